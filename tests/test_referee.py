"""Published values beside their recomputation, and what the referee says of the paper's."""

from __future__ import annotations

import re
import shutil
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import pytest
from helpers import method_folder
from hypothesis import given
from hypothesis import strategies as st
from small_report import found, judged, pure
from sympy import Sum, Symbol

from loopsheet.derivations.equation import Equation, Kind
from loopsheet.report.cli import main
from loopsheet.report.distribution import Error
from loopsheet.report.engines import numpy as engine
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.inputs.published import PublishedValue
from loopsheet.report.messages.errors import InputError
from loopsheet.report.quantity import Printed
from loopsheet.report.referee import print_as, prints_same
from loopsheet.report.result.findings import checks
from loopsheet.report.result.result import Report
from loopsheet.report.result.verdict import EXACT, REACHABLE, UNEXPECTED, UNREACHABLE, WITHIN, Referee
from loopsheet.report.result.verdict_words import lines
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.stages import refereed, refereed_values
from loopsheet.report.study import Study


def printed(text: str, unit: str = "1", scale: Fraction = Fraction(1)) -> Printed:
    """A printed number without a file."""
    return Printed(text, unit, Fraction(text) * scale, scale)


@pytest.mark.parametrize(
    ("value", "like", "again"),
    [
        (1.2579969787, printed("1.234"), "1.258"),
        (1.2, printed("1.30"), "1.20"),
        (4.15439e-05, printed("41.61", "um", Fraction(1, 10**6)), "41.54"),
        (1524.587, printed("1516"), "1525"),
        (1524.587, printed("15e2"), "1500"),
        (-0.0004, printed("0.12"), "-0.00"),
        (2.5, printed("7"), "3"),
        (2.5, printed("2"), "2"),  # a half may have gone either way
        (-2.5, printed("-3"), "-3"),
        (0.0437225, printed("0.043722"), "0.043722"),
        (0.04372249999999999, printed("0.043723"), "0.043723"),  # on whichever side the double lies
        (0.0437224999999999, printed("0.043723"), "0.043722"),
        (1e70, printed("1.50"), f"1{'0' * 70}.00"),
        (238.94213, printed("2.3894e+02"), "238.94"),
        (1.2345, printed("+1.50"), "1.23"),
    ],
)
def test_printed_again_in_the_same_digits(value: float, like: Printed, again: str) -> None:
    assert print_as(value, like) == again


@pytest.mark.parametrize(
    ("value", "text", "same"),
    [
        (238.942129181, "2.3894212918e+02", True),
        (238.942129181, "238.94212918", True),
        (238.942129186, "2.3894212918e+02", False),
        (1.504, "+1.50", True),
        (1.504, "1.50", True),
        (1.504, "1.500", False),  # zeros at the end are digits
        (1.504, "15e-1", True),
        (-1.504, "1.50", False),
        (1524.587, "1.5e3", True),
        (1524.587, "1500", False),
        (-0.0004, "0.000", True),
        (float("nan"), "1.50", False),
    ],
)
def test_it_prints_the_same_by_value_and_decimals_not_by_text(value: float, text: str, same: bool) -> None:
    assert prints_same(value, printed(text)) is same


def test_a_truncated_number_is_not_cut_below_itself() -> None:
    """Most decimal numbers have no double: half of these are a little more than the nearest."""
    for hundredths in range(1, 10000):
        text = f"{hundredths / 100:.2f}"
        like = replace(printed(text, "um", Fraction(1, 10**6)), mode="truncated")
        assert prints_same(float(like.value), like)
        assert prints_same(float(like.value + Fraction(199, 100) * like.half_unit), like)
        assert not prints_same(float(like.value - Fraction(1, 100) * like.half_unit), like)
        assert not prints_same(float(like.value + Fraction(201, 100) * like.half_unit), like)
    longest = replace(printed("0.123456789012345"), mode="truncated")
    assert prints_same(0.123456789012345, longest)
    assert not prints_same(0.123456789012344, longest)


