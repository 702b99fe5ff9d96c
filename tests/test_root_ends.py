"""The ends between which a method declares a root: their unit, and what lies at them."""

from pathlib import Path

import mpmath
import pytest
from helpers import method_folder

import loopsheet
from loopsheet.report.messages.errors import InputError
from loopsheet.report.study import Study


@pytest.mark.parametrize(
    ("equation", "low", "code", "says"),
    [
        ("x**2, a", "1", "#NOROOT!", "no value between 1 and 4, these ends left out, satisfies the equation"),
        ("x**3 - 6*x**2 + 11*x, 6*a", "1", "#UNDECIDED!", "near x = 1 to "),
        ("x**2, a", "5*a", "#DOMAIN!", "4 is not above 5*a, where x ends"),
    ],
)
def test_a_root_at_an_end_is_none(tmp_path: Path, equation: str, low: str, code: str, says: str) -> None:
    body = f"""
    a = given("1", "a")
    x = unknown()
    x = root({equation}, "x", low={low}, high=4)
"""
    head = "from loopsheet import Method, given, root, unknown\nclass R(Method):\n    'A root.'\n"
    folder = method_folder(tmp_path, head + body, more='[parameters]\na = "1.0"\n')
    cell = Study(folder).computed.values.cell("x")
    assert (cell.value, cell.status.code) == (None, code)
    assert says in cell.why


@pytest.mark.parametrize(("unit", "size"), [("1/s", 1.0), ("1/min", 1 / 60), ("%", 0.01)])
def test_a_number_beside_a_formula_has_the_unit_of_the_root(tmp_path: Path, unit: str, size: float) -> None:
    """One end is a number in the unit that is declared, the other a formula, which is in SI."""
    of = "1" if unit == "%" else "s"
    code = (
        "from loopsheet import Method, given, root, unknown\nclass R(Method):\n    'A root.'\n"
        f'    a = given("{of}", "scale")\n'
        f'    x = unknown()\n    x = root((x * a) ** 2, 0.04, "x", "{unit}", low=2, high=1 / a)\n'
    )
    written = "2" if unit == "%" else "2 s"
    folder = method_folder(tmp_path, code, more=f'[parameters]\na = "{written}"\n')
    cell = Study(folder).computed.values.cell("x")
    if size == 1:  # 2/s is above 0.5/s
        assert cell.value is None
        assert "is not above" in cell.why
    else:
        assert cell.value == pytest.approx(0.1, rel=1e-15)


def test_the_ends_of_a_root_have_its_unit(tmp_path: Path) -> None:
    """Dispersion of water waves; numbers are in the unit that the root is declared in."""
    code = (
        "from sympy import pi, tanh\n"
        "from loopsheet import Method, given, root, unknown\n"
        "class Waves(Method):\n"
        "    'Waves.'\n"
        "    T = given('ms', 'period', default='8000 ms')\n"
        "    h = given('cm', 'depth', default='1000 cm')\n"
        "    g = given('m/s^2', 'free fall', default='9.81 m/s^2')\n"
        "    q = unknown()\n"
        "    w = (2 * pi / T) ** 2\n"
        "    q = root(g * q * tanh(q * h), w, 'wave number', 'cm^-1', low=1e-5, high=1)\n"
    )
    wanted = mpmath.findroot(lambda q: 9.81 * q * mpmath.tanh(10 * q) - (mpmath.pi / 4) ** 2, 0.09)
    found = loopsheet.load(method_folder(tmp_path, code))["q"]
    assert found.unit == "cm^-1"
    assert float(found.value) == pytest.approx(float(wanted) / 100, rel=1e-14)


def test_a_number_that_would_take_the_name_of_something_else_is_told(tmp_path: Path) -> None:
    code = (
        "from loopsheet import Method, given, let, root, unknown\nclass R(Method):\n    'A root.'\n"
        '    a = given("s", "scale", default="2 s")\n'
        '    x_low = let(a / 2, "half of it", "s")\n'
        '    x = unknown()\n    x = root(x**2, a**2, "x", "s", low=1, high=5 * a)\n'
    )
    with pytest.raises(InputError) as told:
        assert Study(method_folder(tmp_path, code)).computed
    assert "x_low is declared twice: of the ends, the number 1 is a parameter of that name" in str(told.value)
