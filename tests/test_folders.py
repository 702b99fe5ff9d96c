"""FOLDER means the same in every verb: what is named, where one stands, or the shipped paper."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from small_report import FILES

from loopsheet.report.cli import main
from loopsheet.report.inputs import folders
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.verbs import VERBS

Run = Callable[..., tuple[int, str, str]]


pytestmark = pytest.mark.usefixtures("keeping")


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Give `run("build", "gauge", at=folder)`: the exit code, what was printed and what was complained."""

    def run(*arguments: str, at: Path = tmp_path) -> tuple[int, str, str]:
        with monkeypatch.context() as patch:
            patch.chdir(at)
            code = main(arguments)
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return run


def files(folder: Path) -> list[str]:
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.suffix == ".json")


def test_a_verb_works_where_one_stands_and_on_what_is_named(gauge: Path, run: Run) -> None:
    for verb in (["show", "l"], ["why", "l[1]"], ["prove", "(H.1)"], ["check", "--accept"]):
        here, there = run(*verb, at=gauge), run(*verb, "gauge")
        assert here == (there[0], there[1].replace("gauge/", ""), there[2])
        assert here[0] == 0


@pytest.mark.parametrize(
    "verb", [["build"], ["check"], ["prove"], ["prove", "11"], ["show", "l"], ["why", "l"]]
)
def test_where_there_is_no_report_both_ways_are_named(verb: list[str], gauge: Path, run: Run) -> None:
    code, out, err = run(*verb)
    assert (code, out) == (2, "")
    assert err.startswith(
        "error[LS615]: no FOLDER is named, and the working directory holds no report.toml\n"
    )
    assert "a folder that holds a report.toml, or the word 'paper' for the shipped campaign" in err
    assert "name 'gauge' or 'paper'; 'loopsheet new FOLDER' makes" in err
    assert files(gauge.parent) == []


def test_the_report_goes_into_its_folder_and_the_first_line_says_so(gauge: Path, run: Run) -> None:
    code, out, _ = run("build", "gauge", "--to", "json")
    assert (code, out.splitlines()[0]) == (0, "building 'End gauge' from gauge/report.toml into gauge/out")
    assert files(gauge.parent) == ["gauge/out/manifest.json", "gauge/out/values.json"]
    code, out, _ = run("build", "--to", "json", at=gauge)
    assert (code, out.splitlines()[0]) == (0, "building 'End gauge' from report.toml into out")
    assert files(gauge.parent) == ["gauge/out/manifest.json", "gauge/out/values.json"]
    code, out, _ = run("build", "gauge", "--to", "json", "--out", "site")
    assert (code, out.splitlines()[0]) == (0, "building 'End gauge' from gauge/report.toml into site")
    assert "site/values.json" in files(gauge.parent)


