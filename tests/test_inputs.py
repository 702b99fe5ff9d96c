"""A report folder, read: what is taken, what is refused, and where the findings point."""

import os
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest
from helpers import findings_of

from loopsheet.derivations.unit_text import parse_unit
from loopsheet.report.inputs.cells import check_cells
from loopsheet.report.inputs.inputs import Inputs, load
from loopsheet.report.inputs.number_text import read_printed
from loopsheet.report.inputs.published import Pin
from loopsheet.report.messages.errors import InputError, UnknownWorkbook, diagnose
from loopsheet.report.quantity import Bounds, Printed
from loopsheet.report.workbook import Measured, Parameter, Workbook

PAPER = Path(__file__).parent.parent / "data" / "soft_steel"
POSITIVE = Bounds(low=0, low_open=True)


def combination(given: frozenset[str]) -> str | None:
    if "ball_mass" in given or {"ball_diameter", "ball_density"} <= given:
        return None
    return "give ball_mass, or ball_diameter and ball_density"


WORKBOOK = Workbook(
    name="soft_impact",
    title="Impact of a ball",
    source="A paper",
    ledger=lambda: None,
    measured=(
        Measured("v", "m/s", "impact speed", POSITIVE),
        Measured("e", "1", "restitution coefficient", Bounds(0, 1)),
        Measured("x_p", "m", "imprint depth", POSITIVE),
    ),
    parameters=(
        Parameter("beta", "1", "exponent of restitution", Bounds(1, 2), default="1.5"),
        Parameter("ball_mass", "kg", "mass of the ball", POSITIVE),
        Parameter("ball_diameter", "m", "diameter of the ball", POSITIVE),
        Parameter("ball_density", "kg/m^3", "density of the ball", POSITIVE),
        Parameter("target_mass", "kg", "mass of the target", POSITIVE),
        Parameter("points", "1", "points of a curve", Bounds(2, 1000, integer=True), default="50"),
    ),
    sheet=lambda given: None,
    check_parameters=combination,
)
TOML = """\
title = "Drop tests"
workbook = "soft_impact"
[parameters]
ball_mass = "8.366 g"
[measurements]
file = "measurements.csv"
"""
CSV = "test,v [m/s],e [1],x_p [um]\n1,2.334,0.530,23.5\n2,2.940,0.512,29.7\n"
PUBLISHED = "source,cell,index,value,unit,expect,reason\n"
WITH_PUBLISHED = TOML + '[published]\nfile = "published.csv"\n'


def find_workbook(name: str, folder: Path, code: bytes | None) -> Workbook:
    if name != "soft_impact":
        raise UnknownWorkbook(["soft_impact"])
    return WORKBOOK


Reader = Callable[..., Inputs]


def write_and_load(toml: str = TOML, csv: str | bytes = CSV, published: str | None = None) -> Inputs:
    """Write a folder where we are, and read it."""
    for name, text in {"report.toml": toml, "measurements.csv": csv, "published.csv": published}.items():
        if text is not None:
            Path(name).write_bytes(text if isinstance(text, bytes) else text.encode())
    return load(Path(), find_workbook)


@pytest.fixture
def read(tmp_path: Path, chdir: Callable[[Path], None]) -> Reader:
    """Give a function that writes a folder and reads it."""
    chdir(tmp_path)
    return write_and_load


@pytest.fixture
def findings(read: Reader) -> Callable[..., list[str]]:
    """Give a function that returns the findings of a folder as ``code file:line:column+length``."""
    return findings_of(read)


Findings = Callable[..., list[str]]


# ------------------------------------------------------------------ what is taken


def test_the_paper_is_read_with_its_digits() -> None:
    inputs = load(PAPER, find_workbook)
    assert inputs.title == "Soft steel, ball drop"
    assert inputs.only.tests == (1, 2, 3, 4, 5)
    assert [number.text for number in inputs.measured["x_p"]] == ["23.5", "29.7", "41.6", "45.97", "51.03"]
    assert inputs.measured["x_p"][0].value == Fraction(235, 10**7)
    assert inputs.measured["v"][1].digits == 4
    assert inputs.header_units == {"v": "m/s", "e": "1", "x_p": "um"}
    assert list(inputs.parameters) == ["beta", "ball_diameter", "ball_density", "points"]
    assert inputs.given == {"ball_diameter", "ball_density", "beta"}
    assert inputs.parameters["ball_diameter"].value == Fraction("0.0127")
    assert inputs.parameters["points"].where == ""
    assert sorted(inputs.files) == ["measurements.csv", "published.csv", "report.toml"]
    assert inputs.files["measurements.csv"] == (PAPER / "measurements.csv").read_bytes()


