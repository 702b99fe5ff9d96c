"""A measured column of one report in another: row by row, in value and in uncertainty as if both were one."""

from __future__ import annotations

import json
import math
import random
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest
from helpers import method_folder
from two_reports import CAMPAIGN, COLUMN, GIVEN, MASS, OWN, READ, build, folder, forged, lab

from loopsheet.report.cli import main
from loopsheet.report.inputs.inputs import load
from loopsheet.report.inputs.planned import planned
from loopsheet.report.messages.errors import InputError, render
from loopsheet.report.study import Study
from loopsheet.report.uncertainty import propagation
from loopsheet.report.uncertainty.monte_carlo import draw
from loopsheet.report.uncertainty.propagation import Spread
from loopsheet.report.views.budget import FORMATS
from loopsheet.report.which_workbook import find_workbook

LAST = """
x, total = measured("x", "m"), given("total", "m")
computed("nothing", "m", Sum(x[k], (k, 1, n)) - total)
HEADLINE = ["nothing"]
"""


def campaign(at: Path, tests: str = "1\n2\n3\n", more: str = "", column: dict[str, str] = COLUMN) -> Path:
    """A campaign that takes its depths, and a mass, from the laboratory."""
    return folder(at, CAMPAIGN, MASS, f"test\n{tests}", column, more)


def spread(at: Path) -> Spread:
    report = Study(at).computed
    return Spread(report.inputs, report.values)


@pytest.fixture
def both(tmp_path: Path) -> Path:
    at = campaign(tmp_path / "campaign")
    lab(at)
    return at


# --- what is shared counts once ----------------------------------------------------------------------------


def test_a_shared_gauge_counts_as_by_hand(both: Path) -> None:
    found = spread(both)
    g, z, w, r = 1.003, 0.2e-6, 8.366e-3, [23.7e-6, 29.9e-6, 41.8e-6]
    u_g, u_z, u_w, u_r = 0.004, 0.1e-6, 0.01e-3, 0.2e-6
    assert found.values.value["x"].tolist() == pytest.approx([g * each - z for each in r], rel=1e-15)
    total = [sum(r) * u_g, -3 * u_z, g * math.sqrt(3) * u_r]
    assert found.budget("total", 0).u == pytest.approx(math.hypot(*total), rel=1e-12)
    # the mass was weighed with the same gain, which falls out of sum(r) / w but for the datum
    q = (g * sum(r) - 3 * z) / (g * w)
    q_by = [3 * z / (g**2 * w) * u_g, -3 / (g * w) * u_z, math.sqrt(3) / w * u_r, q / w * u_w]
    assert found.budget("q", 0).u == pytest.approx(math.hypot(*q_by), rel=1e-12)
    assert [source.name for source in found.sources if len(source.moves) > 1] == [
        "g (lab/out/values.json)",
        "z (lab/out/values.json)",
    ]


def test_rows_are_matched_by_their_label(tmp_path: Path) -> None:
    """Whatever the order of the rows in either file, and whatever other rows there are."""
    chance = random.Random(7)
    for n in range(3):
        labels = chance.sample(range(1, 100), 8)
        read = {label: f"{chance.uniform(10, 90):.2f}" for label in labels}
        wanted = chance.sample(labels, 4)
        at = campaign(tmp_path / str(n), "".join(f"{label}\n" for label in wanted))
        lab(at, read)
        found = spread(at)
        taken = dict(zip(wanted, found.values.value["x"].tolist(), strict=True))
        assert taken == {label: pytest.approx(1.003e-6 * float(read[label]) - 0.2e-6) for label in wanted}
        moved = {source.name: source.moves for source in found.sources}
        for row, label in enumerate(wanted):
            ((name, at_row, u),) = moved[f"r[{label}] (lab/out/values.json)"]
            assert (name, at_row, u) == ("x", row, pytest.approx(1.003 * 0.2e-6, rel=1e-12))


