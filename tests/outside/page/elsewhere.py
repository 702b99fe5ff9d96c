"""The live page in a browser that playwright does not drive."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import webdriver
from driving import Live

_LISTEN = """{
  const heard = window.heard = [], say = console.error;
  addEventListener("error", (event) => heard.push(event.message));
  addEventListener("unhandledrejection", (event) => heard.push(String(event.reason)));
  addEventListener("securitypolicyviolation", (event) => heard.push(event.effectiveDirective));
  console.error = (...words) => { heard.push(words.join(" ")); say(...words); };
}"""


_OFFERED = "() => Array.from(document.querySelectorAll('#live-note a[download]'), (one) => one.download)"


def listening(page: str) -> str:
    """The page with a script in front of all others that hears of errors; its policy lets it."""
    own = base64.b64encode(hashlib.sha256(_LISTEN.encode()).digest()).decode()
    allowed = page.replace("script-src ", f"script-src 'sha256-{own}' ", 1)
    return allowed.replace("<title>", f"<script>{_LISTEN}</script><title>", 1)


@dataclass(kw_only=True)
class Elsewhere(Live):
    """A page in another browser: the same hands, and the same eyes."""

    page: webdriver.Page  # type: ignore[assignment]
    folder: Path
    """Where the copy of the page is made that listens."""
    downloads: Path
    """Where the browser puts what it is given to save."""

    def __post_init__(self) -> None:
        """Errors are heard in the page."""

    def load(self) -> None:
        copy = self.folder / self.path.name
        copy.write_text(listening(self.path.read_text(encoding="utf-8")), encoding="utf-8")
        self.page.goto(copy.as_uri())

    def heard(self) -> list[str]:
        found: list[str] = self.page.evaluate("heard")
        return found

    def save(self, folder: Path) -> Path:
        self.click("live-save")
        names = self.page.evaluate(_OFFERED)
        folder.mkdir()
        for name in names:
            self._come(name)
            (self.downloads / name).rename(folder / name)
        return folder

    def _come(self, name: str) -> None:
        """Wait for a file; one that a busy WebKit dropped is asked for as its reader does, by its link."""
        for _ in range(4):
            with suppress(TimeoutError):
                webdriver.until(lambda: self._is_there(name), name, seconds=15)
                return
            self.page.locator(f'#live-note a[download="{name}"]').click()
        webdriver.until(lambda: self._is_there(name), name)

    def _is_there(self, name: str) -> bool:
        path = self.downloads / name
        return path.exists() and path.stat().st_size > 0 and not path.with_name(f"{name}.part").exists()


Open = Callable[[Path], Live]
Find = Callable[..., str]


@contextmanager
def firefox(require: Find, folder: Path) -> Iterator[Open]:
    program = require("firefox-esr", "firefox")
    with webdriver.firefox(program, _new(folder / "home"), _new(folder / "downloads")) as call:
        yield _opening(call, folder)


@contextmanager
def webkit(require: Find, folder: Path) -> Iterator[Open]:
    programs = require("WebKitWebDriver"), require("Xvfb")
    with webdriver.webkit(*programs, _new(folder / "home"), _new(folder / "downloads")) as call:
        yield _opening(call, folder)


BROWSERS = {"Firefox": firefox, "WebKit": webkit}


def _opening(call: webdriver.Call, folder: Path) -> Open:
    """Open pages, each in a window of its own and from a folder of its own, so that none knows another."""

    def open_it(path: Path) -> Live:
        own = _new(folder / f"page{len(list(folder.iterdir()))}")
        live = Elsewhere(page=webdriver.Page.new(call), path=path, folder=own, downloads=folder / "downloads")
        live.load()
        return live

    return open_it


def _new(folder: Path) -> Path:
    folder.mkdir()
    return folder
