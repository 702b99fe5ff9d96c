"""Repeated readings, and limits alone: JCGM 100:2008, 4.4.3 to 4.4.6."""

from loopsheet import Method, given, let, mean, measured


class Temperature(Method, source="JCGM 100:2008, 4.4.3 to 4.4.6"):
    """A temperature by readings and by limits."""

    t = measured("K", "temperature, read again and again", positive=True)
    t_rect = given("K", "temperature, of which limits are known", positive=True)
    t_tri = given("K", "temperature, more likely in the middle of its limits", positive=True)
    t_mean = let(mean(t), "mean temperature", label="(3)", like=t)
