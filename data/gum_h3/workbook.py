"""A calibration line by least squares: JCGM 100:2008, H.3, whose formulas are claimed to say the same."""

from loopsheet import Method, claim, count, fit, given, let, measured, total, unknown


class ThermometerLine(Method, source="JCGM 100:2008, H.3", headline="y_1 y_2 b_30"):
    """Calibration of a thermometer."""

    t = measured("K", "reading of the thermometer")
    b = measured("K", "observed correction")
    t_0 = given("K", "reference temperature")
    t_new = given("K", "temperature of a later reading")
    n = count()
    theta = let(t - t_0, "reading from the reference temperature on", label="(H.12)")
    y_1 = unknown("intercept")
    y_2 = unknown("slope")
    line = fit(b, y_1 + y_2 * theta)
    b_30 = let(y_1 + y_2 * (t_new - t_0), "predicted correction of a later reading", label="(H.14)")
    D = n * total(theta**2) - total(theta) ** 2
    of_intercept = total(b) * total(theta**2) - total(b * theta) * total(theta)
    claim(y_1, of_intercept / D, "intercept as printed", label="(H.13a)")
    claim(y_2, (n * total(b * theta) - total(b) * total(theta)) / D, "slope as printed", label="(H.13b)")
    claim(line.s_y_1**2 * D, line.s**2 * total(theta**2), "scatter of the intercept", label="(H.13c)")
    claim(line.s_y_2**2 * D, line.s**2 * n, "scatter of the slope", label="(H.13d)")
    claim(line.r_y_1_y_2**2 * n * total(theta**2), total(theta) ** 2, "correlation", label="(H.13e)")
