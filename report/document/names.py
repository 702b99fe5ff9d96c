r"""Names for the eye: LaTeX of what quantities are called, and of signed terms one behind the other."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ...derivations.vocabulary import Vocabulary, spelt, with_index
from ..sheet import Column

Terms = list[tuple[bool, str]]
"""LaTeX of the terms of a sum, each with whether it is subtracted."""


def latex_names(vocabulary: Vocabulary, columns: Iterable[Column]) -> dict[str, str]:
    """LaTeX of all names of a report: as its columns print them, else as its vocabulary does.

    `vocabulary`: of the ledger. `columns`: of the sheet.
    """
    names = {name: quantity.latex for name, quantity in vocabulary.items()}
    for column in columns:
        names[column.name] = column.latex or names.get(column.name) or spelt(column.name)
    return names


def name_latex(name: str, names: Mapping[str, str], index: str = "") -> str:
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
    >>> name_latex("x_m", {}, "k"), name_latex("n_pairs", {}), name_latex("v", {"v": "v'%s"}, "2")
    ('x_{m_{k}}', 'n_{\\mathrm{pairs}}', "v'_{2}")
    """
    return with_index(names[name] if name in names else spelt(name), index)


def join(terms: Iterable[tuple[bool, str]]) -> str:
    """Join signed terms."""
    text = ""
    for negative, term in terms:
        sign = "-" if negative else "+"
        text += f" {sign} {term}" if text else ("-" if negative else "") + term
    return text
