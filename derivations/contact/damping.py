"""The damping family F = K x^n (1 + c x'/v_0): what it returns, and the c that authors give for an e.

Here x is the approach, v_0 the impact speed and c a pure number. The bodies part at x = 0, where the force
is zero: no member leaves an imprint. The numbers are this project's own; each formula of c names its author.
The papers themselves were not read for it: formulas are as secondary sources give them, and those that are
claims here follow from the path that their authors took for the true one, as told in their derivation.

Sources:
K H Hunt, F R E Crossley, J Appl Mech 42 (1975) 440, 10.1115/1.3423596;
T W Lee, A C Wang, J Mech Transm Autom Des 105 (1983) 534, 10.1115/1.3267392;
H M Lankarani, P E Nikravesh, J Mech Des 112 (1990) 369, 10.1115/1.2912617;
Y Tsuji, T Tanaka, T Ishida, Powder Technol 71 (1992) 239, 10.1016/0032-5910(92)88030-L;
Y Gonthier, J McPhee, C Lange, J-C Piedboeuf, Multibody Syst Dyn 11 (2004) 209,
10.1023/B:MUBO.0000029392.21648.bc;
P Flores, M Machado, M T Silva, J M Martins, Multibody Syst Dyn 25 (2011) 357, 10.1007/s11044-010-9237-4;
S Hu, X Guo, Multibody Syst Dyn 35 (2015) 131, 10.1007/s11044-015-9453-z;
A S Carvalho, J M Martins, Mech Mach Theory 139 (2019) 174, 10.1016/j.mechmachtheory.2019.03.028.
"""

from __future__ import annotations

from sympy import Expr, Integer, Integral, Rational, Symbol, exp, log, pi, sqrt
from sympy.core.parameters import evaluate

from ..equation import Derivation, Equation, Kind, Ledger, Step, assume, define
from ..vocabulary import Quantity, Vocabulary
from .quantities import SHARED

