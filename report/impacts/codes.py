"""The simulation codes that a card is made for: the law of each, and what is typed into it."""

from functools import reduce

from sympy import Expr, Float, Integer, Piecewise, Rational, Symbol, exp, sqrt
from sympy.core.parameters import evaluate

from ...derivations.contact.damping import K_T, K, c, carvalho_martins, family, gonthier, n, zeta
from .code import BY_RATIO, HERTZ, STRENGTHS, TSUJI, E, R, SimulationCode, Typed, alpha, depth, e, elastic, nu
from .law import ForceLaw, m_red, rate, v_0, x, x_max

k, k_1, d, b, m_1, m_3 = (Symbol(name, positive=True) for name in ("k", "k_1", "d", "b", "m_1", "m_3"))
exponent, c_max, ratio, beta_n = (Symbol(name, positive=True) for name in ("e_x", "c_max", "r", "beta_n"))
stiffness = Symbol("stiffness", positive=True)
MM = Rational(1000)

with evaluate(False):
    _STEP = Piecewise(((x / d) ** 2 * (3 - 2 * x / d), x < d), (1, True))
    _IMPACT = k * x**exponent + c_max * _STEP * rate

ADAMS = SimulationCode(
    name="adams",
    title="Adams and MotionSolve, IMPACT",
    version="the IMPACT function as documented for SolidWorks 2021, which has Adams as its solver",
    sources=(
        "SolidWorks 2021 help, Motion studies, IMPACT function: "
        "max(0, k (x1 - x)^e - STEP(x, x1 - d, cmax, x1, 0) x')",
        "Adams/Solver, IMPACT: the damping is a cubic step of the penetration, cmax at d (in words)",
        "Altair MotionSolve 2022.2, IMPACT: the same arguments in the same order; its formula was not seen",
    ),
    law=ForceLaw("IMPACT", _IMPACT),
    typed=(
        Typed("k", k, "N/mm^e", "stiffness", scale=MM**-exponent),
        Typed("e", exponent, "1", "force exponent", value=alpha),
        Typed("cmax", c_max, "N s/mm", "greatest damping", scale=1 / MM),
        Typed("d", d, "mm", "penetration at which damping is whole: a tenth of the greatest", depth / 10, MM),
    ),
    stiffness=k,
    damping=c_max,
    damping_unit=m_red * v_0 / depth,
    damping_ends=STRENGTHS,
    snippet="IMPACT(distance, rate, x1, {k}, {e}, {cmax}, {d})",
    notes=("numbers are for the units mm, kg, N, s",),
)
"""IMPACT of Adams and MotionSolve: a power of the penetration, and a dashpot that a cubic step turns on."""

with evaluate(False):
    _FLORES = K_T * x ** Rational(3, 2) * (1 + Rational(8, 5) * (1 - e) / e * rate / v_0)

CHRONO = SimulationCode(
    name="chrono",
    title="Chrono, SMC contact by the model Flores",
    version="Chrono::Multicore, commit e8057d0",
    sources=(
        "github.com/projectchrono/chrono src/chrono_multicore/solver/ChIterativeSolverMulticoreSMC.cpp, "
        "function_CalcContactForces",
    ),
    law=ForceLaw("Flores", _FLORES, where=HERTZ),
    typed=(
        Typed("young_modulus", E, "Pa", "of both bodies"),
        Typed("poisson_ratio", nu, "1", "of both bodies", value=nu),
        Typed("restitution", e, "1", "to be typed in, not the one that is returned"),
    ),
    stiffness=E,
    damping=e,
    by_hertz=E,
    snippet="SetYoungModulus({young_modulus}), SetPoissonRatio({poisson_ratio}), "
    "SetRestitution({restitution})",
    notes=(
        "tangential displacement MultiStep: the damping is then divided by the impact speed of each contact",
    ),
)
"""Smooth contact of Chrono by the model Flores: Hertz, with the damping of Flores and others."""

DAMPING_FAMILY = SimulationCode(
    name="damping-family",
    title="a force that one writes down, F = K x^n (1 + c x'/v_0)",
    sources=("Y Gonthier and others, Multibody Syst Dyn 11 (2004) 209, 10.1023/B:MUBO.0000029392.21648.bc",),
    law=ForceLaw("the damping family", family.value),
    typed=(
        Typed("K", K, "N/m^n", "stiffness"),
        Typed("n", n, "1", "exponent of the force", value=alpha),
        Typed("c", c, "1", "damping number"),
    ),
    stiffness=K,
    damping=c,
    damping_ends=STRENGTHS,
    snippet="F = {K}*pow(x, {n})*(1 + {c}*xdot/v_0)",
    notes=(
        "v_0 is the speed of each impact; with one number for c/v_0 restitution hangs on the speed",
        "c is exact; 'loopsheet prove damping' tells what authors give for it",
    ),
)
"""The damping family itself, for a program in which one writes the force down: c is that of (L106)."""

