"""The identified law or a contact model's, as a table and as source: printed from its sympy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from textwrap import wrap
from typing import NamedTuple

import numpy as np
from sympy import Expr, Float, ccode, pycode

from .card import Bodies, solved
from .code import ContactFormula
from .drops import Drop, Drops
from .law import ForceLaw

_TEMPLATES = Path(__file__).resolve().parents[2] / "templates" / "impacts"
POINTS = 100
"""Steps of each branch in a table."""
_LINE = 107
"""Characters of a line of comment."""


@dataclass(frozen=True)
class WrittenLaw:
    """A law that can be written down."""

    law: ForceLaw
    """With all numbers in it."""
    says: str
    """What it is, in a line."""
    beyond: str
    """What it does beyond the measured speeds."""
    drops: Drops
    drop: Drop
    """The impact that a table is of."""
    x_m: float
    """Its greatest approach, in m."""


def identified(drops: Drops, drop: Drop) -> WrittenLaw:
    """The identified law."""
    says = (
        "Law (3) of the report: C x^alpha while the approach x grows, and back along the power beta to the "
        "imprint."
    )
    return WrittenLaw(
        drops.law(), says, "the imprint keeps its share of the greatest approach", drops, drop, drop.x_m
    )


def modelled(formula: ContactFormula, drops: Drops, drop: Drop) -> WrittenLaw:
    """A formula of which all numbers are known.

    Raises
    ------
    Unreachable
        One is not, or the law has no impact for them.
    """
    constants, found, _ = solved(formula, drops, drop, Bodies())
    numbers = {symbol: Float(repr(value), 17) for symbol, value in constants.items()}
    law = formula.law.with_numbers(numbers)
    told = (f"{one.word} = {constants[one.symbol]:.9g} {one.unit}" for one in formula.typed)
    return WrittenLaw(
        law, f"{formula.title}; {', '.join(told)}.", "the law is the same", drops, drop, found.x_m
    )


def _filled(template: str, printed: Callable[[Expr], str], line: str, indent: str, of: WrittenLaw) -> str:
    """A program: what is marked with @ in the template is put in."""

    def put(value: Expr) -> str:
        return " ".join(printed(value).split())

    words = {
        "says": f"\n{indent}".join(wrap(of.says, _LINE)),
        "beyond": of.beyond,
        "loading": put(of.law.loading),
        "unloading": put(of.law.back),
        "where": "\n    ".join(line.format(name, put(value)) for name, value in reversed(of.law.where)),
        "imprint": put(of.law.imprint),
        "mass": repr(of.drops.mass),
        "slowest": repr(of.drops.tests[0].speed),
        "fastest": repr(of.drops.tests[-1].speed),
    }
    text = (_TEMPLATES / template).read_text(encoding="utf-8")
    for word, value in words.items():
        text = text.replace(f"@{word}@", value)
    return text.rstrip("\n")


_as_c99 = partial(_filled, "force.c.txt", ccode, "const double {} = {};", "   ")
_as_python = partial(_filled, "force.py.txt", pycode, "{} = {}", "")


def as_table(of: WrittenLaw) -> str:
    """The force over the approach of one impact as CSV, one branch after the other."""
    forces, x_m = of.law.at(of.drops.mass, of.drop.speed, {}), of.x_m
    lines = ["phase,x [m],F [N]"]
    for place in np.linspace(0.0, x_m, POINTS + 1).tolist():
        lines.append(f"loading,{place!r},{forces.loading(place, 0.0, place)!r}")
    for place in np.linspace(x_m, forces.imprint(x_m), POINTS + 1).tolist():
        lines.append(f"unloading,{place!r},{forces.unloading(place, 0.0, x_m)!r}")
    return "\n".join(lines)


class Language(NamedTuple):
    """A language: what it is for, what prints the law in it, and how a line of comment begins and ends."""

    said: str
    printed: Callable[[WrittenLaw], str]
    begins: str = "# "
    ends: str = ""

    def of(self, written: WrittenLaw, remarks: Sequence[str]) -> str:
        """The law below comments, in which nothing ends a comment."""
        safe = (line.replace("*/", "* /").replace("/*", "/ *") for line in remarks)
        return "\n".join([*(self.begins + line + self.ends for line in safe), self.printed(written)])


SOURCES = {
    "table": Language("the identified law, force over approach at one speed, as CSV", as_table),
    "c": Language("the identified law as a function in C, for any speed", _as_c99, "/* ", " */"),
    "python": Language("the identified law as a function in Python, for any speed", _as_python),
}
"""What prints the law itself, by the word for it."""
