"""How the workbook's cells look: formats, number formats, symbols, and text that stays text."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from ...derivations.vocabulary import with_index
from ..document.notation import fragments
from ..result.numbers import Numeral, rounded

LONGEST = 32_000
"""Characters of a cell; Excel takes 32 767."""
_LINE = 15
"""Points that a line of text is high."""
_SMALL = 1e-6
"""Below, decimals are mostly zeros."""
MOST_DECIMALS = 9
_NOTHING = f"{1e-15:.15f}"
"""What is less is shown as 0 where nothing is expected. (Not every reader knows exponents there.)"""
_INK, _PAPER, _PALE, _LINE_COLOUR = "#1F2A36", "#FFFFFF", "#EEF2F6", "#C9D3DD"
_INPUT, _INPUT_INK, _ERROR = "#FFF8DC", "#1F4E9E", "#B00020"

_FORMATS: dict[str, dict[str, Any]] = {
    "title": {"bold": True, "font_size": 16, "font_color": _INK},
    "subtitle": {"font_color": "#55606B"},
    "section": {"bold": True, "font_size": 12, "font_color": _INK, "bottom": 1, "bottom_color": _INK},
    "group": {"bold": True, "font_color": "#55606B"},
    "head": {
        "bold": True,
        "bg_color": _INK,
        "font_color": _PAPER,
        "valign": "vcenter",
        "text_wrap": True,
        "align": "center",
    },
    "meaning": {"text_wrap": True, "valign": "top", "align": "center", "font_size": 9, "bg_color": _PALE},
    "source": {"align": "center", "bg_color": _PALE, "font_size": 9},
    "symbol": {
        "italic": True,
        "align": "center",
        "bg_color": _PALE,
        "bottom": 1,
        "bottom_color": _LINE_COLOUR,
    },
    "lowered": {"italic": True, "font_script": 2},
    "raised": {"italic": True, "font_script": 1},
    "italic": {"italic": True},
    "name": {"bold": True, "valign": "top"},
    "text": {"valign": "top"},
    "aside": {"font_color": "#55606B", "align": "left", "indent": 1},
    "unit": {"valign": "top", "align": "left", "indent": 1},
    "wrapped": {"text_wrap": True, "valign": "top"},
    "index": {"align": "center", "num_format": "0", "font_color": "#55606B"},
    "input": {
        "bg_color": _INPUT,
        "font_color": _INPUT_INK,
        "border": 1,
        "border_color": _LINE_COLOUR,
        "valign": "top",
    },
    "fixed": {"bg_color": _PALE, "border": 1, "border_color": _LINE_COLOUR, "valign": "top"},
    "number": {"valign": "top"},
    "result": {"valign": "top", "bold": True},
    "step": {"font_color": "#55606B", "num_format": "General", "font_size": 9},
    "outside": {"font_color": _ERROR, "bg_color": "#FFE3C2"},
    "error": {"font_color": _ERROR, "bold": True},
    "finding": {"font_color": _ERROR, "bold": True, "bg_color": "#FBE9EC"},
}


_FORMATS["chosen"] = _FORMATS["input"] | {"align": "left", "indent": 1}
"""A word that may be changed, beside a number."""


class Style:
    """Formats of a workbook by name, each made once, in the order in which they are first used."""

    def __init__(self, book: Any) -> None:
        self._book = book
        self._made: dict[tuple[str, str], Any] = {}

    def __call__(self, name: str, number_format: str = "") -> Any:
        """The format of a name, with a number format."""
        key = (name, number_format)
        if key not in self._made:
            properties = {**_FORMATS[name], **({"num_format": number_format} if number_format else {})}
            self._made[key] = self._book.add_format(properties)
        return self._made[key]

    def page(self, worksheet: Any, title: str, subtitle: str = "", widths: Iterable[float] = ()) -> None:
        """Begin a worksheet: what it is, how wide its columns are, and that it is printed on A4 across."""
        self.text(worksheet, 0, 0, title, "title")
        if subtitle:
            self.text(worksheet, 1, 0, subtitle, "subtitle")
        for column, width in enumerate(widths):
            worksheet.set_column(column, column, width)
        worksheet.set_landscape()
        worksheet.set_paper(9)
        worksheet.fit_to_pages(1, 0)

    # --- cells

    def section(self, worksheet: Any, row: int, title: str, columns: int) -> None:
        """Write a heading that goes across some columns."""
        for column in range(columns):
            self.text(worksheet, row, column, "" if column else title, "section")

    def sentence(self, worksheet: Any, row: int, line: str, columns: int, width: float) -> None:
        """Write a sentence across some columns, which together are so wide, in a row as high as it needs."""
        worksheet.merge_range(row, 0, row, columns - 1, "", self("wrapped"))
        self.text(worksheet, row, 0, line, "wrapped")
        worksheet.set_row(row, height([(line, width)]))

    def text(self, worksheet: Any, row: int, column: int, text: str, name: str = "text") -> None:
        """Write text that stays text, whatever it begins with."""
        short = text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
        worksheet.write_string(row, column, short, self(name))

    def formula(
        self, worksheet: Any, row: int, column: int, formula: str, value: Any, form: Any, array: bool = False
    ) -> None:
        """Write a formula with the value that it has now."""
        if value is None:
            value = "#N/A"
        if array:
            worksheet.write_array_formula(row, column, row, column, formula, form, value)
        else:
            worksheet.write_formula(row, column, formula, form, value)

    def symbol(self, worksheet: Any, row: int, column: int, latex: str, name: str = "symbol") -> None:
        """Write the LaTeX of a symbol as letters with subscripts."""
        parts = fragments(with_index(latex))
        scripts = {"": "italic", "_": "lowered", "^": "raised"}
        rich = [piece for script, text in parts for piece in (self(scripts[script]), text)]
        if len(parts) > 1:
            worksheet.write_rich_string(row, column, *rich, self(name))
        else:
            self.text(worksheet, row, column, parts[0][1] if parts else "", name)


# --- numbers ---------------------------------------------------------------------------------------------


def number_format(figure: Numeral | None) -> str:
    """The number format with which a spreadsheet shows a number as the report does.

    >>> number_format(rounded(1.258, 4)), number_format(rounded(9.6e8, 4)), number_format(rounded(1525.4, 4))
    ('0.000', '0.000E+00', '0')

    What is nothing, as the steps of a fit are where it rests, is shown as 0 whatever rounding leaves of it in
    a spreadsheet, and needs no more room than that:

    >>> number_format(Numeral(False, "0", "0" * 22, None)).split(";")
    ['[>=0.000000000000001]0.0E+00', '[<=-0.000000000000001]-0.0E+00', '0']
    """
    if figure is None:
        return "General"
    if len(figure.fraction) > MOST_DECIMALS and not int(figure.whole + figure.fraction):
        return f"[>={_NOTHING}]0.0E+00;[<=-{_NOTHING}]-0.0E+00;0"
    point = f"0.{'0' * len(figure.fraction)}" if figure.fraction else "0"
    return point if figure.exponent is None else f"{point}E+00"


def typical_format(values: Iterable[float | str | None], digits: int) -> str:
    """A number format that shows so many significant digits of a column's typical cell.

    Errors do not count. It is the middle of a column's sizes: a fitted curve begins near zero and must not
    set the digits.
    """
    known = sorted(abs(value) for value in values if isinstance(value, float) and value)
    return number_format(rounded(known[len(known) // 2], digits) if known else None)


def open_format(decimals: int, value: float = 0.0) -> str:
    """A number format for an input: at least the decimals as printed, and all that somebody types.

    `value`: what stands there; so small a number that its decimals would leave zeros has a power of ten.

    >>> open_format(1), open_format(0), open_format(17, 1.008e-14)
    ('0.0########', 'General', '0.000E+00')
    """
    if decimals > MOST_DECIMALS and 0 < abs(value) < _SMALL:
        digits = decimals + math.floor(math.log10(abs(value)))
        return f"0.{'0' * digits}E+00" if digits > 0 else "0E+00"
    shown = max(0, min(decimals, MOST_DECIMALS))
    if not shown:
        return "General"  # Excel would leave a decimal point behind a whole number
    return f"0.{'0' * shown}{'#' * (MOST_DECIMALS - shown)}"


# --- text ------------------------------------------------------------------------------------------------


def said(unit: str) -> str:
    """A unit in brackets behind a name, as in the header of measurements.csv."""
    return f" [{unit}]"


def height(texts: Iterable[tuple[str, float]], least: int = 1) -> int:
    """How high a row of wrapped texts must be, in points; each with the width of its column in letters."""
    lines = [sum(_lines(part, 1.08 * width) for part in text.split("\n")) for text, width in texts]
    return _LINE * max([least, *lines])


def _lines(text: str, width: float) -> int:
    """How many lines a text breaks into, word by word."""
    lines, used = 1, 0.0
    for word in text.split(" "):
        if used and used + 1 + len(word) > width:
            lines, used = lines + 1, 0.0
        used += len(word) + (1 if used else 0)
        while used > width:
            lines, used = lines + 1, used - width
    return lines
