"""Sheet and equations of a shipped workbook as data: made once, so that what runs of them needs no algebra.

What is kept says which columns there are and what each of them names. Their rules are not kept: they are
declared again when somebody asks for one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

from ..derivations.equation import Derivation, Equation, Kind, Ledger, Step
from ..derivations.vocabulary import Quantity, Vocabulary
from .axis import Axis, CountedAxis, GroupAxis, MemberAxis, PairAxis, RepeatAxis
from .cells.marks import margins
from .charts import Drawn
from .column import Column, Formula, Given, Iterated, Limit, Mentioned, Root, Rule
from .document.names import latex_names
from .document.parts import Placed, Written
from .document.written import gone, placed, written
from .machine.kept import kept
from .partly import is_partly, partly
from .plan.kept import as_data, of_data
from .quantity import Bounds
from .sheet import Sheet, with_parents
from .which_workbook import is_shipped
from .workbook import Workbook

_KINDS = {kind.__name__: kind for kind in (Axis, CountedAxis, GroupAxis, MemberAxis, PairAxis, RepeatAxis)}
_WORDS = ("number", "part", "title", "because")
"""What an equation says, and what is told of it, alike."""


@dataclass(frozen=True)
class _ToldEquation:
    """What an equation says; `origin` is what it is an instance of."""

    words: dict[str, str]
    kind: str
    written: Written | None
    origin: _ToldEquation | None


@dataclass(frozen=True)
class _ToldStep:
    claim: _ToldEquation
    premises: tuple[_ToldEquation, ...]
    says: str
    gone: tuple[str, ...]


@dataclass(frozen=True)
class _ToldLedger:
    """What a ledger says: each entry is an equation, or the steps that end in one."""

    vocabulary: tuple[dict[str, Any], ...]
    entries: tuple[_ToldEquation | tuple[_ToldStep, ...], ...]


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


_SAME = ("unit", "meaning", "latex", "display", "positive", "nonnegative", "exact", "is_u", "spare", "source")
"""What a column says, and what is told of it, alike."""


@dataclass(frozen=True)
class _ToldColumn:
    """What a column says; `given` if it is, and of a root or a loop what there is to say of its cells."""

    name: str
    same: dict[str, Any]
    axis: str | None
    conditions: tuple[str, ...]
    mentioned: Mentioned
    limits: tuple[_ToldLimit, ...]
    alongside: tuple[str, ...]
    given: dict[str, Any] | None
    equations: tuple[_ToldEquation, ...]
    placed: Placed | None
    root: tuple[str, str, str, bool] | None
    iterated: str | None


@dataclass(frozen=True)
class _ToldSheet:
    axes: tuple[_ToldAxis, ...]
    columns: tuple[_ToldColumn, ...]


def drawn_of(
    workbook: Workbook, given: frozenset[str], sheet: Sheet, what: str, make: Callable[[], Drawn]
) -> Drawn:
    """Columns that only charts ask for.

    Parameters
    ----------
    workbook, given
        As for :func:`sheet_of`.
    sheet : Sheet
        That of :func:`sheet_of`.
    what : str
        Which columns.
    make : callable
        Declares them.
    """
    declared = cache(make)

    def told() -> Any:
        own = declared()
        whole = Sheet((*sheet.columns, *own.columns))
        axes = [axis for axis in whole.axes if axis not in sheet.axes]
        columns = tuple(_column(whole, column, {}, None) for column in own.columns)
        whole_sheet = as_data(_ToldSheet(tuple(map(_axis, axes)), columns))
        return {"sheet": whole_sheet, "given": dict(own.given), "thinned": list(own.thinned)}

    if not any(map(is_partly, sheet.columns)):
        return declared()
    data = of_shipped(workbook, given, what, told)
    columns = _Known(
        of_data(data["sheet"], _ToldSheet), lambda: {c.name: c for c in declared().columns}, sheet.axes
    ).columns()
    return Drawn(columns, data["given"], tuple(data["thinned"]))


def sheet_of(workbook: Workbook, given: frozenset[str], check: Callable[[Sheet], None]) -> Sheet:
    """The sheet of a workbook.

    Parameters
    ----------
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
        return as_data(_told(declared(), workbook.ledger().vocabulary)) if own else None

    if not is_shipped(workbook):  # a user's own code has loaded all that it wants
        check(declared())
        return declared()
    data = of_shipped(workbook, given, "sheet", make)
    if data is None:  # it has index sets of a kind that is not known here
        return declared()
    return Sheet(_Known(of_data(data, _ToldSheet), lambda: declared().by_name).columns())


