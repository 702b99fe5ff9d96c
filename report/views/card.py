"""A card for a simulation code, for a terminal, for a pull request and for programs."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict

from msgspec import to_builtins

from ..result import card_words as words
from ..result.card import Behaviour, Card, CardRow, Prescribed
from . import markdown as md
from .budget import aligned, number
from .checks import lines
from .json import oddities

__all__ = ["FORMATS", "as_json", "as_markdown", "as_text"]


def as_text(card: Card) -> str:
    """What to type in, what is returned, and what the card misses over the measured speeds."""
    typed = aligned([list(words.TYPED), *words.typed(card)])
    returned, rows = aligned([*words.returned(card)]), aligned([*words.rows(card)])
    parts = [[*words.head(card)], lines(card.oddities), typed, [card.snippet], returned, rows, card.notes]
    return "\n\n".join("\n".join(part) for part in parts if part)


def as_markdown(card: Card) -> str:
    """The same for a pull request."""
    head = "\n\n".join(map(md.cell, (*words.head(card), *lines(card.oddities))))
    tables = [words.TYPED, *words.typed(card)], words.returned(card), words.rows(card)
    told = (map(md.told, rows) for rows in tables)
    typed, returned, rows = (md.table(header, others) for header, *others in told)
    said = "".join(f"\n{md.cell(note)}\n" for note in card.notes)
    return f"{head}\n\n{typed}\n{md.code(card.snippet)}\n\n{returned}\n{rows}{said}".rstrip()


def as_json(card: Card) -> str:
    """All digits; in SI, but for what is typed in."""
    told = {"schema": 1, **asdict(card)}
    told["wanted"], told["returned"] = _named(card.wanted), _named(card.returned)
    told["typed"] = [one._asdict() for one in card.typed]
    told["rows"] = [_named(row) for row in card.rows]
    told["prescribed"] = [_named(each) for each in card.prescribed]
    told["oddities"] = to_builtins(oddities(card.oddities))
    return json.dumps(told, indent=1, ensure_ascii=False)


def _named(values: Behaviour | CardRow | Prescribed) -> dict[str, object]:
    return {name: number(value) for name, value in values._asdict().items()}


FORMATS: Mapping[str, Callable[[Card], str]] = {
    "text": as_text,
    "markdown": as_markdown,
    "json": as_json,
}
"""What renders a card, by the name of the format."""
