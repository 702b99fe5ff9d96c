"""values.json: every cell in SI with its status, the proofs, and the verdicts on what is published."""

from __future__ import annotations

from decimal import Decimal
from pathlib import Path
from typing import Annotated

from msgspec import UNSET, Meta, UnsetType, field

from .form import Form, Index, Schema, Text, read

NAME = "values.json"

Number = float | None
Bounds = list[Number] | None
Cells = list[Number] | Number
Words = list[str | None] | str | None
Row = int | Annotated[Index, Meta(min_length=1)]


class Marked(Form, frozen=True, kw_only=True):
    """How many of the rows that a scalar rests on, `rows` `of` so many, carry a mark."""

    cell: Text
    mark: Text
    rows: int
    of: int


class Unit(Form, frozen=True, kw_only=True):
    """A unit that is not that of SI.

    Parameters
    ----------
    text : str
        ``mm`` or ``degC``.
    scale : number
        One of it in SI.
    zero : number
        Its zero in SI: 273.15 of ``degC``.
    """

    text: Text
    scale: Annotated[float, Meta(gt=0)]
    zero: float = 0.0

    def of(self, value: Number) -> Number:
        """A value in SI in this unit, without the digits that a rounded quotient would add.

        >>> Unit(text="degC", scale=1.0, zero=273.15).of(293.1)
        19.95
        """
        if value is None:
            return None
        exactly, zero, scale = (Decimal(repr(each)) for each in (float(value), self.zero, self.scale))
        return float((exactly - zero) / scale)


class Column(Form, frozen=True, kw_only=True):
    """One column: of an index set lists, of a scalar one cell; rows made of each row of another are counted.

    Parameters
    ----------
    axis : str or null
        The index set.
    of : str
        Whose rows those of the axis are made of: such rows are as many as pairs times points.
    unit : str
        SI; 1 for a pure number.
    shown : Unit
        In which people read it, where that is another one: all numbers here are in SI.
    rule : str
        Its equation with its number; ``given`` for what the user gave, empty if it is not told.
    index : list
        The number of each row, or the numbers of its tests.
    size : int
        The number of rows that are counted and not listed.
    value : number or null
        In SI, unrounded; null where there is none.
    text : str or null
        The same as people read it, in `shown`, with the digits that its uncertainty leaves; what was given as
        it was printed.
    status : str
        ``ok`` or the code of an error; how many rows have each, where they are counted.
    reason : str or null
        Why there is no root, or more than one.
    u : number or null
        The standard uncertainty, in SI; null where there is no value, and where nothing is known.
    mark : str or null
        That it lies outside of what its source allows.
    rows : table of int
        Over how many rows of each index set a reduction ran.
    marked : list
        What carries a mark among the rows that it rests on.
    """

    axis: Text | None = None
    of: Text | UnsetType = UNSET
    unit: Text
    shown: Unit | UnsetType = UNSET
    rule: Text = ""
    size: Annotated[int, Meta(ge=0)] | UnsetType = UNSET
    index: list[Row] | UnsetType = UNSET
    value: Cells | UnsetType = UNSET
    text: Words | UnsetType = UNSET
    status: list[str] | dict[str, int] | str
    reason: Words | UnsetType = UNSET
    u: Cells | UnsetType = UNSET
    mark: Words | UnsetType = UNSET
    rows: dict[str, int] | UnsetType = UNSET
    marked: list[Marked] | UnsetType = UNSET

    def __post_init__(self) -> None:
        if self.axis is None:
            fit = isinstance(self.value, float | int | None) and isinstance(self.status, str)
        elif self.of is not UNSET:
            fit = self.size is not UNSET and isinstance(self.status, dict)
        else:
            parts = self.index, self.value, self.status
            fit = all(isinstance(part, list) for part in parts)
            fit = fit and len({*map(len, parts), len(set(self.index))}) == 1  # type: ignore[arg-type]
        if not fit:
            raise ValueError("its rows do not fit together")

    @property
    def cells(self) -> dict[Index, tuple[Number, str]]:
        """The value in SI and the status of every row that is listed."""
        if isinstance(self.status, str):
            return {(): (self.value, self.status)}  # type: ignore[dict-item]
        if self.index is UNSET:
            return {}
        labels = (label if isinstance(label, tuple) else (label,) for label in self.index)
        return dict(zip(labels, zip(self.value, self.status, strict=True), strict=True))  # type: ignore[arg-type]

    @property
    def uncertainties(self) -> dict[Index, Number]:
        """The standard uncertainty of every row that is listed; none where the file tells nothing of them."""
        if self.u is UNSET or isinstance(self.status, dict):
            return {}
        every = self.u if isinstance(self.u, list) else [self.u]
        return dict(zip(self.cells, every, strict=False))


