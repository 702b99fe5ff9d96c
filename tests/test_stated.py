"""Uncertainties as text: what is understood, what is refused, and where the finding points."""

import math
from collections.abc import Callable
from contextlib import suppress
from fractions import Fraction
from pathlib import Path

import pytest
from helpers import method_folder
from hypothesis import given
from hypothesis import strategies as st

from loopsheet.derivations.unit_text import parse_unit
from loopsheet.report.distribution import Shape
from loopsheet.report.inputs.inputs import Inputs, load
from loopsheet.report.inputs.number_text import read_printed
from loopsheet.report.inputs.stated import StatementError, read_statement
from loopsheet.report.messages.errors import InputError, render
from loopsheet.report.which_workbook import find_workbook

MM = parse_unit("mm")


def errors(text: str, number: str = "12.50") -> tuple[tuple[float, Shape, float], ...]:
    """The standard uncertainties in mm that are stated of a number in mm, their shapes, their dof."""
    found = read_statement(text, MM).of(read_printed(number, MM))
    return tuple((error.u * 1000, error.shape, error.dof) for error in found)


@pytest.mark.parametrize(
    ("text", "u", "shape", "dof"),
    [
        ("u = 0.02", 0.02, Shape.NORMAL, math.inf),
        ("u = 20 um", 0.02, Shape.NORMAL, math.inf),
        ("u=2e-2 mm, dof=7", 0.02, Shape.STUDENT, 7),
        ("U = 0.03, k = 2", 0.015, Shape.NORMAL, math.inf),
        ("U = 0.075 um, k = 3, dof = 18", 25e-6, Shape.STUDENT, 18),
        ("U = 0.0196, p = 95 %", 0.0196 / 1.959963984540054, Shape.NORMAL, math.inf),
        ("U = 0.02, p = 0.9545", 0.01, Shape.NORMAL, math.inf),
        ("+-0.1 rect", 0.1 / 3**0.5, Shape.RECTANGULAR, math.inf),
        ("± 0.1 mm tri", 0.1 / 6**0.5, Shape.TRIANGULAR, math.inf),
        ("+/- 100 um arcsine", 0.1 / 2**0.5, Shape.ARCSINE, math.inf),
        ("+-0.1 uniform, dof = 50", 0.1 / 3**0.5, Shape.RECTANGULAR, 50),
        ("+-0.1 normal, k = 2", 0.05, Shape.NORMAL, math.inf),
        ("0.5 % of reading + 2 digits", (0.0625 + 0.02) / 3**0.5, Shape.RECTANGULAR, math.inf),
        ("0.5% + 10 um tri", (0.0625 + 0.01) / 6**0.5, Shape.TRIANGULAR, math.inf),
        ("u = 1 % of reading", 0.125, Shape.NORMAL, math.inf),
        ("u = 20 ppm", 0.00025, Shape.NORMAL, math.inf),
        ("20 ppm of reading rect", 0.00025 / 3**0.5, Shape.RECTANGULAR, math.inf),
        ("s = 0.03, n = 9", 0.01, Shape.STUDENT, 8),
        ("s = 0.02, n = 2", 0.02 / 2**0.5, Shape.STUDENT, 1),
        ("s = 0.02, n = 4, dof = 24", 0.01, Shape.STUDENT, 24),
        ("t scale = 0.01, dof = 4", 0.01, Shape.STUDENT, 4),
        ("t sd = 0.02, dof = 4", 0.02 / 2**0.5, Shape.STUDENT, 4),
    ],
)
def test_what_is_understood(text: str, u: float, shape: Shape, dof: float) -> None:
    ((found, own, freedom),) = errors(text)
    assert (found, own, freedom) == (pytest.approx(u, rel=2e-4 if "0.9545" in text else 1e-12), shape, dof)


def test_a_share_of_the_reading_follows_the_value() -> None:
    statement = read_statement("1 % of reading", MM)
    sizes = [statement.of(read_printed(text, MM))[0].width for text in ("10.0", "-20.0", "0.0")]
    assert sizes == [Fraction(1, 10_000), Fraction(2, 10_000), 0]


def test_errors_stand_one_after_another_and_none_is_exact() -> None:
    assert [u for u, _, _ in errors("u = 0.3; +-0.4 normal, k = 1")] == pytest.approx([0.3, 0.4])
    assert errors("exact") == ()


