"""The live page in a browser: what a user does to it, what it shows, and what it should show.

What it should show comes from a build of a folder with the same inputs, never from the page.
"""

import csv
import io
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Download, Locator, Page
from uncertain_data import MISFITS, lost_to_differences

from loopsheet.report.cells.values import CODES, Status, Values
from loopsheet.report.engines import numpy as engine
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.prepared import sheet_data
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import html

LARGEST = 1e-12
"""Largest relative difference between a cell of the page and NumPy's."""

Tests = Mapping[int, Mapping[str, str]]
"""Printed measurements by test and column."""

# --- what a page shows ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Shown:
    """A cell of the page."""

    name: str
    index: str
    value: str
    status: str
    text: str
    layout: str
    """How far it is padded, so that the decimal points stand below each other."""
    changed: bool
    added: bool
    title: str
    mark: str
    """What it lies outside of."""


_CELLS = """() => Array.from(document.querySelectorAll("main [data-cell][data-value]%s"), (cell) => {
  const box = cell.tagName === "INPUT" ? cell.parentElement : cell;
  return [cell.dataset.cell, cell.dataset.index, cell.dataset.value, cell.dataset.status,
    cell.tagName === "INPUT" ? cell.value : cell.textContent,
    Array.from(box.classList).filter((word) => /^(p[0-9]|nopoint|error)$/.test(word)).sort().join(" "),
    cell.classList.contains("changed"), cell.classList.contains("added"), cell.title,
    cell.dataset.mark ?? ""];
})"""


def shown(cells: list[Shown]) -> list[str]:
    """What a reader sees of the cells: their characters and their marks."""
    return [f"{cell.name} {cell.index}: {cell.text} {cell.mark}" for cell in cells]


_SHOWN = re.compile("([-\u2212]?)(\\d[\\d\u202f]*)(\\.\\d+)?(?:[ \u00a0]×[ \u00a0]10([⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+))?")

_REFEREED = re.compile(
    r"(?<=differs), unexpectedly"
    r"| \d+ of these findings (?:was|were) not expected\.| A build of what stands here tells .* differences\."
)


