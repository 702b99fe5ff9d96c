"""What is odd about a campaign's own data: found, located, told everywhere, until somebody expects it."""

import json
import random
import re
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import openpyxl
import pytest
from campaign_sizes import Sizes
from helpers import method_folder
from slipped_campaigns import PAPER, Slip, Texts, campaign, slips, write

from loopsheet.report import stages
from loopsheet.report.cli import main
from loopsheet.report.document.material import Material
from loopsheet.report.judge.suspects import outliers
from loopsheet.report.messages.diagnostics import Check
from loopsheet.report.messages.errors import InputError
from loopsheet.report.result.chi_square import SIGNIFICANT, freedom, largest
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import html, latex
from loopsheet.report.views.checks import FORMATS

pytestmark = pytest.mark.usefixtures("keeping")

SLIPPED = Slip("x_p", 2, up=False).of(PAPER)
TWO = {name: column[:2] for name, column in PAPER.items()}
BACKWARDS = {**TWO, "x_p": ("29.7", "23.5")}
SOUND = {
    "v": ("2.000", "2.603", "3.197", "3.791", "4.395", "4.990"),
    "e": ("0.5401", "0.5227", "0.4990", "0.4838", "0.4710", "0.4557"),
    "x_p": ("20.65", "26.55", "32.96", "39.20", "44.97", "51.41"),
}
"""On the curve of 1.3, with normal errors of the standard uncertainties that follow."""


SCATTERED = (
    "warning: chi2_eiv = 742 on 3 degrees of freedom; the probability of so much is below 1e-15: what is "
    "fitted does not describe all tests, or their standard uncertainties are understated"
)


def stated(part: float = 1) -> str:
    """Lines of report.toml: the standard uncertainties that its errors have, times a number."""
    each = ("v", 0.01, "m/s"), ("e", 0.002, "1"), ("x_p", 0.2, "um")
    return "[uncertainty]\n" + "".join(f'{name} = "u = {part * u:g} {unit}"\n' for name, u, unit in each)


def computed(folder: Path) -> Report:
    """The report of a folder, once as long as its files are the same."""
    return _computed(folder, tuple((file.name, file.read_bytes()) for file in sorted(folder.glob("*.*"))))


@lru_cache(maxsize=1)
def _computed(folder: Path, _: tuple[tuple[str, bytes], ...]) -> Report:
    return Study(folder).computed


def checks(folder: Path) -> dict[str, Check]:
    """What was checked, by kind and name."""
    found = computed(folder).oddities
    assert len({(check.kind, check.name) for check in found}) == len(found)
    return {f"{check.kind} {check.name}": check for check in found}


def told(folder: Path) -> list[str]:
    """What there is to tell, in words."""
    return [f"{check.word}: {check.message}" for check in checks(folder).values() if check.word]


def named(folder: Path) -> list[int]:
    """The tests that are named: as the one to look at, or because a cell of theirs is odd."""
    tests = re.findall(r"look at test (\d+)|\b(?:v|e|x_p)\[(\d+)\] =", "\n".join(told(folder)))
    return list(dict.fromkeys(int(test) for found in tests for test in found if test))


# --- what is found


def test_of_sound_data_there_is_nothing_to_tell(tmp_path: Path) -> None:
    assert told(write(tmp_path, SOUND, stated())) == []
    assert all(check.passed for check in checks(tmp_path).values())


@pytest.mark.parametrize(
    ("part", "says"),
    [
        (0.2, "the probability of so much is 4e-5: what is fitted does not describe all tests"),
        (30, "the probability of so little is 2e-7: the standard uncertainties of the tests are over"),
    ],
)
def test_deviations_are_neither_larger_nor_smaller_than_chance_makes_them(
    tmp_path: Path, part: float, says: str
) -> None:
    (warning,) = told(write(tmp_path, SOUND, stated(part)))
    assert says in warning
    expected = '[expected]\nchi2_eiv = "a round robin"\n'
    assert [line.partition(":")[0] for line in told(write(tmp_path, SOUND, expected + stated(part)))] == [
        "expected"
    ]


