"""A method of one's own: put what is given, what is measured and what follows in the place of these lines."""

from loopsheet import Method, given, let


class Result(Method, source="where it is published"):
    """What is determined."""

    x = given("m", "what is given", example="1.00 m")
    y = let(x, "what follows")
