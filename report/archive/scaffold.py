"""A folder to start one's own campaign from: small, complete, and built from what the workbook declares."""

from __future__ import annotations

import json
import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from ..messages.errors import Location, OutputError, diagnose, why
from ..quantity import Bounds, behind
from .wheel import wheel

if TYPE_CHECKING:
    from ..workbook import Measured, Parameter, RowTable, Workbook

OWN = "workbook.py"
"""What a method of one's own is called in its folder."""


def new(folder: Path, workbook: Workbook, ci: str = "", code: bytes = b"") -> list[Path]:
    """Write a report folder that can be built at once.

    Parameters
    ----------
    folder : Path
        A folder that does not exist yet, or an empty one; an empty repository is one too.
    workbook : Workbook
        The method; its example becomes the measurements, its parameters are listed with their meaning.
    ci : str
        Where the folder is to be checked after every change: a name of :data:`CI`, or nothing.
    code : bytes
        Of a method of one's own, which the folder gets then.

    Returns
    -------
    list of Path
        The files that were written. What a service reads is at the root of the repository that holds the
        folder, or in the folder if none does yet.

    Raises
    ------
    OutputError
        If the folder is not empty or cannot be written, or what a service reads is there already; nothing is
        left half-written then.
    """
    files = {"report.toml": _report(workbook, OWN if code else workbook.name).encode()}
    if code:
        files[OWN] = code
    if workbook.measured or not code:
        files |= {table.file: _measurements(workbook, table).encode() for table in workbook.row_tables}
    try:
        beside = _for_service(folder, ci, files) if ci else {}
        is_new = _is_new(folder)
        for path in beside:
            if path.exists() or path.is_symlink():
                there = why(FileExistsError("there is one; rename it, or the campaign"))
                raise OutputError(diagnose("LS601", Location(path.as_posix()), text=path.name, **there))
        with _written(beside):
            if is_new:
                _create(folder, files)
            else:
                with _written({folder / name: content for name, content in files.items()}):
                    pass
    except (OSError, ValueError) as error:
        raise OutputError(diagnose("LS601", text=folder, **why(error))) from error
    return [*(folder / name for name in files), *beside]


def _is_new(folder: Path) -> bool:
    """Whether there is no such folder yet; one that is there must be empty."""
    if not (folder.is_symlink() or folder.exists()):
        return True
    if not folder.is_dir():
        raise OutputError(diagnose("LS602", text=folder))
    if any(path.name != ".git" for path in folder.iterdir()):
        raise OutputError(diagnose("LS603", text=folder))
    return False


def _for_service(folder: Path, ci: str, files: dict[str, bytes]) -> dict[Path, bytes]:
    """Add what a service installs to the folder's files; what it reads too, or return it by its place."""
    name, content = wheel()
    files[name] = content
    root = repository(folder) or folder
    inside = folder.resolve().relative_to(root.resolve()).as_posix()
    place, workflow = CI[ci]
    text = workflow(inside, name).encode()
    if inside == ".":
        files[place.format("")] = text
        return {}
    return {root / place.format(f"-{_slug(inside)}"): text}


def _slug(folder: str) -> str:
    """A folder's name as part of another name, whatever is in it."""
    return re.sub(r"[^A-Za-z0-9.]+", "-", folder).strip("-.") or "campaign"


def repository(folder: Path) -> Path | None:
    """The root of the repository that a folder is in, as seen from where one stands; None without one."""
    here, there = Path.cwd(), folder.resolve()
    root = next((path for path in (there, *there.parents) if (path / ".git").exists()), None)
    return root.relative_to(here) if root is not None and root.is_relative_to(here) else root


def _create(folder: Path, files: dict[str, bytes]) -> None:
    """Write a folder beside its place and move it there whole."""
    made = _make_parents(folder.parent)
    draft = folder.with_name(f".{folder.name}.{os.getpid()}.new")
    try:
        draft.mkdir()
        for name, content in files.items():
            (draft / name).parent.mkdir(parents=True, exist_ok=True)
            (draft / name).write_bytes(content)
        draft.rename(folder)
    except BaseException:
        shutil.rmtree(draft, ignore_errors=True)
        _remove(made)
        raise


def _make_parents(parent: Path) -> list[Path]:
    """Make the folders above; return those that were missing, outermost first."""
    missing = [folder for folder in [parent, *parent.parents] if not folder.exists()][::-1]
    parent.mkdir(parents=True, exist_ok=True)
    return missing


def _remove(made: list[Path]) -> None:
    for folder in reversed(made):
        with suppress(OSError):
            folder.rmdir()


