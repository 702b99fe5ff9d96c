"""Shows an output folder to browsers of this machine, and tells an open page when there is another report.

Only whoever knows the address can read it: the server listens on the loopback interface, under a random word,
and answers no request that was addressed to another name or comes from another site's page. The report is
served as it is; a page around it, `templates/watch.html`, reloads it and shows what is wrong.
"""

from __future__ import annotations

import base64
import hashlib
import hmac
import json
import re
import secrets
import threading
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, unquote, urlsplit

from ..files.form import load
from ..files.manifest import NAME, Manifest
from .provenance import ROOT

PATIENCE = 20.0
"""Seconds for which a page that asks for news is kept waiting."""

_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".json": "application/json",
    ".pdf": "application/pdf",
    ".svg": "image/svg+xml",
    ".tex": "text/plain; charset=utf-8",
    ".xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
}
_HEADERS = {
    "Cache-Control": "no-store",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",  # the address is the key
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "SAMEORIGIN",
}


class Server:
    """Serves a folder until it is closed.

    `out`: the outputs; what is in no output of ours is served neither.
    """

    def __init__(self, out: Path) -> None:
        self._out = out
        self._word = secrets.token_urlsafe(16)
        self._news: dict[str, Any] = {"number": 0, "error": "", "changed": ""}
        self._changed = threading.Condition()
        self._closed = False
        self._http = _Http(("127.0.0.1", 0), _Handler)
        self._http.owner = self
        self._thread = threading.Thread(target=self._http.serve_forever, args=(0.1,), daemon=True)

    @property
    def host(self) -> str:
        """What a request has to be addressed to."""
        return f"127.0.0.1:{self._http.server_port}"

    @property
    def address(self) -> str:
        """Where a browser finds the report."""
        return f"http://{self.host}/{self._word}/"

    def __enter__(self) -> Server:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self._http.shutdown()
        self._http.server_close()

    def tell(self, error: str = "", changed: str = "") -> None:
        """Tell open pages what is wrong, or that there is another report, and what changed in it."""
        with self._changed:
            number = self._news["number"] + (not error)
            self._news = {"number": number, "error": error, "changed": changed}
            self._changed.notify_all()

    def news(self, known: str) -> bytes:
        """What there is to tell, as soon as it is other than what is known; in JSON."""
        with self._changed:
            self._changed.wait_for(lambda: self._closed or _digest(self._news) != known, PATIENCE)
            return json.dumps({**self._news, "known": _digest(self._news)}).encode()

    def answer(self, target: str) -> tuple[HTTPStatus, str, bytes]:
        """The answer to a request of its own pages: status, type and content."""
        url = urlsplit(target)
        word, _, name = unquote(url.path).removeprefix("/").partition("/")
        if not hmac.compare_digest(word.encode(), self._word.encode()):
            return HTTPStatus.NOT_FOUND, "text/plain", b""
        if name == "":
            return HTTPStatus.OK, _TYPES[".html"], _page()
        if name == "news":
            return HTTPStatus.OK, _TYPES[".json"], self.news(parse_qs(url.query).get("known", [""])[0])
        return self._file(name)

    def _file(self, name: str) -> tuple[HTTPStatus, str, bytes]:
        """A file of the output, which the manifest tells of; no name leads elsewhere."""
        try:
            path = (self._out / name).resolve()
            if name in load(self._out / NAME, Manifest).outputs and path.is_relative_to(self._out.resolve()):
                return HTTPStatus.OK, _TYPES.get(path.suffix, "application/octet-stream"), path.read_bytes()
        except (OSError, ValueError):
            pass  # it is just being built, or gone
        return HTTPStatus.NOT_FOUND, "text/plain", b""


class _Http(ThreadingHTTPServer):
    daemon_threads = True
    owner: Server

    def handle_error(self, *_: object) -> None:
        """Say nothing: a browser closes what it does not need any more."""


class _Handler(BaseHTTPRequestHandler):
    server: _Http
    server_version, sys_version = "loopsheet", ""
    timeout = 60

    def do_GET(self) -> None:
        """Answer what was addressed to us by our own pages."""
        owner = self.server.owner
        if self.headers.get("Host") != owner.host:
            status, kind, content = HTTPStatus.MISDIRECTED_REQUEST, "text/plain", b""
        elif self.headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin"):
            status, kind, content = HTTPStatus.FORBIDDEN, "text/plain", b""
        else:
            status, kind, content = owner.answer(self.path)
        self.send_response(status)
        for name, value in {**_HEADERS, "Content-Type": kind, "Content-Length": str(len(content))}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_: object) -> None:
        """Say nothing: the terminal is for what changed."""


def _digest(news: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(news).encode()).hexdigest()


def _page() -> bytes:
    """The page around the report, which runs its own script and shows its own server's pages alone."""
    text = (ROOT / "templates" / "watch.html").read_text(encoding="utf-8")
    policy = ["default-src 'none'", "connect-src 'self'", "frame-src 'self'", "base-uri 'none'"]
    for tag in ("script", "style"):
        found = re.search(f"<{tag}>(.*?)</{tag}>", text, re.S)
        assert found is not None
        digest = base64.b64encode(hashlib.sha256(found[1].encode()).digest()).decode()
        policy.append(f"{tag}-src 'sha256-{digest}'")
    return text.replace("{policy}", "; ".join(policy)).encode()
