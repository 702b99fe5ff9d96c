"""The uncertainties that the page computes: those of the report, and after an edit those of a rebuild."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from shutil import copytree
from typing import Any

import gas
import numpy as np
import pytest
import test_order
from helpers import in_node, method_folder
from test_digits import CAMPAIGNS

from loopsheet.report import stages
from loopsheet.report.cli import main
from loopsheet.report.document.material import Material
from loopsheet.report.engines.javascript import RUNTIME
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.numbers import shown
from loopsheet.report.result.result import Report
from loopsheet.report.sheet import Given, RepeatAxis
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.propagation import Spread
from loopsheet.report.views import live
from loopsheet.report.views.writer import TEMPLATES

SCRIPTS = ("numbers.js", "inputs.js", "trace.js", "sensitivities.js", "coverage.js", "readings.js", "sure.js")
SCRIPTS += ("cells.js",)
HARNESS = """
const tables = Object.fromEntries(Object.entries(LIVE.tables).map(([axis, { rows }]) => [axis, rows]));
const state = { tables, parameters: LIVE.parameters };
for (const [name, label, text] of EDITS) {
  const test = Object.values(tables)[0].find((one) => one.label === label);
  if (label && !text) test.used = false;
  else if (label) test.cells[name] = text;
  else state.parameters[name] = text;
}
const trace = new Trace(PROGRAM, LIVE.columns, computeSheet(PROGRAM, LIVE.columns, state));
const look = new Look(trace, state, null), cells = {}, follow = Boolean(LIVE.shared);
for (const { name } of CELLS) {
  const rows = [...trace.sheet.value[name].keys()], figures = look.column(name).figures;
  cells[name] = { shown: figures.map((figure) => figure && figureText(figure)) };
  cells[name].values = [...trace.sheet.value[name]];
  if (follow) cells[name].u = rows.map((row) => look.sure.u(name, row));
  if (follow && rows.length) cells[name].factor = look.sure.budget(name, 0).factor;
  if (follow) cells[name].parts = rows.map((row) => [...look.sure.parts(name, row)]);
}
const errors = follow ? look.sure.errors.map(({ called }) => called) : null;
console.log(JSON.stringify({ cells, errors }, (_, value) => Number.isNaN(value) ? null : value));
"""

Edits = list[tuple[str, int, str]]
Told = Callable[[Report, Edits], Any]


def of_page(node: str, report: Report, known: dict[str, Any], scripts: tuple[str, ...], harness: str) -> Any:
    """What a harness behind some of the page's scripts prints of a report; `known`: its constants."""
    head = [f"const LIVE = {live.data(report, Material(report))};"]
    head += [f"const {name} = {json.dumps(value)};" for name, value in known.items()]
    head += ["LIVE.columns = wholeColumns(LIVE.columns);", f"const PROGRAM = {stages.program(report)};"]
    own = [(TEMPLATES / "live" / name).read_text(encoding="utf-8") for name in scripts]
    return in_node(node, RUNTIME.read_text(encoding="utf-8"), *head, *own, harness)


@pytest.fixture(scope="session")
def told(require: Callable[..., str]) -> Told:
    """What the page's scripts tell of the cells of a report, in node."""
    return lambda report, edits: of_page(require("node"), report, {"EDITS": edits}, SCRIPTS, HARNESS)


def agrees(found: Any, report: Report, before: Report) -> None:
    """Every uncertainty that is of first order, to six digits; and every computed cell as it is shown."""
    known, issued = report.uncertain(), before.uncertain()
    passed = {column.name for loop in report.sheet.loops for column in loop.formulas}
    for column in report.sheet.columns:
        if isinstance(column.axis, RepeatAxis):
            continue
        name, cells = column.name, found["cells"][column.name]
        # Where it hangs on the last bit of a value how that is rounded, it may be rounded either way.
        values = [x if x is None else report.shown[name].of(x) for x in cells["values"]]
        texts = [figure and figure.text for figure in shown(values, report.places(name))]
        for row, u in enumerate(known.u[name]):
            kept = known.second[name][row] or issued.second[name][row] or not report.values.value[name][row]
            if not isinstance(column.rule, Given) and not kept:
                assert cells["shown"][row] == texts[row], (name, row)
            # What comes to zero where a loop rests has an uncertainty of nothing but the last pass.
            at_rest = name in passed and not report.values.value[name][row]
            if "u" in cells and not known.second[name][row] and not at_rest:
                wanted = None if math.isnan(u) else pytest.approx(u, rel=1e-5, abs=1e-300)
                assert cells["u"][row] == wanted, (name, row)


