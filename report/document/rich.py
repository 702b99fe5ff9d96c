"""The symbols, numbers and references in plain sentences.

Sentences of a workbook, of the checks and of the referee are plain text: ``at e[1] = 0.51 (11) vanishes``.
Here the names, numbers and equation numbers in them are found; how each is printed is the format's business.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property

from ...derivations.vocabulary import Vocabulary
from ..messages.errors import sentence_case
from ..result.numbers import read
from .names import name_latex
from .tree import Inline, Inlines, Math, Number, Refer, Unit

_UNIT = r"(?<!\w)N/m\^\w+|(?<=[\d–]\s)(?:[uμ](?:m|s|in)\b%s)"
_PART = (
    r"(?P<number>(?<![\w.])-?\d+(?:\.\d+)?e[+-]?\d+(?!\w))"
    r"|(?P<label>\(L?\d+[a-z]?\))"
    r"|(?P<unit>%s)"
    r"|(?P<symbol>(?<![\w'’.])(?P<name>[A-Za-z]\w*(?:'+(?:_\w+)?)?(?:,[a-z](?!\w))?)"
    r"(?:\[(?P<index>\w+(?:-\w+)?)\])?(?:(?:\*\*|\^)(?P<power>\w+))?(?![\w’]|\.\w))"
    r"|(?P<raised>(?<=\))\^(?P<to>\w+))"
    r"|(?P<relation><=|>=)|(?P<minus>(?<= )-(?= ))|(?P<times>(?<=[\w)\]'])\*(?!(?<=\d\*)\d)(?=[\w(]))"
)
"""With the pattern of the units."""
_RAISED = re.compile(r"[\^*]")
"""What no unit of a table has: it prints them as powers and products."""
_LONE = frozenset("ijk")
_OTHERWISE = frozenset("aN")
"""Names that sentences use for something else: an article, and the newton."""
_SIGNS = {"<=": "≤", ">=": "≥", "-": "−", "*": "\u202f"}


class Sentences:
    """Reads sentences in the words of one report.

    Parameters
    ----------
    vocabulary : Vocabulary
        Of the ledger.
    names : mapping of str to str
        LaTeX of all names.
    labels : collection of str
        Of the equations that can be referred to.
    units : iterable of str
        Of the report: behind a number they are printed as tables print them.
    """

    def __init__(
        self,
        vocabulary: Vocabulary,
        names: Mapping[str, str],
        labels: Collection[str],
        units: Iterable[str] = (),
    ) -> None:
        self.vocabulary, self.names, self.labels = vocabulary, names, labels
        raised = sorted(filter(_RAISED.search, units), key=len, reverse=True)
        self._unit = _UNIT % "".join(rf"|{re.escape(unit)}(?!\w)" for unit in raised)
        self._part_of = re.compile(_PART % self._unit)

    def symbol(self, name: str, index: str = "") -> Math:
        """The symbol of a cell's name."""
        return Math(name_latex(name, self.names, index))

    def rich(self, text: str) -> Inlines:
        """A sentence with its symbols, numbers and references."""
        return tuple(part for part in self._parts(text) if part != "")

    def sentence(self, text: str) -> Inlines:
        """A sentence with a capital letter in front and without its full stop."""
        text = text.rstrip(".")
        word = re.match(r"\w+", text)
        return self.rich(text if word and word.group() in self.vocabulary else sentence_case(text))

    def units(self, text: str) -> Inlines:
        """Words of a user, with the units in them as tables print them."""
        parts = enumerate(re.split(f"({self._unit})", text))
        return tuple(Unit(part) if n % 2 else part for n, part in parts if part)

    def _parts(self, text: str) -> Iterator[Inline]:
        place = 0
        for found in self._part_of.finditer(text):
            printed = self._part(found)
            if printed:
                yield text[place : found.start()]
                yield from printed
                place = found.end()
        yield text[place:]

    def _part(self, found: re.Match[str]) -> Inlines:
        if found["number"]:
            mantissa, _, power = found["number"].partition("e")
            zero = not re.search("[1-9]", mantissa)
            figure = read("0" if zero else f"{mantissa}e{int(power)}")
            return () if figure is None else (Number(figure),)
        if found["label"]:
            return (Refer(found["label"]),) if found["label"] in self.labels else ()
        if found["unit"]:
            return (Unit(found["unit"]),)
        if found["raised"]:
            return (Math(f"{{}}^{{{self._power(found['to'])}}}"),)
        if found["symbol"]:
            return self._symbol(found)
        return (_SIGNS[found.group()],)

    def _symbol(self, found: re.Match[str]) -> Inlines:
        name, index = self._written.get(found["name"], (found["name"], ""))
        index = index or found["index"] or ""
        if name in _LONE and not index:
            return (Math(name),)
        if name in _OTHERWISE or not (name in self.vocabulary or self._is_no_word(name)):
            return ()
        if "-" in index:  # a pair: its dash is no minus
            return self.symbol(name), f"\u00a0{index.replace('-', '–')}"
        latex = name_latex(name, self.names, index)
        if found["power"]:
            base = f"({latex})" if "'" in latex else latex
            latex = f"{base}^{{{self._power(found['power'])}}}"
        return (Math(latex),)

    def _is_no_word(self, name: str) -> bool:
        """Whether a column is not called like a word of English: it has an index, or is a Greek letter."""
        return name in self.names and ("_" in name or self.names[name].startswith(f"\\{name}"))

    def _power(self, text: str) -> str:
        """LaTeX of an exponent: digits or a name."""
        return text if text.isdigit() else name_latex(text, self.names)

    @cached_property
    def _written(self) -> dict[str, tuple[str, str]]:
        """Names as sentences of the derivations write them, ``x_m2``: the quantity and its index."""
        quantities = self.vocabulary.items()
        # x_p is the imprint depth before it is the x of some p.
        found: dict[str, tuple[str, str]] = {}
        for name, quantity in quantities:
            found.setdefault(quantity.called(), (name, ""))
        for name, quantity in quantities:
            for index in "12ijkpq":
                found.setdefault(quantity.called(index), (name, index))
        return found
