"""Numbers put into equations, as a report shows its calculation."""

import math
import re
from pathlib import Path

import pytest

from loopsheet.report.document.material import Material
from loopsheet.report.document.names import join
from loopsheet.report.document.notation import Notation, read
from loopsheet.report.document.put_in import put_in
from loopsheet.report.study import Study
from loopsheet.report.views.html import render
from loopsheet.report.views.latex import render as render_latex
from loopsheet.report.views.why import why

DATA = Path(__file__).resolve().parents[1] / "data"


def _told(folder: Path) -> dict[str, str]:
    found = put_in(Material(Study(folder).computed))
    return {each.label: " = ".join(join(list(side)) for side in each.sides) for each in found}


def test_hertz_is_calculated_as_on_paper() -> None:
    assert _told(DATA / "hertz") == {
        "(1)": r"R_{c} = \frac{1}{2} \cdot 0.05 = 0.025\,\text{m}",
        "(2)": r"E_{c} = \frac{\left(2 \times 10^{10}\right)}{2 - 2 \cdot 0.3^{2}} = "
        r"1.09890 \times 10^{10}\,\text{Pa}",
        "(3)": r"K = \frac{4}{3} \cdot \left(1.098901099 \times 10^{10}\right) \cdot \sqrt{0.025} = "
        r"2.31669 \times 10^{9}\,\text{N}/\text{m}^{3/2}",
        "(4)": r"F = 2316686931 \cdot 0.004^{1.5} = 586081\,\text{N}",
        "(5)": r"a = \sqrt{0.025 \cdot 0.004} = 0.01\,\text{m}",
        "(6)": r"\sigma = -\frac{3}{2} \cdot \frac{586080.5861}{\pi \cdot 0.01^{2}} = "
        r"-2.79833 \times 10^{9}\,\text{Pa}",
    }


@pytest.mark.parametrize(("name", "cell", "label"), [("kepler", "E", (1,)), ("colebrook", "f", ())])
def test_why_puts_the_root_itself_in(name: str, cell: str, label: tuple[int, ...]) -> None:
    told = why(Study(DATA / name).proved, cell, label)
    (line,) = (line for line in told.splitlines() if line.startswith("  in SI"))
    assert not re.search(rf"\b{cell}\b", line)


def test_an_equation_that_is_solved_has_its_root_in_it() -> None:
    told = _told(DATA / "kepler")["(1)"]
    root, eccentricity, same, mean = map(float, re.findall(r"\d+\.\d+", told))
    assert told == rf"{root} - {eccentricity} \cdot \sin{{\left({same} \right)}} = {mean}"
    assert root - eccentricity * math.sin(root) == pytest.approx(mean, abs=1e-7)


def test_what_is_given_keeps_its_digits_and_what_is_negative_has_brackets() -> None:
    (told,) = _told(DATA / "gum_h1").values()
    assert told == (
        r"l = \left(2.15 \times 10^{-7}\right) + 0.050000623 - 0.050000623 \cdot "
        r"(\left(1.15 \times 10^{-5}\right) \cdot 0 + 0 \cdot (0 + \left(-0.1\right))) = "
        r"0.050000838\,\text{m}"
    )


def _calculated(part: Notation) -> str:
    """What is typed into a calculator for it: an expression of Python."""
    inside = [_calculated(each) for each in part.parts]
    if part.kind == "fraction":
        return f"(({inside[0]})/({inside[1]}))"
    if part.kind == "scripts":
        return f"({inside[0]})**({inside[2]})"
    if part.kind == "root":
        return f"sqrt({inside[0]})"
    if part.kind == "fence":
        return f"({''.join(inside)})"
    if part.kind == "space":
        return ""
    signs = {"−": "-", "·": "*", "×": "*", "π": "pi", "ln": "log"}
    return signs.get(part.text, part.text) + "".join(inside)


@pytest.mark.parametrize("example", ["hertz", "meyer", "gum_h1", "gum_h2", "gum_h3", "misra1a"])
def test_a_calculator_finds_what_comes_out(example: str) -> None:
    known = {name: getattr(math, name) for name in ("sqrt", "log", "exp", "sin", "cos", "pi")}
    shown = [each.sides for each in put_in(Material(Study(DATA / example).computed)) if len(each.sides) == 3]
    assert shown
    for symbol, put, found in shown:
        text = _calculated(read(join(list(found)))).replace("**", "e")
        digits = re.match(r"-?[\d.]+", text)
        assert digits is not None
        places = len(digits[0].partition(".")[2])
        power = int(re.search(r"10\)e\((-?\d+)", text)[1]) if "10)e" in text else 0  # type: ignore[index]
        value = eval(_calculated(read(join(list(put)))), dict(known))
        assert f"{value / 10.0**power:.{places}f}" == digits[0], join(list(symbol))


def test_what_only_renames_a_number_and_the_parts_of_a_fit_are_not_shown() -> None:
    """The slope of Meyer's line is a part of its fit: to put it in says that a number is itself."""
    told = _told(DATA / "meyer")
    assert not [each for each in told.values() if len({*each.split(" = ")[1:]}) == 1]
    assert not [label for label in told if label.startswith("(L")]


def test_page_and_print_have_the_chapter_and_the_paper_has_none(tmp_path: Path) -> None:
    report = Study(DATA / "hertz").proved
    page, print_ = render(report, {}), render_latex(report, ())
    assert len(re.findall('<section id="?put-in"? data-issued', page)) == 1
    assert r"\section{Numbers put in}" in print_
    assert _told(DATA / "soft_steel") == {}
