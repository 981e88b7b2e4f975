"""The difference between two trees, such as the elements of two robots.

Nodes are paired by what they are recognised by, then by likeness, and compared. Each step of the
difference is independent of the others: a caller makes edits of the steps that it needs.
"""

from collections.abc import Iterator, Sequence
from typing import Any, Literal

from grader.base.grouping import Strings, StringsByName
from grader.base.names import closest
from grader.base.records import Named

_ORDER = {"add": 1, "remove": 2}  # of the steps, after all that set values


class Node(Named):
    """A node of a tree.

    It has its tag, what it is recognised by (the most reliable first), its values, and its
    children.

    `of` is what the node is made from: an element, or a place in a file.
    """

    tag: str
    keys: Sequence[str]
    values: StringsByName
    children: "Sequence[Node]"
    of: Any = None

    def walk(self) -> "Iterator[Node]":
        """Yield the node and all nodes in it."""
        yield self
        for child in self.children:
            yield from child.walk()


_Nodes = Sequence[Node]
_Pair = tuple[Node, Node]


class Step(Named):
    """One step from a tree to another.

    It is what happens to `own_node`, a node of the first tree, as in `like` of the other one.

    set: the value `name` becomes that of `like`. unset: it goes. rename: it is called `other`.
    retag: the node gets the tag of `like`. add: `like` is added to `own_node`. remove: `own_node`
    goes. move: `own_node` becomes a child of `parent`.
    """

    verb: Literal["set", "unset", "rename", "retag", "add", "remove", "move"]
    own_node: Node
    like: Node | None = None
    name: str = ""
    other: str = ""
    parent: Node | None = None


class _Pairs(Named):
    """Two lists of nodes, paired.

    These are those that belong together, those of the first alone, and those of the second alone.
    """

    both: list[_Pair]
    extra: list[Node]
    missing: list[Node]


def steps(own_node: Node, like: Node) -> list[Step]:
    """Return the steps from a tree to another.

    First is what is to move, then the values, then what is to be added and removed.
    """
    every_step = list(_steps(own_node, like))
    spare = [step.own_node for step in every_step if step.verb == "remove"]
    moved = []
    left = []
    for step in every_step:
        other = step.like
        alike = None
        if step.verb == "add" and other:
            alike = next((node for node in spare if _is_alike(node, other)), None)
        if not other or not alike:
            left.append(step)
        else:
            moved.append(Step("move", alike, other, parent=step.own_node))
            moved += _steps(alike, other)
            spare = [node for node in spare if node is not alike]
    kept = _without_removals(left, spare)
    return moved + sorted(kept, key=lambda step: _ORDER.get(step.verb, 0))


def _without_removals(steps_left: Sequence[Step], spare: _Nodes) -> list[Step]:
    """Return the steps without the removal of nodes that are moved: those that are not `spare`."""
    kept = []
    for step in steps_left:
        was_moved = not any(node is step.own_node for node in spare)
        if step.verb != "remove" or not was_moved:
            kept.append(step)
    return kept


def _steps(own_node: Node, like: Node) -> Iterator[Step]:
    if own_node.tag != like.tag:
        yield Step("retag", own_node, like)
    yield from _values(own_node, like)
    pairs = paired(own_node.children, like.children)
    for pair in pairs.both:
        yield from _steps(*pair)
    yield from (Step("add", own_node, node) for node in pairs.missing)
    yield from (Step("remove", node) for node in pairs.extra)


def _values(own_node: Node, like: Node) -> Iterator[Step]:
    missing = [name for name in like.values if name not in own_node.values]
    for name, value in own_node.values.items():
        if name in like.values:
            if value != like.values[name]:
                yield Step("set", own_node, like, name)
            continue
        meant = closest(name, missing)
        if meant:
            yield Step("rename", own_node, like, name, meant)
        yield Step("unset", own_node, like, name)
    yield from (Step("set", own_node, like, name) for name in missing)


def paired(own_nodes: _Nodes, like: _Nodes) -> _Pairs:
    """Pair nodes.

    They are paired by tag and all keys, then by each key, then by tag and likeness, then by similar
    tags.
    """
    pairing = _Pairing(own_nodes, like)
    depth = max((len(node.keys) for node in (*own_nodes, *like)), default=0)
    parts = [slice(0, depth), *(slice(index, index + 1) for index in range(depth))]
    for part in parts:
        pairing.pair_by_keys(part)
    for other in list(pairing.missing):
        alike = [node for node in pairing.extra if node.tag == other.tag]
        if alike:
            scores = [_likeness(node, other) for node in alike]
            pairing.pair(alike[scores.index(max(scores))], other)
    for other in list(pairing.missing):
        near_tag = closest(other.tag, [node.tag for node in pairing.extra])
        for node in pairing.extra:
            if node.tag == near_tag:
                pairing.pair(node, other)
                break
    return _Pairs(pairing.in_order(), pairing.extra, pairing.missing)


class _Pairing:
    """The nodes of two lists that are being paired."""

    def __init__(self, own_nodes: _Nodes, like: _Nodes) -> None:
        self.own_nodes = own_nodes
        self.extra = list(own_nodes)
        self.missing = list(like)
        self.both: list[_Pair] = []

    def pair(self, node: Node, other: Node) -> None:
        """Pair two nodes, which belong to no other one then."""
        self.extra = [one for one in self.extra if one is not node]
        self.missing = [one for one in self.missing if one is not other]
        self.both.append((node, other))

    def pair_by_keys(self, part: slice) -> None:
        """Pair the nodes with the same tag and the same keys, of which one part counts."""
        for other in list(self.missing):
            for node in self.extra:
                is_same = node.tag == other.tag and node.keys[part] == other.keys[part]
                if is_same and any(other.keys[part]):
                    self.pair(node, other)
                    break

    def in_order(self) -> list[_Pair]:
        """Return the pairs in the order of the first list."""
        return [pair for node in self.own_nodes for pair in self.both if pair[0] is node]


def _likeness(one: Node, other: Node) -> float:
    """Return how alike two nodes are.

    This is the share of their values and of the tags in them that both have.
    """
    mine = _content(one)
    its = _content(other)
    return len(mine & its) / max(len(mine | its), 1)


def _is_alike(one: Node, other: Node) -> bool:
    """Return whether a node is another one in another place."""
    if one.tag != other.tag:
        return False
    has_same_key = bool(set(one.keys) & set(other.keys) - {""})
    return has_same_key or _likeness(one, other) > 0.5


def _content(node: Node) -> set[Strings]:
    content: set[Strings] = set()
    for inner in node.walk():
        content.add((inner.tag,))
        content.update((inner.tag, *pair) for pair in inner.values.items())
    return content