def test_the_paper_s_published_values_fit_a_sheet() -> None:
    inputs = load(PAPER, find_workbook)
    tests = range(1, 6)
    pairs = {(i, j) for i in tests for j in tests if i < j}
    cells = {
        "alpha": ("1", pairs),
        "x_m": ("m", {(k,) for k in tests}),
        "Cprime_eq7": ("N", {(k,) for k in tests}),
        "Cprime_eq9": ("N", {(k,) for k in tests}),
        "alpha_log": ("1", {()}),
        "alpha_mean": ("1", {()}),
        "ball_density": ("kg/m^3", {()}),
        "C_log": ("N/m^alpha_log", {()}),
    }
    check_cells(inputs, cells)
    assert len(inputs.published) == 27
    assert [value.printed.text for value in inputs.published[:10]] == (
        ["1.234", "1.275", "1.286", "1.299", "1.303", "1.315", "1.327", "1.355", "1.367", "1.379"]
    )
    assert {value.index for value in inputs.published[:10]} == pairs
    assert all(value.reason for value in inputs.published if value.expect == "differs")


def test_numbers_know_where_they_stand(read: Reader) -> None:
    inputs = read()
    assert inputs.measured["v"][1].where == "measurements.csv:3:3"
    assert inputs.measured["x_p"][0].where == "measurements.csv:2:15"
    assert inputs.parameters["ball_mass"].where == "report.toml:4:13"


def test_any_compatible_unit_and_any_order_of_columns(read: Reader) -> None:
    csv = "x_p [inch],e [%],test,v [km/h]\n0.001,53.0,7,36\n0.002,51.2,3,72\n"
    inputs = read(csv=csv)
    assert inputs.only.tests == (7, 3)
    assert [number.value for number in inputs.measured["v"]] == [10, 20]
    assert inputs.measured["x_p"][0].value == Fraction(254, 10**7)
    assert inputs.measured["e"][0].value == Fraction(53, 100)
    assert inputs.header_units == {"v": "km/h", "e": "%", "x_p": "inch"}


def stated(number: Printed) -> Fraction | None:
    """The width of the one error that was stated of a number."""
    return None if number.stated is None else number.stated[0].width


def test_given_uncertainties_are_in_si_and_for_their_column(read: Reader) -> None:
    header = "test,v [m/s],u(v) [mm/s],e [1],x_p [um],u( x_p ) [nm]\n"
    csv = header + "1,2.334,1.5,0.530,23.5,40\n2,2.940,2,0.512,29.7,4e1\n"
    inputs = read(csv=csv)
    assert [stated(number) for number in inputs.measured["v"]] == [Fraction(15, 10**4), Fraction(2, 10**3)]
    assert [stated(number) for number in inputs.measured["x_p"]] == [Fraction(4, 10**8)] * 2
    assert [stated(number) for number in inputs.measured["e"]] == [None, None]


@pytest.mark.parametrize(
    "csv",
    [
        "\ufeff" + CSV,
        CSV.replace("\n", "\r\n"),
        CSV.replace("\n", "\r"),
        CSV.rstrip("\n"),
        CSV + "\n\n  \n,,,\n",
        CSV.replace(",", " ,\t"),
        '"test","v [m/s]","e [1]","x_p [um]"\n"1","2.334","0.530","23.5"\n2, "2.940" ,0.512,29.7\n',
        CSV.replace("[um]", "[µm]"),
        CSV.replace("[um]", "[ μm ]"),
        CSV.replace("[m/s]", "[m·s⁻¹]"),
        CSV.replace("[1]", "[-]"),
        CSV.replace("[1]", "[]"),
        CSV.replace("v [", "v["),
        CSV.replace("\n1,", "\n01,"),
    ],
)
def test_tables_as_programs_write_them(csv: str, read: Reader) -> None:
    plain, other = read(), read(csv=csv)
    assert other.only.tests == plain.only.tests
    for name, numbers in plain.measured.items():
        assert [number.text for number in other.measured[name]] == [number.text for number in numbers]
        assert [number.value for number in other.measured[name]] == [number.value for number in numbers]


