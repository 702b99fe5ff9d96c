"""Derivatives in a method: what names stand for is put in; calculus that does not see it is refused."""

from __future__ import annotations

from inspect import unwrap
from pathlib import Path

import pytest
from helpers import method_folder
from sympy import exp, sqrt

from loopsheet import Method, derivative, fit, given, let, load, mean, measured, pairs, root, total, unknown
from loopsheet.report.column import SheetError
from loopsheet.report.messages.errors import InputError
from loopsheet.report.study import Study

TABLE = "row,a [mm],b [mm]\n1,300,150.0\n2,310,148.0\n3,330,141.2\n"
HEAD = """from sympy import diff

from loopsheet import Method, claim, derivative, given, let, measured


"""
CODE = f"""{HEAD}class Lens(Method, rows="rows"):
    "A lens."

    a = measured("mm", "object distance", positive=True)
    b = measured("mm", "image distance", positive=True)
    u_a = given("mm", "u of a", positive=True)
    s = let(a + b, "sum", "mm")
    f = let(a * b / s, "focal length", "mm")
    u_f = let(u_a * derivative(f, a), "u of f by a alone", "mm")
"""


def write(folder: Path, code: str) -> Path:
    return method_folder(folder, code, TABLE, '[parameters]\nu_a = "0.5 mm"\n')


def test_a_derivative_goes_through_what_names_stand_for(tmp_path: Path) -> None:
    report = load(write(tmp_path, CODE))
    a, b = report["a"].value, report["b"].value
    assert report["u_f"].value == pytest.approx(0.5 * (b / (a + b)) ** 2, rel=1e-14)


@pytest.mark.parametrize(
    ("claimed", "status"), [("(b / (a + b))**2", "proved"), ("b**2 / s**2", "proved"), ("b / s", "refuted")]
)
def test_a_claim_on_a_derivative_is_proved_or_refuted(tmp_path: Path, claimed: str, status: str) -> None:
    code = f'{CODE}    claim(derivative(f, a), {claimed}, "slope", label="(S)")\n'
    study = Study(write(tmp_path, code))
    (proof,) = study.proofs([study.ledger["(S)"]])
    assert proof.status.value == status


@pytest.mark.parametrize(
    "line",
    [
        'u_f = let(u_a * diff(a * b / s, a), "u", "mm")',
        'u_f = let(u_a * (a * b / s).diff(a), "u", "mm")',
        'u_f = let(u_a * f.subs(a, 2 * a), "u")',
        'u_f = let(u_a * slope(f, a), "u")',
        'u_f = let(u_a * d(f, a), "u")',
    ],
)
def test_calculus_that_takes_names_for_constants_is_refused(tmp_path: Path, line: str) -> None:
    helper = "from sympy import diff as d\n\n\ndef slope(formula, x):\n    return formula.diff(x)\n\n\n"
    code = CODE.replace(HEAD, HEAD + helper * ("slope" in line or " d(" in line))
    code = code.replace('u_f = let(u_a * derivative(f, a), "u of f by a alone", "mm")', line)
    with pytest.raises(InputError, match="takes a name for a constant") as caught:
        Study(write(tmp_path, code)).computed  # noqa: B018
    (found, *_) = caught.value.diagnostics
    assert "diff" in str(found.at.source) or "subs" in str(found.at.source) or " d(" in str(found.at.source)
    assert "derivative(formula, x)" in found.hint


def test_what_a_derivative_is_taken_of_and_by() -> None:
    refused = unwrap(derivative)  # at once, not with all that is wrong in the body

    class Every(Method, rows="rows"):
        """Every case."""

        a = measured("mm", "a", positive=True)
        b = measured("mm", "b", positive=True)
        K = given("1", "K", positive=True)
        s = let(a + b, "s")
        m = let(mean(a), "m")
        q = unknown()
        r = let(K * sqrt(s), "r")
        first, second = pairs()
        assert derivative(K * s**2, s) == 2 * K * s
        assert derivative(q * r, q) == r
        assert derivative(r, K) == sqrt(s)
        assert derivative(first(a) * second(a) * first(b), first(a)) == second(a) * first(b)
        for formula, by, told in (
            (a * s, s, "what stays as it is"),
            (m * a, a, "not by a formula of one row"),
            (total(r), a, "is taken over rows"),
            (first(r), a, r"say first\(...\) or second"),
            (r, 2 * a, "by what has a name"),
        ):
            with pytest.raises(SheetError, match=told):
                refused(formula, by)
        scale, size = unknown("scale", "mm", start=1, positive=True), unknown("size", start=1)
        line = fit(b, size * scale * exp(a / scale))
        assert derivative(size * exp(K * size), K) == size**2 * exp(K * size)
        q = root(q**2, K, "q", low=0, high=9)
        with pytest.raises(SheetError, match="not by a formula of one row"):
            refused(q * K, K)

    assert Every.workbook.name == "every"