@given(st.floats(-1e6, 1e6), st.integers(0, 9))
def test_printing_moves_a_value_by_half_a_digit_at_most(value: float, decimals: int) -> None:
    """And by what rounding to fifteen digits does before: a double is a little beside what it stands for."""
    like = printed("1." + "0" * decimals if decimals else "1")
    beside = abs(Fraction(value)) * Fraction(5, 10**15)
    assert abs(Fraction(Decimal(print_as(value, like))) - Fraction(value)) <= like.half_unit + beside


def test_the_paper_value_by_value(report: Report) -> None:
    """All 27 published values are compared; each known difference differs, none is hidden."""
    comparisons = report.comparisons
    assert len(comparisons) == 27
    assert {c.published.source for c in comparisons} == {"Table 2", "Table 3", "text"}
    assert all(c.as_expected for c in comparisons)
    first = comparisons[0]
    assert (first.published.printed.text, first.again, first.verdict) == ("1.234", "1.258", "differs")
    assert first.distance == pytest.approx(23.996978731236837, rel=1e-12)


# --- the referee on the paper -----------------------------------------------------------------------------


def of_kind(found: Referee, kind: str) -> list[tuple[str, tuple[int, ...]]]:
    return [(each.first.cell, each.first.index) for each in found.explanations if each.first.kind == kind]


def test_two_pairs_are_out_of_reach_by_themselves(paper: Report) -> None:
    """Both are certain, and what is reached comes close to what is certain."""
    out = {c.published.index: c for c in paper.comparisons if c.word == UNREACHABLE}
    assert set(out) == {(2, 4), (2, 5)}
    assert all(c.word == REACHABLE for c in paper.comparisons if c.published.index not in out)
    for comparison in out.values():
        found, printed = comparison.refereed, comparison.published.printed
        assert found is not None
        assert found.high is not None
        assert found.bound_high is not None
        assert found.high <= found.bound_high < float(printed.interval[0])
        assert found.bound_high - found.high < 0.25 * float(printed.half_unit)
    highest = [out[pair].refereed.high for pair in ((2, 4), (2, 5))]  # type: ignore[union-attr]
    assert highest == pytest.approx([1.3119, 1.3231], abs=5e-5)


def test_what_is_reachable_has_a_witness_that_prints_as_given_and_yields_it(paper: Report) -> None:
    """Asked for alone, and put into the sheet again, that gives the published cell in its digits."""
    prepared = Study(PAPER).prepared
    tried = 0
    for comparison in paper.comparisons:
        found, published = comparison.refereed, comparison.published
        assert found is not None
        free = published.cell in paper.referee.free or published.source == "Table 3"
        if found.verdict != REACHABLE or free:
            continue
        data = {name: list(x) if isinstance(x, list) else x for name, x in prepared.data.items()}
        alone = replace(prepared, inputs=replace(prepared.inputs, published=(published,)))
        joint = refereed_values(alone, paper.values)[0].joint
        assert joint is not None
        assert joint.verdict == REACHABLE
        assert joint.witness
        for each in joint.witness:
            if each.cell in paper.referee.free:
                continue
            row = each.index[0] - 1 if each.index else 0
            given = prepared.inputs.printed(each.cell)[row]
            assert given is not None
            low, high = given.interval
            within = Fraction(1, 10**12) * abs(given.value)
            assert low - within <= Fraction(each.value) * given.scale <= high + within
            if each.index:
                data[each.cell][row] = each.value * float(given.scale)
            else:
                data[each.cell] = each.value * float(given.scale)
        value = (
            engine.evaluate(prepared.sheet, prepared.labels, data).cell(published.cell, published.index).value
        )
        assert value is not None
        assert abs(Fraction(value) - published.printed.value) <= published.printed.half_unit * (
            1 + Fraction(1, 10**6)
        )
        tried += 1
    assert tried == 9


