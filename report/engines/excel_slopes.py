"""Derivatives of results as formulas: a spreadsheet has none of its own.

Adjoints (:mod:`~loopsheet.report.plan.adjoints`) have a cell for each row on the worksheet of its axis,
where formulas are filled down. Those that are one number have a worksheet of their own, with sums they name.
They are made of the plan's derivatives (:mod:`~loopsheet.report.plan.derivatives`). Of rows that repeat
another one's, such as generated points, no adjoint has cells: they are summed where they lead to.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import count
from typing import Any

import numpy as np
from sympy import Add, Expr, Integer, Matrix, Mul, Symbol, eye

from ..cells.grid import LONGEST, SLOPES, CellBlock, FilledDown, Place
from ..plan.adjoints import Adjoint, Grouping, ReversePass, Share, Term
from ..plan.derivatives import derivatives
from ..plan.kept import as_data
from ..plan.nodes import Leaf, Part, Plan
from ..plan.slopes import with_unknowns
from ..sheet import Axis, Column, Given, GroupAxis, Iterated, PairAxis, RepeatAxis, Sheet
from .excel import ExcelPrinter, ordered
from .excel_formulas import Formulas, Writing, works_on_ranges
from .excel_values import NotPrintable
from .numpy_texts import program_texts

_CRAMER = 2
"""Of so many numbers, the equations are solved by determinants; of more by an inverse."""
_WIDE = 4
"""Where the columns of equations stand that are solved by an inverse."""
_FEW = 2
"""Formulas that may say the same instead of naming a cell."""
_TOP = 4
"""The row, from 0, of the first cell of the worksheet of single derivatives."""


class Slopes:
    """The derivatives of results by what was given, as the cells of a workbook.

    Parameters
    ----------
    sheet : Sheet
        Of the report.
    results : sequence of str
        Columns.
    """

    def __init__(self, sheet: Sheet, results: Sequence[str]) -> None:
        self.sheet = sheet
        self.made = made = derivatives(sheet, roundings=False)
        self.plan = ordered(made.plan)
        self.parts = {node.symbol.name: node for node in self.plan.nodes if isinstance(node, Part)}
        self.repeats = {
            axis.name: (axis.of.name, axis.of.index_name)
            for axis in sheet.axes
            if isinstance(axis, RepeatAxis)
        }
        given = (c for c in sheet.columns if isinstance(c.rule, Given) and not c.rule.u_of)
        self.adjoints = ReversePass(
            made.nodes,
            [loop.names for loop in sheet.loops],
            {column.name for column in sheet.columns if isinstance(column.rule, Iterated)},
            self.repeats,
            {
                axis.name: Grouping(
                    axis.members.name, axis.members.of.name, axis.index_name, axis.members.of.index_name
                )
                for axis in sheet.axes
                if isinstance(axis, GroupAxis)
            },
            {name for name, part in self.parts.items() if any(leaf.index for leaf in self.named(part))},
        ).adjoints(
            [name for name in results if name in sheet and not isinstance(sheet[name].rule, Given)],
            {column.name for column in given if not sheet.bounds[column.name].integer},
        )
        self.axes = {axis.name: axis for axis in sheet.axes}
        self.blocks: list[CellBlock] = []

    def named(self, part: Part) -> Iterator[Leaf]:
        """What a part names."""
        names = sorted(symbol.name for symbol in part.value.free_symbols)
        return (self.plan.named[name] for name in names if name in self.plan.named)

    # --- what has cells

    @cached_property
    def quantities(self) -> dict[str, Adjoint]:
        """The adjoints, by name."""
        return {each.name: each for each in self.adjoints.quantities}

    @cached_property
    def spread(self) -> dict[str, Term]:
        """The parts that have cells, in a term: those of rows that are added up by what they name."""
        return {
            name: term
            for quantity in self.quantities.values()
            for term in quantity.terms
            if quantity.axis not in (None, term.rows) and term.rows not in self.repeats
            for name in term.factors
            if name in self.parts and not self.parts[name].value.is_number
        }

    @cached_property
    def held(self) -> dict[str, Symbol]:
        """The sums and numbers of rows that parts name: each has cells of its own."""
        symbols = {symbol.name: symbol for symbol in self.plan.leaves}
        names = {name for each in self.quantities.values() for term in each.terms for name in term.factors}
        asked = [self.parts[name].value for name in sorted(names & self.parts.keys())]
        found: dict[str, Symbol] = {}
        while asked:
            for name in sorted(symbol.name for symbol in asked.pop().free_symbols):
                leaf = self.plan.named.get(name)
                if leaf and leaf.kind in ("total", "kept") and name not in found:
                    found[name] = symbols[name]
                    asked += [self.plan.totals[name].terms] if leaf.kind == "total" else []
        return dict(reversed(found.items()))

    def inner(self, quantity: Adjoint) -> bool:
        """Whether it has no cells: it stands in the formulas of others."""
        return quantity.axis in self.repeats or quantity.name in self.folded

    @cached_property
    def folded(self) -> set[str]:
        """The quantities that stand in few formulas of the same rows, so that fewer cells are needed.

        None of them names another one.
        """
        users: dict[str, list[Adjoint]] = {}
        asked = {n for own in self.adjoints.ways.values() for every in own.values() for w in every for n in w}
        for each in self.quantities.values():
            for name in each.names & self.quantities.keys():
                users.setdefault(name, []).append(each)
        found = set[str]()
        for name, each in self.quantities.items():
            own = users.get(name, [])
            alike = (
                user.axis == each.axis
                and not user.solved
                and all(t.rows == user.axis for t in user.terms if name in (*t.factors, t.by))
                for user in own
            )
            if (
                each.axis not in (None, *self.repeats)
                and not (each.solved or each.share or name in asked or each.names & found)
                and not any(self.explicit(each, term) for term in each.terms)
                and len(own) <= _FEW
                and all(alike)
            ):
                found.add(name)
        return found

    def explicit(self, quantity: Adjoint, term: Term) -> bool:
        """Whether the rows of a term that name a row are named one by one."""
        summed = quantity.axis in (None, term.rows) or term.rows in self.repeats
        return not summed and not isinstance(self.axes[term.rows or ""], PairAxis)

    def put(self, room: Callable[[str], Place], unknowns: Mapping[str, Place]) -> dict[str, Place]:
        """Give everything its place.

        `room`: makes the next column of an axis. `unknowns`: where the last steps to roots stand.
        """
        found, rows = dict[str, Place](), count(_TOP)
        axes = {name: _name(self.axis_of_held(name)) for name in self.held}
        axes |= {name: term.rows for name, term in self.spread.items()}
        axes |= {name: each.axis for name, each in self.quantities.items() if not self.inner(each)}
        column = _WIDE
        for each in self.quantities.values():
            if each.solved and each.axis is None and len(each.solved.right) > _CRAMER:
                matrix = each.solved.matrix
                if matrix[0][0] not in found:
                    for n, own in enumerate(matrix):
                        found |= {name: Place(SLOPES, _TOP + m, column + n) for m, name in enumerate(own)}
                    column += len(matrix) + 1
        for name, axis in axes.items():
            if name not in found:
                found[name] = room(axis) if axis else Place(SLOPES, next(rows), 1)
        found |= {again: unknowns[name] for name, again in self.made.again.items()}
        return found

    def axis_of_held(self, name: str) -> Axis | None:
        """The rows of a sum, or of a number of rows."""
        leaf = self.plan.named[name]
        return leaf.axis if leaf.kind == "total" else None

    # --- formulas

    def told(self, formulas: Formulas) -> dict[str, Any]:
        """All of it but the blocks and values, as data; results with what cannot be printed are left out."""
        lost = set[str]()
        for name in (*self.held, *self.spread, *self.quantities):
            quantity = self.quantities.get(name)
            try:
                if quantity and not lost.isdisjoint(quantity.names):
                    raise NotPrintable(name)
                if quantity is None or not self.inner(quantity):
                    self.blocks.append(_Printing(self, formulas, name).block())
            except NotPrintable:
                lost.add(name)
        ways = {
            result: own
            for result, own in self.adjoints.ways.items()
            if lost.isdisjoint(name for every in own.values() for way in every for name in way[:2])
        }
        used = {name for each in self.quantities.values() for name in each.names}
        shares = {each.share.total for each in self.quantities.values() if each.share}
        nodes = [n for n in self.made.plan.nodes if not isinstance(n, Part) or n.symbol.name in used]
        symbols = {symbol.name: symbol for symbol in self.made.plan.leaves}
        sums = [Part(self.column(name), Symbol(_held(name)), None, symbols[name]) for name in self.held]
        program = Plan((*nodes, *sums), self.made.plan.leaves)
        return {
            "ways": as_data(ways),
            "quantities": as_data(self.adjoints.quantities),
            "nodes": as_data([node for node in self.made.nodes if node.name in shares]),
            "again": self.made.again,
            "held": {name: _held(name) for name in self.held},
            "spread": {name: as_data(term) for name, term in self.spread.items()},
            "program": program_texts(with_unknowns(self.sheet, self.made.again), program),
        }

    def column(self, name: str) -> Column:
        """The column in which a sum or a number of rows stands."""
        total = self.plan.totals.get(name)
        return total.column if total else self.sheet[self.plan.named[name].name]


def _held(name: str) -> str:
    """What the part is called that is a sum, or a number of rows."""
    return f"{name}_held"


class _Printing(Writing):
    """The formulas of one quantity, one sum, or one part."""

    def __init__(self, slopes: Slopes, formulas: Formulas, name: str) -> None:
        self.slopes, self.name = slopes, name
        quantity, term = slopes.quantities.get(name), slopes.spread.get(name)
        if name in slopes.held:
            column = slopes.column(name)
        else:
            own = quantity.axis if quantity else term and term.rows
            column = Column(name, slopes.axes[own] if own else None, Given())
        super().__init__(formulas, column, name, slopes.plan)
        self.array = False
        """Whether a choice is taken for many rows at once, of which nothing in a formula tells."""
        self.segment = ""
        """The axis whose rows are meant that repeat the own row."""
        self.of_group: dict[str, tuple[Place, Any]] = {}
        """What stands for the cells of a row's group, and their rows."""

    def block(self) -> CellBlock:
        """Its cells."""
        name, slopes = self.name, self.slopes
        quantity = slopes.quantities.get(name)
        if name in slopes.held:
            total = self.plan.totals.get(name)
            over = total.over.name if total else _axis(self.plan.named[name]).name
            text = self.total(total.terms, over, total.word) if total else self.number_kept(over)
            filled = self.rows(text)
            title, meaning = name, f"a sum of {self.column.name}" if total else f"rows of {self.column.name}"
        elif quantity is None:
            guard, value = self.guard(slopes.spread[name]), slopes.parts[name].value
            filled = self.rows(f"IF({guard},{self.printer.doprint(value)},0)")
            title, meaning = name, f"a derivative of {slopes.spread[name].of}"
        else:
            filled = self.adjoint(quantity)
            title = f"∂{quantity.result}/∂{quantity.of}"
            meaning = f"a share of {quantity.of}" if quantity.share else "a derivative"
        if max(len(each.first) for each in filled) > LONGEST:
            raise NotPrintable(f"the derivative {name} is too long for a formula")
        array = self.array or works_on_ranges(filled[0].first)
        return CellBlock(name, "slope", title, meaning, self.place, filled, array, ("slope", name))

    # --- what stands in formulas

    def symbol(self, symbol: Symbol, rows: bool = False) -> str:
        """What a symbol stands for: of quantities, sums and parts, their own cells."""
        name, slopes = str(symbol.name), self.slopes
        if name in self.of_group:
            return self.fill(*self.of_group[name])
        if name in slopes.quantities:
            quantity = slopes.quantities[name]
            if quantity.axis in slopes.repeats:
                added = Add(*map(self.product, quantity.terms))
                return f"({ExcelPrinter(partial(self.symbol, rows=rows), self.total, rows).doprint(added)})"
            if name in slopes.folded:
                return f"({'+'.join(self.texts(quantity)) or '0'})"
            return self.cells(name, quantity.axis, rows)
        if name in slopes.spread:
            return self.cells(name, slopes.spread[name].rows, rows)
        if name in slopes.held and name != self.name:
            return self.cells(name, _name(slopes.axis_of_held(name)), rows)
        leaf = self.plan.named[name]
        if leaf.kind in ("size", "kept") and leaf.axis and self.layouts[leaf.axis.name].starts is not None:
            raise NotPrintable(f"{name} is a number of each group")
        if self.segment and leaf.axis and leaf.axis.name == self.segment:
            place, address = self.in_segment(leaf)
            return place.to_si(address)
        return super().symbol(symbol, rows)

    def cells(self, name: str, axis: str | None, rows: bool) -> str:
        """The cells of what is printed here: one number, that of the row, or those of all rows."""
        place = self.places.columns[name]
        if axis is None:
            return place.cell(0, self.here)
        return place.range(self.here) if rows else self.fill(place)

    def in_segment(self, leaf: Leaf) -> tuple[Place, str]:
        """Where cells stand that rows name which repeat the own row, and their address."""
        parent, index = self.slopes.repeats[self.segment]
        if leaf.kind == "cells" and leaf.index is not None:
            place = self.places.columns[leaf.name]
            named = None if leaf.index == index else self.layouts[parent].rows[leaf.index]
            return place, self.fill(place, named)
        place = self.place_of(leaf)
        number = self.places.indices[parent][0]
        here, size = self.here, self.layouts[self.segment].size // max(1, self.layouts[parent].size)
        row = f"{size}*ROWS({number.cell(0, here)}:{self.fill(number)})"
        return place, f"INDEX({place.range(here)},{row}-{size - 1}):INDEX({place.range(here)},{row})"

    def stretch(self, place: Place, axis: str) -> str:
        """All rows of an axis; of a sum in groups, and of what has a place there, those of the group."""
        quantity = self.slopes.quantities.get(self.name)
        grouped = self.name in self.slopes.held or (quantity and quantity.share and quantity.axis)
        return super().stretch(place, axis) if grouped else place.range(self.here)

    def product(self, term: Term, spread: bool = False) -> Expr:
        """A term, for a row or for rows."""
        slopes, factors = self.slopes, list[Expr]()
        for name in term.factors:
            part = slopes.parts.get(name)
            factors.append(Symbol(name) if part is None or (spread and name in slopes.spread) else part.value)
        if term.by and term.group is not None and term.rows is not None:
            symbol = f"{term.by} in {term.rows}"
            self.of_group[symbol] = self.places.columns[term.by], self.layouts[term.rows].group
            factors.append(Symbol(symbol))
        elif term.by:
            factors.append(Symbol(term.by))
        return Mul(*factors)

    def guard(self, term: Term, rows: bool = False) -> str:
        """Whether a row counts, or which rows do; empty if all do."""
        if not term.of or term.rows is None:
            return ""
        axis, column = self.slopes.axes[term.rows], self.sheet[term.of]
        leaves = [Leaf("cells", term.of, axis)]
        if term.over:
            named = ((r.name, r.index) for r in self.sheet.named(column) if r.over == axis)
            leaves = [Leaf("cells", name, axis, None if i == axis.index_name else i) for name, i in named]
        if self.segment:
            leaves = [leaf for leaf in leaves if leaf.index is None]
            return self.in_segment(leaves[0])[1] if leaves else ""
        return "*".join(f"ISNUMBER({self.address(leaf, rows)})" for leaf in leaves)

    # --- adjoints

    def adjoint(self, quantity: Adjoint) -> tuple[FilledDown, ...]:
        """The formulas of an adjoint, one a row."""
        if quantity.solved:
            return self.rows(self.solved(quantity.solved, quantity.axis))
        if quantity.share:
            return self.rows(self.share(quantity.share))
        rows_of = [term for term in quantity.terms if self.slopes.explicit(quantity, term)]
        filled = self.rows("+".join(self.texts(quantity)) or "0")
        if not rows_of:
            return filled
        every = [formula for each in filled for formula in each.formulas()]
        more = self.of_rows(rows_of, len(every))
        return tuple(FilledDown(1, f"{text}{added}") for text, added in zip(every, more, strict=True))

    def texts(self, quantity: Adjoint) -> Iterator[str]:
        """What is added up for a row, but what is named one by one."""
        if quantity.plus:
            yield f"{quantity.plus:.0f}"
        terms = (term for term in quantity.terms if not self.slopes.explicit(quantity, term))
        for rows, own in _by(terms, lambda term: term.rows or ""):
            if (rows or None) == quantity.axis:
                yield from self.here_texts(own)
            elif quantity.axis is None:
                yield from self.summed(own)
            elif rows in self.slopes.repeats:
                yield from self.repeated_texts(own, rows)
            else:
                yield from self.of_pairs(own, quantity.axis)

    def here_texts(self, terms: Iterable[Term]) -> Iterator[str]:
        """Terms of the own row."""
        for guard, own in _by(terms, self.guarded):
            text = str(self.printer.doprint(Add(*map(self.product, own))))
            if text != "0":
                yield f"IF({guard},{text},0)" if guard else text

    def guarded(self, term: Term) -> str:
        """The test of a row: none if nothing is named but adjoints, which are 0 there."""
        names = {symbol.name for symbol in self.product(term).free_symbols}
        return "" if not term.over and names <= self.slopes.quantities.keys() else self.guard(term)

    def summed(self, terms: Iterable[Term]) -> Iterator[str]:
        """Terms of all rows."""
        for guard, own in _by(terms, partial(self.guard, rows=True)):
            text = self.printer_of_rows.doprint(Add(*map(self.product, own)))
            yield f"SUM(IF({guard},{text},0))" if guard else f"SUM(IF(1=1,{text},0))"

    def repeated_texts(self, terms: Iterable[Term], axis: str) -> Iterator[str]:
        """Terms of the rows that repeat the own one: either all have values, or none does."""
        self.segment = axis
        for rows, own in _by(terms, self.guard):
            text = self.printer_of_rows.doprint(Add(*map(self.product, own)))
            self.array |= "IF(" in text
            yield f"IF(COUNT({rows})=0,0,SUMPRODUCT(ISNUMBER({rows})*({text})))"
        self.segment = ""

    def of_pairs(self, terms: Iterable[Term], axis: str) -> Iterator[str]:
        """Terms of all pairs that name the own row."""
        own = self.fill(self.places.indices[axis][0])
        for (rows, index), some in _by(terms, lambda term: (term.rows, term.index)):
            pairs = self.slopes.axes[rows]
            assert isinstance(pairs, PairAxis)
            parts = self.places.indices[rows]
            member = parts[pairs.members.index(index) * len(parts) // 2]
            text = self.printer_of_rows.doprint(Add(*(self.product(term, spread=True) for term in some)))
            self.array |= "IF(" in text
            yield f"SUMPRODUCT(({member.range(self.here)}={own})*({text}))"

    def of_rows(self, terms: Iterable[Term], size: int) -> Iterator[str]:
        """Terms of the rows that name the own one, for each row."""
        every = [(term, self.layouts[term.rows].rows[term.index or ""]) for term in terms if term.rows]
        for row in range(size):
            texts = []
            for term, named in every:
                for number in np.flatnonzero(named == row).tolist():

                    def address(symbol: Symbol, number: int = number) -> str:
                        name = str(symbol.name)
                        quantity = self.slopes.quantities.get(name)
                        if quantity and quantity.axis is None:
                            number = 0
                        return self.places.columns[name].cell(number, self.here)

                    text = ExcelPrinter(address).doprint(self.product(term, spread=True))
                    texts.append(f"+{text}")
            yield "".join(texts)

    def share(self, share: Share) -> str:
        """What a row counts by its place: rows with one value share it."""
        total = self.plan.totals[share.total]
        (symbol,) = total.terms.free_symbols
        term = Term((), rows=total.over.name, of=total.column.name, over=True)
        taken = [self.taken(name, total.over.name) for name in share.taken]
        if share.word == "rows":
            own, pairs = self.symbol(symbol), zip(taken[::2], taken[1::2], strict=True)
            counted = "+".join(f"IF({own}={value},1/{number},0)" for value, number in pairs)
            return f"IF({self.guard(term)},({counted})/{len(taken) // 2},0)"
        rows, cells = self.guard(term, rows=True), self.symbol(symbol, rows=True)
        if share.word == "number":
            return f"SUM(IF({rows},IF({cells}={taken[0]},1,0),0))"
        every = f'IF({rows},{cells},"")'
        count = f"COUNT({every})"
        least = {"median": (f"INT(({count}+1)/2)", f"INT({count}/2)+1"), "min": ("1",), "max": (count,)}
        return f"SMALL({every},{least[total.word][share.place]})"

    def taken(self, name: str, rows: str) -> str:
        """What stands in a place of a total by order, or how many rows have it: of groups, the own one's."""
        place, axis = self.places.columns[name], self.slopes.quantities[name].axis
        if axis is None:
            return place.cell(0, self.here)
        return self.fill(place, None if _name(self.axis) == axis else self.layouts[rows].group)

    def solved(self, solved: Any, axis: str | None) -> str:
        """A place in the solution of the equations of a loop."""
        size, matrix = len(solved.right), solved.matrix
        if size <= _CRAMER:
            moves = [[Symbol(name) if name else Integer(0) for name in own] for own in matrix]
            left = eye(size) - Matrix(moves).T
            found = (left.adjugate() * Matrix([Symbol(name) for name in solved.right]))[solved.place]
            return str(self.printer.doprint(found / left.det()))
        if axis is not None:
            raise NotPrintable("a loop of many columns with rows")
        columns, here = self.places.columns, self.here
        first, last = columns[matrix[0][0]], columns[matrix[-1][-1]]
        square = f"{first.cell(0, here)}:{last.cell(0, here)}"
        right = f"{columns[solved.right[0]].cell(0, here)}:{columns[solved.right[-1]].cell(0, here)}"
        one = f"(ROW({square})-ROW({first.cell(0, here)})=COLUMN({square})-COLUMN({first.cell(0, here)}))*1"
        return f"INDEX(MMULT(MINVERSE({one}-{square}),{right}),{solved.place + 1})"


def _by(terms: Iterable[Term], key: Any) -> Iterator[tuple[Any, list[Term]]]:
    """Terms that have something in common, in their order."""
    found: dict[Any, list[Term]] = {}
    for term in terms:
        found.setdefault(key(term), []).append(term)
    yield from found.items()


def _name(axis: Axis | None) -> str | None:
    return None if axis is None else axis.name


def _axis(leaf: Leaf) -> Axis:
    assert leaf.axis is not None
    return leaf.axis