def test_the_paper_is_a_word_and_its_report_goes_to_where_one_stands(
    gauge: Path, tmp_path_factory: pytest.TempPathFactory, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a small report in the place of the paper's, which takes longer."""
    monkeypatch.setattr(folders, "PAPER", gauge)
    here = tmp_path_factory.mktemp("here")
    code, out, _ = run("build", "paper", "--to", "json", at=here)
    assert (code, out.splitlines()[0]) == (0, "building 'End gauge' from the shipped paper into out")
    assert files(here) == ["out/manifest.json", "out/values.json"]
    assert files(gauge) == []
    for words in ([], ["paper"], ["out"]):
        assert run("verify", "--run-workbook", *words, at=here)[1].splitlines()[-1] == "the same report again"


def test_a_folder_that_is_called_as_the_paper_is_not_taken_for_it(gauge: Path, run: Run) -> None:
    gauge.rename(gauge.parent / "paper")
    code, out, err = run("show", "l", "paper")
    assert (code, out) == (2, "")
    assert "error[LS616]: 'paper' is the word for the shipped campaign, and a folder here" in err
    assert "allowed: ./paper for the folder" in err
    assert run("show", "l", "./paper")[0] == 0
    assert run("prove", "paper")[0] == 2


def test_prove_takes_a_folder_alone(gauge: Path, run: Run) -> None:
    assert run("prove", "gauge") == run("prove", at=gauge)
    assert run("prove", "gauge")[1].startswith("(H.1)")


@pytest.mark.parametrize("there", ["inside", "elsewhere"])
def test_verify_needs_no_folder(there: str, gauge: Path, run: Run) -> None:
    out = [] if there == "inside" else ["--out", "../site"]
    assert run("build", "--to", "json", *out, at=gauge)[0] == 0
    ways = [([], gauge), (["gauge"], gauge.parent), (["gauge/out"], gauge.parent)]
    for words, at in ways if there == "inside" else [(["../site"], gauge)]:
        code, said, err = run("verify", "--run-workbook", *words, at=at)
        assert code == 0, said + err
        assert said.splitlines()[-1] == "the same report again"


def test_verify_of_another_folders_output_is_not_that_of_where_it_lies(gauge: Path, run: Run) -> None:
    """What was built from one folder into another's `out` is compared with what it was built from."""
    other = shutil.copytree(gauge, gauge.parent / "other")
    (other / "d.csv").write_text("test,d [nm]\n1,216\n2,205\n")
    code, said, _ = run("build", "../gauge", "--to", "json", "--out", "out", at=other)
    assert (code, said.splitlines()[0].partition(" into ")[2]) == (0, "out, where that of report.toml goes")
    assert run("verify", "--run-workbook", "other/out", at=gauge.parent)[0] == 1
    assert (
        run("verify", "--run-workbook", "../other/out", at=gauge)[1].splitlines()[-1]
        == "the same report again"
    )


def test_one_word_is_enough_where_a_report_goes_into_its_own_folder(gauge: Path, run: Run) -> None:
    assert run("build", "gauge", "--to", "json", "--out", "gauge")[0] == 0
    for words, at in ((["gauge"], gauge.parent), (["."], gauge)):
        code, said, err = run("verify", "--run-workbook", *words, at=at)
        assert (code, said.splitlines()[-1:]) == (0, ["the same report again"]), err
    assert run("crate", "gauge", "--date", "2026-03-31", "--license", "CC-BY-4.0")[0] == 0
    (gauge / "d.csv").write_text("test,d [nm]\n1,216\n2,204\n")
    code, said, _ = run("verify", "--run-workbook", "gauge")
    assert (code, said.splitlines()[-1]) == (1, "different: the input (d.csv) changed")


def test_verify_names_the_input_that_changed_since(gauge: Path, run: Run) -> None:
    assert run("build", "--to", "json", at=gauge)[0] == 0
    (gauge / "d.csv").write_text("test,d [nm]\n1,216\n2,204\n")
    code, said, _ = run("verify", "--run-workbook", "gauge")
    assert (code, said.splitlines()[-1]) == (1, "different: the input (d.csv) changed")


def test_two_results_are_named_by_their_folders(gauge: Path, run: Run) -> None:
    shutil.copytree(gauge, gauge.parent / "other")
    for name in ("gauge", "other"):
        assert run("build", name, "--to", "json")[0] == 0
    assert run("diff", "gauge", "other/out")[0] == 0


@pytest.mark.parametrize("arguments", [["build", ""], ["build", "--out", ""], ["verify", " "], ["new", ""]])
def test_an_empty_name_is_no_folder(arguments: list[str], gauge: Path, run: Run) -> None:
    """A script's variable that was never set must not mean the working directory."""
    code, out, err = run(*arguments, at=gauge)
    assert (code, out) == (2, "")
    assert "error[LS617]: argument " in err
    assert "the name of a folder is empty" in err
    assert files(gauge) == []


@pytest.mark.parametrize("words", ["", ",", " , "])
def test_no_format_is_not_a_format(words: str, gauge: Path, run: Run) -> None:
    code, out, err = run("build", "--to", words, at=gauge)
    assert (code, out) == (2, "")
    assert f"error[LS604]: unknown format '{words}'" in err
    assert files(gauge) == []


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], ["LS617]: no command is named", "allowed: build, watch, check,", "'loopsheet new my-campaign'"]),
        (["biuld"], ["LS604]: unknown command 'biuld'", "did you mean 'build'?"]),
        (["--traceback", "xyz"], ["LS604]: unknown command 'xyz'", "allowed: build, watch, check,"]),
        (["gauge"], ["LS604]: unknown command 'gauge'", "'loopsheet build gauge' builds that folder"]),
        (["build", "--otu", "x"], ["LS604]: unknown option '--otu'", "did you mean '--out'?"]),
        (["show", "gauge", "d"], ["LS617]: 'gauge' is a folder", "'loopsheet show d gauge'"]),
        (["prove", "paper", "(11)"], ["LS617]: 'paper' is a folder", "'loopsheet prove '(11)' paper'"]),
        (["why", "gauge"], ["LS617]: 'gauge' is a folder", "'loopsheet why CELL gauge'"]),
        (["new", "x", "--workbook", "mine.py"], ["LS617]: there is no such file: 'mine.py'"]),
        (["build", "a", "b"], ["LS617]: 'b' is a word too many", "'loopsheet build --help'"]),
        (["show"], ["LS617]: the following arguments are required: CELL", "'loopsheet show --help'"]),
    ],
)
def test_a_wrong_command_line_is_answered_as_all_else_is(
    arguments: list[str], said: list[str], gauge: Path, run: Run
) -> None:
    code, out, err = run(*arguments)
    assert (code, out) == (2, "")
    assert [words for words in said if words not in err] == [], err
    assert not [line for line in err.splitlines() if line.startswith("usage:")]


