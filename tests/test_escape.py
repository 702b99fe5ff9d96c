"""Foreign text survives both formats as text."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import html5lib
import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopsheet.report.document.parts import slug
from loopsheet.report.views.escape import html, tex, visible

HOSTILE = "<script>alert(1)</script> & 50% \\input{/etc/passwd} $x_1$ ☃"


@given(st.text())
def test_any_text_survives_as_text_and_as_an_attribute(text: str) -> None:
    page = html5lib.parse(f'<!DOCTYPE html><title>t</title><p title="{html(text)}">{html(text)}</p>')
    (paragraph,) = page.iter("{http://www.w3.org/1999/xhtml}p")
    assert paragraph.text or visible(text) == ""
    assert "".join(paragraph.itertext()) == visible(text)
    assert paragraph.get("title") == visible(text)
    assert not list(paragraph)


@given(st.text(st.characters(exclude_categories=("Cc", "Cs", "Cn", "Zl", "Zp", "Cf"))))
def test_ordinary_text_is_not_changed(text: str) -> None:
    assert visible(text) == text


@pytest.mark.parametrize(
    ("text", "seen"),
    [
        ("a\x00b", "a[U+0000]b"),
        ("a\x1b[2J", "a[U+001B][2J"),
        ("\u202eabc", "[U+202E]abc"),
        ("\ud800", "[U+D800]"),
        ("a\r\nb\tc", "a b c"),
    ],
)
def test_what_no_page_can_carry_is_seen(text: str, seen: str) -> None:
    assert visible(text) == seen


def test_markup_is_escaped_once_and_only_markup_is_trusted() -> None:
    assert html(html("<b>")) == "&lt;b&gt;"
    assert tex(tex("50 %")) == r"50 \%"


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        ("50 % & #1 $x_1$ {a}", r"50 \% \& \#1 \$x\_1\$ \{a\}"),
        (r"\input", r"\textbackslash{}input"),
        ("~^", r"\textasciitilde{}\textasciicircum{}"),
        ("<|>", r"\textless{}\textbar{}\textgreater{}"),
        ("--", "-{}-{}"),
        ("--,,,a, b-c,", "-{}-,{},{},a, b-c,{}"),
        ("\u202f,", r"\,{},{}"),
        ("Ștefan Müller", "Ștefan Müller"),
        ("e\u0301", "é"),
        ("ﬁ", "fi"),
        ("α", r"\texorpdfstring{\ensuremath{\alpha}}{alpha}"),
        ("☃ Ж", "{}[U+2603] [U+0416]"),
        ("[12] a*", "{}[12] a*"),
        ("*", "{}*"),
    ],
)
def test_latex(text: str, latex: str) -> None:
    assert tex(text) == latex


@given(st.text())
def test_latex_gets_no_character_that_could_act(text: str) -> None:
    # Without what is escaped on purpose, only what T1 prints is left.
    plain = tex(text)
    import re

    left = re.sub(r"\\(?:[A-Za-z]+|[{}$&#_%,])|[{}~^_]", "", plain)
    assert not set(left) & set("\\$&#%~")
    assert "\n" not in plain


@pytest.mark.parametrize("text", ["(12a)", "x_m[1-2]", "", "<a href='x'>", "☃"])
def test_identifiers_are_plain(text: str) -> None:
    import re

    assert re.fullmatch(r"[A-Za-z0-9_.-]+", slug(text))


def test_every_printable_character_compiles(tmp_path: Path, require: Callable[..., str]) -> None:
    pdflatex = require("pdflatex")
    everything = "".join(map(chr, [*range(0x20, 0x600), *range(0x2000, 0x2300)])) + HOSTILE
    lines = "\n\n".join(tex(everything[place : place + 40]) for place in range(0, len(everything), 40))
    (tmp_path / "t.tex").write_text(
        "\\documentclass{article}\\usepackage[T1]{fontenc}\\usepackage[utf8]{inputenc}"
        "\\usepackage{textcomp,lmodern,amsmath,amssymb}\\usepackage[unicode]{hyperref}"
        f"\\hypersetup{{pdftitle={{{tex(HOSTILE)}}}}}\\begin{{document}}\n{lines}\n\\end{{document}}\n",
        encoding="utf-8",
    )
    command = [pdflatex, "-no-shell-escape", "-halt-on-error", "-interaction=nonstopmode", "t.tex"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False, timeout=120)
    log = (tmp_path / "t.log").read_text(encoding="utf-8", errors="replace")
    assert run.returncode == 0, log[-2000:]
    assert "Missing character" not in log
