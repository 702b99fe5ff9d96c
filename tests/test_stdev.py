"""`stdev`: the standard deviation over rows, over pairs, and over the rows of each group."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from pathlib import Path
from statistics import stdev

import pytest
from helpers import method_folder

from loopsheet.report.cli import main
from loopsheet.report.study import Study

METHOD = """
from loopsheet import Method, claim, count, groups, let, mean, measured, pairs, stdev

class Scatter(Method, headline="of_all of_each"):
    "Scatter of readings."
    a = measured("mm", "reading")
    b = measured("mm", "another reading")
    specimen = groups("specimen")
    of_all = let(stdev(a), "scatter of all")
    of_b = let(stdev(b), "scatter of those that are there")
    of_each = let(stdev(a, of=specimen), "scatter of each")
    first, second = pairs()
    of_pairs = let(stdev(first(a) - second(a)), "scatter of differences")
    away = let((a - mean(a, of=specimen)) / stdev(a, of=specimen), "from the mean, in scatters")
    claim(of_all**2 * (count() - 1), sum(a**2) - count() * mean(a) ** 2, "squares by what was observed")
"""
A = {"S-17": ("2.031", "2.034", "2.028"), "S-18": ("2.045", "2.041"), "S-21": ("2.022", "2.029", "2.027")}
B = ("1", "2", "4", "", "3", "3", "3", "7", "")


def folder(place: Path, more: tuple[str, ...] = ()) -> Path:
    """Of these readings, and further ones of a specimen each."""
    every = [(name, text) for name, own in A.items() for text in own]
    every += [(f"S-3{n}", text) for n, text in enumerate(more)]
    rows = "".join(
        f"{n},{name},{text},{b}\n" for n, ((name, text), b) in enumerate(zip(every, B, strict=False), start=1)
    )
    return method_folder(place, METHOD, f"reading,specimen,a [mm],b [mm]\n{rows}")


def test_it_is_pythons_of_rows_groups_and_pairs(tmp_path: Path) -> None:
    values = Study(folder(tmp_path)).computed.values.value
    every = [float(text) / 1000 for own in A.values() for text in own]
    assert values["of_all"] == pytest.approx(stdev(every), rel=1e-12)
    assert values["of_b"] == pytest.approx(stdev(float(text) / 1000 for text in B if text), rel=1e-12)
    each = [stdev(float(text) / 1000 for text in own) for own in A.values()]
    assert values["of_each"] == pytest.approx(each, rel=1e-12)
    apart = [one - other for one, other in combinations(every, 2)]
    assert values["of_pairs"] == pytest.approx(stdev(apart), rel=1e-12)


def test_it_is_shown_in_the_unit_of_what_scatters(tmp_path: Path) -> None:
    """Of per cents in per cent, of the means of groups, too, whose squares are in a column of their own."""
    code = METHOD.partition("    of_all")[0].replace("mm", "%")
    code = code.replace("of_all of_each", "of_a of_means") + (
        "    of_a = let(stdev(a), 'of all')\n"
        "    of_means = let(stdev(let(mean(a, of=specimen), 'of each')), 'of means')\n"
    )
    code = code.replace("let(mean(a, of=specimen), 'of each')", "each").replace(
        "    of_a =", "    each = let(mean(a, of=specimen), 'of each')\n    of_a ="
    )
    table = "reading,specimen,a [%],b [%]\n1,A,1.0,1\n2,A,1.2,1\n3,B,1.7,1\n4,C,1.1,1\n"
    report = Study(method_folder(tmp_path, code, table)).computed
    assert {report.shown[name].unit for name in ("a", "each", "of_a", "of_means")} == {"%"}
    assert report.values.scalar("of_means") == pytest.approx(stdev([0.011, 0.017, 0.011]), rel=1e-12)


def test_of_one_reading_there_is_none_in_any_engine(
    tmp_path: Path, every_engine: Callable[..., str], capsys: pytest.CaptureFixture[str]
) -> None:
    """Nor of what is divided by it: 1/sqrt(1/0) is 0 in doubles."""
    told = every_engine(folder(tmp_path, more=("2.030",)), code=1)
    assert "50 digits say" not in told
    assert main(["show", "of_each", str(tmp_path)]) == 1
    assert "of_each[S-30]    #DOMAIN!" in capsys.readouterr().out
    assert main(["show", "away[9]", str(tmp_path)]) == 1
    assert "#DOMAIN!" in capsys.readouterr().out


def test_what_follows_from_its_definition_is_proved(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["prove", str(folder(tmp_path))]) == 0
    assert "proved       of_all^2*(-1 + n) = " in capsys.readouterr().out


def test_it_is_of_what_has_rows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    place = folder(tmp_path)
    code = METHOD.replace("stdev(b)", "stdev(mean(b))")
    (place / "workbook.py").write_text(code, encoding="utf-8")
    assert main(["build", str(place)]) == 2
    assert "stdev() is taken over rows, and " in capsys.readouterr().err
