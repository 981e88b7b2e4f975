"""Mistakes in xacro robots: the edit of the xacro with which everything passes again is found and proven."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import pytest

from grader.base.element_edits import edited
from grader.base.errors import InputError
from grader.base.source import Edit
from grader.files.tree import Tree, overlaid
from grader.lab.hints.search import HintSearch, Trials
from grader.lab.submission.opening import read_submission
from grader.lab.submission.submission import Submission
from tests.hints.trials import graded, search_for
from tests.samples import LAB6, RUBRICS, SAMPLES, reference

pytestmark = pytest.mark.slow

INERTIALS = SAMPLES["equivalent-xacro-inertials"].alone
MACROS = SAMPLES["equivalent-xacro-macros"]
WHEEL = "my_robot/urdf/wheel.xacro"
URDF = "my_robot/urdf/my_robot.urdf"
MACROS_WHEEL = MACROS.open().whole_tree.files[WHEEL].read(1 << 20).decode()
PROCESSED = ["import xacro\n", "xacro.process_file(os.path.join(share, 'my_robot.urdf')).toxml()"]


def search(submission: Submission) -> HintSearch:
    """Return the finished search for edits of a submission."""
    return search_for(submission, graded(submission))


def failed(search: HintSearch) -> list[str]:
    """Return the criteria that lose points with all edits."""
    return [name for name, result in search.results.items() if result.is_lost]


def mutant(path: str, old: str, new: str) -> tuple[Submission, str]:
    """Return the sample with macros, or the one in a single file, with a mistake in a file; and the text of this file."""
    submission = (MACROS if path != "" else INERTIALS).open()
    assert submission.reopen is not None or path == ""
    data = submission.whole_tree.files[path].read(1 << 20) if path else submission.urdf.data  # type: ignore[union-attr]
    text = data.decode().replace(old, new, 1)
    assert text.encode() != data
    if submission.reopen is None:
        return read_submission(text.encode(), identity="student", path="my_robot.urdf.xacro"), text
    return submission.reopen(overlaid(submission.whole_tree, {path: text.encode()})), text


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("", '"wheel_radius" value="0.1"', '"wheel_radius" value="0.01"'),
        ("", '"length" value="0.6"', '"length" value="6"'),
        ("", "${length/4}", "${length*4}"),
        ("", 'xyz="0 0 ${height/2}"', 'xyz="0 0.1 ${height/2}"'),
        (
            "",
            '${-length/4} ${-width/2} 0" rpy="${-pi/2}',
            '${-length/4} ${-width/2} 0" rpy="${pi/2}',
        ),
        ("", "${height+0.05/2}", "${height-0.05/2}"),
        ("", "${length/3} 0 ${-wheel_radius/2}", "${length/3} 0 ${wheel_radius/2}"),
        ("", 'izz="${(1/2) * mass', 'izz="${(1/2) * mas'),
        ("", 'name="inertial_box"', 'name="inertia_box"'),
        (URDF, 'side="left" outward="1"', 'side="left" outward="-1"'),
        (URDF, 'side="right"', 'side="rigth"'),
        (URDF, 'xyz="-0.15 -0.2 0" rpy="${-pi/2} 0 0"', 'xyz="-0.15 -0.2 0" rpy="${pi/2} 0 0"'),
        (URDF, 'filename="wheel.xacro"', 'filename="wheels.xacro"'),
        (WHEEL, 'name="wheel_width"', 'name="wheel_with"'),
        (WHEEL, 'name="${side}_wheel"', 'name="${side}_whel"'),
        (WHEEL, 'type="continuous"', 'type="fixed"'),
        (WHEEL, 'params="side outward', 'params="side outwards'),
        (WHEEL, '      <axis xyz="0 0 1"/>\n', ""),
    ],
)
def test_a_mistake_in_xacro_is_undone(path: str, old: str, new: str) -> None:
    """A wrong number, sign, operator, argument or name in xacro is undone by an edit of the xacro."""
    submission, text = mutant(path, old, new)
    found = search(submission)
    assert not failed(found)
    [first] = found.found
    names = {edit.path for edit in first.edits}
    assert names <= {path or "my_robot.urdf.xacro", WHEEL}
    for name in names & {path or "my_robot.urdf.xacro"}:
        assert edited(text, name, first.edits) is not None


@pytest.mark.parametrize(
    ("left", "right", "expected"),
    [
        ("-1", "-1", {'outward="1"'}),
        ("${-wheel_radius * 10}", "-1", {'outward="${wheel_radius * 10}"'}),
        ("${wheel_radius * 5}", "-1", {'outward="1"'}),
    ],
)
def test_an_expression_in_a_call_is_corrected_there(
    left: str, right: str, expected: set[str]
) -> None:
    """The macro, which other calls use, stays as it is: the mistake is in the call."""
    submission, text = mutant(URDF, 'side="left" outward="1"', f'side="left" outward="{left}"')
    assert submission.reopen is not None
    files = {URDF: text.replace('outward="-1"', f'outward="{right}"').encode()}
    found = search(submission.reopen(overlaid(submission.whole_tree, files)))
    assert not failed(found)
    assert set(texts(found.edits)) == expected


_LEFT, _RIGHT = 'y="${wheel_separation / 2}"', 'y="${-wheel_separation / 2}"'


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({_LEFT: 'y="${wheel_separation}"'}, {'y="0.12"'}),
        ({_LEFT: _RIGHT, _RIGHT: _LEFT}, {_LEFT, _RIGHT}),
        ({'"wheel_separation" value="0.24"': '"wheel_separation" value="0.42"'}, {'value="0.24"'}),
    ],
)
def test_a_value_that_a_macro_gets_computed_is_corrected_where_it_is_given(
    changes: Mapping[str, str], expected: set[str]
) -> None:
    """In the call or in the property that the call uses; if both wheels are wrong for it, by one hint."""
    correct = reference(RUBRICS["diffdrive"])
    [path] = [it for it in correct.whole_tree.files if it.endswith("diffdrive.urdf.xacro")]
    text = correct.whole_tree.files[path].read(1 << 20).decode()
    wrong = re.sub("|".join(map(re.escape, changes)), lambda it: changes[it[0]], text)
    assert wrong != text
    assert correct.reopen is not None
    submission = correct.reopen(overlaid(correct.whole_tree, {path: wrong.encode()}))
    [found] = search_for(
        submission, graded(submission, RUBRICS["diffdrive"]), RUBRICS["diffdrive"]
    ).found
    assert set(texts(found.edits)) == expected


def test_a_mistake_in_a_macro_is_not_corrected_in_its_calls() -> None:
    """Each call could get another value, but all of them are wrong for what the macro does with it."""
    submission, _ = mutant(WHEEL, "wheel_width / 2}", "wheel_width}")
    found = search(submission)
    assert not [edit for edit in found.edits if edit.path == URDF]


def texts(edits: Sequence[Edit]) -> list[str]:
    """Return what an edit writes, or the new name of its file."""
    return [edit.renamed or edit.new for edit in edits]


@pytest.mark.parametrize(
    ("sample", "expected"),
    [
        ("raw-xacro", ["my_robot.urdf.xacro"]),
        ("xacro-macro-for-wheels", PROCESSED),
        ("xacro-in-urdf", PROCESSED),
    ],
)
def test_xacro_that_ros_2_loads_as_it_stands(sample: str, expected: list[str]) -> None:
    """A launch file that reads the file runs xacro instead; a file on its own gets a name that says xacro."""
    [found] = search(SAMPLES[sample].open()).found
    assert texts(found.edits) == expected
    assert list(found.gains) == ["urdf-loads"]


def test_raw_xacro_with_another_mistake() -> None:
    """Both are corrected, each by an edit of the file as it was submitted."""
    text = SAMPLES["raw-xacro"].open().urdf.data.decode()  # type: ignore[union-attr]
    wrong = text.replace("${base_height + wheel_width/2}", "${base_height - wheel_width/2}")
    submission = read_submission(wrong.encode(), identity="student", path="my_robot.urdf")
    found = search(submission)
    assert not failed(found)
    assert {edit.path for edit in found.edits} == {"my_robot.urdf"}
    assert 'xyz="${base_length/4} 0 0.225"' in texts(found.edits)


def test_edits_after_which_nothing_can_be_read() -> None:
    """They have no results, as a submission that is too large by one of them."""
    submission, _ = mutant(URDF, 'side="left" outward="1"', 'side="left" outward="-1"')

    def refuse(tree: Tree) -> Submission:
        raise InputError(f"{tree.name} is too large")

    edit = search(submission).found[0].edits[0]
    results = graded(submission)
    trials = Trials(LAB6, replace(submission, reopen=refuse), results)
    assert trials.graded((edit,), list(results), whole=True) == {}


LAUNCH = "my_robot/launch/my_robot_rviz.launch.py"
READ = "    with open(os.path.join(share, 'my_robot.urdf')) as file:\n        robot_description = file.read()\n"
PATH = "os.path.join(share, 'my_robot.urdf')"


@pytest.mark.parametrize(
    ("reading", "expected"),
    [
        (
            f"    robot_description = open({PATH}, 'r').read()\n",
            f"xacro.process_file({PATH}).toxml()",
        ),
        (
            f"    path = {PATH}\n    file = open(path)\n    robot_description = file.read()\n",
            "xacro.process_file(path).toxml()",
        ),
        (
            f"    from launch.substitutions import Command\n    robot_description = Command(['cat ', {PATH}])\n",
            "xacro",
        ),
    ],
)
def test_a_launch_file_runs_xacro(reading: str, expected: str) -> None:
    """However the launch file reads the text, it can read the expansion."""
    submission = SAMPLES["xacro-in-urdf"].open()
    text = submission.whole_tree.files[LAUNCH].read(1 << 20).decode()
    assert READ in text
    assert submission.reopen is not None
    found = search(
        submission.reopen(
            overlaid(submission.whole_tree, {LAUNCH: text.replace(READ, reading).encode()})
        )
    )
    assert texts(found.found[0].edits)[-1] == expected
    assert not failed(found)
