"""The server of grader review --html: what it shows and writes, and what it refuses to whom."""

import re
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from http.client import HTTPConnection
from pathlib import Path
from threading import Event
from typing import Any
from urllib.request import urlopen

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.manual_queue import QueuedResult
from grader.grading.rubric import Rubric
from grader.usecases import local_server
from grader.usecases.local_server import HOST, MAX_BODY, MAX_UNAUTHENTICATED
from tests.classroom.gradebooks import (
    ENVIRONMENT,
    PNG,
    batch,
    grade_without,
    grader,
    lab_text,
    refusal,
    write_submission,
)
from tests.command_line import HANG_TIMEOUT
from tests.documents.files import pdf
from tests.review_server import Review, running
from tests.samples import ROOT

GONE = "this criterion is no longer graded for this student"
ITEMS = 6  # of the class: essays of anna and emil, their pictures, and what ben has not answered


@pytest.fixture
def book(graded_class: Path, tmp_path: Path) -> Path:
    """Return a copy of the gradebook; the submissions are where they were graded."""
    shutil.copy(graded_class / "book.db", tmp_path)
    return tmp_path / "book.db"


@pytest.fixture
def review(book: Path) -> Iterator[Review]:
    """Yield a running review of the whole class."""
    with running(book) as review:
        yield review


def marks(book: Path) -> list[tuple[Any, ...]]:
    """Return all marks: key, criterion, points, comment, name."""
    query = (
        "SELECT key, criterion, points / 10000.0, comment, grader_name FROM mark JOIN student ON student = student.id"
    )
    with Gradebook(book) as opened:
        return list(opened.rows(f"{query} ORDER BY mark.id"))


def test_an_item(review: Review, graded_class: Path) -> None:
    """Student, criterion, points, message, answer beside model answer, place, score, position; nothing is raw markup."""
    found = review.get("1")
    assert (found.status, found.headers["content-type"]) == (200, "text/html; charset=utf-8")
    for text in (
        "1 of 6", "Anna Ek (anna)", "About essay", "0 to 4", "The roots of anna.", "Because of the roots.", "6 of 11 points so far",
        f"{graded_class}/class/anna/answers.md, line 1", "The answer in answers.md",
    ):  # fmt: skip
        assert text in found.text, text
    hostile = review.get("2").text
    assert r"[bold]\x1b[31mRed\x1b[0m roots[/bold] \u202eturned" in hostile
    assert not set(hostile) & set("\x1b\u202e")


def test_pictures_have_their_verified_type(review: Review) -> None:
    """The page names the address of each picture; it is served as what it is, and as nothing that runs."""
    assert 'src="4/picture/1"' in review.get("4").text
    found = review.get("4/picture/1")
    assert (found.status, found.body, found.headers["content-type"]) == (200, PNG, "image/png")
    assert found.headers["content-security-policy"].startswith("sandbox;")
    assert review.get("4/picture/2").status == 404
    assert review.get("1/picture/1").status == 404


def test_every_mark_is_in_the_gradebook_at_once(review: Review, book: Path) -> None:
    """With the same rules as in the terminal, also while the review runs."""
    assert review.mark("1", "3,5", " the roots are missing ") == {"go": "2"}
    assert marks(book) == [("anna", "essay", 3.5, "the roots are missing", "Kim")]
    for points, why in (
        ("5", "essay is worth 0 to 4 points, not 5"),
        ("x", "points are a number"),
        ("-", "points are a number from 0"),
    ):
        assert why in review.mark("2", points)["error"]
    assert len(marks(book)) == 1


def test_next_back_and_undo(review: Review, book: Path) -> None:
    """Undo goes back to the item, adds an entry and says what counts now, once."""
    go = {name: {"go": name} for name in ("1", "2", "3", "end")}
    assert review.mark("1", "3") == go["2"]
    assert "Marked in this review:" in review.get("1").text
    assert review.post("2", {"do": "next"}).json == go["3"]
    assert review.post("2", {"do": "back"}).json == go["1"]
    assert review.post("1", {"do": "back"}).json == {"error": "this is the first item"}
    assert review.post("3", {"do": "undo"}).json == go["1"]
    assert "Undone" in review.get("1").text
    assert "Undone" not in review.get("1").text
    assert review.post("1", {"do": "undo"}).json == {"error": "nothing to undo: this review has marked nothing"}
    assert review.post(str(ITEMS), {"do": "next"}).json == go["end"]
    assert [row[2] for row in marks(book)] == [3, None]


