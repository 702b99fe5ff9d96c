"""What the pages of docs/ show is what happens: files are written, edits made, commands run, in their order.

A block with a caption is a file, or an edit of one; one of `console` or `pycon` has commands, and what they
print. Other Python runs, and other TOML has keys that there are.
After a wanted change of what is printed, run this file with LOOPSHEET_UPDATE=1 and read the difference.
"""

import code
import contextlib
import doctest
import io
import os
import re
import shlex
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import made
import pytest

import loopsheet
from loopsheet.report.cli import main
from loopsheet.report.files.form import Form
from loopsheet.report.files.manifest import Manifest
from loopsheet.report.files.values import Result
from loopsheet.report.inputs.keys import ANY, TABLES
from loopsheet.report.messages.catalogue import CATALOGUE
from loopsheet.report.verbs import VERBS

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]
BLOCK = re.compile(
    r"^```(?:\{code-block\} )?(\w+)\n(?::caption: ([^\n]+)\n+)?(.*?)^```$", re.MULTILINE | re.DOTALL
)
VERSIONS = re.compile(r"(?<= node )[\d.]+|(?<=LibreOffice )[\d.]+")
"""Of the programs of the machine, which a page tells as somebody has them."""
RUN = ("console", "pycon")


class Session:
    """Somebody who follows a page: where he stands, and what was printed."""

    def __init__(self) -> None:
        self.python = code.InteractiveConsole()

    def shell(self, line: str) -> str:
        """What a command prints, but for its progress."""
        words, printed, told = shlex.split(line, comments=True), io.StringIO(), io.StringIO()
        if words[0] == "cd":
            os.chdir(words[1])
        elif words[0] == "cat":
            printed.write(Path(words[1]).read_text(encoding="utf-8"))
        elif words[0] == "loopsheet":
            with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(told):
                main(words[1:])
        else:
            raise AssertionError(f"a page runs {words[0]}, which a test does not")
        return printed.getvalue() + re.sub(
            r"^(\w+ing|still .*) \.\.\.\n", "", told.getvalue(), flags=re.MULTILINE
        )

    def prompt(self, line: str) -> str:
        """What Python prints."""
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            assert not self.python.push(line), f"{line} goes on"
        return printed.getvalue()


def run(session: Session, kind: str, text: str) -> str:
    """A block with what its commands print now."""
    prompt, answer = (">>> ", session.prompt) if kind == "pycon" else ("$ ", session.shell)
    lines = [line for line in text.splitlines() if line.startswith(prompt)]
    return "".join(f"{line}\n{answer(line.removeprefix(prompt))}" for line in lines)


def write(path: Path, kind: str, text: str) -> None:
    """Make a file, or the edit that a block shows."""
    if kind != "diff":
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return
    lines = text.splitlines(keepends=True)
    old, new = ("".join(line[1:] for line in lines if line[0] in f" {sign}") for sign in "-+")
    before = path.read_text(encoding="utf-8")
    assert before.count(old) == 1, f"{path} does not have once:\n{old}"
    path.write_text(before.replace(old, new), encoding="utf-8")


def unknown(data: Mapping[str, Any], *table: str) -> list[str]:
    """The keys that report.toml does not have."""
    known, found = TABLES.get(table, {ANY: None}), []
    for key, value in data.items():
        name = key if key in known else ANY
        found += [] if name in known else [".".join((*table, key))]
        found += unknown(value, *table, name) if isinstance(value, dict) else []
    return found


def followed(page: str) -> str:
    """A page with all that its commands print now, in the folder where one stands."""
    session = Session()

    def now(block: re.Match[str]) -> str:
        kind, caption, text = block.groups()
        if caption:
            write(Path(caption), kind, text)
        elif kind == "python":
            exec(text, {})
        elif kind == "toml":
            assert not unknown(tomllib.loads(text))
        elif kind in RUN:
            return block[0].replace(text, run(session, kind, text))
        return block[0]

    return BLOCK.sub(now, page)


