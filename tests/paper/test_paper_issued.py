"""The report of the shipped paper is, to the byte, the one that somebody last looked at."""

from __future__ import annotations

import hashlib
import re
import zipfile
from pathlib import Path

import pytest

SEEN = Path(__file__).with_name("issued.txt")
"""The digest of each file of the report, and of each part of the workbook."""


def digests(out: Path) -> dict[str, str]:
    """The digest of each file by its name, whatever Python they name that made it.

    Of the manifest none, for it names the sources; nor of a PDF, which another zlib packs otherwise.
    """
    found = {}
    for path in sorted(out.rglob("*")):
        name = path.relative_to(out).as_posix()
        if path.suffix == ".xlsx":
            with zipfile.ZipFile(path) as parts:
                found |= {f"{name}/{part}": parts.read(part) for part in sorted(parts.namelist())}
        elif path.is_file() and name != "manifest.json" and path.suffix != ".pdf":
            found[name] = path.read_bytes()
    made_by = re.compile(rb"python(?:\xc2\xa0|[ ~])3\.\d+")
    return {name: hashlib.sha256(made_by.sub(b"", content)).hexdigest() for name, content in found.items()}


def test_nothing_has_changed_that_nobody_looked_at(issued: Path, pytestconfig: pytest.Config) -> None:
    now = digests(issued / "out")
    if pytestconfig.getoption("--seen"):
        SEEN.write_text("".join(f"{digest}  {name}\n" for name, digest in now.items()), encoding="utf-8")
    lines = SEEN.read_text(encoding="utf-8").splitlines()
    before = {name: digest for digest, _, name in (line.partition("  ") for line in lines)}
    other = sorted(name for name in now.keys() | before.keys() if now.get(name) != before.get(name))
    assert not other, (
        f"these parts of the report in {issued / 'out'} are not as they were: look at them beside those of "
        "the last commit; if they are meant to be so, 'make seen' writes that down"
    )
