"""What Python would work out in the body of a method before there are numbers: found where it stands.

A name of the body is a symbol: Python's ``==`` of two symbols is False, NumPy's mean of one is that one, and
to sympy's calculus one is a constant, whatever it was computed from.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Set

from .. import __all__

_WORDS = {*__all__} - {"load", "LoopsheetError", "Method"}
"""What a method is written with: what is made of them has no number yet."""
_OF_NUMBERS = {"cmath", "math", "numpy", "scipy", "statistics"}
_CALCULUS = {
    *("diff", "idiff", "Derivative", "integrate", "Integral", "limit", "series", "subs", "xreplace"),
    *("solve", "solveset", "linsolve", "nonlinsolve", "nsolve", "dsolve"),
}
_COMPARED = (ast.Eq, ast.NotEq, ast.In, ast.NotIn, ast.Is, ast.IsNot)
NO_IF = "a formula has no if: write max(a, b) or min(a, b)"
OF_SYMPY = (
    "functions are those of sympy, not of math or NumPy: from sympy import sqrt, exp, log, sin; over rows "
    "there are sum(x), mean(x), median(x), stdev(x), max(x) and min(x) of loopsheet"
)
_OF_CALCULUS = "{}(...) takes a name for a constant, whatever it is computed from"
OF_NAMES = (
    "derivative(formula, x) of loopsheet puts in what names stand for; integrals, limits and solutions are "
    "written out, and a claim proves them"
)


def at_once(code: bytes) -> Iterator[tuple[int, str, str]]:
    """Lines in the bodies of methods at which Python, NumPy or math would work on names.

    Parameters
    ----------
    code : bytes
        Of a workbook that can be compiled.

    Yields
    ------
    line, what happens there, and what to write instead
    """
    tree = ast.parse(code)
    foreign, calculus = set(_foreign(tree)), set(_calculus(tree))
    methods = [
        each
        for each in ast.walk(tree)
        if isinstance(each, ast.ClassDef) and any("Method" in ast.unparse(base) for base in each.bases)
    ]
    for method in methods:
        yield from _of_body(method, foreign, calculus)
    for helper in (each for each in tree.body if isinstance(each, ast.FunctionDef) and methods):
        for node in ast.walk(helper):
            if isinstance(node, ast.Call) and _called(node) in calculus:
                yield node.lineno, _OF_CALCULUS.format(_called(node)), OF_NAMES


def _foreign(tree: ast.AST) -> Iterator[str]:
    """What modules of numbers, and functions of theirs, are called."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (each.asname or each.name for each in node.names if _root(each.name) in _OF_NUMBERS)
        elif isinstance(node, ast.ImportFrom) and _root(node.module or "") in _OF_NUMBERS:
            yield from (each.asname or each.name for each in node.names)


def _calculus(tree: ast.AST) -> Iterator[str]:
    """What calculus of sympy is called here."""
    yield from _CALCULUS
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and _root(node.module or "") == "sympy":
            yield from (each.asname or each.name for each in node.names if each.name in _CALCULUS)


def _called(call: ast.Call) -> str:
    """The last word of what is called."""
    return ast.unparse(call.func).rpartition(".")[2]


def _root(module: str) -> str:
    return module.partition(".")[0]


def _of_body(method: ast.ClassDef, foreign: Set[str], calculus: Set[str]) -> Iterator[tuple[int, str, str]]:
    declared: set[str] = set()
    for statement in method.body:
        for node in ast.walk(statement):
            match node:
                case ast.If(test=test) | ast.IfExp(test=test) | ast.While(test=test):
                    wrong = _unknown(test, declared)
                case ast.BoolOp():
                    wrong = _unknown(node, declared)
                case ast.Compare(ops=ops) if any(isinstance(each, _COMPARED) for each in ops):
                    wrong = _unknown(node, declared)
                case ast.Call() if _root(ast.unparse(node.func)) in foreign:
                    given = (*node.args, *(each.value for each in node.keywords))
                    if set[str]().union(*map(_names, given)) & declared:
                        said = f"{ast.unparse(node.func)}(...) would work on the name, not on its numbers"
                        yield node.lineno, said, OF_SYMPY
                    continue
                case ast.Call() if _called(node) in calculus and _names(node) & declared:
                    yield node.lineno, _OF_CALCULUS.format(_called(node)), OF_NAMES
                    continue
                case _:
                    continue
            if wrong:
                yield node.lineno, "Python decides here, before there are numbers", NO_IF
        if isinstance(statement, ast.Assign | ast.AnnAssign) and statement.value is not None:
            targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            if _unknown(statement.value, declared):
                declared |= set[str]().union(*map(_names, targets))


def _unknown(node: ast.AST, declared: Set[str]) -> bool:
    """Whether it is made of what has no number yet: of what is declared, or of what a word returns."""
    calls = (each.func for each in ast.walk(node) if isinstance(each, ast.Call))
    return bool(_names(node) & declared) or any(isinstance(f, ast.Name) and f.id in _WORDS for f in calls)


def _names(node: ast.AST) -> set[str]:
    return {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}
