"""Reads what a build wrote: values.json and manifest.json, which may have been changed since."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..cells.address import address
from ..messages.errors import InputError, Location, diagnose

__all__ = ["Column", "Manifest", "Result", "read_manifest", "read_result"]

LARGEST = 500_000_000
"""Bytes."""
SCHEMA = 1
_LONGEST = 1000
"""Characters of a file's name, with its folders."""
_NO_TEXT = re.compile("[\0\ud800-\udfff]")
"""What JSON can write and no file can hold: NUL, and halves of characters."""

Index = tuple[int, ...]


@dataclass(frozen=True)
class Column:
    """One column of a result.

    Parameters
    ----------
    unit, axis : str
        SI unit, and the name of the index set; empty for a scalar.
    rule : str
        Its equation; ``given`` for what the user gave, empty if the result does not say.
    cells : mapping of index to (float or None, str)
        The value in SI and the status of every row.
    """

    unit: str
    axis: str
    rule: str
    cells: Mapping[Index, tuple[float | None, str]]


@dataclass(frozen=True)
class Result:
    """What values.json says.

    Parameters
    ----------
    name : str
        The file, as the user wrote it.
    title, workbook : str
    columns : mapping of str to Column
        In the order of the sheet.
    proofs : mapping of str to str
        The status of each equation.
    published : mapping of str to str
        Of each published value, as ``Table 2 alpha[1-2]``, what it prints and the verdict on it.
    """

    name: str
    title: str
    workbook: str
    columns: Mapping[str, Column]
    proofs: Mapping[str, str]
    published: Mapping[str, str]


@dataclass(frozen=True)
class Manifest:
    """What manifest.json says: sha256 by name, and what computed it.

    Parameters
    ----------
    title : str
        The report's.
    inputs, outputs, sources : mapping of str to str
        The sha256 of every file and part; `sources` is empty if the manifest has none.
    versions : mapping of str to str
        The program, its libraries, and the programs that ran other engines.
    engines : tuple of str
        Whose agreement the report tells.
    processor : str
        On which it ran; empty if the manifest does not say.
    """

    title: str
    inputs: Mapping[str, str]
    outputs: Mapping[str, str]
    sources: Mapping[str, str]
    versions: Mapping[str, str]
    engines: tuple[str, ...]
    processor: str = ""


class _Wrong(ValueError):
    """The content is not what a build writes."""


def read_result(path: Path) -> Result:
    """Read a result.

    Parameters
    ----------
    path : Path
        A values.json, or the folder that holds one.

    Raises
    ------
    InputError
        It is none.
    """
    if os.path.isdir(path):
        path = path / "values.json"
    try:
        data = _load(path)
        cells = _table(data, "cells")
        return Result(
            path.as_posix(),
            _word(data, "title"),
            _word(data, "workbook"),
            {name: _column(name, cells) for name in cells},
            _words(data, "proofs"),
            dict(_published(each) for each in _list(data, "published")),
        )
    except _Wrong as error:
        place = Location(path.as_posix())
        raise InputError(diagnose("LS607", place, text=path.name, reason=error)) from error


def read_manifest(folder: Path) -> Manifest:
    """Read the manifest of an output folder.

    Raises
    ------
    InputError
        There is none, or it is none of loopsheet's.
    """
    path = folder / "manifest.json"
    try:
        data = _load(path)
        engines = _words(data, "engines") if "engines" in data else {"numpy": ""}
        programs = {engine: program for engine, program in engines.items() if program}
        return Manifest(
            _word(data, "title") if "title" in data else "",
            _files(data, "inputs"),
            _files(data, "outputs"),
            _words(data, "sources") if "sources" in data else {},
            _words(data, "versions") | programs,
            tuple(engines),
            _word(data, "processor") if "processor" in data else "",
        )
    except _Wrong as error:
        place = Location(path.as_posix())
        raise InputError(diagnose("LS608", place, text=path.name, reason=error)) from error


