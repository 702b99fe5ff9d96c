"""The house keeps its own rules: arrows between the parts, packaging, locks, lazy imports, doctests."""

import ast
import doctest
import importlib
import io
import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Collection, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from importlib import metadata
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import pytest

from loopsheet.report.archive.wheel import wheel as own_wheel
from loopsheet.report.machine.provenance import sources
from loopsheet.report.messages.catalogue import CATALOGUE

ROOT = Path(__file__).resolve().parent.parent
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PACKAGES: list[str] = PYPROJECT["tool"]["setuptools"]["packages"]
RUNTIME = {re.split(r"[^\w-]", line)[0].lower() for line in PYPROJECT["project"]["dependencies"]}
MAX_LINES = 650

# ---------------------------------------------------------------------------------- the arrows
# Part of the package -> (parts it may import, libraries it may import besides the standard one).
# The longest name that fits a module is its rule; a part includes all below it. "" is the root.
# What proves: it knows no symbol of any paper, a vocabulary comes with each ledger.
PROVER = {
    f"derivations.{name}"
    for name in (
        *("algebra", "arranged", "cells", "differentiated", "dimensions", "equation", "errata", "evaluation"),
        *("facts", "few_rows", "grounds", "proof", "proved", "rebuilt", "reductions", "sampling", "search"),
        *("space", "sums", "system", "text", "together", "unit_text", "vocabulary"),
    )
}
ALGEBRA = {"sympy", "mpmath"}
NUMERIC = {"mpmath", "numpy", "scipy", "sympy"}


def rooms(*names: str) -> set[str]:
    return {f"report.{name}" for name in names}


# What an author of a workbook writes with, and what becomes of it.
AUTHOR = PROVER | rooms("messages", "laws", "distribution", "quantity", "axis", "column", "named", "partly")
AUTHOR |= rooms("sheet", "charts", "workbook")
DECLARED = AUTHOR | rooms("cells")
# The words of methods and what is made of their lines, from the ground up.
METHOD = [
    f"report.method.{name}"
    for name in (
        *("codata", "temperatures", "lines", "fitted", "places", "same_rows", "body", "algebra", "errors"),
        *("ledger", "shown", "declaring", "words"),
    )
]

