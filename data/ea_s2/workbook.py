"""Calibration of a weight of nominal value 10 kg: EA-4/02, S2."""

from sympy import Symbol

from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Column, Formula, Given, Sheet
from loopsheet.report.workbook import Parameter, Workbook

GIVEN = (
    Parameter("m_S", "kg", "conventional mass of the standard"),
    Parameter("dm_D", "kg", "drift of the standard since its calibration"),
    Parameter("dm", "kg", "observed difference"),
    Parameter("dm_C", "kg", "eccentricity and magnetic effects"),
    Parameter("dB", "kg", "air buoyancy"),
)
given = [Column(p.name, None, Given("parameter"), p.unit, p.meaning, positive=False) for p in GIVEN]
m_S, dm_D, dm, dm_C, dB = (column.symbol for column in given)
m_X = Equation(
    "(S2.1)",
    (Symbol("m_X"), m_S + dm_D + dm + dm_C + dB),
    "the model",
    Kind.DEFINITION,
    "conventional mass of the weight",
)
result = Column("m_X", None, Formula(m_X), "kg", m_X.title, display="like m_S", positive=False)

WORKBOOK = Workbook(
    name="ea_s2",
    title="Calibration of a weight of nominal value 10 kg",
    source="EA-4/02, S2",
    ledger=lambda: Ledger((m_X,)),
    measured=(),
    parameters=GIVEN,
    sheet=lambda names: Sheet((*given, result)),
    headline=("m_X",),
)
