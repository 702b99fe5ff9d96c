"""One Chromium for all tests of the page; every test gets a page of its own that must not report an error."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import driving
import pytest
from playwright.sync_api import Browser, Page, ViewportSize, sync_playwright

HERE = Path(__file__).parent

Open = Callable[..., driving.Live]


SIZE: ViewportSize = {"width": 1280, "height": 720}


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


Windows = dict[str, list[Page]]

# What a page asks of a worker after an edit takes a second: that begins when a test waits for it.
_LATER = """(() => {
  const Real = self.Worker, waiting = new Set();
  let now = false;
  self.Worker = class {
    constructor(...how) { this.how = how; waiting.add(this); }
    postMessage(message) { this.message = message; if (now) this.begin(); }
    begin() {
      waiting.delete(this);
      const { onmessage, onerror } = this;
      this.real = Object.assign(new Real(...this.how), { onmessage, onerror });
      this.real.postMessage(this.message);
    }
    terminate() { waiting.delete(this); this.real?.terminate(); }
  };
  self.beginDraws = () => { now = true; waiting.forEach((one) => one.message && one.begin()); };
})()"""


@pytest.fixture
def draws_at_once() -> bool:
    """Whether workers begin as they do for users, whoever waits for what they find."""
    return False


@pytest.fixture(scope="session")
def windows() -> Windows:
    """Windows that were used and are as new, by their options: one is as long in coming as the page."""
    return {}


@pytest.fixture
def open_page(browser: Browser, issued: Path, windows: Windows, draws_at_once: bool) -> Iterator[Open]:
    """Open a file, the page of the paper without one, in a browser that has no network.

    With `own=True` in a window that is not used again; `at` is how the link ends.
    """
    opened: list[driving.Live] = []
    again: list[tuple[str, Page]] = []

    def open_it(
        path: Path | None = None,
        own: bool = False,
        at: str = "",
        viewport: ViewportSize = SIZE,
        **options: Any,
    ) -> driving.Live:
        kind = repr((draws_at_once, *sorted(options.items())))
        free = [] if own else windows.setdefault(kind, [])
        if free:
            page = free.pop()
        else:
            page = browser.new_context(offline=True, **options).new_page()
            if not draws_at_once:
                page.add_init_script(_LATER)
        if not own:
            again.append((kind, page))
        page.set_viewport_size(viewport)
        live = driving.Live(page, path or issued)
        opened.append(live)
        live.load(at)
        return live

    yield open_it
    heard = [error for live in opened for error in live.errors]
    for kind, page in again:
        if not page.is_closed():
            _forget(page)
            windows[kind].append(page)
    used = {page for pages in windows.values() for page in pages}
    for live in opened:
        if live.page not in used:
            live.page.context.close()
    assert heard == []


def _forget(page: Page) -> None:
    """Leave the page of a window, other windows, and all that the browser keeps of them."""
    for other in page.context.pages:
        if other != page:
            other.close()
    page.goto("about:blank")
    page.emulate_media(media="null")
    what = {"origin": "file://", "storageTypes": "all"}
    page.context.new_cdp_session(page).send("Storage.clearDataForOrigin", what)


@pytest.fixture
def live(open_page: Open) -> driving.Live:
    return open_page()


@pytest.fixture(scope="session")
def packages(npm_packages: Callable[[Path], Path]) -> Path:
    """axe-core and html-validate."""
    return npm_packages(HERE)