def test_table_2_cannot_come_from_table_1(paper: Report) -> None:
    tables = {table.source: table for table in paper.referee.tables}
    assert tables["Table 2"].verdict == UNREACHABLE
    assert tables["Table 2"].mismatch == pytest.approx(8.4, abs=0.05)
    assert tables["Table 2"].at_least is not None
    assert tables["Table 2"].at_least > 6
    assert tables["text"].verdict == REACHABLE
    joint = paper.referee.joint
    assert joint is not None
    assert joint.verdict == UNREACHABLE
    assert joint.values == 27


def test_what_would_explain_it_and_nothing_else(paper: Report) -> None:
    found = paper.referee
    assert sorted(of_kind(found, "misprint")) == [("e", (2,)), ("x_p", (2,))]
    assert of_kind(found, "truncated") == [("x_p", ())]
    assert len(found.explanations) == 3
    would = {each.first.cell: each for each in found.explanations if each.first.kind == "misprint"}
    assert would["x_p"].first.would_print == "29.8"
    assert would["x_p"].first.also == ()
    assert would["x_p"].mismatch == pytest.approx(0.76, abs=0.005)
    assert would["e"].first.would_print == "0.514"
    assert "0.515" in would["e"].first.also
    assert all(each.mismatch <= 1 and each.count == 1 for each in found.explanations)
    assert all(each.values == each.of == 27 for each in found.explanations)


def test_rows_of_table_3_are_relabelled(paper: Report) -> None:
    assert [(each.printed, each.right, each.cell) for each in paper.referee.labels] == [
        ("(6)", "(7)", "Cprime_eq7"),
        ("(8)", "(9)", "Cprime_eq9"),
    ]


def test_rows_are_relabelled_where_a_datum_is_missing(tmp_path: Path) -> None:
    """What rests on it has no value: a row can be compared as one column, and as another it cannot."""
    folder = shutil.copytree(PAPER, tmp_path / "steel")
    table, published = folder / "measurements.csv", folder / "published.csv"
    table.write_text(table.read_text(encoding="utf-8").replace("0.479", ""), encoding="utf-8")
    rows = published.read_text(encoding="utf-8").splitlines(keepends=True)
    published.write_text("".join(row for row in rows if re.match("source|.*,Cprime_", row)), encoding="utf-8")
    report = refereed(Study(folder).computed)
    lost = [each for each in report.comparisons if each.verdict == "not-checkable"]
    assert [(each.cell.name, each.cell.label) for each in lost] == [("Cprime_eq7", (3,))]
    told = [line.strip() for line in lines(report.referee, lambda _: "") if line.startswith("  label ")]
    assert [re.findall("Cprime_eq.", line) for line in told] == [
        ["Cprime_eq7", "Cprime_eq9"],
        ["Cprime_eq9", "Cprime_eq7"],
    ]


def test_the_fit_is_the_log_log_one(paper: Report) -> None:
    fits = {fit.published.cell: fit for fit in paper.referee.fits}
    assert fits["alpha_log"].best == "alpha_log"
    assert fits["alpha_log"].mismatch["alpha_log"] <= 1 < fits["alpha_log"].mismatch["alpha_mean"]
    assert fits["alpha_log"].mismatch["alpha_lin"] > 20


def test_with_the_known_misprint_put_right_everything_comes_out(paper: Report) -> None:
    amended = paper.referee.amended
    assert amended is not None
    assert amended.verdict == REACHABLE
    assert paper.referee.misprints == ()
    assert all(c.as_expected for c in paper.comparisons)


def changed(tmp_path: Path, file: str, before: str, after: str) -> Report:
    """The paper with another print somewhere, refereed."""
    return refereed(computed(tmp_path, file, before, after))


def computed(tmp_path: Path, file: str, before: str, after: str) -> Report:
    folder = tmp_path / "campaign"
    shutil.copytree(PAPER, folder)
    text = (folder / file).read_text(encoding="utf-8")
    assert before in text
    (folder / file).write_text(text.replace(before, after), encoding="utf-8")
    return Study(folder).computed


