"""grader gradebook merge: which marks are added, what is a conflict, what is listed, and that nothing is lost."""

import hashlib
import json
import shutil
import sqlite3
import subprocess
from collections import Counter
from collections.abc import Iterator
from contextlib import closing
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import Entry, Mark, insert_mark, newest_second
from grader.classroom.gradebook.run_writer import save_student
from grader.classroom.lateness import time_text
from grader.classroom.students import Student
from tests.classroom.gradebooks import graded_as, grader, lab, record_run, refusal

LAB = lab()
KEYS = ("ash", "birch", "cedar")


@pytest.fixture
def top(tmp_path: Path) -> Path:
    """Return a folder with the gradebooks a.db and b.db: copies, in which Kim has marked Ash's essay."""
    with Gradebook(tmp_path / "a.db", create=True) as book:
        record_run(book, LAB, [graded_as(LAB, key, "ppp??") for key in KEYS])
    put(tmp_path / "a.db", "ash", "essay", Entry("points", Decimal(1), "one root"), "Kim", 1)
    shutil.copy(tmp_path / "a.db", tmp_path / "b.db")
    return tmp_path


def put(path: Path, key: str, criterion: str, entry: Entry, by: str, minute: int) -> None:
    """Add an entry at a minute."""
    with Gradebook(path) as book:
        grade = Grades(book).find(key)
        mark = Mark(entry, by, f"2026-11-20T12:{minute:02}:00+00:00", grade.result)
        insert_mark(book, grade.id, criterion, mark, by)


def points(value: str, comment: str = "") -> Entry:
    """Return an entry with points."""
    return Entry("points", Decimal(value), comment)


def merge(
    top: Path, *more: object, stdin: str = "", names: tuple[str, str] = ("a.db", "b.db")
) -> subprocess.CompletedProcess[str]:
    """Merge the second gradebook into the first one."""
    return grader("gradebook", "merge", *(top / name for name in names), *more, stdin=stdin, COLUMNS="300")


def entries(path: Path, key: str = "ash") -> list[tuple[Any, ...]]:
    """Return a student's entries: criterion, kind, points, comment, name."""
    query = (
        "SELECT criterion, kind, points / 10000.0, comment, grader_name FROM mark JOIN student ON student = student.id"
    )
    with Gradebook(path) as book:
        return list(book.rows(f"{query} WHERE key = ? ORDER BY mark.id", key))


def counts(path: Path, key: str = "ash") -> Iterator[Any]:
    """Yield the points of the essay that count, and the total."""
    with Gradebook(path) as book:
        grades = Grades(book)
        grade = grades.find(key)
        yield grades.points(grade).get("essay")
        yield grade.total


