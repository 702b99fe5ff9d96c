"""What damping numbers return of the measured restitutions: the cells beside simulated impacts."""

from __future__ import annotations

from pathlib import Path

import mpmath
import numpy as np
import pytest
from helpers import number_for

from loopsheet.derivations.contact import damping
from loopsheet.derivations.contact.prescribed import AUTHORS, Author
from loopsheet.report.cells.values import Values
from loopsheet.report.document.writing import placed_in
from loopsheet.report.impacts.damping import number_by
from loopsheet.report.impacts.law import ForceLaw
from loopsheet.report.impacts.simulation import simulate
from loopsheet.report.study import Study

SHIPPED = Path(__file__).parents[1] / "data" / "contact_models"


@pytest.fixture(scope="module")
def values() -> Values:
    return Study(SHIPPED).computed.values


def named(author: Author) -> str:
    return author.c.own.name.removeprefix("c_")


@pytest.mark.parametrize("author", AUTHORS, ids=named)
def test_cells_are_what_a_simulated_impact_shows(values: Values, author: Author) -> None:
    law = ForceLaw(author.title, damping.family.value)
    mass, stiffness = values.scalar("m_red"), values.scalar("K")
    back = author.e.own.name if author.e else "e"
    for row, speed in enumerate(values.value["v"].tolist()):
        own = {
            name: float(values.value[told][row])
            for name, told in (
                ("c", author.c.own.name),
                ("e", back),
                ("x_m", author.x_m.own.name),
                ("F_m", author.F_m.own.name),
                ("t", author.t.own.name),
            )
        }
        constants = {damping.K: stiffness, damping.n: 1.5, damping.c: own["c"]}
        found = simulate(law, constants, mass, speed)
        assert (found.e, found.x_m, found.F_m, found.duration) == pytest.approx(
            (own["e"], own["x_m"], own["F_m"], own["t"]), rel=1e-9
        ), row


def test_numbers_are_those_of_the_family(values: Values) -> None:
    """By another way to the same numbers, with 40 digits."""
    for author, name in zip(AUTHORS, [*damping.MEMBERS, None], strict=True):
        for e, c in zip(values.value["e"], values.value[author.c.own.name], strict=True):
            expected = number_by(name, float(e), 1.5) if name else number_for(float(e))
            assert c == pytest.approx(expected, rel=1e-13), author.title


def test_a_typed_restitution_returns_another(values: Values) -> None:
    """What three authors' numbers return of .453, to the digits that are known of it."""
    found = {name: round(float(values.value[f"e_{name}"][4]), 3) for name in ("HC", "LN", "F")}
    assert values.value["e"][4] == 0.453
    assert found == {"HC": 0.642, "LN": 0.713, "F": 0.420}


def test_the_mean_rate_of_a_linear_spring_is_a_beta_function() -> None:
    integral = mpmath.quad(lambda y: y**1.5 * mpmath.sqrt(1 - y**2), [0, 1])
    (flores,) = (author for author in AUTHORS if named(author) == "F")
    e = mpmath.mpf("0.5")
    expected = (1 - e) / (e * mpmath.mpf("2.5") * integral)
    assert float(flores.c.equation.value.subs(damping.e, 0.5)) == pytest.approx(float(expected), rel=1e-12)


def with_restitutions(folder: Path, *restitutions: str) -> Values:
    """The values of the shipped tests with other restitutions, the first of five for the first test."""
    rows = (SHIPPED / "measurements.csv").read_text(encoding="utf-8").splitlines()
    for row, e in enumerate(restitutions, 1):
        label, v, _, *others = rows[row].split(",")
        rows[row] = ",".join([label, v, e, *others])
    (folder / "measurements.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    (folder / "report.toml").write_text(
        (SHIPPED / "report.toml").read_text(encoding="utf-8"), encoding="utf-8"
    )
    return Study(folder).computed.values


EXTREMES = ("0.03", "0.01", "0.001", "0.97", "0.999")


def test_numbers_and_restitutions_far_from_the_usual(tmp_path: Path) -> None:
    """Where the factor that is left at separation is below 1e-300, and where nearly nothing is lost."""
    values = with_restitutions(tmp_path, *EXTREMES)
    with mpmath.workdps(40):
        for row, text in enumerate(EXTREMES):
            e = mpmath.mpf(text)
            number, start = values.value["c_D"][row].item(), 1.5 * (1 - e) if e > 0.5 else 1 / e
            exact = mpmath.findroot(lambda c, e=e: _sides(c, e), (start, 0.999 * start), solver="secant")
            assert number == pytest.approx(float(exact), rel=1e-11), text
            for author in AUTHORS[:-1]:
                c = mpmath.mpf(values.value[author.c.own.name][row].item())
                assert author.e is not None
                found = values.value[author.e.own.name][row].item()
                assert abs(_factor(c, found)) < 1e-12, (author.title, text)


def _sides(c: mpmath.mpf, e: mpmath.mpf) -> mpmath.mpf:
    """(L106) by exponentials, which have no pole where the factor ends."""
    return (1 - c * e) - (1 + c) * mpmath.exp(-c * (1 + e))


def _factor(c: mpmath.mpf, e: float) -> float:
    return float(_sides(c, mpmath.mpf(e)) / min(c, 1))


def test_where_nothing_comes_back(tmp_path: Path) -> None:
    """Three formulas would need an infinite number, as the exact one does; the others have one."""
    values = with_restitutions(tmp_path, "0")
    told = {named(author): values.cell(author.c.own.name, (1,)) for author in AUTHORS}
    assert {name for name, cell in told.items() if "would have to be infinite" in cell.reason} == {
        "G", "F", "HG", "D",
    }  # fmt: skip
    assert told["HC"].value == 1.5
    assert abs(_factor(mpmath.mpf(1.5), values.value["e_HC"][0].item())) < 1e-12


def test_without_loss_there_is_no_number(tmp_path: Path) -> None:
    """And of the exact one the factor 1, which is no damping, is no root."""
    again = with_restitutions(tmp_path, "1")
    for author in AUTHORS:
        assert "nothing is lost" in again.cell(author.c.own.name, (1,)).reason
        assert np.isfinite(again.value[author.F_m.own.name][1:]).all()


def test_the_sign_of_an_integral_is_no_factor() -> None:
    """What is integrated stands behind it without a dot, also with numbers put in."""
    sheet = Study(SHIPPED).computed.sheet
    latex = placed_in(sheet["t_HC"], sheet, {}).latex
    assert latex.partition(r"\int_")[2].partition("^")[2].startswith(r"{\ln(1 + \text{@2@})}\, (1 + ")
