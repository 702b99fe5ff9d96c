"""What the cells of a workbook show before a spreadsheet has recalculated them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cells.grid import CellBlock, FilledDown, Place
from ..cells.layout import evenly, precedents
from ..cells.values import CODES, Status, Values, inherited, rows_kept
from ..plan.adjoints import Adjoint, Term
from ..plan.kept import of_data
from ..plan.slopes import NodeDerivatives, with_unknowns
from ..sheet import Sheet
from .excel_loops import pass_name, passes_of
from .kernels import Array
from .numpy import Laid, Program, again, parts
from .numpy_adjoints import computed

READY = "ready"
"""What the first cell says where all precedents have values."""


SETTLED = 10**7
"""A last step smaller than this part of the unknown leaves, by its order, less than rounding does."""


STAYS = 10**12
"""A last pass that moves a value by a smaller part leaves less than rounding does."""


class NotPrintable(ValueError):
    """An expression has no spreadsheet formula; half a formula is never printed."""


def filled(
    blocks: Iterable[CellBlock],
    found: Mapping[str, tuple[float | str, ...]],
    values: Values,
    slopes: Mapping[str, Array],
) -> Iterator[CellBlock]:
    """The blocks of a grid with what they show.

    `found`: from :func:`auxiliary_values`, of all roots. `values`: all columns, computed, without a batch.
    `slopes`: from :func:`slope_values`.
    """
    for block in blocks:
        what, name, *more = block.shows
        if what == "labels":
            labels = values.layouts[name].labels[:, int(more[0])]
            shown: tuple[float | str | None, ...] = tuple(map(float, labels))
        elif what == "slope":
            # As many digits as every spreadsheet reads.
            numbers = (float(f"{number:.15g}") + 0.0 for number in slopes[name].tolist())
            shown = tuple(number if math.isfinite(number) else None for number in numbers)
        else:
            shown = found[name] if what.endswith("cell") else _cells(values, name, block.place)
        if what == "drawn":
            some = (shown[row] for row in evenly(len(shown), block.place.rows).tolist())
            shown = tuple(None if isinstance(value, str) else value for value in some)
        elif what == "carried":
            axis, index = more
            shown = tuple(shown[row] for row in values.layouts[axis].rows[index].tolist())
        told = replace(block, values=shown)
        if what.startswith("typed"):
            told = replace(told, filled=tuple(FilledDown(1, _literal(value)) for value in shown))
        yield told


def _cells(values: Values, name: str, place: Place) -> tuple[float | str | None, ...]:
    """A column's values in the unit of its cells; the code where there is none."""
    # Adding zero leaves no minus on a zero.
    scale, held = place.scale, values.value[name]
    numbers = (held * float(scale.denominator) / float(scale.numerator) + 0.0).tolist()
    if place.zero:
        numbers = list(map(place.of, held.tolist()))
    codes = {int(status): code for status, code in CODES.items()}
    pairs = zip(numbers, values.status[name].tolist(), strict=True)
    return tuple(number if not status else codes[status] for number, status in pairs)


def _literal(value: float | str | None) -> str:
    """A formula that is a number, with no exponent, or a text."""
    return f"={Decimal(repr(value)):f}" if isinstance(value, float) else f'="{value}"'


def auxiliary_values(values: Values, root: Mapping[str, Any]) -> dict[str, tuple[float | str, ...]]:
    """The values of every cell of an unrolled root, by name; an empty text where there is none.

    `root`: from :func:`~loopsheet.report.engines.excel_assembly.auxiliary_texts`.
    """
    column, sheet = values.sheet[root["column"]], values.sheet
    named, rows = precedents(sheet, values.layouts, column), len(values.value[column.name])
    codes = inherited(named, rows_kept(named, values.layouts, values.status), values.status, rows)
    asked = (root["issued"], np.ones(rows)), (root["counted"], _counted(values, column.name))
    told = {name: known for name, known in asked if name is not None}
    program = Program.of_texts(sheet, root["program"])
    found = parts(program, replace(values, value={**values.value, **told}))
    cells = {name: found[symbol] for name, symbol, _ in root["cells"]}
    ready = codes == Status.OK
    alone = ready & (cells[root["number"]] == 1)
    shown: dict[str, tuple[float | str, ...]] = {name: tuple(own.tolist()) for name, own in told.items()}
    shown |= {name: _shown(cells[name], alone if single else ready) for name, _, single in root["cells"]}
    check = (READY if code == Status.OK else CODES[Status(int(code))] for code in codes)
    return shown | {root["check"]: tuple(check)}


