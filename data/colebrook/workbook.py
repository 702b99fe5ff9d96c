"""The friction factor of a rough pipe, which its equation names on both sides."""

from sympy import log, sqrt

from loopsheet import Method, given, root, unknown


class FrictionFactor(Method, source="C F Colebrook, J. Inst. Civ. Eng. 11 (1939) 133-156"):
    """Friction factor of a rough pipe."""

    Re = given("1", "Reynolds number", low=4000, high=1e8)
    rough = given("1", "roughness over diameter", low=0, high=0.05)
    f = unknown()
    turbulent = -2 * log(rough / 3.7 + 2.51 / (Re * sqrt(f))) / log(10)
    f = root(1 / sqrt(f), turbulent, "friction factor", low=0.004, high=0.2, start=0.02)
