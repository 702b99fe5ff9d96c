"""Where the uncertainty of a cell comes from, for a terminal, a pull request and a program."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping

from ..document.numbers import decimals, rounded, stated
from ..result.result import Report
from ..result.uncertain import Budget, Contribution
from . import markdown as md

__all__ = ["FORMATS", "as_json", "as_markdown", "as_text", "sentence"]

HEADER = ("source", "estimate", "u", "distribution", "dof", "contribution", "share")
_NONE = "—"


def sentence(report: Report, budget: Budget) -> str:
    """The result in a line: ``alpha_mean = 1.3026, u = 0.0035, U = 0.0069 with k = 1.96 for 95 %``."""
    unit, scale = _unit(report, budget.name)
    if math.isnan(budget.value):
        return f"{budget.cell} has no value"
    if not budget.is_known:
        return f"{budget.cell} = {budget.value / scale:.6g}{unit}, and its uncertainty is not known"
    if not budget.u:
        return f"{budget.cell} = {budget.value / scale!r}{unit}, exactly"
    value, u = stated(budget.value / scale, budget.u / scale)
    told = f"{budget.cell} = {value.text}{unit}, u = {u.text}{unit}"
    if math.isnan(budget.factor):
        return told
    level = f"{100 * budget.level:.12g} %"
    _, expanded = stated(budget.value / scale, budget.expanded / scale)
    return f"{told}, U = {expanded.text}{unit} with k = {rounded(budget.factor, 3).text} for {level}"


def as_text(report: Report, budget: Budget) -> str:
    """The sentence, and a table of the sources."""
    lines = [sentence(report, budget)]
    rows = [HEADER, *(_row(report, budget, each) for each in budget.contributions)]
    if len(rows) > 1:
        widths = [max(len(row[n]) for row in rows) for n in range(len(HEADER))]
        lines += [
            "",
            *("  ".join(f"{text:{w}}" for text, w in zip(row, widths, strict=True)).rstrip() for row in rows),
        ]
        lines.append("")
    return "\n".join([*lines, *_notes(report, budget)])


def as_markdown(report: Report, budget: Budget) -> str:
    """The same for a pull request."""
    rows = [[md.cell(text) for text in _row(report, budget, each)] for each in budget.contributions]
    notes = "".join(f"\n{md.cell(note)}\n" for note in _notes(report, budget))
    return f"{md.cell(sentence(report, budget))}\n\n{md.table(HEADER, rows) if rows else ''}{notes}".rstrip()


def as_json(report: Report, budget: Budget) -> str:
    """All digits, in SI."""
    return json.dumps(
        {
            "schema": 1,
            "cell": budget.cell,
            "unit": report.sheet[budget.name].unit,
            "value": _number(budget.value),
            "u": _number(budget.u),
            "dof": _number(budget.dof),
            "level": budget.level,
            "k": _number(budget.factor),
            "k_from": budget.because,
            "U": _number(budget.expanded),
            "second_order_share": _number(budget.second / budget.u**2) if budget.u else 0.0,
            "sources": [_source(each) for each in budget.contributions],
            "correlations": [[*pair, r] for pair, r in budget.correlations.items()],
        },
        indent=1,
        ensure_ascii=False,
    )


FORMATS: Mapping[str, Callable[[Report, Budget], str]] = {
    "text": as_text,
    "markdown": as_markdown,
    "json": as_json,
}
"""What renders a budget, by the name of the format."""


def _source(each: Contribution) -> dict[str, object]:
    source = each.source
    return {
        "source": source.name,
        "estimate": each.estimate,
        "unit": each.unit,
        "u": source.u,
        "distribution": source.shape.value,
        "dof": _number(source.dof),
        "sensitivity": _number(each.sensitivity),
        "contribution": _number(each.u),
        "share": _number(each.share),
    }


def _row(report: Report, budget: Budget, each: Contribution) -> tuple[str, ...]:
    source = each.source
    name = source.moves[0][0]
    unit, scale = _unit(report, name)
    own, own_scale = _unit(report, budget.name)
    estimate = f"{report.inputs.printed(name)[source.moves[0][1]].text}{unit}"
    contribution, _ = stated(each.u / own_scale, budget.u / own_scale, 3)
    return (
        source.name,
        _NONE if each.estimate is None else estimate,
        _NONE if source.u is None else f"{rounded(source.u / scale, 2).text}{unit}",
        source.shape.value,
        "∞" if math.isinf(source.dof) else f"{source.dof:g}",
        f"{contribution.text}{own}",
        _percent(each.share),
    )


def _notes(report: Report, budget: Budget) -> Iterator[str]:
    for (one, other), r in budget.correlations.items():
        yield f"{one} and {other} are correlated: {r:g}"
    if budget.second:
        yield f"terms of second order make {_percent(budget.second / budget.u**2)} of the variance"
    if budget.is_known and budget.u:
        if not math.isinf(budget.dof) and not math.isnan(budget.dof):
            yield f"{budget.dof:.0f} effective degrees of freedom"
        yield f"k comes from {budget.because}"


def _percent(share: float) -> str:
    return f"{decimals(100 * share, 1).text} %"


def _unit(report: Report, name: str) -> tuple[str, float]:
    how = report.shown[name]
    return ("" if how.unit == "1" else f" {how.unit}"), how.scale


def _number(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
