"""The pytest plugin as a user has it: real runs of pytest in folders of their own."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from helpers import method_folder

from loopsheet.report.engines import ENGINES
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.inputs.published import PublishedValue
from loopsheet.report.pytest_plugin import FolderChecks, _is_ours
from loopsheet.report.result.findings import checks, names_of


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Pytest in a process of its own, in a folder, with no settings of ours."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-W", "error", *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    """A folder of one's own, in a project of one's own."""
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    return shutil.copytree(PAPER, tmp_path / "steel")


OWN = "--loopsheet-run-workbook"
DOUBLED = """from loopsheet import Method, claim, let, measured


class Doubled(Method, rows="readings"):
    "Twice a length."
    x = measured("mm", "a length")
    y = let(2 * x, "twice it", "mm")
    claim(x + y, 3 * x, "three", label="(A)")
    claim(y - x, x, "one", label="(B)")
"""


@pytest.fixture
def doubled(tmp_path: Path) -> Path:
    """A small method, in a project of one's own."""
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    return method_folder(tmp_path / "own", DOUBLED, "reading,x [mm]\n1,1.23\n2,1.25\n3,1.31\n")


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def failed(output: str) -> list[str]:
    """The ids of the tests that the summary names."""
    return [line.split(" - ")[0].removeprefix("FAILED ") for line in output.splitlines() if "FAILED " in line]


def test_every_check_is_a_test(campaign: Path) -> None:
    done = run(campaign.parent, "--collect-only", "--strict-markers", "-m", "loopsheet")
    assert done.returncode == 0, done.stdout + done.stderr
    ids = [line for line in done.stdout.splitlines() if "::" in line]
    assert ids[:3] == [f"steel/report.toml::engine::{name}" for name in ENGINES]
    assert "steel/report.toml::proof::(11)" in ids
    assert "steel/report.toml::published::alpha[1-2]" in ids
    assert "steel/report.toml::table::Table 2" in ids
    assert len(ids) == len(set(ids)) == 3 + 86 + 27 + 5 + 3 + 12 + 1


@pytest.mark.parametrize("name", ["gum_h1", "gum_h3", "misra1a", "worked_example", "ea_s9"])
def test_a_test_is_planned_for_every_check(name: str) -> None:
    """What is asked for by name alone, and what is found: a check that only one of them has is never told."""
    folder = FolderChecks(PAPER.parent / name, own_code=True)
    planned = {(kind, each) for kind, names in folder.plan().items() for each in names if kind != "engine"}
    proofs = {("proof", equation.label) for equation in folder.study.ledger.equations()}
    assert planned == proofs | {(check.kind, check.name) for check in checks(folder.study.refereed)}


def test_the_inputs_in_a_crate_are_tests_where_their_folder_is_not(campaign: Path) -> None:
    crate = campaign / "out"
    shutil.copytree(PAPER, crate / "inputs")
    (crate / "manifest.json").write_text("{}")
    assert run(campaign.parent, "--collect-only", "-k", "engine").stdout.count("report.toml::engine") == 3
    crate.rename(campaign.parent / "crate")
    there = run(campaign.parent, "--collect-only", "-k", "engine").stdout
    assert there.count("steel/report.toml::engine") == there.count("crate/inputs/report.toml::engine") == 3


def test_a_test_is_selected_by_its_id_and_passes(campaign: Path) -> None:
    ids = [f"report.toml::{name}" for name in ("published::alpha[1-2]", "proof::(11)", "engine::numpy")]
    listed = run(campaign, "--collect-only", *ids)
    assert [line.removeprefix("steel/") for line in listed.stdout.splitlines() if "::" in line] == ids
    done = run(campaign, *ids[1:])
    assert done.returncode == 0, done.stdout + done.stderr
    assert "2 passed" in done.stdout


def test_a_published_value_that_differs_fails_alone_and_says_which(campaign: Path) -> None:
    published = campaign / "published.csv"
    some = published.read_text().splitlines(keepends=True)[:5]
    published.write_text("".join(some).replace("alpha,1-2,1.234", "alpha,1-2,1.239"))
    done = run(campaign.parent, "-k", "published")
    assert done.returncode == 1
    assert failed(done.stdout) == ["steel/report.toml::published::alpha[1-2]"]
    said = "steel/published.csv:2:19: Table 2 alpha[1-2] prints 1.239, recomputed 1.258, and differs"
    assert said in done.stdout
    assert "3 passed" in done.stdout
    alike = run(campaign.parent, "-k", "published", "--numprocesses", "2", "--dist", "loadfile")
    assert (failed(alike.stdout), alike.returncode) == (failed(done.stdout), 1)
    assert "3 passed" in alike.stdout
    assert "Traceback" not in done.stdout
    assert "pytest_plugin.py" not in done.stdout


def test_what_is_odd_about_the_data_fails_or_warns(campaign: Path) -> None:
    edit(campaign / "measurements.csv", "29.7", "2.97")
    edit(campaign / "measurements.csv", "2.334", "0.02334")
    done = run(campaign.parent, "-k", "data or limit", "-W", "default")
    assert done.returncode == 1, done.stdout + done.stderr
    assert failed(done.stdout) == [f"steel/report.toml::data::{name}" for name in ("cells", "rows", "result")]
    assert "steel/measurements.csv:3:3: alpha: " in done.stdout
    assert "look at test 2 first" in done.stdout
    assert "steel/measurements.csv:2: PytestWarning: v: 1 of 5 tests: a speed of no drop test" in done.stdout