@pytest.mark.parametrize(
    "words",
    [("show", "l", "--plan", "gauge"), ("show", "l", "gauge", "--plan"), ("show", "--plan", "l", "gauge")],
)
def test_options_stand_anywhere(words: tuple[str, ...], gauge: Path, run: Run) -> None:
    assert run(*words)[:2] == run("show", "l", "gauge", "--plan")[:2]
    assert run(*words)[0] == 0


def test_the_file_that_makes_a_folder_one_names_it(gauge: Path, run: Run) -> None:
    assert run("show", "l", "gauge/report.toml") == run("show", "l", "gauge")


def test_what_is_no_folder_is_not_made_one(gauge: Path, run: Run) -> None:
    code, _, err = run("build", "nowhere")
    assert (code, err.splitlines()[0]) == (2, "error[LS101]: no such folder: 'nowhere'")


def test_new_says_how_its_folder_is_named(tmp_path: Path, run: Run) -> None:
    last = {name: run("new", name)[1].splitlines()[-1] for name in ("mine", "paper", "my own")}
    assert [line.removeprefix("edit them, then: loopsheet build ") for line in last.values()] == [
        "mine",
        "./paper",
        "'my own'",
    ]
    assert (tmp_path / "paper" / "report.toml").is_file()


def test_the_shipped_papers_differences_are_not_accepted(run: Run) -> None:
    before = (PAPER / "published.csv").read_bytes()
    code, _, err = run("check", "--accept", "paper")
    assert (code, "LS614" in err) == (2, True)
    assert (PAPER / "published.csv").read_bytes() == before


def test_every_verb_says_what_its_folder_is(capsys: pytest.CaptureFixture[str]) -> None:
    for verb in sorted(VERBS.keys() - {"new", "verify", "validate", "crate", "diff", "schema"}):
        with pytest.raises(SystemExit):
            main([verb, "--help"])
        help = " ".join(capsys.readouterr().out.split())
        assert "(default: the working directory), or 'paper' for the shipped paper" in help, verb


# --- what is there already --------------------------------------------------------------------------------


def test_an_output_that_somebody_changed_is_kept_and_told(gauge: Path, run: Run) -> None:
    assert run("build", "gauge", "--to", "json,latex")[0] == 0
    tex = gauge / "out" / "report.tex"
    built = tex.read_bytes()
    for number, kept in enumerate(("report.edited.tex", "report.edited-2.tex")):
        tex.write_text(f"mine {number}")
        code, out, _ = run("build", "gauge", "--to", "json,latex")
        assert (code, tex.read_bytes()) == (0, built)
        assert (gauge / "out" / kept).read_text() == f"mine {number}"
        assert out.splitlines()[1] == f"report.tex was not as built: it is kept as {kept}"
    before = sorted((gauge / "out").iterdir())
    assert "kept" not in run("build", "gauge", "--to", "json,latex")[1]
    assert sorted((gauge / "out").iterdir()) == before


def test_an_edited_output_that_is_not_built_again_does_not_pass_for_a_part_of_the_report(
    gauge: Path, run: Run
) -> None:
    assert run("build", "gauge", "--to", "json,latex")[0] == 0
    (gauge / "out" / "report.tex").write_text("mine")
    (gauge / "d.csv").write_text("test,d [nm]\n1,216\n2,204\n")
    told = run("build", "gauge", "--to", "json")[1]
    assert "report.tex was not as built: it is kept as report.edited.tex" in told
    assert sorted(p.name for p in (gauge / "out").iterdir()) == [
        "manifest.json",
        "report.edited.tex",
        "values.json",
    ]
    assert (gauge / "out" / "report.edited.tex").read_text() == "mine"


