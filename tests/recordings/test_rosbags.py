"""The oracle: rosbags, another program, reads what we write, and writes what we read."""

from pathlib import Path
from typing import Any

import pytest

from grader.files.folder import read_folder
from grader.ros.api import find_recordings, read_recording
from tests.recordings.cart import record
from tests.recordings.writing import write_mcap, write_metadata, write_sqlite

rosbags = pytest.importorskip("rosbags.rosbag2")
typesys = pytest.importorskip("rosbags.typesys")
pytestmark = pytest.mark.slow


def _plain(value: Any) -> Any:
    """Return a message of rosbags as the grader decodes it."""
    if hasattr(value, "__dataclass_fields__"):
        fields = [name for name in value.__dataclass_fields__ if not name.startswith("__")]
        return {name: _plain(getattr(value, name)) for name in fields}
    if hasattr(value, "tolist"):
        return tuple(value.tolist())
    return [_plain(one) for one in value] if isinstance(value, list) else value


@pytest.mark.parametrize("plugin", ["MCAP", "SQLITE3"])
@pytest.mark.parametrize("compressed", ["", "FILE", "MESSAGE"])
def test_what_rosbags_writes_is_read(plugin: str, compressed: str, tmp_path: Path) -> None:
    """Each message is decoded as rosbags decodes it, and has its time."""
    store = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
    folder = tmp_path / "drive"
    writer = rosbags.Writer(folder, version=9, storage_plugin=rosbags.StoragePlugin[plugin])
    if compressed:
        writer.set_compression(rosbags.CompressionMode[compressed], rosbags.CompressionFormat.ZSTD)
    messages = record(speeds=((0.5, 0.4, 2.0),), extra=("camera",))
    with writer:
        known: dict[str, Any] = {}
        for one in messages:
            if one.topic not in known:
                known[one.topic] = writer.add_connection(one.topic, one.type, typestore=store)
            writer.write(known[one.topic], one.time, one.data)
    (found,) = find_recordings(read_folder(folder))
    recording = read_recording(found)
    assert recording.notes == ()
    for name, topic in recording.topics.items():
        sent = [one for one in messages if one.topic == name]
        assert [round(time * 1e6) for time in topic.recorder_times] == [
            round(one.time / 1e3) for one in sent
        ]
        expected = [_plain(store.deserialize_cdr(one.data, one.type)) for one in sent]
        if name == "/image":
            expected = [{"header": message["header"]} for message in expected]
        assert [message for _, message in topic.recorder_messages] == expected


@pytest.mark.parametrize("write", [write_mcap, write_sqlite])
def test_rosbags_reads_what_the_tests_write(write: Any, tmp_path: Path) -> None:
    """So the files of the other tests are recordings."""
    messages = record()
    ending = "mcap" if write is write_mcap else "db3"
    path = tmp_path / f"drive_0.{ending}"
    path.write_bytes(write(messages))
    topics = {(one.topic, one.type) for one in messages}
    storage = "mcap" if ending == "mcap" else "sqlite3"
    listed = "".join(
        f"  - topic_metadata: {{name: {topic}, type: {kind}, serialization_format: cdr, offered_qos_profiles: ''}}\n"
        f"    message_count: {sum(one.topic == topic for one in messages)}\n"
        for topic, kind in sorted(topics)
    )
    metadata = write_metadata(path.name).decode().replace("version: 9", "version: 5")
    more = (
        f"  storage_identifier: {storage}\n  duration: {{nanoseconds: {messages[-1].time - messages[0].time}}}\n"
        f"  starting_time: {{nanoseconds_since_epoch: {messages[0].time}}}\n  message_count: {len(messages)}\n"
        f"  compression_format: ''\n  compression_mode: ''\n  topics_with_message_count:\n{listed}"
    )
    (tmp_path / "metadata.yaml").write_text(metadata + more)
    with rosbags.Reader(tmp_path) as reader:
        assert sorted((c.topic, time, bytes(raw)) for c, time, raw in reader.messages()) == sorted(
            (one.topic, one.time, one.data) for one in messages
        )
