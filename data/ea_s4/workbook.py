"""Calibration of a gauge block of nominal length 50 mm: EA-4/02, S4."""

from loopsheet import Method, given, let


class GaugeBlock(Method, source="EA-4/02, S4"):
    """Calibration of a gauge block of nominal length 50 mm."""

    l_S = given("m", "length of the standard")
    dl_D = given("m", "drift of the standard since its calibration")
    dl = given("m", "observed difference in length")
    dl_C = given("m", "non-linearity and offset of the comparator")
    L = given("m", "nominal length")
    alpha = given("K^-1", "average coefficient of thermal expansion")
    dt = given("K", "difference of the temperatures of both blocks")
    dalpha = given("K^-1", "difference of their coefficients")
    t = given("K", "deviation of their average temperature from 20 °C")
    dl_V = given("m", "variation in length off the centre")
    of_temperature = L * (alpha * dt + dalpha * t)
    of_lengths = l_S + dl_D + dl + dl_C - dl_V
    l_X = let(
        of_lengths - of_temperature, "length of the block", label="(S4.3)", because="the model", like=l_S
    )
