"""What all tests share: hypothesis, programs outside Python, the shipped paper, campaigns at random."""

import fcntl
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cache, cached_property
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import pytest
from campaign_sizes import SEED, SIZES, Sizes
from hypothesis import settings
from hypothesis.internal.conjecture import providers
from hypothesis.internal.constants_ast import Constants, constants_from_module
from small_report import end_gauge

import loopsheet
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.machine.background import Background
from loopsheet.report.machine.kept import SETTING
from loopsheet.report.machine.memory import ample
from loopsheet.report.machine.provenance import sources

if TYPE_CHECKING:
    from random_campaigns import Node

    from loopsheet.report.result.result import Report

ample()  # what is imported until here asks for no sympy
CI = os.environ.get("CI", "").lower() not in ("", "0", "false")

# No deadline: the first example of a property pays for imports and code generation. Under CI the
# examples are the same in every run, so that a red run can be repeated.
settings.register_profile("loopsheet", deadline=None, print_blob=True, derandomize=CI)
settings.load_profile("loopsheet")


@cache
def constants() -> Constants:
    """All constants of the package."""
    names = (module.name for module in walk_packages(loopsheet.__path__, "loopsheet."))
    found = Constants()
    for name in names:
        if name != "loopsheet.__main__":
            found |= constants_from_module(import_module(name))
    return found


KEEPS = (
    os.environ.setdefault("LOOPSHEET_TESTS_KEEP", "no" if os.environ.get(SETTING) == "" else "yes") == "yes"
)
"""Whether anything is kept at all, for workers too; not where the sources are changed on purpose
(tests/mutants.py)."""

os.environ[SETTING] = ""
"""Until the tests begin: what is imported keeps nothing."""


