"""What the page needs to recalculate itself: the data, the equations with places for numbers, the script.

The program that computes comes from an engine, as text. The scripts under templates/live edit, redraw and
explain; they know no model, and nothing of what they read is ever evaluated.
"""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, fields
from fractions import Fraction
from typing import Any

from ...derivations.unit_text import ParsedUnit, parse_unit
from ..cells.address import index_text
from ..charts import Chart, Series
from ..document.charted import PREFIXES, Words, plain_unit, unit_text
from ..document.material import Material
from ..document.parts import slug
from ..document.tree import Inlines, Math, Unit
from ..document.written import placed
from ..machine.kept import kept
from ..quantity import Bounds, Printed
from ..result.chi_square import RARE
from ..result.numbers import LEAST
from ..result.result import Report
from ..result.verdict import OTHERWISE, UNEXPECTED
from ..sheet import Column, Given, Iterated, Root
from .compact import short_cells, short_script
from .live_files import given
from .live_uncertain import decided, digits, errors, uncertain
from .writer import TEMPLATES

ALONE = ("random.js", "sensitivities.js", "second_order.js")
"""What a worker runs behind the program, and the page, too."""

SCRIPTS = (
    *ALONE,
    "page.js",
    "numbers.js",
    "inputs.js",
    "trace.js",
    "coverage.js",
    "readings.js",
    "sure.js",
    "cells.js",
    "tables.js",
    "published.js",
    "verdicts.js",
    "drawing.js",
    "charts.js",
    "bar.js",
    "select.js",
    "grid.js",
    "files.js",
    "keep.js",
    "monte_carlo.js",
    "figures.js",
    "panel.js",
    "main.js",
)
"""The scripts of the page in the order in which they are read; people read them in templates/live."""

DRAWING = frozenset({"drawing.js", "charts.js"})
"""The scripts that only a page with charts has."""
READINGS = "readings.js"
"""The script that only a page has in which readings scatter."""


# --- the script ------------------------------------------------------------------------------------------


def script(program: str, runtime: str, drawings: bool = True, readings: bool = False) -> str:
    """The script of the page, with the generated program in it.

    Parameters
    ----------
    program : str
        The sheet as a JavaScript object literal.
    runtime : str
        What evaluates it.
    drawings : bool
        Whether a chart is in the page.
    readings : bool
        Whether readings scatter in it.

    Raises
    ------
    ValueError
        The text would end the element that it stands in.
    """
    spare = (frozenset() if drawings else DRAWING) | (set() if readings else {READINGS})
    names = [name for name in SCRIPTS if name not in spare]
    own = [(TEMPLATES / "minified" / name).read_text(encoding="utf-8") for name in names]
    own.insert(len(ALONE), "if(!self.document)return;\n")
    short: str = kept("program of the page", [program], lambda: short_cells(short_script(program)))
    text = "".join(["(()=>{", runtime, f"let PROGRAM={short};\n", *own, "})();\n"])
    if re.search(r"</script|<!--|<script", text, re.IGNORECASE):
        raise ValueError("the script of the page must not hold the end of its element")
    return text


# --- the data --------------------------------------------------------------------------------------------