MAY_IMPORT: dict[str, tuple[set[str], set[str]]] = {
    "": ({"derivations", "report"}, set()),
    "__main__": ({"report.cli"}, set()),
    "derivations": ({"derivations"}, ALGEBRA),
    **dict.fromkeys(PROVER, (PROVER, ALGEBRA)),
    "derivations.unit_text": (set(), {"pint"}),
    # --- the rooms of report/, from the ground up: each may look into those that stand before it
    "report.messages": (rooms("messages"), set()),
    "report.files": (rooms("files", "messages"), {"msgspec"}),
    "report.machine": (rooms("files", "machine", "messages"), set()),
    "report.machine.provenance": (set(), {"numpy"}),
    "report.laws": (set(), {"numpy", "scipy"}),
    "report.distribution": (rooms("laws"), set()),
    "report.quantity": (rooms("distribution") | {"derivations.unit_text"}, set()),
    "report.content": (set(), ALGEBRA),
    "report.partly": (set(), set()),
    "report.axis": (rooms("content"), ALGEBRA),
    "report.column": (PROVER | rooms("axis", "content", "quantity"), ALGEBRA),
    "report.named": (PROVER | rooms("axis", "column", "messages", "quantity"), ALGEBRA),
    "report.sheet": (rooms("axis", "column", "named", "partly", "quantity"), ALGEBRA),
    "report.charts": (PROVER | rooms("column", "sheet"), ALGEBRA),
    "report.cells": (DECLARED - rooms("workbook"), ALGEBRA | {"numpy"}),
    "report.workbook": (DECLARED, ALGEBRA),
    "report.inputs": (
        rooms(
            *("cells.address", "charts", "distribution", "files", "inputs", "laws", "messages", "quantity"),
            *("sheet", "workbook"),
        )
        | {"derivations.unit_text"},
        {"msgspec"},
    ),
    "report.plan": (DECLARED | rooms("content", "machine.kept", "plan"), ALGEBRA | {"msgspec"}),
    "report.engines": (DECLARED | rooms("engines", "plan"), NUMERIC),
    "report.engines.elementary": (set(), {"numpy"}),
    "report.engines.intervals": (rooms("engines.elementary"), {"numpy"}),
    "report.result": (
        DECLARED | rooms("engines.exact", "files", "inputs", "result"),
        {"mpmath", "msgspec", "numpy"},
    ),
    "report.judge": (
        DECLARED | rooms("engines", "inputs", "judge", "machine", "plan", "result") | {"derivations"},
        NUMERIC,
    ),
    "report.uncertainty": (
        DECLARED | rooms("engines", "inputs", "judge", "result", "uncertainty"),
        {"numpy", "scipy"},
    ),
    "report.referee": (
        DECLARED | rooms("engines", "inputs", "judge", "referee", "result", "uncertainty"),
        NUMERIC,
    ),
    # one impact under a force law, and what simulation codes have to be told for it
    "report.impacts": (rooms("cells.values", "impacts", "result.card") | {"derivations"}, NUMERIC),
    "report.archive": (DECLARED | rooms("archive", "files", "inputs", "machine", "result"), {"msgspec"}),
    "report.document": (
        DECLARED | rooms("document", "inputs.measurements", "inputs.published", "result"),
        {"markdown_it", "mpmath", "numpy", "sympy"},
    ),
    "report.views": (
        DECLARED
        | rooms(
            "archive.differences",
            "document",
            "files",
            "machine.kept",
            "machine.programs",
            "machine.staging",
            "result",
            "views",
        ),
        RUNTIME - {"scipy", "mpmath"},
    ),
    **{
        part: (
            DECLARED | {*METHOD[: place + 1], "derivations"} | rooms("inputs.keys"),
            ALGEBRA | ({"scipy"} if part == "report.method.codata" else set()),
        )
        for place, part in enumerate(METHOD)
    },
    "report.workbooks": (
        DECLARED | {*METHOD, "derivations"} | rooms("judge", "result", "workbooks"),
        ALGEBRA,
    ),
    "report.workbooks.soft_impact_schematics": (
        DECLARED | rooms("engines.numpy_code", "result", "views.drawing", "workbooks") | {"derivations"},
        {"matplotlib", "numpy", "sympy"},
    ),
    # --- above them all: the study of a folder, what is made of it, and who asks
    "report": ({"derivations", "report"}, RUNTIME),
    "report.pytest_plugin": ({"derivations", "report"}, {"pytest", "_pytest"}),
}
# Parts that only these modules may import, whatever the table says.
ASKING = {"report.loaded", "report.pytest_plugin", "report.verbs", "report.verification"}
ONLY_FROM = {
    "report.cli": {"__main__"},
    "report.build": {"report.verbs", "report.verification"},
    "report.study": {*ASKING, "report.build"},
    "report.stages": {"report.verbs", "report.study", "report.build"},
}
# Modules that may import by a name made at run time: the lazy public names, the registries.
MAY_IMPORT_BY_NAME = {"", "report.build", "report.judge.engines", "report.which_workbook"}


class Import(NamedTuple):
    line: int
    target: str  # "report.sheet" inside, "numpy" outside
    inside: bool
    absolute: bool  # written `loopsheet...` where a relative import was meant


def imports(source: str, module: str, known: Collection[str], is_package: bool = False) -> Iterator[Import]:
    """Every import of a module's source, wherever it stands, names resolved to modules."""
    package = module.split(".") if module else []
    if not is_package:
        package = package[:-1]
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                head, _, rest = alias.name.partition(".")
                inside = head == "loopsheet"
                yield Import(node.lineno, rest if inside else head, inside, inside)
        elif isinstance(node, ast.ImportFrom):
            head, _, rest = (node.module or "").partition(".")
            if node.level == 0 and head != "loopsheet":
                yield Import(node.lineno, head, False, False)
                continue
            if node.level:
                assert node.level - 1 <= len(package), f"{module}:{node.lineno}: import from above loopsheet"
                base = package[: len(package) - node.level + 1] + (node.module or "").split(".")
                start = ".".join(filter(None, base))
            else:
                start = rest
            for alias in node.names:
                full = f"{start}.{alias.name}".lstrip(".")
                # a public name of the root is as good as the module behind it; __version__ is nobody's
                named = full in known or (start == "" and not alias.name.startswith("__"))
                yield Import(node.lineno, full if named else start, True, node.level == 0)