def with_passes(values: Values, sheet: Sheet, last: int, done: int) -> Values:
    """The values with those of the passes of a sheet's loops that have no columns of their own.

    `values`: of the sheet and of its :func:`~loopsheet.report.engines.excel_loops.pass_columns`, with as many
    passes as are `done`. `last`: up to which pass.
    """
    first = [each for each in passes_of(sheet).values() if each.number == 1]
    if not first:
        return values
    iterated = [column.name for loop in sheet.loops for column in loop.iterated]
    ours, names = {each.name for each in first}, [column.name for column in values.sheet.columns]
    program = Program.of(values.sheet, tuple(name for name in names if name not in ours))
    laid, value, status = Laid(values.sheet, dict(values.layouts)), dict(values.value), dict(values.status)
    every = replace(values, value=value, status=status)
    for number in range(done + 1, last + 1):
        begun = {pass_name(name, 0): pass_name(name, number - 1) for name in iterated}
        here = again(every, begun, program, laid)
        for each in first:
            name = pass_name(each.of, number)
            value[name], status[name] = here.value[each.name], here.status[each.name]
    return every


def loops_settle(values: Values, sheet: Sheet, last: int) -> bool:
    """Whether every iterated cell that has a value stays in the last pass, as a workbook asks.

    `values`: from :func:`with_passes`, as are the others.
    """
    for column in (column for loop in sheet.loops for column in loop.iterated):
        before, after = (values.value[pass_name(column.name, last - back)] for back in (1, 0))
        moved = np.abs(after - before) * STAYS > np.abs(after)
        if np.any(moved & (values.status[column.name] == Status.OK)):
            return False
    return True


def settles(values: Values, root: Mapping[str, Any], found: Mapping[str, Sequence[float | str]]) -> bool:
    """Whether the last step to a root leaves every row that has one where it is.

    `root` and `found`: of :func:`auxiliary_values`.
    """
    rows = zip(*(found[name] for name in root["last"]), values.status[root["column"]], strict=True)
    return all(
        isinstance(before, float) and isinstance(last, float) and abs(last - before) * SETTLED <= abs(last)
        for before, last, status in rows
        if status == Status.OK
    )


def slope_values(values: Values, sheet: Sheet, told: Mapping[str, Any]) -> dict[str, Array]:
    """The values of all derivatives of results, by name.

    `sheet`: of the report. `told`: from :meth:`~loopsheet.report.engines.excel_slopes.Slopes.told`.
    """
    program = Program.of_texts(with_unknowns(sheet, told["again"]), told["program"])
    found = parts(program, values)
    nodes = {node.name: node for node in of_data(told["nodes"], tuple[NodeDerivatives, ...])}
    held = {name: found[part] for name, part in told["held"].items()}
    terms = of_data(told["spread"], dict[str, Term])
    spread = [
        Adjoint(name, "", "", term.rows, (replace(term, factors=(name,), by="", group=None),))
        for name, term in terms.items()
    ]
    quantities = of_data(told["quantities"], tuple[Adjoint, ...])
    return held | computed([*spread, *quantities], nodes, found, values)


def _shown(numbers: Array, wanted: NDArray[np.bool_]) -> tuple[float | str, ...]:
    """Numbers where they are wanted and there are any."""
    pairs = zip(numbers.tolist(), (wanted & np.isfinite(numbers)).tolist(), strict=True)
    return tuple(number + 0.0 if there else "" for number, there in pairs)


def _counted(values: Values, name: str) -> Array:
    """How many roots each row has; -1 where that is not certain."""
    status, roots = values.status[name], values.roots.get(name, {})
    several = [max(2, len(roots.get(row, ()))) for row in range(len(status))]
    codes = [Status.NOROOT, Status.TWOROOTS, Status.UNDECIDED]
    return np.select([status == code for code in codes], [0, several, -1], 1).astype(np.float64)
