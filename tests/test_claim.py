"""What an author of a method claims is proved, or it is a finding."""

from __future__ import annotations

from pathlib import Path

import pytest
from helpers import method_folder

from loopsheet.derivations.proof import prove
from loopsheet.derivations.proved import Proof, ProofStatus
from loopsheet.report.cli import main
from loopsheet.report.method import words
from loopsheet.report.study import Study

BODY = """\
    x = measured("m", "place")
    y = measured("V", "voltage")
    L = given("m", "length", positive=True)
    dx = let(x - mean(x), "place from the mean on")
    S = let(total(dx**2), "squares")
    s = let(sqrt(S / (count() - 1)), "scatter")
    R = let(total(x * y) ** 2 / (total(x**2) * total(y**2)), "square of a cosine")
    part = let(x / L, "part")
    tenth = let(0.1 * x + 2.104 * L, "with decimal fractions")
    a = unknown("offset")
    b = unknown("slope")
    line = fit(y, a + b * x)
"""
WORDS = """\
from sympy import cos, sin, sqrt
from loopsheet import Method, claim, count, fit, given, let, mean, measured, median, root, total, unknown
"""
CLAIMS = {
    "(S, total(x**2) - total(x) ** 2 / count(), 'by raw sums')": "(S, total(x**2) - total(x) ** 2, 'w')",
    "(total(dx), 0, 'nothing is left')": "(total(dx), mean(x), 'w')",
    "(dx + mean(x), x, 'of each row')": "(dx + mean(x), x + L / 10**30, 'w')",
    "(s**2 * (count() - 1), total(x * dx), 'squares')": "(s**2 * count(), total(x * dx), 'w')",
    "(part**2 * L, x**2 / L, 'of a row')": "(part**2 * L, 2 * x**2 / L, 'w')",
    "(tenth**2, (x + 21.04 * L) ** 2 / 100, 'decimals')": "(tenth**2, (x + 21.05 * L) ** 2 / 100, 'w')",
    "(sin(part) ** 2 + 0.5 * cos(part) ** 2 * 2, 1, 'a')": "(sin(part) ** 2 + cos(part), 1.0, 'w')",
    "(total(line.residual), 0, 'residuals')": "(total(line.residual**2), 0, 'w')",
    "(total(line.residual * x), 0, 'moments')": "(total(line.residual * x**2), 0, 'w')",
    "(b, total(dx * y) / S, 'slope')": "(b, total(dx * y) / total(x**2), 'w')",
    "(a, mean(y) - b * mean(x), 'mean point')": "(a, mean(y) + b * mean(x), 'w')",
    "(line.S, total(y * line.residual), 'squares')": "(line.S, total(line.fitted * line.residual), 'w')",
    "(sqrt(S) * sqrt(1 - R), sqrt(S - S * R), 'but for rounding')": "(sqrt(1 - R), 1 - R, 'w')",
    "(S, total(dx * x), 'by one', from_=[S, dx])": "(total(dx), 0, 'w', from_=[S])",
    "(total(x / max(x)) * max(x), total(x), 'parts')": "(total(x / max(x)) * min(x), total(x), 'w')",
    "(total((x - min(x))**2), total(x**2) - 2 * min(x) * total(x) + count() * min(x)**2, 'a sum with one')": (
        "(total((x - min(x))**2), total(x**2) - 2 * max(x) * total(x) + count() * max(x)**2, 'w')"
    ),
    "(dx + median(x), x - mean(x) + median(x), 'of a row')": "(dx + median(x), x, 'w')",
}
"""What holds, and what does not."""


def proved(claim: str) -> Proof:
    scope: dict[str, object] = {}
    exec(f"{WORDS}\n\nclass Claimed(Method):\n{BODY}    claim{claim}\n", scope)
    ledger = scope["Claimed"].workbook.ledger()  # type: ignore[attr-defined]
    return prove(ledger)[-1]


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_claim_is_proved_and_another_is_refuted(claim: str) -> None:
    right, wrong = proved(claim), proved(CLAIMS[claim])
    assert right.status is ProofStatus.PROVED
    assert wrong.status is ProofStatus.REFUTED
    assert wrong.steps[-1].counterexample


