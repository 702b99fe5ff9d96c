"""What narratives may name: sentences that depend on what was found, and what is made of a whole report."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from ...derivations.equation import Derivation, Equation, Step
from ...derivations.proved import IDENTITY, Proof
from ..cells.address import index_text
from ..cells.values import Cell
from ..messages.errors import suggest
from ..result import verdict_words as words
from ..result.agreement import Agreement
from ..result.chi_square import RARE, SIGNIFICANT, asked_of_chance, head, largest, tail, tied
from ..result.conformity import decision, undecided
from ..result.numbers import probability, rounded
from ..result.statements import statements
from ..result.uncertain import draws_of
from ..result.verdict import NOT_CHECKABLE, UNREACHABLE
from ..workbook import FigureSpec
from . import cards, tree
from .material import Material
from .parts import Item, SourceGroup
from .put_in import put_in
from .refereed import GOOD
from .tables import Tables
from .written import gone

Answer = tree.Inlines | tree.Blocks | bool


class UnknownName(LookupError):
    """A narrative names something that is not there."""


class Role(NamedTuple):
    """What ``{role}`argument` `` stands for: in running text, and alone in a paragraph if that is another."""

    inline: Callable[[str], Answer]
    alone: Callable[[str], Answer] | None = None


class Said:
    """What the roles of narratives stand for: nothing, where a report has nothing of that name.

    `drawn`: names of the figures that were drawn.
    """

    def __init__(self, material: Material, drawn: Collection[str]) -> None:
        self.material, self.report, self.drawn = material, material.report, drawn
        self.rich, self.sentence = material.sentences.rich, material.sentences.sentence
        self.referee, self.tables = material.report.referee, Tables(material)
        self.roles: Mapping[str, Role] = {
            "cell": Role(lambda name: (tree.Value(item),) if (item := self._item(name)).ok else ()),
            "count": Role(self._count),
            "eq": Role(lambda label: (tree.Refer(self._label(label)),), self._numbered),
            "fig": Role(lambda name: _links("figure", self._spec(name)), self._figure),
            "fit": Role(lambda name: self.told(self.fits().get(name, ""))),
            "inside": Role(self._inside),
            "lacking": Role(lambda names: self._lacking(names.split())),
            "math": Role(lambda latex: (tree.Math(latex),)),
            "published": Role(self._printed),
            "say": Role(lambda name: SAID[_known("sentence", name, SAID)](self)),
            "sym": Role(lambda name: (self.material.sentences.symbol(name),)),
            "table": Role(lambda name: _links("table", self._table(name)), self._table),
            "farthest": Role(self._test),
            "chance": Role(self._chance),
            "tail": Role(lambda what: self._followed("tail", what, self._squares(tail, what))),
            "head": Role(lambda what: self._followed("head", what, self._squares(head, what))),
            "unlikely": Role(lambda what: (p := self._squares(tail, what)) is not None and p < RARE),
            "tied": Role(lambda _: tied(self.report)),
            "close": Role(lambda what: (p := self._squares(head, what)) is not None and p < RARE),
        }

    # --- cells, counts, references

    def _column(self, name: str) -> str:
        return _known("column", name, self.report.sheet.by_name)

    def _item(self, name: str) -> Item:
        return self.material.item(self._column(name))

    def _lacking(self, names: Sequence[str]) -> tree.Inlines:
        """That cells have no value, and why the first has none."""
        cells = tree.joined(((self.material.sentences.symbol(name),) for name in names), ", ", " and ")
        why = self.rich(self._item(names[0]).origin.why)
        return *cells, f" {'has' if len(names) == 1 else 'have'} no value: ", *why, "."

    def _label(self, label: str) -> str:
        return _known("equation", label, self.material.identifiers)

    def _count(self, what: str) -> tree.Inlines:
        """``tests``: how many there are; ``alpha_mean pairs``: over how many of them a column sums."""
        values = self.report.values
        *column, axis = what.split()
        _known("axis", axis, values.layouts)
        if not column:
            return (tree.Count(str(values.layouts[axis].size), "count", axis),)
        name = self._column(column[0])
        return (tree.Count(str(values.rows_summed(name, axis)), "count", axis, name),)

    def _inside(self, name: str) -> tree.Inlines:
        limited = self.report.marks.limited(self._column(name))
        return (tree.Count(limited.inside, "inside", limited.margin.column.name),)

    def _probable(self, p: float | None) -> tree.Inlines:
        return () if p is None else self.rich(probability(p))

    def _followed(self, kind: str, what: str, p: float | None) -> tree.Inlines:
        text = self._probable(p)
        # A page computes the sum of squares of the fit again, and no other.
        return (tree.Count(text, kind, what),) if text and not tied(self.report) else text

    def _squares(self, how: Callable[[float, int, float], float], what: str) -> float | None:
        """How likely such a sum of squares is; None without one, and if nothing or no chance is left over."""
        declared = {squares.name: squares for squares in self.report.workbook.squares}
        squares = declared[_known("sum of squares", what, declared)]
        known = asked_of_chance(squares, self.report)
        return how(*known) if known else None

    def _farthest(self, name: str) -> tuple[str, float] | None:
        """The row whose deviation, in standard deviations, is too large for chance, and that chance."""
        values, column = self.report.values, self.report.sheet[self._column(name)]
        known = [(abs(x), row) for row, x in enumerate(values.value[column.name]) if x == x]
        if not known or tied(self.report):
            return None
        most, row = max(known)
        chance = largest(most, len(known), len(self.report.inputs.only.left_out))
        return (index_text(values.labels(column)[row]), chance) if chance < SIGNIFICANT else None

    def _test(self, name: str) -> tree.Inlines:
        found = self._farthest(name)
        return self.sentence(found[0]) if found else ()

    def _chance(self, name: str) -> tree.Inlines:
        found = self._farthest(name)
        return self._probable(found[1]) if found else ()

    def _printed(self, cell: str) -> tree.Inlines:
        self._column(cell)
        for one in self.report.comparisons:
            if (one.published.cell, one.published.index) == (cell, ()):
                printed = one.published.printed
                return tree.Number(None, printed.text), *tree.in_unit(printed.unit)
        return ()

    def _numbered(self, label: str) -> tree.Blocks:
        return (tree.Display(self.report.ledger[self._label(label)], numbered=True),)

    def _table(self, name: str) -> tuple[tree.Table, ...]:
        return (self.tables.data[name],) if name in self.tables.data else ()

    def _spec(self, name: str) -> tuple[FigureSpec, ...]:
        return tuple(one for one in self.material.figures if one.name == name and name in self.drawn)

    def _figure(self, name: str) -> tuple[tree.Figure, ...]:
        return tuple(tree.Figure(spec, self.rich(spec.caption)) for spec in self._spec(name))

    # --- sentences

    def told(self, sentence: str) -> tree.Inlines:
        """A sentence with its full stop; nothing of nothing."""
        return (*self.sentence(sentence), ".") if sentence else ()

    def listed(self, sentences: Iterable[str]) -> tree.Blocks:
        """A list of sentences."""
        return _listed(map(self.told, sentences))

    def headline(self) -> tree.Blocks:
        """The results, and what is decided on limits."""
        names = [name for name in self.report.workbook.headline if name in self.report.sheet]
        items = [item for name in names for item in self.material.items(name)[1]]
        results = (tree.Headline(tuple(map(self._result, items))),) if items else ()
        decided = self.report.uncertain().conformities if self.report.inputs.limits else ()
        told = tuple(self.rich(decision(self.report, found)) for found in decided)
        told += tuple(self.rich(f"{undecided(each)}.") for each in self.report.inputs.undecided)
        return (*results, *((tree.Items(told, "decided"),) if told else ()))

    def _result(self, item: Item) -> tree.HeadlineItem:
        name = item.cell.name
        column, values = self.report.sheet[name], self.report.values
        left_out = values.left_out(name, values.row(column, item.cell.label))
        called = self.report.sheet.rows_of
        rows = tuple(f"over {rows} of {size} {called(axis)}" for rows, size, axis in left_out)
        marks = (count for count in self.report.marks.behind(column) if count.number)
        word = self.report.words(column).get(item.cell.label, "") if column.axis else ""
        meaning = (*self.rich(item.head.meaning), f", {word}" if word else "")
        return tree.HeadlineItem(
            tree.Math(item.head.latex),
            meaning,
            item,
            (*(rows if item.ok else ()), *(count.said for count in marks)),
            *self._sure(item.cell),
        )

    def _sure(self, cell: Cell) -> tuple[tree.Inlines, tree.Inlines]:
        """The expanded uncertainty of a result, where one is known, and whether it may not hold."""
        budgets = self.report.uncertain().budgets
        budget = next((b for b in budgets if (b.name, b.label) == (cell.name, cell.label)), None)
        if budget is None:
            return (), ()
        told: tree.Inlines = ()
        if budget.u > 0 and math.isfinite(budget.factor):
            _, expanded = self.report.stated(cell.name, budget.value, budget.expanded)
            factor = f" (k\u00a0=\u00a0{rounded(budget.factor, 3).text})"
            unit = tree.in_unit(self.report.shown[cell.name].unit)
            told = "U\u00a0=\u00a0", tree.Number(expanded), *unit, factor
        instead = ("; use ", tree.Code(draws_of(budget.cell))) if budget.asks_for_draws else ()
        return told, ((budget.doubt, *instead) if budget.doubt else ())

    def oddities(self) -> tree.Blocks:
        """What there is to tell of the data themselves."""
        return tuple(
            tree.Note((tree.Strong((check.word.capitalize(),)), ": ", *self.rich(check.message), "."))
            for check in self.material.oddities
        )

    def left_out(self) -> tree.Inlines:
        """How many rows of the measurements are left out."""
        left_out = [*self.report.inputs.left_out]
        return (tree.Count(str(len(left_out)), "count", "left out"),) if left_out else ()

    def data(self) -> tree.Blocks:
        """All tables, and all figures of the workbook."""
        figures = (one for spec in self.report.workbook.figures for one in self._figure(spec.name))
        return (*self.tables.data.values(), *figures)

    def tally(self) -> tree.Inlines:
        """How many published values come out."""
        found = self.report.comparisons
        if not found:
            return ()
        same, differing, missing = (
            sum(one.verdict == word for one in found) for word in ("same", "differs", "not-checkable")
        )
        said = f"Of {len(found)} published value{'s' * (len(found) > 1)}, {_come(same)}"
        said += f" and {differing} differ{'s' * (differing == 1)}" if differing else ""
        said += f"; {missing} could not be compared" if missing else ""
        link = tree.Link("section", "published", ("Each is shown beside its recomputation.",))
        odd = sum(not one.as_expected for one in found)
        odd_ones = tree.Strong((f"{odd} of these findings {'was' if odd == 1 else 'were'} not expected.",))
        return (f"{said}. ", link, *((" ", odd_ones) if odd else ()))

    def group(self, group: SourceGroup) -> tree.Inlines:
        """How much of one place of the source comes out."""
        title = (", ", *self.rich(group.title)) if group.title else ()
        off: tree.Inlines = ()
        if (far := group.furthest) is not None and group.same < len(group.pairs):
            again, of = far.comparison.again, f" of {far.row}" if far.row else ""
            beside = f" units, {again} against the published {far.printed.text}{of}"
            off = "; the furthest is off by ", tree.Number(far.distance, signed=True), beside
        come = f": of {len(group.pairs)} value{'s' * (len(group.pairs) > 1)} {_come(group.same)}"
        return tree.Strong((group.source,)), *title, come, *off, "."

    # --- the referee

    def free(self) -> tree.Inlines:
        """What the publication does not print."""
        columns = (self.report.sheet[name] for name in self.referee.free if name in self.report.sheet)
        symbol = self.material.sentences.symbol
        return tree.joined(
            (("the ", *self.rich(c.meaning), " ", symbol(c.name)) for c in columns), ", ", " and "
        )

    def verdict(self) -> tree.Inlines:
        """Whether everything published can come out of one input."""
        if self.referee.joint is None:
            return ()
        said = self.told(f"{words.together(self.referee.joint)}.")
        out = [value.pair for value in self.material.refereed if value.verdict == UNREACHABLE]
        if not out:
            return said
        cells = ((tree.Math(pair.head.latex), f" {pair.index}" if pair.index else "") for pair in out)
        own = "itself" if len(out) == 1 else "themselves"
        return *said, f" Out of reach by {own}: ", *tree.joined(cells, ", ", " and "), "."

    def without(self) -> tree.Inlines:
        """How many values have no interval, and why."""
        values = self.material.refereed
        number = sum(one.found.low is None and one.verdict != NOT_CHECKABLE for one in values)
        rests, own, they = ("rests", "itself", "it") if number == 1 else ("rest", "themselves", "they")
        said = f"{number} of the {len(values)} values {rests} on what is not printed: "
        said += f"by {own} {they} can have any size, so there is no interval to show, "
        said += f"and only together with the others can {they} be refuted."
        return (said,) if number else ()

    def amended(self) -> tree.Inlines:
        """What comes out with the known misprints put right: what they are, then what comes out."""
        return tree.joined(map(self.told, words.amended(self.referee)), " ")

    def fits(self) -> dict[str, str]:
        """What is said of the published value of each average and fit, by its cell."""
        sheet = self.report.sheet
        return {
            found.published.cell: words.fit(found, lambda name: sheet[name].meaning)
            for found in self.referee.fits
        }

    # --- equations

    def claim(self, equation: Equation) -> tree.Claim:
        """An equation with what is known of it."""
        material, ledger = self.material, self.report.ledger
        proof, derivation = material.proof(equation), ledger.derivation(equation)
        because = self.told(equation.because)
        if conditions := material.written(equation).conditions:
            where = tree.joined([(tree.Math(each),) for each in conditions], " and ")
            because += (" Holds where ", *where, ".")
        if proof and proof.remark:
            because += (" ", *self.told(proof.remark))
        steps = tuple(self._steps(derivation, proof)) if derivation else ()
        return tree.Claim(
            equation,
            self.sentence(equation.title),
            material.status(equation),
            because,
            self._grounds(proof) if proof and derivation and proof.status.passes else (),
            f"Derivation, {len(steps)} step{'s' * (len(steps) > 1)}",
            steps,
        )

    def _named(self, label: str, title: str) -> tree.Inlines:
        return (tree.Refer(label),) if label in self.material.identifiers else self.rich(title)

    def _grounds(self, proof: Proof) -> tree.Inlines:
        """What a claim finally rests on: numbers, and titles of what has none."""
        grounds = tree.joined(self._all_grounds(proof), "; ")
        return ("Rests on: ", *(grounds or (IDENTITY,)), ".")

    def _all_grounds(self, proof: Proof) -> list[tree.Inlines]:
        return [self._named(label, label) for label in proof.rests_on]

    def _steps(self, derivation: Derivation, proof: Proof | None) -> Iterator[tree.Blocks]:
        shown: set[tuple[str, str]] = set()
        known = self._all_grounds(proof) if proof and proof.status.passes else []
        for number, step in enumerate(derivation.steps):
            blocks: tree.Blocks = (tree.Paragraph(self.rich(step.says)),)
            if step.claim.label != derivation.claim.label:
                blocks += (tree.Display(step.claim),)
            for premise in step.premises:  # those without a number, the first time
                if premise.label in self.material.identifiers or _name(premise) in shown:
                    continue
                title, first = self.rich(premise.title), self._first_shown[self._shown_as(premise)]
                if first != derivation.claim.label:
                    named = self._named(first, first)
                    blocks += (tree.Paragraph(("Premise: ", *title, ", as in ", *named, ".")),)
                else:
                    why = self.rich(premise.because)
                    blocks += (tree.Paragraph(("Premise: ", *title, " – ", *why, ":")), tree.Display(premise))
            shown.add(_name(step.claim))
            evidence = ("Evidence: ", *self.rich(proof.steps[number].sentence), ".") if proof else ()
            yield *blocks, tree.Paragraph((*self._rests_on(step, known), *evidence), aside=True)

    def _shown_as(self, premise: Equation) -> tuple[object, ...]:
        return *_name(premise), self.material.written(premise).speaks_of

    @cached_property
    def _first_shown(self) -> Mapping[tuple[object, ...], str]:
        """For each equation without a number, the claim whose derivation shows it."""
        found: dict[tuple[object, ...], str] = {}
        for entry in self.report.ledger.entries:
            if isinstance(entry, Derivation):
                for premise in (premise for step in entry.steps for premise in step.premises):
                    found.setdefault(self._shown_as(premise), entry.claim.label)
        return found

    def _rests_on(self, step: Step, known: Sequence[tree.Inlines]) -> tree.Inlines:
        """What a step rests on, unless the claim says the same of itself, and what it eliminates."""
        # two branches of one law are one equation
        each = list(dict.fromkeys(map(self._premise, step.premises)))
        rests: tree.Inlines = ("Rests on ", *tree.joined(each, ", "), ". ") if each and each != known else ()
        out = tree.joined(((tree.Math(each),) for each in gone(step, self.material.names)), ", ")
        return (*rests, *(("Eliminated: ", *out, ". ") if out else ()))

    def _premise(self, equation: Equation) -> tree.Inlines:
        """What a step rests on: its number or its name, and of which test it speaks."""
        named = self._named(equation.label, equation.title)
        row = self.material.written(equation).speaks_of
        return (*named, " for ", tree.Math(row)) if row else named

    def versions(self) -> tree.Blocks:
        """What computed the report."""
        versions = self.report.versions.items()
        return (tree.Items(tuple((f"{name}\u00a0{number}",) for name, number in versions), "versions"),)


SAID: dict[str, Callable[[Said], Answer]] = {
    "results": lambda s: bool(s.report.workbook.headline or s.material.oddities or s.report.comparisons),
    "headline": Said.headline,
    "oddities": Said.oddities,
    "data": Said.data,
    "left_out": Said.left_out,
    "stated": lambda s: any(name in s.report.inputs.measured for name, _ in statements(s.report)),
    "missing": lambda s: (s.tables.missing(),) if s.material.remarks else (),
    "tally": Said.tally,
    "groups": lambda s: _listed(map(s.group, s.material.groups)),
    "published": lambda s: tuple(map(s.tables.published, s.material.groups)),
    "referee": lambda s: bool(s.referee.values),
    "free": Said.free,
    "verdict": Said.verdict,
    "together": lambda s: (s.tables.together(),),
    "each_refereed": lambda s: (s.tables.refereed(),),
    "without": Said.without,
    "uncertain": lambda s: (s.tables.uncertain(),) if s.material.budgets else (),
    "budget": lambda s: s.tables.budget(),
    "conformity": lambda s: (s.tables.conformity(),) if s.report.inputs.limits else (),
    "squares": lambda s: (s.tables.squares(),) if s.report.workbook.squares else (),
    "published_u": lambda s: (s.tables.published_u(),) if s.report.comparisons_u else (),
    "asked_why": lambda s: s.referee.asked_why,
    "possible": lambda s: s.referee.joint is not None and s.referee.joint.verdict in GOOD,
    "explained": lambda s: s.told(words.headline(s.referee.explanations)),
    "explanations": lambda s: s.listed(map(words.explained, s.referee.explanations)),
    "nothing_explains": lambda s: s.told(words.NOTHING_EXPLAINS),
    "tried": lambda s: s.told("" if s.referee.tried is None else words.tried(s.referee.tried)),
    "amended": Said.amended,
    "fits": lambda s: s.listed(s.fits().values()),
    "own_numbers": lambda s: any(equation.own for equation in s.material.equations),
    "lettered": lambda s: any(
        not s.report.sheet[curve.name].source.startswith("(L") for curve in s.report.workbook.curves
    ),
    "ledger": lambda s: (s.tables.ledger(),) if s.material.equations else (),
    "claims": lambda s: tuple(map(s.claim, s.material.equations)),
    "put_in": lambda s: put_in(s.material),
    "errata": lambda s: tuple(table for table in (s.tables.errata(),) if table.size),
    "errata_of_equations": lambda s: bool(s.report.errata),
    "sample": lambda s: tuple(engine.sample for engine in s.report.engines[:1] if engine.sample),
    "engines": lambda s: _listed(map(_agreement, s.report.engines)),
    "other_engines": lambda s: len(s.report.engines) > 1,
    "files": lambda s: tree.joined(((tree.Code(name),) for name in s.report.inputs.files), ", "),
    "cards": lambda s: cards.blocks(s.report.cards()),
    "card_models": lambda s: any(not card.solved for card in s.report.cards().made),
    "untold": lambda s: tree.joined(((name,) for name in s.material.untold), " and "),
    "exactly": lambda s: s.report.exactly is not None,
    "versions": Said.versions,
}
"""What ``{say}`` names: inlines, blocks, or whether something is so."""


def _known(what: str, name: str, known: Collection[str]) -> str:
    if name not in known:
        there = suggest(name, known) or f"there are {', '.join(known)}"
        raise UnknownName(f"no {what} is called '{name}'; {there}")
    return name


def _links(kind: str, shown: Iterable[tree.Table | FigureSpec]) -> tree.Inlines:
    return tuple(tree.Link(kind, one.name, (f"{kind.capitalize()}\u00a0{one.number}",)) for one in shown)


def _come(number: int) -> str:
    return f"{number or 'none'} {'come' if number > 1 else 'comes'} out as printed"


def _listed(items: Iterable[tree.Inlines]) -> tree.Blocks:
    listed = tuple(items)
    return (tree.Items(listed),) if listed else ()


def _agreement(found: Agreement) -> tree.Inlines:
    """What the judge found of an engine."""
    said: tree.Inlines
    if found.absent:
        said = (found.absent,)
    elif not found.cells:
        said = ("failed",)
    else:
        where = (" in ", tree.Code(found.units_where)) if found.units_where else ()
        said = (f"{found.counted}, the largest difference is {found.units:.2g}", *where)
        said += ("; ", tree.Strong((f"{len(found.findings)} findings",))) if found.findings else ()
    return tree.Strong((found.engine,)), f", {found.program}: " if found.program else ": ", *said, "."


def _name(equation: Equation) -> tuple[str, str]:
    """What an equation without a number, or what it is an instance of, is known by."""
    return equation.origin.title, equation.origin.because
