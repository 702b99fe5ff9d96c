"""Building: what is written, that it is the same bytes everywhere, that nothing is lost or half-written."""

from __future__ import annotations

import json
import os
import pickle
import re
import shutil
import subprocess
import sys
from argparse import Namespace
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from made_files import hashes

from loopsheet.report import build, cost
from loopsheet.report.cli import main
from loopsheet.report.engines import excel_grid
from loopsheet.report.files.manifest import read_manifest
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.machine.background import LateArgument
from loopsheet.report.machine.kept import SETTING
from loopsheet.report.machine.staging import put, strangers
from loopsheet.report.messages.errors import InputError, OutputError, UsageError
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.verbs.build import out_of, summary

pytestmark = pytest.mark.usefixtures("keeping")  # what is patched here makes nothing that is kept


def copy_paper(folder: Path) -> Path:
    """A folder of one's own, a copy of the shipped one."""
    shutil.copytree(PAPER, folder)
    return folder


def test_default_outputs(issued: Path) -> None:
    files = [p for p in (issued / "out").rglob("*") if p.is_file()]
    names = {p.relative_to(issued / "out").as_posix() for p in files}
    assert {"report.html", "report.tex", "report.xlsx", "values.json", "manifest.json"} <= names
    assert {n for n in names if n.startswith("figures/")} >= {"figures/loops.svg", "figures/loops.pdf"}
    assert all(p.stat().st_size for p in files)


def test_the_page_gets_the_program_of_sheet_and_curves(issued: Path) -> None:
    page = (issued / "out" / "report.html").read_text()
    assert "evaluateSheet" in page
    assert "unloading_F" in page
    assert len(page.encode()) <= 420_000


