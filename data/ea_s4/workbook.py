"""Calibration of a gauge block of nominal length 50 mm: EA-4/02, S4."""

from sympy import Symbol

from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Column, Formula, Given, Sheet
from loopsheet.report.workbook import Parameter, Workbook

GIVEN = (
    Parameter("l_S", "m", "length of the standard"),
    Parameter("dl_D", "m", "drift of the standard since its calibration"),
    Parameter("dl", "m", "observed difference in length"),
    Parameter("dl_C", "m", "non-linearity and offset of the comparator"),
    Parameter("L", "m", "nominal length"),
    Parameter("alpha", "K^-1", "average coefficient of thermal expansion"),
    Parameter("dt", "K", "difference of the temperatures of both blocks"),
    Parameter("dalpha", "K^-1", "difference of their coefficients"),
    Parameter("t", "K", "deviation of their average temperature from 20 °C"),
    Parameter("dl_V", "m", "variation in length off the centre"),
)
given = [Column(p.name, None, Given("parameter"), p.unit, p.meaning, positive=False) for p in GIVEN]
l_S, dl_D, dl, dl_C, L, alpha, dt, dalpha, t, dl_V = (column.symbol for column in given)
l_X = Equation(
    "(S4.3)",
    (Symbol("l_X"), l_S + dl_D + dl + dl_C - L * (alpha * dt + dalpha * t) - dl_V),
    "the model",
    Kind.DEFINITION,
    "length of the block",
)
result = Column("l_X", None, Formula(l_X), "m", l_X.title, display="like l_S", positive=False)

WORKBOOK = Workbook(
    name="ea_s4",
    title="Calibration of a gauge block of nominal length 50 mm",
    source="EA-4/02, S4",
    ledger=lambda: Ledger((l_X,)),
    measured=(),
    parameters=GIVEN,
    sheet=lambda names: Sheet((*given, result)),
    headline=("l_X",),
)
