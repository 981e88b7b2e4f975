"""Downloads of an LMS on the command line: groups, anonymous students, lateness, and mistakes in rosters."""

import json
import shlex
import shutil
import subprocess
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from grader.report.formats import json_schema
from tests.classroom.gradebooks import grader, lab_text, refusal, urdf

LATE = "percent_per_day = 10\n"
NO_EFFECT = (
    "grader: --due has no effect on grades, because the rubric small has no [late]: only the days late are shown"
)
STATUS = "Submitted for grading"


def write(top: Path, roster: str, files: tuple[str, ...], late: str = LATE) -> None:
    """Write a class, its roster and its rubric."""
    for name in files:
        (top / "class" / name).parent.mkdir(parents=True, exist_ok=True)
        (top / "class" / name).write_text(urdf())
    (top / "roster.csv").write_text(roster)
    (top / "small.toml").write_text(lab_text(late))


def batch(top: Path, *more: object) -> subprocess.CompletedProcess[str]:
    """Grade the class on its robots."""
    return grader(
        "batch", top / "class", "--gradebook", top / "book.db", "--rubric", top / "small.toml", "--part", "robot",
        "--roster", top / "roster.csv", "--jobs", 1, *more,
    )  # fmt: skip


def graded(top: Path, *more: object) -> dict[str, Any]:
    """Return the class as JSON after grading."""
    done = batch(top, "--format", "json", *more)
    assert done.returncode == 0, done.stderr
    data = json.loads(done.stdout)
    jsonschema.validate(data, json_schema("class"))
    return dict(data)


def test_a_group_assignment_of_canvas(tmp_path: Path) -> None:
    """Each member gets the points; the one with an extension is on time, and the summary ends with what lateness cost."""
    roster = "id,name,canvas id,group,extension\nash,Ann Ash,101,,\nbirch,Bea Birch,102,The Reds,\ncedar,Cal Cedar,103,The Reds,2\n"
    write(tmp_path, roster, ("submissions/ashann_101_1_robot.urdf", "submissions/thereds_LATE_102_2_robot.urdf"))
    done = batch(tmp_path)
    assert "3 submissions, layout canvas" in done.stderr
    assert "group submissions that count for each member: 1" in done.stderr
    assert done.stdout.endswith("\n1 submission late: 1.1 points lost\n")
    data = graded(tmp_path)
    assert [(row["id"], row["score"], row["total"], row["late"]["days"]) for row in data["students"]] == [
        ("ash", 6, 6, 0), ("birch", 6, 4.9, 1), ("cedar", 6, 6, 0),
    ]  # fmt: skip
    assert data["students"][2]["late"]["reason"] == "late for the LMS, on time with the extension 2 days"
    assert data["late"] == {"count": 1, "lost": 1.1, "least": 1.1, "most": 1.1}


def test_an_anonymous_download_of_canvas(tmp_path: Path) -> None:
    """The submissions are graded under their anonymous keys with their lateness, and one line says why nobody has one."""
    write(tmp_path, "id,name\nash,Ann Ash\n", ("anon_aB3xY_1_robot.urdf", "LATE_anon_Qr5tu_2_robot.urdf"))
    done = batch(tmp_path)
    assert done.stderr.count("anonymous download") == 1
    assert "download again then" in done.stderr
    assert "unmatched" not in done.stderr
    students = {row["id"]: row["late"]["days"] for row in graded(tmp_path)["students"]}
    assert students == {"anon_Qr5tu": 1, "anon_aB3xY": 0, "ash": 0}


def worksheet(*statuses: str) -> str:
    """Return a Moodle worksheet with these statuses."""
    header = "Identifier,Full name,Email address,Status,Grade,Maximum Grade\n"
    rows = (f"Participant {n},Name {n},n{n}@example.org,{status},,11" for n, status in enumerate(statuses, 11))
    return header + "\n".join(rows)


