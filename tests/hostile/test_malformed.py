"""What is nearly right, folders and results: an answer or a located message, never a bug."""

from __future__ import annotations

import copy
import json
import random
import shutil
import sys
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
from campaign_sizes import Sizes
from malformed_folders import malformed
from small_report import end_gauge

from loopsheet.report import build, stages, verification
from loopsheet.report.cli import main
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.messages.errors import LoopsheetError
from loopsheet.report.referee import uncertain as published_u
from loopsheet.report.result.findings import checks
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.monte_carlo import draw
from loopsheet.report.views import html, latex
from loopsheet.report.views import json as data
from loopsheet.report.views.budget import FORMATS as BUDGETS
from loopsheet.report.views.budget import Besides
from loopsheet.report.views.checks import FORMATS


def shown(report: Report) -> None:
    """All that is made of a report; its 50 digits too."""
    report = stages.judged(report, every=False)
    data.values(report)
    latex.render(report, [])
    html.render(report, {}, stages.program(report))
    stages.book(report)
    found = checks(report)
    for form in FORMATS.values():
        form(found, report.title, {})


def ends(folder: Path, further: bool) -> str:
    """Where the way of a folder ends."""
    stage = "the reader"
    try:
        prepared = Study(folder).prepared
        stage = "the sheet"
        report = stages.evaluated(prepared, prepared.inputs.workbook.ledger, lambda _: None)
        stage = "the uncertainties"
        uncertain = report.uncertain()
        for budget in uncertain.budgets:
            for render in BUDGETS.values():
                render(report, budget)
        stage = "the limits"
        for found in uncertain.conformities:
            for render in BUDGETS.values():
                render(report, found.budget, Besides(limited=[found]))
        if further:
            stage = "the draws"
            for budget in uncertain.budgets[:1]:
                if budget.u > 0:
                    drawn = draw(report.inputs, report.values, budget, 2000)
                    for render in BUDGETS.values():
                        render(report, budget, Besides(drawn))
            stage = "the referee"
            report = stages.refereed(report)
            stage = "the views"
            shown(report)
    except LoopsheetError as error:
        return f"refused by {stage}: {error.diagnostics[0].code}"
    except Exception as error:
        site = [frame for frame in traceback.extract_tb(error.__traceback__) if "report" in frame.filename][
            -1
        ]
        return f"BUG in {stage}: {error!r} at {Path(site.filename).name}:{site.lineno}"
    return "accepted"


def test_empty_brackets_are_a_pure_number(tmp_path: Path) -> None:
    for path in PAPER.iterdir():
        text = path.read_text(encoding="utf-8")
        (tmp_path / path.name).write_text(text.replace("e [1]", "e []"))
    report = Study(tmp_path).computed
    assert report.inputs.header_units["e"] == report.shown["e"].unit == "1"


