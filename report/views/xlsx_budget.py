"""The worksheet of uncertainty budgets: of results and of what has limits, as EA-4/02 lays them out, live.

Estimates are cells of the sheet; standard uncertainties, degrees of freedom and distributions may be changed.
How readings scatter and what is a share of a number follow those cells, too, as do sensitivities, which are
made of derivatives that have cells of their own. What is told of a sum of errors that are not all normal
stays as issued, for a spreadsheet does not convolve. Where sources were edited it says what it takes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal
from functools import cached_property
from itertools import chain, islice
from typing import Any

from ..cells.grid import BUDGETS, LONGEST, CellBlock, Grid, Product, checked, factors, letters
from ..distribution import DOMINANT, FOURTH, MOST_DOF, SCATTER, Shape
from ..quantity import behind
from ..result import conformity
from ..result.numbers import LEADING, SURE, rounded
from ..result.result import Report
from ..result.uncertain import COUNTS, Budget, Contribution, ErrorSource
from .xlsx_inputs import as_printed, same_sum, share_of
from .xlsx_limits import SHAPES, as_issued, write_limits
from .xlsx_style import Style, height, number_format

MOST_LIMITED = 20
"""Cells with limits that are no results, of which the budgets are written."""
_COLUMNS = (
    ("source", 26),
    ("estimate", 15),
    ("unit", 12),
    ("standard uncertainty u", 15),
    ("distribution", 14),
    ("degrees of freedom", 12),
    ("sensitivity", 15),
    ("contribution", 15),
    ("share of the variance", 12),
)
_AS_ISSUED = 11
"""The column, from 0, that names the inputs where sensitivities are numbers."""
_UNLIMITED = 10.0**15
"""Stands for infinitely many degrees of freedom."""
_DOF = '[>=1000000000]"∞";General'
_BARS = {
    **{"type": "data_bar", "bar_color": "#E9B893"},
    **{"min_type": "num", "min_value": 0, "max_type": "num", "max_value": 1},
}
"""A share is as long as its bar: the whole cell is the whole variance."""
_FACTORS = {
    "exponential": "IF({p}>1-EXP(-2),-LN(1-{p})-1,ASINH({p}*EXP(1)/2))",
    "rectangular": "{p}*SQRT(3)",
    "triangular": "(1-SQRT(1-{p}))*SQRT(6)",
    "arcsine": "SIN({p}*PI()/2)*SQRT(2)",
}
"""The coverage factor for a probability, of the shapes that have ends."""


def told_budgets(report: Report) -> list[Budget]:
    """Those of the results, and of the first other cells that have limits."""
    uncertain = report.uncertain()
    results = {each.cell: each for each in uncertain.budgets}
    # Of what first order tells nothing of, draws do: these have no formulas.
    limited = (each.budget for each in uncertain.conformities if not each.budget.unlooked)
    others = islice((each for each in limited if each.cell not in results), MOST_LIMITED)
    return [each for each in (*results.values(), *others) if each.is_known and each.u > 0]


def write_budgets(sheet: Any, style: Style, report: Report, grid: Grid) -> dict[str, tuple[str, str]]:
    """Write them, one below the other; return the formula and the text of each cell's statement."""
    said = "Estimates follow the sheet; yellow cells may be changed, in each budget for itself."
    budgets = told_budgets(report)
    fixed = any(_Written(sheet, style, report, grid, each, 0, "").is_fixed for each in budgets)
    if fixed:
        said += " Sensitivities without a formula are told of the inputs as issued, and of no others."
    widths = (width for _, width in (*_COLUMNS, *[("", 12)] * (_AS_ISSUED - len(_COLUMNS) + 2)))
    style.page(sheet, "uncertainty: where that of the results comes from", said, widths)
    issued, row = _write_as_issued(sheet, style, report, grid) if fixed else "TRUE", 3
    stated = {}
    for budget in budgets:
        written = _Written(sheet, style, report, grid, budget, row, issued)
        row = written.write() + 2
        if written.stated is not None:
            stated[budget.cell] = written.stated
    told = {budget.cell for budget in budgets}
    others = [each for each in report.uncertain().conformities if each.budget.cell not in told]
    if others:
        style.text(sheet, row, 0, "limits of cells without a budget here, as issued", "head")
    for line, found in enumerate(others, start=row + 1):
        style.text(sheet, line, 0, conformity.decision(report, found))
    sheet.freeze_panes(3, 1)
    return stated


