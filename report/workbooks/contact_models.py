"""The workbook of the contact models: what each says of the tests of a folder, beside what was measured."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..quantity import Bounds
from ..workbook import FigureSpec, Parameter, TableSpec, Workbook, sentence_case
from . import soft_impact
from .contact_models_charts import IMPRINTS, LOOPS, RESTITUTIONS, columns

if TYPE_CHECKING:
    from ...derivations.equation import Ledger
    from ..sheet import Sheet

__all__ = ["WORKBOOK"]

_POSITIVE = Bounds(low=0, low_open=True)
_POISSON = Bounds(low=0, high=0.5)

PARAMETERS = (
    *(each for each in soft_impact.PARAMETERS if each.name != "points_per_pair"),
    Parameter("E_1", "Pa", "Young's modulus of the ball", _POSITIVE),
    Parameter("nu_1", "1", "Poisson's ratio of the ball", _POISSON),
    Parameter("E_2", "Pa", "Young's modulus of the target", _POSITIVE),
    Parameter("nu_2", "1", "Poisson's ratio of the target", _POISSON),
    Parameter("sigma_Y", "Pa", "yield strength of the target", _POSITIVE),
)


def _bodies_given(given: frozenset[str]) -> str | None:
    """Say what is missing or too much among the ball's parameters."""
    if "ball_diameter" not in given:
        return "the diameter of the ball is missing: every model but law (3) needs its radius"
    if {"ball_density", "ball_mass"} <= given:
        return "ball_mass and ball_density say the same thing twice; keep one"
    if not {"ball_density", "ball_mass"} & given:
        return "the mass of the ball is missing: give ball_mass or ball_density"
    return None


def _ledger() -> Ledger:
    from ...derivations.contact.models import LEDGER

    return LEDGER


def _sheet(given: frozenset[str]) -> Sheet:
    from .contact_models_sheet import sheet

    return sheet(given)


_BY_ALL = ("power", "johnson", "thornton", "lankarani", "hertz")
_TABLES = {
    "misses": ("What each model misses, root of the mean square over all tests", "miss_{}", _BY_ALL),
    "restitutions": ("Restitution by the models that predict it", "e_{}", ("johnson", "thornton")),
    "restitutions_missed": (
        "What the restitution is too large by, each test predicted by the others",
        "miss_e_{}",
        ("johnson", "thornton"),
    ),
    "imprints": ("Imprint by the models", "x_p_{}", ("power", "johnson", "thornton", "lankarani")),
    "imprints_missed": (
        "What the imprint is too large by, each test predicted by the others", "miss_x_p_{}", _BY_ALL,
    ),
    "squares": (
        "Sums of squares over the variances", "chi2_{}", ("eiv", "johnson", "thornton", "lankarani", "hertz"),
    ),
    "approaches": ("Maximum approach by the models", "x_m_{}", ("power", "johnson", "thornton", "hertz")),
    "forces": ("Greatest force by the models", "F_m_{}", ("power", "johnson", "thornton", "hertz")),
    "durations": ("Duration of the contact by the models", "t_{}", ("power", "johnson", "hertz")),
}  # fmt: skip
"""Tables by the models: title, what their cells are called, and whose."""


def _tables(*names: str) -> tuple[TableSpec, ...]:
    found = []
    for name in names:
        title, cells, models = _TABLES[name]
        measured = {"restitutions": ("e",), "imprints": ("x_p",)}.get(name, ())
        found.append(TableSpec(name, title, (*measured, *map(cells.format, models))))
    return tuple(found)


WORKBOOK = Workbook(
    name="contact_models",
    title="Contact models beside drop tests on a soft target",
    source="Hertz 1881, Lankarani and Nikravesh 1994, Johnson 1985, Thornton 1997, F C Ciornei and others",
    ledger=_ledger,
    measured=soft_impact.MEASURED,
    parameters=PARAMETERS,
    check_parameters=_bodies_given,
    sheet=_sheet,
    headline=("miss_power", "miss_johnson", "miss_thornton", "miss_lankarani", "p_d", "p_y", "alpha_eiv"),
    prose="contact_models",
    tables=(
        *_tables("misses"),
        TableSpec("measured", "Impact parameters, as measured", ("v", "e", "x_p")),
        TableSpec(
            "given",
            "Ball, target and settings",
            (
                *("ball_diameter", "ball_density", "ball_mass", "target_mass", "m_red", "beta"),
                *("E_1", "nu_1", "E_2", "nu_2", "sigma_Y", "E_star", "R_b", "K"),
            ),
        ),
        TableSpec("yielding", "First yield", ("zeta_Y", "p_Y", "x_Y", "v_Y")),
        TableSpec("taken", "What is taken from the tests", ("p_d", "p_y", "V_y", "alpha_eiv", "C_eiv")),
        TableSpec(
            "constants",
            "Constants by each test alone, and by all others",
            ("p_d_alone", "p_d_without", "p_y_alone", "p_y_without"),
        ),
        *_tables("restitutions", "restitutions_missed", "imprints", "imprints_missed", "squares"),
        *_tables("approaches", "forces", "durations"),
        TableSpec(
            "checks",
            "What law (3) says besides",
            ("recovery_power", "a_crater", "recovery_asked", "pressure_power", "deceleration_power"),
        ),
        TableSpec("exponents", "Exponents", ("e_slope", "alpha_by_e", "alpha_eiv", "meyer_n")),
        TableSpec("lankarani", "Imprints beside Lankarani’s", ("x_p", "x_p_lankarani", "over_lankarani")),
    ),
    figures=(
        FigureSpec(
            "imprints", "1", "Imprint over speed: as measured, and by each model.", chart=IMPRINTS,
            alt="Five marks rise with the speed; one line runs through them, three others beside them.",
        ),
        FigureSpec(
            "restitutions", "2", "Restitution over speed: as measured, and by the models that predict it.",
            chart=RESTITUTIONS, alt="Five marks fall with the speed, two lines fall less steeply.",
        ),
        *(
            FigureSpec(
                f"loops_{name}", str(number), f"{sentence_case(chart.title)}, one a test.", chart=chart,
                alt="Force over approach: loops that rise, and fall to an imprint.",
            )
            for number, (name, chart) in enumerate(LOOPS.items(), 3)
        ),
    ),
    drawn=columns,
)  # fmt: skip

sheet = WORKBOOK.sheet
"""The sheet for the names of the parameters that were given; what is given has its bounds."""
