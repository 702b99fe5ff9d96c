"""The same page in fewer bytes: what a browser does not need is left out, nothing that is seen changes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import count, product
from string import ascii_letters

# --- JavaScript ------------------------------------------------------------------------------------------

_TOKEN = re.compile(
    r"""(?P<text>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')"""
    r"|(?P<comment>//[^\n]*|/\*[\s\S]*?\*/)"
    r"|(?P<pattern>(?<=[(,=:?&|!\[{;\n])[ ]*/(?![/*])(?:\\.|\[(?:\\.|[^\]\\\n])*\]|[^/\\\n\[])+/[a-z]*)"
    r"|(?P<space>\s+)|(?P<word>[\w$]+)|(?P<template>`)|(?P<other>.)"
)


def _tokens(text: str) -> Iterator[tuple[str, str]]:
    """Words, texts, patterns, spaces ... in their order, comments left out."""
    place = 0
    while place < len(text):
        found = _TOKEN.match(text, place)
        assert found is not None
        kind, end = str(found.lastgroup), found.end()
        if kind == "template":
            end = _end_of_template(text, end)
        if kind != "comment":
            yield kind, text[place:end]
        place = end


def _end_of_template(text: str, place: int) -> int:
    """Where a text in backquotes ends, with all that is put into it."""
    while text[place] != "`":
        if text[place] == "\\":
            place += 1
        elif text.startswith("${", place):
            depth, place = 1, place + 2
            while depth:
                found = _TOKEN.match(text, place)
                assert found is not None
                place = found.end()
                if found.lastgroup == "template":
                    place = _end_of_template(text, place)
                depth += {"{": 1, "}": -1}.get(found.group(), 0)
            continue
        place += 1
    return place + 1


def short_script(text: str) -> str:
    r"""JavaScript without comments and idle spaces; a line end stays where it ends a statement.

    >>> short_script('const a = 1; // one\n  const b = `x  ${ a }`;\n')
    'let a=1;let b=`x  ${ a }`;\n'
    """
    pieces: list[str] = []
    space = ""
    for kind, piece in _tokens(text):
        if kind == "space":
            space = "\n" if "\n" in piece or space == "\n" else " "
            continue
        if space and pieces:
            last, first = pieces[-1][-1], piece[0]
            words = (last.isalnum() or last in "_$") and (first.isalnum() or first in "_$")
            signs = last in "+-" and first in "+-"
            ends = space == "\n" and last not in ";{(,[&|?:=+-*<>" and first not in "})],.?:&|*"
            if words or signs or ends:
                pieces.append(space)
        space = ""
        varies = kind == "word" and piece == "const"  # nothing is assigned to it
        pieces.append("let" if varies else piece.lstrip() if kind == "pattern" else piece)
    return "".join(pieces) + ("\n" if space == "\n" else "")


def short_cells(program: str) -> str:
    """A generated program with short names for what it calls by a dollar: the cells that its functions read.

    >>> short_cells("const $alpha=c.alpha,pairs$i=a.pairs.rows.i;return $alpha[pairs$i[r]]")
    'const $a=c.alpha,$b=a.pairs.rows.i;return $a[$b[r]]'
    """
    pieces = list(_tokens(program))
    long = dict.fromkeys(piece for kind, piece in pieces if kind == "word" and "$" in piece)
    names = (f"${''.join(each)}" for size in count(1) for each in product(ascii_letters, repeat=size))
    short = dict(zip(long, names, strict=False))
    return "".join(short.get(piece, piece) for _, piece in pieces)


# --- CSS -------------------------------------------------------------------------------------------------


def short_style(text: str) -> str:
    """A style without comments and idle spaces.

    >>> short_style("/* all */ td, th { color: red; margin: 0 calc(1ch + 2px) ; }")
    'td,th{color:red;margin:0 calc(1ch + 2px)}'
    >>> short_style('a > b::after { content: "one: two"; color: red !important; }')
    'a>b::after{content:"one: two";color:red!important}'
    """
    parts = re.split(r'("[^"]*")', re.sub(r"/\*[\s\S]*?\*/", "", text).strip())
    return "".join(part if n % 2 else _short_rules(part) for n, part in enumerate(parts))


def _short_rules(text: str) -> str:
    plain = re.sub(r"\s+", " ", text)
    tight = re.sub(r"\s*([{};,>/])\s*| (!)|(?<=[\w\])])(:) ", r"\1\2\3", plain)
    return re.sub(r";\s*}", "}", tight)


# --- HTML ------------------------------------------------------------------------------------------------

_FLOW = "article|aside|div|dl|footer|h[1-6]|header|nav|ol|p|section|table|ul"
_IMPLIED = re.compile(
    r"(?P<kept><(?P<name>script|style)\b[\s\S]*?</(?P=name)>)"
    r"|</t[dh]>(?=<t[dh][ >]|</tr>(?!<tr[ >]))|</tr>(?=<tr[ >])|</thead>(?=<tbody[ >])|</tbody>(?=</table>)"
    r"|</li>\n?(?=<li[ >])|</d[dt]>(?=<d[dt][ >]|</d(?:l|iv)>)"
    rf"|</p>\n?(?=<(?:{_FLOW})[ >]|</(?:article|aside|div|section|td)>|</li>(?!<li[ >]))"
    r"|(?P<tag><(?!meta)[a-z]\w*(?: [\w-]+(?:=\"[^\"<>]*\")?)+ ?/?>)|&#39;"
)
"""End tags that HTML lets one leave out, for what comes next says that the element is over; tags; quotes.

Where the end tag of what is around it goes too (`</td></tr><tr>`), one of both stays: validators ask for it.
"""


def short_markup(page: str) -> str:
    r"""A page without the end tags, quotes and empty values that every reader puts in again.

    Apostrophes stand as they are; scripts and styles stay.

    >>> short_markup("<ul><li>1</li><li>2</li></ul><script>'</li><li>'</script>")
    "<ul><li>1<li>2</li></ul><script>'</li><li>'</script>"
    >>> short_markup('<td class="p0" title="a b">x="1" </td>')
    '<td class=p0 title="a b">x="1" </td>'
    >>> short_markup('<a href="#i"><path d="m0 1" class="s1"/></a>')
    '<a href=#i><path d="m0 1" class=s1 /></a>'
    >>> short_markup('<b title="a&#39;s">it&#39;s</b>')
    '<b title="a\'s">it\'s</b>'
    """
    return _IMPLIED.sub(_shorter, page)


def _shorter(found: re.Match[str]) -> str:
    if found["kept"] or found["tag"]:
        return found["kept"] or _unquoted(found["tag"])
    return "'" if found[0] == "&#39;" else ""


def _unquoted(tag: str) -> str:
    plain = tag.replace("&#39;", "'").replace('="" ', " ")
    bare = re.sub(r"""="([^\s"'=<>`]+)"(?=[ >])""", r"=\1", plain)
    return re.sub(r"""="([^\s"'=<>`]+)"/>$""", r"=\1 />", bare)