def alike(ours: list[str], theirs: list[str]) -> bool:
    """Whether texts say the same, in numbers as far as both have digits.

    An edited page keeps the digits that uncertainties left it as issued; a build of what was edited has those
    that follow from its own. And it asks a referee whether a difference is a finding, which no page can.
    """

    def read(found: re.Match[str]) -> tuple[Fraction, Fraction]:
        sign, whole, fraction, power = found.groups("")
        exponent = int(power.translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")) or 0)
        size = Fraction(f"{whole}{fraction}".replace("\u202f", "")) * Fraction(10) ** exponent
        return -size if sign else size, Fraction(10) ** (exponent - len(fraction[1:]))

    def same(one: str, other: str) -> bool:
        pairs = zip(map(read, _SHOWN.finditer(one)), map(read, _SHOWN.finditer(other)), strict=True)
        return all(abs(a - b) <= (last + least) / 2 for (a, last), (b, least) in pairs)

    ours, theirs = ([_REFEREED.sub("", text) for text in texts] for texts in (ours, theirs))
    return [_SHOWN.sub("#", text) for text in ours] == [_SHOWN.sub("#", text) for text in theirs] and all(
        map(same, ours, theirs)
    )


# What stands beside the cells and follows from them. A build says of a cell without a value that it has none,
# an edited page shows its code in the sentence as issued; of a published value of a test that is left out a
# build says nothing.
_AROUND = """() => {
  const text = (element) => element.textContent.replace(/\\s+/g, " ").trim();
  const all = (selector) => Array.from(document.querySelectorAll(selector), text);
  const missing = document.getElementById("missing");
  return [...all("#published tbody tr").filter((text) => !/–\\S*left out/.test(text)),
    ...(missing && !missing.hidden ? all("#missing tbody tr") : []),
    ...all("#result > p:not(.stale)").filter((text) => !/#[A-Z]+!|no value: /.test(text)),
    ...all(".headline dd"), ...all("#published > ul > li"),
    ...all("#uncertain > .legend:not([hidden])").filter(Boolean)];
}"""

# A window that nobody sees may be drawn once a minute, or never: no frame is waited for longer than it takes.
FRAME = "new Promise((drawn) => { requestAnimationFrame(drawn); setTimeout(drawn, 500); })"

# When all that waits for the next frame has been done.
_STATE = """async () => {
  const busy = () => document.querySelector("[aria-busy]");
  for (let n = 0; n < 3 || busy(); n++) await FRAME;
  return [document.getElementById("main").innerHTML,
    ...Array.from(document.querySelectorAll("main input"), (input) => `${input.value} ${input.checked}`)];
}""".replace("FRAME", FRAME)

# Put a text into the clipboard when the next thing is copied, whatever that is.
_COPY = """(text) => addEventListener("copy", (event) => {
  event.clipboardData.setData("text/plain", text);
  event.preventDefault();
  event.stopImmediatePropagation();
}, { capture: true, once: true })"""


@dataclass
class Live:
    """A page in a browser, and everything that went wrong in it."""

    page: Page
    path: Path
    errors: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("console", lambda said: said.type == "error" and self.errors.append(said.text))
        self.page.on("request", lambda request: self.requests.append(request.url))

    def load(self, at: str = "") -> None:
        """Load it as the link has it that ends so."""
        self.page.goto(self.path.as_uri() + at)

    # what it shows

    def cells(self, outside: str = "") -> list[Shown]:
        """All that are shown, or those outside of the elements of a selector."""
        where = f":not({outside} *)" if outside else ""
        return [Shown(*fields) for fields in self.page.evaluate(_CELLS.replace("%s", where))]

    def cell(self, name: str, index: str = "") -> Shown:
        return next(cell for cell in self.cells() if (cell.name, cell.index) == (name, index))

    def around(self) -> list[str]:
        found: list[str] = self.page.evaluate(_AROUND)
        return found

    def wait_for_draws(self) -> None:
        """Until a worker has looked at terms of second order, and drawn."""
        self.page.evaluate("() => self.beginDraws?.()")
        self.page.wait_for_function("() => document.documentElement.dataset.draws === 'done'")

    def state(self) -> list[str]:
        """Every character of the report, and what stands in its inputs."""
        found: list[str] = self.page.evaluate(_STATE)
        return found

    def drawn(self) -> None:
        """Wait until all pictures are: those that are not seen are drawn a moment after an edit."""
        self.page.wait_for_function("() => !document.querySelector('[aria-busy]')")

    def paths(self, figure: str) -> list[str]:
        self.drawn()
        found: list[str] = self.page.eval_on_selector_all(
            f"#figure-{figure} svg path", "paths => paths.map((path) => path.getAttribute('d'))"
        )
        return found

    def text(self, identifier: str) -> str:
        return self.page.locator(f"#{identifier}").inner_text()

    def heard(self) -> list[str]:
        """Every error so far."""
        return self.errors

    def focused(self) -> str:
        """The address of the cell that has the focus, or the id of another element."""
        found: str = self.page.evaluate(
            "() => { const { dataset, id } = document.activeElement;"
            " return dataset.cell ? `${dataset.cell}[${dataset.index}]` : id; }"
        )
        return found

    # what a user does

    def input(self, name: str, index: str | int = "") -> Locator:
        return self.page.locator(f'main input[data-cell="{name}"][data-index="{index}"]')

    def type(self, name: str, index: str | int, text: str, key: str = "Enter") -> None:
        self.input(name, index).click()
        self.page.keyboard.type(text)
        self.page.keyboard.press(key)

    def press(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)

    def paste(self, text: str) -> None:
        """Paste where the focus is, from the machine's own clipboard."""
        self.page.evaluate(_COPY, text)
        self.press("Control+c", "Control+v")

    def click(self, identifier: str) -> None:
        self.page.locator(f"#{identifier}").click()

    def save(self, folder: Path, *others: str, file: str | Sequence[str] = "measurements.csv") -> Path:
        """Save all inputs as the page offers it; gives the folder of the files. `file`: of each table."""
        downloads: list[Download] = []

        def keep(download: Download) -> None:
            downloads.append(download)

        self.page.on("download", keep)
        self.click("live-save")
        links = self.page.locator("#live-note a[download]")
        names = [*([file] if isinstance(file, str) else file), "report.toml", *(others or ("published.csv",))]
        assert links.all_inner_texts() == names
        for _ in range(1500):  # half a minute at most
            if len(downloads) < len(names):
                self.page.wait_for_timeout(20)
        self.page.remove_listener("download", keep)
        for download in downloads:
            download.save_as(folder / download.suggested_filename)
        return folder


# --- what it should show ----------------------------------------------------------------------------------

TITLES = {"v": "v [m/s]", "e": "e [1]", "x_p": "x_p [um]"}


def paper() -> dict[int, dict[str, str]]:
    """The measurements as they are shipped."""
    rows = csv.DictReader(io.StringIO((PAPER / "measurements.csv").read_text(encoding="utf-8")))
    return {int(row["test"]): {name: row[title] for name, title in TITLES.items()} for row in rows}


def edited(edits: Mapping[tuple[str, int], str]) -> dict[int, dict[str, str]]:
    tests = paper()
    for (name, test), text in edits.items():
        tests[test][name] = text
    return tests


def write(folder: Path, tests: Tests, published: bool = False) -> Path:
    """A report folder; without the published values, which need the tests that they are about."""
    folder.mkdir(parents=True)
    lines = [",".join(["test", *TITLES.values()])]
    lines += [",".join([str(test), *(cells[name] for name in TITLES)]) for test, cells in tests.items()]
    (folder / "measurements.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "report.toml").write_bytes((PAPER / "report.toml").read_bytes())
    return compared(folder, published)


def compared(folder: Path, published: bool) -> Path:
    """Give a folder the published values of the paper, or take the word of them out of it."""
    if published:
        (folder / "published.csv").write_bytes((PAPER / "published.csv").read_bytes())
    else:
        toml = (folder / "report.toml").read_text(encoding="utf-8")
        toml = re.sub(r"^\[published\].*", "", toml, flags=re.MULTILINE | re.DOTALL)
        (folder / "report.toml").write_text(toml, encoding="utf-8")
    return folder


def built(folder: Path, tests: Tests, published: bool = False) -> Report:
    return Study(write(folder, tests, published)).computed


def static(report: Report, path: Path) -> Path:
    """The page of a report, without a script: what it shows was written by Python."""
    path.write_text(html.render(report, {}), encoding="utf-8")
    return path


def with_missing(report: Report, *refused: tuple[str, int]) -> Values:
    """The same values where some data are refused, each by its name and its test."""
    data: dict[str, Any] = sheet_data(report.sheet, report.inputs)
    for name, test in refused:
        for own in {name, f"u_{name}"} & data.keys():
            data[own] = np.array(data[own], dtype=float)
            data[own][report.inputs.only.tests.index(test)] = math.nan
    labels = {axis.name: report.inputs.only.tests for axis in report.sheet.axes if not axis.parents}
    return engine.evaluate(report.sheet, labels, data)


def differences(cells: list[Shown], values: Values) -> list[str]:
    """Every cell of the page against NumPy; a cell of a test that is left out says nothing."""
    wrong, seen, lost = [], set(), lost_to_differences(values)
    for cell in cells:
        if cell.status == "" and cell.value == "":
            continue
        address = f"{cell.name}[{cell.index}]"
        labels = ["-".join(map(str, label)) for label in values.labels(values.sheet[cell.name])]
        if cell.index not in labels:
            wrong.append(f"{address} is on the page only")
            continue
        seen.add((cell.name, cell.index))
        row = labels.index(cell.index)
        status = Status(int(values.status[cell.name][row]))
        if cell.status != CODES[status]:
            wrong.append(f"{address}: {cell.status} instead of {CODES[status]}")
        elif status != Status.OK:
            if cell.value:
                wrong.append(f"{address}: {cell.value} beside {cell.status}")
        elif not close(
            cell.value, float(values.value[cell.name][row]), lost if cell.name in MISFITS else 1.0
        ):
            wrong.append(f"{address}: {cell.value} instead of {values.value[cell.name][row]!r}")
    for name in {cell.name for cell in cells}:
        for label in values.labels(values.sheet[name]):
            index = "-".join(map(str, label))
            if (name, index) not in seen:
                wrong.append(f"{name}[{index}] is not on the page")
    return wrong


def close(text: str, value: float, lost: float = 1.0) -> bool:
    # A cell without a number compares as different.
    return bool(re.fullmatch(r"[-+.0-9e]+", text)) and abs(float(text) - value) <= lost * LARGEST * abs(value)
