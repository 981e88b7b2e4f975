"""Grade what needs manual grading on a page in the browser, item by item, which a server on this machine serves."""

import json
import re
from bisect import bisect
from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import lru_cache
from http import HTTPStatus
from itertools import count
from typing import Any

from grader.classroom.grades import Class
from grader.classroom.review_items import STATES, ReviewFilter, ReviewItem
from grader.documents.pictures import EmbeddedPicture
from grader.errors import GraderError
from grader.report.pages import review as pages
from grader.report.pages.student import render_html
from grader.text import counted, printable_path
from grader.usecases.class_reports import report_of
from grader.usecases.grade_class import write_grades
from grader.usecases.local_server import SANDBOX, LocalServer, Request, Response
from grader.usecases.review_pictures import open_item
from grader.usecases.review_session import CONFIRMED, ReviewSession
from grader.usecases.terminal import Terminal

_KEPT = 3  # items whose pictures stay in memory: the one before, the current and the next one
_HTML, _JSON = "text/html; charset=utf-8", "application/json"
_PAGE_POLICY = "frame-ancestors 'none'"  # the page itself contains the rest
_REPORT_POLICY = "sandbox allow-scripts; frame-ancestors 'self'"
_PDF_POLICY = "default-src 'none'; frame-ancestors 'self'"
_NO_PAGE = Response(b"not found\n", status=HTTPStatus.NOT_FOUND)


class ReviewPage:
    """The application of the server: shows items of a session by number, and executes actions from the page."""

    def __init__(self, session: ReviewSession, reader: ThreadPoolExecutor) -> None:
        self.session = session

        @lru_cache(maxsize=_KEPT)
        def opened(run: int, stamp: str, position: int) -> Future[pages.OpenedItem]:
            del run, stamp  # another submission
            return reader.submit(open_item, session.book, session.item_at(position))

        self._opened, self._reader = opened, reader

    def __call__(self, request: Request) -> Response:
        """Return the response to a request; errors of the gradebook become messages."""
        session = self.session
        try:
            session.refresh()
            return self._act(request) if request.body is not None else self._page(request.path)
        except GraderError as error:
            if request.body is not None:
                return _json({"error": str(error)})
            position = self._position(request.path[0])
            following = session.following(position) if position is not None else len(session.places)
            return _html(pages.error_page(str(error), self._address(following)), HTTPStatus.SERVICE_UNAVAILABLE)

    def prepare(self) -> None:
        """Begin to read the submission of the next item, while the person looks at this one."""
        with suppress(GraderError):  # the page of that item shows the error
            self._open(self.session.following(self.session.position))

    def _open(self, position: int) -> "Future[pages.OpenedItem]":
        """Return what is shown of an item. Another thread reads it, so that marks are not delayed."""
        shown = self.session.book.run.run, self.session.item_at(position).stamp, position
        if (found := self._opened(*shown)).done() and found.exception() is not None:
            self._opened.cache_clear()  # try again
        return self._opened(*shown)

    def _page(self, path: tuple[str, ...]) -> Response:
        session = self.session
        match path:
            case ("",):
                return Response(b"", status=HTTPStatus.FOUND, location=self._address(session.position))
            case ("end",):
                given = sum(mark.points is not None for mark in session.own.values())
                return _html(pages.end_page(given, session.left, self._place(), printable_path(session.folder)))
            case (number, *rest) if (position := self._position(number)) is not None:
                session.position = position
                return self._of_item(session.item_at(position), rest)
        return _NO_PAGE

    def _of_item(self, item: ReviewItem, rest: list[str]) -> Response:
        """Return the page of the current item, one of its pictures, or the student's page without model answers."""
        session, book, opened = self.session, self.session.book, self._open(self.session.position)
        match rest:
            case []:
                criterion = session.models.get(item.criterion.id, item.criterion)
                comments = session.comments(criterion)
                return _html(pages.item_page(item, opened.result(), criterion, comments, self._place()))
            case ["picture", which]:
                found = dict(zip(map(str, count(1)), opened.result().pictures, strict=False)).get(which)
                if isinstance(found, EmbeddedPicture):
                    return Response(found.data, found.kind.media_type, policy=SANDBOX if found.height else _PDF_POLICY)
            case ["report"] if pages.has_report(item):
                grade = book.grade(item.first.student.key)
                page = self._reader.submit(lambda: render_html(report_of(book, grade))).result()
                return _html(page, policy=_REPORT_POLICY)
        return _NO_PAGE

    def _place(self) -> pages.Place:
        session, listed = self.session, self.session.listed
        values = (
            {"": "all questions", **{name: name for name, _ in session.items}},
            {"": "all sections", **{name: name for name in sorted(session.sections.values())}},
            STATES,
        )
        filters = [*zip(ReviewFilter._fields, ("Question", "Section", "Items"), values, session.filter, strict=True)]
        members = (one.student for item in session.items.values() for one in item.members)
        students = sorted({(one.key, one.name) for one in members}) if not session.is_anonymous else []
        number = bisect(listed, session.position)
        return pages.Place(number, len(listed), self._address(session.position), filters, students)

    def _act(self, request: Request) -> Response:
        """Execute an action of the page."""
        session, position = self.session, self._position(request.path[0]) if len(request.path) == 1 else None
        position = len(session.places) if request.path == ("end",) else position
        session.position = session.position if position is None else position
        match _read(request.body or b"") if position is not None else None:
            case {"do": "mark", "points": str(points), "comment": str(comment), "item": str(item), "shown": str(shown)}:
                return self._mark(points, comment.strip(), item, shown)
            case {"do": "filter", "criterion": str(criterion), "section": str(section), "state": str(state)} if (
                state in STATES
            ):
                session.show_only(ReviewFilter(criterion, section, state))
            case {"do": "find", "student": str(student)}:
                session.find(student.strip())
            case {"do": "again"}:
                session.show_only(session.filter)
            case {"do": "back"}:
                session.back()
            case {"do": "next"}:
                session.position = session.following(session.position)
            case _:
                return _json({"error": "this request is not from the page"}, HTTPStatus.BAD_REQUEST)
        return _json({"go": self._address(session.position)})

    def _mark(self, points: str, comment: str, item: str, shown: str) -> Response:
        """Save a mark, or return those of others that it would replace."""
        session = self.session
        self._open(session.position).result()  # what has moved or changed cannot be marked
        if replaced := session.mark(points, comment, item, shown):
            more = f" (and {counted(len(replaced) - 1, 'more mark')})" if len(replaced) > 1 else ""
            view = session.item_at(session.position).view
            return _json({"newer": pages.mark_text(replaced[0]) + more, "shown": view + CONFIRMED})
        session.position = session.following(session.position)
        return _json({"go": self._address(session.position)})

    def _address(self, position: int) -> str:
        return str(position + 1) if position < len(self.session.places) else "end"

    def _position(self, number: str) -> int | None:
        is_item = re.fullmatch("[1-9][0-9]{0,7}", number) and int(number) <= len(self.session.places)
        return int(number) - 1 if is_item else None


