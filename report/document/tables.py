"""The tables of a report: what stands in them and above and below them, the same in every format."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import groupby, islice
from typing import Any, NamedTuple

from ...derivations.proved import enumerated
from ...derivations.unit_text import is_pure
from ..cells.address import index_text
from ..inputs.measurements import LeftOut, Measurements
from ..inputs.published import PublishedValue
from ..messages.errors import listing, sentence_case
from ..quantity import span
from ..result import verdict_words as words
from ..result.chi_square import asked_of_chance, freedom, number, tail
from ..result.conformity import accepted, conforming, risk
from ..result.numbers import Numeral, decimals, probability, read, rounded, table_format
from ..result.result import Comparison
from ..result.shares import SEEN, foremost
from ..result.statements import of_column
from ..result.uncertain import Budget, Conformity, Contribution, Decision, draws_of
from ..result.verdict import ALL, INPUT, UNREACHABLE, TableVerdict
from ..sheet import Axis, GroupAxis
from ..workbook import SquareSum, TableSpec
from .material import Material
from .parts import MOST, Head, Pair, SourceGroup, described, slug, why_address
from .refereed import GOOD, RefereedPair, shown_mismatch
from .tree import (
    Bar,
    Code,
    Entry,
    Hint,
    Inlines,
    Math,
    Node,
    Number,
    Refer,
    Row,
    Rows,
    Silent,
    Strong,
    Table,
    TableColumn,
    Unit,
    in_unit,
    joined,
)

MOST_SOURCES, LEAST_SHARE = 3, 0.05
"""The sources of an uncertainty that are named, and the least share of the variance of one."""
MOST_BARS = 12
"""The sources whose shares are drawn; those of no whole percent are none of them."""
MOST_LETTERS = 24
"""What stands beside a row in words, and is longer, is broken into lines."""
OFF_BY = "recomputed minus published, in units of the last published digit"


class _Made(NamedTuple):
    """A column and what it says of a row: text, a node, a run of inlines, a cell of the sheet, or nothing."""

    head: str
    cell: Callable[[Any], Any]
    kind: str = "left"
    """As of :class:`TableColumn`; of a column ``aligned`` the numbers stand below one another."""
    share: float = 0
    tip: str = ""


def _table(
    name: str,
    caption: Inlines,
    made: Sequence[_Made],
    groups: Iterable[tuple[Inlines, Iterable[Any]]],
    row: Callable[[Any], Mapping[str, str]] = lambda _: {},
    **more: Any,
) -> Table:
    """A table from its columns and what its rows are made of; `row` tells of one what a Row has besides."""
    listed = tuple(
        Rows(tuple(Row(tuple(_run(one.cell(each)) for one in made), **row(each)) for each in group), title)
        for title, group in groups
    )
    rows = [row.cells for group in listed for row in group.rows]
    columns = tuple(_column(one, [cells[n] for cells in rows]) for n, one in enumerate(made))
    return Table(name, caption, columns, listed, **more)


def _whole(told: str) -> str:
    """A percentage that stays on its line."""
    return told.replace(" %", "\u00a0%")


def _run(said: Any) -> Any:
    if said is None or said == "":
        return ()
    return (said,) if isinstance(said, (str, Node)) else said


def _column(made: _Made, cells: Iterable[Any]) -> TableColumn:
    head, kind = (made.head,), made.kind
    if kind != "aligned":
        return TableColumn(head, kind, share=made.share, tip=made.tip)
    numbers = [one for cell in cells for one in cell if isinstance(one, Number)]
    form = table_format(one.figure for one in numbers)
    signed = any(one.signed for one in numbers) and form[0] != "-"
    return TableColumn(head, "number", f"-{form}" if signed else form, tip=made.tip)


class Tables:
    """Makes the tables of a report."""

    def __init__(self, material: Material) -> None:
        self.material, self.report = material, material.report
        self.rich, self.sentence = material.sentences.rich, material.sentences.sentence

    # --- the sheet

    @cached_property
    def data(self) -> Mapping[str, Table]:
        """The workbook's tables by their names; without any, one for the scalars and one for each axis."""
        return {
            spec.name: self._words(spec) if spec.words else self._cells(spec) for spec in self.material.specs
        }

    def _cells(self, spec: TableSpec) -> Table:
        axis = self.report.sheet[spec.columns[0]].axis
        return self._scalars(spec) if axis is None else self._rows(spec, axis)

    def _words(self, spec: TableSpec) -> Table:
        heads, *rows = spec.words
        longest = [max(len(row[n]) for row in spec.words) for n in range(len(heads))]
        shares = [round(length / sum(longest), 2) for length in longest]
        made = [
            _Made(head, lambda row, n=n: row[n], "words", share)  # type: ignore[misc]
            for n, (head, share) in enumerate(zip(heads, shares, strict=True))
        ]
        title = self.rich(spec.title)
        return _table(spec.name, title, made, [((), rows)], number=spec.number, look="list", wide=True)

    def squares(self) -> Table:
        """How likely each sum of squares of the workbook is, if chance alone made it."""

        def likely(each: SquareSum) -> Inlines:
            known = asked_of_chance(each, self.report)
            return self.rich(probability(tail(*known))) if known else ()

        def head(each: SquareSum) -> Head:
            return self.material.head(self.report.sheet[each.name])

        made = (
            _Made("sum of squares", lambda each: self._meaning(head(each)), "words", 0.3),
            _Made("symbol", lambda each: Math(head(each).latex), "symbol"),
            _Made("value", lambda each: self.material.item(each.name), "number"),
            _Made("squares", lambda each: str(number(each, self.report)), "number"),
            _Made("taken", lambda each: str(each.fitted), "number", tip="numbers that were taken from them"),
            _Made("freedom", lambda each: str(freedom(each, self.report)), "number", tip="its degrees"),
            _Made("probability", likely, "number", tip="of a sum that is as large, or larger"),
        )
        title = "Sums of squares, and how likely chance alone makes them so large"
        there = [each for each in self.report.workbook.squares if each.name in self.report.sheet]
        return _table("chances", self.rich(title), made, [((), there)], look="list", wide=True)

    def _scalars(self, spec: TableSpec) -> Table:
        over, told = spec.beside[0], dict(spec.beside[1])
        made = (
            _Made("quantity", lambda item: self._meaning(item.head), "words", 0.42),
            _Made("symbol", lambda item: Math(item.head.latex), "symbol"),
            _Made("value", lambda item: item, "number"),
            _Made("unit", lambda item: _unit(item.head.unit), "unitcell"),
            _Made("from", lambda item: _refers(item.head, ", ") or "given", "words"),
            *([_Made(over, lambda item: told[item.head.name], "words", 0.3)] if told else []),
        )
        items = [self.material.item(name) for name in spec.columns]
        heads = [item.head for item in items]
        legend, limits = (*self.rich(spec.note), *self._known(heads)), self._limits(heads)
        more: dict[str, Any] = {"number": spec.number, "look": "list", "legend": legend, "limits": limits}
        return _table(spec.name, self.rich(spec.title), made, [((), items)], wide=bool(told), **more)

    def _meaning(self, head: Head) -> Inlines:
        return (head.name,) if head.meaning == head.name else self.rich(head.meaning)

    def _rows(self, spec: TableSpec, axis: Axis) -> Table:
        heads, columns = zip(*map(self.material.items, spec.columns), strict=True)
        labels = self.report.values.labels(self.report.sheet[spec.columns[0]])
        most = len(labels) if axis.is_given else MOST  # what was measured is shown whole
        rows = islice(zip(labels, *columns, strict=True), most)
        inputs, measured = self.report.inputs, any(head.given for head in heads) and axis.is_given
        table = inputs.on(axis.name) if axis.is_given else Measurements((), {}, {})
        words, names = table.remarks if measured else table.naming, table.rows
        head = "no." if axis.row in words else axis.row
        if isinstance(axis, GroupAxis):
            words, head = (axis.row,), "no."
            of = inputs.on(axis.members.of.name)
            names = {n: {axis.row: word} for n, word in enumerate(of.words(axis.row), start=1)}

        def row(label: tuple[int, ...], items: Iterable[Entry], state: str = "") -> Row:
            told = (_run(names[label[0]][name]) for name in words)
            return Row(((_dashed(label),), *told, *items), state)

        shown = [row(label, items) for label, *items in rows]
        if measured:
            for each in table.left_out:
                shown.insert(each.place, row((each.test,), _left_out(each, heads), "excluded"))
        legend = joined((self._legend(head) for head in heads), "; ")
        cut = f"The first {most} {axis.name} are shown; values.json has all of them."
        return Table(
            spec.name,
            self.rich(spec.title),
            (TableColumn((head,)), *(_worded(each, names) for each in words), *map(_headed, heads)),
            (Rows(tuple(shown)),),
            spec.number,
            legend=(*legend, ".", *((" ", *self.rich(spec.note)) if spec.note else ()), *self._known(heads)),
            limits=self._limits(heads),
            cut=cut if len(labels) > most else "",
            wide=len(words) + len(heads) > 5,
        )

    def _legend(self, head: Head) -> Inlines:
        sources = ", given" if head.given else ", from " if head.sources else ""
        return (Math(head.latex), "\u00a0", *self.rich(head.meaning), sources, *_refers(head, ", solved as "))

    def _known(self, heads: Iterable[Head]) -> Inlines:
        """What is stated of the errors of given columns."""
        told = [
            (Math(head.latex), "\u00a0", *self.material.sentences.units(said))
            for head in heads
            if head.given and (said := of_column(self.report, head.name))
        ]
        return (" Stated uncertainties: ", *joined(told, "; "), ".") if told else ()

    def _limits(self, heads: Iterable[Head]) -> Inlines:
        told = self.material.limits(heads)
        return (*joined(map(self.rich, told), "; or "), ".") if told else ()

    # --- what is known of the uncertainty

    def uncertain(self) -> Table:
        """The results with their uncertainties, and the sources that most of it comes from."""
        made = (
            _Made("result", lambda budget: Code(budget.cell), "words"),
            _Made("value", lambda budget: Number(self._stated(budget)[0])),
            _Made("u", lambda budget: Number(self._stated(budget)[1])),
            _Made("k", self._factor),
            _Made("U", self._expanded),
            _Made("unit", lambda budget: Unit(self._of(budget).unit)),
            _Made("most of it from", self._largest, "words", 0.24),
        )
        level = f"{100 * self.material.budgets[0].level:.12g}\u00a0%"
        caption = (Strong(("Uncertainty of the results.",)), f" U is the expanded one, for {level}")
        every = self.material.budgets
        legend = self._doubted(every)
        return _table("uncertain", caption, made, [((), every)], look="list", wide=True, legend=legend)

    @staticmethod
    def _doubted(budgets: Iterable[Budget]) -> Inlines:
        """Of which results U may not hold, and why."""
        doubts: dict[str, list[Inlines]] = {}
        for each in budgets:
            if each.doubt:
                doubts.setdefault(each.doubt, []).append((Code(each.cell),))
        told = [(f"{doubt} (", *joined(cells, ", ", " and "), "). ") for doubt, cells in doubts.items()]
        return (*joined(told, ""), Code(draws_of("CELL")), " tells the interval.") if told else ()

    def budget(self) -> tuple[Table, ...]:
        """Where the uncertainty of the first result comes from, source by source; nothing if none is seen.

        Beside terms of second order, those of first order may all be next to nothing.
        """
        if not self.material.budgets:
            return ()
        budget, most = self.material.budgets[0], foremost(self.report, self.material.budgets[0])
        seen = [each for each in budget.contributions if abs(each.share) >= SEEN][:MOST_BARS]
        if not seen:
            return ()
        made = (
            _Made("source", lambda each: Code(each.source.name), "words"),
            _Made("u", self._of_source),
            _Made("share of the variance", self._share, "words"),
        )
        caption = Strong(("Where that comes from:",)), " ", Code(budget.cell)
        shown, many = f"{len(seen)} " * (len(seen) > 1), len(budget.contributions)
        legend = f"The largest {shown}of {many} sources." if many > 1 else "The only source."
        legend += f" {sentence_case(most[0])} matters most: {_percent(most[1])}." if most else ""
        return (_table("budget", caption, made, [((), seen)], look="list", legend=(legend,)),)

    def _share(self, each: Contribution) -> Inlines:
        return Bar(each.share), f" {_percent(each.share)}"

    def _of_source(self, each: Contribution) -> Inlines:
        if each.source.u is None:
            return ()
        name = each.source.moves[0][0]
        return Number(self.report.sure(name, each.source.u)), *in_unit(self.report.shown[name].unit)

    def conformity(self) -> Table:
        """The cells that have limits, and what the decision rule says of each."""

        def row(found: Conformity) -> dict[str, str]:
            sure = found.decision is Decision.CONFORMS and not found.improbable
            return {"state": "" if sure else "unexpected"}

        every = self.report.uncertain().conformities
        rules = [found.limits.guard for found in every]
        guarded = any(rule.draws_in for rule in rules)
        made = (
            _Made("result", lambda found: Code(found.budget.cell), "words"),
            _Made("limits", self._tolerance, "words", 0.16),
            *([_Made("guard band", self._guard, "words")] * guarded),
            *([_Made("acceptance limits", self._accepted, "words", 0.16)] * guarded),
            _Made("decision", lambda found: str(found.decision), "words"),
            _Made("conformance probability", lambda found: _whole(conforming(found)), "words", 0.12),
            _Made("specific risk", lambda found: _whole(risk(found)), "words", 0.14),
        )
        drawn = "acceptance limits are the limits, drawn in by the guard band"
        told = drawn if guarded else "simple acceptance, without a guard band"
        levels = dict.fromkeys(f"{100 * rule.level:.12g}" for rule in rules if rule.times)
        bands = [f"a share of U for {enumerated(levels)}\u00a0%"] if levels else []
        bands += ["a fixed width"] * any(rule.width for rule in rules)
        bands += ["none"] * any(not rule.draws_in for rule in rules)
        of_each = f", which is {listing(bands, last='or')}, as the table says"
        told += of_each if len(bands) > 1 else f", {bands[0]}" if guarded else ""
        caption = (Strong(("Conformity with limits.",)), f" Decision rule (JCGM 106): {told}")
        return _table("conformity", caption, made, [((), every)], row, look="list", wide=True)

    def _tolerance(self, found: Conformity) -> Inlines:
        low, high = ("" if end is None else end.text for end in (found.limits.low, found.limits.high))
        units = {end.unit for end in (found.limits.low, found.limits.high) if end is not None}
        return (str(found.limits),) if len(units) > 1 else (span(low, high), *in_unit(units.pop()))

    def _accepted(self, found: Conformity) -> Inlines:
        if math.isnan(found.guard):
            return ("not known",)
        if not found.guard:
            return self._tolerance(found)
        within = accepted(self.report, found)
        return (within, *in_unit(self._of(found.budget).unit)) if within else ("none",)

    def _guard(self, found: Conformity) -> Inlines:
        if not found.guard > 0:
            return ("not known",) if math.isnan(found.guard) else ("none",)
        return Number(self.report.sure(found.budget.name, found.guard)), *in_unit(self._of(found.budget).unit)

    def published_u(self) -> Table:
        """What is published of uncertainties, beside what is computed."""

        def told(one: Comparison) -> Inlines | str:
            known = one.as_expected and one.published.reason
            return self.rich(one.published.reason) if known else one.word

        def row(one: Comparison) -> dict[str, str]:
            return {"state": "" if one.as_expected else "unexpected"}

        made = (
            _Made("in", lambda one: one.published.source, "words"),
            _Made("of", lambda one: Code(one.cell.address), "words"),
            _Made("published", lambda one: _as_is(one.published.printed.text), "aligned"),
            _Made("computed", lambda one: _as_is(one.again), "aligned"),
            _Made("unit", lambda one: Unit(one.published.printed.unit)),
            _Made("verdict", told, "words", 0.3),
        )
        caption = (Strong(("Published uncertainties,",)), " each beside what is computed")
        every = self.report.comparisons_u
        return _table("published-uncertainties", caption, made, [((), every)], row, look="list", wide=True)

    def _of(self, budget: Budget) -> Head:
        return self.material.head(self.report.sheet[budget.name])

    def _stated(self, budget: Budget) -> tuple[Numeral, Numeral]:
        return self.report.stated(budget.name, budget.value, budget.u)

    def _expanded(self, budget: Budget) -> Number | None:
        if math.isnan(budget.factor):
            return None
        return Number(self.report.stated(budget.name, budget.value, budget.expanded)[1])

    def _factor(self, budget: Budget) -> Number | None:
        return None if math.isnan(budget.factor) else Number(rounded(budget.factor, 3))

    def _largest(self, budget: Budget) -> Inlines:
        """The sources with the largest shares of the variance."""
        every = [(own, sum(each.share for each in own)) for own in budget.estimates]
        told = [self._source(own, share) for own, share in every[:MOST_SOURCES] if share >= LEAST_SHARE]
        if budget.second:
            told.append((f"second order\u00a0{_percent(budget.second / budget.u**2)}",))
        return joined(told, ", ")

    def _source(self, own: Sequence[Contribution], share: float) -> Inlines:
        """A source; of readings that are one estimate all together, those of several columns if paired."""
        first, moved = own[0].source, [each.source.moves[0] for each in own]
        axis = self.report.sheet[first.moves[0][0]].axis
        if len(own) == 1 or axis is None:
            return Code(first.name), f"\u00a0{_percent(share)}"
        named = joined([(Code(name),) for name in dict.fromkeys(name for name, *_ in moved)], ", ")
        rows = {row for _, row, _ in moved}
        return *named, f" ({len(rows)}\u00a0{axis.name})\u00a0{_percent(share)}"

    # --- what is published

    def published(self, group: SourceGroup) -> Table:
        """The published values of one place of the source, beside those that are recomputed."""
        made = (
            _Made("value", lambda pair: pair.index or _symbol(pair.head)),
            _Made("of", lambda pair: Math(pair.head.latex) if pair.index else ()),
            _Made("published", _printed, "aligned"),
            _Made("recomputed", lambda pair: Number(pair.again, pair.comparison.again), "aligned"),
            _Made("unit", lambda pair: "–" if is_pure(pair.printed.unit) else Unit(pair.printed.unit)),
            _Made("off by", lambda pair: _number(pair.distance, signed=True), "aligned", tip=OFF_BY),
            _Made("finding", lambda pair: pair.finding, "verdict"),
            _Made("known reason", lambda pair: pair.comparison.published.reason, share=0.34),
        )
        title = (", ", *self.rich(group.title)) if group.title else ()
        caption = (Strong((group.source,)), *title, ": published beside recomputed")
        name = f"published-{slug(group.source)}"

        def row(pair: Any) -> dict[str, str]:
            return {"state": "" if pair.comparison.as_expected else "unexpected"}

        return _table(name, caption, made, [((), group.pairs)], row, look="compared", wide=True)

    def together(self) -> Table:
        """What the referee says of all values of a table, and of all tables."""
        least = "what no input that prints as given can fall below"
        made = (
            _Made("source", _source, share=0.3),
            _Made("values", lambda table: str(table.values), "number"),
            _Made("verdict", lambda table: words.CALLED[table.verdict], "verdict"),
            _Made("mismatch", lambda table: _number(shown_mismatch(table.mismatch)), "number"),
            _Made("at least", lambda table: _number(_least(table)), "number", tip=least),
            _Made("presses most", self._worst),
        )
        said = "asked for together: the worst mismatch for the best input that was found"
        caption = (Strong(("All values of a table",)), f", {said}")
        return _table("refereed-tables", caption, made, [((), self._tables())], _refused)

    def _tables(self) -> tuple[TableVerdict, ...]:
        """Each table, and all of them together if there are several."""
        found = self.report.referee
        return (*found.tables, found.joint) if found.joint and len(found.tables) > 1 else found.tables

    def _worst(self, table: TableVerdict) -> Inlines:
        if table.worst is None or table.verdict in GOOD:
            return ()
        symbol = self.material.sentences.symbol(table.worst.cell)
        return (symbol, f"\u00a0{_dashed(table.worst.index)}") if table.worst.index else (symbol,)

    def refereed(self) -> Table:
        """What the referee says of every value by itself."""
        tip = "the least that was found, in half units of the last published digit"
        made = (
            _Made("value", lambda value: value.pair.index or _symbol(value.pair.head)),
            _Made(
                "published", lambda value: Number(value.pair.published, value.pair.printed.text), "aligned"
            ),
            _Made("recomputed", lambda value: _number(value.here, value.pair.comparison.again), "aligned"),
            _Made("off by", lambda value: _number(value.pair.distance, signed=True), "aligned", tip=OFF_BY),
            _Made("least", lambda value: _number(value.low), "aligned"),
            _Made("largest", lambda value: _number(value.high), "aligned"),
            _Made("mismatch", lambda value: _number(shown_mismatch(value.mismatch)), "aligned", tip=tip),
            _Made("verdict", lambda value: words.CALLED[value.verdict], "verdict"),
        )
        said = " Least and largest were seen from inputs that print as given"
        caption = (Strong(("Every published value by itself.",)), said)
        runs = groupby(self.material.refereed, lambda value: value.run)
        groups = [(self._run(*run), list(values)) for run, values in runs]
        return _table("refereed-values", caption, made, groups, _refused, wide=True)

    def _run(self, source: str, head: Head, unit: str) -> Inlines:
        behind = () if is_pure(unit) else (", in ", Unit(unit))
        return (Strong((source,)), ", ", Math(head.latex), " ", *self.rich(head.meaning), *behind)

    # --- what is known

    def ledger(self) -> Table:
        """Every equation and what is known of it."""
        made = (
            _Made("number", lambda equation: Refer(equation.label)),
            _Made("claim", lambda equation: self.rich(equation.title), share=0.5),
            _Made("status", self.material.status, share=0.3),
        )
        said = " Every equation, and what is known of it; why it holds is said at its number"
        caption, rows = (Strong(("Ledger.",)), said), [((), self.material.equations)]
        return _table("ledger", caption, made, rows, look="list", wide=True, whole=True)

    def errata(self) -> Table:
        """What the checks of the equations found, then what the referee found in the data."""
        made = (
            _Made("about", lambda one: one[0], share=0.13),
            _Made("kind", lambda one: one[1], share=0.13),
            _Made("finding", lambda one: self._told(one[2]), share=0.37),
            _Made("evidence", lambda one: self._told(one[3]), share=0.29),
        )
        caption = (Strong(("Ledger of errata",)), ", of equations and data alike")
        rows = [((), self._errata())]
        return _table("errata-ledger", caption, made, rows, look="list", wide=True, whole=True)

    def _told(self, sentence: str) -> Inlines:
        return (*self.sentence(sentence), ".") if sentence else ()

    def _errata(self) -> Iterator[tuple[Inlines, str, str, str]]:
        """What each is about, its kind, the finding and the evidence."""
        found = self.report.referee
        for erratum in self.report.errata:
            yield self.rich(erratum.about), erratum.kind, erratum.sentence, erratum.evidence
        for label in found.labels:
            finding = f"named after {label.printed}, but comes out of {label.right}"
            yield self._place(label.source, label.cell), "label", finding, words.because(label)
        for table in self._tables():
            if table.verdict == UNREACHABLE:
                yield (_source(table),), "contradiction", words.contradiction(table), words.evidence(table)
        for value in self.material.refereed:
            if value.verdict == UNREACHABLE:
                printed: PublishedValue = value.pair.comparison.published
                ends = words.bounds(value.found, printed.printed)
                finding = f"{printed.printed.text} cannot come out of inputs that print as given"
                about = self._place(printed.source, printed.cell, printed.index)
                yield about, "unreachable", finding, words.certain(ends) if ends else ""
        for each in found.explanations:
            if not each.as_printed:  # then something that is printed needs to be otherwise
                source = "" if each.first.source == INPUT else each.first.source
                about = self._place(source, each.first.cell, each.first.index)
                yield about, words.POSSIBLE[each.first.kind], words.suggested(each), words.follows(each)

    def _place(self, source: str, cell: str, index: tuple[int, ...] = ()) -> Inlines:
        """A place in the data: ``Table 2, alpha 1-2``."""
        if not cell:
            return (source,)
        symbol = _symbol(self.material.head(self.report.sheet[cell]))
        return *((source, ", ") if source else ()), symbol, *((f"\u00a0{_dashed(index)}",) if index else ())

    def missing(self) -> Table:
        """The cells without a value, and those outside of what is expected."""
        made = (
            _Made("cell", lambda one: _symbol(self.material.head(self.report.sheet[one.cell.name]))),
            _Made("index", lambda one: _dashed(one.cell.label), "row"),
            _Made("code", lambda one: Code(one.code), "words"),
            _Made("why", lambda one: self.rich(one.why), "words", share=0.6),
        )
        said = (
            " What is computed from one without a value has none either; a † is outside of what is expected"
        )
        caption, rows = (Strong(("Cells to look at.",)), said), [((), self.material.remarks)]

        def row(one: Any) -> dict[str, str]:
            return {"identifier": why_address(one.cell) if one.cell.why else ""}

        return _table("missing-cells", caption, made, rows, row, look="list", cut=self.material.cut_remarks)


