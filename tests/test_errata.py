"""Each check of the print is seen to find its slip, and to find nothing where the print is right."""

import re
from dataclasses import replace

import mpmath
import pytest
from sympy import And, Le, Lt, Piecewise, Rational, Symbol

from loopsheet.derivations import soft_impact as model
from loopsheet.derivations.equation import Equation, Erratum, Kind, Ledger
from loopsheet.derivations.errata import (
    Check,
    Citation,
    check_citation,
    check_count,
    check_determined,
    check_missing,
    check_overlap,
    check_range,
    check_spurious,
    check_units,
    check_whose,
)
from loopsheet.derivations.soft_impact import CP, LEDGER, XM, XP, C, Cprime, E, alpha, beta
from loopsheet.derivations.symbols import VOCABULARY, F_of, k

x, x_m, x_p, n = (VOCABULARY[name].symbol for name in ("x", "x_m", "x_p", "n"))
MARGIN = alpha + 1 - (beta + 1) * E[2] ** 2


def law(*branches: tuple[object, object]) -> Equation:
    return Equation("(3)", (F_of(x), Piecewise(*branches, evaluate=False)), "", Kind.ASSUMPTION)


APART = law((C * x**alpha, And(Le(0, x), Lt(x, x_p))), (Cprime * x / x_m, And(Le(x_p, x), Le(x, x_m))))
ALIKE = law(
    (C * x**alpha, And(Le(0, x), Le(x, x_m))), (C * x ** (alpha + 1) / x, And(Le(x_p, x), Le(x, x_m)))
)
SYSTEM = (model.eq10a, model.eq10b, model.eq10c)
UNKNOWNS = (C, XM[1], XM[2], CP[1], CP[2])
KNOWN = ("Tabor's range", 2, Rational(5, 2))

CORRECTED = Ledger(
    tuple(
        replace(entry, steps=(replace(entry.steps[0], claim=replace(model.eq12e, printed=None)),))
        if entry is LEDGER.derivation(model.eq12e)
        else entry
        for entry in LEDGER.entries
    )
)


@pytest.mark.parametrize(
    ("kind", "finds", "passes"),
    [
        ("overlap", check_overlap(model.eq2), check_overlap(APART)),
        ("overlap", check_overlap(model.eq3), check_overlap(ALIKE)),
        ("range", check_range(model.eq4, 2, n, KNOWN), check_range(model.eq4, 2, n, ("Meyer's", 2, 3))),
        (
            "count",
            check_count(SYSTEM, (C, alpha, XM[k], CP[k]), (3 * k, 2 * k + 3)),
            check_count(SYSTEM, (C, alpha, XM[k], CP[k]), (3 * k, 2 * k + 2)),
        ),
        (
            "count",
            check_count(SYSTEM[:2], (C, alpha, XM[k], CP[k]), (3 * k, 2 * k + 2)),
            check_count(SYSTEM[:2], (C, alpha, XM[k], CP[k]), (2 * k, 2 * k + 2)),
        ),
        (
            "condition",
            check_spurious(model.eq11, XP[1], model.eq12a, MARGIN),
            check_spurious(replace(model.eq11, conditions=(MARGIN > 0,)), XP[1], model.eq12a, MARGIN),
        ),
        ("determined", check_determined("(12)", UNKNOWNS), check_determined("(12)", UNKNOWNS[:-1])),
        (
            "citation",
            check_citation(Citation("Table 3", "(6)", Cprime)),
            check_citation(Citation("Table 3", "(7)", Cprime)),
        ),
        (
            "citation",
            check_citation(Citation("Table 3", "(8)", Cprime)),
            check_citation(Citation("Table 3", "(9)", Cprime)),
        ),
        (
            "attribution",
            check_whose(model.eq3, alpha, "conclusions", "restitution"),
            check_whose(model.eq3, alpha, "conclusions", "compression"),
        ),
        (
            "unit",
            check_units(model.eq3, {C: None, Cprime: None}),
            check_units(model.eq3, {C: "N/m^alpha", Cprime: "N"}),
        ),
        ("unit", check_units(model.eq3, {C: "N/m"}), check_units(model.eq3, {Cprime: "kg*m/s^2"})),
        (
            "missing",
            check_missing("Table 3", (model.x_m_of_test,), (alpha, model.v)),
            check_missing("Table 3", (model.x_m_of_test,), (alpha, model.v, C, model.m_red)),
        ),
    ],
)
def test_each_check_finds_and_passes(kind: str, finds: Check, passes: Check) -> None:
    found = finds(LEDGER)
    assert found is not None
    assert found.kind == kind
    assert found.sentence.endswith(".")
    assert found.evidence
    assert passes(LEDGER) is None


