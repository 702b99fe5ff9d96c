"""What a report says to simulation codes: its cards, for whoever asks for them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Any

from .machine.kept import kept
from .messages.errors import Findings, listing, suggest
from .result.card import Card, Cards, NoCard, Point, Prescribed

if TYPE_CHECKING:
    from sympy import Symbol

    from .impacts.card import Bodies
    from .impacts.code import ContactFormula
    from .impacts.drops import Drop, Drops
    from .impacts.law import ForceLaw
    from .result.result import Report

POISSON = 0.3
"""Poisson's ratio of most metals, where none is given."""
_CURVES = (("alpha_eiv", "C_eiv"), ("alpha_log", "C_log"), ("alpha_lin", "C_lin"))
"""Cells of the identified loading curve, the best first."""


class NoImpacts(Exception):
    """A report has no impacts that a simulation could be held to; the message says what it lacks."""


class NotTogether(Exception):
    """What is asked of cards does not go with the codes or the drops.

    `reason` and `known`: what is wrong, and what to do. `option`: of which option it is told.
    """

    def __init__(self, reason: str, known: str, option: str) -> None:
        super().__init__(reason)
        self.reason, self.known, self.option = reason, known, option


@dataclass(frozen=True)
class Asked:
    """What is asked of cards besides their codes, in SI; None where nothing is."""

    prefix: str = ""
    """What stands before the name of an option where it was asked."""
    speed: float | None = None
    E: float | None = None
    nu: float | None = None
    R: float | None = None
    """`speed`, `E`, `nu` and `R`: the impact speed, Young's modulus and Poisson's ratio of both bodies, the
    effective radius."""

    def symbols(self, code: ContactFormula) -> frozenset[Symbol]:
        """Which of Poisson's ratio and radius a code has to know."""
        return code.asks(self.E is not None)

    def bodies(self, drops: Drops) -> Bodies:
        """What is taken of the bodies."""
        from .impacts.card import Bodies

        return Bodies(self.E, self.poisson(drops)[0], drops.radius if self.R is None else self.R)

    def poisson(self, drops: Drops) -> tuple[float, str]:
        """Poisson's ratio that is taken, and what is to be said of it."""
        if self.nu is not None:
            return self.nu, ""
        if math.isfinite(drops.nu):
            return drops.nu, f"Poisson's ratio is that of the ball: {drops.nu:g}"
        return POISSON, f"Poisson's ratio was not given: {POISSON:g}"

    def check(self, codes: Sequence[ContactFormula], drops: Drops) -> None:
        """Raise :class:`NotTogether` for what says nothing to any of the codes, and for what one lacks."""
        from .impacts.code import R, nu

        names, dash = listing([code.name for code in codes], most=20), self.prefix
        if self.E is not None and all(code.by_hertz is None for code in codes):
            why = ": its stiffness is not Hertz's" if any(code.solves for code in codes) else " here"
            reason = f"{dash}E says nothing to {names}{why}"
            raise NotTogether(reason, f"leave {dash}E out", "E")
        for option, symbol in (("nu", nu), ("R", R)):
            unasked = all(symbol not in self.symbols(code) for code in codes)
            if getattr(self, option) is not None and unasked:
                raise NotTogether(
                    f"{dash}{option} says nothing to {names} here", f"leave {dash}{option} out", option
                )
        lacking = [code.name for code in codes if R in self.symbols(code)]
        if lacking and self.R is None and not math.isfinite(drops.radius):
            reason = f"{lacking[0]} wants the radius of the ball, which the folder does not say"
            raise NotTogether(reason, f"give {dash}R", "R")


def drops_of(report: Report) -> Drops:
    """What a report says of impacts.

    Raises
    ------
    NoImpacts
    """
    from .impacts.drops import Drops

    wanted = {"v": "m/s", "e": "1", "m_red": "kg"}
    units = {column.name: column.unit for column in report.sheet.columns}
    lacking = [f"{name} in {unit}" for name, unit in wanted.items() if units.get(name) != unit]
    v = _column(report, "v")
    _, alpha, C = curve(report)
    drops = Drops(
        _number(report, "m_red"),
        v,
        _column(report, "e"),
        _column(report, "x_p") or (math.nan,) * len(v),
        alpha,
        C,
        _number(report, "beta"),
        _number(report, "R_b") if "R_b" in report.sheet else _number(report, "ball_diameter") / 2,
        "target_diameter" not in report.sheet,
        _number(report, "nu_1"),
    )
    if lacking:
        raise NoImpacts(f"it has no {' and no '.join(lacking)}")
    if not drops.mass > 0:
        raise NoImpacts("m_red has no value")
    if not drops.tests:
        raise NoImpacts("no test has a speed and a restitution between 0 and 1")
    return drops


