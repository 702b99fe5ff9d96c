"""What accuses nobody, or leaves something out, is said where uncertainties are stated as where none are."""

from __future__ import annotations

from pathlib import Path

import pytest

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


def said(folder: Path, f: str, b: str, published: str, more: str = "") -> list[str]:
    """What the referee holds for possible of a publication: the words of each explanation."""
    (folder / "workbook.py").write_text(DENSITY, encoding="utf-8")
    (folder / "measurements.csv").write_text(RUNS, encoding="utf-8")
    (folder / "published.csv").write_text(f"source,cell,index,value,unit\n{published}", encoding="utf-8")
    (folder / "report.toml").write_text(
        f'workbook = "workbook.py"\n[parameters]\nf = "{f}"\nb = "{b}"\n'
        f'[measurements]\nfile = "measurements.csv"\n{more}[published]\nfile = "published.csv"\n',
        encoding="utf-8",
    )
    referee = Study(folder).report.referee
    found = referee.explanations if referee.asked_why else referee.slips
    return [claimed(each.first) for each in found]


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
    assert sorted(told[-2:]) == ["L was 10.073, not 10", "L_0 was 9.9272, not 10"]


def test_a_convention_is_told_in_its_own_unit(tmp_path: Path) -> None:
    content = "T,c,1,0.51131,g/mL\nT,c,2,0.51503,g/mL\nT,c,3,0.51150,g/mL\nT,c_m,,0.51261,g/mL\n"
    told = said(tmp_path, "1, exact", "0 g/mL, exact", content)
    assert told[:2] == ["L was 12.5, not 10", "L_0 was 8, not 10"]