def test_bare_limits_mean_what_was_said_once_for_all() -> None:
    assert read_statement("+-0.1", MM, Shape.TRIANGULAR).parts[0].shape is Shape.TRIANGULAR
    with pytest.raises(StatementError) as refused:
        read_statement("+-0.1", MM)
    assert refused.value.code == "LS432"


@pytest.mark.parametrize(
    ("text", "culprit", "start"),
    [
        ("0.1", "0.1", 0),
        ("U = 0.03", "U = 0.03", 0),
        ("U = 0.03, k = 2, p = 95 %", "U = 0.03", 0),
        ("U = 0.03, p = 95 %, dof = 5", "U = 0.03", 0),
        ("k = 2", "k = 2", 0),
        ("u = 1 s", "s", 6),
        ("u = 1 mmm", "mmm", 6),
        ("u = -1", "-1", 4),
        ("u = 1,5", "5", 6),
        ("u = ", "", 3),
        ("u = 0.1, k = 2", "k = 2", 9),
        ("U = 0.1, k = 2, k = 3", "k = 3", 16),
        ("u = 1e61", "1e61", 4),
        ("u = 0.1; u = x", "x", 13),
        ("+-0.1 normal", "+-0.1 normal", 0),
        ("+-0.1 rect, k = 2", "+-0.1 rect", 0),
        ("+-0.1 rct", "rct", 6),
        ("s = 0.1", "s = 0.1", 0),
        ("s = 0.1, n = 1", "n = 1", 9),
        ("s = 0.1, n = 2.5", "n = 2.5", 9),
        ("t sd = 0.1, dof = 2", "t sd = 0.1", 0),
        ("t scale = 0.1", "t scale = 0.1", 0),
        ("u = 0.1, dof = 0.5", "dof = 0.5", 9),
        ("U = 0.1, p = 100 %", "p = 100 %", 9),
        ("u = 1e999", "1e999", 4),
        ("", "", 0),
    ],
)
def test_what_is_refused_and_where(text: str, culprit: str, start: int) -> None:
    with pytest.raises(StatementError) as refused:
        read_statement(text, MM)
    found = refused.value
    assert (found.code, found.text, found.start) == ("LS431", culprit, start)


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("3 % of reading, normal", "if it is a standard uncertainty, write u = 3 % of reading; else a shape"),
        ("+-0.1 mm, normal, k = 1", "if it is a standard uncertainty, write u = 0.1 mm; else a shape"),
        ("+-0.1, rect", "a shape stands behind the size, without a comma: +-0.1 rect"),
    ],
)
def test_a_shape_behind_a_comma_is_told_where_it_stands(text: str, hint: str) -> None:
    with pytest.raises(StatementError) as refused:
        read_statement(text, MM)
    assert refused.value.text == text.split(", ")[1]
    assert refused.value.suggestion.startswith(hint)


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("+-0.1 normal", "say the coverage factor, once: +-0.1 normal, k = 2"),
        (
            "U = 0.2, p = 95 %, dof = 8",
            "with degrees of freedom, say k itself: Student's t, 2.306 for 8 and 95 %",
        ),
        ("u = 34,8 mm", "a decimal comma? write u = 34.8 mm"),
        ("u = sqrt(x)", "what follows another formula than a share of the reading stands beside it"),
    ],
)
def test_what_was_meant_is_guessed(text: str, hint: str) -> None:
    with pytest.raises(StatementError, match="LS431") as refused:
        read_statement(text, MM)
    assert refused.value.suggestion.startswith(hint)


@pytest.mark.parametrize("text", ["u = 6 mm/(L*s)", "U = 12 mm/(L s), k = 2", "+-12 mm/(L*s) normal, k = 2"])
def test_a_unit_may_have_parentheses(text: str) -> None:
    (own,) = read_statement(text, parse_unit("m/(L*s)")).of(read_printed("0.1", parse_unit("m/(L*s)")))
    assert own.u == pytest.approx(6)  # in 1/(m^2 s)


def test_percent_of_a_pure_number_is_not_guessed() -> None:
    for unit, size in (("%", "0.5"), ("percent", "0.5"), ("1", "0.005"), ("ppm", "5000")):
        of = parse_unit(unit)
        for text in ("u = 0.5 %", "u = 0.5 percent"):
            with pytest.raises(StatementError, match="LS431") as refused:
                read_statement(text, of)
            hint = f"say '0.5 % of reading', or '{size}' for that much in its unit {unit}"
            assert refused.value.suggestion == hint
        assert read_statement(f"u = {size}", of).parts[0].absolute == Fraction(1, 200)
    assert read_statement("u = 0.5 percent", MM).parts[0].relative == Fraction(1, 200)
    part = read_statement("u = 0.5 % of reading", parse_unit("%")).parts[0]
    assert (part.relative, part.absolute) == (Fraction(1, 200), 0)


