"""Ten resistors that were calibrated with the same standard: the example of JCGM 100:2008, 5.2.2."""

from loopsheet import Method, let, measured, total


class ResistorsInSeries(Method, source="JCGM 100:2008, 5.2.2", rows="resistors", index="i"):
    """Ten resistors and one standard."""

    R = measured("ohm", "resistance", positive=True)
    R_ref = let(total(R), "reference resistance", "ohm", label="(5.2.2)", because="in series", like=R)
