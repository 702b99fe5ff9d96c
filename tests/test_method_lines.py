"""Shipped workbooks are as short as their calculations: what their class has below its docstring."""

import ast
from pathlib import Path

import pytest

from loopsheet.report.inputs.folders import PAPER

LINES = {
    "gum_h1": 14,
    "gum_h3": 10,
    "colebrook": 8,
    "misra1a": 6,
    "hertz": 14,
    "meyer": 8,
    "kepler": 12,
}
WORDS = ("given", "measured", "let", "unknown", "root", "fit")


def computing(path: Path) -> int:
    """Lines that compute: not those of claims, nor of what claims alone name."""
    code = ast.parse(path.read_text(encoding="utf-8"))
    (body,) = (each.body for each in code.body if isinstance(each, ast.ClassDef))
    lines = [each for each in body[1:] if "claim(" not in ast.unparse(each)]

    def names(line: ast.stmt) -> set[str]:
        return {each.id for each in ast.walk(line) if isinstance(each, ast.Name)}

    used = set[str]().union(*(names(line.value) for line in lines if isinstance(line, ast.Assign)))

    def counts(line: ast.stmt) -> bool:
        declares = isinstance(line, ast.Assign) and ast.unparse(line.value).partition("(")[0] in WORDS
        return declares or (isinstance(line, ast.Assign) and not names(line.targets[0]).isdisjoint(used))

    return sum((each.end_lineno or 0) - each.lineno + 1 for each in lines if counts(each))


@pytest.mark.parametrize("name", LINES)
def test_no_line_too_many(name: str) -> None:
    assert computing(PAPER.parent / name / "workbook.py") <= LINES[name]