def test_the_status_of_moodle(tmp_path: Path) -> None:
    """A grading worksheet as roster says how late: each day begun costs a tenth, after the grace period."""
    statuses = (
        STATUS,
        f"{STATUS} - 10 mins late",
        f"{STATUS} - 1 day 2 hours late - Graded",
        f"{STATUS} - 3 hours late",
    )
    files = tuple(f"Name {n}_{n}_assignsubmission_file/robot.urdf" for n in range(11, 15))
    write(tmp_path, worksheet(*statuses), files, f"{LATE}grace_minutes = 15\n")
    data = graded(tmp_path)
    assert [row["late"]["days"] for row in data["students"]] == [0, 0, 2, 1]
    assert data["students"][2]["total"] == 3.8
    assert data["late"] == {"count": 2, "lost": 3.3, "least": 1.1, "most": 2.2}
    done = grader("stats", "--gradebook", tmp_path / "book.db")
    assert "2 submissions late: 3.3 points lost, 1.1 to 2.2 each" in done.stdout


def test_due_without_a_late_penalty(tmp_path: Path) -> None:
    """batch, stats and every export say once that --due changes no grade; days late are shown nevertheless."""
    write(tmp_path, "id,submitted\nash,2026-09-03T10:00Z\nbirch,\n", ("ash.urdf", "birch.urdf"), "")
    due = ("--due", "2026-09-01T10:00Z")
    book = ("--gradebook", tmp_path / "book.db")
    done = batch(tmp_path, *due)
    assert done.stderr.splitlines().count(NO_EFFECT) == 1
    assert done.stdout.endswith("\n1 submission late: no points lost, because the rubric has no [late]\n")
    for words in (
        ("stats",),
        ("export", "csv"),
        ("export", "json"),
        ("export", "html", "--output", tmp_path / "pages"),
    ):
        assert grader(*words, *book, *due).stderr.splitlines().count(NO_EFFECT) == 1, words
        assert NO_EFFECT not in grader(*words, *book).stderr
    assert ",2,0,6" in grader("export", "csv", *book, *due).stdout
    (tmp_path / "small.toml").write_text(lab_text(LATE))
    assert "has no effect" not in batch(tmp_path, *due).stderr
    assert "has no effect" not in grader("stats", *book, *due).stderr


def test_bad_values_in_a_roster(tmp_path: Path) -> None:
    """All mistakes are reported at once with file and line, and nothing is graded."""
    write(tmp_path, "id,late,due,email\nash,maybe,,a@x.org\nbirch,-1,2026-02-30,A@x.org\n", ("ash.urdf", "birch.urdf"))
    done = batch(tmp_path)
    shown = tmp_path / "roster.csv"
    assert (done.returncode, done.stdout) == (2, "")
    assert [line.removeprefix("grader: ") for line in done.stderr.splitlines()] == [
        f"line 2 of {shown} has 'maybe' for late: write yes, no, or a number of days from 0",
        f"line 3 of {shown} has the date '2026-02-30', which does not exist: write it as 2026-09-01 or 2026-09-01T23:59",
        f"line 3 of {shown} has '-1' for late: write yes, no, or a number of days from 0",
        f"{shown} has the email address A@x.org twice, in lines 2 and 3",
    ]
    assert not (tmp_path / "book.db").exists()


@pytest.mark.parametrize(("late", "words"), [("3", "3 submissions late: 9.9 points lost, 3.3 each"), ("no", "")])
def test_the_last_line_of_a_batch(tmp_path: Path, late: str, words: str) -> None:
    """It says how many were late and what they lost, and is absent if nobody was."""
    roster = f"id,late\nash,{late}\nbirch,{late}\ncedar,{late}\n"
    write(tmp_path, roster, ("ash.urdf", "birch.urdf", "cedar.urdf"))
    last = batch(tmp_path).stdout.splitlines()[-1]
    assert last == words if words else "late" not in last


