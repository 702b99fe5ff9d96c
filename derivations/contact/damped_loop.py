"""Law (3) with damping on both branches: the loop of internal friction and plastic deformation together.

Each branch carries the factor 1 + c x'/v_0 of the damping family, c_c in compression and c_r in restitution,
so that the loop has three parts: the work W_c of the damping in compression, W_r in restitution, and the
plastic work W_p between the elastic parts of both branches. What is combined here is this project's own. Of a
model with the same two kinds of work, that of Anderson, Long and Serre, only the abstract was seen: it
extends Hunt and Crossley's damping by a permanent indentation, and nothing here is claimed to be theirs.

The shares s_c and s_r are 1 without damping. With them all of it is as by law (3), and so are its tests: s_c
stands beside C and beta + 1 alone, and s_r beside beta + 1. Impact speeds, restitutions and imprints do not
tell how the loss is divided, (L216), as long as C and beta are not known from elsewhere.

Domain: c_c, c_r > 0 and c_r e < 1; an imprint where (beta + 1) s_r e^2 < (alpha + 1) s_c.

Sources:
the figure of the hysteresis loop of the soft-impact paper, for the three works;
Y Gonthier, J McPhee, C Lange, J-C Piedboeuf, Multibody Syst Dyn 11 (2004) 209, for the separated variables;
R W G Anderson, A D Long, T Serre, Nonlinear Dyn 58 (2009) 199, 10.1007/s11071-009-9471-6 (abstract).
"""

from __future__ import annotations

from sympy import Integral, Rational, Symbol, log
from sympy.core.parameters import evaluate

from ..equation import Derivation, Equation, Kind, Ledger, assume, define
from ..vocabulary import Quantity, Vocabulary
from . import damping
from .quantities import SHARED

VOCABULARY = Vocabulary(
    *(damping.VOCABULARY[name] for name in ("x", "xdot", "v_0", "m_red", "g")),
    Quantity("F_c", "force in compression", "N", "F_{c%s}", (1.0, 5000.0)),
    Quantity("F_r", "force in restitution", "N", "F_{r%s}", (1.0, 5000.0)),
    Quantity("C", "coefficient of the compression", "N/m^alpha", "C%s", (1e8, 1e10)),
    Quantity("alpha", "exponent of the compression", "1", r"\alpha%s", (1.0, 1.5)),
    Quantity("beta", "exponent of the restitution", "1", r"\beta%s", (1.0, 2.0)),
    Quantity("Cprime", "force where both branches meet", "N", "C'%s", (100.0, 1e4)),
    Quantity("x_m", "maximum approach", "m", "x_{m%s}", (5e-5, 1e-4)),
    Quantity("x_p", "imprint depth", "m", "x_{p%s}", (1e-6, 4e-5)),
    SHARED["delta"],
    Quantity("e", "coefficient of restitution", "1", "e%s", (0.05, 0.6)),
    Quantity("c_c", "damping number of the compression", "1", "c_{c%s}", (0.05, 1.5)),
    Quantity("c_r", "damping number of the restitution", "1", "c_{r%s}", (0.05, 1.5)),
    Quantity("s_c", "elastic work of compression over the energy at impact", "1", "s_{c%s}", (0.3, 1.0)),
    Quantity("s_r", "elastic work of restitution over the energy of rebound", "1", "s_{r%s}", (1.0, 2.0)),
    Quantity("S_c", "elastic work of compression", "J", "S_{c%s}", (1e-3, 1.0)),
    Quantity("S_r", "elastic work of restitution", "J", "S_{r%s}", (1e-4, 1.0)),
    Quantity("W_c", "work of internal friction in compression", "J", "W_{c%s}", (1e-4, 1.0)),
    Quantity("W_r", "work of internal friction in restitution", "J", "W_{r%s}", (1e-6, 1.0)),
    Quantity("W_p", "work of plastic deformation", "J", "W_{p%s}", (1e-4, 1.0), positive=False),
    Quantity("C_u", "coefficient of a compression without damping", "N/m^alpha", "C_{u%s}", (1e8, 1e10)),
    Quantity("beta_u", "exponent of a restitution without damping", "1", r"\beta_{u%s}", (1.0, 4.0)),
)
x, rate, F_c, F_r, v_0, m_red, C, alpha, beta, Cprime = VOCABULARY.plain(
    "x xdot F_c F_r v_0 m_red C alpha beta Cprime"
)
x_m, x_p, delta, e, c_c, c_r, g, s_c, s_r, S_c, S_r = VOCABULARY.plain(
    "x_m x_p delta e c_c c_r g s_c s_r S_c S_r"
)
W_c, W_r, W_p, C_u, beta_u = VOCABULARY.plain("W_c W_r W_p C_u beta_u")
w = Symbol("w", positive=True)
_parts = c_r * e < 1

