"""Page, workbook and NumPy say what 50 digits say, code for code, of campaigns of which half are spoiled.

Each campaign goes through all of them: typed into the page as texts and into the workbook as somebody pastes,
recalculated by LibreOffice.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from campaign_books import workbook_reads
from campaign_judging import Tally, compare
from campaign_sizes import SIZES, Sizes
from random_campaigns import KINDS, Node, drawn, shares

from loopsheet.report.result.agreement import LIMIT

pytestmark = pytest.mark.campaigns


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "size" in metafunc.fixturenames:
        metafunc.parametrize("size", SIZES[metafunc.config.getoption("campaigns")].workbooks)


def test_page_workbook_and_numpy_say_what_fifty_digits_say(
    require: Callable[..., str],
    tmp_path: Path,
    node: Node,
    sizes: Sizes,
    summary: Callable[[str], None],
    size: int,
) -> None:
    number = sizes.workbooks[size]
    how: dict[str, Any] = {"most": 15}  # spreadsheets call numbers equal that differ in later digits
    if number < 30:  # formulas for other parameters, or more rows, take longer to print than to run
        how |= {"variants": (size % 2,), "points": (2,)}
    campaigns = [
        campaign
        for kind, share in shares(size, number).items()
        for campaign in drawn(KINDS[kind](size, **how), share, sizes.seed)
    ]
    tally = Tally()
    readings = workbook_reads(require("soffice", "libreoffice"), tmp_path, campaigns)
    for campaign, reading in zip(campaigns, readings, strict=True):
        compare(campaign, node, tally, reading)
    worst = ", ".join(f"{units:.2f} ({engine})" for engine, units in tally.worst.items())
    summary(
        f"campaigns of {size} tests in page and workbook: {len(campaigns)}, at most {worst} eps x condition"
    )
    summary(f"  their cells: {dict(tally.codes.most_common())}, excused {dict(tally.excused)}")
    assert len(campaigns) >= 0.99 * number
    assert set(tally.worst) == {"numpy", "JavaScript", "xlsx"}
    assert all(0 < units <= LIMIT for units in tally.worst.values())
    assert tally.excused.total() <= max(number / 50, 2)
