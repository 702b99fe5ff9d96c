"""What every search for an explanation shares: which changes are worth a search, and what became of it.

The values of a conflict cannot come out together, whatever all the others are: a change of the print that
touches none of them cannot explain it. A conflict is certain if a certificate says so; if it is only that no
search met it, the changes that it speaks against stay open.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..result.verdict import Change, Explanation
from .certificate import Certificate, excluded
from .comparison import prints_same
from .minimax import Best, best, meet
from .problem import Box, Problem

HOPELESS = 3.0
"""What is promised to stay so many half units off is not looked into further, and stays open."""
LOOKED_INTO = 6
"""How many of the changes of a kind are looked into that differ in little, such as a power of ten."""


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


@dataclass(frozen=True)
class Explained:
    """An explanation, and the problem as it would be."""

    explanation: Explanation
    problem: Problem
    box: Box
    best: Best
    alone: bool = False
    """Whether everything comes out of this change alone, all else being exactly as it is printed."""


class Search:
    """The search for what would explain that published values do not come out of one input.

    A change is dropped only if it is certain that it explains nothing; what was searched for in vain is left
    open and counted.

    Parameters
    ----------
    problem : Problem
        One that cannot be met.

    Attributes
    ----------
    excluded, open : int
        How many changes certainly explain nothing, and of how many that is not certain.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem, self.conflicts = problem, Conflicts(problem)
        self.excluded = self.open = 0
        self.groups: dict[tuple[str, str], list[int]] = {}
        for n, value in enumerate(problem.published):
            self.groups.setdefault((value.source, value.cell), []).append(n)

    @cached_property
    def differing(self) -> list[int]:
        """The published values that do not print as they are recomputed."""
        problem = self.problem
        both = zip(problem.published, problem.at(problem.box.start).cells.tolist(), strict=True)
        return [n for n, (value, cell) in enumerate(both) if not prints_same(cell, value.printed)]

    def resting_on(self, unknowns: Iterable[int]) -> frozenset[int]:
        """The published values that rest on some unknowns."""
        touched = self.problem.touched[:, list(unknowns)].any(axis=1)
        return frozenset(np.flatnonzero(touched).tolist())

    def worth(self, touches: Iterable[int]) -> bool:
        """Whether without these values the others come out; a change that touches no more may explain it."""
        found = self.conflicts.without(frozenset(touches))
        if isinstance(found, Conflict):
            self.drop(found.certain)
            return False
        return True

    def drop(self, certain: bool) -> None:
        """Count a change that explained nothing."""
        if certain:
            self.excluded += 1
        else:
            self.open += 1

    def met(self, problem: Problem, box: Box | None = None, wide: bool = False) -> Best | None:
        """An input that yields all values of a changed problem; None, and counted, if there is none.

        `box`: that of the printed digits, if left out. `wide`: whether the box is so wide that nothing is
        certain in it: then any such input will do, and a search that comes near none is given up.
        """
        until = 1.0 if wide else 0.0
        found = best(problem, box, until)
        if found.mismatch > 1:
            if not wide and Certificate(problem, box).at_least(found.weights) > 1:
                self.drop(certain=True)
                return None
            found = meet(problem, box, found, until)
        if found.mismatch > 1:
            self.drop(certain=False)
            return None
        return found

    def met_if_hopeful(self, problem: Problem, box: Box) -> Best | None:
        """The same of one of many changes: an input is sought only where the derivatives promise one."""
        first = best(problem, box, unless=-1.0)
        if first.promised > HOPELESS:
            self.drop(Certificate(problem, box).at_least(first.weights) > 1)
            return None
        return self.met(problem, box)

    def likeliest(self, asked: Sequence[tuple[Problem, Box | None]]) -> list[tuple[int, Best]]:
        """Of many changes of a kind, those that explain it: those are looked into that promise most.

        Parameters
        ----------
        asked : sequence of (Problem, Box or None)
            As for :meth:`met`.

        Returns
        -------
        list of (int, Best)
            Which, and with what input.
        """
        promised = [best(problem, box, unless=-1.0).promised for problem, box in asked]
        order = sorted(range(len(asked)), key=lambda n: (promised[n], n))
        hopeful = [n for n in order[:LOOKED_INTO] if promised[n] <= HOPELESS]
        self.open += len(asked) - len(hopeful)
        found = [(n, self.met(*asked[n])) for n in sorted(hopeful)]
        return [(n, now) for n, now in found if now is not None]

    def if_met(self, changes: list[Change], problem: Problem, box: Box | None = None) -> Iterator[Explained]:
        """What changes of the print explain, if an input then yields all values."""
        found = self.met(problem, box)
        if found is not None:
            yield self.explained(changes, problem, box or problem.box, found)

    def of_likeliest(self, tried: Sequence[tuple[Change, Problem, Box | None]]) -> Iterator[Explained]:
        """What each of many changes of a kind explains, of those that promise most."""
        for place, found in self.likeliest([(problem, box) for _, problem, box in tried]):
            change, problem, box = tried[place]
            yield self.explained([change], problem, box or problem.box, found)

    def alive(self, boxes: Sequence[Box], problem: Problem | None = None) -> list[int]:
        """The boxes that may hold an input that yields all values."""
        if not boxes:
            return []
        return np.flatnonzero(~excluded(problem or self.problem, boxes)).tolist()

    def screened(self, boxes: Sequence[Box]) -> list[int]:
        """The same, one box a change: the others are excluded."""
        alive = self.alive(boxes)
        self.excluded += len(boxes) - len(alive)
        return alive

    def explained(
        self, changes: Sequence[Change], problem: Problem, box: Box, found: Best, alone: bool = False
    ) -> Explained:
        """What changes of the print make of the published values."""
        number = len(self.problem.published)
        come_out = len(problem.published) - len(problem.ignored)
        explanation = Explanation(tuple(changes), found.mismatch, come_out, number)
        return Explained(explanation, problem, box, found, alone)