# What the damping family says of each branch: the approach of the restitution begins at the imprint.
_there = {damping.K: C, damping.n: alpha, damping.c: c_c, damping.W: S_c}
_back = {
    damping.K: Cprime / delta**beta, damping.n: beta, damping.x_m: delta, damping.c: c_r, damping.e_o: e,
    damping.W: S_r,
}  # fmt: skip
compression, work_c = damping.compression.at(_there), damping.work.at(_there)
restitution, work_r, left = (each.at(_back) for each in (damping.rebound, damping.work, damping.left))

with evaluate(False):
    _energy = Rational(1, 2) * m_red * v_0**2
    loading = Equation(
        "(L201)",
        (F_c, C * x**alpha * (1 + c_c * rate / v_0)),
        "the compression of (3), and damping in its proportion",
        Kind.ASSUMPTION,
        "compression with internal friction",
    )
    unloading = Equation(
        "(L202)",
        (F_r, Cprime * ((x - x_p) / (x_m - x_p)) ** beta * (1 + c_r * rate / v_0)),
        "the restitution of (3), and damping in its proportion",
        Kind.ASSUMPTION,
        "restitution with internal friction",
    )

    recovery = define(
        "", delta, x_m - x_p, "elastic recovery", "definition, the approach that the restitution takes back"
    )
    share_c = define(
        "(L203)",
        s_c,
        2 * (c_c - log(1 + c_c)) / c_c**2,
        "elastic share of compression",
        "below 1, and 1 without damping",
    )
    share_r = define(
        "(L204)",
        s_r,
        2 * (-c_r * e - log(1 - c_r * e)) / (c_r * e) ** 2,
        "elastic share of restitution",
        "above 1, and 1 without damping",
        conditions=(_parts,),
    )
    elastic_c = Equation(
        "(L205)",
        (S_c, s_c * _energy),
        "(L201) integrated from the impact speed to rest",
        title="elastic work of compression by energy",
    )
    elastic_r = Equation(
        "(L206)",
        (S_r, s_r * e**2 * _energy),
        "(L202) integrated from rest to the speed of rebound",
        title="elastic work of restitution by energy",
        conditions=(_parts,),
    )
    by_approach = Equation(
        "(L207)",
        (S_c, C * x_m ** (alpha + 1) / (alpha + 1)),
        "integrated",
        title="elastic work of compression by approach",
    )
    by_recovery = Equation(
        "(L208)",
        (S_r, Cprime * (x_m - x_p) / (beta + 1)),
        "integrated",
        title="elastic work of restitution by approach",
    )
    approach = Equation(
        "(L209)",
        (x_m, ((alpha + 1) * s_c * m_red * v_0**2 / (2 * C)) ** (1 / (alpha + 1))),
        "(L205) and (L207)",
        title="maximum approach with internal friction",
    )
    meets = assume(
        (Cprime, C * x_m**alpha),
        "both branches meet at rest, where there is no damping",
        "force at the maximum approach",
    )
    imprint = Equation(
        "(L210)",
        (x_p, x_m * (1 - (beta + 1) * s_r * e**2 / ((alpha + 1) * s_c))),
        "both elastic works, and the force where the branches meet",
        title="imprint with internal friction",
        conditions=(_parts,),
    )

    # --- the three works of the loop ---------------------------------------------------------------------
    damping_c = define(
        "",
        W_c,
        m_red * v_0**2 * Integral(c_c * w**2 / (1 + c_c * w), (w, 0, 1)),
        "work of the damping in compression",
        "the damping of (L201) over the way of compression, variables separated",
    )
    damping_r = define(
        "",
        W_r,
        m_red * v_0**2 * Integral((1 - w) ** 2 / w, (w, g, 1)) / c_r**2,
        "work of the damping in restitution",
        "the damping of (L202) over the way of restitution, variables separated, w its factor",
    )
    between = define(
        "",
        W_p,
        S_c - S_r,
        "work between the elastic parts",
        "the area between the elastic parts of both branches",
    )
    friction_c = Equation(
        "(L211)", (W_c, (1 - s_c) * _energy), "integrated", title="internal friction in compression"
    )
    friction_r = Equation(
        "(L212)",
        (W_r, (s_r - 1) * e**2 * _energy),
        "integrated",
        title="internal friction in restitution",
        conditions=(_parts,),
    )
    plastic = Equation(
        "(L213)",
        (W_p, (s_c - s_r * e**2) * _energy),
        "(L205) and (L206)",
        title="plastic deformation",
        conditions=(_parts,),
    )
    loss = Equation(
        "(L214)",
        (W_c + W_r + W_p, (1 - e**2) * _energy),
        "(L211), (L212) and (L213): the area of the loop is the energy that is lost, however it is divided",
        title="the three works together",
        conditions=(_parts,),
    )

    # --- what tests of speed, restitution and imprint do not tell ------------------------------------------
    undamped_c = define("", C_u, C / s_c, "compression without damping", "another material")
    undamped_r = Equation(
        "(L215)",
        (beta_u + 1, (beta + 1) * s_r / s_c),
        "another material",
        Kind.DEFINITION,
        "restitution without damping",
    )
    like_3 = Equation(
        "(L216)",
        (
            x_p,
            ((alpha + 1) * m_red * v_0**2 / (2 * C_u)) ** (1 / (alpha + 1))
            * (1 - (beta_u + 1) * e**2 / (alpha + 1)),
        ),
        "law (3) without damping, by another coefficient and another exponent, leaves the same imprint at "
        "every speed with the same s_r: all tests with one c_r e, and one test whatever the damping",
        title="the imprint does not tell the damping",
        conditions=(_parts,),
    )