def test_how_numbers_were_shortened(read: Reader) -> None:
    inputs = read(TOML + '[measurements.printed]\nx_p = "truncated"\n')
    assert {number.mode for number in inputs.measured["x_p"]} == {"truncated"}
    assert {number.mode for number in inputs.measured["v"]} == {"rounded"}


@pytest.mark.parametrize(
    "toml",
    [
        TOML.replace("\n", "\r\n"),
        "\ufeff" + TOML,
        """
        workbook = "soft_impact"
        measurements = {file = "measurements.csv"}
        parameters = {ball_mass = "8.366 g"}
        """,
        """
        workbook = 'soft_impact'
        parameters.ball_mass = '8.366 g'
        measurements . file = 'measurements.csv'
        """,
        TOML.replace("ball_mass", '"ball\\u005fmass"'),
        TOML.replace('"8.366 g"', '"""\n8.366   g"""'),
        TOML.replace('"8.366 g"', '"8.366 \\u0067"'),
    ],
)
def test_toml_as_people_write_it(toml: str, read: Reader) -> None:
    inputs = read(toml)
    assert inputs.parameters["ball_mass"].text == "8.366"
    assert inputs.parameters["ball_mass"].value == Fraction("0.008366")


@pytest.mark.parametrize(
    ("text", "value"), [("8.366e-3 kg", "0.008366"), ("83.66E2 mg", "0.008366"), ("8e+0 g", "0.008")]
)
def test_a_parameter_may_have_a_power_of_ten(text: str, value: str, read: Reader) -> None:
    printed = read(TOML.replace("8.366 g", text)).parameters["ball_mass"]
    assert printed.text == text.split(maxsplit=1)[0]
    assert printed.value == Fraction(value)


def test_without_a_title_the_workbook_s_holds(read: Reader) -> None:
    assert read(TOML.replace('title = "Drop tests"\n', "")).title == "Impact of a ball"


def test_two_hundred_tests(read: Reader) -> None:
    rows = "".join(f"{k},{2 + k / 100:.3f},0.500,{20 + k / 10:.1f}\n" for k in range(1, 201))
    inputs = read(csv="test,v [m/s],e [1],x_p [um]\n" + rows)
    assert inputs.only.tests == tuple(range(1, 201))
    assert len(inputs.measured["v"]) == 200


def test_published_values(read: Reader) -> None:
    rows = (
        'Table 2,alpha,1-2,1.234,1,differs,"a misprint, so\nthey say"\n'
        "Table 3,x_m,2,41.61,um,,\ntext,mean,,1.314,1,,\n"
    )
    values = read(WITH_PUBLISHED, published=PUBLISHED + rows).published
    assert [(value.source, value.cell, value.index) for value in values] == [
        ("Table 2", "alpha", (1, 2)),
        ("Table 3", "x_m", (2,)),
        ("text", "mean", ()),
    ]
    assert (values[0].expect, values[0].reason) == ("differs", "a misprint, so they say")
    assert values[1].printed.value == Fraction("0.00004161")
    assert values[1].where == "published.csv:4:15"


def test_known_differences_say_what_they_differ_to(read: Reader) -> None:
    header = "source,cell,index,value,unit,expect,recomputed,explained,reason\n"
    rows = (
        "T,alpha,1-2,1.234,1,differs,1.234 -> 1.258,,a slip\n"
        "T,x_m,2,41.61,um,differs,41.61->#NOROOT!,,a slip\n"
        "T,x_m,3,55.3,um,differs,,misprint  x_p[2],\nT,mean,,1.314,1,,,,\n"
    )
    one, two, three, four = read(WITH_PUBLISHED, published=header + rows).published
    assert one.pin == Pin("1.234", "1.258")
    assert str(one.pin) == "1.234 -> 1.258"
    assert two.pin == Pin("41.61", "#NOROOT!")
    assert (three.pin, three.explained, three.reason) == (None, "misprint x_p[2]", "")
    assert (four.pin, four.explained, four.expect) == (None, "", "")


