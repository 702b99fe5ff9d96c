"""MathML of notation, with no attribute and no group that a browser does not need."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from markupsafe import Markup

from ..document.notation import FUNCTIONS, NONE, Notation, read
from .escape import html
from .typeset import Typeset, relates

_MINUS = Notation("sign", "−")
_BEFORE_SIGN = frozenset("=([{")
_STAND_APART = frozenset({"letter", "upright", "number", "fence", "scripts", "fraction", "cases"})
"""What a function that is a factor keeps its distance from."""
_SCRIPTS = {
    "scripts": ("mrow", "msub", "msup", "msubsup"),
    "limits": ("mrow", "munder", "mover", "munderover"),
}
"""Without any, with one below, with one above, with both."""


def mathml(latex: str, display: bool = False) -> Markup:
    """MathML of a formula; `display` for one on a line of its own."""
    mode = ' display="block"' if display else ""
    return Markup(f"<math{mode}>{_inside(latex, display)}</math>")


def mathml_block(made: Typeset) -> Markup:
    """MathML of a displayed equation, a row of a table for each of its lines."""
    if len(made.rows) == 1:
        return mathml(made.latex, display=True)
    rows = []
    for place, row in enumerate(made.rows):
        indent = "" if place == 0 or relates(row) else '<mspace width="2em"/>'
        left = _inside(made.left, True) if place == 0 and made.left else ""
        # An empty group in front makes the sign that begins a line an infix one.
        first = f"<mtd>{left}</mtd>" if made.left else ""
        rows.append(f"<mtr>{first}<mtd>{indent}<mrow></mrow>{_inside(row, True)}</mtd></mtr>")
    kind = "lines sided" if made.left else "lines"
    return Markup(f'<math display="block"><mtable class="{kind}">{"".join(rows)}</mtable></math>')


@lru_cache(maxsize=4096)
def _inside(latex: str, display: bool) -> str:
    return _row(read(latex).parts, display)


def _row(parts: Sequence[Notation], display: bool = False, opened: bool = False) -> str:
    """Parts in a line; limits stand below and above where it is displayed."""
    printed = []
    before = Notation("sign", "(") if opened else None
    for part in parts:
        own = _part(part, display)
        if before is not None:
            apart = before.kind in _STAND_APART or (before.kind == "limits" and not display)
            if part.kind == "upright" and part.text in FUNCTIONS and apart:
                own = f'<mspace width=".17em"/>{own}'
            if part == _MINUS and before.kind == "sign" and before.text in _BEFORE_SIGN:
                own = '<mo form="prefix">−</mo>'
        printed.append(own)
        before = part
    return "".join(printed)


def _group(part: Notation) -> str:
    """One element: a row of several, and of a lone sign, whose spacing a group changes."""
    parts = part.parts if part.kind == "row" else (part,)
    return _part(parts[0]) if len(parts) == 1 and parts[0].kind != "sign" else f"<mrow>{_row(parts)}</mrow>"


def _part(part: Notation, display: bool = False) -> str:
    text = html(part.text)
    match part.kind:
        case "letter":
            upright = part.text.isupper() and not part.text.isascii() and part.text < "\u2100"
            return f'<mi mathvariant="normal">{text}</mi>' if upright else f"<mi>{text}</mi>"
        case "upright":
            return f"<mi>{text}</mi>" if len(part.text) > 1 else f'<mi mathvariant="normal">{text}</mi>'
        case "number":
            return f"<mn>{text}</mn>"
        case "text":
            return f"<mtext>{text}</mtext>"
        case "space":
            return f'<mspace width="{text}em"/>'
        case "sign":
            how = (
                ' stretchy="false"' if part.text in "()[]|" else ' lspace="0" rspace="0"' * (part.text == "/")
            )
            return f"<mo{how}>{text}</mo>"
        case "row":
            return f"<mrow>{_row(part.parts)}</mrow>"
        case "fence":
            first, last = (f"<mo>{html(end)}</mo>" if end != "." else "" for end in part.text)
            return f"<mrow>{first}{_row(part.parts, opened=True)}{last}</mrow>"
        case "root":
            inside = part.parts[0]
            return f"<msqrt>{_row(inside.parts if inside.kind == 'row' else (inside,))}</msqrt>"
        case "accent":
            return f'<mover>{_group(part.parts[0])}<mo stretchy="false">{text}</mo></mover>'
        case "cases":
            rows = ("".join(f"<mtd>{_row(cell.parts)}</mtd>" for cell in line.parts) for line in part.parts)
            return f"<mrow><mo>{{</mo><mtable>{''.join(f'<mtr>{row}</mtr>' for row in rows)}</mtable></mrow>"
        case "fraction":
            return f"<mfrac>{''.join(map(_group, part.parts))}</mfrac>"
        case "under":
            return f"<munder>{''.join(map(_group, part.parts))}</munder>"
    base, below, above = part.parts
    own = _part(base) if base.kind == "sign" else _group(base)
    tag = _SCRIPTS[part.kind if display else "scripts"][(below != NONE) + 2 * (above != NONE)]
    return f"<{tag}>{own}{''.join(_group(script) for script in (below, above) if script != NONE)}</{tag}>"
