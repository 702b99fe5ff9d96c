"""The delivered workbook in LibreOffice: edited, recalculated, and compared cell by cell with NumPy."""

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import spreadsheets
from helpers import method_folder
from small_report import end_gauge

from loopsheet.report.cells.grid import checked
from loopsheet.report.cells.marks import Marks
from loopsheet.report.cells.values import Status
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.uncertain import Decision

HOSTILE = "=cmd|' /C calc'!A0"

EDITS: dict[str, spreadsheets.Edits] = {
    "as issued": {},
    "x_p of test 2": {("x_p", 1): 29.8},
    "no root": {("x_p", 1): 42.0},
    "e of test 3": {("e", 2): 0.9},
    "two roots": {("e", 0): 0.37, ("e", 1): 0.6, ("e", 2): 0.61},
    "an empty input": {("x_p", 1): None},
    "a word for a number": {("v", 3): "fast"},
    "two equal tests": {("v", 1): 2.334, ("e", 1): 0.53, ("x_p", 1): 23.5},
    "nothing measured": {("v", row): None for row in range(5)},
    "no exponent": {("beta", 0): None},
    "other parameters": {("beta", 0): 1.2, ("ball_diameter", 0): 10.0},
    "a test gives nothing back": {("e", 0): 0.0},
    "speeds sorted": {("v", row): v for row, v in enumerate((4.993, 4.504, 4.089, 2.94, 2.334))},
    "three speeds moved on": {("v", 2): 4.993, ("v", 3): 4.089, ("v", 4): 4.504},
    "two e swapped": {("e", 2): 0.467, ("e", 3): 0.479},
    "a negative speed": {("v", 0): -2.0},
    "nothing of a ball": {("ball_diameter", 0): 0.0},
}
PASTED: dict[str, spreadsheets.Edits] = {
    "e a little above 100 %": {("e", 1): 100.000000000001},
    "e below 0": {("e", 1): -0.1},
    "a number as text": {("v", 1): "2.94"},
    "a decimal comma": {("x_p", 1): "29,7"},
    "a space": {("x_p", 1): " "},
    "a truth": {("v", 1): True},
    "no truth": {("e", 1): False},
    "an error": {("v", 1): spreadsheets.Error("#DIV/0!"), ("x_p", 2): spreadsheets.Error("#N/A")},
    "a date for e": {("e", 1): 45413.0},
    "beta of 0": {("beta", 0): 0.0},
    "a mass below 0": {("ball_mass", 0): -8.366},
    "more points": {("points_per_pair", 0): 12.0},
    "fewer points": {("points_per_pair", 0): 9.0},
    "half a point": {("points_per_pair", 0): 10.5},
    "points as text": {("points_per_pair", 0): "10"},
    "points left empty": {("points_per_pair", 0): None},
    "other branches": {("loop_points", 0): 21.0},
    "several at once": {("v", 0): 0.0, ("e", 2): 700.0, ("x_p", 1): -1.0, ("beta", 0): "x"},
}
"""What data validation refuses when it is typed, and does not see when it is pasted."""
ROOTS: spreadsheets.Edits = {("v", 1): 406.32, ("e", 1): 0.64, ("x_p", 1): 16.0}
"""A speed and a depth that no drop test has: four steps do not reach the root of 1-2, eight do."""

TWELVE = [
    (2.0 + 0.31 * n, round(0.54 - 0.009 * n, 3), round(20.5 + 3.3 * n + 0.3 * (n % 3), 1)) for n in range(12)
]


