"""Any bytes at all as input: a report folder is read or refused with located findings, nothing else."""

import tempfile
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from loopsheet.report.inputs.cells import check_cells
from loopsheet.report.inputs.inputs import Inputs, load
from loopsheet.report.messages.errors import InputError, UnknownWorkbook, render_all
from loopsheet.report.quantity import Bounds
from loopsheet.report.workbook import Measured, Parameter, Workbook

WORKBOOK = Workbook(
    name="w",
    title="t",
    source="s",
    ledger=lambda: None,
    measured=(
        Measured("v", "m/s", "impact speed", Bounds(0, low_open=True)),
        Measured("e", "1", "ratio", Bounds(0, 1)),
    ),
    parameters=(
        Parameter("beta", "1", "exponent", Bounds(1, 2), default="1.5"),
        Parameter("m", "kg", "mass"),
    ),
    sheet=lambda given: None,
)
TOML = 'workbook = "w"\n[measurements]\nfile = "m.csv"\n[published]\nfile = "p.csv"\n'
CSV = "test,v [m/s],e [1]\n1,2.5,0.5\n2,3.5,0.4\n"
PUBLISHED = "source,cell,index,value,unit,expect,recomputed,reason\nT,a,1,2,1,,,\n"


def find_workbook(name: str, folder: Path, code: bytes | None) -> Workbook:
    if name != "w":
        raise UnknownWorkbook(["w"])
    return WORKBOOK


def read(
    toml: str | bytes = TOML, csv: str | bytes = CSV, published: str | bytes = PUBLISHED
) -> Inputs | None:
    """Read a folder; every finding must have a code and a place, and be safe to show."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in {"report.toml": toml, "m.csv": csv, "p.csv": published}.items():
            (folder / file).write_bytes(
                text if isinstance(text, bytes) else text.encode("utf-8", "surrogatepass")
            )
        try:
            inputs = load(folder, find_workbook)
            check_cells(inputs, {"a": ("1", {(1,)})})
        except InputError as refusal:
            error = refusal
        else:
            return inputs
    assert error.diagnostics
    assert all(finding.at.path.startswith(folder.as_posix()) for finding in error.diagnostics)
    shown = render_all(error.diagnostics)
    assert not [c for c in shown if c != "\n" and not (c.isprintable() or c.isspace())]
    assert "\x1b" not in shown
    assert "\r" not in shown
    assert max(map(len, shown.split("\n"))) < 2000
    return None


def words(text: str) -> list[str]:
    return text.split()


TOML_WORDS = st.sampled_from(
    [
        *words("title workbook parameters measurements published printed file beta m v"),
        *words(r"= . [ ] [[ ]] { } , # - 1 1.5 e inf nan true 2020-01-01 \ \u0000 é"),
        *words('" \' """ \'\'\' "w" "m.csv" "p.csv" "1.5"'),
        *(" ", "\n", "\r\n", '"5 kg"', "\u202e", "\x00"),
    ]
)
CSV_WORDS = st.sampled_from(
    [
        *words("test v e u(v) [m/s] [1] [ ] ( ) , , , ; 1 2 2.5 0.5 1-2 - + e nan inf 1e999"),
        *words("source cell index value unit expect recomputed explained reason differs -> 1->2 #NO! é 日"),
        *("\n", "\n", "\r\n", "\r", "\t", " ", '"', '""', "9" * 120),
        *("\ufeff", "\u202e", "\x00", "\x1b", "\u2028", "\u0301"),
    ]
)


@given(st.binary(max_size=400))
@example(b"\xff\xfe")
@example(b"\xef\xbb\xbf")
@example(b"\x00" * 10)
def test_any_bytes_in_each_file(data: bytes) -> None:
    read(toml=data)
    read(csv=data)
    read(published=data)


@given(st.text(max_size=300))
def test_any_text_as_measurements(text: str) -> None:
    read(csv=text)
    read(csv="test,v [m/s],e [1]\n" + text)
    read(csv=f"test,v [{text}],e [1]\n1,2.5,0.5\n2,3.5,0.4\n")


@given(st.lists(CSV_WORDS, max_size=60).map("".join))
@settings(max_examples=300)
def test_anything_that_looks_like_a_table(text: str) -> None:
    read(csv=text)
    read(csv=CSV + text)
    read(published=text)
    read(published=PUBLISHED + text)


