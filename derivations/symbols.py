"""The vocabulary of the soft-impact paper, and the running numbers of its equations."""

from __future__ import annotations

from sympy import Function, Symbol

from .vocabulary import Quantity, Vocabulary

VOCABULARY = Vocabulary(
    Quantity(
        "v",
        "impact speed, the normal relative velocity before impact",
        "m/s",
        "v'%s",
        (0.5, 8.0),
        text="v'%s",
    ),
    Quantity("e", "normal coefficient of restitution", "1", "e%s", (0.05, 0.9)),
    Quantity("x_p", "imprint depth, the permanent deformation", "m", "x_{p%s}", (5e-6, 9e-5)),
    Quantity("x_m", "maximum normal approach", "m", "x_{m%s}", (1e-5, 1e-4)),
    Quantity("C", "coefficient of the compression law", "N/m^alpha", "C%s", (1e7, 1e10)),
    Quantity("Cprime", "force at the maximum approach", "N", "C'%s", (500.0, 5000.0), text="C'%s"),
    # The law that the paper quotes for comparison has a coefficient and a force of its own, printed alike.
    Quantity("C_LN", "coefficient of Lankarani's law", "N/m^(3/2)", "C%s", (1e7, 1e10), text="C%s"),
    Quantity("F_LN", "force of Lankarani's law", "N", "F%s", (1.0, 5000.0), text="F%s"),
    Quantity("alpha", "exponent of the compression law", "1", r"\alpha%s", (1.0, 1.5)),
    Quantity("beta", "exponent of the restitution law", "1", r"\beta%s", (1.0, 2.5)),
    Quantity("m_red", "reduced mass of the two bodies", "kg", "m_{red%s}", (1e-3, 1e-1)),
    Quantity("m_1", "mass of the ball", "kg", "m_{1%s}", (1e-3, 1e-1)),
    Quantity("m_2", "mass of the target", "kg", "m_{2%s}", (1e-3, 1e2)),
    Quantity(
        "mu", "mass of the ball over the mass of the target", "1", r"\mu%s", (1e-4, 2.0), positive=False
    ),
    Quantity("rho", "density of the ball", "kg/m^3", r"\rho%s", (1e3, 1e4)),
    Quantity("d", "diameter of the ball", "m", "d%s", (1e-3, 5e-2)),
    Quantity("x", "normal approach", "m", "x%s", (1e-6, 1e-4)),
    Quantity("F", "impact force", "N", "F%s", (1.0, 5000.0)),
    Quantity("z", "height over the ball's centre", "m", "z%s", (-1e-3, 1e-3)),
    Quantity("u", "reciprocal of alpha + 1", "1", "u%s", (0.3, 0.6)),
    Quantity(
        "u_turn", "u at which the logarithm turns", "1", r"u_{\mathrm{turn}%s}", (0.05, 0.95), positive=False
    ),
    Quantity(
        "v_n1",
        "normal component of the relative velocity before impact",
        "m/s",
        r"\mathbf{v}'\cdot\mathbf{n}%s",
        (0.5, 8.0),
        text="v'.n%s",
    ),
    Quantity(
        "v_n2",
        "normal component of the relative velocity after impact",
        "m/s",
        r"\mathbf{v}''\cdot\mathbf{n}%s",
        (-8.0, -0.05),  # the bodies come apart again
        text="v''.n%s",
    ),
    Quantity("Lambda", "logarithm of the ratio of both impact speeds", "1", r"\Lambda%s", (-2.0, 2.0)),
    Quantity("n", "exponent of Meyer's law", "1", "n%s", (2.0, 3.0)),
    Quantity(
        "x_ref", "approach that makes the logarithms pure numbers", "m", r"x_{\mathrm{ref}%s}", (1e-5, 1e-4)
    ),
    Quantity(
        "F_ref", "force that makes the logarithms pure numbers", "N", r"F_{\mathrm{ref}%s}", (100.0, 5000.0)
    ),
    Quantity("x_top", "largest approach of the pair", "m", r"x_{\mathrm{top}%s}", (1e-5, 1e-4)),
    Quantity("X", "logarithm of a point's approach over the reference", "1", "X%s", (-1.0, 1.0)),
    Quantity("Y", "logarithm of a point's force over the reference", "1", "Y%s", (-1.0, 1.0)),
    Quantity("Xmean", "mean of X over the points", "1", r"\bar{X}%s", (-1.0, 1.0)),
    Quantity("Ymean", "mean of Y over the points", "1", r"\bar{Y}%s", (-1.0, 1.0)),
    Quantity("a", "intercept of the fitted line", "1", "a%s", (-1.0, 1.0)),
    Quantity("b", "slope of the fitted line", "1", "b%s", (-1.0, 1.0)),
    Quantity("C_b", "coefficient of the fitted line", "N/m^b", "C%s", (1e7, 1e10), text="C%s"),
    Quantity("alpha_mean", "mean exponent", "1", r"\bar{\alpha}%s", (1.0, 1.5)),
    Quantity("alpha_median", "median exponent", "1", r"\tilde{\alpha}%s", (1.0, 1.5)),
    # The fit to all tests at once: what was measured beside the values that lie on one curve.
    Quantity("x_0", "mean imprint depth, at which the curve has the force F_0", "m", "x_{0%s}", (1e-5, 9e-5)),
    Quantity("v_0", "mean impact speed", "m/s", "v_{0%s}", (0.5, 8.0)),
    Quantity("alpha_0", "exponent at which the global fit begins", "1", r"\alpha_{0%s}", (0.5, 2.0)),
    Quantity("F_0", "force at the mean imprint depth", "N", "F_{0%s}", (100.0, 5000.0)),
    Quantity("v_obs", "impact speed, as measured", "m/s", r"\tilde{v}'%s", (0.5, 8.0), text="v'~%s"),
    Quantity("e_obs", "coefficient of restitution, as measured", "1", r"\tilde{e}%s", (0.05, 0.9)),
    Quantity("x_obs", "imprint depth, as measured", "m", r"\tilde{x}_{p%s}", (5e-6, 9e-5)),
    Quantity("u_v", "standard uncertainty of the impact speed", "m/s", r"u(v'%s)", (1e-4, 1e-3)),
    Quantity("u_e", "standard uncertainty of the restitution", "1", r"u(e%s)", (1e-4, 1e-3)),
    Quantity("u_x", "standard uncertainty of the imprint depth", "m", r"u(x_{p%s})", (1e-6, 1e-5)),
    Quantity(
        "D", "change of the imprint depth with the exponent, for a given force F_0", "m", "D%s", (-1e-4, 1e-4)
    ),
    Quantity("B_v", "change of the imprint depth with the speed", "s", "B_{v%s}", (1e-6, 1e-4)),
    Quantity("B_e", "change of the imprint depth with the restitution", "m", "B_{e%s}", (-1e-4, -1e-6)),
    Quantity("W", "weight of the test", "1/m^2", "W%s", (1e10, 1e20)),
    Quantity("R", "misfit of the test", "m", "R%s", (-1e-6, 1e-6)),
    Quantity("lam", "multiplier: how hard the test pulls", "1/m", r"\lambda%s", (-1e9, 1e9)),
    # The normal matrix of exponent and force.
    Quantity("S_DD", "sum of the weighted squares of D", "1", "S_{DD%s}", (1e5, 1e6)),
    Quantity("S_DX", "sum of the weighted products of D and x_p", "1", "S_{DX%s}", (-1e5, 1e5)),
    Quantity("S_XX", "sum of the weighted squares of x_p", "1", "S_{XX%s}", (1e7, 1e8)),
    Quantity("Delta", "determinant of the normal matrix", "1", r"\Delta%s", (1e12, 1e14)),
    Quantity("h", "leverage of the test: how far the curve follows it", "1", "h%s", (0.01, 0.99)),
    Quantity("alpha_k", "exponent without the test, to first order", "1", r"\alpha'%s", (1.0, 1.5)),
    Quantity("phi", "step of the force that goes with it", "1", r"\varphi%s", (-0.1, 0.1)),
    # How sure the force of the curve is; c are the elements of the covariance matrix of alpha and ln F_0.
    Quantity("c_aa", "variance of the exponent", "1", r"c_{\alpha\alpha%s}", (1e-6, 1e-4)),
    Quantity(
        "c_aF",
        "covariance of the exponent and the logarithm of the force F_0",
        "1",
        r"c_{\alpha F%s}",
        (-1e-7, 1e-7),
    ),
    Quantity("c_FF", "variance of the logarithm of the force F_0", "1", "c_{FF%s}", (1e-6, 1e-4)),
    Quantity("u_C", "standard uncertainty of the force on the curve", "N", "u(C'%s)", (1.0, 100.0)),
    Quantity("dC", "what its misfit adds to the force of the test", "N", r"\delta C'%s", (-100.0, 100.0)),
    Quantity("u_new", "standard deviation of the force of a further test", "N", "u_{+}(C'%s)", (1.0, 100.0)),
    # The exponent may go with the depth: alpha + tau ln(x/x_0).
    Quantity("tau", "trend: what the exponent gains as the depth grows e-fold", "1", r"\tau%s", (-1.0, 1.0)),
    Quantity("u_tau", "standard uncertainty of the trend", "1", r"u(\tau%s)", (1e-3, 1.0)),
    Quantity("gamma", "relative change of the maximum force with the trend", "1", r"\gamma%s", (-1.0, 1.0)),
    Quantity("G", "change of the approach with the trend", "m", "G%s", (-1e-4, 1e-4)),
    Quantity("T", "change of the imprint depth with the trend", "m", "T%s", (-1e-4, 1e-4)),
    Quantity("S_TT", "sum of the weighted squares of T", "1", "S_{TT%s}", (1e5, 1e6)),
    Quantity("S_TD", "sum of the weighted products of T and D", "1", "S_{TD%s}", (-1e5, 1e5)),
    Quantity("S_TX", "sum of the weighted products of T and x_p", "1", "S_{TX%s}", (-1e5, 1e5)),
    Quantity("Q", "what of S_TT exponent and force do not make up for", "1", "Q%s", (1e3, 1e5)),
    Quantity("dchi2", "sum of squares that the trend takes off", "1", r"\Delta\chi^2%s", (0.1, 100.0)),
    Quantity(
        "G_alpha",
        "half of what a larger exponent takes off the sum of squares; zero at the least sum",
        "1",
        r"G_{\alpha%s}",
        (-1e3, 1e3),
    ),
    Quantity(
        "G_F",
        "half of what a smaller force takes off the sum of squares, times alpha + 1; zero at the least sum",
        "1",
        r"G_{F%s}",
        (-1e3, 1e3),
    ),
    Quantity(
        "chi2",
        "sum of squares of all deviations, each over its standard uncertainty",
        "1",
        r"\chi^2%s",
        (0.1, 100.0),
    ),
    Quantity(
        "u_alpha",
        "standard uncertainty of the exponent by the adjusted points",
        "1",
        r"u(\alpha%s)",
        (1e-4, 1e-1),
    ),
    Quantity("z_R", "misfit of the test, in standard deviations", "1", "z%s", (-5.0, 5.0)),
    Quantity(
        "u_B",
        "standard uncertainty of the exponent by the scatter: times the Birge ratio, with Student's t",
        "1",
        r"u_{\mathrm{B}}(\alpha%s)",
        (1e-4, 1e-1),
    ),
    Quantity("R_B", "Birge ratio", "1", r"R_{\mathrm{B}%s}", (0.1, 10.0)),
    Quantity("N", "number of generated points of a pair", "1", "N%s", (5.0, 50.0)),
)


k = Symbol("k", integer=True, positive=True)
p = Symbol("p", integer=True, positive=True)
q = Symbol("q", integer=True, positive=True)
s = Symbol("s", integer=True, positive=True)
"""The running numbers: k of a test, p of a pair, q of a point, s of a point within its pair."""

F_of, F_LN_of = Function("F"), Function("F_LN")
"""The force as an unknown function of the approach, before a law is put in: the model's, and Lankarani's."""
