"""What narratives may name: sentences that depend on what was found, and what is made of a whole report."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import NamedTuple

from sympy import Expr, Indexed, Integer

from ...derivations.equation import Derivation, Equation, Step
from ...derivations.proof import IDENTITY, Proof
from ..agreement import Agreement
from ..errors import suggest
from .material import Material
from .numbers import is_pure
from .parts import Group
from .refereed import Value as Refereed
from .tables import Tables
from .tree import (
    Blocks,
    Claim,
    Code,
    Figure,
    Formula,
    Headline,
    Inlines,
    Inside,
    Items,
    Link,
    Math,
    Note,
    Number,
    Numbered,
    Paragraph,
    Refer,
    Result,
    Size,
    Strong,
    Table,
    Unit,
    Value,
    Versions,
    joined,
)  # fmt: skip

__all__ = ["Role", "Said", "Unknown"]

Answer = Inlines | Blocks | bool
_NOTHING: Inlines = ()


class Unknown(LookupError):
    """A narrative names something that is not there."""


class Role(NamedTuple):
    """What ``{role}`argument` `` stands for: in running text, and alone in a paragraph if that is another."""

    inline: Callable[[str], Answer]
    alone: Callable[[str], Answer] | None = None


_SAID: dict[str, Callable[[Said], Answer]] = {}


def _says(method: Callable[[Said], Answer]) -> Callable[[Said], Answer]:
    """Let narratives name what a method returns: inlines, blocks, or whether something is so."""
    _SAID[method.__name__.lstrip("_")] = method
    return method


class Said:
    """What the roles of narratives stand for: nothing, where a report has nothing of that name.

    Parameters
    ----------
    material : Material
    drawn : collection of str
        Names of the figures that were drawn.
    """

    def __init__(self, material: Material, drawn: Collection[str]) -> None:
        self.material, self.report, self.drawn = material, material.report, drawn
        self.rich, self.sentence = material.sentences.rich, material.sentences.sentence
        self.refereed, self.tables = material.refereed, Tables(material)
        self.roles: Mapping[str, Role] = {
            "cell": Role(self._cell),
            "count": Role(self._count),
            "eq": Role(lambda label: (Refer(self._label(label)),), self._numbered),
            "fig": Role(self._figure_link, self._figure),
            "inside": Role(self._inside),
            "math": Role(lambda latex: (Math(latex),)),
            "published": Role(self._printed),
            "say": Role(lambda name: _SAID[_known("sentence", name, _SAID)](self)),
            "sym": Role(lambda name: (self.material.sentences.symbol(name),)),
            "table": Role(self._table_link, self._table),
        }

    # --- cells, counts, references

    def _column(self, name: str) -> str:
        return _known("column", name, self.report.sheet.by_name)

    def _label(self, label: str) -> str:
        return _known("equation", label, self.material.identifiers)

    def _cell(self, name: str) -> Inlines:
        return (Value(self.material.item(self._column(name))),)

    def _count(self, what: str) -> Inlines:
        """``tests``: how many there are; ``alpha_mean pairs``: over how many of them a column sums."""
        *column, axis = what.split()
        _known("axis", axis, self.report.values.layouts)
        if not column:
            return (Size(self.material.count(axis), axis),)
        name = self._column(column[0])
        return (Size(self.material.counted(name, axis), axis, name),)

    def _inside(self, name: str) -> Inlines:
        limited = self.report.marks.limited(self._column(name))
        return (Inside(limited.inside, limited.margin.column.name),)

    def _printed(self, cell: str) -> Inlines:
        pair = self.material.published(self._column(cell))
        return (
            () if pair is None else (Number(pair.published, pair.printed.text), *_behind(pair.printed.unit))
        )

    def _numbered(self, label: str) -> Blocks:
        return (Numbered(self.report.ledger[self._label(label)]),)

    def _table(self, name: str) -> tuple[Table, ...]:
        return (self.tables.data[name],) if name in self.tables.data else ()

    def _table_link(self, name: str) -> Inlines:
        return tuple(Link("table", name, (f"Table\u00a0{one.number}",)) for one in self._table(name))

    def _figure(self, name: str) -> tuple[Figure, ...]:
        specs = (spec for spec in self.material.figures if spec.name == name and name in self.drawn)
        return tuple(Figure(spec, self.rich(spec.caption)) for spec in specs)

    def _figure_link(self, name: str) -> Inlines:
        return tuple(Link("figure", name, (f"Figure\u00a0{one.spec.number}",)) for one in self._figure(name))

    # --- the result

    @_says
    def _results(self) -> bool:
        return bool(self.report.workbook.headline or self.material.oddities or self.material.groups)

    @_says
    def _headline(self) -> Blocks:
        names = [name for name in self.report.workbook.headline if self.material.has(name)]
        return (Headline(tuple(map(self._result, names))),) if names else ()

    def _result(self, name: str) -> Result:
        item = self.material.item(name)
        left_out = (f"over {rows} of {size} {axis}" for axis, rows, size in self.material.left_out(name))
        marks = (count.said for count in self.material.marked(name))
        meaning = self.rich(item.head.meaning)
        return Result(Math(item.head.latex), meaning, item, tuple(left_out), tuple(marks))

    @_says
    def _oddities(self) -> Blocks:
        return tuple(
            Note((Strong((check.word.capitalize(),)), ": ", *self.rich(check.message), "."))
            for check in self.material.oddities
        )

    @_says
    def _left_out(self) -> Inlines:
        """How many rows of the measurements are left out."""
        left_out = self.report.inputs.left_out
        return (Size(len(left_out), "left out"),) if left_out else ()

    @_says
    def _data(self) -> Blocks:
        """All tables, and all figures of the workbook."""
        figures = (one for spec in self.report.workbook.figures for one in self._figure(spec.name))
        return (*self.tables.data.values(), *figures)

    @_says
    def _missing(self) -> Blocks:
        return (self.tables.missing(),) if self.material.remarks else ()

    # --- what is published

    @_says
    def _tally(self) -> Inlines:
        material, verb = self.material, "differs" if self.material.differing == 1 else "differ"
        if not material.groups:
            return ()
        said = f"Of {len(self.report.comparisons)} published values, {_come(material.same)}"
        said += f" and {material.differing} {verb}" if material.differing else ""
        said += f"; {material.unchecked} could not be compared" if material.unchecked else ""
        link = Link("section", "published", ("Each is shown beside its recomputation.",))
        were = "was" if material.unexpected == 1 else "were"
        found = Strong((f"{material.unexpected} of these findings {were} not expected.",))
        return (f"{said}. ", link, *((" ", found) if material.unexpected else ()))

    @_says
    def _groups(self) -> Blocks:
        """How much of each place of the source comes out."""
        return _listed(map(self._group, self.material.groups))

    def _group(self, group: Group) -> Inlines:
        title = (", ", *self.rich(group.title)) if group.title else ()
        far, off = group.furthest, _NOTHING
        if far is not None and group.same < len(group.pairs):
            again, of = far.comparison.again, f" of {far.row}" if far.row else ""
            beside = f" units, {again} against the published {far.printed.text}{of}"
            off = "; the furthest is off by ", Number(far.distance, signed=True), beside
        come = f": of {len(group.pairs)} values {_come(group.same)}"
        return Strong((group.source,)), *title, come, *off, "."

    @_says
    def _published(self) -> Blocks:
        return tuple(map(self.tables.published, self.material.groups))

    # --- the referee

    @_says
    def _referee(self) -> bool:
        return self.refereed.present

    @_says
    def _free(self) -> Inlines:
        columns = ((name, self.rich(self.report.sheet[name].meaning)) for name in self.refereed.free)
        said = (("the ", *meaning, " ", self.material.sentences.symbol(name)) for name, meaning in columns)
        return joined(said, ", ", " and ")

    @_says
    def _verdict(self) -> Inlines:
        if self.refereed.joint is None:
            return ()
        said = (*self.sentence(self.refereed.joint.sentence), ".")
        out = self.refereed.out
        if not out:
            return said
        cells = joined((self._refereed(value) for value in out), ", ", " and ")
        return *said, f" Out of reach by {'itself' if len(out) == 1 else 'themselves'}: ", *cells, "."

    def _refereed(self, value: Refereed) -> Inlines:
        return Math(value.pair.head.latex), f" {value.pair.index}" if value.pair.index else ""

    @_says
    def _together(self) -> Blocks:
        return (self.tables.together(),)

    @_says
    def _each_refereed(self) -> Blocks:
        return (self.tables.refereed(),)

    @_says
    def _without(self) -> Inlines:
        """How many values have no interval, and why."""
        number, all_of = self.refereed.without, len(self.refereed.values)
        rests, own, they = ("rests", "itself", "it") if number == 1 else ("rest", "themselves", "they")
        said = f"{number} of the {all_of} values {rests} on what is not printed: "
        said += f"by {own} {they} can have any size, so there is no interval to show, "
        said += f"and only together with the others can {they} be refuted."
        return (said,) if number else ()

    @_says
    def _asked_why(self) -> bool:
        return self.refereed.asked_why

    @_says
    def _possible(self) -> bool:
        return self.refereed.possible

    @_says
    def _explained(self) -> Inlines:
        """What is said above explanations."""
        return (*self.sentence(self.refereed.headline), ".") if self.refereed.explanations else ()

    @_says
    def _explanations(self) -> Blocks:
        return self._sentences(self.refereed.explanations)

    @_says
    def _nothing_explains(self) -> Inlines:
        return (*self.sentence(self.refereed.nothing), ".")

    @_says
    def _tried(self) -> Inlines:
        return (*self.sentence(self.refereed.tried), ".") if self.refereed.tried else ()

    @_says
    def _amended(self) -> Inlines:
        return joined(((*self.sentence(each), ".") for each in self.refereed.amended), " ")

    @_says
    def _fits(self) -> Blocks:
        return self._sentences(self.refereed.fits)

    @_says
    def _fit_of_alpha_log(self) -> Inlines:
        said = self.refereed.fit_of("alpha_log")
        return (*self.sentence(said), ".") if said else ()

    def _sentences(self, sentences: Iterable[str]) -> Blocks:
        return _listed((*self.sentence(each), ".") for each in sentences)

    # --- equations

    @_says
    def _own_numbers(self) -> bool:
        return self.material.has_own_numbers

    @_says
    def _ledger(self) -> Blocks:
        return (self.tables.ledger(),) if self.material.equations else ()

    @_says
    def _claims(self) -> Blocks:
        return tuple(map(self._claim, self.material.equations))

    def _claim(self, equation: Equation) -> Claim:
        proof, derivation = self.material.proof(equation), self.material.derivation(equation)
        because: Inlines = (*self.sentence(equation.because), ".")
        if equation.conditions:
            because += (" Holds where ", *joined(map(self._formula, equation.conditions), " and "), ".")
        if proof and proof.remark:
            because += (" ", *self.sentence(proof.remark), ".")
        steps = tuple(self._steps(derivation, proof)) if derivation else ()
        many = f"{len(steps)} step{'s' * (len(steps) > 1)}"
        return Claim(
            equation,
            self.sentence(equation.title),
            self.material.status(equation),
            because,
            self._grounds(proof) if proof and derivation and proof.status.passes else (),
            f"Derivation, {many}{', with its evidence' if proof else ''}",
            steps,
        )

    def _formula(self, expression: Expr) -> Inlines:
        return (Math(self.material.printer.doprint(expression)),)

    def _named(self, label: str) -> Inlines:
        return (Refer(label),) if label in self.material.identifiers else self.rich(label)

    def _grounds(self, proof: Proof) -> Inlines:
        """What a claim finally rests on: numbers, and titles of what has none."""
        return ("Rests on: ", *(joined(map(self._named, proof.rests_on), "; ") or (IDENTITY,)), ".")

    def _steps(self, derivation: Derivation, proof: Proof | None) -> Iterator[Blocks]:
        shown: set[Equation] = set()
        for number, step in enumerate(derivation.steps):
            blocks: Blocks = (Paragraph(self.rich(step.says)),)
            if step.claim.label != derivation.claim.label:
                blocks += (Formula(step.claim),)
            for premise in step.premises:  # those without a number, the first time
                if premise.label not in self.material.identifiers and premise.origin not in shown:
                    title, why = self.rich(premise.title), self.rich(premise.because)
                    blocks += (Paragraph(("Premise: ", *title, " – ", *why, ":")), Formula(premise))
            shown.add(step.claim.origin)
            evidence = self.rich(proof.steps[number].sentence) if proof else ()
            said = self._rests_on(step) + (("Evidence: ", *evidence, ".") if proof else ())
            yield *blocks, Paragraph(said, aside=True)

    def _rests_on(self, step: Step) -> Inlines:
        if not step.premises:
            return ()
        # two branches of one law are one equation
        each = dict.fromkeys(map(self._premise, step.premises))
        gone = joined(map(self._formula, step.eliminate), ", ")
        return ("Rests on ", *joined(each, ", "), *(("; eliminated: ", *gone) if gone else ()), ". ")

    def _premise(self, equation: Equation) -> Inlines:
        """What a step rests on: its number or its name, and of which test it speaks."""
        named = (
            self._named(equation.label)
            if equation.label in self.material.identifiers
            else self.rich(equation.title)
        )
        own, general = _indices(equation), _indices(equation.origin)
        if len(own) == len(general) == 1 and own != general and isinstance(next(iter(own)), Integer):
            return (*named, " for ", Math(f"{general.pop()} = {own.pop()}"))
        return named

    # --- how it was checked

    @_says
    def _errata(self) -> Blocks:
        return (self.tables.errata(),) if self.refereed.errata else ()

    @_says
    def _errata_of_equations(self) -> bool:
        return bool(self.report.errata)

    @_says
    def _sample(self) -> Inlines:
        """Which cells were judged, if not all were."""
        return tuple(engine.sample for engine in self.report.engines[:1] if engine.sample)

    @_says
    def _engines(self) -> Blocks:
        return _listed(map(_agreement, self.report.engines))

    @_says
    def _other_engines(self) -> bool:
        return len(self.report.engines) > 1

    @_says
    def _files(self) -> Inlines:
        return joined(((Code(name),) for name in self.report.inputs.files), ", ")

    @_says
    def _untold(self) -> Inlines:
        """The axes whose rows are not shown."""
        return joined(((name,) for name in self.material.untold), " and ")

    @_says
    def _exactly(self) -> bool:
        return bool(self.report.exactly)

    @_says
    def _versions(self) -> Blocks:
        return (Versions(tuple((f"{name}\u00a0{number}",) for name, number in self.report.versions.items())),)


def _known(what: str, name: str, known: Collection[str]) -> str:
    if name not in known:
        raise Unknown(
            f"no {what} is called '{name}'; {suggest(name, known) or 'there are ' + ', '.join(known)}"
        )
    return name


def _behind(unit: str) -> Inlines:
    return () if is_pure(unit) else ("\u00a0", Unit(unit))


def _come(number: int) -> str:
    return f"{number or 'none'} {'come' if number > 1 else 'comes'} out as printed"


def _listed(items: Iterable[Inlines]) -> Blocks:
    listed = tuple(items)
    return (Items(listed),) if listed else ()


def _agreement(found: Agreement) -> Inlines:
    """What the judge found of an engine."""
    said: Inlines
    if found.missing:
        said = (f"{found.missing} was not found",)
    elif not found.cells:
        said = ("failed",)
    else:
        where = (" in ", Code(found.units_where)) if found.units_where else ()
        said = (f"{found.counted}, the largest difference is {found.units:.2g}", *where)
        said += ("; ", Strong((f"{len(found.findings)} findings",))) if found.findings else ()
    return Strong((found.engine,)), f", {found.program}: " if found.program else ": ", *said, "."


def _indices(equation: Equation) -> set[Expr]:
    """The indices that the cells of an equation carry."""
    return {index for member in equation.members for cell in member.atoms(Indexed) for index in cell.indices}
