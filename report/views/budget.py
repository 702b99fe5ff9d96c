"""Where the uncertainty of a cell comes from, for a terminal, a pull request and a program."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ..cells.address import address
from ..distribution import Shape
from ..quantity import behind
from ..result import uncertain
from ..result.conformity import lines
from ..result.numbers import decimals, degrees_of_freedom, for_json, rounded, stated
from ..result.result import Report
from ..result.shares import foremost
from .blocks import Block, TextTable, printers

WIDER = 1.02
"""So many times u, a standard deviation of draws is another number."""
HEADER = ("source", "estimate", "u", "distribution", "dof", "contribution", "share")
_NONE = "—"
SHIFTED = 0.05
"""In standard uncertainties: so far from its expectation a given number is no estimate of it."""


@dataclass(frozen=True)
class Besides:
    """What is told beside a budget."""

    drawn: uncertain.Distributed | None = None
    """What draws told."""
    limited: Sequence[uncertain.Conformity] = ()
    """The cell beside its limits."""
    scattered: uncertain.Scattered | None = None
    """What the rows say that it was fitted to."""


NOTHING = Besides()


def sentence(report: Report, budget: uncertain.Budget) -> str:
    """The result in a line: ``alpha_mean = 1.3026, u = 0.0035, U = 0.0069 with k = 1.96 for 95 %``."""
    unit = behind(report.shown[budget.name].unit)
    if math.isnan(budget.value):
        return report.values.cell(budget.name, budget.label).reason
    if not budget.is_known:
        told = report.text(report.values.cell(budget.name, budget.label))
        why = f": {budget.unlooked}; use '{uncertain.draws_of(budget.cell)}'" if budget.unlooked else ""
        return f"{budget.cell} = {told}, and its uncertainty is not known{why}"
    if not budget.u:
        return f"{budget.cell} = {report.shown[budget.name].digits_of(budget.value)}{unit}, exactly"
    value, u = report.stated(budget.name, budget.value, budget.u)
    told = f"{budget.cell} = {value.text}{unit}, u = {u.text}{unit}"
    if math.isnan(budget.factor):
        return told
    _, expanded = report.stated(budget.name, budget.value, budget.expanded)
    return f"{told}, U = {expanded.text}{unit} with k = {rounded(budget.factor, 3).text} for {_level(budget)}"


def _blocks(report: Report, budget: uncertain.Budget, besides: Besides = NOTHING) -> Iterator[Block]:
    """The sentence, what limits say, a table of the sources, and what draws told."""
    said = [sentence(report, budget), *(line for each in besides.limited for line in lines(report, each))]
    told = [*notes(report, budget), *_of_scatter(report, budget, besides.scattered)]
    told += _of_draws(report, budget, besides.drawn)
    if rows := [_row(report, budget, each) for each in budget.contributions]:
        yield from (said, TextTable(HEADER, rows), told)
    else:
        yield [*said, *told]


def _as_json(report: Report, budget: uncertain.Budget, besides: Besides = NOTHING) -> str:
    """All digits, in SI."""
    by = {"scatter": _scatter(besides.scattered)} if besides.scattered else {}
    monte_carlo = {} if besides.drawn is None else {"monte_carlo": _drawn(besides.drawn)}
    conformity = {"conformity": _conformity(besides.limited[0])} if besides.limited else {}
    return json.dumps(
        {
            "schema": 1,
            "cell": budget.cell,
            "unit": report.sheet[budget.name].unit,
            "value": for_json(budget.value),
            "u": for_json(budget.u),
            "dof": for_json(budget.dof),
            "level": budget.level,
            "k": for_json(budget.factor),
            "k_from": budget.because,
            "U": for_json(budget.expanded),
            "second_order_share": for_json(budget.second / budget.u**2) if budget.u else 0.0,
            "second_order_unknown": budget.unlooked or None,
            "sources": [_source(each) for each in budget.contributions],
            "summed": {
                each.name: {"eigenvalues": each.eigenvalues, "rank": each.rank} for each in budget.summed
            },
            "correlations": [[*pair, r] for pair, r in budget.correlations.items()],
            **by,
            **monte_carlo,
            **conformity,
        },
        indent=1,
        ensure_ascii=False,
    )


def _scatter(by: uncertain.Scattered) -> dict[str, object]:
    return {"u": by.u, "dof": by.dof, "k": by.factor, "U": by.expanded}


FORMATS = {**printers(_blocks), "json": _as_json}
"""What renders a budget, by the name of the format."""


def _source(each: uncertain.Contribution) -> dict[str, object]:
    source = each.source
    return {
        "source": source.name,
        "estimate": each.estimate,
        "unit": each.unit,
        "u": source.u,
        "distribution": source.shape.value,
        "dof": for_json(source.dof),
        "sensitivity": for_json(each.sensitivity),
        "contribution": for_json(each.u),
        "share": for_json(each.share),
    }


def _row(report: Report, budget: uncertain.Budget, each: uncertain.Contribution) -> tuple[str, ...]:
    source = each.source
    name, row, _ = source.moves[0]
    (unit, _), (own, own_scale) = _unit(report, name), _unit(report, budget.name)
    printed = report.inputs.printed(name)[row]
    if printed is None:
        raise AssertionError(f"{source.name} is an error of an empty cell")
    estimate = f"{printed.text}{unit}"
    if source.origin and each.estimate is not None:  # its own value stands in the other report
        cell = address(name, report.values.labels(report.sheet[name])[row])
        estimate = f"{cell} = {report.stated(name, each.estimate, printed.u)[0].text}{unit}"
    contribution, _ = stated(each.u / own_scale, budget.u / own_scale, 3)
    return (
        source.name,
        _NONE if each.estimate is None else estimate,
        _NONE if source.u is None else f"{report.sure(name, source.u).text}{unit}",
        source.shape.value,
        "∞" if math.isinf(source.dof) else f"{source.dof:g}",
        f"{contribution.text}{own}",
        percent(each.share),
    )


def notes(report: Report, budget: uncertain.Budget, draws: str = "--draws") -> Iterator[str]:
    """What there is to say of a budget besides its numbers, a sentence each."""
    alike: dict[tuple[str, ...], list[str]] = {}
    columns = {each.source.name: each.source.moves[0][0] for each in budget.contributions}
    for pair, r in budget.correlations.items():
        alike.setdefault((*map(columns.__getitem__, pair), f"{r:g}"), []).append(" and ".join(pair))
    for (one, other, told), pairs in alike.items():
        yield f"{pairs[0] if len(pairs) == 1 else f'{one} and {other} of a row'} are correlated: {told}"
    tied = {name for pair in budget.correlations for name in pair}
    sources = (each.source for each in budget.contributions if each.source.name in tied)
    if any(source.shape not in (Shape.NORMAL, Shape.STUDENT) and not source.table for source in sources):
        yield "correlated errors are taken as normal, without the ends that are stated of them"
    for each in budget.contributions:
        law, (name, _, _) = each.source.law, each.source.moves[0]
        if law is not None and abs(law.mean) >= SHIFTED:
            off = law.mean * (each.source.u or 0.0)
            (unit, _), far = _unit(report, name), report.sure(name, abs(off)).text
            there = f"{far}{unit} {'above' if off > 0 else 'below'} the given number"
            yield f"the expectation of {each.source.name} lies {there}: {draws} counts it"
    if budget.unlooked and budget.is_known:
        said = f"terms of second order were not looked at: {budget.unlooked}"
        yield f"{said}; {budget.hold}, {draws} tells more"
    if budget.second:
        share = percent(budget.second / budget.u**2)
        yield f"terms of second order make {share} of the variance: {budget.hold}, {draws} tells more"
    if budget.is_known and budget.u:
        if not math.isinf(budget.dof) and not math.isnan(budget.dof):
            yield degrees_of_freedom(budget.dof).replace(" ", " effective ", 1)
        yield f"k {'is not known:' if math.isnan(budget.factor) else 'comes from'} {budget.because}"
    if (most := foremost(report, budget)) is not None:
        yield f"{most[0]} matters most: {percent(most[1])} of the variance"
    yield from map(_together, budget.summed)


def _together(summed: uncertain.Together) -> str:
    """How much cells that share their inputs tell: ``the 10 cells of alpha tell as much as 4 ...``."""
    larger = [rounded(value, 2).text for value in summed.eigenvalues[: summed.rank]]
    less = summed.eigenvalues[summed.rank :]
    told = ", ".join(larger) + (f", then {rounded(less[0], 1).text} and less" if less else "")
    cells = f"the {len(summed.eigenvalues)} cells of {summed.name}"
    rank = f"{summed.rank} at a tolerance of {uncertain.TOLERANCE}"
    return f"{cells} tell as much as {rank}: the eigenvalues of their correlation are {told}"


def _of_scatter(report: Report, budget: uncertain.Budget, found: uncertain.Scattered | None) -> Iterator[str]:
    """What the rows say of a number that was fitted to them, whatever is stated of them."""
    if found is None:
        return
    unit = behind(report.shown[budget.name].unit)
    u, expanded = (f"{report.sure(budget.name, each).text}{unit}" for each in (found.u, found.expanded))
    yield (
        f"by the scatter of what it was fitted to, u = {u}, U = {expanded} with k = "
        f"{rounded(found.factor, 3).text} for {_level(budget)} (Student's t, {degrees_of_freedom(found.dof)})"
    )


def _level(budget: uncertain.Budget) -> str:
    return f"{100 * budget.level:.12g} %"


def _of_draws(report: Report, budget: uncertain.Budget, drawn: uncertain.Distributed | None) -> Iterator[str]:
    """What Monte Carlo told."""
    if drawn is None:
        return
    how = report.shown[budget.name]
    unit = behind(how.unit)
    u = drawn.u if math.isfinite(drawn.u) else budget.u

    def told(value: float) -> str:
        if not math.isfinite(u):
            return rounded(how.of(value), how.digits).text
        return report.stated(budget.name, value, u)[0].text

    def apart(value: float) -> str:
        return told(abs(value - budget.value) + how.zero)

    def wide(width: float) -> str:
        return report.sure(budget.name, max(width, 0.0)).text

    yield f"Monte Carlo, {drawn.number} draws: median {told(drawn.median)}{unit}" + (
        f", u = {report.sure(budget.name, drawn.u).text}{unit}" if math.isfinite(drawn.u) else ""
    )
    if drawn.u > WIDER * budget.u and any(math.isfinite(each.source.dof) for each in budget.contributions):
        yield (
            "errors that are known with few degrees of freedom are drawn from t distributions, whose "
            "standard deviation is larger than u (JCGM 101, 6.4.9)"
        )
    if drawn.lost:
        lost = f"{drawn.lost} of them ({percent(drawn.lost / drawn.number)}) have no value"
        if report.sheet.axes:
            yield (
                f"{lost}, or one of sums over other rows than the estimate's: all this is given that every "
                "row which the estimate uses has a value, and no other"
            )
        else:
            yield f"{lost}: all this is given that there is one"
    if math.isnan(drawn.u):
        what = "standard deviation" if math.isfinite(drawn.mean) else "mean and no standard deviation"
        yield f"there is no {what}: the tails fall as the power {drawn.tail:.2g} of the distance"
    if math.isnan(drawn.symmetric[0]):
        yield "no interval is told: too many draws have no value"
        return
    level = _level(budget)
    for name, (low, high) in (("equal tails", drawn.symmetric), ("the shortest", drawn.shortest)):
        around = ""  # where the estimate lies outside, it has no such distances
        if low <= budget.value <= high:
            around = f"; {told(budget.value)} +{apart(high)}/-{apart(low)}"
        yield f"{level} between {told(low)} and {told(high)}{unit} ({name}{around})"
    if not drawn.stable:
        yield "its ends are not known to the second digit of u: more draws would tell"
    if not budget.is_known:
        return  # of a sheet that is too large: there is nothing to compare with
    if not math.isfinite(budget.factor):
        yield "the law of propagation tells no interval to compare with"
        return
    far, (low, high) = wide(max(drawn.differences)), drawn.symmetric
    if drawn.validates:
        yield f"the law of propagation gives the same interval within {far}{unit}"
    elif low <= budget.value <= high:
        yield f"the law of propagation is off by {far}{unit} at an end: the interval of the draws holds"
    else:
        side, way = ("below", "up") if budget.value < low else ("above", "down")
        yield (
            f"the law of propagation is off by {far}{unit} at an end, and the estimate lies {side} the "
            f"draws: errors move it {way}, as they move a range or a standard deviation up, so that neither "
            "interval is about the estimate"
        )


def _drawn(drawn: uncertain.Distributed) -> dict[str, object]:
    return {
        "draws": drawn.number,
        "without_value": drawn.lost,
        "median": for_json(drawn.median),
        "mean": for_json(drawn.mean),
        "u": for_json(drawn.u),
        "interval": list(map(for_json, drawn.symmetric)),
        "shortest": list(map(for_json, drawn.shortest)),
        "tail_index": for_json(drawn.tail),
        "stable": drawn.stable,
        "tolerance": drawn.tolerance,
        "differences": list(map(for_json, drawn.differences)),
        "validates": drawn.validates,
    }


def _conformity(found: uncertain.Conformity) -> dict[str, object]:
    return {
        "limits": list(map(for_json, found.limits.ends)),
        "level": found.limits.guard.level,
        "guard": for_json(found.guard),
        "acceptance": list(map(for_json, found.acceptance)),
        "decision": found.decision.value,
        "because": found.because,
        "distribution": found.by.shape.value,
        "probability": for_json(found.probability),
        "below": for_json(found.below),
        "above": for_json(found.above),
        "consumer_risk": for_json(found.consumer_risk),
        "producer_risk": for_json(found.producer_risk),
    }


def percent(share: float) -> str:
    """A share as it is shown."""
    return f"{decimals(100 * share, 1).text} %"


def _unit(report: Report, name: str) -> tuple[str, float]:
    how = report.shown[name]
    return behind(how.unit), how.scale