VOCABULARY = Vocabulary(
    Quantity("x", "normal approach", "m", "x%s", (1e-6, 1e-4)),
    Quantity("xdot", "rate of the approach", "m/s", r"\dot{x}%s", (-5.0, 5.0)),
    Quantity("F", "contact force", "N", "F%s", (1.0, 5000.0)),
    Quantity("F_T", "contact force of discrete elements", "N", "F_{T%s}", (1.0, 5000.0), positive=False),
    Quantity("K_T", "Hertz's stiffness of discrete elements", "N/m^(3/2)", "K_{T%s}", (1e7, 1e10)),
    Quantity("K", "stiffness of the contact", "N/m^n", "K%s", (1e7, 1e10)),
    Quantity("n", "exponent of the force law", "1", "n%s", (1.0, 2.0)),
    Quantity("c", "damping number", "1", "c%s", (0.05, 1.5)),
    Quantity("e", "coefficient of restitution that is wanted", "1", "e%s", (0.05, 0.95)),
    Quantity("e_o", "coefficient of restitution that is returned", "1", "e_{o%s}", (0.05, 0.6)),
    Quantity("v_0", "impact speed", "m/s", "v_{0%s}", (0.5, 8.0)),
    Quantity("m_red", "reduced mass of the two bodies", "kg", "m_{red%s}", (1e-3, 1e-1)),
    Quantity("g", "factor of the force that the damping leaves at separation", "1", "g%s", (0.05, 0.95)),
    Quantity(
        "q", "how far the damping lowers the force at separation, as a logarithm", "1", "q%s", (0.05, 3.0)
    ),
    Quantity("s_d", "logarithm of the damping's factor", "1", "s%s", (-0.5, 0.04)),
    Quantity("sdot", "rate of that logarithm", "1/s", r"\dot{s}%s", (-1e6, -1e3)),
    Quantity("xddot", "acceleration of the approach", "m/s^2", r"\ddot{x}%s", (-1e7, 0.0)),
    Quantity("x_s", "approach with that logarithm", "m", "x_{s%s}", (1e-6, 1e-4)),
    Quantity("t_d", "duration of the contact with damping", "s", "t%s", (1e-6, 1e-3)),
    Quantity("x_m", "maximum approach", "m", "x_{m%s}", (1e-5, 1e-4)),
    Quantity("u_F", "rate at the greatest force, over the impact speed", "1", "u_{F%s}", (0.05, 0.95)),
    Quantity("x_F", "approach at the greatest force", "m", "x_{F%s}", (1e-6, 1e-4)),
    SHARED["F_m"],
    Quantity("J", "mean rate of an undamped path, over the impact speed", "1", "J%s", (0.2, 0.8)),
    Quantity("c_LN", "damping number by Lankarani and Nikravesh", "1", "c_{LN%s}", (0.05, 1.5)),
    Quantity("c_HG", "damping number by Hu and Guo", "1", "c_{HG%s}", (0.05, 1.5)),
    Quantity("c_F", "damping number by Flores and others", "1", "c_{F%s}", (0.05, 1.5)),
    Quantity("c_HC", "damping number by Hunt and Crossley", "1", "c_{HC%s}", (0.05, 1.5)),
    Quantity("c_LW", "damping number by Lee and Wang", "1", "c_{LW%s}", (0.05, 1.5)),
    Quantity("c_G", "damping number by Gonthier and others", "1", "c_{G%s}", (0.05, 1.5)),
    Quantity("c_CM", "damping number by Carvalho and Martins", "1", "c_{CM%s}", (0.05, 1.5)),
    Quantity("zeta", "damping ratio", "1", r"\zeta%s", (0.02, 0.9)),
    Quantity("W", "work of the elastic part up to the maximum approach", "J", "W%s", (1e-3, 1.0)),
    # Each author takes another path for that of the impact, and so another work.
    Quantity("W_LN", "the same, as Lankarani and Nikravesh take it", "J", "W_{LN%s}", (1e-3, 1.0)),
    Quantity("W_HG", "the same, as Hu and Guo take it", "J", "W_{HG%s}", (1e-3, 1.0)),
    Quantity("W_F", "the same, as Flores and others take it", "J", "W_{F%s}", (1e-3, 1.0)),
)
x, rate, F, K, n, c, e, e_o, v_0, m_red, x_m, u_F, x_F, F_m, g, q, J, W = VOCABULARY.plain(
    "x xdot F K n c e e_o v_0 m_red x_m u_F x_F F_m g q J W"
)
s_d, sdot, xddot, x_s, t = VOCABULARY.plain("s_d sdot xddot x_s t_d")
c_LN, c_HG, c_F, c_HC, c_LW, c_G, c_CM = VOCABULARY.plain("c_LN c_HG c_F c_HC c_LW c_G c_CM")
W_LN, W_HG, W_F = VOCABULARY.plain("W_LN W_HG W_F")
zeta, F_T, K_T = VOCABULARY.plain("zeta F_T K_T")
w, y = Symbol("w", positive=True), Symbol("y", positive=True)
sigma = Symbol("sigma", real=True)
half = Rational(1, 2)
_within = c * e_o < 1

