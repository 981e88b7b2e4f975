"""A fact of a reference, as arguments of a check that are to be tried on it."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from grader.robot.kinematics import Configuration
from grader.robot.reader import Reading
from grader.submission.submission import Submission
from grader.xml.parsing import Element

THE_FILE, THE_ROBOT, THE_PACKAGE = "The file", "The robot", "The package"  # headings


class Solution(NamedTuple):
    """A solution that ROS 2 loads: its submission, its URDF as it was read, and its robot with the joints at 0."""

    submission: Submission
    reading: Reading
    robot: Configuration

    @property
    def root(self) -> Element:
        """The <robot> that it was read from."""
        assert self.reading.root is not None  # ROS 2 loads it
        return self.reading.root


class Fact(NamedTuple):
    """A check with arguments that the reference may pass: `about` is the heading, `words` are those of the id.

    `otherwise` are tried in its place if the reference does not pass it. `title` is by default what the check says.
    """

    about: str
    check: str
    arguments: Mapping[str, Any]
    words: str
    otherwise: "Sequence[Fact]" = ()
    title: str = ""


class Omission(NamedTuple):
    """Something of the reference that no criterion is about, and why."""

    what: str
    why: str


Facts = Iterator[Fact | Omission]