@pytest.mark.parametrize(
    ("pin", "again", "holds"),
    [
        ("1.234 -> 1.258", "1.258", True),
        ("+1.234 -> 12.58e-1", "1.258", True),
        ("1.234 -> 1.258", "1.2580", False),  # printed with other digits
        ("1.2340 -> 1.258", "1.258", False),
        ("1.234 -> 1.257", "1.258", False),
        ("1.235 -> 1.258", "1.258", False),
        ("-1.234 -> 1.258", "1.258", False),
        ("1.234 -> #NOROOT!", "#NOROOT!", True),
        ("1.234 -> #NOROOT!", "#DOMAIN!", False),
        ("1.234 -> #NOROOT!", "1.258", False),
        ("1.234 -> 1.258", "#NOROOT!", False),
    ],
)
def test_a_known_difference_is_compared_by_value_and_decimals(pin: str, again: str, holds: bool) -> None:
    printed, _, known = pin.partition(" -> ")
    assert Pin(printed, known).holds(read_printed("1.234", parse_unit("1")), again) is holds


def test_published_values_without_the_optional_columns(read: Reader) -> None:
    values = read(WITH_PUBLISHED, published="source,cell,index,value,unit\nT,alpha,1-2,1.2,1\n").published
    assert (values[0].expect, values[0].reason) == ("", "")


def test_the_user_s_own_workbook_is_part_of_the_inputs(read: Reader) -> None:
    Path("own.py").write_text("# code")
    Path("report.toml").write_text(TOML.replace('"soft_impact"', '"own.py"'))
    Path("measurements.csv").write_text(CSV)
    seen = []
    inputs = load(Path(), lambda *found: seen.append(found) or WORKBOOK)
    assert seen == [("own.py", Path(), b"# code")]
    assert inputs.files["own.py"] == b"# code"


# ------------------------------------------------------------------ what is refused, and where


