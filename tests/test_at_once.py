"""What Python, math or NumPy would do to the names of a method: told with its line, all of it at once."""

import re
from pathlib import Path

import pytest
from helpers import method_folder

from loopsheet.report.at_once import at_once
from loopsheet.report.cli import main

HEAD = """import math
import numpy as np
from statistics import mean as average
from loopsheet import Method, given, let, measured


class Ohm(Method):
    i = measured("mA", "current")
    U = given("V", "voltage")
    Q = 2 * U
"""


@pytest.mark.parametrize(
    "line",
    [
        "R = let(np.median(i), 'median')",
        "R = let(U / np.mean(a=i), 'mean')",
        "R = let(np.linalg.norm([i, i]), 'norm')",
        "R = let(math.sqrt(U), 'root')",
        "R = let(average([U, Q]), 'mean')",
        "R = let(U if i == 10 else Q, 'case')",
        "R = let(U if U in (1, 5) else 2 * U, 'case')",
        "R = let(U or i, 'either')",
        "R = let(U, 'one') if Q else let(i, 'other')",
        "if Q != 10: R = let(U, 'one')",
        "while U: break",
        "R = let(U * (1 if count() == 3 else 2), 'count')",
        "if sum(i) and mean(i) == 2: R = let(U, 'one')",
    ],
)
def test_it_is_told_with_its_line(line: str) -> None:
    found = list(at_once(f"{HEAD}    {line}\n".encode()))
    assert {at for at, _, _ in found} == {11}


@pytest.mark.parametrize(
    "line",
    [
        "R = let(np.pi * U / math.sqrt(2), 'of numbers alone')",
        "R = let(max(U, Q), 'the greater')",
        "R = [let(n * U, 'times') for n in (1, 2) if n == 2 or n != 3][0]",
        "c = 3 if __name__ else 4",
        "R = [let(rows * U, 'times') for rows in (1, 2) if rows == 2][0]",
    ],
)
def test_numbers_are_pythons(line: str) -> None:
    assert not list(at_once(f"{HEAD}    {line}\n".encode()))


def test_what_words_return_has_no_number_yet() -> None:
    """Of three readings `n == 3` was False."""
    for said in ("n = count()", "n: object = total(1)", "first, n = pairs()"):
        code = f"{HEAD}    {said}\n    f = 1 if n == 3 else 2\n"
        assert {at for at, _, _ in at_once(code.encode())} == {12}


def test_all_lines_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code = f"{HEAD}    R = let(np.mean(i), 'mean')\n    if U == 5: S = let(U, 'five')\n"
    assert main(["check", str(method_folder(tmp_path, code, more='[parameters]\nU = "5.0 V"\n'))]) == 2
    told = capsys.readouterr().err
    assert re.findall(r"workbook\.py:(\d+)", told) == ["11", "12"]
    assert "np.mean(...) would work on the name, not on its numbers" in told
    assert "help: a formula has no if: write max(a, b) or min(a, b)" in told
