"""Hertz's contact of a ball and a plane or a ball, and the elastic impact that follows from it.

Sources: H Hertz, Über die Berührung fester elastischer Körper, J. reine angew. Math. 92 (1881) 156-171;
S Timoshenko, J N Goodier, Theory of Elasticity, 3rd ed. 1970, for the impact; K L Johnson, Contact Mechanics,
1985, for the unloading of an imprint.
"""

from __future__ import annotations

from collections.abc import Callable

from sympy import Expr, Integer, Integral, Rational, Symbol, beta, pi, sqrt
from sympy.core.parameters import evaluate

from ..equation import Derivation, Equation, Kind, Step, assume, define
from ..vocabulary import Quantity, Vocabulary
from .model import ContactModel
from .quantities import SHARED

OWN = (
    Quantity("x_m_hertz", "maximum approach by Hertz", "m", r"x_{m,\mathrm{H}%s}", (1e-5, 1e-4)),
    Quantity("F_m_hertz", "greatest force by Hertz", "N", r"F_{m,\mathrm{H}%s}", (100.0, 1e4)),
    Quantity("t_hertz", "duration of the contact by Hertz", "s", r"t_{\mathrm{H}%s}", (1e-6, 1e-3)),
    Quantity("e_hertz", "restitution by Hertz", "1", r"e_{\mathrm{H}%s}", (0.99, 1.0)),
    Quantity("x_p_hertz", "imprint by Hertz", "m", r"x_{p,\mathrm{H}%s}", (0.0, 1e-9)),
)
_WORDS = Vocabulary(*SHARED.values(), *OWN)
v, e, m_red, x, d, F = SHARED.plain("v e m_red x d F")
E_1, E_2, nu_1, nu_2, E_star, R, K = SHARED.plain("E_1 E_2 nu_1 nu_2 E_star R_b K")
d_2, ratio, gap, off_axis = SHARED.plain("target_diameter d_ratio gap off_axis")
r, a, a_u, p_0, delta, R_u, F_m = SHARED.plain("r a_c a_u p_0 delta R_u F_m")
x_m, peak, t, e_H, x_p = _WORDS.plain("x_m_hertz F_m_hertz t_hertz e_hertz x_p_hertz")
half, hertz = Rational(1, 2), Rational(3, 2)


Over = Callable[[Expr], Expr]
"""How long the compression under a power of the approach takes, over that of its way at impact speed; the
restitution takes as long, over its way at the speed of rebound."""


def passing(exponent: Expr) -> Expr:
    """That, as what the shares of the way take: the energy that is left tells the rate at each."""
    return Integral(1 / sqrt(1 - r ** (exponent + 1)), (r, 0, 1))


def lasts(exponent: Expr) -> Expr:
    """That, as Euler's beta function."""
    power = exponent + 1
    return beta(1 / power, half) / power


def duration(
    x_m: Expr, x_p: Expr, e: Expr, compression: Expr = hertz, restitution: Expr = hertz, *, over: Over
) -> Expr:
    """How long a contact lasts under two powers of the approach: the way of each branch over its rate.

    `x_m`, `x_p` and `e`: maximum approach, imprint, coefficient of restitution. `compression` and
    `restitution`: the exponents of both branches.
    """
    return x_m / v * over(compression) + (x_m - x_p) / (e * v) * over(restitution)


def elastic_duration(x_m: Expr, *, over: Over) -> Expr:
    """How long an elastic contact lasts: both branches are the same way."""
    return 2 * over(hertz) * x_m / v


def timed(number: str, t: Symbol, title: str, taken: Callable[..., Expr], *of: Expr) -> Derivation:
    """The duration of a contact, from the way of its branches.

    `taken` and `of`: what it is of what, :func:`duration` or :func:`elastic_duration`.
    """
    way = assume(
        (t, taken(*of, over=passing)),
        "the way over its rate, which the energy that is left tells",
        f"shares of the way: {title}",
    )
    closed = Equation(
        number,
        (t, taken(*of, over=lasts)),
        "the shares of the way summed, by Euler's beta function (DLMF 5.12.1)",
        title=title,
        defines=t,
    )
    return Derivation.of(closed, (way,), (t,), "Sum the shares of the way.")


def unloads(peak: Expr, x_m: Expr, x_p: Expr) -> Expr:
    """The force while an elastic contact unloads from its greatest one to an imprint."""
    return peak * ((x - x_p) / (x_m - x_p)) ** hertz


