"""The class of which a method is one: its body is read as declarations, and makes a workbook."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from ...derivations.equation import Ledger
from ..column import SheetError
from ..workbook import Workbook
from .body import MethodBody
from .errors import CURRENT, WatchedBody
from .made import workbook_of


class _Declaring(type):
    """Makes a workbook of the body of a class."""

    workbook: Workbook

    @classmethod
    def __prepare__(
        cls, name: str, bases: tuple[type, ...], /, *, rows: str = "readings",
        index: str = "k", size: str = "n", **more: Any,
    ) -> MethodBody:  # fmt: skip
        body = WatchedBody(rows, index, size, more.get("ledger"))
        if bases:
            CURRENT.set(body)
        if bases and bases != (Method,):
            raise SheetError("a method is a class of Method alone")
        return body

    def __new__(
        cls, name: str, bases: tuple[type, ...], body: Mapping[str, Any], /, *, source: str = "",
        headline: str = "", rows: str = "", index: str = "", size: str = "",
        ledger: Ledger | None = None, prose: str = "",
    ) -> _Declaring:  # fmt: skip
        """Take what the body declared; the first line of its docstring is the title.

        Parameters
        ----------
        source : str
            Where the method is published.
        headline : str
            The names of the results, first in every view: single numbers, and columns of groups, which have a
            line for each group. Without, the parameters of fits, and else that of which nothing else is
            computed.
        rows, index, size : str
            What the rows of the table of measurements are called, ``readings``, their running number in
            formulas, ``k``, and how many there are, ``n``.
        ledger : Ledger
            The equations that :func:`by` takes, with their proofs and their vocabulary. It says which rows a
            sum leaves out; elsewhere they follow from what results rest on.
        prose : str
            The narrative of the report, in templates/prose; it says itself which tables it shows.
        """
        found = super().__new__(cls, name, bases, dict(body))
        if bases:
            assert isinstance(body, WatchedBody)
            body.refuse_nameless()
            if body.wrong:
                raise body.first_wrong
            CURRENT.set(None)
            title = (found.__doc__ or name).strip().partition("\n")[0].removesuffix(".")
            found.workbook = workbook_of(name, body, title, source, re.findall(r"\w+", headline), prose)
        return found


class Method(metaclass=_Declaring):
    """A method of one's own: `class Name(Method, source=...)` with its title and its quantities as its body.

    Attributes
    ----------
    workbook : Workbook
        What it declares, in the order in which it stands there.
    """
