"""What there is to show of a report: cells as they are shown, references, comparisons, remarks.

Nothing is calculated here; what is decided is order, wording, digits and what refers to what.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from itertools import chain, count, islice

from ...derivations.equation import Equation
from ...derivations.proved import Proof, ProofStatus
from ..cells.marks import MarkCount
from ..cells.values import Cell
from ..messages.diagnostics import Check
from ..result.numbers import decimals, read, table_format
from ..result.result import Report
from ..result.uncertain import Budget
from ..sheet import Column, Given, Root
from ..workbook import FigureSpec, TableSpec, tables_of
from .names import latex_names, name_latex
from .parts import MARK, MOST, Head, Item, Pair, Remark, SourceGroup, Written, slug
from .pictures import figures
from .refereed import RefereedPair
from .rich import Sentences
from .tree import Badge
from .written import written


class Material:
    """A report as its document sees it."""

    def __init__(self, report: Report) -> None:
        self.report = report
        self.names = latex_names(report.ledger.vocabulary, report.sheet.columns)
        units = {shown.unit for shown in report.shown.values()}
        self.sentences = Sentences(report.ledger.vocabulary, self.names, self.identifiers, units)

    # --- names and numbers

    def latex(self, name: str) -> str:
        """LaTeX of a cell's name."""
        return name_latex(name, self.names)

    def head(self, column: Column) -> Head:
        """The head of a column, without what its numbers need."""
        sources: tuple[str, ...] = ()
        if column.equation is not None:
            sources = (column.equation.label,)
            if isinstance(column.rule, Root) and column.rule.form.label not in sources:
                sources += (column.rule.form.label,)
        known = {equation.label for equation in self.report.ledger.equations()}
        return Head(
            column.name,
            self.latex(column.name),
            self.report.shown[column.name].unit,
            column.meaning,
            isinstance(column.rule, Given) and not column.rule.u_of,
            tuple(source for source in sources if source in known),
        )

    def items(self, name: str) -> tuple[Head, tuple[Item, ...]]:
        """All cells of a column, in one notation."""
        column = self.report.sheet[name]
        head, cells = self.head(column), list(self.report.values.cells(name))
        # A given number is shown as it was printed, in the unit it was printed in; what another report has
        # computed was not, but is edited with all its digits.
        printed = tuple(
            each.text if each else None for each in self.report.inputs.printed(name) if head.given
        )
        texts, figures = printed or (None,) * len(cells), self.report.figures(name)
        places = max((len(figure.fraction) for figure in figures if figure is not None), default=0)
        head = replace(head, format=table_format(figures), places=places)
        rows = zip(cells, figures, texts, self.report.marks.of(name), strict=True)
        return head, tuple(Item(cell, head, figure, text, mark) for cell, figure, text, mark in rows)

    def item(self, name: str) -> Item:
        """The cell of a column that has one."""
        (only,) = self.items(name)[1]
        return only

    # --- marks

    def marked(self, name: str) -> tuple[MarkCount, ...]:
        """For a scalar, how many of the rows that it rests on lie outside of what is expected."""
        counts = self.report.marks.behind(self.report.sheet[name])
        return tuple(count for count in counts if count.number)

    def limits(self, heads: Iterable[Head]) -> tuple[str, ...]:
        """What a mark in a table may mean, each once."""
        columns = (self.report.sheet[head.name] for head in heads)
        return tuple(dict.fromkeys(limit.told for column in columns for limit in column.limits))

    # --- tables

    @cached_property
    def specs(self) -> tuple[TableSpec, ...]:
        """The workbook's tables with what the sheet has of them; without any, scalars and axes."""
        workbook, there = self.report.workbook, self.report.sheet
        specs = workbook.tables or tables_of(there, workbook.aside)
        shown = [replace(spec, columns=tuple(n for n in spec.columns if n in there)) for spec in specs]
        shown = [spec for spec in shown if spec.columns or spec.words]
        of_source = {spec.number for spec in shown}
        own = (str(n) for n in count(1) if str(n) not in of_source)
        return tuple(replace(spec, number=spec.number or next(own)) for spec in shown)

    @property
    def untold(self) -> tuple[str, ...]:
        """The names of the axes whose rows are not shown."""
        return tuple(axis.name for axis in self.report.sheet.axes if axis.repeats)

    # --- figures

    @cached_property
    def figures(self) -> tuple[FigureSpec, ...]:
        """The workbook's figures, and those that are of no workbook."""
        return figures(self.report)

    # --- equations

    @cached_property
    def equations(self) -> tuple[Equation, ...]:
        """All equations of the ledger."""
        return tuple(self.report.ledger.equations())

    @cached_property
    def identifiers(self) -> Mapping[str, str]:
        """What each label is called in the page; the number of a group stands for its first line."""
        found: dict[str, str] = {}
        for equation in self.equations:
            identifier = f"eq-{slug(equation.label)}"
            while identifier in found.values():
                identifier += "x"
            found[equation.label] = identifier
        for equation in self.equations:
            if equation.number:
                found.setdefault(equation.number, found[equation.label])
        return found

    def written(self, equation: Equation) -> Written:
        """How an equation is written."""
        return written(equation, self.names, self.report.ledger.vocabulary)

    def proof(self, equation: Equation) -> Proof | None:
        """What was found of it; None where the algebra was not checked."""
        return next((proof for proof in self.report.proofs if proof.equation == equation), None)

    def status(self, equation: Equation) -> Badge:
        """What is known of it."""
        proof = self.proof(equation)
        if proof is None or proof.status in (
            ProofStatus.DEFINITION,
            ProofStatus.ASSUMPTION,
            ProofStatus.LIMIT,
        ):
            return Badge(proof.status.value if proof else "not checked", "stated")
        return Badge(proof.status.value, "holds" if proof.status.passes else "fails")

    # --- uncertainties

    @cached_property
    def budgets(self) -> tuple[Budget, ...]:
        """Those of the results of which something is known."""
        return tuple(budget for budget in self.report.uncertain().budgets if budget.is_known and budget.u > 0)

    # --- published values

    @cached_property
    def groups(self) -> tuple[SourceGroup, ...]:
        """The published values by their source, in the order of the file."""
        found: dict[str, list[Pair]] = {}
        for comparison in self.report.comparisons:
            column, printed = self.report.sheet[comparison.published.cell], comparison.published.printed
            distance = None if comparison.distance is None else decimals(comparison.distance, 1)
            axis = "" if column.axis is None else column.axis.row
            pair = Pair(
                comparison, self.head(column), read(printed.text), read(comparison.again), distance, axis
            )
            found.setdefault(comparison.published.source, []).append(pair)
        titles = self.report.workbook.published_as if self.report.inputs.about_source else {}
        return tuple(
            SourceGroup(source, titles.get(source, ""), tuple(pairs)) for source, pairs in found.items()
        )

    @cached_property
    def refereed(self) -> tuple[RefereedPair, ...]:
        """Those that the referee was asked about."""
        pairs = (pair for group in self.groups for pair in group.pairs)
        return tuple(
            RefereedPair(pair, pair.comparison.refereed) for pair in pairs if pair.comparison.refereed
        )

    # --- errors

    @property
    def remarks(self) -> tuple[Remark, ...]:
        """The cells where an error begins, then those outside of what is expected; the first of many."""
        return self._remarks[:MOST]

    @property
    def cut_remarks(self) -> str:
        """A sentence about those that are not shown, if there are any."""
        told = f"The first {MOST} are shown; values.json has what there is to say of every cell."
        return told if len(self._remarks) > MOST else ""

    @cached_property
    def _remarks(self) -> tuple[Remark, ...]:
        errors = (Remark(cell, cell.status.code, cell.why) for cell in self.report.faults)
        return tuple(islice(chain(errors, self._marks()), MOST + 1))

    def told(self, cell: Cell) -> bool:
        """Whether a cell where an error begins is among those that are shown."""
        return (cell.name, cell.label) in self._told

    @cached_property
    def _told(self) -> set[tuple[str, tuple[int, ...]]]:
        return {(remark.cell.name, remark.cell.label) for remark in self.remarks}

    @cached_property
    def oddities(self) -> tuple[Check, ...]:
        """What there is to tell of the data of the campaign itself."""
        return tuple(check for check in self.report.oddities if check.word)

    def _marks(self) -> Iterator[Remark]:
        marks, told = self.report.marks, dict[Cell, list[str]]()
        for margin in marks.margins:
            cells = self.report.values.cells(margin.of.name)
            for cell, outside in zip(cells, marks.outside(margin).tolist(), strict=True):
                if outside:
                    told.setdefault(cell, []).append(margin.limit.told)
        return (Remark(cell, MARK, "; ".join(why)) for cell, why in told.items())