def covers(part: str, module: str) -> bool:
    return part == module or module.startswith(f"{part}.")


def wrong_imports(source: str, module: str, known: Collection[str], is_package: bool = False) -> list[str]:
    """Sentences about what breaks the table; an empty list when all is well."""
    rule = max((part for part in MAY_IMPORT if part == "" or covers(part, module)), key=len)
    parts, libraries = MAY_IMPORT[rule]
    found: list[str] = []
    for line, target, inside, absolute in imports(source, module, known, is_package):
        where = f"{module or '__init__'}:{line}"
        if absolute:
            found.append(f"{where}: write the import of loopsheet.{target} as a relative one")
        if not inside:
            if target not in libraries and target not in sys.stdlib_module_names:
                found.append(f"{where}: {rule or 'the root'} may not import {target}")
        elif target and not any(covers(part, target) for part in parts):
            found.append(f"{where}: {rule or 'the root'} may not import {target}")
        for guarded, importers in ONLY_FROM.items():
            if inside and covers(guarded, target) and not any(covers(part, module) for part in importers):
                found.append(f"{where}: only {', '.join(sorted(importers))} may import {guarded}")
    if module not in MAY_IMPORT_BY_NAME:
        for node in ast.walk(ast.parse(source)):
            name = getattr(node, "id", None) or getattr(node, "attr", None)
            if name in ("import_module", "__import__"):
                found.append(f"{module}:{getattr(node, 'lineno', 0)}: import by name hides the arrow")
    return list(dict.fromkeys(found))


def folder_of(package: str) -> Path:
    return ROOT.joinpath(*package.split(".")[1:])


def module_files() -> dict[str, Path]:
    """Modules of all listed packages, by their name below loopsheet ("" is the root)."""
    files = {}
    for package in PACKAGES:
        inner = package.partition(".")[2]
        for path in sorted(folder_of(package).glob("*.py")):
            stem = "" if path.stem == "__init__" else path.stem
            files[".".join(filter(None, (inner, stem)))] = path
    return files


MODULES = module_files()


@pytest.mark.parametrize("module", MODULES, ids=lambda name: name or "loopsheet")
def test_arrows_run_one_way(module: str) -> None:
    path = MODULES[module]
    assert not wrong_imports(
        path.read_text(encoding="utf-8"), module, MODULES, is_package=path.name == "__init__.py"
    )


