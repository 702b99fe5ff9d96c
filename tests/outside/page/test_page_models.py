"""Contact models in the page: their loops follow an edit, and what cannot follow is struck out."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from drawn_files import svg_of
from driving import Live

import loopsheet
from loopsheet.report import stages
from loopsheet.report.study import Study
from loopsheet.report.views import figures, html
from loopsheet.report.workbooks.contact_models_charts import LOOPS

SHIPPED = Path(loopsheet.__file__).parent / "data" / "contact_models"
PANEL = 4
"""The last test has the largest loops."""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """As a build has it, but for what its judge and its proofs say."""
    report = Study(SHIPPED).computed
    drawn = {each.name: svg_of(report, each.drawing) for each in figures.of(report)}
    path = tmp_path_factory.mktemp("models") / "report.html"
    path.write_text(html.render(report, drawn, stages.program(report)), encoding="utf-8")
    return path


@pytest.fixture
def live(page: Path, open_page: Callable[..., Live]) -> Live:
    return open_page(page)


def reaches(live: Live) -> dict[str, float]:
    """How far each loop of a panel goes to the right of the force's axis, in points."""
    paths = live.page.locator(f"#figure-loops svg > g:nth-of-type({PANEL + 1}) > path").evaluate_all(
        "all => all.map((path) => [path.getAttribute('stroke'), path.getAttribute('d')])"
    )
    places = [(colour, [float(x) for x in re.findall(r"[ML](-?[\d.]+) ", d)]) for colour, d in paths]
    axis = min(xs[0] for _, xs in places if len(xs) > 1 and len(set(xs)) > 1)
    found: dict[str, float] = {}
    for colour, xs in places:
        found[colour] = max(found.get(colour, 0.0), max(xs, default=axis) - axis)
    return found


def test_loops_of_models_follow_an_edit(live: Live, tmp_path: Path) -> None:
    picture = live.page.locator("#figure-loops svg")
    assert "Redrawn" not in (picture.get_attribute("aria-label") or "")
    live.type("E_2", "", "70")
    live.drawn()
    assert "Redrawn after an edit" in (picture.get_attribute("aria-label") or "")
    folder = shutil.copytree(SHIPPED, tmp_path / "own", ignore=shutil.ignore_patterns("out"))
    toml = (folder / "report.toml").read_text(encoding="utf-8")
    assert toml.count('E_2 = "210 GPa') == 1
    (folder / "report.toml").write_text(toml.replace('E_2 = "210 GPa', 'E_2 = "70 GPa'), encoding="utf-8")
    value = Study(folder).computed.values.value
    found = reaches(live)
    colours = {series.x.removeprefix("loading_x_"): series.colour for series in LOOPS.series}
    names = ("hertz", "johnson", "thornton", "power")
    expected = {name: float(value[f"x_m_{name}"][PANEL]) for name in names}
    for name in names:
        part = found[colours[name]] / found[colours["thornton"]]
        assert part == pytest.approx(expected[name] / expected["thornton"], abs=2e-4), name
    # Of the law of the paper, which asks for no modulus, nothing moved: below the others is what was.
    assert live.page.locator('#figure-loops svg > g > path[stroke="#c4c4c4"]').count() == 5 * 8
    assert (
        live.page.locator('#figure-loops svg > g > g > path[stroke="#c4c4c4"]').count() == 1
    )  # in the legend


def test_lines_of_tests_at_one_speed_are_seen(live: Live) -> None:
    """A line that leads nowhere to the side has dots, and what is not drawn has no place in the legend."""
    dots = live.page.locator('#figure-imprints svg > path[stroke-width="3"]:not([stroke="#c4c4c4"])')
    for test in range(1, 6):
        assert dots.count() == 0
        live.type("v", str(test), "2.0")
        live.drawn()
    assert dots.count() == 3
    assert "law (3)" not in live.page.locator("#figure-loops svg > g:last-of-type").text_content()


def test_cards_that_an_edit_has_left_behind_are_struck_out(live: Live) -> None:
    def looks() -> tuple[set[str], set[str]]:
        style = "all => all.map((one) => getComputedStyle(one)['%s'])"
        cells, cards = (live.page.locator(f"#cards {what}") for what in ("td:not(.w)", ".card"))
        return set(cells.evaluate_all(style % "textDecorationLine")), set(
            cards.evaluate_all(style % "opacity")
        )

    assert looks() == ({"none"}, {"1"})
    live.type("E_2", "", "70")
    assert looks() == ({"line-through"}, {"0.35"})
    assert live.page.locator("#cards > .stale").is_visible()
