"""Which published values cannot come out together, whatever all the others are.

A change of the print that touches none of the values of a conflict cannot explain it. A conflict is certain
if a certificate says so; if it is only that no search met it, the changes that it speaks against stay open.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass

import numpy as np

from .certificate import Certificate
from .minimax import Best, best, meet
from .problem import Problem


@dataclass(frozen=True)
class Conflict:
    """Published values that do not come out together."""

    values: frozenset[int]
    """Their places among the problem's."""
    certain: bool
    """Whether a certificate says that no input yields them."""


class Conflicts:
    """The conflicts of a problem, as they are found."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.certificate = Certificate(problem)
        self.known: list[Conflict] = []
        self.met: list[tuple[frozenset[int], Best]] = []
        """Sets of values without which the others come out, and an input that yields these."""

    def without(self, values: Set[int]) -> Conflict | Best:
        """A conflict among all values but some; an input that yields the others if there is none."""
        for known in self.known:
            if not known.values & values:
                return known
        for left_out, found in self.met:
            if left_out <= values:
                return found
        return self._asked(frozenset(values))

    def _asked(self, values: frozenset[int]) -> Conflict | Best:
        rest, problem = frozenset(range(len(self.problem.published))) - values, self.problem.ignoring(values)
        found = best(problem)
        certain = found.mismatch > 1 and self.certificate.at_least(found.weights) > 1
        if not certain:
            found = meet(problem, found=found)
        if found.mismatch <= 1:
            self.met.append((values, found))
            return found
        members = frozenset(found.pressing.tolist()) or self._without_value(rest, found)
        conflict = Conflict(members, certain or self.certificate.at_least(found.weights) > 1)
        # Few values may come out of another input; then the search was led astray by the others.
        if not conflict.certain and members != rest and self._alone(members).mismatch <= 1:
            conflict = Conflict(rest, certain=False)
        self.known.append(conflict)
        self.known.sort(key=lambda each: not each.certain)  # what is certain speaks first
        return conflict

    def _alone(self, members: frozenset[int]) -> Best:
        """The best input for some values alone."""
        others = frozenset(range(len(self.problem.published))) - members
        return meet(self.problem.ignoring(others), until=1.0)

    def _without_value(self, rest: frozenset[int], found: Best) -> frozenset[int]:
        """A value that no input was found for; all if each has one somewhere."""
        missing = sorted(n for n in rest if not np.isfinite(found.cells[n]))
        none = (n for n in missing if not np.isfinite(self._alone(frozenset({n})).mismatch))
        first = next(none, None)
        return rest if first is None else frozenset({first})
