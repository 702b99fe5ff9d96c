"""A result that is a mean is a fit of a constant: its rows differ as their uncertainties make them."""

from __future__ import annotations

from pathlib import Path

import mpmath
import numpy as np
import pytest

from loopsheet.report.messages.diagnostics import Check
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study

METHOD = '''\
from loopsheet import Method, given, let, mean, measured


class Density(Method, source="made up", headline="rho"):
    """Density of a specimen that was weighed several times."""

    m = measured("g", "mass", positive=True)
    z = given("g", "reading of the empty pan")
    V = given("cm^3", "volume", positive=True)
    rho_k = let((m - z) / V, "density by one weighing", "kg/m^3")
    rho = let(mean(rho_k), "density", "kg/m^3")
'''
LIKE = ("20.01", "20.03", "19.99", "20.00", "20.02")
SWAPPED = ("20.01", "20.03", "19.99", "20.20", "20.02")


def report_of(
    folder: Path, readings: tuple[str, ...], stated: str, corrections: tuple[str, ...] = ()
) -> tuple[Report, Check]:
    code, head = METHOD, "reading,m [g]"
    if corrections:
        code = METHOD.replace(
            "    rho_k = let((m - z)", '    b = measured("1", "buoyancy")\n    rho_k = let(b * (m - z)'
        )
        head, readings = f"{head},b [1]", tuple(map(",".join, zip(readings, corrections, strict=True)))
    rows = "".join(f"{n},{text}\n" for n, text in enumerate(readings, start=1))
    toml = 'workbook = "workbook.py"\n[measurements]\nfile = "m.csv"\n'
    toml += f'[parameters]\nz = "0.00 g"\nV = "10.00 cm^3"\n{stated}'
    files = {"workbook.py": code, "m.csv": f"{head}\n{rows}", "report.toml": toml}
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    report = Study(folder).computed
    (found,) = (check for check in report.oddities if (check.kind, check.name) == ("squares", "rho"))
    return report, found


def test_what_differs_more_than_its_uncertainties_make_it_is_told(tmp_path: Path) -> None:
    """Generalised least squares of a constant: what all rows share explains next to nothing."""
    stated = '[uncertainty]\nm = "u = 0.02 g"\nz = "u = 1 g"\nV = "u = 0.05 cm^3"\n'
    report, found = report_of(tmp_path, SWAPPED, stated)
    masses = np.array(list(map(float, SWAPPED)))
    weights = np.linalg.inv(0.02**2 * np.eye(5) + 1.0 + np.outer(masses, masses) * (0.05 / 10) ** 2)
    about = masses - weights.sum(axis=0) @ masses / weights.sum()
    chi2 = about @ weights @ about
    assert chi2 == pytest.approx(np.sum((masses - masses.mean()) ** 2) / 0.02**2, rel=2e-3)
    assert report.uncertain().misfits["rho"].chi2 == pytest.approx(chi2, rel=1e-6)
    assert mpmath.gammainc(2, chi2 / 2, regularized=True) < 0.01
    assert found.word == "warning"
    assert f"rho is the mean of 5 rho_k: chi2 = {chi2:.1f} on 4 degrees of freedom" in found.message
    scatter = masses.std(ddof=1) / 10 / 5**0.5 * 1000
    assert f"rho_k[4] is farthest; by their scatter u of rho is {scatter:.1f} kg/m^3" in found.message


@pytest.mark.parametrize(
    ("readings", "stated", "said"),
    [
        (LIKE, '[uncertainty]\nm = "u = 0.02 g"\n', "which is what chance makes"),
        (SWAPPED, "", "no uncertainty is stated that could say how far they differ"),
        (SWAPPED, '[uncertainty]\nz = "u = 1 g"\nV = "u = 1 cm^3"\n', "no uncertainty is stated that could"),
        (SWAPPED, '[uncertainty]\nm = "scatter"\n', "which is what chance makes"),
        (
            SWAPPED,
            '[uncertainty]\nm = "exact"\nV = "exact"\nz = "u = 1 g"\n',
            "no uncertainty is stated that",
        ),
        (SWAPPED, '[uncertainty]\nm = "exact"\nV = "exact"\nz = "exact"\n', "no uncertainty is stated that"),
        (SWAPPED[:1], '[uncertainty]\nm = "u = 0.02 g"\n', "no uncertainty is stated that could"),
    ],
    ids=[
        "alike",
        "nothing stated",
        "stated of what all share",
        "their own scatter",
        "one error of all",
        "all exact",
        "one reading",
    ],
)
def test_nothing_else_is(tmp_path: Path, readings: tuple[str, ...], stated: str, said: str) -> None:
    _, found = report_of(tmp_path, readings, stated)
    assert (found.passed, found.word) == (True, "")
    assert said in found.message


@pytest.mark.parametrize(("digits", "word"), [("1.00012", "warning"), ("1.0", "")])
def test_a_little_may_be_known_by_its_digits_alone(tmp_path: Path, digits: str, word: str) -> None:
    """A column of which nothing is stated makes the others mute only where it matters."""
    _, found = report_of(tmp_path, SWAPPED, '[uncertainty]\nm = "u = 0.02 g"\n', (digits,) * 5)
    assert found.word == word
    assert ("chi2 = " in found.message) == bool(word)
