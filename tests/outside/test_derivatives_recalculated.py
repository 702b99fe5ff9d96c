"""Sensitivities of a delivered workbook after an edit: those of a report that is built again with it."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import spreadsheets
from uncertain_data import POLES

from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.uncertain import Decision

DATA = PAPER.parent
NEAR = 1e-9


class Case(NamedTuple):
    """A folder, and the same with another number in it."""

    files: Mapping[str, str]
    before: str
    after: str
    """`before` and `after`: what stands in one of its files."""
    edits: spreadsheets.Edits
    """The same in the workbook."""
    moves: int = 4
    """How many sensitivities become others, at least."""


def shipped(name: str, *parameters: str) -> dict[str, str]:
    """The files of a shipped folder, with more parameters."""
    found = {
        path.name: path.read_text(encoding="utf-8")
        for path in (DATA / name).iterdir()
        if path.suffix in (".toml", ".csv", ".py")
    }
    more = "".join(f"{each}\n" for each in ("[parameters]", *parameters))
    found["report.toml"] = found["report.toml"].replace("[parameters]\n", more, 1)
    return found


def method(body: str, table: str, parameters: str = "", sources: str = "") -> dict[str, str]:
    """The files of a method of one's own."""
    report = f'workbook = "workbook.py"\n[parameters]\n{parameters}[measurements]\nfile = "d.csv"\n'
    return {"workbook.py": body, "d.csv": table, "report.toml": report + sources}


