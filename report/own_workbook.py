"""A user's own workbook: the bytes that were read are what runs, and what it raises is told with its line."""

from __future__ import annotations

import ast
import re
import sys
import types
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from inspect import signature
from keyword import iskeyword
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from .at_once import NO_IF, OF_SYMPY, at_once
from .column import SheetError
from .inputs.declared import mistyped
from .messages.errors import Diagnostic, InputError, Location, LoopsheetError, diagnose

if TYPE_CHECKING:
    from ..derivations.equation import Ledger
    from .workbook import Workbook

_PURE = {"__future__", "collections", "dataclasses", "fractions", "functools", "itertools", "math", "typing"}
_PURE |= {"loopsheet", "mpmath", "sympy"}
"""What a workbook may import and still be the same whenever it is run."""


def own_workbook(path: Path, code: bytes) -> Workbook:
    """Run the user's own code and return the workbook that it declares.

    Parameters
    ----------
    path : Path
        The file, as the user wrote it, for messages.
    code : bytes
        What is run: nothing is read again, no cache is believed and none is left in the user's folder.

    Raises
    ------
    InputError
        It fails, asks to end the program, or declares no workbook; later, a function that it gave the
        workbook does so.
    """
    from ..derivations.equation import Ledger
    from .workbook import Workbook

    own = _Own(path, code)
    found: Workbook = own.guarded("WORKBOOK", own.run, Workbook)()
    wrong = [
        diagnose("LS213", place_of(path, code, field, word), text=path.name, reason=reason, suggestion="")
        for field, word, reason in mistyped(found)
    ]
    if wrong:
        raise InputError(*wrong)

    def ledger() -> Ledger:
        plain: Ledger = own.guarded("what ledger() returns", found.ledger, Ledger)()
        return replace(plain, checks=tuple(own.guarded("a check", check) for check in plain.checks))

    def drawings() -> dict[str, Callable[[Any], Any]]:
        made = own.guarded("what drawings() returns", found.drawings or dict, Mapping)()
        return {name: own.guarded(f"the drawing '{name}'", draw) for name, draw in made.items()}

    return replace(
        found,
        ledger=ledger,
        sheet=own.guarded("what sheet() returns", found.sheet),
        check_parameters=found.check_parameters
        and own.guarded("what check_parameters() returns", found.check_parameters, str | None),
        drawn=found.drawn and own.guarded("what drawn() returns", found.drawn),
        drawings=found.drawings and drawings,
    )


def follows_from_its_bytes(code: bytes) -> bool:
    """Whether all that a workbook says follows from its code, as far as its author did not hide it.

    What reads files, or uses what loopsheet does not know the version of, is run whenever it is asked for.
    """
    try:
        tree = ast.parse(code)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    imported = {
        name.partition(".")[0]
        for node in ast.walk(tree)
        if isinstance(node, (ast.Import, ast.ImportFrom))
        for name in (
            [node.module or ""] if isinstance(node, ast.ImportFrom) else [a.name for a in node.names]
        )
    }
    named = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    return imported <= _PURE and named.isdisjoint({"open", "exec", "eval", "compile", "__import__"})


_HINT = (
    "it is a Python file with a class of loopsheet.Method (or a Workbook of loopsheet.report as WORKBOOK); "
    "'loopsheet new FOLDER --workbook formula' writes one"
)


