"""A report folder with temperatures in degC and degF, and with their differences."""

from pathlib import Path

WORKBOOK = """\
from loopsheet import Method, given, let, mean, measured, plot


class Gas(Method, source="R Boyle", rows="readings"):
    \"\"\"Density of air.\"\"\"

    T = measured("degC", "temperature", low=-50, high=60)
    T_0 = given("degF", "temperature elsewhere", default="68 degF")
    p = given("mbar", "pressure", positive=True)
    dT = given("delta_degC", "difference")
    R = given("J/(kg K)", "gas constant", positive=True)
    rho = let(p / (R * T), "density", "kg/m^3")
    warm = let(T + dT, "warmer", "degC")
    m = let(mean(T), "mean", like=T)
    apart = let(T - T_0, "apart", "delta_degC")
    warmest = let(mean(warm), "mean of warmer", "degF")
    plot(T, warm, m)
"""
IN_TABLES = f"""\
{WORKBOOK}
from dataclasses import replace
from loopsheet.report.workbook import TableSpec
TABLES = TableSpec("measured", "Measured", ("T",)), TableSpec("computed", "Computed", ("rho", "warm"))
WORKBOOK = replace(Gas.workbook, tables=TABLES)
"""
"""What is measured in one table, what is computed in another."""
TOML = """\
title = "Gas"
workbook = "workbook.py"
[parameters]
p = "1013.2 mbar"
dT = "1.5 delta_degC"
R = "287.05 J/(kg K), exact"
[measurements]
file = "measurements.csv"
[uncertainty]
T = "u = 0.1 degC"
[limits]
m = "12 .. 14 degC"
[limits.rule]
guard = "0.2 degC"
[published]
file = "published.csv"
"""
TABLE = """\
reading,T [degC]
1,20.0
2,21.5
3,-3.2
"""
NAMED = """\
reading,note,specimen,T [degC],left out
1,,=1+1,20.0,
2,"the door was open, 5 % of the time",@x <b>y</b>,21.5,
3,,#9 {\\a},-3.2,
4,,17,30,fell
"""
"""A name is what is there for every row, wherever its column stands."""
PUBLISHED = """\
source,cell,index,value,unit
here,m,,12.77,degC
here,u(m),,0.058,degC
here,"u(m, T)",,0.104,delta_degF
here,warm,3,-1.7,degC
here,warmest,,57.68,degF
here,apart,1,0.0,K
here,T,1,68.0,degF
"""


def folder(path: Path, toml: str = TOML, table: str = TABLE, code: str = WORKBOOK) -> Path:
    """Write it."""
    path.mkdir(exist_ok=True)
    every = {"workbook.py": code, "report.toml": toml, "measurements.csv": table, "published.csv": PUBLISHED}
    for name, text in every.items():
        (path / name).write_text(text, encoding="utf-8")
    return path
