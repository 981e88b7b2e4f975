"""Grade what needs manual grading on a page in the browser, item by item, which a server on this machine serves."""

import json
import re
from bisect import bisect
from contextlib import suppress
from http import HTTPStatus
from typing import Any

from grader.classroom.gradebook import Gradebook
from grader.classroom.marks import is_open_in_libreoffice
from grader.classroom.review_items import STATES, ReviewFilter
from grader.commands.grade_class import write_grades
from grader.commands.local_server import SANDBOX, LocalServer, Response
from grader.commands.review_pictures import open_item
from grader.commands.review_session import ReviewSession
from grader.commands.terminal import Terminal
from grader.documents.pictures import PDF, EmbeddedPicture
from grader.errors import GraderError
from grader.report.pages import review as pages
from grader.text import counted, printable_path

_PAGE_POLICY = "frame-ancestors 'none'"  # the page itself contains the rest
_PDF_POLICY = "default-src 'none'; frame-ancestors 'self'"
_CHANGED = "Not saved: this item has changed since it was shown. Look at it again."


class ReviewPage:
    """The application of the server: shows items of a session by number, and executes actions from the page."""

    def __init__(self, session: ReviewSession) -> None:
        self.session = session

    def __call__(self, path: tuple[str, ...], body: bytes | None) -> Response:
        """Return the response to a request; errors of the gradebook become messages."""
        at = self._position(path[0])
        try:
            self.session.refresh()
            return self._page(at, path) if body is None else self._act(at, body)
        except GraderError as error:
            if body is not None:
                return _json(error=str(error))
            page = pages.error_page(str(error), self.address(self.session.following(at)))
            return _html(page, HTTPStatus.SERVICE_UNAVAILABLE)

    def _page(self, at: int, path: tuple[str, ...]) -> Response:
        session, book = self.session, self.session.book
        is_item = 0 <= at < len(session.places)
        match path:
            case ("end",):
                given = sum(mark.points is not None for mark in session.own.values())
                return _html(pages.end_page(given, session.left, self._place(at), printable_path(session.folder)))
            case (_,) if is_item:
                item = session.item_at(at)
                return _html(pages.item_page(item, open_item(book, item), self._place(at)))
            case (_, "picture", number) if is_item:
                pictures = enumerate(open_item(book, session.item_at(at)).pictures, 1)
                found = {str(which): one for which, one in pictures}.get(number)
                if isinstance(found, EmbeddedPicture):
                    return Response(
                        found.data, found.kind.media_type, policy=_PDF_POLICY if found.kind is PDF else SANDBOX
                    )
        return Response(b"not found\n", status=HTTPStatus.NOT_FOUND)

    def _place(self, at: int) -> dict[str, Any]:
        session, listed = self.session, self.session.listed
        questions = [*dict.fromkeys(criterion for criterion, _ in session.items)]
        filters = pages.filters(session.filter, questions, sorted(session.sections.values()))
        return {"number": bisect(listed, at), "total": len(listed), "address": self.address(at), "filters": filters}

    def _act(self, at: int, body: bytes) -> Response:
        """Execute an action of the page."""
        session, sent = self.session, None
        with suppress(ValueError, RecursionError):
            sent = json.loads(body)
        match sent if at >= 0 else None:
            case {"do": "mark", "points": str(points), "comment": str(comment), "shown": str(shown)} if at < len(
                session.places
            ):
                return self._mark(at, points, comment.strip(), shown)
            case {"do": "filter", "criterion": str(criterion), "section": str(section), "state": str(state)} if (
                state in STATES
            ):
                session.show_only(ReviewFilter(criterion, section, state))
                at = session.following()
            case {"do": "again"}:
                session.show_only(session.filter)
                at = session.following()
            case {"do": "back"}:
                at = session.previous(at)
            case {"do": "next"}:
                at = session.following(at)
            case _:
                return _json(HTTPStatus.BAD_REQUEST, error="this request is not from the page")
        return _json(go=self.address(at))

    def _mark(self, at: int, points: str, comment: str, shown: str) -> Response:
        """Save a mark, or return those of others that it would replace."""
        session = self.session
        open_item(session.book, session.item_at(at))  # what has moved or changed cannot be marked
        replaced = session.mark(at, points, comment, shown)
        if replaced:
            more = f" (and {counted(len(replaced) - 1, 'more mark')})" if len(replaced) > 1 else ""
            return _json(newer=pages.mark_text(replaced[0]) + more)
        if replaced is None:
            return _json(error=_CHANGED, go=self.address(at))
        return _json(go=self.address(session.following(at)))

    def address(self, at: int) -> str:
        """Return the address of an item below that of the server."""
        return str(at + 1) if at < len(self.session.places) else "end"

    def _position(self, address: str) -> int:
        """Return the position of an item, beyond the last one for the end; -1 if there is none."""
        count = len(self.session.places)
        at = int(address) if re.fullmatch("[1-9][0-9]{0,7}", address) else 0
        return count if address == "end" else at - 1 if at <= count else -1


def _html(page: str, status: HTTPStatus = HTTPStatus.OK) -> Response:
    return Response(page.encode("utf-8", "backslashreplace"), "text/html; charset=utf-8", status, policy=_PAGE_POLICY)


def _json(status: HTTPStatus = HTTPStatus.OK, **answer: str) -> Response:
    return Response(json.dumps(answer).encode(), "application/json", status)


def review_in_browser(session: ReviewSession, port: int, terminal: Terminal) -> str:
    """Serve the review page until Ctrl-C, write the grades, and return a summary. Raises InputError."""
    if not session.places:
        return "nothing needs manual grading\n"
    page = ReviewPage(session)
    with LocalServer(page, port) as server:
        if is_open_in_libreoffice(session.file):
            shown = printable_path(session.file)
            terminal.warn(f"{shown} is open in LibreOffice: close it, because saving it there would remove new marks")
        with suppress(KeyboardInterrupt):
            terminal.print(f"{server.url}{page.address(session.following())}\n")
            terminal.warn("open this address in a browser on this machine; Ctrl-C ends the review, all marks are kept")
            server.serve_forever()
    write_grades(Gradebook(session.folder))
    return f"{len(session.own)} marked, {session.left} left\n"