def test_all_findings_of_all_files_at_once(findings: Findings) -> None:
    toml = WITH_PUBLISHED.replace(
        'ball_mass = "8.366 g"', 'ball_mas = "8.366 g"\nbeta = 1.5\ntarget_mass = "3 m"'
    )
    csv = "test,v [m/s],e [2],x_p [kg]\n1,abc,0.530,23.5\n1,,0.512,-29.7\n"
    assert findings(toml, csv, PUBLISHED + "T,alpha,1to2,1,1,perhaps,\n") == [
        "LS424 measurements.csv:1:17+1",
        "LS422 measurements.csv:1:25+2",
        "LS401 measurements.csv:2:3+3",
        "LS311 measurements.csv:3:1+1",
        "LS501 published.csv:2:9+4",
        "LS502 published.csv:2:18+7",
        "LS203 report.toml:4:1+8",
        "LS206 report.toml:5:8+3",
        "LS422 report.toml:6:18+1",
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("title =", "titel =", ["LS203 report.toml:1:1+5"]),
        ('"Drop tests"', "3", ["LS205 report.toml:1:9+1"]),
        ('"Drop tests"', '" "', ["LS403 report.toml:1:9+3"]),
        ('"Drop tests"', '"a\\u0007b"', ["LS112 report.toml:1:9+10"]),
        ('"Drop tests"', '"""two\nlines"""', ["LS112 report.toml:1:9+6"]),
        ("workbook =", "wrokbook =", ["LS203 report.toml:2:1+8"]),
        ('"soft_impact"', '"../x.py"', ["LS107 report.toml:2:12+9"]),
        ('"soft_impact"', '"x.py"', ["LS104 report.toml:2:12+6"]),
        ("[parameters]", "[parameter]", ["LS203 report.toml:3:2+9"]),
        ("[parameters]", "[[parameters]]", ["LS205 report.toml:3:1+14"]),
        ("[measurements]", "[measurement]", ["LS203 report.toml:5:2+11"]),
        ("[measurements]\nfile", "measurements", ["LS204 report.toml+1", "LS203 report.toml:5:1+12"]),
        ("file =", "fil =", ["LS203 report.toml:6:1+3"]),
        ('file = "measurements.csv"', "", ["LS204 report.toml:5:2+12"]),
        ('"8.366 g"', '"8.366  g"', []),
        ('"8.366 g"', '"8.366g"', ["LS210 report.toml:4:13+8"]),
        ('"8.366 g"', '"8,366 g"', ["LS402 report.toml:4:14+5"]),
        ('"8.366 g"', '"8.366 gg"', ["LS421 report.toml:4:20+2"]),
        ('"8.366 g"', '"8.366 mm"', ["LS422 report.toml:4:20+2"]),
        ('"8.366 g"', '"-8.366 g"', ["LS406 report.toml:4:14+6"]),
        ('"8.366 g"', '"abc mm"', ["LS401 report.toml:4:14+3", "LS422 report.toml:4:18+2"]),
        ('"8.366 g"', '""', ["LS211 report.toml:4:13+2", "LS403 report.toml:4:14+1"]),
        ('"8.366 g"', "true", ["LS205 report.toml:4:13+4"]),
        ('"8.366 g"', "2020-01-01", ["LS205 report.toml:4:13+10"]),
        ('"8.366 g"', "{ mass = 1 }", ["LS203 report.toml:4:15+4"]),
        ('"8.366 g"', "1_000", ["LS206 report.toml:4:13+5"]),
        ('"8.366 g"', "inf", ["LS206 report.toml:4:13+3"]),
        ('"8.366 g"', '"8.366 g"\npoints = "2.5"', ["LS406 report.toml:5:11+3"]),
        ('ball_mass = "8.366 g"', 'ball_diameter = "12.7 mm"', ["LS209 report.toml:3:2+10"]),
        ('"8.366 g"', '"8.366 g"\nball_mass = "1 g"', ["LS201 report.toml:5:18+1"]),
        ('"measurements.csv"', '"/etc/passwd"', ["LS107 report.toml:6:8+13"]),
        ('"measurements.csv"', '"a/../../b.csv"', ["LS107 report.toml:6:8+15"]),
        ('"measurements.csv"', "'C:\\m.csv'", ["LS107 report.toml:6:8+10"]),
        ('"measurements.csv"', "'..\\m.csv'", ["LS107 report.toml:6:8+10"]),
        ('"measurements.csv"', '"a\\u0000b"', ["LS112 report.toml:6:8+10"]),
        ('"measurements.csv"', '"."', ["LS105 report.toml:6:8+3"]),
        ('"measurements.csv"', f'"{"x" * 300}"', ["LS104 report.toml:6:8+302"]),
        ("", "\x07", ["LS112 report.toml:1:1+1"]),
    ],
)
def test_findings_in_report_toml(
    old: str, new: str, expected: list[str], findings: Findings, read: Reader
) -> None:
    assert old in TOML
    toml = TOML.replace(old, new, 1)
    if expected:
        assert findings(toml) == expected
    else:
        read(toml)


@pytest.mark.parametrize(
    ("new", "said"),
    [
        ('"8.366 g', "close the text with a second quotation mark"),
        ("8.3 .. 8.4 g", 'put quotes around a number with its unit, "12.7 mm"'),
        ("5 %", 'put quotes around a number with its unit, "12.7 mm"'),
        ('"8.366" g', ""),
    ],
)
def test_what_quotes_may_be_missing_is_proposed(new: str, said: str, read: Reader) -> None:
    with pytest.raises(InputError) as told:
        read(TOML.replace('"8.366 g"', new, 1))
    assert [each.hint for each in told.value.diagnostics] == [said]


