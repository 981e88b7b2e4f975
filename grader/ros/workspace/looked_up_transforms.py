"""Transforms that own nodes look up between frames that nothing connects."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.known.known import known
from grader.ros.package.static_transforms import STATIC_PUBLISHER, frames_named
from grader.ros.workspace.endpoints import frames_of
from grader.ros.workspace.frames import openings, own_frames
from grader.ros.workspace.names import UNCONNECTED, Compared, Mismatch
from grader.ros.workspace.workspace import Workspace

_PUBLISHED = ("publishes", "is above")


class _Lookup(NamedTuple):
    """A transform that a node looks up."""

    frames: tuple[str, str]
    location: Location


class _Trees:
    """The frames that transforms may connect."""

    def __init__(self) -> None:
        self._above: dict[str, str] = {}

    def root(self, frame: str) -> str:
        """Return the frame that stands for all that are connected with one."""
        while frame in self._above:
            frame = self._above[frame]
        return frame

    def connect(self, frames: Sequence[str]) -> None:
        """Add that there may be transforms between frames."""
        for frame in frames[1:]:
            roots = self.root(frames[0]), self.root(frame)
            if roots[0] != roots[1]:
                self._above[roots[1]] = roots[0]


def lookup_facts(workspace: Workspace) -> Iterator[Compared | Mismatch]:
    """Yield the transforms that are looked up between frames that exist, where certainly nothing
    that a launch file starts connects these.
    """
    lookups = [*_lookups(workspace)]
    if not lookups or any(fact.kind == "frame" for fact in openings(workspace)):
        return
    trees = _connected(workspace)
    if trees is None:
        return
    yield Compared("transforms")
    for lookup in lookups:
        target, source = lookup.frames
        if trees.root(target) == trees.root(source):
            continue
        message = (
            f"the transform between {quoted(target)} and {quoted(source)} is looked up, and "
            "nothing that is started connects these frames"
        )
        yield Mismatch("transforms", message, lookup.location, is_certain=False, rule=UNCONNECTED)


def _lookups(workspace: Workspace) -> Iterator[_Lookup]:
    """Yield what nodes that are certainly started look up, where both frames are known to exist."""
    existing = {*known()["frames"]}
    for found in workspace.robots:
        existing |= {link.name for link in found.robot.links}
    for _, node in workspace.nodes:
        if (node.package, node.executable) == STATIC_PUBLISHER:
            existing |= {*frames_named(node)}
    for _, node in workspace.nodes:
        if node.when is not True:
            continue
        by_call: dict[Location, list[str]] = {}
        for name, frame in frames_of(workspace, node):
            if frame.lookup is not None:
                by_call.setdefault(frame.lookup, []).append((name or "").removeprefix("/"))
        for at, names in by_call.items():
            if len(names) == 2 and existing.issuperset(names):
                yield _Lookup((names[0], names[1]), at)


def _connected(workspace: Workspace) -> _Trees | None:
    """Return what may be connected, whatever conditions say; None where that is not known."""
    trees = _Trees()
    roots: list[str] = []
    for found in workspace.robots:
        joints = found.robot.joints
        for joint in joints:
            trees.connect([joint.parent, joint.child])
        children = {joint.child for joint in joints}
        roots += [link.name for link in found.robot.links if link.name not in children]
    for package, node in workspace.nodes:
        if (node.package, node.executable) == STATIC_PUBLISHER:
            trees.connect([name for name in frames_named(node) if name])
        elif node.package in known()["placing"]:
            named = own_frames(workspace.parameters_given(package, node))
            frames = [*known()["placing"][node.package], *(name for name, _ in named)]
            trees.connect([*frames, *roots])
        own = [name for name, frame in frames_of(workspace, node) if frame.use in _PUBLISHED]
        if None in own:
            return None
        trees.connect([name.removeprefix("/") for name in own if name])
    return trees
