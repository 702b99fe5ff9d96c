"""report.xlsx as it is delivered: what is in which cell, what may be typed, and that text stays text."""

import io
import json
import re
import shutil
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from helpers import method_folder
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.formula import ArrayFormula

from loopsheet.derivations.vocabulary import with_index
from loopsheet.report import stages
from loopsheet.report.build import build
from loopsheet.report.cells.grid import Grid, letters
from loopsheet.report.document.notation import fragments
from loopsheet.report.engines import excel_grid
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.quantity import Bounds
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import json as json_view
from loopsheet.report.views import xlsx
from loopsheet.report.views.xlsx_style import (
    LONGEST,
    height,
    open_format,
    typical_format,
)


def grid_of(report: Report) -> Grid:
    units = {name: shown.unit for name, shown in report.shown.items()}
    drawn = stages.for_a_grid(report)
    return excel_grid.grid(report.sheet, report.values, units, report.workbook.headline, drawn)


@pytest.fixture(scope="module")
def grid(report: Report) -> Grid:
    return grid_of(report)


@pytest.fixture(scope="module")
def content(report: Report, grid: Grid) -> bytes:
    return xlsx.render(report, grid)


@pytest.fixture(scope="module")
def book(content: bytes) -> Any:
    return openpyxl.load_workbook(io.BytesIO(content))


@pytest.fixture(scope="module")
def shown(content: bytes) -> Any:
    return openpyxl.load_workbook(io.BytesIO(content), data_only=True)


def named(book: Any, name: str) -> list[Any]:
    """The cells of a defined name."""
    worksheet, _, cells = book.defined_names[name].attr_text.partition("!")
    found = book[worksheet.strip("'")][cells.replace("$", "")]
    return [row[0] for row in found] if isinstance(found, tuple) else [found]


# --- what is there ---------------------------------------------------------------------------------------


def test_worksheets(book: Any) -> None:
    assert book.sheetnames == [
        "report", "figures", "tests", "pairs", "points", "loops", "bands", "steps", "published",
        "uncertainty", "derivatives", "equations",
    ]  # fmt: skip


def test_every_column_is_a_defined_name_with_the_values_of_the_report(report: Report, shown: Any) -> None:
    assert {f"ls_{name}" for name in json.loads(json_view.values(report))["cells"]} == set(
        shown.defined_names
    )
    for name, values in report.values.value.items():
        scale = report.shown[name].scale
        assert [c.value * scale for c in named(shown, f"ls_{name}")] == pytest.approx(values, rel=1e-14), name


def test_names_do_not_tell_capitals(report: Report, grid: Grid) -> None:
    sheet = report.sheet
    twin = replace(sheet["C"], name="c")
    values = report.values
    own = {name: {**getattr(values, name), "c": getattr(values, name)["C"]} for name in ("value", "status")}
    more = replace(
        report,
        sheet=(twins := type(sheet)((*sheet.columns, twin))),
        values=replace(values, sheet=twins, **own),
        shown={**report.shown, "c": report.shown["C"]},
    )
    blocks = (*grid.blocks, replace(grid["C"], name="c"))
    content = xlsx.render(more, replace(grid, blocks=blocks))
    names = openpyxl.load_workbook(io.BytesIO(content)).defined_names
    assert {"ls_C", "ls_c_2"} <= set(names)


def test_inputs_are_numbers_as_printed(book: Any) -> None:
    tests = book["tests"]
    assert [tests.cell(4, n).value for n in (2, 3, 4)] == ["v [m/s]", "e [1]", "x_p [um]"]
    assert [tests.cell(row, 4).value for row in range(8, 13)] == [23.5, 29.7, 41.6, 45.97, 51.03]
    assert tests["B9"].value == 2.94
    assert tests["B9"].number_format == "0.000######"
    assert tests["D9"].fill.fgColor.rgb == "FFFFF8DC"


def test_what_is_not_nothing_is_not_shown_as_0(report: Report, shown: Any) -> None:
    """Of every column, in the number format of each of its cells."""
    for name in report.values.value:
        for cell in named(shown, f"ls_{name}"):
            decimals = re.fullmatch(r"0\.?(0*)#*", cell.number_format)
            if decimals and cell.value:
                assert round(cell.value, len(decimals[1]) + cell.number_format.count("#")), cell.coordinate


