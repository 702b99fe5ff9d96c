"""What is taken over all values of a running number: sympy's sum, and the median that sympy lacks."""

from __future__ import annotations

from sympy import Sum
from sympy.concrete.expr_with_limits import ExprWithLimits

__all__ = ["REDUCTIONS", "Median"]


class Median(ExprWithLimits):  # type: ignore[misc] # sympy has no types
    """The middle of the terms in the order of their size; of an even number, the mean of the two there.

    It stays as it is written: sympy's algebra knows nothing of order, and none is asked of it. By a term it
    changes by one where that term alone is in the middle, by one half where it is one of two, and by nothing
    elsewhere.

    Parameters
    ----------
    function : Expr
        The terms.
    limits : tuple
        The running number and its ends, as for a sum.

    Examples
    --------
    >>> from sympy import IndexedBase, Symbol
    >>> p, n = Symbol("p", integer=True), Symbol("n", integer=True)
    >>> Median(IndexedBase(Symbol("alpha", positive=True))[p], (p, 1, n)).is_positive
    True
    """

    def _eval_is_real(self) -> bool | None:
        return self.function.is_real  # type: ignore[no-any-return]

    def _eval_is_positive(self) -> bool | None:
        return True if self.function.is_positive else None

    def _eval_is_nonnegative(self) -> bool | None:
        return True if self.function.is_nonnegative else None


REDUCTIONS = (Sum, Median)
"""What a rule may take over the rows of an index set."""
