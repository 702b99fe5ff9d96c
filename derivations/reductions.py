"""What is taken over all values of a running number: sympy's sum, and by order what sympy lacks."""

from __future__ import annotations

from typing import ClassVar

from sympy import Add, Expr, Function, Mul, Pow, Sum
from sympy.concrete.expr_with_limits import ExprWithLimits


class OrderStatistic(ExprWithLimits):  # type: ignore[misc] # sympy has no types
    """What stands at one place of the terms in the order of their size, or the mean of what stands at two.

    It stays as it is written: sympy's algebra knows nothing of order, and none is asked of it. By a term it
    changes by one where that term alone is taken, by one half where it is one of two, and by nothing
    elsewhere.

    Parameters
    ----------
    function : Expr
        The terms.
    limits : tuple
        The running number and its ends, as for a sum.

    Attributes
    ----------
    word : str
        What it is called wherever it is told, printed or computed.

    Examples
    --------
    >>> from sympy import IndexedBase, Symbol
    >>> p, n = Symbol("p", integer=True), Symbol("n", integer=True)
    >>> Median(IndexedBase(Symbol("alpha", positive=True))[p], (p, 1, n)).is_positive
    True
    """

    word: ClassVar[str]

    def _eval_is_real(self) -> bool | None:
        return taken_of(self).is_real  # type: ignore[no-any-return]

    def _eval_is_positive(self) -> bool | None:
        return True if taken_of(self).is_positive else None

    def _eval_is_nonnegative(self) -> bool | None:
        return True if taken_of(self).is_nonnegative else None


class Median(OrderStatistic):
    """The middle of the terms; of an even number, the mean of the two there."""

    word = "median"


class Greatest(OrderStatistic):
    """The greatest of the terms."""

    word = "max"


class Least(OrderStatistic):
    """The least of the terms."""

    word = "min"


class Member(Function):  # type: ignore[misc] # sympy has no types
    """One where a row belongs to a group, nought elsewhere: a factor that leaves a sum the group's own terms.

    What is taken by order has it as a mark of the same: the terms are those of the group alone.

    `row` and `group`: their running numbers.
    """

    nargs = 2  # sympy asks for it
    is_real = True
    is_nonnegative = True


def never_negative(expr: Expr) -> bool:
    """Whether an expression is surely 0 or more where it has a value.

    As sympy knows, or as a range of one and the same terms is, as an even root of anything, and as sums and
    other reductions of such terms are.

    >>> from sympy import IndexedBase, Rational, Symbol
    >>> k, n, t = Symbol("k", integer=True), Symbol("n", integer=True), IndexedBase(Symbol("t", real=True))
    >>> high, low = (taken(t[k], (k, 1, n)) for taken in (Greatest, Least))
    >>> [never_negative(each) for each in ((high - low) / 2, (high - low) ** 2, high + low, high, low - high)]
    [True, True, False, False, False]
    >>> root = ((high - low) / (n - 1)) ** Rational(1, 2)
    >>> never_negative(root), never_negative(Sum((t[k] - 1) ** 2, (k, 1, n)))
    (True, True)
    """
    if expr.is_nonnegative or (isinstance(expr, Pow) and expr.exp.is_Rational and expr.exp.q % 2 == 0):
        return True
    if isinstance(expr, Mul):
        return all(map(never_negative, expr.args))
    if isinstance(expr, REDUCTIONS):
        return never_negative(taken_of(expr))
    if isinstance(expr, Add) and all(map(never_negative, expr.args)):
        return True
    terms = expr.as_coefficients_dict()
    greatest = [each for each in terms if isinstance(each, Greatest)]
    ranges = {each: terms[each] for each in greatest} | {Least(*each.args): -terms[each] for each in greatest}
    return all(terms[each] > 0 for each in greatest) and terms == ranges


REDUCTIONS = (Sum, Median, Greatest, Least)
"""What a rule may take over the rows of an index set."""


def member_of(total: ExprWithLimits) -> Member | None:
    """The factor of something that is taken over rows which says of which group these are; None if of all."""
    factors = Mul.make_args(total.function)
    return next((each for each in factors if isinstance(each, Member)), None)


def taken_of(total: ExprWithLimits) -> Expr:
    """The terms of something that is taken over rows, without the factor that says of which group.

    >>> from sympy import IndexedBase, Symbol
    >>> k, g, n = (Symbol(name, integer=True) for name in ("k", "g", "n"))
    >>> taken_of(Sum(2 * IndexedBase("L")[k] * Member(k, g), (k, 1, n)))
    2*L[k]
    """
    factors = Mul.make_args(total.function)
    if member_of(total) is None:
        return total.function
    rest = [each for each in factors if not isinstance(each, Member)]
    return Mul(*rest)
