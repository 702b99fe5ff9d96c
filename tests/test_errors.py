"""Every sentence: each code of the catalogue is provoked once and compared with tests/hostile/messages.txt.

That file reads as the specification of what users see. After a wanted change of a sentence, run this file
with LOOPSHEET_UPDATE=1 and read the difference.
"""

import hashlib
import json
import os
import re
import shutil
from argparse import Namespace
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from small_report import end_gauge

from loopsheet.report.archive.crate import write as write_crate
from loopsheet.report.archive.scaffold import new
from loopsheet.report.build import built
from loopsheet.report.cli import _parse
from loopsheet.report.files.manifest import read_manifest
from loopsheet.report.files.values import read_result
from loopsheet.report.inputs.cells import check_cells
from loopsheet.report.inputs.folders import PAPER, built_from, report_folder
from loopsheet.report.inputs.inputs import load
from loopsheet.report.machine.staging import own, replaced
from loopsheet.report.messages import errors
from loopsheet.report.messages.catalogue import CATALOGUE
from loopsheet.report.messages.errors import (
    Diagnostic,
    ForeignCode,
    InputError,
    Location,
    LoopsheetError,
    OutputError,
    UnknownWorkbook,
    UsageError,
    diagnose,
    listing,
    render,
    render_all,
    suggest,
)
from loopsheet.report.quantity import Bounds
from loopsheet.report.study import Study
from loopsheet.report.verbs import check
from loopsheet.report.verbs.build import out_of, summary
from loopsheet.report.verbs.common import find
from loopsheet.report.views.validation import TITLE
from loopsheet.report.workbook import Measured, Parameter, Workbook

MESSAGES = Path(__file__).parent / "hostile" / "messages.txt"

POSITIVE = Bounds(low=0, low_open=True)
WORKBOOK = Workbook(
    name="impact",
    title="Impact of a ball",
    source="A paper",
    ledger=lambda: None,
    measured=(
        Measured("v", "m/s", "impact speed", POSITIVE),
        Measured("e", "1", "restitution coefficient", Bounds(0, 1)),
        Measured("x_p", "m", "imprint depth", POSITIVE),
    ),
    parameters=(
        Parameter("ball_mass", "kg", "mass of the ball", POSITIVE),
        Parameter("beta", "1", "exponent of restitution", Bounds(1, 2), default="1.5"),
    ),
    sheet=lambda given: None,
    check_parameters=lambda given: None if "ball_mass" in given else "ball_mass is needed",
)

TOML = """\
workbook = "impact"
[parameters]
ball_mass = "8.366 g"
[measurements]
file = "measurements.csv"
[published]
file = "published.csv"
"""
CSV = """\
test,v [m/s],e [1],x_p [um]
1,2.334,0.530,23.5
2,2.940,0.512,29.7
"""
PUBLISHED = """\
source,cell,index,value,unit,expect,reason
Table 2,alpha,1-2,1.234,1,differs,misprint
"""
CELLS = {"alpha": ("1", {(1, 2)}), "x_m": ("m", {(1,), (2,)})}


def find_workbook(name: str, folder: Path, code: bytes | None) -> Workbook:
    if name != "impact":
        raise UnknownWorkbook(["impact"])
    return WORKBOOK


def campaign(toml: str | bytes = TOML, csv: str | bytes = CSV, published: str | bytes = PUBLISHED) -> None:
    """Write a report folder into the current one, read it and check it against a sheet."""
    for name, text in {"report.toml": toml, "measurements.csv": csv, "published.csv": published}.items():
        Path(name).write_bytes(text if isinstance(text, bytes) else text.encode())
    check_cells(load(Path(), find_workbook), CELLS)


def toml(old: str, new_text: str) -> Callable[[], None]:
    assert old in TOML
    return lambda: campaign(toml=TOML.replace(old, new_text))


def csv(old: str, new_text: str) -> Callable[[], None]:
    assert old in CSV
    return lambda: campaign(csv=CSV.replace(old, new_text))


def published(old: str, new_text: str) -> Callable[[], None]:
    assert old in PUBLISHED
    return lambda: campaign(published=PUBLISHED.replace(old, new_text))


def pinned(fields: str) -> str:
    return PUBLISHED.replace("expect,", "expect,recomputed,").replace("differs", fields)


