"""The command line. Every verb is one function here; what it needs is imported when it runs."""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

if TYPE_CHECKING:
    from ..derivations.proof import Proof
    from .result import Report
    from .sheet import Column

__all__ = ["main"]

OK, FINDINGS, USAGE, BUG = 0, 1, 2, 3

_DESCRIPTION = (
    "Reports whose every number is traced to an equation, recomputed and compared with its publication."
)
_EPILOG = """\
Without FOLDER, every command works on the shipped paper.

exit codes:
  0  everything as expected
  1  findings: a proof fails, a published value differs unexpectedly
  2  the input or the command line is wrong; the message says where
  3  a bug of loopsheet

examples:
  loopsheet build                      the report of the shipped paper, in out/
  loopsheet new my-campaign            a folder to start your own from
  loopsheet build my-campaign --to html,pdf
  loopsheet prove "(11)"               how equation (11) follows, step by step
  loopsheet show alpha                 all cells of a column, with all digits
  loopsheet why "alpha[1-2]"           one number: its equation, its proof, what it rests on
"""


def _parser() -> argparse.ArgumentParser:
    from .. import __version__

    parser = argparse.ArgumentParser(
        prog="loopsheet",
        description=_DESCRIPTION,
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"loopsheet {__version__}")
    parser.add_argument("--traceback", action="store_true", help="show where a bug happened")
    verbs = parser.add_subparsers(dest="verb", metavar="COMMAND", required=True)

    def verb(name: str, run: Any, text: str) -> argparse.ArgumentParser:
        sub = verbs.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        sub.set_defaults(run=run)
        return sub

    build = verb("build", _build, "compute a report and write it")
    _folder(build)
    build.add_argument(
        "--out", metavar="DIR", type=Path, default=Path("out"), help="where it goes (default: out)"
    )
    build.add_argument(
        "--to",
        metavar="FORMATS",
        default="html,latex,xlsx,json",
        help="html, latex, xlsx, json, pdf (default: html,latex,xlsx,json)",
    )
    build.add_argument(
        "--engines",
        action="store_true",
        help="judge JavaScript and the workbook too, and put that into the report",
    )
    check = verb(
        "check", _check, "check the proofs, the engines against each other, and the published values"
    )
    _folder(check)
    check.add_argument("--format", choices=("text", "json"), default="text", help="how findings are printed")
    prove = verb("prove", _prove, "prove the algebra of a workbook, or show the proof of one equation")
    prove.add_argument("equation", metavar="EQUATION", nargs="?", help="its number, for example (11) or 12a")
    prove.add_argument("--folder", metavar="FOLDER", type=Path, help="the folder whose workbook is meant")
    show = verb("show", _show, "show a cell: its value, its equation, what it is computed from")
    show.add_argument("cell", metavar="CELL", help="alpha, alpha[1-2], x_m[3] or alpha_mean")
    _folder(show)
    why = verb("why", _why, "tell where one number comes from and what is computed from it")
    why.add_argument("cell", metavar="CELL", help="alpha[1-2], x_m[3] or alpha_mean")
    _folder(why)
    new = verb("new", _new, "make a folder to start a campaign from")
    new.add_argument("folder", metavar="FOLDER", type=Path)
    new.add_argument(
        "--workbook", metavar="NAME", default="soft_impact", help="the method (default: soft_impact)"
    )
    return parser


def _folder(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=Path, help="a folder with a report.toml")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return its exit code."""
    from .errors import LoopsheetError, render_all

    options = argparse.Namespace(traceback=False)
    try:
        options = _parser().parse_args(arguments)
        code: int = options.run(options)
        sys.stdout.flush()
    except LoopsheetError as error:
        print(render_all(error.diagnostics, color=_colored(sys.stderr)), file=sys.stderr)
        return error.exit_code
    except BrokenPipeError:
        # Whoever read us has seen enough; Python would complain once more while closing.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return OK
    except KeyboardInterrupt:
        print("\nstopped; nothing was half-written", file=sys.stderr)
        return 130
    except Exception as error:
        if options.traceback:
            raise
        print(f"bug: {type(error).__name__}: {error}", file=sys.stderr)
        print(
            "This is a fault of loopsheet, not of your input. 'loopsheet --traceback ...' shows where.",
            file=sys.stderr,
        )
        return BUG
    return code


def _colored(stream: TextIO) -> bool:
    return stream.isatty() and "NO_COLOR" not in os.environ


class _Progress:
    """Says what is being done once it has taken longer than a second; on a terminal in one moving line."""

    def __init__(self, stream: TextIO) -> None:
        self.stream, self.begun, self.shown = stream, time.monotonic(), ""

    def __call__(self, text: str) -> None:
        if time.monotonic() - self.begun < 1:
            return
        if self.stream.isatty():
            self.stream.write("\r" + text.ljust(len(self.shown)))
            self.shown = text
        elif (stage := text.split(maxsplit=1)[0]) != self.shown:
            # Not a terminal: one line a stage, however many steps the stage has.
            self.stream.write(f"{stage} ...\n")
            self.shown = stage
        self.stream.flush()

    def __enter__(self) -> _Progress:
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the moving line."""
        if self.stream.isatty() and self.shown:
            self.stream.write("\r" + " " * len(self.shown) + "\r")
            self.stream.flush()


