"""What is told of a report: one check for each engine, proof, published value and table, in its own words."""

from dataclasses import replace

import pytest
from small_report import end_gauge

from loopsheet.derivations.equation import Step
from loopsheet.derivations.proved import Proof, ProofStatus, StepProof
from loopsheet.report.engines import ENGINES
from loopsheet.report.messages.diagnostics import Check
from loopsheet.report.result import verdict_words as words
from loopsheet.report.result.agreement import Agreement
from loopsheet.report.result.findings import checks, names_of, of_engine, table_names
from loopsheet.report.result.result import Report
from loopsheet.report.result.verdict import (
    OTHERS,
    REACHABLE,
    UNAMENDED,
    UNREACHABLE,
    Change,
    Explanation,
    Referee,
    TableVerdict,
    Verdict,
)
from loopsheet.report.study import Study

KNOWN = "source,cell,index,value,unit,expect,recomputed,reason"
ROWS = (
    "Table 1,l,1,50.000838,mm,,,",
    "Table 2,l,1,51.2,mm,differs,51.2 -> 50.0,a slip",
    "Table 2,l_S,,50,mm,,,",
)
MISPRINT = Explanation((Change("misprint", "theta", (), "input", "-0.1", "-0.2"),), 0.5, 3, 3)


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Report:
    folder = end_gauge(tmp_path_factory.mktemp("gauge"), "\n".join((KNOWN, *ROWS, "")))
    return Study(folder).computed


def of_kind(report: Report, kind: str) -> list[Check]:
    return [check for check in checks(report) if check.kind == kind]


def test_engines(small: Report) -> None:
    assert tuple(ENGINES) == ("numpy", "JavaScript", "xlsx")
    toml = (small.inputs.folder / "report.toml").as_posix()
    missing = Agreement(0, 0.0, "", (), engine="xlsx", missing="LibreOffice")
    good, absent = of_kind(replace(small, engines=(Agreement(7, 1e-16, "l[1]", ()), missing)), "engine")
    assert (good.name, good.passed, good.skipped) == ("numpy", True, False)
    assert good.message == "numpy agrees with 50 digits on 7 cells within 1.0e-16 (l[1])"
    assert (absent.name, absent.passed, absent.skipped) == ("xlsx", True, True)
    assert absent.message == "xlsx was not compared: LibreOffice not found"
    assert good.at.path == absent.at.path == toml
    for number, end in ((5, "5"), (6, "5; and 1 more"), (7, "5; and 2 more")):
        said = of_engine(Agreement(9, 1.0, "x", tuple(map(str, range(1, number + 1)))), small.inputs)
        assert not said.passed
        assert said.message == f"1; 2; 3; 4; {end}"


def test_proofs(small: Report) -> None:
    (claim,) = small.ledger.equations()
    step = Step(claim, (), (), "put in")
    wrong = StepProof(step, ProofStatus.REFUTED, 20, 1.0, {"l": "1"}, ("1", "2"))
    right = StepProof(step, ProofStatus.PROVED, 20, 0.0)
    proofs = (
        Proof(claim, ProofStatus.DEFINITION),
        Proof(claim, ProofStatus.REFUTED, (right, wrong), "misprinted"),
        Proof(claim, ProofStatus.UNDECIDED, (right,), "too hard"),
    )
    passed, refuted, undecided = of_kind(replace(small, proofs=proofs), "proof")
    assert (passed.name, passed.passed, passed.message) == ("(H.1)", True, "(H.1) is definition")
    assert (refuted.passed, refuted.message) == (False, f"(H.1) is refuted: {wrong.sentence}")
    assert (undecided.passed, undecided.message) == (False, "(H.1) is undecided: too hard")
    assert passed.at.path.endswith("/report.toml")
    assert passed.sentence == passed.message


def test_published_values(small: Report) -> None:
    one, two, three = of_kind(small, "published")
    assert [one.name, two.name, three.name] == ["l[1] (Table 1)", "l[1] (Table 2)", "l_S"]
    assert one.passed
    assert one.message == "Table 1 l[1] prints 50.000838, recomputed 50.000838 (same)"
    assert two.passed
    assert two.message == "Table 2 l[1] prints 51.2, recomputed 50.0 (differs): a slip"
    assert three.passed
    assert (two.at.line, two.at.column) == (3, 13)
    assert two.sentence == f"{two.at}: {two.message}"
    assert names_of(small.inputs.published[1:]) == ["l[1]", "l_S"]


def test_a_published_value_without_a_place(small: Report) -> None:
    """Who makes values in a program has no file; then the message alone is told."""
    bare = tuple(replace(c, published=replace(c.published, places={})) for c in small.comparisons)
    assert [check.at.path for check in of_kind(replace(small, comparisons=bare), "published")] == [""] * 3


