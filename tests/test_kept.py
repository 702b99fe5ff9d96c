"""What is kept from run to run: believed only where it is private and whole, and seen in no result."""

from __future__ import annotations

import errno
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from made_files import hashes
from small_report import FILES, end_gauge

from loopsheet.report import stages
from loopsheet.report.cli import main
from loopsheet.report.machine import kept as keeping
from loopsheet.report.machine.kept import SETTING, kept, nothing_kept, place
from loopsheet.report.machine.provenance import versions
from loopsheet.report.machine.timing import Timing
from loopsheet.report.messages.errors import InputError
from loopsheet.report.own_workbook import follows_from_its_bytes
from loopsheet.report.referee import judging
from loopsheet.report.result.verdict import Referee
from loopsheet.report.study import Study
from loopsheet.report.verification import verify

Built = Callable[..., tuple[int, str, int]]


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "cache"
    monkeypatch.setenv(SETTING, str(folder))
    return folder


def made(what: str = "a thing", *parts: str | bytes) -> bool:
    """Whether a thing is made now."""
    told: list[bool] = []

    def make() -> dict[str, object]:
        told.append(True)
        return {"value": 0.1, "all": (1, None)}

    assert kept(what, parts, make) == {"value": 0.1, "all": [1, None]}
    return bool(told)


def the(folder: Path) -> Path:
    (path,) = folder.iterdir()
    return path


@pytest.mark.usefixtures("cache")
def test_a_thing_is_made_once_for_all_that_it_is_made_from() -> None:
    keys: list[tuple[str | bytes, ...]] = [
        (),
        ("a",),
        ("a", "b"),
        ("ab",),
        ("", "ab"),
        (b"\xff",),
        ("\udcff",),
    ]
    assert [made("a thing", *key) for key in keys] == [True] * len(keys)
    assert [made("a thing", *key) for key in keys] == [False] * len(keys)
    assert made("another", "a")
    assert kept("a third", (), None) is None
    assert kept("another", ["a"], None) == {"value": 0.1, "all": [1, None]}


def test_what_is_damaged_or_foreign_is_made_again(cache: Path) -> None:
    made()
    path = the(cache)
    whole = path.read_bytes()
    for damaged in (b"", whole[:-1], whole + b" ", whole.replace(b"0.1", b"0.2"), b"0" * 64 + b"{}"):
        path.write_bytes(damaged)
        assert made()
        assert path.read_bytes() == whole
    made("another")
    (other,) = set(cache.iterdir()) - {path}
    path.write_bytes(other.read_bytes())  # whole, but of something else
    assert made()
    assert not made()


