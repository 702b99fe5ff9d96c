"""Numbers and units as they are shown: as many digits as are known, in both formats, aligned.

A shown number is text, and no calculation ever reads it. It is made from the fifteen digits that every double
has, and a half of them goes up (ISO 80000-1, B.3, rule B), as in spreadsheets: 0.0437225 is shown alike by
all that computed it, whatever the last bit of each.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_HALF_UP, Context, Decimal, localcontext

MOST = 2
"""Digits of an uncertainty, unless somebody wants fewer (JCGM 100, 7.2.6)."""
SURE = 6
"""Digits of an uncertainty that are believed: what follows is of how it was computed."""
_BEYOND = 2
"""An integer part with more digits than these beyond the known ones is written with a power of ten."""
LEADING = 3
"""So are numbers with more zeros than this behind the decimal point."""
_NOTHING = 1e-9
"""Of its uncertainty: what is left of a difference of two numbers that are alike is not more."""
_EXACTLY = Context(prec=800, rounding=ROUND_HALF_UP)
_DOUBLE = 15
"""Digits that every double has."""
_GROUPS = 5
"""From this many digits on, the integer part is grouped by three."""
LEAST = 1e-15
"""Of a probability below this nobody knows more than that it is."""
MINUS = "\u2212"
THIN = "\u202f"
RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


@dataclass(frozen=True)
class Numeral:
    """A number as it is shown."""

    negative: bool
    whole: str
    """Digits before the decimal point."""
    fraction: str
    """Digits behind it."""
    exponent: int | None = None
    """The power of ten that it is multiplied by; None if none is written."""

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


def read(text: str) -> Numeral | None:
    """Read a printed number as it stands, for its alignment; None if it is not plain digits."""
    match = re.fullmatch(r"([+-]?)(\d+)(?:\.(\d+))?(?:[eE]([+-]?\d+))?", text, re.ASCII)
    if match is None or match[1] == "+":
        return None
    return Numeral(match[1] == "-", match[2], match[3] or "", None if match[4] is None else int(match[4]))


def order(value: float) -> int:
    """The power of ten of the first digit of a number; 0 for zero."""
    return Decimal(repr(value)).adjusted() if value else 0


def last_place(value: float, u: float, digits: int, most: int = MOST) -> int:
    """The power of ten of the last digit that is shown of a number: the one rule that all views ask.

    It is that of the last digit of its uncertainty; a number that is less than that keeps one digit, for it
    is not zero, unless it is so much less that it comes from rounding. Where nothing is known of an
    uncertainty, the number has so many significant digits, and an integer part that is a little longer is
    written in full: a zero in place of a known digit would be wrong.
    What is certain is written without idle zeros.

    Parameters
    ----------
    value : float
        A finite number.
    u : float
        Its standard uncertainty in the same unit; 0 if it is certain, NaN if nothing is known.
    digits : int
        Significant digits, at least 1, where no uncertainty tells.
    most : int
        Digits of an uncertainty.

    Examples
    --------
    >>> last_place(1.30264, 0.0035015, 4), last_place(0.0034, 0.02, 4), last_place(50.0, 9.96, 4)
    (-4, -3, 0)
    >>> last_place(12.5, 0.0, 4), last_place(12.5, math.nan, 4), last_place(3e-14, 0.25, 4)
    (-1, -2, -2)
    >>> last_place(7.96e35, 1.4e46, 4)
    35
    """
    if 0 < u < math.inf:
        first, size = order(value), order(max(abs(value), u))
        least = first if abs(value) > _NOTHING * u else max(first, 0)
        return min(max(_told(u, most)[1], size - _DOUBLE + 1), least)  # a double has no more
    place = order(value) - digits + 1
    if not u:
        place = max(place, min(0, int(_round(_kept(value), digits).normalize().as_tuple().exponent)))
    return 0 if 0 < place <= _BEYOND else place


def _kept(value: float, digits: int = 0) -> Decimal:
    """A double in the digits that every double has, or in more."""
    return _round(Decimal(value), max(_DOUBLE, digits))


def _round(value: Decimal, digits: int, rounding: str = ROUND_HALF_UP) -> Decimal:
    """With significant digits."""
    with localcontext(Context(prec=digits, rounding=rounding)) as context:
        return context.plus(value)


def _told(u: float, most: int) -> tuple[Decimal, int]:
    """An uncertainty as it is told, and the power of ten of its last digit.

    Rounded, but up where rounding would make it smaller by more than a twentieth (JCGM 100, 7.2.6; EA-4/02,
    6.3). Whether it is a half, the digits say that are believed.
    """
    short = _round(_round(_kept(u), SURE), most)
    if short < Decimal(u) * Decimal("0.95"):
        short = _round(Decimal(u), most, ROUND_CEILING)
    return short, short.adjusted() - most + 1


def at(value: float, place: int, scientific: bool | None = None) -> Numeral:
    r"""Show a number up to a digit.

    Parameters
    ----------
    value : float
        A finite number.
    place : int
        The power of ten of its last digit.
    scientific : bool or None
        Whether to write a power of ten; None decides: where zeros in front of the point would pass for digits
        that are known, and where too many stand behind it.

    Examples
    --------
    >>> at(1.01871737e9, 6).text, at(1525.37, 0).plain, at(9.9996, -3).plain
    ('1.019\xa0×\xa010⁹', '1525', '10.000')
    """
    with localcontext(_EXACTLY):
        short = _to(value, place)
        first = short.adjusted() if short else 0
        if scientific is None:
            scientific = bool(short) and (place > 0 or first < -LEADING)
        if not scientific:
            return _written(short, place, None)
        # 9.996e9 becomes 1.000e10: a power of ten keeps the number of digits, as every spreadsheet does.
        return _written(short, place + first - order(value), first)


def _to(value: float, place: int) -> Decimal:
    return _kept(value, order(value) - place + 1).quantize(Decimal(1).scaleb(place))


def _written(short: Decimal, place: int, power: int | None) -> Numeral:
    """What was rounded to a place, with a power of ten."""
    behind = max(0, (power or 0) - place)
    return _figure(f"{short.scaleb(-(power or 0)):.{behind}f}", power)


def rounded(value: float, digits: int) -> Numeral:
    r"""Show a number with significant digits.

    Examples
    --------
    >>> rounded(1.019e9, 4).text
    '1.019\xa0×\xa010⁹'
    >>> rounded(1525.37, 3).plain, rounded(0.5, 3).plain, rounded(1.2996, 4).plain
    ('1525', '0.500', '1.300')
    """
    return at(value, last_place(value, math.nan, digits))


def decimals(value: float, places: int) -> Numeral:
    """Show a number with a given number of decimals: as another one is printed."""
    return at(value, -max(0, places), scientific=False)


def chance(probability: float, other: float, places: int = 2) -> str:
    """A probability in percent, and that of the contrary: it is told to be 0 or 1 only where it is.

    >>> chance(0.66, 0.34), chance(1.0, 1e-19), chance(1e-9, 1 - 1e-9), chance(0.0, 1.0)
    ('66.00 %', 'more than 99.99 %', 'less than 0.01 %', '0 %')
    >>> chance(0.0004, 0.9996, 1)
    'less than 0.1 %'
    """
    if probability == 0.0 or other == 0.0:
        return f"{100 * probability:.0f} %"
    least = 10.0 ** -(places + 2)
    if probability < least:
        return f"less than {decimals(100 * least, places).text} %"
    if probability > 1 - least:
        return f"more than {decimals(100 * (1 - least), places).text} %"
    return f"{decimals(100 * probability, places).text} %"


def degrees_of_freedom(number: float) -> str:
    """How many there are, in words.

    >>> degrees_of_freedom(1), degrees_of_freedom(8.2)
    ('1 degree of freedom', '8 degrees of freedom')
    """
    said = f"{number:.0f}"
    return f"{said} degree{'s' * (said != '1')} of freedom"


def probability(p: float) -> str:
    """A probability with one digit, or with one of what is missing to 1; of tiny ones that they are.

    >>> probability(6.25e-12), probability(0.0), probability(0.34), probability(0.968)
    ('6e-12', 'below 1e-15', '0.3', '0.97')
    """
    if p < LEAST:
        return f"below {rounded(LEAST, 1).plain}"
    return at(p, min(order(p), order(1 - p))).plain if p < 1 else "1"


def _figure(text: str, exponent: int | None) -> Numeral:
    negative = text.startswith("-")
    whole, _, fraction = text.lstrip("-").partition(".")
    if not int(whole + fraction):
        negative = False
    return Numeral(negative, whole, fraction, exponent or None)  # a power of 0 is no power


def shown(values: Iterable[float | None], places: Iterable[int]) -> tuple[Numeral | None, ...]:
    """Show a column in one notation: a power of ten for all its numbers or for none.

    Parameters
    ----------
    values : iterable of float or None
        In the unit that is shown; None where a cell has no value.
    places : iterable of int
        The power of ten of the last digit of each.

    Examples
    --------
    >>> [figure.plain for figure in shown([1.18425, 2.56288e-4, 0.0], [-5, -9, -5])]
    ['1.18425', '2.56288e-4', '0.00000']
    """
    cells = list(zip(values, places, strict=True))
    found = [None if value is None else at(value, place) for value, place in cells]
    if all(each is None or each.exponent is None for each in found):
        return tuple(found)
    return tuple(None if value is None else at(value, place, scientific=True) for value, place in cells)


def uncertainty(u: float, most: int = MOST) -> Numeral:
    """Show a standard uncertainty by itself.

    >>> uncertainty(0.00350146).plain, uncertainty(0.0996).plain, uncertainty(0.014, 1).plain
    ('0.0035', '0.10', '0.02')
    """
    short, place = _told(u, most)
    return at(float(short), place)


def stated(value: float, u: float, most: int = MOST) -> tuple[Numeral, Numeral]:
    r"""Show a value and its standard uncertainty, with as many digits as the uncertainty leaves.

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
    >>> [numeral.plain for numeral in stated(0.2, 9.96)], [n.plain for n in stated(0.0, 0.104, 1)]
    (['0', '10'], ['0.0', '0.1'])
    """
    told, place = _told(u, most)
    if place < (own := last_place(value, u, 1, most)):
        return at(value, own), uncertainty(u, most)
    power = at(max(abs(value), u), place).exponent
    with localcontext(_EXACTLY):
        return _written(_to(value, place), place, power), _written(told, place, power)


def for_json(value: float | None) -> float | None:
    """A number as JSON can hold it, which has none that are not finite."""
    return float(value) if value is not None and math.isfinite(value) else None


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
