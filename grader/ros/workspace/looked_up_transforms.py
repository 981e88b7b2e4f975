"""Transforms that own nodes look up between frames that are there, and that nothing connects."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.known.known import known
from grader.ros.package.static_transforms import STATIC_PUBLISHER, frames_named
from grader.ros.workspace.frames import openings
from grader.ros.workspace.graph.endpoints import frames_of
from grader.ros.workspace.graph.gazebo_topics import roots, system_of
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.names import UNCONNECTED, Compared, Mismatch

_ROBOT_PUBLISHER = "robot_state_publisher"
_PUBLISHED = ("publishes", "is above")


class _Lookup(NamedTuple):
    """A transform that a node looks up."""

    frames: tuple[str, str]
    location: Location


class _Trees:
    """The frames that are published, and which of them transforms connect."""

    def __init__(self) -> None:
        self._number: dict[str, int] = {}
        self._members: list[list[str]] = []

    def connect(self, *frames: str) -> None:
        """Add that there are transforms between frames."""
        for frame in frames:
            if frame not in self._number:
                self._number[frame] = len(self._members)
                self._members.append([frame])
            first, second = sorted((self._number[frames[0]], self._number[frame]))
            if first != second:
                moved = self._members[second]
                self._members[second] = []
                self._members[first] += moved
                self._number.update(dict.fromkeys(moved, first))

    def are_apart(self, one: str, other: str) -> bool:
        """Return whether two frames are published, and not connected."""
        numbers = self._number.get(one), self._number.get(other)
        return None not in numbers and numbers[0] != numbers[1]


def lookup_facts(workspace: Workspace) -> Iterator[Compared | Mismatch]:
    """Yield the transforms that are looked up between frames which launch files publish, where
    certainly nothing that these start connects them. A program in another terminal may publish
    other frames, such as the map, and is not likely to connect these.
    """
    lookups = [*_lookups(workspace)]
    if not lookups or any(fact.kind == "frame" for fact in openings(workspace)):
        return
    trees = _published(workspace)
    if trees is None:
        return
    yield Compared("transforms")
    for lookup in lookups:
        target, source = lookup.frames
        if trees.are_apart(target, source):
            message = (
                f"nothing that is started connects {quoted(target)} and {quoted(source)}, so this "
                "lookup fails"
            )
            at = lookup.location
            yield Mismatch("transforms", message, at, is_certain=False, rule=UNCONNECTED)


def _lookups(workspace: Workspace) -> Iterator[_Lookup]:
    """Yield what nodes that are certainly started look up, where both frames are known."""
    for _, node in workspace.nodes:
        if node.when is not True:
            continue
        by_call: dict[Location, list[str]] = {}
        for name, frame in frames_of(workspace, node):
            if frame.lookup is not None:
                by_call.setdefault(frame.lookup, []).append((name or "").removeprefix("/"))
        for at, names in by_call.items():
            if len(names) == 2:
                yield _Lookup((names[0], names[1]), at)


def _published(workspace: Workspace) -> _Trees | None:
    """Return what launch files publish, whatever conditions say; None where that is not known."""
    odometry = known()["odometry_systems"]
    if any(system_of(it) in odometry for root, _ in roots(workspace) for it in root.iter("plugin")):
        return None
    trees = _Trees()
    if any(node.executable == _ROBOT_PUBLISHER for _, node in workspace.nodes):
        for found in workspace.robots:
            for joint in found.robot.joints:
                trees.connect(joint.parent, joint.child)
    for _, node in workspace.nodes:
        frames: Sequence[str | None] = []
        if node.package in known()["transform_publishers"] or node.frame_prefix != "":
            return None
        if (node.package, node.executable) == STATIC_PUBLISHER:
            frames = [name or None for name in frames_named(node)]
        elif node.executable != _ROBOT_PUBLISHER:
            named = frames_of(workspace, node)
            frames = [name for name, frame in named if frame.use in _PUBLISHED]
        if None in frames:
            return None
        trees.connect(*(frame.removeprefix("/") for frame in frames if frame))
    return trees