def _load(path: Path) -> dict[str, Any]:
    try:
        if not path.is_file():
            raise _Wrong("there is no such file")
        if path.stat().st_size > LARGEST:
            raise _Wrong(f"it has more than {LARGEST:,} bytes")
        data = json.loads(path.read_text(encoding="utf-8"), parse_constant=_no_number)
    except OSError as error:
        raise _Wrong(error.strerror or str(error)) from error
    except _Wrong:
        raise
    except (ValueError, RecursionError) as error:
        raise _Wrong(f"not JSON: {error}") from error
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise _Wrong(f'it does not say "schema": {SCHEMA}')
    return data


def _no_number(word: str) -> Any:
    raise _Wrong(f"{word} is no number of JSON")


def _get(data: Mapping[str, Any], key: str, kind: type) -> Any:
    found = data.get(key)
    if not isinstance(found, kind):
        raise _Wrong(f"'{key}' is missing, or not what it should be")
    for text in (key, *(found if isinstance(found, dict) else [found])):
        if isinstance(text, str) and _NO_TEXT.search(text):
            raise _Wrong(f"'{text}' is no text")
    return found


def _table(data: Mapping[str, Any], key: str) -> dict[str, Any]:
    found: dict[str, Any] = _get(data, key, dict)
    return found


def _list(data: Mapping[str, Any], key: str) -> list[Any]:
    found: list[Any] = _get(data, key, list)
    return found


def _word(data: Mapping[str, Any], key: str) -> str:
    return str(_get(data, key, str))


def _words(data: Mapping[str, Any], key: str) -> dict[str, str]:
    found = _table(data, key)
    return {name: _word(found, name) for name in found}


def _files(data: Mapping[str, Any], key: str) -> dict[str, str]:
    """The sha256 of files by their names, which may lead anywhere but can be names."""
    found = _words(data, key)
    for name in found:
        if len(name) > _LONGEST or any(len(part.encode()) > 255 for part in name.split("/")):
            raise _Wrong(f"'{key}' names what can be no file")
    return found


def _column(name: str, cells: Mapping[str, Any]) -> Column:
    entry = _table(cells, name)
    axis, rule = entry.get("axis"), entry.get("rule", "")
    if axis is None:
        labels: list[Index] = [()]
        values, statuses = [entry.get("value")], [entry.get("status")]
    elif "of" in entry:  # generated rows are counted, not listed
        _get(entry, "size", int)
        labels, values, statuses = [], [], []
    else:
        labels = [_index(each) for each in _list(entry, "index")]
        values, statuses = _list(entry, "value"), _list(entry, "status")
    if not len(labels) == len(values) == len(statuses) == len(set(labels)):
        raise _Wrong(f"the rows of '{name}' do not fit together")
    rows = zip(values, statuses, strict=True)
    found = {label: _cell(name, value, status) for label, (value, status) in zip(labels, rows, strict=True)}
    if not isinstance(rule, str) or not isinstance(axis, str | None):
        raise _Wrong(f"'{name}' is not what it should be")
    return Column(_word(entry, "unit"), axis or "", rule, found)


def _cell(name: str, value: Any, status: Any) -> tuple[float | None, str]:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if not isinstance(status, str) or not (number or value is None):
        raise _Wrong(f"a cell of '{name}' is not what it should be")
    try:
        return (float(value) if number else None), status
    except OverflowError as error:
        raise _Wrong(f"a cell of '{name}' is too large") from error


def _index(index: Any) -> Index:
    parts = index if isinstance(index, list) else [index]
    if not parts or not all(isinstance(part, int) for part in parts):
        raise _Wrong("an index is not what it should be")
    return tuple(parts)


def _published(entry: Any) -> tuple[str, str]:
    if not isinstance(entry, dict):
        raise _Wrong("'published' is not what it should be")
    index = _list(entry, "index")
    cell = address(_word(entry, "cell"), index)
    return f"{_word(entry, 'source')} {cell}", f"{_word(entry, 'printed')}: {_word(entry, 'verdict')}"