def test_a_formula_that_no_cell_takes_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Excel opens no file that has one; all else is made where nobody asked for the workbook."""
    (tmp_path / "workbook.py").write_text(
        "from sympy import Add, sin\n\nfrom loopsheet import Method, given, let\n\n\n"
        "def sines(x):\n    return Add(*(sin(n * x) for n in range(1, 701)))\n\n\nclass Long(Method):\n"
        '    """Many terms."""\n\n    x = given("1", "a number")\n'
        '    y = let(sines(x), "their sum", "1")\n'
    )
    (tmp_path / "report.toml").write_text('workbook = "workbook.py"\n[parameters]\nx = "0.25"\n')
    with pytest.raises(UsageError) as refused:
        build.build(Study(tmp_path), tmp_path / "out", ("xlsx",))
    (finding,) = refused.value.diagnostics
    assert finding.code == "LS606"
    assert re.search(r"y has a formula of \d{5} characters, which no cell takes", finding.message)
    build.build(Study(tmp_path), tmp_path / "out", ("html",))
    told: list[str] = []
    _, files = build.build(Study(tmp_path), tmp_path / "all", tell=told.append)
    assert {"report.html", "report.tex", "values.json"} <= {p.name for p in files}
    assert "report.xlsx" not in {p.name for p in files}
    assert any(said.startswith("report.xlsx cannot be made: y has a formula") for said in told)
    assert main(["check", str(tmp_path)]) == 0
    assert re.search(r"\nengine +xlsx +report.xlsx cannot be made: y has a formula", capsys.readouterr().out)


def test_too_many_rows_for_a_worksheet_are_refused_before_anything_is_written(tmp_path: Path) -> None:
    folder = copy_paper(tmp_path / "in")
    toml = folder / "report.toml"
    toml.write_text(toml.read_text().replace("[measurements]", 'points_per_pair = "10000"\n[measurements]'))
    table = folder / "measurements.csv"
    more = "".join(f"{n},{n}.1,0.{500 - 10 * n},{9 * n}.3\n" for n in (6, 7))
    table.write_text(table.read_text() + more)
    with pytest.raises(UsageError) as refused:
        build.build(Study(folder), tmp_path / "out", ("json", "xlsx"))
    (finding,) = refused.value.diagnostics
    assert finding.code == "LS606"
    assert "points has 210000 rows" in finding.message
    assert not (tmp_path / "out").exists()


def test_a_workbook_that_nobody_asked_for_is_left_out_where_it_would_be_too_large(
    issued: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, unjudged: None
) -> None:
    monkeypatch.setattr(excel_grid, "MOST_ROWS", 499)
    told: list[str] = []
    _, files = build.build(Study(issued), tmp_path / "out", tell=told.append)
    assert {"report.html", "report.tex", "values.json", "manifest.json"} == {
        p.name for p in files if p.suffix in {".html", ".tex", ".json", ".xlsx"}
    }
    assert told[1].startswith(
        "report.xlsx cannot be made: points has 500 rows; at most 499 rows in a worksheet"
    )


def test_what_a_long_build_takes_is_told_before_it_begins(
    issued: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, unjudged: None
) -> None:
    """By what there is to compute, the same on every machine."""
    prepared = Study(issued).prepared
    formats = ("html", "json")
    assert cost.told(prepared.sheet, prepared.layouts, formats) == ""
    counts = {name: replace(layout, size=500 * layout.size) for name, layout in prepared.layouts.items()}
    long = cost.told(prepared.sheet, counts, formats)
    assert long.startswith("2500 tests, 5000 pairs, 250000 points: this takes about 11 s")
    assert "about 55 s" in cost.told(prepared.sheet, counts, (*formats, "xlsx"))
    told: list[str] = []

    def step(begun: str) -> None:
        told.append(begun)

    monkeypatch.setattr(cost, "LONG", 0.0)
    build.build(Study(issued, step=step), tmp_path / "out", formats, tell=step)
    line = "5 tests, 10 pairs, 500 points: this takes about 6 s, without what the referee needs"
    assert told.index(line) < next(
        n for n, said in enumerate(told) if re.fullmatch("computing [0-9]+ cells", said)
    )


def test_the_referee_says_the_same_of_values_that_it_is_told(paper: Report) -> None:
    plain = LateArgument[tuple[Any, ...]]()
    plain.told.append(pickle.loads(pickle.dumps(paper.values.plain)))
    found = build._refereed(Study(PAPER).recipe, plain)
    assert found == (paper.referee, paper.comparisons)


@pytest.mark.usefixtures("unjudged", "beside")
def test_proofs_from_a_process_of_their_own_are_of_the_ledgers_own_equations(
    report: Report, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Study, "are_proved", lambda _: False)  # where they are, no process is begun
    built, _ = build.build(Study(PAPER), tmp_path / "out", ("json",))
    assert (built.proofs, built.errata) == (report.proofs, report.errata)
    assert any(proof.remark for proof in built.proofs)
    for proof, entry in zip(built.proofs, built.ledger.entries, strict=True):
        assert proof.equation is getattr(entry, "claim", entry)
        assert [found.step for found in proof.steps] == list(getattr(entry, "steps", ()))


def test_outputs_name_no_place_of_the_machine(issued: Path) -> None:
    for path in (issued / "out").rglob("*"):
        if path.is_file():
            assert str(issued.parent).encode() not in path.read_bytes(), path


@pytest.mark.usefixtures("unjudged")
def test_manifest_names_every_output_by_its_content(tmp_path: Path) -> None:
    _, files = build.build(Study(PAPER), tmp_path / "out", ("json",))
    assert files == [tmp_path / "out" / name for name in ("manifest.json", "values.json")]
    manifest = json.loads((tmp_path / "out" / "manifest.json").read_text())
    assert manifest["outputs"] == {"values.json": hashes(tmp_path / "out")["values.json"]}
    assert set(manifest["inputs"]) == {"report.toml", "measurements.csv", "published.csv"}
    assert manifest["inputs"] == hashes(PAPER)
    assert manifest["versions"]["loopsheet"]


def test_other_files_in_the_output_folder_stay(tmp_path: Path, gauge: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "notes.txt").write_text("mine")
    build.build(Study(gauge), out, ("json",))
    assert (out / "notes.txt").read_text() == "mine"
    assert sorted(p.name for p in out.iterdir()) == ["manifest.json", "notes.txt", "values.json"]


FOREIGN = {
    "nothing": ({}, True),
    "what is hidden": ({".gitkeep": ""}, True),
    "notes": ({"notes.txt": "mine"}, False),
    "a manifest of something else": ({"manifest.json": '{"name": "a page"}', "a.png": ""}, False),
    "a damaged manifest": ({"manifest.json": '<<<<<<< {"versions": {"loopsheet": "0"}}', "a.txt": ""}, True),
    "what a killed build left": ({".loopsheet-abcdefgh/manifest.json": "", "report.html": ""}, True),
}


@pytest.mark.parametrize("case", FOREIGN)
def test_a_folder_of_something_else_is_no_output(case: str, tmp_path: Path) -> None:
    files, ours = FOREIGN[case]
    (tmp_path / "out").mkdir()
    for name, text in files.items():
        put(tmp_path / "out" / name, text)
    assert (strangers(tmp_path / "out") == []) == ours
    assert strangers(tmp_path / "none") == []


@pytest.mark.parametrize("verb", ["build", "watch"])
def test_nothing_is_written_among_the_files_of_somebody(
    verb: str, tmp_path: Path, gauge: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    put(tmp_path / "mine" / "notes.txt", "mine")
    assert main([verb, str(gauge), "--out", str(tmp_path / "mine")]) == 2
    assert "holds what no build has written: notes.txt" in capsys.readouterr().err
    assert [path.name for path in (tmp_path / "mine").iterdir()] == ["notes.txt"]


@pytest.mark.parametrize("link", ["out", "out/figures"])
def test_nothing_is_written_or_removed_where_a_link_leads(
    link: str, tmp_path: Path, gauge: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["build", str(gauge), "--to", "html,latex"]) == 0
    elsewhere = tmp_path / "elsewhere"
    (gauge / link).rename(elsewhere)
    (gauge / link).symlink_to(elsewhere)
    toml, before = gauge / "report.toml", hashes(elsewhere)
    toml.write_text(toml.read_text().replace("0.1 K", "0.2 K"))
    assert main(["build", str(gauge), "--to", "html,latex"]) == 2
    assert "cannot be written: it is a link to " in capsys.readouterr().err
    assert main(["build", str(gauge), "--to", "json"]) == (2 if link == "out" else 0)  # no figure any more
    assert hashes(elsewhere) == before
    (gauge / link).unlink()
    (tmp_path / "link").symlink_to(elsewhere)
    named = ["build", str(gauge), "--to", "json", "--out", str(tmp_path / "link")]
    assert main(named) == (
        0 if link == "out" else 2
    )  # what is named may be one, but not to somebody's figures
    capsys.readouterr()
    elsewhere.rename(tmp_path / "gone")
    assert main(named) == 2
    assert "cannot be written: it is a link to " in capsys.readouterr().err


def test_a_build_without_its_manifest_is_told_how_to_go_on(
    gauge: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["build", str(gauge), "--to", "json"]) == 0
    (gauge / "out" / "manifest.json").unlink()
    assert main(["build", str(gauge), "--to", "json"]) == 2
    assert "or delete it if a build lost its manifest.json" in capsys.readouterr().err


def test_a_report_folder_may_hold_its_report(tmp_path: Path, gauge: Path) -> None:
    own = shutil.copytree(gauge, tmp_path / "own", ignore=lambda *_: ["out"])
    assert out_of(Namespace(out=str(own)), own) == own


def test_what_is_of_the_same_inputs_stays(
    tmp_path: Path, gauge: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def outputs() -> set[str]:
        there = {*hashes(out)} - {"manifest.json"}
        assert there == {*read_manifest(out).outputs}  # all that lies there is marked
        return {name for name in there if "/" not in name}

    def again(*formats: str) -> list[str]:
        told: list[str] = []
        build.build(Study(gauge), out, formats, tell=told.append)
        return told[1:]

    out, whole = tmp_path / "out", {"report.html", "report.tex", "values.json"}
    again("html", "latex", "json")
    before = hashes(out)
    assert again("json") == []
    assert hashes(out) == before
    (out / "report.tex").write_text("edited")
    assert again("html")[0] == "report.tex was not as built: it is kept as report.edited.tex"
    (out / "report.edited.tex").unlink()
    assert outputs() == whole - {"report.tex"}
    again("latex")
    assert hashes(out) == before
    with monkeypatch.context() as patch:
        sums = build.sources()
        patch.setattr(build, "sources", lambda: sums | {"program": "0"})
        again("html", "json")
        assert outputs() == whole - {"report.tex"}
    again("html", "latex", "json")
    toml = gauge / "report.toml"
    toml.write_text(toml.read_text().replace("0.1 K", "0.2 K"))
    assert again("html")[-1].endswith("report.tex, values.json: removed, as of the report before")
    assert outputs() == {"report.html"}


def test_a_failure_while_writing_leaves_everything_as_it_was(
    tmp_path: Path, gauge: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from loopsheet.report.views import json as view

    out = tmp_path / "out"
    build.build(Study(gauge), out, ("json",))
    before = hashes(out)

    def breaks(*_: object) -> str:
        raise RuntimeError("while writing")

    monkeypatch.setattr(view, "manifest", breaks)
    with pytest.raises(RuntimeError, match="while writing"):
        build.build(Study(gauge), out, ("json",))
    assert hashes(out) == before
    with pytest.raises(RuntimeError, match="while writing"):
        build.build(Study(gauge), tmp_path / "fresh" / "deep", ("json",))
    assert not (tmp_path / "fresh").exists()


def test_an_output_that_cannot_be_written_is_refused_before_any_work(tmp_path: Path) -> None:
    taken = tmp_path / "taken"
    taken.write_text("a file")
    with pytest.raises(OutputError, match="LS602"):
        build.build(Study(PAPER), taken)
    with pytest.raises(OutputError, match="LS60"):
        build.build(Study(PAPER), taken / "below")
    assert taken.read_text() == "a file"
    with pytest.raises(OutputError, match="LS601"):
        build.build(Study(PAPER), Path("/proc/loopsheet"))


def test_a_workbook_whose_columns_go_in_a_circle_shows_the_path(tmp_path: Path) -> None:
    folder = copy_paper(tmp_path / "own")
    toml = folder / "report.toml"
    toml.write_text(toml.read_text().replace('"soft_impact"', '"workbook.py"'))
    (folder / "workbook.py").write_text(
        "from dataclasses import replace\n"
        "from sympy import Symbol\n"
        "from loopsheet.derivations.equation import Equation, Kind\n"
        "from loopsheet.report.sheet import Column, Formula, Sheet\n"
        "from loopsheet.report.workbooks.soft_impact import WORKBOOK as paper\n"
        "a, b = (Symbol(n, positive=True) for n in 'ab')\n"
        "one = Formula(Equation('(1)', (a, b), 'x', Kind.DEFINITION))\n"
        "two = Formula(Equation('(2)', (b, a), 'x', Kind.DEFINITION))\n"
        "own = Sheet, (Column('a', None, one), Column('b', None, two))\n"
        "WORKBOOK = replace(paper, name='own', sheet=lambda given: own[0](own[1]))\n"
    )
    with pytest.raises(InputError, match="a -> b -> a"):
        assert Study(folder).computed


def test_other_units_other_masses_and_other_numbers_of_tests(report: Report, tmp_path: Path) -> None:
    """The same campaign in other units gives the same numbers; a finite target scales the forces only."""
    folder = copy_paper(tmp_path / "units")
    (folder / "report.toml").write_text(
        'title = "other units"\nworkbook = "soft_impact"\n[parameters]\nball_mass = "8.365741 g"\n'
        'target_mass = "8.365741 kg"\n[measurements]\nfile = "m.csv"\n'
    )
    rows = [line.split(",") for line in (folder / "measurements.csv").read_text().splitlines()[1:]]
    lines = ["test,x_p [mm],e [%],v [cm/s]"]
    for number, v, e, x in rows[:3]:
        lines.append(f"{int(number) * 10},{float(x) / 1000:.6f},{float(e) * 100:.4f},{float(v) * 100:.4f}")
    (folder / "m.csv").write_text("\n".join(lines) + "\n")
    other = Study(folder).computed
    assert [c.label for c in other.values.cells("alpha")] == [(10, 20), (10, 30), (20, 30)]
    for mine, theirs in (((10, 20), (1, 2)), ((10, 30), (1, 3)), ((20, 30), (2, 3))):
        a, b = other.values.cell("alpha", mine).value, report.values.cell("alpha", theirs).value
        assert a == pytest.approx(b, rel=1e-13)
        c, d = other.values.cell("C", mine).value, report.values.cell("C", theirs).value
        assert c == pytest.approx(d * 1000 / 1001, rel=1e-6)
    assert other.shown["x_m"].unit == "mm"


@pytest.mark.parametrize(
    ("change", "digits", "alpha_mean"),
    [
        (("", ""), 4, "1.3026"),  # e and three depths have three digits
        (("5,4.993,0.453,51.03", "5,4.993,0.45,51.03"), 3, "1.317"),
        (("41.6\n", "41.60\n"), 4, "1.3026"),
        (("5,4.993,0.453,51.03", "5,5,0.453,51.03"), 2, "1.31"),
    ],
)
def test_where_no_uncertainty_tells_a_digit_more_is_shown_than_the_least_precise_number_has(
    tmp_path: Path, change: tuple[str, str], digits: int, alpha_mean: str
) -> None:
    folder = copy_paper(tmp_path / "in")
    tests, toml = folder / "measurements.csv", folder / "report.toml"
    assert change[0] in tests.read_text()
    tests.write_text(tests.read_text().replace(*change))
    toml.write_text(toml.read_text().partition("[published]")[0])
    report = Study(folder).computed
    shown = report.shown
    assert {shown[name].digits for name in ("alpha", "alpha_mean", "x_m", "Cprime_eq7")} == {digits}
    assert (shown["v"].digits, shown["e"].digits, shown["x_p"].digits) == tuple(
        1 + min(printed.digits for printed in report.inputs.measured[name]) for name in ("v", "e", "x_p")
    )
    assert (shown["ball_density"].digits, shown["ball_diameter"].digits) == (5, 4)
    assert (shown["beta"].digits, shown["points_per_pair"].digits) == (6, 6)  # not measured: exact
    assert (shown["x_m"].unit, shown["x_m"].scale) == ("um", 1e-6)
    assert (shown["C"].unit, shown["C"].scale) == ("N/m^alpha", 1.0)
    line = next(line for line in summary(report)["lines"] if line.startswith("alpha_mean "))
    assert line.split()[1] == alpha_mean


def test_a_move_that_fails_half_way_is_taken_back(
    tmp_path: Path, gauge: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Fail at each replacement in turn: every time the old output is there to the last byte."""
    import os as system

    monkeypatch.setenv(SETTING, "")  # what is kept is put in place in the same way
    out = tmp_path / "out"
    build.build(Study(gauge), out, ("json",))
    before = hashes(out)
    toml = gauge / "report.toml"
    toml.write_text(toml.read_text().replace("0.1 K", "0.2 K"))
    real = system.replace
    for fatal in range(2):
        calls = iter(range(100))

        def breaks(source: object, target: object, calls: object = calls, fatal: int = fatal) -> None:
            if next(calls) == fatal:  # type: ignore[call-overload]
                raise OSError(28, "No space left on device")
            real(source, target)  # type: ignore[arg-type]

        with monkeypatch.context() as patch:
            patch.setattr(system, "replace", breaks)
            with pytest.raises(OutputError, match="No space left"):
                build.build(Study(gauge), out, ("json",))
        assert hashes(out) == before, fatal


