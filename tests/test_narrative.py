"""Narratives: what a report says, from Markdown with roles and conditions; and the shipped ones."""

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from slipped_campaigns import PAPER, Slip, write

from loopsheet.report.document import cards, narrative
from loopsheet.report.document.material import Material
from loopsheet.report.document.narrative import NarrativeError, narratives, sections
from loopsheet.report.document.said import SAID, Said
from loopsheet.report.document.tree import (
    Code,
    Count,
    Display,
    Figure,
    Items,
    Link,
    Math,
    Note,
    Number,
    Paragraph,
    Refer,
    Section,
    Strong,
    Table,
    Value,
)
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.which_workbook import find_workbook
from loopsheet.report.workbooks import SHIPPED

Reads = Callable[..., tuple[Section, ...]]


@pytest.fixture
def reads(report: Report, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Reads:
    """Reads a text as the narrative of the paper."""
    monkeypatch.setattr(narrative, "FOLDER", tmp_path)
    narrative._lines.cache_clear()

    def read(
        text: str, drawn: tuple[str, ...] = ("loops",), said: Said | None = None, **parts: str
    ) -> tuple[Section, ...]:
        (tmp_path / "parts").mkdir(exist_ok=True)
        (tmp_path / "own.md").write_text(text, encoding="utf-8")
        for name, part in parts.items():
            (tmp_path / "parts" / f"{name}.md").write_text(part, encoding="utf-8")
        narrative._lines.cache_clear()
        return sections("own", said or Said(Material(report), drawn))

    return read


def test_a_narrative_is_chapters_of_blocks(reads: Reads) -> None:
    first, second = reads(
        "# One {#one}\n\nSome **strong words** and `code`,\nand [more](#two).\n\n"
        "> A note\n> of two lines.\n\n- an item\n- another\n\n# Two {#two .issued}\n"
    )
    assert (first.name, first.title, first.issued) == ("one", "One", False)
    assert (second.name, second.blocks, second.issued) == ("two", (), True)
    paragraph, note, items = first.blocks
    assert isinstance(paragraph, Paragraph)
    assert paragraph.content[0] == "Some "
    assert isinstance(paragraph.content[1], Strong)
    assert paragraph.content[2:] == (
        " and ", Code("code"), ",", " ", "and ", Link("section", "two", ("more",)), "."
    )  # fmt: skip
    assert note == Note(("A note", " ", "of two lines."))
    assert items == Items((("an item",), ("another",)))


def test_a_role_is_shown_where_it_is_alone_and_else_referred_to(reads: Reads) -> None:
    (chapter,) = reads(
        "# One {#one}\n\n{eq}`(11)`\n\n{table}`alpha`\n\n{fig}`loops`\n\n"
        "{eq}`(11)`, {table}`alpha`, {fig}`loops`, {cell}`alpha_mean`, {sym}`x_m`, {count}`tests`\n"
    )
    equation, table, figure, text = chapter.blocks
    assert isinstance(equation, Display)
    assert isinstance(table, Table)
    assert isinstance(figure, Figure)
    assert isinstance(text, Paragraph)
    assert [type(part) for part in text.content if part != ", "] == [Refer, Link, Link, Value, Math, Count]


def test_what_a_report_does_not_have_is_left_out(reads: Reads) -> None:
    (chapter,) = reads("# One {#one}\n\n{fig}`loops`\n\nBefore {fig}`loops`after.\n", drawn=())
    assert chapter.blocks == (Paragraph(("Before ", "after.")),)


@pytest.mark.parametrize(
    ("condition", "said"),
    [
        ("{fig}`loops`", "It is drawn, so."),
        ("{fig}`loops` {cell}`beta`", "It is drawn, so."),
        ("{fig}`lankarani`", "It is not drawn."),
        ("{fig}`loops` {fig}`lankarani`", "It is not drawn."),
    ],
)
def test_a_condition_may_lie_inside_of_a_paragraph(reads: Reads, condition: str, said: str) -> None:
    (chapter,) = reads(
        f"# One {{#one}}\n\nIt is\n:::{{if}} {condition}\ndrawn\n, so\n:::{{else}}\nnot drawn\n:::\n.\n"
    )
    (paragraph,) = chapter.blocks
    assert isinstance(paragraph, Paragraph)
    assert "".join(map(str, paragraph.content)) == said


def test_conditions_hold_each_other_and_parts_are_put_in(reads: Reads) -> None:
    inner = ":::{if} {fig}`lankarani`\n:::{if} {fig}`loops`\nno\n:::{else}\nno\n:::\n:::{else}\nyes\n:::\n"
    (chapter,) = reads("# One {#one}\n\n:::{include} inner\n", inner=inner)
    assert chapter.blocks == (Paragraph(("yes",)),)


def values_in(run: object) -> Iterator[Value]:
    """The cells in running text."""
    if isinstance(run, Value):
        yield run
    elif isinstance(run, tuple):
        for part in run:
            yield from values_in(part)
    elif isinstance(run, (Section, Paragraph, Note, Strong)):
        yield from values_in(run.blocks if isinstance(run, Section) else run.content)


@pytest.fixture(scope="module")
def slipped(tmp_path_factory: pytest.TempPathFactory) -> Report:
    """The paper with one depth a tenth of itself: some pairs and the global fit have no value."""
    folder = write(tmp_path_factory.mktemp("slipped"), Slip("x_p", 2, up=False).of(PAPER))
    return Study(folder).computed


def test_a_sentence_about_a_cell_without_a_value_says_so_and_why(slipped: Report, reads: Reads) -> None:
    line = "The exponent is {cell}`alpha_eiv`, not {cell}`beta`, and {cell}`chi2_eiv` is left over."
    said = Said(Material(slipped), ())
    (chapter,) = reads(f"# One {{#one}}\n\n{line}\nThe mean is {{cell}}`alpha_mean`.\n", said=said)
    (paragraph,) = chapter.blocks
    assert isinstance(paragraph, Paragraph)
    symbols = Math(r"\alpha_{\mathrm{eiv}}"), " and ", Math(r"\chi^2_{\mathrm{eiv}}")
    assert paragraph.content[:4] == (*symbols, " have no value: ")
    text = "".join(part for part in paragraph.content if isinstance(part, str))
    assert "did not settle: no power law with a positive exponent comes near to all tests, or" in text
    assert text.endswith("state one above zero. The mean is .")
    assert [value.item.cell.name for value in values_in(chapter)] == ["alpha_mean"]


NO, CLOSE, ONE = (
    "No single power law describes these tests",
    "The uncertainties look overstated",
    "One power law describes these tests",
)


@pytest.mark.parametrize(
    ("chi2", "said", "probability"),
    [
        (1e-4, CLOSE, "3e-7"),
        (0.11, CLOSE, "0.009"),
        (0.12, ONE, "0.99"),
        (2.366, ONE, "0.5"),
        (11.2, ONE, "0.01"),
        (11.5, NO, "0.009"),
        (55.19, NO, "6e-12"),
        (1e4, NO, "below 1e-15"),
    ],
)
def test_what_is_said_first_is_whether_one_curve_serves(
    report: Report, chi2: float, said: str, probability: str
) -> None:
    """Chi-square of three degrees of freedom: 1 % below 0.115, half below 2.366, 1 % above 11.345."""
    values = replace(report.values, value={**report.values.value, "chi2_eiv": np.array([chi2])})
    told = sections("soft_impact", Said(Material(replace(report, values=values)), ()))[0].blocks[0]
    assert isinstance(told, Note)
    text = "".join(map(plain, told.content))
    assert text.startswith(said)
    assert text.endswith(f"with probability {probability}.")


def plain(part: object) -> str:
    """What an inline says."""
    if isinstance(part, Number) and part.figure:
        return part.figure.plain
    inside = part.content if isinstance(part, Strong) else part.text if isinstance(part, Count) else ()
    return "".join(map(plain, inside)) or str(part)


def test_no_sentence_of_a_shipped_narrative_shows_a_code(slipped: Report, report: Report) -> None:
    known, lacking = (sections("soft_impact", Said(Material(each), ())) for each in (report, slipped))
    assert "alpha_eiv" in {value.item.cell.name for value in values_in(known)}
    shown = list(values_in(lacking))
    assert {"alpha_mean", "beta"} <= {value.item.cell.name for value in shown}
    assert all(value.item.ok for value in shown)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        (
            "{cell}`alpha_maen`",
            "prose/own.md:5: no column is called 'alpha_maen'; did you mean 'alpha_mean'?",
        ),
        ("and {tabel}`alpha`", "prose/own.md:5: no role is called {tabel}; there are cell, count, eq, "),
        ("{eq}`(99)`", "prose/own.md:5: no equation is called '(99)'; "),
        ("{count}`test`", "prose/own.md:5: no axis is called 'test'; did you mean 'tests'?"),
        ("{say}`taly`", "prose/own.md:5: no sentence is called 'taly'; did you mean 'tally'?"),
        ("{say}`exactly`", "prose/own.md:5: {say}`exactly` is a condition: there is nothing to show"),
        ("## No name", "prose/own.md:5: a heading is '# Title {#name}'"),
        (":::{if} {say}`taly`", "prose/own.md:5: no sentence is called 'taly'"),
        (":::{if} {say}`exactly`", "prose/own.md:5: this condition does not end"),
        (":::", "prose/own.md:5: nothing is open that ::: could belong to"),
        (":::{if} loops\n:::", "prose/own.md:5: a condition is ':::{if} {role}`argument`'"),
        (":::{include} nowhere", "prose/own.md:5: there is no prose/parts/nowhere.md"),
        ("two\nlines and {eq}`(0)`", "prose/own.md:6: no equation is called '(0)'"),
    ],
)
def test_what_is_unknown_is_told_with_its_place(reads: Reads, line: str, says: str) -> None:
    with pytest.raises(NarrativeError, match=re.escape(says)):
        reads(f"# One {{#one}}\n\nText.\n\n{line}\n")


