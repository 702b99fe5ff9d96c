"""Additive models: JCGM 101:2008, 9.2.2 to 9.2.4."""

from loopsheet import Method, given, let


class AdditiveModels(Method, source="JCGM 101:2008, 9.2.2 to 9.2.4"):
    """Additive models."""

    X_1 = given("1", "quantity 1, normal")
    X_2 = given("1", "quantity 2, normal")
    X_3 = given("1", "quantity 3, normal")
    X_4 = given("1", "quantity 4, normal")
    R_1 = given("1", "quantity 1, rectangular")
    R_2 = given("1", "quantity 2, rectangular")
    R_3 = given("1", "quantity 3, rectangular")
    R_4 = given("1", "quantity 4, rectangular")
    W = given("1", "quantity 4, ten times as wide")
    model = "the model"
    four, same = "sum of four normal quantities", "sum of four rectangular quantities of the same width"
    Y_2 = let(X_1 + X_2 + X_3 + X_4, four, label="(9.2.2)", because=model)
    Y_3 = let(R_1 + R_2 + R_3 + R_4, same, label="(9.2.3)", because=model)
    Y_4 = let(
        R_1 + R_2 + R_3 + W, "the same with one that is ten times as wide", label="(9.2.4)", because=model
    )
