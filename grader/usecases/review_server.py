"""Serve the review page to a browser on this machine."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from http import HTTPStatus
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import EVERYTHING, ReviewScope
from grader.classroom.review.session import ReviewSession
from grader.usecases import Terminal
from grader.usecases.local_server import LocalServer, Request, Response
from grader.usecases.review import NOTHING, summary
from grader.usecases.review_page import ReviewPage


def review_in_browser(gradebook: Path, scope: ReviewScope, port: int, terminal: Terminal) -> str:
    """Serve the review page until Ctrl-C, and return a summary. Prints the address. Raises InputError."""
    with serving(gradebook, scope, port) as (server, page):
        if server is None:
            return NOTHING
        with suppress(KeyboardInterrupt):
            terminal.show(f"{server.url}\n")
            terminal.warn(
                "open this address in a browser on this machine; Ctrl-C ends the review, and all marks are kept"
            )
            server.serve_forever()
        return server.worker.submit(lambda: summary(page.session)).result()


@contextmanager
def serving(
    gradebook: Path, scope: ReviewScope = EVERYTHING, port: int = 0
) -> Iterator[tuple[LocalServer | None, ReviewPage]]:
    """Yield a server for a review, None if nothing needs manual grading.

    One thread opens, reads and writes the gradebook; another one reads pictures.
    """
    with ThreadPoolExecutor(1) as worker, ThreadPoolExecutor(1) as reader:
        book = worker.submit(Gradebook, gradebook).result()
        try:
            session = worker.submit(lambda: ReviewSession(Grades(book, answers=True), scope)).result()
            page = ReviewPage(session, book.shown, reader)
            if not session.queue:
                yield None, page
                return
            book.check_writable()

            def followed(request: Request) -> Response:
                """Answer a request, and then read the pictures of the item after the one that is shown."""
                response = page(request)
                if request.body is None and len(request.path) == 1 and response.status is HTTPStatus.OK:
                    worker.submit(page.prepare)
                return response

            with LocalServer(followed, worker, port) as server:
                yield server, page
        finally:
            worker.submit(book.close).result()
