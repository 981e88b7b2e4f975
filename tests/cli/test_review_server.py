"""The server of grader review: what it shows and writes, and what it refuses to whom."""

import json
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from urllib.request import urlopen

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.report import local_server
from grader.report.local_server import HOST, MAX_BODY
from tests.classroom.class_runs import eventually
from tests.classroom.gradebooks import (
    ENVIRONMENT,
    PNG,
    batch,
    grader,
    lab_text,
    refusal,
    write_submission,
)
from tests.command_line import HANG_TIMEOUT
from tests.documents.files import pdf
from tests.review_server import Review, marks_in, rows_of, running
from tests.samples import ROOT

ITEMS = 6  # of the class: the essays of anna and emil, that ben has not written, and their pictures


@pytest.fixture
def book(top: Path) -> Path:
    """Return a gradebook that can be marked, beside its class."""
    return top / "book"


@pytest.fixture
def review(book: Path) -> Iterator[Review]:
    """Yield a running review of the whole class."""
    with running(book) as review:
        yield review


def test_an_item(review: Review, book: Path) -> None:
    """Student, criterion, points, message, answer beside model answer, place, score, position; nothing is raw markup."""
    found = review.get("1")
    assert (found.status, found.headers["content-type"]) == (200, "text/html; charset=utf-8")
    for text in (
        "1 of 6",
        "Anna Ek (anna)",
        "About essay",
        "0 to 4",
        "The roots of anna.",
        "Because of the roots.",
        "In <code>answers.md, line 1 in anna</code>",
        "The answer in answers.md",
        "6 of 11 points so far; 5 points need manual grading",
    ):
        assert text in found.text, text
    assert str(book.parent) not in found.text
    hostile = review.get("2").text
    assert r"[bold]\x1b[31mRed\x1b[0m roots[/bold] \u202eturned" in hostile
    assert not set(hostile) & set("\x1b\u202e")


def test_similar_answers_are_offered_together(tmp_path: Path) -> None:
    """Each has a box, unticked, with the answer; what is ticked gets the same mark, if it is still as it was shown."""
    answers = {
        "anna": "The link has no parent, so that the tree has two roots.",
        "ben": "the link has NO parent so that the tree has  two roots",
        "cleo": "The link has no parent, so that its tree has two roots!",
        "dora": "Because RViz cannot draw what robot_state_publisher does not publish.",
        "emil": "The roots.",
    }
    for name, answer in answers.items():
        write_submission(tmp_path / "class" / name, answer=answer)
    (tmp_path / "small.toml").write_text(lab_text())
    book = tmp_path / "book"
    done = grader(
        "batch", tmp_path / "class", "--gradebook", book, "--rubric", tmp_path / "small.toml"
    )
    assert done.returncode == 0, done.stderr
    with running(book, "essay") as review:
        page = review.get("1").text
        boxes = re.findall(r'data-similar="(\w+)"> (.*?)</label>', page)
        assert [about for _, about in boxes] == [
            "ben: 100% the same words",
            "cleo: 92% the same words",
        ]
        assert "so that its tree has two roots!" in page
        views = re.findall(r'"similar":({.*?})', page)
        similar = json.loads(views[0])
        assert [*similar] == [address for address, _ in boxes]
        other = {**similar, boxes[1][0]: "another"}
        assert "error" in review.mark("1", "3", similar=other)
        assert "error" in review.mark("1", "3", similar={"99": "x"})
        assert marks_in(book) == []
        assert "error" not in review.mark(
            "1", "3", "no parent", similar={boxes[1][0]: similar[boxes[1][0]]}
        )
        assert marks_in(book) == [
            ("anna", "essay", "3", "no parent"),
            ("cleo", "essay", "3", "no parent"),
        ]
        assert 'class="similar"' not in review.get("4").text
        assert 'class="similar"' not in review.get("5").text


def test_pictures_have_their_verified_type(review: Review) -> None:
    """The page names the address of each picture; it is served as what it is, and as nothing that runs."""
    assert 'src="4/picture/1"' in review.get("4").text
    found = review.get("4/picture/1")
    assert (found.status, found.body, found.headers["content-type"]) == (200, PNG, "image/png")
    assert found.headers["content-security-policy"].startswith("sandbox;")
    assert review.get("4/picture/2").status == 404
    assert review.get("1/picture/1").status == 404


