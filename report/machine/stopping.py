"""How a run is stopped: SIGINT, SIGTERM and SIGHUP unwind it once, so that everything begun is taken back."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any, NoReturn

_SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
_PATIENCE = 10.0
"""Seconds in which a second signal does not disturb what the first one made us take back."""


class Stopped(KeyboardInterrupt):
    """Somebody asked us to end."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


class _Stop:
    """The signals of this process: what came, whether it has to wait, and which was raised."""

    def __init__(self) -> None:
        self.shields, self.waiting = 0, 0
        self.begin()

    def begin(self) -> None:
        self.raised, self.number = -_PATIENCE, 0

    def __call__(self, number: int, _: FrameType | None = None) -> None:
        if self.shields:
            self.waiting = number
        elif time.monotonic() - self.raised > _PATIENCE:
            self.throw(number)

    def throw(self, number: int) -> NoReturn:
        self.raised, self.waiting, self.number = time.monotonic(), 0, number
        raise Stopped(number)

    def lost(self, found: Any) -> None:
        """Raise again what was raised in a destructor, of which Python only tells."""
        if not isinstance(found.exc_value, Stopped):
            if not self.number:  # else the destructor of what was not finished complains
                sys.__unraisablehook__(found)
            return
        self.raised = -_PATIENCE
        self.shields += 1  # here it would be lost again
        threading.Thread(target=self.again, args=(found.exc_value.number,), daemon=True).start()
        self.shields -= 1

    def again(self, number: int) -> None:
        """Send a signal to ourselves once it can be heeded."""
        while self.shields:
            time.sleep(0.01)
        time.sleep(0.05)
        os.kill(os.getpid(), number)


_stop = _Stop()


@contextmanager
def stoppable() -> Iterator[None]:
    """Raise :class:`Stopped` in the block when the process is told to end; only the main thread can."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, _stop) for number in _SIGNALS if _heeded(number)}
    hook, sys.unraisablehook = sys.unraisablehook, _stop.lost
    _stop.begin()
    try:
        yield
    except Stopped as stopped:
        traceback.clear_frames(stopped.__traceback__)  # what was not finished goes while we are heard
        raise
    finally:
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)


def _heeded(number: int) -> bool:
    """Whether a signal is not ignored: ``nohup`` and shells that start us in the background say so."""
    return signal.getsignal(number) not in (signal.SIG_IGN, None)


@contextmanager
def heeded() -> Iterator[None]:
    """Raise :class:`Stopped` for what others made of it: an import that it ended raises what it likes."""
    try:
        yield
    except Exception as error:
        if not _stop.number:
            raise
        raise Stopped(_stop.number) from error


@contextmanager
def unstoppable() -> Iterator[None]:
    """Do the block as a whole: who is told to end in it ends after it."""
    _stop.shields += 1
    try:
        yield
    finally:
        _stop.shields -= 1
    if _stop.waiting and not _stop.shields:
        _stop.throw(_stop.waiting)


def worker(parent: int, work: Callable[[], None]) -> None:
    """Work in a process that was just begun for it: it ends with its parent, not before.

    What a terminal sends to all is for the parent, which ends its workers by SIGTERM. If the parent is
    killed, nobody does: then the worker tells itself.
    """
    _stop.shields = 1  # until there is somebody to catch what it throws
    sys.unraisablehook = _stop.lost
    for number in _SIGNALS:
        signal.signal(number, _stop if number == signal.SIGTERM else signal.SIG_IGN)
    threading.Thread(target=_end_with, args=(parent,), daemon=True).start()
    with suppress(Stopped):  # nobody waits for it
        try:
            _stop.shields = 0
            if _stop.waiting:
                _stop.throw(_stop.waiting)
            work()
        finally:
            _stop.shields = 1  # it ends anyway


def _end_with(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(0.2)
    os.kill(os.getpid(), signal.SIGTERM)
