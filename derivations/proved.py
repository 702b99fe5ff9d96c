"""What proofs found: verdicts on equations and steps, and their words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum

from .equation import Equation, Step

DIGITS = 50
"""To how many an equation is evaluated."""
IDENTITY = "nothing, it is an identity"
"""What is said of a claim that needs no premise."""


class ProofStatus(Enum):
    """What is known of an equation."""

    DEFINITION = "definition"
    ASSUMPTION = "assumption"
    LIMIT = "limit"
    PROVED = "proved"
    CORRECTED = "proved with a correction of the print"
    REFUTED = "refuted"
    UNDECIDED = "undecided"
    REFUSED = "refused"

    @property
    def passes(self) -> bool:
        """Whether a report may rest on it."""
        return self not in (ProofStatus.REFUTED, ProofStatus.UNDECIDED, ProofStatus.REFUSED)


@dataclass(frozen=True)
class StepProof:
    """What was found of one step."""

    step: Step
    status: ProofStatus
    points: int
    worst: float
    """Largest relative residual over the points."""
    counterexample: Mapping[str, str] = field(default_factory=dict)
    sides: tuple[str, str] = ("", "")
    """Both sides of the claim at the counterexample."""
    why: str = ""
    """Why it is undecided; where it is proved, where its symbols have to lie besides what the claim says."""

    @property
    def sentence(self) -> str:
        """The finding, in words."""
        if self.status is ProofStatus.REFUTED:
            at = f"at {said(self.counterexample)} " if self.counterexample else ""
            return f"{at}the sides are {self.sides[0]} and {self.sides[1]}"
        if self.status is ProofStatus.UNDECIDED:
            return self.why
        where = f" where {self.why}" if self.why else ""
        return f"residual 0{where}; {self.points} points at {DIGITS} digits agree within {self.worst:.0e}"


@dataclass(frozen=True)
class Proof:
    """What is known of one equation of the ledger."""

    equation: Equation
    status: ProofStatus
    steps: tuple[StepProof, ...] = ()
    remark: str = ""
    """How the print differs from what was proved, or why an equation is refused."""
    rests_on: tuple[str, ...] = ()
    """The labels of what a claim finally rests on: definitions, assumptions and premises of its steps."""


def enumerated(words: Iterable[str]) -> str:
    """Words as a sentence has them.

    >>> enumerated(["a"]), enumerated(["a", "b", "c"])
    ('a', 'a, b and c')
    """
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last


def said(point: Mapping[str, str]) -> str:
    """Write a point as a list of values."""
    return ", ".join(f"{name} = {value}" for name, value in point.items())
