"""Fits of folders: what rows do not say, and how what a fit makes is shown."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers import method_folder
from test_fit import cells

from loopsheet.derivations.equation import Kind
from loopsheet.report.messages.errors import InputError
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.propagation import Spread

PLACES = (
    "from loopsheet import Method, fit, let, mean, measured, unknown\nclass Places(Method):\n    'Places.'\n"
)


LINE = "    a = unknown('a')\n    b = unknown('b')\n    f = fit(y, a + b * x)\n"
POWER = "    b = unknown('b', start=1.4)\n    f = fit(y, x**b)\n"


def in_folder(tmp_path: Path, body: str, rows: str) -> Any:
    """What is computed of a method of x and y."""
    head = PLACES + "    x = measured('1', 'x')\n    y = measured('1', 'y')\n"
    return Study(method_folder(tmp_path, head + body, f"reading,x [1],y [1]\n{rows}")).computed


def test_no_row_is_weighed_by_a_negative_uncertainty(tmp_path: Path) -> None:
    body = "    a = unknown('a')\n    b = unknown('b')\n    line = fit(y, a + b * x, u=0.05 * x)\n"
    report = in_folder(tmp_path, body, "1,-1,-1.1\n2,1,0.9\n3,2,2.1\n4,3,2.9\n5,4,4.1\n")
    first, second = (report.values.cell("line_w", (row,)) for row in (1, 2))
    assert (first.status.code, second.value) == ("#DOMAIN!", pytest.approx(400))
    assert "a standard uncertainty that rows are weighed by is above zero" in first.why


@pytest.mark.parametrize("start", ["0.9 * mean(y) / mean(x)", "max(y) / max(x)"])
def test_a_start_may_be_taken_over_rows(tmp_path: Path, start: str) -> None:
    """In the workbook, too, whose passes begin there."""
    from loopsheet.report import stages

    body = f"    b = unknown('b', start={start})\n    f = fit(y, x**b)\n"
    report = in_folder(tmp_path, body, "1,1,1.0\n2,2,2.8\n3,3,5.2\n4,4,8.1\n")
    assert cells(report.values, "b")[0] == pytest.approx(1.506, abs=2e-3)
    assert "b_start" in report.workbook.aside
    stages.book(report)


RATES = """from loopsheet import Method, fit, measured, unknown


class Rates(Method, rows="readings"):
    "L Michaelis, M L Menten, Die Kinetik der Invertinwirkung."
    S = measured("mmol/L", "concentration", positive=True)
    v = measured("umol/(L min)", "initial rate", positive=True)
    V_max = unknown("limiting rate", "umol/(L min)", start=2)
    K_M = unknown("Michaelis constant", "mmol/L", start=1)
    line = fit(v, V_max * S / (K_M + S))
"""
RATED = "0.10,0.45\n0.25,0.93\n0.50,\n1.00,2.25\n2.00,2.88\n4.00,3.35\n"


def test_a_claim_of_a_fit_is_called_no_definition(tmp_path: Path) -> None:
    report = in_folder(tmp_path, POWER, "1,1,1.0\n2,2,2.8\n3,3,5.2\n4,4,8.1\n")
    claims = [each for each in report.ledger.equations() if each.kind is Kind.CLAIM]
    assert "the derivative of the sum of squares" in {each.because for each in claims}
    assert not [each.number for each in claims if each.because.startswith("definition")]


def test_the_referee_steps_without_a_row_that_is_empty(tmp_path: Path) -> None:
    """A missing datum is none of the size of a SI unit, from which the steps would not settle."""
    published = "source,cell,index,value,unit\nbook,K_M,,0.809,mmol/L\n"
    method_folder(tmp_path, RATES, f"S [mmol/L],v [umol/(L min)]\n{RATED}", published=published)
    referee = Study(tmp_path).refereed.referee
    assert referee is not None
    assert [(found.verdict, found.low < found.high) for found in referee.values] == [("reachable", True)]


RECIPROCALS = """from loopsheet import Method, fit, let, measured, unknown


class Reciprocals(Method, rows="readings"):
    "H Lineweaver, D Burk, The determination of enzyme dissociation constants."
    S = measured("mmol/L", "concentration", positive=True)
    v = measured("umol/(L min)", "initial rate", positive=True)
    x = let(1 / S, "reciprocal concentration", "L/mmol")
    y = let(1 / v, "reciprocal rate", "L min/umol")
    a = unknown("intercept", "L min/umol")
    b = unknown("slope", "min mmol/umol")
    line = fit(y, a + b * x)
    again = let(line.fitted + line.residual, "reciprocal rate again", like=line.fitted)
    K_M = unknown("Michaelis constant", "mmol/L", start=1)
    V_max = unknown("limiting rate", "umol/(L min)", start=2)
    curve = fit(v, V_max * S / (K_M + S))
