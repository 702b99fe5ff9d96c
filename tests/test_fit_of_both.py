"""Fits of methods with errors in several variables: what is published, another way, proofs."""

from __future__ import annotations

import types
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from adjusted import adjusted
from helpers import method_folder
from sympy import Expr, IndexedBase, Symbol, exp, symbols
from test_fit import cells, k, n

import loopsheet
from loopsheet import Method, fit, measured, unknown
from loopsheet.derivations.equation import Derivation, Ledger
from loopsheet.derivations.least_squares import LeastSquares
from loopsheet.derivations.proof import check_step, prove
from loopsheet.derivations.proved import ProofStatus
from loopsheet.report.cells.values import Values
from loopsheet.report.cli import main
from loopsheet.report.engines import exact
from loopsheet.report.engines.numpy import evaluate
from loopsheet.report.study import Study

LINE = """from loopsheet import Method, fit, let, measured, unknown


class Pearson(Method):
    "K. Pearson, On lines and planes of closest fit to systems of points in space, 1901."
    x = measured("1", "abscissa")
    y = measured("1", "ordinate")
    a, b = unknown("intercept"), unknown("slope")
    line = fit(y, a + b * x, u={x: "stated", y: "stated"})
    u_a = let(line.s_a / line.s, "u of the intercept by the adjusted points")
    u_b = let(line.s_b / line.s, "u of the slope by the adjusted points")
    birge = let(line.s**2, "square of Birge's ratio")
"""


PEARSON = (
    ("0", "0.9", "1.8", "2.6", "3.3", "4.4", "5.2", "6.1", "6.5", "7.4"),
    ("5.9", "5.4", "4.4", "4.6", "3.5", "3.7", "2.8", "2.8", "2.4", "1.5"),
)
YORK = ((1000, 1000, 500, 800, 200, 80, 60, 20, 1.8, 1), (1, 1.8, 4, 8, 20, 20, 70, 70, 100, 500))


def same(found: float, printed: str) -> bool:
    """Whether a number rounds to what is printed."""
    return f"{found:.{len(printed.partition('.')[2])}f}" == printed


def pearson(folder: Path) -> Path:
    """A report folder of Pearson's data with York's weights."""
    (x, y), (u_x, u_y) = PEARSON, ([repr(weight**-0.5) for weight in own] for own in YORK)
    rows = "".join(",".join(each) + "\n" for each in zip(x, u_x, y, u_y, strict=True))
    return method_folder(folder, LINE, f"x [1],u(x) [1],y [1],u(y) [1]\n{rows}")


def test_all_that_is_published_of_pearsons_data_with_yorks_weights(tmp_path: Path) -> None:
    """Slope and intercept: Neri, Saitta, Chiofalo (1989). By the adjusted points: York, Evensen, Martinez,
    De Basabe Delgado (2004). Propagated: Kalantar (1992)."""
    report = loopsheet.load(pearson(tmp_path))
    found = {
        "a": "5.479910224", "b": "-0.480533407", "u_a": "0.294970735", "u_b": "0.057985009",
        "birge": "1.483294149",
    }  # fmt: skip
    for name, printed in found.items():
        assert same(float(report[name]), printed), name
    assert same(float(report["a"].u), "0.29193")
    assert same(float(report["b"].u), "0.057617")
    assert not report.findings


