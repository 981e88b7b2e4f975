"""grader stats: a class at a glance, for people at any terminal and for programs."""

import json
import shutil
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.run_writer import save_student
from grader.classroom.gradebook.stored import Enrolment
from grader.classroom.students import Student
from tests.classroom.gradebooks import batch, graded_as, grader, lab, record_run, refusal, write_submission
from tests.samples import LAB6, ROOT


def stats(path: Path, *more: object, **variables: str) -> str:
    """Return the output for a gradebook."""
    done = grader("stats", "--gradebook", path, *more, **variables)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def as_json(path: Path) -> dict[str, Any]:
    """Return the same as JSON, valid under its schema."""
    data = json.loads(stats(path, "--format", "json"))
    jsonschema.validate(data, json.loads(grader("schema", "class").stdout))
    return dict(data)


def test_at_a_glance(top: Path) -> None:
    """Marks, criteria, failures, and who needs attention."""
    for key in ("anna", "emil"):
        grader("mark", key, "essay", "1.5", "--gradebook", top / "book.db")
    text = stats(top / "book.db")
    assert text.startswith(
        "A small lab\n3 graded, 1 could not be graded, 1 without a submission\n\n"
        "Grades out of 11 (scaled up from the points that need no manual grading): mean\n8.1, standard deviation 2.5, "
        "lowest 4.95, median 8.25, highest 11\n"
        "Points on average: 6.0 earned, 2.7 lost, 2.3 need manual grading; 3 submissions\nneed manual grading\n"
    )
    assert "criterion  points  passed   marks  of  share  discrimination\n" in text
    assert "whether students who earned the rest of the" in text
    assert "box           2.5       2       0   3    67%           -0.19\n" in text
    assert "essay           4       0       2   3    38%                \n" in text
    assert "     1  box: 'base' shows a box 1 1 2 m; it should be 1 1 1 m (x, y, z)\n" in text
    assert "Needs attention\n  could not be graded (1)\n    Cleo Ray (cleo): " in text
    assert "  nothing was submitted (1): Dora Fi (dora)\n" in text


def test_as_json(top: Path) -> None:
    """Batch, stats and export give the same."""
    done = batch(top, "--format", "json")
    reported = json.loads(done.stdout)
    jsonschema.validate(reported, json.loads(grader("schema", "class").stdout))
    run = reported.pop("run")
    assert (run["total"], run["graded"] + run["unchanged"], run["errored"]) == (4, 4, 0)
    assert (
        reported
        == as_json(top / "book.db")
        == json.loads(grader("export", "json", "--gradebook", top / "book.db").stdout)
    )
    assert reported["needs_attention"] == 2


@pytest.mark.parametrize(
    "variables",
    [{"COLUMNS": "40"}, {"COLUMNS": "1"}, {"COLUMNS": "9999"}, {"NO_COLOR": "1"}, {"PYTHONIOENCODING": "ascii"}],
)
def test_any_terminal(variables: dict[str, str], graded_class: Path) -> None:
    """No line is longer than the width, and a pipe gets no colour."""
    text = stats(graded_class / "book.db", **variables)
    width = min(500, max(40, int(variables.get("COLUMNS", "80"))))
    assert max(map(len, text.splitlines())) <= width
    assert "\x1b" not in text
    assert "loads" in text


def test_an_empty_gradebook(tmp_path: Path) -> None:
    """A gradebook without results is reported in a line."""
    book = tmp_path / "book.db"
    Gradebook(book, create=True).close()
    why = f"nothing has been graded into {book} yet: run `grader batch PATH --gradebook {book}`"
    assert refusal(grader("stats", "--gradebook", book)) == why


@pytest.mark.parametrize("signs", [{}, {"anna": "pps?f"}, {"anna": "?!p!?"}])
def test_few_or_none(signs: dict[str, str], tmp_path: Path) -> None:
    """A run without submissions, of one student, and with only unreadable submissions."""
    rubric = lab()
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, rubric, [graded_as(rubric, key, row) for key, row in signs.items()])
    text = stats(tmp_path / "book.db")
    data = as_json(tmp_path / "book.db")
    assert len(data["students"]) == len(signs)
    grades = (
        "Grades out of 11 (scaled up from the points that need no manual grading): mean 8.6, standard deviation 0.0"
    )
    assert (grades in " ".join(text.split())) == ("pps?f" in signs.values())
    assert ("no students" in text) == (not signs)
    assert grader("export", "csv", "--gradebook", tmp_path / "book.db").stdout.count("\n") == 1 + len(signs)


def test_almost_all_is_not_all(tmp_path: Path) -> None:
    """A mean just below full marks is not rounded up to them, nor is a share to 100 % or 0 %."""
    rubric = lab()
    with Gradebook(tmp_path / "book.db", create=True) as book:
        found = [graded_as(rubric, f"s{number}", "ppppp" if number else "ppppf") for number in range(300)]
        record_run(book, rubric, found)
    text = stats(tmp_path / "book.db")
    assert "Grades out of 11: mean 10.9, standard deviation 0.1" in text
    assert "picture         1     299  300    99%" in text
    assert "essay           4     300  300   100%" in text


def test_older_rubrics_are_reported(tmp_path: Path) -> None:
    """Grades that do not count are mentioned."""
    old, new = lab(), lab(loads="1")
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, old, [graded_as(old, key, "ppppp") for key in ("anna", "ben")])
        record_run(book, new, [graded_as(new, "anna", "ppppp")])
    text = stats(tmp_path / "book.db")
    assert "2 graded\n1 graded by an earlier rubric only: not in these statistics\n" in text
    assert "  graded with an earlier version of the rubric (1): ben\n" in text


