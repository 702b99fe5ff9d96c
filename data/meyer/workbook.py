"""Meyer's law of the imprints of a ball: the force grows as a power of their diameter."""

from sympy import log

from loopsheet import Method, fit, given, let, mean, measured, unknown


class Meyer(
    Method, source="E Meyer, Z. Ver. dtsch. Ing. 52 (1908) 645", rows="impacts", size="N", headline="n alpha"
):
    """Meyer's law."""

    D = given("mm", "diameter of the ball", positive=True)
    x = measured("um", "greatest approach", positive=True)
    F = measured("N", "greatest force", positive=True)
    y = let(log(F / mean(F)), "logarithm of the force over its mean")
    a = unknown("logarithm where an imprint is as wide as the ball")
    n = unknown("exponent of Meyer's law")
    line = fit(y, a + n * log(4 * x / D) / 2)
    alpha = let(n / 2, "exponent of the force over the approach")
