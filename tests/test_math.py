"""Mathematics in the author's order: a literal for each construct."""

from xml.etree import ElementTree

import pytest
from sympy import (
    And,
    Expr,
    Integer,
    Integral,
    Le,
    Max,
    Mul,
    Piecewise,
    Rational,
    Sum,
    Symbol,
    besselj,
    beta,
    exp,
    log,
    pi,
    sqrt,
    symbols,
)
from sympy.core.parameters import evaluate
from sympy.printing.latex import greek_letters_set, other_symbols, tex_greek_dictionary, translate

from loopsheet.derivations import soft_impact
from loopsheet.derivations.reductions import Greatest, Median
from loopsheet.derivations.symbols import VOCABULARY, F_of, k, q
from loopsheet.derivations.vocabulary import with_index
from loopsheet.report.document.math import MathPrinter
from loopsheet.report.document.names import latex_names, name_latex
from loopsheet.report.document.notation import fragments
from loopsheet.report.views.mathml import mathml, mathml_block
from loopsheet.report.views.typeset import TEXT_WIDTH, block, width

a, b, c, x, y = symbols("a b c x y", positive=True)
eps = Symbol("eps")
NAMES = latex_names(VOCABULARY, ())
PRINTER = MathPrinter(NAMES)
V, XM, CP, E = (VOCABULARY[name] for name in ("v", "x_m", "Cprime", "e"))
n = Symbol("n_points")

with evaluate(False):
    CASES: list[tuple[Expr, str]] = [
        # the author's order
        (y - x, "y - x"),
        (b + a, "b + a"),
        (c + (b + a), "c + b + a"),
        (c * b * a, "c b a"),
        (c - (b + a), "c - (b + a)"),
        (-(b * a), "-b a"),
        (2 * (b + a), "2 (b + a)"),
        (1 * x, "x"),
        (c * eps * a, r"c \, \mathrm{eps} \, a"),  # a word is set off
        (a * eps**2 * b, r"a \, \mathrm{eps}^{2} \, b"),
        (eps + c, r"\mathrm{eps} + c"),
        (Mul(Integer(2), Integer(3)), r"2 \cdot 3"),
        # fractions
        (b / a, r"\frac{b}{a}"),
        (b * a / c, r"\frac{b a}{c}"),
        (b / c * a, r"\frac{b}{c} a"),
        (b / c * (a / x), r"\frac{b}{c} \frac{a}{x}"),
        (b / (c * a), r"\frac{b}{c a}"),
        (1 / (1 - x), r"\frac{1}{1 - x}"),
        ((b + 1) / (a + 1), r"\frac{b + 1}{a + 1}"),
        (Rational(1, 2) * b * a, r"\frac{1}{2} b a"),
        (b * a / 2, r"\frac{b a}{2}"),
        (-(b / a), r"-\frac{b}{a}"),
        # decimal numbers below, as they were typed
        (Rational(10, 37) * b, r"\frac{b}{3.7}"),
        (Rational(200, 251) * b, r"\frac{2}{2.51} b"),
        (Rational(10, 3) * b, r"\frac{10}{3} b"),
        (Rational(10, 12345678901234567) * b, r"\frac{b}{1234567890123456.7}"),
        # powers
        (x**2, "x^{2}"),
        (x ** Rational(3, 2), "x^{3/2}"),
        (pi**2, r"\pi^{2}"),
        (x ** (2 / (a + 1)), "x^{2/(a + 1)}"),
        ((b / a) ** x, r"\left(\frac{b}{a}\right)^{x}"),
        ((b * a) ** 2, "(b a)^{2}"),
        (sqrt(x), r"\sqrt{x}"),
        # names
        (V[2], "v'_{2}"),
        (V[2] ** 2, r"v_{2}^{\prime 2}"),
        (XM[k], "x_{m_{k}}"),
        (XM[2] ** a, "x_{m_{2}}^{a}"),
        (CP[1], "C'_{1}"),
        (VOCABULARY["alpha"][1], r"\alpha_{1}"),
        (VOCABULARY["m_red"].symbol, r"m_{\mathrm{red}}"),
        (F_of(x), "F"),
        # functions
        (log(b / a), r"\ln\left(\frac{b}{a}\right)"),
        (exp(-x), r"\exp(-x)"),
        (Max(XM[1], XM[2]), r"\max(x_{m_{1}}, x_{m_{2}})"),
        # sums and integrals
        (Integral(F_of(x), (x, 0, a)), r"\int_{0}^{a} F \, dx"),
        (-Integral(b + x, (x, 0, a)), r"-\int_{0}^{a} (b + x) \, dx"),
        (Sum(E[q], (q, 1, n)) / n, r"\frac{1}{n_{\mathrm{points}}} \sum_{q=1}^{n_{\mathrm{points}}} e_{q}"),
        (Sum(E[q] - a, (q, 1, n)), r"\sum_{q=1}^{n_{\mathrm{points}}} (e_{q} - a)"),
        (Median(E[q], (q, 1, n)), r"\underset{1 \le q \le n_{\mathrm{points}}}{\mathrm{median}} \, e_{q}"),
        (Greatest(E[q], (q, 1, n)), r"\underset{1 \le q \le n_{\mathrm{points}}}{\mathrm{max}} \, e_{q}"),
        (
            Greatest(E[q], (q, 1, n)) * Sum(V[q], (q, 1, n)),
            r"(\underset{1 \le q \le n_{\mathrm{points}}}{\mathrm{max}} \, e_{q}) "
            r"\sum_{q=1}^{n_{\mathrm{points}}} v'_{q}",
        ),
        (
            Sum(E[q], (q, 1, n)) * Sum(V[q], (q, 1, n)),
            r"\left(\sum_{q=1}^{n_{\mathrm{points}}} e_{q}\right) \sum_{q=1}^{n_{\mathrm{points}}} v'_{q}",
        ),
        # cases and conditions
        (And(Le(0, x), Le(x, a)), r"0 \le x \le a"),
        (x > a, "x > a"),
        (
            Piecewise((b * x, And(Le(0, x), Le(x, a))), (c, True)),
            r"\begin{cases} b x, & 0 \le x \le a \\ c, & \text{otherwise} \end{cases}",
        ),
    ]


