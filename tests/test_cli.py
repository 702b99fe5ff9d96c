"""The command line as a user has it; where a process of its own could matter, it is one."""

from __future__ import annotations

import io
import json
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest

from loopsheet.report import stages
from loopsheet.report.cli import main
from loopsheet.report.engines import javascript
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.machine.kept import SETTING
from loopsheet.report.result.result import Report
from loopsheet.report.verbs import VERBS
from loopsheet.report.verbs.common import Progress

pytestmark = pytest.mark.usefixtures("keeping")  # what is patched here makes nothing that others are given


def run(*arguments: str, cwd: Path | None = None, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the command in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "loopsheet", *arguments],
        cwd=cwd,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    """A folder of one's own, a copy of the shipped one."""
    folder = tmp_path / "campaign"
    folder.mkdir()
    for file in PAPER.iterdir():
        (folder / file.name).write_bytes(file.read_bytes())
    return folder


def test_help_answers_without_loading_anything_heavy() -> None:
    code = (
        "import sys; from loopsheet.report.cli import main\ntry: main(['--help'])\nexcept SystemExit: pass\n"
    )
    code += "heavy = {'numpy', 'sympy', 'scipy', 'matplotlib', 'jinja2', 'pint'}\n"
    code += "print(sorted(heavy & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
    for verb in VERBS:
        assert f"  {verb} " in done.stdout
    assert "exit codes" in done.stdout


def test_every_verb_has_help(capsys: pytest.CaptureFixture[str]) -> None:
    for verb in VERBS:
        with pytest.raises(SystemExit) as stopped:
            main([verb, "--help"])
        assert stopped.value.code == 0
        assert f"usage: loopsheet {verb}" in capsys.readouterr().out