def data(report: Report, document: Material) -> str:
    """What the script must know of the report, as JSON that cannot end the element it stands in.

    `document`: the same report, as its document sees it.
    """
    sheet = report.sheet
    known = {
        "columns": {column.name: _least(_column(report, document, column)) for column in sheet.columns},
        **given(report),
        **uncertain(report),
        "decided": decided(report),
        "headline": [
            (name, index_text(label))
            for name in report.workbook.headline
            if name in sheet
            for label in report.values.labels(sheet[name])
        ],
        "figures": drawn(report),
        "squares": {one.name: [one.axis, one.fitted] for one in report.workbook.squares if one.asked},
        "chances": [RARE, LEAST],
        "findings": {"unexpected": UNEXPECTED, "otherwise": OTHERWISE},
        "published": [
            {
                "id": f"published-{slug(group.source)}",
                "rows": [
                    [
                        pair.comparison.published.cell,
                        index_text(pair.comparison.published.index),
                        pair.printed.text,
                        _size(pair.printed) if pair.printed.unit != "1" else 0,
                        int(pair.printed.mode == "truncated"),
                        *pair.comparison.known,
                    ]
                    for pair in group.pairs
                ],
                "called": [pair.row for pair in group.pairs],
            }
            for group in document.groups
        ],
    }
    # By its content an issue is known again: edits of another one do not fit.
    known["issue"] = hashlib.sha256(json.dumps(known).encode()).hexdigest()[:16]
    # In an element of its own only these could be taken for its end or for a comment.
    return json.dumps(known, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def drawn(report: Report) -> dict[str, Any]:
    """The charts of the figures that the page draws again, as its script reads them."""
    words = Words(report) if report.workbook.charts else None
    return {f.name: _chart(words, f.chart) for f in report.workbook.figures if f.chart and words}


def _chart(words: Words, chart: Chart) -> dict[str, Any]:
    """A chart without what is as it is unless somebody says so."""
    found: dict[str, Any] = {"height": round(chart.height * 72 / 2.54, 1), "series": []}
    for axis, scale in zip("xy", words.scales(chart), strict=True):
        found[axis] = {"title": scale.title, "unit": unit_text(scale.unit), "size": scale.size}
        if scale.zero:
            found[axis]["from"] = scale.zero
        if scale.prefixed:
            found[axis]["prefixes"] = PREFIXES
    found["log"] = [int(axis in chart.log) for axis in "xy"]
    if chart.from_zero:
        found["zero"] = 1
    if chart.zero:
        found["base"] = 1
    if chart.whole:
        found["whole"] = 1
    if chart.panels:
        found["panels"] = words.axis(chart.series[0]).row
    plain = {field.name: field.default for field in fields(Series)}
    for series in chart.series:
        # Drawn again, points have no bars: uncertainties may have changed.
        said = {name: value for name, value in vars(series).items() if name != "bars"}
        one = {name: value for name, value in said.items() if value != plain[name]}
        one["label"] = words.label(series)
        if "%s" in series.label and not series.each:
            one["rows"] = (words.axis(series).name, words.axis(series).row)
        found["series"].append(one)
    return found


def _size(of: Printed | ParsedUnit) -> list[str]:
    """A unit in SI as a fraction, and the numerator of its zero over the same denominator: as text.

    JavaScript's numbers would round them. A zero that is that of SI goes without saying.
    """
    below = math.lcm(of.scale.denominator, of.zero.denominator)
    every = (of.scale * below, Fraction(below), of.zero * below)
    return [str(each.numerator) for each in every if each]


def _least(entry: dict[str, Any]) -> dict[str, Any]:
    """An entry without what the page puts in again (templates/live/trace.js)."""
    plain = {"unit": "1", "scale": 1.0, "zero": 0.0} | (
        {} if "given" in entry or "of" in entry else {"digits": 4}
    )
    return {name: value for name, value in entry.items() if plain.get(name) != value}


def _column(report: Report, document: Material, column: Column) -> dict[str, Any]:
    shown = report.shown[column.name]
    head = document.head(column)
    entry: dict[str, Any] = {
        "source": column.source,
        "unit": plain_unit(shown.unit) or "1",
        "scale": shown.scale,
        "zero": shown.zero,
    }
    if limits := report.marks.limiting(column.name):
        entry["limits"] = [
            (
                each.column.name,
                each.limit.mark,
                each.limit.says if each.limit.source else "",
                *(1,) * each.limit.silent,
            )
            for each in limits
        ]
    if isinstance(column.rule, Given) and column.rule.u_of:
        return entry | {"of": column.rule.u_of} | digits(report, column)
    if isinstance(column.rule, Given):
        del entry["source"]  # what is given says in which file
        entry["given"] = _given(report, column)
        return entry if (stated := errors(report, column)) is None else entry | {"errors": stated}
    entry |= digits(report, column)
    if doubt := report.uncertain().advice.get(column.name):
        entry["doubt"] = doubt
    if not column.positive and any(
        b.name == column.name and b.least == 0 for b in report.uncertain().budgets
    ):
        entry["floor"] = 1
    if (jumps := report.uncertain().rough.get(column.name)) is not None:
        entry["rough"] = 2 if jumps else -1 if column.nonnegative else 1
    if column.spare or report.told_of(column) != column.name:
        entry["spare"] = 1
    if head.sources != (column.source,):
        entry["equations"] = head.sources
    if isinstance(column.rule, Iterated):
        first = report.sheet.loop_of[column.name].iterated[0]
        same = (
            column is not first and isinstance(first.rule, Iterated) and first.rule.none == column.rule.none
        )
        # What all columns of a loop say stands with the first of them.
        entry["none"] = first.name if same else f"did not settle: {column.rule.none}"
    if isinstance(column.rule, Root):
        entry |= {"none": f"has no root here: {column.rule.none}", "two": column.rule.two}
        if column.rule.unknown_name != column.name and not column.rule.by_proof:
            entry["unknown"] = column.rule.unknown_name
    if column.conditions:
        entry["requires"] = column.conditions
    put = placed(column, report.sheet, document.names)
    if put.latex:
        entry["put"] = ",".join(" ".join(part for part in cell if part is not None) for cell in put.cells)
    return entry


def _given(report: Report, column: Column) -> dict[str, Any]:
    """What an input may be, and how large its printed unit is."""
    declared = report.workbook.declared.get(column.name, column)
    printed, bounds = _printed(report, column.name), report.sheet.bounds[column.name]
    more: dict[str, Any] = {"truncated": True} if printed and printed.mode == "truncated" else {}
    inputs, own = report.inputs, f"u({column.name})"
    if (taken := inputs.taken.get(column.name)) and printed:
        more |= {"said": taken.file, "u": 1.0, "taken": printed.unit}
    elif own in inputs.header_units:
        units = (parse_unit(inputs.header_units[name]).scale for name in (column.name, own))
        more |= {"said": f"the column {own}", "u": float(next(units) / next(units))}
    elif column.name in inputs.uncertainty.columns or (column.axis is None and printed and printed.stated):
        more["said"] = "report.toml"
    return more | {
        "scale": _size(printed or parse_unit(column.unit)),
        "bounds": limits(bounds),
        "allowed": f"{bounds.said(declared.unit)} ({declared.meaning})",
    }


def limits(bounds: Bounds) -> dict[str, Any]:
    """What an input may be, as the page reads it: ends as text, which its fractions hold exactly."""
    return {
        name: repr(bound).removesuffix(".0") if name in ("low", "high") else True
        for name in ("low", "high", "low_open", "high_open", "integer")
        if (bound := getattr(bounds, name)) is not None and bound is not False
    }


def _printed(report: Report, name: str) -> Printed | None:
    """A number of an input, for its unit."""
    return next(iter(report.inputs.numbers(name)), None)


# --- equations with places for numbers --------------------------------------------------------------------


@dataclass(frozen=True)
class BarPart:
    """What the formula bar shows of a column."""

    column: Column
    symbol: Math
    meaning: Inlines
    unit: Unit
    """It is shown in."""
    equation: Math | None
    """Its equation with ``@n@`` for the n-th cell in it; None if it is given or sums over rows."""


def parts(report: Report, document: Material) -> Iterator[BarPart]:
    """What the formula bar shows of every column."""
    for column in report.sheet.columns:
        equation = placed(column, report.sheet, document.names).latex
        yield BarPart(
            column,
            document.sentences.symbol(column.name),
            document.sentences.rich(column.meaning),
            Unit(report.shown[column.name].unit),
            Math(equation) if equation else None,
        )
