"""A server for one person on this machine: bound to the loopback address, with a secret in the path of every address.

Requests without the secret are refused. Requests of other websites are refused as well: the server accepts only its own
host name, and only JSON from its own origin. One thread does all the work, so that nothing is written concurrently.
"""

import hmac
import secrets
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from io import BufferedReader
from socket import SHUT_RDWR, SocketIO, socket
from threading import Lock
from time import monotonic
from typing import Any, NamedTuple

from grader import __version__
from grader.errors import InputError
from grader.text import printable

HOST = "127.0.0.1"
MAX_BODY = 64 * 1024  # bytes
MAX_REQUEST = 2 * MAX_BODY  # bytes, with the headers
MAX_UNAUTHENTICATED = 64  # connections that have not sent the secret yet
PATIENCE = 15.0  # seconds in which a client must send a whole request, and receive a whole response
TEXT = "text/plain; charset=utf-8"
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


class Request(NamedTuple):
    """A request: the parts of the path after the secret, and the body of a POST."""

    path: tuple[str, ...]
    body: bytes | None = None


class Response(NamedTuple):
    """A response. `location` is the path of a redirect, after the secret."""

    body: bytes
    media_type: str = TEXT
    status: HTTPStatus = HTTPStatus.OK
    location: str | None = None
    policy: str = SANDBOX


Application = Callable[[Request], Response]


class _RefusedError(Exception):
    """A request that is refused."""

    def __init__(self, status: HTTPStatus, why: str) -> None:
        super().__init__(why)
        self.status = status


