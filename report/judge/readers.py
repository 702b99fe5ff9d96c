"""Other programs compute the sheet: JavaScript in node or Chromium, the workbook in LibreOffice.

Each runs in a temporary folder and within a time limit. One that is not installed is told, and is no error;
one that fails is told with its message.
"""

from __future__ import annotations

import html
import io
import json
import math
import re
import shutil
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from ..cells.grid import BUDGETS, Grid, checked
from ..cells.values import CODES, Status, Values
from ..machine.programs import ProgramFailed, run
from ..machine.scratch import scratch
from ..sheet import Given, Sheet

SCRIPT_SECONDS = 120
BOOK_SECONDS = 300
"""How long a program may take."""

STORED_DIGITS = 15
"""Significant digits of a number in a file that LibreOffice writes, whichever format it is."""

BUDGETED, PARTS, SHARES = ("standard uncertainty u", "expanded uncertainty U"), "H", "I"
"""The lines of a budget, and its columns of contributions and shares: compared with what was issued."""
SURELY = 1e-3
"""How near they have to be: u has two digits, and how much of them rounding takes nobody knows."""

OK = CODES[Status.OK]
_SHOWN = 300
"""How much of a program's message is shown."""


@dataclass(frozen=True)
class Book:
    """A workbook and where the sheet's columns stand in it."""

    content: bytes
    """The xlsx file."""
    grid: Grid


@dataclass(frozen=True)
class Case:
    """What an engine is to compute."""

    sheet: Sheet
    labels: Mapping[str, Sequence[int]]
    """By axis name."""
    data: Mapping[str, Any]
    """By column name; the given columns in SI, as the NumPy engine gets them; NaN is a missing datum."""
    values: Values | None = None
    """What NumPy found, without a batch dimension."""
    book: Book | None = None
    """The report's workbook; without it, there is nothing to recalculate."""
    unmade: str = ""
    """Why there is none."""


@dataclass(frozen=True)
class Reading:
    """What an engine found, or why it found nothing."""

    engine: str
    """``numpy``, ``JavaScript``, ``xlsx``."""
    program: str = ""
    """What ran it, with its version, ``node 20.19``; empty if it needs none."""
    value: Mapping[str, Sequence[float | Fraction | None]] = field(default_factory=dict)
    """By column name; SI; None where there is no number."""
    status: Mapping[str, Sequence[str]] = field(default_factory=dict)
    """By column name; ``ok``, a code of :data:`~loopsheet.report.cells.values.CODES`, or what else the engine
    says."""
    missing: str = ""
    """The program that is not installed; then there are no values."""
    unmade: str = ""
    """Why there is nothing that it could compute; then there are no values."""
    failure: str = ""
    """What the program said when it failed; then there are no values."""
    rounded: Mapping[str, Sequence[Fraction]] = field(default_factory=dict)
    """By column name; how much of each number the engine's file may have lost, in SI; empty if it keeps all
    digits."""
    beside: tuple[str, ...] = ()
    """What of the budgets it has otherwise than they were issued."""


def of_values(values: Values) -> Reading:
    """What NumPy found.

    `values`: without a batch dimension.
    """
    numbers, codes = {}, {}
    for name in values.sheet.by_name:
        codes[name] = [CODES[Status(code)] for code in values.status[name].tolist()]
        pairs = zip(values.value[name].tolist(), codes[name], strict=True)
        numbers[name] = [number if code == OK else None for number, code in pairs]
    return Reading("numpy", "", numbers, codes)


def of_case(case: Case) -> Reading | None:
    """What NumPy found."""
    return None if case.values is None else of_values(case.values)


def _find(*names: str) -> tuple[str, str] | None:
    """The first of these programs that is installed: its name and its path."""
    return next(((name, path) for name in names if (path := shutil.which(name))), None)