def test_a_newer_mark_is_kept_or_replaced(review: Review, book: Path) -> None:
    """The page gets the newer mark, and nothing is written before the person has seen it."""
    assert grader("mark", "anna", "essay", "1", "--gradebook", book, "--by", "Lee", "--comment", "no").returncode == 0
    newer = review.mark("1", "4")
    assert newer["newer"].startswith("1 point by Lee at 20")
    assert newer["newer"].endswith(": no")
    assert len(marks(book)) == 1
    assert review.mark("1", "4", shown=newer["shown"]) == {"go": "2"}
    assert [row[2] for row in marks(book)] == [1, 4]


def test_comments_given_before(review: Review) -> None:
    """The page of the same criterion offers them; of another criterion not."""
    review.mark("1", "3", "two <b>roots</b>")
    assert "<kbd>1</kbd> two &lt;b&gt;roots&lt;/b&gt;" in review.get("2").text
    assert "two" not in review.get("4").text


def test_marks_at_once(review: Review, book: Path) -> None:
    """Requests that arrive together are followed one after the other."""
    with ThreadPoolExecutor(ITEMS) as pool:
        answers = list(pool.map(lambda number: review.mark(str(number), "1"), range(1, ITEMS + 1)))
    assert [list(answer) for answer in answers] == [["go"]] * ITEMS
    assert len(marks(book)) == ITEMS


