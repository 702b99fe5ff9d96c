"""The words of a ledger: what each symbol means, its unit, how it is printed, where proofs sample it.

A vocabulary comes with the ledger that is written in it, and nothing else says what a symbol is: the ``v``
of one paper is a speed with a prime, that of another a voltage.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sympy import Expr, Indexed, IndexedBase, Rel, Symbol

_SMALL = "alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa varkappa lambda mu nu"
_SMALL += " xi pi varpi rho varrho sigma varsigma tau upsilon phi varphi chi psi omega"
_CAPITAL = "Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega"
_OTHER = "aleph beth gimel daleth ell eth hbar hslash mho wp"
_LETTERS = frozenset(f"{_SMALL} {_CAPITAL} {_OTHER}".split())
"""What LaTeX has a letter for."""
_COMMAND, _GROUP = re.compile(r"\\(?:[A-Za-z]+|.)"), re.compile(r"\{([^{}]*)\}")
_TWICE = re.compile(r"_.(?:\^.|')*_|(?:\^.(?:_.)*|'_.)[\^']|[_^](?:$|[_^'])")
"""Two scripts in one place, or none where one is said to be, of letters alone."""


def subscripted(name: str, subscript: str) -> str:
    """A name with its subscript, for a terminal.

    >>> subscripted("x_m", "2"), subscripted("x_m", "k"), subscripted("e", "k"), subscripted("e", "")
    ('x_m2', 'x_m,k', 'e_k', 'e')
    """
    if not subscript:
        return name
    join = "_" if "_" not in name else "" if subscript.isdigit() else ","
    return f"{name}{join}{subscript}"


def spelt(name: str) -> str:
    r"""LaTeX of a name that nothing is said of: what follows the first ``_`` is a subscript.

    >>> spelt("x_m"), spelt("alpha")
    ('x_{m%s}', '\\alpha%s')
    """
    head, _, tail = name.partition("_")
    return _word(head) + (f"_{{{_word(tail)}%s}}" if tail else "%s")


def with_index(template: str, index: str = "") -> str:
    r"""Put an index where the LaTeX of a quantity has its place for one.

    >>> with_index("m_{red%s}"), with_index("e%s", "1")
    ('m_{\\mathrm{red}}', 'e_{1}')
    >>> with_index("g_2%s", "1"), with_index(r"x_{m_2%s}", "k")  # LaTeX takes no second subscript
    ('g_{2_{1}}', 'x_{m_{2_{k}}}')
    """
    # A subscript of several letters is a word, not a product.
    upright = re.sub(r"_\{([A-Za-z]{2,})(?=[%}])", r"_{\\mathrm{\1}", template)
    if not index:
        return upright.replace("%s", "")
    if "%s" in upright:
        # Behind a subscript it is one of the subscript.
        inside = re.sub(r"_(?:\{((?:[^{}]|\{[^{}]*\})*)\}|(\\[A-Za-z]+|[^{}\\%]))%s", r"_{\1\2%s}", upright)
        return inside.replace("%s", f"_{{{index}}}")
    return f"{{{upright}}}_{{{index}}}" if "_" in upright else f"{upright}_{{{index}}}"


def amiss(template: str) -> str:
    r"""What TeX would not take of the LaTeX of a quantity, in words; empty if it takes it.

    >>> amiss(r"\hat{x}_{m%s}"), amiss("x'^2"), amiss("x_{m")
    ('', '', 'has a brace without its other one')
    >>> amiss("x_1_2"), amiss("{x_1}_2")
    ('has two scripts in one place: put the first and its letter in braces', '')
    >>> amiss("50 % x"), amiss(r"50 \%")
    ("has a '%', which means another thing in LaTeX: write \\%", '')
    """
    text = _COMMAND.sub("x", with_index(template, "1").replace(" ", ""))
    if special := re.search("[%#$&]", text):
        return f"has a '{special[0]}', which means another thing in LaTeX: write \\{special[0]}"
    scripts = False
    while group := _GROUP.search(text):  # from the inside out, each is one letter of what is around it
        scripts = scripts or _TWICE.search(group[1]) is not None
        text = f"{text[: group.start()]}x{text[group.end() :]}"
    if re.search("[{}]", text):
        return "has a brace without its other one"
    if scripts or _TWICE.search(text):
        return "has two scripts in one place: put the first and its letter in braces"
    return ""


def _word(text: str) -> str:
    if len(text) == 1 or text.isdigit():
        return text
    plain = text.replace("_", r"\_")
    return f"\\{text}" if text in _LETTERS else rf"\mathrm{{{plain}}}"


@dataclass(frozen=True)
class Quantity:
    """A physical quantity, written plain (``x_m.symbol``) or for test number k (``x_m[k]``).

    Both carry the same assumptions, so the algebra of a claim for all k is the algebra of the claim for one.
    """

    name: str
    """The name in the field and of its cell, ``x_m``."""
    meaning: str
    """What it is, in words."""
    unit: str
    """SI unit as text; an exponent may be a symbol's name (``N/m^alpha``)."""
    latex: str
    """How the source prints it; ``%s`` is where a subscript goes (nothing, or the test's number)."""
    span: tuple[float, float] = (0.5, 2.0)
    """The interval in which proofs sample it, in SI."""
    positive: bool | None = None
    """Whether it is positive in every model here (a logarithm is not); left out: if all of `span` is."""
    text: str = ""
    """How a terminal shows it; ``%s`` is where a subscript goes. Left out: the name, then the subscript."""
    low: float | None = None
    high: float | None = None
    """`low` and `high`: between which it is known to lie, in SI: nothing else is let in."""
    whole: bool = False
    """Whether it is a whole number."""

    def __post_init__(self) -> None:
        if self.positive is None:
            object.__setattr__(self, "positive", self.span[0] > 0)

    def called(self, subscript: str = "") -> str:
        """How a terminal shows it, of a row or of all."""
        if self.text:
            return self.text.replace("%s", f"_{subscript}" if subscript else "")
        return subscripted(self.name, subscript)

    @cached_property
    def symbol(self) -> Symbol:
        """The plain symbol, with its assumptions."""
        from sympy import Symbol

        return Symbol(self.name, positive=True) if self.positive else Symbol(self.name, real=True)

    @cached_property
    def base(self) -> IndexedBase:
        """The indexed symbol, with the same assumptions."""
        from sympy import IndexedBase

        return IndexedBase(self.symbol)

    def inside(self, symbol: Expr) -> Iterator[Rel]:
        """That it lies between its ends, of a symbol or cell that stands for it."""
        from sympy import Rational

        if self.low is not None:
            yield symbol >= Rational(repr(self.low))
        if self.high is not None:
            yield symbol <= Rational(repr(self.high))

    def __getitem__(self, index: Expr | int) -> Indexed:
        """The quantity of one test (or pair, or point)."""
        return self.base[index]


