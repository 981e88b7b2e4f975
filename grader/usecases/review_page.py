"""Grade what needs manual grading on a page in the browser, item by item, which a server on this machine serves."""

import json
from bisect import bisect
from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import lru_cache
from http import HTTPStatus
from pathlib import Path
from typing import Any

from grader.classroom.grades import Class
from grader.classroom.review_items import STATES, ReviewFilter, ReviewItem
from grader.documents.pictures import EmbeddedPicture
from grader.errors import GraderError
from grader.report.pages.review import (
    Found,
    Place,
    end_page,
    error_page,
    files_text,
    has_report,
    item_page,
    mark_text,
)
from grader.report.pages.student import render_html
from grader.text import counted, printable_path
from grader.usecases.class_reports import report_of
from grader.usecases.grade_class import write_grades
from grader.usecases.local_server import SANDBOX, LocalServer, Request, Response
from grader.usecases.review_pictures import OpenedItem, open_item
from grader.usecases.review_session import CONFIRMED, EVERYTHING, ReviewScope, ReviewSession
from grader.usecases.terminal import Terminal

_KEPT = 3  # items whose pictures stay in memory: the one before, the current and the next one
_HTML, _JSON = "text/html; charset=utf-8", "application/json"
_PAGE_POLICY = "frame-ancestors 'none'"  # the page itself contains the rest
_REPORT_POLICY = "sandbox allow-scripts; frame-ancestors 'self'"
_PDF_POLICY = "default-src 'none'; frame-ancestors 'self'"
_NO_PAGE = Response(b"not found\n", status=HTTPStatus.NOT_FOUND)
# What the page sends besides `do`, with the type of each value.
_ACTIONS: Mapping[str, Mapping[str, type]] = {
    "mark": {"points": str, "comment": str, "shown": str, "item": str},
    "filter": {"criterion": str, "section": str, "state": str},
    "find": {"student": str},
    **{name: {} for name in ("next", "back", "again")},
}


class ReviewPage:
    """The application of the server: shows items of a session by number, and executes actions from the page."""

    def __init__(self, session: ReviewSession, reader: ThreadPoolExecutor) -> None:
        self.session = session

        @lru_cache(maxsize=_KEPT)
        def opened(run: int, stamp: str, position: int) -> Future[OpenedItem]:
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
            return _html(error_page(str(error), self._address(following)), HTTPStatus.SERVICE_UNAVAILABLE)

    def prepare(self) -> None:
        """Begin to read the submission of the next item, while the person looks at this one."""
        with suppress(GraderError):  # the page of that item shows the error
            self._open(self.session.following(self.session.position))

    def _open(self, position: int) -> "Future[OpenedItem]":
        """Return what is shown of an item. Another thread reads it, so that marks are not delayed."""
        return self._opened(self.session.book.run.run, self.session.item_at(position).stamp, position)

    def _page(self, path: tuple[str, ...]) -> Response:
        session = self.session
        match path:
            case ("",):
                return Response(b"", status=HTTPStatus.FOUND, location=self._address(session.position))
            case ("end",):
                given = sum(mark.points is not None for mark in session.own.values())
                return _html(end_page(given, session.left, self._place(), printable_path(session.folder)))
            case (number, *rest) if (position := self._position(number)) is not None:
                session.position = position
                item = session.item_at(position)
                match rest:
                    case []:
                        return self._item(item)
                    case ["picture", which]:
                        return self._picture(which)
                    case ["report"] if has_report(item):
                        return self._report(item)
        return _NO_PAGE

    def _item(self, item: ReviewItem) -> Response:
        session, name = self.session, item.criterion.id
        result, pictures = self._open(session.position).result()
        paths = files_text(item, result, session.root_of(item))
        found = Found(result, pictures, paths, session.comments(name))
        return _html(item_page(item, session.models[name], found, self._place()))

    def _place(self) -> Place:
        session, listed = self.session, self.session.listed
        values = (
            {"": "all questions", **{name: name for name, _ in session.items}},
            {"": "all sections", **{name: name for name in sorted(session.sections.values())}},
            STATES,
        )
        filters = [*zip(ReviewFilter._fields, ("Question", "Section", "Items"), values, session.filter, strict=True)]
        members = (one.student for item in session.items.values() for one in item.members)
        students = sorted({(one.key, one.name) for one in members}) if not session.scope.anonymous else []
        number = bisect(listed, session.position)
        return Place(number, len(listed), self._address(session.position), filters, students)

    def _report(self, item: ReviewItem) -> Response:
        """Return the student's page, without model answers."""
        book = self.session.book
        page = self._reader.submit(lambda: render_html(report_of(book, book.grade(item.first.student.key)))).result()
        return Response(page.encode("utf-8", "backslashreplace"), _HTML, policy=_REPORT_POLICY)

    def _picture(self, which: str) -> Response:
        pictures = dict(enumerate(self._open(self.session.position).result().pictures, 1))
        found = pictures.get(int(which) if _is_number(which) else 0)
        if not isinstance(found, EmbeddedPicture):
            return _NO_PAGE
        return Response(found.data, found.kind.media_type, policy=SANDBOX if found.height else _PDF_POLICY)

    def _act(self, request: Request) -> Response:
        """Execute an action of the page."""
        session, sent = self.session, _action(request.body or b"")
        position = self._position(request.path[0]) if len(request.path) == 1 else None
        if request.path == ("end",):
            position = len(session.places)
        if sent is None or position is None:
            return _json({"error": "this request is not from the page"}, HTTPStatus.BAD_REQUEST)
        session.position = position
        match sent["do"]:
            case "mark":
                return self._mark(sent)
            case "find":
                session.find(sent["student"].strip())
            case "filter":
                session.show_only(ReviewFilter(*(sent[name] for name in ReviewFilter._fields)))
            case "again":
                session.show_only(session.filter)
            case "back":
                session.back()
            case "next":
                session.position = session.following(session.position)
        return _json({"go": self._address(session.position)})

    def _mark(self, sent: Mapping[str, str]) -> Response:
        """Save a mark, or return those of others that it would replace."""
        session = self.session
        self._open(session.position).result()  # what has moved or changed cannot be marked
        replaced = session.mark(sent["points"], sent["comment"].strip(), sent["item"], sent["shown"])
        if replaced:
            more = f" (and {counted(len(replaced) - 1, 'more mark')})" if len(replaced) > 1 else ""
            view = session.item_at(session.position).view
            return _json({"newer": mark_text(replaced[0]) + more, "shown": view + CONFIRMED})
        session.position = session.following(session.position)
        return _json({"go": self._address(session.position)})

    def _address(self, position: int) -> str:
        return str(position + 1) if position < len(self.session.places) else "end"

    def _position(self, number: str) -> int | None:
        inside = _is_number(number) and 1 <= int(number) <= len(self.session.places)
        return int(number) - 1 if inside else None


