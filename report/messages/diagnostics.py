"""A finding about what the user gave, and how it is shown: the line, a caret, what to try."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, TextIO

_TAB = 4
_BEFORE = 40
"""Terminal columns kept before the caret when a line is too long to be shown whole."""
_WIDEST = 100
"""Terminal columns of a source line at most."""
_HIDDEN = frozenset({"Cc", "Cf", "Cn", "Co", "Cs", "Zl", "Zp"})
"""Unicode categories that steer a terminal (or turn its text around) or have no glyph to show."""
_MOST = 40
"""Findings that are shown."""


@dataclass(frozen=True)
class Location:
    """A place in a file."""

    path: str = ""
    """The file, as the user would write it."""
    line: int | None = None
    column: int | None = None
    """`line` and `column`: counted from 1, in characters; None where the finding is about the whole file."""
    length: int = 1
    """How many characters of the line the finding is about."""
    source: str | None = None
    """The line itself."""

    def __str__(self) -> str:
        """Say ``file:line:column``."""
        return ":".join([self.path, *(str(n) for n in (self.line, self.column) if n is not None)])


@dataclass(frozen=True)
class Diagnostic:
    """One finding: a stable code, a sentence, a place, what was allowed and what to try."""

    code: str
    """The key of :data:`loopsheet.report.messages.catalogue.CATALOGUE`; it never changes its meaning."""
    message: str
    """What happened."""
    at: Location = Location()
    """Where."""
    allowed: str = ""
    hint: str = ""
    """`allowed` and `hint`: what was allowed, and what to try; empty where there is nothing to say."""

    @property
    def order(self) -> tuple[str, int, int, str]:
        """The sorting key: file, line, column, code."""
        return (self.at.path, self.at.line or 0, self.at.column or 0, self.code)


@dataclass(frozen=True)
class Check:
    """One thing that is as expected, or is not."""

    kind: str
    """``proof``, ``engine``, ``published``, ...: what is checked."""
    name: str
    """What it is about: ``(11)``, ``numpy``, ``alpha[1-2]``; no two of a kind have the same."""
    passed: bool
    """Whether it is as expected."""
    message: str
    """What was found, in a sentence that names it."""
    at: Location = Location()
    """Where the user wrote what was checked; the report.toml if it was nowhere written."""
    skipped: bool = False
    """It could not be checked, and nothing is wrong: a program is not installed."""
    note: str = ""
    """As what it is told although it passed: ``warning``, ``expected``; nothing fails because of it."""

    @property
    def word(self) -> str:
        """As what it is told: ``finding``, ``warning``, ``expected``; nothing if there is nothing to tell."""
        return self.note if self.passed else "finding"

    @property
    def sentence(self) -> str:
        """The message after its place, if that is a line of a file."""
        return visible(self.message if self.at.line is None else f"{self.at}: {self.message}")


def visible(text: str) -> str:
    r"""Write control characters as escapes, so that foreign text cannot steer a terminal.

    >>> print(visible("a\x1b[2Jb\u202ec"))
    a\x1b[2Jb\u202ec
    """
    return text if text.isascii() and text.isprintable() else "".join(map(_visible_character, text))


def _visible_character(character: str) -> str:
    if unicodedata.category(character) not in _HIDDEN:
        return character
    code = ord(character)
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


class VisibleStream:
    """A stream that writes what :func:`visible` makes of each line: all that is printed goes through one."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write text, and tell how much of it was taken: all."""
        self._stream.write("\n".join(map(visible, text.split("\n"))))
        return len(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def render(diagnostic: Diagnostic, color: bool = False) -> str:
    """Show one finding as a compiler does.

    Parameters
    ----------
    diagnostic : Diagnostic
        The finding.
    color : bool
        Whether to add ANSI colours.

    Returns
    -------
    str
        Several lines without a final newline; no control characters but newlines and our own colours.
    """
    red, blue, plain = ("\x1b[1;31m", "\x1b[1;34m", "\x1b[0m") if color else ("", "", "")
    at = diagnostic.at
    number = "" if at.line is None else str(at.line)
    margin = " " * max(len(number), 1)
    lines = [f"{red}error[{diagnostic.code}]{plain}: {visible(diagnostic.message)}"]
    if at.path:
        lines.append(f"{margin} {blue}-->{plain} {visible(str(at))}")
    if at.source is not None and at.column is not None:
        shown, before, width = _frame(at.source, at.column, at.length)
        lines.append(f"{margin}  {blue}|{plain}")
        lines.append(f" {blue}{number} |{plain} {shown}".rstrip())
        lines.append(f"{margin}  {blue}|{plain} {' ' * before}{red}{'^' * width}{plain}")
    for word, text in (("allowed", diagnostic.allowed), ("help", diagnostic.hint)):
        if text:
            lines.append(f"{margin}  {blue}={plain} {word}: {visible(text)}")
    return "\n".join(lines)


def render_all(diagnostics: Iterable[Diagnostic], color: bool = False) -> str:
    """Show findings one after another with a line that counts them; past the limit they are only counted."""
    found = list(diagnostics)
    shown = [render(diagnostic, color) for diagnostic in found[:_MOST]]
    count = "1 error" if len(found) == 1 else f"{len(found)} errors"
    rest = f" ({len(found) - _MOST} of them not shown)" if len(found) > _MOST else ""
    return "\n\n".join([*shown, f"{count}{rest}"])


def _frame(source: str, column: int, length: int) -> tuple[str, int, int]:
    """Return what is shown of a line, and where its carets begin and how many they are."""
    first = column - 1
    # One character takes at most ten columns (as an escape) and may take none (a combining mark), so
    # this slice is enough for any window, however long the line is.
    skip = max(0, first - 4 * _BEFORE)
    cells = list(_cells(source[skip : first + 4 * _WIDEST]))
    first -= skip
    begin, before = first, 0
    if sum(width for _, width in cells) <= _WIDEST and skip == 0 and len(source) <= first + 4 * _WIDEST:
        begin, before = 0, sum(width for _, width in cells[:first])
    else:
        while begin > 0 and before + cells[begin - 1][1] <= _BEFORE:
            begin -= 1
            before += cells[begin][1]
    end, taken = begin, 0
    while end < len(cells) and taken + cells[end][1] <= _WIDEST:
        taken += cells[end][1]
        end += 1
    marked = sum(width for _, width in cells[first : min(end, first + length)])
    left = "..." if skip + begin > 0 else ""
    right = "..." if end < len(cells) or skip + end < len(source) else ""
    shown = "".join(text for text, _ in cells[begin:end])
    # A caret past the end of the line shows where something is missing.
    before += max(0, first - len(cells))
    return left + shown + right, len(left) + before, max(marked, 1)


def _cells(text: str) -> Iterator[tuple[str, int]]:
    """Yield what is shown of each character and how many terminal columns that takes."""
    column = 0
    for character in text:
        shown, width = character, 1
        if character == "\t":
            width = _TAB - column % _TAB
            shown = " " * width
        elif not (character.isascii() and character.isprintable()):
            shown = _visible_character(character)
            if shown != character:
                width = len(shown)
            elif unicodedata.category(character) in {"Mn", "Me"}:
                width = 0
            elif unicodedata.east_asian_width(character) in {"W", "F"}:
                width = 2
        column += width
        yield shown, width