def test_every_computed_cell_is_a_formula(grid: Grid, book: Any) -> None:
    for block in grid.blocks:
        if block.kind in ("index", "given"):
            continue
        for row in range(block.place.rows):
            cell = book[block.place.worksheet].cell(block.place.row + row + 1, block.place.column + 1).value
            assert isinstance(cell, ArrayFormula) == block.array, (block.name, row)
            assert (cell.text if block.array else cell) == block.formulas[row]


def test_headers_say_name_unit_meaning_equation_and_symbol(book: Any) -> None:
    pairs = book["pairs"]
    assert [pairs.cell(row, 3).value for row in range(4, 8)] == [
        "alpha [1]",
        "exponent of the compression law",
        "(11)",
        "α",
    ]
    assert [pairs.cell(row, 4).value for row in (4, 6, 7)] == ["x_m2 [um]", "(12a)", "xm2"]
    assert [c.value for c in pairs[4][:3]] == ["i", "j", "alpha [1]"]


def test_panes_are_frozen_and_steps_are_an_outline(grid: Grid, book: Any) -> None:
    assert book["tests"].freeze_panes == "B8"
    assert book["points"].freeze_panes == "D8"
    step = grid["alpha.f_1"].place.column
    dimension = book["pairs"].column_dimensions
    level = next(d for d in dimension.values() if d.min <= step + 1 <= d.max)
    assert (level.outlineLevel, level.hidden) == (1, False)


@pytest.mark.parametrize("name", ["loops", "bands"])
def test_points_that_are_only_drawn_are_printed_whole(book: Any, name: str) -> None:
    """How many there are is given above them, in the first columns."""
    last = get_column_letter(book[name].max_column)
    assert re.search(r":\$([A-Z]+)\$", book[name].print_area)[1] == last  # type: ignore[index]


def test_the_shares_of_a_variance_are_bars_of_a_whole(book: Any) -> None:
    sheet = book["uncertainty"]
    shares = {cell.coordinate for cell in sheet["I"] if str(cell.value).startswith("=")}
    barred = set()
    for own in sheet.conditional_formatting:
        (rule,) = own.rules
        assert rule.type == "dataBar"
        assert [(end.type, end.val) for end in rule.dataBar.cfvo] == [("num", 0), ("num", 1)]
        barred |= {cell.coordinate for (cell,) in sheet[str(own.sqref)]}
    assert barred == shares
    assert len(shares) > 50


def test_the_first_worksheet(book: Any, shown: Any, report: Report) -> None:
    cells = shown["report"]
    assert cells["A1"].value == "Soft steel, ball drop"
    headline = report.workbook.headline
    assert [cells.cell(row, 1).value for row in range(6, 6 + len(headline))] == list(headline)
    assert cells["B6"].value == pytest.approx(1.30130453, abs=1e-8)
    assert [cells.cell(6, n).value for n in (3, 4, 5, 8)] == [
        "1",
        "exponent of the global fit",
        "(L42)",
        "5 of 5 tests",
    ]
    text = "\n".join(str(c.value) for row in cells.iter_rows() for c in row if c.value)
    for code in ("#INPUT!", "#DOMAIN!", "#NOROOT!", "#TWOROOTS!", "#OVERFLOW!", "#STEPS!"):
        assert code in text
    assert isinstance(book["report"]["H6"].value, ArrayFormula)