@pytest.mark.parametrize(
    ("before", "after", "cell", "would"),
    [
        ("alpha,1-2,1.234", "alpha,1-2,1.239", ("alpha", (1, 2)), "1.234 (or 1.233, 1.235, 1.236)"),
        ("x_m,3,55.34", "x_m,3,55.43", ("x_m", (3,)), "55.34 (or "),
        ("Cprime_eq9,4,3263", "Cprime_eq9,4,3236", ("Cprime_eq9", (4,)), "3263 (or "),
    ],
)
def test_a_broken_published_value_is_named(
    tmp_path: Path, before: str, after: str, cell: object, would: str
) -> None:
    """Each was known to differ, and now differs otherwise; the slip that was made is named first."""
    report = changed(tmp_path, "published.csv", before, after)
    failed = [check for check in checks(report) if not check.passed]
    assert [(c.cell.name, c.cell.label) for c in report.comparisons if not c.as_expected] == [cell]
    assert sorted(check.kind for check in failed) == ["published", "table"]
    assert "differs otherwise than is known" in failed[0].message
    assert f"is printed {after.rsplit(',', maxsplit=1)[-1]} for {would}" in failed[1].message


def test_a_column_in_another_unit_is_named_where_what_is_free_was_fitted_to_it(tmp_path: Path) -> None:
    """The coefficient of the fit is not printed, and is off by a factor of 10^7 or so with the column."""
    report = changed(tmp_path, "measurements.csv", "x_p [um]", "x_p [mm]")
    said = [check.message for check in checks(report) if check.name == "known misprints"]
    assert "perhaps the numbers of x_p are to be multiplied by 1e-3: then all 27" in said[0]


def test_a_misprint_that_is_no_longer_needed_is_a_finding(tmp_path: Path) -> None:
    report = changed(tmp_path, "measurements.csv", "29.7", "29.8")
    failed = [check for check in checks(report) if not check.passed]
    assert [check.name for check in failed if check.kind == "table"] == ["known misprints"]
    assert "differs otherwise than is known (1.234 -> 1.258)" in failed[0].message
    assert report.referee.joint is not None
    assert report.referee.joint.verdict == REACHABLE
    assert report.referee.explanations == ()


def test_a_stated_uncertainty_may_reach_further_than_the_digits(tmp_path: Path) -> None:
    header = "test,v [m/s],e [1],x_p [um]\n1,2.334,0.530,23.5\n2,2.940,0.512,29.7\n"
    wide = "test,v [m/s],e [1],x_p [um],u(x_p) [um]\n1,2.334,0.530,23.5,0.03\n2,2.940,0.512,29.7,0.3\n"
    rows = "3,4.089,0.479,41.6\n4,4.504,0.467,45.97\n5,4.993,0.453,51.03"
    report = changed(
        tmp_path, "measurements.csv", header + rows, wide + rows.replace("\n", ",0.03\n") + ",0.03"
    )
    words = {c.published.index: c.word for c in report.comparisons if c.published.source == "Table 2"}
    assert words[2, 4] == WITHIN
    assert words[1, 2] == REACHABLE