EXAMPLES = sorted(folder.name for folder in PAPER.parent.iterdir() if (folder / "report.toml").exists())


@pytest.mark.parametrize("name", [*CAMPAIGNS, *EXAMPLES])
def test_as_issued(told: Told, tmp_path: Path, name: str) -> None:
    folder = CAMPAIGNS[name](tmp_path) if name in CAMPAIGNS else PAPER.parent / name
    report = Study(folder).computed
    found = told(report, [])
    agrees(found, report, report)
    if found["errors"] is not None:
        spread = Spread(report.inputs, report.values)
        assert found["errors"] == [source.name for source in spread.sources]
        for headline in report.workbook.headline:
            if report.values.status[headline][0] or not spread.sources:  # all that was given is exact
                continue
            (own,) = spread.contributions([(headline, 0)])
            mine = found["cells"][headline]["parts"][0]
            if not (budget := spread.budget(headline, 0)).second:
                # U has two digits: this moves none of them but where it is as good as half-way between two
                assert found["cells"][headline]["factor"] == pytest.approx(budget.factor, rel=1e-3)
            # Curves of two tests at one speed end at the same approach: the lesser of both has no one slope.
            twice = len(set(report.values.value.get("v", ()))) < len(report.inputs.only.tests)
            np.testing.assert_allclose(
                mine, own, rtol=1e-4, atol=(0.01 if twice else 1e-6) * np.abs(own).max()
            )


def test_what_bends_as_issued_has_the_digits_of_its_first_order_far_away(told: Told, tmp_path: Path) -> None:
    """A sum of squares of errors alone, which is of second order, and one of a test that is far off."""
    texts = {}
    for depth in ("44.61", "60.00"):
        folder = tmp_path / depth
        assert main(["new", str(folder)]) == 0
        path = folder / "measurements.csv"
        path.write_text(path.read_text(encoding="utf-8").replace("44.61", depth), encoding="utf-8")
        texts[depth] = Study(folder).computed
    before, after = texts.values()
    assert [bool(report.uncertain().second["chi2_eiv"][0]) for report in (before, after)] == [True, False]
    for edits, report in (([], before), ([("x_p", 3, "60.00")], after)):
        found = told(before, edits)["cells"]["chi2_eiv"]["shown"]
        assert found == [figure and figure.text for figure in report.figures("chi2_eiv")]


def test_what_bends_as_issued_has_its_digits_where_it_is_less(told: Told, tmp_path: Path) -> None:
    """Speeds over the one that yields, of which a third is left by a softer target."""
    texts = ("210 GPa, u = 5 GPa", "71 GPa, u = 5 GPa")
    folder = copytree(PAPER.parent / "contact_models", tmp_path / "models", ignore=lambda *_: ["out"])
    toml = (folder / "report.toml").read_text(encoding="utf-8")
    before = Study(folder).computed
    (folder / "report.toml").write_text(
        toml.replace(f'E_1 = "{texts[0]}"', f'E_1 = "{texts[1]}"'), encoding="utf-8"
    )
    after = Study(folder).computed
    assert before.uncertain().second["v_over_Y"].all()
    found = told(before, [("E_1", 0, texts[1].partition(" ")[0])])["cells"]["v_over_Y"]["shown"]
    assert found == [figure and figure.text for figure in after.figures("v_over_Y")]


def test_rounding_where_a_loop_rests_has_no_digits(told: Told, tmp_path: Path) -> None:
    assert main(["new", str(tmp_path / "fit"), "--workbook", "fit"]) == 0
    report = Study(tmp_path / "fit").computed
    (text,) = told(report, [])["cells"]["curve_d2"]["shown"]
    assert len(re.sub("\u00a0.*|\\D", "", text)) <= 3


