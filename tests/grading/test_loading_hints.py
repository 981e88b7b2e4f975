"""A file that ROS 2 rejects, or drops content of, gets a proven hint: the edits that make ROS 2 load it."""

from pathlib import Path
from random import Random

import pytest

from grader.grading.grade import grade
from grader.grading.hints.loading import repair
from grader.grading.hints.search import FoundHint, HintSearch
from grader.grading.hints.trials import Trials
from grader.grading.report import Result
from grader.robot.edits.draft import Draft
from grader.robot.normal_form import normal_form
from grader.robot.reader import Reading, read_urdf
from grader.submission.editing import edited_files
from grader.submission.submission import Submission
from grader.submission.urdf import Read
from tests.examples import spread
from tests.grading.broken_urdfs import BROKEN, REFERENCE, Broken
from tests.robot.problem_samples import SAMPLES as PROBLEMS
from tests.samples import LAB6, LAB6_SAMPLES, SAMPLES, opened

# Samples whose text is what is wrong; an empty file has no hint.
REFERENCE_DRAFT = Draft.of(read_urdf(REFERENCE.encode()))
REJECTED = [
    name
    for name, sample in LAB6_SAMPLES.items()
    if sample.expected.verdict in ("rejected", "degraded") and "xacro" not in name and name != "empty-urdf"
]
# Problems whose samples stay as they are, with the reason.
_BEYOND_REPAIR = {
    "URDF003": "an empty file",
    "URDF004": "the samples have no links",
    "URDF007": "tags nested 499 times",
    "URDF008": "UTF-16",
    "URDF013": "another format",
    "URDF022": "a robot without links",
    "URDF085": "thousands of paths",
    "URDF099": "thousands of problems",
}


def results_of(submission: Submission) -> dict[str, Result]:
    """Return the results of a submission by criterion."""
    return {result.criterion.id: result for result in grade(LAB6, submission).results}


def searched(submission: Submission) -> HintSearch:
    """Return the finished search for a submission."""
    return HintSearch(Trials(LAB6, submission, results_of(submission)), REFERENCE_DRAFT).run()


def written(folder: Path, text: str | bytes) -> Submission:
    """Return the submission of a single file."""
    path = folder / "my_robot.urdf"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return opened(path)


def reading_of(submission: Submission) -> Reading:
    """Return what was read of the URDF."""
    assert isinstance(submission.urdf, Read)
    return submission.urdf.reading


def model(reading: Reading) -> object:
    """Return the links and joints of a robot, however they are written."""
    assert reading.robot is not None
    return repr(normal_form(reading.robot))


def repaired_text(submission: Submission, found: FoundHint) -> bytes:
    """Return the file after the edits of a hint."""
    files = edited_files(submission, found.edits)
    assert files is not None
    (data,) = files.values()
    assert data is not None
    return data


@pytest.mark.parametrize("broken", spread(BROKEN, 30), ids=[broken.name for broken in BROKEN])
def test_repair_restores_the_robot(broken: Broken, tmp_path: Path) -> None:
    """One hint restores the robot that the student meant, and all points, with edits of few characters."""
    submission = written(tmp_path, broken.text)
    search = searched(submission)
    best = max(search.found, key=lambda found: len(found.gains))
    after = read_urdf(repaired_text(submission, best))
    assert after.verdict == "clean"
    assert model(after) == model(read_urdf(REFERENCE.encode()))
    assert sum(len(edit.old) + len(edit.new) for edit in best.edits) < 700


@pytest.mark.parametrize("name", REJECTED)
def test_samples_that_ros_rejects_have_a_hint(name: str) -> None:
    """Every sample whose URDF ROS 2 rejects, or drops content of, has hints with which ROS 2 loads all of it."""
    search = searched(SAMPLES[name].open())
    assert search.found
    assert "urdf-loads" not in search.final.failed


def test_several_mistakes_are_repaired_one_after_the_other(tmp_path: Path) -> None:
    """A chain of repairs, each of which makes ROS 2 read on, reject or drop less, is one hint for `urdf-loads`."""
    text = REFERENCE.replace("</visual>", "", 1).replace('<child link="lidar"/>', '<child="lidar"/>')
    text = text.replace('xyz="0.2 0 -0.05"', 'xyz="0.2, 0, -0.05"').replace('type="continuous"', 'type="continous"')
    submission = written(tmp_path, text)
    (found,) = [found for found in searched(submission).found if "urdf-loads" in found.gains]
    assert model(read_urdf(repaired_text(submission, found))) == model(read_urdf(REFERENCE.encode()))
    assert [edit.new for edit in found.edits][1] == '<child link="lidar"/>'


