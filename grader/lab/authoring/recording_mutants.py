"""Mutants of the recordings of a reference: a lost topic or end, another rate, drive or frame."""

import struct
from collections.abc import Iterator, Sequence
from contextlib import suppress

from grader.base.errors import RecordingError
from grader.base.names import last_part
from grader.lab.authoring.mutants import Mutant
from grader.lab.submission.submission import Submission
from grader.ros.api import (
    TRANSFORMS,
    Channel,
    Message,
    MessageDecoder,
    Recording,
    RecordingFiles,
    find_recordings,
    read_recording,
    write_database,
)
from grader.ros.urdf.model import Robot

_MOVED = 0.05  # metres
_CUT = "recording cut"
_LOST = "recorded topic lost"
_HALVED = "recorded rate halved"
_REVERSED = "recorded drive reversed"
_FRAME_MOVED = "recorded frame moved"
_TimedMessage = tuple[int, bytes]


def recording_mutants(submission: Submission) -> Iterator[Mutant]:
    """Yield the mutants of the recordings of a reference that can be read."""
    for files, recording in _read_all(submission):
        for mutation, label in _list_mutations(recording, submission.robot):
            yield Mutant(f"{mutation}: {label}", mutation, files.files[0].path, 1)


def mutated_recording(submission: Submission, mutant: Mutant) -> dict[str, bytes | None]:
    """Return the files of a recording with a mistake; none for a mutant of another file.

    All messages are in the first file.
    """
    for files, recording in _read_all(submission):
        if mutant.path == files.files[0].path:
            label = mutant.id.partition(": ")[2]
            changed = []
            for channel in recording.channels:
                changed.append((channel, _change(channel, mutant.mutation, label)))
            others = {file.path: None for file in files.files}
            return {**others, mutant.path: write_database(changed)}
    return {}


def _read_all(submission: Submission) -> Iterator[tuple[RecordingFiles, Recording]]:
    for files in find_recordings(submission.tree):
        with suppress(RecordingError):
            yield files, read_recording(files)


def _list_mutations(recording: Recording, robot: Robot | None) -> Iterator[tuple[str, str]]:
    """Yield each mutation with the topic or frame that it changes."""
    yield _CUT, recording.path
    for topic in recording.topics.values():
        if topic.count:
            yield _LOST, topic.name
        if topic.needs_stamps and topic.rate:
            yield _HALVED, topic.name
    for topic in recording.odometry[:1]:
        yield _REVERSED, topic.name
    links = {joint.child for joint in robot.joints} if robot else set()
    for frame in sorted(recording.frames.parents):
        if last_part(frame) in links:
            yield _FRAME_MOVED, frame


def _change(channel: Channel, mutation: str, label: str) -> Sequence[_TimedMessage]:
    """Return the messages of a channel after a mutation, with the recorder's times."""
    messages = list(zip(channel.times, channel.messages, strict=False))
    if mutation == _CUT:
        return messages[: (len(messages) + 1) // 2]
    if mutation == _FRAME_MOVED and channel.type == TRANSFORMS:
        return list(_move(channel, messages, label))
    if channel.topic != label:
        return messages
    if mutation == _REVERSED:
        return list(_move(channel, messages, None))
    return messages[::2] if mutation == _HALVED else []


def _move(
    channel: Channel, messages: Sequence[_TimedMessage], frame: str | None
) -> Iterator[_TimedMessage]:
    """Yield transforms with one frame moved along x, or odometry on the other side of its start."""
    decoder = MessageDecoder(channel.type, channel.definition)
    start: Message = {}
    for time, data in messages:
        message = decoder.decode(data)
        changed = data
        if frame is None:
            place = message["pose"]["pose"]["position"]
            start = start or place
            other = {axis: 2 * start[axis] - place[axis] for axis in "xyz"}
            changed = _replace_vector(data, message["child_frame_id"], place, other)
        for transform in message.get("transforms", ()):
            child = transform["child_frame_id"]
            place = transform["transform"]["translation"]
            if child.lstrip("/") == frame:
                moved = {**place, "x": place["x"] + _MOVED}
                changed = _replace_vector(changed, child, place, moved)
        yield time, changed


def _replace_vector(data: bytes, after: str, old: Message, new: Message) -> bytes:
    """Return a message with another x, y and z behind a text."""
    form = f"{'><'[data[1]]}3d"
    before, behind = (struct.pack(form, *map(vector.get, "xyz")) for vector in (old, new))
    start = data.index(before, data.index(after.encode() + b"\0"))
    return data[:start] + behind + data[start + len(before) :]
