"""Harnesses of recordings: files in MCAP and SQLite."""

import json
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from math import inf

from grader.base.errors import NotDecided, RecordingError
from grader.files.tree import make_tree
from grader.report.drawing.playback import Playback
from grader.ros.api import (
    Configuration,
    find_recordings,
    read_recording,
    read_track,
    read_urdf,
)
from tests.checks.submissions import file_of
from tests.fuzz.harness import check_message
from tests.recordings.cart import URDF, record
from tests.recordings.writing import compress_zstd, write_mcap, write_sqlite

_MESSAGES = [one for one in record(speeds=((0.5, 0.2, 0.1),)) if one.topic != "/robot_description"]


def recording(data: bytes, name: str) -> None:
    """A recording has messages and times, also where it is damaged, or one reason why it is not read."""
    (found,) = find_recordings(make_tree("bag", [file_of(name, data)], ()))
    try:
        read = read_recording(found)
    except RecordingError as error:
        check_message(str(error))
        return
    assert 0 <= read.seconds < inf  # of the recording, not of reading it
    for note in read.notes:
        check_message(note.text)
    for topic in read.odometry:
        try:
            assert read_track(topic).path >= 0
        except NotDecided as error:
            check_message(str(error))
    assert read.frames.names >= read.frames.parents.keys()
    assert read.hash == read_recording(found).hash
    for topic in read.topics.values():
        assert len(topic.qos) == len(("reliability", "durability"))
    cart = read_urdf(URDF).robot
    assert cart is not None
    json.dumps(Playback(read, b"").data(Configuration(cart)), allow_nan=False)


def seeds(ending: str) -> Iterable[bytes]:
    """Yield small recordings in a format."""
    if ending == "db3":
        yield write_sqlite(_MESSAGES)
        yield write_sqlite(_MESSAGES, is_defined=False)
        return
    yield write_mcap(_MESSAGES, is_defined=False)
    for compression in ("", "zstd", "lz4"):
        yield write_mcap(_MESSAGES[:4], chunked=3, compression=compression)
    yield compress_zstd(write_mcap(_MESSAGES))


RECORDINGS: Mapping[str, Callable[[bytes], None]] = {
    ending: partial(recording, name=f"a.{ending}") for ending in ("mcap", "db3")
}
