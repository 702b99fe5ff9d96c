"""What the tests of the prover share: a few symbols, and how a step is put together and decided."""

from sympy import Expr, IndexedBase, Symbol

from loopsheet.derivations import proof
from loopsheet.derivations.equation import Equation, Kind, Step
from loopsheet.derivations.proof import check_step

a, b, c = (Symbol(name, positive=True) for name in "abc")
y, w = (Symbol(name, real=True) for name in "yw")
q, n = Symbol("q", integer=True, positive=True), Symbol("n", integer=True, positive=True)
X = IndexedBase(Symbol("X", positive=True))


def given(left: Expr, right: Expr, *conditions: Expr) -> Equation:
    return Equation("", (left, right), "", Kind.ASSUMPTION, f"{left} = {right}", conditions=conditions)


def claim(*members: Expr, conditions: tuple[Expr, ...] = ()) -> Equation:
    return Equation("(1)", members, "", conditions=conditions)


def decide(
    claimed: Equation, *premises: tuple[Equation, Expr], factor: Expr | None = None
) -> proof.StepProof:
    """Check a step; a premise without anything to solve for is the one that the factor multiplies."""
    unknowns = tuple(unknown for _, unknown in premises if unknown is not None)
    return check_step(Step(claimed, tuple(premise for premise, _ in premises), unknowns, "", factor))