class Office:
    """Every book of this module after LibreOffice has recalculated it, in one run of the program."""

    def __init__(self, soffice: str, folder: Path) -> None:
        self.paper = spreadsheets.paper()
        # The paper with fewer points of each pair, of which an edit moves all alike.
        short = shutil.copytree(PAPER, folder / "short")
        text = (short / "report.toml").read_text()
        (short / "report.toml").write_text(
            text.replace("[measurements]", 'points_per_pair = "5"\n[measurements]')
        )
        units = spreadsheets.folder_with(
            folder / "units", [(7.92, 53.5, 22.58), (11.16, 50.5, 31.92), (15.48, 47.0, 44.61)],
            'points_per_pair = "10"\n', "test,v [km/h],e [%],x_p [um]",
        )  # fmt: skip
        title = f'title = "{HOSTILE}"\n'
        many = spreadsheets.folder_with(folder / "many", TWELVE, 'points_per_pair = "4"\n')
        toml = many / "report.toml"
        toml.write_text(re.sub(r'title = ".*"\n', lambda _: title, toml.read_text()))
        self.delivered = {
            **dict.fromkeys((*EDITS, "steps"), spreadsheets.deliver(short)),
            **dict.fromkeys(("as issued", "one character"), self.paper),
            **dict.fromkeys((*PASTED, "three tests"), spreadsheets.deliver(units)),
            "twelve tests": spreadsheets.deliver(many),
        }
        self.edits = {
            **EDITS,
            **PASTED,
            "steps": ROOTS,
            "three tests": {("e", 1): 50.0},
            "twelve tests": {("x_p", 4): 36.1},
        }
        books = {name: self.delivered[name].edited(edits) for name, edits in self.edits.items()}
        e = self.paper.grid[checked("e")].place.moving(0, "tests")
        books["one character"] = mutated(books["as issued"], e)
        self.read = spreadsheets.recalculate(soffice, folder, books)


def mutated(content: bytes, cell: str) -> bytes:
    """The workbook with one character of one formula changed: a square of e becomes a cube."""
    files = spreadsheets.parts(content)
    name = spreadsheets.part_of(files, "tests")
    text = files[name].decode()
    square = rf"(<f[^>]*>IF\([^<]*1022\),[^<]*?\({re.escape(cell)}\)\^\()2(\)[^<]*</f>)"
    changed, found = re.subn(square, r"\g<1>3\2", text, count=1)
    assert found == 1
    assert sum(a != b for a, b in zip(text, changed, strict=True)) == 1
    files[name] = changed.encode()
    return spreadsheets.packed(files)


@pytest.fixture(scope="module")
def office(require: Callable[..., str], tmp_path_factory: pytest.TempPathFactory) -> Office:
    return Office(require("soffice", "libreoffice"), tmp_path_factory.mktemp("office"))


@pytest.mark.parametrize("name", [*EDITS, *PASTED, "three tests", "twelve tests"])
def test_recalculates_after_an_edit_as_numpy_does(office: Office, name: str) -> None:
    delivered = office.delivered[name]
    values = delivered.values(office.edits[name])
    found = spreadsheets.compare(delivered, values, office.read[name])
    assert not found.wrong, (len(found.wrong), found.wrong[:5])
    assert found.cells == sum(delivered.grid[name].place.rows for name in delivered.every)


@pytest.mark.parametrize("name", ["as issued", "e of test 3", "no root", "an empty input", "twelve tests"])
def test_marks_are_counted_beside_each_mean(office: Office, name: str) -> None:
    delivered = office.delivered[name]
    values, margins = delivered.values(office.edits[name]), delivered.report.marks.margins
    marks, told = Marks(values, margins), set()
    for cell in ("alpha_mean", "alpha_log", "alpha_lin"):
        (axis,) = values.sheet.summed_axes(values.sheet[cell])
        size = values.layouts[axis.name].size
        said = f"{values.counted.get(cell, {}).get(axis.name, size)} of {size} {axis.name}"
        said += "".join(f"; {count.said}" for count in marks.behind(values.sheet[cell]) if count.number)
        assert office.read[name]["report"][f"H{delivered.grid[cell].place.row + 1}"] == said
        told.add("outside (4)" in said)
    assert told == {name in ("e of test 3", "no root", "twelve tests")}


@pytest.mark.parametrize("name", PASTED)
def test_what_is_pasted_is_checked_and_told(office: Office, name: str) -> None:
    """The code stands beside what was pasted, with what it must be, and on the first worksheet."""
    cells, grid = office.read[name], office.delivered[name].grid
    for column, row in PASTED[name]:
        place = grid[column].place
        if column in ("v", "e", "x_p"):
            told = cells["tests"][f"H{place.row + row + 1}"]
        elif column != "loop_points":
            told = cells["report"][f"H{place.row + 1}"]
        else:
            continue  # what only the charts have is told by their gaps
        assert told.startswith("#INPUT! ")
        decides = column == "points_per_pair"
        assert f"{column} decides how many rows" in told if decides else f"{column} must be " in told
    number = sum(column != "loop_points" for column, _ in PASTED[name])
    said = f"#INPUT! given cells that are refused: {number}. "
    assert cells["report"].get("A3", "") == (said if number else "")


