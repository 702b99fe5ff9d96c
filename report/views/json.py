"""values.json and manifest.json: the results for programs."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from msgspec import UNSET, UnsetType

from ..cells.marks import MarkCount
from ..cells.values import Status
from ..document.written import text_of
from ..files import values as form
from ..files.form import SCHEMA, alike, text
from ..files.manifest import Manifest
from ..laws import TruncatedNormal
from ..machine.staging import put
from ..messages.diagnostics import Check
from ..result import verdict_data
from ..result.conformity import accepted
from ..result.numbers import for_json
from ..result.result import Comparison, Report
from ..result.uncertain import Budget, Conformity, ErrorSource
from ..result.verdict import Verdict
from ..sheet import Column, Formula, RepeatAxis
from .issued import Issued


def write(made: Issued, stage: Path) -> None:
    """Write values.json."""
    put(stage / "values.json", values(made.report))


def values(report: Report) -> str:
    """All cells in SI, unrounded, with their statuses; the proofs; the published values.

    The rows that an axis makes of each row of another are as many as pairs times points: they follow
    from the rows of that one by the rule that is told, and are counted only.
    """
    return text(
        form.Result(
            schema=SCHEMA,
            workbook=report.workbook.name,
            title=report.title,
            headline=[name for name in report.workbook.headline if name in report.sheet],
            aside=[column.name for column in report.sheet.columns if column.name in report.workbook.aside],
            cells={column.name: _column(report, column) for column in report.sheet.columns},
            words={
                axis: {label[0]: word for label, word in words.items()}
                for axis, words in report.values.words.items()
            }
            or UNSET,
            oddities=oddities(report.oddities),
            expanded=[_expanded(budget) for budget in report.uncertain().budgets if budget.is_known] or UNSET,
            conformity=[_decided(report, each) for each in report.uncertain().conformities] or UNSET,
            proofs=proof_statuses(report),
            rests_on=proof_grounds(report),
            errata=[alike(erratum, form.Erratum) for erratum in report.errata],
            published=[_published(comparison) for comparison in report.comparisons],
            published_u=[_published(comparison) for comparison in report.comparisons_u] or UNSET,
            influences=_influences(report),
            referee=UNSET if report.referee.joint is None else verdict_data.data(report.referee),
        )
    )


def oddities(checks: Iterable[Check]) -> list[form.Oddity]:
    """What is told of the data, without the place: a file that is carried away names no path."""
    return [
        form.Oddity(kind=check.kind, name=check.name, word=check.word, sentence=check.message)
        for check in checks
        if check.word
    ]


def _expanded(budget: Budget) -> form.Expanded:
    expanded, factor, dof = (_short(each) for each in (budget.expanded, budget.factor, budget.dof))
    return form.Expanded(cell=budget.cell, U=expanded, k=factor, level=budget.level, dof=dof)


def _decided(report: Report, found: Conformity) -> form.Conformity:
    low, high = map(for_json, found.acceptance)
    return form.Conformity(
        cell=found.budget.cell,
        limits=str(found.limits),
        acceptance=(low, high),
        accepted=accepted(report, found) if found.guard > 0 else "",
        probability=for_json(found.probability),
        decision=found.decision.value,
    )


def _column(report: Report, column: Column) -> form.Column:
    values, statuses = report.values.value[column.name], report.values.status[column.name]
    if isinstance(column.axis, RepeatAxis) and isinstance(column.rule, Formula):
        return _generated(report, column, column.axis)
    numbers = [float(v) if s == Status.OK else None for v, s in zip(values, statuses, strict=True)]
    codes = [Status(int(s)).code for s in statuses]

    def told(rows: list[Any]) -> Any:
        return rows[0] if column.axis is None else rows

    entry: dict[str, Any] = {}
    if column.axis is not None:
        labels = report.values.layouts[column.axis.name].labels.tolist()
        index = [label[0] for label in labels] if len(labels[0]) == 1 else list(map(tuple, labels))
        entry = {"axis": column.axis.name, "index": index}
    if (how := report.shown[column.name]).unit != column.unit:
        entry["shown"] = how.as_data
    if column.name in report.values.roots:
        reasons = [cell.reason or None for cell in report.values.cells(column.name)]
        entry["reason"] = told(reasons)
    if column.name in (known := report.uncertain().u):
        entry["u"] = told([_short(u) for u in known[column.name].tolist()])
    if column.limits:
        marks = [mark or None for mark in report.marks.of(column.name)]
        entry["mark"] = told(marks)
    if column.name in report.values.counted:
        entry["rows"] = dict(report.values.counted[column.name])
    if marked := [_marked(count) for count in report.marks.behind(column) if count.number]:
        entry["marked"] = marked
    printed = [each.text if each else None for each in report.printed(column.name)]
    shown = printed or [each.plain if each else None for each in report.figures(column.name)]
    return form.Column(
        unit=column.unit,
        rule=_rule(report, column),
        value=told(numbers),
        text=told(shown),
        status=told(codes),
        **entry,
    )


def _generated(report: Report, column: Column, axis: RepeatAxis) -> form.Column:
    """How many generated rows a column has, by their status."""
    codes, sizes = np.unique(report.values.status[column.name], return_counts=True)
    return form.Column(
        axis=axis.name,
        of=axis.of.name,
        unit=column.unit,
        rule=_rule(report, column),
        size=report.values.layouts[axis.name].size,
        status={Status(code).code: size for code, size in zip(codes.tolist(), sizes.tolist(), strict=True)},
    )


def _marked(count: MarkCount) -> form.Marked:
    """How many of the rows that a scalar rests on carry a mark."""
    margin = count.margin
    return form.Marked(cell=margin.of.name, mark=margin.limit.mark, rows=count.number, of=count.size)


def _rule(report: Report, column: Column) -> str:
    """What makes its values: its equation with its number, or ``given``."""
    if column.equation is None:
        return "given"
    return f"{column.source} {text_of(column.equation, report.ledger.vocabulary)}"


def _influences(report: Report) -> form.Influences | UnsetType:
    """What other reports need, so that what they take shares errors with all else that rests on them."""
    found = report.uncertain().influence
    if found is None or not found.sources:
        return UNSET
    files = "".join(f"{name}\n{digest}\n" for name, digest in _hashes(report.inputs.files).items())
    return form.Influences(
        inputs=hashlib.sha256(files.encode()).hexdigest(),
        sources=[_error(source) for source in found.sources],
        cells={name: list(map(_fifteen, moved)) for name, moved in found.cells.items()},
        rows={name: [(n, _fifteen(each)) for n, each in moved] for name, moved in found.rows.items()}
        or UNSET,
        second={name: _fifteen(each) for name, each in found.second.items()},
        doubts=dict(found.doubts),
        correlations=list(found.correlations),
    )


def _fifteen(u: float) -> float:
    """With the digits that a double surely holds."""
    return float(f"{u:.15g}")


def _error(source: ErrorSource) -> form.Source:
    """A source, by its name where it was stated."""
    report, name = source.origin or ("", source.name)
    dof, law = for_json(source.dof), source.law
    ends = (for_json(law.low), for_json(law.high)) if isinstance(law, TruncatedNormal) else UNSET
    return form.Source(
        name=name, report=report, distribution=source.shape.value, ends=ends, dof=dof, sample=source.sample
    )


def _short(u: float) -> float | None:
    """A standard uncertainty with the digits that no processor changes."""
    return float(f"{u:.9g}") if math.isfinite(u) else None


def proof_statuses(report: Report) -> dict[str, str]:
    """Status by number; a number with several lines also has the worst status of its lines."""
    order = [
        "refuted",
        "refused",
        "undecided",
        "proved with a correction of the print",
        "proved",
        "limit",
        "assumption",
        "definition",
    ]
    found: dict[str, str] = {}
    for proof in report.proofs:
        equation, status = proof.equation, proof.status.value
        if equation.part:
            known = found.get(equation.number, status)
            found[equation.number] = min(known, status, key=order.index)
    for proof in report.proofs:
        found[proof.equation.label] = proof.status.value
    return dict(sorted(found.items(), key=lambda item: _natural(item[0])))


def proof_grounds(report: Report) -> dict[str, list[str]]:
    """What each proved claim finally rests on: numbers, and titles of what has none."""
    return {p.equation.label: list(p.rests_on) for p in report.proofs if p.steps and p.status.passes}


def _natural(label: str) -> tuple[bool, int, str]:
    digits = "".join(c for c in label if c.isdigit())
    return (label.startswith("(L"), int(digits or 0), label)


def _published(comparison: Comparison) -> form.Published:
    value = comparison.published
    return form.Published(
        source=value.source,
        cell=value.cell,
        index=list(value.index),
        printed=value.printed.text,
        unit=value.printed.unit,
        value=comparison.cell.value,
        again=comparison.again,
        distance=comparison.distance,
        verdict=comparison.word,
        interval=_interval(comparison.refereed),
        bounds=verdict_data.bounds(comparison.refereed),
        expected=comparison.as_expected,
        finding=comparison.finding or None,
    )


def _interval(verdict: Verdict | None) -> list[float | None] | None:
    """What inputs that print as given were seen to yield, in SI."""
    return None if verdict is None or verdict.low is None else [verdict.low, verdict.high]


def manifest(report: Report, outputs: Mapping[str, bytes], sources: Mapping[str, str], processor: str) -> str:
    """What went in, what came out and what computed it, by content; no clock and no place.

    Parameters
    ----------
    outputs : mapping of str to bytes
        Every file that was written, by its name in the output folder.
    sources : mapping of str to str
        The sha256 of the parts of this program.
    processor : str
        On which it ran.
    """
    return text(
        Manifest(
            schema=SCHEMA,
            title=report.title,
            inputs=_hashes(report.inputs.files),
            outputs=_hashes(outputs),
            sources=dict(sources),
            versions=dict(report.versions),
            engines={agreement.engine: agreement.program for agreement in report.engines},
            processor=processor,
            values="as doubles compute them" if report.exactly is None else "correctly rounded",
        )
    )


def _hashes(files: Mapping[str, bytes]) -> dict[str, str]:
    return {name: hashlib.sha256(content).hexdigest() for name, content in sorted(files.items())}