@dataclass(frozen=True)
class _Own:
    path: Path
    code: bytes

    def run(self) -> Any:
        # Two folders may each have a workbook.py; a class finds its module by its name.
        module = types.ModuleType(f"loopsheet_workbook_{self.path.resolve().as_posix()}")
        module.__file__ = str(self.path)
        sys.modules[module.__name__] = module
        program = compile(self.code, str(self.path), "exec", dont_inherit=True)
        if wrong := {line: (said, instead) for line, said, instead in at_once(self.code)}:
            raise InputError(*(self.finding(line, *told) for line, told in sorted(wrong.items())))
        exec(program, vars(module))
        if hasattr(module, "WORKBOOK"):
            return module.WORKBOOK
        every = [each for each in vars(module).values() if getattr(each, "__module__", "") == module.__name__]
        methods = [each for each in every if hasattr(each, "workbook")]
        if len(methods) != 1:
            self.refuse(
                "it declares no WORKBOOK and no class of Method" if not methods else "it declares two methods"
            )
        return methods[0].workbook

    def guarded(self, what: str, function: Callable[..., Any], kind: Any = object) -> Callable[..., Any]:
        """The function, with what it raises told as the user's own; and that it returns what it should."""

        def call(*arguments: Any) -> Any:
            try:
                found = function(*arguments)
            except (KeyboardInterrupt, LoopsheetError):
                raise
            except BaseException as error:  # sys.exit() too: it must not end us as if all were well
                self.refuse(_said(error), error)
            if not isinstance(found, kind):
                self.refuse(f"{what} is no {getattr(kind, '__name__', kind)}")
            return found

        return call

    def refuse(self, reason: str, error: BaseException | None = None) -> NoReturn:
        """Raise a finding at the last line of the user's file that the error passed through."""
        line = getattr(error, "lineno", None) if isinstance(error, SyntaxError) else None
        traceback = None if error is None else error.__traceback__
        while traceback is not None:
            if traceback.tb_frame.f_code.co_filename == str(self.path):
                line = traceback.tb_lineno
            traceback = traceback.tb_next
        found = self.finding(line, reason, _HINT if error is None else self.hint(error, line))
        if isinstance(error, SheetError) and str(found.at.source).lstrip().startswith("class "):
            at = place_of_column(self.path, self.code, error.about)  # told at the end of its body
            found = replace(found, at=at) if at.line else found
        raise InputError(*self.met_before(error, found)) from error

    def met_before(self, error: BaseException | None, found: Diagnostic) -> Iterator[Diagnostic]:
        """What was wrong in the body of a method, and the finding, unless it follows from that."""
        from .method.errors import CURRENT

        body = CURRENT.get()
        CURRENT.set(None)
        for line, each in body.wrong.items() if body else ():
            yield self.finding(line, _said(each), self.hint(each, line))
        named = set(re.findall(r"\w+", str(found.at.source)))
        if body is None or (error not in body.wrong.values() and named.isdisjoint(body.without)):
            yield found

    def hint(self, error: BaseException, line: int | None) -> str:
        """What helps who wrote a line that fails; of a name also where it is declared, if that is below."""
        if not isinstance(error, NameError) or not line:
            return _hint(error)
        below = enumerate(self.code.decode(errors="replace").splitlines()[line:], start=line + 1)
        computed = re.compile(rf"\s+{re.escape(error.name or '')}\s*=\s*(let|given|measured|constant)\(")
        later = next((n for n, text in below if computed.match(text)), 0)
        there = f"{error.name} is declared below, in line {later}: move this line behind it"
        return there if later else _hint(error)

    def finding(self, line: int | None, reason: str, hint: str) -> Diagnostic:
        """A finding at a line of the file."""
        at = _place(self.path, self.code, line)
        return diagnose("LS213", at, text=self.path.name, reason=reason, suggestion=hint)


def _said(error: BaseException) -> str:
    """What a sheet complains of, or what Python does, with its name."""
    ours = isinstance(error, SheetError)
    text = error.msg if isinstance(error, SyntaxError) else str(error)  # without its line, which is shown
    return text if ours else f"{type(error).__name__}: {text}".removesuffix(": ")