def test_nothing_is_told_where_nothing_is_wrong(office: Office) -> None:
    cells = office.read["as issued"]
    assert [cells["tests"][f"H{row}"] for row in range(8, 13)] == ["ok"] * 5
    assert "A3" not in cells["report"]
    assert "A3" not in cells["tests"]


@pytest.mark.parametrize("name", [*EDITS, *PASTED])
def test_a_column_in_another_order_is_told(office: Office, name: str) -> None:
    """Of no other edit: what is not as issued differs in a sum of powers."""
    column = {"speeds sorted": "v", "two e swapped": "e", "three speeds moved on": "v"}.get(name)
    said = f"{column} has its numbers as issued in another order: "
    for worksheet in ("tests", "report"):
        told = office.read[name][worksheet].get("A3", "")
        assert told.startswith(said) if column else "another order" not in told


def test_the_edits_reach_every_error(office: Office) -> None:
    reached = {
        int(status)
        for name in EDITS
        for status in office.delivered[name].values(office.edits[name]).status["alpha"]
    }
    assert reached == set(Status) - {
        Status.OVERFLOW,
        Status.UNDECIDED,
    }  # no exponent is too large, or uncounted


def test_the_promised_edit(office: Office) -> None:
    alpha, mean = (office.delivered["x_p of test 2"].grid[name].place for name in ("alpha", "alpha_mean"))
    cells = office.read["x_p of test 2"]
    assert cells["pairs"][alpha.cell(0, "pairs").replace("$", "")] == pytest.approx(1.2277, abs=5e-5)
    assert cells["report"][mean.cell(0, "report").replace("$", "")] == pytest.approx(1.3049, abs=5e-5)


def test_what_is_stored_is_what_is_recalculated(office: Office) -> None:
    """In every cell of every worksheet: texts, counts, verdicts and the steps to the roots too."""
    stored = spreadsheets.cells_of(office.paper.content)
    # What tends to zero is in the end what rounding left of it, and so is the end of the bracket that its
    # sign moves; no program rounds as another does.
    rests = {
        (block.place.worksheet, block.place.cell(row, block.place.worksheet).replace("$", ""))
        for block in office.paper.grid.blocks
        if block.kind == "step"
        and (block.title in ("f", "step") or (block.step > 1 and block.title in ("left", "right")))
        for row in range(block.place.rows)
    }
    # At the least of a sum of squares its derivatives are what rounding left of terms that cancel: they are
    # compared as all else is, but with y/x, the size that a derivative dy/dx has by itself.
    found, left = office.paper.values({}).value, dict[tuple[str, str], float]()
    for block in office.paper.grid.blocks:
        ways = r"d (?:step of )?(\w+) / d (?:step of )?(\w+?)(?:_sum_\d+)?(?: again| along \w+)*"
        named = re.fullmatch(ways, block.name) if block.kind == "slope" else None
        if named and {*named.groups()} <= found.keys():
            share = abs(found[named[1]]).max() / abs(found[named[2]]).max()
            for row in range(block.place.rows):
                place = block.place.cell(row, block.place.worksheet).replace("$", "")
                left[block.place.worksheet, place] = max(1e-12, 1e-9 * share)
        elif block.kind == "slope" and re.fullmatch(r"\w+_sum_\d+", block.name):
            # A sum that a fit makes zero, of terms up to 1e4.
            left[block.place.worksheet, block.place.cell(0, block.place.worksheet).replace("$", "")] = 1e-8
    assert left
    compared = 0
    for worksheet, cells in stored.items():
        for address, value in cells.items():
            again = office.read["as issued"][worksheet].get(address, "")
            if isinstance(value, int | float) and isinstance(again, int | float):
                near = pytest.approx(value, rel=1e-9, abs=left.get((worksheet, address), 1e-12))
                assert (worksheet, address) in rests or again == near, (worksheet, address)
            else:
                assert again == value, (worksheet, address)
            compared += 1
    assert compared > 5000


