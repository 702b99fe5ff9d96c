"""Contact of two equal elastic spheres: H Hertz, J. reine angew. Math. 92 (1881) 156-171."""

from sympy import pi, sqrt

from loopsheet import Method, given, let


class HertzContact(Method, source="H Hertz, J. reine angew. Math. 92 (1881) 156-171", headline="a sigma F"):
    """Contact of two equal spheres."""

    E = given("MPa", "modulus of elasticity", positive=True)
    nu = given("1", "Poisson's ratio", low=0, high=0.5)
    R = given("mm", "radius of each sphere", positive=True)
    h = given("mm", "approach of both", low=0)
    R_c = let(R / 2, "radius of the gap", "mm")
    E_c = let(E / (2 * (1 - nu**2)), "modulus of the contact", "MPa")
    K = let(4 * E_c * sqrt(R_c) / 3, "stiffness of the contact", "N/m^(3/2)")
    F = let(K * h**1.5, "force", "kN")
    a = let(sqrt(R_c * h), "radius of the contact", "mm")
    sigma = let(-3 * F / (2 * pi * a**2), "stress at its centre", "MPa")
