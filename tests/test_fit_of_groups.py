"""A fit of the rows of each group: its parameters are columns of the groups."""

import re
from collections.abc import Callable
from pathlib import Path

import grouped
import numpy as np
import pytest

import loopsheet
from loopsheet.report.build import build
from loopsheet.report.charts import BARS
from loopsheet.report.cli import main
from loopsheet.report.column import SheetError
from loopsheet.report.method import words
from loopsheet.report.study import Study
from loopsheet.report.views import charts

METHOD, HEAD, drawn = grouped.RATES, grouped.RATES_HEAD, grouped.rates
FIT, LEVEL = "line = fit(y, a + b * x, of=catalyst)", "level = let(mean(y, of=catalyst), '')\n    line = "
STATED = '[uncertainty]\ny = "u = 0.05"\n'
Rows = tuple[tuple[str, ...], ...]


def alone(rows: Rows, word: str) -> Rows:
    return tuple(row for row in rows if row[0] == word)


@pytest.mark.parametrize(("seed", "groups"), [(1, 3), (2, 4), (3, 1)])
def test_each_group_has_the_line_of_its_rows_alone(tmp_path: Path, seed: int, groups: int) -> None:
    rows = drawn(seed, groups)
    stated = '[uncertainty]\nx = "exact"\ny = "u = 0.05"\n'
    report = Study(grouped.write(tmp_path, rows, HEAD, METHOD, stated)).computed
    values, sure = report.values.value, report.uncertain().u
    for place, word in enumerate(dict.fromkeys(row[0] for row in rows)):
        x, y = np.array([row[1:] for row in alone(rows, word)], dtype=float).T
        (b, a), by_scatter = np.polyfit(x, y, 1, cov=True)
        found = [values[name][place] for name in ("a", "b", "s_a", "s_b")]
        known = [a, b, *np.sqrt(np.diagonal(by_scatter)[::-1])]
        assert found == pytest.approx(known, rel=1e-11)
        left = y - a - b * x
        assert values["line_S"][place] == pytest.approx((left**2).sum(), rel=1e-10)
        of_rows = [n for n, row in enumerate(rows) if row[0] == word]
        assert values["line_residual"][of_rows] == pytest.approx(left, abs=1e-12)
        assert sure["b"][place] == pytest.approx(0.05 / np.sqrt(((x - x.mean()) ** 2).sum()), rel=1e-11)


@pytest.mark.parametrize(("stated", "told"), [(0.05, False), (0.0005, True)])
def test_its_residuals_are_held_against_what_is_stated(tmp_path: Path, stated: float, told: bool) -> None:
    """All lines together: each leaves its rows but two for its parameters, one of two rows none."""
    rows = (*drawn(2, 4), ("few", "1", "1.0"), ("few", "2", "1.4"))
    text = f'[uncertainty]\nx = "exact"\ny = "u = {stated}"\n'
    report = Study(grouped.write(tmp_path, rows, HEAD, METHOD, text)).computed
    misfit = report.uncertain().misfits["line_S"]
    squares, numbers = 0.0, []
    for word in dict.fromkeys(row[0] for row in rows):
        x, y = np.array([row[1:] for row in alone(rows, word)], dtype=float).T
        squares += float(((y - np.polyval(np.polyfit(x, y, 1), x)) ** 2).sum())
        numbers.append(len(x) - 2)
    assert misfit.chi2 == pytest.approx(squares / stated**2, rel=1e-6)
    assert misfit.dof == sum(numbers)
    found = [check.message for check in report.oddities if check.name == "line_S"]
    assert ["understated" in each for each in found] == [told]


def test_it_is_the_fit_without_groups_where_there_is_one(tmp_path: Path) -> None:
    rows = drawn(4, 1)
    code = METHOD.replace(", of=catalyst", "").replace("max(b) - min(b)", "b")
    both = [
        Study(grouped.write(tmp_path / name, rows, HEAD, text)).computed.values.value
        for name, text in {"each": METHOD, "all": code}.items()
    ]
    for name in ("a", "b", "s_a", "s_b", "r_a_b", "line_s", "line_S", "line_fitted", "scaled"):
        assert both[0][name].tolist() == both[1][name].tolist(), name


def test_every_engine_fits_each_group(tmp_path: Path, every_engine: Callable[..., str]) -> None:
    stated = '[uncertainty]\ny = "u = 0.05"\n'
    told = every_engine(grouped.write(tmp_path, drawn(1), HEAD, METHOD, stated))
    assert re.search(r"proofs +(\d+) of \1 equations stand", told)


