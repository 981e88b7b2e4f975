"""What a hint may say: the cause first, alone if possible, never to please a tolerance, and nothing that makes the robot worse."""

import re
from dataclasses import replace

import pytest

from grader.lab.grading.grade import grade
from grader.lab.hints.hinting import hinted
from grader.lab.hints.search import Trials
from grader.lab.submission.opening import read_submission
from grader.lab.submission.submission import Submission
from tests.hints.trials import BASES, Hints, hints_for
from tests.samples import LAB6, SAMPLES

pytestmark = pytest.mark.slow

REFERENCE = BASES["reference"].text
MACROS = BASES["equivalent-xacro-macros"]


def edits_of(hints: Hints) -> list[list[tuple[str, str]]]:
    """Return the old and new texts of each hint."""
    return [[(edit.old, edit.new) for edit in found.edits] for found in hints.found]


def changed(*changes: tuple[str, str], text: str = REFERENCE) -> Submission:
    """Return a single URDF in which texts, each of which is there, are changed."""
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    return read_submission(text.encode(), identity="robot", path="my_robot.urdf")


def test_a_call_without_its_parameter_has_no_hint() -> None:
    """No hint writes a value that a macro call lacks, and no link is added beside it."""
    call = next(
        line for line in MACROS.text.split("\n") if "<xacro:wheel" in line and "right" in line
    )
    given = next(pair for pair in call.rstrip("/> ").split()[1:] if "right" not in pair)
    hints = hints_for(MACROS.changed(MACROS.text.replace(call, call.replace(f" {given}", ""))))
    assert edits_of(hints) == []


def test_each_hint_is_alone() -> None:
    """Two mistakes have a hint each, which contains nothing of the other one."""
    hints = hints_for(
        changed(
            ('xyz="0.15 0 0.225"', 'xyz="0.15 0 0.025"'), ('rgba="0 0.6 0 1"', 'rgba="0 1 0 1"')
        )
    )
    assert sorted(edits_of(hints)) == [
        [('rgba="0 1 0 1"', 'rgba="0 0.6 0 1"')],
        [('xyz="0.15 0 0.025"', 'xyz="0.15 0 0.225"')],
    ]


@pytest.mark.parametrize("size", ["6 4 2", "600 400 200", "0.01 0.01 0.0005"])
def test_no_edit_pleases_a_tolerance(size: str) -> None:
    """A box of another size at the origin gets the size and the place of the lab, not a size that sinks by less than 2 mm."""
    hints = hints_for(
        changed(
            ('size="0.6 0.4 0.2"', f'size="{size}"'), ('<origin xyz="0 0 0.1" rpy="0 0 0"/>', "")
        )
    )
    assert hints.is_full
    new = {new for edits in edits_of(hints) for _, new in edits if "size" in new}
    assert new == {'size="0.6 0.4 0.2"'}


def test_no_edit_adds_a_problem() -> None:
    """With all edits, ROS 2 rejects and drops nothing that it loaded before."""
    for name in ("several-mistakes", "caster-misnamed", "footprint-below-the-base", "box-sunk"):
        if name in SAMPLES:
            fixed = hints_for(SAMPLES[name].open()).fixed
            assert getattr(fixed.urdf, "loaded").verdict == "clean"  # noqa: B009  of any state of a URDF


def test_a_colour_in_a_link_is_corrected_there() -> None:
    """No second definition of the material is added under <robot>."""
    text = BASES["equivalent-materials-in-links"].text
    hints = hints_for(changed(('rgba="0.7 0.7 0.7 1"', 'rgba="0.1 0.1 0.4 1"'), text=text))
    assert hints.is_full
    assert edits_of(hints) == [[('rgba="0.1 0.1 0.4 1"', 'rgba="0.7 0.7 0.7 1"')]]


def test_a_property_without_prefix_gets_it() -> None:
    """The cause is where the property is written, not where its value is missing."""
    base = BASES["equivalent-xacro-numbers"]
    first = base.text.index("<xacro:property")
    hints = hints_for(
        base.changed(f"{base.text[:first]}<property{base.text[first + len('<xacro:property') :]}")
    )
    assert hints.is_full
    assert edits_of(hints)[0] == [("<property", "<xacro:property")]


def test_exchanged_expressions_are_exchanged() -> None:
    """They are not replaced by numbers."""
    base, right, wrong = (
        BASES["equivalent-xacro-inertials"],
        "${length/4} 0 ${height+0.05/2}",
        "${length/4} ${height+0.05/2} 0",
    )
    assert right in base.text
    hints = hints_for(base.changed(base.text.replace(right, wrong)))
    assert hints.is_full
    assert edits_of(hints) == [[(f'xyz="{wrong}"', f'xyz="{right}"')]]


def test_hints_that_do_not_hold_from_scratch_are_taken_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """All edits together are graded once more, with the submission read as a new one."""
    submission = changed(('xyz="0.15 0 0.225"', 'xyz="0.15 0 0.025"'))
    assert hints_for(submission).found
    of_trial = Trials.graded
    fails_whole = lambda self, edits, wanted, *, whole=False: (
        {} if whole else of_trial(self, edits, wanted)
    )
    monkeypatch.setattr(Trials, "graded", fails_whole)
    assert not hints_for(submission).found


def test_a_missing_joint_is_only_said() -> None:
    """A link without a joint is not removed, though the URDF would load without it, and the joint is not written."""
    joint = re.search(r'  <joint name="base_lidar_joint".*?</joint>\n', REFERENCE, re.DOTALL)
    assert joint is not None
    submission = changed((joint[0], ""))
    report = grade(replace(LAB6, criteria=LAB6.criteria[:1]), submission)
    hint = hinted(report, submission, "edit").report.results[0].hint
    assert hint is not None
    assert hint.message.startswith("Add a fixed joint from 'base_link' to 'lidar'")
    assert not hint.edits
