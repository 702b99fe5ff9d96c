"""A report folder that takes no time: the end gauge of JCGM 100:2008, H.1, one sum of products."""

from __future__ import annotations

from pathlib import Path

SOURCE = """\
from sympy import Symbol
from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Parameter, Workbook

k, n = (Symbol(s, integer=True, positive=True) for s in ("k", "n"))
d = Column("d", Axis("readings", k, n), Given("measured"), "m", "difference", positive=False)
units = {"l_S": "m", "dalpha": "K^-1", "alpha_S": "K^-1", "theta": "K", "cycle": "K", "dtheta": "K"}
parameter = Given("parameter")
given = {name: Column(name, None, parameter, unit, name, positive=False) for name, unit in units.items()}
l_S, dalpha, alpha_S, theta, cycle, dtheta = (column.symbol for column in given.values())
length = l_S + d[k] - l_S * (dalpha * (theta + cycle) + alpha_S * dtheta)
eq = Equation("(H.1)", (Symbol("l"), length), "definition", Kind.DEFINITION, "length of the end gauge")
l = Column("l", d.axis, Formula(eq), "m", "length of the end gauge", positive=False)
WORKBOOK = Workbook(
    name="end_gauge",
    title="End gauge",
    source="JCGM 100:2008, H.1",
    ledger=lambda: Ledger((eq,)),
    measured=(Measured("d", "m", "difference"),),
    parameters=tuple(Parameter(name, unit, name) for name, unit in units.items()),
    sheet=lambda names: Sheet((d, *given.values(), l)),
)
"""
FILES = {
    "workbook.py": SOURCE,
    "report.toml": """\
workbook = "workbook.py"
[parameters]
l_S = "50.000623 mm"
dalpha = "0 K^-1"
alpha_S = "11.5e-6 K^-1"
theta = "-0.1 K"
cycle = "0 K"
dtheta = "0 K"
[measurements]
file = "d.csv"
[published]
file = "published.csv"
""",
    "d.csv": "test,d [nm]\n1,215\n2,204\n",
    "published.csv": "source,cell,index,value,unit\nH.1,l,1,50.000838,mm\n",
}


def end_gauge(folder: Path, published: str = "", **files: str | bytes) -> Path:
    """Write the folder, with other rows of published values and other files if they are given.

    Parameters
    ----------
    folder : Path
    published : str
        The whole published.csv.
    **files : str or bytes
        The content of a file by its name without its ending: ``report``, ``d``.
    """
    for name, text in FILES.items():
        content = (published if name == "published.csv" else "") or files.get(name.partition(".")[0], text)
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder
