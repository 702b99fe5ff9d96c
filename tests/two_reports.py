"""A laboratory's report of imprint depths, from which others take a column and a number."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from loopsheet.report.cli import main

HEAD = """\
from sympy import Sum, Symbol
from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Parameter, Workbook

k, n = (Symbol(s, integer=True, positive=True) for s in ("k", "n"))
ROWS = Axis("drops", k, n)
made, equations = {}, []

def measured(name, unit):
    made[name] = Column(name, ROWS, Given("measured"), unit, name)
    return made[name]

def given(name, unit):
    made[name] = Column(name, None, Given("parameter"), unit, name, positive=False)
    return made[name].symbol

def computed(name, unit, right, axis=None):
    eq = Equation(f"({len(equations) + 1})", (Symbol(name), right), "definition", Kind.DEFINITION, name)
    equations.append(eq)
    made[name] = Column(name, axis, Formula(eq), unit, name, positive=False)
    return made[name]
"""
TAIL = """
columns = [c for c in made.values() if isinstance(c.rule, Given)]
WORKBOOK = Workbook(
    name="made", title="Made", source="none", ledger=lambda: Ledger(tuple(equations)),
    measured=tuple(Measured(c.name, c.unit, c.name, Bounds(low=0, low_open=True)) for c in columns if c.axis),
    parameters=tuple(Parameter(c.name, c.unit, c.name) for c in columns if not c.axis),
    sheet=lambda names: Sheet(tuple(made.values())), headline=tuple(HEADLINE),
)
"""
LAB = """
r, g, z, w = measured("r", "m"), given("g", "1"), given("z", "m"), given("w", "kg")
computed("depth", "m", g * r[k] - z, ROWS)
computed("area", "m^2", r[k]**2, ROWS)
computed("m", "kg", g * w)
HEADLINE = ["m"]
"""
CAMPAIGN = """
x, m = measured("x", "m"), given("m", "kg")
computed("total", "m", Sum(x[k], (k, 1, n)))
computed("q", "m/kg", made["total"].symbol / m)
HEADLINE = ["total", "q"]
"""
GIVEN = {"g": "1.003, u = 0.004", "z": "0.2 um, u = 0.1", "w": "8.366 g, u = 0.01"}
READ = {5: "63.6", 3: "41.8", 1: "23.7", 2: "29.9", 4: "53.1"}
OWN = '[uncertainty]\nr = "u = 0.2 um"\n'
COLUMN = {"x": '{ from = "lab/out/values.json", cell = "depth", unit = "um" }'}
MASS = {"m": '{ from = "lab/out/values.json", cell = "m" }'}


def section(head: str, said: dict[str, str]) -> str:
    """A table of TOML; what begins with a brace is no text."""
    return "".join(
        [f"[{head}]\n", *(f"{n} = {t}\n" if t[0] == "{" else f'{n} = "{t}"\n' for n, t in said.items())]
    )


def folder(
    at: Path, workbook: str, parameters: dict[str, str], table: str, taken: dict[str, str], more: str = ""
) -> Path:
    """Write a report folder."""
    at.mkdir(parents=True, exist_ok=True)
    name = "workbook.py" if "\n" in workbook else workbook
    if name.endswith(".py"):
        (at / name).write_text(HEAD + workbook + TAIL, encoding="utf-8")
    (at / "measurements.csv").write_text(table, encoding="utf-8")
    told = f'workbook = "{name}"\n' + section("parameters", parameters)
    told += '[measurements]\nfile = "measurements.csv"\n' + section("measurements.taken", taken) * bool(taken)
    (at / "report.toml").write_text(told + more, encoding="utf-8")
    return at


def build(at: Path) -> Path:
    assert main(["build", str(at), "--to", "json"]) == 0
    return at


def lab(at: Path, read: dict[int, str] = READ, parameters: dict[str, str] = GIVEN, more: str = OWN) -> Path:
    """The laboratory's report, built."""
    rows = "".join(f"{label},{text}\n" for label, text in read.items())
    return build(folder(at / "lab", LAB, parameters, f"test,r [um]\n{rows}", {}, more))


def forged(file: Path, content: dict[str, Any]) -> None:
    """Write a values.json of which nobody can tell that it was changed: without its manifest."""
    file.write_text(json.dumps(content), encoding="utf-8")
    file.with_name("manifest.json").unlink(missing_ok=True)
