"""The number of roots of an interval is right or not decided, never wrong, in every engine."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest
from helpers import method_folder
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st
from sympy import Abs, Expr, Integer, Max, Mul, Piecewise, Rational, Symbol, cos, exp, log, sin, sqrt, sympify

from loopsheet.derivations.equation import Equation
from loopsheet.report.cells.values import CODES, Status
from loopsheet.report.cli import main
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.certified import certified
from loopsheet.report.judge.readers import Case, run_javascript
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import Axis, Column, Given, Root, Sheet
from loopsheet.report.workbooks.soft_impact import sheet as soft_impact

w = Symbol("w", real=True)
V = Symbol("V", positive=True)
positive = Bounds(low=0, low_open=True)
T, p = (Column(name, None, Given(bounds=positive)) for name in "Tp")
Re, rough = Column("Re", None, Given(bounds=positive)), Column("rough", None, Given(bounds=Bounds(low=0)))
OK, NONE, TWO, UNDECIDED = Status.OK, Status.NOROOT, Status.TWOROOTS, Status.UNDECIDED


def column(form: Expr, low: Any, high: Any, unknown: Symbol = w, **more: Any) -> Column:
    equation = Equation("(1)", (form, 0 * unknown), "")
    low, high = sympify(low), sympify(high)
    rule = Root(equation, equation, unknown, unknown, low, high, (low + high) / 3, **more)
    return Column("r", None, rule, positive=False)


def sheet(form: Expr, low: Any, high: Any, *given: Column, **more: Any) -> Sheet:
    return Sheet((*given, column(form, low, high, **more)))


def certain(form: Expr, low: Any, high: Any, *given: Column, **more: Any) -> bool:
    made = sheet(form, low, high, *given, **more)
    return certified(made, made["r"])


# Carbon dioxide in m^3/kmol, kPa: (p + a/V^2)(V - b) = R T, cleared of its denominators.
a, b, R = Rational("365.8"), Rational("0.04286"), Rational("8.314")
GAS = (p.symbol * V**3 - (p.symbol * b + R * T.symbol) * V**2 + a * V - a * b, "3/50", 10)


def gas() -> Sheet:
    return sheet(*GAS, T, p, unknown=V)


CASES: dict[str, tuple[Expr, Any, Any, Status, tuple[float, ...]]] = {
    "none": (w**2 + 1, -4, 4, NONE, ()),
    "one": (w**2 - 3 * w + 2, 0, Rational(3, 2), OK, (1,)),
    "two between equal signs": (w**2 - 3 * w + 2, 0, 4, TWO, (1, 2)),
    "three": ((w - 1) * (w - 2) * (w - 3), 0, 4, TWO, (1, 2, 3)),
    "two close together": ((w - 1) * (w - 1 - Rational(1, 2**16)), 0, 4, TWO, (1, 1 + 2**-16)),
    "touches": ((w - 1) ** 2, 0, 4, UNDECIDED, ()),
    "crosses, then touches": ((w - 1) * (w - 2) ** 2, 0, 4, UNDECIDED, ()),
    "as good as touches": (((w - 1) ** 2 - Rational(1, 10**20)).expand(), 0, 4, UNDECIDED, ()),
    "a flat crossing": ((w - 1) ** 3, 0, 4, OK, (1,)),
    "without end": (w * sin(1 / w), Rational(1, 10**5), 1, UNDECIDED, ()),
    "many": (sin(w), Rational(1, 2), 20, TWO, tuple(n * np.pi for n in range(1, 7))),
    "a pole is no root": (1 / (3 - w) - 1, 0, 5, UNDECIDED, ()),
    "a logarithm from minus infinity": (log(w) + w, 0, 4, OK, (0.5671432904097838,)),
    "roots of a root": (sqrt(w) - w / 2 - Rational(1, 4), 0, 4, TWO, (1.5 - 2**0.5, 1.5 + 2**0.5)),
    "exponential": (exp(w) - 3 * w, 0, 2, TWO, (0.6190612867359451, 1.5121345516578424)),
    "cosine": (cos(w) - w, 0, 2, OK, (0.7390851332151607,)),
    "a root on the end of the open interval": (w * (w - 1), 0, 4, UNDECIDED, ()),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_the_number_of_roots_and_each_of_them(case: str) -> None:
    form, low, high, status, roots = CASES[case]
    made = sheet(form, low, high)
    values, judged = engine.evaluate(made, {}, {}), exact.evaluate(made, {}, {})
    assert values.status["r"].tolist() == [status] == judged.status["r"]
    if status == OK:
        assert values.value["r"] == pytest.approx(roots, rel=1e-14)
        assert float(judged.value["r"][0]) == pytest.approx(roots[0], rel=1e-14)
    if status == TWO:
        assert values.roots["r"][0] == pytest.approx(roots, rel=1e-10)
        assert [float(root) for root in judged.roots["r"][0]] == pytest.approx(roots, rel=1e-10)
        named = " and ".join(f"{root:.6g}" for root in roots)
        assert f"(1) has more than one root here: {named} (" in values.cell("r").reason


def test_what_was_not_decided_is_told_with_its_place() -> None:
    values = engine.evaluate(sheet((w - 1) ** 2, 0, 4), {}, {})
    assert values.cell("r").reason == (
        "#UNDECIDED! r: the roots of (1) cannot be counted near w = 1: it may touch "
        "zero, jump, or cross it too often"
    )


@pytest.mark.parametrize(
    ("temperature", "pressure", "status", "number"),
    [(260.0, 4000.0, TWO, 3), (320.0, 4000.0, OK, 1), (260.0, 6000.0, OK, 1)],
)
def test_a_gas_has_one_volume_or_three(
    temperature: float, pressure: float, status: Status, number: int
) -> None:
    """Van der Waals, carbon dioxide: liquid, vapour and what is neither, or one fluid."""
    data = {"T": temperature, "p": pressure}
    values, judged = engine.evaluate(gas(), {}, data), exact.evaluate(gas(), {}, data)
    assert values.status["r"].tolist() == [status] == judged.status["r"]
    cubic = [pressure, -(pressure * float(b) + float(R) * temperature), float(a), -float(a * b)]
    expected = sorted(float(x.real) for x in np.roots(cubic) if abs(x.imag) < 1e-9 and 0.06 < x.real < 10)
    assert len(expected) == number
    found = values.roots["r"][0] if number > 1 else values.value["r"]
    assert found == pytest.approx(expected, rel=1e-9)


# ------------------------------------------------------------------------------- for all inputs at once


def test_a_slope_of_one_sign_is_certified_for_all_inputs() -> None:
    """Colebrook and White in 1/sqrt(f); Kepler, whatever the anomaly; a pole or a turn is none."""
    inner = rough.symbol / Rational("3.7") + Rational("2.51") * w / Re.symbol
    assert certain(w + 2 * log(inner) / log(10), 0, 100, Re, rough)
    eccentricity = Column("ecc", None, Given(bounds=Bounds(low=0, high=1, high_open=True)))
    anomaly = Column("M", None, Given())
    ends = anomaly.symbol - 1, anomaly.symbol + 1
    assert certain(w - eccentricity.symbol * sin(w) - anomaly.symbol, *ends, eccentricity, anomaly)
    assert not certain(w - 2 * sin(w) - anomaly.symbol, *ends, anomaly)
    assert not certain(1 / (w - 1) + 1, 0, 4)
    assert not certain(Piecewise((w - 1, w < 2), (w - 3, True)), 0, 4)
    assert not certain(w**2 - 3 * w + 2, 0, 4)
    assert certain(w**3 - 12 * w, Rational(201, 100), 4)  # in parts
    assert not certain(w**3 - 12 * w, Rational(199, 100), 4)
    assert not certain(GAS[0], *GAS[1:], T, p, unknown=V)


def test_a_slope_of_one_sign_is_seen_by_its_factors() -> None:
    """A damping number by the restitution that it returns, from where the bodies part as fast as they met."""
    e = Column("e", None, Given(bounds=Bounds(low=0, high=1)))
    lost = 1 - exp(-w)
    form = log(1 + lost / e.symbol) + w - lost / e.symbol - lost
    above = ((e.symbol > Rational(1, 1000), "something comes back"), (e.symbol < 1, "something is lost"))
    ends = -log(e.symbol), 1 / e.symbol - e.symbol
    solved = replace(column(form, *ends), requires=above)
    assert certified(Sheet((e, solved)), solved)
    assert not certain(form, *ends, e)  # at e = 0 there is no slope
    wider = replace(column(form, -log(e.symbol) / 2, ends[1]), requires=above)
    assert not certified(Sheet((e, wider)), wider)


def test_the_exponent_of_the_paper_is_certified_and_its_claim_is_proved() -> None:
    made = soft_impact(frozenset({"ball_mass"}))
    assert certified(made, made["alpha"])
    rule = made["alpha"].rule
    assert isinstance(rule, Root)
    assert [equation.label for equation in rule.turning_by] == ["(L6)", "(L9)"]
    unproved = replace(made["alpha"], rule=replace(rule, turning_by=()))
    assert not certified(made, unproved)


def test_of_the_paper_whoever_counts_finds_the_same(random_pairs: dict[str, Any]) -> None:
    """The proved claim about (L8) against intervals, which know nothing of it, on sound and absurd pairs."""
    made = soft_impact(frozenset({"ball_mass"}))
    small = Sheet(tuple(made[name] for name in ("v", "e", "x_p", "beta", "alpha")))
    rule = replace(small["alpha"].rule, turning_by=())
    counted = Sheet(tuple(replace(c, rule=rule) if c.name == "alpha" else c for c in small.columns))
    by_signs, by_intervals = (engine.evaluate(s, {"tests": [1, 2]}, random_pairs) for s in (small, counted))
    decided = by_intervals.status["alpha"] != UNDECIDED
    assert decided.mean() > 0.95
    np.testing.assert_array_equal(by_signs.status["alpha"][decided], by_intervals.status["alpha"][decided])
    codes = set(by_signs.status["alpha"][decided].tolist())
    assert codes >= {OK, NONE, TWO}


@pytest.fixture(scope="module")
def random_pairs() -> dict[str, Any]:
    rng = np.random.default_rng(5)
    size = (400, 2)
    v, e = np.sort(rng.uniform(0.5, 8, size)), rng.uniform(0.05, 0.95, size)
    return {
        "v": v,
        "e": e,
        "x_p": rng.uniform(1e-5, 9e-5, size),
        "beta": rng.choice([1.0, 1.5, 2.0], (400, 1)),
    }


# --------------------------------------------------------------------------------- what authors claim


@pytest.mark.parametrize("turning", [(Rational(1, 2),), (Integer(3),), ()])
def test_a_false_claim_about_turning_points_is_not_believed(turning: tuple[Expr, ...]) -> None:
    form = w**2 - 3 * w + 2
    assert not certain(form, 0, 4, turning=turning)
    assert engine.evaluate(sheet(form, 0, 4, turning=turning), {}, {}).roots["r"][0] == pytest.approx((1, 2))


def test_a_true_claim_about_turning_points_is_seen_to_be_true() -> None:
    assert certain(w**2 - 3 * w + 2, 0, 4, turning=(Rational(3, 2),))
    g = Column("g", None, Given())
    cubic, turning = w**3 - 3 * w - g.symbol, (Integer(-1), Integer(1))
    assert certain(cubic, -3, 3, g, turning=turning)
    assert not certain(cubic, -3, 3, g, turning=turning[:1])
    assert not certain(cubic, -3, 3, g, turning=turning[::-1])


def test_a_point_that_may_lie_outside_divides_nothing() -> None:
    top = Column("top", None, Given(bounds=positive))
    assert not certain(w**2 - 3 * w + 2, 0, top.symbol, top, turning=(Rational(3, 2),))


# ------------------------------------------------------------------------------------------- never wrong

roots_of = st.lists(st.fractions(-4, 4, max_denominator=8), min_size=0, max_size=4)


@settings(derandomize=True, max_examples=40, phases=(Phase.explicit, Phase.generate))
@given(
    roots_of, st.booleans(), st.fractions(-5, -1, max_denominator=7), st.fractions(1, 5, max_denominator=7)
)
def test_of_a_polynomial_the_number_is_right_or_undecided(
    roots: Any, factor: bool, low: Any, high: Any
) -> None:
    assume(not {low, high} & set(roots))
    form = Mul(*(w - Rational(root) for root in roots), *([w**2 + 1] if factor else []))
    form = form.expand() + 0 * w
    assume(form.has(w))
    made = sheet(form, Rational(low), Rational(high))
    inside = sorted(root for root in roots if low < root < high)
    once = len(set(inside)) == len(inside)
    odd = [root for root in sorted(set(inside)) if inside.count(root) % 2]
    for found in (engine.evaluate(made, {}, {}), exact.evaluate(made, {}, {})):
        status = found.status["r"][0]
        if not once:
            assert status == UNDECIDED or (status == OK and len(set(inside)) == len(odd) == 1)
        else:
            assert status == (NONE, OK, TWO)[min(len(inside), 2)]
        if status == TWO:
            several = [float(root) for root in found.roots["r"][0]]
            assert several == pytest.approx(list(map(float, inside)), abs=1e-9)


def test_rows_and_batches_are_counted_one_by_one() -> None:
    k, size = (Symbol(name, integer=True, positive=True) for name in ("k", "n_rows"))
    c = Column("c", Axis("rows", k, size), Given())
    rule = column(w**2 - 3 * w + c[k], 0, 4).rule
    made = Sheet((c, Column("r", c.axis, rule, positive=False)))
    assert not certified(made, made["r"])
    rows = {"rows": range(1, 6)}
    data = [2.0, -1.0, 5.0, 2.25, 0.5]
    expected = [TWO, OK, NONE, UNDECIDED, TWO]
    values = engine.evaluate(made, rows, {"c": data})
    assert values.status["r"].tolist() == expected == exact.evaluate(made, rows, {"c": data}).status["r"]
    batch = engine.evaluate(made, rows, {"c": np.array([data, data[::-1]])})
    assert batch.status["r"].tolist() == [expected, expected[::-1]]


# --------------------------------------------------------------------------------------------- JavaScript


def test_javascript_counts_the_same(require: Callable[..., str]) -> None:
    require("node", "chromium")
    names = [f"r{n}" for n in range(len(CASES))]
    columns = [
        replace(column(form, low, high), name=name)
        for name, (form, low, high, *_) in zip(names, CASES.values(), strict=True)
        if not form.has(1 / (3 - w))
    ]
    made = Sheet(tuple(columns))
    values = engine.evaluate(made, {}, {})
    reading = run_javascript(Case(made, {}, {}))
    assert reading.failure == ""
    for name in made.by_name:
        assert reading.status[name] == [CODES[Status(values.status[name][0])]], name


def test_roots_are_counted_across_corners() -> None:
    """The slope of a corner is what it is on both sides."""
    forms = {"one": Max(w, 1) - 2, "none": Max(w, 1) - Rational(1, 2), "both": Abs(w - 2) - 1}
    found = {name: engine.evaluate(sheet(form, 0, 4), {}, {}) for name, form in forms.items()}
    codes = {name: CODES[Status(values.status["r"][0])] for name, values in found.items()}
    assert codes == {"one": "ok", "none": "#NOROOT!", "both": "#TWOROOTS!"}
    assert found["one"].scalar("r") == 2


# ------------------------------------------------------------------------------------ where it is shown

FOLDER = {
    "workbook.py": """\