@pytest.mark.parametrize(
    ("at", "rows", "u_x", "u_y", "printed"),
    [
        (
            [1, 2, 3, 4, 5, 6], [3.3, 5.6, 7.1, 9.3, 10.7, 12.1], 0, [0.5] * 6,
            ("1.867", "1.757", "0.465", "0.120", "-0.050", "1.665"),
        ),
        (
            [1, 2, 3, 4, 5, 6], [3.2, 4.3, 7.6, 8.6, 11.7, 12.8], 0, [0.5, 0.5, 0.5, 1, 1, 1],
            ("0.885", "2.057", "0.530", "0.178", "-0.082", "4.131"),
        ),
        (
            [1.2, 1.9, 2.9, 4.0, 4.7, 5.9], [3.4, 4.4, 7.2, 8.5, 10.8, 13.5],
            0.2, [0.2, 0.2, 0.2, 0.4, 0.4, 0.4],
            ("0.5788", "2.1597", "0.4764", "0.1355", "-0.0577", "2.743"),
        ),
    ],
    ids=["6.3, alike", "6.3, not alike", "7.4, in both"],
)  # fmt: skip
def test_examples_of_iso_28037(
    at: list[float], rows: list[float], u_x: float, u_y: list[float], printed: tuple[str, ...]
) -> None:
    sheet = method_of(a + b * x, (0, 1)).workbook.sheet(frozenset())
    given = {"x": at, "y": rows, "u_x": np.full(6, u_x), "u_y": u_y}
    values = evaluate(sheet, {"readings": range(1, 7)}, {k: np.asarray(v, float) for k, v in given.items()})
    sizes = cells(values, "s_a", "s_b") / values.scalar("f_s")
    shared = values.scalar("r_a_b") * sizes[0] * sizes[1]
    numbers = (*cells(values, "a", "b"), *sizes, shared, values.scalar("f_S"))
    for number, text in zip(numbers, printed, strict=True):
        assert same(number, text), (number, text)


def test_what_misfits_is_told_by_the_errors_of_both(tmp_path: Path) -> None:
    """To first order, what the fit itself makes of the distances."""
    report = Study(pearson(tmp_path)).computed
    misfit = report.uncertain().misfits["line_S"]
    assert (misfit.dof, misfit.is_stated) == (8, True)
    assert misfit.chi2 == pytest.approx(report.values.scalar("line_S"), rel=0.01)


@pytest.mark.parametrize(
    ("stated", "told"),
    [
        ('[uncertainty.correlation]\n"x, y" = "0.4"\n', "x and y are correlated"),
        (
            '[uncertainty.shared.zero]\nof = "y"\nstated = "u = 0.1"\ngroups = [[1, 2, 3]]\n',
            "'zero' is shared",
        ),
        ('[uncertainty.shared.zero]\nof = "y"\nstated = "u = 0.1"\n', ""),  # the intercept alone feels it
    ],
)
def test_weights_that_leave_out_what_is_stated_are_told(tmp_path: Path, stated: str, told: str) -> None:
    folder = pearson(tmp_path)
    with (folder / "report.toml").open("a", encoding="utf-8") as file:
        file.write(stated)
    said = [check.message for check in Study(folder).computed.oddities if check.note == "warning"]
    ends = f"{told}: a and b are not the likeliest numbers; their u counts it"
    assert any(each.endswith(f"line_S and its weights leave out that {ends}") for each in said) == bool(
        told
    ), said


# ------------------------------------------------------------------------------ by another way

a, b, x, y, z = symbols("a b x y z")
MODELS: dict[str, tuple[Expr, tuple[float, float], Any]] = {
    "a power": (a * x**b, (2, 1.3), lambda x, z: 2 * x**1.3),
    "a growth": (a * (1 - exp(-b * x)), (3, 0.4), lambda x, z: 3 * (1 - np.exp(-0.4 * x))),
    "of two": (a * x + b * z**2, (1, 0.5), lambda x, z: x + z**2 / 2),
    "a product": (a * x * exp(-b * z), (2, 0.2), lambda x, z: 2 * x * np.exp(-0.2 * z)),
    "a fraction": (a * b * x / (1 + b * x), (4, 0.5), lambda x, z: 2 * x / (1 + 0.5 * x)),
}