def replaced_read_only() -> None:
    path = Path("published.csv")
    path.write_text(PUBLISHED)
    path.chmod(0o444)
    replaced(path, PUBLISHED.encode(), b"")


def load_there(name: str) -> Callable[[], None]:
    return lambda: load(Path(name), find_workbook) and None


def foreign_code() -> None:
    def refuse(name: str, *_: object) -> Workbook:
        raise ForeignCode(name)

    for name, text in {"report.toml": TOML, "measurements.csv": CSV, "published.csv": PUBLISHED}.items():
        Path(name).write_text(text)
    load(Path(), refuse)


def grouped(by: str) -> Callable[[], None]:
    def write() -> None:
        words = iter(by)
        table = re.sub(r"(?m)^(?=\d)", lambda _: f"{next(words)},", CSV).replace("test,", "place,test,")
        for name, text in {
            "report.toml": TOML,
            "measurements.csv": table,
            "published.csv": PUBLISHED,
        }.items():
            Path(name).write_text(text)
        load(Path(), lambda *_: replace(WORKBOOK, groups=("place",)))

    return write


def load_a_file() -> None:
    Path("campaign").write_text("")
    load(Path("campaign"), find_workbook)


def a_folder_for_a_file() -> None:
    Path("tests.csv").mkdir()
    campaign(toml=TOML.replace("measurements.csv", "tests.csv"))


def unreadable() -> None:
    """Root may read anything, so the refusal is made here."""
    real = Path.open

    def refuse(path: Path, *args: str) -> object:
        if path.name == "published.csv":
            raise PermissionError(13, "Permission denied")
        return real(path, *args)

    with pytest.MonkeyPatch.context() as patch:
        for name, text in {"report.toml": TOML, "measurements.csv": CSV, "published.csv": ""}.items():
            Path(name).write_text(text)
        patch.setattr(Path, "open", refuse)
        load(Path(), find_workbook)


def few_draws() -> None:
    Path("mass.csv").write_text("ball_mass [g]\n8.365\n8.367\n")
    campaign(toml=TOML.replace("8.366 g", "8.366 g, samples = mass.csv"))


def nothing_to_take() -> None:
    Path("values.json").write_text("{}")
    campaign(toml=TOML.replace('"8.366 g"', '{ from = "values.json", cell = "m" }'))


def record_over_notes() -> None:
    Path("notes.txt").write_text("mine\n")
    own(Path("notes.txt"), TITLE.encode())


def build_over_notes() -> None:
    Path("thesis").mkdir()
    Path("thesis", "notes.txt").write_text("mine\n")
    out_of(Namespace(out="thesis"), Path("campaign"))


def why_of_a_row_left_out() -> None:
    table = "test,v [m/s],e [1],x_p [um],left out\n1,2.334,0.530,23.5,\n2,2.940,0.512,29.7,hit twice\n"
    folder = Path("campaign")
    shutil.copytree(PAPER, folder)
    (folder / "measurements.csv").write_text(f"{table}3,4.089,0.479,41.6,\n")
    (folder / "report.toml").write_text((PAPER / "report.toml").read_text().partition("[published]")[0])
    find(Study(folder).computed, "alpha[1-2]")


def huge() -> None:
    with Path("huge.csv").open("wb") as file:
        file.truncate(50_000_001)  # a hole: no disk is used
    campaign(toml=TOML.replace("measurements.csv", "huge.csv"))


def raises(error: type[LoopsheetError], code: str, **fields: str) -> Callable[[], None]:
    """Stand in for a caller in another module."""

    def call() -> None:
        raise error(diagnose(code, **fields))

    return call


def new_in_a_file() -> None:
    Path("file").write_text("")
    new(Path("file/campaign"), WORKBOOK)


def new_on_a_file() -> None:
    Path("file").write_text("")
    new(Path("file"), WORKBOOK)


def new_in_a_used_folder() -> None:
    Path("used").mkdir()
    Path("used/notes.txt").write_text("")
    new(Path("used"), WORKBOOK)


def build_over_anothers() -> None:
    for name in ("one", "other"):
        Path(name).mkdir()
        end_gauge(Path(name))
    built(Study(Path("other")), Path("other/out"), ("json",), False, lambda _: None, summary)
    built(Study(Path("one")), Path("other/out"), ("json",), False, lambda _: None, summary)


