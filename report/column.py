"""What a sheet is made of over index sets: rules, and columns that have one rule each.

Nothing here knows a model, a number or an output.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from ..derivations.unit_text import UnitError, parse_open
from .axis import Axis
from .content import content
from .quantity import Bounds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from sympy import Basic, Expr, Indexed, Rel, Symbol
    from sympy.logic.boolalg import Boolean

    from ..derivations.equation import Equation
    from ..derivations.unit_text import ParsedUnit


class SheetError(ValueError):
    """A workbook declares something that cannot be a sheet.

    Parameters
    ----------
    *about : str
        What it is about, as the workbook calls it; where it is declared may be looked for by the first that
        stands there.
    """

    def __init__(self, sentence: str, *about: str) -> None:
        super().__init__(sentence)
        self.about = about


# --- rules -----------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Given:
    """The value comes from the user, as printed."""

    source: str = "given"
    """Where from."""
    bounds: Bounds = field(default_factory=Bounds)
    """What it may be, in SI. Every engine asks for that: any other number is ``#INPUT!``."""
    u_of: str = ""
    """The name of the given column whose standard uncertainties it holds; empty for one that is measured or
    chosen."""


@dataclass(frozen=True)
class Formula:
    """The last side of an equation of the ledger, in the sheet's symbols."""

    equation: Equation

    @cached_property
    def expression(self) -> Expr:
        """What is computed."""
        return self.equation.value

    @property
    def statements(self) -> tuple[Equation, ...]:
        """What the ledger must say."""
        return (self.equation,)


@dataclass(frozen=True)
class Root:
    """The only root of an equation in an interval; that it is the only one is decided before it is sought.

    It is decided for all inputs at once where `form` has a slope of one sign, or `turning_by` says why it
    changes sign at most once between turning points; elsewhere for each row by interval arithmetic.
    """

    equation: Equation
    """What the root satisfies, as published."""
    form: Equation
    """What is solved: equivalent on the interval, its left side smooth, its right side zero."""
    unknown: Symbol
    """The unknown of `form`."""
    value: Expr
    """The cell's value in terms of the unknown."""
    low: Expr
    high: Expr
    """`low` and `high`: the open interval of the unknown."""
    start: Expr
    """A first guess. It costs steps, never truth: the bracket decides."""
    sign_low: Expr | None = None
    sign_high: Expr | None = None
    """`sign_low` and `sign_high`: expressions with the sign of `form` at the ends of the interval, where it
    cannot be evaluated or where rounding would decide; None evaluates it."""
    turning: tuple[Expr, ...] = ()
    """Increasing points of the interval between which `form` changes sign at most once; one that is not a
    number, or lies outside, does not count. Believed if `turning_by` says why, and not used if not."""
    turning_by: tuple[Equation, ...] = ()
    """The statements from which that follows: proved claims of the workbook's ledger."""
    steps: int = 4
    """How many steps a cell gets. One that they do not settle is bisected to the end."""
    none: str = "no value of the interval satisfies the equation"
    """What it means when there is no root, for the reader."""
    two: str = "several values of the interval satisfy the equation"
    """What it means when there are several."""

    @cached_property
    def unknown_name(self) -> str:
        """What the unknown is called."""
        return str(self.unknown.name)

    @cached_property
    def by_proof(self) -> bool:
        """Whether statements say how often its form changes sign."""
        return bool(self.turning_by)

    @property
    def statements(self) -> tuple[Equation, ...]:
        """What the ledger must say."""
        return (self.equation, self.form, *self.turning_by)

    @cached_property
    def expression(self) -> Expr:
        """What must vanish."""
        sides = self.form.sides
        return sides[0] - sides[1]

    @property
    def expressions(self) -> tuple[Expr, ...]:
        """Everything that is evaluated, in terms of other columns and the unknown."""
        signs = tuple(s for s in (self.sign_low, self.sign_high) if s is not None)
        return (self.expression, self.value, self.low, self.high, self.start, *signs, *self.turning)


