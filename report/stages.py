"""What is made of a report folder, stage by stage: values, judges, and what several views and judges need."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import TYPE_CHECKING, Any

from ..derivations.unit_text import UnitError as NotAUnit
from ..derivations.unit_text import of_differences, parse_unit
from .inputs.inputs import Inputs
from .machine.provenance import versions
from .machine.timing import timed
from .messages.errors import LoopsheetError, UsageError, diagnose, listing
from .prepared import Prepared
from .which_workbook import is_shipped

if TYPE_CHECKING:
    from ..derivations.equation import Ledger
    from .cells.grid import Grid
    from .cells.layout import Layout
    from .cells.marks import Marks
    from .cells.values import Values
    from .charts import Drawn
    from .messages.diagnostics import Check
    from .messages.errors import Diagnostic
    from .result.agreement import Agreement
    from .result.result import Comparison, Plotted, Report, Shown
    from .result.uncertain import Uncertainties
    from .result.verdict import Referee
    from .sheet import Column, Sheet
    from .workbook import Workbook

Step = Callable[[str], None]
"""Told what is begun, for whoever watches."""
Keep = Callable[[str, Callable[[], Any]], Any]
"""Gives data of a name that is made now or was made before."""

EXACTLY = 20_000
"""Up to so many cells, a sheet is evaluated at 50 digits, which takes .3 ms a cell, and its values are those,
correctly rounded; of a larger one, some of its tests are."""


VERDICTS = "verdicts"
"""Under which name it is kept what the referee found."""


def silent(_: str) -> None:
    """Nobody watches."""


def made_anew(_: str, make: Callable[[], Any]) -> Any:
    """Nothing is kept."""
    return make()


def prepared(inputs: Inputs, ledger: Callable[[], Ledger]) -> Prepared:
    """The inputs with their sheet, of which dimensions and names are in order."""
    from . import refusals
    from .kept_sheet import sheet_of
    from .sheet import SheetError

    def check(sheet: Sheet) -> None:
        from .stated import refuse_what_is_not_stated

        refuse_what_is_not_stated(sheet, ledger())

    own = not is_shipped(inputs.workbook)
    try:
        sheet = sheet_of(inputs.workbook, inputs.given, check)
        if own:
            _refuse_other_dimensions(sheet)
    except SheetError as error:
        if not own:
            raise  # ours, and our bug
        raise refusals.of_sheet(inputs, error) from error
    if own:
        from .document.narrative import narratives

        refusals.refuse_what_is_misnamed(sheet, inputs, narratives(), lambda: _drawings(inputs))
    refusals.refuse_what_is_missing(sheet, inputs)
    made = Prepared(inputs, sheet)
    if inputs.workbook.curves and sheet.loops:
        from .engines.fit_starts import begun

        made = replace(made, sheet=begun(sheet, inputs.workbook.curves, made.labels, made.data))
    return made


def _refuse_other_dimensions(sheet: Sheet) -> None:
    """Refuse columns that would be shown in a unit of another dimension, or in what is no unit."""
    from .sheet import SheetError

    for column in sheet.columns:
        like = column.display.removeprefix("like ")
        written = like if like == column.display else sheet[like].unit if like in sheet else ""
        try:
            own = parse_unit(column.unit)
        except NotAUnit:
            continue  # an exponent that is a symbol: it is shown in SI
        try:
            shown = parse_unit(written) if written else own
        except NotAUnit as error:
            said = f"{column.name}: it is to be shown in {written!r}, which is no unit"
            raise SheetError(said, column.name) from error
        if shown.dimension != own.dimension:
            said = f"{column.name}: its unit is {column.unit}, which is not shown in {written}"
            raise SheetError(said, column.name)


def of_cells(inputs: Inputs) -> Sequence[Diagnostic]:
    """What is wrong with the cells that a folder names, if that is asked because something else is wrong."""
    try:
        prepared(inputs, inputs.workbook.ledger).check_cells()
    except LoopsheetError as error:
        return error.diagnostics
    return ()


def _drawings(inputs: Inputs) -> Collection[str]:
    from .views import figures

    return figures.drawings(inputs.workbook)


def evaluated(made: Prepared, ledger: Callable[[], Ledger], step: Step) -> Report:
    """Everything but the proofs."""
    from .judge.oddities import oddities
    from .uncertainty.beyond import outside

    report = _evaluated(made, ledger, step)
    if report.inputs.cards.codes:
        from .cards import asked_for

        report = replace(report, cards=asked_for(report))
    return replace(report, oddities=(*oddities(report, outside(report)), *_claims(report)))


def _evaluated(made: Prepared, ledger: Callable[[], Ledger], step: Step) -> Report:
    """All cells, at which nobody has looked for what is odd."""
    inputs, sheet = made.inputs, made.sheet
    from .cells.layout import how_large
    from .cells.marks import Marks, margins, with_margins
    from .referee import compare
    from .result.result import Report

    step(f"computing {how_large(sheet, made.layouts)} cells")
    inputs = made.check_cells()
    workbook, limits = inputs.workbook, margins(sheet)
    exactly, (values, whole) = made.computed(with_margins(sheet), EXACTLY)
    return Report(
        title=inputs.title,
        workbook=workbook,
        inputs=inputs,
        sheet=sheet,
        values=values,
        marks=Marks(whole, limits),
        exactly=exactly,
        shown={column.name: shown(column, sheet, inputs) for column in sheet.columns},
        algebra=ledger,
        comparisons=compare(inputs.published, values, inputs.expected),
        plotted=cache(lambda: plotted(values, inputs)),
        uncertain=cache(lambda: uncertain(workbook, values, inputs)),
        versions=versions(),
    )


def computing(sheet: Sheet, columns: Sequence[Column]) -> Callable[[Inputs], Marks]:
    """What computes some columns of a sheet, and what they rest on, for one set of inputs after another."""
    from .cells.marks import Marks, margins, with_margins
    from .engines.numpy import Program, evaluate
    from .sheet import Sheet

    whole = with_margins(sheet)

    def below(columns: Iterable[Column]) -> set[str]:
        return {own.name for column in columns for own in (*whole.ancestors(column), column)}

    limits = tuple(margin for margin in margins(sheet) if margin.of.name in below(columns))
    wanted = below([*columns, *(margin.column for margin in limits)])
    part = Sheet(tuple(column for column in whole.columns if column.name in wanted))
    program = Program.of(part)

    def computed(inputs: Inputs) -> Marks:
        made = Prepared(inputs, part)
        return Marks(evaluate(part, made.labels, made.data, program), limits)

    return computed


def _claims(report: Report) -> Iterator[Check]:
    """Whether what is claimed holds of the numbers: of some of the rows, where there are many."""
    from .judge import sample
    from .judge.claims import claims

    if said := report.workbook.claims:
        made = Prepared(sample.part(report.inputs, report.values, EXACTLY), report.sheet)
        yield from claims(said, report.sheet, made.labels, made.exact_data, report.inputs.place)


def judged(report: Report, every: bool = True, step: Step = silent) -> Report:
    """The report with its engines compared with 50 digits.

    `every`: whether to run what else is installed too: JavaScript, and the workbook in LibreOffice.
    """
    from .cells.layout import how_large
    from .engines.numpy import evaluate
    from .judge import sample

    step("judging the engines at 50 digits")
    whole = report.marks.values
    inputs = sample.part(report.inputs, whole, EXACTLY)
    made = Prepared(inputs, report.sheet)
    computed = evaluate(whole.sheet, made.labels, made.data)
    if inputs is report.inputs:
        return replace(report, engines=_agreements(report, computed, every))
    few = _evaluated(made, report.algebra, silent)
    found = _agreements(few, sample.with_own(computed, whole), every)
    given = [axis.name for axis in report.sheet.axes if axis.is_given]
    sizes = [(len(inputs.on(axis).tests), len(report.inputs.on(axis).tests), axis) for axis in given]
    told = listing(["{} of {} {}".format(*size) for size in sizes], last="and")
    of = how_large(whole.sheet, whole.layouts)
    return replace(report, engines=tuple(replace(each, of=of, sample=told) for each in found))


def _agreements(report: Report, values: Values, every: bool) -> tuple[Agreement, ...]:
    """How NumPy's values agree with 50 digits; and what else is installed here, if that is wanted."""
    from .judge import engines
    from .judge.readers import Book, Case, of_values

    made = Prepared(report.inputs, report.sheet)
    labels, exactly = made.labels, made.exact_data
    judge = engines.Judge.of(values.sheet, values.layouts, labels, exactly, report.exactly)
    if not every:
        return (judge.agreement(of_values(values)),)
    case = Case(values.sheet, labels, made.data, values)
    try:
        grid, content = book(report)
        case = replace(case, book=Book(content, grid))
    except UsageError as refused:
        case = replace(case, unmade=refused.diagnostics[0].message)
    return engines.compare_all(judge, case)