# --- verbs ------------------------------------------------------------------------------------------------


def _build(options: argparse.Namespace) -> int:
    from . import build

    formats = build.parse_formats(options.to)
    with _Progress(sys.stderr) as progress:
        report, files = build.build(
            options.folder or build.PAPER, options.out, formats, progress, options.engines
        )
    for name in report.workbook.headline:
        print(_line(report, name))
    for cell in report.values.errors():
        print(cell.reason)
    findings = _findings(report)
    for finding in findings:
        print(f"finding: {finding}")
    names = {path.name: path for path in files}
    first = next(
        names[n]
        for n in ("report.html", "report.pdf", "report.tex", "report.xlsx", "values.json", "manifest.json")
        if n in names
    )
    print(f"{len(files)} files in {options.out}; look at {first}")
    return FINDINGS if findings else OK


def _check(options: argparse.Namespace) -> int:
    from . import build

    with _Progress(sys.stderr) as progress:
        report = build.compute(options.folder or build.PAPER, progress)
        report = build.judged(report, step=progress)
    findings = _findings(report)
    if options.format == "json":
        import json

        proofs = {p.equation.label: p.status.value for p in report.proofs}
        compared = [
            {
                "source": c.published.source,
                "cell": c.cell.address,
                "printed": c.published.printed.text,
                "again": c.again,
                "verdict": c.verdict,
                "expected": c.as_expected,
            }
            for c in report.comparisons
        ]
        print(
            json.dumps(
                {
                    "findings": findings,
                    "proofs": proofs,
                    "engines": [agreement.data for agreement in report.engines],
                    "published": compared,
                },
                indent=1,
            )
        )
        return FINDINGS if findings else OK
    passed = sum(p.status.passes for p in report.proofs)
    print(f"proofs     {passed} of {len(report.proofs)} equations stand")
    for erratum in report.errata:
        print(f"  erratum  {erratum.sentence}")
    for agreement in report.engines:
        print(f"engine     {agreement.line}")
    same = sum(c.verdict == "same" for c in report.comparisons)
    known = sum(c.verdict == "differs" and c.as_expected for c in report.comparisons)
    print(f"published  {len(report.comparisons)} values: {same} print the same, {known} differ as is known")
    for comparison in report.comparisons:
        if comparison.verdict != "same":
            where = f"{comparison.published.source} {comparison.cell.address}"
            printed, reason = comparison.published.printed.text, comparison.published.reason
            print(f"  {where:28} {printed:>8} -> {comparison.again:>8}  {reason}")
    for finding in findings:
        print(f"finding: {finding}")
    print(f"{len(findings)} findings" if findings else "everything as expected")
    return FINDINGS if findings else OK


def _findings(report: Report) -> list[str]:
    """What is not as expected."""
    found = [finding for agreement in report.engines for finding in agreement.findings]
    for proof in report.proofs:
        if not proof.status.passes:
            why = next((s.sentence for s in proof.steps if not s.status.passes), proof.remark)
            found.append(f"{proof.equation.label} is {proof.status.value}: {why}")
    for c in report.comparisons:
        if not c.as_expected:
            where = f"{c.published.where}: {c.published.source} {c.cell.address}"
            if c.verdict == "same":
                found.append(
                    f"{where} prints {c.published.printed.text} and no longer differs; drop its 'differs'"
                )
            elif c.verdict == "differs":
                found.append(f"{where} prints {c.published.printed.text}, recomputed {c.again}")
            else:
                found.append(f"{where} cannot be checked: {c.cell.reason}")
    return found


def _prove(options: argparse.Namespace) -> int:
    from ..derivations.proof import prove
    from . import build
    from .errors import UsageError, close, diagnose

    folder = options.folder or build.PAPER
    workbook = (
        build.prepare(folder).inputs.workbook
        if options.folder
        else build.find_workbook("soft_impact", folder)
    )
    ledger = workbook.ledger()
    labels = [equation.label for equation in ledger.equations()]
    wanted: list[str] = labels
    if options.equation:
        number = options.equation.strip("()")
        wanted = [e.label for e in ledger.equations() if f"({number})" in (e.label, e.number)]
        if not wanted:
            near = close(f"({number})", labels)
            hint = f"did you mean '{near}'?" if near else ""
            known = ", ".join(labels)
            raise UsageError(
                diagnose("LS604", kind="equation", text=options.equation, known=known, suggestion=hint)
            )
    with _Progress(sys.stderr) as progress:
        proofs = prove(ledger, lambda equation: progress(f"proving {equation.label}"))
    shown = [proof for proof in proofs if proof.equation.label in wanted]
    for proof in shown:
        _print_proof(proof, steps=bool(options.equation))
    if not options.equation:
        for erratum in (found for check in ledger.checks if (found := check(ledger)) is not None):
            print(f"erratum: {erratum.sentence}")
            if erratum.evidence:
                print(f"         {erratum.evidence}")
    failed = [proof for proof in shown if not proof.status.passes]
    print(f"{len(shown) - len(failed)} of {len(shown)} stand")
    return FINDINGS if failed else OK


