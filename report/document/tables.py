"""The tables of a report: what stands in them and above and below them, the same in every format."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from itertools import islice

from ..measurements import LeftOut
from ..sheet import Axis
from ..workbook import TableSpec
from .material import Material
from .numbers import Figure, is_pure, table_format
from .parts import MOST, Group, Head, Pair, Remark, described, index_text, slug, why_address
from .refereed import Finding, Run, Together, Value
from .tree import (
    Code,
    Column,
    Hint,
    Inlines,
    Math,
    Number,
    Refer,
    Row,
    Rows,
    Silent,
    Strong,
    Table,
    Unit,
    joined,
)

__all__ = ["Tables"]

OFF_BY = "recomputed minus published, in units of the last published digit"


class Tables:
    """Makes the tables of a report.

    Parameters
    ----------
    material : Material
    """

    def __init__(self, material: Material) -> None:
        self.material, self.report = material, material.report
        self.rich = material.sentences.rich

    # --- the sheet

    @cached_property
    def data(self) -> Mapping[str, Table]:
        """The workbook's tables by their names; without any, one for the scalars and one for each axis."""
        return {
            spec.name: self._scalars(spec) if axis is None else self._rows(spec, axis)
            for spec in self.material.specs
            for axis in [self.report.sheet[spec.columns[0]].axis]
        }

    def _scalars(self, spec: TableSpec) -> Table:
        items = [self.material.item(name) for name in spec.columns]
        columns = (
            Column(("quantity",), "words", share=0.42),
            Column(("symbol",), "symbol"),
            Column(("value",), "number"),
            Column(("unit",), "unitcell"),
            Column(("from",), "words"),
        )
        rows = tuple(
            Row((*self._named(item.head), item, _unit(item.head.unit), _from(item.head))) for item in items
        )
        return Table(
            spec.name,
            self.rich(spec.title),
            columns,
            (Rows(rows),),
            spec.number,
            "list",
            legend=self.rich(spec.note),
            limits=self._limits(item.head for item in items),
        )

    def _named(self, head: Head) -> tuple[Inlines, Inlines]:
        return (head.name,) if head.meaning == head.name else self.rich(head.meaning), (Math(head.latex),)

    def _rows(self, spec: TableSpec, axis: Axis) -> Table:
        heads, columns = zip(*map(self.material.items, spec.columns), strict=True)
        labels = self.report.values.labels(self.report.sheet[spec.columns[0]])
        most = MOST if axis.parents else len(labels)  # what was measured is shown whole
        rows = list(islice(zip(labels, *columns, strict=True), most))
        shown = [Row(((_dashed(label),), *items)) for label, *items in rows]
        if not axis.parents and any(head.given for head in heads):
            for each in self.report.inputs.left_out:
                shown.insert(each.place, _left_out(each, heads))
        cut = ""
        if len(labels) > most:
            cut = f"The first {most} {axis.name} are shown; values.json has all of them."
        told = joined((self._legend(head) for head in heads), "; ")
        note = (" ", *self.rich(spec.note)) if spec.note else ()
        return Table(
            spec.name,
            self.rich(spec.title),
            (Column((axis.row,)), *map(_headed, heads)),
            (Rows(tuple(shown)),),
            spec.number,
            legend=(*told, ".", *note),
            limits=self._limits(heads),
            cut=cut,
            wide=len(heads) > 5,
        )

    def _legend(self, head: Head) -> Inlines:
        sources = ", given" if head.given else ", from " if head.sources else ""
        refers = joined(((Refer(label),) for label in head.sources), ", solved as ")
        return (Math(head.latex), "\u00a0", *self.rich(head.meaning), sources, *refers)

    def _limits(self, heads: Iterable[Head]) -> Inlines:
        told = self.material.limits(heads)
        return (*joined(map(self.rich, told), "; "), ".") if told else ()

    # --- what is published

    def published(self, group: Group) -> Table:
        """The published values of one place of the source, beside those that are recomputed."""
        title = (", ", *self.rich(group.title)) if group.title else ()
        pairs = group.pairs
        return Table(
            f"published-{slug(group.source)}",
            (Strong((group.source,)), *title, ": published beside recomputed"),
            (
                Column(("cell",)),
                Column(("index",)),
                _numbers("published", (pair.published for pair in pairs)),
                _numbers("recomputed", (pair.again for pair in pairs)),
                Column(("unit",)),
                _numbers("off by", (pair.distance for pair in pairs), OFF_BY, signed=True),
                Column(("finding",), "verdict"),
                Column(("known reason",), share=0.34),
            ),
            (Rows(tuple(map(self._published, pairs))),),
            look="compared",
            wide=True,
        )

    def _published(self, pair: Pair) -> Row:
        comparison = pair.comparison
        finding = f", {comparison.finding}" if comparison.finding else ""
        cells: tuple[Inlines, ...] = (
            _symbol(pair.head),
            (pair.index,),
            (Number(pair.published, pair.printed.text),),
            (Number(pair.again, comparison.again),),
            _unit(pair.printed.unit),
            _off(pair),
            (pair.verdict + finding,),
            _text(comparison.published.reason),
        )
        return Row(cells, "" if comparison.as_expected else "unexpected")

    def together(self) -> Table:
        """What the referee says of all values of a table, and of all tables."""
        columns = (
            Column(("source",), share=0.3),
            Column(("values",), "number"),
            Column(("verdict",), "verdict"),
            Column(("mismatch",), "number"),
            Column(("at least",), "number", tip="what no input that prints as given can fall below"),
            Column(("presses most",)),
        )
        said = "asked for together: the worst mismatch for the best input that was found"
        caption = (Strong(("All values of a table",)), f", {said}")
        rows = tuple(map(self._together, self.material.refereed.tables))
        return Table("refereed-tables", caption, columns, (Rows(rows),))

    @staticmethod
    def _together(one: Together) -> Row:
        worst: Inlines = ()
        if one.worst is not None:
            worst = (Math(one.worst.head.latex), f"\u00a0{one.worst.index}" if one.worst.index else "")
        cells = (
            (one.name,),
            (str(one.table.values),),
            (one.called,),
            _number(one.mismatch),
            _number(one.at_least),
            worst,
        )
        return Row(cells, "" if one.good else "unexpected")

    def refereed(self) -> Table:
        """What the referee says of every value by itself."""
        values = self.material.refereed.values
        pairs = [value.pair for value in values]
        tip = "the least that was found, in half units of the last published digit"
        columns = (
            Column(("value",)),
            _numbers("published", (pair.published for pair in pairs)),
            _numbers("recomputed", (value.here for value in values)),
            _numbers("off by", (pair.distance for pair in pairs), OFF_BY, signed=True),
            _numbers("least", (value.low for value in values)),
            _numbers("largest", (value.high for value in values)),
            _numbers("mismatch", (value.mismatch for value in values), tip),
            Column(("verdict",), "verdict"),
        )
        said = " Least and largest were seen from inputs that print as given"
        caption = (Strong(("Every published value by itself.",)), said)
        groups = tuple(map(self._run, self.material.refereed.runs))
        return Table("refereed-values", caption, columns, groups, wide=True)

    def _run(self, run: Run) -> Rows:
        unit = () if is_pure(run.unit) else (", in ", Unit(run.unit))
        title = (Strong((run.source,)), ", ", Math(run.head.latex), " ", *self.rich(run.head.meaning), *unit)
        return Rows(tuple(self._refereed(run, value) for value in run.values), title)

    @staticmethod
    def _refereed(run: Run, value: Value) -> Row:
        pair = value.pair
        cells = (
            (pair.index,) if pair.index else _symbol(run.head),
            (Number(pair.published, pair.printed.text),),
            (Number(value.here, "" if value.here else pair.comparison.again),),
            _off(pair),
            _number(value.low),
            _number(value.high),
            _number(value.mismatch),
            (value.called,),
        )
        return Row(cells, "" if value.good else "unexpected")

    # --- what is known

    def ledger(self) -> Table:
        """Every equation and what is known of it."""
        columns = (Column(("number",)), Column(("claim",), share=0.5), Column(("status",), share=0.3))
        said = " Every equation, and what is known of it; why it holds is said at its number"
        rows = tuple(
            Row(((Refer(one.label),), self.rich(one.title), (self.material.status(one),)))
            for one in self.material.equations
        )
        return Table(
            "ledger", (Strong(("Ledger.",)), said), columns, (Rows(rows),), look="list", wide=True, whole=True
        )

    def errata(self) -> Table:
        """What was found in equations and data."""
        names = {"about": 0.13, "kind": 0.13, "finding": 0.37, "evidence": 0.29}
        columns = tuple(Column((name,), share=share) for name, share in names.items())
        rows = tuple(map(self._erratum, self.material.refereed.errata))
        caption = (Strong(("Ledger of errata",)), ", of equations and data alike")
        return Table("errata-ledger", caption, columns, (Rows(rows),), look="list", wide=True, whole=True)

    def _erratum(self, one: Finding) -> Row:
        about = self.rich(one.about) or _text(one.source)
        if one.cell:
            index = f"\u00a0{_dashed(one.index)}" if one.index else ""
            about += (", " if one.source else "", *self._cell(one.cell), index)
        sentence = self.material.sentences.sentence
        evidence = (*sentence(one.evidence), ".") if one.evidence else ()
        return Row((about, (one.kind,), (*sentence(one.finding), "."), evidence))

    def _cell(self, name: str) -> Inlines:
        return _symbol(self.material.head(self.report.sheet[name]))

    def missing(self) -> Table:
        """The cells without a value, and those outside of what is expected."""
        columns = (
            Column(("cell",)),
            Column(("index",), "row"),
            Column(("code",), "words"),
            Column(("why",), "words", share=0.6),
        )
        said = (
            " What is computed from one without a value has none either; a † is outside of what is expected"
        )
        return Table(
            "missing-cells",
            (Strong(("Cells to look at.",)), said),
            columns,
            (Rows(tuple(map(self._remark, self.material.remarks))),),
            look="list",
            cut=self.material.cut_remarks,
        )

    def _remark(self, remark: Remark) -> Row:
        cell = remark.cell
        cells = (
            self._cell(cell.name),
            (_dashed(cell.label),),
            (Code(remark.code),),
            self.rich(remark.why),
        )
        return Row(cells, identifier=why_address(cell) if cell.why else "")


