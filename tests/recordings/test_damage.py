"""A damaged file is read as far as possible, or is one clear error."""

import random
from collections.abc import Iterator
from math import inf
from typing import Any

import pytest

from grader.base.errors import MissingElement, NotDecided, RecordingError
from grader.files.tree import make_tree
from grader.ros.api import find_recordings, read_recording, read_track
from tests.checks.outcomes import graded
from tests.checks.submissions import Submitted, file_of
from tests.examples import spread
from tests.recordings.cart import URDF, record
from tests.recordings.writing import compress_zstd, write_mcap, write_sqlite

MESSAGES = record(speeds=((0.5, 0.2, 0.5),), extra=("goal",))
FILES = {
    "plain.mcap": write_mcap(MESSAGES),
    "chunks.mcap": write_mcap(MESSAGES, chunked=5),
    "zstd.mcap": write_mcap(MESSAGES, chunked=20, compression="zstd"),
    "lz4.mcap": write_mcap(MESSAGES, chunked=20, compression="lz4"),
    "whole.mcap.zstd": compress_zstd(write_mcap(MESSAGES)),
    "bag.db3": write_sqlite(MESSAGES),
    "humble.db3": write_sqlite(MESSAGES, is_defined=False),
}
VARIANTS = 200  # of each file


def damaged(name: str, seed: int) -> bytes:
    """Return a file with some bytes changed, missing or doubled, or without its end."""
    dice = random.Random(f"{name} {seed}")
    data = bytearray(FILES[name])
    for _ in range(dice.choice((1, 2, 10))):
        at = dice.randrange(len(data))
        match dice.randrange(5):
            case 0:
                del data[at:]
                data += b"\0"
            case 1:
                data[at] = dice.randrange(256)
            case 2:
                data[at : at + 8] = dice.randbytes(8)
            case 3:
                del data[at : at + dice.randrange(1, 40)]
                data += b"\0"
            case _:
                data[at:at] = data[at : at + dice.randrange(1, 400)]
    return bytes(data)


def _cases() -> Iterator[tuple[str, int]]:
    for seed in range(VARIANTS):
        yield from ((name, seed) for name in FILES)


@pytest.mark.parametrize(("name", "seed"), spread(_cases(), 70))
def test_a_damaged_file_is_one_clear_error(name: str, seed: int) -> None:
    """1,400 of them: each is read, or raises RecordingError in one line; what is computed of it raises nothing else."""
    tree = make_tree(
        "bag", [file_of(name, damaged(name, seed)), file_of("cart.urdf", URDF.encode())], ()
    )
    (found,) = find_recordings(tree)
    try:
        recording = read_recording(found)
    except RecordingError as error:
        assert str(error)
        assert "\n" not in str(error)
        return
    assert 0 <= recording.seconds < inf  # of the recording, not of reading it
    for topic in recording.topics.values():
        assert len(topic.messages) <= topic.count
    robot = Submitted({"cart.urdf": URDF}).submission
    assert robot.robot is not None
    for ask in (recording.odometry[:1], recording.joint_states[:1]):
        for topic in ask:
            try:
                read_track(topic)
            except (NotDecided, MissingElement) as error:
                assert str(error)


@pytest.mark.parametrize("name", FILES)
def test_a_damaged_file_breaks_no_check(name: str) -> None:
    """Each check of some variants passes, fails or is open."""
    from grader.lab.checks.registry import own_checks

    arguments: dict[str, dict[str, Any]] = {
        "recording_found": {},
        "recorded_topic": {"topic": "/odom", "rate": 1.0},
        "recorded_value": {"topic": "/goal", "field": "goal.x", "smallest": 1.0},
        "drove": {"forward": 0.2},
        "wheels_agree": {},
        "recorded_frames_agree": {},
        "recorded_tree": {},
    }
    for seed in range(1_000, 1_006):
        submitted = Submitted({"cart.urdf": URDF, name: damaged(name, seed)})
        for check in own_checks():
            if check.name in arguments:
                outcome = graded(check.function, submitted, **arguments[check.name])
                assert outcome.status in ("passed", "failed", "pending"), outcome