def test_names_are_escaped(top: Path) -> None:
    """Names of students and files cannot colour, reverse or end the terminal's text."""
    write_submission(top / "class" / "x[red]\x1b[31m\u202ey")
    (top / "class" / "[bold]\x1b]0;z\x07.zip").write_bytes(b"no zip")
    (top / "roster.csv").write_bytes("id,name\nanna,\u202eA\x1b[31mn[red]\n".encode())
    done = batch(top)
    assert done.returncode == 0
    for text in (done.stdout, done.stderr, stats(top / "book.db")):
        assert not set(text) & set("\x1b\x07\u202e\r")
    assert "[red]" in done.stdout


def sections(path: Path) -> None:
    """Write a gradebook with the sections A (two graded, one late) and B (one graded, one missing), and a student without a section."""
    rubric = lab("due = 2026-09-10T12:00:00Z\npercent_per_day = 10")
    enrolled = {
        "ash": ("A", "ppppp", 0),
        "birch": ("A", "pfspp", 2),
        "cedar": ("B", "pppff", 0),
        "fir": ("", "ffff?", 0),
    }
    with Gradebook(path, create=True) as book:
        run = record_run(book, rubric, [graded_as(rubric, key, signs) for key, (_, signs, _) in enrolled.items()])
        assert run == 1
        with book.transaction():
            for key, (section, _, late) in {**enrolled, "elm": ("B", "", 0)}.items():
                enrolment = Enrolment(1, days_late=late, section=section, marker="Kim" if section == "A" else "Lee")
                save_student(book, Student(key), enrolment)


def test_sections_side_by_side(tmp_path: Path) -> None:
    """Students, grades, lateness, and the criteria that differ most between named sections."""
    sections(tmp_path / "book.db")
    lines = stats(tmp_path / "book.db", "--compare", "section").splitlines()
    assert lines[:5] == [
        "Grades out of 11 (scaled up from the points that need no manual grading)",
        "section       students  graded  mean  median  late  late penalty",
        "(no section)         1       1   0.0     0.0     0             0",
        "A                    2       2   9.5     9.5     1           2.2",
        "B                    2       1   6.0     6.0     0             0",
    ]
    assert lines[8:] == [
        "Criteria that differ most: mean share of the points earned",
        "  essay (4): (no section) 0%, A 100%, B 0%",
        "  picture (1): A 100%, B 0%",
        "  box (2.5): (no section) 0%, A 50%, B 100%",
        "  tall (0.5): (no section) 0%, A 50%, B 100%",
    ]


@pytest.mark.parametrize("entry", ["3", "--excused"])
def test_final_marks_and_excuses_are_not_late(tmp_path: Path, entry: str) -> None:
    """They lose nothing, so neither the class nor its sections count them."""
    book = tmp_path / "book.db"
    sections(book)
    assert "1 submission late: 2.2 points lost" in grader("stats", "--gradebook", book).stdout
    assert grader("mark", "birch", "total", entry, "--gradebook", book).returncode == 0
    assert " late: " not in grader("stats", "--gradebook", book).stdout
    (section,) = (line for line in stats(book, "--compare", "section").splitlines() if line.startswith("A "))
    assert section.split()[-2:] == ["0", "0"]


def test_sections_in_json(tmp_path: Path) -> None:
    """The comparison is added to the data of the class, which are otherwise the same."""
    sections(tmp_path / "book.db")
    book = ("--gradebook", tmp_path / "book.db", "--format", "json")
    plain, data = (json.loads(grader("stats", *more, *book).stdout) for more in ((), ("--compare", "marker")))
    jsonschema.validate(data, json.loads(grader("schema", "class").stdout))
    comparison = data.pop("comparison")
    assert data == plain
    assert comparison["by"] == "marker"
    assert [(group["name"], group["students"], group["graded"], group["mean"]) for group in comparison["groups"]] == [
        ("Kim", 2, 2, 9.5),
        ("Lee", 3, 2, 3),
    ]
    assert comparison["groups"][0]["late_points"] == 2.2
    assert comparison["groups"][0]["shares"]["box"] == 0.5
    assert comparison["differing"][0] == "essay"


def test_the_table_of_criteria_fits_on_80_columns(tmp_path: Path) -> None:
    """With criteria that are not deducted, or marked, no header and no id is cut."""
    shutil.copytree(ROOT / "submissions/lab6/wheel-too-small/my_robot/urdf", tmp_path / "class" / "ash")
    book = ("--gradebook", tmp_path / "book.db")
    assert grader("batch", tmp_path / "class", *book, "--jobs", 1).returncode == 0
    assert grader("mark", "ash", "answer-floating-link", "1", *book).returncode == 0
    lines = stats(tmp_path / "book.db").splitlines()
    header = next(line for line in lines if line.startswith("criterion"))
    assert header.split() == ["criterion", "points", "passed", "deducted", "marks", "of", "share", "discrimination"]
    assert lines[lines.index(header) - 1].split() == ["not", "manual"]
    ids = {line.split()[0] for line in lines[lines.index(header) :] if line}
    assert {criterion.id for criterion in LAB6.criteria if criterion.part == "task1"} <= ids
