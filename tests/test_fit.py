"""Fits in the body of a method: certified digits, proofs that fail if they are wrong, and what is told."""

from __future__ import annotations

import itertools
import math
import re
import types
from dataclasses import replace
from pathlib import Path
from typing import Any

import nist_strd
import numpy as np
import pytest
from adjusted import adjusted
from helpers import method_folder
from nist_strd import Strd, digits
from sympy import Expr, IndexedBase, Sum, Symbol, exp, sin, symbols

import loopsheet
import loopsheet.report.method.words
from loopsheet import Method, fit, given, let, measured, unknown
from loopsheet.derivations.equation import Derivation, Equation, Kind, Ledger, Step
from loopsheet.derivations.least_squares import LeastSquares
from loopsheet.derivations.proof import check_step, prove
from loopsheet.derivations.proved import ProofStatus
from loopsheet.report.cells.values import CODES, Values
from loopsheet.report.cli import main
from loopsheet.report.engines import exact
from loopsheet.report.engines.numpy import evaluate
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.misfit import least_squares_of_errors
from loopsheet.report.uncertainty.monte_carlo import draw
from loopsheet.report.uncertainty.propagation import Spread

LINEAR, NONLINEAR = nist_strd.linear(), nist_strd.nonlinear()
Array = nist_strd.Array

# --- against certified values ----------------------------------------------------------------------------


def method_of(strd: Strd, start: Array) -> Any:
    """The set as a method: an author would write it in the body of a class."""

    def fill(body: dict[str, Any]) -> None:
        where: dict[Expr, Any] = {}
        for name in (*strd.of, Symbol("y")):
            body[str(name)] = measured("1", str(name))
            where[name] = body[str(name)]
        for parameter, first in zip(strd.parameters, start, strict=True):
            body[str(parameter)] = unknown(str(parameter), start=float(first))
            where[parameter] = body[str(parameter)]
        body["f"] = fit(where[Symbol("y")], strd.value.xreplace(where))

    return types.new_class("Set", (Method,), {}, fill)


def computed(strd: Strd, start: Array, engine: Any = evaluate) -> Values:
    sheet = method_of(strd, start).workbook.sheet(frozenset())
    data = {**{str(name): column for name, column in strd.of.items()}, "y": strd.y}
    values = engine(sheet, {"readings": range(1, len(strd.y) + 1)}, data)
    found: Values = values if engine is evaluate else values.rounded(sheet)
    return found


def cells(values: Values, *names: Any) -> Array:
    return np.array([values.scalar(str(name)) for name in names])


IN_DOUBLES = {
    "Norris": 11, "Pontius": 11, "NoInt1": 11, "NoInt2": 11, "Longley": 11, "Filip": 7, "Wampler1": 9,
    "Wampler2": 11, "Wampler3": 9, "Wampler4": 8, "Wampler5": 6,
}  # fmt: skip
"""Digits of the worst parameter that doubles keep, of eleven that are looked at: Filip's polynomial of the
tenth degree and Wampler's of the fifth are close to what rows do not tell apart."""


@pytest.mark.parametrize("name", LINEAR)
def test_linear_sets_come_out_as_certified(name: str) -> None:
    strd = LINEAR[name]
    (start,), scatter = strd.starts, [f"s_{each}" for each in strd.parameters]
    values = computed(strd, start, exact.evaluate)
    assert digits(cells(values, *strd.parameters), strd.certified) == 11
    if strd.deviations.any():
        assert digits(cells(values, *scatter), strd.deviations) == 11
    else:  # the points lie on the polynomial, as doubles write them
        assert cells(values, *scatter) == pytest.approx(0, abs=1e-15)
    doubles = cells(computed(strd, start), *strd.parameters)
    assert IN_DOUBLES[name] <= digits(doubles, strd.certified)
    assert digits(doubles * (1 + 1e-5), strd.certified) < min(IN_DOUBLES.values())


