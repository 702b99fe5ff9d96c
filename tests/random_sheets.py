"""Sheets that are drawn at random: two columns and two scalars given, and what bends and has poles."""

from __future__ import annotations

import random

from small_report import pure
from sympy import Expr, Rational, Symbol, exp, log, sqrt

from loopsheet.derivations.equation import Equation, Kind
from loopsheet.report.quantity import Printed
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet

__all__ = ["ROWS", "definition", "k", "n", "printed", "sheet_of"]

k, n = (Symbol(name, integer=True, positive=True) for name in "kn")
ROWS = Axis("rows", k, n)


def expression(rng: random.Random, leaves: list[Expr], depth: int) -> Expr:
    """Something that bends, has poles and is undefined here and there."""
    if not depth or rng.random() < 0.15:
        return rng.choice(leaves)
    one, other = (expression(rng, leaves, depth - 1) for _ in range(2))
    match rng.randrange(9):
        case 0 | 1:
            return one + other
        case 2 | 3:
            return one - other
        case 4 | 5:
            return one * other
        case 6:
            return one / (other + Rational(5, 2))
        case 7:
            return rng.choice((sqrt, exp))(one)
    return rng.choice((one**2, log(one + 2)))


def printed(rng: random.Random) -> Printed:
    """A small number, often zero: there derivatives of products vanish."""
    return pure(f"{rng.choice((0, 0, rng.uniform(-2, 2), rng.uniform(0, 9))):.{rng.randrange(3)}f}")


def definition(formula: Expr) -> Formula:
    return Formula(Equation("", (Symbol("made"), formula), "for a test", Kind.DEFINITION, "made"))


def sheet_of(rng: random.Random) -> Sheet:
    given = [Column(name, ROWS, Given(), positive=False) for name in "ab"]
    given += [Column(name, None, Given(), positive=False) for name in "cd"]
    leaves = [given[0][k], given[1][k], given[2].symbol, given[3].symbol]
    columns = list(given)
    for name in "yz":
        columns.append(Column(name, ROWS, definition(expression(rng, leaves, 4)), positive=False))
        leaves.append(columns[-1][k])
    return Sheet(tuple(columns))
