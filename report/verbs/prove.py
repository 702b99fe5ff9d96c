"""`prove`: the algebra alone."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .common import FINDINGS, OK, Progress, folder_argument, keeping_arguments

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...derivations.equation import Erratum, Ledger
    from ...derivations.proved import Proof
    from ...derivations.vocabulary import Vocabulary

    Step = Callable[[str], None]
    Proved = tuple[tuple[Proof, ...], tuple[Erratum, ...]]
    Algebra = tuple[Ledger, Callable[[list[str] | None, Step], Proved]]

FAMILIES = ("damping", "damped-loop")
"""Ledgers of contacts that no workbook computes: forces of simulation codes, law (3) with damping."""
HELP = "prove the algebra of a workbook, or show the proof of one equation"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    parser.add_argument("equation", metavar="EQUATION", nargs="?", help="its number, for example (11) or 12a")
    of = " or ".join(f"'{word}'" for word in FAMILIES)
    folder_argument(parser, f", {of} for models of contacts that no workbook computes")
    keeping_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Prove, and print one line an equation, or all steps of one."""
    from ..inputs.folders import WORD, is_report
    from ..messages.errors import UsageError, diagnose, suggest

    word = options.equation
    if word and options.folder is None and (word in (WORD, *FAMILIES) or is_report(Path(word))):
        options.equation, options.folder = None, word  # no equation has such a name
    beside = options.folder in FAMILIES and not is_report(Path(options.folder))
    ledger, prove = _beside(_family(options.folder)) if beside else _folder(options.folder)
    labels = [equation.label for equation in ledger.equations()]
    wanted: list[str] | None = None
    if options.equation:
        number = options.equation.strip("()")
        wanted = [e.label for e in ledger.equations() if f"({number})" in (e.label, e.number)]
        if not wanted:
            known, hint = ", ".join(labels), suggest(f"({number})", labels)
            raise UsageError(
                diagnose("LS604", kind="equation", text=options.equation, known=known, suggestion=hint)
            )
    with Progress(sys.stderr) as progress:
        shown, errata = prove(wanted, progress)
    for proof in shown:
        _print(proof, ledger.vocabulary, steps=bool(options.equation))
    for erratum in errata:
        print(f"erratum: {erratum.sentence}")
        if erratum.evidence:
            print(f"         {erratum.evidence}")
    failed = [proof for proof in shown if not proof.status.passes]
    print(f"{len(shown) - len(failed)} of {len(shown)} stand")
    return FINDINGS if failed else OK


def _family(word: str) -> Ledger:
    from ...derivations.contact import damped_loop, damping

    return damping.LEDGER if word == FAMILIES[0] else damped_loop.LEDGER


def _folder(folder: str | None) -> Algebra:
    """The ledger of a report folder, and what proves all of it or some, which is kept."""
    from ..inputs.folders import report_folder
    from ..study import Study

    study = Study(report_folder(folder))
    assert study.prepared  # whoever asks for the algebra of a folder hears of what is wrong with it
    ledger = study.declared

    def prove(wanted: list[str] | None, step: Step) -> Proved:
        study.step = step
        return study.algebra if wanted is None else (study.proofs(map(ledger.__getitem__, wanted)), ())

    return ledger, prove


def _beside(ledger: Ledger) -> Algebra:
    """A ledger that is not that of a folder, and what proves it."""
    from ...derivations.proof import prove

    return ledger, lambda wanted, step: (
        prove(ledger, lambda equation: step(f"proving {equation.label}"), only=wanted),
        (),
    )


def _print(proof: Proof, vocabulary: Vocabulary, steps: bool) -> None:
    from ...derivations.proved import IDENTITY
    from ...derivations.text import text_of_equation

    print(f"{proof.equation.label:6} {proof.status.value:12} {text_of_equation(proof.equation, vocabulary)}")
    if steps:
        print(f"       {proof.equation.because}")
    for n, found in enumerate(proof.steps, start=1):
        if steps:
            print(f"  {n}.   {found.step.says}")
            premises = "; ".join(dict.fromkeys(premise.label for premise in found.step.premises))
            print(f"       from  {premises or IDENTITY}")
            print(f"       holds {text_of_equation(found.step.claim, vocabulary)}")
        if steps or not found.status.passes:
            print(f"       {found.status.value}: {found.sentence}")
    if proof.steps and proof.status.passes:
        print(f"       rests on: {'; '.join(proof.rests_on) or IDENTITY}")
    if proof.remark:
        print(f"       {proof.remark}")
