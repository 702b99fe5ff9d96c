"""What a publication tells of a cell besides its value: ``u(l)``, ``U99(l)``, ``r(R, X)``.

u(l)              the combined standard uncertainty; u1(l): to first order alone
u(l, d)           what all errors of the column d contribute to it
U99(l), k99(l)    the expanded uncertainty for 99 %, and its coverage factor
U(l, k=2)         the standard uncertainty times a factor that was chosen
dof(l)            the effective degrees of freedom, truncated or not
r(R, X)           the correlation of two cells of the same row
low95(l), high95(l)   the ends of the interval with equal tails, by Monte Carlo
"""

from __future__ import annotations

import re
from dataclasses import dataclass

FORMS = "u(l), u1(l), u(l, d), U95(l), k95(l), U(l, k=2), dof(l), r(l, m), low95(l), high95(l)"
"""What there is, for messages."""
_WRITTEN = re.compile(r"([^()\s]*)\s*\(\s*([^(),]+?)\s*(?:,\s*([^(),]+?)\s*)?\)")
_KIND = re.compile(r"(u1?|dof|r)|(U|k|low|high)([0-9]{1,2}(?:\.[0-9]{1,6})?)")
_FACTOR = re.compile(r"k\s*=\s*([0-9]{1,2}(?:\.[0-9]{1,6})?)")
_PURE = ("k", "dof", "r")


@dataclass(frozen=True)
class About:
    """What is told of a cell."""

    kind: str
    """``u``, ``u1``, ``U``, ``k``, ``dof``, ``r``, ``low`` or ``high``."""
    cell: str
    """The column of the cell."""
    other: str = ""
    """The column whose errors contribute, or that it is correlated with; empty if there is none."""
    level: float = 0.95
    """The coverage probability, where there is one."""
    factor: float = 0.0
    """Of an expanded uncertainty the coverage factor, where that was chosen; else 0."""

    @property
    def is_width(self) -> bool:
        """Whether it is a difference of values of the cell."""
        return self.kind in ("u", "u1", "U")

    @property
    def is_pure(self) -> bool:
        """Whether it is a pure number, whatever the unit of the cell."""
        return self.kind in _PURE


def read_about(text: str) -> About | None:
    """What the field `cell` of published.csv tells of a cell; None if it is no such thing.

    >>> read_about("U99(l)"), read_about("l")
    (About(kind='U', cell='l', other='', level=0.99, factor=0.0), None)
    """
    written = _WRITTEN.fullmatch(text)
    if written is not None and written[1] == "U" and (chosen := _FACTOR.fullmatch(written[3] or "")):
        factor = float(chosen[1])
        return About("U", written[2], factor=factor) if factor else None
    kind = _KIND.fullmatch(written[1]) if written else None
    if written is None or kind is None:
        return None
    name, cell, other = kind[1] or kind[2], written[2], written[3] or ""
    level = float(kind[3] or 95) / 100
    if level < 0.01 or bool(other) not in {"u": (False, True), "r": (True,)}.get(name, (False,)):
        return None
    return About(name, cell, other, level)