def curve(report: Report) -> tuple[str, float, float]:
    """Which loading curve is taken, and its two numbers; NaN where there is none."""
    curves = ((a, _number(report, a), _number(report, c)) for a, c in _CURVES)
    return next((one for one in curves if math.isfinite(sum(one[1:]))), ("", math.nan, math.nan))


def taken(report: Report, drops: Drops) -> tuple[str, ...]:
    """Which tests are in no card, which are taken together, and which curve is, if not the best."""
    table = report.inputs.only

    def called(row: int) -> str:
        return f"{table.row} {table.called(table.tests[row])}"

    found = [f"{called(row)} is left out here: {why}" for row, why in drops.aside]
    found += [
        f"{listing(map(called, rows), last='and')} are at one speed, {drops.v[rows[0]]:g} m/s: "
        "restitution and imprint are their means"
        for rows in drops.averaged
    ]
    better = [name for name, _ in _CURVES if name in report.sheet]
    name = curve(report)[0]
    if name in better[1:]:
        found.append(f"the loading curve is that of {name}: {better[0]} has no value")
    return tuple(found)


def drop_at(drops: Drops, asked: Asked) -> Drop:
    """The impact that is asked for, without a speed that in the middle.

    Raises
    ------
    NotTogether
    """
    if asked.speed is None:
        return drops.middle
    drop = drops.at(asked.speed)
    if drop is None:
        ends = f"{drops.tests[0].speed:g} to {drops.tests[-1].speed:g} m/s"
        reason = f"{asked.prefix}speed {asked.speed:g} m/s is not among the measured speeds, {ends}"
        raise NotTogether(reason, "nothing is extrapolated", "speed")
    return drop


def card(code: ContactFormula, drops: Drops, drop: Drop, of: str, asked: Asked) -> Card:
    """A card, which tells what was taken though nobody said it.

    Raises
    ------
    Unreachable
        The code cannot return what was measured.
    """
    from .impacts.card import card as made

    found = made(code, drops, drop, of, asked.bodies(drops))
    return replace(found, notes=(*found.notes, *_assumed(code, asked, drops)))


def swept(
    code: ContactFormula | None,
    drops: Drops,
    drop: Drop,
    asked: Asked,
    impacts: int,
    step: Callable[[str], None],
) -> str:
    """Many impacts, evenly from the slowest to the fastest measured speed, as CSV.

    Parameters
    ----------
    code : ContactFormula or None
        Whose card they follow; None: the identified law.
    drops, drop, asked
        As for :func:`card`.
    step : callable
        Told how many are done.

    Raises
    ------
    Unreachable
        The code cannot return what was measured.
    """
    import numpy as np

    from .impacts.sweep import as_csv, sweep

    law, constants = _solved(code, drops, drop, asked)
    speeds = np.linspace(drops.tests[0].speed, drops.tests[-1].speed, impacts).tolist()
    return as_csv(speeds, sweep(law, constants, drops.mass, speeds, step))


def course(code: ContactFormula | None, drops: Drops, drop: Drop, asked: Asked, impacts: int) -> str:
    """The course of impacts one after the other in the same place, as CSV; as for :func:`swept`."""
    from .impacts.sweep import course_as_csv, repeated

    law, constants = _solved(code, drops, drop, asked)
    return course_as_csv(repeated(law, constants, drops.mass, drop.speed, impacts), drops.mass)


def _solved(
    code: ContactFormula | None, drops: Drops, drop: Drop, asked: Asked
) -> tuple[ForceLaw, Mapping[Symbol, float]]:
    """The law that impacts follow, and its constants."""
    from .impacts.card import solved

    if code is None:
        return drops.law(), {}
    return code.law, solved(code, drops, drop, asked.bodies(drops))[0]


def _assumed(code: ContactFormula, asked: Asked, drops: Drops) -> Iterator[str]:
    """What was taken though nobody said it."""
    from .impacts.code import R, nu

    if R in asked.symbols(code) and asked.R is None:
        of = "of the ball, {:g} m: the target is flat" if drops.flat else "of two balls, {:g} m"
        yield "the effective radius is that " + of.format(drops.radius)
    if nu in asked.symbols(code) and (said := asked.poisson(drops)[1]):
        yield said