def _write_as_issued(sheet: Any, style: Style, report: Report, grid: Grid) -> str:
    """Write which inputs are as issued, one below the other; return the formula that says whether all are.

    A column is, where sums of its numbers are, each times what no numbers that are typed cancel.
    """
    style.text(sheet, 3, _AS_ISSUED, "inputs", "head")
    style.text(sheet, 3, _AS_ISSUED + 1, "are as issued", "head")
    given = [block for block in grid.blocks if block.kind == "checked" and block.of in report.sheet]
    for row, block in enumerate(given, start=4):
        place, status = block.place, report.values.status[block.of]
        cells, rows = place.range(), range(place.row + 1, place.row + place.rows + 1)
        values = report.values.value[block.of].tolist()
        numbers = [0.0 if bad else place.of(x) for x, bad in zip(values, status, strict=True)]
        same = []
        for formula, weigh in ("SQRT(ROW({}))", math.sqrt), ("LN(ROW({}))", math.log):
            terms = [weigh(at) * number for at, number in zip(rows, numbers, strict=True)]
            same.append(same_sum(f"{formula.format(cells)},{cells}", terms))
        style.text(sheet, row, _AS_ISSUED, block.of, "name")
        style.formula(sheet, row, _AS_ISSUED + 1, f"=AND({','.join(same)})", True, style("text"))
    column = letters(_AS_ISSUED + 1)
    return f"AND(${column}$5:${column}${4 + len(given)})"


def _fourth(cells: str) -> str:
    """The fourth powers of cells: a power that is too small for a double is an error to LibreOffice."""
    return "*".join([cells] * 4)