def test_an_equation_that_does_not_hold_fails_and_says_which(doubled: Path) -> None:
    edit(doubled / "workbook.py", "claim(y - x, x,", "claim(y - x, 2 * x,")
    done = run(doubled.parent, OWN, "-k", "proof")
    assert done.returncode == 1, done.stdout + done.stderr
    assert failed(done.stdout) == ["own/report.toml::proof::(B)"]
    assert "(B) is refuted: at " in done.stdout
    assert "the sides are" in done.stdout
    assert " passed" in done.stdout


WRONG_ENGINE = """
from loopsheet.report.engines import javascript
program = javascript.program
javascript.program = lambda *a, **k: program(*a, **k).replace("2*$x", "3*$x", 1)
"""


def test_an_engine_that_computes_wrongly_fails_and_says_which(doubled: Path) -> None:
    if shutil.which("node") is None:
        pytest.skip("needs node on the PATH")
    (doubled / "conftest.py").write_text(WRONG_ENGINE)
    done = run(doubled.parent, OWN, "-k", "numpy or JavaScript")
    assert done.returncode == 1
    assert failed(done.stdout) == ["own/report.toml::engine::JavaScript"]
    assert "JavaScript is off by" in done.stdout
    assert "1 passed" in done.stdout


def test_a_program_that_is_missing_is_a_skip(campaign: Path) -> None:
    (campaign / "conftest.py").write_text(
        "import shutil\nwhich = shutil.which\nshutil.which = lambda name, *a, **k: which('no such ' + name)\n"
    )
    done = run(campaign.parent, "-rs", "-k", "JavaScript")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "1 skipped" in done.stdout
    assert "JavaScript was not compared" in done.stdout


MISTAKES = {
    "number": ("measurements.csv", "0.512", "abc", "number/measurements.csv:3:9"),
    "workbook": ("report.toml", '"soft_impact"', '"soft_impct"', "did you mean 'soft_impact'?"),
    "toml": ("report.toml", "[measurements]", "[measurements", "toml/report.toml:11:"),
    "cell": ("published.csv", "Table 2,alpha,1-2", "Table 2,alfa,1-2", "cell/published.csv:2:9"),
    "index": ("published.csv", "Table 2,alpha,1-2", "Table 2,alpha,1-9", "alpha has no index '1-9'"),
}


def test_a_broken_folder_is_one_located_message(tmp_path: Path) -> None:
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    for name, (file, old, new, _) in MISTAKES.items():
        edit(shutil.copytree(PAPER, tmp_path / name) / file, old, new)
    done = run(tmp_path)
    assert done.returncode == 2
    for name, (_, _, _, said) in MISTAKES.items():
        assert f"ERROR {name}/report.toml" in done.stdout
        assert said in done.stdout
    assert f"{len(MISTAKES)} errors" in done.stdout
    assert "Traceback" not in done.stdout
    assert "pytest_plugin.py" not in done.stdout


def test_without_a_report_nothing_is_loaded(tmp_path: Path) -> None:
    """Another tool's report.toml is none either."""
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    (tmp_path / "report.toml").write_text('[report]\nname = "coverage"\n')
    (tmp_path / "test_it.py").write_text(
        "import sys\n"
        "def test_it(pytestconfig):\n"
        "    assert pytestconfig.pluginmanager.has_plugin('loopsheet')\n"
        "    heavy = ('numpy', 'sympy', 'pint', 'loopsheet.report.build', 'loopsheet.report.study')\n"
        "    assert [name for name in heavy if name in sys.modules] == []\n"
    )
    done = run(tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "1 passed" in done.stdout


@pytest.mark.parametrize(
    ("text", "ours"),
    [
        ('workbook = "soft_impact"\n[measurements]\nfile = "m.csv"\n', True),
        ('workbook = "soft_impct"\n[parameters]\n', True),
        ("workbook = 7\n[measurements]\n", True),
        ('workbook = "soft_impact\n[measurements]\n', True),
        ('workbook = "sales.xlsx"\n', False),
        ("[measurements]\n", False),
        ("", False),
        ("not toml", False),
        ("workbook = [\n", False),
        ('workbook = "x"\n[measurements]\n' + "#" * 300_000, False),
        ("a = " + "[" * 5000, False),
        ("\x00\xff", False),
    ],
)
def test_what_is_ours(text: str, ours: bool, tmp_path: Path) -> None:
    (tmp_path / "report.toml").write_text(text)
    assert _is_ours(tmp_path / "report.toml") is ours


@pytest.mark.parametrize("text", ['workbook = "soft_impact"\n[measurement]\n', 'workbok = "x"\n', ""])
def test_what_is_broken_is_ours_by_what_stands_beside_it(text: str, tmp_path: Path) -> None:
    found = tmp_path / "report.toml"
    found.write_text(text)
    assert not _is_ours(found)
    (tmp_path / "measurements.csv").write_text("test,v [m/s]\n")
    assert _is_ours(found) is bool(text)
    (tmp_path / "workbook.py").write_text("from somewhere import Method\n")
    assert _is_ours(found) is bool(text)
    (tmp_path / "workbook.py").write_text("from loopsheet import Method\n")
    assert _is_ours(found)


def test_what_cannot_be_read_is_not_ours(tmp_path: Path) -> None:
    assert not _is_ours(tmp_path)
    assert not _is_ours(tmp_path / "nothing")


def test_a_cell_that_two_sources_print_is_told_apart() -> None:
    values = [
        PublishedValue(source, cell, index, None)  # type: ignore[arg-type]
        for source, cell, index in [("A", "x", (1,)), ("B", "x", (1,)), ("A", "x", (2,)), ("B", "y", ())]
    ]
    assert names_of(values) == ["x[1] (A)", "x[1] (B)", "x[2]", "y"]
