"""The article: it compiles without complaint, and what is foreign stays text."""

import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from drawn_files import pdf_of
from made_files import COMPLAINTS, log_of_latex, without_a_root

from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import latex, pdf

HOSTILE = "<script>alert(1)</script> & 50% \\input{/etc/passwd} $x_1$ ☃ Șα"


@pytest.fixture(scope="module")
def article(report: Report) -> str:
    return latex.render(report, [figure.name for figure in report.workbook.figures])


def _environments(text: str) -> list[str]:
    return re.findall(r"\\(begin|end)\{(\w+\*?)\}", text)  # type: ignore[return-value]


def test_environments_are_nested(article: str) -> None:
    open_ones: list[str] = []
    for kind, name in _environments(article):
        if kind == "begin":
            open_ones.append(name)
        else:
            assert open_ones.pop() == name
    assert not open_ones


def test_every_reference_has_one_label(article: str) -> None:
    labels = re.findall(r"\\label\{([^}]*)\}", article)
    assert len(labels) == len(set(labels))
    references = re.findall(r"\\(?:ref\{|hyperref\[)([^}\]]*)", article)
    assert references
    assert set(references) <= set(labels)


def test_equations_carry_the_numbers_of_the_paper(article: str) -> None:
    tags = re.findall(r"\\tag\*\{([^}]*)\}", article)
    assert [tag for tag in tags if "L" not in tag and len(tag) < 5] != []
    for number in ("(3)", "(11)", "(12a)", "(12e)", "(L21)"):
        assert tags.count(number) == 1


def test_numbers_come_from_the_report(article: str) -> None:
    assert r"$\bar{\alpha}$ = \num{1.3026}" in article
    assert "1–2 & 1.258" in article
    assert "2 & 2.940 & 0.512 & 29.7" in article
    assert r"\num{1.019e9}~\unit{N/m^{\alpha_{\log}}}" in article
    assert "1.234 & 1.258" in article


def test_a_claim_says_what_it_finally_rests_on(article: str) -> None:
    said = [" ".join(found.split()) for found in re.findall(r"Rests on: (.*?)\.\n", article)]
    assert r"\ref{eq:3}; theorem of kinetic energy, compression" in said
    assert r"\ref{eq:3}" in said
    assert "nothing, it is an identity" in said


def test_the_same_bytes_are_asked_for(article: str) -> None:
    for primitive in (r"\pdfinfoomitdate=1", r"\pdftrailerid{}", r"\pdfsuppressptexinfo=-1"):
        assert primitive in article
    assert r"\today" not in article


def test_a_figure_that_is_not_there_is_not_included(report: Report) -> None:
    assert r"\includegraphics" not in latex.render(report, [])


def test_what_is_foreign_is_escaped(report: Report) -> None:
    text = latex.render(replace(report, title=HOSTILE), [])
    assert r"\textbackslash{}input\{/etc/passwd\} \$x\_1\$ [U+2603]" in text
    assert r"\input{" not in text