@pytest.mark.parametrize(
    ("csv", "expected"),
    [
        ("test,v [m/s],e [1],x_p [um]\n", ["LS310 measurements.csv:1:28+1"]),
        ("  \n\n", ["LS111 measurements.csv+1"]),
        (",,,\n", ["LS111 measurements.csv:1:1+1"]),
        ("\n" + CSV, ["LS315 measurements.csv:1:1+1"]),
        (CSV.replace("2.334", "0"), ["LS406 measurements.csv:2:3+1"]),
        (CSV.replace("0.530", "1.001"), ["LS406 measurements.csv:2:9+5"]),
        (CSV.replace("0.530", "-0.1"), ["LS406 measurements.csv:2:9+4"]),
        (CSV.replace("0.530", "1"), []),
        (CSV.replace("23.5", "1e-400"), ["LS405 measurements.csv:2:15+6"]),
        (CSV.replace("\n1,", "\n0,"), ["LS312 measurements.csv:2:1+1"]),
        (CSV.replace("\n1,", "\n1.0,"), ["LS312 measurements.csv:2:1+3"]),
        (CSV.replace("\n1,", "\n-1,"), ["LS312 measurements.csv:2:1+2"]),
        (CSV.replace("\n1,", "\n,"), ["LS403 measurements.csv:2:1+1"]),
        (CSV.replace("\n2,", "\n01,"), ["LS311 measurements.csv:3:1+2"]),
        (CSV.replace("test,", "Test,"), ["LS303 measurements.csv:1:1+4"]),
        (CSV.replace("test,", "nr,"), ["LS303 measurements.csv:1:1+2"]),
        (CSV.replace("v [m/s]", "v [m/s"), ["LS305 measurements.csv:1:6+6"]),
        (CSV.replace("v [m/s]", "v, [m/s]"), None),
        (
            CSV.replace("x_p [um]", "x_p [um],u(x) [um]").replace(".5\n", ".5,1\n").replace(".7\n", ".7,1\n"),
            None,
        ),
        (CSV.replace("1,2.334", '1,"2.3""34"'), ["LS401 measurements.csv:2:3+9"]),
        (CSV.replace("[m/s]", "[m/s kg]"), ["LS425 measurements.csv:1:13+2"]),
        (CSV.replace(",", "|"), ["LS308 measurements.csv:1:5+1"]),
        (CSV.replace(",", "\t"), ["LS308 measurements.csv:1:5+1"]),
        (CSV.replace("\n2,", '\n"2,'), ["LS313 measurements.csv:3:1+1"]),
        ("\x89PNG\r\n\x1a\n", ["LS112 measurements.csv:1:1+1"]),
    ],
)
def test_findings_in_the_measurements(
    csv: str, expected: list[str] | None, findings: Findings, read: Reader
) -> None:
    if expected == []:
        read(csv=csv)
        return
    found = findings(csv=csv)
    assert expected is None or sorted(found) == sorted(expected)


@pytest.mark.parametrize(
    "text",
    ["1.258", "1.234 ->", "-> 1.258", "1.234 -> 1,258", "1.234 => 1.258", "1.2 -> 1.3 -> 1.4", "a -> b"],
)
def test_what_is_no_known_difference_is_refused_with_its_place(text: str, findings: Findings) -> None:
    csv = f'source,cell,index,value,unit,expect,recomputed\nT,alpha,1-2,1.234,1,differs,"{text}"\n'
    assert findings(WITH_PUBLISHED, published=csv) == [f"LS507 published.csv:2:30+{len(text)}"]


@pytest.mark.parametrize("name", ["recomputed", "explained"])
def test_what_a_difference_rests_on_needs_a_difference(name: str, findings: Findings) -> None:
    csv = f"source,cell,index,value,unit,expect,{name}\nT,alpha,1-2,1.234,1,,1.2 -> 1.3\n"
    assert findings(WITH_PUBLISHED, published=csv) == ["LS508 published.csv:2:22+10"]


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        ("T,alpha,1–2,1,1,,", ["LS501 published.csv:2:9+3"]),
        ("T,alpha,0,1,1,,", ["LS501 published.csv:2:9+1"]),
        ("T,alpha,1-2-3,1,1,,", ["LS501 published.csv:2:9+5"]),
        ("T,alpha,1-2,1,m?,,", ["LS424 published.csv:2:16+1"]),
        ("T,alpha,1-2,1,,,", ["LS403 published.csv:2:15+1"]),
        (",,1-2,1,1,,", ["LS403 published.csv:2:1+1", "LS403 published.csv:2:2+1"]),
        ("T,alpha,1-2,,1,,", ["LS403 published.csv:2:13+1"]),
        ("T,alpha,1-2,1,1", ["LS306 published.csv:2:16+1"]),
        ("T,alpha,1-2,1,1,,\nT,alpha,1-2,2,1,,", ["LS504 published.csv:3:3+5"]),
    ],
)
def test_findings_in_the_published_values(row: str, expected: list[str], findings: Findings) -> None:
    assert findings(WITH_PUBLISHED, published=PUBLISHED + row + "\n") == expected


