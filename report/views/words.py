"""Running text with symbols, numbers and references in it, and the templates that put it in its place.

Sentences of a workbook and of the checks are plain text: ``at e[1] = 0.51 (11) vanishes``. Here the names,
numbers and equation numbers in them are found; how each is printed is the format's business.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from sympy import Expr, Indexed, Integer, Symbol

from ...derivations.equation import Derivation, Equation, Step
from ...derivations.proof import IDENTITY, Proof, Status
from ...derivations.text import Writer
from .document import Document
from .escape import Markup, slug
from .numbers import Figure, read
from .parts import Head, Item, index_text

__all__ = ["TEMPLATES", "Words", "environment", "narratives"]

TEMPLATES = Path(__file__).resolve().parents[2] / "templates"
GENERIC = "generic"
"""The narrative of any workbook."""

_PART = re.compile(
    r"(?P<number>(?<![\w.])-?\d+(?:\.\d+)?e[+-]?\d+(?!\w))"
    r"|(?P<label>\(L?\d+[a-z]?\))"
    r"|(?P<unit>(?<!\w)N/m\^\w+)"
    r"|(?P<symbol>(?<![\w'’.])(?P<name>[A-Za-z]\w*(?:'+(?:_\w+)?)?(?:,[a-z](?!\w))?)"
    r"(?:\[(?P<index>\w+(?:-\w+)?)\])?(?:(?:\*\*|\^)(?P<power>\w+))?(?![\w’]|\.\w))"
    r"|(?P<raised>(?<=\))\^(?P<to>\w+))"
    r"|(?P<relation><=|>=)|(?P<minus>(?<= )-(?= ))|(?P<times>(?<=[\w)\]'])\*(?=[\w(]))"
)
_LONE = frozenset("ijk")
_OTHERWISE = frozenset("aN")
"""Names that sentences use for something else: an article, and the newton."""
_SIGNS = {"<=": "≤", ">=": "≥", "-": "−", "*": "\u202f"}


class Words(ABC):
    """What templates call to print something in one format.

    Parameters
    ----------
    document : Document
    """

    def __init__(self, document: Document) -> None:
        self.document = document
        self.vocabulary = document.report.ledger.vocabulary
        self.sections: list[tuple[str, str]] = []
        self._used: set[str] = set()

    # --- what a format prints

    @abstractmethod
    def escape(self, text: object) -> Markup:
        """Plain text."""

    @abstractmethod
    def math(self, latex: str) -> Markup:
        """A formula in running text."""

    @abstractmethod
    def number(self, figure: Figure) -> Markup:
        """A number."""

    @abstractmethod
    def unit(self, unit: str) -> Markup:
        """A unit; nothing for a pure number."""

    @abstractmethod
    def refer(self, label: str) -> Markup:
        """A reference to an equation by its label."""

    @abstractmethod
    def signed(self, figure: Figure) -> Markup:
        """A difference: with its sign, be it a plus."""

    # --- what follows from that

    def symbol(self, name: str, index: str = "") -> Markup:
        """The symbol of a cell's name."""
        return self.math(self.document.latex(name, index))

    def rich(self, text: str) -> Markup:
        """A sentence with its symbols, numbers and references; everything else is escaped."""
        return Markup("").join(self._parts(text))

    def _parts(self, text: str) -> Iterator[Markup]:
        place = 0
        for found in _PART.finditer(text):
            printed = self._part(found)
            if printed is not None:
                yield self.escape(text[place : found.start()])
                yield printed
                place = found.end()
        yield self.escape(text[place:])

    def _part(self, found: re.Match[str]) -> Markup | None:
        if found["number"]:
            mantissa, _, power = found["number"].partition("e")
            zero = not re.search("[1-9]", mantissa)
            figure = read("0" if zero else f"{mantissa}e{int(power)}")
            return None if figure is None else self.number(figure)
        if found["label"]:
            return self.refer(found["label"]) if found["label"] in self.document.identifiers else None
        if found["unit"]:
            return self.unit(found["unit"])
        if found["raised"]:
            return self.math(f"{{}}^{{{self._power(found['to'])}}}")
        if found["symbol"]:
            return self._symbol(found)
        return self.escape(_SIGNS[found.group()])

    def _symbol(self, found: re.Match[str]) -> Markup | None:
        name, index = self._written.get(found["name"], (found["name"], ""))
        index = index or found["index"] or ""
        if name in _LONE and not index:
            return self.math(name)
        # A column may be called like a word of English.
        if name in _OTHERWISE or not (name in self.vocabulary or name in self._names):
            return None
        if "-" in index:  # a pair: its dash is no minus
            return self.symbol(name) + self.escape(f"\u00a0{index.replace('-', '–')}")
        latex = self.document.latex(name, index)
        if found["power"]:
            base = f"({latex})" if "'" in latex else latex
            latex = f"{base}^{{{self._power(found['power'])}}}"
        return self.math(latex)

    def _power(self, text: str) -> str:
        """LaTeX of an exponent: digits or a name."""
        return text if text.isdigit() else self.document.latex(text)

    @cached_property
    def _written(self) -> dict[str, tuple[str, str]]:
        """Names as sentences of the derivations write them, ``x_m2``: the quantity and its index."""
        text, quantities = Writer(self.vocabulary).text, self.vocabulary.items()
        # x_p is the imprint depth before it is the x of some p.
        found: dict[str, tuple[str, str]] = {}
        for name, quantity in quantities:
            found.setdefault(text(quantity.symbol), (name, ""))
        for name, quantity in quantities:
            for index in (1, 2, *map(Symbol, "ijkpq")):
                found.setdefault(text(quantity[index]), (name, str(index)))
        return found

    @cached_property
    def _names(self) -> frozenset[str]:
        return frozenset(name for name in self.document.names if "_" in name)

    def quantity(self, item: Item) -> Markup:
        """A cell's number with its unit, or the code of its error."""
        if item.printed is not None and item.figure is None:
            return self.escape(item.printed)
        if item.figure is None:
            return self.escape(item.code)
        return self.number(item.figure)

    def exponents(self) -> dict[str, str]:
        """LaTeX of the names that may stand in the exponent of a unit."""
        return {name: self.document.latex(name) for name in self.document.names}

    def first(self, key: str) -> bool:
        """Whether something is mentioned for the first time: only then it gets its identifier."""
        if key in self._used:
            return False
        self._used.add(key)
        return True

    def section(self, identifier: str, title: str) -> str:
        """Remember a section for the table of contents."""
        self.sections.append((identifier, title))
        return ""

    def sentence(self, text: str) -> Markup:
        """A sentence with a capital letter in front and without its full stop."""
        text = text.rstrip(".")
        word = re.match(r"[a-z]{2,}\b|a(?= )", text)
        return self.rich(text[0].upper() + text[1:] if word and word.group() not in self.vocabulary else text)

    def slug(self, text: str) -> Markup:
        """An identifier made of foreign text: letters, digits, ``_``, ``.`` and ``-``."""
        return Markup(slug(text))

    def index(self, label: tuple[int, ...]) -> str:
        """The label of a row for the eye."""
        return index_text(label).replace("-", "–")

    def kind(self, proof: Proof | None) -> str:
        """The kind of a status, for its colour."""
        if proof is None or proof.status in (Status.DEFINITION, Status.ASSUMPTION, Status.LIMIT):
            return "stated"
        return "holds" if proof.status.passes else "fails"

    def unseen(self, step: Step, derivation: Derivation) -> list[Equation]:
        """The premises of a step that have no number and were not shown in a step before it."""
        before = derivation.steps[: derivation.steps.index(step)]
        shown = {other.claim.origin for other in before}
        return [
            p for p in step.premises if p.label not in self.document.identifiers and p.origin not in shown
        ]

    def premise(self, equation: Equation) -> Markup:
        """What a step rests on: its number or its name, and of which test it speaks."""
        known = equation.label in self.document.identifiers
        named = self.refer(equation.label) if known else self.rich(equation.title)
        own, general = _indices(equation), _indices(equation.origin)
        if len(own) == len(general) == 1 and own != general and isinstance(next(iter(own)), Integer):
            return named + self.escape(" for ") + self.math(f"{general.pop()} = {own.pop()}")
        return named

    def premises(self, step: Step) -> list[Markup]:
        """What a step rests on, each once: two branches of one law are one equation."""
        return list(dict.fromkeys(self.premise(premise) for premise in step.premises))

    def grounds(self, proof: Proof) -> list[Markup]:
        """What a claim finally rests on: numbers, and titles of what has none."""
        known = self.document.identifiers
        found = [self.refer(label) if label in known else self.rich(label) for label in proof.rests_on]
        return found or [self.escape(IDENTITY)]

    def legend(self, heads: tuple[Head, ...]) -> Iterator[tuple[Head, Markup, Markup]]:
        """For each column: its head, its meaning, the equations behind it."""
        for head in heads:
            refer = [self.refer(label) for label in head.sources]
            yield head, self.rich(head.meaning), self.escape(", solved as ").join(refer)


