"""Pages in a headless browser. Without it, or without Playwright, tests are skipped; `.ci/run` requires both."""

import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import pytest

from tests.command_line import HANG_TIMEOUT

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

CHROMIUM = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("google-chrome")
# Without these, Chromium writes to the console of each page that it draws without a graphics card.
SOFTWARE_WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")


@pytest.fixture(
    scope="module"
)  # not of the session: while Playwright runs, the thread has an event loop
def browser() -> Iterator["Browser"]:
    """Return a headless browser."""
    sync_api = pytest.importorskip(
        "playwright.sync_api", reason="Playwright is not installed: pip install --group browser"
    )
    if CHROMIUM is None:
        pytest.skip("Chromium is not installed")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", *SOFTWARE_WEBGL]
        )  # tests may run as root
        yield browser
        browser.close()


@dataclass
class OpenPage:
    """A page in the browser, with every request that it made and every message of its console."""

    page: "Page"
    requests: list[str] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)

    def check(self) -> None:
        """Assert that the page made no request but for files of its own origin, and that its console is empty."""
        first = urlsplit(self.page.url)
        for request in self.requests:
            parts = urlsplit(request)
            assert (parts.scheme, parts.netloc) == (first.scheme, first.netloc), request
        assert self.messages == []


@pytest.fixture(scope="module")
def open_pages(browser: "Browser") -> Callable[..., OpenPage]:
    """Return a function that opens a file or an address. The test that opens a page checks it."""

    def open_one(address: Path | str, **options: object) -> OpenPage:
        page = browser.new_page(**options)
        page.set_default_timeout(HANG_TIMEOUT * 1000)
        found = OpenPage(page)
        page.on("request", lambda request: found.requests.append(request.url))
        page.on("console", lambda message: found.messages.append(message.text))
        page.on("pageerror", lambda error: found.messages.append(str(error)))
        page.on("dialog", lambda dialog: found.messages.append(f"dialog: {dialog.message}"))
        page.goto(address.as_uri() if isinstance(address, Path) else address)
        return found

    return open_one


@pytest.fixture
def open_page(open_pages: Callable[..., OpenPage]) -> Iterator[Callable[..., OpenPage]]:
    """Return a function that opens a file or an address; each page is checked at the end of the test."""
    opened: list[OpenPage] = []

    def open_one(address: Path | str, **options: object) -> OpenPage:
        opened.append(open_pages(address, **options))
        return opened[-1]

    yield open_one
    for found in opened:
        found.check()
        found.page.close()
