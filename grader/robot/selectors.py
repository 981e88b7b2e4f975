"""Links that are named by their place in the tree: "@root", "@tip", "@moved:2"."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from grader.errors import MissingElement, NotDecided
from grader.robot.model import Joint, Robot
from grader.text import counted, enumerated, quoted

_SELECTOR = re.compile(r"@(?:root|tip|moved:([1-9]\d{0,3}))")
_MAX_NAMED = 5  # links in a message


class _LinkPlace(NamedTuple):
    """The place of a link in its tree: the root, and how many moving joints are above it."""

    root: str
    depth: int
    is_moved: bool  # by its own joint


def is_selector(text: str) -> bool:
    """Return whether a text names a link by its place in the tree."""
    return _SELECTOR.fullmatch(text) is not None


def texts_in(value: Any) -> Iterator[str]:
    """Yield a text, or the texts in a list or in the values of a table."""
    match value:
        case str():
            yield value
        case list() | tuple():
            for item in value:
                yield from texts_in(item)
        case Mapping():
            yield from texts_in(list(value.values()))


def selected_link(robot: Robot, parents: Mapping[str, Joint], name: str) -> str:
    """Return the name of the link that a selector means, and any other text as it is; `parents` are the parent joints.

    Of several trees the one with the most links counts. "@root" is its root. The chain with the most moving joints,
    which are neither fixed nor mimic joints, leads to "@tip", its last link, and "@moved:2" is the child of its second
    moving joint.

    Raises MissingElement where there is no such link, NotDecided where several could be meant.
    """
    found = _SELECTOR.fullmatch(name)
    if found is None or robot.has_link(name):
        return name
    robot.check_complete()
    places = _places(robot, parents)
    root = _main_root(places, name)
    places = {link: place for link, place in places.items() if place.root == root}
    if name == "@root":
        return root
    most = max(place.depth for place in places.values())
    if found[1] is None:
        inner = {parents[link].parent for link in places if link != root}
        tips = {link for link, place in places.items() if place.depth == most and link not in inner}
        return _only(robot, tips, name)
    return _only(robot, _links_of(places, parents, int(found[1]), most, name), name)


def _links_of(
    places: dict[str, _LinkPlace], parents: Mapping[str, Joint], number: int, most: int, name: str
) -> set[str]:
    """Return the links that the joint of this number moves, of those on the chains with the most moving joints."""
    if number > most:
        longest = f"the longest chain has {counted(most, 'moving joint')}"
        raise MissingElement("link", name, message=f"there is no {name}: {longest}")
    on_chain = {link for link, place in places.items() if place.depth == most}
    for link in reversed(places):  # a link comes after its parent
        if link in on_chain and link != places[link].root:
            on_chain.add(parents[link].parent)
    return {link for link in on_chain if places[link].is_moved and places[link].depth == number}


def _places(robot: Robot, parents: Mapping[str, Joint]) -> dict[str, _LinkPlace]:
    """Return the places of the links that are in a tree, each after that of its parent."""
    below: dict[str, list[str]] = {}
    for link, joint in parents.items():
        below.setdefault(joint.parent, []).append(link)
    places = {link.name: _LinkPlace(link.name, 0, is_moved=False) for link in robot.links if link.name not in parents}
    waiting = list(places)
    while waiting:
        above = waiting.pop()
        for link in below.get(above, ()):
            is_moving = parents[link].type != "fixed" and parents[link].mimic is None
            places[link] = _LinkPlace(places[above].root, places[above].depth + is_moving, is_moving)
            waiting.append(link)
    return places


def _main_root(places: Mapping[str, _LinkPlace], name: str) -> str:
    sizes = Counter(place.root for place in places.values()).most_common()
    largest = [root for root, size in sizes if size == sizes[0][1]]
    if len(largest) == 1:
        return largest[0]
    message = "no link is the root of the robot" if not largest else "several links are roots of trees of the same size"
    detail = f": {enumerated([*map(quoted, largest)], _MAX_NAMED)}" if largest else ""
    raise MissingElement("link", name, message=f"there is no {name}: {message}", detail=detail)


def _only(robot: Robot, links: set[str], name: str) -> str:
    if len(links) > 1:
        reason = f"several links can be {name}"
        in_file = [quoted(link.name) for link in robot.links if link.name in links]
        raise NotDecided(f"{reason}: {enumerated(in_file, _MAX_NAMED)}", reason)
    return min(links)
