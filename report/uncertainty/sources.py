"""The errors behind a report: of each given number, and those that several share."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import combinations

from ..cells.address import address
from ..cells.values import Values
from ..inputs.inputs import Inputs
from ..inputs.taken import Origin, Taken, TakenError
from ..laws import Samples
from ..quantity import Printed
from ..result.uncertain import ErrorSource
from ..sheet import Column, Given


def sources(inputs: Inputs, values: Values) -> tuple[ErrorSource, ...]:
    """All errors of what was given, in the order of the sheet, then what is shared, and what was taken.

    A number that the workbook declares exact has none unless one was stated.

    `values`: of the sheet; they tell what rows are called.
    """
    return (*_own(inputs, values), *_shared(inputs, values), *_taken(inputs, values))


def _own(inputs: Inputs, values: Values) -> Iterator[ErrorSource]:
    for column in given(values):
        if column.name in inputs.taken:
            continue
        printed = inputs.printed(column.name)
        for row, (label, number) in enumerate(zip(values.labels(column), printed, strict=True)):
            if number is None:
                continue
            errors = () if column.exact and number.stated is None else number.errors
            name = address(column.name, label)
            for n, error in enumerate(errors):
                if error.width:
                    told = f"{name}, {error.said}" if len(errors) > 1 else name
                    if alike := sum(each.said == error.said for each in errors[:n]):
                        told += f" ({alike + 1})"
                    moves = ((column.name, row, error.u),)
                    yield ErrorSource(
                        told, error.shape, error.dof, moves, error.said, error.sample, error.law
                    )


def _shared(inputs: Inputs, values: Values) -> Iterator[ErrorSource]:
    for each in inputs.uncertainty.shared:
        # A parameter that the sheet of this folder does not use has none.
        own = [values.sheet[name] for name in each.statements if name in values.sheet]
        of_test: dict[int, list[tuple[tuple[str, int], Printed]]] = {}
        for column in own:
            labels, printed = values.labels(column), inputs.printed(column.name)
            for row, (label, number) in enumerate(zip(labels, printed, strict=True)):
                if number is not None:
                    of_test.setdefault(label[0] if label else 0, []).append(((column.name, row), number))
        for group in each.groups or (tuple(of_test),):
            every = [one for test in group for one in of_test.get(test, ())]
            errors = {cell: each.error(cell[0], number) for cell, number in every}
            moves = tuple((*cell, each.sign(cell[0], number) * errors[cell].u) for cell, number in every)
            named = ""
            if each.groups and own and (axis := own[0].axis):
                named = f" ({axis.name if len(group) > 1 else axis.row} {', '.join(map(str, group))})"
            if any(u for _, _, u in moves):
                one = next(iter(errors.values()))
                yield ErrorSource(
                    f"{each.name}{named}", one.shape, one.dof, moves, one.said, one.sample, one.law
                )


def _taken(inputs: Inputs, values: Values) -> Iterator[ErrorSource]:
    """The errors of other reports: one that two numbers share moves both.

    Each is named by the report where it begins; by one that it came through, if nothing is taken from that.
    """
    every = [(name, taken) for name, taken in inputs.taken.items() if name in values.sheet]
    moves: dict[Origin, list[tuple[str, int, float]]] = {}
    first: dict[Origin, tuple[Taken, TakenError]] = {}
    for name, taken in every:
        for row, each in ((row, each) for row, errors in enumerate(taken.errors) for each in errors):
            moves.setdefault(each.origin, []).append((name, row, each.moved))
            first.setdefault(each.origin, (taken, each))
    files = {taken.made_from: taken.file for _, taken in reversed(every)}
    begun = {origin: files.get(origin[0], f"through {taken.file}") for origin, (taken, _) in first.items()}
    names = Counter((origin[1], file) for origin, file in begun.items())
    for origin, (_, each) in first.items():
        more = f", {origin[0][:8]}" if names[origin[1], begun[origin]] > 1 else ""
        told, error = f"{origin[1]} ({begun[origin]}{more})", each.error
        yield ErrorSource(
            told, error.shape, error.dof, tuple(moves[origin]), "taken", error.sample, error.law, origin
        )


def given(values: Values) -> tuple[Column, ...]:
    """The given columns of a sheet that are measured: not counted, and no standard uncertainties."""
    sheet = values.sheet
    return tuple(
        column
        for column in sheet.columns
        if isinstance(column.rule, Given) and not column.rule.u_of and not sheet.bounds[column.name].integer
    )


def correlated(
    every: Sequence[ErrorSource], inputs: Inputs, values: Values
) -> tuple[tuple[int, int, float], ...]:
    """The correlation coefficients that were stated or drawn, with the places of their two sources."""
    place = {source.name: n for n, source in reversed(tuple(enumerate(every)))}  # own ones are first
    found = []
    for (one, other), coefficient in inputs.uncertainty.correlations.items():
        labels = values.labels(values.sheet[one]) if one in values.sheet and other in values.sheet else ()
        for names in ((address(one, label), address(other, label)) for label in labels):
            if place.keys() >= set(names):
                found.append((place[names[0]], place[names[1]], coefficient))
    origins = {source.origin: n for n, source in enumerate(every) if source.origin}
    both = {pair: r for taken in inputs.taken.values() for pair, r in taken.correlations.items()}
    found += [(origins[a], origins[b], r) for (a, b), r in both.items() if {a, b} <= origins.keys()]
    drawn = [(n, source.law) for n, source in enumerate(every) if isinstance(source.law, Samples)]
    for (a, first), (b, second) in combinations(drawn, 2):
        if first.table == second.table:
            found.append((a, b, first.correlation(second)))
    return tuple(found)
