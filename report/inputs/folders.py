"""What FOLDER means in every verb: what is named, where one stands, or the shipped paper."""

from __future__ import annotations

import hashlib
import shlex
from collections.abc import Iterator, Mapping
from pathlib import Path

from ..messages.errors import Location, UsageError, diagnose, listing

PAPER = Path(__file__).resolve().parents[2] / "data" / "soft_steel"
"""The shipped campaign."""
EXAMPLES = tuple(path.parent for path in sorted(PAPER.parent.glob("*/report.toml")))
"""All shipped folders."""
WORD = "paper"
"""What a user calls it; a folder of that name is written ``./paper``."""
OUT = "out"
"""Where a report goes, below its folder."""
INPUTS = "inputs"
"""Where a crate holds what it was built from: a report folder again."""


def report_folder(word: str | None) -> Path:
    """The report folder that a word of the command line names.

    Parameters
    ----------
    word : str or None
        A folder, or :data:`WORD`; without it, the working directory.

    Raises
    ------
    UsageError
        Nothing was named, and the working directory is no report folder; or a report folder here has the
        name of the shipped paper. What is named may still be none: its reader tells.
    """
    if word is None:
        if is_report(Path()):
            return Path()
        # One level down is where a newcomer's folder is, and a listing of it costs nothing.
        near = sorted(written(path.parent) for path in Path().glob("*/report.toml"))
        raise UsageError(diagnose("LS615", known=listing(f"'{name}'" for name in (*near[:3], WORD))))
    if word != WORD:
        path = Path(word)
        return path.parent if path.name == "report.toml" and is_report(path.parent) else path
    if is_report(Path(WORD)):
        raise UsageError(diagnose("LS616", Location(f"./{WORD}/report.toml"), text=WORD))
    return PAPER


def is_report(folder: Path) -> bool:
    """Whether a folder holds a report.toml."""
    try:
        return (folder / "report.toml").is_file()
    except (OSError, ValueError):
        return False


def written(folder: Path) -> str:
    """A report folder as one writes it in a command."""
    if folder == PAPER:
        return WORD
    text = folder.as_posix()
    return f"./{text}" if text == WORD or text.startswith("-") else shlex.quote(text)


def called(folder: Path) -> str:
    """A report folder by a name that is the same wherever loopsheet is installed, if it is a shipped one."""
    shipped = folder.resolve()
    return shipped.name if shipped in EXAMPLES else written(folder)


def told(folder: Path) -> str:
    """A report folder in a sentence, by the file that makes it one."""
    return "the shipped paper" if folder == PAPER else (folder / "report.toml").as_posix()


def output(folder: Path) -> Path:
    """Where the report of a folder goes; that of the shipped paper to where one stands."""
    return Path(OUT) if folder == PAPER else folder / OUT


def result(word: str | None = None) -> Path:
    """The output folder that a word names: itself, or that of the report folder which the word names."""
    if word is None:
        return Path(OUT)
    if word != WORD and (not is_report(Path(word)) or Path(word, "manifest.json").is_file()):
        return Path(word)
    return output(report_folder(word))


def built_from(out: Path, inputs: Mapping[str, str]) -> Path:
    """The report folder that an output was built from, as far as that can be seen.

    Parameters
    ----------
    out : Path
        What ``build`` wrote.
    inputs : mapping of str to str
        The sha256 of each input, as its manifest says.

    Returns
    -------
    Path
        The output itself where it is a report folder too, the folder above it, its own :data:`INPUTS`, the
        working directory or the shipped paper, whichever holds these inputs; if none does, one of the first,
        whose inputs were changed then. Where the report of a folder goes, that folder is meant, and no copy
        of what it held once.

    Raises
    ------
    UsageError
        There is none.
    """
    here, above = Path.cwd(), out.resolve().parent
    above = above.relative_to(here) if above.is_relative_to(here) else above
    known = is_report(out) or (is_report(above) and out.resolve() == output(above).resolve())
    near = [out, above] if known else [above, out / INPUTS]
    places = [*near, Path()] if known else [*near, Path(), PAPER]
    found = [folder for folder in places if is_report(folder)]
    for folder in found:
        if holds(folder, inputs):
            return folder
    if changed := [folder for folder in near if folder in found]:
        return changed[0]
    reason = f"it is not in a report folder, and is not that of the working directory or of '{WORD}'"
    raise UsageError(diagnose("LS609", text=out, reason=reason))


def holds(folder: Path, inputs: Mapping[str, str]) -> bool:
    """Whether a folder holds these inputs; no name in a manifest makes us read outside of it."""
    return bool(inputs) and not any(changed(folder, inputs))


def changed(folder: Path, inputs: Mapping[str, str]) -> Iterator[str]:
    """The names of those inputs that a folder does not hold any more."""
    root = folder.resolve()
    for name, digest in inputs.items():
        file = (root / name).resolve()
        inside = file.is_relative_to(root) and file.is_file()
        if not inside or hashlib.sha256(file.read_bytes()).hexdigest() != digest:
            yield name