def method_of(model: Expr, start: tuple[float, float]) -> Any:
    """A method whose variables have their stated errors."""

    def fill(body: dict[str, Any]) -> None:
        names = sorted(map(str, model.free_symbols - {a, b}))
        where: dict[Expr, Any] = {}
        for name in (*names, "y"):
            body[name] = measured("1", name)
            where[Symbol(name)] = body[name]
        for parameter, first in zip((a, b), start, strict=True):
            body[str(parameter)] = unknown(str(parameter), start=first)
            where[parameter] = body[str(parameter)]
        sizes = {where[Symbol(name)]: "stated" for name in (*names, "y")}
        body["f"] = fit(where[y], model.xreplace(where), u=sizes)

    return types.new_class("Both", (Method,), {}, fill)


@pytest.mark.parametrize(
    ("name", "engine"), [*((name, evaluate) for name in MODELS), ("a power", exact.evaluate)]
)
def test_a_curve_is_where_the_adjusted_points_have_it(name: str, engine: Any) -> None:
    model, start, true = MODELS[name]
    rng, count = np.random.default_rng(5), 12
    at = {x: np.linspace(0.5, 6, count), z: rng.uniform(1, 3, count)}
    sizes = {x: rng.uniform(0.02, 0.1, count), z: rng.uniform(0.02, 0.06, count)}
    at, sizes = ({each: of[each] for each in at if model.has(each)} for of in (at, sizes))
    sizes[y] = rng.uniform(0.02, 0.1, count)
    at[y] = true(*(at.get(each, np.nan) for each in (x, z)))
    data = {each: at[each] + rng.normal(0, sizes[each]) for each in at}
    found = adjusted(model, y, (a, b), data, sizes, start)
    sheet = method_of(model, start).workbook.sheet(frozenset())
    given = {**{str(s): d for s, d in data.items()}, **{f"u_{s}": u for s, u in sizes.items()}}
    values: Any = engine(sheet, {"readings": range(1, count + 1)}, given)
    values = values if engine is evaluate else values.rounded(sheet)
    assert isinstance(values, Values)
    assert cells(values, "a", "b") == pytest.approx(found.parameters, rel=1e-9)
    assert cells(values, "s_a", "s_b") / values.scalar("f_s") == pytest.approx(found.u, rel=1e-8)
    assert values.scalar("f_S") == pytest.approx(found.chi2, rel=1e-9)
    for symbol, points in found.points.items():
        assert values.value[f"f_at_{symbol}"] == pytest.approx(points, rel=1e-8)


def test_errors_of_one_variable_are_what_is_left_of_two() -> None:
    """No error in x: the line of the ordinary fit, and rows stay where they are."""
    sheet = method_of(a + b * x, (0, 0)).workbook.sheet(frozenset())
    at, size = np.linspace(1, 5, 7), np.array([1, 2, 1, 3, 2, 1, 1]) * 0.1
    rows = np.array([1.1, 2.3, 2.8, 4.4, 4.6, 5.9, 7.2])
    given = {"x": at, "y": rows, "u_x": np.zeros(7), "u_y": size}
    values = evaluate(sheet, {"readings": range(1, 8)}, given)
    slope, offset = np.polyfit(at, rows, 1, w=1 / size)
    assert cells(values, "a", "b") == pytest.approx([offset, slope], rel=1e-12)
    assert values.value["f_at_x"].tolist() == at.tolist()


# ------------------------------------------------------------------------------ why it holds


def row(symbol: Symbol) -> Any:
    """A cell of a column of positive numbers."""
    return IndexedBase(Symbol(symbol.name, positive=True))[k]


def squares(name: str) -> LeastSquares:
    model, _, _ = MODELS[name]
    rows: dict[Expr, Any] = {each: row(each) for each in (x, y, z)}
    own = (f"(L{number})" for number in range(1, 99))
    others = {rows[each]: row(Symbol(f"u_{each}")) for each in (x, z) if model.has(each)}
    real = {each: Symbol(each.name, real=True) for each in (a, b)}
    words = {each: str(each) for each in real.values()}
    u = row(Symbol("u_y"))
    return LeastSquares(
        "f", rows[y], model.xreplace({**rows, **real}), "y", words, u, others, k, n, "(1)", own
    )


