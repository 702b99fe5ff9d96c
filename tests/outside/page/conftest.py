"""One Chromium for all tests of the page; every test gets a page of its own that must not report an error."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import driving
import pytest
from playwright.sync_api import Browser, sync_playwright

HERE = Path(__file__).parent

Open = Callable[..., driving.Live]


@pytest.fixture(scope="session")
def issued(issued: Path) -> Path:
    """The page of the paper, as `loopsheet build` writes it."""
    return issued / "out" / "report.html"


@pytest.fixture(scope="session")
def browser(require: Callable[..., str]) -> Iterator[Browser]:
    program = require("chromium", "chromium-browser", "google-chrome")
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=program, args=["--no-sandbox", "--disable-gpu"])
        yield found
        found.close()


@pytest.fixture
def open_page(browser: Browser, issued: Path) -> Iterator[Open]:
    """Open a file, the page of the paper without one, in a browser that has no network."""
    opened: list[driving.Live] = []

    def open_it(path: Path | None = None, **options: Any) -> driving.Live:
        context = browser.new_context(offline=True, **options)
        live = driving.Live(context.new_page(), path or issued)
        opened.append(live)
        live.load()
        return live

    yield open_it
    for live in opened:
        live.page.context.close()
    assert [error for live in opened for error in live.errors] == []


@pytest.fixture
def live(open_page: Open) -> driving.Live:
    return open_page()


@pytest.fixture(scope="session")
def packages(npm_packages: Callable[[Path], Path]) -> Path:
    """axe-core and html-validate."""
    return npm_packages(HERE)
