"""The workbook that a report folder names: a shipped one, or the user's own code."""

from __future__ import annotations

import importlib
import sys
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from .kept_workbook import known_workbook
from .messages.errors import ForeignCode, UnknownWorkbook
from .own_workbook import own_workbook
from .partly import is_partly
from .workbooks import SHIPPED

if TYPE_CHECKING:
    from .workbook import Workbook


def _imported(name: str) -> Workbook:
    workbook: Workbook = importlib.import_module(SHIPPED[name]).WORKBOOK
    return workbook


@cache
def _known(name: str) -> Workbook:
    return known_workbook(name, partial(_imported, name))


def find_workbook(name: str, folder: Path, code: bytes | None = None) -> Workbook:
    """The workbook of a name: a shipped one, or the user's own ``NAME.py`` in the folder.

    Parameters
    ----------
    code : bytes, optional
        What that file held when it was read. It is run: whoever names a folder to be computed asks for it.

    Raises
    ------
    UnknownWorkbook
        With the names there are.
    InputError
        The user's own workbook cannot be run, or declares none.
    """
    if name in SHIPPED:
        return _imported(name) if SHIPPED[name] in sys.modules else _known(name)
    if code is None:
        raise UnknownWorkbook([*SHIPPED, *sorted(p.name for p in folder.glob("*.py"))])
    return own_workbook(folder / name, code)


def is_shipped(workbook: Workbook) -> bool:
    """Whether a workbook is a shipped one, and not somebody's own that is called as one is."""
    name = workbook.name
    return name in SHIPPED and (is_partly(workbook) or find_workbook(name, Path()) is workbook)


def shipped_workbook(name: str, folder: Path, code: bytes | None = None) -> Workbook:
    """The same, for whoever did not ask to run what is in the folder.

    Raises
    ------
    ForeignCode
        The workbook is code of the folder.
    """
    if name not in SHIPPED and code is not None:
        raise ForeignCode(name)
    return find_workbook(name, folder, code)
