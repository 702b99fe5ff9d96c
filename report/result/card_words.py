"""What a card says, in words: the same on a terminal, in a report and in a workbook."""

from __future__ import annotations

from collections.abc import Iterator

from .card import Card

TYPED = ("parameter", "value", "unit", "what it is")
"""The head of what is typed in."""


def head(card: Card) -> Iterator[str]:
    """What it is for, its formula, and where that stands."""
    yield f"{card.title}, for '{card.of}' at {card.speed:.4g} m/s, reduced mass {card.mass:.6g} kg"
    yield card.formula
    yield from sources(card)


def sources(card: Card) -> Iterator[str]:
    """The version that was read, and where the formula stands in it."""
    if card.version:
        yield f"version: {card.version}"
    yield from (f"source: {source}" for source in card.sources)


def typed(card: Card) -> Iterator[list[str]]:
    """What is typed in."""
    for one in card.typed:
        yield [one.word, f"{one.value:.9g}", one.unit, one.meaning + (", solved for" if one.solved else "")]


def returned(card: Card) -> Iterator[list[str]]:
    """What was measured, or is on the identified curve, beside what the formula returns."""
    wanted, found = card.wanted, card.returned
    yield ["", "measured", "returned"]
    yield ["e", f"{wanted.e:.6g}", f"{found.e:.6g}"]
    yield ["imprint", _metres(wanted.imprint), _metres(found.imprint)]
    yield ["greatest approach", f"{_metres(wanted.approach)}, by the curve", _metres(found.approach)]
    yield ["greatest force", "", f"{found.force:.5g} N"]
    yield ["contact time", "", f"{found.duration:.5g} s"]


def rows(card: Card) -> Iterator[list[str]]:
    """What it returns at every measured speed, and the imprint if it leaves one."""
    heads = ["v [m/s]", "e measured", "e by this card", *(["e if e is typed in"] if card.takes_e else [])]
    yield [*heads, *(["imprint measured", "imprint by this card"] if card.leaves_imprint else [])]
    for row in card.rows:
        typed = [] if row.typed is None else [row.typed_code or f"{row.typed:.4f}"]
        imprints = (
            [_metres(row.imprint), row.code or _metres(row.imprint_by_card)] if card.leaves_imprint else []
        )
        yield [f"{row.speed:.4g}", f"{row.measured:.4f}", row.code or f"{row.by_card:.4f}", *typed, *imprints]


def misses(card: Card) -> str:
    """By how much its restitution is off where it is furthest off."""
    row = card.furthest
    return f"{row.by_card - row.measured:+.4f} at {row.speed:.4g} m/s"


def _metres(value: float) -> str:
    return f"{value:.5g} m" if value == value else "not known"
