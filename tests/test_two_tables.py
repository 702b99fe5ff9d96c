"""Several tables of rows, each with its file: what is of one, and what leads to the other."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import two_tables
from two_tables import SAMPLES, SIGNALS, STANDARDS, TOML, U_SIGNALS, U_Y, C, Y, contents

import loopsheet
from loopsheet.report import build
from loopsheet.report.cli import main
from loopsheet.report.column import SheetError
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.inputs.inputs import Inputs
from loopsheet.report.judge.sample import part
from loopsheet.report.messages.errors import InputError
from loopsheet.report.method import words
from loopsheet.report.quantity import there
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.propagation import Spread
from loopsheet.report.views import live_files

SI = 1e-3  # mg/L in kg/m^3


def told(folder: Path) -> list[tuple[str, str, int | None]]:
    """What is wrong with a folder: code, file and line."""
    with pytest.raises(InputError) as error:
        _ = Study(folder).computed
    return [(d.code, Path(d.at.path).name, d.at.line) for d in error.value.diagnostics]


def test_the_values_are_those_of_numpy(tmp_path: Path) -> None:
    report = Study(two_tables.write(tmp_path)).computed
    slope, intercept, *found = contents(Y, SIGNALS)
    values = report.values
    assert values.scalar("m") == pytest.approx(slope / SI, rel=1e-13)
    assert values.scalar("b") == pytest.approx(intercept, rel=1e-12)
    assert values.value["x"] == pytest.approx(np.array(found) * SI, rel=1e-13)
    assert values.scalar("x_mean") == pytest.approx(np.mean(found) * SI, rel=1e-13)
    assert values.scalar("many") == 3
    assert values.labels(report.sheet["x"]) == [(1,), (2,), (4,)]
    assert values.labels(report.sheet["line_residual"]) == [(1,), (2,), (3,), (4,), (5,)]


def test_the_uncertainties_are_those_of_both_tables(tmp_path: Path) -> None:
    report = Study(two_tables.write(tmp_path)).computed
    every, step = np.concatenate([Y, SIGNALS]), 1e-7

    def mean(each: np.ndarray) -> float:
        return float(contents(each[:5], each[5:])[2:].mean())

    slopes = [(mean(every + step * e) - mean(every - step * e)) / (2 * step) for e in np.eye(8)]
    sizes = np.concatenate([np.full(5, U_Y), U_SIGNALS])
    u = float(np.hypot.reduce(np.array(slopes) * sizes))
    assert report.uncertain().u["x_mean"][0] == pytest.approx(u * SI, rel=1e-5)
    budget = report.uncertain().budgets[-1]
    assert {"y_s[4]", "y[4]"} <= {each.source.name for each in budget.contributions}


def test_draws_of_both_tables(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["budget", "x_mean", str(two_tables.write(tmp_path)), "--draws", "20000"]) == 0
    found = re.search(r"draws: median ([\d.]+) mg/L, u = ([\d.]+) mg/L", capsys.readouterr().out)
    assert found is not None
    rng = np.random.default_rng(1)
    y = Y + rng.normal(0, U_Y, (20_000, 5))
    drawn = contents(y, SIGNALS + rng.normal(size=(20_000, 3)) * U_SIGNALS)[:, 2:].mean(axis=1)
    assert [float(each) for each in found.groups()] == pytest.approx(
        [np.median(drawn), drawn.std()], rel=0.03
    )


def test_every_engine_proof_and_check_knows_both(
    tmp_path: Path, every_engine: Callable[..., str], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = two_tables.write(tmp_path)
    out = every_engine(folder)
    assert re.search(r"proofs +(\d+) of \1 equations stand", out)
    assert "standard 7, spilled" in out
    assert main(["prove", str(folder)]) == 0
    capsys.readouterr()
    assert main(["why", "x[4]", str(folder)]) == 0
    why = capsys.readouterr().out
    assert "y_s[4]" in why
    assert main(["why", "x[3]", str(folder)]) == 2
    assert "1, 2 or 4" in capsys.readouterr().err
    assert main(["why", "y[7]", str(folder)]) == 2
    assert "standard 7" in capsys.readouterr().err
    assert main(["why", "x[7]", str(folder)]) == 2  # that is no sample
    assert "spilled" not in capsys.readouterr().err


def test_a_build_has_a_table_and_a_fingerprint_of_each(tmp_path: Path) -> None:
    folder = two_tables.write(tmp_path / "in")
    out = tmp_path / "out"
    build.build(Study(folder), out, ("html", "latex", "xlsx", "json"))
    manifest = json.loads((out / "manifest.json").read_text(encoding="utf-8"))
    assert {"standards.csv", "samples/today.csv"} <= manifest["inputs"].keys()
    cells = json.loads((out / "values.json").read_text(encoding="utf-8"))["cells"]
    assert (cells["y"]["axis"], cells["x"]["axis"]) == ("standards", "samples")
    page = (out / "report.html").read_text(encoding="utf-8")
    standards, samples = (
        next(
            each for each in re.findall(r"<table.*?</table>", page, re.DOTALL) if f"data-cell={name} " in each
        )
        for name in ("y", "y_s")
    )
    assert "B-7" in samples
    assert "B-7" not in standards
    assert standards.count("<tr") == 1 + 6  # with the one that is left out
    assert samples.count("<tr") == 1 + 3
    assert main(["diff", str(out), str(out)]) == 0


def test_an_expectation_is_of_a_row_of_its_table(tmp_path: Path) -> None:
    lost = SAMPLES.replace("2,A-2,0.501,0.003", "2,A-2,,")
    more = (
        SAMPLES.splitlines()[0]
        + ",z [1]\n"
        + "\n".join(f"{line},{n}.5" for n, line in enumerate(lost.splitlines()[1:]))
    )
    code = two_tables.METHOD.replace(
        "    m = unknown", '    z = measured("1", "another", of=samples)\n    m = unknown'
    )
    folder = two_tables.write(
        tmp_path, workbook=code, today=more, report=f'{TOML}[expected]\n"sample 2" = "lost"\n'
    )
    report = Study(folder).computed
    assert [check.note for check in report.oddities if check.name == "cells"] == [""]
    assert all(check.passed for check in report.oddities)
    wrong = f'{TOML}[expected]\n"standard 2" = "lost"\n'
    again = Study(two_tables.write(tmp_path / "again", workbook=code, today=more, report=wrong)).computed
    assert not all(check.passed for check in again.oddities)
    assert told(two_tables.write(tmp_path / "no", report=f'{TOML}[expected]\n"test 2" = "lost"\n')) == [
        ("LS505", "report.toml", 14)
    ]
    assert told(two_tables.write(tmp_path / "none", report=f'{TOML}[expected]\n"sample 3" = "lost"\n')) == [
        ("LS506", "report.toml", 14)
    ]


def test_what_is_shared_or_goes_together_is_so_within_a_table(tmp_path: Path) -> None:
    shared = '[uncertainty.shared."drift"]\nof = "y_s"\nstated = "u = 0.001"\ngroups = [[1, 4]]\n'
    report = Study(two_tables.write(tmp_path, report=TOML + shared)).computed
    names = [each.source.name for each in report.uncertain().budgets[-1].contributions]
    assert "drift (samples 1, 4)" in names
    (drift,) = (check.message for check in report.oddities if check.name == "drift")
    assert drift.startswith("drift: sample 2 is in no group")
    outside = shared.replace("[[1, 4]]", "[[1, 5]]")
    assert told(two_tables.write(tmp_path / "no", report=TOML + outside)) == [("LS506", "report.toml", 16)]
    both = shared.replace('"y_s"', '["y", "y_s"]')
    assert told(two_tables.write(tmp_path / "rows", report=TOML + both)) == [("LS506", "report.toml", 16)]
    every = both.partition("groups")[0]  # of all rows of both tables
    report = Study(two_tables.write(tmp_path / "both", report=TOML + every)).computed
    moved = {column for source in Spread(report.inputs, report.values).sources if source.name == "drift"
             for column, _, _ in source.moves}  # fmt: skip
    assert moved == {"y", "y_s"}
    together = '[uncertainty.correlation]\n"y, y_s" = "0.5"\n'
    folder = two_tables.write(
        tmp_path / "together", report=TOML + together, today=SAMPLES + "5,C,.7,.002\n6,D,.8,.002\n"
    )
    assert told(folder) == [("LS434", "report.toml", 14)]  # though there are as many of each


def test_a_column_of_either_may_come_from_another_report(tmp_path: Path) -> None:
    other = two_tables.write(tmp_path / "first")
    build.build(Study(other), tmp_path / "other", ("json",))
    own = 'file = "samples/today.csv"\n'
    taken = (
        f'{own}[measurements.samples.taken]\ny_s = {{ from = "other/values.json", cell = "line_fitted" }}\n'
    )
    folder = two_tables.write(tmp_path, report=TOML.replace(own, taken), today="sample\n1\n2\n4\n")
    report = Study(folder).computed
    assert report.values.value["x"] == pytest.approx(C[[0, 1, 3]] * SI, rel=1e-12)  # read off its own line


def test_some_rows_of_each_are_judged_of_many(tmp_path: Path) -> None:
    rows = "".join(f"{n},S,0.{300 + n % 400},0.002\n" for n in range(1, 2001))
    folder = two_tables.write(tmp_path, today=SAMPLES.splitlines()[0] + "\n" + rows)
    report = Study(folder).computed
    some = part(report.inputs, report.marks.values, 500)
    assert len(some.on("standards").tests) == 5
    assert 10 < len(some.on("samples").tests) < 500


def test_in_python_each_row_has_its_name(tmp_path: Path) -> None:
    report = loopsheet.load(two_tables.write(tmp_path))
    assert report["x"].names == ("1 (A-1)", "2 (A-2)", "4 (B-7)")
    assert report["y"].names == ("1", "2", "3", "4", "5")
    assert report["x"].value == pytest.approx(contents(Y, SIGNALS)[2:], rel=1e-13)


def test_new_writes_a_file_of_each(tmp_path: Path) -> None:
    code = tmp_path / "calibration.py"
    code.write_text(two_tables.METHOD, encoding="utf-8")
    folder = tmp_path / "mine"
    assert main(["new", str(folder), "--workbook", str(code)]) == 0
    assert (folder / "standards.csv").read_text(encoding="utf-8").splitlines()[:2] == [
        "standard,c [mg/L],y [1]", "1,1.0,0.113",
    ]  # fmt: skip
    assert (folder / "samples.csv").read_text(encoding="utf-8").splitlines() == [
        "sample,y_s [1]", "1,0.314", "2,0.501",
    ]  # fmt: skip
    assert Study(folder).computed.values.scalar("many") == 2


# --- what is wrong ----------------------------------------------------------------------------------------


def test_a_table_without_its_place_or_its_file_is_told_where_it_stands(tmp_path: Path) -> None:
    none = TOML.replace('[measurements.samples]\nfile = "samples/today.csv"\n', "")
    assert told(two_tables.write(tmp_path / "none", report=none))[0][0] == "LS204"
    gone = two_tables.write(tmp_path / "gone")
    (gone / "samples" / "today.csv").unlink()
    ((code, file, line),) = told(gone)
    assert (file, line, code[:3]) == ("report.toml", 8, "LS1")
    one = TOML.replace('[measurements.standards]\nfile = "standards.csv"\n', "").replace(
        "[measurements.samples]", "[measurements]"
    )
    assert "LS203" in [code for code, _, _ in told(two_tables.write(tmp_path / "one", report=one))]
    path = TOML.replace('[measurements.standards]\nfile = "standards.csv"\n', "").replace(
        '[measurements.samples]\nfile = "samples/today.csv"\n', ""
    )
    above = path.replace("title", 'measurements = "standards.csv"\ntitle')
    assert [line for _, _, line in told(two_tables.write(tmp_path / "above", report=above))] == [1]
    within = f'{path}[measurements]\nstandards = "standards.csv"\nsamples = "samples/today.csv"\n'
    found = told(two_tables.write(tmp_path / "within", report=within))
    assert found == [("LS205", "report.toml", 10), ("LS205", "report.toml", 11)]
    broken = two_tables.write(tmp_path / "broken", workbook="no python", samples="sample,y_s [1]\nx,1\n")
    assert [code for code, _, _ in told(broken)] == ["LS213"]
    other = TOML.replace("measurements.samples", "measurements.sample")
    assert told(two_tables.write(tmp_path / "other", report=other))[0] == ("LS203", "report.toml", 7)


def test_a_column_in_the_wrong_table_is_told_where_it_belongs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    today = "sample,y [1],y_s [1]\n1,0.1,0.314\n2,0.2,0.501\n"
    folder = two_tables.write(tmp_path, today=today)
    assert told(folder) == [("LS303", "today.csv", 1)]
    assert main(["build", str(folder)]) == 2
    assert (
        "y is a column of the standards, [measurements.standards]: it belongs there"
        in capsys.readouterr().err
    )


def test_two_tables_are_two_files_and_one_of_words_alone_is_empty(tmp_path: Path) -> None:
    both = TOML.replace("samples/today.csv", "./standards.csv")
    assert told(two_tables.write(tmp_path / "both", report=both)) == [("LS216", "report.toml", 8)]
    empty = two_tables.write(tmp_path / "empty", today="sample,lot,y_s [1]\n")
    assert told(empty) == [("LS310", "today.csv", 1)]


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "x = let(y_s / y, 'ratio')",
            "names standards and samples, which are rows of two tables: take a mean",
        ),
        ("x = let(mean(y_s / y), 'ratio')", "rows of two tables"),
        ("d = measured('1', 'd', of=y)", "of=y[k] is none of what rows() returned"),
        (
            "d = measured('1', 'd', of='samples')",
            "d: of='samples' is none of what rows() returned: write of=samples",
        ),
        ("x = let(mean(y_s, of=samples), 'mean')", "without a word"),
        ("a = unknown('a'); line = fit(y, a * y_s)", "rows of two tables: take a mean"),
        ("plot(y, y_s)", "no columns of the same rows: y is of the standards, y_s is of the samples"),
        (
            "more = rows('blanks')",
            "nothing is measured of the blanks: what stands in their table says so, measured(..., of=more)",
        ),
        ("more = rows('samples')", "samples are rows already"),
        ("more = rows('standard')", "standard are rows already"),
        ("more = rows('file')", "is a key of [measurements]"),
        ("more = rows('a b')", "needs names"),
        ("k_samples = let(mean(y_s), 'mean')", "k_samples is the sample's number"),
    ],
)
def test_a_line_that_takes_rows_for_others_is_refused(line: str, said: str) -> None:
    code = (
        "from loopsheet.report.method.words import *\n"
        "class Two(Method, source='', rows='standards'):\n"
        "    samples = rows('samples')\n"
        "    y = measured('1', 'signal')\n"
        "    y_s = measured('1', 'signal of a sample', of=samples)\n"
        f"    {line}\n    z = let(mean(y), 'mean')\n"
    )
    with pytest.raises(SheetError, match=re.escape(said)):
        exec(compile(code, "two.py", "exec"), {})


def test_one_further_table_alone_is_written_as_the_only_one() -> None:
    class One(words.Method, source=""):
        """One."""

        samples = words.rows("samples")
        y = words.measured("1", "signal", of=samples)
        z = words.let(words.mean(y), "mean")

    workbook = One.workbook
    assert not workbook.several
    assert (workbook.row_tables[0].place, workbook.row) == (("measurements",), "sample")
    assert C.size == Y.size
    assert STANDARDS


def numbers(inputs: Inputs) -> dict[str, list[tuple[str, float]]]:
    """What is measured, as it stands, with its uncertainty."""
    return {name: [(each.text, each.u) for each in there(column)] for name, column in inputs.measured.items()}


def saved_by_the_page(folder: Path, into: Path) -> Path:
    """The files as Save gives them after no edit."""
    report = Study(folder).computed
    page = live_files.given(report)
    files = {
        each["file"]: (folder / table.file).read_text(encoding="utf-8")
        for each, table in zip(page["tables"].values(), report.inputs.tables, strict=True)
    }
    pieces = (
        piece if isinstance(piece, str) else piece.get("file", piece.get("parameter"))
        for piece in page["toml"]
    )
    names = [*files, "report.toml", *page["files"]]
    assert len(names) == len({name.casefold() for name in names})
    for name, text in (files | {"report.toml": "".join(pieces)} | page["files"]).items():
        into.mkdir(exist_ok=True)
        (into / name).write_text(text, encoding="utf-8")
    return into


SPELLED = {
    "plainly": TOML,
    "with dots": TOML.replace("[measurements.samples]\nfile", "[measurements]\nsamples.file"),
    "as a table in a line": re.sub(
        r"\[measurements\.(\w+)\]\n(.*)", r"measurements.\1 = { \2 }", TOML.replace("\n\n", "\n")
    ),
    "in quotes": TOML.replace("[measurements.samples]\nfile", "[measurements.'samples']\n\"file\""),
    "in three quotes": TOML.replace('"samples/today.csv"', '"""samples/today.csv"""'),
    "with an escape": TOML.replace("samples/today", "samples\\u002ftoday"),
}


@pytest.mark.parametrize("spelled", SPELLED)
def test_a_file_in_a_folder_is_saved_beside_the_others_and_named_so(tmp_path: Path, spelled: str) -> None:
    issued = two_tables.write(tmp_path / "issued", report=SPELLED[spelled])
    again = Study(saved_by_the_page(issued, tmp_path / "saved")).inputs
    assert [table.file for table in again.tables] == ["standards.csv", "samples-today.csv"]
    assert numbers(again) == numbers(Study(issued).inputs)


def test_no_saved_file_has_the_name_of_another(tmp_path: Path) -> None:
    """A folder may have a file whose name is what that of another becomes, which would be lost."""
    issued = two_tables.write(tmp_path / "issued", report=TOML.replace("standards.csv", "Samples-today.csv"))
    (issued / "standards.csv").rename(issued / "Samples-today.csv")
    again = Study(saved_by_the_page(issued, tmp_path / "saved")).inputs
    assert [table.file for table in again.tables] == ["Samples-today.csv", "_samples-today.csv"]
    assert numbers(again) == numbers(Study(issued).inputs)


def test_a_saved_table_of_draws_is_named_as_it_is_saved(tmp_path: Path) -> None:
    (tmp_path / "issued" / "balance").mkdir(parents=True)
    draws = "".join(f"{8.366 + n / 1e5:.5f}\n" for n in range(-60, 61))
    (tmp_path / "issued" / "balance" / "mass.csv").write_text(f"ball_mass [g]\n{draws}")
    for name in ("measurements.csv", "report.toml"):
        (tmp_path / "issued" / name).write_bytes((PAPER / name).read_bytes())
    toml = (
        'workbook = "soft_impact"\n[parameters]\nball_mass = "8.366 g, samples = balance/mass.csv"\n'
        '[measurements]\nfile = "measurements.csv"\n'
    )
    (tmp_path / "issued" / "report.toml").write_text(toml)
    pieces = live_files.given(Study(tmp_path / "issued").computed)["toml"]
    text = "".join(each if isinstance(each, str) else each.get("file", "") for each in pieces)
    assert ' g, samples = balance-mass.csv"\n' in text
