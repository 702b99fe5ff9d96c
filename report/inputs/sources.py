"""Files of a report folder as text with places: read once, checked, and never followed out of the folder."""

from __future__ import annotations

import re
import stat
from bisect import bisect_right
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from ..messages.errors import Location, suggest

if TYPE_CHECKING:
    from ..messages.errors import Findings

_NEWLINE = re.compile(r"\r\n|\n|\r")
_CONTROL = re.compile("[\x01-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ufffe\uffff]")

_SPREADSHEETS = {
    b"PK\x03\x04": "a spreadsheet (.xlsx or .ods) or another archive",
    b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1": "a spreadsheet (.xls) or another Office document",
}
"""What files begin with that come from a spreadsheet as it saves them."""


class Source:
    """The text of a file, and the line and column of every character of it.

    Parameters
    ----------
    path : str
        The file as the user would write it, for messages.
    name : str
        The file relative to the folder, for tracing.
    text : str
        The text, without a byte order mark.
    """

    def __init__(self, path: str, name: str, text: str) -> None:
        self.path = path
        self.name = name
        self.text = text
        breaks = [match.span() for match in _NEWLINE.finditer(text)]
        self._starts = [0, *(end for _, end in breaks)]
        self._ends = [*(start for start, _ in breaks), len(text)]
        self._lines: dict[int, str] = {}

    def line_end(self, offset: int) -> int:
        """Return where the line of a character ends, before its line break."""
        return self._ends[self._line(offset)]

    def next_line(self, offset: int) -> int:
        """Return where the next line begins; past the end if there is none."""
        line = self._line(offset) + 1
        return self._starts[line] if line < len(self._starts) else len(self.text) + 1

    def at(self, offset: int, length: int = 1) -> Location:
        """Return the place of some characters, of which only those of the first line count."""
        line = self._line(offset)
        start, end = self._starts[line], self._ends[line]
        if line not in self._lines:  # shared: a long line with many findings is held once
            self._lines[line] = self.text[start:end]
        inside = max(1, min(length, end - offset))
        return Location(self.path, line + 1, offset - start + 1, inside, self._lines[line])

    def trace(self, offset: int) -> str:
        """Return ``file:line:column`` relative to the folder."""
        line = self._line(offset)
        return f"{self.name}:{line + 1}:{offset - self._starts[line] + 1}"

    def _line(self, offset: int) -> int:
        return bisect_right(self._starts, offset) - 1


def read_bytes(
    folder: Path, name: str, limit: int, findings: Findings, asked: Location | None = None
) -> bytes | None:
    """Read a file of the folder; None, with a finding, if it cannot or must not be read.

    Parameters
    ----------
    folder : Path
        The report folder.
    name : str
        The file, relative to it, with forward slashes.
    limit : int
        The largest size, in bytes.
    findings : Findings
        Where findings go.
    asked : Location, optional
        Where the user wrote the name.
    """
    path = folder / name
    at = asked or Location(path.as_posix())
    if "\\" in name or ":" in name or PurePosixPath(name).is_absolute() or ".." in PurePosixPath(name).parts:
        findings.add("LS107", at, text=name)
        return None
    try:
        # A link may stay inside the folder; one that leads out would make the report unrepeatable
        # elsewhere, and would show a stranger's folder to be able to quote any file of this machine.
        if not path.resolve().is_relative_to(folder.resolve()):
            findings.add("LS107", at, text=name)
            return None
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):  # a pipe would wait for ever
            findings.add("LS105", at, text=name)
            return None
        size = status.st_size
        if size <= limit:
            with path.open("rb") as file:
                data = file.read(limit + 1)
            if len(data) <= limit:
                return data
            size = len(data)
        findings.add("LS108", at, text=name, size=f"{size:,}", limit=f"{limit:,}")
    except PermissionError as error:
        findings.add("LS106", at, text=name, reason=error.strerror)
    except (OSError, ValueError, RuntimeError):  # also names too long, with a NUL, or a ring of links
        built = "'loopsheet build' of its folder writes it" if path.name == "values.json" else ""
        findings.add("LS104", at, text=name, suggestion=suggest(name, _siblings(path)) or built)
    return None


def _siblings(path: Path) -> list[str]:
    try:
        return sorted(other.name for other in path.parent.iterdir())
    except (OSError, ValueError):
        return []


def open_source(path: str, name: str, data: bytes, wanted: str, findings: Findings) -> Source | None:
    """Decode a file; None, with a finding, if it is not text.

    Parameters
    ----------
    path, name : str
        As for :class:`Source`.
    data : bytes
        The file.
    wanted : str
        What an empty file should have held.
    findings : Findings
        Where findings go.
    """
    for magic, kind in _SPREADSHEETS.items():
        if data.startswith(magic):
            findings.add("LS113", Location(path), kind=kind)
            return None
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        at = _byte_location(path, data, error.start)
        findings.add("LS109", at, offset=error.start + 1, byte=f"{data[error.start]:02x}")
        return None
    if b"\0" in data:
        offset = data.index(b"\0")
        findings.add("LS110", _byte_location(path, data, offset), offset=offset + 1)
        return None
    source = Source(path, name, text.removeprefix("\ufeff"))
    if not source.text.strip():
        findings.add("LS111", Location(path), allowed=wanted)
        return None
    control = _CONTROL.search(source.text)
    if control:
        findings.add("LS112", source.at(control.start()), text=f"U+{ord(control.group()):04X}")
        return None
    return source


def _byte_location(path: str, data: bytes, offset: int) -> Location:
    """Return the place of a byte in a file that is not text."""
    begin = max(data.rfind(b"\n", 0, offset), data.rfind(b"\r", 0, offset)) + 1
    ends = [end for end in (data.find(b"\n", offset), data.find(b"\r", offset)) if end >= 0]
    before = data[begin:offset].decode("utf-8", "replace")
    after = data[offset : min([*ends, len(data)])].decode("utf-8", "replace")
    head = data[:begin]
    line = head.count(b"\n") + head.count(b"\r") - head.count(b"\r\n") + 1
    return Location(path, line, len(before) + 1, 1, before + after)