def _version(path: str, name: str) -> str:
    """A program's name and the first two parts of its version."""
    try:
        found = re.search(r"\d+(\.\d+)?", run([path, "--version"], SCRIPT_SECONDS))
    except ProgramFailed:
        found = None
    return f"{name} {found[0]}" if found else name


# --- JavaScript -------------------------------------------------------------------------------------------

_NODE = 'const read = require("fs").readFileSync(0, "utf8");\nconst say = (text) => console.log(text);\n'
_PAGE = (
    'const read = document.getElementById("data").textContent;\n'
    'const say = (text) => { document.getElementById("found").textContent = text; };\n'
)
_EVALUATE = """
const given = JSON.parse(read, (key, value) => (value === null ? NaN : value));
const found = evaluateSheet(program, given.labels, given.data);
const out = {};
for (const name of Object.keys(found.value)) {
  const value = Array.from(found.value[name], (each) => (Number.isNaN(each) ? null : each));
  out[name] = [value, Array.from(found.status[name])];
}
say(JSON.stringify(out));
"""
_BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")


def run_javascript(case: Case) -> Reading:
    """Evaluate a sheet in node; without it, in Chromium."""
    lists = {name: each if isinstance(each, (list, tuple)) else [each] for name, each in case.data.items()}
    numbers = {
        name: [float(x) if math.isfinite(float(x)) else None for x in values]
        for name, values in lists.items()
    }
    text = json.dumps({"labels": {name: list(rows) for name, rows in case.labels.items()}, "data": numbers})
    node, browser = _find("node"), _find(*_BROWSERS)
    found = node or browser
    if found is None:
        return Reading("JavaScript", missing="node or Chromium")
    program = _version(found[1], "node" if node else "Chromium")
    from ..engines import javascript as printed

    runtime = printed.RUNTIME.read_text(encoding="utf-8")
    body = f"{runtime}\nconst program = {printed.program(case.sheet)};\n"
    try:
        with scratch() as here:
            out = _in_node(found[1], here, body, text) if node else _in_page(found[1], here, body, text)
        columns = json.loads(out)
        value = {name: columns[name][0] for name in case.sheet.by_name}
        status = {name: [CODES[Status(code)] for code in columns[name][1]] for name in case.sheet.by_name}
    except ProgramFailed as failed:
        return Reading("JavaScript", program, failure=str(failed))
    except (ValueError, LookupError, TypeError) as error:
        return Reading("JavaScript", program, failure=f"its answer cannot be read: {error!r}"[:_SHOWN])
    return Reading("JavaScript", program, value, status)


def _in_node(path: str, folder: Path, body: str, text: str) -> str:
    script = folder / "sheet.js"
    script.write_text(f"{body}{_NODE}{_EVALUATE}", encoding="utf-8")
    return run([path, str(script)], SCRIPT_SECONDS, text)


def _in_page(path: str, folder: Path, body: str, text: str) -> str:
    """Chromium prints the page after its script has run; what the script threw is printed instead."""
    page = folder / "sheet.html"
    guarded = (
        f"window.onerror = (text) => {{ document.getElementById('failed').textContent = text; }};\n"
        f"</script><script>{body}{_PAGE}{_EVALUATE}"
    )
    page.write_text(
        '<!DOCTYPE html><meta charset="utf-8">'
        f'<pre id="data">{html.escape(text)}</pre><pre id="found"></pre><pre id="failed"></pre>'
        f"<script>{guarded}</script>",
        encoding="utf-8",
    )
    switches = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder / 'profile'}"]
    out = run([path, *switches, "--dump-dom", page.as_uri()], SCRIPT_SECONDS)
    found, failed = (re.search(rf'<pre id="{name}">([^<]*)</pre>', out) for name in ("found", "failed"))
    if found is None or not found[1]:
        raise ProgramFailed(
            html.unescape(failed[1])[:_SHOWN] if failed and failed[1] else "the page stayed empty"
        )
    return html.unescape(found[1])


# --- the workbook -----------------------------------------------------------------------------------------