@pytest.mark.parametrize(
    "name", ["BoxBOD", "Chwirut2", "Kirby2", "Misra1b", "Misra1d", "Roszman1", "Thurber"]
)
def test_nonlinear_sets_come_out_as_certified(name: str) -> None:
    strd = NONLINEAR[name]
    values = computed(strd, strd.starts[1])
    scatter = [f"s_{each}" for each in strd.parameters]
    assert digits(cells(values, *strd.parameters), strd.certified) > 10
    assert digits(cells(values, *scatter), strd.deviations) > 10
    assert digits(cells(values, "f_S"), np.array([strd.squares])) > 9.5


@pytest.mark.parametrize("name", ["BoxBOD", "Nelson", "Rat42", "Thurber"])
def test_steps_that_are_too_long_are_made_shorter(name: str) -> None:
    """From NIST's farther start, where whole steps lead nowhere."""
    strd = NONLINEAR[name]
    values = computed(strd, strd.starts[0])
    assert digits(cells(values, *strd.parameters), strd.certified) > 6


def test_a_fit_that_rests_steps_no_more() -> None:
    """Nothing is left of a step, not even the rounding of 50 digits; what stays is no zero."""
    strd = NONLINEAR["Misra1a"]
    values = computed(strd, strd.starts[1], exact.evaluate)
    names = [name for name in values.value if name.startswith("f_")]
    assert {"f_step1", "f_step2", "f_d1", "f_d2"} == {n for n in names if not values.value[n].any()}


@pytest.mark.parametrize("name", ["Eckerle4", "MGH10", "Rat43"])
def test_from_a_start_that_leads_nowhere_there_is_no_number(name: str) -> None:
    strd = NONLINEAR[name]
    values = computed(strd, strd.starts[0])
    for parameter in strd.parameters:
        (cell,) = values.cells(str(parameter))
        assert (CODES[cell.status], cell.value) == ("#NOROOT!", None)
        assert "begin nearer" in cell.reason
    assert not (values.status["f_fitted"] == 0).any()


def test_weights_are_those_of_the_solver() -> None:
    """Stated uncertainties and a formula of them, beside least squares by another way."""
    rng = np.random.default_rng(7)
    t, size = rng.uniform(0, 3, 14), rng.uniform(0.01, 0.2, 14)
    y = 2 + 0.3 * t + 1.5 * t**2 + rng.normal(0, size)

    def body_of(u: Any) -> Any:
        def fill(body: dict[str, Any]) -> None:
            body["t"], body["y"] = measured("s", "time"), measured("m", "length")
            body["q"] = measured("m", "other size")
            for name in "abc":
                body[name] = unknown(name)
            model = body["a"] + body["b"] * body["t"] + body["c"] * body["t"] ** 2
            body["f"] = fit(body["y"], model, u=body["q"] / 2 if u is None else u)

        return types.new_class("Weighed", (Method,), {}, fill)

    a, b, c, x, v = symbols("a b c t y")
    found = adjusted(a + b * x + c * x**2, v, (a, b, c), {x: t, v: y}, {v: size}, [0, 0, 0])
    scatter = math.sqrt(found.chi2 / (len(t) - 3)) * found.u
    for u in ("stated", None):
        method = body_of(u)
        sheet = method.workbook.sheet(frozenset())
        data = {"t": t, "y": y, "q": 2 * size, **({"u_y": size} if u else {})}
        values = evaluate(sheet, {"readings": range(1, 15)}, data)
        assert cells(values, *"abc") == pytest.approx(found.parameters, rel=1e-12)
        assert cells(values, "s_a", "s_b", "s_c") == pytest.approx(scatter, rel=1e-10)
        assert values.scalar("f_S") == pytest.approx(found.chi2, rel=1e-12)
        assert [sheet[name].unit for name in ("a", "b", "c", "f_s")] == ["m", "m/s", "m/s^2", "1"]
        assert [(curve.name, curve.weighed) for curve in method.workbook.curves] == [("f_S", True)]


