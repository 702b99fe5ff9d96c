"""The worksheet of cards: what to type into simulation codes, and what they then return, as issued."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ..result import card_words as words
from ..result.card import Card, Cards
from .xlsx_style import Style

_WIDTHS = (24, 18, 16, 46, 22, 22)


def write_cards(sheet: Any, style: Style, cards: Cards) -> None:
    """Write the cards, one below the other."""
    said = "As issued: these numbers follow no edit. Build the report again, or ask loopsheet card."
    style.page(sheet, "cards: what to type into simulation codes", said, _WIDTHS)
    row = 3
    for card in cards.made:
        row = _Written(sheet, style, card, row).write() + 2
    told = [*cards.notes, *(f"{each.title}: {each.reason}" for each in cards.refused)]
    for at, line in enumerate(told, start=row):
        style.text(sheet, at, 0, line, "aside")
    sheet.freeze_panes(3, 0)


class _Written:
    """One card."""

    def __init__(self, sheet: Any, style: Style, card: Card, row: int) -> None:
        self.sheet, self.style, self.card, self.row = sheet, style, card, row

    def write(self) -> int:
        """Write it; return the row behind it."""
        title, *lines = words.head(self.card)
        self.style.section(self.sheet, self.row, title, len(_WIDTHS))
        self.row += 1
        self.lines([*lines, f"in an input: {self.card.snippet}"])
        self.table([list(words.TYPED), *words.typed(self.card)])
        self.table(list(words.rows(self.card)))
        self.table(list(words.returned(self.card)))
        self.lines(self.card.notes)
        return self.row

    def lines(self, lines: Iterable[str]) -> None:
        """Sentences, each across all columns."""
        for line in lines:
            self.style.sentence(self.sheet, self.row, line, len(_WIDTHS), sum(_WIDTHS))
            self.row += 1

    def table(self, rows: Sequence[Sequence[str]]) -> None:
        """A table with its head; what is a number is one."""
        for number, row in enumerate(rows):
            for at, said in enumerate(row):
                value = _number(said) if number else None
                if value is None:
                    self.style.text(self.sheet, self.row, at, said, "text" if number else "head")
                else:
                    self.sheet.write_number(self.row, at, value, self.style("number", "General"))
            self.row += 1
        self.row += 1


def _number(said: str) -> float | None:
    try:
        return float(said)
    except ValueError:
        return None
