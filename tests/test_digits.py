"""One rule for the digits that are shown: a cell reads alike in page, article, workbook and terminal."""

import io
import math
import random
import re
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Context, Decimal, localcontext
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import html5lib
import openpyxl
import pytest
from small_report import FILES, end_gauge

from loopsheet.report import stages
from loopsheet.report.cells.address import index_text
from loopsheet.report.cells.grid import Grid
from loopsheet.report.cells.values import Status
from loopsheet.report.document.material import Material
from loopsheet.report.document.tables import Tables
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.result import Report
from loopsheet.report.sheet import Given, RepeatAxis
from loopsheet.report.study import Study
from loopsheet.report.verbs.build import summary
from loopsheet.report.views import html, latex
from loopsheet.report.views.live_uncertain import digits
from loopsheet.report.views.xlsx_style import MOST_DECIMALS

TOML = """\
workbook = "soft_impact"
[parameters]
ball_mass = "8.366(40) g"
[measurements]
file = "measurements.csv"
[uncertainty]
v = "0.5 % of reading"
{more}
[uncertainty.shared."height datum"]
of = "x_p"
stated = "+-{datum} um rect"
"""
STATED = """\
test,v [m/s],e [1],u(e) [1],x_p [um]
1,2.2,0.535,0.002,22.58(4)
2,3.1,0.505,0.002,31.92
3,4.3,0.47,0.0005,44.61
4,2.2,0.53,0.003,22.4(1)
5,3.1,0.51,0,32.0
6,4.3,0.468,0.002,44.8
"""


def written(folder: Path, csv: str = STATED, more: str = "", datum: str = "0.2") -> Path:
    (folder / "report.toml").write_text(TOML.format(more=more, datum=datum), encoding="utf-8")
    (folder / "measurements.csv").write_text(csv, encoding="utf-8")
    return folder


def at_random(folder: Path, seed: int) -> Path:
    """A campaign with any digits, and pairs that have no exponent."""
    dice = random.Random(seed)
    rows = ["test,v [m/s],e [1],x_p [um]"]
    for test in range(1, dice.randint(3, 7)):
        v = dice.uniform(1, 6)
        texts = (v, dice.uniform(0.4, 0.6), 10 * v * dice.uniform(0.9, 1.1))
        rows.append(f"{test}," + ",".join(f"{x:.{dice.randint(1, 5)}f}" for x in texts))
    more = dice.choice(("", 'e = "u = 0.02"', 'e = "exact"', "digits = 1"))
    return written(folder, "\n".join(rows) + "\n", more, dice.choice(("0.001", "0.2", "30")))


CAMPAIGNS: dict[str, Callable[[Path], Path]] = {
    "paper": lambda folder: PAPER,
    "stated": written,
    "stated, one digit": lambda folder: written(folder, more="digits = 1"),
    "nothing is certain": lambda folder: written(folder, datum="50"),
    "end gauge": end_gauge,
    **{f"random {seed}": lambda folder, seed=seed: at_random(folder, seed) for seed in range(6)},  # type: ignore[misc]
}


def plain(text: str) -> str:
    """A number for the eye as a program writes it: ``1.019e9``."""
    text = re.sub("\u00a0×\u00a010(.*)", lambda found: "e" + found[1].translate(LOWERED), text)
    return text.replace("\u2212", "-").replace("\u202f", "")


LOWERED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


