"""Firefox and WebKitGTK in the place of playwright's Chromium: as much of its page as is used of it here.

Both are the browsers that Debian ships, unchanged. They speak W3C WebDriver: WebKit's driver over HTTP, and
Firefox what its own driver translates that to (Marionette: the same commands by name, each with its length in
front).
"""

from __future__ import annotations

import http.client
import json
import os
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

Call = Callable[..., Any]
"""A command of WebDriver's by its name, with its parameters."""

WAIT = 60.0
"""Seconds that a browser may take for anything."""


class WebDriverError(Exception):
    """What the browser answered instead."""


def until(found: Callable[[], Any], what: str, seconds: float = WAIT) -> Any:
    """Wait for something that is true."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if result := found():
            return result
        time.sleep(0.02)
    raise TimeoutError(f"waited for {what}")


@contextmanager
def _running(command: list[str], folder: Path, **settings: str) -> Iterator[None]:
    """A program with a home of its own, where it leaves what it says; ended in the end."""
    with (folder / f"{Path(command[0]).name}.log").open("wb") as log:
        process = subprocess.Popen(
            command, stdout=log, stderr=log, cwd=folder, env={**os.environ, "HOME": str(folder), **settings}
        )
        try:
            yield
        finally:
            process.terminate()
            process.wait(WAIT)


# --- Firefox ------------------------------------------------------------------------------------------------


@contextmanager
def firefox(program: str, folder: Path, downloads: Path) -> Iterator[Call]:
    """A Firefox without a window, with a new profile."""
    settings = {
        "marionette.port": 0,
        "browser.download.folderList": 2,
        "browser.download.dir": str(downloads),
        "browser.download.always_ask_before_handling_new_types": False,
    }
    lines = [f"user_pref({json.dumps(name)}, {json.dumps(value)});\n" for name, value in settings.items()]
    (folder / "user.js").write_text("".join(lines), encoding="utf-8")
    said = folder / "MarionetteActivePort"
    with _running([program, "--headless", "--marionette", "--no-remote", "--profile", str(folder)], folder):
        port = int(until(lambda: said.exists() and said.read_text(encoding="ascii"), "Firefox"))
        with (
            socket.create_connection(("127.0.0.1", port), WAIT) as connection,
            connection.makefile("rb") as answers,
        ):
            call = _marionette(connection, answers)
            call("NewSession", capabilities={})
            yield call


def _marionette(connection: socket.socket, answers: BinaryIO) -> Call:
    number = 0

    def receive() -> Any:
        length = b""
        while (byte := answers.read(1)) != b":":
            assert byte, "Firefox has gone"
            length += byte
        return json.loads(answers.read(int(length)))

    def call(name: str, /, **parameters: Any) -> Any:
        nonlocal number
        number += 1
        text = json.dumps([0, number, f"WebDriver:{name}", parameters]).encode()
        connection.sendall(b"%d:%s" % (len(text), text))
        _, _, error, result = receive()
        if error:
            raise WebDriverError(f"{name}: {error['error']}: {error['message']}")
        return result.get("value", result) if isinstance(result, dict) else result

    receive()  # who it is
    return call


# --- WebKit -------------------------------------------------------------------------------------------------

_PATHS = {
    "Navigate": ("POST", "/url"),
    "ExecuteScript": ("POST", "/execute/sync"),
    "FindElement": ("POST", "/element"),
    "ElementClick": ("POST", "/element/{id}/click"),
    "PerformActions": ("POST", "/actions"),
    "NewWindow": ("POST", "/window/new"),
    "GetWindowHandle": ("GET", "/window"),
    "SwitchToWindow": ("POST", "/window"),
    "CloseWindow": ("DELETE", "/window"),
}


@contextmanager
def webkit(program: str, screen: str, folder: Path, downloads: Path) -> Iterator[Call]:
    """WebKit's own small browser, on a screen that nobody sees."""
    (folder / ".config").mkdir()
    (folder / ".config" / "user-dirs.dirs").write_text(f'XDG_DOWNLOAD_DIR="{downloads}"\n', encoding="utf-8")
    with ExitStack() as running, socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
        free.close()
        display = running.enter_context(_screen(screen, folder))
        # Without a graphics card composing layers costs more than all else, also of a page at rest.
        settings = {"DISPLAY": display, "WEBKIT_DISABLE_COMPOSITING_MODE": "1"}
        running.enter_context(_running([program, f"--port={port}"], folder, **settings))
        until(lambda: _answers(port), "WebKitWebDriver")
        session = _ask(port, "POST", "/session", {"capabilities": {}})["sessionId"]

        def call(name: str, /, **parameters: Any) -> Any:
            method, path = _PATHS[name]
            sent = parameters if method == "POST" else None
            return _ask(port, method, f"/session/{session}{path.format(**parameters)}", sent)

        yield call
        _ask(port, "DELETE", f"/session/{session}", None)