@pytest.mark.parametrize(
    ("cell", "code"), [("v[1", "LS505"), ("v1]", "LS505"), ("w[1]", "LS505"), ("v[9]", "LS506")]
)
def test_an_erratum_is_of_a_measured_cell(cell: str, code: str, findings: Findings) -> None:
    toml = WITH_PUBLISHED + f'[published.errata]\n"{cell}" = "2"\n'
    found = findings(toml, published=PUBLISHED)
    assert [finding.partition(" ")[0] for finding in found] == [code]


@pytest.mark.parametrize(
    ("row", "code"),
    [
        ("T,alfa,1-2,1,1,,", "LS505"),
        ("T,alpha,1-3,1,1,,", "LS506"),
        ("T,alpha,1-3,1,1,,\nT,alpha,2-3,1,1,,\nT,alpha,1-2,1,1,,", "LS511"),
        ("T,alpha,,1,1,,", "LS506"),
        ("T,mean,1,1,1,,", "LS506"),
        ("T,alpha,1-2,1,mm,,", "LS422"),
        ("T,C,1-2,1,N/m^alpha,,", None),
        ("T,C,1-2,1,N,,", "LS422"),
        ("T,C,1-2,1,kg/(m s),,", "LS422"),
        ("T,C,1-2,1,N/m^alpha_log,,", "LS422"),
        ("T,alpha,1-2,1,N/m^alpha,,", "LS422"),
    ],
)
def test_published_values_against_the_sheet(row: str, code: str | None, read: Reader) -> None:
    inputs = read(WITH_PUBLISHED, published=PUBLISHED + row + "\n")
    cells = {"alpha": ("1", {(1, 2)}), "mean": ("1", {()}), "C": ("N/m^alpha", {(1, 2)})}
    if code is None:
        check_cells(inputs, cells)
        return
    with pytest.raises(InputError) as caught:
        check_cells(inputs, cells)
    assert [finding.code for finding in caught.value.diagnostics] == [code]
    assert caught.value.diagnostics[0].at.path == "published.csv"


def test_with_an_unknown_workbook_the_rest_is_still_looked_at(findings: Findings) -> None:
    toml = WITH_PUBLISHED.replace("soft_impact", "soft")
    csv = "test,v [m/s],what\n1,2\n1,2,3\n1,2,3\n"
    assert findings(toml, csv, PUBLISHED + "T,a,1x,1,1,,\n") == [
        "LS306 measurements.csv:2:4+1",
        "LS311 measurements.csv:4:1+1",
        "LS501 published.csv:2:5+2",
        "LS207 report.toml:2:12+6",
    ]


def test_with_an_unknown_workbook_nothing_is_said_of_its_cells(findings: Findings) -> None:
    toml = WITH_PUBLISHED.replace("soft_impact", "soft") + '[published.errata]\n"v[1]" = "2"\n'
    assert findings(toml, CSV, PUBLISHED) == ["LS207 report.toml:2:12+6"]


def test_a_word_of_a_table_that_cannot_be_read_is_no_mistake(findings: Findings) -> None:
    """Whether there is such a row is asked once the table can be read; what looks like a date is told now."""
    csv = "test,lot,v [m/s]\n1,A-1\n"
    values = "T,alpha,A-1,1,1,,\nT,alpha,oil A,1,1,,\nT,alpha,1to2,1,1,,\n"
    found = findings(WITH_PUBLISHED, csv, PUBLISHED + values)
    assert [each for each in found if "published" in each] == ["LS501 published.csv:4:9+4"]


def test_what_a_workbook_finds_is_shown_with_the_rest(read: Reader) -> None:
    read()
    error = InputError(diagnose("LS213", text="own.py", reason="it is broken", suggestion=""))

    def fail(name: str, folder: Path, code: bytes | None) -> Workbook:
        raise error

    Path("measurements.csv").write_text("test\n1\n1\n")
    with pytest.raises(InputError) as caught:
        load(Path(), fail)
    assert [finding.code for finding in caught.value.diagnostics] == ["LS213", "LS311"]


