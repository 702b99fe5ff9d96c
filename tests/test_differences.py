"""Two results side by side."""

from __future__ import annotations

import json
import math
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import grouped
import pytest
from msgspec import UNSET
from msgspec.structs import replace

from loopsheet.report.archive.differences import Differences, Move, OtherChange, compare
from loopsheet.report.cli import main
from loopsheet.report.files.form import Index
from loopsheet.report.files.values import (
    Column,
    Conformity,
    Expanded,
    Oddity,
    Published,
    Result,
    Unit,
    read_result,
)
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
    (move,) = compare(RESULT, with_column("m", replace(M, status="OK"))).moved
    assert moved(move) == ("ok", "OK", "")  # and not 1.25 twice


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


def test_another_expanded_uncertainty_is_told_where_u_is_the_same() -> None:
    """Fewer degrees of freedom, or another distribution of the same standard uncertainty."""
    sure = Expanded(cell="m", U=0.5, k=2.0, level=0.95)
    column = Column(unit="1", rule="(12) m = a", value=1.25, status="ok", u=0.25)
    before = replace(with_column("m", column), expanded=[sure])
    assert not compare(before, before).any
    found = compare(before, replace(before, expanded=[replace(sure, U=1.0, k=4.0, dof=2.0)]))
    (move,) = found.moved
    assert (move.address, move.before, move.after) == ("U(m)", 0.5, 1.0)
    (change,) = compare(before, replace(before, expanded=[replace(sure, level=0.9545)])).printed
    assert change == OtherChange("U(m)", "95 % coverage", "95.45 % coverage")
    # With another u it is that which is told.
    wider = replace(with_column("m", replace(column, u=0.5)), expanded=[replace(sure, U=1.0)])
    assert [move.address for move in compare(before, wider).moved] == ["u(m)"]


def test_what_people_read_of_the_same_number_is_told() -> None:
    before = with_column("v", replace(V, text=["2.00", "3.00"]))
    found = compare(before, with_column("v", replace(V, text=["2.00", "3.000"])))
    assert found.printed == (OtherChange("v[2]", "3.00 m/s", "3.000 m/s"),)
    assert found.any
    assert as_text(found, 5).splitlines()[1:] == [
        "printed    v[2]: 3.00 m/s",
        "                 -> 3.000 m/s",
        "different",
    ]
    in_mm = replace(V, unit="m", text=["2.00", "3.00"], shown=Unit(text="mm", scale=1e-3))
    assert len(compare(before, with_column("v", in_mm)).printed) == 2
    (retitled,) = compare(RESULT, replace(RESULT, title="T")).printed
    assert retitled == OtherChange("title", "t", "T")
    assert not compare(before, RESULT).any  # a file of before does not tell it


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


PLACES = {1: "A", 2: "B", 3: "C"}
TURNED = {1: "C", 2: "B", 3: "A"}


def of_falls(words: dict[int, str], v: dict[str, float], **more: Any) -> Result:
    """Falls that words tell apart, of which `v` is known."""
    cells = {
        "v": listed("m/s", "falls", "given", {(n,): v[word] for n, word in words.items()}),
        "s": listed("m/s", "falls", "(1) s = v", {(n,): 10 * v[word] for n, word in words.items()}),
        "m": M,
    }
    return replace(RESULT, cells=cells, words={"falls": words}, **{"published": [], **more})


OF_FALLS = of_falls(PLACES, {"A": 1.0, "B": 2.0, "C": 3.0})


def test_rows_in_another_order_are_the_same_rows() -> None:
    """The word stands for the row: no number is another, and in one line it is told that the order is."""
    after = of_falls(TURNED, {"A": 1.0, "B": 2.0, "C": 3.0})
    found = compare(OF_FALLS, after)
    assert (found.same, found.any, found.order) == (7, False, ("falls",))
    assert as_text(found, 20) == (
        "numbers    7 in both: 7 the same, 0 within rounding, 0 moved\n"
        "order      the falls stand in another order: they are compared by their words\n"
        "the same\n"
    )
    assert "\nthe falls stand in another order: they are compared by their words\n" in as_markdown(found, 20)