def test_one_changed_character_is_noticed(office: Office) -> None:
    found = spreadsheets.compare(office.paper, office.paper.values({}), office.read["one character"])
    assert found.wrong


def test_a_root_far_from_its_guess_is_reached(office: Office) -> None:
    delivered, read = office.delivered["steps"], office.read["steps"]["pairs"]
    values = delivered.values(ROOTS)
    assert values.status["alpha"][0] == Status.OK, "NumPy goes on until it has the root"
    for name in ("alpha", "x_m1"):
        place = delivered.grid[name].place
        for row in range(place.rows):
            if values.status[name][row] != Status.OK:
                continue
            found = read[place.cell(row, "pairs").replace("$", "")]
            assert found * float(place.scale) == pytest.approx(values.value[name][row], rel=1e-12)


def test_rows_left_out_are_counted(office: Office) -> None:
    row = office.paper.grid["alpha_mean"].place.row + 1
    assert office.read["as issued"]["report"][f"H{row}"] == "10 of 10 pairs"
    assert office.read["an empty input"]["report"][f"H{row}"] == "6 of 10 pairs"
    assert office.read["nothing measured"]["report"][f"H{row}"] == "0 of 10 pairs"


def test_published_values_are_compared_again(office: Office) -> None:
    cells: dict[str, dict[str, Any]] = office.read
    assert cells["as issued"]["published"]["I6"] == "differs"
    assert cells["as issued"]["published"]["K6"] == 1.258
    assert cells["as issued"]["published"]["L6"] == "yes"
    assert cells["x_p of test 2"]["published"]["I6"] == "differs"
    assert cells["x_p of test 2"]["published"]["L6"] == "no"  # otherwise than is known
    assert cells["an empty input"]["published"]["F6"] == "#INPUT!"
    assert cells["an empty input"]["published"]["I6"] == "not-checkable"
    assert cells["an empty input"]["published"]["L6"] == "no"


def test_text_stays_text(office: Office) -> None:
    assert office.read["twelve tests"]["report"]["A1"] == HOSTILE


def test_is_printed(require: Callable[..., str], tmp_path: Path) -> None:
    """The first page, the figures and the tables fit on pages; nothing is too narrow for its number."""
    soffice, pdftotext = require("soffice", "libreoffice"), require("pdftotext")
    (tmp_path / "report.xlsx").write_bytes(spreadsheets.paper().content)
    profile = f"-env:UserInstallation=file://{tmp_path / 'profile'}"
    command = [soffice, profile, "--headless", "--convert-to", "pdf", "--outdir", str(tmp_path)]
    subprocess.run([*command, str(tmp_path / "report.xlsx")], check=True, capture_output=True, timeout=300)
    pages = subprocess.run(
        [pdftotext, "-layout", str(tmp_path / "report.pdf"), "-"], check=True, capture_output=True, text=True
    ).stdout
    assert "Soft steel, ball drop" in pages
    assert "###" not in pages
    assert "Err:" not in pages


SURE = {
    "l_S": "50.000623 mm, exact",
    "dalpha": "0 K^-1, exact",
    "alpha_S": "11.5e-6 K^-1, exact",
    "theta": "-0.1 K, exact",
    "cycle": "0 K, exact",
    "dtheta": "0 K, exact",
}
BUDGETS: dict[str, dict[str, str]] = {
    "limits": {"l_S": "50.000623 mm, +-0.1 um rect"},
    "limits and little": {"l_S": "50.000623 mm, +-0.1 um arcsine", "dtheta": "0 K, u = 0.001"},
    "a triangle": {"l_S": "50.000623 mm, +-0.1 um tri"},
    "limits that are not certain": {"l_S": "50.000623 mm, +-0.1 um rect, dof = 2"},
    "no one dominates": {"l_S": "50.000623 mm, +-0.1 um rect", "dtheta": "0 K, +-0.2 rect"},
    "few readings": {"l_S": "50.000623 mm, s = 0.1 um, n = 5", "dtheta": "0 K, u = 0.02"},
    "cut off": {"l_S": "50.000623 mm, u = 0.1 um, min = 50.00055 mm"},
    "an estimate alone": {"dtheta": "0.2 K, exponential"},
    "an estimate alone, to the other side": {"dalpha": "1e-8 K^-1, exponential", "theta": "-9 K, exact"},
    "draws": {"l_S": "50.000623 mm, samples = draws.csv"},
    "correlated": {"l_S": "50.000623 mm, u = 0.1 um", "dtheta": "0 K, u = 0.1"},
    "second order alone": {"dalpha": "0 K^-1, +-1e-6 rect", "cycle": "0 K, u = 0.2", "theta": "0 K, exact"},
    "second order beside": {
        "l_S": "50.000623 mm, +-0.05 um rect", "dalpha": "0 K^-1, u = 1e-6", "cycle": "0 K, u = 1",
    },
}  # fmt: skip


