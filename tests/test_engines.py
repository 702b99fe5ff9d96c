"""One suite for every engine of the registry, and for the one that judges them: what is known of cases."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import engine_cases
import mpmath
import pytest
import sympy

from loopsheet.report.cells.values import CODES, Status
from loopsheet.report.engines import ENGINES, exact
from loopsheet.report.judge.engines import EPS, Judge
from loopsheet.report.judge.readers import Case, Reading
from loopsheet.report.quantity import SMALLEST
from loopsheet.report.result.agreement import LIMIT


@pytest.fixture(scope="module")
def case() -> Case:
    return engine_cases.asked()


@pytest.fixture(scope="module")
def judge(case: Case) -> Judge:
    assert case.values is not None
    return Judge.of(case.sheet, case.values.layouts, case.labels, case.data)


@pytest.fixture(scope="module")
def reading(case: Case, judge: Judge, require: Callable[..., str]) -> Callable[[str], Reading]:
    """What an engine finds, all cases at once."""

    @cache
    def of(engine: str) -> Reading:
        if engine == "exact":
            status = {name: [CODES[code] for code in codes] for name, codes in judge.judged.status.items()}
            return Reading(engine, "", judge.judged.value, status)  # type: ignore[arg-type]
        return engine_cases.found_by(engine, case, require)

    return of


@pytest.mark.parametrize("name", engine_cases.KNOWN)
@pytest.mark.parametrize("engine", ["exact", *ENGINES])
def test_every_engine_finds_what_is_known(
    engine: str, name: str, judge: Judge, reading: Callable[[str], Reading], request: pytest.FixtureRequest
) -> None:
    """Codes and numbers: 50 digits in closed form, doubles within 8 eps times the condition of their cell."""
    if gap := engine_cases.GAPS.get((engine, name)):
        request.applymarker(pytest.mark.xfail(reason=gap))
    found, judged = reading(engine), judge.judged
    known = engine_cases.KNOWN[name] or [None] * len(judged.status[name])
    for row, (each, status) in enumerate(zip(known, judged.status[name], strict=True)):
        code = status if each is None else each if isinstance(each, Status) else Status.OK
        assert found.status[name][row] == CODES[code], row
        if code is Status.OK:
            true, number = judged.value[name][row], found.value[name][row]
            with mpmath.workdps(exact.DIGITS + 10):
                if engine != "exact":
                    _is_near(number, true, found, judge, name, row)
                elif not isinstance(each, Status | None):
                    closed = mpmath.mpf(sympy.N(each, exact.DIGITS + 10))
                    assert abs(true - closed) <= abs(closed) * mpmath.mpf(10) ** -50, row
    assert len(found.value[name]) == len(known)


def _is_near(number: Any, true: Any, found: Reading, judge: Judge, name: str, row: int) -> None:
    if 0 < abs(true) < SMALLEST:
        return  # what a double has left of its digits is chance
    lost = exact.as_mpf(found.rounded[name][row]) if name in found.rounded else 0
    difference = float(abs(exact.as_mpf(number) - true) - lost)
    assert difference <= LIMIT * EPS * judge.bounds.allowing(name, row, difference), row


def test_a_gap_names_an_engine_and_a_case_that_there_are() -> None:
    assert {engine for engine, _ in engine_cases.GAPS} <= {"exact", *ENGINES}
    assert {name for _, name in engine_cases.GAPS} <= set(engine_cases.KNOWN)
