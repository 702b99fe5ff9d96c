"""The class of which a method is one: its body is read as declarations, and makes a workbook."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from sympy import Sum

from ...derivations.equation import Ledger
from ...derivations.vocabulary import Quantity, Vocabulary, spelt
from ..axis import Axis, CountedAxis, PairAxis, RepeatAxis
from ..charts import Drawn
from ..column import Column, Formula, SheetError
from ..quantity import Bounds
from ..sheet import Sheet
from ..workbook import Measured, Parameter, RowTable, Workbook, tables_of
from .body import MethodBody
from .errors import CURRENT, WatchedBody

_FEW = 4.0
"""Where nothing else is said of it, a whole number is drawn from a half to twice as many."""


def _drawn(column: Column, bounds: Bounds, is_sure: bool) -> Quantity:
    """What is given, for proofs: it is drawn between its limits, or beyond the only one that it has.

    Nothing else is let in of an input; a parameter of a fit may be found elsewhere.
    """
    low, high = bounds.low, bounds.high
    if bounds.integer:  # the first and the last that is allowed
        low = low if low is None else math.floor(low) + 1 if bounds.low_open else math.ceil(low)
        high = high if high is None else math.ceil(high) - 1 if bounds.high_open else math.floor(high)
    known = (low, high) if is_sure else (None, None)
    if low is None or high is None:
        end = next((each for each in (low, high) if each is not None), 0.0)
        far = max(abs(end), _FEW if bounds.integer else 1.0) * (1 if high is None else -1)
        low, high = sorted((end + far / 2, end + 2 * far))
    own = column.name, column.meaning, column.unit, column.latex or spelt(column.name), (low, high)
    return Quantity(*own, bool(column.positive), "", *known, whole=bounds.integer)


def _words(body: MethodBody, place: int) -> Iterator[str]:
    """What the example of a table has in its columns of words, in a row from 1."""
    for axis in body.groups:
        said = body.examples.get(axis.members.by, "").split()
        yield said[place - 1] if place <= len(said) else f"S{(place + 1) // 2}"


def _table_of(axis: Axis, body: MethodBody, columns: Sequence[Measured]) -> RowTable:
    """A table of measured rows, with an example of what stands in it."""
    own = [one for one in columns if one.table == axis.name]
    groups = tuple(each.members.by for each in body.groups if each.members.of == axis)
    rows = zip(*(body.examples.get(one.name, "").split() for one in own), strict=False)
    head = (axis.row, *groups, *(f"{one.name} [{one.unit}]" for one in own))
    numbered = enumerate(rows, start=1)
    example = ((str(place), *(_words(body, place) if groups else ()), *row) for place, row in numbered)
    paired = any(isinstance(each, PairAxis) and each.of is axis for each in body.axes)
    return RowTable(axis.name, axis.row, 2 if paired else 1, groups, (head, *example))


def _means(body: MethodBody, results: Iterable[str]) -> Iterator[tuple[str, str]]:
    """The results that are means of a column over the rows of the data, with that column."""
    of_rows = [each for each in body.columns.values() if each.axis in body.row_axes]
    means = {Sum(c.cell, (c.axis.index, 1, c.axis.size)) / c.axis.size: c.name for c in of_rows if c.axis}
    for name in results:
        rule = body.columns[name].rule
        if isinstance(rule, Formula) and rule.expression in means:
            yield name, means[rule.expression]


def _refuse_undeclared(name: str, body: MethodBody, headline: Iterable[str]) -> None:
    """Refuse what is named and not declared, and a class that computes nothing."""
    for each in headline:
        if each not in body.columns:
            raise SheetError(f"the headline names {each}, which is not declared", each)
    for announced in body.announced:
        if announced not in body.columns:
            raise SheetError(
                f"{announced} is announced as unknown, and neither a root nor a fit finds it", announced
            )
    if not body.entries and body.ledger is None:
        raise SheetError(f"{name} computes nothing: it has no let(...), no root(...) and no fit(...)", name)


def _last(sheet: Sheet, body: MethodBody) -> tuple[str, ...]:
    """The results where no headline says them: what fits find, and single numbers that nothing rests on."""
    # What nothing but a curve rests on is a result all the same.
    others = (c for c in sheet.columns if not isinstance(c.axis, CountedAxis | RepeatAxis))
    used = {each.name for c in others for each in sheet.precedents(c) if each.name != c.name}
    scalars = (c.name for c in sheet.columns if c.axis is None and c.equation)
    return tuple(each for each in scalars if body.of_fits.get(each, each not in used))


def _vocabulary(body: MethodBody) -> Vocabulary:
    """What has limits, for proofs."""
    bounds = {one.name: one.bounds for one in body.inputs} | body.bounds
    limited = (one for one, said in bounds.items() if said.integer or (said.low, said.high) != (None, None))
    return Vocabulary(*(_drawn(body.columns[one], bounds[one], one not in body.bounds) for one in limited))


def _tables_of_rows(body: MethodBody, columns: Sequence[Measured]) -> Sequence[RowTable]:
    """The tables in which something is measured: the first one where nothing is."""
    used = {one.table for one in columns}
    for axis in body.row_axes[1:]:
        if axis.name not in used:
            of = next((each for each, value in body.items() if value is axis), axis.name)
            said = f"what stands in their table says so, measured(..., of={of})"
            raise SheetError(f"nothing is measured of the {axis.name}: {said}", of)
    tables = [_table_of(axis, body, columns) for axis in body.row_axes]
    return [one for one in tables if one.name in used] or tables[:1]


def workbook_of(
    name: str, body: MethodBody, title: str, source: str, headline: Sequence[str], prose: str
) -> Workbook:
    """All that a class of that name declares."""
    _refuse_undeclared(name, body, headline)
    entries, columns = tuple(body.entries), body.whole
    sheet, curves = Sheet(columns), Drawn(tuple(body.drawn), body.drawn_given)
    Sheet((*columns, *curves.columns))  # a name that both have is told now
    results = tuple(headline) or _last(sheet, body)
    taken = body.ledger or Ledger((), vocabulary=_vocabulary(body))
    in_tables = {*body.aside, *(each for spec in body.tables for each in spec.columns)}
    given_to = tuple(one for one in body.inputs if isinstance(one, Parameter))
    columns_of = tuple(one for one in body.inputs if isinstance(one, Measured))
    only, *others = _tables_of_rows(body, columns_of)
    several = (only, *others) if others else ()
    if not several:  # the only one needs no name
        columns_of = tuple(replace(each, table="") for each in columns_of)
    return Workbook(
        name=re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower(),
        title=title,
        source=source,
        ledger=lambda: replace(taken, entries=(*taken.entries, *entries)),
        measured=columns_of,
        parameters=given_to,
        sheet=lambda names: body.optional.sheet(columns, names),
        either=tuple(body.optional.either),
        headline=results,
        row=only.row,
        least=only.least,
        curves=tuple(body.curves),
        means=tuple(_means(body, results)),
        claims=tuple(body.claims),
        constants=frozenset(body.constants),
        margins=body.margins,
        aside=frozenset(body.aside),
        tables=(*body.tables, *(tables_of(sheet, in_tables) if body.tables and not prose else ())),
        prose=prose or "generic",
        figures=tuple(body.figures),
        drawn=(lambda sheet: curves) if curves.columns else None,
        groups=only.groups,
        example=only.example if columns_of else (),
        several=several,
        example_parameters={
            one.name: body.examples[one.name] for one in given_to if one.name in body.examples
        },
    )


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

        `rows`, `index`, `size` and `ledger` are those of the body, which was given them before it was read.

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