def test_a_group_of_too_few_rows_has_no_line_and_others_have(tmp_path: Path) -> None:
    rows = (("few", "1.5", "2.5"), *drawn(1))
    values = Study(grouped.write(tmp_path, rows, HEAD, METHOD)).computed.values
    before = Study(grouped.write(tmp_path / "before", rows[1:], HEAD, METHOD)).computed.values
    assert "2 parameters take 2 rows or more" in values.cell("b", (1,)).reason
    assert values.numbers("b")[1:] == before.numbers("b")
    assert values.numbers("line_residual") == [None, *before.numbers("line_residual")]


def test_its_weights_are_those_that_are_stated(tmp_path: Path) -> None:
    rows = tuple((*row, f"{0.03 + 0.01 * (n % 3):.2f}") for n, row in enumerate(drawn(6)))
    code = METHOD.replace("of=catalyst", 'u="stated", of=catalyst')
    values = Study(grouped.write(tmp_path, rows, f"{HEAD},u(y) [1]", code)).computed.values.value
    for place, word in enumerate(dict.fromkeys(row[0] for row in rows)):
        x, y, u = np.array([row[1:] for row in rows if row[0] == word], dtype=float).T
        known = np.polyfit(x, y, 1, w=1 / u)[::-1]
        assert [values[name][place] for name in "ab"] == pytest.approx(known, rel=1e-11)


def test_the_report_has_a_line_for_each(tmp_path: Path) -> None:
    folder = grouped.write(tmp_path, drawn(1), HEAD, METHOD)
    build(Study(folder), tmp_path / "out", ("html",))
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "fit of each catalyst" in page
    assert "of the n readings of each catalyst" in page


def test_its_pictures_tell_groups_apart_by_their_words(tmp_path: Path) -> None:
    report = Study(grouped.write(tmp_path, drawn(1), HEAD, METHOD, STATED)).computed
    fitted, left = (charts.draw(report, spec.chart) for spec in report.workbook.figures if spec.chart)
    said = [[text.get_text() for text in figure.legends[0].get_texts()] for figure in (fitted, left)]
    words = list(dict.fromkeys(row[0] for row in drawn(1)))
    assert said == [[*words, BARS, "fit of each catalyst"], [*words, BARS]]
    axes = fitted.axes[0]
    colours = [line.get_color() for line in axes.lines if len(line.get_xdata()) == 2]
    keys = [handle.get_color() for handle in fitted.legends[0].legend_handles[: len(words)]]
    assert len({*keys}) == len(words)
    assert {*colours} >= {*keys}  # a line has the colour of its points
    assert {text.get_text() for text in axes.texts} <= {*words}
    assert any([*line.get_ydata()] == [0, 0] for line in left.axes[0].lines)
    assert not any([*line.get_ydata()] == [0, 0] for line in axes.lines)


def test_many_groups_are_not_told_apart_in_a_legend(tmp_path: Path) -> None:
    report = Study(grouped.write(tmp_path, drawn(1, 9, 40), HEAD, METHOD, STATED)).computed
    figure = charts.draw(report, report.workbook.figures[0].chart)
    said = [text.get_text() for text in figure.legends[0].get_texts()]
    assert said == ["logarithm of the rate", BARS, "fit of each catalyst"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "a + b * x",
            "a + x ** b",
            "not linear: of each catalyst there are fits of linear models",
        ),
        (
            "of=catalyst",
            "of='catalyst'",
            "of='catalyst' is none of what groups() returned, or has no readings: write of=catalyst, without",
        ),
        ("fit(y, a", "fit(mean(y, of=catalyst), a", "is no column over the rows"),
        ("a + b * x", "a + b * mean(x, of=catalyst)", "is of rows in groups, which no fit takes"),
        (FIT, LEVEL + "fit(level, a + b * x)", "instead: name a let(mean(x, of=catalyst), ...)"),
        (FIT, LEVEL + "fit(level, a + b * mean(x, of=catalyst))", "let(...) what is taken of=catalyst be"),
    ],
)
def test_what_is_refused_of_a_fit_of_groups(old: str, new: str, said: str) -> None:
    assert METHOD.count(old) == 1
    code = METHOD.replace(old, new).replace("Method, fit", "Method, fit, mean")
    with pytest.raises(SheetError, match=re.escape(said)):
        exec(code, {**vars(words), **vars(loopsheet)})


def test_what_a_fit_lacks_is_known_by_its_parameters(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Whose cells begin nothing: what counts the rows does, and has a name that nobody wrote."""
    rows = (*drawn(2, 4), ("few", "1", "1.0"))
    folder = grouped.write(tmp_path, rows, HEAD, METHOD)
    assert main(["check", str(folder)]) == 1
    told = capsys.readouterr().out
    assert "[few] #DOMAIN!" in told
    assert "line_N1" not in told
    (lacking,) = re.findall(r"(\w+)\[few\] #DOMAIN!", told)
    toml = folder / "report.toml"
    toml.write_text(f'{toml.read_text()}\n[expected]\n"{lacking}[few]" = "one row"\n')
    assert main(["check", str(folder)]) == 0, capsys.readouterr().out