def test_of_rows_without_a_number_nothing_is_told() -> None:
    strd = LINEAR["Pontius"]
    some, every = slice(3, None), slice(None)
    y = strd.y.copy()
    y[:3] = math.nan
    values = [
        computed(strd._replace(y=y[rows], of={name: x[rows] for name, x in strd.of.items()}), strd.starts[0])
        for rows, y in ((every, y), (some, strd.y))
    ]
    for name in ("b0", "b1", "b2", "f_s", "s_b0", "s_b2", "r_b0_b1"):
        assert values[0].scalar(name) == pytest.approx(values[1].scalar(name), rel=1e-12)


# --- what an author writes -------------------------------------------------------------------------------


class Decay(Method, rows="counts"):
    """Decay in a background."""

    t = measured("s", "time")
    rate = measured("s^-1", "rate")
    first = given("s^-1", "rate to begin with", positive=True)
    A = unknown("initial rate", "s^-1", start=2 * first)
    tau = unknown("life time", "s", start=3.0)
    decay = fit(rate, A * exp(-t / tau), label="(7)")
    twice = let(decay.s_tau / tau * 2, "relative uncertainty, k = 2")


def test_a_fit_has_cells_equations_and_figures() -> None:
    book = Decay.workbook
    sheet = book.sheet(frozenset())
    assert [sheet[name].unit for name in ("A", "tau", "s_tau", "decay_fitted", "decay_S", "twice")] == [
        "s^-1", "s", "s", "s^-1", "s^-2", "1",
    ]  # fmt: skip
    labels = [equation.label for equation in book.ledger().equations()]
    assert [label for label in labels if not label.startswith("(L")] == [
        *("(7g)", "(7h)", "(7a)", "(7b)", "(7c)", "(7d)", "(7e)", "(7f)", "(7i)", "(2)"),
    ]
    assert book.headline == ("A", "tau", "twice")
    assert book.aside >= {"decay_N1", "decay_J2", "decay_step1"}
    over, left = book.charts
    assert [(s.x, s.y, s.style) for s in over.series] == [
        ("t", "rate", "points"),
        ("decay_curve_x", "decay_curve_y", "line"),
    ]
    assert [(s.x, s.y) for s in left.series] == [("t", "decay_residual")]


