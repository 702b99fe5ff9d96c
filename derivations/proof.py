"""Decides whether a claim holds: a symbolic residual of zero *and* 50-digit agreement over the domain.

Neither half is trusted alone. A computer algebra system may simplify on assumptions that fail somewhere;
numbers may agree by chance. A claim is proved when both say so, refuted when the numbers show a point of
the domain where its premises hold and it does not, and undecided otherwise. Undecided is a failure.

What is proved step by step may still say nothing: an equation that rests on itself, that equates what is of
different dimension, or that cannot hold together with the others is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from functools import lru_cache

from sympy import Expr, Indexed, IndexedBase, Sum, Symbol

from .dimensions import mixed
from .equation import Derivation, Equation, Kind, Ledger, Step
from .evaluation import NotEvaluable
from .grounds import behind, circle, is_assumed
from .proved import Proof, ProofStatus, StepProof
from .sampling import POINTS, examine
from .system import Refused, prepare
from .text import text
from .together import conflict
from .vocabulary import NO_WORDS, Vocabulary

NOT_REDUCED = (
    "the numbers agree, but the residual was not reduced to zero; what may help: say what is positive, claim "
    "it in steps, or claim of both sides what undoes a root or an inverse function, as a square or a tangent"
)
"""Of what is true as far as is known."""

# --- verdicts ------------------------------------------------------------------------------------------


@lru_cache(maxsize=256)
def check_step(step: Step, vocabulary: Vocabulary = NO_WORDS) -> StepProof:
    """Decide one step.

    Parameters
    ----------
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
            found = StepProof(step, ProofStatus.REFUTED, outcome.points, outcome.worst)
            return replace(found, counterexample=outcome.counterexample, sides=outcome.sides)
        if outcome.points < POINTS:
            raise Refused(f"only {outcome.points} points of its domain were evaluated")
        where = "" if _holds_of_any_columns(step, vocabulary) else system.residual_is_zero()
        if where is None:
            raise Refused(NOT_REDUCED)
    except (Refused, NotEvaluable) as problem:
        return StepProof(step, ProofStatus.UNDECIDED, 0, 0.0, why=str(problem))
    return StepProof(step, ProofStatus.PROVED, outcome.points, outcome.worst, why=where)


def _holds_of_any_columns(step: Step, vocabulary: Vocabulary) -> bool:
    """Whether a step is soon seen to hold without the premises that say what columns are by data.

    What follows from the normal equations of a fit follows of any columns, while logarithms of quotients have
    many more terms under a sum.
    """
    pairs = tuple(zip(step.premises, step.eliminate, strict=False))
    sought = {unknown for _, unknown in pairs}
    kept = [
        (premise, unknown)
        for premise, unknown in pairs
        if not isinstance(unknown, IndexedBase)
        or any(side.atoms(Symbol, IndexedBase) & sought for side in premise.sides[1:])
    ]
    sums = any(side.has(Sum) for premise, _ in kept for side in premise.sides)
    if not sums or len(kept) == len(pairs):
        return False
    premises, unknowns = zip(*kept, strict=True)
    fewer = replace(step, premises=(*premises, *step.premises[len(pairs) :]), eliminate=unknowns)
    try:
        return prepare(fewer, vocabulary).expands_to_zero()
    except Refused:
        return False


def _check_print(step: Step, vocabulary: Vocabulary) -> tuple[ProofStatus, str]:
    """Compare the print of a claim with its meaning, which was proved; the remark says how it differs."""
    claim = step.claim
    assert claim.printed is not None
    as_printed = Equation(
        claim.number, claim.printed, claim.because, part=claim.part, conditions=claim.conditions
    )
    if claim.defines is not None and not any(side.has(claim.defines) for side in as_printed.sides):
        return ProofStatus.CORRECTED, (
            f"as printed, {claim.label} does not contain {text(claim.defines, vocabulary)}, which it should "
            f"determine: it repeats {text(as_printed.sides[0], vocabulary)}"
        )
    found = check_step(replace(step, claim=as_printed), vocabulary)
    match found.status:
        case ProofStatus.PROVED:
            return ProofStatus.PROVED, ""
        case ProofStatus.REFUTED:
            return ProofStatus.CORRECTED, f"as printed, {claim.label} fails: {found.sentence}"
    return ProofStatus.UNDECIDED, f"as printed, {claim.label} is undecided: {found.sentence}"


Grounds = Mapping[Equation, tuple[Equation, ...]]
"""For each equation that stands, the definitions and assumptions that it finally rests on."""


def _loose(step: Step, reached: Grounds) -> str:
    """Say which premise is neither assumed nor defined in plain sight, nor proved before, nor an instance."""
    unproved = [
        premise.label
        for premise in step.premises
        if (premise.origin.number or not is_assumed(premise)) and premise.origin not in reached
    ]
    if unproved:
        return f"rests on {', '.join(unproved)}, not proved before"
    forged = [p.label for p in step.premises if p != p.origin and not p.follows_from_origin]
    return f"rests on what is called {', '.join(forged)} and is no instance of it" if forged else ""


def _grounds(step: Step, reached: Grounds) -> tuple[Equation, ...]:
    """What the claim of a step finally rests on."""
    behind = (reached.get(premise.origin, (premise.origin,)) for premise in step.premises)
    return tuple(dict.fromkeys(ground for grounds in behind for ground in grounds))