def ledger_of(
    workbook: Workbook, given: frozenset[str], sheet: Sheet, declared: Callable[[], Ledger]
) -> Ledger:
    """The ledger of a workbook; parameters as for :func:`drawn_of`."""
    if not is_shipped(workbook):
        return declared()

    def told() -> Any:
        return as_data(_told_ledger(declared(), latex_names(declared().vocabulary, sheet.columns)))

    return _known_ledger(of_data(of_shipped(workbook, given, "ledger", told), _ToldLedger), declared)


def of_shipped(workbook: Workbook, given: frozenset[str], what: str, make: Callable[[], Any]) -> Any:
    """What is made of a shipped workbook for some given parameters, now or before; of another it is made."""
    return kept(what, [workbook.name, *sorted(given)], make) if is_shipped(workbook) else make()


# --- telling ---------------------------------------------------------------------------------------------


def _told(sheet: Sheet, vocabulary: Vocabulary) -> _ToldSheet:
    found, writing = margins(sheet), (latex_names(vocabulary, sheet.columns), vocabulary)
    whole = Sheet((*sheet.columns, *(margin.column for margin in found)))
    limits = {id(margin.limit): _mentioned(whole, margin.column) for margin in found}
    columns = (_column(sheet, column, limits, writing) for column in sheet.columns)
    return _ToldSheet(tuple(map(_axis, sheet.axes)), tuple(columns))


def _axis(axis: Axis) -> _ToldAxis:
    of = axis.parents[0].name if axis.parents else None
    return _ToldAxis(type(axis).__name__, axis.words, of, axis.alone.content)


def _mentioned(sheet: Sheet, column: Column) -> Mentioned:
    named = tuple((r.name, r.index, None if r.over is None else r.over.name) for r in sheet.named(column))
    return Mentioned(named, tuple(axis.name for axis in sheet.summed_axes(column)), column.content)


def _column(
    sheet: Sheet,
    column: Column,
    margins: Mapping[int, Mentioned],
    writing: tuple[Mapping[str, str], Vocabulary] | None,
) -> _ToldColumn:
    rule, equations, place = column.rule, list[Equation](), None
    if writing is not None and not isinstance(rule, Given):
        equations = [rule.equation, rule.form] if isinstance(rule, Root) else [rule.equation]
        place = placed(column, sheet, writing[0])
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
        name=column.name,
        same={name: getattr(column, name) for name in _SAME},
        axis=None if column.axis is None else column.axis.name,
        conditions=column.conditions,
        mentioned=_mentioned(sheet, column),
        limits=tuple(limits),
        alongside=tuple(other.name for other in column.alongside),
        given=asdict(rule) if isinstance(rule, Given) else None,
        equations=tuple(_told_equation(each, *writing) for each in equations) if writing else (),
        placed=place,
        root=(rule.none, rule.two, rule.unknown_name, rule.by_proof) if isinstance(rule, Root) else None,
        iterated=rule.none if isinstance(rule, Iterated) else None,
    )


def _told_equation(equation: Equation, names: Mapping[str, str], vocabulary: Vocabulary) -> _ToldEquation:
    """What there is to keep of an equation; parameters as for :func:`~.document.written.written`."""
    parent = equation.parent
    origin = None if parent is None else _ToldEquation(_words(parent), parent.kind.value, None, None)
    own = written(equation, names, vocabulary)
    return _ToldEquation(_words(equation), equation.kind.value, own, origin)


def _told_ledger(ledger: Ledger, names: Mapping[str, str]) -> _ToldLedger:
    """What there is to keep of a ledger."""

    def equation(own: Equation) -> _ToldEquation:
        return _told_equation(own, names, ledger.vocabulary)

    def step(own: Step) -> _ToldStep:
        return _ToldStep(equation(own.claim), tuple(map(equation, own.premises)), own.says, gone(own, names))

    return _ToldLedger(
        tuple(asdict(quantity) for quantity in ledger.vocabulary.values()),
        tuple(
            tuple(map(step, entry.steps)) if isinstance(entry, Derivation) else equation(entry)
            for entry in ledger.entries
        ),
    )


def _words(equation: Equation) -> dict[str, str]:
    return {name: getattr(equation, name) for name in _WORDS}


# --- the same again --------------------------------------------------------------------------------------


