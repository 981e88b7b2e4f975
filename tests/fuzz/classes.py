"""Harnesses of what an instructor has: rubrics, rosters, the files of an LMS, and the requests to a review."""

import io
import re
import shutil
from collections.abc import Callable, Iterator, Sequence
from decimal import Decimal
from functools import cache, partial
from itertools import combinations
from pathlib import Path

from grader.base.errors import RubricError
from grader.classroom.lms.fill import FillOptions, fill
from grader.classroom.lms.forms import FORMS
from grader.classroom.review.review_server import ReviewPage
from grader.classroom.review.review_session import ReviewSession
from grader.classroom.roster.roster import People, read_roster
from grader.classroom.tables import Table, TableRow, _split_rows, read_table
from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import read_rubric
from grader.report import local_server
from grader.report.local_server import LocalServer
from tests.classroom.gradebooks import ROSTER, batch, lab_text, make_class
from tests.classroom.lms.lms_class import (
    CLASS,
    blackboard_file,
    brightspace_file,
    canvas_file,
    moodle_file,
)
from tests.fuzz.harness import GUARD, check_message, user_errors
from tests.samples import LAB6, reference

_SOME = CLASS[:10]
_OUT_OF = Decimal(11)


def rubric(data: bytes) -> None:
    """A rubric is refused with a line for each mistake, or grades a robot without a fault of the grader."""
    try:
        found = read_rubric(data, Path("rubrics/fuzzed.toml"))
    except RubricError as error:
        assert error.complaints
        for complaint in error.complaints:
            check_message(complaint)
            assert complaint.startswith("rubrics/fuzzed.toml"), complaint
        return
    with user_errors():  # a reference that does not exist
        report = grade(found, reference(LAB6))
        assert not report.fault, [result.traceback for result in report.results if result.traceback]
        assert 0 <= report.score <= report.max_score + report.bonus


def rubrics() -> Iterator[bytes]:
    """Yield small rubrics."""
    yield lab_text().encode()
    yield lab_text("due = 2026-09-10T12:00:00Z\npercent_per_day = 10\nfloor_percent = 40").encode()
    whole = LAB6.data.decode()
    start, *rows = whole.split("[[criterion]]")
    yield from (f"{start}[[criterion]]{row}".encode() for row in rows)


def roster(data: bytes) -> None:
    """A roster is refused, or has students with different keys, each of whom is found again by it or by nobody else."""
    with user_errors():
        found = read_roster(data, "roster.csv")
        keys = [student.key for student in found.students]
        assert len({*keys}) == len(keys)
        assert all(keys)
        for note in found.notes:
            check_message(note)
        people = People(found.students)
        for index, student in enumerate(found.students):
            match = people.match(student)
            assert not match.owners or index in match.owners


def rosters() -> Iterator[bytes]:
    """Yield rosters in several forms."""
    yield from (ROSTER.encode(), ROSTER.replace(",", ";").encode("cp1252"), ROSTER.encode("utf-16"))
    yield b"Last name,First name,Group,Section,Due,Extension,Late,Status\nAsh,Ann,team 1,A,2026-09-10,2,no,Submitted - 2 hours late\n"
    yield b"Identifier,Full name,Email address,Status\nParticipant 5001,Ann Ash,a@uni.example,Submitted for grading - 1 day 2 hours late\n"
    yield canvas_file({one.student.key: "" for one in _SOME})


def lms(data: bytes, name: str) -> None:
    """A file of an LMS is refused, or filled: rows are removed, and of the others only grade and feedback change."""
    with user_errors():
        table = read_table(data, "lms.csv")
        assert table.encoded() == data
        filled = fill(
            data,
            _SOME,
            FORMS[name],
            FillOptions(_OUT_OF, ("A small lab", "small"), shown="lms.csv"),
        )
        text = filled.data.removeprefix(table.bom).decode(
            table.encoding
        )  # as what it was read, whatever is left of it
        _check_filled(table, _split_rows(text, table.delimiter, "lms.csv"))
        for line in filled.lines:
            assert line.isprintable(), line


def _check_filled(before: Table, after: Sequence[TableRow]) -> None:
    """Assert that the rows are some of those before, in their order; two columns may differ, for grade and feedback."""
    columns = range(max(len(row.cells) for row in before.rows))
    assert any(
        _are_some(before, after, {*two})
        for two in [(), *combinations(columns, 1), *combinations(columns, 2)]
    )


def _are_some(before: Table, after: Sequence[TableRow], changed: set[int]) -> bool:
    """Return whether rows are some of a table's, in their order, but for these columns."""
    kept, rest = (
        [_without(row, changed) for row in rows if row.cells] for rows in (after, before.rows)
    )
    rows = iter(rest)
    return all(any(row == old for old in rows) for row in kept)


