"""The shipped paper is the same bytes whatever the processor, threads, locale, folder, user and hash seed."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from campaign_sizes import Sizes
from processors import beyond, lesser

pytestmark = pytest.mark.usefixtures("anew")

OTHER = 65534
"""The user that Unix calls nobody."""
LOCALES = ("de_DE", "tr_TR", "fr_FR")
"""Decimal commas, and capitals of their own."""


@dataclass(frozen=True)
class Place:
    """Where a report is built: what differs from where the tests run."""

    name: str
    environment: dict[str, str] = field(default_factory=dict)
    folder: str = "out"
    user: int = 0


def places() -> list[Place]:
    """All differences at once, then each alone; `make test` has one thread (Makefile)."""
    threads = {number: {"OPENBLAS_NUM_THREADS": number, "OMP_NUM_THREADS": number} for number in "12"}
    locales = [{"LC_ALL": f"{locale}.UTF-8", "LANG": f"{locale}.UTF-8"} for locale in LOCALES]
    sooner = {"PYTHONHASHSEED": "4711", "TZ": "Pacific/Kiritimati"}
    of_all = {**lesser(), **threads["2"], **locales[0], **sooner}
    return [
        Place("all that follows at once", of_all, "Prüfung 1/a folder", OTHER),
        Place("as it is"),
        *(Place(f"processor without {names}", {"NPY_DISABLE_CPU_FEATURES": names}) for names in beyond()),
        *(Place(f"{number} BLAS threads", of) for number, of in threads.items()),
        *(Place(of["LC_ALL"], of) for of in locales),
        Place("locale C", {"LC_ALL": "C"}),
        Place("another folder", folder="Prüfung 1/a folder"),
        Place("another user", user=OTHER),
        Place("another hash seed and zone", sooner),
        Place("hash seed 0", {"PYTHONHASHSEED": "0"}),
    ]


@pytest.fixture(scope="module")
def room() -> Iterator[Path]:
    """A folder that every user may enter; pytest's own are closed to others."""
    with TemporaryDirectory() as name:
        Path(name).chmod(0o755)
        yield Path(name)


@pytest.fixture(scope="module")
def locales(require: Callable[..., str], room: Path) -> Path:
    """Locales that the system need not have."""
    found = room / "locales"
    found.mkdir()
    for locale in LOCALES:
        # It warns of what the fewest locales have; what matters is asked below.
        command = [require("localedef"), "-i", locale, "-f", "UTF-8", found / f"{locale}.UTF-8"]
        subprocess.run(command, capture_output=True, check=False)
    comma = "import locale; locale.setlocale(locale.LC_ALL, ''); print(locale.localeconv()['decimal_point'])"
    environment = {**os.environ, "LOCPATH": str(found), "LC_ALL": "de_DE.UTF-8"}
    done = subprocess.run([sys.executable, "-c", comma], env=environment, capture_output=True, check=False)
    assert done.stdout == b",\n", done.stderr
    return found


@pytest.mark.campaigns
def test_the_same_bytes_everywhere(
    require: Callable[..., str],
    locales: Path,
    issued: Path,
    room: Path,
    sizes: Sizes,
    summary: Callable[[str], None],
) -> None:
    for program in ("latexmk", "setpriv"):
        require(program)
    asked = places()[: sizes.places]
    found = {"here": digests(issued / "out")}
    for number, place in enumerate(asked):
        home = room / str(number)
        home.mkdir()
        found[place.name] = digests(built(place, home, locales))
    names = sorted({name for each in found.values() for name in each})
    assert {"report.html", "report.tex", "report.xlsx", "report.pdf", "values.json", "manifest.json"} < set(
        names
    )
    for name in names:
        sums = {where: each[name] for where, each in found.items() if name in each}
        assert len(set(sums.values())) == 1, (name, sums)
    summary(f"places: {len(names)} files are the same bytes here and in {len(asked)} other places")
    for place in asked:
        summary(f"  {place.name}")


def built(place: Place, home: Path, locales: Path) -> Path:
    """The outputs of the shipped paper, built in a place."""
    out = home / place.folder
    command = [sys.executable, "-m", "loopsheet", "build", "paper", "--out", str(out)]
    command += ["--to", "html,latex,xlsx,json,pdf"]
    if place.user and os.getuid() == 0:
        os.chown(home, place.user, place.user)
        command = ["setpriv", f"--reuid={place.user}", f"--regid={place.user}", "--clear-groups", *command]
    environment = {**os.environ, "HOME": str(home), "LOCPATH": str(locales), **place.environment}
    done = subprocess.run(command, cwd=home, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{place.name}: {done.stderr}"
    return out


def digests(out: Path) -> dict[str, str]:
    """The sha256 of all outputs; the manifest is to say what differs, the processor and the format more."""
    found = {p.relative_to(out).as_posix(): p.read_bytes() for p in sorted(out.rglob("*")) if p.is_file()}
    manifest = json.loads(found["manifest.json"])
    del manifest["processor"]
    manifest["outputs"].pop("report.pdf", None)
    found["manifest.json"] = json.dumps(manifest).encode()
    return {name: hashlib.sha256(content).hexdigest() for name, content in found.items()}
