"""Lines of an equation, and MathML: how :mod:`~loopsheet.report.document.math` is set on a page."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from sympy import Expr

from ..document.math import Printer
from .escape import Markup, html

__all__ = ["TEXT_WIDTH", "Block", "block", "mathml", "mathml_block", "width"]

TEXT_WIDTH = 60.0
"""How wide a line may be beside the number of its equation, in letters."""
_SHORT = 14.0
"""Left-hand sides up to this width get a column of their own."""


@dataclass(frozen=True)
class Block:
    """A displayed equation, broken into lines.

    Parameters
    ----------
    left : str
        LaTeX in front of the first relation, if the relations are aligned; else empty.
    rows : tuple of str
        LaTeX of the lines; all but the first continue it.
    """

    left: str
    rows: tuple[str, ...]

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
            *(rf"&{'' if _relates(row) else chr(92) + 'quad '}{row}" for row in rest),
        ]
        return r"\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}"

    @property
    def width(self) -> float:
        """How wide the widest line is, in letters."""
        return width(self.left) + max(width(row) for row in self.rows)


def _relates(row: str) -> bool:
    return row.startswith("=")


def block(printer: Printer, members: Sequence[Expr], room: float = TEXT_WIDTH) -> Block:
    """Break an equation into lines, before a relation or between the terms of a sum.

    Parameters
    ----------
    printer : Printer
    members : sequence of Expr
        The sides of the equation, or one relation.
    room : float
        How wide a line may be, in letters.
    """
    sides = [printer.terms(member) for member in members]
    whole = " = ".join(printer.join(side) for side in sides)
    if width(whole) <= room or (len(members) == 1 and len(sides[0]) == 1):
        return Block("", (whole,))
    first = printer.join(sides[0])
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
            fits = bool(rows) and width(left) + width(rows[-1]) + width(" ".join(pieces)) <= room
            fresh = not rows or (number == 0 and place > 0 and (chained or not (fits or left)))
            if fresh or width(left) + width(rows[-1]) + width(piece) + 1 > room:
                rows.append(piece)
            else:
                rows[-1] += " " + piece
    return Block(left, tuple(rows))


# --- how wide --------------------------------------------------------------------------------------------

_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|\S")
_NOTHING = {r"\left", r"\right", r"\displaystyle", r"\mathrm", r"\text", r"\mathbf", r"\bar", r"\,", "'"}
_WIDE = {
    r"\sum": 2.2,
    r"\int": 1.6,
    r"\max": 3.0,
    r"\min": 3.0,
    r"\exp": 2.8,
    r"\ln": 1.8,
    r"\sqrt": 1.4,
    r"\quad": 2.0,
}
_SPACED = {"=", "+", "-", "<", ">", r"\le", r"\ge", r"\ne", r"\cdot"}


@lru_cache(maxsize=4096)
def width(latex: str) -> float:
    r"""How wide LaTeX is printed, roughly, in letters.

    >>> width("a + b") < width(r"a + b + c"), width(r"\frac{a}{b + c}") < width("a + b + c")
    (True, True)
    """
    return _measure(_TOKEN.findall(latex), 0)[0]


def _measure(tokens: list[str], place: int) -> tuple[float, int]:
    """Width of a group, and where it ends."""
    total = 0.0
    while place < len(tokens):
        token = tokens[place]
        place += 1
        if token == "}":
            return total, place
        if token == r"\frac":
            above, place = _argument(tokens, place)
            below, place = _argument(tokens, place)
            total += max(above, below) + 0.5
        elif token == "{":
            inner, place = _measure(tokens, place)
            total += inner
        elif token in "^_":
            script, place = _argument(tokens, place)
            script *= 0.72
            if place < len(tokens) and tokens[place] in "^_":
                other, place = _argument(tokens, place + 1)
                script = max(script, 0.72 * other)
            total += script
        elif token == r"\begin" or token == r"\end":
            _, place = _argument(tokens, place)
        elif token not in _NOTHING:
            total += _WIDE.get(token, 2.2 if token in _SPACED else 0.7 if token in "()[]|," else 1.0)
    return total, place


def _argument(tokens: list[str], place: int) -> tuple[float, int]:
    if place < len(tokens) and tokens[place] == "{":
        return _measure(tokens, place + 1)
    return 1.0, place + 1


# --- MathML ----------------------------------------------------------------------------------------------

# What latex2mathml leaves to chance: spacing, mostly.
_REPAIRS = tuple(
    (re.compile(pattern), better)
    for pattern, better in (
        # a minus behind a relation or an opening parenthesis is a sign, not an operation
        (
            r'((?:<mo>&#x0003D;</mo>|form="prefix">[^<]*</mo>|<mo[^>]*>&#x00028;</mo>))<mo>&#x02212;</mo>',
            r'\1<mo form="prefix">&#x02212;</mo>',
        ),
        (r"<mo>&#x0002F;</mo>", '<mo lspace="0" rspace="0">&#x0002F;</mo>'),
        (r"<mo>/</mo>", '<mo lspace="0" rspace="0">/</mo>'),
        (
            r"(</m(?:i|n|row|sub|sup|subsup|frac)>)<m([io])>(ln|exp|max|min)</m\2>",
            r'\1<mspace width="0.17em"></mspace><mi>\3</mi>',
        ),
        (r"<mo>(max|min)</mo>", r"<mi>\1</mi>"),
        (r'<mo stretchy="true">&#x000AF;</mo>', '<mo stretchy="false">&#x000AF;</mo>'),
        (r"<mi>&#x0039B;</mi>", '<mi mathvariant="normal">&#x0039B;</mi>'),
    )
)
_UPRIGHT = re.compile(r'(?:<mi mathvariant="normal">[^<&]</mi>){2,}')


@lru_cache(maxsize=4096)
def _converted(latex: str, display: bool) -> str:
    """The inside of the math element."""
    from latex2mathml.converter import convert

    mode = "block" if display else "inline"  # limits above and below, or beside
    # Columns of cases are aligned by CSS; the attribute is not part of MathML Core.
    made = re.sub(r"^<math[^>]*>|</math>$", "", convert(latex, display=mode)).replace(
        ' columnalign="left"', ""
    )
    for pattern, better in _REPAIRS:
        made = pattern.sub(better, made)
    # A word is one name, not a product of letters; a name of several letters is upright by itself.
    return _UPRIGHT.sub(lambda word: f"<mi>{re.sub('<[^>]*>', '', word.group())}</mi>", made)


def mathml(latex: str, display: bool = False) -> Markup:
    """MathML of a formula.

    Parameters
    ----------
    latex : str
        As :class:`~loopsheet.report.document.math.Printer` makes it.
    display : bool
        Whether it stands on a line of its own.
    """
    mode = ' display="block"' if display else ""
    return Markup(f'<math{mode} alttext="{html(latex)}">{_converted(latex, display)}</math>')


def mathml_block(made: Block) -> Markup:
    """MathML of a displayed equation, a row of a table for each of its lines."""
    if len(made.rows) == 1:
        return mathml(made.latex, display=True)
    rows = []
    for place, row in enumerate(made.rows):
        indent = "" if place == 0 or _relates(row) else '<mspace width="2em"></mspace>'
        left = _converted(made.left, True) if place == 0 and made.left else ""
        # An empty group in front makes the sign that begins a line an infix one.
        first = "<mtd>" + left + "</mtd>" if made.left else ""
        rows.append(f"<mtr>{first}<mtd>{indent}<mrow></mrow>{_converted(row, True)}</mtd></mtr>")
    kind = "lines sided" if made.left else "lines"
    table = f'<mtable class="{kind}">{"".join(rows)}</mtable>'
    return Markup(f'<math display="block" alttext="{html(made.latex)}">{table}</math>')