def test_temperatures_have_a_zero_of_their_own(told: Told, tmp_path: Path) -> None:
    """The page reads degC as a build does, and shows it so."""
    before = Study(gas.folder(tmp_path / "before")).computed
    agrees(told(before, []), before, before)
    toml = gas.TOML.replace('R = "', 'T_0 = "-40.0 degF"\nR = "').replace("1.5 delta", "2.25 delta")
    after = Study(gas.folder(tmp_path / "after", toml, gas.TABLE.replace("-3.2", "-13.7"))).computed
    found = told(before, [("T", 3, "-13.7"), ("T_0", 0, "-40.0"), ("dT", 0, "2.25")])
    assert found["cells"]["T"]["values"][2] == 259.45
    assert found["cells"]["T_0"]["values"] == [233.15]
    agrees(found, after, before)


MEASURED = """test,v [m/s],u(v) [m/s],e [1],x_p [um]
1,2.334,0.003,0.530,23.5(4)
2,2.940,0.003,0.512,29.7
3,4.089,0,0.479,41.60
4,4.504,0.004,0.467,45.97
"""
STATED = """title = "Stated"
workbook = "soft_impact"
[parameters]
ball_diameter = "12.7 mm, 0.5 % of reading + 1 digit"
ball_density = "7800(40) kg/m^3"
[measurements]
file = "measurements.csv"
[uncertainty]
e = "0.5 % of reading + 2 digits"
[uncertainty.shared."height datum"]
of = "x_p"
stated = "+-0.2 um rect"
groups = [[1, 2], [3, 4]]
[uncertainty.shared."gain"]
of = ["v", "ball_diameter"]
stated = "0.2 % of reading"
[uncertainty.correlation]
"v, e" = "0.3"
"""


@pytest.mark.parametrize(
    "edits",
    [
        [("e", 1, "0.54")],
        [("x_p", 2, "29.83"), ("x_p", 3, "41.8"), ("v", 2, "2.95"), ("ball_diameter", 0, "12.80")],
        [("ball_density", 0, "7900"), ("v", 1, "2.3"), ("e", 4, "0.4650")],
    ],
)
def test_an_edit_is_a_rebuild(told: Told, tmp_path: Path, edits: Edits) -> None:
    """Whatever is stated: of a column, a number, several tests, or two columns together."""
    reports = []
    for name, edited in ("issued", ()), ("edited", edits):
        csv, toml = MEASURED, STATED
        for column, test, text in edited:
            if not test:
                toml = re.sub(rf'(?m)^({column} = ")[0-9.]+', rf"\g<1>{text}", toml)
                continue
            lines = csv.splitlines()
            fields, place = lines[test].split(","), ("", "v", "u", "e", "x_p").index(column)
            fields[place] = re.sub(r"^[0-9.]+", text, fields[place])
            lines[test] = ",".join(fields)
            csv = "\n".join(lines) + "\n"
        folder = tmp_path / name
        folder.mkdir()
        (folder / "report.toml").write_text(toml, encoding="utf-8")
        (folder / "measurements.csv").write_text(csv, encoding="utf-8")
        reports.append(Study(folder).computed)
    issued, rebuilt = reports
    agrees(told(issued, edits), rebuilt, issued)


PIPETTE = """from loopsheet import Method, given, let, mean, measured


class Pipette(Method, rows="deliveries", headline="V"):
    "A pipette by weighing."
    m = measured("mg", "mass of a delivery")
    rho = given("kg/m^3", "density of the water", default="997.5(2) kg/m^3")
    V = let(mean(m) / rho, "mean volume", "uL")
"""
READINGS = {
    "paired": ("", [("V", 2, "4.99"), ("I", 5, "19.7")]),
    "paired, one left out": ("", [("V", 3, ""), ("phi", 1, "1.05")]),
    "paired, one that stands still": ("", [("V", row, "5.000") for row in range(1, 6)]),
    "scatter": ("scatter", [("m", 2, "1003.1")]),
    "scatter, one left out": ("scatter", [("m", 4, "")]),
    "scatter and a resolution": ("scatter; 1 digit", [("m", 2, "1003.1"), ("rho", 0, "990.0")]),
    "scatter of none": ("scatter", [("m", row, "998.0") for row in range(1, 5)]),
    "scatter of none and a resolution": ("scatter; 1 digit", [("m", row, "998.0") for row in range(1, 5)]),
}


