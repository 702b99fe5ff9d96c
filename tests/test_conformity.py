"""Conformity with limits: JCGM 106's examples, what probabilities are to one another, and what is printed."""

import json
import math
import re
from pathlib import Path
from statistics import NormalDist

import mpmath
import numpy as np
import openpyxl
import pytest
from helpers import method_folder, told
from hypothesis import given
from hypothesis import strategies as st
from test_budget import FILES
from test_monte_carlo import SUM

from loopsheet.derivations.unit_text import parse_unit
from loopsheet.report.cli import main
from loopsheet.report.distribution import DIVISORS, Shape
from loopsheet.report.inputs.inputs import Inputs, load
from loopsheet.report.inputs.limits import Guard, Limits, of_every_row
from loopsheet.report.inputs.number_text import read_printed
from loopsheet.report.messages.errors import Location
from loopsheet.report.result.uncertain import Budget, Conformity, Decision
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.conformity import beyond, conformity
from loopsheet.report.which_workbook import find_workbook

INF = math.inf


def judged(
    value: float, u: float, low: str = "", high: str = "", times: str = "0", shape: Shape = Shape.NORMAL
) -> Conformity:
    """A value beside its limits, with U = 2 u, or 3 u for a t of 5 degrees of freedom."""
    ends = (read_printed(text, parse_unit("1")) if text else None for text in (low, high))
    dof, factor = (5.0, 3.0) if shape is Shape.STUDENT else (INF, 2.0)
    budget = Budget("y", "y", (), value, u, dof=dof, level=0.95, factor=factor, shape=shape)
    guard = Guard(read_printed(times, parse_unit("1")).value)
    return conformity(budget, Limits("y", Location(), *ends, guard), budget)


@pytest.mark.parametrize(
    ("value", "u", "low", "high", "digits"),
    [
        (-5.47, 0.05, "", "-5.40", "0.92"),  # 7.3.2, a Zener diode: Phi(1.4)
        (509.7, 8.6, "490", "", "0.99"),  # 7.3.3, a container that is burst: Phi(2.3)
        (13.6, 1.8, "12.5", "16.3", "0.66"),  # 7.4, motor oil: Phi(1.5) - Phi(-0.6)
    ],
)
def test_examples_of_the_standard(value: float, u: float, low: str, high: str, digits: str) -> None:
    found = judged(value, u, low, high)
    assert f"{found.probability:.2f}" == digits
    assert found.decision is Decision.CONFORMS
    assert found.consumer_risk == pytest.approx(1 - found.probability, rel=1e-12)


def test_a_guard_band_of_the_expanded_uncertainty_leaves_a_risk_of_a_fortieth() -> None:
    """One limit, U = 2 u, at the acceptance limit: 2.3 % (ILAC-G8, table 1: less than 2.5 %)."""
    found = judged(8.0, 1.0, high="10", times="1")
    assert found.decision is Decision.CONFORMS
    assert found.consumer_risk == pytest.approx(0.022750131948179195, rel=1e-12)
    assert judged(math.nextafter(8.0, 9.0), 1.0, high="10", times="1").decision is Decision.NONE


@pytest.mark.parametrize(("z", "probability"), [(0.84, 0.80), (1.28, 0.90), (1.64, 0.95), (2.33, 0.99)])
def test_how_far_from_a_limit_a_value_has_to_lie(z: float, probability: float) -> None:
    """JCGM 106, 7.3: table 1."""
    assert f"{judged(-z, 1.0, high='0').probability:.2f}" == f"{probability:.2f}"


LAWS = (Shape.TRUNCATED, Shape.EXPONENTIAL, Shape.SAMPLES, Shape.CONVOLVED)
TOLD_WHOLE = [shape for shape in Shape if shape not in LAWS]
"""By their word; what has a law is in test_laws.py and test_convolution.py."""
SHAPES = st.sampled_from(TOLD_WHOLE)
SIZES = st.floats(-8, 8)


