"""The one visible place where the parts are wired: inputs -> sheet -> values -> proofs -> views -> files."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import cost
from .background import Background
from .crate import added
from .errors import ForeignCode, LoopsheetError, UnknownWorkbook, UsageError, close, diagnose, listing
from .folders import INPUTS, PAPER, told
from .inputs import Find, Inputs, load
from .own_workbook import own_workbook
from .prepared import Prepared, given_data
from .provenance import processor, sources
from .staging import put, staged
from .unit_text import UnitError as NotAUnit
from .unit_text import parse_unit
from .workbooks import SHIPPED

if TYPE_CHECKING:
    from ..derivations.equation import Erratum, Ledger
    from ..derivations.proof import Proof, StepProof
    from .agreement import Agreement
    from .charts import Drawn
    from .errors import Diagnostic
    from .grid import Grid
    from .layout import Layout
    from .result import Comparison, Report, Shown
    from .sheet import Column, Sheet
    from .values import Values
    from .verdict import Referee
    from .workbook import FigureSpec, Workbook

__all__ = [
    "FORMATS",
    "PAPER",
    "Prepared",
    "Step",
    "build",
    "checked",
    "compared",
    "compute",
    "find_workbook",
    "given_data",
    "judged",
    "prepare",
    "refereed",
    "shipped_workbook",
    "versions",
]

FORMATS = ("html", "latex", "xlsx", "json", "pdf")
DEFAULT_FORMATS = ("html", "latex", "xlsx", "json")

Step = Callable[[str], None]
"""Told what is begun, for whoever watches."""

_Found = tuple[dict[str, Any], list[dict[str, Any]]]
"""A proof without its equation, and its steps without theirs."""

EXACTLY = 20_000
"""Up to so many cells, a sheet is evaluated at 50 digits, which takes .3 ms a cell, and its values are those,
correctly rounded; of a larger one, some of its tests are."""


def _silent(_: str) -> None:
    """Nobody watches."""


# --- workbooks -------------------------------------------------------------------------------------------


def find_workbook(name: str, folder: Path, code: bytes | None = None) -> Workbook:
    """The workbook of a name: a shipped one, or the user's own ``NAME.py`` in the folder.

    Parameters
    ----------
    name : str
    folder : Path
    code : bytes, optional
        What that file held when it was read. It is run: whoever names a folder to be computed asks for it.

    Raises
    ------
    UnknownWorkbook
        With the names there are.
    InputError
        The user's own workbook cannot be run, or declares none.
    """
    if name in SHIPPED:
        workbook: Workbook = importlib.import_module(SHIPPED[name]).WORKBOOK
        return workbook
    if code is None:
        raise UnknownWorkbook([*SHIPPED, *sorted(p.name for p in folder.glob("*.py"))])
    return own_workbook(folder / name, code)


def shipped_workbook(name: str, folder: Path, code: bytes | None = None) -> Workbook:
    """The same, for whoever did not ask to run what is in the folder.

    Raises
    ------
    ForeignCode
        The workbook is code of the folder.
    """
    if name not in SHIPPED and code is not None:
        raise ForeignCode(name)
    return find_workbook(name, folder, code)


# --- from inputs to values --------------------------------------------------------------------------------


def prepare(folder: Path, find: Find = find_workbook) -> Prepared:
    """Read a folder, lay out its sheet, check dimensions and published cells.

    Parameters
    ----------
    folder : Path
        A report folder.
    find : callable
        :func:`find_workbook`, or :func:`shipped_workbook` if nobody asked to run the folder's own code.

    Raises
    ------
    InputError
        With every finding.
    """
    inputs = load(folder, find, _of_cells)
    return _prepared(inputs, inputs.workbook.ledger())


def _of_cells(inputs: Inputs) -> Sequence[Diagnostic]:
    """What is wrong with the cells that a folder names, if that is asked because something else is wrong."""
    try:
        _prepared(inputs, inputs.workbook.ledger()).check_cells()
    except LoopsheetError as error:
        return error.diagnostics
    return ()


def _prepared(inputs: Inputs, ledger: Ledger) -> Prepared:
    from . import refusals
    from .sheet import SheetError

    own = inputs.workbook.name not in SHIPPED
    try:
        sheet = inputs.workbook.sheet(inputs.given)
        refusals.refuse_what_is_not_stated(sheet, ledger)
    except SheetError as error:
        if not own:
            raise  # ours, and our bug
        raise refusals.of_sheet(inputs, error) from error
    if own:
        from .document.narrative import narratives

        refusals.refuse_what_is_misnamed(sheet, inputs, narratives(), _drawings)
    refusals.refuse_what_is_missing(sheet, inputs)
    return Prepared(inputs, sheet)


def _drawings() -> Collection[str]:
    from .views import figures

    return figures.NAMES


def compute(folder: Path, step: Step = _silent, prove: bool = True, find: Find = find_workbook) -> Report:
    """Compute a whole report.

    Parameters
    ----------
    folder : Path
        A report folder.
    step : callable
        Told what is begun.
    prove : bool
        Whether to check the algebra too.
    find : callable
        As for :func:`prepare`.
    """
    step("reading the folder")
    inputs = load(folder, find, _of_cells)
    ledger = inputs.workbook.ledger()
    report = _evaluated(_prepared(inputs, ledger), ledger, step)
    if not prove:
        return report
    proofs, errata = checked(report.inputs, report.ledger, step)
    return replace(report, proofs=proofs, errata=errata)


def _evaluated(prepared: Prepared, ledger: Ledger, step: Step) -> Report:
    """Everything but the proofs."""
    inputs, sheet = prepared.inputs, prepared.sheet
    from .analysis.oddities import oddities
    from .analysis.referee import compare
    from .layout import how_large
    from .marks import Marks, margins, with_margins
    from .result import Report

    step(f"computing {how_large(sheet, prepared.layouts)} cells")
    inputs = prepared.check_cells()
    workbook, limits = inputs.workbook, margins(sheet)
    exactly, (values, whole) = prepared.computed(with_margins(sheet), EXACTLY)
    report = Report(
        title=inputs.title,
        workbook=workbook,
        inputs=inputs,
        sheet=sheet,
        values=values,
        marks=Marks(whole, limits),
        exactly=exactly,
        shown={column.name: shown(column, sheet, inputs) for column in sheet.columns},
        ledger=ledger,
        proofs=(),
        errata=(),
        comparisons=compare(inputs.published, values),
        curves=workbook.curves(sheet, values) if workbook.curves is not None else (),
        versions=versions(),
    )
    return replace(report, oddities=oddities(report))


def checked(
    inputs: Inputs, ledger: Ledger, step: Step = _silent
) -> tuple[tuple[Proof, ...], tuple[Erratum, ...]]:
    """What is known of the algebra: a proof of each equation, and the errata of the print it is about."""
    from ..derivations.proof import prove

    proofs = prove(ledger, lambda equation: step(f"proving {equation.label}"))
    checks = ledger.checks if inputs.about_source else ()
    return proofs, tuple(found for check in checks if (found := check(ledger)) is not None)


def _checked_plainly(inputs: Inputs, ledger: Ledger) -> tuple[list[_Found], tuple[Erratum, ...]]:
    """The same without equations, for another process: an expression that is sent arrives evaluated."""
    proofs, errata = checked(inputs, ledger)
    return [(_but(p, "equation", "steps"), [_but(s, "step") for s in p.steps]) for p in proofs], errata


def _but(found: Proof | StepProof, *names: str) -> dict[str, Any]:
    return {name: value for name, value in vars(found).items() if name not in names}


def _with_equations(ledger: Ledger, found: Sequence[_Found]) -> tuple[Proof, ...]:
    """The proofs again, of a ledger's own equations and steps."""
    from ..derivations.equation import Derivation
    from ..derivations.proof import Proof, StepProof

    proofs = []
    for entry, (own, rests) in zip(ledger.entries, found, strict=True):
        equation, steps = (entry.claim, entry.steps) if isinstance(entry, Derivation) else (entry, ())
        told = tuple(StepProof(step=step, **rest) for step, rest in zip(steps, rests, strict=True))
        proofs.append(Proof(equation=equation, steps=told, **own))
    return tuple(proofs)


