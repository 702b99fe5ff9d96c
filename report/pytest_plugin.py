"""Report folders as tests: pytest collects a report.toml, one test a proof, engine and published value.

pytest loads this module in every run on a machine that has loopsheet, so that nothing heavy is imported
before there is a report.toml of ours. ``-p no:loopsheet`` leaves it out, ``-m "not loopsheet"`` its tests.
"""

from __future__ import annotations

import re
import tomllib
import warnings
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from _pytest.mark.expression import Expression

if TYPE_CHECKING:
    from .messages.diagnostics import Check
    from .messages.errors import Diagnostic
    from .study import Study

_LARGEST = 250_000
"""Bytes. A report.toml of ours is smaller; another tool's larger one is left alone."""
_LIKE_OURS = re.compile(r"^\s*workb\w+\s*=", re.M)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Take whether the workbook.py of a folder may be run, for one run or in the settings."""
    what = "run the workbook.py of report folders that have one: it is code"
    parser.getgroup("loopsheet").addoption("--loopsheet-run-workbook", action="store_true", help=what)
    parser.addini("loopsheet_run_workbook", what, type="bool", default=False)


def pytest_configure(config: pytest.Config) -> None:
    """Declare the marker that our tests carry."""
    config.addinivalue_line("markers", "loopsheet: a check of a report folder, made from its report.toml")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> ReportFile | None:
    """Take a report.toml that names a workbook; another tool's file of that name is none of our business."""
    if file_path.name != "report.toml" or not _is_ours(file_path) or _is_copy(file_path):
        return None
    return ReportFile.from_parent(parent, path=file_path)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Tell why folders with code of their own were skipped, which else only ``-rs`` tells."""
    for skip in terminalreporter.stats.get("skipped", ()):
        if skip.nodeid.endswith("report.toml::workbook::own code"):
            terminalreporter.write_line(f"{skip.nodeid.partition('::')[0]}: {skip.longrepr[2]}")


def _is_ours(path: Path) -> bool:
    """Whether a report.toml is meant for loopsheet, also if there is something wrong with it."""
    try:
        if path.stat().st_size > _LARGEST:
            return False
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False
    return _says_ours(text) or _stands_with_ours(path.parent, text)


def _says_ours(text: str) -> bool:
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError):
        return bool(_LIKE_OURS.search(text)) and ("[measurements" in text or "[parameters" in text)
    return "workbook" in data and ("measurements" in data or "parameters" in data)


def _stands_with_ours(folder: Path, text: str) -> bool:
    """Whether it is meant for loopsheet by what stands beside it, whatever it says itself."""
    try:
        method = (folder / "workbook.py").read_bytes()[:_LARGEST]
    except OSError:
        method = b""
    return b"loopsheet" in method or bool(_LIKE_OURS.search(text) and (folder / "measurements.csv").is_file())


def _is_copy(path: Path) -> bool:
    """Whether it stands in a crate that was made of the folder around it, which is collected itself."""
    from .inputs.folders import INPUTS

    folder, out = path.parent, path.parent.parent
    return folder.name == INPUTS and (out / "manifest.json").exists() and _is_ours(out.parent / path.name)


def _own_code_is_asked_for(config: pytest.Config) -> bool:
    """Whether a workbook.py may be run: that was said, and ``-m`` does not leave its tests out anyway."""
    if not (config.getoption("loopsheet_run_workbook") or config.getini("loopsheet_run_workbook")):
        return False
    chosen = config.getoption("markexpr", "")
    try:
        return not chosen or Expression.compile(chosen).evaluate(lambda name, /, **_: name == "loopsheet")
    except SyntaxError:
        return False  # pytest tells of it


class FolderChecks:
    """A report folder, computed once and only as far as its tests ask.

    `own_code`: whether its workbook may be code of the folder.
    """

    def __init__(self, folder: Path, own_code: bool) -> None:
        from .which_workbook import find_workbook, shipped_workbook

        self._folder = folder
        self._find = find_workbook if own_code else shipped_workbook
        self._engines: dict[str, Check] = {}
        self._refused: Diagnostic | None = None

    @cached_property
    def study(self) -> Study:
        """The folder as a user would write it, from where the run is when it is first asked for."""
        from .study import Study

        here = Path.cwd()
        folder = self._folder.relative_to(here) if self._folder.is_relative_to(here) else self._folder
        return Study(folder, self._find)

    def plan(self) -> dict[str, list[str]]:
        """The names of all checks, by kind, without computing anything.

        Raises
        ------
        InputError
            The folder is not as it must be.
        """
        from .engines import ENGINES
        from .judge import oddities
        from .messages.errors import InputError
        from .result.findings import CONFORMITY, names_of, table_names

        try:
            prepared = self.study.prepared
        except InputError as error:
            (*others, last) = error.diagnostics
            if others or last.code != "LS214":
                raise
            self._refused = last
            return {"workbook": ["own code"]}
        inputs = prepared.check_cells()
        return {
            "engine": list(ENGINES),
            "proof": [equation.label for equation in self.study.ledger.equations()],
            "published": names_of((*inputs.published, *inputs.published_u)),
            "table": table_names(inputs),
            **oddities.names(prepared.sheet, inputs),
            CONFORMITY: [each.address for each in inputs.limits],
        }

    def check(self, kind: str, name: str, every_engine: bool = True) -> Check:
        """Do what is needed for one check, and whatever comes with it."""
        if kind == "workbook":
            return self._not_run(name)
        if kind == "engine":
            return self._engine(name, every_engine)
        if kind == "proof":
            return self._proofs[name]
        own = (check for check in self.study.computed.oddities if (check.kind, check.name) == (kind, name))
        return next(own, None) or self._refereed[kind, name]

    @cached_property
    def _refereed(self) -> dict[tuple[str, str], Check]:
        from .result.findings import checks

        return {(check.kind, check.name): check for check in checks(self.study.refereed)}

    @cached_property
    def _proofs(self) -> dict[str, Check]:
        from .result.findings import of_proof

        found, _ = self.study.algebra
        return {proof.equation.label: of_proof(proof, self.study.inputs) for proof in found}

    def _not_run(self, name: str) -> Check:
        from .messages.diagnostics import Check

        assert self._refused is not None
        said = f"{self._refused.message}; {self._refused.hint}"
        return Check("workbook", name, True, said, self._refused.at, skipped=True)

    def _engine(self, name: str, every: bool) -> Check:
        from .messages.diagnostics import Check
        from .result.findings import of_engine

        if name not in self._engines:
            judged = self.study.engines if every else self.study.numpy
            self._engines |= {each.engine: of_engine(each, self.study.inputs) for each in judged}
        nothing = Check(
            "engine", name, True, f"{name} was not compared: it cannot hold this sheet", skipped=True
        )
        return self._engines.setdefault(name, nothing)


class ReportFile(pytest.File):
    """A report.toml: one collector for each kind of check."""

    def collect(self) -> Iterator[KindCollector]:
        """Read the folder and name its checks; a mistake in it is told with its line."""
        from .messages.errors import LoopsheetError

        checks = FolderChecks(self.path.parent, _own_code_is_asked_for(self.config))
        try:
            plan = checks.plan()
        except LoopsheetError as error:
            raise self.CollectError(str(error)) from None
        for kind, names in plan.items():
            if names:
                yield KindCollector.from_parent(self, name=kind, checks=checks, names=names)


class KindCollector(pytest.Collector):
    """The checks of one kind.

    Parameters
    ----------
    **more
        As for :class:`pytest.Collector`.
    """

    def __init__(self, *, checks: FolderChecks, names: list[str], **more: Any) -> None:
        super().__init__(**more)
        self.checks, self.names = checks, names

    def collect(self) -> Iterator[CheckItem]:
        """One test a name."""
        for name in self.names:
            yield CheckItem.from_parent(self, name=name, checks=self.checks)


class CheckItem(pytest.Item):
    """One check of a report folder.

    Parameters
    ----------
    **more
        As for :class:`pytest.Item`.
    """

    def __init__(self, *, checks: FolderChecks, **more: Any) -> None:
        super().__init__(**more)
        self.checks = checks
        self.kind: str = self.parent.name if self.parent is not None else ""
        self.add_marker("loopsheet")

    def runtest(self) -> None:
        """Fail with the sentence of a finding; skip what cannot be checked here."""
        from .messages.errors import LoopsheetError

        try:
            check = self.checks.check(self.kind, self.name, self._with_programs())
        except LoopsheetError as error:
            pytest.fail(str(error), pytrace=False)
        if check.note == "warning":
            told = pytest.PytestWarning(check.message)
            warnings.warn_explicit(told, None, check.at.path, check.at.line or 1)
        if check.skipped:
            pytest.skip(check.message)
        if not check.passed:
            pytest.fail(check.sentence, pytrace=False)

    def _with_programs(self) -> bool:
        """Whether an engine that is run by another program was selected too."""
        from .engines import ENGINES

        return any(
            isinstance(item, CheckItem)
            and item.checks is self.checks
            and item.kind == "engine"
            and item.name != next(iter(ENGINES))
            for item in self.session.items
        )

    def reportinfo(self) -> tuple[Path, None, str]:
        """Tell where it was written."""
        return self.path, None, f"{self.kind} {self.name}"
