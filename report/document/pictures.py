"""All figures of a report: those of its workbook, and those that are of no workbook."""

from __future__ import annotations

from dataclasses import replace

from ..result.result import Report
from ..workbook import FigureSpec
from . import cards, refereed


def figures(report: Report) -> tuple[FigureSpec, ...]:
    """The workbook's, then the referee's and those of cards, with the numbers that are left."""
    found = list(report.workbook.figures)
    for spec in (*refereed.figures(report), *cards.figures(report.cards())):
        taken = {each.number for each in found}
        number = next(f"L{n}" for n in range(1, len(taken) + 2) if f"L{n}" not in taken)
        found.append(replace(spec, number=number))
    return tuple(found)
