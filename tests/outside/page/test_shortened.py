"""The page's scripts as they ship are the ones that people read, made short."""

import json
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from loopsheet.report.engines.javascript import LOOPS, RUNTIME
from loopsheet.report.engines.javascript_intervals import FUNCTIONS
from loopsheet.report.views import live
from loopsheet.report.views.writer import TEMPLATES

HERE = Path(__file__).parent
KEPT = [RUNTIME.name, LOOPS.name]
SOURCES = (
    *(TEMPLATES / "engines" / name for name in (*KEPT, FUNCTIONS.name)),
    *(TEMPLATES / "live" / name for name in live.SCRIPTS),
)


def test_scripts_that_ship_are_made_of_their_sources(
    require: Callable[..., str], packages: Path, pytestconfig: pytest.Config
) -> None:
    scripts = {path.name: path.read_text(encoding="utf-8") for path in SOURCES}
    given = json.dumps(
        {
            "module": str(packages / "terser"),
            "scripts": scripts,
            "kept": KEPT,
            "parted": FUNCTIONS.name,
        }
    )
    done = subprocess.run(
        [require("node"), str(HERE / "shorten.cjs")], input=given, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    made, shipped = json.loads(done.stdout), RUNTIME.parent
    if pytestconfig.getoption("--seen"):
        for name, text in made.items():
            (shipped / name).write_text(text, encoding="utf-8")
    found = {path.name: path.read_text(encoding="utf-8") for path in shipped.glob("*.js")}
    other = sorted(name for name in made.keys() | found.keys() if made.get(name) != found.get(name))
    assert other == [], "a script was changed and not made short again: 'make seen' does that"
