"""What the referee found, for JSON.

What was searched for is cut short, for its further digits depend on the machine; what is certain is rounded
outwards.
"""

from __future__ import annotations

from decimal import ROUND_CEILING, ROUND_FLOOR, Context

from msgspec.structs import asdict

from ..files import values as form
from ..files.form import alike
from . import verdict_words as words
from .verdict import Change, Explanation, Fit, Referee, Relabelled, TableVerdict, Verdict, Witness

DIGITS = 6
"""Significant digits; of a mismatch also decimals, for a search is content with a millionth."""


def short(value: float | None) -> float | None:
    """A mismatch that was searched for: rounded to the nearest.

    >>> short(8.4199506), short(4.44089e-13)
    (8.41995, 0.0)
    """
    return None if value is None else round(float(f"{value:.{DIGITS}g}"), DIGITS)


def certain(value: float | None, upwards: bool = False) -> float | None:
    """What is certain, rounded down; an upper bound, rounded up.

    >>> certain(6.4637125), certain(1.311909, upwards=True), certain(-1.311909)
    (6.46371, 1.31191, -1.31191)
    """
    if value is None:
        return None
    rounding = ROUND_CEILING if upwards else ROUND_FLOOR
    return float(Context(prec=DIGITS, rounding=rounding).create_decimal_from_float(value))


def bounds(found: Verdict | None) -> list[float | None] | None:
    """What no input that prints as given can leave, in SI; None where it was not asked for."""
    if found is None or (found.bound_low is None and found.bound_high is None):
        return None
    return [certain(found.bound_low), certain(found.bound_high, upwards=True)]


def data(found: Referee) -> form.Referee:
    """All that the referee found, but for the values by themselves."""
    return form.Referee(
        tables=[_table(table) for table in found.tables],
        joint=None if found.joint is None else _table(found.joint),
        tried=None if found.tried is None else alike(found.tried, form.Tried),
        explanations=[*map(_explanation, found.explanations), *map(_relabelled, found.labels)],
        fits=[_fit(fit) for fit in found.fits],
        free=list(found.free),
        amended=None if found.amended is None else _table(found.amended),
        misprints=[_explanation(each) for each in found.misprints],
    )


def _witness(found: Witness) -> form.Witness:
    return form.Witness(cell=found.cell, index=list(found.index), value=float(f"{found.value:.9g}"))


def _table(found: TableVerdict) -> form.Table:
    return form.Table(
        source=found.source,
        verdict=found.verdict,
        values=found.values,
        mismatch=short(found.mismatch),
        at_least=certain(found.at_least),
        because=found.because or None,
        witness=[_witness(each) for each in found.witness],
    )


def _explanation(found: Explanation) -> form.Explanation:
    return form.Explanation(
        **asdict(alike(found.first, form.Change)),
        besides=[alike(change, form.Change) for change in found.changes[1:]],
        mismatch=short(found.mismatch),
        changes=found.count,
        sentence=words.explained(found),
    )


def _relabelled(found: Relabelled) -> form.Explanation:
    change = Change("label", found.cell, (), found.source, found.printed, found.right)
    return form.Explanation(
        **asdict(alike(change, form.Change)),
        besides=[],
        mismatch=short(found.mismatch),
        changes=change.count,
        sentence=words.relabelled(found),
    )


def _fit(found: Fit) -> form.Fit:
    value = found.published
    mismatch = {name: short(off) for name, off in found.mismatch.items()}
    return form.Fit(source=value.source, cell=value.cell, best=found.best, mismatch=mismatch)
