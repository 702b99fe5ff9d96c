"""A planned campaign: what it will show, how sure a cell will be, and what that comes from."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping

from ..messages.errors import listing
from ..quantity import behind, span
from ..result.design import Planned
from ..result.numbers import for_json, rounded
from .blocks import Block, TextTable, printers
from .budget import notes, percent, sentence


def _header(plan: Planned) -> list[str]:
    """The names of the columns of the table, each with its unit."""
    found = ["test"]
    for name in plan.u:
        unit = behind(plan.report.shown[name].unit)
        found += [f"{name}{f' [{unit.strip()}]' if unit else ''}", f"u({name})"]
    return [*found, "share"]


def _rows(plan: Planned) -> Iterator[list[str]]:
    """The planned tests."""
    for row, test in enumerate(plan.report.inputs.only.tests):
        found = [str(test)]
        for name, u in plan.u.items():
            value = float(plan.report.values.value[name][row])
            if not math.isfinite(u[row]) or not u[row]:
                found += [rounded(plan.report.shown[name].of(value), 6).text, "0"]
            else:
                found += [figure.text for figure in plan.report.stated(name, value, float(u[row]))]
        yield [*found, percent(plan.of_tests[test])]


def _curve(plan: Planned) -> str:
    cells = (plan.followed.values.cell(name) for name in plan.curve)
    told = ", ".join(f"{cell.name} = {plan.followed.text(cell)}" for cell in cells)
    return f"planned on the curve of '{plan.followed.title}': {told}"


def _said(plan: Planned) -> Iterator[str]:
    """What there is to tell of it, a sentence each."""
    yield from notes(plan.report, plan.budget, "'budget --draws' of such a campaign")
    if plan.best is not None:
        yield _best(plan)
    if plan.needed is not None:
        yield _needed(plan)
    yield from (f"warning: {told}" for told in _warnings(plan))


def _warnings(plan: Planned) -> list[str]:
    """What would be odd, and pairs that would tell nothing, of which a report of measurements is silent."""
    marks = plan.report.marks
    found = [*_beyond(plan), *(check.message for check in plan.report.oddities if not check.passed)]
    for margin in (margin for margin in marks.margins if margin.limit.silent):
        cells = plan.report.values.cells(margin.of.name)
        near = [cell.address for cell, out in zip(cells, marks.outside(margin), strict=True) if out]
        if near:
            found.append(f"{', '.join(near)}: {margin.limit.told}")
    return found


def _beyond(plan: Planned) -> Iterator[str]:
    """Where the curve would be known from no measurement."""
    name = next(iter(plan.u))  # what was chosen
    measured, planned = (each.values.value[name].tolist() for each in (plan.followed, plan.report))
    ends = min(measured), max(measured)
    rows = zip(plan.report.inputs.only.tests, planned, strict=True)
    if tests := [str(test) for test, value in rows if not ends[0] <= value <= ends[1]]:
        there = f"test{'s' * (len(tests) > 1)} {listing(tests, last='and')}"
        cells = list(plan.followed.values.cells(name))
        known = span(*(plan.followed.text(cells[measured.index(end)]) for end in ends))
        yield f"{there}: {name} beyond what was measured, {known}; the curve is extrapolated there"


def _best(plan: Planned) -> str:
    best = plan.best
    assert best is not None
    name = plan.budget.name
    found = f"the best of {best.tried} choices that were tried"
    if math.isinf(best.u_equal):
        return f"{found}; with equal steps {plan.budget.cell} has no uncertainty to compare"
    worse = percent(best.u_equal / best.u - 1)
    return f"{found}; with equal steps u is {plan.report.sure(name, best.u_equal).text}, {worse} larger"


def _needed(plan: Planned) -> str:
    needed, report = plan.needed, plan.report
    assert needed is not None
    cell = plan.budget.cell
    unit = behind(report.shown[plan.budget.name].unit)
    asked = report.sure(plan.budget.name, needed.wanted).text
    wanted = f"u({cell}) = {asked}{unit}"
    if needed.is_out_of_reach:
        if math.isinf(needed.others):
            return f"no u({needed.of}) gives {wanted}: {cell} has no uncertainty"
        others = report.sure(plan.budget.name, needed.others).text
        if others == asked:  # by digits that are not shown
            others = rounded(needed.others / report.shown[plan.budget.name].scale, 4).text
        return f"no u({needed.of}) is small enough for {wanted}: without it the others alone make {others}"
    if math.isinf(needed.u):
        return f"any u({needed.of}) is small enough for {wanted}"
    how = report.shown[needed.of]
    # Rounded down, so that what is told is small enough.
    return f"{wanted} needs u({needed.of}) of at most {_floor(needed.u / how.scale)}{behind(how.unit)}"


def _floor(value: float) -> str:
    """Three digits, none of them rounded up."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 2) if value > 0 else 1.0
    return rounded(math.floor(value / unit) * unit, 3).text


def _blocks(plan: Planned) -> Iterator[Block]:
    """The planned tests, the cell, where its uncertainty comes from, and what there is to say."""
    yield [_curve(plan)]
    yield TextTable(_header(plan), [*_rows(plan)])
    yield [sentence(plan.report, plan.budget)]
    if parts := [(name, percent(share)) for name, share in plan.shares.items()]:
        yield TextTable(("what", "share"), parts)
    yield [*_said(plan)]


def _as_json(plan: Planned) -> str:
    """All digits, in SI."""
    report, budget, best, needed = plan.report, plan.budget, plan.best, plan.needed
    tests = [
        {
            "test": test,
            **{
                name: {"value": for_json(float(report.values.value[name][row])), "u": for_json(float(u[row]))}
                for name, u in plan.u.items()
            },
            "share": for_json(plan.of_tests[test]),
        }
        for row, test in enumerate(report.inputs.only.tests)
    ]
    told = {
        "schema": 1,
        "cell": budget.cell,
        "unit": report.sheet[budget.name].unit,
        "value": for_json(budget.value),
        "u": for_json(budget.u),
        "k": for_json(budget.factor),
        "U": for_json(budget.expanded),
        "level": for_json(budget.level),
        "second_order_share": for_json(budget.second / budget.u**2) if budget.u else 0.0,
        "curve": {name: for_json(plan.followed.values.scalar(name)) for name in plan.curve},
        "tests": tests,
        "shares": {name: for_json(share) for name, share in plan.shares.items()},
        "warnings": _warnings(plan),
        "best": best
        and {
            "between": best.ends,
            "u": for_json(best.u),
            "u_equal_steps": for_json(best.u_equal),
            "tried": best.tried,
        },
        "needed": needed
        and {
            "of": needed.of,
            "unit": report.sheet[needed.of].unit,
            "wanted": needed.wanted,
            "u": for_json(needed.u),
            "others": for_json(needed.others),
            "out_of_reach": needed.is_out_of_reach,
        },
    }
    return json.dumps(told, indent=1, ensure_ascii=False)


FORMATS: Mapping[str, Callable[[Planned], str]] = {**printers(_blocks), "json": _as_json}
"""What renders a plan, by the name of the format."""
