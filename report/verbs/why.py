"""`why`: where one number comes from."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING

from .common import OK, find_one, folder_argument, keeping_arguments, studied

if TYPE_CHECKING:
    from ..study import Study

HELP = "tell where one number comes from and what is computed from it"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    parser.add_argument("cell", metavar="CELL", help="alpha[1-2], x_m[3] or alpha_mean")
    folder_argument(parser)
    keeping_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Print what the formula bar of the page tells of a cell."""
    with studied(options.folder) as study:
        told = study.kept("why", lambda: _told(study, options.cell), options.cell)
    print(told)
    return OK


def _told(study: Study, address: str) -> str:
    from ..views.why import equations_of, why

    column, label = find_one(report := study.computed, address)
    return why(replace(report, proofs=study.proofs(equations_of(report, column))), column.name, label)
