"""How numbers were shortened, and in which unit they stand: for a column, a parameter or a cell."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ...derivations.unit_text import parse_open
from ..quantity import Printed
from ..result.verdict import INPUT, Change
from .campaign import Array
from .problem import Box, Problem
from .search import Explained, Search

POWERS = (-1, 1, -2, 2, -3, 3, -6, 6)
"""By which powers of ten a unit or a decimal point may be wrong, the likelier first."""
FACTORS = {"2": Fraction(2), "1/2": Fraction(1, 2)}
"""A radius for a diameter, an amplitude for what is between the peaks, and the reverse."""
CONSTANTS = {"ln 10": math.log(10), "2π": 2 * math.pi, "π": math.pi, "√2": math.sqrt(2)}
"""By which a formula goes wrong: ln for lg, turns for radians, an effective value for an amplitude. One
number is met by one of so many by chance: only columns of several are multiplied, or divided, by them."""
MOST_COUNTED = 100
"""Of more rows n and n - 1 are nearer than the digits that are printed mostly tell, and explain by chance."""
ANYTHING = 2.0
"""Of a published value: what moves it by more, to the end of a print, explains whatever it is."""
UNITS = (
    ("rad", "deg"), ("s", "min", "h"), ("mm", "in"), ("m/s", "km/h"), ("Pa", "atm", "mmHg"),
    ("J", "cal", "eV"), ("N", "kgf"),
)  # fmt: skip
"""Units of a kind that are no powers of ten of one another: one may be taken for the other."""


def shortened_inputs(search: Search) -> Iterator[Explained]:
    """A given column whose numbers were shortened otherwise than is said."""
    problem = search.problem
    for name, members in problem.rows.items():
        printed = [problem.unknowns[n].printed for n in members]
        if None in printed or problem.sheet[name].exact or not problem.campaign.suspects(name):
            continue
        if not search.worth(search.resting_on(members)):
            continue
        for change, prints in _shortened([each for each in printed if each]):
            ends = zip(members, prints, strict=True)
            low, high = zip(*(problem.unknowns[n].interval(each) for n, each in ends), strict=True)
            if np.array_equal((low, high), (problem.box.low[members], problem.box.high[members])):
                continue  # of what is exact nothing was cut
            middles = [(one + other) / 2 for one, other in zip(low, high, strict=True)]
            box = problem.box.moved(members, low, high, middles)
            yield from search.if_met([replace(change, cell=name, source=INPUT)], problem, box)


def shortened_tables(search: Search) -> Iterator[Explained]:
    """A published column whose numbers were shortened otherwise than is said."""
    problem = search.problem
    for (source, cell), members in search.groups.items():
        if not search.worth(members):
            continue
        for change, prints in _shortened([problem.published[n].printed for n in members]):
            changed = problem.reprinted(dict(zip(members, prints, strict=True)))
            yield from search.if_met([replace(change, cell=cell, source=source)], changed)


def _shortened(printed: Sequence[Printed]) -> Iterator[tuple[Change, list[Printed]]]:
    """The other ways in which a column may have been shortened, and its numbers as they were printed then."""
    was = printed[0].mode
    would = "rounded" if was == "truncated" else "truncated"
    yield Change("truncated", "", (), "", was, would), [replace(each, mode=would) for each in printed]
    # Of a number with a stated uncertainty no digit says how well it is known.
    own = [n for n, each in enumerate(printed) if each.stated is None]
    for texts in without_zeros([printed[n].text for n in own]):
        prints = list(printed)
        for n, text in zip(own, texts, strict=True):
            prints[n] = replace(printed[n], text=text)
        was, would = next((a.text, b.text) for a, b in zip(printed, prints, strict=True) if a != b)
        yield Change("zeros", "", (), "", was, would), prints


def without_zeros(texts: Sequence[str]) -> list[list[str]]:
    """Numbers of a column without zeros that only say how large they are: to one place, or to as many digits.

    At least two digits stay.

    >>> without_zeros(["12300", "-500"]), without_zeros(["12300", "456"]), without_zeros(["12000", "12345"])
    ([['1.230e4', '-5.0e2'], ['1.23e4', '-500']], [['1.23e4', '456']], [])
    """
    bare = [text.lstrip("+-") for text in texts]
    zeros = [
        min(len(each) - len(each.rstrip("0")), max(len(each) - 2, 0)) if each.isdigit() else 0
        for each in bare
    ]
    digits = [len(each.partition("e")[0].replace(".", "").lstrip("0")) for each in bare]
    most = max((own - zero for own, zero in zip(digits, zeros, strict=True)), default=0)
    to_place = [min(zeros, default=0)] * len(texts)
    to_digits = [min(zero, max(own - most, 0)) for own, zero in zip(digits, zeros, strict=True)]
    ways = [list(map(_shorter, texts, cuts)) for cuts in (to_place, to_digits)]
    return [way for n, way in enumerate(ways) if way != texts and way not in ways[:n]]


def _shorter(text: str, zeros: int) -> str:
    """An integer without so many of the zeros at its end."""
    if not zeros:
        return text
    sign, digits = text[: -len(text.lstrip("+-"))], text.lstrip("+-")
    kept = digits[:-zeros]
    return f"{sign}{kept[0]}.{kept[1:]}e{len(digits) - 1}"


_Way = tuple[Change, tuple[Fraction, ...]]
"""What is wrong with a published column, and by what it, or each of its cells, has to be multiplied."""


@dataclass(frozen=True)
class _Scale:
    """By what numbers may have to be multiplied."""

    factor: Fraction
    says: Change
    """That, of a column that it does not name."""

    @property
    def factors(self) -> tuple[Fraction, ...]:
        """It is one for all cells."""
        return (self.factor,)

    def column(self, cell: str, source: str) -> Change:
        """That of a column."""
        return replace(self.says, cell=cell, source=source)

    def way(self, cell: str, source: str) -> _Way:
        """That, and by what to multiply."""
        return self.column(cell, source), self.factors

    def cell(self, cell: str, source: str, index: tuple[int, ...], of: Printed) -> Change:
        """That of a cell alone, as it would be printed."""
        would = shifted(of, self.says.power).text
        return replace(self.column(cell, source), index=index, printed=of.text, would_print=would)


_POINTS = tuple(_Scale(Fraction(10) ** n, Change("unit", "", (), "", "", "", power=n)) for n in POWERS)
_SAME = _Scale(Fraction(1), Change("unit", "", (), "", "", ""))
_OFTEN = tuple(
    _Scale(Fraction(factor), Change("factor", "", (), "", "", text))
    for name, size in CONSTANTS.items()
    for text, factor in ((name, size), (f"1/({name})" if name[0] == "2" else f"1/{name}", 1 / size))
)
_TWICE = tuple(_Scale(factor, Change("factor", "", (), "", "", text)) for text, factor in FACTORS.items())


def _scales(of: Printed) -> Iterator[_Scale]:
    """What may be wrong with a whole column that is printed like this."""
    yield from _POINTS
    yield from _TWICE
    yield from _other_units(of)


def _other_units(of: Printed) -> Iterator[_Scale]:
    """Those of the units that its own may have been taken for."""
    own = parse_open(of.unit)
    for units in UNITS:
        others = [parse_open(unit) for unit in units]
        # An angle is a pure number as any other is: it is known by the name of its unit.
        if own.text in units or own.dimension == others[0].dimension != ():
            for other in others:
                factor = other.scale / own.scale
                if str(factor.numerator * factor.denominator).strip("0") != "1":  # no power of ten
                    yield _Scale(factor, Change("unit", "", (), "", own.text, other.text))


def shifted(of: Printed, power: int) -> Printed:
    """The same digits with the decimal point elsewhere: 2.97 and 29.7."""
    mantissa, _, exponent = of.text.lower().partition("e")
    places = len(mantissa.partition(".")[2]) - int(exponent or 0) - power
    digits = mantissa.replace(".", "").lstrip("+-0") or "0"
    sign = "-" if mantissa.startswith("-") else ""
    if places < 0:
        text = f"{sign}{digits}e{-places}"
    else:
        padded = digits.zfill(places + 1)
        text = sign + (f"{padded[:-places]}.{padded[-places:]}" if places else padded)
    return replace(of, text=text, value=of.value * Fraction(10) ** power)


def misplaced_inputs(search: Search) -> Iterator[Explained]:
    """A given column in another unit than is said, doubled or halved; a cell of it off by a power of ten."""
    problem, tried, alike = search.problem, list[tuple[Change, Box]](), dict[_Scale, list[list[int]]]()
    for name, members in problem.rows.items():
        printed = problem.unknowns[members[0]].printed
        if printed is None or problem.sheet[name].exact or not problem.campaign.suspects(name):
            continue
        for scale in _other_units(printed):
            alike.setdefault(scale, []).append(members)
        # In another unit of a column a fit to it is far from where it is by this one.
        if search.worth(search.resting_on([*members, *problem.fitted_to(name)])):
            for scale in _scales(printed):
                if (box := _scaled(problem, members, scale.factor)) is not None:
                    tried.append((scale.column(name, INPUT), box))
        for n in members if len(members) > 1 else ():
            if search.worth(search.resting_on([n])):
                unknown = problem.unknowns[n]
                for scale in _POINTS:
                    if (box := _scaled(problem, [n], scale.factor)) is not None:
                        change = scale.cell(name, INPUT, unknown.index, unknown.printed or printed)
                        tried.append((change, box))
    for scale, columns in alike.items():  # a calculator that was left in radians spares no angle
        members = [n for column in columns for n in column]
        box = _scaled(problem, members, scale.factor) if len(columns) > 1 else None
        if box is not None and search.worth(search.resting_on(members)):
            tried.append((scale.column("", INPUT), box))
    alive = [tried[place] for place in search.screened([box for _, box in tried])]
    if not alive:
        return
    starts = problem.restarted(np.stack([box.start for _, box in alive]))
    told = search.of_likeliest([
        (change, problem, replace(box, start=start))
        for (change, box), start in zip(alive, starts, strict=True)
    ])  # fmt: skip
    cells = set[tuple[str, tuple[int, ...]]]()
    for each in told:
        where = each.explanation.first.cell, each.explanation.first.index
        if where[1] and where in cells:
            continue  # its point stands elsewhere: that is told by the least power of ten
        if _tells(each, search.groups.values()):
            cells.add(where)
            yield each
        else:
            search.drop(certain=False)


def _tells(found: Explained, columns: Iterable[Sequence[int]]) -> bool:
    """Whether not every value comes out of what an explanation allows: so many turns hold any sine.

    `columns`: the places of each published column.
    """
    problem, box = found.problem, found.box
    slopes = np.abs(np.nan_to_num(problem.slopes(problem.at(found.best.point), box)))
    moved = (box.low != problem.box.low) | (box.high != problem.box.high)
    reach = slopes[:, moved] @ (box.width[moved] / 2)
    sizes = np.abs(problem.centre)
    for members in columns:  # a 0 is as large as what stands beside it
        sizes[members] = sizes[members].max()
    return bool((reach <= ANYTHING * sizes)[(reach > 0) & (sizes > 0)].all())


def _scaled(problem: Problem, members: Sequence[int], times: Fraction) -> Box | None:
    """The box with some cells so many times as large; None where that is not allowed."""
    factor, allowed = float(times), [problem.unknowns[n].allowed for n in members]
    starts = [problem.box.start[n] * factor for n in members]
    ends = [
        bounds.clip(problem.box.low[n] * factor, problem.box.high[n] * factor)
        for n, bounds in zip(members, allowed, strict=True)
    ]
    if any(not low <= start <= high for (low, high), start in zip(ends, starts, strict=True)):
        return None
    return problem.box.moved(members, [low for low, _ in ends], [high for _, high in ends], starts)


def misplaced_tables(search: Search) -> Iterator[Explained]:
    """A published column, or a cell of it, in another unit than is said, or wrong by a factor."""
    problem, tried = search.problem, list[tuple[Change, Problem, Box | None]]()
    for (source, cell), members in search.groups.items():
        if search.worth(members):
            more = _OFTEN if len(members) > 1 else ()
            ways = *_ways(problem, source, cell, members), *(each.way(cell, source) for each in more)
            tried += ((change, _multiplied(problem, members, *by), problem.box) for change, by in ways)
        for n in members if len(members) > 1 else ():
            if search.worth([n]):
                value = problem.published[n]
                for scale in _POINTS:
                    change = scale.cell(cell, source, value.index, value.printed)
                    tried.append((change, _multiplied(problem, [n], scale.factor), problem.box))
    yield from search.of_likeliest(tried)


def misplaced_together(search: Search) -> Iterator[Explained]:
    """Several published columns, each in another unit or by a factor: each as it is nearest to its cells."""
    problem, changes = search.problem, list[Change]()
    changed, cells = problem, problem.guessing.at(problem.box.start).cells
    for (source, cell), members in search.groups.items():
        with np.errstate(all="ignore"):
            times = cells[members] / problem.centre[members]
        ways = _SAME.way(cell, source), *_ways(problem, source, cell, members)
        change, by = min(ways, key=lambda way: _off(times, way[1]))
        if by != _SAME.factors:
            changed = _multiplied(changed, members, *by)
            changes.append(change)
    if len(changes) > 1:
        yield from search.if_met(changes, changed)


def _off(times: Array, factors: Sequence[Fraction]) -> float:
    """How far numbers are from being multiplied so."""
    found = float(np.abs(times / np.array(factors, dtype=float) - 1).max())
    return found if np.isfinite(found) else np.inf


def _ways(problem: Problem, source: str, cell: str, members: Sequence[int]) -> Iterator[_Way]:
    """What may be wrong with a published column."""
    for scale in _scales(problem.published[members[0]].printed):
        yield scale.way(cell, source)
    for numbers, wrong, right in _divisors(problem, members):
        text = "/".join(_counted(numbers, less) for less in (wrong, right))
        by = tuple(Fraction(number - wrong, number - right) for number in numbers)
        yield Change("factor", cell, (), source, "", text), by
        root = tuple(Fraction(math.sqrt(each)) for each in by)
        yield Change("factor", cell, (), source, "", f"√({text})"), root


def _divisors(problem: Problem, members: Sequence[int]) -> dict[tuple[tuple[int, ...], int, int], None]:
    """By what a sum under a published column may have been divided that has other degrees of freedom.

    The number of rows under each of its cells; how many fewer were counted, and are to be. Of a sum over rows
    n stands for n - 1 or the reverse, of the scatter about a fit both for what its parameters leave.
    """
    campaign = problem.campaign
    column = campaign.sheet[problem.published[members[0]].cell]
    under, rows = (column, *campaign.sheet.ancestors(column)), [problem.places[n][1] for n in members]
    asked = [
        (each.name, axis.name, pair)
        for each in under
        if each.axis == column.axis
        for axis in campaign.sheet.summed_axes(each)
        for pair in ((0, 1), (1, 0))
    ]
    names = {each.name for each in under}
    asked += (
        (curve.name, curve.axis, (less, len(curve.fitted)))
        for curve in campaign.inputs.workbook.curves
        if curve.scatter in names and campaign.sheet[curve.name].axis == column.axis
        for less in (0, 1)
    )
    found = dict[tuple[tuple[int, ...], int, int], None]()
    for name, axis, (wrong, right) in asked:
        numbers = tuple(campaign.values.over(name, row, axis)[0] for row in rows)
        if wrong != right and max(wrong, right) < min(numbers) and max(numbers) <= MOST_COUNTED:
            found[numbers, wrong, right] = None
    return found


def _counted(numbers: Sequence[int], less: int) -> str:
    """So many fewer than the rows: a number if all cells have as many."""
    if len(set(numbers)) == 1:
        return str(numbers[0] - less)
    return f"(n - {less})" if less else "n"


def _multiplied(problem: Problem, members: Sequence[int], *times: Fraction) -> Problem:
    """The same with some published values so many times as large, all of them alike or each by its own."""
    factors = times if len(times) == len(members) else times * len(members)
    pairs = zip(members, factors, strict=True)
    return problem.reprinted({n: _other_unit(problem.published[n].printed, factor) for n, factor in pairs})


def _other_unit(of: Printed, times: Fraction) -> Printed:
    return replace(of, value=(of.value - of.zero) * times + of.zero, scale=of.scale * times)