with evaluate(False):
    family = Equation(
        "(L101)",
        (F, K * x**n * (1 + c * rate / v_0)),
        "the damping family: Hertz's or Meyer's force, and damping in its proportion",
        Kind.ASSUMPTION,
        "damping family",
    )

    # m x'' = -F as m x' dx' = -F dx, divided by 1 + c x'/v_0; then w = |x'|/v_0 runs from 0 to 1, and to e_o.
    compression = assume(
        (Integral(K * x**n, (x, 0, x_m)), m_red * v_0**2 * Integral(w / (1 + c * w), (w, 0, 1))),
        "Newton's law in compression, variables separated",
        "compression with damping",
    )
    left = define(
        "",
        g,
        1 - c * e_o,
        "factor of the damping at separation",
        "(L101) at the speed of rebound; the force does not pull, so it is positive",
    )
    rebound = assume(
        (Integral(K * x**n, (x, 0, x_m)), m_red * v_0**2 * Integral((1 - w) / w, (w, g, 1)) / c**2),
        "Newton's law in restitution, variables separated, w the factor 1 + c x'/v_0",
        "restitution with damping",
    )
    work = define("", W, Integral(K * x**n, (x, 0, x_m)), "work of the elastic part")
    work_compression = Equation(
        "(L102)",
        (W, m_red * v_0**2 * (c - log(1 + c)) / c**2),
        "(L101) integrated in compression",
        title="work of the elastic part in compression",
    )
    work_rebound = Equation(
        "(L103)",
        (W, m_red * v_0**2 * (g - 1 - log(g)) / c**2),
        "(L101) integrated in restitution, g = 1 - c e_o",
        title="work of the elastic part in restitution",
    )
    power = Equation(
        "(L104)",
        (W, K * x_m ** (n + 1) / (n + 1)),
        "integrated",
        title="work of the elastic part by approach",
    )
    approach = Equation(
        "(L105)",
        (x_m, ((n + 1) * m_red * v_0**2 * (c - log(1 + c)) / (K * c**2)) ** (1 / (n + 1))),
        "(L102) and (L104)",
        title="maximum approach with damping",
        conditions=(c - log(1 + c) > 0,),
    )
    returned = Equation(
        "(L106)",
        (c * (1 + e_o), log((1 + c) / (1 - c * e_o))),
        "both branches do the same elastic work, whatever the exponent (Gonthier; Carvalho, Martins)",
        title="restitution that is returned",
        conditions=(_within,),
    )
    # The factor falls as exp(-c): its logarithm is what can be solved for.
    decay = define("", q, -log(g), "logarithm of that factor")
    by_decay = Equation(
        "(L120)",
        (log(1 + c) + q, c + 1 - exp(-q)),
        "(L106) in terms of the factor exp(-q) = 1 - c e_o that damping leaves at separation",
        title="restitution by the factor of the damping at separation",
    )

    def _by_factor(number: str, of: Symbol, other: Symbol, what: str) -> Equation:
        """The product of both is what the factor falls by up to separation."""
        told = f"{what}, by the factor at separation"
        return Equation(number, (of, (1 - exp(-q)) / other), "what that factor is", title=told, defines=of)

    back = _by_factor("(L168)", e_o, c, "restitution that is returned")
    asked = _by_factor("(L169)", c, e_o, "damping number")

    # The logarithm s of the factor 1 + c x'/v_0 falls from log(1 + c) at impact to -q at separation.
    factor = assume((exp(s_d), 1 + c * rate / v_0), "definition", "logarithm of the factor", Kind.DEFINITION)
    turned = assume(
        (xddot, v_0 * exp(s_d) * sdot / c), "the rate of that", "rate by the logarithm", Kind.DEFINITION
    )
    newton = assume((m_red * xddot, -F), "Newton's law", "Newton's law")
    falls = Equation(
        "(L172)",
        (sdot, -c * K * x**n / (m_red * v_0)),
        "Newton's law with (L101)",
        title="rate of the logarithm of the damping's factor",
    )
    _fallen = 1 + c - log(1 + c) - exp(s_d) + s_d
    work_fallen = assume(
        (
            Integral(K * x**n, (x, 0, x_s)),
            m_red * v_0**2 * Integral(exp(sigma) - 1, (sigma, s_d, log(1 + c))) / c**2,
        ),
        "Newton's law up to that approach, variables separated, by the logarithm of the factor",
        "work by the logarithm of the factor",
    )
    deep = Equation(
        "(L173)",
        (x_s ** (n + 1), (n + 1) * m_red * v_0**2 * _fallen / (K * c**2)),
        "(L101) integrated up to that approach",
        title="approach by the logarithm of the damping's factor",
    )
    _scale = (n + 1) * m_red * v_0**2 / (K * c**2)
    passing = assume(
        (t, Integral(m_red * v_0 / (c * K) * (_scale * _fallen) ** (-n / (n + 1)), (s_d, -q, log(1 + c)))),
        "the way of the logarithm over its rate (L172), with the approach (L173)",
        "way of the logarithm",
    )
    lasting = Equation(
        "(L174)",
        (
            t,
            m_red
            * v_0
            / (c * K * _scale ** (n / (n + 1)))
            * Integral(_fallen ** (-n / (n + 1)), (s_d, -q, log(1 + c))),
        ),
        "what is the same all the way taken out",
        title="duration of the contact with damping",
        defines=t,
    )

    # The greatest force comes before the maximum approach: there dF/dt = 0.
    work_peak = assume(
        (Integral(K * x**n, (x, 0, x_F)), m_red * v_0**2 * Integral(w / (1 + c * w), (w, u_F, 1))),
        "Newton's law up to the greatest force, variables separated",
        "compression up to the greatest force",
    )
    stationary = assume(
        (n * v_0 * u_F / x_F * (1 + c * u_F), c * K * x_F**n * (1 + c * u_F) / (m_red * v_0)),
        "the rate of (L101) over K x^n is zero, with x'' = -F/m",
        "greatest force",
    )
    peak_approach = Equation(
        "(L107)",
        (
            x_F ** (n + 1),
            (n + 1) * m_red * v_0**2 * ((1 - u_F) / c - log((1 + c) / (1 + c * u_F)) / c**2) / K,
        ),
        "(L101) integrated up to the greatest force",
        title="approach at the greatest force",
        conditions=(u_F < 1,),
    )
    peak_speed = Equation(
        "(L108)",
        (n * u_F / (n + 1), c * ((1 - u_F) / c - log((1 + c) / (1 + c * u_F)) / c**2)),
        "the force is greatest where its rate is zero",
        title="rate at the greatest force",
        conditions=(u_F < 1,),
    )
    spot = Equation(
        "",
        (n * m_red * v_0**2 * u_F / (c * K), x_F ** (n + 1)),
        "dF/dt = 0",
        title="approach at the greatest force by the rate there",
    )
    at_peak = assume((F_m, K * x_F**n * (1 + c * u_F)), "(L101) there", "force of the family at its greatest")
    greatest = Equation(
        "(L119)",
        (F_m, K * (n * m_red * v_0**2 * u_F / (c * K)) ** (n / (n + 1)) * (1 + c * u_F)),
        "(L101) where its rate is zero",
        title="greatest force with damping",
        conditions=(u_F < 1,),
    )

    # --- c by the energy of a path that is not the damped one: y = x/x_m, or its power n + 1 ----------------
    def _loss(number: Symbol, elastic: Symbol, mean: Expr, back: Expr, because: str, title: str) -> Equation:
        """The energy that is lost is the work of the damping, (1 + back) times that of compression."""
        lost = half * m_red * v_0**2 * (1 - e**2)
        return assume((lost, (1 + back) * number * mean * elastic), because, title)

    _all = half * m_red * v_0**2
    loss_undamped = _loss(
        c_LN,
        W_LN,
        Integral(sqrt(1 - y), (y, 0, 1)),
        Integer(1),
        "path of the undamped impact in both branches, y = (x/x_m)^(n + 1)",
        "loss on the undamped path",
    )
    all_elastic = assume(
        (_all, W_LN),
        "the elastic work is the kinetic energy: the damping is left out of it",
        "undamped compression",
    )
    loss_hu_guo = _loss(
        c_HG,
        W_HG,
        Integral(sqrt(1 - y), (y, 0, 1)),
        e,
        "the undamped path, in restitution e times as fast",
        "loss by Hu and Guo",
    )
    balance_hu_guo = assume(
        (_all, W_HG * (1 + c_HG * Integral(sqrt(1 - y), (y, 0, 1)))),
        "the kinetic energy is the elastic work and that of the damping",
        "balance of compression by Hu and Guo",
    )
    loss_flores = _loss(
        c_F, W_F, (n + 1) * J, e, "path of a linear spring, in restitution e times as fast", "loss by Flores"
    )
    balance_flores = assume(
        (_all, W_F * (1 + c_F * (n + 1) * J)),
        "the kinetic energy is the elastic work and that of the damping",
        "balance of compression by Flores",
    )
    mean_flores = define(
        "(L109)",
        J,
        Integral(y**n * sqrt(1 - y**2), (y, 0, 1)),
        "path of a linear spring",
        "mean rate of a linear spring's path, weighted with the force",
    )

    tsuji = Equation(
        "(L117)",
        (F_T, K_T * x ** Rational(3, 2) + sqrt(5) * zeta * sqrt(m_red * K_T) * x ** Rational(1, 4) * rate),
        "Hertz's force, and damping with which e is the same at every speed (Tsuji and others 1992); it "
        "pulls at the end",
        Kind.ASSUMPTION,
        "damping of discrete elements",
    )
    damping_ratio = define(
        "(L118)",
        zeta,
        -log(e) / sqrt(pi**2 + log(e) ** 2),
        "damping ratio for an e",
        "of a linear spring with a dashpot that may pull, and of (L117)",
    )

    def _member(
        number: str, of: Symbol, value: Expr, because: str, title: str, kind: Kind = Kind.CLAIM
    ) -> Equation:
        return Equation(number, (of, value), because, kind, title, defines=of)

    lankarani_nikravesh = _member(
        "(L110)",
        c_LN,
        3 * (1 - e**2) / 4,
        "undamped path, both branches alike, any n",
        "Lankarani and Nikravesh 1990",
    )
    hu_guo = _member(
        "(L111)",
        c_HG,
        3 * (1 - e) / (2 * e),
        "undamped path, in restitution e times as fast",
        "Hu and Guo 2015",
    )
    flores = _member(
        "(L112)",
        c_F,
        (1 - e) / (e * (n + 1) * J),
        "path of a linear spring, in restitution e times as fast; 8/5 (1 - e)/e is printed, for n = 3/2",
        "Flores and others 2011",
    )
    hunt_crossley = _member(
        "(L113)",
        c_HC,
        3 * (1 - e) / 2,
        "(L110) for e near 1, where 1 - e^2 is 2 (1 - e); as secondary sources give it",
        "Hunt and Crossley 1975",
        Kind.DEFINITION,
    )
    lee_wang = _member(
        "(L114)",
        c_LW,
        3 * (1 - e) / 4,
        "half of (L113), as secondary sources give it",
        "Lee and Wang 1983",
        Kind.DEFINITION,
    )
    gonthier = _member(
        "(L115)",
        c_G,
        (1 - e**2) / e,
        "explicit approximation of (L106), as secondary sources give it",
        "Gonthier and others 2004",
        Kind.DEFINITION,
    )
    carvalho_martins = _member(
        "(L116)",
        c_CM,
        3 * (1 - e) * (11 - e) / (2 * (1 + 9 * e)),
        "rational approximation of (L106), as secondary sources give it",
        "Carvalho and Martins 2019",
        Kind.DEFINITION,
    )

