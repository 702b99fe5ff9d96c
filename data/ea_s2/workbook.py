"""Calibration of a weight of nominal value 10 kg: EA-4/02, S2."""

from loopsheet import Method, given, let


class Weight(Method, source="EA-4/02, S2"):
    """Calibration of a weight of nominal value 10 kg."""

    m_S = given("kg", "conventional mass of the standard")
    dm_D = given("kg", "drift of the standard since its calibration")
    dm = given("kg", "observed difference")
    dm_C = given("kg", "eccentricity and magnetic effects")
    dB = given("kg", "air buoyancy")
    m_X = let(
        m_S + dm_D + dm + dm_C + dB,
        "conventional mass of the weight",
        label="(S2.1)",
        because="the model",
        like=m_S,
    )