def test_pictures_that_take_long_do_not_delay_marks(book: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of the next item are read in another thread, before its page is asked for."""
    read, started = Event(), Event()

    def slow(item: QueuedResult, rubric: Rubric) -> tuple[()]:
        if item.grade.student.key != "anna":
            started.set()
            assert read.wait(HANG_TIMEOUT)
        return ()

    monkeypatch.setattr("grader.usecases.review_page.item_pictures", slow)
    with running(book, "picture") as review:
        try:
            assert review.get("1").status == 200
            assert started.wait(HANG_TIMEOUT)
            assert review.mark("1", "1") == {"go": "2"}
        finally:
            read.set()
        assert review.get("2").status == 200


def test_the_end(review: Review, book: Path) -> None:
    """The first address leads to the current item; the end says how many are marked and left, and the next command."""
    assert review.get().headers["location"] == f"/{review.token}/1"
    for number in range(1, ITEMS + 1):
        last = review.mark(str(number), "1")
    assert last == {"go": "end"}
    page = review.get("end").text
    assert "<h1>Manual grading complete</h1>" in page
    assert "6 marks given in this review." in page
    assert f"grader export csv --gradebook {book}" in page


def test_the_last_item_stays_the_current_one(review: Review) -> None:
    """Also after its page has looked for a next item."""
    assert review.get(str(ITEMS)).status == 200
    assert review.get().headers["location"] == f"/{review.token}/{ITEMS}"


def test_a_criterion_that_is_no_longer_graded(review: Review, book: Path) -> None:
    """Its page, its picture and a mark are refused with the reason, after another process has used another rubric."""
    assert review.get("3/picture/1").status == 200
    grade_without(book, "anna", "picture")
    for path in ("3", "3/picture/1"):
        found = review.get(path)
        assert (found.status, GONE in found.text) == (503, True)
    assert review.mark("3", "1") == {"error": GONE}


def test_undo_of_a_criterion_that_is_no_longer_graded(review: Review, book: Path) -> None:
    """The page shows the reason, and there is nothing more to undo."""
    assert review.mark("3", "1") == {"go": "4"}
    grade_without(book, "anna", "picture")
    assert review.post("4", {"do": "undo"}).json == {"error": f"not undone: {GONE}"}
    assert review.get().headers["location"] == f"/{review.token}/4"
    assert review.post("4", {"do": "undo"}).json == {"error": "nothing to undo: this review has marked nothing"}


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/", 404),
        ("GET", "/1", 404),
        ("GET", "/TOKE/1", 404),
        ("GET", "/TOKEN", 404),
        ("GET", "/TOKEN/0", 404),
        ("GET", "/TOKEN/7", 404),
        ("GET", "/TOKEN/1/picture/../../../../etc/passwd", 404),
        ("GET", "/TOKEN/4/picture/..%2f..%2fbook.db", 404),
        ("GET", "/TOKEN/4/picture/99999999999999999999", 404),
        ("GET", "/TOKEN/../TOKEN/1", 404),
        ("GET", "/TOKEN/\u0661", 404),
        ("GET", "/favicon.ico", 200),
        ("HEAD", "/TOKEN/1", 200),
        ("HEAD", "/1", 404),
        ("PUT", "/TOKEN/1", 405),
        ("DELETE", "/TOKEN/1", 405),
        ("OPTIONS", "/TOKEN/1", 405),
        ("TRACE", "/TOKEN/1", 405),
        ("BREW", "/TOKEN/1", 405),
    ],
)
def test_what_there_is_and_what_not(method: str, path: str, status: int, review: Review, book: Path) -> None:
    """Only numbers of items and pictures lead anywhere, and only with the secret; every answer has the same headers."""
    address = path.replace("TOKEN", review.token).encode().decode("latin-1")
    found = review.ask(method, address.replace(" ", "")) if address.isascii() else raw(review, address)
    assert found.status == status
    assert method != "HEAD" or found.body == b""
    assert str(book).encode() not in found.body
    assert found.headers["x-content-type-options"] == "nosniff"
    assert found.headers["referrer-policy"] == "no-referrer"
    assert found.headers["cache-control"] == "no-store"
    assert "content-security-policy" in found.headers


def raw(review: Review, path: str) -> Any:
    """Return the answer to a path that is not ASCII, which `http.client` does not send."""
    from tests.review_server import Answer

    with socket.create_connection((HOST, review.port), timeout=HANG_TIMEOUT) as connection:
        connection.sendall(
            f"GET {path} HTTP/1.1\r\nHost: {HOST}:{review.port}\r\nConnection: close\r\n\r\n".encode("latin-1")
        )
        head, _, body = b"".join(iter(lambda: connection.recv(4096), b"")).partition(b"\r\n\r\n")
    first, *lines = head.decode().split("\r\n")
    return Answer(int(first.split()[1]), body, dict(line.lower().split(": ", 1) for line in lines))


@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:PORT", "127.0.0.1", "localhost:1", "[::1]:PORT", "127.0.0.1:PORT@evil.example", ""],
)
def test_another_host_name_is_refused(host: str, review: Review) -> None:
    """A site whose name leads to this machine (DNS rebinding) cannot read or send anything, even with the secret."""
    name = host.replace("PORT", str(review.port))
    assert review.get("1", Host=name).status == 421
    assert review.post("1", {"do": "next"}, Host=name, Origin=f"http://{name}").status == 421
    assert review.get("1", Host=f"LOCALHOST:{review.port}").status == 200


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Origin": "http://evil.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Origin": "http://127.0.0.1"}, 403),
        ({"Sec_Fetch_Site": "cross-site"}, 403),
        ({"Sec_Fetch_Site": "same-site"}, 403),
        ({"Content_Type": "text/plain"}, 415),
        ({"Content_Type": "application/x-www-form-urlencoded"}, 415),
        ({"Content_Length": "-1"}, 411),
        ({"Content_Length": "x"}, 411),
        ({"Content_Length": str(MAX_BODY + 1)}, 413),
        ({"Content_Length": "9" * 5000}, 413),
        ({"Transfer_Encoding": "chunked"}, 411),
    ],
)
def test_only_the_page_itself_can_mark(headers: dict[str, str], status: int, review: Review, book: Path) -> None:
    """Another origin, a form, and a body that is too large are refused before anything is read."""
    sent = {"do": "mark", "points": "4", "comment": "", "shown": 0, "item": review.item("1")}
    assert review.post("1", sent, **headers).status == status
    assert marks(book) == []
    assert review.post("1", sent, Sec_Fetch_Site="same-origin").status == 200
    assert len(marks(book)) == 1


@pytest.mark.parametrize(
    "sent",
    [
        None, [], "mark", {}, {"do": "delete"}, {"do": ["mark"]}, {"do": "mark"},
        {"do": "mark", "points": 4, "comment": "", "shown": 0, "item": ""}, {"do": "mark", "points": "4", "comment": None, "shown": 0, "item": ""},
        {"do": "mark", "points": "4", "comment": "", "shown": "0", "item": ""}, {"do": "mark", "points": "4", "comment": "", "shown": 0}, {"do": "mark", "points": "4", "comment": "", "shown": True, "item": ""},
    ],
)  # fmt: skip
def test_a_body_of_another_form_is_refused(sent: object, review: Review, book: Path) -> None:
    """It marks nothing, and is no error of the server."""
    assert review.post("1", sent).status == 400
    own = {"Content-Type": "application/json", "Origin": f"http://{HOST}:{review.port}"}
    assert review.ask("POST", f"/{review.token}/1", own, b"[" * 60_000).status == 400
    assert marks(book) == []


def test_an_error_of_the_gradebook_is_a_message(review: Review, book: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On the page, and in the answer to a mark; the review goes on."""
    import sqlite3

    def locked(*_: object) -> None:
        error = sqlite3.OperationalError("database is locked")
        error.sqlite_errorcode = sqlite3.SQLITE_BUSY
        raise error

    with monkeypatch.context() as patched:
        patched.setattr("grader.classroom.gradebook.gradebook.transaction_of", locked)
        assert review.mark("1", "3")["error"] == f"the gradebook {book}: database is locked"
    assert review.mark("1", "3") == {"go": "2"}
    with monkeypatch.context() as patched:
        patched.setattr("grader.usecases.review_page.item_page", locked_page)
        found = review.get("2")
        assert (found.status, "disk I/O error" in found.text, 'href="3"' in found.text) == (503, True, True)
        assert 'href="end"' in review.get(str(ITEMS)).text


def test_a_fault_of_the_grader_is_one_line(review: Review, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a traceback, and the review goes on."""
    with monkeypatch.context() as patched:
        patched.setattr("grader.usecases.review_page.item_page", lambda *_: 1 / 0)
        found = review.get("1")
    assert (found.status, found.headers["content-type"]) == (500, "text/plain; charset=utf-8")
    assert found.text == "the grader failed on this request: ZeroDivisionError: division by zero\n"
    assert review.get("1").status == 200


def locked_page(*_: object) -> str:
    """Fail as a gradebook on a broken disk does."""
    from grader.errors import InputError

    raise InputError("the gradebook: disk I/O error")


def test_idle_and_slow_clients_do_not_block_others(review: Review) -> None:
    """Of connections without the secret, the oldest one is disconnected; one with the secret stays."""
    own = HTTPConnection(HOST, review.port, timeout=HANG_TIMEOUT)
    others = []
    try:
        for number in range(MAX_UNAUTHENTICATED + 6):
            others.append(socket.create_connection((HOST, review.port), timeout=HANG_TIMEOUT))
            others[-1].sendall(b"POST / HTTP/1.1\r\nContent-Le")
            if number % 10 == 0:
                own.request("GET", f"/{review.token}/1")
                assert own.getresponse().read()
        assert [review.get("1").status for _ in range(3)] == [200] * 3
        assert others[0].recv(1) == b""
        others[-1].sendall(b"ngth: 0\r\n\r\n")
        assert others[-1].recv(12) == b"HTTP/1.1 421"
    finally:
        own.close()
        for connection in others:
            connection.close()


@pytest.mark.parametrize(("patience", "size"), [(0.3, 10**9), (HANG_TIMEOUT, 500)])
def test_a_request_without_end_is_disconnected(
    patience: float, size: int, book: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The limits of time and size are those of the whole request, not of each part that arrives."""
    monkeypatch.setattr(local_server, "PATIENCE", patience)
    monkeypatch.setattr(local_server, "MAX_REQUEST", size)
    with running(book) as review, socket.create_connection((HOST, review.port)) as slow:
        slow.settimeout(0.01)
        for _ in range(3000):
            try:
                slow.sendall(b"a long word")
                if slow.recv(1) == b"":
                    return
            except ConnectionError:
                return
            except TimeoutError:
                continue
        pytest.fail("the connection is still open")


def test_it_listens_on_this_machine_only(review: Review) -> None:
    """The address is that of the loopback interface, and the secret is long."""
    assert re.fullmatch(rf"http://127\.0\.0\.1:{review.port}/[\w-]{{32}}/", review.url)


def test_the_command(book: Path) -> None:
    """It prints the address, marks, and ends with Ctrl-C and the summary of the terminal review."""
    command = [sys.executable, "-m", "grader", "review", "--html", "--gradebook", str(book), "--criterion", "picture"]
    with subprocess.Popen(
        command, cwd=ROOT, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:  # fmt: skip
        assert process.stdout is not None
        url = process.stdout.readline().strip()
        with urlopen(f"{url}1", timeout=HANG_TIMEOUT) as page:
            assert b"1 of 3" in page.read()
        _, port, token = re.fullmatch(r"http://(127\.0\.0\.1):(\d+)/([\w-]+)/", url).groups()  # type: ignore[union-attr]
        Review(url, int(port), token).mark("1", "0.5")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=HANG_TIMEOUT)
    assert (process.returncode, out) == (0, "1 marked, 2 left\n")
    assert (
        err
        == "grader: open this address in a browser on this machine; Ctrl-C ends the review, and all marks are kept\n"
    )
    assert [row[:3] for row in marks(book)] == [("anna", "picture", 0.5)]


def test_options(book: Path, review: Review) -> None:
    """A port that is taken, and options that do not fit together, are refused in one line."""
    html = ("review", "--html", "--gradebook", book)
    assert f"cannot listen on port {review.port} of 127.0.0.1" in refusal(grader(*html, "--port", review.port))
    assert "--pictures cannot be used with --html" in refusal(grader(*html, "--pictures", "out"))
    assert refusal(grader("review", "--gradebook", book, "--port", 8000)) == "--port needs --html"
    assert "did you mean 'essay'" in refusal(grader(*html, "--criterion", "esay"))
    for number in range(1, ITEMS + 1):
        review.mark(str(number), "1")
    assert grader(*html).stdout == "nothing needs manual grading\n"


def test_the_report_of_a_student(review: Review, book: Path) -> None:
    """It is the student's page, in a sandbox; not in an anonymous review or a second one, nor for several students."""
    found = review.get("1/report")
    assert (found.status, found.headers["content-security-policy"]) == (
        200,
        "sandbox allow-scripts; frame-ancestors 'self'",
    )
    assert "<h1>A small lab</h1>" in found.text and "Because of the roots." not in found.text
    assert 'data-src="1/report"' in review.get("1").text
    with running(book, anonymous=True) as anonymous:
        assert anonymous.get("1/report").status == 404
        assert "/report" not in anonymous.get("1").text.partition("<script>")[0]


def test_a_pdf_is_served_to_the_viewer(tmp_path: Path) -> None:
    """The page of an answer in a PDF has the file, opened on its page; what is no PDF is not served."""
    (tmp_path / "class").mkdir()
    pages = ["Title"], ["Task 1: Step 1", "The roots."]
    (tmp_path / "class" / "ash.pdf").write_bytes(pdf(*pages))
    write_submission(tmp_path / "class" / "birch")
    (tmp_path / "class" / "birch" / "screen.png").rename(tmp_path / "class" / "birch" / "screen.pdf")
    shutil.move(tmp_path / "class" / "ash.pdf", tmp_path / "class" / "birch" / "report.pdf")
    (tmp_path / "class" / "birch" / "answers.md").unlink()
    (tmp_path / "roster.csv").write_text("id\nbirch\n")
    (tmp_path / "small.toml").write_text(lab_text())
    assert batch(tmp_path).returncode == 0
    with running(tmp_path / "book.db") as review:
        assert 'data-src="1/picture/1#page=2&amp;navpanes=0"' in review.get("1").text
        found = review.get("1/picture/1")
        assert (found.status, found.headers["content-type"]) == (200, "application/pdf")
        assert found.headers["content-security-policy"] == "default-src 'none'; frame-ancestors 'self'"
        assert found.body == pdf(*pages)
        assert review.get("2/picture/1").headers["content-type"] == "image/png"  # by its bytes


@pytest.mark.parametrize(
    ("sent", "answer"),
    [
        ({"do": "find", "student": "emil"}, {"go": "2"}),
        ({"do": "find", "student": "nobody"}, None),
        ({"do": "filter", "criterion": "picture", "section": "", "state": ""}, {"go": "3"}),
        ({"do": "filter", "criterion": "", "section": "", "state": "empty"}, {"go": "5"}),
        ({"do": "filter", "criterion": "", "section": "", "state": "marked"}, {"go": "end"}),
        ({"do": "keep"}, {"go": "1"}),
        ({"do": "split"}, {"error": "this item has one student only"}),
    ],
)
def test_other_actions(sent: dict[str, str], answer: dict[str, str] | None, review: Review) -> None:
    """A jump to a student, filters, and what is left of an item after the mark of somebody else."""
    review.get("1")
    found = review.post("1", sent).json
    assert found == answer if answer is not None else "there is no student 'nobody'" in found["error"]
    if answer == {"go": "end"}:
        assert "The filter shows no more items." in review.get("end").text


@pytest.mark.parametrize("state", ["", "unknown"])
def test_a_filter_of_another_form_is_refused(state: str, review: Review) -> None:
    """Each value must be there, and be a known one."""
    sent = {"do": "filter", "criterion": "", "state": state} | ({"section": ""} if state else {})
    assert review.post("1", sent).status == 400