def test_every_mark_is_in_its_file_at_once(review: Review, book: Path) -> None:
    """One row a student, with the digest of the submission; a mistake is said, and writes nothing."""
    assert review.mark("1", "3,5", " the roots are missing ") == {"go": "2"}
    assert marks_in(book) == [("anna", "essay", "3.5", "the roots are missing")]
    last = (book / "marks" / "kim.csv").read_text().splitlines()[-1]
    digest = Gradebook(book).grade("anna").stored.digest  # type: ignore[union-attr]
    assert last.endswith(f",Kim,anna,essay,3.5,the roots are missing,{digest}")
    for points, why in (
        ("5", "essay is worth 0 to 4 points, not 5"),
        ("x", "points are a number"),
        (" ", "points are missing"),
        ("excused", "points are a number"),
    ):
        assert why in review.mark("2", points)["error"]
    assert rows_of(book) == ["3.5"]


def test_marking_again_changes_a_mark_and_a_hyphen_withdraws_it(review: Review, book: Path) -> None:
    """A marked item stays in the list until it is looked through again."""
    go = {name: {"go": name} for name in ("1", "2", "3", "end")}
    assert review.mark("1", "3") == go["2"]
    assert "Marked:" in review.get("1").text
    assert review.post("2", {"do": "next"}).json == go["3"]
    assert review.post("2", {"do": "back"}).json == go["1"]
    assert review.post("1", {"do": "back"}).json == go["1"]
    for points in ("2.5", "-"):
        assert review.mark("1", points) == go["2"]
    assert rows_of(book) == ["3", "2.5", "-"]
    assert marks_in(book) == []
    assert "Marked" not in review.get("1").text.partition("<script>")[0].partition("<main")[2]
    assert review.post(str(ITEMS), {"do": "next"}).json == go["end"]
    assert review.post("end", {"do": "again"}).json == go["1"]


@pytest.mark.slow
def test_a_mark_of_another_person_is_replaced_only_if_asked(book: Path) -> None:
    """Whether the page has shown it or not; the answer has the mark, and is the same for a later one."""

    def mark(points: str, by: str) -> None:
        done = grader(
            "mark", "anna", "essay", points, "--gradebook", book, "--by", by, "--comment", "no"
        )
        assert done.returncode == 0

    with running(book) as review:
        seen = review.seen("1")
        mark("1", "Lee")
        changed = review.mark("1", "4", **seen)
        assert (changed["go"], "has changed since it was shown" in changed["error"]) == ("1", True)
        newer = review.mark("1", "4")["newer"]
        assert re.fullmatch(r"1 point by Lee at 20\S+ \S+ \(UTC\S*\): no", newer)
        confirmed = review.seen("1")["shown"] + "!"
        mark("2", "Lee")
        assert "has changed" in review.mark("1", "4", shown=confirmed)["error"]
        assert review.mark("1", "4")["newer"].startswith("2 points by Lee")
        assert rows_of(book) == []
        assert review.mark("1", "4", shown=review.seen("1")["shown"] + "!") == {"go": "2"}
        assert review.mark("1", "3") == {"go": "2"}
        seen = review.seen("1")
        mark("1", "Kim")  # elsewhere, under the same name
        assert "has changed" in review.mark("1", "2", **seen)["error"]
    assert rows_of(book) == ["4", "3", "1"]


def test_rows_that_have_gone_are_named_before_the_next_save(review: Review, book: Path) -> None:
    """Another program has put back the file as it was; the mark can then be given again."""
    review.mark("1", "1")
    before = (book / "marks" / "kim.csv").read_bytes()
    assert review.mark("2", "2") == {"go": "3"}
    (book / "marks" / "kim.csv").write_bytes(before)
    error = review.mark("4", "1")["error"]
    assert error.startswith("Not saved: rows of this review are no longer in marks/kim.csv")
    assert "essay 2 of emil" in error
    assert review.mark("2", "2") == {"go": "3"}
    assert review.mark("4", "1") == {"go": "5"}
    assert rows_of(book) == ["1", "2", "1"]


