"""The end gauge of JCGM 100:2008, H.1: its length by comparison with a standard."""

from sympy import Symbol

from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Column, Formula, Given, Sheet
from loopsheet.report.workbook import Parameter, Workbook

GIVEN = (
    Parameter("l_S", "m", "length of the standard at 20 °C"),
    Parameter("d", "m", "difference in length"),
    Parameter("dalpha", "K^-1", "difference of the coefficients of thermal expansion"),
    Parameter("alpha_S", "K^-1", "coefficient of thermal expansion of the standard"),
    Parameter("theta", "K", "mean deviation of the test bed from 20 °C"),
    Parameter("cycle", "K", "cyclic variation of its temperature"),
    Parameter("dtheta", "K", "difference of the temperatures of the gauges"),
)
given = {p.name: Column(p.name, None, Given("parameter"), p.unit, p.meaning, positive=False) for p in GIVEN}
l_S, d, dalpha, alpha_S, theta, cycle, dtheta = (column.symbol for column in given.values())
length = Equation(
    "(H.2)",
    (Symbol("l"), l_S + d - l_S * (dalpha * (theta + cycle) + alpha_S * dtheta)),
    "the standard, the difference, and what the temperatures do",
    Kind.DEFINITION,
    "length of the end gauge at 20 °C",
)
gauge = Column("l", None, Formula(length), "m", length.title, display="like l_S", positive=False)

WORKBOOK = Workbook(
    name="gum_h1",
    title="End-gauge calibration",
    source="JCGM 100:2008, H.1",
    ledger=lambda: Ledger((length,)),
    measured=(),
    parameters=GIVEN,
    sheet=lambda names: Sheet((*given.values(), gauge)),
    headline=("l",),
)
