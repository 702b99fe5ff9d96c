"""Cells outside of what is expected: computed, marked, counted wherever they are used, in every output."""

import io
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest
from sympy import And, Basic, Eq, Or, Symbol
from uncertain_data import uncertain

from loopsheet.derivations import soft_impact as model
from loopsheet.derivations.equation import Equation, Kind
from loopsheet.report import build
from loopsheet.report.archive import scaffold
from loopsheet.report.cells import units
from loopsheet.report.cells.marks import Marks, margins, with_margins
from loopsheet.report.cli import main
from loopsheet.report.engines import numpy as engine
from loopsheet.report.quantity import Bounds
from loopsheet.report.result.result import Report
from loopsheet.report.sheet import Axis, Column, Formula, Given, Limit, Sheet, SheetError
from loopsheet.report.study import Study
from loopsheet.report.views import html, latex
from loopsheet.report.workbooks.soft_impact import WORKBOOK

k, n = (Symbol(name, integer=True, positive=True) for name in "kn")
ROWS = Axis("rows", k, n)
a, b = Column("a", ROWS, Given(), "m"), Column("b", None, Given(), "m")


def limited(inside: Basic | Bounds, source: str = "") -> Sheet:
    """A column with one limit, and another that rests on it."""
    definition = Equation("(1)", (Symbol("c"), 2 * b.symbol), "", Kind.DEFINITION)
    limit = Limit(inside, "odd", source)
    return Sheet((replace(a, limits=(limit,)), b, Column("c", None, Formula(definition), "m")))


def marks_of(sheet: Sheet, **data: Any) -> Marks:
    values = engine.evaluate(sheet, {"rows": [1, 2, 3]}, data)
    found = margins(sheet)
    return Marks(engine.extend(values, [margin.column for margin in found], {}), found)


INSIDE: dict[str, tuple[Basic | Bounds, list[bool]]] = {
    "less": (a[k] < b.symbol, [False, False, True]),
    "at most": (a[k] <= 2 * b.symbol, [False, False, False]),
    "more": (a[k] > b.symbol / 2, [True, False, False]),
    "between": (And(a[k] >= b.symbol / 2, a[k] <= b.symbol), [True, False, True]),
    "not between": (Or(a[k] <= b.symbol / 2, a[k] >= b.symbol), [False, True, False]),
    "bounds": (Bounds(low=1, high=2), [True, False, True]),
    "one bound": (Bounds(low=1), [True, False, False]),
}


@pytest.mark.parametrize("case", INSIDE)
def test_what_lies_outside(case: str) -> None:
    inside, expected = INSIDE[case]
    sheet = limited(inside)
    units.check(sheet)
    marks = marks_of(sheet, a=[0.5, 1.5, 3.0], b=2.0)
    (margin,) = marks.margins
    assert marks.outside(margin).tolist() == expected
    assert marks.of("a") == ["odd" if outside else "" for outside in expected]


def test_what_stands_at_its_limit_is_inside() -> None:
    assert marks_of(limited(Bounds(1, 2)), a=[1.0, 2.0, np.nextafter(2, 3)], b=1.0).of("a") == ["", "", "odd"]
    assert marks_of(limited(a[k] < b.symbol), a=[1.0, 2.0, 3.0], b=2.0).of("a") == ["", "", "odd"]


def test_what_has_no_value_has_no_mark_and_is_not_counted() -> None:
    sheet = limited(Bounds(1, 2), "(4)")
    marks = marks_of(sheet, a=[0.5, np.nan, 1.5], b=1.0)
    assert marks.of("a") == ["outside (4)", "", ""]
    count = marks.limited("a")
    assert (count.number, count.size, count.said, count.inside) == (
        1, 2, "1 of 2 rows outside (4)", "1 of 2 rows"
    )  # fmt: skip


def test_only_comparisons_can_be_limits() -> None:
    with pytest.raises(SheetError, match=r"^a: a limit compares by < or >, it cannot be Eq\(a\[k\], b\)$"):
        margins(limited(Eq(a[k], b.symbol)))
    with pytest.raises(SheetError, match=r"^a_margin: no column is called 'q'"):
        with_margins(limited(a[k] < Symbol("q")))
    with pytest.raises(units.DimensionMismatch, match=r"^a given: cannot compare m and 1 in a\[k\] < 3$"):
        units.check(limited(a[k] < 3))


def test_names_that_are_taken_stay_free() -> None:
    _, *others = limited(Bounds(1)).columns
    own = replace(a, limits=(Limit(Bounds(1), "low"), Limit(Bounds(high=2), "high")))
    sheet = Sheet((own, *others, Column("a_margin", None, Given())))
    assert [margin.column.name for margin in margins(sheet)] == ["a_margin_2", "a_margin_3"]


# --- the workbook of the paper ----------------------------------------------------------------------------


