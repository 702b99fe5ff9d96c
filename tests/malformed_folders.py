"""Report folders that are nearly right, drawn from a seed: most get past the reader, and what then?

A right folder is changed at one to five places. Most changes are what a reader cannot object to: another
number, another unit of the same kind, equal rows, other published values.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from small_report import FILES as GAUGE
from test_toy_workbook import FILES as MARS

from loopsheet.report.inputs.folders import PAPER

__all__ = ["Folder", "malformed"]

USUAL = (
    *("0.5", "1", "1.0", "1.000", "2", "1.5", "12.7", "0.530", "0.512", "2.940", "29.7", "31", "100", "0"),
    *("0.9999999", "1.0000000000000002", "+1", ".5", "5.", "1E5"),
)
"""Most of them, for most quantities."""
EXTREME = (
    *("-1", "-0", "0.0", "1e-9", "1e9", "1e-16", "1e-150", "1e150", "1e-299", "1e299", "9.99e299"),
    *("0.99999999999999999999", "123456789012345678901234567890", "0." + "0" * 60 + "1"),
)
WRONG = ("nan", "inf", "1e300", "1e-301", "4.9e-324", "1,5", "1_000", "0x1", "abc")
LENGTHS, TIMES = ["m", "mm", "nm", "km", "um", "pm", "ly"], ["s", "ms", "d", "h", "min", "year"]


@dataclass(frozen=True)
class Base:
    """A right folder.

    Parameters
    ----------
    files : mapping of str to str
    table : str
        Which of them holds the measurements.
    cells : mapping of str to sequence of str
        The cells of its sheet, with units that they may be published in.
    given : sequence of str
        Those that the user gives, as columns.
    parameters : sequence of str
        Those that are scalars and given.
    """

    files: Mapping[str, str]
    table: str
    cells: Mapping[str, Sequence[str]]
    given: Sequence[str]
    parameters: Sequence[str]


TEMPERATURES = ("K", "mK")
READINGS = PAPER.parent / "gum_h2"
BASES = {
    "gauge": Base(
        GAUGE,
        "d.csv",
        dict.fromkeys(("l", "d", "l_S"), LENGTHS)
        | dict.fromkeys(("theta", "cycle", "dtheta"), TEMPERATURES)
        | dict.fromkeys(("dalpha", "alpha_S"), ("K^-1", "1/K")),
        ("d",),
        ("l_S", "dalpha", "alpha_S", "theta", "cycle", "dtheta"),
    ),
    "mars": Base(
        MARS,
        "seen.csv",
        dict.fromkeys(("t", "T"), TIMES)
        | dict.fromkeys(("a", "r", "gap", "r_mean"), LENGTHS)
        | dict.fromkeys(("ecc", "M", "E"), ("1",)),
        ("t",),
        ("T", "a", "ecc"),
    ),
    "readings": Base(
        {path.name: path.read_text(encoding="utf-8") for path in READINGS.iterdir() if path.is_file()},
        "measurements.csv",
        dict.fromkeys(("V", "V_mean"), ("V", "mV"))
        | dict.fromkeys(("I", "I_mean"), ("A", "mA"))
        | dict.fromkeys(("R", "X", "Z"), ("ohm", "kohm"))
        | dict.fromkeys(("phi", "phi_mean"), ("1",)),
        ("V", "I", "phi"),
        (),
    ),
    "paper": Base(
        {path.name: path.read_text(encoding="utf-8") for path in PAPER.iterdir()},
        "measurements.csv",
        dict.fromkeys(("alpha", "e", "beta", "alpha_mean", "alpha_log", "C_log"), ("1",))
        | dict.fromkeys(("x_p", "x_m", "x_m1", "ball_diameter"), LENGTHS)
        | {"v": ("m/s", "km/h", "mm/s"), "ball_density": ("kg/m^3", "g/cm^3"), "ball_mass": ("g", "kg")}
        | {"points_per_pair": ("1",)},
        ("v", "e", "x_p"),
        ("ball_diameter", "ball_density", "ball_mass", "beta", "points_per_pair"),
    ),
}
INDICES = ("", "1", "1", "2", "2", "3", "1-2", "1-2", "1-3", "2-1", "1-2-3", "99", "x")


class Folder:
    """One folder: a right one, changed at a few places.

    Parameters
    ----------
    dice : random.Random
    kind : str
        A name of :data:`BASES`.
    """

    def __init__(self, dice: random.Random, kind: str) -> None:
        self.dice, self.kind, self.base = dice, kind, BASES[kind]
        files = self.base.files
        self.toml = files["report.toml"].splitlines()
        self.table = [line.split(",") for line in files[self.base.table].splitlines()]
        self.published = [line.split(",") for line in files["published.csv"].splitlines()]
        self.ending = "\n"
        for _ in range(dice.choice((1, 1, 2, 2, 3, 5))):
            with suppress(IndexError, ValueError):  # what it would change is not there any more
                dice.choice(CHANGES)(self)

    def number(self) -> str:
        """A number that somebody may have written."""
        return self.dice.choice(self.dice.choices((USUAL, EXTREME, WRONG), (70, 25, 5))[0])

    def unit(self, name: str) -> str:
        """A unit for a cell, which fits as a rule."""
        wrong = ("", " ", "%", "m", "kg", "furlong", "m^0", "m/s/s", "1")
        return self.dice.choice(wrong if self.dice.random() < 0.1 else self.base.cells[name])

    def write(self, place: Path) -> Path:
        """Write its files into a folder that exists."""
        texts = {"report.toml": self.toml, self.base.table: map(",".join, self.table)}
        texts["published.csv"] = map(",".join, self.published)
        for name, text in self.base.files.items():
            lines = texts.get(name, text.splitlines())
            (place / name).write_bytes("".join(f"{line}{self.ending}" for line in lines).encode())
        return place


Change = Callable[[Folder], None]


def _measured(folder: Folder) -> None:
    row = folder.dice.choice(folder.table[1:])
    row[folder.dice.randrange(1, len(row))] = folder.number()


def _same_as_another(folder: Folder) -> None:
    place = folder.dice.randrange(1, len(folder.table[0]))
    one, other = folder.dice.choices(folder.table[1:], k=2)
    one[place] = other[place]


def _header(folder: Folder) -> None:
    name = folder.dice.choice(folder.base.given)
    place = next(n for n, head in enumerate(folder.table[0]) if head.startswith(name))
    folder.table[0][place] = f"{name} [{folder.unit(name)}]"


def _rows(folder: Folder) -> None:
    rows, count = folder.table[1:], folder.dice.choice((1, 2, 2, 3, 6))
    folder.table[1:] = [[str(n), *row[1:]] for n, row in enumerate((rows * 6)[:count], 1)]


def _tests(folder: Folder) -> None:
    numbers = folder.dice.sample(("1", "2", "7", "12", "3", "99", "999999999", "007", "0", "1.0"), 10)
    for row, number in zip(folder.table[1:], numbers, strict=False):
        row[0] = number


def _uncertainty(folder: Folder) -> None:
    name = folder.dice.choice(folder.base.given)
    for row in folder.table:
        row.append(folder.dice.choice(("0.1", "0.01", folder.number())))
    folder.table[0][-1] = f"u({name}) [{folder.unit(name)}]"


STATED = (
    *(
        "exact",
        "u = {0}",
        "u = {0} {1}",
        "U = {0} {1}, k = 2",
        "U = {0}, p = 95 %",
        "+-{0} rect",
        "± {0} {1} tri",
    ),
    *(
        "+-{0} arcsine, dof = 3",
        "+-{0}",
        "{0} % of reading + 2 digits",
        "s = {0} {1}, n = 5",
        "t sd = {0}, dof = 3",
    ),
    *(
        "scatter",
        "scatter; u = {0}",
        "u = {0}, dof = 1; +-{0} rect",
        "u = 200 %",
        "t scale = {0}, dof = 0.5",
        "u = {0} %",
        "U = {0}",
        "{0}",
    ),
)


def _statement(folder: Folder, name: str) -> str:
    units = folder.base.cells[name]
    return folder.dice.choice(STATED).format(folder.number(), folder.dice.choice(units))


def _behind(folder: Folder) -> None:
    name = folder.dice.choice(folder.base.parameters)
    place = [n for n, line in enumerate(folder.toml) if line.startswith(f"{name} =")][0]  # noqa: RUF015
    before, quote, behind = folder.toml[place].rpartition('"')
    said = folder.dice.choice((f", {_statement(folder, name)}", f"; {_statement(folder, name)}", "(3)"))
    folder.toml[place] = f"{before}{said}{quote}{behind}"


def _concise(folder: Folder) -> None:
    row = folder.dice.choice(folder.table[1:])
    row[folder.dice.randrange(1, len(row))] += folder.dice.choice(("(1)", "(25)", "(0)", "()", "(1.5)"))


def _section(folder: Folder) -> None:
    dice, names = folder.dice, (*folder.base.given, *folder.base.parameters)
    lines = ["[uncertainty]"]
    lines += [f'{name} = "{_statement(folder, name)}"' for name in dice.sample(names, dice.choice((0, 1, 2)))]
    if dice.random() < 0.2:
        lines.append('plus_minus = "rect"')
    if dice.random() < 0.2:
        together = (dice.sample(names, 2), dice.choices(names, k=3), [*names], "x")
        lines.append(f"paired = {dice.choice(together)!r}")
    if dice.random() < 0.2:
        lines.append(f"digits = {dice.choice(('1', '2', '3', '0', 'true', '1.0', '[2]', folder.number()))}")
    for name in dice.sample(names, dice.choice((0, 0, 1, 2))):
        groups = dice.choice(("", "groups = [[1], [2]]", "groups = [[1, 2]]", "groups = [[9]]"))
        lines += [
            "[uncertainty.shared." + name + "]",
            f'of = "{name}"',
            f'stated = "{_statement(folder, name)}"',
            groups,
        ]
    if dice.random() < 0.5:
        one, other = dice.sample(names, 2)
        r = dice.choice(("0.3", "1", "-1", "0", "1.1", "x"))
        lines += ["[uncertainty.correlation]", f'"{one}, {other}" = "{r}"']
    folder.toml += lines


def _limits(folder: Folder) -> None:
    dice, lines = folder.dice, ["[limits]"]
    for name in dice.sample((*folder.base.given, *folder.base.parameters, *folder.base.cells), 2):
        scalar, unit = name in folder.base.parameters, folder.unit(name)
        index = dice.choice(INDICES) if dice.random() < 0.2 else "" if scalar else "1"
        numbers = sorted(
            (folder.number(), folder.number()), key=lambda text: text not in WRONG and float(text)
        )
        said = dice.choice(("{0} .. {1} {2}", "{0} {2} .. {1} {2}", "<= {1} {2}", ">= {0} {2}", "{0} {2}"))
        lines.append(f'"{name}{index and f"[{index}]"}" = "{said.format(*numbers, unit)}"')
    if dice.random() < 0.7:
        guard = dice.choice(("U", "0.83 U", "0", "0.1", f"{folder.number()} {unit}", f"{folder.number()} U"))
        level = dice.choice(("95 %", "0.9545", folder.number()))
        lines += ["[limits.rule]", f'guard = "{guard}"', f'level = "{level}"']
    folder.toml += lines


def _columns(folder: Folder) -> None:
    order = folder.dice.sample(range(len(folder.table[0])), len(folder.table[0]))
    folder.table = [[row[place] for place in order] for row in folder.table]


def _parameter(folder: Folder) -> None:
    name = folder.dice.choice(folder.base.parameters)
    folder.toml = [line for line in folder.toml if not line.startswith(f"{name} =")]
    if folder.dice.random() < 0.9:
        unit = folder.unit(name)
        value = folder.number() if unit == "1" else f"{folder.number()} {unit}"
        folder.toml.insert(folder.toml.index("[parameters]") + 1, f'{name} = "{value}"')


def _printed(folder: Folder) -> None:
    name = folder.dice.choice(folder.base.given)
    way = folder.dice.choice(("truncated", "truncated", "rounded", "cut"))
    folder.toml += ["[measurements.printed]", f'{name} = "{way}"']


def _published_printed(folder: Folder) -> None:
    if len(folder.published) > 1:
        folder.toml += ["[published.printed]", f'"{folder.published[-1][1]}" = "truncated"']


def _errata(folder: Folder) -> None:
    name, index = folder.dice.choice(folder.base.given), folder.dice.choice(("1", "2", "2", "99", ""))
    folder.toml += ["[published.errata]", f'"{name}[{index}]" = "{folder.number()}"']


def _free(folder: Folder) -> None:
    names = folder.dice.sample(sorted(folder.base.cells), folder.dice.choice((1, 2, 4)))
    folder.toml.insert(folder.toml.index("[published]") + 1, f"free = {names}".replace("'", '"'))


ABOUT = ("u({0})", "u1({0})", "U95({0})", "k99.5({0})", "dof({0})", "low90({0})", "q({0})", "u({0}", "r({0})")


def _about(folder: Folder, name: str) -> tuple[str, str]:
    """The cell of a published value and its unit: now and then of something else than its value."""
    unit = folder.unit(name)
    if folder.dice.random() < 0.7:
        return name, unit
    form = folder.dice.choice(ABOUT)
    return form.format(name), "1" if form[0] in "kdr" else unit


def _publish(folder: Folder) -> None:
    name = folder.dice.choice(sorted(folder.base.cells))
    index = folder.dice.choice(INDICES)
    if folder.dice.random() < 0.8:
        index = "" if name in folder.base.parameters or name.endswith(("_mean", "_log")) else index or "1"
    if folder.dice.random() < 0.4:
        del folder.published[1:]
    about, unit = _about(folder, name)
    row = [folder.dice.choice(("Table 2", "T")), about, index, folder.number(), unit]
    folder.published.append(row + [""] * (len(folder.published[0]) - 5))


def _published_value(folder: Folder) -> None:
    row = folder.dice.choice(folder.published[1:])
    row[folder.published[0].index("value")] = folder.number()


def _expect(folder: Folder) -> None:
    words = {
        "expect": ("differs", "differs", ""),
        "recomputed": ("1.234 -> 1.258", "1 -> #NOROOT!", "", "1.234->", "nan -> 1"),
        "explained": (
            "misprint x_p[2]",
            "misprint d[1]",
            "misprint nothing[9]",
            "truncated x_p",
            "",
            "order",
        ),
        "reason": ("because", '"a, b"', "\u202e", "x" * 5000, ""),
        "label": ("a", "", "7"),
    }
    for name in folder.dice.sample(sorted(words), folder.dice.choice((1, 3, 5))):
        if name not in folder.published[0]:
            folder.published[0].append(name)
            for row in folder.published[1:]:
                row.append(folder.dice.choice(words[name]))


def _unpublished(folder: Folder) -> None:
    del folder.published[1:]


def _title(folder: Folder) -> None:
    words = (
        "\u202ex",
        "<script>",
        "x" * 9000,
        "%s {0}",
        r"$\\alpha$ \\input{x}",
        "é日",
        "{{7*7}}",
        "=1+1",
        "",
    )
    folder.toml = [line for line in folder.toml if not line.startswith("title")]
    folder.toml.insert(0, f'title = "{folder.dice.choice(words)}"')


def _ending(folder: Folder) -> None:
    folder.ending = folder.dice.choice(("\r\n", "\r\n", " \n", "\n\n"))


def _line(folder: Folder) -> None:
    folder.toml.pop(folder.dice.randrange(len(folder.toml)))


CHANGES: tuple[Change, ...] = (
    *(_measured, _measured, _measured, _same_as_another, _same_as_another, _header, _rows, _tests, _columns),
    *(_parameter, _parameter, _parameter, _printed, _published_printed, _errata, _free, _publish, _publish),
    *(
        _publish,
        _published_value,
        _published_value,
        _expect,
        _unpublished,
        _title,
        _uncertainty,
        _behind,
        _concise,
        _section,
        _section,
        _limits,
        _ending,
        _line,
    ),
)


def malformed(seed: str, kinds: Sequence[str] = ("gauge", "mars", "readings")) -> Folder:
    """The folder of a seed.

    Parameters
    ----------
    seed : str
    kinds : sequence of str
        Of :data:`BASES`; the paper takes seconds.
    """
    dice = random.Random(seed)
    return Folder(dice, dice.choice(kinds))