def test_published_values_stand_beside_live_ones(book: Any, shown: Any, report: Report) -> None:
    live, now = book["published"], shown["published"]
    assert [now.cell(6, n).value for n in (1, 2, 3, 4, 5)] == ["Table 2", "alpha", "1-2", "1", 1.234]
    assert live["F6"].value == "=IF(ISNUMBER(pairs!$C$8),pairs!$C$8,pairs!$C$8)"
    assert live["I6"].value == '=IF(ISNUMBER($F$6),IF(ROUND($F$6,3)=$E$6,"same","differs"),"not-checkable")'
    for row, comparison in enumerate(report.comparisons, start=6):
        assert now.cell(row, 9).value == comparison.verdict
        assert now.cell(row, 11).value == float(comparison.again)
        assert now.cell(row, 12).value == ("yes" if comparison.as_expected else "no")
        assert now.cell(row, 8).value == pytest.approx(comparison.distance, abs=1e-9)
        assert now.cell(row, 13).value == comparison.published.reason
    assert live["L6"].value == '=IF($I$6="differs",IF(ROUND($F$6,3)=$K$6,"yes","no"),"no")'
    depth = next(row for row in range(6, 40) if now.cell(row, 2).value == "x_m")
    assert live.cell(depth, 6).value == "=IF(ISNUMBER(tests!$I$8),tests!$I$8,tests!$I$8)"


def test_published_uncertainties_stand_below(tmp_path: Path) -> None:
    """As issued, for they are no cells of the sheet; the page has a table of them."""
    build(Study(PAPER.parent / "gum_h1"), tmp_path / "out", ("xlsx", "json"))
    rows = openpyxl.load_workbook(tmp_path / "out" / "report.xlsx")["published"].iter_rows(min_row=6)
    told = [[cell.value for cell in row] for row in rows]
    (first,) = (n for n, row in enumerate(told) if str(row[0]).startswith("Published uncertainties"))
    values = json.loads((tmp_path / "out" / "values.json").read_text())["published_u"]
    assert [(row[1], row[4]) for row in told[first + 1 :]] == [
        (each["cell"], each["printed"]) for each in values
    ]
    assert next([row[1], *row[4:6]] for row in told if row[1] == "U99(l)") == ["U99(l)", "93", "99"]


def test_equations_and_their_proofs(shown: Any) -> None:
    rows = {row[0].value: [c.value for c in row] for row in shown["equations"].iter_rows(min_row=5)}
    assert rows["(11)"][3] == "proved"
    assert rows["(12e)"][3] == "proved with a correction of the print"
    assert rows["(9)"][2] == "C*x_m^alpha = C'"
    assert "where x_m > x_p" in rows["(L4)"][2]
    assert rows["(6)"][4] == "(3); theorem of kinetic energy, compression"
    assert rows["(L6)"][4] == "nothing, it is an identity"
    assert not rows["(8)"][4]


# --- what may be typed -----------------------------------------------------------------------------------


def validations(sheet: Any) -> dict[str, Any]:
    return {str(v.sqref): v for v in sheet.data_validations.dataValidation}


def test_what_may_be_typed_is_checked(book: Any, grid: Grid) -> None:
    def guard(cell: str, *tests: str) -> str:
        return f"IF(ISNUMBER({cell}),AND({','.join([f'NOT(ISLOGICAL({cell}))', *tests])}),FALSE())"

    tests = validations(book["tests"])
    assert tests["B8:B12"].formula1 == guard("B8", "B8>0")
    assert tests["C8:C12"].formula1 == guard("C8", "C8<=1", "C8>=0")
    assert tests["D8:D12"].error == "x_p must be greater than 0 um."
    count = grid["points_per_pair"].place.cell(0, "report").replace("$", "")
    assert validations(book["report"])[count].formula1 == guard(count, f"{count}<=50", f"{count}>=50")


