"""The paper's campaign: Table 1 as printed, recomputed to the digits that follow from it."""

from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from judged_values import compare
from mpmath import mpf
from scipy.optimize import least_squares

from loopsheet.report.cells.values import Status, Values
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study

PAIRS = [(i, j) for i in range(1, 6) for j in range(i + 1, 6)]
ALPHA = [1.2580, 1.2767, 1.2817, 1.2937, 1.2898, 1.2945, 1.3092, 1.3104, 1.3413, 1.3710]
TABLE_2 = [1.234, 1.275, 1.286, 1.299, 1.303, 1.315, 1.327, 1.355, 1.367, 1.379]
TABLE_3 = {
    "x_m": [34.08, 41.61, 55.34, 60.16, 65.77],
    "Cprime_eq7": [1516, 2009, 2935, 3257, 3622],
    "Cprime_eq9": [1547, 2010, 2924, 3263, 3668],
}
FROM_TABLE_1 = {
    "x_m": [34.00, 41.54, 55.33, 60.18, 65.81],
    "Cprime_eq7": [1525, 2001, 2922, 3256, 3619],
    "Cprime_eq9": [1543, 2004, 2910, 3246, 3648],
}


@pytest.fixture(scope="module")
def values(report: Report) -> Values:
    return report.values


@pytest.fixture(scope="module")
def judged() -> exact.ExactValues:
    prepared = Study(PAPER).prepared
    return exact.evaluate(prepared.sheet, prepared.labels, prepared.exact_data)


def test_the_ten_exponents(values: Values) -> None:
    cells = list(values.cells("alpha"))
    assert [cell.label for cell in cells] == PAIRS
    assert [cell.status for cell in cells] == [Status.OK] * 10
    assert [f"{cell.value:.4f}" for cell in cells] == [f"{alpha:.4f}" for alpha in ALPHA]


def test_the_exponents_are_within_2e_14_of_50_digits(values: Values, judged: exact.ExactValues) -> None:
    for value, true in zip(values.value["alpha"].tolist(), judged.value["alpha"], strict=True):
        assert abs(mpf(value) / true - 1) < 2e-14


def test_the_exponents_satisfy_eq_11_as_printed(judged: exact.ExactValues) -> None:
    def eq11(alpha: Any, v: Any, e: Any, xp: Any) -> Any:
        share = (alpha + 1) / (1 + mpf(3) / 2)
        return share + xp[0] / xp[1] * (e[1] ** 2 - share) * (v[1] / v[0]) ** (2 / (alpha + 1)) - e[0] ** 2

    table_1 = {
        "v": ("2.334", "2.940", "4.089", "4.504", "4.993"),
        "e": ("0.530", "0.512", "0.479", "0.467", "0.453"),
        "xp": ("23.5", "29.7", "41.6", "45.97", "51.03"),
    }
    with mpmath.workdps(60):
        for (i, j), alpha in zip(PAIRS, judged.value["alpha"], strict=True):
            pair = {name: (mpf(column[i - 1]), mpf(column[j - 1])) for name, column in table_1.items()}
            assert abs(eq11(alpha, **pair)) < mpf(10) ** -50


def test_the_averages(values: Values) -> None:
    assert f"{values.scalar('alpha_mean'):.5f}" == "1.30264"
    assert f"{values.scalar('alpha_log'):.4f}" == "1.3023"
    assert f"{np.log(values.scalar('C_log')):.3f}" == "20.742"
    assert f"{values.scalar('alpha_lin'):.4f}" == "1.3213"


def test_the_exponents_climb_with_the_speed(values: Values) -> None:
    v, alpha = values.value["v"], values.value["alpha"]
    speed = [(v[i - 1] + v[j - 1]) / 2 for i, j in PAIRS]
    ordered = alpha[np.argsort(speed)]
    assert (np.diff(ordered) > 0).all()


def test_the_mass_of_the_ball(values: Values) -> None:
    assert f"{values.scalar('m_red') * 1e3:.3f}" == "8.366"


@pytest.mark.parametrize("name", TABLE_3)
def test_the_cells_of_table_3(values: Values, name: str) -> None:
    scale, digits = (1e6, 2) if name == "x_m" else (1, 0)
    shown = [f"{value * scale:.{digits}f}" for value in values.value[name]]
    assert shown == [f"{value:.{digits}f}" for value in FROM_TABLE_1[name]]
    # Near the printed ones, and not the same: Table 3 follows from the fit to Table 2.
    ratio = values.value[name] * scale / np.array(TABLE_3[name])
    assert abs(ratio - 1).max() < 0.007
    assert shown != [f"{value:.{digits}f}" for value in TABLE_3[name]]