@pytest.mark.slow
def test_states(review: Review, book: Path) -> None:
    """Of marked items, of those that were marked before the submission changed, and of all."""
    shown: dict[str, list[tuple[str, str]]] = {}
    review.mark("1", "3")
    (book / "marks" / "lee.csv").write_text(
        "student,criterion,points,comment,submission\nemil,essay,1,wrong,d0\nemil,box,1,,\n"
    )
    for state in ("unmarked", "marked", "older", ""):
        address = review.post(
            "end", {"do": "filter", "criterion": "", "section": "", "state": state}
        ).json["go"]
        shown[state] = []
        while address != "end":
            page = review.get(address).text
            shown[state] += re.findall(r"<h1>(.*)</h1>\n<p class=\"what\">About (\w+)", page)
            assert ": wrong, before the submission changed" in page or state != "older"
            address = review.post(address, {"do": "next"}).json["go"]
    ben, anna, emil = "Ben Oh (ben)", "Anna Ek (anna)", "Ben Oh (emil)"
    pictures = [(anna, "picture"), (emil, "picture"), (ben, "picture")]
    assert shown["unmarked"] == [(ben, "essay"), *pictures]
    assert sorted(shown["marked"]) == [(anna, "essay"), (emil, "box")]
    assert shown["older"] == [(emil, "essay")]
    assert len(shown[""]) == ITEMS + 1
    wrong = review.post("1", {"do": "filter", "criterion": "esay", "section": "", "state": ""}).json
    assert "did you mean 'essay'" in wrong["error"]


@pytest.mark.slow
def test_marks_at_once_and_the_end(review: Review, book: Path) -> None:
    """Requests that arrive together are followed one after the other; the end says how many are marked, and the next command."""
    with ThreadPoolExecutor(ITEMS) as pool:
        answers = list(pool.map(lambda number: review.mark(str(number), "1"), range(1, ITEMS + 1)))
    assert [list(answer) for answer in answers] == [["go"]] * ITEMS
    assert len(marks_in(book)) == ITEMS
    page = review.get("end").text
    for text in (
        "<h1>Manual grading complete</h1>",
        "6 marks given",
        "the grade file that Canvas has exported",
    ):
        assert text in page
    assert (
        f"grader export canvas --gradebook {book} --into EXPORTED.csv --output upload.csv" in page
    )


def test_a_submission_that_has_moved_or_changed_is_not_marked(review: Review, book: Path) -> None:
    """Its page says so, and leads to the next item; after `batch NEWPATH` the review goes on with what is there now."""
    (book.parent / "class").rename(book.parent / "moved")
    found = review.get("1")
    assert found.status == 503
    assert f"run `grader batch NEWPATH --gradebook {book}` with its class folder" in found.text
    assert 'href="2"' in found.text
    assert "has moved or changed" in review.mark("1", "1")["error"]
    assert rows_of(book) == []
    assert grader("batch", book.parent / "moved", "--gradebook", book).returncode == 0
    assert review.get("1").status == 200
    (book.parent / "moved/anna/answers.md").write_text("# Step 1\n\nOther roots.\n")
    assert grader("batch", "--gradebook", book).returncode == 0
    assert "this answer has changed" in review.get("1").text
    assert "Other roots." in review.get("7").text


PATHS = {
    404: [
        "GET /",
        "GET /TOKEN/",
        "GET /1",
        "GET /TOKE/1",
        "GET /TOKEN",
        "GET /TOKEN/0",
        "GET /TOKEN/7",
        "GET /TOKEN/1/picture/../../x",
        "GET /TOKEN/4/picture/..%2f..%2fclass.toml",
        f"GET /TOKEN/4/picture/{'9' * 20}",
        "GET /TOKEN/../TOKEN/1",
        "GET /TOKEN/%d9%a1",
    ],
    200: ["GET /TOKEN/1"],
    204: ["GET /favicon.ico"],
    501: [f"{method} /TOKEN/1" for method in ("HEAD", "PUT", "DELETE", "OPTIONS", "TRACE", "BREW")],
}


