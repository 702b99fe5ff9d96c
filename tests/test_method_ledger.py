"""A method that takes its equations from a ledger: what its names, its rows and its words are."""

from __future__ import annotations

from pathlib import Path

import pytest
from helpers import method_folder
from sympy import Rational, Sum, Symbol

from loopsheet import (
    Method,
    by,
    expected,
    given,
    let,
    measured,
    numbered,
    pairs,
    plot,
    sketch,
    standing,
    uncertainty,
    unknown,
)
from loopsheet.derivations.equation import Equation, Kind, Ledger, define
from loopsheet.derivations.vocabulary import Quantity, Vocabulary
from loopsheet.report.cli import main
from loopsheet.report.column import Given, Iterated, Root
from loopsheet.report.engines.numpy import evaluate
from loopsheet.report.study import Study

WORDS = Vocabulary(
    Quantity("t", "time of the fall", "s", "t%s"),
    Quantity("h", "height", "m", "h%s"),
    Quantity("g", "free fall", "m/s^2", "g%s"),
    Quantity("g_m", "mean free fall", "m/s^2", r"\bar{g}%s"),
    Quantity("d", "diameter", "m", "d%s"),
    Quantity("V", "volume", "m^3", "V%s"),
    Quantity("a", "edge of a cube of the same volume", "m", "a%s"),
    Quantity("G", "free fall by two heights", "m/s^2", "G%s"),
)
T, H, G = (WORDS[name] for name in ("t", "h", "g"))
t, h, g, g_m, d, V, a, by_two = WORDS.plain("t h g g_m d V a G")
k, n = (Symbol(name, integer=True, positive=True) for name in "kn")
FALL = define("(1)", g, 2 * h / t**2, "free fall")
MEAN = define("(2)", g_m, Sum(G[k], (k, 1, n)) / n, "mean free fall")
BALL = define("(3)", V, 2 * d**3 / 3, "volume")
CUBE = Equation("(4)", (a**3, V), "definition", Kind.DEFINITION, "edge", defines=a)
TWO = define("(5)", by_two, 2 * (H[2] - H[1]) / (T[2] ** 2 - T[1] ** 2), "free fall by two heights")
FALLS = Equation("(6)", (g < 10,), "of the earth", Kind.ASSUMPTION, "range of free fall")
LEDGER = Ledger((FALL, MEAN, BALL, CUBE, TWO, FALLS), vocabulary=WORDS)


class Fall(Method, ledger=LEDGER, rows="drops"):
    """Free fall."""

    t = measured(WORDS["t"], "time, as measured", positive=True)
    h = measured(WORDS["h"], "height, as measured", positive=True)
    d = given(WORDS["d"], "diameter of the ball", positive=True, optional=True)
    V = given("cm^3", "volume of the ball", positive=True, otherwise=BALL)
    density = given("kg/m^3", "density of the ball", positive=True, optional=True)
    u_h = uncertainty(h)
    with standing({WORDS["t"].symbol: t, WORDS["h"].symbol: h}):
        g_k = by(FALL, needs=(WORDS["t"].symbol > Rational(1, 10), "too short"), spare=True)
    with standing({G[k]: g_k}):
        g_mean = by(MEAN, "mean of all drops", latex="g_0", over=g_k)
    expected(FALLS, g_k)
    expected((0, 3), h, says="no tower")
    expected(density > 1000, g_mean, says="floats")
    a = by(CUBE, root={"low": 0, "high": 10, "start": 1}, none="no edge")
    b = unknown(positive=True)
    with standing({WORDS["a"].symbol: b}):
        b = by(CUBE, step=(2 * b + WORDS["V"].symbol / b**2) / 3, start=1)
    first, second = pairs()
    with standing({T[1]: first(t), T[2]: second(t)}, {H[1]: first(h), H[2]: second(h)}):
        g_two = by(TWO)
    each = sketch(3, "points of each path")
    s = numbered("places", each, of=h, index="place", size="places_all", step="s")
    deep = sketch(h * s / each, "depth", "m")