def different(expected: str, found: str) -> str:
    """Where a page says something else; empty if it says what happens."""
    expected, found = (VERSIONS.sub("0", text) for text in (expected, found))
    checker, example = doctest.OutputChecker(), doctest.Example("", expected)
    same = checker.check_output(expected, found, doctest.ELLIPSIS)
    return "" if same else checker.output_difference(example, found, doctest.REPORT_UDIFF)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_a_page_tells_what_happens(
    page: Path, require: Callable[..., str], tmp_path: Path, chdir: Callable[[Path], None]
) -> None:
    chdir(tmp_path)
    text = page.read_text(encoding="utf-8")
    if "$ loopsheet check\n" in text:
        require("node")
        require("soffice", "libreoffice")
    found = followed(text)
    if os.environ.get("LOOPSHEET_UPDATE"):
        page.write_text(found, encoding="utf-8")
    assert not different(text, found)


def test_the_readme_shows_the_message_of_a_wrong_file(
    tmp_path: Path, chdir: Callable[[Path], None], capsys: pytest.CaptureFixture[str]
) -> None:
    chdir(tmp_path)
    assert main(["new", "my-campaign"]) == 0
    table = Path("my-campaign/measurements.csv")
    title, first, second, *rest = table.read_text(encoding="utf-8").splitlines()
    test, _, *cells = second.split(",")
    table.write_text("\n".join([title, first, ",".join([test, "abc", *cells]), *rest]), encoding="utf-8")
    capsys.readouterr()
    assert main(["check", "my-campaign"]) == 2
    told = capsys.readouterr().err.removesuffix("\n\n1 error\n")
    assert f"```\n{told}\n```\n" in PAGES[0].read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("page", "said"),
    [
        ("```console\n$ loopsheet schema values\n```\n", "$schema"),
        ("```{code-block} text\n:caption: f\na\n```\n```console\n$ cat f\nb\n```\n", "-b"),
        ("```pycon\n>>> 1 + 1\n3\n```\n", "+2"),
    ],
)
def test_a_page_that_tells_something_else_is_seen(
    page: str, said: str, tmp_path: Path, chdir: Callable[[Path], None]
) -> None:
    chdir(tmp_path)
    assert said in different(page, followed(page))


def test_a_key_that_there_is_not_is_seen() -> None:
    assert unknown({"titel": "", "published": {"errata": {"x": ""}, "fre": []}}) == ["titel", "published.fre"]


def test_an_edit_that_fits_nowhere_is_seen(tmp_path: Path) -> None:
    (tmp_path / "f").write_text("a\n", encoding="utf-8")
    with pytest.raises(AssertionError, match="does not have once"):
        write(tmp_path / "f", "diff", "-b\n+c\n")


# ------------------------------------------------------------------------------- what is made of the sources
def test_every_part_that_is_made_is_asked_for_once() -> None:
    asked = [name for page in PAGES for name in made.PLACE.findall(page.read_text(encoding="utf-8"))]
    assert sorted(asked) == sorted(made.MADE)


def test_every_code_has_its_anchor_and_every_command_its_help() -> None:
    errors, commands = made.errors(), made.commands()
    assert [code for code in CATALOGUE if f"({code.lower()})=\n### {code}: " not in errors] == []
    assert errors.count("```text\n") >= 0.95 * len(CATALOGUE)
    assert [verb for verb in VERBS if f"usage: loopsheet {verb} " not in commands] == []


@pytest.mark.parametrize("form", [Result, Manifest])
def test_every_field_of_a_file_stands_in_its_table(form: type[Form]) -> None:
    told = made.MADE["values_json" if form is Result else "manifest_json"]()
    assert [field for field in form.__struct_fields__ if f"| `{field}` |" not in told] == []


@pytest.mark.parametrize("word", [name for name in loopsheet.__all__ if name != "Method"])
def test_every_word_of_a_method_stands_in_the_reference(word: str) -> None:
    page = (DOCS / "reference" / "python.md").read_text(encoding="utf-8")
    kind = "exception" if word[0].isupper() else "function"
    assert f".. auto{kind}:: {word}\n" in page
    assert getattr(loopsheet, word).__doc__
