"""The page reads and saves temperatures in degC as a build does, and what is remarked of them."""

from collections.abc import Callable
from pathlib import Path

import driving
import gas
import pytest
from driving import Live

from loopsheet.report import build
from loopsheet.report.study import Study


@pytest.mark.usefixtures("unrefereed")
def test_a_temperature_that_is_edited_is_saved_as_it_was_typed(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    rows = zip(gas.TABLE.splitlines(), ("remark", "", '"warm, too"', "cold"), strict=True)
    folder = gas.folder(tmp_path / "gas", table="".join(f"{row},{said}\n" for row, said in rows))
    build.build(Study(folder), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    assert driving.differences(live.cells(), Study(folder).computed.values) == []
    live.type("T", 3, "-13.7")
    live.type("dT", "", "2.25")
    assert live.cell("warm", "3").text in ("-11.45", "−11.45")
    assert live.cell("T", "3").value == "259.45"
    live.type("T", 1, "60.1")
    assert "between -50 and 60 degC (temperature)" in " ".join(live.around())
    live.type("T", 1, "59.9")
    saved = live.save(tmp_path / "saved", "workbook.py", "published.csv")
    lines = (saved / "measurements.csv").read_text(encoding="utf-8").splitlines()
    assert lines == ["reading,T [degC],remark", "1,59.9,", '2,21.5,"warm, too"', "3,-13.7,cold"]
    report = Study(saved).computed
    assert report.values.value["T"].tolist() == [333.05, 294.65, 259.45]
    assert driving.differences(live.cells(), report.values) == []