class LocalServer(ThreadingHTTPServer):
    """Serves an application until it is interrupted. `url` is the address with its secret; `worker` is the one thread.

    Raises InputError if the port is taken.
    """

    daemon_threads = True  # a slow client does not delay the end of the server
    allow_reuse_address = True
    request_queue_size = MAX_UNAUTHENTICATED

    def __init__(self, application: Application, worker: ThreadPoolExecutor, port: int = 0) -> None:
        self.application, self.worker = application, worker
        self.token = secrets.token_urlsafe(_TOKEN_BYTES)
        self._unauthenticated: dict[socket, None] = {}  # the oldest one first
        self._lock = Lock()
        try:
            super().__init__((HOST, port), _Handler)
        except (OSError, OverflowError) as error:
            reason = error.strerror if isinstance(error, OSError) else str(error)
            raise InputError(f"cannot listen on port {port} of {HOST}: {reason}; name another --port") from None
        self.hosts = tuple(f"{name}:{self.server_port}" for name in (HOST, "localhost"))
        self.url = f"http://{self.hosts[0]}/{self.token}/"

    def server_bind(self) -> None:
        """Bind the socket, without a lookup of the machine's name."""
        self.socket.bind(self.server_address)
        self.server_address = self.socket.getsockname()
        self.server_name, self.server_port = HOST, int(self.server_address[1])

    def process_request(self, request: Any, client_address: Any) -> None:
        """Serve a connection in its own thread; of too many without the secret, the oldest one is disconnected."""
        with self._lock:
            if len(self._unauthenticated) >= MAX_UNAUTHENTICATED:
                oldest = next(iter(self._unauthenticated))
                del self._unauthenticated[oldest]
                with suppress(OSError):  # it has ended
                    oldest.shutdown(SHUT_RDWR)
            self._unauthenticated[request] = None
        super().process_request(request, client_address)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Serve a connection."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self.authenticated(request)

    def authenticated(self, connection: socket) -> None:
        """Count a connection no longer among those without the secret."""
        with self._lock:
            self._unauthenticated.pop(connection, None)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Ignore errors of broken connections."""


class _Requests(SocketIO):
    """What a client sends: each request within a limit of time and size, however slowly its bytes arrive."""

    def __init__(self, connection: socket) -> None:
        super().__init__(connection, "r")
        self._connection = connection
        self.begin()

    def begin(self) -> None:
        """Begin a request."""
        self._deadline, self._left = monotonic() + PATIENCE, MAX_REQUEST

    def readinto(self, buffer: Any) -> int | None:
        """Read what has arrived. Raises TimeoutError beyond a limit."""
        seconds = self._deadline - monotonic()
        if seconds <= 0 or self._left <= 0:
            raise TimeoutError
        self._connection.settimeout(seconds)
        number = super().readinto(buffer)
        self._connection.settimeout(PATIENCE)  # of a response, as a whole
        self._left -= number or 0
        return number


class _Handler(BaseHTTPRequestHandler):
    server: LocalServer
    protocol_version = "HTTP/1.1"
    server_version, sys_version = f"grader/{__version__}", ""

    def setup(self) -> None:
        """Bound what the client sends."""
        super().setup()
        self._requests = _Requests(self.connection)
        self.rfile = BufferedReader(self._requests)

    def handle_one_request(self) -> None:
        """Answer the next request of a connection."""
        self._requests.begin()
        super().handle_one_request()

    def do_GET(self) -> None:
        """Answer a request that changes nothing; HEAD without the body."""
        self._serve(has_body=False)

    do_HEAD = do_GET  # noqa: N815  the name of the base class

    def do_POST(self) -> None:
        """Answer a request from the page."""
        self._serve(has_body=True)

    def _serve(self, *, has_body: bool) -> None:
        try:
            request = Request(self._path(), self._body() if has_body else None)
        except _RefusedError as error:
            self._refuse(error.status, str(error))
        else:
            self._send(self._answer(request))

    def _path(self) -> tuple[str, ...]:
        """Return the path after the secret."""
        if len(self.headers.get_all("Host", [])) != 1 or self.headers["Host"].lower() not in self.server.hosts:
            raise _RefusedError(
                HTTPStatus.MISDIRECTED_REQUEST, "wrong host name: use the address that the command has printed"
            )
        if self.path == "/favicon.ico":  # every browser asks for it
            raise _RefusedError(HTTPStatus.OK, "")
        first, *rest = self.path.partition("?")[0].removeprefix("/").split("/")
        if not hmac.compare_digest(first.encode(), self.server.token.encode()) or not rest:
            raise _RefusedError(HTTPStatus.NOT_FOUND, "not found: use the whole address that the command has printed")
        self.server.authenticated(self.connection)
        return tuple(rest)

    def _body(self) -> bytes:
        """Return the body of a request, which must be JSON from the page."""
        own = f"http://{self.headers['Host'].lower()}"
        if self.headers.get("Origin") != own or self.headers.get("Sec-Fetch-Site", "same-origin") != "same-origin":
            raise _RefusedError(HTTPStatus.FORBIDDEN, "this request is not from the page")
        if self.headers.get_content_type() != "application/json":
            raise _RefusedError(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "the content type must be application/json")
        length = self.headers.get("Content-Length", "")
        if "Transfer-Encoding" in self.headers or not (length.isascii() and length.isdigit()):
            raise _RefusedError(HTTPStatus.LENGTH_REQUIRED, "the header Content-Length is missing")
        if len(length) > 9 or int(length) > MAX_BODY:
            raise _RefusedError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"at most {MAX_BODY} bytes")
        return self.rfile.read(int(length))

    def _answer(self, request: Request) -> Response:
        try:
            return self.server.worker.submit(self.server.application, request).result()
        except Exception as error:  # noqa: BLE001  no traceback ever reaches a user
            message = printable(f"the grader failed on this request: {type(error).__name__}: {error}")
            return Response(f"{message}\n".encode(), status=HTTPStatus.INTERNAL_SERVER_ERROR)

    def _refuse(self, status: HTTPStatus, why: str) -> None:
        self.close_connection = True  # a body may be unread
        self._send(Response(f"{why}\n".encode(), status=status))

    def _send(self, response: Response) -> None:
        self.send_response(response.status)
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        self.send_header("Content-Security-Policy", response.policy)
        self.send_header("Content-Type", response.media_type)
        self.send_header("Content-Length", str(len(response.body)))
        if response.location is not None:
            self.send_header("Location", f"/{self.server.token}/{response.location}")
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        if getattr(self, "command", "") != "HEAD":
            self.wfile.write(response.body)

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:
        """Answer a request that cannot be read, or has an unsupported method, in plain text."""
        del explain
        status = HTTPStatus.METHOD_NOT_ALLOWED if code == HTTPStatus.NOT_IMPLEMENTED else HTTPStatus(code)
        self._refuse(status, printable(message or "this request cannot be read"))

    def log_message(self, format: str, *arguments: Any) -> None:  # noqa: A002  the name of the base class
        """Log nothing: addresses contain the secret."""
