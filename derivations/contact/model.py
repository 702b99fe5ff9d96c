"""What a contact model is here: what it assumes, the equations by which it predicts a test, and its force.

The ledger, the sheet, tables, charts and simulations of all models are made of this.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from sympy import Add, Expr, Piecewise, Rel, Symbol, diff

from ..equation import Derivation, Equation
from ..vocabulary import Quantity


@dataclass(frozen=True)
class Constant:
    """The one number that a model takes from the tests."""

    of_test: tuple[Equation, ...]
    """What it would be by one test alone: formulas; one that is solved for what it `defines` has that on both
    sides, and is a root between 0 and 1."""
    mean: Equation
    without: Equation
    """`mean` and `without`: the geometric mean of these over all tests, and over all but one."""
    needs: tuple[tuple[Rel, str], ...] = ()
    """Without what a test tells nothing of it, and the sentences for that."""


@dataclass(frozen=True)
class ContactModel:
    """A model of an impact."""

    name: str
    """The last part of the names of its cells, ``johnson``."""
    title: str
    mark: str
    """`title` and `mark`: author and what it is, ``Johnson, fully plastic``; the letters at its symbols."""
    assumes: str
    """In a sentence, what it takes for true."""
    source: str
    """Author, title, year."""
    quantities: tuple[Quantity, ...]
    """Its own symbols, called as their cells."""
    entries: tuple[Equation | Derivation, ...]
    """Its equations, in the order of a ledger."""
    cells: tuple[Equation, ...]
    """Those that tell a cell of all tests or of each, after the ones that they need."""
    predicts: Mapping[str, Symbol]
    """Its approach ``x_m``, force ``F_m``, duration ``t``, restitution ``e`` and imprint ``x_p``; what it
    does not predict but is told is left out."""
    loading: Expr
    unloading: Expr
    """`loading` and `unloading`: the force up to the greatest approach, and from there; in terms of the
    approach x, of what is given and of its cells."""
    constants: int = 0
    """How many numbers it takes from the tests."""
    constant: Constant | None = None
    """The only one of them."""
    left_out: Mapping[Symbol, Symbol] = field(default_factory=dict)
    """What predicts a test that is left out, where its equations say so themselves."""
    needs: Mapping[Symbol, tuple[Rel, str]] = field(default_factory=dict)
    """Without what it says nothing of a test, and the sentence for that."""
    expects: Mapping[Symbol, tuple[Rel, str]] = field(default_factory=dict)
    """What it expects of a cell that has a value all the same, and what is odd where that does not hold."""

    @property
    def told(self) -> bool:
        """Whether it is told the restitution of a test, which it does not predict."""
        return "e" not in self.predicts

    def varies(self, name: str) -> bool:
        """Whether it predicts something that is not one number for all impacts."""
        told = {equation.sides[0]: equation for equation in self.cells}
        own = told.get(self.predicts.get(name))
        return own is not None and bool(own.value.free_symbols)

    def slope(self, of: Symbol, by: Symbol) -> Expr:
        """How one of its cells changes with what was measured, in terms of its cells.

        Those that tell cases tell the same ones, in the same order.
        """
        known: dict[Expr, Expr] = {}

        def along(value: Expr, case: int | None = None) -> Expr:
            through = (diff(value, cell) * _case(slope, case) for cell, slope in known.items())
            return Add(diff(value, by), *through)

        for equation in self.cells:
            value = equation.value
            cases = enumerate(value.args) if isinstance(value, Piecewise) else ()
            told = [(along(each.expr, case), each.cond) for case, each in cases]
            known[equation.sides[0]] = Piecewise(*told) if told else along(value)
        return known[of]

    def hanging(self) -> tuple[Equation, ...]:
        """Its cells that hang on its constant, and that restitution and imprint need."""
        if self.constant is None:
            return ()
        wanted = {symbol for name, symbol in self.predicts.items() if name in ("e", "x_p")}
        moved, found = {self.constant.mean.sides[0]}, []
        for equation in self.cells:
            if equation.value.free_symbols & moved:
                moved.add(equation.sides[0])
                found.append(equation)
        for equation in reversed(found):
            if equation.sides[0] in wanted:
                wanted |= equation.value.free_symbols
        return tuple(equation for equation in found if equation.sides[0] in wanted)


def _case(of: Expr, case: int | None) -> Expr:
    """What is said for one of the cases, where cases are told apart."""
    return of if case is None or not isinstance(of, Piecewise) else of.args[case].expr
