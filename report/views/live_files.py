"""The inputs of a report for the page that edits them, and the files that it makes of them."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Any

from ..quantity import Printed, behind
from ..result.result import Report
from ..sheet import Axis, GroupAxis, MemberAxis


def given(report: Report) -> dict[str, Any]:
    """What was given, as it was printed, and all that is needed to save it as the files that it came from."""
    inputs, sheet = report.inputs, report.sheet
    given = [axis for axis in sheet.axes if axis.is_given]
    saved = _saved(inputs.files)
    own = {"report.toml", *(inputs.on(axis.name).file for axis in given)}
    return {
        "tables": {axis.name: _table_of(report, axis, saved) for axis in given},
        "parameters": {name: number.text for name, number in inputs.parameters.items() if name in sheet},
        **({"groups": groups, "words": _words(report)} if (groups := _groups(report)) else {}),
        "toml": list(_toml(report, saved)),
        # What goes with them as it is.
        "files": {
            saved[name]: data.decode("utf-8", "replace")
            for name, data in inputs.files.items()
            if name not in own
        },
    }


def _table_of(report: Report, axis: Axis, saved: Mapping[str, str]) -> dict[str, Any]:
    """A table of rows, what it is called when it is saved, and what a row is called."""
    table = report.inputs.on(axis.name)
    return {
        "rows": _rows(report, axis),
        "row": axis.row,
        "least": table.table.least,
        "heads": table.heads or {"test": axis.row},
        "texts": _texts(report, axis),
        "naming": [*table.naming],
        "file": saved.get(table.file, table.file),
    }


def _groups(report: Report) -> dict[str, dict[int, int]]:
    """For each axis of rows in groups, the number of every test's group."""
    axes = (axis for axis in report.sheet.axes if isinstance(axis, MemberAxis))
    return {axis.name: report.inputs.on(axis.of.name).groups(axis.by) for axis in axes}


def _words(report: Report) -> dict[str, dict[int, str]]:
    """For each axis of groups, the words by their numbers."""
    names = [axis.name for axis in report.sheet.axes if isinstance(axis, GroupAxis)]
    return {name: {n: word for (n,), word in report.values.words[name].items()} for name in names}


def _measured(report: Report, axis: Axis) -> dict[str, tuple[Printed | None, ...]]:
    """What is measured in the rows of a table, of which the sheet knows."""
    every = report.inputs.on(axis.name).measured.items()
    return {name: numbers for name, numbers in every if name in report.sheet}


def _rows(report: Report, axis: Axis) -> list[dict[str, Any]]:
    """The rows of a table, in its order, with those that are left out."""
    table, measured = report.inputs.on(axis.name), _measured(report, axis)
    rows = [
        {
            "label": test,
            "used": True,
            "reason": "",
            "cells": {name: _text(numbers[row]) for name, numbers in measured.items()},
        }
        for row, test in enumerate(table.tests)
    ]
    for each in table.left_out:
        cells = {name: each.texts[name] for name in measured}
        rows.insert(each.place, {"label": each.test, "used": False, "reason": each.reason, "cells": cells})
    return rows


def _text(number: Printed | None) -> str:
    return number.text if number else ""


def _raw(report: Report) -> str:
    return report.inputs.files.get("report.toml", b"").decode("utf-8-sig", "replace")


def _saved(names: Iterable[str]) -> dict[str, str]:
    """What files are called that a browser saves, which makes no folders; each has a name of its own."""
    saved: dict[str, str] = {}
    for name in sorted(names, key=lambda name: (name.count("/"), name)):
        own = name.replace("/", "-")
        while own.casefold() in map(str.casefold, saved.values()):
            own = f"_{own}"
        saved[name] = own
    return saved


def _texts(report: Report, axis: Axis) -> dict[int, dict[str, str]]:
    """What stands in the rows of a table, by test and column, where the cells of the page do not say it."""
    table, measured = report.inputs.on(axis.name), _measured(report, axis)
    cells = {
        test: {name: _text(measured[name][row]) for name in measured} for row, test in enumerate(table.tests)
    }
    found = {
        test: {name: text for name, text in texts.items() if cells[test].get(name) != text}
        for test, texts in table.texts.items()
    }
    found |= {
        each.test: {name: text for name, text in each.texts.items() if name not in measured}
        for each in table.left_out
    }
    return {test: texts for test, texts in found.items() if texts}


