"""Lines of an equation: where what :mod:`~loopsheet.report.document.math` prints is broken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from ..document.names import Terms, join
from ..document.notation import Notation, read

TEXT_WIDTH = 60.0
"""How wide a line may be beside the number of its equation, in letters."""
_SHORT = 14.0
"""Left-hand sides up to this width get a column of their own."""


@dataclass(frozen=True)
class Typeset:
    """A displayed equation, broken into lines."""

    left: str
    """LaTeX in front of the first relation, if the relations are aligned; else empty."""
    rows: tuple[str, ...]
    """LaTeX of the lines; all but the first continue it."""

    @property
    def latex(self) -> str:
        """The whole on one line."""
        return " ".join([self.left, *self.rows] if self.left else self.rows)

    @property
    def aligned(self) -> str:
        """For a displayed equation of LaTeX."""
        if len(self.rows) == 1:
            return self.latex
        first, *rest = self.rows
        lines = [
            f"{self.left} &{first}",
            *(rf"&{'' if relates(row) else chr(92) + 'quad '}{row}" for row in rest),
        ]
        return r"\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}"

    @property
    def width(self) -> float:
        """How wide the widest line is, in letters."""
        return width(self.left) + max(width(row) for row in self.rows)


def relates(row: str) -> bool:
    """Whether a line begins with a relation."""
    return row.startswith("=")


def block(sides: Sequence[Terms]) -> Typeset:
    """Break an equation into lines, before a relation or between the terms of a sum.

    `sides`: of the equation, or one relation: from :meth:`~loopsheet.report.document.math.MathPrinter.sides`.
    """
    whole = " = ".join(join(side) for side in sides)
    if width(whole) <= TEXT_WIDTH or (len(sides) == 1 and len(sides[0]) == 1):
        return Typeset("", (whole,))
    first = join(sides[0])
    left = first if len(sides) > 1 and width(first) <= _SHORT else ""
    rows: list[str] = []
    for place, side in enumerate(sides):
        if place == 0 and left:
            continue
        pieces = [
            ("- " if negative else "+ " if number else "") + term
            for number, (negative, term) in enumerate(side)
        ]
        if place:
            pieces[0] = "= " + pieces[0]
        else:
            pieces[0] = pieces[0].replace("- ", "-", 1)
        for number, piece in enumerate(pieces):
            # A chain of equalities has one a line; the zero of "... = 0" stays where the line ends.
            chained = len(sides) > 2 and place > 1 - bool(left)
            fits = bool(rows) and width(left) + width(rows[-1]) + width(" ".join(pieces)) <= TEXT_WIDTH
            fresh = not rows or (number == 0 and place > 0 and (chained or not (fits or left)))
            if fresh or width(left) + width(rows[-1]) + width(piece) + 1 > TEXT_WIDTH:
                rows.append(piece)
            else:
                rows[-1] += " " + piece
    return Typeset(left, tuple(rows))


# --- how wide --------------------------------------------------------------------------------------------

_WIDE = {"∑": 2.2, "∫": 1.6, "max": 3.0, "min": 3.0, "exp": 2.8, "ln": 1.8}
_SPACED = frozenset("=+−<>≤≥≠·")
_SMALL = 0.72
"""How large scripts are."""


@lru_cache(maxsize=4096)
def width(latex: str) -> float:
    r"""How wide LaTeX is printed, roughly, in letters.

    >>> width("a + b") < width(r"a + b + c"), width(r"\frac{a}{b + c}") < width("a + b + c")
    (True, True)
    """
    return _width(read(latex))


def _width(part: Notation) -> float:
    inside = [_width(each) for each in part.parts]
    match part.kind:
        case "fraction":
            return max(inside) + 0.5
        case "scripts" | "limits":
            return inside[0] + _SMALL * max(inside[1:])
        case "root":
            return 1.4 + sum(inside)
        case "under" | "cases" | "line":
            return 1.0 + sum(inside)
        case "fence":
            return 1.4 + sum(inside)
        case "accent" | "space":
            return sum(inside)
        case "sign" | "upright" if part.text in _WIDE:
            return _WIDE[part.text]
        case "sign":
            return 2.2 if part.text in _SPACED else 0.7
        case "letter" if part.text in "′″‴":
            return 0.0
    return len(part.text) + sum(inside)
