"""How far a model misses the tests: what it predicts of each, beside what was measured.

A model with a constant is asked for each test with the constant of all others: it is not to win by
construction. Its sum of squares takes the constant of all tests, and is the least over the true speeds, and
over the true restitutions where it is told these, along its tangents.
"""

from __future__ import annotations

from dataclasses import dataclass
from string import ascii_lowercase

from sympy import Expr, Matrix, Max, Symbol, sqrt

from ..equation import Equation, define
from ..global_fit import n_tests, over_tests
from ..reductions import Greatest, Least
from ..symbols import VOCABULARY as PAPER
from ..symbols import k
from ..vocabulary import Quantity
from .model import ContactModel

_WORDS = {"v": "speed", "e": "restitution", "x_p": "imprint"}
_UNITS = {"v": "m/s", "e": "1", "x_p": "m"}
_U = {"v": PAPER["u_v"], "e": PAPER["u_e"], "x_p": PAPER["u_x"]}
"""What was measured, and its standard uncertainties."""


@dataclass(frozen=True)
class Compared:
    """A model beside the tests."""

    quantities: tuple[Quantity, ...]
    """What it misses of each test, the root of the mean square and the largest of each kind; slopes, and the
    sum of squares."""
    equations: tuple[Equation, ...]
    """One for each."""
    without: dict[Symbol, Symbol]
    """What cells of the model are called if the test is left out."""


def compared(model: ContactModel, number: str) -> Compared:
    """A model beside the tests.

    `number`: of its equations, which get letters.
    """
    letters, made = iter(ascii_lowercase), dict[Quantity, Equation]()
    mark = rf"\mathrm{{{model.mark}}}"

    def tell(
        name: str, value: Expr, meaning: str, latex: str, unit: str = "1", least: float = -0.5
    ) -> Quantity:
        said = f"{meaning}: {model.title}"
        own = Quantity(f"{name}_{model.name}", said, unit, latex, (least, 0.5))
        made[own] = define(number, own.symbol, value, said, part=next(letters))
        return own

    without = dict(model.left_out) or _without(model)
    told = {name: model.predicts[name] for name in ("e", "x_p") if name in model.predicts}
    misses = [
        tell(
            f"miss_{name}",
            without.get(symbol, symbol) / PAPER[name].symbol - 1,
            f"what the {_WORDS[name]} is too large by, predicted by the other tests",
            rf"\epsilon_{{{name[0]},{mark}%s}}",
        )
        for name, symbol in told.items()
    ]
    for name, miss in zip(told, misses, strict=True):
        tell(
            f"rms_{name}",
            sqrt(over_tests(miss[k] ** 2) / n_tests),
            f"root-mean-square miss of the {_WORDS[name]}",
            rf"\bar{{\epsilon}}_{{{name[0]},{mark}%s}}",
        )
    if not model.left_out:
        given = [name for name in _WORDS if name not in told]
        slopes = Matrix(len(told), len(given), lambda _row, _column: 0).as_mutable()
        for row, (name, symbol) in enumerate(told.items()):
            for column, by in enumerate(given):
                slope = model.slope(symbol, PAPER[by].symbol)
                if slope != 0:
                    meaning = f"change of the {_WORDS[name]} with the {_WORDS[by]}"
                    latex = rf"\partial {name[0]}/\partial {by[0]}_{{{mark}%s}}"
                    own = tell(f"d_{name}_{by}", slope, meaning, latex, f"{_UNITS[name]}/({_UNITS[by]})")
                    slopes[row, column] = own[k]
        variances = Matrix.diag(*(_U[name][k] ** 2 for name in told))
        spread = Matrix.diag(*(_U[name][k] ** 2 for name in given))
        off = Matrix([PAPER[name][k] - _cell(model, told[name])[k] for name in told])
        covariance = variances + slopes * spread * slopes.T
        squares = (off.T * covariance.adjugate() * off)[0] / covariance.det()
        tell(
            "chi2",
            over_tests(squares),
            "sum of squares over the variances",
            rf"\chi^2_{{{mark}%s}}",
            least=0.1,
        )
    for name, miss in zip(told, misses, strict=True):
        tell(
            f"most_{name}",
            Max(Greatest(miss[k], (k, 1, n_tests)), -Least(miss[k], (k, 1, n_tests))),
            f"largest miss of the {_WORDS[name]}",
            rf"\hat{{\epsilon}}_{{{name[0]},{mark}%s}}",
        )
    return Compared(tuple(made), tuple(made.values()), without)


def _cell(model: ContactModel, symbol: Symbol) -> Quantity:
    return next(own for own in model.quantities if own.symbol == symbol)


def _without(model: ContactModel) -> dict[Symbol, Symbol]:
    """New names for what hangs on the constant."""
    if model.constant is None:
        return {}
    hanging = [equation.sides[0] for equation in model.hanging()]
    names = {own.symbol: own.name for own in model.quantities}
    renamed = {symbol: symbol.func(f"{names[symbol]}_without", positive=True) for symbol in hanging}
    return {model.constant.mean.sides[0]: model.constant.without.defines, **renamed}