def density(x: mpmath.mpf, shape: Shape) -> mpmath.mpf:
    """Of an error with standard uncertainty 1: what the probabilities are integrals of."""
    half = mpmath.mpf(DIVISORS[shape])
    if shape is Shape.NORMAL:
        return mpmath.npdf(x)
    if shape is Shape.STUDENT:
        front = mpmath.gamma(3) / (mpmath.sqrt(5 * mpmath.pi) * mpmath.gamma(mpmath.mpf(5) / 2))
        return front * (1 + x**2 / 5) ** -3
    if abs(x) >= half:
        return mpmath.mpf(0)
    if shape is Shape.RECTANGULAR:
        return 1 / (2 * half)
    return (
        (half - abs(x)) / half**2
        if shape is Shape.TRIANGULAR
        else 1 / (mpmath.pi * mpmath.sqrt(half**2 - x**2))
    )


@pytest.mark.parametrize("shape", TOLD_WHOLE)
@pytest.mark.parametrize("z", [0.0, 0.3, 1.1, 1.39])
def test_a_probability_is_the_integral_of_its_density(shape: Shape, z: float) -> None:
    whole = mpmath.quad(lambda x: density(x, shape), [0, z])
    assert beyond(z, shape, 5.0) == pytest.approx(float(mpmath.mpf(1) / 2 - whole), rel=1e-12)


@given(SHAPES, SIZES, SIZES, st.floats(0.01, 9))
def test_probabilities_make_one(shape: Shape, value: float, low: float, width: float) -> None:
    found = judged(value, 1.0, f"{low:.9f}", f"{low + width:.9f}", shape=shape)
    assert found.below + found.above + found.probability == pytest.approx(1, abs=1e-14)
    assert all(0 <= each <= 1 for each in (found.below, found.above, found.probability))
    assert (found.consumer_risk is None) == (found.decision is not Decision.CONFORMS)
    assert (found.producer_risk is None) == (found.decision is not Decision.DOES_NOT)


@given(SHAPES, SIZES, st.floats(0.01, 9))
def test_both_sides_of_symmetric_limits_are_alike(shape: Shape, value: float, half: float) -> None:
    one, other = (judged(y, 1.0, f"{-half:.9f}", f"{half:.9f}", "0.5", shape) for y in (value, -value))
    assert (one.below, one.above, one.decision) == (other.above, other.below, other.decision)
    assert one.probability == other.probability


@given(SHAPES, st.floats(0, 8), st.floats(0, 3), st.floats(0, 3))
def test_a_wider_guard_band_accepts_less_and_leaves_a_smaller_risk(
    shape: Shape, value: float, one: float, other: float
) -> None:
    narrow, wide = (judged(value, 1.0, "0", "9", f"{t:.9f}", shape) for t in sorted((one, other)))
    if wide.decision is Decision.CONFORMS:
        assert narrow.decision is Decision.CONFORMS
    least = [judged(9 - each.guard, 1.0, "", "9", shape=shape).above for each in (narrow, wide)]
    assert least[0] >= least[1]


def test_far_outside_the_probability_keeps_its_digits() -> None:
    found = judged(20.0, 1.0, "0", "10")
    assert found.producer_risk == pytest.approx(float(mpmath.ncdf(-10) - mpmath.ncdf(-20)), rel=1e-12)


UNKNOWN = "the guard band is not known"


@pytest.mark.parametrize(
    ("value", "u", "factor", "decision", "because"),
    [
        (math.nan, math.nan, math.nan, Decision.NONE, "it has no value"),
        (5.0, math.nan, math.nan, Decision.NONE, f"{UNKNOWN}: nothing is known of the uncertainty"),
        (11.0, math.nan, math.nan, Decision.DOES_NOT, "it lies outside of the tolerance limits"),
        (10.0, 0.0, 1.96, Decision.CONFORMS, "it lies within the acceptance limits"),
        (5.0, 1.0, math.nan, Decision.NONE, f"{UNKNOWN}: who knows"),
    ],
)
def test_what_is_not_known(value: float, u: float, factor: float, decision: Decision, because: str) -> None:
    high = read_printed("10", parse_unit("1"))
    because_of_it = "" if math.isnan(u) else "who knows"
    budget = Budget("y", "y", (), value, u, level=0.95, factor=factor, because=because_of_it)
    found = conformity(budget, Limits("y", Location(), None, high, Guard(high.value / 10)), budget)
    assert (found.decision, found.because) == (decision, because)
    assert math.isnan(found.probability) == (u != 0)


