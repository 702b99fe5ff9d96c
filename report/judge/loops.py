"""What the figures of the soft-impact paper draw: points, hysteresis loops and exponents, in SI.

No force law is typed here. The branches are those of equation (3) in the derivations, printed by the NumPy
engine and given the sheet's values.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from sympy import Basic

from ...derivations import soft_impact as model
from ...derivations.equation import evaluated
from ..cells.values import Status, Values
from ..charts import Curve
from ..engines.numpy import kernel
from ..sheet import PairAxis, Sheet

__all__ = ["SAMPLES", "ForceLaw", "curves"]

Array = NDArray[np.float64]

SAMPLES = 201
"""Abscissae of a curve. A polyline through so many is smooth to a tenth of a point in print."""


class ForceLaw:
    """A branch of a force law, ready to be evaluated over approaches.

    Parameters
    ----------
    expression : Basic
        The force as the derivations write it, in the symbol ``x`` and the law's constants.
    """

    def __init__(self, expression: Basic) -> None:
        self._kernel = kernel([evaluated(expression)])
        self._names = [str(argument) for argument in self._kernel.arguments]

    def __call__(self, x: Array, **constants: float) -> Array:
        """The force at each approach.

        Parameters
        ----------
        x : float array
            Approaches within the branch's domain.
        **constants : float
            The law's constants by their names; those that it does not use are ignored.
        """
        known: dict[str, Array | float] = {"x": x, **constants}
        (force,) = self._kernel.run(*(known[name] for name in self._names))
        return np.asarray(force, dtype=np.float64)


def curves(sheet: Sheet, values: Values, samples: int = SAMPLES) -> tuple[Curve, ...]:
    """All curves of the paper's figures; what rests on a cell in error is left out.

    Parameters
    ----------
    sheet : Sheet
        A sheet of the soft-impact workbook.
    values : Values
        Its values, without a batch dimension.
    samples : int
        How many abscissae a curve gets.

    Returns
    -------
    tuple of Curve
        ``loops``: ``points`` (one a pair), ``compression``, ``restitution`` (one a test);
        ``alpha_pairs``: ``pair`` (one a pair: mean speed of its tests in m/s, exponent), ``mean``.
    """
    return (
        *_points(values),
        *_loops(values, samples),
        *_alpha_pairs(sheet, values),
    )


def _ok(values: Values, *names: str) -> NDArray[np.bool_]:
    """Where all of these columns, on one axis, have values."""
    return np.asarray(np.all([values.status[name] == Status.OK for name in names], axis=0))


def _label(parts: NDArray[np.int64]) -> str:
    return "-".join(str(part) for part in parts)


# --- figure 4: points, compression, restitution -----------------------------------------------------------


def _points(values: Values) -> Iterator[Curve]:
    """The generated points, pair by pair."""
    pairs = values.layouts["pairs"].labels
    # The rows of the points' axis repeat the pairs one after the other.
    shape = (len(pairs), -1)
    x, F, ok = (a.reshape(shape) for a in (values.value["x"], values.value["F"], _ok(values, "x", "F")))
    for pair, its_x, its_F, its_ok in zip(pairs, x, F, ok, strict=True):
        if its_ok.any():
            yield Curve("loops", "points", _label(pair), its_x[its_ok], its_F[its_ok])


def _loops(values: Values, samples: int) -> Iterator[Curve]:
    """The fitted compression curve and the restitution curve of every test."""
    has_fit = bool(_ok(values, "C_log", "alpha_log", "beta").all())
    x_m, x_p, peak = (values.value[name] for name in ("x_m", "x_p", "Cprime_eq9"))
    # A test that the fit gives no more approach than its imprint has no restitution to draw.
    closed = _ok(values, "x_m", "x_p", "Cprime_eq9") & (x_p < x_m)
    if not has_fit or not closed.any():
        return
    fit = {"C": values.scalar("C_log"), "alpha": values.scalar("alpha_log")}
    # The abscissae contain every x_m, so that the tip of each loop lies on the polyline itself.
    up = np.union1d(np.linspace(0.0, x_m[closed].max(), samples), x_m[closed])
    yield Curve("loops", "compression", "", up, ForceLaw(model.law_c.value)(up, **fit))
    restitution = ForceLaw(model.law_r.value)
    tests = values.layouts["tests"].labels
    for test, its_x_m, its_x_p, its_peak in zip(
        tests[closed], x_m[closed], x_p[closed], peak[closed], strict=True
    ):
        back = np.linspace(its_x_p, its_x_m, samples)
        # The maximum force is that of (9), not of (7): (9) is the continuity of (3) at x_m, so the loop
        # closes on the fitted curve. With (7) it would close only for a test that the fit meets exactly.
        law = {"Cprime": its_peak, "beta": values.scalar("beta"), "x_m": its_x_m, "x_p": its_x_p}
        yield Curve("loops", "restitution", _label(test), back, restitution(back, **law))


# --- the exponent of every pair ---------------------------------------------------------------------------


def _alpha_pairs(sheet: Sheet, values: Values) -> Iterator[Curve]:
    """Each pair's exponent over the mean speed of its two tests, and the mean of all.

    One power law for all speeds would scatter the pairs about a level. The mean speed is the place on the
    speed axis that a pair speaks for: on the paper's data the exponents climb with it without exception.
    """
    axis = sheet["alpha"].axis
    assert isinstance(axis, PairAxis)
    layout = values.layouts[axis.name]
    v, alpha = values.value["v"], values.value["alpha"]
    speed = (v[layout.rows[axis.first]] + v[layout.rows[axis.second]]) / 2
    ok = _ok(values, "alpha")
    for pair, its_speed, its_alpha in zip(layout.labels[ok], speed[ok], alpha[ok], strict=True):
        yield Curve("alpha_pairs", "pair", _label(pair), np.array([its_speed]), np.array([its_alpha]))
    if ok.any() and _ok(values, "alpha_mean").all():
        span = np.array([speed[ok].min(), speed[ok].max()])
        yield Curve("alpha_pairs", "mean", "", span, np.full(2, values.scalar("alpha_mean")))
