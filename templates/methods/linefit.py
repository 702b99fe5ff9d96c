"""A calibration line by least squares, and the reading that belongs to a later indication."""

from loopsheet import Method, fit, given, let, measured, unknown


class Line(Method, source="where it is published", headline="slope intercept later"):
    """Calibration line."""

    x = measured("K", "indication", example="21.521 22.012 22.512 23.003 23.507 23.999")
    y = measured("K", "correction", example="-0.171(4) -0.169(4) -0.166(4) -0.159(4) -0.164(4) -0.165(4)")
    x_new = given("K", "a later indication", example="22.80 K")
    slope = unknown("slope")
    intercept = unknown("intercept")
    line = fit(y, intercept + slope * x)
    later = let(intercept + slope * x_new, "correction of the later indication")
