"""The record of a validation, for a laboratory's files: as text, as Markdown and as data."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from ..quantity import behind
from ..result.result import Comparison
from ..result.validation import Example, Validation
from .blocks import Block, Heading, TextTable, printers
from .checks import as_json, as_junit

TITLE = "Validation of loopsheet"
SIGNED = ("Date", "Place and machine", "Name and signature")
"""What is left for whoever files it: the record has no clock."""


def _blocks(record: Validation) -> Iterator[Block]:
    """For a terminal, for paper, for a pull request or a wiki."""
    yield Heading(1, TITLE)
    yield [record.verdict]
    yield TextTable(("computed by", ""), list(record.by.items()))
    for example in record.examples:
        yield from _of_example(example)
    yield Heading(2, "Filed")
    yield TextTable(("", ""), [(word, "_" * 40) for word in SIGNED])


def _of_example(example: Example) -> Iterator[Block]:
    report, failed = example.report, example.failed
    yield Heading(2, f"{example.name}: {report.title}")
    yield [f"{example.word}: {report.workbook.source}"]
    passed = sum(proof.status.passes for proof in report.proofs)
    rows = [("proofs", f"{passed} of {len(report.proofs)} equations stand")]
    rows += [("engine", " ".join(agreement.line.split())) for agreement in report.engines]
    yield TextTable(("", "against 50 digits"), rows)
    if compared := report.every_comparison:
        header = ("where", "what", "published", "computed", "verdict")
        yield TextTable(header, [_row(each) for each in compared])
    for check in failed:
        yield [f"FAIL {check.kind} {check.message}"]


def _row(compared: Comparison) -> tuple[str, ...]:
    printed = compared.published.printed
    unit = behind(printed.unit)
    said = (compared.published.source, compared.cell.address, f"{printed.text}{unit}")
    return (*said, f"{compared.again}{unit if compared.cell.value is not None else ''}", _verdict(compared))


def _verdict(compared: Comparison) -> str:
    """Whether it passes; why it is known to differ, if it is."""
    if not compared.as_expected:
        return f"FAIL ({compared.word})"
    if compared.published.expect:
        return f"known difference: {compared.published.reason}"
    return "pass"


def _details(record: Validation) -> dict[str, Any]:
    """What JSON tells besides the checks."""
    return {
        "verdict": record.verdict,
        "by": dict(record.by),
        "examples": [_details_of(example) for example in record.examples],
    }


def _details_of(example: Example) -> Mapping[str, Any]:
    names = ("where", "what", "published", "computed", "verdict")
    report = example.report
    return {
        "name": example.name,
        "title": report.title,
        "source": report.workbook.source,
        "passed": not example.failed and (example.compares or None),
        "engines": [agreement.data for agreement in report.engines],
        "published": [dict(zip(names, _row(each), strict=True)) for each in report.every_comparison],
    }


FORMATS: Mapping[str, Callable[[Validation], str]] = {
    **printers(_blocks),
    "json": lambda record: as_json(record.checks, TITLE, _details(record)),
    "junit": lambda record: as_junit(record.checks, TITLE, {}),
}
"""What prints a record, by the name of the format."""
