"""The symbolic half of a proof: solving a premise, integrating, seeing that a residual is zero.

Each function here either returns what is right wherever the symbols' assumptions hold, or says that it
cannot; none of them guesses. What a result needs beyond the assumptions is returned with it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import sympy as sp

from .facts import Facts
from .sums import in_terms

NOTHING = Facts()

_LARGEST = 3000
"""Operations. The largest that the paper needs has 1300."""
_MOST_TIMES = 16
"""An angle, in a function that is written by the tangent of half of it."""


@dataclass(frozen=True)
class Solved:
    """The only positive solution of an equation for one of its symbols."""

    value: sp.Expr
    """What the symbol is."""
    pivots: tuple[sp.Expr, ...] = ()
    """What was divided by: where one is zero the equation does not determine the symbol."""
    powers: tuple[sp.Expr, ...] = ()
    """What must be positive for a solution to exist: each is the value of a power with a positive base."""


def solve_for(unknown: sp.Expr, left: sp.Expr, right: sp.Expr, facts: Facts = NOTHING) -> Solved | None:
    """Solve left = right for a positive unknown; None where the solution was not seen to be the only one.

    Two kinds of equation are solved. One is linear in the unknown after its denominators are cleared.
    In the other the unknown stands in one place, under products, powers and logarithms, each of which takes
    a value once where its argument is positive; `facts` may know that it is.
    """
    for here, there in ((left, right), (right, left)):
        if here == unknown and not there.has(unknown):
            return Solved(there)
    # As it stands first: clearing denominators costs more, and may divide by what can vanish.
    for cleared in (False, True):
        difference = left - right
        difference = in_terms(_numerator(difference) if cleared else difference)
        if difference.has(sp.Sum):
            difference = sp.expand(difference)
        slope = _slope(difference, unknown)
        if slope is not None:
            return Solved(-difference.xreplace({unknown: sp.Integer(0)}) / slope, pivots=(slope,))
        if not difference.has(unknown):
            return None
    if left.has(unknown) and right.has(unknown):
        return None
    return _undo(unknown, *((left, right) if left.has(unknown) else (right, left)), facts)


def _slope(expression: sp.Expr, unknown: sp.Expr) -> sp.Expr | None:
    """The factor of the unknown in an expression that is linear in it; None where it is not seen to be."""
    slope = sp.Integer(0)
    for term in sp.Add.make_args(expression):
        if term.has(unknown):
            factor = _slope_of_product(term, unknown)
            if factor is None:
                return None
            slope += factor
    return slope if slope != 0 else None


def _slope_of_product(term: sp.Expr, unknown: sp.Expr) -> sp.Expr | None:
    if term == unknown:
        return sp.Integer(1)
    if not isinstance(term, sp.Mul):
        return None
    with_it = [factor for factor in term.args if factor.has(unknown)]
    if len(with_it) != 1:
        return None
    inner = (
        _slope(with_it[0], unknown)
        if isinstance(with_it[0], sp.Add)
        else _slope_of_product(with_it[0], unknown)
    )
    return (
        None
        if inner is None
        else inner * sp.Mul(*(factor for factor in term.args if factor is not with_it[0]))
    )


def _undo(unknown: sp.Expr, here: sp.Expr, there: sp.Expr, facts: Facts) -> Solved | None:
    """Undo what was done to the unknown, the outermost operation first."""
    pivots: list[sp.Expr] = []
    powers: list[sp.Expr] = []
    while here != unknown:
        holders = [argument for argument in here.args if argument.has(unknown)]
        if len(holders) != 1:
            return None
        (inner,) = holders
        rest = [argument for argument in here.args if argument is not inner]
        match here:
            case sp.Add():
                there -= sp.Add(*rest)
            case sp.Mul():
                pivots.append(sp.Mul(*rest))
                there /= sp.Mul(*rest)
            # x^p = y has one positive x where y is positive, for any p but 0.
            case sp.Pow() if here.base == inner and facts.positive(inner):
                pivots.append(here.exp)
                powers.append(there)
                there = there ** (1 / here.exp)
            case sp.log() if facts.positive(inner):
                there = sp.exp(there)
            case sp.exp():
                powers.append(there)
                there = sp.log(there)
            case _:
                return None
        here = inner
    return Solved(there, tuple(pivots), tuple(powers))


def _numerator(expression: sp.Expr) -> sp.Expr:
    return sp.fraction(sp.together(expression))[0]


def settle(expression: Any, solution: Mapping[sp.Expr, sp.Expr], facts: Facts = NOTHING) -> Any:
    """Put a solution and what is known in, and integrate; sums stay (sympy would search closed forms)."""
    settled = facts.put(expression.xreplace(dict(solution)))
    integrals = settled.atoms(sp.Integral)
    return (
        settled.xreplace({integral: _integrate(integral) for integral in integrals}) if integrals else settled
    )


@lru_cache(maxsize=64)
def _integrate(integral: sp.Integral) -> sp.Expr:
    closed = in_powers(integral)
    if closed is not None:
        return closed
    # Of a broken power of what grows as an exponential there is no closed form, for which sympy would search.
    outer, inner = sp.expand_power_base(integral.function).as_independent(*integral.variables, as_Add=False)
    if isinstance(inner, sp.Pow) and not inner.exp.is_integer and inner.base.has(sp.exp):
        return outer * integral.func(inner, *integral.limits)
    return integral.doit()


def in_powers(integral: sp.Integral) -> sp.Expr | None:
    """The integral of a sum of powers of linear functions from end to end; None of anything else."""
    if len(integral.limits) != 1 or len(integral.limits[0]) != 3:
        return None
    variable, low, high = integral.limits[0]
    parts = [_of_power(term, variable, low, high) for term in sp.Add.make_args(sp.expand(integral.function))]
    return None if None in parts else sp.Add(*parts)


def _of_power(term: sp.Expr, variable: sp.Expr, low: sp.Expr, high: sp.Expr) -> sp.Expr | None:
    """Integrate a factor times (a x + b)^p, p > -1, where a x + b is not negative from end to end."""
    outer, inner = term.as_independent(variable, as_Add=False)
    if inner == 1:
        return outer * (high - low)
    base, power = inner.as_base_exp()
    slope = _slope(base, variable)
    if slope is None or power.has(variable) or not (power + 1).is_positive:
        return _of_euler(inner, variable, low, high, outer)
    at_low, at_high = (sp.together(base.xreplace({variable: end})) for end in (low, high))
    if not (power.is_integer or (at_low.is_nonnegative and at_high.is_nonnegative)):
        return None
    return outer * (at_high ** (power + 1) - at_low ** (power + 1)) / (power + 1) / slope


def _of_euler(
    inner: sp.Expr, variable: sp.Expr, low: sp.Expr, high: sp.Expr, outer: sp.Expr
) -> sp.Expr | None:
    """Integrate a factor times y^a (1 - z y^m)^b, a > -1, b > -1, 0 < z <= 1, from 0 to 1, with t for z y^m.

    DLMF 5.12.1, and 8.17.1 up to z; above 1 neither side is a real number. The circle's 1/sqrt(1 - y^2) from
    elsewhere up to 1 is the arc's cosine (DLMF 4.23.2).
    """
    if high == 1 and low != 0 and inner == 1 / sp.sqrt(1 - variable**2):
        return outer * sp.acos(low)
    a, m, b, z = (sp.Wild(name, exclude=[variable]) for name in "ambz")
    found = inner.match(variable**a * (1 - z * variable**m) ** b)
    if (
        found is None
        or (low, high) != (0, 1)
        or not all(positive.xreplace(found).is_positive for positive in (a + 1, b + 1, m, z))
    ):
        return None
    share = (found[a] + 1) / found[m]
    if found[z] == 1:
        return outer * sp.beta(share, found[b] + 1) / found[m]
    return outer * sp.betainc(share, found[b] + 1, 0, found[z]) * found[z] ** -share / found[m]


def _powers(expression: sp.Expr) -> sp.Expr:
    """Write exp(c log y + ...) as y^c ..., which is what the power means."""
    if not expression.has(sp.exp):
        return expression

    def product(argument: sp.Expr) -> sp.Expr:
        total: sp.Expr = sp.Integer(1)
        for term in sp.Add.make_args(sp.expand(sp.expand_log(argument))):
            # exp(c log y) = y^c; a product of two logarithms is no power of anything.
            logs = [factor for factor in sp.Mul.make_args(term) if isinstance(factor, sp.log)]
            total *= logs[0].args[0] ** (term / logs[0]) if len(logs) == 1 else sp.exp(term)
        return total

    return expression.replace(sp.exp, product)


_MOST_WRITTEN = 6
"""Arguments: the greatest of more takes as many distances as there are ways to order them."""
_FAMILIES = (
    ((sp.erfc, sp.erfi), sp.erf),
    ((sp.asinh, sp.acosh, sp.atanh, sp.acoth), sp.log),
    ((sp.sinh, sp.cosh, sp.tanh, sp.coth, sp.sech, sp.csch), sp.exp),
    ((sp.Max, sp.Min), sp.Abs),
)
"""Functions that are another one in disguise, by their definitions."""


def _undisguised(expression: Any) -> Any:
    """Write functions of a family by the one that defines them."""
    for disguised, plain in _FAMILIES:
        if all(len(each.args) <= _MOST_WRITTEN for each in expression.atoms(*disguised)):
            expression = expression.rewrite(disguised, plain)
    return expression


def vanishes(residual: sp.Expr, cheaply: bool = False) -> bool:
    """Whether the residual is identically zero; False means only that it was not seen to be.

    The numerator over one denominator settles what the algebra of a model asks for; what comes after it
    is dearer. `cheaply`: whether to leave that out.
    """
    if residual.has(sp.nan, sp.zoo, sp.oo):
        return False
    residual = _powers(in_terms(residual))
    if residual == 0:
        return True
    # A fraction vanishes with its numerator; from here on, the cheapest attempt first.
    numerator = sp.expand(_numerator(sp.expand_power_base(residual)))
    attempts: tuple[Callable[[], Any], ...] = (
        lambda: numerator,
        lambda: sp.expand(sp.powsimp(numerator)),
        lambda: _row_by_row(numerator),
        lambda: _simplified(numerator),
        lambda: _simplified(residual),
        lambda: _simplified(_undisguised(residual)),
        lambda: _in_half_angles(residual),
    )
    tried = any(attempt() == 0 for attempt in attempts[: 1 if cheaply else None])
    return tried or (not cheaply and _stays_zero(residual))


def _row_by_row(expression: sp.Expr) -> Any:
    """Sums over the same rows as one sum, each term of which vanishes with its numerator."""
    rows: dict[Any, sp.Expr] = {}
    rest: list[sp.Expr] = []
    for term in sp.Add.make_args(expression):
        total = next((factor for factor in sp.Mul.make_args(term) if isinstance(factor, sp.Sum)), None)
        before = term if total is None else term.xreplace({total: sp.Integer(1)})
        if total is None or before.has(sp.Sum, *total.variables):
            rest.append(term)
        else:
            rows[total.limits] = rows.get(total.limits, sp.Integer(0)) + before * total.function
    left = any(sp.expand(_numerator(sp.expand_power_base(body))) != 0 for body in rows.values())
    return expression if left else sp.Add(*rest)


def _stays_zero(expression: sp.Expr) -> bool:
    """Whether an expression does not change with a symbol, and is zero at one value of it.

    It has to be smooth on all that the symbol may be: atan(1/x) + atan(x) is pi/2 above zero, not below.
    """
    if not expression.has(sp.acos, sp.asin, sp.atan) or not _is_smooth(expression):
        return False
    for symbol in sorted(expression.free_symbols, key=str):
        anything = symbol == sp.Symbol(symbol.name, real=True)
        if symbol != sp.Symbol(symbol.name, positive=True) and not anything:
            continue
        if sp.expand(_numerator(expression.diff(symbol))) == 0:
            there = expression.xreplace({symbol: sp.Integer(1)})
            return bool(sp.simplify(there) == 0) or _stays_zero(there)
    return False


def _is_smooth(expression: sp.Expr) -> bool:
    """Whether an expression has a value and a slope wherever its symbols' assumptions hold."""
    match expression:
        case sp.Symbol():
            return bool(expression.is_real)
        case sp.Pow(base=base, exp=power):
            known = power.is_Integer and power.is_positive
            return _is_smooth(base) and _is_smooth(power) and bool(known or base.is_positive)
        case sp.log(args=(of,)):
            return bool(of.is_positive) and _is_smooth(of)
        case sp.acos(args=(of,)) | sp.asin(args=(of,)):
            return all(sp.together(end).is_positive for end in (1 - of, 1 + of)) and _is_smooth(of)
        case sp.Add() | sp.Mul() | sp.atan() | sp.exp() | sp.sin() | sp.cos():
            return all(map(_is_smooth, expression.args))
    return bool(expression.is_number and expression.is_real)