def judged(report: Report, every: bool = True, step: Step = _silent) -> Report:
    """The report with its engines compared with 50 digits.

    Parameters
    ----------
    report : Report
    every : bool
        Whether to run what else is installed too: JavaScript, and the workbook in LibreOffice.
    step : callable
        Told what is begun.
    """
    from .analysis import sample
    from .engines.numpy import evaluate
    from .layout import how_large

    step("judging the engines at 50 digits")
    whole = report.marks.values
    inputs = sample.part(report.inputs, whole, EXACTLY)
    prepared = Prepared(inputs, report.sheet)
    computed = evaluate(whole.sheet, prepared.labels, prepared.data)
    if inputs is report.inputs:
        return replace(report, engines=_agreements(report, computed, every))
    few = _evaluated(prepared, report.ledger, _silent)
    found = _agreements(few, sample.with_own(computed, whole), every)
    rows = next(axis.name for axis in report.sheet.axes if not axis.parents)
    told = f"{len(inputs.tests)} of {len(report.inputs.tests)} {rows}"
    of = how_large(whole.sheet, whole.layouts)
    return replace(report, engines=tuple(replace(each, of=of, sample=told) for each in found))


def _agreements(report: Report, values: Values, every: bool) -> tuple[Agreement, ...]:
    """How NumPy's values agree with 50 digits; and what else is installed here, if that is wanted."""
    from .analysis import engines
    from .analysis.readers import Book, of_values

    prepared = Prepared(report.inputs, report.sheet)
    labels, exactly = prepared.labels, prepared.exact_data
    judge = engines.Judge.of(values.sheet, values.layouts, labels, exactly, report.exactly)
    if not every:
        return (judge.agreement(of_values(values)),)
    try:
        grid, content = _workbook(report)
        book = Book(content, grid)
    except UsageError:
        book = None  # there is no such workbook, and nothing to judge
    return engines.compare_all(judge, values, labels, prepared.data, book)