LIMITS = (
    '"l[1]" = "50.0007 .. 50.0009 mm"\n[limits.rule]\nguard = "0.5 U"\nlevel = "99 %"\n',
    '"l[1]" = "<= 50.0007 mm"\n',
    '"l[1]" = ">= 50.00075 mm"\n[limits.rule]\nguard = "0.2 um"\n',
)
"""Of which one accepts, one rejects, and one leaves it open, or nearly."""


def test_a_budget_is_recalculated_to_the_same(recalculate: spreadsheets.Recalculate, tmp_path: Path) -> None:
    """Degrees of freedom, coverage factor, expanded uncertainty: by the formulas as by the program."""
    books = {}
    for n, (name, stated) in enumerate(BUDGETS.items()):
        folder = tmp_path / str(n)
        folder.mkdir()
        given = "".join(f'{key} = "{said}"\n' for key, said in (SURE | stated).items())
        more = '[uncertainty.correlation]\n"l_S, dtheta" = "0.5"\n' if name == "correlated" else ""
        toml = f'workbook = "workbook.py"\n[parameters]\n{given}[measurements]\nfile = "d.csv"\n'
        rule = LIMITS[n % len(LIMITS)]
        end_gauge(folder, report=f'{toml}[uncertainty]\nd = "exact"\n{more}[limits]\n{rule}')
        drawn = "".join(f"{50.0005 + 0.0002 * (k / 400) ** 2:.9f}\n" for k in range(401))
        (folder / "draws.csv").write_text(f"l_S [mm]\n{drawn}", encoding="utf-8")
        books[name] = spreadsheets.deliver(folder).content
    shipped = [PAPER.parent / name for name in ("gum_h1", "gum_h2", "gum_h3")]
    books |= {folder.name: spreadsheets.deliver(folder).content for folder in shipped}
    read = recalculate(books)
    decided: set[str] = set()
    for name, book in books.items():
        stored = spreadsheets.cells_of(book)["uncertainty"]
        again = read[name]["uncertainty"]
        numbers = {at: value for at, value in stored.items() if isinstance(value, int | float)}
        of_limits = {
            at
            for at in numbers
            if re.search("over u|probability that|conformance|risk", str(stored.get(f"A{at[1:]}")))
        }
        sizes = {str(stored[at]): numbers[f"B{at[1:]}"] for at in stored if f"B{at[1:]}" in numbers}
        # A spreadsheet keeps 15 to 17 digits: what is left of them in the distance from a limit.
        lost = 4 * 2.0**-52 * sizes["value"] / sizes["standard uncertainty u"]
        for some, least in ((of_limits, lost), (numbers.keys() - of_limits, 1e-24)):
            expected = pytest.approx({at: numbers[at] for at in some}, rel=1e-9, abs=least)
            assert {at: again[at] for at in some} == expected, name
        told = {at: value for at, value in stored.items() if value and isinstance(value, str)}
        assert {at: again[at] for at in told} == told
        decided |= {value for value in told.values() if value in set(Decision)}
    assert decided == set(Decision)


READINGS = """from loopsheet import Method, given, let, mean, measured


class Readings(Method):
    V = measured("V", "a voltage")
    W = measured("V", "another, read at the same time")
    S = given("V", "what a shunt adds")
    D = let(mean(V) - 2 * mean(W) + S, "what is sought")
"""


