"""A new index set, rule, workbook, engine or view is one module and one line, and every part takes it."""

from __future__ import annotations

import difflib
import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

AXIS = """\
from dataclasses import dataclass
from sympy import Eq
from loopsheet.report.sheet import PairAxis

@dataclass(frozen=True)
class Steps(PairAxis):
    @property
    def chosen(self):
        return Eq(self.second, self.first + 1)

    @property
    def described(self):
        return f"each two neighbours of {self.of.name}"
"""
RULE = """\
from dataclasses import dataclass
from functools import cached_property
from sympy import Sum
from loopsheet.report.sheet import Formula

@dataclass(frozen=True)
class Share(Formula):
    over: tuple

    @cached_property
    def expression(self):
        whole = self.equation.value
        return whole / Sum(whole, self.over)
"""
WORKBOOK = """\
from sympy import Symbol
from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Axis, Column, Formula, Given
from loopsheet.report.sheet import Sheet
from loopsheet.report.workbook import Measured, Workbook
from loopsheet.report.toy_axis import Steps
from loopsheet.report.toy_rule import Share

k, i, j, p, n, m = (Symbol(s, integer=True, positive=True) for s in ("k", "i", "j", "p", "n", "m"))
ROWS = Axis("readings", k, n)
STEPS = Steps("steps", p, m, of=ROWS, first=i, second=j)
h = Column("h", ROWS, Given("measured"), "m", "height of the stair")
rise = Equation("(1)", (Symbol("dh"), h[j] - h[i]), "definition", Kind.DEFINITION, "rise of a step")
own = Equation("(2)", (Symbol("w"), h[k]), "definition", Kind.DEFINITION, "weight of a reading")
dh = Column("dh", STEPS, Formula(rise), "m", "rise of a step", positive=False)
w = Column("w", ROWS, Share(own, (k, 1, n)), "1", "share of a reading")
WORKBOOK = Workbook(
    name="stairs", title="Stairs", source="a mason", ledger=lambda: Ledger((rise, own)),
    measured=(Measured("h", "m", "height"),), parameters=(),
    sheet=lambda names: Sheet((h, dh, w)),
)
"""
ENGINE = """\
from loopsheet.report.cells.values import CODES
from loopsheet.report.engines import exact
from loopsheet.report.judge.readers import Reading

def run(case):
    found = exact.evaluate(case.sheet, case.labels, case.data)
    value = {name: [None if x is None else float(x) for x in each] for name, each in found.value.items()}
    status = {name: [CODES[code] for code in each] for name, each in found.status.items()}
    for name in {"dh", "two_sums"} & value.keys():
        value[name][-1] *= 1 + 1e-9
    return Reading("abacus", "abacus 1.0", value, status)
"""
VIEW = """\
from loopsheet.report.machine.staging import put

def write(made, stage):
    lines = (f"{name} = {made.report.values.value[name][0]}" for name in made.report.sheet.by_name)
    put(stage / "stairs.txt", "\\n".join(lines))
"""
TOYS = {
    "report/toy_axis.py": AXIS,
    "report/toy_rule.py": RULE,
    "report/workbooks/stairs.py": WORKBOOK,
    "report/engines/abacus.py": ENGINE,
    "report/views/note.py": VIEW,
}
LINES = {
    "report/workbooks/__init__.py": '    "stairs": "loopsheet.report.workbooks.stairs",\n',
    "report/views/__init__.py": '    "note": ("loopsheet.report.views.note", "stairs.txt", ""),\n',
    "report/engines/__init__.py": '    "abacus": "loopsheet.report.engines.abacus:run",\n',
}
FOLDER = {
    "report.toml": 'workbook = "stairs"\n[measurements]\nfile = "h.csv"\n',
    "h.csv": "test,h [cm]\n1,17.5\n2,35.0\n3,53.1\n4,70.0\n",
}
Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """The command of a loopsheet that has the toys too: a file each, and a line in the registries."""
    place = tmp_path_factory.mktemp("toys")
    package, folder = place / "loopsheet", place / "folder"
    for name in ("report", "derivations", "templates"):
        shutil.copytree(ROOT / name, package / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("__init__.py", "__main__.py"):
        shutil.copy(ROOT / name, package / name)
    for name, text in TOYS.items():
        (package / name).write_text(text, encoding="utf-8")
    for name, line in LINES.items():
        path = package / name
        path.write_text(path.read_text(encoding="utf-8").replace("\n}\n", f"\n{line}}}\n"), encoding="utf-8")
        before, after = ((root / name).read_text().splitlines() for root in (ROOT, package))
        added = [each for each in difflib.ndiff(before, after) if each[0] in "+-"]
        assert added == [f"+ {line.rstrip()}"]
    folder.mkdir()
    for name, text in FOLDER.items():
        (folder / name).write_text(text, encoding="utf-8")

    def command(*words: str, module: str = "loopsheet") -> subprocess.CompletedProcess[str]:
        full = [sys.executable, "-m", module, *words, *(["--no-cache"] if module == "loopsheet" else [])]
        settings = {**os.environ, "PYTHONPATH": str(place)}
        return subprocess.run(full, cwd=folder, env=settings, capture_output=True, text=True, check=False)

    return command


def test_an_index_set_a_rule_and_a_workbook_reach_every_view(run: Run, tmp_path: Path) -> None:
    done = run("build", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    cells = json.loads((tmp_path / "values.json").read_text(encoding="utf-8"))["cells"]
    assert cells["dh"]["index"] == [[1, 2], [2, 3], [3, 4]]
    assert cells["dh"]["value"] == pytest.approx([0.175, 0.181, 0.169], rel=1e-15)
    assert cells["w"]["value"] == pytest.approx([h / 175.6 for h in (17.5, 35.0, 53.1, 70.0)], rel=1e-15)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count("data-cell=dh ") == 3
    assert "1-3" not in page
    with zipfile.ZipFile(tmp_path / "report.xlsx") as book:
        assert b"each two neighbours of readings" in book.read("xl/sharedStrings.xml")


def test_a_view_is_a_format_of_build(run: Run, tmp_path: Path) -> None:
    done = run("build", "--to", "note", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "stairs.txt").read_text(encoding="utf-8").splitlines()[0] == "h = 0.175"
    assert {path.name for path in tmp_path.iterdir()} == {"stairs.txt", "values.json", "manifest.json"}
    assert "note" in run("build", "--to", "nte").stderr


def test_every_engine_computes_them_and_a_new_one_is_judged_with_the_others(
    run: Run, require: Callable[..., str]
) -> None:
    """The toy engine says of its last cell what is wrong by a billionth, and is alone in that."""
    require("node")
    require("soffice", "libreoffice")
    done = run("check")
    assert done.returncode == 1, done.stderr
    assert all(f"engine     {name} " in done.stdout for name in ("numpy", "JavaScript", "xlsx", "abacus"))
    assert "not found" not in done.stdout
    assert [line for line in done.stdout.splitlines() if line.startswith("finding")] == [
        "finding: dh[3-4]: abacus is off by 9.3e-10"
    ]


def test_the_suite_of_engines_takes_a_new_one_by_its_line(run: Run) -> None:
    """Found are what it says wrong, and the case of which only 50 digits know the value."""
    suite = [str(ROOT / "tests" / "test_engines.py"), "-k", "abacus", "-p", "no:cacheprovider"]
    done = run("-q", "--no-header", *suite, module="pytest")
    failed = re.findall(r"^FAILED .*\[abacus-(\w+)\]", done.stdout, re.MULTILINE)
    assert failed == ["two_sums", "on_the_way"], done.stdout + done.stderr
    assert " passed" in done.stdout
