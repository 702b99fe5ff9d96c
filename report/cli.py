"""The command line: what is common to all verbs. Each verb is a module of :mod:`~loopsheet.report.verbs`."""

from __future__ import annotations

import argparse
import io
import os
import re
import shlex
import signal
import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TextIO, cast

from .machine.memory import ample
from .machine.stopping import heeded, stoppable
from .machine.streams import Outlet, opened
from .machine.timing import RUN
from .messages.diagnostics import VisibleStream
from .verbs import VERBS
from .verbs.common import BUG, print_checks

if TYPE_CHECKING:
    from .messages.diagnostics import Check
    from .messages.errors import LoopsheetError, UsageError

_DESCRIPTION = (
    "Reports whose every number is traced to an equation, recomputed and compared with its publication."
)
_EPILOG = """\
FOLDER is a folder with a report.toml: without it the working directory, and the word 'paper' is the shipped
paper. A report goes to FOLDER/out, that of the paper to out.

exit codes:
  0  everything as expected
  1  findings: a proof fails, a published value differs unexpectedly, two reports are not the same, a cell
     that 'show' or 'budget' is asked for has no value, a card is made from data that 'check' finds fault with
  2  the input or the command line is wrong; the message says where
  3  a bug of loopsheet
  130 and 143 where it was interrupted or ended: nothing is half-written then

what was made of the same inputs before is not made again (--no-cache does); --timing tells where time goes

examples:
  loopsheet build paper                the report of the shipped paper, in out/
  loopsheet new my-campaign            a folder to start your own from
  loopsheet build my-campaign --to html,pdf
  loopsheet check my-campaign --format github
and in such a folder, or with its name or 'paper' at the end:
  loopsheet build                      the report, in out/
  loopsheet watch                      the same whenever a file is saved, shown in the browser
  loopsheet prove "(11)"               how equation (11) follows, step by step
  loopsheet show alpha                 all cells of a column, with all digits
  loopsheet why "alpha[1-2]"           one number: its equation, its proof, what it rests on
  loopsheet budget alpha_mean          how uncertain it is, and where that comes from
  loopsheet design --speeds "2, 4 m/s" how uncertain a number of a planned campaign will be
  loopsheet card --for mujoco          parameters with which a simulation returns what was measured
  loopsheet verify                     the same report again? if not, which number and why
  loopsheet diff out other/out         two results, number by number
  loopsheet validate --out record.txt  all shipped examples on this machine, as a record for the files
"""
_FIRST = "'loopsheet new my-campaign' makes a folder to start from, 'loopsheet --help' tells more"


class _Parser(argparse.ArgumentParser):
    """Tells what is wrong as all else is told, and takes options before, after and between the words."""

    _mixing = False

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """As argparse does, which of a verb's own words takes only those that stand together."""
        if self._mixing or self._subparsers is not None:
            return super().parse_known_args(args, namespace)
        self._mixing = True  # what mixes asks here, twice
        try:
            return self.parse_known_intermixed_args(args, namespace)
        finally:
            self._mixing = False

    def error(self, message: str) -> NoReturn:
        raise _wrong(message, self.prog)


def _wrong(reason: str, command: str) -> UsageError:
    from .messages.errors import UsageError, diagnose

    hint = f"'{command} --help' tells what it takes"
    return UsageError(diagnose("LS617", reason=reason, known="", suggestion=hint))


def _parser() -> argparse.ArgumentParser:
    from .. import __version__

    parser = _Parser(
        prog="loopsheet",
        description=_DESCRIPTION,
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"loopsheet {__version__}")
    parser.add_argument("--traceback", action="store_true", help="show where a bug happened")
    verbs = parser.add_subparsers(dest="verb", metavar="COMMAND", required=True)
    for name, verb in VERBS.items():
        text = verb.HELP
        sub = verbs.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        verb.arguments(sub)
        sub.set_defaults(run=verb.run, options=re.findall(r"--[a-z-]+", sub.format_usage()))
    return parser


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Read the command line; a word that is not known is answered with the nearest."""
    from .inputs.folders import is_report, written
    from .messages.errors import UsageError, diagnose, listing, suggest, unknown

    arguments = _ended(arguments)
    words = [word for word in arguments if not word.startswith("-")]  # no option before the verb takes a word
    if words and words[0] not in VERBS:
        hint = suggest(words[0], VERBS)
        if is_report(folder := Path(words[0])):
            hint = f"'loopsheet build {written(folder)}' builds that folder"
        known = listing(VERBS)
        raise UsageError(diagnose("LS604", kind="command", text=words[0], known=known, suggestion=hint))
    if set(arguments) <= {"--traceback"}:
        raise UsageError(
            diagnose("LS617", reason="no command is named", known=listing(VERBS), suggestion=_FIRST)
        )
    options, left = _parser().parse_known_args(_verb_first(arguments))
    if left and left[0].startswith("-"):
        raise unknown("option", left[0], options.options)
    if left:
        raise _wrong(f"'{left[0]}' is a word too many", f"loopsheet {options.verb}")
    _in_order(options)
    return options


def _ended(arguments: Sequence[str]) -> list[str]:
    """A command line without the ``--`` behind which no word is an option: a folder ``-x`` is ``./-x``."""
    at = arguments.index("--") if "--" in arguments else len(arguments)
    behind = (f"./{word}" if word.startswith("-") else word for word in arguments[at + 1 :])
    return [*arguments[:at], *behind]


def _verb_first(arguments: Sequence[str]) -> list[str]:
    """A command line whose verb stands before the options that are the verb's."""
    at = next((n for n, word in enumerate(arguments) if word in VERBS), 0)
    own = [word for word in arguments[:at] if word in ("--traceback", "--version", "--help", "-h")]
    return [*own, arguments[at], *(word for word in arguments[:at] if word not in own), *arguments[at + 1 :]]