# Not in threads: with them LibreOffice 7.4 leaves #VALUE! in whole columns of a fit to 500 rows.
ALWAYS_RECALCULATE = """<?xml version="1.0" encoding="UTF-8"?>
<oor:items xmlns:oor="http://openoffice.org/2001/registry" xmlns:xs="http://www.w3.org/2001/XMLSchema"
 xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
<item oor:path="/org.openoffice.Office.Calc/Formula/Load"><prop oor:name="OOXMLRecalcMode" oor:op="fuse">
<value>0</value></prop></item>
<item oor:path="/org.openoffice.Office.Calc/Formula/Calculation">
<prop oor:name="UseThreadedCalculationForFormulaGroups" oor:op="fuse"><value>false</value></prop></item>
</oor:items>
"""
_MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
_RELATION = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"


def run_workbook(case: Case) -> Reading | None:
    """Let LibreOffice recalculate a workbook whose results were taken out, and read it back.

    LibreOffice computes with doubles, and stores the 15 digits that it shows at most: what was computed may
    be half a unit of the fifteenth digit away from what is read, and :attr:`Reading.rounded` says how much
    that is. Values are read in the unit of their cells and turned into SI as fractions, which round nothing.
    """
    book = case.book
    if book is None:
        return Reading("xlsx", unmade=case.unmade) if case.unmade else None
    found = _find("soffice", "libreoffice")
    if found is None:
        return Reading("xlsx", missing="LibreOffice")
    program = _version(found[1], "LibreOffice")
    try:
        cells = _recalculated(found[1], book.content)
        value, status, rounded = _columns(case.sheet, book.grid, cells)
        issued = read_cells(book.content, BUDGETS).get(BUDGETS, {})
        beside = tuple(_unlike(issued, cells.get(BUDGETS, {})))
    except ProgramFailed as failed:
        return Reading("xlsx", program, failure=str(failed))
    except (OSError, KeyError, ValueError, zipfile.BadZipFile, ElementTree.ParseError) as error:
        return Reading("xlsx", program, failure=f"its file cannot be read: {error!r}"[:_SHOWN])
    return Reading("xlsx", program, value, status, rounded=rounded, beside=beside)


def _recalculated(soffice: str, content: bytes) -> dict[str, dict[str, float | str]]:
    """Every cell of the workbook after LibreOffice computed it."""
    with scratch() as folder:
        profile, made = folder / "profile", folder / "made"
        (profile / "user").mkdir(parents=True)
        # Without this LibreOffice would believe the values of a file that says where it comes from.
        (profile / "user" / "registrymodifications.xcu").write_text(ALWAYS_RECALCULATE, encoding="utf-8")
        given = folder / "report.xlsx"
        given.write_bytes(without_results(content))
        command = [soffice, f"-env:UserInstallation={profile.as_uri()}", "--headless", "--convert-to", "xlsx"]
        run([*command, "--outdir", str(made), str(given)], BOOK_SECONDS)
        if not (made / "report.xlsx").is_file():
            raise ProgramFailed("made no file")  # and ended as if all were well
        return read_cells((made / "report.xlsx").read_bytes())