def result_without_cells() -> None:
    Path("values.json").write_text('{"schema": 1, "title": "t", "workbook": "w"}')
    read_result(Path("values.json"))


def crate(date: str, licence: str, digest: str = "") -> None:
    Path("values.json").write_text("{}")
    known = digest or hashlib.sha256(b"{}").hexdigest()
    manifest = {
        "schema": 1,
        "inputs": {"report.toml": "0"},
        "outputs": {"values.json": known},
        "versions": {},
    }
    Path("manifest.json").write_text(json.dumps(manifest))
    write_crate(Path(), date, licence)


def crate_of_a_changed_output() -> None:
    crate("2026-03-31", "MIT", "00")


def the_word_for_a_folder() -> None:
    Path("paper").mkdir()
    Path("paper/report.toml").write_text("")
    report_folder("paper")


CASES: dict[str, Callable[[], None]] = {
    "LS101": load_there("nowhere"),
    "LS102": load_a_file,
    "LS103": load_there("."),
    "LS104": toml('"measurements.csv"', '"measurement.csv"'),
    "LS105": a_folder_for_a_file,
    "LS106": unreadable,
    "LS107": toml('"published.csv"', '"../published.csv"'),
    "LS108": huge,
    "LS109": lambda: campaign(csv=CSV.replace("[um]", "[µm]").encode("latin-1")),
    "LS110": lambda: campaign(csv=CSV.replace("2.940", "2.9\x0040")),
    "LS111": lambda: campaign(csv=""),
    "LS112": csv("29.7", "29.\x1b[2J7"),
    "LS113": lambda: campaign(csv=b"PK\x03\x04" + CSV.encode()),
    "LS201": toml('"8.366 g"', "8.366 g"),
    "LS202": toml("[parameters]", "x = " + "[" * 5000 + "\n[parameters]"),
    "LS203": toml("[parameters]\n", '[parameters]\nbeat = "1.5"\n'),
    "LS204": toml('workbook = "impact"\n', ""),
    "LS205": toml('"8.366 g"', '["8.366 g"]'),
    "LS206": toml('"8.366 g"', "8.3660"),
    "LS207": toml('"impact"', '"impct"'),
    "LS208": toml("[published]", '[measurements.printed]\nx_p = "truncate"\n[published]'),
    "LS209": toml('ball_mass = "8.366 g"\n', ""),
    "LS210": toml('"8.366 g"', '"8.366g"'),
    "LS211": toml('"8.366 g"', '"8.366"'),
    "LS213": raises(
        InputError,
        "LS213",
        text="workbook.py",
        reason="NameError: name 'T' is not defined",
        suggestion="a name stands for its cell from the line on where it is declared",
    ),
    "LS214": foreign_code,
    "LS215": toml("[published]\n", '[published]\nby = "sauce"\n'),
    "LS216": raises(InputError, "LS216", text="oils.csv", known="standards"),
    "LS217": toml("[published]", '[uncertainty]\nplus_minus = "rectt"\n[published]'),
    "LS301": lambda: campaign(csv="test,v [m/s],e [1]\n1,2.334,0.530\n2,2.940,0.512\n"),
    "LS302": lambda: campaign(csv=re.sub(r"(?m)^((.*?),.*)$", r"\1,\2", CSV)),
    "LS303": csv("x_p [um]", "x-p [um]"),
    "LS304": csv("v [m/s]", "v"),
    "LS305": csv("v [m/s]", "v (m/s)"),
    "LS306": csv("2,2.940,", "2,2.940,,"),
    "LS307": lambda: campaign(csv="test,v [m/s],e [1],x_p [um]\n1,2,334,0,530,23,5\n2,2,940,0,512,29,7\n"),
    "LS308": lambda: campaign(csv=CSV.replace(",", "|")),
    "LS309": csv("test,v [m/s],e [1],x_p [um]\n", ""),
    "LS310": csv("2,2.940,0.512,29.7\n", ""),
    "LS311": csv("2,2.940", "1,2.940"),
    "LS312": csv("2,2.940", "two,2.940"),
    "LS313": csv("2,2.940", '"2,2.940'),
    "LS314": csv("2,2.940", '"2"nd,2.940'),
    "LS315": csv("2,2.940", "\n2,2.940"),
    "LS316": lambda: campaign(csv="v," * 300),
    "LS317": toml(
        "[published]", '[measurements.taken]\nx_p = { from = "values.json", cell = "x_p" }\n[published]'
    ),
    "LS318": grouped("77"),
    "LS319": grouped("Bb"),
    "LS320": csv("test,v", "Drop tests of March,,,\ntest,v"),
    "LS321": lambda: campaign(csv=re.sub(r"(?m)$(?=\n)", ",no", CSV).replace(",no", ",left out", 1)),
    "LS401": csv("2.940", "2.9 40"),
    "LS402": csv("2.940", '"2,940"'),
    "LS403": csv("2,2.940", ",2.940"),
    "LS404": csv("2.940", "NaN"),
    "LS405": csv("2.940", "2.940e999999999"),
    "LS406": csv("2.940", "-2.940"),
    "LS407": lambda: campaign(
        csv="test,v [m/s],u(v) [mm/s],e [1],x_p [um]\n1,2.334,-1,0.530,23.5\n2,2.940,1.5,0.512,29.7\n"
    ),
    "LS408": lambda: campaign(csv=CSV.replace(",", ";").replace(".", ",").replace("29,7", "29.7")),
    "LS409": lambda: campaign(csv="test;v [m/s];e [1];x_p [um]\n1;2,334;1;2,350\n2;2,940;1;2,970\n"),
    "LS421": csv("x_p [um]", "x_p [Um]"),
    "LS422": csv("x_p [um]", "x_p [kg]"),
    "LS423": csv("e [1]", "e [dB]"),
    "LS424": csv("v [m/s]", "v [m/s^99]"),
    "LS425": csv("v [m/s]", "v [km/min kg]"),
    "LS431": toml("8.366 g", "8.366 g, U = 0.02"),
    "LS432": toml("8.366 g", "8.366 g +-0.02"),
    "LS433": toml("8.366 g", "8.366(4) g, u = 0.02"),
    "LS434": toml("[published]", '[uncertainty.correlation]\n"v, e" = "1.2"\n[published]'),
    "LS435": toml("[published]", "[uncertainty]\ndigits = 3\n[published]"),
    "LS436": few_draws,
    "LS437": nothing_to_take,
    "LS441": toml("[published]", '[limits]\nalpha_mean = "1.3"\n[published]'),
    "LS442": toml("[published]", '[limits.rule]\nguard = "V"\n[published]'),
    "LS501": published("1-2", "2-Jan"),
    "LS502": published("differs", "differ"),
    "LS504": published("\nTable 2", "\nTable 2,alpha,1-2,1.234,1,,\nTable 2"),
    "LS505": published("alpha", "alfa"),
    "LS506": published("1-2", "2-3"),
    "LS507": lambda: campaign(published=pinned("differs,1.258")),
    "LS508": lambda: campaign(published=pinned(",1.234 -> 1.258")),
    "LS509": published("alpha", "q(alpha)"),
    "LS510": toml("[published]\n", '[published]\nfree = ["x_p"]\n'),
    "LS511": lambda: campaign(
        published=PUBLISHED + "Table 3,x_m,3,55.34,um,,\nTable 2,alpha,1-3,1.275,1,,\n"
    ),
    "LS601": new_in_a_file,
    "LS602": new_on_a_file,
    "LS603": new_in_a_used_folder,
    "LS604": raises(
        UsageError,
        "LS604",
        kind="format",
        text="htm",
        known="html, latex, xlsx or json",
        suggestion=suggest("htm", ["html", "latex", "xlsx", "json"]),
    ),
    "LS605": raises(OutputError, "LS605", kind="pdf", text="latexmk", known="TeX Live, or leave out pdf"),
    "LS606": raises(
        UsageError, "LS606", reason="points has 995000 rows", known="at most 40000 rows in a worksheet"
    ),
    "LS607": result_without_cells,
    "LS608": lambda: read_manifest(Path("out")) and None,
    "LS609": lambda: built_from(Path("out"), {"d.csv": "0"}) and None,
    "LS610": crate_of_a_changed_output,
    "LS611": lambda: crate("31.3.2026", "MIT"),
    "LS612": lambda: crate("2026-03-31", "all mine"),
    "LS613": replaced_read_only,
    "LS614": lambda: check.run(Namespace(accept=False, reason="a slip", folder="paper")) and None,
    "LS615": lambda: report_folder(None) and None,
    "LS616": the_word_for_a_folder,
    "LS617": lambda: _parse(["build", "a", "b"]) and None,
    "LS618": raises(UsageError, "LS618", text="gum_h1"),
    "LS619": raises(
        UsageError, "LS619", reason="at v = 3 m/s the curve gives e = 2, which must be at most 1"
    ),
    "LS621": raises(OutputError, "LS621", text="out", seconds="60"),
    "LS622": raises(UsageError, "LS622", reason="Too many open files"),
    "LS623": record_over_notes,
    "LS624": raises(UsageError, "LS624", text="the report 'Springs'", reason="it has no v and no e"),
    "LS625": raises(
        UsageError,
        "LS625",
        text="IMPACT",
        reason="the formula returns from 0.2000 to 0.9000 at 3 m/s, not 0.1000",
    ),
    "LS626": build_over_notes,
    "LS627": why_of_a_row_left_out,
    "LS628": build_over_anothers,
}