@dataclass(frozen=True)
class Iterated:
    """A value that is put into its own formula again until it stays: columns that rest on one another.

    All columns on the way from it and back to it are computed again and again, from `start` on: the formulas
    in their order, then the next values of the iterated ones, all at once. What they come to satisfies all
    their equations together, as a spreadsheet's circular references do.
    """

    equation: Equation
    """What holds when it stays: a statement of the ledger."""
    step: Expr
    """The next value, in cells of the sheet, its own among them. Where it is the value itself, the equation
    must hold; how fast it leads there is its own matter."""
    start: Expr
    """The first value, in cells that do not rest on it; a number is in SI."""
    none: str = "the values go on changing"
    """What it means when it does not settle, for the reader."""

    @property
    def statements(self) -> tuple[Equation, ...]:
        """What the ledger must say."""
        return (self.equation,)

    @property
    def expressions(self) -> tuple[Expr, ...]:
        """Everything that is evaluated, in terms of columns."""
        return (self.step, self.start)


Rule = Given | Formula | Root | Iterated


@dataclass(frozen=True)
class Mentioned:
    """What the rule of a column names, where its algebra is not at hand."""

    named: tuple[tuple[str, str | None, str | None], ...]
    """The names of a column, of the index, of the axis that it is summed over: those of its references, in
    the order of the sheet."""
    summed: tuple[str, ...]
    """The names of the axes that it takes something over."""
    content: str
    """That of the column."""


@dataclass(frozen=True)
class Limit:
    """Where the cells of a column are expected, and who says so."""

    inside: Boolean | Bounds
    """What holds where all is as expected: comparisons of cells that the column's axis may name, joined by
    and; or what the cell itself may be, in SI."""
    says: str
    """What is odd outside, in a few words."""
    source: str = ""
    """The number of the statement that says so, ``(4)``; empty if it is the workbook's own."""
    silent: bool = False
    """Whether a row outside tells nothing of what it rests on, so that no test is suspected because of it. A
    column that requires the same in the same words leaves it out; what that does is told by the limit."""
    mentioned: ClassVar[Mentioned | None] = None
    """Of the column that says how far inside a row lies, if only a part of the limit is known: as
    ``kept_sheet.py`` has it."""

    @classmethod
    def of(cls, equation: Equation) -> Limit:
        """A relation of a ledger, in a sheet's cells."""
        return cls(equation.value, equation.title, equation.label)

    @property
    def mark(self) -> str:
        """What is said of a cell outside."""
        return f"outside {self.source}" if self.source else self.says

    @property
    def told(self) -> str:
        """The mark, with what the statement is about."""
        return f"{self.mark}, {self.says}" if self.source else self.says

    def rows(self, axis: str) -> str:
        """What is behind a number of rows that lie outside: ``pairs outside (4)``."""
        return f"{axis}{'' if self.source else ':'} {self.mark}"


