"""Repeated readings of a column, alone or together with others: scatter, correlation, degrees of freedom."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from shutil import copytree
from statistics import correlation, stdev

import numpy as np
import pytest
from helpers import method_folder

from loopsheet.report.cli import main
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.monte_carlo import draw
from loopsheet.report.uncertainty.propagation import Spread

V = [5.007, 4.994, 5.005, 4.990, 4.999]
I = [19.663, 19.639, 19.640, 19.685, 19.678]  # noqa: E741
Made = Callable[..., Path]


@pytest.fixture
def made(tmp_path: Path) -> Made:
    """GUM H.2 with other statements, unpublished."""

    def folder(section: str, **files: str) -> Path:
        place = tmp_path / "h2"
        copytree(PAPER.parent / "gum_h2", place, ignore=lambda *_: ["out", "__pycache__"])
        head = (place / "report.toml").read_text(encoding="utf-8").partition("[uncertainty]")[0]
        (place / "report.toml").write_text(f"{head}[uncertainty]\n{section}\n", encoding="utf-8")
        for name, text in files.items():
            (place / f"{name}.csv").write_text(text, encoding="utf-8")
        return place

    return folder


def spread(folder: Path) -> Spread:
    report = Study(folder).computed
    return Spread(report.inputs, report.values)


def test_readings_have_the_standard_deviation_that_they_have(made: Made) -> None:
    found = spread(made('V = "scatter"\nI = "exact"\nphi = "exact"'))
    budget = found.budget("V_mean", 0)
    assert found.u("V") == pytest.approx([stdev(V)] * 5, rel=1e-14)
    assert budget.u == pytest.approx(stdev(V) / math.sqrt(5), rel=1e-14)
    assert (budget.dof, {each.source.shape.value for each in budget.contributions}) == (4, {"t"})


def test_another_error_beside_the_scatter(made: Made) -> None:
    budget = spread(made('V = "scatter; u = 0.004"\nI = "exact"\nphi = "exact"')).budget("V_mean", 0)
    parts = stdev(V) / math.sqrt(5), 0.004 / math.sqrt(5)
    assert budget.u == pytest.approx(math.hypot(*parts), rel=1e-14)
    assert budget.dof == math.floor(4 * budget.u**4 / parts[0] ** 4)


def test_readings_together_correlate_and_are_one_sample(made: Made) -> None:
    found = spread(made('paired = ["V", "I"]\nphi = "exact"'))
    covariance = found.covariance([("V_mean", 0), ("I_mean", 0)])
    r = covariance[0, 1] / math.sqrt(covariance[0, 0] * covariance[1, 1])
    assert r == pytest.approx(correlation(V, I), rel=1e-12)
    assert found.budget("Z", 0).dof == 4


def test_two_samples_are_two(made: Made) -> None:
    """Without the pairing each column is a sample of its own: Welch and Satterthwaite, of two means."""
    found = spread(made('V = "scatter"\nI = "scatter"\nphi = "exact"')).budget("Z", 0)
    of_v, of_i = (stdev(x) / math.sqrt(5) / (sum(x) / 5) for x in (V, I))
    assert found.dof == math.floor(4 * (of_v**2 + of_i**2) ** 2 / (of_v**4 + of_i**4))
    assert 4 < found.dof < 8


def test_what_is_one_estimate_stands_together(made: Made) -> None:
    """What most of it comes from: all readings of V, not the first of them."""
    budget = spread(made('V = "scatter"\nI = "scatter"\nphi = "exact"')).budget("Z", 0)
    told = [({each.source.moves[0][0] for each in own}, len(own)) for own in budget.estimates]
    assert told == [({"V"}, 5), ({"I"}, 5)]
    shares = [sum(each.share for each in own) for own in budget.estimates]
    of_v, of_i = ((stdev(x) / sum(x)) ** 2 for x in (V, I))
    assert shares == pytest.approx([of_v / (of_v + of_i), of_i / (of_v + of_i)], rel=1e-9)


def test_one_estimate_for_a_column_is_one_estimate(made: Made) -> None:
    """Stated once for all rows: its degrees of freedom do not add up with the rows."""
    found = spread(made('V = "u = 0.004, dof = 6"\nI = "exact"\nphi = "exact"'))
    assert found.budget("V_mean", 0).dof == found.budget("V", 0).dof == 6


def test_a_test_that_is_left_out_is_no_reading(made: Made) -> None:
    rows = "".join(f"{n},{v},{i},1.04,\n" for n, (v, i) in enumerate(zip(V, I, strict=True), 1))
    table = f"test,V [V],I [mA],phi [1],left out\n{rows}6,9.9,30,1.04,it slipped\n"
    found = spread(made('V = "scatter"', measurements=table))
    assert found.u("V") == pytest.approx([stdev(V)] * 5, rel=1e-14)


def test_paired_readings_that_are_all_the_same_have_the_error_of_their_digits(made: Made) -> None:
    table = "test,V [V],I [mA],phi [1]\n" + "".join(f"{n},5,{i},1.04\n" for n, i in enumerate(I, 1))
    found = spread(made('paired = ["V", "I", "phi"]', measurements=table))
    assert found.u("V_mean").tolist() == pytest.approx([0.5 / math.sqrt(3 * 5)])
    assert found.budget("I_mean", 0).dof == 4


def test_draws_of_readings_have_their_degrees_of_freedom(made: Made) -> None:
    """The mean of five readings is spread as t with four degrees of freedom, no mean of five of these."""
    report = Study(made('paired = ["V", "I"]\nphi = "exact"')).computed
    for cell in ("V_mean", "Z"):
        budget = Spread(report.inputs, report.values).budget(cell, 0)
        drawn = draw(report.inputs, report.values, budget, 200_000)
        ends = np.array(drawn.symmetric) - budget.value
        assert ends == pytest.approx([-budget.expanded, budget.expanded], rel=0.02)
        assert budget.factor == pytest.approx(2.7764, abs=1e-4)


@pytest.mark.parametrize(
    ("section", "code", "said"),
    [
        ('paired = "V"', "LS205", "a list of columns"),
        ('paired = ["V"]', "LS434", "two or more of V, I or phi"),
        ('paired = ["V", "V"]', "LS434", "'V' is named twice"),
        ('paired = ["V", "U"]', "LS434", "'U' is no measured column with two rows or more"),
        ('paired = ["V", "I"]\nI = "u = 0.1"', "LS433", "uncertainty of I is stated twice"),
        (
            'paired = ["V", "I"]\nphi = "u = 0.1"\n[uncertainty.correlation]\n"V, phi" = "0.1"',
            "LS434",
            "what V correlates with follows from its paired readings",
        ),
        ('[uncertainty.shared.a]\nof = "V"\nstated = "scatter"', "LS431", "'scatter' is not understood"),
        ('V = "scatter, n = 3"', "LS431", "say what the number is"),
    ],
)
def test_what_is_wrong_is_told_where_it_stands(
    made: Made, section: str, code: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", str(made(section))]) == 2
    told = capsys.readouterr().err
    assert f"error[{code}]" in told
    assert said in told
    assert "report.toml:" in told


def test_a_single_number_does_not_scatter(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    copytree(PAPER.parent / "gum_h1", tmp_path / "h1")
    toml = tmp_path / "h1" / "report.toml"
    toml.write_text(toml.read_text(encoding="utf-8").replace("u = 0.2", "scatter"), encoding="utf-8")
    assert main(["check", str(tmp_path / "h1")]) == 2
    assert "it is that of a measured column with two rows or more" in capsys.readouterr().err


@pytest.mark.parametrize("more", ["", "; +-0.5 digits rect"])
def test_equal_readings_have_the_error_of_their_digits(made: Made, more: str) -> None:
    table = "test,V [V],I [mA],phi [1]\n" + "".join(f"{n},5.00,{i},1.04\n" for n, i in enumerate(I, 1))
    at = made(f'V = "scatter{more}"\nI = "exact"\nphi = "exact"', measurements=table)
    budget = spread(at).budget("V_mean", 0)
    assert budget.u == pytest.approx(0.005 / math.sqrt(3 * 5), rel=1e-12)
    found = [c for c in Study(at).computed.oddities if (c.kind, c.name) == ("scatter", "V")]
    assert [(c.note, "all 5 readings are 5.00" in c.message) for c in found] == [("warning", True)] * (
        not more
    )


WEIGHED = """from loopsheet import Method, given, let, mean, measured