def _in_half_angles(expression: sp.Expr) -> Any:
    """Sines and cosines by the tangent of half their angle, of which they are rational functions.

    What holds of these but where a tangent has no value holds there too, as both sides go on smoothly.
    """
    angles = {term for each in expression.atoms(sp.sin, sp.cos) for term in sp.Add.make_args(each.args[0])}
    # Of n times an angle it is a polynomial of degree n: of a bound of 90 degrees n may have fifty digits.
    many = any(abs(term.as_coeff_Mul(rational=True)[0]) > _MOST_TIMES for term in angles)
    if not angles or many or expression.count_ops() > _LARGEST:
        return expression
    halved: sp.Expr = sp.expand_trig(expression)
    for angle in sorted({each.args[0] for each in halved.atoms(sp.sin, sp.cos)}, key=str):
        t = sp.tan(angle / 2)
        halved = halved.xreplace({sp.sin(angle): 2 * t / (1 + t**2), sp.cos(angle): (1 - t**2) / (1 + t**2)})
    return sp.expand(_numerator(halved))


def _simplified(expression: sp.Expr) -> sp.Expr:
    """What sympy makes of an expression that is not so large that nobody would wait for it."""
    return sp.simplify(expression) if expression.count_ops() <= _LARGEST else expression


def is_continuous(expression: sp.Expr) -> bool:
    """Whether an expression is continuous wherever it has a value: of what does not jump, and no 0^0."""
    powers = (power for power in expression.atoms(sp.Pow) if not power.exp.is_number)
    return not expression.has(sp.Piecewise, sp.ceiling, sp.floor, sp.sign) and all(
        p.base.is_positive for p in powers
    )