MORE = " whole spread slope middle most peak"
SUMS = f"""from sympy import sqrt

from loopsheet import Method, given, let, mean, measured, median, total


class Sums(Method, headline="Q{MORE}"):
    V = measured("mV", "a voltage", positive=True)
    T = measured("K", "a temperature", positive=True)
    h = given("mm", "a length", positive=True)
    t = given("ms", "a time", positive=True)
    V_0 = let(mean(V), "its mean")
    G = let(sqrt(h) / t, "a gain")
    Q = let(V_0**2 * G - V_0 * mean(V) * G / 3, "what is sought")
    whole = let(Q / mean(T), "by kelvin")
    spread = let(mean((V - V_0) ** 2), "a scatter")
    slope = let(total((V - V_0) * (T - mean(T))) / total((T - mean(T)) ** 2), "a line's", "mV/K")
    W = let(V**2 / T, "of each row")
    middle = let(median(W), "that in the middle")
    most = let(max(W) - min(W), "the range of them")
    peak = let(max(V) ** 2 * median(T) / min(T) ** 3, "powers of extremes")
"""
VOLTAGES = "reading,V [mV],T [K]\n1,{},301.0\n2,52.0,304.5\n3,47.5,299.0\n4,50.25,300.0\n"
STATED = 'h = "4.0 mm, u = 0.1"\nt = "2.50 ms, u = 0.02"\n'
BATH = (
    '[uncertainty]\nV = "u = 0.5"\nT = "u = 0.2"\n[uncertainty.shared.bath]\nof = "T"\nstated = "u = 0.3"\n'
    '[uncertainty.shared.gain]\nof = "V"\nstated = "u = 0.1 % of reading"\n'
)
LIMITS = (
    '[limits]\nV = "49 .. 51 mV"\nW = "7.5 .. 9.1 mV^2/K"\nG = "<= 25.6 m^0.5/s"\nh = "3.9 .. 4.2 mm"\n'
    '[limits.rule]\nguard = "U"\n'
)
ROOTS = """from sympy import exp, log, pairs, sin

from loopsheet import Method, given, let, mean, measured, root, total, unknown


class Roots(Method, headline="level turned"):
    e = measured("1", "eccentricity", low=0, high=0.9)
    M = measured("1", "anomaly", low=0, high=3)
    c = given("1", "a share", positive=True)
    E = unknown()
    E = root(E - e * sin(E), M, "eccentric anomaly", low=M - 1, high=M + 1, start=M, steps=20)
    z = let(c * E / mean(M), "of each row")
    level = let(mean(E**2), "mean square")
    q = unknown()
    q = root(q * exp(q), c * level, "by a root of one number", low=0, high=10, start=1)
    turned = let(q / total(E * M), "what rests on both")
""".replace("log, pairs, ", "")
ORBITS = "reading,e [1],M [1]\n1,0.10,{}\n2,0.25,1.10\n3,0.40,1.90\n"
BOTH = """from loopsheet import Method, fit, let, measured, unknown


class Both(Method, headline="a b chi apart"):
    x = measured("1", "abscissa")
    y = measured("1", "ordinate")
    a = unknown("offset")
    b = unknown("slope")
    line = fit(y, a + b * x, u={x: "stated", y: "stated"})
    chi = let(line.S, "sum of squares")
    apart = let(b * 2 - a, "of both")
"""
POINTS = "reading,x [1],y [1]\n1,0.0,{}\n2,0.9,5.4\n3,1.8,4.4\n4,2.6,4.6\n5,3.3,3.5\n6,4.4,3.7\n"
FOUR = """from sympy import exp

from loopsheet import Method, fit, let, measured, unknown


class Four(Method, headline="a b c d half"):
    x = measured("1", "abscissa")
    y = measured("1", "ordinate")
    a = unknown("height", start=1)
    b = unknown("rate", start=1)
    c = unknown("second height", start=2)
    d = unknown("level", start=0.1)
    curve = fit(y, a * exp(-b * x) + c * exp(-3 * b * x) + d)
    half = let(a / (a + c), "a share")
"""
DECAY = "reading,x [1],y [1]\n" + "".join(
    f"{n},{0.25 * n:.2f},{y}\n"
    for n, y in enumerate(["{}", 2.21, 1.71, 1.33, 1.09, 0.90, 0.78, 0.66, 0.60, 0.53, 0.48], 1)
)
LINE = """from loopsheet import Method, fit, given, let, mean, measured, unknown


class Line(Method, headline="level"):
    x = measured("mm", "stated")
    y = measured("V", "indicated")
    a = unknown("offset")
    b = unknown("slope")
    line = fit(y, a + b * x)
    f = given("1", "a factor")
    reading = let(f * (y - a) / b, "what each row reads", "mm")
    level = let(mean(reading), "mean of them")
"""
STEPS = "reading,x [mm],y [V]\n1,1.0,{}\n2,2.0,2.31\n3,3.0,3.29\n4,4.0,4.42\n"
CERTAIN = '[uncertainty]\nV = "exact"\n'
SIZES = """from loopsheet import Method, given, let, mean, measured


class Sizes(Method, headline="small plain large"):
    V = measured("mV", "a voltage")
    h = given("mm", "a length")
    small = let(h * mean(V) / 1e8, "a hundred millionth")
    plain = let(h * mean(V), "as it is")
    large = let(h * mean(V) * 7e6, "millions", "mV*mm")
"""
GROUPS = """from loopsheet import Method, count, given, groups, let, mean, measured, total


class Groups(Method, headline="between within off"):
    y = measured("mm", "reading")
    zero = given("mm", "where they begin")
    instrument = groups("instrument")
    level = let(mean(y - zero, of=instrument), "mean of an instrument", "mm")
    all_y = let(mean(y), "mean of all", like=y)
    between = let(total(count(y, of=instrument) * (level - all_y) ** 2), "squares between", "mm^2")
    within = let(total((y - level) ** 2), "squares within", "mm^2")
    off = let(mean(y / level), "readings by their means")
"""
EACH = """from sympy import exp

from loopsheet import Method, fit, given, groups, let, mean, measured, total, unknown


class Each(Method, headline="level ratio b apart swing wide"):
    x = measured("1", "abscissa")
    y = measured("mm", "reading")
    zero = given("mm", "where they begin")
    c = given("1", "a factor")
    instrument = groups("instrument")
    level = let(mean(c * exp(x) * (y - zero), of=instrument), "mean of an instrument", "mm")
    ratio = let(level * c / mean(y * x), "of that of all")
    a = unknown("offset")
    b = unknown("rate")
    line = fit(y, a + b * x, of=instrument)
    apart = let(b - a / c, "what rests on a fit", like=b)
    swing = let(total(c * line.residual**2 * (y - level), of=instrument) / level**2, "of readings", "mm")
    wide = let(max(a) - min(a), "of all", like=a)
"""
ADJUSTED = """from loopsheet import Method, fit, groups, let, mean, measured, unknown


class Adjusted(Method, headline="level typical"):
    x = measured("1", "abscissa")
    y = measured("mm", "reading")
    instrument = groups("instrument")
    a = unknown("offset", "mm")
    b = unknown("slope", "mm")
    line = fit(y, a + b * x, u={x: "stated", y: "stated"})
    level = let(mean(y, of=instrument), "mean of an instrument")
    typical = let(mean(line.at_x, of=instrument), "of what is adjusted")
"""
ORDER = """from loopsheet import Method, count, given, groups, let, mean, measured, median, total


class Order(Method, headline="typical low swing wide skew"):
    x = measured("1", "abscissa")
    y = measured("mm", "reading")
    zero = given("mm", "where they begin")
    instrument = groups("instrument")
    square = let((y - zero) ** 2, "of each row")
    typical = let(median(square, of=instrument), "that in the middle", "mm^2")
    low = let(min(y, of=instrument) * max(y, of=instrument), "of both ends", "mm^2")
    level = let(mean(y, of=instrument), "mean of an instrument", "mm")
    swing = let(level * max(y, of=instrument) - typical, "of an instrument", "mm^2")
    wide = let(max(typical) - min(low), "of all", "mm^2")
    middle = let(median(y, of=instrument), "in the middle", "mm")
    skew = let(mean(x * y * middle), "of both", "mm^2")
"""
PAIRS = "reading,instrument,x [1],y [mm]\n1,A,1.0,{}\n2,B,1.5,2.25\n3,A,2.2,1.75\n4,B,1.1,2.20\n"
PAIRS += "5,A,1.6,1.62\n6,B,2,3.1\n"
GAIN = '[uncertainty]\nV = "u = 0.01"\n[uncertainty.shared.gain]\nof = ["V", "b"]\n'
GAIN += 'stated = "u = 1 % of reading"\n'
NEAR_A_LINE = "reading,instrument,x [1],y [mm]\n1,A,1.0,{}\n2,B,1.5,1.93\n3,A,2.2,2.31\n4,B,1.1,1.70\n"
NEAR_A_LINE += "5,A,1.6,1.95\n6,B,2,2.22\n"
READINGS = "reading,instrument,y [mm]\n1,A,{}\n2,B,2.25\n3,A,1.75\n4,B,2.20\n5,A,1.62\n"
SURE = {name: f'[uncertainty]\n{each}' for name, each in {
    "ME": 'M = "u = 0.02"\ne = "u = 0.01"\n',
    "xy": 'x = "u = 0.05"\ny = "u = 0.1"\n',
    "y": 'y = "u = 0.01"\n',
    "of reading": 'x = "u = 0.05"\ny = "u = 3 % of reading; u = 0.02"\n',
}.items()}  # fmt: skip
VOLTS, SHARE = method(SUMS, VOLTAGES.format("48.0"), STATED, BATH), 'c = "1.20, u = 0.01"\n'
ZERO = 'zero = "0.10 mm, u = 0.01"\n'
INSTRUMENTS = method(EACH, PAIRS.format("1.50"), ZERO + 'c = "1.20, u = 0.01"\n', SURE["xy"])
RANKED = method(ORDER, PAIRS.format("1.50") + "7,A,1.2,1.60\n8,B,1.3,2.31\n", ZERO, SURE["xy"])
CASES = {
    "sums": Case(VOLTS, "1,48.0", "1,48.9", {("V", 0): 48.9}),
    "sums of fewer": Case(VOLTS, "1,48.0", "1,", {("V", 0): None}),
    "roots": Case(method(ROOTS, ORBITS.format("0.50"), SHARE, SURE["ME"]), "0.50", "0.90", {("M", 0): 0.9}),
    "a fit of both": Case(
        method(BOTH, POINTS.format("5.9"), "", SURE["xy"]), "0.0,5.9", "0.0,6.4", {("y", 0): 6.4}
    ),
    "a fit by shares of readings": Case(
        method(BOTH, POINTS.format("5.9"), "", SURE["of reading"]), "0.0,5.9", "0.0,6.9", {("y", 0): 6.9}
    ),
    "a fit of four": Case(
        method(FOUR, DECAY.format("2.93"), "", SURE["y"]), "0.25,2.93", "0.25,2.97", {("y", 0): 2.97}
    ),
    "readings of a line": Case(
        method(LINE, STEPS.format("1.22"), 'f = "1.02, u = 0.01"\n', SURE["y"]),
        "1.0,1.22", "1.0,1.37", {("y", 0): 1.37},
        moves=0,  # the mean of what rows read off their own line hangs on none of them
    ),
    "groups": Case(
        method(GROUPS, READINGS.format("1.50"), ZERO, SURE["y"]), "A,1.50", "A,1.95", {("y", 0): 1.95}
    ),
    "results of groups": Case(INSTRUMENTS, "1.0,1.50", "1.0,1.53", {("y", 0): 1.53}, moves=20),
    "results of groups of fewer": Case(INSTRUMENTS, "B,1.5,2.25", "B,1.5,", {("y", 1): None}, moves=20),
    "orders of groups": Case(RANKED, "2,1.60", "2,1.70", {("y", 6): 1.70}, moves=10),
    "orders of groups of fewer": Case(RANKED, "1.6,1.62", "1.6,", {("y", 4): None}, moves=10),
    "a gain": Case(
        method(POLES, "reading,V [V]\n1,10.0\n2,-5.0\n3,2.0\n", 'b = "-3.00 V, u = 0.02"\n', GAIN),
        "1,10.0", "1,-9.0", {("V", 0): -9.0},
    ),
    "a gain of one size": Case(
        method(POLES, "reading,V [V]\n1,5.0\n2,5.0\n3,-5.0\n", 'b = "5.0 V, u = 0.02"\n', GAIN),
        "3,-5.0", "3,4.0", {("V", 2): 4.0}, moves=1,
    ),
    "digits of other sizes": Case(
        method(SIZES, "reading,V [mV]\n1,1.00\n", 'h = "4.17 mm, u = 7 % of reading"\n', CERTAIN),
        '"4.17', '"0.0128', {("h", 0): 0.0128}, moves=0,
    ),
    "limits of what is no result": Case(
        method(SUMS.replace(MORE, ""), VOLTAGES.format("50.2"), STATED, BATH + LIMITS),
        '"4.0 mm', '"4.15 mm', {("h", 0): 4.15}, moves=2,
    ),
    "gum_h1": Case(shipped("gum_h1"), '"-0.1 K', '"-0.7 K', {("theta", 0): -0.7}, moves=1),
}  # fmt: skip