def refereed(report: Report, step: Step = silent, keep: Keep = made_anew) -> Report:
    """The report with every published value judged: whether the printed inputs can yield it.

    `step`: told what is begun. `keep`: gives what is made of the folder of the report, made now or before.
    """
    found, comparisons = refereed_values(Prepared(report.inputs, report.sheet), report.values, step, keep)
    return with_uncertainties(replace(report, referee=found, comparisons=comparisons), step)


def with_uncertainties(report: Report, step: Step) -> Report:
    """The report with everything that is published of uncertainties beside what is computed.

    `step`: told what is begun.
    """
    if not report.inputs.published_u:
        return report
    from .referee.uncertain import compare_uncertainties

    compute = partial(computing, report.sheet)
    found = compare_uncertainties(report.inputs, report.values, compute, step)
    return replace(report, comparisons_u=found)


def refereed_values(
    made: Prepared, values: Values, step: Step = silent, keep: Keep = made_anew
) -> tuple[Referee, tuple[Comparison, ...]]:
    """The same of values alone: the verdicts, and every published value with its own."""
    from . import referee
    from .kept_sheet import of_shipped
    from .referee import kept as verdicts

    workbook, given = made.inputs.workbook, made.inputs.given

    def numbers() -> dict[str, list[str]]:
        from .referee.numbers import numbers_of

        return numbers_of(made.sheet, workbook.ledger())

    def known() -> dict[str, list[str]]:
        found: dict[str, list[str]] = of_shipped(workbook, given, "numbers of equations", numbers)
        return found

    def judge() -> Any:
        from .referee.judging import referee as judge

        return verdicts.as_data(judge(made.sheet, made.inputs, values, made.data, step, known), made.inputs)

    found = verdicts.of_data(keep(VERDICTS, judge), made.inputs)
    return found, referee.refereed(
        referee.compare(made.inputs.published, values, made.inputs.expected), found
    )


