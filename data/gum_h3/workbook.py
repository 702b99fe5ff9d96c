"""A calibration line by least squares: JCGM 100:2008, H.3, in the sums that it prints."""

from sympy import Sum, Symbol, sqrt

from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Parameter, Workbook

k, n = (Symbol(s, integer=True, positive=True) for s in ("k", "n"))
READINGS = Axis("readings", k, n)
MEASURED = (Measured("t", "K", "reading of the thermometer"), Measured("b", "K", "observed correction"))
GIVEN = (
    Parameter("t_0", "K", "reference temperature"),
    Parameter("t_new", "K", "temperature of a later reading"),
)
t, b = (Column(m.name, READINGS, Given("measured"), m.unit, m.meaning, positive=False) for m in MEASURED)
t_0, t_new = (Column(p.name, None, Given("parameter"), p.unit, p.meaning, positive=False) for p in GIVEN)


def column(number, name, unit, formula, meaning, axis=None):
    """What is defined by a formula."""
    equation = Equation(f"({number})", (Symbol(name), formula), "definition", Kind.DEFINITION, meaning)
    return Column(name, axis, Formula(equation), unit, meaning, positive=False)


def total(formula):
    """The sum over all readings."""
    return Sum(formula, (k, 1, n))


theta = column("H.12", "theta", "K", t[k] - t_0.symbol, "reading from the reference temperature on", READINGS)
D = column("H.13g", "D", "K^2", n * total(theta[k] ** 2) - total(theta[k]) ** 2, "determinant")
intercept = total(b[k]) * total(theta[k] ** 2) - total(b[k] * theta[k]) * total(theta[k])
y_1 = column("H.13a", "y_1", "K", intercept / D.symbol, "intercept")
slope = n * total(b[k] * theta[k]) - total(b[k]) * total(theta[k])
y_2 = column("H.13b", "y_2", "1", slope / D.symbol, "slope")
b_fit = column("H.12a", "b_fit", "K", y_1.symbol + y_2.symbol * theta[k], "predicted correction", READINGS)
residual = column("H.12b", "residual", "K", b[k] - b_fit[k], "observed less predicted correction", READINGS)
s = column("H.13f", "s", "K", sqrt(total(residual[k] ** 2) / (n - 2)), "scatter about the line")
s_y1 = column("H.13c", "s_y1", "K", s.symbol * sqrt(total(theta[k] ** 2) / D.symbol), "of the intercept")
s_y2 = column("H.13d", "s_y2", "1", s.symbol * sqrt(n / D.symbol), "of the slope")
r_12 = column("H.13e", "r_12", "1", -total(theta[k]) / sqrt(n * total(theta[k] ** 2)), "correlation of both")
later = y_1.symbol + y_2.symbol * (t_new.symbol - t_0.symbol)
b_30 = column("H.14", "b_30", "K", later, "predicted correction of a later reading")
COMPUTED = (theta, D, y_1, y_2, b_fit, residual, s, s_y1, s_y2, r_12, b_30)

WORKBOOK = Workbook(
    name="gum_h3",
    title="Calibration of a thermometer",
    source="JCGM 100:2008, H.3",
    ledger=lambda: Ledger(tuple(c.rule.equation for c in COMPUTED)),
    measured=MEASURED,
    parameters=GIVEN,
    sheet=lambda names: Sheet((t, b, t_0, t_new, *COMPUTED)),
    headline=("y_1", "y_2", "b_30"),
)
