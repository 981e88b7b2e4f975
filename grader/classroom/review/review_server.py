"""Grade what needs manual grading on a page in the browser, item by item.

A server on this machine serves the page.

It answers one request at a time, so that nothing is written concurrently.
"""

import json
import re
from bisect import bisect
from collections.abc import Mapping, Sequence
from contextlib import suppress
from http import HTTPStatus
from threading import Lock
from typing import Any

from grader.base.errors import GraderError
from grader.base.text import counted, printable_path
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades_file import write_grades
from grader.classroom.gradebook.review_items import STATES, ReviewFilter
from grader.classroom.marks.gradebook_folder import warn_without_locks
from grader.classroom.marks.marks import is_open_in_libreoffice
from grader.classroom.review import review_pages as pages
from grader.classroom.review.opened_item import open_item
from grader.classroom.review.review_session import ReviewSession
from grader.lab.documents.pictures import PDF, EmbeddedPicture
from grader.report.local_server import (
    SANDBOX,
    LocalServer,
    Response,
    html_response,
    json_response,
    shown_until_interrupted,
)
from grader.report.writing import Terminal

_MAX_SIMILAR = 20  # answers on a page
_LINK = "open-review.html"  # in the gradebook, while the server runs
_CHANGED = "Not saved: this item has changed since it was shown. Look at it again."


