"""The workbook of the contact models: what each says of the tests of a folder, beside what was measured.

All that is shown of a model is made of its declaration in derivations/contact/.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...derivations.contact.models import LEDGER, MODELS
from ...derivations.contact.prescribed import AUTHORS
from ...derivations.proved import enumerated
from ..messages.errors import sentence_case
from ..quantity import POISSON, Bounds
from ..workbook import FigureSpec, Parameter, SquareSum, TableSpec, Workbook
from . import soft_impact
from .contact_models_charts import DAMPED, LOOPS, columns, over_speed

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from sympy import Symbol

    from ...derivations.contact.model import ContactModel
    from ..sheet import Sheet

_POSITIVE = Bounds(low=0, low_open=True)
_TOLD = {"x_m": "approach", "F_m": "greatest force", "t": "duration", "e": "restitution", "x_p": "imprint"}
"""What models predict."""
_NUMBERS = ("no number", "one number", "two numbers", "three numbers")

PARAMETERS = (
    *(each for each in soft_impact.PARAMETERS if each.name != "points_per_pair"),
    Parameter("E_1", "Pa", "Young's modulus of the ball", _POSITIVE),
    Parameter("nu_1", "1", "Poisson's ratio of the ball", POISSON),
    Parameter("E_2", "Pa", "Young's modulus of the target", _POSITIVE),
    Parameter("nu_2", "1", "Poisson's ratio of the target", POISSON),
    Parameter(
        "target_diameter", "m", "diameter of the target, if it is a ball; left out, it is a plane", _POSITIVE
    ),
    Parameter(
        "sigma_Y", "Pa", "yield strength of the target; left out, nothing is told of first yield", _POSITIVE
    ),
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


def _sheet(given: frozenset[str]) -> Sheet:
    from .contact_models_sheet import sheet

    return sheet(given)


def _constants(sheet: Sheet) -> Mapping[Symbol, str]:
    from .contact_models_sheet import constants

    return constants(sheet)


# --- tables -------------------------------------------------------------------------------------------------


def _of_all(cells: str, predicted: str, varies: bool = False) -> tuple[str, ...]:
    """The cells of all models that predict something; `varies`: if that is not one number for all tests."""
    return tuple(
        cells.format(model.name)
        for model in MODELS
        if (model.varies(predicted) if varies else predicted in model.predicts)
    )


_CONSTANTS = tuple(model.constant for model in MODELS if model.constant)
_MEANS = tuple(constant.mean.sides[0].name for constant in _CONSTANTS)
_MISSED = "What the {} is too large by, each test predicted by the others"


def _numbers(model: ContactModel) -> str:
    """How many numbers it takes from the tests, in words."""
    return _NUMBERS[model.constants] if model.constants < len(_NUMBERS) else f"{model.constants} numbers"


def _tables() -> Iterator[TableSpec]:
    yield TableSpec(
        "misses",
        "What each model misses, root of the mean square over the tests that all of them predict",
        (*_of_all("rms_x_p_{}", "x_p"), *_of_all("rms_e_{}", "e")),
    )
    yield TableSpec("measured", "Impact parameters, as measured", ("v", "e", "x_p"))
    yield TableSpec(
        "given",
        "Ball, target and settings",
        (
            *(
                "ball_diameter",
                "ball_density",
                "ball_mass",
                "target_diameter",
                "target_mass",
                "m_red",
                "beta",
            ),
            *("E_1", "nu_1", "E_2", "nu_2", "sigma_Y", "E_star", "R_b", "K"),
        ),
    )
    yield TableSpec("yielding", "First yield", ("zeta_Y", "p_Y", "x_Y", "v_Y"))
    yield TableSpec("beyond", "Impact speeds beside that of first yield", ("v_over_Y",))
    yield TableSpec(
        "models",
        "What each model takes for true, and from the tests",
        (),
        words=(
            ("model", "takes for true", "from the tests", "source"),
            *((sentence_case(model.title), model.assumes, _taken(model), model.source) for model in MODELS),
        ),
    )
    yield TableSpec("taken", "What is taken from the tests", (*_MEANS, "V_y", "alpha_eiv", "C_eiv"))
    yield TableSpec(
        "constants",
        "Constants by each test alone, and by all others",
        tuple(
            each.sides[0].name if each.defines is None else each.defines.name
            for constant in _CONSTANTS
            for each in (constant.of_test[-1], constant.without)
        ),
    )
    yield TableSpec("restitutions", "Restitution by the models", ("e", *_of_all("e_{}", "e", varies=True)))
    yield TableSpec("restitutions_missed", _MISSED.format("restitution"), _of_all("miss_e_{}", "e"))
    yield TableSpec("imprints", "Imprint by the models", ("x_p", *_of_all("x_p_{}", "x_p", varies=True)))
    yield TableSpec("imprints_missed", _MISSED.format("imprint"), _of_all("miss_x_p_{}", "x_p"))
    yield TableSpec("approaches", "Maximum approach by the models", _of_all("x_m_{}", "x_m"))
    yield TableSpec("forces", "Greatest force by the models", _of_all("F_m_{}", "F_m"))
    yield TableSpec("durations", "Duration of the contact by the models", _of_all("t_{}", "t"))
    for name, title, told in (
        ("damping_numbers", "Damping numbers for the measured restitution", [each.c for each in AUTHORS]),
        ("damping_factors", "Logarithm of the damping’s factor at separation", [each.q for each in AUTHORS]),
        ("damping_returns", "Restitution that they return", [each.e for each in AUTHORS]),
        ("damping_approaches", "Maximum approach with them", [each.x_m for each in AUTHORS]),
        ("damping_forces", "Greatest force with them", [each.F_m for each in AUTHORS]),
        ("damping_durations", "Duration of the contact with them", [each.t for each in AUTHORS]),
    ):
        asked = ("e",) if name == "damping_returns" else ()
        yield TableSpec(name, title, (*asked, *(each.own.name for each in told if each)))
    yield TableSpec("exponents", "Exponents", ("e_slope", "alpha_by_e", "alpha_eiv", "meyer_n"))
    yield TableSpec(
        "checks",
        "What law (3) says besides",
        ("recovery_power", "a_crater", "recovery_asked", "pressure_power", "deceleration_power"),
    )
    yield TableSpec("lankarani", "Imprints beside Lankarani’s", ("x_p", "x_p_lankarani", "over_lankarani"))


def _taken(model: ContactModel) -> str:
    told = "; each restitution is told" if model.told else ""
    return f"{_numbers(model)}{told}"


# --- what the narrative says of each model ------------------------------------------------------------------


def _result(model: ContactModel) -> str:
    """What it takes from the tests, and how far it misses them: a sentence a line."""
    with_what = f"**{sentence_case(model.title)}**: with {_numbers(model)} from the tests"
    if model.constant:
        own = LEDGER.vocabulary[model.constant.mean.sides[0].name]
        with_what += f", the {own.meaning} {{sym}}`{own.name}` = {{cell}}`{own.name}`"
    with_what += " and each restitution" if model.told else ""
    missed = " and ".join(
        f"the {_TOLD[name]}s by {{cell}}`rms_{name}_{model.name}`, none by more than "
        f"{{cell}}`most_{name}_{model.name}`,"
        for name in ("x_p", "e")
        if name in model.predicts
    )
    over = f"over {{count}}`rms_x_p_{model.name} tests` of {{count}}`tests` tests"
    return f"{with_what} it misses {missed} {over}."


def _equations(model: ContactModel) -> str:
    """What it assumes, and the numbers of the equations by which it predicts."""
    of = {each.defines or each.sides[0]: each.label for each in model.cells}
    told = [f"{_TOLD[name]} {{eq}}`{of[symbol]}`" for name, symbol in model.predicts.items() if symbol in of]
    said = f"**{sentence_case(model.title)}**: {model.assumes}. Equations: {enumerated(told)}."
    if constant := model.constant:
        alone = enumerated([f"{{eq}}`{each.label}`" for each in constant.of_test])
        said += f" Its constant: of each test {alone}, of all {{eq}}`{constant.mean.label}`"
        said += f", of all others {{eq}}`{constant.without.label}`."
    for symbol in model.left_out.values():
        said += f" By all other tests: {{eq}}`{of[symbol]}`."
    return said


def _squares() -> Iterator[SquareSum]:
    """The sums of squares; of a model that says itself what is without a test, that of the fit."""
    for model in MODELS:
        name = "chi2_eiv" if model.left_out else f"chi2_{model.name}"
        each = sum(name in model.predicts for name in ("e", "x_p"))
        yield SquareSum(name, axis="tests", fitted=model.constants, each=each, asked=False)


_INCH, _GRAVITY = 0.0254, 9.80665
_QUOTED = {
    "first_yield": "The paper quotes first yield of a half-inch steel ball on steel at 3 in/s, "
    f"{3 * _INCH:.3f} m/s, which is a fall of {1e3 * (3 * _INCH) ** 2 / (2 * _GRAVITY):.1f} mm, and after a "
    f"fall of 1 mm, which is {(2e-3 * _GRAVITY) ** 0.5:.2f} m/s. The speed of first yield is as the power "
    f"5/2 of the yield strength: a target twice as strong takes one that is {2 ** (5 / 2):.1f} times as "
    "high.",
    "indentation": "Plastic indentations have from 2 to 2.5 by Tabor, and none more than 3.",
    "daily_life": "The paper quotes impacts of 10⁻⁴ s to 10⁻³ s, with 10³ to 10⁴ times the acceleration of "
    f"gravity, {_GRAVITY:.2f} m/s²: those of daily life. How long these tests are in contact, by each model, "
    "is in {table}`durations`.",
}
"""What sources say of impacts in general, by where the narrative says it."""


WORKBOOK = Workbook(
    name="contact_models",
    title="Contact models beside drop tests on a soft target",
    source="Hertz 1881, Lankarani and Nikravesh 1994, Johnson 1985, Thornton 1997, F C Ciornei and others",
    ledger=lambda: LEDGER,
    measured=soft_impact.MEASURED,
    parameters=PARAMETERS,
    check_parameters=_bodies_given,
    sheet=_sheet,
    squares=tuple(_squares()),
    headline=(
        *_of_all("rms_x_p_{}", "x_p", varies=True),
        *_of_all("rms_e_{}", "e", varies=True),
        *(*_MEANS, "alpha_eiv"),
    ),
    prose="contact_models",
    told={
        "results": "\n".join(map(_result, MODELS)),
        "equations": "\n\n".join(map(_equations, MODELS)),
        **_QUOTED,
    },
    tables=tuple(_tables()),
    figures=(
        FigureSpec(
            "imprints", "1", "Imprint over speed: as measured, and by each model.",
            chart=over_speed("x_p", "imprint over speed", "imprint depth"),
            alt="Marks of the tests, and a line for each model.",
        ),
        FigureSpec(
            "restitutions", "2", "Restitution over speed: as measured, and by the models that predict it.",
            chart=over_speed("e", "restitution over speed", "coefficient of restitution"),
            alt="Marks of the tests, and a line for each model that predicts the restitution.",
        ),
        FigureSpec(
            "loops", "3", "Force over approach by all models, a panel for each test.", chart=LOOPS,
            alt="Panels with the same axes: in each a loop for every model, up to its greatest force.",
        ),
        FigureSpec(
            "damped", "4", "Force over approach with the damping that a typed restitution gets, a panel for "
            "each test: of all authors, and the exact one, which returns what is typed in.",
            chart=DAMPED,
            alt="Panels with the same axes: in each a loop for every author's damping number, from no "
            "approach to none.",
        ),
    ),
    drawn=columns,
    models=MODELS,
    card_constants=_constants,
    example=soft_impact.WORKBOOK.example,
    example_parameters={
        "ball_diameter": "12.7 mm", "ball_density": "7800 kg/m^3", "beta": "1.5",
        "E_1": "210 GPa", "nu_1": "0.30", "E_2": "210 GPa", "nu_2": "0.30",
    },
)  # fmt: skip