"""


def test_all_of_a_fit_is_shown_in_the_unit_of_what_it_belongs_to(tmp_path: Path) -> None:
    """What is shown like a computed column has that one's unit, in the report and in the cells of charts."""
    from loopsheet.report import stages

    method_folder(tmp_path, RECIPROCALS, f"S [mmol/L],v [nmol/(mL min)]\n{RATED}")
    report = Study(tmp_path).computed
    rate, reciprocal = "nmol/(mL min)", "L min/umol"
    units = {
        **dict.fromkeys(("line_fitted", "line_residual", "line_s", "again", "s_a"), reciprocal),
        **{"line_S": "(L min/umol)^2", "s_b": "min mmol/umol", "s_K_M": "mmol/L", "s_V_max": "umol/(L min)"},
        **dict.fromkeys(("curve_fitted", "curve_residual", "curve_s"), rate),
    }
    assert {name: report.shown[name].unit for name in units} == units
    grid, _ = stages.book(report)
    drawn = dict.fromkeys(("plotted_y", "line_curve_y", "plotted_line_residual"), reciprocal)
    assert {name: grid[name].unit for name in drawn} == drawn
    (*_, largest) = grid["line_curve_y"].values
    assert largest == pytest.approx(0.2543 + 0.1979 * (10 + 9.75 / 20), rel=1e-3)


@pytest.mark.parametrize(
    ("body", "rows", "ends", "number"),
    [
        (LINE, "-1,-1.1\n1,0.9\n3,3.2\n", (-1.05, 3.15), 2),
        (LINE, "1,1.1\n4,,\n2,1.9\n".replace(",,", ","), (0.95, 4.15), 2),
        (LINE, "-6,1.1\n-1,1.9\n-2,1.7\n", (-6.25, -0.95), 2),
        (POWER, "1,1.0\n2,2.8\n21,96.2\n", (0.95, 22), 65),
    ],
)
def test_a_curve_goes_through_the_rows_and_a_little_beyond(
    tmp_path: Path, body: str, rows: str, ends: tuple[float, float], number: int
) -> None:
    """But not beyond zero, where there may be a pole; between the rows it is no chord."""
    numbered = "".join(f"{n},{row}\n" for n, row in enumerate(rows.splitlines(), start=1))
    values = in_folder(tmp_path, body, numbered).plotted().values
    x, y = (values.value[f"f_curve_{each}"] for each in "xy")
    a, b = (values.scalar(each) if each in values.value else 0.0 for each in "ab")
    assert (x[0], x[-1], len(x)) == (pytest.approx(ends[0]), pytest.approx(ends[1]), number)
    np.testing.assert_allclose(np.diff(x), (x[-1] - x[0]) / (number - 1))
    np.testing.assert_allclose(y, a + b * x if body is LINE else x**b, rtol=1e-12)


@pytest.mark.parametrize(
    ("body", "latex"),
    [
        ("    a = unknown('a')\n    line = fit(y, a)\n", {"line_s": "s", "line_S": "S", "line_N1": "N_{1}"}),
        (
            "    S = let(2 * y, 'twice')\n    a = unknown('a')\n    line = fit(y, a)\n",
            {
                "S": "",
                "line_S": r"S_{\mathrm{line}}",
                "line_s": r"s_{\mathrm{line}}",
                "line_fitted": r"\hat{y}%s",
            },
        ),
        (
            "    a = unknown('a')\n    line = fit(y, a)\n    b = unknown('b')\n    c = unknown('c')\n"
            "    bent_line = fit(y, b + c * x, u=0.1 * x)\n",
            {
                "line_s": r"s_{\mathrm{line}}",
                "bent_line_s": r"s_{\mathrm{bent line}}",
                "bent_line_w": r"w_{\mathrm{bent line}%s}",
                "bent_line_r1_2": r"r_{12,\mathrm{bent line}}",
                "line_fitted": r"\hat{y}_{\mathrm{line}%s}",
                "bent_line_residual": r"\delta y_{\mathrm{bent line}%s}",
                "s_b": "s(b)",
            },
        ),
    ],
)
def test_two_fits_are_told_apart_by_their_symbols(tmp_path: Path, body: str, latex: dict[str, str]) -> None:
    """One alone is printed short, unless its letters mean something else, too."""
    sheet = in_folder(tmp_path, body, "1,1,1.0\n2,2,2.8\n3,3,5.2\n").sheet
    assert {name: sheet[name].latex for name in latex} == latex