def test_the_paper_compiles_without_complaint(
    report: Report, tmp_path: Path, require: Callable[..., str]
) -> None:
    require("latexmk")
    hostile = replace(report, title=HOSTILE)
    names = [figure.name for figure in report.workbook.figures]
    (tmp_path / "figures").mkdir()
    for name in names:
        (tmp_path / "figures" / f"{name}.pdf").write_bytes(pdf_of(report, name))
    (tmp_path / "report.tex").write_text(latex.render(hostile, names), encoding="utf-8")
    pdf.compile(tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["figures", "report.pdf", "report.tex"]
    first = (tmp_path / "report.pdf").read_bytes()
    (tmp_path / "report.pdf").unlink()
    pdf.compile(tmp_path)
    assert (tmp_path / "report.pdf").read_bytes() == first

    log = log_of_latex(tmp_path)
    assert not re.search(COMPLAINTS, log, re.MULTILINE)
    pypdf = pytest.importorskip("pypdf")
    document = pypdf.PdfReader(tmp_path / "report.pdf")
    assert document.metadata.title == HOSTILE.replace("☃", "[U+2603]").replace("α", "alpha")
    assert document.metadata.creation_date is None
    text = " ".join(page.extract_text() for page in document.pages)
    assert "alert(1)" in text


def test_missing_tex_is_told_with_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(pdf.TexMissing, match=r"latexmk.*not installed"):
        pdf.compile(tmp_path)


def test_a_failure_is_told_with_the_lines_of_the_log(tmp_path: Path, require: Callable[..., str]) -> None:
    require("latexmk")
    (tmp_path / "report.tex").write_text("\\documentclass{article}\\begin{document}\\nothing\\end{document}")
    with pytest.raises(pdf.TexFailed, match="Undefined control sequence"):
        pdf.compile(tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["report.tex"]


@pytest.mark.parametrize("file", ["/etc/passwd", "../secret.tex"])
def test_tex_reads_nothing_outside_its_folder(file: str, tmp_path: Path, require: Callable[..., str]) -> None:
    require("latexmk")
    folder = tmp_path / "report"
    folder.mkdir()
    (tmp_path / "secret.tex").write_text("secret")
    (folder / "report.tex").write_text(
        f"\\documentclass{{article}}\\begin{{document}}\\input{{{file}}}\\end{{document}}"
    )
    with pytest.raises(pdf.TexFailed):
        pdf.compile(folder)


def test_much_that_is_said_of_a_result_is_broken_into_lines(
    tmp_path: Path, require: Callable[..., str]
) -> None:
    require("pdflatex")
    article = latex.render(Study(without_a_root(tmp_path)).computed, [])
    first = article.partition(r"\end{abstract}")[0] + r"\end{abstract}\end{document}"
    assert "; over 9 of 10 pairs" in first
    (tmp_path / "report.tex").write_text(first, encoding="utf-8")
    assert not re.search(r"^!|Overfull", log_of_latex(tmp_path), re.MULTILINE)


def test_no_heading_stands_alone_at_the_foot_of_a_page(
    article: str, tmp_path: Path, require: Callable[..., str]
) -> None:
    """Wherever it falls, its first claim or the first rows of its table follow."""
    require("pdflatex")
    require("pdftotext")
    preamble, body = article.split(r"\begin{document}")
    rest = body.partition(r"\section{Derivations}")[2]
    first = re.match(r"(?s).*?\\end\{(align\*?|equation\*?|gather\*?)\}", rest)
    assert first is not None
    claim = re.sub(r"\\label{.*?}", "", first[0])
    table = r"\begin{longtable}[l]{l}\caption*{What} \\ head\endfirsthead first row \\ second\end{longtable}"
    pages = (
        rf"\newpage top\vspace*{{{height}pt}}\section{{Derivations}}{below}"
        for below in (claim, table)
        for height in range(540, 680, 10)
    )
    text = "\n\n".join([preamble, r"\begin{document}", *pages, r"\end{document}"])
    (tmp_path / "report.tex").write_text(text, encoding="utf-8")
    assert not re.search(r"^!", log_of_latex(tmp_path), re.MULTILINE)
    subprocess.run(["pdftotext", "report.pdf", "t.txt"], cwd=tmp_path, check=True, timeout=60)
    for page in (tmp_path / "t.txt").read_text(encoding="utf-8").split("\f"):
        assert not re.search(r"Derivations\s+\d*\s*$", page)


def test_a_page_on_which_a_long_table_ends_is_no_longer_than_others(
    article: str, tmp_path: Path, require: Callable[..., str]
) -> None:
    """With a float at its top and another behind the table, what came then ran off the page."""
    require("pdflatex")
    preamble = article.partition(r"\begin{document}")[0]
    above = r"\begin{figure}[t]\rule{1pt}{200pt}\end{figure} text \begin{longtable}[l]{l}"
    below = r"\end{longtable}\begin{figure}[!h]\rule{1pt}{30pt}\end{figure}"
    below += "\n\na line\n\n" * 60 + r"\clearpage"
    pages = [above + r"row \\" * rows + below for rows in (4, 40, 90)]
    text = "\n".join([preamble, r"\begin{document}", *pages, r"\end{document}"])
    (tmp_path / "report.tex").write_text(text, encoding="utf-8")
    assert not re.search(r"^!|Overfull \\vbox", log_of_latex(tmp_path), re.MULTILINE)