@pytest.mark.parametrize(("expression", "latex"), CASES, ids=[latex for _, latex in CASES])
def test_printed(expression: Expr, latex: str) -> None:
    assert PRINTER.doprint(expression) == latex


def test_what_sympy_has_ordered_begins_with_a_positive_term_and_is_one_fraction() -> None:
    assert MathPrinter().doprint(a - x) == "a - x"
    assert MathPrinter().doprint(pi * a / (b * c)) == r"\frac{\pi a}{b c}"


def test_what_stands_in_euler_s_beta_function_is_set_too() -> None:
    """sympy writes it as text: ``alpha``."""
    alpha = VOCABULARY["alpha"].symbol
    assert PRINTER.doprint(beta(1 / (alpha + 1), Rational(1, 2))) == r"\operatorname{B}(1/(1 + \alpha), 1/2)"


def test_half_an_equation_is_worse_than_none() -> None:
    with pytest.raises(TypeError, match="no LaTeX for Unknown"):
        MathPrinter().doprint(type("Unknown", (Expr,), {})(x))
    assert "J" in MathPrinter().doprint(besselj(1, x))  # sympy's own printer knows it


def test_a_workbook_names_its_own_columns() -> None:
    assert MathPrinter({"alpha_mean": r"\bar{\alpha}%s"}).doprint(Symbol("alpha_mean")) == r"\bar{\alpha}"


@pytest.mark.parametrize(
    ("name", "index", "latex"),
    [
        ("x_p", "", "x_{p}"),
        ("x_p", "2", "x_{p_{2}}"),
        ("n_pairs", "", r"n_{\mathrm{pairs}}"),
        ("gamma", "", r"\gamma"),
        ("speed", "3", r"\mathrm{speed}_{3}"),
        ("drop_height_m", "", r"\mathrm{drop}_{\mathrm{height\_m}}"),
    ],
)
def test_names(name: str, index: str, latex: str) -> None:
    assert name_latex(name, NAMES, index) == latex


def test_a_name_is_a_letter_where_the_library_has_one() -> None:
    for name in sorted({*greek_letters_set, *tex_greek_dictionary, *other_symbols, "word", "abar"}):
        own, theirs = name_latex(name, {}), translate(name)
        if name not in {"lamda", "Lamda", "khi"}:  # which nobody writes, and LaTeX has not
            assert own == (theirs if theirs == f"\\{name}" else rf"\mathrm{{{name}}}"), name


def test_an_index_has_its_place_or_follows() -> None:
    assert with_index("x_{m%s}", "k") == "x_{m_{k}}"
    assert with_index("X", "k") == "X_{k}"
    assert with_index(r"\bar{x}_{1}", "k") == r"{\bar{x}_{1}}_{k}"


def test_equation_11_as_the_paper_prints_it() -> None:
    assert block(PRINTER.sides(soft_impact.eq11.members)).latex == (
        r"\frac{\alpha + 1}{\beta + 1} + \frac{x_{p_{1}}}{x_{p_{2}}} "
        r"\left(e_{2}^{2} - \frac{\alpha + 1}{\beta + 1}\right) "
        r"\left(\frac{v'_{2}}{v'_{1}}\right)^{2/(\alpha + 1)} - e_{1}^{2} = 0"
    )


def test_equation_12c_keeps_its_two_fractions() -> None:
    assert block(PRINTER.sides(soft_impact.eq12c.members)).latex == (
        r"C = \frac{m_{\mathrm{red}} v_{2}^{\prime 2}}{2} \frac{\alpha + 1}{x_{m_{2}}^{\alpha + 1}}"
    )


