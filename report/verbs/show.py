"""`show`: a cell or a column with all digits."""

from __future__ import annotations

import argparse
from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

from .common import OK, answer, find, folder_argument, keeping_arguments

if TYPE_CHECKING:
    from ..result.result import Report
    from ..sheet import Column

HELP = "show a cell: its value, its equation, what it is computed from"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    parser.add_argument("cell", metavar="CELL", help="alpha, alpha[1-2], x_m[3] or alpha_mean")
    folder_argument(parser)
    said = "show what is computed for the column instead, node by node; CELL may be 'all'"
    parser.add_argument("--plan", action="store_true", help=said)
    keeping_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Print an equation and the cells that are asked for; exit code 1 if one of them has no value."""
    from ..inputs.folders import report_folder
    from ..study import Study

    study = Study(report_folder(options.folder))
    if options.plan:
        print(study.kept("plan", lambda: _plan(study.computed, options.cell), options.cell), end="")
        return OK
    return answer(*study.kept("show", lambda: _told(study.computed, options.cell), options.cell))


def _told(report: Report, address: str) -> tuple[str, bool]:
    """What is told, and whether all cells that are asked for have a value."""
    column, labels = find(report, address)
    known = all(report.values.cell(column.name, label).value is not None for label in labels)
    return "\n".join(_lines(report, column, labels)), known


def _plan(report: Report, address: str) -> str:
    from ..plan.lowering import lowered
    from ..plan.text import text

    plan = lowered(report.sheet)
    if address == "all" and address not in report.sheet:
        return text(plan)
    column, _ = find(report, address)
    return text(plan, [column.name])


def _lines(report: Report, column: Column, labels: Collection[tuple[int, ...]]) -> Iterator[str]:
    from ...derivations.text import text_of_equation

    name = column.name
    yield f"{name}  {column.meaning}  [{report.shown[name].unit}]  {column.source}"
    if column.equation is not None:
        yield f"  {text_of_equation(column.equation, report.ledger.vocabulary)}"
        precedents = ", ".join(precedent.name for precedent in report.sheet.precedents(column))
        yield f"  computed from {precedents or 'nothing'}"
    wanted_labels, marks = set(labels), report.marks.of(name)
    # What is given has the digits it was given with, no others.
    every = report.values.labels(column)
    texts = [printed.text if printed else "" for printed in report.inputs.printed(name)]
    if name in report.inputs.taken:  # what was computed has those that its uncertainty tells
        texts = [figure.plain if figure else "" for figure in report.figures(name)]
    given = dict(zip(every, texts, strict=True)) if len(texts) == len(every) else {}
    names = {
        label: f"{word}  "
        for label, word in report.words(column).items()
        if not report.values.word(column, label)  # stands there already
    }
    wide = max(map(len, names.values()), default=0)
    nothing = [0.0] * len(every)
    uncertain = report.uncertain().u.get(name, nothing)
    for row, (cell, mark) in enumerate(zip(report.values.cells(name), marks, strict=True)):
        if cell.label in wanted_labels:
            value = (
                cell.reason
                if cell.value is None
                else given.get(cell.label) or report.shown[name].digits_of(cell.value)
            )
            u = f"  u {report.sure(name, uncertain[row]).plain}" if uncertain[row] > 0 else ""
            called = names.get(cell.label, "").ljust(wide)
            yield f"  {cell.address:16} {called}{value}{u}{mark and f'  {mark}'}"
    for count in report.marks.behind(column):
        if count.number or count.margin.limit.source:
            yield f"  {count.said}"