def test_a_value_that_the_known_misprints_do_not_explain(small: Report) -> None:
    wrong = replace(small.comparisons[1], finding=UNAMENDED)
    (check,) = of_kind(replace(small, comparisons=(wrong,)), "published")
    assert not check.passed
    assert check.message.endswith("50.0, and does not come out once the known misprints are put right")


def refereed(small: Report, **more: object) -> list[Check]:
    values = tuple(Verdict(word) for word in (REACHABLE, UNREACHABLE, REACHABLE))
    tables = (TableVerdict("Table 1", 1, REACHABLE, 0.5), TableVerdict("Table 2", 2, UNREACHABLE, 8.0))
    joint = TableVerdict("all", 3, UNREACHABLE, 9.0, 6.0)
    found = Referee(values, tables, joint)
    return of_kind(replace(small, referee=replace(found, **more)), "table")  # type: ignore[arg-type]


def test_tables(small: Report) -> None:
    """One that holds known differences is not asked to come out; that all do is not asked then either."""
    assert of_kind(small, "table") == []
    first, second, together = refereed(small)
    assert (first.name, first.passed) == ("Table 1", True)
    assert "with a worst mismatch of 0.5 half units" in first.message
    assert (second.name, second.passed) == ("Table 2", True)
    assert second.message.startswith("the 2 values of Table 2 cannot come out of one input")
    assert (together.name, together.passed) == ("all together", True)
    said, nothing = together.message.split(". ")[-1].rsplit("; ", 1)
    assert said.endswith("by interval arithmetic none leaves less than 6.0")
    assert nothing == words.NOTHING_EXPLAINS
    explained = refereed(small, explanations=(MISPRINT,))[-1]
    assert "; perhaps theta is printed -0.1 for -0.2" in explained.message
    assert all(check.at.path.endswith("/report.toml") for check in (first, second, together))


@pytest.mark.parametrize(
    ("joint", "said"),
    [
        (TableVerdict("all", 3, UNREACHABLE, 8.0), "cannot come out either, as is told of Table 2; no small"),
        (TableVerdict("all", 3, UNREACHABLE, 8.1), "cannot come out of one input that prints as given: "),
        (TableVerdict("all", 3, REACHABLE, 0.5), "can come out of one input that prints as given, with a "),
    ],
)
def test_what_is_told_of_a_table_is_not_told_again(small: Report, joint: TableVerdict, said: str) -> None:
    message = refereed(small, joint=joint)[-1].message
    assert message.startswith(f"all 3 published values together {said}")


def test_tables_without_known_differences_have_to_come_out(small: Report) -> None:
    published = tuple(replace(value, expect="") for value in small.inputs.published)
    unannounced = replace(small, inputs=replace(small.inputs, published=published))
    assert [check.passed for check in refereed(unannounced)] == [True, False, False]


@pytest.mark.parametrize(("verdict", "passed"), [(REACHABLE, True), (UNREACHABLE, False)])
def test_beside_known_differences_all_others_have_to_come_out(
    small: Report, verdict: str, passed: bool
) -> None:
    """A known misprint does not hide the next one."""
    others = TableVerdict(OTHERS, 2, verdict, 0.5 if passed else 3.0)
    together = refereed(small, others=others)[-1]
    assert together.passed is passed
    said = "the 2 published values that are neither known to differ nor out of reach cannot come out"
    assert (said in together.message) is not passed


def test_known_misprints(small: Report) -> None:
    assert table_names(small.inputs) == ["Table 1", "Table 2", "all together"]
    known = replace(small.inputs, errata={("d", 0): small.inputs.measured["d"][0]})
    assert table_names(known) == ["Table 1", "Table 2", "all together", "known misprints"]
    assert table_names(replace(known, published=())) == []
    changes = (Change("misprint", "d", (1,), "input", "215", "216"),)
    out = TableVerdict("all", 3, REACHABLE, 0.7)
    (check,) = refereed(small, errata=changes, amended=out)[3:]
    assert (check.name, check.passed) == ("known misprints", True)
    assert check.message.startswith("with d[1] as 216, not 215, all 3 published values together can come out")
    right = (replace(changes[0], printed="216"), *changes)
    (check,) = refereed(small, errata=right, amended=out)[3:]
    assert check.message.startswith("with d[1] as 216, as it is here and d[1] as 216, not 215, all 3")
    (check,) = refereed(
        small, errata=changes, amended=replace(out, verdict=UNREACHABLE), misprints=(MISPRINT,)
    )[3:]
    assert not check.passed
    assert "0.7 half units of the last digit; with that, perhaps theta is printed -0.1" in check.message
    (check,) = refereed(small, errata=changes, amended=out, joint=out)[3:]
    assert (check.name, check.passed) == ("known misprints", False)
    assert check.message == "all values come out as it is; drop the known misprints"
