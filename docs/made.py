"""What the reference has from the sources: a line ``<!-- made: NAME -->`` of a page becomes that."""

from __future__ import annotations

import inspect
import io
import json
import os
import re
from collections.abc import Callable, Iterable, Mapping
from contextlib import redirect_stdout, suppress
from pathlib import Path
from typing import Any

from loopsheet.report.files.form import Form, schema
from loopsheet.report.files.manifest import Manifest
from loopsheet.report.files.values import Result
from loopsheet.report.inputs import about, keys
from loopsheet.report.messages.catalogue import CATALOGUE, GROUPS
from loopsheet.report.method.lines import FUNCTIONS
from loopsheet.report.method.words import Method
from loopsheet.report.verbs import VERBS

MESSAGES = Path(__file__).parent.parent / "tests" / "hostile" / "messages.txt"
"""Messages, as a test provokes them."""
PLACE = re.compile(r"^<!-- made: (\w+) -->$", re.MULTILINE)


def filled(page: str) -> str:
    """A page with what it shall have from the sources."""
    return PLACE.sub(lambda place: MADE[place[1]](), page)


# ------------------------------------------------------------------------------------- commands
def commands() -> str:
    """Each command as its ``--help`` tells it."""
    parts = [f"```text\n{helped()}```\n"]
    for name in VERBS:
        parts.append(f"(loopsheet-{name})=\n## loopsheet {name}\n\n```text\n{helped(name)}```\n")
    return "\n".join(parts)


def helped(*words: str) -> str:
    """What ``--help`` prints."""
    from loopsheet.report.cli import main

    before, printed = os.environ.get("COLUMNS"), io.StringIO()
    os.environ["COLUMNS"] = "100"  # argparse asks it
    try:
        with redirect_stdout(printed), suppress(SystemExit):
            main([*words, "--help"])
    finally:
        del os.environ["COLUMNS"]
        os.environ.update({} if before is None else {"COLUMNS": before})
    return printed.getvalue()


# --------------------------------------------------------------------------------------- errors
def errors() -> str:
    """Each code as a test provokes it; where none does, the sentences."""
    examples = {
        match[1]: block
        for block in re.split(r"\n\n(?=\w+\[)", MESSAGES.read_text(encoding="utf-8").strip())
        if (match := re.match(r"\w+\[(LS\d+)\]", block))
    }
    parts = []
    for group, title in GROUPS.items():
        parts.append(f"## {title}\n")
        for code in (code for code in CATALOGUE if code.startswith(group)):
            said = f"```text\n{examples[code]}\n```\n" if code in examples else _said(code)
            parts.append(f"({code.lower()})=\n### {code}: {CATALOGUE[code].title}\n\n{said}")
    return "\n".join(parts)


def _said(code: str) -> str:
    """The sentences of a code; what they name is written in italics."""
    entry = CATALOGUE[code]
    lines = [("", entry.message), ("Allowed: ", entry.allowed), ("Help: ", entry.hint)]
    return "".join(f"{head}{_open(text)}\n\n" for head, text in lines if re.sub(r"{\w+}", "", text).strip())


def _open(template: str) -> str:
    escaped = re.sub(r"([\\`*_<>#\[\]|~$])", r"\\\1", template)
    return re.sub(r"{([\w\\]+)}", lambda field: f"*{field[1]}*", escaped)


# ------------------------------------------------------------------------------ files that are read
def report_toml() -> str:
    """Each table of report.toml with its keys."""
    parts = []
    for table, entries in keys.TABLES.items():
        name = ".".join("NAME" if part == keys.ANY else part for part in table)
        if table and table[-1] == keys.ANY and table[:-1] != ("uncertainty", "shared"):
            title = f"`NAME = {{ ... }}` in `[{name.removesuffix('.NAME')}]`"
        else:
            title = f"`[{name}]`" if table else "Above all tables"
        parts.append(f"### {title}\n\n{_keys(entries)}")
    return "\n".join(parts)


def measurements_csv() -> str:
    """The columns of the table of measurements."""
    return _keys(keys.MEASURED)


def published_csv() -> str:
    """The columns of published.csv."""
    return _keys(keys.PUBLISHED)


