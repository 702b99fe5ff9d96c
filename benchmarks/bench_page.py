"""How fast the live page follows an edit: recalculation with redrawing, for 5 and for 40 tests, in Chromium.

Prints medians of 50 edits each: what the script takes (a new sheet, tables, figures, formula bar), and the
same with the browser's layout of what is near the window. The pages take turns, and the least of each says
what the machine can do when nothing else is running on it. Needs playwright and a Chromium; nothing here is
a test.
"""

from __future__ import annotations

import shutil
import statistics
import sys
import tempfile
from pathlib import Path

from loopsheet.report import stages
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study
from loopsheet.report.views import figures, html

EDITS = 50
ROUNDS = 5
DRIVE = """async (edits) => {
  const input = document.getElementById("cell-x_p-2"), first = Number(input.value), found = [];
  for (let n = 1; n <= edits; n++) {
    input.focus();
    input.dispatchEvent(new InputEvent("beforeinput", { bubbles: true }));
    input.value = (first + 0.01 * n).toFixed(2);
    const begin = performance.now();
    input.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
    const script = Number(document.documentElement.dataset.milliseconds);
    document.body.offsetHeight;
    found.push([script, performance.now() - begin]);
    await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
  }
  return found;
}"""


def campaign(folder: Path, tests: int) -> Path:
    """A report folder with so many tests of one power law, printed as an instrument would."""
    alpha, coefficient, mass, beta = 1.3, 9.6e8, 8.366e-3, 1.5
    lines = ["test,v [m/s],e [1],x_p [um]"]
    for test in range(1, tests + 1):
        v = 2.0 + 3.6 * test / tests
        e = 0.56 - 0.022 * v
        x_m = ((alpha + 1) * mass * v**2 / (2 * coefficient)) ** (1 / (alpha + 1))
        x_p = x_m * (1 - (beta + 1) / (alpha + 1) * e**2)
        lines.append(f"{test},{v:.3f},{e:.4f},{1e6 * x_p:.2f}")
    folder.mkdir()
    (folder / "measurements.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "report.toml").write_text(
        f'title = "{tests} tests"\nworkbook = "soft_impact"\n'
        '[parameters]\nball_mass = "8.366 g"\nbeta = "1.5"\n[measurements]\nfile = "measurements.csv"\n',
        encoding="utf-8",
    )
    return folder


def page(folder: Path, target: Path) -> Path:
    """The page of a report folder, as a file."""
    report = Study(folder).computed
    made = {each.name: figures.files(report, each.drawing, ["svg"]) for each in report.workbook.figures}
    drawn = {name: files["svg"].decode() for name, files in made.items()}
    target.write_text(html.render(report, drawn, stages.program(report)), encoding="utf-8")
    return target


def main() -> int:
    """Print the table."""
    from playwright.sync_api import sync_playwright

    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        print("no Chromium was found: the page is not measured")
        return 0
    with tempfile.TemporaryDirectory() as name, sync_playwright() as playwright:
        here = Path(name)
        pages = {
            "5 tests (the paper)": page(PAPER, here / "paper.html"),
            "40 tests": page(campaign(here / "forty", 40), here / "forty.html"),
        }
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox", "--disable-gpu"])
        tabs = {what: browser.new_page(viewport={"width": 1280, "height": 900}) for what in pages}
        found: dict[str, list[list[float]]] = {what: [] for what in pages}
        for what, tab in tabs.items():
            tab.goto(pages[what].as_uri())
        for _ in range(ROUNDS):
            for what, tab in tabs.items():
                tab.bring_to_front()
                found[what] += tab.evaluate(DRIVE, EDITS // ROUNDS)
        for what, path in pages.items():
            script, whole = zip(*found[what], strict=True)
            print(
                f"{what:20} {path.stat().st_size / 1000:7.0f} kB   "
                f"script {statistics.median(script):6.1f} ms (least {min(script):.1f} ms)   "
                f"with layout {statistics.median(whole):6.1f} ms (least {min(whole):.1f} ms), "
                f"median of {EDITS} edits"
            )
        browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
