"""The force laws of contact models, for any turning point: what a simulation takes of their declarations."""

from __future__ import annotations

from sympy import Expr, Integer, Symbol

from loopsheet.derivations.contact import hertz
from loopsheet.derivations.contact.model import ContactModel
from loopsheet.report.impacts.law import ForceLaw, m_red, v_0, x, x_max

__all__ = ["law_of"]


def law_of(model: ContactModel) -> ForceLaw:
    """The force of a model.

    Parameters
    ----------
    model : ContactModel
        Its cells say what its symbols are; what they leave open are the constants of the law.

    Notes
    -----
    A greatest approach stands for the speed that leads there, so that the law holds for any turning point:
    what a model says of the speed is said by the approach.
    """
    x_m: Symbol = model.predicts.get("x_m", hertz.x_m)
    cells = [equation for equation in model.cells if equation.sides[0] != x_m]
    shared = (hertz.stiffness, hertz.radius, hertz.modulus)
    told = tuple((each.sides[0], _plain(each.value, x_m)) for each in (*reversed(cells), *shared))
    imprint: Expr = model.predicts["x_p"]
    unloading = None if imprint == hertz.x_p else _plain(model.unloading, x_m)
    parts = Integer(0) if unloading is None else imprint
    return ForceLaw(model.title, _plain(model.loading, x_m), unloading, parts, where=told)


def _plain(of: Expr, x_m: Symbol) -> Expr:
    """With the symbols that simulations have."""
    return of.xreplace({hertz.x: x, x_m: x_max, hertz.v: v_0, hertz.m_red: m_red})
