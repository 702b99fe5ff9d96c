"""One Chromium for all tests of the page; every test gets a page of its own that must not report an error."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import driving
import pytest
from playwright.sync_api import Browser, Page, sync_playwright

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


@pytest.fixture(scope="session")
def windows() -> list[Page]:
    """Windows that were used and are as new: to open one takes a browser as long as to load a page."""
    return []


@pytest.fixture
def open_page(browser: Browser, issued: Path, windows: list[Page]) -> Iterator[Open]:
    """Open a file, the page of the paper without one, in a browser that has no network.

    With options, or `own=True`, in a window that is not used again.
    """
    opened: list[driving.Live] = []
    again: list[Page] = []

    def open_it(path: Path | None = None, own: bool = False, **options: Any) -> driving.Live:
        own = own or bool(options)
        new = own or not windows
        page = browser.new_context(offline=True, **options).new_page() if new else windows.pop()
        if not own:
            again.append(page)
        live = driving.Live(page, path or issued)
        opened.append(live)
        live.load()
        return live

    yield open_it
    heard = [error for live in opened for error in live.errors]
    for live in opened:
        if live.page in again and not live.page.is_closed():
            _forget(live.page)
            windows.append(live.page)
        else:
            live.page.context.close()
    assert heard == []


def _forget(page: Page) -> None:
    """Leave the page of a window, other windows, and all that the browser keeps of them."""
    for other in page.context.pages:
        if other != page:
            other.close()
    page.goto("about:blank")
    what = {"origin": "file://", "storageTypes": "all"}
    page.context.new_cdp_session(page).send("Storage.clearDataForOrigin", what)


@pytest.fixture
def live(open_page: Open) -> driving.Live:
    return open_page()


@pytest.fixture(scope="session")
def packages(npm_packages: Callable[[Path], Path]) -> Path:
    """axe-core and html-validate."""
    return npm_packages(HERE)