@given(st.text("uUkpsnt =.,;+-±%01 mreadingofdct", max_size=30))
def test_any_text_is_understood_or_refused_within_it(text: str) -> None:
    def understood() -> None:
        found = read_statement(text, MM)
        assert all(error.width >= 0 for error in found.of(read_printed("12.50", MM)))

    with suppress(StatementError):
        understood()
        return
    with pytest.raises(StatementError) as refused:
        read_statement(text, MM)
    start, culprit = refused.value.start, refused.value.text
    assert text[start : start + len(culprit)] == culprit


# --- in a folder ------------------------------------------------------------------------------------------

TOML = """\
workbook = "soft_impact"
[parameters]
ball_mass = "{mass}"
[measurements]
file = "measurements.csv"
[uncertainty]
{section}
"""
CSV = "test,v [m/s],e [1],x_p [um]\n1,2.334,0.530,23.5\n2,2.940,0.512,29.7\n3,4.089,0.479,41.6(2)\n"
Read = Callable[..., Inputs]


@pytest.fixture
def read(tmp_path: Path) -> Read:
    """Read a folder whose mass, section and table are given."""

    def read(section: str = "", mass: str = "8.366 g", csv: str = CSV) -> Inputs:
        (tmp_path / "report.toml").write_text(TOML.format(mass=mass, section=section), encoding="utf-8")
        (tmp_path / "measurements.csv").write_text(csv, encoding="utf-8")
        return load(tmp_path, find_workbook)

    return read


@pytest.mark.parametrize(
    ("mass", "u"),
    [
        ("8.366(4) g", 4e-6),
        ("8.366 g, U = 6 mg, k = 2", 3e-6),
        ("8.366 +-0.006 g normal, k = 2", 3e-6),
        ("8.366 g ±0.003 rect", 3e-6 / 3**0.5),
        ("8.366 g; exact", 0),
        ("8.366+-0.006 g rect", 6e-6 / 3**0.5),
        ("8.366 g", 5e-7 / 3**0.5),
    ],
)
def test_a_parameter_says_it_behind_its_number(read: Read, mass: str, u: float) -> None:
    found = read(mass=mass).parameters["ball_mass"]
    assert (found.u, found.text, found.unit) == (pytest.approx(u, rel=1e-12), "8.366", "g")


def test_a_cell_says_it_in_parentheses_and_a_column_in_the_section(read: Read) -> None:
    inputs = read('v = "u = 5 mm/s"\nball_mass = "0.1 % of reading"')
    assert [number.u for number in inputs.measured["v"]] == [0.005] * 3
    assert inputs.parameters["ball_mass"].u == pytest.approx(8.366e-6 / 3**0.5)
    *digits, stated = inputs.measured["x_p"]
    assert [number.stated for number in digits] == [None, None]
    assert (stated.text, stated.u) == ("41.6", pytest.approx(2e-7))


@pytest.mark.parametrize(
    "said", ["1.5, u = 0.1", "1.5; u = 0.1", "1.5 , u = 0.1", "1.5(1)", "1.5+-0.1 normal, k = 1"]
)
def test_a_pure_number_needs_no_unit_in_between(read: Read, said: str) -> None:
    inputs = read(mass=f'8 g"\nbeta = "{said}')
    assert (inputs.parameters["beta"].text, inputs.parameters["beta"].u) == ("1.5", pytest.approx(0.1))


def test_a_number_that_the_method_counts_with_has_no_uncertainty(read: Read) -> None:
    with pytest.raises(InputError) as refused:
        read(mass='8 g"\npoints_per_pair = "50(2)')
    assert [found.code for found in refused.value.diagnostics] == ["LS431"]


@pytest.mark.parametrize("cell", ["41.6 +- 0.1", "41.6(1.5)", "41.6(2)e0"])
def test_what_a_cell_cannot_say_is_told_where_it_can(read: Read, cell: str) -> None:
    with pytest.raises(InputError) as refused:
        read(csv=CSV.replace("41.6(2)", cell))
    (found,) = refused.value.diagnostics
    assert (found.code, "41.6(2)" in render(found)) == ("LS401", True)