UNDECIDED = ("alpha_lin", "C_lin")
"""Of the paper: their root is counted for the inputs as issued alone, and after an edit they say so."""
CONVOLVED = ("coverage factor k", "expanded uncertainty U", "statement", "k comes from")
"""What no spreadsheet tells of a sum of errors that are not all normal: it does not convolve, and says so."""
SECOND = ("variance of second order", "standard uncertainty u", "all others together")
"""What stays, or follows it, where terms of second order count: they are issued as a number."""


class Office:
    """All cases, before and after, and what LibreOffice makes of the edited ones."""

    def __init__(self, soffice: str, folder: Path) -> None:
        folders = {str(case.files): case.files for case in CASES.values()}
        made = {key: self.made(folder / str(n), files) for n, (key, files) in enumerate(folders.items())}
        self.before = {name: made[str(case.files)] for name, case in CASES.items()}
        self.after = {name: self.made(folder / name, self.edited(case)) for name, case in CASES.items()}
        books = {name: self.before[name].edited(case.edits) for name, case in CASES.items()}
        self.read = spreadsheets.recalculate(soffice, folder, books)

    @staticmethod
    def edited(case: Case) -> dict[str, str]:
        found = {name: text.replace(case.before, case.after, 1) for name, text in case.files.items()}
        assert found != case.files
        return found

    @staticmethod
    def made(folder: Path, files: Mapping[str, str]) -> spreadsheets.Delivered:
        folder.mkdir()
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")
        return spreadsheets.deliver(folder)


