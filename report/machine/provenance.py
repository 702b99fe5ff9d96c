"""What a report was computed by: the sources of this program, by their content, and the processor."""

from __future__ import annotations

import hashlib
import os
import platform
import sys
from functools import lru_cache
from pathlib import Path

from ... import __version__

__all__ = ["PARTS", "ROOT", "files", "processor", "sources", "versions"]

ROOT = Path(__file__).resolve().parents[2]
"""The folder of the package."""

PARTS = {
    "method": ("derivations", "report/workbooks"),
    "program": ("__init__.py", "__main__.py", "report"),
    "templates": ("templates",),
}
"""The folders and files of each part; what an earlier part has is not counted again."""


def sources(root: Path = ROOT) -> dict[str, str]:
    """The sha256 of each part: of the names and contents of its files, in the order of their names.

    The same from a wheel and from a checkout: only files that a wheel holds are counted, by their names
    below the package.

    Parameters
    ----------
    root : Path
        The folder of the package.
    """
    counted: set[Path] = set()
    parts = []
    for part, places in PARTS.items():
        own = {file for place in places for file in files(root / place)} - counted
        counted |= own
        named = sorted((file.relative_to(root).as_posix(), file) for file in own)
        parts.append((part, tuple((*each, _stamp(each[1])) for each in named)))
    return dict(_digests(tuple(parts)))


Stamp = tuple[int, int, int, int]
"""What changes with a file: which it is, when it and what is said of it were changed, its size."""


def _stamp(file: Path) -> Stamp:
    found = file.stat()
    return found.st_ino, found.st_mtime_ns, found.st_ctime_ns, found.st_size


@lru_cache(maxsize=8)
def _digests(
    parts: tuple[tuple[str, tuple[tuple[str, Path, Stamp], ...]], ...],
) -> tuple[tuple[str, str], ...]:
    """The sha256 of each part; of files that nobody touched, those of before: they are asked for often."""
    found = []
    for part, named in parts:
        total = hashlib.sha256()
        for name, file, _ in named:
            content = hashlib.sha256(file.read_bytes()).hexdigest()
            total.update(f"{content}  {name}\n".encode())
        found.append((part, total.hexdigest()))
    return tuple(found)


def files(place: Path) -> set[Path]:
    """The files of a part that a wheel holds, in a folder or the one that is named."""
    if place.is_file():
        return {place}
    found = set()
    for folder, below, names in os.walk(place):
        below[:] = filter(_is_shipped, below)
        own = (name for name in names if place.name == "templates" or name.endswith(".py"))
        found |= {Path(folder, name) for name in filter(_is_shipped, own)}
    return found


def _is_shipped(name: str) -> bool:
    """Whether it is neither hidden nor a cache: a wheel may hold it."""
    return not name.startswith(".") and name != "__pycache__"


def versions() -> dict[str, str]:
    """What computed: this program, its libraries and the interpreter's minor version."""
    from importlib.metadata import version

    printing = ("jinja2", "markdown-it-py", "matplotlib", "xlsxwriter")
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    return {
        "loopsheet": __version__,
        "python": python,
        **{name: version(name) for name in ("numpy", "sympy", "mpmath", *printing)},
    }


def processor() -> str:
    """The kind of processor and what of it NumPy uses, as NumPy names it: ``x86_64 X86_V2 X86_V3``."""
    import numpy as np

    features = np.show_config(mode="dicts")["SIMD Extensions"]
    return " ".join([platform.machine(), *features.get("baseline", []), *features.get("found", [])])