def test_what_moved_of_rows_in_another_order_is_told_by_their_words() -> None:
    before, after = OF_FALLS, of_falls(TURNED, {"A": 1.0, "B": 2.0, "C": 3.5})
    surer = {
        name: replace(after.cells[name], u=u) for name, u in (("v", [0.1, 0.2, 0.3]), ("s", [0.1, 0.2, 0.3]))
    }
    sure = {name: replace(before.cells[name], u=[0.4, 0.2, 0.1]) for name in surer}
    before, after = (replace(r, cells=r.cells | u) for r, u in ((before, sure), (after, surer)))
    found = compare(before, after)
    assert [(move.named, move.before, move.after) for move in found.moved] == [
        ("u(v[A])", 0.4, 0.3), ("v[C]", 3.0, 3.5), ("s[C]", 30.0, 35.0), ("u(s[A])", 0.4, 0.3),
    ]  # fmt: skip
    assert found.any
    # What rounding may do is known of the rows as they stand now.
    allowed = {"v": {(1,): 1.0}, "s": {(1,): 10.0}}
    assert [move.named for move in compare(before, after, allowed).moved] == ["u(v[A])", "u(s[A])"]


def test_a_row_above_leaves_the_others() -> None:
    after = of_falls({1: "new", 2: "A", 3: "B", 4: "C"}, {"new": 9.0, "A": 1.0, "B": 2.0, "C": 3.0})
    found = compare(OF_FALLS, after)
    assert (found.moved, found.rows, found.order) == ((), (), ())
    assert (found.added, found.removed) == (("v[new]", "s[new]"), ())
    found = compare(after, OF_FALLS)
    assert (found.moved, found.added, found.removed) == ((), (), ("v[new]", "s[new]"))


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ({1: "A", 2: "B", 3: "A"}, {1: "B", 2: "A", 3: "A"}),  # a word of two rows
        ({1: "A", 2: "B", 3: "4"}, {1: "B", 2: "A", 3: "4"}),  # a number is that of a row
        ({10: "A", 20: "B"}, {10: "B", 20: "A"}),  # numbers that somebody wrote
        ({2: "A", 1: "B"}, {2: "B", 1: "A"}),
    ],
)
def test_what_no_word_stands_for_alone_is_compared_by_number(
    before: dict[int, str], after: dict[int, str]
) -> None:
    v = {"A": 1.0, "B": 2.0, "4": 3.0}
    (one, other), found = list(before)[:2], compare(of_falls(before, v), of_falls(after, v))
    assert [move.address for move in found.moved] == [f"v[{one}]", f"v[{other}]", f"s[{one}]", f"s[{other}]"]
    assert {change.name for change in found.rows} == {f"falls {one}", f"falls {other}"}
    assert found.order == ()


def test_pairs_are_of_the_rows_that_words_stand_for() -> None:
    def paired(result: Result, cells: dict[Index, float]) -> Result:
        return replace(result, cells={**result.cells, "a": listed("1", "pairs", "(2) a = v", cells)})

    v = {"new": 9.0, "A": 1.0, "B": 2.0, "C": 3.0}
    before = paired(OF_FALLS, {(1, 2): 12.0, (1, 3): 13.0, (2, 3): 23.0})
    above = of_falls({1: "new", 2: "A", 3: "B", 4: "C"}, v)
    found = compare(before, paired(above, {(1, 2): 91.0, (2, 3): 12.0, (2, 4): 13.0, (3, 4): 24.0}))
    assert [(move.named, move.before, move.after) for move in found.moved] == [("a[B-C]", 23.0, 24.0)]
    assert found.added == ("v[new]", "s[new]", "a[new-A]")
    # Of two tables nobody knows whose pairs they are.
    two = {"w": listed("m", "others", "given", {(1,): 1.0})}
    both = (replace(each, cells=each.cells | two) for each in (before, paired(above, {(1, 2): 12.0})))
    assert compare(*both).removed == ("a[1-3]", "a[2-3]")


