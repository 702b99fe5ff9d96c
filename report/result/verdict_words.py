"""What the referee found, in words: the one place of its sentences, for the terminal, the pages and machines.

A sentence names cells as the sheet does, ``x_p[2]``; a page prints their symbols. What was only searched for
is rounded to the nearest, what is certain is rounded outwards: no more is claimed than holds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Decimal, localcontext
from fractions import Fraction
from functools import partial

from ...derivations.proved import enumerated
from ..cells.address import address, index_text
from ..inputs.published import PublishedValue
from ..quantity import Printed, behind
from . import verdict

CALLED = {
    verdict.EXACT: "exact",
    verdict.REACHABLE: "reachable",
    verdict.WITHIN: "within uncertainty",
    verdict.UNREACHABLE: "unreachable",
    verdict.NOT_FOUND: "not found",
    verdict.NOT_CHECKABLE: "no value",
}
"""A verdict in a table or a picture."""

POSSIBLE = {
    "misprint": "possible misprint",
    "truncated": "possible truncation",
    "zeros": "possibly no digits",
    "label": "possible confusion",
    "order": "possible disorder",
    "unit": "possible unit",
    "factor": "possible factor",
    "rows": "possible rows",
    "neglect": "possible neglect",
    "parameter": "possible convention",
    "printed": "possible rounding",
}
"""What a change would be, were it the right one."""

EACH_ALONE = "each of these other digits with the first that are named of the other number"
"""What else of several numbers may stand is not said of both at once."""
MOST_TOLD = 5
"""So many explanations are told in sentences."""
NOTHING_EXPLAINS = (
    "no small change of what is printed was found with which everything published comes out: no misprinted "
    "number or two, no truncated column, no zeros that are no digits, no other unit, nothing doubled or "
    "halved, no mean over other rows, nothing exchanged or in another order, nothing computed from rounded "
    "numbers or constants, no other "
    "convention"
)

_MOST_PLACES = 16


# --- numbers ---------------------------------------------------------------------------------------------


_NO_LESS = 1e-6
"""By so little less than 1 a mismatch is 1."""


def mismatch(value: float) -> str:
    """A mismatch with one decimal, or with as many as tell on which side of one it is.

    What is met up to rounding is 1.0, which is met.

    >>> mismatch(8.4107), mismatch(1.02), mismatch(0.9996), mismatch(1.0), mismatch(0.9999999999)
    ('8.4', '1.02', '0.9996', '1.0', '1.0')
    """
    value = 1.0 if 1 - _NO_LESS < value < 1 else value
    for places in range(1, _MOST_PLACES):
        shown = _quantized(value, places, ROUND_HALF_EVEN)
        if (shown > 1, shown < 1) == (value > 1, value < 1):
            return f"{shown:f}"
    return f"{_quantized(value, 1, ROUND_HALF_EVEN):f}"


def at_least(value: float) -> str:
    """What a mismatch is at least: rounded down, for no more is certain.

    >>> at_least(6.4637), at_least(1.04)
    ('6.4', '1.04')
    """
    shown = (_quantized(value, places, ROUND_FLOOR) for places in range(1, _MOST_PLACES))
    return next((f"{one:f}" for one in shown if one > 1), f"{Decimal(value):f}")


def bounds(found: verdict.Verdict, printed: Printed) -> tuple[str, str] | None:
    """What no printed input can leave, in the printed unit with one decimal more; None if it is not known."""
    if found.bound_low is None or found.bound_high is None:
        return None
    places = max(0, printed.decimals + 1)
    low, high = (printed.of(Fraction(end)) for end in (found.bound_low, found.bound_high))
    return f"{_whole(low, places, ROUND_FLOOR):f}", f"{_whole(high, places, ROUND_CEILING):f}"


def _half_units(value: float) -> str:
    """A mismatch with what it counts, for sentences that may be read alone."""
    return f"{mismatch(value)} half units of the last digit"


def _quantized(value: float, places: int, rounding: str) -> Decimal:
    with localcontext(prec=400):
        return Decimal(value).quantize(Decimal(1).scaleb(-places), rounding=rounding)


def _whole(value: Fraction, places: int, rounding: str) -> Decimal:
    """A fraction with some decimals, rounded exactly."""
    scaled = value * 10**places
    number = scaled.__floor__() if rounding == ROUND_FLOOR else scaled.__ceil__()
    with localcontext(prec=400):
        return Decimal(number).scaleb(-places)


# --- names -----------------------------------------------------------------------------------------------


def called(published: PublishedValue, found: verdict.Verdict) -> str:
    """The verdict on a value, and what that means where it does not come out."""
    if found.verdict == verdict.WITHIN:
        return f"{CALLED[verdict.WITHIN]}, but no input that prints as given was found to yield it"
    ends = bounds(found, published.printed)
    if found.verdict != verdict.UNREACHABLE or ends is None:
        return CALLED[found.verdict]
    return f"{CALLED[found.verdict]}: {certain(ends)}"


def certain(ends: tuple[str, str]) -> str:
    """What the bounds of a value say."""
    return f"by interval arithmetic inputs that print as given yield at least {ends[0]} and at most {ends[1]}"


# --- tables ----------------------------------------------------------------------------------------------


def together(table: verdict.TableVerdict) -> str:
    """Whether all values of a table come out of one input, without a full stop."""
    whose, off = _whose(table), "" if table.mismatch is None else _half_units(table.mismatch)
    come = "comes" if table.values == 1 else "come"
    match table.verdict:
        case "exact":
            return f"{whose} {come} out as printed, from the inputs exactly as they are printed"
        case "reachable":
            return f"{whose} can come out of one input that prints as given, with a worst mismatch of {off}"
        case "within-uncertainty":
            return (
                f"no input that prints as given was found from which {whose} {come} out; the best leaves "
                f"a mismatch of {off}. One that is as near as the stated uncertainties say was found: "
                "another measurement would explain it, the printed digits by themselves do not"
            )
        case "unreachable":
            because = f". {table.because} alone makes that certain" if table.because else ""
            return f"{contradiction(table)}: {evidence(table)}{because}"
        case "not found":
            return (
                f"no input that prints as given was found from which {whose} {come} out; the best leaves "
                f"a mismatch of {off}. That there is none is not certain"
            )
    return "none of the published values could be asked for: their cells have no values"


def all_together(found: verdict.Referee) -> str:
    """The same of all tables; shortly, where one of them has told all of it."""
    joint = found.joint
    assert joint is not None
    alike = (table.source for table in found.tables if _told(table) == _told(joint))
    source = next(alike, "")
    if joint.possible or not source:
        return together(joint)
    come = "cannot come out" if joint.verdict == verdict.UNREACHABLE else "did not come out"
    return f"{_whose(joint)} {come} either, as is told of {source}"


def _told(table: verdict.TableVerdict) -> tuple[str, str, str]:
    """What is said of how far off a table is."""
    ends = (table.mismatch, mismatch), (table.at_least, at_least)
    off, least = ("" if value is None else said(value) for value, said in ends)
    return table.verdict, off, least


def contradiction(table: verdict.TableVerdict) -> str:
    """What is certain of a table that does not come out."""
    return f"{_whose(table)} cannot come out of one input that prints as given"


def evidence(table: verdict.TableVerdict) -> str:
    """Why it does not."""
    parts = []
    if table.mismatch is not None:
        parts.append(f"the best input that was found leaves a mismatch of {_half_units(table.mismatch)}")
    if table.at_least is not None:
        parts.append(f"by interval arithmetic none leaves less than {at_least(table.at_least)}")
    elif table.out == 1:
        parts.append("one value is out of reach even by itself")
    elif table.out:
        parts.append(f"{table.out} values are out of reach even by themselves")
    return "; ".join(parts)


def _whose(table: verdict.TableVerdict) -> str:
    n = table.values
    if table.source == verdict.ALL:
        return f"all {n} published values together" if n > 1 else "the published value"
    if table.source == verdict.OTHERS:
        told = f"the {n} published values that are" if n > 1 else "the published value that is"
        return f"{told} neither known to differ nor out of reach"
    return f"the {n} values of {table.source}" if n > 1 else f"the value of {table.source}"


# --- what would explain it -------------------------------------------------------------------------------


def explained(found: verdict.Explanation) -> str:
    """What is claimed and what follows."""
    told = " and ".join(claimed(change) for change in found.changes)
    several = sum(bool(change.also) for change in found.changes) > 1
    return f"{told}{f', {EACH_ALONE}' if several else ''}: {follows(found)}"


def name(found: verdict.Explanation) -> str:
    """What a known difference that rests on it calls it: ``misprint x_p[2]``, ``order x_m (Table 3)``."""
    return " and ".join(map(_name, found.changes))


def _name(change: verdict.Change, *, sourced: bool = True) -> str:
    where = f"({change.source})" if sourced and change.source != verdict.INPUT else ""
    return " ".join(filter(None, (change.kind, address(change.cell, change.row), where)))


def holds(said: str, explanations: Sequence[verdict.Explanation]) -> bool:
    """Whether what a known difference is explained by is an explanation; nothing always is.

    It may be its name, also without the table, or what the referee says that is claimed; a group may be
    called by its number.
    """
    said = said.removeprefix("perhaps ")
    return not said or any(
        said == " and ".join(map(told, changes))
        for each in explanations
        for changes in (each.changes, [replace(change, words=("", "")) for change in each.changes])
        for told in (_name, partial(_name, sourced=False), claimed)
    )


def names(explanations: Sequence[verdict.Explanation]) -> str:
    """What the column ``explained`` calls each of some explanations."""
    called = dict.fromkeys(map(name, explanations))
    return f"in the column 'explained' of a known difference: {'; '.join(called)}"


def perhaps(explanations: Sequence[verdict.Explanation]) -> tuple[str, ...]:
    """What would explain that values do not come out together, or that nothing does.

    Of many the first: they stand in the order in which the referee holds them for likely.
    """
    told = [f"perhaps {explained(each)}" for each in explanations[:MOST_TOLD]]
    if more := len(explanations) - MOST_TOLD:
        told += [f"and {more} more would: values.json has them"] if more > 0 else []
    return tuple(told) or (NOTHING_EXPLAINS,)


def why(found: verdict.Referee) -> tuple[str, ...]:
    """The same for all published values, and how certain that is; nothing where none is asked for."""
    if not found.asked_why:
        return tuple(f"or perhaps {explained(each)}" for each in found.slips)
    return (*perhaps(found.explanations), *([tried(found.tried)] if found.tried is not None else []))


def tried(found: verdict.Tried) -> str:
    """How many changes were tried, and what became of them."""
    explaining, excluded, left = found.explaining, found.excluded, found.open
    number = explaining + excluded + left
    return (
        f"{number} {'change was' if number == 1 else 'changes were'} tried: "
        f"{explaining} {'explains' if explaining == 1 else 'explain'} it, "
        f"{excluded} certainly {'does' if excluded == 1 else 'do'} not, "
        f"{left} {'was' if left == 1 else 'were'} searched for in vain, which is not certain"
    )


def headline(explanations: Sequence[verdict.Explanation]) -> str:
    """What is said above explanations."""
    with_which = "that was found with which everything published comes out"
    if explanations[0].as_printed:
        first = "nothing that is printed needs to be otherwise: it matters only what it was computed from"
    elif len(explanations) == 1:
        first = f"this is the smallest change of what is printed {with_which}"
    else:
        first = f"these are the smallest changes of what is printed {with_which.replace('was', 'were')}"
    several = (
        " They are equally good: the digits alone cannot decide between them."
        if len(explanations) > 1
        else ""
    )
    return f"{first}.{several} Nobody is accused"


def follows(found: verdict.Explanation) -> str:
    """What follows from a change."""
    which = "all" if found.values == found.of else "the other"
    values = f"{which} {found.values} published values come" if found.values > 1 else "the value comes"
    return f"then {values} out of one input, with a worst mismatch of {_half_units(found.mismatch)}"


def claimed(change: verdict.Change) -> str:
    """What is claimed of something printed."""
    cell = address(change.cell, change.row)
    of = "" if change.source == verdict.INPUT else f" of {change.source}"
    printed, would = change.printed, change.would_print
    match change.kind:
        case "printed":
            which = f"{cell}{of}" if change.cell else change.source
            return f"{which} was computed from the printed, rounded {would}"
        case "parameter":
            return f"{cell} was {would}{_or(change)}, not {printed}"
        case "truncated":
            return f"{cell}{of} was {would}, not {printed}"
        case "zeros":
            return f"the zeros at the end of {cell}{of} are no digits: {printed} is {would}"
        case "unit" | "factor" if not change.index:
            if not cell:
                return f"all that is given in {printed} was taken in {would}"
            if printed:
                how = "are in" if of else "were taken in"
                return f"the numbers of {cell}{of} {how} {would}, not in {printed}"
            return f"the numbers of {cell}{of} are to be multiplied by {would or f'1e{change.power}'}"
        case "rows":
            return f"{cell}{of} was taken {would}{_or(change)}"
        case "neglect":
            return f"{cell} was taken as {would}"
        case "order":
            return f"{cell}{of} stands in another order, {would}"
        case "label" if not change.cell:
            both = f"rows {index_text(change.row)} and {index_text(change.other_row)}"
            return f"{both}{of} stand in each other's place"
        case "label" if change.index:
            other = address(change.cell, change.other_row)
            return f"{cell} and {other}{of} stand in each other's place ({printed} and {would})"
        case "label":
            return f"{cell}{of} is {would}"
    return f"{cell}{of} is printed {printed} for {would}{_or(change)}"


def _or(change: verdict.Change) -> str:
    """The other ways in which it could stand."""
    if change.span:
        return f" (or {', '.join(change.also)}; anything from {change.span[0]} to {change.span[1]})"
    return f" (or {', '.join(change.also)})" if change.also else ""


def suggested(found: verdict.Explanation) -> str:
    """What is claimed, shortly: what a line of the ledger says beside the cell of the first change."""
    first, *others = found.changes
    return " and ".join((_suggested(first), *map(claimed, others)))


def _suggested(change: verdict.Change) -> str:
    printed, would = change.printed, " or ".join((change.would_print, *change.also))
    match change.kind:
        case "truncated" | "parameter":
            return f"may have been {would}, not {printed}"
        case "zeros":
            return f"may have zeros at its end that are no digits: {printed} is {would}"
        case "unit" | "factor" if not change.index:
            if printed:
                return f"may be in {would}, not in {printed}"
            return f"may have to be multiplied by {would or f'1e{change.power}'}"
        case "rows":
            return f"may have been taken {would}"
        case "neglect":
            return f"may have been taken as {would}"
        case "order":
            return f"may belong in the order {would}"
        case "label" if not change.cell:
            return f"rows {index_text(change.row)} and {index_text(change.other_row)} may have changed places"
        case "label" if change.index:
            return f"{printed} and {would} may have changed places"
        case "label":
            return f"may be {would}"
    return f"{printed} may have to read {would}"


def relabelled(label: verdict.Relabelled) -> str:
    """That a row is named after an equation which it cannot come from."""
    named = f"{label.source} names {label.cell} after {label.printed}"
    return f"{named}, but it comes out of {label.right}: {because(label)}"


def because(label: verdict.Relabelled) -> str:
    """Why it cannot."""
    given = " and ".join(f"{name} in {unit}" for name, unit in label.gives)
    kind = f"{label.printed} gives {given}, no {label.wanted[0]} in {label.wanted[1]}"
    if not given:
        kind = f"no column of {label.printed} is of this kind"
    others = "".join(f", as {name} {mismatch(off)}" for name, off in label.rivals.items())
    return f"{kind}; the worst mismatch is {_half_units(label.mismatch)}{others}"


def amended(found: verdict.Referee) -> tuple[str, ...]:
    """What comes out with the known misprints put right, and what would explain that not all does."""
    if found.amended is None:
        return ()
    right = enumerated(
        f"{address(each.cell, each.index)} as {each.would_print}, "
        + ("as it is here" if each.would_print == each.printed else f"not {each.printed}")
        for each in found.errata
    )
    said = f"with {right}, {together(found.amended)}"
    if found.amended.possible:
        return (said,)
    first, *others = perhaps(found.misprints)
    return said, f"with that, {first}", *others


def lines(found: verdict.Referee, meaning: Callable[[str], str]) -> Iterator[str]:
    """All of it for a terminal, a finding a line.

    `meaning`: takes a column's name; returns what it is.
    """
    if found.joint is None:
        return
    for said in (*map(together, found.tables), all_together(found)):
        yield f"referee    {said}"
    if found.others is not None and not found.others_come:
        yield f"  {together(found.others)}"
    for said in why(found):
        yield f"  {said}"
    if every := (*(found.explanations if found.asked_why else ()), *found.slips, *found.pinned):
        yield f"  names    {names(every)}"
    for label in found.labels:
        yield f"  label    {relabelled(label)}"
    for each in found.fits:
        yield f"  fit      {fit(each, meaning)}"
    for n, said in enumerate(amended(found)):
        yield f"  {said if n else f'amended  {said}'}"


# --- which average was published -------------------------------------------------------------------------


def fit(found: verdict.Fit, meaning: Callable[[str], str]) -> str:
    """What a published average may be, in two sentences.

    `meaning`: takes a column's name; returns what it is.
    """
    printed = found.published.printed
    unit = behind(printed.unit)
    offs = enumerated(
        f"{mismatch(off)} as the {meaning(name)} {name}" for name, off in found.mismatch.items()
    )
    return (
        f"{printed.text}{unit} is published as the {meaning(found.published.cell)}. "
        f"The worst mismatch is {offs}. {told(found, meaning)}"
    )


def told(found: verdict.Fit, meaning: Callable[[str], str]) -> str:
    """What that says of it."""
    good = [f"the {meaning(name)}" for name, off in found.mismatch.items() if off <= 1]
    if not good:
        return "None of them goes with what is published"
    if len(good) == 1:
        return f"Only {good[0]} goes with what is published"
    return f"The digits do not tell {' from '.join(good)}"
