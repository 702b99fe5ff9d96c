"""A vocabulary belongs to its ledger: a workbook of another field is never shown the symbols of the paper."""

import io
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from helpers import method_folder
from sympy import Function, IndexedBase, Symbol

from loopsheet.derivations.dimensions import Dimensions, dimension_of_unit
from loopsheet.derivations.equation import Derivation, Equation, Kind, Ledger
from loopsheet.derivations.proof import prove
from loopsheet.derivations.proved import ProofStatus
from loopsheet.derivations.text import text
from loopsheet.derivations.vocabulary import NO_WORDS, Quantity, Vocabulary
from loopsheet.report import build
from loopsheet.report.cli import main
from loopsheet.report.study import Study

# Every symbol is called as one of the paper's, and means something else.
WORKBOOK = """
from sympy import Sum, Symbol

from loopsheet.derivations.equation import Derivation, Equation, Kind, Ledger
from loopsheet.derivations.vocabulary import Quantity, Vocabulary
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Parameter, Workbook

k = Symbol("k", integer=True, positive=True)
TESTS = Axis("tests", k, Symbol("n_tests", integer=True, positive=True))
v = Column("v", TESTS, Given("measured"), "W/A", "voltage")
x_p = Column("x_p", TESTS, Given("measured"), "A", "current")
rho = Column("rho", None, Given("parameter"), "W/A", "offset of the meter")
WORDS = Vocabulary(%s)
F, Cprime, mu = (Symbol(name, positive=True) for name in ("F", "Cprime", "mu"))
drop = Equation("(1)", (mu, v[k] - rho.symbol), "definition", Kind.DEFINITION, "voltage v without rho")
law = Equation("(2)", (F, mu * x_p[k]), "definition", Kind.DEFINITION, "power F of a test")
power = Equation("(3)", (F, (v[k] - rho.symbol) * x_p[k]), "(2) with v and rho put in", title="power")
total = Equation("(4)", (Cprime, Sum(v[k] * x_p[k], (k, 1, TESTS.size))), "definition", Kind.DEFINITION)
WORKBOOK = Workbook(
    "ohm", "Powers", "G S Ohm, 1827",
    lambda: Ledger((drop, law, Derivation.of(power, (drop, law), (mu, F), "Put mu in."), total), (), WORDS),
    (Measured("v", "W/A", "voltage"), Measured("x_p", "A", "current")),
    (Parameter("rho", "W/A", "offset of the meter"),),
    lambda given: Sheet((v, x_p, rho, Column("F", TESTS, Formula(power), "W", "power"),
                         Column("Cprime", None, Formula(total), "W", "total"))),
    headline=("Cprime",),
)
"""
WORDS = 'Quantity("v", "voltage", "W/A", "U%s", text="U%s"), Quantity("Cprime", "power", "W", "P%s")'
PRIMED = ("v'", "v′", "C'", "C′", "<mi>′</mi>", r"\prime")
MEANT = ("impact speed", "imprint", "approach", "density of the ball", "restitution", "ratio of the")


def folder(place: Path, words: str) -> Path:
    rows = "test,v [W/A],x_p [A]\n1,2.00,0.50\n2,4.00,1.00\n"
    more = 'title = "Powers"\n[parameters]\nrho = "0.10 W/A"\n'
    return method_folder(place, WORKBOOK % words, rows, more)


def read(out: Path) -> Iterator[tuple[str, str]]:
    """Whatever a reader of the outputs may meet; the page's script holds its own words, not symbols'."""
    for name in ("report.html", "report.tex", "values.json"):
        text = (out / name).read_text(encoding="utf-8")
        yield name, text.partition("<script")[0] if name.endswith("html") else text
    with zipfile.ZipFile(io.BytesIO((out / "report.xlsx").read_bytes())) as book:
        for part in book.namelist():
            if part.endswith(".xml"):
                yield part, book.read(part).decode()


@pytest.fixture(scope="module", params=["", WORDS], ids=["without words", "with words of its own"])
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    place = folder(tmp_path_factory.mktemp("ohm"), request.param)
    build.build(Study(place), place / "out")
    return place, request.param


def test_nothing_that_is_written_shows_the_symbols_of_the_paper(made: tuple[Path, str]) -> None:
    place, words = made
    for name, content in read(place / "out"):
        assert not [word for word in PRIMED + MEANT if word in content], name
    paper = (place / "out" / "report.tex").read_text(encoding="utf-8")
    assert ("U_{k}" in paper, "v_{k}" in paper) == (bool(words), not words)
    assert ("P = " in paper, r"\mathrm{Cprime} = " in paper) == (bool(words), not words)
    assert r"x_{p_{k}}" in paper  # what nothing is said of is spelt as it is called


def test_the_terminal_says_the_words_of_the_workbook(
    made: tuple[Path, str], capsys: pytest.CaptureFixture[str]
) -> None:
    place, words = made
    assert main(["prove", "3", str(place)]) == 0
    assert main(["show", "F[1]", str(place)]) == 0
    assert main(["why", "F[1]", str(place)]) == 0
    said = capsys.readouterr().out
    assert ("F = (-rho + U_k)*x_p,k" if words else "F = (-rho + v_k)*x_p,k") in said
    assert not [word for word in PRIMED + MEANT if word in said]


# --- what a vocabulary is ---------------------------------------------------------------------------------

x, d, p_1 = (Symbol(name, positive=True) for name in ("x", "d", "p_1"))


def test_ranges_come_with_the_ledger_that_is_proved() -> None:
    """The paper samples x far below d; here they are anybody's symbols."""

    def status(big: Symbol, small: Symbol, words: Vocabulary = NO_WORDS) -> ProofStatus:
        given = Equation("", (big, small + 1), "", Kind.DEFINITION, "given")
        claim = Equation("(1)", (big**2 - small, small**2 + small + 1), "", conditions=(small > big / 3,))
        return prove(Ledger((Derivation.of(claim, (given,), (big,), ""),), (), words))[0].status

    assert status(d, x) is status(x, d) is status(p_1, x) is ProofStatus.PROVED
    far = Vocabulary(Quantity("x", "approach", "m", "x%s", (1e-6, 1e-4)))
    assert status(d, x, far) is ProofStatus.UNDECIDED
    assert status(x, d, far) is ProofStatus.PROVED


def test_words_are_found_for_every_form_of_a_symbol() -> None:
    U = Quantity("v", "voltage", "W/A", "U%s", text="U%s")
    words = Vocabulary(U)
    forms = (U.symbol, U[1], IndexedBase(Symbol("v"))[2], Function("v")(x))
    assert all(words.find(form) is U for form in forms)
    assert words.find(x) is None
    assert [text(form, words) for form in forms] == ["U", "U_1", "U_2", "U(x)"]
    assert [text(form, NO_WORDS) for form in forms] == ["v", "v_1", "v_2", "v(x)"]
    assert Dimensions(words).of(U.symbol * x) == dimension_of_unit("W/A")
    assert list(words) == ["v"]
    assert words.plain("v") == (U.symbol,)


def test_a_vocabulary_says_each_word_once() -> None:
    with pytest.raises(ValueError, match="says twice what v means"):
        Vocabulary(Quantity("v", "voltage", "W/A", "U"), Quantity("v", "speed", "m/s", "v"))