LIMITS = """
[limits]
"x_p[1]" = "22.2 .. 23 um"
"x_p[2]" = ">= 0.0318 mm"
alpha_mean = "<= 1.2"
[limits.rule]
guard = "0.5 U"
level = "99 %"
"""


def folder(tmp_path: Path, more: str) -> str:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text + (more if name == "report.toml" else ""), encoding="utf-8")
    return str(tmp_path)


def test_a_budget_tells_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    campaign = folder(tmp_path, LIMITS)
    assert told(capsys, "x_p[1]", campaign).splitlines()[1:4] == [
        "limits 22.2 to 23 um, guard band 0.29 um (0.5 U at 99 %), acceptance limits 22.49 to 22.71 um",
        "x_p[1] conforms: it lies within the acceptance limits",
        "conformance probability 92.22 %, specific consumer’s risk 7.78 %, "
        "by a t distribution with 100 degrees of freedom",
    ]
    assert "no decision on x_p[2]: it lies in the guard band" in told(capsys, "x_p[2]", campaign)
    assert "limits" not in told(capsys, "x_p[3]", campaign)
    assert "conforms: it lies" in told(capsys, "x_p[1]", campaign, "--format", "markdown")


def half_of_a_product(y: float) -> mpmath.mpf:
    """The probability that the product of two normal errors lies between 0 and y."""
    return mpmath.quad(lambda t: mpmath.besselk(0, t), [0, y]) / mpmath.pi


