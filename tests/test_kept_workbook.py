"""A shipped workbook as data: the same as what its module declares, of which nothing is imported."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import pytest

from loopsheet.report.kept_workbook import known_workbook
from loopsheet.report.machine.kept import SETTING
from loopsheet.report.partly import is_partly
from loopsheet.report.which_workbook import is_shipped
from loopsheet.report.workbook import Workbook
from loopsheet.report.workbooks import contact_models, soft_impact


def never() -> Workbook:
    raise AssertionError("somebody asked for the whole workbook")


@pytest.fixture
def known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Workbook]:
    """A workbook that was made before."""
    monkeypatch.setenv(SETTING, str(tmp_path / "kept"))
    known_workbook("soft_impact", lambda: soft_impact.WORKBOOK)
    return lambda whole: known_workbook("soft_impact", whole)


def test_all_that_is_data_is_known(known: Callable[..., Workbook]) -> None:
    found, own = known(never), soft_impact.WORKBOOK
    functions = {"ledger", "sheet", "check_parameters", "drawn", "drawings", "design"}
    for name in {field.name for field in fields(Workbook)} - functions:
        assert getattr(found, name) == getattr(own, name), name
    assert found.card_constants is None
    assert found.wrong(frozenset({"ball_mass"})) is None
    assert found.wrong(frozenset({"ball_mass", "ball_density"}))
    assert found.charts == own.charts
    assert is_shipped(found)


def test_what_it_does_is_done_by_itself(known: Callable[..., Workbook]) -> None:
    found, given = known(lambda: soft_impact.WORKBOOK), frozenset({"ball_mass"})
    assert found.sheet(given) is soft_impact.WORKBOOK.sheet(given)
    assert found.wrong(frozenset()) == soft_impact.WORKBOOK.wrong(frozenset())
    assert is_partly(found)
    with pytest.raises(AssertionError, match="somebody asked"):
        known(never).ledger()


def test_a_workbook_with_algebra_in_it_is_imported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(SETTING, str(tmp_path / "kept"))
    for _ in range(2):
        assert known_workbook("contact_models", lambda: contact_models.WORKBOOK) is contact_models.WORKBOOK
