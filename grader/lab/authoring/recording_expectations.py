"""The expectations of a recording: what the robot of a reference did, with tolerances.

They leave room for another run of the same robot, and none for another robot or another drive.
"""

from itertools import chain
from math import degrees, isfinite
from posixpath import basename
from typing import Any

from grader.base.errors import NotDecided, RecordingError
from grader.base.quantities import in_degrees, point
from grader.base.text import printable_path
from grader.lab.authoring.expectations import Expectation, Expectations, Omission, Solution
from grader.lab.submission.submission import Submission
from grader.ros.recording.motion import read_track
from grader.ros.recording.recorded_topics import RecordedTopic
from grader.ros.recording.recording import Recording
from grader.ros.recording.recording_files import find_recordings, read_recording

_THE_RECORDING = "The recording"  # the heading
_LESS = 0.8  # of the duration, of rates and of distances, that another run has at least
_SHARE = 0.1  # of a distance, that another run may be off
_TURN_SHARE = 0.05
_NEAR, _TURNED = 0.05, 5.0  # metres and degrees that it may be off anyway
_STANDING = 0.1  # metres below which nothing drove
_END = 0.05  # radians or metres that a joint may end elsewhere
# What each node has, or a recorder, and what other criteria are about.
_HIDDEN = ("/rosout", "/parameter_events", "/events/write_split", "/tf", "/tf_static")
_SCAN = "sensor_msgs/msg/LaserScan"


def read_reference_recording(submission: Submission, path: str) -> tuple[Recording, str]:
    """Return the recording at a path in a submission, and the pattern that names it among others.

    The pattern is empty of the only one. Raises RecordingError.
    """
    every = find_recordings(submission.tree)
    for files in every:
        if path in (".", files.path, *(file.path for file in files.files)):
            name = basename(files.path).partition(".")[0]
            return read_recording(files), name if len(every) > 1 else ""
    raise RecordingError(
        f"the reference has no recording of `ros2 bag record` at {printable_path(path)}"
    )


def recording_expectations(
    recording: Recording, name: str, solution: Solution | None
) -> Expectations:
    """Yield what may be true of a recording with a name, and of a robot in it."""
    for expectation in _list_expectations(recording, solution):
        if isinstance(expectation, Expectation) and name:
            yield expectation.with_arguments(name=name)
        else:
            yield expectation


def _list_expectations(recording: Recording, solution: Solution | None) -> Expectations:
    seconds = _allow_less(recording.seconds)
    title = f"the recording lasts at least {point((seconds,))} s"
    yield _expect("recording_found", title, seconds=seconds)
    for topic in recording.topics.values():
        if topic.count and topic.name not in _HIDDEN:
            yield _expect_topic(topic)
    yield from _expect_drive(recording)
    if recording.frames.names:
        yield _expect("recorded_tree", "the recorded frames are one tree")
    if recording.frames.names and solution:
        yield _expect("recorded_frames_agree")
    if recording.odometry and recording.joint_states and solution:
        yield _expect("wheels_agree", "the wheels roll as far as the odometry says")
    for scan in recording.list_of_type(_SCAN):
        ranges = chain.from_iterable(message.get("ranges", ()) for _, message in scan.messages)
        least = _allow_less(min(filter(isfinite, ranges), default=0.0))
        nearest = _expect("recorded_value", topic=scan.name, field="ranges", smallest=least)
        yield nearest._replace(words=f"{scan.name} nearest", is_detail=True)
    for joint in solution.robot.robot.joints if solution else ():
        known = recording.joint_positions.get(joint.name)
        if known and joint.limit is not None:
            last = known.positions[-1]
            ends = {"smallest": round(last - _END, 3), "largest": round(last + _END, 3)}
            of = {"topic": recording.joint_states[0].name, "field": f"position[{joint.name}]"}
            end = _expect("recorded_value", "", **of, **ends, last=True)
            yield end._replace(words=f"{joint.name} ends", is_detail=True)


def _expect(check: str, title: str = "", **arguments: Any) -> Expectation:
    return Expectation(_THE_RECORDING, check, arguments, check, title=title, is_recorded=True)


def _allow_less(value: float) -> float:
    """Return what another run has at least, with two digits."""
    return float(f"{value * _LESS:.2g}")


def _expect_topic(topic: RecordedTopic) -> Expectation:
    """Return that a topic has its type, and its rate if it is that of a sensor or of odometry."""
    (type_name, *others) = topic.types
    arguments: dict[str, Any] = {"topic": topic.name}
    title = f"{topic.name} is recorded"
    if not others:
        arguments["type"] = type_name
        title += f" as {type_name}"
    if topic.needs_stamps and topic.rate:
        arguments["rate"] = _allow_less(topic.rate)
        title += f", with {point((arguments['rate'],))} messages a second"
    return _expect("recorded_topic", title, **arguments)._replace(words=f"{topic.name} recorded")


def _expect_drive(recording: Recording) -> Expectations:
    """Yield how far the base drove and turned, and where it ended."""
    for topic in recording.odometry[:1]:
        try:
            track = read_track(topic)
        except NotDecided as reason:
            yield Omission("drove", str(reason))
            return
        ahead, left, turned = track.end
        turn = degrees(turned)
        if max(track.path, abs(turn) / _TURNED * _NEAR) < _STANDING:
            yield Omission("drove", f"by {topic.name} the base hardly moved")
            return
        by = {} if len(recording.odometry) == 1 else {"odometry": topic.name}
        place = {"forward": track.forward, "ahead": ahead, "left": left}
        rounded = {way: round(metres, 2) for way, metres in place.items()}
        room = {"tolerance": round(max(_NEAR, _SHARE * track.path), 2)}
        title = (
            f"the robot drives {track.forward:.2f} m forward, and ends {ahead:.2f} m ahead and "
            f"{left:.2f} m to the left of its start"
        )
        yield _expect("drove", title, **rounded, **room, **by)
        title = f"the robot turns {in_degrees(turn)} to the left in all"
        angle = round(max(_TURNED, _TURN_SHARE * abs(turn)), 1)
        turns = _expect("drove", title, turn=round(turn, 1), angle=angle, **by)
        yield turns._replace(words="drove turn")
