"""A folder to start one's own campaign from: small, complete, and built from what the workbook declares."""

from __future__ import annotations

import os
import shutil
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import OutputError, diagnose
from .quantity import Bounds

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .workbook import Measured, Parameter, Workbook

__all__ = ["CI", "new"]


WORKFLOW = ".github/workflows/loopsheet.yml"


def new(folder: Path, workbook: Workbook, ci: str = "") -> list[Path]:
    """Write a report folder that can be built at once.

    Parameters
    ----------
    folder : Path
        A folder that does not exist yet, or an empty one.
    workbook : Workbook
        The method; its example becomes the measurements, its parameters are listed with their meaning.
    ci : str
        Where the folder is to be checked after every change: a name of :data:`CI`, or nothing.

    Returns
    -------
    list of Path
        The files that were written.

    Raises
    ------
    OutputError
        If the folder is not empty or cannot be written; nothing is left half-written then.
    """
    files = {"report.toml": _report(workbook), "measurements.csv": _measurements(workbook)}
    if ci:
        name, workflow = CI[ci]
        files[name] = workflow()
    try:
        if folder.is_symlink() or folder.exists():
            if not folder.is_dir():
                raise OutputError(diagnose("LS602", text=folder))
            if any(folder.iterdir()):
                raise OutputError(diagnose("LS603", text=folder))
            _fill(folder, files)
        else:
            _create(folder, files)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise OutputError(diagnose("LS601", text=folder, reason=reason)) from error
    return [folder / name for name in files]


def _create(folder: Path, files: dict[str, str]) -> None:
    """Write a folder beside its place and move it there whole."""
    made = _make_parents(folder.parent)
    draft = folder.with_name(f".{folder.name}.{os.getpid()}.new")
    try:
        draft.mkdir()
        for name, text in files.items():
            (draft / name).parent.mkdir(parents=True, exist_ok=True)
            (draft / name).write_text(text, encoding="utf-8", newline="\n")
        draft.rename(folder)
    except BaseException:
        shutil.rmtree(draft, ignore_errors=True)
        for parent in reversed(made):
            with suppress(OSError):
                parent.rmdir()
        raise


def _make_parents(parent: Path) -> list[Path]:
    """Make the folders above; return those that were missing, outermost first."""
    missing = [folder for folder in [parent, *parent.parents] if not folder.exists()][::-1]
    parent.mkdir(parents=True, exist_ok=True)
    return missing


def _fill(folder: Path, files: dict[str, str]) -> None:
    """Write into an empty folder, which stays the same folder: somebody may be working in it."""
    drafts = {folder / name: folder / f".{Path(name).name}.{os.getpid()}.new" for name in files}
    done: list[Path] = []
    made: list[Path] = []
    try:
        for path in drafts:
            made += _make_parents(path.parent)
        for draft, text in zip(drafts.values(), files.values(), strict=True):
            draft.write_text(text, encoding="utf-8", newline="\n")
        for path, draft in drafts.items():
            draft.replace(path)
            done.append(path)
    except BaseException:
        for path in [*drafts.values(), *done]:
            with suppress(OSError):
                path.unlink()
        for parent in reversed(made):
            with suppress(OSError):
                parent.rmdir()
        raise


def _measurements(workbook: Workbook) -> str:
    header = ("test", *(f"{column.name} [{column.unit}]" for column in workbook.measured))
    return "".join(",".join(row) + "\n" for row in workbook.example or (header,))


def _report(workbook: Workbook) -> str:
    return "\n".join(_lines(workbook)) + "\n"


def _lines(workbook: Workbook) -> Iterator[str]:
    yield from (
        "# A campaign of your own: put your numbers where the example's are, then 'loopsheet build' here.",
        "# Numbers are written in quotes, as they were printed: the digits say how sure they are.",
        "",
        'title = "My campaign"',
        f"workbook = {_quote(workbook.name)}",
        f"# {_one_line(workbook.title)}",
        f"# {_one_line(workbook.source)}",
        "",
        "[parameters]",
    )
    for parameter in workbook.parameters:
        yield from _parameter(parameter, workbook.example_parameters.get(parameter.name))
    yield from ("", "[measurements]", 'file = "measurements.csv"')
    for column in workbook.measured:
        yield f"# {column.name}: {_meaning(column)}"
    if not workbook.measured:
        return
    last = workbook.measured[-1].name
    yield from (
        "# Its first line names each column and its unit, which may be any that converts to the one above.",
        f"# A column u({last}) [unit] gives standard uncertainties; without it the printed digits do.",
        "",
        "# [measurements.printed]",
        f'# {last} = "truncated"                    # if digits were cut off; without this, "rounded"',
        "",
        "# [published]                            # values to compare with, if there are any",
        '# file = "published.csv"                 # source,cell,index,value,unit,expect,recomputed,reason',
    )


def _parameter(parameter: Parameter, example: str | None) -> Iterator[str]:
    """Write one parameter: the example's as a line that counts, any other as a comment."""
    note = _meaning(parameter)
    if parameter.default is not None:
        note += f"; {parameter.default} if left out"
    suffix = "" if parameter.unit == "1" else f" {parameter.unit}"
    value = example or parameter.default or f"...{suffix}"
    mark = "" if example is not None else "# "
    yield f"{mark}{parameter.name} = {_quote(value)}".ljust(38) + f"  # {_one_line(note)}"


def _meaning(declared: Measured | Parameter) -> str:
    """Say what it is and what is allowed."""
    allowed = "" if declared.bounds == Bounds() else f"; {declared.bounds.said(declared.unit)}"
    return _one_line(declared.meaning + allowed)


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _quote(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def _github() -> str:
    from .. import __version__

    return f"""\
# After every change: is the report as expected? What is not is marked in the pull request, at its line.
# GitHub reads this file at the root of a repository. If this folder is not the root, move .github there and
# write the folder's name instead of the point after 'check' and 'build'.
name: report

on:
  push:
    branches: [main, master]
  pull_request:
  workflow_dispatch:

permissions:
  contents: read

jobs:
  report:
    runs-on: ubuntu-latest
    steps:
      - uses: actions/checkout@v6
      - uses: actions/setup-python@v6
        with:
          python-version: "3.12"
      # The version that made this folder: the same numbers until you choose another.
      - run: python -m pip install "loopsheet=={__version__}"
      - run: loopsheet check . --format github
      - if: ${{{{ !cancelled() }}}}
        run: loopsheet build . --out out
      - if: ${{{{ !cancelled() }}}}
        uses: actions/upload-artifact@v6
        with:
          name: report
          path: out
          if-no-files-found: error
"""


CI = {"github": (WORKFLOW, _github)}
"""By the name of a service, the file that it reads and what is written there."""
