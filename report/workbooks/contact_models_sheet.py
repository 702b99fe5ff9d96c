"""The sheet of the contact models: every model's equations, laid out over the tests."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from sympy import Expr, Indexed, Integer, Rational, Rel, Symbol

from ...derivations.contact import checks, hertz, johnson, prescribed
from ...derivations.contact.model import ContactModel
from ...derivations.contact.models import BESIDE, LEDGER, MODELS
from ...derivations.equation import Equation
from ...derivations.global_fit import n_tests
from ...derivations.symbols import k
from ..charts import Drawn, drawn
from ..named import name_of
from ..sheet import Column, Formula, Given, Limit, RepeatAxis, Root, Sheet
from . import soft_impact

_BODIES = ("E_1", "nu_1", "E_2", "nu_2")
"""What is given of both bodies besides their masses."""
_BALL = "target_diameter"
"""Of a target that is no plane."""
_YIELD = "sigma_Y"
"""Only first yield asks for it."""
_SHOWN = {"m": "like x_p", "Pa": "GPa", "s": "us"}
_PERCENT = ("miss_", "rms_", "most_")
_AVERAGES = ("rms_", "chi2_", "most_")
"""What compares models, which is to be over the same tests of all."""
_OTHERS = (n_tests > 1, "needs two tests: there are no others")
_CALLED = {
    "alpha": "alpha_eiv", "C": "C_eiv", "x_obs": "x_p", "R": "R_eiv", "h": "leverage", "d": "ball_diameter",
    "u_v": "u_v", "u_e": "u_e", "u_x": "u_x_p", "m_1": "ball_mass",
}  # fmt: skip
"""What quantities of the derivations are called in the sheet, where their names differ."""
_ALONE = frozenset({"ball_mass"})
"""What is given, to the soft-impact sheet, for its columns that are the same whatever is."""
_TESTS = soft_impact.sheet(_ALONE).axes[0]


def sheet(given: frozenset[str]) -> Sheet:
    """The sheet for the parameters that were given.

    `given`: names of parameters: they decide between the mass and the density, a free and a fixed target, and
    whether first yield is told.
    """
    laid = _Laid()
    names = [column.name for column in soft_impact.sheet(_ALONE).columns]
    fitted = _of_tests(_ALONE, *names[names.index("u_v") :])
    told = {equation.label for equation in LEDGER.equations()}
    typed = soft_impact.sheet(_ALONE | {"ball_diameter"})
    given_there = (typed[name] for name in ("v", "e", "x_p", "beta"))  # with what no drop test has
    for column in (*given_there, *_masses(given), *fitted):
        if column.equation is None or column.equation.label in told:
            laid.add(column)
    if "ball_diameter" not in laid.columns:
        laid.add(Column("ball_diameter", None, Given("parameter"), "m", "diameter of the ball", "d%s", "mm"))
    laid.call_all()
    for name in _BODIES:
        laid.give(name)
    if _BALL in given:
        laid.give(_BALL)
    radius = hertz.radius_of_two if _BALL in given else hertz.radius
    for equation in (hertz.modulus, radius, hertz.stiffness):
        laid.tell(equation)
    if _YIELD in given:
        laid.give(_YIELD)
        for equation in johnson.FIRST_YIELD:
            laid.tell(equation, expects=johnson.SLOW)
    for model in MODELS:
        laid.tell_model(model)
    # What is taken together comes last: of every model over the tests that all of them predict.
    alike = tuple(c for c in laid.columns.values() if c.name.startswith("miss_") and not c.spare)
    for model in MODELS:
        for equation in _parts(model)[1]:
            laid.tell(equation, spare=bool(model.left_out), alongside=alike)
    for equation in checks.CELLS:
        laid.tell(equation, checks.NEEDS)
    for author in prescribed.AUTHORS:
        for each in author.told:
            laid.tell(each.equation, {each.own.symbol: each.needs}, solved=each.solved)
    return Sheet(tuple(laid.columns.values()))


def _of_tests(given: frozenset[str], *names: str) -> tuple[Column, ...]:
    """Some columns of the soft-impact sheet; what is odd of them is said there."""
    own = soft_impact.sheet(given)
    return tuple(replace(own[name], limits=()) for name in names if name in own)


def _masses(given: frozenset[str]) -> tuple[Column, ...]:
    """The mass of the ball and the reduced mass, from what was given."""
    shape = () if "ball_mass" in given else ("ball_diameter", "ball_density")
    own = given & {"ball_mass", "target_mass", *shape}
    return _of_tests(own, *shape, "ball_mass", "target_mass", "m_red")


def _parts(model: ContactModel) -> tuple[list[Equation], list[Equation]]:
    """Of what is told of a model beside the tests: of each test, and of all together."""
    found: tuple[list[Equation], list[Equation]] = [], []
    for equation in BESIDE[model.name].equations:
        found[equation.sides[0].name.startswith(_AVERAGES)].append(equation)
    return found


class _Laid:
    """Columns so far, and which cell each symbol of the derivations stands for."""

    def __init__(self) -> None:
        self.columns: dict[str, Column] = {}
        self.where: dict[Expr, Expr] = {}

    @classmethod
    def of(cls, sheet: Sheet) -> _Laid:
        """The columns of a sheet."""
        laid = cls()
        for column in sheet.columns:
            laid.add(column)
        laid.call_all()
        return laid

    def add(self, column: Column) -> None:
        """A column; a quantity of its name is meant by it."""
        self.columns[column.name] = column
        if column.name in LEDGER.vocabulary:
            self.call(column.name, column.name)

    def call(self, quantity: str, name: str) -> None:
        """What a quantity of the derivations is called here."""
        own, cell = LEDGER.vocabulary[quantity], self.columns[name].cell
        self.where |= {own.symbol: cell, own[k]: cell}

    def call_all(self) -> None:
        """Models speak of a test as it was measured, and of the curve of law (3) as fitted."""
        for quantity, name in _CALLED.items():
            self.call(quantity, name)

    def give(self, name: str) -> None:
        """What is given of a body."""
        own = LEDGER.vocabulary[name]
        shown = f"like {name}" if own.unit != "1" else ""
        self.add(Column(name, None, Given("parameter"), own.unit, own.meaning, own.latex, shown))

    def tell_model(self, model: ContactModel) -> None:
        """The cells of a model, those without a test, and what stands beside the measured ones."""
        if constant := model.constant:
            for equation in constant.of_test:
                self.tell(equation, dict.fromkeys((_defined(equation),), constant.needs))
            self.tell(constant.mean, expects=model.expects)
            self.tell(constant.without, {constant.without.sides[0]: _OTHERS})
        for equation in model.cells:
            own = _defined(equation) in model.left_out.values()
            self.tell(equation, model.needs, expects=model.expects, spare=own)
        without = BESIDE[model.name].without
        for equation in model.hanging():
            self.tell(equation, model.needs, without)
        for equation in _parts(model)[0]:
            self.tell(equation, spare=bool(model.left_out))

    def tell(
        self,
        equation: Equation,
        needs: Mapping[Any, Any] | None = None,
        without: Mapping[Symbol, Symbol] | None = None,
        expects: Mapping[Any, tuple[Rel, str]] | None = None,
        solved: prescribed.Solving | None = None,
        **more: Any,
    ) -> None:
        """A column by the equation that defines it; one that has it on both sides is solved for it.

        `solved`: how; left out, it lies in the interval in which proofs sample it.
        """
        symbol = _defined(equation)
        called = without or {}
        own, new = LEDGER.vocabulary[symbol.name], called.get(symbol, symbol)
        if new.name in self.columns:
            return
        where = self.where | {old: self.where[name] for old, name in called.items() if name in self.where}
        named = set[Any]().union(*(side.xreplace(where).free_symbols for side in equation.sides))
        blank = Column(
            new.name, _TESTS if k in named else None, Given(), own.unit, own.meaning, own.latex,
            positive=bool(own.positive),
            display="%" if new.name.startswith(_PERCENT) else _SHOWN.get(own.unit, ""), **more,
        )  # fmt: skip
        own_where = where | {symbol: blank.cell, own[k]: blank.cell}
        asked = (needs or {}).get(symbol, ())
        asked = (asked,) if asked and isinstance(asked[0], Rel) else asked
        requires = tuple((condition.xreplace(own_where), says) for condition, says in asked)
        limits = tuple(self.limits((expects or {}).get(symbol), own_where))
        if equation.sides[0] in (symbol, own[k]) and not equation.sides[-1].has(symbol):
            rule: Formula | Root = Formula(equation.at(own_where))
        else:
            cells = {old: cell for old, cell in where.items() if old != symbol}
            said = equation.at(cells)
            low, high = map(Rational, map(str, own.span))
            rule = Root(said, said, symbol, symbol, low, high, (low + high) / 2, steps=8)
            if solved is not None:
                low, high, start = (part.xreplace(cells) for part in solved)
                below, above = Integer(-1), Integer(1)
                rule = Root(said, said, symbol, symbol, low, high, start, below, above, steps=8)
        column = replace(blank, rule=rule, requires=requires, limits=limits)
        self.columns[new.name] = column
        self.where |= {new: column.cell}
        if new == symbol:
            self.where |= {own[k]: column.cell}

    def limits(self, expected: tuple[Rel, str] | None, where: Mapping[Expr, Expr]) -> list[Limit]:
        """Where a cell is expected, if all that this names is in the sheet."""
        if expected is None or not expected[0].free_symbols <= where.keys():
            return []
        return [Limit(expected[0].xreplace(where), expected[1])]


def _defined(equation: Equation) -> Symbol:
    """What an equation is a column of; of a test it may say so itself."""
    of = equation.sides[0] if equation.defines is None else equation.defines
    return LEDGER.vocabulary[name_of(of)].symbol if isinstance(of, Indexed) else of


def constants(sheet: Sheet) -> dict[Symbol, str]:
    """Which cells the quantities of the derivations are that are the same for all tests."""
    called = {name: _CALLED.get(name, name) for name in LEDGER.vocabulary}
    return {
        LEDGER.vocabulary[quantity].symbol: name
        for quantity, name in called.items()
        if name in sheet and sheet[name].axis is None
    }


def branches(sheet: Sheet, points: int) -> Drawn:
    """The columns of charts: approach and force of both branches of each test, by every model.

    `points`: of each branch.
    """
    row, step, size = (Symbol(name, integer=True, positive=True) for name in ("l", "m", "n_loops"))
    axis = RepeatAxis("loops", row, size, of=_TESTS, step=step, count="loop_points")
    count = Column(axis.count, None, Given("chart"), meaning="points of each branch", exact=True)
    share, found, where = (step - 1) / (count.symbol - 1), [count], _Laid.of(sheet).where
    for model in MODELS:
        x_m = where[model.predicts.get("x_m", hertz.x_m)]
        x_p = where[model.predicts["x_p"]]
        ways = {
            "loading": (x_m * share, model.loading),
            "unloading": (x_p + (x_m - x_p) * share, model.unloading),
        }
        closed = ((x_m > x_p, "a loop is drawn where the imprint is shallower than the approach"),)
        for way, (at, law) in ways.items():
            meaning, more = f"while {way}, {model.title}", {"requires": closed, "display": "like x_p"}
            x = drawn(f"{way}_x_{model.name}", axis, at, "m", f"approach {meaning}", **more)
            force = law.xreplace(where | {hertz.x: x[row]})
            found += [
                x,
                drawn(f"{way}_F_{model.name}", axis, force, "N", f"force {meaning}", requires=closed),
            ]
    for author in prescribed.AUTHORS:
        back = author.e.own.symbol if author.e else hertz.e
        even = Rational(5, 2)  # with Hertz's force the work is as this power of the approach
        ways = {"loading": 1 - share**even, "unloading": -back * (1 - (1 - share) ** even)}
        for way, rate in ways.items():
            name, meaning = author.c.own.name, f"while {way}, damping by {author.title}"
            depth, force = (part.xreplace(where) for part in prescribed.course(author, rate))
            found += [
                drawn(f"{way}_x_{name}", axis, depth, "m", f"approach {meaning}", display="like x_p"),
                drawn(f"{way}_F_{name}", axis, force, "N", f"force {meaning}"),
            ]
    return Drawn(tuple(found), {axis.count: points})
