"""Whether cells conform to their limits, in words."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..distribution import Shape
from ..messages.errors import sentence_case
from ..quantity import behind, span
from .numbers import chance
from .uncertain import Conformity, Decision

if TYPE_CHECKING:
    from ..inputs.limits import Limits
    from .result import Report


def sentence(found: Conformity) -> str:
    """The decision: ``alpha_mean conforms: it lies within the acceptance limits``."""
    cell = found.budget.cell
    told = f"{found.decision} on {cell}" if found.decision is Decision.NONE else f"{cell} {found.decision}"
    return f"{told}: {found.because}"


def undecided(limits: Limits) -> str:
    """Of a cell that there is none of."""
    return f"{Decision.NONE} on {limits.address} ({limits}): it rests on a row that is left out"


def lines(report: Report, found: Conformity) -> Iterator[str]:
    """Limits, the rule, the decision and its risk."""
    yield f"limits {found.limits}{_rule(report, found)}"
    yield sentence(found)
    if told := ", ".join(probabilities(found)):
        yield told + (f", by {found.by.because}" if found.budget.u and conforming(found) else "")


def decision(report: Report, found: Conformity) -> str:
    """All of that in one sentence, the decision first; before it what a margin is of, and how large it is."""
    limits, name = f"{found.limits}{_rule(report, found)}", found.budget.name
    told = f"{sentence(found)} ({'; '.join((limits, *probabilities(found)))})."
    if name not in report.workbook.margins:
        return told
    cell = report.values.cell(name, found.budget.label)
    return f"{sentence_case(report.sheet[name].meaning)} {report.text(cell)}: {told}"


def probabilities(found: Conformity) -> Iterator[str]:
    """The conformance probability and the risk that is taken, where a distribution is known."""
    if told := conforming(found):
        yield f"conformance probability {told}"
    elif found.decision is not Decision.NONE and math.isnan(found.by.factor) and found.by.because:
        yield f"conformance probability not known: {found.by.because}"
    if told := risk(found):
        yield f"specific {told}"


def conforming(found: Conformity) -> str:
    """The conformance probability; empty if no distribution is known."""
    return _chance(found, found.probability, found.below + found.above)


def risk(found: Conformity) -> str:
    """The specific risk that is taken: ``consumer’s risk 1.37 %``; empty where nothing was decided."""
    told = conforming(found)
    if told and found.consumer_risk is not None:
        return f"consumer’s risk {_chance(found, found.consumer_risk, found.probability)}"
    return f"producer’s risk {told}" if told and found.producer_risk is not None else ""


def _chance(found: Conformity, probability: float, other: float) -> str:
    """With as many digits as draws tell, where draws told it."""
    if math.isnan(probability):
        return ""
    shapes = {found.by.shape, *(each.source.shape for each in found.budget.contributions if each.u)}
    if found.budget.u and (found.by.draws or shapes & {Shape.NORMAL, Shape.STUDENT}):
        # Without bounds nothing is certain, but to doubles.
        probability, other = max(probability, sys.float_info.min), max(other, sys.float_info.min)
    return chance(probability, other, 1 if found.by.draws else 2)


def _rule(report: Report, found: Conformity) -> str:
    """The guard band and what it leaves."""
    guard, name = found.limits.guard, found.budget.name
    if not guard.draws_in:
        return ", no guard band"
    if math.isnan(found.guard):
        return ", guard band not known"
    times = "" if guard.times == 1 else f"{float(guard.times):g} "
    drawn = " of the draws" if found.budget.draws else ""
    of = "" if guard.width else f" ({times}U at {100 * guard.level:.12g} %{drawn})"
    unit = behind(report.shown[name].unit)
    if not found.guard:
        return f", guard band 0{unit}{of}"
    width = report.stated(name, found.budget.value, found.guard)[1].text
    within = accepted(report, found)
    within = f"acceptance limits {within}{unit}" if within else "no acceptance limits: the guard bands meet"
    return f", guard band {width}{unit}{of}, {within}"


def accepted(report: Report, found: Conformity) -> str:
    """The acceptance limits with as many digits as the guard band has; empty where nothing is accepted.

    With a digit or two more where the value would be printed as one of them, and is not that.
    """
    name, (low, high), value = found.budget.name, found.acceptance, found.budget.value
    if low > high:
        return ""

    def told(finer: int) -> tuple[str, str, str]:
        least, most, own = (
            report.stated(name, end, found.guard / 10**finer)[0].text if math.isfinite(end) else ""
            for end in (low, high, value)
        )
        return least, most, own

    ways = [told(finer) for finer in range(3)]
    least, most, _ = next((way for way in ways if way[2] not in way[:2]), ways[0])
    return span(least, most)
