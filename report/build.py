"""From a study to files: what is written, where it goes, and that it is there as a whole."""

from __future__ import annotations

import importlib
from base64 import b64decode, b64encode
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .archive.crate import added
from .files.manifest import manifest_of
from .inputs.folders import INPUTS, holds, is_report, output, told
from .machine.background import Background, LateArgument, Telling
from .machine.provenance import processor, sources
from .machine.staging import put, refuse_link, staged
from .machine.timing import timed
from .messages.errors import UsageError, diagnose, unknown
from .stages import Step, book, refereed_values, refuse_too_many_rows, silent, with_uncertainties
from .study import Recipe, Study
from .views import FORMATS, ON_REQUEST

if TYPE_CHECKING:
    from .prepared import Prepared
    from .result.result import Comparison, Report
    from .result.verdict import Referee
    from .views.issued import Issued
    from .workbook import FigureSpec

DEFAULT_FORMATS = tuple(each for each in FORMATS if each not in ON_REQUEST)


def parse_formats(words: str) -> tuple[str, ...]:
    """Read ``html,latex``; values.json comes with any of them, for what says that it has all numbers.

    Raises
    ------
    UsageError
        A word is no format, or there is none.
    """
    wanted = [word.strip() for word in words.split(",") if word.strip()]
    for word in wanted or [words]:
        if word not in FORMATS:
            raise unknown("format", word, FORMATS)
    return tuple(f for f in FORMATS if f in (*wanted, "json"))


def formats_there(out: Path) -> tuple[str, ...]:
    """What an output folder says that it has been built in."""
    before = manifest_of(out)
    return tuple(each for each in FORMATS if before and FORMATS[each][1] in before.outputs)


def formats_again(out: Path) -> tuple[str, ...] | None:
    """What to build where nothing is asked for: None, the default, and what was asked for before besides.

    A report.pdf that was issued is not to go because it is built again without a word.
    """
    there = formats_there(out)
    if set(there).isdisjoint(ON_REQUEST):
        return None
    # A workbook that is not there beside a page was too large.
    left = {"xlsx"} if "html" in there and "xlsx" not in there else set()
    return tuple(each for each in FORMATS if each in there or (each in DEFAULT_FORMATS and each not in left))


@dataclass(frozen=True)
class Built:
    """What was built."""

    files: tuple[Path, ...]
    """Where they are now."""
    told: Any
    """What there is to tell of the report."""


def built(
    study: Study,
    out: Path,
    formats: Collection[str] | None,
    every_engine: bool,
    tell: Step,
    of: Callable[[Report], Any],
) -> Built:
    """Write a report as :func:`build` does, or the very files that were written of the same folder before.

    `study`, `out`, `formats`, `every_engine` and `tell`: as for :func:`build`. `of`: what there is to tell of
    the report, as data that JSON can hold.
    """
    if not study.folder.is_dir():
        _ = study.inputs  # which tells, before the outputs' folder makes it
    _refuse_anothers(study, out)
    with staged(out, tell, lambda place: _of_a_crate(place, study.folder)) as stage:
        said: list[str] = []

        def say(sentence: str) -> None:
            said.append(sentence)
            tell(sentence)

        def make() -> dict[str, Any]:
            report = _made(study, stage, out, formats, every_engine, say)
            files = {name: (stage / name).read_bytes() for name in _names(stage)}
            return {"title": report.title, "said": said[1:], "files": _as_texts(files), "told": of(report)}

        # What other programs made of it hangs on them, too.
        if every_engine or "pdf" in (formats or ()):
            found = make()
        else:
            wanted = "default" if formats is None else " ".join(formats)
            found = study.kept("outputs", make, wanted, processor(), str(study.folder))
        if not said:
            for sentence in (_begun(found["title"], study, out), *found["said"]):
                tell(sentence)
            for name, content in _as_bytes(found["files"]).items():
                put(stage / name, content)
        names = _names(stage)
    return Built(tuple(out / name for name in names), found["told"])