@contextmanager
def _written(files: dict[Path, bytes]) -> Iterator[None]:
    """Write files into folders that may be in use; if that or the block fails, they are taken away again."""
    drafts = {path: path.with_name(f".{path.name}.{os.getpid()}.new") for path in files}
    done: list[Path] = []
    made: list[Path] = []
    try:
        for path in drafts:
            made += _make_parents(path.parent)
        for draft, content in zip(drafts.values(), files.values(), strict=True):
            draft.write_bytes(content)
        for path, draft in drafts.items():
            draft.replace(path)
            done.append(path)
        yield
    except BaseException:
        for path in [*drafts.values(), *done]:
            with suppress(OSError):
                path.unlink()
        _remove(made)
        raise


def _measurements(workbook: Workbook, table: RowTable) -> str:
    header = (table.row, *(f"{column.name} [{column.unit}]" for column in workbook.columns_of(table)))
    return "".join(",".join(row) + "\n" for row in table.example or (header,))


def _report(workbook: Workbook, name: str) -> str:
    return "\n".join(_lines(workbook, name)) + "\n"


def _lines(workbook: Workbook, name: str) -> Iterator[str]:
    yield from (
        "# A campaign of your own: put your numbers where the example's are, then 'loopsheet build' here.",
        "# Numbers are written in quotes, as they were printed: the digits say how sure they are.",
        "",
        'title = "My campaign"',
        f"workbook = {_quote(name)}",
        f"# {_one_line(workbook.title)}",
        f"# {_one_line(workbook.source)}",
        "",
        "[parameters]",
    )
    for parameter in workbook.parameters:
        yield from _parameter(parameter, workbook.example_parameters.get(parameter.name))
    if not workbook.measured and name == OWN:
        return
    for table in workbook.row_tables:
        yield from ("", f"[{'.'.join(table.place)}]", f'file = "{table.file}"')
        for column in workbook.columns_of(table):
            yield f"# {column.name}: {_meaning(column)}"
    if not workbook.measured:
        return
    table = workbook.row_tables[-1]
    of = workbook.columns_of(table)[-1]
    last, unit = of.name, of.unit
    width = f"0.03{behind(unit)}"  # with its unit: another head of the column does not change it
    yield from (
        "# Its first line names each column and its unit, which may be any that converts to the one above.",
        f"# A column u({last}) [unit] gives standard uncertainties; without it the printed digits do.",
        "",
        "# [uncertainty]                          # of whole columns, and of parameters",
        f'# {last} = "U = {width}, k = 2"         # or +-0.1 rect, 0.5 % of reading + 2 digits, exact',
        "",
        f"# [{'.'.join((*table.place, 'printed'))}]",
        f'# {last} = "truncated"                    # if digits were cut off; without this, "rounded"',
        "",
        "# [expected]                             # cells and tests that are odd, and why",
        f'# "{table.row} 3" = "the bench was knocked"',
        "",
        "# [published]                            # values to compare with, if there are any",
        '# file = "published.csv"                 # source,cell,index,value,unit,expect,recomputed,reason',
    )


def _parameter(parameter: Parameter, example: str | None) -> Iterator[str]:
    """Write one parameter: the example's as a line that counts, any other as a comment."""
    note = _meaning(parameter)
    if parameter.default is not None:
        note += f"; {parameter.default} if left out"
    suffix = behind(parameter.unit)
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


def _github(folder: str, wheel: str) -> str:
    """The workflow for a folder of a repository, ``.`` for its root."""
    path = "." if folder == "." else f"./{folder}"
    known = json.dumps(path, ensure_ascii=False)
    known = known.replace("${{", "${{ '${{' }}")  # no expression of the service
    return f"""\
# After every change: is the report as expected? What is not is marked in the pull request, at its line.
name: report

on:
  push:
    branches: [main, master]
  pull_request:
  workflow_dispatch:

permissions:
  contents: read

env:
  # The folder of the report, from the root of the repository, where GitHub reads this file.
  FOLDER: {known}

jobs:
  report:
    runs-on: ubuntu-latest
    steps:
      - uses: actions/checkout@v6
      - uses: actions/setup-python@v6
        with:
          python-version: "3.12"
      # The loopsheet that made this folder is kept beside it. To take another: put its wheel there.
      - run: python -m pip install "$FOLDER"/{wheel}
      - run: loopsheet check "$FOLDER" --format github
      - if: ${{{{ !cancelled() }}}}
        run: loopsheet build "$FOLDER" --out "$RUNNER_TEMP"/report
      # If a build is committed: does each of its numbers come out again?
      - if: ${{{{ !cancelled() }}}}
        run: test ! -e "$FOLDER"/out/values.json || loopsheet diff "$FOLDER"/out "$RUNNER_TEMP"/report
      - if: ${{{{ !cancelled() }}}}
        uses: actions/upload-artifact@v6
        with:
          name: report{"" if folder == "." else f" of {_slug(folder)}"}
          path: ${{{{ runner.temp }}}}/report
          if-no-files-found: error
"""


CI = {"github": (".github/workflows/loopsheet{}.yml", _github)}
"""By the name of a service, the file that it reads, with a place for the folder, and what is in it."""
