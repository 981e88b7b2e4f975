"""grader mark: final marks, excuses, comments without points, undo, second opinions, and what is refused."""

import subprocess
import zipfile
from decimal import Decimal
from pathlib import Path

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from tests.classroom.gradebooks import batch, grader, lab_text, refusal


def mark(top: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    """Mark in the class's gradebook."""
    return grader("mark", *arguments, "--gradebook", top / "book.db")


def entries(top: Path) -> list[tuple[str, int | None, str, str]]:
    """Return all entries: kind, points in ten-thousandths, comment, name in reports."""
    with Gradebook(top / "book.db") as book:
        return list(book.rows("SELECT kind, points, comment, grader_name FROM mark ORDER BY id"))


def total(top: Path, key: str) -> tuple[Decimal, bool, str]:
    """Return the total of a student, whether there is an excuse, and why there is no final grade."""
    with Gradebook(top / "book.db") as book:
        grade = Grades(book).find(key)
        return grade.total, grade.is_excused, grade.why_not_final


def test_a_final_mark_with_and_without_a_submission(top: Path) -> None:
    """It replaces the total of anyone in the gradebook; `-` withdraws it."""
    missing = mark(top, "dora", "total", "0", "--comment", "nothing submitted")
    assert (missing.returncode, missing.stdout, missing.stderr) == (0, "dora, Dora Fi: final mark 0 of 11 points\n", "")
    assert total(top, "dora") == (Decimal(0), False, "")
    given = mark(top, "Anna Ek", "total", "7,5")
    assert given.stdout == "anna, Anna Ek: final mark 7.5 of 11 points; the criteria give 6 of 11 points\n"
    assert total(top, "anna") == (Decimal("7.5"), False, "")
    withdrawn = mark(top, "anna", "total", "-")
    assert withdrawn.stdout == "anna, Anna Ek: 6 of 11 points; needs manual grading: 5 points\n"
    assert withdrawn.stderr.startswith("grader: this replaces the newest mark of total: 7.5 points by an unnamed")
    assert mark(top, "dora", "total", "-").stdout == "dora, Dora Fi: no submission\n"


def test_extra_credit_is_part_of_a_final_mark(top: Path) -> None:
    """A final mark may be as much as the rubric's points and its extra credit, and no more."""
    text = lab_text(extra="2").replace('id = "extra"', 'id = "extra"\nbonus = true')
    (top / "bonus.toml").write_text(text)
    assert batch(top, rubric=top / "bonus.toml").returncode == 0
    assert mark(top, "dora", "total", "13").stdout == "dora, Dora Fi: final mark 13 of 11 points\n"
    assert refusal(mark(top, "dora", "total", "13.5")) == "total is worth 0 to 13 points, not 13.5"


def test_an_excuse(top: Path) -> None:
    """A student with or without a submission is excused; a later final mark replaces the excuse."""
    assert (
        mark(top, "dora", "total", "--excused", "--comment", "ill", "--by", "Kim").stdout == "dora, Dora Fi: excused\n"
    )
    assert total(top, "dora") == (Decimal(0), True, "excused")
    assert mark(top, "anna", "total", "--excused").stdout == "anna, Anna Ek: excused\n"
    again = mark(top, "dora", "total", "4")
    assert again.stdout == "dora, Dora Fi: final mark 4 of 11 points\n"
    assert again.stderr.startswith("grader: this replaces the newest mark of total: excused by Kim at 20")
    assert again.stderr.endswith(": ill\n")


def test_a_comment_without_points(top: Path) -> None:
    """It changes no points, on a criterion or on the whole submission; on a mark it keeps the points."""
    alone = mark(top, "anna", "box", "--comment", "well named", "--by", "Kim")
    assert (alone.stdout, alone.stderr) == ("anna, Anna Ek: 6 of 11 points; needs manual grading: 5 points\n", "")
    assert mark(top, "anna", "total", "--comment", "well done").stdout == alone.stdout
    assert mark(top, "anna", "essay", "3").returncode == 0
    kept = mark(top, "anna", "essay", "--comment", "the roots")
    assert kept.stdout == "anna, Anna Ek: 9 of 11 points; needs manual grading: 1 point\n"
    assert entries(top)[-1] == ("points", 30_000, "the roots", "")
    report = batch(top, "--reports", top / "out", "--report-format", "markdown")
    assert report.returncode == 0, report.stderr
    replaced = mark(top, "anna", "box", "--comment", "well placed")
    assert replaced.stderr.startswith("grader: this replaces the newest comment of box: comment by Kim at 20")


def test_undo(top: Path) -> None:
    """It adds an entry that repeats the one before the newest, with the name of who gave it; undo of undo is redo."""
    mark(top, "anna", "essay", "--comment", "read again", "--by", "Kim")
    mark(top, "anna", "essay", "3", "--by", "Lee")
    undone = mark(top, "anna", "essay", "--undo", "--by", "Max")
    assert undone.stdout == "anna, Anna Ek: 6 of 11 points; needs manual grading: 5 points\n"
    assert undone.stderr.startswith("grader: this undoes the newest mark of essay: 3 points by Lee at 20")
    assert (
        mark(top, "anna", "essay", "--undo").stdout == "anna, Anna Ek: 9 of 11 points; needs manual grading: 1 point\n"
    )
    comment, points = ("comment", None, "read again", "Kim"), ("points", 30_000, "", "Lee")
    assert entries(top) == [comment, points, comment, points]
    with Gradebook(top / "book.db") as book:
        assert [author for (author,) in book.rows("SELECT author FROM mark ORDER BY id")][:3] == ["Kim", "Lee", "Max"]


def test_undo_of_the_only_mark(top: Path) -> None:
    """It is withdrawn; without a mark there is nothing to undo."""
    assert refusal(mark(top, "dora", "total", "--undo")) == "there is no mark of total to undo for dora"
    mark(top, "dora", "total", "0")
    assert mark(top, "dora", "total", "--undo").stdout == "dora, Dora Fi: no submission\n"
    assert [kind for kind, *_ in entries(top)] == ["points", "withdrawn"]


def test_undo_restores_a_mark_for_an_earlier_submission_as_such(top: Path) -> None:
    """A mark that was given for the submission before stays one that needs a look."""
    mark(top, "anna", "box", "1")
    (top / "class" / "anna" / "more.txt").write_text("changed")
    assert batch(top).returncode == 0
    mark(top, "anna", "box", "2")
    mark(top, "anna", "box", "--undo")
    with Gradebook(top / "book.db") as book:
        assert Grades(book).find("anna").doubtful.older == ("box",)


def test_a_second_opinion_changes_no_grade(top: Path) -> None:
    """It is recorded beside the mark, can be replaced and withdrawn, and its output shows no points of the first."""
    mark(top, "anna", "essay", "3", "--by", "Kim")
    before = total(top, "anna")
    second = mark(top, "anna", "essay", "1", "--second", "--by", "Lee", "--comment", "two roots")
    assert (second.stdout, second.stderr) == ("anna, Anna Ek: second opinion on essay; the grade stays the same\n", "")
    again = mark(top, "anna", "essay", "-", "--second", "--by", "Lee")
    assert again.stderr.startswith("grader: this replaces the newest second opinion of essay: 1 point by Lee at 20")
    assert mark(top, "anna", "essay", "2", "--second", "--by", "Lee").stderr == ""
    assert total(top, "anna") == before
    own = refusal(mark(top, "anna", "essay", "2", "--second", "--by", "Kim"))
    assert own == "the mark of essay is by Kim: a second opinion must be given by another person"
    assert (
        mark(top, "anna", "essay", "--undo").stdout == "anna, Anna Ek: 6 of 11 points; needs manual grading: 5 points\n"
    )


def test_comments_are_numbered(top: Path) -> None:
    """`--list-comments` lists them by first use, also those that no longer count; `#2` repeats one, and says which."""
    assert mark(top, "anna", "essay", "--list-comments").stdout == "no comments yet\n"
    for points, comment in (("1", "one root"), ("2", "two\nroots"), ("3", "one root")):
        mark(top, "anna", "essay", points, "--comment", comment)
    mark(top, "anna", "essay", "3", "--second", "--by", "Lee", "--comment", "blind")
    assert mark(top, "emil", "essay", "--list-comments").stdout == "#1 one root\n#2 two roots\n"
    used = mark(top, "emil", "essay", "2", "--comment", "#2")
    assert used.stderr == "grader: comment #2: two roots\n"
    assert entries(top)[-1][2] == "two\nroots"
    assert refusal(mark(top, "emil", "essay", "2", "--comment", "#3")) == (
        "essay has no comment #3: `grader mark STUDENT essay --list-comments` lists the earlier comments"
    )
    assert mark(top, "emil", "essay", "2", "--comment", "#3 is wrong").returncode == 0


def test_a_repeated_comment_is_printable(top: Path) -> None:
    """Control characters of a stored comment are escaped on the terminal, and kept in the gradebook."""
    mark(top, "anna", "essay", "1", "--comment", "\x1b[31mred\u202e")
    used = mark(top, "emil", "essay", "2", "--comment", "#1")
    assert used.stderr == "grader: comment #1: \\x1b[31mred\\u202e\n"
    assert entries(top)[-1][2] == "\x1b[31mred\u202e"


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (("essay",), "give POINTS, --comment, --excused or --undo"),
        (("total", "1", "--excused"), "--excused has no POINTS"),
        (("essay", "--excused"), "--excused is for the whole submission: use `total` as CRITERION"),
        (("essay", "1", "--undo"), "--undo takes no POINTS and no other option but --by"),
        (("essay", "--undo", "--comment", "x"), "--undo takes no POINTS and no other option but --by"),
        (("total", "--undo", "--excused"), "--undo takes no POINTS and no other option but --by"),
        (("essay", "1", "--second"), "--second needs --by, your name"),
        (("essay", "--second", "--by", "Lee"), "--second needs POINTS"),
        (("total", "1", "--second", "--by", "Lee"), "--second is for one criterion, not for the whole submission"),
        (("total", "--excused", "--second", "--by", "Lee"), "--second cannot be used with --excused"),
        (("essay", "1", "--list-comments"), "--list-comments records nothing: use it alone"),
        (("total", "11.5"), "total is worth 0 to 11 points, not 11.5"),
        (("total", "-1"), "total is worth 0 to 11 points, not -1"),
    ],
)
def test_contradictions_are_refused(options: tuple[str, ...], why: str, graded_class: Path) -> None:
    """One line, and nothing is recorded."""
    assert refusal(mark(graded_class, "anna", *options)) == why
    assert entries(graded_class) == []


