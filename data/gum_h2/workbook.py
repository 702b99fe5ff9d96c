"""Resistance, reactance and impedance from simultaneous readings: JCGM 100:2008, H.2, approach 1."""

from sympy import cos, sin

from loopsheet import Method, let, mean, measured


class Impedance(Method, source="JCGM 100:2008, H.2"):
    """Simultaneous resistance and reactance measurement."""

    V = measured("V", "amplitude of the potential difference", positive=True)
    I = measured("A", "amplitude of the current", positive=True)
    phi = measured("1", "phase shift of both", positive=True)
    V_mean = let(mean(V), "mean amplitude of the potential difference", "V", label="(C.2a)", like=V)
    I_mean = let(mean(I), "mean amplitude of the current", "A", label="(C.2b)", like=I)
    phi_mean = let(mean(phi), "mean phase shift of both", label="(C.2c)", like=phi)
    R = let(V_mean / I_mean * cos(phi_mean), "resistance", "ohm", label="(H.7a)")
    X = let(V_mean / I_mean * sin(phi_mean), "reactance", "ohm", label="(H.7b)")
    Z = let(V_mean / I_mean, "impedance", "ohm", label="(H.7c)")