class Weighing(Method, rows="cycles", headline="dI m_T"):
    "Substitution weighing."
    A = measured("mg", "standard")
    B = measured("mg", "test")
    m_R = given("mg", "mass of the standard")
    D_k = let(B - A, "difference of a cycle", "mg")
    dI = let(mean(D_k), "mean difference", "mg")
    m_T = let(m_R + dI, "mass of the test weight", "mg")
"""


@pytest.mark.parametrize(
    ("rows", "odd"),
    [("0.012,0.256\n0.010,0.254\n0.013,0.257\n", True), ("0.012,0.256\n0.010,0.251\n0.013,0.260\n", False)],
)
def test_what_readings_come_to_may_scatter_less_than_their_digits_leave(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], rows: str, odd: bool
) -> None:
    """Each of them moves, and the difference stands still: its u is 0, and nobody has seen a microgram."""
    more = '[parameters]\nm_R = "100.000 mg, u = 0.015 mg"\n[uncertainty]\npaired = ["A", "B"]\n'
    method_folder(tmp_path, WEIGHED, f"A [mg],B [mg]\n{rows}", more)
    left = 1e-9 * math.sqrt(2 / 3 / 12)  # a microgram in both, over three rows
    found = Study(tmp_path).computed.uncertain().unresolved
    assert found == ({("dI", 0): pytest.approx(left, rel=1e-9)} if odd else {})
    main(["build", str(tmp_path)])
    said = capsys.readouterr().out
    assert ("mg): A and B scatter there by less than half of what their digits leave" in said) == odd


READINGS = "reading,V [V],I [mA],phi [1]\n1,5.007,19.663,1.0456\n2,4.994,19.639,1.0438\n"
READINGS += "3,5.005,19.640,1.0468\n4,4.990,19.685,1.0428\n5,4.999,19.678,1.0433\n"
COARSE = "reading,V [V],I [mA],phi [1]\n1,5.0,19.6,1.05\n2,5.1,19.6,1.04\n3,5.0,19.6,1.05\n"


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        (READINGS + "6,4.994,19.639,1.0438\n", "readings 2 and 6 have the same numbers in all columns"),
        (READINGS + "6,4.994,19.639,1.0439\n", ""),
        (READINGS, ""),
        (COARSE, ""),  # of two numbers a column, three rows have the same ones soon
    ],
)
def test_a_row_that_stands_there_twice_is_told(made: Made, rows: str, told: str) -> None:
    folder = made('V = "u = 0.01"\nI = "u = 0.01"\nphi = "u = 0.001"', measurements=rows)
    (found,) = (each for each in Study(folder).computed.oddities if each.kind == "twice")
    assert (told in found.message, found.word) == (True, "warning" if told else "")
    assert found.at.line == (7 if told else None)
    if told:
        with (folder / "report.toml").open("a", encoding="utf-8") as report:
            report.write('[expected]\n"reading 6" = "so it was"\n')
        (again,) = (each for each in Study(folder).computed.oddities if each.kind == "twice")
        assert again.message.endswith("as is expected")


def test_readings_that_were_taken_together_are_looked_for_together(tmp_path: Path, made: Made) -> None:
    """A correlation, too, is that of digits that are not printed."""
    rng = np.random.default_rng(3)
    voltage = 5 + 0.004 * rng.standard_normal(5)
    current = 19.66 + 0.6 * (voltage - 5) + 0.003 * rng.standard_normal(5)
    table = "".join(
        f"{n},{v:.3f},{i:.3f},1.04\n" for n, (v, i) in enumerate(zip(voltage, current, strict=True), 1)
    )
    head = "reading,V [V],I [mA],phi [rad]\n"
    said = 'paired = ["V", "I"]\nphi = "exact"\n[published]\nfile = "published.csv"\n'
    folder = made(said, measurements=head + table)
    published = 'source,cell,index,value,unit\nT,"r(V_mean, I_mean)",,{:.4f},1\n'
    hidden = correlation(voltage, current)
    (folder / "published.csv").write_text(published.format(hidden))
    (one,) = Study(folder).refereed.comparisons_u
    assert (one.verdict, one.word) == ("differs", "reachable")
    (folder / "published.csv").write_text(published.format(-hidden))
    (one,) = Study(folder).refereed.comparisons_u
    assert one.word == "differs"


PERIODS = """\
from sympy import pi
from loopsheet import Method, given, let, mean, measured


