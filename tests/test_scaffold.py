"""`new`: a folder that builds at once, or nothing at all."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from small_report import end_gauge

from loopsheet.report.archive.scaffold import new
from loopsheet.report.inputs.inputs import load
from loopsheet.report.machine.provenance import sources
from loopsheet.report.messages.errors import OutputError
from loopsheet.report.quantity import Bounds
from loopsheet.report.workbook import Measured, Parameter, Workbook

POSITIVE = Bounds(low=0, low_open=True)
WORKBOOK = Workbook(
    name="impact",
    title='Impact of a "ball"',
    source="A paper,\non two lines",
    ledger=lambda: None,
    measured=(Measured("v", "m/s", "impact speed", POSITIVE), Measured("x_p", "m", "imprint depth")),
    parameters=(
        Parameter("ball_mass", "kg", "mass of the ball", POSITIVE),
        Parameter("beta", "1", "exponent of restitution", Bounds(1, 2), default="1.5"),
        Parameter("target_mass", "kg", "mass of the target;\nimmobile if left out"),
    ),
    sheet=lambda given: None,
    example=(("test", "v [m/s]", "x_p [um]"), ("1", "2.000", "19.82"), ("2", "3.000", "29.61")),
    example_parameters={"ball_mass": "8.366 g"},
)
REPORT = """\
# A campaign of your own: put your numbers where the example's are, then 'loopsheet build' here.
# Numbers are written in quotes, as they were printed: the digits say how sure they are.

title = "My campaign"
workbook = "impact"
# Impact of a "ball"
# A paper, on two lines

[parameters]
ball_mass = "8.366 g"                   # mass of the ball; greater than 0 kg
# beta = "1.5"                          # exponent of restitution; between 1 and 2; 1.5 if left out
# target_mass = "... kg"                # mass of the target; immobile if left out

[measurements]
file = "measurements.csv"
# v: impact speed; greater than 0 m/s
# x_p: imprint depth
# Its first line names each column and its unit, which may be any that converts to the one above.
# A column u(x_p) [unit] gives standard uncertainties; without it the printed digits do.

# [uncertainty]                          # of whole columns, and of parameters
# x_p = "U = 0.03 m, k = 2"         # or +-0.1 rect, 0.5 % of reading + 2 digits, exact

# [measurements.printed]
# x_p = "truncated"                    # if digits were cut off; without this, "rounded"

# [expected]                             # cells and tests that are odd, and why
# "test 3" = "the bench was knocked"

