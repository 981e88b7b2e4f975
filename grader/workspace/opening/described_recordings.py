"""What a recording shows, in words, beside what the files of a workspace say."""

from collections.abc import Iterator
from math import degrees
from typing import NamedTuple

from grader.base.errors import MissingElement, NotDecided, RecordingError
from grader.base.grouping import Strings
from grader.base.quantities import in_degrees
from grader.base.text import enumerated, quoted
from grader.ros.package.robot_file import Read
from grader.ros.recording.motion import read_track
from grader.ros.recording.recorded_robot import measure_travel
from grader.ros.recording.recorded_topics import RecordedTopic
from grader.ros.recording.recording import Recording
from grader.ros.recording.recording_files import find_recordings, read_recording
from grader.ros.urdf.kinematics import Configuration
from grader.workspace.opening.opened import OpenedWorkspace
from grader.workspace.opening.recorded_graph import compare_recording

_MAX_RECORDINGS = 20
_MAX_LISTED = 6
_TOLERANCES = (0.005, 3.0)  # metres and degrees that a frame may be off
_RATIO = 0.05  # by which wheels and odometry may differ


class DescribedRecording(NamedTuple):
    """What a recording shows, a line each, and what is wrong or differs from the files."""

    path: str
    facts: Strings
    faults: Strings
    topics: tuple[RecordedTopic, ...] = ()


def describe_recordings(opened: OpenedWorkspace) -> list[DescribedRecording]:
    """Return the recordings of a workspace, beside its main launch file and its only URDF."""
    described = []
    for files in find_recordings(opened.whole_tree)[:_MAX_RECORDINGS]:
        try:
            recording = read_recording(files)
        except RecordingError as error:
            described.append(DescribedRecording(files.path, (), (str(error),)))
            continue
        faults = [note.text for note in recording.notes]
        faults += _list_tree_faults(recording)
        faults += _compare_graph(recording, opened)
        faults += _compare_robot(recording, opened)
        topics = tuple(recording.topics.values())
        facts = tuple(_list_facts(recording))
        described.append(DescribedRecording(files.path, facts, tuple(faults), topics))
    return described


def _list_facts(recording: Recording) -> Iterator[str]:
    yield f"it lasts {recording.seconds:.1f} s, and has {recording.count} messages"
    for topic in recording.odometry:
        try:
            track = read_track(topic)
        except NotDecided as reason:
            yield str(reason)
            continue
        ahead, left, turn = track.end
        yield (
            f"by {topic.name} it drove {track.forward:.2f} m forward on a path of "
            f"{track.path:.2f} m, ended {ahead:.2f} m ahead and {left:.2f} m to the left, and "
            f"turned {in_degrees(degrees(turn))}"
        )
    if recording.frames.roots:
        roots = enumerated([quoted(root) for root in recording.frames.roots], _MAX_LISTED)
        yield f"{len(recording.frames.names)} frames below {roots}"


def _list_tree_faults(recording: Recording) -> Iterator[str]:
    frames = recording.frames
    for child, parents in sorted(frames.parents.items()):
        if len(parents) > 1:
            yield f"{quoted(child)} has the parents {enumerated(sorted(parents))}"
    for topic, frame in recording.named_frames:
        if frame not in frames.names:
            yield f"{topic.name}: no transform has {quoted(frame)}"


def _compare_graph(recording: Recording, opened: OpenedWorkspace) -> Iterator[str]:
    """Yield how topics differ from what the main launch file starts."""
    for launch in opened.launch_files()[:1]:
        names: dict[str, list[str]] = {}
        for heard in compare_recording(opened.launch_graph(launch), recording):
            for difference in heard.differences:
                names.setdefault(difference, []).append(heard.topic.name)
        for difference, topics in names.items():
            yield f"{enumerated(topics, _MAX_LISTED)}: {difference} ({launch})"


def _compare_robot(recording: Recording, opened: OpenedWorkspace) -> Iterator[str]:
    read = [robot for robot in opened.robots if isinstance(robot, Read)]
    model = read[0].loaded.robot if len(read) == 1 else None
    if not model:
        return
    robot = Configuration(model)
    try:
        comparison = recording.compare_frames(robot, *_TOLERANCES, ())
        yield from map(str, comparison.differences)
        if comparison.unrecorded and recording.frames.names:
            links = [quoted(joint.child) for joint in comparison.unrecorded]
            yield f"no transform was recorded of {enumerated(links, _MAX_LISTED)}"
        for topic in recording.odometry[:1]:
            travel = measure_travel(robot, (), recording.joint_positions, read_track(topic))
            if abs(travel.largest - travel.driven) > _RATIO * max(1.0, abs(travel.driven)):
                yield (
                    f"by the wheels of {read[0].path} it drove {travel.largest:.2f} m, by "
                    f"{topic.name} {travel.driven:.2f} m"
                )
    except (MissingElement, NotDecided):
        return  # there is nothing to compare
