"""What several verbs share: exit codes, common arguments, progress, the address of a cell."""

from __future__ import annotations

import argparse
import sys
import threading
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, TextIO

from ..cells.address import index_text, parts
from ..inputs.folders import WORD
from ..messages.diagnostics import visible

if TYPE_CHECKING:
    from ..messages.diagnostics import Check
    from ..result.result import Report
    from ..sheet import Column
    from ..study import Study

OK, FINDINGS, BUG = 0, 1, 3  # 2 is the exit code of an error that is told


def folder_argument(parser: argparse.ArgumentParser, more: str = "") -> None:
    """Take a FOLDER: a word for :func:`~loopsheet.report.inputs.folders.report_folder`, or `more`."""
    said = f"a folder with a report.toml (default: the working directory), or '{WORD}' for the shipped paper"
    said += more
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=named, help=said)


def folders_argument(parser: argparse.ArgumentParser) -> None:
    """Take any number of FOLDERs."""
    said = f"folders with a report.toml, or '{WORD}' for the shipped paper (default: all that are shipped)"
    parser.add_argument("folders", metavar="FOLDER", nargs="*", type=named, help=said)


def keeping_arguments(parser: argparse.ArgumentParser) -> None:
    """Take what hangs on what is kept from run to run, and on what takes how long."""
    parser.add_argument(
        "--no-cache", action="store_true", help="make everything again, and keep nothing for the next run"
    )
    parser.add_argument("--timing", action="store_true", help="tell at the end where the time went")


@contextmanager
def studied(folder: str | None) -> Iterator[Study]:
    """The study of a FOLDER, which tells on the terminal what it is about."""
    from ..inputs.folders import report_folder
    from ..study import Study

    with Progress(sys.stderr) as progress:
        yield Study(report_folder(folder), step=progress)


def result_argument(parser: argparse.ArgumentParser) -> None:
    """Take what `build` wrote, as :func:`~loopsheet.report.inputs.folders.result` does; else ``out``."""
    said = "what 'build' wrote, or the FOLDER that it was built from (default: out)"
    parser.add_argument("out", metavar="OUT", nargs="?", type=named, help=said)


def source_argument(parser: argparse.ArgumentParser) -> None:
    """Take the FOLDER of what `build` wrote, where that is not found by itself."""
    said = "the report folder, if OUT does not tell it"
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=named, help=said)


def named(text: str) -> str:
    """Read the name of a folder, for argparse: an empty one is a mistake, not the working directory."""
    if not text.strip():
        raise argparse.ArgumentTypeError(f"the name of a folder is empty: '{text}'")
    return text


def format_argument(parser: argparse.ArgumentParser, *formats: str) -> None:
    """Take --format; the first is the default."""
    parser.add_argument(
        "--format", choices=formats, default=formats[0], help=f"how it is printed (default: {formats[0]})"
    )


def count(text: str) -> int:
    """Read a whole number of at least 0, for argparse."""
    if not text.isdecimal() or len(text) > 9:
        raise argparse.ArgumentTypeError(f"not a whole number: '{text}'")
    return int(text)


def outcome(checks: Iterable[Check]) -> int:
    """The exit code of what was checked."""
    return OK if all(check.passed for check in checks) else FINDINGS


def say(sentence: str) -> None:
    """Print what may name files, at once."""
    print(visible(sentence), flush=True)


def answer(told: str, known: bool) -> int:
    """Print what is told of cells; the exit code: a cell that was asked for and has no value is a finding."""
    print(told)
    return OK if known else FINDINGS


def print_checks(checks: tuple[Check, ...], form: str, title: str, more: Mapping[str, Any]) -> None:
    """Print checks for a machine, in one of :data:`~loopsheet.report.views.checks.FORMATS`.

    `title`: what was checked, for formats with a heading. `more`: what JSON tells besides.
    """
    from ..views.checks import FORMATS

    print(FORMATS[form](checks, title, more), end="")


def told(checks: Iterable[Check]) -> list[str]:
    """What there is to tell of checks, a line each; findings last."""
    every = [
        (check.word or "not checked" * (check.skipped and check.kind != "engine"), check) for check in checks
    ]
    some = sorted((each for each in every if each[0]), key=lambda each: not each[1].passed)
    return [f"{word}: {check.sentence}" for word, check in some]


