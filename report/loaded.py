"""A report folder for Python users: its cells as arrays with units and standard uncertainties."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.typing import DTypeLike, NDArray

from .cells.address import index_text, parts
from .cells.values import CODES
from .column import Column
from .inputs.folders import report_folder
from .messages.errors import LoopsheetError, listing, suggest
from .quantity import behind
from .result.findings import checks
from .study import Recipe, Study
from .views.escape import html

Array = NDArray[np.float64]
MOST = 50
"""Rows that a notebook shows."""


@dataclass(frozen=True, eq=False)
class Estimates(NDArrayOperatorsMixin):
    """Estimates of a column of the sheet.

    Arithmetic, comparisons, ``len`` and ``bool`` are those of `value`, a plain array: none knows of `u`.

    Parameters
    ----------
    name, meaning, unit : str
        `unit` is that of the report; ``1`` for a pure number.
    value, u : float array (rows,)
        Estimates and standard uncertainties, in that unit; of a scalar both have no axis. NaN where there is
        none.
    index : tuple of str
        What the rows are called: ``2``, ``1-2``; empty for a scalar, of one row alone that row.
    names : tuple of str
        The same with the names that rows have in the table of measurements, ``2 (S-17)``; the words of
        groups.
    status : tuple of str
        ``ok``, or the code of a cell without a value: ``#NOROOT!``.
    texts, sure : tuple of str
        As the report shows the cells and their uncertainties, with units: of a cell without a value its code,
        of an uncertainty that is not known nothing.
    addresses, words : tuple of str
        Of the cells; and by which word a row is known, if it is.
    """

    name: str
    meaning: str
    unit: str
    value: Array
    u: Array
    index: tuple[str, ...]
    names: tuple[str, ...]
    status: tuple[str, ...]
    texts: tuple[str, ...] = field(repr=False)
    sure: tuple[str, ...] = field(repr=False)
    addresses: tuple[str, ...] = field(repr=False)
    words: tuple[str, ...] = field(repr=False)

    def __float__(self) -> float:
        """The value of a scalar."""
        return float(self.value)

    def __int__(self) -> int:
        """The value of a scalar, without its fraction."""
        return int(self.value)

    def __round__(self, digits: int | None = None) -> float:
        """The value of a scalar with so many decimals."""
        return round(float(self), digits)

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        """The values, for NumPy; of a scalar without an axis."""
        return np.array(self.value, dtype=dtype, copy=copy)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **more: Any) -> Any:
        """What a function of NumPy, or an operator, makes of the values."""
        values = (each.value if isinstance(each, Estimates) else each for each in inputs)
        if any(isinstance(each, Estimates) for each in more.get("out", ())):
            raise TypeError(
                f"{self.name} stays as it was computed: {self.name} = {self.name} + 1, say, is an array"
            )
        return getattr(ufunc, method)(*values, **more)

    def __bool__(self) -> bool:
        """Whether the value of a scalar is not 0; of several NumPy says that it is ambiguous."""
        return bool(self.value)

    def __len__(self) -> int:
        """How many rows it has; a scalar has no length."""
        return len(self.value)

    def __iter__(self) -> Iterator[float]:
        """The values, row by row; a scalar has none."""
        return iter(self.value.tolist())

    def __getitem__(self, rows: Any) -> Any:
        """The values of rows, which are counted from 0 as in an array of NumPy; of a text :meth:`of` that."""
        return self.of(rows) if isinstance(rows, str) else self.value[rows]

    def of(self, row: str | int) -> Estimates:
        """The estimate of a row, by its number or its word; several may have one word.

        Raises
        ------
        KeyError
            There is no such row.
        """
        named = ([n for n, each in enumerate(own) if each == str(row)] for own in (self.index, self.words))
        places = next(filter(None, named), [])
        if not places:
            known = listing([*self.index, *filter(None, dict.fromkeys(self.words))])
            raise KeyError(f"{self.name} has no row '{row}': {known or 'it is a single number'}")

        rowwise = {name: every for name, every in vars(self).items() if isinstance(every, tuple)}
        own: dict[str, Any] = {name: tuple(every[n] for n in places) for name, every in rowwise.items()}
        at = places if len(places) > 1 else places[0]
        return replace(self, value=np.asarray(self.value[at]), u=np.asarray(self.u[at]), **own)

    def __str__(self) -> str:
        """Its cells as the report shows them."""
        return ", ".join(self.texts)

    def __format__(self, how: str) -> str:
        """The value of a scalar with a format, ``{x:.2f}``; without one what it is."""
        return format(float(self.value), how) if how else str(self)

    @property
    def rows(self) -> tuple[tuple[str, str, str], ...]:
        """Address, cell and uncertainty as texts, row by row."""
        return tuple(zip(self.addresses, self.texts, self.sure, strict=True))

    def _repr_html_(self) -> str:
        """For a notebook: a table of its cells."""
        return _table([self])


class Loaded(Mapping[str, Estimates]):
    """A report: its quantities by their names.

    Attributes
    ----------
    title : str
    headline : tuple of str
        The names of the results.
    """

    def __init__(self, study: Study) -> None:
        self._study, self._report = study, (report := study.computed)
        self.title = report.title
        self.headline = tuple(name for name in report.workbook.headline if name in report.sheet)

    def __reduce__(self) -> tuple[Any, ...]:
        """Another process, or a copy, reads the same bytes again."""
        return _again, (self._study.recipe,)

    def _ipython_key_completions_(self) -> list[str]:
        """What a notebook proposes behind ``report[``."""
        return list(self)

    @cached_property
    def findings(self) -> tuple[str, ...]:
        """What there is to tell of it, findings and warnings, as `loopsheet check` tells it but of engines.

        Its equations are proved for that, the first time that it is asked for.
        """
        return tuple(f"{each.word}: {each.sentence}" for each in checks(self._study.proved) if each.word)

    def __getitem__(self, name: str) -> Estimates:
        """A column, or a cell of it by its address, ``alpha[1-2]``.

        Raises
        ------
        KeyError
            With the nearest name and all there are.
        """
        if not isinstance(name, str):
            raise KeyError(
                f"a quantity is asked for by its name, ['{next(iter(self), 'x')}'], not by {name!r}"
            )
        report = self._report
        own, row = parts(name) or (name, "")
        if row and own in report.sheet:
            return self[own].of(row)
        if name not in report.sheet:
            instead = suggest(name, self)
            raise KeyError(f"no quantity '{name}': {instead and instead + ' '}there are {', '.join(self)}")
        column, how = report.sheet[name], report.shown[name]
        cells = list(report.values.cells(name))
        shape = () if column.axis is None else (len(cells),)
        printed = [float(each.number) if each else np.nan for each in report.inputs.printed(name)]
        values = printed or [float(how.digits_of(each)) for each in report.values.value[name]]
        known = report.uncertain().u.get(name)
        u = np.full(len(cells), np.nan) if known is None else known
        return Estimates(
            name,
            column.meaning,
            how.unit,
            np.array(values).reshape(shape),
            (u / how.scale).reshape(shape),
            tuple(index_text(cell.label) for cell in cells) if shape else (),
            tuple(self._called(column, cell.label) for cell in cells) if shape else (),
            tuple(CODES[status] for status in report.values.status[name].tolist()),
            tuple(map(report.text, cells)),
            tuple(report.sure(name, each).text + behind(how.unit) if each > 0 else "" for each in u.tolist()),
            tuple(cell.address for cell in cells),
            tuple(report.words(column).get(cell.label, "") for cell in cells) if shape else (),
        )

    def _called(self, column: Column, index: tuple[int, ...]) -> str:
        """A row by its number, with its name if it is one of the table of measurements; or a group's word."""
        axis = column.axis
        if axis is None or not axis.is_given:
            return self._report.words(column).get(index) or index_text(index)
        return self._report.inputs.on(axis.name).called(index[0])

    def __iter__(self) -> Iterator[str]:
        return iter(self._report.sheet.by_name)

    def __len__(self) -> int:
        return len(self._report.sheet.by_name)

    def __repr__(self) -> str:
        told = ", ".join(text for name in self.headline for _, text, _ in self[name].rows)
        return f"<report '{self.title}'{': ' * bool(told)}{told}>"

    def _repr_html_(self) -> str:
        """For a notebook: title, results, and what there is to tell."""
        said = Markup("").join(Markup("<p>{}</p>").format(html(line)) for line in self.findings)
        results = _table([self[name] for name in self.headline])
        return Markup("<p><b>{}</b></p>{}{}").format(html(self.title), Markup(results), said)


def _again(recipe: Recipe) -> Loaded:
    return Loaded(Study.of(recipe))


def load(folder: str | Path) -> Loaded:
    """Compute a report folder.

    Parameters
    ----------
    folder : str or Path
        Or ``paper``, the shipped one. A method of one's own in it is run.

    Raises
    ------
    LoopsheetError
        With all that is wrong with its files, each with its place.

    Examples
    --------
    >>> paper = load("paper")
    >>> paper["alpha_mean"].texts, paper["alpha"].index[0], round(float(paper["alpha_mean"].u), 4)
    (('1.3026',), '1-2', 0.0035)
    """
    try:
        return Loaded(Study(report_folder(str(folder))))
    except LoopsheetError as error:
        raise error.with_traceback(None) from None  # what is wrong is in the folder, not on the way there


def _table(quantities: list[Estimates]) -> str:
    rows = [(row, one.meaning) for one in quantities for row in one.rows]
    line = Markup("<tr><th>{}</th><td>{}</td><td>{}</td><td>{}</td></tr>")
    shown = [line.format(*map(html, (*row, meaning))) for row, meaning in rows[:MOST]]
    more = [line.format("…", f"{len(rows) - MOST} more", "", "")] if len(rows) > MOST else []
    head = Markup("<tr><th></th><th>value</th><th>u</th><th></th></tr>")
    return Markup("<table>{}{}</table>").format(head, Markup("").join([*shown, *more]))