def test_a_bad_test_is_told_alone_with_what_is_left_without_it(tmp_path: Path) -> None:
    """It pulls the curve so far that tests beside it lie off by more than chance leads: these are sound."""
    depths = list(SOUND["x_p"])
    depths[4] = "52.00"
    folder = write(tmp_path, {**SOUND, "x_p": tuple(depths)}, stated())
    report = computed(folder)
    (outlier,) = outliers(report, report.workbook.squares[0])
    off = np.abs(report.values.value["z_eiv"])
    assert sum(largest(float(each), 6) < SIGNIFICANT for each in off) > 1
    assert (outlier.test, outlier.among, outlier.deviation) == (5, 6, off.max())
    assert outlier.chance == largest(float(off.max()), 6)
    message = checks(folder)["squares chi2_eiv"].message
    assert re.findall(r"(?:without|then) test (\d)", message) == ["5"]
    table = (folder / "measurements.csv").read_text().splitlines()
    table = [
        f"{line},{'left out' if not n else 'bounced twice' if n == 5 else ''}" for n, line in enumerate(table)
    ]
    (folder / "measurements.csv").write_text("\n".join([*table, ""]))
    again = computed(folder)
    assert outlier.chi2 == pytest.approx(again.values.scalar("chi2_eiv"), rel=1e-9)
    assert outlier.dof == freedom(again.workbook.squares[0], again) == 3
    # Whoever looks for another one then has had as many tries as there are pairs.
    assert not outliers(again, again.workbook.squares[0])
    assert checks(folder)["squares chi2_eiv"].message.endswith("which is what chance makes")


def test_a_second_bad_test_is_looked_for_without_the_first(tmp_path: Path) -> None:
    depths = list(SOUND["x_p"])
    depths[4], depths[1] = "52.00", "29.00"
    report = computed(write(tmp_path, {**SOUND, "x_p": tuple(depths)}, stated()))
    first, second = outliers(report, report.workbook.squares[0])
    assert {first.test, second.test} == {2, 5}
    assert second.chance == largest(second.deviation, 5, 1)
    assert (first.dof, second.dof) == (3, 2)
    assert second.chi2 < first.chi2 < report.values.scalar("chi2_eiv")


def test_a_test_that_is_in_no_group_is_told(tmp_path: Path) -> None:
    """It was measured later, say, and nobody thought of the error that its drop height has."""
    shared = '[uncertainty.shared."height datum"]\nof = "x_p"\nstated = "u = 1 um"\ngroups = '
    (warning,) = told(write(tmp_path, SOUND, stated() + f"{shared}[[1, 2], [4]]\n"))
    assert warning.startswith("warning: height datum: tests 3, 5 and 6 are in no group of it")
    assert told(write(tmp_path, SOUND, stated() + f"{shared}[[1, 2, 3, 5, 6], [4]]\n")) == []


def test_of_two_tests_nothing_is_left_over(tmp_path: Path) -> None:
    assert checks(write(tmp_path, TWO))["squares chi2_eiv"].message == "chi2_eiv: nothing left over of tests"


@pytest.mark.parametrize("up", [True, False])
def test_one_slipped_decimal_names_its_test(tmp_path: Path, up: bool) -> None:
    found = checks(write(tmp_path, Slip("x_p", 2, up).of(PAPER)))
    cells, rows = found["data cells"], found["data rows"]
    assert cells.word == rows.word == "finding"
    assert cells.message.startswith("alpha: 4 of 10 pairs have no value: ")
    assert (
        "alpha[1-2], alpha[2-3], alpha[2-4] and alpha[2-5] #NOROOT!: (11) has no root here" in cells.message
    )
    assert cells.message.endswith("; look at test 2 first: every odd pair rests on it")
    assert (cells.at.path, cells.at.line) == ((tmp_path / "measurements.csv").as_posix(), 3)
    assert rows.message.startswith("alpha_mean, alpha_median, x_ref and F_ref are over 6 of 10 pairs; ")
    assert "are over 12 of 20 points" in rows.message
    assert found["data result"].message.startswith(
        "alpha_eiv, C_eiv and chi2_eiv of the result have no value"
    )