def test_what_is_refused_is_told_beside_it(book: Any, grid: Grid) -> None:
    tests, report = book["tests"], book["report"]
    first = next(cell.column for cell in tests[3] if cell.value == "as checked")
    checked = [get_column_letter(first + place) for place in range(6)]
    names = ["v [m/s]", "e [1]", "x_p [um]", "u_v [m/s]", "u_e [1]", "u_x_p [um]"]
    assert [tests[f"{column}4"].value for column in checked] == names
    broken = [f"NOT(ISNUMBER(${column}$8))" for column in checked]
    told = (
        *("v must be greater than 0 m/s. ", "e must be between 0 and 1. ", "x_p must be greater than 0 um. "),
        *("u_v must be at least 0 m/s. ", "u_e must be at least 0. ", "u_x_p must be at least 0 um. "),
    )
    said = "&".join(f'IF({test},"{text}","")' for test, text in zip(broken, told, strict=True))
    assert tests["H4"].value == "check"
    other = 'IF(NOT(AND($A$8=1)),"#INPUT! not the row as issued: its number, name or group is another one",'
    assert tests["H8"].value == f'={other}IF(OR({",".join(broken)}),"#INPUT! "&{said},"ok"))'
    row = grid["points_per_pair"].place.row + 1
    assert "change report.toml and build again" in report[f"H{row}"].value
    assert report[f"G{row}"].value.startswith("=IF(IF(ISNUMBER(")
    (rule,) = next(own for own in tests.conditional_formatting if str(own.sqref) == "B8:B12").rules
    assert rule.formula == [f"NOT(ISNUMBER({checked[0]}8))"]


def test_a_report_without_single_cells_has_its_alert_first() -> None:
    report = Study(PAPER.parent / "kepler").computed
    book = openpyxl.load_workbook(io.BytesIO(xlsx.render(report, grid_of(report))))
    assert book["report"]["A3"].value.endswith("orbits!$A$3")


def test_no_formula_names_a_given_cell_but_its_check(grid: Grid, book: Any) -> None:
    typed = {
        f"{prefix}{address}"
        for block in grid.blocks
        if block.kind == "given"
        for address in block.place.cells(range(block.place.rows), block.place.worksheet)
        for prefix in (f"{block.place.worksheet}!", f"{block.place.worksheet} alone ")
    }
    named = set()
    for sheet in book.worksheets:
        for row in sheet.iter_rows():
            for cell in row:
                formula = cell.value.text if isinstance(cell.value, ArrayFormula) else cell.value
                if not isinstance(formula, str) or not formula.startswith("="):
                    continue
                found = re.findall(r"(?:(\w+)!)?(\$[A-Z]+)\$?([0-9]+)", formula)
                found = {
                    f"{of}!{letters}${row}" if of else f"{sheet.title} alone {letters}${row}"
                    for of, letters, row in found
                }
                if found & typed:
                    named.add((sheet.title, cell.coordinate))
    checks = {
        (block.place.worksheet, block.place.cell(row, block.place.worksheet).replace("$", ""))
        for block in grid.blocks
        if block.kind == "checked"
        for row in range(block.place.rows)
    }
    assert named == checks
    assert len(checks) == 30 + 4 + 2


def test_notes_say_meaning_bounds_and_origin(book: Any, grid: Grid) -> None:
    note = book["tests"]["D9"].comment.text
    assert "x_p: imprint depth" in note
    assert "x_p must be greater than 0 um." in note
    assert "Given as 29.7 um in measurements.csv:3:15." in note
    fixed = book["report"][grid["points_per_pair"].place.cell(0, "report").replace("$", "")].comment.text
    assert "build again" in fixed
    assert "The default." in fixed


def test_bounds_are_told_in_the_unit_of_the_cells(report: Report) -> None:
    bounds = Bounds(low=1e-6, high=0.001, high_open=True)
    sheet = report.sheet.bounded(dict.fromkeys(("v", "e", "x_p"), bounds))
    changed = replace(report, sheet=sheet, values=replace(report.values, sheet=sheet))
    book = openpyxl.load_workbook(io.BytesIO(xlsx.render(changed, grid_of(changed))))
    assert "AND(NOT(ISLOGICAL(D8)),D8<1000,D8>=1)" in validations(book["tests"])["D8:D12"].formula1
    assert "AND(NOT(ISLOGICAL(B8)),B8<0.001,B8>=0.000001)" in validations(book["tests"])["B8:B12"].formula1
    assert "x_p must be at least 1 and less than 1000 um. " in book["tests"]["H8"].value


# --- charts ----------------------------------------------------------------------------------------------