from sympy import Symbol
from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import Axis, Column, Given, Root, Sheet
from loopsheet.report.workbook import Measured, TableSpec, Workbook

k, n = (Symbol(name, integer=True, positive=True) for name in ("k", "n"))
w, c = Symbol("w", positive=True), Symbol("c", positive=True)
eq1 = Equation("(1)", (w**2 - 3 * w + c, 0 * w), "assumed", Kind.ASSUMPTION, "a parabola")
given = Column("c", Axis("rows", k, n), Given("measured"), "1", "constant", "c%s")
form = eq1.at({c: given[k]})
root = Column("w0", given.axis, Root(form, form, w, w, 0 * w, 0 * w + 4, 0 * w + 1), "1", "root", "w%s")
WORKBOOK = Workbook(
    name="parabola", title="A parabola", source="nobody", ledger=lambda: Ledger((eq1,)),
    measured=(Measured("c", "1", "constant", Bounds(low=-9)),), parameters=(),
    sheet=lambda given_names: Sheet((given, root)), tables=(TableSpec("all", "All", ("c", "w0")),),
)
""",
    "report.toml": 'title = "P"\nworkbook = "workbook.py"\n[measurements]\nfile = "m.csv"\n',
    "m.csv": "test,c [1]\n1,2\n2,-1\n3,5\n4,2.25\n",
}
REASONS = [
    "#TWOROOTS! w0[1]: (1) has more than one root here: 1 and 2 (several values of the interval satisfy the "
    "equation)",
    None,
    "#NOROOT! w0[3]: (1) has no root here: no value of the interval satisfies the equation",
    "#UNDECIDED! w0[4]: the roots of (1) cannot be counted near w = 1.5: it may "
    "touch zero, jump, or cross it too often",
]


@pytest.mark.parametrize("told", ["", "w0 solves (2), which is not derived from (1)"])
def test_what_is_solved_is_what_is_told_or_follows_from_it(
    told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Twice the equation is derived from it; three times the coefficient is another equation."""
    second = "2 * w**2 - 6 * w + 2 * c" if not told else "w**2 - 9 * w + c"
    entry = "Derivation.of(eq2, (eq1,), (c,), 'doubled')" if not told else "eq2"
    kind = "CLAIM" if not told else "ASSUMPTION"
    code = FOLDER["workbook.py"].replace("import Equation", "import Derivation, Equation")
    code = code.replace(
        "form = eq1", f"eq2 = Equation('(2)', ({second}, 0 * w), '', Kind.{kind})\nform = eq2"
    )
    code = code.replace("Root(form, ", "Root(eq1.at({c: given[k]}), ").replace("(eq1,)", f"(eq1, {entry})", 1)
    for name, text in (FOLDER | {"workbook.py": code}).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert main(["show", "w0", str(tmp_path)]) == (2 if told else 1)
    assert told in capsys.readouterr().err


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("parabola")
    for name, text in FOLDER.items():
        (place / name).write_text(text, encoding="utf-8")
    assert (
        main(["build", str(place), "--out", str(place / "out"), "--to", "html,json,xlsx"]) == 1
    )  # rows without a value
    return place


