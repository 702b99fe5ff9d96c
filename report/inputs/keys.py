"""What may stand in report.toml and in the tables beside it: each key and column, what it says, an example.

Readers take from here which keys there are and what a message proposes; the reference is printed from it. A
key :data:`ANY` is the name of a parameter, a column, a cell ... of the folder's own.
"""

from __future__ import annotations

from typing import NamedTuple

ANY = "*"
LEFT_OUT = "left out"
"""The column that says why a test takes no part; empty where it does."""
_LEAVING = {
    "exclude",
    "excluded",
    "ignore",
    "ignored",
    "omit",
    "omitted",
    "outlier",
    "rejected",
    "skip",
    "skipped",
}


NO_REASONS = {"-", "0", "false", "n", "no", "none"}
"""What tells in a column of answers that a row stays, and is no reason to leave it out."""


def for_left_out(word: str) -> str:
    """What to write instead of a word that somebody takes for the one that leaves a row out; else nothing."""
    told = "a row that takes no part has its reason in a column 'left out' of the table of measurements"
    return told if word.lower() in _LEAVING else ""


class Key(NamedTuple):
    """What a key says."""

    example: str
    """What may stand behind it, as it is written there."""
    meaning: str
    required: bool = False
    """Whether it must be there; of a table within report.toml, if that table is."""


_TAKEN = {
    "from": Key('"balance/out/values.json"', "The values.json of that report, within the folder.", True),
    "cell": Key('"m"', "Its cell, or its column.", True),
    "unit": Key('"um"', "In which it is shown; without it, in that of the workbook."),
}

TABLES: dict[tuple[str, ...], dict[str, Key]] = {
    (): {
        "title": Key('"Soft steel, ball drop"', "The title of the report; the workbook's, without it."),
        "workbook": Key(
            '"soft_impact"', "The method: one that ships, or a file of the folder, `workbook.py`.", True
        ),
        "parameters": Key("[parameters]", "What is given: one number each."),
        "measurements": Key("[measurements]", "What was measured; left out if the method measures nothing."),
        "uncertainty": Key("[uncertainty]", "What is stated of whole columns and of parameters."),
        "limits": Key("[limits]", "Where cells have to lie."),
        "expected": Key("[expected]", "What is odd and as it should be."),
        "published": Key("[published]", "Values to compare with."),
        "cards": Key("[cards]", "A chapter of what to type into simulation codes."),
    },
    ("parameters",): {
        ANY: Key(
            '"12.7 mm, U = 0.03, k = 2"',
            "A number as it was printed, a space, its unit; behind a comma what is stated of its "
            "uncertainty. Or a table, if another report computed it.",
        ),
    },
    ("parameters", ANY): _TAKEN,
    ("measurements",): {
        "file": Key('"measurements.csv"', "The table, within the folder.", True),
        "printed": Key('{ v = "truncated" }', "Columns whose digits were cut off; else they were rounded."),
        "taken": Key("[measurements.taken]", "Columns that another report computed."),
        ANY: Key(
            "[measurements.samples]",
            "Where a method has several tables of rows: each under its name, with `file`, `printed` and "
            "`taken` of its own, and none of these above it.",
        ),
    },
    ("measurements", "taken"): {
        ANY: Key(
            '{ from = "imprints/out/values.json", cell = "depth" }', "Of each test the row of its number."
        ),
    },
    ("measurements", "taken", ANY): _TAKEN,
    ("uncertainty",): {
        ANY: Key(
            '"0.5 % of reading + 2 digits"',
            "Of a measured column or of a parameter, by itself. A size without a unit, `u = 0.003`, is in "
            "the unit that the head of the column, or the parameter, is written in. The referee holds the "
            "numbers to it: what is `exact` is no other number that prints so.",
        ),
        "plus_minus": Key('"rect"', "What `+-0.1` means where no word says more."),
        "digits": Key("1", "Of an uncertainty that is shown: 1 or 2; 2 without it."),
        "paired": Key('["V", "I"]', "Repeated readings that were taken together: they scatter, correlated."),
        "shared": Key(
            '[uncertainty.shared."height datum"]', "One error of many cells, by a name of one's own."
        ),
        "correlation": Key("[uncertainty.correlation]", "Coefficients of the errors of one test."),
    },
    ("uncertainty", "shared", ANY): {
        "of": Key('"x_p"', "The column, or the parameter; several in a list have one error together.", True),
        "stated": Key('"+-0.2 um rect"', "Its size: one error.", True),
        "groups": Key(
            "[[1, 2], [3, 4, 5]]",
            'The tests of each group, or the column that has its word, `"batch"`; without, all are one.',
        ),
    },
    ("uncertainty", "correlation"): {
        ANY: Key('"0.3"', 'Of two columns or two parameters: `"v, e"`.'),
    },
    ("limits",): {
        ANY: Key(
            '"1.25 .. 1.35"',
            "Of a cell: also `<= 1.35`, `>= 1.25`, `22 .. 24 um`, `<= 2 mm, guard = 0.1 mm`.",
        ),
        "rule": Key("[limits.rule]", "The decision rule (JCGM 106); simple acceptance, without it."),
    },
    ("limits", "rule"): {
        "guard": Key('"U"', "How far acceptance limits are drawn in: also `0.83 U`, `0.2 um`, `0`."),
        "level": Key('"95 %"', "The coverage probability of U."),
    },
    ("expected",): {
        ANY: Key(
            '"both drops from one height"', 'A cell, `"alpha[1-2]"`, or a test, `"test 3"`, and the reason.'
        ),
    },
    ("published",): {
        "file": Key('"published.csv"', "The table, within the folder.", True),
        "by": Key('"source"', "If these are the values of the workbook's own source."),
        "free": Key(
            '["C_log"]', "Columns that are given or computed, and not printed: they may have any value."
        ),
        "printed": Key(
            '{ alpha = "truncated" }',
            'Columns whose digits were cut off, and uncertainties that were rounded `"up"`; else rounded.',
        ),
        "errata": Key("[published.errata]", "Misprints that are known."),
    },
    ("published", "errata"): {
        ANY: Key('"29.8"', 'What a measured cell, `"x_p[2]"`, would have to be printed as.'),
    },
    ("cards",): {
        "codes": Key(
            '["lammps", "mujoco"]', "The codes, as `loopsheet card --for list` calls them.", required=True
        ),
        "speed": Key('"3 m/s"', "The impact speed that they are for; the test in the middle, without it."),
        "E": Key('"210 GPa"', "Young's modulus of both bodies, if the stiffness shall be Hertz's."),
        "nu": Key('"0.3"', "Poisson's ratio of both bodies; 0.3 without it."),
        "R": Key('"6.35 mm"', "The effective radius of the contact; the ball's, without it."),
    },
}
"""The keys of each table of report.toml, by its place."""

