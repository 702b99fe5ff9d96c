"""The live page: what it embeds, and that its JavaScript reads and prints numbers as Python does."""

import base64
import hashlib
import json
import math
import random
import re
import struct
import subprocess
from collections.abc import Callable
from dataclasses import replace
from decimal import ROUND_HALF_UP, Context, Decimal, localcontext
from fractions import Fraction
from pathlib import Path
from typing import Any

import html5lib
import pytest
from drawn_files import svg_of
from helpers import in_node
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from loopsheet.derivations.unit_text import parse_unit
from loopsheet.report.document.material import Material
from loopsheet.report.document.tree import Math
from loopsheet.report.document.written import placed
from loopsheet.report.engines import javascript
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.inputs.number_text import NumberError, read_printed, read_value
from loopsheet.report.messages.errors import Findings, Location
from loopsheet.report.quantity import Bounds
from loopsheet.report.referee import print_as, prints_same
from loopsheet.report.result.numbers import Numeral, at, decimals, last_place, order, shown, stated
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import compact, html, live, live_files
from loopsheet.report.views.live_uncertain import digits

ROOT = Path(__file__).resolve().parent.parent
LIVE = ROOT / "templates" / "live"
RUNTIME = ROOT / "templates" / "engines" / "runtime.js"

# ------------------------------------------------------------------------------------------ the page


@pytest.fixture(scope="module")
def page(report: Report) -> str:
    drawn = {figure.name: svg_of(report, figure.name) for figure in report.workbook.figures}
    return html.render(report, drawn, program=javascript.program(report.sheet))


@pytest.fixture(scope="module")
def known(report: Report) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(live.data(report, Material(report)))
    return found


def element(page: str, pattern: str) -> str:
    found = re.search(pattern, page, re.DOTALL)
    assert found is not None
    return found[1]


def script_of(page: str) -> str:
    return element(page, r"<script>(.*?)</script>")


def test_page_of_the_paper_is_small(page: str) -> None:
    assert len(page.encode()) <= 400_000


def test_policy_names_the_hashes_of_exactly_this_style_and_this_script(page: str) -> None:
    policy = element(page, r'http-equiv="Content-Security-Policy" content="([^"]*)"')
    policy = policy.replace("&#39;", "'")
    for directive, text in (("style", element(page, r"<style>(.*?)</style>")), ("script", script_of(page))):
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert f"{directive}-src 'sha256-{digest}';" in policy
    assert policy.startswith("default-src 'none';")
    assert "unsafe" not in policy


def test_same_report_makes_the_same_page(report: Report, page: str) -> None:
    drawn = {figure.name: svg_of(report, figure.name) for figure in report.workbook.figures}
    assert html.render(report, drawn, program=javascript.program(report.sheet)) == page


def test_page_without_a_program_has_no_script(report: Report) -> None:
    text = html.render(report, {})
    assert "<script" not in text
    assert "live-dock" not in text


FORBIDDEN = r"\beval\b|\bFunction\(|innerHTML|outerHTML|insertAdjacentHTML|document\.write|DOMParser"


def test_nothing_is_evaluated_and_nothing_is_parsed_as_markup() -> None:
    for path in sorted(LIVE.glob("*.js")):
        text = path.read_text(encoding="utf-8")
        assert not re.search(FORBIDDEN, text), path
        assert len(text.splitlines()) < 300, path


def test_scripts_are_all_there_and_all_in_use() -> None:
    assert sorted(live.SCRIPTS) == sorted(path.name for path in LIVE.glob("*.js"))


def test_scripts_are_javascript(require: Callable[..., str], page: str, tmp_path: Path) -> None:
    path = tmp_path / "script.js"
    path.write_text(script_of(page), encoding="utf-8")
    subprocess.run([require("node"), "--check", str(path)], check=True)


def test_script_begins_and_ends_as_one_element(page: str) -> None:
    tree = html5lib.parse(page, namespaceHTMLElements=False)
    assert len(tree.findall(".//script")) == 2


# ------------------------------------------------------------------------------------------ the data


