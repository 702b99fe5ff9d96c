"""What all contact models speak of: the two bodies, an impact, and Hertz's contact between them."""

from __future__ import annotations

from ..symbols import VOCABULARY as PAPER
from ..vocabulary import Quantity, Vocabulary

SHARED = Vocabulary(
    *(PAPER[name] for name in ("v", "e", "x_p", "m_red", "x", "d", "F", "beta")),
    Quantity("E_1", "Young's modulus of the ball", "Pa", "E_{1%s}", (1e9, 4e11)),
    Quantity("E_2", "Young's modulus of the target", "Pa", "E_{2%s}", (1e9, 4e11)),
    Quantity("nu_1", "Poisson's ratio of the ball", "1", r"\nu_{1%s}", (0.1, 0.49)),
    Quantity("nu_2", "Poisson's ratio of the target", "1", r"\nu_{2%s}", (0.1, 0.49)),
    Quantity("E_star", "modulus of the contact", "Pa", "{E^*}%s", (1e9, 2e11)),
    Quantity("R_b", "effective radius of the contact", "m", "R%s", (1e-3, 2e-2)),
    Quantity("target_diameter", "diameter of the target, a ball", "m", "d_{2%s}", (1e-3, 1e-1)),
    Quantity(
        "d_ratio",
        "diameter of the ball, over that of the target",
        "1",
        "d/d_2%s",
        (1e-4, 2.0),
        positive=False,
    ),
    Quantity("gap", "gap beside the point of contact", "m", "h_{g%s}", (1e-9, 1e-5)),
    Quantity("off_axis", "distance from the axis of the contact", "m", r"\varrho%s", (1e-5, 1e-3)),
    Quantity("K", "stiffness of Hertz's contact", "N/m^(3/2)", "K%s", (1e7, 1e11)),
    Quantity("r", "a part of a way", "1", "r%s", (0.01, 0.99)),
    Quantity("a_c", "radius of the contact", "m", "a%s", (1e-4, 1e-3)),
    Quantity("p_0", "pressure at the centre of the contact", "Pa", "p_{0%s}", (1e8, 1e10)),
    Quantity(
        "delta", "elastic recovery: the approach that unloading takes back", "m", r"\delta%s", (1e-6, 1e-4)
    ),
    Quantity("a_u", "radius of the contact where unloading begins", "m", "a_{u%s}", (1e-4, 1e-3)),
    Quantity("R_u", "radius of the gap while unloading", "m", "R_{u%s}", (1e-3, 1.0)),
    Quantity("F_m", "greatest force of an impact", "N", "F_{m%s}", (100.0, 1e4)),
)
"""The paper's symbols where it has them."""
