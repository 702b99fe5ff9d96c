"""A sheet as a workbook's cells: puts every quantity in its place and every formula in its cell.

An axis has a worksheet: the numbers of its rows, room for words beside them, its columns in the order of
the sheet, what is drawn of it, and, to the right, the cells on the way to its roots. Scalars stand one below
the other on the worksheet ``report``; the cells on the way to a scalar root have the worksheet ``steps``.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from ...derivations.unit_text import ParsedUnit, UnitError, parse_open, parse_unit
from ..cells import grid
from ..cells.layout import Layout
from ..charts import MOST_DOTS
from ..column import shown_as
from ..plan.kept import as_data
from ..plan.lowering import lowered
from ..plan.nodes import Leaf, RootNode
from ..quantity import Bounds
from ..sheet import Axis, Column, Given, GroupAxis, Sheet
from .certified import certified
from .excel import ordered
from .excel_formulas import Formulas, Places, carried, carried_name, guard, works_on_ranges
from .excel_loops import names_in, passes_of
from .excel_roots import Unrolled, unroll
from .excel_slopes import Slopes
from .excel_values import NotPrintable
from .numpy_texts import program_texts

_ABOVE = 6
"""How far above the first row of a drawn axis the number stands that says how often it repeats."""
_GAP = 3
"""Rows from one group of scalars to the next: one empty, a title, a header."""


@dataclass
class _Room:
    """Where the next column of a worksheet goes."""

    worksheet: str
    rows: int
    column: int = 0

    def next(self, scale: Fraction = Fraction(1), zero: Fraction = Fraction(0)) -> grid.Place:
        place = grid.Place(self.worksheet, grid.FIRST_ROW, self.column, self.rows, scale, zero)
        self.column += 1
        return place


@dataclass(eq=False)
class Assembly:
    """Blocks being put together: first all places, then all formulas."""

    names: Mapping[str, str]
    """Of worksheets, by index set."""
    sheet: Sheet
    judged: Sheet
    """The sheet with the margins of its limits."""
    whole: Sheet
    """The same with what is drawn."""
    layouts: Mapping[str, Layout]
    """Of the whole sheet."""
    counts: Mapping[str, float]
    """How often axes repeat, by the scalar that says so."""
    units: Mapping[str, str]
    """In which columns are shown."""
    first: Sequence[str]
    """The result."""
    results: Sequence[str]
    """The same, and other columns whose derivatives have cells."""
    worded: Mapping[str, Sequence[str]]
    """The columns of words beside the numbers of rows, by index set."""
    thinned: Collection[str]
    """Drawn columns that have no more cells than dots are drawn."""
    times: int
    """How often a root's own steps are laid out."""
    last: int
    """The last pass of a loop that is laid out."""

    def __post_init__(self) -> None:
        whole, sheet = self.whole, self.sheet
        self.rooms = {a.name: _Room(self.names[a.name], self.layouts[a.name].size) for a in whole.axes}
        self.places: dict[str, grid.Place] = {}
        self.notes: dict[str, grid.Place] = {}
        self.words: dict[str, tuple[grid.Place, ...]] = {}
        self.groups: dict[str, tuple[grid.Grouped, ...]] = {}
        self.indices: dict[str, tuple[grid.Place, ...]] = {}
        self.plan = ordered(lowered(whole))
        roots = {node.column.name: node for node in self.plan.nodes if isinstance(node, RootNode)}
        self.unrolled = {
            c.name: unroll(self.plan, roots[c.name], certified(sheet, c), self.times)
            for c in sheet.columns
            if c.name in roots
        }
        asked = {
            given.name
            for unrolled in self.unrolled.values()
            if unrolled.issued is not None
            for given in sheet.ancestors(unrolled.column)
            if isinstance(given.rule, Given)
        }
        self.asked = [column for column in sheet.columns if column.name in asked]
        self.passes = passes_of(sheet, self.last)
        self.carried = {k: v for c in whole.columns for k, v in self.carried_for(c).items()}

    def told(self) -> dict[str, Any]:
        """All of it but the values, as data."""
        self.put_all()
        derived = Slopes(self.sheet, self.results)
        steps = {
            name: self.places[[c.name for c in each.cells if c.name.startswith(f"{name}.u_")][-1]]
            for name, each in self.unrolled.items()
        }
        self.places |= derived.put(lambda axis: self.rooms[axis].next(), steps)
        named = {name: self.places[grid.checked(name)] for name in self.whole.bounds}
        places = Places({**self.places, **named}, {name: self.places[name] for name in named}, self.indices)
        formulas = Formulas(self.whole, self.plan, self.layouts, places, self.last)
        blocks = [*self.index_blocks(), *self.column_blocks(formulas), *self.step_blocks(formulas)]
        slopes = derived.told(formulas)
        blocks += derived.blocks
        for block in blocks:
            if (longest := max((len(each.first) for each in block.filled), default=0)) > grid.LONGEST:
                raise NotPrintable(f"{block.name} has a formula of {longest} characters, which no cell takes")
        order = [grid.SCALARS, *self.names.values(), grid.STEPS, grid.SLOPES]
        blocks.sort(
            key=lambda b: (
                order.index(b.place.worksheet),
                b.place.column if b.place.worksheet in self.names.values() else 0,
                b.place.row,
                b.place.column,
            )
        )
        return {
            "blocks": as_data(blocks),
            "roots": [auxiliary_texts(self.whole, unrolled) for unrolled in self.unrolled.values()],
            "notes": as_data(self.notes),
            "words": as_data(self.words),
            "groups": as_data(self.groups),
            "slopes": slopes,
        }

    # --- places

    def put_all(self) -> None:
        """Give every quantity its place: further right, or further down, than those before."""
        self.put_indices()
        self.put_scalars()
        given = [c for c in self.whole.columns if c.axis is not None and isinstance(c.rule, Given)]
        self.put_given(given)
        self.put_computed(given)
        for column in given:
            self.put(column, grid.checked(column.name))
        for name, (leaf, axis) in sorted(self.carried.items()):
            self.places[name] = self.rooms[axis.name].next(
                self.places[leaf.name].scale, self.places[leaf.name].zero
            )
        row = self.put_roots(grid.TOP - 2)
        for loop in dict.fromkeys(each.loop for each in self.passes.values()):
            row = self.put_passes(loop, row)
        self.put_issued(row)

    def put_indices(self) -> None:
        """The numbers of the rows of every axis, and the words beside them."""
        for axis in self.whole.axes:
            parts = self.layouts[axis.name].labels.shape[1]
            room = self.rooms[axis.name]
            self.indices[axis.name] = tuple(room.next() for _ in range(parts))
            if axis.is_given:
                self.words[room.worksheet] = tuple(room.next() for _ in self.worded.get(axis.name, ()))
            elif isinstance(axis, GroupAxis):
                self.words[room.worksheet] = (room.next(),)
                self.put_group(axis, self.words[room.worksheet][0])

    def put_given(self, given: Sequence[Column]) -> None:
        """What is given of rows, then a note on each of their worksheets."""
        for column in given:
            self.put(column, column.name)
        for worksheet in dict.fromkeys(self.places[column.name].worksheet for column in given):
            (room,) = (room for room in self.rooms.values() if room.worksheet == worksheet)
            self.notes[worksheet] = room.next()

    def put_computed(self, given: Sequence[Column]) -> None:
        """What is computed of rows, then each pass of a loop."""
        for column in self.whole.columns:
            if column.axis is not None and column not in given and column.name not in self.passes:
                self.put(column, column.name)
        for number in range(self.last + 1):
            own = {each.rule: each for each in self.passes.values() if each.number == number}
            for column in self.whole.columns:
                if column.axis is not None and column.name in own:
                    self.put(column, own[column.name].name)

    def put_roots(self, row: int) -> int:
        """The parts of each root: of rows on their worksheet, else among the steps below a row."""
        for unrolled in self.unrolled.values():
            over = unrolled.column.axis
            if over is not None:
                for name in (unrolled.check.name, *_counting(unrolled), *(c.name for c in unrolled.cells)):
                    self.places[name] = self.rooms[over.name].next()
            else:
                row = self.put_steps(unrolled, row)
        return row

    def put_issued(self, row: int) -> None:
        """What was given as issued, where a root asks for it; single numbers among the steps below a row."""
        for column in self.asked:
            if column.axis is not None:
                self.put(column, grid.as_issued(column.name))
            else:
                self.places[grid.as_issued(column.name)] = grid.Place(
                    grid.STEPS, row := row + 1, 1, 1, *self.size(column)
                )

    def put_group(self, axis: GroupAxis, group: grid.Place) -> None:
        """Say where the words are by which a row belongs to its group, if there are any."""
        rows = axis.members.of
        worded = self.worded.get(rows.name, ())
        if axis.row in worded:
            words = self.words[self.names[rows.name]]
            which = self.layouts[rows.name].rows[axis.members.group_name].tolist()
            grouped = grid.Grouped(words[worded.index(axis.row)], group, tuple(which))
            self.groups[grouped.own.worksheet] = (*self.groups.get(grouped.own.worksheet, ()), grouped)

    def rule_of(self, name: str) -> Column:
        """The column that has the rule of one."""
        return self.whole[self.passes[name].rule if name in self.passes else name]

    def carried_for(self, column: Column) -> dict[str, tuple[Leaf, Axis]]:
        """What is repeated for a column, in each pass that it is written for."""
        found = carried(self.whole, column)
        own = self.passes.get(column.name)
        if own is None or own.number != 1:
            return found
        every = (
            (replace(leaf, name=names_in(self.passes, number)(leaf.name)), axis)
            for number in range(1, self.last + 1)
            for leaf, axis in found.values()
        )
        return {carried_name(leaf): (leaf, axis) for leaf, axis in every}

    def put(self, column: Column, name: str) -> None:
        """The next free column of its worksheet."""
        assert column.axis is not None
        place = self.rooms[column.axis.name].next(*self.size(column))
        self.places[name] = replace(place, rows=min(place.rows, MOST_DOTS)) if name in self.thinned else place

    def put_scalars(self) -> None:
        """The result, what is given, and the rest, each group under a title."""
        for axis in self.whole.axes:
            if axis.repeats and axis.repeats not in self.sheet:
                for name, at in ((axis.repeats, 1), (grid.checked(axis.repeats), 2)):
                    self.places[name] = grid.Place(self.names[axis.name], grid.FIRST_ROW - _ABOVE, at)
        scalars = [column for column in self.sheet.columns if column.axis is None]
        groups = (
            [self.sheet[name] for name in self.first if name in self.sheet and self.sheet[name].axis is None],
            [c for c in scalars if isinstance(c.rule, Given) and c.name not in self.first],
            [c for c in scalars if not isinstance(c.rule, Given) and c.name not in self.first],
            [c for c in self.judged.columns if c.axis is None and c.name not in self.sheet],
        )
        row = grid.TOP
        for at, group in enumerate(groups):
            for column in group:
                self.places[column.name] = place = grid.Place(grid.SCALARS, row, 1, 1, *self.size(column))
                if isinstance(column.rule, Given):
                    self.places[grid.checked(column.name)] = replace(place, column=grid.CHECKED)
                row += 1
            row += _GAP if group else 0
            if not at:  # results that have rows stand there, too, below those that are one number
                row += sum(rows + _GAP - 1 for rows in self.rows_of_results())

    def rows_of_results(self) -> Iterator[int]:
        """The numbers of rows of results that are shown with the scalars."""
        axes = (self.whole[name].axis for name in self.first if name in self.whole)
        sizes = (self.layouts[axis.name].size for axis in axes if axis is not None)
        yield from (size for size in sizes if size <= grid.MOST_RESULTS)

    def put_steps(self, unrolled: Unrolled, row: int) -> int:
        """What comes before the steps one below the other, then a table with a row for each step."""
        place = row + 1
        self.places[unrolled.check.name] = grid.Place(grid.STEPS, place, 1)
        for name in _counting(unrolled):
            place += 1
            self.places[name] = grid.Place(grid.STEPS, place, 1)
        for cell in unrolled.cells:
            if cell.step == 0:
                place += 1
                self.places[cell.name] = grid.Place(grid.STEPS, place, 1)
        table, last = place + 3, place
        for cell in unrolled.cells:
            if cell.step > 0:
                fields = [own.name for own in unrolled.cells if own.step == cell.step]
                last = table + cell.step - 1
                self.places[cell.name] = grid.Place(grid.STEPS, last, 1 + fields.index(cell.name))
        return last + 4

    def put_passes(self, loop: str, row: int) -> int:
        """The starts of scalars one below the other, then a table with a row for each pass."""
        own = [
            each for each in self.passes.values() if each.loop == loop and self.whole[each.rule].axis is None
        ]
        starts = [each for each in own if not each.number]
        table = row + len(starts) + 4
        fields: dict[int, int] = {}
        for each in own:
            if each.number:
                at = fields[each.number] = fields.get(each.number, 0) + 1
                place = grid.Place(grid.STEPS, table + each.number - 1, at)
            else:
                place = grid.Place(grid.STEPS, row + 1 + starts.index(each), 1)
            scale, zero = self.size(self.whole[each.rule])
            self.places[each.name] = replace(place, scale=scale, zero=zero)
        return table + max((each.number for each in own), default=0) + 3

    def size(self, column: Column) -> tuple[Fraction, Fraction]:
        """The unit of a column's cells and its zero, in SI."""
        unit = self.unit(column)
        return unit.scale, unit.zero

    def unit(self, column: Column) -> ParsedUnit:
        """The unit of a column's cells."""
        like = shown_as(column, self.whole.by_name)
        unit = self.units.get(column.name) or self.units.get(like.name) or like.display or like.unit
        try:
            return parse_unit(unit)
        except UnitError:
            return parse_open(column.unit)  # an exponent that is a symbol: SI

    # --- blocks

    def index_blocks(self) -> Iterator[grid.CellBlock]:
        """The numbers that name the rows of every axis."""
        for axis in self.whole.axes:
            for part, (place, names) in enumerate(zip(self.indices[axis.name], axis.parts, strict=True)):
                title, meaning = names
                yield grid.CellBlock(
                    title, "index", title, meaning, place, shows=("labels", axis.name, str(part))
                )

    def column_blocks(self, formulas: Formulas) -> Iterator[grid.CellBlock]:
        """The columns of the sheet, and those that are drawn."""
        for column in self.whole.columns:
            if column.name in self.passes:
                continue
            block = grid.CellBlock(
                column.name,
                "given",
                column.name,
                column.meaning,
                self.places[column.name],
                unit=self.unit(column).text,
                source=column.source,
                shows=("column", column.name),
            )
            if isinstance(column.rule, Given):
                yield from self.given_blocks(column, block, formulas)
            elif column.name not in self.judged:
                yield _computed(
                    replace(block, kind="drawn", shows=("drawn", column.name)), formulas.drawn(column)
                )
            else:
                written = formulas.column(column, self.unrolled.get(column.name))
                kind = "computed" if column.name in self.sheet else "margin"
                yield _computed(replace(block, kind=kind, kept=formulas.kept(column)), written)
        for each in self.passes.values():
            column, of = self.whole[each.rule], self.sheet[each.of]
            block = grid.CellBlock(
                each.name, "step", each.of, f"{of.meaning}, {each.when}", self.places[each.name],
                unit=self.unit(column).text, source=of.source, of=each.loop, step=each.number,
                shows=("column", each.name),
            )  # fmt: skip
            yield _computed(block, formulas.passed(column, each.name, names_in(self.passes, each.number)))
        for name, (leaf, axis) in sorted(self.carried.items()):
            column = self.rule_of(leaf.name)
            block = grid.CellBlock(
                name, "carried", leaf.written, f"{leaf.name} of each row",
                self.places[name], unit=self.unit(column).text, of=leaf.name,
                shows=("carried", leaf.name, axis.name, str(leaf.index)),
            )  # fmt: skip
            yield _computed(block, formulas.carried(leaf))

    def given_blocks(
        self, column: Column, block: grid.CellBlock, formulas: Formulas
    ) -> Iterator[grid.CellBlock]:
        """What is typed, and what of it is allowed; how many rows there are is what the worksheets have."""
        bounds = self.whole.bounds[column.name].over(block.place.scale, block.place.zero)
        if any(axis.repeats == column.name for axis in self.whole.axes):
            there = self.counts[column.name]
            bounds = Bounds(there, there)
        test = guard(bounds)
        yield replace(block, bounds=bounds, guard=test)
        name = grid.checked(column.name)
        own = replace(
            block, name=name, kind="checked", meaning=f"{column.name}, where it is allowed",
            place=self.places[name], of=column.name,
        )  # fmt: skip
        yield _computed(own, formulas.checked(column, test, self.groups.get(block.place.worksheet, ())))

    def step_blocks(self, formulas: Formulas) -> Iterator[grid.CellBlock]:
        """The cells on the way to roots."""
        for unrolled in self.unrolled.values():
            name = unrolled.check.name
            block = grid.CellBlock(
                name, "step", "precedents", "whether all precedents have values, or the first error",
                self.places[name], of=unrolled.column.name, source=unrolled.column.source,
                shows=("cell", name),
            )  # fmt: skip
            yield _computed(block, formulas.check(unrolled))
            if unrolled.issued is not None:
                yield from self.counting_blocks(unrolled, formulas)
            for cell in unrolled.cells:
                block = grid.CellBlock(
                    cell.name, "step", cell.title, cell.meaning, self.places[cell.name],
                    of=unrolled.column.name, step=cell.step, shows=("cell", cell.name),
                )  # fmt: skip
                yield _computed(block, formulas.auxiliary(unrolled, cell))
        guarded = [unrolled.column for unrolled in self.unrolled.values() if unrolled.issued is not None]
        for column in self.asked:
            yield grid.CellBlock(
                grid.as_issued(column.name), "step", f"{column.name} as issued", f"{column.name} as issued, "
                "for which the roots were counted", self.places[grid.as_issued(column.name)],
                of=guarded[0].name, source=column.source, shows=("typed column", column.name),
            )  # fmt: skip

    def counting_blocks(self, unrolled: Unrolled, formulas: Formulas) -> Iterator[grid.CellBlock]:
        """Whether the inputs are as issued, and how many roots there are then."""
        issued, counted = _counting(unrolled)
        column = unrolled.column
        given = [c.name for c in self.sheet.ancestors(column) if isinstance(c.rule, Given)]
        block = grid.CellBlock(
            issued, "step", "as issued", "1 if all inputs are those as issued, for which the roots were "
            "counted; if not, build the report again", self.places[issued], of=column.name,
            source=column.source, shows=("cell", issued),
        )  # fmt: skip
        yield _computed(block, formulas.issued(issued, column, given))
        says = "how many roots there are for the inputs as issued, by interval arithmetic; -1 if not certain"
        place, shows = self.places[counted], ("typed cell", counted)
        yield replace(block, name=counted, title="counted", meaning=says, place=place, shows=shows)


def _computed(block: grid.CellBlock, filled: tuple[grid.FilledDown, ...]) -> grid.CellBlock:
    """The block with its formulas."""
    return replace(block, filled=filled, array=works_on_ranges(filled[0].first))


def _counting(unrolled: Unrolled) -> tuple[str, ...]:
    """The cells of a root whose number is known for the inputs as issued only."""
    return tuple(cell.name for cell in (unrolled.issued, unrolled.counted) if cell is not None)


def auxiliary_texts(sheet: Sheet, unrolled: Unrolled) -> dict[str, Any]:
    """What computes the cells of an unrolled root of a sheet, printed, as data."""
    issued, counted = unrolled.issued, unrolled.counted
    name, last = unrolled.column.name, unrolled.cells[-1].step
    return {
        "column": name,
        "last": (f"{name}.u_{last - 1}", f"{name}.u_{last}"),
        "check": unrolled.check.name,
        "number": unrolled.number.name,
        "issued": issued and issued.name,
        "counted": counted and counted.name,
        "cells": [(cell.name, cell.part.symbol.name, cell.alone) for cell in unrolled.cells],
        "program": program_texts(sheet, unrolled.plan),
    }