@pytest.fixture(scope="module")
def office(require: Callable[..., str], tmp_path_factory: pytest.TempPathFactory) -> Office:
    return Office(require("soffice", "libreoffice"), tmp_path_factory.mktemp("office"))


@pytest.mark.parametrize("name", CASES)
def test_a_budget_follows_an_edit_as_a_rebuild_does(office: Office, name: str) -> None:
    """Sensitivities, contributions and shares of every source, also of those that did nothing before."""
    expected, stale = (
        budgets(spreadsheets.cells_of(each[name].content)["uncertainty"])
        for each in (office.after, office.before)
    )
    found, moved = budgets(office.read[name]["uncertainty"]), 0
    assert expected.keys() == found.keys()
    for result, lines in expected.items():
        if result in UNDECIDED:
            told = ("statement", "standard uncertainty u", "expanded uncertainty U")
            assert {found[result][line, "B"] for line in told} == {"#UNDECIDED!"}
            continue
        if convolves := any(name == "k comes from" for name, _ in lines):
            factor = "coverage factor k", "B"
            assert found[result][factor] == pytest.approx(lines[factor], rel=0.02)
        second = lines["variance of second order", "B"] != 0
        for line, value in lines.items():
            if (convolves and line[0] in CONVOLVED) or (second and line[1] in "BI"):
                continue
            again = found[result][line]
            if isinstance(value, str):
                assert again == value, (result, line)
            else:
                # What is exactly 0 in one may be rounding in the other.
                least = 1e-12 * max(abs(v) for (_, c), v in lines.items() if c == line[1] and v != stays(v))
                assert again == pytest.approx(value, rel=NEAR, abs=least), (result, line)
                moved += line[1] == "G" and value != pytest.approx(stale[result][line], rel=1e-6)
    assert moved >= CASES[name].moves