class ReviewPage:
    """The application of the server.

    It shows items of a session by number, and executes actions from the page.
    """

    def __init__(self, session: ReviewSession) -> None:
        self.session = session
        self._lock = Lock()

    def __call__(self, path: Sequence[str], body: bytes | None) -> Response:
        """Return the response to a request; errors of the gradebook become messages."""
        with self._lock:
            return self._answer(path, body)

    def _answer(self, path: Sequence[str], body: bytes | None) -> Response:
        at = self._position(path[0])
        try:
            self.session.refresh()
            if body is None:
                return self._page(at, path)
            return self._act(at, body)
        except GraderError as error:
            if body is not None:
                return json_response(error=str(error))
            page = pages.error_page(str(error), self.address(self.session.following(at)))
            return html_response(page, HTTPStatus.SERVICE_UNAVAILABLE)

    def _page(self, at: int, path: Sequence[str]) -> Response:
        session = self.session
        is_item = 0 <= at < len(session.places)
        match path:
            case ("end",):
                return html_response(self._end_page(at))
            case (_, "people") if at >= 0:
                people = [(label, left, self.address(to)) for label, left, to in session.people(at)]
                return json_response(people=people)
            case (_,) if is_item:
                item = session.item_at(at)
                place = self._place(at) | {"so_far": session.so_far(item)}
                similar_items = session.similar(at)[:_MAX_SIMILAR]
                similar = {self.address(one.position): one for one in similar_items}
                return html_response(
                    pages.item_page(item, open_item(session.book, item), place, similar)
                )
            case (_, "picture", number) if is_item:
                pictures = enumerate(open_item(session.book, session.item_at(at)).pictures, 1)
                picture = {str(which): picture for which, picture in pictures}.get(number)
                if isinstance(picture, EmbeddedPicture):
                    policy = (
                        "default-src 'none'; frame-ancestors 'self'"
                        if picture.kind is PDF
                        else SANDBOX
                    )
                    return Response(picture.data, picture.kind.media_type, policy=policy)
        return Response(b"not found\n", status=HTTPStatus.NOT_FOUND)

    def _end_page(self, at: int) -> str:
        session = self.session
        given = sum(mark.points is not None for mark in session.own.values())
        folder = printable_path(session.folder)
        return pages.end_page(given, session.left, self._place(at), folder, session.lms)

    def _place(self, at: int) -> dict[str, Any]:
        session = self.session
        listed = self.session.listed
        questions = list(dict.fromkeys(criterion for criterion, _ in session.items))
        filters = pages.filters(session.filter, questions, sorted(session.sections.values()))
        return {
            "number": bisect(listed, at),
            "total": len(listed),
            "address": self.address(at),
            "filters": filters,
        }

    def _act(self, at: int, body: bytes) -> Response:
        """Execute an action of the page."""
        session = self.session
        sent = None
        with suppress(ValueError, RecursionError):
            sent = json.loads(body)
        match sent if at >= 0 else None:
            case {
                "do": "mark",
                "points": str(points),
                "comment": str(comment),
                "shown": str(shown),
                **more,
            } if at < len(session.places):
                return self._mark(at, points, comment.strip(), shown, more)
            case {
                "do": "filter",
                "criterion": str(criterion),
                "section": str(section),
                "state": str(state),
            } if state in STATES:
                session.show_only(ReviewFilter(criterion, section, state))
                at = session.following()
            case {"do": "again"}:
                session.show_only(session.filter)
                at = session.following()
            case {"do": "back"}:
                at = session.previous(at)
            case {"do": "next"}:
                at = session.following(at)
            case {"do": "question"}:
                at = session.next_question(at)
            case {"do": "go", "to": str(address)} if self._position(address) >= 0:
                at = self._position(address)
            case _:
                return json_response(
                    HTTPStatus.BAD_REQUEST, error="this request is not from the page"
                )
        return json_response(go=self.address(at))

    def _mark(
        self, at: int, points: str, comment: str, shown: str, sent: Mapping[Any, Any]
    ) -> Response:
        """Save a mark, or return those of others that it would replace.

        Of what is sent besides, `to` is `question` for the next one of the student, and `similar`
        has the addresses and views of items that get the same mark.
        """
        session = self.session
        to = sent.get("to")
        given = sent.get("similar")
        similar = []
        for address, view in given.items() if isinstance(given, dict) else ():
            similar.append((self._position(address), str(view)))
        for position in (at, *(position for position, _ in similar)):
            if not 0 <= position < len(session.places):
                return json_response(error=_CHANGED, go=self.address(at))
            open_item(session.book, session.item_at(position))  # not what has moved or changed
        replaced = session.mark(at, points, comment, shown, similar)
        if replaced:
            more = f" (and {counted(len(replaced) - 1, 'more mark')})" if len(replaced) > 1 else ""
            return json_response(newer=pages.mark_text(replaced[0]) + more)
        if replaced is None:
            return json_response(error=_CHANGED, go=self.address(at))
        if to == "question":
            return json_response(go=self.address(session.next_question(at)))
        following = session.following(at)
        while following in dict(similar):
            following = session.following(following)
        return json_response(go=self.address(following))

    def address(self, at: int) -> str:
        """Return the address of an item below that of the server."""
        if at < len(self.session.places):
            return str(at + 1)
        return "end"

    def _position(self, address: str) -> int:
        """Return the position of an item, beyond the last one for the end; -1 if there is none."""
        count = len(self.session.places)
        if address == "end":
            return count
        at = int(address) if re.fullmatch("[1-9][0-9]{0,7}", address) else 0
        if at <= count:
            return at - 1
        return -1


def review_in_browser(
    session: ReviewSession, port: int, terminal: Terminal, *, opens: bool = True
) -> str:
    """Serve the review page until Ctrl-C, write the grades, and return a summary.

    It `opens` the page in the browser.

    Raises InputError.
    """
    if not session.places:
        return "nothing needs manual grading\n"
    warn_without_locks(session.folder, terminal.warn)
    page = ReviewPage(session)
    marks = session.file
    with LocalServer(page, port) as server:
        if is_open_in_libreoffice(marks):
            shown = printable_path(marks)
            terminal.warn(
                f"{shown} is open in LibreOffice: close it, because saving it there would "
                "remove new marks"
            )
        address = f"{server.url}{page.address(session.following())}"
        file = session.folder / _LINK
        ending = "Ctrl-C ends the review, all marks are kept"
        with shown_until_interrupted(address, file, terminal, ending, opens=opens):
            server.serve_forever()
    write_grades(Gradebook(session.folder))
    need = "needs" if session.left == 1 else "need"
    return f"{len(session.own)} marked, {session.left} still {need} manual grading\n"