def shipped(config: pytest.Config) -> Path:
    """What is kept of these sources, by all workers and runs; the larger shipped folders, to begin with."""
    place = config.cache.mkdir("loopsheet")
    of_these = hashlib.sha256(json.dumps(sources(), sort_keys=True).encode()).hexdigest()[:16]
    found, examples = place / of_these, place / f"{of_these}.examples"
    with (place / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not found.exists():
            for older in filter(Path.is_dir, place.iterdir()):
                shutil.rmtree(older)
                place.joinpath(f"{older.name}.examples").unlink(missing_ok=True)
            found.mkdir(mode=0o700)
        # Where one file is run, after an edit, its tests ask for less.
        if hasattr(config, "workerinput") and not examples.exists():
            for example in ("soft_steel", "worked_example"):
                with TemporaryDirectory() as made:
                    copied = shutil.copytree(PAPER.parent / example, Path(made, example))
                    command = [sys.executable, "-m", "loopsheet", "build", str(copied)]
                    environment = {**os.environ, SETTING: str(found)}
                    subprocess.run(command, env=environment, capture_output=True, check=False)
            examples.touch()
    return found


@pytest.fixture(scope="session", autouse=True)
def _kept(pytestconfig: pytest.Config) -> Iterator[None]:
    """What is made of the same bytes is kept from test to test, as it is for users."""
    with pytest.MonkeyPatch.context() as patch:
        if KEEPS and hasattr(pytestconfig, "cache"):  # without pytest's own there is no place for it
            patch.setenv(SETTING, str(shipped(pytestconfig)))
        yield


@pytest.fixture(scope="module")
def anew(_kept: None) -> Iterator[None]:
    """What a test looks at is made for it: for tests of how, or how often, something is made."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(SETTING, "")
        yield


@pytest.fixture(scope="module")
def keeping(_kept: None, tmp_path_factory: pytest.TempPathFactory) -> str:
    """Where that is kept for the tests of a file alone which is made where they patch something."""
    if not KEEPS:
        return ""
    own = tmp_path_factory.mktemp("kept")
    if os.environ[SETTING]:
        # What another worker is about to put there has a name with a point before it.
        begun = shutil.ignore_patterns(".*")
        shutil.copytree(os.environ[SETTING], own, dirs_exist_ok=True, copy_function=os.link, ignore=begun)
    return str(own)


@pytest.fixture(autouse=True)
def _made_by_what_is_patched(request: pytest.FixtureRequest) -> Iterator[None]:
    """Where a test patches what makes something, others are not given that, nor it what others made."""
    with pytest.MonkeyPatch.context() as patch:
        if "monkeypatch" in request.fixturenames:
            patch.setitem(ONCE, "now", False)
            own = "keeping" in request.fixturenames
            patch.setenv(SETTING, request.getfixturevalue("keeping") if own else "")
        yield


ONCE = {"now": True}
"""Whether a part of a shipped folder's study that was made once is given to whoever asks for it."""


@pytest.fixture(scope="session", autouse=True)
def _shipped_folders_once(_kept: None) -> Iterator[None]:
    """What is known of the folders that ship is made once a run, also for the commands that tests call."""
    from loopsheet.report.study import Study

    found: dict[tuple[str, Path, Any], tuple[Any, list[str]]] = {}

    def once(name: str, make: Callable[[Study], Any]) -> Callable[[Study], Any]:
        def made(study: Study) -> Any:
            if not (ONCE["now"] and os.environ[SETTING] and study.folder.parent == PAPER.parent):
                return make(study)
            key = name, study.folder, study.find
            if key in found:
                part, said = found[key]
                for sentence in said:
                    study.step(sentence)
                return part
            said, tell = [], study.step
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(study, "step", lambda sentence: (said.append(sentence), tell(sentence)))
                part = make(study)
            found[key] = part, said
            return part

        return made

    with pytest.MonkeyPatch.context() as patch:
        for name in ("computed", "numpy", "refereed"):
            part = cached_property(once(name, vars(Study)[name].func))
            part.__set_name__(Study, name)
            patch.setattr(Study, name, part)
        yield


@pytest.fixture(scope="session", autouse=True)
def _examples_whoever_ran_before() -> Iterator[None]:
    """Hypothesis likes to draw constants of modules, but takes those that happen to be loaded."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(providers, "_get_local_constants", constants)
        yield


def find_program(*names: str) -> str:
    """Path of the first of these programs that is installed; without any, skip (under CI: fail)."""
    for name in names:
        path = shutil.which(name)
        if path is not None:
            return path
    sentence = f"needs {' or '.join(names)} on the PATH"
    if CI:
        pytest.fail(f"{sentence}: install it in .ci/run", pytrace=False)
    pytest.skip(sentence)


@pytest.fixture(scope="session")
def require() -> Callable[..., str]:
    """Give `require("latexmk")`, or `require("chromium", "chromium-browser")` where names differ."""
    return find_program


@pytest.fixture
def every_engine(capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    """Give `every_engine(folder)`: what `check` tells, in which all three engines are within their bounds."""

    def check(folder: Path, code: int = 0) -> str:
        from loopsheet.report.cli import main

        find_program("node")
        find_program("soffice", "libreoffice")
        assert main(["check", str(folder)]) == code
        told = capsys.readouterr().out
        assert re.findall(r"engine +(\w+) .* at most [\d.]+ eps", told) == ["numpy", "JavaScript", "xlsx"]
        return told

    return check


@pytest.fixture
def chdir() -> Iterator[Callable[[Path], None]]:
    """Go somewhere until the test ends; `monkeypatch` could, too, but what it patches is made anew."""
    before = Path.cwd()
    yield os.chdir
    os.chdir(before)


@pytest.fixture
def gauge(tmp_path: Path) -> Path:
    """A small report folder in an otherwise empty one."""
    folder = tmp_path / "gauge"
    folder.mkdir()
    return end_gauge(folder)


# --- the shipped paper, made once: nothing in it may be changed, `replace` gives another ---


@pytest.fixture(scope="session")
def report() -> "Report":
    """The report of the shipped paper, computed and proved."""
    from loopsheet.report.study import Study

    return Study(PAPER).proved


@pytest.fixture(scope="session")
def paper(report: "Report") -> "Report":
    """The report of the shipped paper, refereed too."""
    from loopsheet.report.study import Study

    return replace(Study(PAPER).refereed, proofs=report.proofs, errata=report.errata)


@pytest.fixture(scope="session")
def issued(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the shipped paper, and in `out` its report as `loopsheet build` writes it."""
    from loopsheet.report import build
    from loopsheet.report.study import Study

    def make(place: Path) -> None:
        folder = shutil.copytree(PAPER, place / "steel")
        build.build(Study(folder), folder / "out")

    return once_a_run(tmp_path_factory, "issued", make) / "steel"


def once_a_run(tmp_path_factory: pytest.TempPathFactory, name: str, make: Callable[[Path], None]) -> Path:
    """A folder that is made by the first worker who asks for it; nothing in it may be changed."""
    place = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        place = place.parent  # which all workers have
    with (place / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (place / name).exists():
            draft = tmp_path_factory.mktemp(name)
            make(draft)
            draft.rename(place / name)
    return place / name


@pytest.fixture
def unrefereed() -> Iterator[None]:
    """No referee, who takes longer than all else."""
    from loopsheet.report import build, referee, stages
    from loopsheet.report.result.verdict import Referee

    def unasked(made: Any, values: Any, *_: object, **__: object) -> Any:
        return Referee(), referee.compare(made.inputs.published, values)

    with without("a referee") as patch:
        for module in (build, stages):
            patch.setattr(module, "refereed_values", unasked)
        yield


@pytest.fixture
def unjudged(report: "Report", unrefereed: None) -> Iterator[None]:
    """No judge of the engines either, and the proofs are known: for tests of how files are written."""
    from loopsheet.report import stages

    with without("a judge") as patch:
        patch.setattr(stages, "judged", lambda report, *_: report)
        yield


@contextmanager
def without(what: str) -> Iterator[pytest.MonkeyPatch]:
    """A patch that changes no more than outputs: these are kept beside those of others, all else with it."""
    from loopsheet.report.study import Study

    kept = Study.kept

    def beside(study: Study, part: str, make: Any, *parts: str, **by: str) -> Any:
        more = (f"without {what}",) if part == "outputs" else ()
        return kept(study, part, make, *parts, *more, **by)

    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(ONCE, "now", False)
        patch.setattr(Study, "kept", beside)
        yield patch


# --- processes ---


@pytest.fixture
def beside() -> None:
    """Where that is what matters, a build has processes beside its own."""


@pytest.fixture(autouse=True)
def _in_this_process(request: pytest.FixtureRequest) -> Iterator[None]:
    """Else it builds as where the system lets none begin: most reports here take less than a process does."""
    from loopsheet.report import build

    with pytest.MonkeyPatch.context() as patch:
        if "beside" not in request.fixturenames:
            patch.setattr(build, "Background", Here)
        yield


class Here(Background[Any]):
    """A call for which no process may be begun."""

    def __init__(self, function: Callable[..., Any], *arguments: Any) -> None:
        def refused(*_: object, **__: object) -> None:
            raise PermissionError

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(subprocess, "Popen", refused)
            super().__init__(function, *arguments)


# --- campaigns that are drawn at random ---


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--seen", action="store_true", help="the paper's report is right as it is")
    group = parser.getgroup("campaigns", "campaigns drawn at random (tests/campaign_sizes.py)")
    group.addoption("--campaigns", choices=SIZES, default="few", help="how many (default: few)")
    group.addoption("--seed", type=int, default=SEED, help=f"which ones (default: {SEED})")


LONGEST = (
    "test_libreoffice.py", "test_referee_forged.py", "test_environments.py", "test_browsers.py",
    "test_hyperformula.py", "test_figures.py", "test_digits.py", "test_oddities.py", "test_page_access.py",
    "test_build.py", "test_cli.py", "test_kept.py", "test_verify.py", "test_page_lasting.py",
    "test_pytest_plugin.py", "test_design.py", "test_page_digits.py", "test_open_xml.py", "test_ledger.py",
    "test_page.py", "test_global_fit.py", "test_kept_sheet.py", "test_soft_impact_algebra.py",
    "test_engines_random.py", "test_same_anywhere.py", "test_referee.py", "test_page_layout.py",
    "test_page_saving.py",
)  # fmt: skip
"""The files that take longest, as they are measured: begun first, none is left over for a single worker."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    places = {name: place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: places.get(item.path.name, len(LONGEST)))


def drawn(config: pytest.Config) -> str:
    return f"campaigns: {config.getoption('campaigns')}, seed {config.getoption('seed')}"


def pytest_report_header(config: pytest.Config) -> str:
    return drawn(config)


@pytest.fixture(scope="session")
def sizes(pytestconfig: pytest.Config) -> Sizes:
    """How many campaigns to draw, and from what seed."""
    return replace(SIZES[pytestconfig.getoption("campaigns")], seed=pytestconfig.getoption("seed"))


@pytest.fixture(scope="module")
def node(require: Callable[..., str], tmp_path_factory: pytest.TempPathFactory) -> "Iterator[Node]":
    """The programs of the sheets of campaigns in node, printed once for a file."""
    from random_campaigns import SHEETS, Node, printed_once

    from loopsheet.report.engines import javascript

    programs = [javascript.program(sheet) for sheet in SHEETS]
    with printed_once(), Node(require("node"), tmp_path_factory.mktemp("node"), programs) as running:
        yield running


@pytest.fixture
def summary(record_property: Callable[[str, object], None]) -> Callable[[str], None]:
    """Give `summary("200 honest papers: nobody accused")`, a line at the end of the run."""
    return lambda line: record_property("campaigns", line)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    reports = [report for kind in ("passed", "failed") for report in terminalreporter.stats.get(kind, ())]
    said = [
        line
        for report in sorted(reports, key=lambda report: report.nodeid.partition("::")[0])
        for name, line in report.user_properties
        if name == "campaigns" and report.when == "call"
    ]
    if said:
        terminalreporter.section(drawn(config))
        for line in said:
            terminalreporter.write_line(line)
