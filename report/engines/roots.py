"""The step towards a root and what rounding leaves of its equation, as algebra: every engine prints the same.

Householder's method of order four needs three derivatives of the equation; sympy makes them, so that no
engine and no model types a derivative.
"""

from __future__ import annotations

from sympy import Abs, Add, Basic, Expr, Mul, Pow, Sum, Symbol, exp, factor_terms, log

from ...derivations.differentiated import beside_corners, differentiated
from ..plan.nodes import RowSum


def derivatives(function: Expr, unknown: Symbol) -> tuple[Expr, Expr, Expr, Expr]:
    """The function and its first three derivatives; at a corner those beside it."""
    first = differentiated(function, unknown)
    second = beside_corners(differentiated(first, unknown))
    return function, first, second, beside_corners(differentiated(second, unknown))


def householder(f: Expr, f1: Expr, f2: Expr, f3: Expr) -> Expr:
    """What is subtracted from the unknown: the third Householder step, of fourth order.

    Source: A. S. Householder, The Numerical Treatment of a Single Nonlinear Equation, McGraw-Hill, 1970.
    """
    return 3 * f * (2 * f1**2 - f * f2) / (6 * f1**3 - 6 * f * f1 * f2 + f**2 * f3)


def step(function: Expr, unknown: Symbol) -> tuple[dict[Symbol, Expr], Expr]:
    """What is subtracted from the unknown: a fourth-order step, or Newton's where a derivative is a sum.

    Parameters
    ----------
    function : Expr
        What must vanish, in plain symbols.

    Returns
    -------
    dict of Symbol to Expr
        What the step is made of, each of what comes before: the derivatives of :func:`householder`, and what
        they are divided by, in an order that takes the fewest operations.
    Expr
        The step, of these.
    """
    if function.has(RowSum):
        return {}, function / differentiated(function, unknown)
    f, f1, f2, f3, newton, by, bent = (Symbol(f"f_{i}", real=True) for i in range(7))
    parts = dict(zip((f, f1, f2, f3), map(factor_terms, derivatives(function, unknown)), strict=True))
    # householder() divided through by f1^3: three quotients, and no power that could overflow.
    parts |= {newton: f / f1, by: newton / f1, bent: by * f2}
    return parts, newton * (1 - bent / 2) / (1 - bent + newton * by * f3 / 6)


def hoist(expression: Expr, unknown: Symbol, constants: dict[Expr, Symbol]) -> Expr:
    """Write what does not change with the unknown as constants, to be computed once for all steps.

    A power whose base is such becomes an exponential: the logarithm is then taken once.

    `expression`: in plain symbols. `constants`: the constants so far; new ones are added.
    """

    def constant(part: Expr) -> Expr:
        if part.is_Atom:
            return part
        signs = {
            "positive": part.is_positive,
            "negative": part.is_negative,
            "nonpositive": part.is_nonpositive,
        }
        sign = next((name for name, known in signs.items() if known), "real")
        named = Symbol(f"c_{len(constants)}", **{sign: True})
        return constants.setdefault(part, named)

    def moving(part: Expr) -> Expr:
        if not part.has(unknown):
            return constant(part)
        if isinstance(part, (Add, Mul)):
            still = [argument for argument in part.args if not argument.has(unknown)]
            rest = [moving(argument) for argument in part.args if argument.has(unknown)]
            return part.func(constant(part.func(*still)), *rest)
        if isinstance(part, Pow) and part.base.is_positive and not part.base.has(unknown):
            return exp(moving(log(part.base) * part.exp))
        if isinstance(part, RowSum):
            terms, axis = part.args
            return RowSum(moving(terms), axis)
        return part.func(*map(moving, part.args)) if part.args else part

    return moving(expression)


def magnitude(expression: Basic) -> Expr:
    """The expression with nothing cancelling: times the unit roundoff, about what rounding leaves of it."""
    if isinstance(expression, (Add, Mul)):
        return expression.func(*map(magnitude, expression.args))
    if isinstance(expression, Pow) and expression.exp.is_Integer and expression.exp > 0:
        return magnitude(expression.base) ** expression.exp
    if isinstance(expression, RowSum):
        terms, axis = expression.args
        return RowSum(magnitude(terms), axis)
    if isinstance(expression, Sum):
        return Sum(magnitude(expression.function), *expression.limits)
    return Abs(expression)
