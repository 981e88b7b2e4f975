"""The difference between two trees, such as the elements of two robots.

Nodes are paired by what they are recognised by, then by likeness, and compared. Each step of the
difference is independent of the others: a caller makes edits of the steps that it needs.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple

from grader.base.names import closest

_LAST = ("add", "remove")


class Node(NamedTuple):
    """A node of a tree: its tag, what it is recognised by (the most reliable first), its values,
    and its children.

    `of` is what the node is made from: an element, or a place in a file.
    """

    tag: str
    keys: tuple[str, ...]
    values: Mapping[str, str]
    children: "Sequence[Node]"
    of: Any = None

    def walk(self) -> "Iterator[Node]":
        """Yield the node and all nodes in it."""
        yield self
        for child in self.children:
            yield from child.walk()


class Step(NamedTuple):
    """One step from a tree to another: what happens to `own`, a node of the first tree, as in
    `like` of the other one.

    set: the value `name` becomes that of `like`. unset: it goes. rename: it is called `other`.
    retag: the node gets the tag of `like`. add: `like` is added to `own`. remove: `own` goes. move:
    `own` becomes a child of `parent`.
    """

    verb: Literal["set", "unset", "rename", "retag", "add", "remove", "move"]
    own: Node
    like: Node | None = None
    name: str = ""
    other: str = ""
    parent: Node | None = None


class _Pairs(NamedTuple):
    """Two lists of nodes: those that belong together, those of the first alone, and those of the
    second alone.
    """

    both: list[tuple[Node, Node]]
    extra: list[Node]
    missing: list[Node]


def steps(own: Node, like: Node) -> list[Step]:
    """Return the steps from a tree to another: what is to move, the values, then what is to be
    added and removed.
    """
    found = [*_steps(own, like)]
    spare = [step.own for step in found if step.verb == "remove"]
    taken: list[Node] = []
    moved: list[Step] = []
    left: list[Step] = []
    for step in found:
        added = step.like if step.verb == "add" else None
        alike = next((node for node in spare if added is not None and _is_alike(node, added)), None)
        if added is None or alike is None:
            left.append(step)
        else:
            moved += [Step("move", alike, added, parent=step.own), *_steps(alike, added)]
            spare = [node for node in spare if node is not alike]
            taken.append(alike)
    kept = [
        step
        for step in left
        if step.verb != "remove" or not any(node is step.own for node in taken)
    ]
    return moved + sorted(
        kept, key=lambda step: _LAST.index(step.verb) if step.verb in _LAST else -1
    )


def _steps(own: Node, like: Node) -> Iterator[Step]:
    if own.tag != like.tag:
        yield Step("retag", own, like)
    yield from _values(own, like)
    pairs = paired(own.children, like.children)
    for pair in pairs.both:
        yield from _steps(*pair)
    yield from (Step("add", own, node) for node in pairs.missing)
    yield from (Step("remove", node) for node in pairs.extra)


def _values(own: Node, like: Node) -> Iterator[Step]:
    missing = [name for name in like.values if name not in own.values]
    for name, value in own.values.items():
        if name in like.values:
            if value != like.values[name]:
                yield Step("set", own, like, name)
            continue
        meant = closest(name, missing)
        if meant:
            yield Step("rename", own, like, name, meant)
        yield Step("unset", own, like, name)
    yield from (Step("set", own, like, name) for name in missing)


def paired(own: Sequence[Node], like: Sequence[Node]) -> _Pairs:
    """Pair nodes: by tag and all keys, then by each key, then by tag and likeness, then by similar
    tags.
    """
    extra, missing = [*own], [*like]
    both: list[tuple[Node, Node]] = []
    depth = max((len(node.keys) for node in (*own, *like)), default=0)
    for part in (slice(0, depth), *(slice(index, index + 1) for index in range(depth))):
        for other in [*missing]:
            alike = [
                node
                for node in extra
                if node.tag == other.tag and node.keys[part] == other.keys[part]
            ]
            found = next(iter(alike), None) if any(other.keys[part]) else None
            if found is not None:
                _pair(found, other, extra, missing, both)
    for other in [*missing]:
        alike = [node for node in extra if node.tag == other.tag]
        if alike:
            _pair(max(alike, key=lambda node: _likeness(node, other)), other, extra, missing, both)
    for other in [*missing]:
        near = closest(other.tag, [node.tag for node in extra])
        found = next((node for node in extra if node.tag == near), None)
        if found is not None:
            _pair(found, other, extra, missing, both)
    in_order = [pair for node in own for pair in both if pair[0] is node]
    return _Pairs(in_order, extra, missing)


def _pair(
    node: Node, other: Node, extra: list[Node], missing: list[Node], both: list[tuple[Node, Node]]
) -> None:
    extra[:] = [one for one in extra if one is not node]
    missing[:] = [one for one in missing if one is not other]
    both.append((node, other))


def _likeness(one: Node, other: Node) -> float:
    """Return how alike two nodes are: the share of their values and of the tags in them that both
    have.
    """
    mine, its = _content(one), _content(other)
    return len(mine & its) / max(len(mine | its), 1)


def _is_alike(one: Node, other: Node) -> bool:
    """Return whether a node is another one in another place."""
    return one.tag == other.tag and (
        _likeness(one, other) > 0.5 or bool(set(one.keys) & set(other.keys) - {""})
    )


def _content(node: Node) -> set[tuple[str, ...]]:
    return {
        item
        for inner in node.walk()
        for item in ((inner.tag,), *((inner.tag, *pair) for pair in inner.values.items()))
    }