def test_every_equation_of_the_ledger_has_latex_and_mathml() -> None:
    for equation in soft_impact.LEDGER.equations():
        made = block(PRINTER.sides(equation.members))
        assert made.latex.count("{") == made.latex.count("}")
        page = mathml_block(made)
        assert page.startswith('<math display="block"')
        assert "style=" not in page
        assert "xmlns" not in page


# --- lines ---------------------------------------------------------------------------------------------


def _sum_of(terms: int) -> Expr:
    with evaluate(False):
        total: Expr = x
        for _ in range(terms - 1):
            total = total + x
        return total


def test_a_short_equation_stays_on_one_line() -> None:
    assert block(MathPrinter().sides((y, _sum_of(3)))).rows == ("y = x + x + x",)


def test_a_long_sum_is_broken_between_its_terms_and_loses_none() -> None:
    made = block(MathPrinter().sides((y, _sum_of(40))))
    assert made.left == "y"
    assert len(made.rows) > 1
    assert all(width(row) <= TEXT_WIDTH for row in made.rows)
    assert made.latex == "y = " + " + ".join("x" * 40)
    assert made.aligned.startswith(r"\begin{aligned} y &= x + x")


def test_a_chain_too_long_for_a_line_has_one_equality_a_line() -> None:
    made = block(MathPrinter().sides((y, _sum_of(12), _sum_of(12))))
    assert [row[0] for row in made.rows] == ["=", "="]


def test_two_long_sides_part_at_the_sign() -> None:
    made = block(MathPrinter().sides((_sum_of(15), _sum_of(15))))
    assert made.left == ""
    assert [row[:3] for row in made.rows] == ["x +", "= x"]


@pytest.mark.parametrize(
    ("narrow", "wide"),
    [
        ("a", "a b"),
        (r"\frac{a}{b}", "a + b"),
        ("a^{b}", "a b"),
        ("a_{b}^{c}", "a_{b c d}"),
        (r"\left(a\right)", "(a b)"),
    ],
)
def test_widths(narrow: str, wide: str) -> None:
    assert width(narrow) < width(wide)


# --- MathML --------------------------------------------------------------------------------------------


def test_a_word_is_one_upright_name() -> None:
    assert "<mi>red</mi>" in mathml(r"m_{\mathrm{red}}")


@pytest.mark.parametrize(
    ("latex", "made"),
    [
        ("x_{m}^{2}", "<msubsup><mi>x</mi><mi>m</mi><mn>2</mn></msubsup>"),
        ("v'_{2}", "<msubsup><mi>v</mi><mn>2</mn><mi>′</mi></msubsup>"),
        (r"v''^{2}", "<msup><msup><mi>v</mi><mi>″</mi></msup><mn>2</mn></msup>"),
        (r"\frac{a + 1}{2}", "<mfrac><mrow><mi>a</mi><mo>+</mo><mn>1</mn></mrow><mn>2</mn></mfrac>"),
        (r"\sqrt{x}", "<msqrt><mi>x</mi></msqrt>"),
        (r"\left(x\right)", "<mrow><mo>(</mo><mi>x</mi><mo>)</mo></mrow>"),
        (r"\dot{x}", '<mover><mi>x</mi><mo stretchy="false">˙</mo></mover>'),
        (r"\Omega", '<mi mathvariant="normal">Ω</mi>'),
        (r"\varphi_{0}", "<msub><mi>φ</mi><mn>0</mn></msub>"),
        (r"\text{a < b}", "<mtext>a &lt; b</mtext>"),
        (r"\foo", "<mi>foo</mi>"),
        ("2.5 < x", "<mn>2.5</mn><mo>&lt;</mo><mi>x</mi>"),
        (r"2 \ln(x)", '<mn>2</mn><mspace width=".17em"/><mi>ln</mi>'
         '<mo stretchy="false">(</mo><mi>x</mi><mo stretchy="false">)</mo>'),
    ],
)  # fmt: skip
def test_notation_is_set(latex: str, made: str) -> None:
    assert mathml(latex) == f"<math>{made}</math>"


NO_NOTATION = (
    *("_", "^", "{", "}", "'", "\\", "a_b_c", "a^^", r"\frac", r"\left", r"\left(", r"\sqrt{"),
    *(r"\begin{cases}a", r"\left<a\right>"),
)


@pytest.mark.parametrize("latex", ["", *NO_NOTATION])
def test_what_is_no_notation_is_read_all_the_same(latex: str) -> None:
    ElementTree.fromstring(mathml(latex))
    assert width(latex) >= 0
    fragments(latex)


def test_limits_stand_above_where_there_is_room() -> None:
    total = r"\sum_{k=1}^{n} x_{k}"
    assert "<munderover>" in mathml(total, display=True)
    assert "<munderover>" not in mathml(total)


def test_a_sign_behind_a_relation_is_no_operation() -> None:
    assert '<mo form="prefix">−</mo>' in mathml("a = -b")
    assert '<mo form="prefix">' not in mathml("a - b")