@dataclass(frozen=True)
class Shown:
    """A report, and what its cells show: by column and index, numbers as programs write them."""

    report: Report

    def cells(self) -> Iterator[tuple[str, str, str]]:
        """All cells of tables that are computed and have a value, as the rule has them."""
        for column in self.report.sheet.columns:
            if isinstance(column.rule, Given) or isinstance(column.axis, RepeatAxis):
                continue
            every = self.report.figures(column.name)
            for label, figure in zip(self.report.values.labels(column), every, strict=True):
                if figure is not None:
                    yield column.name, index_text(label), figure.plain

    @cached_property
    def page(self) -> dict[tuple[str, str], set[str]]:
        found: dict[tuple[str, str], set[str]] = {}
        for element in html5lib.parse(html.render(self.report, {}), namespaceHTMLElements=False).iter():
            name, index, code = (element.get(f"data-{key}") for key in ("cell", "index", "status"))
            if name and element.tag != "input" and code == "ok":
                found.setdefault((name, index or ""), set()).add(plain("".join(element.itertext())))
        return found

    @cached_property
    def book(self) -> tuple[Grid, bytes]:
        return stages.book(self.report)

    @cached_property
    def workbook(self) -> dict[tuple[str, str], str]:
        grid, content = self.book
        book, found = openpyxl.load_workbook(io.BytesIO(content)), {}
        for name in {name for name, _, _ in self.cells()}:
            block = grid[name]
            for row, label in enumerate(self.report.values.labels(self.report.sheet[name])):
                place = block.place
                cell = book[place.worksheet].cell(place.row + row + 1, place.column + 1)
                value = block.values[row]
                if isinstance(value, float):
                    found[name, index_text(label)] = as_a_spreadsheet(value, cell.number_format)
        return found


def as_a_spreadsheet(value: float, form: str) -> str:
    """What a number format shows: ``0.00`` or ``0.00E+00``, or ``0`` where nothing is expected."""
    if ";" in form:
        some, _, form = form.split(";")
        if abs(value) >= 1e-15:
            form = some.partition("]")[2]
    point, scientific, _ = form.partition("E")
    decimals = len(point.partition(".")[2])
    with localcontext(Context(prec=60, rounding=ROUND_HALF_UP)):  # 1.75955 as 0.0000 is 1.7596 in all of them
        text = f"{Decimal(f'{value:.14e}'):.{decimals}{'e' if scientific else 'f'}}"
    return re.sub(r"e([+-])0*(\d)", lambda found: f"e{found[1].strip('+')}{found[2]}", text)


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Shown]:
    """Give `shown(campaign)`, computed once for all tests."""
    return cache(lambda name: Shown(Study(CAMPAIGNS[name](tmp_path_factory.mktemp("folder"))).computed))


@pytest.fixture(params=CAMPAIGNS, scope="module")
def of(request: Any, shown: Callable[[str], Shown]) -> Shown:
    return shown(request.param)


def test_page_and_workbook_show_every_cell_alike(of: Shown) -> None:
    cells = list(of.cells())
    assert cells
    for name, index, text in cells:
        if (name, index) in of.page:  # tables need not have all columns
            assert of.page[name, index] == {text}, (name, index)
        nothing = len(text.partition(".")[2]) > MOST_DECIMALS and not float(
            text
        )  # a spreadsheet has no room for such zeros
        assert of.workbook[name, index] == ("0" if nothing else text), (name, index)
    values = of.report.values
    headline = {name for name in of.report.workbook.headline if values.status[name][0] == Status.OK}
    assert {name for name, _ in of.page} >= headline


def test_the_article_shows_what_the_page_shows(of: Shown) -> None:
    article, material = latex.render(of.report, ()), Material(of.report)
    told = 0
    for spec in material.specs:
        columns = [material.items(name)[1] for name in spec.columns]
        if of.report.sheet[spec.columns[0]].axis is None:
            for (item,) in columns:
                if item.ok and item.printed is None:
                    assert f"& \\num{{{item.figure.plain if item.figure else ''}}} &" in article
                    told += 1
            continue
        for row in zip(*columns, strict=True):
            if all(item.ok and not item.mark for item in row):
                texts = [item.printed or (item.figure.plain if item.figure else "") for item in row]
                assert " & ".join([row[0].index.replace("-", "–"), *texts]) in article
                told += 1
    assert told


