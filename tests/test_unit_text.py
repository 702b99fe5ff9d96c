"""Units as text: exact, equal to pint's, and never evaluated."""

import subprocess
import sys
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from loopsheet.derivations import unit_text
from loopsheet.derivations.unit_text import COMMON, UnitError, coherent, examples, parse_open, parse_unit

SI = {
    "meter": "m",
    "kilogram": "kg",
    "second": "s",
    "kelvin": "K",
    "ampere": "A",
    "mole": "mol",
    "candela": "cd",
}


@cache
def registry() -> Any:
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)


def by_pint(text: str) -> tuple[Fraction, tuple[tuple[str, int], ...]]:
    """Return what pint's own parser makes of a unit; an angle is a pure number."""
    quantity = registry().Quantity(Fraction(1), registry().parse_units(text)).to_base_units()
    powers = ((SI[name], int(power)) for name, power in quantity.unit_items() if name != "radian")
    return Fraction(quantity.magnitude), tuple(sorted(powers))


@pytest.mark.parametrize("name", COMMON)
def test_every_common_unit_is_what_pint_says(name: str) -> None:
    assert COMMON[name] == by_pint(name)
    assert isinstance(COMMON[name][0], Fraction)


@pytest.mark.parametrize(
    ("text", "scale", "dimension"),
    [
        ("um", "1/1000000", (("m", 1),)),
        ("µm", "1/1000000", (("m", 1),)),
        ("μm", "1/1000000", (("m", 1),)),
        ("inch", "0.0254", (("m", 1),)),
        ("thou", "0.0000254", (("m", 1),)),
        ("angstrom", "1e-10", (("m", 1),)),
        ("lb", "0.45359237", (("kg", 1),)),
        ("mph", "0.44704", (("m", 1), ("s", -1))),
        ("lbf", "4.4482216152605", (("kg", 1), ("m", 1), ("s", -2))),
        ("1", "1", ()),
        ("", "1", ()),
        ("-", "1", ()),
        ("–", "1", ()),
        ("%", "0.01", ()),
        ("percent", "0.01", ()),
        ("m/sec", "1", (("m", 1), ("s", -1))),
        ("m/s^2", "1", (("m", 1), ("s", -2))),
        ("m·s⁻¹", "1", (("m", 1), ("s", -1))),
        ("m s⁻²", "1", (("m", 1), ("s", -2))),
        ("m*s**-2", "1", (("m", 1), ("s", -2))),
        ("m s^(-2)", "1", (("m", 1), ("s", -2))),
        (" km / h ", "5/18", (("m", 1), ("s", -1))),
        ("kg/m^3", "1", (("kg", 1), ("m", -3))),
        ("g/cm³", "1000", (("kg", 1), ("m", -3))),
        ("kg/m/s", "1", (("kg", 1), ("m", -1), ("s", -1))),
        ("J/(kg K)", "1", (("K", -1), ("m", 2), ("s", -2))),
        ("(mm)^2", "1e-6", (("m", 2),)),
        ("1/s", "1", (("s", -1),)),
        ("m/m", "1", ()),
        ("N/mm", "1000", (("kg", 1), ("s", -2))),
        ("deg", None, ()),
        ("rad", "1", ()),
        ("mrad/s", "0.001", (("s", -1),)),
        ("N/m^(3/2)", "1", (("kg", 1), ("m", Fraction(-1, 2)), ("s", -2))),
        ("N m^-1.5", "1", (("kg", 1), ("m", Fraction(-1, 2)), ("s", -2))),
        ("MPa*m^0.5", "1e6", (("kg", 1), ("m", Fraction(-1, 2)), ("s", -2))),
        ("MPa m**(1 / 2)", "1e6", (("kg", 1), ("m", Fraction(-1, 2)), ("s", -2))),
        ("MPa·m^(0.5)", "1e6", (("kg", 1), ("m", Fraction(-1, 2)), ("s", -2))),
        ("MPa^0.5", "1000", (("kg", Fraction(1, 2)), ("m", Fraction(-1, 2)), ("s", -1))),
        ("mm^(1/3)", "0.1", (("m", Fraction(1, 3)),)),
        ("(m^0.5)^2", "1", (("m", 1),)),
        ("ppm", "1e-6", ()),
        ("Bq", "1", (("s", -1),)),
        ("kBq/kg", "1000", (("kg", -1), ("s", -1))),
        ("Ci", "3.7e10", (("s", -1),)),
        ("delta_degC", "1", (("K", 1),)),
    ],
)
def test_units_are_exact(text: str, scale: str | None, dimension: tuple[tuple[str, int], ...]) -> None:
    unit = parse_unit(text)
    assert unit.text == text
    assert isinstance(unit.scale, Fraction)
    assert scale is None or unit.scale == Fraction(scale)
    assert unit.dimension == dimension


