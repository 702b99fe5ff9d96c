"""Cells that are printed with other digits: which, and how they would have to be printed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, pairwise

import numpy as np

from ..judge.chain import Numbered
from ..quantity import Printed
from ..result.verdict import INPUT, Change
from .campaign import Array
from .digits import is_slip, moved, respelt, slips
from .minimax import Best, best
from .problem import Box, Problem
from .search import HOPELESS, LOOKED_INTO, Conflict, Explained, Search

RANGE = 10.0
"""A misprinted number is looked for between a tenth and ten times what is printed."""
PIECES = 160
"""Into how many pieces that range is cut."""
TRIED = 3
"""In how many of them a search begins: where the others have least left to do."""
INTO, ZOOMS = 16, 16
"""Into how many smaller ones an interval is cut, and how often: as far as doubles are apart."""
FURTHEST = 1 << 20
"""Units of the last digit up to which the ways to print a cell are followed."""
LISTED = 12
"""How many of them are listed at most."""
PAIRS = 100
"""How many pairs of cells are looked into."""


# --- a cell that may be misprinted ------------------------------------------------------------------------


@dataclass(frozen=True)
class _Cell:
    """A printed cell: ``n`` is its place among the published values, or among the unknowns if it is given."""

    n: int
    given: bool
    printed: Printed
    touches: frozenset[int]

    def ignored(self, problem: Problem, box: Box) -> tuple[Problem, Box]:
        """What is asked if its digits say nothing."""
        if not self.given:
            return problem.ignoring({self.n}), box
        low, high = _range(problem, self.n)
        return problem, box.moved([self.n], [low], [high], [box.start[self.n]])

    def reprinted(self, problem: Problem, box: Box, units: int) -> tuple[Problem, Box]:
        """What is asked if it is printed so many units of its last digit further."""
        printed = respelt(self.printed, units)
        if not self.given:
            return problem.reprinted({self.n: printed}), box
        low, high = problem.unknowns[self.n].interval(printed)
        start = float(box.start[self.n])
        start = start if low <= start <= high else min(max(float(printed.value), low), high)
        return problem, box.moved([self.n], [low], [high], [start])

    def units(self, problem: Problem, point: Array) -> int | None:
        """How many units further it prints at a point; None if it has no value there."""
        value = point[self.n] if self.given else problem.guessing.evaluate(point[None])[0, self.n]
        return moved(self.printed, Fraction(float(value))) if np.isfinite(value) else None

    def recomputed(self, problem: Problem) -> int | None:
        """How many units further it prints as recomputed from what is printed, if it is published."""
        value = float("nan") if self.given else problem.at(problem.box.start).cells[self.n]
        return moved(self.printed, Fraction(float(value))) if np.isfinite(value) else None

    def change(self, problem: Problem, would: str, also: Sequence[str], span: tuple[str, ...]) -> Change:
        """What is claimed."""
        if self.given:
            unknown = problem.unknowns[self.n]
            where = unknown.column, unknown.index, INPUT
        else:
            value = problem.published[self.n]
            where = value.cell, value.index, value.source
        return Change("misprint", *where, self.printed.text, would, tuple(also), span=span)


def _cells(search: Search) -> Iterator[_Cell]:
    problem = search.problem
    for n, unknown in enumerate(problem.unknowns):
        touches = search.resting_on([n])
        if unknown.printed is not None and touches and problem.campaign.suspects(unknown.column):
            yield _Cell(n, True, unknown.printed, touches)
    for n, value in enumerate(problem.published):
        yield _Cell(n, False, value.printed, frozenset({n}))


# --- how it would be printed ------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Told:
    """How a cell would be printed, and the problem as it would be then."""

    change: Change
    units: int
    problem: Problem
    box: Box
    best: Best


def _told(
    cell: _Cell, problem: Problem, box: Box, point: Array, known_way: int | None = None
) -> _Told | None:
    """Follow the ways to print a cell to both sides of what a point makes of it; None if there is none.

    One that is known stays the first.
    """
    known: dict[int, Best | None] = {0: None}
    near = replace(box, start=point)

    def possible(units: int) -> Best | None:
        if units not in known:
            now = best(*cell.reprinted(problem, near, units), until=1.0)
            known[units] = now if now.mismatch <= 1 else None
        return known[units]

    middle = cell.units(problem, point) if known_way is None else known_way
    starts = () if middle is None else (middle, middle + 1, middle - 1)
    start = next((units for units in starts if possible(units) is not None), None)
    if start is None:
        return None
    low, high = (_last(start, way, possible) for way in (-1, 1))
    ways = _in_order(cell.printed, low, high, cell.recomputed(problem))
    would = next((units for units in ways[:LISTED] if possible(units) is not None), start)
    would = would if known_way is None else start
    others = [respelt(cell.printed, units).text for units in ways if units != would]
    ends = tuple(respelt(cell.printed, units).text for units in (low, high))
    text, span = respelt(cell.printed, would).text, ends if high - low > LISTED else ()
    change = cell.change(problem, text, others[:LISTED], span)
    asked, there = cell.reprinted(problem, near, would)
    found = possible(would)
    assert found is not None
    return _Told(change, would, asked, there, best(asked, replace(there, start=found.point)))


def _last(start: int, way: int, possible: Callable[[int], Best | None]) -> int:
    """The furthest possible way to print a cell to one side."""
    last, step = start, 1
    while step < FURTHEST and possible(start + way * step) is not None:
        last, step = start + way * step, 2 * step
    out = start + way * step
    while abs(out - last) > 1:
        between = (out + last) // 2
        last, out = (between, out) if possible(between) is not None else (last, between)
    return last


def _in_order(printed: Printed, low: int, high: int, again: int | None) -> list[int]:
    """The ways to print a cell: those that one slip of the hand makes, then the others, middle ones first.

    After these slips stands the one that is recomputed: `again`, if there is one.
    """
    slipped = _slipped(printed)
    middle = (low + high) // 2
    every = range(max(low, middle - LISTED), min(high, middle + LISTED) + 1)
    known = slipped if again is None else {*slipped, again}

    def order(units: int) -> tuple[bool, bool, int, int]:
        other = units not in slipped
        return other, other and units != again, abs(units - middle), units

    near = sorted({*every, *known}, key=order)
    return [units for units in near if low <= units <= high and units]


def _slipped(printed: Printed) -> set[int]:
    """How many units further one slip of the hand prints a number, for each that it may be."""
    return {moved(printed, Fraction(text) * printed.scale + printed.zero) for text in slips(printed.text)}


# --- one cell ---------------------------------------------------------------------------------------------


def misprints(search: Search) -> Iterator[Explained]:
    """One cell, given or published, that would have to be printed otherwise."""
    yield from _misprinted(search, _cells(search))


def misprint(search: Search, n: int) -> Iterator[Explained]:
    """The same of one published value."""
    yield from _misprinted(search, (cell for cell in _cells(search) if not cell.given and cell.n == n))


def _misprinted(search: Search, cells: Iterable[_Cell]) -> Iterator[Explained]:
    problem = search.problem
    for cell in cells:
        if not search.worth(cell.touches):
            continue
        if cell.given:
            point, is_certain = _freed(search, problem, cell.n)
            ways = [*_slips_of(cell, np.array([]))]
            if is_certain:  # where it was looked for
                ways = [units for units in ways if not _is_in(_range(problem, cell.n), cell, units)]
            if is_certain and not ways:
                search.drop(certain=True)
                continue
        else:
            found = search.conflicts.without(cell.touches)
            assert isinstance(found, Best)
            point = found.point
        known = None if point is None else _alone(problem, cell, point)
        told = None if point is None else _told(cell, problem, problem.box, point, known)
        if cell.given:
            told = _with_slips(problem, cell, told, ways)
        if told is not None:
            alone = cell.given and _comes_out(problem, _at(problem, cell, told.units))
            yield search.explained([told.change], told.problem, told.box, told.best, alone)
        else:
            search.drop(certain=False)


def _is_in(ends: tuple[float, float], cell: _Cell, units: int) -> bool:
    """Whether a given cell is looked for where it is printed otherwise."""
    return ends[0] <= float(respelt(cell.printed, units).value) <= ends[1]


def _with_slips(problem: Problem, cell: _Cell, told: _Told | None, ways: Sequence[int]) -> _Told | None:
    """The same with the slips that explain it as well from elsewhere: what is sought may have several roots.

    A slip stands before any other way to print a given cell, and before other slips one with which everything
    comes out while all else is exactly as it is printed. `ways`: how many units further slips print it.
    """
    if not ways:
        return told
    points = problem.restarted(np.stack([_at(problem, cell, units) for units in ways]))
    size = _sizes(problem, points)
    alone = [n for n in np.argsort(size.max(axis=1), kind="stable").tolist() if size[n].max() <= 1]
    left = (size - _reach(problem)).max(axis=1)
    hopeful = [n for n in np.argsort(left, kind="stable").tolist() if left[n] <= HOPELESS]
    hopeful = [n for n in hopeful if n not in alone and not _is_told(cell, told, ways[n])][:LOOKED_INTO]
    slipped = [
        n for n in hopeful if best(*cell.reprinted(problem, problem.box, ways[n]), until=1.0).mismatch <= 1
    ]
    slipped = [*alone, *slipped]
    if alone or (slipped and (told is None or not is_slip(cell.printed.text, told.change.would_print))):
        first = slipped[0]
        told = _told(cell, problem, problem.box, points[first], ways[first]) or told
    if told is None:
        return None
    others = (respelt(cell.printed, ways[n]).text for n in slipped if not _is_told(cell, told, ways[n]))
    also = tuple(dict.fromkeys((*others, *told.change.also)))[:LISTED]
    return replace(told, change=replace(told.change, also=also))


def _is_told(cell: _Cell, told: _Told | None, units: int) -> bool:
    """Whether what is told of a cell holds a way to print it."""
    if told is None:
        return False

    def further(text: str) -> int:
        return moved(cell.printed, Fraction(text) * cell.printed.scale + cell.printed.zero)

    change = told.change
    known = {further(text) for text in (change.would_print, *change.also)}
    low, *_, high = sorted(map(further, change.span)) if change.span else (1, 0)
    return units in known or low <= units <= high


def freed(search: Search, problem: Problem, n: int) -> Array | None:
    """An input in which a given cell has any value and everything comes out; None, and counted, without."""
    point, is_certain = _freed(search, problem, n)
    if point is None:
        search.drop(is_certain)
    return point


def _freed(search: Search, problem: Problem, n: int) -> tuple[Array | None, bool]:
    """The same, not counted, and whether there is certainly none."""
    turned = _turned(problem, n)
    if turned is not None and search.alive([turned], problem):
        now = best(problem, turned, until=1.0)
        if now.mismatch <= 1:
            return now.point, False
    edges = _edges(problem, n)
    pieces = [problem.box.moved([n], [low], [high], [(low + high) / 2]) for low, high in pairwise(edges)]
    alive = search.alive(pieces, problem)
    if not alive:
        return None, True
    steps = -(-PIECES // len(alive))
    spans = list[Array]()
    for place in alive:
        span = np.linspace(pieces[place].low[n], pieces[place].high[n], steps + 1)
        if place - 1 in alive:
            spans[-1] = np.append(spans[-1], span[1:])
        else:
            spans.append(span)
    point = _held(problem, n, spans)
    if point is not None:
        return point, False
    for place, start in _promising(problem, n, spans):
        first, last = _run(alive[place // steps], alive)
        box = problem.box.moved([n], [pieces[first].low[n]], [pieces[last].high[n]], [start])
        box = replace(box, start=problem.restarted(box.start[None])[0])
        now = best(problem, box, until=1.0)
        if now.mismatch <= 1:
            return now.point, False
    return None, False


def _held(problem: Problem, n: int, spans: Sequence[Array]) -> Array | None:
    """The same while all else is exactly as it is printed.

    Of one number alone every published value is a curve, and all curves pass what is published between the
    same two of many numbers. These are followed into ever smaller intervals, to as many digits as there are;
    a search for the least of the worst ends between curves that turn.
    """
    for _ in range(ZOOMS):
        values = np.concatenate(spans)
        points = np.tile(problem.box.start, (values.size, 1))
        points[:, n] = values
        points = problem.restarted(points)
        off = problem.mismatch(problem.guessing.evaluate(points))
        worst = np.nan_to_num(np.abs(off), nan=np.inf, posinf=np.inf).max(axis=1)
        if worst.min() <= 1:
            found: Array = points[np.argmin(worst)]
            return found
        with np.errstate(invalid="ignore"):
            change = np.pad(np.abs(np.diff(off, axis=0)), ((1, 1), (0, 0)))
            change = np.fmax(np.fmax(change[:-2], change[2:]), change[1:-1])  # a curve may turn in between
            missed = (np.minimum(np.abs(off[1:]), np.abs(off[:-1])) / (1 + change)).max(axis=1)
        ends = np.cumsum([span.size for span in spans])
        missed[ends[:-1] - 1] = np.inf  # between two intervals
        spans = _around(values, ends, missed)
        if not spans:
            return None
    return None


def _around(values: Array, ends: Numbered, missed: Array) -> list[Array]:
    """The intervals of values that miss least, each with its neighbours, cut into smaller ones.

    `ends`: behind the values of each span. `missed`: by how much each interval does; none is taken of which
    that is more than 1, or not known.
    """
    chosen = list[tuple[int, int]]()
    for i in np.argsort(missed, kind="stable").tolist():
        if len(chosen) == TRIED or not missed[i] <= 1:
            break
        span = int(np.searchsorted(ends, i, side="right"))
        first, last = max(i - 1, int(ends[span - 1]) if span else 0), min(i + 2, int(ends[span]) - 1)
        if not any(low <= i < high for low, high in chosen):
            chosen.append((first, last))
    return [np.linspace(values[low], values[high], INTO * (high - low) + 1) for low, high in chosen]


def _turned(problem: Problem, n: int) -> Box | None:
    """The box with the other sign of a given cell; None where it has none, or that is not allowed."""
    box, unknown = problem.box, problem.unknowns[n]
    twice = 2 * float(unknown.printed.zero) if unknown.printed else 0.0
    low, high, start = (twice - float(end) for end in (box.high[n], box.low[n], box.start[n]))
    if not start or unknown.allowed.clip(low, high) != (low, high):
        return None
    return box.moved([n], [low], [high], [start])


def _range(problem: Problem, n: int) -> tuple[float, float]:
    """Between what a given cell is looked for."""
    unknown, own = problem.unknowns[n], float(problem.box.start[n])
    size = max(np.abs(problem.box.start[problem.rows[unknown.column]]))
    low, high = sorted((own / RANGE, own * RANGE)) if own else (-size, size)
    return unknown.allowed.clip(low, high)


def _edges(problem: Problem, n: int) -> list[float]:
    """Where the pieces of that range begin and end."""
    low, high = _range(problem, n)
    if low * high <= 0:
        return np.linspace(low, high, PIECES + 1).tolist()  # type: ignore[no-any-return]
    sizes: list[float] = np.geomspace(abs(low), abs(high), PIECES + 1).tolist()
    return sorted(size if low > 0 else -size for size in sizes)


def _run(place: int, alive: list[int]) -> tuple[int, int]:
    """The pieces that hang together with one."""
    first = last = place
    while first - 1 in alive:
        first -= 1
    while last + 1 in alive:
        last += 1
    return first, last


def _promising(problem: Problem, n: int, spans: Sequence[Array]) -> list[tuple[int, float]]:
    """Where a given cell leaves least to what the others can do, of neighbours the best; with its number.

    A search that begins between two solutions may stay there, where no small step is better.
    """
    problem = problem.guessing
    values = np.concatenate([(span[1:] + span[:-1]) / 2 for span in spans])
    points = np.tile(problem.box.start, (values.size, 1))
    points[:, n] = values
    off = _sizes(problem, problem.restarted(points))
    every = replace(problem, ignored=frozenset())
    slopes = np.abs(np.nan_to_num(every.slopes(every.at(problem.box.start), problem.box)))
    slopes[:, n] = 0
    left = (off - slopes @ (problem.box.width / 2) / problem.half).max(axis=1)
    around = np.concatenate([[np.inf], left, [np.inf]])
    lowest = np.flatnonzero((left <= around[:-2]) & (left <= around[2:]))
    chosen = lowest[np.argsort(left[lowest], kind="stable")][:TRIED]
    return [(place, float(values[place])) for place in chosen.tolist()]


def slipped(search: Search) -> Iterator[Explained]:
    """One cell in which one slip explains everything: only those are looked for, and all of them at once."""
    problem = search.problem
    here = problem.guessing.at(problem.box.start)
    tried = [
        (cell, units, _at(problem, cell, units))
        for cell in _cells(search)
        if search.worth(cell.touches)
        for units in _slips_of(cell, here.cells)
    ]
    if not tried:
        return
    sizes = _sizes(problem, problem.restarted(np.stack([point for _, _, point in tried])))
    left = sizes - _reach(problem)
    for n, (cell, _, _) in enumerate(tried):
        if not cell.given:
            sizes[n, cell.n] = left[n, cell.n] = 0.0
    alone, left = sizes.max(axis=1) <= 1, left.max(axis=1)
    order = [n for n in np.lexsort((left, ~alone)).tolist() if left[n] <= HOPELESS]
    texts: dict[_Cell, list[str]] = {}
    first: dict[_Cell, tuple[Problem, Box, Best, bool]] = {}
    for n in order[:LOOKED_INTO]:
        cell, units, _ = tried[n]
        changed, box = cell.reprinted(problem, problem.box, units)
        now = search.met(changed, box)
        if now is not None:
            texts.setdefault(cell, []).append(respelt(cell.printed, units).text)
            first.setdefault(cell, (changed, box, now, bool(alone[n])))
    for cell, (would, *also) in texts.items():
        yield search.explained([cell.change(problem, would, also, ())], *first[cell])


def _alone(problem: Problem, cell: _Cell, point: Array) -> int | None:
    """How a given cell prints at a point, if everything comes out of that with all else as it is printed."""
    units = cell.units(problem, point) if cell.given else None
    return None if units is None or not _comes_out(problem, _at(problem, cell, units)) else units


def _comes_out(problem: Problem, point: Array) -> bool:
    """Whether everything comes out of a point."""
    return bool(_sizes(problem, problem.restarted(point[None])).max() <= 1)


def _sizes(problem: Problem, points: Array) -> Array:
    """How far everything is from coming out at points (points, unknowns): of shape (points, published)."""
    off = np.abs(problem.mismatch(problem.guessing.evaluate(points)))
    return np.nan_to_num(off, nan=np.inf, posinf=np.inf)


def _reach(problem: Problem) -> Array:
    """How much of that (published,) the box can do by its slopes."""
    here = problem.guessing.at(problem.box.start)
    slopes = np.abs(np.nan_to_num(problem.slopes(here, problem.box)))
    reach: Array = slopes @ (problem.box.width / 2) / problem.half
    return reach


def _slips_of(cell: _Cell, cells: Array) -> Iterator[int]:
    """How many units further one slip prints a cell; a published one only as it is recomputed."""
    own = cell.printed
    units = sorted(each for each in _slipped(own) if is_slip(own.text, respelt(own, each).text))
    value = np.nan if cell.given else float(cells[cell.n])
    again = moved(own, Fraction(value)) if np.isfinite(value) else None
    yield from (each for each in units if cell.given or each == again)


def _at(problem: Problem, cell: _Cell, units: int) -> Array:
    """What is printed, with a given cell printed otherwise."""
    point = problem.box.start.copy()
    if cell.given:
        low, high = problem.unknowns[cell.n].interval(respelt(cell.printed, units))
        point[cell.n] = min(max(float(respelt(cell.printed, units).value), low), high)
    return point


# --- two cells --------------------------------------------------------------------------------------------


def two_misprints(search: Search) -> Iterator[Explained]:
    """Two cells without which the rest comes out."""
    problem = search.problem
    cells = [(cell, _conflict(search, cell)) for cell in _cells(search)]
    pairs = [
        (one, other)
        for (one, against_one), (other, against_other) in combinations(cells, 2)
        if one.touches & against_other and other.touches & against_one
    ]
    pairs.sort(key=lambda pair: len(pair[0].touches | pair[1].touches))
    looked_into = 0
    for one, other in pairs:
        if not search.worth(one.touches | other.touches):
            continue
        looked_into += 1
        if looked_into > PAIRS:
            search.drop(certain=False)
            continue
        point = _freed_both(search, one, other)
        first = None if point is None else _told(one, *other.ignored(problem, problem.box), point)
        if first is None:
            continue
        second = _told(other, *one.reprinted(problem, first.box, first.units), first.best.point)
        if second is None:
            search.drop(certain=False)
        else:
            # What else the first may read is asked again: not whatever the second is, but as it is told now.
            first = _told(one, second.problem, second.box, second.best.point, first.units) or first
            changes = [first.change, second.change]
            yield search.explained(changes, second.problem, second.box, second.best)


def _freed_both(search: Search, one: _Cell, other: _Cell) -> Array | None:
    """An input with which the rest comes out if two cells say nothing; None if none was found."""
    problem = search.problem
    if one.given and not other.given:
        return freed(search, problem.ignoring({other.n}), one.n)
    found = search.met(*other.ignored(*one.ignored(problem, problem.box)), wide=one.given)
    return None if found is None else found.point


def _conflict(search: Search, cell: _Cell) -> frozenset[int]:
    """Values of which one must be touched besides, even if a cell's digits say nothing."""
    problem = search.problem
    found = search.conflicts.without(cell.touches)
    if isinstance(found, Conflict):
        return found.values
    pressing = frozenset[int]()
    if cell.given:
        pressing = frozenset(best(*cell.ignored(problem, problem.box)).pressing.tolist())
    return pressing or frozenset(range(len(problem.published)))
