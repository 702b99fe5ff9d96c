"""What results rest on, led backwards through a plan's derivatives: a program of products and sums over rows.

The adjoint of a cell is the derivative of a result by it. That of a cell that is not the result is the sum of
the adjoints of what names it, each times its own derivative. So every cell has one adjoint for each result,
however many numbers were given. What is made here is a list of quantities, each after those that it names;
engines print or compute it.

- A result that is one number leads back through sums, to all rows of what they run over.
- A column whose rows are results leads back row by row (``along``), to what its rows name themselves; numbers
  on the way that are no rows' are results of their own, told once.
- A result of each group leads back as a number does: a row belongs to one group, so that one adjoint for each
  row is that of its own group's result. Numbers have one for each group, and are led back as above.
- A loop ends where its iterated columns x satisfy x = S(x, r). By the implicit function theorem the adjoints
  of x there are those of what is behind the loop, solved with I - dS/dx. Iterated rows name one another by
  way of numbers alone, so this is solved row by row first, and then for the numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import InitVar, dataclass, field, replace
from typing import Literal, NamedTuple

from ..cells.grid import Product
from .order import places
from .slopes import NodeDerivatives


class Unfollowed(Exception):
    """The ways back from a result are none that are followed here."""


@dataclass(frozen=True)
class Term:
    """A product for each row of an axis, and what it is added to."""

    factors: tuple[str, ...]
    """Parts of the plan, and quantities on the same rows or without any."""
    by: str = ""
    """One more quantity; empty for 1."""
    rows: str | None = None
    """The axis; None for one number."""
    of: str = ""
    """The column that must have a value in the row, or whose sums must take it; empty if all rows count."""
    over: bool = False
    """Whether it is a term of a sum of that column."""
    group: str | None = None
    """Of a sum in groups, the axis of the groups, on which `by` stands."""
    axis: str | None = None
    index: str | None = None
    """`axis` and `index`: how rows name what is added to, as a
    :class:`~loopsheet.report.plan.slopes.Slope`."""


class Solution(NamedTuple):
    """A place in the solution x of (I - M') x = b, row by row or for numbers."""

    place: int
    matrix: tuple[tuple[str, ...], ...]
    """M: what each step does to each; empty where it does nothing."""
    right: tuple[str, ...]
    """b."""


class Share(NamedTuple):
    """What is asked of a total by order: what each row counts, or of one of its places what stands there."""

    total: str
    place: int = 0
    """Of the places that the total takes."""
    word: Literal["rows", "value", "number"] = "rows"
    """``rows``: what each row counts; of the place the ``value``, or the ``number`` of rows that have it."""
    taken: tuple[str, ...] = ()
    """For rows, the quantities of the value and of the number of each place; for a number, of its value."""


class Grouping(NamedTuple):
    """What an axis of groups is made of."""

    members: str
    """The axis of the rows, those of one group beside one another."""
    rows: str
    """The axis that these repeat."""
    group: str
    """The index by which rows of either name their group."""
    row: str
    """The index by which members name the row that they repeat."""


@dataclass(frozen=True)
class Adjoint:
    """A derivative of a result, or what is needed for it."""

    name: str
    result: str
    """The column or total of which it is a derivative."""
    of: str
    """That by which it is one."""
    axis: str | None
    """Its rows; None for one number."""
    terms: tuple[Term, ...] = ()
    plus: float = 0.0
    """A number to begin with: 1 for the result by itself."""
    solved: Solution | None = None
    """Instead of terms."""
    share: Share | None = None
    """Instead of terms."""

    @property
    def names(self) -> set[str]:
        """The parts and quantities that it names."""
        found = {name for term in self.terms for name in (*term.factors, term.by)}
        if self.solved:
            found.update(self.solved.right, *self.solved.matrix)
        if self.share:
            found.update(self.share.taken)
        return found - {""}


@dataclass(frozen=True)
class Adjoints:
    """The derivatives of results by what was given."""

    quantities: tuple[Adjoint, ...]
    ways: Mapping[str, Mapping[str, tuple[Product, ...]]]
    """Of each result that can be followed, by the given columns that it rests on."""


def _needed(
    made: Mapping[str, Adjoint], ways: Mapping[str, Mapping[str, Iterable[Product]]]
) -> list[Adjoint]:
    """The quantities on these ways, each after those that it names."""
    needed = {name for own in ways.values() for every in own.values() for way in every for name in way[:2]}
    found = []
    for quantity in reversed(tuple(made.values())):
        if quantity.name in needed:
            needed |= quantity.names
            found.append(quantity)
    return found[::-1]


@dataclass
class _LoopClosure:
    """What is known of a loop: how its end follows what is before it."""

    rows: dict[str, dict[tuple[str, str | None], str]]
    """For each iterated column with rows, its derivatives row by row, by what they are by and the index."""
    numbers: list[str]
    """The numbers by way of which it closes: iterated ones, and others that iterated rows name."""
    ends: dict[str, dict[str, str]] = field(default_factory=dict)
    """For each of the numbers, the quantities by what is before the loop, and by the numbers."""


class _PendingTerms:
    """The adjoints of one result so far: terms wait until all users of a cell are done."""

    def __init__(self, result: str, groups: str | None = None) -> None:
        self.result = result
        self.groups = groups
        """The axis of the groups, if there is a result of each."""
        self.terms: dict[str, list[Term]] = {}
        self.made: dict[str, str] = {}
        """The quantities, by what they are derivatives by."""


def _settled(name: str) -> str:
    """What a loop leaves, by the name of what its last pass was given."""
    return name.partition("~")[0]


@dataclass
class ReversePass:
    """Leads results backwards."""

    derived: InitVar[Iterable[NodeDerivatives]]
    """Of the derivatives; of loops, the last pass counts."""
    loops: InitVar[Iterable[Iterable[str]]]
    """The columns of each loop."""
    iterated: Collection[str]
    """Those of them that are iterated."""
    repeats: Mapping[str, tuple[str, str]]
    """Axes that repeat each row of another one, with that one and the index by which they name its rows."""
    groups: Mapping[str, Grouping]
    """The axes of groups."""
    indexed: Collection[str]
    """The parts that name cells of rows that are not their own."""

    def __post_init__(self, derived: Iterable[NodeDerivatives], loops: Iterable[Iterable[str]]) -> None:
        self.nodes = {node.name: node for node in derived if "~" not in node.name}
        self.order = list(self.nodes)
        self.loop_of = {name: n for n, loop in enumerate(loops) for name in loop}
        self.made: dict[str, Adjoint] = {}
        self.folds: dict[int, _LoopClosure] = {}
        self.heads: dict[str, _PendingTerms] = {}

    def adjoints(self, results: Iterable[str], given: Collection[str]) -> Adjoints:
        """Lead columns backwards, to those of what is given that derivatives are asked for by."""
        ways: dict[str, dict[str, tuple[Product, ...]]] = {}
        for result in results:
            kept = dict(self.made), dict(self.folds), dict(self.heads)
            try:
                found = self.ways(result)
            except Unfollowed:
                self.made, self.folds, self.heads = kept
                continue
            ways[result] = {name: own for name, own in found.items() if name in given}
        return Adjoints(tuple(_needed(self.made, ways)), ways)

    # --- names

    def axis(self, name: str) -> str | None:
        """The rows of a column or a total."""
        return self.nodes[name].axis

    def loop(self, name: str) -> int | None:
        """The loop in which a node stands."""
        return self.loop_of.get(self.nodes[name].of)

    def add(self, quantity: Adjoint) -> str:
        """Have a quantity; returns its name."""
        self.made[quantity.name] = quantity
        return quantity.name

    # --- what is asked

    def ways(self, result: str) -> dict[str, tuple[Product, ...]]:
        """The ways from a result to all that was given."""
        if self.axis(result) is None:
            return {name: (Product(made),) for name, made in self.of_number(result).items()}
        if self.axis(result) in self.groups:
            return self.of_groups(result)
        found: dict[str, list[Product]] = {}
        for (name, index), made in self.along(result, lambda node: False).items():
            if not self.nodes[name].slopes:
                way = Product(made, "", None if self.axis(name) is None else index or "")
                found.setdefault(name, []).append(way)
            elif self.axis(name) is None:
                for given, then in self.of_number(name).items():
                    found.setdefault(given, []).append(Product(made, then))
            else:
                raise Unfollowed(name)
        return {name: tuple(own) for name, own in found.items()}

    def of_number(self, result: str) -> dict[str, str]:
        """The adjoints of what was given, for a result that is one number."""
        if result not in self.heads:
            self.heads[result] = self.back(_PendingTerms(result), {result: 1.0})
        own = self.heads[result]
        return {name: made for name, made in own.made.items() if not self.nodes[name].slopes}

    def of_groups(self, result: str) -> dict[str, tuple[Product, ...]]:
        """The ways from a result of each group."""
        groups = self.axis(result)
        assert groups is not None
        own, grouped = _PendingTerms(result, groups), self.groups[groups]
        found: dict[str, list[Product]] = {}
        for name, made in self.back(own, {result: 1.0}).made.items():
            node = self.nodes[name]
            if not node.slopes:
                ways = {None: Product(made), groups: Product(made, "", "")}
                own_way = ways.get(node.axis, Product(made, "", grouped.group, grouped.rows))
                found.setdefault(name, []).append(own_way)
            elif node.axis is None:
                for given, then in self.of_number(name).items():
                    found.setdefault(given, []).append(Product(made, then))
        return {name: tuple(ways) for name, ways in found.items()}

    def within(self, groups: str, node: NodeDerivatives) -> None:
        """Refuse a node of a group's result that names what another group may have."""
        own = self.groups[groups]
        named: dict[str | None, set[str | None]] = {
            groups: {None},
            own.rows: {None, own.group},
            own.members: {own.row, own.group},
        }
        rows = node.over or node.axis
        indices = {slope.index for slope in node.slopes if slope.axis is not None}
        if rows not in named or not indices <= named[rows] or self.loop(node.name) is not None:
            raise Unfollowed(node.name)

    # --- backwards, for a number or for one of each group

    def back(self, own: _PendingTerms, start: Mapping[str, float], only: int | None = None) -> _PendingTerms:
        """Take all that a result rests on, the last first; or only what stands in a loop."""
        rests, waiting = set[str](), [*start, *own.terms]
        while waiting:
            name = waiting.pop()
            if name not in rests:
                rests.add(name)
                if not self.ends(own, name):
                    waiting += [_settled(slope.by) for slope in self.nodes[name].slopes]
        inside: int | None = None
        for name in reversed([name for name in self.order if name in rests]):
            loop = self.loop(name)
            if only is not None and loop != only:
                continue
            if only is None and loop != inside:
                if inside is not None:
                    self.close(own, inside)
                inside = loop
            if name in self.iterated:
                # Where a loop has settled, what it steps to is what it steps from.
                if name in start:
                    own.terms.setdefault(name, [])
                continue
            self.quantity(own, name, start.get(name, 0.0))
            if name in own.made and not self.ends(own, name):
                self.through(own, self.nodes[name], own.made[name])
        if inside is not None:
            self.close(own, inside)
        return own

    def ends(self, own: _PendingTerms, name: str) -> bool:
        """Whether a node is a number on the way from the results of groups: it is led back for itself."""
        return own.groups is not None and self.axis(name) is None

    def quantity(self, own: _PendingTerms, name: str, plus: float = 0.0) -> None:
        """The adjoint of a node whose users are done, if there is anything."""
        terms = own.terms.pop(name, [])
        if terms or plus:
            made, axis = f"d {own.result} / d {name}", self.axis(name) or own.groups
            own.made[name] = self.add(Adjoint(made, own.result, name, axis, tuple(terms), plus))

    def through(self, own: _PendingTerms, node: NodeDerivatives, by: str) -> None:
        """Lead the adjoint of a node to what it names."""
        if own.groups:
            self.within(own.groups, node)
        rows = node.over or node.axis
        for slope in node.slopes:
            factors = (slope.value, self.share(node)) if node.by_order else (slope.value,)
            group = node.axis if node.over is not None else None
            on = by
            if group is not None and (slope.axis is None or slope.index is not None):
                on, group = self.on_rows(own, by, node), None
            term = Term(factors, on, rows, node.of, node.over is not None, group, slope.axis, slope.index)
            self.put(own, _settled(slope.by), term)

    def on_rows(self, own: _PendingTerms, by: str, node: NodeDerivatives) -> str:
        """The adjoint of a sum in groups, for each of the rows of its group that it takes."""
        name = f"{by} of each row"
        term = Term((), by, node.over, node.of, over=True, group=node.axis)
        return self.add(Adjoint(name, own.result, node.name, node.over, (term,)))

    def put(self, own: _PendingTerms, name: str, term: Term) -> None:
        """A term for what a node names; rows that repeat another one's are added up for that one first."""
        if self.ends(own, name) and own.groups and term.rows != own.groups:
            term = replace(term, axis=term.rows, index=self.groups[own.groups].group)
        if term.rows is not None and term.rows in self.repeats:
            of, index = self.repeats[term.rows]
            if (term.axis, term.index) not in ((term.rows, None), (term.rows, index)) and (
                term.axis is not None or self.names_others(term)
            ):
                made = f"d {own.result} / d {name} by {term.of} for each of {of}"
                while made in self.made:
                    made += "'"
                first = self.add(
                    Adjoint(made, own.result, name, of, (replace(term, axis=term.rows, index=index),))
                )
                term = Term((), first, of, axis=None if term.axis is None else of, index=term.index)
        own.terms.setdefault(name, []).append(term)

    def names_others(self, term: Term) -> bool:
        """Whether a term names cells of rows that are not its own."""
        names = [name for name in (*term.factors, term.by) if name]
        return any(
            name in self.indexed
            or (
                name in self.made
                and self.made[name].axis in self.repeats
                and any(map(self.names_others, self.made[name].terms))
            )
            for name in names
        )

    def share(self, node: NodeDerivatives) -> str:
        """What each row counts in a total by order."""
        name, taken = f"share in {node.name}", list[str]()
        if name not in self.made:
            for place in range(len(places(node.word, 1))):
                for word in ("value", "number"):
                    own = f"{word} {place + 1} of {node.name}"
                    share = Share(node.name, place, word, tuple(taken[-1:]) if word == "number" else ())
                    taken.append(self.add(Adjoint(own, node.of, node.name, node.axis, share=share)))
            self.add(Adjoint(name, node.of, node.name, node.over, share=Share(node.name, taken=tuple(taken))))
        return name

    # --- row by row

    def along(
        self, result: str, ends: Callable[[NodeDerivatives], bool], step: bool = False
    ) -> dict[tuple[str, str | None], str]:
        """The derivatives of each row of a column by what the rows on its way name, row by row.

        `ends`: what is not gone through. `step`: whether `result` is an iterated column, of which the step
        is meant.
        """
        rows, found = self.axis(result), dict[tuple[str, str | None], str]()
        terms: dict[tuple[str, str | None], list[Term]] = {}
        for name in reversed(self.order):
            node = self.nodes[name]
            inner = node.axis == rows and node.over is None and (name, None) in terms
            if name == result:
                made = (
                    ""
                    if step
                    else self.add(Adjoint(f"d {result} / d {result}", result, name, rows, plus=1.0))
                )
            elif not inner or (name in self.iterated and step) or not node.slopes or ends(node):
                continue
            elif self.loop(name) is not None and not step:
                raise Unfollowed(name)
            else:
                made = self.row_quantity(result, name, None, terms.pop((name, None)), found)
                del found[name, None]
            for slope in node.slopes:
                by = _settled(slope.by)
                term = Term((slope.value,), made, rows, node.of, axis=rows)
                terms.setdefault((by, slope.index), []).append(term)
        for (name, index), own in terms.items():
            self.row_quantity(result, name, index, own, found)
        return found

    def row_quantity(
        self,
        result: str,
        name: str,
        index: str | None,
        terms: Sequence[Term],
        found: dict[tuple[str, str | None], str],
    ) -> str:
        """Have the derivatives of a column's rows by what they name; returns its name."""
        made = f"d {result} / d {name}{f'[{index}]' if index else ''} along {self.axis(result)}"
        found[name, index] = self.add(Adjoint(made, result, name, self.axis(result), tuple(terms)))
        return made

    # --- loops

    def fold(self, loop: int) -> _LoopClosure:
        """How a loop closes; made once."""
        if loop in self.folds:
            return self.folds[loop]
        own = [name for name in self.order if self.loop(name) == loop]
        iterated = [name for name in own if name in self.iterated]
        rows: dict[str, dict[tuple[str, str | None], str]] = {}
        for name in iterated:
            if self.axis(name) is not None:
                rows[name] = self.along(name, lambda node: self.loop_of.get(node.of) != loop, step=True)
        numbers = [name for name in iterated if self.axis(name) is None]
        for name, leaves in rows.items():
            for by, index in leaves:
                if self.loop(by) != loop or by in numbers:
                    continue
                if self.axis(by) is None:
                    numbers.append(by)
                elif by not in self.iterated or index is not None or self.axis(by) != self.axis(name):
                    raise Unfollowed(by)
        self.folds[loop] = fold = _LoopClosure(rows, numbers)
        for name in numbers:
            step = _PendingTerms(f"step of {name}" if name in self.iterated else name)
            if name in self.iterated:
                self.through(step, self.nodes[name], "")
                self.back(step, {}, loop)
            else:
                step.result = f"{name} in its loop"
                self.back(step, {name: 1.0}, loop)
            self.by_rows(step, fold, loop)
            ends = dict(step.made)
            for each in numbers:
                ends[each] = self.number(step, each)
            for each in list(step.terms):
                if self.loop(each) != loop:
                    self.quantity(step, each)
                    ends[each] = step.made[each]
            fold.ends[name] = {
                each: made for each, made in ends.items() if each in numbers or self.loop(each) != loop
            }
        return fold

    def number(self, own: _PendingTerms, name: str) -> str:
        """The adjoint of a number by way of which a loop closes; 0 where there is nothing."""
        made = f"d {own.result} / d {name} again"
        terms = own.terms.pop(name, []) if name in self.iterated else own.terms.pop(f"{name} again", [])
        plus = 1.0 if own.result == name else 0.0
        return self.add(Adjoint(made, own.result, name, None, tuple(terms), plus))

    def by_rows(self, own: _PendingTerms, fold: _LoopClosure, loop: int) -> None:
        """Solve the iterated rows for themselves, and lead that to what their steps name."""
        axes = dict.fromkeys(self.axis(name) for name in fold.rows)
        for axis in axes:
            names = [name for name in fold.rows if self.axis(name) == axis]
            if not any(name in own.terms for name in names):
                continue
            right = []
            for name in names:
                made = f"d {own.result} / d {name} again"
                terms = tuple(own.terms.pop(name, []))
                right.append(self.add(Adjoint(made, own.result, name, axis, terms)))
            matrix = tuple(tuple(fold.rows[name].get((other, None), "") for other in names) for name in names)
            for place, name in enumerate(names):
                made = f"d {own.result} / d step of {name}"
                solved = Solution(place, matrix, tuple(right))
                self.add(Adjoint(made, own.result, name, axis, solved=solved))
                for (by, index), value in fold.rows[name].items():
                    if by in names and index is None:
                        continue
                    to = by if self.loop(by) != loop or by in self.iterated else f"{by} again"
                    where = None if self.axis(by) is None else axis
                    own.terms.setdefault(to, []).append(Term((value,), made, axis, axis=where, index=index))

    def close(self, own: _PendingTerms, loop: int) -> None:
        """Lead the adjoints of what a loop ends with to what is before it."""
        if own.groups:  # the rows of a loop name one another by way of numbers, whatever their group
            raise Unfollowed(own.result)
        fold = self.fold(loop)
        self.by_rows(own, fold, loop)
        if not fold.numbers or not any(
            name in own.terms or f"{name} again" in own.terms for name in fold.numbers
        ):
            return
        right = tuple(self.number(own, name) for name in fold.numbers)
        matrix = tuple(tuple(fold.ends[name][other] for other in fold.numbers) for name in fold.numbers)
        for place, name in enumerate(fold.numbers):
            made = f"d {own.result} / d step of {name}"
            self.add(Adjoint(made, own.result, name, None, solved=Solution(place, matrix, right)))
            for by, value in fold.ends[name].items():
                if by not in fold.numbers:
                    axis = self.axis(by)
                    own.terms.setdefault(by, []).append(Term((value,), made, axis, axis=axis))
