"""A card for a simulation code, for a terminal, for a pull request and for programs."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict

from msgspec import to_builtins

from ..result import card_words as words
from ..result.card import Behaviour, Card, CardRow, Prescribed
from ..result.numbers import for_json
from .blocks import Block, Snippet, TextTable, printers
from .checks import lines
from .json import oddities


def _blocks(card: Card) -> Iterator[Block]:
    """What to type in, what is returned, and what the card misses over the measured speeds."""
    yield [*words.head(card)]
    yield lines(card.oddities)
    yield TextTable(words.TYPED, [*words.typed(card)])
    yield Snippet(card.snippet)
    for header, *rows in ([*words.returned(card)], [*words.rows(card)]):
        yield TextTable(header, rows)
    yield card.notes


def _as_json(card: Card) -> str:
    """All digits; in SI, but for what is typed in."""
    told = {"schema": 1, **asdict(card)}
    told["wanted"], told["returned"] = _named(card.wanted), _named(card.returned)
    told["typed"] = [one._asdict() for one in card.typed]
    told["rows"] = [_named(row) for row in card.rows]
    told["prescribed"] = [_named(each) for each in card.prescribed]
    told["oddities"] = to_builtins(oddities(card.oddities))
    return json.dumps(told, indent=1, ensure_ascii=False)


def _named(values: Behaviour | CardRow | Prescribed) -> dict[str, object]:
    told = values._asdict().items()
    return {name: value if isinstance(value, str) else for_json(value) for name, value in told}


FORMATS: Mapping[str, Callable[[Card], str]] = {**printers(_blocks), "json": _as_json}
"""What renders a card, by the name of the format."""
