"""Grade what needs manual grading on a page in the browser, item by item, which a server on this
machine serves.

The server is for one person: bound to the loopback address, with a secret in the path of every
address. Requests without the secret are refused. Requests of other websites are refused as well:
the server accepts only its own host name, and only JSON from its own origin. It answers one request
at a time, so that nothing is written concurrently.
"""

import hmac
import json
import re
import secrets
import signal
from bisect import bisect
from collections.abc import Callable, Mapping
from contextlib import nullcontext, suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler
from socket import SHUT_RD, socket
from socketserver import ThreadingTCPServer
from threading import Lock, Timer
from typing import Any, NamedTuple

from grader import __version__
from grader.base.errors import GraderError, InputError
from grader.base.text import counted, printable, printable_path
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades_file import write_grades
from grader.classroom.gradebook.review_items import STATES, ReviewFilter
from grader.classroom.marks.marks import is_open_in_libreoffice
from grader.classroom.review import review_pages as pages
from grader.classroom.review.opened_item import open_item
from grader.classroom.review.review_session import ReviewSession
from grader.lab.documents.pictures import PDF, EmbeddedPicture
from grader.report.open_browser import opened_in_browser
from grader.report.writing import Terminal

HOST = "127.0.0.1"
_ENDINGS = [
    getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)
]  # end it as Ctrl-C does
MAX_BODY = 64 * 1024  # bytes; `http.server` limits the headers
# seconds in which a client must send a whole request, and receive a whole response
_PATIENCE = 15.0
_TEXT = "text/plain; charset=utf-8"
_TOKEN_BYTES = 24
_MAX_SIMILAR = 20  # answers on a page
_LINK = "open-review.html"  # in the gradebook, while the server runs
_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "X-Frame-Options": "DENY",
}
_SANDBOX = "sandbox; default-src 'none'"  # for everything that is not a page
_PAGE_POLICY = "frame-ancestors 'none'"  # the page itself contains the rest
_PDF_POLICY = "default-src 'none'; frame-ancestors 'self'"
_CHANGED = "Not saved: this item has changed since it was shown. Look at it again."


class _Response(NamedTuple):
    """A response."""

    body: bytes
    media_type: str = _TEXT
    status: HTTPStatus = HTTPStatus.OK
    policy: str = _SANDBOX


class _RefusedError(Exception):
    """A request that is refused with a status, and why."""