def shown(column: Column, sheet: Sheet, inputs: Inputs) -> Shown:
    """In which unit a column is shown, and with how many digits.

    What was printed is shown in the unit it was printed in, whatever the workbook would show it in, and so is
    what is to be shown like it.
    The digits of a cell follow from its uncertainty; where that is not known, from the inputs: one more than
    the least precise measured number that the column rests on. Zero and what is exact are no such number.
    """
    from .column import shown_as
    from .result.result import Shown
    from .sheet import Given

    u_of = column.rule.u_of if isinstance(column.rule, Given) else ""
    like = shown_as(column, sheet.by_name)
    unit = like.display or like.unit
    if printed := inputs.numbers(u_of or column.name) or inputs.numbers(like.name):
        unit = printed[0].unit
        if u_of:
            unit = of_differences(parse_unit(unit))  # an uncertainty
    try:
        size = parse_unit(unit)
    except NotAUnit:
        unit, size = column.unit, parse_unit("1")  # an exponent that is a symbol: SI
    digits = []
    for given in (*sheet.ancestors(column), column):
        if isinstance(given.rule, Given) and not given.exact:
            digits += [each.digits for each in inputs.numbers(given.name) if each.value and each.u]
    return Shown(unit, float(size.scale), min(digits, default=5) + 1, float(size.zero))