def test_only_what_is_private_is_believed(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made()
    assert (cache.stat().st_mode & 0o777, the(cache).stat().st_mode & 0o777) == (0o700, 0o600)
    the(cache).chmod(0o644)
    assert made()
    for mode in (0o755, 0o770, 0o701):
        cache.chmod(mode)
        assert place() is None
        assert made()
    cache.chmod(0o700)
    assert not made()
    other = os.getuid() + 1
    monkeypatch.setattr(os, "getuid", lambda: other)
    assert place() is None
    monkeypatch.undo()
    link = cache.with_name("link")
    link.symlink_to(cache)
    monkeypatch.setenv(SETTING, str(link))
    assert place() is None


def test_other_sources_and_libraries_make_other_things(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = {"method": "0"}
    monkeypatch.setattr(keeping, "sources", lambda: dict(now))
    keeping._made_by.cache_clear()
    assert [made(), made()] == [True, False]
    now["method"] = "1"
    keeping._made_by.cache_clear()
    assert [made(), made()] == [True, False]

    def meanwhile() -> int:
        now["method"] = "2"  # somebody edits the sources while they run
        return 1

    there = len(list(cache.iterdir()))
    assert kept("edited", (), meanwhile) == 1
    assert len(list(cache.iterdir())) == there
    monkeypatch.setattr(keeping, "versions", lambda: versions() | {"sympy": "99"})
    keeping._made_by.cache_clear()
    assert made()
    monkeypatch.undo()
    keeping._made_by.cache_clear()


def test_every_library_is_known() -> None:
    from importlib.metadata import requires

    needed = {word.partition(">")[0] for word in requires("loopsheet") or () if "extra" not in word}
    assert needed == {*versions(), *keeping.UNTOLD} - {"loopsheet", "python"}


@pytest.mark.parametrize(
    ("platform", "variables", "expected"),
    [
        ("linux", {}, "home/.cache/loopsheet/kept"),
        ("linux", {"XDG_CACHE_HOME": "{}/xdg"}, "xdg/loopsheet/kept"),
        ("linux", {"XDG_CACHE_HOME": "not/absolute"}, "home/.cache/loopsheet/kept"),
        ("darwin", {"XDG_CACHE_HOME": "{}/xdg"}, "home/Library/Caches/loopsheet/kept"),
        ("win32", {"LOCALAPPDATA": "{}/local"}, "local/loopsheet/kept"),
        ("linux", {SETTING: ""}, None),
        ("linux", {SETTING: "{}/a file/below"}, None),
        ("linux", {SETTING: "\x00"}, None)
        if sys.platform == "win32"
        else ("linux", {SETTING: "/dev/null"}, None),
    ],
)
def test_where_things_are_kept(
    platform: str,
    variables: dict[str, str],
    expected: str | None,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in (SETTING, "XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    for name, value in {"HOME": "{}/home", **variables}.items():
        monkeypatch.setenv(name, value.format(tmp_path))
    (tmp_path / "a file").touch()
    monkeypatch.setattr(sys, "platform", platform)
    assert place() == (None if expected is None else tmp_path / expected)


def test_where_nothing_can_be_kept_all_goes_on(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", full)
        assert [made(), made()] == [True, True]
    assert list(cache.iterdir()) == []
    with nothing_kept():
        assert [made(), made()] == [True, True]
        assert os.environ[SETTING] == ""
    assert os.environ[SETTING] == str(cache)
    assert list(cache.iterdir()) == []


def test_there_is_room_for_what_was_used_last(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number, name in enumerate("abc"):
        made(name)
        for path in cache.iterdir():
            found = path.stat()
            os.utime(path, (found.st_atime - 10, found.st_mtime - 10))
        assert len(list(cache.iterdir())) == number + 1
    assert not made("a")
    (cache / ".killed").touch()
    os.utime(cache / ".killed", (0, 0))
    monkeypatch.setattr(keeping, "LARGEST", 3 * the_size(cache))
    made("d")
    assert not (cache / ".killed").exists()
    assert [made(name) for name in "acd"] == [False, False, False]
    assert kept("b", (), None) is None


def the_size(cache: Path) -> int:
    return max(path.stat().st_size for path in cache.iterdir())


# --- what a user sees of it: nothing but the time ---


@pytest.fixture
def build(
    tmp_path: Path, cache: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Built:
    """Build a small report; exit code, what was told, and how often something was computed."""
    folder = tmp_path / "gauge"
    folder.mkdir()
    end_gauge(folder)
    monkeypatch.chdir(tmp_path)
    computed: list[object] = []
    real = stages.evaluated

    def counted(*given: object) -> object:
        computed.append(given)
        return real(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(stages, "evaluated", counted)

    def call(*options: str) -> tuple[int, str, int]:
        computed.clear()
        code = main(["build", "gauge", "--to", "html,json", *options])
        return code, capsys.readouterr().out, len(computed)

    return call


def test_outputs_are_the_same_with_and_without(build: Built, tmp_path: Path, cache: Path) -> None:
    out = tmp_path / "gauge" / "out"
    code, told, computed = build("--no-cache")
    assert computed
    assert not cache.exists()
    first = hashes(out)
    assert (*build()[:2], hashes(out)) == (code, told, first)
    assert (*build(), hashes(out)) == (code, told, 0, first)
    for word in ("cache", "kept", str(cache)):
        assert word not in (out / "manifest.json").read_text()
    for path in cache.iterdir():
        path.write_bytes(path.read_bytes()[:-1])
    again = build()
    assert (again[:2], hashes(out)) == ((code, told), first)
    assert again[2]
    # A file that the user worked on is no less theirs.
    (out / "values.json").write_text("mine")
    assert "values.json was not as built: it is kept as values.edited.json" in build()[1]
    assert (out / "values.edited.json").read_text() == "mine"
    (out / "values.edited.json").unlink()
    assert hashes(out) == first


def test_an_edit_is_computed_and_taken_back_is_known(build: Built, tmp_path: Path) -> None:
    data = tmp_path / "gauge" / "d.csv"
    before, out = data.read_text(), tmp_path / "gauge" / "out"
    build()
    first = hashes(out)
    data.write_text(before.replace("215", "216"))
    assert build()[2]
    assert hashes(out) != first
    data.write_text(before)
    assert build()[2] == 0
    assert hashes(out) == first
    toml = tmp_path / "gauge" / "report.toml"
    toml.write_text(toml.read_text().replace('"d.csv"', '"e.csv"'))
    with pytest.raises(InputError, match="LS104"):
        assert Study(toml.parent).computed
    data.rename(data.with_name("e.csv"))
    assert build()[2]


def test_a_workbook_that_reads_what_it_likes_is_run_again(build: Built, tmp_path: Path) -> None:
    assert (build()[2] > 0, build()[2] > 0) == (True, False)
    code = tmp_path / "gauge" / "workbook.py"
    code.write_text(f"import os\n{code.read_text()}")
    assert (build()[2] > 0, build()[2] > 0) == (True, True)


@pytest.mark.parametrize(
    ("code", "closed"),
    [
        ("from sympy import Symbol\nimport math\nfrom loopsheet.report.sheet import Sheet", True),
        ("import numpy", False),
        ("from . import other", False),
        ("import math, os.path", False),
        ("x = open('data')", False),
        ("read = [eval][0]", False),
        ("def f(:", False),
        ("\x00", False),
    ],
)
def test_what_follows_from_its_bytes(code: str, closed: bool) -> None:
    assert follows_from_its_bytes(code.encode()) is closed


def test_verify_believes_nothing_that_is_kept(
    build: Built, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    build()
    build()

    def fail(*_: object) -> None:
        raise MemoryError

    from loopsheet.report.which_workbook import find_workbook

    for module, name in ((judging, "referee"), (stages, "evaluated")):
        with monkeypatch.context() as patch:
            patch.setattr(module, name, fail)
            assert build()[0] == 0
            with pytest.raises(MemoryError):
                verify(tmp_path / "gauge" / "out", None, find=find_workbook)


def test_what_the_referee_found_is_kept_of_the_same_bytes_alone(
    tmp_path: Path, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And it is what was found: a published value off by one slip, in a folder with stated uncertainties."""
    asked, judge = [], judging.referee

    def counted(*given: Any) -> Referee:
        asked.append(judge(*given))
        return asked[-1]

    monkeypatch.setattr(judging, "referee", counted)
    stated = "\n[uncertainty]\nd = 'u = 5 nm, dof = 9'\n"
    slipped = "source,cell,index,value,unit\nH.1,l,1,50.000383,mm\nH.1,l,2,50.000827,mm\n"
    folder, copy = tmp_path / "gauge", tmp_path / "elsewhere" / "gauge"
    folder.mkdir()
    end_gauge(folder, slipped, report=FILES["report.toml"] + stated)
    shutil.copytree(folder, copy)
    first, again, there = Study(folder).refereed, Study(folder).refereed, Study(copy).refereed
    (found,) = asked
    assert found.joint is not None
    assert found.joint.worst is not None
    assert found.joint.witness
    assert found.explanations or found.slips
    assert first.referee == again.referee == there.referee == found
    assert there.referee.joint is not None
    assert there.referee.joint.worst is there.inputs.published[0]
    (folder / "published.csv").write_text(slipped.replace("383", "838"))
    right = Study(folder).refereed.referee
    assert right == asked[-1] != found
    (folder / "published.csv").write_text(slipped)
    assert Study(folder).refereed.referee == found
    assert len(asked) == 2


@pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() != 0, reason="only root can be two users")
def test_another_user_believes_nothing_of_ours_and_writes_the_same(
    require: Callable[..., str],
) -> None:
    """Whoever is told to use another one's cache folder makes all again, and leaves it as it is."""
    setpriv, other = require("setpriv"), 65534
    with tempfile.TemporaryDirectory() as name:  # pytest's own are closed to others
        place = Path(name)
        place.chmod(0o777)
        (place / "gauge").mkdir()
        end_gauge(place / "gauge")
        found, kept_before = [], []
        runs = ((0, "ours"), (other, "ours"), (other, "theirs"), (other, "theirs"), (0, "theirs"))
        for user, cache in runs:
            out = place / f"out{len(found)}"
            out.mkdir()
            os.chown(out, user, user)
            as_other = [setpriv, f"--reuid={user}", f"--regid={user}", "--clear-groups"] if user else []
            command = [sys.executable, "-m", "loopsheet", "build", str(place / "gauge"), "--out", str(out)]
            done = subprocess.run(
                [*as_other, *command, "--to", "json", "--timing"],
                env={**os.environ, SETTING: str(place / cache), "HOME": str(place)},
                cwd=place, capture_output=True, text=True, check=False,
            )  # fmt: skip
            assert done.returncode == 0, done.stderr
            found.append(hashes(out))
            kept_before.append("  values" not in done.stderr)
        assert [each == found[0] for each in found] == [True] * 5
        assert kept_before == [False, False, False, True, False]
        assert {path.stat().st_uid for path in (place / "ours").iterdir()} == {0}
        assert {path.stat().st_uid for path in (place / "theirs").iterdir()} == {other}


HEAVY = {"sympy", "numpy", "scipy", "matplotlib", "pint", "jinja2", "mpmath"}


@pytest.mark.parametrize(
    ("verb", "never", "again"),
    [
        (["show", "alpha_mean"], {"scipy", "matplotlib", "jinja2"}, HEAVY),
        (["why", "alpha[1-2]"], {"scipy", "matplotlib", "jinja2"}, HEAVY),
        (["prove", "(9)"], {"scipy", "matplotlib", "jinja2"}, set()),
    ],
)
def test_what_is_not_needed_is_not_imported(
    verb: list[str], never: set[str], again: set[str], cache: Path
) -> None:
    code = (
        "import sys; from loopsheet.report.cli import main; main(sys.argv[1:]);"
        f"print(*sorted({HEAVY!r} & set(sys.modules)), file=sys.stderr)"
    )
    runs = [
        subprocess.run(
            [sys.executable, "-c", code, *verb, "paper"], capture_output=True, text=True, check=True
        )
        for _ in range(2)
    ]
    assert runs[0].stdout == runs[1].stdout
    assert never.isdisjoint(runs[0].stderr.split())
    assert again.isdisjoint(runs[1].stderr.split())


# --- where the time went ---


def test_parts_count_their_own_time(monkeypatch: pytest.MonkeyPatch) -> None:
    ticks = iter([0.0, 1.0, 3.0, 7.0, 15.0, 31.0])
    monkeypatch.setattr("time.perf_counter", lambda: next(ticks))
    timing = Timing()
    with timing.part("outer"), timing.part("inner"):
        pass
    assert timing.seconds == {"outer": 10.0, "inner": 4.0}
    lines = list(timing.lines())
    assert lines[2:4] == ["  17.000 s  everything else", "  31.000 s  in all"]


def test_it_is_told_if_one_asks(build: Built, cache: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["show", "l", "gauge", "--timing"])
    told = capsys.readouterr().err
    assert [part for part in ("inputs", "values", "in all") if part not in told] == []
    assert f"kept for the next run in {cache}" in told
    cache.chmod(0o755)
    main(["show", "l", "gauge", "--timing"])
    assert "nothing was kept: there is no folder for it that belongs" in capsys.readouterr().err
    main(["show", "l", "gauge", "--timing", "--no-cache"])
    assert "nothing was kept, as was asked for" in capsys.readouterr().err
    cache.chmod(0o700)
    main(["show", "l", "gauge"])
    assert capsys.readouterr().err == ""


def test_data_that_is_kept_is_json(cache: Path, build: Built) -> None:
    build()
    assert [json.loads(path.read_bytes()[64:]) for path in cache.iterdir()]
