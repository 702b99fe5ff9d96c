"""The digits of an edited page, and what it says of uncertainties: what a build of its files says."""

import random
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from shutil import copytree

import driving
import pytest
from driving import Live
from helpers import method_folder
from uncertain_data import POLES

from loopsheet.report.build import build
from loopsheet.report.cli import main
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study

Open = Callable[..., Live]


@dataclass(frozen=True)
class Edits:
    """What is typed into the page, in this order; indices of given numbers are tests, 0 is a parameter."""

    typed: dict[tuple[str, int], str] = field(default_factory=dict)
    added: tuple[tuple[str, str, str], ...] = ()
    """Speed, restitution and imprint of new tests."""
    left_out: tuple[int, ...] = ()
    removed: tuple[int, ...] = ()

    def make(self, live: Live) -> None:
        for texts in self.added:
            live.click("live-add")
            for text in texts:
                live.page.keyboard.type(text)
                live.press("Tab")
        for (name, test), text in self.typed.items():
            live.type(name, test or "", text)
        for test in self.left_out:
            live.page.locator(f'[data-use="{test}"]').click()
        for test in self.removed:
            live.page.locator(f'[data-remove="{test}"]').click()


def finer(digits: int) -> dict[tuple[str, int], str]:
    """Every measured number with so many more digits."""
    cells = {(name, test): text for test, row in driving.paper().items() for name, text in row.items()}
    cells["ball_diameter", 0] = "12.70"
    return {place: text + "0" * (digits - 1) + "4" for place, text in cells.items()}


def at_random(seed: int) -> Edits:
    """Numbers near those of the paper, printed with one to seven digits in one of the ways people print."""
    dice = random.Random(seed)
    typed = {}
    for test, row in driving.paper().items():
        for name in dice.sample(sorted(row), dice.randint(0, 2)):
            value, digits = float(row[name]) * dice.uniform(0.97, 1.03), dice.randint(1, 7)
            text = dice.choice([f"{value:.{digits}g}", f"{value:.{digits - 1}e}", f"{value:.{digits}f}"])
            typed[name, test] = (
                text.replace("0.", ".", 1) if text.startswith("0.") and dice.random() < 0.5 else text
            )
    added = tuple((f"{5.5:.{n}f}", f"{0.44:.{n + 1}f}", f"{56.6:.{n}f}") for n in range(dice.randint(0, 2)))
    return Edits(typed, added[1:], tuple(dice.sample(range(1, 6), dice.randint(0, 2))))


EDITS = {
    "fewer": Edits({("e", 2): ".9"}),
    "as many": Edits({("x_p", 2): "29.8"}),
    "more in one cell": Edits({("x_p", 2): "29.8000"}),
    "more": Edits(finer(3)),
    "zeros that lead": Edits({("x_p", 2): "0029.8", ("e", 1): "0.053e1"}),
    "nothing": Edits({("e", 3): "0"}),
    "fewer in a parameter": Edits({("ball_diameter", 0): "13"}),
    "an exact number": Edits({("beta", 0): "1"}),
    "a sixth test": Edits(added=(("5.5", "0.44", "56.6"),)),
    "a sixth test as precise": Edits(added=(("5.500", "0.440", "56.60"),)),
    "a coarse test left out": Edits({("v", 3): "4"}, left_out=(3,)),
    "a coarse test removed": Edits({("v", 3): "4"}, added=(("5.500", "0.440", "56.60"),), removed=(3,)),
    "only the finest": Edits({**finer(2), ("v", 1): "2.3"}, left_out=(1,)),
    **{f"random {seed}": at_random(seed) for seed in range(4)},
}


@pytest.mark.parametrize("edits", EDITS.values(), ids=EDITS)
def test_page_shows_what_a_build_of_its_files_shows(
    live: Live, open_page: Open, tmp_path: Path, edits: Edits, report: Report
) -> None:
    issued = live.state()
    edits.make(live)
    folder = driving.compared(live.save(tmp_path / "saved"), published=True)
    built = Study(folder).computed
    fresh = open_page(driving.static(built, tmp_path / "built.html"))
    ours, theirs = (
        [
            cell for cell in page.cells(outside="p") if cell.status or cell.value
        ]  # what is left out says nothing
        for page in (live, fresh)
    )
    assert driving.alike(driving.shown(ours), driving.shown(theirs))
    # In digits of cells terms of second order stay as issued; of a column all are under one power of ten.
    bent = {name for made in (report, built) for name, rows in made.uncertain().second.items() if rows.any()}
    assert "alpha" not in bent
    assert [cell.text for cell in ours if cell.name not in bent] == [
        cell.text for cell in theirs if cell.name not in bent
    ]
    live.wait_for_draws()
    assert uncertain(live) == uncertain(fresh)
    assert driving.alike(live.around(), fresh.around())
    drawn_again(live, {cell.name: cell.text for cell in ours if cell.index == ""})
    live.click("live-reset")
    assert live.state() == issued