def refereed(report: Report, step: Step = _silent) -> Report:
    """The report with every published value judged: whether the printed inputs can yield it.

    Parameters
    ----------
    report : Report
    step : callable
        Told what is begun.
    """
    from .analysis import referee

    data = Prepared(report.inputs, report.sheet).data
    found = referee.referee(report.sheet, report.inputs, report.values, data, step)
    return replace(report, referee=found, comparisons=referee.refereed(report.comparisons, found))


def compared(report: Report) -> Report:
    """The report with published.csv read again, after only what is known of differences has changed."""
    from .analysis import referee

    inputs = load(report.inputs.folder, find_workbook)
    comparisons = referee.refereed(referee.compare(inputs.published, report.values), report.referee)
    return replace(report, inputs=inputs, comparisons=comparisons)


def shown(column: Column, sheet: Sheet, inputs: Inputs) -> Shown:
    """In which unit a column is shown, and with how many digits.

    What was printed is shown in the unit it was printed in, whatever the workbook would show it in.
    The digits follow from the inputs: one more than the least precise measured number that the column
    rests on, so that rounding for the reader loses nothing that was measured.
    """
    from .result import Shown
    from .sheet import Given

    unit = column.display or column.unit
    like = column.name if isinstance(column.rule, Given) else ""
    if unit.startswith("like "):
        like = like or unit.removeprefix("like ")
    if printed := inputs.printed(like):
        unit = printed[0].unit
    try:
        scale = float(parse_unit(unit).scale)
    except NotAUnit:
        unit, scale = column.unit, 1.0  # an exponent that is a symbol: SI
    digits = []
    for given in (*sheet.ancestors(column), column):
        if isinstance(given.rule, Given) and not given.exact:
            digits.append(min(printed.digits for printed in inputs.printed(given.name)))
    return Shown(unit, scale, min(digits, default=5) + 1)


def versions() -> dict[str, str]:
    """What computed: this program, its libraries and the interpreter's minor version."""
    from importlib.metadata import version

    printing = ("jinja2", "markdown-it-py", "matplotlib", "latex2mathml", "xlsxwriter")
    from .. import __version__

    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    return {
        "loopsheet": __version__,
        "python": python,
        **{name: version(name) for name in ("numpy", "sympy", "mpmath", *printing)},
    }


# --- from values to files ---------------------------------------------------------------------------------


