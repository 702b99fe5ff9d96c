"""What no formula gives: the root of an equation, certified to be the only one between its ends."""

from sympy import log, sqrt

from loopsheet import Method, given, let, root, unknown


class Pipe(Method, source="C F Colebrook, J. Inst. Civ. Eng. 11 (1939) 133", headline="f loss"):
    """Friction factor of a rough pipe."""

    Re = given("1", "Reynolds number", low=4000, high=1e8, example="1.00e5, u = 1e3")
    rough = given("1", "roughness over diameter", low=0, high=0.05, example="0.0010")
    v = given("m/s", "mean speed", positive=True, example="1.00 m/s")
    rho = given("kg/m^3", "density", positive=True, example="998 kg/m^3")
    D = given("m", "diameter", positive=True, example="100.0 mm")
    f = unknown()
    turbulent = -2 * log(rough / 3.7 + 2.51 / (Re * sqrt(f))) / log(10)
    f = root(1 / sqrt(f), turbulent, "friction factor", low=0.004, high=0.2, start=0.02)
    loss = let(f * rho * v**2 / (2 * D), "loss of pressure over a length", "Pa/m")