def test_a_pair_that_an_edit_makes_sure_is_told_so(open_page: Open, tmp_path: Path) -> None:
    """As issued terms of second order make nearly all of its u; little of it is left, and of them."""
    folder = copytree(PAPER, tmp_path / "near", ignore=lambda *_: ["published.csv", "out"])
    rows = ("1,2.591,0.5148,26.93", "2,4.820,0.4668,49.47", "3,4.827,0.4666,49.49")
    table = folder / "measurements.csv"
    table.write_text("\n".join(("test,v [m/s],e [1],x_p [um]", *rows, "")), encoding="utf-8")
    toml = '[parameters]\nball_mass = "8.366 g"\nbeta = "1.5"\n[measurements]\nfile = "measurements.csv"\n'
    (folder / "report.toml").write_text('workbook = "soft_impact"\n' + toml, encoding="utf-8")
    build(Study(folder), folder / "out", ("html",))
    live = open_page(folder / "out" / "report.html")
    live.type("v", 3, "5.203")
    live.type("x_p", 3, "53.49")
    table.write_text(
        table.read_text(encoding="utf-8").replace("4.827,0.4666,49.49", "5.203,0.4666,53.49"),
        encoding="utf-8",
    )
    built = Study(folder).computed
    pair = next(cell for cell in live.cells() if (cell.name, cell.index) == ("alpha", "2-3"))
    assert pair.text == built.text(built.values.cell("alpha", (2, 3)))


def uncertain(live: Live) -> list[str]:
    """The table of the results with their uncertainties: values, u, k, U and where most of it comes from."""
    texts = "rows => rows.map((row) => Array.from(row.cells, (cell) => cell.textContent).join(' '))"
    found: list[str] = live.page.eval_on_selector_all("#uncertain tbody tr", texts)
    assert found
    # A cell without a value is not in the table that is built.
    return [line for line in found if "#" not in line]


def drawn_again(live: Live, scalars: dict[str, str]) -> None:
    """The numbers in the pictures and in the formula bar have the digits of the tables."""
    live.drawn()
    said = live.page.locator("#figure-alpha_pairs svg text, #figure-loops svg text").all_text_contents()
    means = [text for text in said if text.startswith("mean ") and "speed" not in text]
    assert means in ([], [f"mean {scalars['alpha_mean']}"])
    fitted = [text for text in said if text.startswith("compression fitted")]
    assert fitted in ([], [f"compression fitted to them, α = {scalars['alpha_log']}"])
    live.page.locator("#cell-alpha_log").click(position={"x": 3, "y": 3})
    used = live.page.locator('#bar-dependents button[data-goto="C_log"]')
    assert used.inner_text().startswith(f"C_log {scalars['C_log']}")


def test_digits_follow_the_uncertainty(live: Live) -> None:
    assert live.cell("alpha", "1-3").text == "1.2767"
    live.type("e", 1, "0.5200")
    finer = live.cell("alpha", "1-3").text
    live.type("e", 1, "0.52")
    assert live.cell("alpha", "1-3").text == finer[:-1] or len(live.cell("alpha", "1-3").text) < len(finer)
    assert "as issued: 1.3026" in live.cell("alpha_mean").title.split("; ")


def test_the_bar_says_how_sure_a_cell_is_and_why(live: Live) -> None:
    live.page.locator("#cell-alpha_mean").click(position={"x": 3, "y": 3})
    said = live.text("bar-sure")
    assert "u = 0.0035, U = 0.0067 with k = 1.93 for 95\u00a0%" in said
    assert live.page.locator("#bar-sure button").first.inner_text().split() == ["x_p[1]", "44", "%"]
    live.type("x_p", 1, "23.50")
    live.page.locator("#cell-alpha_mean").click(position={"x": 3, "y": 3})
    assert live.text("bar-sure") != said
    live.page.locator("#bar-sure button").first.click()
    assert live.focused() == "x_p[3]"
    live.page.locator("#cell-C-4-5").click(position={"x": 3, "y": 3})
    assert "u = " in live.text("bar-sure")
    live.page.locator("#cell-C-3-4").click(position={"x": 3, "y": 3})
    assert live.text("bar-sure") == "its uncertainty is of second order …"
    live.wait_for_draws()
    said = live.text("bar-sure")
    assert "for 95\u00a0%; U may not hold: second order counts" in said
    assert re.search(r"second order \d+\s%", said)


def test_input_that_is_refused_has_no_uncertainty(live: Live) -> None:
    live.type("e", 4, "x")
    assert live.cell("alpha", "1-2").text == "1.258"
    live.page.locator("#cell-e-4").click()
    assert not live.page.locator("#bar-sure").is_visible()
    assert uncertain(live)[0].split()[:2] == ["alpha_eiv", live.cell("alpha_eiv").text]


MEANS = """from loopsheet import Method, let, mean, measured


class Means(Method, headline="D"):
    V = measured("V", "a voltage")
    W = measured("V", "another")
    D = let(mean(V) - mean(W), "their difference")
"""


