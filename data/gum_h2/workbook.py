"""Resistance, reactance and impedance from simultaneous readings: JCGM 100:2008, H.2, approach 1."""

from sympy import Sum, Symbol, cos, sin

from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Workbook

k, n = (Symbol(s, integer=True, positive=True) for s in ("k", "n"))
READINGS = Axis("readings", k, n)
MEASURED = (
    Measured("V", "V", "amplitude of the potential difference"),
    Measured("I", "A", "amplitude of the current"),
    Measured("phi", "1", "phase shift of both"),
)
given = [Column(m.name, READINGS, Given("measured"), m.unit, m.meaning) for m in MEASURED]


def column(number, name, unit, formula, meaning, like=None):
    """What is defined by a formula, as a scalar."""
    equation = Equation(f"({number})", (Symbol(name), formula), "definition", Kind.DEFINITION, meaning)
    return Column(name, None, Formula(equation), unit, meaning, display=like, positive=False)


means = [
    column(number, f"{c.name}_mean", c.unit, Sum(c[k], (k, 1, n)) / n, f"mean {c.meaning}", f"like {c.name}")
    for number, c in zip(("C.2a", "C.2b", "C.2c"), given, strict=True)
]
voltage, current, phase = (mean.symbol for mean in means)
results = [
    column("H.7a", "R", "ohm", voltage / current * cos(phase), "resistance"),
    column("H.7b", "X", "ohm", voltage / current * sin(phase), "reactance"),
    column("H.7c", "Z", "ohm", voltage / current, "impedance"),
]

WORKBOOK = Workbook(
    name="gum_h2",
    title="Simultaneous resistance and reactance measurement",
    source="JCGM 100:2008, H.2",
    ledger=lambda: Ledger(tuple(c.rule.equation for c in (*means, *results))),
    measured=MEASURED,
    parameters=(),
    sheet=lambda names: Sheet((*given, *means, *results)),
    headline=("R", "X", "Z"),
)