CANVAS = ("ashann_101_1_robot.urdf", "birchbea_LATE_102_2_robot.urdf", "birchbea_102_3_picture.png")
MOODLE = ("Ann Ash_11_assignsubmission_file/robot.urdf", "Bea Birch_12_assignsubmission_file/robot.urdf")
NBGRADER = ("submitted/ash/small/robot.urdf", "submitted/birch/small/robot.urdf", "source/small/a.ipynb")


@pytest.mark.parametrize("form", ["folder", "zip"])
@pytest.mark.parametrize("wrapper", ["", "our submissions/"])
@pytest.mark.parametrize(("lms", "files"), [("Canvas", CANVAS), ("Moodle", MOODLE), ("nbgrader", NBGRADER)])
def test_a_class_is_not_one_submission(
    tmp_path: Path, lms: str, files: tuple[str, ...], wrapper: str, form: str
) -> None:
    """`grade` refuses a whole class, and names the command that grades it; that command works as it is printed."""
    write(tmp_path, "", tuple(f"{wrapper}{file}" for file in files))
    path = tmp_path / "class"
    if form == "zip":
        path = Path(shutil.make_archive(str(tmp_path / "our class"), "zip", tmp_path / "class"))
    rubric = tmp_path / "small.toml"
    done = grader("grade", path, "--rubric", rubric, "--part", "robot")
    assert (done.returncode, done.stdout) == (2, "")
    head, last = (line.removeprefix("grader: ") for line in done.stderr.splitlines())
    assert head == f"{path} is a download of {lms} with the submissions of 2 students: nothing was graded"
    assert last == (
        f"to grade all: grader batch {shlex.quote(str(path))} --gradebook small.db --rubric {rubric} --part robot"
    )
    if wrapper:
        words = shlex.split(last.partition(": grader ")[2].replace("small.db", f"{tmp_path}/small.db"))
        assert "2 submissions" in grader(*words).stderr


@pytest.mark.parametrize(
    "files",
    [
        CANVAS[1:],  # of one student
        MOODLE[:1],
        ("robot.urdf", "step_8_1_a.png", "step_18_2_b.png", "step_36_3_c.png"),  # numbers as those of users
        ("robot.urdf", "submitted/lab6/final/notes.txt", "submitted/lab5/final/notes.txt"),
        ("src/my_robot_pkg/robot.urdf", "src/my_robot_sim/a.txt"),
    ],
)
def test_the_submission_of_one_student_is_graded(tmp_path: Path, files: tuple[str, ...]) -> None:
    """Whatever its files are called."""
    write(tmp_path, "", files)
    done = grader("grade", tmp_path / "class", "--rubric", tmp_path / "small.toml", "--part", "robot")
    assert done.returncode == 0, done.stderr


def test_who_is_marked(tmp_path: Path) -> None:
    """`mark` finds the one student who fits; several are listed with their ids, and no mark is recorded."""
    roster = "id,first name,last name,login\ns1,Jörg,Müller,jm1\ns2,Ann,Müller,am2\ns3,Ann,Cedar,ac3\n"
    write(tmp_path, roster, ("jm1.urdf", "am2.urdf", "ac3.urdf"))
    assert batch(tmp_path).returncode == 0

    def mark(name: str) -> tuple[int, str]:
        done = grader("mark", name, "essay", "1", "--gradebook", tmp_path / "book.db")
        return done.returncode, (done.stdout or done.stderr).removeprefix("grader: ").partition("points")[0].strip()

    for name in ("Jörg Müller", "Mu\u0308ller, Jörg", "jörg", "JM1", "s1"):
        code, line = mark(name)
        assert (code, line.partition(":")[0]) == (0, "s1, Jörg Müller"), name
    several = "'s1' (Jörg Müller), 's2' (Ann Müller)"
    assert mark("Müller") == (2, f"'Müller' is ambiguous: it may be {several}; use one of these ids")
    assert mark("Mueller") == (2, f"there is no student 'Mueller' in the gradebook; did you mean one of {several}?")
    assert mark("Ann")[0] == 2
    assert [row["manual_marks"] for row in graded(tmp_path)["students"]] == [1, 0, 0]


