"""The chapter of cards for simulation codes: what a folder asks for, in every view."""

import html
import io
import json
import re
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest
from made_files import COMPLAINTS, log_of_latex

from loopsheet.report.cards import asked_for
from loopsheet.report.cli import main
from loopsheet.report.impacts.codes import CODES
from loopsheet.report.impacts.damping import number_by, returned
from loopsheet.report.messages.errors import InputError
from loopsheet.report.result import card_words as words
from loopsheet.report.result.card import Cards
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study

TOML = """\
title = "A ball"
workbook = "soft_impact"
[parameters]
ball_diameter = "12.7 mm"
ball_density = "7800 kg/m^3"
[measurements]
file = "measurements.csv"
"""
TABLE = """\
test,v [m/s],e [1],x_p [um]
1,2.334,0.530,23.5
2,2.940,0.512,29.7
3,4.089,0.479,41.6
"""
CARDS = '[cards]\ncodes = ["lammps", "exudyn", "drake"]\nnu = "0.29"\nspeed = "3 m/s"\n'


def folder_of(path: Path, toml: str = TOML + CARDS, table: str = TABLE) -> Path:
    path.mkdir(exist_ok=True)
    (path / "report.toml").write_text(toml, encoding="utf-8")
    (path / "measurements.csv").write_text(table, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = folder_of(tmp_path_factory.mktemp("cards") / "own")
    assert main(["build", str(folder), "--to", "html,latex,xlsx"]) == 0
    return folder / "out"


@pytest.fixture(scope="module")
def with_cards(built: Path) -> Report:
    return Study(built.parent).computed


def plain(markup: str) -> str:
    return " ".join(html.unescape(re.sub(r"<[^>]*>", " ", markup)).split())


def sheet_texts(book: Path, name: str) -> list[list[str]]:
    """The cells of a worksheet as text, row by row."""
    space = {"s": "http://schemas.openxmlformats.org/spreadsheetml/2006/main"}
    with zipfile.ZipFile(io.BytesIO(book.read_bytes())) as parts:
        names = re.findall(r'<sheet name="([^"]*)"', parts.read("xl/workbook.xml").decode())
        shared = ElementTree.fromstring(parts.read("xl/sharedStrings.xml"))
        strings = ["".join(t.text or "" for t in each.iterfind(".//s:t", space)) for each in shared]
        root = ElementTree.fromstring(parts.read(f"xl/worksheets/sheet{names.index(name) + 1}.xml"))
    rows = []
    for row in root.iterfind(".//s:row", space):
        cells = [(cell.get("t"), cell.findtext("s:v", "", space)) for cell in row]
        rows.append([strings[int(value)] if kind == "s" else value for kind, value in cells if value])
    return rows


def test_every_view_has_the_numbers_that_the_command_prints(
    built: Path, with_cards: Report, capsys: pytest.CaptureFixture[str]
) -> None:
    page = plain((built / "report.html").read_text(encoding="utf-8").partition("id=cards ")[2])
    article = re.sub(r"\\_", "_", (built / "report.tex").read_text(encoding="utf-8"))
    book = sheet_texts(built / "report.xlsx", "cards")
    for card in with_cards.cards().made:
        options = ["--nu", "0.29"] if card.name == "lammps" else []
        asked = ["card", str(built.parent), "--for", card.name, "--speed", "3 m/s", *options]
        assert main(asked) == 0
        told = capsys.readouterr().out
        for line in [list(words.TYPED), *words.typed(card), *list(words.rows(card))[1:]]:
            assert all(text in told for text in line)
            assert " ".join(line) in page
            # LaTeX writes signs as commands
            assert all(part in article for text in line for part in re.split(r"[^\w. ]+", text))
        for name, value, *_ in words.typed(card):
            assert any(row[0] == name and float(row[1]) == float(value) for row in book if len(row) > 1)
        for source in card.sources:
            assert source in told
            assert source in page
            assert ["source: " + source] in book


def test_the_article_compiles_without_overfull_boxes(tmp_path: Path, require: Callable[..., str]) -> None:
    require("pdflatex")
    toml = f"{TOML}[cards]\ncodes = {json.dumps([*CODES])}\n"
    folder = folder_of(tmp_path / "own", toml)
    assert main(["build", str(folder), "--to", "latex"]) == 0
    log = log_of_latex(folder / "out")
    assert not re.search(COMPLAINTS, log, re.MULTILINE)


def test_without_the_section_nothing_is_there(report: Report, issued: Path) -> None:
    assert report.cards() == Cards()
    assert "id=cards" not in (issued / "out" / "report.html").read_text(encoding="utf-8")
    assert "\\label{sec:cards}" not in (issued / "out" / "report.tex").read_text(encoding="utf-8")


def test_the_pictures_stand_in_the_chapter(built: Path) -> None:
    chapter = (built / "report.html").read_text(encoding="utf-8").partition("id=cards ")[2]
    for name in ("cards_returned", "cards_restitutions", "cards_imprints"):
        assert f"id=figure-{name}>" in chapter
        assert (built / "figures" / f"{name}.svg").is_file()


def test_what_authors_prescribe_is_in_the_cards(with_cards: Report) -> None:
    laws = with_cards.cards().laws
    assert len(laws) == 7
    (half,) = (each for each in laws["Hunt and Crossley 1975"] if each.typed == 0.5)
    assert half.returned == returned(number_by("hunt_crossley", 0.5, 1.5))


def test_measured_points_have_their_uncertainties(with_cards: Report) -> None:
    """The digits as printed: half a unit of the last one, rectangular."""
    first = with_cards.cards().measured[0]
    assert (first.speed, first.e, first.imprint) == (2.334, 0.53, 23.5e-6)
    assert first.u_e == pytest.approx(0.0005 / 3**0.5, rel=1e-12)
    assert first.u_imprint == pytest.approx(0.05e-6 / 3**0.5, rel=1e-12)


def test_what_cannot_be_returned_is_told_in_the_report(tmp_path: Path) -> None:
    """Without loss to speak of there is no damping to find for it."""
    table = TABLE.replace("0.530", "0.9999").replace("0.512", "0.9998").replace("0.479", "0.9997")
    study = Study(folder_of(tmp_path / "own", TOML + '[cards]\ncodes = ["exudyn", "chrono"]\n', table))
    (refused, *_) = study.computed.cards().refused
    assert refused.reason


def test_all_codes_can_be_asked_for(tmp_path: Path) -> None:
    toml = f"{TOML}[cards]\ncodes = {json.dumps([*CODES])}\n"
    cards = Study(folder_of(tmp_path / "own", toml)).computed.cards()
    assert [card.name for card in cards.made] == [*CODES]
    assert all(abs(card.returned.e - 0.512) < 1e-8 for card in cards.made)


@pytest.mark.parametrize(
    ("section", "code", "place", "said"),
    [
        ('codes = ["lammp"]', "LS604", '["lammp"]', "unknown code 'lammp'"),
        ('codes = ["drake"]\nE = "210 GPa"', "LS614", '"210 GPa"', "E says nothing to drake"),
        ('codes = ["drake", "simbody"]\nnu = "0.3"', "LS614", '"0.3"', "nu says nothing to drake or simbody"),
        ('codes = ["drake"]\nspeed = "9 m/s"', "LS614", '"9 m/s"', "speed 9 m/s is not among the measured"),
        ('codes = ["drake"]\nspeed = "9 mm"', "LS422", "mm", "speed is in 'mm', which does not"),
        ('codes = ["lammps"]\nnu = "0.51"', "LS406", "0.51", "0.5"),
        ('codes = "lammps"', "LS205", '"lammps"', "a list of names"),
        ('code = ["lammps"]', "LS203", "code", "unknown key 'code'"),
        ('E = "210 GPa"', "LS204", "cards]", "codes"),
    ],
)
def test_what_does_not_fit_is_told_where_it_stands(
    tmp_path: Path, section: str, code: str, place: str, said: str
) -> None:
    folder = folder_of(tmp_path / "own", f"{TOML}[cards]\n{section}\n")
    with pytest.raises(InputError) as found:
        _ = Study(folder).computed
    (diagnostic,) = found.value.diagnostics
    assert diagnostic.code == code
    assert said in str(found.value)
    at = diagnostic.at
    assert at is not None
    assert at.source is not None
    assert at.source[(at.column or 1) - 1 :].startswith(place)


def test_a_radius_that_nobody_knows_is_asked_for(tmp_path: Path) -> None:
    toml = TOML.replace('ball_diameter = "12.7 mm"\nball_density = "7800 kg/m^3"', 'ball_mass = "8.366 g"')
    with pytest.raises(InputError, match="lammps wants the radius of the ball, which the folder"):
        _ = Study(folder_of(tmp_path / "own", f'{toml}[cards]\ncodes = ["lammps"]\n')).computed
    again = Study(folder_of(tmp_path / "own", f'{toml}[cards]\ncodes = ["lammps"]\nR = "6.35 mm"\n'))
    assert again.computed.cards().made


def test_a_folder_without_impacts_has_no_cards(tmp_path: Path) -> None:
    folder = tmp_path / "kepler"
    shutil.copytree(Path(__file__).parent.parent / "data" / "kepler", folder)
    with (folder / "report.toml").open("a", encoding="utf-8") as toml:
        toml.write('\n[cards]\ncodes = ["drake"]\n')
    with pytest.raises(InputError, match="it has no v in m/s and no m_red in kg"):
        _ = Study(folder).computed


def test_a_card_that_was_kept_is_the_same(with_cards: Report) -> None:
    assert repr(asked_for(with_cards)()) == repr(with_cards.cards())
