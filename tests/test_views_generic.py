"""A workbook without a narrative of its own: the report says all there is to say, in both formats."""

import re
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import html5lib
import pytest

from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import html, latex

WORKBOOK = """
from sympy import Sum, Symbol

from loopsheet.derivations.equation import Derivation, Equation, Kind, Ledger, Step
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Parameter, Workbook

k = Symbol("k", integer=True, positive=True)
TESTS = Axis("tests", k, Symbol("n_tests", integer=True, positive=True))
U, I = (Column(n, TESTS, Given("measured"), "1", w, l + "%s") for n, w, l in (
    ("volts", "voltage & <current>", "U"), ("amps", "current", "I")))
gain = Column("gain", None, Given("parameter"), meaning="gain of the amplifier", latex="g")
power = Equation("(1)", (Symbol("power", positive=True), U[k] * I[k] * gain.symbol), "definition",
                 Kind.DEFINITION, "power of a test")
total = Equation("(2)", (Symbol("total", positive=True), Sum(U[k], (k, 1, TESTS.size))), "definition",
                 Kind.DEFINITION, "sum of the voltages")
WORKBOOK = Workbook(
    "toy", "A toy: 50 % & more", "Nobody, 2020", lambda: Ledger((power, total)),
    (Measured("volts", "1", "voltage"), Measured("amps", "1", "current")),
    (Parameter("gain", "1", "gain of the amplifier"),),
    lambda given: Sheet((U, I, gain, Column("power", TESTS, Formula(power), meaning="power"),
                         Column("total", None, Formula(total), meaning="total"))),
    headline=("total",),
)
"""


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Report:
    folder = tmp_path_factory.mktemp("toy")
    (folder / "toy.py").write_text(WORKBOOK, encoding="utf-8")
    (folder / "report.toml").write_text(
        'workbook = "toy.py"\n[parameters]\ngain = "2.0"\n[measurements]\nfile = "m.csv"\n', encoding="utf-8"
    )
    rows = "".join(f"{n},{n}.00,0.{n:03}\n" for n in range(1, 36))
    (folder / "m.csv").write_text("test,volts [1],amps [1]\n" + rows, encoding="utf-8")
    return Study(folder).proved


def test_the_page(report: Report) -> None:
    parser = html5lib.HTMLParser(tree=html5lib.getTreeBuilder("etree"))
    tree = parser.parse(html.render(report, {}))
    assert parser.errors == []
    by_id = {element.get("id"): element for element in tree.iter() if element.get("id")}
    assert by_id["cell-volts-3"].get("value") == "3.00"
    # 35 rows get a box of their own to scroll in.
    assert any("tall" in (e.get("class") or "") for e in by_id["table-tests"].iter())
    assert "630" in "".join(by_id["cell-total"].itertext())
    assert {"result", "values", "equations", "derivations", "reproduce", "eq-1", "eq-2"} <= set(by_id)
    assert "published" not in by_id


def test_the_article(report: Report) -> None:
    article = latex.render(report, [])
    assert r"\begin{longtable}" in article
    assert r"A toy: 50 \% \& more" in article
    assert r"voltage \& \textless{}current\textgreater{}" in article


def test_the_article_compiles(report: Report, tmp_path: Path, require: Callable[..., str]) -> None:
    pdflatex = require("pdflatex")
    (tmp_path / "report.tex").write_text(latex.render(report, []), encoding="utf-8")
    for _ in range(3):
        subprocess.run(
            [pdflatex, "-interaction=nonstopmode", "report.tex"],
            cwd=tmp_path,
            capture_output=True,
            check=False,
        )
    log = (tmp_path / "report.log").read_text(encoding="latin-1")
    assert not re.search(r"^!|Overfull|undefined|multiply defined", log, re.MULTILINE)


def test_where_nothing_is_a_result_there_is_no_chapter_of_it(report: Report) -> None:
    chapter = re.compile('id="?result"?[ >]')
    none = replace(report, workbook=replace(report.workbook, headline=()))
    assert chapter.search(html.render(report, {}))
    assert not chapter.search(html.render(none, {}))
