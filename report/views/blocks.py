"""What a verb tells, in blocks: the same sentences and tables for a terminal and for a pull request."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import ParamSpec

from ..messages.diagnostics import visible
from . import markdown as md

P = ParamSpec("P")


@dataclass(frozen=True)
class Heading:
    """A heading, of the first or of the second level."""

    level: int
    text: str


@dataclass(frozen=True)
class TextTable:
    """Rows of text; a terminal shows no head without words."""

    header: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Snippet:
    """What is typed in somewhere as it is."""

    text: str


Block = Heading | TextTable | Snippet | Sequence[str]
"""The last are sentences, which a terminal shows below one another."""


def _as_text(blocks: Iterable[Block]) -> str:
    """For a terminal and for paper: an empty line between blocks."""
    return "\n\n".join("\n".join(map(visible, lines)) for block in blocks if (lines := _lines(block)))


def _lines(block: Block) -> Sequence[str]:
    match block:
        case Heading(level, text):
            return [text, ("=" if level == 1 else "-") * len(text)]
        case TextTable(header, rows):
            return _aligned([row for row in (header, *rows) if any(row)])
        case Snippet(text):
            return [text]
    return block


def _aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """A table as lines, each column as wide as its widest cell."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(f"{text:{w}}" for text, w in zip(row, widths, strict=True)).rstrip() for row in rows]


def _as_markdown(blocks: Iterable[Block]) -> str:
    """For a pull request or a wiki: each sentence by itself."""
    return "\n\n".join(part for block in blocks for part in _parts(block))


def _parts(block: Block) -> list[str]:
    match block:
        case Heading(level, text):
            return [f"{'#' * level} {md.cell(text)}"]
        case TextTable(header, rows):
            return [md.table(md.told(header), map(md.told, rows)).rstrip()]
        case Snippet(text):
            return [md.code(text)]
    return md.told(block)


def printers(blocks: Callable[P, Iterable[Block]]) -> dict[str, Callable[P, str]]:
    """Both, of what makes blocks of something, by the name of the format."""

    def by(form: Callable[[Iterable[Block]], str]) -> Callable[P, str]:
        def printed(*args: P.args, **named: P.kwargs) -> str:
            return form(blocks(*args, **named))

        return printed

    return {"text": by(_as_text), "markdown": by(_as_markdown)}
