"""The commands that a launch file executes which are no nodes, and what they record.

Source: ros2bag/ros2bag/verb/record.py of ros2/rosbag2, branches humble to rolling.
"""

from typing import NamedTuple

from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.source import Location

_RECORDS = ("ros2", "bag", "record")
_NAME = on_use(r"/?[A-Za-z_][\w/]*")
# The options that are followed by no value of their own.
_FLAGS = frozenset(
    {
        *("-a", "--all", "--all-topics", "--topics", "--include-hidden-topics", "--no-discovery"),
        *("--include-unpublished-topics", "--ignore-leaf-topics", "--use-sim-time"),
        *("--start-paused", "--snapshot-mode", "--disable-keyboard-controls"),
    }
)


class StartedCommand(NamedTuple):
    """A command that a launch file executes which is no node; unknown words are stand-ins."""

    words: Strings
    when: bool | None
    location: Location

    @property
    def text(self) -> str:
        """The command as one line."""
        return " ".join(self.words)

    @property
    def recorded_topics(self) -> list[str]:
        """The topics that it names to be recorded, in full; none of another command."""
        topics = []
        before = ""
        is_recording = self.words[:3] == _RECORDS
        for word in self.words[3:] if is_recording else ():
            is_value = before.startswith("-") and before not in _FLAGS
            if _NAME.fullmatch(word) and not is_value:
                topics.append(f"/{word.removeprefix('/')}")
            before = word
        return topics
