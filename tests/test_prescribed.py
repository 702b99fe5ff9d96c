"""What damping numbers return of the measured restitutions: the cells beside simulated impacts."""

from __future__ import annotations

from pathlib import Path

import mpmath
import numpy as np
import pytest

from loopsheet.derivations.contact import damping
from loopsheet.derivations.contact.prescribed import AUTHORS, Author
from loopsheet.report.cells.values import Values
from loopsheet.report.impacts.damping import number_by, number_for
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
            )
        }
        constants = {damping.K: stiffness, damping.n: 1.5, damping.c: own["c"]}
        found = simulate(law, constants, mass, speed)
        assert (found.e, found.x_m, found.F_m) == pytest.approx(
            (own["e"], own["x_m"], own["F_m"]), rel=1e-9
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


def test_without_loss_there_is_no_number(tmp_path: Path) -> None:
    """And of the exact one the factor 1, which is no damping, is no root."""
    for name, old, new in (("report.toml", "", ""), ("measurements.csv", "2.334,0.530", "2.334,1")):
        text = (SHIPPED / name).read_text(encoding="utf-8")
        assert old in text
        (tmp_path / name).write_text(text.replace(old, new), encoding="utf-8")
    again = Study(tmp_path).computed.values
    for author in AUTHORS:
        assert "nothing is lost" in again.cell(author.c.own.name, (1,)).reason
        assert np.isfinite(again.value[author.F_m.own.name][1:]).all()