with evaluate(False):
    _DRAKE = k * x * (1 + d * rate)
    _TWO_SPRINGS = ((k, k_1 / 2),)

DRAKE = SimulationCode(
    name="drake",
    title="Drake, compliant point contact",
    version="commit 0465a03; run in 1.51.1",
    sources=("github.com/RobotLocomotion/drake multibody/plant/contact_model_doxygen.h, Modeling of Forces",),
    law=ForceLaw("point contact", _DRAKE, where=_TWO_SPRINGS),
    typed=(
        Typed("point_contact_stiffness", k_1, "N/m", "of both geometries, which are in series"),
        Typed("hunt_crossley_dissipation", d, "s/m", "of both geometries"),
    ),
    stiffness=k_1,
    damping=d,
    damping_unit=1 / v_0,
    damping_ends=STRENGTHS,
    snippet="AddContactMaterial({hunt_crossley_dissipation}, {point_contact_stiffness}, friction, "
    "&properties)",
    notes=("both geometries get the same numbers; the time step must be short beside the contact time",),
)
"""Compliant point contact of Drake: linear in the penetration, with Hunt and Crossley's dissipation."""

EXUDYN = SimulationCode(
    name="exudyn",
    title="Exudyn, ObjectContactSphereSphere with contactPlasticityRatio",
    version="1.13.6; source of commit e4b8e51",
    sources=(
        "github.com/jgerstmayr/EXUDYN main/src/Objects/CObjectContactSphereSphere.cpp, ComputeContactForces",
    ),
    law=ForceLaw("the plastic contact", k_1 * x, k_1 / (1 - ratio) * (x - ratio * x_max), ratio * x_max),
    typed=(
        Typed("contactStiffness", k_1, "N/m", "while loading"),
        Typed("contactPlasticityRatio", ratio, "1", "imprint over the greatest approach"),
    ),
    stiffness=k_1,
    damping=ratio,
    snippet="ObjectContactSphereSphere(..., contactStiffness={contactStiffness}, contactDamping=0, "
    "contactPlasticityRatio={contactPlasticityRatio}, impactModel=0)",
    notes=("contactStiffnessExponent 1, no adhesion and no pull-off force",),
)
"""Plastic contact of two spheres of Exudyn: a linear spring that is stiffer when unloaded, and an imprint."""

with evaluate(False):
    _OF_MODEL_2 = Piecewise((carvalho_martins.members[-1], e > Rational(1, 3)), (gonthier.members[-1], True))
    _MODEL_2 = k * x**n * (1 + c * rate / v_0)

EXUDYN_DAMPED = SimulationCode(
    name="exudyn-damped",
    title="Exudyn, ObjectContactSphereSphere with impactModel 2",
    version="1.13.6; source of commit e4b8e51",
    sources=(
        "github.com/jgerstmayr/EXUDYN main/src/Objects/CObjectContactSphereSphere.cpp, ComputeContactForces",
    ),
    law=ForceLaw("impact model 2", _MODEL_2, where=((c, _OF_MODEL_2),)),
    typed=(
        Typed("contactStiffness", k, "N/m^n", "stiffness"),
        Typed("contactStiffnessExponent", n, "1", "exponent of the force", value=alpha),
        Typed("restitutionCoefficient", e, "1", "to be typed in"),
    ),
    stiffness=k,
    damping=e,
    snippet="ObjectContactSphereSphere(..., contactStiffness={contactStiffness}, contactDamping=0, "
    "contactStiffnessExponent={contactStiffnessExponent}, restitutionCoefficient={restitutionCoefficient}, "
    "impactModel=2)",
    notes=("minimumImpactVelocity below the slowest impact",),
)
"""Impact model 2 of Exudyn: Hunt and Crossley's force with c by Carvalho and Martins, or by Gonthier."""

LAMMPS = SimulationCode(
    name="lammps",
    title="LAMMPS, granular hertz/material, damping coeff_restitution, limit_damping",
    version="commits 07b704c and 14dc2fb; run in 22 Jul 2025",
    sources=(
        "github.com/lammps/lammps src/GRANULAR/gran_sub_mod_damping.cpp, GranSubModDampingCoeffRestitution",
        "github.com/lammps/lammps src/GRANULAR/granular_model.cpp, calculate_forces",
    ),
    law=ForceLaw("hertz/material", TSUJI, where=BY_RATIO),
    typed=(
        Typed("E", E, "Pa", "Young's modulus of both bodies"),
        Typed("e", e, "1", "to be typed in, not the one that is returned"),
        Typed("nu", nu, "1", "Poisson's ratio of both bodies", value=nu),
    ),
    stiffness=E,
    damping=e,
    damping_ends=(1e-9, 1 - 1e-6),
    by_hertz=E,
    snippet="pair_coeff * * hertz/material {E} {e} {nu} tangential ... damping coeff_restitution "
    "limit_damping",
    notes=(
        "numbers are for units si",
        "without limit_damping the force pulls at the end and the typed restitution is returned",
    ),
)
"""Pair style granular of LAMMPS: hertz/material with damping coeff_restitution, limited so as not to pull."""

