"""Grade what needs manual grading on a page in the browser, item by item, which a server on this machine serves."""

import json
import re
from bisect import bisect
from collections.abc import Mapping
from contextlib import suppress
from http import HTTPStatus
from typing import Any

from grader.classroom.grades import Class
from grader.classroom.review_items import STATES, ReviewFilter, ReviewItem
from grader.documents.pictures import EmbeddedPicture
from grader.errors import GraderError
from grader.report.pages import review as pages
from grader.text import counted, printable_path
from grader.usecases.grade_class import write_grades
from grader.usecases.local_server import SANDBOX, LocalServer, Response
from grader.usecases.review_pictures import open_item
from grader.usecases.review_session import ReviewSession
from grader.usecases.terminal import Terminal

_HTML, _JSON = "text/html; charset=utf-8", "application/json"
_PAGE_POLICY = "frame-ancestors 'none'"  # the page itself contains the rest
_PDF_POLICY = "default-src 'none'; frame-ancestors 'self'"
_CHANGED = "Not saved: this item has changed since it was shown. Look at it again."
_NO_PAGE = Response(b"not found\n", status=HTTPStatus.NOT_FOUND)


class ReviewPage:
    """The application of the server: shows items of a session by number, and executes actions from the page."""

    def __init__(self, session: ReviewSession) -> None:
        self.session = session

    def __call__(self, path: tuple[str, ...], body: bytes | None) -> Response:
        """Return the response to a request; errors of the gradebook become messages."""
        session = self.session
        try:
            session.refresh()
            return self._act(path, body) if body is not None else self._page(path)
        except GraderError as error:
            if body is not None:
                return _json({"error": str(error)})
            following = session.following(self._position(path[0]))
            return _html(pages.error_page(str(error), self._address(following)), HTTPStatus.SERVICE_UNAVAILABLE)

    def _page(self, path: tuple[str, ...]) -> Response:
        session = self.session
        match path:
            case ("",):
                return Response(b"", status=HTTPStatus.FOUND, location=self._address(session.position))
            case ("end",):
                given = sum(mark.points is not None for mark in session.own.values())
                return _html(pages.end_page(given, session.left, self._place(), printable_path(session.folder)))
            case (number, *rest) if (position := self._position(number)) >= 0:
                session.position = position
                return self._of_item(session.item_at(position), rest)
        return _NO_PAGE

    def _of_item(self, item: ReviewItem, rest: list[str]) -> Response:
        """Return the page of the current item, or one of its pictures."""
        session, book = self.session, self.session.book
        match rest:
            case []:
                criterion = session.models.get(item.criterion.id, item.criterion)
                return _html(pages.item_page(item, open_item(book, item), criterion, self._place()))
            case ["picture", which]:
                found = {str(at): one for at, one in enumerate(open_item(book, item).pictures, 1)}.get(which)
                if isinstance(found, EmbeddedPicture):
                    return Response(found.data, found.kind.media_type, policy=SANDBOX if found.height else _PDF_POLICY)
        return _NO_PAGE

    def _place(self) -> pages.Place:
        session, listed = self.session, self.session.listed
        values = (
            {"": "all questions", **{name: name for name, _ in session.items}},
            {"": "all sections", **{name: name for name in sorted(session.sections.values())}},
            STATES,
        )
        filters = [*zip(ReviewFilter._fields, ("Question", "Section", "Items"), values, session.filter, strict=True)]
        return pages.Place(bisect(listed, session.position), len(listed), self._address(session.position), filters)

    def _act(self, path: tuple[str, ...], body: bytes) -> Response:
        """Execute an action of the page."""
        session = self.session
        at = len(session.places) if path == ("end",) else self._position("/".join(path))
        match _read(body) if at >= 0 else None:
            case {"do": "mark", "points": str(points), "comment": str(comment), "shown": str(shown)}:
                session.position = at
                return self._mark(points, comment.strip(), shown)
            case {"do": "filter", "criterion": str(criterion), "section": str(section), "state": str(state)} if (
                state in STATES
            ):
                session.show_only(ReviewFilter(criterion, section, state))
            case {"do": "again"}:
                session.show_only(session.filter)
            case {"do": "back"}:
                session.position = session.previous(at)
            case {"do": "next"}:
                session.position = session.following(at)
            case _:
                return _json({"error": "this request is not from the page"}, HTTPStatus.BAD_REQUEST)
        return _json({"go": self._address(session.position)})

    def _mark(self, points: str, comment: str, shown: str) -> Response:
        """Save a mark, or return those of others that it would replace."""
        session = self.session
        open_item(session.book, session.item_at(session.position))  # what has moved or changed cannot be marked
        replaced = session.mark(points, comment, shown)
        if replaced:
            more = f" (and {counted(len(replaced) - 1, 'more mark')})" if len(replaced) > 1 else ""
            return _json({"newer": pages.mark_text(replaced[0]) + more})
        answer = {"error": _CHANGED} if replaced is None else {}
        session.position = session.position if answer else session.following(session.position)
        return _json({**answer, "go": self._address(session.position)})

    def _address(self, position: int) -> str:
        return str(position + 1) if position < len(self.session.places) else "end"

    def _position(self, number: str) -> int:
        """Return the position of an item; -1 if there is none."""
        is_item = re.fullmatch("[1-9][0-9]{0,7}", number) and int(number) <= len(self.session.places)
        return int(number) - 1 if is_item else -1


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
    with LocalServer(ReviewPage(session), port) as server:
        for warning in session.warnings:
            terminal.warn(warning)
        with suppress(KeyboardInterrupt):
            terminal.print(f"{server.url}\n")
            terminal.warn("open this address in a browser on this machine; Ctrl-C ends the review, all marks are kept")
            server.serve_forever()
    write_grades(Class(session.folder))
    return f"{len(session.own)} marked, {session.left} left\n"