def test_a_mark_of_an_adjusted_criterion_is_reported(top: Path) -> None:
    """It is recorded, and standard error says that it does not count."""
    text = lab_text() + '\n[adjust.essay]\naction = "full"\nreason = "the question was unclear"\n'
    (top / "adjusted.toml").write_text(text)
    assert batch(top, rubric=top / "adjusted.toml").returncode == 0
    done = mark(top, "anna", "essay", "1")
    assert (
        done.stderr
        == "grader: essay is corrected after grading, by [adjust] in the rubric: its manual marks do not count\n"
    )
    assert done.stdout == "anna, Anna Ek: 10 of 11 points; needs manual grading: 1 point\n"


def test_points_of_a_dropped_criterion_are_refused(top: Path) -> None:
    """The reason is the rubric's correction, not the range of the points; a mark can still be withdrawn."""
    assert mark(top, "anna", "essay", "3").returncode == 0
    text = lab_text() + '\n[adjust.essay]\naction = "drop"\nreason = "the question was unclear"\n'
    (top / "adjusted.toml").write_text(text)
    assert batch(top, rubric=top / "adjusted.toml").returncode == 0
    why = "essay is corrected after grading, by [adjust] in the rubric: its manual marks do not count"
    assert refusal(mark(top, "anna", "essay", "3")) == why
    assert refusal(mark(top, "anna", "essay", "0", "--second", "--by", "Lee")) == why
    assert mark(top, "anna", "essay", "-").returncode == 0