LIGGGHTS = SimulationCode(
    name="liggghts",
    title="LIGGGHTS-PUBLIC, model hertz with limitForce on",
    version="commits 25fc396 and 84ba3d7; run in 3.8.0",
    sources=(
        "github.com/CFDEMproject/LIGGGHTS-PUBLIC src/normal_model_hertz.h, surfacesIntersect",
        "github.com/CFDEMproject/LIGGGHTS-PUBLIC src/global_properties.cpp, createBetaEff",
    ),
    law=ForceLaw("hertz", TSUJI, where=BY_RATIO),
    typed=(
        Typed("youngsModulus", E, "Pa", "of both bodies"),
        Typed("poissonsRatio", nu, "1", "of both bodies", value=nu),
        Typed("coefficientRestitution", e, "1", "to be typed in, not the one that is returned"),
    ),
    stiffness=E,
    damping=e,
    damping_ends=(0.05 + 1e-6, 1 - 1e-6),  # createCoeffRest takes no 0.05
    by_hertz=E,
    snippet="pair_style gran model hertz limitForce on",
    notes=(
        "a modulus below 5e6 Pa is refused",
        "hard_particles yes before the properties: without it a modulus above 1e9 Pa is refused",
        "with limitForce off, the default, the force pulls at the end and the typed restitution is returned",
    ),
)
"""The normal model hertz of LIGGGHTS: Tsuji's damping by a typed restitution; the force may not pull."""

MUJOCO = SimulationCode(
    name="mujoco",
    title="MuJoCo, solref in the direct format",
    version="4.0.0; documentation of commit 01085bd",
    sources=("github.com/google-deepmind/mujoco doc/modeling.rst, Solver parameters, eq. solref_direct",),
    law=ForceLaw("the soft constraint", m_red * (k * x + b * rate)),
    typed=(
        Typed("solref[0]", k, "1/s^2", "minus the stiffness for each kilogram", scale=Integer(-1)),
        Typed("solref[1]", b, "1/s", "minus the damping for each kilogram", scale=Integer(-1)),
    ),
    stiffness=k,
    damping=b,
    damping_unit=v_0 / depth,
    damping_ends=STRENGTHS,
    snippet='<geom condim="1" solref="{solref[0]} {solref[1]}" solimp="0.999 0.999 0.001"/>',
    notes=(
        "solimp with dmin = dmax, condim 1; with friction the cone has a share in the normal force",
        "the time step must be a small part of the contact time, and the flag refsafe off",
    ),
)
"""Contact of MuJoCo by solref in its direct format: a spring and a dashpot, which do not pull."""

with evaluate(False):
    _RECURDYN = k * x**m_1 + c * rate * x**m_3

RECURDYN = SimulationCode(
    name="recurdyn",
    title="RecurDyn, standard contact force",
    version="the manufacturer's help and questions, as stored; the formula itself is a picture there",
    sources=(
        "functionbay.com/documentation/onlinehelp, Characteristic Page, Standard Contact Force (in words)",
        "functionbay.co.kr, questions: What is the indentation effect of the contact force? (in words: "
        "spring and damping coefficients, exponents m1 of stiffness, m2 of damping, m3 of indentation)",
    ),
    law=ForceLaw("the standard contact force", _RECURDYN),
    typed=(
        Typed("Stiffness Coefficient", k, "N/mm^m1", "spring coefficient", scale=MM**-m_1),
        Typed("Stiffness Exponent", m_1, "1", "m1, of the penetration", value=alpha),
        Typed("Damping Coefficient", c, "N s/mm^(1 + m3)", "with m2 = 1", scale=MM ** (-1 - m_3)),
        Typed("Indentation Exponent", m_3, "1", "m3, as m1: the force never pulls", value=alpha),
    ),
    stiffness=k,
    damping=c,
    damping_unit=m_red * v_0 / depth ** (1 + alpha),
    damping_ends=STRENGTHS,
    snippet="Stiffness Coefficient {Stiffness Coefficient}, Damping Coefficient {Damping Coefficient}, "
    "Stiffness Exponent {Stiffness Exponent}, Damping Exponent 1, "
    "Indentation Exponent {Indentation Exponent}",
    notes=(
        "numbers are for the units mm, kg, N, s",
        "the formula was read from the words that go with its picture, and not seen",
    ),
)
"""Standard contact force of RecurDyn: a power of the penetration, and damping by another power of it."""

