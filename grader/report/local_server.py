"""A server of pages for one person on this machine, until Ctrl-C.

It is bound to the loopback address, with a secret in the path of every address. Requests without
the secret are refused. Requests of other websites are refused as well: the server accepts only its
own host name, and only JSON from its own origin.
"""

import hmac
import json
import re
import secrets
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler
from pathlib import Path
from socket import SHUT_RD, socket
from socketserver import ThreadingTCPServer
from threading import Timer
from typing import Any, NamedTuple

from grader import __version__
from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.text import printable
from grader.report.open_browser import opened_in_browser
from grader.report.writing import Terminal

HOST = "127.0.0.1"
_ENDINGS = [
    getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)
]  # end it as Ctrl-C does
MAX_BODY = 64 * 1024  # bytes; `http.server` limits the headers
# seconds in which a client must send a whole request, and receive a whole response
_PATIENCE = 15.0
_MOST_OPEN = 64  # connections: a browser opens six, and each takes a thread and a descriptor
_TEXT = "text/plain; charset=utf-8"
_TOKEN_BYTES = 24
_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "X-Frame-Options": "DENY",
}
SANDBOX = "sandbox; default-src 'none'"  # for everything that is not a page
_PAGE_POLICY = "frame-ancestors 'none'"  # the page itself contains the rest


class Response(NamedTuple):
    """What a server answers a request."""

    body: bytes
    media_type: str = _TEXT
    status: HTTPStatus = HTTPStatus.OK
    policy: str = SANDBOX


class _RefusedError(Exception):
    """A request that is refused with a status, and why."""


class LocalServer(ThreadingTCPServer):
    """Serves an application until it is interrupted. `url` is the address with its secret.

    The application gets the parts of the path after the secret, and the body of a POST, of several
    requests at once.

    Raises InputError if the port is taken.
    """

    daemon_threads = True  # a slow client does not delay the end of the server
    allow_reuse_address = True
    request_queue_size = 64

    def __init__(
        self,
        application: Callable[[Strings, bytes | None], Response],
        port: int = 0,
        max_body: int = MAX_BODY,
    ) -> None:
        self.application = application
        self.max_body = max_body
        self._open: dict[socket, None] = {}  # the oldest first
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

    def process_request(self, request: Any, client_address: Any) -> None:
        """Serve a connection in a thread; of too many, no more is read of the oldest."""
        self._open[request] = None
        for oldest in list(self._open)[:-_MOST_OPEN]:
            _stop_reading(oldest)
        super().process_request(request, client_address)

    def shutdown_request(self, request: Any) -> None:
        """Close a connection."""
        self._open.pop(request, None)
        super().shutdown_request(request)

    def finish_request(self, request: Any, client_address: Any) -> None:
        """Serve a connection.

        The whole request must arrive in time, however slowly its bytes do.
        """
        timer = Timer(_PATIENCE, _stop_reading, [request])
        timer.daemon = True
        timer.start()
        super().finish_request(request, client_address)
        timer.cancel()

    def answer(self, path: Strings, body: bytes | None) -> Response:
        """Return the response of the application; a fault of it is one line."""
        try:
            return self.application(path, body)
        except Exception as error:  # noqa: BLE001  no traceback ever reaches a user
            if isinstance(error, OSError):
                reason = error.strerror
            else:
                reason = f"{type(error).__name__}: {error}"
            message = printable(f"the grader failed on this request: {reason}")
            return Response(f"{message}\n".encode(), status=HTTPStatus.INTERNAL_SERVER_ERROR)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Ignore errors of broken connections."""


def _stop_reading(connection: socket) -> None:
    with suppress(OSError):  # it has ended
        connection.shutdown(SHUT_RD)


class _Handler(BaseHTTPRequestHandler):
    """Reads one request of a connection (HTTP/1.0), and answers it."""

    server: LocalServer
    server_version = f"grader/{__version__}"
    sys_version = ""
    timeout = _PATIENCE
    policy = SANDBOX

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

    def _path(self) -> Strings:
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
        own_origin = f"http://{self.headers['Host'].lower()}"
        if (
            self.headers.get("Origin") != own_origin
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
        most = self.server.max_body
        if len(length) > 9 or int(length) > most:
            raise _RefusedError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"at most {most} bytes")
        return self.rfile.read(int(length))

    def end_headers(self) -> None:
        """End the headers, which protect every answer."""
        for name, value in {**_HEADERS, "Content-Security-Policy": self.policy}.items():
            self.send_header(name, value)
        super().end_headers()

    def log_message(self, format: str, *arguments: Any) -> None:  # noqa: A002  the name of the base class
        """Log nothing: addresses contain the secret."""


def html_response(page: str, status: HTTPStatus = HTTPStatus.OK) -> Response:
    """Return a page as a response."""
    return Response(
        page.encode("utf-8", "backslashreplace"),
        "text/html; charset=utf-8",
        status,
        policy=_PAGE_POLICY,
    )


def json_response(status: HTTPStatus = HTTPStatus.OK, **answer: object) -> Response:
    """Return an object of JSON as a response."""
    return Response(json.dumps(answer).encode(), "application/json", status)


@contextmanager
def shown_until_interrupted(
    address: str, file: Path, terminal: Terminal, ending: str, *, opens: bool = True
) -> Iterator[None]:
    """Print the address of a server, and open it in the browser while a block runs.

    Ctrl-C or a signal ends the block.

    Args:
        address: The address of a page, with its secret.
        file: The file that leads the browser to the address, while the block runs.
        terminal: Where the address is printed.
        ending: What Ctrl-C does, for a sentence on standard error.
        opens: Whether to open the browser.
    """
    for number in _ENDINGS:
        if signal.getsignal(number) is signal.SIG_DFL:  # else it is ignored, as after nohup
            signal.signal(number, signal.default_int_handler)
    with suppress(KeyboardInterrupt):
        terminal.print(f"{address}\n")
        with opened_in_browser(address, file) if opens else nullcontext(False) as is_open:
            if is_open:
                how = "the page opens in the browser"
            else:
                how = "open this address in a browser on this machine"
            terminal.warn(f"{how}; {ending}")
            yield