def test_why_tells_what_the_formula_bar_tells(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["why", "alpha[1-2]", "paper"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("alpha[1-2] = 1.25799697873")
    assert "(11) proved, solved as (L5) proved" in out
    assert "0.512^2" in out  # the equation with the values put in
    for cell in ("v[2] = 2.940 m/s", "x_p[2] = 29.7 um", "alpha_mean = 1.3026", "F (50 rows)"):
        assert cell in out


@pytest.mark.parametrize(
    ("cell", "said"),
    [
        ("x[1-2-3]", ["in SI     x[1-2-3] = (4.18451e-05)*3/50 = 2.51071e-06"]),
        ("x_p[2]", ["given     as 29.7 um, measurements.csv:3:", "used by   alpha[1-2] = 1.258"]),
        ("m_red", ["(L", "ball_mass = 8.366 g"]),
        ("alpha_mean", ["over 10 pairs", "alpha[4-5] = 1.371"]),
        ("alpha_log", ["over 500 points", "ln_x (500 rows)"]),
        ("x[1-2-3]", ["in SI     x[1-2-3] =", "points_per_pair = 50"]),
    ],
)
def test_why_of_every_kind_of_cell(cell: str, said: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["why", cell, "paper"]) == 0
    out = capsys.readouterr().out
    assert [words for words in said if words not in out] == [], out


def test_why_names_the_first_culprit(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = campaign / "measurements.csv"
    table.write_text(table.read_text().replace("0.512", "0.9"))
    assert main(["why", "x_m1[1-2]", str(campaign)]) == 0
    out = capsys.readouterr().out
    assert "x_m1[1-2] = #NOROOT!" in out
    assert "#NOROOT! x_m1[1-2] needs alpha[1-2]: (11) has no root here" in out


@pytest.mark.parametrize("command", ["show alpha_eiv", "show alpha", "show x_m1[1-2]", "budget alpha_eiv"])
def test_a_cell_without_a_value_is_a_finding(
    campaign: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    whole = main([*command.split(), str(campaign)]), capsys.readouterr().out
    table = campaign / "measurements.csv"
    table.write_text(table.read_text().replace("29.7", "2.97"))
    lacking = main([*command.split(), str(campaign)]), capsys.readouterr().out
    assert (whole[0], lacking[0]) == (0, 1)
    assert "#NOROOT!" in lacking[1]
    assert "#NOROOT!" not in whole[1]


def test_an_option_may_stand_before_its_verb(capsys: pytest.CaptureFixture[str]) -> None:
    told = []
    for line in (
        ["--no-cache", "show", "alpha_mean", "paper"],
        ["show", "alpha_mean", "paper", "--no-cache"],
    ):
        assert main(line) == 0
        told.append(capsys.readouterr().out)
    assert told[0] == told[1]
    assert main(["--no-cash", "show", "alpha_mean", "paper"]) == 2
    assert "did you mean '--no-cache'?" in capsys.readouterr().err


@pytest.mark.parametrize("verb", ["build --to json", "why v[1]", "verify"])
def test_behind_two_dashes_a_folder_may_begin_with_one(
    verb: str,
    campaign: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copytree(campaign, "-steel")
    code = main([*verb.split(), "--", "-steel"])
    told = capsys.readouterr().err
    assert "LS608" in told if verb == "verify" else code < 2, told  # nothing was built there
    assert "LS604" not in told


def test_show_tells_value_equation_and_precedents(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "alpha[1-2]", "paper"]) == 0
    out = capsys.readouterr().out
    assert "alpha[1-2]" in out
    assert "1.25799697873" in out
    assert "(11)" in out
    assert "computed from v, e, x_p, beta" in out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["show", "alhpa", "paper"], "did you mean 'alpha'?"),
        (["show", "alpha[1-9]", "paper"], "unknown row of alpha '1-9'"),
        (["show", "alpha[", "paper"], "unknown cell 'alpha['"),
        (["show", "alpha[1-2", "paper"], "a column, or a row of it in brackets, such as alpha[1-2]"),
        (["why", "alpha[]", "paper"], "unknown cell 'alpha[]'"),
        (["why", "alpha[1-2]]", "paper"], "unknown cell 'alpha[1-2]]'"),
        (["why", "alpha", "paper"], "unknown single cell 'alpha'"),
        (["prove", "(99)", "paper"], "unknown equation '(99)'"),
        (["why", "(11)", "paper"], "'loopsheet prove \"(11)\"' tells of an equation"),
        (["build", "--to", "htlm"], "did you mean 'html'?"),
        (["build", "no-such-folder"], "no-such-folder"),
        (["new", "x", "--workbook", "soft_inpact"], "did you mean 'soft_impact'?"),
        (["new", "x", "--ci", "githb"], "did you mean 'github'?"),
        (["verify", "out"], "'manifest.json' is no manifest: there is no such file"),
        (["diff", "a", "b"], "'a' is no result: there is no such file"),
        (["crate", "out", "--date", "2026-03-31", "--license", "MIT"], "'manifest.json' is no manifest"),
    ],
)
def test_wrong_words_are_answered_with_what_was_meant(
    arguments: list[str],
    said: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    chdir: Callable[[Path], None],
) -> None:
    chdir(tmp_path)
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert said in captured.err
    assert captured.out == ""
    assert list(tmp_path.iterdir()) == []


def test_prove_prints_the_ledger_and_passes(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", "paper"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for number in ("(6)", "(7)", "(9)", "(10a)", "(11)", "(12a)"):
        assert any(line.startswith(f"{number} ") and " proved " in line for line in lines), number
    assert any(line.startswith("(12e)") and "proved with a correction of the print" in line for line in lines)
    after = {line.split()[0]: following.strip() for line, following in pairwise(lines) if line[:1] == "("}
    assert after["(9)"] == "rests on: (3)"
    assert after["(6)"] == "rests on: (3); theorem of kinetic energy, compression"
    assert after["(L6)"] == "rests on: nothing, it is an identity"
    assert not after["(3)"].startswith("rests on")


def test_prove_one_equation_shows_its_steps(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", "11", "paper"]) == 0
    out = capsys.readouterr().out
    assert "from " in out
    assert "50 digits agree" in out
    assert out.count("residual 0") == 4


def test_check_of_the_paper_is_as_expected(
    require: Callable[..., str], capsys: pytest.CaptureFixture[str]
) -> None:
    require("node")
    require("soffice", "libreoffice")
    assert main(["check", "paper"]) == 0
    out = capsys.readouterr().out
    assert out.splitlines()[-2].startswith("warning: chi2_eiv = 55 on 3 degrees of freedom; ")
    assert out.splitlines()[-1] == "no findings, 1 warning"
    engines = [line.split()[1:5] for line in out.splitlines() if line.startswith("engine ")]
    assert engines == [[name, "2274", "cells,", "at"] for name in ("numpy", "JavaScript", "xlsx")]


@pytest.mark.usefixtures("unrefereed")
def test_a_wrong_engine_is_a_finding(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One operator in the generated JavaScript: check says which engine is off, and where."""
    program = javascript.program
    monkeypatch.setattr(
        javascript, "program", lambda *a, **k: program(*a, **k).replace("*Math.pow($x", "/Math.pow($x", 1)
    )
    assert main(["check", "paper"]) == 1
    out = capsys.readouterr().out
    assert "finding: " in out
    assert "JavaScript" in out.partition("finding: ")[2]
    assert "numpy is off" not in out


@pytest.mark.usefixtures("unrefereed")
def test_the_report_says_how_its_engines_agree(tmp_path: Path) -> None:
    assert main(["build", "paper", "--engines", "--out", str(tmp_path), "--to", "html,latex"]) == 0
    page = (tmp_path / "report.html").read_text()
    section = page.partition("id=engines")[2].partition("</section>")[0]
    assert "2274 cells" in section
    assert all(name in section for name in ("numpy", "JavaScript", "xlsx"))
    assert "How the engines agree" in (tmp_path / "report.tex").read_text()


@pytest.mark.usefixtures("unrefereed")
def test_a_known_difference_that_vanishes_is_a_finding(
    campaign: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = campaign / "published.csv"
    path.write_text(path.read_text().replace("1-2,1.234,", "1-2,1.258,"))
    monkeypatch.setattr(stages, "judged", lambda report, step: report)  # the engines are as they were
    assert main(["check", str(campaign)]) == 1
    out = capsys.readouterr().out
    assert "published.csv:2" in out
    assert "no longer differs" in out


def once(function: Callable[..., Report]) -> Callable[..., Report]:
    """A function that is called with the same again and again."""
    known: list[Report] = []

    def called(*given: object) -> Report:
        known.append(known[0] if known else function(*given))
        return known[-1]

    return called


def test_an_unexpected_difference_is_a_finding_in_every_format(
    campaign: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = campaign / "published.csv"
    path.write_text(re.sub(r"(?m)^(Table 2,alpha,2-4,1\.315,1,.*?)differs,.*$", r"\1,,", path.read_text()))
    monkeypatch.chdir(campaign.parent)
    monkeypatch.setattr(stages, "judged", lambda report, step: report)  # the engines are as they were
    for slow in ("evaluated", "refereed"):
        monkeypatch.setattr(stages, slow, once(getattr(stages, slow)))
    found = {}
    for form in ("text", "json", "junit", "github", "markdown"):
        assert main(["check", "campaign", "--format", form]) == 1
        found[form] = capsys.readouterr().out
        assert "1.315, recomputed 1.294" in found[form]
    data = json.loads(found["json"])
    (finding,) = data["findings"]
    assert finding.startswith(
        "campaign/published.csv:7:19: Table 2 alpha[2-4] prints 1.315, recomputed 1.294 (unreachable"
    )
    assert data["proofs"]["(11)"] == "proved"
    assert data["rests_on"]["(9)"] == ["(3)"]
    assert ElementTree.fromstring(found["junit"]).get("failures") == "1"
    assert found["github"].startswith("::error file=campaign/published.csv,line=7,col=19,")


def test_wrong_input_is_told_in_the_format_that_a_machine_reads(
    campaign: Path, chdir: Callable[[Path], None], capsys: pytest.CaptureFixture[str]
) -> None:
    path = campaign / "measurements.csv"
    path.write_text(path.read_text().replace("0.512", "abc"))
    chdir(campaign)
    assert main(["check", ".", "--format", "github"]) == 2
    captured = capsys.readouterr()
    assert captured.out.startswith(
        "::error file=measurements.csv,line=3,col=9,endColumn=12,title=input LS401::"
    )
    assert "measurements.csv:3:9" in captured.err


@pytest.mark.usefixtures("unjudged")
def test_bad_input_gives_one_located_message_and_leaves_out_as_it_was(campaign: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["build", str(campaign), "--out", str(out), "--to", "json"]) == 0
    before = {p.name: p.read_bytes() for p in out.iterdir()}
    path = campaign / "measurements.csv"
    path.write_text(path.read_text().replace("0.512", "abc"))
    done = run("build", str(campaign), "--out", str(out), "--to", "json")
    assert done.returncode == 2
    assert "measurements.csv:3:9" in done.stderr
    assert "^^^" in done.stderr
    assert "Traceback" not in done.stderr
    assert {p.name: p.read_bytes() for p in out.iterdir()} == before


def test_our_own_bug_is_told_from_the_users_error(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(*_: object, **__: object) -> None:
        raise RuntimeError("a wheel came off")

    monkeypatch.setenv(SETTING, "")  # what was shown before is kept, and nothing would be evaluated
    monkeypatch.setattr(stages, "evaluated", broken)
    assert main(["show", "alpha", "paper"]) == 3
    assert "bug: RuntimeError: a wheel came off" in capsys.readouterr().err


def test_new_makes_a_folder_that_builds(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    assert main(["new", str(folder)]) == 0
    assert main(["build", str(folder), "--out", str(tmp_path / "out"), "--to", "json"]) == 0
    assert (tmp_path / "out" / "values.json").is_file()


@pytest.mark.parametrize("streams", ["| true", "2>&1 | true", ">&-", "2>&-", "<&- >&- 2>&-", "2>/dev/full"])
@pytest.mark.parametrize(
    ("asked", "code"),
    [("show x", 0), ("show alhpa", 2), ("show alpha", 1), ("--version", 0), ("show --help", 0)],
)
def test_who_listens_changes_no_exit_code(
    asked: str, code: int, streams: str, campaign: Path, require: Callable[..., str]
) -> None:
    """Of a reader that goes, and of streams that were never there, nothing is told, and nothing said."""
    if code == 1:
        file = campaign / "measurements.csv"
        file.write_text(file.read_text(encoding="utf-8").replace(",51.03", ","), encoding="utf-8")
    asked = f"env -u PYTHONUNBUFFERED {sys.executable} -m loopsheet {asked}"
    command = [require("bash"), "-c", f"{asked} {streams}; exit ${{PIPESTATUS[0]}}"]
    done = subprocess.run(command, cwd=campaign, capture_output=True, text=True, check=False)
    assert done.returncode == code
    assert "Traceback" not in done.stderr
    assert "Exception" not in done.stderr


def test_show_prints_what_is_given_as_it_was_given(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "x_p", "paper"]) == 0
    told = [line.split() for line in capsys.readouterr().out.splitlines() if line.startswith("  x_p[")]
    assert told == [
        [f"x_p[{test}]", text, "u", "0.029" if test < 4 else "0.0029"]
        for test, text in enumerate(("23.5", "29.7", "41.6", "45.97", "51.03"), start=1)
    ]


def test_why_tells_how_sure_a_number_is(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["why", "alpha[1-2]", "paper"]) == 0
    assert "  uncertain u = 0.016, of 1.258; 'loopsheet budget'" in capsys.readouterr().out
    assert main(["why", "beta", "paper"]) == 0
    assert "uncertain" not in capsys.readouterr().out


def test_a_long_step_is_named_where_stages_alone_are(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    with Progress(stream, patience=0.5) as progress:
        progress.begun -= 60
        progress("proving (1)")
        progress("proving (2)")
        time.sleep(3)
    assert stream.getvalue() == "proving ...\nstill proving (2) ...\n"
