"""The digits of an edited page: those that the uncertainties left each cell as issued, whatever is typed."""

import random
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import driving
import pytest
from driving import Live

from loopsheet.report.cells.address import index_text
from loopsheet.report.result.numbers import order, shown
from loopsheet.report.result.result import Report
from loopsheet.report.sheet import Given
from loopsheet.report.study import Study
from loopsheet.report.views.live import digits

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

    @property
    def keeps_the_tests(self) -> bool:
        """Whether the published values, which are about the tests of the paper, can be compared."""
        return not (self.left_out or self.removed)


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
    folder = driving.compared(live.save(tmp_path / "saved"), edits.keeps_the_tests and not edits.added)
    built = Study(folder).computed
    fresh = open_page(driving.static(built, tmp_path / "built.html"))
    ours, theirs = (
        [cell for cell in page.cells() if cell.status or cell.value]  # what is left out says nothing
        for page in (live, fresh)
    )
    assert driving.alike(driving.shown(ours), driving.shown(theirs))
    computed = [
        cell for cell in ours if cell.status == "ok" and not isinstance(report.sheet[cell.name].rule, Given)
    ]
    assert [cell.text for cell in computed] == as_issued(report, computed)
    if built.comparisons:
        assert driving.alike(live.around(), fresh.around())
    drawn_again(live, {cell.name: cell.text for cell in ours if cell.index == ""})
    live.click("live-reset")
    assert live.state() == issued


def as_issued(issued: Report, cells: list[driving.Shown]) -> list[str]:
    """What cells show that keep the number of digits that they have as issued; new ones have the fewest."""
    texts = {}
    for name in {cell.name for cell in cells}:
        column, found = issued.sheet[name], digits(issued, issued.sheet[name])
        labels = [index_text(label) for label in issued.values.labels(column)]
        every = (
            dict.fromkeys(labels, found) if isinstance(found, int) else dict(zip(labels, found, strict=True))
        )
        rows = {
            cell.index: float(cell.value) / issued.shown[name].scale for cell in cells if cell.name == name
        }
        places = [order(value) - every.get(row, min(every.values())) + 1 for row, value in rows.items()]
        for row, figure in zip(rows, shown(rows.values(), places), strict=True):
            texts[name, row] = figure.text if figure else ""
    return [texts[cell.name, cell.index] for cell in cells]


def drawn_again(live: Live, scalars: dict[str, str]) -> None:
    """The numbers in the pictures and in the formula bar have the digits of the tables."""
    said = live.page.locator("#figure-alpha_pairs svg text, #figure-loops svg text").all_text_contents()
    means = [text for text in said if text.startswith("mean ") and "speed" not in text]
    assert means in ([], [f"mean {scalars['alpha_mean']}"])
    fitted = [text for text in said if text.startswith("compression fitted")]
    assert fitted in ([], [f"compression fitted to them, α = {scalars['alpha_log']}"])
    live.page.locator("#cell-alpha_log").click(position={"x": 3, "y": 3})
    used = live.page.locator('#bar-dependents button[data-goto="C_log"]')
    assert used.inner_text().startswith(f"C_log {scalars['C_log']}")


def test_digits_stay_unless_the_size_changes(live: Live) -> None:
    assert live.cell("alpha", "1-3").text == "1.2767"
    for text in (".52", "0.520", "0.5200000"):  # no digits of what is typed
        live.type("e", 1, text)
        assert len(live.cell("alpha_mean").text) == len("1.3026"), text
    assert "as issued: 1.3026" in live.cell("alpha_mean").title.split("; ")
    live.click("live-reset")
    size = live.cell("C_log").text
    live.type("ball_density", "", "7.8")
    assert size == "1.019\u00a0×\u00a010⁹"
    assert live.cell("C_log").text == "1.019\u00a0×\u00a010⁶"
    assert live.cell("Cprime_1", "1-2").text == "1.509"  # of 1509


def test_input_that_is_refused_has_no_digits(live: Live) -> None:
    before = live.cell("alpha", "1-2").text
    live.type("e", 4, "9")  # not allowed
    assert live.cell("alpha", "1-2").text == before
    live.type("e", 4, "x")
    assert live.cell("alpha", "1-2").text == before
