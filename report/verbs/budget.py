"""`budget`: where the uncertainty of one number comes from."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING

from ..distribution import LEVEL
from .common import answer, count, find_one, folder_argument, format_argument, keeping_arguments, studied

if TYPE_CHECKING:
    from ..study import Study

HELP = "tell how uncertain one number is, and where that comes from"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    parser.add_argument("cell", metavar="CELL", help="alpha[1-2], x_m[3] or alpha_mean")
    folder_argument(parser)
    said = "coverage probability of the expanded uncertainty in percent (default: 95)"
    parser.add_argument("--level", metavar="P", type=_level, default=LEVEL, help=said)
    said = "draw the inputs so many times at most, and tell what the results are spread over (JCGM 101)"
    parser.add_argument("--draws", metavar="N", type=count, help=said)
    parser.add_argument("--seed", metavar="N", type=count, default=1, help="of the draws (default: 1)")
    format_argument(parser, "text", "markdown", "json")
    keeping_arguments(parser)


def _level(text: str) -> float:
    """Read a probability in percent, for argparse."""
    try:
        percent = float(text.rstrip("% "))
    except ValueError:
        percent = 0.0
    if not 1 <= percent < 100:
        instead = f"; write {100 * percent:.12g}" if 0.01 <= percent < 1 and "%" not in text else ""
        said = f"not a probability from 1 to below 100 percent: '{text}'{instead}"
        raise argparse.ArgumentTypeError(said)
    return percent / 100


def run(options: argparse.Namespace) -> int:
    """Print the budget of a cell; exit code 1 if it has no value."""
    with studied(options.folder) as study:
        _refuse_too_few(options.draws, options.level)
        draws = str(options.draws or 0), str(options.seed)
        parts = options.cell, options.format, repr(options.level), *draws
        told = study.kept("budget", lambda: _told(study, *parts), *parts)
    return answer(*told)


def _refuse_too_few(draws: int | None, level: float) -> None:
    from ..messages.errors import wrong
    from ..uncertainty.monte_carlo import BEYOND, least

    if draws is not None and draws < (number := least(level)):
        reason = f"--draws {draws} tells nothing of an interval of {100 * level:.12g} %"
        known = (
            f"at least {number}, of which some {BEYOND} lie beyond each end; 1000000 is usual (JCGM 101, 7.2)"
        )
        raise wrong(reason, known)


def _told(study: Study, address: str, form: str, level: str, draws: str, seed: str) -> tuple[str, bool]:
    """What is told, and whether the cell has a value."""
    from ..uncertainty.monte_carlo import draw
    from ..uncertainty.propagation import Spread
    from ..views.budget import FORMATS, Besides

    column, label = find_one(report := study.computed, address)
    spread = Spread(report.inputs, report.values)
    row = report.values.row(column, label)
    budget, drawn = spread.budget(column.name, row, float(level)), None
    if int(draws) and (budget.u > 0 or budget.unlooked):
        drawn = draw(report.inputs, report.values, budget, int(draws), int(seed), study.step)
    limited = [each for each in report.inputs.limits if each.cell == (column.name, tuple(label))]
    scattered = spread.scattered(column.name, float(level))
    besides = Besides(drawn, tuple(map(spread.conformity, limited)), scattered)
    told = FORMATS[form](report, budget, besides)
    return told, not math.isnan(budget.value)