_TOLD = re.compile(r"\b(?:m\.cell|m\.eq|m\.ref|doc\.count|doc\.counted|doc\.inside)\('([^']+)'")


def narratives() -> dict[str, list[str]]:
    """The texts around tables and figures that a workbook may name: the generic one and what extends it.

    With the cells, axes and equations that each tells of.
    """
    extends = f"((* extends 'prose/{GENERIC}.j2' *))"
    prose = {path.stem: path.read_text("utf-8") for path in sorted((TEMPLATES / "prose").glob("*.j2"))}
    told = {name: sorted(set(_TOLD.findall(text))) for name, text in prose.items() if extends in text}
    return {GENERIC: []} | told


def _indices(equation: Equation) -> set[Expr]:
    """The indices that the cells of an equation carry."""
    return {index for member in equation.members for cell in member.atoms(Indexed) for index in cell.indices}


@lru_cache(maxsize=4)
def environment(finalize: Callable[[Any], Markup]) -> Environment:
    """The templates' environment: everything that is put out is escaped, and a name that is not there raises.

    All templates use the delimiters ``((* *))``, ``((( )))`` and ``((# #))``: the prose is written once for
    both formats, and LaTeX is full of braces.
    """
    return Environment(
        loader=FileSystemLoader(TEMPLATES),
        block_start_string="((*",
        block_end_string="*))",
        variable_start_string="(((",
        variable_end_string=")))",
        comment_start_string="((#",
        comment_end_string="#))",
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=True,
        undefined=StrictUndefined,
        finalize=finalize,
    )
