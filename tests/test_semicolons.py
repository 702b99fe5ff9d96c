"""Tables with semicolons: read where their numbers can mean one thing only."""

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest
from helpers import findings_of
from test_inputs import CSV, WITH_PUBLISHED, Findings, Reader, write_and_load

from loopsheet.report.messages.errors import InputError


@pytest.fixture
def read(tmp_path: Path, chdir: Callable[[Path], None]) -> Reader:
    """Give a function that writes a folder and reads it."""
    chdir(tmp_path)
    return write_and_load


@pytest.fixture
def findings(read: Reader) -> Findings:
    """Give a function that returns the findings of a folder as ``code file:line:column+length``."""
    return findings_of(read)


GERMAN = CSV.replace(",", ";").replace(".", ",")


@pytest.mark.parametrize(
    "csv",
    [
        CSV.replace(",", ";"),
        GERMAN,
        GERMAN.replace("\n", "\r\n"),
        "\ufeff" + GERMAN,
        GERMAN.replace("0,530", '"0,530"').replace("1;", " 1 ;"),
    ],
)
def test_semicolons_may_separate_and_commas_be_decimal(csv: str, read: Reader) -> None:
    plain = read(csv=CSV).measured
    other = read(csv=csv).measured
    assert {name: [(p.text, p.value) for p in column] for name, column in other.items()} == {
        name: [(p.text, p.value) for p in column] for name, column in plain.items()
    }


@pytest.mark.parametrize(
    "csv",
    [
        "sep=;\n" + GERMAN,
        "\ufeffsep=;\r\n" + GERMAN.replace("\n", "\r\n"),
        '"sep=;"\n' + CSV.replace(",", ";"),
        "SEP=,\n" + CSV,
    ],
)
def test_a_line_above_may_say_what_separates(csv: str, read: Reader) -> None:
    assert read(csv=csv).measured["x_p"][0] is not None
    plain, other = read(csv=CSV).measured, read(csv=csv).measured
    assert [[p and p.text for p in column] for column in other.values()] == [
        [p and p.text for p in column] for column in plain.values()
    ]
    assert other["v"][0] is not None
    assert other["v"][0].where.startswith("measurements.csv:3:")


def test_what_a_line_above_says_is_believed(findings: Findings) -> None:
    """A comma in the first line of names is one, where semicolons separate; other signs never do."""
    assert findings(csv="sep=;\n" + GERMAN.replace("v [m/s]", "v [m/s],")) == ["LS305 measurements.csv:2:6+8"]
    assert findings(csv="sep=|\n" + CSV.replace(",", "|"))


def test_uncertainties_and_reasons_in_such_a_table(read: Reader) -> None:
    rows = ["1;2,334(5);0,530;2,35e1;", "2;2,940(5);0,512;29,7;", '3;2,9;0,5;30;"1,5; 2,5, or so"']
    found = read(csv="\n".join(["test;v [m/s];e [1];x_p [um];left out", *rows]))
    assert [p.text for p in found.measured["v"]] == ["2.334", "2.940"]
    assert found.measured["v"][0].stated[0].width == Fraction(5, 1000)
    assert [p.text for p in found.measured["x_p"]] == ["2.35e1", "29.7"]
    assert [each.reason for each in found.only.left_out] == ["1,5; 2,5, or so"]


def test_words_do_not_tell_what_a_comma_is(read: Reader) -> None:
    """A date has points in it, and a remark may be a number."""
    rows = ["1;24.11.2026;2,334;0,530;23,5;rim", "2;25.11.2026;2,940;0,512;29,7;3.5", "3;x;2,9;0,5;30;1,5"]
    found = read(csv="\n".join(["test;day;v [m/s];e [1];x_p [um];remark", *rows]))
    assert [p.text for p in found.measured["v"]] == ["2.334", "2.940", "2.9"]
    assert [found.only.texts[n]["remark"] for n in (1, 2, 3)] == ["rim", "3.5", "1,5"]
    assert found.only.texts[1]["day"] == "24.11.2026"


THOUSANDS = "test;v [m/s];e [1];x_p [um]\n1;2,334;1;2,350\n2;2,940;1;2,970\n"


