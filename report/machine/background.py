"""Work beside the main work, in a fresh process, which shares no memory, threads or locks with this one."""

from __future__ import annotations

import errno
import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import IO, Any, Generic, TypeVar

from .memory import ample
from .stopping import unstoppable, worker

T = TypeVar("T")
_PATIENCE = 5.0
"""Seconds in which a process that is told to end takes back what it has begun."""


class LateArgument(Generic[T]):
    """An argument that is not known yet when a call begins: told to it while it runs."""

    def __init__(self) -> None:
        self.told: list[T] = []

    def wait(self) -> T:
        """What was told: where the call runs, once it is."""
        if not self.told:
            self.told.append(pickle.load(sys.stdin.buffer))
        return self.told[0]


class Telling:
    """An argument that is called with what is done now, and is heard where the result is waited for."""

    hear: Callable[[str], None]

    def __call__(self, text: str) -> None:
        """Tell it."""
        self.hear(text)


class Background(Generic[T]):
    """A call of a function in a process of its own; where none may be begun, when the result is asked for.

    Parameters
    ----------
    function : callable
        Of a module; what it returns must be plain data.
    *arguments : anything
        Plain data, too; the last may be a :class:`LateArgument`, which has to be told, or :class:`Telling`.
    """

    def __init__(self, function: Callable[..., T], *arguments: Any) -> None:
        self._call = function, arguments
        self._process: subprocess.Popen[bytes] | None = None
        code = f"import sys; sys.path[:] = {sys.path!r}; from {__name__} import serve; serve({os.getpid()})"
        with unstoppable(), suppress(PermissionError, FileNotFoundError):
            self._process = subprocess.Popen(
                [sys.executable, "-c", code],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=True,  # what a terminal sends to all is for the parent
            )
        if self._process is not None and self._process.stdin is not None:
            with suppress(BrokenPipeError):  # it has ended, and that is told when somebody asks
                self._process.stdin.write(pickle.dumps(self._call))
                self._process.stdin.flush()
                if not any(isinstance(argument, LateArgument) for argument in arguments):
                    self._process.stdin.close()

    def __enter__(self) -> Background[T]:
        return self

    def __exit__(self, *_: object) -> None:
        self.cancel()

    def tell(self, value: Any) -> None:
        """What the last argument is."""
        self._call[1][-1].told.append(value)
        if self._process is not None and self._process.stdin is not None:
            with suppress(BrokenPipeError):
                self._process.stdin.write(pickle.dumps(value))
                self._process.stdin.close()

    def result(self, step: Callable[[str], None] = lambda _: None) -> T:
        """Wait for the result; what the function raised is raised here, what it tells is told to `step`."""
        if self._process is None or self._process.stdout is None:
            function, arguments = self._call
            return function(*_heard(arguments, step))
        while isinstance(told := _loaded(self._process.stdout), str):
            step(told)
        code = self._process.wait()
        self._close()
        if told is None:
            reason = f"a process of ours was ended by somebody else (code {code})"
            raise OSError(errno.ENOMEM, reason)  # the system does so when memory is short
        outcome, error = told
        if error is not None:
            raise error
        result: T = outcome
        return result

    def cancel(self) -> None:
        """Stop it, if it still runs."""
        if self._process is None:
            return
        with unstoppable():
            self._process.terminate()
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(_PATIENCE)
            self._process.kill()
            self._process.wait()
            self._close()

    def _close(self) -> None:
        process, self._process = self._process, None
        for pipe in (process.stdin, process.stdout) if process is not None else ():
            if pipe is not None:
                with suppress(BrokenPipeError):
                    pipe.close()


def _loaded(pipe: IO[bytes]) -> Any:
    """What was told next; None where nothing, or not all of it, comes any more."""
    try:
        return pickle.load(pipe)
    except (EOFError, pickle.UnpicklingError):
        return None


def _heard(arguments: tuple[Any, ...], hear: Callable[[str], None]) -> tuple[Any, ...]:
    """Arguments, of which those that tell something are heard."""
    for argument in arguments:
        if isinstance(argument, Telling):
            argument.hear = hear
    return arguments


def serve(parent: int) -> None:
    """Do in this process what another one asks for, and tell it.

    `parent`: the process that asks, by its number.
    """
    ample()
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # nothing that is printed goes into the answer

    def tell(told: object) -> None:
        with suppress(BrokenPipeError):  # nobody waits for it
            answer.write(pickle.dumps(told))
            answer.flush()

    def work() -> None:
        try:
            function, arguments = pickle.load(sys.stdin.buffer)
            outcome: tuple[object, Exception | None] = (function(*_heard(arguments, tell)), None)
        except EOFError:
            return  # nobody asks any more
        except Exception as error:
            outcome = (None, error)
        tell(outcome)

    worker(parent, work)