def test_a_decimal_comma_is_still_told(read: Read) -> None:
    with pytest.raises(InputError) as refused:
        read(mass="8,366 g, exact")
    assert [found.code for found in refused.value.diagnostics] == ["LS402"]


def test_what_bare_limits_mean_holds_for_parameters_too(read: Read) -> None:
    inputs = read('plus_minus = "tri"\nv = "+-0.1"', mass="8.366 +-0.006 g")
    assert inputs.parameters["ball_mass"].u == pytest.approx(6e-6 / 6**0.5)
    assert inputs.measured["v"][0].u == pytest.approx(0.1 / 6**0.5)


def test_what_is_shared(read: Read) -> None:
    section = (
        '[uncertainty.shared."height datum"]\nof = "v"\nstated = "+-0.01 rect"\ngroups = [[1, 3], [2]]\n'
    )
    (shared,) = read(section).uncertainty.shared
    assert (shared.name, [*shared.statements], shared.groups) == ("height datum", ["v"], ((1, 3), (2,)))
    (shared,) = read(
        section.replace('"v"', '["v", "e"]').replace("+-0.01 rect", "1 % of reading rect")
    ).uncertainty.shared
    assert [*shared.statements] == ["v", "e"]


@pytest.mark.parametrize(
    ("section", "code", "culprit"),
    [
        ('w = "exact"', "LS203", "w"),
        ('v = "+-1"', "LS432", "+-1"),
        ('v = "u = 1 s"', "LS431", "s"),
        ('v = "u = 1 m/s, k = 2"', "LS431", "k = 2"),
        ("v = 0.1", "LS205", "0.1"),
        ('x_p = "u = 1 um"', "LS433", "x_p"),
        ('points_per_pair = "u = 1"', "LS431", '"u = 1"'),
        ('plus_minus = "rectt"', "LS217", '"rectt"'),
        *((f"digits = {wrong}", "LS435", wrong) for wrong in ("0", "3", "-1", "true", "2.0", '"2"', "[1]")),
        ("shared = 3", "LS205", "3"),
        ('[uncertainty.shared.a]\nof = "w"\nstated = "u = 1"', "LS505", '"w"'),
        ('[uncertainty.shared.a]\nof = ["v", "w"]\nstated = "u = 1 %"', "LS505", '["v", "w"]'),
        ('[uncertainty.shared.a]\nof = ["v", 3]\nstated = "u = 1 %"', "LS205", '["v", 3]'),
        ('[uncertainty.shared.a]\nof = []\nstated = "u = 1 %"', "LS205", "[]"),
        ('[uncertainty.shared.a]\nof = ["v", "e"]\nstated = "u = 1 m/s"', "LS431", "m/s"),
        ('[uncertainty.shared.a]\nof = "v"', "LS204", "uncertainty.shared.a"),
        ('[uncertainty.shared.a]\nof = "v"\nstated = "exact"', "LS431", '"exact"'),
        ('[uncertainty.shared.a]\nof = "v"\nstated = "u = 1"\ngroups = [[1], [1]]', "LS433", "[[1], [1]]"),
        ('[uncertainty.shared.a]\nof = "v"\nstated = "u = 1"\ngroups = [1]', "LS205", "[1]"),
        ('[uncertainty.shared.a]\nof = "v"\nstated = "u = 1"\ngroups = [[]]', "LS205", "[[]]"),
        ('[uncertainty.shared.a]\nof = "v"\nstated = "u = 1"\ngroups = []', "LS205", "[]"),
        ('[uncertainty.shared.a]\nof = "v"\nstated = "u = 1"\ngroups = "batch"', "LS303", '"batch"'),
        (
            '[uncertainty.shared.a]\nof = "ball_mass"\nstated = "u = 1 g"\ngroups = [[1]]',
            "LS506",
            "groups",
        ),
        ('[uncertainty.correlation]\n"v, w" = "0.1"', "LS505", '"v, w"'),
        ('[uncertainty.correlation]\n"v, v" = "0.1"', "LS434", '"v, v"'),
        ('[uncertainty.correlation]\n"v, e" = "1.1"', "LS434", '"1.1"'),
        ('[uncertainty.correlation]\n"v, e" = "0.9"\n"e, v" = "0.3"', "LS433", '"e, v"'),
        ('[uncertainty.correlation]\n"v, ball_mass" = "0.1"', "LS434", '"0.1"'),
        ('e = "u = 1; u = 2"\n[uncertainty.correlation]\n"v, e" = "0.1"', "LS434", '"0.1"'),
        ('[uncertainty.correlation]\n"beta, ball_mass" = "0.1"', "LS434", '"0.1"'),
        (
            '[uncertainty.correlation]\n"v, e" = "0.9"\n"e, x_p" = "0.9"\n"v, x_p" = "-0.9"',
            "LS434",
            "uncertainty.correlation",
        ),
    ],
)
def test_what_is_wrong_is_told_where_it_stands(read: Read, section: str, code: str, culprit: str) -> None:
    with pytest.raises(InputError) as refused:
        read(section, mass='8.366 g"\nbeta = "1.5, u = 0.1; +-0.1 rect')
    (found,) = refused.value.diagnostics
    at = found.at
    assert found.code == code
    assert (at.source or "")[(at.column or 1) - 1 :][: at.length] == culprit


