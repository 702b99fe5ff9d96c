"""A quantity by a formula, from repeated readings: put your own in the place of these lines."""

from sympy import pi

from loopsheet import Method, given, let, mean, measured


class Pendulum(Method, source="where it is published", rows="swings"):
    """Free fall by a pendulum."""

    T = measured("s", "period of a swing", positive=True, example="2.001 1.998 2.003")
    L = given("m", "length of the thread", positive=True, example="994.0 mm, u = 0.5 mm")
    g_k = let(4 * pi**2 * L / T**2, "free fall by one swing")
    g = let(mean(g_k), "free fall", "m/s^2")