@pytest.mark.parametrize("slip", [slip for slip in slips(PAPER) if slip.column != "v"], ids=str)
def test_every_slip_of_the_paper_names_its_test_and_no_other(tmp_path: Path, slip: Slip) -> None:
    assert named(write(tmp_path, slip.of(PAPER))) == [slip.test]


def test_a_result_without_a_value_is_a_finding(tmp_path: Path) -> None:
    found = checks(write(tmp_path, BACKWARDS))
    assert "look at" not in found["data cells"].message, "either test may be wrong"
    assert found["data result"].message == (
        "alpha_eiv, C_eiv, chi2_eiv, alpha_mean, alpha_median, alpha_log and 3 more of the result have no "
        "value, "
        "for want of alpha_eiv, v_eiv[1] and alpha[1-2]"
    )


def test_of_a_fit_without_a_value_nobody_says_over_how_many_tests_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = write(tmp_path, PAPER) / "measurements.csv"
    exact = (
        table.read_text().replace("2.940", "2.940(0)").replace("0.512", "0.512(0)").replace("29.7", "29.7(0)")
    )
    table.write_text(exact)
    found = checks(tmp_path)
    assert found["data cells"].message.startswith("test 2 has v, e and x_p without uncertainty")
    assert found["data rows"].message == "rows are left out as is expected"
    report = Study(tmp_path).computed
    assert report.values.counted["alpha_eiv"] == {"tests": 4}, "the exact one does not count"
    headline = re.search(r"<dl class=.?headline.*?</dl>", html.render(report, {}), re.DOTALL)
    assert headline is not None
    assert "over 4 of 5" not in headline[0]
    assert main(["why", "alpha_eiv", str(tmp_path)]) == 0
    assert "over" not in capsys.readouterr().out.split("rests on")[0].split("from  ")[1]


def changed(column: str, test: int, text: str, texts: Texts = PAPER) -> Texts:
    """The campaign with another number."""
    return {**texts, column: [text if n == test else old for n, old in enumerate(texts[column], 1)]}


NEAR = changed("v", 4, "4.092")
IMPLAUSIBLE = {
    "x_p[5] = 6400 um": (changed("x_p", 5, "6400"), "deeper than the radius of the ball", 6),
    "v[1] = 0.0235 m/s": (changed("v", 1, "0.0235"), "a speed of no drop test", 2),
    "alpha[1-2] = ": (changed("x_p", 2, "27.5", TWO), "1 of 1 pairs outside (4): ", None),
    "alpha[4-5] = ": (changed("e", 5, "0.469"), "1 of 10 pairs: e rises with the speed", 6),
    "alpha[3-4] = ": (changed("x_p", 4, "41.7", NEAR), "1 of 10 pairs: speeds within 4 %: too near", None),
}


def test_of_several_tests_that_may_be_wrong_the_one_that_moves_the_result_most(tmp_path: Path) -> None:
    """Only the pair of tests 4 and 5 is odd: both may be the cause."""
    texts = changed("e", 5, "0.469")
    *both, scattered = told(write(tmp_path, texts))
    without = "; without test 5 (farthest of 5, 27 standard deviations off: below 1e-15) it is 4.8 on 2: 0.09"
    assert scattered == SCATTERED + without
    assert [said.partition(": alpha[4-5] = ")[0] for said in both] == [
        "warning: alpha: 1 of 10 pairs outside (4)",
        "warning: alpha: 1 of 10 pairs: e rises with the speed",
    ]
    whole, means = computed(tmp_path).values.scalar("alpha_eiv"), {}
    for test in (4, 5):
        left = {name: [n for at, n in enumerate(column, 1) if at != test] for name, column in texts.items()}
        report = Study(write(tmp_path / str(test), left)).computed
        means[test] = report.values.scalar("alpha_eiv")
    worst = max(means, key=lambda test: abs(means[test] - whole))
    goes = f"without it alpha_eiv goes from {whole:.4f} to {means[worst]:.4f}, further than without another"
    assert all(said.endswith(f"look at test {worst} first: {goes}") for said in both)


