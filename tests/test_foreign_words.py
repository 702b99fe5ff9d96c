"""What is said of the paper stands in its own report: not in a client's, nor in other workbooks'."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import openpyxl
import pytest
from small_report import end_gauge
from test_toy_workbook import FILES

from loopsheet.report import build
from loopsheet.report.cli import main
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import html, live
from loopsheet.report.views.writer import TEMPLATES

SHORT = TEMPLATES / "minified"
DRAWS = (SHORT / "charts.js").read_text(encoding="utf-8")


def folder_of(place: Path, kind: str) -> Path:
    """The end gauge, which has no headline, or the orbit, which has two axes and a root."""
    place.mkdir(exist_ok=True)
    if kind == "gauge":
        return end_gauge(place)
    for name, text in FILES.items():
        (place / name).write_text(text, encoding="utf-8")
    return place


@pytest.fixture(scope="module", params=["gauge", "orbit"])
def other(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """The outputs of another workbook."""
    place = folder_of(tmp_path_factory.mktemp("other") / request.param, request.param)
    build.build(Study(place), place / "out", ("html", "xlsx"))
    return request.param, place / "out"


def test_no_page_tells_or_draws_what_only_the_paper_has(other: tuple[str, Path]) -> None:
    kind, out = other
    page = (out / "report.html").read_text(encoding="utf-8")
    assert re.findall(r"generated|alpha_\w*log|x_m\b|speed|restitution", page) == []
    assert (DRAWS in page) == (kind == "orbit")
    assert "All numbers in full are in" in page
    (data,) = re.findall(r'id="?live-data"?>(.*?)</script>', page, re.DOTALL)
    known, rows = json.loads(data), "readings" if kind == "gauge" else "sightings"
    assert {name: table["row"] for name, table in known["tables"].items()} == {rows: rows.removesuffix("s")}
    assert list(known["figures"]) == (["orbit"] if kind == "orbit" else [])


def test_no_workbook_names_a_cell_that_it_does_not_have(other: tuple[str, Path]) -> None:
    kind, out = other
    book = openpyxl.load_workbook(out / "report.xlsx")
    notes = " ".join(
        str(cell.value) for sheet in book for row in sheet.iter_rows() for cell in row if cell.value
    )
    (example,) = re.findall(r"Names such as (\w+) stand", notes)
    assert example in book.defined_names
    row = "a reading" if kind == "gauge" else "a sighting"
    assert f"to add {row}, build the report again. To leave {row} out, empty one of its cells." in notes


@pytest.fixture
def client(tmp_path: Path) -> Path:
    """The paper's method with other measurements, which somebody else published."""
    folder = shutil.copytree(PAPER, tmp_path / "mine")
    toml = folder / "report.toml"
    toml.write_text(re.sub(r"(?m)^by = .*\n", "", toml.read_text()))
    return folder


def test_the_errata_of_the_paper_are_told_where_it_is_compared_with(report: Report, client: Path) -> None:
    inputs = Study(client).prepared.inputs
    told = [html.render(each, {}) for each in (report, replace(report, inputs=inputs, errata=()))]
    assert len(report.errata) >= 5
    assert ["Errata of equations" in page for page in told] == [True, False]
    assert ["the two averages in the text" in page for page in told] == [True, False]


def test_nor_does_the_terminal_tell_them(client: Path, capsys: pytest.CaptureFixture[str]) -> None:
    told = []
    for folder in ("paper", str(client)):
        assert main(["prove", folder]) == 0
        told.append(capsys.readouterr().out.count("erratum: ") >= 5)
    assert told == [True, False]


def test_who_published_is_the_source_or_not_said(client: Path, capsys: pytest.CaptureFixture[str]) -> None:
    toml = client / "report.toml"
    toml.write_text(toml.read_text().replace("[published]\n", '[published]\nby = "sauce"\n'))
    assert main(["show", "alpha", str(client)]) == 2
    assert "error[LS215]: by is 'sauce'" in capsys.readouterr().err


def test_a_workbook_that_comes_along_has_its_own_errata_told(client: Path) -> None:
    inputs = Study(client).prepared.inputs
    assert not inputs.about_source
    assert replace(inputs, files={"workbook.py": b""}).about_source


def test_only_a_page_with_drawings_has_what_draws() -> None:
    whole, without = (live.script("{}", "", drawings) for drawings in (True, False))
    assert DRAWS in whole
    assert not any((SHORT / name).read_text(encoding="utf-8") in without for name in live.DRAWING)


def test_no_name_stands_outermost_twice_in_the_page() -> None:
    """Its scripts are one function: of two of one name the latter is called by all, and nobody says so."""
    named = re.compile(r"(?m)^(?:const|let|function\*?|class) (\w+)")
    texts = [(TEMPLATES / "live" / name).read_text(encoding="utf-8") for name in live.SCRIPTS]
    names = [name for text in texts for name in named.findall(text)]
    assert len(names) > 200
    assert not {name for name in names if names.count(name) > 1}