def parse_formats(words: str) -> tuple[str, ...]:
    """Read ``html,latex``.

    Raises
    ------
    UsageError
        A word is no format, or there is none.
    """
    wanted = [word.strip() for word in words.split(",") if word.strip()]
    for word in wanted or [words]:
        if word not in FORMATS:
            known = close(word, FORMATS)
            hint = f"did you mean '{known}'?" if known else ""
            raise UsageError(
                diagnose("LS604", kind="format", text=word, known=listing(FORMATS), suggestion=hint)
            )
    return tuple(f for f in FORMATS if f in wanted)


def build(
    folder: Path,
    out: Path,
    formats: Collection[str] | None = None,
    step: Step = _silent,
    every_engine: bool = False,
    find: Find = find_workbook,
    tell: Step = _silent,
) -> tuple[Report, list[Path]]:
    """Compute a report and write it.

    Everything is written to a temporary folder first and moved in when all of it is there, so that a
    failure leaves an existing output as it was.

    Parameters
    ----------
    folder : Path
        A report folder.
    out : Path
        Where the report goes; made if it does not exist. Other files in it are left alone.
    formats : collection of str, optional
        Of :data:`FORMATS`. Without it, :data:`DEFAULT_FORMATS`, but no workbook that would be too large.
    step : callable
        Told what is begun.
    every_engine : bool
        Whether JavaScript and the workbook are judged too, by the programs that are installed here.
    find : callable
        As for :func:`prepare`.
    tell : callable
        Told what is built from where once the folder was read and found right, what is left out, and what it
        takes if that is long; which files that somebody had changed are kept; and what a crate of the report
        before had added, which is removed.

    Returns
    -------
    Report
    list of Path
        The files that were written.
    """
    with staged(out, tell, lambda place: _of_a_crate(place, folder)) as stage, ExitStack() as running:
        step("reading the folder")
        inputs = load(folder, find, _of_cells)
        tell(f"building '{inputs.title}' from {told(folder)} into {out}")
        ledger = inputs.workbook.ledger()
        # Everything that takes long has a process of its own, from when there is what it needs.
        proving = running.enter_context(Background(lambda: _checked_plainly(inputs, ledger)))
        prepared = _prepared(inputs, ledger)
        formats = _possible(prepared, formats, tell)
        if long := cost.told(prepared.sheet, prepared.layouts, formats):
            tell(long)
        report = _evaluated(prepared, ledger, step)
        judging = running.enter_context(Background(lambda: judged(report, every_engine).engines))
        refereeing, drawing, workbook = None, None, None
        if report.inputs.published:
            refereeing = running.enter_context(Background(lambda: _refereed(report, formats)))
        if report.workbook.figures and _WITH_FIGURES & set(formats):
            drawing = running.enter_context(
                Background(lambda: _pictures(report, report.workbook.figures, formats))
            )
        program = _program(report) if "html" in formats else ""
        step("proving the equations")
        found, errata = proving.result()
        proved = replace(report, proofs=_with_equations(ledger, found), errata=errata)
        if "xlsx" in formats:
            workbook = running.enter_context(Background(lambda: _workbook(proved)[1]))
        step("judging the engines at 50 digits")
        finished = replace(proved, engines=judging.result())
        pictures: dict[str, bytes] = {}
        if drawing is not None:
            step("drawing the figures")
            pictures = drawing.result()
        if refereeing is not None:
            step("refereeing what was published")
            referee, comparisons, its_pictures = refereeing.result()
            finished = replace(finished, referee=referee, comparisons=comparisons)
            pictures |= its_pictures
        _write(finished, stage, formats, pictures, program, workbook, step)
        names = sorted(p.relative_to(stage) for p in stage.rglob("*") if p.is_file())
    return finished, [out / name for name in names]


def _of_a_crate(out: Path, folder: Path) -> dict[Path, str]:
    """What `crate` added to an output, without what is built from: a crate is built again in itself too."""
    copies, source = (out / INPUTS).resolve(), folder.resolve()
    own = source.is_relative_to(copies)
    return {name: digest for name, digest in added(out).items() if not (own and INPUTS in name.parts)}


_WITH_FIGURES = {"html", "latex", "pdf"}
"""The formats that show figures."""


def _pictures(report: Report, which: Sequence[FigureSpec], formats: Collection[str]) -> dict[str, bytes]:
    """The files of figures, by name."""
    from .views import figures

    drawn: dict[str, bytes] = {}
    for figure in which:
        if "html" in formats:
            drawn[f"{figure.name}.svg"] = figures.svg(report, figure.draw).encode()
        if "latex" in formats or "pdf" in formats:
            drawn[f"{figure.name}.pdf"] = figures.pdf(report, figure.draw)
    return drawn


