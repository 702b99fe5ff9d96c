"""A finished report: everything a view shows, computed. Views read this and compute nothing."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ..cells.marks import Marks
from ..cells.values import Cell, Status, Values
from ..files.values import Unit
from ..inputs.inputs import Inputs
from ..inputs.published import PublishedValue
from ..messages.diagnostics import Check
from ..quantity import Printed, behind
from ..sheet import Column, Given, Iterated, Sheet
from ..workbook import Workbook
from .agreement import Agreement
from .card import Cards
from .numbers import Numeral, last_place, order, read, shown, stated, uncertainty
from .uncertain import Uncertainties
from .verdict import (
    OTHERWISE,
    UNAMENDED,
    UNEXPECTED,
    UNEXPLAINED,
    UNPINNED,
    UNREASONED,
    Referee,
    Verdict,
)

if TYPE_CHECKING:
    from ...derivations.equation import Erratum, Ledger
    from ...derivations.proved import Proof
    from ..engines.exact import ExactValues


@dataclass(frozen=True)
class Shown:
    """How a column is shown."""

    unit: str
    """The unit it is shown in, as text; ``1`` for a pure number."""
    scale: float
    """One such unit in SI."""
    digits: int
    """Significant digits of a cell whose uncertainty is not known: one more than the least precise input
    behind it."""
    zero: float = 0.0
    """Zero of that unit in SI: 273.15 for ``degC``."""

    def of(self, value: Any) -> Any:
        """A value in SI, or an array of them, in that unit; of a difference only its scale is asked."""
        return (value - self.zero) / self.scale

    @property
    def as_data(self) -> Unit:
        """The unit, as files hold it."""
        return Unit(text=self.unit, scale=self.scale, zero=self.zero)

    def digits_of(self, value: float) -> str:
        """All digits of a value in SI in that unit."""
        return repr(self.as_data.of(value))


@dataclass(frozen=True)
class Plotted:
    """What charts are drawn from."""

    values: Values
    """Of the sheet and of the columns that only charts ask for."""
    shown: Mapping[str, Shown]
    """By column name; the same for both."""


@dataclass(frozen=True)
class Comparison:
    """A published value beside its recomputation."""

    published: PublishedValue
    """What was printed, and whether a difference is expected."""
    cell: Cell
    """The recomputed cell."""
    again: str
    """The recomputed value, printed as the published one is: same unit, same decimals."""
    distance: float | None
    """Recomputed minus published, in units of the last printed digit; None where there is no value."""
    verdict: str
    """``same`` (prints the same), ``differs`` or ``not-checkable`` (the cell has no value)."""
    finding: str
    """What is not as expected, in a word of :mod:`~loopsheet.report.result.verdict`; empty if all is. What
    the referee found reachable differs by no more than the printed digits of the inputs allow, and is no
    finding."""
    refereed: Verdict | None = None
    """What the referee says of it; None if it was not asked."""
    instead: str = ""
    """Of an uncertainty that differs, the other one that prints so: ``U``, ``2 u``."""

    @property
    def as_expected(self) -> bool:
        """Whether there is nothing to find."""
        return not self.finding

    @property
    def says_nothing(self) -> bool:
        """Whether 0 is published of a value that is none, in digits or a unit too coarse for it."""
        return self.published.printed.value == 0 and self.cell.value not in (None, 0)

    @property
    def known(self) -> tuple[str | None, str]:
        """What a view that recalculates shall expect, and what there is to find even so.

        None for a value that shall print as published, and what there is to find if it does not. For a known
        difference what is recomputed then, printed as here; nothing where no number would do.
        """
        published, pin = self.published, self.published.pin
        if not published.expect:
            return None, "" if self.verdict == "differs" and self.as_expected else UNEXPECTED
        if pin is None:
            return "", UNPINNED
        if not pin.holds(published.printed, pin.again):
            return "", OTHERWISE  # another number was published when it was pinned
        even_so = self.finding if self.finding in (UNREASONED, UNEXPLAINED, UNAMENDED) else ""
        return self.again if pin.holds(published.printed, self.again) else pin.again, even_so

    @property
    def word(self) -> str:
        """What the referee says in a word; without it, whether it prints the same."""
        return self.verdict if self.refereed is None else self.refereed.verdict


@dataclass(frozen=True)
class Report:
    """All that is known after the sheet has been computed."""

    title: str
    workbook: Workbook
    inputs: Inputs
    """As the user gave them, with the digits as printed."""
    sheet: Sheet
    values: Values
    """Every cell, in SI, without a batch dimension."""
    marks: Marks
    """Which of them lie outside of what is expected."""
    exactly: ExactValues | None
    """Every cell at 50 digits, for the judge of the engines; then `values` and `marks` are these, rounded to
    the nearest doubles. None where the sheet is too large for that: then they are NumPy's."""
    shown: Mapping[str, Shown]
    """By column name."""
    algebra: Callable[[], Ledger]
    """Returns the ledger."""
    comparisons: tuple[Comparison, ...]
    """In the order of published.csv."""
    plotted: Callable[[], Plotted]
    """Computes what charts ask for besides."""
    uncertain: Callable[[], Uncertainties]
    """Computes the standard uncertainties of the cells."""
    proofs: tuple[Proof, ...] = ()
    """One for each equation of the ledger, in its order."""
    errata: tuple[Erratum, ...] = ()
    """Findings about the source's print, each made by a check."""
    engines: tuple[Agreement, ...] = ()
    """What the judge of the engines found, NumPy first; empty if it was not asked."""
    oddities: tuple[Check, ...] = ()
    """Whether the data of the campaign itself are as expected."""
    referee: Referee = field(default_factory=Referee)
    """What the referee found; empty if it was not asked."""
    versions: Mapping[str, str] = field(default_factory=dict)
    """What computed it: this program and its libraries."""
    comparisons_u: tuple[Comparison, ...] = ()
    """The same of what is published of uncertainties, each with a cell of its own; empty before the referee
    was asked."""
    cards: Callable[[], Cards] = Cards
    """Makes the cards for simulation codes that the folder asks for."""
    _figures: dict[str, tuple[Numeral | None, ...]] = field(default_factory=dict, init=False, compare=False)

    @property
    def every_comparison(self) -> tuple[Comparison, ...]:
        """Of values and of uncertainties, as they stand in published.csv."""
        if not self.comparisons_u:
            return self.comparisons
        every = (*self.comparisons, *self.comparisons_u)
        return tuple(sorted(every, key=lambda each: each.published.places["value"].line or 0))

    @cached_property
    def faults(self) -> tuple[Cell, ...]:
        """The cells where an error begins: of a loop that does not settle those of one column.

        What is missing is the number, not its uncertainty.
        """
        return tuple(
            cell
            for cell in self.values.errors()
            if not self.marks.is_faultless(cell)
            and not getattr(self.sheet[cell.name].rule, "u_of", "")
            and (cell.status is not Status.NOROOT or self.told_of(self.sheet[cell.name]) == cell.name)
        )

    def told_of(self, column: Column) -> str:
        """The column that tells that the loop of a column does not settle: of the result, or the first."""
        loop = self.sheet.loop_of.get(column.name)
        if loop is None or not isinstance(column.rule, Iterated):
            return column.name
        names = [column.name for column in loop.iterated]
        return next((name for name in self.workbook.headline if name in names), names[0])

    @property
    def ledger(self) -> Ledger:
        """The equations of its workbook."""
        return self.algebra()

    # --- numbers as they are shown, in every view

    def words(self, column: Column) -> dict[tuple[int, ...], str]:
        """What the rows of a column are known by besides their numbers; nothing where there are no words."""
        return dict(self.values.words.get(column.axis.name, {})) if column.axis else {}

    def in_unit(self, name: str) -> list[float | None]:
        """The cells of a column in the unit that it is shown in; None where there is no value."""
        # A double divided by a scale such as 1e-6 is not exact; the error is far below any shown digit.
        how = self.shown[name]
        return [None if value is None else how.of(value) for value in self.values.numbers(name)]

    def places(self, name: str) -> list[int]:
        """The power of ten of the last digit that is shown of each cell of a column, in its unit."""
        how, most = self.shown[name], self.inputs.uncertainty.digits
        known = self.uncertain().u
        values = self.in_unit(name)
        if self.sheet[name].is_u:
            return [order(value) - most + 1 if value else 0 for value in values]
        u = (known[name] / how.scale).tolist() if name in known else [math.nan] * len(values)
        return [last_place(value or 0.0, own, how.digits, most) for value, own in zip(values, u, strict=True)]

    def printed(self, name: str) -> tuple[Printed | None, ...]:
        """What was printed of a given column; nothing of others, nor of what another report has computed."""
        given = isinstance(self.sheet[name].rule, Given) and name not in self.inputs.taken
        return self.inputs.printed(name) if given else ()

    def figures(self, name: str) -> tuple[Numeral | None, ...]:
        """The cells of a column as they are shown: in one notation, or as they were printed."""
        if name not in self._figures:
            printed = tuple(read(each.text) if each else None for each in self.printed(name))
            self._figures[name] = printed or shown(self.in_unit(name), self.places(name))
        return self._figures[name]

    def text(self, cell: Cell) -> str:
        """A cell as it is shown, with its unit: a given one as it was printed; without a value, its code."""
        if cell.value is None:
            return cell.status.code
        row = self.values.row(self.sheet[cell.name], cell.label)
        figure, number = (
            self.figures(cell.name)[row],
            next(iter(self.printed(cell.name)[row : row + 1]), None),
        )
        text = number.text if number else figure.text if figure else ""
        return text + behind(self.shown[cell.name].unit)

    def stated(self, name: str, value: float, u: float) -> tuple[Numeral, Numeral]:
        """A value of a column and its uncertainty, both in SI, as they are shown together in its unit."""
        how = self.shown[name]
        return stated(how.of(value), u / how.scale, self.inputs.uncertainty.digits)

    def sure(self, name: str, u: float) -> Numeral:
        """An uncertainty of a column by itself, in SI, as it is shown in its unit."""
        return uncertainty(u / self.shown[name].scale, self.inputs.uncertainty.digits)
