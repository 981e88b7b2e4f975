"""A slip that hides much of a robot costs one criterion, and so does a value that is missing."""

from functools import cache

import pytest

from grader.lab.grading.deciding import decide
from grader.lab.grading.grade import grade
from grader.lab.grading.not_known import _with_payers
from grader.lab.grading.report import Report
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.edited import with_files
from grader.lab.submission.opening import read_submission
from tests.command_line import ROOT
from tests.grading.written_kinds import WAYS, WrittenKind, work, written_kinds
from tests.samples import LAB6

pytestmark = pytest.mark.slow


@cache
def _open_in_work(rubric: str, name: str) -> frozenset[str]:
    report = grade(load_rubric(rubric), work(rubric, name))
    return frozenset(result.criterion.id for result in report.results if result.is_open)


def _graded(slip: WrittenKind) -> Report:
    submission = with_files(work(slip.rubric.id, slip.work), {slip.path: slip.text.encode()})
    report = grade(slip.rubric, submission)
    assert not report.fault
    return report


@pytest.mark.parametrize("kind", dict.fromkeys(way.kind for way in WAYS))
def test_one_criterion_pays(kind: str) -> None:
    """At most one criterion loses points for a slip of each kind, nothing becomes open, and some cost something."""
    wrong = []
    costs = 0
    for slip in written_kinds(kind):
        report = _graded(slip)
        lost = [result for result in report.results if result.is_lost]
        still_open = {result.criterion.id for result in report.results if result.is_open}
        costs += len(lost)
        if len(lost) > 1 or still_open - _open_in_work(slip.rubric.id, slip.work):
            wrong.append((slip.name, lost, still_open))
    assert wrong == []
    assert costs


@pytest.mark.parametrize("kind", dict.fromkeys(way.kind for way in WAYS))
def test_marks_are_never_lower_than_as_written(kind: str) -> None:
    """A robot is never worse with a reading than with what is written alone."""
    for slip in written_kinds(kind):
        submission = with_files(work(slip.rubric.id, slip.work), {slip.path: slip.text.encode()})
        report = grade(slip.rubric, submission)
        wanted = {result.criterion.id for result in report.results}
        written = sum(result.points for result in decide(slip.rubric, submission, wanted))
        assert report.score >= written, slip.name


_LINKS = '<link name="base_link"/><link name="lidar"/>'
_JOINT = '<joint name="j" type="fixed"><parent link="base_link"/><child link="lidar"/></joint>'
_CALLS = '<xacro:m side="left" y="1"/><xacro:m side="left" y="1"/>'
_MACRO = '<xacro:macro name="m" params="{}"><link name="${{side}}_{{y}}"/></xacro:macro>'


@pytest.mark.parametrize(
    "body",
    [
        # A part that is not there on purpose.
        f"{_LINKS}<!-- wheel: not finished\n<link name='w'/>\n<!-- joint -->{_JOINT}",
        f"{_LINKS}<!-- old wheel\n<link name='w'/>\n<!-- joint -->{_JOINT}",
        # A comment that may end in two places.
        f"{_LINKS}<!-- wheel\n<link name='w'/>\n<!-- joint --> -->{_JOINT}",
        # A block of which * and ** give a robot each.
        '<xacro:macro name="m" params="a"><xacro:insert_block name="b"/></xacro:macro><link name="l"/>',
        # The student's own M_PI.
        '<xacro:property name="M_PI" value="3"/><link name="l${M_PI}"/>',
        # Two properties may stand for each of two words.
        '<xacro:property name="mass_left" value="1"/><xacro:property name="mass_right" value="2"/><link name="l${mass}"/>',
        # A command that is none of a launch file's.
        '<link name="l"/><xacro:include filename="$(where my_robot)/a.xacro"/>',
    ],
)
def test_what_may_be_several_things_is_left(body: str) -> None:
    """Nothing is assumed where a text can be read in two ways, or is written on purpose."""
    text = f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{body}</robot>'
    submission = read_submission(text.encode(), identity="r", path="my_robot.urdf.xacro")
    assert grade(LAB6, submission).meant is None


def test_a_value_that_xacro_refuses_is_one_value() -> None:
    """A mass that xacro cannot compute costs the mass, besides the file that does not load."""
    [slip] = [
        slip
        for slip in written_kinds("missing value")
        if slip.work == "equivalent-xacro-limits" and slip.old.startswith("<mass")
    ][:1]
    mass = slip.old.replace('value="', 'value="${(').replace('"/>', '}"/>')
    files = work(slip.rubric.id, slip.work).whole_tree.files
    text = files[slip.path].read(1 << 20).decode().replace(slip.old, mass)
    report = _graded(slip._replace(text=text))
    lost = [result.criterion.id for result in report.results if result.is_lost]
    assert lost[0] == "urdf-loads"
    assert len(lost) <= 2


def test_a_reading_that_earns_less_does_not_count() -> None:
    """The robot of another lab passes what is not there: its wheel in a comment would fail."""
    text = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
    hidden = text.replace(
        '<link name="right_wheel">', '<!-- the right wheel --\n<link name="right_wheel">'
    ).replace("</robot>", "<!-- the end -->\n</robot>")
    assert grade(
        load_rubric("lab6"), read_submission(hidden.encode(), identity="r", path="r.urdf")
    ).meant
    assert (
        grade(
            load_rubric("arm"), read_submission(hidden.encode(), identity="r", path="r.urdf")
        ).meant
        is None
    )


def test_the_first_that_a_passing_criterion_carries_pays() -> None:
    """Later ones are carried by it."""
    results = grade(load_rubric("lab6"), work("lab6", "reference")).results
    lost = results[:2]
    known = [result._replace(carried="base-on-ground") for result in lost]
    judged = _with_payers(lost, known)
    first, second = (result.criterion.id for result in lost)
    assert (judged[first].carried, judged[second].carried) == ("", first)