def test_the_same_errors_stated_in_one_folder_give_the_same_uncertainties(tmp_path: Path) -> None:
    """The paper's method with depths from a laboratory, and typed with [uncertainty.shared]."""
    rows = {1: ("2.334", "0.530"), 2: ("2.940", "0.512"), 3: ("4.089", "0.479"), 5: ("5.890", "0.449")}
    ball = {"ball_mass": "8.366 g"}
    table = "".join(f"{label},{v},{e}\n" for label, (v, e) in rows.items())
    column = {"x_p": COLUMN["x"]}
    apart = folder(tmp_path / "apart", "soft_impact", ball, f"test,v [m/s],e [1]\n{table}", column)
    shared = '[uncertainty.shared."certificate"]\nof = "r"\nstated = "u = 0.2 %"\ngroups = [[1, 2], [3, 5]]\n'
    lab(apart, READ, GIVEN | {"g": "1, u = 0.004", "z": "0 um, u = 0.1"}, OWN + shared)
    report = Study(apart).computed
    depths = [repr(float(each.value * 10**6)) for each in report.inputs.measured["x_p"]]
    typed = "".join(f"{line},{x}\n" for line, x in zip(table.splitlines(), depths, strict=True))
    more = '[uncertainty]\nx_p = "u = 0.2 um"\n'
    more += '[uncertainty.shared."gain"]\nof = "x_p"\nstated = "u = 0.4 %"\n'
    more += '[uncertainty.shared."datum"]\nof = "x_p"\nstated = "u = 0.1 um"\n'
    more += shared.replace('"r"', '"x_p"')
    whole = folder(tmp_path / "whole", "soft_impact", ball, f"test,v [m/s],e [1],x_p [um]\n{typed}", {}, more)
    one, two = spread(whole), spread(apart)
    cells = [(name, 0) for name in ("alpha_mean", "alpha_eiv", "alpha_lin", "C_log", "chi2_eiv")]
    cells += [("alpha", row) for row in range(6)]
    ours, theirs = one.covariance(cells), two.covariance(cells)
    u, own = np.sqrt(np.diag(ours)), np.sqrt(np.diag(theirs))
    assert own == pytest.approx(u, rel=1e-12)
    # a correlation is a small sum of large parts
    assert theirs / np.outer(own, own) == pytest.approx(ours / np.outer(u, u), abs=1e-12)
    assert two.budget("alpha_mean", 0).u == pytest.approx(one.budget("alpha_mean", 0).u, rel=1e-12)


def test_what_a_third_report_took_before_is_still_one(both: Path, tmp_path: Path) -> None:
    """Of a sum, and of the column that it is of: nothing is left, and none of its uncertainty."""
    build(both)
    total = {"total": '{ from = "campaign/out/values.json", cell = "total" }'}
    column = {"x": COLUMN["x"].replace("lab/", "campaign/lab/")}
    found = spread(folder(tmp_path, LAST, total, "test\n1\n2\n3\n", column))
    assert found.budget("total", 0).u > 1e-7
    assert found.budget("nothing", 0).u < 1e-20
    assert len(found.sources) == 2 + 3  # gain and datum, and a reading each


def test_draws_have_what_is_shared_once(both: Path) -> None:
    report = Study(both).computed
    own = Spread(report.inputs, report.values).budget("total", 0)
    found = draw(report.inputs, report.values, own, 100_000, tolerance=0.0)
    assert found.symmetric[1] - found.symmetric[0] == pytest.approx(2 * own.expanded, rel=0.03)


def test_terms_of_second_order_come_along(tmp_path: Path) -> None:
    column = {"x": '{ from = "lab/out/values.json", cell = "area" }'}
    workbook = (
        'x = measured("x", "m^2")\ncomputed("total", "m^2", Sum(x[k], (k, 1, n)))\nHEADLINE = ["total"]\n'
    )
    at = folder(tmp_path, workbook, {}, "test\n1\n2\n", column)
    lab(at, {1: "0.3", 2: "60"})
    second = told(at)["second"]
    assert second == {"area[1]": pytest.approx(math.sqrt(2) * 0.2e-6**2)}  # of a square of a normal quantity
    found = spread(at)
    (taken,) = (source for source in found.sources if source.name.startswith("second order"))
    assert taken.moves == (("x", 0, second["area[1]"]),)
    first = 2 * 0.2e-6 * math.hypot(0.3e-6, 60e-6)
    assert found.budget("total", 0).u == pytest.approx(math.hypot(first, second["area[1]"]), rel=1e-9)


# --- what a file tells -------------------------------------------------------------------------------------


def told(at: Path) -> Any:
    return json.loads((at / "lab/out/values.json").read_text(encoding="utf-8"))["influences"]


def test_a_file_tells_of_rows_by_the_sources_that_move_them(both: Path) -> None:
    rows = told(both)["rows"]
    assert list(rows) == [f"{name}[{label}]" for name in ("r", "depth", "area") for label in READ]
    names = [source["name"] for source in told(both)["sources"]]
    assert [names[n] for n, _ in rows["depth[3]"]] == ["r[3]", "g", "z"]
    assert dict(rows["depth[3]"])[names.index("g")] == pytest.approx(41.8e-6 * 0.004)
    assert not any("[" in cell for cell in told(both)["cells"])


