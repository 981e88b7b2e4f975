"""grader review: one section, one marker, anonymous, second opinions, earlier comments, partial points."""

import re
import shutil
import subprocess
from decimal import Decimal
from pathlib import Path

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from tests.checks.submissions import gif
from tests.classroom.gradebooks import batch, grader, lab_text, refusal, write_submission
from tests.review_server import running

# Keys with names and file names that occur nowhere else in an output.
STUDENTS = {"u7701": "Zebulon Ash", "u7702": "Wilhelmina Birch", "u7703": "Ignatius Cedar"}
ROSTER = "id,name,section,marker\nu7701,Zebulon Ash,Lab A,Kim\nu7702,Wilhelmina Birch,Lab B,Lee\nu7703,Ignatius Cedar,Lab A,Lee\n"


@pytest.fixture(scope="session")
def scoped_class(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a class of three in two sections; the names of their files contain their names."""
    top = tmp_path_factory.mktemp("scopes")
    for (key, name), colour in zip(STUDENTS.items(), ("red", "green", "blue"), strict=True):
        folder = top / "class" / key
        write_submission(folder, answer=f"The {colour} roots.")
        (folder / "answers.md").rename(folder / f"answers {name}.md")
        (folder / "screen.png").rename(folder / f"screen {name}.png")
        (folder / f"screen 2 {name}.png").write_bytes(b"<svg/>" if key == "u7701" else gif())
    (top / "roster.csv").write_text(ROSTER)
    (top / "small.toml").write_text(lab_text())
    assert batch(top).returncode == 0
    return top


@pytest.fixture
def top(scoped_class: Path, tmp_path: Path) -> Path:
    """Return a folder with a copy of the gradebook."""
    shutil.copy(scoped_class / "book.db", tmp_path / "book.db")
    return tmp_path


def review(top: Path, typed: str, *more: object, **variables: str) -> subprocess.CompletedProcess[str]:
    """Review with these input lines."""
    return grader("review", "--gradebook", top / "book.db", *more, stdin=typed, COLUMNS="300", **variables)


def shown(done: subprocess.CompletedProcess[str]) -> list[str]:
    """Return the headings of the items."""
    return re.findall(r"^\d of \d  .*$", done.stdout, re.MULTILINE)


def mark(top: Path, key: str, criterion: str, points: str, *more: object) -> None:
    """Mark a criterion."""
    assert grader("mark", key, criterion, points, "--gradebook", top / "book.db", *more).returncode == 0


def scores(top: Path) -> list[Decimal]:
    """Return the scores of all students."""
    with Gradebook(top / "book.db") as book:
        return [grade.score for grade in Grades(book).all()]


def test_a_section(top: Path) -> None:
    """Only its students, in any spelling; the summary counts these; an unknown one is refused with the known ones."""
    done = review(top, "1\ns\nq\n", "--section", "lab-a", "--criterion", "essay")
    assert shown(done) == [
        "1 of 2  Zebulon Ash (u7701): About essay (4 points)", "2 of 2  Ignatius Cedar (u7703): About essay (4 points)",
    ]  # fmt: skip
    assert done.stdout.endswith("1 marked, 1 left\n")
    unknown = refusal(review(top, "", "--section", "C"))
    assert unknown == "no student has the section 'C' in the roster; the roster has 'Lab A' and 'Lab B'"


def test_the_students_of_a_marker(top: Path) -> None:
    """Those whose marker is --by, which is needed."""
    assert len(shown(review(top, "s\n" * 9, "--mine", "--by", "lee"))) == 4
    both = review(top, "s\n" * 9, "--mine", "--by", "Lee", "--section", "Lab A", "--criterion", "essay")
    assert shown(both) == ["1 of 1  Ignatius Cedar (u7703): About essay (4 points)"]
    assert refusal(review(top, "", "--mine")) == "--mine needs --by, your name"
    unknown = refusal(review(top, "", "--mine", "--by", "Max"))
    assert unknown == "no student has the marker 'Max' in the roster; the roster has 'Kim' and 'Lee'"


def test_students_with_a_final_mark_or_an_excuse_are_not_shown(top: Path) -> None:
    """Their grades need no other marks."""
    mark(top, "u7701", "total", "5")
    assert grader("mark", "u7702", "total", "--excused", "--gradebook", top / "book.db").returncode == 0
    assert shown(review(top, "s\n" * 9, "--criterion", "essay")) == [
        "1 of 1  Ignatius Cedar (u7703): About essay (4 points)"
    ]


def revealing(text: str, scoped_class: Path) -> set[str]:
    """Return what a text says of who the students are."""
    words = [
        *STUDENTS,
        *(word for name in STUDENTS.values() for word in name.split()),
        str(scoped_class),
        "screen",
        "answers",
    ]
    return {word for word in words if word in text}


def test_an_anonymous_review_in_the_terminal(top: Path, scoped_class: Path) -> None:
    """No name, key, path or file name: not in items, lists of pictures, messages and the summary. Marks are those of the students."""
    commands = "3 good\nb\nu\n2\n1\n0.5\n" + "s\n" * 9
    done = review(top, commands, "--anonymous", "--pictures", top / "out")
    assert revealing(done.stdout + done.stderr, scoped_class) == set()
    numbers = [re.sub(r".*  (submission \d): .*", r"\1", line) for line in shown(done)]
    assert numbers[:2] == ["submission 1", "submission 2"] and set(numbers) == {f"submission {n}" for n in (1, 2, 3)}
    names = sorted(path.relative_to(top / "out").as_posix() for path in (top / "out").rglob("*.*"))
    assert len(names) == 5 and revealing(" ".join(names), scoped_class) == set()
    assert "Pictures:\n" in done.stdout and "  file 1: it is not a PNG" in done.stdout
    assert "The red roots." in done.stdout and "Because of the roots." in done.stdout
    assert (
        "\nWhy? a written answer, needs manual grading\n" in done.stdout
        and "\n2 files, need manual grading\n" in done.stdout
    )
    again = review(top, "q\n", "--anonymous", "--criterion", "picture")
    assert shown(again)[0].startswith("1 of 3  submission 1: About picture")
    refused = refusal(review(top, "", "--anonymous", "--pictures", top / "out"))
    assert refused == f"{top}/out is not empty: --anonymous needs a new folder for --pictures"
    assert sorted(scores(top)) == [Decimal("6.5"), Decimal(7), Decimal(8)]


def test_an_anonymous_review_in_the_browser(top: Path, scoped_class: Path) -> None:
    """Pages, captions, addresses and messages have numbers as well."""
    with running(top / "book.db", by="Kim", anonymous=True) as served:
        pages = [served.get(f"{number}").text for number in range(1, 7)]
        assert all(f"submission {number}" in page for number, page in enumerate(pages[:3], 1))
        assert "(1 x 1 pixels)" in "".join(pages) and "(320 x 240 pixels)" in "".join(pages)
        sent = served.mark("1", "3", "good")
        newer = served.mark("1", "2", "bad")
        end = served.get("end").text
        undone = served.post("end", {"do": "undo"}).json
        notice = served.get(str(undone["go"])).text
    for text in (*pages, str(sent), str(newer), end, notice):
        assert revealing(text, scoped_class) <= {"screen", "answers"}  # words of the style sheet
    assert "Somebody has marked" in pages[0] and "newer" in newer


def test_an_anonymous_student_who_is_removed(top: Path) -> None:
    """No message names the key, and no other student is shown instead."""
    from grader.classroom.gradebook.manual_queue import ReviewScope
    from grader.classroom.review.session import ReviewSession
    from grader.errors import InputError

    with Gradebook(top / "book.db") as book:
        session = ReviewSession(Grades(book), ReviewScope(anonymous=True))
        with book.transaction():
            book.connection.execute("UPDATE student SET key = 'x' || key")
        session.go(0)
        with pytest.raises(InputError, match=r"^this criterion is no longer graded for this student$"):
            session.current_item()


def test_second_marking_is_blind(top: Path) -> None:
    """It shows what others have marked or must mark, without their marks, and records opinions that change no grade."""
    mark(top, "u7701", "essay", "3.25", "--by", "Kim", "--comment", "secret reason")
    mark(top, "u7701", "box", "1.75", "--by", "Kim")
    mark(top, "u7702", "essay", "1", "--by", "Lee")
    before = scores(top)
    arguments = ("--second", "--by", "Lee")
    first = review(top, "2 mine\ns\n4 well\nb\nu\n1\nq\n", *arguments)
    assert shown(first)[:3] == [
        "1 of 6  Zebulon Ash (u7701): About box (2.5 points)",
        "2 of 6  Zebulon Ash (u7701): About essay (4 points)",
        "3 of 6  Ignatius Cedar (u7703): About essay (4 points)",
    ]
    assert not set(re.findall(r"3\.25|1\.75|secret|by Kim", first.stdout + first.stderr))
    assert "Marked: 4 points by Lee" in first.stdout
    assert first.stderr == "grader: undone\n"
    assert scores(top) == before
    rest = review(top, "s\n" * 9, *arguments)
    assert shown(rest)[0] == "1 of 4  Zebulon Ash (u7701): About essay (4 points)"
    assert "secret" not in rest.stdout
    assert refusal(review(top, "", "--second")) == "--second needs --by, your name"
    with Gradebook(top / "book.db") as book:
        kinds = list(book.rows("SELECT kind, points / 10000.0 FROM mark WHERE id > 3 ORDER BY id"))
    assert kinds == [("second", 2.0), ("second", 4.0), ("second", None), ("second", 1.0)]


def test_the_page_of_a_second_opinion_has_no_score(top: Path) -> None:
    """The score so far would tell what the first mark is."""
    from grader.classroom.gradebook.manual_queue import ReviewScope, queued_results
    from grader.report.pages.review import Place, item_page

    mark(top, "u7701", "essay", "3.25", "--by", "Kim")
    with Gradebook(top / "book.db") as book:
        for is_second in (False, True):
            scope = ReviewScope("essay", "Lee", second=is_second)
            grades = Grades(book)
            (item,) = queued_results(grades, grades.find("u7701"), ["essay"], scope)
            page = item_page(item, Place(1, 1, "1", False, False), (), (), "")
            assert ("9.25" in page, "3.25" in page) == (not is_second, not is_second)


def test_earlier_comments_have_numbers(top: Path) -> None:
    """The terminal lists them, `3.5 #1` repeats one; a number keeps its comment, also for `grader mark`."""
    done = review(top, "3 the roots are missing\n2 #1\n1 #7\n1 #1 again\nq\n", "--criterion", "essay")
    assert done.stderr == "grader: there is no comment #7\n"
    assert "Earlier comments:\n  #1 the roots are missing\n" in done.stdout
    used = grader("mark", "u7703", "essay", "1", "--comment", "#2", "--gradebook", top / "book.db")
    assert used.stderr.startswith("grader: comment #2: #1 again\n")
    with Gradebook(top / "book.db") as book:
        comments = [comment for (comment,) in book.rows("SELECT comment FROM mark ORDER BY id")]
    assert comments == ["the roots are missing", "the roots are missing", "#1 again", "#1 again"]


def test_a_comment_without_points_is_shown(top: Path) -> None:
    """An item with a comment still needs points; the page has the comment in its field, so that it is not lost."""
    command = ("mark", "u7701", "essay", "--comment", "read again", "--by", "Kim", "--gradebook", top / "book.db")
    assert grader(*command).returncode == 0
    done = review(top, "q\n", "--criterion", "essay")
    assert re.search(r"\nMarked: comment by Kim at \S+ \S+ \(UTC\S*\): read again\n", done.stdout)
    assert "1 of 3" in done.stdout
    with running(top / "book.db", "essay") as served:
        assert '"comment": "read again"' in served.get("1").text.replace('":"', '": "')


def test_a_port_needs_a_page(top: Path) -> None:
    """Without --html nothing is served."""
    assert refusal(review(top, "", "--port", "8000")) == "--port needs --html"


def test_partial_points_are_shown_as_partial(top: Path, scoped_class: Path) -> None:
    """A sign of its own in the terminal, in Markdown and HTML, and in the review; JSON keeps the status."""
    marked = review(top, "3\nb\nq\n", "--by", "Kim", TZ="Asia/Tokyo")
    assert re.search(r"Marked: 3 points by Kim at \S+ \d\d:\S+ \(UTC\+09:00\) \(partial points\)\n", marked.stdout)
    shutil.copytree(scoped_class, top / "again")
    mark(top / "again", "u7701", "essay", "3")
    mark(top / "again", "u7701", "picture", "0")
    formats = [word for kind in ("terminal", "markdown", "html", "json") for word in ("--report-format", kind)]
    assert batch(top / "again", "--reports", top / "out", *formats).returncode == 0
    assert re.search(r"^~ essay  -1 point$", (top / "out" / "u7701.txt").read_text(), re.MULTILINE)
    assert "- ~ 3/4 About essay (`essay`)" in (top / "out" / "u7701.md").read_text()
    assert "- \u2717 0/1 About picture (`picture`)" in (top / "out" / "u7701.md").read_text()
    page = (top / "out" / "u7701.html").read_text()
    assert 'class="partial"' in page and "partial-card" in page
    assert '"status": "pending"' in (top / "out" / "u7701.json").read_text()


def test_an_empty_section_is_refused(top: Path) -> None:
    """It would be all sections: a script with an unset variable gets a line instead."""
    for name in ("", " "):
        why = refusal(review(top, "", "--section", name))
        assert why == "--section is empty: name a section, or omit it to review all"