def build(
    study: Study,
    out: Path,
    formats: Collection[str] | None = None,
    every_engine: bool = False,
    tell: Step = silent,
) -> tuple[Report, list[Path]]:
    """Compute a report and write it.

    Everything is written to a temporary folder first and moved in when all of it is there, so that a
    failure leaves an existing output as it was.

    Parameters
    ----------
    study : Study
        Of a report folder.
    out : Path
        Where the report goes; made if it does not exist. Other files in it are left alone.
    formats : collection of str, optional
        Of :data:`~loopsheet.report.views.FORMATS`. Without it, :data:`DEFAULT_FORMATS`, but no workbook
        that would be too large.
    every_engine : bool
        Whether JavaScript and the workbook are judged too, by the programs that are installed here.
    tell : callable
        Told what is built from where once the folder was read and found right, what is left out, and what it
        takes if that is long; which files that somebody had changed are kept; and what a crate of the report
        before had added, which is removed.

    Returns
    -------
    Report
    list of Path
        The files that were written.
    """
    with staged(out, tell, lambda place: _of_a_crate(place, study.folder)) as stage:
        report = _made(study, stage, out, formats, every_engine, tell)
        names = _names(stage)
    return report, [out / name for name in names]


def _as_texts(files: Mapping[str, bytes]) -> dict[str, str]:
    """Files as JSON can hold them."""
    return {name: b64encode(content).decode() for name, content in files.items()}


def _as_bytes(texts: Mapping[str, str]) -> dict[str, bytes]:
    return {name: b64decode(text) for name, text in texts.items()}


def _names(stage: Path) -> list[str]:
    return sorted(p.relative_to(stage).as_posix() for p in stage.rglob("*") if p.is_file())


def _of_another(study: Study, out: Path) -> Path | None:
    """The other report folder whose output goes there."""
    other = out.parent
    own = out == output(other) and is_report(other)
    return other if own and other.resolve() != study.folder.resolve() else None


def _refuse_anothers(study: Study, out: Path) -> None:
    """Refuse to put a report where nobody said, or in the place of another folder's that is as built."""
    if out == output(study.folder):
        refuse_link(out)
    other = _of_another(study, out)
    before = manifest_of(out) if other else None
    if other and before and holds(other, before.inputs):
        raise UsageError(diagnose("LS628", text=out.as_posix(), known=told(other)))


def _begun(title: str, study: Study, out: Path) -> str:
    said = f"building '{title}' from {told(study.folder)} into {out}"
    if other := _of_another(study, out):
        said += f", where that of {told(other)} goes"
    before = manifest_of(out)  # none, or damaged: `verify` tells of that
    return f"{said}, in place of '{before.title}'" if before and before.title != title else said


def _made(
    study: Study, stage: Path, out: Path, formats: Collection[str] | None, every_engine: bool, tell: Step
) -> Report:
    """Compute a report and write its files into a folder."""
    from . import cost
    from .views.issued import Issued

    tell(_begun(study.inputs.title, study, out))
    with ExitStack() as running:
        # What takes long and needs little of the rest has a process of its own, from when the folder is known
        # to be in order.
        proving = refereeing = None
        if not study.are_proved():
            proving = running.enter_context(Background(_proofs, study.recipe, Telling()))
        if not study.is_refereed():
            refereeing = running.enter_context(Background(_refereed, study.recipe, LateArgument()))
        asked, formats = formats is not None, _possible(study.prepared, formats, tell)
        if long := cost.told(study.prepared.sheet, study.prepared.layouts, formats):
            tell(long)
        study.prepared.check_cells()
        if refereeing is not None:
            refereeing.tell(study.computed.values.plain)
        engines = study.engines if every_engine else study.numpy
        source = study.program if "html" in formats else ""
        if proving is not None:
            study.step("proving the equations")
            with timed("waiting for proofs"):
                study.proof_data = proving.result(study.step)
        proved = with_uncertainties(study.proved, study.step)
        content = b""
        if "xlsx" in formats:
            study.step("writing report.xlsx")
            with timed("workbook"), _without_workbook(asked, tell) as left_out:
                content = book(proved)[1]
            formats = [each for each in formats if each not in left_out]
        finished = replace(proved, engines=engines)
        study.step("drawing the figures")
        with timed("figures"):
            pictures = _pictures(study, finished, formats)
        if study.inputs.published:
            study.step("refereeing what was published")
            with timed("waiting for the referee"):
                referee, comparisons = _refereed_here(study) if refereeing is None else refereeing.result()
            finished = replace(finished, referee=referee, comparisons=comparisons)
            with timed("figures"):
                pictures |= _pictures(study, finished, formats, finished.workbook.figures)
    with timed("writing"):
        _write(Issued(finished, pictures, source, content), stage, formats, study.step)
    return finished