def test_what_there_is_and_what_not(review: Review, book: Path) -> None:
    """Only numbers of items and pictures lead anywhere, and only with the secret; every answer has the same headers."""
    for request, status in (
        (request, status) for status, requests in PATHS.items() for request in requests
    ):
        method, path = request.replace("TOKEN", review.token).split()
        found = review.ask(method, path)
        assert found.status == status, request
        assert method != "HEAD" or found.body == b""
        assert status == 200 or str(book).encode() not in found.body
        wanted = {
            "x-content-type-options": "nosniff",
            "referrer-policy": "no-referrer",
            "cache-control": "no-store",
        }
        assert found.headers.items() >= wanted.items()
        assert "content-security-policy" in found.headers


def test_another_host_name_is_refused(review: Review) -> None:
    """A site whose name leads to this machine (DNS rebinding) cannot read or send anything, even with the secret."""
    for host in (
        "evil.example",
        "evil.example:PORT",
        "127.0.0.1",
        "localhost:1",
        "[::1]:PORT",
        "127.0.0.1:PORT@x",
        "",
    ):
        name = host.replace("PORT", str(review.port))
        assert review.get("1", Host=name).status == 421
        assert review.post("1", {"do": "next"}, Host=name, Origin=f"http://{name}").status == 421
    assert review.get("1", Host=f"LOCALHOST:{review.port}").status == 200


def test_only_the_page_itself_can_mark(review: Review, book: Path) -> None:
    """Another origin, a form, and a body that is too large are refused before anything is read."""
    sent = {"do": "mark", "points": "4", "comment": "", **review.seen("1")}
    for name, value, status in (
        ("Origin", "http://evil.example", 403),
        ("Origin", "null", 403),
        ("Origin", "http://127.0.0.1", 403),
        ("Sec_Fetch_Site", "cross-site", 403),
        ("Sec_Fetch_Site", "same-site", 403),
        ("Content_Type", "text/plain", 415),
        ("Content_Type", "application/x-www-form-urlencoded", 415),
        ("Content_Length", "-1", 411),
        ("Content_Length", "x", 411),
        ("Transfer_Encoding", "chunked", 411),
        ("Content_Length", str(MAX_BODY + 1), 413),
        ("Content_Length", "9" * 5000, 413),
    ):
        assert review.post("1", sent, **{name: value}).status == status
    assert marks_in(book) == []
    assert review.post("1", sent, Sec_Fetch_Site="same-origin").status == 200
    assert len(marks_in(book)) == 1


def test_a_body_of_another_form_is_refused(review: Review, book: Path) -> None:
    """It marks nothing, and is no error of the server."""
    mark: dict[str, object] = {"do": "mark", "points": "4", "comment": "", "shown": ""}
    some = {"do": "filter", "criterion": "", "section": "", "state": "other"}
    wrong = (
        mark | {"points": 4},
        mark | {"comment": None},
        mark | {"shown": 0},
        some,
        {"do": "filter", "state": ""},
    )
    others: tuple[object, ...] = (
        None,
        [],
        "mark",
        {},
        {"do": "delete"},
        {"do": ["mark"]},
        {"do": "mark"},
    )
    for sent in (*others, *wrong):
        assert review.post("1", sent).status == 400
    assert (
        review.post("end", {"do": "mark", "points": "1", "comment": "", "shown": ""}).status == 400
    )
    own = {"Content-Type": "application/json", "Origin": f"http://{HOST}:{review.port}"}
    assert review.ask("POST", f"/{review.token}/1", own, b"[" * 60_000).status == 400
    assert marks_in(book) == []