@given(st.text(max_size=300))
def test_any_text_as_report(text: str) -> None:
    read(toml=text)
    read(toml=f"{TOML}# {text}")
    escaped = "".join(f"\\U{ord(c):08x}" for c in text if not 0xD800 <= ord(c) < 0xE000)
    read(toml=f'title = "{escaped}"\n{TOML}[parameters]\nbeta = "{escaped}"\n"{escaped}" = "1"\n')
    read(toml=f'workbook = "w"\nmeasurements.file = "{escaped}"\n')
    read(toml=f'workbook = "{escaped}"\nmeasurements.file = "m.csv"\n')


@given(st.lists(TOML_WORDS, max_size=60).map("".join))
@settings(max_examples=300)
def test_anything_that_looks_like_toml(text: str) -> None:
    read(toml=text)
    read(toml=TOML + text)
    read(toml=f"{TOML}[parameters]\nbeta = {text}\n")


@given(
    st.lists(
        st.tuples(
            st.from_regex(r"[1-9][0-9]{0,3}(\.[0-9]{1,9})?(e-?[0-9]{1,2})?", fullmatch=True),
            st.from_regex(r"0?\.[0-9]{1,15}", fullmatch=True),
        ),
        min_size=2,
        max_size=20,
    ),
    st.sampled_from(["\n", "\r\n", "\r"]),
    st.booleans(),
)
def test_every_digit_comes_back(rows: list[tuple[str, str]], newline: str, quoted: bool) -> None:
    quote = '"' if quoted else ""
    lines = ["test,v [m/s],e [1]", *(f"{k},{quote}{v}{quote},{e}" for k, (v, e) in enumerate(rows, 1))]
    inputs = read(csv=newline.join(lines))
    assert inputs is not None
    assert [number.text for number in inputs.measured["v"]] == [v for v, _ in rows]
    assert [number.text for number in inputs.measured["e"]] == [e for _, e in rows]


@pytest.mark.parametrize(
    "toml",
    [
        "a." * 100_000 + "a = 1",
        "a = " + "[" * 100_000,
        "a = " + "{a=" * 50_000,
        "a = " + "[" * 300 + "]" * 300,
        "a = " + "9" * 10_000,
        "a = 1e" + "9" * 1000,
        "a = 0x" + "f" * 100_000,
        "\n".join(f"k{n} = 1" for n in range(20_000)),
        "title = '" + "x" * 200_000 + "'",
        "\n" * 200_000,
        "'" * 200_000,
        "#" * 250_001,
    ],
    ids=lambda text: text[:12].strip(),
)
def test_a_report_that_wants_to_exhaust_us(toml: str) -> None:
    read(toml=toml)
    read(toml=f"{TOML}\n{toml}")


@pytest.mark.parametrize(
    "csv",
    [
        "a," * 500_000,
        '"' * 500_001,
        '"a' * 100_000,
        '""' * 300_000,
        "[" * 500_000,
        "u(" * 200_000,
        "\r" * 200_000,
        CSV + "3," + "1" * 1_000_000 + ",0.5",
        CSV + "x,y,z\n" * 50_000,
        CSV + "1,2,3,4,5\n" * 50_000,
        CSV + '"1","2"x,3\n' * 50_000,
        f"test,v [{'m*' * 100_000}m],e [1]\n1,2,0.5\n2,3,0.5\n",
        f"test,v [{'(' * 1000}],e [9**9**9]\n1,2,0.5\n2,3,0.5\n",
    ],
    ids=lambda text: text[:24].strip() + str(len(text)),
)
def test_a_table_that_wants_to_exhaust_us(csv: str) -> None:
    assert read(csv=csv) is None
    assert read(published=csv) is None


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('touch owned')",
        "{0.__class__}",
        "{{7*7}}",
        "${7*7}",
        "=cmd|'/c calc'!A1",
        "%s%n",
        "eval(1)",
    ],
)
def test_code_is_only_text(text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    inputs = read(
        toml=f'title = "{text}"\n{TOML}', published=PUBLISHED + f'"{text}",a,1,2,1,differs,2->3,"{text}"\n'
    )
    assert inputs is not None
    assert inputs.title == inputs.published[1].source == inputs.published[1].reason == text
    for place in (
        f"test,v [m/s],e [{text}]\n1,2,3\n2,3,4\n",
        CSV.replace("2.5", f'"{text}"'),
        CSV + f'"{text}",1,1\n',
    ):
        assert read(csv=place) is None
    assert read(toml=f'{TOML}[parameters]\nbeta = "{text}"\n') is None
    assert list(tmp_path.iterdir()) == []
