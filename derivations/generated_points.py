"""The points that the paper generates on each pair's loading curve; mean and median over the pairs."""

from __future__ import annotations

from sympy import Max, Sum, Symbol
from sympy.core.parameters import evaluate

from .equation import Equation, Kind, define
from .reductions import Median
from .symbols import VOCABULARY, p, s

XM, ALPHA, CP, XTOP = (VOCABULARY[name] for name in ("x_m", "alpha", "Cprime", "x_top"))
x, x_top, N, x_ref, F_ref, alpha_mean, alpha_median = VOCABULARY.plain(
    "x x_top N x_ref F_ref alpha_mean alpha_median"
)
n_pairs = Symbol("n_pairs", integer=True, positive=True)

with evaluate(False):
    top = define(
        "(L10)",
        x_top,
        Max(XM[1], XM[2]),
        "largest approach of the pair",
        "the paper generates points up to the pair's largest approach",
    )

    abscissa = define(
        "(L11)",
        x,
        x_top * s / N,
        "abscissae of the generated points",
        "equally spaced up to the largest approach; the paper does not say how many",
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

    x_scale = define(
        "(L22)",
        x_ref,
        Sum(XTOP[p], (p, 1, n_pairs)) / n_pairs,
        "reference approach",
        "a typical approach, so that logarithms are taken of pure numbers; any would do",
    )

    F_scale = define(
        "(L23)",
        F_ref,
        Sum(CP[p], (p, 1, n_pairs)) / n_pairs,
        "reference force",
        "a typical force; any would do",
    )

ENTRIES = (top, abscissa, mean, middle, x_scale, F_scale)
"""Everything above, in the order of a ledger."""
