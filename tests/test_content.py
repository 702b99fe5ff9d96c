"""What is made of a sheet is kept by all that it says: nothing that says something else finds it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sympy import Expr, Float, Function, Symbol, log, sqrt

from loopsheet.derivations.equation import Equation, Kind
from loopsheet.report.axis import Axis, PairAxis
from loopsheet.report.cells.layout import lay_out
from loopsheet.report.cells.values import Status
from loopsheet.report.column import Column, Formula, Given, Root
from loopsheet.report.content import Untold, content
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines import numpy_texts
from loopsheet.report.engines.numpy import Program
from loopsheet.report.judge import bounds
from loopsheet.report.judge.chain import SheetDerivatives
from loopsheet.report.machine.kept import SETTING
from loopsheet.report.plan import derivatives
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import Sheet

k, n, i, j, p, size = (Symbol(s, integer=True, positive=True) for s in ("k", "n", "i", "j", "p", "size"))
ROWS = Axis("rows", k, n)
x, u = Symbol("x", positive=True), Symbol("u", positive=True)


def formula(value: Expr, axis: Axis | None = None, **more: bool) -> Column:
    return Column("y", axis, Formula(Equation("(1)", (Symbol("y"), value), "", Kind.DEFINITION)), **more)  # type: ignore[arg-type]


def root(**more: object) -> Column:
    form = Equation("(2)", (u**3 + u - x, 0 * u), "", Kind.ASSUMPTION)
    given = {"value": u, "low": x * 0, "high": x + 1, "start": x / 2} | more
    return Column("r", None, Root(form, form, u, **given), positive=False)  # type: ignore[arg-type]


GIVEN = Column("x", None, Given("parameter", Bounds(low=0)))
SHEET = Sheet((GIVEN, formula(sqrt(x)), replace(formula(log(x)), name="z"), root()))


def test_columns_that_are_computed_otherwise_say_something_else() -> None:
    others = [
        GIVEN,
        replace(GIVEN, name="x_"),
        replace(GIVEN, axis=ROWS),
        replace(GIVEN, axis=PairAxis("rows", k, n, of=Axis("tests", p, size), first=i, second=j)),
        replace(GIVEN, positive=False),
        replace(GIVEN, rule=Given("parameter", Bounds(low=0, low_open=True))),
        formula(x + 1),
        formula(Symbol("x", real=True) + 1),
        formula(x + Float(1.0)),
        formula(x + Float("1.0", 50)),
        formula(x + 1, positive=False),
        replace(formula(x + 1), requires=((x > 1, "it is small"),)),
        root(),
        root(value=u + 1),
        root(steps=5),
        root(sign_low=-x),
        root(sign_high=-x),
        root(turning=(x,)),
        root(turning=(x,), turning_by=(Equation("(3)", (x, x), "", Kind.CLAIM),)),
    ]
    assert len({column.content for column in others}) == len(others)
    assert (
        GIVEN.content == replace(GIVEN, meaning="something", unit="m", rule=Given("", Bounds(low=0))).content
    )


class unheard(Function):
    """What it prints hangs on code that is not loopsheet's."""


def test_what_somebody_else_has_written_says_nothing() -> None:
    for foreign in (unheard(x), log(unheard(x)), Function("f")(x)):
        with pytest.raises(Untold):
            content(foreign)

    class Some(PairAxis):
        @property
        def chosen(self) -> object:  # type: ignore[override]
            return self.first + 1 < self.second

    with pytest.raises(Untold):
        content(Some("rows", k, n, of=Axis("tests", p, size), first=i, second=j))


def test_what_is_kept_computes_the_same_and_nothing_is_lowered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(SETTING, str(tmp_path / "kept"))
    layouts, data = lay_out(SHEET, {}, {}), {"x": np.linspace(0.1, 3.0, 7).reshape(-1, 1)}
    value = {"x": np.array([2.0]), "y": np.array([2.0**0.5]), "z": np.log([2.0]), "r": np.array([1.0])}

    def made() -> tuple[str, Any, object]:
        values = engine.evaluate(SHEET, {}, data)
        found = bounds.RoundingBounds(SHEET, layouts, value)
        told = [values.value["r"].tolist(), values.status["z"].tolist()]
        return Program.of(SHEET).source, told, {n: b.tolist() for n, b in found.items()}

    first = made()
    assert {code for row in first[1][1] for code in row} == {Status.OK, Status.DOMAIN}
    again = [SheetDerivatives.of(SHEET).nodes]

    def fail(*_: object) -> None:
        raise AssertionError

    with monkeypatch.context() as patch:
        patch.setattr(numpy_texts, "program_texts", fail)
        patch.setattr(derivatives, "derivatives", fail)
        assert made() == first
        again.append(SheetDerivatives.of(SHEET).nodes)
        with pytest.raises(AssertionError):
            Program.of(Sheet((GIVEN, formula(x + 2))))
    assert again[0] == again[1]
    monkeypatch.setenv(SETTING, "")
    assert made() == first


def test_a_program_of_a_function_of_ones_own_is_printed_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(SETTING, str(tmp_path / "kept"))
    found = []
    for text in ("numpy.sqrt", "numpy.abs"):

        class own(Function):
            def _numpycode(self, printer: object, text: str = text) -> str:
                return f"{text}({printer._print(self.args[0])})"  # type: ignore[attr-defined]

        found.append(text in Program.of(Sheet((GIVEN, formula(own(x))))).source)
    assert found == [True, True]
