"""A slip: a word of a file that surely stands for another one."""

from typing import NamedTuple

from grader.base.problems import Fix
from grader.base.source import Edits, Location


class Slip(NamedTuple):
    """What is written, what it surely stands for, and what ROS 2 does with it as it is written.

    Readers find slips in the file alone. A slip changes how something is written, a tag, a name, a
    separator, a letter in a number, and never a value: no number, no sign, no axis, no unit. In a
    node, what keeps it from running is one as well: an edit that adds something is assumed for the
    grade alone, and no hint writes it.
    """

    edits: Edits  # that write what is meant
    reaction: str  # "ROS 2 ignores the attribute lenght of <cylinder>"
    assumption: str  # "the attribute lenght of <cylinder> is read as length"
    location: Location
    is_refused: bool = False  # whether nothing of the file is used for it

    @property
    def fix(self) -> Fix:
        """The fix that writes what is meant."""
        return Fix(self.edits, self.assumption)
