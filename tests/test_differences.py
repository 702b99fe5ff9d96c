"""Two results side by side."""

from __future__ import annotations

import json
import math
import shutil
import sys
from pathlib import Path

import pytest
from msgspec.structs import replace

from loopsheet.report.archive.differences import Differences, Move, compare
from loopsheet.report.cli import main
from loopsheet.report.files.form import Index
from loopsheet.report.files.values import Column, Oddity, Published, Result, Unit
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.views.differences import as_markdown, as_text, moved

EPS = sys.float_info.epsilon


def listed(unit: str, axis: str, rule: str, cells: dict[Index, float]) -> Column:
    return Column(
        unit=unit, axis=axis, rule=rule,
        index=list(cells), value=list(cells.values()), status=["ok"] * len(cells),
    )  # fmt: skip


V = listed("m/s", "tests", "given", {(1,): 2.0, (2,): 3.0})
A = listed("1", "pairs", "(11) a = v", {(1, 2): 1.25})
M = Column(unit="1", rule="(12) m = a", value=1.25, status="ok")
PUBLISHED = Published(source="Table 2", cell="a", index=[1, 2], printed="1.2", verdict="same")
RESULT = Result(
    schema=1, title="t", workbook="w",
    cells={"v": V, "a": A, "m": M}, proofs={"(11)": "proved"}, published=[PUBLISHED],
)  # fmt: skip


def with_column(name: str, column: Column) -> Result:
    return replace(RESULT, cells={**RESULT.cells, name: column})


def test_a_result_is_itself() -> None:
    found = compare(RESULT, RESULT)
    assert (found.same, found.noise, found.any) == (4, 0, False)
    assert as_text(found, 20) == ("numbers    4 in both: 4 the same, 0 within rounding, 0 moved\nthe same\n")


@pytest.mark.parametrize(
    ("after", "is_noise"),
    [
        (1.25 + 8 * 1.25 * EPS, True),
        (1.25 + 9.6 * 1.25 * EPS, False),
        (1.26, False),
        (-1.25, False),
        (0.0, False),
    ],
)
def test_rounding_is_eight_eps_of_the_larger(after: float, is_noise: bool) -> None:
    found = compare(RESULT, with_column("m", replace(M, value=after)))
    assert (found.noise, len(found.moved)) == ((1, 0) if is_noise else (0, 1))
    assert found.any is not is_noise


def test_what_a_condition_allows_is_rounding_too() -> None:
    after = with_column("m", replace(M, value=1.25 + 1e-13))
    assert compare(RESULT, after).any
    assert not compare(RESULT, after, {"m": {(): 2e-13}}).any
    assert compare(RESULT, after, {"m": {(): 5e-14}}).any


def test_a_number_that_vanishes_has_moved() -> None:
    (move,) = compare(RESULT, with_column("m", replace(M, value=None, status="#NOROOT!"))).moved
    assert (move.before, move.after, move.status, move.relative) == (1.25, None, ("ok", "#NOROOT!"), None)
    assert moved(move) == ("1.25", "#NOROOT!", "")


def test_another_status_without_a_number_has_moved() -> None:
    none = with_column("m", replace(M, value=None, status="#NOROOT!"))
    other = with_column("m", replace(M, value=None, status="#DOMAIN!"))
    assert compare(none, none).same == 4
    assert len(compare(none, other).moved) == 1


def test_another_uncertainty_is_told_also_where_the_number_moved() -> None:
    """Behind what the user gives and behind results; of all else last."""
    sure = replace(V, u=[0.1, 0.2])
    before = with_column("v", sure)
    found = compare(before, with_column("v", replace(sure, u=[0.1, 0.2 * (1 + 1e-7)])))
    assert (found.same, found.any) == (6, False)
    surer = replace(
        before,
        cells={
            **before.cells,
            "v": replace(sure, value=[2.0, 3.5], u=[0.1, 0.3]),
            "m": replace(M, value=2.0, u=0.4),
        },
    )
    certain = replace(before, cells={**before.cells, "m": replace(M, u=0.2)})
    found = compare(certain, surer)
    assert [(move.address, move.before, move.after) for move in found.moved] == [
        ("v[2]", 3.0, 3.5),
        ("u(v[2])", 0.2, 0.3),
        ("m", 1.25, 2.0),
        ("u(m)", 0.2, 0.4),
    ]
    unknown = compare(before, with_column("v", replace(sure, u=[None, 0.2])))
    assert [(move.address, moved(move)) for move in unknown.moved] == [("u(v[1])", ("0.1", "not known", ""))]
    assert compare(before, RESULT).same == 4  # a file of before does not tell them