def test_faults_are_messages(review: Review, book: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the gradebook on the page and in the answer to a mark, of the grader in one line; the review goes on."""
    (book / "marks" / "lee.csv").write_text("student,criterion,points\nanna,essay,x\n")
    assert "marks/lee.csv:2: points are a number" in review.mark("1", "3", shown="")["error"]
    found = review.get("1")
    assert (found.status, "marks/lee.csv:2" in found.text, 'href="2"' in found.text) == (
        503,
        True,
        True,
    )
    assert 'href="end"' in review.get(str(ITEMS)).text
    (book / "marks" / "lee.csv").unlink()
    with monkeypatch.context() as patched:
        patched.setattr("grader.classroom.review.review_pages.item_page", lambda *_: 1 / 0)
        found = review.get("1")
    assert (found.status, found.headers["content-type"]) == (500, "text/plain; charset=utf-8")
    assert found.text == "the grader failed on this request: ZeroDivisionError: division by zero\n"
    assert review.mark("1", "3") == {"go": "2"}


@pytest.mark.slow
def test_a_request_without_end_is_disconnected(book: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The limit of time is that of the whole request, not of each part that arrives; others are answered meanwhile."""
    monkeypatch.setattr(local_server, "_PATIENCE", 3.0)
    with (
        running(book) as review,
        socket.create_connection((HOST, review.port), timeout=0.01) as slow,
    ):
        assert review.get("1").status == 200
        assert eventually(lambda: _is_closed(slow))


def _is_closed(connection: socket.socket) -> bool:
    """Send another byte, and return whether the server has ended the connection."""
    try:
        connection.sendall(b"x")
        return connection.recv(1) == b""
    except ConnectionError:
        return True
    except TimeoutError:
        return False


@pytest.mark.slow
@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_the_command(book: Path, ending: signal.Signals) -> None:
    """It prints the address, marks, writes the grades after each mark, and ends with a signal: it says what is left; a port is free."""
    (book / "marks" / ".~lock.kim.csv#").touch()
    options = ("--gradebook", str(book), "--criterion", "picture", "--by", "Kim")
    command = [sys.executable, "-m", "grader", "review", *options]
    with subprocess.Popen(
        command,
        cwd=ROOT,
        env=ENVIRONMENT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        url = process.stdout.readline().strip()
        with urlopen(url, timeout=HANG_TIMEOUT) as page:
            assert b"1 of 3" in page.read()
        _, port, token = re.fullmatch(r"http://(127\.0\.0\.1):(\d+)/([\w-]{32})/4", url).groups()  # type: ignore[union-attr]
        Review(url, int(port), token).mark("4", "0.5")
        refused = refusal(grader("review", "--gradebook", book, "--port", port))
        assert refused.startswith(f"cannot listen on port {port} of 127.0.0.1")
        assert "0.5" in (book / "grades.csv").read_text().splitlines()[1].split(",")
        (book / "grades.csv").unlink()
        process.send_signal(ending)
        out, err = process.communicate(timeout=HANG_TIMEOUT)
    assert (process.returncode, out) == (0, "1 marked, 2 still need manual grading\n")
    assert f"grader: {book}/marks/kim.csv is open in LibreOffice: close it" in err
    assert err.endswith(
        "grader: open this address in a browser on this machine; Ctrl-C ends the review, all marks are kept\n"
    )
    assert marks_in(book) == [("anna", "picture", "0.5", "")]
    assert "0.5" in (book / "grades.csv").read_text().splitlines()[1].split(",")


@pytest.mark.slow
def test_a_pdf_is_served_to_the_viewer(tmp_path: Path) -> None:
    """The page of an answer in a PDF has the file, opened on its page; what is no PDF is not served."""
    data, birch = pdf(["Title"], ["Task 1: Step 1", "The roots."]), tmp_path / "class" / "birch"
    write_submission(birch)
    (birch / "screen.png").rename(birch / "screen.pdf")
    (birch / "report.pdf").write_bytes(data)
    (birch / "answers.md").unlink()
    (tmp_path / "roster.csv").write_text("id\nbirch\n")
    (tmp_path / "small.toml").write_text(lab_text())
    assert batch(tmp_path).returncode == 0
    with running(tmp_path / "book") as review:
        assert 'data-src="1/picture/1#page=2&amp;navpanes=0"' in review.get("1").text
        found = review.get("1/picture/1")
        assert (found.body, found.headers["content-type"]) == (data, "application/pdf")
        assert (
            found.headers["content-security-policy"] == "default-src 'none'; frame-ancestors 'self'"
        )
        assert review.get("2/picture/1").headers["content-type"] == "image/png"  # by its bytes


def test_connections_without_a_request_take_no_place(
    review: Review, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of more than the limit, the oldest are ended; a request of the page is answered all the same."""
    monkeypatch.setattr(local_server, "_MOST_OPEN", 8)
    address = (HOST, review.port)
    idle = [socket.create_connection(address, timeout=HANG_TIMEOUT) for _ in range(40)]
    try:
        assert review.get("1").status == 200
        assert idle[0].recv(1) == b""
    finally:
        for connection in idle:
            connection.close()
