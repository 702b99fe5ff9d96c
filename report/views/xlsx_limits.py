"""The decision rule below a budget of the workbook: limits, guard band, probability, in live formulas."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ..cells.grid import Place
from ..distribution import MOST_DOF, Shape
from ..result.uncertain import Conformity, Decision
from .xlsx_style import Style

NONE = "none"
_SHARES = {
    Shape.RECTANGULAR: "MIN(ABS({z})/SQRT(3),1)",
    Shape.TRIANGULAR: "(1-(1-MIN(ABS({z})/SQRT(6),1))^2)",
    Shape.ARCSINE: "(ASIN(MIN(ABS({z})/SQRT(2),1))*2/PI())",
}
"""The share within z standard uncertainties, of the shapes that have ends."""
_LAWS = (Shape.TRUNCATED, Shape.EXPONENTIAL, Shape.SAMPLES, Shape.CONVOLVED)
SHAPES = {shape.value: f'"{shape.value}"' for shape in (*_SHARES, *_LAWS)}
"""Their names in a formula."""
CHANCE = "0.00%"
ROUNDING = "(0.000000001+0.00000000000001*ABS({value}/{u}))"
"""Standard uncertainties by which rounding may leave a value beyond a limit that it is at, and more."""


def as_issued(cell: str, at: float, value: float) -> str:
    """A number that is known where a cell is as it was issued, and not when somebody has changed it."""
    return f"IF(ABS({cell}-({at:.15f}))<0.000001,{value:.15f},NA())" if math.isfinite(at) else "0"


def _known(formula: str) -> str:
    """What has no value is not decided: the code that stands for it says why."""
    return f"IF(ISNUMBER({{value}}),{formula},{{value}})"


class _Written:
    """The lines of one rule; each may name those above it, and those of the budget."""

    def __init__(self, sheet: Any, style: Style, row: int, at: dict[str, str]) -> None:
        self.sheet, self.style, self.row, self.at = sheet, style, row, at

    def line(self, name: str, said: str, formula: str, now: float | str, form: str = "General") -> None:
        """Write a line; without a formula it may be changed."""
        self.style.text(self.sheet, self.row, 0, said, "name")
        if formula:
            cell = self.style("number", form)
            self.style.formula(self.sheet, self.row, 1, f"={formula.format_map(self.at)}", now, cell)
        elif isinstance(now, str):
            self.style.text(self.sheet, self.row, 1, now, "input")
        else:
            self.sheet.write_number(self.row, 1, now, self.style("input", form))
        self.row += 1
        self.at[name] = f"$B${self.row}"

    def end(self, name: str, said: str, formula: str, now: float, form: str) -> None:
        """A line that is there only where there is such a limit."""
        finite = math.isfinite(now)
        guarded = formula and f'IF(ISNUMBER({{{name.rsplit(maxsplit=1)[-1]}}}),{formula},"{NONE}")'
        self.line(name, said, guarded, now if finite else NONE, form)

    def tail(self, z: str) -> str:
        """The probability that an error is larger than z standard uncertainties."""
        share = "0"
        for shape, part in _SHARES.items():
            share = f"IF({{shape}}={SHAPES[shape.value]},{part.format(z=z)},{share})"
        sure = f"MIN({{dof}},{MOST_DOF})"
        student = f"IF({z}>=0,TDIST(ABS({z}),{sure},1),1-TDIST(ABS({z}),{sure},1))"
        with_ends = f"(1-SIGN({z})*{share})/2"
        return f'IF({{shape}}="normal",NORMSDIST(-({z})),IF({{shape}}="t",{student},{with_ends}))'


def write_limits(
    sheet: Any,
    style: Style,
    found: Conformity,
    place: Place,
    form: str,
    row: int,
    at: dict[str, str],
    formulas: tuple[Callable[[str], str], str],
) -> int:
    """Write the rule; return the row behind it.

    Parameters
    ----------
    place : Place
        Of the budget's value, in whose unit all of it is.
    form : str
        The number format of a width.
    row : int
        Where it begins.
    at : dict of str to str
        Where value, u and dof of the budget stand.
    formulas : (callable, str)
        The coverage factor for the cell of a probability; the name of the distribution that is assigned.
    """
    budget, by, rule, (low, high) = found.budget, found.by, found.limits.guard, found.limits.ends
    style.text(sheet, row, 0, "decision rule (JCGM 106)", "head")
    to = _Written(sheet, style, row + 1, dict(at))
    to.end("low", "lower tolerance limit", "", place.of(low), "General")
    to.end("high", "upper tolerance limit", "", place.of(high), "General")
    if math.isnan(found.probability) or math.isnan(found.guard):
        why = (math.isnan(by.factor) and by.because) or found.because
        style.text(sheet, to.row, 0, f"what is decided is not known: {why}")
        return to.row + 1
    width = ""
    if rule.width is None:
        to.line("level", "coverage probability of its U", "", rule.level, "0.##%")
        to.line("times", "guard band over U", "", float(rule.times))
        width = f"{{times}}*{formulas[0](to.at['level'])}*{{u}}"
    to.line("guard", "guard band", width, found.guard / float(place.scale), form)
    least, most = found.acceptance
    to.end("from low", "lower acceptance limit", "{low}+{guard}", place.of(least), form)
    to.end("to high", "upper acceptance limit", "{high}-{guard}", place.of(most), form)
    to.line("shape", "distribution", formulas[1], by.shape.value)
    z = (budget.value - low) / budget.u, (high - budget.value) / budget.u
    to.end("z low", "lower margin over u", _known("({value}-{low})/{u}"), z[0], "0.00")
    to.end("z high", "upper margin over u", _known("({high}-{value})/{u}"), z[1], "0.00")
    for name, said, now in (("low", "below", found.below), ("high", "above", found.above)):
        end = f"{{z {name}}}"
        tail = to.tail(end)
        if by.law is not None:  # of sources that were edited it is another one
            known = as_issued(end, z[name == "high"], now)
            tail = f'IF({{shape}}="{by.shape}",{known},NA())'
        tail = _known(f"IF(ISTEXT({end}),0,{tail})")
        to.line(said, f"probability that it lies {said}", tail, now, CHANCE)
    inside = (
        "1-({below}+{above})"
        if by.law
        else (
            f"IF({{below}}>0.5,{to.tail('-N({z low})')}-{{above}},"
            f"IF({{above}}>0.5,{to.tail('-N({z high})')}-{{below}},1-({{below}}+{{above}})))"
        )
    )
    crossed = "AND(ISNUMBER({low}),ISNUMBER({high}),N({low})>N({high}))"
    inside = _known(f"IF({crossed},NA(),{inside})")
    to.line("inside", "conformance probability", inside, found.probability, CHANCE)
    if by.law:
        said = "the probabilities do not follow an edit: #N/A where value or limits are not as issued"
        style.text(sheet, to.row, 0, said)
        to.row += 1
    no, yes, open_ = (f'"{each.value}"' for each in (Decision.DOES_NOT, Decision.CONFORMS, Decision.NONE))
    accepted = (
        f"AND(IF(ISNUMBER({{low}}),({{value}}-{{from low}})/{{u}}>=-{ROUNDING},TRUE),"
        f"IF(ISNUMBER({{high}}),({{to high}}-{{value}})/{{u}}>=-{ROUNDING},TRUE))"
    )
    outside = f"OR(N({{z low}})<-{ROUNDING},N({{z high}})<-{ROUNDING})"
    decided = _known(f"IF({crossed},NA(),IF({outside},{no},IF({accepted},{yes},{open_})))")
    to.line("decision", "decision", decided, found.decision.value)
    for name, when, taken, risk in (
        ("consumer", yes, "{below}+{above}", found.consumer_risk),
        ("producer", no, "{inside}", found.producer_risk),
    ):
        formula = f'IF({{decision}}={when},{taken},"{NONE}")'
        to.line(name, f"specific {name}’s risk", formula, NONE if risk is None else risk, CHANCE)
    return to.row
