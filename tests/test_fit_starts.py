"""Where fits begin: certified values through sheets from far starts, and what stays as its author has it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import test_fit
from helpers import method_folder
from nist_strd import Strd, digits
from sympy import Rational
from test_fit import NONLINEAR, Array, cells
from test_live_second_order import SCRIPTS
from test_live_uncertain import of_page

from loopsheet.report.cli import main
from loopsheet.report.engines import ENGINES, exact
from loopsheet.report.engines.excel_loops import PASSES
from loopsheet.report.engines.fit_starts import begun
from loopsheet.report.engines.numpy import evaluate
from loopsheet.report.result.result import Report
from loopsheet.report.sheet import Sheet
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.monte_carlo import draw
from loopsheet.report.uncertainty.propagation import Spread


def sheet_of(strd: Strd, start: Array) -> tuple[Sheet, Sheet, dict[str, Any], dict[str, Any]]:
    """The sheet of a set as its author wrote it, that of a study, and what both are asked of."""
    book = test_fit.method_of(strd, start).workbook
    labels = {"readings": range(1, len(strd.y) + 1)}
    data = {**{str(name): column for name, column in strd.of.items()}, "y": strd.y}
    sheet = book.sheet(frozenset())
    return sheet, begun(sheet, book.curves, labels, data), labels, data


@pytest.mark.parametrize("start", [0, 1])
@pytest.mark.parametrize("name", NONLINEAR)
def test_certified_values_come_out_of_workbooks_from_both_starts(name: str, start: int) -> None:
    strd = NONLINEAR[name]
    written, sheet, labels, data = sheet_of(strd, strd.starts[start])
    values = evaluate(sheet, labels, data)
    assert digits(cells(values, *strd.parameters), strd.certified) > 10
    scatter = cells(values, *(f"s_{each}" for each in strd.parameters))
    # The data of Lanczos1 lie on the curve to the rounding of doubles: the scatter is of that.
    assert digits(scatter, strd.deviations) > (2 if name == "Lanczos1" else 10)
    before = evaluate(written, labels, data)
    settled = before.passes["b1"] <= PASSES and np.isfinite(before.scalar("b1"))
    assert (sheet is written) == settled
    assert values.passes["b1"] <= 1.2 * PASSES, "a workbook asks for fewer digits than doubles"


def test_fifty_digits_begin_where_doubles_end() -> None:
    strd = NONLINEAR["MGH10"]
    written, sheet, labels, data = sheet_of(strd, strd.starts[0])
    found = [exact.evaluate(each, labels, data).rounded(each) for each in (written, sheet)]
    assert np.isnan(found[0].scalar("b1"))
    assert digits(cells(found[1], *strd.parameters), strd.certified) > 10.9


GROWTH = """from sympy import exp
from loopsheet import Method, fit, let, measured, unknown


class Growth(Method):
    t = measured("s", "time")
    y = measured("mV", "voltage")
    A = unknown("end", "mV", start={A})
    r = unknown("rate", "1/min", start={r}, positive=True)
    f = fit(y, A * (1 - exp(-r * t)), u={u})
"""
OWN = """    B = unknown("other end", "mV", start={A})
    q = unknown("other rate", "1/min", start={r}, positive=True)
    z = let(y + A, "raised")
    g = fit(z, A + B * (1 - exp(-q * t)))
