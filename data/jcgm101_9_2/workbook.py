"""Additive models: JCGM 101:2008, 9.2.2 to 9.2.4."""

from sympy import Symbol

from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Column, Formula, Given, Sheet
from loopsheet.report.workbook import Parameter, Workbook

GIVEN = (
    Parameter("X_1", "1", "quantity 1, normal"),
    Parameter("X_2", "1", "quantity 2, normal"),
    Parameter("X_3", "1", "quantity 3, normal"),
    Parameter("X_4", "1", "quantity 4, normal"),
    Parameter("R_1", "1", "quantity 1, rectangular"),
    Parameter("R_2", "1", "quantity 2, rectangular"),
    Parameter("R_3", "1", "quantity 3, rectangular"),
    Parameter("R_4", "1", "quantity 4, rectangular"),
    Parameter("W", "1", "quantity 4, ten times as wide"),
)
given = [Column(p.name, None, Given("parameter"), p.unit, p.meaning, positive=False) for p in GIVEN]
X_1, X_2, X_3, X_4, R_1, R_2, R_3, R_4, W = (column.symbol for column in given)
Y_2 = Equation(
    "(9.2.2)",
    (Symbol("Y_2"), X_1 + X_2 + X_3 + X_4),
    "the model",
    Kind.DEFINITION,
    "sum of four normal quantities",
)
Y_3 = Equation(
    "(9.2.3)",
    (Symbol("Y_3"), R_1 + R_2 + R_3 + R_4),
    "the model",
    Kind.DEFINITION,
    "sum of four rectangular quantities of the same width",
)
Y_4 = Equation(
    "(9.2.4)",
    (Symbol("Y_4"), R_1 + R_2 + R_3 + W),
    "the model",
    Kind.DEFINITION,
    "the same with one that is ten times as wide",
)
MODELS = {"Y_2": Y_2, "Y_3": Y_3, "Y_4": Y_4}
results = [
    Column(name, None, Formula(model), "1", model.title, positive=False) for name, model in MODELS.items()
]

WORKBOOK = Workbook(
    name="jcgm101_9_2",
    title="Additive models",
    source="JCGM 101:2008, 9.2.2 to 9.2.4",
    ledger=lambda: Ledger(tuple(MODELS.values())),
    measured=(),
    parameters=GIVEN,
    sheet=lambda names: Sheet((*given, *results)),
    headline=("Y_2", "Y_3", "Y_4"),
)