def digest(path: Path) -> str:
    """Return the digest of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def test_new_marks_are_added(top: Path) -> None:
    """Marks, comments, excuses and final marks that only B has; B is unchanged, and a second merge does nothing."""
    put(top / "b.db", "ash", "essay", points("3", "two roots"), "Lee", 2)
    put(top / "b.db", "birch", "box", Entry("comment", None, "well named"), "Lee", 3)
    put(top / "b.db", "cedar", "total", Entry("excused", None, "ill"), "Lee", 4)
    put(top / "b.db", "birch", "total", points("7"), "Lee", 5)
    put(top / "a.db", "cedar", "essay", points("4"), "Kim", 2)
    before = digest(top / "b.db")
    done = merge(top)
    assert (done.returncode, done.stdout, done.stderr) == (0, f"4 entries of 3 students merged into {top}/a.db\n", "")
    assert (*counts(top / "a.db"),) == (3, 9)
    assert entries(top / "a.db") == [
        ("essay", "points", 1.0, "one root", "Kim"),
        ("essay", "points", 3.0, "two roots", "Lee"),
    ]
    with Gradebook(top / "a.db") as book:
        birch, cedar = Grades(book).find("birch"), Grades(book).find("cedar")
    assert (str(birch.total), cedar.is_excused, str(cedar.score)) == ("7", True, "10")
    assert digest(top / "b.db") == before
    again = merge(top)
    assert (again.returncode, again.stdout) == (0, f"nothing to merge: {top}/a.db has all marks of {top}/b.db\n")


@pytest.mark.parametrize(
    ("keep", "typed", "value", "name"),
    [("first", "", 2, "Kim"), ("second", "", 3, "Lee"), ("", "what\nK\n", 2, "Kim"), ("", "take\n", 3, "Lee")],
)
def test_a_conflict_is_decided(top: Path, keep: str, typed: str, value: int, name: str) -> None:
    """By an option or on the terminal; the entries of both stay, and a merge in either direction changes no grade."""
    put(top / "a.db", "ash", "essay", points("2"), "Kim", 2)
    put(top / "b.db", "ash", "essay", points("3"), "Lee", 3)
    done = merge(top, *(("--keep", keep) if keep else ()), stdin=typed)
    assert (done.returncode, done.stderr) == (0, "")
    kinds = Counter(row[2] for row in entries(top / "a.db"))
    assert kinds == Counter([1, 2, 3, *([2] if value == 2 else [])])
    for names in (("a.db", "b.db"), ("b.db", "a.db"), ("a.db", "b.db"), ("b.db", "a.db")):
        assert merge(top, names=names).returncode == 0
        assert (*counts(top / names[0]),) == (value, 6 + value)
        assert entries(top / names[0])[-1][4] == name
    assert "nothing to merge" in merge(top).stdout


@pytest.mark.parametrize("typed", ["", "s\n", "\n"])
def test_a_conflict_without_a_decision_is_listed(top: Path, typed: str) -> None:
    """Nothing of it is written, everything else is; the exit code is 1."""
    put(top / "a.db", "ash", "essay", points("2", "my mark"), "Kim", 2)
    put(top / "b.db", "ash", "essay", Entry("withdrawn"), "Lee", 3)
    put(top / "b.db", "ash", "picture", points("1"), "Lee", 4)
    done = merge(top, stdin=typed)
    assert (done.returncode, done.stderr) == (1, "")
    assert done.stdout.endswith(
        f"1 entry of 1 student merged into {top}/a.db\n"
        "not merged, because both gradebooks have new marks (--keep first or --keep second decides): 1\n"
        "  ash, essay:\n"
        f"    {top}/a.db: 2 points by Kim at {time_text('2026-11-20T12:02:00+00:00')}: my mark\n"
        f"    {top}/b.db: withdrawn by Lee at {time_text('2026-11-20T12:03:00+00:00')}\n"
    )
    assert [row[:3] for row in entries(top / "a.db")] == [
        ("essay", "points", 1.0), ("essay", "points", 2.0), ("picture", "points", 1.0),
    ]  # fmt: skip


def test_the_same_decision_twice_is_no_conflict(top: Path) -> None:
    """Points and comment are the same: the entries of both are kept."""
    put(top / "a.db", "ash", "essay", points("2"), "Kim", 2)
    for number, value in enumerate(("4", "2"), 3):
        put(top / "b.db", "ash", "essay", points(value), "Lee", number)
    assert merge(top).returncode == 0
    assert [row[2] for row in entries(top / "a.db")] == [1, 2, 4, 2]


def test_equal_entries_are_counted(top: Path) -> None:
    """Two marks of one second are two entries, also if the other gradebook has one of them."""
    for path, number in (("a.db", 1), ("b.db", 2)):
        for _ in range(number):
            put(top / path, "ash", "essay", points("2"), "Kim", 2)
    assert merge(top).stdout == f"1 entry of 1 student merged into {top}/a.db\n"
    assert [row[2] for row in entries(top / "a.db")] == [1, 2, 2]
    assert "nothing to merge" in merge(top).stdout


def test_second_opinions_are_merged(top: Path) -> None:
    """They are never a conflict, and change no grade."""
    put(top / "a.db", "ash", "essay", points("2"), "Kim", 2)
    put(top / "b.db", "ash", "essay", Entry("second", Decimal(4)), "Lee", 3)
    assert merge(top).returncode == 0
    assert (*counts(top / "a.db"),) == (2, 8)
    assert entries(top / "a.db")[-1] == ("essay", "second", 4.0, "", "Lee")


def test_the_newest_second_opinion_counts_after_a_merge(top: Path) -> None:
    """The entry that was made last, though the merge appends an earlier one; in either direction."""
    put(top / "a.db", "ash", "essay", Entry("second", Decimal(2)), "Lee", 5)
    put(top / "b.db", "ash", "essay", Entry("second", Decimal(4)), "Lee", 3)
    for names in (("a.db", "b.db"), ("b.db", "a.db")):
        assert merge(top, names=names).returncode == 0
        book = top / names[0]
        data = json.loads(grader("stats", "--gradebook", book, "--format", "json").stdout)["agreement"]
        assert [(item["first"], item["second"]) for item in data["largest"]] == [(1, 2)]
        with Gradebook(book) as opened:
            newest = newest_second(opened, Grades(opened).find("ash"), "essay", "Lee")
        assert newest is not None
        assert newest.points == 2


def test_students_are_matched_by_ids(tmp_path: Path) -> None:
    """By the key unless an LMS number differs, else by ids; who is ambiguous or missing is listed with the number of entries."""
    classes = {
        "a.db": [Student("ash", canvas="1"), Student("birch", login="b2"), Student("elm", login="x"), Student("x")],
        "b.db": [
            Student("ash", canvas="9"), Student("b2", name="Birch"), Student("x", login="elm"), Student("oak"), Student("y", login="x"),
        ],
    }  # fmt: skip
    for name, students in classes.items():
        with Gradebook(tmp_path / name, create=True) as book:
            record_run(book, LAB, [])
            for student in students:
                save_student(book, student, None)
    for student in classes["b.db"]:
        put(tmp_path / "b.db", student.key, "total", points("5"), "Lee", 1)
    put(tmp_path / "b.db", "oak", "total", points("6"), "Lee", 2)
    done = merge(tmp_path)
    assert done.returncode == 1
    assert done.stdout.splitlines() == [
        f"2 entries of 2 students merged into {tmp_path}/a.db",
        f"not merged, because {tmp_path}/a.db has no such student: 3",
        "  ash: 1 entry",
        "  oak: 2 entries",
        "  y: 1 entry",
    ]
    with Gradebook(tmp_path / "a.db") as book:
        marked = {row[0] for row in book.rows("SELECT key FROM mark JOIN student ON student.id = mark.student")}
    assert marked == {"birch", "x"}


def test_the_result_of_a_mark_is_found_or_copied(top: Path) -> None:
    """B has graded a newer submission with another rubric: its result is copied once, and A's own stays the current one."""
    other = lab(essay="5")
    with Gradebook(top / "b.db") as book:
        record_run(book, other, [graded_as(other, "ash", "pp-??", "newer")])
    put(top / "b.db", "ash", "essay", points("3"), "Lee", 2)
    put(top / "b.db", "ash", "picture", points("1"), "Lee", 3)
    put(top / "b.db", "birch", "essay", points("4"), "Lee", 4)
    with Gradebook(top / "a.db") as book:
        before = Grades(book).find("ash")
    assert merge(top).returncode == 0
    with Gradebook(top / "a.db") as book:
        after = Grades(book).find("ash")
        assert (after.result, after.out_of, len(after.doubtful.older)) == (before.result, before.out_of, 2)
        assert Grades(book).find("birch").doubtful.older == ()
        assert book.first("SELECT count(*) FROM result") == (4,)
        assert book.first("SELECT count(*) FROM rubric") == (2,)
        assert not [*book.rows("PRAGMA foreign_key_check")]
        record_run(book, LAB, [graded_as(LAB, "ash", "ppp??")])
        assert Grades(book).find("ash").score == 10


