"""A method of one's own in as few lines as the calculation has: what is given, measured, and what follows.

class EndGauge(Method, source="JCGM 100:2008, H.1"):
    "End-gauge calibration."

    l_S = given("m", "length of the standard at 20 °C")
    d = given("m", "difference in length")
    l = let(l_S + d, "length of the end gauge", label="(H.1)")

In the body of the class a name stands for its cell from the line on where it is declared, as an expression of
sympy: what is measured for the cell of a row, what is computed for a row if its formula names one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, cast

from sympy import Expr, false, sympify, true
from sympy.core.relational import GreaterThan, LessThan, StrictGreaterThan, StrictLessThan

from ...derivations.rebuilt import in_absolute_values
from ...derivations.reductions import Median
from ...derivations.vocabulary import Quantity
from ..axis import plural
from ..column import SheetError
from ..named import name_of
from ..quantity import Bounds, behind
from . import algebra
from .codata import adjusted
from .declaring import Method
from .errors import current, named_next, told_together
from .ledger import by, expected, numbered, sketch, standing, uncertainty
from .lines import ComputedLine, FitLine, InputLine, PointsLine, UnknownLine, exact
from .shown import drawing, plot, table, trace

__all__ = [
    "Method",
    "by",
    "claim",
    "constant",
    "count",
    "derivative",
    "drawing",
    "expected",
    "fit",
    "given",
    "groups",
    "let",
    "mean",
    "measured",
    "median",
    "numbered",
    "pairs",
    "plot",
    "points",
    "required",
    "root",
    "rows",
    "sketch",
    "standing",
    "stdev",
    "table",
    "total",
    "trace",
    "uncertainty",
    "unknown",
]


@told_together
def given(
    unit: str | Quantity,
    meaning: str = "",
    *,
    low: float | None = None,
    high: float | None = None,
    positive: bool = False,
    whole: bool = False,
    default: str | None = None,
    exact: bool = False,
    latex: str = "",
    example: str = "",
    optional: bool = False,
    otherwise: Any = None,
    asked: str = "",
) -> Any:
    """Declare a number of ``[parameters]``.

    Parameters
    ----------
    unit : str or Quantity
        Its unit, ``K^-1`` or ``um``, in which it is shown; in report.toml any that converts to it may stand.
        Formulas have it in SI, and an angle in radians. A word of a ledger has unit, meaning and LaTeX; it is
        shown as it is typed.
    meaning : str
        What it is, for messages and captions; a word of a ledger says it.
    low, high : float, optional
        The least and the largest value that is allowed, in that unit.
    positive : bool
        Whether it must be greater than zero.
    whole : bool
        Whether it must be a whole number.
    default : str, optional
        As printed, with its unit: what holds where it is left out.
    exact : bool
        Whether it is a choice or a convention, so that its digits say nothing of precision.
    latex : str
        How it is printed; as its name is, without.
    example : str
        What `loopsheet new` writes for it, as in report.toml; of a column, its numbers with spaces between.
    optional : bool
        Whether it may be left out; what rests on it then is left out, too.
    otherwise : Expr or Equation, optional
        What it is where it is left out: of optional parameters, which are refused beside it.
    asked : str
        What who gives it is told instead of the meaning: ``mass of the target; left out, it is immobile``.
    """
    column = {"exact": exact, "latex": latex, "positive": positive}
    more = {"example": example, "optional": optional, "otherwise": otherwise, "asked": asked}
    return named_next(
        InputLine(meaning, cast(str, unit), column, _bounds(low, high, positive, whole), default, **more)
    )


@told_together
def constant(name: str, *, latex: str = "") -> Any:
    """Declare a constant of nature: its value, unit and uncertainty are CODATA's, as scipy has them.

    Values that were adjusted together are correlated, which is not known here: of a result that rests on two
    of them `check` warns. State it under ``[uncertainty.correlation]``, or take the constant that they make.

    Parameters
    ----------
    name : str
        As in `scipy.constants.physical_constants`, ``molar gas constant``.
    latex : str
        How it is printed; as its name in the body is, without.

    Raises
    ------
    SheetError
        There is none of that name.
    """
    value, unit, u, source = adjusted(name)
    default = f"{value!r} {unit}" + (f", u = {u!r} {unit}" if u else "")
    column = {"exact": not u, "latex": latex, "positive": value > 0}
    bounds = _bounds(None, None, value > 0, False)
    return named_next(InputLine(f"{name}, {source}", unit, column, bounds, default, is_constant=True))


@told_together
def measured(
    unit: str | Quantity,
    meaning: str = "",
    *,
    low: float | None = None,
    high: float | None = None,
    positive: bool = False,
    exact: bool = False,
    latex: str = "",
    example: str = "",
    of: Any = None,
) -> Any:
    """Declare a column of the table of measurements; parameters as for :func:`given`.

    `of`: in which of several tables it stands, what :func:`rows` returned; that of the class's rows, without.
    """
    column = {"exact": exact, "latex": latex, "positive": positive}
    bounds = _bounds(low, high, positive)
    said = InputLine(meaning, cast(str, unit), column, bounds, is_measured=True, of=of, example=example)
    return named_next(said)


@told_together
def let(
    formula: Any,
    meaning: str,
    unit: str = "",
    *,
    label: str = "",
    because: str = "definition",
    like: Any = None,
    display: str = "",
    latex: str = "",
) -> Any:
    """Declare what is computed.

    Parameters
    ----------
    formula : Expr
        In names of the body; one that names a measured column, but in a sum, has a value for each row.
    meaning : str
        What it is.
    unit : str
        Its unit, which the formula must have, and in which it is shown; without it, that of SI that it has.
    label : str
        The number of its equation, ``(H.2)``; its place among the equations, without.
    because : str
        Why it holds, in a few words.
    like : Expr, optional
        What is given or measured in the unit in which it shall be shown.
    display : str
        That unit by itself.
    latex : str
        How it is printed; as its name is, without.
    """
    shown = f"like {name_of(like)}" if like is not None else display
    column = {"latex": latex, "positive": False} | ({"display": shown} if shown else {})
    return named_next(ComputedLine(meaning, unit, column, (exact(formula),), label, because))


@told_together
def unknown(
    meaning: str = "",
    unit: str = "",
    *,
    start: Any = None,
    low: float | None = None,
    high: float | None = None,
    positive: bool = False,
    latex: str = "",
    of: Any = None,
) -> Any:
    """Announce what a root or a parameter of a fit will be called, so that an equation can name it.

    Parameters
    ----------
    meaning, unit, latex : str
        Of a parameter, as for :func:`let`; a root says itself what it is.
    start : float or Expr, optional
        Where a fit begins that is not linear in its parameters; a number is in its unit.
    low, high, positive
        Of a parameter, as for :func:`given`: proofs draw it so. One that is found outside of low and high has
        a warning, one that is found not positive has no value.
    of : Expr, optional
        A column, if there is one for each of its rows; of what :func:`by` iterates.
    """
    column = {"latex": latex, "positive": positive}
    bounds = _bounds(low, high, positive)
    return UnknownLine(meaning, unit, column, None if start is None else exact(start), bounds, of)


@told_together
def required(
    stays: Any, meaning: str, unit: str = "", *, label: str = "", because: str = "", latex: str = ""
) -> Any:
    """Declare where a formula has to stay, ``safe = required(p_0 < 1.6 * Y, "no yield")``.

    What it is called is the margin, ``1.6 * Y - p_0``, which is computed as everything else, and of which the
    report decides as of a cell under ``[limits]``: it is at least 0, or there is a finding. Limits that
    report.toml states of it hold in the place of that.

    Parameters
    ----------
    stays : relation
        ``<``, ``<=``, ``>`` or ``>=`` between two formulas, in names of the body; of what has a value for
        each row, it is of every row. A margin of 0 is met.
    meaning : str
        What it is for.
    unit, label, because, latex : str
        As for :func:`let`, of the margin.
    """
    if not isinstance(stays, GreaterThan | StrictGreaterThan | LessThan | StrictLessThan):
        said = "holds always" if stays == true else "never holds" if stays == false else "is no comparison"
        raise SheetError(f"{stays!s} {said}: a limit is of two formulas, p < 1.6 * Y")
    column = {"latex": latex, "positive": False}
    margin = (exact(stays.gts - stays.lts),)
    because = because or "what is left to the limit: it is met from 0 on"
    return named_next(
        ComputedLine(f"{meaning}, margin", unit, column, margin, label, because, is_margin=True)
    )


@told_together
def root(
    left: Any,
    right: Any,
    meaning: str,
    unit: str = "1",
    *,
    low: Any,
    high: Any,
    start: Any = None,
    label: str = "",
    because: str = "the method",
    display: str = "",
    latex: str = "",
    steps: int = 8,
) -> Any:
    """Declare the root of an equation; that it is the only one is decided before it is sought.

    Parameters
    ----------
    left, right : Expr
        Both sides, in names of the body and in the one that is announced by :func:`unknown`.
    meaning, unit, label, because, display, latex
        As for :func:`let`; the unit is that of the unknown.
    low, high : Expr
        Between which it lies, themselves left out; a number is in the unit of the unknown, and beside a
        formula, which is in SI, a parameter with a default: ``x_low``, ``x_high``.
    start : Expr, optional
        A first guess, alike; the middle, without. It costs steps, never truth.
    steps : int
        How many of Newton's steps are tried before it is bisected.
    """
    for end in (low, high, start):
        if isinstance(end, str):
            raise _no_end(end)
    low, high = exact(low), exact(high)
    if low.is_number and high.is_number and low >= high:
        raise SheetError(f"the root is sought between {low} and {high}: low is not below high")
    first, last = (f"{float(end):.15g}" if end.is_number else str(end) for end in (low, high))
    between = f"{first} and {last}" + behind(unit)
    begun = None if start is None else sympify(start)
    if begun is not None and ((begun <= low) == true or (begun >= high) == true):
        raise SheetError(f"the root is begun at {float(begun):.15g}, which is not between {between}")
    none = f"no value between {between}, these ends left out, satisfies the equation"
    column = {"latex": latex, "positive": False}
    column |= {"display": display} if display else {}
    sides = exact(left), exact(right)
    ends = {"low": low, "high": high, "start": begun, "steps": steps, "none": none}
    return named_next(ComputedLine(meaning, unit, column, sides, label, because, ends))


@told_together
def fit(
    observed: Any, model: Any, *, u: Any = None, label: str = "", figures: bool = True, of: Any = None
) -> Any:
    """Declare a fit by least squares: it finds the unknowns that its model names.

    Of ``line = fit(...)`` there are ``line.fitted`` and ``line.residual`` of each row, ``line.S``, the sum of
    squares, ``line.s``, the scatter, and by scatter ``line.s_a``, the standard uncertainty of a parameter
    ``a``, and ``line.r_a_b``, the correlation of two. Their `u` is propagated as that of everything else.

    Parameters
    ----------
    observed : Expr
        A column over the rows.
    model : Expr
        In names of the body and in those that are announced by :func:`unknown`. If it is linear in these,
        nothing is iterated; else each needs a start.
    u : Expr, ``"stated"`` or a mapping, optional
        The standard uncertainties that rows are weighed by: a formula in the unit of the column, or those
        that are stated of it. Without, all rows are alike. With ``u={y: u_y, x: "stated"}`` x has errors,
        too, and ``line.at_x`` is what it is on the model. Parameters then have the units that are announced.
    label : str
        The number of its equations, ``(H.13)``, which get letters.
    figures : bool
        Whether points and curve, and the residuals, are figures of the report.
    of : optional
        What :func:`groups` returned: the rows of each group have a fit of their own, so that each parameter,
        its standard uncertainty, ``line.S`` and ``line.s`` have a value for each group. The model is linear.
    """
    sizes = (u if isinstance(u, Mapping) else {observed: u}).items()

    def typed(formula: Any) -> Any:
        return in_absolute_values(algebra.in_fractions(exact(formula)))

    weights = {each: size if size is None or isinstance(size, str) else typed(size) for each, size in sizes}
    return named_next(FitLine(observed, typed(model), weights, label, figures, of))


@told_together
def total(formula: Any, *, of: Any = None) -> Expr:
    """The sum over all rows; in the body of a method it may be written ``sum`` as well.

    Parameters
    ----------
    formula : Expr
        Of a row, of a pair, or of a group.
    of : optional
        What :func:`groups` returned: the sum over the rows of each group, so that there is one for each.
    """
    return current().total(formula, of=of)


@told_together
def mean(formula: Any, *, of: Any = None) -> Expr:
    """The mean over all rows, or over all pairs, or over the rows of each group; as :func:`total`."""
    return current().mean(formula, of)


@told_together
def median(formula: Any, *, of: Any = None) -> Expr:
    """The median over all rows, or all pairs, or the rows of each group; as :func:`total`.

    Of an even number it is the mean of the two in the middle. The greatest and the least are written as in
    Python: in the body of a method `max(x)` and `min(x)` are taken over the rows of a column, and
    `max(x, of=specimen)` over those of each group; `max(a, b)` and `min(a, b)` are of several formulas.
    """
    return current().ordered(Median, formula, of)


@told_together
def stdev(formula: Any, *, of: Any = None) -> Expr:
    """The standard deviation over all rows, or all pairs, or the rows of each group; as :func:`total`.

    It is that of a sample, by one less than the number of the rows (JCGM 100:2008, 4.2.2): of one row there
    is none.
    """
    return current().stdev(formula, of)


@told_together
def count(formula: Any = 0, *, of: Any = None) -> Expr:
    """How many rows the sums beside it run over; of a formula, in how many rows, or pairs, it has a value.

    Parameters
    ----------
    formula : Expr, optional
    of : optional
        As for :func:`total`.
    """
    return current().number(formula, of)


@told_together
def derivative(formula: Any, by: Any) -> Expr:
    """The derivative of a formula by a quantity, with all that rests on it put in.

    All other quantities that nothing here is computed from stay as they are. It is a formula, so that
    ``let(derivative(V, x), "slope")`` has it in every engine.

    Parameters
    ----------
    formula : Expr
        In names of the body.
    by : Expr
        What is given, measured or announced; or computed, where nothing else in the formula rests on what
        that is computed from.

    Raises
    ------
    SheetError
        A root, a fit or a sum over rows rests on it: that has no formula to put in.
    """
    return algebra.derivative(current(), exact(formula), exact(by))


def rows(name: str, *, index: str = "", size: str = "") -> Any:
    """Take the rows of a further table, which has a file of its own: ``samples = rows("samples")``.

    ``A = measured("1", "signal", of=samples)`` is a column of it, and what names that has a value for each of
    its rows. No formula names rows of two tables: what leads from one to the other is a mean, a sum or a fit
    over the rows of one. In report.toml each table then has its place, ``[measurements.samples]``. Groups and
    pairs are of the rows that stand behind ``(Method``.

    Parameters
    ----------
    name : str
        What its rows are called, ``samples``.
    index, size : str
        What the running number of a row is called in formulas, ``k_samples`` without, and how many there are,
        ``n_samples``.

    Raises
    ------
    SheetError
        A name is taken, or no name.
    """
    return current().further(name, index or f"k_{name}", size or f"n_{name}")


def groups(by: str, *, rows: str = "", index: str = "", size: str = "", example: str = "") -> Any:
    """Take the rows that have one word in a column as a group: ``specimen = groups("specimen")``.

    With ``of=specimen`` a sum, a mean, a median, a count, the greatest or the least runs over the rows of
    each group. What is computed of it has
    a value for each group, in the order in which their words first appear, and its mean, its sum or a fit
    runs over the groups.

    Parameters
    ----------
    by : str
        The column of words.
    rows : str
        What the groups are called, ``specimens``; the plural of the column, without.
    index, size : str
        What the running number of a group is called in formulas, and how many there are: ``g`` and
        ``groups``, without, of those by further columns ``g_lot`` and ``n_lots``.
    example : str
        What `loopsheet new` writes in the column, with spaces between.

    Raises
    ------
    SheetError
        A name is taken, or no name.
    """
    return current().grouped(by, rows or plural(by), index, size, example)


def pairs(
    *, index: str = "pair", size: str = "pairs", members: str = "i j"
) -> tuple[Callable[[Any], Expr], ...]:
    """Take every pair of rows, the first above the second: ``first, second = pairs()``.

    What names both, ``(second(y) - first(y)) / (second(x) - first(x))``, has a value for each pair, and its
    mean and its sum run over the pairs.

    Parameters
    ----------
    index, size, members : str
        What the running number of a pair is called in formulas, how many there are, and the running numbers
        of its two rows.

    Returns
    -------
    tuple of two callables
        Each takes a formula for the rows, and returns it for one of both.
    """
    both = members.split()
    if len({index, size, *both}) < 4 or len(both) != 2:
        raise SheetError(f"the members of a pair have two names, members='i j', not {members!r}")
    return current().paired(index, size, both)


@told_together
def points(
    low: Any,
    high: Any,
    meaning: str,
    unit: str = "1",
    *,
    number: int = 65,
    label: str = "",
    latex: str = "",
) -> Any:
    """Take points between two ends, themselves among them: what names them has a value for each.

    ``h = points(0, 80, "depth", "um")`` and ``F = let(C * h**2, "force", "N")`` make a curve, which
    ``plot(h, F)`` draws. Where the ends have a value for each row, or for each group, so have the curves.

    Parameters
    ----------
    low, high : Expr
        The first and the last; a number is in the unit, a formula that names others in SI.
    meaning, unit, label, latex : str
        As for :func:`let`; no table shows them, unless :func:`table` does.
    number : int
        How many, on each curve.
    """
    column = {"latex": latex, "positive": False}
    return named_next(PointsLine(meaning, unit, column, exact(low), exact(high), number, label))


@told_together
def claim(
    left: Any,
    right: Any,
    meaning: str,
    *,
    because: str = "",
    from_: Sequence[Any] | None = None,
    label: str = "",
) -> None:
    """State that two formulas are equal whatever was measured: it is proved, or a finding of `check`.

    Parameters
    ----------
    left, right : Expr
        In names of the body; of one that has a value for each row, it is claimed of every row.
    meaning : str
        What is claimed, in a few words.
    because : str
        Why it holds.
    from_ : sequence of Expr, optional
        The quantities whose equations it follows from, all others may have any value; without, all that it
        rests on, back to what is given and measured.
    label : str
        The number of its equation; its place among the equations, without.
    """
    algebra.claimed(current(), exact(left), exact(right), meaning, because, from_, label)


def _no_end(said: Any) -> SheetError:
    return SheetError(f"low and high are numbers, in the unit that is declared, not {said!r}")


def _bounds(low: float | None, high: float | None, positive: bool, whole: bool = False) -> Bounds:
    for end in (low, high):
        if end is not None and not isinstance(end, int | float):
            raise _no_end(end)
    above = positive and (low is None or low <= 0)
    return Bounds(0 if above else low, high, low_open=above, integer=whole)
