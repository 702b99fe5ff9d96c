"""Pairs of rows in a method of one's own, and the tables that it declares."""

import re
from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from helpers import method_folder

import loopsheet
from loopsheet.report.cli import main
from loopsheet.report.column import SheetError
from loopsheet.report.document.material import Material
from loopsheet.report.method import words
from loopsheet.report.study import Study

SEN = """
from sympy import sqrt
from loopsheet import Method, claim, count, let, mean, measured, median, pairs, plot, table, total

class Sen(Method, source="P K Sen, J. Am. Stat. Assoc. 63 (1968) 1379", headline="b middle"):
    "Slopes of all pairs."
    x = measured("s", "time")
    y = measured("degC", "temperature")
    first, second = pairs()
    rise = let(second(y) - first(y), "rise")
    slope = let(rise / (second(x) - first(x)), "slope of a pair")
    b = let(mean(slope), "mean slope")
    middle = let(median(slope), "Sen's slope")
    steepest = let(max(slope), "greatest slope")
    spread = let(sqrt(total((slope - b)**2) / (count(slope) - 1)), "scatter of the slopes")
    level = let(mean(y - b * x), "intercept", like=y)
    of_both = let(total(first(x) * second(x)), "sum of products")
    claim(of_both, (total(x)**2 - total(x**2)) / 2, "products of pairs", from_=[of_both])
    claim(total(rise), total(second(y) - first(y)), "rises")
    plot(rise, slope)
    table("Slopes of pairs", slope, rise, note="Not all are alike.")
"""
X, Y = (1, 2, 3, 4, 10, 12, 18), (9, 15, 19, 20, 45, 55, 78)


def folder(path: Path, code: str = SEN) -> Path:
    rows = "".join(f"{n},{x},{y}\n" for n, (x, y) in enumerate(zip(X, Y, strict=True), start=1))
    more = '[uncertainty]\nx = "exact"\ny = "u = 0.5 delta_degC"\n'
    return method_folder(path, code, f"reading,x [s],y [degC]\n{rows}", more)


def test_every_pair_has_a_value(tmp_path: Path) -> None:
    report = Study(folder(tmp_path)).computed
    both = list(combinations(range(7), 2))
    slopes = np.array([(Y[j] - Y[i]) / (X[j] - X[i]) for i, j in both])
    assert report.values.value["slope"] == pytest.approx(slopes, rel=1e-14)
    assert report.sheet["slope"].unit == "K/s"
    assert report.values.labels(report.sheet["slope"])[1] == (1, 3)
    names = ("b", "middle", "steepest", "spread", "level", "of_both")
    found = {name: report.values.scalar(name) for name in names}
    level = np.mean(np.array(Y) - slopes.mean() * np.array(X)) + 273.15
    products = sum(X[i] * X[j] for i, j in both)
    known = {"b": slopes.mean(), "middle": 4, "steepest": slopes.max()}  # Sen's example: 4
    known |= {"spread": slopes.std(ddof=1), "level": level, "of_both": products}
    assert found == pytest.approx(known, rel=1e-14)


def test_what_pairs_share_is_one_error(tmp_path: Path) -> None:
    report = Study(folder(tmp_path)).computed
    u = report.uncertain().u["b"][0]
    by_y = np.zeros(7)
    for i, j in combinations(range(7), 2):
        by_y[[i, j]] += np.array([-1, 1]) / (X[j] - X[i]) / 21
    assert u == pytest.approx(0.5 * np.sqrt((by_y**2).sum()), rel=1e-12)


def test_what_is_summed_over_pairs_needs_no_line_of_its_own(tmp_path: Path) -> None:
    code = SEN.partition("    rise")[0].replace('headline="b middle"', 'headline="m many"')
    code += (
        "    m = let(mean(second(x) - first(x)), 'mean distance')\n    many = let(count(first(x)), 'pairs')\n"
    )
    report = Study(folder(tmp_path, code)).computed
    apart = [b - a for a, b in combinations(X, 2)]
    assert report.values.scalar("m") == pytest.approx(np.mean(apart), rel=1e-14)
    assert report.values.scalar("many") == 21
    assert [spec.name for spec in Material(report).specs] == ["readings", "scalars"]


def test_every_engine_and_proof(tmp_path: Path, every_engine: Callable[..., str]) -> None:
    told = every_engine(folder(tmp_path), code=1)
    # That sum of products is one of powers for any number of rows: true, and no algebra of sums shows it.
    assert re.findall(r"(?m)^finding: (.*) is", told) == ["(9)"]


def test_a_false_claim_of_pairs_is_refuted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wrong = SEN.replace("total(second(y) - first(y))", "total(first(y) - second(y))")
    assert main(["check", str(folder(tmp_path, wrong))]) == 1
    told = capsys.readouterr().out
    assert "(10) is refuted" in told
    assert any("(10) is refuted" in said for said in loopsheet.load(tmp_path).findings)
    assert "(10), rises, does not hold of these data: its sides differ by" in told


def test_a_table_comes_first_and_the_rest_follows(tmp_path: Path) -> None:
    report = Study(folder(tmp_path)).computed
    shown = {spec.name: spec.columns for spec in Material(report).specs}
    assert list(shown) == ["table_1", "readings", "scalars"]
    assert shown["table_1"] == ("slope", "rise")
    assert shown["scalars"] == ("b", "middle", "steepest", "spread", "level", "of_both")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("z = let(first(y) - y, 'both')", "names a row and a pair of rows: say first(...) or second(...)"),
        ("z = let(first(b), 'none')", "b has no value for each row"),
        ("z = let(first(slope), 'none')", "has no value for each row"),
        ("one, other = pairs()", "pairs() is asked for twice"),
        ("pair = given('1', 'x')", "pair is the pair's number: call that otherwise, index='...' in pairs()"),
        ("j = given('1', 'x')", "j is the number of one of two: call that otherwise, members='...' in"),
        ("table('T', x, slope)", "the table 'T' is of one kind of rows, or of single numbers, not of x or"),
        ("table('T')", "not of nothing"),
        ("table('T', 2 * x)", "2*x[k] is not declared"),
    ],
)
def test_what_is_refused_of_pairs_and_tables(line: str, said: str) -> None:
    with pytest.raises(SheetError, match=re.escape(said)):
        exec(f"{SEN}    {line}\n", {**vars(words), **vars(loopsheet)})
