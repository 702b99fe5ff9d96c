"""The same report again: what changed is named, and why; what is there stays as it is."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest
from made_files import hashes
from processors import lesser

from loopsheet.report import build, stages, verification
from loopsheet.report.cli import main
from loopsheet.report.engines import numpy as engine
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.machine import provenance
from loopsheet.report.messages.errors import InputError, UsageError
from loopsheet.report.study import Study
from loopsheet.report.verification import Verification, verify

pytestmark = pytest.mark.usefixtures("keeping")  # what is patched here decides about no program of a sheet


@pytest.fixture(scope="module")
def unpublished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A campaign with its report inside, and nothing for the referee, who takes longer than all the rest."""
    folder = shutil.copytree(PAPER, tmp_path_factory.mktemp("verify") / "steel")
    toml = folder / "report.toml"
    toml.write_text(toml.read_text().partition("[published]")[0])
    build.build(Study(folder), folder / "out", ("json",))
    return folder


@pytest.fixture
def campaign(unpublished: Path, tmp_path: Path) -> Path:
    return shutil.copytree(unpublished, tmp_path / "steel")


@pytest.fixture(autouse=True)
def _algebra_is_kept() -> Iterator[None]:
    """Nothing that is kept is believed, as tests/test_kept.py holds; all algebra again is a minute a test."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(verification, "nothing_kept", nullcontext)
        yield


def failed(found: Verification) -> dict[str, list[str]]:
    """What differs, by kind."""
    names: dict[str, list[str]] = {}
    for check in found.checks:
        if not check.passed:
            names.setdefault(check.kind, []).append(check.name)
    return names


def test_the_same_report_again_anywhere(tmp_path: Path) -> None:
    """Another process, with another hash seed, time zone, locale and folder, on a lesser processor.

    tests/outside/test_same_anywhere.py builds the shipped paper so.
    """
    campaign = shutil.copytree(PAPER.parent / "gum_4_4", tmp_path / "readings")
    build.build(Study(campaign), campaign / "out")
    before = hashes(campaign)
    elsewhere = {"PYTHONHASHSEED": "4711", "TZ": "Asia/Tokyo", "LC_ALL": "C", "HOME": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-m", "loopsheet", "verify", str(campaign / "out"), "--run-workbook"],
        cwd=tmp_path, env={**os.environ, **elsewhere, **lesser()},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    lines = done.stdout.splitlines()
    assert [line.split(maxsplit=1) for line in lines[:2]] == [
        ["input", "4 the same"],
        ["source", "3 the same"],
    ]
    assert lines[-1] == "the same report again"
    assert hashes(campaign) == before


def test_an_input_that_changed_and_what_it_moves(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = campaign / "measurements.csv"
    table.write_text(table.read_text().replace("29.7", "29.8"))
    before = hashes(campaign)
    assert main(["verify", str(campaign / "out"), "--most", "3"]) == 1
    out = capsys.readouterr().out
    assert "input      the input measurements.csv was changed\n" in out
    assert "number     x_p[2] was 29.7 and is 29.8 um (+0.337 %)\n" in out
    assert "number     alpha_eiv was 1.3013 and is 1.30664 (+0.41 %)\n" in out
    assert " more\n" in out
    assert out.endswith("different: the input (measurements.csv) changed\n")
    assert hashes(campaign) == before


def test_other_ends_of_lines_are_told(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """As where Git changes them on its way to Windows."""
    file = campaign / "measurements.csv"
    file.write_bytes(file.read_bytes().replace(b"\n", b"\r\n"))
    assert main(["verify", str(campaign)]) == 1
    out = capsys.readouterr().out
    assert "measurements.csv was changed, in the ends of its lines alone: '* -text' in .gitattributes" in out


def test_a_library_and_a_source_that_changed(campaign: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    versions, sums = provenance.versions(), provenance.sources()
    monkeypatch.setattr(stages, "versions", lambda: versions | {"numpy": "99.0"})
    monkeypatch.setattr(build, "sources", lambda: sums | {"method": "0" * 64})
    found = verify(campaign / "out", None)
    names = failed(found)
    assert (names["source"], names["library"]) == (["method"], ["numpy"])
    assert "number" not in names
    said = [check.message for check in found.checks if check.kind == "library" and not check.passed]
    assert said == [f"numpy was {versions['numpy']} and is 99.0"]
    assert found.verdict == "different: the sources of loopsheet (method) and the libraries (numpy) changed"


def test_an_output_that_was_changed_by_hand(campaign: Path) -> None:
    values = campaign / "out" / "values.json"
    data = json.loads(values.read_text())
    data["cells"]["alpha"]["value"][0] = 1.234
    values.write_text(json.dumps(data))
    found = verify(campaign / "out", campaign)
    assert failed(found) == {"output": ["values.json"], "number": ["alpha[1-2]"]}
    assert found.verdict == "different: the outputs were changed after they were built, and nothing else was"
    assert [check.message for check in found.checks if not check.passed] == [
        "values.json was changed after it was built",
        "alpha[1-2] was 1.234 and is 1.258 (+1.94 %)",
    ]


@pytest.mark.parametrize(("name", "says"), [("title", "Harder steel"), ("values", "as doubles")])
def test_what_a_manifest_says_of_the_report_is_compared(name: str, says: str, campaign: Path) -> None:
    manifest = campaign / "out" / "manifest.json"
    data = json.loads(manifest.read_text())
    was = data[name]
    manifest.write_text(json.dumps({**data, name: says}))
    found = verify(campaign / "out", campaign)
    assert failed(found) == {"manifest": [name]}
    (told,) = (check.message for check in found.checks if not check.passed)
    assert told == f"the {name} was '{says}', as the manifest says, and is '{was}' when it is built again"
    assert found.verdict.startswith("different")


def test_an_output_that_is_no_result_any_more(campaign: Path) -> None:
    (campaign / "out" / "values.json").write_text("{")
    found = verify(campaign / "out", campaign)
    assert failed(found) == {"output": ["values.json"]}
    assert found.differences is None
    (told,) = (check for check in found.checks if check.kind == "number")
    assert told.skipped
    assert told.message.startswith("no number is compared: 'values.json' is no result: ")


def test_a_manifest_without_inputs_is_none(campaign: Path) -> None:
    """Who empties them would not be told that something else went in."""
    manifest = campaign / "out" / "manifest.json"
    manifest.write_text(json.dumps({**json.loads(manifest.read_text()), "inputs": {}}))
    with pytest.raises(InputError, match="inputs: expected `object` of length >= 1"):
        verify(campaign / "out", campaign)


def rounds(by: float) -> Callable[..., object]:
    """NumPy's engine on a machine that rounds one root otherwise."""
    real = engine.evaluate

    def evaluate(sheet: object, *rest: object, **more: object) -> object:
        values = real(sheet, *rest, **more)  # type: ignore[arg-type]
        if "alpha" in values.value:
            values.value["alpha"].flat[0] *= 1 + by
        return values

    return evaluate


