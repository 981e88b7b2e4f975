"""Checks of how a robot drove in a recording: by its odometry, and by its wheels."""

from math import degrees
from typing import TYPE_CHECKING

from grader.base.errors import RubricError
from grader.base.grouping import known_values
from grader.base.quantities import SLACK, in_degrees, point
from grader.base.toml_types import NonNegative
from grader.lab.checks.check import About
from grader.lab.checks.opened_recordings import ask_recordings, need_topic, weigh_losses
from grader.lab.checks.outcome import Outcome, failed, judged, passed, pending
from grader.lab.submission.submission import Submission
from grader.ros.urdf.kinematics import Configuration

if TYPE_CHECKING:
    from grader.ros.api import RecordedTopic, Recording, WheelTravel

_STANDING = 0.1  # metres below which wheels have nothing to agree with
_WAYS = {
    "forward": ("drove", "forward", "backward"),
    "path": ("drove a path of", "", ""),
    "ahead": ("ended", "ahead", "behind"),
    "left": ("ended", "to the left", "to the right"),
    "turn": ("turned", "to the left", "to the right"),
}
ABOUT = {
    "drove": About(causes={"way": "the base drove another way"}),
    "wheels_agree": About(
        breaks_under=lambda _: ("joints renamed",),
        causes={"way": "the wheels rolled another way than the base drove"},
    ),
}


def drove(
    submission: Submission,
    *,
    forward: float | None = None,
    path: NonNegative | None = None,
    ahead: float | None = None,
    left: float | None = None,
    turn: float | None = None,
    tolerance: NonNegative = 0.05,
    angle: NonNegative = 5.0,
    odometry: str | None = None,
    name: str = "",
) -> Outcome:
    """The base drove as asked, by its recorded odometry.

    Args:
        forward: The metres that it drove along its heading: backward ones count negative.
        path: The metres that it drove in any direction.
        ahead: Where it ended, in metres ahead of where it began.
        left: Where it ended, in metres to the left of where it began.
        turn: The degrees by which it turned to the left, several turns included.
        tolerance: How far it may be off, in metres.
        angle: How far the turn may be off, in degrees.
        odometry: The topic of the odometry; default: that with the plainest name.
        name: A pattern for the name of the recording; default: the only one.
    """
    given = {"forward": forward, "path": path, "ahead": ahead, "left": left, "turn": turn}
    wanted = known_values(given)
    if not wanted:
        raise RubricError((f"drove needs one of {', '.join(given)}",))

    from grader.ros.api import read_track  # late: few rubrics ask

    def judge(recording: "Recording") -> Outcome:
        topic = _find_odometry(recording, odometry)
        track = read_track(topic)
        ended = track.end
        actual = {
            "forward": track.forward,
            "path": track.path,
            "ahead": ended[0],
            "left": ended[1],
            "turn": degrees(ended[2]),
        }
        for way, value in wanted.items():
            allowed = angle if way == "turn" else tolerance
            if not abs(actual[way] - value) <= allowed + SLACK:
                message = f"by {topic.name} it {_tell_way(way, actual[way])}"
                unit = "deg" if way == "turn" else "m"
                wrong = f"{message}, expected {_tell_amount(way, value)}"
                outcome = judged(False, wrong, actual[way], value, allowed, unit)
                return weigh_losses(
                    outcome, recording, mistake="the base drove another way", cause="way"
                )
        told = " and ".join(_tell_way(way, actual[way]) for way in wanted)
        return passed(f"by {topic.name} it {told}")

    return ask_recordings(submission, name, judge)


def _tell_way(way: str, value: float) -> str:
    return f"{_WAYS[way][0]} {_tell_amount(way, value)}"


def _tell_amount(way: str, value: float) -> str:
    _, positive, negative = _WAYS[way]
    amount = in_degrees(abs(value)) if way == "turn" else f"{point((abs(round(value, 3)),))} m"
    return f"{amount} {positive if value >= 0 else negative}".rstrip()


def _find_odometry(recording: "Recording", name: str | None) -> "RecordedTopic":
    """Return the topic with the odometry; raises MissingElement."""
    topics = recording.odometry
    return topics[0] if topics and name is None else need_topic(recording, name or "odom")


def wheels_agree(
    submission: Submission,
    robot: Configuration,
    *,
    ratio: NonNegative = 0.05,
    wheels: list[str] | None = None,
    odometry: str | None = None,
    name: str = "",
) -> Outcome:
    """The wheels of the URDF rolled as far as the base drove, by the recorded joint states and
    odometry.

    Args:
        ratio: How far the two distances may differ, as a part of that of the odometry.
        wheels: The links of the wheels; default: all that roll forward.
        odometry: The topic of the odometry; default: that with the plainest name.
        name: A pattern for the name of the recording; default: the only one.
    """
    for link in wheels or ():
        robot.link(link)

    from grader.ros.api import measure_travel, read_track  # late: few rubrics ask

    def judge(recording: "Recording") -> Outcome:
        topic = _find_odometry(recording, odometry)
        if not recording.joint_states:
            need_topic(recording, "joint_states")
        travel = measure_travel(robot, wheels or (), recording.joint_positions, read_track(topic))
        return _judge_travel(travel, ratio, topic.name)

    return ask_recordings(submission, name, judge)


def _judge_travel(travel: "WheelTravel", ratio: float, odometry: str) -> Outcome:
    driven = travel.driven
    told = f"by the wheels it drove {travel.largest:.2f} m, by {odometry} {driven:.2f} m"
    if max(abs(driven), abs(travel.largest)) < _STANDING:
        return pending(f"the base hardly moved: {told}; needs manual grading", "it hardly moved")
    allowed = ratio * max(abs(driven), _STANDING) + SLACK
    low, high = sorted((travel.smallest, travel.largest))
    if low - allowed <= driven <= high + allowed:
        return judged(True, told, travel.largest, driven, allowed, "m")
    question = ": do the wheels turn the other way?"
    if travel.largest * driven >= 0:
        radius = point(travel.wheel.radii[:1])
        question = f": is the radius in the controller that of the URDF, {radius} m?"
    mistake = "the wheels and the odometry disagree"
    return failed(told + question, travel.wheel.joint.location, mistake=mistake, cause="way")
