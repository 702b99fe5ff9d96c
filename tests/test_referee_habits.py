"""What accuses nobody, or leaves something out, is said where uncertainties are stated as where none are."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from helpers import method_folder

from loopsheet.report.result.findings import checks
from loopsheet.report.result.verdict_words import claimed
from loopsheet.report.study import Study

DENSITY = '''\
from loopsheet import Method, given, let, mean, measured


class Content(Method, source="own", rows="runs"):
    """Rounded on the way, or a correction left out."""

    m = measured("g", "mass", positive=True)
    V = measured("mL", "volume", positive=True)
    f = given("1", "factor", positive=True)
    b = given("g/mL", "blank")
    L = given("mm", "path", default="10 mm", exact=True)
    L_0 = given("mm", "path of the factor", default="10 mm", exact=True)
    rho = let(m / V, "density", "g/mL")
    c = let(f * rho * L / L_0 - b, "content", "g/mL")
    c_m = let(mean(c), "mean content", "g/mL")
'''
RUNS = "run,m [g],V [mL]\n1,10.2314,25.013\n2,10.3941,25.227\n3,10.1773,24.871\n"
STATED = '[uncertainty]\nm = "u = 0.01 g"\n'


SCATTER = '''\
from sympy import sqrt
from loopsheet import Method, count, fit, let, mean, measured, unknown


class Line(Method, source="own", rows="runs"):
    """What scatters about a mean, and about a line."""

    m = measured("g", "mass", positive=True)
    V = measured("mL", "volume", positive=True)
    V_m = let(mean(V), "mean volume", "mL")
    s = let(sqrt(sum((V - V_m) ** 2) / (count(V) - 1)), "scatter", "mL")
    u_m = let(s / sqrt(count(V)), "its uncertainty", "mL")
    a, b = unknown("intercept", "mL"), unknown("slope", "mL/g")
    line = fit(V, a + b * m)
'''


def judged(folder: Path, book: str, published: str, more: str, runs: str = RUNS) -> tuple[list[str], ...]:
    """What the referee holds for possible of a publication: the words of each explanation."""
    method_folder(folder, book, runs, more, f"source,cell,index,value,unit\n{published}")
    referee = Study(folder).refereed.referee
    found = referee.explanations if referee.asked_why else referee.slips
    return tuple([claimed(change) for change in each.changes] for each in found)


def said(folder: Path, f: str, b: str, published: str, more: str = "") -> list[str]:
    """The first words of each, of a publication of contents."""
    given = f'[parameters]\nf = "{f}"\nb = "{b}"\n'
    return [first for first, *_ in judged(folder, DENSITY, published, more + given)]


CORRECTED = '''\
from sympy import pi, sin
from loopsheet import Method, given, let, mean, measured


class Pendulum(Method, source="own", rows="swings"):
    """Free fall, with a correction for the amplitude."""

    T = measured("s", "period", positive=True)
    theta = measured("deg", "amplitude")
    L = given("mm", "length", positive=True)
    g_k = let(4 * pi**2 * L * (1 + sin(theta / 2) ** 2 / 4) ** 2 / T**2, "free fall by one", "m/s^2")
    g = let(mean(g_k), "free fall", "m/s^2")
'''


def test_a_column_of_corrections_that_was_left_out(tmp_path: Path) -> None:
    """It was 0; nearly nothing by a power of ten says the same, and is not said besides."""
    periods, amplitudes = (2.0105, 2.0127, 2.0152), (4.0, 7.0, 9.0)
    runs = "".join(
        f"{n},{T},{angle}\n" for n, (T, angle) in enumerate(zip(periods, amplitudes, strict=True), 1)
    )
    without = [4 * np.pi**2 * 1.0 / T**2 for T in periods]
    published = "".join(f"Table,g_k,{n},{value:.3f},m/s^2\n" for n, value in enumerate(without, 1))
    published += f"Table,g,,{np.mean(without):.3f},m/s^2\n"
    table = f"swing,T [s],theta [deg]\n{runs}"
    found = judged(tmp_path, CORRECTED, published, '[parameters]\nL = "1000.0 mm"\n', table)
    assert found[0] == ["theta was taken as 0"]
    assert not any("theta are to be multiplied" in each for each, *_ in found)


@pytest.mark.parametrize("more", ["", STATED])
def test_what_was_computed_from_rounded_numbers(more: str, tmp_path: Path) -> None:
    density = "T1,rho,1,0.409,g/mL\nT1,rho,2,0.412,g/mL\nT1,rho,3,0.409,g/mL\n"
    content = "T2,c,1,1.7126,g/mL\nT2,c,2,1.7252,g/mL\nT2,c,3,1.7126,g/mL\nT2,c_m,,1.7168,g/mL\n"
    (told,) = said(tmp_path, "4.1873, exact", "0 g/mL, exact", density + content, more)
    assert told == "T2 was computed from the printed, rounded rho"


@pytest.mark.parametrize("more", ["", STATED])
@pytest.mark.parametrize(
    ("f", "b", "first"),
    [
        ("1, exact", "0.0013 g/mL", "b was 0, not 0.0013"),
        ("1, exact", "1.3e-3 g/mL, exact", "b was 0, not 1.3e-3"),
        ("1.0021", "0 g/mL, exact", "f was 1, not 1.0021"),
    ],
)
def test_a_correction_that_was_left_out(f: str, b: str, first: str, more: str, tmp_path: Path) -> None:
    """The contents are the densities, to their last digit."""
    content = "T,c,1,0.40904,g/mL\nT,c,2,0.41202,g/mL\nT,c,3,0.40920,g/mL\nT,c_m,,0.41009,g/mL\n"
    assert said(tmp_path, f, b, content, more)[0] == first


def test_a_convention_is_no_explanation_of_a_single_number(tmp_path: Path) -> None:
    """Some path of four digits always yields it; the number itself is asked first."""
    content = "T,rho,1,0.40904,g/mL\nT,c_m,,0.41309,g/mL\n"
    told = said(tmp_path, "1, exact", "0 g/mL, exact", content)
    assert told[0].startswith("c_m of T is printed 0.41309 for 0.4100")
    assert sorted(told[-2:]) == ["L was 10.073, not 10", "L_0 was 9.9273, not 10"]


def test_a_convention_is_told_in_its_own_unit(tmp_path: Path) -> None:
    content = "T,c,1,0.51131,g/mL\nT,c,2,0.51503,g/mL\nT,c,3,0.51150,g/mL\nT,c_m,,0.51261,g/mL\n"
    told = said(tmp_path, "1, exact", "0 g/mL, exact", content)
    assert told[:2] == ["L was 12.5, not 10", "L_0 was 8, not 10"]


@pytest.mark.parametrize("more", ["", '[uncertainty]\nV = "u = 0.05 mL"\n'])
def test_what_was_divided_by_n_stands_in_all_that_follows_from_it(more: str, tmp_path: Path) -> None:
    """One cause, though two columns are off: s = 0.1786 mL and s/sqrt(3) are published as by n."""
    content = "T,V_m,,25.0370,mL\nT,s,,0.1463,mL\nT,u_m,,0.0845,mL\n"
    told = judged(tmp_path, SCATTER, content, more)
    assert told[0] == [f"the numbers of {name} of T are to be multiplied by √(3/2)" for name in ("s", "u_m")]


@pytest.mark.parametrize(("divisor", "factor"), [(3, "√(3/1)"), (2, "√(2/1)")])
def test_the_scatter_about_a_fit_is_over_what_its_parameters_leave(
    divisor: int, factor: str, tmp_path: Path
) -> None:
    m, V = np.array([[10.2314, 10.3941, 10.1773], [25.013, 25.227, 24.871]])
    b, a = np.polyfit(m, V, 1)
    s, root = (np.sum((V - a - b * m) ** 2) / divisor) ** 0.5, np.sum((m - m.mean()) ** 2) ** 0.5
    content = f"T,a,,{a:.5f},mL\nT,b,,{b:.6f},mL/g\nT,line_s,,{s:.6f},mL\nT,s_b,,{s / root:.5f},mL/g\n"
    told = judged(tmp_path, SCATTER, content, "")
    assert told[0] == [
        f"the numbers of {name} of T are to be multiplied by {factor}" for name in ("line_s", "s_b")
    ]


@pytest.mark.parametrize(
    ("published", "told"),
    [
        ("u(V_m),,0.0577,mL", "u(V_m) prints 0.0577, recomputed 0.0289, and 2 u would print so (differs)"),
        ("u(V_m),,0.0566,mL", "u(V_m) prints 0.0566, recomputed 0.0289, and U would print so (differs)"),
        (
            '"U(V_m, k=2)",,0.0289,mL',
            "U(V_m, k=2) prints 0.0289, recomputed 0.0577, and u would print so (differs)",
        ),
        ("u(V_m),,0.0433,mL", "u(V_m) prints 0.0433, recomputed 0.0289 (differs)"),
    ],
)
def test_an_uncertainty_that_is_another_one(published: str, told: str, tmp_path: Path) -> None:
    """u of one reading is 0.05 mL, of their mean 0.0289 mL; U is 1.96 times that."""
    judged(tmp_path, SCATTER, f"T,{published}\n", '[uncertainty]\nV = "u = 0.05 mL"\n')
    (found,) = (each for each in checks(Study(tmp_path).refereed) if each.kind == "published")
    assert (found.passed, found.message) == (False, f"T {told}")


SIGNED = '''\
from loopsheet import Method, let, measured


class Signed(Method, source="own", rows="runs"):
    """A number whose sign was lost."""

    m = measured("{unit}", "what has a sign")
    V = measured("mL", "what has none", positive=True)
    a = let({formula}, "made of it", "{of}")
    b = let(m, "itself", "{unit}")
'''


@pytest.mark.parametrize(
    ("unit", "formula", "of", "rows"),
    [
        ("V", "m / V", "V/mL", ("0.40904", "-0.41202", "0.40920")),
        ("degC", "m", "degC", ("10.2314", "-10.3941", "10.1773")),
    ],
)
def test_a_sign_that_was_lost(
    unit: str, formula: str, of: str, rows: tuple[str, ...], tmp_path: Path
) -> None:
    """Of a temperature it is that of its number: what is below 0 degC is not below 0 K."""
    lines = [f"T,a,{n},{text},{of}\n" for n, text in enumerate(rows, start=1)]
    book = SIGNED.format(unit=unit, formula=formula, of=of)
    told = judged(
        tmp_path,
        book,
        "".join([*lines, f"T,b,2,-10.3941,{unit}\n"]),
        "",
        RUNS.replace("m [g]", f"m [{unit}]"),
    )
    assert told[0][0].startswith("m[2] is printed 10.3941 for -10.3941")


ROUND = '''\
from loopsheet import Method, given, let, mean, measured


class Bar(Method, source="own", rows="bars"):
    """Stress of a bar."""

    x = measured("1", "strain", positive=True)
    E = given("MPa", "modulus", positive=True)
    s = let(E * x, "stress", "MPa")
    s_m = let(mean(s), "mean stress", "MPa")
'''
BARS = "bar,x [1]\n1,0.0012345\n2,0.0023456\n3,0.0034567\n"


@pytest.mark.parametrize(
    ("E", "values", "told"),
    [
        # 210 345 MPa, known to four digits and printed in full.
        (
            "210300",
            ("259.67", "493.39", "727.10"),
            "the zeros at the end of E are no digits: 210300 is 2.103e5",
        ),
        # What is printed to tens is 259.7, 493.4 and 727.1.
        ("210345", ("260", "490", "730"), "the zeros at the end of s of text are no digits: 260 is 2.6e2"),
    ],
)
def test_zeros_may_be_no_digits(E: str, values: Sequence[str], told: str, tmp_path: Path) -> None:
    published = "".join(f"text,s,{n},{value},MPa\n" for n, value in enumerate(values, start=1))
    found = judged(tmp_path, ROUND, published, f'[parameters]\nE = "{E} MPa"\n', BARS)
    assert [told] in found


BY_LOT = '''\
from loopsheet import Method, groups, let, mean, measured


class Lots(Method, source="own", rows="runs"):
    """Means by lot."""

    m = measured("g", "mass", positive=True)
    lot = groups("lot")
    d = let(2 * m, "double", "g")
    d_lot = let(mean(d, of=lot), "mean by lot", "g")
'''
LOTS = "run,lot,m [g]\n1,x,10.11\n2,x,10.17\n3,y,12.40\n4,x,10.38\n5,y,12.51\n"


def test_the_mean_of_a_group_without_one_of_its_rows(tmp_path: Path) -> None:
    """It is named as the table has it, by its word; in what is accepted its number stands for that, too."""
    published = "T,d_lot,x,20.28,g\nT,d_lot,y,24.91,g\n"
    (own,), *_ = judged(tmp_path, BY_LOT, published, "", LOTS)
    assert own == "d_lot[x] of T was taken without run 4 (x)"
    published = published.replace("20.28,g", "20.28,g,differs,20.28 -> 20.44,rows d_lot[{}],known")
    published = published.replace("24.91,g", "24.91,g,,,,")
    report = 'workbook = "workbook.py"\n[measurements]\nfile = "measurements.csv"\n'
    (tmp_path / "report.toml").write_text(f'{report}[published]\nfile = "published.csv"\n', encoding="utf-8")
    for called, right in (("x", True), ("1", True), ("y", False)):
        rows = f"source,cell,index,value,unit,expect,recomputed,explained,reason\n{published.format(called)}"
        (tmp_path / "published.csv").write_text(rows, encoding="utf-8")
        found = {c.name: c.passed for c in checks(Study(tmp_path).refereed) if c.kind == "published"}
        assert found == {"d_lot[1]": right, "d_lot[2]": True}
