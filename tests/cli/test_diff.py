"""grader diff: who changed between two runs or gradebooks, and why, for people and programs."""

import re
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from tests.classroom.gradebooks import (
    graded_as,
    grader,
    lab,
    record_run,
    refusal,
)


def diff(top: Path, *more: object) -> str:
    """Return the output without the line that names the runs."""
    done = grader("diff", top / "book.db", *more)
    assert (done.returncode, done.stderr) == (0, "")
    first, rest = done.stdout.split("\nrun 2", 1)[0], done.stdout
    assert re.match(r"From run \d+ of 20\S+ \S+ \(UTC\S*\) to run \d+ of 20\S+ \S+ \(UTC\S*\)\n", rest), first
    return rest.partition("\n")[2]


def test_an_interrupted_run_is_not_compared_by_default(tmp_path: Path) -> None:
    """Whom the interrupted run graded again is in the comparison of the run that resumed it; a number still names it."""
    rubric = lab()
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, rubric, [graded_as(rubric, key, "fff??") for key in ("ash", "birch")])
        record_run(book, rubric, [graded_as(rubric, "ash", "pff??", "b")])
        with book.transaction():
            book.connection.execute("UPDATE run SET finished = NULL WHERE id = 2")
        assert "not two runs" in refusal(grader("diff", tmp_path / "book.db"))
        record_run(book, rubric, [graded_as(rubric, "birch", "pff??", "b")])
    run = re.compile(r"From run (\d).* to run (\d)")
    for arguments, runs, students in (
        ((), ("1", "3"), {"ash", "birch"}),
        (("--before", 2), ("2", "3"), {"birch"}),
        (("--after", 2), ("1", "2"), {"ash"}),
    ):
        done = grader("diff", tmp_path / "book.db", *arguments)
        assert (found := run.match(done.stdout)), done
        assert found.groups() == runs
        assert {key for key in ("ash", "birch") if key in done.stdout} == students