def files(content: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_charts_are_native_and_drawn_from_cells(content: bytes) -> None:
    charts = [
        text.decode()
        for name, text in files(content).items()
        if re.fullmatch(r"xl/charts/chart\d+\.xml", name)
    ]
    assert len(charts) == 3
    loops = next(text for text in charts if "Figure 4" in text)
    assert len(re.findall("<c:ser>", loops)) == 1 + 5 + 5
    assert "points!$H$8:$H$507" in loops
    assert "loops!$C$8:$C$40" in loops
    assert "restitution of test 5" in loops
    assert "strRef" not in re.sub(r"<c:tx>.*?</c:tx>", "", loops), "numbers that are read as labels"
    assert len(re.findall("<c:legendEntry>", loops)) == 4, "the fitted curve is named once"


def test_what_has_no_value_is_left_out_of_a_chart(tmp_path: Path) -> None:
    shutil.copytree(PAPER, tmp_path / "in")
    table = tmp_path / "in" / "measurements.csv"
    table.write_text(table.read_text().replace("0.479", "0.9"))
    (tmp_path / "in" / "published.csv").unlink()
    toml = tmp_path / "in" / "report.toml"
    toml.write_text(toml.read_text().partition("[published]")[0])
    report = Study(tmp_path / "in").computed
    assert (report.values.status["alpha"] != 0).any()
    grid = grid_of(report)
    content = xlsx.render(report, grid)
    shown = openpyxl.load_workbook(io.BytesIO(content), data_only=True)
    assert "#N/A" in {c.value for c in shown["pairs"][letters(grid["plotted_alpha"].place.column)]}
    assert "#NOROOT!" in {c.value for c in shown["pairs"]["C"]}
    assert "published" not in shown.sheetnames
    for name, text in files(content).items():
        if name.startswith("xl/charts/chart"):
            assert b"#N/A" not in text
            assert b"#NOROOT!" not in text


# --- bytes and text --------------------------------------------------------------------------------------


def test_same_bytes_for_the_same_report(report: Report, content: bytes) -> None:
    assert xlsx.render(report, grid_of(report)) == content


def test_no_clock_and_no_place(content: bytes) -> None:
    core = files(content)["docProps/core.xml"].decode()
    assert "2000-01-01T00:00:00Z" in core
    for name, text in files(content).items():
        assert str(PAPER).encode() not in text, name
        assert b"/tmp" not in text, name


HOSTILE = (
    "=cmd|' /C calc'!A0",
    "+1",
    "-1+1",
    "@SUM(1)",
    '=HYPERLINK("http://x.test")',
    '<b>"&amp;</b>',
    "http://x.test",
    "_x0041_",
)


@pytest.mark.parametrize("text", HOSTILE)
def test_text_stays_text(report: Report, grid: Grid, text: str) -> None:
    published = tuple(
        replace(c, published=replace(c.published, reason=text, source=text)) for c in report.comparisons[:1]
    )
    changed = replace(report, title=text, comparisons=published)
    content = xlsx.render(changed, grid)
    book = openpyxl.load_workbook(io.BytesIO(content))
    assert book["report"]["A1"].data_type == "s"
    assert book["published"]["M6"].data_type == "s"
    strings = files(content)["xl/sharedStrings.xml"].decode()
    escaped = text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    assert f">{escaped.replace('_x0041_', '_x005F_x0041_')}<" in strings
    rels = [name for name in files(content) if name.endswith(".rels")]
    assert not any(b"External" in files(content)[name] for name in rels)


def test_a_very_long_text_is_cut(report: Report, grid: Grid) -> None:
    long = replace(report, title="x" * 40_000)
    title = openpyxl.load_workbook(io.BytesIO(xlsx.render(long, grid)))["report"]["A1"].value
    assert len(title) == LONGEST
    assert title.endswith("…")


# --- how it looks ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "digits", "form"),
    [
        ([1.258, 1.371], 4, "0.000"),
        ([41.845, 55.61], 4, "0.00"),
        ([1525.4, 3619.0], 4, "0"),
        ([9.6e8, 2.1e9], 4, "0.000E+00"),
        ([3.2e-6], 3, "0.00E+00"),
        ([8.366], 4, "0.000"),
        ([0.5, "#NOROOT!", None], 3, "0.000"),
        (["#INPUT!"], 4, "General"),
        ([0.0], 4, "General"),
        ([0.8, *[30.0] * 9], 4, "0.00"),
    ],
)
def test_a_column_has_the_number_format_of_its_typical_cell(
    values: list[Any], digits: int, form: str
) -> None:
    assert typical_format(values, digits) == form


