"""values.json as programs read it."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.agreement import Agreement
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import json as view


@pytest.fixture(scope="module")
def values(report: Report) -> dict[str, object]:
    return json.loads(view.values(report))  # type: ignore[no-any-return]


def test_shape(values: dict) -> None:  # type: ignore[type-arg]
    assert values["schema"] == 1
    assert values["workbook"] == "soft_impact"
    alpha = values["cells"]["alpha"]
    assert alpha["axis"] == "pairs"
    assert alpha["index"][:2] == [[1, 2], [1, 3]]
    assert alpha["unit"] == "1"
    assert alpha["status"] == ["ok"] * 10
    assert alpha["value"][0] == 1.2579969787312355
    assert values["cells"]["alpha_mean"]["axis"] is None
    assert values["cells"]["v"]["index"] == [1, 2, 3, 4, 5]
    assert values["cells"]["v"]["u"][0] == pytest.approx(0.0005 / 3**0.5)
    assert {c["axis"] for c in values["cells"].values()} == {"tests", "pairs", "points", None}


def test_it_says_which_are_the_results_and_in_which_unit_people_read_them(values: dict) -> None:  # type: ignore[type-arg]
    assert values["headline"][:3] == ["alpha_eiv", "C_eiv", "chi2_eiv"]
    assert values["aside"] == []
    assert values["cells"]["x_p"]["shown"] == {"text": "um", "scale": 1e-06, "zero": 0.0}
    assert "shown" not in values["cells"]["v"]


def test_it_has_the_digits_that_every_view_shows(values: dict, report: Report) -> None:  # type: ignore[type-arg]
    cells = values["cells"]
    assert cells["x_p"]["text"] == ["23.5", "29.7", "41.6", "45.97", "51.03"]  # as printed, in um
    assert cells["v"]["text"][0] == "2.334"
    assert (cells["alpha_mean"]["text"], cells["C_eiv"]["text"]) == ("1.3026", "1.009e9")
    for name in ("alpha", "x_m", "u_alpha_eiv"):
        own = (
            cells[name] if isinstance(cells[name]["text"], list) else {k: [v] for k, v in cells[name].items()}
        )
        every = list(report.values.cells(name))
        shown = [report.text(cell).partition(" ")[0] for cell in every]
        assert [text.replace("-", "\u2212") for text in own["text"]] == shown


def test_rows_that_a_rule_makes_of_each_pair_are_counted_not_listed(values: dict) -> None:  # type: ignore[type-arg]
    F = dict(values["cells"]["F"])
    assert F.pop("rule").startswith("(L")
    assert F == {"axis": "points", "of": "pairs", "unit": "N", "size": 500, "status": {"ok": 500}}


def test_cells_of_the_design_are_there(values: dict) -> None:  # type: ignore[type-arg]
    names = (
        "v e x_p m_red beta alpha x_m1 x_m2 C Cprime_1 Cprime_2 alpha_mean alpha_log C_log alpha_lin C_lin"
    )
    assert set(f"{names} x_m Cprime_eq7 Cprime_eq9".split()) <= set(values["cells"])


def test_every_column_says_what_makes_it(values: dict) -> None:  # type: ignore[type-arg]
    cells = values["cells"]
    assert cells["v"]["rule"] == cells["beta"]["rule"] == "given"
    assert cells["x_m2"]["rule"] == "(12a) x_m2,p = x_p,j/(1 - (beta + 1)/(alpha_p + 1)*e_j^2)"
    assert all(c["rule"] for c in cells.values())


def test_the_manifest_says_what_computed_it(report: Report) -> None:
    report = replace(report, engines=(Agreement(1, 0.0, "", (), engine="JavaScript", program="node 20.1"),))
    found = json.loads(view.manifest(report, {"b": b"2", "a": b"1"}, {"method": "00"}, "x86_64 X86_V2"))
    assert list(found) == [
        "schema", "title", "inputs", "outputs", "sources", "versions", "engines", "processor", "values",
    ]  # fmt: skip
    assert (found["processor"], found["values"]) == ("x86_64 X86_V2", "correctly rounded")
    assert list(found["outputs"]) == ["a", "b"]
    assert found["engines"] == {"JavaScript": "node 20.1"}
    assert found["sources"] == {"method": "00"}


def test_proofs_by_number(values: dict) -> None:  # type: ignore[type-arg]
    assert values["proofs"]["(11)"] == "proved"
    assert values["proofs"]["(12)"] == "proved with a correction of the print"
    assert values["proofs"]["(8)"] == "definition"


def test_what_proofs_rest_on(values: dict) -> None:  # type: ignore[type-arg]
    assert values["rests_on"]["(9)"] == ["(3)"]
    assert values["rests_on"]["(6)"] == ["(3)", "theorem of kinetic energy, compression"]
    assert values["rests_on"]["(L6)"] == []
    assert "(8)" not in values["rests_on"]  # a definition


def test_published(values: dict) -> None:  # type: ignore[type-arg]
    first = values["published"][0]
    assert (first["cell"], first["index"], first["printed"], first["verdict"]) == (
        "alpha",
        [1, 2],
        "1.234",
        "differs",
    )


def test_an_error_is_null_with_its_code(tmp_path: Path) -> None:
    """A pair without a root is a cell's error; the mean goes on and says over how many."""
    folder = shutil.copytree(PAPER, tmp_path / "f")
    table = folder / "measurements.csv"
    table.write_text(table.read_text().replace("29.7", "23.4"))
    toml = folder / "report.toml"
    toml.write_text(toml.read_text().partition("[published]")[0])  # the last table: nothing to compare with
    cells = json.loads(view.values(Study(folder).computed))["cells"]
    assert cells["alpha"]["value"][0] is None
    assert cells["alpha"]["status"][0] == "#NOROOT!"
    assert cells["C"]["status"][0] == "#NOROOT!"
    assert cells["alpha_mean"]["status"] == "ok"
    assert cells["alpha_mean"]["rows"] == {"pairs": 9}