def test_links_may_not_lead_out_of_the_folder(read: Reader, tmp_path: Path) -> None:
    read()
    outside = tmp_path.parent / f"{tmp_path.name}-secret.csv"
    outside.write_text("secret,text\n")
    Path("measurements.csv").unlink()
    Path("measurements.csv").symlink_to(outside)
    with pytest.raises(InputError) as caught:
        load(Path(), find_workbook)
    assert [finding.code for finding in caught.value.diagnostics] == ["LS107"]
    assert "secret,text" not in str(caught.value)
    Path("measurements.csv").unlink()
    Path("real.csv").write_text(CSV)
    Path("measurements.csv").symlink_to("real.csv")
    assert load(Path(), find_workbook).only.tests == (1, 2)


@pytest.mark.parametrize(
    "make", [lambda: os.mkfifo("measurements.csv"), lambda: Path("measurements.csv").mkdir()]
)
def test_only_regular_files_are_opened(make: Callable[[], None], read: Reader) -> None:
    read()
    Path("measurements.csv").unlink()
    make()
    with pytest.raises(InputError) as caught:
        load(Path(), find_workbook)
    assert [finding.code for finding in caught.value.diagnostics] == ["LS105"]


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-32", "latin-1", "cp1252"])
def test_other_encodings_are_one_finding(encoding: str, findings: Findings) -> None:
    found = findings(csv=CSV.replace("[um]", "[µm]").encode(encoding))
    assert len(found) == 1
    assert found[0][:5] in {"LS109", "LS110"}


@pytest.mark.parametrize(
    ("head", "help_"),
    [
        ("x_p (mm)", "x_p [mm]"),
        ('"x_p, mm"', "x_p [mm]"),
        ("x_p_mm", "x_p [mm]"),
        ("x_p mm", "x_p [mm]"),
        ("x_p in mm", "x_p [mm]"),
        ("x_p/mm", "x_p [mm]"),
        ("x_p: µm", "x_p [µm]"),
        ("x_p [mm", "x_p [mm]"),
        ("x_p (s)", "x_p [m]"),
        ("x_p (depth)", "x_p [m]"),
        ("imprint (mm)", "imprint [mm]"),
        ("x_p depth", None),
        ("x_p_2", None),
    ],
)
def test_help_for_a_header_keeps_the_user_s_unit(head: str, help_: str | None, read: Reader) -> None:
    with pytest.raises(InputError) as caught:
        read(csv=CSV.replace("x_p [um]", head))
    first = caught.value.diagnostics[0]
    assert (first.code, first.hint if help_ else "") == (
        ("LS305", f"write '{help_}'") if help_ else ("LS303", "")
    )


@pytest.mark.parametrize("magic", [b"PK\x03\x04\x14\x00\x08", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\x00"])
def test_a_spreadsheet_is_told_for_what_it_is(magic: bytes, findings: Findings) -> None:
    assert findings(csv=magic + bytes(range(256))) == ["LS113 measurements.csv+1"]


def test_the_place_of_a_wrong_byte_counts_characters_not_bytes(findings: Findings) -> None:
    assert findings(csv="µµ,\r\nµx\xff".encode("latin-1").replace(b"\xb5", "µ".encode())) == [
        "LS109 measurements.csv:2:3+1"
    ]


def test_paths_in_messages_are_those_the_user_gave(tmp_path: Path) -> None:
    folder = tmp_path / "campaign"
    folder.mkdir()
    (folder / "report.toml").write_text("x = 1\n" + TOML)
    (folder / "measurements.csv").write_text(CSV)
    with pytest.raises(InputError) as caught:
        load(folder, find_workbook)
    assert caught.value.diagnostics[0].at.path == (folder / "report.toml").as_posix()


def test_nothing_of_a_place_depends_on_where_the_folder_is(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "report.toml").write_text(TOML)
        (tmp_path / name / "measurements.csv").write_text(CSV)
    a, b = (load(tmp_path / name, find_workbook) for name in ("a", "b"))
    assert a.measured == b.measured
    assert a.parameters == b.parameters