def test_uncertainties_of_an_edited_workbook_follow_its_readings(
    recalculate: spreadsheets.Recalculate, tmp_path: Path
) -> None:
    """How readings scatter, how they correlate, and what is a share of a number, as a rebuild has them."""
    voltages = [(5.007, 9.663), (4.994, 9.639), (5.005, 9.640), (4.990, 9.685), (4.999, 9.678)]

    def delivered(name: str, first: float, shunt: float) -> spreadsheets.Delivered:
        rows = "".join(
            f"{n},{v},{w}\n" for n, (v, w) in enumerate([(first, voltages[0][1]), *voltages[1:]], 1)
        )
        more = f'[parameters]\nS = "{shunt} V, u = 0.05 % of reading + 1 mV"\n'
        more += '[uncertainty]\npaired = ["V", "W"]\n'
        rows = f"test,V [V],W [V]\n{rows}"
        return spreadsheets.deliver(method_folder(tmp_path / name, READINGS, rows, more))

    before, after = delivered("before", 5.007, 4.0), delivered("after", 5.057, 9.0)
    edited = before.edited({("V", 0): 5.057, ("S", 0): 9.0})
    read = recalculate({"edited": edited})["edited"]["uncertainty"]
    expected = spreadsheets.cells_of(after.content)["uncertainty"]
    stale = spreadsheets.cells_of(before.content)["uncertainty"]
    sizes = {
        str(said): (read[cell], number, stale[cell])
        for at, said in expected.items()
        if at.startswith("A") and isinstance(number := expected.get(cell := f"B{at[1:]}"), float | int)
    }
    for name in ("value", "standard uncertainty u", "coverage factor k", "expanded uncertainty U"):
        again, now, then = sizes[name]
        assert again == pytest.approx(now, rel=1e-9)
        assert now != pytest.approx(then, rel=1e-6) or name == "coverage factor k"


UNKNOWN = """from loopsheet import Method, given, let, mean, measured


class Unknown(Method, headline="D square"):
    V = measured("V", "a voltage")
    S = given("V", "another")
    D = let(mean(V) + S, "what is sought")
    square = let((mean(V) - S) ** 2, "how far both are apart", "V^2")
"""


def test_what_a_workbook_cannot_know_after_an_edit_is_not_told(
    recalculate: spreadsheets.Recalculate, tmp_path: Path
) -> None:
    """Readings made equal, slopes that came to 0, uncertainties that are none, limits in the wrong order."""
    more = '[parameters]\nS = "6.00 V, u = 0.02 V"\n'
    more += '[uncertainty]\nV = "scatter"\n[limits]\nD = "10 .. 12 V, guard = U"\n'
    rows = "test,V [V]\n1,5.01\n2,4.99\n3,5.03\n"
    made = spreadsheets.deliver(method_folder(tmp_path, UNKNOWN, rows, more))
    cells = spreadsheets.cells_of(made.content)["uncertainty"]
    at = {str(said): f"B{cell[1:]}" for cell, said in reversed(cells.items()) if cell.startswith("A")}
    source = next(cell[1:] for cell, said in cells.items() if cell[0] == "A" and said == "S")
    edits = {
        "equal": {("V", 0): 5.0, ("V", 1): 5.0, ("V", 2): 5.0},
        "flat": {("V", 0): 5.0, ("V", 1): 6.0, ("V", 2): 7.0},
    }
    books = {name: made.edited(own) for name, own in edits.items()}
    for name, typed in {"emptied": {f"D{source}": None}, "negative": {f"D{source}": -0.5}}.items():
        books[name] = spreadsheets.typed(made.content, {"uncertainty": typed})
    books["crossed"] = spreadsheets.typed(made.content, {"uncertainty": {at["lower tolerance limit"]: 13.0}})
    read = recalculate(books)
    u = at["standard uncertainty u"]
    assert cells[u] == pytest.approx(0.0231, rel=1e-2)
    for name in ("equal", "emptied", "negative"):
        assert read[name]["uncertainty"][u] == "#N/A", name
    rows = [
        int(cell[1:]) for cell, said in cells.items() if (cell[0], said) == ("A", "standard uncertainty u")
    ]
    assert read["flat"]["uncertainty"][f"B{max(rows)}"] == "#N/A"
    for line in ("conformance probability", "decision"):
        assert read["crossed"]["uncertainty"][at[line]] == "#N/A", line