WITHIN = {
    'e = measured("1", "of 0 to 1", low=0, high=1)': {
        "sqrt((1 - e) ** 2)": "1 - e",
        "log((1 - e) ** 2)": "2 * log(1 - e)",
        "acos(-e)": "pi - acos(e)",
        "asin(e)": "pi / 2 - acos(e)",
        "sqrt((1 - e) / (1 + e))": "(1 - e) / sqrt(1 - e**2)",
    },
    'e = given("mm", "at most 7 mm", low=2, high=7)': {"sqrt((e - K) ** 2)": "K - e"},
}
"""What holds where a quantity may be, and nowhere else."""


@pytest.mark.parametrize("line", WITHIN)
def test_what_holds_of_all_that_is_let_in_is_proved_and_says_where(line: str) -> None:
    named = "from sympy import acos, asin, log, pi, sqrt\nfrom loopsheet import *"
    known = f'    K = given("mm", "at least 7 mm", low=7)\n    {line}\n    b = let(2 * e, "twice")\n'
    wider = line.replace("low=0, high=1", "low=-2, high=2").replace("high=7", "high=8")
    for left, right in WITHIN[line].items():
        for own in (line, wider):
            scope: dict[str, object] = {}
            body = f"{known.replace(line, own)}    claim({left}, {right}, 'c')\n"
            exec(f"{named}\n\n\nclass Within(Method):\n{body}", scope)
            (found,) = prove(scope["Within"].workbook.ledger())[-1].steps  # type: ignore[attr-defined]
            assert (found.status is ProofStatus.PROVED) == (own is line), (left, own, found.sentence)
            if own is line:
                assert ("e_i <= 1" if "measured" in line else "e <= 7/1000") in found.why


FIT = """
from sympy import log
from loopsheet import *

class Curve(Method):
    R = measured("ohm", "resistance", positive=True)
    T = measured("K", "temperature", positive=True)
    R_0 = given("ohm", "reference", positive=True)
    x = let(log(R / R_0), "logarithm")
    y = let(1 / T, "reciprocal")
    A = unknown("A", "1/K")
    B = unknown("B", "1/K")
    C = unknown("C", "1/K")
    line = fit(y, A + B * x + C * x**3)
    claim(sum(line.residual * x), {}, "no slope is left")
"""
"""An equation of Steinhart and Hart's: put into one another, its sums have terms without number."""


@pytest.mark.parametrize("right", ["0", "sum(line.residual)", "sum(y) / 7"])
def test_what_follows_from_normal_equations_follows_of_any_columns(right: str) -> None:
    scope: dict[str, object] = {}
    exec(FIT.format(right), scope)
    found = prove(scope["Curve"].workbook.ledger())[-1]  # type: ignore[attr-defined]
    assert (found.status is ProofStatus.PROVED) == (right != "sum(y) / 7")
    assert found.status is not ProofStatus.UNDECIDED
    if right != "sum(y) / 7":
        assert {f"normal equation of the {each}" for each in "ABC"} <= set(found.rests_on)


WEIGHED = """
from loopsheet import *

class Weighed(Method):
    x = measured("mm", "abscissa")
    y = measured("V", "ordinate")
    w = measured("V", "standard uncertainty", positive=True, exact=True)
    a = unknown("offset", "V")
    b = unknown("slope", "V/mm")
    line = fit(y, a + b * x, u=w)
    claim(sum(line.residual{} / w**2), 0, "nothing is left by weight")
"""


@pytest.mark.parametrize("more", ["", " * x", " * y"])
def test_what_is_left_by_weight_is_proved_of_stated_weights(more: str) -> None:
    scope: dict[str, object] = {}
    exec(WEIGHED.format(more), scope)
    found = prove(scope["Weighed"].workbook.ledger())[-1]  # type: ignore[attr-defined]
    assert found.status is (ProofStatus.REFUTED if "y" in more else ProofStatus.PROVED)


def folder(path: Path, line: str) -> Path:
    code = f'{WORDS}\n\nclass Claimed(Method):\n    """Claims."""\n\n{BODY}    {line}\n'
    rows = "reading,x [m],y [V]\n1,1.0,2.0\n2,2.0,3.1\n3,3.5,4.2\n"
    return method_folder(path, code, rows, '[parameters]\nL = "2.0 m"\n')


