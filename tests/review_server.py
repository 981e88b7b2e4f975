"""A review server in this process, for tests of its answers and of its page."""

import json
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from http.client import HTTPConnection, HTTPResponse
from pathlib import Path
from threading import Thread
from typing import Any, NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.review_items import ReviewFilter
from grader.classroom.review.review_server import ReviewPage
from grader.classroom.review.review_session import ReviewSession
from grader.report.local_server import HOST, LocalServer
from tests.command_line import HANG_TIMEOUT


class Answer(NamedTuple):
    """The answer to a request."""

    status: int
    body: bytes
    headers: dict[str, str]

    @property
    def json(self) -> dict[str, Any]:
        """The body as JSON."""
        found: dict[str, Any] = json.loads(self.body)
        return found

    @property
    def text(self) -> str:
        """The body as text."""
        return self.body.decode()


class Review(NamedTuple):
    """A running review: its address, port and secret."""

    url: str
    port: int
    token: str

    def ask(
        self, method: str, path: str, headers: Mapping[str, str] = {}, body: bytes | None = None
    ) -> Answer:
        """Send one request, with the path as it is given; an underscore in a header's name is a hyphen."""
        connection = HTTPConnection(HOST, self.port, timeout=HANG_TIMEOUT)
        try:
            given = {name.replace("_", "-"): value for name, value in headers.items()}
            connection.request(method, path, body, given)
            answer: HTTPResponse = connection.getresponse()
            return Answer(
                answer.status,
                answer.read(),
                {name.lower(): value for name, value in answer.headers.items()},
            )
        finally:
            connection.close()

    def get(self, path: str = "", **headers: str) -> Answer:
        """Return the answer to a GET below the secret."""
        return self.ask("GET", f"/{self.token}/{path}", headers)

    def post(self, path: str, sent: object, **headers: str) -> Answer:
        """Return the answer to what the page sends."""
        own = {"Content_Type": "application/json", "Origin": f"http://{HOST}:{self.port}"}
        return self.ask("POST", f"/{self.token}/{path}", own | headers, json.dumps(sent).encode())

    def mark(self, path: str, points: str, comment: str = "", **sent: object) -> dict[str, Any]:
        """Mark an item as its page does, and return the answer."""
        return self.post(
            path, {"do": "mark", "points": points, "comment": comment, **self.seen(path), **sent}
        ).json

    def seen(self, path: str) -> dict[str, str]:
        """Return what the page of an item sends back to say what it shows; nothing for an address without an item."""
        return dict(re.findall(r'"(shown)":"(\w+)"', self.get(path).text)) or {"shown": ""}


@contextmanager
def running(
    gradebook: Path, criterion: str = "", by: str = "Kim", **options: Any
) -> Iterator[Review]:
    """Yield a review that runs in another thread."""
    session = ReviewSession(gradebook, ReviewFilter(criterion), by, **options)
    with LocalServer(ReviewPage(session)) as server:
        thread = Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        try:
            yield Review(server.url, server.port, server.token)
        finally:
            server.shutdown()
            thread.join()


def marks_in(gradebook: Path) -> list[tuple[str, str, str, str]]:
    """Return the marks that count: student, criterion, value, comment."""
    return sorted(
        (*key, mark.value, mark.comment)
        for key, mark in Gradebook(gradebook).marks.counting.items()
    )


def rows_of(gradebook: Path, by: str = "kim") -> list[str]:
    """Return the points in the rows of a grader's file, in its order."""
    path = gradebook / "marks" / f"{by}.csv"
    return (
        [line.split(",")[4] for line in path.read_text().splitlines()[1:]] if path.exists() else []
    )