@contextmanager
def _screen(program: str, folder: Path) -> Iterator[str]:
    said = folder / "display"
    with said.open("wb") as number:
        command = [program, "-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"]
        process = subprocess.Popen(command, stdout=number, stderr=subprocess.DEVNULL)
    try:
        yield f":{until(lambda: said.read_text(encoding='ascii').strip(), 'Xvfb')}"
    finally:
        process.terminate()
        process.wait(WAIT)


def _answers(port: int) -> bool:
    try:
        return bool(_ask(port, "GET", "/status", None)["ready"])
    except OSError:
        return False


def _ask(port: int, method: str, path: str, sent: Any) -> Any:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=WAIT)
    try:
        connection.request(method, path, None if sent is None else json.dumps(sent))
        value = json.loads(connection.getresponse().read())["value"]
    finally:
        connection.close()
    if isinstance(value, dict) and "error" in value:
        raise WebDriverError(f"{path}: {value['error']}: {value['message']}")
    return value


# --- what playwright calls a page ---------------------------------------------------------------------------

_KEYS = {
    "Backspace": "\ue003", "Tab": "\ue004", "Enter": "\ue006", "Shift": "\ue008", "Control": "\ue009",
    "Escape": "\ue00c", "End": "\ue010", "Home": "\ue011", "ArrowLeft": "\ue012", "ArrowUp": "\ue013",
    "ArrowRight": "\ue014", "ArrowDown": "\ue015", "Delete": "\ue017", "F2": "\ue032",
}  # fmt: skip
_CALL = "const what = {}; return typeof what === 'function' ? what(...arguments) : what;"
_ALL = "(selector) => document.querySelectorAll(selector)"


@dataclass(frozen=True)
class Keyboard:
    call: Call

    def press(self, chord: str) -> None:
        """A key with those that are held meanwhile: ``Control+Shift+z``."""
        keys = [_KEYS.get(key, key) for key in chord.split("+")]
        self._act([("keyDown", key) for key in keys] + [("keyUp", key) for key in reversed(keys)])

    def type(self, text: str) -> None:
        self._act([(kind, letter) for letter in text for kind in ("keyDown", "keyUp")])

    def _act(self, actions: list[tuple[str, str]]) -> None:
        done = [{"type": kind, "value": key} for kind, key in actions]
        self.call("PerformActions", actions=[{"type": "key", "id": "keyboard", "actions": done}])


@dataclass(frozen=True)
class Locator:
    """The first element of a selector."""

    page: Page
    selector: str

    def ask(self, script: str) -> Any:
        return self.page.evaluate(
            f"(selector) => {{ const one = document.querySelector(selector); {script} }}", self.selector
        )

    def click(self) -> None:
        """Click it; what a busy WebKit took for a press alone is done again, as its reader does."""
        for _ in range(4):
            self.ask(
                "one.scrollIntoView({ block: 'center' }); self.clicked = false;"
                "one.addEventListener('click', () => (self.clicked = true), { once: true, capture: true });"
            )
            until(self._stands_still, f"{self.selector} to stand still")
            found = self.page.call("FindElement", using="css selector", value=self.selector)
            (element,) = found.values()
            self.page.call("ElementClick", id=element)
            if self.page.evaluate("() => self.clicked") is not False:
                return

    def _stands_still(self) -> bool:
        """Whether it stays where it is: figures that are drawn later move what stands below them."""
        where = "return JSON.stringify(one.getBoundingClientRect());"
        before = self.ask(where)
        time.sleep(0.05)
        return bool(self.ask(where) == before)

    def inner_text(self) -> str:
        found: str = self.ask("return one.innerText;")
        return found

    def input_value(self) -> str:
        found: str = self.ask("return one.value;")
        return found

    def is_disabled(self) -> bool:
        found: bool = self.ask("return one.disabled;")
        return found


@dataclass(frozen=True)
class Page:
    """A window of one of these browsers."""

    call: Call
    home: str
    """The window that the browser began with, which stays."""

    @classmethod
    def new(cls, call: Call) -> Page:
        home = call("GetWindowHandle")
        call("SwitchToWindow", handle=call("NewWindow", type="window")["handle"])
        return cls(call, home)

    def close(self) -> None:
        """No page works on behind the next one."""
        self.call("CloseWindow")
        self.call("SwitchToWindow", handle=self.home)

    @property
    def keyboard(self) -> Keyboard:
        return Keyboard(self.call)

    def goto(self, url: str) -> None:
        self.call("Navigate", url=url)

    def evaluate(self, script: str, argument: Any = None) -> Any:
        """What a function gives for an argument, or what an expression is."""
        return self.call("ExecuteScript", script=_CALL.format(script), args=[argument])

    def locator(self, selector: str) -> Locator:
        return Locator(self, selector)