def test_a_parameter_that_the_sheet_wants_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    end_gauge(tmp_path)
    toml = tmp_path / "report.toml"
    toml.write_text(toml.read_text().replace('theta = "-0.1 K"\n', ""))
    assert main(["show", "l", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert "error[LS204]: the key 'theta' is missing in [parameters]" in told
    assert 'write theta = "1.0 K"' in told


def test_a_table_whose_name_is_not_closed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    end_gauge(tmp_path)
    toml = tmp_path / "report.toml"
    toml.write_text(toml.read_text().replace("[parameters]", "[parameters  # as printed"))
    assert main(["show", "l", str(tmp_path)]) == 2
    assert "help: close the name of the table: [parameters]" in capsys.readouterr().err


def test_a_difference_that_no_double_holds_is_one(tmp_path: Path) -> None:
    end_gauge(tmp_path, "source,cell,index,value,unit\nH.1,l,1,1e-290,mm\n")
    toml = tmp_path / "report.toml"
    toml.write_text(toml.read_text().replace('"50.000623 mm"', '"1e150 mm"'))
    (comparison,) = Study(tmp_path).computed.comparisons
    assert comparison.verdict == "differs"
    assert comparison.distance == sys.float_info.max


@pytest.mark.campaigns
def test_a_malformed_folder_is_computed_or_refused(
    tmp_path: Path, sizes: Sizes, summary: Callable[[str], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(published_u, "MOST", 20_000)  # draws
    found, bugs = Counter[str](), []
    for turn in range(sizes.malformed):
        kinds = ("paper",) if turn % 500 == 499 else ("gauge", "mars", "readings")
        folder = malformed(f"{sizes.seed} {turn}", kinds).write(tmp_path)
        how = ends(folder, turn % 50 == 7)
        found[how] += 1
        if how.startswith("BUG"):
            bugs.append((turn, how))
    refused = sum(count for how, count in found.items() if how.startswith("refused"))
    late = sum(count for how, count in found.items() if how.startswith("refused") and "the reader" not in how)
    codes = Counter({how.rpartition(" ")[2]: 0 for how in found if how.startswith("refused")})
    for how, count in found.items():
        if how.startswith("refused"):
            codes[how.rpartition(" ")[2]] += count
    told = ", ".join(f"{count} {code}" for code, count in codes.most_common())
    summary(
        f"{sizes.malformed} malformed folders: {found['accepted']} accepted, {refused} refused, "
        f"{late} of them after the reader ({told}), {len(bugs)} bugs"
    )
    assert not bugs
    assert found["accepted"] + late > sizes.malformed / 3


# --- results that somebody has written by hand ---

BAD: tuple[Any, ...] = (
    *(None, True, 0, -1, 1.5, 1e308, 10**400, 10**25, "", "x" * 5000, "a" * 300, "\ud800", "\u202e", "\0"),
    *(
        "../x",
        "/etc/passwd",
        "a/../../b",
        ".",
        "..",
        "a\0b",
        "nan",
        "ok",
        "report.toml",
        [],
        {},
        [[]],
        [None],
    ),
    *([1, [2]], [1, 2], [[1, 2], [1, 2]], {"a": 1}),
)


def places(value: object, above: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Every place in a JSON value."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield (*above, key)
        yield from places(inner, (*above, key))


def spoilt(value: Mapping[str, Any], dice: random.Random) -> bytes:
    """A JSON object changed at a few places, or no JSON any more."""
    made = copy.deepcopy(dict(value))
    for _ in range(dice.choice((1, 1, 2, 4))):
        *above, key = dice.choice(list(places(made)) or [("schema",)])
        inside: Any = made
        for name in above:
            inside = inside[name]
        how = dice.random()
        if how < 0.15:
            inside.pop(key, None) if isinstance(inside, dict) else inside.pop(key)
        elif how < 0.3 and isinstance(inside, dict):
            inside[dice.choice([bad for bad in BAD if isinstance(bad, str)])] = inside.pop(key, None)
        else:
            inside[key] = copy.deepcopy(dice.choice(BAD))
    text = json.dumps(made)
    if dice.random() < 0.1:
        text = dice.choice((text[: dice.randrange(len(text))], text.replace("1", "NaN", 1), "[" * 100_000))
    return text.encode()


@pytest.mark.campaigns
def test_a_malformed_result_is_read_or_refused(
    tmp_path: Path,
    sizes: Sizes,
    summary: Callable[[str], None],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """By diff, by verify (which finds the same built again) and by crate."""
    end_gauge(tmp_path)
    kept, out, found = tmp_path / "kept", tmp_path / "out", Counter[str]()
    report, _ = build.build(Study(tmp_path), kept, ("json",))
    whole = {name: json.loads((kept / name).read_text()) for name in ("values.json", "manifest.json")}

    def again(_: Study, place: Path, *__: object) -> tuple[Report, list[Path]]:
        shutil.copytree(kept, place)
        return report, []

    monkeypatch.setattr(verification, "build", again)
    for turn in range(sizes.malformed // 2):
        dice = random.Random(f"{sizes.seed} {turn}")
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(kept, out)
        verb = dice.choice(("diff", "diff", "verify", "crate"))
        arguments = {
            "diff": dice.choice(([str(out), str(kept)], [str(kept), str(out), "--format", "markdown"])),
            "verify": [
                str(out),
                str(tmp_path),
                "--run-workbook",
                "--format",
                dice.choice(("text", *FORMATS)),
            ],
            "crate": [str(out), str(tmp_path), "--date", "2026-03-31", "--license", "MIT"],
        }[verb]
        name = (
            "values.json"
            if verb == "diff"
            else dice.choice(("manifest.json", "manifest.json", "values.json"))
        )
        (out / name).write_bytes(spoilt(whole[name], dice))
        code = main([verb, *arguments])
        said = capsys.readouterr()
        assert code in (0, 1, 2), (turn, said.err)
        found[f"{verb} {('the same', 'different', 'refused')[code]}"] += 1
    told = ", ".join(f"{count} {how}" for how, count in sorted(found.items()))
    summary(f"{sizes.malformed // 2} malformed results: {told}, 0 bugs")
