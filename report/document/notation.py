r"""Notation: the part of LaTeX that names and equations are written in, read into a tree, here alone.

Formats print the tree: MathML, the letters of a worksheet, how wide a line is.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple


class Notation(NamedTuple):
    r"""A piece of notation."""

    kind: str
    """With a text: ``letter``, ``upright`` (a word), ``number``, ``sign``, ``text``, ``space`` (in em). With
    parts: ``row``; ``scripts`` (base, below, above; an empty row is none); ``limits`` (the same, in lines of
    their own where there is room); ``fraction``; ``root``; ``fence`` (the text has both its ends); ``accent``
    (the text is above the part); ``under`` (base, below); ``cases`` and ``line`` (its rows, their cells)."""
    text: str = ""
    parts: tuple[Notation, ...] = ()


NONE = Notation("row")
FUNCTIONS = frozenset({"ln", "exp", "max", "min"})
"""Words that stand apart from the factor before them."""
_TOKEN = re.compile(
    r"\\(?P<style>text|mathrm|mathbf|mathit|operatorname)\s*\{(?P<word>[^{}]*)\}"
    r"|\\begin\{(?P<begin>\w+)\}|\\end\{\w+\}|\\(?P<command>[A-Za-z]+|.)|(?P<number>\d+(?:\.\d+)?)|(?P<other>\S)"
)
_SIGNS = {
    "cdot": "·", "times": "×", "pm": "±", "le": "≤", "leq": "≤", "ge": "≥", "geq": "≥", "ne": "≠", "neq": "≠",
    "approx": "≈", "sum": "∑", "int": "∫", "prod": "∏", "prime": "′", "partial": "∂", "infty": "∞", "to": "→",
    "in": "∈",
}  # fmt: skip
_LETTERS = {
    "epsilon": "ϵ",
    "phi": "ϕ",
    "vartheta": "ϑ",
    "ell": "ℓ",
    "hbar": "ℏ",
    "lambda": "λ",
    "Lambda": "Λ",
}
_SPACES = {",": "0.167", ":": "0.222", ";": "0.278", " ": "0.5", "quad": "1", "qquad": "2", "!": "-0.167"}
_ACCENTS = {"bar": "¯", "overline": "¯", "hat": "^", "tilde": "~", "dot": "˙", "ddot": "¨", "vec": "→"}
_COMBINING = {"¯": "\u0304", "^": "\u0302", "~": "\u0303", "˙": "\u0307", "¨": "\u0308", "→": "\u20d7"}
_LIMITS = frozenset("∑∏")


@lru_cache(maxsize=4096)
def read(latex: str) -> Notation:
    r"""The tree of a formula.

    >>> read("x_{m}").parts[0].kind, plain(read(r"x_{m}'"))
    ('scripts', 'xm′')
    >>> plain(read(r"\sum_{k \in q} x_k"))
    '∑k∈qxk'
    """
    return _Reader(latex).row()


def plain(part: Notation) -> str:
    """Its letters, one after the other."""
    return part.text + "".join(map(plain, part.parts))


def fragments(latex: str) -> list[tuple[str, str]]:
    r"""The letters of a symbol, in pieces: each with ``_``, ``^`` or nothing for its height.

    >>> fragments(r"x_{m_2}"), fragments(r"\bar{\alpha}"), fragments("C'_{(7)}")
    ([('', 'x'), ('_', 'm2')], [('', 'ᾱ')], [('', 'C′'), ('_', '(7)')])
    """
    pieces: list[tuple[str, str]] = []
    for height, text in _letters(read(latex), ""):
        before = pieces.pop()[1] if pieces and pieces[-1][0] == height else ""
        pieces.append((height, unicodedata.normalize("NFC", before + text)))
    return pieces


def _letters(part: Notation, height: str) -> Iterator[tuple[str, str]]:
    if part.kind in {"scripts", "limits"}:
        base, below, above = part.parts
        primes = not set(plain(above)) - set("′″‴")
        yield from _letters(base, height)
        for script, own in ((above, height),) * primes + ((below, "_"),) + ((above, "^"),) * (not primes):
            yield from _letters(script, height or own)
    elif part.kind == "accent":
        yield height, plain(part.parts[0]) + _COMBINING[part.text]
    elif part.parts:
        for inner in part.parts:
            yield from _letters(inner, height)
    elif part.text and part.kind != "space":
        yield height, part.text


class _Reader:
    """Takes tokens from the left."""

    def __init__(self, latex: str) -> None:
        self.tokens = list(_TOKEN.finditer(latex))[::-1]
        self.ended = ""

    def row(self, *ends: str) -> Notation:
        """Everything up to one of these tokens, which is taken."""
        parts: list[Notation] = []
        while self.tokens:
            token = self.tokens.pop()
            text = token.group()
            if text in ends:
                self.ended = text
                break
            if text == "'":
                primes = "′"
                while self.tokens and self.tokens[-1].group() == "'":
                    self.tokens.pop()
                    primes += "′"
                primes = {"′′": "″", "′′′": "‴"}.get(primes, primes)
                parts.append(_scripted(parts, 2, Notation("letter", primes)))
            elif text in {"_", "^"}:
                parts.append(_scripted(parts, 1 + (text == "^"), self.argument()))
            else:
                parts.append(self.part(token))
        return Notation("row", "", tuple(parts))

    def argument(self) -> Notation:
        """What a command or a script takes: a group, or what comes next."""
        made = self.part(self.tokens.pop()) if self.tokens else NONE
        return made.parts[0] if made.kind == "row" and len(made.parts) == 1 else made

    def part(self, token: re.Match[str]) -> Notation:
        """What begins with a token."""
        command, other = token["command"], token["other"]
        if token["style"]:
            word = token["word"].replace("\\_", "_")
            bold = token["style"] == "mathbf" and re.fullmatch("[A-Za-z]", word)
            kind = {"text": "text", "mathit": "letter"}.get(token["style"], "upright")
            letter = unicodedata.lookup(_BOLD[word.islower()] + word.upper()) if bold else word
            return Notation("letter" if bold else kind, letter)
        if token["number"]:
            return Notation("number", token["number"])
        if token["begin"]:
            return self.cases()
        if command is None:
            if other == "{":
                return self.row("}")
            return Notation("letter" if other.isalpha() else "sign", other.replace("-", "−"))
        if command == "left":
            opening = self.tokens.pop().group() if self.tokens else "."
            inside = self.row(r"\right")
            closing = self.tokens.pop().group() if self.tokens else "."
            return Notation("fence", opening[-1] + closing[-1], inside.parts)
        if command in {"frac", "sqrt", "underset"}:
            first = self.argument()
            if command == "sqrt":
                return Notation("root", "", (first,))
            second = self.argument()
            both = (first, second) if command == "frac" else (second, first)
            return Notation("fraction" if command == "frac" else "under", "", both)
        if command in _ACCENTS:
            return Notation("accent", _ACCENTS[command], (self.argument(),))
        if command in _SPACES:
            return Notation("space", _SPACES[command])
        if command in _SIGNS:
            return Notation("letter" if command == "prime" else "sign", _SIGNS[command])
        return _named(command)

    def cases(self) -> Notation:
        """The lines of a distinction of cases."""
        lines: list[Notation] = []
        cells: list[Notation] = []
        while self.tokens:
            cells.append(self.row("&", r"\\", r"\end{cases}"))
            end = self.ended
            if end != "&":
                lines.append(Notation("line", "", tuple(cells)))
                cells = []
            if end == r"\end{cases}":
                break
        return Notation("cases", "", tuple(lines))


_BOLD = ("MATHEMATICAL BOLD CAPITAL ", "MATHEMATICAL BOLD SMALL ")


def _scripted(parts: list[Notation], place: int, script: Notation) -> Notation:
    """The last part with one script more."""
    base = parts.pop() if parts else NONE
    if base.kind in {"scripts", "limits"} and base.parts[place] == NONE:
        return base._replace(parts=tuple(script if n == place else part for n, part in enumerate(base.parts)))
    both = (NONE, script) if place == 2 else (script, NONE)
    return Notation("limits" if base.text in _LIMITS else "scripts", "", (base, *both))


def _named(command: str) -> Notation:
    """A Greek letter, or an upright word."""
    if command in _LETTERS:
        return Notation("letter", _LETTERS[command])
    size = "CAPITAL" if command[0].isupper() else "SMALL"
    try:
        return Notation(
            "letter", unicodedata.lookup(f"GREEK {size} LETTER {command.removeprefix('var').upper()}")
        )
    except KeyError:
        return Notation("upright", command)
