"""Units as they are set in HTML and in LaTeX."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from markupsafe import Markup

from ...derivations.unit_text import is_pure, micro
from ..result.numbers import RAISED
from .escape import html, tex

_TOKEN = re.compile(
    r"(?P<name>[^\W\d⁰¹²³⁴⁵⁶⁷⁸⁹]+(?:_\w+)?|[°%])"
    r"|(?P<power>\s*(?:\^|\*\*)\s*(?:\(\s*(?P<enclosed>[^()]+?)\s*\)|(?P<exponent>[+-]?\w+(?:\.\d+)?))"
    r"|(?P<raised>[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+))"
    r"|(?P<over>\s*[/∕]\s*)|(?P<times>\s*[*·⋅×.]\s*|\s+)|(?P<other>.)"
)
_LOWERED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-")


def _tokens(unit: str) -> Iterable[tuple[str, str]]:
    """Parts of a unit: (name, m), (power, 3), (times, ), (over, ), (other, ()."""
    for match in _TOKEN.finditer(unit.strip()):
        kind = match.lastgroup or "other"
        if match["power"]:
            exponent = match["enclosed"] or match["exponent"] or match["raised"]
            yield "power", re.sub(r"\s", "", exponent).translate(_LOWERED).removeprefix("+")
        elif kind == "name":
            yield kind, micro(match["name"])
        else:
            yield kind, match.group()


def unit_html(unit: str, names: Mapping[str, Markup] | None = None) -> Markup:
    """A unit in HTML; `names` says how a name in an exponent is printed.

    >>> print(unit_html("kg/m^3"), unit_html("um"), unit_html("umol/L"))
    kg/m³ µm µmol/L
    """
    if is_pure(unit):
        return Markup("1")
    parts = []
    for kind, text in _tokens(unit):
        if kind == "power" and re.fullmatch(r"-?\d+", text):
            parts.append(Markup(text.translate(RAISED)))
        elif kind == "power":
            parts.append(Markup("<sup>{}</sup>").format((names or {}).get(text, html(text))))
        else:
            parts.append({"times": Markup("\u202f"), "over": Markup("/")}.get(kind, html(text)))
    return Markup("").join(parts)


def unit_tex(unit: str, names: Mapping[str, str] | None = None) -> Markup:
    r"""A unit for siunitx; `names` says how a name in an exponent is printed, in mathematics.

    >>> print(unit_tex("kg/m^3"))
    \unit{kg/m^{3}}
    """
    if is_pure(unit):
        return Markup("1")
    parts = []
    for kind, text in _tokens(unit):
        if kind == "power":
            printed = text if re.fullmatch(r"-?\d+([./]\d+)?", text) else (names or {}).get(text, tex(text))
            parts.append(f"^{{{printed}}}")
        elif kind == "name" and text.isascii() and text.isalpha():
            parts.append(text)
        elif kind == "name" and text[0] == "µ":
            parts.append(rf"\text{{\textmu}}{tex(text[1:])}")
        else:
            parts.append({"times": ".", "over": "/"}.get(kind, rf"\text{{{tex(text)}}}"))
    return Markup(rf"\unit{{{''.join(parts)}}}")