def test_one_mistake_in_many_places_is_one_hint(tmp_path: Path) -> None:
    """Commas in every vector are one proposal with several edits, which does not name a link."""
    text = REFERENCE.replace('xyz="0 0 0.1"', 'xyz="0, 0, 0.1"').replace('xyz="0 0 0.025"', 'xyz="0, 0, 0.025"')
    (found,) = searched(written(tmp_path, text)).found
    assert [edit.new for edit in found.edits] == ['xyz="0 0 0.1"', 'xyz="0 0 0.025"', 'xyz="0 0 0.1"']
    assert found.proposal.action == "separate the numbers by spaces"


def test_joint_of_each_link_is_a_hint_of_its_own() -> None:
    """Links without joints get a hint for each joint, and one for all, with which the tree is connected."""
    found = searched(SAMPLES["links-without-joints"].open()).found
    alone = [hint for hint in found if len(hint.edits) == 1 and "lidar-frame" in hint.gains and len(hint.gains) < 10]
    assert len(alone) == 1
    assert any("urdf-loads" in hint.gains for hint in found)


def test_truncated_file_is_closed_and_completed(tmp_path: Path) -> None:
    """A file that was cut off is closed where it ends; what is missing is restored after that."""
    for share in (0.35, 0.5, 0.65, 0.8, 0.95):
        search = searched(written(tmp_path, REFERENCE[: int(len(REFERENCE) * share)]))
        assert search.found[0].gains
        assert not search.final.failed


@pytest.mark.parametrize("text", [b"", b"\n", "robot".encode("utf-16"), b"this is no robot"])
def test_no_hint_where_too_much_is_missing(text: bytes, tmp_path: Path) -> None:
    """A file without any tag has no hint."""
    submission = written(tmp_path, text)
    if isinstance(submission.urdf, Read):
        assert not searched(submission).found


def test_xacro_in_a_urdf_is_not_repaired_number_by_number() -> None:
    """Where the xacro of a .urdf is what is wrong, no expression is replaced by its value."""
    assert not any("${" in edit.old for found in searched(SAMPLES["raw-xacro"].open()).found for edit in found.edits)


@pytest.mark.exhaustive
def test_every_kind_of_problem_is_repaired(tmp_path: Path) -> None:
    """Of every kind of problem, ROS 2's verdict on a sample gets better, even if its links are not those of the lab."""
    kinds, undone = set(), set()
    for sample in (sample for sample in PROBLEMS if read_urdf(sample.data).verdict != "clean"):
        submission = written(tmp_path, sample.data)
        kinds.add(sample.code)
        final = repair(Trials(LAB6, submission, results_of(submission)), REFERENCE_DRAFT)[1].submission
        if isinstance(final.urdf, Read) and final.urdf.reading.verdict == "clean":
            undone.add(sample.code)

    assert kinds - undone == _BEYOND_REPAIR.keys()


def test_no_hint_loses_a_point(tmp_path: Path) -> None:
    """Random damage: every hint, graded from scratch, keeps what passed and gains what it says."""
    random = Random(14)
    for _ in range(8):
        text = REFERENCE
        for _ in range(random.randint(1, 3)):
            at = random.randrange(len(text))
            text = text[:at] + random.choice(("", "", '"', "<", ">", "/", "=", ",", "</link>")) + text[at + 1 :]
        submission = written(tmp_path, text)
        before = results_of(submission)
        for found in searched(submission).found:
            after = results_of(written(tmp_path, repaired_text(submission, found)))
            assert all(after[name].outcome.status == "passed" for name in found.gains), text
            assert all(after[name].points >= result.points for name, result in before.items()), text


def test_a_chain_of_repairs_ends(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """What the first steps repair is kept; of the edits of one step a few are compared."""
    text = REFERENCE.replace("</robot>", "", 1).replace('rgba="', 'rgba="1 ', 1)
    submission = written(tmp_path, text)
    trials = Trials(LAB6, submission, results_of(submission))
    full, _ = repair(trials, REFERENCE_DRAFT)
    monkeypatch.setattr("grader.grading.hints.loading._MAX_STEPS", 1)
    monkeypatch.setattr("grader.grading.hints.loading._MAX_VALUES", 1)
    first, _ = repair(Trials(LAB6, submission, results_of(submission)), REFERENCE_DRAFT)
    assert (len(first), len(full)) == (1, 2)
    closed = written(tmp_path, REFERENCE.replace("</robot>", "", 1))
    [only], _ = repair(Trials(LAB6, closed, results_of(closed)), REFERENCE_DRAFT)
    assert only.edits
