"""Decides whether a claim holds: a symbolic residual of zero *and* 50-digit agreement over the domain.

Neither half is trusted alone. A computer algebra system may simplify on assumptions that fail somewhere;
numbers may agree by chance. A claim is proved when both say so, refuted when the numbers show a point of
the domain where its premises hold and it does not, and undecided otherwise. Undecided is a failure.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import lru_cache

from .equation import Derivation, Equation, Kind, Ledger, Step
from .evaluation import NotEvaluable
from .sampling import DIGITS, POINTS, examine
from .space import said
from .system import Refused, prepare
from .text import text
from .vocabulary import NO_WORDS, Vocabulary

__all__ = ["DIGITS", "POINTS", "Proof", "Status", "StepProof", "check_step", "prove", "prove_equation"]

LEAST_POINTS = 20
"""Fewer points than this prove nothing, whatever they say."""


class Status(Enum):
    """What is known of an equation."""

    DEFINITION = "definition"
    ASSUMPTION = "assumption"
    PROVED = "proved"
    CORRECTED = "proved with a correction of the print"
    REFUTED = "refuted"
    UNDECIDED = "undecided"

    @property
    def passes(self) -> bool:
        """Whether a report may rest on it."""
        return self not in (Status.REFUTED, Status.UNDECIDED)


@dataclass(frozen=True)
class StepProof:
    """What was found of one step."""

    step: Step
    status: Status
    points: int
    worst: float
    """Largest relative residual over the points."""
    symbolic: bool
    counterexample: Mapping[str, str] = field(default_factory=dict)
    sides: tuple[str, str] = ("", "")
    """Both sides of the claim at the counterexample."""
    why: str = ""

    @property
    def sentence(self) -> str:
        """The finding, in words."""
        if self.status is Status.REFUTED:
            return f"at {said(self.counterexample)} the sides are {self.sides[0]} and {self.sides[1]}"
        if self.status is Status.UNDECIDED:
            return self.why
        return f"residual 0; {self.points} points at {DIGITS} digits agree within {self.worst:.0e}"


@dataclass(frozen=True)
class Proof:
    """What is known of one equation of the ledger."""

    equation: Equation
    status: Status
    steps: tuple[StepProof, ...] = ()
    remark: str = ""
    """How the print differs from what was proved."""


# --- verdicts ------------------------------------------------------------------------------------------


@lru_cache(maxsize=256)
def check_step(step: Step, vocabulary: Vocabulary = NO_WORDS) -> StepProof:
    """Decide one step.

    Parameters
    ----------
    step : Step
    vocabulary : Vocabulary
        Of its ledger: where its symbols are sampled, and what they are called.

    Notes
    -----
    The same claim always gets the same points: the seed is its label. The numbers come first, since a
    counterexample is found sooner than a residual that does not vanish.
    """
    try:
        system = prepare(step, vocabulary)
        outcome = examine(system, step.claim.label)
        if outcome.counterexample is not None:
            found = StepProof(step, Status.REFUTED, outcome.points, outcome.worst, False)
            return replace(found, counterexample=outcome.counterexample, sides=outcome.sides)
        if outcome.points < LEAST_POINTS:
            raise Refused(f"only {outcome.points} points of its domain were evaluated")
        if not system.residual_is_zero():
            raise Refused("the numbers agree, but the residual was not reduced to zero")
    except (Refused, NotEvaluable) as problem:
        return StepProof(step, Status.UNDECIDED, 0, 0.0, False, why=str(problem))
    return StepProof(step, Status.PROVED, outcome.points, outcome.worst, True)


def _check_print(step: Step, vocabulary: Vocabulary) -> tuple[Status, str]:
    """Compare the print of a claim with its meaning, which was proved; the remark says how it differs."""
    claim = step.claim
    assert claim.printed is not None
    as_printed = Equation(
        claim.number, claim.printed, claim.because, part=claim.part, conditions=claim.conditions
    )
    if claim.defines is not None and not any(side.has(claim.defines) for side in as_printed.sides):
        return Status.CORRECTED, (
            f"as printed, {claim.label} does not contain {text(claim.defines, vocabulary)}, which it should "
            f"determine: it repeats {text(as_printed.sides[0], vocabulary)}"
        )
    found = check_step(replace(step, claim=as_printed), vocabulary)
    match found.status:
        case Status.PROVED:
            return Status.PROVED, ""
        case Status.REFUTED:
            return Status.CORRECTED, f"as printed, {claim.label} fails: {found.sentence}"
    return Status.UNDECIDED, f"as printed, {claim.label} is undecided: {found.sentence}"


def _is_loose(premise: Equation, reached: set[Equation]) -> bool:
    """Whether a premise is neither assumed nor defined in plain sight, nor proved before."""
    origin = premise.origin
    if origin.number and origin not in reached:
        return True
    if Kind.CLAIM not in (premise.kind, origin.kind):
        return False
    return origin not in reached or not premise.follows_from_origin


def prove_equation(
    entry: Equation | Derivation,
    known: frozenset[Equation] = frozenset(),
    vocabulary: Vocabulary = NO_WORDS,
) -> Proof:
    """Decide one entry of a ledger, given the equations that stand before it.

    Parameters
    ----------
    entry : Equation or Derivation
    known : frozenset of Equation
        What a step may rest on: the entries before this one that passed.
    vocabulary : Vocabulary
        Of the ledger.
    """
    if isinstance(entry, Equation):
        if entry.kind is Kind.CLAIM:
            return Proof(entry, Status.UNDECIDED, remark="a claim without a derivation")
        return Proof(entry, Status(entry.kind.value))
    steps: list[StepProof] = []
    reached = set(known)
    for step in entry.steps:
        found = check_step(step, vocabulary)
        loose = [premise.label for premise in step.premises if _is_loose(premise, reached)]
        if loose and found.status.passes:
            found = replace(
                found, status=Status.UNDECIDED, why=f"rests on {', '.join(loose)}, not proved before"
            )
        steps.append(found)
        if found.status.passes:
            reached.add(step.claim)
    verdicts = {found.status for found in steps}
    for verdict in (Status.REFUTED, Status.UNDECIDED):
        if verdict in verdicts:
            return Proof(entry.claim, verdict, tuple(steps))
    status, remark = Status.PROVED, ""
    if entry.claim.printed is not None:
        status, remark = _check_print(entry.steps[-1], vocabulary)
    return Proof(entry.claim, status, tuple(steps), remark)


def prove(ledger: Ledger, begin: Callable[[Equation], None] | None = None) -> tuple[Proof, ...]:
    """Decide every equation of a ledger, in its order; nothing may rest on what comes later.

    Parameters
    ----------
    ledger : Ledger
    begin : callable, optional
        Told of each equation before it is decided: all of them take the better part of a second.
    """
    proofs: list[Proof] = []
    known: set[Equation] = set()
    for entry in ledger.entries:
        if begin is not None:
            begin(entry.claim if isinstance(entry, Derivation) else entry)
        proof = prove_equation(entry, frozenset(known), ledger.vocabulary)
        proofs.append(proof)
        if proof.status.passes:
            known.add(proof.equation)
    return tuple(proofs)
