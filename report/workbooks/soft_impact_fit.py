"""The workbook of the soft-impact paper with one curve fitted to all tests at once."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..charts import BLUE, Chart, Series
from ..workbook import FigureSpec, TableSpec
from .soft_impact import WORKBOOK as PAPER

if TYPE_CHECKING:
    from ...derivations.equation import Ledger
    from ..sheet import Sheet

__all__ = ["WORKBOOK"]


def _ledger() -> Ledger:
    from ...derivations.global_fit import LEDGER

    return LEDGER


def _sheet(given: frozenset[str]) -> Sheet:
    from .soft_impact_fit_sheet import sheet

    return sheet(given)


_ESTIMATES = ("alpha_eiv", "alpha_mean", "alpha_median", "alpha_log", "alpha_lin")
_MISFITS = Chart(
    "misfit of each test",
    "impact speed of the test",
    "misfit in standard deviations",
    (Series("v", "z_eiv", "%s", "points", BLUE, named=True),),
)

WORKBOOK = replace(
    PAPER,
    name="soft_impact_fit",
    title="Exponent of the force law from all drop tests at once",
    ledger=_ledger,
    sheet=_sheet,
    headline=("alpha_eiv", "C_eiv", "chi2_eiv", *PAPER.headline),
    prose="soft_impact_fit",
    tables=(
        *PAPER.tables,
        TableSpec(
            "estimates", "Exponent of one curve for all tests, by five estimates", _ESTIMATES, number="L6"
        ),
        TableSpec(
            "common",
            "The curve nearest to all tests",
            ("alpha_eiv", "u_alpha_eiv", "u_birge_eiv", "F_eiv", "x_0", "C_eiv", "chi2_eiv", "birge_eiv"),
            number="L4",
        ),
        TableSpec(
            "adjusted",
            "Each test on that curve: adjusted values, and how far off it was measured",
            ("v_eiv", "e_eiv", "x_p_eiv", "x_m_eiv", "R_eiv", "z_eiv"),
            number="L5",
        ),
    ),
    figures=(
        *PAPER.figures,
        FigureSpec(
            "misfits",
            "L2",
            "Misfit of each test: how far its measured depth lies beside the one that follows from its speed "
            "and its restitution on the common curve, in standard deviations.",
            alt="One mark for each test, its misfit over its impact speed.",
            chart=_MISFITS,
        ),
    ),
)
