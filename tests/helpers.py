"""What tests of several files share."""

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from sympy import Expr, Symbol

from loopsheet.derivations.contact import damping as model
from loopsheet.derivations.equation import Equation
from loopsheet.report.cli import main
from loopsheet.report.impacts.damping import _MARGIN, _STRONG, _value, _zero
from loopsheet.report.messages.errors import InputError
from loopsheet.report.sheet import Axis, Column, Formula


def whole(name: str) -> Symbol:
    return Symbol(name, integer=True, positive=True)


def formula(name: str, expression: Expr, axis: Axis | None = None, positive: bool = False) -> Column:
    equation = Equation("(1)", (Symbol(name), expression), "")
    return Column(name, axis, Formula(equation), positive=positive)


def method_folder(place: Path, code: str, rows: str = "", more: str = "", published: str = "") -> Path:
    """Write a report folder with a method of its own, and return it.

    Parameters
    ----------
    place : Path
    code : str
        Its workbook.py.
    rows : str
        The whole measurements.csv; without, there is none.
    more : str
        What else report.toml says, before its tables are named: a title first, then sections.
    published : str
        The whole published.csv; without, there is none.
    """
    place.mkdir(parents=True, exist_ok=True)
    toml = f'workbook = "workbook.py"\n{more}'
    for name, text in {"measurements": rows, "published": published}.items():
        if text:
            toml += f'[{name}]\nfile = "{name}.csv"\n'
            (place / f"{name}.csv").write_text(text, encoding="utf-8")
    (place / "report.toml").write_text(toml, encoding="utf-8")
    (place / "workbook.py").write_text(code, encoding="utf-8")
    return place


def number_for(e: float) -> float:
    """The damping number with which the family returns a restitution, for any n: (L106), solved for it."""
    if e < 1 / _STRONG:
        return 1 / e
    (residual,) = model.returned.residuals
    # Weak damping: c is about 1 - e^2; (L106) also holds for c = 0, which returns any e.
    return _zero(lambda c: _value(residual, c=c, e_o=e), 0.2 * (1 - e**2), (1 - _MARGIN) / e)


def in_node(node: str, *parts: str) -> Any:
    """What a script that prints JSON prints; its parts follow one another."""
    done = subprocess.run([node, "-"], input="\n".join(parts), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def findings_of(read: Callable[..., object]) -> Callable[..., list[str]]:
    """Give a function that returns what is found while reading as ``code file:line:column+length``."""

    def collect(*args: str, **files: str) -> list[str]:
        with pytest.raises(InputError) as caught:
            read(*args, **files)
        return [f"{found.code} {found.at}+{found.at.length}" for found in caught.value.diagnostics]

    return collect


def told(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """What `budget` tells."""
    assert main(["budget", *words]) == 0
    return capsys.readouterr().out
