"""Rows in groups in the page: after an edit it is what a folder with the edit gives."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import driving
import grouped
import pytest
from driving import Live

from loopsheet.report.build import build
from loopsheet.report.cells.values import Values
from loopsheet.report.study import Study


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return grouped.write(tmp_path, tuple((*row, "") for row in grouped.FEW), "instrument,y [mm],left out")


def opened(folder: Path, open_page: Callable[..., Live]) -> Live:
    build(Study(folder), folder / "out", ("html",))
    return open_page(folder / "out" / "report.html")


def rebuilt(folder: Path, *edits: tuple[str, str]) -> Values:
    table = folder / "measurements.csv"
    text = table.read_text(encoding="utf-8")
    for old, new in edits:
        assert text.count(old) == 1
        text = text.replace(old, new)
    table.write_text(text, encoding="utf-8")
    return Study(folder).computed.values


def test_an_edited_reading_moves_its_group(open_page: Callable[..., Live], folder: Path) -> None:
    live = opened(folder, open_page)
    issued = Study(folder).computed.values
    live.type("y", 6, "2.85")
    again = rebuilt(folder, ("6,B,2.75", "6,B,2.85"))
    assert driving.differences(live.cells(), again) == []
    assert driving.differences(live.cells(), issued) != []
    live.page.locator('main [data-cell="level"][data-index="2"]').first.click()
    assert live.page.locator("#bar-name code").text_content() == "level[B]"
    beside = live.page.locator("#bar-precedents button").evaluate_all(
        "all => all.map((one) => one.dataset.goto)"
    )
    assert beside == ["y[2]", "y[6]"]
    assert "over 2\u00a0readings" in (live.page.locator("#bar-source").text_content() or "")


def test_over_how_many_readings_is_told_of_each_group(open_page: Callable[..., Live], tmp_path: Path) -> None:
    """As issued and after an edit: of the group that lacks a reading alone."""
    rows = tuple((word, "" if n == 2 else y, "1.0") for n, (word, y) in enumerate(grouped.FEW))
    code = grouped.METHOD.replace("    instrument =", '    x = measured("mm", "another")\n    instrument =')
    code = code.replace("between within F R2 s apart", "level all_y")
    folder = grouped.write(tmp_path, rows, "instrument,y [mm],x [mm]", code)
    live = opened(folder, open_page)

    def said() -> list[str]:
        boxes = live.page.locator(".headline [data-cell]").evaluate_all(
            "all => all.map((one) => one.parentElement.textContent)"
        )
        return [" ".join(re.findall(r"over \d+ of \d+ readings", text)) for text in boxes]

    assert said() == ["over 2 of 3 readings", "", "", "over 6 of 7 readings"]
    live.input("y", 2).click()
    live.page.keyboard.press("Delete")
    assert said() == ["over 2 of 3 readings", "over 1 of 2 readings", "", "over 5 of 7 readings"]


def test_readings_of_another_group_are_not_pasted(open_page: Callable[..., Live], folder: Path) -> None:
    live = opened(folder, open_page)
    live.input("y", 1).click()
    live.paste("instrument\ty [mm]\nA\t1.6\nA\t2.3\n")
    assert live.text("live-note") == "Nothing was pasted: instrument of reading 2 is B, not A."
    assert live.text("live-banner") == ""
    live.input("y", 6).click()
    live.paste("instrument\ty [mm]\nB\t2.85\nC\t3.25\nC\t3.5\n")
    assert live.text("live-note") == "Pasted, but 1 row had no place."
    again = rebuilt(folder, ("6,B,2.75", "6,B,2.85"))
    assert driving.differences(live.cells(), again) == []


def test_a_block_without_heads_is_not_put_into_other_columns(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    """Columns stand in the file in another order than in page and workbook: only heads tell them."""
    rows = tuple((word, "1.0", y) for word, y in grouped.FEW)
    code = grouped.METHOD.replace("    instrument =", '    x = measured("mm", "another")\n    instrument =')
    folder = grouped.write(tmp_path, rows, "instrument,x [mm],y [mm]", code)
    live = opened(folder, open_page)
    live.input("y", 1).click()
    live.paste("1.1\t1.6\n1.0\t2.25\n")
    said = "the columns of measurements.csv stand in another order (x, y): copy them with their heads."
    assert live.text("live-note") == f"Nothing was pasted: {said}"
    assert live.text("live-banner") == ""
    live.paste("x\ty\n1.1\t1.5\n")
    live.paste("2\tB\t1.0\t2.3\n3\tA\t1.2\t1.8\n")
    assert live.text("live-note") == f"Nothing was pasted: {said}"
    heads = "reading\tinstrument\tx\ty\n"
    live.paste(heads + "2\tB\t1.0\t2.3\n3\tA\t1.2\t1.8\n")
    assert live.text("live-note") == ""
    again = rebuilt(folder, ("1,A,1.0,1.50", "1,A,1.1,1.5"), ("2,B,1.0,2.25", "2,B,1.0,2.3"))
    again = rebuilt(folder, ("3,A,1.0,1.75", "3,A,1.2,1.8"))
    assert driving.differences(live.cells(), again) == []
    live.paste(heads + "2\tA\t1.0\t2.4\n3\tA\t1.2\t1.8\n")
    assert live.text("live-note") == "Nothing was pasted: instrument of reading 2 is B, not A."


def test_a_group_that_is_left_out_leaves_the_numbers_of_the_others(
    open_page: Callable[..., Live], folder: Path
) -> None:
    live = opened(folder, open_page)
    for reading in (1, 3, 4):
        live.page.locator(f'input[data-use="{reading}"]').uncheck()
    rows = ((f"{n},A,{y},", f"{n},A,{y},dropped") for n, y in ((1, "1.50"), (3, "1.75"), (4, "1.25")))
    again = rebuilt(folder, *rows)
    cells = [cell for cell in live.cells() if cell.name != "y"]
    assert driving.differences(cells, again) == []
    assert [cell.index for cell in cells if cell.name == "level"] == ["2", "3"]
    build(Study(folder), folder / "out", ("html",))
    back = open_page(folder / "out" / "report.html")
    for reading in (1, 3, 4):
        back.page.locator(f'input[data-use="{reading}"]').check()
    whole = Study(grouped.write(folder.parent / "whole")).computed.values
    assert driving.differences([cell for cell in back.cells() if cell.name != "y"], whole) == []
    row = back.page.locator('main tr:has([data-cell="level"][data-index="1"])').first
    assert (row.text_content() or "").startswith("1A")


def test_no_row_is_added_whose_group_nobody_told(open_page: Callable[..., Live], folder: Path) -> None:
    live = opened(folder, open_page)
    assert live.page.locator("#live-add").count() == 0
    assert "with the word of its group" in (live.page.locator("p.add").text_content() or "")


def test_an_edited_reading_moves_the_line_of_its_group(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    folder = grouped.write(tmp_path, grouped.rates(1), grouped.RATES_HEAD, grouped.RATES)
    live = opened(folder, open_page)
    issued = Study(folder).computed.values
    old, new = grouped.rates(1)[4][2], "-0.512"
    live.type("y", 5, new)
    again = rebuilt(folder, (f",{old}\n", f",{new}\n"))
    # What is left of a difference of larger numbers is as sure as these are.
    lefts = [cell for cell in live.cells() if cell.name == "line_residual"]
    cells = [cell for cell in live.cells() if cell.name not in ("line_residual", "scaled")]
    fitted = dict(zip(again.labels(again.sheet["line_fitted"]), again.value["line_fitted"], strict=True))
    for cell in lefts:
        label = (int(cell.index),)
        known = again.cell("line_residual", label).value
        assert float(cell.value) == pytest.approx(known, rel=0, abs=1e-13 * abs(fitted[label]))
    assert len(lefts) == len(fitted)
    assert "line_S" in {cell.name for cell in cells}
    assert driving.differences(cells, again) == []
    assert driving.differences(cells, issued) != []
    words = [row[0] for row in grouped.rates(1)]
    moved = again.value["b"] != issued.value["b"]
    assert moved.tolist() == [word == words[4] for word in dict.fromkeys(words)]


def test_a_result_of_each_group_has_its_word_and_follows(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    code = grouped.RATES.replace('headline="spread"', 'headline="spread b"')
    stated = '[uncertainty]\ny = "u = 0.05"\n'
    folder = grouped.write(tmp_path, grouped.rates(1), grouped.RATES_HEAD, code, stated)
    live = opened(folder, open_page)
    shown = live.page.locator('.headline > div:has([data-cell="b"])')
    words = list(dict.fromkeys(row[0] for row in grouped.rates(1)))
    assert [text.split(", ")[1] for text in shown.locator(".meaning").all_text_contents()] == words
    before, sure = (
        shown.locator("[data-cell]").all_text_contents(),
        shown.locator(".sure").all_text_contents(),
    )
    old = grouped.rates(1)[4][2]
    live.type("y", 5, "-0.512")
    again = rebuilt(folder, (f",{old}\n", ",-0.512\n"))
    report = Study(folder).computed
    assert driving.differences([cell for cell in live.cells() if cell.name == "b"], again) == []
    place, now = words.index(grouped.rates(1)[4][0]), shown.locator("[data-cell]").all_text_contents()
    assert [one != other for one, other in zip(before, now, strict=True)] == [n == place for n in range(3)]
    assert shown.locator(".sure").all_text_contents() == sure  # a straight line's u is of x alone
    assert len(report.uncertain().budgets) == 4
    panel = live.page.locator("#live-panel tbody th").all_text_contents()
    assert [text.rsplit(" ", 1)[-1] for text in panel[1:]] == words
    live.page.locator('main [data-cell="spread"]').first.click()
    live.page.locator(f'#bar-precedents [data-goto="b[{words[1]}]"]').click()
    assert live.page.locator("#bar-name code").text_content() == f"b[{words[1]}]"


def test_a_result_of_a_group_without_readings_is_a_dash_and_all_else_goes_on(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    code = grouped.METHOD.replace('headline="between within F R2 s apart"', 'headline="level"')
    rows = tuple((*row, "") for row in grouped.FEW)
    folder = grouped.write(tmp_path, rows, "instrument,y [mm],left out", code)
    live = opened(folder, open_page)
    shown = live.page.locator(".headline [data-cell]")
    issued = shown.all_text_contents()
    for reading in (5, 7):
        live.page.locator(f'input[data-use="{reading}"]').uncheck()
    assert shown.all_text_contents() == [*issued[:2], "–"]
    live.type("y", 6, "2.85")
    again = rebuilt(
        folder, ("6,B,2.75", "6,B,2.85"), ("5,C,3.50,", "5,C,3.50,dropped"), ("7,C,3.25,", "7,C,3.25,dropped")
    )
    cells = [cell for cell in live.cells() if cell.name != "y" and cell.value]
    assert driving.differences(cells, again) == []
    for reading in (5, 7):
        live.page.locator(f'input[data-use="{reading}"]').check()
    assert shown.all_text_contents()[::2] == issued[::2]


def test_an_edited_reading_moves_the_roots_of_its_group(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    equation = "q**3 + mean(y, of=instrument) / y * q, y / level"
    more = f'    q = unknown()\n    q = root({equation}, "q", low=0, high=5)\n'
    code = (grouped.METHOD + more).replace("import total, unknown", "import root, total, unknown")
    folder = grouped.write(tmp_path, code=code)
    live, issued = opened(folder, open_page), Study(folder).computed.values
    live.type("y", 6, "2.85")
    again = rebuilt(folder, ("6,B,2.75", "6,B,2.85"))
    cells = [cell for cell in live.cells() if cell.name == "q"]
    assert driving.differences(cells, again) == []
    moved = again.value["q"] != issued.value["q"]
    assert moved.tolist() == [word == "B" for word, _ in grouped.FEW]


def test_pictures_tell_groups_by_their_words_after_an_edit(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    code = grouped.RATES.replace(
        '"logarithm of the rate"', f'"{"logarithm of the rate over the catalyst, " * 2}by its flow"'
    )
    live = opened(grouped.write(tmp_path, grouped.rates(1), grouped.RATES_HEAD, code), open_page)
    live.type("y", 5, "-0.512")
    live.drawn()
    words = list(dict.fromkeys(row[0] for row in grouped.rates(1)))
    for number, more in ((1, ["fit of each catalyst"]), (2, [])):
        figure = live.page.locator(f"#figure-plot_{number} svg")
        keys = figure.locator("g[transform]:has(> text[x])").all_text_contents()
        assert [key for key in keys if key != "as issued"] == [*words, *more]
        rotated = figure.locator('text[transform*="rotate(-90)"]')
        assert rotated.count() > 2
        picture = figure.bounding_box()
        for title in rotated.all():
            box = title.bounding_box()
            assert box["y"] >= picture["y"] + 25 * picture["width"] / 453.54  # below the legend
            assert box["y"] + box["height"] <= picture["y"] + picture["height"]