def is_root(expression: sp.Expr) -> bool:
    """Whether an expression is not negative where it is real: a product of roots and what is not negative.

    Of the roots all but one must be of what is not negative: those of -1 and -4 have a negative product.
    """
    unsure = [factor for factor in sp.Mul.make_args(expression) if not _is_not_negative(factor)]
    match unsure:
        case []:
            return True
        case [sp.Pow(exp=exponent)]:
            return bool(exponent.is_Rational and exponent.q % 2 == 0)
    return False


def _is_not_negative(expression: sp.Expr) -> bool:
    if expression.is_nonnegative:
        return True
    if isinstance(expression, sp.Sum):
        return _is_not_negative(expression.function)
    if isinstance(expression, (sp.Add, sp.Mul)):
        return all(map(_is_not_negative, expression.args))
    if not isinstance(expression, sp.Pow):
        return False
    rational = all(part.exp.is_Integer for part in expression.base.atoms(sp.Pow)) and not expression.atoms(
        sp.Function
    )
    return bool(expression.exp.is_even and rational) or (
        bool(expression.exp.is_real) and _is_not_negative(expression.base)
    )


def definite(expression: sp.Expr) -> bool:
    """Whether an expression is finite and of one sign wherever its symbols' assumptions hold."""
    if expression.is_positive or expression.is_negative:
        return True
    if isinstance(expression, sp.Sum):
        _, low, high = expression.limits[0]
        return low == 1 and bool(high.is_positive and expression.function.is_positive)
    if isinstance(expression, sp.Mul):
        return all(map(definite, expression.args))
    return (
        isinstance(expression, sp.Pow)
        and bool(expression.exp.is_real)
        and definite(expression.base)
        and (bool(expression.exp.is_integer) or bool(expression.base.is_positive))
    )