def _decimal(value: Fraction) -> str:
    """A fraction that was a decimal number, as one again."""
    places = next((n for n in range(400) if (value * 10**n).denominator == 1), 400)
    digits = str(round(value * 10**places)).rjust(places + 1, "0")
    return f"{digits[:-places]}.{digits[-places:]}" if places else digits


def _stated(number: Printed) -> str:
    """What is stated of a number, as it stands behind it and its unit."""
    if number.stated is None:
        return ""
    sizes = (
        f"u = {_decimal(error.width / number.scale)}"
        if error.said.startswith(f"{number.text}(")
        else error.said
        for error in number.stated
    )
    return f", {'; '.join(sizes) or 'exact'}"


def _line(text: str, name: str) -> tuple[int, str]:
    """Where the line of a parameter goes that has none in report.toml, and what it begins with."""
    if head := re.search(r"^[ \t]*\[[ \t]*parameters[ \t]*\][^\n]*\n?", text, re.MULTILINE):
        return head.end(), name
    table = re.search(r"^[ \t]*\[", text, re.MULTILINE)
    return table.start() if table else len(text), f"parameters.{name}"


def _toml(report: Report, renamed: Mapping[str, str]) -> Iterator[str | dict[str, str]]:
    """report.toml in pieces: text as it stands, and between it the numbers that may be edited.

    A parameter that is not in the file has its piece behind the head of the table.
    """
    # Lines are counted as the reader counts them: any of the three ends, a mark in front is not text.
    text = re.sub("\r\n?", "\n", _raw(report))
    starts = [0, *(found.end() for found in re.finditer("\n", text))]
    pieces: list[tuple[int, int, str | dict[str, str]]] = []
    for name, number in report.inputs.parameters.items():
        found = re.fullmatch(r"report\.toml:(\d+):(\d+)", number.where)
        if found is None or name in report.inputs.taken:
            stated = (
                "" if name in (*report.inputs.taken, *report.inputs.uncertainty.columns) else _stated(number)
            )
            at, key = _line(text, name)
            pieces.append((at, at, {"parameter": name, "line": key, "behind": behind(number.unit) + stated}))
            continue
        place = text.find(number.text, starts[int(found[1]) - 1] + int(found[2]) - 1)
        if place >= 0:
            end = place + len(number.text)
            pieces.append((place, end, {"parameter": name}))
            # In parentheses it counts units of the last digit, which an edit may move.
            if concise := re.match(r"\([0-9]+\)(?P<behind>[^\"'\n]*)", text[end:]):
                now = {"parameter": name, "was": concise[0], "behind": concise["behind"] + _stated(number)}
                pieces.append((end, end + concise.end(), now))
    for where, written, name in report.inputs.named:
        if renamed[name] != name:
            line, column = map(int, where.split(":")[1:])
            start, own = text.index(written, starts[line - 1] + column - 1), renamed[name]
            quoted = json.dumps(own, ensure_ascii=False) if written[0] in "\"'" else own
            pieces.append((start, start + len(written), {"file": quoted}))
    pieces += _taken(report, text)
    done = 0
    for start, end, piece in sorted(pieces, key=lambda piece: piece[:2]):
        yield text[done:start]
        yield piece
        done = end
    yield text[done:]


def _taken(report: Report, text: str) -> Iterator[tuple[int, int, str | dict[str, str]]]:
    """The places where a mark makes a remark of what is said of a taken number."""
    for name in report.inputs.taken:
        table = "parameters"
        if name in report.inputs.measured:
            table = r"[ \t]*\.[ \t]*".join((*report.inputs.of(name).table.place, "taken"))
        own, key = _table(text, rf"{table}[ \t]*\.[ \t]*{name}"), rf"""[ \t]*(["']?){name}\1[ \t]*[=.]"""
        whole = own or _table(text, table)
        for line in re.finditer(r"^[^\n]*\S[^\n]*$", whole, re.MULTILINE):
            if own or re.match(key, line.group()):
                start = text.index(whole) + line.start()
                yield start, start, {"taken": name}


def _table(text: str, name: str) -> str:
    """The lines of a table of report.toml."""
    found = re.search(rf"^[ \t]*\[[ \t]*{name}[ \t]*\][^\n]*\n(?:(?![ \t]*\[)[^\n]*\n?)*", text, re.MULTILINE)
    return found.group() if found else ""
