"""Kepler's equation in degrees: J Meeus, Astronomical Algorithms, 1991, chapter 30."""

from sympy import atan, sin, sqrt, tan

from loopsheet import Method, let, measured, root, unknown


class Kepler(Method, source="J Meeus, Astronomical Algorithms, 1991, chapter 30", rows="orbits"):
    """Kepler's equation."""

    e = measured("1", "eccentricity", low=0, high=0.999)
    M = measured("deg", "mean anomaly", low=-180, high=180)
    E = unknown()
    E = root(E - e * sin(E), M, "eccentric anomaly", "deg", low=M - 1, high=M + 1, start=M, steps=20)
    nu = let(2 * atan(sqrt((1 + e) / (1 - e)) * tan(E / 2)), "true anomaly", "deg")
