"""Roots whose equations name rows and their groups, in every engine."""

from collections.abc import Callable
from pathlib import Path

import grouped
import numpy as np
import pytest
from scipy.optimize import brentq

from loopsheet.report.cli import main
from loopsheet.report.study import Study

ROWS = (("a", "2.0"), ("b", "3.1"), ("a", "2.4"), ("b", "2.9"), ("a", "2.2"))
METHOD = """
from loopsheet import Method, groups, let, mean, measured, root, unknown

class Roots(Method):
    "Roots of rows and of groups."
    y = measured("1", "reading", positive=True)
    s = groups("s")
    m = let(mean(y, of=s), "mean")
    q = unknown()
    q = root({}, {}, "root", low=0, high=50)
    twice = let(2 * q, "twice the root")
"""
WORDS = np.array([word for word, _ in ROWS])
Y = np.array([float(y) for _, y in ROWS])


def of_group(taken: Callable[..., float], rows: bool) -> np.ndarray:
    return np.array([taken(Y[word == WORDS]) for word in (WORDS if rows else ("a", "b"))])


@pytest.mark.parametrize(
    ("left", "right", "factor", "known"),
    [
        ("q**3 + m * q", "y", of_group(np.mean, rows=True), Y),
        ("q**3 + mean(y, of=s) * q", "y", of_group(np.mean, rows=True), Y),
        ("q**3 + q * sum(y, of=s) / y", "mean(y, of=s)", of_group(np.sum, True) / Y, of_group(np.mean, True)),
        ("q**3 + q", "m", np.ones(2), of_group(np.mean, rows=False)),
        (
            "q**3 + q * sum(y**2, of=s)",
            "m",
            of_group(lambda y: (y**2).sum(), False),
            of_group(np.mean, False),
        ),
    ],
)
def test_a_root_of_rows_or_groups_is_that_of_each(
    tmp_path: Path, every_engine: Callable[..., str],
    left: str, right: str, factor: np.ndarray, known: np.ndarray,
) -> None:  # fmt: skip
    folder = grouped.write(tmp_path, ROWS, "s,y [1]", METHOD.format(left, right))
    every_engine(folder)
    found = Study(folder).computed.values.value["q"]
    expected = [
        brentq(lambda q, a=a, c=c: q**3 + a * q - c, 0, 50, xtol=1e-14)
        for a, c in zip(factor, known, strict=True)
    ]
    assert found == pytest.approx(expected, rel=1e-12)


def test_no_root_is_in_a_sum_over_the_rows_of_its_group(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = grouped.write(tmp_path, ROWS, "s,y [1]", METHOD.format("sum(y**3 * q, of=s)", "m"))
    assert main(["check", str(folder)]) == 2
    assert "names the unknown of a row" in capsys.readouterr().err