class _Written:
    """One budget."""

    def __init__(
        self,
        sheet: Any,
        style: Style,
        report: Report,
        grid: Grid,
        budget: Budget,
        row: int,
        issued: str,
    ) -> None:
        self.issued = issued
        """The formula that says whether the inputs are as issued."""
        self.stated: tuple[str, str] | None = None
        """The formula that names the cell of its statement, and what that says now; None before it stands."""
        self.sheet, self.style, self.report, self.grid, self.budget = sheet, style, report, grid, budget
        self.block: CellBlock = grid[budget.name]
        self.scale = float(self.block.place.scale)
        self.top = row
        self.first = row + 2
        self.lines = [*budget.contributions, *(each for each in budget.idle if self.slope(each.source))]
        self.last = self.first + len(self.lines) - 1
        self.rows = {each.source.name: self.first + n for n, each in enumerate(self.lines)}
        every = {**budget.correlations, **budget.tied}
        self.correlations = {pair: r for pair, r in every.items() if self.rows.keys() >= set(pair)}

    def write(self) -> int:
        """Write it; return the row behind it."""
        column = self.report.sheet[self.budget.name]
        unit = "" if self.block.unit == "1" else f" [{self.block.unit}]"
        for at, (head, _) in enumerate(_COLUMNS):
            title = f"{self.budget.cell}{unit}: {column.meaning}" if not at else ""
            self.style.text(self.sheet, self.top, at, title, "section")
            self.style.text(self.sheet, self.top + 1, at, head, "head")
        self.sheet.set_row(self.top + 1, height([(head, width) for head, width in _COLUMNS], 2))
        for row, each in enumerate(self.lines, start=self.first):
            self.source(row, each)
        if self.lines:
            self.sheet.conditional_format(self.first, 8, self.last, 8, _BARS)
        return self.result(self.last + 1)

    @property
    def is_fixed(self) -> bool:
        """Whether a sensitivity has no formula."""
        return not all(self.slope(each.source) for each in self.budget.contributions)

    def source(self, row: int, each: Contribution) -> None:
        """A line: what it is, and what it does."""
        source, style, sheet, report = each.source, self.style, self.sheet, self.report
        name, cell, _ = source.moves[0]
        block = self.grid[name]
        scale = float(block.place.scale)
        style.text(sheet, row, 0, source.name, "name")
        if each.estimate is not None and not source.origin:  # its own estimate stands in the other report
            allowed = self.grid[checked(name)].place.cell(cell)
            form = style("number", as_printed(report, block, cell))
            style.formula(sheet, row, 1, f"={allowed}", block.place.of(each.estimate), form)
        style.text(sheet, row, 2, block.unit, "unit")
        dof, size, number, kind = min(source.dof, _UNLIMITED), self.size(row, each), "", ""
        shape = source.shape.value
        if source.said == SCATTER:
            own = self.readings(source)
            spread, left = f"STDEV({own})", f"COUNT({own})-1"
            # Of readings that are all the same nobody knows it here: a cell has no digits that leave more.
            size, number = f"=IF({spread}=0,NA(),{spread})", f"={left}"
            if source.u and source.shape is not Shape.STUDENT:
                # Of readings that are all the same the digits leave more, as long as they are.
                size, number, kind = (
                    f"=IF({spread}=0,{now},{then})"
                    for now, then in (
                        (repr(source.u / scale), spread),
                        (repr(dof), left),
                        (f'"{shape}"', f'"{Shape.STUDENT}"'),
                    )
                )
        if kind:
            style.formula(sheet, row, 4, kind, shape, style("chosen"))
        else:
            style.text(sheet, row, 4, shape, "chosen")
        self.number(row, 5, number, dof, _DOF)
        contribution = each.u / self.scale
        if width := self.width(source):
            u = width / scale
            self.number(row, 3, size, u, number_format(report.sure(name, width)))
            form = style("number", number_format(rounded(contribution / u, 4)))
            slope = self.slope(source) or f"=IF({self.issued},{contribution / u!r},NA())"
            style.formula(sheet, row, 6, slope, contribution / u, form)
            form = number_format(rounded(contribution, 3))
            product = f"D{row + 1}*G{row + 1}"
            typed = product if size else f'IF(COUNTIF(D{row + 1},">=0")=1,{product},NA())'
            style.formula(sheet, row, 7, f"={typed}", contribution, style("number", form))
        else:  # larger in one cell than in another: there is no one sensitivity
            slope = self.slope(source) or f"=IF({self.issued},{contribution!r},NA())"
            self.number(row, 7, slope, contribution, number_format(rounded(contribution, 3)))
        formula = f"=IFERROR(H{row + 1}*(H{row + 1}{self.correlated(row)})/$B${self.last + 3}^2,0)"
        style.formula(sheet, row, 8, formula, each.share, style("number", "0.0%"))

    def slope(self, source: ErrorSource) -> str:
        """The formula of the sensitivity to an error, if there is one: by all cells that it moves.

        Of an error that is larger in one cell than in another, that of its contribution.
        """
        by, (name, _, size), grid = self.ways, source.moves[0], self.grid
        ways = by.get(name, ())
        every = range(grid[ways[0].first].place.rows) if ways else ()
        width = self.width(source)
        whole = self.axis is None and len(every) > 1
        whole = whole and [move[:2] for move in source.moves] == [(name, row) for row in every]
        slopes = grid[ways[0].first].place.range() if whole else ""
        if whole and width and len({u for *_, u in source.moves}) == 1:
            told = f"{'-' * (size < 0)}SUM({slopes})"
        elif whole and (
            gain := self.gain(source, f"SUMPRODUCT({slopes},{grid[checked(name)].place.range()})")
        ):
            told = gain
        else:
            terms = [
                f"{sign}{text}{times}"
                for own, row, u in source.moves
                for sign, times in [self.times(source, own, row, u)]
                for text in self.products(own, row)
            ]
            told = "".join(terms).removeprefix("+")
            told = f"({told})" if len(terms) > 1 or told.startswith("-") else told
        unit = (grid[name].place.scale if width else 1) / self.block.place.scale
        return f"={told}{factors(unit)[0]}" if 0 < len(told) < LONGEST else ""

    @property
    def ways(self) -> Mapping[str, Sequence[Product]]:
        """The products that the derivatives by each given column are made of."""
        return self.grid.slopes.get(self.budget.name, {})

    def times(self, source: ErrorSource, name: str, row: int, u: float) -> tuple[str, str]:
        """The sign of an error in a cell, and its standard uncertainty in SI as a factor, if they differ."""
        sign = "+" if u > 0 else "-"
        if self.width(source):
            return sign, ""
        value, cell = float(self.report.values.value[name][row]), self.grid[checked(name)].place.cell(row)
        if told := self.gain(source, f"N({cell})", name):
            return "+", f"*{told}"
        told = self.of_share(source, name, value, u, f"ABS(N({cell}))")
        unit = factors(self.grid[name].place.scale)[0]
        return sign, f"*({told}){unit}" if told else f"*{Decimal(repr(abs(u))):f}"

    def gain(self, source: ErrorSource, size: str, name: str = "") -> str:
        """The formula of what a gain makes of a number or of a sum of products, of such a size; else nothing.

        `name`: its column, if it is not the first that the gain moves.
        """
        name = name or source.moves[0][0]
        place, part = self.grid[name].place, self.part(source, name)
        if part is None or not part.scales or place.zero:
            return ""
        return f"({part.share:.15g}*{size}){factors(place.scale)[0]}"

    def part(self, source: ErrorSource, name: str) -> Any:
        """What was stated of an error, where that stands alone."""
        said = self.report.inputs.uncertainty.again(source.said, self.grid[name].unit, source.shape)
        return said.parts[0] if said else None

    def products(self, name: str, row: int) -> Iterator[str]:
        """What is added to the derivative by a row of a given column."""
        result, layouts = self.row_of_cell, self.report.values.layouts
        if (name, row) == (self.budget.name, result):  # a number that was given may have limits, too
            yield "1"
        for first, then, index, rows in self.ways.get(name, ()):
            place = self.grid[first].place
            if then:
                yield f"{place.cell(result)}*{self.grid[then].place.cell(row)}"
            elif self.axis is None:
                yield place.cell(row)
            elif rows:
                if layouts[rows].rows[index or ""][row] == result:
                    yield place.cell(row)
            elif index is None or row == (layouts[self.axis].rows[index][result] if index else result):
                yield place.cell(result)

    @property
    def axis(self) -> str | None:
        """The rows of a column of results."""
        axis = self.report.sheet[self.budget.name].axis
        return None if axis is None else axis.name

    def number(self, row: int, column: int, formula: str, now: float, form: str) -> None:
        """A number that follows others; without a formula one that may be changed."""
        if formula:
            self.style.formula(self.sheet, row, column, formula, now, self.style("number", form))
        else:
            self.sheet.write_number(row, column, now, self.style("input", form))

    def readings(self, source: ErrorSource) -> str:
        """The cells of the readings that an error is estimated from."""
        return self.grid[checked(source.moves[0][0])].place.range()

    def size(self, row: int, each: Contribution) -> str:
        """The formula of a standard uncertainty of which a share of the estimate is a part; else nothing."""
        source = each.source
        name, *_ = source.moves[0]
        if not source.u or each.estimate is None:
            return ""
        told = self.of_share(source, name, each.estimate, source.u, f"ABS(N(B{row + 1}))")
        return told and f"={told}"

    def width(self, source: ErrorSource) -> float | None:
        """The standard uncertainty of an error where it is, and stays, as large in all cells; else None."""
        part = self.part(source, source.moves[0][0])
        return None if len(source.moves) > 1 and part is not None and part.scales else source.u

    def of_share(self, source: ErrorSource, name: str, value: float, u: float, size: str) -> str:
        """The formula of a standard uncertainty in the unit of a cell, of which it is a share.

        `size`: the formula of how large the number is.
        """
        place, part = self.grid[name].place, self.part(source, name)
        if part is None or not part.share or place.zero:
            return ""
        return share_of(part.share, value, abs(u), size, float(place.scale), float(place.scale))

    def correlated(self, row: int) -> str:
        """What correlated sources add to a contribution."""
        return "".join(f"+({of})*H{other + 1}" for other, of in self.beside.get(row, ()))

    @cached_property
    def beside(self) -> Mapping[int, Sequence[tuple[int, str]]]:
        """The lines of what each line is correlated with, and the coefficients."""
        found: dict[int, list[tuple[int, str]]] = {}
        for pair, r in self.correlations.items():
            first, second = (self.rows[name] for name in pair)
            told = self.coefficient(pair, r)
            found.setdefault(first, []).append((second, told))
            found.setdefault(second, []).append((first, told))
        return found

    def result(self, row: int) -> int:
        """What follows from the lines; the row behind it."""
        budget, scale = self.budget, self.scale
        own, dof = (f"${c}${self.first + 1}:${c}${self.last + 1}" for c in "HF")
        names = ("value", "u", "second", "largest", "others", "dof", "p", "k", "U")
        at = {name: f"$B${row + n + 1}" for n, name in enumerate(names)}
        sizes = sorted(abs(each.u) / scale for each in budget.contributions) or [0.0]
        first = f"SUMSQ({own}){self.pairs}"
        ratio = f"({first})^2/{self.below(own, dof)}"
        freedom = f"IF({ratio}>{MOST_DOF},{_UNLIMITED:.0f},MAX(1,INT(ROUND({ratio},2))))"
        second, largest = budget.second / scale**2, sizes[-1]
        others = math.sqrt(math.hypot(*sizes[:-1]) ** 2 + abs(second))
        lost = f"SUMSQ({own})-{at['largest']}^2"
        shown = number_format(self.report.figures(budget.name)[self.row_of_cell])
        of_second, of_largest = number_format(rounded(second, 3)), number_format(rounded(largest, 4))
        cell, value = self.block.place.cell(self.row_of_cell), self.block.place.of(budget.value)
        u, expanded = budget.u / scale, budget.expanded / scale
        free = f"=IF({at['largest']}=0,{_UNLIMITED:.0f},{freedom})", min(budget.dof, _UNLIMITED)
        # What has no value has no uncertainty, but the code that stands for it.
        root, wide = f"SQRT(MAX(0,{first}+{at['second']}))", f"{at['k']}*{at['u']}"
        # Sources that do nothing after an edit may do something to second order.
        stated = f"$D${self.first + 1}:$D${self.last + 1}"
        gains = any(self.width(each.source) is None for each in self.lines)  # their column says nothing
        known = f"IFERROR(IF(AND({root}=0,{'TRUE' if gains else f'SUMSQ({stated})>0'}),NA(),{root}),NA())"
        sure, form = self.form(budget.u), self.form(budget.expanded)
        lines: tuple[tuple[str, str, float, str], ...] = (
            ("value", f"={cell}", value, shown),
            ("standard uncertainty u", f"=IF(ISNUMBER({at['value']}),{known},{at['value']})", u, sure),
            ("variance of second order", self.second_order(first), second, of_second),
            ("largest contribution", f"=MAX(MAX({own}),-MIN({own}))", largest, of_largest),
            ("all others together", f"=SQRT(MAX(0,{lost})+ABS({at['second']}))", others, of_largest),
            ("effective degrees of freedom", *free, _DOF),
            ("coverage probability", "", budget.level, "0.##%"),
            ("coverage factor k", f"={self.factor(own, at, budget)}", budget.factor, "0.000"),
            ("expanded uncertainty U", f"=IF(ISNUMBER({at['u']}),{wide},{at['u']})", expanded, form),
        )
        for line, (name, formula, now, form) in enumerate(lines, start=row):
            self.style.text(self.sheet, line, 0, name, "name")
            if math.isnan(now):
                self.style.text(self.sheet, line, 1, f"not known: {budget.because}")
            else:
                self.number(line, 1, formula, now, form)
        row = self.statement(row + len(lines), at)
        if budget.shape is Shape.CONVOLVED:
            told = f"{budget.because}, as issued: they do not follow an edit"
            instead = f"{budget.because} as issued, and how their kurtosis changed: it may be some % off"
            self.style.text(self.sheet, row, 0, "k comes from", "name")
            said = f'=IF({self.unmoved(at)},"{told}","{instead}")'
            self.style.formula(self.sheet, row, 1, said, told, self.style("text"))
            row += 1
        if budget.advice:
            self.style.text(self.sheet, row, 0, budget.advice)
            row += 1
        return self.limits(row, own, at)

    def second_order(self, first: str) -> str:
        """The formula of what is taken from the variance, if it is that: as much of it as was issued.

        Where the sources have other shares nobody knows how much: nothing is taken, and U is not too small.
        What was too little to count stays what it was, and counts where less is left of first order; where
        nothing is, the sources may have come to nothing themselves.
        """
        second, issued = self.budget.second, self.budget.u**2 - self.budget.second
        if second >= 0:
            little = self.budget.little / self.scale**2
            counts = f"AND({first}>0,{little!r}>{COUNTS}*({first}))"
            return f"=IF({counts},{little!r},0)" if little > 0 else ""
        same = ",".join(self.same_shares(f"({first})^2", math.sqrt(issued)))
        return f"=IF({first}=0,0,IF(AND({same}),-({first})*{-second / issued!r},0))"

    def unmoved(self, at: Mapping[str, str]) -> str:
        """Whether the sources are as issued, and their degrees of freedom."""
        same = ",".join(self.same_shares(f"{at['u']}^4", self.budget.u))
        return f"AND({same},ABS({at['dof']}/{min(self.budget.dof, _UNLIMITED):.0f}-1)<0.000001)"

    def same_shares(self, whole: str, issued: float) -> Iterator[str]:
        """Whether the fourth powers of the sources' shares are as issued, shape by shape.

        As the variances make u and the fourth powers what is told besides, it is the same where these are.
        `whole`: the fourth power of what they are shares of. `issued`: that itself, in SI.
        """
        shapes: dict[Shape, float] = {}
        for each in self.budget.contributions:
            shapes[each.source.shape] = shapes.get(each.source.shape, 0.0) + (each.u / issued) ** 4
        own, kind = (f"${c}${self.first + 1}:${c}${self.last + 1}" for c in "HE")
        for shape, now in shapes.items():
            yield f'ABS(SUMPRODUCT(({kind}="{shape}")*{_fourth(own)})/{whole}-({now:.15f}))<0.000001'

    def limits(self, row: int, own: str, at: Mapping[str, str]) -> int:
        """The decision rule, where the cell has limits."""
        for found in self.report.uncertain().conformities:
            if found.budget.cell == self.budget.cell:
                form = self.form(found.guard or self.budget.u)
                formulas = self.assigned(found.budget, own, at)[0], self.assigned(found.by, own, at)[1]
                row = write_limits(
                    self.sheet, self.style, found, self.block.place, form, row, dict(at), formulas
                )
        return row

    def assigned(self, budget: Budget, own: str, at: Mapping[str, str]) -> tuple[Callable[[str], str], str]:
        """The coverage factor for the cell of a probability, and the name of the distribution."""
        plain = f'IF({at["dof"]}>{MOST_DOF},"normal","t")'

        def factor(p: str) -> str:
            return self.factor(own, {**at, "p": p}, budget)

        if budget.draws:
            return factor, f'"{budget.shape}"'
        named = self.by_shape(own, at, SHAPES, plain)
        if self.is_joint(budget):
            named = f'IF({self.unmoved(at)},"{budget.shape}",NA())'
        return factor, named

    def below(self, own: str, dof: str) -> str:
        """What stands below in the formula of Welch and Satterthwaite: sources of one estimate are one."""
        samples = [each.source.sample for each in self.lines]
        if not any(sample and samples.count(sample) > 1 for sample in samples):
            return f"SUMPRODUCT({_fourth(own)}/({dof}))"
        self.style.text(self.sheet, self.top + 1, len(_COLUMNS), "estimate", "head")
        for row, sample in enumerate(samples, start=self.first):
            number = samples.index(sample) if sample else row - self.first
            self.sheet.write_number(row, len(_COLUMNS), number + 1, self.style("input", "0"))
        share, estimate = (own.replace("H", column) for column in "IJ")
        u = f"$B${self.last + 3}"
        return f"({u}^4*SUMPRODUCT({share}*SUMIF({estimate},{estimate},{share})/({dof})))"

    def form(self, u: float) -> str:
        """The number format of an uncertainty of the cell."""
        return number_format(self.report.sure(self.budget.name, u) if math.isfinite(u) else None)

    @property
    def pairs(self) -> str:
        """What correlated pairs of sources add to the variance."""
        rows = self.rows
        return "".join(
            f"+2*({self.coefficient((one, other), r)})*H{rows[one] + 1}*H{rows[other] + 1}"
            for (one, other), r in self.correlations.items()
        )

    def coefficient(self, pair: tuple[str, str], r: float) -> str:
        """A correlation coefficient; that of paired readings follows them."""
        sources = [self.lines[self.rows[name] - self.first].source for name in pair]
        if self.report.inputs.uncertainty.paired and all(each.said == SCATTER for each in sources):
            return f"CORREL({','.join(map(self.readings, sources))})"
        return f"{r:.15f}"

    def factor(self, own: str, at: Mapping[str, str], budget: Budget) -> str:
        """The coverage factor: of the shape of a source that dominates, else of t or normal.

        Of a truncated normal source, of draws and of a sum of errors no spreadsheet has the formula: it is
        known for the level as issued, and for no other.
        """
        p, dof = at["p"], at["dof"]
        if budget.draws:
            return as_issued(p, budget.level, budget.factor)
        otherwise = f"IF({dof}>{MOST_DOF},NORMSINV((1+{p})/2),TINV(1-{p},MIN({dof},{MOST_DOF})))"
        factors = {name: factor.format(p=p) for name, factor in _FACTORS.items()}
        if budget.law and budget.shape.value not in factors:
            factors[budget.shape.value] = as_issued(p, budget.level, budget.factor)
        told = self.by_shape(own, at, factors, otherwise)
        if self.is_joint(budget):
            issued = factors[budget.shape.value]
            moved = self.by_kurtosis(own, at, budget, issued, otherwise) or f"MAX({told},{issued})"
            return f"IF({self.unmoved(at)},{issued},IF(ISNUMBER({issued}),{moved},{told}))"
        return told

    @staticmethod
    def by_kurtosis(own: str, at: Mapping[str, str], budget: Budget, issued: str, otherwise: str) -> str:
        """The coverage factor of a sum whose parts have changed, in proportion to its excess kurtosis.

        It is that of a normal distribution, or t, where there is none, and as issued where it is the same. Of
        sums drawn at random it is within 2 % where contributions change by a tenth, most within 0.3 %; where
        they change by half, most are within 2.5 %. Empty where a distribution is none of those that a word
        tells.
        """
        if budget.shape is not Shape.CONVOLVED or any(each.source.law for each in budget.contributions):
            return ""
        excess = {shape: fourth - 3 for shape, fourth in FOURTH.items()}
        parts = ((each.source.shape, (each.u / budget.u) ** 4) for each in budget.contributions)
        then = sum(excess.get(shape, 0.0) * part for shape, part in parts)
        if not then < 0:
            return ""
        kind = own.replace("H", "E")
        sums = (f'({kind}="{shape}")*{by!r}' for shape, by in excess.items())
        now = f"SUMPRODUCT(({'+'.join(sums)})*{_fourth(own)})/{at['u']}^4"
        p, dof = at["p"], budget.dof
        plain = f"NORMSINV((1+{p})/2)" if dof > MOST_DOF else f"TINV(1-{p},{dof!r})"
        return f"{otherwise}+({issued}-{plain})*{now}/{then!r}"

    @staticmethod
    def is_joint(budget: Budget) -> bool:
        """Whether its distribution is that of several sources: of a sum, or of one table of draws."""
        tables = [each.source.table for each in budget.contributions if each.source.table]
        return not budget.draws and (budget.shape is Shape.CONVOLVED or len(tables) > len({*tables}))

    def by_shape(self, own: str, at: Mapping[str, str], formulas: Mapping[str, str], otherwise: str) -> str:
        """The formula of the shape of a source that dominates; another one if none does."""
        place = f"IF(MAX({own})>=-MIN({own}),MATCH(MAX({own}),{own},0),MATCH(MIN({own}),{own},0))"
        shape, sure = (f"INDEX({own.replace('H', column)},{place})" for column in "EF")
        told = otherwise
        for name, formula in formulas.items():
            told = f'IF({shape}="{name}",{formula},{told})'
        # Where nothing is of first order there is no line to look at.
        dominant = f"IF({sure}>{MOST_DOF},{told},{otherwise})"
        named = dict.fromkeys(chain.from_iterable(self.correlations))
        own_sources = enumerate((line.source for line in self.lines), start=1)
        tied = [n for n, source in own_sources if source.name in named and not source.table]
        if tied and not self.budget.second:  # correlated errors are taken as normal
            those = ",".join(map(str, tied))
            dominant = f'IF(ISNUMBER(FIND(","&{place}&",",",{those},")),{otherwise},{dominant})'
        return (
            f"IF({at['largest']}=0,{otherwise},"
            f"IF({at['others']}<={DOMINANT}*{at['largest']},{dominant},{otherwise}))"
        )

    @property
    def row_of_cell(self) -> int:
        return self.report.values.row(self.report.sheet[self.budget.name], self.budget.label)

    def statement(self, row: int, at: Mapping[str, str]) -> int:
        """The result as it is written, by the rule of :func:`~loopsheet.report.result.numbers.stated`."""
        budget, style, sheet = self.budget, self.style, self.sheet
        if math.isnan(budget.factor):
            return row
        value, expanded = self.report.stated(budget.name, budget.value, budget.expanded)
        most, unit = self.report.inputs.uncertainty.digits, behind(self.block.unit)
        told, decimals, power = (f"$B${row + n}" for n in (1, 2, 3))
        sure, short = (f"{digits}-1-{_order(at['U'])}" for digits in (SURE, most))
        near = f"ROUND(ROUND({at['U']},{sure}),{short})"
        up = f"IF({near}<0.95*{at['U']},ROUNDUP({at['U']},{short}),{near})"
        rounded_value = f"ROUND({at['value']},{decimals})"
        size = _order(f"MAX(ABS({rounded_value}),{told})")
        by, places = value.exponent or 0, len(expanded.fraction) - (expanded.exponent or 0)
        steps: tuple[tuple[str, str, float, str], ...] = (
            ("U as it is told", f"IF({at['U']}=0,0,{up})", float(expanded.plain), self.form(budget.expanded)),
            ("its decimals", f"IF({told}=0,0,{most}-1-{_order(told)})", places, "0"),
            ("power of ten", f"IF({told}=0,0,IF(OR({decimals}<0,{size}<-{LEADING}),{size},0))", by, "0"),
        )
        for line, (name, formula, number, form) in enumerate(steps, start=row):
            style.text(sheet, line, 0, name, "aside")
            style.formula(sheet, line, 1, f"={formula}", number, style("step", form))
        form = f'"0"&IF({decimals}+{power}>0,"."&REPT("0",{decimals}+{power}),"")'
        parts = [f"TEXT({number}/10^{power},{form})" for number in (rounded_value, told)]
        written = f'"("&{parts[0]}&" ± "&{parts[1]}&")"&IF({power}=0,"","E"&{power})&"{unit}'
        text = f'{written}, k = "&TEXT({at["k"]},"0.00")'
        certain = f'{at["value"]}&"{unit}, U = 0"'
        formula = f"=IF(ISNUMBER({at['value']}),IF({at['U']}=0,{certain},{text}),{at['value']})"
        plain = [replace(number, exponent=None).plain for number in (value, expanded)]
        now = f"({plain[0]} ± {plain[1]}){f'E{by}' if by else ''}{unit}, k = {budget.factor:.2f}"
        style.text(sheet, row + len(steps), 0, "statement", "name")
        style.formula(sheet, row + len(steps), 1, formula, now, style("text"))
        self.stated = f"={BUDGETS}!$B${row + len(steps) + 1}", now
        return row + len(steps) + 1


def _order(cell: str) -> str:
    """The power of ten of the first digit of a positive number, in a formula; logarithms are not exact."""
    return f"INT(LOG10({cell})+1E-9)"