def test_what_no_build_made_is_kept_as_well(gauge: Path, run: Run) -> None:
    assert run("build", "gauge", "--to", "json")[0] == 0
    (gauge / "out" / "report.tex").write_text("mine")
    told = "report.tex was not as built: it is kept as report.edited.tex"
    assert run("build", "gauge", "--to", "json,latex")[1].splitlines()[1] == told
    assert (gauge / "out" / "report.edited.tex").read_text() == "mine"


def test_what_somebody_did_to_an_output_is_a_warning(gauge: Path, run: Run) -> None:
    assert run("build", "gauge", "--to", "json")[0] == 0
    assert "as it was built" not in run("check", "gauge")[1]
    (gauge / "out" / "values.json").write_text("mine")
    said = "gauge/out is not as it was built, values.json: 'loopsheet verify' tells more"
    assert said in run("check", "gauge")[1]
    (gauge / "out" / "values.json").unlink()
    assert said in run("check", "gauge")[1]
    manifest = gauge / "out" / "manifest.json"
    manifest.write_text("{")
    said = "gauge/out/manifest.json is damaged, so that nobody can tell whether gauge/out is as it was built"
    assert said in run("check", "gauge")[1]
    manifest.unlink()
    manifest.mkdir()
    assert said in run("check", "gauge")[1]
    manifest.rmdir()
    assert (
        "manifest.json" not in run("check", "gauge")[1]
    )  # of a folder that no build has written nothing is said
    (gauge / "out" / "values.json").write_text("mine")
    assert said.replace("damaged", "missing") in run("check", "gauge")[1]


def test_nothing_is_built_among_the_files_of_others(gauge: Path, run: Run) -> None:
    (gauge / "site").mkdir()
    for name in ("values.json", "manifest.json"):
        (gauge / "site" / name).write_text('{"name": "my site"}')
    code, _, told = run("build", "gauge", "--to", "json", "--out", "gauge/site")
    assert (code, files(gauge)) == (2, ["site/manifest.json", "site/values.json"])
    assert "what no build has written: manifest.json and values.json" in told
    for name in ("values.json", "manifest.json"):
        assert (gauge / "site" / name).read_text() == '{"name": "my site"}'


def test_a_build_of_other_inputs_keeps_nothing_of_what_was_built(gauge: Path, run: Run) -> None:
    assert run("build", "gauge", "--to", "json")[0] == 0
    (gauge / "d.csv").write_text("test,d [nm]\n1,216\n2,204\n")
    assert "kept" not in run("build", "gauge", "--to", "json")[1]
    assert files(gauge) == ["out/manifest.json", "out/values.json"]


