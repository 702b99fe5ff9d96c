"""What an author says of the parameters of a fit: proofs take it, and what is found is held to it."""

from __future__ import annotations

from pathlib import Path

import pytest
from helpers import method_folder

from loopsheet.derivations.proved import ProofStatus
from loopsheet.report.cli import main
from loopsheet.report.engines import ENGINES
from loopsheet.report.study import Study

HEAD = """from sympy import exp, log, sqrt
from loopsheet import Method, claim, fit, let, measured, root, unknown


class Line(Method, rows="readings"):
    x = measured("m", "place", positive=True)
    y = measured("V", "voltage")
"""
RISING, FALLING = ((0.1, 0.31, 0.49, 0.7), (0.9, 0.69, 0.51, 0.3))


def folder(place: Path, lines: str, y: tuple[float, ...]) -> Path:
    rows = (f"{n},{n}.0,{value}" for n, value in enumerate(y, 1))
    code = HEAD + "".join(f"    {line}\n" for line in lines.split("; "))
    return method_folder(place, code, "\n".join(("reading,x [m],y [V]", *rows, "")))


LINE = "a = unknown('a', 'V'); b = unknown('b', 'mV/m'{}); f = fit(y, a + b * x); "
CURVE = "a = unknown('a', 'V', start=1.0); b = unknown('b', '1/m', start=0.2{}); f = fit(y, a * exp(b * x)); "
BOTH = "r = let(1 / x, 'r'); a = unknown('a', 'V'{0}); b = unknown('b', 'V*m'{0}); f = fit(y, a + b * r); "
HILL = (
    "V = let(1 / a, 'V'); K = let(b / a, 'K'); m = let(V * x / (K + x), 'm'); "
    "claim(log(m / (V - m)), log(x / K), 'Hill', label='(P)')"
)


def test_proofs_draw_a_parameter_as_it_is_said_to_be(tmp_path: Path) -> None:
    of = Study(folder(tmp_path, BOTH.format(", positive=True") + HILL, RISING)).proved.proofs
    assert next(proof.status for proof in of if proof.equation.label == "(P)") is ProofStatus.PROVED


def test_one_that_is_positive_proves_nothing_false(tmp_path: Path) -> None:
    lines = LINE.format(", positive=True") + "claim(sqrt(a**2) * b, a * b, 'of the other', label='(F)')"
    found = {
        proof.equation.label: proof.status for proof in Study(folder(tmp_path, lines, RISING)).proved.proofs
    }
    assert found["(F)"] is ProofStatus.REFUTED


@pytest.mark.parametrize("fitted", [LINE, CURVE])
def test_one_that_is_not_positive_has_no_value_in_any_engine(fitted: str, tmp_path: Path) -> None:
    study = Study(folder(tmp_path, fitted.format(", positive=True"), FALLING))
    assert study.computed.values.cell("b").reason.startswith("#")
    assert [engine.findings for engine in study.engines] == [()] * len(ENGINES)
    assert {"a", "b"} & {cell.name for cell in study.computed.faults}


def told(place: Path) -> str:
    return "\n".join(check.message for check in Study(place).computed.oddities if check.word == "warning")


@pytest.mark.parametrize("fitted", [LINE, CURVE])
def test_one_outside_of_its_ends_is_told(fitted: str, tmp_path: Path) -> None:
    own = folder(tmp_path, fitted.format(", low=0.01, high=500"), FALLING)
    assert "b: outside of what is said of b" in told(own)
    below = fitted.replace("start=0.2", "start=-0.2")
    folder(tmp_path, below.format(", low=-500, high=-0.01"), FALLING)
    assert "outside of what is said of b" not in told(own)


def test_a_root_says_itself_where_it_is_sought(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = "q = unknown(low=0); q = root(q**2, 2, 'q', low=1, high=2)"
    assert main(["check", str(folder(tmp_path, lines, RISING))]) == 2
    assert "q = unknown() is enough: root(...) says what q is" in capsys.readouterr().err