def _action(body: bytes) -> dict[str, Any] | None:
    """Return the action that the page has sent, or None if it is malformed."""
    try:
        sent = json.loads(body)
    except (ValueError, RecursionError):
        return None
    wanted = _ACTIONS.get(str(sent.get("do"))) if isinstance(sent, dict) else None
    if wanted is None or not all(type(sent.get(name)) is kind for name, kind in wanted.items()):
        return None
    return sent if "state" not in wanted or sent["state"] in STATES else None


def _is_number(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) < 9


def _html(page: str, status: HTTPStatus = HTTPStatus.OK) -> Response:
    return Response(page.encode("utf-8", "backslashreplace"), _HTML, status, policy=_PAGE_POLICY)


def _json(answer: Mapping[str, Any], status: HTTPStatus = HTTPStatus.OK) -> Response:
    return Response(json.dumps(answer).encode(), _JSON, status)


def review_in_browser(gradebook: Path, scope: ReviewScope, port: int, terminal: Terminal) -> str:
    """Serve the review page until Ctrl-C, write the grades, and return a summary. Raises InputError."""
    with serving(gradebook, scope, port) as (server, session):
        if not session.places:
            return "nothing needs manual grading\n"
        for warning in session.warnings:
            terminal.warn(warning)
        with suppress(KeyboardInterrupt):
            terminal.print(f"{server.url}\n")
            terminal.warn("open this address in a browser on this machine; Ctrl-C ends the review, all marks are kept")
            server.serve_forever()
        summary = server.worker.submit(lambda: f"{len(session.own)} marked, {session.left} left\n").result()
    write_grades(Class(gradebook))
    return summary


@contextmanager
def serving(
    gradebook: Path, scope: ReviewScope = EVERYTHING, port: int = 0
) -> Iterator[tuple[LocalServer, ReviewSession]]:
    """Yield a server for a review. One thread reads and writes the gradebook; another one reads submissions."""
    with ThreadPoolExecutor(1) as worker, ThreadPoolExecutor(1) as reader:
        page = ReviewPage(ReviewSession(gradebook, scope), reader)

        def followed(request: Request) -> Response:
            """Answer a request, and then read the submission of the item after the one that is shown."""
            response = page(request)
            if request.body is None and len(request.path) == 1 and response.status is HTTPStatus.OK:
                worker.submit(page.prepare)
            return response

        with LocalServer(followed, worker, port) as server:
            yield server, page.session