LEDGER = Ledger(
    entries=(
        loading,
        unloading,
        share_c,
        share_r,
        Derivation.of(
            elastic_c,
            (work_c, compression, share_c),
            (S_c, C, s_c),
            "Integrate the separated law from the impact speed to rest.",
        ),
        Derivation.of(
            elastic_r,
            (left, work_r, restitution, share_r),
            (g, S_r, Cprime, s_r),
            "Integrate the separated law from rest to the speed of rebound.",
        ),
        Derivation.of(by_approach, (work_c,), (S_c,), "Integrate the elastic part."),
        Derivation.of(by_recovery, (work_r, recovery), (S_r, delta), "Integrate the elastic part."),
        Derivation.of(
            approach,
            (elastic_c, by_approach),
            (m_red, S_c),
            "Put (L207) into (L205) and solve for the approach.",
        ),
        Derivation.of(
            imprint,
            (elastic_c, by_approach, by_recovery, elastic_r, meets),
            (m_red, S_c, x_p, S_r, Cprime),
            "Divide the elastic work of restitution by that of compression.",
        ),
        Derivation.of(
            friction_c, (damping_c, share_c), (W_c, s_c), "Integrate the work of the damping in compression."
        ),
        Derivation.of(
            friction_r,
            (left, damping_r, share_r),
            (g, W_r, s_r),
            "Integrate the work of the damping in restitution.",
        ),
        Derivation.of(
            plastic,
            (between, elastic_c, elastic_r),
            (W_p, S_c, S_r),
            "Take the elastic work of restitution from that of compression.",
        ),
        Derivation.of(loss, (friction_c, friction_r, plastic), (W_c, W_r, W_p), "Add the three works."),
        undamped_r,
        Derivation.of(
            like_3,
            (imprint, approach, undamped_c, undamped_r),
            (x_p, x_m, C_u, beta_u),
            "Let the other material take up the shares.",
        ),
    ),
    vocabulary=VOCABULARY,
)