class Vocabulary(Mapping[str, Quantity]):
    """Quantities by their names, in the order in which they were given.

    Raises
    ------
    ValueError
        Two of them have one name.
    """

    def __init__(self, *quantities: Quantity) -> None:
        self._quantities = {quantity.name: quantity for quantity in quantities}
        if len(self._quantities) != len(quantities):
            names = [quantity.name for quantity in quantities]
            twice = sorted({name for name in names if names.count(name) > 1})
            raise ValueError(f"a vocabulary says twice what {', '.join(twice)} means")

    def __getitem__(self, name: str) -> Quantity:
        return self._quantities[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._quantities)

    def __len__(self) -> int:
        return len(self._quantities)

    def __hash__(self) -> int:
        return id(self)

    def __eq__(self, other: object) -> bool:
        return self is other

    def plain(self, names: str) -> tuple[Symbol, ...]:
        """The plain symbols of some quantities, by their names with spaces between."""
        return tuple(self[name].symbol for name in names.split())

    def find(self, symbol: Expr) -> Quantity | None:
        """What a symbol, plain, indexed or a function of something, stands for; None if nothing says."""
        from sympy import Indexed
        from sympy.core.function import AppliedUndef

        if isinstance(symbol, AppliedUndef):
            return self.get(symbol.func.__name__)
        return self.get(str(symbol.base.label) if isinstance(symbol, Indexed) else str(symbol))


NO_WORDS = Vocabulary()
"""The vocabulary of a ledger that says nothing of its symbols: they are called what they are called."""
