"""What a build wrote is read again; whatever else a file holds is told in a sentence, no traceback."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from loopsheet.report.cli import main
from loopsheet.report.files.form import Form, load, schema, text
from loopsheet.report.files.manifest import Manifest, read_manifest
from loopsheet.report.files.values import Result, read_result
from loopsheet.report.messages.errors import InputError

RESULT: dict[str, Any] = {
    "schema": 1,
    "workbook": "w",
    "title": "t",
    "cells": {
        "v": {
            "axis": "tests", "unit": "m/s", "rule": "given",
            "index": [1, 2], "value": [1.5, 2], "status": ["ok", "ok"],
        },
        "a": {"axis": "pairs", "unit": "1", "index": [[1, 2]], "value": [None], "status": ["#NOROOT!"]},
        "F": {
            "axis": "points", "of": "pairs", "unit": "N", "rule": "(2) F = a", "size": 9, "status": {"ok": 9},
        },
        "m": {"axis": None, "unit": "1", "rule": "(1) m = 2", "value": 2.5, "status": "ok"},
    },
    "proofs": {"(1)": "proved"},
    "published": [
        {"source": "Table 2", "cell": "a", "index": [1, 2], "printed": "1.2", "verdict": "same"},
        {"source": "text", "cell": "m", "index": [], "printed": "2", "verdict": "differs"},
    ],
}  # fmt: skip
MANIFEST: dict[str, Any] = {
    "schema": 1,
    "title": "t",
    "inputs": {"report.toml": "00"},
    "outputs": {"values.json": "11"},
    "sources": {"method": "22"},
    "versions": {"loopsheet": "1"},
    "engines": {"numpy": "", "JavaScript": "node 20"},
}


def changed(content: dict[str, Any], change: Callable[[dict[str, Any]], Any]) -> str:
    copy = json.loads(json.dumps(content))
    change(copy)
    return json.dumps(copy)


def test_a_result(tmp_path: Path) -> None:
    (tmp_path / "values.json").write_text(json.dumps(RESULT))
    found = read_result(tmp_path / "values.json")
    assert (found.title, found.workbook, found.proofs) == ("t", "w", {"(1)": "proved"})
    assert found.cells["v"].cells == {(1,): (1.5, "ok"), (2,): (2.0, "ok")}
    assert found.cells["a"].cells == {(1, 2): (None, "#NOROOT!")}
    assert found.cells["a"].rule == ""
    assert (found.cells["F"].axis, found.cells["F"].cells) == ("points", {})
    assert found.cells["m"].cells == {(): (2.5, "ok")}
    assert [(each.source, each.index, each.verdict) for each in found.published] == [
        ("Table 2", [1, 2], "same"),
        ("text", [], "differs"),
    ]


WRONG: dict[str, Callable[[dict[str, Any]], Any]] = {
    "schema": lambda d: d.update(schema=2),
    "no cells": lambda d: d.pop("cells"),
    "cells": lambda d: d.update(cells=[]),
    "column": lambda d: d["cells"].update(v=7),
    "rows": lambda d: d["cells"]["v"]["value"].pop(),
    "twice": lambda d: d["cells"]["v"].update(index=[1, 1]),
    "index": lambda d: d["cells"]["v"].update(index=["x", {}]),
    "empty index": lambda d: d["cells"]["v"].update(index=[[], []]),
    "word": lambda d: d["cells"]["v"].update(value=["1", 2]),
    "truth": lambda d: d["cells"]["v"].update(value=[True, 2]),
    "huge": lambda d: d["cells"]["v"].update(value=[10**400, 2]),
    "status": lambda d: d["cells"]["m"].update(status=None),
    "size": lambda d: d["cells"]["F"].pop("size"),
    "unit": lambda d: d["cells"]["m"].update(unit=1),
    "axis": lambda d: d["cells"]["v"].update(axis=[]),
    "rule": lambda d: d["cells"]["v"].update(rule=[]),
    "proofs": lambda d: d["proofs"].update(x=1),
    "published": lambda d: d["published"].append(1),
    "published index": lambda d: d["published"][0].pop("index"),
    "title": lambda d: d.pop("title"),
    "headline": lambda d: d.update(headline="m"),
    "shown": lambda d: d["cells"]["m"].update(shown={"text": "percent", "scale": 0}),
    "decision": lambda d: d.update(
        conformity=[{"cell": "x[1]", "limits": "1 to 2", "acceptance": [1, 2], "decision": "conforms"}]
    ),
}

NOT_IN_A_SCHEMA = {"decision", "rows", "twice", "size", "huge"}
"""What hangs on other fields, and on doubles."""


@pytest.mark.parametrize("wrong", WRONG)
def test_what_is_no_result_is_told(wrong: str, tmp_path: Path) -> None:
    (tmp_path / "values.json").write_text(changed(RESULT, WRONG[wrong]))
    with pytest.raises(InputError, match="LS607"):
        read_result(tmp_path / "values.json")


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{", "null", '{"schema": NaN}', "[" * 100_000, "\ud800".encode("utf-8", "surrogatepass")],
)
def test_what_is_no_json_is_told(text: str | bytes, tmp_path: Path) -> None:
    for name in ("values.json", "manifest.json"):
        (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError, match="LS607"):
        read_result(tmp_path / "values.json")
    with pytest.raises(InputError, match="LS608"):
        read_manifest(tmp_path)


def test_what_is_not_there_is_told(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "nowhere", tmp_path / ("x" * 300), Path("nul\0")):
        with pytest.raises(InputError, match="LS607"):
            read_result(path)
        with pytest.raises(InputError, match="LS608"):
            read_manifest(path)


def test_a_manifest(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text(json.dumps(MANIFEST))
    found = read_manifest(tmp_path)
    assert found.software == {"loopsheet": "1", "JavaScript": "node 20"}
    assert list(found.engines) == ["numpy", "JavaScript"]
    assert found.sources == {"method": "22"}


def test_a_manifest_from_before_sources_were_told(tmp_path: Path) -> None:
    old = {name: value for name, value in MANIFEST.items() if name not in ("title", "sources", "engines")}
    (tmp_path / "manifest.json").write_text(json.dumps(old))
    found = read_manifest(tmp_path)
    assert (found.title, found.sources, found.engines) == ("", {}, {"numpy": ""})


@pytest.mark.parametrize("key", ["schema", "inputs", "outputs", "versions"])
def test_what_is_no_manifest_is_told(key: str, tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text(changed(MANIFEST, lambda d: d.update({key: 7})))
    with pytest.raises(InputError, match="LS608"):
        read_manifest(tmp_path)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda d: d["cells"]["v"].update(value=[1, ""]), "cells.v.value[1]: expected `float | null`, got"),
        (lambda d: d["cells"]["v"]["value"].pop(), "cells.v: its rows do not fit together"),
        (lambda d: d["proofs"].update({"(2)": 1}), "proofs.(2): expected `str`, got `int`"),
        (lambda d: d["published"][1].pop("printed"), "published[1]: object missing required field `printed`"),
        (lambda d: d.pop("proofs"), "object missing required field `proofs`"),
        (lambda d: d.update(schema=2), 'it does not say "schema": 1'),
        (lambda d: d.update(cells={"a\0": {}}), "key in cells: expected `str` matching regex"),
    ],
)  # fmt: skip
def test_a_sentence_says_where(change: Callable[[dict[str, Any]], Any], said: str, tmp_path: Path) -> None:
    (tmp_path / "values.json").write_text(changed(RESULT, change))
    with pytest.raises(InputError) as caught:
        read_result(tmp_path / "values.json")
    assert f"'values.json' is no result: {said}" in caught.value.diagnostics[0].message


@pytest.mark.parametrize(
    "rest", ["", '}, "cells": {"v": {}}}', ', "v": {"unit": "m", "value": 1, "status": "ok"}}}', "},"]
)
def test_what_follows_a_wrong_entry_may_be_anything(rest: str, tmp_path: Path) -> None:
    start = '{"schema": 1, "workbook": "w", "title": "t", "cells": {"v": {"unit": 1}'
    (tmp_path / "values.json").write_text(start + rest)
    with pytest.raises(InputError, match=r"cells\S*.unit: expected `str`, got `int`"):
        read_result(tmp_path / "values.json")


def test_what_is_written_is_of_the_form_that_is_told(
    issued: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """For programs that are not ours; and what is read is written as it was, to the last byte."""
    forms: dict[str, type[Form]] = {"values": Result, "manifest": Manifest}
    for name, form in forms.items():
        file = issued / "out" / f"{name}.json"
        assert main(["schema", name]) == 0
        told = json.loads(capsys.readouterr().out)
        Draft202012Validator.check_schema(told)
        judge = Draft202012Validator(told)
        content = json.loads(file.read_bytes())
        assert not list(judge.iter_errors(content))
        assert list(judge.iter_errors({**content, "schema": 2}))
        assert text(load(file, form)) == file.read_text(encoding="utf-8")


@pytest.mark.parametrize("wrong", [name for name in WRONG if name not in NOT_IN_A_SCHEMA])
def test_what_is_refused_is_not_of_the_form_that_is_told(wrong: str) -> None:
    told = Draft202012Validator(json.loads(schema(Result)))
    assert not list(told.iter_errors(RESULT))
    assert list(told.iter_errors(json.loads(changed(RESULT, WRONG[wrong]))))