def test_an_input_shows_all_that_is_typed() -> None:
    assert open_format(1) == "0.0########"
    assert open_format(3) == "0.000######"
    assert open_format(-2) == open_format(0) == "General"
    # What nine decimals show as 0 has a power of ten; what they show has as many as there is room for.
    assert [open_format(17, 1.008e-14), open_format(12, -2e-12), open_format(10, 3.0e-9)] == [
        "0.000E+00", "0E+00", "0.0E+00",
    ]  # fmt: skip
    assert open_format(12, 0.0) == open_format(12, 0.125) == "0.000000000"


@pytest.mark.parametrize(
    ("latex", "pieces"),
    [
        ("x_{p%s}", [("", "x"), ("_", "p")]),
        (r"\alpha_{\mathrm{lin}}", [("", "α"), ("_", "lin")]),
        (r"\bar{X}", [("", "X̄")]),
        ("C'_{(7)%s}", [("", "C′"), ("_", "(7)")]),
        ("m_1", [("", "m"), ("_", "1")]),
        (r"x_{\mathrm{ref}%s}", [("", "x"), ("_", "ref")]),
        (r"\chi^2", [("", "χ"), ("^", "2")]),
        ("", []),
    ],
)
def test_symbols_are_letters_with_subscripts(latex: str, pieces: list[tuple[str, str]]) -> None:
    assert fragments(with_index(latex)) == pieces


def test_rows_are_as_high_as_their_text() -> None:
    assert height([("short", 20)]) == 15
    assert height([("a word or two more than fit", 10)]) == 45
    assert height([("one\ntwo", 20)]) == 30


def test_a_report_without_anything_to_draw_or_to_compare(report: Report) -> None:
    units: Mapping[str, str] = {name: shown.unit for name, shown in report.shown.items()}
    plain = excel_grid.grid(report.sheet, report.values, units)
    content = xlsx.render(replace(report, comparisons=()), plain)
    names = openpyxl.load_workbook(io.BytesIO(content)).sheetnames
    assert names == ["report", "tests", "pairs", "points", "steps", "uncertainty", "equations"]


LINE = """\
from loopsheet import Method, fit, measured, unknown


class Line(Method):
    x = measured("mm", "abscissa")
    y = measured("V", "ordinate", positive=True)
    a = unknown("a", "V")
    b = unknown("b", "V/mm")
    line = fit(y, a + b * x, u={y: "stated"})
"""


@pytest.mark.parametrize(
    ("stated", "follows"),
    [
        ("u = 3 % of reading", "0.03*ABS("),
        ("u = 3 % of reading; u = 0.02", "SQRT(SUMSQ(0.03*ABS("),
        ("u = 0.02", ""),
        ("u = 60 % of reading, min = 0; u = 5 % of reading", ""),  # where it is cut off it is another one
    ],
)
def test_what_rows_are_weighed_by_follows_them_where_it_is_a_share(
    tmp_path: Path, stated: str, follows: str
) -> None:
    rows = "reading,x [mm],y [V]\n1,1,\n2,2,2.1\n3,3,2.9\n4,4,4.2\n5,5,4.9\n"
    stated = f'[uncertainty]\nx = "exact"\ny = "{stated}"\n'
    report = Study(method_folder(tmp_path, LINE, rows, stated)).computed
    made = openpyxl.load_workbook(io.BytesIO(xlsx.render(report, grid_of(report))))
    (sheet,) = (each for each in made if each.title == "readings")
    heads = next(texts for row in sheet.iter_rows() if "u_y [V]" in (texts := [str(c.value) for c in row]))
    column = heads.index("u_y [V]")
    cells = [str(row[column].value) for row in sheet.iter_rows(min_row=9, max_row=12)]
    assert all((follows in each and each[0] == "=") if follows else each[0] != "=" for each in cells)
    assert ("stay as issued" in str(sheet["A2"].value)) != bool(follows)