@pytest.mark.parametrize("cell", IMPLAUSIBLE)
def test_what_is_implausible_is_a_warning_with_its_place(tmp_path: Path, cell: str) -> None:
    texts, says, line = IMPLAUSIBLE[cell]
    found = [
        check for check in checks(write(tmp_path, texts)).values() if check.kind == "limit" and check.word
    ]
    (check,) = [check for check in found if says in check.message]
    assert cell in check.message
    assert (check.word, check.passed, check.at.line) == ("warning", True, line)
    assert check.at.path == (tmp_path / ("report.toml" if line is None else "measurements.csv")).as_posix()


def test_a_pair_that_says_nothing_accuses_nobody(tmp_path: Path) -> None:
    campaign = write(tmp_path, changed("x_p", 4, "41.5", NEAR))
    said, scattered = told(campaign)
    assert scattered.startswith("warning: chi2_eiv = ")
    assert said.startswith("warning: alpha: 1 of 10 pairs: speeds within 4 %")
    assert said.endswith(": alpha[3-4] #NOROOT!")


def remarks(folder: Path) -> list[tuple[str, str, str]]:
    """The cells to look at."""
    return [(each.cell.address, each.code, each.why) for each in Material(computed(folder)).remarks]


def test_two_tests_are_no_fault_though_no_test_can_be_left_out_of_them(tmp_path: Path) -> None:
    report = computed(write(tmp_path, TWO))
    codes = {
        name: report.values.cell(name).reason for name in ("birge_eiv", "Q_eiv", "u_birge_eiv", "trend_eiv")
    }
    assert codes["birge_eiv"].endswith("(L46): two tests lie on one curve, so that nothing is left over")
    assert codes["u_birge_eiv"].startswith("#DOMAIN! u_birge_eiv needs birge_eiv: ")
    assert codes["Q_eiv"].endswith("(L61): tests at two speeds tell no trend")
    assert report.values.cell("z_eiv", (1,)).why.endswith("(L48): the other tests alone tell no curve")
    assert told(tmp_path) == remarks(tmp_path) == []
    found = checks(tmp_path)
    assert found["data cells"].message == "every cell has a value where it can"
    assert main(["check", str(tmp_path)]) == 0


def test_a_fault_of_two_tests_is_one_all_the_same(tmp_path: Path) -> None:
    write(tmp_path, BACKWARDS)
    assert [address for address, _, _ in remarks(tmp_path)][:2] == ["alpha[1-2]", "alpha_eiv"]


def test_a_pair_at_nearly_one_speed_is_told_once(tmp_path: Path) -> None:
    write(tmp_path, changed("x_p", 4, "41.7", NEAR))
    ((address, code, why),) = remarks(tmp_path)
    assert (address, code) == ("alpha[3-4]", "†")
    assert why == "outside (4), range of the exponent; speeds within 4 %: too near for averages and fits"


@pytest.mark.campaigns
def test_slips_at_random(tmp_path: Path, sizes: Sizes, summary: Callable[[str], None]) -> None:
    dice, missed, others = random.Random(sizes.seed), [], 0
    for _ in range(sizes.slips):
        texts = campaign(dice, dice.randint(3, 8), noise=0.002)
        slip = dice.choice(list(slips(texts)))
        found = named(write(tmp_path, slip.of(texts)))
        missed += [(slip, texts)] * (slip.test not in found)
        others += found != [slip.test]
    summary(f"{sizes.slips} slipped decimals: {len(missed)} not named, {others} not alone")
    assert missed == []


# --- what is expected


def expecting(folder: Path, texts: Texts, *lines: str) -> Path:
    return write(folder, texts, "\n".join(["[expected]", *lines, ""]))


