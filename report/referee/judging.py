"""The referee at work: every value, every table, all of them together, and what would explain them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ..cells.values import Values
from ..inputs.inputs import Inputs
from ..inputs.published import PublishedValue
from ..result.verdict import (
    ALL,
    EXACT,
    INPUT,
    NOT_CHECKABLE,
    NOT_FOUND,
    OTHERS,
    REACHABLE,
    UNREACHABLE,
    WITHIN,
    Change,
    Explanation,
    Fit,
    Referee,
    Relabelled,
    TableVerdict,
    Tried,
    Verdict,
)
from ..sheet import Given, Sheet
from .campaign import Campaign
from .certificate import Certificate
from .comparison import missing_as_expected, prints_same
from .explain import explanations, possibilities
from .labels import Numbers, fits, labels
from .minimax import Best, counted, meet
from .problem import Problem
from .search import Explained, Search
from .values import verdicts

NEAR = (EXACT, REACHABLE, WITHIN)
"""Of values that are not out of reach by themselves."""
MORE = 1.01
"""How much more certain a table must make it than all tables together, to be named."""


def referee(
    sheet: Sheet,
    inputs: Inputs,
    values: Values,
    data: Mapping[str, Any],
    step: Callable[[str], None],
    numbers: Callable[[], Numbers],
) -> Referee:
    """Judge all published values of a report.

    Parameters
    ----------
    values : Values
        As recomputed from what is printed.
    data : mapping of column name to float or sequence of float
        The given columns in SI.
    step : callable
        Told what is begun.
    numbers : callable
        Returns the source's numbers of the columns' equations.
    """
    published = inputs.published
    if not published:
        return Referee(free=inputs.free)
    campaign = Campaign(sheet, inputs, values, data, inputs.free)
    step("refereeing each published value")
    alone = verdicts(campaign, published)
    checkable = [
        value for value, verdict in zip(published, alone, strict=True) if verdict.verdict != NOT_CHECKABLE
    ]
    if not checkable:
        return Referee(alone, free=inputs.free)
    whole = Problem.of(campaign, checkable)
    certificate = Certificate(whole)
    tables = []
    for source in dict.fromkeys(value.source for value in published):
        step(f"refereeing {source}")
        which = [n for n, value in enumerate(checkable) if value.source == source]
        if which:
            tables.append(_together(source, whole, which, certificate, alone, published)[0])
        else:
            tables.append(TableVerdict(source, 0, NOT_CHECKABLE))
    step("refereeing all tables together")
    joint, found = _together(ALL, whole, list(range(len(checkable))), certificate, alone, published, tables)
    if joint.mismatch is None:
        return Referee(alone, tuple(tables), joint, free=inputs.free)
    near = [value for value, verdict in zip(published, alone, strict=True) if verdict.verdict in NEAR]
    asked = [value for value in near if not value.expect]
    others = _of_others(whole, asked, joint, certificate)
    if campaign.states:
        for n, table in enumerate(tables):
            own = [value for value in checkable if value.source == table.source]
            tables[n] = _allowed(campaign, table, own, near)
        joint = _allowed(campaign, joint, checkable, near)
        others = others and _allowed(campaign, others, asked, near)
    explained = slips = pinned = tuple[Explained, ...]()
    tried: Tried | None = None
    there = [value for value in published if not _is_gone(campaign, value)]
    if len(checkable) < len(there):
        # What was published once had a value: a change must give it one.
        whole = Problem.of(campaign, there)
        found = meet(whole)
    if found.mismatch > 1 and joint.verdict == WITHIN:
        step("refereeing what a habit or one slip would explain")
        slips = possibilities(whole)
    elif found.mismatch > 1:
        explained, tried, pinned = _explained(whole, step)
    named, fit = tuple[Relabelled, ...](), tuple[Fit, ...]()
    if explained or found.mismatch <= 1:
        step("refereeing names of rows and fits")
        first = explained[0] if explained else None
        named = labels(whole, numbers(), first)
        fit = fits(whole, inputs.workbook.fits, first)
    amended, misprints = _amended(campaign, checkable, step)
    told = partial(_told, values)
    return Referee(
        values=alone,
        tables=tuple(tables),
        joint=joint,
        explanations=told(explained),
        tried=tried,
        labels=named,
        fits=fit,
        free=inputs.free,
        errata=_known(inputs),
        amended=amended,
        misprints=told(misprints),
        slips=told(slips),
        others=others,
        pinned=told(pinned),
    )


def _of_others(
    whole: Problem, asked: Sequence[PublishedValue], joint: TableVerdict, certificate: Certificate
) -> TableVerdict | None:
    """The values not known to differ, together, where all do not come out: None without such values."""
    if joint.verdict in (EXACT, REACHABLE) or not asked or not any(value.expect for value in whole.published):
        return None
    which = [n for n, value in enumerate(whole.published) if value in asked]
    return _together(OTHERS, whole, which, certificate, (), ())[0]


def _told(values: Values, explained: Sequence[Explained]) -> tuple[Explanation, ...]:
    """Explanations, in which groups are called by their words."""

    def word(change: Change, label: tuple[int, ...]) -> str:
        return values.word(values.sheet[change.cell], label) if label and change.cell else ""

    return tuple(
        replace(
            found.explanation,
            changes=tuple(
                replace(change, words=(word(change, change.index), word(change, change.other)))
                for change in found.explanation.changes
            ),
        )
        for found in explained
    )


def _is_gone(campaign: Campaign, published: PublishedValue) -> bool:
    """Whether no change of what is printed gives its cell a value: for want of a datum, or as is expected."""
    values, inputs = campaign.values, campaign.inputs
    cell = values.cell(published.cell, published.index)
    begun = cell.culprit or cell
    column = values.sheet[begun.name]
    printed = inputs.printed(begun.name) if isinstance(column.rule, Given) else ()
    is_empty = bool(printed) and printed[values.row(column, begun.label)] is None
    return is_empty or missing_as_expected(cell, values, inputs.expected)


def _explained(
    whole: Problem, step: Callable[[str], None]
) -> tuple[tuple[Explained, ...], Tried, tuple[Explained, ...]]:
    """What would explain all; or with less changes what is not known to differ, if that does not come out.

    Last, what explains the known differences by themselves: another wrong value does not make theirs wrong.
    """
    explained, tried = explanations(whole, step)
    known = {
        n for n, value in enumerate(whole.published)
        if value.pin is not None and value.pin.holds(value.printed, value.pin.again)
    }  # fmt: skip
    rest = whole.ignoring(known)
    if not known or (explained and explained[0].explanation.count <= 1) or meet(rest).mismatch <= 1:
        return explained, tried, ()
    others, looked = explanations(rest, step)
    if others and (not explained or others[0].explanation.count < explained[0].explanation.count):
        explained, tried = others, looked
    new = set(Search(whole).differing) - known
    if not new or not any(whole.published[n].explained for n in known):
        return explained, tried, ()
    alone = whole.ignoring(new)
    return explained, tried, explanations(alone, step)[0] if meet(alone).mismatch > 1 else ()


def _allowed(
    campaign: Campaign,
    table: TableVerdict,
    asked: Sequence[PublishedValue],
    near: Sequence[PublishedValue],
) -> TableVerdict:
    """A table, with another word if the digits do not allow it and the stated uncertainties do.

    Each value by itself has to be as near as its own uncertainty says, and all of them have to come out of
    one input, each number of which is as near to its print as is stated of it.
    """
    if table.possible or not all(value in near for value in asked):
        return table
    problem = Problem.of(replace(campaign, stated=True), asked)
    found = counted(problem, meet(problem))
    if found.mismatch > 1:
        return table
    return replace(table, verdict=WITHIN, witness=problem.witness(found.point), because="", out=0)


def _known(inputs: Inputs) -> tuple[Change, ...]:
    """The misprints of the input that the report states."""
    return tuple(
        Change("misprint", name, (inputs.of(name).tests[row],), INPUT, printed.text, again.text)
        for (name, row), again in inputs.errata.items()
        if (printed := inputs.measured[name][row]) is not None
    )


def _amended(
    campaign: Campaign, published: Sequence[PublishedValue], step: Callable[[str], None]
) -> tuple[TableVerdict | None, tuple[Explained, ...]]:
    """Whether everything comes out with the known misprints put right, and if not, what else is wrong."""
    if not campaign.inputs.errata:
        return None, ()
    step("refereeing with the known misprints put right")
    inputs = campaign.inputs.amended
    problem = Problem.of(replace(campaign, inputs=inputs), published)
    which = list(range(len(problem.published)))
    verdict, found = _together(ALL, problem, which, Certificate(problem), (), ())
    return verdict, explanations(problem, step)[0] if found.mismatch > 1 else ()


def _together(
    source: str,
    whole: Problem,
    which: Sequence[int],
    certificate: Certificate,
    alone: Sequence[Verdict],
    published: Sequence[PublishedValue],
    parts: Sequence[TableVerdict] = (),
) -> tuple[TableVerdict, Best]:
    """Whether some of the values come out of one input."""
    problem = whole.only(which)
    found = counted(problem, meet(problem))
    if not np.isfinite(found.mismatch):
        return TableVerdict(source, len(which), NOT_CHECKABLE), found
    exact = all(
        prints_same(float(cell), value.printed)
        for cell, value in zip(problem.evaluate(problem.box.start[None])[0], problem.published, strict=True)
    )
    # Many are as far off as the worst; those that press are why.
    pressing = np.abs(found.weights) if found.weights.any() else np.abs(problem.mismatch(found.cells))
    worst = problem.published[int(np.argmax(pressing))]
    at_least, because = 0.0, ""
    out = [
        value for value, verdict in zip(published, alone, strict=True)
        if verdict.verdict == UNREACHABLE and source in (ALL, value.source)
    ]  # fmt: skip
    if exact:
        word = EXACT
    elif found.mismatch <= 1:
        word = REACHABLE
    else:
        weights = np.zeros(len(whole.published))
        weights[list(which)] = found.weights
        at_least = certificate.at_least(weights)
        for part in parts:
            if (part.at_least or 0) > MORE * at_least:
                at_least, because = part.at_least or 0, part.source
        word = UNREACHABLE if at_least > 1 or out else NOT_FOUND
    verdict = TableVerdict(
        source,
        values=len(which),
        verdict=word,
        mismatch=found.mismatch,
        at_least=at_least if at_least > 1 else None,
        worst=worst,
        witness=problem.witness(found.point),
        because=because,
        out=len(out),
    )
    return verdict, found