def test_data_hold_the_inputs_as_printed(known: dict[str, Any], report: Report) -> None:
    (tests,) = known["tables"].values()
    assert [test["label"] for test in tests["rows"]] == [1, 2, 3, 4, 5]
    cells = {"v": "2.940", "e": "0.512", "x_p": "29.7"}
    assert tests["rows"][1] == {"label": 2, "used": True, "reason": "", "cells": cells}
    assert known["parameters"]["beta"] == "1.5"
    assert tests["heads"] == {"test": "test", "v": "v [m/s]", "e": "e [1]", "x_p": "x_p [um]"}
    assert tests["texts"] == {}
    assert set(known["columns"]) == {column.name for column in report.sheet.columns}


def test_data_say_what_inputs_may_be(known: dict[str, Any]) -> None:
    speed, e, count = (known["columns"][name]["given"] for name in ("v", "e", "points_per_pair"))
    assert speed["bounds"] == {"low": "0", "low_open": True}
    assert e["bounds"] == {"low": "0", "high": "1"}
    assert e["allowed"].startswith("between 0 and 1")
    assert count["bounds"]["integer"] is True
    assert known["columns"]["x_p"]["given"]["scale"] == ["1", "1000000"]


def test_pieces_of_the_toml_make_the_file_again(known: dict[str, Any], report: Report) -> None:
    def text(piece: str | dict[str, str]) -> str:
        if isinstance(piece, str):
            return piece
        return "" if "line" in piece else known["parameters"][piece["parameter"]]

    assert "".join(map(text, known["toml"])) == report.inputs.files["report.toml"].decode()
    places = [piece["parameter"] for piece in known["toml"] if isinstance(piece, dict)]
    assert sorted(places) == sorted(known["parameters"])


def test_only_what_is_of_second_order_or_an_uncertainty_keeps_its_digits(
    known: dict[str, Any], report: Report
) -> None:
    for name, column in known["columns"].items():
        if "given" in column:
            assert "digits" not in column
        else:
            shown = column["digits"] if "of" in column else column.get("digits", 4)
            assert shown == digits(report, report.sheet[name])["digits"], name
        second = report.uncertain().second.get(name, ())
        assert len(column.get("kept", ())) == report.values.value[name].size * report.sheet[name].is_u, name
        assert len(column.get("bent", ())) == sum(each != 0 for each in second), name
    row = report.values.row(report.sheet["C"], (3, 4))
    second, u = report.uncertain().second["C"][row], report.uncertain().u["C"][row]
    told = [second, report.values.value["C"][row], u**2 - second]
    assert known["columns"]["C"]["bent"] == {"3-4": pytest.approx(told, rel=1e-5)}
    assert (known["shared"], known["correlated"], known["most"]) == ([], [], 2)


def test_published_values_keep_their_digits(known: dict[str, Any]) -> None:
    (tables, *_) = known["published"]
    assert tables["id"] == "published-Table-2"
    assert tables["rows"][0] == ["alpha", "1-2", "1.234", 0, 0, "1.258", ""]


def test_a_unit_keeps_its_closing_parenthesis() -> None:
    hertz = Study(PAPER.parent / "hertz").computed
    columns = json.loads(live.data(hertz, Material(hertz)))["columns"]
    assert columns["K"]["unit"] == hertz.shown["K"].unit == "N/m^(3/2)"


def test_foreign_text_cannot_end_the_element(tmp_path: Path) -> None:
    nasty = "</script><!-- <script> ]]>"
    (tmp_path / "report.toml").write_text(
        f'title = "{nasty}"\nworkbook = "soft_impact"\n[parameters]\nball_mass = "8.366 g"\n'
        '[measurements]\nfile = "measurements.csv"\n# </script>\n',
        encoding="utf-8",
    )
    (tmp_path / "measurements.csv").write_bytes((PAPER / "measurements.csv").read_bytes())
    strange = Study(tmp_path).computed
    text = live.data(strange, Material(strange))
    assert "<" not in text
    assert json.loads(text)["toml"][-1].endswith("# </script>\n")
    page = html.render(strange, {}, javascript.program(strange.sheet))
    tree = html5lib.parse(page, namespaceHTMLElements=False)
    assert len(tree.findall(".//script")) == 2