def test_what_is_told_of_rows_in_another_order_is_told_by_their_words() -> None:
    def told(words: dict[int, str], odd: tuple[int, int], out: int) -> Result:
        cells = " and ".join(f"v[{n}] ({words[n]}) is odd" for n in odd)
        decided = Conformity(cell=f"v[{out}]", limits="l", acceptance=(None, None), decision="conforms")
        return of_falls(
            words, {"A": 1.0, "B": 2.0, "C": 3.0},
            published=[replace(PUBLISHED, cell="v", index=[out])],
            published_u=[replace(PUBLISHED, cell="U95(s)", index=[out])],
            conformity=[decided],
            oddities=[
                Oddity(kind="groups", name="fall height", word="warning", sentence="as it was"),
                Oddity(kind="limit", name="v", word="warning", sentence=f"v: 2 of 3 falls: {cells}"),
                Oddity(
                    kind="left out", name=f"fall {out}", word="left out",
                    sentence=f"fall {out} ({words[out]}), wet",
                ),
            ],
        )  # fmt: skip

    before = told(PLACES, (1, 2), 1)
    assert not compare(before, told(TURNED, (2, 3), 3)).any
    found = compare(
        before, told(TURNED, (1, 3), 1)
    )  # the limit of v, another cell of which is odd, is told as before
    assert [change.name for change in found.published] == [
        f"Table 2 {cell}" for cell in ("v[A]", "U95(s)[A]", "v[C]", "U95(s)[C]")
    ]
    assert [(change.name, change.before, change.after) for change in found.checks][:1] == [
        ("left out fall A", "left out", "")
    ]
    assert "limits v[C]" in [change.name for change in found.checks]


def test_groups_in_another_order_are_the_same_groups(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Rows that keep their numbers stand the other way round, so that groups are numbered otherwise."""
    stated = '[uncertainty]\ny = "u = 0.2 mm"\n[limits]\n"level[B]" = "<= 3 mm"\n'
    folder = grouped.write(tmp_path / "instruments", more=stated)
    assert main(["build", str(folder), "--to", "json", "--out", str(tmp_path / "before")]) == 0
    table = folder / "measurements.csv"
    head, *lines = table.read_text(encoding="utf-8").splitlines()
    table.write_text("\n".join((head, *reversed(lines))), encoding="utf-8")
    capsys.readouterr()
    assert main(["verify", str(tmp_path / "before"), str(folder), "--run-workbook"]) == 1
    told = capsys.readouterr().out
    assert "\norder      the instruments stand in another order: they are compared by their words\n" in told
    assert "number     114 the same\n" in told
    assert told.endswith("different: the input (measurements.csv) changed\n")
    assert main(["build", str(folder), "--to", "json"]) == 0
    capsys.readouterr()
    assert main(["diff", str(tmp_path / "before"), str(folder)]) == 0
    assert capsys.readouterr().out.endswith("0 moved\n" + told.splitlines()[-3] + "\nthe same\n")


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
    assert "check      limits l: 50.0007 to 50.0010 mm: conforms\n" in told
    assert "-> 50.0007 to 50.0008 mm: does not conform\n" in told
    assert main(["diff", str(tmp_path / "wide"), str(tmp_path / "wide")]) == 0
    assert capsys.readouterr().err == ""
    with (tmp_path / "wide" / "report.toml").open("a") as file:
        file.write("# another day\n")
    assert main(["diff", str(tmp_path / "wide"), str(tmp_path / "wide")]) == 0
    assert "wide/out is older than what it was built from, report.toml" in capsys.readouterr().err


def test_acceptance_limits_are_others_if_they_print_otherwise(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """As the report tells them, with the digits of the guard band."""
    folder = shutil.copytree(PAPER.parent / "gum_h1", tmp_path / "gauge")
    with (folder / "report.toml").open("a") as file:
        file.write('\n[limits]\nl = "50.0005 .. 50.0012 mm, guard = U"\n')
    assert main(["build", str(folder), "--to", "json"]) == 0
    capsys.readouterr()
    assert main(["budget", "l", str(folder)]) == 0
    budget = capsys.readouterr().out
    built = read_result(folder / "out" / "values.json")
    (decided,) = built.conformity or ()
    assert re.fullmatch(r"50\.000\d{3} to 50\.001\d{3}", within := str(decided.accepted))
    assert f"acceptance limits {within} mm\n" in budget

    def told(one: Conformity, other: Conformity) -> list[tuple[str, ...]]:
        results = (replace(built, conformity=[each]) for each in (one, other))
        return [(change.name, change.before, change.after) for change in compare(*results).checks]

    low, high = decided.acceptance
    assert low is not None
    assert told(decided, replace(decided, acceptance=(low * (1 + 1e-10), high))) == []
    limits = "50.0005 to 50.0012 mm: conforms"
    assert told(decided, replace(decided, accepted="50.0006 to 50.0011")) == [
        (
            "limits l",
            f"{limits}, acceptance limits {within} mm",
            f"{limits}, acceptance limits 50.0006 to 50.0011 mm",
        )
    ]
    assert told(decided, replace(decided, accepted=UNSET)) == []  # a file of before does not tell them


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
