"""All that is wrong in the body of a method is told at once, and nothing that follows from it."""

from pathlib import Path

import pytest
from helpers import method_folder

from loopsheet import Method, let, measured
from loopsheet.report.column import SheetError
from loopsheet.report.messages.errors import InputError
from loopsheet.report.study import Study

HEAD = """\
from sympy import log
from loopsheet import (
    Method, claim, constant, fit, given, let, mean, measured, pairs, plot, root, table, unknown
)


class Lab(Method):
    "Lab."

    x = measured("mm", "length", positive=True)
    y = measured("N", "force")
    K = given("N/mm", "stiffness")
"""
FIRST = HEAD.count("\n") + 1

WRONG = {
    "units, sums and areas": (
        """\
b = given("furlongs per day", "speed")
d = let(log(x), "logarithm of a length")
e = let(x + y, "sum of two kinds")
f = let(K * x, "force", "kg")
g = let(b * x, "what names a line that is wrong")
h = let(2 * mean(g) - K * b, "and what names that")
i = let(K * x, "force", "N")
""",
        {0: "furlongs per day", 1: "must be a pure number", 2: "cannot add", 3: "but the formula gives"},
    ),
    "words and names": (
        """\
a = measured("mm", "width", positiv=True)
b = let(zz * x, "of a name that there is not")
c = let(x, 3)
d = constant("gas constant of moles")
claim(x, 2 * x, "a length is two")
plot(x, K)
table("Mixed", x, K)
e = let(mean(a * b) + c, "of three wrong lines")
plot(a, x)
claim(b, x, "of what is wrong")
f = let(x**2, "area", "mm")
""",
        {0: "'positiv'", 1: "'zz' is not defined", 2: "in quotes, not 3", 3: "CODATA has no",
         5: "single number", 6: "one kind of rows", 10: "but the formula gives"},
    ),
    "labels": (
        """\
a = let(2 * x, "twice", label="(A)")
b = let(3 * x, "thrice", label="(A)")
c = let(4 * x, "four times", label=7)
d = let(5 * x, "five times", label="(B)\\n(C)")
claim(a / 2, x, "it is half of that", label="(A)")
""",
        {1: "b: another equation is called (A)", 2: "in quotes, not 7", 3: "of one line", 4: "(A) already"},
    ),
    "a fit and what it has": (
        """\
a = unknown("where it begins", "mm")
b = unknown("N/mm", "slope")
line = fit(y, a + b * x)
s = let(line.s / line.residual, "scatter")
plot(x, line.fitted)
i = let(K * x, "force", "m")
q = unknown()
q = root(q * x, y, "nothing", low=3, high=2)
""",
        {1: "have they changed places?", 5: "but the formula gives", 7: "low is not below high"},
    ),
    "what a fit shall find": (
        """\
a = unknown("where it begins", "N", start=-2.5, positive=True)
b = unknown("slope", "Nmm")
c = unknown("power", start=3, low=0, high=2)
d = unknown("factor", "N/mm", start=0.5, low=0.1, high=2, positive=True)
line = fit(y, a + b * x**c)
other = fit(y, d * x)
e = let(a / b, "quotient of what is wrong", "mm")
""",
        {0: "the start, -2.5, has to be greater than 0 N: positive, low and high say so",
         1: "the unit 'Nmm' is unknown", 2: "the start, 3, has to be between 0 and 2: positive"},
    ),
    "LaTeX that TeX does not take": (
        """\
a = let(2*x, "twice", latex="a_{2")
b = let(3*x, "thrice", latex="50 % of b")
c = let(4*x, "four times", latex="c_4_1")
d = let(5*x, "five times", latex="d_5%s")
e = let(6*x, "six times", latex="e~6")
f = let(7*x, "seven times", latex=7)
""",
        {
            0: "a brace without its other",
            1: "means another thing in LaTeX",
            2: "two scripts in one place",
            5: "a LaTeX is a text in quotes, not 7",
        },
    ),
    "nothing that says what it is": (
        """\
z = measured("mm")
""",
        {0: "say what it is, behind the unit: 'mm', 'length of the rod'"},
    ),
    "what has no name": (
        """\
let(2 * x, "twice as long")
required(y < 1, "not too long")
fit(y, K * x)
a = let(2 * x, "twice as long")
""",
        {0: "'twice as long' has no name", 1: "from loopsheet import required", 2: "a fit has no name"},
    ),
    "a line that Python refuses": (
        """\
a = let(log(x), "logarithm of a length")
b = let(x^2, "area")
""",
        {0: "must be a pure number", 1: "a power is written x**2"},
    ),
    "what Python refuses of what was wrong": (
        """\
a = let(log(x), "logarithm of a length")
b = let(a[1], "of it")
""",
        {0: "must be a pure number"},
    ),
    "what a member of a pair takes": (
        """\
first, second = pairs()
a = let(first(x) - second(z), "apart")
b = let(first(K) * first(x), "of what has no rows")
c = let(first(a) + second(y), "of what failed")
""",
        {1: "'z' is not defined", 2: "K has no value for each row, of which a pair has two"},
    ),
    "what a root that is refused would have found": (
        """\
q = unknown("length", "mm")
q = root(q**2, x**2, "length", low=1, high=9)
r = let(q / x, "share", "%")
plot(x, q)
""",
        {1: "is enough: root(...) says what q is"},
    ),
    "what follows from a fit, a unit and a module that are not there": (
        """\
a = unknown("where it begins", "N")
b = unknown("slope", "N/mm")
z = let(y + x, "sum of two kinds")
line = fit(z, a + b * x)
straight = let(a + b * x, "line", "N")
K_2 = let(K * x, "stiffness", "kg")
F = let(K_2 * x, "force", "N")
m = let(np.mean(x), "mean", "mm")
u = let(log(x), "logarithm of a length")
v = let(b0 + b_0, "of misspelt names")
""",
        {2: "cannot add", 5: "but the formula gives", 7: "'np' is not defined", 8: "must be a pure number",
         9: "'b0' is not defined"},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_all_that_is_wrong_is_told_at_once(tmp_path: Path, name: str) -> None:
    lines, expected = WRONG[name]
    body = "".join(f"    {line}\n" for line in lines.splitlines())
    with pytest.raises(InputError) as told:
        _ = Study(method_folder(tmp_path, HEAD + body, more="[parameters]\n")).computed
    found = [(each.at.line, str(each)) for each in told.value.diagnostics]
    assert [line for line, _ in found] == [FIRST + line for line in expected]
    for (_, said), words in zip(found, expected.values(), strict=True):
        assert words in said


def test_in_python_the_first_has_notes_of_all() -> None:
    with pytest.raises(SheetError, match="but the formula gives") as told:

        class Wrong(Method):
            """Two areas that are called lengths."""

            x = measured("mm", "side")
            A = let(x**2, "area", "mm")
            B = let(2 * x**2, "area", "mm")

    assert [note.partition(": ")[2][:2] for note in told.value.__notes__] == ["A ", "B "]
    with pytest.raises(SheetError, match="gives m"):

        class Right(Method):
            """What was wrong before is forgotten."""

            x = measured("mm", "side")
            A = let(x, "length", "mm^2")