def test_what_the_user_gave_comes_first_then_scalars() -> None:
    after = replace(
        RESULT,
        cells={
            "a": replace(A, value=[1.3]),
            "v": replace(V, value=[2.0, 3.5]),
            "m": replace(M, value=1.3),
        },
    )
    found = compare(RESULT, after)
    assert [move.address for move in found.moved] == ["v[2]", "m", "a[1-2]"]
    assert [move.kind for move in found.moved] == ["input", "moved", "moved"]
    text = as_text(found, 2)
    assert "  input    v[2]             3 -> 3.5 m/s   +16.7 %\n" in text
    assert "  moved    m                1.25 -> 1.3   +4 %\n" in text
    assert "and 1 more: a (1)" in text
    assert text.endswith("different\n")


def test_the_headline_comes_before_what_leads_there() -> None:
    numbers = {name: Column(unit="1", rule="(1) x = 1", value=1.0, status="ok", u=0.1) for name in "abcd"}
    before = replace(RESULT, headline=["d", "b"], aside=["a"], cells={**numbers, "v": V})
    two = {name: replace(column, value=2.0) for name, column in numbers.items()}
    found = compare(
        before, replace(before, cells={**two, "v": replace(V, rule="(2) v = 1", value=[1.0, 3.0])})
    )
    assert [(move.address, move.kind) for move in found.moved] == [
        ("d", "result"), ("b", "result"), ("c", "moved"), ("v[1]", "moved"), ("a", "moved"),
    ]  # fmt: skip
    assert "  result   d                1 -> 2" in as_text(found, 20)
    assert "| `d` | result |" in as_markdown(found, 20)
    surer = {name: replace(column, u=0.2) for name, column in numbers.items()}
    found = compare(before, replace(before, cells={**surer, "v": V}))
    assert [move.address for move in found.moved] == ["u(d)", "u(b)", "u(c)", "u(a)"]


def test_numbers_are_told_in_the_unit_that_they_are_shown_in() -> None:
    cells = {
        "t": Column(
            unit="K", rule="(1) t = 1", value=293.15, status="ok", u=0.01,
            shown=Unit(text="degC", scale=1.0, zero=273.15),
        ),
        "R": Column(
            unit="ohm", rule="given", value=10470.0, status="ok", u=5.0, shown=Unit(text="kohm", scale=1000.0)
        ),
    }  # fmt: skip
    before = replace(RESULT, cells=cells)

    def told(after: dict[str, Column]) -> list[tuple[str, ...]]:
        found = compare(before, replace(before, cells=after))
        return [(move.address, *moved(move), move.unit) for move in found.moved]

    other = {"t": replace(cells["t"], value=293.4), "R": replace(cells["R"], value=10480.0)}
    assert told(other) == [
        ("R", "10.47", "10.48", "+0.0955 %", "kohm"),
        ("t", "20", "20.25", "+0.25 K", "degC"),
    ]
    none = {**other, "t": replace(cells["t"], value=None, status="#DOMAIN!")}
    assert told(none)[1] == ("t", "20", "#DOMAIN!", "", "degC")
    surer = {"t": replace(cells["t"], u=0.02), "R": replace(cells["R"], u=6.0)}
    assert told(surer) == [
        ("u(R)", "0.005", "0.006", "+20 %", "kohm"),
        ("u(t)", "0.01", "0.02", "+100 %", "K"),
    ]


@pytest.mark.parametrize(
    ("column", "said"),
    [
        (replace(M, rule="(13) m = 2*a"), "(13) m = 2*a [1]"),
        (replace(M, unit="m"), "(12) m = a [m]"),
        (replace(M, rule="given"), "given [1]"),
    ],
)
def test_another_equation_or_unit_is_another_method(column: Column, said: str) -> None:
    (change,) = compare(RESULT, with_column("m", column)).method
    assert (change.name, change.before, change.after) == ("m", "(12) m = a [1]", said)


