"""What is known of the algebra of a workbook, as data that can be kept, and that another process can tell."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from ..derivations.equation import Derivation, Erratum, Ledger
from ..derivations.proved import Proof, ProofStatus, StepProof

Algebra = tuple[tuple[Proof, ...], tuple[Erratum, ...]]
"""A proof of each equation, and the errata of the print they are about."""


def proved(ledger: Ledger, errata: bool, step: Callable[[str], None]) -> Algebra:
    """Prove all equations of a ledger.

    `errata`: whether to check the print, too. `step`: told what is begun.
    """
    from ..derivations.proof import prove

    proofs = prove(ledger, lambda equation: step(f"proving {equation.label}"))
    found = (check(ledger) for check in ledger.checks) if errata else ()
    return proofs, tuple(erratum for erratum in found if erratum is not None)


def as_data(algebra: Algebra) -> dict[str, Any]:
    """The same without equations, as JSON can hold it."""
    proofs, errata = algebra
    return {
        "proofs": [
            {**_but(proof, "equation"), "steps": [_but(step, "step") for step in proof.steps]}
            for proof in proofs
        ],
        "errata": [asdict(erratum) for erratum in errata],
    }


def of_data(data: Mapping[str, Any], ledger: Ledger) -> Algebra:
    """The same again, of a ledger's own equations and steps."""
    proofs = []
    for entry, found in zip(ledger.entries, data["proofs"], strict=True):
        equation, own = (entry.claim, entry.steps) if isinstance(entry, Derivation) else (entry, ())
        steps = tuple(
            StepProof(
                **{**rest, "step": step, "status": ProofStatus(rest["status"]), "sides": tuple(rest["sides"])}
            )
            for step, rest in zip(own, map(dict, found["steps"]), strict=True)
        )
        rests_on, status = tuple(found["rests_on"]), ProofStatus(found["status"])
        proofs.append(Proof(equation, status, steps, found["remark"], rests_on))
    return tuple(proofs), tuple(Erratum(**each) for each in data["errata"])


def _but(found: Proof | StepProof, own: str) -> dict[str, Any]:
    return {**{n: value for n, value in vars(found).items() if n != own}, "status": found.status.value}
