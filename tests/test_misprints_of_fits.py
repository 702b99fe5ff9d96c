"""A misprint in a table of which a fit was published: its results hang together, and few inputs yield them.

The rows are the first of Norris, the line of NIST's Statistical Reference Datasets.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from helpers import method_folder
from mpmath import mp, mpf, nstr, sqrt

from loopsheet.report.result.verdict import Change, Referee
from loopsheet.report.study import Study

DATA = Path(__file__).parent.parent / "data"
LINE = """
from loopsheet import Method, fit, measured, unknown

class Line(Method):
    "An instrument beside that of a laboratory."
    y = measured("1", "reading")
    x = measured("1", "reading of the laboratory")
    B0 = unknown("intercept")
    B1 = unknown("slope")
    line = fit(y, B0 + B1 * x)
"""
Y = ["0.1", "338.8", "118.1", "888.0", "9.2", "228.1", "668.5", "998.5", "449.1", "778.9"]
X = ["0.2", "337.4", "118.2", "884.6", "10.1", "226.5", "666.3", "996.3", "448.6", "777.0"]


def fitted(y: list[str], x: list[str]) -> dict[str, mpf]:
    """What is published of a line: textbook sums, at 50 digits."""
    with mp.workdps(50):
        pairs = [(mpf(a), mpf(b)) for a, b in zip(y, x, strict=True)]
        n = len(pairs)
        of_y, of_x = (sum(each) / n for each in zip(*pairs, strict=True))
        squares = sum((b - of_x) ** 2 for _, b in pairs)
        slope = sum((b - of_x) * (a - of_y) for a, b in pairs) / squares
        start = of_y - slope * of_x
        left = sum((a - start - slope * b) ** 2 for a, b in pairs)
        s = sqrt(left / (n - 2))
        of_start = s * sqrt(mpf(1) / n + of_x**2 / squares)
        found = {"B0": start, "B1": slope, "s_B0": of_start, "s_B1": s / sqrt(squares)}
        return {**found, "line_s": s, "line_S": left}


def refereed(folder: Path, number: int, digits: int, row: int, wrong: str) -> Referee:
    """Some rows with their results to so many digits, one reading being printed otherwise."""
    y, x = Y[:number], X[:number]
    published = [
        f"NIST,{name},,{nstr(value, digits, strip_zeros=False, min_fixed=-20, max_fixed=30)},1"
        for name, value in fitted(y, x).items()
    ]
    printed = [wrong if n == row else text for n, text in enumerate(y, 1)]
    rows = [f"{a},{b}" for a, b in zip(printed, x, strict=True)]
    method_folder(
        folder,
        LINE,
        "\n".join(["y [1],x [1]", *rows, ""]),
        '[uncertainty]\nx = "exact"\n',
        "\n".join(["source,cell,index,value,unit", *published, ""]),
    )
    return Study(folder).refereed.referee


def reading(row: int, wrong: str) -> tuple[str, str, tuple[int, ...], str, str]:
    return "misprint", "y", (row,), wrong, Y[row - 1]


def told(change: Change) -> tuple[str, str, tuple[int, ...], str, str]:
    return change.kind, change.cell, change.index, change.printed, change.would_print


@pytest.mark.parametrize(
    ("number", "digits", "row", "wrong"),
    [
        (5, 6, 2, "333.8"),
        (6, 4, 6, "223.1"),
        (6, 6, 6, "223.1"),
        (8, 6, 8, "995.5"),
        (10, 5, 10, "778.3"),
        (10, 6, 10, "778.5"),
        (10, 9, 10, "778.3"),
        (10, 12, 10, "778.3"),
    ],
)
def test_the_slip_with_which_all_comes_out_comes_first(
    tmp_path: Path, number: int, digits: int, row: int, wrong: str
) -> None:
    """Whatever else would do with other digits behind what is printed; a certain reading is no pair."""
    first, *others = refereed(tmp_path, number, digits, row, wrong).explanations
    assert [told(change) for change in first.changes] == [reading(row, wrong)]
    assert all(len(each.changes) == 1 for each in others)


def test_a_number_that_is_no_slip_is_found_to_all_digits(tmp_path: Path) -> None:
    """Two values of a reading have the published scatter, and a search ends between them."""
    (first,) = refereed(tmp_path, 10, 9, 6, "271.3").explanations
    assert [told(change) for change in first.changes] == [reading(6, "271.3")]


def test_so_it_is_of_a_curve_to_which_a_search_leads(tmp_path: Path) -> None:
    """Misra1a: y[8] is no slip of 44.82, and each result has eleven digits."""
    for file in (DATA / "misra1a").iterdir():
        if file.is_file():
            (tmp_path / file.name).write_bytes(file.read_bytes())
    table = tmp_path / "measurements.csv"
    text = table.read_text(encoding="utf-8")
    assert text.count(",44.82\n") == 1
    table.write_text(text.replace(",44.82\n", ",55.90\n"), encoding="utf-8")
    first, *_ = Study(tmp_path).refereed.referee.explanations
    assert [told(change) for change in first.changes] == [("misprint", "y", (8,), "55.90", "44.82")]


SUMS = """
from loopsheet import Method, given, let

class Sums(Method):
    "Of three numbers."
    a = given("m", "one")
    b = given("m", "another")
    c = given("m", "a third")
    x = let(3 * a, "three of one")
    z = let(a + b, "sum of two")
    w = let(b + c, "sum of the others")
"""


@pytest.mark.parametrize("printed", ["0.19", "0.29", "7.19"])
def test_a_digit_may_be_lost_by_more_than_ten_times(tmp_path: Path, printed: str) -> None:
    """Beyond where a certificate says that nothing comes out there are slips: 0.19 for 2.19."""
    published = "source,cell,index,value,unit\nT,x,,6.57,m\nT,z,,5.60,m\nT,w,,8.53,m\n"
    more = f'[parameters]\na = "{printed} m"\nb = "3.41 m"\nc = "5.12 m"\n'
    method_folder(tmp_path, SUMS, more=more, published=published)
    first, *_ = Study(tmp_path).refereed.referee.explanations
    assert [(each.cell, each.would_print) for each in first.changes] == [("a", "2.19")]