def prove_entry(entry: Equation | Derivation, known: Grounds, ledger: Ledger) -> tuple[Proof, Grounds]:
    """A proof of one entry of a ledger by what stands before it, and the equations that stand after it.

    `known`: the entries before this one that passed, each with what it finally rests on.
    """
    words = ledger.vocabulary
    if isinstance(entry, Equation):
        if entry.kind is Kind.CLAIM:
            return Proof(entry, ProofStatus.UNDECIDED, remark="a claim without a derivation"), known
        if problem := _misstated(entry, words):
            return Proof(entry, ProofStatus.REFUSED, remark=problem), known
        return Proof(entry, ProofStatus(entry.kind.value)), {**known, entry: (entry,)}
    steps: list[StepProof] = []
    reached = dict(known)
    for step in entry.steps:
        found = check_step(step, words)
        if found.status.passes and (why := _loose(step, reached)):
            found = replace(found, status=ProofStatus.UNDECIDED, why=why)
        steps.append(found)
        if found.status.passes:
            reached[step.claim] = _grounds(step, reached)
    status, remark = _verdict(entry, steps, ledger)
    rests_on = tuple(dict.fromkeys(ground.label for ground in reached.get(entry.claim, ())))
    proof = Proof(entry.claim, status, tuple(steps), remark, rests_on if status.passes else ())
    return proof, {**known, entry.claim: reached[entry.claim]} if status.passes else known


def _goes_to_zero(quantity: Expr, *others: Expr) -> bool:
    return isinstance(quantity, (Symbol, Indexed)) and others == (0,)


def _misstated(equation: Equation, vocabulary: Vocabulary) -> str:
    """Say why an equation says nothing that could hold; empty where nothing was found."""
    if equation.kind is Kind.LIMIT and not _goes_to_zero(*equation.sides):
        return "a limit says of a quantity that it is zero"
    return mixed(equation, vocabulary)


def _verdict(entry: Derivation, steps: list[StepProof], ledger: Ledger) -> tuple[ProofStatus, str]:
    """What the steps, what they rest on and the print make of a claim, with a remark."""
    verdicts = {found.status for found in steps}
    if ProofStatus.REFUTED in verdicts:
        return ProofStatus.REFUTED, ""
    if path := circle(entry, ledger):
        return ProofStatus.REFUSED, f"{entry.claim.label} rests on itself: {path}"
    for equation in (each for step in entry.steps for each in (*step.premises, step.claim)):
        if problem := _misstated(equation, ledger.vocabulary):
            return ProofStatus.REFUSED, f"{equation.label}: {problem}" if equation != entry.claim else problem
    if ProofStatus.UNDECIDED in verdicts:
        return ProofStatus.UNDECIDED, ""
    if entry.claim.printed is not None:
        return _check_print(entry.steps[-1], ledger.vocabulary)
    return ProofStatus.PROVED, ""


def prove(
    ledger: Ledger, begin: Callable[[Equation], None] | None = None, only: Collection[str] | None = None
) -> tuple[Proof, ...]:
    """Decide the equations of a ledger, in its order; nothing may rest on what comes later.

    `begin`: told of each equation before it is decided: all of them take a second or two. `only`: the labels
    of those that are asked for: what they do not rest on is not derived then. What is assumed is looked at in
    any case, for they have to hold together with all of it.
    """
    needed = None if only is None else behind((ledger[label] for label in only), ledger)
    proofs: list[Proof] = []
    known: Grounds = {}
    for entry in ledger.entries:
        claim = entry.claim if isinstance(entry, Derivation) else entry
        if needed is not None and isinstance(entry, Derivation) and claim not in needed:
            continue
        if begin is not None:
            begin(claim)
        proof, known = prove_entry(entry, known, ledger)
        proofs.append(proof)
    if needed is None or not _holds_together(ledger, proofs):
        proofs = _refuse_conflicts(ledger, proofs, known)
    return tuple(proof for proof in proofs if only is None or proof.equation.label in only)


def _holds_together(ledger: Ledger, proofs: Collection[Proof]) -> bool:
    """Whether a point was found at which a ledger holds, with all that it claims, proved or not.

    Then it holds there with fewer claims too, for which a point is harder to find.
    """
    refused = {proof.equation for proof in proofs if not proof.status.passes}
    standing = frozenset(ledger.equations()) - refused
    claimed = {entry.claim for entry in ledger.entries if isinstance(entry, Derivation)} & standing
    claims = frozenset(
        claim for claim in claimed if not any(e.kind is Kind.LIMIT for e in behind([claim], ledger))
    )
    return conflict(ledger, standing, claims) is None


def _refuse_conflicts(ledger: Ledger, proofs: list[Proof], known: Grounds) -> list[Proof]:
    """Let nothing stand that was not seen to hold together with what is before it, nor what rests on it."""
    standing = frozenset(proof.equation for proof in proofs if proof.status.passes)
    claims = frozenset(
        proof.equation
        for proof in proofs
        if proof.equation in standing
        and proof.steps
        and not any(ground.kind is Kind.LIMIT for ground in known[proof.equation])
    )
    found = conflict(ledger, standing, claims)
    if found is None:
        return proofs
    culprit, status = found.culprit.origin, ProofStatus.REFUSED if found.certain else ProofStatus.UNDECIDED
    return [
        replace(proof, status=status, remark=found.sentence, rests_on=())
        if culprit in (proof.equation, *known.get(proof.equation, ()))
        else proof
        for proof in proofs
    ]