# [published]                            # values to compare with, if there are any
# file = "published.csv"                 # source,cell,index,value,unit,expect,recomputed,reason
"""


def tree(folder: Path) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*"))


def test_the_files_are_these(tmp_path: Path) -> None:
    folder = tmp_path / "campaign"
    assert new(folder, WORKBOOK) == [folder / "report.toml", folder / "measurements.csv"]
    assert tree(tmp_path) == ["campaign", "campaign/measurements.csv", "campaign/report.toml"]
    assert (folder / "report.toml").read_text() == REPORT
    assert (
        folder / "measurements.csv"
    ).read_text() == "test,v [m/s],x_p [um]\n1,2.000,19.82\n2,3.000,29.61\n"


@pytest.mark.parametrize("where", [".", "deep/down/campaign", "empty"])
def test_the_folder_is_read_without_findings(
    where: str, tmp_path: Path, chdir: Callable[[Path], None]
) -> None:
    (tmp_path / "here").mkdir()
    chdir(tmp_path / "here")
    Path("empty").mkdir() if where == "empty" else None
    inputs = load(new(Path(where), WORKBOOK)[0].parent, lambda *_: WORKBOOK)
    assert inputs.only.tests == (1, 2)
    assert inputs.given == {"ball_mass"}
    assert inputs.title == "My campaign"
    assert not [name for name in tree(tmp_path) if name.endswith(".new")]


def test_every_comment_that_is_a_key_may_be_switched_on(tmp_path: Path) -> None:
    text = new(tmp_path / "c", WORKBOOK)[0].read_text()
    on = "\n".join(
        line.removeprefix("# ") if " = " in line or line.startswith("# [") else line
        for line in text.split("\n")
    )
    data = tomllib.loads(on)
    assert data["parameters"] == {"ball_mass": "8.366 g", "beta": "1.5", "target_mass": "... kg"}
    assert data["measurements"] == {"file": "measurements.csv", "printed": {"x_p": "truncated"}}
    assert data["published"] == {"file": "published.csv"}


def test_without_an_example_there_is_a_header(tmp_path: Path) -> None:
    bare = Workbook("w", "t", "s", lambda: None, WORKBOOK.measured, (), lambda given: None)
    assert new(tmp_path / "c", bare)[1].read_text() == "test,v [m/s],x_p [m]\n"


@pytest.mark.parametrize(
    ("made", "name", "root"),
    [("", "campaign", "campaign"), ("campaign", "campaign", "campaign"), (".git", "two words/paper", ".")],
)
def test_a_workflow_is_where_github_reads_it(
    made: str, name: str, root: str, tmp_path: Path, chdir: Callable[[Path], None]
) -> None:
    chdir(tmp_path)
    if made:
        Path(made).mkdir()
    written = new(Path(name), WORKBOOK, "github")
    workflow = written[-1].resolve().relative_to((tmp_path / root).resolve()).as_posix()
    assert workflow == f".github/workflows/loopsheet{'' if name == root else '-two-words-paper'}.yml"
    assert all(path.is_file() for path in written)
    assert not [path for path in tree(tmp_path) if path.endswith(".new")]


def test_a_workflow_for_github_does_what_it_says(tmp_path: Path, require: Callable[..., str]) -> None:
    """Its commands run as they stand, at the root of the repository, with the wheel that is kept there."""
    (tmp_path / ".git").mkdir()
    campaign = tmp_path / "two words" / "paper"
    text = new(campaign, WORKBOOK, "github")[-1].read_text()
    assert re.findall(r"uses: (\S+)", text) == [
        "actions/checkout@v6",
        "actions/setup-python@v6",
        "actions/upload-artifact@v6",
    ]
    assert "contents: read" in text
    assert "{{ !cancelled() }}" in text
    assert "\t" not in text

    end_gauge(campaign)
    folder, there = json.loads(re.findall(r"FOLDER: (.*)", text)[0]), tmp_path / "there"
    path = f"{there / 'bin'}:{Path(sys.executable).parent}"  # no other engines: they take their time
    known = {"FOLDER": folder, "RUNNER_TEMP": str(tmp_path), "PATH": path, "PYTHONPATH": str(there)}
    installing = {"PIP_TARGET": str(there), "PIP_NO_DEPS": "1", "PIP_NO_INDEX": "1", "PIP_NO_COMPILE": "1"}
    done = subprocess.run(
        [require("bash"), "-e", "-c", "\n".join(re.findall(r"run: (.*)", text))],
        cwd=tmp_path, env={**os.environ, **known, **installing},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"from {Path(folder) / 'report.toml'} into" in done.stdout
    manifest = json.loads((tmp_path / "report" / "manifest.json").read_text())
    assert manifest["sources"] == sources(there / "loopsheet") == sources()
    # Of a build that is committed, a number that moves is told.
    committed = shutil.copytree(tmp_path / "report", campaign / "out")
    (guard,) = re.findall(r"run: (test .*)", text)
    values, told = (tmp_path / "report" / name for name in ("values.json", "manifest.json"))
    for moved in (False, True):
        if moved:
            was = values.read_bytes()
            now = re.sub(rb'"value": *([0-9.]+)', rb'"value": 7\g<1>', was, count=1)
            values.write_bytes(now)
            sums = (hashlib.sha256(each).hexdigest() for each in (was, now))
            told.write_text(told.read_text().replace(next(sums), next(sums)))
        again = subprocess.run(
            [require("bash"), "-c", guard], cwd=tmp_path, env={**os.environ, **known},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert again.returncode == moved, again.stdout + again.stderr
    assert committed.is_dir()


def test_what_a_service_reads_already_is_not_written_over(tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    new(tmp_path / "a b", WORKBOOK, "github")
    before = tree(tmp_path)
    with pytest.raises(OutputError, match=r"loopsheet-a-b.yml' cannot be written: there is one"):
        new(tmp_path / "a-b", WORKBOOK, "github")
    assert tree(tmp_path) == before


def test_a_folders_name_is_no_expression_of_the_service(tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    workflow = new(tmp_path / "x ${{ github.token }}", WORKBOOK, "github")[-1].read_text()
    assert """FOLDER: "./x ${{ '${{' }} github.token }}"\n""" in workflow


def test_without_a_service_there_is_no_workflow(tmp_path: Path) -> None:
    assert len(new(tmp_path / "c", WORKBOOK)) == 2


def test_a_workflow_that_cannot_be_written_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "campaign"
    folder.mkdir()
    real = Path.replace

    def fail(path: Path, target: Path) -> Path:
        if "loopsheet.yml" in path.name:
            raise OSError(5, "Input/output error")
        return real(path, target)

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(OutputError):
        new(folder, WORKBOOK, "github")
    assert tree(tmp_path) == ["campaign"]


@pytest.mark.parametrize("fails", ["loopsheet-campaign.yml", "report.toml"])
def test_if_a_part_fails_nothing_is_left_in_the_repository(
    fails: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / ".git").mkdir()
    real = Path.write_bytes

    def fail(path: Path, content: bytes) -> int:
        if fails in path.name:
            raise OSError(28, "No space left on device")
        return real(path, content)

    monkeypatch.setattr(Path, "write_bytes", fail)
    with pytest.raises(OutputError):
        new(tmp_path / "campaign", WORKBOOK, "github")
    assert tree(tmp_path) == [".git"]


@pytest.mark.parametrize("used", [True, False])
def test_if_writing_fails_nothing_is_left(
    used: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "a" / "b" / "campaign"
    if used:
        folder.mkdir(parents=True)
    before = tree(tmp_path)
    real = Path.write_bytes

    def fail(path: Path, content: bytes) -> int:
        if "measurements" in path.name:
            raise OSError(28, "No space left on device")
        return real(path, content)

    monkeypatch.setattr(Path, "write_bytes", fail)
    with pytest.raises(OutputError) as caught:
        new(folder, WORKBOOK)
    assert caught.value.diagnostics[0].code == "LS601"
    assert "No space left on device" in str(caught.value)
    assert tree(tmp_path) == before


def test_if_moving_fails_nothing_is_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = Path.replace

    def fail(path: Path, target: Path) -> Path:
        if "measurements" in path.name:
            raise OSError(5, "Input/output error")
        return real(path, target)

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(OutputError):
        new(tmp_path, WORKBOOK)
    assert tree(tmp_path) == []


@pytest.mark.parametrize("name", ["x" * 300, "nul\0"])
def test_a_name_that_no_folder_can_have_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(OutputError):
        new(tmp_path / name, WORKBOOK)
    assert tree(tmp_path) == []


def test_a_used_folder_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "report.toml").write_text("mine")
    with pytest.raises(OutputError) as caught:
        new(tmp_path, WORKBOOK)
    assert caught.value.diagnostics[0].code == "LS603"
    assert (tmp_path / "report.toml").read_text() == "mine"
    assert os.listdir(tmp_path) == ["report.toml"]