def test_a_print_that_gives_every_unknown_passes() -> None:
    assert check_determined("(12)", UNKNOWNS)(CORRECTED) is None


def found_in_the_paper() -> dict[tuple[str, str], Erratum]:
    errata = [found for check in LEDGER.checks if (found := check(LEDGER)) is not None]
    return {(found.about, found.kind): found for found in errata}


def test_the_errata_of_the_paper() -> None:
    assert list(found_in_the_paper()) == [
        ("(2)", "overlap"),
        ("(3)", "overlap"),
        ("(4)", "range"),
        ("(11)", "condition"),
        ("(12)", "determined"),
        ("Table 3, row C', (eq. 6)", "citation"),
        ("Table 3, row C', (eq. 8)", "citation"),
        ("(3)", "unit"),
        ("Table 3", "missing"),
        ("conclusions", "attribution"),
    ]
    assert len(LEDGER.checks) == 11  # the number of equations and unknowns is right as it is said


def test_what_the_errata_say() -> None:
    said = {key: found.sentence for key, found in found_in_the_paper().items()}
    assert (
        said["(12)", "determined"] == "(12) prints C'_1 twice and does not give C'_2; what is meant is (12e)."
    )
    assert said["Table 3, row C', (eq. 6)", "citation"] == (
        "Table 3, row C', (eq. 6): (6) does not contain C'; the claims that do are (7) and (9)."
    )
    assert said["(3)", "unit"] == (
        "By (3) C has the unit N/m^alpha and C' has the unit N, so that they are not of one kind. "
        "The source prints C in no unit and C' in no unit."
    )
    assert said["(4)", "range"] == (
        "The range in (4) is that of Meyer's exponent n = 2 alpha in [2, 3]. Tabor's plastic range of "
        "Meyer's exponent is [2, 5/2], which would mean 1 <= alpha <= 5/4."
    )
    assert said["(11)", "condition"].startswith(
        "(11) also vanishes where alpha + 1 - (beta + 1)*e_2^2 is negative."
    )
    assert said["Table 3", "missing"] == (
        "Table 3 cannot be computed from what is printed: it needs C by (L3) and m_red by (L3) and (L4), "
        "and the source gives no value of either."
    )


def test_no_name_of_the_program_shows() -> None:
    for found in found_in_the_paper().values():
        for words in (found.sentence, found.evidence):
            assert not re.search(r"Cprime|\w\[|\*\*|Piecewise", words), words


def test_the_evidence_of_the_condition_is_a_root_of_11() -> None:
    evidence = found_in_the_paper()["(11)", "condition"].evidence
    at = {
        name: mpmath.mpf(value) for name, value in re.findall(r"([\w']+) = (-?[\d.]+(?:e[-+]\d+)?)", evidence)
    }
    A, s = at["alpha"] + 1, at["beta"] + 1
    residual = (
        A / s
        + at["x_p1"] / at["x_p2"] * (at["e_2"] ** 2 - A / s) * (at["v'_2"] / at["v'_1"]) ** (2 / A)
        - at["e_1"] ** 2
    )
    assert abs(residual) < 1e-4
    assert at["x_m2"] == pytest.approx(at["x_p2"] / (1 - s / A * at["e_2"] ** 2), rel=1e-3)
    assert at["x_m2"] < 0


def test_the_evidence_of_the_overlap_is_two_forces() -> None:
    evidence = found_in_the_paper()["(2)", "overlap"].evidence
    at = {name: float(value) for name, value in re.findall(r"([\w']+) = (-?[\d.]+(?:e[-+]\d+)?)", evidence)}
    first, second = map(float, re.findall(r"give ([\d.]+) and ([\d.]+)", evidence)[0])
    assert at["x_p"] <= at["x"] <= at["x_m"]
    assert first == pytest.approx(at["C"] * at["x"] ** 1.5, rel=1e-4)
    assert second == pytest.approx(
        at["C'"] * ((at["x"] - at["x_p"]) / (at["x_m"] - at["x_p"])) ** 1.5, rel=1e-4
    )


def test_a_table_that_gives_a_coefficient_another_unit_is_our_mistake() -> None:
    stranger = Symbol("d", positive=True)  # the table's d is a diameter
    wrong = law((stranger * x**alpha, Le(x, x_m)), (Cprime, True))
    with pytest.raises(ValueError, match="another unit"):
        check_units(wrong, {stranger: None})(LEDGER)
