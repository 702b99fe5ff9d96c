"""What the page saves builds by itself: with the tests that are left out, and with all other files."""

import shutil
import tomllib
from collections.abc import Callable
from pathlib import Path

import driving
import pytest
from driving import Live
from helpers import method_folder
from two_reports import COLUMN, MASS, lab
from two_reports import folder as written

from loopsheet.report import build, stages
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study

Open = Callable[..., Live]

HEAD = "test,v [m/s],e [1],x_p [um]"


def page_of(folder: Path, place: Path) -> Path:
    build.build(Study(folder), place, ("html",))
    return place / "report.html"


@pytest.mark.usefixtures("unrefereed")
def test_a_test_left_out_stays_with_its_reason(live: Live, open_page: Open, tmp_path: Path) -> None:
    live.page.locator('[data-use="3"]').click()
    assert live.page.locator('[data-reason="2"]').is_hidden()
    live.page.locator('[data-reason="3"]').click()
    live.page.keyboard.type('heard "twice", it seems')
    live.press("Tab")
    struck = "one => getComputedStyle(one).textDecorationLine"
    assert live.input("x_p", 3).evaluate(struck) == "line-through"
    assert live.page.locator('[data-reason="3"]').evaluate(struck) == "none"
    live.page.locator('[data-remove="5"]').click()
    live.type("x_p", 2, "29.80")
    assert live.text("live-banner").startswith("Edited: 3 inputs differ")
    folder = live.save(tmp_path / "saved")
    assert (folder / "measurements.csv").read_text(encoding="utf-8").splitlines() == [
        f"{HEAD},left out",
        "1,2.334,0.530,23.5,",
        "2,2.940,0.512,29.80,",
        '3,4.089,0.479,41.6,"heard ""twice"", it seems"',
        "4,4.504,0.467,45.97,",
        "5,4.993,0.453,51.03,removed",
    ]
    assert (folder / "published.csv").read_bytes() == (PAPER / "published.csv").read_bytes()
    report = Study(folder).computed
    assert report.inputs.only.tests == (1, 2, 4)
    assert driving.differences(live.cells(), report.values) == []
    # In the page of what was saved they are left out, and can be taken in again.
    fresh = open_page(page_of(folder, tmp_path / "out"))
    assert driving.differences(fresh.cells(), report.values) == []
    assert fresh.page.locator("tr.excluded").count() == 2
    assert fresh.page.locator('[data-reason="3"]').input_value() == 'heard "twice", it seems'
    notes = " ".join(fresh.page.locator("#result .note").all_inner_texts())
    assert 'test 3, heard "twice", it seems; 7 published values rest on it' in notes
    assert fresh.text("live-banner") == ""
    for test in (3, 5):
        fresh.page.locator(f'[data-use="{test}"]').click()
    whole = driving.built(tmp_path / "whole", driving.edited({("x_p", 2): "29.80"}))
    assert driving.differences(fresh.cells(), whole.values) == []
    fresh.click("live-reset")
    assert not fresh.page.locator('[data-use="3"]').is_checked()
    assert fresh.page.locator("tr.excluded").count() == 2


