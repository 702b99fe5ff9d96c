"""How likely a sum of squares is."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import TYPE_CHECKING

import mpmath

from ..messages.errors import listing

if TYPE_CHECKING:
    from ..workbook import SquareSum
    from .result import Report

RARE = 0.01
"""A sum of squares that is as large, or as small, less often than this is not taken for chance."""
SIGNIFICANT = 0.05
"""Nor is a deviation that is less likely than this, however many were looked at."""


def tied(report: Report) -> bool:
    """Whether errors that are weighed are shared or correlated: squares are then no independent ones."""
    stated = report.inputs.uncertainty
    of = set[str]().union(*(each.statements for each in stated.shared), *stated.correlations)
    return not of.isdisjoint(report.sheet.weighed.values())


def ties(report: Report, weighed: Collection[str]) -> str:
    """What makes errors of columns no independent ones: ``x and y are correlated``; empty if nothing."""
    stated = report.inputs.uncertainty
    paired = [pair for pair in (*stated.correlations, stated.paired) if len({*pair} & {*weighed}) > 1]
    told = [f"{listing(pair, last='and')} are correlated" for pair in paired]
    shared = [each for each in stated.shared if each.groups or len({*each.statements} & {*weighed}) > 1]
    told += [f"'{each.name}' is shared" for each in shared if not {*weighed}.isdisjoint(each.statements)]
    return listing(told, last="and")


def freedom(squares: SquareSum, report: Report) -> int:
    """The degrees of freedom of a sum of squares: rows without a value do not count."""
    return squares.freedom(report.values.rows_summed(squares.name, squares.axis))


def asked_of_chance(squares: SquareSum, report: Report) -> tuple[float, int, float] | None:
    """What chance is asked of: a sum of squares, its degrees of freedom, and those of the uncertainties.

    That is the sum of the fit, but where errors are shared or correlated: its weights leave that out, and the
    sum is that with what they have in common. None where it is not known, or nothing is left over.
    """
    if tied(report):
        known = report.uncertain().misfits.get(squares.name)
        return (known.chi2, known.dof, known.known_by) if known else None
    value, dof = report.values.scalar(squares.name), freedom(squares, report)
    return (value, dof, math.inf) if dof > 0 and value == value else None


def number(squares: SquareSum, report: Report) -> int:
    """How many squares there are in a sum."""
    return squares.each * report.values.rows_summed(squares.name, squares.axis)


def tail(chi2: float, dof: int, known_by: float = math.inf) -> float:
    """The probability of a sum of squares at least so large, of so many independent standard normal numbers.

    Parameters
    ----------
    dof : int
        At least 1.
    known_by : float
        The degrees of freedom of the standard uncertainty that the numbers were divided by: with a finite one
        the sum over `dof` has Fisher's distribution F(dof, known_by).

    Examples
    --------
    >>> f"{tail(3.841459, 1):.6f}", f"{tail(55.1908, 3):.2e}", f"{tail(4 * 5.1922, 4, 5):.5f}"
    ('0.050000', '6.25e-12', '0.05000')
    """
    if math.isfinite(known_by):
        return _beta(known_by, dof, known_by / (chi2 + known_by))
    return float(mpmath.gammainc(mpmath.mpf(dof) / 2, mpmath.mpf(chi2) / 2, regularized=True))


def head(chi2: float, dof: int, known_by: float = math.inf) -> float:
    """The probability of a sum of squares at most so large: the rest of :func:`tail`, which may be tiny.

    Examples
    --------
    >>> f"{head(0.484419, 4):.6f}", f"{head(1e-4, 4):.3e}", f"{head(4 / 6.2561, 4, 5):.5f}"
    ('0.025000', '1.250e-09', '0.05000')
    """
    if math.isfinite(known_by):
        return _beta(dof, known_by, chi2 / (chi2 + known_by))
    return float(mpmath.gammainc(mpmath.mpf(dof) / 2, 0, mpmath.mpf(chi2) / 2, regularized=True))


def _beta(one: float, other: float, part: float) -> float:
    """The share that a sum of `one` squares has of that of `one` and `other` is at most this, so often."""
    return float(mpmath.betainc(mpmath.mpf(one) / 2, mpmath.mpf(other) / 2, 0, part, regularized=True))


def largest(deviation: float, number: int, left_out: int = 0) -> float:
    """The probability that the largest of so many normal deviations is at least so large, by either sign.

    Parameters
    ----------
    deviation : float
        In standard deviations.
    number : int
        Of deviations.
    left_out : int
        How many were left out before: whoever looks for the worst again has had as many tries as there are
        ways to choose those and this one (Bonferroni).

    Examples
    --------
    >>> f"{largest(2.8, 5):.4f}", f"{largest(2.8, 5, 1):.4f}"
    ('0.0253', '0.0740')
    """
    one, tries = tail(deviation**2, 1), math.comb(number + left_out, left_out + 1)
    return -math.expm1(tries * math.log1p(-one)) if one < 1 else 1.0
