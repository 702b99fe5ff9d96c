"""`prove`: the algebra alone."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .common import FINDINGS, OK, Progress, folder_argument, keeping_arguments

if TYPE_CHECKING:
    from ...derivations.proved import Proof
    from ...derivations.vocabulary import Vocabulary

HELP = "prove the algebra of a workbook, or show the proof of one equation"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    parser.add_argument("equation", metavar="EQUATION", nargs="?", help="its number, for example (11) or 12a")
    folder_argument(parser)
    keeping_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Prove, and print one line an equation, or all steps of one."""
    from ..inputs.folders import WORD, is_report, report_folder
    from ..messages.errors import UsageError, diagnose, suggest
    from ..study import Study

    word = options.equation
    if word and options.folder is None and (word == WORD or is_report(Path(word))):
        options.equation, options.folder = None, word  # no equation has such a name
    study = Study(report_folder(options.folder))
    assert study.prepared  # whoever asks for the algebra of a folder hears of what is wrong with it
    ledger = study.declared
    labels = [equation.label for equation in ledger.equations()]
    wanted: list[str] = labels
    if options.equation:
        number = options.equation.strip("()")
        wanted = [e.label for e in ledger.equations() if f"({number})" in (e.label, e.number)]
        if not wanted:
            known, hint = ", ".join(labels), suggest(f"({number})", labels)
            raise UsageError(
                diagnose("LS604", kind="equation", text=options.equation, known=known, suggestion=hint)
            )
    with Progress(sys.stderr) as progress:
        study.step = progress
        shown = study.proofs(map(ledger.__getitem__, wanted)) if options.equation else study.algebra[0]
    for proof in shown:
        _print(proof, ledger.vocabulary, steps=bool(options.equation))
    if not options.equation:
        for erratum in study.algebra[1]:
            print(f"erratum: {erratum.sentence}")
            if erratum.evidence:
                print(f"         {erratum.evidence}")
    failed = [proof for proof in shown if not proof.status.passes]
    print(f"{len(shown) - len(failed)} of {len(shown)} stand")
    return FINDINGS if failed else OK


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