def test_a_shipped_workbook_passes_on_its_scalars_alone(both: Path, issued: Path) -> None:
    file = (issued / "out/values.json").read_bytes()
    assert "rows" not in json.loads(file)["influences"]
    forged(both / "lab/out/values.json", json.loads(file))
    assert refused(folder(both, CAMPAIGN, {"m": "8 g"}, "test\n1\n2\n", x("x_p"))) == "LS437"


def test_a_column_of_too_many_influences_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(propagation, "MOST_PASSED", 5 * 2 + 5 * 4)  # of the readings and of the depths
    lab(tmp_path)
    assert {cell.partition("[")[0] for cell in told(tmp_path)["rows"]} == {"r", "depth"}
    monkeypatch.setattr(propagation, "MOST_PASSED", 5 * 2 + 5 * 4 - 1)
    lab(tmp_path)
    assert {cell.partition("[")[0] for cell in told(tmp_path)["rows"]} == {"r", "area"}


# --- what is refused ---------------------------------------------------------------------------------------


def x(cell: str, more: str = "") -> dict[str, str]:
    return {"x": f'{{ from = "lab/out/values.json", cell = "{cell}"{more} }}'}


def finding(at: Path, path: str = "report.toml") -> tuple[str, str]:
    """The code of the one finding, and how it reads."""
    with pytest.raises(InputError) as caught:
        load(at, find_workbook)
    (found,) = caught.value.diagnostics
    assert found.at.path.endswith(path)
    assert found.at.line
    return found.code, render(found)


def refused(at: Path) -> str:
    return finding(at)[0]


@pytest.mark.parametrize(
    ("column", "code"),
    [
        ({"x": "{ }"}, "LS204"),
        ({"x": '{ from = "lab/out/values.json" }'}, "LS204"),
        ({"x": "lab/out/values.json"}, "LS205"),
        (x("depth", ", units = 'um'"), "LS203"),
        (x("depth", ", unit = 3"), "LS205"),
        (x("depth", ", unit = 'kg'"), "LS422"),
        (x("depth", ", unit = 'Um'"), "LS421"),
        ({"y": COLUMN["x"], **COLUMN}, "LS203"),
        (x("deep"), "LS505"),
        (x("depth[1]"), "LS505"),
        (x("m"), "LS505"),
        (x("area"), "LS422"),
        ({"x": '{ from = "lab/values.json", cell = "depth" }'}, "LS104"),
    ],
)
def test_what_cannot_be_taken_is_told_where_it_stands(both: Path, column: dict[str, str], code: str) -> None:
    assert refused(campaign(both, column=column)) == code


def test_a_row_that_there_is_not_is_told_with_those_that_there_are(both: Path) -> None:
    code, text = finding(campaign(both, "1\n7\n2\n8\n"))
    assert code == "LS437"
    assert "has no depth[7] or depth[8]" in text
    assert "the rows 5, 3, 1, 2 or 4" in text


def test_a_row_without_a_value_is_told(both: Path) -> None:
    file = both / "lab/out/values.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    column = content["cells"]["depth"]
    place = column["index"].index(2)
    column["value"][place], column["status"][place] = None, "#DOMAIN!"
    forged(file, content)
    code, text = finding(both)
    assert code == "LS437"
    assert "has no value of depth[2]: #DOMAIN!" in text
    assert "the rows 5, 3, 1 or 4" in text
    load(campaign(both, "1\n3\n"), find_workbook)  # a row that nobody asks for may have none


@pytest.mark.parametrize(
    ("change", "code", "word"),
    [
        (lambda c: c["cells"]["depth"].update(unit="mm"), "LS422", "'mm'"),
        (lambda c: c["cells"]["depth"]["value"].__setitem__(2, -1e-6), "LS406", "x[1] is out of range"),
        (lambda c: c["influences"]["rows"].pop("depth[2]"), "LS437", "uncertainty of depth[2] comes"),
        (lambda c: c["influences"].pop("rows"), "LS437", "uncertainty of depth comes"),
        (lambda c: c.pop("influences"), "LS437", "a file that tells"),
        (lambda c: c["influences"]["rows"]["depth[2]"].append([99, 1.0]), "LS437", "do not fit together"),
    ],
)
def test_a_file_that_has_changed_is_told(both: Path, change: Any, code: str, word: str) -> None:
    file = both / "lab/out/values.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    change(content)
    forged(file, content)
    folder(both, CAMPAIGN, {"m": "8 g"}, "test\n1\n2\n3\n", COLUMN)
    found, text = finding(both)
    assert (found, word in text) == (code, True)