def test_rows_eq_7_and_eq_9_differ_by_up_to_two_per_cent() -> None:
    ratio = np.array(TABLE_3["Cprime_eq7"]) / np.array(TABLE_3["Cprime_eq9"])
    assert f"{100 * abs(ratio - 1).max():.1f}" == "2.0"


def test_the_papers_fit_is_the_log_log_one() -> None:
    """With inputs that give Table 2 as printed, the log-log fit gives the printed 1.313 and no other does.

    Table 1 cannot give Table 2 (see the known differences in published.csv). With x_p of test 2 free it
    can: the inputs nearest to the printed ones, counted in half units of their last digits, are sought.
    """
    prepared = Study(PAPER).prepared
    program = engine.Program.of(prepared.sheet)
    printed = np.concatenate([np.array(prepared.data[name]) for name in ("v", "e", "x_p")])
    half = np.array([5e-4] * 10 + [5e-8, 5e-8, 5e-8, 5e-9, 5e-9])
    free = np.arange(15) == 11

    def at(moved: Any) -> Values:
        v, e, x_p = np.split(printed + half * moved, 3)
        data = {**prepared.data, "v": v, "e": e, "x_p": x_p}
        return engine.evaluate(prepared.sheet, prepared.labels, data, program)

    def residuals(moved: Any) -> Any:
        return np.concatenate([3 * (at(moved).value["alpha"] - TABLE_2) / 5e-4, moved * ~free])

    found = least_squares(residuals, 2.0 * free).x
    values = at(found)
    assert [f"{alpha:.3f}" for alpha in values.value["alpha"]] == [f"{alpha:.3f}" for alpha in TABLE_2]
    assert 29.75 < (printed[11] + half[11] * found[11]) * 1e6 < 29.85
    assert f"{values.scalar('alpha_mean'):.3f}" == "1.314"
    assert abs(values.scalar("alpha_log") - 1.3135) < 5e-4
    assert f"{values.scalar('alpha_lin'):.3f}" == "1.340"
    assert abs(values.value["x_m"] * 1e6 / TABLE_3["x_m"] - 1).max() < 1e-3


def test_both_engines_agree_on_every_cell_of_the_paper(values: Values) -> None:
    prepared = Study(PAPER).prepared
    agreement = compare(values, prepared.labels, prepared.exact_data)
    assert agreement.findings == ()
    assert agreement.cells == 2228
    assert agreement.worst < 2e-13


def write(folder: Path, measurements: str, parameters: str) -> Path:
    folder.mkdir()
    (folder / "measurements.csv").write_text(measurements, encoding="utf-8")
    (folder / "report.toml").write_text(
        f'title = "T"\nworkbook = "soft_impact"\n[parameters]\n{parameters}\n'
        '[measurements]\nfile = "measurements.csv"\n',
        encoding="utf-8",
    )
    return folder


def test_other_units_and_the_mass_for_the_diameter_change_nothing(tmp_path: Path, values: Values) -> None:
    folder = write(
        tmp_path / "cgs",
        "test,v [cm/s],e [%],x_p [mm]\n1,233.4,53.0,0.0235\n2,294.0,51.2,0.0297\n3,408.9,47.9,0.0416\n"
        "4,450.4,46.7,0.04597\n5,499.3,45.3,0.05103\n",
        f'ball_mass = "{values.scalar("ball_mass") * 1e3:.15g} g"',
    )
    again = Study(folder).computed.values
    for name in ("alpha", "alpha_mean", "alpha_log", "C_log", "x_m", "Cprime_eq7", "Cprime_eq9"):
        np.testing.assert_allclose(again.value[name], values.value[name], rtol=1e-13)


def test_a_finite_target_changes_the_forces_and_no_exponent(tmp_path: Path, values: Values) -> None:
    measurements = (PAPER / "measurements.csv").read_text(encoding="utf-8")
    parameters = 'ball_diameter = "12.7 mm"\nball_density = "7800 kg/m^3"\ntarget_mass = "2 kg"'
    again = Study(write(tmp_path / "light", measurements, parameters)).computed.values
    np.testing.assert_array_equal(again.value["alpha"], values.value["alpha"])
    assert again.scalar("m_red") == pytest.approx(
        values.scalar("m_red") / (1 + values.scalar("ball_mass") / 2)
    )
    assert again.scalar("C_log") == pytest.approx(
        values.scalar("C_log") * again.scalar("m_red") / values.scalar("m_red"), rel=1e-12
    )