def test_if_the_move_fails_no_copy_is_left(gauge: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run("build", "gauge", "--to", "json")[0] == 0
    (gauge / "out" / "values.json").write_text("mine")
    before = {path: path.read_bytes() for path in (gauge / "out").iterdir()}
    real, failed = os.replace, []

    def fail(source: Path, target: Path) -> None:
        if Path(target) == Path("gauge/out/manifest.json") and not failed:
            failed.append(target)
            raise OSError(28, "No space left on device")
        real(source, target)

    monkeypatch.setattr(os, "replace", fail)
    code, out, err = run("build", "gauge", "--to", "json")
    monkeypatch.undo()
    assert (code, "LS601" in err, "kept" in out) == (2, True, False)
    assert {path: path.read_bytes() for path in (gauge / "out").iterdir()} == before


def test_what_a_killed_build_had_put_in_place_is_nobodys_edit(gauge: Path, run: Run) -> None:
    """It had moved values.json, and its manifest not yet."""
    assert run("build", "gauge", "--to", "json")[0] == 0
    old = (gauge / "out" / "manifest.json").read_bytes()
    (gauge / "d.csv").write_text("test,d [nm]\n1,216\n2,204\n")
    assert run("build", "gauge", "--to", "json")[0] == 0
    (gauge / "out" / ".loopsheet-abcd1234").mkdir()
    (gauge / "out" / "manifest.json").rename(gauge / "out" / ".loopsheet-abcd1234" / "manifest.json")
    (gauge / "out" / "manifest.json").write_bytes(old)
    (gauge / "d.csv").write_text("test,d [nm]\n1,217\n2,204\n")
    code, out, _ = run("build", "gauge", "--to", "json")
    assert (code, "kept" in out) == (0, False)
    assert sorted(path.name for path in (gauge / "out").iterdir()) == ["manifest.json", "values.json"]


# --- a crate whose report goes on ---------------------------------------------------------------------------

CRATE = ("crate", "--date", "2026-03-31", "--license", "MIT")


@pytest.fixture
def edited(gauge: Path, run: Run) -> Path:
    """A folder with a crate in it, whose inputs were edited since."""
    assert run("build", "--to", "json", at=gauge)[0] == 0
    assert run(*CRATE, at=gauge)[0] == 0
    (gauge / "report.toml").write_text((gauge / "report.toml").read_text() + "# edited\n")
    return gauge


def test_a_folder_is_verified_by_what_it_holds_and_not_by_the_copies_of_a_crate(
    edited: Path, run: Run
) -> None:
    for code, out, _ in (
        run("verify", "--run-workbook", at=edited),
        run("verify", "gauge", "--run-workbook"),
        run("verify", "gauge/out", "--run-workbook"),
    ):
        assert code == 1
        assert "the input report.toml was changed\n" in out
    (edited / "out").rename(edited / "archive")  # a crate for itself, wherever it lies
    code, out, _ = run("verify", "gauge/archive", "--run-workbook")
    assert (code, out.splitlines()[-1]) == (0, "the same report again")


def test_a_crate_goes_with_the_report_that_it_is_of(edited: Path, run: Run) -> None:
    out, toml = edited / "out", (edited / "report.toml").read_text()
    (edited / "report.toml").write_text(toml.removesuffix("# edited\n"))
    before = files(out)
    assert "removed" not in run("build", "gauge", "--to", "json")[1]
    assert files(out) == before
    (edited / "report.toml").write_text(toml)
    code, said, _ = run("build", "gauge", "--to", "json")
    assert code == 0
    names = ", ".join([*(f"inputs/{name}" for name in sorted(FILES)), "ro-crate-metadata.json"])
    assert said.splitlines()[1] == f"{names}: removed, as of the report before"
    assert sorted(path.name for path in out.iterdir()) == ["manifest.json", "values.json"]
    assert run(*CRATE, at=edited)[0] == 0


@pytest.mark.parametrize("name", ["ro-crate-metadata.json", "inputs/report.toml"])
def test_what_somebody_changed_in_a_crate_is_kept(name: str, edited: Path, run: Run) -> None:
    path = edited / "out" / name
    path.write_text(path.read_text() + "\n")
    mine = path.read_bytes()
    _, said, _ = run("build", "gauge", "--to", "json")
    kept = path.with_name(f"{path.stem}.edited{path.suffix}")
    assert f"{name} was not as built: it is kept as {kept.relative_to(edited / 'out')}\n" in said
    assert kept.read_bytes() == mine
    assert not path.exists()


def test_a_crate_that_is_built_in_itself_keeps_what_it_is_built_from(edited: Path, run: Run) -> None:
    out = edited / "out"
    toml = out / "inputs" / "report.toml"
    toml.write_text(toml.read_text() + "# edited\n")
    held = {path.name: path.read_bytes() for path in toml.parent.iterdir()}
    assert run("build", "inputs", "--out", ".", "--to", "json", at=out)[0] == 0
    assert {path.name: path.read_bytes() for path in toml.parent.iterdir()} == held
    assert not (out / "ro-crate-metadata.json").exists()


@pytest.mark.parametrize(
    "name", ["inputs/\0", "inputs/\ud800", f"inputs/{'x' * 5000}", "inputs/../../report.toml", 7]
)
def test_metadata_that_somebody_tampered_with_removes_nothing(name: object, edited: Path, run: Run) -> None:
    path = edited / "out" / "ro-crate-metadata.json"
    metadata = json.loads(path.read_text())
    digest = hashlib.sha256((edited / "report.toml").read_bytes()).hexdigest()
    metadata["@graph"].append(
        {"@id": "x", "@type": "File", "name": name, "contentSize": "1", "sha256": digest}
    )
    path.write_text(json.dumps(metadata))
    mine = path.read_bytes()
    code, said, _ = run("build", "gauge", "--to", "json")
    assert (code, "crate-metadata.json: removed" in said) == (0, False)
    assert mine in [left.read_bytes() for left in path.parent.glob("ro-crate-*")]
    assert (edited / "report.toml").is_file()


def test_a_file_of_the_report_before_does_not_go_without_a_word(gauge: Path, run: Run) -> None:
    assert run("build", str(gauge), "--to", "html,json")[0] == 0
    (gauge / "report.toml").write_text((gauge / "report.toml").read_text() + "# edited\n")
    code, said, _ = run("build", str(gauge), "--to", "json")
    assert code == 0
    assert re.fullmatch(r".*report\.html: removed, as of the report before", said.splitlines()[1])
    assert sorted(path.name for path in (gauge / "out").iterdir()) == ["manifest.json", "values.json"]