@pytest.mark.parametrize(
    ("module", "source", "complaint"),
    [
        ("derivations.hertz", "import numpy", "may not import numpy"),
        ("derivations.hertz", "def f():\n    from ..report import study", "may not import report.study"),
        ("derivations.hertz", "from ..report.sheet import Sheet", "may not import report.sheet"),
        ("derivations.sampling", "from . import symbols", "may not import derivations.symbols"),
        ("derivations.text", "from .soft_impact import LEDGER", "may not import derivations.soft_impact"),
        ("report.views.math", "from ...derivations.symbols import k", "may not import derivations.symbols"),
        ("report.engines.numpy", "from ..views.html import page", "may not import report.views.html"),
        ("report.engines.numpy", "from .. import views", "may not import report.views"),
        ("report.engines.numpy", "import jinja2", "may not import jinja2"),
        ("report.judge.fit", "from ..views import html", "may not import report.views.html"),
        ("report.views.html", "from ..engines.numpy import solve", "may not import report.engines.numpy"),
        ("report.views.html", "from ..judge import fit", "may not import report.judge.fit"),
        ("report.views.html", "from scipy import optimize", "may not import scipy"),
        (
            "report.views.html",
            "from ..build import build",
            "only report.verbs, report.verification may",
        ),
        ("report.inputs.inputs", "from ..cli import main", "only __main__ may import report.cli"),
        ("report.inputs.inputs", "import undeclared", "may not import undeclared"),
        ("report.inputs.inputs", "from loopsheet.report import sheet", "as a relative one"),
        ("report.inputs.inputs", "import loopsheet", "as a relative one"),
        ("report.inputs.inputs", "import importlib\nimportlib.import_module('x')", "hides the arrow"),
        ("report.inputs.inputs", "from ... import Sheet", "may not import Sheet"),
        ("report.messages.errors", "from ..sheet import sheet", "may not import report.sheet"),
        ("", "import numpy", "the root may not import numpy"),
    ],
)
def test_a_wrong_import_is_seen(module: str, source: str, complaint: str) -> None:
    known = {
        "derivations",
        "derivations.soft_impact",
        "derivations.symbols",
        "report",
        "report.sheet",
        "report.study",
        "report.views",
        "report.views.html",
        "report.judge",
        "report.judge.fit",
    }
    found = wrong_imports(source, module, known, is_package=not module)
    assert any(re.search(complaint, sentence) for sentence in found), found


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("derivations.hertz", "import math\nimport sympy as sp\nfrom .equation import Equation"),
        ("report.engines.numpy", "import numpy\nfrom ...derivations import proof\nfrom ..sheet import Sheet"),
        ("report.judge.fit", "from ..engines import numpy"),
        ("report.views.html", "import jinja2\nfrom ..sheet import Sheet\nfrom .escape import escape"),
        ("report.cli", "from .verbs import VERBS\nfrom .. import __version__"),
        ("report.verbs.check", "from .. import build"),
        ("__main__", "from .report.cli import main"),
    ],
)
def test_a_right_import_is_let_through(module: str, source: str) -> None:
    known = {"derivations", "derivations.proof", "report", "report.engines"}
    assert wrong_imports(source, module, known) == []


def test_rooms_stand_in_the_order_of_the_flow() -> None:
    """A room looks into itself and into those that stand before it."""
    before: list[str] = ["derivations"]
    for part, (others, _) in MAY_IMPORT.items():
        if part.startswith("report."):
            before.append(part)
            above = [one for one in others if not any(covers(known, one) for known in before)]
            assert part == "report.pytest_plugin" or not above, f"{part} looks up to {above}"


def circle(files: Mapping[str, Path]) -> list[str]:
    """Modules that import one another in a ring, imports for types alone included; empty if there is none."""
    arrows = {
        module: {
            one.target
            for one in imports(path.read_text(encoding="utf-8"), module, files, path.name == "__init__.py")
            if one.inside and one.target in files and one.target not in ("", module)
        }
        for module, path in files.items()
    }
    try:
        TopologicalSorter(arrows).prepare()
    except CycleError as error:
        found: list[str] = error.args[1]
        return found
    return []


def test_no_modules_import_one_another() -> None:
    assert not circle(MODULES)


def test_a_circle_is_seen(tmp_path: Path) -> None:
    one, other = tmp_path / "one.py", tmp_path / "other.py"
    one.write_text("if TYPE_CHECKING:\n    from .other import x\n")
    other.write_text("def f():\n    from . import one\n")
    assert set(circle({"report.one": one, "report.other": other})) == {"report.one", "report.other"}


@pytest.mark.parametrize("package", PACKAGES)
def test_init_has_only_names(package: str) -> None:
    """An __init__.py holds a docstring, imports, literal tables, and the hooks of lazy names."""
    path = folder_of(package) / "__init__.py"
    tree = ast.parse(path.read_text(encoding="utf-8"))
    assert ast.get_docstring(tree)
    names = (ast.Expr, ast.Import, ast.ImportFrom, ast.Assign, ast.AnnAssign, ast.If)
    for node in tree.body:
        lazy = isinstance(node, ast.FunctionDef) and node.name in ("__getattr__", "__dir__")
        assert lazy or isinstance(node, names), f"{path}:{node.lineno}: belongs in a module of its own"