def test_what_has_limits_is_decided_below_its_budget(office: Office) -> None:
    """Of inputs, of each row, of what results rest on: also where it is no result."""
    delivered = office.before["limits of what is no result"]
    found = budgets(spreadsheets.cells_of(delivered.content)["uncertainty"])
    decided = {cell: told for cell, lines in found.items() if (told := lines.get(("decision", "B")))}
    every = delivered.report.uncertain().conformities
    assert decided == {each.budget.cell: each.decision.value for each in every}
    assert len(decided) == 10
    assert set(decided.values()) == set(Decision)


AT_LIMITS = """
from loopsheet import Method, let, measured
class AtLimits(Method, rows="points"):
    "Deviations that are as large as they may be."
    x = measured("mm", "reading")
    nominal = measured("mm", "nominal")
    dev = let(x - nominal, "deviation", "um")
    rel = let((x - nominal) / nominal, "relative deviation", "%")
"""


def test_what_is_at_its_limit_conforms_there_too(
    recalculate: spreadsheets.Recalculate, tmp_path: Path
) -> None:
    """In doubles 9.95 - 10 is a little less than -0.05."""
    said = (
        '[uncertainty]\nx = "u = 0.01 mm"\nnominal = "exact"\n'
        '[limits]\ndev = "-50 .. 100 um"\nrel = "-0.5 .. 0.5 %"\n'
    )
    rows = "point,x [mm],nominal [mm]\n1,10.05,10\n2,9.95,10\n3,20.10,20\n"
    delivered = Office.made(tmp_path / "made", method(AT_LIMITS, rows, sources=said))
    every = delivered.report.uncertain().conformities
    assert {each.decision for each in every} == {Decision.CONFORMS}
    read = recalculate({"edited": delivered.edited({("x", 0): 10.05})})["edited"]
    found = budgets(read["uncertainty"])
    assert {found[each.budget.cell]["decision", "B"] for each in every} == {Decision.CONFORMS.value}


