"""Work beside the main work: drawing takes as long as judging, and neither needs the other."""

from __future__ import annotations

import errno
import gc
import multiprocessing
import os
import warnings
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Generic, TypeVar

from .stopping import unstoppable, worker

__all__ = ["Background"]

T = TypeVar("T")
_PATIENCE = 5.0
"""Seconds in which a process that is told to end takes back what it has begun."""


class Background(Generic[T]):
    """A function running in a process of its own, where the system can fork; else when it is asked for.

    Parameters
    ----------
    work : callable
        Takes nothing; what it returns must be plain data. It sees the memory as it is now.
    """

    def __init__(self, work: Callable[[], T]) -> None:
        self._work = work
        self._process = None
        if "fork" not in multiprocessing.get_all_start_methods():
            return
        context = multiprocessing.get_context("fork")
        self._receiver, sender = context.Pipe(duplex=False)
        self._process = context.Process(target=_run, args=(work, sender, os.getpid()), daemon=True)
        with warnings.catch_warnings(), unstoppable():
            # Forking beside NumPy's idle threads is what the warning is about; the child does not use them.
            warnings.simplefilter("ignore", DeprecationWarning)
            self._process.start()
        sender.close()

    def __enter__(self) -> Background[T]:
        return self

    def __exit__(self, *_: object) -> None:
        self.cancel()

    def result(self) -> T:
        """Wait for the result; what the work raised is raised here."""
        if self._process is None:
            return self._work()
        try:
            outcome, error = self._receiver.recv()
        except EOFError:
            self._process.join()
            reason = f"a process of ours was ended by somebody else (code {self._process.exitcode})"
            outcome, error = None, OSError(errno.ENOMEM, reason)  # the system does so when memory is short
        self._process.join()
        self._process = None
        if error is not None:
            raise error
        result: T = outcome
        return result

    def cancel(self) -> None:
        """Stop it, if it still runs."""
        if self._process is not None:
            with unstoppable():
                self._process.terminate()
                self._process.join(_PATIENCE)
                self._process.kill()
                self._process.join()


def _run(work: Callable[[], T], sender: Connection, parent: int) -> None:
    def send() -> None:
        gc.freeze()  # what was inherited is no garbage, and looking at it would copy it
        try:
            outcome: tuple[object, Exception | None] = (work(), None)
        except Exception as error:
            outcome = (None, error)
        with suppress(BrokenPipeError):  # nobody waits for it
            sender.send(outcome)

    worker(parent, send)