def _print_proof(proof: Proof, steps: bool) -> None:
    from ..derivations.text import text_of_equation

    print(f"{proof.equation.label:6} {proof.status.value:12} {text_of_equation(proof.equation)}")
    if steps:
        print(f"       {proof.equation.because}")
    for n, found in enumerate(proof.steps, start=1):
        if steps:
            print(f"  {n}.   {found.step.says}")
            premises = "; ".join(premise.label for premise in found.step.premises)
            print(f"       from  {premises or 'nothing: an identity'}")
            print(f"       holds {text_of_equation(found.step.claim)}")
        if steps or not found.status.passes:
            print(f"       {found.status.value}: {found.sentence}")
    if proof.remark:
        print(f"       {proof.remark}")


def _show(options: argparse.Namespace) -> int:
    from ..derivations.text import text_of_equation
    from . import build

    report = build.compute(options.folder or build.PAPER, prove=False)
    column, labels = _find(report, options.cell)
    name = column.name
    print(f"{name}  {column.meaning}  [{report.shown[name].unit}]  {column.source}")
    if column.equation is not None:
        print(f"  {text_of_equation(column.equation)}")
        precedents = ", ".join(precedent.name for precedent in report.sheet.precedents(column))
        print(f"  computed from {precedents or 'nothing'}")
    wanted_labels = set(labels)
    for cell in report.values.cells(name):
        if cell.label in wanted_labels:
            scale = report.shown[name].scale
            print(f"  {cell.address:16} {cell.reason if cell.value is None else repr(cell.value / scale)}")
    return OK


def _why(options: argparse.Namespace) -> int:
    from . import build
    from .errors import UsageError, diagnose, listing
    from .views.why import why

    with _Progress(sys.stderr) as progress:
        report = build.compute(options.folder or build.PAPER, progress)
    column, labels = _find(report, options.cell)
    if len(labels) != 1:
        known = listing(report.values.cell(column.name, label).address for label in labels)
        raise UsageError(diagnose("LS604", kind="single cell", text=options.cell, known=known, suggestion=""))
    print(why(report, column.name, labels[0]))
    return OK


def _find(report: Report, address: str) -> tuple[Column, list[tuple[int, ...]]]:
    """The column of an address such as ``alpha[1-2]``, and the rows that it names: all without an index."""
    from .errors import UsageError, diagnose, listing, suggest

    name, _, index = address.rstrip("]").partition("[")
    if name not in report.sheet:
        names = [column.name for column in report.sheet.columns]
        known, hint = listing(names, most=60), suggest(name, names)
        raise UsageError(diagnose("LS604", kind="cell", text=name, known=known, suggestion=hint))
    column = report.sheet[name]
    labels = report.values.labels(column)
    if not index:
        return column, labels
    wanted = [label for label in labels if "-".join(map(str, label)) == index]
    if not wanted:
        known = listing(["-".join(map(str, label)) for label in labels])
        raise UsageError(diagnose("LS604", kind=f"row of {name}", text=index, known=known, suggestion=""))
    return column, wanted


def _line(report: Report, name: str) -> str:
    """A headline cell in a line, in the digits that its inputs warrant."""
    cell = report.values.cell(name)
    how = report.shown[name]
    column = report.sheet[name]
    if cell.value is None:
        return cell.reason
    rows = report.values.counted.get(name, {})
    left = "".join(f"  (over {n} {axis} that have values)" for axis, n in rows.items())
    unit = "" if how.unit == "1" else f" {how.unit}"
    return f"{name:12} {cell.value / how.scale:#.{how.digits}g}{unit}  {column.meaning} {column.source}{left}"


def _new(options: argparse.Namespace) -> int:
    from . import build, scaffold
    from .errors import UnknownWorkbook, UsageError, diagnose, listing, suggest

    try:
        workbook = build.find_workbook(options.workbook, Path())
    except UnknownWorkbook as error:
        known, hint = listing(error.known), suggest(options.workbook, error.known)
        raise UsageError(
            diagnose("LS604", kind="workbook", text=options.workbook, known=known, suggestion=hint)
        ) from error
    for path in scaffold.new(options.folder, workbook):
        print(path)
    print(f"edit them, then: loopsheet build {options.folder}")
    return OK
