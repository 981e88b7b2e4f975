"""Checks of the frames in a recording: where they were, and whether they are one tree."""

from collections.abc import Collection
from math import dist
from typing import TYPE_CHECKING

from grader.base.errors import NotDecided
from grader.base.quantities import point
from grader.base.text import enumerated, quoted
from grader.base.toml_types import NonNegative
from grader.base.transforms import turn_between
from grader.lab.checks.check import EQUIVALENTS, About
from grader.lab.checks.opened_recordings import ask_recordings, need_topic
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.submission.submission import Submission
from grader.ros.urdf.kinematics import Configuration

if TYPE_CHECKING:
    from grader.ros.api import FrameComparison, Recording

_MAX_LISTED = 6
ABOUT = {
    # The names and places of links are those of the recording.
    "recorded_frames_agree": About(
        breaks_under=lambda _: EQUIVALENTS,
        causes={
            "robot": "another robot was recorded",
            "place": "a frame was recorded in another place",
            "frame": "a frame was not recorded",
        },
    ),
    "recorded_tree": About(
        causes={
            "parents": "a frame has two parents",
            "trees": "the frames are several trees",
            "frame": "no transform has a frame",
            "slash": "the name of a frame begins with /",
        }
    ),
}


def recorded_frames_agree(
    submission: Submission,
    robot: Configuration,
    *,
    tolerance: NonNegative = 0.005,
    angle: NonNegative = 3.0,
    without: list[str] | None = None,
    name: str = "",
) -> Outcome:
    """The recorded transforms of the robot's links are those of the URDF, at the recorded positions
    of joints.

    Transforms and joint states are matched by the times in their headers. A recorded robot
    description has to be that of the URDF, too.

    Args:
        tolerance: How far a link may be off, in metres.
        angle: How far it may be turned, in degrees.
        without: The links that are not compared, as other nodes publish them.
        name: A pattern for the name of the recording; default: the only one.
    """

    def judge(recording: "Recording") -> Outcome:
        return _judge_frames(recording, robot, (tolerance, angle), without or ())

    return ask_recordings(submission, name, judge)


def _judge_frames(
    recording: "Recording",
    robot: Configuration,
    tolerances: tuple[float, float],
    without: Collection[str],
) -> Outcome:
    other = _compare_descriptions(recording, robot, tolerances)
    if other:
        return other
    from grader.ros.api import missing_position  # late: few rubrics ask

    comparison = recording.compare_frames(robot, *tolerances, without)
    if comparison.differences:
        worst = max(comparison.differences, key=lambda one: one.excess)
        at = worst.joint.location
        line = at.resolve().line if at else 0
        mistake = f"{quoted(worst.link)} was recorded in another place"
        return failed(f"{worst} (line {line})", at, mistake=mistake, cause="place")
    if comparison.unrecorded:
        return _fail_unrecorded(recording, comparison)
    if comparison.without_states:
        if not recording.joint_states:
            need_topic(recording, "joint_states")
        raise missing_position(comparison.without_states[0])
    if comparison.untimed:
        link = comparison.untimed[0].child
        raise NotDecided(f"no joint state has a time of {quoted(link)} in /tf", "other times")
    return passed("the recorded frames are those of the URDF")


def _compare_descriptions(
    recording: "Recording", robot: Configuration, tolerances: tuple[float, float]
) -> Outcome | None:
    """Return the failure of another recorded description; None if it agrees, or there is none.

    Links that only it has may be those of a simulation.
    """
    from grader.ros.api import read_description  # late: few rubrics ask

    described = read_description(recording.descriptions, robot)
    if not described:
        return None
    start = "the recorded robot is another"
    missing = [link.name for link in robot.robot.links if not described.robot.has_link(link.name)]
    if missing:
        names = enumerated(map(quoted, missing), _MAX_LISTED)
        return failed(f"{start}: it has no link {names}", mistake=start, cause="robot")
    for joint in robot.robot.joints:
        theirs = described.pose(joint.child, relative_to=joint.parent)
        ours = robot.at({}).pose(joint.child, relative_to=joint.parent)
        off = dist(theirs.translation, ours.translation)
        turned = turn_between(theirs.rotation, ours.rotation)
        if off > tolerances[0] or turned > tolerances[1]:
            places = f"at {point(theirs.translation)}, submitted {point(ours.translation)}"
            message = f"{start}: {quoted(joint.child)} is {places} in {quoted(joint.parent)}"
            return failed(message, joint.location, mistake=start, cause="robot")
    return None


def _fail_unrecorded(recording: "Recording", comparison: "FrameComparison") -> Outcome:
    """Return the failure of links without a transform.

    Raises MissingElement for a topic that was not recorded, which costs once.
    """
    joint = comparison.unrecorded[0]
    if any(each.has_position for each in comparison.unrecorded):
        _need_transforms(recording, "tf")
    if any(each.type == "fixed" for each in comparison.unrecorded):
        _need_transforms(recording, "tf_static")
    there = enumerated(map(quoted, sorted(recording.frames.names)), _MAX_LISTED)
    message = f"no transform from {quoted(joint.parent)} to {quoted(joint.child)} was recorded"
    return failed(message, joint.location, detail=f"; there are {there}", cause="frame")


def _need_transforms(recording: "Recording", name: str) -> None:
    """Raise MissingElement if a topic of transforms was recorded in no namespace."""
    topics = [topic for topic in recording.topics.values() if topic.count]
    if not any(topic.name.endswith(f"/{name}") for topic in topics):
        need_topic(recording, name)


def recorded_tree(
    submission: Submission,
    *,
    frames: list[str] | None = None,
    name: str = "",
) -> Outcome:
    """The recorded transforms are one tree, which has every frame that the headers of odometry and
    of data of sensors name.

    Args:
        frames: Frames that it has to have as well.
        name: A pattern for the name of the recording; default: the only one.
    """
    return ask_recordings(submission, name, lambda recording: _judge_tree(recording, frames or ()))


def _judge_tree(recording: "Recording", wanted: Collection[str]) -> Outcome:
    tree = recording.frames
    if not tree.names:
        need_topic(recording, "tf")
    named = [(frame, f"{topic.name}: ") for topic, frame in recording.named_frames]
    for frame, start in named:
        if frame.startswith("/"):
            message = f"{start}tf2 does not look up {quoted(frame)}: a frame has no / before it"
            return failed(message, cause="slash")
    for child, parents in sorted(tree.parents.items()):
        if len(parents) > 1:
            names = enumerated(sorted(parents))
            return failed(f"{quoted(child)} has the parents {names}", cause="parents")
    absent = [(frame, start) for frame, start in named if frame not in tree.names]
    absent += [(frame, "") for frame in wanted if frame not in tree.names]
    if absent or len(tree.roots) > 1:
        _need_transforms(recording, "tf")
        _need_transforms(recording, "tf_static")
    if absent:
        frame, start = absent[0]
        return failed(f"{start}no transform has {quoted(frame)}", cause="frame")
    if len(tree.roots) != 1:
        roots = enumerated(map(quoted, tree.roots), _MAX_LISTED) or "none"
        message = f"the frames are {len(tree.roots)} trees"
        return failed(message, detail=f", below {roots}", cause="trees")
    return passed(f"the {len(tree.names)} recorded frames are one tree below {tree.roots[0]}")