@pytest.mark.parametrize("name", ["a growth", "of two", "a fraction", "a power"])
def test_points_and_parameters_follow_from_the_sum_of_squares_of_both(name: str) -> None:
    entries = tuple(squares(name).entries)
    found = [proof for proof in prove(Ledger(entries)) if proof.status is not ProofStatus.DEFINITION]
    assert {proof.status for proof in found} == {ProofStatus.PROVED}
    assert len(found) == len([each for each in entries if isinstance(each, Derivation)])


def derived(name: str, of: str) -> Any:
    """The last step of what is derived for a cell, or of the slope by it."""
    entries = [entry for entry in squares(name).entries if isinstance(entry, Derivation)]
    (entry,) = (each for each in entries if of in (str(each.claim.members[0]), each.claim.title))
    return entry.steps[-1]


WRONG = {
    "a sign": lambda value: -value,
    "half": lambda value: value / 2,
    "an error that is none": lambda value: value.subs(row(Symbol("u_x")), 0),
    "a little": lambda value: value * (1 + Symbol("f_G1", real=True) / 10**20),
}


@pytest.mark.parametrize(
    ("wrong", "of"),
    [*((wrong, "f_at_x[k]") for wrong in WRONG)]
    + [(wrong, "slope of the sum of squares by a") for wrong in ("a sign", "half", "a little")],
)
def test_a_wrong_point_or_slope_is_refuted(wrong: str, of: str) -> None:
    step = derived("of two", of)
    left, right = step.claim.members
    claim = replace(step.claim, members=(left, WRONG[wrong](right)))
    assert check_step(step).status is ProofStatus.PROVED
    assert check_step(replace(step, claim=claim)).status is ProofStatus.REFUTED


@pytest.mark.parametrize("named", ["x", "f_w", "f_residual"])
def test_a_wrong_premise_of_a_slope_is_refuted(named: str) -> None:
    """Where the point is, what a row weighs, what is left: each twice as much."""
    step = derived("of two", "slope of the sum of squares by a")
    changed = [
        replace(premise, members=(premise.members[0], 2 * premise.members[1]))
        if str(premise.members[0]) == f"{named}[k]"
        else premise
        for premise in step.premises
    ]
    assert changed != list(step.premises)
    assert check_step(replace(step, premises=tuple(changed))).status is ProofStatus.REFUTED


# ------------------------------------------------------------------------------ what is refused


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("f = fit(y, a * x, u={x: 'stated'})", "f: u says how uncertain y and x are, each of them"),
        ("f = fit(y, a * x, u={x: 1, y: None})", "f: u says how uncertain y and x are, each of them"),
        ("f = fit(y, a * x, u={y: 1, x: 'known'})", "f: u is a formula, or 'stated', not 'known'"),
        ("f = fit(y, a * x, u={y: 1, z: 1})", "f: u is of columns that the model names; z[k] is none"),
        ("f = fit(y, a * x, u={y: 1, 2 * x: 1})", "f: u is of columns that the model names; 2*x[k] is none"),
        ("q = let(2 * x, 'twice'); f = fit(y, a * q, u={y: 1, q: 'stated'})", "nothing is stated of q"),
        ("g = groups('s'); f = fit(y, a * x, u={y: 1, x: 1}, of=g)", "has errors in y[k] alone"),
        ("f = fit(y, a**2 * x, u={y: 1, x: 1})", "not linear: say where to begin, a = unknown(..., start="),
    ],
)
def test_a_wrong_fit_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], body: str, said: str
) -> None:
    head = "from loopsheet import Method, fit, groups, let, measured, unknown\n\n\nclass Wrong(Method):\n"
    named = "".join(f"    {name} = measured('1', '{name}')\n" for name in "xyz")
    code = f"{head}{named}    a = unknown('a')\n    {body}\n"
    method_folder(tmp_path, code, "x [1],y [1],z [1],s\n1,2,3,A\n")
    assert main(["check", str(tmp_path)]) == 2
    assert said in capsys.readouterr().err