@pytest.mark.parametrize("name", READINGS)
def test_how_readings_scatter_follows_an_edit(told: Told, tmp_path: Path, name: str) -> None:
    """With its degrees of freedom, and how readings that were taken together are correlated."""
    stated, edits = READINGS[name]
    folders = tmp_path / "issued", tmp_path / "edited"
    for folder in folders:
        if not stated:
            copytree(PAPER.parent / "gum_h2", folder, ignore=lambda *_: ["out", "published.csv"])
            toml = (folder / "report.toml").read_text(encoding="utf-8").partition("[published]")[0]
            (folder / "report.toml").write_text(toml, encoding="utf-8")
        else:
            rows = "delivery,m [mg]\n1,998.1\n2,999.4\n3,997.2\n4,998.8\n"
            more = f'[parameters]\nrho = "997.5(2) kg/m^3"\n[uncertainty]\nm = "{stated}"\n'
            method_folder(folder, PIPETTE, rows, more)
    for column, row, text in edits:
        place = folders[1] / ("measurements.csv" if row else "report.toml")
        lines = place.read_text(encoding="utf-8").splitlines()
        if row and text:
            at = [head.partition(" ")[0] for head in lines[0].split(",")].index(column)
            lines[row] = ",".join([*lines[row].split(",")[:at], text, *lines[row].split(",")[at + 1 :]])
        elif row:
            lines[row] = ""
        else:
            lines = [line.replace('rho = "997.5', f'rho = "{text}') for line in lines]
        place.write_text("\n".join(line for line in lines if line) + "\n", encoding="utf-8")
    issued, rebuilt = (Study(folder).computed for folder in folders)
    found, spread = told(issued, edits), Spread(rebuilt.inputs, rebuilt.values)
    (name, *_) = rebuilt.workbook.headline
    assert issued.uncertain().u[name][0] != pytest.approx(rebuilt.uncertain().u[name][0], rel=0.01)
    agrees(found, rebuilt, issued)
    for headline in rebuilt.workbook.headline:
        budget = spread.budget(headline, 0)
        assert found["cells"][headline]["factor"] == pytest.approx(budget.factor, rel=1e-3)


@pytest.mark.parametrize(
    "edits",
    [
        [],
        [("d", 2, "11.900")],  # what was the greatest is the least
        [("d", 3, "12.050")],  # two are the greatest, and one more has a value
        [("d", 4, "0.500"), ("T", 4, "-30.0"), ("T", 1, "-40.0")],
        [("d_0", 0, "12.010"), ("d", 3, "12.060")],
    ],
)
def test_what_is_taken_by_order_follows_an_edit(told: Told, tmp_path: Path, edits: Edits) -> None:
    """Other rows are taken then, and may have a value that had none."""
    issued = Study(test_order.folder(tmp_path / "issued")).computed
    table, toml = test_order.TABLE, test_order.TOML
    for name, place, text in edits:
        lines = table.splitlines()
        if place:
            cells = lines[place].split(",")
            cells["_dT".index(name)] = text
            lines[place] = ",".join(cells)
        else:
            toml = re.sub(r'd_0 = "[\d.]+', f'd_0 = "{text}', toml)
        table = "\n".join(lines) + "\n"
    folder = test_order.folder(tmp_path / "edited", table)
    (folder / "report.toml").write_text(toml, encoding="utf-8")
    rebuilt, found = Study(folder).computed, told(issued, edits)
    agrees(found, rebuilt, issued)
    for name in rebuilt.workbook.headline:
        assert found["cells"][name]["values"] == pytest.approx(rebuilt.values.value[name], rel=1e-9)
        assert found["cells"][name]["u"] == pytest.approx(rebuilt.uncertain().u[name], rel=1e-6)
