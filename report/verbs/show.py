"""`show`: a cell or a column with all digits."""

from __future__ import annotations

import argparse

from .common import OK, find, folder_argument

HELP = "show a cell: its value, its equation, what it is computed from"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    parser.add_argument("cell", metavar="CELL", help="alpha, alpha[1-2], x_m[3] or alpha_mean")
    folder_argument(parser)


def run(options: argparse.Namespace) -> int:
    """Print a column's equation, and the cells that are asked for."""
    from ...derivations.text import text_of_equation
    from .. import build

    report = build.compute(options.folder or build.PAPER, prove=False)
    column, labels = find(report, options.cell)
    name = column.name
    print(f"{name}  {column.meaning}  [{report.shown[name].unit}]  {column.source}")
    if column.equation is not None:
        print(f"  {text_of_equation(column.equation, report.ledger.vocabulary)}")
        precedents = ", ".join(precedent.name for precedent in report.sheet.precedents(column))
        print(f"  computed from {precedents or 'nothing'}")
    wanted_labels = set(labels)
    for cell in report.values.cells(name):
        if cell.label in wanted_labels:
            scale = report.shown[name].scale
            print(f"  {cell.address:16} {cell.reason if cell.value is None else repr(cell.value / scale)}")
    return OK