def test_what_is_expected_of_a_test_is_no_finding_and_the_reason_is_told(tmp_path: Path) -> None:
    found = checks(expecting(tmp_path, SLIPPED, '"test 2" = "the dial was read in cm"'))
    assert all(check.passed for check in found.values())
    rows, said = told(tmp_path)
    assert said.startswith(
        "expected: test 2, the dial was read in cm: alpha[1-2] has no value (#NOROOT!), alpha[2-3] has no"
    )
    assert found["data cells"].message.endswith(", as is expected")
    assert rows == f"expected: {found['data rows'].message}"
    assert "alpha_mean, alpha_median, x_ref and F_ref are over 6 of 10 pairs" in rows


def test_what_is_expected_of_a_cell_is_of_no_other(tmp_path: Path) -> None:
    pairs = ("1-2", "2-3", "2-4")
    found = checks(expecting(tmp_path, SLIPPED, *(f'"alpha[{pair}]" = "known"' for pair in pairs)))
    assert found["data cells"].message.startswith("alpha: 1 of 10 pairs have no value: alpha[2-5] #NOROOT!")
    assert not found["data cells"].passed
    assert not found["data rows"].passed
    assert all(found[f"expected alpha[{pair}]"].passed for pair in pairs)
    all_of_them = (*(f"alpha[{pair}]" for pair in (*pairs, "2-5")), "alpha_eiv")
    every = checks(expecting(tmp_path, SLIPPED, *(f'"{cell}" = "known"' for cell in all_of_them)))
    assert all(check.passed for check in every.values())


def test_a_sum_may_be_expected_to_leave_rows_out_by_its_own_name(tmp_path: Path) -> None:
    found = checks(expecting(tmp_path, SLIPPED, 'alpha_mean = "test 2 is looked into"'))
    assert found["data rows"].message.startswith("alpha_median, x_ref and F_ref are over 6 of 10 pairs")
    assert (
        found["expected alpha_mean"].message
        == "alpha_mean, test 2 is looked into: alpha_mean is over 6 of 10 pairs"
    )
    assert not found["data cells"].passed


def test_a_result_may_be_expected_to_have_no_value(tmp_path: Path) -> None:
    assert not told(write(tmp_path, BACKWARDS))[-1].startswith("expected")
    found = checks(
        expecting(
            tmp_path,
            BACKWARDS,
            *(f'"{cell}" = "swapped, as a demonstration"' for cell in ("alpha[1-2]", "alpha_eiv")),
        )
    )
    assert all(check.passed for check in found.values())


def test_an_implausible_cell_may_be_expected(tmp_path: Path) -> None:
    slow = changed("v", 1, "0.0235")
    line = '"v[1]" = "rolled down a ramp"'
    assert any("a speed of no drop test" in said for said in told(write(tmp_path, slow)))
    found = checks(expecting(tmp_path, slow, line))
    assert found["expected v[1]"].passed
    (speeds,) = [check for name, check in found.items() if name.startswith("limit v:")]
    assert (speeds.word, speeds.message[-16:]) == ("", ", as is expected")


@pytest.mark.parametrize("address", ["test 3", "alpha[1-3]", "alpha_mean", "x_p[1]"])
def test_to_expect_what_does_not_happen_is_a_finding(tmp_path: Path, address: str) -> None:
    found = checks(expecting(tmp_path, PAPER, f'"{address}" = "heard twice"'))[f"expected {address}"]
    assert found.word == "finding"
    leave = "; a column 'left out' of its table leaves a row out" * (address == "test 3")
    assert (
        found.message == f"{address} is expected to be odd (heard twice), and is not: drop that line{leave}"
    )
    line = (tmp_path / "report.toml").read_text().splitlines()[(found.at.line or 0) - 1]
    assert line == f'"{address}" = "heard twice"'


