"""Whether cells conform to their limits, in words."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..quantity import behind, span
from .numbers import chance
from .uncertain import Conformity, Decision

if TYPE_CHECKING:
    from .result import Report

__all__ = ["accepted", "lines", "probabilities", "sentence"]


def sentence(found: Conformity) -> str:
    """The decision: ``alpha_mean conforms: it lies within the acceptance limits``."""
    cell = found.budget.cell
    told = f"{found.decision} on {cell}" if found.decision is Decision.NONE else f"{cell} {found.decision}"
    return f"{told}: {found.because}"


def lines(report: Report, found: Conformity) -> Iterator[str]:
    """Limits, the rule, the decision and its risk."""
    yield f"limits {found.limits}{_rule(report, found)}"
    yield sentence(found)
    if told := ", ".join(probabilities(found)):
        yield told + (f", by {found.budget.because}" if found.budget.u else "")


def probabilities(found: Conformity) -> Iterator[str]:
    """The conformance probability and the risk that is taken, where a distribution is known."""
    if math.isnan(found.probability):
        return
    without = found.below + found.above
    yield f"conformance probability {chance(found.probability, without)}"
    if found.consumer_risk is not None:
        yield f"specific consumer's risk {chance(without, found.probability)}"
    if found.producer_risk is not None:
        yield f"specific producer's risk {chance(found.probability, without)}"


def _rule(report: Report, found: Conformity) -> str:
    """The guard band and what it leaves."""
    guard, name = found.limits.guard, found.budget.name
    if not guard.times and guard.width is None:
        return ", no guard band"
    if math.isnan(found.guard):
        return ", guard band not known"
    times = "" if guard.times == 1 else f"{float(guard.times):g} "
    of = "" if guard.width else f" ({times}U at {100 * guard.level:.12g} %)"
    unit = behind(report.shown[name].unit)
    if not found.guard:
        return f", guard band 0{unit}{of}"
    width = report.stated(name, found.budget.value, found.guard)[1].text
    return f", guard band {width}{unit}{of}, {accepted(report, found)}"


def accepted(report: Report, found: Conformity) -> str:
    """The acceptance limits, with as many digits as the guard band has."""
    name, (low, high) = found.budget.name, found.acceptance
    if low > high:
        return "no acceptance limits: the guard bands meet"
    least, most = (
        report.stated(name, end, found.guard)[0].text if math.isfinite(end) else "" for end in (low, high)
    )
    return f"acceptance limits {span(least, most)}{behind(report.shown[name].unit)}"
