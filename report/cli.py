"""The command line: what is common to all verbs. Each verb is a module of :mod:`~loopsheet.report.verbs`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, TextIO

from .verbs import VERBS
from .verbs.common import BUG, OK, print_checks

if TYPE_CHECKING:
    from .errors import LoopsheetError

__all__ = ["main"]

_DESCRIPTION = (
    "Reports whose every number is traced to an equation, recomputed and compared with its publication."
)
_EPILOG = """\
Without FOLDER, every command works on the shipped paper.

exit codes:
  0  everything as expected
  1  findings: a proof fails, a published value differs unexpectedly, two reports are not the same
  2  the input or the command line is wrong; the message says where
  3  a bug of loopsheet

examples:
  loopsheet build                      the report of the shipped paper, in out/
  loopsheet new my-campaign            a folder to start your own from
  loopsheet build my-campaign --to html,pdf
  loopsheet prove "(11)"               how equation (11) follows, step by step
  loopsheet show alpha                 all cells of a column, with all digits
  loopsheet why "alpha[1-2]"           one number: its equation, its proof, what it rests on
  loopsheet check my-campaign --format github
  loopsheet verify out                 the same report again? if not, which number and why
  loopsheet diff out other/out         two results, number by number
"""


def _parser() -> argparse.ArgumentParser:
    from .. import __version__

    parser = argparse.ArgumentParser(
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
        sub.set_defaults(run=verb.run)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return its exit code."""
    from .errors import LoopsheetError, render_all

    options = argparse.Namespace(traceback=False)
    try:
        options = _parser().parse_args(arguments)
        code: int = options.run(options)
        sys.stdout.flush()
    except LoopsheetError as error:
        _tell_machines(error, options)
        print(render_all(error.diagnostics, color=_colored(sys.stderr)), file=sys.stderr)
        return error.exit_code
    except BrokenPipeError:
        # Whoever read us has seen enough; Python would complain once more while closing.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return OK
    except KeyboardInterrupt:
        print("\nstopped; nothing was half-written", file=sys.stderr)
        return 130
    except Exception as error:
        if options.traceback:
            raise
        print(f"bug: {type(error).__name__}: {error}", file=sys.stderr)
        print(
            "This is a fault of loopsheet, not of your input. 'loopsheet --traceback ...' shows where.",
            file=sys.stderr,
        )
        return BUG
    return code


def _tell_machines(error: LoopsheetError, options: argparse.Namespace) -> None:
    """Where findings are printed for a machine, it hears of wrong input too."""
    form = getattr(options, "format", "text")
    if form == "text":
        return
    from .findings import of_diagnostics

    print_checks(of_diagnostics(error.diagnostics), form, "The input is wrong", {})


def _colored(stream: TextIO) -> bool:
    return stream.isatty() and "NO_COLOR" not in os.environ