def test_names_units_rows_and_words_follow_from_the_ledger() -> None:
    book = Fall.workbook
    sheet = book.sheet(frozenset({"V"}))
    told = {c.name: (c.axis and c.axis.name, c.unit, c.meaning, c.latex, c.display) for c in sheet.columns}
    assert told["t"] == ("drops", "s", "time of the fall", "t%s", "like t")
    assert told["g_k"] == ("drops", "m/s^2", "free fall", "g%s", "")
    assert told["g_mean"] == (None, "m/s^2", "mean of all drops", "g_0", "")
    assert told["a"] == (None, "m", "edge of a cube of the same volume", "a%s", "like h")
    assert told["u_h"][:2] == ("drops", "m")
    assert told["g_two"][0] == "pairs"
    assert [one.meaning for one in book.measured] == ["time, as measured", "height, as measured"]
    assert [entry.label for entry in book.ledger().entries] == ["(1)", "(2)", "(3)", "(4)", "(5)", "(6)"]
    assert [c.name for c in sheet["g_mean"].alongside] == ["g_k"]
    assert isinstance(sheet["u_h"].rule, Given)
    assert sheet["u_h"].rule.u_of == "h"
    assert isinstance(sheet["a"].rule, Root)
    assert isinstance(sheet["b"].rule, Iterated)
    assert sheet["g_k"].spare
    assert sheet["g_k"].limits[0].mark == "outside (6)"


def test_what_rests_on_a_parameter_that_is_left_out_is_left_out() -> None:
    book = Fall.workbook
    whole, without = (book.sheet(frozenset(names)) for names in ({"V", "density", "d"}, {"d"}))
    assert {"d", "density", "V"} <= whole.by_name.keys()
    assert whole["V"].source == "parameter"
    assert without["V"].source == "(3)"
    assert "density" not in without
    assert len(whole["g_mean"].limits) == 1
    assert without["g_mean"].limits == ()
    assert book.wrong(frozenset({"d"})) is None
    assert book.wrong(frozenset({"V", "density"})) is None
    assert book.wrong(frozenset({"V", "d"})) == "V and d say the same thing twice; keep one"
    assert book.wrong(frozenset()) == "the volume of the ball is missing: give V, or d"


def test_what_is_computed_is_what_the_ledger_says() -> None:
    sheet = Fall.workbook.sheet(frozenset({"d"}))
    data = {"t": [0.45, 0.64, 0.05], "h": [1.0, 2.0, 0.1], "d": 0.3, "u_h": [0.001] * 3}
    values = evaluate(sheet, {"drops": (1, 2, 3)}, data)
    g_k = [2 * h / t**2 for t, h in zip(data["t"][:2], data["h"][:2], strict=True)]
    assert values.value["g_k"][:2].tolist() == pytest.approx(g_k, rel=1e-14)
    assert values.cell("g_k", (3,)).reason.endswith("too short")
    assert values.scalar("g_mean") == pytest.approx(sum(g_k) / 2, rel=1e-14)
    assert values.scalar("a") == pytest.approx((2 * 0.3**3 / 3) ** (1 / 3), rel=1e-14)
    assert values.scalar("b") == pytest.approx((2 * 0.3**3 / 3) ** (1 / 3), rel=1e-12)


AIR = 2 * h / t**2 + g**2 * t**2 / d
DRAG = Equation("(4)", (g, AIR), "drag", Kind.ASSUMPTION, "drag of air", defines=g)


class Own(Method, ledger=Ledger((DRAG, BALL), vocabulary=WORDS), rows="drops"):
    """Free fall with formulas of its own."""

    t = measured(T, "time", positive=True)
    h = measured(WORDS["h"], positive=True)
    d = given("m", "diameter of the ball", positive=True)
    speed = let(2 * h / t, "speed at the end", "m/s")
    g = unknown(of=t)
    g = by(DRAG, step=AIR, start=9)
    each = sketch(3, "points of each path")
    s = numbered("places", each, of=h, index="place", size="places_all", step="s")
    deep, after = sketch(h * s / each, "depth", "m"), sketch(t * s / each, "time", "s")
    plot(t, h, (after, deep))


