"""Markdown for a pull request: tables whose cells hold text that came from elsewhere."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from .escape import visible

_MEANS_SOMETHING = re.compile(r"([\\`*_\[\]<>|~$])")


def cell(text: object) -> str:
    r"""Make text say what it says and do nothing: no markup, no HTML, no mention of anybody.

    >>> print(cell("a|b *c* <b> @you #7"))
    a\|b \*c\* \<b\> @<!-- -->you #<!-- -->7
    """
    plain = visible(str(text)).replace("&", "&amp;")
    return re.sub("([@#])", r"\1<!-- -->", _MEANS_SOMETHING.sub(r"\\\1", plain))


def code(text: object) -> str:
    r"""Set a short word, such as the address of a cell, as code.

    >>> print(code("alpha[1-2]"), code("a`|b"))
    `alpha[1-2]` ``a`\|b``
    """
    plain = visible(str(text)).replace("|", "\\|")
    fence = "`" * (max(map(len, re.findall("`+", plain)), default=0) + 1)
    pad = " " if plain.startswith("`") or plain.endswith("`") else ""
    return f"{fence}{pad}{plain}{pad}{fence}" if plain else ""


def told(texts: Iterable[object]) -> list[str]:
    """The cells of a row of texts that came from elsewhere."""
    return [*map(cell, texts)]


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Set a table of finished cells."""
    lines = [header, ["---"] * len(header), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)
