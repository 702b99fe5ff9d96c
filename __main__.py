"""The command `loopsheet`, which `python -m loopsheet` is, too."""

import os
import signal
import sys
from contextlib import suppress
from typing import NoReturn


def command() -> NoReturn:
    """The program: one command, and the end of the process."""
    # Until main() heeds it, Ctrl-C ends us without a word: it would be a traceback of the imports.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from .report.cli import main

    code = main()
    if code > 128:
        # Somebody stopped it, in the middle of an import perhaps: Python's own way out may crash there.
        with suppress(OSError):
            sys.stdout.flush()
        os._exit(code)
    raise SystemExit(code)


if __name__ == "__main__":
    # `python -m` looks for modules where one stands first: a numpy.py in a report folder is none of ours.
    if sys.path[0] == os.getcwd():
        del sys.path[0]
    command()