MEASURED = {
    "test": Key("1", "The number of the row, or as the method calls its rows; without it they are counted."),
    ANY: Key(
        "29.7", "A measured column `x_p [um]`: digits as they were read, `29.7(2)` with an uncertainty.", True
    ),
    "u(*)": Key("0.1", "The standard uncertainty of each number of a column, `u(x_p) [um]`."),
    "left out": Key("bounced twice", "Why the row takes no part; empty where it does."),
}
"""The columns of the table of measurements."""

PUBLISHED = {
    "source": Key("Table 2", "Where it is printed.", True),
    "cell": Key("alpha", "Which column it is a value of, or what of its uncertainty: `u(l)`.", True),
    "index": Key("1-2", "Which row: `3`, of a pair `1-2`; empty for a single number.", True),
    "value": Key("1.234", "As it is printed.", True),
    "unit": Key("1", "Its unit; 1 for a pure number.", True),
    "label": Key("eq. 6", "What the publication calls its row."),
    "expect": Key("differs", "Empty, or `differs` for a difference that is known."),
    "recomputed": Key("1.234 -> 1.258", "What it differs to; `check --accept` writes it."),
    "explained": Key("misprint x_p[2]", "The explanation that it rests on, as the referee calls it."),
    "reason": Key("not from Table 1", "Why it differs."),
}
"""The columns of published.csv, in the order in which they are best written."""


def fixed(*table: str) -> tuple[str, ...]:
    """The keys of a table of report.toml that are called so in all folders; none of an open one.

    One of several tables of rows has those that the only one has.
    """
    one_of_several = len(table) == 2 and table[0] == "measurements" and table not in TABLES
    return tuple(key for key in TABLES.get(table[:1] if one_of_several else table, {}) if key != ANY)