def _refereed(
    report: Report, formats: Collection[str]
) -> tuple[Referee, tuple[Comparison, ...], dict[str, bytes]]:
    """What the referee found, and its own picture."""
    found = refereed(report)
    pictures: dict[str, bytes] = {}
    if _WITH_FIGURES & set(formats):
        from .views import figures

        own = [figure for figure in figures.of(found) if figure not in report.workbook.figures]
        pictures = _pictures(found, own, formats)
    return found.referee, found.comparisons, pictures


def _program(report: Report) -> str:
    """The sheet as the page's program, with the curves that the page draws."""
    from .engines import javascript

    drawn, sheet = _drawn(report), report.marks.values.sheet
    if drawn is None:
        return javascript.program(sheet)
    return javascript.program(drawn.with_curves(sheet), drawn.given)


def _write(
    report: Report,
    stage: Path,
    formats: Collection[str],
    pictures: Mapping[str, bytes],
    program: str,
    workbook: Background[bytes] | None,
    step: Step,
) -> None:
    from .views import json

    if "json" in formats:
        put(stage / "values.json", json.values(report))
    if "latex" in formats or "pdf" in formats:
        from .views import latex

        step("writing report.tex")
        names = [name.removesuffix(".pdf") for name in pictures if name.endswith(".pdf")]
        put(stage / "report.tex", latex.render(report, names))
    for name, content in pictures.items():
        put(stage / "figures" / name, content)
    if "html" in formats:
        from .views import html

        step("writing report.html")
        svg = {
            name.removesuffix(".svg"): content.decode()
            for name, content in pictures.items()
            if name.endswith(".svg")
        }
        put(stage / "report.html", html.render(report, svg, program))
    if workbook is not None:
        step("writing report.xlsx")
        put(stage / "report.xlsx", workbook.result())
    if "pdf" in formats:
        step("running latexmk")
        latex.compile(stage)
    outputs = {
        p.relative_to(stage).as_posix(): p.read_bytes() for p in sorted(stage.rglob("*")) if p.is_file()
    }
    put(stage / "manifest.json", json.manifest(report, outputs, sources(), processor()))


def _possible(prepared: Prepared, formats: Collection[str] | None, tell: Step) -> Collection[str]:
    """The formats that are asked for; or those that everybody gets, without a workbook that is too large."""
    wanted = DEFAULT_FORMATS if formats is None else formats
    if "xlsx" in wanted:
        try:
            _refuse_too_many_rows(prepared.layouts)
        except UsageError as refused:
            if formats is not None:
                raise
            (reason,) = refused.diagnostics
            tell(f"{reason.message}; {reason.allowed}")
            return [each for each in wanted if each != "xlsx"]
    return wanted


def _refuse_too_many_rows(layouts: Mapping[str, Layout]) -> None:
    """Before anything long is begun."""
    from .engines.excel_grid import MOST_ROWS, TooManyRows, check_rows

    try:
        check_rows(layouts)
    except TooManyRows as error:
        known = f"at most {MOST_ROWS} rows in a worksheet; fewer points_per_pair make fewer rows"
        raise UsageError(diagnose("LS606", reason=error, known=known)) from error


def _drawn(report: Report) -> Drawn | None:
    """What the page and the workbook draw themselves."""
    return None if report.workbook.drawn is None else report.workbook.drawn(report.sheet)


def _workbook(report: Report) -> tuple[Grid, bytes]:
    """The sheet as a workbook with live formulas: where its cells are, and the file."""
    _refuse_too_many_rows(report.values.layouts)
    from .engines import excel_grid
    from .engines.excel import NotPrintable
    from .views import xlsx

    units = {name: how.unit for name, how in report.shown.items()}
    try:
        first, values = report.workbook.headline, report.marks.values
        grid = excel_grid.grid(report.sheet, values, units, first, _drawn(report))
    except NotPrintable as error:
        raise UsageError(
            diagnose("LS606", reason=error, known="functions that every spreadsheet has")
        ) from error
    return grid, xlsx.render(report, grid)