def _percent(share: float) -> str:
    return f"{decimals(100 * share, 0).text}\u00a0%"


def _worded(name: str, rows: Mapping[int, Mapping[str, str]]) -> TableColumn:
    """A column of words beside the rows: names stay on their line, sentences are broken."""
    if max(map(len, (name, *(row[name] for row in rows.values())))) <= MOST_LETTERS:
        return TableColumn((name,), "row")
    return TableColumn((name,), "words", share=0.2)


def _headed(head: Head) -> TableColumn:
    """A column of the sheet."""
    return TableColumn((_symbol(head),), "number", head.format, unit=(_unit(head.unit),))


def _left_out(test: LeftOut, heads: Iterable[Head]) -> Iterator[Silent]:
    """What was printed of a test that takes no part."""
    label = (test.test,)
    for head in heads:
        told = described(head, label) if head.given else ""
        yield Silent(head.name, label, test.texts.get(head.name, ""), told)


def _refused(found: TableVerdict | RefereedPair) -> dict[str, str]:
    return {"state": "" if found.verdict in GOOD else "unexpected"}


def _source(table: TableVerdict) -> str:
    return "all together" if table.source == ALL else table.source


def _least(table: TableVerdict) -> Any:
    return None if table.at_least is None else read(words.at_least(table.at_least))


def _symbol(head: Head) -> Hint:
    return Hint((Math(head.latex),), head.meaning)


def _dashed(label: tuple[int, ...]) -> str:
    """The label of a row for the eye."""
    return index_text(label).replace("-", "–")


def _printed(pair: Pair) -> Number:
    return Number(pair.published, pair.printed.text)


def _number(figure: Any, otherwise: str = "", signed: bool = False) -> Number | str:
    return otherwise if figure is None else Number(figure, signed=signed)


def _as_is(text: str) -> Number:
    return Number(read(text), text)


def _unit(unit: str) -> Hint | Unit:
    return Hint(("–",), "a pure number") if is_pure(unit) else Unit(unit)


def _refers(head: Head, between: str) -> Inlines:
    return joined(((Refer(label),) for label in head.sources), between)
