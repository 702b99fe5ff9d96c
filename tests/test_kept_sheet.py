"""The sheet of a shipped workbook as data: the same sheet, and no algebra is loaded for what runs of it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from loopsheet.report.cells.marks import margins
from loopsheet.report.column import Column, Given, Root
from loopsheet.report.engines.numpy_texts import program_texts
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.kept_sheet import sheet_of
from loopsheet.report.machine.kept import SETTING
from loopsheet.report.partly import is_partly
from loopsheet.report.plan.lowering import lowered
from loopsheet.report.sheet import Sheet
from loopsheet.report.study import Study
from loopsheet.report.workbooks.soft_impact import WORKBOOK

GIVEN = [
    frozenset({"ball_mass", "beta", "points_per_pair"}),
    frozenset({"ball_diameter", "ball_density", "target_mass", "beta", "points_per_pair"}),
]


@pytest.fixture(params=GIVEN, ids=["mass", "diameter"])
def both(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Sheet]:
    """A sheet as it is declared, and as it is known."""
    monkeypatch.setenv(SETTING, str(tmp_path / "kept"))
    checked: list[Sheet] = []
    known = [sheet_of(WORKBOOK, request.param, checked.append) for _ in range(2)]
    assert len(checked) == 1, "what is kept was checked before"
    return [checked[0], *known]


def plainly(sheet: Sheet, column: Column) -> list[object]:
    """What a column says without its algebra."""
    names = (
        "name",
        "unit",
        "meaning",
        "latex",
        "display",
        "positive",
        "exact",
        "is_u",
        "spare",
        "source",
        "content",
    )
    rule = column.rule
    return [
        *(getattr(column, name) for name in names),
        rule if isinstance(rule, Given) else type(rule).__name__,
        (rule.none, rule.two, rule.unknown_name) if isinstance(rule, Root) else None,
        column.axis and (column.axis.words, column.axis.parts, column.axis.described),
        column.axis and column.axis.alone.content,
        [(r.name, r.index, r.over and r.over.name) for r in sheet.named(column)],
        [axis.name for axis in sheet.summed_axes(column)],
        [(limit.mark, limit.told, limit.silent) for limit in column.limits],
    ]


def test_a_known_sheet_says_what_the_declared_one_says(both: list[Sheet]) -> None:
    declared, *known = both
    for sheet in known:
        assert [c.name for c in sheet.order] == [c.name for c in declared.order]
        assert sheet.bounds == declared.bounds
        for own, column in zip(sheet.columns, declared.columns, strict=True):
            assert plainly(sheet, own) == plainly(declared, column)
        assert [m.column.content for m in margins(sheet)] == [m.column.content for m in margins(declared)]


def test_what_is_not_known_is_declared_again(both: list[Sheet]) -> None:
    declared, _, sheet = both
    for own, column in zip(sheet.columns, declared.columns, strict=True):
        assert is_partly(own)
        assert own.expressions == column.expressions
        assert own == column
        assert column == own
        assert own.requires == column.requires
        assert own.nonnegative is column.nonnegative
        assert [r.cell for r in sheet.named(own)] == [r.cell for r in declared.named(column)]
    assert [axis.maps for axis in sheet.axes] == [axis.maps for axis in declared.axes]
    assert program_texts(sheet, lowered(sheet)) == program_texts(declared, lowered(declared))
    assert sheet["x_p"] != sheet["v"]
    given = replace(sheet["alpha"], rule=Given("free"), requires=())
    assert not is_partly(given)
    assert given.expressions == ()
    assert hash(given.axis) == hash(declared["alpha"].axis)


WITHOUT = """\
import sys
class Refuse:
    def find_spec(self, name, *_):
        if name == "sympy":
            raise ImportError("sympy is not wanted here")
sys.meta_path.insert(0, Refuse())
"""


def test_an_edited_number_is_built_without_sympy(tmp_path: Path) -> None:
    campaign, without = tmp_path / "campaign", tmp_path / "without"
    shutil.copytree(PAPER, campaign)
    without.mkdir()
    (without / "sitecustomize.py").write_text(WITHOUT)  # runs at the start of every process that is begun
    table = campaign / "measurements.csv"
    if os.environ[SETTING]:  # the algebra of the paper itself
        shutil.copytree(os.environ[SETTING], tmp_path / "kept", copy_function=os.link)

    def build(edited: str, out: str, paths: str = "", cache: str = "kept") -> list[Path]:
        table.write_text(re.sub(r"29\.7\d*", edited, table.read_text()))
        environment = {**os.environ, SETTING: str(tmp_path / cache), "PYTHONPATH": paths}
        command = [sys.executable, "-m", "loopsheet", "build", str(campaign), "--out", str(tmp_path / out)]
        run = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
        assert run.returncode == 1, run.stderr  # published values differ otherwise than is known
        return sorted(path for path in (tmp_path / out).rglob("*") if path.is_file())

    build("29.71", "first")
    found = build("29.72", "second", str(without))
    for one, other in zip(found, build("29.72", "third", cache="none"), strict=True):
        assert one.read_bytes() == other.read_bytes(), one.name


OWN = """\
from dataclasses import replace
from loopsheet.report.sheet import Sheet
from loopsheet.report.study import Study
from loopsheet.report.workbooks.soft_impact import WORKBOOK as paper

def sheet(given):
    return Sheet(tuple(
        replace(c, meaning="mean of them all") if c.name == "alpha_mean" else c
        for c in paper.sheet(given).columns
    ))

WORKBOOK = replace(paper, sheet=sheet)
"""


def test_a_workbook_that_is_called_as_a_shipped_one_is_taken_for_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(SETTING, str(tmp_path / "kept"))
    campaign = tmp_path / "campaign"
    shutil.copytree(PAPER, campaign)
    assert Study(campaign).prepared.sheet["alpha_mean"].meaning == "mean exponent"
    (campaign / "workbook.py").write_text(OWN)
    toml = campaign / "report.toml"
    toml.write_text(toml.read_text().replace('"soft_impact"', '"workbook.py"'))
    assert Study(campaign).prepared.sheet["alpha_mean"].meaning == "mean of them all"
