"""The shipped paper with the oldest libraries that are allowed, and with the newest Python: same numbers."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable
from itertools import zip_longest
from pathlib import Path

import pytest

from loopsheet.report.archive.wheel import wheel

pytestmark = pytest.mark.usefixtures("anew")

ROOT = Path(__file__).parents[2]

Build = Callable[[Path], Path]


@pytest.fixture
def built(tmp_path: Path) -> Build:
    """Install the running loopsheet in an environment, let it build the paper, and give the outputs."""

    def build(python: Path) -> Path:
        name, content = wheel()
        (tmp_path / name).write_bytes(content)
        pip = [python, "-m", "pip", "--quiet", "--disable-pip-version-check", "install"]
        for command in (
            [*pip, "--no-deps", "--no-index", "--force-reinstall", tmp_path / name],
            [python.parent / "loopsheet", "build", "paper", "--out", tmp_path / "out"],
        ):
            done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stderr
        return tmp_path / "out"

    return build


def same(out: Path, issued: Path) -> None:
    """All files are there, and all results are the same to the last digit, those of the referee too."""
    names = [sorted(path.name for path in folder.rglob("*")) for folder in (out, issued / "out")]
    assert names[0] == names[1]
    assert (out / "values.json").read_text() == (issued / "out" / "values.json").read_text()


def test_at_the_floors(environment: Callable[..., Path], built: Build, issued: Path) -> None:
    same(built(environment("floors")), issued)


def test_with_the_newest_python(environment: Callable[..., Path], built: Build, issued: Path) -> None:
    newest = max(newer(), default=None)
    if newest is None:
        pytest.skip(f"there is no Python beyond {sys.version_info.major}.{sys.version_info.minor} here")
    same(built(environment("runtime", newest[1])), issued)


def newer() -> list[tuple[int, str]]:
    """The interpreters of later minor versions that can be called here, by their minor versions."""
    found = []
    for minor in range(sys.version_info.minor + 1, sys.version_info.minor + 10):
        name = f"python3.{minor}"
        # What pyenv has, but does not let be called by that name, it tells.
        for asked in ([name], ["pyenv", "whence", "--path", name]):
            if (program := shutil.which(asked[0])) is None:
                continue
            command = [program, *(asked[1:] or ["-c", "import sys; print(sys.executable)"])]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode == 0 and done.stdout.strip():
                found.append((minor, done.stdout.splitlines()[0]))
                break
    return found


def test_the_lock_of_the_floors_has_the_floors() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["dependencies"]
    lock = (ROOT / "requirements" / "floors.txt").read_text(encoding="utf-8")
    pinned = dict(re.findall(r"^([\w-]+)==([\d.]+)", lock, re.MULTILINE))
    for each in declared:
        name, floor = each.split(">=")
        numbers = ([int(part) for part in version.split(".")] for version in (floor, pinned[name]))
        assert all(a == b for a, b in zip_longest(*numbers, fillvalue=0)), name
