"""What a least sum of squares satisfies: its derivative by each parameter vanishes."""

from __future__ import annotations

from sympy import Expr, Integer

from .equation import Equation, Kind, assume


def normal_equation(derivative: Expr, name: str, given: str = "") -> Equation:
    """The sum of squares is least where its derivative by a parameter vanishes.

    Parameters
    ----------
    derivative : Expr
        Of the sum of squares.
    name : str
        Of the parameter, in words.
    given : str
        What else holds, as the end of the sentence.
    """
    because = f"the sum of squares is least where its derivative by the {name} vanishes{given}"
    return assume((derivative, Integer(0)), because, f"normal equation of the {name}", Kind.DEFINITION)