@dataclass(frozen=True)
class Column:
    """One quantity over one index set."""

    name: str
    """The cell name, ``x_m1``."""
    axis: Axis | None
    """None for a scalar."""
    rule: Rule
    """Where its values come from."""
    unit: str = "1"
    """SI unit; an exponent may be another column's name (``N/m^alpha``)."""
    meaning: str = ""
    """What it is."""
    latex: str = ""
    """How it is printed; ``%s`` is where an index goes."""
    display: str = ""
    """The unit it is shown in; ``like x_p`` follows that of another column, as the user wrote it if that is
    given."""
    positive: bool = True
    """Whether it is positive wherever it has a value: a formula that gives zero or less is then outside its
    domain. (A root is held by its interval, a given value by what the workbook allows.)"""
    requires: tuple[tuple[Rel, str], ...] = ()
    """Relations that must hold for a row, each with the sentence that explains a ``#DOMAIN!``."""
    exact: bool = False
    """Whether a given value is a choice or a convention, so that its digits say nothing of precision."""
    limits: tuple[Limit, ...] = ()
    """Where its cells are expected. One outside keeps its value and carries a mark."""
    is_u: bool = False
    """Whether its cells are uncertainties themselves, of which no more digits are shown than of any other."""
    spare: bool = False
    """Whether its conditions ask for more than a campaign must have, so that where they do not hold there is
    nothing to find: its cells have no value, and nobody is to blame."""
    alongside: tuple[Column, ...] = ()
    """Columns on the axes that its rule sums over: the sums leave out rows without a value in these, too."""
    mentioned: ClassVar[Mentioned | None] = None
    """Of a column of which only a part is known, as ``kept_sheet.py`` has it."""

    @cached_property
    def nonnegative(self) -> bool:
        """Whether its rule gives no number below 0."""
        if self.positive or not isinstance(self.rule, Formula):
            return self.positive
        from ..derivations.reductions import never_negative

        return never_negative(self.rule.expression)

    @property
    def written(self) -> str:
        """The unit that it is declared in: what it is shown in, if that is a unit, else that of SI."""
        return self.unit if self.display.startswith("like ") else self.display or self.unit

    @cached_property
    def symbol(self) -> Symbol:
        """The name as a sympy symbol, with its assumptions."""
        from sympy import Symbol

        return Symbol(self.name, positive=True) if self.positive else Symbol(self.name, real=True)

    def __getitem__(self, index: Any) -> Indexed:
        """The cell of a row."""
        from sympy import IndexedBase

        return IndexedBase(self.symbol)[index]

    @property
    def cell(self) -> Expr:
        """The column as it stands in formulas on its own axis."""
        return self.symbol if self.axis is None else self[self.axis.index]

    @cached_property
    def conditions(self) -> tuple[str, ...]:
        """The sentences of its conditions."""
        return tuple(sentence for _, sentence in self.requires)

    @property
    def equation(self) -> Equation | None:
        """The published equation behind it."""
        return None if isinstance(self.rule, Given) else self.rule.equation

    @cached_property
    def source(self) -> str:
        """Number of its equation, or where it was given."""
        return self.rule.source if isinstance(self.rule, Given) else self.rule.equation.label

    @property
    def expressions(self) -> tuple[Basic, ...]:
        """All expressions that its rule and its conditions evaluate."""
        conditions = tuple(condition for condition, _ in self.requires)
        if isinstance(self.rule, Formula):
            return (self.rule.expression, *conditions)
        return conditions if isinstance(self.rule, Given) else (*self.rule.expressions, *conditions)

    @cached_property
    def content(self) -> str:
        """All that an engine makes anything of: columns that share it are computed by the same program."""
        rule, own = self.rule, tuple[Any, ...]()
        if isinstance(rule, Given):
            own = (rule.bounds,)
        elif isinstance(rule, Root):
            turning = len(rule.turning), bool(rule.turning_by)
            own = (rule.unknown, rule.steps, *turning, rule.sign_low is None, rule.sign_high is None)
        axis = self.axis and self.axis.content
        every = (self.name, axis, self.positive, type(rule).__name__, own, self.expressions)
        more = [tuple(other.name for other in self.alongside)] if self.alongside else []
        return content((*every, len(self.requires), *more))


# --- what a rule names -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Reference:
    """A cell, size or running number in an expression."""

    cell: Expr
    """``x_p[i]``, ``beta``, ``n_pairs``."""
    over: Axis | None = None
    """The axis of the innermost reduction it stands in, whose rows it then runs over; None for one of the row
    itself. ``alpha[p]`` may stand for both in one formula."""

    @cached_property
    def name(self) -> str:
        """The column's, or what else it is called."""
        symbol = self.cell.base.label if self._is_indexed else self.cell
        return str(getattr(symbol, "name", symbol))

    @cached_property
    def index(self) -> str | None:
        """The index that names its row; None for what has one value."""
        if not self._is_indexed:
            return None
        row = self.cell.indices[0]
        if not hasattr(row, "name"):
            raise SheetError(
                f"{self.name.partition('[')[0]}[{row}] is one row by its number, which no formula names: "
                "standing(...) says which cell it is, the first(...) or second(...) of a pair; a column of 1 "
                "and 0, stated exact, tells rows apart"
            )
        return str(row.name)

    @property
    def _is_indexed(self) -> bool:
        return hasattr(self.cell, "indices")

    @property
    def written(self) -> str:
        """As the sheet writes it."""
        return self.name if self.index is None else f"{self.name}[{self.index}]"


def shown_as(column: Column, columns: Mapping[str, Column]) -> Column:
    """The column whose unit another is shown in: itself, or what it is declared to be shown like, to the end.

    `columns`: one that it is shown like and that is not among them is the end.
    """
    way = {column.name}
    while column.display.startswith("like "):
        like = columns.get(column.display.removeprefix("like "))
        if like is None or like.name in way:
            break
        way.add(like.name)
        column = like
    return column


def shown_in(column: Column, columns: Mapping[str, Column]) -> ParsedUnit:
    """The unit that a column is declared to be shown in; that of another column, if it is shown like it."""
    try:
        return parse_open(written_in(column, columns))
    except UnitError:
        return parse_open(column.unit)  # it is refused elsewhere


def written_in(column: Column, columns: Mapping[str, Column]) -> str:
    """The same as it is written, unread: a unit that is not common takes half a second."""
    like = shown_as(column, columns)
    own = "" if like.display.startswith("like ") else like.display
    return own or like.unit
