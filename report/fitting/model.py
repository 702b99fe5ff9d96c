"""A declared model and its fit to data with errors in one variable or in all of them.

The model is one equation, g(variables, parameters) = 0; its derivatives are sympy's, printed as those of a
sheet are. Where several variables have errors, the true values of a row are unknown, too:
:mod:`~loopsheet.report.fitting.feet` eliminates them.

Three covariances of the parameters differ from the third digit on. `covariance` is that by the adjusted
points, as ISO/TS 28037:2010 has it; `by_hessian` has the exact second derivatives of chi2; `propagated` leads
the errors of the data through the solution by the implicit function theorem (JCGM 100, 5.1.2).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from sympy import Expr, Symbol, diff

from ..column import SheetError
from ..engines.kernels import Kernel
from ..engines.numpy_code import kernel
from .feet import Feet, Known, Second, solved
from .least_squares import Fitted, NotFitted, least_squares
from .triangle import EPS, Array, product

__all__ = ["Adjustment", "Model"]


@dataclass(frozen=True)
class Model:
    """An equation between observed variables, with parameters.

    Parameters
    ----------
    equation : Expr
        What is zero: `y - f(x, theta)`, or any g(x, y, theta).
    parameters, variables : tuple of Symbol
        What is sought, and what is observed.

    Raises
    ------
    SheetError
        It names what is neither, or does not name one of them, or NumPy has no word for some part of it.

    Examples
    --------
    A straight line with errors in both variables (K. Pearson 1901, with the weights of D. York 1966):

    >>> from sympy import symbols
    >>> a, b, x, y = symbols("a b x y")
    >>> line = Model(y - a - b * x, (a, b), (x, y))
    >>> weights = {
    ...     x: [1000, 1000, 500, 800, 200, 80, 60, 20, 1.8, 1],
    ...     y: [1, 1.8, 4, 8, 20, 20, 70, 70, 100, 500],
    ... }
    >>> data = {
    ...     x: [0, 0.9, 1.8, 2.6, 3.3, 4.4, 5.2, 6.1, 6.5, 7.4],
    ...     y: [5.9, 5.4, 4.4, 4.6, 3.5, 3.7, 2.8, 2.8, 2.4, 1.5],
    ... }
    >>> found = line.fit(data, {each: np.array(w) ** -0.5 for each, w in weights.items()}, [5, 0])
    >>> found.parameters.round(8), found.u.round(6), found.u_propagated.round(6)
    (array([ 5.47991022, -0.48053341]), array([0.294971, 0.057985]), array([0.291934, 0.057617]))
    """

    equation: Expr
    parameters: tuple[Symbol, ...]
    variables: tuple[Symbol, ...]

    def __post_init__(self) -> None:
        strange = self.equation.free_symbols ^ {*self._all}
        if strange:
            names = ", ".join(sorted(map(str, strange)))
            raise SheetError(f"a model names its parameters and variables, all and nothing else: {names}")

    @property
    def _all(self) -> tuple[Symbol, ...]:
        return (*self.variables, *self.parameters)

    @cached_property
    def _names(self) -> list[str]:
        return [each.name for each in self._all]

    @cached_property
    def _slopes(self) -> Kernel:
        return kernel([self.equation, *(diff(self.equation, each) for each in self._all)])

    @cached_property
    def _curvatures(self) -> Kernel:
        return kernel([each for row in self._second for each in row])

    @cached_property
    def _second(self) -> list[list[Expr]]:
        return [[diff(self.equation, one, other) for other in self._all] for one in self._all]

    def slopes(self, points: Array, place: Array) -> Array:
        """The equation and its derivatives (n, 1 + m + p) at points (n, m), for parameters (p,)."""
        return self._run(self._slopes, points, place)

    def curvatures(self, points: Array, place: Array) -> Array:
        """The second derivatives (n, m + p, m + p) at the same."""
        count = len(self._all)
        return self._run(self._curvatures, points, place).reshape(-1, count, count)

    def _run(self, printed: Kernel, points: Array, place: Array) -> Array:
        values = dict(zip(self._names, [*points.T, *place[:, None]], strict=True))
        with np.errstate(all="ignore"):
            columns = printed.run(*(values[name] for name in printed.arguments))
        found = np.empty((len(points), len(columns)))
        for number, column in enumerate(columns):
            found[:, number] = column
        return found

    def fit(
        self,
        data: Mapping[Symbol, ArrayLike],
        errors: Mapping[Symbol, ArrayLike | None],
        start: Sequence[float],
        correlated: Mapping[tuple[Symbol, Symbol], ArrayLike] | None = None,
        known: Mapping[Symbol, tuple[float, float]] | None = None,
    ) -> Adjustment:
        """The parameters that are likeliest for normal errors.

        Parameters
        ----------
        data : mapping of Symbol to array (n,)
            The rows, variable by variable.
        errors : mapping of Symbol to array (n,), number or None
            Standard uncertainties. What is left out is exact. None: nobody knows them, but they are all
            alike; then only the scatter tells how uncertain the parameters are.
        start : sequence of float
            A value of each parameter to begin with. With errors in several variables it is to lie near the
            data; what a fit with errors in one of them finds does.
        correlated : mapping of pairs of Symbol to array (n,) or number, optional
            Correlation coefficients of the errors of a row.
        known : mapping of Symbol to (float, float), optional
            Value and standard uncertainty of parameters that are known from elsewhere. An error that all
            rows share is such a parameter, of the value 0.

        Raises
        ------
        SheetError
            A row has no error, or uncertainties are known of some variables only, or are none, or the
            correlation is none.
        """
        columns = [np.asarray(data[each], dtype=float) for each in self.variables]
        rows = np.stack(np.broadcast_arrays(*columns), axis=-1)
        given = {each is not None for each in errors.values()}
        if len(given) != 1:
            raise SheetError("uncertainties are known of all variables with errors, or of none")
        sizes = np.zeros(rows.shape)
        shared = np.zeros((*rows.shape, len(columns))) + np.eye(len(columns))
        for symbol, size in errors.items():
            sizes[:, self.variables.index(symbol)] = 1.0 if size is None else np.asarray(size, dtype=float)
        for pair, coefficient in (correlated or {}).items():
            one, other = map(self.variables.index, pair)
            shared[:, one, other] = shared[:, other, one] = np.asarray(coefficient, dtype=float)
        if not (np.isfinite(sizes).all() and (sizes >= 0).all() and (sizes > 0).any(axis=1).all()):
            raise SheetError("uncertainties are not negative, and each row has one that is not zero")
        if not (np.linalg.eigvalsh(shared) >= -8 * EPS).all():
            raise SheetError(
                "correlation coefficients of a row fit together: no combination has less than none"
            )
        flat = not any(any(self._second[self.variables.index(symbol)]) for symbol in errors)
        which = np.array([self.parameters.index(symbol) for symbol in known or {}], dtype=np.intp)
        values, certain = np.reshape(list((known or {}).values()), (-1, 2)).astype(float).T
        if not (np.isfinite(certain).all() and (certain > 0).all()):
            raise SheetError("what is known of a parameter has a standard uncertainty that is not zero")
        feet = Feet(self.slopes, self.curvatures, rows, sizes, shared, flat, Known(which, values, certain))
        fitted = least_squares(feet.residuals, feet.jacobian, np.array(start, dtype=float))
        feet.residuals(fitted.reached)
        return Adjustment(feet, fitted, given == {True})


@dataclass(frozen=True)
class Adjustment:
    """A fit of a model, and how uncertain it is.

    Attributes
    ----------
    feet : Feet
        What has the adjusted points.
    fitted : Fitted
        Whether it converged, the parameters, chi2, degrees of freedom.
    known : bool
        Whether the uncertainties of the data were given. Without them all covariances are refused, and only
        `u_by_scatter` is left.
    """

    feet: Feet
    fitted: Fitted
    known: bool

    @property
    def parameters(self) -> Array:
        """The parameters (p,), in the order of the model."""
        return self.fitted.parameters

    @property
    def covariance(self) -> Array:
        """Of the parameters (p, p), by the adjusted points."""
        return self._given.covariance

    @property
    def by_hessian(self) -> Array:
        """Of the parameters (p, p), by the second derivatives of half of chi2."""
        return self._applied(np.eye(len(self._given.reached)))

    @property
    def influences(self) -> Array:
        """What one standard uncertainty of each datum moves each parameter by (p, n, m)."""
        pull = self._second.pull
        moved: Array = -self._applied(pull.reshape(len(pull), -1)).reshape(pull.shape)
        return moved

    @property
    def influences_known(self) -> Array:
        """The same of what was known of parameters (p, k)."""
        return -self._applied(self._second.known)

    @property
    def propagated(self) -> Array:
        """Of the parameters (p, p), led from the data through the solution."""
        moved, known = np.swapaxes(self.influences, 0, 1), self.influences_known
        by_rows = np.sum(product(product(moved, self.feet.shared), np.swapaxes(moved, 1, 2)), axis=0)
        found: Array = by_rows + product(known, known.T)
        return found

    @property
    def u(self) -> Array:
        """Standard uncertainties (p,) by the adjusted points."""
        return self._given.u

    @property
    def u_by_hessian(self) -> Array:
        """Standard uncertainties (p,) by the second derivatives of chi2."""
        return np.sqrt(np.diagonal(self.by_hessian))

    @property
    def u_propagated(self) -> Array:
        """Standard uncertainties (p,) led from the data through the solution."""
        return np.sqrt(np.diagonal(self.propagated))

    @property
    def u_by_scatter(self) -> Array:
        """Standard uncertainties (p,) by the adjusted points from the scatter, for t(freedom)."""
        return self.fitted.u_by_scatter

    @property
    def _given(self) -> Fitted:
        if not self.known:
            raise NotFitted(
                "no uncertainty of the data was given: only the scatter tells that of the parameters"
            )
        return self.fitted.believed

    @cached_property
    def _second(self) -> Second:
        return self.feet.second(self._given.reached)

    def _applied(self, right: Array) -> Array:
        """The inverse of the Hessian, times a matrix (p, c)."""
        scale = self._given.triangle.scale
        hessian = self._second.hessian / np.multiply.outer(scale, scale)
        found: Array = solved(hessian[None], (right / scale[:, None])[None])[0] / scale[:, None]
        return found
