"""TOML with the place of every key and value: tomllib reads it, this module says where things stand."""

from __future__ import annotations

import re
import tomllib
from typing import TYPE_CHECKING, Any, NamedTuple

from ..messages.errors import Location

if TYPE_CHECKING:
    from ..messages.errors import Findings
    from .sources import Source

_KEY = re.compile(r'"(?:\\.|[^"\\])*"|\'[^\']*\'|[A-Za-z0-9_-]+')
_STRING = re.compile(
    r'"""(?:\\[\s\S]|(?!""")[^\\])*"{3,5}'
    r"|'''(?:(?!''')[\s\S])*'{3,5}"
    r'|"(?:\\.|[^"\\])*"'
    r"|'[^']*'"
)
_BARE = re.compile(r"[^,\]}\n#]*")
_SPACE = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_ERROR = re.compile(
    r"(?P<reason>.*) \(at (?:line (?P<line>\d+), column (?P<column>\d+)|end of document)\)", re.S
)
_TWICE = re.compile(r"Cannot declare \((.*)\) twice")
_NAME = r"'([^']*)'"
_PLAIN = re.compile(r"\"[^\"\\\n]*\"|'[^'\n]*'")

_MOST_DOTS = 200
"""In a line: a key a.b.c... of thousands of parts costs tomllib quadratic memory."""

Path = tuple[str, ...]


class _Mark(NamedTuple):
    key: tuple[int, int]
    value: tuple[int, int]


class TomlFile:
    """The data of a TOML file, and where its keys and values stand.

    `source`: the text, which tomllib has accepted. `data`: what tomllib made of it.
    """

    def __init__(self, source: Source, data: dict[str, Any]) -> None:
        self.source = source
        self.data = data
        self._marks: dict[Path, _Mark] = {}
        self.strings: list[tuple[Path | None, int, int]] = []
        """Each with its quotes: the keys that lead to it (None in a list), where it begins, where it ends."""
        _Locator(source.text, self._marks, self.strings).document()

    def key(self, *path: str) -> Location:
        """Return the place of a key, or of the nearest table that holds it."""
        while path and path not in self._marks:
            path = path[:-1]
        return self.source.at(*self._span(self._marks[path].key)) if path else Location(self.source.path)

    def value(self, *path: str, start: int = 0, length: int | None = None) -> Location:
        """Return the place of a value, or of a part of a string if it is written plainly."""
        if path not in self._marks:
            return self.key(*path)
        begin, end = self._marks[path].value
        if length is not None and _PLAIN.fullmatch(self.source.text, begin, end):
            return self.source.at(begin + 1 + start, length)
        return self.source.at(begin, end - begin)

    def trace(self, *path: str) -> str:
        """Return ``file:line:column`` of a value."""
        return self.source.trace(self._marks[path].value[0]) if path in self._marks else self.source.name

    @staticmethod
    def _span(mark: tuple[int, int]) -> tuple[int, int]:
        return mark[0], mark[1] - mark[0]


def read_toml(source: Source, findings: Findings) -> TomlFile | None:
    """Read a TOML file; None, with a finding, if it is none."""
    if any(line.count(".") > _MOST_DOTS for line in source.text.split("\n")):
        findings.add("LS202", Location(source.path))
        return None
    try:
        return TomlFile(source, tomllib.loads(source.text))
    except RecursionError:
        findings.add("LS202", Location(source.path))
    except ValueError as error:  # not only TOMLDecodeError: Python refuses numbers of 5000 digits
        match = _ERROR.fullmatch(str(error))
        at = source.at(len(source.text))
        if match and match["line"]:
            at = _place(source, int(match["line"]), int(match["column"]))
        elif not match:
            at = Location(source.path)
        reason = match["reason"] if match else str(error)
        if twice := _TWICE.fullmatch(reason):
            reason = f"the table [{'.'.join(re.findall(_NAME, twice[1]))}] is there twice"
        findings.add("LS201", at, reason=reason[:1].lower() + reason[1:], suggestion=_advice(at))
    return None


