"""Words of a column that may be one word, misspelt."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ..messages.errors import Location

_AS_DRAWN = str.maketrans(
    "OoIl" + "АВЕКМНОРСТХаеорсух" + "ΑΒΕΖΗΙΚΜΝΟΡΤΥΧο",
    "0011" + "ABEKMH0PCTXae0pcyx" + "ABEZH1KMN0PTYX0",
)
"""Signs that look alike: digits and letters, and the letters of three alphabets."""
_DASHES = re.compile("[\u2010-\u2015\u2212\ufe58\ufe63\uff0d]")
_VARIANTS = {chr(each) for each in range(0xFE00, 0xFE10)}
"""What chooses between two drawings of one sign."""
_WHOLE = re.compile(r"^(\d+)\.0+$")
_ZEROS = re.compile(r"(?<![0-9.,])0+(?=[0-9])")
_MARKS = re.compile(r"(?<=[^\W_])[-_.\s]+(?=[^\W_])|[_.]+$")
"""Marks within a word or that end it: one that begins a number is a sign, and ``Cl-`` is not ``Cl``."""
_SHORTEST = 5
"""In shorter words one letter more is another word."""


class Alike(NamedTuple):
    """A word that may be another one misspelt, with the rows of both."""

    column: str
    word: str
    rows: tuple[int, ...]
    other: str
    others: tuple[int, ...]
    at: Location
    """Where the word stands first."""


def same(word: str) -> str:
    """What a word has in common with those that differ from it in case, blanks or the form of a sign alone.

    Dashes are one sign, what is not drawn at all is a blank, and a spreadsheet makes ``1.0`` of ``1``.

    >>> same("b 40") == same("B40"), same("A\u20131\u200b") == same("A-1"), same("B40") == same("B41")
    (True, True, False)
    >>> same("A\ufe0f") == same("A"), same("1.0") == same("1"), same("1.10") == same("1.1")
    (True, True, False)
    """
    plain = _DASHES.sub("-", unicodedata.normalize("NFKC", word).casefold())
    drawn = (each for each in plain if not each.isspace() and unicodedata.category(each) != "Cf")
    return _WHOLE.sub(r"\1", "".join(each for each in drawn if each not in _VARIANTS))


def in_case(word: str, other: str, rows: Mapping[str, Sequence[int]]) -> bool:
    """Whether two words differ in case alone, and each stands in several rows: both may be meant."""
    return word.casefold() == other.casefold() and min(len(rows[word]), len(rows[other])) > 1


def alike(rows: Mapping[str, Sequence[int]]) -> Iterator[tuple[str, str]]:
    """Words that may be one, that of fewer rows (or the later one) first.

    They look the same (``B4O`` and ``B40``, ``S01`` and ``S1``); or a hyphen, underscore, blank or point is
    missing in one or another one of these (``S-2``, ``S_2`` and ``S2``); or they differ in case alone, and
    each stands in several rows (``CO`` and ``Co``); or one stands in a single row and the other
    in several, and they differ by a small letter more within the word, or by two that are exchanged. Other
    numbers and other letters tell rows apart (``A1`` and ``A2``, ``1-11`` and ``11-1``, ``butane`` and
    ``butene``).

    Parameters
    ----------
    rows : mapping of str to sequence of int
        The rows of each word, in the order of the table.

    Examples
    --------
    >>> list(alike({"Aldrich": [1, 2], "Aldrcih": [3], "B40": [4, 5], "B4O": [6], "B41": [7]}))
    [('B4O', 'B40'), ('Aldrcih', 'Aldrich')]
    >>> list(alike({"S-2": [1, 2], "S2": [3], "s_02": [4], "1-11": [5], "11-1": [6]}))
    [('S2', 'S-2'), ('s_02', 'S-2')]
    >>> list(alike({"A1": [1, 2], "A2": [3], "butane": [5, 6], "butene": [7], "CO2": [8], "C2": [9]}))
    []
    """
    told: set[tuple[str, str]] = set()
    for seen in (str.casefold, lambda word: word.translate(_AS_DRAWN), _without_zeros, _without_marks):
        first: dict[str, str] = {}
        for word in rows:
            other = first.setdefault(seen(word), word)
            if other == word or (word.casefold() == other.casefold() and not in_case(word, other, rows)):
                continue
            pair = (word, other) if len(rows[word]) <= len(rows[other]) else (other, word)
            if pair not in told:
                told.add(pair)
                yield pair
    of = {slip: word for word, own in rows.items() if len(own) > 1 for slip in _slips(word)}
    for word in (word for word, own in rows.items() if len(own) == 1):
        if other := of.get(word) or next((each for each in _slips(word) if len(rows.get(each, ())) > 1), ""):
            yield word, other


def _without_zeros(word: str) -> str:
    return _ZEROS.sub("", word)


def _without_marks(word: str) -> str:
    """A word without the marks within it, in one case; between digits they are one mark."""

    def plain(mark: re.Match[str]) -> str:
        around = word[mark.start() - 1], word[mark.end() : mark.end() + 1]
        return "-" if all(map(str.isdigit, around)) else ""

    word = _without_zeros(_DASHES.sub("-", word.casefold()))
    return _MARKS.sub(plain, word)


def _slips(word: str) -> Iterator[str]:
    """A word without one of the small letters within it, and with two of them exchanged."""
    if len(word) < _SHORTEST:
        return
    for place in range(1, len(word) - 1):
        if re.fullmatch(r"[^\W\d_]{3}", near := word[place - 1 : place + 2]) and near.islower():
            yield word[:place] + word[place + 1 :]
            yield word[:place] + word[place + 1] + word[place] + word[place + 2 :]
