"""Numbers and units as they are shown: as many digits as are known, in both formats, aligned.

A shown number is text. It is made from the exact value of the double, so that it is the same everywhere,
and no calculation ever reads it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_HALF_EVEN, Context, Decimal, localcontext

__all__ = ["RAISED", "Numeral", "decimals", "is_pure", "read", "rounded", "shown", "stated", "table_format"]

_BEYOND = 2
"""An integer part with more digits than these beyond the known ones is written with a power of ten."""
_LEADING = 3
"""So are numbers with more zeros than this behind the decimal point."""
_DOUBLE = 15
"""Digits that every double has."""
_GROUPS = 5
"""From this many digits on, the integer part is grouped by three."""
MINUS = "\u2212"
THIN = "\u202f"
RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


@dataclass(frozen=True)
class Numeral:
    """A number as it is shown.

    Parameters
    ----------
    negative : bool
    whole : str
        Digits before the decimal point.
    fraction : str
        Digits behind it.
    exponent : int or None
        The power of ten that it is multiplied by; None if none is written.
    """

    negative: bool
    whole: str
    fraction: str
    exponent: int | None = None

    @property
    def plain(self) -> str:
        """In plain characters, ``-1.019e9``: what a program or siunitx reads."""
        point = f".{self.fraction}" if self.fraction else ""
        power = "" if self.exponent is None else f"e{self.exponent}"
        return f"{'-' if self.negative else ''}{self.whole}{point}{power}"

    @property
    def text(self) -> str:
        """For the eye: a real minus sign, thin spaces in long numbers, a written power of ten."""
        whole = self.whole
        if len(whole) >= _GROUPS:
            head = len(whole) % 3
            parts = [whole[:head]] if head else []
            whole = THIN.join([*parts, *(whole[place : place + 3] for place in range(head, len(whole), 3))])
        point = f".{self.fraction}" if self.fraction else ""
        return f"{MINUS if self.negative else ''}{whole}{point}{self.power}"

    @property
    def power(self) -> str:
        """The power of ten, `` × 10⁹``; empty if none is written."""
        return "" if self.exponent is None else f"\u00a0×\u00a010{str(self.exponent).translate(RAISED)}"

    @property
    def tex(self) -> str:
        """For LaTeX."""
        return rf"\num{{{self.plain}}}"


def read(text: str) -> Numeral | None:
    """Read a printed number as it stands, for its alignment; None if it is not plain digits."""
    match = re.fullmatch(r"([+-]?)(\d+)(?:\.(\d+))?(?:[eE]([+-]?\d+))?", text, re.ASCII)
    if match is None or match[1] == "+":
        return None
    return Numeral(match[1] == "-", match[2], match[3] or "", None if match[4] is None else int(match[4]))


def _rounded(value: float, digits: int) -> tuple[Decimal, int]:
    """Round the exact value to significant digits, and the exponent of its first digit."""
    exact = Decimal(value)
    if not exact:
        return exact, 0
    with localcontext(Context(prec=max(1, digits), rounding=ROUND_HALF_EVEN)) as context:
        short = context.plus(exact)
    return short, short.adjusted()


def rounded(value: float, digits: int, scientific: bool | None = None) -> Numeral:
    r"""Show a number with significant digits.

    Parameters
    ----------
    value : float
        A finite number.
    digits : int
        Significant digits, at least 1. An integer part that is a little longer is written in full, for a
        zero in place of a known digit would be wrong.
    scientific : bool or None
        Whether to write a power of ten; None decides by the size.

    Examples
    --------
    >>> rounded(1.019e9, 4).text
    '1.019\xa0×\xa010⁹'
    >>> rounded(1525.37, 4).plain, rounded(0.5, 3).plain, rounded(1.2996, 4).plain
    ('1525', '0.500', '1.300')
    """
    short, first = _rounded(value, digits)
    if scientific is None:
        scientific = first >= digits + _BEYOND or first < -_LEADING
    with localcontext(Context(prec=400, rounding=ROUND_HALF_EVEN)):
        if scientific:
            mantissa = f"{short.scaleb(-first):.{max(0, digits - 1)}f}"
            return _figure(mantissa, first)
        places = max(0, digits - 1 - first)
        # Digits before the point beyond the known ones come from the value itself, not from its rounding.
        exact = Decimal(value) if first >= digits else short
        return _figure(f"{exact:.{places}f}", None)


def decimals(value: float, places: int) -> Numeral:
    """Show a number with a given number of decimals: as another one is printed."""
    with localcontext(Context(prec=400, rounding=ROUND_HALF_EVEN)):
        return _figure(f"{Decimal(value):.{max(0, places)}f}", None)


def _figure(text: str, exponent: int | None) -> Numeral:
    negative = text.startswith("-")
    whole, _, fraction = text.lstrip("-").partition(".")
    if not int(whole + fraction):
        negative = False
    return Numeral(negative, whole, fraction, exponent)


def shown(values: Iterable[float | None], scale: float, digits: int) -> list[Numeral | None]:
    """Show a column in one notation: a power of ten for all its numbers or for none.

    Parameters
    ----------
    values : iterable of float or None
        In SI; None where a cell has no value.
    scale : float
        One unit that is shown, in SI.
    digits : int
        Significant digits.
    """
    # A double divided by a scale such as 1e-6 is not exact; the error is far below any shown digit.
    scaled = [None if value is None else value / scale for value in values]
    known = [value for value in scaled if value]
    scientific = any(rounded(value, digits).exponent is not None for value in known)
    return [None if value is None else rounded(value, digits, scientific) for value in scaled]


def stated(value: float, u: float, most: int = 2) -> tuple[Numeral, Numeral]:
    r"""Show a value and its standard uncertainty, with as many digits as the uncertainty leaves.

    The uncertainty has at most two digits; it is rounded up where rounding would make it smaller by more than
    a twentieth (JCGM 100, 7.2.6; EA-4/02, 6.3).

    Parameters
    ----------
    value : float
        A finite number.
    u : float
        In the same unit, greater than 0.
    most : int
        Digits of the uncertainty.

    Returns
    -------
    tuple of Numeral
        Both with the same decimals and the same power of ten, if a double has so many digits.

    Examples
    --------
    >>> [numeral.plain for numeral in stated(1.30264345, 0.00350146)]
    ['1.3026', '0.0035']
    >>> [numeral.plain for numeral in stated(1.01871737e9, 3.756e7)]
    ['1.019e9', '0.038e9']
    >>> [numeral.plain for numeral in stated(0.2, 9.96, 1)], [n.plain for n in stated(0.0, 0.104, 1)]
    (['0', '10'], ['0.0', '0.1'])
    """
    places = _places(u, most)
    size = max(abs(value), u)
    first = max(_rounded(size, 1)[1], places)
    if first - places >= _DOUBLE:  # more digits than a double has: each by itself
        return rounded(value, _DOUBLE), rounded(u, most)
    # Zeros in front of the point would pass for digits that are known.
    power = first if places > 1 else rounded(size, first - places + 1).exponent
    with localcontext(Context(prec=400, rounding=ROUND_HALF_EVEN)):
        step = Decimal(1).scaleb(places)
        up = (Decimal(u) / step).to_integral_value(ROUND_CEILING)
        short = (Decimal(u) / step).to_integral_value()
        told = up if short * step < Decimal(u) * Decimal("0.95") else short
        behind = max(0, (power or 0) - places)
        pair = [(Decimal(value) / step).to_integral_value() * step, told * step]
        value_text, u_text = (f"{number.scaleb(-(power or 0)):.{behind}f}" for number in pair)
    return _figure(value_text, power), _figure(u_text, power)


def _places(u: float, digits: int) -> int:
    """The power of ten of the last digit of an uncertainty, after it was rounded."""
    return _rounded(u, digits)[1] - digits + 1


def table_format(figures: Iterable[Numeral | None]) -> str:
    """The ``table-format`` of siunitx that holds all numbers of a column.

    >>> table_format([read("2.334"), read("-51.0")])
    '-2.3'
    """
    known = [figure for figure in figures if figure is not None]
    sign = "-" if any(figure.negative for figure in known) else ""
    whole = max((len(figure.whole) for figure in known), default=1)
    fraction = max((len(figure.fraction) for figure in known), default=0)
    point = f".{fraction}" if fraction else ""
    powers = [str(figure.exponent) for figure in known if figure.exponent is not None]
    power = ""
    if powers:
        minus = "-" if any(text.startswith("-") for text in powers) else ""
        power = f"e{minus}{max(len(text.lstrip('-')) for text in powers)}"
    return f"{sign}{whole}{point}{power}"


def is_pure(unit: str) -> bool:
    """Whether a unit says that a number is a pure one."""
    return unit.strip() in {"", "1", "-", "–", "—", "−"}
