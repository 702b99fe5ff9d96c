"""The points that the paper generates on each pair's loading curve; mean and median over the pairs."""

from __future__ import annotations

from sympy import Max, Sum, Symbol
from sympy.core.parameters import evaluate

from .equation import Equation, Kind
from .reductions import Median
from .symbols import VOCABULARY, p, s

__all__ = [
    "ENTRIES",
    "F_ref",
    "F_scale",
    "N",
    "abscissa",
    "mean",
    "middle",
    "n_pairs",
    "top",
    "x_ref",
    "x_scale",
    "x_top",
]

XM, ALPHA, CP, XTOP = (VOCABULARY[name] for name in ("x_m", "alpha", "Cprime", "x_top"))
x, x_top, N, x_ref, F_ref, alpha_mean, alpha_median = VOCABULARY.plain(
    "x x_top N x_ref F_ref alpha_mean alpha_median"
)
n_pairs = Symbol("n_pairs", integer=True, positive=True)

with evaluate(False):
    top = Equation(
        "(L10)",
        (x_top, Max(XM[1], XM[2])),
        "the paper generates points up to the pair's largest approach",
        Kind.DEFINITION,
        "largest approach of the pair",
        defines=x_top,
    )

    abscissa = Equation(
        "(L11)",
        (x, x_top * s / N),
        "equally spaced up to the largest approach; the paper does not say how many",
        Kind.DEFINITION,
        "abscissae of the generated points",
        defines=x,
    )

    mean = Equation(
        "(L12)",
        (alpha_mean, Sum(ALPHA[p], (p, 1, n_pairs)) / n_pairs),
        "arithmetic mean over the pairs",
        Kind.DEFINITION,
        "mean exponent",
    )

    middle = Equation(
        "(L25)",
        (alpha_median, Median(ALPHA[p], (p, 1, n_pairs))),
        "half of the pairs lie on either side, so that one pair far off does not move it",
        Kind.DEFINITION,
        "median exponent",
    )

    x_scale = Equation(
        "(L22)",
        (x_ref, Sum(XTOP[p], (p, 1, n_pairs)) / n_pairs),
        "a typical approach, so that logarithms are taken of pure numbers; any would do",
        Kind.DEFINITION,
        "reference approach",
        defines=x_ref,
    )

    F_scale = Equation(
        "(L23)",
        (F_ref, Sum(CP[p], (p, 1, n_pairs)) / n_pairs),
        "a typical force; any would do",
        Kind.DEFINITION,
        "reference force",
        defines=F_ref,
    )

ENTRIES = (top, abscissa, mean, middle, x_scale, F_scale)
"""Everything above, in the order of a ledger."""
