"""Every student with a robot gets the mark of that robot's plain URDF, whatever its repository looks like."""

import csv
import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from tests.classroom.class_runs import Done, grader, without_hints
from tests.classroom.repositories.contents import robot
from tests.classroom.repositories.table import ROWS, Row, Work
from tests.classroom.repositories.writing import write_class
from tests.command_line import run

pytestmark = pytest.mark.slow

Report = dict[str, Any]
TEAMS = [row for row in ROWS if len(row.works) > 1]
WITHOUT = [row for row in ROWS if not row.works]
WORKS = [(row, folder) for row in ROWS for folder in row.works]
# What each repository without a robot shows: the evidence that is found, and the answers.
PRELAB = ("yew",)  # have a robot, but another one; that of olive has no links
EVIDENCE = {
    "yew": (5, 0),
    "myrtle": (5, 0),
    "nutmeg": (4, 0),
    "oak": (5, 2),
    "oleander": (5, 2),
    "olive": (5, 2),
    "palm": (5, 0),
    "pear": (0, 0),
}


class Class(NamedTuple):
    """The class folder, and of both layouts the gradebook, the reports by student, and what the run said."""

    folder: Path
    gradebooks: dict[str, Path]
    reports: dict[str, dict[str, Report]]
    runs: dict[str, Done]


@pytest.fixture(scope="module")
def graded(tmp_path_factory: pytest.TempPathFactory) -> Class:
    """Write the class with its roster, and grade it in two layouts."""
    top = tmp_path_factory.mktemp("repositories")
    found = Class(write_class(top / "class", ROWS), {}, {}, {})
    with (top / "roster.csv").open("w", newline="") as file:
        csv.writer(file).writerows([("id", "login", "name", "group"), *_roster()])
    rubric = without_hints()
    for layout in ("folders", "teams"):
        found.gradebooks[layout] = top / f"{layout}-grades"
        found.runs[layout] = grader(
            "batch",
            found.folder,
            "--gradebook",
            top / f"{layout}-grades",
            "--rubric",
            rubric,
            "--layout",
            layout,
            "--roster",
            top / "roster.csv",
            "--jobs",
            "2",
            "--report-format",
            "json",
            "--reports",
            top / layout,
        )
        assert found.runs[layout].returncode == 0, found.runs[layout].stderr
        found.reports[layout] = {
            path.stem: json.loads(path.read_text()) for path in (top / layout).glob("*.json")
        }
    return found


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Report]:
    """Return the report on a robot's plain URDF on its own."""
    top = tmp_path_factory.mktemp("plain")

    @cache
    def grade_alone(sample: str) -> Report:
        (top / sample).mkdir()
        path = top / sample / "robot.urdf"
        path.write_text(robot(sample), encoding="utf-8")
        return _report(path, "--part", "task1")

    return grade_alone


def _student(row: Row, folder: str) -> str:
    return folder.rpartition("/")[2].lower() if folder else row.name


def _roster() -> list[tuple[str, str, str, str]]:
    folders = [(row, folder) for row in ROWS for folder in row.works or [""]]
    keys = [(_student(row, folder), row.name) for row, folder in folders]
    return [(key, key, f"Sam {key.title()}", group) for key, group in keys]


def _report(path: Path, *more: str) -> Report:
    done = run(("grade", path, "--hints", "none", "--format", "json", *more))
    assert done.stdout, done.stderr
    return dict(json.loads(done.stdout))


def _reason(gradebook: Path, student: str) -> str:
    lines = map(json.loads, (gradebook / "results.jsonl").read_text().splitlines())
    return next(str(line["reason"]) for line in lines if line.get("student") == student)


def _statuses(report: Report, part: str) -> dict[str, str]:
    return {
        result["id"]: result["status"] for result in report["results"] if result["part"] == part
    }


def _points(report: Report, part: str) -> float:
    return float(sum(result["points"] for result in report["results"] if result["part"] == part))


def _check(row: Row, work: Work, report: Report, alone: Report) -> None:
    """Compare a student's report with the table, and with the report on the plain URDF."""
    expected = _statuses(alone, "task1")
    expected |= dict.fromkeys(row.failed, "failed") | dict.fromkeys(row.undecided, "pending")
    assert _statuses(report, "task1") == expected
    if not row.failed and not row.undecided:
        assert _points(report, "task1") == alone["score"]
    task2 = _statuses(report, "task2")
    if work.package is None:
        has_evidence = report["other_pictures"] or any(
            it["files"] or it["possible"] for it in report["evidence"]
        )
        expected_of_package = ("pending", {"pending"}) if has_evidence else ("failed", {"skipped"})
        assert (task2.pop("package-found"), set(task2.values())) == expected_of_package
    else:
        assert {name for name, status in task2.items() if status == "failed"} == set(work.lost)
        assert {name for name, status in task2.items() if status != "passed"} == {
            *work.lost,
            *work.unknown,
        }


@pytest.mark.parametrize(
    ("row", "folder"), WORKS, ids=[f"{row.name}/{folder}".rstrip("/") for row, folder in WORKS]
)
def test_a_student_with_a_robot(
    row: Row, folder: str, graded: Class, plain: Callable[[str], Report]
) -> None:
    """`grade` and `batch` give the mark of the plain URDF, and Task 2 what its package deserves."""
    work = row.works[folder]
    alone = plain(work.sample)
    _check(row, work, _report(graded.folder / row.name / folder), alone)
    _check(row, work, graded.reports["teams"][_student(row, folder)], alone)
    if not folder:
        _check(row, work, graded.reports["folders"][row.name], alone)


@pytest.mark.parametrize("row", WITHOUT, ids=[row.name for row in WITHOUT])
def test_a_student_without_a_robot(row: Row, graded: Class) -> None:
    """Nothing is earned; evidence and answers are found and need manual grading."""
    for report in (_report(graded.folder / row.name), graded.reports["folders"][row.name]):
        statuses = _statuses(report, "task1")
        loads = statuses.pop("urdf-loads")
        decided = (
            ("pending", {"pending"}, 100) if EVIDENCE[row.name][0] else ("failed", {"skipped"}, 10)
        )
        assert (loads, set(statuses.values()), report["pending"], report["score"]) == (*decided, 0)
        assert (row.name in PRELAB) == ("another robot" in json.dumps(report["notes"]))
        answers = [
            result["message"] for result in report["results"] if result["part"] == "questions"
        ]
        found = sum(bool(evidence["files"]) for evidence in report["evidence"])
        assert (
            found,
            sum("No answer was found" not in message for message in answers),
        ) == EVIDENCE[row.name]


@pytest.mark.parametrize("row", TEAMS, ids=[row.name for row in TEAMS])
def test_several_students(row: Row, graded: Class) -> None:
    """`grade` warns which robot counts, and `batch` lists the repository unless it is told the layout."""
    done = run(("grade", graded.folder / row.name))
    assert "robots fit this lab" in done.stderr.decode()
    assert all(f"{folder}/" in done.stderr.decode() for folder in row.works)
    for folder in row.works:
        reason = _reason(graded.gradebooks["folders"], _student(row, folder))
        assert all(f"{each}/" in reason for each in row.works)


def test_the_class_is_complete(graded: Class) -> None:
    """Each student on the roster has a report, and nobody else has; the run counts those who submitted no URDF."""
    students = {key for key, *_ in _roster()}
    assert graded.reports["teams"].keys() == graded.reports["folders"].keys() == students
    printed = " ".join(graded.runs["teams"].stdout.split())
    assert "no URDF of this lab" not in printed
