"""Repeated readings, and limits alone: JCGM 100:2008, 4.4.3 to 4.4.6."""

from sympy import Sum, Symbol

from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Parameter, Workbook

k, n = (Symbol(s, integer=True, positive=True) for s in ("k", "n"))
READINGS = Axis("readings", k, n)
MEASURED = (Measured("t", "K", "temperature, read again and again"),)
LIMITS = (
    Parameter("t_rect", "K", "temperature, of which limits are known"),
    Parameter("t_tri", "K", "temperature, more likely in the middle of its limits"),
)
t = Column("t", READINGS, Given("measured"), "K", MEASURED[0].meaning)
limits = [Column(p.name, None, Given("parameter"), p.unit, p.meaning) for p in LIMITS]
mean = Equation(
    "(3)", (Symbol("t_mean"), Sum(t[k], (k, 1, n)) / n), "definition", Kind.DEFINITION, "mean temperature"
)
t_mean = Column("t_mean", None, Formula(mean), "K", mean.title, display="like t")

WORKBOOK = Workbook(
    name="gum_4_4",
    title="A temperature by readings and by limits",
    source="JCGM 100:2008, 4.4.3 to 4.4.6",
    ledger=lambda: Ledger((mean,)),
    measured=MEASURED,
    parameters=LIMITS,
    sheet=lambda names: Sheet((t, *limits, t_mean)),
    headline=("t_mean",),
)