def without_results(content: bytes) -> bytes:
    """A workbook whose formulas have no stored results: what is read back was computed."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(buffer, "w") as new:
        for name in old.namelist():
            part = old.read(name)
            if name.startswith("xl/worksheets/sheet"):
                part = re.sub(rb"(</f>|<f [^>]*/>)<v>[^<]*</v>", rb"\1", part)
            new.writestr(name, part, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def _unlike(issued: Mapping[str, float | str], found: Mapping[str, float | str]) -> Iterator[str]:
    """What of budgets was computed otherwise than it was issued: u, U, contributions and shares."""
    for at, was in issued.items():
        share = issued.get(f"{SHARES}{at[1:]}")
        named = at[0] == "B" and issued.get(f"A{at[1:]}") in BUDGETED
        named |= at[0] == PARTS and isinstance(share, float) and abs(share) > SURELY
        if isinstance(was, float) and (named or at[0] == SHARES):
            now = found.get(at, "nothing")
            least = 0.0 if named else SURELY
            if not (isinstance(now, float) and math.isclose(now, was, rel_tol=SURELY, abs_tol=least)):
                yield f"xlsx has {now} in {BUDGETS}!{at}, where {was:.4g} was issued"


def read_cells(content: bytes, only: str = "") -> dict[str, dict[str, float | str]]:
    """Every cell of a workbook that holds something: a number, or its text; an error's name is a text.

    `only`: the worksheet that is read; all of them without it.

    Returns
    -------
    mapping of worksheet to mapping of address to float or str
    """
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        parts = {
            relation.get("Id"): str(relation.get("Target"))
            for relation in ElementTree.fromstring(archive.read("xl/_rels/workbook.xml.rels"))
        }
        shared: list[str] = []
        if "xl/sharedStrings.xml" in archive.namelist():
            table = ElementTree.fromstring(archive.read("xl/sharedStrings.xml"))
            shared = ["".join(t.text or "" for t in item.iter(f"{_MAIN}t")) for item in table]
        found: dict[str, dict[str, float | str]] = {}
        for entry in ElementTree.fromstring(archive.read("xl/workbook.xml")).iter(f"{_MAIN}sheet"):
            if only not in ("", entry.get("name")):
                continue
            target = parts[entry.get(_RELATION)]
            path = target.removeprefix("/") if target.startswith("/") else f"xl/{target}"
            worksheet = ElementTree.fromstring(archive.read(path))
            found[str(entry.get("name"))] = dict(_cells(worksheet, shared))
        return found


def _cells(worksheet: ElementTree.Element, shared: Sequence[str]) -> Iterator[tuple[str, float | str]]:
    for cell in worksheet.iter(f"{_MAIN}c"):
        kind, text = cell.get("t", "n"), cell.findtext(f"{_MAIN}v")
        address = str(cell.get("r"))
        if kind == "inlineStr":
            yield address, "".join(t.text or "" for t in cell.iter(f"{_MAIN}t"))
        elif text:
            yield address, float(text) if kind == "n" else shared[int(text)] if kind == "s" else text


def _columns(
    sheet: Sheet, grid: Grid, cells: Mapping[str, Mapping[str, float | str]]
) -> tuple[dict[str, list[Fraction | None]], dict[str, list[str]], dict[str, list[Fraction]]]:
    """Values in SI of every column, their codes, and what their storage may have cut."""
    value: dict[str, list[Fraction | None]] = {}
    status: dict[str, list[str]] = {}
    rounded: dict[str, list[Fraction]] = {}
    for column in sheet.columns:
        place = grid[checked(column.name) if isinstance(column.rule, Given) else column.name].place
        found = [
            cells[place.worksheet].get(address.replace("$", ""))
            for address in place.cells(range(place.rows), place.worksheet)
        ]
        numbers = [x if isinstance(x, float) and math.isfinite(x) else None for x in found]
        value[column.name] = [None if x is None else Fraction(x) * place.scale + place.zero for x in numbers]
        rounded[column.name] = [Fraction(0) if x is None else _lost(x) * place.scale for x in numbers]
        status[column.name] = [
            OK if x is not None else held if isinstance(held, str) and held.startswith("#") else "nothing"
            for x, held in zip(numbers, found, strict=True)
        ]
    return value, status, rounded


def _lost(stored: float) -> Fraction:
    """Half a unit of the last digit that is stored.

    >>> _lost(1.25), _lost(0.0)
    (Fraction(1, 200000000000000), Fraction(0, 1))
    """
    if stored == 0:
        return Fraction(0)
    exponent = int(f"{stored:e}".partition("e")[2])
    return Fraction(10) ** (exponent - STORED_DIGITS + 1) / 2