def test_what_could_be_thousands_is_refused(read: Reader, findings: Findings) -> None:
    """Each a little more than two, or some two thousand: told once, with what else a comma may be."""
    assert findings(csv=THOUSANDS) == ["LS409 measurements.csv:2:3+5"]
    assert findings(csv="sep=;\n" + THOUSANDS) == ["LS409 measurements.csv:3:3+5"]
    with pytest.raises(InputError, match=r"v is '2,334'.*numbers like this: 4") as caught:
        read(csv=THOUSANDS)
    assert (
        "write '2.334' or '2334', whichever is meant, and all others so" in caught.value.diagnostics[0].hint
    )
    assert "LS401 measurements.csv:2:15+9" in findings(csv=GERMAN.replace("23,5", "1,002,970"))


@pytest.mark.parametrize(
    ("number", "hint"),
    [
        ("29.7", "write '29,7'"),
        ("29.7(2)", "write '29,7(2)'"),
        ("2.97e1", "write '2,97e1'"),
        ("1.029,7", "write '1029,7'"),
        ("1.029", "write '1,029' or '1029', whichever is meant"),
        ("1.029.700,5", "write '1029700,5'"),
        ("1 029,7", "write '1029,7'"),
        ("1\u202f029\u00a0700,5", "write '1029700,5'"),
        ("1'029,7", "write '1029,7'"),
    ],
)
def test_a_point_among_decimal_commas_is_told_alone(number: str, hint: str, read: Reader) -> None:
    with pytest.raises(InputError) as caught:
        read(csv=GERMAN.replace("29,7", number))
    (found,) = caught.value.diagnostics
    assert (found.code, str(found.at), found.hint) == ("LS408", "measurements.csv:3:15", hint)


def test_what_there_is_less_of_is_wrong(read: Reader, findings: Findings) -> None:
    """A comma among points, too; what is no number at all is told as that, and of a row left out, nothing."""
    assert findings(csv=CSV.replace(",", ";").replace("29.7", "29,7")) == ["LS402 measurements.csv:3:15+4"]
    assert findings(csv=GERMAN.replace("29,7", "24.11.2026")) == ["LS401 measurements.csv:3:15+10"]
    left = ended(GERMAN, ";").replace("um];", "um];left out", 1) + "3;2.9;0.5;30.1;drop was tilted\n"
    assert [p and p.text for p in read(csv=left).measured["v"]] == ["2.334", "2.940"]


def test_semicolons_separate_measurements_alone(findings: Findings) -> None:
    published = "source;cell;index;value;unit\nT;alpha;1-2;1,234;1\n"
    assert findings(WITH_PUBLISHED, published=published) == ["LS308 published.csv:1:7+1"]
    assert findings(csv="test;v [m/s], e;x_p [um]\n1;2,3;4\n2;2,4;5\n")


def ended(text: str, end: str, head: bool = True) -> str:
    """The table with the same at the end of each line."""
    first, rest = text.split("\n", 1)
    return first + end * head + "\n" + rest.replace("\n", end + "\n")


@pytest.mark.parametrize(
    "csv",
    [
        ended(CSV, ","),
        ended(GERMAN, ";;"),
        ended(GERMAN, ' ; "" '),
        ended(CSV, ",", head=False),
        ended(CSV, ",") + ",,,,\n",
        CSV.replace("\n", ",\n", 1),
    ],
)
def test_an_empty_column_at_the_end_is_none(csv: str, read: Reader) -> None:
    assert {name: [p.value for p in column] for name, column in read(csv=csv).measured.items()} == {
        name: [p.value for p in column] for name, column in read(csv=CSV).measured.items()
    }


@pytest.mark.parametrize(
    ("csv", "found"),
    [
        (ended(CSV, ",").replace("29.7,", "29.7,x"), "LS303 measurements.csv:1:29+1"),
        (CSV.replace("29.7", "29.7,"), "LS306 measurements.csv:3:20+1"),
    ],
)
def test_what_stands_at_the_end_of_one_row_is_told(csv: str, found: str, findings: Findings) -> None:
    assert findings(csv=csv) == [found]