def test_equations_have_a_place_for_each_cell(report: Report) -> None:
    document = Material(report)
    found = {part.column.name: part for part in live.parts(report, document)}
    put = placed(report.sheet["x_m1"], report.sheet, document.names)
    printed = put.latex
    assert found["x_m1"].equation == Math(printed)
    assert put.cells == (("x_m2", "p"), ("alpha", "p"), ("v", "i"), ("v", "j"))
    assert r"\left(\frac{\text{@2@}}{\text{@3@}}\right)^{2/(\text{@1@} + 1)}" in printed
    assert r"\text{@0@} \cdot " in printed  # two numbers side by side would be read as one
    assert found["alpha_mean"].equation is None  # a sum has too many terms
    assert found["v"].equation is None


# ------------------------------------------------------------------------------------------ shorter text


def test_short_script_runs_as_the_long_one(require: Callable[..., str], tmp_path: Path) -> None:
    text = r"""
    // a comment with a ` in it
    const a = 1; /* and
    another */ let b = `x ${ a > 0 ? `in ${ a }  side` : "no" }  y`; // the end
    const pattern = /[/"'`]\/ +/g
    const c = "// no comment", d = 'it\'s', e = a - -a
    for (let n = 0; n < 3; n++);
    if (a) { b += "!" }
    const f = () => { return { a, b: 2 } }
    console.log(JSON.stringify([a, b, c, d, e, "x/ y".replace(pattern, "z"), f()]))
    """
    node = require("node")
    long, short = (
        subprocess.run([node, "-e", source], check=True, capture_output=True).stdout
        for source in (text, compact.short_script(text))
    )
    assert long == short
    assert len(compact.short_script(text)) < len(text)


# ------------------------------------------------------------------------------------------ numbers

HARNESS = """
const bytes = (hex) => Uint8Array.from(hex.match(/../g), (b) => parseInt(b, 16));
const doubled = (hex) => new DataView(bytes(hex).buffer).getFloat64(0);
const hexed = (x) => { const view = new DataView(new ArrayBuffer(8)); view.setFloat64(0, x);
  return view.getBigUint64(0).toString(16).padStart(16, "0"); };
const plain = (f) => [f.negative, f.whole, f.fraction, f.exponent, figureText(f)];
const does = {
  rounded: (x, place) => plain(rounded(doubled(x), place)),
  last: (x, u, digits, most) => plain(rounded(doubled(x), lastPlace(doubled(x), doubled(u), digits, most))),
  stepped: (text, by) => stepped(text, by),
  stated: (x, u, most) => stated(doubled(x), doubled(u), most).map(plain),
  decimals: (x, places) => plain(decimals(doubled(x), places)),
  repr: (x) => repr(doubled(x)),
  brief: (x) => brief(doubled(x)),
  shown: (xs, places) => {
    const values = xs.map((x) => x === null ? NaN : doubled(x));
    return shownColumn(values, (row) => places[row]).map((f) => f && plain(f));
  },
  beside: (x, text, [n, d], cut) => beside(doubled(x), text, [n, d].map(BigInt), cut),
  read: (given, text) => {
    const found = readInput({ given }, "", text);
    return found.why ? null : hexed(found.value);
  },
  normalised: (text) => normalised(text),
};
console.log(JSON.stringify(cases.map(([name, ...rest]) => does[name](...rest))));
"""


@pytest.fixture(scope="module")
def in_js(require: Callable[..., str]) -> Callable[[list[list[Any]]], list[Any]]:
    own = [(LIVE / name).read_text(encoding="utf-8") for name in ("numbers.js", "inputs.js")]
    return lambda cases: in_node(require("node"), *own, f"const cases = {json.dumps(cases)};", HARNESS)


def bits(x: float) -> str:
    return struct.pack(">d", x).hex()


