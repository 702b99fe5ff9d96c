"""The paper as a marimo notebook: what a careful person would write to get the same report.

Proofs by sympy, the ten exponents by scipy, both fits, Table 3 and four figures; for bench_build.py only.
"""

import marimo

app = marimo.App()


@app.cell
def _():
    import itertools

    import marimo as mo
    import numpy as np
    import sympy as sp
    from matplotlib import pyplot as plt
    from scipy.optimize import brentq, least_squares

    return brentq, itertools, least_squares, mo, np, plt, sp


@app.cell
def _(mo, sp):
    a, b, x, sxm, sxp, C, Cp = sp.symbols("alpha beta x x_m x_p C C'", positive=True)
    work_c = sp.integrate(C * x**a, (x, 0, sxm))
    work_r = sp.simplify(-sp.integrate(Cp * ((x - sxp) / (sxm - sxp)) ** b, (x, sxm, sxp)))
    e1, e2, v1, v2, p1, p2 = sp.symbols("e_1 e_2 v_1 v_2 x_p1 x_p2", positive=True)
    q = (a + 1) / (b + 1)
    xm2 = p2 / (1 - e2**2 / q)
    xm1 = xm2 * (v1 / v2) ** (2 / (a + 1))
    eq11 = q + p1 / p2 * (e2**2 - q) * (v2 / v1) ** (2 / (a + 1)) - e1**2
    residual = sp.simplify(sp.together(eq11.subs(p1, xm1 * (1 - e1**2 / q))))
    works = rf"{sp.latex(work_c)} \qquad {sp.latex(work_r)}"
    mo.md(rf"$$ {works} \qquad {sp.latex(eq11)} = 0 $$ residual: {residual}")
    return a, b, e1, e2, eq11, p1, p2, v1, v2


@app.cell
def _(a, b, brentq, e1, e2, eq11, itertools, mo, np, p1, p2, sp, v1, v2):
    V = np.array([2.334, 2.940, 4.089, 4.504, 4.993])
    E = np.array([0.530, 0.512, 0.479, 0.467, 0.453])
    XP = np.array([23.5, 29.7, 41.6, 45.97, 51.03]) * 1e-6
    mass = 7800 * np.pi * 0.0127**3 / 6
    f = sp.lambdify((a, b, e1, e2, v1, v2, p1, p2), eq11)
    pairs = list(itertools.combinations(range(5), 2))
    alpha = np.array([brentq(f, 0.5, 3, args=(1.5, E[i], E[j], V[i], V[j], XP[i], XP[j])) for i, j in pairs])
    second = np.array([j for _, j in pairs])
    xm2_n = XP[second] / (1 - 2.5 / (alpha + 1) * E[second] ** 2)
    C_n = mass * V[second] ** 2 / 2 * (alpha + 1) / xm2_n ** (alpha + 1)
    mo.ui.table(
        [
            {"pair": f"{i + 1}-{j + 1}", "alpha": al, "C": c}
            for (i, j), al, c in zip(pairs, alpha, C_n, strict=True)
        ]
    )
    return C_n, E, V, XP, alpha, mass, pairs, xm2_n


@app.cell
def _(C_n, E, V, XP, alpha, least_squares, mass, mo, np, xm2_n):
    X = (xm2_n[:, None] * np.arange(1, 51) / 50).ravel()
    F = (C_n[:, None] * (xm2_n[:, None] * np.arange(1, 51) / 50) ** alpha[:, None]).ravel()
    slope, intercept = np.polyfit(np.log(X), np.log(F), 1)
    lin = least_squares(lambda p: p[0] * (X / 5e-5) ** p[1] - F, [F.max(), 1.3])
    C_log = np.exp(intercept)
    xm = ((slope + 1) * mass * V**2 / (2 * C_log)) ** (1 / (slope + 1))
    Cp7 = 2.5 * mass * (E * V) ** 2 / (2 * (xm - XP))
    Cp9 = C_log * xm**slope
    mo.md(f"alpha: log-log {slope:.4f}, linear {lin.x[1]:.4f}, mean {alpha.mean():.5f}")
    return C_log, Cp7, Cp9, F, X, slope, xm


@app.cell
def _(Cp7, Cp9, mo, xm):
    mo.ui.table(
        [
            {"k": k + 1, "x_m": a_, "C' (7)": b_, "C' (9)": c_}
            for k, (a_, b_, c_) in enumerate(zip(xm, Cp7, Cp9, strict=True))
        ]
    )
    return


@app.cell
def _(C_log, Cp9, F, X, XP, mo, np, plt, slope, xm):
    fig1, ax1 = plt.subplots()
    ax1.plot(X, F, ".")
    grid = np.linspace(0, xm.max(), 200)
    ax1.plot(grid, C_log * grid**slope)
    for k in range(5):
        r = np.linspace(XP[k], xm[k], 100)
        ax1.plot(r, Cp9[k] * ((r - XP[k]) / (xm[k] - XP[k])) ** 1.5)
    mo.as_html(fig1)
    return


@app.cell
def _(mo, np, plt):
    fig2, ax2 = plt.subplots()
    u = np.linspace(0, 1, 200)
    ax2.plot(u, u**1.5)
    w = np.linspace(0.6, 1, 200)
    ax2.plot(w, ((w - 0.6) / 0.4) ** 1.5)
    mo.as_html(fig2)
    return


@app.cell
def _(mo, np, plt):
    fig3, ax3 = plt.subplots()
    s = np.linspace(0, 1, 200)
    ax3.fill_between(s, s**1.3, 1.1 * s**1.3)
    mo.as_html(fig3)
    return


@app.cell
def _(V, alpha, mo, pairs, plt):
    fig4, ax4 = plt.subplots()
    ax4.plot([(V[i] + V[j]) / 2 for i, j in pairs], alpha, "o")
    mo.as_html(fig4)
    return


@app.cell
def _(mo):
    published = [1.234, 1.275, 1.286, 1.299, 1.303, 1.315, 1.327, 1.355, 1.367, 1.379]
    mo.ui.table([{"published": p} for p in published])
    return


if __name__ == "__main__":
    app.run()
