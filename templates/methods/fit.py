"""A curve by least squares that is not linear in what it finds: each begins at a start."""

from sympy import exp, log

from loopsheet import Method, fit, let, measured, unknown


class Decay(Method, source="where it is published", rows="readings", headline="tau half"):
    """Decay of a signal."""

    t = measured("s", "time", example="0.0 1.0 2.0 3.0 4.0 5.0")
    U = measured("V", "signal", example="5.02 3.57 2.61 1.86 1.36 0.97")
    U_0 = unknown("signal at the beginning", "V", start=5)
    tau = unknown("time constant", "s", start=3)
    curve = fit(U, U_0 * exp(-t / tau))
    half = let(log(2) * tau, "half-life")