def many() -> list[float]:
    """Numbers of all sizes, and those where rounding is decided by the last bit or not at all."""
    dice = random.Random(12)
    found = [dice.uniform(1, 10) * 10.0 ** dice.randint(-12, 15) for _ in range(3000)]
    found += [dice.randint(1, 99999) / 2 ** dice.randint(0, 12) for _ in range(2000)]  # ties among them
    found += [dice.randint(1, 99999) / 10 ** dice.randint(0, 7) for _ in range(2000)]
    found += [0.0, 0.5, 1.5, 2.5, 0.125, 9.995, 99.95, 999999.5, 0.00099995, 0.0009995, 1e-4, 9.5, 1e6]
    return found + [-x for x in found[::3]]


def told(figure: Numeral) -> list[Any]:
    return [figure.negative, figure.whole, figure.fraction, figure.exponent, figure.text]


def test_numbers_are_printed_as_python_does(in_js: Callable[[list[list[Any]]], list[Any]]) -> None:
    cases: list[list[Any]] = []
    wanted: list[Any] = []
    for n, x in enumerate(many()):
        place = order(x) - n % 8
        cases += [["rounded", bits(x), place], ["decimals", bits(x), n % 6]]
        wanted += [told(at(x, place)), told(decimals(x, n % 6))]
        cases += [["repr", bits(x)], ["brief", bits(x)]]
        with localcontext(Context(prec=6, rounding=ROUND_HALF_UP)):
            six = float(+Decimal(f"{x:.14e}"))
        wanted += [repr(x), f"{six:.6g}"]
    assert in_js(cases) == wanted


def test_uncertain_numbers_are_printed_as_python_does(in_js: Callable[[list[list[Any]]], list[Any]]) -> None:
    """With the digits that an uncertainty leaves, one of nothing, and one that is not known."""
    dice, cases, wanted = random.Random(7), [], []
    for x in [*many(), *(dice.uniform(1, 10) * 10.0 ** dice.randint(-250, 250) for _ in range(500))]:
        size = dice.choice((1e-17, 1e-9, 1e-4, 0.01, 0.0996, 0.3, 1, 5, 1e3)) * dice.uniform(0.5, 1)
        u = dice.choice((abs(x) * size, abs(x) * size, abs(x) * size, 0.0, math.nan, 9.96, 0.0996))
        digits, most = dice.randint(1, 7), dice.choice((1, 2))
        cases.append(["last", bits(x), bits(u), digits, most])
        wanted.append(told(at(x, last_place(x, u, digits, most))))
    assert in_js(cases) == wanted


def test_values_and_uncertainties_are_told_as_python_does(
    in_js: Callable[[list[list[Any]]], list[Any]],
) -> None:
    dice, cases, wanted = random.Random(8), [], []
    for x in many():
        u = 10 ** dice.uniform(-9, 1) * abs(x) or dice.choice((0.104, 9.96, 0.95))
        if dice.random() < 0.3:  # halves, and what rounding makes of them
            u = float(f"{u:.1e}".replace("e", "5e")) * (1 + dice.randint(-9, 9) * 1e-16)
        most = dice.choice((1, 2))
        cases.append(["stated", bits(x), bits(u), most])
        wanted.append([told(figure) for figure in stated(x, u, most)])
    assert in_js(cases) == wanted


@pytest.mark.parametrize(
    ("text", "by", "wanted"),
    [
        ("29.7", 1, "29.8"),
        ("2.940", -1, "2.939"),
        ("0.0", -1, "-0.1"),
        ("-0.1", 1, "0.0"),
        ("9.99", 1, "10.00"),
        ("12e2", 1, "13e2"),
        ("1.20E-3", -1, "1.19E-3"),
        (".5", 1, "0.6"),
        ("7", 1, "8"),
        ("abc", 1, "abc"),
    ],
)
def test_a_step_is_one_of_the_last_printed_digit(
    in_js: Callable[[list[list[Any]]], list[Any]], text: str, by: int, wanted: str
) -> None:
    assert in_js([["stepped", text, by]]) == [wanted]


