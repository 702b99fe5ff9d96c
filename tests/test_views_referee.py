"""The referee's chapter: on the paper it says what was found, of an honest campaign it accuses nobody."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any

import html5lib
import pytest
from drawn_files import pdf_of, svg_of
from made_files import COMPLAINTS, log_of_latex
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from loopsheet.report import stages
from loopsheet.report.document.material import Material
from loopsheet.report.document.pictures import figures as pictures
from loopsheet.report.document.refereed import FIGURE, RefereedPair
from loopsheet.report.document.said import Said
from loopsheet.report.result.numbers import decimals
from loopsheet.report.result.result import Report
from loopsheet.report.result.verdict import (
    INPUT,
    NOT_CHECKABLE,
    NOT_FOUND,
    REACHABLE,
    UNREACHABLE,
    WITHIN,
    Change,
    Explanation,
    Referee,
    TableVerdict,
    Verdict,
)
from loopsheet.report.result.verdict_words import CALLED, at_least, bounds, mismatch, together
from loopsheet.report.study import Study
from loopsheet.report.views import figures, html, latex, reach
from loopsheet.report.workbooks.soft_impact import WORKBOOK

HOSTILE = "<script>alert(1)</script> & 50% \\input{/etc/passwd} $x_1$ ☃ ((( report )))"
SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="360pt" height="180pt"><path d="M0 0"/></svg>'
XHTML = "{http://www.w3.org/1999/xhtml}"


def out_of(report: Report) -> list[RefereedPair]:
    """The published values that are out of reach by themselves."""
    return [value for value in Material(report).refereed if value.verdict == UNREACHABLE]


def sections_of(report: Report) -> dict[str, ET.Element]:
    parser = html5lib.HTMLParser(tree=html5lib.getTreeBuilder("etree"))
    tree: ET.Element = parser.parse(html.render(report, {spec.name: SVG for spec in figures.of(report)}))
    assert parser.errors == []
    identifiers = [element.get("id") for element in tree.iter() if element.get("id")]
    assert len(identifiers) == len(set(identifiers))
    targets = [link.get("href", "")[1:] for link in tree.iter(XHTML + "a")]
    assert set(targets) <= set(identifiers)
    return {element.get("id", ""): element for element in tree.iter() if element.get("id")}


def text_of(element: ET.Element) -> str:
    return " ".join("".join(element.itertext()).split())


def rows_of(element: ET.Element) -> list[list[str]]:
    return [[text_of(cell) for cell in row] for row in element.iter(XHTML + "tr")]


# --- the paper -------------------------------------------------------------------------------------------


def test_two_pairs_are_out_of_reach_by_themselves(paper: Report) -> None:
    out = [(v.pair.comparison.published.cell, v.pair.comparison.published.index) for v in out_of(paper)]
    assert out == [("alpha", (2, 4)), ("alpha", (2, 5))]
    found = sections_of(paper)
    assert "Out of reach by themselves: α 2–4 and α 2–5." in text_of(found["referee"])
    verdicts = {
        row[0]: row[-1] for row in rows_of(found["refereed-values"]) if len(row) == 8 and "–" in row[0]
    }
    assert {name for name, verdict in verdicts.items() if verdict == "unreachable"} == {"2–4", "2–5"}


def test_table_2_and_all_tables_cannot_come_out_of_one_input(paper: Report) -> None:
    joint = paper.referee.joint
    assert joint is not None
    assert joint.at_least is not None
    assert joint.mismatch is not None
    worst, least = mismatch(joint.mismatch), at_least(joint.at_least)
    assert float(least) <= joint.at_least
    found = sections_of(paper)
    said = f"{worst} half units of the last digit; by interval arithmetic none leaves less than {least}"
    assert f"a mismatch of {said}" in text_of(found["referee"])
    rows = {row[0]: row for row in rows_of(found["refereed-tables"])}
    assert rows["Table 2"][1:6] == ["10", "unreachable", worst, least, "α 2–4"]
    assert rows["all together"][1:5] == ["27", "unreachable", worst, least]
    assert rows["Table 3"][2] == "not found"
    assert rows["Table 3"][4] == ""  # no certificate is claimed where there is none
    assert rows["text"][2] == "reachable"


def test_three_explanations_and_no_other(paper: Report) -> None:
    (section,) = (element for name, element in sections_of(paper).items() if name == "referee")
    items = [text_of(item) for item in section.iter(XHTML + "li")][:-2]  # the last two are about the fits
    assert len(items) == len(paper.referee.explanations) == 3
    assert items[0].startswith("xp was truncated, not rounded")
    assert items[1].startswith("xp2 is printed 29.7 for 29.8: then all 27 ")
    assert items[2].startswith("e2 is printed 0.512 for 0.514 (or 0.513, 0.515): then all 27 ")
    assert "equally good: the digits alone cannot decide between them. Nobody is accused" in text_of(section)


def test_the_fit_is_the_log_log_one(paper: Report) -> None:
    fits = Said(Material(paper), ()).fits()
    fit, mean = fits["alpha_log"], fits["alpha_mean"]
    assert fit.endswith("Only the exponent of the log-log fit goes with what is published")
    assert mean.endswith("the mean exponent from the exponent of the log-log fit")
    assert "Only the exponent of the log-log fit goes with what is published." in text_of(
        sections_of(paper)["fit"]
    )


def test_the_ledger_has_errata_of_equations_and_of_data(paper: Report) -> None:
    rows = rows_of(sections_of(paper)["errata-ledger"])[1:]
    kinds = [row[1] for row in rows]
    assert kinds[: len(paper.errata)] == [erratum.kind for erratum in paper.errata]
    assert kinds[len(paper.errata) :] == [
        "label", "label", "contradiction", "contradiction", "unreachable", "unreachable",
        "possible truncation", "possible misprint", "possible misprint",
    ]  # fmt: skip
    named = [row[2] for row in rows if row[1] == "label"]
    assert named == ["Named after (6), but comes out of (7).", "Named after (8), but comes out of (9)."]
    assert all(row[0].startswith("Table 3, C(") for row in rows if row[1] == "label")
    unreachable = next(row for row in rows if row[1] == "unreachable")
    out = out_of(paper)[0]
    ends = bounds(out.found, out.pair.printed)
    assert ends is not None
    assert unreachable[0] == "Table 2, α 2–4"
    assert f"at most {ends[1]}" in unreachable[3]
    assert [row[0] for row in rows[-3:]] == ["xp", "xp 2", "e 2"]


def test_every_value_has_its_verdict_and_its_interval_or_none(paper: Report) -> None:
    rows = [row for row in rows_of(sections_of(paper)["refereed-values"]) if len(row) == 8][1:]
    verdicts = [c.refereed for c in paper.comparisons]
    assert len(rows) == len(verdicts)
    for row, comparison, verdict in zip(rows, paper.comparisons, verdicts, strict=True):
        assert verdict is not None
        assert comparison.cell.value is not None
        assert row[1] == comparison.published.printed.text
        printed = comparison.published.printed
        one_more = decimals(comparison.cell.value / float(printed.scale), printed.decimals + 1)
        assert row[2] == one_more.text  # as the interval has, so that it lies between as it is shown
        assert row[-1] == CALLED[verdict.verdict]
        assert bool(row[4]) == bool(row[5]) == (verdict.low is not None)
        assert not row[4] or float(row[4]) <= float(row[2]) <= float(row[5])
    free = sum(verdict is not None and verdict.low is None for verdict in verdicts)
    assert f"{free} of the {len(rows)} values rest on what is not printed" in text_of(
        sections_of(paper)["referee"]
    )


def test_what_is_free_is_named(paper: Report) -> None:
    said = text_of(sections_of(paper)["referee"])
    for name in paper.referee.free:
        assert Material(paper).head(paper.sheet[name]).meaning in said


def test_both_formats_say_the_same(paper: Report) -> None:
    article = latex.render(paper, [spec.name for spec in figures.of(paper)])
    joint = paper.referee.joint
    assert joint is not None
    assert together(joint)[1:] in article
    for words in (
        r"\section{The referee}",
        r"\includegraphics[max width=0.85\linewidth]{figures/referee.pdf}",
        r"$x_{p}$ was truncated, not rounded",
        "Ledger of errata",
    ):
        assert words in article


def test_the_article_compiles_without_overfull_boxes(
    paper: Report, tmp_path: Path, require: Callable[..., str]
) -> None:
    require("pdflatex")
    specs = figures.of(paper)
    (tmp_path / "figures").mkdir()
    for spec in specs:
        (tmp_path / "figures" / f"{spec.name}.pdf").write_bytes(pdf_of(paper, spec.drawing))
    hostile = with_sources(paper, {"text": HOSTILE})
    (tmp_path / "report.tex").write_text(
        latex.render(hostile, [spec.name for spec in specs]), encoding="utf-8"
    )
    log = log_of_latex(tmp_path)
    assert not re.search(COMPLAINTS, log, re.MULTILINE)


# --- who has published nothing, or nothing wrong ----------------------------------------------------------


def campaign(folder: Path, published: Sequence[str]) -> Report:
    header, *rows = WORKBOOK.example
    table = "\n".join(",".join(row) for row in (header, *rows)) + "\n"
    (folder / "measurements.csv").write_text(table, encoding="utf-8")
    toml = 'workbook = "soft_impact"\n[parameters]\n'
    toml += "".join(f'{name} = "{value}"\n' for name, value in WORKBOOK.example_parameters.items())
    toml += '[measurements]\nfile = "measurements.csv"\n'
    if published:
        (folder / "published.csv").write_text(
            "\n".join(["source,cell,index,value,unit,expect,reason", *published]) + "\n", encoding="utf-8"
        )
        toml += '[published]\nfile = "published.csv"\n'
    (folder / "report.toml").write_text(toml, encoding="utf-8")
    return stages.refereed(Study(folder).computed)


PAIRS = ((1, 2), (1, 3), (2, 3))


def test_an_honest_campaign_is_not_accused(tmp_path: Path) -> None:
    """Its exponents are printed as they are; the inputs are too coarse to give them, but can yield them."""
    report = campaign(tmp_path, [f"Table 2,alpha,{i}-{j},1.300,1,," for i, j in PAIRS])
    found = sections_of(report)
    said = text_of(found["referee"])
    assert "All 3 published values together can come out of one input that prints as given" in said
    assert "Nothing needs an explanation." in said
    assert {row[-1] for row in rows_of(found["refereed-values"]) if len(row) == 8} <= {
        "verdict",
        "reachable",
        "exact",
    }
    assert not re.search(
        "unreachable|misprint|truncation|out of reach", re.sub("Unreachable is said.*", "", said)
    )
    assert "errata" not in found
    assert all(comparison.as_expected for comparison in report.comparisons)


def test_what_comes_out_exactly_needs_few_words(tmp_path: Path) -> None:
    first = campaign(tmp_path, [])
    values = {index: first.values.cell("alpha", index).value for index in PAIRS}
    report = campaign(tmp_path, [f"Table 2,alpha,{i}-{j},{values[i, j]:.3f},1,," for i, j in PAIRS])
    said = text_of(sections_of(report)["referee"])
    assert (
        "All 3 published values together come out as printed, from the inputs exactly as they are printed."
        in said
    )
    assert "Nothing needs an explanation." in said


def test_without_published_values_there_is_no_chapter(tmp_path: Path) -> None:
    report = campaign(tmp_path, [])
    assert not Material(report).refereed
    assert FIGURE not in [spec.name for spec in pictures(report)]
    found = sections_of(report)
    assert "referee" not in found
    assert "referee" not in latex.render(report, [])


def test_without_the_referee_there_is_no_chapter(paper: Report) -> None:
    asked = tuple(replace(comparison, refereed=None) for comparison in paper.comparisons)
    report = replace(paper, referee=Referee(), comparisons=asked)
    found = sections_of(report)
    assert "referee" not in found
    assert "is left open" in text_of(found["published"])
    assert "Which fit was published" not in text_of(found["fit"])
    assert "rests on the log-log fit" in text_of(found["fit"])
    assert len(rows_of(found["errata-ledger"])) == 1 + len(paper.errata)


# --- what the referee may find elsewhere ------------------------------------------------------------------


def with_joint(report: Report, **changes: Any) -> Report:
    joint = report.referee.joint
    assert joint is not None
    return replace(report, referee=replace(report.referee, joint=replace(joint, **changes)))


def test_impossible_and_nothing_explains_it(paper: Report) -> None:
    report = replace(paper, referee=replace(paper.referee, explanations=()))
    said = text_of(sections_of(report)["referee"])
    assert "No small change of what is printed was found with which everything published comes out" in said
    assert "Nobody is accused" not in said


def test_an_uncertain_verdict_says_so(paper: Report) -> None:
    report = with_joint(paper, verdict=NOT_FOUND, at_least=None, mismatch=1.004)
    said = text_of(sections_of(report)["referee"])
    assert (
        "No input that prints as given was found from which all 27 published values together come out" in said
    )
    assert (
        "leaves a mismatch of 1.004 half units of the last digit. That there is none is not certain." in said
    )


def test_a_table_that_settles_it_is_named(paper: Report) -> None:
    said = text_of(sections_of(with_joint(paper, because="Table 2"))["referee"])
    assert "Table 2 alone makes that certain." in said


def test_nothing_can_be_asked_for_where_no_cell_has_a_value(paper: Report) -> None:
    verdict = Verdict(NOT_CHECKABLE)
    asked = tuple(replace(c, refereed=verdict) for c in paper.comparisons)
    report = replace(paper, comparisons=asked, referee=Referee((verdict,) * len(asked)))
    found = sections_of(report)
    assert FIGURE not in [spec.name for spec in pictures(report)]
    assert {row[-1] for row in rows_of(found["refereed-values"])[1:] if len(row) == 8} == {"no value"}
    assert "What would explain" not in text_of(found["referee"])


@pytest.mark.parametrize(
    ("kind", "index", "says"),
    [
        ("misprint", (2,), "2 may have to read 3 or 4."),
        ("truncated", (), "May have been 3 or 4, not 2."),
        ("label", (1,), "2 and 3 or 4 may have changed places."),
        ("label", (), "May be 3 or 4."),
        ("order", (), "May belong in the order 3 or 4."),
    ],
)
def test_every_kind_of_explanation_has_its_line(
    paper: Report, kind: str, index: tuple[int, ...], says: str
) -> None:
    one = Explanation((Change(kind, "e", index, INPUT, "2", "3", ("4",), (2,)),), 0.5, 27, 27)
    report = replace(paper, referee=replace(paper.referee, explanations=(one,)))
    found = sections_of(report)
    assert rows_of(found["errata-ledger"])[-1][2] == says
    assert "This is the smallest change" in text_of(found["referee"])


def with_sources(report: Report, names: dict[str, str]) -> Report:
    """The report with other names of its sources, wherever the referee or a table says them."""

    def renamed(value: Any) -> Any:
        return value and replace(value, source=names.get(value.source, value.source))

    def table(found: TableVerdict) -> TableVerdict:
        return renamed(replace(found, worst=renamed(found.worst)))  # type: ignore[no-any-return]

    referee, joint = report.referee, report.referee.joint
    return replace(
        report,
        comparisons=tuple(replace(c, published=renamed(c.published)) for c in report.comparisons),
        referee=replace(
            referee,
            tables=tuple(map(table, referee.tables)),
            joint=joint and table(joint),
            labels=tuple(renamed(one) for one in referee.labels),
            fits=tuple(replace(fit, published=renamed(fit.published)) for fit in referee.fits),
        ),
    )


def test_hostile_sources_are_text_in_the_page(paper: Report) -> None:
    report = with_sources(paper, {"Table 2": HOSTILE, "Table 3": HOSTILE + "3"})
    found = sections_of(report)
    assert not any(element.tag == XHTML + "script" for element in found["referee"].iter())
    assert HOSTILE in [row[0] for row in rows_of(found["refereed-tables"])]
    assert any(row[0].startswith(HOSTILE + ", α") for row in rows_of(found["refereed-values"]))
    assert any(row[0].startswith(HOSTILE + "3, C") for row in rows_of(found["errata-ledger"]))


def test_hostile_sources_are_text_in_the_article(paper: Report) -> None:
    article = latex.render(with_sources(paper, {"Table 2": HOSTILE, "Table 3": HOSTILE + "3"}), [])
    assert r"\input{" not in article
    assert article.count(r"\textbackslash{}input\{/etc/passwd\}") > 5


# --- numbers ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [0.0, 0.3, 0.96, 0.99996, 1.0, 1.00004, 1.04, 6.46, 8.41])
def test_a_mismatch_is_seen_on_the_right_side_of_one(value: float) -> None:
    seen = float(mismatch(value))
    assert (seen > 1) == (value > 1)
    assert (seen < 1) == (value < 1)


@pytest.mark.parametrize("value", [1.0001, 1.05, 6.4637, 12.0])
def test_no_more_is_claimed_than_is_certain(value: float) -> None:
    assert 1 < float(at_least(value)) <= value


# --- the picture -----------------------------------------------------------------------------------------


def test_the_picture_shows_intervals_and_nothing_else(paper: Report) -> None:
    rows = reach.rows(paper)
    known = [c for c in paper.comparisons if c.refereed and c.refereed.low is not None]
    assert len(rows) == len(known)
    for row, comparison in zip(rows, known, strict=True):
        assert row.name.endswith(comparison.published.printed.text)
        assert row.here == comparison.distance
        assert row.low <= row.here <= row.high
        assert row.band == pytest.approx((-0.5, 0.5))
        # Reachable by itself means that bar and band meet; out of reach, that they do not.
        assert (row.low <= row.band[1] and row.high >= row.band[0]) == row.solid


def words(report: Report) -> list[str]:
    found = figures.draw(report, FIGURE).findobj(Text)
    return [text.get_text() for text in found if text.get_text()]


def test_what_is_out_of_reach_is_said_in_words(paper: Report) -> None:
    assert words(paper).count("unreachable") == 2
    spec = next(spec for spec in pictures(paper) if spec.name == FIGURE)
    assert spec is not None
    assert "12 published values" in spec.alt
    assert "2 lie outside theirs" in spec.alt
    assert spec.number == "L3"
    assert spec in figures.of(paper)


def test_the_picture_is_the_same_bytes_and_small(paper: Report) -> None:
    assert svg_of(paper, FIGURE) == svg_of(paper, FIGURE)
    assert pdf_of(paper, FIGURE) == pdf_of(paper, FIGURE)
    pictures, style = html.inlined({FIGURE: svg_of(paper, FIGURE)})
    assert len(pictures[FIGURE]) + len(style) < 8_000


def with_verdicts(report: Report, change: Callable[[int, Verdict], Verdict]) -> Report:
    asked = tuple(
        replace(c, refereed=c.refereed and change(n, c.refereed)) for n, c in enumerate(report.comparisons)
    )
    return replace(report, comparisons=asked)


def test_every_verdict_can_be_drawn(paper: Report) -> None:
    kinds = (REACHABLE, UNREACHABLE, NOT_FOUND, WITHIN)
    report = with_verdicts(paper, lambda n, verdict: replace(verdict, verdict=kinds[n % 4]))
    seen = words(report)
    assert {"unreachable", "not found", "within uncertainty"} <= set(seen)
    ET.fromstring(svg_of(report, FIGURE))


def test_an_endless_interval_ends_in_an_arrowhead(paper: Report) -> None:
    report = with_verdicts(paper, lambda n, v: replace(v, low=-1e9, high=1e9) if v.low is not None else v)
    (axes,) = figures.draw(report, FIGURE).axes
    arrows = [line.get_marker() for line in axes.lines]
    assert arrows.count("<") == arrows.count(">") == len(reach.rows(report))


def test_of_many_values_those_are_drawn_that_matter(paper: Report) -> None:
    first, out = paper.comparisons[0], paper.comparisons[5]
    report = replace(paper, comparisons=(*(first,) * 200, out))
    rows = reach.rows(report)
    assert len(rows) == reach.MOST_ROWS
    assert rows[-1].verdict == UNREACHABLE
    assert f"{reach.MOST_ROWS} of 201" in " ".join(words(report))


@pytest.mark.parametrize("source", [HOSTILE, "表 2", "$\\frac{1}{0}$", "a" * 200, "\x1b[2J"])
def test_a_hostile_source_is_drawn_as_text(paper: Report, source: str) -> None:
    report = with_sources(paper, {"Table 2": source, "text": source})
    drawn = figures.draw(report, FIGURE)
    renderer = FigureCanvasAgg(drawn).get_renderer()  # type: ignore[no-untyped-call]
    boxes = [
        (text.get_text(), Text.get_window_extent(text, renderer))
        for text in drawn.findobj(Text)
        if text.get_text() and text.get_visible()
    ]
    for text, box in boxes:
        assert box.x0 >= 0, text
        assert box.x1 <= drawn.bbox.x1, text
    for (one, its), (other, others) in combinations(boxes, 2):
        assert not its.overlaps(others), f"{one!r} overlaps {other!r}"
    short, _ = html.inlined({FIGURE: svg_of(report, FIGURE)})
    image = html.picture(short[FIGURE], source)
    assert "<script" not in image
    parsed = html5lib.parse(image, namespaceHTMLElements=False)
    names = {str(element.tag).rpartition("}")[2] for element in parsed.iter()}
    assert names <= {
        "html",
        "head",
        "body",
        "svg",
        "defs",
        "path",
        "use",
        "text",
        "tspan",
        "clipPath",
        "rect",
    }


def test_a_truncated_print_has_its_band_on_one_side(paper: Report) -> None:
    first = paper.comparisons[0]
    printed = replace(first.published.printed, mode="truncated")
    cut = replace(first, published=replace(first.published, printed=printed))
    report = replace(paper, comparisons=(cut, *paper.comparisons[1:]))
    assert reach.rows(report)[0].band == pytest.approx((0, 1))
    ET.fromstring(svg_of(report, FIGURE))
