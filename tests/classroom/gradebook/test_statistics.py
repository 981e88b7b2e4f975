"""A class's statistics, compared with numpy and the standard library on the CSV export."""

import csv
import json
import statistics as standard
import sys
from collections import Counter
from decimal import Decimal
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

from grader.checks.manual import MANUAL_CHECKS
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.statistics import ClassStatistics, statistics
from tests.classroom.class_runs import without_hints
from tests.classroom.gradebooks import graded_as, grader, lab, mark, record_run
from tests.samples import LAB6, ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))  # a folder of scripts
import class_generator as made_up

LAB = lab()
CRITERIA = [criterion.id for criterion in LAB6.criteria]


@pytest.fixture(scope="module")
def graded(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[dict[str, str]], dict[str, Any]]:
    """Return the CSV export of a class of 60 with some 150 manual marks, and its statistics as JSON."""
    top = tmp_path_factory.mktemp("class")
    count = sum(1 for _ in made_up.make_class(top / "class", 60, 7, "mixed"))
    assert count > 60
    book = top / "book.db"
    assert grader("batch", top / "class", "--gradebook", book, "--rubric", without_hints()).returncode == 0
    mark_some(book)
    table = grader("export", "csv", "--gradebook", book).stdout
    done = grader("stats", "--gradebook", book, "--format", "json")
    return list(csv.DictReader(table.splitlines())), json.loads(done.stdout)["statistics"]


def mark_some(path: Path) -> None:
    """Add marks as graders do: for most pending criteria, and sometimes against a check."""
    chance = Random(3).random
    with Gradebook(path) as book:
        standings = Grades(book)
        for standing in list(standings.all()):
            for result in standings.report(standing).results if standing.result is not None else ():
                criterion = result.criterion
                if chance() < (0.7 if result.is_open else 0.01):
                    points = (criterion.points * int(chance() * 9) / 8).quantize(Decimal("0.0001"))
                    mark(book, standing, criterion, min(points, criterion.points), "me", "")


def close(value: float, expected: float) -> bool:
    """Return whether a value equals another up to the rounding of JSON."""
    return abs(value - expected) < 2e-6


def test_marks(graded: tuple[list[dict[str, str]], dict[str, Any]]) -> None:
    """Mean, deviation (of the class, not of a sample), lowest, median, highest, tenths: over decided points."""
    rows, found = graded
    own = [row for row in rows if row["status"] == "graded"]
    scores, undecided = [], 0
    for row in own:
        is_empty = [
            row[criterion.id] == "" for criterion in LAB6.criteria if criterion.check.function not in MANUAL_CHECKS
        ]
        decided = float(row["max_score"]) - float(row["pending"])
        if float(row["max_score"]) == 100 and sum(is_empty) == len(is_empty):
            undecided += 1
        else:
            scores.append(round(float(row["score"]) * 100 / decided, 4))
    assert found["graded"] == len(own) > 40
    assert found["undecided"] == undecided
    assert found["pending"] == sum(float(row["pending"]) > 0 for row in own) > 0
    assert close(found["mean"], standard.fmean(scores))
    assert close(found["deviation"], standard.pstdev(scores))
    assert (found["lowest"], found["highest"]) == (min(scores), max(scores))
    assert close(found["median"], standard.median(scores))
    assert found["tenths"] == np.histogram(scores, bins=10, range=(0, 100))[0].tolist()
    assert found["counts"] == dict(Counter(row["status"] for row in rows))


def test_points_are_earned_lost_or_undecided(graded: tuple[list[dict[str, str]], dict[str, Any]]) -> None:
    """The three add up to the maximum of all graded submissions."""
    rows, found = graded
    own = [row for row in rows if row["status"] == "graded"]
    earned, pending, most = (sum(Decimal(row[name]) for row in own) for name in ("score", "pending", "max_score"))
    assert [Decimal(str(found["points"][name])) for name in ("earned", "lost", "pending")] == [
        earned,
        most - earned - pending,
        pending,
    ]


def test_criteria(graded: tuple[list[dict[str, str]], dict[str, Any]]) -> None:
    """The share of the points, and its correlation with the rest of the score."""
    rows, found = graded
    points = [[row[name] for name in CRITERIA] for row in rows if row["status"] == "graded"]
    earned = np.array([[float(cell or 0) for cell in row] for row in points])
    decided = np.array([[bool(cell) for cell in row] for row in points])
    most = np.array([float(criterion.points) for criterion in LAB6.criteria])
    assert [criterion["id"] for criterion in found["criteria"]] == CRITERIA
    for index, criterion in enumerate(found["criteria"]):
        who = decided[:, index]
        share = earned[who, index] / most[index]
        rest = earned[who].sum(axis=1) - earned[who, index]
        assert close(criterion["share"], float(share.mean()))
        assert close(criterion["discrimination"], float(np.corrcoef(share, rest)[0, 1]))
        reported = ("passed", "manual_marks", "carried", "failed", "skipped")
        assert sum(criterion[name] for name in reported) == who.sum()
    manual = sum(criterion["manual_marks"] for criterion in found["criteria"])
    assert manual > 60