def stays(value: Any) -> Any:
    """What is no number."""
    return value if isinstance(value, str) else None


def budgets(cells: Mapping[str, Any]) -> dict[str, dict[tuple[str, str], Any]]:
    """What stands in each line of the budget of each result, by its name and the letter of the column."""
    found: dict[str, dict[tuple[str, str], Any]] = {}
    last = max(int(at[1:]) for at in cells if at.startswith("A"))
    for row in range(4, last + 1):
        said = str(cells.get(f"A{row}", ""))
        if str(cells.get(f"A{row + 1}", "")) == "source":
            own = found.setdefault(re.split(r"[ :]", said)[0], {})
        elif said and said != "source":
            own |= {(said, at): cells[f"{at}{row}"] for at in "BDFGHI" if f"{at}{row}" in cells}
    return found


@pytest.mark.parametrize("folder", ["gum_h1", "gum_h2", "gum_h3", "meyer"])
def test_no_sensitivity_is_a_number_as_issued(folder: str) -> None:
    delivered = spreadsheets.deliver(DATA / folder)
    cells = spreadsheets.formulas_of(delivered.content).get("uncertainty", {})
    for result, lines in budgets(cells).items():
        numbers = {
            line
            for line, value in lines.items()
            if line[1] in "GH" and not str(value).startswith(("=", "{="))
        }
        assert not numbers, result
    assert "stay as issued" not in str(cells.get("A2", ""))


def test_a_sensitivity_without_formula_is_told_of_the_inputs_as_issued(
    recalculate: spreadsheets.Recalculate, tmp_path: Path
) -> None:
    """What a fit adjusts in each group: neither u nor U nor what is decided with it outlives an edit."""
    delivered = Office.made(tmp_path / "few", method(ADJUSTED, NEAR_A_LINE.format("1.60"), "", SURE["xy"]))
    books = {
        "as issued": delivered.content,
        "edited": delivered.edited({("y", 0): 1.64}),
        "typed again": delivered.edited({("y", 0): 1.60}),
    }
    read = recalculate(books)
    issued = budgets(spreadsheets.cells_of(delivered.content)["uncertainty"])
    assert {result[:-3] for result in issued} == {"level", "typical"}
    for name, cells in read.items():
        found = budgets(cells["uncertainty"])
        for result in issued:
            for what in ("standard uncertainty u", "expanded uncertainty U"):
                again = found[result][what, "B"]
                if name == "edited" and result.startswith("typical"):
                    assert isinstance(again, str)
                    assert again.startswith("#"), (result, what)
                else:
                    assert again == pytest.approx(issued[result][what, "B"], rel=1e-9)


REPEATED = """from sympy import sqrt

from loopsheet import Method, count, let, mean, measured


class Repeated(Method, rows="deliveries", headline="s"):
    "How masses repeat."
    m = measured("mg", "mass of a delivery")
    s = let(sqrt(sum((m - mean(m)) ** 2) / (count(m) - 1)), "scatter", "mg")
"""


def test_what_second_order_takes_away_is_a_share_of_the_first(
    recalculate: spreadsheets.Recalculate, tmp_path: Path
) -> None:
    """Readings that scatter less have less of it, too: nothing is left of u if it stays as issued."""
    numbers = [998.1, 995.4, 997.2, 996.8, 994.9]
    quiet = [997.0 + (number - 997.0) / 4 for number in numbers]

    def made(name: str, numbers: list[float]) -> spreadsheets.Delivered:
        rows = "".join(f"{n},{number:.4f}\n" for n, number in enumerate(numbers, start=1))
        toml = 'workbook = "workbook.py"\n[measurements]\nfile = "m.csv"\n[uncertainty]\nm = "scatter"\n'
        files = {"workbook.py": REPEATED, "m.csv": f"delivery,m [mg]\n{rows}", "report.toml": toml}
        return Office.made(tmp_path / name, files)

    before, after = made("before", numbers), made("after", quiet)
    books = {"edited": before.edited({("m", row): number for row, number in enumerate(quiet)})}
    read = recalculate(books)["edited"]
    (found,) = budgets(read["uncertainty"]).values()
    issued, rebuilt = (
        budgets(spreadsheets.cells_of(each.content)["uncertainty"])["s"] for each in (before, after)
    )
    assert issued["variance of second order", "B"] < -(rebuilt["standard uncertainty u", "B"] ** 2)
    for what in ("standard uncertainty u", "expanded uncertainty U", "variance of second order"):
        assert found[what, "B"] == pytest.approx(rebuilt[what, "B"], rel=1e-3)


