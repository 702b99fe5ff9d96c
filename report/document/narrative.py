"""Narratives: Markdown files under templates/prose that become the blocks of a document.

Besides Markdown's paragraphs, headings (``# Title {#name}``), lists, notes (``>``), ``**strong**``, code and
links to chapters (``[text](#name)``) they have

- roles, ``{role}`argument` ``: what a report has of that name (:mod:`~loopsheet.report.document.said`). One
  that is alone in its paragraph is shown there: a table, a figure, an equation;
- conditions: lines between ``:::{if} {role}`argument` `` and ``:::`` are there if all roles named stand for
  something, those behind ``:::{else}`` if not. They may lie inside a paragraph: each line holds sentences;
- ``:::{include} NAME``: the lines of parts/NAME.md;
- ``:::{told} NAME``: what the workbook itself has to say there, which may be nothing.

A line that begins with a comma, a semicolon or a full stop goes on with the word before it. In the place of a
line that shows a cell without a value stands which of its cells have none, and why: such lines are whole
sentences. Nothing of a narrative is evaluated.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .said import Answer, Said, UnknownName
from .tree import Block, Blocks, Code, Inlines, Items, Link, Note, Paragraph, Section, Strong

if TYPE_CHECKING:
    from markdown_it.token import Token

FOLDER = Path(__file__).resolve().parents[2] / "templates" / "prose"

_MARKDOWN = ["heading", "list", "blockquote", "emphasis", "backticks", "link", "newline"]
_NAMED = re.compile(r"\{(\w+)\}`([^`]*)`")
_TELLS = re.compile(r"\{(?:cell|count|eq|inside|published)\}`([^`]*)`")
_HEADING = re.compile(r"(?P<title>.*?) *\{#(?P<name>[\w-]+)(?P<issued> \.issued)?\}")


class NarrativeError(ValueError):
    """A narrative says something that cannot be understood."""


class Line(NamedTuple):
    """A line of a narrative and where it stands."""

    text: str
    place: str


def narratives() -> dict[str, list[str]]:
    """The narratives that a workbook may name, with the cells, axes and equations that each tells of."""
    names = sorted(path.stem for path in FOLDER.glob("*.md"))
    return {name: sorted(_told("\n".join(line.text for line in _lines(name)))) for name in names}


def _told(text: str) -> set[str]:
    return {word for found in _TELLS.findall(text) for word in found.split()}


def sections(name: str, said: Said) -> tuple[Section, ...]:
    """The chapters of a narrative.

    Parameters
    ----------
    name : str
        One of :func:`narratives`.
    said : Said
        What its roles stand for.

    Raises
    ------
    NarrativeError
        It names something unknown, or a condition does not end; the message says in which line.
    """
    return _Reader(said, name).sections()


@lru_cache(maxsize=16)
def _lines(name: str) -> tuple[Line, ...]:
    text = (FOLDER / f"{name}.md").read_text(encoding="utf-8")
    found: list[Line] = []
    for number, line in enumerate(text.splitlines(), start=1):
        place = f"prose/{name}.md:{number}"
        if included := re.fullmatch(r":::\{include\} (\w+)", line):
            if not (FOLDER / "parts" / f"{included[1]}.md").is_file():
                raise NarrativeError(f"{place}: there is no prose/parts/{included[1]}.md")
            found += _lines(f"parts/{included[1]}")
        else:
            found.append(Line(line, place))
    return tuple(found)


class _Reader:
    """Reads one narrative for one report."""

    def __init__(self, said: Said, name: str) -> None:
        from markdown_it import MarkdownIt

        self.said = said
        self.lines = list(self._kept(_lines(name)))
        text = "\n".join(line.text for line in self.lines)
        self.tokens = MarkdownIt("zero").enable(_MARKDOWN).parse(text)

    def _kept(self, lines: Sequence[Line]) -> Iterator[Line]:
        """The lines whose conditions hold."""
        open_ones: list[tuple[bool, Line]] = []
        for line in lines:
            word = line.text.strip() if line.text.startswith(":::") else ""
            if word.startswith(":::{if} "):
                holds = all(holds for holds, _ in open_ones) and self._hold(word, line.place)
                open_ones.append((holds, line))
            elif word in (":::{else}", ":::") and not open_ones:
                raise NarrativeError(f"{line.place}: nothing is open that {word} could belong to")
            elif word == ":::{else}":
                open_ones[-1] = (not open_ones[-1][0], line)
            elif word == ":::":
                open_ones.pop()
            elif word.startswith(":::{told} "):
                told = self.said.report.workbook.told.get(word.removeprefix(":::{told} "), "")
                if all(holds for holds, _ in open_ones):
                    yield from self._kept([Line(text, line.place) for text in told.splitlines()])
            elif word:
                known = ":::{if}, :::{else}, :::{include}, :::{told} and :::"
                raise NarrativeError(f"{line.place}: unknown line {word}; there are {known}")
            elif all(holds for holds, _ in open_ones):
                yield self._valued(line)
        if open_ones:
            raise NarrativeError(f"{open_ones[-1][1].place}: this condition does not end")

    def _valued(self, line: Line) -> Line:
        """The line; if it shows cells without a value, one that says so."""
        cells = (name for role, name in _NAMED.findall(line.text) if role == "cell")
        lacking = [name for name in cells if not self._answer("cell", name, line.place)]
        return line._replace(text=f"{{lacking}}`{' '.join(lacking)}`") if lacking else line

    def _hold(self, condition: str, place: str) -> bool:
        """Whether all roles of a condition stand for something."""
        asked = _NAMED.findall(condition)
        if not asked:
            raise NarrativeError(f"{place}: a condition is ':::{{if}} {{role}}`argument`'")
        return all(self._answer(role, argument, place) for role, argument in asked)

    def _answer(self, role: str, argument: str, place: str, alone: bool = False) -> Answer:
        roles = self.said.roles
        if role not in roles:
            raise NarrativeError(f"{place}: no role is called {{{role}}}; there are {', '.join(roles)}")
        try:
            return ((alone and roles[role].alone) or roles[role].inline)(argument)
        except UnknownName as error:
            raise NarrativeError(f"{place}: {error}") from error

    # --- blocks

    def sections(self) -> tuple[Section, ...]:
        """The chapters: a heading and all blocks up to the next."""
        found: list[Section] = []
        for block in self._blocks():
            if isinstance(block, Section):
                found.append(block)
            else:
                found[-1] = replace(found[-1], blocks=(*found[-1].blocks, block))
        return tuple(found)

    def _blocks(self) -> Iterator[Block]:
        around = ""
        items: list[Inlines] = []
        for token in self.tokens:
            if token.type == "inline":
                first = (token.map or [0])[0]
                if around == "heading_open":
                    yield self._heading(token.content, first)
                elif around == "blockquote_open":
                    yield Note(self._inlines(token, first))
                elif around == "bullet_list_open":
                    items.append(self._inlines(token, first))
                else:
                    yield from self._paragraph(token, first)
            elif token.type in ("heading_open", "blockquote_open", "bullet_list_open"):
                around = token.type
            elif token.type == "bullet_list_close":
                yield Items(tuple(items))
                items, around = [], ""
            elif token.type in ("heading_close", "blockquote_close"):
                around = ""

    def _heading(self, text: str, line: int) -> Section:
        found = _HEADING.fullmatch(text)
        if found is None:
            raise NarrativeError(f"{self.lines[line].place}: a heading is '# Title {{#name}}'")
        return Section(found["name"], found["title"], (), found["issued"] is not None)

    def _paragraph(self, token: Token, line: int) -> Blocks:
        alone = _NAMED.fullmatch(token.content)
        if alone is None:
            return (Paragraph(self._inlines(token, line)),)
        answer = self._said(alone[1], alone[2], line, alone=True)
        if answer and isinstance(answer[0], Block):
            return tuple(answer)
        return (Paragraph(answer),) if answer else ()

    # --- inlines

    def _inlines(self, token: Token, line: int) -> Inlines:
        runs: list[tuple[str, list[Any]]] = [("", [])]
        for part in token.children or ():
            inlines = runs[-1][1]
            if part.type == "softbreak":
                line += 1
                inlines.append(" ")
            elif part.type == "code_inline":
                before = inlines[-1] if inlines and isinstance(inlines[-1], str) else ""
                role = re.search(r"\{(\w+)\}$", before)
                if role is None:
                    inlines.append(Code(part.content))
                else:
                    inlines[-1:] = before[: role.start()], *self._said(role[1], part.content, line)
            elif part.type == "text":
                if part.content[:1] in {",", ";", "."} and inlines and inlines[-1] == " ":
                    inlines.pop()
                inlines.append(part.content)
            elif part.nesting == 1:
                runs.append((str(part.attrs.get("href", "")), []))
            else:
                target, content = runs.pop()
                link = target.removeprefix("#")
                runs[-1][1].append(Link("section", link, tuple(content)) if link else Strong(tuple(content)))
        return tuple(one for one in runs[0][1] if one != "")

    def _said(self, role: str, argument: str, line: int, alone: bool = False) -> Any:
        place = self.lines[line].place
        answer = self._answer(role, argument, place, alone)
        if isinstance(answer, bool):
            raise NarrativeError(f"{place}: {{{role}}}`{argument}` is a condition: there is nothing to show")
        return answer