def test_what_is_one_estimate_stands_together_after_an_edit(open_page: Open, tmp_path: Path) -> None:
    """What most of it comes from: all readings of V, by one standard uncertainty with degrees of freedom."""

    def written(name: str, first: str) -> Path:
        rows = f"test,V [V],W [V]\n1,{first},4.1\n2,5.2,4.25\n3,5.1,4.2\n"
        more = '[uncertainty]\nV = "u = 1 % of reading, dof = 6"\nW = "u = 0.05 V"\n'
        return method_folder(tmp_path / name, MEANS, rows, more)

    folder = written("before", "5.0")
    assert main(["build", str(folder), "--to", "html", "--out", str(tmp_path / "out")]) == 0
    live = open_page(tmp_path / "out" / "report.html")
    issued = uncertain(live)
    live.type("V", 1, "8.0")
    edited = uncertain(live)
    again = Study(written("after", "8.0")).computed
    assert edited == uncertain(open_page(driving.static(again, tmp_path / "after.html")))
    assert edited != issued
    assert "V (3\u00a0readings)" in edited[0]
    live.page.locator("#cell-D").click(position={"x": 3, "y": 3})
    of_bar = live.page.locator("#bar-sure > :is(button, span:not(.says))").all_inner_texts()
    assert ["V (3\u00a0readings)" in text for text in of_bar] == [True, False, False, False]


@pytest.mark.parametrize(
    ("issued", "edited"), [("0", "1"), ("20", "0")], ids=["no more of second order", "now of second order"]
)
def test_the_doubt_about_second_order_follows_an_edit(
    open_page: Open, tmp_path: Path, issued: str, edited: str
) -> None:
    """A gauge block at 20 °C and beside it: on its card, in the table and below it, as a build has it."""
    pages = []
    for t in (issued, edited):
        place = copytree(PAPER.parent / "ea_s4", tmp_path / t, ignore=lambda *_: ["out"])
        toml = (place / "report.toml").read_text(encoding="utf-8")
        (place / "report.toml").write_text(toml.replace('\nt = "0 K', f'\nt = "{t} K'), encoding="utf-8")
        assert main(["build", str(place), "--to", "html"]) in (0, 1)
        pages.append(open_page(place / "out" / "report.html", own=True))
    ours, theirs = pages
    ours.type("t", "", edited)
    ours.wait_for_draws()
    assert uncertain(ours) == uncertain(theirs)
    told = [[text for text in page.around() if "U" in text] for page in pages]
    assert driving.alike(*told)
    assert any("U may not hold" in text for text in told[0]) == (edited == "0")


COOLING = """from loopsheet import Method, given, let


class Cooling(Method, headline="q"):
    "What an estimate and a length make."
    r = given("1", "a rate that is estimated")
    h = given("mm", "a length")
    q = let(r * h, "what is sought")
"""


def test_what_an_edit_leaves_of_an_uncertainty_is_struck_out(open_page: Open, tmp_path: Path) -> None:
    """Of other laws the page knows nothing: beside the new value stands no U that passes for its own."""
    more = '[parameters]\nr = "0.25, exponential"\nh = "12.0 mm, u = 0.1 mm"\n'
    method_folder(tmp_path, COOLING, more=more)
    build(Study(tmp_path), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    told, note = live.page.locator(".headline .sure"), live.page.locator(".headline + .stale")
    style = "one => getComputedStyle(one).textDecorationLine"
    assert told.inner_text().startswith("U")
    assert (told.evaluate(style), note.is_visible()) == ("none", False)
    live.page.locator("#cell-h").fill("24.0")
    live.page.locator("#cell-h").press("Enter")
    assert (told.evaluate(style), note.is_visible()) == ("line-through", True)
    assert "as issued" in note.inner_text()
    live.click("live-reset")
    assert (told.evaluate(style), note.is_visible()) == ("none", False)


GAIN = """workbook = "workbook.py"
[parameters]
b = "-3.00 V, u = 0.02"
[measurements]
file = "measurements.csv"
[uncertainty]
V = "u = 0.2 % of reading"
[uncertainty.shared.gain]
of = ["V", "b"]
stated = "u = 1 % of reading"
"""


def test_a_gain_has_the_sign_of_what_is_typed(open_page: Open, tmp_path: Path) -> None:
    def folder(first: str) -> Path:
        made = tmp_path / first
        made.mkdir()
        (made / "workbook.py").write_text(POLES, encoding="utf-8")
        (made / "report.toml").write_text(GAIN, encoding="utf-8")
        (made / "measurements.csv").write_text(f"reading,V [V]\n1,{first}\n2,-5.00\n", encoding="utf-8")
        build(Study(made), made / "out", ("html",))
        return made / "out" / "report.html"

    live = open_page(folder("10.00"))
    live.type("V", 1, "-9.00")
    fresh = open_page(folder("-9.00"))
    live.wait_for_draws()
    assert uncertain(live) == uncertain(fresh)