def _without(row: TableRow, changed: set[int]) -> list[str]:
    return ["" if index in changed else cell for index, cell in enumerate(row.cells)]


_CELLS = {one.student.key: ("", "1.00", "")[number % 3] for number, one in enumerate(_SOME)}
LMS_SEEDS: dict[str, Callable[[], list[bytes]]] = {
    "canvas": lambda: [canvas_file(_CELLS), canvas_file(_CELLS, only=True)],
    "moodle": lambda: [moodle_file(_CELLS, {one.student.key: "<p>kept</p>" for one in _SOME[:2]})],
    "blackboard": lambda: [
        blackboard_file(_CELLS),
        blackboard_file(_CELLS).decode("utf-16").encode(),
    ],
    "brightspace": lambda: [brightspace_file(_CELLS)],
}
LMS = {name: partial(lms, name=name) for name in LMS_SEEDS}


# --- The review server -------------------------------------------------------------------------------------------------

_STATUSES = {200, 204, 302, 400, 403, 404, 411, 413, 414, 415, 421, 431, 501, 503, 505}
_START = b"POST /t/1 HTTP/1.1\r\nHost: 127.0.0.1:80\r\nOrigin: http://127.0.0.1:80\r\nContent-Type: application/json\r\nContent-Length: "
_FROM_PAGE = (b"/t/", b"http://", b"application/json", b"127.0.0.1:80")


def requests(data: bytes) -> None:
    """Every request has an answer that is no fault; only what the page itself sends changes a mark."""
    server, book = _server()
    before = _marks(book)
    connection = _Connection(data)
    local_server._Handler(connection, ("127.0.0.1", 1), server)  # type: ignore[arg-type]
    for status in re.findall(rb"(?:\A|\n)HTTP/1\.0 (\d{3}) ", bytes(connection.sent)):
        assert int(status) in _STATUSES, connection.sent
    if _marks(book) != before:
        assert all(part in data.lower() for part in _FROM_PAGE)
        if _marks(book) > 50:
            _server.cache_clear()


class _Connection:
    """A connection whose client has sent everything that it sends."""

    def __init__(self, data: bytes) -> None:
        self._data, self.sent = io.BytesIO(data), bytearray()

    def makefile(self, _mode: str, _size: int) -> io.BytesIO:
        return self._data

    def sendall(self, data: bytes) -> None:
        self.sent += data

    def settimeout(self, _seconds: float) -> None:
        """There is nothing to wait for."""


class _Server(LocalServer):
    """A server without a port."""

    def server_bind(self) -> None:
        self.server_address = local_server.HOST, 80

    def server_activate(self) -> None:
        """Nobody can connect."""


@cache
def _server() -> tuple[LocalServer, Path]:
    """Return a server of a review with six items, and its gradebook."""
    top = Path(GUARD.folder, "review")
    shutil.rmtree(top, ignore_errors=True)
    top.mkdir()
    make_class(top)
    assert batch(top).returncode == 0
    server = _Server(ReviewPage(ReviewSession(top / "book", by="Kim")), 80)
    server.socket.close()
    server.token = "t"
    return server, top / "book"


def _marks(book: Path) -> int:
    return sum(path.read_bytes().count(b"\n") for path in (book / "marks").glob("*.csv"))


def sent_requests() -> Iterator[bytes]:
    """Yield requests as a browser sends them, and others."""
    _server.cache_clear()
    for path in ("/t/", "/t/1", "/t/2/picture/1", "/t/end", "/favicon.ico", "/", "/t/99"):
        yield f"GET {path} HTTP/1.1\r\nHost: localhost:80\r\n\r\n".encode()
    page = _answer(b"GET /t/1 HTTP/1.1\r\nHost: localhost:80\r\n\r\n")
    [shown] = re.findall(rb'"shown":"(\w+)"', page)
    mark = b'{"do":"mark","points":"2","comment":"good","shown":"%b"}' % shown
    bodies = (
        mark,
        b'{"do":"next"}',
        b'{"do":"back"}',
        b"[]",
        b'{"do":"again"}',
    )
    other = b'{"do":"filter","criterion":"essay","section":"","state":"marked"}'
    yield from (_START + b"%d\r\n\r\n%b" % (len(body), body) for body in (*bodies, other))
    yield b"HEAD /t/1 HTTP/1.1\r\nHost: 127.0.0.1:80\r\n\r\nOPTIONS * HTTP/1.1\r\n\r\n"


def _answer(data: bytes) -> bytes:
    connection = _Connection(data)
    local_server._Handler(connection, ("127.0.0.1", 1), _server()[0])  # type: ignore[arg-type]
    return bytes(connection.sent)
