"""What a report was computed by: the sources of this program, by their content, and the processor."""

from __future__ import annotations

import hashlib
import os
import platform
import sys
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

from ... import __version__

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

    `root`: the folder of the package.
    """
    parts: dict[str, tuple[tuple[str, Stamp], ...]] = {}
    counted: set[str] = set()
    for part, places in PARTS.items():
        found = (each for place in places for each in _stamped(root / place))
        parts[part] = tuple(each for each in found if each[0] not in counted)
        counted.update(file for file, _ in parts[part])
    return dict(_digests(root, tuple(parts.items())))


Stamp = tuple[int, int, int, int]
"""What changes with a file: which it is, when it and what is said of it were changed, its size."""


@lru_cache(maxsize=8)
def _digests(
    root: Path, parts: tuple[tuple[str, tuple[tuple[str, Stamp], ...]], ...]
) -> tuple[tuple[str, str], ...]:
    """The sha256 of each part; of files that nobody touched, those of before: they are asked for often."""
    found = []
    for part, stamped in parts:
        total = hashlib.sha256()
        for name, file in sorted((Path(file).relative_to(root).as_posix(), file) for file, _ in stamped):
            content = hashlib.sha256(Path(file).read_bytes()).hexdigest()
            total.update(f"{content}  {name}\n".encode())
        found.append((part, total.hexdigest()))
    return tuple(found)


def files(place: Path) -> set[Path]:
    """The files of a part that a wheel holds, in a folder or the one that is named."""
    return {Path(file) for file, _ in _stamped(place)}


def _stamped(place: Path) -> Iterator[tuple[str, Stamp]]:
    """The same with their stamps, in one look at each folder: whatever is kept asks for it."""
    if place.is_file():
        yield str(place), _stamp(place.stat())
        return
    folders = [str(place)]
    for folder in folders:
        with os.scandir(folder) as found:
            for entry in found:
                if entry.name.startswith(".") or entry.name == "__pycache__":
                    continue  # hidden or a cache: no wheel may hold it
                if entry.is_dir(follow_symlinks=False):
                    folders.append(entry.path)
                elif place.name == "templates" or entry.name.endswith(".py"):
                    yield entry.path, _stamp(entry.stat())


def _stamp(found: os.stat_result) -> Stamp:
    return found.st_ino, found.st_mtime_ns, found.st_ctime_ns, found.st_size


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
