"""What a derivation is made of: equations, the steps between them, and the ledger that holds both.

An equation is written once, in its author's order of terms (under ``with evaluate(False)``); what is
computed is the same expression, evaluated. Nothing here decides whether a claim holds: that is
:mod:`~loopsheet.derivations.proof`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from .vocabulary import NO_WORDS, Vocabulary

if TYPE_CHECKING:
    from sympy import Expr, Rel


class Kind(Enum):
    """Why an equation stands in the ledger."""

    DEFINITION = "definition"
    ASSUMPTION = "assumption"
    LIMIT = "limit"
    """An assumption that is approached from above and never reached: a quantity is zero."""
    CLAIM = "claim"


@dataclass(frozen=True)
class Equation:
    """A numbered statement that some expressions are equal, in the source's own words."""

    number: str
    """Its number in the source, ``"(11)"``; numbers that begin with L are this project's own."""
    members: tuple[Expr, ...]
    """Two or more expressions said to be equal, as the author orders their terms; an inequality is one
    relation."""
    because: str
    """Why it holds, in a sentence."""
    kind: Kind = Kind.CLAIM
    """Definition, assumption, or a claim that needs a derivation."""
    title: str = ""
    """What it is called in prose."""
    part: str = ""
    """Which line of a numbered group, ``"a"`` of ``(12a)``."""
    defines: Expr | None = None
    """The quantity that this line determines."""
    printed: tuple[Expr, ...] | None = None
    """What the source prints, where that differs from what is meant."""
    conditions: tuple[Rel, ...] = ()
    """Relations without which it does not hold."""
    parent: Equation | None = field(default=None, repr=False)
    renamed: tuple[tuple[tuple[Any, Any], ...], ...] = field(default=(), repr=False)
    """What `at` put in, call by call: a proof makes the instance again from the parent."""

    def __post_init__(self) -> None:
        if any(isinstance(member, int | float) for member in self.members):  # a plain number: x = 0
            from sympy import sympify

            members = tuple(sympify(member, rational=True) for member in self.members)
            object.__setattr__(self, "members", members)

    @property
    def label(self) -> str:
        """Number and part: ``(12a)``; the title where there is no number."""
        if not self.number:
            return self.title
        return f"{self.number[:-1]}{self.part})" if self.part else self.number

    @property
    def own(self) -> bool:
        """Whether the number is this project's, not the source's."""
        return self.number.startswith("(L")

    @cached_property
    def sides(self) -> tuple[Expr, ...]:
        """The members as they are computed."""
        from .rebuilt import evaluated

        return tuple(evaluated(member) for member in self.members)

    @property
    def residuals(self) -> tuple[Expr, ...]:
        """Differences of neighbouring sides: the equation says that each is zero."""
        sides = self.sides
        return tuple(a - b for a, b in pairwise(sides))

    @property
    def value(self) -> Expr:
        """The last side: what a formula for the quantity on the left computes."""
        return self.sides[-1]

    @property
    def brief(self) -> Equation:
        """Only the first and the last member: what a chain of equalities says in the end."""
        return replace(self, members=(self.members[0], self.members[-1]), parent=self.origin)

    @property
    def reversed(self) -> Equation:
        """The same equation read from right to left."""
        return replace(self, members=self.members[::-1], parent=self.origin)

    def at(self, where: Mapping[Any, Any]) -> Equation:
        """The same equation for other symbols: one test of all, or the rows of a sheet."""
        from .rebuilt import replaced

        return replace(
            self,
            members=tuple(replaced(member, where) for member in self.members),
            defines=None if self.defines is None else self.defines.xreplace(dict(where)),
            conditions=tuple(condition.xreplace(dict(where)) for condition in self.conditions),
            printed=None,
            parent=self.origin,
            renamed=(*self.renamed, tuple(where.items())),
        )

    def branch(self, number: int, because: str) -> Equation:
        """One branch of a law by cases, as an equation of its own."""
        law = self.members[-1].args[number].expr
        return replace(self, members=(self.members[0], law), because=because, parent=self.origin)

    @property
    def origin(self) -> Equation:
        """The equation of the ledger that this is an instance of (itself, if it is none)."""
        return self.parent if self.parent is not None else self

    @property
    def follows_from_origin(self) -> bool:
        """Whether it says no more than its origin, with positive quantities put in for positive ones.

        A branch of a law by cases is what the law says in that case.
        """
        from sympy import Piecewise

        laws = (member for member in self.origin.members if isinstance(member, Piecewise))
        cases = (case.expr for law in laws for case in law.args)
        made = replace(self.origin, members=(*self.origin.members, *cases))
        for where in self.renamed:
            if any(old.is_positive and not new.is_positive for old, new in where):
                return False
            made = made.at(dict(where))
        return set(self.members) <= set(made.members) and set(made.conditions) <= set(self.conditions)