def test_another_proof_verdict_or_workbook_is_told() -> None:
    text = replace(PUBLISHED, source="text", cell="m", index=[], printed="1")
    after = replace(RESULT, workbook="x", proofs={"(11)": "refuted", "(12)": "proved"}, published=[text])
    found = compare(RESULT, after)
    assert [(c.name, c.before, c.after) for c in found.method] == [
        ("workbook", "w", "x"),
        ("(11)", "proved", "refuted"),
        ("(12)", "", "proved"),
    ]
    assert [c.name for c in found.published] == ["Table 2 a[1-2]", "text m"]
    assert "(12): (none)" in as_text(found, 20)


def test_rows_and_columns_come_and_go() -> None:
    after = replace(
        RESULT,
        cells={"v": replace(V, index=[1, 3], value=[2.0, 1.0]), "a": A, "new": M},
    )
    found = compare(RESULT, after)
    assert (found.added, found.removed) == (("v[3]", "new"), ("v[2]", "m"))
    assert found.any
    assert "added      v[3], new" in as_text(found, 20)


def test_a_row_that_is_called_otherwise_is_a_difference() -> None:
    first, second = (replace(RESULT, words={"tests": {1: "oil A", 2: word}}) for word in ("oil B", "oil C"))
    assert not compare(first, first).any
    found = compare(first, second)
    assert found.any
    assert [(c.name, c.before, c.after) for c in found.rows] == [("tests 2", "oil B", "oil C")]
    assert "row        tests 2: oil B\n                    -> oil C\n" in as_text(found, 20)
    assert "tests 2" in as_markdown(found, 20)


def test_a_number_that_moved_is_told_with_the_word_of_its_row() -> None:
    before = replace(RESULT, words={"tests": {1: "oil A", 2: "oil B"}})
    after = replace(before, cells={**before.cells, "v": replace(V, value=[2.5, 3.5])})
    lines = as_text(compare(before, after), 20).splitlines()[1:3]
    assert [line.split() for line in lines] == [
        ["input", "v[1]", "(oil", "A)", "2", "->", "2.5", "m/s", "+25", "%"],
        ["input", "v[2]", "(oil", "B)", "3", "->", "3.5", "m/s", "+16.7", "%"],
    ]
    assert "v[1] (oil A)" in as_markdown(compare(before, after), 20)
    # A row that is called otherwise since has no word that is true of both numbers.
    other = replace(after, words={"tests": {1: "oil C", 2: "oil B"}})
    assert "v[1] " in (told := as_text(compare(before, other), 20))
    assert "v[1] (" not in told


def test_another_warning_about_the_same_numbers_is_a_difference() -> None:
    warned = replace(RESULT, oddities=[Oddity(kind="limit", name="m", word="warning", sentence="too large")])
    assert not compare(warned, warned).any
    found = compare(RESULT, warned)
    assert found.any
    assert [(c.name, c.before, c.after) for c in found.checks] == [("limit m", "", "too large")]
    assert "check      limit m: (none)\n" in as_text(found, 20)
    assert "too large" in as_markdown(found, 20)


