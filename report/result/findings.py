"""What is checked of a report: one list of checks, which every output of findings reads.

The command line, the formats for machines and the pytest plugin all take a tuple of :class:`Check`. To have
another kind of check, add a function here that makes them and its line in :func:`checks`.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ...derivations.unit_text import parse_unit
from ..cells.address import address
from ..messages.diagnostics import Check, Diagnostic, Location
from . import verdict_words as words
from .conformity import probabilities, sentence, undecided
from .uncertain import Conformity, Decision
from .verdict import OTHERWISE, UNAMENDED, UNEXPLAINED, UNPINNED, UNREASONED

if TYPE_CHECKING:
    from ...derivations.proved import Proof
    from ..inputs.inputs import Inputs
    from ..inputs.published import PublishedValue
    from .agreement import Agreement
    from .result import Comparison, Report

CONFORMITY = "conformity"
"""The kind of the checks of limits."""
NEAR_A_POWER = 0.05
"""So far from a power of ten, as a share of it, the ratio of recomputed and published may be."""
NEAR_THE_ZERO = 0.5
"""So far, in kelvins, from the zero of degC a difference of temperatures may be that comes from it."""
PLAIN = 6
"""Up to this exponent powers of ten are written out."""
MOST_NAMED = 5
"""Of the findings about an engine; one wrong formula spoils many cells."""


def checks(report: Report) -> tuple[Check, ...]:
    """Everything that was checked of a report, in the order in which it is told."""
    every = (*report.comparisons, *report.comparisons_u)
    return (
        *(of_engine(agreement, report.inputs) for agreement in report.engines),
        *(of_proof(proof, report.inputs) for proof in report.proofs),
        *map(of_comparison, every, names_of(c.published for c in every)),
        *of_referee(report),
        *report.oddities,
        *(
            of_limits(each, report)
            for each in (report.uncertain().conformities if report.inputs.limits else ())
        ),
        *(
            Check(CONFORMITY, each.address, False, undecided(each), each.at)
            for each in report.inputs.undecided
        ),
    )


def of_proof(proof: Proof, inputs: Inputs) -> Check:
    """Whether an equation stands."""
    label, status = proof.equation.label, proof.status
    said = f"{label} is {status.value}"
    if not status.passes:
        said += f": {next((s.sentence for s in proof.steps if not s.status.passes), proof.remark)}"
    return Check("proof", label, status.passes, said, inputs.place)


def of_engine(agreement: Agreement, inputs: Inputs) -> Check:
    """Whether an engine agrees with 50 digits."""
    at = inputs.place
    if agreement.absent:
        said = f"{agreement.engine} was not compared: {agreement.absent}"
        return Check("engine", agreement.engine, True, said, at, skipped=True)
    more = len(agreement.findings) - MOST_NAMED
    named = [*agreement.findings[:MOST_NAMED], *([f"and {more} more"] if more > 0 else [])]
    said = "; ".join(named) or agreement.summary
    return Check("engine", agreement.engine, not agreement.findings, said, at)


def of_comparison(comparison: Comparison, name: str) -> Check:
    """Whether a published value is what is expected of it.

    `name`: as from :func:`names_of`.
    """
    published, cell = comparison.published, comparison.cell
    said = f"{published.source} {cell.address} prints {published.printed.text}"
    skipped = cell.value is None and not published.expect and comparison.as_expected
    if skipped or (cell.value is None and not comparison.as_expected):
        said = f"{published.source} {cell.address} cannot be checked: {cell.reason}"
    elif published.expect and comparison.verdict == "same":
        said += f" and no longer differs; drop its '{published.expect}'"
    elif published.expect and not comparison.as_expected:
        said += f", recomputed {comparison.again}{_misplaced(comparison)}, and {_otherwise(comparison)}"
    else:
        said += f", recomputed {comparison.again}{_misplaced(comparison)} ({_word(comparison)})"
        said += f": {published.reason}" if published.reason else ""
    field = {UNPINNED: "recomputed", UNREASONED: "reason", UNEXPLAINED: "explained"}
    places = published.places
    at = places.get(field.get(comparison.finding, ""), places.get("value", Location()))
    return Check("published", name, comparison.as_expected, said, at, skipped=skipped)


def _misplaced(comparison: Comparison) -> str:
    """What one that is not as expected may be due to: another uncertainty, a power of ten, a zero."""
    cell, printed = comparison.cell, comparison.published.printed
    if comparison.as_expected or cell.value is None or not printed.number:
        return ""
    here, there = printed.of(cell.value), float(printed.number)
    if comparison.instead:
        return f", and {comparison.instead} would print so"
    is_temperature = printed.unit in ("K", "degC", "°C")
    if is_temperature and abs(abs(here - there) - float(parse_unit("degC").zero)) < NEAR_THE_ZERO:
        return ", perhaps printed in K for degC, or the reverse"
    ratio = here / there
    if not 0 < ratio < math.inf:
        return ""
    power = round(math.log10(ratio))
    if not power or abs(ratio / 10.0**power - 1) > NEAR_A_POWER:
        return ""
    times = 10 ** abs(power) if abs(power) <= PLAIN else f"1e{abs(power)}"
    size = "large" if power > 0 else "small"
    return f", about {times} times as {size}, perhaps by a unit or a decimal point"


def of_limits(found: Conformity, report: Report) -> Check:
    """Whether a cell conforms to its limits; where the rule leaves that open, nobody has shown it.

    One without a value may be expected to have none.
    """
    cell, told = report.values.cell(*found.limits.cell), "; ".join((str(found.limits), *probabilities(found)))
    tests = report.values.tests(cell)
    expected = any(each.covers(cell.name, cell.label, tests) for each in report.inputs.expected)
    passed = found.decision is Decision.CONFORMS or (cell.value is None and expected)
    note = "warning" if found.improbable else ""
    said = f"{sentence(found)} ({told})"
    return Check(CONFORMITY, found.limits.address, passed, said, found.limits.at, note=note)


def _otherwise(comparison: Comparison) -> str:
    """In which way a known difference is not as it is known."""
    published = comparison.published
    accept = "'loopsheet check --accept FOLDER' pins it"
    return {
        UNPINNED: f"its known difference is not pinned: any other would pass; {accept}",
        OTHERWISE: f"differs otherwise than is known ({published.pin}); if that is right, {accept}",
        UNREASONED: "why it differs is not said; say it in the column 'reason'",
        UNEXPLAINED: f"rests on '{published.explained}', which explains it no more; "
        "'loopsheet check --accept FOLDER' takes that back",
        UNAMENDED: "does not come out once the known misprints are put right",
    }.get(comparison.finding, comparison.finding)


def _word(comparison: Comparison) -> str:
    """The verdict on a value, and what was certain of one that cannot be reached."""
    found = comparison.refereed
    return comparison.verdict if found is None else words.called(comparison.published, found)


TOGETHER = "all together"
"""The name of the check whether all tables come out of one input."""
MISPRINTS = "known misprints"
"""The name of the check whether they do once the known misprints are put right."""


def table_names(inputs: Inputs) -> list[str]:
    """The names of the referee's checks of tables, without asking it."""
    sources = list(dict.fromkeys(value.source for value in inputs.published))
    if not sources:
        return []
    return [*sources, TOGETHER, *([MISPRINTS] if inputs.errata else [])]