with evaluate(False):
    _HUNT_CROSSLEY = Rational(4, 3) * k * x * sqrt(R * k * x) * (1 + Rational(3, 2) * c * rate)
    _TWO_SURFACES = ((k, stiffness ** Rational(2, 3) / 2),)

SIMBODY = SimulationCode(
    name="simbody",
    title="Simbody and OpenSim, HuntCrossleyForce",
    version="simbody commit 178eb21, opensim-core commit 0c0ddb2; run in OpenSim 4.6",
    sources=(
        "github.com/simbody/simbody Simbody/src/HuntCrossleyForce.cpp, calcForce",
        "github.com/simbody/simbody Simbody/src/HuntCrossleyForceImpl.h, Parameters: the power 2/3",
        "github.com/opensim-org/opensim-core OpenSim/Simulation/Model/HuntCrossleyForce.cpp hands both on",
    ),
    law=ForceLaw("HuntCrossleyForce", _HUNT_CROSSLEY, where=_TWO_SURFACES),
    typed=(
        Typed("stiffness", stiffness, "Pa", "of both surfaces"),
        Typed("dissipation", c, "s/m", "of both surfaces"),
    ),
    stiffness=stiffness,
    damping=c,
    damping_unit=1 / v_0,
    damping_ends=STRENGTHS,
    by_hertz=2 ** Rational(3, 2) * elastic,
    snippet="setBodyParameters(surface, {stiffness}, {dissipation}, us, ud, uv)",
    notes=("both surfaces get the same numbers; friction is not part of this card",),
)
"""HuntCrossleyForce of Simbody and OpenSim: Hertz with moduli to the power 2/3, and a dissipation in s/m.

What is typed is raised to the power 2/3 when it is stored. As those powers are put in series, two equal
materials are 0.7071 times as stiff as by Hertz.
"""

_POWERS = (
    "-6.918798", "-16.41105", "146.8049", "-796.4559", "2928.711",
    "-7206.864", "11494.29", "-11342.18", "6276.757", "-1489.915",
)  # fmt: skip
"""Of the first and higher powers of the restitution."""


def _and_lower(higher: Expr, factor: str) -> Expr:
    return e * (Float(factor) + higher)


_POLYNOMIAL: Expr = reduce(_and_lower, reversed(_POWERS), Integer(0))
with evaluate(False):
    _BY_POLYNOMIAL = (
        (zeta, sqrt(Rational(6, 5)) * beta_n),
        (beta_n, sqrt(1 / (1 - (1 + e) ** 2 * exp(_POLYNOMIAL)) - 1)),
        *HERTZ,
    )

YADE = SimulationCode(
    name="yade",
    title="Yade, Ip2_FrictMat_FrictMat_MindlinPhys with en",
    version="2023.02a, run in it; commit 15182ac of its MPI branch has Tsuji's damping, which pulls",
    sources=(
        "Yade 2023.02a, help of Ip2_FrictMat_FrictMat_MindlinPhys: c_n = 2 beta_n sqrt(m k_n) of the tangent "
        "stiffness, beta_n by formula (B6) of Thornton and others 2013",
        "gitlab.com/yade-dev/trunk merge request 919, Update Hertz-Mindlin model and docs",
        "the polynomial: gitlab.com/yade-dev/trunk, benchmarks of Chung and Ooi, Test3.py",
    ),
    law=ForceLaw("MindlinPhys", TSUJI, where=_BY_POLYNOMIAL),
    typed=(
        Typed("young", E, "Pa", "of both materials"),
        Typed("poisson", nu, "1", "of both materials", value=nu),
        Typed("en", e, "1", "normal coefficient of restitution"),
    ),
    stiffness=E,
    damping=e,
    by_hertz=E,
    snippet="FrictMat(young={young}, poisson={poisson}), Ip2_FrictMat_FrictMat_MindlinPhys(en={en})",
    notes=(
        "for two spheres: with a wall or facet Yade takes half of the ball's radius for the effective one",
    ),
)
"""Hertz and Mindlin of Yade with a typed restitution: the damping ratio of Thornton and others, no pull.

C Thornton, S J Cummins, P W Cleary, Powder Technol 233 (2013) 30-46, gave the ratio as a polynomial so that a
force that ends where it would pull returns what is typed. The damping is of the tangent stiffness, 3/2 of the
secant one that (L117) has.
"""

CODES = {
    code.name: code
    for code in (
        ADAMS, CHRONO, DAMPING_FAMILY, DRAKE, EXUDYN, EXUDYN_DAMPED,
        LAMMPS, LIGGGHTS, MUJOCO, RECURDYN, SIMBODY, YADE,
    )
}  # fmt: skip