def test_an_empty_row_is_dropped(live: Live, tmp_path: Path) -> None:
    live.click("live-add")
    live.type("x_p", 2, "29.8")
    lines = (live.save(tmp_path / "saved") / "measurements.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == HEAD
    assert len(lines) == 6


def test_what_is_being_typed_is_saved(live: Live, tmp_path: Path) -> None:
    """Without Enter: the press on the button must not move it away from under the pointer."""
    live.input("x_p", 2).click()
    live.page.keyboard.type("29.99")
    lines = (live.save(tmp_path / "saved") / "measurements.csv").read_text(encoding="utf-8").splitlines()
    assert lines[2] == "2,2.940,0.512,29.99"


def test_rows_without_numbers_are_saved_without(open_page: Open, tmp_path: Path) -> None:
    folder = shutil.copytree(PAPER, tmp_path / "own")
    table = folder / "measurements.csv"
    head, *lines = [line.partition(",")[2] for line in table.read_text(encoding="utf-8").splitlines()]
    own = [f"{head},specimen", *(f"{line},{name}" for line, name in zip(lines, "EDCBA", strict=True))]
    table.write_text("\n".join([*own, ""]), encoding="utf-8")
    live = open_page(page_of(folder, tmp_path / "out"))
    live.type("x_p", 2, "29.80")
    saved = (live.save(tmp_path / "saved") / "measurements.csv").read_text(encoding="utf-8")
    assert saved.splitlines() == [line.replace("29.7,", "29.80,") for line in own]
    # What goes stays at its place: limits, expectations and shared errors name a row by its number.
    for test in (1, 3):
        live.page.locator(f'[data-remove="{test}"]').click()
    saved = (live.save(tmp_path / "again") / "measurements.csv").read_text(encoding="utf-8")
    said = {line: line + ",removed" * (n in (1, 3)) for n, line in enumerate(own)}
    assert [line.rstrip(",") for line in saved.replace("29.80,", "29.7,").splitlines()] == [
        f"{own[0]},left out",
        *(said[line] for line in own[1:]),
    ]


def test_what_no_build_would_take_is_told(live: Live, tmp_path: Path) -> None:
    live.type("x_p", 2, "abc")
    for name in driving.TITLES:
        live.input(name, 3).click()
        live.press("Delete")
    lines = (live.save(tmp_path / "saved") / "measurements.csv").read_text(encoding="utf-8").splitlines()
    assert "3,4.089,0.479,41.6,its numbers were deleted" in lines
    assert live.text("live-note").endswith("a number that is allowed: x_p[2].")


def test_a_reason_is_taken_back_and_given_again(live: Live) -> None:
    live.page.locator('[data-use="3"]').click()
    why = live.page.locator('[data-reason="3"]')
    why.fill("first")
    live.press("Enter")
    why.fill("second")
    live.press("Enter")
    live.page.locator("#result h2").click()
    live.press("Control+z")
    assert why.input_value() == "first"
    live.press("Control+z", "Control+z")
    assert live.page.locator('[data-use="3"]').is_checked()
    assert live.text("live-banner") == ""


@pytest.mark.usefixtures("unrefereed")
def test_files_keep_their_names_and_a_workbook_comes_along(open_page: Open, tmp_path: Path) -> None:
    folder = tmp_path / "own"
    (folder / "data").mkdir(parents=True)
    (folder / "workbook.py").write_bytes(
        (Path(stages.__file__).parent / "workbooks" / "soft_impact.py")
        .read_bytes()
        .replace(b"from ..", b"from loopsheet.report.")
        .replace(b"from loopsheet.report..", b"from loopsheet.")
        .replace(b"from .", b"from loopsheet.report.workbooks.")
    )
    (folder / "data" / "drops, 2.csv").write_bytes((PAPER / "measurements.csv").read_bytes())
    (folder / "printed.csv").write_bytes((PAPER / "published.csv").read_bytes())
    toml = (PAPER / "report.toml").read_text(encoding="utf-8")
    toml = toml.replace('"soft_impact"', '"workbook.py"').replace('"published.csv"', '"printed.csv"')
    toml = toml.replace('"measurements.csv"', '"data/drops, 2.csv"').replace('by = "source"', "")
    (folder / "report.toml").write_text(toml, encoding="utf-8")
    live = open_page(page_of(folder, tmp_path / "out"))
    live.input("x_p", 2).click()
    if live.page.locator("#bar-toggle").get_attribute("aria-expanded") == "false":
        live.click("bar-toggle")
    assert "given, in data-drops, 2.csv, test 2" in live.text("bar-source")
    live.type("x_p", 2, "29.8")
    saved = live.save(tmp_path / "saved", "workbook.py", "printed.csv", file="data-drops, 2.csv")
    report = Study(saved).computed
    assert driving.differences(live.cells(), report.values) == []
    assert len(report.inputs.published) == 27
    assert (saved / "workbook.py").read_bytes() == (folder / "workbook.py").read_bytes()


@pytest.mark.parametrize("text", ['1.5"', "1.5\\", '1.5"\nx = "1'])
def test_no_parameter_writes_more_than_itself(live: Live, tmp_path: Path, text: str) -> None:
    live.input("beta").fill(text)
    live.press("Enter")
    saved = tomllib.loads((live.save(tmp_path / "saved") / "report.toml").read_text(encoding="utf-8"))
    assert saved["parameters"]["beta"] == text.replace("\n", " ")


@pytest.mark.usefixtures("unrefereed")
def test_what_was_taken_is_saved_as_it_was_or_as_it_was_typed_over(open_page: Open, tmp_path: Path) -> None:
    """A number that is typed over is one of this report: its column goes into the table, without links."""
    file, rows = "lab-out-values.json", "test,v [m/s],e [1]\n1,2.334,0.530\n2,2.940,0.512\n3,4.089,0.479\n"
    taken = {"ball_mass": MASS["m"]}, rows, {"x_p": COLUMN["x"]}
    folder = written(tmp_path / "own", "soft_impact", *taken)
    lab(folder)
    live = open_page(page_of(folder, tmp_path / "out"))
    live.type("v", 2, "2.945")
    saved = live.save(tmp_path / "saved", file)
    report = Study(saved).computed
    assert driving.differences(live.cells(), report.values) == []
    assert report.inputs.taken.keys() == {"ball_mass", "x_p"}
    assert {each.file for each in report.inputs.taken.values()} == {file}
    live.type("x_p", 2, "29.61")
    live.type("ball_mass", "", "0.0084")
    saved = live.save(tmp_path / "again", file)
    told = live.text("live-note")
    assert told.endswith("No longer taken from another report, nor are shared errors: x_p, ball_mass.")
    report = Study(saved).computed
    assert driving.differences(live.cells(), report.values) == []
    assert report.inputs.taken == {}
    assert report.inputs.parameters["ball_mass"].text == "0.0084"
    assert [float(each.text) for each in report.inputs.measured["x_p"]] == pytest.approx(
        [23.5711, 29.61, 41.7254]
    )
    # what a reading has alone: gain and datum are stated no more
    assert [each.u for each in report.inputs.measured["x_p"]] == pytest.approx([1.003 * 0.2e-6] * 3, rel=1e-5)


@pytest.mark.usefixtures("unrefereed")
def test_a_number_that_is_deleted_is_saved_as_missing(live: Live, tmp_path: Path) -> None:
    live.input("x_p", 3).click()
    live.press("Delete")
    folder = live.save(tmp_path / "saved")
    assert (folder / "measurements.csv").read_text(encoding="utf-8").splitlines()[3] == "3,4.089,0.479,"
    assert "No build takes" not in live.text("live-note")
    assert driving.differences(live.cells(), Study(folder).computed.values) == []


DEFAULTS = """
from loopsheet import Method, given, let, mean, measured

class Heats(Method, headline="heat"):
    "Heat of a body."
    T = measured("K", "temperature")
    x = measured("m", "place")
    T_0 = given("K", "temperature before", default="290.10(5) K")
    c = given("J/(kg*K)", "specific heat", default="450 J/(kg*K), U = 9, k = 2")
    m = given("kg", "mass", default="2.0 kg, exact")
    middle = let(mean(x), "mean place", "m")
    heat = let(c * m * (mean(T) - T_0), "heat", "J")
"""


@pytest.mark.parametrize("more", ["", "[parameters]\n"])
def test_an_edited_default_keeps_what_is_stated_of_it(open_page: Open, tmp_path: Path, more: str) -> None:
    rows = "T [K],u(T) [K],x [m]\n300.1,0.2,1.0\n300.4,0.2,2.0\n"
    folder = method_folder(tmp_path / "own", DEFAULTS, rows, more)
    live = open_page(page_of(folder, tmp_path / "out"))
    for name, text in {"T_0": "290.2", "c": "460", "m": "2.5"}.items():
        live.type(name, "", text)
    live.input("T", 1).click()
    live.press("Delete")
    report = Study(live.save(tmp_path / "saved", "workbook.py")).computed
    given = report.inputs.parameters
    assert [given[name].text for name in ("T_0", "c", "m")] == ["290.2", "460", "2.5"]
    assert [given[name].u for name in ("T_0", "c", "m")] == pytest.approx([0.05, 4.5, 0])
    assert report.inputs.printed("T")[0] is None
    assert driving.differences(live.cells(), report.values) == []


@pytest.mark.parametrize(
    ("edited", "saved"), [("T_0", "2.500(40) kg"), ("m", "2.51 kg, u = 0.04")], ids=["another", "itself"]
)
def test_what_was_not_edited_stands_as_it_stood(
    open_page: Open, tmp_path: Path, edited: str, saved: str
) -> None:
    """What stands in parentheses counts units of the last digit: it is written out where that was edited."""
    rows = "T [K],u(T) [K],x [m]\n300.1,0.2,1.0\n"
    folder = method_folder(tmp_path / "own", DEFAULTS, rows, '[parameters]\nm = "2.500(40) kg"\n')
    live = open_page(page_of(folder, tmp_path / "out"))
    live.type(edited, "", {"T_0": "290.2", "m": "2.51"}[edited])
    text = (live.save(tmp_path / "saved", "workbook.py") / "report.toml").read_text(encoding="utf-8")
    assert tomllib.loads(text)["parameters"]["m"] == saved
