"""The end gauge of JCGM 100:2008, H.1: its length by comparison with a standard."""

from loopsheet import Method, given, let


class EndGauge(Method, source="JCGM 100:2008, H.1"):
    """End-gauge calibration."""

    l_S = given("m", "length of the standard at 20 °C")
    d = given("m", "difference in length")
    dalpha = given("K^-1", "difference of the coefficients of thermal expansion")
    alpha_S = given("K^-1", "coefficient of thermal expansion of the standard")
    theta = given("K", "mean deviation of the test bed from 20 °C")
    cycle = given("K", "cyclic variation of its temperature")
    dtheta = given("K", "difference of the temperatures of the gauges")
    of_temperature = l_S * (dalpha * (theta + cycle) + alpha_S * dtheta)
    why = "the standard, the difference, and what the temperatures do"
    l = let(
        l_S + d - of_temperature, "length of the end gauge at 20 °C", label="(H.2)", because=why, like=l_S
    )
