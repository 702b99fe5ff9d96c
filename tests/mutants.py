"""How much of the sources is held by tests: one operator, number or truth is changed at a time.

Run it by ``make mutants`` (SEED=7: others, EACH=40: more of them, PART=plan: of one part). The tests that
belong to a part, and the examples of the module, run on a copy in which one spot of the part is changed; a
change that no test notices is printed with its line. Some mean the same as what they replace: read them
before a test is written.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]

PARTS = {
    "plan": (("report/plan/*.py",), ("test_plan", "test_conditions", "test_engine_numpy", "test_overflow")),
    "engines": (
        ("report/engines/*.py",),
        (
            "test_intervals", "test_numpy_enclosed", "test_elementary",
            "test_engine_numpy", "test_engine_exact", "test_engine_javascript", "test_engine_excel",
            "test_roots", "test_root_certificates", "test_overflow", "test_values", "test_engines",
            "test_fit_starts",
        ),
    ),
    "judge": (
        ("report/judge/*.py",),
        ("test_conditions", "test_enclosure", "test_analysis_engines", "test_oddities"),
    ),
    "referee": (
        ("report/referee/*.py",),
        ("test_referee_parts", "test_referee_explanations", "test_referee"),
    ),
    "views": (
        ("report/views/*.py", "report/document/*.py"),
        ("paper/test_paper_issued", "test_views_html", "test_views_latex", "test_views_generic",
         "test_views_xlsx", "test_views_referee", "test_numbers", "test_math", "test_json", "test_checks",
         "test_figures", "test_svg", "test_escape", "test_narrative"),
    ),
}  # fmt: skip
"""For each part, its sources and the tests that are to notice."""

SWAPPED: dict[type, type] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.Lt: ast.LtE, ast.LtE: ast.Lt,
    ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.And: ast.Or, ast.Or: ast.And,
    ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
}  # fmt: skip

SECONDS = 900


class Mutant(NamedTuple):
    """A source with one spot changed."""

    path: Path
    line: int
    before: str
    after: str
    source: str


def mutants(path: Path) -> Iterator[Mutant]:
    """All changes of a module, each of one spot; what only types say is left as it is."""
    text = path.read_text(encoding="utf-8")
    tree = ast.parse(text)
    spots = [node for node in _alive(tree) if _change(node) is not None]
    for number, spot in enumerate(spots):
        again = ast.parse(text)
        node = [each for each in _alive(again) if _change(each) is not None][number]
        change = _change(node)
        assert change is not None
        attribute, value = change
        before = ast.unparse(node)
        if attribute == "ops":
            node.ops[0] = value  # type: ignore[attr-defined]
        else:
            setattr(node, attribute, value)
        yield Mutant(path, spot.lineno, before, ast.unparse(node), ast.unparse(again))


def _alive(tree: ast.AST) -> Iterator[ast.expr]:
    """The expressions that run: no annotations, no docstrings, nothing that only checkers of types see."""
    for name, value in ast.iter_fields(tree):
        if name in ("annotation", "returns", "decorator_list", "type_params"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING":
                continue
            if isinstance(child, ast.expr):
                yield child
            if isinstance(child, ast.AST):
                yield from _alive(child)


def _change(node: ast.expr) -> tuple[str, object] | None:
    """Which attribute of an expression is changed, and to what."""
    if isinstance(node, (ast.BinOp, ast.BoolOp)) and type(node.op) in SWAPPED:
        return "op", SWAPPED[type(node.op)]()
    if isinstance(node, ast.Compare) and type(node.ops[0]) in SWAPPED:
        return "ops", SWAPPED[type(node.ops[0])]()
    if isinstance(node, ast.Constant) and isinstance(node.value, bool):
        return "value", not node.value
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return "value", node.value + 1
    return None


def is_noticed(copy: Path, mutant: Mutant, tests: tuple[str, ...]) -> bool:
    """Whether some test fails on the mutant."""
    place = copy / mutant.path.relative_to(ROOT)
    original = place.read_text(encoding="utf-8")
    place.write_text(mutant.source, encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "--maxfail=1"]
    module = ".".join(mutant.path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
    command += [f"{copy / 'tests' / 'test_house.py'}::test_doctests[{module}]"]
    command += [str(copy / "tests" / f"{test}.py") for test in tests]
    environment = {**os.environ, "PYTHONPATH": str(copy.parent), "LOOPSHEET_CACHE": ""}
    try:
        run = subprocess.run(
            command, cwd=copy, env=environment, capture_output=True, timeout=SECONDS, check=False
        )
        return run.returncode != 0
    except subprocess.TimeoutExpired:
        return True  # it does not end: that is noticed
    finally:
        place.write_text(original, encoding="utf-8")


def main() -> None:
    """Change some spots of each part, and tell which nobody noticed."""
    parser = argparse.ArgumentParser(description="How much of what the sources say is held by a test.")
    parser.add_argument("parts", nargs="*", help=f"of {', '.join(PARTS)}; all, if none is named")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--each", type=int, default=12, help="how many spots of a part are changed")
    options = parser.parse_args()
    draw = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "loopsheet"
        left_out = shutil.ignore_patterns(".git", ".venv*", ".mypy*", "out", "node_modules", "__pycache__")
        shutil.copytree(ROOT, copy, ignore=left_out)
        total = caught = 0
        for part in options.parts or PARTS:
            sources, tests = PARTS[part]
            every = [m for pattern in sources for path in sorted(ROOT.glob(pattern)) for m in mutants(path)]
            chosen = draw.sample(every, min(options.each, len(every)))
            noticed = 0
            first = every[0]
            if is_noticed(copy, first._replace(source=first.path.read_text(encoding="utf-8")), tests):
                sys.exit(f"{part}: its tests fail as it is: nothing can be told")
            for mutant in chosen:
                if is_noticed(copy, mutant, tests):
                    noticed += 1
                else:
                    where = f"{mutant.path.relative_to(ROOT)}:{mutant.line}"
                    print(f"  not noticed: {where}: {mutant.before} -> {mutant.after}", flush=True)
            print(f"{part}: {noticed} of {len(chosen)} noticed, of {len(every)} there are", flush=True)
            total, caught = total + len(chosen), caught + noticed
    print(f"seed {options.seed}: {caught} of {total} noticed, {100 * caught / max(total, 1):.0f} %")


if __name__ == "__main__":
    main()
