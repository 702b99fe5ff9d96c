"""The one visible place where the parts are wired: inputs -> sheet -> values -> proofs -> views -> files."""

from __future__ import annotations

import importlib
import importlib.util
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .background import Background
from .errors import InputError, Location, OutputError, UnknownWorkbook, UsageError, close, diagnose, listing
from .inputs import Inputs, check_published, load
from .unit_text import UnitError as NotAUnit
from .unit_text import parse_unit
from .workbooks import SHIPPED

if TYPE_CHECKING:
    from .grid import Drawn, Grid
    from .result import Report, Shown
    from .sheet import Column, Sheet
    from .workbook import Workbook

__all__ = [
    "FORMATS",
    "PAPER",
    "Step",
    "build",
    "compute",
    "find_workbook",
    "given_data",
    "judged",
    "prepare",
    "versions",
]

PAPER = Path(__file__).resolve().parent.parent / "data" / "soft_steel"
"""The shipped campaign."""

FORMATS = ("html", "latex", "xlsx", "json", "pdf")
DEFAULT_FORMATS = ("html", "latex", "xlsx", "json")

Step = Callable[[str], None]
"""Told what is begun, for whoever watches."""


def _silent(_: str) -> None:
    """Nobody watches."""


# --- workbooks -------------------------------------------------------------------------------------------


def find_workbook(name: str, folder: Path) -> Workbook:
    """The workbook of a name: a shipped one, or the user's own ``NAME.py`` in the folder.

    Raises
    ------
    UnknownWorkbook
        With the names there are.
    InputError
        The user's own workbook cannot be imported, or declares none.
    """
    if name in SHIPPED:
        workbook: Workbook = importlib.import_module(SHIPPED[name]).WORKBOOK
        return workbook
    path = folder / name
    if name.endswith(".py") and Path(name).name == name and path.is_file():
        return _own_workbook(path)
    raise UnknownWorkbook([*SHIPPED, *sorted(p.name for p in folder.glob("*.py"))])


