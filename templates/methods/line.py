"""A calibration line by least squares, and the reading that belongs to a later indication."""

from sympy import sqrt

from loopsheet import Method, count, given, let, mean, measured, plot, total


class Line(Method, source="where it is published", headline="slope intercept later"):
    """Calibration line."""

    x = measured("K", "indication", example="21.521 22.012 22.512 23.003 23.507 23.999")
    y = measured("K", "correction", example="-0.171 -0.169 -0.166 -0.159 -0.164 -0.165")
    x_new = given("K", "a later indication", example="22.80 K")
    dx = let(x - mean(x), "indication from the mean on")
    slope = let(total(dx * y) / total(dx**2), "slope")
    intercept = let(mean(y) - slope * mean(x), "intercept")
    fitted = let(intercept + slope * x, "correction on the line")
    residual = let(y - fitted, "residual")
    s = let(sqrt(total(residual**2) / (count() - 2)), "scatter about the line")
    later = let(intercept + slope * x_new, "correction of the later indication")
    plot(x, y, fitted, caption="Corrections and the line.")
    plot(x, residual, caption="What is left.")
