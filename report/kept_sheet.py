"""The sheet of a shipped workbook as data: made once, so that what runs of it needs no algebra.

What is kept says which columns there are and what each of them names. Their rules are not kept: they are
declared again when somebody asks for one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

from .cells.marks import margins
from .column import Axis, Column, Formula, Given, Limit, Mentioned, PairAxis, RepeatAxis, Root, Rule
from .machine.kept import kept
from .partly import partly
from .plan.kept import as_data, of_data
from .quantity import Bounds
from .sheet import Sheet
from .which_workbook import is_shipped
from .workbook import Workbook

__all__ = ["of_shipped", "sheet_of"]

_KINDS = {kind.__name__: kind for kind in (Axis, PairAxis, RepeatAxis)}


@dataclass(frozen=True)
class _ToldAxis:
    """What an index set says; `of` is the name of its parent."""

    kind: str
    words: dict[str, Any]
    of: str | None
    alone: str


@dataclass(frozen=True)
class _ToldLimit:
    """What a limit says; `inside` if that is no algebra."""

    says: str
    source: str
    silent: bool
    inside: dict[str, Any] | None
    mentioned: Mentioned


@dataclass(frozen=True)
class _ToldColumn:
    """What a column says; `given` if it is, and of a root what there is to say of its cells."""

    name: str
    axis: str | None
    unit: str
    meaning: str
    latex: str
    display: str
    positive: bool
    exact: bool
    source: str
    conditions: int
    mentioned: Mentioned
    limits: tuple[_ToldLimit, ...]
    given: dict[str, Any] | None
    root: tuple[str, str, str] | None


@dataclass(frozen=True)
class _ToldSheet:
    axes: tuple[_ToldAxis, ...]
    columns: tuple[_ToldColumn, ...]


def sheet_of(workbook: Workbook, given: frozenset[str], check: Callable[[Sheet], None]) -> Sheet:
    """The sheet of a workbook.

    Parameters
    ----------
    workbook : Workbook
    given : frozenset of str
        As for :attr:`Workbook.sheet`.
    check : callable
        Refuses a sheet that is not as it must be; it was asked of one that is kept.

    Raises
    ------
    SheetError
        What is declared cannot be a sheet.
    """

    @cache
    def declared() -> Sheet:
        return workbook.sheet(given)

    def make() -> Any:
        check(declared())
        own = all(type(axis) in _KINDS.values() for axis in declared().axes)
        return as_data(_told(declared())) if own else None

    if not is_shipped(workbook):  # a user's own code has loaded all that it wants
        check(declared())
        return declared()
    data = of_shipped(workbook, given, "sheet", make)
    if data is None:  # it has index sets of a kind that is not known here
        return declared()
    return _Known(of_data(data, _ToldSheet), declared).sheet()


def of_shipped(workbook: Workbook, given: frozenset[str], what: str, make: Callable[[], Any]) -> Any:
    """What is made of a shipped workbook for some given parameters, now or before; of another it is made."""
    return kept(what, [workbook.name, *sorted(given)], make) if is_shipped(workbook) else make()


# --- telling ---------------------------------------------------------------------------------------------


def _told(sheet: Sheet) -> _ToldSheet:
    found = margins(sheet)
    whole = Sheet((*sheet.columns, *(margin.column for margin in found)))
    limits = {id(margin.limit): _mentioned(whole, margin.column) for margin in found}
    return _ToldSheet(tuple(map(_axis, sheet.axes)), tuple(_column(sheet, c, limits) for c in sheet.columns))


def _axis(axis: Axis) -> _ToldAxis:
    of = axis.parents[0].name if axis.parents else None
    return _ToldAxis(type(axis).__name__, axis.words, of, axis.alone.content)


def _mentioned(sheet: Sheet, column: Column) -> Mentioned:
    named = tuple((r.name, r.index, None if r.over is None else r.over.name) for r in sheet.named(column))
    return Mentioned(named, tuple(axis.name for axis in sheet.summed_axes(column)), column.content)


def _column(sheet: Sheet, column: Column, margins: Mapping[int, Mentioned]) -> _ToldColumn:
    rule = column.rule
    limits = (
        _ToldLimit(
            own.says,
            own.source,
            own.silent,
            asdict(own.inside) if isinstance(own.inside, Bounds) else None,
            margins[id(own)],
        )
        for own in column.limits
    )
    return _ToldColumn(
        column.name, None if column.axis is None else column.axis.name, column.unit, column.meaning,
        column.latex, column.display, column.positive, column.exact, column.source, len(column.requires),
        _mentioned(sheet, column), tuple(limits), asdict(rule) if isinstance(rule, Given) else None,
        (rule.none, rule.two, rule.unknown_name) if isinstance(rule, Root) else None,
    )  # fmt: skip


# --- the same again --------------------------------------------------------------------------------------


class _Known:
    """A sheet of what was told.

    Parameters
    ----------
    told : _ToldSheet
    declared : callable
        Returns the sheet that it was told of.
    """

    def __init__(self, told: _ToldSheet, declared: Callable[[], Sheet]) -> None:
        self.told, self.declared = told, declared
        self.axes: dict[str, Axis] = {}

    def sheet(self) -> Sheet:
        for told in self.told.axes:
            self.axes[told.words["name"]] = self.axis(told)
        return Sheet(tuple(map(self.column, self.told.columns)))

    def axis(self, told: _ToldAxis) -> Axis:
        def whole() -> Axis:
            return next(axis for axis in self.declared().axes if axis.name == told.words["name"])

        words = {name: tuple(own) if isinstance(own, list) else own for name, own in told.words.items()}
        alone = partly(Axis, {**words, "content": told.alone}, lambda: whole().alone)
        parent = {"of": self.axes[told.of]} if told.of else {}
        return partly(_KINDS[told.kind], {**words, **parent, "alone": alone}, whole)

    def column(self, told: _ToldColumn) -> Column:
        def whole() -> Column:
            return self.declared()[told.name]

        limits = tuple(self.limit(each, n, whole) for n, each in enumerate(told.limits))
        known: dict[str, Any] = {
            name: getattr(told, name)
            for name in (
                "name",
                "unit",
                "meaning",
                "latex",
                "display",
                "positive",
                "exact",
                "source",
                "mentioned",
            )
        }
        known |= {"axis": self.axes[told.axis] if told.axis else None, "limits": limits}
        known |= {"content": told.mentioned.content, "rule": self.rule(told, whole)}
        if not told.conditions:
            known["requires"] = ()
        return partly(Column, known, whole)

    def rule(self, told: _ToldColumn, whole: Callable[[], Column]) -> Rule:
        if told.given is not None:
            return Given(told.given["source"], Bounds(**told.given["bounds"]))
        if told.root is None:
            return partly(Formula, {}, lambda: whole().rule)  # type: ignore[arg-type, return-value]
        known = dict(zip(("none", "two", "unknown_name"), told.root, strict=True))
        return partly(Root, known, lambda: whole().rule)  # type: ignore[arg-type, return-value]

    def limit(self, told: _ToldLimit, place: int, whole: Callable[[], Column]) -> Limit:
        known: dict[str, Any] = {"says": told.says, "source": told.source, "silent": told.silent}
        if told.inside is not None:
            known["inside"] = Bounds(**told.inside)
        return partly(Limit, {**known, "mentioned": told.mentioned}, lambda: whole().limits[place])