@pytest.mark.parametrize(
    ("line", "code", "says"),
    [
        ('"test 9" = "x"', "LS506", "test has no index '9'"),
        ('test = "x"', "LS505", "the sheet has no cell 'test'"),
        ('"test2" = "x"', "LS505", "did you mean 'test 2'?"),
        ('"alpha[1]" = "x"', "LS506", "alpha has no index '1'"),
        ('"alpha[2-1]" = "x"', "LS506", "alpha has no index '2-1'"),
        ('"alpha_mean[1]" = "x"', "LS506", "alpha_mean has no index '1'"),
        ('"alhpa[1-2]" = "x"', "LS505", "did you mean 'alpha'?"),
        ('"alpha[1-2" = "x"', "LS505", "the sheet has no cell 'alpha[1-2'"),
        ('"" = "x"', "LS505", "the sheet has no cell ''"),
        ('"alpha[1-2]" = ""', "LS403", "is empty"),
        ('"alpha[1-2]" = 3', "LS205", "text in quotes"),
    ],
)
def test_a_wrong_expectation_is_told_with_its_line(tmp_path: Path, line: str, code: str, says: str) -> None:
    with pytest.raises(InputError) as refused:
        assert Study(expecting(tmp_path, PAPER, line)).computed
    (finding,) = refused.value.diagnostics
    assert finding.code == code
    assert says in str(refused.value)
    assert finding.at.line == 9
    assert finding.at.path == (tmp_path / "report.toml").as_posix()


def test_what_is_expected_stands_in_a_table(tmp_path: Path) -> None:
    folder = write(tmp_path, PAPER)
    (folder / "report.toml").write_text('expected = "test 2"\n' + (folder / "report.toml").read_text())
    with pytest.raises(InputError, match=r"LS205.*\n(.*\n)*.*a table \[expected\]"):
        assert Study(folder).computed


# --- where it is told


