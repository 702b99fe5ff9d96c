"""What the rules of a sheet name, read from their algebra, and what may not stand in them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from functools import cached_property

from sympy import And, Basic, Eq, Expr, Indexed, Integral, Pow, Rational, Symbol, floor
from sympy.logic.boolalg import Boolean

from ..derivations.reductions import REDUCTIONS, Member, OrderStatistic, member_of, taken_of
from .axis import Axis, GroupAxis, MemberAxis
from .column import Column, Iterated, Reference, Root, SheetError
from .messages.errors import close
from .quantity import Bounds


class Named:
    """What symbols mean in a sheet.

    `by_name`: its columns. `axes`: its index sets.
    """

    def __init__(self, by_name: Mapping[str, Column], axes: Sequence[Axis]) -> None:
        self.by_name, self.axes = by_name, axes

    @cached_property
    def sizes(self) -> dict[Symbol, Axis]:
        """The axis whose number of rows a symbol stands for."""
        return {axis.size: axis for axis in self.axes}

    @cached_property
    def indices(self) -> dict[Expr, Axis]:
        """The axis that a sum over a running number runs over, or one with a factor that tells groups."""
        return summed_over(self.axes)

    def over(self, total: Basic) -> Axis:
        """The axis that something is taken over."""
        return _over(total, self.indices)

    def maps(self, axis: Axis) -> dict[Symbol, Axis]:
        """For every index that may be used in a formula on an axis, the axis whose rows it names."""
        rows = (axis, *_grouped(axis))
        groups = (each for each in self.axes if isinstance(each, GroupAxis) and each.members.of in rows)
        return axis.maps | {each.index: each for each in groups}

    def summed(self, column: Column) -> tuple[Axis, ...]:
        """The axes that its rule takes something over, or counts rows of that it looks at."""
        own, found = self._summed.get(column.name, (None, ()))
        if own is not column:
            over = {self.over(total) for each in column.expressions for total in each.atoms(*REDUCTIONS)}
            if column.alongside:
                counted = self.counted(column)
                over |= {other.axis for other in column.alongside if other.axis in counted}
            found = tuple(axis for axis in self.axes if axis in over)
            self._summed[column.name] = column, found
        return found

    @cached_property
    def _summed(self) -> dict[str, tuple[Column, tuple[Axis, ...]]]:
        return {}

    def beside(self, column: Column, other: Column) -> Axis | None:
        """The axis along which the sums of a column look at another, if they do."""
        return next((axis for axis in self.summed(column) if other.axis in (axis, *_grouped(axis))), None)

    def counted(self, column: Column) -> tuple[Axis, ...]:
        """The axes whose number of rows its rule names."""
        named = set[Basic]().union(*map(_counting, column.expressions))
        return tuple(axis for axis in self.axes if axis.size in named)

    def of(self, column: Column) -> Iterator[Reference]:
        """The cells that a column names."""
        unknown = column.rule.unknown if isinstance(column.rule, Root) else None
        for expression in column.expressions:
            for reference in references(expression, self.indices):
                if reference.cell == unknown or reference.cell in self.sizes:
                    continue
                if isinstance(reference.cell, Indexed):
                    yield reference
                elif name_of(reference.cell) in self.by_name:
                    yield Reference(reference.cell)  # a scalar is the same inside and outside of sums
        for other in column.alongside:
            yield Reference(other.cell, self.beside(column, other))

    def check(self, column: Column) -> None:
        """Every symbol is a column, a size, or a running number that means something on this axis."""
        for expression in column.expressions:
            self._check_scope(column, expression, column.axis)
        for other in column.alongside:
            if self.beside(column, self._find(column, other.name)) is None:
                raise SheetError(
                    f"{column.name}: its sums run over no rows of {other.name}, which they shall look at",
                    column.name,
                )
        if isinstance(column.rule, Root) and column.axis is not None:
            for total in column.rule.expression.atoms(*REDUCTIONS):
                if total.has(column.rule.unknown):
                    raise SheetError(
                        f"{column.name}: {total} names the unknown of a row; a root whose equation sums over "
                        f"its unknown is one number, not one for each of {column.axis.name}",
                        column.name,
                    )

    def check_in_loop(self, column: Column, names: Set[str]) -> None:
        """A loop begins somewhere, and each of its columns is a formula or iterated.

        `names`: of the columns of its loop.
        """
        rule = column.rule
        if isinstance(rule, Root):
            raise SheetError(
                f"{column.name}: a root cannot be sought again and again; iterate its equation", column.name
            )
        jumping = sorted(each.word for part in column.expressions for each in part.atoms(OrderStatistic))
        if jumping:
            raise SheetError(
                f"{column.name}: a {jumping[0]} cannot stand in what is iterated; it jumps", column.name
            )
        if isinstance(rule, Iterated):
            named = sorted({r.name for r in references(rule.start, self.indices)} & names)
            if named:
                raise SheetError(
                    f"{column.name}: its start {rule.start} names {', '.join(named)}, which is computed from "
                    "it; a start rests on other cells",
                    column.name,
                )

    def _check_scope(self, column: Column, expression: Basic, axis: Axis | None) -> None:
        if isinstance(expression, REDUCTIONS):
            limits = expression.limits
            over = self.over(expression) if limits[0][0] in self.indices else None
            whole = over.of if isinstance(over, MemberAxis) else over
            if over is None or whole is None or len(limits) != 1 or limits[0][1:] != (1, whole.size):
                known = ", ".join(f"({a.index}, 1, {a.size})" for a in self.axes) or "none"
                shown = ", ".join(map(str, limits))
                raise SheetError(
                    f"{column.name}: a sum runs over all rows of one index set ({known}), not over {shown}",
                    column.name,
                )
            taken = f"{column.name}: a {expression.word}" if isinstance(expression, OrderStatistic) else ""
            if taken and not isinstance(taken_of(expression), Indexed):
                raise SheetError(
                    f"{taken} is of the cells of a column, not of {taken_of(expression)}; "
                    "give that a column of its own",
                    column.name,
                )
            if taken and isinstance(column.rule, Root):
                raise SheetError(f"{taken} in a root has to be a column of its own", column.name)
            self._check_scope(column, taken_of(expression), over)
        elif isinstance(expression, Integral):
            if not is_summed(expression):
                raise SheetError(
                    f"{column.name}: an integral is of a power between -1 and 0 of what is zero at both "
                    f"ends, not of {expression.function}",
                    column.name,
                )
            for part in _at_ends(expression):
                self._check_scope(column, part, axis)
        elif isinstance(expression, Indexed):
            self._check_cell(column, expression, axis)
        elif isinstance(expression, Symbol):
            self._check_symbol(column, expression, axis)
        else:
            for argument in expression.args:
                self._check_scope(column, argument, axis)

    def _check_symbol(self, column: Column, symbol: Symbol, axis: Axis | None) -> None:
        own = column.rule.unknown if isinstance(column.rule, Root) else None
        if symbol == own or symbol in self.sizes or (axis is not None and symbol in axis.ordinals):
            return
        other = self._find(column, symbol.name)
        if other.axis is not None:
            raise SheetError(
                f"{column.name}: {symbol.name} has one value for each of {other.axis.name}; say which",
                column.name,
            )

    def _check_cell(self, column: Column, cell: Indexed, axis: Axis | None) -> None:
        other = self._find(column, name_of(cell))
        maps = {} if axis is None else self.maps(axis)
        where = maps.get(cell.indices[0])
        if where is None or other.axis != where or len(cell.indices) != 1:
            place = "a scalar" if other.axis is None else f"on {other.axis.name}"
            allowed = ", ".join(f"{i} ({a.name})" for i, a in maps.items()) or "none"
            raise SheetError(
                f"{column.name}: {cell} names a row of nothing: {other.name} is {place}; indices here: "
                f"{allowed}",
                column.name,
            )

    def _find(self, column: Column, name: str) -> Column:
        other = self.by_name.get(name)
        if other is None:
            near = close(name, self.by_name)
            hint = f"; did you mean {near!r}?" if near else ""
            raise SheetError(f"{column.name}: no column is called {name!r}{hint}", name, column.name)
        return other


def within(value: Expr, bounds: Bounds) -> Boolean:
    """That a number is allowed, for every engine to print.

    Parameters
    ----------
    value : Expr
        A real symbol that assumes nothing, or all of it would be true already.

    Examples
    --------
    >>> within(Symbol("e", real=True), Bounds(low=0, high=1))
    (e >= 0) & (e <= 1)
    """
    low, high = (None if end is None else Rational(repr(end)) for end in (bounds.low, bounds.high))
    tests: list[Boolean] = [Eq(value, floor(value))] if bounds.integer else []
    if low is not None:
        tests.append(value > low if bounds.low_open else value >= low)
    if high is not None:
        tests.append(value < high if bounds.high_open else value <= high)
    return And(*tests)


def references(expression: Basic, sums: Mapping[Expr, Axis], over: Axis | None = None) -> Iterator[Reference]:
    """Everything that an expression names, in the order it stands there; the same may come twice.

    `sums`: from :func:`summed_over`. `over`: the axis of the sum that the expression stands in.
    """
    if isinstance(expression, REDUCTIONS):
        yield from references(taken_of(expression), sums, _over(expression, sums))
    elif isinstance(expression, Integral):
        for part in _at_ends(expression):
            yield from references(part, sums, over)
    elif isinstance(expression, (Indexed, Symbol)):
        yield Reference(expression, over)
    else:
        for argument in expression.args:
            yield from references(argument, sums, over)


def is_summed(integral: Integral) -> bool:
    """Whether engines sum an integral; that what it is a power of is zero at both ends is for its author."""
    ((variable, *ends),) = integral.limits
    match integral.function:
        case Pow(base=inner, exp=Rational() as power):
            return len(ends) == 2 and -1 < power < 0 and variable in inner.free_symbols
    return False


def _at_ends(integral: Integral) -> Iterator[Basic]:
    """What an integral names: its ends, and what is integrated at one of them."""
    ((variable, low, high),) = integral.limits
    yield from (low, high, integral.function.xreplace({variable: low}))


def summed_over(axes: Iterable[Axis]) -> dict[Expr, Axis]:
    """The axis that a sum over a running number runs over, or one with a factor that tells groups."""
    return {member(each) if isinstance(each, MemberAxis) else each.index: each for each in axes}


def member(axis: MemberAxis) -> Member:
    """One where a row belongs to a group, nought elsewhere."""
    return Member(axis.of.index, axis.group)


def _over(total: Basic, sums: Mapping[Expr, Axis]) -> Axis:
    """The axis that something is taken over."""
    index = member_of(total) or total.limits[0][0]
    if index not in sums:
        raise SheetError(f"{total} runs over no rows of a table: total(x) and mean(x) take all of them")
    return sums[index]


def _counting(expression: Basic) -> set[Basic]:
    """The symbols that an expression names, but where its sums end."""
    if isinstance(expression, REDUCTIONS):
        return _counting(taken_of(expression))
    if expression.has(*REDUCTIONS):  # sympy takes long for the free symbols of what has sums in it
        return set().union(*map(_counting, expression.args))
    found: set[Basic] = expression.free_symbols
    return found


def _grouped(axis: Axis) -> tuple[Axis, ...]:
    """The axis whose rows an axis has in groups."""
    return (axis.of,) if isinstance(axis, MemberAxis) else ()


def name_of(cell: Expr) -> str:
    """The column's name in a cell, plain or indexed."""
    return Reference(cell).name