def messages() -> dict[str, str]:
    """Return the expected rendering of each code."""
    parts = re.split(r"(?m)^(?=error\[)", MESSAGES.read_text(encoding="utf-8"))
    return {part[6:11]: part.rstrip("\n") for part in parts if part.startswith("error[")}


def test_the_catalogue_the_cases_and_the_messages_have_the_same_codes() -> None:
    if os.environ.get("LOOPSHEET_UPDATE"):
        pytest.skip("the messages are being written")
    assert list(CATALOGUE) == sorted(CATALOGUE) == list(CASES) == list(messages())


@pytest.mark.parametrize("code", CASES)
def test_a_finding_reads_as_written_in_messages(
    code: str, tmp_path: Path, chdir: Callable[[Path], None]
) -> None:
    chdir(tmp_path)
    with pytest.raises(LoopsheetError) as caught:
        CASES[code]()
    assert [finding.code for finding in caught.value.diagnostics] == [code]  # one problem, one message
    assert caught.value.exit_code == 2
    shown = "\n\n".join(render(finding) for finding in caught.value.diagnostics)
    if os.environ.get("LOOPSHEET_UPDATE"):
        kept = messages() if MESSAGES.exists() else {}
        kept[code] = shown
        MESSAGES.write_text("\n\n".join(kept[key] for key in CASES if key in kept) + "\n", encoding="utf-8")
    assert shown == messages()[code]


