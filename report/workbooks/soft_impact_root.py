"""How equation (11) of the soft-impact paper is solved: which form, on which interval, from where."""

from __future__ import annotations

from collections.abc import Mapping

from sympy import Expr, Integer, Max, Ne, Or, Piecewise, Poly, Pow, Rational, Rel, numer, together

from ...derivations import alpha_root
from ...derivations import soft_impact as model
from ...derivations.rebuilt import evaluated
from ...derivations.soft_impact import XP, E, V
from ..sheet import Root

__all__ = ["alpha_rule", "two_tests"]

Cells = Mapping[Expr, Expr]
"""What the two tests of the derivations are called in a sheet."""


def alpha_rule(where: Cells) -> Root:
    """The root of (11): in u = 1/(alpha + 1) it is smooth, its domain and its turning point closed form.

    `where`: the cells that the symbols of the two tests stand for.
    """
    u = alpha_root.u
    form = alpha_root.root_form
    # Both approaches are positive for alpha + 1 > (beta + 1) e^2 of either test, and alpha is for u < 1.
    livelier = (model.beta + 1) * Max(E[1] ** 2, E[2] ** 2)
    high = 1 / Max(livelier, 1)
    logarithm = evaluated(alpha_root.logarithm)
    at_one, equal_e = logarithm.xreplace({u: Integer(1)}), logarithm.xreplace({E[2]: E[1], u: 1 / livelier})
    # The definition of u is linear in alpha; sympy's own solve() would load its system of units for this.
    slope, rest = Poly(numer(together(alpha_root.reciprocal.residuals[0])), model.alpha).all_coeffs()

    def cells(expression: Expr) -> Expr:
        return expression.xreplace(dict(where))

    return Root(
        equation=model.eq11.at(where),
        form=form.at(where),
        unknown=u,
        value=-rest / slope,
        low=Rational(0),
        high=cells(high),
        # Where u -> 0 the form tends to 1 - x_p1/x_p2. At the other end, if that is not u = 1, the factor of
        # the livelier test vanishes and the other decides; where both vanish, or none, the logarithm of (L6)
        # does: it takes no square of a speed that doubles may not hold.
        sign_low=cells(XP[2] - XP[1]),
        sign_high=cells(Piecewise((at_one, livelier < 1), (E[2] - E[1], Ne(E[1], E[2])), (equal_e, True))),
        turning=(cells(_turning()),),
        turning_by=(alpha_root.log_form, alpha_root.slope),
        start=cells(_start()),
        steps=4,
        none="no exponent above 0 gives both tests a positive approach on one loading curve; "
        "the imprint does not deepen with the speed, or deepens too steeply for what is given back",
        two="e rises with the speed, and the two tests alone cannot tell which exponent is meant",
    )


def two_tests(where: Cells) -> tuple[tuple[Rel, str], ...]:
    """What must hold for there to be two tests at all."""
    different = Or(*(Ne(quantity[1], quantity[2]) for quantity in (V, E, XP)))
    return ((different.xreplace(dict(where)), "two equal tests are one; every exponent fits them"),)


def _turning() -> Expr:
    """Where (L8) turns: only a pair whose e rises with the speed may have two roots, others get no point."""
    point = alpha_root.turning.value.xreplace({alpha_root.Lambda: alpha_root.log_speeds.value})
    return Piecewise((point, (E[2] - E[1]) * (V[2] - V[1]) > 0), (Rational(0), True))


def _start() -> Expr:
    """The starting value for tests in any order: exchanging them exchanges the roots of its quadratic."""
    start = alpha_root.starting_value()
    (root,) = (power for power in start.atoms(Pow) if power.exp == Rational(1, 2))
    return start.xreplace({root: Piecewise((root, V[2] > V[1]), (-root, True))})