@pytest.mark.parametrize(
    ("text", "mode", "verdict"),
    [
        *(("30.999999999", "rounded", WITHIN), ("31.000000001", "rounded", UNREACHABLE)),
        *(("29.000000001", "rounded", WITHIN), ("28.999999999", "rounded", UNREACHABLE)),
        *(("30.999999999", "truncated", WITHIN), ("31.000000000", "truncated", UNREACHABLE)),
        *(("29.000000000", "truncated", WITHIN), ("28.999999999", "truncated", UNREACHABLE)),
    ],
)
def test_uncertainties_combine_in_quadrature_and_cover_twice(text: str, mode: str, verdict: str) -> None:
    """JCGM 100:2008, (10) and 6.3.3: u(a) = 0.3 and u(b) = 0.4 are 0.5 in a + b, twice that is covered.

    What was truncated stands for a number that is half a unit larger on the average.
    """
    k, n = (Symbol(name, integer=True, positive=True) for name in "kn")
    a, b = (Column(name, Axis("rows", k, n), Given()) for name in "ab")
    total = Formula(Equation("", (Symbol("y"), a[k] + b[k]), "for a test", Kind.DEFINITION))
    sheet = Sheet((a, b, Column("y", a.axis, total)))
    measured = {
        name: [replace(pure(digits), stated=(Error(Fraction(u), said=f"u = {u}"),))]
        for name, digits, u in (("a", "10.000", "0.3"), ("b", "20.000", "0.4"))
    }
    printed = replace(pure(text), mode=mode)
    (comparison,) = judged(sheet, measured, {}, lambda _: [PublishedValue("Table", "y", (1,), printed)])
    found = comparison.refereed
    assert found is not None
    assert found.verdict == verdict
    assert comparison.finding == UNEXPECTED


def _stated(u: str, said: str) -> tuple[Error, ...]:
    return (Error(Fraction(u), said=said),)


@pytest.mark.parametrize(
    ("stated", "text", "verdict"),
    [
        (None, "30.7", REACHABLE),
        ((), "30.7", UNREACHABLE),
        ((), "30.0", EXACT),
        (_stated("0.0001", "u = 0.0001"), "30.7", UNREACHABLE),
        (_stated("0.0001", "u = 0.0001"), "30.0003", REACHABLE),
        (_stated("0.0001", "u = 0.0001"), "30.0006", UNREACHABLE),
        (_stated("3", "u = 3"), "30.7", REACHABLE),
        (_stated("0", "scatter"), "30.7", REACHABLE),
    ],
)
def test_what_is_stated_of_a_number_holds_it_closer_than_its_digits(
    stated: tuple[Error, ...] | None, text: str, verdict: str
) -> None:
    """A typed 10 that is exact, or known to 0.0001, is not 10.4; how much readings scatter holds none."""
    k, n = (Symbol(name, integer=True, positive=True) for name in "kn")
    x = Column("x", Axis("rows", k, n), Given())
    mean = Formula(Equation("", (Symbol("y"), 2 * Sum(x[k], (k, 1, n)) / n), "for a test", Kind.DEFINITION))
    sheet = Sheet((x, Column("y", None, mean)))
    measured = {"x": [replace(pure(digits), stated=stated) for digits in ("10", "20")]}
    (comparison,) = judged(sheet, measured, {}, lambda _: [PublishedValue("Table", "y", (), pure(text))])
    assert comparison.refereed is not None
    assert comparison.refereed.verdict == verdict
    assert comparison.as_expected is (verdict in (EXACT, REACHABLE))


OILS = """\
from loopsheet import Method, given, let


class Oil(Method):
    \"\"\"Viscosity by a capillary.\"\"\"

    C = given("mm^2/s^2", "constant of the capillary")
    t = given("s", "flow time")
    nu = let(C * t, "kinematic viscosity", "mm^2/s")
"""