def tell(checks: Iterable[Check]) -> None:
    """Print what there is to tell of checks."""
    for line in told(checks):
        print(line)


class Progress:
    """Says what is being done once it has taken longer than a second; on a terminal in one moving line.

    `patience`: seconds after which a step is named where stages alone are.
    """

    def __init__(self, stream: TextIO, patience: float = 10) -> None:
        self.stream, self.begun, self.shown = stream, time.monotonic(), ""
        self._now, self._ended = "", threading.Event()
        self._patience, self._beside = patience, threading.Thread(target=self._name_the_long, daemon=True)

    def __call__(self, text: str) -> None:
        """Tell what is begun."""
        self._now = text = visible(text)
        if time.monotonic() - self.begun < 1:
            return
        if self.stream.isatty():
            self.stream.write("\r" + text.ljust(len(self.shown)))
            self.shown = text
        elif (stage := text.split(maxsplit=1)[0]) != self.shown:
            # Not a terminal: one line a stage, however many steps the stage has.
            self.stream.write(f"{stage} ...\n")
            self.shown = stage
        self.stream.flush()

    def _name_the_long(self) -> None:
        named = before = ""
        with suppress(OSError, ValueError):  # nobody reads it any more
            while not self._ended.wait(self._patience):
                if self._now == before != named:
                    named = before
                    self.stream.write(f"still {named} ...\n")
                    self.stream.flush()
                before = self._now

    def __enter__(self) -> Progress:
        if not self.stream.isatty():
            self._beside.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the moving line."""
        self._ended.set()
        if self._beside.is_alive():
            self._beside.join()
        if self.stream.isatty() and self.shown:
            self.stream.write("\r" + " " * len(self.shown) + "\r")
            self.stream.flush()


def find_one(report: Report, address: str) -> tuple[Column, tuple[int, ...]]:
    """The column of an address such as ``alpha[1-2]``, and the one row that it names.

    Raises
    ------
    UsageError
        There is no such cell, or more than one.
    """
    from ..messages.errors import UsageError, diagnose, listing

    column, labels = find(report, address)
    if len(labels) != 1:
        known = listing(report.values.cell(column.name, label).address for label in labels)
        raise UsageError(diagnose("LS604", kind="single cell", text=address, known=known, suggestion=""))
    return column, labels[0]


def _address(report: Report) -> str:
    """A cell of a report, as an example: one with an index, if there is one."""
    columns = [column for column in report.sheet.by_name.values() if report.values.labels(column)]
    column = next((each for each in columns if each.axis and each.equation), columns[0])
    return report.values.address(column.name, 0)


def find(report: Report, address: str) -> tuple[Column, list[tuple[int, ...]]]:
    """The column of an address such as ``alpha[1-2]``, and the rows that it names: all without an index.

    A row has its number, and the word by which it is known, if there is one: several may have the same.

    Raises
    ------
    UsageError
        There is no such column or row.
    """
    from ..messages.errors import UsageError, diagnose, listing, unknown

    found = parts(address)
    if found is None or address.startswith("("):
        known = f"a column, or a row of it in brackets, such as {_address(report)}"
        instead = f"'loopsheet prove \"{address}\"' tells of an equation" if address.startswith("(") else ""
        raise UsageError(diagnose("LS604", kind="cell", text=address, known=known, suggestion=instead))
    name, index = found
    if name not in report.sheet:
        raise unknown("cell", name, report.sheet.by_name, most=60)
    column = report.sheet[name]
    labels = report.values.labels(column)
    if not index:
        return column, labels
    words = report.words(column)
    numbered = [label for label in labels if index_text(label) == index]
    wanted = numbered or [label for label in labels if words.get(label) == index]
    if not wanted:
        for table, each in report.inputs.left_out:
            if table in report.inputs.beneath(column.axis) and str(each.test) in index.split("-"):
                said = f"{table.row} {each.test}"
                raise UsageError(diagnose("LS627", each.at, text=address, row=said, reason=each.reason))
        known = listing([index_text(label) for label in labels])
        if words:
            known += f"; or {listing(dict.fromkeys(words.values()))}"
        alone = "" if column.axis else f"{name} is a single number: '{name}' names it"
        raise UsageError(diagnose("LS604", kind=f"row of {name}", text=index, known=known, suggestion=alone))
    return column, wanted
