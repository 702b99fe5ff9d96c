"""Published values as a user of `check` meets them: what counts as the same, what pins a difference."""

from pathlib import Path

import pytest
from small_report import end_gauge

from loopsheet.report import build
from loopsheet.report.cli import main


@pytest.fixture(autouse=True)
def engines_are_as_they_were(monkeypatch: pytest.MonkeyPatch) -> None:
    """They are judged elsewhere, and take longer than all that is done here."""
    monkeypatch.setattr(build, "judged", lambda report, step: report)


@pytest.mark.parametrize("text", ["50.000838", "5.0000838e1", "5.0000838E+01", "+50.000838", "50000.838e-3"])
def test_check_counts_what_prints_the_same_in_any_notation(
    tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        main(["check", str(end_gauge(tmp_path, f"source,cell,index,value,unit\nH.1,l,1,{text},mm\n"))]) == 0
    )
    out = capsys.readouterr().out
    assert "published  1 values: 1 print the same, 0 differ as is known\n" in out
    assert "->" not in out


def test_a_value_of_seventy_digits_can_be_compared(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    csv = "source,cell,index,value,unit\nH.1,l,1,1.5,mm\n"
    toml = (end_gauge(tmp_path) / "report.toml").read_text().replace("50.000623 mm", "5e70 mm")
    assert main(["check", str(end_gauge(tmp_path, csv, report=toml))]) == 1
    captured = capsys.readouterr()
    assert "bug" not in captured.err
    assert f"1.5 -> {1000 * int(5e67)}.0 " in captured.out