MEMBERS: dict[str, Equation] = {
    "hunt_crossley": hunt_crossley,
    "lee_wang": lee_wang,
    "lankarani_nikravesh": lankarani_nikravesh,
    "gonthier": gonthier,
    "flores": flores,
    "hu_guo": hu_guo,
    "carvalho_martins": carvalho_martins,
}
"""The formulas of c by name; the exact one is (L106), which gives c for e_o = e."""

LEDGER = Ledger(
    entries=(
        family,
        Derivation.of(
            work_compression,
            (work, compression),
            (W, K),
            "Integrate the separated law from the impact speed to rest.",
        ),
        Derivation.of(
            work_rebound,
            (work, rebound),
            (W, K),
            "Integrate the separated law from rest to the speed of rebound.",
        ),
        Derivation.of(power, (work,), (W,), "Integrate the elastic part."),
        Derivation.of(
            approach,
            (work_compression, power),
            (m_red, W),
            "Put (L104) into (L102) and solve for the approach.",
        ),
        Derivation.of(
            returned,
            (left, work_compression, work_rebound),
            (g, W),
            "Both branches do the same elastic work.",
            multiplier=c**2 / (m_red * v_0**2),
        ),
        Derivation.of(
            by_decay, (decay, left, returned), (g, e_o), "Put the factor in.", multiplier=Integer(-1)
        ),
        Derivation.of(back, (decay, left), (q, g), "Solve for the restitution."),
        Derivation.of(asked, (decay, left), (q, g), "Solve for the number."),
        Derivation.of(peak_approach, (work_peak,), (K,), "Integrate both sides."),
        Derivation.of(
            falls,
            (newton, turned, family, factor),
            (xddot, sdot, F, rate),
            "Put force and rates into Newton's law.",
        ),
        Derivation.of(deep, (work_fallen,), (K,), "Integrate both sides."),
        Derivation.of(lasting, (passing,), (t,), "Take out of the integral what does not change."),
        Derivation.of(
            peak_speed,
            (stationary, peak_approach),
            (K,),
            "Put the stiffness that dF/dt = 0 gives into (L107).",
            multiplier=n * u_F / ((n + 1) * x_F ** (n + 1)),
        ),
        Derivation(
            (
                Step(
                    spot,
                    (stationary,),
                    (),
                    "Clear the fractions.",
                    multiplier=m_red * v_0 * x_F / (c * K * (1 + c * u_F)),
                ),
                Step(greatest, (spot, at_peak), (x_F, F_m), "Put that approach into (L101)."),
            )
        ),
        mean_flores,
        Derivation.of(
            lankarani_nikravesh,
            (all_elastic, loss_undamped),
            (W_LN, c_LN),
            "The work of the damping on the undamped path is the energy that is lost.",
        ),
        Derivation.of(
            hu_guo, (balance_hu_guo, loss_hu_guo), (W_HG, c_HG), "Loss over the balance of compression."
        ),
        Derivation.of(
            flores, (balance_flores, loss_flores), (W_F, c_F), "Loss over the balance of compression."
        ),
        hunt_crossley,
        lee_wang,
        gonthier,
        carvalho_martins,
        tsuji,
        damping_ratio,
    ),
    vocabulary=VOCABULARY,
)
