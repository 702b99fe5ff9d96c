"""The page around the report: it reloads when another one was built, and says what is wrong."""

from __future__ import annotations

import json
from pathlib import Path

from playwright.sync_api import Browser

from loopsheet.report.machine.local_server import Server


def test_an_open_page_follows(browser: Browser, tmp_path: Path) -> None:
    def issue(text: str) -> None:
        (tmp_path / "report.html").write_text(f"<title>Steel</title><p>{text}</p>")

    manifest = {"schema": 1, "inputs": {"report.toml": "0"}, "outputs": {"report.html": "0"}, "versions": {}}
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    issue("first")
    with Server(tmp_path) as server:
        page = browser.new_page()
        complaints: list[str] = []
        page.on("console", lambda message: complaints.append(message.text))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto(server.address)
        report, bar = page.frame_locator("iframe"), page.locator("section")
        report.get_by_text("first").wait_for()
        assert bar.is_hidden()
        server.tell(error="error[LS401]: v is not a number: '<b>abc'")
        page.get_by_text("'<b>abc'").wait_for()
        assert "The report below is the one of before" in bar.inner_text()
        assert report.get_by_text("first").is_visible()
        issue("second")
        server.tell(changed="alpha_mean 1.303 -> 1.305")
        report.get_by_text("second").wait_for()
        page.get_by_text("alpha_mean 1.303 -> 1.305").wait_for()
        assert page.title() == "Steel"
        page.get_by_role("button", name="Close").click()
        assert bar.is_hidden()
        assert complaints == []
        page.close()
