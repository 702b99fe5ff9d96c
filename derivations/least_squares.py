"""Least squares of a declared model, its columns made orthogonal one after the other over the rows.

What is left of the slopes of a model and of what was observed, once the first slope is taken out of them, is
a fit with one parameter less: each step of the proof knows two slopes alone, however many there are, and
numbers keep their digits (modified Gram and Schmidt: A. Björck, BIT 7 (1967) 1). A model that is not linear
in its parameters is taken so at the last ones, again and again (Gauss and Newton): a step is solved for.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, combinations, product
from string import ascii_lowercase as LETTERS
from typing import Any

import sympy as sp

from .equation import Derivation, Equation, Kind, Step
from .normal_equation import normal_equation

_APART = sp.Integer(2**45)
"""What is left of a slope, as a part of it, is more than rounding from one over this on. (Its square has more
digits than a spreadsheet reads.)"""


_PARTS = tuple(map(sp.Rational, ("1", "2/5", "1/10", "1/50", "1/250")))
"""Of a step that is too long: with fewer of them some sets of NIST's need more passes than a workbook has."""
_ROUNDING = sp.Rational(1, 2**40)
"""By what part of itself a sum of squares may grow by rounding."""
_NOTHING = sp.Rational(1, 10**24)
"""What a sum of squares may be by rounding alone, as a part of that of what was observed."""


@dataclass(frozen=True)
class FitQuantity:
    """A quantity of a fit.

    Parameters
    ----------
    name, title, latex : str
        What it is called, what it is, and how it is printed.
    cell : Expr
        It, of a row or of all.
    entry : Equation or Derivation
        What the ledger says of it; the last side is its formula, if it has no step.
    needs : tuple of (Rel, str)
        What must hold, and what it means if it does not.
    step, start : Expr or None
        Of what is sought by steps: the next value, and the first one if its author says none.
    """

    name: str
    title: str
    latex: str
    cell: sp.Expr
    entry: Equation | Derivation
    needs: tuple[tuple[sp.Rel, str], ...] = ()
    step: sp.Expr | None = None
    start: sp.Expr | None = None

    @property
    def equation(self) -> Equation:
        """What holds."""
        return self.entry.claim if isinstance(self.entry, Derivation) else self.entry


Needs = tuple[tuple[sp.Rel, str], ...]
Pair = tuple[Equation, sp.Expr]
"""A premise, and what it is solved for."""


def _step(claim: Equation, pairs: Iterable[Pair], says: str) -> Step:
    premises, unknowns = zip(*pairs, strict=True)
    return Step(claim, premises, unknowns, says)


