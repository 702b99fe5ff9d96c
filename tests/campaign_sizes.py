"""How many campaigns the tests draw at random, and from what seed: the one place for both.

`make test` draws FEW, `make campaigns` ALL; `SEED=7 make campaigns` draws others. A test that draws is marked
`campaigns`, asks for the fixture `sizes`, derives all its dice from `sizes.seed` and says with the fixture
`summary` what it found: a line at the end of the run. A new kind of campaign is a new field here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

SEED = 1


@dataclass(frozen=True)
class Sizes:
    """How many campaigns of each kind are drawn, and what they must have among them at least.

    Parameters
    ----------
    honest : int
        Papers printed as they were computed.
    forged : int
        Papers of each forger that were changed so that somebody could see it.
    engines : mapping of int to int
        For each number of tests, campaigns for NumPy, JavaScript and 50 digits; the 66 pairs of twelve tests
        take their time. Half of them are spoiled.
    workbooks : mapping of int to int
        The same for campaigns that also go through the workbook, which has two tests at least.
    of_each_code : int
        Cells of the campaigns for the engines that have a value, and that have each of the codes.
    overflows : int
        Those with a value that no double holds, which no dependent inherits.
    broken : int
        Cells of them that break a condition.
    program_mutants, workbook_mutants, page_mutants : int
        Changed characters in the programs of the engines, in the formulas of the workbook and in the page.
    stopped : int
        Builds that are ended at a random moment by each signal.
    malformed : int
        Report folders that are nearly right; half as many results.
    stride : int
        At every how many steps of a move of outputs it is ended.
    slips : int
        Campaigns with one decimal sign in the wrong place.
    places : int
        In which the shipped paper is built; the first has all differences at once.
    seed : int
    """

    honest: int
    forged: int
    engines: Mapping[int, int]
    workbooks: Mapping[int, int]
    of_each_code: int
    overflows: int
    broken: int
    program_mutants: int
    workbook_mutants: int
    page_mutants: int
    stopped: int
    stride: int
    slips: int
    malformed: int
    places: int
    seed: int = SEED


FEW = Sizes(
    honest=6,
    forged=1,
    engines={1: 6, 2: 50, 3: 30, 4: 16, 5: 8, 6: 4, 7: 4, 8: 4, 9: 4, 10: 4, 11: 4, 12: 4},
    workbooks={2: 10, 4: 8},
    of_each_code=100,
    overflows=5,
    broken=50,
    program_mutants=80,
    workbook_mutants=30,
    page_mutants=4,
    stopped=1,
    stride=4,
    slips=8,
    malformed=30,
    places=1,
)
ALL = Sizes(
    honest=40,
    forged=7,
    engines={1: 40, 2: 800, 3: 500, 4: 280, 5: 140, 6: 72, 7: 48, 8: 36, 9: 36, 10: 36, 11: 36, 12: 36},
    workbooks={2: 900, 3: 600, 4: 300, 5: 120, 6: 40, 7: 16, 8: 10, 9: 8, 10: 6, 11: 4, 12: 4},
    of_each_code=5000,
    overflows=200,
    broken=1000,
    program_mutants=10_000,
    workbook_mutants=150,
    page_mutants=15,
    stopped=100,
    stride=1,
    slips=500,
    malformed=10_000,
    places=99,
)
assert min(sum(ALL.engines.values()), sum(ALL.workbooks.values())) > 2000

SIZES = {"few": FEW, "all": ALL}