SQUARE = """from loopsheet import Method, let, mean, measured


class Square(Method, headline="A"):
    "An area."
    a = measured("mm", "side")
    A = let(mean(a) ** 2, "area", "mm^2")
"""
LIMITED = """workbook = "workbook.py"
[measurements]
file = "m.csv"
[uncertainty]
a = "u = 0.30 mm"
[limits]
A = "<= 0.15 mm^2"
[limits.rule]
guard = "U"
"""


def test_what_second_order_adds_counts_where_less_is_left_of_the_first(
    recalculate: spreadsheets.Recalculate, tmp_path: Path
) -> None:
    """A side of 1.2 mm is of first order; of 0.1 mm nobody knows whether its square conforms."""

    def made(side: str) -> spreadsheets.Delivered:
        files = {"workbook.py": SQUARE, "m.csv": f"reading,a [mm]\n1,{side}\n", "report.toml": LIMITED}
        return Office.made(tmp_path / side, files)

    before, after = made("1.20"), made("0.10")
    read = recalculate({"edited": before.edited({("a", 0): 0.10}), "issued": before.edited({})})
    found, issued = (budgets(read[name]["uncertainty"])["A"] for name in ("edited", "issued"))
    rebuilt = budgets(spreadsheets.cells_of(after.content)["uncertainty"])["A"]
    assert issued["variance of second order", "B"] == 0
    for what in ("standard uncertainty u", "variance of second order"):
        assert found[what, "B"] == pytest.approx(rebuilt[what, "B"], rel=1e-9)
    assert (issued["decision", "B"], found["decision", "B"]) == ("does not conform", "no decision")
    assert rebuilt["decision", "B"] == found["decision", "B"]


SCATTER = """
from loopsheet import Method, let, measured, stdev

class Scatter(Method, headline="s"):
    "Scatter of readings."
    x = measured("mm", "reading")
    y = let(2 * x, "twice")
    s = let(stdev(x), "scatter")
"""


def test_what_has_no_value_is_not_decided_and_says_why(
    recalculate: spreadsheets.Recalculate, tmp_path: Path
) -> None:
    """An emptied reading, three that are made equal, and one whose cube no double holds."""
    said = '[uncertainty]\nx = "u = 0.01 mm"\n[limits]\ny = ">= 1 mm"\ns = "<= 0.2 mm"\n'
    rows = "reading,x [mm]\n1,1.2\n2,1.3\n3,1.1\n"
    made = Office.made(tmp_path / "made", method(SCATTER, rows, sources=said))
    edits: dict[str, spreadsheets.Edits] = {
        "empty": {("x", 1): None}, "equal": {("x", row): 1.2 for row in range(3)}, "huge": {("x", 1): 1e300},
    }  # fmt: skip
    read = recalculate({name: made.edited(edit) for name, edit in edits.items()})
    lines = "standard uncertainty u", "conformance probability", "decision"
    found = budgets(read["empty"]["uncertainty"])["y[2]"]
    assert {found[each, "B"] for each in lines} == {"#INPUT!"}
    found = budgets(read["equal"]["uncertainty"])["s"]
    assert [found[each, "B"] for each in lines[::2]] == ["#N/A", "#N/A"]
    assert read["huge"]["report"].get("A3", "") == ""