@settings(max_examples=25, suppress_health_check=list(HealthCheck))
@given(st.data())
def test_columns_are_printed_in_one_notation(
    in_js: Callable[[list[list[Any]]], list[Any]], data: st.DataObject
) -> None:
    sizes = st.floats(1e-12, 1e12) | st.just(0.0) | st.none() | st.floats(-1e9, -1e-9)
    column = st.lists(st.tuples(sizes, st.integers(-14, 9)), min_size=1, max_size=6)
    columns = [
        list(zip(*cells, strict=True)) for cells in data.draw(st.lists(column, min_size=1, max_size=60))
    ]
    cases = [["shown", [x if x is None else bits(x) for x in xs], places] for xs, places in columns]
    wanted = [[figure and told(figure) for figure in shown(xs, places)] for xs, places in columns]
    assert in_js(cases) == wanted


printed = st.from_regex(
    r"[+-]?([0-9]{1,18}\.?[0-9]{0,18}|\.[0-9]{1,18})([eE][+-]?[0-9]{1,3})?", fullmatch=True
)


@settings(max_examples=40, suppress_health_check=list(HealthCheck))
@given(st.data())
def test_texts_are_read_to_the_same_double(
    in_js: Callable[[list[list[Any]]], list[Any]], data: st.DataObject
) -> None:
    units = ["um", "mm", "g", "kg/m^3", "1", "km/h", "inch"]
    written = printed | st.text("0123456789.,e+-x ", max_size=8)
    texts = data.draw(st.lists(st.tuples(written, st.sampled_from(units)), min_size=1, max_size=80))
    cases: list[list[Any]] = []
    wanted: list[str | None] = []
    for text, name in texts:
        unit = parse_unit(name)
        scale = [str(unit.scale.numerator), str(unit.scale.denominator)]
        cases.append(["read", {"scale": scale, "bounds": {}, "allowed": ""}, text])
        try:
            wanted.append(bits(float(read_printed(text, unit).value) + 0.0))
        except NumberError:
            wanted.append(None)
    for read, found, expected in zip(texts, in_js(cases), wanted, strict=True):
        assert found == expected, read


ODD = (
    "", " ", "abc", "nan", "NaN", "inf", "-inf", "1e400", "1e-400", "1e301", "0e-301", "0.0e-299", "1.5e-297",
    "1e297", "1e304", "0x10", "1_000", "2,94", "1.2.3", "--1", "+-1", "1e", "e5", ".", "-.5", "+.5", "5.",
    "29.7 um", "2.94 m/s", "29.7um", "1/2", "50%", "true", "#N/A", "\u0663", "\uff11", "\u00bd", "1e+2",
    "1E2", "-0", "-0.0", "+0", "0", "0.000", "1", "1.0", "1.00000000000000000001", "0.99999999999999999999",
    "-1e-300", "1e-299", "2", "2.0", "1.9999999999999999999", "50", "50.0", "5e1", "500e-1", "50.5", "10000",
    "10000.1", "10001", "1" * 101, "9" * 99,
)  # fmt: skip
"""What somebody may type or paste where a number is wanted."""


def test_the_page_refuses_what_the_reader_of_a_folder_refuses(
    in_js: Callable[[list[list[Any]]], list[Any]], known: dict[str, Any], report: Report
) -> None:
    """And reads the same number where it is not refused, in the unit of each header."""
    cases, wanted, refused = [], [], 0
    for name, declared in report.workbook.declared.items():
        if not report.inputs.printed(name):
            continue
        unit = parse_unit(report.inputs.printed(name)[0].unit)
        for text in ODD:
            read = read_value(text, unit, declared, Location("made"), Findings())
            refused += read is None
            cases.append(["read", known["columns"][name]["given"], text])
            wanted.append(None if read is None else bits(float(read.value) + 0.0))
    for case, found, expected in zip(cases, in_js(cases), wanted, strict=True):
        assert found == expected, case
    assert 0.4 < refused / len(cases) < 0.9


