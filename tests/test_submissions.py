"""The sample submissions: the reference and its equivalents get full marks, each mistake loses its criteria."""

import csv
import filecmp
from collections.abc import Iterable, Iterator
from dataclasses import replace
from decimal import Decimal
from itertools import pairwise
from pathlib import Path

import pytest

from grader.lab.grading.grade import grade
from grader.lab.rubric.hint_levels import HintLevel
from grader.lab.rubric.rubric import Rubric, load_rubric, shipped_rubrics
from grader.lab.submission.opening import open_submission
from grader.ros.known.releases import Release
from grader.ros.package.robot_file import Read
from tests.command_line import run
from tests.sample_class import FOLDER, STUDENTS, TOP, package_files
from tests.sample_files import generated, lost_criteria, packages
from tests.samples import LAB6, ROOT, SAMPLES, Sample, opened

REFERENCE = "submissions/lab6/reference/roscourse_sim_ws/src/my_robot"


def differences(sample: Sample) -> Iterator[tuple[str, object]]:
    """Yield what a report has that expected.toml does not name."""
    report, expected, urdf = sample.grade(), sample.expected, sample.open().urdf
    statuses = {result.criterion.id: result.outcome.status for result in report.results}
    carried = [result.criterion.id for result in report.results if result.carried]
    lost = [
        name
        for name, status in statuses.items()
        if status in ("failed", "skipped") and name not in carried
    ]
    costly = [
        result.criterion.maximum
        for result in report.results
        if result.criterion.id in (*lost, *expected.pending)
    ]
    failed: set[str] = set()
    for result in report.results:
        if result.outcome.status == "skipped" and result.because not in failed:
            yield "a skip that no failure causes", result.criterion.id
        elif result.outcome.status == "failed":
            failed.add(result.criterion.id)
    for name, found, wanted in (
        ("verdict", urdf.loaded.verdict if isinstance(urdf, Read) else "missing", expected.verdict),
        ("lost", lost, list(expected.lost)),
        ("carried", carried, list(expected.carried)),
        ("points", report.max_score + report.bonus - report.score, sum(costly)),
        (
            "pending",
            [name for name, status in statuses.items() if status == "pending"],
            list(expected.pending),
        ),
        ("errored", [name for name, status in statuses.items() if status == "errored"], []),
    ):
        if found != wanted:
            yield name, found


@pytest.mark.slow
def test_every_sample_loses_the_expected_criteria() -> None:
    """Verdict, lost, carried and pending criteria are those in expected.toml, and an earlier failure causes each skip."""
    found = {name: [*differences(sample)] for name, sample in SAMPLES.items()}
    assert {name: wrong for name, wrong in found.items() if wrong} == {}


def _marks(sample: Sample, rubric: Rubric) -> list[tuple[str, str, Decimal | None, str]]:
    """Return what a sample gets for each criterion of a rubric."""
    report = grade(rubric, opened(sample.path, rubric))
    return [
        (it.criterion.id, it.outcome.status, it.points, it.outcome.message) for it in report.results
    ]


@pytest.mark.exhaustive
def test_every_sample_has_the_same_marks_in_a_lab_for_lyrical() -> None:
    """No sample uses what one of the two releases lacks."""
    assert _differing([("lyrical", "cause"), ("jazzy", "cause")]) == []


@pytest.mark.exhaustive
def test_marks_do_not_depend_on_hints() -> None:
    """What is read as it is meant is found in the files alone."""
    assert _differing([("jazzy", "none"), ("jazzy", "edit")]) == []


def _differing(settings: Iterable[tuple[Release, HintLevel]]) -> list[str]:
    """Return the samples whose marks differ between labs for releases with hints of some levels."""
    return [
        name
        for name, sample in SAMPLES.items()
        for first, second in pairwise(
            _marks(sample, replace(sample.rubric, distro=distro, hints=hints))
            for distro, hints in settings
        )
        if first != second
    ]


def test_there_are_enough_samples() -> None:
    """At least five equivalents and fifteen mistakes; only the reference and the equivalents lose nothing."""
    full = {
        name
        for name, sample in SAMPLES.items()
        if not lost_criteria(sample, sample.rubric) and len(sample.expected.pending) < 4
    }
    assert full == {
        name for name in SAMPLES if name.rpartition("/")[2].startswith(("reference", "equivalent-"))
    }
    assert len(full) >= 6
    assert len(SAMPLES) - len(full) >= 15


@pytest.mark.parametrize("name", shipped_rubrics())
def test_a_reference_gets_full_marks(name: str) -> None:
    """The reference solution of every shipped rubric passes all criteria that need no manual grading."""
    rubric = load_rubric(name)
    path = str(rubric.path.parent / rubric.reference)
    report = grade(rubric, open_submission(path, rubric.lab))
    assert report.max_score == rubric.points
    assert report.score + report.pending == rubric.points
    assert report.problems == ()


def test_the_rubric_contains_the_reference() -> None:
    """The rubric's reference solution equals the package of the sample of that name, byte for byte."""
    compared = filecmp.dircmp(
        LAB6.path.parent / LAB6.reference, ROOT / REFERENCE, ignore=["__pycache__"]
    )
    waiting = [compared]
    while waiting:
        folders = waiting.pop()
        assert not (folders.left_only or folders.right_only or folders.diff_files), folders.left
        waiting += folders.subdirs.values()


@pytest.mark.slow
def test_the_files_that_follow_from_others_are_current() -> None:
    """READMEs, packages and the class are those that `python tests/sample_files.py` writes, and nothing is beside them."""
    expected = dict(generated())
    assert [
        path for path, data in expected.items() if not path.is_file() or path.read_bytes() != data
    ] == []
    for folder, files in packages():
        assert package_files(folder).keys() == files.keys(), folder
    assert {path for path in (FOLDER / "files").iterdir()} == {
        path for path in expected if path.parent.name == "files"
    }


@pytest.mark.slow
def test_the_class_is_graded_by_the_command_of_its_readme(tmp_path: Path) -> None:
    """Two are perfect, most lose something; a file is missing, another broken, one is late, one was submitted again."""
    command = next(line for line in TOP.splitlines() if line.startswith("grader ")).removeprefix(
        "grader "
    )
    book = str(tmp_path / "grades")
    done = run((*command.split(), "--gradebook", book))
    assert (done.returncode, done.stderr.count(b"\n")) == (0, 4), done.stderr
    rows = [
        *csv.DictReader(run(("export", "csv", "--gradebook", book)).stdout.decode().splitlines())
    ]
    assert [row["name"] for row in rows] == [student["name"] for student in STUDENTS]
    graded = {row["name"]: int(row["score"]) for row in rows if row["status"] == "graded"}
    assert graded == {
        student["name"]: student["points"] for student in STUDENTS if "points" in student
    }
    assert [row["name"] for row in rows if row["late_days"] not in ("", "0")] == ["Jon Juniper"]
    assert [row["status"] for row in rows if row["name"] not in graded] == ["missing", "unreadable"]