FILES = sorted(path.relative_to(narrative.FOLDER).as_posix() for path in narrative.FOLDER.rglob("*.md"))


def test_the_shipped_narratives() -> None:
    told = narratives()
    assert told["generic"] == []
    assert {"(11)", "alpha_mean", "pairs", "beta"} <= set(told["soft_impact"])


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_narrative_names_tables_figures_and_symbols_of_its_workbook(name: str) -> None:
    workbook = find_workbook(name, Path())
    text = "".join(line.text for line in narrative._lines(workbook.prose))
    assert set(re.findall(r"\{table\}`([^`]*)`", text)) <= {spec.name for spec in workbook.tables}
    assert set(re.findall(r"\{fig\}`([^`]*)`", text)) <= {
        *("referee", cards.RETURNED, cards.RESTITUTIONS, cards.IMPRINTS),
        *(spec.name for spec in workbook.figures),
    }
    assert set(re.findall(r"\{sym\}`([^`]*)`", text)) <= set(workbook.ledger().vocabulary) | {
        column.name for column in workbook.sheet(frozenset(one.name for one in workbook.parameters)).columns
    }


@pytest.mark.parametrize("name", FILES)
def test_prose_has_no_markup_of_one_format_and_no_typed_number(name: str) -> None:
    text = (narrative.FOLDER / name).read_text(encoding="utf-8")
    assert set(re.findall(r"\{say\}`(\w+)`", text)) <= set(SAID)
    prose = re.sub(r"(?m)^:::.*$|^# |^> |\{\w+\}`[^`]*`|`[^`]*`|\{#[^}]*\}|\]\(#\w+\)|\*\*", " ", text)
    assert not set(prose) & set("<>&%#_$~^\\{}\"'`")
    numbers = re.findall(r"\d+(?:\.\d+)?(?:/\d+)?", prose)
    assert set(numbers) <= {"1", "3/2"}  # the limits of (4)


def test_every_sentence_that_can_be_named_is_named() -> None:
    text = "".join((narrative.FOLDER / name).read_text(encoding="utf-8") for name in FILES)
    assert set(SAID) == set(re.findall(r"\{say\}`(\w+)`", text))


def test_every_chapter_comes_where_there_is_something_to_tell(report: Report) -> None:
    said = Said(Material(report), ())
    names = [section.name for section in sections("generic", said)]
    assert {
        "result",
        "values",
        "published",
        "equations",
        "derivations",
        "errata",
        "reproduce",
        "uncertainty",
    } == set(names)
    bare = replace(report, comparisons=(), errata=(), engines=(), proofs=())
    assert "published" not in [section.name for section in sections("generic", Said(Material(bare), ()))]