@pytest.mark.parametrize("is_zip", [False, True])
def test_a_file_that_cannot_be_opened_stays_the_same(top: Path, is_zip: bool) -> None:
    """After a change of the rubric, its final mark is not reported as older than the submission; other bytes are another one."""
    source = top / "class.zip" if is_zip else top / "class"

    def graded(content: bytes, rubric: str) -> str:
        (top / "class/dora.zip").write_bytes(content)
        if is_zip:
            with zipfile.ZipFile(source, "w") as archive:
                for path in (top / "class").iterdir():
                    archive.write(path, path.name) if path.is_file() else None
        (top / "lab.toml").write_text(rubric)
        done = grader("batch", source, "--gradebook", top / "dora.db", "--rubric", top / "lab.toml", "--jobs", 1)
        shown = [grader(*words, "--gradebook", top / "dora.db").stdout for words in (("stats",), ("export", "csv"))]
        return " ".join((done.stdout + "".join(shown)).split())

    alarm = "before the submission changed"
    assert "could not be graded" in graded(b"no zip at all", lab_text())
    assert grader("mark", "dora", "total", "3", "--gradebook", top / "dora.db").returncode == 0
    assert alarm not in graded(b"no zip at all", lab_text() + "\n# a comment\n[late]\npercent_per_day = 5\n")
    assert alarm in graded(b"another file that is no zip", lab_text())


def test_nothing_to_withdraw(top: Path) -> None:
    """Without a mark, a final mark or a new deadline, the command says so."""
    book = ("--gradebook", top / "book.db")
    for command in (("mark", "anna", "total", "-"), ("mark", "anna", "essay", "-"), ("extend", "anna", "-")):
        what = {"total": "mark of total", "essay": "mark of essay", "-": "new deadline"}[command[2]]
        assert grader(*command, *book).stderr == f"grader: there was no {what} to withdraw\n"
