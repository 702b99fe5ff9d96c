"""A finished report: everything a view shows, computed. Views read this and compute nothing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..cells.marks import Marks
from ..cells.values import Cell, Values
from ..inputs.inputs import Inputs, PublishedValue
from ..messages.diagnostics import Check
from ..sheet import Sheet
from ..workbook import Workbook
from .agreement import Agreement
from .uncertain import Uncertainties
from .verdict import (
    OTHERWISE,
    UNAMENDED,
    UNEXPECTED,
    UNEXPLAINED,
    UNPINNED,
    UNREASONED,
    Referee,
    Verdict,
)

if TYPE_CHECKING:
    from ...derivations.equation import Erratum, Ledger
    from ...derivations.proved import Proof
    from ..engines.exact import ExactValues

__all__ = ["Comparison", "Plotted", "Report", "Shown"]


@dataclass(frozen=True)
class Shown:
    """How a column is shown.

    Parameters
    ----------
    unit : str
        The unit it is shown in, as text; ``1`` for a pure number.
    scale : float
        One such unit in SI.
    digits : int
        Significant digits that the inputs warrant: one more than the least precise input behind it.
    """

    unit: str
    scale: float
    digits: int


@dataclass(frozen=True)
class Plotted:
    """What charts are drawn from.

    Parameters
    ----------
    values : Values
        Of the sheet and of the columns that only charts ask for.
    shown : mapping of column name to Shown
        The same for both.
    """

    values: Values
    shown: Mapping[str, Shown]


@dataclass(frozen=True)
class Comparison:
    """A published value beside its recomputation.

    Parameters
    ----------
    published : PublishedValue
        What was printed, and whether a difference is expected.
    cell : Cell
        The recomputed cell.
    again : str
        The recomputed value, printed as the published one is: same unit, same decimals.
    distance : float or None
        Recomputed minus published, in units of the last printed digit; None where there is no value.
    verdict : str
        ``same`` (prints the same), ``differs`` or ``not-checkable`` (the cell has no value).
    finding : str
        What is not as expected, in a word of :mod:`~loopsheet.report.result.verdict`; empty if all is. What
        the referee found reachable differs by no more than the printed digits of the inputs allow, and is
        no finding.
    refereed : Verdict or None
        What the referee says of it; None if it was not asked.
    """

    published: PublishedValue
    cell: Cell
    again: str
    distance: float | None
    verdict: str
    finding: str
    refereed: Verdict | None = None

    @property
    def as_expected(self) -> bool:
        """Whether there is nothing to find."""
        return not self.finding

    @property
    def known(self) -> tuple[str | None, str]:
        """What a view that recalculates shall expect, and what there is to find even so.

        None for a value that shall print as published, and what there is to find if it does not. For a known
        difference what is recomputed then, printed as here; nothing where no number would do.
        """
        published, pin = self.published, self.published.pin
        if not published.expect:
            return None, "" if self.verdict == "differs" and self.as_expected else UNEXPECTED
        if pin is None:
            return "", UNPINNED
        if not pin.holds(published.printed, pin.again):
            return "", OTHERWISE  # another number was published when it was pinned
        even_so = self.finding if self.finding in (UNREASONED, UNEXPLAINED, UNAMENDED) else ""
        return self.again if pin.holds(published.printed, self.again) else pin.again, even_so

    @property
    def word(self) -> str:
        """What the referee says in a word; without it, whether it prints the same."""
        return self.verdict if self.refereed is None else self.refereed.verdict


@dataclass(frozen=True)
class Report:
    """All that is known after the sheet has been computed.

    Parameters
    ----------
    title : str
    workbook : Workbook
    inputs : Inputs
        As the user gave them, with the digits as printed.
    sheet : Sheet
    values : Values
        Every cell, in SI, without a batch dimension.
    marks : Marks
        Which of them lie outside of what is expected.
    exactly : ExactValues or None
        Every cell at 50 digits, for the judge of the engines; then `values` and `marks` are these, rounded
        to the nearest doubles. None where the sheet is too large for that: then they are NumPy's.
    shown : mapping of column name to Shown
    algebra : callable
        Returns the ledger.
    proofs : tuple of Proof
        One for each equation of the ledger, in its order.
    errata : tuple of Erratum
        Findings about the source's print, each made by a check.
    comparisons : tuple of Comparison
        In the order of published.csv.
    comparisons_u : tuple of Comparison
        The same of what is published of uncertainties, each with a cell of its own; empty before the referee
        was asked.
    plotted : callable
        Computes what charts ask for besides.
    uncertain : callable
        Computes the standard uncertainties of the cells.
    engines : tuple of Agreement
        What the judge of the engines found, NumPy first; empty if it was not asked.
    oddities : tuple of Check
        Whether the data of the campaign itself are as expected.
    referee : Referee
        What the referee found; empty if it was not asked.
    versions : mapping of str to str
        What computed it: this program and its libraries.
    """

    title: str
    workbook: Workbook
    inputs: Inputs
    sheet: Sheet
    values: Values
    marks: Marks
    exactly: ExactValues | None
    shown: Mapping[str, Shown]
    algebra: Callable[[], Ledger]
    proofs: tuple[Proof, ...]
    errata: tuple[Erratum, ...]
    comparisons: tuple[Comparison, ...]
    plotted: Callable[[], Plotted]
    uncertain: Callable[[], Uncertainties]
    engines: tuple[Agreement, ...] = ()
    oddities: tuple[Check, ...] = ()
    referee: Referee = field(default_factory=Referee)
    versions: Mapping[str, str] = field(default_factory=dict)
    comparisons_u: tuple[Comparison, ...] = ()

    @property
    def every_comparison(self) -> tuple[Comparison, ...]:
        """Of values and of uncertainties, as they stand in published.csv."""
        if not self.comparisons_u:
            return self.comparisons
        every = (*self.comparisons, *self.comparisons_u)
        return tuple(sorted(every, key=lambda each: each.published.places["value"].line or 0))

    @property
    def ledger(self) -> Ledger:
        """The equations of its workbook."""
        return self.algebra()

    def proof(self, label: str) -> Proof:
        """The proof of an equation by its label, ``(12a)``."""
        return next(proof for proof in self.proofs if proof.equation.label == label)
