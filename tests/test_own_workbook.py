"""A user's own workbook: what runs is what was read, only where one asked for it; its mistakes are told."""

from __future__ import annotations

import importlib.util
import os
import py_compile
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from small_report import SOURCE, end_gauge
from test_pytest_plugin import run

from loopsheet.report import build
from loopsheet.report.cli import main
from loopsheet.report.inputs.inputs import load
from loopsheet.report.messages.errors import InputError
from loopsheet.report.study import Study
from loopsheet.report.verification import verify
from loopsheet.report.which_workbook import find_workbook

RAN = "from pathlib import Path\nPath(__file__).with_name('ran').touch()\n"
"""Leaves a file beside the workbook."""


@pytest.fixture
def folder(tmp_path: Path, chdir: Callable[[Path], None]) -> Path:
    """A report folder with a workbook of its own, as a user in the folder above it would name it."""
    chdir(tmp_path)
    Path("gauge").mkdir()
    return end_gauge(Path("gauge"))


def own(folder: Path, code: str) -> None:
    (folder / "workbook.py").write_text(code, encoding="utf-8")


def changed(old: str, new: str) -> str:
    assert old in SOURCE
    return SOURCE.replace(old, new)


def shows(field: str) -> str:
    return changed("    sheet=", f"    {field},\n    sheet=").replace(
        "import Meas", "import FigureSpec, Meas"
    )


UNIT = '"m", "length'
SHEET = "Sheet((d, *given.values(), l))"


