"""What a folder says of cells, held against those that the sheet has."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType

from ..messages.errors import Findings
from .expected import Cells, Expectation, Words, check_expected
from .inputs import Inputs
from .limits import check_limits, of_every_row
from .measurements import Measurements
from .published import check_published


def check_cells(
    inputs: Inputs,
    cells: Cells,
    words: Words = MappingProxyType({}),
    beneath: Mapping[str, Collection[Measurements]] = MappingProxyType({}),
) -> Inputs:
    """Check all that was read of cells against those of the sheet.

    What is said of a cell that is missing because a test is left out is set aside.

    Parameters
    ----------
    inputs : Inputs
        What was read.
    beneath : mapping of str to collection of Measurements
        For each cell the tables whose rows its own are made of.

    Returns
    -------
    Inputs
        Those without what was set aside.

    Raises
    ------
    InputError
        With every cell, index and test that there is not, and every unit of another dimension.
    """

    def gone(tables: Iterable[Measurements]) -> set[int]:
        return {each.test for table in tables for each in table.left_out}

    def rests_on_gone(name: str, index: tuple[int, ...]) -> bool:
        there = cells[name][1] if name in cells else (index,)
        if index in there:
            return False
        # Groups are known by their words, also those that have no row left.
        lost = gone(beneath.get(name, inputs.tables))
        return index in words[name] if words.get(name) else not lost.isdisjoint(index)

    def is_gone(said: Expectation) -> bool:
        name, index = said.cell
        if not name:
            return not gone(said.tables(inputs.tables)).isdisjoint(index)
        return all(rests_on_gone(name, row) for row in said.rows or (index,))

    inputs = replace(
        inputs,
        expected=tuple(each.of_words(words).in_table(inputs.tables) for each in inputs.expected),
        limits=tuple(each.of_words(words) for each in inputs.limits),
        published=tuple(each.of_words(words) for each in inputs.published),
        published_u=tuple(each.of_words(words) for each in inputs.published_u),
    )
    every = (*inputs.published, *inputs.published_u)
    aside = tuple(value for value in every if rests_on_gone(value.columns[0], value.index))
    undecided = tuple(each for each in inputs.limits if rests_on_gone(*each.cell))
    kept = replace(
        inputs,
        expected=tuple(each for each in inputs.expected if not is_gone(each)),
        limits=tuple(each for each in of_every_row(inputs.limits, cells) if each not in undecided),
        undecided=undecided,
        published=tuple(value for value in inputs.published if value not in aside),
        published_u=tuple(value for value in inputs.published_u if value not in aside),
        aside=aside,
    )
    findings = Findings()
    check_expected(kept.expected, kept.tables, cells, findings, words)
    written = {each.at: each for each in reversed(kept.limits)}  # what is wrong with a line is told once
    check_limits([*reversed(written.values())], cells, findings, words)
    check_published((*kept.published, *kept.published_u), kept.free_at, cells, kept.tables, findings, words)
    findings.check()
    return kept