def _own_workbook(path: Path) -> Workbook:
    """Import the user's own code; what it raises is told with its line."""
    from .workbook import Workbook

    spec = importlib.util.spec_from_file_location(f"loopsheet_workbook_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    try:
        spec.loader.exec_module(module)
        found = module.WORKBOOK
    except Exception as error:
        raise InputError(_own_code_failed(path, error)) from error
    if not isinstance(found, Workbook):
        raise InputError(
            diagnose("LS213", Location(path.name), text=path.name, reason="WORKBOOK is no Workbook")
        )
    return found


def _own_code_failed(path: Path, error: Exception) -> Any:
    """A finding at the last line of the user's file that the error passed through."""
    line = getattr(error, "lineno", None) if isinstance(error, SyntaxError) else None
    traceback = error.__traceback__
    while traceback is not None:
        if Path(traceback.tb_frame.f_code.co_filename) == path:
            line = traceback.tb_lineno
        traceback = traceback.tb_next
    source = path.read_text(encoding="utf-8", errors="replace").splitlines()
    shown = source[line - 1] if line is not None and line <= len(source) else ""
    text = shown.strip()
    at = Location(path.name, line, shown.index(text) + 1, len(text), shown) if text else Location(path.name)
    return diagnose("LS213", at, text=path.name, reason=f"{type(error).__name__}: {error}")


# --- from inputs to values --------------------------------------------------------------------------------


def given_data(inputs: Inputs) -> dict[str, Any]:
    """The given columns in SI as exact fractions: a list for a measured column, one for a parameter."""
    data: dict[str, Any] = {name: [p.value for p in column] for name, column in inputs.measured.items()}
    data |= {name: printed.value for name, printed in inputs.parameters.items()}
    return data


@dataclass(frozen=True)
class Prepared:
    """A folder that was read, with its sheet, checked and ready to be computed."""

    inputs: Inputs
    sheet: Sheet

    @property
    def labels(self) -> dict[str, tuple[int, ...]]:
        """Row numbers of the axes that come with the data."""
        return {axis.name: self.inputs.tests for axis in self.sheet.axes if not axis.parents}

    @property
    def exact_data(self) -> dict[str, Any]:
        """What the exact engine starts from."""
        needed = {c.name for c in self.sheet.columns}
        return {name: value for name, value in given_data(self.inputs).items() if name in needed}

    @property
    def data(self) -> dict[str, Any]:
        """What the other engines start from: the nearest doubles."""
        return {
            n: [float(x) for x in v] if isinstance(v, list) else float(v) for n, v in self.exact_data.items()
        }


def prepare(folder: Path) -> Prepared:
    """Read a folder, lay out its sheet, check dimensions and published cells.

    Raises
    ------
    InputError
        With every finding.
    """
    inputs = load(folder, find_workbook)
    from . import units
    from .sheet import SheetError

    try:
        sheet = inputs.workbook.sheet(inputs.given)
        units.check(sheet)
    except SheetError as error:
        if inputs.workbook.name in SHIPPED:
            raise  # ours, and our bug
        raise InputError(diagnose("LS213", text=inputs.workbook.name, reason=str(error))) from error
    return Prepared(inputs, sheet)


def compute(folder: Path, step: Step = _silent, prove: bool = True) -> Report:
    """Compute a whole report.

    Parameters
    ----------
    folder : Path
        A report folder.
    step : callable
        Told what is begun.
    prove : bool
        Whether to check the algebra too.
    """
    report = _evaluated(folder, step)
    return _proved(report, step) if prove else report


def _evaluated(folder: Path, step: Step) -> Report:
    """Everything but the proofs."""
    step("reading the folder")
    prepared = prepare(folder)
    inputs, sheet = prepared.inputs, prepared.sheet
    from .analysis.referee import compare
    from .engines import numpy as engine
    from .result import Report

    step("computing the sheet")
    values = engine.evaluate(sheet, prepared.labels, prepared.data)
    check_published(inputs, {c.name: (c.unit, set(values.labels(c))) for c in sheet.columns})
    workbook = inputs.workbook
    return Report(
        title=inputs.title,
        workbook=workbook,
        inputs=inputs,
        sheet=sheet,
        values=values,
        shown={column.name: shown(column, sheet, inputs) for column in sheet.columns},
        ledger=workbook.ledger(),
        proofs=(),
        errata=(),
        comparisons=compare(inputs.published, values),
        curves=workbook.curves(sheet, values) if workbook.curves is not None else (),
        versions=versions(),
    )


def _proved(report: Report, step: Step) -> Report:
    """The report with its algebra checked."""
    from ..derivations.proof import prove

    ledger = report.ledger
    proofs = prove(ledger, lambda equation: step(f"proving {equation.label}"))
    errata = tuple(found for check in ledger.checks if (found := check(ledger)) is not None)
    return replace(report, proofs=proofs, errata=errata)


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
    from .analysis import engines

    step("judging the engines at 50 digits")
    prepared = Prepared(report.inputs, report.sheet)
    if not every:
        agreement = engines.compare(report.values, prepared.labels, prepared.exact_data)
        return replace(report, engines=(agreement,))
    from .analysis.readers import Book

    try:
        grid, content = _workbook(report)
        book = Book(content, grid)
    except UsageError:
        book = None  # there is no such workbook, and nothing to judge
    agreements = engines.compare_all(report.values, prepared.labels, prepared.data, prepared.exact_data, book)
    return replace(report, engines=agreements)


def shown(column: Column, sheet: Sheet, inputs: Inputs) -> Shown:
    """In which unit a column is shown, and with how many digits.

    The digits follow from the inputs: one more than the least precise measured number that the column
    rests on, so that rounding for the reader loses nothing that was measured.
    """
    from .result import Shown
    from .sheet import Given

    unit = column.display or column.unit
    if unit.startswith("like "):
        name = unit.removeprefix("like ")
        unit = inputs.header_units.get(name) or inputs.parameters[name].unit
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

    libraries = ("numpy", "sympy", "mpmath", "jinja2", "matplotlib", "latex2mathml", "xlsxwriter")
    from .. import __version__

    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    return {"loopsheet": __version__, "python": python, **{name: version(name) for name in libraries}}


# --- from values to files ---------------------------------------------------------------------------------


def parse_formats(words: str) -> tuple[str, ...]:
    """Read ``html,latex``.

    Raises
    ------
    UsageError
        A word is no format.
    """
    wanted = [word.strip() for word in words.split(",") if word.strip()]
    for word in wanted:
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
    formats: Collection[str] = DEFAULT_FORMATS,
    step: Step = _silent,
    every_engine: bool = False,
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
    formats : collection of str
        Of :data:`FORMATS`.
    step : callable
        Told what is begun.
    every_engine : bool
        Whether JavaScript and the workbook are judged too, by the programs that are installed here.

    Returns
    -------
    Report
    list of Path
        The files that were written.
    """
    with _staged(out) as stage:
        report = _evaluated(folder, step)
        if "xlsx" in formats:
            _refuse_too_many_rows(report)
        with (
            Background(lambda: _pictures(report, formats)) as drawing,
            Background(lambda: judged(report, every_engine).engines) as judging,
        ):
            report = _proved(report, step)
            step("judging the engines at 50 digits")
            report = replace(report, engines=judging.result())
            with Background(lambda: _workbook(report)[1] if "xlsx" in formats else b"") as workbook:
                _write(report, stage, formats, drawing, workbook, step)
        names = sorted(p.relative_to(stage) for p in stage.rglob("*") if p.is_file())
    return report, [out / name for name in names]


def _pictures(report: Report, formats: Collection[str]) -> dict[str, bytes]:
    """The files of all figures, by name."""
    if not {"html", "latex", "pdf"} & set(formats) or not report.workbook.figures:
        return {}
    from .views import figures

    drawn: dict[str, bytes] = {}
    for figure in report.workbook.figures:
        if "html" in formats:
            drawn[f"{figure.name}.svg"] = figures.svg(report, figure.draw).encode()
        if "latex" in formats or "pdf" in formats:
            drawn[f"{figure.name}.pdf"] = figures.pdf(report, figure.draw)
    return drawn


def _write(
    report: Report,
    stage: Path,
    formats: Collection[str],
    drawing: Background[dict[str, bytes]],
    workbook: Background[bytes],
    step: Step,
) -> None:
    from .views import json

    if "json" in formats:
        _put(stage / "values.json", json.values(report))
    if "latex" in formats or "pdf" in formats:
        from .views import latex

        step("writing report.tex")
        _put(stage / "report.tex", latex.render(report, [figure.name for figure in report.workbook.figures]))
    step("drawing the figures")
    pictures = drawing.result()
    for name, content in pictures.items():
        _put(stage / "figures" / name, content)
    if "html" in formats:
        from .engines import javascript
        from .views import html

        step("writing report.html")
        drawn = _drawn(report)
        sheet = report.sheet if drawn is None else drawn.with_curves(report.sheet)
        program = javascript.program(sheet, drawn.given if drawn is not None else {})
        svg = {
            name.removesuffix(".svg"): content.decode()
            for name, content in pictures.items()
            if name.endswith(".svg")
        }
        _put(stage / "report.html", html.render(report, svg, program))
    if "xlsx" in formats:
        step("writing report.xlsx")
        _put(stage / "report.xlsx", workbook.result())
    if "pdf" in formats:
        step("running latexmk")
        latex.compile(stage)
    outputs = {
        p.relative_to(stage).as_posix(): p.read_bytes() for p in sorted(stage.rglob("*")) if p.is_file()
    }
    _put(stage / "manifest.json", json.manifest(report.inputs.files, outputs, report.versions))


def _refuse_too_many_rows(report: Report) -> None:
    """Before anything long is begun."""
    from .engines.excel_grid import MOST_ROWS, TooManyRows, check_rows

    try:
        check_rows(report.values)
    except TooManyRows as error:
        known = f"at most {MOST_ROWS} rows in a worksheet; fewer points_per_pair make fewer rows"
        raise UsageError(diagnose("LS606", reason=error, known=known)) from error


def _drawn(report: Report) -> Drawn | None:
    """What the page and the workbook draw themselves."""
    return None if report.workbook.drawn is None else report.workbook.drawn(report.sheet)


def _workbook(report: Report) -> tuple[Grid, bytes]:
    """The sheet as a workbook with live formulas: where its cells are, and the file."""
    _refuse_too_many_rows(report)
    from .engines import excel_grid
    from .engines.excel import NotPrintable
    from .views import xlsx

    units = {name: how.unit for name, how in report.shown.items()}
    try:
        grid = excel_grid.grid(report.sheet, report.values, units, report.workbook.headline, _drawn(report))
    except NotPrintable as error:
        raise UsageError(
            diagnose("LS606", reason=error, known="functions that every spreadsheet has")
        ) from error
    return grid, xlsx.render(report, grid)


def _put(path: Path, content: str | bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content.encode() if isinstance(content, str) else content)


@contextmanager
def _staged(out: Path) -> Iterator[Path]:
    """A temporary folder beside the output, moved in whole when the block ends well."""
    made: list[Path] = []
    try:
        if out.exists() and not out.is_dir():
            raise OutputError(diagnose("LS602", text=str(out)))
        made = [p for p in (out, *out.parents) if not p.exists()]
        out.mkdir(parents=True, exist_ok=True)
        stage = Path(tempfile.mkdtemp(prefix=".loopsheet-", dir=out))
    except OSError as error:
        _remove(made)
        raise OutputError(diagnose("LS601", text=str(out), reason=error.strerror or str(error))) from error
    try:
        yield stage
        _move_in(stage, out)
    except BaseException:
        shutil.rmtree(stage, ignore_errors=True)
        _remove(made)
        raise
    shutil.rmtree(stage, ignore_errors=True)


def _remove(made: list[Path]) -> None:
    """Take back the empty folders that were made."""
    for folder in made:
        try:
            folder.rmdir()
        except OSError:
            return


def _move_in(stage: Path, out: Path) -> None:
    """Put the staged files in place: all of them, or none if one cannot be.

    The manifest comes last and never speaks of half an output. What an earlier build made and this one does
    not is taken away, unless somebody changed it.
    """
    names = sorted(
        (p.relative_to(stage) for p in stage.rglob("*") if p.is_file()),
        key=lambda name: (name.name == "manifest.json", name),
    )
    for name in names:
        _refuse_what_is_in_the_way(out, name)
    before = stage / ".before"
    done: list[tuple[Path, Path | None]] = []
    try:
        for name in (*_stale(out, names), *names):
            target = out / name
            kept = None
            if target.exists():
                kept = before / name
                kept.parent.mkdir(parents=True, exist_ok=True)
                os.replace(target, kept)
            done.append((target, kept))
            if name in names:
                target.parent.mkdir(parents=True, exist_ok=True)
                os.replace(stage / name, target)
    except BaseException as error:
        for target, kept in reversed(done):
            target.unlink(missing_ok=True)
            if kept is not None:
                os.replace(kept, target)
        if isinstance(error, OSError):
            reason = error.strerror or str(error)
            raise OutputError(diagnose("LS601", text=str(out), reason=reason)) from error
        raise


def _refuse_what_is_in_the_way(out: Path, name: Path) -> None:
    """A folder where a file goes, or a file where a folder goes, is the user's: nothing is done then."""
    if (out / name).is_dir():
        raise OutputError(diagnose("LS601", text=name.as_posix(), reason="a folder has this name"))
    for parent in name.parents[:-1]:
        if (out / parent).exists() and not (out / parent).is_dir():
            raise OutputError(diagnose("LS601", text=name.as_posix(), reason=f"{parent} is a file"))


def _stale(out: Path, names: Collection[Path]) -> list[Path]:
    """What the manifest of an earlier build lists, unchanged since, and this build does not make."""
    import hashlib
    import json

    try:
        listed = json.loads((out / "manifest.json").read_text(encoding="utf-8"))["outputs"]
        known = {Path(name): str(digest) for name, digest in listed.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return []  # no earlier build, or a manifest that is not ours
    found = []
    for name, digest in sorted(known.items()):
        path = out / name
        if (
            name in names
            or name.is_absolute()
            or ".." in name.parts
            or path.is_symlink()
            or not path.is_file()
        ):
            continue
        if hashlib.sha256(path.read_bytes()).hexdigest() == digest:
            found.append(name)
    return found