def test_what_is_in_the_way_is_named_and_nothing_is_touched(tmp_path: Path, gauge: Path) -> None:
    out = tmp_path / "out"
    (out / "values.json").mkdir(parents=True)
    (out / "manifest.json").write_text("mine")
    with pytest.raises(OutputError, match=r"values\.json"):
        build.build(Study(gauge), out, ("json",))
    assert (out / "manifest.json").read_text() == "mine"
    assert sorted(p.name for p in out.iterdir()) == ["manifest.json", "values.json"]


def test_what_an_earlier_build_made_goes_and_what_was_changed_has_another_name(
    tmp_path: Path, gauge: Path
) -> None:
    out = tmp_path / "out"
    build.build(Study(gauge), out, ("json", "latex"))
    (out / "report.tex").write_text("changed by hand")
    (gauge / "report.toml").write_text((gauge / "report.toml").read_text() + "# edited\n")
    build.build(Study(gauge), out, ("json",))
    assert sorted(p.name for p in out.rglob("*") if p.is_file()) == [
        "manifest.json",
        "report.edited.tex",
        "values.json",
    ]


def test_a_place_that_may_not_be_entered_is_a_message(require: Callable[..., str], tmp_path: Path) -> None:
    """Root may enter all: then another user asks, who may not enter the folders of tests."""
    tmp_path.chmod(0o000)
    command = [sys.executable, "-m", "loopsheet", "build", "paper", "--out", str(tmp_path / "a" / "out")]
    if os.getuid() == 0:
        command = [require("setpriv"), "--reuid=65534", "--regid=65534", "--clear-groups", *command]
    done = subprocess.run(command, cwd="/", capture_output=True, text=True, check=False)
    tmp_path.chmod(0o700)
    assert done.returncode == 2, done.stderr
    assert done.stderr.startswith("error[LS601]: ")
    assert "' cannot be written: Permission denied\n" in done.stderr
    assert "help: choose another place (a build's is --out), or check the permissions\n" in done.stderr


