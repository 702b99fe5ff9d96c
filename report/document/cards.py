"""The chapter of cards for simulation codes: its tables, its lists and its pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from ..result import card_words as words
from ..result.card import Card, Cards
from ..workbook import FigureSpec
from .tree import Blocks, Code, Inlines, Items, Note, Row, Rows, Strong, Table, TableColumn

RETURNED, RESTITUTIONS, IMPRINTS = "cards_returned", "cards_restitutions", "cards_imprints"
"""The names of the pictures and of their drawings."""
WORDS = "in words"
_CODES = {"parameter", "value"}
"""Columns of what is typed."""
_SHARES = {words.TYPED[-1]: 0.26, WORDS: 0.78}
"""Of the line, for columns of words."""


def blocks(cards: Cards) -> Blocks:
    """What a report says of its cards."""
    refused = tuple(Note((Strong((each.title,)), f": {each.reason}.")) for each in cards.refused)
    if not cards.made:
        return refused
    speed = cards.made[0].speed
    return (
        _overview(cards.made, (Strong(("Cards",)), f" for impacts at {speed:.4g} m/s")),
        _grouped("cards-typed", (Strong(("What to type in",)),), cards.made, _typed),
        _grouped(
            "cards-returned",
            (Strong(("What each returns",)), " at the measured speeds"),
            cards.made,
            lambda card: list(words.rows(card)),
        ),
        _grouped(
            "cards-about", (Strong(("Where that comes from,",)), " and what to know"), cards.made, _about
        ),
        *((Items(tuple((note,) for note in cards.notes)),) if cards.notes else ()),
        *refused,
    )


def _overview(cards: Iterable[Card], caption: Inlines) -> Table:
    """A row a code."""
    heads = ("code", "imprint", "greatest force", "contact time", "misses e by at most")
    rows = []
    for card in cards:
        told = {row[0]: row[-1] for row in words.returned(card)}
        cells = (told["imprint"], told["greatest force"], told["contact time"], words.misses(card))
        rows.append(Row(((Code(card.name),), *((cell,) for cell in cells))))
    columns = tuple(TableColumn((head,)) for head in heads)
    return Table("cards-overview", caption, columns, (Rows(tuple(rows)),), look="list", whole=True)


def _typed(card: Card) -> list[list[str]]:
    return [list(words.TYPED), *words.typed(card)]


def _grouped(
    name: str, caption: Inlines, cards: Sequence[Card], told: Callable[[Card], list[list[str]]]
) -> Table:
    """A table of several: below the title of each its rows, in the columns that any of them has."""
    every = [told(card) for card in cards]
    heads = list(dict.fromkeys(head for first, *_ in every for head in first))
    groups = []
    for card, (first, *lines) in zip(cards, every, strict=True):
        named = [dict(zip(first, line, strict=True)) for line in lines]
        rows = tuple(Row(tuple(_cell(head, line.get(head, "")) for head in heads)) for line in named)
        groups.append(Rows(rows, (card.title,)))
    columns = tuple(_column(head) for head in heads)
    return Table(name, caption, columns, tuple(groups), look="list", wide=len(heads) > 4, whole=True)


def _column(head: str) -> TableColumn:
    share = _SHARES.get(head, 0.0)
    return TableColumn((head,), "words" if share else "left", share=share)


def _cell(head: str, text: str) -> Inlines:
    return () if not text else (Code(text),) if head in _CODES else (text,)


def _about(card: Card) -> list[list[str]]:
    """How it is written, its formula, where that stands, and what a user has to know besides."""
    lines = [["in an input", card.snippet], ["formula", card.formula]]
    lines += [["version", card.version]] if card.version else []
    lines += [["source", source] for source in card.sources]
    return [["", WORDS], *lines, *(["note", note] for note in card.notes)]


def figures(cards: Cards) -> tuple[FigureSpec, ...]:
    """The pictures that there are to draw, without their numbers."""
    if not cards.made:
        return ()
    returned = FigureSpec(
        RETURNED,
        "",
        "The restitution that is returned, over the one that is typed in, at the speed of the cards: of the "
        "codes that take one, with a dot where the measured one comes out, and in grey of the formulas that "
        "their damping goes back to. On the diagonal a restitution returns itself.",
        RETURNED,
        "Curves of the restitution that is returned over the one that is typed in, from 0 to 1, beside the "
        "diagonal.",
    )
    over = " over the impact speed: as measured, with twice its standard uncertainty, and by each card"
    restitutions = FigureSpec(
        RESTITUTIONS,
        "",
        f"Restitution{over}.",
        RESTITUTIONS,
        "Restitution over the impact speed: dots as measured, and a line for each code.",
    )
    imprints = FigureSpec(
        IMPRINTS,
        "",
        f"Imprint{over} whose contact leaves one.",
        IMPRINTS,
        "Imprint over the impact speed: dots as measured, and a line for each code that leaves one.",
    )
    wanted = {
        returned: any(card.prescribed for card in cards.made),
        restitutions: True,
        imprints: any(card.leaves_imprint for card in cards.made),
    }
    return tuple(spec for spec, is_there in wanted.items() if is_there)