@pytest.mark.parametrize("text", ["mm^1.5", "N/mm^(3/2)", "MPa*mm^0.5", "km^-0.25", "inch^(2/3)", "deg^0.5"])
def test_a_size_that_is_no_fraction_is_one_to_sixty_digits(text: str) -> None:
    unit = parse_unit(text)
    size = registry().Quantity(1.0, registry().parse_units(text.replace("^", "**"))).to_base_units().magnitude
    assert float(unit.scale) == pytest.approx(float(size), rel=1e-14)
    square = parse_unit(f"({text})^12")
    name, _, power = text.rpartition("^")
    assert float(unit.scale**12 / square.scale - 1) == pytest.approx(0, abs=1e-50)
    if name.isalpha():
        whole = Fraction(power.strip("()")) * 12
        assert float(square.scale / parse_unit(name).scale ** int(whole) - 1) == pytest.approx(0, abs=1e-50)


def test_a_size_may_hang_on_a_cell() -> None:
    unit = parse_open("N/m^alpha")
    assert (unit.dimension, unit.open) == ((("kg", 1), ("m", 1), ("s", -2)), (("m", "alpha", -1),))
    with pytest.raises(UnitError, match="LS424"):
        parse_unit("N/m^alpha")
    with pytest.raises(UnitError, match="LS424"):
        parse_open("N/mm^alpha")  # of which nobody knows how large it is
    with pytest.raises(UnitError, match="LS421"):
        parse_open("N/mist^alpha")


@pytest.mark.parametrize(
    ("text", "si"),
    [
        *[("mm", "m"), ("GPa", "Pa"), ("deg", "1"), ("rad", "1"), ("%", "1"), ("-", "-"), ("um", "m")],
        *[("kN/mm^(3/2)", "kg*m^(-1/2)*s^-2"), ("N/m^(3/2)", "N/m^(3/2)"), ("cm^2/h", "m^2*s^-1")],
        *[("J/(kg K)", "J/(kg K)"), ("inch", "m"), ("m/m", "1"), ("N/m^alpha", "N/m^alpha")],
    ],
)
def test_every_unit_is_a_multiple_of_one_of_si(text: str, si: str) -> None:
    assert coherent(parse_open(text)) == si
    assert parse_open(si).scale == 1
    assert parse_open(si).dimension == parse_open(text).dimension


NAMES = st.sampled_from(
    [name for name in COMMON if name not in "%°"] + ["inch", "lbf", "mile", "hour", "degree"]
)


@given(st.lists(st.tuples(NAMES, st.integers(-4, 4), st.sampled_from("*/")), min_size=1, max_size=4))
def test_products_and_quotients_are_what_pint_says(parts: list[tuple[str, int, str]]) -> None:
    text = "".join(
        f"{sign if n else ''}{name}^{power}" for n, (name, power, sign) in enumerate(parts) if power
    )
    text = text.lstrip("*/")
    assume(text)
    unit = parse_unit(text)
    assert (unit.scale, unit.dimension) == by_pint(text.replace("^", "**"))


