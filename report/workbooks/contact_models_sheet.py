"""The sheet of the contact models: every model's equations, laid out over the tests."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from sympy import Expr, Rational, Symbol

from ...derivations.contact import checks, hertz, johnson
from ...derivations.contact.model import ContactModel
from ...derivations.contact.models import BESIDE, LEDGER, MODELS
from ...derivations.equation import Equation
from ...derivations.symbols import k
from ..charts import Drawn, drawn
from ..sheet import Column, Formula, Given, RepeatAxis, Root, Sheet
from . import soft_impact_fit
from .soft_impact_sheet import TESTS, beta, e, masses, v, x_p

__all__ = ["BODIES", "branches", "sheet"]

BODIES = ("E_1", "nu_1", "E_2", "nu_2", "sigma_Y")
"""What is given of both bodies besides their masses."""
_SHOWN = {"m": "like x_p", "Pa": "GPa", "s": "us"}
_MISS = "miss"
CALLED = {
    "alpha": "alpha_eiv", "C": "C_eiv", "x_obs": "x_p", "R": "R_eiv", "h": "leverage", "d": "ball_diameter",
    "u_v": "u_v", "u_e": "u_e", "u_x": "u_x_p",
}  # fmt: skip
"""What quantities of the derivations are called in the sheet, where their names differ."""


def sheet(given: frozenset[str]) -> Sheet:
    """The sheet for the parameters that were given.

    Parameters
    ----------
    given : frozenset of str
        Names of parameters: they decide between the mass and the density, a free and a fixed target.
    """
    laid = _Laid()
    fitted = soft_impact_fit.columns(TESTS, (v, e, x_p))
    told = {equation.label for equation in LEDGER.equations()}
    for column in (v, e, x_p, beta, *masses(given), *fitted):
        if column.equation is None or column.equation.label in told:
            laid.add(column)
    if "ball_diameter" not in laid.columns:
        laid.add(Column("ball_diameter", None, Given("parameter"), "m", "diameter of the ball", "d%s", "mm"))
    # The models speak of a test as it was measured, and of the curve of law (3) as the one that was fitted.
    for quantity, name in CALLED.items():
        laid.call(quantity, name)
    for name in BODIES:
        laid.give(name)
    for equation in (hertz.modulus, hertz.radius, hertz.stiffness, *johnson.FIRST_YIELD):
        laid.tell(equation)
    for model in MODELS:
        laid.tell_model(model)
    for equation in checks.CELLS:
        laid.tell(equation)
    return Sheet(tuple(laid.columns.values()))


class _Laid:
    """Columns so far, and which cell each symbol of the derivations stands for."""

    def __init__(self) -> None:
        self.columns: dict[str, Column] = {}
        self.where: dict[Expr, Expr] = {}

    def add(self, column: Column) -> None:
        """A column; a quantity of its name is meant by it."""
        self.columns[column.name] = column
        if column.name in LEDGER.vocabulary:
            self.call(column.name, column.name)

    def call(self, quantity: str, name: str) -> None:
        """What a quantity of the derivations is called here."""
        own, cell = LEDGER.vocabulary[quantity], self.columns[name].cell
        self.where |= {own.symbol: cell, own[k]: cell}

    def give(self, name: str) -> None:
        """What is given of a body."""
        own = LEDGER.vocabulary[name]
        shown = f"like {name}" if own.unit != "1" else ""
        self.add(Column(name, None, Given("parameter"), own.unit, own.meaning, own.latex, shown))

    def tell_model(self, model: ContactModel) -> None:
        """The cells of a model, those without a test, and what stands beside the measured ones."""
        beside = BESIDE[model.name]
        if constant := model.constant:
            for equation in (*constant.of_test, constant.mean, constant.without):
                self.tell(equation)
        for equation in model.cells:
            self.tell(equation, model.needs)
        for equation in model.hanging():
            self.tell(equation, model.needs, beside.without)
        for equation in beside.equations:
            self.tell(equation)

    def tell(
        self,
        equation: Equation,
        needs: Mapping[Any, Any] | None = None,
        without: Mapping[Symbol, Symbol] | None = None,
    ) -> None:
        """A column by the equation that defines it; one that has it on both sides is solved for it."""
        symbol = equation.sides[0] if equation.defines is None else equation.defines
        called = without or {}
        own, new = LEDGER.vocabulary[symbol.name], called.get(symbol, symbol)
        if new.name in self.columns:
            return
        where = self.where | {old: self.where[name] for old, name in called.items() if name in self.where}
        named = set[Any]().union(*(side.xreplace(where).free_symbols for side in equation.sides))
        axis = TESTS if k in named else None
        blank = Column(
            new.name, axis, Given(), own.unit, own.meaning, own.latex, positive=own.positive,
            display="%" if new.name.startswith(_MISS) else _SHOWN.get(own.unit, ""),
        )  # fmt: skip
        if equation.sides[0] == symbol and not equation.sides[-1].has(symbol):
            where |= {symbol: blank.cell}
            asked = [needs[symbol]] if needs and symbol in needs else []
            requires = tuple((condition.xreplace(where), says) for condition, says in asked)
            column = replace(blank, rule=Formula(equation.at(where)), requires=requires)
        else:
            low, high = map(Rational, map(str, own.span))
            said = equation.at({old: cell for old, cell in where.items() if old != symbol})
            rule = Root(said, said, symbol, symbol, low, high, (low + high) / 2, steps=8)
            column = replace(blank, rule=rule)
        self.columns[new.name] = column
        self.where |= {new: column.cell}
        if new == symbol:
            self.where |= {own[k]: column.cell}


def branches(sheet: Sheet, names: tuple[str, ...], points: int) -> Drawn:
    """The columns of charts: approach and force of both branches of each test, by some models.

    Parameters
    ----------
    sheet : Sheet
    names : tuple of str
        Of the models.
    points : int
        Of each branch.
    """
    row, step, size = (Symbol(name, integer=True, positive=True) for name in ("l", "m", "n_loops"))
    axis = RepeatAxis("loops", row, size, of=TESTS, step=step, count="loop_points")
    count = Column(axis.count, None, Given("chart"), meaning="points of each branch", exact=True)
    share, found = (step - 1) / (count.symbol - 1), [count]
    where: dict[Expr, Expr] = {
        LEDGER.vocabulary[c.name].symbol: c.cell for c in sheet.columns if c.name in LEDGER.vocabulary
    } | {LEDGER.vocabulary[q].symbol: sheet[name].cell for q, name in CALLED.items()}
    for model in (model for model in MODELS if model.name in names):
        x_m = where[model.predicts.get("x_m", hertz.x_m)]
        x_p = where[model.predicts["x_p"]]
        closed = ((x_m > x_p, "a loop is drawn where the imprint is shallower than the approach"),)
        ways = {
            "loading": (x_m * share, model.loading),
            "unloading": (x_p + (x_m - x_p) * share, model.unloading),
        }
        for way, (at, law) in ways.items():
            meaning = f"while {way}, {model.title}"
            x = drawn(
                f"{way}_x_{model.name}",
                axis,
                at,
                "m",
                f"approach {meaning}",
                display="like x_p",
                requires=closed,
            )
            force = law.xreplace(where | {hertz.x: x[row]})
            found += [
                x,
                drawn(f"{way}_F_{model.name}", axis, force, "N", f"force {meaning}", requires=closed),
            ]
    return Drawn(tuple(found), {axis.count: points})
