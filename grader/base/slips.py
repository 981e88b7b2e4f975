"""A slip: a word of a file that surely stands for another one."""

from collections.abc import Callable, Iterator, Sequence

from grader.base.problems import Fix, Fixes
from grader.base.records import Named
from grader.base.source import Edit, Edits, Location
from grader.base.text import enumerated


class Slip(Named):
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


Slips = Iterator[Slip]


def make_slip(
    edits: Sequence[Edit], reaction: str, assumption: str, *, is_refused: bool = False
) -> Slip:
    """Return the slip that is where the first of its edits is."""
    return Slip(tuple(edits), reaction, assumption, edits[0].location, is_refused)


def fix_together(find_slips: Callable[[], Sequence[Slip]]) -> Fixes:
    """Return one fix of a file that nothing reads before all of its slips are corrected."""

    def compute() -> list[Fix]:
        slips = find_slips()
        edits: list[Edit] = []
        for slip in slips:
            edits += slip.edits
        if not edits:
            return []
        return [Fix(tuple(edits), enumerated([slip.assumption for slip in slips]))]

    return Fixes(compute)
