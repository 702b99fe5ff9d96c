"""What the reader of a folder refuses, every engine refuses too, with the same code in the same cells."""

import math
from dataclasses import replace
from fractions import Fraction

import pytest
from campaign_judging import Tally, compare
from random_campaigns import SHEETS, Campaign, Node, digits_of, numpy_reads

from loopsheet.derivations.unit_text import parse_unit
from loopsheet.report.cells.values import Status
from loopsheet.report.engines import numpy as engine
from loopsheet.report.inputs.number_text import read_value
from loopsheet.report.messages.errors import Findings, Location
from loopsheet.report.workbooks.soft_impact import WORKBOOK

SHEET, GIVEN = SHEETS[1], ("v", "e", "x_p", "beta", "points_per_pair", "ball_diameter", "target_mass")
DATA = {
    "v": [2.334, 2.940], "e": [0.530, 0.512], "x_p": [23.5e-6, 29.7e-6],
    "beta": [1.5], "points_per_pair": [2.0],
    "ball_diameter": [0.0127], "ball_density": [7800.0], "target_mass": [3.0],
}  # fmt: skip
PAPER = Campaign(1, [1, 2], DATA | digits_of(1, DATA))
NUMBERS = (
    *(-1e300, -1.0, -1e-9, -0.0, 0.0, 1e-300, 1e-100, 0.5, 1.0, 1 + 2**-52, 1.2),
    *(2.0, 2.5, 30.0, 10000.0, 10001.0, 1e300),
)
NOT_FINITE = (math.nan, math.inf, -math.inf)


def edited(name: str, row: int, value: float) -> Campaign:
    column = [value if place == row else datum for place, datum in enumerate(PAPER.data[name])]
    data = PAPER.data | {name: column}
    return replace(PAPER, data=data | digits_of(1, data))


def reader_allows(name: str, value: float) -> bool:
    """Whether a folder with this number, of the unit in SI, is read."""
    declared, findings = WORKBOOK.declared[name], Findings()
    unit = replace(parse_unit(declared.unit), scale=Fraction(1))
    read = read_value(repr(value), unit, declared, Location("made"), findings)
    return read is not None


@pytest.mark.parametrize("name", GIVEN)
def test_engines_refuse_what_the_reader_refuses(node: Node, name: str) -> None:
    """And whatever becomes of the other cells, they say of each what 50 digits say."""
    row, refused, tally, hanging = len(PAPER.data[name]) - 1, 0, Tally(), Tally()
    for value in (*NUMBERS, *NOT_FINITE):
        campaign = edited(name, row, value)
        ours, _ = numpy_reads(campaign, engine.Program.of(SHEET))
        theirs, _ = node.read(campaign, 1)
        allowed = reader_allows(name, value)
        refused += not allowed
        assert (ours.status[name][row] == "ok") == (theirs.status[name][row] == "ok") == allowed, value
        if campaign.data["points_per_pair"][0] < 1e4 or not allowed:  # so many take 50 digits their time
            # Without a rebound to speak of, roundings decide whether x_m is above x_p.
            compare(campaign, node, hanging if name == "e" and abs(value) < 1e-50 else tally)
    assert 3 < refused < len(NUMBERS) + len(NOT_FINITE)
    assert tally.excused.total() == 0


def test_what_is_refused_says_what_is_allowed() -> None:
    data = edited("e", 1, 1.2).data
    values = engine.evaluate(SHEET, PAPER.labels, data)
    assert values.cell("alpha", (1, 2)).reason == (
        "#INPUT! alpha[1-2] needs e[2]: the datum is missing or invalid; it must be between 0 and 1"
    )
    assert values.cell("e", (1,)).status is Status.OK
