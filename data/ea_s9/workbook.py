"""Calibration of a hand-held digital multimeter at 100 V DC: EA-4/02, S9."""

from loopsheet import Method, given, let


class Multimeter(Method, source="EA-4/02, S9"):
    """Calibration of a hand-held digital multimeter at 100 V DC."""

    V_iX = given("V", "voltage that the multimeter indicates")
    V_S = given("V", "voltage that the calibrator generates")
    dV_iX = given("V", "finite resolution of the multimeter")
    dV_S = given("V", "drift, loading and environment of the calibrator")
    of_both = V_iX - V_S + dV_iX - dV_S
    E_X = let(of_both, "error of indication", "V", label="(S9.1)", because="the model", like=V_iX)
