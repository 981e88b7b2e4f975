"""A file that ROS 2 rejects, or drops content of, gets a proven hint: the edits that make ROS 2 load it."""

from pathlib import Path
from random import Random

import pytest

from grader.lab.hints.edits import FoundHint
from grader.lab.hints.search import HintSearch
from grader.lab.submission.edited import edited_files
from grader.lab.submission.opening import read_submission
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from tests.hints.broken_urdfs import BROKEN, REFERENCE, Broken
from tests.hints.trials import graded, search_for
from tests.samples import LAB6_SAMPLES, SAMPLES, opened

pytestmark = pytest.mark.slow

# Samples whose text is what is wrong; an empty file has no hint.
REJECTED = [
    name
    for name, sample in LAB6_SAMPLES.items()
    if sample.expected.verdict in ("rejected", "degraded")
    and "xacro" not in name
    and name != "empty-urdf"
]
_LACKING = {
    "footprint-without-joint",
    "lidar-without-joint",
    "links-without-joints",
    "truncated-file",
}
# Mistakes after which it is not certain which tag was meant, or that ROS 2 does not see as an error.
_NOT_UNDONE = {
    "tag-glued-to-its-attribute",
    "no-start-of-a-link",
    "no-start-of-a-joint",
    "robot-twice",
    "no-robot",
    "declaration-opened-badly",
}


def searched(submission: Submission) -> HintSearch:
    """Return the finished search for a submission."""
    return search_for(submission, graded(submission))


def written(folder: Path, text: str | bytes) -> Submission:
    """Return the submission of a single file."""
    path = folder / "my_robot.urdf"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return opened(path)


def fixed_text(submission: Submission, found: FoundHint | HintSearch) -> bytes:
    """Return the file after the edits of a hint, or of all."""
    files = edited_files(submission, found.edits)
    assert files is not None
    (data,) = filter(None, files.values())
    assert data is not None
    return data


@pytest.mark.parametrize("broken", BROKEN, ids=[broken.name for broken in BROKEN])
def test_what_ros_2_rejects_is_undone_or_left(broken: Broken, tmp_path: Path) -> None:
    """All hints together restore the robot that the student meant, or there is none that does not load."""
    submission = written(tmp_path, broken.text)
    search = searched(submission)
    if broken.name in _NOT_UNDONE:
        assert not search.found
        return
    assert search.found
    assert not any(result.is_lost for result in search.results.values())


@pytest.mark.parametrize("name", REJECTED)
def test_samples_that_ros_rejects_are_loaded_or_lack_a_part(name: str) -> None:
    """Every sample whose URDF ROS 2 rejects, or drops content of, is loaded with all edits, or lacks a joint."""
    search = searched(SAMPLES[name].open())
    if name in _LACKING:
        assert name == "truncated-file" or search.missing
    else:
        assert not search.results["urdf-loads"].is_lost


def test_one_mistake_in_many_places(tmp_path: Path) -> None:
    """Commas in every vector are corrected in each."""
    text = REFERENCE.replace('xyz="0 0 0.1"', 'xyz="0, 0, 0.1"').replace(
        'xyz="0 0 0.025"', 'xyz="0, 0, 0.025"'
    )
    search = searched(written(tmp_path, text))
    assert sorted(edit.new for edit in search.edits) == [
        'xyz="0 0 0.025"',
        'xyz="0 0 0.1"',
        'xyz="0 0 0.1"',
    ]


@pytest.mark.parametrize("text", [b"", b"\n", "robot".encode("utf-16"), b"this is no robot"])
def test_no_hint_where_too_much_is_missing(text: bytes, tmp_path: Path) -> None:
    """A file without any tag has no hint."""
    submission = written(tmp_path, text)
    if isinstance(submission.urdf, Read):
        assert not searched(submission).found


def test_xacro_in_a_urdf_is_not_repaired_number_by_number() -> None:
    """Where the xacro of a .urdf is what is wrong, no expression is replaced by its value."""
    assert not any(
        "${" in edit.old
        for found in searched(SAMPLES["raw-xacro"].open()).found
        for edit in found.edits
    )


def test_no_hint_loses_a_point(tmp_path: Path) -> None:
    """Random damage: every hint, graded from scratch, keeps what passed and gains what it says."""
    random = Random(14)
    for _ in range(8):
        text = REFERENCE
        for _ in range(random.randint(1, 3)):
            at = random.randrange(len(text))
            text = (
                text[:at]
                + random.choice(("", "", '"', "<", ">", "/", "=", ",", "</link>"))
                + text[at + 1 :]
            )
        submission = written(tmp_path, text)
        before = graded(submission)
        for found in searched(submission).found:
            after = graded(written(tmp_path, fixed_text(submission, found)))
            assert all(after[name].outcome.status == "passed" for name in found.gains), text
            assert all(after[name].points >= result.points for name, result in before.items()), text


def test_the_misspelt_name_of_an_attribute_is_corrected() -> None:
    """Its value stays, and nothing else of the tag changes."""
    text = REFERENCE.replace('<child link="lidar"/>', '<child lnik="lidar"/>')
    assert text != REFERENCE
    submission = read_submission(text.encode(), identity="ash", path="my_robot.urdf")
    [found] = searched(submission).found
    assert [(edit.old, edit.new) for edit in found.edits] == [('lnik="lidar"', 'link="lidar"')]
