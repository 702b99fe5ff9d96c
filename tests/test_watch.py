"""What is saved is built again and shown; nobody else can read it, and nothing is left at the end."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from small_report import end_gauge

from loopsheet.report.cli import main
from loopsheet.report.machine.local_server import Server
from loopsheet.report.verbs.watch import _look


def get(url: str, **headers: str) -> tuple[int, bytes, Any]:
    request = urllib.request.Request(url, headers={name.replace("_", "-"): v for name, v in headers.items()})
    try:
        with urllib.request.urlopen(request, timeout=60) as answer:
            return answer.status, answer.read(), answer.headers
    except urllib.error.HTTPError as error:
        return error.code, error.read(), error.headers


# --- the server ---


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    out = tmp_path / "out"
    out.mkdir()
    (out / "report.html").write_text("<p>the report")
    (out / "notes.txt").write_text("the user's own")
    (tmp_path / "secret").write_text("secret")
    (out / "link.html").symlink_to(tmp_path / "secret")
    listed = dict.fromkeys(["report.html", "link.html", "gone.html", "../secret", "/etc/passwd"], "0")
    (out / "manifest.json").write_text(
        json.dumps({"schema": 1, "inputs": {"report.toml": "0"}, "outputs": listed, "versions": {}})
    )
    with Server(out) as made:
        yield made


def test_it_serves_the_outputs_and_nothing_else(server: Server) -> None:
    status, content, headers = get(f"{server.address}report.html")
    assert (status, content, headers["Content-Type"]) == (200, b"<p>the report", "text/html; charset=utf-8")
    assert headers["Cache-Control"] == "no-store"
    assert headers["Referrer-Policy"] == "no-referrer"
    names = ["notes.txt", "manifest.json", "link.html", "gone.html", "../secret", "%2e%2e/secret", "%00"]
    assert [get(server.address + name)[0] for name in [*names, "/etc/passwd"]] == [404] * 8


def test_no_other_site_can_have_it_read(server: Server) -> None:
    host = server.host
    port = host.rpartition(":")[2]
    assert get(server.address)[0] == 200
    assert get(server.address, Sec_Fetch_Site="same-origin")[0] == 200
    for other in ("evil.example", f"evil.example:{port}", f"localhost:{port}", "127.0.0.1"):
        assert get(server.address, Host=other)[:2] == (421, b"")
    for site in ("cross-site", "same-site"):
        assert get(server.address, Sec_Fetch_Site=site)[:2] == (403, b"")
    for path in ("", "report.html", "x" * 22, "x" * 22 + "/report.html", "%ff/"):
        assert get(f"http://{host}/{path}")[:2] == (404, b"")
    assert server.host.startswith("127.0.0.1:")
    with pytest.raises(urllib.error.HTTPError, match="501"):
        urllib.request.urlopen(urllib.request.Request(server.address, data=b"x"), timeout=60)


def test_the_page_around_it_runs_its_own_script_alone(server: Server) -> None:
    page = get(server.address)[1].decode()
    found = re.search('Content-Security-Policy" content="([^"]*)"', page)
    assert found
    own = "default-src 'none'; connect-src 'self'; frame-src 'self'; base-uri 'none'; script-src 'sha256-"
    assert found[1].startswith(own)
    assert "unsafe" not in found[1]


def test_it_tells_news_as_soon_as_there_are_some(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    news = json.loads(get(f"{server.address}news")[1])
    assert (news["number"], news["error"], news["changed"]) == (0, "", "")
    server.tell(changed="alpha moved")
    second = json.loads(get(f"{server.address}news?known={news['known']}")[1])
    assert (second["number"], second["changed"]) == (1, "alpha moved")
    server.tell(error="v is not a number")
    third = json.loads(get(f"{server.address}news?known={second['known']}")[1])
    assert (third["number"], third["error"]) == (1, "v is not a number")
    monkeypatch.setattr("loopsheet.report.machine.local_server.PATIENCE", 0.05)
    assert json.loads(get(f"{server.address}news?known={third['known']}")[1]) == third


# --- the command ---


class Watch:
    """`loopsheet watch`, with what it says."""

    def __init__(self, folder: Path) -> None:
        self.said = folder.parent / "said"
        with self.said.open("w") as said:
            # Tests in the background of a shell ignore what comes from the keyboard.
            before = signal.signal(signal.SIGINT, signal.default_int_handler)
            command = [sys.executable, "-m", "loopsheet", "watch", str(folder)]
            self.process = subprocess.Popen(command, stdout=said, stderr=said)
            signal.signal(signal.SIGINT, before)

    def until(self, what: str, since: int = 0) -> str:
        """What it says once it says something, after what it had said."""
        for _ in range(1200):
            text = self.said.read_text()[since:]
            if re.search(what, text):
                return text
            assert self.process.poll() is None, text
            time.sleep(0.05)
        raise AssertionError(text)


def test_what_is_saved_is_built_again(tmp_path: Path) -> None:
    folder = tmp_path / "gauge"
    folder.mkdir()
    end_gauge(folder)
    assert main(["build", str(folder), "--to", "html,xlsx"]) == 0
    watch = Watch(folder)
    try:
        address = re.findall(r"http://\S+", watch.until(r"\(Ctrl-C ends\)"))[0]
        watch.until("4 files in ")
        page = get(f"{address}report.html")[1]
        assert page == (folder / "out" / "report.html").read_bytes()
        news = json.loads(get(f"{address}news")[1])
        assert (news["number"], news["error"]) == (1, "")
        data, since = folder / "d.csv", len(watch.said.read_text())
        right = data.read_text()
        data.write_text(right.replace("215", "abc"))
        told = watch.until("1 error", since)
        assert re.search(r"error\[LS401\]: .*'abc'\n +--> .*gauge/d\.csv:2:3\n", told)
        wrong = json.loads(get(f"{address}news?known={news['known']}")[1])
        assert wrong["number"] == 1
        assert "'abc'" in wrong["error"]
        assert get(f"{address}report.html")[1] == page
        since = len(watch.said.read_text())
        draft = folder / "draft"  # as an editor that replaces a file does
        draft.write_text(right.replace("215", "216"))
        draft.replace(data)
        told = watch.until("4 files in ", since)
        assert re.search(r"\n  input    d\[1\] +215 -> 216 nm +\+0\.465 %\n", told)
        last = json.loads(get(f"{address}news?known={wrong['known']}")[1])
        assert (last["number"], last["error"]) == (2, "")
        assert "d[1]" in last["changed"]
        again = get(f"{address}report.html")[1]
        assert again != page
        since = len(watch.said.read_text())
        shutil.rmtree(folder / "out")
        watch.until("4 files in ", since)
        assert get(f"{address}report.html")[1] == again
        watch.process.send_signal(signal.SIGINT)
        assert watch.process.wait(20) == 0
        *_, last_line = watch.said.read_text().splitlines()
        assert last_line == f"'loopsheet build {folder} --to html,xlsx,json' makes again what went: xlsx"
        assert "Traceback" not in watch.said.read_text()
        with pytest.raises(urllib.error.URLError):
            get(address)
        assert [name for name in os.listdir(folder / "out") if name.startswith(".")] == []
    finally:
        watch.process.kill()
        watch.process.wait()


def test_it_ends_when_nobody_reads_what_it_tells(gauge: Path) -> None:
    command = [sys.executable, "-m", "loopsheet", "watch", str(gauge), "--to", "json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as watching:
        assert watching.stdout is not None
        assert watching.stdout.readline()
        watching.stdout.close()
        assert watching.wait(timeout=300) == 0


def test_what_is_looked_at(tmp_path: Path) -> None:
    (tmp_path / "data").mkdir()
    (tmp_path / "a.csv").write_text("1")
    (tmp_path / "data" / "b.csv").write_text("1")
    first = _look(tmp_path, ["data/b.csv", "none.csv"])
    assert set(first) == {"a.csv", "data/b.csv"}
    (tmp_path / "data" / "b.csv").write_text("22")
    assert _look(tmp_path, ["data/b.csv"]) != first
    assert _look(tmp_path / "none", ["x"]) == {}
    # What report.toml names, though nothing could be read of it; not what somebody writes beside it.
    toml = '[measurements]\nfile = "data/b.csv"\n[published]\nfile = "c.txt"\n'
    (tmp_path / "report.toml").write_text(toml)
    (tmp_path / "c.txt").write_text("1")
    (tmp_path / "watch.log").write_text("1")
    assert set(_look(tmp_path, [])) == {"a.csv", "data/b.csv", "c.txt", "report.toml"}