def test_the_case_without_mistakes_has_no_finding(tmp_path: Path, chdir: Callable[[Path], None]) -> None:
    chdir(tmp_path)
    campaign()


# ------------------------------------------------------------------ how a finding is shown


def shown(source: str, column: int, length: int = 1) -> tuple[str, str]:
    """Return the line and its carets, without the margin."""
    finding = Diagnostic("LS401", "m", Location("f", 3, column, length, source))
    lines = render(finding).split("\n")
    assert lines[3].startswith(" 3 |")
    return lines[3][5:], lines[4][5:]


@pytest.mark.parametrize(
    ("source", "column", "length", "line", "carets"),
    [
        ("1,abc,2", 3, 3, "1,abc,2", "  ^^^"),
        ("", 1, 1, "", "^"),
        ("ab", 3, 1, "ab", "  ^"),
        ("a\tb\tX", 5, 1, "a   b   X", "        ^"),
        ("\tX", 1, 1, "    X", "^^^^"),
        ("日本X", 3, 1, "日本X", "    ^"),
        ("日本X", 2, 1, "日本X", "  ^^"),
        ("e\u0301\u0308X", 4, 1, "e\u0301\u0308X", " ^"),
        ("a\u0301b", 2, 1, "a\u0301b", " ^"),
        ("\x1b[2J,X", 6, 1, "\\x1b[2J,X", "        ^"),
        ("\u202eX", 2, 1, "\\u202eX", "      ^"),
        ("\U000e0001X", 2, 1, "\\U000e0001X", "          ^"),
        ("x" * 300, 200, 2, "..." + "x" * 100 + "...", " " * 43 + "^^"),
        ("x" * 300, 1, 300, "x" * 100 + "...", "^" * 100),
        ("x" * 300, 299, 2, "..." + "x" * 42, " " * 43 + "^^"),
        ("日" * 300, 200, 1, "..." + "日" * 50 + "...", " " * 43 + "^^"),
        ("x" * 300, 301, 1, "..." + "x" * 40, " " * 43 + "^"),
        ("x" * 101, 5, 1, "x" * 100 + "...", "    ^"),
        ("x" * 100, 5, 1, "x" * 100, "    ^"),
    ],
)
def test_the_caret_is_below_what_it_marks(
    source: str, column: int, length: int, line: str, carets: str
) -> None:
    assert shown(source, column, length) == (line, carets)


