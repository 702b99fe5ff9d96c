"""Measurements that are not made yet: what the command line says of them, and inputs with their numbers."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal, localcontext
from fractions import Fraction
from typing import TYPE_CHECKING

from ...derivations.unit_text import is_pure, parse_unit
from ..messages.errors import Findings, Location, listing, suggest
from ..quantity import Printed, there
from .number_text import read_unit_of, read_value
from .readings import correlations_of
from .stated import Of, StatementError, read_statement, split
from .taken import alone

if TYPE_CHECKING:
    from .inputs import Inputs
    from .number_text import Declared
    from .stated import StatedErrors
    from .taken import Taken, TakenError

Said = Mapping[str, "StatedErrors"]
"""What is stated of columns and parameters, by name."""

_NUMBER = re.compile(r"(?P<number>[+-]?[0-9.]*(?:[eE][+-]?[0-9]+)?)\s*(?P<unit>.*)", re.DOTALL)
_NAMED = re.compile(r"(?P<name>\w+)\s*=\s*")
_BARE = re.compile(r"[0-9.][^%;,]*")
_SAYS = "u = "
_DOUBLES = 1500
"""Digits: more than any double has, in any unit, up to any last digit that is printed."""


def known(inputs: Inputs) -> list[str]:
    """The columns and parameters that have an uncertainty: what is given, and not counted."""
    every = inputs.workbook.declared.items()
    return [name for name, own in every if inputs.printed(name) and not own.bounds.integer]


def read_numbers(text: str, option: str, mark: str, like: Declared, unit: str) -> list[float]:
    """Read numbers of a column from an option: ``2.5, 3.5, 5 m/s``.

    Parameters
    ----------
    text, option : str
        What was written, and for what.
    mark : str
        What stands between two.
    like : Measured
        What they are.
    unit : str
        Of those that name none, if the last one does not name one either; empty: it is missed.

    Returns
    -------
    list of float
        In SI.

    Raises
    ------
    InputError
        With every finding, each with its place in the option.
    """
    findings, found = Findings(), []
    parts = []
    for part, start in split(text, mark):
        match = _NUMBER.fullmatch(part)
        number, own = (match["number"], match["unit"]) if match and match["number"] else (part, "")
        parts.append((number, own, start, start + len(part) - len(own)))
    common = parts[-1][1] or unit
    for number, own, start, behind in parts:
        at = _place(option, text, behind if own else start, len(own or number))
        if not (own or common or is_pure(like.unit)):
            example = f"{number} {like.unit}"
            findings.add("LS211", at, name=like.name, text=number, unit=like.unit, example=example)
            continue
        size = read_unit_of(own or common, like, lambda *_, at=at: at, findings)
        value = read_value(number, size, like, _place(option, text, start, len(number)), findings)
        if value is not None:
            found.append(float(value.value))
    findings.check()
    return found


def read_u(text: str, option: str, inputs: Inputs) -> Said:
    """Read uncertainties from an option, ``v = 0.5 %; x_p = 0.1 um``, as [uncertainty] has them.

    A size alone, which would say nothing there, is a standard uncertainty here.

    Parameters
    ----------
    inputs : Inputs
        Whose columns and parameters they are of.

    Raises
    ------
    InputError
        With every finding, each with its place in the option.
    """
    findings = Findings()
    names = known(inputs)
    found: dict[str, StatedErrors] = {}
    for name, said, begin, start in _statements(text, names):
        if name not in names or name in found:
            at = _place(option, text, begin, max(len(name), 1))
            if name in found:
                findings.add("LS433", at, name=name, suggestion="several errors stand behind one name")
            else:
                words = {"known": listing(names), "suggestion": suggest(name, names)}
                findings.add("LS604", at, kind="column or parameter", text=name, **words)
            continue
        before = _SAYS if _BARE.fullmatch(said) and "digit" not in said else ""
        of = Of(inputs.numbers(name), inputs.workbook.declared[name].bounds)
        try:
            found[name] = read_statement(before + said, parse_unit(inputs.numbers(name)[0].unit), None, of)
        except StatementError as error:
            at = _place(option, text, start + max(error.start - len(before), 0), max(len(error.text), 1))
            findings.add(error.code, at, text=error.text, suggestion=error.suggestion)
    for pair in inputs.uncertainty.correlations:
        for name in (name for name in pair if name in found and len(found[name].parts) != 1):
            reason = f"{' and '.join(pair)} are correlated, and {name} would not have one error"
            at = _place(option, text, text.find(name), len(name))
            findings.add("LS434", at, reason=reason, suggestion="state one error of it")
    findings.check()
    return found


def planned(inputs: Inputs, values: Mapping[str, Sequence[float]], like: Sequence[int], said: Said) -> Inputs:
    """Inputs with rows that are not measured yet.

    Parameters
    ----------
    inputs : Inputs
        Of what was measured; no cell is empty.
    values : mapping of str to sequence of float
        All measured columns, in SI.
    like : sequence of int
        For each row the measured one that it is like: it has as many decimals, its errors, and a share in
        what that one's group shares.
    said : mapping of str to StatedErrors
        What is stated of columns and parameters anew.

    Returns
    -------
    Inputs
        Without all that is about measured rows.
    """
    tests = tuple(range(1, len(like) + 1))
    own = inputs.uncertainty
    shared = tuple(
        replace(each, groups=tuple(g for group in each.groups if (g := _again(group, inputs, like))))
        for each in own.shared
    )
    # Where no planned row is like one of a group, nothing is shared; without groups all rows share it.
    shared = tuple(
        new for old, new in zip(own.shared, shared, strict=True) if bool(old.groups) == bool(new.groups)
    )
    stated = replace(own, columns={**own.columns, **said}, shared=shared)
    measured: dict[str, tuple[Printed | None, ...]] = {
        name: tuple(_like(inputs.numbers(name)[row], value) for row, value in zip(like, column, strict=True))
        for name, column in values.items()
    }
    parameters = {name: (printed,) for name, printed in inputs.parameters.items()}
    taken = {name: taken for name, taken in inputs.taken.items() if name not in said}
    return replace(
        inputs,
        tables=(replace(inputs.only, tests=tests, measured=stated.of(measured), left_out=(), remarks=()),),
        parameters={name: printed for name, (printed,) in stated.of(parameters).items()},
        uncertainty=stated,
        published=(),
        published_u=(),
        aside=(),
        expected=(),
        limits=(),
        errata={},
        free_at={},
        taken=_taken_again(taken, inputs.measured, like),
    )


def otherwise(inputs: Inputs, numbers: Mapping[str, Sequence[float]]) -> Inputs:
    """Inputs as they would be if some numbers were others than they are printed, all else being the same.

    How readings scatter, alone or together, follows; what the text of a number says of its error stays.

    `numbers`: in SI, by column or parameter; of what is not there nothing is asked.
    """

    def of(name: str, column: tuple[Printed | None, ...]) -> tuple[Printed | None, ...]:
        pairs = zip(column, numbers.get(name, ()), strict=False)
        return tuple(p and replace(p, value=Fraction(value)) for p, value in pairs) or column

    measured = {name: of(name, column) for name, column in inputs.measured.items()}
    parameters = {name: of(name, (printed,)) for name, printed in inputs.parameters.items()}
    own = inputs.uncertainty
    columns = {
        name: each.of_others(there(measured[name])) if name in measured else each
        for name, each in own.columns.items()
    }
    apart = {pair: r for pair, r in own.correlations.items() if not {*pair} <= {*own.paired}}
    together = correlations_of({name: there(measured[name]) for name in own.paired})
    stated = replace(own, columns=columns, correlations={**apart, **together})
    every = {name: printed for name, (printed,) in stated.of(parameters).items() if printed}
    return replace(inputs.with_numbers(stated.of(measured)), parameters=every, uncertainty=stated)


def _again(group: tuple[int, ...], inputs: Inputs, like: Sequence[int]) -> tuple[int, ...]:
    """The planned tests that are like those of a group."""
    return tuple(test for test, row in enumerate(like, start=1) if inputs.only.tests[row] in group)


def _taken_again(
    every: Mapping[str, Taken], measured: Collection[str], like: Sequence[int]
) -> dict[str, Taken]:
    """What was taken, for planned rows: an error of one measured row alone is another one in each like it."""
    own = alone(every, measured)

    def again(error: TakenError, test: int) -> TakenError:
        report, name = error.origin
        return replace(error, origin=(report, f"{name}, test {test}")) if error.origin in own else error

    def planned(taken: Taken) -> Taken:
        there = taken.of(like)
        errors = (tuple(again(e, test) for e in each) for test, each in enumerate(there.errors, start=1))
        return replace(there, errors=tuple(errors))

    return {name: planned(taken) if name in measured else taken for name, taken in every.items()}


def _like(printed: Printed, value: float) -> Printed:
    """A number as another is printed: the text is rounded, what is computed from is not."""
    places = printed.decimals
    with localcontext(prec=_DOUBLES):
        shift = Decimal(printed.zero.numerator) / printed.zero.denominator
        size = (Decimal(value) - shift) * printed.scale.denominator / printed.scale.numerator
        short = size.quantize(Decimal(1).scaleb(-places))
    text = f"{short:f}" if places >= 0 else f"{short.scaleb(places):f}e{-places}"
    return replace(printed, text=text, value=Fraction(value), where="")


def _statements(text: str, names: Sequence[str]) -> Iterator[tuple[str, str, int, int]]:
    """Name, statement, and where both begin; what names nothing goes on with what was named before."""
    name, said, begin, start = "", "", 0, 0
    for part, at in split(text, ";"):
        named = _NAMED.match(part)
        if named and (named["name"] in names or not name or named["name"] not in _WORDS):
            if name:
                yield name, said, begin, start
            name, begin, start = named["name"], at, at + named.end()
            said = part[named.end() :]
        elif name:
            said = text[start : at + len(part)]
        else:
            yield part, "", at, at
            return
    yield name, said, begin, start


_WORDS = frozenset({"u", "U", "s", "k", "p", "n", "dof", "t"})
"""What a statement may begin with."""


def _place(option: str, text: str, start: int, length: int) -> Location:
    return Location(option, 1, start + 1, max(length, 1), text)