def of_referee(report: Report) -> tuple[Check, ...]:
    """Whether the values of each table, and of all, come out of one input; none if it was not asked."""
    found = report.referee
    if found.joint is None:
        return ()
    at, known = report.inputs.place, {v.source for v in report.inputs.published if v.expect}
    tables = [
        Check("table", t.source, found.as_printed or t.possible or t.source in known, words.together(t), at)
        for t in found.tables
    ]
    others = () if found.others is None or found.others_come else (words.together(found.others),)
    said = "; ".join((words.all_together(found), *others, *words.why(found)))
    passed = found.others_come if known else found.as_printed
    tables.append(Check("table", TOGETHER, passed, said, at))
    if found.amended is None:
        return tuple(tables)
    if found.joint.possible:
        nothing = "all values come out as it is; drop the known misprints"
        return (*tables, Check("table", MISPRINTS, False, nothing, at))
    said = "; ".join(words.amended(found))
    return (*tables, Check("table", MISPRINTS, found.amended.possible, said, at))


def of_diagnostics(diagnostics: Iterable[Diagnostic]) -> tuple[Check, ...]:
    """What is wrong with the input, for the formats that tell findings to machines."""
    return tuple(
        Check("input", found.code, False, "; ".join(filter(None, (found.message, found.hint))), found.at)
        for found in diagnostics
    )


def names_of(published: Iterable[PublishedValue]) -> list[str]:
    """Name each published value by its cell, and by its source too where two sources print that cell."""
    values = list(published)
    cells = [address(value.cell, value.index) for value in values]
    times = Counter(cells)
    return [
        cell if times[cell] == 1 else f"{cell} ({value.source})"
        for cell, value in zip(cells, values, strict=True)
    ]
