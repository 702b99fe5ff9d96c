"""Where the time of a run went: parts of it by name, each without the parts inside of it."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager


class Timing:
    """The seconds of some parts, in the order in which they were begun first."""

    def __init__(self) -> None:
        self.begun = time.perf_counter()
        self.seconds: dict[str, float] = {}
        self._inside: list[float] = []

    @contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Count the time of the block to a part."""
        self.seconds.setdefault(name, 0.0)
        begun = time.perf_counter()
        self._inside.append(0.0)
        try:
            yield
        finally:
            taken = time.perf_counter() - begun
            self.seconds[name] += taken - self._inside.pop()
            if self._inside:
                self._inside[-1] += taken

    def lines(self) -> Iterator[str]:
        """Tell it, a line a part."""
        whole = time.perf_counter() - self.begun
        rest = {"everything else": whole - sum(self.seconds.values()), "in all": whole}
        for name, seconds in {**self.seconds, **rest}.items():
            yield f"{seconds:8.3f} s  {name}"
        yield f"{time.process_time():8.3f} s  of the processor, from the start of Python on"


RUN = Timing()
"""That of this process."""

timed = RUN.part
