"""An output folder as an RO-Crate: everything named, nothing invented, the same bytes again."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from small_report import FILES, end_gauge

from loopsheet.report.archive.crate import write
from loopsheet.report.cli import main
from loopsheet.report.messages.errors import InputError, LoopsheetError, OutputError, UsageError

VALUES, TOML = b'{"a": 1}\n', b"title = 'A title'\n"


@pytest.fixture
def out(tmp_path: Path) -> Path:
    """What a build wrote, made by hand."""
    folder = tmp_path / "out"
    (folder / "figures").mkdir(parents=True)
    files = {"values.json": VALUES, "figures/a b.svg": b"<svg/>"}
    for name, content in files.items():
        (folder / name).write_bytes(content)
    manifest = {
        "schema": 1,
        "title": "A title",
        "inputs": {"report.toml": hashlib.sha256(TOML).hexdigest()},
        "outputs": {name: hashlib.sha256(content).hexdigest() for name, content in files.items()},
        "sources": {"method": "11"},
        "versions": {"loopsheet": "9.9", "numpy": "2.0"},
        "engines": {"numpy": "", "JavaScript": "node 20.1"},
    }
    (folder / "manifest.json").write_text(json.dumps(manifest))
    (tmp_path / "report.toml").write_bytes(TOML)
    return folder


def graph(path: Path) -> dict[str, dict[str, Any]]:
    entities = json.loads(path.read_text(encoding="utf-8"))["@graph"]
    found = {entity["@id"]: entity for entity in entities}
    assert len(found) == len(entities), "an @id is there twice"
    return found


def references(value: Any) -> set[str]:
    if isinstance(value, list):
        return set().union(*map(references, value))
    return {value["@id"]} if isinstance(value, dict) and set(value) == {"@id"} else set()


def test_everything_is_named_and_every_reference_leads_somewhere(out: Path) -> None:
    found = graph(write(out, "2026-03-31", "CC-BY-4.0", "Some  Body", "A university"))
    root = found["./"]
    assert root["datePublished"] == "2026-03-31"
    assert root["license"] == {"@id": "https://spdx.org/licenses/CC-BY-4.0"}
    files = {"values.json", "figures/a%20b.svg", "manifest.json", "inputs/report.toml"}
    assert references(root["hasPart"]) == files
    assert found["values.json"]["sha256"] == hashlib.sha256(VALUES).hexdigest()
    assert found["values.json"]["contentSize"] == str(len(VALUES))
    action = found["#build"]
    assert references(action["object"]) == {"inputs/report.toml"}
    assert found["inputs/report.toml"]["encodingFormat"] == "application/toml"
    assert found["inputs/report.toml"]["sha256"] == hashlib.sha256(TOML).hexdigest()
    assert references(action["result"]) == files - {"inputs/report.toml"}
    assert references(action["instrument"]) == {"#loopsheet-9.9"}
    assert references(found["#loopsheet-9.9"]["softwareRequirements"]) == {
        "#numpy-2.0",
        "#JavaScript-node%2020.1",
    }
    assert found["#author"] == {
        "@id": "#author",
        "@type": "Person",
        "name": "Some Body",
        "affiliation": {"@id": "#organization"},
    }
    named = set().union(*(references(value) for entity in found.values() for value in entity.values()))
    assert named - set(found) == {"https://w3id.org/ro/crate/1.1"}


def test_an_address_is_who_somebody_is(out: Path) -> None:
    orcid = "https://orcid.org/0000-0002-1825-0097"
    found = graph(write(out, "2026-03-31", "MIT", f"Some Body <{orcid}>", "House <no address>"))
    assert found[orcid] == {
        "@id": orcid,
        "@type": "Person",
        "name": "Some Body",
        "url": orcid,
        "affiliation": {"@id": "#organization"},
    }
    assert found["./"]["author"] == found["#build"]["agent"] == {"@id": orcid}
    assert found["#organization"]["name"] == "House <no address>"


def test_nobody_is_invented(out: Path) -> None:
    found = graph(write(out, "2026-03-31", "https://example.org/terms"))
    assert not {"author", "publisher"} & set(found["./"])
    assert not {"#author", "#organization"} & set(found)
    assert found["./"]["license"] == {"@id": "https://example.org/terms"}


def test_the_same_words_give_the_same_bytes(out: Path) -> None:
    first = write(out, "2026-03-31", "MIT", "x").read_bytes()
    assert write(out, "2026-03-31", "MIT", "x").read_bytes() == first
    assert str(out).encode() not in first
    assert sorted(p.name for p in out.iterdir()) == [
        "figures",
        "inputs",
        "manifest.json",
        "ro-crate-metadata.json",
        "values.json",
    ]


@pytest.mark.parametrize(
    ("date", "licence", "said"),
    [
        ("31.3.2026", "MIT", "not a date: '31.3.2026'"),
        ("2026-02-30", "MIT", "not a date"),
        ("20260331", "MIT", "not a date"),
        ("2026-03-31T10:00", "MIT", "not a date"),
        ("2026-03-31", "all mine", "not a licence: 'all mine'"),
        ("2026-03-31", "", "not a licence"),
        ("2026-03-31", "javascript:alert(1)", "not a licence"),
    ],
)
def test_words_that_mean_nothing_are_refused(date: str, licence: str, said: str, out: Path) -> None:
    with pytest.raises(UsageError, match=said.replace("(", r"\(")):
        write(out, date, licence)
    assert not (out / "ro-crate-metadata.json").exists()


def test_outputs_that_were_changed_are_refused(out: Path) -> None:
    (out / "values.json").write_text("{}")
    with pytest.raises(OutputError, match=r"'values.json' was changed after it was built"):
        write(out, "2026-03-31", "MIT")
    (out / "values.json").unlink()
    with pytest.raises(OutputError, match=r"'values.json' is missing"):
        write(out, "2026-03-31", "MIT")
    (out / "manifest.json").unlink()
    with pytest.raises(InputError, match="LS608"):
        write(out, "2026-03-31", "MIT")


def test_a_manifest_that_leads_out_of_the_folder_is_refused(out: Path) -> None:
    data = json.loads((out / "manifest.json").read_text())
    data["outputs"]["../secret"] = "00"
    (out / "manifest.json").write_text(json.dumps(data))
    (out.parent / "secret").write_text("s")
    with pytest.raises(LoopsheetError, match="is missing"):
        write(out, "2026-03-31", "MIT")


def test_a_crate_is_built_again_from_itself(
    tmp_path: Path, chdir: Callable[[Path], None], capsys: pytest.CaptureFixture[str]
) -> None:
    """Far from where it was made, with the workbook and all that its report.toml names."""
    (tmp_path / "gauge").mkdir()
    folder = end_gauge(tmp_path / "gauge")
    chdir(folder)
    assert main(["build", "--to", "json"]) == 0
    assert main(["crate", "--date", "2026-03-31", "--license", "MIT"]) == 0
    archive = (folder / "out").rename(tmp_path / "archive")
    shutil.rmtree(folder)
    chdir(archive)
    inputs = {path.name: path.read_bytes() for path in (archive / "inputs").iterdir()}
    assert inputs == {name: text.encode() for name, text in FILES.items()}
    capsys.readouterr()
    assert main(["verify", ".", "--run-workbook"]) == 0
    assert capsys.readouterr().out.endswith("\nthe same report again\n")
    assert main(["build", "inputs", "--to", "json"]) == 0
    assert (archive / "inputs/out/values.json").read_bytes() == (archive / "values.json").read_bytes()


def test_what_was_done_to_a_crate_is_told(
    gauge: Path, chdir: Callable[[Path], None], capsys: pytest.CaptureFixture[str]
) -> None:
    """Its copies of the inputs are the record."""
    chdir(gauge)
    assert main(["build", "--to", "json"]) == 0
    assert main(["crate", "--date", "2026-03-31", "--license", "MIT"]) == 0
    verified = ["verify", "--run-workbook"]
    assert main(verified) == 0
    capsys.readouterr()
    copy = Path("out/inputs/report.toml")
    metadata = Path("out/ro-crate-metadata.json")
    for alter, name in (
        (lambda: copy.write_bytes(copy.read_bytes() + b"# mine"), "inputs/report.toml"),
        (copy.unlink, "inputs/report.toml"),
        (lambda: metadata.write_bytes(b"{"), "ro-crate-metadata.json"),
    ):
        alter()
        assert main(verified) == 1
        told = capsys.readouterr().out
        assert f"{name} is not as the crate has it" in told
        assert told.endswith("the outputs were changed after they were built, and nothing else was\n")
        main(["check"])
        assert f"warning: out is not as it was built, {name}" in capsys.readouterr().out


def test_inputs_that_were_changed_are_no_part_of_a_crate(out: Path) -> None:
    (out.parent / "report.toml").write_text("title = 'Another'")
    with pytest.raises(OutputError, match=r"'report.toml' was changed after it was built"):
        write(out, "2026-03-31", "MIT")
    (out.parent / "report.toml").unlink()
    with pytest.raises(UsageError, match="LS609"):
        write(out, "2026-03-31", "MIT")
    assert not (out / "inputs").exists()


def test_the_inputs_of_an_earlier_crate_are_replaced_unless_somebody_changed_them(out: Path) -> None:
    write(out, "2026-03-31", "MIT")
    new = b"title = 'Another'"
    (out.parent / "report.toml").write_bytes(new)
    manifest = json.loads((out / "manifest.json").read_text())
    manifest["inputs"]["report.toml"] = hashlib.sha256(new).hexdigest()
    (out / "manifest.json").write_text(json.dumps(manifest))
    write(out, "2026-03-31", "MIT")
    assert (out / "inputs" / "report.toml").read_bytes() == new
    (out / "inputs" / "report.toml").write_bytes(b"mine")
    with pytest.raises(OutputError, match=r"'inputs/report.toml' was changed after it was put there") as told:
        write(out, "2026-03-31", "MIT")
    assert (out / "inputs" / "report.toml").read_bytes() == b"mine"
    assert "delete it: it is copied again then" in str(told.value)
    (out / "inputs" / "report.toml").unlink()
    write(out, "2026-03-31", "MIT")


@pytest.mark.parametrize("name", ["../secret", "/etc/hostname"])
def test_no_input_leads_out_of_the_crate(name: str, out: Path) -> None:
    (out.parent / "secret").write_text("s")
    manifest = json.loads((out / "manifest.json").read_text())
    manifest["inputs"][name] = "00"
    (out / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(OutputError, match="is missing"):
        write(out, "2026-03-31", "MIT")
    (out / "inputs").symlink_to(out.parent)
    del manifest["inputs"][name]
    (out / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(OutputError, match="leads out of the folder"):
        write(out, "2026-03-31", "MIT")


def test_the_verb(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["crate", str(out), "--date", "2026-03-31", "--license", "MIT"]) == 0
    assert capsys.readouterr().out == f"{out / 'ro-crate-metadata.json'}\n"
    assert main(["crate", str(out)]) == 2
    assert "--date, --license" in capsys.readouterr().err
