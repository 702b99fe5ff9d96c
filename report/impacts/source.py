"""The identified law as a table, and as source for programs of one's own: printed from its sympy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from sympy import Expr, ccode, pycode

from .drops import Drop, Drops

__all__ = ["SOURCES", "Language", "as_table"]

_TEMPLATES = Path(__file__).resolve().parents[2] / "templates" / "impacts"
POINTS = 100
"""Steps of each branch in a table."""


def _filled(template: str, printed: Callable[[Expr], str], drops: Drops) -> str:
    """A program: what is marked with @ in the template is put in."""
    law = drops.law()
    ((_, imprint),) = law.where
    words = {
        "loading": printed(law.loading),
        "unloading": printed(law.back),
        "imprint": " ".join(printed(imprint).split()),
        "mass": repr(drops.mass),
        "slowest": repr(drops.tests[0].speed),
        "fastest": repr(drops.tests[-1].speed),
    }
    text = (_TEMPLATES / template).read_text(encoding="utf-8")
    for word, value in words.items():
        text = text.replace(f"@{word}@", value)
    return text.rstrip("\n")


def as_c(drops: Drops, _: Drop) -> str:
    """A function in C99."""
    return _filled("force.c.txt", ccode, drops)


def as_python(drops: Drops, _: Drop) -> str:
    """A function in Python, which imports nothing."""
    return _filled("force.py.txt", pycode, drops)


def as_table(drops: Drops, drop: Drop) -> str:
    """The force over the approach of one impact as CSV, one branch after the other."""
    forces = drops.law().at(drops.mass, drop.speed, {})
    x_m = drop.x_m
    lines = ["phase,x [m],F [N]"]
    for place in np.linspace(0.0, x_m, POINTS + 1).tolist():
        lines.append(f"loading,{place!r},{forces.loading(place, 0.0, place)!r}")
    for place in np.linspace(x_m, forces.imprint(x_m), POINTS + 1).tolist():
        lines.append(f"unloading,{place!r},{forces.unloading(place, 0.0, x_m)!r}")
    return "\n".join(lines)


class Language(NamedTuple):
    """A language: what it is for, what prints the law in it, and how a line of comment begins and ends."""

    said: str
    printed: Callable[[Drops, Drop], str]
    begins: str = "# "
    ends: str = ""

    def of(self, drops: Drops, drop: Drop, remarks: Sequence[str]) -> str:
        """The law below comments, in which nothing ends a comment."""
        safe = (line.replace("*/", "* /").replace("/*", "/ *") for line in remarks)
        return "\n".join([*(self.begins + line + self.ends for line in safe), self.printed(drops, drop)])


SOURCES = {
    "table": Language("the identified law, force over approach at one speed, as CSV", as_table),
    "c": Language("the identified law as a function in C, for any speed", as_c, "/* ", " */"),
    "python": Language("the identified law as a function in Python, for any speed", as_python),
}
"""What prints the law itself, by the word for it."""