@pytest.mark.parametrize(
    ("published", "word", "failed", "summary"),
    [
        ("104.22,", EXACT, 0, "1 value: 1 prints the same"),
        ("104.40,", WITHIN, 3, "1 differs within the stated uncertainties alone\n"),
        ("104.50,", WITHIN, 3, "1 differs within the stated uncertainties alone\n"),
        ("104.60,", UNREACHABLE, 3, "0 print the same, 0 differ as is known, 1 differs otherwise\n"),
        ("104.40,differs", WITHIN, 0, "1 differs as is known"),
    ],
)
def test_an_error_of_arithmetic_is_none_of_measurement(
    tmp_path: Path, published: str, word: str, failed: int, summary: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """C is known to 0.35 % alone, and whoever multiplies what is printed gets 104.22 all the same."""
    more = '[parameters]\nC = "0.1003000 mm^2/s^2, U = 0.35 %, k = 2"\nt = "1039.07 s"\n'
    rows = f"value,unit,expect,recomputed,reason,cell,index,source\n{published.partition(',')[0]},mm^2/s,"
    rows += f"{published.partition(',')[2]},{'104.40 -> 104.22,measured apart' if 'd' in published else ','},"
    method_folder(tmp_path, OILS, more=more, published=f"{rows}nu,,Report 7\n")
    report = refereed(Study(tmp_path).computed)
    (comparison,) = report.comparisons
    assert comparison.word == word
    assert sum(not check.passed for check in checks(report)) == failed
    assert main(["check", str(tmp_path)]) == bool(failed)
    told = capsys.readouterr().out
    assert summary in told
    assert ("everything as expected" in told) is (not failed)
    assert ("another measurement would explain it" in told) is (word == WITHIN)


def test_a_truncated_column_is_no_misprint(tmp_path: Path) -> None:
    report = changed(
        tmp_path, "report.toml", "[published]\n", '[measurements.printed]\nx_p = "truncated"\n\n[published]\n'
    )
    assert report.referee.joint is not None
    assert report.referee.joint.verdict == REACHABLE


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('"x_q[2]" = "29.8"', "the sheet has no cell 'x_q'"),
        ('"x_p[7]" = "29.8"', "x_p has no index '7'"),
        ('"x_p[2]" = "29,8"', "29.8"),
        ('"x_p[2]" = 29.8', "quotes"),
    ],
)
def test_a_wrong_erratum_is_refused_with_its_place(tmp_path: Path, line: str, said: str) -> None:
    with pytest.raises(InputError) as error:
        changed(tmp_path, "report.toml", '"x_p[2]" = "29.8"', line)
    assert said in str(error.value)
    assert "report.toml:" in str(error.value)


@pytest.mark.parametrize("line", ['free = "C_log"', "free = [1]", 'free = ["C_lag"]'])
def test_wrong_free_cells_are_refused_with_their_place(tmp_path: Path, line: str) -> None:
    with pytest.raises(InputError) as error:
        changed(tmp_path, "report.toml", 'free = ["ball_density", "alpha_log", "C_log"]', line)
    assert "report.toml:" in str(error.value)


def test_a_published_column_may_be_truncated(tmp_path: Path) -> None:
    """What it stands for moves up by half a unit, and with it what is asked."""
    report = changed(
        tmp_path,
        "report.toml",
        "[published.errata]",
        '[published.printed]\nalpha = "truncated"\n\n[published.errata]',
    )
    printed = {c.published.cell: c.published.printed for c in report.comparisons}
    assert printed["alpha"].interval == (
        printed["alpha"].value,
        printed["alpha"].value + 2 * printed["alpha"].half_unit,
    )
    assert printed["x_m"].mode == "rounded"
    with pytest.raises(InputError, match="LS208"):
        changed(
            tmp_path / "again",
            "report.toml",
            "[published.errata]",
            '[published.printed]\nalpha = "cut"\n\n[published.errata]',
        )


def asked_of_sums(*texts: str, u: str = "0.3") -> Referee:
    """What the referee says of published values of a + b, 2 a + b and a + 2 b: a is 10.000, b 20.000."""
    k, n = (Symbol(name, integer=True, positive=True) for name in "kn")
    a, b = (Column(name, Axis("rows", k, n), Given()) for name in "ab")
    right = {"y": a[k] + b[k], "z": 2 * a[k] + b[k], "w": a[k] + 2 * b[k]}
    equations = {
        name: Equation("", (Symbol(name), r), "a test", Kind.DEFINITION) for name, r in right.items()
    }
    sheet = Sheet((a, b, *(Column(name, a.axis, Formula(eq)) for name, eq in equations.items())))
    stated = None if u == "digits" else (Error(Fraction(u), said=f"u = {u}"),)
    measured = {name: [replace(pure(x), stated=stated)] for name, x in (("a", "10.000"), ("b", "20.000"))}
    published = [
        PublishedValue("Table", name, (1,), pure(text)) for name, text in zip(right, texts, strict=False)
    ]
    return found(sheet, measured, published)