def test_a_word_stands_for_its_column_and_what_is_announced_for_its_symbol() -> None:
    sheet = Own.workbook.sheet(frozenset({"d"}))
    t_k, h_k, g_k = (sheet[name].cell for name in "thg")
    rule = sheet["g"].rule
    assert isinstance(rule, Iterated)
    assert rule.step == 2 * h_k / t_k**2 + g_k**2 * t_k**2 / sheet["d"].cell
    assert sheet["g"].unit == "m/s^2"


def test_a_word_says_what_it_is() -> None:
    assert [one.meaning for one in Own.workbook.measured] == ["time", "height"]


def test_formulas_of_its_own_are_numbered_behind_those_of_the_ledger() -> None:
    assert Own.workbook.sheet(frozenset({"d"}))["speed"].source == "(5)"
    assert len({equation.number for equation in Own.workbook.ledger().equations()}) == 3


def test_a_sketch_is_drawn_beside_points() -> None:
    (chart,) = Own.workbook.charts
    assert [(each.x, each.y, each.each) for each in chart.series] == [
        ("t", "h", False),
        ("after", "deep", True),
    ]


def test_charts_alone_have_sketches() -> None:
    book = Fall.workbook
    assert book.drawn is not None
    drawn = book.drawn(book.sheet(frozenset({"V"})))
    assert [(c.name, c.unit, c.display) for c in drawn.columns] == [
        ("each", "1", ""),
        ("deep", "m", "like h"),
    ]
    assert drawn.given == {"each": 3}
    assert "deep" not in book.sheet(frozenset({"V"}))


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("x = by(FALL)", "x: by() takes an equation of the ledger, class X(Method, ledger=...)"),
        ("x = sketch(2 * c, 'twice')", "x is a single number, which is no column of a chart"),
        ("x = numbered('rows', c, of=c, index='r', size='rs', step='s')", "c is a single number: rows are"),
        ("expected((0, 1), c * 2)", "is not declared"),
    ],
)
def test_what_is_refused(line: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code = (
        "from sympy import Symbol\n"
        "from loopsheet import Method, by, expected, given, let, numbered, sketch\n"
        "from loopsheet.derivations.equation import define\n"
        "FALL = define('(1)', Symbol('x'), Symbol('c'), 'itself')\n\n\n"
        "class Own(Method):\n    '''Own.'''\n\n    c = given('1', 'a number')\n    y = let(2 * c, 'twice')\n"
        f"    {line}\n"
    )
    assert main(["check", str(method_folder(tmp_path, code, more='[parameters]\nc = "1"\n'))]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert "workbook.py:12" in told


GAUGE = """\
from sympy import Abs, Sum, Symbol, sqrt
from loopsheet import Method, by, given, let, mean, measured, standing
from loopsheet.derivations.equation import Ledger, define
from loopsheet.derivations.vocabulary import Quantity, Vocabulary

W = Vocabulary(
    Quantity("x", "reading of the gauge", "m", "x%s"{positive}), Quantity("D", "mean size", "m", "D%s"),
    Quantity("y", "way", "m", "y%s"{low}), Quantity("z", "way from there", "m", "z%s"),
)
X = W["x"]
D, y, z = W.plain("D y z")
k, n = (Symbol(name, integer=True, positive=True) for name in "kn")
SIZE = define("(1)", D, Sum(Abs(X[k]), (k, 1, n)) / n, "mean size of a reading")
WAY = define("(2)", z, y - D, "way from there on")


class Gauge(Method, ledger=Ledger((SIZE, WAY), vocabulary=W), rows="loads"):
    '''A gauge.'''

    x = measured(X)
    y = given(W["y"]{bounds})
    with standing({{X[k]: x}}):
        D = by(SIZE)
    z = by(WAY)
    e = let(mean(sqrt(x**2)), "the same")
"""


def gauge_of(
    folder: Path,
    x: str = "2.00 -3.00 4.00",
    y: str = "7.0 m",
    positive: str = "",
    low: str = "",
    bounds: str = "",
) -> str:
    code = GAUGE.format(positive=positive, low=low, bounds=bounds)
    rows = "".join(f"{n},{each}\n" for n, each in enumerate(x.split(), start=1))
    return str(method_folder(folder, code, f"load,x [m]\n{rows}", f'[parameters]\ny = "{y}"\n'))


def test_what_a_word_says_is_positive_is_so_of_the_data(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its formulas and proofs count on it: the mean size of 2, -3 and 4 was 1."""
    assert main(["show", "D", gauge_of(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert "x is out of range: '-3.00'" in told
    assert "measurements.csv:3:3" in told
    assert "with positive=False in its Quantity the method lets any number in" in told
    folder = gauge_of(tmp_path, positive=", positive=False")
    assert [Study(Path(folder)).computed.values.scalar(name) for name in ("D", "e")] == [3.0, 3.0]


def test_a_word_that_is_positive_is_not_declared_otherwise(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", gauge_of(tmp_path, "1 2", bounds=", low=-5, high=9")]) == 2
    told = capsys.readouterr().err
    assert "y is positive, as its word says: no end is -5; positive=False in its Quantity lets it be" in told


def test_what_may_be_zero_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "y", gauge_of(tmp_path, "1 2", "0 m")]) == 2
    assert "y is out of range: '0'" in capsys.readouterr().err
    assert main(["show", "y", gauge_of(tmp_path, "1 2", "0 m", bounds=", low=0")]) == 0


@pytest.mark.parametrize(
    ("unit", "y", "low", "code"),
    [
        ("mm", "7.0 mm", ", low=0.001, high=0.01", 0),
        ("mm", "0.7 mm", ", low=0.001, high=0.01", 2),
        ("mm", "-7 mm", "", 2),
        ("degC", "-5.0 degC", "", 0),
        ("degC", "-300 degC", "", 2),
        ("1", "1.5", ", whole=True", 2),
        ("1", "2", ", whole=True", 0),
    ],
)
def test_a_word_keeps_its_data_within_its_ends_in_any_unit(
    unit: str, y: str, low: str, code: int, tmp_path: Path
) -> None:
    method = (
        "from loopsheet import Method, given, let\nfrom loopsheet.derivations.equation import Ledger\n"
        "from loopsheet.derivations.vocabulary import Quantity, Vocabulary\n\n"
        f"W = Vocabulary(Quantity('y', 'a datum', '{unit}', 'y%s'{low}))\n\n\n"
        "class Own(Method, ledger=Ledger((), vocabulary=W)):\n    'Own.'\n\n    y = given(W['y'])\n"
        "    z = let(2 * y, 'twice')\n"
    )
    folder = method_folder(tmp_path, method, more=f'[parameters]\ny = "{y}"\n')
    assert main(["show", "z", str(folder)]) == code


def test_the_ends_that_a_word_has_hold_of_the_data(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = gauge_of(tmp_path, "1 2", low=", low=8.0, high=9.0")
    assert main(["check", folder]) == 2
    assert "y is out of range: '7.0'" in capsys.readouterr().err


def test_what_a_word_says_is_positive_and_is_not_is_told_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["show", "z", gauge_of(tmp_path, "1 2", "1.0 m")]) == 1
    assert "z: outside the domain of (2): it has to be positive" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("formula", "said"),
    [
        ("X[2] - X[1]", "x[1] is one row by its number, which no formula names"),
        ("X[k] - X[k - 1]", "x[k - 1] is one row by its number"),
        (
            "Sum(X[k], (k, 1, 3))",
            "D: a sum runs over all rows of one index set ((k, 1, n)), not over (k, 1, 3)",
        ),
    ],
)
def test_a_formula_that_names_single_rows_is_told(
    formula: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = Path(gauge_of(tmp_path, "1 2"))
    code = (folder / "workbook.py").read_text(encoding="utf-8")
    code = code.replace("Sum(Abs(X[k]), (k, 1, n)) / n", formula)
    (folder / "workbook.py").write_text(code, encoding="utf-8")
    assert main(["check", str(folder)]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert "workbook.py:23" in told
