"""What was checked, for machines: JSON, JUnit's XML, GitHub's annotations and Markdown."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

from ..messages.diagnostics import Check, visible
from . import markdown as md

Checks = Sequence[Check]
Details = Mapping[str, Any]


def summary(checks: Checks) -> str:
    """How many are as expected, in a line.

    >>> summary([Check("proof", "(1)", True, "(1) is proved"), Check("engine", "x", True, "", skipped=True)])
    '2 checks: 1 as expected, 0 findings, 1 not checked'
    """
    passed, failed, warned, skipped = _tally(checks)
    parts = [
        f"{passed} as expected",
        _count(failed, "finding"),
        *([_count(warned, "warning")] * bool(warned)),
        *([f"{skipped} not checked"] * bool(skipped)),
    ]
    return f"{_count(len(checks), 'check')}: {', '.join(parts)}"


def _tally(checks: Checks) -> tuple[int, int, int, int]:
    """How many are as expected, findings, warnings, not checked."""
    failed, skipped = sum(not check.passed for check in checks), sum(check.skipped for check in checks)
    warned = sum(check.word == "warning" for check in checks)
    return len(checks) - failed - warned - skipped, failed, warned, skipped


def _count(number: int, word: str) -> str:
    return f"{number} {word}{'s' * (number != 1)}"


def lines(checks: Checks) -> list[str]:
    """What there is to tell, a line each, without the place: for what is carried away from its folder.

    >>> lines([Check("data", "cells", False, "v[3] has no value"), Check("proof", "(1)", True, "it stands")])
    ['finding: v[3] has no value']
    """
    return [f"{check.word}: {visible(check.message)}" for check in checks if check.word]


def as_json(checks: Checks, title: str, more: Details) -> str:
    """One object: the findings as sentences, all checks, and what the caller adds."""
    content = {
        "schema": 1,
        "title": title,
        "passed": all(check.passed for check in checks),
        "findings": [check.sentence for check in checks if not check.passed],
        "checks": [
            {
                "kind": check.kind,
                "name": check.name,
                "passed": check.passed,
                "skipped": check.skipped,
                "note": check.note or None,
                "message": check.message,
                "file": check.at.path or None,
                "line": check.at.line,
                "column": check.at.column,
            }
            for check in checks
        ],
        **more,
    }
    text = json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False)
    # A character that steers a terminal is escaped as JSON does it; all others are as they were written.
    return "".join(c if c == "\n" or visible(c) == c else json.dumps(c)[1:-1] for c in text) + "\n"


def as_junit(checks: Checks, title: str, more: Details) -> str:
    """JUnit's XML: a suite for each kind of check."""
    root = ET.Element("testsuites", {"name": "loopsheet", **_counts(checks)})
    for kind in dict.fromkeys(check.kind for check in checks):
        own = [check for check in checks if check.kind == kind]
        suite = ET.SubElement(root, "testsuite", {"name": visible(f"{title}: {kind}"), **_counts(own)})
        for check in own:
            case = ET.SubElement(suite, "testcase", classname=f"loopsheet.{kind}", name=visible(check.name))
            if check.at.path:
                case.set("file", visible(check.at.path))
            if check.at.line is not None:
                case.set("line", str(check.at.line))
            if check.skipped:
                ET.SubElement(case, "skipped", message=visible(check.message))
            elif not check.passed:
                failure = ET.SubElement(case, "failure", type=kind, message=visible(check.message))
                failure.text = visible(check.sentence)
            elif check.note:
                ET.SubElement(case, "system-out").text = visible(f"{check.word}: {check.sentence}")
    ET.indent(root, " ")
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _counts(checks: Checks) -> dict[str, str]:
    return {
        "tests": str(len(checks)),
        "failures": str(sum(not check.passed for check in checks)),
        "errors": "0",
        "skipped": str(sum(check.skipped for check in checks)),
    }


def as_github(checks: Checks, title: str, more: Details) -> str:
    """GitHub's workflow commands: an annotation at the place of each finding, then a line for the log."""
    lines = []
    for check in checks:
        if not check.word and not check.skipped:
            continue
        at = check.at
        where = {"file": _from_here(at.path)} if at.path else {}
        if at.line is not None:
            where["line"] = str(at.line)
            if at.column is not None:
                where |= {"col": str(at.column), "endColumn": str(at.column + at.length)}
        where["title"] = f"{check.kind} {check.name}"
        properties = ",".join(f"{name}={_property(text)}" for name, text in where.items())
        word = {"finding": "error", "warning": "warning"}.get(check.word, "notice")
        lines.append(f"::{word} {properties}::{_data(check.message)}")
    return "".join(f"{line}\n" for line in (*lines, summary(checks)))


def _from_here(path: str) -> str:
    """As the user wrote it; if that was a full path, from the folder in which the command runs."""
    full = Path(path)
    if full.is_absolute() and full.is_relative_to(Path.cwd()):
        return full.relative_to(Path.cwd()).as_posix()
    return path


def _data(text: str) -> str:
    return visible(text).replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")


def as_markdown(checks: Checks, title: str, more: Details) -> str:
    """A heading, how many of each kind are as expected, and a table of the findings and warnings."""
    kinds = []
    for kind in dict.fromkeys(check.kind for check in checks):
        own = [check for check in checks if check.kind == kind]
        kinds.append([md.cell(kind), *map(str, _tally(own))])
    text = f"### {md.cell(title)}\n\n{summary(checks)}\n\n"
    text += md.table(["checked", "as expected", "findings", "warnings", "not checked"], kinds)
    found = [
        [
            md.cell(c.word),
            md.code(f"{c.kind} {c.name}"),
            md.code(str(c.at) if c.at.path else ""),
            md.cell(c.message),
        ]
        for c in checks
        if c.word
    ]
    return text + ("\n" + md.table(["", "check", "where", "what"], found) if found else "")


FORMATS: dict[str, Callable[[Checks, str, Details], str]] = {
    "json": as_json,
    "junit": as_junit,
    "github": as_github,
    "markdown": as_markdown,
}
"""Each takes the checks, a title, and what JSON tells besides."""