def correlated(folder: Path, names: str, error: str, **pairs: str) -> Inputs:
    """Read a folder with some numbers, each with that error, and coefficients of pairs: ``ab="0.9"``."""
    lines = "".join(f'    {name} = given("1", "{name}")\n' for name in names)
    code = f"from loopsheet import Method, given, let\nclass Several(Method):\n{lines}"
    more = "[parameters]\n" + "".join(f'{n} = "1.0{error}"\n' for n in names)
    more += "[uncertainty.correlation]\n"
    more += "".join(f'"{one}, {other}" = "{r}"\n' for (one, other), r in pairs.items())
    return load(method_folder(folder, f'{code}    y = let(a, "y")\n', more=more), find_workbook)


def test_of_correlations_those_that_clash_are_named(tmp_path: Path) -> None:
    """The correlation of d with another clashes with none."""
    with pytest.raises(InputError, match="these correlations of a, b and c cannot hold together"):
        correlated(tmp_path, "abcd", "", ab="0.9", bc="0.9", ac="-0.9", ad="0.1")


def test_correlations_that_just_hold_together_do(tmp_path: Path) -> None:
    """What is correlated with each of two as far as it can be: 0.6^2 + 0.8^2 is 1, and of doubles more."""
    found = correlated(tmp_path, "abc", ", u = 0.1", ab="0.6", ac="0.8").uncertainty.correlations
    assert found == {("a", "b"): 0.6, ("a", "c"): 0.8}
    with pytest.raises(InputError, match="cannot hold together"):
        correlated(tmp_path, "abc", ", u = 0.1", ab="0.6", ac="0.8001")


@pytest.mark.parametrize("share", ["99.99999999999999999 %", "0.00000000000000000001"])
def test_a_coverage_probability_that_is_none(read: Read, share: str) -> None:
    with pytest.raises(InputError, match="LS431"):
        read(f'v = "U = 0.1, p = {share}"\n')


def test_a_column_of_uncertainties_and_parentheses_are_one_too_many(read: Read) -> None:
    csv = "test,v [m/s],e [1],x_p [um],u(x_p) [um]\n1,2.334,0.530,23.5,0.1\n2,2.940,0.512,29.7(2),0\n"
    with pytest.raises(InputError) as refused:
        read(csv=csv)
    assert [found.code for found in refused.value.diagnostics] == ["LS433"]
    inputs = read(csv=csv.replace("(2)", ""))
    assert [number.u for number in inputs.measured["x_p"]] == [pytest.approx(1e-7), 0]


def test_percent_beside_a_pure_number_in_another_unit_is_refused(read: Read) -> None:
    csv = "test,v [m/s],e [1],u(e) [%],x_p [um]\n1,2.334,0.530,2,23.5\n2,2.940,0.512,2,29.7\n"
    with pytest.raises(InputError) as refused:
        read(csv=csv)
    (found,) = refused.value.diagnostics
    assert (found.code, found.at.line, found.at.column) == ("LS431", 1, 20)
    assert 'write each in the unit of its number, u(e) [1]; or of all of them [uncertainty] e = "u = 2 %' in (
        render(found)
    )
    shares = csv.replace("e [1]", "e [%]").replace("0.530", "53.0").replace("0.512", "51.2")
    assert [number.u for number in read(csv=shares).measured["e"]] == [pytest.approx(0.02)] * 2
