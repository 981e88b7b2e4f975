"""The pages of `grader view`, served in this process while files change, for tests of its answers and of its page."""

import json
import re
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import Any, NamedTuple

from grader.app.commands.view_server import MAX_LOG_BODY, RobotPages, follow_files
from grader.app.commands.viewed_robots import ViewRequest
from grader.files.reading import URDF_LIMIT
from grader.report.local_server import LocalServer
from tests.command_line import HANG_TIMEOUT
from tests.review_server import Answer, Review


class Page(NamedTuple):
    """A page as it is served."""

    text: str

    @property
    def data(self) -> dict[str, Any]:
        """What its script reads."""
        found = re.search(r'id="data">(.*?)</script>', self.text)
        assert found is not None
        data: dict[str, Any] = json.loads(found[1])
        return data

    @property
    def number(self) -> int:
        """The number of its version."""
        number: int = self.data["view"]["number"]
        return number

    @property
    def sizes(self) -> dict[str, list[float]]:
        """The size of the first shape of each link that has one."""
        links = self.data["robot"]["links"]
        return {link["name"]: link["shapes"][0]["size"] for link in links if link["shapes"]}

    def part(self, name: str) -> str:
        """Return a part of what the page of a report does not have: `broken`, `robots`, `arguments`, `answers` or `notes`."""
        found = re.search(rf'(?s)id="view-{name}"[^>]*>(.*?)\n</(?:div|nav|form)>', self.text)
        assert found is not None, name
        return found[1].strip()


class View(NamedTuple):
    """A running view."""

    server: Review
    pages: RobotPages

    def get(self, address: str = "", **headers: str) -> Answer:
        """Return the answer to a GET below the secret."""
        return self.server.get(address, **headers)

    def page(self, address: str = "") -> Page:
        """Return a page as it is now."""
        return Page(self.get(address).text)

    def next(self, page: Page) -> Page:
        """Return the page that follows, as soon as it is there."""
        address = page.data["view"]["address"]
        for _ in range(20):
            found = self.get(f"changes/{page.number}/{address}").json
            if found["page"]:
                return Page(found["page"])
        raise AssertionError("nothing has changed")

    def explain(self, log: str) -> int:
        """Paste an output of a terminal as the page does, and return the status."""
        return self.server.post("log", {"do": "explain", "log": log}).status

    def try_arguments(self, **values: str) -> int:
        """Try arguments of xacro as the page does, and return the status."""
        return self.server.post("arguments", {"do": "try", "arguments": values}).status


@contextmanager
def viewing(path: Path, rubric: str = "", arg: Sequence[str] = ()) -> Iterator[View]:
    """Yield a view that follows the files, in other threads."""
    pages = RobotPages()
    versions = follow_files(ViewRequest(str(path), rubric, arg, URDF_LIMIT), pages)
    with LocalServer(pages, max_body=MAX_LOG_BODY) as server:
        next(versions)
        serving = Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
        following = Thread(target=deque, args=(versions, 0))
        for thread in (serving, following):
            thread.start()
        try:
            yield View(Review(server.url, server.port, server.token), pages)
        finally:
            pages.end()
            server.shutdown()
            for thread in (serving, following):
                thread.join(HANG_TIMEOUT)
                assert not thread.is_alive()


def put(text: str, target: Path) -> None:
    """Replace a file at once, as many editors do."""
    beside = target.with_name(f".{target.name}.tmp")
    beside.write_text(text, encoding="utf-8")
    beside.replace(target)
