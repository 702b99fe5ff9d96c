"""Builds kernel.c around the root that a workbook declares: sympy prints the equation, gcc makes the loop."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from sympy import Expr, Pow, Symbol, ccode, cse, diff, exp, log

from loopsheet.report.column import Root

STEPS = 4


def built(rule: Root, arguments: list[Symbol], folder: Path) -> Callable[[Mapping[str, Any]], Any] | None:
    """The exponents of pairs, as a function of arrays of two tests a row; None without a compiler.

    Parameters
    ----------
    rule : Root
    arguments : list of Symbol
        Of what it is a root, in the order of `root` in kernel.c.
    folder : Path
        Where it is built.
    """
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        return None
    (folder / "root.h").write_text("\n".join(_printed(rule, arguments)))
    source, library = Path(__file__).with_name("kernel.c"), folder / "kernel.so"
    options = [
        "-O3",
        "-march=native",
        "-fno-math-errno",
        "-fno-trapping-math",
        "-shared",
        "-fPIC",
        "-I",
        str(folder),
        "-o",
        str(library),
    ]
    subprocess.run([compiler, *options, str(source), "-lm"], check=True)
    function = ctypes.CDLL(str(library)).roots
    pointer = np.ctypeslib.ndpointer(dtype=float, flags="C_CONTIGUOUS")
    function.argtypes = [ctypes.c_int64, ctypes.c_double, pointer, pointer, pointer, pointer]
    function.restype = None

    def solve(data: Mapping[str, Any]) -> Any:
        out = np.empty(len(data["v"]))
        function(len(out), 1.5, data["v"], data["e"], data["x_p"], out)
        return out

    return solve


def _printed(rule: Root, arguments: list[Symbol]) -> Iterator[str]:
    """The function `root`, each common part computed once, as soon as what it needs is known."""
    step = rule.expression / diff(rule.expression, rule.unknown)
    places = [Symbol(f"u{n}") for n in range(STEPS + 1)]
    moves = [places[n] - step.xreplace({rule.unknown: places[n]}) for n in range(STEPS)]
    value = rule.value.xreplace({rule.unknown: places[-1]})
    shared, results = cse([_elementary(each) for each in (rule.start, *moves, value)])
    waiting: list[tuple[Any, Expr]] = [*shared, *zip([*places, Symbol("alpha")], results, strict=True)]
    known = set(arguments)
    yield f"static inline double root({', '.join(f'double {name}' for name in arguments)})\n{{"
    while waiting:
        ready = next(each for each in waiting if each[1].free_symbols <= known)
        waiting.remove(ready)
        known.add(ready[0])
        yield f"    double {ready[0]} = {ccode(ready[1], user_functions={'log': 'ln', 'exp': 'e_to'})};"
    yield "    return alpha;\n}\n"


def _elementary(expression: Expr) -> Expr:
    """With exponentials and logarithms in the place of powers; a whole power or a square root is none."""

    def is_power(each: Expr) -> bool:
        return isinstance(each, Pow) and bool(each.exp.free_symbols)

    return expression.replace(is_power, lambda each: exp(each.exp * log(each.base)))
