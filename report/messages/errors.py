"""What is wrong, told: findings by their codes, the errors that carry them, and the nearest known word."""

from __future__ import annotations

import errno
import re
from collections.abc import Iterable, Sequence
from typing import Any

from .catalogue import CATALOGUE
from .diagnostics import Diagnostic, Location, render, render_all, visible

__all__ = [
    "EXHAUSTED",
    "Diagnostic",
    "Findings",
    "ForeignCode",
    "InputError",
    "Location",
    "LoopsheetError",
    "OutputError",
    "UnknownWorkbook",
    "UsageError",
    "close",
    "diagnose",
    "listing",
    "render",
    "render_all",
    "sentence_case",
    "some",
    "suggest",
    "unknown",
    "why",
    "wrong",
]


EXHAUSTED = frozenset(
    getattr(errno, name)
    for name in ("ENOSPC", "EDQUOT", "EFBIG", "EMFILE", "ENFILE", "ENOMEM", "EAGAIN", "EROFS", "EIO")
    if hasattr(errno, name)
)
"""What the system says when the machine, or what somebody allowed us of it, is used up: no bug of ours."""


def why(error: Exception, of: str = "") -> dict[str, Any]:
    """Why something cannot be written, and what helps: of a full disk, no permission does."""
    full = getattr(error, "errno", 0) in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
    there = "move away what is there" if isinstance(error, FileExistsError) else ""
    helps = there or ("make room" if full else f"check the permissions {of}".rstrip())
    return {"reason": getattr(error, "strerror", None) or str(error), "suggestion": helps}


def diagnose(code: str, at: Location | None = None, **fields: object) -> Diagnostic:
    """Make a finding from its code, its place and what its sentences name."""
    entry = CATALOGUE[code]
    words = {}
    for name, value in fields.items():
        text, most = str(value), 60 if name == "text" else 400
        words[name] = visible(text if len(text) <= most else text[: most - 3] + "...")
    message, allowed, hint = (template.format_map(words) for template in entry[1:])
    return Diagnostic(code, message, at or Location(), allowed, hint)


def suggest(word: str, known: Iterable[str]) -> str:
    """Return "did you mean ...?" for the nearest known word, or nothing.

    >>> suggest("x-p", ["v", "e", "x_p"]), suggest("u_e", ["e", "u(v)", "u(e)"])
    ("did you mean 'x_p'?", "did you mean 'u(e)'?")
    """
    return f"did you mean '{nearest}'?" if (nearest := close(word, known)) else ""


def close(word: str, known: Iterable[str], likeness: float = 0.6) -> str | None:
    """Return the known word that is nearest to a misspelt one, if one is near; else one of its letters."""
    if len(word) > 60:  # difflib takes quadratic time, and no name of ours is as long
        return None
    import difflib  # only errors need it

    by_lower = {name.lower(): name for name in reversed(list(known))}
    found = difflib.get_close_matches(word.lower(), by_lower, n=1, cutoff=likeness)
    letters = [*filter(str.isalnum, word.lower())]
    found += [name for name in by_lower if [*filter(str.isalnum, name)] == letters]
    return by_lower[found[0]] if found else None


def listing(words: Iterable[str], most: int = 12, last: str = "or") -> str:
    """Return words for "allowed": ``a, b or c``; past `most` they are cut."""
    names = list(words)
    if len(names) > most:
        return ", ".join(names[:most]) + f" ... ({len(names)} in all)"
    return f" {last} ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


NAMED = 6
"""So many of what is found are named; the rest are counted."""


def some(parts: Sequence[str]) -> str:
    """The first parts, and how many more there are.

    >>> some(["a"]), some(["a", "b", "c"]), some(list("abcdefgh"))
    ('a', 'a, b and c', 'a, b, c, d, e, f and 2 more')
    """
    left = len(parts) - NAMED
    return listing([*parts[:NAMED], *([f"{left} more"] if left > 0 else [])], NAMED + 1, last="and")


def sentence_case(said: str) -> str:
    """What is said with a capital at its beginning, if that is a plain word: a symbol and ``pH`` stay.

    >>> sentence_case("force by Johnson")
    'Force by Johnson'
    >>> sentence_case("pH by an electrode")
    'pH by an electrode'
    """
    return said[0].upper() + said[1:] if re.match(r"[a-z]{2,}\b|a(?= )", said) else said


class Findings:
    """Collects findings, so that a user hears of all of them at once.

    A file of a million wrong cells would fill the memory with sentences that nobody reads: past
    :attr:`most` they are dropped.
    """

    most = 1000

    def __init__(self) -> None:
        self.found: list[Diagnostic] = []

    @property
    def full(self) -> bool:
        """Whether there is no use in looking further."""
        return len(self.found) >= self.most

    def add(self, code: str, at: Location | None = None, **fields: object) -> None:
        """Keep one finding."""
        if not self.full:
            self.found.append(diagnose(code, at, **fields))

    def check(self) -> None:
        """Raise :class:`InputError` if there are findings."""
        if self.found:
            raise InputError(*self.found)


class LoopsheetError(Exception):
    """What the user can put right: it carries findings and ends the run with exit code 2.

    Parameters
    ----------
    *diagnostics : Diagnostic
        One or more; they are kept sorted by file, line and column.
    """

    exit_code = 2

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__(*diagnostics)
        self.diagnostics = tuple(sorted(diagnostics, key=lambda diagnostic: diagnostic.order))

    def __str__(self) -> str:
        """Show the findings, without colour."""
        return render_all(self.diagnostics)


class InputError(LoopsheetError):
    """The files of a report folder are not as they must be."""


class OutputError(LoopsheetError):
    """An output cannot be written where it should go."""


class UsageError(LoopsheetError):
    """A word of the command line is not known."""


def wrong(reason: str, known: str) -> UsageError:
    """What is raised where options do not go together, or say what cannot be meant."""
    return UsageError(diagnose("LS614", reason=reason, known=known))


def unknown(kind: str, text: str, known: Iterable[str], most: int = 12) -> UsageError:
    """What is raised of a word that is none of those that are known, with the nearest of them."""
    names = list(known)
    told = listing(names, most)
    return UsageError(diagnose("LS604", kind=kind, text=text, known=told, suggestion=suggest(text, names)))


class UnknownWorkbook(LookupError):
    """No workbook has this name."""

    def __init__(self, known: Iterable[str] = ()) -> None:
        self.known = tuple(known)
        super().__init__(self.known)


class ForeignCode(Exception):
    """The workbook is a file of the folder, which nobody asked to run."""
