"""One slip costs one criterion its points, whatever ROS 2 does with it, and hides no other mistake."""

from collections import Counter
from functools import cache

import pytest

from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.edited import with_files
from grader.lab.submission.submission import Submission
from tests.grading.slips import (
    DIFFDRIVE,
    WrittenSlip,
    solution,
    with_something_ignored,
    written_slips,
)
from tests.samples import LAB6

pytestmark = pytest.mark.slow

SLIPS = [*written_slips()]
KINDS = [*dict.fromkeys((slip.rubric.id, slip.kind) for slip in SLIPS)]
_PAIRED = 29  # every so many slips are tried beside mistakes of values

# Mistakes of values: the end of the file, what is replaced, and the criteria that pay.
VALUES = {
    LAB6.id: [
        ("my_robot.urdf", 'rgba="0 0.6 0 1"', 'rgba="0 0.9 0 1"'),
        ("my_robot.urdf", 'xyz="0.15 0 0.225"', 'xyz="0.15 0 0.25"'),
        ("my_robot.urdf", 'radius="0.05"', 'radius="0.06"'),
        ("my_robot.urdf", 'xyz="0.2 0 -0.05"', 'xyz="0.3 0 -0.05"'),
        ("my_robot.rviz", "Fixed Frame: base_footprint", "Fixed Frame: odom"),
    ],
    DIFFDRIVE.id: [
        ("diffdrive.urdf.xacro", '"0.3 0.2 0.08"', '"0.3 0.2 0.07"'),
        ("diffdrive.urdf.xacro", 'mass value="2"', 'mass value="3"'),
        ("controllers.yaml", "wheel_separation: 0.24", "wheel_separation: 0.3"),
        ("diffdrive.rviz", "Fixed Frame: odom", "Fixed Frame: map"),
        ("package.xml", "<build_type>ament_cmake<", "<build_type>ament_python<"),
    ],
}


_RUBRICS = {rubric.id: rubric for rubric in (LAB6, DIFFDRIVE)}


@cache
def _correct(rubric: str) -> Report:
    return grade(_RUBRICS[rubric], solution(_RUBRICS[rubric]))


def _graded(submission: Submission, rubric: Rubric) -> Report:
    report = grade(rubric, submission)
    assert not report.fault
    return report


def _lost(report: Report) -> Counter[str]:
    """Return what each criterion lost, and what is open that a correct submission has decided."""
    correct = {result.criterion.id: result for result in _correct(report.rubric.id).results}
    lost = Counter[str]()
    for result in report.results:
        name = result.criterion.id
        if result.is_lost:
            lost[name] = int(result.criterion.points * 100)
        elif result.is_open and not correct[name].is_open:
            lost[f"open: {name}"] = 1
    return lost


def _with(slip: WrittenSlip, text: str = "") -> Submission:
    return with_files(solution(slip.rubric), {slip.path: (text or slip.text).encode()})


def test_there_are_enough() -> None:
    """There are slips of six kinds of files."""
    assert len(SLIPS) > 300
    assert len({kind for _, kind in KINDS}) >= 6


@pytest.mark.parametrize(("rubric", "kind"), KINDS)
def test_a_slip_costs_one_criterion(rubric: str, kind: str) -> None:
    """At most one criterion loses points, nothing is open, and the report names the line at the one that pays."""
    wrong = []
    paid = 0
    for slip in SLIPS:
        if (slip.rubric.id, slip.kind) != (rubric, kind):
            continue
        report = _graded(_with(slip), slip.rubric)
        lost = _lost(report)
        paid += len(lost)
        if len(lost) > 1 or any(name.startswith("open") for name in lost):
            wrong.append((slip.name, lost))
        if report.meant is not None:
            lines = [str(one.slip.location.line) for one in report.meant.paid]
            payer = next(it for it in report.results if it.criterion.id in lost)
            assert any(line in payer.outcome.message for line in lines), slip.name
            codes = [problem.code for problem in report.problems]
            assert codes.count("URDF015") >= len(lines)
    assert wrong == []
    assert paid


@pytest.mark.parametrize("slip", SLIPS[::_PAIRED], ids=lambda slip: f"{slip.rubric.id}-{slip.name}")
def test_a_slip_hides_no_mistake(slip: WrittenSlip) -> None:
    """Beside a mistake of a value elsewhere the costs add, unless one criterion pays for both."""
    alone = _lost(_graded(_with(slip), slip.rubric))
    for end, old, new in VALUES[slip.rubric.id]:
        files = solution(slip.rubric).whole_tree.files
        path = next(path for path in files if path.endswith(end))
        text = files[path].read(1 << 20).decode()
        assert old in text
        value = with_files(solution(slip.rubric), {path: text.replace(old, new).encode()})
        other = _lost(_graded(value, slip.rubric))
        if path == slip.path:
            if old not in slip.text:
                continue
            both = _with(slip, slip.text.replace(old, new))
        else:
            both = with_files(value, {slip.path: slip.text.encode()})
        assert _lost(_graded(both, slip.rubric)) == alone | other, (new, slip.name)


def test_edits_that_do_not_fit_are_left() -> None:
    """A slip whose text is written in another way than it reads is left as it is written."""
    files = solution(DIFFDRIVE).whole_tree.files
    path = next(path for path in files if path.endswith("controllers.yaml"))
    text = files[path].read(1 << 20).decode()
    keyed = text.replace("drive_circle:\n  ros__parameters", 'drive_circle:\n  "ros_parameters"')
    report = _graded(with_files(solution(DIFFDRIVE), {path: keyed.encode()}), DIFFDRIVE)
    assert report.meant is None
    assert _lost(report)


def test_a_package_without_a_robot() -> None:
    """A slip in a package is corrected where there is no URDF, too."""
    submission = solution(LAB6)
    files: dict[str, bytes | None] = {}
    for path, file in submission.whole_tree.files.items():
        if path.endswith("setup.py"):
            files[path] = file.read(1 << 20).replace(b"zip_safe=True,", b"zip_safe=True")
        elif path.endswith(".urdf"):
            files[path] = None
    report = _graded(with_files(submission, files), LAB6)
    assert report.meant is not None
    assert [paid.payer for paid in report.meant.paid] == ["setup-imports"]


def test_what_is_ignored_without_harm_costs_nothing() -> None:
    """A robot that is right as written keeps its points, beside a mistake elsewhere as well."""
    files = solution(LAB6).whole_tree.files
    path = next(path for path in files if path.endswith("my_robot.urdf"))
    text = files[path].read(1 << 20).decode().replace('rgba="0 0.6 0 1"', 'rgba="0 0.9 0 1"')
    expected = _lost(_graded(with_files(solution(LAB6), {path: text.encode()}), LAB6))
    assert [*expected] == ["base-green"]
    robots = [*with_something_ignored(text)]
    assert len(robots) > 300
    wrong = []
    for robot in robots:
        lost = _lost(_graded(with_files(solution(LAB6), {path: robot.encode()}), LAB6))
        if lost != expected:
            wrong.append((robot, lost))
    assert wrong == []