def define(
    number: str, quantity: Expr, value: Expr, title: str, because: str = "definition", **more: Any
) -> Equation:
    """Say what a quantity is: an equation that determines it, with `more` that an equation may have."""
    return Equation(number, (quantity, value), because, Kind.DEFINITION, title, defines=quantity, **more)


def assume(
    members: tuple[Expr, ...], because: str, title: str, kind: Kind = Kind.ASSUMPTION, **more: Any
) -> Equation:
    """Say what a derivation begins with and no source numbers: by `kind`, no claim."""
    return Equation("", members, because, kind, title, **more)


@dataclass(frozen=True)
class Step:
    """One step: the claim follows when the premises are solved for `eliminate` and put in."""

    claim: Equation
    premises: tuple[Equation, ...]
    eliminate: tuple[Expr, ...]
    """For each premise in turn, what it is solved for: ``X``, the column, of ``X[k] = ...`` for every k."""
    says: str
    multiplier: Expr | None = None
    """Where a premise is not solved: the last premise times this factor, nowhere zero, is the claim."""


@dataclass(frozen=True)
class Derivation:
    """A chain of steps; the claim of the last is what was to be shown."""

    steps: tuple[Step, ...]

    @classmethod
    def of(
        cls,
        claim: Equation,
        premises: tuple[Equation, ...],
        eliminate: tuple[Expr, ...],
        says: str,
        multiplier: Expr | None = None,
        after: tuple[Step, ...] = (),
    ) -> Derivation:
        """Make a chain of one step, `after` others."""
        return cls((*after, Step(claim, premises, eliminate, says, multiplier)))

    @property
    def claim(self) -> Equation:
        """The equation at the end of the chain."""
        return self.steps[-1].claim


@dataclass(frozen=True)
class Erratum:
    """A finding about the printed equations, made by a check; it names its evidence."""

    about: str
    kind: str
    sentence: str
    evidence: str = ""


@dataclass(frozen=True)
class Ledger:
    """All equations of a source, in its order, each with its derivation, and the checks of the print.

    Raises
    ------
    ValueError
        Two equations have one number: a report could not tell them apart.
    """

    entries: tuple[Equation | Derivation, ...]
    checks: tuple[Callable[[Ledger], Erratum | None], ...] = ()
    vocabulary: Vocabulary = NO_WORDS
    """What its symbols mean, how they are printed and where they are sampled."""
    parts: tuple[tuple[Equation | Derivation, ...], ...] = ()
    """Of models that exclude one another, each with what it rests on: what is to hold together. Left out, all
    of it is."""

    def __post_init__(self) -> None:
        """No two equations with a number have the same."""
        labels = [equation.label for equation in self.equations() if equation.number]
        twice = [label for place, label in enumerate(labels) if label in labels[:place]]
        if twice:
            raise ValueError(f"the ledger has two equations {', '.join(twice)}; a number has exactly one")

    def equations(self) -> Iterator[Equation]:
        """All numbered equations, in order."""
        for entry in self.entries:
            yield entry.claim if isinstance(entry, Derivation) else entry

    def derivation(self, equation: Equation) -> Derivation | None:
        """The chain that ends in this equation."""
        for entry in self.entries:
            if isinstance(entry, Derivation) and entry.claim == equation:
                return entry
        return None

    def __getitem__(self, label: str) -> Equation:
        """The equation of a label, ``(12a)``."""
        for equation in self.equations():
            if equation.label == label:
                return equation
        raise KeyError(label)
