"""What the referee found about published numbers, for all who tell it: nothing is computed here.

A printed number stands for all values that print so. A *mismatch* is how far a value is from the middle of
the values that print as published, in half units of the last printed digit: at most 1 prints the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .published import PublishedValue
from .quantity import Printed

__all__ = [
    "EXACT",
    "NOT_CHECKABLE",
    "NOT_FOUND",
    "REACHABLE",
    "UNREACHABLE",
    "WITHIN",
    "Explanation",
    "Fit",
    "Referee",
    "TableVerdict",
    "Verdict",
    "Witness",
    "short",
]

EXACT = "exact"
"""The recomputed value prints as published."""
REACHABLE = "reachable"
"""An input that prints as given yields a value that prints as published; it is kept."""
WITHIN = "within-uncertainty"
"""It is not reachable, but nearer than twice the standard uncertainty that the user gave."""
UNREACHABLE = "unreachable"
"""It is certain that no input which prints as given yields it."""
NOT_FOUND = "not found"
"""None was found, and that there is none could not be made certain."""
NOT_CHECKABLE = "not-checkable"
"""The cell has no value to compare with."""


def short(mismatch: float | None) -> float | None:
    """A mismatch for print: it was searched for, and its further digits depend on the machine."""
    return None if mismatch is None else float(f"{mismatch:.6g}")


@dataclass(frozen=True)
class Witness:
    """A given cell and a value of it.

    Parameters
    ----------
    cell : str
    index : tuple of int
    value : float
        In the unit that the cell was printed in; in SI if it was not printed.
    printed : Printed or None
        As it was printed; None for what the publication does not print.
    """

    cell: str
    index: tuple[int, ...]
    value: float
    printed: Printed | None

    @property
    def data(self) -> dict[str, Any]:
        """For JSON."""
        return {"cell": self.cell, "index": list(self.index), "value": float(f"{self.value:.9g}")}


@dataclass(frozen=True)
class Verdict:
    """What can be said of one published value.

    Parameters
    ----------
    verdict : str
        One of the words above.
    low, high : float or None
        The values in SI that inputs which print as given were seen to yield; None where nothing is known.
    bound_low, bound_high : float or None
        What no such input can leave, in SI, by interval arithmetic; None where that is not known.
    mismatch : float or None
        The least that was found, in half units of the last printed digit.
    witness : tuple of Witness
        The input that prints as given and yields it, if one was found.
    u : float or None
        Combined standard uncertainty in SI, where the user gave uncertainties.
    missing : str
        For what is not checkable: what is missing.
    """

    verdict: str
    low: float | None = None
    high: float | None = None
    bound_low: float | None = None
    bound_high: float | None = None
    mismatch: float | None = None
    witness: tuple[Witness, ...] = ()
    u: float | None = None
    missing: str = ""


@dataclass(frozen=True)
class TableVerdict:
    """Whether all values of a table, or of several, can come out of one and the same input.

    Parameters
    ----------
    source : str
        ``Table 2``; ``all`` for all tables together.
    values : int
        How many were asked for together.
    verdict : str
        ``exact``, ``reachable``, ``unreachable``, ``not found`` or ``not-checkable``.
    mismatch : float or None
        The worst of the values, for the best input that was found.
    at_least : float or None
        What the worst mismatch is at least, for whatever input; None without a certificate.
    worst : PublishedValue or None
        A value that is as far off as the worst.
    witness : tuple of Witness
        The best input that was found.
    because : str
        The table that makes it impossible, where a part of the tables already does.
    """

    source: str
    values: int
    verdict: str
    mismatch: float | None = None
    at_least: float | None = None
    worst: PublishedValue | None = None
    witness: tuple[Witness, ...] = ()
    because: str = ""

    @property
    def possible(self) -> bool:
        """Whether one input yields them all, or nothing can be said of it."""
        return self.verdict in (EXACT, REACHABLE, NOT_CHECKABLE)

    @property
    def sentence(self) -> str:
        """The verdict in words."""
        if self.verdict == NOT_CHECKABLE:
            return "some cells have no value to compare with"
        number = f"the {self.values} values" if self.values > 1 else "the value"
        if self.possible:
            how = "as printed" if self.verdict == EXACT else "that prints as given"
            return f"{number} come out of an input {how}, the worst within {self.mismatch:.2f} half units"
        best = f"for the best input the worst is off by {self.mismatch:.2f} half units of its last digit"
        if self.verdict == NOT_FOUND:
            return f"no input was found that prints as given and yields {number}; {best}"
        least = f", and for whatever input by {self.at_least:.2f} at least" if self.at_least else ""
        return f"no input that prints as given yields {number}; {best}{least}"

    @property
    def data(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "source": self.source,
            "verdict": self.verdict,
            "values": self.values,
            "mismatch": short(self.mismatch),
            "at_least": short(self.at_least),
            "because": self.because or None,
            "witness": [each.data for each in self.witness],
        }


@dataclass(frozen=True)
class Explanation:
    """A small change of what is printed with which everything published comes out.

    Parameters
    ----------
    kind : str
        ``misprint`` (one cell), ``truncated`` (a column was cut, not rounded), ``label`` (a number or a row
        stands under another's name) or ``order`` (a list stands in another order).
    cell : str
        The column.
    index : tuple of int
        The row; empty for a scalar or a whole column.
    source : str
        The table, for what is published; ``input`` for what is given.
    printed : str
        As it stands.
    would_print : str
        As it would have to stand.
    also : tuple of str
        Other ways that it could stand, least first.
    mismatch : float
        The worst of all values then.
    changes : int
        How many printed numbers change; a manner of printing that holds for a column counts as one.
    sentence : str
        What is claimed.
    """

    kind: str
    cell: str
    index: tuple[int, ...]
    source: str
    printed: str
    would_print: str
    mismatch: float
    changes: int
    sentence: str
    also: tuple[str, ...] = ()

    @property
    def data(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "kind": self.kind,
            "source": self.source,
            "cell": self.cell,
            "index": list(self.index),
            "printed": self.printed,
            "would_print": self.would_print,
            "also": list(self.also),
            "mismatch": short(self.mismatch),
            "changes": self.changes,
            "sentence": self.sentence,
        }


@dataclass(frozen=True)
class Fit:
    """How well a published average or fit goes with each that the workbook knows.

    Parameters
    ----------
    published : PublishedValue
    mismatch : mapping of column name to float
        The worst mismatch of the tables it was made from and of itself, were it that column's; best first.
    """

    published: PublishedValue
    mismatch: dict[str, float]

    @property
    def best(self) -> str:
        """The column that goes with it best."""
        return next(iter(self.mismatch))

    @property
    def data(self) -> dict[str, Any]:
        """For JSON."""
        value = self.published
        mismatch = {name: short(off) for name, off in self.mismatch.items()}
        return {"source": value.source, "cell": value.cell, "is": self.best, "mismatch": mismatch}


@dataclass(frozen=True)
class Referee:
    """All that the referee found.

    Parameters
    ----------
    values : tuple of Verdict
        In the order of the published values.
    tables : tuple of TableVerdict
        One a source, in the order they are first published.
    joint : TableVerdict or None
        All of them together; None where nothing is published.
    explanations : tuple of Explanation
        Those that change least come first; none where nothing needs one.
    labels : tuple of Explanation
        Printed names of rows that cannot be right.
    fits : tuple of Fit
    free : tuple of str
        The cells that the publication does not print.
    amended : TableVerdict or None
        All tables together if the known misprints of the input are put right; None if none are known.
    misprints : tuple of Explanation
        What else would have to change then, if they do not come out.
    """

    values: tuple[Verdict, ...] = ()
    tables: tuple[TableVerdict, ...] = ()
    joint: TableVerdict | None = None
    explanations: tuple[Explanation, ...] = ()
    labels: tuple[Explanation, ...] = ()
    fits: tuple[Fit, ...] = ()
    free: tuple[str, ...] = ()
    amended: TableVerdict | None = None
    misprints: tuple[Explanation, ...] = ()

    @property
    def data(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "tables": [table.data for table in self.tables],
            "joint": self.joint.data if self.joint is not None else None,
            "explanations": [each.data for each in (*self.explanations, *self.labels)],
            "fits": [fit.data for fit in self.fits],
            "free": list(self.free),
            "amended": self.amended.data if self.amended is not None else None,
            "misprints": [each.data for each in self.misprints],
        }