@pytest.mark.parametrize(
    ("files", "formats"),
    [
        ((), None),
        (("report.html", "report.xlsx"), None),
        (("report.html", "report.xlsx", "report.pdf"), ("html", "latex", "xlsx", "json", "pdf")),
        (("report.html", "report.pdf"), ("html", "latex", "json", "pdf")),
        (("report.pdf",), ("html", "latex", "xlsx", "json", "pdf")),
    ],
)
def test_a_pdf_that_was_built_before_is_built_again(
    tmp_path: Path, files: tuple[str, ...], formats: tuple[str, ...] | None
) -> None:
    manifest = {
        "schema": 1,
        "title": "t",
        "inputs": {"report.toml": "0"},
        "outputs": dict.fromkeys(files, "0"),
        "versions": {},
    }
    manifest |= {"values": ""}
    if files:
        (tmp_path / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    assert build.formats_again(tmp_path) == formats


def test_the_numbers_come_with_any_format(tmp_path: Path) -> None:
    """A page says that values.json has all numbers, and `diff` asks for it."""
    folder, out = copy_paper(tmp_path / "own"), tmp_path / "out"
    assert main(["build", str(folder), "--out", str(out), "--to", "latex"]) == 0
    written = {path.name for path in out.iterdir()}
    assert written >= {"report.tex", "values.json"}
    assert "report.html" not in written