@pytest.mark.parametrize(("right", "code"), [("0", 0), ("mean(x)", 1)])
def test_a_wrong_claim_is_red(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], right: str, code: int
) -> None:
    where = folder(tmp_path, f"claim(total(dx), {right}, 'nothing is left', label='(C)')")
    assert main(["prove", "(C)", str(where)]) == code
    told = capsys.readouterr().out
    assert ("refuted" in told) == bool(code)
    assert ("proved: residual 0" in told) != bool(code)
    assert all(proof.status.passes for proof in Study(where).proved.proofs) != bool(code)
    assert main(["check", str(where)]) == code


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("claim(x, y, 'of two kinds')", "of two kinds (8): cannot add A^-1 kg m^2 s^-3 and m"),
        ("claim(x > y, 1, 'no formula')", "is no formula of real numbers"),
        (
            "r = unknown(); r = root(r**3 + r, x, 'r', low=0, high=9); claim(r, x, 'root')",
            "r is sought, it has no formula to put in: say what 'root' follows from without it, from_=[...]",
        ),
    ],
)
def test_what_cannot_be_claimed_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], line: str, said: str
) -> None:
    where = folder(tmp_path, line.replace("x, 'r'", "x / L, 'r'"))
    assert main(["check", str(where)]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert "workbook.py:" in told


def test_a_claim_stands_in_the_body_of_a_method() -> None:
    import contextvars

    with pytest.raises(words.SheetError, match="stand in the body of a class of Method"):
        contextvars.Context().run(words.claim, 1, 1, "one")


def test_what_is_proved_must_hold_of_the_data(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Each sum leaves out the rows that it has no value for; a proof knows of none."""
    code = (
        "from sympy import sqrt\nfrom loopsheet import Method, claim, let, mean, measured\n"
        "class Means(Method):\n    y = measured('1', 'size')\n    s = let(sqrt(y), 'root')\n"
        "    a = let(mean(y), 'mean')\n    b = let(mean(s**2), 'the same')\n    claim(a, b, 'means')\n"
        "    claim(s**2, y, 'of each row')\n"
    )
    for first, found in (("-0.1", 1), ("0.1", 0)):
        rows = f"test,y [1]\n1,{first}\n2,1.9\n3,1.2\n"
        method_folder(tmp_path, code, rows, '[expected]\n"s[1]" = "below"\n')
        own = {c.name: c.passed for c in Study(tmp_path).computed.oddities if c.kind == "claim"}
        assert own == {"(4)": not found, "(5)": True}
        if found:
            assert main(["check", str(tmp_path)]) == 1
            told = capsys.readouterr().out
            assert "finding: (4), means, does not hold of these data: its sides differ by -0.55 in SI" in told


def test_a_claim_that_has_no_value_of_these_data_is_told(tmp_path: Path) -> None:
    """What was proved of all numbers for which both sides have values says nothing of 0/0."""
    code = (
        "from loopsheet import Method, claim, let, measured\n"
        "class Parts(Method):\n    x = measured('m', 'first')\n    y = measured('m', 'second')\n"
        "    s = let(x + y, 'sum')\n    claim((x**2 - y**2) / (x - y), s, 'quotient')\n"
    )
    for second, told in (("2.0", "(2), quotient, has no value for these data in row 2"), ("2.5", "")):
        rows = f"test,x [m],y [m]\n1,1.0,3.0\n2,2.0,{second}\n"
        study = Study(method_folder(tmp_path, code, rows))
        assert all(proof.status.passes for proof in study.proved.proofs)
        (check,) = (c for c in study.computed.oddities if c.kind == "claim")
        assert (check.passed, check.note) == (True, "warning" if told else "")
        assert told in check.message


def test_a_whole_number_is_drawn_as_one(tmp_path: Path) -> None:
    code = (
        "from sympy import cos, pi\nfrom loopsheet import Method, claim, given, let\n"
        "class Turns(Method):\n    n = given('1', 'turns', whole=True)\n"
        "    m = given('1', 'one or two', whole=True, low=0.5, high=2.5)\n"
        "    c = let(cos(2 * pi * n), 'cosine')\n    claim(c, 1, 'whole turns')\n"
        "    claim(cos(pi * n), 1, 'half turns')\n    claim((m - 1) * (m - 2), 0, 'one or two')\n"
        "    claim(m, 1, 'one')\n"
    )
    study = Study(method_folder(tmp_path, code, more='[parameters]\nn = "4"\nm = "1"\n'))
    found = {proof.equation.title: proof.status for proof in study.proved.proofs}
    assert {said: found[said] for said in ("whole turns", "half turns", "one or two", "one")} == {
        "whole turns": ProofStatus.UNDECIDED,
        "half turns": ProofStatus.REFUTED,
        "one or two": ProofStatus.UNDECIDED,
        "one": ProofStatus.REFUTED,
    }