def test_a_very_long_line_is_not_walked_through() -> None:
    line, carets = shown("日" * 10_000_000, 9_000_000)
    assert len(line) < 60
    assert carets.endswith("^^")


def test_control_characters_reach_the_terminal_nowhere() -> None:
    evil = "\x1b]0;x\x07\r\u202e\u2028"
    finding = Diagnostic("LS401", evil, Location(evil, 1, 2, 3, evil), evil, evil)
    text = render(finding)
    assert not [character for character in text if character != "\n" and not character.isprintable()]
    assert len(text.split("\n")) == 7


def test_the_arrow_and_the_bar_stand_in_line_for_any_line_number() -> None:
    text = render(Diagnostic("LS401", "m", Location("f.csv", 1234, 1, 1, "abc"), hint="h"))
    assert text.split("\n") == [
        "error[LS401]: m",
        "     --> f.csv:1234:1",
        "      |",
        " 1234 | abc",
        "      | ^",
        "      = help: h",
    ]


def test_colour_adds_only_escape_sequences() -> None:
    finding = Diagnostic("LS401", "m", Location("f", 1, 2, 1, "abc"), "a", "h")
    assert re.sub(r"\x1b\[[0-9;]*m", "", render(finding, color=True)) == render(finding)
    assert render(finding, color=True) != render(finding)


def test_many_findings_are_counted_and_cut() -> None:
    findings = [Diagnostic("LS401", f"m{n}") for n in range(42)]
    assert render_all(findings[:1]).endswith("\n\n1 error")
    assert render_all(findings[:5]).endswith("m4\n\n5 errors")
    assert render_all(findings).endswith("m39\n\n42 errors (2 of them not shown)")


def test_findings_are_sorted_by_file_line_and_column() -> None:
    places = [("b", 1, 1), ("a", 10, 1), ("a", 2, 5), ("a", 2, 1), ("a", None, None)]
    error = InputError(*(Diagnostic("LS401", "m", Location(*place)) for place in places))
    assert [str(finding.at) for finding in error.diagnostics] == ["a", "a:2:1", "a:2:5", "a:10:1", "b:1:1"]
    assert str(error).endswith("5 errors")


def test_a_long_or_evil_word_is_cut_and_made_visible() -> None:
    finding = diagnose("LS312", name="test", suggestion="", text="\x1b" + "{text}" * 1000)
    assert finding.message == "'\\x1b" + ("{text}" * 10)[:56] + "...' is no number of a test"


def test_past_a_thousand_findings_the_rest_is_dropped() -> None:
    findings = errors.Findings()
    for _ in range(1500):
        findings.add("LS312", name="test", text="x", suggestion="")
    assert findings.full
    with pytest.raises(InputError) as caught:
        findings.check()
    assert len(caught.value.diagnostics) == 1000


@pytest.mark.parametrize(
    ("word", "known", "answer"),
    [
        ("beat", ["beta", "ball_mass"], "did you mean 'beta'?"),
        ("BETA", ["beta"], "did you mean 'beta'?"),
        ("zzz", ["beta"], ""),
        ("b" * 100, ["b" * 100], ""),
        ("x", [], ""),
    ],
)
def test_suggestions(word: str, known: list[str], answer: str) -> None:
    assert suggest(word, known) == answer


def test_listings() -> None:
    assert listing([]) == ""
    assert listing(["a"]) == "a"
    assert listing(["a", "b", "c"]) == "a, b or c"
    assert listing(map(str, range(100)), most=2) == "0, 1 ... (100 in all)"


def test_every_sentence_is_plain() -> None:
    for code, entry in CATALOGUE.items():
        assert re.fullmatch(r"LS[1-6]\d\d", code)
        assert entry.title
        assert not entry.title.endswith(".")
        for sentence in entry[1:]:
            assert sentence == sentence.strip()
            assert not sentence.endswith(".")