class Pendulum(Method, rows="swings"):
    \"\"\"g by the period.\"\"\"

    T = measured("s", "period", positive=True)
    L = given("m", "length", positive=True)
    Tm = let(mean(T), "mean period", "s")
    g = let(4 * pi**2 * L / Tm**2, "gravity", "m/s^2")
"""


@pytest.mark.parametrize("off", [1.0, 1.5])
def test_a_published_scatter_may_be_that_of_digits_that_are_not_printed(tmp_path: Path, off: float) -> None:
    """Whoever had all digits has another standard deviation than two decimals have, and not any other."""
    more = '[parameters]\nL = "0.8403 m, u = 0.5 mm"\n[uncertainty]\nT = "scatter"\n'
    hidden = np.array([1.85357, 1.81807, 1.83837, 1.85647, 1.81823])
    rows = "".join(f"{n},{each:.2f}\n" for n, each in enumerate(hidden, start=1))
    u, g = hidden.std(ddof=1) / math.sqrt(5), 4 * np.pi**2 * 0.8403 / hidden.mean() ** 2
    u_g = g * math.hypot(0.5e-3 / 0.8403, 2 * u / hidden.mean())
    said = [
        f"T,u(Tm),,{off * u:.4f},s",
        f"T,u(g),,{u_g:.3f},m/s^2",
        f'T,"u(g, T)",,{2 * g * u / 1.838:.3f},m/s^2',
    ]
    published = "\n".join(["source,cell,index,value,unit", *said, ""])
    method_folder(tmp_path, PERIODS, f"swing,T [s]\n{rows}", more, published)
    found = Study(tmp_path).refereed.comparisons_u
    assert [each.verdict for each in found] == ["differs"] * 3
    assert [each.word for each in found] == ["reachable" if off == 1 else "differs", "reachable", "reachable"]
    assert [each.as_expected for each in found] == [off == 1, True, True]
    assert main(["check", str(tmp_path)]) == (0 if off == 1 else 1)
