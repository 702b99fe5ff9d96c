"""The page: complete, correct, self-contained, safe."""

import base64
import hashlib
import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import html5lib
import pytest
from drawn_files import svg_of
from large_campaigns import write
from made_files import without_a_root

from loopsheet.derivations.vocabulary import Vocabulary
from loopsheet.report.cells.address import index_text
from loopsheet.report.document import tree as tree_module
from loopsheet.report.document.material import Material
from loopsheet.report.document.parts import MOST
from loopsheet.report.document.rich import Sentences
from loopsheet.report.document.tables import Tables
from loopsheet.report.document.tree import Math, Node, Unit
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.result import Report
from loopsheet.report.sheet import Given, RepeatAxis
from loopsheet.report.study import Study
from loopsheet.report.views import html, latex

HOSTILE = "<script>alert(1)</script> & 50% \\input{/etc/passwd} $x_1$ ☃ ((( report ))) {{ 7 * 7 }}"
SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="480" height="240"><path d="M0 0"/></svg>'
XHTML = "{http://www.w3.org/1999/xhtml}"
THEAD, TBODY, TH, TD = (XHTML + name for name in ("thead", "tbody", "th", "td"))
SVG_NAME = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def page(report: Report) -> str:
    return html.render(report, {figure.name: SVG for figure in report.workbook.figures})


@pytest.fixture(scope="module")
def tree(page: str) -> ET.Element:
    parser = html5lib.HTMLParser(tree=html5lib.getTreeBuilder("etree"))
    parsed: ET.Element = parser.parse(page)
    assert parser.errors == []
    return parsed


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Report:
    """The report of 26 tests with 325 pairs, of which every third has no exponent at all."""
    folder = write(tmp_path_factory.mktemp("large"), 26)
    file = folder / "measurements.csv"
    rows = file.read_text().splitlines()
    rows[1] = "1,2.000,0.5500,60.00"  # deeper than the fastest, so that no pair of it has a root
    file.write_text("\n".join(rows))
    return Study(folder).computed


def test_tables_without_a_number_are_given_none_that_a_table_has(report: Report) -> None:
    first, second, third, *_ = (replace(spec, number="") for spec in report.workbook.tables)
    tables = first, replace(second, number="1"), third
    own = replace(report, workbook=replace(report.workbook, tables=tables))
    assert [spec.number for spec in Material(own).specs] == ["2", "1", "3"]


def test_one_table_says_which_estimate_to_trust_and_what_each_counts(report: Report) -> None:
    table = Tables(Material(report)).data["estimates"]
    (rows,) = table.groups
    said = {row.cells[1][0].latex: row.cells[-1] for row in rows.rows}  # type: ignore[union-attr]
    assert len(said) == 5
    assert all(words for words in said.values())
    (trusted,) = (symbol for symbol, (words,) in said.items() if "the one to trust" in str(words))
    assert trusted == report.sheet["alpha_eiv"].latex
    other = Tables(Material(report)).data["fit"]
    assert len(other.columns) == len(table.columns) - 1


def test_of_many_rows_the_first_are_shown_and_it_is_said(large: Report) -> None:
    page = html.render(large, {})
    tables = Tables(Material(large)).data
    assert {tables[name].size for name in ("alpha", "pairs")} == {MOST}
    assert tables["measured"].size == 26
    assert page.count("The first 300 pairs are shown; values.json has all of them.") == 2
    assert page.count(f"data-most={MOST}") + page.count(f'data-most="{MOST}"') == 2
    printed = latex.render(large, [])
    assert printed.count("The first 300 pairs are shown; values.json has all of them.") == 2


