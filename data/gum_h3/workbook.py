"""A calibration line by least squares: JCGM 100:2008, H.3, in the sums that it prints."""

from sympy import sqrt

from loopsheet import Method, count, given, let, measured, total


class ThermometerLine(Method, source="JCGM 100:2008, H.3", headline="y_1 y_2 b_30"):
    """Calibration of a thermometer."""

    t = measured("K", "reading of the thermometer")
    b = measured("K", "observed correction")
    t_0 = given("K", "reference temperature")
    t_new = given("K", "temperature of a later reading")
    n = count()
    theta = let(t - t_0, "reading from the reference temperature on", label="(H.12)")
    D = let(n * total(theta**2) - total(theta) ** 2, "determinant", label="(H.13g)")
    of_intercept = total(b) * total(theta**2) - total(b * theta) * total(theta)
    y_1 = let(of_intercept / D, "intercept", label="(H.13a)")
    y_2 = let((n * total(b * theta) - total(b) * total(theta)) / D, "slope", label="(H.13b)")
    b_fit = let(y_1 + y_2 * theta, "predicted correction", label="(H.12a)")
    residual = let(b - b_fit, "observed less predicted correction", label="(H.12b)")
    s = let(sqrt(total(residual**2) / (n - 2)), "scatter about the line", label="(H.13f)")
    s_y1 = let(s * sqrt(total(theta**2) / D), "of the intercept", label="(H.13c)")
    s_y2 = let(s * sqrt(n / D), "of the slope", label="(H.13d)")
    r_12 = let(-total(theta) / sqrt(n * total(theta**2)), "correlation of both", label="(H.13e)")
    b_30 = let(y_1 + y_2 * (t_new - t_0), "predicted correction of a later reading", label="(H.14)")
