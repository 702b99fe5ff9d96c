"""A contact model as a force law for any turning point, and as what a user types into a program."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping

from sympy import Expr, Float, Integer, Piecewise, Symbol, ccode

from ...derivations.contact import hertz
from ...derivations.contact.model import ContactModel
from ...derivations.vocabulary import Vocabulary
from .code import ContactFormula, Typed, e
from .law import ForceLaw, m_red, v_0, x, x_max


def law_of(model: ContactModel, known: Collection[Symbol] = ()) -> ForceLaw:
    """The force of a model.

    Parameters
    ----------
    model : ContactModel
        Its cells say what its symbols are; what they leave open are the constants of the law.
    known : collection of Symbol
        Those that are constants, though cells say what they are.

    Notes
    -----
    A greatest approach stands for the speed that leads there, so that the law holds for any turning point:
    what a model says of the speed is said by the approach.
    """
    x_m: Symbol = model.predicts.get("x_m", hertz.x_m)
    imprint: Expr = model.predicts["x_p"]
    unloading = None if imprint == hertz.x_p else _plain(model.unloading, x_m)
    loading, parts = _plain(model.loading, x_m), Integer(0) if unloading is None else imprint
    asked = loading.free_symbols | parts.free_symbols | (unloading or loading).free_symbols
    told = []
    for equation in (*reversed(model.cells), hertz.stiffness, hertz.radius, hertz.modulus):
        symbol = equation.sides[0]
        if symbol in asked and symbol not in known and symbol != x_m:
            told.append((symbol, _plain(equation.value, x_m)))
            asked |= told[-1][1].free_symbols
    return ForceLaw(model.title, loading, unloading, parts, where=tuple(told))


def _plain(of: Expr, x_m: Symbol) -> Expr:
    """With the symbols that simulations have."""
    return of.xreplace({hertz.x: x, x_m: x_max, hertz.v: v_0, hertz.m_red: m_red})


def formula(model: ContactModel, numbers: Mapping[Symbol, float], words: Vocabulary) -> ContactFormula:
    """A model as a formula with nothing to solve for; a restitution that it is told is that of the impact.

    `numbers`: what its constants are, in SI; NaN where one has no value. `words`: of these symbols.
    """
    law = law_of(model, numbers)
    typed = []
    for symbol in law.constants:
        own, value = words[symbol.name], numbers.get(symbol, math.nan)
        known = e if symbol == e else Float(repr(value), 17)
        typed.append(Typed(own.name, symbol, own.unit, own.meaning, known))
    return ContactFormula(
        name=model.name,
        title=model.title,
        sources=(model.source,),
        law=law,
        typed=tuple(typed),
        snippet=_in_c(law),
        notes=(f"as in this report: {model.assumes}",),
    )


def _in_c(law: ForceLaw) -> str:
    """Its force as expressions of C, what they name first."""
    force = law.loading
    if law.unloading is not None:
        force = Piecewise((law.loading, x >= x_max), (law.unloading, x > law.imprint), (0, True))
    told = [*((str(symbol), value) for symbol, value in reversed(law.where)), ("F", force)]
    return "; ".join(f"{name} = {' '.join(ccode(value).split())}" for name, value in told)