def test_the_terminal_shows_what_the_page_shows(of: Shown) -> None:
    lines = summary(of.report)["lines"]
    for name, line in zip(of.report.workbook.headline, lines, strict=False):
        if (name, "") in of.page:
            number = line.removeprefix(f"{name:12} ").split("  ")[0].split(" ")[0]
            assert plain(number) in of.page[name, ""], line
    for name, index, text in of.cells():
        label = tuple(map(int, index.split("-"))) if index else ()
        told = of.report.text(of.report.values.cell(name, label))
        assert plain(told.removesuffix(f" {of.report.shown[name].unit}")) == text


def test_a_column_of_uncertainties_has_no_more_digits_than_any_other(report: Report) -> None:
    shown = {c.name: report.figures(c.name) for c in report.sheet.columns if c.is_u}
    assert {name: figure.plain for name, (figure,) in shown.items() if figure} == {
        "u_alpha_eiv": "0.0031", "u_birge_eiv": "0.013", "u_trend_eiv": "0.026"
    }  # fmt: skip
    assert all(digits(report, report.sheet[name])["kept"] == {"": 2} for name in shown)


def test_units_in_what_a_user_stated_are_those_of_the_head(tmp_path: Path) -> None:
    report = Study(written(tmp_path)).computed
    legend = "".join(map(str, Tables(Material(report)).data["measured"].legend))
    stated = legend.partition("Stated uncertainties")[2]
    assert "Unit(unit='um')" in stated
    assert " um" not in stated


def test_the_key_sets_the_number_of_digits(tmp_path: Path) -> None:
    shown = {}
    for most in (1, 2):
        folder = tmp_path / str(most)
        folder.mkdir()
        report = Study(written(folder, more=f"digits = {most}")).computed
        u = float(report.uncertain().u["alpha_mean"][0])
        figure = report.figures("alpha_mean")[0]
        assert figure is not None
        assert len(report.sure("alpha_mean", u).fraction) == len(figure.fraction)
        shown[most] = len(figure.fraction)
    assert shown[2] == shown[1] + 1


def test_a_given_zero_and_what_is_exact_say_nothing_of_digits(tmp_path: Path) -> None:
    """Parameters of the end gauge are 0: no numbers of one digit. The others have three at least."""
    toml = FILES["report.toml"].replace('"-0.1 K"', '"-0.1000 K"')
    report = Study(end_gauge(tmp_path, report=toml)).computed
    assert [printed.text for printed in report.inputs.printed("cycle")] == ["0"]
    assert report.shown["l"].digits == 4


BOOKS = ("paper", "stated", "nothing is certain")


@pytest.fixture(scope="module")
def pages(
    shown: Callable[[str], Shown], require: Callable[..., str], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """What LibreOffice shows of each of these books, as pages, in one run of the program."""
    folder = tmp_path_factory.mktemp("office")
    books = [folder / f"{name}.xlsx" for name in BOOKS]
    for name, book in zip(BOOKS, books, strict=True):
        book.write_bytes(shown(name).book[1])
    profile = f"-env:UserInstallation=file://{folder}/profile"
    command = [require("soffice", "libreoffice"), profile, "--headless", "--convert-to", "html", "--outdir"]
    subprocess.run([*command, folder, *books], check=True, capture_output=True, timeout=300)
    return folder


@pytest.mark.parametrize("name", BOOKS)
def test_libreoffice_shows_what_the_page_shows(name: str, shown: Callable[[str], Shown], pages: Path) -> None:
    of, grid = shown(name), shown(name).book[0]
    texts: list[tuple[float, str]] = []
    page = html5lib.parse((pages / f"{name}.html").read_bytes(), namespaceHTMLElements=False)
    for cell in page.iter("td"):
        if number := cell.get("sdval"):
            texts.append((float(number), "".join(cell.itertext()).strip()))
    for name, index, text in of.cells():
        label = tuple(map(int, index.split("-"))) if index else ()
        value = grid[name].values[of.report.values.row(of.report.sheet[name], label)]
        assert isinstance(value, float)
        found = (said for number, said in texts if math.isclose(number, value, rel_tol=1e-11))
        told = {re.sub(r"E\+?(-?)0*(\d)", r"e\1\2", said) for said in found}
        assert text in told, (name, index)
