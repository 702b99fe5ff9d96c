"""The SVG of a figure: the ways, texts and areas that matplotlib draws, in a fraction of its bytes."""

import io
import re
from collections.abc import Callable
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from drawn_files import svg_of
from matplotlib.figure import Figure

from loopsheet.report.result.result import Report
from loopsheet.report.views import drawing, figures
from loopsheet.report.views.svg import written

SVG = "{http://www.w3.org/2000/svg}"
Way = list[tuple[float, float]]


def ways(path: str) -> list[Way]:
    """Where a path goes, told by steps or by places, each time that the pen is set down."""
    here, start, found = (0.0, 0.0), (0.0, 0.0), []
    for letter, rest in re.findall(r"([A-Za-z])([^A-Za-z]*)", path):
        numbers = [float(number) for number in re.findall(r"-?(?:\d+\.?\d*|\.\d+)", rest)]
        if letter == "z":
            here = start
        if letter in "hv":
            numbers = [part for n in numbers for part in ((n, 0.0) if letter == "h" else (0.0, n))]
        size = {"Q": 4, "C": 6}.get(letter.upper(), 2)
        for first in range(0, len(numbers) - size + 1, size):
            some = numbers[first : first + size]
            points = list(zip(some[::2], some[1::2], strict=True))
            if letter.islower():
                points = [(here[0] + x, here[1] + y) for x, y in points]
            if letter in "Mm" and first == 0:
                found.append([])
            found[-1] += points
            here = points[-1]
            start = here if letter in "Mm" else start
    return found


def drawn_ways(svg: str) -> list[Way]:
    """All ways of a picture; what is used in several places is drawn there."""
    root, found = ET.fromstring(svg), []
    named = {element.get("id"): element for element in root.iter() if element.get("id")}
    outline = "scale(0.015625)"  # a letter that a font would draw
    inside = {path for defs in root.iter(f"{SVG}defs") for path in defs.iter(f"{SVG}path")}
    for element in root.iter():
        if element.tag == f"{SVG}path" and element not in inside:
            found += ways(element.get("d", ""))
        elif element.tag == f"{SVG}use" and element.get("x"):
            other = named[next(v for name, v in element.items() if name.endswith("href")).removeprefix("#")]
            if other.get("transform") != outline:
                at = float(element.get("x", "")), float(element.get("y", ""))
                found += [[(x + at[0], y + at[1]) for x, y in way] for way in ways(other.get("d", ""))]
    return found


def theirs(figure: Figure) -> str:
    """The same picture as matplotlib writes it."""
    buffer = io.StringIO()
    with drawing.styled():
        figure.savefig(buffer, format="svg")
    return buffer.getvalue()


def same(one: list[tuple[float, float]], other: list[tuple[float, float]]) -> bool:
    """Whether each place of a way is one of the other's, to a tenth of a point."""
    apart = np.abs(np.array(one)[:, None] - np.array(other)).max(axis=2)
    return bool(max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 0.11)


def is_drawn_alike(ours: str, long: str) -> None:
    """Every way and every text of both, in whatever order."""
    left = drawn_ways(long)
    for way in drawn_ways(ours):
        place = next((n for n, other in enumerate(left) if same(way, other)), None)
        assert place is not None, way
        left.pop(place)
    assert left == []
    said = ["".join(element.itertext()) for element in ET.fromstring(ours).iter(f"{SVG}text")]
    wanted = re.findall(r"<!-- ((?:(?!-->)[\s\S])*) -->", long)
    assert len(said) == len(wanted)
    assert {text for text in wanted if "$" not in text} <= set(said)


@pytest.mark.parametrize("name", ["hysteresis", "lankarani", "loops", "alpha_pairs"])
def test_a_picture_goes_the_same_ways_and_says_the_same(report: Report, name: str) -> None:
    figure = figures.draw(report, name)
    ours, long = svg_of(report, name), theirs(figure)
    assert len(ours) < len(long) / 3
    is_drawn_alike(ours, long)


def picture(paint: Callable[[Figure], object]) -> str:
    figure = Figure(figsize=(4, 3))
    paint(figure)
    return written(figure, "p")


def test_what_a_user_may_draw_is_there() -> None:
    def paint(figure: Figure) -> None:
        axes = figure.add_subplot()
        axes.plot([0, 1, 2], [3, 1, 2], "o--", alpha=0.5, label="a < b & c")
        axes.fill_between([0, 1], [1, 2], [2, 3], hatch="//", facecolor="none", edgecolor="red")
        axes.imshow([[0, 1], [1, 0]], extent=(0, 1, 0, 1), aspect="auto")
        axes.set(xlim=(0.25, 1.5), ylim=(0, 3), title=r"$\frac{a}{b}$ and $x_p$", xlabel="50 \\$")
        axes.legend()

    ours = picture(paint)
    root = ET.fromstring(ours)
    said = ["".join(element.itertext()) for element in root.iter(f"{SVG}text")]
    assert {"a < b & c", "50 $"} <= set(said)
    assert not [text for text in said if "frac" in text]  # notation in two dimensions is drawn
    assert len(list(root.iter(f"{SVG}image"))) == 1
    assert "data:image/png;base64," in ours
    assert len(list(root.iter(f"{SVG}pattern"))) == 1
    named = {element.get("id") for element in root.iter() if element.get("id")}
    assert set(re.findall(r"url\(#([^)]+)\)", ours)) == named
    assert "stroke-opacity:0.5" in ours
    assert "stroke-dasharray" in ours
    assert picture(paint) == ours
    assert not re.search("nan|inf", ours)


def test_the_numbers_of_a_logarithmic_axis_are_texts() -> None:
    ours = picture(lambda figure: figure.add_subplot(yscale="log", ylim=(0.2, 300)))
    said = ["".join(element.itertext()) for element in ET.fromstring(ours).iter(f"{SVG}text")]
    assert {"100", "101", "102"} <= set(said)  # the last digit stands above the line
    assert 'dy="-3"' in ours
    assert "mathdefault" not in ours


@pytest.mark.parametrize("notation", [r"\frac{a}{b}", r"\sqrt{2}", r"\bar{x}", r"\mathbb{R}", r"\ln x"])
def test_notation_that_is_more_than_letters_is_drawn(notation: str) -> None:
    ours = picture(lambda figure: figure.text(0.1, 0.5, f"a ${notation}$"))
    assert not list(ET.fromstring(ours).iter(f"{SVG}text"))
    assert len(list(ET.fromstring(ours).iter(f"{SVG}path"))) > 1
