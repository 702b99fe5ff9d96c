"""A card for a simulation code, for a terminal, for a pull request and for programs."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict

from msgspec import to_builtins

from ..result.card import Behaviour, Card, CardRow
from . import markdown as md
from .budget import aligned, number
from .checks import lines
from .json import oddities

__all__ = ["FORMATS", "as_json", "as_markdown", "as_text"]

_TYPED = ("parameter", "value", "unit", "what it is")


def _head(card: Card) -> Iterator[str]:
    yield f"{card.title}, for '{card.of}' at {card.speed:.4g} m/s, reduced mass {card.mass:.6g} kg"
    yield card.formula
    yield f"version: {card.version}"
    yield from (f"source: {source}" for source in card.sources)


def _typed(card: Card) -> Iterator[list[str]]:
    for one in card.typed:
        yield [one.word, f"{one.value:.9g}", one.unit, one.meaning + (", solved for" if one.solved else "")]


def _returned(card: Card) -> Iterator[list[str]]:
    """What was measured, or is on the identified curve, beside what the formula returns."""
    wanted, returned = card.wanted, card.returned
    yield ["", "measured", "returned"]
    yield ["e", f"{wanted.e:.6g}", f"{returned.e:.6g}"]
    yield ["imprint", _metres(wanted.imprint), _metres(returned.imprint)]
    yield ["greatest approach", f"{_metres(wanted.approach)}, by the curve", _metres(returned.approach)]
    yield ["greatest force", "", f"{returned.force:.5g} N"]
    yield ["contact time", "", f"{returned.duration:.5g} s"]


def _metres(value: float) -> str:
    return f"{value:.5g} m" if value == value else "not known"


def _rows(card: Card) -> Iterator[list[str]]:
    yield ["v [m/s]", "e measured", "e by this card", *(["e if e is typed in"] if card.takes_e else [])]
    for row in card.rows:
        typed = [] if row.typed is None else [f"{row.typed:.4f}"]
        yield [f"{row.speed:.4g}", f"{row.measured:.4f}", f"{row.by_card:.4f}", *typed]


def as_text(card: Card) -> str:
    """What to type in, what is returned, and what the card misses over the measured speeds."""
    typed = aligned([list(_TYPED), *_typed(card)])
    returned, rows = aligned([*_returned(card)]), aligned([*_rows(card)])
    parts = [[*_head(card)], lines(card.oddities), typed, [card.snippet], returned, rows, card.notes]
    return "\n\n".join("\n".join(part) for part in parts if part)


def as_markdown(card: Card) -> str:
    """The same for a pull request."""
    head = "\n\n".join(map(md.cell, (*_head(card), *lines(card.oddities))))
    tables = [[list(_TYPED), *_typed(card)], [*_returned(card)], [*_rows(card)]]
    typed, returned, rows = (
        md.table([md.cell(text) for text in first], ([md.cell(text) for text in row] for row in others))
        for first, *others in tables
    )
    said = "".join(f"\n{md.cell(note)}\n" for note in card.notes)
    return f"{head}\n\n{typed}\n{md.code(card.snippet)}\n\n{returned}\n{rows}{said}".rstrip()


def as_json(card: Card) -> str:
    """All digits; in SI, but for what is typed in."""
    told = {"schema": 1, **asdict(card)}
    told["wanted"], told["returned"] = _named(card.wanted), _named(card.returned)
    told["typed"] = [one._asdict() for one in card.typed]
    told["rows"] = [_named(row) for row in card.rows]
    told["oddities"] = to_builtins(oddities(card.oddities))
    return json.dumps(told, indent=1, ensure_ascii=False)


def _named(values: Behaviour | CardRow) -> dict[str, object]:
    return {name: number(value) for name, value in values._asdict().items()}


FORMATS: Mapping[str, Callable[[Card], str]] = {
    "text": as_text,
    "markdown": as_markdown,
    "json": as_json,
}
"""What renders a card, by the name of the format."""