@pytest.mark.parametrize(
    ("head", "row", "code"),
    [("x [um]", "23", "LS317"), ("u(x) [um]", "0.1", "LS433"), ("x", "23", "LS317")],
)
def test_a_column_is_given_or_taken(both: Path, head: str, row: str, code: str) -> None:
    (both / "measurements.csv").write_text(f"test,{head}\n1,{row}\n2,{row}\n", encoding="utf-8")
    assert finding(both, "measurements.csv")[0] == code


@pytest.mark.parametrize(
    ("more", "code"),
    [
        ('[uncertainty]\nx = "u = 1 um"\n', "LS433"),
        ('[uncertainty.correlation]\n"x, m" = "0.5"\n', "LS434"),
        ('[measurements.printed]\nx = "truncated"\n', "LS203"),
    ],
)
def test_what_is_taken_says_its_uncertainty_itself(both: Path, more: str, code: str) -> None:
    assert refused(campaign(both, more=more)) == code


# --- everywhere that numbers go ----------------------------------------------------------------------------


def test_a_budget_says_of_which_row_it_tells(both: Path) -> None:
    report = Study(both).computed
    rows = FORMATS["text"](report, Spread(report.inputs, report.values).budget("total", 0)).splitlines()
    (row,) = (row for row in rows if row.startswith("r[3] (lab/out/values.json)"))
    assert "x[3] = 41.73 um" in row


def test_the_worksheet_of_budgets_has_no_estimate_of_another_report(both: Path) -> None:
    assert main(["build", str(both), "--to", "xlsx"]) == 0
    book = openpyxl.load_workbook(both / "out/report.xlsx")
    lines = [[cell.value for cell in row] for row in book["uncertainty"].iter_rows()]
    there = [line for line in lines if str(line[0]).endswith("(lab/out/values.json)")]
    assert len(there) == 5 + 6  # a line for each reading, for gain and datum; the mass has a weight, too
    assert {line[1] for line in there} == {None}
    notes = [cell.comment.text for sheet in book for row in sheet.iter_rows() for cell in row if cell.comment]
    assert any("Taken from lab/out/values.json, depth[3]." in note for note in notes)