@pytest.mark.parametrize(
    ("text", "bounds", "allowed"),
    [
        ("0", Bounds(low=0, low_open=True), False),
        ("1e-9", Bounds(low=0, low_open=True), True),
        ("1", Bounds(low=0, high=1), True),
        ("1.0000000000000000001", Bounds(low=0, high=1), False),
        ("0.1", Bounds(low=0.1, low_open=True), False),
        ("50", Bounds(low=2, high=10000, integer=True), True),
        ("50.5", Bounds(low=2, high=10000, integer=True), False),
    ],
)
def test_bounds_hold_in_the_page_too(
    in_js: Callable[[list[list[Any]]], list[Any]], text: str, bounds: Bounds, allowed: bool
) -> None:
    known = live.limits(bounds)
    (found,) = in_js([["read", {"scale": ["1", "1"], "bounds": known, "allowed": ""}, text]])
    assert (found is not None) == allowed == bounds.allow(Fraction(text))


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("29,8", "29.8"),
        (" 1 234,5 ", "1234.5"),
        ("1.234,5", "1234.5"),
        ("1,234.5", "1234.5"),
        ("1,234", "1,234"),  # never guessed
        ("-12,345", "-12,345"),
        ("0,123", "0.123"),
        ("1,2345", "1.2345"),
        ("−0.5", "-0.5"),
        ("1,2,3", "1,2,3"),
        ("abc", "abc"),
        ("2.940", "2.940"),
        ("1 234 567", "1234567"),
        ("29 7", "29 7"),
        ("1 2345", "1 2345"),
        ("1,234,567.8", "1234567.8"),
        ("1.0,60", "1.0,60"),  # two numbers
        ("1,5.70", "1,5.70"),
        ("12,34.5", "12,34.5"),
        ("0.234,5", "0.234,5"),
        (",5", ".5"),
        (",5.3", ",5.3"),
        ("29.7 um", "29.7 um"),
    ],
)
def test_what_people_write_is_put_into_our_notation(
    in_js: Callable[[list[list[Any]]], list[Any]], text: str, plain: str
) -> None:
    assert in_js([["normalised", text]]) == [plain]


def test_published_values_are_compared_as_python_does(
    in_js: Callable[[list[list[Any]]], list[Any]], report: Report
) -> None:
    dice = random.Random(4)
    cases: list[list[Any]] = []
    wanted: list[dict[str, Any]] = []
    for comparison in report.comparisons:
        for turn in range(40):
            like = replace(comparison.published.printed, mode=("rounded", "truncated")[turn % 2])
            value = float(like.value) * (1 + dice.gauss(0, 0.01) * (turn > 4)) * dice.choice((-1, 1))
            if turn == 4:  # what may have been rounded either way
                value = float(like.value + dice.choice((-1, 1)) * like.half_unit)
            scale = [str(like.scale.numerator), str(like.scale.denominator)]
            cases.append(["beside", bits(value), like.text, scale, like.mode == "truncated"])
            again = print_as(value, like)
            distance = float((Fraction(value) - like.value) / (2 * like.half_unit))
            wanted.append({"again": again, "distance": distance, "same": prints_same(value, like)})
    assert in_js(cases) == wanted
    assert sum(each["same"] for each in wanted) > 40


def test_an_uncertainty_in_parentheses_is_saved_so_that_an_edit_does_not_move_it(tmp_path: Path) -> None:
    """In parentheses it counts units of the last digit: of 8.40 another one than of 8.366."""
    (tmp_path / "measurements.csv").write_bytes((PAPER / "measurements.csv").read_bytes())
    (tmp_path / "report.toml").write_text(
        'workbook = "soft_impact"\n[parameters]\nball_mass = "8.366(4) g"  # (as weighed)\n'
        '[measurements]\nfile = "measurements.csv"\n'
    )
    saved = live_files.given(Study(tmp_path).computed)["toml"]
    assert {piece["parameter"] for piece in saved if "line" in piece} >= {"beta", "points_per_pair"}
    # what has a line of its own is a default: the page writes none that nobody edited
    edited = (
        each if isinstance(each, str) else "" if "line" in each else each.get("behind", "8.40")
        for each in saved
    )  # fmt: skip
    (tmp_path / "report.toml").write_text(toml := "".join(edited))
    assert 'ball_mass = "8.40 g, u = 0.004"  # (as weighed)\n' in toml
    again = Study(tmp_path).inputs.parameters["ball_mass"]
    assert (again.text, again.u) == ("8.40", pytest.approx(4e-6))