def test_build_names_the_report_that_it_replaces(
    tmp_path: Path, unjudged: None, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, out = write(tmp_path / "in", SLIPPED), tmp_path / "out"
    words = ["build", str(folder), "--out", str(out), "--to", "json"]
    for title, said in (
        ("One", "into {out}"),
        ("One", "into {out}"),
        ("Two", "into {out}, in place of 'One'"),
    ):
        toml = (folder / "report.toml").read_text(encoding="utf-8")
        lines = [line for line in toml.splitlines() if not line.startswith("title")]
        (folder / "report.toml").write_text(
            "\n".join([f'title = "{title}"', *lines]) + "\n", encoding="utf-8"
        )
        main(words)
        assert capsys.readouterr().out.splitlines()[0].endswith(said.format(out=out))


def test_build_tells_it_last(tmp_path: Path, unjudged: None, capsys: pytest.CaptureFixture[str]) -> None:
    folder, out = write(tmp_path / "in", SLIPPED), tmp_path / "out"
    assert main(["build", str(folder), "--out", str(out), "--to", "json"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line.partition(": ")[0] for line in lines[-4:-1]] == ["finding"] * 3
    assert (
        f"finding: {folder.as_posix()}/measurements.csv:3:3: alpha: 4 of 10 pairs have no value" in lines[-4]
    )
    assert lines[-1].startswith("2 files in ")


def test_build_tells_what_is_expected_and_ends_well(
    tmp_path: Path, unjudged: None, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = expecting(tmp_path / "in", SLIPPED, '"test 2" = "read in cm"')
    assert main(["build", str(folder), "--out", str(tmp_path / "out"), "--to", "json"]) == 0
    assert "expected: " in capsys.readouterr().out.splitlines()[-2]
    values = json.loads((tmp_path / "out" / "values.json").read_text())
    rows, odd = values["oddities"]
    assert rows["sentence"].endswith(", as is expected")
    assert (odd["kind"], odd["name"], odd["word"]) == ("expected", "test 2", "expected")
    assert "read in cm" in odd["sentence"]


@pytest.mark.parametrize("form", ["text", *FORMATS])
def test_every_format_of_check_tells_it(
    tmp_path: Path, form: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(stages, "judged", lambda report, step: report)
    monkeypatch.setattr(Study, "algebra", ((), ()))
    folder = write(tmp_path, changed("v", 1, "0.0235", SLIPPED))
    assert main(["check", str(folder), "--format", form]) == 1
    out = capsys.readouterr().out
    assert "look at test 2 first" in out
    assert "a speed of no drop test" in out
    if form == "json":
        noted = {check["name"]: check["note"] for check in json.loads(out)["checks"]}
        assert noted["cells"] is None
        assert [name for name, note in noted.items() if note == "warning" and name.startswith("v: ")]
    if form == "junit":
        assert int(ElementTree.fromstring(out).get("failures", "")) == 3
    if form == "github":
        assert re.search(r"^::error file=.*measurements\.csv,line=3,col=3,.*title=data cells::", out, re.M)
        assert re.search(r"^::warning file=.*measurements\.csv,line=2,", out, re.M)


def test_the_report_tells_findings_and_reasons(tmp_path: Path) -> None:
    for texts, lines, says in (
        (SLIPPED, (), "look at test 2 first"),
        (SLIPPED, ('"test 2" = "the dial was read in <cm>"',), "the dial was read in "),
    ):
        report = Study(expecting(tmp_path, texts, *lines)).computed
        assert says in html.render(report, {}, "")
        assert says in latex.render(report, [])
        content = stages.book(report)[1]
        (tmp_path / "report.xlsx").write_bytes(content)
        sheet = openpyxl.load_workbook(tmp_path / "report.xlsx").worksheets[0]
        cells = [str(cell.value) for row in sheet.iter_rows() for cell in row if cell.value]
        assert any(says in text for text in cells)
        assert "The data as they were given" in cells
    assert "in &lt;cm&gt;" in html.render(report, {}, "")


def test_a_report_without_oddities_says_nothing_of_them(tmp_path: Path) -> None:
    report = Study(write(tmp_path, PAPER)).computed
    shown = html.render(report, {}, "")
    other = replace(report, oddities=(Check("data", "x", False, "something odd"),))
    assert "something odd" not in shown
    assert "<strong>Finding</strong>: something odd." in html.render(other, {}, "")


AMBIGUOUS = {"v": ("2.00", "2.76", "3.87"), "e": ("0.500", "0.552", "0.621"), "x_p": ("20.0", "26.7", "27.8")}
"""One pair without a root, and two with two roots each, which are not the same two."""


def test_each_cause_is_told_of_its_own_cells(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    report = computed(write(tmp_path, AMBIGUOUS))
    causes = [cell.why for cell in report.values.errors() if cell.name == "alpha"]
    said = checks(tmp_path)["data cells"].message
    assert len(set(causes)) == 3
    assert all(cause in said for cause in causes)
    monkeypatch.setattr("loopsheet.report.judge.oddities.CAUSES", 1)
    _computed.cache_clear()
    said = checks(tmp_path)["data cells"].message
    assert "; and 2 other causes" in said
    assert [cause in said for cause in causes] == [True, False, False]


WEIGHED = """\
from sympy import Sum, Symbol
from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Parameter, Workbook

k, n = (Symbol(s, integer=True, positive=True) for s in ("k", "n"))
d = Column("d", Axis("tests", k, n), Given("measured"), "m", "a length", positive=False)
u = Column("u_d", d.axis, Given("uncertainty", Bounds(low=0), "d"), "m", "its u", exact=True)
eq = Equation("(1)", (Symbol("w"), Sum(1 / u[k] ** 2, (k, 1, n))), "definition", Kind.DEFINITION, "weight")
w = Column("w", None, Formula(eq), "m^-2", "all weights")
WORKBOOK = Workbook(
    name="weighed", title="Weighed", source="none", ledger=lambda: Ledger((eq,)),
    measured=(Measured("d", "m", "a length"),), parameters=(),
    sheet=lambda names: Sheet((d, u, w)), headline=("w",),
)
"""


@pytest.mark.parametrize(("first", "named"), [("0", True), ("1", False)])
def test_a_test_that_is_exact_is_named_where_tests_are_weighed(
    tmp_path: Path, first: str, named: bool
) -> None:
    rows = f"test,d [nm],u(d) [nm]\n3,215,{first}\n5,204,2\n"
    report = Study(method_folder(tmp_path, WEIGHED, rows)).computed
    said = "; ".join(check.message for check in report.oddities)
    assert ("test 3 has d without uncertainty, so that no other test would count beside it" in said) == named
    assert "test 5 has" not in said


# --- uncertainties that cannot be meant
SHARED = '[uncertainty.shared.scale]\nof = "x_p"\nstated = "{}"\n'


def with_column(folder: Path, head: str, sizes: tuple[str, ...]) -> Path:
    """The campaign with a column of standard uncertainties at its right."""
    table = write(folder, SOUND) / "measurements.csv"
    lines = zip(table.read_text().splitlines(), (head, *sizes), strict=True)
    table.write_text("\n".join([*map(",".join, lines), ""]))
    return folder


def test_micrometres_under_a_head_of_millimetres_are_told_where_they_stand(tmp_path: Path) -> None:
    folder = with_column(tmp_path, "u(x_p) [mm]", ("0.0002", "0.0002", "0.2", "0.0002", "0.0002", "0.0002"))
    found = checks(folder)["uncertainty x_p"]
    assert (found.word, str(found.at)) == ("warning", f"{folder.as_posix()}/measurements.csv:4:22")
    assert found.message.startswith(
        "u(x_p): 1 of 6 tests: 2 u reach below 0, where none can lie: 2.0\u00a0×\u00a010² um of x_p[3] = "
    )
    assert found.message.endswith("is its unit right, and is it a standard uncertainty?")


@pytest.mark.parametrize(("size", "odd"), [("10.32", False), ("10.33", True)])
def test_an_uncertainty_of_half_the_value_is_the_largest_that_is_plausible(
    size: str, odd: bool, tmp_path: Path
) -> None:
    sizes = (size, "1", "1", "1", "1", "1")
    assert bool(checks(with_column(tmp_path, "u(x_p) [um]", sizes))["uncertainty x_p"].word) == odd


@pytest.mark.parametrize(
    ("stated", "odd"), [("+-150 % of reading rect", True), ("+-5 % of reading rect", False)]
)
def test_a_shared_error_counts_for_each_number(stated: str, odd: bool, tmp_path: Path) -> None:
    found = checks(write(tmp_path, SOUND, SHARED.format(stated)))["uncertainty x_p"]
    assert bool(found.word) == odd
    assert not odd or "6 of 6 tests: " in found.message


def test_a_group_has_the_shared_error_that_others_have_not(tmp_path: Path) -> None:
    more = SHARED.format("u = 30 um") + "groups = [[1, 2], [3]]\n"
    assert "3 of 6 tests: " in checks(write(tmp_path, SOUND, more))["uncertainty x_p"].message


@pytest.mark.parametrize(
    ("stated", "odd"),
    [("+- 11.01 mm", True), ("+- 10.99 mm", False), ("exponential", False), ("u = 12 mm, truncated", False)],
)
def test_of_a_parameter_too_but_for_errors_that_keep_to_bounds(
    stated: str, odd: bool, tmp_path: Path
) -> None:
    folder = write(
        tmp_path, SOUND, f'[uncertainty]\nball_diameter = "{stated}{" rect" * ("+-" in stated)}"\n'
    )
    assert bool(checks(folder)["uncertainty ball_diameter"].word) == odd


def test_an_implausible_uncertainty_can_be_expected(tmp_path: Path) -> None:
    more = f'{SHARED.format("u = 30 um")}groups = [[1]]\n[expected]\n"x_p[1]" = "read in a photograph"\n'
    assert "uncertainty x_p" in checks(write(tmp_path, SOUND, more))
    assert told(tmp_path)[-1] == (
        "expected: x_p[1], read in a photograph: x_p[1] has an implausible uncertainty"
    )


def test_quantities_that_may_be_zero_are_not_asked(tmp_path: Path) -> None:
    """A restitution of 0 is one: its uncertainty may be larger."""
    assert "uncertainty e" not in checks(write(tmp_path, SOUND, stated()))