def _place(source: Source, line: int, column: int) -> Location:
    # tomllib counts lines by \n alone and sees \r\n as one character; so does this.
    starts = [0, *(match.end() for match in re.finditer("\n", source.text))]
    return source.at(min(starts[line - 1] + column - 1, len(source.text)))


def _advice(at: Location) -> str:
    line = (at.source or "").strip()
    if re.fullmatch(r"\[[^\[\]]+\]\s*(#.*)?", line):
        return "one table has all of its lines: put those of this one below the first"
    if re.match(r"\[[^\]]*(#.*)?$", line):
        return "close the name of the table: " + re.split(r"\s|#", line)[0] + "]"
    if re.match(r"[A-Za-z_]\w*\s*=\s*[^\s\"'\[{\dtfin+-]", line):
        return "put quotes around text"
    if re.match(r"[A-Za-z_]\w*\s*=\s*[\d.,+\s-]+[A-Za-zµμ%]", line):
        return 'put quotes around a number with its unit, "12.7 mm"'
    if line.count('"') % 2:
        return "close the text with a second quotation mark"
    return ""


class _Locator:
    """Walks through valid TOML and notes where keys and values begin and end."""

    def __init__(
        self, text: str, marks: dict[Path, _Mark], strings: list[tuple[Path | None, int, int]]
    ) -> None:
        self.text = text
        self.marks = marks
        self.strings = strings
        self.position = 0

    def document(self) -> None:
        table: Path = ()
        self.skip()
        while self.position < len(self.text):
            start = self.position
            if self.text[start] == "[":
                while self.text[self.position] in "[ \t":
                    self.position += 1
                begin = self.position
                table, end = self.keys()
                while self.text[self.position : self.position + 1] in {"]", " ", "\t"}:
                    self.position += 1
                self.marks.setdefault(table, _Mark((begin, end), (start, self.position)))
            else:
                self.pair(table)
            self.skip()

    def skip(self) -> None:
        space = _SPACE.match(self.text, self.position)
        self.position = space.end() if space else self.position

    def keys(self) -> tuple[Path, int]:
        """Read a dotted key; return it and where it ends."""
        parts: list[str] = []
        end = self.position
        while True:
            self.skip()
            match = _KEY.match(self.text, self.position)
            if match is None:  # not in valid TOML
                raise AssertionError(self.text[self.position : self.position + 20])
            word = match.group()
            parts.append(tomllib.loads(f"k = {word}")["k"] if word[0] in "\"'" else word)
            end = self.position = match.end()
            self.skip()
            if self.text[self.position : self.position + 1] != ".":
                return tuple(parts), end
            self.position += 1

    def pair(self, table: Path | None) -> None:
        begin = self.position
        keys, end = self.keys()
        self.position += 1  # the equals sign
        self.skip()
        path = None if table is None else table + keys
        start = self.position
        self.value(path)
        if path is not None and table is not None:
            mark = _Mark((begin, end), (start, self.position))
            for depth in range(len(table) + 1, len(path)):
                if depth <= len(table) + 4:  # ours are two levels deep; a key of a thousand dots is no matter
                    self.marks.setdefault(path[:depth], mark)
            self.marks.setdefault(path, mark)

    def value(self, path: Path | None) -> None:
        text = self.text
        string = _STRING.match(text, self.position)
        if string:
            self.strings.append((path, *string.span()))
            self.position = string.end()
        elif text[self.position] in "[{":
            closing = {"[": "]", "{": "}"}[text[self.position]]
            self.position += 1
            self.skip()
            while text[self.position] != closing:
                if closing == "}":
                    self.pair(path)
                else:
                    self.value(None)
                self.skip()
                if text[self.position] == ",":
                    self.position += 1
                    self.skip()
            self.position += 1
        else:
            bare = _BARE.match(text, self.position)
            self.position += len(bare.group().rstrip()) if bare else 0