def test_failures(graded: tuple[list[dict[str, str]], dict[str, Any]]) -> None:
    """The most frequent failures come first, and none is more frequent than lost points of its criterion."""
    rows, found = graded
    counts = [failure["count"] for failure in found["failures"]]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > 3
    most = {criterion.id: criterion.points for criterion in LAB6.criteria}
    for name in {failure["criterion"] for failure in found["failures"]}:
        missed = sum(row["status"] == "graded" and row[name] != "" and Decimal(row[name]) < most[name] for row in rows)
        assert sum(failure["count"] for failure in found["failures"] if failure["criterion"] == name) <= missed


def of(path: Path, *signs: str, rubric: Any = LAB) -> ClassStatistics:
    """Return the statistics of submissions with these results."""
    with Gradebook(path / "book.db", create=True) as book:
        results = [
            graded_as(rubric, f"s{number}", row, reason="" if row else "no zip") for number, row in enumerate(signs)
        ]
        record_run(book, rubric, results)
        return statistics(book, rubric)


def test_equal_scores_have_no_discrimination(tmp_path: Path) -> None:
    """If the rest of the score is the same for all, there is no correlation, in whichever order points are added."""
    rubric = lab(loads="0.1", box="0.2", tall="0.3", essay="0.7")
    signs = [sign_row for sign_row in ("pppfp", "pppff") for _ in range(7)]
    found = of(tmp_path, *signs, rubric=rubric)
    assert [criterion.discrimination for criterion in found.criteria] == [None] * 5


def test_a_criterion_without_points_still_has_a_share(tmp_path: Path) -> None:
    """The share of passes is reported even if the criterion has no points; it does not affect the rest of the score."""
    found = of(tmp_path, "ppppp", "ppppf", "fpppf", rubric=lab(picture="0")).criteria
    assert found[-1].share == pytest.approx(1 / 3)
    assert found[0].discrimination is None
    assert found[-1].discrimination == pytest.approx(float(np.corrcoef([1, 0, 0], [10, 10, 7])[0, 1]))


@pytest.mark.parametrize(("score", "bin_of_it"), [("ppppp", 9), ("fffff", 0), ("pppff", 5), ("ppp-f", 8)])
def test_all_points_are_in_the_last_tenth(score: str, bin_of_it: int, tmp_path: Path) -> None:
    """A mark at a boundary is in the upper tenth; full marks are in the last. The tenths are those of the graded parts."""
    assert of(tmp_path, score).bins.index(1) == bin_of_it


def test_a_manually_overridden_failure_is_not_counted(tmp_path: Path) -> None:
    """A failure with a manual mark of full points is not counted; with fewer points it is."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, LAB, [graded_as(LAB, key, "pfspp") for key in ("anna", "ben", "cleo")])
        standings = Grades(book)
        for key, points in (("anna", "2.5"), ("ben", "1")):
            mark(book, standings.find(key), LAB.criteria[1], Decimal(points), "me", "")
        found = statistics(book, LAB)
    assert [(failure.criterion.id, failure.count) for failure in found.failures] == [("box", 2)]
    box = found.criteria[1]
    assert (box.passed, box.manual_marks, box.failed, box.decided) == (0, 2, 1, 3)
    assert box.share == pytest.approx(3.5 / 7.5)


def test_names_do_not_split_a_group(tmp_path: Path) -> None:
    """Two students who made the same mistake with other names of joints are in one group."""
    text = (ROOT / "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf").read_text()
    (tmp_path / "class").mkdir()
    for key, joint in (("anna", "base_lidar_joint"), ("ben", "lidar's joint")):
        (tmp_path / "class" / f"{key}.urdf").write_text(text.replace("base_lidar_joint", joint))
    grader("batch", tmp_path / "class", "--gradebook", tmp_path / "book.db", "--jobs", 1, "--part", "task1")
    found = json.loads(grader("stats", "--gradebook", tmp_path / "book.db", "--format", "json").stdout)
    counts = {failure["criterion"]: failure["count"] for failure in found["statistics"]["failures"]}
    assert counts == {"lidar-frame": 2, "lidar-on-top": 2, "joint-names": 1}