def _proofs(recipe: Recipe, step: Step) -> dict[str, Any]:
    """In a process of its own: what is known of the algebra."""
    study = Study.of(recipe)
    _ = study.declared  # read before: that is told already
    study.step = step
    return study.proof_data


def _refereed(recipe: Recipe, plain: LateArgument[tuple[Any, ...]]) -> tuple[Referee, tuple[Comparison, ...]]:
    """In a process of its own: what the referee finds of values that are computed meanwhile."""
    from .cells.values import Values
    from .referee import judging  # noqa: F401 - takes long, and needs no values

    study = Study.of(recipe)
    made = study.prepared
    made = replace(made, inputs=made.check_cells())
    values = made.worded(Values(made.sheet, made.layouts, *plain.wait()))
    return refereed_values(made, values, keep=study.kept)


def _refereed_here(study: Study) -> tuple[Referee, tuple[Comparison, ...]]:
    """What is known of it from before."""
    found = study.computed
    return refereed_values(replace(study.prepared, inputs=found.inputs), found.values, keep=study.kept)


def _of_a_crate(out: Path, folder: Path) -> dict[Path, str]:
    """What `crate` added to an output, without what is built from: a crate is built again in itself too."""
    copies, source = (out / INPUTS).resolve(), folder.resolve()
    own = source.is_relative_to(copies)
    return {name: digest for name, digest in added(out).items() if not (own and INPUTS in name.parts)}


def _pictures(
    study: Study, report: Report, formats: Collection[str], but: Collection[FigureSpec] = ()
) -> dict[str, bytes]:
    """The files of a report's figures, by name, but some; those that show no data are kept."""
    forms = sorted({FORMATS[each][2] for each in formats} - {""})
    if not forms:
        return {}
    from .views import figures

    def files(figure: FigureSpec) -> dict[str, bytes]:
        draw = partial(figures.files, report, figure.drawing, forms)
        if not figure.fixed:
            return draw()
        own = figure.drawing, *forms
        return _as_bytes(study.kept("drawing", lambda: _as_texts(draw()), *own, by="workbook"))

    wanted = (figure for figure in figures.of(report) if figure not in but)
    return {f"{figure.name}.{form}": content for figure in wanted for form, content in files(figure).items()}


def _write(made: Issued, stage: Path, formats: Collection[str], step: Step) -> None:
    from .views.json import manifest

    for name, content in made.pictures.items():
        put(stage / "figures" / name, content)
    for name in (each for each in FORMATS if each in formats):
        module, file, _ = FORMATS[name]
        step(f"writing {file}")
        importlib.import_module(module).write(made, stage)
    outputs = {
        p.relative_to(stage).as_posix(): p.read_bytes() for p in sorted(stage.rglob("*")) if p.is_file()
    }
    put(stage / "manifest.json", manifest(made.report, outputs, sources(), processor()))


def _possible(prepared: Prepared, formats: Collection[str] | None, tell: Step) -> Collection[str]:
    """The formats that are asked for; or those that everybody gets, without a workbook that is too large."""
    wanted = DEFAULT_FORMATS if formats is None else formats
    if "xlsx" not in wanted:
        return wanted
    with _without_workbook(formats is not None, tell) as left_out:
        refuse_too_many_rows(prepared.layouts)
    return [each for each in wanted if each not in left_out]


@contextmanager
def _without_workbook(asked: bool, tell: Step) -> Iterator[list[str]]:
    """Go on without a workbook that cannot be made, and tell why, if nobody asked for it.

    Yields what is left out, once it is known.
    """
    left_out: list[str] = []
    try:
        yield left_out
    except UsageError as refused:
        if asked:
            raise
        (reason,) = refused.diagnostics
        tell(f"{reason.message}; {reason.allowed}")
        left_out.append("xlsx")
