"""Other programs, run within a time limit: they and all that they start end with us."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from .stopping import unstoppable

_SHOWN = 300
"""How much of a program's message is shown."""


class ProgramFailed(Exception):
    """A program that was found did not do its work."""


def run(
    command: Sequence[str],
    seconds: float,
    text: str | None = None,
    folder: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> str:
    """The output of a program; it and all that it starts end within the time, and when we are stopped.

    Parameters
    ----------
    text : str, optional
        What it reads.
    folder : Path, optional
        Where it works.
    environment : mapping of str to str, optional
        All of it, if it is another one than ours.

    Raises
    ------
    ProgramFailed
        It cannot be started, takes too long, or ends with an error.
    """
    try:
        with unstoppable():
            process = subprocess.Popen(
                list(command),
                stdin=subprocess.DEVNULL if text is None else subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                encoding="utf-8",
                errors="replace",
                start_new_session=True,
                cwd=folder,
                env=environment,
            )
    except OSError as error:
        raise ProgramFailed(str(error)) from error
    try:
        out, said = process.communicate(text, timeout=seconds)
    except subprocess.TimeoutExpired as error:
        raise ProgramFailed(f"took more than {seconds:g} s") from error
    finally:
        if process.poll() is None:
            with unstoppable():
                _end(process)
    if process.returncode:
        message = " ".join(said.split()) or "no message"
        raise ProgramFailed(f"ended with code {process.returncode}: {message[:_SHOWN]}")
    return out


def _end(process: subprocess.Popen[str]) -> None:
    """End a program and what it started: soffice is a script, and the office its child."""
    if hasattr(os, "killpg"):
        os.killpg(process.pid, signal.SIGKILL)
    else:
        process.kill()
    process.communicate()