@pytest.mark.parametrize(
    ("texts", "alone", "together"),
    [
        (("30.300", "40.400", "50.500"), {WITHIN}, WITHIN),  # of 10.1 and 20.2, which nobody has printed
        (("30.300", "40.400", "50.600"), {WITHIN}, UNREACHABLE),  # each is near, all of them fit no input
        (("30.300", "40.400", "55.500"), {WITHIN, UNREACHABLE}, UNREACHABLE),
        (("30.000", "40.000", "50.000"), {EXACT}, EXACT),
    ],
)
def test_stated_uncertainties_explain_what_digits_do_not(
    texts: tuple[str, ...], alone: set[str], together: str
) -> None:
    referee = asked_of_sums(*texts)
    assert {verdict.verdict for verdict in referee.values} == alone
    assert referee.joint is not None
    assert [table.verdict for table in (*referee.tables, referee.joint)] == [together] * 2
    said = list(lines(referee, str))
    told = "another measurement would explain it, the printed digits by themselves do not" in said[0]
    assert told == (together == WITHIN)
    # nobody is accused of what is explained, and of what is not still somebody is asked for
    assert referee.asked_why == (together == UNREACHABLE)
    assert len(said) == 2 or referee.asked_why


def test_without_a_statement_the_digits_have_to_explain_it() -> None:
    referee = asked_of_sums("30.300", "40.400", "50.500", u="digits")
    assert {verdict.verdict for verdict in referee.values} == {UNREACHABLE}
    assert referee.joint is not None
    assert (referee.joint.verdict, referee.asked_why) == (UNREACHABLE, True)


def test_an_error_that_tests_share_reaches_as_far_as_it_is_stated(tmp_path: Path) -> None:
    """A table that was made with the datum 0.3 um deeper: no digits allow it, and the statement does."""
    header = "source,cell,index,value,unit\n"
    report = computed(tmp_path, "measurements.csv", "23.5", "23.8")
    moved = "".join(
        f"Table,alpha,{i}-{j},{report.values.cell('alpha', (i, j)).value:.4f},1\n"
        for i, j in [(1, 2), (1, 3)]
    )
    (tmp_path / "measurements.csv").write_bytes((PAPER / "measurements.csv").read_bytes())
    (tmp_path / "published.csv").write_text(header + moved, encoding="utf-8")
    toml = (PAPER / "report.toml").read_text(encoding="utf-8").partition("[published")[0]
    toml += '[published]\nfile = "published.csv"\n'
    for more, word in (("", UNREACHABLE), (SHARED, WITHIN)):
        (tmp_path / "report.toml").write_text(toml + more, encoding="utf-8")
        referee = refereed(Study(tmp_path).computed).referee
        assert referee.joint is not None
        assert referee.joint.verdict == word
        assert referee.asked_why == (word == UNREACHABLE)


SHARED = '[uncertainty.shared.datum]\nof = "x_p"\nstated = "u = 0.2 um"\ngroups = [[1]]\n'


ENERGY = """\
from loopsheet import Method, constant, let, measured


class Energy(Method, rows="runs"):
    \"\"\"RT by the run, and twice that.\"\"\"

    T = measured("K", "temperature")
    R = constant("molar gas constant")
    E = let(R * T, "energy", "kJ/mol")
    twice = let(2 * E, "twice the energy", "kJ/mol")
"""


