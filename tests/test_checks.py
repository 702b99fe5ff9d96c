"""What was checked, in every format: counted, located, and nothing that a user wrote does anything."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest
from helpers import method_folder
from small_report import end_gauge

from loopsheet.report.inputs.inputs import Inputs
from loopsheet.report.messages.diagnostics import Check, Diagnostic, Location
from loopsheet.report.result.agreement import Agreement
from loopsheet.report.result.findings import checks, of_diagnostics, of_engine
from loopsheet.report.study import Study
from loopsheet.report.views.checks import FORMATS, as_github, as_json, as_junit, as_markdown, summary
from loopsheet.report.views.markdown import cell, code

EVIL = "a|b `c` <b> &amp; @you #1 % \n::error::x, y: z \x1b[2J \u202e ]]> \"'"
CHECKS = (
    Check("proof", "(1)", True, "(1) is proved", Location("f/report.toml")),
    Check("engine", "node", True, "not compared", Location("f/report.toml"), skipped=True),
    Check("published", "alpha[1-2]", False, "prints 1, recomputed 2", Location("f/p.csv", 2, 19, 5, "x")),
    Check("published", EVIL, False, EVIL, Location(EVIL, 3)),
)


def test_summary_counts() -> None:
    assert summary(CHECKS) == "4 checks: 1 as expected, 2 findings, 1 not checked"
    assert summary(CHECKS[:1]) == "1 check: 1 as expected, 0 findings"
    assert summary(()) == "0 checks: 0 as expected, 0 findings"


@pytest.mark.parametrize("form", FORMATS)
def test_without_checks_every_format_is_whole(form: str) -> None:
    assert FORMATS[form]((), "t", {}).endswith("\n")


def test_json() -> None:
    data = json.loads(as_json(CHECKS, "t", {"engines": [1]}))
    assert data["passed"] is False
    assert data["findings"][0] == "f/p.csv:2:19: prints 1, recomputed 2"
    assert data["engines"] == [1]
    assert data["checks"][0] == {
        "kind": "proof",
        "name": "(1)",
        "passed": True,
        "skipped": False,
        "note": None,
        "message": "(1) is proved",
        "file": "f/report.toml",
        "line": None,
        "column": None,
    }
    assert data["checks"][3]["message"] == EVIL


def test_junit() -> None:
    root = ElementTree.fromstring(as_junit(CHECKS, EVIL, {}))
    assert {k: root.get(k) for k in ("tests", "failures", "errors", "skipped")} == {
        "tests": "4",
        "failures": "2",
        "errors": "0",
        "skipped": "1",
    }
    assert [suite.get("tests") for suite in root] == ["1", "1", "2"]
    cases = list(root.iter("testcase"))
    assert [c.get("classname") for c in cases] == [f"loopsheet.{check.kind}" for check in CHECKS]
    assert [[child.tag for child in case] for case in cases] == [[], ["skipped"], ["failure"], ["failure"]]
    assert cases[2][0].text == "f/p.csv:2:19: prints 1, recomputed 2"
    assert cases[2].get("line") == "2"


def test_github() -> None:
    lines = as_github(CHECKS, "t", {}).splitlines()
    assert lines[0] == "::notice file=f/report.toml,title=engine node::not compared"
    assert lines[1] == (
        "::error file=f/p.csv,line=2,col=19,endColumn=24,title=published alpha[1-2]::prints 1, recomputed 2"
    )
    properties, _, message = lines[2].removeprefix("::error ").partition("::")
    assert properties.count(",") == 2
    assert properties.count(":") == 0
    assert "%25" in message
    assert "\x1b" not in message
    assert lines[3:] == [summary(CHECKS)]


def test_github_names_files_from_where_the_command_runs(
    tmp_path: Path, chdir: Callable[[Path], None]
) -> None:
    chdir(tmp_path)
    inside, outside = (tmp_path / "f" / "p.csv").as_posix(), "/elsewhere/p.csv"
    found = [Check("published", "x", False, "m", Location(path, 1, 1)) for path in (inside, outside)]
    lines = as_github(found, "t", {}).splitlines()
    assert "file=f/p.csv," in lines[0]
    assert "file=/elsewhere/p.csv," in lines[1]


def test_markdown() -> None:
    text = as_markdown(CHECKS, "t", {})
    assert "| published | 0 | 2 | 0 | 0 |" in text
    assert "| finding | `published alpha[1-2]` | `f/p.csv:2:19` | prints 1, recomputed 2 |" in text
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert len(rows) == 2 + 3 + 2 + 2
    assert all(row.replace("\\|", "").count("|") == 5 + (n < 5) for n, row in enumerate(rows))
    assert "finding" not in as_markdown(CHECKS[:1], "t", {}).partition("\n| ")[2].partition("proof")[2]


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("plain", "plain"),
        ("[x](javascript:1)", "\\[x\\](javascript:1)"),
        ("<img>", "\\<img\\>"),
        ("&lt;", "&amp;lt;"),
        ("@you", "@<!-- -->you"),
        ("a\nb|c", "a b\\|c"),
        ("\\|", "\\\\\\|"),
    ],
)
def test_text_in_markdown_says_what_it_says(text: str, shown: str) -> None:
    assert cell(text) == shown


@pytest.mark.parametrize(
    ("text", "shown"), [("x", "`x`"), ("", ""), ("`", "`` ` ``"), ("a``b|", "```a``b\\|```")]
)
def test_code_in_markdown(text: str, shown: str) -> None:
    assert code(text) == shown


def test_of_many_wrong_cells_some_are_named() -> None:
    inputs = Inputs(Path("f"), "", None, {}, frozenset(), (), (), {})  # type: ignore[arg-type]
    wrong = Agreement(9, 1.0, "x", tuple(f"x[{n}]: off" for n in range(9)), engine="node")
    check = of_engine(wrong, inputs)
    assert not check.passed
    assert check.message == "x[0]: off; x[1]: off; x[2]: off; x[3]: off; x[4]: off; and 4 more"
    assert check.sentence == check.message
    missing = of_engine(Agreement(0, 0.0, "", (), engine="JavaScript", missing="node"), inputs)
    assert (missing.passed, missing.skipped) == (True, True)
    assert missing.message == "JavaScript was not compared: node not found"


def test_how_engines_agree_in_a_line_and_for_machines() -> None:
    least = Agreement(7, 0.0, "", ())
    assert least.line == "numpy       7 cells, at most 0 eps x condition"
    assert least.data == {
        "engine": "numpy",
        "program": None,
        "missing": None,
        "cells": 7,
        "of": 7,
        "sample": None,
        "unbounded": 0,
        "eps_condition": 0.0,
        "eps_condition_cell": None,
        "limit": 8.0,
        "relative": 0.0,
        "relative_cell": None,
        "findings": [],
    }
    most = Agreement(7, 2e-15, "x[1]", ("x[2]: off",), 3.14, "x[2]", "JavaScript", "node 20", unbounded=2)
    assert most.line == (
        "JavaScript  7 cells, at most 3.1 eps x condition (x[2]), 2 without a condition, node 20"
    )
    assert most.summary == "JavaScript agrees with 50 digits on 7 cells within 2.0e-15 (x[1])"
    assert most.data == {
        **least.data,
        "engine": "JavaScript",
        "program": "node 20",
        "unbounded": 2,
        "eps_condition": 3.14,
        "eps_condition_cell": "x[2]",
        "relative": 2e-15,
        "relative_cell": "x[1]",
        "findings": ["x[2]: off"],
    }
    missing = Agreement(0, 0.0, "", (), engine="xlsx", missing="LibreOffice")
    assert missing.line == "xlsx        LibreOffice not found"
    assert missing.data["missing"] == "LibreOffice"
    assert Agreement(0, 0.0, "", ("it failed",), engine="xlsx", program="Calc").line == (
        "xlsx        failed, Calc"
    )


def test_wrong_input_as_checks() -> None:
    (check,) = of_diagnostics([Diagnostic("LS401", "no number", Location("f", 1, 2), "digits", "try")])
    assert (check.kind, check.name, check.passed) == ("input", "LS401", False)
    assert check.sentence == "f:1:2: no number; try"


@pytest.mark.parametrize(
    ("published", "times"),
    [
        ("50000.838,mm", ", about 1000 times as small, perhaps by a unit or a decimal point ("),
        ("50.000838,um", ", about 1000 times as large, perhaps by a unit or a decimal point ("),
        ("5.01,mm", ", about 10 times as large, perhaps"),
        ("51,mm", ""),
        ("50.000839,mm", ""),
        ("-50000,mm", ""),
        ("0.0,mm", ""),
        ("5.0e-200,um", ", about 1e204 times as large, "),
    ],
)
def test_what_is_off_by_a_power_of_ten_is_told_so(tmp_path: Path, published: str, times: str) -> None:
    folder = end_gauge(tmp_path, f"source,cell,index,value,unit\nH.1,l,1,{published}\n")
    (said,) = (c.message for c in checks(Study(folder).computed) if c.kind == "published")
    assert said.startswith(f"H.1 l[1] prints {published.partition(',')[0]}, recomputed ")
    assert times in said
    assert (" times as " in said) == bool(times)


@pytest.mark.parametrize(
    ("published", "hint"),
    [
        ("21.50,K", ", perhaps printed in K for degC, or the reverse ("),
        ("294.65,degC", ", perhaps printed in K for degC, or the reverse ("),
        ("21.60,degC", "recomputed 21.50 ("),
        ("290.00,K", "recomputed 294.65 ("),
        ("29.465,K", ", about 10 times as large, perhaps"),
    ],
)
def test_a_temperature_in_the_other_unit_is_told_so(tmp_path: Path, published: str, hint: str) -> None:
    code = "from loopsheet import Method, let, mean, measured\n\n\nclass Bath(Method):\n"
    code += '    T = measured("degC", "bath")\n    T_m = let(mean(T), "its mean", "degC")\n'
    printed = f"source,cell,index,value,unit\nA,T_m,,{published}\n"
    method_folder(tmp_path, code, "T [degC]\n21.4\n21.6\n", published=printed)
    (said,) = (c.message for c in checks(Study(tmp_path).computed) if c.kind == "published")
    assert hint in said