"""
ROWS = (
    "1,0.5,0.92(3)\n2,1.0,1.79(4)\n3,2.0,,\n4,3.0,3.71(3)\n5,5.0,4.79(4)\n6,8.0,5.61(4)\n7,13,5.97(2)\n"
    "8,20,5.99(3)\n"
).replace(",,", ",")


def growth(folder: Path, A: float, r: float, u: str = "'stated'", more: str = "") -> Study:
    t = '[uncertainty]\nt = "u = 0.05"\n' if "t:" in u else '[uncertainty]\nt = "exact"\n'
    method_folder(folder, (GROWTH + more).format(A=A, r=r, u=u), f"reading,t [s],y [mV]\n{ROWS}", t)
    return Study(folder)


NEAR, FAR = (6, 20), (400, 3000)


@pytest.mark.parametrize("u", ["None", "'stated'", "{y: 'stated', t: 'stated'}", "0.01 * y"])
def test_from_afar_a_fit_finds_what_it_finds_from_nearby(u: str, tmp_path: Path) -> None:
    """Weighed or not, with errors in both variables, with a row without its reading."""
    found = [growth(tmp_path, *start, u).computed for start in (NEAR, FAR)]
    for name in ("A", "r", "s_A", "s_r", "f_S"):
        near, far = (report.values.scalar(name) for report in found)
        assert far == pytest.approx(near, rel=1e-9), name
    near, far = (report.workbook.sheet(report.inputs.given)["A"].rule.start for report in found)
    assert (found[0].sheet["A"].rule.start, near) == (near, Rational(6, 1000))
    assert (found[1].sheet["A"].rule.start != far, far) == (True, Rational(400, 1000))


def test_all_engines_begin_there_and_why_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = growth(tmp_path, *FAR)
    assert [(engine.engine, engine.findings) for engine in study.engines] == [
        (engine, ()) for engine in ENGINES
    ]
    assert "begun     at 19." not in study.program
    assert main(["why", "r", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert "  begun     at 19." in told
    assert "            from 3000 1/min, as is stated, its passes lead nowhere, or there too slowly\n" in told


def test_draws_begin_there(tmp_path: Path) -> None:
    report = growth(tmp_path, *FAR).computed
    budget = Spread(report.inputs, report.values).budget("r", 0)
    drawn = draw(report.inputs, report.values, budget, 2000)
    assert drawn.lost == 0
    assert drawn.u == pytest.approx(budget.u, rel=0.1)


def test_a_fit_that_rests_on_another_begins_after_it(tmp_path: Path) -> None:
    values = growth(tmp_path, *FAR, "None", OWN).computed.values
    assert cells(values, "B", "q") == pytest.approx(cells(values, "A", "r"), rel=1e-9)


def test_where_nothing_is_least_there_is_no_number(tmp_path: Path) -> None:
    """What grows on and on has no end."""
    method_folder(
        tmp_path,
        GROWTH.format(A=-400, r=0.2, u=None),
        "reading,t [s],y [mV]\n1,1,-1\n2,2,-3\n3,3,-9\n4,4,-27\n",
    )
    study = Study(tmp_path)
    assert study.prepared.sheet is not None
    cell = study.computed.values.cell("A")
    assert cell.value is None
    assert "begin nearer" in cell.reason
    assert study.prepared.sheet["A"].rule.start == study.inputs.workbook.sheet(frozenset())["A"].rule.start


# D G Watts' data of an enzyme: N R Draper and H Smith, Applied Regression Analysis; in R as "Puromycin".
ENZYME = """from loopsheet import Method, fit, measured, unknown


class Kinetics(Method, headline="K_M"):
    S = measured("mmol/L", "substrate", positive=True)
    v = measured("umol/(L*min)", "rate")
    V = unknown("limiting rate", "umol/(L*min)", start={V}, positive=True)
    K_M = unknown("Michaelis constant", "mmol/L", start={K_M}, positive=True)
    curve = fit(v, V * S / (K_M + S))
"""
RATES = """S [mmol/L],v [umol/(L*min)]
0.02,76
0.02,47
0.06,97
0.06,107
0.11,123
0.11,139
0.22,159
0.22,152
0.56,191
0.56,201
1.10,207
1.10,200
"""
STATED = '[uncertainty]\nS = "exact"\nv = "u = 11"\n'


def from_near_and_far(place: Path) -> Iterator[Report]:
    for name, start in {"near": (210, 0.06), "far": (100, 1)}.items():
        folder = place / name
        folder.mkdir()
        method_folder(folder, ENZYME.format(V=start[0], K_M=start[1]), RATES, STATED)
        yield Study(folder).computed


def test_draws_begin_at_the_estimate_and_not_where_their_author_did(tmp_path: Path) -> None:
    """From far away some of them would not settle, and those are not like the others."""
    drawn = []
    for report in from_near_and_far(tmp_path):
        budget = Spread(report.inputs, report.values).budget("K_M", 0)
        drawn.append(draw(report.inputs, report.values, budget, 20_000))
    near, far = drawn
    assert near.lost == far.lost == 0
    assert (far.u, *far.symmetric) == pytest.approx((near.u, *near.symmetric), rel=1e-9)


DRAWN = """
const tables = Object.fromEntries(Object.entries(LIVE.tables).map(([axis, { rows }]) => [axis, rows]));
const state = { tables, parameters: LIVE.parameters };
const trace = new Trace(PROGRAM, LIVE.columns, computeSheet(PROGRAM, LIVE.columns, state));
const look = new Look(trace, state, null), { errors, pairs } = look.sure, { labels, data } = trace.sheet;
const names = [["K_M", ...trace.ancestors("K_M")]];
const [found] = drawn({ count: 2000, labels, data, errors, pairs, cells: [["K_M", 0]], names });
console.log(JSON.stringify([...found]));
"""


def test_so_do_the_draws_of_a_page(tmp_path: Path, require: Callable[..., str]) -> None:
    near, far = (
        of_page(require("node"), report, {"self": {"document": 1}}, SCRIPTS, DRAWN)
        for report in from_near_and_far(tmp_path)
    )
    assert len(near) == len(far) == 2000
    assert far == pytest.approx(near, rel=1e-9)