@pytest.mark.parametrize(
    ("published", "perhaps"),
    [
        ("E,1,2.497\nT,twice,2,13.00", "twice[2] of T is printed 13.00 for 12.00: "),
        ("E,1,2.598\nT,E,2,6.242\nT,twice,2,12.48", "T[1] is printed 300.32 for 312.4"),
    ],
)
def test_a_constant_of_nature_is_never_suspected(tmp_path: Path, published: str, perhaps: str) -> None:
    """By R = 9.0 or 8.65 all would come out; it is exact, and nobody typed it."""
    rows = "".join(f"{line},kJ/mol\n" for line in f"T,{published}".splitlines())
    said = f"source,cell,index,value,unit\n{rows}"
    method_folder(tmp_path, ENERGY, "run,T [K]\n1,300.32\n2,721.65\n", published=said)
    report = refereed(Study(tmp_path).computed)
    found = lines(report.referee, lambda _: "")
    told = [line for line in found if "perhaps" in line]
    assert perhaps in told[0]
    assert not any("R " in line for line in told)


EXACT_ROWS = """\
from loopsheet import Method, count, groups, let, measured


class Lines(Method, rows="lines"):
    \"\"\"Squares of whole numbers.\"\"\"

    j = measured("1", "quantum number", exact=True)
    of = groups("series")
    q = let(1 / j**2, "inverse square")
    c = let(count(j, of=of), "lines of a series")
"""


@pytest.mark.parametrize(
    ("published", "right"),
    [
        ("q,1,0.1111\nT,q,2,0.0625\nT,q,3,0.0400", True),
        ("q,1,0.1111\nT,q,2,0.0139\nT,q,3,-0.0311", False),
        ("c,A,2\nT,c,B,1", True),
        ("c,A,2\nT,c,B,0", False),
    ],
)
def test_what_rests_on_nothing_that_may_move_is_what_it_is(
    tmp_path: Path, published: str, right: bool
) -> None:
    """Each row by itself: no rounding of the first one is that of the others."""
    rows = "".join(f"{line},1\n" for line in f"T,{published}".splitlines())
    said = f"source,cell,index,value,unit\n{rows}"
    method_folder(tmp_path, EXACT_ROWS, "line,series,j [1]\n1,A,3\n2,A,4\n3,B,5\n", published=said)
    found = refereed(Study(tmp_path).computed)
    assert found.referee is not None
    assert {each.refereed.verdict for each in found.comparisons if each.refereed} == (
        {EXACT} if right else {EXACT, UNREACHABLE}
    )


@pytest.mark.parametrize(
    ("x", "y", "perhaps"),
    [
        ("210", "402.0", ["or perhaps x[1] is printed 210 for 201: then all 2 published values come out"]),
        ("210", "436.0", ["or perhaps x[1] is printed 210 for 218"]),
        ("210", "414.0", []),  # 207 is no slip of it
    ],
)
def test_within_uncertainty_a_slip_is_a_possibility(x: str, y: str, perhaps: list[str]) -> None:
    """With u = 10.9 another measurement explains it, and a swapped digit does so, too: it stays a finding."""
    k, n = (Symbol(name, integer=True, positive=True) for name in "kn")
    given = Column("x", Axis("rows", k, n), Given())
    rules = {
        name: Formula(Equation("", (Symbol(name), by * given[k]), "for a test", Kind.DEFINITION))
        for name, by in (("y", 2), ("z", 4))
    }
    sheet = Sheet((given, *(Column(name, given.axis, rule) for name, rule in rules.items())))
    printed = [replace(pure(x), stated=_stated("10.9", "u = 10.9"))]
    published = [
        PublishedValue("T", name, (1,), pure(text)) for name, text in (("y", y), ("z", f"{2 * float(y):.1f}"))
    ]
    of = found(sheet, {"x": printed}, published)
    assert of.joint is not None
    assert (of.joint.verdict, of.explanations) == (WITHIN, ())
    told = [line.strip() for line in lines(of, lambda _: "") if "perhaps" in line]
    assert len(told) == len(perhaps)
    assert all(line.startswith(start) for line, start in zip(told, perhaps, strict=True))