def test_show_has_the_digits_that_the_uncertainty_tells(
    both: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    capsys.readouterr()
    assert main(["show", "x", str(both)]) == 0
    assert main(["show", "m", str(both)]) == 0
    told = [line.split() for line in capsys.readouterr().out.splitlines() if " u " in line]
    assert [line[:2] for line in told] == [
        ["x[1]", "23.57"],
        ["x[2]", "29.79"],
        ["x[3]", "41.73"],
        ["m", "0.008391"],
    ]


def test_a_test_that_takes_no_part_has_its_number_all_the_same(both: Path) -> None:
    (both / "measurements.csv").write_text("test,left out\n1,\n2,bounced\n3,\n9,lost\n", encoding="utf-8")
    inputs = load(both, find_workbook)
    assert [float(each.value) for each in inputs.measured["x"]] == pytest.approx([23.5711e-6, 41.7254e-6])
    bounced, lost = inputs.only.left_out
    assert (float(bounced.texts["x"]), lost.texts["x"]) == (pytest.approx(29.7897), "")
    assert main(["build", str(both), "--to", "html,latex,xlsx"]) == 0


def test_another_result_of_the_laboratory_is_told(both: Path, capsys: pytest.CaptureFixture[str]) -> None:
    build(both)
    assert main(["verify", str(both), "--run-workbook"]) == 0
    lab(both, READ | {3: "41.9"})
    capsys.readouterr()
    assert main(["verify", str(both), "--run-workbook"]) == 1
    said = capsys.readouterr().out
    assert "lab/out/values.json" in said
    assert "x[3]" in said


def test_planned_rows_share_what_measured_ones_share(both: Path) -> None:
    """Rows like one measured row have an error of their own each, and one gauge."""
    report = Study(both).computed
    inputs = planned(report.inputs, {"x": [20e-6, 30e-6, 40e-6]}, [0, 0, 2], {})
    taken = inputs.taken["x"]
    moves: dict[tuple[str, str], list[float]] = {}
    for row, errors in enumerate(taken.errors):
        for error in errors:
            moves.setdefault(error.origin, [0.0] * 3)[row] = error.moved
    own = [moved for moved in moves.values() if np.count_nonzero(moved) == 1]
    assert sorted(map(tuple, own)) == sorted([(2.006e-7, 0, 0), (0, 2.006e-7, 0), (0, 0, 2.006e-7)])
    shared = {name: moved for (_, name), moved in moves.items() if np.count_nonzero(moved) > 1}
    assert shared.keys() == {"g", "z"}
    assert shared["g"] == pytest.approx([9.48e-8, 9.48e-8, 1.672e-7])


# --- rows that have words ----------------------------------------------------------------------------------

JAM = """
from loopsheet import Method, groups, let, mean, measured

class Jam(Method, headline="largest w"):
    "Contents."
    y = measured("mg", "reading")
    jar = groups("jar")
    w = let(mean(y, of=jar), "content", "mg")
    largest = let(max(w), "largest", "mg")
"""
RECOVERY = """
from loopsheet import Method, let, measured

class Recovery(Method, headline="gain"):
    "What was added."
    w = measured("mg", "content")
    f = measured("1", "factor")
    gain = let(sum(w * f), "gain", "mg")
"""
READINGS = ("jam A,1.0\n", "jam A,1.2\n", "jam B,3.0\n", "jam B,3.2\n")


def jars(at: Path, table: str, readings: tuple[str, ...] = READINGS) -> Path:
    """A report that takes the content of each jar."""
    content = "jar,y [mg]\n" + "".join(readings)
    build(method_folder(at / "lab", JAM, content, '[uncertainty]\ny = "u = 0.1"\n'))
    taken = '[measurements.taken]\nw = { from = "lab/out/values.json", cell = "w" }\n'
    return method_folder(at, RECOVERY, table, f'{taken}[uncertainty]\nf = "exact"\n')


def told_of_rows(at: Path) -> list[tuple[str, str]]:
    return [(c.note, c.message) for c in Study(at).computed.oddities if c.kind == "words" and c.name == "w"]


@pytest.mark.parametrize("readings", [READINGS, READINGS[::-1]])
def test_rows_with_words_are_matched_by_them(tmp_path: Path, readings: tuple[str, ...]) -> None:
    """Whatever the order in either table, blanks and case as elsewhere; of each with its own errors."""
    at = jars(tmp_path, "jar,f [1]\njam b,1\nJam A,-1\n", readings)
    found = spread(at)
    assert found.values.value["w"].tolist() == pytest.approx([3.1e-6, 1.1e-6])
    assert found.values.value["gain"].tolist() == pytest.approx([2e-6])
    ((note, text),) = told_of_rows(at)
    assert (note, "of its word in" in text) == ("", True)
    assert ("1 is w[2]" in text) == (readings == READINGS)


def test_a_word_that_the_other_report_lacks_is_told_with_those_that_it_has(tmp_path: Path) -> None:
    code, text = finding(jars(tmp_path, "jar,f [1]\njam B,1\njam C,-1\n"))
    assert (code, "no w[jam C]" in text, "the rows jam A or jam B" in text) == ("LS437", True, True)


@pytest.mark.parametrize("table", ["test,f [1]\n1,-1\n2,1\n", "by,f [1]\nAnna,-1\nBo,1\n"])
def test_rows_that_only_one_report_has_words_for_go_by_number_and_this_is_told(
    tmp_path: Path, table: str
) -> None:
    at = jars(tmp_path, table)
    assert spread(at).values.value["gain"].tolist() == pytest.approx([2e-6])
    ((note, text),) = told_of_rows(at)
    assert (note, "jam A or jam B" in text) == ("warning", True)


def test_one_row_is_taken_by_its_word(tmp_path: Path) -> None:
    at = jars(tmp_path, "jar,f [1]\njam B,1\njam A,-1\n")
    method = RECOVERY.replace("let, measured", "given, let, measured")
    method += '    blank = given("mg", "blank")\n    less = let(gain - blank, "less", "mg")\n'
    (at / "workbook.py").write_text(method, encoding="utf-8")
    toml = (at / "report.toml").read_text(encoding="utf-8")
    more = '[parameters]\nblank = { from = "lab/out/values.json", cell = "w[jam B]" }\n'
    (at / "report.toml").write_text(toml.replace("[measurements]", f"{more}[measurements]"), encoding="utf-8")
    found = spread(at)
    assert found.values.value["less"].tolist() == pytest.approx([-1.1e-6])
    assert found.budget("less", 0).u == pytest.approx(0.1e-6 / math.sqrt(2), rel=1e-6)