with evaluate(False):
    modulus = define(
        "(L121)",
        E_star,
        1 / ((1 - nu_1**2) / E_1 + (1 - nu_2**2) / E_2),
        "modulus of the contact",
        "both bodies give way",
    )
    diameters = define("", ratio, d / d_2, "ratio of the diameters")
    flat = assume((ratio, Integer(0)), "the target is a plane", "flat target", Kind.LIMIT)
    gap_of_two = assume(
        (gap, off_axis**2 / d + off_axis**2 / d_2),
        "both bodies are balls, and the contact is small beside them",
        "gap of two balls that touch",
    )
    gap_of_one = assume(
        (gap, off_axis**2 / (2 * R)),
        "a ball on a plane with the same gap",
        "effective radius",
        Kind.DEFINITION,
    )
    by_ratio = Equation(
        "", (R, d / (2 + 2 * ratio)), "(L189) with that ratio", title="effective radius by diameters"
    )
    radius_of_two = Equation(
        "(L189)",
        (R, 1 / (2 / d + 2 / d_2)),
        "the same gap at every distance from the axis",
        title="effective radius of two balls",
        defines=R,
    )
    radius = Equation("(L122)", (R, d / 2), "a ball on a plane", title="effective radius", defines=R)
    pressure = Equation(
        "(L123)",
        (p_0, 2 * E_star * a / (pi * R)),
        "elastic half-spaces, frictionless, the contact small beside the ball (Hertz 1881)",
        Kind.ASSUMPTION,
        "pressure at the centre",
    )
    contact = Equation("(L124)", (a**2, R * x), "the same theory", Kind.ASSUMPTION, "radius of the contact")
    carried = assume(
        (F, 2 * pi * a**2 * p_0 * Integral(r * sqrt(1 - r**2), (r, 0, 1))),
        "the pressure is an ellipse over the contact; r is the distance from the axis, over its radius",
        "force of Hertz's pressure",
    )
    stiffness = define("(L125)", K, Rational(4, 3) * E_star * sqrt(R), "stiffness of Hertz's contact")
    force = Equation(
        "(L126)", (F, K * x**hertz), "the pressure summed over the contact", title="Hertz's force"
    )
    energy = assume(
        (half * m_red * v**2, Integral(K * x**hertz, (x, 0, x_m))),
        "the kinetic energy at impact is the work of Hertz's force",
        "energy of an elastic impact",
    )
    approach = Equation(
        "(L127)",
        (x_m, (5 * m_red * v**2 / (4 * K)) ** Rational(2, 5)),
        "all kinetic energy has become work",
        title="maximum approach of an elastic impact",
        defines=x_m,
    )
    greatest = Equation(
        "(L128)",
        (peak, K * x_m**hertz),
        "(L126) there",
        title="greatest force of an elastic impact",
        defines=peak,
    )
    lasting = timed("(L129)", t, "duration of an elastic impact", elastic_duration, x_m)
    elastic = Equation(
        "(L130)", (e_H, Integer(1)), "nothing is lost", Kind.ASSUMPTION, "restitution of an elastic impact",
        defines=e_H,
    )  # fmt: skip
    no_imprint = Equation(
        "(L131)", (x_p, Integer(0)), "nothing is left", Kind.ASSUMPTION, "imprint of an elastic impact",
        defines=x_p,
    )  # fmt: skip

    # --- unloading of an imprint: Hertz's contact of a flatter gap ----------------------------------------
    unloading = assume(
        (F_m, Rational(4, 3) * E_star * sqrt(R_u) * delta**hertz),
        "unloading is elastic: Hertz's force with the radius of the gap that the imprint leaves",
        "force of elastic unloading",
    )
    flatter = assume(
        (a_u**2, R_u * delta),
        "the radius of the contact where unloading begins",
        "radius of the contact at the beginning of unloading",
    )
    recovery = Equation(
        "(L132)",
        (delta, 3 * F_m / (4 * E_star * a_u)),
        "force and contact radius tell the gap",
        title="elastic recovery",
        defines=delta,
    )
    given_back = assume(
        (half * m_red * (e * v) ** 2, F_m * delta * Integral(r**hertz, (r, 0, 1))),
        "the kinetic energy at rebound is the work of elastic unloading, r its share of the recovery",
        "work of elastic unloading",
    )
    returned_work = Equation(
        "(L133)",
        (half * m_red * (e * v) ** 2, Rational(2, 5) * F_m * delta),
        "integrated; (7) says the same of this exponent",
        title="work that elastic unloading gives back",
    )

CONTACT: tuple[Equation | Derivation, ...] = (
    modulus,
    Derivation.of(radius_of_two, (gap_of_two, gap_of_one), (gap, R), "Let both gaps be the same."),
    Derivation(
        (
            Step(by_ratio, (radius_of_two, diameters), (R, d), "Put the ratio of the diameters in."),
            Step(radius, (by_ratio, flat), (R, ratio), "Let it be zero."),
        )
    ),
    pressure,
    contact,
    stiffness,
    Derivation.of(
        force,
        (carried, pressure, contact, stiffness),
        (F, p_0, a, E_star),
        "Integrate the pressure over the contact, and put its radius in.",
    ),
    Derivation.of(
        recovery,
        (flatter, unloading),
        (R_u, F_m),
        "Put the radius of the gap in.",
    ),
    Derivation.of(
        returned_work,
        (given_back,),
        (F_m,),
        "Integrate.",
    ),
)
"""What other models rest on, too."""

HERTZ = ContactModel(
    name="hertz",
    title="Hertz, elastic",
    mark="H",
    assumes="both bodies are elastic: nothing is lost, and no imprint is left",
    source="H Hertz, J. reine angew. Math. 92 (1881) 156-171, 10.1515/crll.1882.92.156; Timoshenko and "
    "Goodier 1970 for the impact",
    quantities=OWN,
    entries=(
        Derivation.of(approach, (energy,), (m_red,), "Integrate, and solve for the approach."),
        Derivation.of(
            greatest, (force.at({x: x_m, F: peak}),), (K,), "Put the maximum approach into (L126)."
        ),
        lasting,
        elastic,
        no_imprint,
    ),
    cells=(approach, greatest, lasting.claim, elastic, no_imprint),
    predicts={"x_m": x_m, "F_m": peak, "t": t, "e": e_H, "x_p": x_p},
    loading=force.value,
    unloading=force.value,
)
