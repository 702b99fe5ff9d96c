"""What a report was computed by: the sources of this program, by their content, and the processor."""

from __future__ import annotations

import hashlib
import platform
import sys
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
    found = {}
    for part, places in PARTS.items():
        own = {file for place in places for file in files(root / place)} - counted
        counted |= own
        total = hashlib.sha256()
        for name, file in sorted((file.relative_to(root).as_posix(), file) for file in own):
            content = hashlib.sha256(file.read_bytes()).hexdigest()
            total.update(f"{content}  {name}\n".encode())
        found[part] = total.hexdigest()
    return found


def files(place: Path) -> set[Path]:
    """The files of a part that a wheel holds, in a folder or the one that is named."""
    if place.is_file():
        return {place}
    found = place.rglob("*" if place.name == "templates" else "*.py")
    return {file for file in found if file.is_file() and not _is_made(file.relative_to(place))}


def _is_made(name: Path) -> bool:
    """Whether it is hidden or a cache: nothing that a wheel holds."""
    return any(part.startswith(".") or part == "__pycache__" for part in name.parts)


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