def _headed(head: Head) -> Column:
    """A column of the sheet."""
    return Column(_symbol(head), "number", head.format, unit=_unit(head.unit))


def _numbers(head: str, figures: Iterable[Figure | None], tip: str = "", signed: bool = False) -> Column:
    """A column of numbers, aligned at their decimal signs."""
    form = table_format(figures)
    return Column((head,), "number", f"-{form}" if signed and form[0] != "-" else form, tip=tip)


def _left_out(test: LeftOut, heads: Iterable[Head]) -> Row:
    """What was printed of a test that takes no part."""
    label = (test.test,)
    cells = (
        Silent(head.name, label, test.texts.get(head.name, ""), described(head, label) if head.given else "")
        for head in heads
    )
    return Row(((_dashed(label),), *cells), "excluded")


def _symbol(head: Head) -> Inlines:
    return (Hint((Math(head.latex),), head.meaning),)


def _dashed(label: tuple[int, ...]) -> str:
    """The label of a row for the eye."""
    return index_text(label).replace("-", "–")


def _text(text: str) -> Inlines:
    return (text,) if text else ()


def _number(figure: Figure | None) -> Inlines:
    return () if figure is None else (Number(figure),)


def _off(pair: Pair) -> Inlines:
    return () if pair.distance is None else (Number(pair.distance, signed=True),)


def _unit(unit: str) -> Inlines:
    return (Hint(("–",), "a pure number"),) if is_pure(unit) else (Unit(unit),)


def _from(head: Head) -> Inlines:
    return joined(((Refer(label),) for label in head.sources), ", ") or ("given",)
