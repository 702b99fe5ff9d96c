"""Foreign text made harmless in HTML and in LaTeX: what it says is shown, what it could do is not done.

A title, a reason, the name of a file come from outside. In both formats every character either appears as
itself or, where the format cannot show it, as its visible code point ``[U+2603]``. Nothing is dropped.
"""

from __future__ import annotations

import re
import unicodedata

from markupsafe import Markup, escape

# What HTML cannot carry (control characters, lone surrogates, non-characters) or what would turn the
# text around it (directional overrides and isolates), and line ends that a parser would change.
_UNFIT = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufdd0-\ufdef\ufffe\uffff"
    + "".join(chr(plane << 16 | last) for plane in range(1, 17) for last in (0xFFFE, 0xFFFF))
    + "]"
)


def visible(text: str) -> str:
    r"""Write what no page can carry as its code point; line ends become spaces.

    >>> visible("a\x07b")
    'a[U+0007]b'
    """
    plain = re.sub("\r\n|[\r\n\t\x0b\x0c]", " ", text)
    return _UNFIT.sub(lambda found: f"[U+{ord(found.group()):04X}]", plain)


def html(text: object) -> Markup:
    """Escape text for HTML, in an element as well as in a quoted attribute.

    >>> html("<b> & 'c'")
    Markup('&lt;b&gt; &amp; &#39;c&#39;')
    """
    return text if isinstance(text, Markup) else escape(visible(str(text)))


# --- LaTeX -----------------------------------------------------------------------------------------------

_TEX = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "_": r"\_",
    "%": r"\%",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "`": r"\textasciigrave{}",
    "'": r"\textquotesingle{}",
    "\u00a0": "~",
    "\u202f": r"\,",
    "\u2009": r"\,",
    "\u2007": r"\phantom{0}",
    "\u2032": r"\texorpdfstring{\ensuremath{'}}{'}",
    "\u2033": r"\texorpdfstring{\ensuremath{''}}{''}",
}
_GREEK = "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi omicron pi rho"
_LOWER = [*_GREEK.split(), "", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega"]
_UPPER = {
    name: 0x391 + place
    for place, name in enumerate(_LOWER)
    if name in {"gamma", "delta", "theta", "lambda", "xi", "pi", "sigma", "phi", "psi", "omega"}
}
_SYMBOLS = {
    **{chr(0x3B1 + place): rf"\{name}" for place, name in enumerate(_LOWER) if name not in ("", "omicron")},
    **{chr(code): rf"\{name.capitalize()}" for name, code in _UPPER.items()},
    "\u2212": "-",
    "≤": r"\le",
    "≥": r"\ge",
    "≠": r"\ne",
    "≈": r"\approx",
    "∞": r"\infty",
    "∈": r"\in",
    "√": r"\surd",
    "∑": r"\sum",
    "∫": r"\int",
    "·": r"\cdot",
    "⋅": r"\cdot",
    "×": r"\times",
    "÷": r"\div",
    "±": r"\pm",
    "¬": r"\neg",
    "→": r"\to",
    "←": r"\gets",
    "⁻": "{}^{-}",
    "⁰": "{}^{0}",
    **{chr(0x2070 + digit): f"{{}}^{{{digit}}}" for digit in range(4, 10)},
    **{chr(0x2080 + digit): f"{{}}_{{{digit}}}" for digit in range(10)},
}
# Two of them would be drawn as one sign, -- as an en dash and ,, as a low quotation mark. What follows a text
# is not known here, so behind the last one something stands, too.
_DOUBLED = re.compile(r"([-,])(?=\1|$)")
# Behind the end of a row, or \item, these would be taken for what it asks for.
_FIRST = re.compile(r"^(?=\s*[\[*])")
# What the T1 and TS1 encodings of every LaTeX since 2020 hold, so that pdflatex prints it.
_PRINTABLE = frozenset(
    {chr(code) for code in range(0x20, 0x7F)}
    | {
        chr(code)
        for code in range(0xA1, 0x17F)
        if code not in {0xAD, 0x126, 0x127, 0x138, 0x13F, 0x140, 0x149, 0x166, 0x167}
    }
    | set("ȘșȚțẞ–—‘’‚“”„†‡•…‰‹›€№™")
)


def tex(text: object) -> Markup:
    r"""Escape text for LaTeX, in running text, in a table and in the title of the document.

    >>> print(tex("50 % of $x_1$"))
    50 \% of \$x\_1\$
    """
    if isinstance(text, Markup):
        return text
    plain = unicodedata.normalize("NFC", visible(str(text)))
    return Markup(_FIRST.sub("{}", _DOUBLED.sub(r"\1{}", "".join(map(_one, plain)))))


def _one(character: str) -> str:
    if character in _TEX:
        return _TEX[character]
    if character in _SYMBOLS:
        # In the title of the PDF there is no mathematics: the name of the symbol stands for it.
        name = unicodedata.name(character).split()[-1].lower()
        return rf"\texorpdfstring{{\ensuremath{{{_SYMBOLS[character]}}}}}{{{name}}}"
    if character in _PRINTABLE:
        return character
    plain = unicodedata.normalize("NFKC", character)
    if plain != character and all(c in _PRINTABLE for c in plain):
        return "".join(_one(c) for c in plain)
    return f"[U+{ord(character):04X}]"