class Oddity(Form, frozen=True, kw_only=True):
    """What is odd about the data themselves."""

    kind: Text
    name: Text
    word: Text
    sentence: Text


class Expanded(Form, frozen=True, kw_only=True):
    """The expanded uncertainty of a result.

    Parameters
    ----------
    cell : str
        Its address.
    U : number or null
        In SI; null where none is known.
    k, level : number or null
        The coverage factor and the coverage probability.
    dof : number or null
        Effective degrees of freedom; null where there are no finite ones.
    """

    cell: Text
    U: Number
    k: Number
    level: Number
    dof: Number = None


class Conformity(Form, frozen=True, kw_only=True):
    """Whether a cell lies where it has to.

    Parameters
    ----------
    cell : str
        Its address.
    limits : str
        The tolerance limits as they are stated.
    acceptance : two numbers or null
        Between which it is accepted, in SI; null for an end that there is none of, or that is not known.
    accepted : str
        The same as people read it, in the unit that its column is shown in, with the digits that the guard
        band has; empty without one, where it is not known, and where nothing is accepted.
    probability : number or null
        That the quantity lies within the tolerance limits; null where no distribution is known.
    decision : str
    """

    cell: Text
    limits: Text
    acceptance: tuple[Number, Number]
    accepted: Text | UnsetType = UNSET
    probability: Number = None
    decision: Text

    @property
    def column(self) -> str:
        """The name of its column."""
        return self.cell.partition("[")[0]


class Erratum(Form, frozen=True, kw_only=True):
    """What is wrong with the print of the source."""

    about: Text
    kind: Text
    sentence: Text


class Published(Form, frozen=True, kw_only=True):
    """A published value beside its recomputation.

    Parameters
    ----------
    source, cell, index
        Where it stands, and which cell it is.
    printed, unit : str
        As it is printed.
    value : number or null
        The cell, in SI.
    again : str
        The cell, printed in the same way.
    distance : number or null
        The cell minus what is published, in units of its last printed digit.
    verdict : str
        The referee's word; without it, whether the cell prints the same.
    interval, bounds : two numbers or null
        What inputs that print as given were seen to yield, and what none of them can leave, in SI.
    expected : bool
        Whether there is nothing to find.
    finding : str or null
    """

    source: Text
    cell: Text
    index: list[int]
    printed: Text
    unit: Text = ""
    value: Number = None
    again: Text = ""
    distance: Number = None
    verdict: Text
    interval: Bounds = None
    bounds: Bounds = None
    expected: bool = True
    finding: Text | None = None


class Witness(Form, frozen=True, kw_only=True):
    """A cell of the best input that was found, in the unit that it is printed in."""

    cell: Text
    index: list[int]
    value: float


class Table(Form, frozen=True, kw_only=True):
    """A table as a whole.

    Parameters
    ----------
    source, verdict : str
    values : int
        How many.
    mismatch : number or null
        The worst of them for the best input that was found, in half units of the last printed digit.
    at_least : number or null
        What no input can leave less than.
    because : str or null
    witness : list
        That input.
    """

    source: Text
    verdict: Text
    values: int
    mismatch: Number
    at_least: Number
    because: Text | None
    witness: list[Witness]


class Tried(Form, frozen=True, kw_only=True):
    """How many changes explain what is published, how many certainly do not, and of how many it is open."""

    explaining: int
    excluded: int
    open: int


class Change(Form, frozen=True, kw_only=True):
    """Something that may have been printed wrongly, and how it would be printed; `also` are other digits."""

    kind: Text
    source: Text
    cell: Text
    index: list[int]
    printed: Text
    would_print: Text
    also: list[Text]


class Explanation(Change, frozen=True, kw_only=True):
    """A change with which all comes out; what has to change besides, and how many changes that makes."""

    besides: list[Change]
    mismatch: Number
    changes: int
    sentence: Text


class Fit(Form, frozen=True, kw_only=True):
    """The column that a published one goes with best, and the mismatch of each."""

    source: Text
    cell: Text
    best: Text = field(name="is")
    mismatch: dict[str, Number]


class Referee(Form, frozen=True, kw_only=True):
    """What the referee found: the tables, all together, and what would have to be printed otherwise."""

    tables: list[Table]
    joint: Table | None
    tried: Tried | None
    explanations: list[Explanation]
    fits: list[Fit]
    free: list[Text]
    amended: Table | None
    misprints: list[Explanation]


