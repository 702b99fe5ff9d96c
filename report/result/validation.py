"""The record of a validation: report folders whose results are published, computed here and now."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..messages.diagnostics import Check
from .findings import checks
from .verdict import UNEXPECTED

if TYPE_CHECKING:
    from .result import Comparison, Report

NOTHING = "NOTHING TO COMPARE"
"""Said where nothing is published, so that no number was held against another."""


MISSING = "a program is not installed"
"""Why an engine is not checked; whatever else is not says why itself."""


@dataclass(frozen=True)
class Example:
    """One report folder, with all that is checked of it."""

    name: str
    """What the record calls it."""
    report: Report
    """From :meth:`of`."""

    @classmethod
    def of(cls, name: str, report: Report) -> Example:
        """What is checked of a report with proofs, engines and referee.

        A published number has to print the same, or to be a known difference: that the printed inputs might
        yield it excuses an author, but no program that is given the author's inputs.
        """

        def strict(each: Comparison) -> Comparison:
            is_wrong = each.verdict == "differs" and not each.published.expect
            return replace(each, finding=UNEXPECTED) if is_wrong else each

        values, uncertainties = (
            tuple(map(strict, every)) for every in (report.comparisons, report.comparisons_u)
        )
        return cls(name, replace(report, comparisons=values, comparisons_u=uncertainties))

    @property
    def checks(self) -> tuple[Check, ...]:
        """Everything that was checked, by names that no other example has."""
        return tuple(
            replace(check, name=f"{self.name}: {check.name}", at=replace(check.at, path=""))
            for check in checks(self.report)
        )

    @property
    def compares(self) -> bool:
        """Whether anything is published of it: without, nothing was validated."""
        return bool(self.report.every_comparison)

    @property
    def word(self) -> str:
        """What came of it."""
        return "FAIL" if self.failed else "PASS" if self.compares else NOTHING

    @property
    def failed(self) -> tuple[Check, ...]:
        """What is not as expected."""
        return tuple(check for check in self.checks if not check.passed)


@dataclass(frozen=True)
class Validation:
    """What was run on a machine, and what came of it."""

    examples: tuple[Example, ...]
    by: Mapping[str, str]
    """What computed it: versions, fingerprints of the sources, the machine."""

    @property
    def checks(self) -> tuple[Check, ...]:
        """Of all examples."""
        return tuple(check for example in self.examples for check in example.checks)

    @property
    def passed(self) -> bool:
        """Whether everything is as expected."""
        return all(check.passed for check in self.checks)

    @property
    def verdict(self) -> str:
        """The same in a line."""
        found = self.checks
        failed, skipped = sum(not each.passed for each in found), [each for each in found if each.skipped]
        number = len(self.examples)
        some = f"{len(found)} checks of {number} example{'s' * (number != 1)}"
        why = Counter(MISSING if each.kind == "engine" else each.message for each in skipped)
        rest = "".join(f", {times} not checked: {said}" for said, times in why.items())
        if not self.passed:
            return f"FAIL: {failed} of {some}{rest}"
        silent = [example.name for example in self.examples if not example.compares]
        if len(silent) == number:
            return f"{NOTHING}: no value is published; {some}{rest} pass"
        more = f"; nothing to compare in {', '.join(silent)}" if silent else ""
        return f"PASS: {some}{rest}{more}"