def test_what_the_law_of_propagation_does_not_tell_is_drawn(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A product of two normal errors around zero has the density K0(y) / pi: 0.896 below 1, and not 0.841."""
    product = SUM.replace("sum(c.symbol for c in x)", "x[0].symbol * x[1].symbol")
    stated = "".join(f'x_{n} = "0.0, u = 1"\n' for n in range(1, 5))
    limits = '[limits]\ny = "<= 1"\n[limits.rule]\nguard = "U"\nlevel = "90 %"\n'
    method_folder(tmp_path, product, "test,r [1]\n1,1\n2,2\n", f"[parameters]\n{stated}{limits}")
    own = json.loads(told(capsys, "y", str(tmp_path), "--format", "json"))["conformity"]
    assert own["above"] == pytest.approx(float(0.5 - half_of_a_product(1)), abs=0.007)
    level = mpmath.findroot(lambda y: 2 * half_of_a_product(y) - 0.9, 1.6)  # 1.60; of a normal one 1.64
    assert own["guard"] == pytest.approx(float(level), abs=0.05)
    assert (own["distribution"], own["decision"]) == ("samples", "no decision")
    assert own["below"] == 0  # there is no lower limit
    words = told(capsys, "y", str(tmp_path))
    assert "the guard bands meet" not in words
    assert "(U at 90 % of the draws)" in words
    assert re.search(r"conformance probability \d\d\.\d %, by 20000 draws: ", words)


def of_two(tmp_path: Path, first: str, second: str, limit: str) -> str:
    """A folder whose y is a sum of two numbers, with a limit."""
    given = f'x_1 = "{first}"\nx_2 = "{second}"\nx_3 = "0, exact"\nx_4 = "0, exact"\n'
    limits = f'[limits]\ny = "{limit}"\n[limits.rule]\nguard = "U"\n'
    return str(method_folder(tmp_path, SUM, "test,r [1]\n1,1\n2,2\n", f"[parameters]\n{given}{limits}"))


@pytest.mark.parametrize(
    ("error", "inside"),
    [
        # A square is at most 1.6 where its root is at most 1.265, and not where a straight line is.
        ("+-0.3 rect", (1.6**0.5 - 0.7) / 0.6),
        ("u = 0.15", NormalDist(1.0, 0.15).cdf(1.6**0.5) - NormalDist(1.0, 0.15).cdf(-(1.6**0.5))),
    ],
)
def test_what_bends_on_its_way_to_a_limit_is_drawn(tmp_path: Path, error: str, inside: float) -> None:
    """Terms of second order make 1 % of the variance, and more of what lies farther out."""
    code = "from loopsheet import Method, given, let\nclass Power(Method):\n    'A square.'\n"
    code += '    V = given("1", "voltage")\n    P = let(V**2, "power")\n    L = let(2 * V, "twice")\n'
    more = f'[parameters]\nV = "1.000, {error}"\n[limits]\nP = "<= 1.6"\nL = "<= 2.5"\n'
    method_folder(tmp_path, code, more=more)
    square, line = Study(tmp_path).computed.uncertain().conformities
    assert square.probability == pytest.approx(inside, abs=5e-3)
    assert (square.by.draws, square.budget.draws, line.by.draws) == (20_000, 0, 0)


SUM_AND_SQUARE = """
from loopsheet import Method, given, let
class Sum(Method):
    "A sum, and one with a square."
    a = given("1", "a", positive=True)
    b = given("1", "b")
    L = let(2 * a, "twice")
    y = let(a + b**2, "with a square")
"""


@pytest.mark.parametrize(
    ("a", "limits", "draws"),
    [
        ("10.0, u = 0.02", 'L = "0 .. 24"', 0),  # a straight line, whose way to 0 is 500 u
        ("10.0, u = 6", 'L = "0 .. 24"', 0),  # many draws have no value: the budget has a distribution
        ("10.0, u = 1", 'y = "<= 11"', 20_000),  # across its way it bends, and its mean is another
        ("10.0, u = 1", 'y = "<= 30"', 0),  # but nothing comes near
    ],
)
def test_where_a_probability_is_drawn(tmp_path: Path, a: str, limits: str, draws: int) -> None:
    more = f'[parameters]\na = "{a}"\nb = "0.0, u = 0.35"\n[limits]\n{limits}\n'
    method_folder(tmp_path, SUM_AND_SQUARE, more=more)
    (found,) = Study(tmp_path).computed.uncertain().conformities
    assert found.by.draws == draws
    assert 0 < found.probability <= 1


@pytest.mark.parametrize(
    ("limit", "said"),
    [
        ("<= 10.00", "conformance probability 90.00 %, by the convolved"),
        ("<= 10.09", "conformance probability 100 %, specific consumer’s risk 0 %, by"),
        ("<= 10.08", "conformance probability 100 %, specific consumer’s risk 0 %, by"),
        ("<= 9.90", "conformance probability 50.00 %, by"),
        ("9.80 .. 10.05", "conformance probability 88.59 %, by"),  # 10 % below, 0.03^2 / 0.064 above
    ],
)
def test_two_rectangular_sources_make_a_trapezoid(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], limit: str, said: str
) -> None:
    campaign = of_two(tmp_path, "9.90, +-0.10 rect", "0.00, +-0.08 rect", limit)
    assert said in told(capsys, "y", campaign)


def test_what_is_given_and_has_limits_keeps_its_check_on_the_first_worksheet(tmp_path: Path) -> None:
    """A result has its statement beside; a given cell tells there how it was checked."""
    campaign = of_two(tmp_path, "9.90, u = 0.30", "0.00, u = 0.05", "<= 13")
    toml = tmp_path / "report.toml"
    both = toml.read_text(encoding="utf-8").replace("[limits]\n", '[limits]\nx_1 = "<= 12"\n')
    toml.write_text(both, encoding="utf-8")
    assert main(["build", campaign, "--to", "xlsx"]) == 0
    book = openpyxl.load_workbook(tmp_path / "out" / "report.xlsx")
    beside = {str(row[0].value): row[6:] for row in book["report"].iter_rows(max_col=8)}
    assert str(beside["x_1"][1].value).startswith("=IF(OR(NOT(ISNUMBER(")
    assert str(beside["y"][0].value).startswith("=uncertainty!$B$")


def test_beside_a_normal_source_nothing_is_certain(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of an error that has ends alone a probability is 100 %; one without ends reaches beyond all limits."""
    campaign = of_two(tmp_path, "9.90, +-0.30 rect", "0.00, u = 0.05", "<= 13")
    words = told(capsys, "y", campaign)
    assert "conformance probability more than 99.99 %, specific consumer’s risk less than 0.01 %" in words


@pytest.mark.parametrize("other", ["0.05, exponential", "0.00, u = 0.08, min = 0", "0.00, s = 0.10, n = 4"])
def test_a_source_beside_a_rectangular_one_is_as_it_is_drawn(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], other: str
) -> None:
    """With draws of our own; the guard band is half of what holds 95 % of them around the value."""
    found = json.loads(
        told(capsys, "y", of_two(tmp_path, "9.80, +-0.10 rect", other, "<= 10"), "--format", "json")
    )
    draws, size = np.random.default_rng(2), 400_000
    beside = {
        "exponential": draws.exponential(0.05, size),
        "min = 0": np.abs(draws.normal(0, 0.08, size)),
        "n = 4": 0.05 * draws.standard_t(3, size),
    }
    (drawn,) = (9.8 + draws.uniform(-0.1, 0.1, size) + each for word, each in beside.items() if word in other)
    share = float(np.mean(drawn > 10))
    assert found["conformity"]["above"] == pytest.approx(share, abs=4 * math.sqrt(share / size))
    inside = np.mean(np.abs(drawn - found["value"]) < found["conformity"]["guard"])
    assert inside == pytest.approx(0.95, abs=4 * math.sqrt(0.95 * 0.05 / size))