def _read(body: bytes) -> Any:
    try:
        return json.loads(body)
    except (ValueError, RecursionError):
        return None


def _html(page: str, status: HTTPStatus = HTTPStatus.OK, policy: str = _PAGE_POLICY) -> Response:
    return Response(page.encode("utf-8", "backslashreplace"), _HTML, status, policy=policy)


def _json(answer: Mapping[str, str], status: HTTPStatus = HTTPStatus.OK) -> Response:
    return Response(json.dumps(answer).encode(), _JSON, status)


def review_in_browser(session: ReviewSession, port: int, terminal: Terminal) -> str:
    """Serve the review page until Ctrl-C, write the grades, and return a summary. Raises InputError."""
    if not session.places:
        return "nothing needs manual grading\n"
    with serving(session, port) as server:
        for warning in session.warnings:
            terminal.warn(warning)
        with suppress(KeyboardInterrupt):
            terminal.print(f"{server.url}\n")
            terminal.warn("open this address in a browser on this machine; Ctrl-C ends the review, all marks are kept")
            server.serve_forever()
    write_grades(Class(session.folder))
    return f"{len(session.own)} marked, {session.left} left\n"


@contextmanager
def serving(session: ReviewSession, port: int = 0) -> Iterator[LocalServer]:
    """Yield a server for a review. One thread reads and writes the gradebook; another one reads submissions."""
    with ThreadPoolExecutor(1) as worker, ThreadPoolExecutor(1) as reader:
        page = ReviewPage(session, reader)

        def followed(request: Request) -> Response:
            """Answer a request, and then read the submission of the item after the one that is shown."""
            response = page(request)
            if request.body is None and len(request.path) == 1 and response.status is HTTPStatus.OK:
                worker.submit(page.prepare)
            return response

        with LocalServer(followed, worker, port) as server:
            yield server