def test_a_time_of_submission_that_cannot_be_read(tmp_path: Path) -> None:
    """The roster is refused with the line: without the time, no submission would be late."""
    write(tmp_path, "id,submitted\nash,20.11.2026 10:00\n", ("ash/robot.urdf",))
    where = f"line 2 of {tmp_path}/roster.csv has the time '20.11.2026 10:00' for submitted"
    assert refusal(batch(tmp_path)) == f"{where}: write it as 2026-09-01T10:00"
    assert not (tmp_path / "book.db").exists()


def last_words(done: subprocess.CompletedProcess[str]) -> str:
    """Return the output without its line breaks."""
    return " ".join(done.stdout.split())


def test_a_deadline_without_times_of_submission(tmp_path: Path) -> None:
    """The summary ends with what is missing, unless the roster has times, or says who is late."""
    write(tmp_path, "id\nash\nbirch\n", ("ash/robot.urdf", "birch/robot.urdf"))
    due, line = (
        ("--due", "2026-09-01"),
        "no submission time is known for 2 submissions: add a column `submitted` to the roster",
    )
    assert not last_words(batch(tmp_path)).endswith(line)
    assert last_words(batch(tmp_path, *due)).endswith(line)
    for roster in ("id,late\nash,no\nbirch,\n", "id,submitted\nash,2026-09-01\nbirch,\n"):
        (tmp_path / "roster.csv").write_text(roster)
        assert "no submission time" not in batch(tmp_path, *due).stdout
    write(tmp_path, "id\nash\nbirch\n", (), late="")
    assert "no submission time" not in batch(tmp_path, *due).stdout
    write(tmp_path, "id\nash\nbirch\n", (), late=f"due = 2026-09-01T00:00:00Z\n{LATE}")
    (tmp_path / "book.db").unlink()
    assert last_words(batch(tmp_path)).endswith(line)


@pytest.mark.parametrize("name", ["Student, Test", "Test Student"])
def test_the_test_student_of_canvas_is_no_student(name: str, tmp_path: Path) -> None:
    """A gradebook from Canvas has a row for it; nothing was submitted by nobody."""
    head = "Student,ID,SIS User ID,SIS Login ID,Section,A small lab (77)\n    Points Possible,,,,,6\n"
    write(tmp_path, f'{head}"Ash, Ann",101,s1,ash,A,\n"{name}",199,,f00ba4,A,\n', ("ash/robot.urdf",))
    assert [student["name"] for student in graded(tmp_path)["students"]] == ["Ash, Ann"]


def test_a_mark_of_one_member_names_the_others(tmp_path: Path) -> None:
    """Until they have the same mark; a final mark is for one student, and a submission of one's own has no other members."""
    roster = "id,name,group\nash,Ann Ash,\nbirch,Bea Birch,The Reds\ncedar,Cal Cedar,The Reds\n"
    write(tmp_path, roster, ("ash/robot.urdf", "The Reds/robot.urdf"))
    assert batch(tmp_path).returncode == 0

    def said(key: str, *arguments: str) -> str:
        done = grader("mark", key, *arguments, "--gradebook", tmp_path / "book.db")
        assert done.returncode == 0, done.stderr
        return done.stderr.removeprefix("grader: ")

    assert said("birch", "box", "1") == "the same submission counts for Cal Cedar (cedar): mark them as well\n"
    assert said("cedar", "box", "1") == ""
    assert said("birch", "box", "-").endswith(
        "grader: the same submission counts for Cal Cedar (cedar): mark them as well\n"
    )
    assert said("cedar", "total", "1") == ""
    assert said("ash", "box", "1") == ""


def test_an_extension_that_cannot_be_read(tmp_path: Path) -> None:
    """The line says that it may be a number of days."""
    write(tmp_path, "id,extension\nash,two\n", ("ash/robot.urdf",))
    where = f"line 2 of {tmp_path}/roster.csv has 'two' for extension"
    assert refusal(batch(tmp_path)) == f"{where}: write a number of days from 0, or a date"