def _in_order(options: argparse.Namespace) -> None:
    """Refuse a folder that stands where what is asked of it should."""
    from .inputs.folders import WORD, is_report, report_folder, written
    from .messages.errors import UsageError, diagnose

    named = getattr(options, "folder", None)
    word = getattr(options, "cell", None) or (named and getattr(options, "equation", None))
    if not word or is_report(Path(named or "")) or not (word == WORD or is_report(Path(word))):
        return
    asked = shlex.quote(named) if named else "CELL"
    reason = f"'{word}' is a folder: what is asked of it stands before it"
    hint = f"'loopsheet {options.verb} {asked} {written(report_folder(word))}'"
    raise UsageError(diagnose("LS617", reason=reason, known="", suggestion=hint))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return its exit code."""
    ample()
    opened()
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # a terminal of another encoding still gets all
    told = cast(TextIO, Outlet(sys.stdout))
    with (
        redirect_stdout(cast(TextIO, VisibleStream(told))),
        redirect_stderr(cast(TextIO, Outlet(sys.stderr, OSError))),
    ):
        try:
            with stoppable():
                return _run(arguments)
        except KeyboardInterrupt as error:
            print("\nstopped; nothing was half-written", file=sys.stderr)
            return 128 + getattr(error, "number", signal.SIGINT)
        except SystemExit:  # of help
            told.flush()
            raise


def _run(arguments: Sequence[str] | None) -> int:
    from .messages.diagnostics import Check, visible
    from .messages.errors import LoopsheetError, UsageError, diagnose

    options = argparse.Namespace(traceback=False)
    try:
        with heeded():  # reading the command line imports, too
            options = _parse(sys.argv[1:] if arguments is None else arguments)
        with heeded(), _kept(options):
            code: int = options.run(options)
            sys.stdout.flush()
            if getattr(options, "timing", False):
                from .machine.kept import told

                print(*RUN.lines(), told(), sep="\n", file=sys.stderr)
    except LoopsheetError as error:
        return _refuse(error, options)
    except Exception as error:
        if (reason := _exhausted(error)) is not None:
            return _refuse(UsageError(diagnose("LS622", reason=reason)), options)
        if options.traceback:
            raise
        said = f"{type(error).__name__}: {error}"
        _tell_machines((Check("bug", type(error).__name__, False, said),), "A fault of loopsheet", options)
        print(f"bug: {visible(said)}", file=sys.stderr)
        print(
            "This is a fault of loopsheet, not of your input. 'loopsheet --traceback ...' shows where.",
            file=sys.stderr,
        )
        return BUG
    return code


def _kept(options: argparse.Namespace) -> AbstractContextManager[None]:
    """What a run may take from another one, and leave for it."""
    if not getattr(options, "no_cache", False):
        return nullcontext()
    from .machine.kept import nothing_kept

    return nothing_kept()


def _refuse(error: LoopsheetError, options: argparse.Namespace) -> int:
    """Tell what the user can put right, machines too, as far as anything can be written still."""
    from .messages.errors import render_all
    from .result.findings import of_diagnostics

    _tell_machines(of_diagnostics(error.diagnostics), "The input is wrong", options)
    print(render_all(error.diagnostics, color=_colored(sys.stderr)), file=sys.stderr)
    return error.exit_code


def _exhausted(error: Exception) -> str | None:
    """What the machine has no more of, if that is what happened."""
    from .messages.errors import EXHAUSTED

    if isinstance(error, MemoryError):
        return "no memory is left"
    if isinstance(error, OSError) and error.errno in EXHAUSTED:
        return f"{error.strerror}: {error.filename}" if error.filename else error.strerror
    # A library that cannot be opened is told by a sentence alone.
    words = map(os.strerror, sorted(EXHAUSTED))
    return next((word for word in words if isinstance(error, ImportError) and word in str(error)), None)


def _tell_machines(found: tuple[Check, ...], title: str, options: argparse.Namespace) -> None:
    """Where findings are printed for a machine it hears of the end too, as far as it can be told."""
    form = getattr(options, "format", "text")
    try:
        if form != "text":
            print_checks(found, form, title, {})
        sys.stdout.flush()
    except OSError:
        cast(Outlet, sys.stdout).drop()  # what nobody gets is not tried once more while Python closes


def _colored(stream: TextIO) -> bool:
    return stream.isatty() and "NO_COLOR" not in os.environ
