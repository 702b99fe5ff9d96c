"""A sheet that uses everything a sheet may use, none of it physics: engines are compared on it."""

from collections.abc import Mapping
from typing import Any

from sympy import And, Eq, Max, Min, Ne, Not, Or, Piecewise, Rational, Sum, Symbol, exp, log, pi, sqrt

from loopsheet.derivations.equation import Equation, Kind
from loopsheet.derivations.reductions import Median
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import Axis, Column, Formula, Given, PairAxis, RepeatAxis, Root, Sheet

k, p, q, i, j, s = (Symbol(name, integer=True, positive=True) for name in "kpqijs")
n_items, n_pairs, n_points = (
    Symbol(f"n_{name}", integer=True, positive=True) for name in ("items", "pairs", "points")
)
ITEMS = Axis("items", k, n_items)
PAIRS = PairAxis("pairs", p, n_pairs, of=ITEMS, first=i, second=j)
POINTS = RepeatAxis("points", q, n_points, of=PAIRS, step=s, count="per")

UNITS = {"a": "mm", "w": "in", "far": "km", "ratio": "%", "total": "um"}
"""Units of the cells; the other columns are in SI."""


def _formula(value: Any) -> Formula:
    return Formula(Equation("", (Symbol("made"), value), "for a test", Kind.DEFINITION, "made"))


def _columns() -> tuple[Column, ...]:
    positive = Given("given", Bounds(low=0, low_open=True))
    a = Column("a", ITEMS, positive, "m")
    g = Column("g", ITEMS, Given("given", Bounds(high=1000)), positive=False)
    w = Column("w", None, positive, "m")
    per = Column("per", None, Given("given", Bounds(high=9)))
    far = Column("far", None, _formula(1000 * w.symbol + Sum(a[k], (k, 1, n_items))), "m")
    ratio = Column("ratio", PAIRS, _formula(a[i] / a[j] - a[j] ** 2 / (a[i] + w.symbol)), positive=False)
    strict = Column(
        "strict", PAIRS, _formula(a[j] - a[i]), requires=((Or(Ne(g[i], g[j]), g[i] > 0), "for a test"),)
    )
    cases = Column(
        "cases", PAIRS,
        _formula(
            Piecewise(
                (g[i], And(g[i] < g[j], g[j] < 2)), (-g[j], Not(Eq(g[i], g[j]))), (Rational(1, 3), True)
            )
        ),
        positive=False,
    )  # fmt: skip
    wave = Column("wave", POINTS, _formula(s * ratio[p] / per.symbol + a[i]), positive=False)
    inner = Max(wave[q], s * ratio[p]) + Min(wave[q], Rational(1, 7)) * Piecewise(
        (1, Or(s > 2, a[j] > w.symbol)), (-1, True)
    )
    total = Column(
        "total", ITEMS, _formula(a[k] * Sum(inner, (q, 1, n_points)) / n_points), "m", positive=False
    )
    chosen = Piecewise((g[k] ** 3, And(g[k] > -1, a[k] < 1)), (sqrt(a[k]), True))
    mixed = Column(
        "mixed",
        None,
        _formula(Sum(chosen, (k, 1, n_items)) * log(w.symbol) + pi * n_pairs * exp(-w.symbol)),
        positive=False,
    )
    u = Symbol("u", positive=True)
    balance = u * w.symbol - Sum(exp(-u * a[j] * s), (q, 1, n_points)) / n_points
    form = Equation("", (balance, Rational(0)), "for a test", Kind.DEFINITION, "balance")
    root = Root(form, form, u, 1 + u, Rational(0), Rational(1000), 30 * w.symbol, steps=8)
    solved = Column("solved", None, root)
    many = Column("many", ITEMS, _root_of_cubic(g[k], Symbol("z", real=True)))
    last = Column(
        "last", None, _formula(Sum(solved.symbol + many[k], (k, 1, n_items)) / n_items), positive=False
    )
    middle = Column("middle", None, _formula(Median(strict[p], (p, 1, n_pairs)) / w.symbol))
    # Of g, 2.5 has a value, -3 one that is too small, 12 and 5 one that is too large; 5 has no quotient.
    huge = Column("huge", ITEMS, _formula(exp(240 * g[k])))
    quotient = Column("quotient", ITEMS, _formula(a[k] / (g[k] - 5)), positive=False)
    carried = Column("carried", None, _formula(Median(strict[p], (q, 1, n_points))), "mm")
    return (
        a,
        g,
        w,
        per,
        far,
        ratio,
        strict,
        cases,
        wave,
        total,
        mixed,
        solved,
        many,
        last,
        middle,
        carried,
        huge,
        quotient,
    )


def _root_of_cubic(g: Any, z: Symbol) -> Root:
    """Roots of z^3 - 3z = g between -3 and 3: one, or three for |g| < 2; none beyond 18."""
    form = Equation("", (z**3 - 3 * z - g, Rational(0)), "for a test", Kind.DEFINITION, "cubic")
    return Root(
        form, form, z, z**2, Rational(-3), Rational(3), g / 3, turning=(Rational(-1), Rational(1)), steps=8
    )


SHEET = Sheet(_columns())

DATA: Mapping[str, Any] = {
    "a": [0.012, 0.025, 0.031, 0.044],
    "g": [2.5, -3.0, 12.0, 5.0],
    "w": 0.0254,
    "per": 3,
}