def test_of_many_remarks_the_first_are_shown_and_links_lead_to_those(
    large: Report, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert Material(large).cut_remarks == ""
    monkeypatch.setattr("loopsheet.report.document.material.MOST", 20)
    document = Material(large)
    assert len(document.remarks) == 20
    assert document.cut_remarks.startswith("The first 20 are shown; ")
    for text in (html.render(large, {}), latex.render(large, [])):
        assert document.cut_remarks in text
    page = html.render(large, {})
    links = set(re.findall(r'href="?#(why-[^">\s]+)', page))
    assert links
    assert links <= set(re.findall(r'id="?(why-[^">\s]+)', page))


def test_end_tags_that_are_left_out_are_read_as_if_they_stood_there(
    report: Report, page: str, tree: ET.Element, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(html, "short_markup", lambda whole: whole)
    whole = html.render(report, {figure.name: SVG for figure in report.workbook.figures})
    assert len(page) < len(whole) - 5000
    parser = html5lib.HTMLParser(tree=html5lib.getTreeBuilder("etree"))
    assert _between_blocks(parser.parse(whole)) == _between_blocks(tree)


def _between_blocks(tree: ET.Element) -> bytes:
    """A tree without the line ends between paragraphs and between items of a list, which nobody sees."""
    return re.sub(rb"(</html:(?:p|li)>)\n", rb"\1", ET.tostring(tree))


def _elements(tree: ET.Element, name: str) -> list[ET.Element]:
    return list(tree.iter(XHTML + name))


def _text(element: ET.Element) -> str:
    return " ".join("".join(element.itertext()).split())


def test_identifiers_are_unique_and_every_link_has_a_target(tree: ET.Element) -> None:
    identifiers = [element.get("id") for element in tree.iter() if element.get("id")]
    assert len(identifiers) == len(set(identifiers))
    targets = [link.get("href", "") for link in _elements(tree, "a")]
    assert targets
    assert all(target.startswith("#") and target[1:] in identifiers for target in targets)
    named = [element.get("aria-labelledby") for element in tree.iter() if element.get("aria-labelledby")]
    assert set(named) <= set(identifiers)


def test_nothing_is_loaded_and_nothing_can_run(page: str, tree: ET.Element) -> None:
    for name in ("script", "link", "iframe", "img"):
        assert not _elements(tree, name)
    for element in tree.iter():
        assert not any(name == "style" or name.startswith("on") for name in element.attrib)
    assert not re.search(r"url\((?!#)|@import|https?://", page)


def test_real_pictures_keep_their_parts_and_their_styles_apart(report: Report) -> None:
    drawn = {figure.name: svg_of(report, figure.name) for figure in report.workbook.figures}
    text = html.render(report, drawn)
    parser = html5lib.HTMLParser(tree=html5lib.getTreeBuilder("etree"))
    tree = parser.parse(text)
    test_identifiers_are_unique_and_every_link_has_a_target(tree)
    test_nothing_is_loaded_and_nothing_can_run(text, tree)
    style = "".join(_elements(tree, "style")[0].itertext())
    pictures = list(tree.iter(SVG_NAME + "svg"))
    assert len(pictures) == len(drawn)
    for picture in pictures:
        own = {element.get("id") for element in picture.iter()}
        used = "".join(v for e in picture.iter() for name, v in e.attrib.items() if name != "aria-label")
        classes = {name for e in picture.iter() if (name := e.get("class"))}
        rules = "".join(re.findall("|".join(rf"\.{name}\{{[^}}]*\}}" for name in classes), style))
        assert all(f".{name}{{" in rules for name in classes)
        assert set(re.findall(r"url\(#([^)]*)\)", used + rules)) <= own
        assert not list(picture.iter(SVG_NAME + "style"))


def test_the_policy_allows_this_style_and_no_other(tree: ET.Element) -> None:
    (style,) = _elements(tree, "style")
    digest = base64.b64encode(hashlib.sha256((style.text or "").encode()).digest()).decode()
    (policy,) = (m.get("content") for m in _elements(tree, "meta") if m.get("http-equiv"))
    assert policy == (
        f"default-src 'none'; script-src 'none'; style-src 'sha256-{digest}'; img-src data:; "
        "base-uri 'none'; form-action 'none'"
    )


def test_every_cell_is_there_with_its_value_in_full(report: Report, tree: ET.Element) -> None:
    shown = {
        (element.get("data-cell"), element.get("data-index")): element
        for element in tree.iter()
        if element.get("data-cell") and element.get("id")
    }
    expected = set()
    for column in report.sheet.columns:
        # How well what is given is known stands with that; its digits say it here.
        if isinstance(column.axis, RepeatAxis) or (isinstance(column.rule, Given) and column.rule.u_of):
            continue
        for cell in report.values.cells(column.name):
            key = (cell.name, index_text(cell.label))
            expected.add(key)
            element = shown[key]
            assert element.get("data-value") == repr(cell.value)
            assert element.get("data-status") == "ok"
            assert (element.tag == XHTML + "input") == isinstance(column.rule, Given)
    assert set(shown) == expected


def test_mentions_in_prose_carry_the_same_values(report: Report, tree: ET.Element) -> None:
    mentions = [e for e in tree.iter() if e.get("data-cell") == "alpha_mean"]
    assert len(mentions) >= 3
    assert {e.get("data-value") for e in mentions} == {repr(report.values.scalar("alpha_mean"))}
    assert {_text(e) for e in mentions} == {"1.3026"}


def test_given_cells_are_inputs_with_the_printed_string(report: Report, tree: ET.Element) -> None:
    inputs = {(e.get("data-cell"), e.get("data-index")): e for e in _elements(tree, "input")}
    for name, printed in report.inputs.measured.items():
        for test, number in zip(report.inputs.only.tests, printed, strict=True):
            element = inputs[name, str(test)]
            assert element.get("value") == number.text
            assert element.get("readonly") is not None
            assert f", {test}" in element.get("aria-label", "")
    assert inputs["v", "2"].get("value") == "2.940"
    assert inputs["ball_density", ""].get("value") == "7800"


def test_shown_digits_follow_the_uncertainties(tree: ET.Element) -> None:
    shown = {e.get("id"): _text(e) for e in tree.iter() if e.get("data-cell") and e.get("id")}
    assert shown["cell-alpha-1-2"] == "1.258"
    assert shown["cell-alpha-1-3"] == "1.2767"
    assert shown["cell-x_m-1"] == "33.996"
    assert shown["cell-Cprime_eq7-5"] == "3619"
    assert shown["cell-C_log"] == "1.019 × 10⁹"


def test_tables_have_captions_heads_by_place_and_links_to_their_equations(tree: ET.Element) -> None:
    """A head without a scope heads its column if its row has heads alone, else its row (HTML, 4.9.12.2)."""
    for table in _elements(tree, "table"):
        assert table.find(XHTML + "caption") is not None
        (above,), *rows = ([list(row) for row in part] for part in table if part.tag in (THEAD, TBODY))
        assert {head.tag for head in above} == {TH}
        for first, *others in (row for part in rows for row in part):
            assert first.tag == TH
            assert {cell.tag for cell in others} == ({TD} if others else set())
            assert others or first.get("scope") == "rowgroup"
    by_id = {element.get("id"): element for element in tree.iter() if element.get("id")}
    for table, equations in {
        "table-alpha": {"#eq-11", "#eq-L5"},
        "table-pairs": {"#eq-12a", "#eq-12b", "#eq-12c", "#eq-L26", "#eq-L10"},
        "table-tests": {"#eq-L3", "#eq-L4", "#eq-9"},
        "table-fit": {"#eq-L12", "#eq-L17", "#eq-L19", "#eq-L20", "#eq-L21"},
    }.items():
        assert equations <= {link.get("href") for link in by_id[table].iter(XHTML + "a")}


def test_published_values_stand_beside_recomputed_ones(report: Report, tree: ET.Element) -> None:
    by_id = {element.get("id"): element for element in tree.iter() if element.get("id")}
    rows = list(by_id["published-Table-2"].iter(XHTML + "tr"))
    assert len(rows) == 11
    assert [_text(cell) for cell in rows[1]][:7] == ["1–2", "α", "1.234", "1.258", "–", "+24.0", "differs"]
    assert len(list(by_id["published-Table-3"].iter(XHTML + "tr"))) == 16
    assert len(list(by_id["published-text"].iter(XHTML + "tr"))) == 3
    assert "Of 27 published values, none comes out as printed and 27 differ." in _text(by_id["result"])


def test_the_ledger_and_every_derivation_are_there(report: Report, tree: ET.Element) -> None:
    by_id = {element.get("id"): element for element in tree.iter() if element.get("id")}
    ledger = _text(by_id["ledger"])
    for proof in report.proofs:
        identifier = "eq-" + proof.equation.label.strip("()")
        assert proof.equation.label in ledger
        claim = by_id[identifier]
        assert proof.status.value in _text(claim)
        assert len(list(claim.iter(XHTML + "li"))) == len(proof.steps)
    assert "50 digits" in _text(by_id["eq-11"])


def test_a_claim_says_what_it_finally_rests_on(tree: ET.Element) -> None:
    by_id = {element.get("id"): element for element in tree.iter() if element.get("id")}
    work = "theorem of kinetic energy, compression"
    for number, said in (
        ("6", f"Rests on: (3); {work}."),
        ("9", "Rests on: (3)."),
        ("L6", "Rests on: nothing, it is an identity."),
    ):
        assert said in _text(by_id[f"eq-{number}"])
    assert "Rests on:" not in _text(by_id["eq-8"])
    (said,) = (p for p in by_id["eq-9"].iter(XHTML + "p") if _text(p).startswith("Rests on:"))
    assert [link.get("href") for link in said.iter(XHTML + "a")] == ["#eq-3"]


def test_findings_about_the_print_are_there(report: Report, tree: ET.Element) -> None:
    (section,) = (e for e in _elements(tree, "section") if e.get("id") == "errata")
    (table,) = section.iter(XHTML + "table")
    assert [_text(head) for head in table.iter(XHTML + "th")][:4] == ["about", "kind", "finding", "evidence"]
    rows = list(table.iter(XHTML + "tr"))[1:]
    assert [_text(list(row)[1]) for row in rows] == [erratum.kind for erratum in report.errata]


def test_landmarks_language_and_skip_link(tree: ET.Element) -> None:
    assert tree.get("lang") == "en"
    for landmark in ("header", "nav", "main", "footer", "h1"):
        assert len(_elements(tree, landmark)) == 1
    assert _elements(tree, "a")[0].get("href") == "#main"
    pictures = list(tree.iter(SVG_NAME + "svg"))
    assert pictures
    assert all(picture.get("role") == "img" and picture.get("aria-label") for picture in pictures)
    levels = [int(e.tag[-1]) for e in tree.iter() if re.fullmatch(r"\{.*\}h[1-6]", str(e.tag))]
    assert all(b - a <= 1 for a, b in pairwise(levels))


def test_pictures_keep_their_size_and_their_text(report: Report, tree: ET.Element) -> None:
    picture = next(tree.iter(SVG_NAME + "svg"))
    assert (picture.get("width"), picture.get("height")) == ("480", "240")
    assert [child.tag for child in picture] == [SVG_NAME + "path"]


def test_what_is_certain_has_no_expanded_uncertainty_on_its_card() -> None:
    """All that is given of two spheres is exact."""
    report = Study(PAPER.parent / "hertz").computed
    assert [budget.u for budget in report.uncertain().budgets] == [0.0] * len(report.workbook.headline)
    page = html.render(report, {})
    assert "class=headline" in page
    assert "class=sure" not in page


def test_two_renderings_are_the_same_bytes(report: Report, page: str) -> None:
    assert html.render(report, {figure.name: SVG for figure in report.workbook.figures}) == page


def test_a_hostile_title_and_a_hostile_reason_are_text(report: Report) -> None:
    first = report.comparisons[0]
    published = replace(first.published, source=HOSTILE, reason=HOSTILE)
    comparisons = (replace(first, published=published), *report.comparisons[1:])
    page = html.render(replace(report, title=HOSTILE, comparisons=comparisons), {})
    parser = html5lib.HTMLParser(tree=html5lib.getTreeBuilder("etree"))
    tree = parser.parse(page)
    assert parser.errors == []
    assert not _elements(tree, "script")
    assert _elements(tree, "title")[0].text == HOSTILE
    assert _text(_elements(tree, "h1")[0]) == HOSTILE
    assert any(_text(cell) == HOSTILE for cell in _elements(tree, "td"))


def test_a_cell_without_a_value_shows_its_code_and_where_it_began(tmp_path: Path) -> None:
    tree = html5lib.parse(html.render(Study(without_a_root(tmp_path)).computed, {}))
    by_id = {element.get("id"): element for element in tree.iter() if element.get("id")}
    for cell in ("cell-alpha-1-2", "cell-C-1-2"):
        assert by_id[cell].get("data-status") == "#NOROOT!"
        assert by_id[cell].get("data-value") == ""
        (link,) = by_id[cell].iter(XHTML + "a")
        assert (_text(link), link.get("href")) == ("#NOROOT!", "#why-alpha-1-2")
    assert "has no root here" in _text(by_id["why-alpha-1-2"])
    assert "over 9 of 10 pairs" in _text(by_id["result"])


# --- nodes -------------------------------------------------------------------------------------------


def test_both_formats_print_every_kind_of_node(report: Report) -> None:
    kinds = {
        name.lower()
        for name, kind in vars(tree_module).items()
        if isinstance(kind, type) and issubclass(kind, Node)
    } - {"node", "block"}
    for writer in (html.HtmlWriter, latex.LatexWriter):
        macros = re.findall(
            r"\(\(\* macro (\w+)\(", (html.TEMPLATES / writer.macros).read_text(encoding="utf-8")
        )
        entries = (
            {"silent"} if writer is latex.LatexWriter else set()
        )  # a cell of a table, printed by `entry`
        assert kinds - entries <= {*macros, *vars(writer)}


@pytest.mark.parametrize(
    ("text", "seen"),
    [
        ("only alpha is left of (11)", "only α is left of (11)"),
        ("both x_m2 and v'_1 at C = 8.1e+9", "both xm2 and v1′ at C = 8.1\u00a0×\u00a010⁹"),
        ("x_p[2] was 29.7, alpha[1-2] 1.23", "xp2 was 29.7, α\u00a01–2 1.23"),
        ("C'*((x - x_p)/(x_m - x_p))^beta", "C′\u202f((x − xp)/(xm − xp))β"),
        ("C has the unit N/m^alpha and F is in N", "C has the unit N/mα and F is in N"),
        ("e[2]**2 <= 1, agree within 0e+00", "e22 ≤ 1, agree within 0"),
        ("a test's mean, e.g. Meyer's (99)", "a test's mean, e.g. Meyer's (99)"),
    ],
)
def test_sentences_of_the_checks_are_set_as_mathematics(report: Report, text: str, seen: str) -> None:
    material = Material(report)
    printed = html.HtmlWriter(material, {})(material.sentences.rich(text))
    assert "".join(html5lib.parseFragment(printed).itertext()) == seen


def test_names_and_units_of_a_method_are_set_in_sentences() -> None:
    """A column that is called like a word of English is a word; Greek letters and powers of units are set."""
    names = {"rho": r"\rho%s", "slope": r"\bar{s}%s", "rho_k": r"\rho_{k%s}"}
    sentences = Sentences(Vocabulary(), names, (), ["kg/m^3", "kg", "N*m"])
    printed = sentences.rich("u of rho is 0.25 kg/m^3 and a slope 3 N*m, not kg/m^3s; rho_k[2] is farthest")
    assert printed == (
        "u of ", Math(r"\rho"), " is 0.25 ", Unit("kg/m^3"), " and a slope 3 ", Unit("N*m"),
        ", not kg/m^3s; ", Math(r"\rho_{k_{2}}"), " is farthest",
    )  # fmt: skip


def test_a_sentence_is_escaped(report: Report) -> None:
    material = Material(report)
    printed = html.HtmlWriter(material, {})(material.sentences.rich("<div> & 'dd'"))
    assert printed == "&lt;div&gt; &amp; &#39;dd&#39;"