class _Known:
    """Columns of what was told.

    `declared`: returns the columns that it was told of, by name. `axes`: those that are there already.
    """

    def __init__(
        self, told: _ToldSheet, declared: Callable[[], Mapping[str, Column]], axes: Iterable[Axis] = ()
    ) -> None:
        self.told, self.declared = told, declared
        self.axes = {axis.name: axis for axis in axes}

    def columns(self) -> tuple[Column, ...]:
        for told in self.told.axes:
            self.axes[told.words["name"]] = self.axis(told)
        by_name = {told.name: told for told in self.told.columns}
        return tuple(self.column(told, by_name) for told in self.told.columns)

    def axis(self, told: _ToldAxis) -> Axis:
        def whole() -> Axis:
            every = with_parents(column.axis for column in self.declared().values())
            return next(axis for axis in every if axis.name == told.words["name"])

        words = {name: tuple(own) if isinstance(own, list) else own for name, own in told.words.items()}
        alone = partly(Axis, {**words, "content": told.alone}, lambda: whole().alone)
        parent = {"of": self.axes[told.of]} if told.of else {}
        return partly(_KINDS[told.kind], {**words, **parent, "alone": alone}, whole)

    def column(self, told: _ToldColumn, by_name: Mapping[str, _ToldColumn]) -> Column:
        def whole() -> Column:
            return self.declared()[told.name]

        limits = tuple(self.limit(each, n, whole) for n, each in enumerate(told.limits))
        known = {**told.same, "name": told.name, "conditions": told.conditions}
        known |= {"axis": self.axes[told.axis] if told.axis else None, "limits": limits}
        known |= {"content": told.mentioned.content, "rule": self.rule(told, whole)}
        known |= {"mentioned": told.mentioned, "placed": told.placed}
        known |= {"alongside": tuple(self.column(by_name[name], by_name) for name in told.alongside)}
        if not told.conditions:
            known["requires"] = ()
        return partly(Column, known, whole)

    def rule(self, told: _ToldColumn, whole: Callable[[], Column]) -> Rule:
        if told.given is not None:
            return Given(told.given["source"], Bounds(**told.given["bounds"]), told.given["u_of"])
        equations = {
            name: _known_equation(own, lambda name=name: getattr(whole().rule, name))  # type: ignore[misc]
            for name, own in zip(("equation", "form"), told.equations, strict=False)
        }
        said = told.root or (() if told.iterated is None else (told.iterated,))
        more = zip(("none", "two", "unknown_name", "by_proof"), said, strict=False)
        kind: Any = Root if told.root else Formula if told.iterated is None else Iterated
        rule: Rule = partly(kind, {**equations, **dict(more)}, lambda: whole().rule)
        return rule

    def limit(self, told: _ToldLimit, place: int, whole: Callable[[], Column]) -> Limit:
        known: dict[str, Any] = {"says": told.says, "source": told.source, "silent": told.silent}
        if told.inside is not None:
            known["inside"] = Bounds(**told.inside)
        return partly(Limit, {**known, "mentioned": told.mentioned}, lambda: whole().limits[place])


def _known_equation(told: _ToldEquation, whole: Callable[[], Equation]) -> Equation:
    """The equation of what was told.

    `whole`: returns the equation that it was told of.
    """
    parent = None if told.origin is None else _known_equation(told.origin, lambda: whole().origin)
    known = {**told.words, "kind": Kind(told.kind), "parent": parent, "written": told.written}
    return partly(Equation, known, whole)


def _known_ledger(told: _ToldLedger, declared: Callable[[], Ledger]) -> Ledger:
    """The ledger of what was told; parameters as for :func:`_known_equation`."""
    declared = cache(declared)
    entries = tuple(_entry(own, declared, n) for n, own in enumerate(told.entries))
    words = ({**own, "span": tuple(own["span"])} for own in told.vocabulary)
    vocabulary = Vocabulary(*(Quantity(**own) for own in words))
    return partly(Ledger, {"entries": entries, "vocabulary": vocabulary}, declared)


def _entry(
    told: _ToldEquation | tuple[_ToldStep, ...], declared: Callable[[], Ledger], place: int
) -> Equation | Derivation:
    def whole() -> Any:
        return declared().entries[place]

    if isinstance(told, _ToldEquation):
        return _known_equation(told, whole)
    steps = tuple(_step(own, lambda n=n: whole().steps[n]) for n, own in enumerate(told))  # type: ignore[misc]
    return partly(Derivation, {"steps": steps}, whole)


def _step(told: _ToldStep, whole: Callable[[], Step]) -> Step:
    premises = tuple(
        _known_equation(own, lambda n=n: whole().premises[n])  # type: ignore[misc]
        for n, own in enumerate(told.premises)
    )
    claim = _known_equation(told.claim, lambda: whole().claim)
    return partly(Step, {"claim": claim, "premises": premises, "says": told.says, "gone": told.gone}, whole)