def test_both_gradebooks_may_be_in_use(top: Path) -> None:
    """Another process has them open, B with a write that is not yet in the file itself."""
    with Gradebook(top / "a.db") as one, Gradebook(top / "b.db") as other:
        grade = Grades(other).find("ash")
        insert_mark(other, grade.id, "essay", Mark(points("3"), "Lee", result=grade.result), "Lee")
        assert merge(top).returncode == 0
        assert Grades(one).find("ash").score == 9


def test_what_is_refused(top: Path) -> None:
    """One line: the same file, a missing file, a file of another kind."""
    (top / "link.db").symlink_to(top / "a.db")
    (top / "text.db").write_text("no database, but a text that is long enough to have a header " * 3)
    (top / "empty.db").touch()
    (top / "folder.db").mkdir()
    for name, statement in (("other.db", "CREATE TABLE mark (id)"), ("newer.db", "PRAGMA user_version = 99")):
        shutil.copy(top / ("a.db" if name == "newer.db" else "empty.db"), top / name)
        with closing(sqlite3.connect(top / name)) as connection:
            connection.execute(statement)
    for second, why in (
        ("empty.db", f"{top}/empty.db is not a gradebook: name another file"),
        ("other.db", f"{top}/other.db is not a gradebook: name another file"),
        ("newer.db", f"{top}/newer.db is a gradebook of version 99"),
        ("folder.db", f"there is no gradebook {top}/folder.db"),
        ("a.db", "cannot be merged into itself: name two gradebooks"),
        ("link.db", "cannot be merged into itself: name two gradebooks"),
        ("none.db", f"there is no gradebook {top}/none.db"),
        ("text.db", f"the gradebook {top}/text.db: file is not a database"),
    ):
        assert why in refusal(merge(top, names=("a.db", second)))
    assert "there is no gradebook" in refusal(merge(top, names=("none.db", "a.db")))
    assert len(entries(top / "a.db")) == 1