@pytest.mark.parametrize(("by", "noise"), [(100 * np.finfo(float).eps, True), (1e-9, False)])
@pytest.mark.parametrize("another", [True, False])
def test_what_the_judge_of_the_engines_allows_is_rounding(
    by: float, noise: bool, another: bool, campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The condition of alpha[1-2] is 121: a hundred eps are rounding, a billionth is not."""
    monkeypatch.setattr(stages, "EXACTLY", 0)  # a sheet too large for 50 digits
    monkeypatch.setattr(engine, "evaluate", rounds(by))
    manifest = campaign / "out" / "manifest.json"
    issued = manifest.read_text().replace("correctly rounded", "as doubles compute them")
    manifest.write_text(issued.replace(provenance.processor(), "x86_64 X86_V1") if another else issued)
    found = verify(campaign / "out", campaign)
    assert found.differences is not None
    assert "manifest" not in failed(found)
    moved = [move.address for move in found.differences.moved]
    assert found.differences.noise > 50
    assert moved == [] if noise else "alpha[1-2]" in moved
    if noise and another:
        assert failed(found) == {}
        assert found.verdict.startswith("the same report again: another processor rounds ")
        return
    assert "values.json" in failed(found)["output"]
    if noise:
        assert found.verdict.startswith("different: nothing changed but the machine, which rounds ")


def test_what_is_correctly_rounded_is_not_rounded_otherwise(campaign: Path) -> None:
    """Who changes a number a little and the manifest with it is found out: nobody's processor does that."""
    values, manifest = campaign / "out" / "values.json", campaign / "out" / "manifest.json"
    text = values.read_text()
    value = json.loads(text)["cells"]["alpha"]["value"][0]
    values.write_text(text.replace(repr(value), repr(float(np.nextafter(value, 2)))))
    was, now = (hashlib.sha256(each).hexdigest() for each in (text.encode(), values.read_bytes()))
    manifest.write_text(
        manifest.read_text().replace(was, now).replace(provenance.processor(), "x86_64 X86_V1")
    )
    found = verify(campaign / "out", campaign)
    assert found.differences is not None
    assert (found.differences.noise, found.differences.any) == (1, False)
    assert failed(found)["output"] == ["values.json"]
    assert not found.verdict.startswith("different: nothing changed but the machine")


def test_a_digit_that_was_forged_in_output_and_manifest_is_laid_to_no_machine(campaign: Path) -> None:
    """The same machine would make the same bytes of the same input, sources and libraries."""
    values, manifest = campaign / "out" / "values.json", campaign / "out" / "manifest.json"
    text = values.read_text()
    values.write_text(text.replace("1.2579", "1.2578"))
    was, now = (hashlib.sha256(each).hexdigest() for each in (text.encode(), values.read_bytes()))
    assert was != now
    told = manifest.read_text().replace(was, now)
    manifest.write_text(told)
    found = verify(campaign / "out", campaign)
    assert failed(found) == {"output": ["values.json"], "number": ["alpha[1-2]"]}
    assert (
        "so nothing that is recorded explains it; an output was edited together with its fingerprint"
        in found.verdict
    )
    manifest.write_text(told.replace(provenance.processor(), "x86_64 X86_V1"))
    found = verify(campaign / "out", campaign)
    assert found.verdict.endswith("other programs or the machine made it")


def test_the_folder_is_the_one_that_holds_the_report_or_where_one_stands_or_the_paper(
    issued: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def stop(study: Study, *_: object, **__: object) -> None:
        asked.append(study.folder)
        raise KeyboardInterrupt

    monkeypatch.setattr(verification, "build", stop)
    monkeypatch.chdir(issued)
    elsewhere = shutil.copytree(issued / "out", tmp_path / "elsewhere")
    for arguments in ((Path("out"), None), (elsewhere, None), (elsewhere, issued)):
        with pytest.raises(KeyboardInterrupt):
            verify(*arguments)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        verify(elsewhere, None)
    assert asked == [Path(), Path(), issued, PAPER]
    # A copy of the paper that was edited is that folder, though the shipped one holds what it was built from.
    mine = shutil.copytree(issued, tmp_path / "mine")
    (mine / "measurements.csv").write_text("")
    with pytest.raises(KeyboardInterrupt):
        verify(mine / "out", None)
    assert asked[-1] == Path("mine")
    manifest = json.loads((elsewhere / "manifest.json").read_text())
    manifest["inputs"]["report.toml"] = "00"
    (elsewhere / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(UsageError, match="LS609"):
        verify(elsewhere, None)


def test_what_is_no_output_of_ours_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="LS608"):
        verify(tmp_path, None)


@pytest.mark.parametrize("left", [{}, {"report.txt": "0" * 64}])
def test_a_manifest_cannot_make_us_look_away(left: dict[str, str], campaign: Path) -> None:
    """What it leaves out is there, and may hold anything."""
    path, values = (campaign / "out" / name for name in ("manifest.json", "values.json"))
    manifest = json.loads(path.read_text())
    path.write_text(json.dumps(manifest | {"outputs": left}))
    values.write_text(values.read_text().replace("1.3", "1.5"))
    found = verify(campaign / "out", campaign)
    (told,) = [check.message for check in found.checks if check.name == "values.json"]
    assert told == "values.json lies there, but is no part of the build that its manifest tells of"
    assert failed(found)["output"] == [*left, "values.json"]
    assert found.verdict == "different: the outputs were changed after they were built, and nothing else was"


def test_a_manifest_cannot_make_us_look_elsewhere(campaign: Path) -> None:
    path = campaign / "out" / "manifest.json"
    manifest = json.loads(path.read_text())
    manifest["outputs"]["../report.toml"] = hashlib.sha256(
        (campaign / "report.toml").read_bytes()
    ).hexdigest()
    path.write_text(json.dumps(manifest))
    found = verify(campaign / "out", campaign)
    assert failed(found) == {"output": ["../report.toml"]}


@pytest.mark.parametrize("form", ["json", "junit", "github", "markdown"])
def test_findings_in_every_format(
    form: str, campaign: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    found = Verification(
        (verification.Check("input", "a.csv", False, "the input a.csv was changed"),), None, "v"
    )
    monkeypatch.setattr(verification, "verify", lambda *_: found)
    assert main(["verify", str(campaign / "out"), "--format", form]) == 1
    assert "the input a.csv was changed" in capsys.readouterr().out