def test_all_roots_and_every_doubt_are_named_in_every_output(
    built: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cell = json.loads((built / "out" / "values.json").read_text("utf-8"))["cells"]["w0"]
    assert cell["status"] == ["#TWOROOTS!", "ok", "#NOROOT!", "#UNDECIDED!"]
    assert cell["reason"] == REASONS
    page = html.unescape((built / "out" / "report.html").read_text("utf-8"))
    assert main(["show", "w0", str(built)]) == 1
    shown = capsys.readouterr().out
    for reason in filter(None, REASONS):
        assert reason in shown
        assert reason.partition(": ")[2] in page
    book = openpyxl.load_workbook(built / "out" / "report.xlsx")
    notes = [c.comment.text for row in book["rows"].iter_rows() for c in row if c.comment]
    assert [note for note in notes if note.startswith("as issued")] == [
        f"as issued: {REASONS[0]}",
        f"as issued: {REASONS[3]}",
    ]


def test_a_temperature_in_a_workbook_is_as_issued_to_its_last_digit(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """273.16 - 273.15 is not 0.01 in doubles, and 0.01 is what stands in the cell of the input."""
    code = (
        "from loopsheet import Method, given, let, measured, root, unknown\n\n\n"
        'class Deg(Method, source="own", rows="points"):\n'
        '    """A root of each row."""\n\n'
        '    t = measured("degC", "temperature")\n'
        '    zero = given("degC", "ice", default="0 degC", exact=True)\n'
        '    d = let(t - zero, "above it", "K")\n'
        '    c = given("1/K", "coefficient")\n'
        "    x = unknown()\n"
        '    x = root(x + c * d * x**3 + x**5, 2 + c * d, "some number", low=-10, high=40)\n'
    )
    rows = "point,t [degC]\n1,0.010\n2,29.765\n3,-40.3\n"
    method_folder(tmp_path, code, rows, '[parameters]\nc = "0.0010 1/K"\n')
    assert main(["check", str(tmp_path)]) == 0
    assert re.search(r"engine +xlsx +11 cells", capsys.readouterr().out)
    assert main(["build", str(tmp_path), "--to", "xlsx"]) == 0
    book = openpyxl.load_workbook(tmp_path / "out" / "report.xlsx")["points"]
    at = {str(cell.value): cell.column_letter for cell in reversed(book[4]) if cell.value}
    assert [book[f"{at['t as issued']}{row}"].value for row in (8, 9, 10)] == [
        "=0.01", "=29.765", "=-40.3",
    ]  # fmt: skip


def test_an_edited_workbook_takes_no_root_that_was_not_counted(built: Path) -> None:
    """The formulas ask whether the inputs are as issued, and name nothing but that if they are not."""
    book = openpyxl.load_workbook(built / "out" / "report.xlsx")["rows"]
    at = {
        str(cell.value).removesuffix(" [1]"): cell.column_letter for cell in reversed(book[4]) if cell.value
    }
    flag, counted, kept = (at[name] for name in ("as issued", "counted", "c as issued"))
    for row, number in zip(range(8, 12), (2, 1, 0, -1), strict=True):
        assert book[f"{counted}{row}"].value == f"={number}.0"
        formula = book[f"{at['w0']}{row}"].value
        assert f"IF(${flag}{row}=1," in formula
        assert formula.count('"#UNDECIDED!"') == 2
    assert [book[f"{kept}{row}"].value for row in range(8, 12)] == ["=2.0", "=-1.0", "=5.0", "=2.25"]
    tested = book[f"{flag}8"].value
    assert f"${kept}$8:${kept}$11" in getattr(tested, "text", tested)
