"""Monomolecular adsorption: Misra1a of NIST's Statistical Reference Datasets."""

from sympy import exp

from loopsheet import Method, fit, measured, unknown


class Misra1a(Method, source="NIST StRD, Misra1a (D Misra, 1978)", rows="observations", headline="b_1 b_2"):
    """Dental research in monomolecular adsorption."""

    x = measured("1", "pressure")
    y = measured("1", "volume")
    b_1 = unknown("volume at saturation", start=500)
    b_2 = unknown("rate of saturation", start=0.0001)
    curve = fit(y, b_1 * (1 - exp(-b_2 * x)))