@pytest.mark.parametrize(
    ("code", "line", "said"),
    [
        ("\nWORKBOOK = 1 / 0", "WORKBOOK", "ZeroDivisionError: division by zero"),
        ("\ndef (", "def", "SyntaxError: "),
        ("x = '\0'", "", "SyntaxError: "),
        ("if True:\n    lambda = 2", "lambda", "'lambda' is a word of Python: call it lambda_, with latex"),
        ("x = 2 \u2212 1", "x = 2", "write the minus sign as an ordinary hyphen"),
        ("\n\nraise SystemExit(0)", "raise", "SystemExit: 0"),
        ("import sys\nsys.exit()", "sys.exit", "cannot be used: SystemExit\n"),
        ("raise BaseException", "raise", "cannot be used: BaseException\n"),
        ("WORKBOOK = 7", "", "WORKBOOK is no Workbook"),
        ("", "", "it declares no WORKBOOK and no class of Method\n"),
        (changed("Ledger((eq,))", "exit(0)"), "exit(0)", "SystemExit: 0"),
        (changed("Ledger((eq,))", "eq"), "", "what ledger() returns is no Ledger"),
        (changed("Ledger((eq,))", "Ledger((eq,), (lambda own: exit(1),))"), "exit(1)", "SystemExit: 1"),
        (changed(SHEET, "1 / 0"), "1 / 0", "ZeroDivisionError"),
        (changed(SHEET, "None"), "", "what sheet() returns is no Sheet"),
        (changed("Ledger((eq,))", "Ledger(())"), "", "l is computed from (H.1) l = "),
        (
            changed("Formula(eq)", "Formula(Equation('(H.1)', (Symbol('l'), l_S), '', Kind.DEFINITION))"),
            "",
            "l is computed from (H.1) l = l_S, which the ledger does not have: add it there",
        ),
        (changed(UNIT, '"Pa m^61", "length'), '"Pa m^61"', "l: 'Pa m^61' cannot be read: no unit '^61'"),
        (
            changed(UNIT, '"mm", "length'),
            '"mm", "length',
            "l: 'mm' is no unit of SI without prefix, such as m",
        ),
        (changed(UNIT, '"m^2", "length'), 'Column("l"', "l (H.1): the unit is m^2, but the formula"),
        (changed('"d", "m", "diff', '"d", "furlongg", "diff'), '"furlongg"', "cannot be read at 'furlongg'"),
        (shows('headline=("L",)'), '"L"', "there is no cell 'L', which headline names; there is l_S, "),
        (shows('headline=("l",)'), '"l",)', "'l' has many rows, and headline names single numbers"),
        (shows('headline="l_S"'), "headline", "headline is no tuple of names in quotes; one alone"),
        (shows('fits=("l_S", "l_s", "theta")'), '"l_s"', "there is no cell 'l_s', which fits names; did you"),
        (shows('fits=("l_S",)'), "fits", "fits names the mean and two fits, or nothing"),
        (
            shows('prose="../own"'),
            '"../own"',
            "there is no text '../own', which prose names; there is contact_models, ",
        ),
        (shows("prose=None"), "prose", "prose is no text in quotes"),
        (
            shows('prose="soft_impact"'),
            '"soft_impact"',
            "the text 'soft_impact' tells of (10a), (10c), (11), (12a), (12e), (2), (3), (4), ",
        ),
        (
            shows('figures=(FigureSpec("f", "1", "", "loop"),)'),
            '"loop"',
            "no drawing 'loop', which figures names; there is referee",
        ),
        (
            shows('figures=(FigureSpec("f", "1", "", "own"),), drawings=lambda: {"my": print}'),
            '"own"',
            "no drawing 'own', which figures names; there is",
        ),
        (
            shows('figures=(FigureSpec("f", "1", "", "own"),), drawings=lambda: 1 / 0'),
            "1 / 0",
            "ZeroDivision",
        ),
        (
            shows('figures=(FigureSpec("f", "1", "", "own"),), drawings=lambda: 7'),
            "",
            "what drawings() returns is no Mapping",
        ),
        (
            shows('figures=(FigureSpec("../f", "1", "", "loops"),)'),
            '"../f"',
            "cannot be the name of a figure",
        ),
        (shows("tables=7"), "tables", "tables is no tuple of TableSpec"),
        (shows("published_as=7"), "published_as", "published_as is no dict of titles"),
        (changed("    sheet=", "    check_parameters=lambda x: 1 / 0,\n    sheet="), "1 / 0", "ZeroDivision"),
        (changed("    sheet=", "    drawn=lambda *_: exit(),\n    sheet="), "exit()", "SystemExit"),
    ],
)
def test_what_it_raises_is_told_with_folder_and_line(
    code: str, line: str, said: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own(folder, code)
    assert main(["check", "gauge"]) == 2
    told = capsys.readouterr().err
    assert "LS213" in told
    assert said in told
    number = code[: code.index(line)].count("\n") + 1
    assert f"--> gauge/workbook.py{f':{number}:' if line else ''}" in told


DRAWS = """
def draw(report):
    from matplotlib.figure import Figure
    figure = Figure()
    figure.add_subplot().set_title(f"{len(report.values.value['l'])} lengths")
    return figure
"""
OWN = 'figures=(FigureSpec("f", "1", "A figure of one’s own.", "own"),), drawings=lambda: {"own": draw}'


def test_it_draws_its_own_figures(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    own(folder, shows(OWN).replace("WORKBOOK =", f"{DRAWS}\nWORKBOOK ="))
    assert main(["build", "gauge", "--to", "html,latex"]) == 0
    assert "2 lengths" in (folder / "out" / "report.html").read_text(encoding="utf-8")
    assert (folder / "out" / "figures" / "f.pdf").is_file()


def test_a_drawing_that_fails_is_told_with_its_line(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code = shows(OWN).replace("WORKBOOK =", f"{DRAWS.replace('Figure()', '1 / 0')}\nWORKBOOK =")
    own(folder, code)
    assert main(["build", "gauge", "--to", "html"]) == 2
    told = capsys.readouterr().err
    assert "ZeroDivisionError" in told
    assert f"--> gauge/workbook.py:{code[: code.index('1 / 0')].count(chr(10)) + 1}:" in told


@pytest.mark.parametrize(
    ("verb", "cell", "said"),
    [
        ("why", "d[1]", ["d[1] = 215 nm  difference", "given     as 215 nm, d.csv:2:3"]),
        ("why", "l[1]", ["rests on  d[1] = 215 nm, l_S = 50.000623 mm,"]),
        (
            "show",
            "d",
            ["d  difference  [nm]", "d[1]             215  u 0.29\n", "d[2]             204  u 0.29\n"],
        ),
        ("show", "l_S", ["[mm]", "l_S              50.000623"]),
    ],
)
def test_a_given_number_stands_with_the_unit_it_was_given_in(
    verb: str, cell: str, said: list[str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The workbook says metres and nothing of how its columns are to be shown."""
    assert main([verb, cell, folder.name]) == 0
    out = capsys.readouterr().out
    assert [words for words in said if words not in out] == [], out


def test_the_bytes_that_were_read_are_run_and_nothing_else(folder: Path) -> None:
    """No cache that somebody planted, nor what the file holds by then; and no cache is left."""
    own(folder, RAN)
    file = folder / "workbook.py"
    cache = Path(importlib.util.cache_from_source(str(file)))
    py_compile.compile(str(file), str(cache))
    found = file.stat()
    file.write_text(SOURCE)
    held = file.read_bytes()
    os.utime(file, ns=(found.st_atime_ns, found.st_mtime_ns))
    planted = cache.read_bytes()
    cache.write_bytes(planted[:12] + len(held).to_bytes(4, "little") + planted[16:])

    def swapped(name: str, place: Path, code: bytes | None) -> object:
        own(place, RAN)
        return find_workbook(name, place, code)

    assert Study(folder).prepared.inputs.workbook.name == "end_gauge"
    inputs = load(folder, swapped)
    assert inputs.workbook.name == "end_gauge"
    assert inputs.files["workbook.py"] == held
    assert not (folder / "ran").exists()
    own(folder, SOURCE)
    cache.unlink()
    cache.parent.rmdir()
    assert Study(folder).prepared
    assert not cache.parent.exists()


def test_verify_runs_it_if_it_is_told_to(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    own(folder, SOURCE + RAN)
    build.build(Study(folder), folder / "out", ("json",))
    (folder / "ran").unlink()
    for given in (None, folder):
        with pytest.raises(InputError) as refused:
            verify(folder / "out", given)
        (finding,) = refused.value.diagnostics
        assert (finding.code, str(finding.at)) == ("LS214", "gauge/report.toml:1:12")
    assert not (folder / "ran").exists()
    assert main(["verify", "gauge/out"]) == 2
    assert "--run-workbook" in capsys.readouterr().err
    assert main(["verify", "gauge/out", "--run-workbook"]) == 0
    assert (folder / "ran").exists()


def test_pytest_runs_it_if_it_is_told_to(folder: Path) -> None:
    own(folder, SOURCE + RAN)
    Path("pytest.ini").write_text("[pytest]\n")
    Path("test_other.py").write_text("def test_other():\n    pass\n")
    done = run(Path.cwd())  # the reason is told even so
    assert done.returncode == 0, done.stdout
    assert "1 passed, 1 skipped" in done.stdout
    assert "is code that came with the folder" in done.stdout
    assert "--loopsheet-run-workbook" in done.stdout
    Path("pytest.ini").write_text("[pytest]\nloopsheet_run_workbook = true\n")
    done = run(Path.cwd(), "-m", "not loopsheet")
    assert "1 passed, 1 deselected" in done.stdout
    assert not (folder / "ran").exists()
    done = run(Path.cwd(), "-k", "published or other", "-m", "loopsheet or not loopsheet")
    assert done.returncode == 0, done.stdout
    assert "2 passed" in done.stdout
    assert (folder / "ran").exists()


def test_one_that_asks_to_end_the_program_ends_no_run_of_pytest(folder: Path) -> None:
    own(folder, "raise SystemExit(0)\n")
    Path("pytest.ini").write_text("[pytest]\n")
    Path("test_other.py").write_text("def test_other():\n    pass\n")
    done = run(Path.cwd(), "--loopsheet-run-workbook", "--continue-on-collection-errors")
    assert done.returncode == 1
    assert "gauge/workbook.py:1:1" in done.stdout
    assert "1 passed, 1 error" in done.stdout


def test_a_module_in_the_folder_where_one_stands_is_not_taken_for_a_library(folder: Path) -> None:
    (folder / "sympy.py").write_text(RAN)
    command = [sys.executable, "-m", "loopsheet", "show", "l[1]", "."]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert not (folder / "ran").exists()
