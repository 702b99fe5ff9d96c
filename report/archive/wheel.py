"""The loopsheet that runs, as a wheel: what is installed again from beside a campaign, without an index."""

from __future__ import annotations

import base64
import hashlib
import io
import zipfile
from importlib.metadata import PackageNotFoundError, distribution

from ..machine.provenance import PARTS, ROOT, files
from ..messages.errors import OutputError, diagnose

_DATA = "data"
_BORN = (1980, 1, 1, 0, 0, 0)
"""The first day that a zip can tell: the same sources are the same bytes."""
_KIND = "Wheel-Version: 1.0\nGenerator: loopsheet\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
_FACTS = ("METADATA", "entry_points.txt", "licenses/LICENSE")


def wheel() -> tuple[str, bytes]:
    """The name and the content of a wheel that installs what is running now.

    Raises
    ------
    OutputError
        loopsheet runs without being installed, so that what it needs is not known.
    """
    try:
        installed = distribution("loopsheet")
    except PackageNotFoundError as error:
        what, how = "loopsheet as a package", "it first: pip install, and the folder of its pyproject.toml"
        raise OutputError(diagnose("LS605", kind="a wheel", text=what, known=how)) from error
    about = f"loopsheet-{installed.version}.dist-info"
    held = {f"loopsheet/{name}": (ROOT / name).read_bytes() for name in _names()}
    held |= {f"{about}/{name}": (installed.read_text(name) or "").encode() for name in _FACTS}
    held[f"{about}/WHEEL"] = _KIND.encode()
    held[f"{about}/RECORD"] = _record(held, f"{about}/RECORD").encode()
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in held.items():
            entry = zipfile.ZipInfo(name, _BORN)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o100644 << 16
            archive.writestr(entry, content)
    return f"loopsheet-{installed.version}-py3-none-any.whl", packed.getvalue()


def _names() -> list[str]:
    """What a wheel holds, below the package: what computes a report, and the shipped campaigns."""
    found = {file for places in PARTS.values() for place in places for file in files(ROOT / place)}
    found |= {file for file in (ROOT / _DATA).glob("*/*") if file.is_file()}
    found.add(ROOT / "py.typed")
    return sorted(file.relative_to(ROOT).as_posix() for file in found)


def _record(held: dict[str, bytes], own: str) -> str:
    """Every file with its fingerprint, as the format of wheels has it."""
    lines = []
    for name, content in held.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        lines.append(f"{name},sha256={digest},{len(content)}\n")
    return "".join([*lines, f"{own},,\n"])
