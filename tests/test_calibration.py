"""Standards and samples in one table: a line through the standards, and what is read off it."""

from collections.abc import Callable
from pathlib import Path

import grouped
import numpy as np
import pytest

from loopsheet.report.messages.errors import InputError
from loopsheet.report.result.findings import checks as every_check
from loopsheet.report.study import Study

METHOD = """
from loopsheet import Method, fit, groups, let, mean, measured, unknown

class Jam(Method, headline="w"):
    "Iron in jam."
    c = measured("mg/L", "stated content")
    y = measured("1", "signal")
    b_0 = unknown("signal of none")
    b_1 = unknown("slope")
    line = fit(y, b_0 + b_1 * c)
    sample = groups("sample")
    w = let((mean(y, of=sample) - b_0) / b_1, "content", "mg/L")
    each = let((y - b_0) / b_1, "content by one reading", "mg/L")
    all_of_them = let(mean(y / c), "signal by content")
"""
STANDARDS = [(2.0, 0.21), (5.0, 0.51), (10.0, 1.015), (20.0, 2.005)]
SAMPLES = {"jam A": [0.80, 0.82], "jam B": [1.40, 1.43, 1.44]}


def _write(path: Path, expected: str) -> Path:
    rows = [("standard", f"{c:g}", f"{y:g}") for c, y in STANDARDS]
    rows += [(word, "", f"{y:g}") for word, read in SAMPLES.items() for y in read]
    more = f'[expected]\n"{expected}" = "samples"\n'
    return grouped.write(path, tuple(rows), "sample,c [mg/L],y [1]", METHOD, more)


def test_a_line_through_the_standards_is_read_off_for_all(tmp_path: Path) -> None:
    values = Study(_write(tmp_path, "c")).computed.values
    c, y = np.array(STANDARDS).T
    slope, intercept = np.polyfit(c, y, 1)
    every = np.array([*y, *SAMPLES["jam A"], *SAMPLES["jam B"]])
    means = np.array([y.mean(), *map(np.mean, SAMPLES.values())])
    assert 1e3 * values.value["each"] == pytest.approx((every - intercept) / slope, rel=1e-12)
    assert 1e3 * values.value["w"] == pytest.approx((means - intercept) / slope, rel=1e-12)
    assert values.scalar("all_of_them") / 1e3 == pytest.approx((y / c).mean(), rel=1e-14)  # of what has both


def test_it_is_as_expected_in_every_engine(tmp_path: Path, every_engine: Callable[..., str]) -> None:
    told = every_engine(_write(tmp_path, "c"))
    assert told.count("eps x condition") == 3
    assert told.endswith("everything as expected\n")


@pytest.mark.parametrize(
    ("expected", "told"),
    [
        ("c", ["c, samples: c[5] has no value (#INPUT!)", "over 4 of 9 readings, as is expected"]),
        ("c[jam A]", ["c: 3 of 9 readings have no value: c[7] (jam B), c[8] (jam B)", "are over 4 of 9"]),
        (
            "c[standard]",
            ["c[standard] is expected to be odd (samples), and is not: drop that line", "c: 5 of 9"],
        ),
    ],
)
def test_empty_cells_are_expected_of_a_column_or_of_a_word(
    expected: str, told: list[str], tmp_path: Path
) -> None:
    checks = Study(_write(tmp_path, expected)).computed.oddities
    said = "\n".join(each.message for each in checks)
    assert [each for each in told if each not in said] == []
    assert all(each.passed for each in checks) == (expected == "c")


LIMITED = METHOD.replace("mean, measured,", "mean, measured, required,").replace(
    "    sample =", '    limit = measured("mg/L", "limit", exact=True)\n    sample ='
)
LEGAL = '    legal = required(w <= mean(limit, of=sample), "within its limit", "mg/L")\n'


def test_a_limit_that_a_result_is_compared_with_does_not_change_it(tmp_path: Path) -> None:
    rows = [("standard", f"{c:g}", f"{y:g}", "") for c, y in STANDARDS]
    rows += [("jam A", "", "0.80", "7.9"), ("jam A", "", "0.82", ""), ("jam B", "", "1.40", "15")]
    expected = '[expected]\nc = "samples"\nlimit = "one each"\n"legal[standard]" = "a standard"\n'
    head = "sample,c [mg/L],y [1],limit [mg/L]"
    plain = grouped.write(tmp_path / "plain", tuple(rows), head, LIMITED)
    folder = grouped.write(tmp_path / "legal", tuple(rows), head, LIMITED + LEGAL, expected)
    report = Study(folder).computed
    found = report.values.value
    assert found["w"].tolist() == Study(plain).computed.values.value["w"].tolist()
    assert found["legal"][1:] == pytest.approx([7.9e-3, 15e-3] - found["w"][1:], rel=1e-12)
    failed = [each.message.partition(":")[0] for each in every_check(report) if not each.passed]
    assert failed == ["legal[jam A] does not conform"]


def test_a_blank_that_is_subtracted_has_rows_of_its_own(tmp_path: Path) -> None:
    code = METHOD.replace("fit(y, ", "fit(net, ").replace(
        "    b_0 =",
        '    is_blank = measured("1", "1 of a blank", exact=True)\n'
        '    net = let(y - sum(y * is_blank) / sum(is_blank), "signal less that of the blanks")\n    b_0 =',
    )
    rows = [("blank", "", "0.010", "1"), ("blank", "", "0.012", "1")]
    rows += [("standard", f"{c:g}", f"{y:g}", "0") for c, y in STANDARDS]
    rows += [(word, "", f"{y:g}", "0") for word, read in SAMPLES.items() for y in read]
    folder = grouped.write(tmp_path, tuple(rows), "sample,c [mg/L],y [1],is_blank [1]", code)
    values = Study(folder).computed.values
    c, y = np.array(STANDARDS).T
    slope, intercept = np.polyfit(c, y - 0.011, 1)
    assert values.scalar("b_0") == pytest.approx(intercept, rel=1e-10)
    assert values.scalar("b_1") / 1e3 == pytest.approx(slope, rel=1e-12)


def test_what_is_expected_of_no_row_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"c has no index 'jam C'(.|\n)*or standard, jam A or jam B"):
        _ = Study(_write(tmp_path, "c[jam C]")).computed
