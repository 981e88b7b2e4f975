"""The transforms that the nodes of own code look up."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.base.source import Location
from grader.ros.nodes.node_facts import NodeFrame
from grader.ros.workspace.graph.code_ends import frames_of
from grader.ros.workspace.model.workspace import Workspace

_CPP = (".cpp", ".hpp", ".h")
# What looks up transforms by other calls than those that are read.
_OTHER_LOOKUPS = (".transform(", "lookup_transform)", "lookup_transform\n", "lookup_transform,")
_LOOKUPS = (
    *("lookup_transform", "lookupTransform", "can_transform", "canTransform"),
    *_OTHER_LOOKUPS,
)


class _LookedUp(NamedTuple):
    """The frames of a transform that a node looks up; None for one that is not known."""

    target: str | None
    source: str | None
    node: str
    location: Location


def looked_up_transforms(workspace: Workspace) -> tuple[Sequence[_LookedUp], bool]:
    """Return the transforms that nodes look up, and whether code may look up others.

    Nodes that launch files start, or may start, come first.
    """
    lookups = [*_read_lookups(workspace)]
    return lookups, _may_look_up_others(workspace, lookups)


def _read_lookups(workspace: Workspace) -> Iterator[_LookedUp]:
    started: set[Location] = set()
    nodes = [node for _, node in workspace.launches.nodes]
    for _, launch in workspace.launches.roots:
        nodes += [component.node for component in launch.components if component.node is not None]
    for node in nodes:
        started.update(facts.location for facts in workspace.code.nodes_of(node))
        if node.when is not False:
            yield from _pairs(frames_of(workspace, node), node.executable)
    for code in workspace.code.by_package.values():
        for facts in code.nodes:
            if facts.location not in started:
                frames = [(frame.name, frame) for frame in facts.frames]
                yield from _pairs(frames, facts.name or facts.class_name)


def _pairs(frames: Iterable[tuple[str | None, NodeFrame]], node: str) -> Iterator[_LookedUp]:
    """Yield the frames of each lookup of a node."""
    by_call: dict[Location, list[str | None]] = {}
    for name, frame in frames:
        if frame.lookup is not None:
            plain = name.removeprefix("/") if name is not None else None
            by_call.setdefault(frame.lookup, []).append(plain)
    for at, names in by_call.items():
        target, source = names if len(names) == 2 else (None, None)
        yield _LookedUp(target, source, node, at)


def _may_look_up_others(workspace: Workspace, lookups: Sequence[_LookedUp]) -> bool:
    """Return whether code may look up transforms that are not known."""
    if workspace.launches.unknown_nodes or any(None in lookup[:2] for lookup in lookups):
        return True
    texts = [*workspace.texts.python_texts]
    for package in workspace.packages:
        texts += [file.text for file in workspace.texts.sources_of(package, _CPP)]
    words = _LOOKUPS if not lookups else _OTHER_LOOKUPS
    return any(word in text for text in texts for word in words)