def _hint(error: BaseException) -> str:
    """What helps who wrote a line that fails; what a sheet complains of says it itself."""
    from .method.lines import FUNCTIONS

    match error:
        case SheetError() if "argument of a function must be a pure number" in str(error):
            return "divide it by one of its kind, log(c / c_0): c_0 given, default='1 mol/L', exact=True"
        case SheetError() if re.search(r"cannot add (1 and|.* and 1 in)", str(error)):
            return 'a number has no unit; what is declared has, given("mm", ...) and unknown("length", "mm")'
        case SheetError():
            return ""
        case NameError(name="math" | "cmath" | "np" | "numpy"):
            return OF_SYMPY
        case NameError(name=name) if name in (*FUNCTIONS, "sqrt", "pi"):
            return f"write above: from sympy import {name}"
        case NameError(name=name) if name in _words():
            return f"write above: from loopsheet import {name}"
        case NameError(name=name):
            said = "a name stands for its cell from the line on where it is declared"
            found = f"; what a root or a fit finds is announced above it, {name} = unknown(...)"
            return said if not name or "did you mean" in str(error) else said + found
        case ImportError(name="loopsheet"):
            return f"there are {', '.join(_words())}; max, min and sum are Python's, functions are sympy's"
        case ImportError():
            return "a copy of a shipped workbook imports by full names, as loopsheet.report.sheet"
        case TypeError() if " for ^" in str(error):
            return "a power is written x**2"
        case TypeError() if re.search("float|ufunc", str(error)):
            return OF_SYMPY
        case TypeError() if "truth value" in str(error):
            return NO_IF
        case TypeError() if "_Declaring.__new__" in str(error):
            return 'behind Method: source, headline, rows (as in rows="readings"), index and size'
        case TypeError() if word := re.match(r"(\w+)\(\) (takes|missing|got)", str(error)):
            return _called(word[1])
        case TypeError() if re.search(r"'\w+Line'", str(error)):
            return "what is declared has a line of its own, and a name that stands for it in formulas"
        case TypeError() if "not callable" in str(error):
            return "is there a * missing before a parenthesis?"
        case TypeError() if "not subscriptable" in str(error):
            return (
                "a formula names no single row or group: give rows a column of 1 and 0, stated exact, "
                "and take sum(w * is_spiked)"
            )
        case TypeError() | AttributeError() if re.search("symbol|Indexed|Symbol", str(error)):
            return "a name stands for a cell in formulas: no number yet, and no list; mean(x) is its mean"
        case SyntaxError(text=str(line)) if iskeyword(own := line.partition("=")[0].strip()):
            return f"'{own}' is a word of Python: call it {own}_, with latex=... as it is printed"
        case SyntaxError() if re.search(r"U\+(2212|2013)", error.msg):
            return "write the minus sign as an ordinary hyphen"
    return ""


def _words() -> list[str]:
    """What a method is written with."""
    from .method import words

    return words.__all__


def _called(word: str) -> str:
    """How a word of methods is called."""
    from .method import words

    if word not in _words():
        return ""
    said = signature(getattr(words, word))
    plain = [each.replace(annotation=each.empty) for each in said.parameters.values()]
    return f"it is {word}{said.replace(parameters=plain, return_annotation=said.empty)}"


def place_of(path: Path, code: bytes, field: str, word: str = "") -> Location:
    """Where a field of the workbook is given, or a word in quotes from there on; else the file alone."""
    text = code.decode("utf-8", "replace")
    given = re.search(rf"\b{field}\s*=", text)
    found = given and re.compile(_quoted(word) if word else field).search(text, given.start())
    return _found(path, text, found)


def place_of_column(path: Path, code: bytes, about: Sequence[str]) -> Location:
    """Where what a sheet complains of is written: a column of the first name that there is, or the name."""
    text = code.decode("utf-8", "replace")
    ways = (
        way
        for name in about
        for way in (
            rf"Column\(\s*{_quoted(name)}",
            *(rf"(?m)(?<=^{space}){re.escape(name)}\b(?= *=)" for space in (" " * 4, " " * 8)),
            _quoted(name),
        )
    )
    found = (re.search(way, text) for way in ways)
    return _found(path, text, next(filter(None, found), None))


def _quoted(word: str) -> str:
    return rf"([\"']){re.escape(word)}\1"


def _found(path: Path, text: str, found: re.Match[str] | None) -> Location:
    """The place of a match that ends on its line, in a file."""
    if found is None:
        return Location(path.as_posix())
    begin = text.rfind("\n", 0, found.end()) + 1
    line, first = text[begin:].partition("\n")[0].rstrip("\r"), max(found.start(), begin)
    number = text.count("\n", 0, begin) + 1
    return Location(path.as_posix(), number, first - begin + 1, found.end() - first, line)


def _place(path: Path, code: bytes, line: int | None) -> Location:
    """A line of the code, if it is one."""
    source = code.decode("utf-8", "replace").splitlines()
    shown = source[line - 1] if line is not None and 0 < line <= len(source) else ""
    file, text = path.as_posix(), shown.strip()
    return Location(file, line, shown.index(text) + 1, len(text), shown) if text else Location(file)