def test_sums_of_a_fit_that_lack_rows_are_told_by_what_they_lead_to(tmp_path: Path) -> None:
    """Its sums have names that nobody gave them."""
    report = in_folder(tmp_path, LINE, "1,1,2.1\n2,2,3.9\n3,3,\n4,4,8.2\n5,5,9.9\n")
    assert set(report.values.counted) & report.workbook.aside
    (said,) = (check.message for check in report.oddities if check.name == "rows")
    told, _, over = said.partition(" are over ")
    assert over.startswith("4 of 5 ")
    assert {"a", "b", "f_s"} <= set(re.findall(r"\w+", told))
    assert not set(re.findall(r"\w+", told)) & report.workbook.aside


THERMISTOR = """from sympy import exp
from loopsheet import Method, fit, given, measured, unknown


class Thermistor(Method, rows="points", headline="R_25 B"):
    "A resistor that is measured at two temperatures."
    theta = measured("degC", "temperature of the bath")
    R = measured("kohm", "resistance", positive=True)
    T_25 = given("degC", "reference", default="25 degC", exact=True)
    R_25 = unknown("resistance there", "kohm", start=10)
    B = unknown("constant", "K", start=3500)
    line = fit(R, R_25 * exp(B * (1 / theta - 1 / T_25)), u="stated")
"""


@pytest.mark.parametrize(
    ("first", "second"),
    [((0.0, 32.63), (40.0, 5.326)), ((0.0, 32.63), (25.0, 10.003)), ((10, 19.91), (60, 2.488))],
)
def test_a_curve_through_all_points_is_as_sure_as_they_are(
    tmp_path: Path, first: tuple[float, float], second: tuple[float, float]
) -> None:
    """No step makes a sum of squares smaller that is rounding alone, and yet all of it is a step."""
    rows = "theta [degC],R [kohm]\n" + "".join(f"{theta:.2f},{R!r}\n" for theta, R in (first, second))
    method_folder(
        tmp_path, THERMISTOR, rows, '[uncertainty]\nR = "u = 0.1 % of reading"\ntheta = "U = 0.02 K, k = 2"\n'
    )
    study = Study(tmp_path)
    T_1, T_2 = (theta + 273.15 for theta, _ in (first, second))
    part = (1 / 298.15 - 1 / T_1) / (1 / T_2 - 1 / T_1)  # of the way from one to the other, in 1 / T
    B = np.log(first[1] / second[1]) / (1 / T_1 - 1 / T_2)
    value = 1e3 * first[1] ** (1 - part) * second[1] ** part
    slopes = np.array([(1 - part), part, (1 - part) * B / T_1**2, part * B / T_2**2])
    u = value * np.hypot.reduce(slopes * [1e-3, 1e-3, 0.01, 0.01])
    (found,) = cells(study.computed.values, "R_25")
    assert found == pytest.approx(value, rel=1e-12)
    assert Spread(study.computed.inputs, study.computed.values).budget("R_25", 0).u == pytest.approx(
        u, rel=1e-9
    )
    assert cells(study.computed.values, "line_part")[0] == 1


@pytest.mark.parametrize("rows", ["1,21.521,-0.171\n2,23.999,-0.165\n", "1,1000.13,3.1\n2,1000.97,-2.22\n"])
def test_a_line_through_two_points_leaves_nothing(tmp_path: Path, rows: str) -> None:
    """What is left of u where all ways cancel is rounding."""
    computed = in_folder(tmp_path, LINE, rows)
    spread = Spread(computed.inputs, computed.values)
    assert (spread.u("y") > 0).all()
    assert spread.u("b")[0] > 0
    assert (spread.u("f_residual") == 0).all()


@pytest.mark.parametrize("u", ["10", "0.1 * x / x", "0.1 * q", "{y: 0.002, x: 0.25}"])
def test_a_standard_uncertainty_is_in_the_unit_of_what_it_belongs_to(tmp_path: Path, u: str) -> None:
    """A plain number would be taken for metres, and the scatter for that of the rows."""
    body = "    q = measured('1', 'share')\n    x = measured('mm', 'reference')\n"
    body += "    y = measured('mm', 'reading')\n"
    body += f"    a = unknown('zero', 'mm')\n    b = unknown('slope')\n    line = fit(y, a + b * x, u={u})\n"
    rows = "x [mm],y [mm],q [1]\n0,0,1\n1,1.2,1\n2,1.9,1\n3,3.1,1\n"
    method_folder(tmp_path, PLACES + body, rows)
    with pytest.raises(InputError, match=r"line: u of y is not in its unit, mm, .* u_y = given") as refused:
        _ = Study(tmp_path).computed
    assert "workbook.py:9:5" in str(refused.value)
    method_folder(tmp_path, PLACES + body.replace(f"u={u}", "u=0.1 * q * x"), rows)
    assert np.isfinite(cells(Study(tmp_path).computed.values, "b")[0])