def told_of_cells() -> str:
    """What `cell` may be in published.csv besides the name of a column."""
    _, _, forms = (about.__doc__ or "").partition("\n\n")
    rows = (re.split(r"  +", line, maxsplit=1) for line in forms.strip().splitlines())
    return _table(("cell", "what it is"), ((f"`{form}`", said) for form, said in rows))


def _keys(entries: Mapping[str, keys.Key]) -> str:
    called = {name: "*a name*" if name == keys.ANY else f"`{name}`" for name in entries}
    rows = (
        (called[name], f"{key.meaning}{' Must be there.' * key.required}", f"`{key.example}`")
        for name, key in entries.items()
    )
    return _table(("key", "meaning", "example"), rows)


# --------------------------------------------------------------------------- files that are written
def values_json() -> str:
    """The fields of values.json."""
    return _forms(Result)


def manifest_json() -> str:
    """The fields of manifest.json."""
    return _forms(Manifest)


def _forms(form: type[Form]) -> str:
    """A table for each struct of a JSON schema."""
    parts = []
    for name, told in json.loads(schema(form))["$defs"].items():
        said, meanings = _described(told["description"])
        spare = [f"`{name}`" for name in told["properties"] if name not in told.get("required", ())]
        rows = (
            (f"`{field}`", meanings.get(field, ""), _kind(kind)) for field, kind in told["properties"].items()
        )
        head = f"(json-{name.lower()})=\n### {name}\n\n{said}\n"
        parts.append(f"{head}\n{_table(('field', 'meaning', 'form'), rows)}")
        parts.append(f"May be missing: {', '.join(spare)}.\n" if spare else "")
    return "\n".join(parts)


def _described(docstring: str) -> tuple[str, dict[str, str]]:
    """The first sentences of a docstring, and what it says of each parameter."""
    said, parameters = _parts(docstring)
    return said, {name: text for names, text in parameters for name in re.split(", *", names)}


def _parts(docstring: str) -> tuple[str, list[tuple[str, str]]]:
    """What stands above the parameters, and each of these, or several together, with what it is."""
    said, _, parameters = inspect.cleandoc(docstring).partition("\nParameters\n----------\n")
    found = re.findall(r"^([\w, ]+?)(?: : .*)?\n((?:    .*\n?)*)", parameters, re.MULTILINE)
    return " ".join(said.split()), [(names, " ".join(text.split())) for names, text in found]


def _kind(told: Mapping[str, Any]) -> str:
    """A type of a JSON schema in words."""
    if "$ref" in told:
        name = told["$ref"].rpartition("/")[2]
        return f"[{name}](#json-{name.lower()})"
    if "enum" in told:
        return " or ".join(map(str, told["enum"]))
    if "anyOf" in told:
        return " or ".join(dict.fromkeys(_kind(one) for one in told["anyOf"]))
    if told.get("type") == "array":
        return f"list of {_one(told['items'])}" if told.get("items") else "list"
    if told.get("type") == "object":
        inner = told.get("additionalProperties")
        return f"table of {_one(inner)}" if isinstance(inner, Mapping) else "table"
    return str(told.get("type", "anything"))


def _one(told: Mapping[str, Any]) -> str:
    """The same of the entries of a list or of a table."""
    kind = _kind(told)
    return f"({kind})" if " or " in kind else kind


# ------------------------------------------------------------------------------------------ Python
def method() -> str:
    """What may stand behind the name of a method."""
    _, parameters = _parts(type(Method).__new__.__doc__ or "")
    return _table(("word", "meaning"), ((f"`{names}`", text) for names, text in parameters))


def functions() -> str:
    """What may stand in a formula besides powers."""
    return ", ".join(f"`{name}`" for name in FUNCTIONS)


def _table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    def line(cells: Iterable[str]) -> str:
        return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"

    head = tuple(head)
    return line(head) + line("---" for _ in head) + "".join(map(line, rows))


MADE: dict[str, Callable[[], str]] = {
    make.__name__: make
    for make in (
        *(commands, errors, report_toml, measurements_csv, published_csv, told_of_cells),
        *(values_json, manifest_json, method, functions),
    )
}
"""What a page may ask for."""
