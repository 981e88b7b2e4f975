"""Grade what needs manual grading on a page in the browser, item by item, which a server on this machine serves."""

import json
from bisect import bisect
from collections import OrderedDict
from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from http import HTTPStatus
from pathlib import Path
from typing import Any

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import EVERYTHING, QueuedResult, ReviewScope
from grader.classroom.gradebook.marks import NewerMarkError
from grader.classroom.review.queue import ITEM_STATES, ReviewFilter
from grader.classroom.review.session import ReviewSession
from grader.documents.pictures import EmbeddedPicture, NotShown
from grader.errors import GraderError
from grader.report.pages.review import Place, end_page, error_page, has_report, item_page, stamp_of
from grader.report.pages.student import render_html
from grader.report.review import mark_text
from grader.usecases.class_reports import report_of
from grader.usecases.local_server import SANDBOX, LocalServer, Request, Response
from grader.usecases.review import NOTHING, review_summary
from grader.usecases.review_actions import follow, read_action
from grader.usecases.review_pictures import item_pictures
from grader.usecases.terminal import Terminal

Album = tuple[EmbeddedPicture | NotShown, ...]
_CHANGED = "Not saved: this item has changed since it was shown. Look at it again."
_KEPT = 3  # items whose pictures stay in memory: the one before, the current and the next one
_HTML, _JSON = "text/html; charset=utf-8", "application/json"
_PAGE_POLICY = "frame-ancestors 'none'"  # the page itself contains the rest
_REPORT_POLICY = "sandbox allow-scripts; frame-ancestors 'self'"
_PDF_POLICY = "default-src 'none'; frame-ancestors 'self'"


