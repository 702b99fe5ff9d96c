"""The tables of report.toml: their keys, texts and lists of names, each looked at where it stands."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from ..messages.errors import Findings, Location, close, listing, suggest
from .keys import TABLES, fixed, for_left_out
from .parameters import wrong_type

if TYPE_CHECKING:
    from .tomlfile import TomlFile


class TomlTables:
    """What is read of the tables of a TOML file.

    `findings`: where findings go.
    """

    def __init__(self, toml: TomlFile, findings: Findings) -> None:
        self.toml, self.findings = toml, findings

    def keys(
        self,
        table: tuple[str, ...],
        own: Iterable[str] = (),
        alone: bool = False,
        why_not: Callable[[str], str] = lambda _: "",
    ) -> dict[str, Any]:
        """Return a table after a look at its keys; an absent one, or no table at all, is empty.

        `table`: its place, one of :data:`~loopsheet.report.inputs.keys.TABLES`. `own`: what there may be
        besides, names of the folder's own; `alone`: in place of all others. `why_not`: what helps with a key
        that has a meaning elsewhere.
        """
        known = (*own, *(() if alone else fixed(*table)))
        where = "[" + ".".join(table) + "]" if table else "report.toml"
        # A key above the first table header and a table of the same name look alike to a beginner.
        data = self.table(table, f"a table {where}", f"{where} on a line of its own")
        for key in data:
            if key not in known:
                suggestion = for_left_out(key) or why_not(key) or suggest(key, known)
                allowed = listing(known) if known else "no key"
                self.findings.add(
                    "LS203",
                    self.toml.key(*table, key),
                    text=key,
                    table=where,
                    known=allowed,
                    suggestion=suggestion,
                )
        return {key: value for key, value in data.items() if key in known}

    def table(self, path: tuple[str, ...], wanted: str, example: str) -> dict[str, Any]:
        """Return a table with whatever is in it; an absent one, or no table at all, is empty.

        `wanted` and `example`: what is told of one that is no table.
        """
        data: Any = self.toml.data
        for name in path:
            data = data.get(name, {}) if isinstance(data, dict) else {}
        if isinstance(data, dict):
            return data
        wrong_type(self.toml, self.findings, path, wanted, example)
        return {}

    def text(
        self, table: tuple[str, ...], key: str, example: str | None = None, required: bool = False
    ) -> str | None:
        """Return the text of a key, if it is there and is text on one line.

        Messages propose the example: without it, that of :data:`~loopsheet.report.inputs.keys.TABLES`.
        """
        if example is None:
            example = TABLES[table][key].example.strip('"')
        data: Any = self.toml.data
        for name in table:
            data = data.get(name, {})
            if not isinstance(data, dict):
                return None  # keys() has reported it
        name = key if re.fullmatch(r"[\w-]+", key, re.ASCII) else f'"{key}"'
        line = f'{name} = "{example}"'
        if key not in data:
            # A misspelt key is one problem, not two.
            if required and not any(close(word, [key]) for word in data):
                where = "[" + ".".join(table) + "]" if table else "report.toml"
                self.findings.add("LS204", self.toml.key(*table), text=key, table=where, example=line)
            return None
        path = (*table, key)
        value = data[key]
        if not isinstance(value, str):
            several = key == "file" and isinstance(value, list)
            more = ": the rows of several files go into one" if several else ""
            wrong_type(self.toml, self.findings, path, f"text in quotes{more}", line)
            return None
        control = re.search("[\x00-\x1f\x7f-\x9f\u2028\u2029\ufffe\uffff]", value)
        if control:
            self.findings.add("LS112", self.toml.value(*path), text=f"U+{ord(control.group()):04X}")
            return None
        if not value.strip():
            self.findings.add(
                "LS403", self.toml.value(*path), name=key, allowed=f"text, such as {line}", suggestion=""
            )
            return None
        return value.strip()

    def names(self, *path: str) -> dict[str, Location]:
        """Return a list of names, each with its place."""
        data: Any = self.toml.data
        for key in path:
            data = data.get(key, [])
        if not isinstance(data, list) or not all(isinstance(name, str) for name in data):
            wrong_type(self.toml, self.findings, path, "a list of names in quotes", f'{path[-1]} = ["C_log"]')
            return {}
        return dict.fromkeys(data, self.toml.value(*path))
