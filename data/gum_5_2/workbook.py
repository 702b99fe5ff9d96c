"""Ten resistors that were calibrated with the same standard: the example of JCGM 100:2008, 5.2.2."""

from sympy import Sum, Symbol

from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Workbook

i, n = (Symbol(s, integer=True, positive=True) for s in ("i", "n"))
R = Column("R", Axis("resistors", i, n), Given("measured"), "ohm", "resistance")
total = Equation(
    "(5.2.2)", (Symbol("R_ref"), Sum(R[i], (i, 1, n))), "in series", Kind.DEFINITION, "reference resistance"
)
R_ref = Column("R_ref", None, Formula(total), "ohm", total.title, display="like R")

WORKBOOK = Workbook(
    name="gum_5_2",
    title="Ten resistors and one standard",
    source="JCGM 100:2008, 5.2.2",
    ledger=lambda: Ledger((total,)),
    measured=(Measured("R", "ohm", R.meaning),),
    parameters=(),
    sheet=lambda names: Sheet((R, R_ref)),
    headline=("R_ref",),
)