def test_guard_bands_that_meet_accept_nothing() -> None:
    found = judged(5.0, 3.0, "4", "6", "1")
    assert (found.decision, found.because) == (Decision.NONE, "the guard bands meet: no value is accepted")


def test_a_program_gets_all_digits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = json.loads(told(capsys, "x_p[1]", folder(tmp_path, LIMITS), "--format", "json"))
    own, u = found["conformity"], found["u"]
    # 100 degrees of freedom: t at 99 %, from the incomplete beta function
    low, high = (float(mpmath.mpf(d)) / (u * 1e6) for d in ("0.38", "0.42"))
    tails = [mpmath.betainc(50, 0.5, 0, 100 / (100 + z * z), regularized=True) / 2 for z in (low, high)]
    assert own["below"] == pytest.approx(float(tails[0]), rel=1e-9)
    assert own["above"] == pytest.approx(float(tails[1]), rel=1e-9)
    assert own["guard"] == pytest.approx(0.5 * 2.6258905 * u, rel=1e-7)
    assert (own["decision"], own["distribution"]) == ("conforms", "t")


def test_a_check_counts_what_does_not_conform(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", folder(tmp_path, LIMITS), "--format", "json"]) == 1
    found = json.loads(capsys.readouterr().out)["checks"]
    own = {each["name"]: each for each in found if each["kind"] == "conformity"}
    assert {name: each["passed"] for name, each in own.items()} == {
        "x_p[1]": True,
        "x_p[2]": False,
        "alpha_mean": False,
    }
    assert "specific producer’s risk" in own["alpha_mean"]["message"]


def read(tmp_path: Path, more: str) -> Inputs:
    return load(Path(folder(tmp_path, more)), find_workbook)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1.25..1.35", "1.25 to 1.35"),
        ("<=1.35", "at most 1.35"),
        ("≥ -2 um", "at least -2 um"),
        ("1 .. 2 um", "1 to 2 um"),
        ("1 mm .. 2 cm", "1 mm to 2 cm"),
        ("10.00 +- 0.10 mm", "9.90 to 10.10 mm"),
        ("10 mm ± 50 um", "9.95 to 10.05 mm"),
        ("10.0 mm +/- 0.10", "9.90 to 10.10 mm"),
        ("-250 mm +- 2 %", "-255 to -245 mm"),
        ("1.30+-0.05", "1.25 to 1.35"),
        ("0.00 +- 0.15 %", "-0.15 to 0.15 %"),
        ("0.00 % +- 0.15 %", "-0.15 to 0.15 %"),
        ("297.6 K +- 2 percent", "291.648 to 303.552 K"),
        ("10 mm +- 500 ppm", "9.995 to 10.005 mm"),
        ("250 ppm +- 10 ppm", "240 to 260 ppm"),
        ("0 ppm +- 0.1 %", "-0.1 to 0.1 %"),
        ("30 deg +- 2 %", "29.4 to 30.6 deg"),
        ("25 degC +- 0.5 K", "24.5 to 25.5 degC"),
        ("25 +- 0.5 degC, guard = 0.1 K", "24.5 to 25.5 degC"),
    ],
)
def test_what_is_understood(tmp_path: Path, text: str, said: str) -> None:
    (found,) = read(tmp_path, f'[limits]\nq = "{text}"\n').limits
    assert str(found) == said


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("25 % +- 10 %", "write the limits: 22.5 .. 27.5 % or 15 .. 35 %"),
        ("25 % +- 10 percent", "write the limits: 22.5 .. 27.5 % or 15 .. 35 %"),
        ("1.30 +- 5 percent", "write the limits: 1.235 .. 1.365 or 1.25 .. 1.35"),
        (
            "250 +- 10 ppm",
            "write the limits: 249.9975 .. 250.0025 or 249.99999 .. 250.00001 or 240 .. 260 ppm",
        ),
        ("500 ppm +- 2 %", "write the limits: 490 .. 510 ppm or -19500 .. 20500 ppm"),
        ("76.01 degF +- 2 %", "zero degF is not nothing, of which there is a share: say how much, in K"),
        ("26,38 .. 26,50 kJ/g", "a decimal comma? write 26.50"),
    ],
)
def test_what_could_be_either_says_what_to_write(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, hint: str
) -> None:
    assert main(["budget", "alpha_mean", folder(tmp_path, f'[limits]\nalpha_mean = "{text}"\n')]) == 2
    assert hint in capsys.readouterr().err