class LeastSquares:
    """The parameters of a model which make a sum of squares least.

    Parameters
    ----------
    called : str
        What the names of the fit begin with.
    observed, model : Expr
        Of a row: what was observed, and what the model says there.
    what : str
        The former in words.
    parameters : mapping of Symbol to str
        What each is.
    u : Expr or None
        Of a row, if they are not alike: the standard uncertainty of what was observed.
    others : mapping of Indexed to Expr
        What else of the model was observed with errors, and its standard uncertainty. Then the true values
        of a row are sought, too: the point of the model that is nearest, counted in these.
    index, size : Symbol
        The number of a row, and how many there are.
    number : str
        Of the equations of the fit, ``(H.13)``: they are its parts.
    own : iterator of str
        The numbers of equations that only lead there.
    rows : str
        Which rows these are, in words, if there is such a fit of others as well.

    Attributes
    ----------
    flat, linear : bool
        Whether the model is linear in its parameters, and whether these follow without steps.
    helpers, results : list of FitQuantity
        What only leads there, and what is sought: the parameters, their standard uncertainties and
        correlations by scatter, the scatter, of each row the fitted value and the residual, and the sum of
        squares.
    claims : list of Derivation
        What is proved besides.
    """

    def __init__(
        self,
        called: str,
        observed: sp.Expr,
        model: sp.Expr,
        what: str,
        parameters: Mapping[sp.Symbol, str],
        u: sp.Expr | None,
        others: Mapping[sp.Indexed, sp.Expr],
        index: sp.Symbol,
        size: sp.Symbol,
        number: str,
        own: Iterator[str],
        rows: str = "",
    ) -> None:
        self.called, self.observed, self.model = called, observed, model
        self.parameters, self.words = tuple(parameters), tuple(parameters.values())
        self.index, self.size, self.number, self.own, self.rows = index, size, number, own, rows
        self.count = len(self.parameters)
        feet = {each: self._cell(f"{called}_at_{each.base}", rows=True) for each in others}
        self.feet, self.others, self.true = feet, others, model.xreplace(feet)
        self.u: sp.Expr = sp.Integer(1) if u is None else u
        self.tilts = {each: sp.diff(self.true, foot) for each, foot in feet.items()}
        self.slopes = tuple(sp.diff(self.true, each) for each in self.parameters)
        self.flat = not any(slope.has(*self.parameters) for slope in self.slopes)
        self.linear = self.flat and not others
        self.enough: tuple[sp.Rel, ...] = (size > self.count,)
        self.pairs = tuple(combinations(range(self.count), 2))
        names = map(str, self.parameters)
        self.names = {
            **{name: name for name in names},
            **{f"s_{each}": f"s_{each}" for each in self.parameters},
            **{name: name for name in (self._together(*pair) for pair in self.pairs)},
            **{name: f"{called}_{name}" for name in ("s", "fitted", "residual", "S")},
            **{f"at_{each.base}": str(foot.base) for each, foot in feet.items()},
        }
        """What the results are called by the fit, and in all."""
        self._parts = dict(
            zip(self.names, chain(LETTERS, map("".join, product(LETTERS, repeat=2))), strict=False)
        )
        self.helpers: list[FitQuantity] = []
        self._found: dict[str, FitQuantity] = {}
        self.claims: list[Derivation] = []
        self.weight: sp.Expr = sp.Integer(1)
        tilts, fitted = self.tilts, model
        self.there, self.tangent = self.true, model
        bent = any(tilt.has(*feet.values()) for tilt in tilts.values())
        if bent:

            def tangent(there: sp.Expr, tilts: Mapping[sp.Indexed, sp.Expr]) -> sp.Expr:
                return there + sp.Add(*(tilt * (each - feet[each]) for each, tilt in tilts.items()))

            self.tangent = tangent(self.true, tilts)
            # As columns: what is proved holds of any model and any slopes, and formulas are short.
            self.there = self._column("model", self.true, "model at the nearest point", "m%s")
            self.tilts = {
                each: self._column(f"B{n}", tilt, f"slope of the model by {each.base}", f"B_{{{n}%s}}")
                for n, (each, tilt) in enumerate(tilts.items(), start=1)
            }
            fitted = tangent(self.there, self.tilts)
        if u is not None:

            def spread(tilts: Mapping[sp.Indexed, sp.Expr]) -> sp.Expr:
                return u**2 + sp.Add(*((tilt * others[each]) ** 2 for each, tilt in tilts.items()))

            above = sp.StrictGreaterThan(spread(tilts) if feet else u, 0)
            needs = (
                ()
                if above == sp.true
                else ((above, "a standard uncertainty that rows are weighed by is above zero"),)
            )
            self.weighing, by_columns = (1 / spread(each) for each in (tilts, self.tilts))
            self.weight = self._helper(
                "w", by_columns, "weight of a row", "w%s", rows=True, positive=True, needs=needs
            )
        self.fitted = self._result("fitted", fitted, f"{what}, fitted", rows=True)
        self.residual = self._result("residual", observed - self.fitted, f"{what}, residual", rows=True)
        self._orthogonal()
        self._solve()
        self._approach()
        self._scatter()

    @property
    def results(self) -> list[FitQuantity]:
        """What is sought, in the order in which it is shown."""
        return [self._found[name] for name in self.names]

    @property
    def entries(self) -> Iterator[Equation | Derivation]:
        """All that the ledger says, nothing before what it rests on."""
        rows = [] if self.linear else [self._found[name] for name in ("fitted", "residual")]
        yield from (part.entry for part in (*rows, *self.helpers))
        yield from (part.entry for part in self.results if part not in rows)
        yield from self.claims

    # --- words

    def total(self, terms: sp.Expr) -> sp.Expr:
        """The sum over the rows, by weight."""
        return sp.Sum(self.weight * terms, (self.index, 1, self.size))

    def _together(self, j: int, m: int) -> str:
        return f"r_{self.parameters[j]}_{self.parameters[m]}"

    def _cell(self, name: str, rows: bool = False, positive: bool = False) -> sp.Expr:
        symbol = sp.Symbol(name, positive=True) if positive else sp.Symbol(name, real=True)
        return sp.IndexedBase(symbol)[self.index] if rows else symbol

    def _result(
        self, name: str, value: sp.Expr, title: str, latex: str = "", *, rows: bool = False, needs: Needs = ()
    ) -> sp.Expr:
        """A result by its definition."""
        cell = self._cell(self.names[name], rows)
        equation = self._said(
            self.number, (cell, value), title, Kind.DEFINITION, part=self._parts[name], defines=cell
        )
        self._found[name] = FitQuantity(self.names[name], title, latex, cell, equation, needs)
        return cell

    def _helper(
        self,
        name: str,
        value: sp.Expr,
        title: str,
        latex: str,
        *,
        rows: bool = False,
        positive: bool = False,
        needs: Needs = (),
    ) -> sp.Expr:
        """What only leads there, by its definition."""
        cell = self._cell(f"{self.called}_{name}", rows, positive)
        equation = self._said(next(self.own), (cell, value), title, Kind.DEFINITION, defines=cell)
        self.helpers.append(FitQuantity(f"{self.called}_{name}", title, latex, cell, equation, needs))
        return cell

    def _said(
        self,
        number: str,
        members: tuple[sp.Expr, ...],
        title: str,
        kind: Kind = Kind.CLAIM,
        because: str = "",
        **more: Any,
    ) -> Equation:
        because = f"{because or 'definition'}{self.rows and ', '}{self.rows}"
        return Equation(number, members, because, kind, title, conditions=self.enough, **more)

    def _definitions(self, *cells: sp.Expr) -> Iterator[Pair]:
        """Those of some quantities, and what they are solved for; of data there are none."""
        known = {part.cell: part.equation for part in (*self.helpers, *self._found.values())}
        for cell in dict.fromkeys(cells):
            if cell in known:
                yield known[cell], cell.base if isinstance(cell, sp.Indexed) else cell

    # --- columns

    def _column(self, name: str, value: sp.Expr, title: str, latex: str) -> sp.Expr:
        """What a row has: itself, if it is a number or a cell."""
        alone = value.is_Atom or isinstance(value, sp.Indexed)
        return value if alone else self._helper(name, value, title, latex, rows=True)

    def _orthogonal(self) -> None:
        """Take each column out of those that come behind it."""
        names = [str(each) for each in self.parameters]
        own = [
            self._column(f"J{n}", slope, f"slope of the model by {name}", f"J_{{{n}%s}}")
            for n, (name, slope) in enumerate(zip(names, self.slopes, strict=True), start=1)
        ]
        left, self.unknowns = self.residual, self.parameters
        if self.linear:
            offset = self.model.xreplace(dict.fromkeys(self.parameters, sp.Integer(0)))
            left = self._column("z", self.observed - offset, "observed less what no parameter moves", "z%s")
        else:
            self.unknowns = tuple(self._cell(f"{self.called}_step{n + 1}") for n in range(self.count))
        self.columns, self.left = [own], [left]
        """Slopes, and what was observed: as they are, then without the first slope, without two, ..."""
        self.norms, self.along, self.shares = list[sp.Expr](), list[sp.Expr](), list[dict[int, sp.Expr]]()
        for m, name in enumerate(names):
            q, n, primes = own[m], m + 1, "'" * (m + 1)
            now = f"without what {' and '.join(names[:n])} moves"
            title = f"squares of what {name} alone moves"
            norm = self._helper(
                f"N{n}", self.total(q**2), title, f"N_{{{n}}}", positive=True, needs=(self._apart(m),)
            )
            along = self._helper(f"d{n}", self.total(q * left) / norm, f"{name} by itself", f"d_{{{n}}}")
            shares = dict[int, sp.Expr]()
            for j in range(n, self.count):
                value, title = self.total(q * own[j]) / norm, f"what {names[j]} moves, as {name} does"
                shares[j] = self._helper(f"r{n}_{j + 1}", value, title, f"r_{{{n}{j + 1}}}")
            own = list(own)
            for j, share in shares.items():
                latex, title = f"J{primes}_{{{j + 1}%s}}", f"slope by {names[j]}, {now}"
                own[j] = self._helper(f"J{j + 1}_{n}", own[j] - share * q, title, latex, rows=True)
            if shares:
                title = f"observed, {now}"
                left = self._helper(f"z{n}", left - along * q, title, f"z{primes}%s", rows=True)
            self.norms.append(norm)
            self.along.append(along)
            self.shares.append(shares)
            self.columns.append(own)
            self.left.append(left)

    def _apart(self, m: int) -> tuple[sp.Rel, str]:
        """That rows tell a parameter from those before it."""
        if m == 0:
            return self.size >= self.count, f"{self.count} parameters take {self.count} rows or more"
        own, before = self.parameters[m], " and ".join(map(str, self.parameters[:m]))
        left, whole = self.columns[m][m] ** 2, self.columns[0][m] ** 2
        return (
            _APART * self.total(left) > self.total(whole) / _APART,
            f"these rows do not tell {own} from {before}: what it does to the model, they do as well",
        )

    # --- what follows, and why

    def _solve(self) -> None:
        """The unknowns from the last to the first: parameters, or the steps to the next ones."""
        found = [self._solved(m) for m in range(self.count)]
        if self.linear:
            self._found |= {part.name: part for part in found}
            return
        self.helpers += reversed(found)
        self.part = self._part()
        for m in range(self.count):
            self._seek(m, self.part)

    def _part(self) -> sp.Expr:
        """How much of a step is taken: all of it where the sum of squares does not grow, else less."""

        def squares(part: sp.Rational) -> sp.Expr:
            pairs = zip(self.parameters, self.unknowns, strict=True)
            moved = {each: each + part * step for each, step in pairs}
            left = (self.observed - self.tangent.xreplace(moved)) ** 2
            if not self.feet:
                return self.total(left)
            return sp.Sum(self.weighing.xreplace(moved) * left, (self.index, 1, self.size))

        # A model that goes through all rows leaves rounding only, which any step makes more or less.
        now = (1 + _ROUNDING) * self.total(self.residual**2) + _NOTHING * self.total(self.observed**2)
        sums = [squares(part) for part in _PARTS[:-1]]
        if self.feet:  # too long for one formula of a worksheet
            shares = ["the whole", *(f"{part} of the" for part in _PARTS[1:-1])]
            titles = [f"sum of squares after {share} step" for share in shares]
            pairs = enumerate(zip(sums, titles, strict=True), start=1)
            sums = [self._helper(f"Q{n}", total, title, f"Q_{{{n}}}") for n, (total, title) in pairs]
        ways = [(part, total <= now) for part, total in zip(_PARTS[:-1], sums, strict=True)]
        value = sp.Piecewise(*ways, (_PARTS[-1], True))
        return self._helper("part", value, "part of the step that is taken", r"\lambda")

    def _solved(self, m: int) -> FitQuantity:
        """An unknown, by those behind it."""
        unknown, shares, tangent = (
            self.unknowns[m],
            self.shares[m],
            "" if self.linear else " along the tangent",
        )
        value = self.along[m] - sp.Add(*(share * self.unknowns[j] for j, share in shares.items()))
        title = self.words[m] if self.linear else f"step of {self.parameters[m]}"
        number, part = (self.number, self._parts[str(unknown)]) if self.linear else (next(self.own), "")
        because = f"the sum of squares is least{tangent}"
        claim = self._said(number, (unknown, value), title, because=because, part=part)
        own = self._definitions(*shares.values(), self.along[m], self.norms[m])
        last = _step(claim, (*own, (self._normal(m, m), unknown)), "Solve its normal equation.")
        latex = "" if self.linear else rf"\delta_{{{m + 1}}}"
        return FitQuantity(str(unknown), title, latex, unknown, Derivation((*self._reduced(m), last)))

    @cached_property
    def normal(self) -> dict[sp.Symbol, Equation]:
        """The normal equation of each parameter: together they say what the parameters are."""
        pairs = zip(self.parameters, self.words, strict=True)
        return {each: normal_equation(sp.diff(self._squares, each), word) for each, word in pairs}

    @property
    def _squares(self) -> sp.Expr:
        if not self.feet:
            return self.total((self.observed - self.model) ** 2)
        off = ((each - foot) ** 2 / self.others[each] ** 2 for each, foot in self.feet.items())
        squares = (self.observed - self.true) ** 2 / self.u**2 + sp.Add(*off)
        return sp.Sum(squares, (self.index, 1, self.size))

    def _normal(self, m: int, j: int) -> Equation:
        """The normal equation of an unknown, when the first m are out."""
        own, out = self.columns[m], ", ".join(map(str, self.unknowns[:m]))
        rest = self.left[m] - sp.Add(*(self.unknowns[i] * own[i] for i in range(m, self.count)))
        title = f"normal equation of {self.unknowns[j]}{' without ' if out else ''}{out}"
        if self.linear or m:
            return self._said("", (self.total(own[j] * rest), sp.Integer(0)), title)
        # Half of the derivative, along the tangent.
        return replace(normal_equation(self.total(own[j] * rest), str(self.unknowns[j])), title=title)

    def _reduced(self, m: int) -> tuple[Step, ...]:
        """What leads to the normal equations of all unknowns but the first m."""
        if m == 0:
            own, found = [*self._definitions(*self.columns[0], self.left[0])], list[Step]()
            for j, normal in enumerate(self.normal.items()):
                pairs = (*own, normal[::-1])
                found += [_step(self._normal(0, j), pairs, "Write it by the slopes of the model.")]
            return tuple(found) if self.linear else ()
        last, says = m - 1, f"Take what {self.unknowns[m - 1]} moves out of all else."
        before = (*self.shares[last].values(), self.along[last], self.norms[last])
        own = [*self._definitions(*self.columns[m][m:], self.left[m], *before)]
        return (
            *self._reduced(last),
            *(
                _step(
                    self._normal(m, j),
                    (*own, *((self._normal(last, i), self.unknowns[i]) for i in (last, j))),
                    says,
                )
                for j in range(m, self.count)
            ),
        )

    def _seek(self, m: int, part_of_step: sp.Expr) -> None:
        """A parameter that steps lead to: it stays where the sum of squares has no slope."""
        parameter, word, slope = self.parameters[m], self.words[m], self._cell(f"{self.called}_G{m + 1}")
        because = "half the slope of the sum of squares, downwards; where that is least, it is zero"
        members, part = (slope, self.total(self.columns[0][m] * self.residual)), self._parts[str(parameter)]
        said = self._said(self.number, members, word, Kind.DEFINITION, because, part=part, defines=slope)
        step = parameter + part_of_step * self.unknowns[m]
        self._found[str(parameter)] = FitQuantity(str(parameter), word, "", parameter, said, step=step)
        title, shown = f"slope of the sum of squares by {parameter}", "the derivative of the sum of squares"
        claim = self._said(
            next(self.own), (sp.diff(self._squares, parameter), -2 * slope), title, because=shown
        )
        rows = (self.columns[0][m], self.residual, self.fitted, *(self.weight, self.there) * bool(self.feet))
        own = (*self._definitions(*rows), *self._nearest)
        step_of = _step(claim, ((said, slope), *own), "Differentiate the sum of squares.")
        self.claims.append(Derivation((step_of,)))

    @property
    def _nearest(self) -> Iterator[Pair]:
        """Where the true values of a row are, solved for what was observed of them."""
        for each, foot in self.feet.items():
            off = self.others[each] ** 2 * self.tilts[each] * (self.observed - self.there) / self.u**2
            because = "half the slope of the sum of squares by it vanishes where that is least"
            title = f"{each.base} of the nearest point of the model"
            yield self._said("", (each, foot - off), title, Kind.DEFINITION, because), each.base

    def _approach(self) -> None:
        """The true values of a row, as far as the parameters are known: along the tangent there."""
        moved = sp.Add(*(s * step for s, step in zip(self.columns[0], self.unknowns, strict=True)))
        for each, foot in self.feet.items():
            name, along = f"at_{each.base}", self.others[each] ** 2 * self.tilts[each] * self.weight
            members, title = (foot, each + along * self.residual), f"{each.base} of the nearest point"
            because = "from there to the row it is as far as the weights make it"
            claim = self._said(self.number, members, title, because=because, part=self._parts[name])
            own = (*self._definitions(self.residual, self.fitted, self.weight), *self._nearest)
            entry = Derivation((_step(claim, own, "Put in where that is."),))
            step = each + along * (self.residual - self.part * moved)
            self._found[name] = FitQuantity(str(foot.base), title, "", foot, entry, step=step, start=each)

    # --- how well

    def _scatter(self) -> None:
        """What the scatter about the model tells."""
        squares = self.total(self.residual**2)
        several = self.size > self.count, f"{self.count} parameters leave nothing over of as many rows"
        s = self._result(
            "s", sp.sqrt(squares / (self.size - self.count)), "scatter about the fit", "s", needs=(several,)
        )
        self._result("S", squares, "sum of squares", "S")
        inverse = self._inverse()

        def product_of(j: int, i: int) -> sp.Expr:
            return sp.Add(
                *(inverse[j, m] * inverse[i, m] / self.norms[m] for m in range(max(j, i), self.count))
            )

        for j, (name, word) in enumerate(zip(self.parameters, self.words, strict=True)):
            title = f"standard uncertainty of the {word} by scatter"
            self._result(f"s_{name}", s * sp.sqrt(product_of(j, j)), title)
        for i, j in self.pairs:
            title = f"correlation of {self.words[i]} and {self.words[j]} by scatter"
            value = product_of(i, j) / sp.sqrt(product_of(i, i) * product_of(j, j))
            self._result(self._together(i, j), value, title)

    def _inverse(self) -> dict[tuple[int, int], sp.Expr]:
        """What each parameter by itself does to those before it: the inverse of the triangle of shares."""
        found: dict[tuple[int, int], sp.Expr] = {(j, j): sp.Integer(1) for j in range(self.count)}
        for j, m in sorted(self.pairs, key=lambda pair: pair[1] - pair[0]):
            value = -sp.Add(*(self.shares[j][i] * found[i, m] for i in range(j + 1, m + 1)))
            if m > j + 1:
                title = f"what {self.parameters[m]} by itself does to {self.parameters[j]}"
                value = self._helper(f"X{j + 1}_{m + 1}", value, title, f"X_{{{j + 1}{m + 1}}}")
            found[j, m] = value
        return found
