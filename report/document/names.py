r"""Names for the eye: LaTeX of what quantities are called, and of signed terms one behind the other."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from itertools import accumulate

from ...derivations.vocabulary import Vocabulary, spelt
from ..sheet import Column
from .notation import read

__all__ = ["Terms", "amiss", "join", "latex_names", "name_latex", "with_index"]

Terms = list[tuple[bool, str]]
"""LaTeX of the terms of a sum, each with whether it is subtracted."""


def latex_names(vocabulary: Vocabulary, columns: Iterable[Column] = ()) -> dict[str, str]:
    """LaTeX of all names of a report: as its columns print them, else as its vocabulary does.

    `vocabulary`: of the ledger. `columns`: of the sheet.
    """
    names = {name: quantity.latex for name, quantity in vocabulary.items()}
    for column in columns:
        names[column.name] = column.latex or names.get(column.name) or spelt(column.name)
    return names


def name_latex(name: str, names: Mapping[str, str] | None = None, index: str = "") -> str:
    r"""Print the name of a quantity.

    Parameters
    ----------
    name : str
        The cell name, ``x_m``.
    names : mapping of str to str
        LaTeX of those that are printed otherwise than they are called; ``%s`` is where an index goes.
    index : str
        LaTeX of the index; empty for none.

    Examples
    --------
    >>> name_latex("x_m", index="k"), name_latex("n_pairs"), name_latex("v", {"v": "v'%s"}, "2")
    ('x_{m_{k}}', 'n_{\\mathrm{pairs}}', "v'_{2}")
    """
    return with_index(names[name] if names and name in names else spelt(name), index)


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

    >>> amiss(r"\hat{x}_{m%s}"), amiss("x_{m")
    ('', 'has a brace without its other one')
    >>> amiss("x_1_2"), amiss("{x_1}_2")
    ('has two scripts in one place: put the first and its letter in braces', '')
    >>> amiss("50 % x"), amiss(r"50 \%")
    ("has a '%', which means another thing in LaTeX: write \\%", '')
    """
    latex = with_index(template, "1")
    bare = re.sub(r"\\.", "", latex)
    if special := re.search("[%#$&]", bare):
        return f"has a '{special[0]}', which means another thing in LaTeX: write \\{special[0]}"
    depths = list(accumulate((sign == "{") - (sign == "}") for sign in bare))
    if depths and (min(depths) < 0 or depths[-1]):
        return "has a brace without its other one"
    if any(part.kind == "scripts" and part.parts[0].kind == "scripts" for part in read(latex).walk()):
        return "has two scripts in one place: put the first and its letter in braces"
    return ""


def join(terms: Iterable[tuple[bool, str]]) -> str:
    """Join signed terms."""
    text = ""
    for negative, term in terms:
        sign = "-" if negative else "+"
        text += f" {sign} {term}" if text else ("-" if negative else "") + term
    return text