def refuse_too_many_rows(layouts: Mapping[str, Layout]) -> None:
    """Before anything long is begun."""
    from .engines.excel_grid import MOST_ROWS, TooManyRows, check_rows

    try:
        check_rows(layouts)
    except TooManyRows as error:
        known = f"at most {MOST_ROWS} rows in a worksheet; fewer points_per_pair make fewer rows"
        raise UsageError(diagnose("LS606", reason=error, known=known)) from error


def drawn(inputs: Inputs, sheet: Sheet) -> Drawn:
    """The columns that only the charts ask for."""
    from .charts import Drawn
    from .kept_sheet import drawn_of

    workbook = inputs.workbook
    if workbook.drawn is None:
        return Drawn()
    return drawn_of(workbook, inputs.given, sheet, "curves", partial(workbook.drawn, sheet))


def plotted(values: Values, inputs: Inputs) -> Plotted:
    """What the charts are drawn from."""
    from .engines.numpy import extend
    from .result.result import Plotted

    more = drawn(inputs, values.sheet)
    every = extend(values, more.columns, more.given)
    return Plotted(every, {c.name: shown(c, every.sheet, inputs) for c in every.sheet.columns})


def uncertain(workbook: Workbook, values: Values, inputs: Inputs) -> Uncertainties:
    """The standard uncertainties of the cells, and the budgets of the headline."""
    from .uncertainty.propagation import uncertainties

    with timed("uncertainties"):
        return uncertainties(inputs, values, workbook.headline)


def for_a_grid(report: Report) -> Drawn:
    """What the charts of a worksheet are drawn from."""
    from .charts import with_copies
    from .kept_sheet import drawn_of

    inputs, sheet = report.inputs, report.sheet

    def make() -> Drawn:
        from .engines.excel_grid import with_first_pass

        curves = with_copies(drawn(inputs, sheet), sheet, inputs.workbook.charts)
        return with_first_pass(curves, sheet) or curves

    return drawn_of(inputs.workbook, inputs.given, sheet, "curves of a worksheet", make)


def words_beside(report: Report) -> dict[str, tuple[str, ...]]:
    """The columns of words beside the rows of each table, by index set."""
    given = (axis.name for axis in report.sheet.axes if axis.is_given)
    return {axis: report.inputs.on(axis).remarks for axis in given}


def book(report: Report, charts: bool = True) -> tuple[Grid, bytes]:
    """The sheet as a workbook with live formulas: where its cells are, and the file.

    `charts`: whether it has any.
    """
    refuse_too_many_rows(report.values.layouts)
    from .engines import excel_grid
    from .engines.excel_values import NotPrintable
    from .views import xlsx

    units = {name: how.unit for name, how in report.shown.items()}
    try:
        first, values = report.workbook.headline, report.marks.values
        words, drawn = words_beside(report), for_a_grid(report) if charts else None
        limited = [limits.cell[0] for limits in report.inputs.limits]
        grid = excel_grid.grid(report.sheet, values, units, first, drawn, words, limited)
    except NotPrintable as error:
        known = "a worksheet has the functions and lengths that every spreadsheet has"
        raise UsageError(diagnose("LS606", reason=error, known=known)) from error
    return grid, xlsx.render(report, grid)


def program(report: Report) -> str:
    """The sheet as the page's program, with the curves that the page draws."""
    from .engines import javascript
    from .sheet import Sheet

    curves, sheet = drawn(report.inputs, report.sheet), report.marks.values.sheet
    return javascript.program(Sheet((*sheet.columns, *curves.columns)), curves.given)
