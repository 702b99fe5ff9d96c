"""What is wrong in the body of a method, told at once: behind a line that fails the others are read.

What fails stands for something of which nothing is known; what names that is passed over without a word.
"""

from __future__ import annotations

import builtins
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextvars import ContextVar
from functools import wraps
from typing import Any, ParamSpec, TypeVar, cast

from sympy import Basic, Dummy, Expr

from ...derivations.equation import Ledger
from ..cells.units import check_column
from ..column import SheetError
from ..messages.errors import suggest
from .body import MethodBody
from .lines import FUNCTIONS, ComputedLine, Declaration, FitLine, PointsLine, TakenLine

P = ParamSpec("P")
T = TypeVar("T")


class _Failed(Dummy):  # type: ignore[misc]
    """The place of what could not be declared; of two, nobody knows that they are the same."""

    __slots__ = ()

    def __getattr__(self, name: str) -> Any:
        """What a fit would have."""
        if name.startswith(("_", "is_")):
            raise AttributeError(name)
        return self

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        """What ``np.mean`` would be called with."""
        return self


class WatchedBody(MethodBody):
    """A body that goes on behind a line that is wrong."""

    def __init__(self, rows: str, index: str, size: str, ledger: Ledger | None = None) -> None:
        super().__init__(rows, index, size, ledger)
        self.wrong: dict[int, Exception] = {}
        """By line, in the order in which they stand; of a line the first alone."""
        self.said_in = dict[int, int]()  # of what a word declares, by its identity, the line

    def failed(self, error: Exception, line: int) -> Any:
        """Remember an error; what stands for what the line declares."""
        self.wrong.setdefault(line, error)
        return _Failed("_")

    def refuse_nameless(self) -> None:
        """Remember what was declared and has no name."""
        for said in self.unnamed:
            what = f"'{said.meaning}'" if isinstance(said, Declaration) else "a fit"
            error = SheetError(f"{what} has no name: a line is a name, =, and what is declared")
            self.failed(error, self.said_in[id(said)])

    @property
    def first_wrong(self) -> Exception:
        """The first error, with all of them as its notes."""
        first = next(iter(self.wrong.values()))
        for line, error in self.wrong.items():
            first.add_note(f"line {line}: {error}")
        return first

    @property
    def without(self) -> set[str]:
        """The names of which nothing is known."""
        return {name for name, value in self.items() if any(_failed_in(value))}

    def without_fit(self, *formulas: Any) -> None:
        """Know nothing of the unknowns in formulas that a fit would have found, not even their units."""
        named = {each for part in formulas if isinstance(part, Basic) for each in part.free_symbols}
        for each in {str(symbol) for symbol in named} & self.announced.keys():
            dict.__setitem__(self, each, _Failed("_"))

    def paired(self, index: str, size: str, members: Sequence[str]) -> tuple[Callable[[Any], Expr], ...]:
        """The members of a pair, which remember what is wrong with their line, too."""
        return tuple(map(told_together, super().paired(index, size, members)))

    def __missing__(self, name: str) -> Any:
        try:
            return told_together(super().__missing__(name))
        except KeyError:
            around = sys._getframe(1)
            beyond = name in around.f_globals or name in around.f_code.co_freevars or hasattr(builtins, name)
            if beyond or name.startswith("__"):
                raise
            # Of all that a star brings along nothing is meant.
            brought = (n for n, of in around.f_globals.items() if not _is_of_sympy(of))
            theirs = [*brought, *(n for n in (*FUNCTIONS, "sqrt", "pi") if n in around.f_globals)]
            near = suggest(name, [*self]) or suggest(name, theirs)
            hint = f": {near}" if near else ""
            return self.failed(NameError(f"name {name!r} is not defined{hint}", name=name), around.f_lineno)

    def __setitem__(self, name: str, value: Any) -> None:
        is_new = name not in self or name in self.announced.keys() - self.columns.keys()
        if isinstance(value, TakenLine) and any(_failed_in(value.parts(self))):
            self.unnamed = [said for said in self.unnamed if said is not value]
            dict.__setitem__(self, name, _Failed("_"))
            return
        try:
            super().__setitem__(name, value)
            if isinstance(value, ComputedLine | PointsLine):
                check_column(self.columns, self.columns[name])
        except SheetError as error:
            failed = self.failed(error, sys._getframe(1).f_lineno)
            self.unnamed = [said for said in self.unnamed if said is not value]
            if is_new:
                dict.__setitem__(self, name, failed)
            if isinstance(value, FitLine):
                self.without_fit(value.model)


CURRENT: ContextVar[WatchedBody | None] = ContextVar("CURRENT", default=None)
"""That of the method which is being declared, or which could not be."""


def told_together(word: Callable[P, T]) -> Callable[P, T]:
    """A word of methods that remembers what is wrong with its line, where that stands in a body."""

    @wraps(word)
    def said(*arguments: P.args, **named: P.kwargs) -> T:
        body = CURRENT.get()
        if body is None:
            return word(*arguments, **named)
        if any(_failed_in((arguments, named))):
            if getattr(word, "__name__", "") == "fit":
                body.without_fit(*arguments, *named.values())
            return cast(T, _Failed("_"))
        line = sys._getframe(1).f_lineno
        try:
            found = word(*arguments, **named)
        except (SheetError, TypeError) as error:
            return cast(T, body.failed(error, line))
        body.said_in[id(found)] = line
        return found

    return said


def current() -> MethodBody:
    """The body of the method which is being declared."""
    body = CURRENT.get()
    if body is None:
        raise SheetError("sums, counts and plots stand in the body of a class of Method")
    return body


def named_next(line: Declaration | FitLine) -> Any:
    """What a line declares; the name comes with the assignment, and must come."""
    body = CURRENT.get()
    if body is not None:
        body.unnamed.append(line)
    return line


def _is_of_sympy(value: Any) -> bool:
    return (getattr(value, "__module__", None) or type(value).__module__).startswith("sympy")


def _failed_in(value: Any) -> Iterator[_Failed]:
    """What failed among the formulas of a value."""
    if isinstance(value, Basic):
        yield from value.atoms(_Failed)
    elif isinstance(value, Mapping):
        yield from _failed_in((*value, *value.values()))
    elif isinstance(value, tuple | list):
        for each in value:
            yield from _failed_in(each)
