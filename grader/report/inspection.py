"""A URDF as `grader inspect` shows it: problems, tree, joints, poses; and the names in packages
that do not agree.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice
from math import isfinite

from grader.base.errors import MissingElement, NotDecided
from grader.base.problems import Problem
from grader.base.source import Base, Source
from grader.base.text import counted, printable
from grader.base.transforms import Transform
from grader.report.content import UNDECIDED, VERDICTS
from grader.report.criteria import alike
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint
from grader.ros.urdf.reader import Reading

MAX_LISTED = 500  # links, or problems on a page
_MAX_INDENT = 60
EFFECTS = {
    **{verdict: text.replace("the file", "it") for verdict, text in VERDICTS.items()},
    "undecided": UNDECIDED,
}


_NO_BASE = Base(is_outside=True)


@dataclass(frozen=True, slots=True)
class Inspection:
    """A URDF as read, with its joints at given positions; `robot` is None if ROS 2 reads nothing.

    Packages without a URDF have no `reading`. `names` are the problems of names in packages.
    """

    path: str
    reading: Reading | None
    robot: Configuration | None = None
    relative_to: str | None = None
    names: tuple[Problem, ...] = ()
    source_of: Callable[[str], Source | None] | None = None
    base: Base = _NO_BASE  # its place in a repository

    @property
    def verdict(self) -> str | None:
        """ROS 2's verdict; `undecided` where it cannot be determined statically; None without a
        URDF.
        """
        if self.reading is None:
            return None
        return self.reading.verdict if self.reading.is_certain else "undecided"

    @property
    def is_passed(self) -> bool:
        """Return whether ROS 2 loads the URDF, and no name is certainly wrong."""
        return self.verdict not in ("rejected", "undecided") and all(
            it.severity != "error" for it in self.names
        )

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The problems of the URDF, then those of names."""
        return (*(self.reading.problems if self.reading is not None else ()), *self.names)

    def source(self, path: str) -> Source | None:
        """Return the text of a file, for quoting."""
        own = self.reading.source if self.reading is not None else None
        if own is not None and own.path == path:
            return own
        return self.source_of(path) if self.source_of is not None else None

    def poses(self) -> Iterator[tuple[str, Transform | str]]:
        """Yield the pose of every link in the frame `relative_to`, in file order, or the reason why
        it has none.
        """
        if self.robot is None or self.relative_to is None:
            return
        for link in self.robot.robot.links:
            try:
                yield link.name, self.robot.pose(link.name, relative_to=self.relative_to)
            except (MissingElement, NotDecided) as reason:
                yield link.name, str(reason)


def main_root(robot: Configuration) -> str | None:
    """Return the root of the largest tree; None if every link is in a loop."""
    return next(iter(robot.main_tree), None)


def lists(inspection: Inspection) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Yield the links as a tree with their joints, and their poses: a title, and names with words
    about each.
    """
    if (
        inspection.robot is not None and inspection.relative_to is not None
    ):  # else there is neither a tree nor a frame
        links = _tree(inspection.robot)
        yield (
            "Tree",
            _first_rows(
                (indent + printable(link), _joint_text(joint)) for indent, link, joint in links
            ),
        )
        title = (
            f"Poses in {printable(inspection.relative_to)!r} (x y z in m, roll pitch yaw in rad)"
        )
        yield (
            title,
            _first_rows(
                (printable(link), f"  {_pose_text(pose)}") for link, pose in inspection.poses()
            ),
        )


def _first_rows(rows: Iterator[tuple[str, str]]) -> list[tuple[str, str]]:
    shown, rest = [*islice(rows, MAX_LISTED)], sum(1 for _ in rows)
    if rest:
        return [*shown, (f"... and {rest} more", " (--format json lists all)")]
    return shown


def effect(inspection: Inspection) -> str:
    """Return what ROS 2 does with a URDF; without one, how many names are wrong."""
    if inspection.verdict is not None:
        return EFFECTS[inspection.verdict]
    if inspection.names:
        return f"{counted(len(inspection.names), 'problem')} of names"
    return "the names agree"


def _tree(robot: Configuration) -> Iterator[tuple[str, str, Joint | None]]:
    """Yield every link after its parent: its indentation, its name, and its parent joint."""
    children = dict(alike(robot.parent_joints.values(), lambda joint: joint.parent))
    stack: list[tuple[str, str, Joint | None]] = [
        ("", root, None) for root in reversed(robot.roots)
    ]
    while stack:
        yield (link := stack.pop())
        indent = f"{link[0]}  " if len(link[0]) < _MAX_INDENT else link[0]
        stack += [(indent, joint.child, joint) for joint in reversed(children.get(link[1], ()))]


def _joint_text(joint: Joint | None) -> str:
    """Return a joint in words; empty for the parent joint of a root."""
    if joint is None:
        return ""
    words = f"  {printable(joint.name)}: {printable(joint.type) or 'no type'}"
    if joint.type not in ("fixed", "floating"):
        words += (
            f" about {_numbers(joint.axis)}"
            if joint.axis is not None
            else " about an unreadable axis"
        )
    if joint.limit is not None and isfinite(joint.limit.upper - joint.limit.lower):
        words += f", {joint.limit.lower:g}..{joint.limit.upper:g}"
    if joint.mimic is not None:
        words += f", mimics {printable(joint.mimic.joint)}"
    return words


def _pose_text(pose: Transform | str) -> str:
    if isinstance(pose, str):
        return printable(pose)
    return f"{_numbers(pose.translation)}  rpy {_numbers(pose.rpy)}"


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(f"{round(value, 4) + 0.0:g}" for value in values)
