"""One report folder as a graph of what can be known of it: each part is made when somebody asks, and once.

Verbs, the pytest plugin, `verify` and users of the package ask a :class:`Study`. What it gives to views is
finished data, a :class:`~loopsheet.report.result.result.Report`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from . import stages
from .inputs.inputs import LARGEST_TABLE, Find, Inputs, load
from .inputs.sources import read_bytes
from .machine.kept import kept
from .machine.timing import timed
from .messages.errors import Findings
from .own_workbook import follows_from_its_bytes
from .which_workbook import find_workbook

if TYPE_CHECKING:
    from ..derivations.equation import Equation, Ledger
    from ..derivations.proved import Proof
    from .prepared import Prepared
    from .proofs import Algebra
    from .result.agreement import Agreement
    from .result.result import Report

T = TypeVar("T")
Recipe = tuple[Path, Find, dict[str, bytes]]
"""A folder, how its workbook is found, and its files."""


def _part(name: str) -> Callable[[Callable[[Any], T]], cached_property[T]]:
    """A part of a study: made once, and its time is counted."""

    def of(make: Callable[[Any], T]) -> cached_property[T]:
        def made(study: Study) -> T:
            with timed(name):
                return make(study)

        made.__doc__ = make.__doc__
        return cached_property(made)

    return of


class Study:
    """What can be known of a report folder.

    Parameters
    ----------
    find : callable
        :func:`~loopsheet.report.which_workbook.find_workbook`, or, if nobody asked to run the folder's own
        code, :func:`~loopsheet.report.which_workbook.shipped_workbook`.
    step : callable
        Told what is begun.

    Notes
    -----
    Every part raises InputError, with every finding, if the folder is not as it must be.
    """

    def __init__(self, folder: Path, find: Find = find_workbook, step: stages.Step = stages.silent) -> None:
        self.folder, self.find, self.step = folder, find, step
        self._read: dict[str, bytes] = {}

    @property
    def recipe(self) -> Recipe:
        """What another process makes the same study of."""
        return self.folder, self.find, self.inputs.files

    @classmethod
    def of(cls, recipe: Recipe) -> Study:
        """The study of the same bytes, whatever has become of the folder."""
        study = cls(*recipe[:2])
        study.files = study._read = recipe[2]
        return study

    # --- what was read ---

    @cached_property
    def files(self) -> dict[str, bytes]:
        """The files that the folder is read from, by name; which these are hangs on report.toml alone."""
        toml = read_bytes(self.folder, "report.toml", LARGEST_TABLE, Findings())
        if toml is None:
            return self.inputs.files  # which tells why
        self._read = {"report.toml": toml}
        names = kept("names of files", [toml], lambda: sorted(self.inputs.files))
        if "inputs" in vars(self):
            return self.inputs.files
        for name in names:
            data = read_bytes(self.folder, name, LARGEST_TABLE, Findings()) if name != "report.toml" else toml
            if data is None:
                return self.inputs.files
            self._read[name] = data
        return self._read

    @_part("inputs")
    def inputs(self) -> Inputs:
        """What the folder says, checked."""
        self.step("reading the folder")
        return load(self.folder, self.find, stages.of_cells, self._read)

    @_part("ledger")
    def declared(self) -> Ledger:
        """The equations of its workbook, with their algebra."""
        return self.inputs.workbook.ledger()

    @_part("ledger")
    def ledger(self) -> Ledger:
        """The same, of a shipped workbook as they were told before."""
        from .kept_sheet import ledger_of

        inputs = self.inputs
        return ledger_of(inputs.workbook, inputs.given, self.prepared.sheet, lambda: self.declared)

    @_part("sheet")
    def prepared(self) -> Prepared:
        """The inputs with their sheet, dimensions and names checked."""
        return stages.prepared(self.inputs, lambda: self.declared)

    # --- what is computed ---

    @_part("values")
    def computed(self) -> Report:
        """All cells, without proofs, engines and referee."""
        return stages.evaluated(self.prepared, lambda: self.ledger, self.step)

    @_part("proofs")
    def proof_data(self) -> dict[str, Any]:
        """The proofs and errata of the algebra as data: what another process may tell."""
        from .proofs import as_data, proved

        about = self.inputs.about_source
        return self.kept("proofs", lambda: as_data(proved(self.declared, about, self.step)), by="workbook")

    @_part("proofs")
    def algebra(self) -> Algebra:
        """A proof of every equation, and the errata of the print it is about."""
        from .proofs import of_data

        return of_data(self.proof_data, self.ledger)

    def are_proved(self) -> bool:
        """Whether all proofs are known already."""
        if "proof_data" not in vars(self):
            found: dict[str, Any] | None = self.kept("proofs", None, by="workbook")
            if found is None:
                return False
            self.proof_data = found
        return True

    def proofs(self, equations: Iterable[Equation]) -> tuple[Proof, ...]:
        """The proofs of some equations: of these and what they rest on, if not all are known."""
        labels = {equation.label for equation in equations} & {e.label for e in self.ledger.equations()}
        if not self.are_proved():
            from ..derivations.proof import prove

            with timed("proofs"):
                return prove(self.declared, only=labels)
        return tuple(proof for proof in self.algebra[0] if proof.equation.label in labels)

    @cached_property
    def proved(self) -> Report:
        """All cells and proofs."""
        proofs, errata = self.algebra
        return replace(self.computed, proofs=proofs, errata=errata)

    @_part("referee")
    def refereed(self) -> Report:
        """All cells, and every published value judged."""
        return stages.refereed(self.computed, self.step, self.kept)

    def is_refereed(self) -> bool:
        """Whether it is known already what the referee finds, or nothing is published."""
        return not self.inputs.published or self.kept(stages.VERDICTS, None) is not None

    @_part("page program")
    def program(self) -> str:
        """The sheet as the page's program: of the columns, whatever numbers are given for them."""
        sheet, curves = self.prepared.sheet, self.inputs.workbook.curves
        begun = [sheet[name].content for curve in curves for name in curve.fitted]  # it may hang on the data
        given = " ".join(sorted(self.inputs.given))
        make = partial(stages.program, self.computed)
        return self.kept("page program", make, given, *begun, by="workbook")

    @_part("judge of the engines")
    def engines(self) -> tuple[Agreement, ...]:
        """How every engine that is installed here agrees with 50 digits."""
        return stages.judged(self.computed, step=self.step).engines

    @_part("judge of NumPy")
    def numpy(self) -> tuple[Agreement, ...]:
        """The same of NumPy alone."""
        return stages.judged(self.computed, False, self.step).engines

    @cached_property
    def report(self) -> Report:
        """All that there is to know."""
        proofs, errata = self.algebra
        engines = self.engines
        return replace(self.refereed, proofs=proofs, errata=errata, engines=engines)

    # --- what is kept ---

    def kept(self, what: str, make: Callable[[], T] | None, *parts: str, by: str = "folder") -> T:
        """What is made of the folder's files, or of its workbook alone, now or before.

        Parameters
        ----------
        what : str
            What it is.
        make : callable or None
            As for :func:`~loopsheet.report.machine.kept.kept`.
        *parts : str
            What it hangs on besides.
        by : str
            ``workbook`` if it hangs on that alone.
        """
        files = self.files
        own = {name: content for name, content in files.items() if name.endswith(".py")}
        if not all(map(follows_from_its_bytes, own.values())) or (by == "folder" and self._is_told_otherwise):
            return make() if make is not None else None  # type: ignore[return-value]
        if by == "workbook":
            files = own
            parts = (*parts, self.inputs.workbook.name, str(self.inputs.about_source))
        named = (part for name, content in sorted(files.items()) for part in (name, content))
        found: T = kept(what, [*parts, *named], make)
        return found

    @cached_property
    def _is_told_otherwise(self) -> bool:
        """Whether a result that numbers are taken from is not as it was built, by the manifest beside it.

        That is refused once it is read; what was kept was made when it was right, or had no manifest.
        """
        from .files.manifest import is_as_built

        files = self.files.items()
        results = ((self.folder / name, data) for name, data in files if name.endswith(".json"))
        return not all(is_as_built(file, data) for file, data in results)