def test_a_published_uncertainty_that_no_longer_comes_out_is_a_difference(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, u in (("right", "22.5"), ("wrong", "21.5")):
        folder = shutil.copytree(PAPER.parent / "ea_s2", tmp_path / name)
        table = (folder / "published.csv").read_text(encoding="utf-8")
        assert table.count(",22.5,") == 1
        (folder / "published.csv").write_text(table.replace(",22.5,", f",{u},"), encoding="utf-8")
        assert main(["build", str(folder), "--to", "json"]) == (name == "wrong")
    capsys.readouterr()
    assert main(["diff", str(tmp_path / "right"), str(tmp_path / "wrong")]) == 1
    told = capsys.readouterr().out
    assert "published  S2.12 u(m_X, m_S): 22.5: same\n" in told
    assert "-> 21.5: differs" in told


def test_a_limit_that_was_moved_is_a_difference(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, limit, found in (("wide", "50.0010", 0), ("narrow", "50.0008", 1)):
        shutil.copytree(PAPER.parent / "gum_h1", tmp_path / name)
        with (tmp_path / name / "report.toml").open("a") as file:
            file.write(f'\n[limits]\nl = "50.0007 .. {limit} mm"\n')
        assert main(["build", str(tmp_path / name), "--to", "json"]) == found
    capsys.readouterr()
    assert main(["diff", str(tmp_path / "wide"), str(tmp_path / "narrow")]) == 1
    told = capsys.readouterr().out
    assert "0 moved" in told
    assert "check      limits l: 50.0007 to 50.0010 mm: conforms, accepted from 50.0007 to 50.001 mm" in told
    assert "-> 50.0007 to 50.0008 mm: does not conform" in told
    assert main(["diff", str(tmp_path / "wide"), str(tmp_path / "wide")]) == 0
    assert capsys.readouterr().err == ""
    with (tmp_path / "wide" / "report.toml").open("a") as file:
        file.write("# another day\n")
    assert main(["diff", str(tmp_path / "wide"), str(tmp_path / "wide")]) == 0
    assert "wide/out is older than what it was built from, report.toml" in capsys.readouterr().err


def test_markdown_has_a_table_for_each_kind_and_no_live_text() -> None:
    evil = "|`<b>@you"
    found = Differences(
        evil, evil, 1, 0,
        (Move(evil, "1", "moved", 1.0, 2.0, ("ok", "ok")),) * 3,
        (), (evil,), (), (), (), (),
    )  # fmt: skip
    text = as_markdown(found, 2)
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert all(row.replace("\\|", "").count("|") in (6, 2) for row in rows)
    assert "and 1 more" in text
    assert "<b>" not in text.replace("`` |`<b>@you ``", "").replace("\\|`<b>@you", "")


def test_digits_tell_any_two_doubles_apart() -> None:
    for value in (1.0, 1.2579969787312368, 1e-300, 123456789.123, 2.97e-05):
        other = math.nextafter(value, math.inf)
        was, now, _ = moved(Move("x", "1", "moved", value, other, ("ok", "ok")))
        assert was != now
        assert (float(was), float(now)) == (value, other)


def test_the_verb(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    content = {
        "schema": 1, "title": "t", "workbook": "w", "proofs": {}, "published": [],
        "cells": {"m": {"axis": None, "unit": "m", "rule": "(1) m = 2", "value": 2.0, "status": "ok"}},
    }  # fmt: skip
    for name, value in (("a", 2.0), ("b", 2.5)):
        (tmp_path / name).mkdir()
        content["cells"]["m"]["value"] = value  # type: ignore[index]
        (tmp_path / name / "values.json").write_text(json.dumps(content))
    a, b = str(tmp_path / "a"), str(tmp_path / "b" / "values.json")
    assert main(["diff", a, a]) == 0
    assert capsys.readouterr().out.endswith("\nthe same\n")
    assert main(["diff", a, b]) == 1
    assert "m                2 -> 2.5 m   +25 %" in capsys.readouterr().out
    assert main(["diff", a, b, "--format", "markdown", "--most", "0"]) == 1
    assert "and 1 more: m (1)" in capsys.readouterr().out
    assert main(["diff", a, str(tmp_path)]) == 2
    assert "LS607" in capsys.readouterr().err
    assert main(["diff", a, b, "--most", "-1"]) == 2
    assert "not a whole number: '-1'" in capsys.readouterr().err


def test_a_result_that_was_changed_by_hand_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["build", PAPER.as_posix(), "--to", "json", "--out", str(tmp_path / "out")]) == 0
    result = tmp_path / "out" / "values.json"
    shutil.copy(result, tmp_path / "values.json")
    result.write_text(result.read_text(encoding="utf-8").replace("1.30", "1.31"), encoding="utf-8")
    capsys.readouterr()
    assert main(["diff", str(tmp_path / "values.json"), str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert "LS607" in told
    assert "changed after it was built" in told
    # Without a manifest beside it, nobody can tell.
    shutil.copy(result, tmp_path / "other.json")
    assert main(["diff", str(tmp_path / "values.json"), str(tmp_path / "other.json")]) == 1