HEAD = "    x = measured('m', 'place')\n    y = measured('V', 'voltage')\n    a = unknown('offset')\n"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("f = fit(y, 2 * x)", "the model of f names no unknown: write a = unknown('...') above"),
        ("b = unknown('more'); f = fit(y, a * x)", "b is announced as unknown, and neither a root nor a fit"),
        (
            "f = fit(y, sin(a) * x)",
            "the model of f is not linear: say where to begin, a = unknown(..., start=...)",
        ),
        ("f = fit(2 * y, a)", "2*y[k] is no column over the rows: let(...) it be one"),
        ("f = fit(y, a + x)", "f_z (L1): cannot add m and A^-1 kg m^2 s^-3"),
        ("f = fit(y, a, u='known')", "u is a formula, or 'stated', not 'known'"),
        (
            "z = let(2 * y, 'twice'); f = fit(z, a, u='stated')",
            "f: nothing is stated of z, which is computed: give a formula of its standard uncertainties",
        ),
        ("a_1 = unknown('x', start=1); f = fit(y, a + sin(a_1 * x))", "the model of f is not linear"),
        ("s_a = let(x, 'x'); f = fit(y, a)", "s_a is declared twice: f has one of that name, too"),
        (
            "b = unknown('b'); f = fit(y, a + b * x); f_points = let(b, 'b')",
            "the column 'f_points' is called as",
        ),
        (
            "f = fit(y, a); g = let(f.scatter, 'scatter')",
            "scatter is nothing that a fit has: there are a, s_a, s, f",
        ),
        (
            "S = unknown('x'); f = fit(y, a + S * x)",
            "S is a word of the fit f itself: call the parameter otherw",
        ),
        ("s_a = unknown('x'); f = fit(y, a + s_a * x)", "s_a is a word of the fit f itself"),
        ("a = root(a, 1, 'x', low=0, high=2)", "a = unknown() is enough: root(...) says what a is"),
        ("b = unknown('b', 's', start=1); f = fit(y, b * x)", "f_residual (1e): cannot add m s and A^-1"),
    ],
)
def test_a_wrong_fit_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], line: str, said: str
) -> None:
    words = "from sympy import sin\nfrom loopsheet import Method, fit, let, measured, root, unknown\n"
    code = f"{words}\n\nclass Wrong(Method):\n    'W.'\n\n{HEAD}    {line}\n"
    method_folder(tmp_path, code, "reading,x [m],y [V]\n1,1.0,2.0\n")
    assert main(["check", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert re.search(r"workbook\.py:\d+", told)


@pytest.mark.parametrize(
    ("model", "rows", "told"),
    [
        ("a + b * x + c * (2 * x + 3)", 6, "these rows do not tell c from a and b"),
        ("a + b * x", 1, "2 parameters take 2 rows or more"),
        ("a + b * x", 2, "2 parameters leave nothing over of as many rows"),
        ("a + b * x + c * x**2", 3, "3 parameters leave nothing over of as many rows"),
        ("a * b * x", 6, "begin nearer"),
    ],
)
def test_what_rows_do_not_tell_has_no_value(model: str, rows: int, told: str) -> None:
    names = [name for name in "abc" if name in model]
    lines = ["x, y = measured('1', 'x'), measured('1', 'y')"]
    lines += [f"{name} = unknown('{name}', start=1)" for name in names]
    body = "".join(f"    {line}\n" for line in (*lines, f"f = fit(y, {model})"))
    scope = dict(vars(loopsheet.report.method.words))
    exec(f"class Few(Method):\n{body}", scope)
    method: Any = scope["Few"]
    x = np.array([0.1, 0.4, 0.9, 1.3, 1.8, 2.5])[:rows]
    sheet = method.workbook.sheet(frozenset())
    values = evaluate(sheet, {"readings": range(1, rows + 1)}, {"x": x, "y": x**3})
    why = {cell.reason for name in (*names, "f_s") for cell in values.cells(name) if cell.status}
    assert any(told in each for each in why), why
    assert all(math.isnan(values.scalar(f"s_{name}")) for name in names)


WEIGHED = """\
from sympy import exp

from loopsheet import Method, fit, measured, unknown


class Weighed(Method):
    x = measured("s", "time")
    y = measured("V", "voltage")
    a, b = unknown("offset"), unknown("slope")
    line = fit(y, a + b * x, u="stated")
    A, tau = unknown("begin", "mV", start=2000), unknown("time constant", "ms", start=5000)
    growth = fit(y, A * exp(x / tau), u="stated")
"""


def test_two_fits_of_one_column_by_its_stated_uncertainties(tmp_path: Path) -> None:
    """A start has the unit that is sought; the sums of squares tell whether the model describes the rows."""
    rows = "1,1.0,2105(20)\n2,2.0,3120(30)\n3,3.5,4650(20)\n4,4.0,5090(40)\n5,5.0,6120(40)\n"
    method_folder(tmp_path, WEIGHED, f"reading,x [s],y [mV]\n{rows}", '[uncertainty]\nx = "exact"\n')
    assert main(["build", str(tmp_path), "--to", "html", "--out", str(tmp_path / "out")]) == 0
    assert (
        "Letters behind the number of a fit are this project’s"
        in (tmp_path / "out" / "report.html").read_text()
    )
    report = Study(tmp_path).computed
    assert not report.faults
    time, size = np.array([1, 2, 3.5, 4, 5]), np.array([0.02, 0.03, 0.02, 0.04, 0.04])
    volts = np.array([2.105, 3.12, 4.65, 5.09, 6.12])
    slope, offset = np.polyfit(time, volts, 1, w=1 / size)
    assert cells(report.values, "a", "b") == pytest.approx([offset, slope], rel=1e-12)
    assert [report.sheet[name].rule.start for name in ("A", "tau")] == [2, 5]
    found = loopsheet.load(tmp_path).findings
    assert any("growth_residual: chi2 = " in line and "does not describe" in line for line in found)
    assert not any("line_residual" in line for line in found)


LINE = """\
from loopsheet import Method, fit, measured, unknown


class Line(Method):
    x = measured("s", "time")
    y = measured("mV", "voltage")
    a, b = unknown("offset", "mV"), unknown("slope", "mV/s")
    line = fit(y, a + b * x)
"""
TIME = np.array([1, 2, 3.5, 4, 5, 7])
VOLTS = np.array([2.1, 3.2, 4.7, 4.9, 6.3, 8.2])


def of_line(folder: Path, said: str, code: str = LINE, sizes: Any = "") -> tuple[Any, list[str]]:
    """What is known of the residuals of a line, and what is told of it."""
    sizes = [f"({size})" if size else "" for size in (sizes or [0] * 6)]
    read = zip(TIME, VOLTS, sizes, strict=True)
    rows = "".join(f"{n},{x},{y}{u}\n" for n, (x, y, u) in enumerate(read, start=1))
    method_folder(folder, code, f"reading,x [s],y [mV]\n{rows}", f"[uncertainty]\n{said}")
    report = Study(folder).computed
    told = [
        check.message
        for check in report.oddities
        if check.kind == "squares" and (check.word or check.skipped)
    ]
    return report.uncertain().misfits.get("line_S"), told


def least(covariance: Array) -> float:
    """The least sum of squares with a covariance matrix of what was observed."""
    slopes, inverse = np.stack([np.ones(6), TIME], axis=1), np.linalg.inv(covariance)
    found = np.linalg.solve(slopes.T @ inverse @ slopes, slopes.T @ inverse @ VOLTS)
    left = VOLTS - slopes @ found
    return float(left @ inverse @ left)


def test_residuals_are_held_against_what_is_stated(tmp_path: Path) -> None:
    """However rows were weighed, whatever they share and whichever variable has the error."""
    own = np.array([1, 2, 1, 3, 2, 1]) * 0.1
    exact, weighed = 'x = "exact"\n', LINE.replace("b * x)", 'b * x, u="stated")')
    for code in (LINE, weighed):
        known, _ = of_line(tmp_path, exact, code, [1, 2, 1, 3, 2, 1])
        assert (known.chi2, known.dof, known.known_by) == (pytest.approx(least(np.diag(own**2))), 4, math.inf)
    shared = '[uncertainty.shared."zero"]\nof = "y"\nstated = "u = 0.5 mV"\ngroups = [[1, 2], [3, 4, 5, 6]]\n'
    known, _ = of_line(tmp_path, f'{exact}y = "u = 0.2 mV"\n{shared}', LINE)
    group = np.array([0, 0, 1, 1, 1, 1])
    together = np.eye(6) * 0.2**2 + 0.5**2 * (group[:, None] == group)
    assert known.chi2 == pytest.approx(least(together))
    known, _ = of_line(tmp_path, 'x = "u = 0.3 s"\ny = "u = 0.1 mV"\n')
    assert known.chi2 == pytest.approx(of_both(VOLTS, 0.3, 0.1)[0], rel=1e-6)


def of_both(volts: Array, u_x: float, u_y: float) -> tuple[float, float]:
    """With errors in both variables: by differences of what polyfit leaves, and by the adjusted points."""

    def left(data: Array) -> Array:
        x, y = data[:6], data[6:]
        return np.asarray(y - np.polyval(np.polyfit(x, y, 1), x))

    data, step, size = np.concatenate([TIME, volts]), 1e-4, [u_x] * 6 + [u_y] * 6
    moved = np.stack([left(data + step * e) - left(data - step * e) for e in np.diag(size)]) / (2 * step)
    found, dof = least_squares_of_errors(left(data), moved.T @ moved, np.full(6, u_y), 2)
    assert dof == 4
    a, b, x, y = symbols("a b x y")
    sizes = {x: np.full(6, u_x), y: np.full(6, u_y)}
    return found, adjusted(a + b * x, y, (a, b), {x: TIME, y: volts}, sizes, [0, 1]).chi2


def test_errors_of_both_variables_count_as_adjusted_points_do() -> None:
    """To first order: what is missing falls with the square of the errors."""
    line = np.polyval(np.polyfit(TIME, VOLTS, 1), TIME)
    first, second = (
        abs(1 - found / adjusted)
        for part in (1, 0.1)
        for found, adjusted in [of_both(line + part * (VOLTS - line), part * 0.3, part * 0.1)]
    )
    assert second < 1e-4
    assert first == pytest.approx(100 * second, rel=0.1)


def test_a_scatter_that_is_not_what_was_stated_is_told(tmp_path: Path) -> None:
    """Too much, too little, what the scatter itself says, few readings, and what the printed digits say."""
    (_, (said,)) = of_line(tmp_path, 'x = "exact"\ny = "u = 0.01 mV"\n')
    scatter = math.sqrt(least(np.eye(6)) / 4)
    assert "does not describe all readings, or their standard uncertainties are understated" in said
    assert f"u is {scatter / 0.01:.0f} times what is stated (Birge's ratio): y = " in said
    (stated,) = re.findall('"(u = .*, dof = 4)"', said)
    (known, told) = of_line(tmp_path, f'x = "exact"\ny = "{stated}"\n')
    assert not told
    assert known.chi2 == pytest.approx(4, rel=0.05)
    (_, (said,)) = of_line(tmp_path, 'x = "exact"\ny = "u = 3 mV"\n')
    assert "the standard uncertainties of the readings are overstated" in said
    (_, (said,)) = of_line(tmp_path, 'x = "exact"\ny = "u = 0.04 mV"\n')
    (_, told) = of_line(tmp_path, 'x = "exact"\ny = "u = 0.04 mV, dof = 2"\n')
    assert "understated" in said
    assert not told  # two degrees of freedom may be as far off
    (known, told) = of_line(tmp_path, 'x = "exact"\ny = "exact"\n')
    assert known is None
    assert told == ["line_S: y has no uncertainty to compare the residuals with, or too many rows"]
    (known, (said,)) = of_line(tmp_path, 'x = "exact"\n')
    assert not known.is_stated
    assert "times what the printed digits say" in said
    (_, told) = of_line(tmp_path, '[expected]\nline_S = "the clock jumped"\n')
    assert told == [f"{said.partition(';')[0]}{said[said.index(';') :]}, as is expected"] or not told


DECAY = """from sympy import exp
from loopsheet import Method, fit, measured, unknown


class Decay(Method):
    '''Counts that decay.'''

    t = measured("s", "time")
    A = measured("1", "counts")
    A_0 = unknown("counts at first", start=10)
    c = unknown("rate", unit="1/s", start=0.4)
    f = fit(A, A_0 * exp(-c * t))
"""


def test_how_far_a_fit_steps_is_no_corner_of_what_it_finds(tmp_path: Path) -> None:
    """Terms of second order make u of the rate a twelfth larger, as draws do."""
    rows = "1,0.0,10.2\n2,2.0,4.1\n3,4.0,2.4\n4,6.0,0.7\n5,8.0,0.6\n"
    said = '[uncertainty]\nA = "u = 1.0"\nt = "exact"\n'
    method_folder(tmp_path, DECAY, f"test,t [s],A [1]\n{rows}", said)
    report = Study(tmp_path).computed
    budget = Spread(report.inputs, report.values).budget("c", 0)
    assert budget.unlooked == ""
    assert budget.second > 0.1 * (budget.u**2 - budget.second)
    drawn = draw(report.inputs, report.values, budget, 20_000)
    assert budget.u == pytest.approx(drawn.u, rel=0.04)


def test_why_of_what_a_fit_finds_names_its_data_its_start_and_its_proof(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = "test,t [s],A [1],left out\n1,0,10.2,\n2,2,,\n3,4,2.4,\n4,5,1.9,\n5,6,9.9,dust\n"
    method_folder(tmp_path, DECAY, table, '[uncertainty]\nA = "u = 1"\nt = "exact"\n')
    assert main(["why", "c", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    for line in (
        "  from      (1b) definition\n            f_G2 = sum(f_J2,k*f_residual,k, k = 1..n) = 0\n",
        "  fitted    to A of 3 of 4 readings, with A_0, by least squares; f_s = ",
        "  begun     at 0.4 1/s\n  proof     (L14) slope of the sum of squares by c: proved\n",
        "  left out  reading 2: #INPUT! f_residual[2] needs A[2]: the datum is missing or invalid\n",
        "  left out  reading 5: dust\n",
        "  rests on  t[1] = 0 s, t[3] = 4 s, t[4] = 5 s, A[1] = 10.2, A[3] = 2.4, A[4] = 1.9\n",
        "  used by   f_fitted[1] = ",
    ):
        assert line in told
    assert "f_J1" not in told.partition("used by")[2]
    method_folder(tmp_path, LINE, "reading,x [s],y [mV]\n1,1,2.1\n2,2,3.2\n3,4,4.9\n")
    assert main(["why", "b", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert "  from      (1b) proved\n" in told
    assert "  fitted    to y of 3 readings, with a, by least squares; line_s = " in told
    assert "  rests on  x[1] = 1 s, x[2] = 2 s, x[3] = 4 s, y[1] = 2.1 mV, " in told
    assert "begun" not in told


def test_what_is_fitted_does_not_scatter_about_its_mean(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = "test,t [s],A [1]\n1,0,10.2\n2,2,4.1\n3,4,2.4\n"
    method_folder(tmp_path, DECAY, table, '[uncertainty]\nA = "u = 1; scatter"\n')
    assert main(["check", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert "a model is fitted to A, which scatters about a curve and not about its mean: f_s tells" in said
    assert ":3:5" in said


# --- why it holds ----------------------------------------------------------------------------------------

k, n = (Symbol(name, integer=True, positive=True) for name in "kn")
x, y, u = (IndexedBase(Symbol(name, real=True))[k] for name in "xyu")


def squares(model: Expr, parameters: tuple[Symbol, ...], weight: Expr | None = None) -> LeastSquares:
    own = map("(L{})".format, itertools.count(1))
    words = {each: str(each) for each in parameters}
    return LeastSquares("f", y, model, "y", words, weight, {}, k, n, "(1)", own)


a, b, c = PARAMETERS = symbols("a b c", real=True)
MODELS = {
    "line": (a + b * x, (a, b), None),
    "weighed line": (a + b * x, (a, b), u),
    "through the origin": (a * x, (a,), None),
    "parabola": (a + b * x + c * x**2, PARAMETERS, None),
    "with an offset": (a * exp(x) + b * sin(x) + 3 * x, (a, b), None),
    "growth": (a * (1 - exp(-b * x)), (a, b), None),
    "weighed growth": (a * (1 - exp(-b * x)), (a, b), u),
}


@pytest.mark.parametrize("name", MODELS)
def test_parameters_follow_from_the_normal_equations(name: str) -> None:
    entries = tuple(squares(*MODELS[name]).entries)
    found = prove(Ledger(entries))
    assert all(proof.status.passes for proof in found)
    proved = [proof.equation for proof in found if proof.status is ProofStatus.PROVED]
    derived = [entry.claim for entry in entries if isinstance(entry, Derivation)]
    assert proved == derived
    assert len(derived) == len(MODELS[name][1]) * (2 if "growth" in name else 1)


WRONG = {
    "a sign": lambda value: -value,
    "a share left out": lambda value: value.subs(Symbol("f_r1_2", real=True), 0),
    "a share too much": lambda value: value + Symbol("f_r1_2", real=True),
    "of another slope": lambda value: value + Symbol("f_d2", real=True) / 10**20,
}


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize("name", ["line", "parabola", "growth"])
def test_a_wrong_parameter_is_refuted(name: str, wrong: str) -> None:
    entries = [entry for entry in squares(*MODELS[name]).entries if isinstance(entry, Derivation)]
    (entry,) = (e for e in entries if str(e.claim.members[0]) in ("a", "f_step1"))
    step = entry.steps[-1]
    left, right = step.claim.members
    claim = replace(step.claim, members=(left, WRONG[wrong](right)))
    assert check_step(replace(step, claim=claim)).status is ProofStatus.REFUTED


@pytest.mark.parametrize("name", ["line", "weighed line", "growth"])
def test_a_wrong_reduction_is_refuted(name: str) -> None:
    """The step that takes a slope out, if one of its definitions said twice as much."""
    entries = [entry for entry in squares(*MODELS[name]).entries if isinstance(entry, Derivation)]
    (step,) = (step for each in entries for step in each.steps if " without " in step.claim.title)
    assert check_step(step).status is ProofStatus.PROVED
    found = dict[str, ProofStatus]()
    for place, premise in enumerate(step.premises):
        if premise.number:
            left, right = premise.members
            changed = replace(premise, members=(left, 2 * right))
            premises = (*step.premises[:place], changed, *step.premises[place + 1 :])
            found[str(left)] = check_step(replace(step, premises=premises)).status
    # What is orthogonal stays so, however much is taken of the first slope from what was observed.
    assert found.pop("f_d1") is ProofStatus.PROVED
    assert set(found.values()) == {ProofStatus.REFUTED}
    assert set(found) == {"f_J2_1[k]", "f_z1[k]", "f_r1_2", "f_N1"}


def test_a_column_is_put_under_a_sum_only_by_its_law() -> None:
    """X of X[k] = ... is known for every k; the cell X[k] for one."""
    X, Y = (IndexedBase(Symbol(name, real=True)) for name in "XY")

    def decided(law: Expr, right: Expr, unknown: Any = X, left: Expr = X[k]) -> Any:
        premise = Equation("", (left, law), "", Kind.DEFINITION, "law")
        claim = Equation("(1)", (Sum(X[k], (k, 1, n)), right), "")
        return check_step(Step(claim, (premise,), (unknown,), ""))

    double = 2 * Sum(Y[k], (k, 1, n))
    assert decided(2 * Y[k], double).status is ProofStatus.PROVED
    assert decided(3 * Y[k], double).status is ProofStatus.REFUTED
    assert decided(2 * Y[k] + Y[1] / 10**30, double).status is ProofStatus.REFUTED
    assert decided(2 * Y[k], double, X[k]).status is ProofStatus.UNDECIDED
    assert decided(2 * X[k], double).why == "law does not give every row of X in closed form"
    assert decided(2 * Y[1], double, left=X[1]).why == "law does not give every row of X in closed form"


# --- shipped examples ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "values"), [("gum_h3", 29), ("misra1a", 6)])
def test_shipped_fits_come_out_as_published(name: str, values: int) -> None:
    report = Study(PAPER.parent / name).proved
    assert [comparison.verdict for comparison in report.comparisons] == ["same"] * values
    assert all(proof.status.passes for proof in report.proofs)
    code = (PAPER.parent / name / "workbook.py").read_text(encoding="utf-8")
    declared = [line for line in code.splitlines() if re.match(r"    \w+ = \w+\([^)]", line)]
    assert len(declared) <= {"gum_h3": 10, "misra1a": 6}[name]


def test_a_step_that_leaves_the_domain_of_the_model_is_too_long(tmp_path: Path) -> None:
    """It was a TypeError: the sum of squares there is no real number."""
    method = (
        "from sympy import log\nfrom loopsheet import Method, fit, measured, unknown\n\n\n"
        "class Growth(Method, rows='points'):\n    'A growth.'\n\n"
        "    x = measured('1', 'abscissa', positive=True)\n    y = measured('1', 'ordinate')\n"
        "    a, b = unknown('a', start=0.2), unknown('b', start=3)\n    f = fit(y, a * log(1 + b * x))\n"
    )
    at = (0.05, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    off = (0.01, -0.02, 0.01, 0.02, -0.01, -0.02, 0.02, -0.01)
    rows = "".join(f"{x},{2 * math.log(1 + 1.5 * x) + e:.4f}\n" for x, e in zip(at, off, strict=True))
    method_folder(tmp_path, method, f"x [1],y [1]\n{rows}")
    values = Study(tmp_path).computed.values
    assert values.scalar("a") == pytest.approx(2, rel=0.02)
    assert values.scalar("b") == pytest.approx(1.5, rel=0.05)