# ------------------------------------------------------------------------------- size and doctests
def test_the_name_of_a_class_means_one_thing() -> None:
    """What stands in a file is called there as it is called in the house."""
    found: dict[str, list[str]] = {}
    for module, path in MODULES.items():
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                found.setdefault(node.name, []).extend([] if module.startswith("report.files.") else [module])
    assert {name: places for name, places in found.items() if len(places) > 1} == {}


TESTS = sorted((ROOT / "tests").rglob("*.py"))


@pytest.mark.parametrize("path", [str(path.relative_to(ROOT)) for path in (*MODULES.values(), *TESTS)])
def test_no_module_is_too_long(path: str) -> None:
    lines = (ROOT / path).read_text(encoding="utf-8").count("\n")
    assert lines <= MAX_LINES, f"{lines} lines: split it, {MAX_LINES} is the most"


@pytest.mark.parametrize("module", MODULES, ids=lambda name: name or "loopsheet")
def test_doctests(module: str) -> None:
    imported = importlib.import_module(f"loopsheet.{module}".rstrip("."))
    found = Path(imported.__file__ or "").resolve()
    assert found == MODULES[module], "another loopsheet is installed: make clean"
    result = doctest.testmod(imported, optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
    assert result.failed == 0, "see the captured output"


# ------------------------------------------------------------------------------------- lazy imports
HEAVY = sorted(RUNTIME | {"html5lib", "pytest", "hypothesis", "marimo"})


@pytest.mark.parametrize(
    ("module", "needed"),
    [("loopsheet", []), ("loopsheet.report.cli", []), ("loopsheet.report.pytest_plugin", ["pytest"])],
)
def test_heavy_libraries_load_when_used(module: str, needed: list[str]) -> None:
    code = f"import sys, {module}; print(*[name for name in {HEAVY!r} if name in sys.modules])"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == needed


# ---------------------------------------------------------------------------------------- packaging
def test_every_package_is_listed() -> None:
    apart = {"tests", "benchmarks", "build", "dist", "docs", "out"}
    found = {"loopsheet"}
    for init in ROOT.rglob("__init__.py"):
        parts = init.parent.relative_to(ROOT).parts
        if parts and parts[0] not in apart and not any(part.startswith(".") for part in parts):
            found.add(".".join(("loopsheet", *parts)))
    assert found == set(PACKAGES)


def test_command_is_registered() -> None:
    (command,) = metadata.entry_points(group="console_scripts", name="loopsheet")
    assert command.value == "loopsheet.__main__:command"


def test_pytest_plugin_is_registered() -> None:
    (plugin,) = metadata.entry_points(group="pytest11", name="loopsheet")
    assert plugin.value == "loopsheet.report.pytest_plugin"


def test_one_version() -> None:
    import loopsheet

    assert metadata.version("loopsheet") == loopsheet.__version__
    assert f"\nversion: {loopsheet.__version__}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def test_wheel_holds_the_package_and_nothing_else(tmp_path: Path) -> None:
    """The wheel is built from a copy: `build/` in the checkout would keep deleted modules."""
    clean, wheels = tmp_path / "clean", tmp_path / "wheels"
    leave = shutil.ignore_patterns(".*", "build", "dist", "out", "*.egg-info", "__pycache__")
    shutil.copytree(ROOT, clean, ignore=leave)
    build = [sys.executable, "-m", "pip", "wheel", "--no-index", "--no-deps", "--no-build-isolation"]
    env = {name: value for name, value in os.environ.items() if not name.startswith("PIP_")}
    run = subprocess.run(
        [*build, "--wheel-dir", wheels, clean], capture_output=True, text=True, check=False, env=env
    )
    assert run.returncode == 0, run.stdout + run.stderr
    (wheel,) = wheels.glob("*.whl")
    held = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    expected = {f"loopsheet/{path.relative_to(ROOT).as_posix()}" for path in MODULES.values()}
    for folder in ("templates", "data"):
        files = {path for path in (clean / folder).rglob("*") if path.is_file()}
        expected |= {f"loopsheet/{path.relative_to(clean).as_posix()}" for path in files}
        assert files, f"{folder}/ is empty"
    assert held == {*expected, "loopsheet/py.typed"}
    with zipfile.ZipFile(wheel) as opened:
        opened.extractall(tmp_path / "unpacked")
        theirs = {name: opened.read(name) for name in opened.namelist()}
    assert sources(tmp_path / "unpacked" / "loopsheet") == sources(ROOT)
    name, content = own_wheel()
    assert name == wheel.name
    with zipfile.ZipFile(io.BytesIO(content)) as ours:
        assert {name for name in ours.namelist() if ".dist-info/" not in name} == held
        assert not [name for name in held if ours.read(name) != theirs[name]]
        told = {name for name in ours.namelist() if ".dist-info/" in name}
    assert told == set(theirs) - held - {name for name in theirs if name.endswith("top_level.txt")}
    assert own_wheel() == (name, content)


# -------------------------------------------------------------------------------------------- locks
LOCKS = sorted((ROOT / "requirements").glob("*.txt"))
PIN = re.compile(r"([a-z0-9][a-z0-9-]*)==([\w.!+]+)( ; [^/\\]+)? \\")
HASH = re.compile(r"    --hash=sha256:[0-9a-f]{64}( \\)?")
COMMENT = re.compile(r" *#( +(via|make lock|[\w-]+( \(pyproject\.toml(:\w+)?\))?|-c requirements/\w+\.txt))+")
BANNER = "# This file was autogenerated by uv via the following command:"


def pins(lock: Path) -> dict[str, str]:
    found = (PIN.fullmatch(line) for line in lock.read_text(encoding="utf-8").splitlines())
    return {match[1]: match[0] for match in found if match}


@pytest.mark.parametrize("lock", LOCKS, ids=lambda lock: lock.name)
def test_lock_holds_pins_and_hashes_and_nothing_else(lock: Path) -> None:
    """No address, index, host or path: nothing that is not a pin, a hash or the name of who asked."""
    for number, line in enumerate(lock.read_text(encoding="utf-8").splitlines(), start=1):
        known = any(form.fullmatch(line) for form in (PIN, HASH, COMMENT)) or line == BANNER
        assert known, f"{lock.name}:{number}: {line}"


def test_locks_agree() -> None:
    found = {lock.stem: pins(lock) for lock in LOCKS}
    runtime = found["runtime"]
    beside = [found[name] for name in ("test", "docs", "bench")]  # in one environment
    assert all(runtime.items() <= lock.items() for lock in beside)
    for one, other in combinations(beside, 2):
        assert all(other[name].split()[0] == pin.split()[0] for name, pin in one.items() if name in other)
    assert runtime.keys() >= RUNTIME | {"setuptools", "wheel"}
    for name in ("test", "docs", "bench", "crate", "codes"):
        assert found[name].keys() >= set(PYPROJECT["dependency-groups"][name])


def test_every_installed_pin_is_the_locked_one() -> None:
    for name, pin in pins(ROOT / "requirements" / "runtime.txt").items():
        if " ; " not in pin:
            assert pin.startswith(f"{name}=={metadata.version(name)} ")


WALKS = re.findall(r"`(report/[\w/]+\.py): (\w+)`", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))


@pytest.mark.parametrize(("path", "name"), WALKS)
def test_who_walks_through_the_house_finds_what_is_named(path: str, name: str) -> None:
    tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    assert name in {node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}


def test_the_walks_name_places() -> None:
    assert len(WALKS) > 25


NAMED = re.findall(
    r"`((?:report|derivations|tests|templates|docs|benchmarks|data)/[\w/.-]+)[`:]",
    (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"),
)


@pytest.mark.parametrize("name", dict.fromkeys(NAMED))
def test_what_contributors_are_told_of_is_there(name: str) -> None:
    assert (ROOT / name).exists()


def test_every_code_of_an_error_is_explained() -> None:
    named = {
        code
        for file in (ROOT / "report").rglob("*.py")
        for code in re.findall(r'"(LS\d{3})"', file.read_text("utf-8"))
    }
    assert named <= CATALOGUE.keys()
    assert len(named) > 100
