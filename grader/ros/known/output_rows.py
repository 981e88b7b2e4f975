"""What programs of ROS 2 say when something is wrong: the rows of outputs.toml."""

import re
from functools import cache
from typing import Literal

from grader.base.grouping import Strings
from grader.base.records import Named
from grader.ros.known.typed_rows import read_file

# Where the files say why, besides the findings of rules.
OutputPlace = Literal[
    "",
    "package",
    "parameter",
    "module",
    "spaced path",
    "frame",
    "hardware",
    "states",
    "inertia",
    "text",
    "robot parameter",
    "manager",
    "description",
]


class OutputRow(Named):
    """A message of a program, and what explains it in a workspace.

    The groups of its pattern are the names that the message has. A finding explains it if a rule of
    the row made it and the lines that it names have these names.
    """

    name: str
    pattern: str  # which is searched in the message, whose white space is single spaces
    source: str  # repository, file and line
    sentence: str  # what it means, and what to look at
    example: str  # a message that has the pattern, for pages: people search for it
    rules: Strings = ()  # that are asked, the first that has an answer counts
    within: Strings = ()  # the groups that must be in the lines of the finding
    is_of_robot: bool = False  # whether only what keeps ROS 2 from loading a started robot counts
    processes: Strings = ()  # one of which must be started by a launch file
    place: OutputPlace = ""
    is_place_last: bool = False  # whether it is asked after the rules
    # With groups in braces: a parameter whose parent is there, and it is not; a pattern of a text.
    key: str = ""
    otherwise: str = ""  # what is said if no finding fits but the place has an answer
    follows: bool = False  # whether another message before it says the cause

    @property
    def compiled(self) -> "re.Pattern[str]":
        """The pattern, compiled once."""
        return _compiled(self.pattern)


class _Outputs(Named):
    output: tuple[OutputRow, ...]


@cache
def known_outputs() -> tuple[OutputRow, ...]:
    """Return the messages that are known, in the order in which they are tried."""
    return read_file(_Outputs, "outputs").output


@cache
def _compiled(pattern: str) -> "re.Pattern[str]":
    return re.compile(pattern)