def test_limits_may_have_a_rule_of_their_own(tmp_path: Path) -> None:
    lines = ['a = "<= 2"', 'b = "1 .. 2 um, guard = 0.2 um"']
    lines += ['c = ">= 1,level=90 %"', 'd = "<= 2, guard = 0.5 U, level = 80 %"']
    rule = '[limits.rule]\nguard = "U"\nlevel = "99 %"'
    rules = [one.guard for one in read(tmp_path, "\n".join(["[limits]", *lines, rule])).limits]
    assert [(float(one.times), one.level) for one in rules] == [(1, 0.99), (0, 0.99), (1, 0.9), (0.5, 0.8)]
    assert [one.width and (one.width.text, one.width.unit) for one in rules] == [
        None,
        ("0.2", "um"),
        None,
        None,
    ]


def test_a_rule_of_its_own_decides(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The same limit of the same cell, with and without: what was accepted is not any more."""
    lines = '[limits]\nalpha_mean = "<= 1.33{}"\n"x_p[1]" = "22 .. 24 um, guard = 0.2 um"\n'
    simple, guarded = (
        told(capsys, "alpha_mean", folder(tmp_path, lines.format(own)))
        for own in ("", ", guard = U, level = 90 %")
    )
    assert main(["build", folder(tmp_path, lines.format("")), "--out", str(tmp_path / "out")]) == 0
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    band = "drawn in by the guard band, which is a fixed width or none, as the table says"
    assert band in " ".join(re.sub(r"<[^>]*>", "", page).split())
    assert "limits at most 1.33, no guard band\nalpha_mean conforms:" in simple
    assert "U at 90 %), acceptance limits at most 1.276\nno decision on alpha_mean:" in guarded


def test_a_unit_behind_the_second_number_is_that_of_both(tmp_path: Path) -> None:
    (found,) = read(tmp_path, '[limits]\nx = "1 .. 2 um"\n').limits
    assert found.ends == (1e-6, 2e-6)


@pytest.mark.parametrize(
    ("line", "code", "culprit"),
    [
        ('alpha_mean = "1.3"', "LS441", "1.3"),
        ('alpha_mean = "1.25 .. x"', "LS441", "x"),
        ('alpha_mean = "1.30 +- 5 %"', "LS441", "1.30 +- 5 %"),
        ('alpha_mean = "25 % +- 10 %"', "LS441", "25 % +- 10 %"),
        ('alpha_mean = "24.5 degC +- 2 %"', "LS441", "24.5 degC +- 2 %"),
        ('alpha_mean = "1.30 +- 0"', "LS441", "1.30 +- 0"),
        ('alpha_mean = "1e40 +- 1"', "LS441", "1e40 +- 1"),
        ('alpha_mean = "5 +- 1e-200"', "LS441", "5 +- 1e-200"),
        ('alpha_mean = "1.30 +- x"', "LS441", "x"),
        ('alpha_mean = "1 m +- 2 s"', "LS441", "1 m +- 2 s"),
        ('alpha_mean = "1.35 .. 1.25"', "LS441", "1.35 .. 1.25"),
        ('alpha_mean = "<= 1.25 furlung"', "LS441", "furlung"),
        ("alpha_mean = 1.3", "LS205", "1.3"),
        ('alpha_mean = "<= 1 m"', "LS422", '"<= 1 m"'),
        ('alfa_mean = "<= 1"', "LS505", "alfa_mean"),
        ('"alpha[1-9]" = "<= 1"', "LS506", '"alpha[1-9]"'),
        ('"x_p[01]" = "<= 1 um"', "LS506", '"x_p[01]"'),
        ('[limits.rule]\nguard = "2 furlung"', "LS442", '"2 furlung"'),
        ('[limits.rule]\nguard = "-1"', "LS442", '"-1"'),
        ('[limits.rule]\nlevel = "0.5 %"', "LS442", '"0.5 %"'),
        ('[limits.rule]\nlevl = "95 %"', "LS203", "levl"),
        ('alpha_mean = "<= 2, guard = 1 um"', "LS422", '"<= 2, guard = 1 um"'),
        ('alpha_mean = "<= 2, guard = 2 furlung"', "LS442", "2 furlung"),
        ('alpha_mean = "<= 2, gard = U"', "LS442", "gard"),
        ('alpha_mean = "<= 2, guard = U, 3"', "LS442", "U, 3"),
        ('alpha_mean = "1,25 .. 1,35"', "LS441", "1,35"),
        ('alpha_mean = "<= 2"\n[limits.rule]\nguard = "1 um"', "LS422", '"1 um"'),
    ],
)
def test_what_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], line: str, code: str, culprit: str
) -> None:
    assert main(["budget", "alpha_mean", folder(tmp_path, f"[limits]\n{line}\n")]) == 2
    told = capsys.readouterr().err
    assert told.count("error[") == 1
    assert f"error[{code}]" in told
    marked = next(row for row in told.splitlines() if "^" in row)
    above = told.splitlines()[told.splitlines().index(marked) - 1]
    assert above[marked.index("^") : marked.rindex("^") + 1] == culprit


def test_the_report_tells_it_in_every_form(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    main(["build", folder(tmp_path, LIMITS), "--out", str(out)])
    capsys.readouterr()
    page, tex = ((out / f"report.{form}").read_text(encoding="utf-8") for form in ("html", "tex"))
    assert "Conformity with limits." in page
    assert "22.2 to 23" in page
    assert "<tr class=unexpected>" in page
    assert "& does not conform & " in tex
    assert r"\num{0.29}~\unit" in tex
    assert "a share of U for 99" in tex
    first = page[page.index("id=result") : page.index("id=measured")]
    assert "conforms: it lies within the acceptance limits (22.2 to 23 µm, guard band" in first
    assert "does not conform: it lies outside of the tolerance limits (at most 1.2, guard" in first
    assert re.search(r"<span class=sure>U\s=\s[\d.]+ \(k\s=\s[\d.]+\)</span>", first)
    assert page.count("22.49 to 22.71") == 2  # the acceptance limits, there and in their table


def test_the_report_tells_why_there_is_no_expanded_uncertainty(tmp_path: Path) -> None:
    """Correlated sources, one of few degrees of freedom: JCGM 100 has no formula for such."""
    stated = '[uncertainty.correlation]\n"v, x_p" = "0.4"\n'
    limited = '[limits]\nalpha_mean = "<= 2"\n[limits.rule]\nguard = "U"\n'
    toml = Path(folder(tmp_path, stated + limited)) / "report.toml"
    toml.write_text(toml.read_text(encoding="utf-8").replace('v = "exact"', 'v = "u = 0.02 m/s"'))
    assert main(["build", str(tmp_path), "--out", str(tmp_path / "out")]) == 1
    page, tex = (
        (tmp_path / "out" / f"report.{form}").read_text(encoding="utf-8") for form in ("html", "tex")
    )
    why = "correlated sources have finite degrees of freedom"
    assert f"the guard band is not known: {why} (at most 2, guard band" in page
    assert f"U is not known: {why}" in page[: page.index("id=measured")]
    assert f"U is not known: {why}" in tex


def test_there_is_no_decision_where_draws_alone_have_a_value(tmp_path: Path) -> None:
    """Of what is divided by a reading of 0: the search for an interval about no number would not end."""
    code = (
        "from loopsheet import Method, let, measured\n\nclass Speed(Method, source='own'):\n    'Speeds.'\n"
        "    x = measured('mm', 'way')\n    y = measured('s', 'time')\n    q = let(x / y, 'speed')\n"
    )
    table, limit = "x [mm],y [s]\n5.0,2.0\n3.0,1.0\n5.1,0\n", '[limits]\nq = "<= 2.8 mm/s"\n'
    report = Study(method_folder(tmp_path, code, table, limit)).computed
    found = [each.decision for each in report.uncertain().conformities]
    assert [each is Decision.CONFORMS for each in found] == [True, False, False]
    assert report.uncertain().conformities[2].because == "it has no value"


def test_limits_of_a_column_are_of_each_row_that_has_none_of_its_own() -> None:
    limits = [Limits(cell, Location(), None, None, Guard()) for cell in ("E", "E[2]", "m", "x")]
    cells = {"E": ("K", {(1,), (2,), (3,)}), "m": ("g", {()})}
    assert [each.address for each in of_every_row(limits, cells)] == ["E[1]", "E[3]", "E[2]", "m", "x"]


def test_what_conforms_by_the_rule_and_more_likely_does_not_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wide, at_the_limit, sure = (
        judged(value, u, "0", "10") for value, u in ((5.0, 20.0), (10.0, 1.0), (5.0, 1.0))
    )
    assert wide.decision is at_the_limit.decision is sure.decision is Decision.CONFORMS
    assert [each.improbable for each in (wide, at_the_limit, sure)] == [True, False, False]
    assert not judged(11.0, 20.0, "0", "10").improbable
    main(["check", folder(tmp_path, '\n[limits]\n"x_p[1]" = "22.57 .. 22.61 um"\n')])
    (line,) = (each for each in capsys.readouterr().out.splitlines() if "x_p[1] conforms" in each)
    assert line.startswith("warning: ")
    assert "so large that it is more likely outside of the tolerance limits (" in line


def test_a_value_in_the_guard_band_is_not_printed_as_its_end(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With one digit of the guard band both were 22.6."""
    campaign = folder(tmp_path, '\n[limits]\n"x_p[1]" = ">= 19.6 um, guard = 3 um"\n')
    said = told(capsys, "x_p[1]", campaign)
    assert "acceptance limits at least 22.60 um" in said
    assert "no decision on x_p[1]: it lies in the guard band" in said


SPRING = """from loopsheet import Method, fit, given, let, measured, unknown

class Spring(Method, rows="loads", headline="give"):
    "A spring."
    m = measured("g", "mass", positive=True)
    x = measured("mm", "position")
    g = given("m/s^2", "free fall", positive=True)
    F = let(m * g, "force", "N")
    zero, give = unknown("position without a mass", "mm"), unknown("way by force", "mm/N")
    line = fit(x, zero + give * F)
"""


def test_a_limit_of_what_has_no_budget_in_the_workbook_is_told_there(tmp_path: Path) -> None:
    """Of the scatter of a fit only draws know how it is distributed: there are no formulas for it."""
    rows = "1,50.0,112.4\n2,100.0,132.1\n3,150.0,151.3\n4,200.0,171.4\n5,250.0,190.7\n"
    more = '[parameters]\ng = "9.8123 m/s^2, u = 0.0002 m/s^2"\n'
    more += '[uncertainty]\nm = "+-0.1 g rect"\nx = "u = 0.3 mm"\n[limits]\nline_s = "<= 0.2 mm"\n'
    method_folder(tmp_path, SPRING, f"load,m [g],x [mm]\n{rows}", more)
    main(["build", str(tmp_path), "--to", "xlsx"])
    book = openpyxl.load_workbook(tmp_path / "out" / "report.xlsx")["uncertainty"]
    told = [str(row[0].value) for row in book.iter_rows()]
    after = told.index("limits of cells without a budget here, as issued") + 1
    assert told[after].startswith("line_s does not conform: it lies outside of the tolerance limits")