class ReviewPage:
    """The application of the server: shows items of a session by number, and executes actions from the page."""

    def __init__(self, session: ReviewSession, book: Gradebook, reader: ThreadPoolExecutor) -> None:
        self.session, self._book, self._reader = session, book, reader
        self._albums: OrderedDict[str, Future[Album]] = OrderedDict()  # by the stamp of the item
        self._notice = ""

    def __call__(self, request: Request) -> Response:
        """Return the response to a request; errors of the gradebook become messages."""
        try:
            return self._act(request) if request.body is not None else self._page(request.path)
        except GraderError as error:
            if request.body is not None:
                return _json({"error": str(error)})
            following = self._following(self._position(request.path[0]))
            following_address = str(following + 1) if following < len(self.session.queue.items) else "end"
            return _html(error_page(str(error), following_address), HTTPStatus.SERVICE_UNAVAILABLE)

    def prepare(self) -> None:
        """Begin to read the pictures of the next item, while the person looks at this one."""
        following = self._following(self.session.position)
        with suppress(GraderError):  # the page of that item shows the error
            item = self.session.queue.item_at(following)
            if item is not None:
                self._album(item)

    def _following(self, position: int | None) -> int:
        """Return the position of the next item that the filter lets through."""
        queue = self.session.queue
        return next((at for at in queue.listed() if position is not None and at > position), len(queue.items))

    def _page(self, path: tuple[str, ...]) -> Response:
        match path:
            case ("",):
                return Response(b"", status=HTTPStatus.FOUND, location=self._address())
            case ("end",):
                session = self.session
                page = end_page(session.marked, session.left, self._place(), self._book.shown, self._pop_notice())
                return _html(page)
            case (number, *rest) if (position := self._position(number)) is not None:
                self.session.go(position)
                match rest:
                    case []:
                        return self._item()
                    case ["picture", which]:
                        return self._picture(which)
                    case ["report"]:
                        return self._report()
        return Response(b"not found\n", status=HTTPStatus.NOT_FOUND)

    def _item(self) -> Response:
        session, item = self.session, self.session.current_item()
        pictures = self._album(item).result()
        return _html(item_page(item, self._place(), pictures, session.comments(), self._pop_notice()))

    def _place(self) -> Place:
        session, listed = self.session, self.session.queue.listed()
        asked = {item.criterion for item in session.queue.items}
        values = (
            {"": "all questions"} | {row.id: row.id for row in session.criteria if row.id in asked},
            {"": "all sections"} | {name: name for name in session.queue.sections},
            ITEM_STATES,
        )
        filters = [
            *zip(ReviewFilter._fields, ("Question", "Section", "Items"), values, session.queue.filter, strict=True)
        ]
        students = [(one.key, one.name) for one in session.queue.students]
        number = bisect(listed, session.position)
        return Place(number, len(listed), self._address(), session.is_own, session.own.can_undo, filters, students)

    def _report(self) -> Response:
        """Return the student's page, without model answers."""
        item = self.session.current_item()
        if not has_report(item):
            return Response(b"not found\n", status=HTTPStatus.NOT_FOUND)
        page = render_html(report_of(Grades(self._book), item.grade))
        return Response(page.encode("utf-8", "backslashreplace"), _HTML, policy=_REPORT_POLICY)

    def _picture(self, which: str) -> Response:
        pictures = self._album(self.session.current_item()).result()
        found = dict(enumerate(pictures, 1)).get(int(which) if _is_number(which) else 0)
        if not isinstance(found, EmbeddedPicture):
            return Response(b"not found\n", status=HTTPStatus.NOT_FOUND)
        return Response(found.data, found.kind.media_type, policy=SANDBOX if found.height else _PDF_POLICY)

    def _act(self, request: Request) -> Response:
        """Execute an action of the page: next, back, undo, or a mark."""
        sent = read_action(request.body or b"")
        position = self._position(request.path[0]) if len(request.path) == 1 else None
        if request.path == ("end",):
            position = len(self.session.queue.items)
        if sent is None or position is None:
            return _json({"error": "this request is not from the page"}, HTTPStatus.BAD_REQUEST)
        self.session.go(position)
        try:
            if sent["do"] == "mark" and sent["item"] != stamp_of(self.session.current_item()):
                return _json({"error": _CHANGED, "go": request.path[0]})
            self._notice = follow(self.session, sent)
        except NewerMarkError as error:
            return _json({"newer": mark_text(error.mark), "shown": error.mark.id})
        return _json({"go": self._address()})

    def _album(self, item: QueuedResult) -> "Future[Album]":
        """Return the pictures of an item. Another thread reads them, so that marks are not delayed."""
        shown = stamp_of(item)
        if shown not in self._albums:
            self._albums[shown] = self._reader.submit(item_pictures, item, self.session.rubric_of(item))
        while len(self._albums) > _KEPT:
            self._albums.popitem(last=False)[1].cancel()
        return self._albums[shown]

    def _address(self) -> str:
        return str(self.session.position + 1) if self.session.item is not None else "end"

    def _position(self, number: str) -> int | None:
        inside = _is_number(number) and 1 <= int(number) <= len(self.session.queue.items)
        return int(number) - 1 if inside else None

    def _pop_notice(self) -> str:
        """Return the notice of the last action, once."""
        said, self._notice = self._notice, ""
        return said


def _is_number(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) < 9


def _html(page: str, status: HTTPStatus = HTTPStatus.OK) -> Response:
    return Response(page.encode("utf-8", "backslashreplace"), _HTML, status, policy=_PAGE_POLICY)


def _json(answer: Mapping[str, Any], status: HTTPStatus = HTTPStatus.OK) -> Response:
    return Response(json.dumps(answer).encode(), _JSON, status)


def review_in_browser(gradebook: Path, scope: ReviewScope, port: int, terminal: Terminal) -> str:
    """Serve the review page until Ctrl-C, and return a summary. Prints the address. Raises InputError."""
    with serving(gradebook, scope, port) as (server, page):
        if server is None:
            return NOTHING
        with suppress(KeyboardInterrupt):
            terminal.print(f"{server.url}\n")
            terminal.warn(
                "open this address in a browser on this machine; Ctrl-C ends the review, and all marks are kept"
            )
            server.serve_forever()
        return server.worker.submit(lambda: review_summary(page.session)).result()


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
            page = ReviewPage(session, book, reader)
            if not session.queue.items:
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