class Source(Form, frozen=True, kw_only=True):
    """An error that is independent of all others, unless a correlation says otherwise.

    Parameters
    ----------
    name : str
        In the report where it was stated.
    report : str
        The sha256 of that report's inputs; empty if it is this one.
    distribution : str
    ends : two numbers or null
        Where a normal one is cut off, in its standard deviations before that; null where it is not.
    dof : number or null
        Degrees of freedom; null where its standard uncertainty is known.
    sample : str
        What its standard uncertainty was estimated from, where others were too.
    """

    name: Text
    report: Text = ""
    distribution: Text
    ends: tuple[Number, Number] | UnsetType = UNSET
    dof: Annotated[float, Meta(gt=0)] | None = None
    sample: Text = ""

    def __post_init__(self) -> None:
        if self.ends is not UNSET:
            low, high = self.ends
            if (low or 0) > 0 or (high or 0) < 0 or low == high == 0:
                raise ValueError(f"the ends of {self.name} do not lie around its number")


class Influences(Form, frozen=True, kw_only=True):
    """Where the uncertainty of cells comes from, for reports that take their values from here.

    Parameters
    ----------
    inputs : str
        The sha256 of all that the report was made from.
    sources : list of Source
    cells : table of lists
        By how much the standard uncertainty of each source moves a cell, in SI, with its sign.
    rows : table of lists
        The same of cells of columns over the rows of the data: the places of the sources that move each, and
        by how much.
    second : table of number
        The standard uncertainty that terms of second order add to a cell.
    doubts : table of str
        Of which cells U may not hold, and why.
    correlations : list
        Two places in `sources`, and their coefficient.
    """

    inputs: Text
    sources: list[Source]
    cells: dict[Text, list[float]]
    rows: dict[Text, list[tuple[int, float]]] | UnsetType = UNSET
    second: dict[Text, float] = field(default_factory=dict)
    doubts: dict[Text, Text] = field(default_factory=dict)
    correlations: list[tuple[int, int, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        number, several = len(self.sources), {} if self.rows is UNSET else self.rows
        places = [n for a, b, _ in self.correlations for n in (a, b)]
        places += [n for moved in several.values() for n, _ in moved]
        fit = all(len(moved) == number for moved in self.cells.values())
        if not fit or not all(0 <= n < number for n in places):
            raise ValueError("its sources do not fit together")

    @property
    def known(self) -> list[str]:
        """The cells that it tells of."""
        return [*self.cells, *(() if self.rows is UNSET else self.rows)]

    def of(self, cell: str) -> list[tuple[int, float]] | None:
        """The places of the sources that move a cell, and by how much; None where nothing is told of it."""
        if cell in self.cells:
            return [(n, moved) for n, moved in enumerate(self.cells[cell]) if moved]
        return None if self.rows is UNSET else self.rows.get(cell)


class Result(Form, frozen=True, kw_only=True):
    """What a report was computed to.

    Parameters
    ----------
    schema : 1
    workbook, title : str
    headline : list of str
        The results: names of scalars, the first of them first.
    aside : list of str
        Columns that only lead to other cells, as those that a fit is computed by.
    cells : table of Column
        In the order of the sheet.
    words : table of tables
        What the rows of an index set are known by besides numbers: words of groups, names of rows.
    oddities : list of Oddity
    expanded : list of Expanded
        Of the results. Missing where there are none that are known.
    conformity : list of Conformity
        Missing where no cell has limits.
    proofs : table of str
        The status of each equation.
    rests_on : table of lists
        What each proved equation finally rests on.
    errata : list of Erratum
    published : list of Published
    published_u : list of Published
        The same of uncertainties and what else is published of how sure a value is, as ``u(eta)``. Missing
        where nothing is.
    influences : Influences
        Missing where nothing is known of them.
    referee : Referee
        Missing where nothing is published.
    """

    schema: Schema
    workbook: Text
    title: Text
    headline: list[Text] = field(default_factory=list)
    aside: list[Text] = field(default_factory=list)
    cells: dict[Text, Column]
    words: dict[Text, dict[int, str]] | UnsetType = UNSET
    oddities: list[Oddity] = field(default_factory=list)
    expanded: list[Expanded] | UnsetType = UNSET
    conformity: list[Conformity] | UnsetType = UNSET
    proofs: dict[Text, Text]
    rests_on: dict[Text, list[Text]] = field(default_factory=dict)
    errata: list[Erratum] = field(default_factory=list)
    published: list[Published]
    published_u: list[Published] | UnsetType = UNSET
    influences: Influences | UnsetType = UNSET
    referee: Referee | UnsetType = UNSET

    def known(self, name: str) -> dict[Index, str]:
        """The words of the rows of a column; none where they have numbers alone."""
        axis = self.cells[name].axis if name in self.cells else None
        every = {} if self.words is UNSET or axis is None else self.words
        return {(number,): word for number, word in every.get(axis or "", {}).items()}

    def __post_init__(self) -> None:
        for each in () if self.conformity is UNSET else self.conformity:
            if each.column not in self.cells:
                raise ValueError(f"it decides on {each.cell}, and has no such cell")


def read_result(path: Path) -> Result:
    """Read a values.json.

    Raises
    ------
    InputError
        It is none.
    """
    return read(path, Result, "LS607")
