"""Classroom 50's result.json: valid, in whole numbers, and only with a known identity."""

import os
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from grader.grading.report import Report
from grader.report.platforms import identity_from, render_classroom50
from tests.golden.cases import CLASSROOM50, run
from tests.report.readers import read_by_schema
from tests.report.reports import half_points, marked
from tests.samples import REPORTED, SAMPLES

READ = read_by_schema("classroom50")
MISTAKEN = "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"


def result_of(report: Report) -> Any:
    """Return the data of a report: whole numbers, no booleans, no score above its maximum, and correct sums."""
    data = READ(render_classroom50(report, identity_from(os.environ)))
    for scored in (data, *data["tests"]):
        assert {type(scored["score"]), type(scored["max-score"])} == {int}
        assert 0 <= scored["score"] <= scored["max-score"]
    for key in ("score", "max-score"):
        assert sum(test[key] for test in data["tests"]) == data[key]
    scale = Decimal(data["max-score"]) / report.max_score
    assert data["score"] == report.score * scale
    return data


@pytest.mark.parametrize("name", REPORTED)
def test_every_criterion_is_a_test(name: str) -> None:
    """Whole points are unchanged, and a pending criterion has not passed."""
    report = SAMPLES[name].grade()
    data = result_of(report)
    assert (data["score"], data["max-score"]) == (report.score, report.max_score)
    for test, result in zip(data["tests"], report.results, strict=True):
        assert test["test-name"] == f"{result.criterion.title} ({result.criterion.id})"
        assert test["passed"] == (result.outcome.status == "passed")
        assert (test["score"], test["max-score"]) == (result.points, result.criterion.points)


def test_fractions_become_whole(tmp_path: Path) -> None:
    """Eighths are given in thousandths; a skipped criterion has not passed, even without points."""
    data = result_of(half_points(tmp_path))
    assert [(test["score"], test["max-score"], test["passed"]) for test in data["tests"]] == [
        (0, 500, False),
        (250, 250, True),
        (0, 0, False),
        (0, 0, False),
        (0, 125, False),
    ]


def test_manual_marks_count() -> None:
    """With full points a test has passed, whatever the check found; with half of them it has not."""
    report = marked()
    data = result_of(report)
    reported = {
        result.outcome.status: test["passed"]
        for test, result in zip(data["tests"], report.results, strict=True)
        if result.manual_mark is not None
    }
    assert reported == {"failed": True, "passed": False, "pending": False}


def test_the_identity_is_that_of_the_runner() -> None:
    """Each field is the variable's; without a link for review, the commit's."""
    data = result_of(SAMPLES["reference"].grade())
    assert (data["classroom"], data["assignment"], data["owner"]) == ("robotics", "lab6", "alice")
    assert data["submission"] == CLASSROOM50["SUBMISSION_TAG"]
    assert data["datetime"] == "2026-11-20T18:30:05Z"
    without = {name: value for name, value in CLASSROOM50.items() if name not in ("REVIEW_URL", "ASSIGNMENT_TYPE")}
    identity = identity_from(without)
    assert (identity["review"], identity["assignment_type"]) == (CLASSROOM50["COMMIT_URL"], "individual")


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        (dict.fromkeys(CLASSROOM50, ""), "CLASSROOM, ASSIGNMENT, SUBMISSION_TAG, USERNAME, COMMIT_URL, RELEASE_URL"),
        ({"USERNAME": ""}, "requires USERNAME in the environment"),
        ({"SUBMISSION_TAG": "main"}, "not 'main'"),
        ({"SUBMISSION_TAG": "submit/2026-11-20T25-00-00Z-ab12cd3"}, "SUBMISSION_TAG must look like"),
        ({"SUBMISSION_TAG": "submit/2026-11-20T18-30-05Z-"}, "SUBMISSION_TAG must look like"),
        (
            {"SUBMISSION_TAG": "submit/2026-11-20T18-30-05Z-a\n::error::x"},
            "not 'submit/2026-11-20T18-30-05Z-a\\\\x0a::error::x'",
        ),
        ({"SUBMISSION_TAG": "submit/\u0662\u0660\u0662\u0666-11-20T18-30-05Z-a"}, "SUBMISSION_TAG must look like"),
        ({"ASSIGNMENT_TYPE": "duet"}, "one of individual, group, team, not 'duet'"),
    ],
)
@pytest.mark.parametrize("saved", [False, True])
def test_without_an_identity_nothing_is_graded(
    tmp_path: Path, changed: dict[str, str], words: str, saved: bool
) -> None:
    """One line names the missing or invalid variable before anything is written."""
    file = tmp_path / "result.json"
    expected = ("--save", f"classroom50={file}") if saved else ("--format", "classroom50")
    done = run(("grade", MISTAKEN, *expected), **{**CLASSROOM50, **changed})
    assert (done.returncode, done.stdout) == (2, b"")
    assert words in done.stderr.decode()
    assert done.stderr.count(b"\n") == 1
    assert not file.exists()
