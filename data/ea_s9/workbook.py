"""Calibration of a hand-held digital multimeter at 100 V DC: EA-4/02, S9."""

from sympy import Symbol

from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Column, Formula, Given, Sheet
from loopsheet.report.workbook import Parameter, Workbook

GIVEN = (
    Parameter("V_iX", "V", "voltage that the multimeter indicates"),
    Parameter("V_S", "V", "voltage that the calibrator generates"),
    Parameter("dV_iX", "V", "finite resolution of the multimeter"),
    Parameter("dV_S", "V", "drift, loading and environment of the calibrator"),
)
given = [Column(p.name, None, Given("parameter"), p.unit, p.meaning, positive=False) for p in GIVEN]
V_iX, V_S, dV_iX, dV_S = (column.symbol for column in given)
E_X = Equation(
    "(S9.1)", (Symbol("E_X"), V_iX - V_S + dV_iX - dV_S), "the model", Kind.DEFINITION, "error of indication"
)
result = Column("E_X", None, Formula(E_X), "V", E_X.title, display="like V_iX", positive=False)

WORKBOOK = Workbook(
    name="ea_s9",
    title="Calibration of a hand-held digital multimeter at 100 V DC",
    source="EA-4/02, S9",
    ledger=lambda: Ledger((E_X,)),
    measured=(),
    parameters=GIVEN,
    sheet=lambda names: Sheet((*given, result)),
    headline=("E_X",),
)
