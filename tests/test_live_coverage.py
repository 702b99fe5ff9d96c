"""How far to both sides 95 % of a sum of errors are: in the page, beside the convolution of a build."""

from __future__ import annotations

import json
import math
from collections.abc import Callable

import numpy as np
import pytest
from helpers import in_node
from scipy.special import stdtrit

from loopsheet.report.distribution import Shape
from loopsheet.report.engines.javascript import RUNTIME
from loopsheet.report.uncertainty.coverage import Convolved, _Part
from loopsheet.report.views.writer import TEMPLATES

CLOSE = 1e-4
"""Of the probability: it moves no factor of three digits by a tenth of the last."""
ENDED = (Shape.RECTANGULAR, Shape.TRIANGULAR, Shape.ARCSINE)

Error = tuple[Shape, float, float]
OfPage = Callable[[str], list[float]]


@pytest.fixture(scope="session")
def of_page(require: Callable[..., str]) -> OfPage:
    """The numbers that a line of JavaScript makes of the functions of the page."""
    scripts = RUNTIME, TEMPLATES / "live" / "coverage.js"
    functions = [script.read_text(encoding="utf-8") for script in scripts]
    return lambda line: in_node(require("node"), *functions, f"console.log(JSON.stringify({line}));")


def page(errors: list[Error]) -> list[dict[str, object]]:
    """Errors as the page has them, in standard uncertainties of their sum."""
    u = math.hypot(*(size for _, size, _ in errors))
    return [
        {"shape": shape.value, "size": size / u, **({"dof": dof} if math.isfinite(dof) else {})}
        for shape, size, dof in errors
    ]


def build(errors: list[Error]) -> Convolved:
    u = math.hypot(*(size for _, size, _ in errors))
    return Convolved([_Part(shape, size / u, dof) for shape, size, dof in errors])


def sums(seed: int, number: int) -> list[list[Error]]:
    """Sums of few and of many errors, alike and of very different sizes, one of them at least with ends."""
    generator = np.random.default_rng(seed)
    found = []
    for many in generator.choice([1, 2, 3, 9], number):
        own: list[Error] = []
        for n in range(many):
            shape = (
                ENDED[generator.integers(3)]
                if not n
                else (*ENDED, Shape.NORMAL, Shape.STUDENT)[generator.integers(5)]
            )
            dof = float(generator.choice([1, 2, 3, 7, 30])) if shape is Shape.STUDENT else math.inf
            own.append((shape, float(10 ** generator.uniform(-3, 0)), dof))
        found.append(own)
    return found


def test_the_page_has_the_factors_of_a_build(of_page: OfPage) -> None:
    cases = sums(1, 150)
    factors = of_page(f"{json.dumps([page(case) for case in cases])}.map(summedFactor)")
    for case, factor in zip(cases, factors, strict=True):
        law = build(case)
        assert law.below(factor) - law.below(-factor) == pytest.approx(0.95, abs=CLOSE), case


def test_errors_that_are_alone_have_the_factors_that_are_known(of_page: OfPage) -> None:
    alone = [page([(shape, 1.0, math.inf)]) for shape in (*ENDED, Shape.NORMAL)]
    factors = of_page(f"{json.dumps(alone)}.map(summedFactor)")
    known = [
        0.95 * math.sqrt(3),
        (1 - math.sqrt(0.05)) * math.sqrt(6),
        math.sqrt(2) * math.sin(0.475 * math.pi),
    ]
    assert factors == pytest.approx([*known, 1.959963984540054], rel=3e-6)


def test_factors_of_t_distributions(of_page: OfPage) -> None:
    freedom = [1, 2, 3, 4, 5, 10, 29, 100]
    assert of_page(f"{freedom}.map(studentFactor)") == pytest.approx(
        stdtrit(freedom, 0.975).tolist(), rel=1e-11
    )