class LocalServer(ThreadingTCPServer):
    """Serves an application until it is interrupted. `url` is the address with its secret.

    The application gets the parts of the path after the secret, and the body of a POST.

    Raises InputError if the port is taken.
    """

    daemon_threads = True  # a slow client does not delay the end of the server
    allow_reuse_address = True
    request_queue_size = 64

    def __init__(
        self, application: Callable[[tuple[str, ...], bytes | None], _Response], port: int = 0
    ) -> None:
        self.application, self.lock = application, Lock()
        self.token = secrets.token_urlsafe(_TOKEN_BYTES)
        try:
            super().__init__((HOST, port), _Handler)
        except OSError as error:
            raise InputError(
                f"cannot listen on port {port} of {HOST}: {error.strerror}; name another --port"
            ) from None
        self.port = int(self.server_address[1])
        self.hosts = tuple(f"{name}:{self.port}" for name in (HOST, "localhost"))
        self.url = f"http://{self.hosts[0]}/{self.token}/"

    def finish_request(self, request: Any, client_address: Any) -> None:
        """Serve a connection; the whole request must arrive in time, however slowly its bytes
        do.
        """
        timer = Timer(_PATIENCE, _stop_reading, [request])
        timer.daemon = True
        timer.start()
        super().finish_request(request, client_address)
        timer.cancel()

    def answer(self, path: tuple[str, ...], body: bytes | None) -> _Response:
        """Return the response of the application; a fault of it is one line."""
        try:
            with self.lock:
                return self.application(path, body)
        except Exception as error:  # noqa: BLE001  no traceback ever reaches a user
            if isinstance(error, OSError):
                reason = error.strerror
            else:
                reason = f"{type(error).__name__}: {error}"
            message = printable(f"the grader failed on this request: {reason}")
            return _Response(f"{message}\n".encode(), status=HTTPStatus.INTERNAL_SERVER_ERROR)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Ignore errors of broken connections."""


def _stop_reading(connection: socket) -> None:
    with suppress(OSError):  # it has ended
        connection.shutdown(SHUT_RD)


class _Handler(BaseHTTPRequestHandler):
    """Reads one request of a connection (HTTP/1.0), and answers it."""

    server: LocalServer
    server_version, sys_version = f"grader/{__version__}", ""
    timeout, policy = _PATIENCE, _SANDBOX

    def do_GET(self) -> None:
        """Answer a request: one with a body is from the page, which may change something."""
        try:
            path = self._path()
            body = self._body() if self.command == "POST" else None
        except _RefusedError as error:
            self.send_error(*error.args)
            return
        response = self.server.answer(path, body)
        self.policy = response.policy
        self.send_response(response.status)
        self.send_header("Content-Type", response.media_type)
        self.send_header("Content-Length", str(len(response.body)))
        self.end_headers()
        self.wfile.write(response.body)

    do_POST = do_GET  # noqa: N815  the name of the base class

    def _path(self) -> tuple[str, ...]:
        """Return the path after the secret."""
        if (
            len(self.headers.get_all("Host", [])) != 1
            or self.headers["Host"].lower() not in self.server.hosts
        ):
            raise _RefusedError(
                HTTPStatus.MISDIRECTED_REQUEST, "wrong host name: use the address of the command"
            )
        if self.path == "/favicon.ico":  # every browser asks for it
            raise _RefusedError(HTTPStatus.NO_CONTENT)
        first, *rest = self.path.partition("?")[0].removeprefix("/").split("/")
        if not hmac.compare_digest(first.encode(), self.server.token.encode()) or not rest:
            raise _RefusedError(
                HTTPStatus.NOT_FOUND,
                "not found: use the whole address that the command has printed",
            )
        return tuple(rest)

    def _body(self) -> bytes:
        """Return the body of a request, which must be JSON from the page."""
        own = f"http://{self.headers['Host'].lower()}"
        if (
            self.headers.get("Origin") != own
            or self.headers.get("Sec-Fetch-Site", "same-origin") != "same-origin"
        ):
            raise _RefusedError(HTTPStatus.FORBIDDEN, "this request is not from the page")
        if self.headers.get_content_type() != "application/json":
            raise _RefusedError(
                HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "the content type must be application/json"
            )
        length = self.headers.get("Content-Length", "")
        if not re.fullmatch("[0-9]+", length):
            raise _RefusedError(HTTPStatus.LENGTH_REQUIRED, "the header Content-Length is missing")
        if len(length) > 9 or int(length) > MAX_BODY:
            raise _RefusedError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"at most {MAX_BODY} bytes")
        return self.rfile.read(int(length))

    def end_headers(self) -> None:
        """End the headers, which protect every answer."""
        for name, value in {**_HEADERS, "Content-Security-Policy": self.policy}.items():
            self.send_header(name, value)
        super().end_headers()

    def log_message(self, format: str, *arguments: Any) -> None:  # noqa: A002  the name of the base class
        """Log nothing: addresses contain the secret."""


class ReviewPage:
    """The application of the server: shows items of a session by number, and executes actions from
    the page.
    """

    def __init__(self, session: ReviewSession) -> None:
        self.session = session

    def __call__(self, path: tuple[str, ...], body: bytes | None) -> _Response:
        """Return the response to a request; errors of the gradebook become messages."""
        at = self._position(path[0])
        try:
            self.session.refresh()
            if body is None:
                return self._page(at, path)
            return self._act(at, body)
        except GraderError as error:
            if body is not None:
                return _json(error=str(error))
            page = pages.error_page(str(error), self.address(self.session.following(at)))
            return _html(page, HTTPStatus.SERVICE_UNAVAILABLE)

    def _page(self, at: int, path: tuple[str, ...]) -> _Response:
        session = self.session
        is_item = 0 <= at < len(session.places)
        match path:
            case ("end",):
                return _html(self._end_page(at))
            case (_, "people") if at >= 0:
                people = [(label, left, self.address(to)) for label, left, to in session.people(at)]
                return _json(people=people)
            case (_,) if is_item:
                item = session.item_at(at)
                place = self._place(at) | {"so_far": session.so_far(item)}
                found = session.similar(at)[:_MAX_SIMILAR]
                similar = {self.address(one.position): one for one in found}
                return _html(pages.item_page(item, open_item(session.book, item), place, similar))
            case (_, "picture", number) if is_item:
                pictures = enumerate(open_item(session.book, session.item_at(at)).pictures, 1)
                picture = {str(which): picture for which, picture in pictures}.get(number)
                if isinstance(picture, EmbeddedPicture):
                    policy = _PDF_POLICY if picture.kind is PDF else _SANDBOX
                    return _Response(picture.data, picture.kind.media_type, policy=policy)
        return _Response(b"not found\n", status=HTTPStatus.NOT_FOUND)

    def _end_page(self, at: int) -> str:
        session = self.session
        given = sum(mark.points is not None for mark in session.own.values())
        folder = printable_path(session.folder)
        return pages.end_page(given, session.left, self._place(at), folder, session.lms)

    def _place(self, at: int) -> dict[str, Any]:
        session, listed = self.session, self.session.listed
        questions = [*dict.fromkeys(criterion for criterion, _ in session.items)]
        filters = pages.filters(session.filter, questions, sorted(session.sections.values()))
        return {
            "number": bisect(listed, at),
            "total": len(listed),
            "address": self.address(at),
            "filters": filters,
        }

    def _act(self, at: int, body: bytes) -> _Response:
        """Execute an action of the page."""
        session, sent = self.session, None
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
                return _json(HTTPStatus.BAD_REQUEST, error="this request is not from the page")
        return _json(go=self.address(at))

    def _mark(
        self, at: int, points: str, comment: str, shown: str, sent: Mapping[Any, Any]
    ) -> _Response:
        """Save a mark, or return those of others that it would replace.

        Of what is sent besides, `to` is `question` for the next one of the student, and `similar`
        has the addresses and views of items that get the same mark.
        """
        session, to = self.session, sent.get("to")
        given, similar = sent.get("similar"), []
        for address, view in given.items() if isinstance(given, dict) else ():
            similar.append((self._position(address), str(view)))
        for position in (at, *(position for position, _ in similar)):
            if not 0 <= position < len(session.places):
                return _json(error=_CHANGED, go=self.address(at))
            open_item(session.book, session.item_at(position))  # not what has moved or changed
        replaced = session.mark(at, points, comment, shown, similar)
        if replaced:
            more = f" (and {counted(len(replaced) - 1, 'more mark')})" if len(replaced) > 1 else ""
            return _json(newer=pages.mark_text(replaced[0]) + more)
        if replaced is None:
            return _json(error=_CHANGED, go=self.address(at))
        if to == "question":
            return _json(go=self.address(session.next_question(at)))
        following = session.following(at)
        while following in dict(similar):
            following = session.following(following)
        return _json(go=self.address(following))

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


def _html(page: str, status: HTTPStatus = HTTPStatus.OK) -> _Response:
    return _Response(
        page.encode("utf-8", "backslashreplace"),
        "text/html; charset=utf-8",
        status,
        policy=_PAGE_POLICY,
    )


def _json(status: HTTPStatus = HTTPStatus.OK, **answer: object) -> _Response:
    return _Response(json.dumps(answer).encode(), "application/json", status)


def review_in_browser(
    session: ReviewSession, port: int, terminal: Terminal, *, opens: bool = True
) -> str:
    """Serve the review page until Ctrl-C, write the grades, and return a summary; it `opens` the
    page in the browser.

    Raises InputError.
    """
    if not session.places:
        return "nothing needs manual grading\n"
    page = ReviewPage(session)
    with LocalServer(page, port) as server:
        if is_open_in_libreoffice(session.file):
            shown = printable_path(session.file)
            terminal.warn(
                f"{shown} is open in LibreOffice: close it, because saving it there would "
                "remove new marks"
            )
        address = f"{server.url}{page.address(session.following())}"
        for number in _ENDINGS:
            if signal.getsignal(number) is signal.SIG_DFL:  # else it is ignored, as after nohup
                signal.signal(number, signal.default_int_handler)
        with suppress(KeyboardInterrupt):
            terminal.print(f"{address}\n")
            with (
                opened_in_browser(address, session.folder / _LINK)
                if opens
                else nullcontext(False) as is_open
            ):
                if is_open:
                    how = "the page opens in the browser"
                else:
                    how = "open this address in a browser on this machine"
                terminal.warn(f"{how}; Ctrl-C ends the review, all marks are kept")
                server.serve_forever()
    write_grades(Gradebook(session.folder))
    return f"{len(session.own)} marked, {session.left} left\n"