REFUSED = {
    "LS421": ["furlog", "kPas", "__import__", "None", "import", "Um", "mmm", "nan", "inf", "ｍ", "eval"],
    "LS423": ["degC*m", "1/°C", "degF^2", "dB", "dBm", "neper", "degC/m"],
    "LS424": [
        "m^1e9", "9**9**9", "m**9**9", "m^99999999", "m^61", "m^0",
        "m^(1/0)", "m^(0/3)", "m^(1/13)", "m^.5", "m^3/2", "m^(3/2", "m^alpha", "m^1.23456789",
        "m2", "m3/s", "2 m", "10^-6 m",
        "1.5", "(", ")", "((((m", "m)", "m/", "/m", "*", "m//s", "m^", "os.system('x')", "m;s", "m\ns", "m@s",
        "`m`", "{m}", "m s" * 40, "(" * 59, "m^" * 29, "m^-", "m^(2", "__import__('os')", "m=s", "m'",
        'm"', "m\\s", "\x00",
    ],
    "LS425": ["J/kg K", "m/s s"],
}  # fmt: skip


@pytest.mark.parametrize(
    ("code", "text"), [(code, text) for code, texts in REFUSED.items() for text in texts]
)
def test_anything_else_is_refused_with_its_reason(code: str, text: str) -> None:
    with pytest.raises(UnitError) as caught:
        parse_unit(text)
    error = caught.value
    assert error.code == code
    assert text[error.start : error.start + len(error.text)] == error.text


def test_ten_kilobytes_of_units_are_not_read() -> None:
    with pytest.raises(UnitError):
        parse_unit("m*" * 5000 + "m")


def outcome(text: str) -> str:
    """Say what became of a text."""
    try:
        return "a unit" if parse_unit(text).scale > 0 else "no size"
    except UnitError as error:
        return error.code


@given(st.text(max_size=70))
def test_any_text_is_a_unit_or_refused(text: str) -> None:
    assert outcome(text) in {"a unit", *REFUSED}


@given(st.text(alphabet="mskgN/*^()123-+·⁻² %µ_.", max_size=60))
def test_any_text_that_looks_like_a_unit_is_one_or_refused(text: str) -> None:
    assert outcome(text) in {"a unit", *REFUSED}


def test_pint_is_shown_single_words_only(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[str] = []
    real = unit_text._from_pint
    monkeypatch.setattr(unit_text, "_from_pint", lambda name: seen.append(name) or real(name))
    for text in ["lbf/inch^2", "furlong*(m)", "__import__('os')", "9**9", "eval(x)", "a.b.c"]:
        try:
            parse_unit.__wrapped__(text)
        except UnitError:
            continue
    assert seen
    assert all(word.replace("_", "a").isalpha() for word in seen)


def test_a_misspelt_unit_gets_a_suggestion() -> None:
    with pytest.raises(UnitError) as caught:
        parse_unit("Um")
    assert caught.value.suggestion == "did you mean 'um'?"
    with pytest.raises(UnitError) as caught:
        parse_unit("kg/m3")
    assert caught.value.suggestion == "write a power as kg/m^3"
    with pytest.raises(UnitError) as caught:
        parse_unit("N/m^3/2")
    assert caught.value.suggestion == "write a fraction as ^(3/2)"
    with pytest.raises(UnitError) as caught:
        parse_unit("furlog")
    assert caught.value.suggestion == "did you mean 'furlong'?"


def test_examples_name_units_of_the_same_dimension() -> None:
    assert examples(parse_unit("m")) == "a unit that converts to m: m, km, cm, mm, um ..."
    assert examples(parse_unit("m/s")) == "a unit that converts to m/s"
    assert examples(parse_unit("1")) == "1 for a pure number, or percent"


def test_common_units_do_without_pint() -> None:
    """Half a second of a cold build; a fresh interpreter tells."""
    code = (
        "import sys; from loopsheet.report.inputs import inputs\n"
        "from loopsheet.derivations.unit_text import parse_unit\n"
        "for text in ('um', 'kg/m^3', 'm·s⁻²', '%', 'N/(m*s)', 'm^1.5', 'deg', 'kV'): parse_unit(text)\n"
        "print(sorted({'pint', 'numpy', 'sympy', 'difflib'} & sys.modules.keys()))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, encoding="utf-8"
    )
    assert done.stdout.strip() == "[]"
