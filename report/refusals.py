"""What a sheet must be before anything is computed: sound, stated, and given all that it wants."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from pathlib import Path

from .inputs.declared import misnamed
from .inputs.inputs import Inputs
from .messages.errors import InputError, Location, diagnose
from .own_workbook import place_of, place_of_column
from .sheet import Given, Sheet, SheetError


def of_sheet(inputs: Inputs, error: SheetError) -> InputError:
    """What is wrong with the sheet of a user's own workbook, with its place there."""
    at = place_of_column(*_own_code(inputs), error.about)
    return InputError(diagnose("LS213", at, text=inputs.workbook.name, reason=str(error), suggestion=""))


def _own_code(inputs: Inputs) -> tuple[Path, bytes]:
    """The file of the user's own workbook, and what it held."""
    name = next(name for name in inputs.files if name.endswith(".py"))
    return inputs.folder / name, inputs.files[name]


def refuse_what_is_misnamed(
    sheet: Sheet,
    inputs: Inputs,
    narratives: Mapping[str, Collection[str]],
    drawings: Callable[[], Collection[str]],
) -> None:
    """What a user's own workbook wants shown must be there; parameters as for :func:`~.declared.misnamed`."""
    path, code = _own_code(inputs)
    found = [
        diagnose("LS213", place_of(path, code, field, word), text=path.name, reason=reason, suggestion="")
        for field, word, reason in misnamed(inputs.workbook, sheet, narratives, drawings)
    ]
    if found:
        raise InputError(*found)


def refuse_what_is_missing(sheet: Sheet, inputs: Inputs) -> None:
    """A workbook need not say which parameters go together: what its sheet wants must be there."""
    place = Location((inputs.folder / "report.toml").as_posix())
    declared = inputs.workbook.declared
    missing = [
        declared.get(c.name, c)
        for c in sheet.columns
        if isinstance(c.rule, Given) and not inputs.printed(c.rule.u_of or c.name)
    ]
    known = inputs.workbook.example_parameters
    examples = {c.name: known.get(c.name, f"1.0 {c.unit}") for c in missing}
    found = [
        diagnose("LS204", place, text=name, table="[parameters]", example=f'{name} = "{example}"')
        for name, example in examples.items()
    ]
    if found:
        raise InputError(*found)
