"""report.xlsx judged by the validator of Microsoft's Open XML SDK: what Excel would offer to repair."""

from __future__ import annotations

import json
import os
import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
import spreadsheets
from small_report import end_gauge
from test_toy_workbook import FILES

from loopsheet.report.inputs.folders import PAPER

HERE = Path(__file__).parent
OFFICES = ("Office2016", "Microsoft365")

Finding = tuple[str, str, str]
"""Part, place in it, identifier."""
Judge = Callable[[bytes, str], list[Finding]]

EXTENSION = (
    b'<c:extLst><c:ext uri="{56B9EC1D-385E-4148-901F-78D8002777C0}" '
    b'xmlns:c16r3="http://schemas.microsoft.com/office/drawing/2017/03/chart"><c16r3:dataDisplayOptions16>'
    b'<c16r3:dispNaAsBlank val="1"/></c16r3:dataDisplayOptions16></c:ext></c:extLst>'
)
"""What a chart says for "#N/A is a gap", as Excel writes it. The SDK (3.x, its issue 1877) knows no extension
of a chart at all and finds fault with every one, so the rest of the file is judged without it."""


@pytest.fixture(scope="module")
def judge(
    require: Callable[..., str],
    npm_packages: Callable[[Path], Path],
    tmp_path_factory: pytest.TempPathFactory,
) -> Judge:
    """Judge the bytes of a workbook as a version of Office would read them."""
    scope = npm_packages(HERE) / "@xarsh"
    validator = require(str(scope / "ooxml-validator-linux-x64" / "ooxml-validator"))
    path = tmp_path_factory.mktemp("judged") / "report.xlsx"
    settings = {**os.environ, "DOTNET_SYSTEM_GLOBALIZATION_INVARIANT": "1"}

    def ask(content: bytes, office: str) -> list[Finding]:
        path.write_bytes(content)
        run = subprocess.run(
            [validator, path, office], env=settings, capture_output=True, text=True, timeout=60, check=False
        )
        assert run.returncode == 0, run.stderr
        found = json.loads(run.stdout)
        assert found["ok"] == (not found["errors"])
        return [(error["path"], error["xPath"], error["id"]) for error in found["errors"]]

    return ask


def without_extension(content: bytes) -> bytes:
    files = spreadsheets.parts(content)
    return spreadsheets.packed({name: part.replace(EXTENSION, b"") for name, part in files.items()})


# --- workbooks ----------------------------------------------------------------------------------------------

WORST = "=cmd|' /C calc'!A0 <b>&amp;\"said\" ]]></v> 😀 _x0041_ " + "word " * 80
"""Like a formula, like XML, like Excel's own escapes, beyond 16 bits, and longer than a formula's text."""
TEXTS = (
    '"Mars"', '"mean anomaly"', '"eccentric anomaly"', '"semi-major axis"', '"period"', '"eccentricity"',
    '"Distances of a planet"', '"J Kepler: Astronomia nova"', '"time of a sighting"', '"Sightings"',
    '"uniform in time"', '"the ellipse"', '"the orbit is open"', '"the planet is at its perihelion then,',
)  # fmt: skip
NAMES = {'"sightings"': "Equations", '"pairs"': "e" * 40}
"""Index sets called as another worksheet is, and longer than any may be."""


def told_at_length(folder: Path, eccentricity: str) -> Path:
    """The orbit with such words wherever its author may write any."""
    escaped, doubled = WORST.replace('"', '\\"'), WORST.replace('"', '""')
    odd = {plain: f'"{escaped}{plain[1:]}' for plain in TEXTS} | {
        name: f'"{odd}"' for name, odd in NAMES.items()
    }
    odd |= {"Tables,r": f'"{doubled}",r', "0.0934": eccentricity}
    plain = re.compile("|".join(map(re.escape, odd)))
    for name, text in FILES.items():
        changed = plain.sub(lambda found: odd[found[0]], text)
        (folder / name).write_text(changed, encoding="utf-8")
    return folder


def no_exponent(folder: Path) -> Path:
    """Pairs without a root, with two, and cells out of reach of a double."""
    return spreadsheets.folder_with(
        folder / "soft", [(2.0, 0.37, 23.5), (2.94, 0.6, 29.7), (3.0, 0.61, 29.8), (5.0, 0.9, 1e-5)]
    )


FOLDERS: dict[str, Callable[[Path], Path]] = {
    "paper": lambda _: PAPER,
    "worked example": lambda _: PAPER.parent / "worked_example",
    "errors in cells": no_exponent,
    "end gauge": end_gauge,
    "orbit of long words": lambda place: told_at_length(place, "0.0934"),
    "orbit that is open": lambda place: told_at_length(place, "1.2"),
}


@pytest.fixture(scope="module", params=FOLDERS)
def delivered(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> spreadsheets.Delivered:
    folder = FOLDERS[request.param](tmp_path_factory.mktemp("books"))
    return spreadsheets.deliver(folder)


@pytest.mark.parametrize("office", OFFICES)
def test_nothing_is_found(delivered: spreadsheets.Delivered, judge: Judge, office: str) -> None:
    assert judge(without_extension(delivered.content), office) == []


# --- the judge ----------------------------------------------------------------------------------------------


def test_what_it_says_of_charts_is_of_their_extension_alone(judge: Judge) -> None:
    content = spreadsheets.paper().content
    charts = [part for name, part in spreadsheets.parts(content).items() if name.startswith("xl/charts/")]
    assert [part.count(EXTENSION) for part in charts] == [1, 1, 1]
    found = judge(content, "Microsoft365")
    assert {place for _, place, _ in found} <= {"/c:chartSpace[1]/c:chart[1]/c:extLst[1]/c:ext[1]"}


@pytest.mark.parametrize(
    ("part", "old", "new"),
    [
        ("xl/worksheets/sheet1.xml", b"<sheetData>", b"<sheetDate/><sheetData>"),
        ("xl/worksheets/sheet1.xml", b'showErrorMessage="1"', b'showErrorMessage="both"'),
        ("xl/worksheets/sheet1.xml", b"<mergeCells ", b'<pageSetup orientation="portrait"/><mergeCells '),
        ("xl/worksheets/sheet3.xml", b' t="str"', b' t="text"'),
        ("xl/styles.xml", b"<fonts count=", b"<fonts size="),
        ("xl/workbook.xml", b"<definedName name=", b"<definedName label="),
        ("xl/charts/chart1.xml", b"<c:scatterStyle ", b"<c:scatterLook "),
    ],
)
def test_the_judge_sees_what_is_wrong(judge: Judge, part: str, old: bytes, new: bytes) -> None:
    files = spreadsheets.parts(without_extension(spreadsheets.paper().content))
    assert old in files[part]
    files[part] = files[part].replace(old, new, 1)
    assert {where for where, _, _ in judge(spreadsheets.packed(files), "Office2016")} == {f"/{part}"}