def contacts_of(report: Report) -> Mapping[str, ContactFormula]:
    """The forces of the contact models that stand beside the tests of a report, by name."""
    workbook = report.workbook
    if workbook.card_constants is None:
        return {}
    from .impacts.contact import formula

    words = workbook.ledger().vocabulary
    named = workbook.card_constants(report.sheet)
    numbers = {symbol: _number(report, name) for symbol, name in named.items()}
    return {model.name: formula(model, numbers, words) for model in workbook.models}


# --- what a folder asks for ------------------------------------------------------------------------------


def asked_for(report: Report) -> Callable[[], Cards]:
    """What makes the cards that a folder asks for in [cards].

    Raises
    ------
    InputError
        What is asked for cannot be, with its place.
    """
    from .impacts.codes import CODES

    said, findings = report.inputs.cards, Findings()
    for name, at in said.codes.items():
        if name not in CODES:
            known = {"known": listing(CODES, most=20), "suggestion": suggest(name, CODES)}
            findings.add("LS604", at, kind="code", text=name, **known)
    findings.check()
    codes: list[ContactFormula] = [CODES[name] for name in said.codes]
    asked = Asked("", **{name: float(printed.value) for name, printed in said.numbers.items()})
    try:
        drops = drops_of(report)
        asked.check(codes, drops)
        drop = drop_at(drops, asked)
    except NoImpacts as error:
        findings.add("LS624", said.at, text=f"the report '{report.title}'", reason=error)
    except NotTogether as error:
        findings.add(
            "LS614", said.places.get(error.option) or said.at, reason=error.reason, known=error.known
        )
    findings.check()

    @cache
    def made() -> Cards:
        notes = taken(report, drops)
        models = contacts_of(report).values()
        every = [_kept(formula, drops, drop, report.title, asked) for formula in (*codes, *models)]
        cards = tuple(each for each in every if isinstance(each, Card))
        refused = tuple(each for each in every if isinstance(each, NoCard))
        return Cards(cards, _measured(report, drops), refused, _laws(), notes)

    return made


def _measured(report: Report, drops: Drops) -> tuple[Point, ...]:
    """What was measured of each impact that is in the cards."""
    known = report.uncertain().u
    aside = {row for row, _ in drops.aside}
    columns = []
    for name, values in (("v", drops.v), ("e", drops.e), ("x_p", drops.x_p)):
        columns += [values, known[name].tolist() if name in known else [math.nan] * len(values)]
    rows = zip(*columns, strict=True)
    return tuple(Point(*row) for number, row in enumerate(rows) if number not in aside)


def _kept(code: ContactFormula, drops: Drops, drop: Drop, of: str, asked: Asked) -> Card | NoCard:
    """A card, made now or before, or why there is none."""
    from msgspec import convert, to_builtins

    from .impacts.card import Unreachable

    def make() -> Any:
        try:
            return {"card": to_builtins(card(code, drops, drop, of, asked))}
        except Unreachable as error:
            return {"refused": to_builtins(NoCard(code.name, code.title, str(error)))}

    found = kept("a card", [repr(code), of, repr(drops), repr(drop), repr(asked)], make)
    if "card" in found:
        return convert(found["card"], Card)
    return convert(found["refused"], NoCard)


@cache
def _laws() -> dict[str, tuple[Prescribed, ...]]:
    """What damping numbers return for a prescribed restitution, by author."""
    from ..derivations.contact.damping import MEMBERS
    from .impacts.card import PRESCRIBED
    from .impacts.damping import number_by, returned

    return {
        MEMBERS[author].title: tuple(
            Prescribed(e, returned(number_by(author, e, _EXPONENT))) for e in PRESCRIBED
        )
        for author in MEMBERS
    }


_EXPONENT = 1.5
"""Hertz's: the only one that a damping number hangs on is that by Flores."""


# --- the report --------------------------------------------------------------------------------------------


def _column(report: Report, name: str) -> tuple[float, ...]:
    found = report.values.value
    return tuple(map(float, found[name])) if name in report.sheet and name in found else ()


def _number(report: Report, name: str) -> float:
    values = _column(report, name)
    return values[0] if len(values) == 1 else math.nan