def test_the_range_of_the_exponent_is_said_once() -> None:
    """By equation (4) of the ledger, for every exponent that the sheet computes."""
    sheet = WORKBOOK.sheet(frozenset({"ball_mass"}))
    for name in ("alpha", "alpha_mean", "alpha_median", "alpha_log", "alpha_lin"):
        column = sheet[name]
        limit = column.limits[0]
        assert limit.inside == model.eq4.value.xreplace({model.alpha: column.cell})
        assert (limit.source, limit.mark) == ("(4)", "outside (4)")


def test_the_paper_lies_inside(report: Report) -> None:
    assert not any(report.marks.outside(margin).any() for margin in report.marks.margins)
    assert report.marks.limited("alpha").inside == "10 of 10 pairs"
    assert all(
        not count.number for name in report.sheet.by_name for count in report.marks.behind(report.sheet[name])
    )


def test_the_paper_says_so(report: Report) -> None:
    page, text = html.render(report, {}), latex.render(report, [])
    inside = "<span data-inside=alpha_margin>10 of 10 pairs</span> lie inside this range"
    assert inside in page
    assert "10 of 10 pairs lie inside this range" in text
    assert "data-mark" not in page.partition("</style>")[2]
    assert "textdagger" not in text


@pytest.fixture(scope="module")
def slipped(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example of `new` with a speed of 4.0 where 3.1 was meant."""
    folder = tmp_path_factory.mktemp("marks") / "campaign"
    scaffold.new(folder, WORKBOOK)
    table = folder / "measurements.csv"
    table.write_text(table.read_text(encoding="utf-8").replace("3.100", "4.000"), encoding="utf-8")
    build.build(Study(folder), folder / "out", ("html", "latex", "xlsx", "json"))
    return folder


def test_marks_in_values_json(slipped: Path) -> None:
    cells = json.loads((slipped / "out" / "values.json").read_text(encoding="utf-8"))["cells"]
    assert cells["alpha"]["status"] == ["ok"] * 3
    assert cells["alpha"]["mark"] == ["outside (4)", None, "outside (4)"]
    assert cells["alpha_lin"]["mark"] == "outside (4)"
    assert cells["alpha_mean"]["mark"] is None
    assert "mark" not in cells["x_m1"]
    counted = [{"cell": "alpha", "mark": "outside (4)", "rows": 2, "of": 3}]
    for name in ("alpha_mean", "alpha_median", "alpha_log", "alpha_lin", "C_lin"):
        assert cells[name]["marked"] == counted
    assert "marked" not in cells["m_red"]


def test_marks_in_the_terminal(slipped: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "alpha", str(slipped)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.rpartition("  ")[2] for line in lines if "alpha[" in line][::2] == ["outside (4)"] * 2
    assert main(["show", "alpha_mean", str(slipped)]) == 0
    shown = capsys.readouterr().out
    assert "\n  2 of 3 pairs outside (4)\n" in shown
    assert "a speed of no drop test" not in shown, "none is"
    assert main(["show", "alpha_mean", "paper"]) == 0
    assert "\n  0 of 10 pairs outside (4)\n" in capsys.readouterr().out
    assert main(["why", "alpha[1-2]", str(slipped)]) == 0
    assert "\n  marked    outside (4)\n" in capsys.readouterr().out
    assert main(["why", "alpha_mean", str(slipped)]) == 0
    assert "\n  marked    2 of 3 pairs outside (4)\n" in capsys.readouterr().out


def test_marks_in_page_and_print(slipped: Path) -> None:
    page, text = (
        (slipped / "out" / name).read_text(encoding="utf-8") for name in ("report.html", "report.tex")
    )
    # Two pairs; a fit in text, result and two tables.
    assert page.count('data-mark="outside (4)" title="outside (4)"') == 6
    assert page.count("<span class=counted>2 of 3 pairs outside (4)</span>") == 6
    assert "<span data-inside=alpha_margin>1 of 3 pairs</span> lie inside" in page
    assert text.count(r"{\textsuperscript{\textdagger}}") == 2
    assert text.count("2 of 3 pairs outside (4)") == 6
    assert "1 of 3 pairs lie inside" in text
    for shown in (page, text):
        assert "Cells to look at" in shown


def test_marks_in_the_workbook(slipped: Path) -> None:
    content = (slipped / "out" / "report.xlsx").read_bytes()
    book = openpyxl.load_workbook(io.BytesIO(content))
    shown = openpyxl.load_workbook(io.BytesIO(content), data_only=True)
    rows = {row[0].value: row for row in shown["report"].iter_rows() if row[0].value}
    assert rows["alpha_mean"][7].value == "3 of 3 pairs; 2 of 3 pairs outside (4)"
    assert rows["alpha_lin_margin"][1].value < 0 < rows["alpha_mean_margin"][1].value
    (column,) = (
        cell.column
        for row in shown["pairs"].iter_rows()
        for cell in row
        if str(cell.value).split(" ")[0] == "alpha_margin"
    )
    assert [shown["pairs"].cell(row, column).value < 0 for row in (8, 9, 10)] == [True, False, True]
    colours = [
        rule.formula
        for area in book["pairs"].conditional_formatting
        for rule in area.rules
        if rule.type == "expression"
    ]
    letter = openpyxl.utils.get_column_letter(column)
    assert [f"AND(ISNUMBER(${letter}8),${letter}8<0)"] in colours


@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        ("v", "3.100", "3100", "a speed of no drop test: a fall of less than 0.5 mm, or of more than 20 m"),
        ("v", "3.100", "0.0031", "a speed of no drop test: a fall of less than 0.5 mm, or of more than 20 m"),
        ("alpha", "0.5050", "0.5500", "e rises with the speed"),
        ("x_p", "ball", "0.05 mm", "deeper than the radius of the ball"),
        ("ball_density", "ball", "7.8 kg/m^3", "lighter than foam, or denser than osmium"),
    ],
)
def test_what_no_drop_test_gives(
    tmp_path: Path, name: str, old: str, new: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "campaign"
    scaffold.new(folder, WORKBOOK)
    table, toml = folder / "measurements.csv", folder / "report.toml"
    table.write_text(table.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    if old == "ball":
        size, density = (new, "7800 kg/m^3") if "mm" in new else ("12.7 mm", new)
        given = f'ball_diameter = "{size}"\nball_density = "{density}"'
        toml.write_text(
            toml.read_text(encoding="utf-8").replace('ball_mass = "8.366 g"', given), encoding="utf-8"
        )
    report = Study(folder).computed
    told = [margin.limit.says for margin in report.marks.margins if report.marks.outside(margin).any()]
    assert said in told
    assert any(said in mark for mark in report.marks.of(name)) or report.values.status[name].any()
    assert main(["show", name, str(folder)]) == 0
    assert said in capsys.readouterr().out or report.values.status[name].any()


def test_a_mark_needs_no_value_of_its_cell() -> None:
    """e rises with the speed: that is why a pair has no exponent, and is said although it has none."""
    sheet = WORKBOOK.sheet(frozenset({"ball_mass"}))
    data = {
        "v": [2.0, 3.0],
        "e": [0.5, 0.9],
        "x_p": [2e-5, 3e-5],
        "ball_mass": 0.008,
        "beta": 1.5,
        "points_per_pair": 5,
    }
    values = engine.evaluate(sheet, {"tests": [1, 2]}, uncertain(data))
    found = margins(sheet)
    marks = Marks(engine.extend(values, [margin.column for margin in found], {}), found)
    (rises,) = (margin for margin in found if margin.limit.says.startswith("e rises"))
    assert values.status["alpha"][0]
    assert marks.outside(rises).tolist() == [True]
    assert marks.of("alpha") == [""]


def elastic(folder: Path, slip: float = 0.0) -> Path:
    """A campaign on a target that is loaded elastically, alpha = 3/2, printed with four digits."""
    folder.mkdir()
    lines = ["test,v [m/s],e [1],x_p [um]"]
    for test, v in enumerate((1.0, 1.5, 2.0, 3.0, 4.0), start=1):
        restitution = 0.6 * v**-0.1
        x_m = (2.5 * 0.01 * v**2 / (2 * 5e9)) ** (1 / 2.5)
        x_p = 1e6 * x_m * (1 - restitution**2) + slip * (test == 2)
        lines.append(f"{test},{v:.3f},{restitution:.4f},{x_p:.2f}")
    (folder / "measurements.csv").write_text("\n".join(lines) + "\n")
    (folder / "report.toml").write_text(
        'title = "Elastic"\nworkbook = "soft_impact"\n[parameters]\nball_mass = "10 g"\nbeta = "1.5"\n'
        '[measurements]\nfile = "measurements.csv"\n'
    )
    return folder


def test_what_its_uncertainty_takes_beyond_a_limit_is_no_finding(tmp_path: Path) -> None:
    """Of honest numbers at the limit half lie beyond it: they are marked, and nobody is blamed."""
    report = Study(elastic(tmp_path / "honest")).computed
    (alpha,) = (each for each in report.marks.margins if each.column.name == "alpha_margin")
    marked = report.marks.count(alpha)
    assert 0 < marked.number < marked.size
    of_limit = {check.name: check for check in report.oddities if check.kind == "limit"}
    found = of_limit[f"alpha: {alpha.limit.mark}"]
    assert (found.passed, found.note) == (True, "")
    assert found.message == f"alpha: {marked.said} by no more than 2 u"
    assert not any(check.word for check in of_limit.values())
    # A twentieth of a micrometre is ten times what is printed.
    slipped = Study(elastic(tmp_path / "slipped", 0.05)).computed
    told = next(check for check in slipped.oddities if check.name == found.name)
    assert told.word
    assert "look at test 2 first" in told.message
