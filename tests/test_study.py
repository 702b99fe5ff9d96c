"""A study makes each part once, when it is asked for, and nothing that was not asked for."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
from small_report import end_gauge

from loopsheet.derivations import proof
from loopsheet.report import stages
from loopsheet.report.build import build
from loopsheet.report.cli import main
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.machine.kept import SETTING
from loopsheet.report.messages.errors import InputError
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import figures


def parts(study: Study) -> set[str]:
    """What was made of it."""
    return set(vars(study)) - {"folder", "find", "step", "_read"}


def test_nothing_is_made_that_was_not_asked_for(tmp_path: Path) -> None:
    study = Study(end_gauge(tmp_path))
    assert parts(study) == set()
    assert study.inputs.title
    assert parts(study) == {"inputs"}
    assert study.computed.proofs == ()
    assert parts(study) == {"inputs", "declared", "prepared", "computed"}
    assert study.algebra is study.algebra
    assert study.proved.proofs == study.algebra[0]
    assert study.report.engines == study.engines
    assert study.report.referee == study.refereed.referee


@pytest.mark.usefixtures("anew")
def test_a_folder_is_read_once(tmp_path: Path) -> None:
    """What is kept of it and what is computed are of the same bytes, however soon it is edited."""
    study = Study(end_gauge(tmp_path))
    read = dict(study.files)
    (tmp_path / "d.csv").write_text("somebody edits it")
    assert study.inputs.files == study.files == read
    again = Study.of(study.recipe)  # in another process
    assert again.computed.values.scalar("l") == study.computed.values.scalar("l")
    assert again.files == read
    with pytest.raises(InputError):
        assert Study(tmp_path).files


def test_a_proof_that_was_made_elsewhere_is_the_same(report: Report) -> None:
    study, other = Study(PAPER), Study(PAPER)
    other.proof_data = study.proof_data
    assert (other.proved.proofs, other.proved.errata) == (report.proofs, report.errata)
    own = tuple(proof for proof in report.proofs if proof.equation.label == "(11)")
    assert own
    assert other.proofs([report.ledger["(11)"]]) == own
    assert report.errata


def test_a_figure_that_shows_no_data_is_drawn_once(
    tmp_path: Path, report: Report, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(SETTING, str(tmp_path / "cache"))
    monkeypatch.setattr(Study, "are_proved", lambda _: True)
    monkeypatch.setattr(Study, "algebra", (report.proofs, report.errata))
    folder, drawn = shutil.copytree(PAPER, tmp_path / "paper"), list[str]()
    (folder / "published.csv").write_text("source,cell,index,value,unit\n")
    draw = figures.draw

    def told(report: Report, name: str) -> Any:
        drawn.append(name)
        return draw(report, name)

    monkeypatch.setattr(figures, "draw", told)
    build(Study(folder), tmp_path / "out", ("html", "latex"))
    every = {path.name: path.read_bytes() for path in (tmp_path / "out" / "figures").iterdir()}
    assert drawn == ["hysteresis", "lankarani", "loops", "alpha_pairs", "band"]
    data = folder / "measurements.csv"
    data.write_text(data.read_text().replace("29.7", "29.81"))
    build(Study(folder), tmp_path / "out", ("html", "latex"))
    assert drawn[5:] == ["loops", "alpha_pairs", "band"]
    now = {path.name: path.read_bytes() for path in (tmp_path / "out" / "figures").iterdir()}
    assert {name for name in every if now[name] == every[name]} == {
        f"{name}.{form}" for name in drawn[:2] for form in ("svg", "pdf")
    }


def test_the_program_of_the_page_hangs_on_what_is_given_and_not_on_the_numbers(
    tmp_path: Path, report: Report, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(SETTING, str(tmp_path / "cache"))
    folder = shutil.copytree(PAPER, tmp_path / "paper")
    data, toml = folder / "measurements.csv", folder / "report.toml"
    programs = [Study(folder).program]
    assert programs[0] == stages.program(report)
    data.write_text(data.read_text().replace("29.7", "29.81"))
    monkeypatch.setattr(stages, "program", lambda report: "another")
    programs.append(Study(folder).program)
    toml.write_text(toml.read_text().replace("beta = ", 'points_per_pair = "7"\nbeta = '))
    programs.append(Study(folder).program)
    assert programs == [programs[0], programs[0], "another"]
    monkeypatch.undo()
    assert stages.program(Study(folder).computed) == programs[0]


def test_why_proves_what_a_number_comes_from_and_show_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    proved: list[str] = []
    real = proof.prove_entry

    def counted(entry, known, ledger):  # type: ignore[no-untyped-def]
        if hasattr(entry, "steps"):
            proved.append(entry.claim.label)
        return real(entry, known, ledger)

    monkeypatch.setattr(proof, "prove_entry", counted)
    monkeypatch.setattr(stages, "judged", None)
    monkeypatch.setattr(stages, "refereed", None)
    assert main(["show", "alpha", "paper"]) == 0
    assert proved == []
    assert main(["why", "C[1-2]", "paper"]) == 0
    assert "from      (12c) proved" in capsys.readouterr().out
    assert 0 < len(proved) < 6, proved
    proved.clear()
    assert main(["prove", "(7)", "paper"]) == 0
    assert proved == ["(7)"]
