"""The names in the elements of robots: links, joints and materials, defined and used."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

from grader.base import markup
from grader.ros.package.robot_file import Read
from grader.ros.xml.parsing import Element
from grader.workspace.index.written_names import (
    Role,
    WrittenNames,
    written_name,
)


class _Named(NamedTuple):
    """What an attribute of an element names."""

    kind: str
    role: Role


# By the tags of an element and its parent, and the attribute.
_NAMED = {
    ("robot", "link", "name"): _Named("link", "definition"),
    ("robot", "joint", "name"): _Named("joint", "definition"),
    ("robot", "material", "name"): _Named("material", "definition"),
    ("robot", "gazebo", "reference"): _Named("link", "use"),
    ("joint", "parent", "link"): _Named("link", "use"),
    ("joint", "child", "link"): _Named("link", "use"),
    ("joint", "mimic", "joint"): _Named("joint", "use"),
    ("sensor", "parent", "link"): _Named("link", "use"),
    ("visual", "material", "name"): _Named("material", "use"),
    ("ros2_control", "joint", "name"): _Named("joint", "use"),
    ("transmission", "joint", "name"): _Named("joint", "use"),
}
_TAGS = frozenset(tag for _, tag, _ in _NAMED)
_ATTRIBUTES = tuple(dict.fromkeys(attribute for _, _, attribute in _NAMED))


def names_in_robots(urdfs: Sequence[Read]) -> WrittenNames:
    """Yield the names in robots, each robot with its path as the owner.

    Names of xacro are yielded where they are written, and as they are after expansion.
    """
    for urdf in urdfs:
        reading = urdf.reading
        root = reading.root if reading.root is not None else reading.recovered
        if root is not None:
            yield from _names_in_robot(urdf, root)


def _names_in_robot(urdf: Read, root: Element) -> WrittenNames:
    joints = {joint.get("name") for joint in root.iterchildren("joint")}
    for tag, element in enumerate(root.iter("*")):
        if element.tag not in _TAGS or element.getparent() is None:
            continue
        for attribute in _ATTRIBUTES:
            name = element.get(attribute)
            named = _named_by(element, attribute, joints) if name else None
            if not named or not name:
                continue
            source, start = urdf.reading.source.element(tag)
            written = markup.attribute(source.text, start, attribute)
            if written:
                yield written_name(source, written.value, named.kind, name, named.role, urdf.path)


def _named_by(element: Element, attribute: str, joints: Collection[str | None]) -> _Named | None:
    """Return what an attribute names.

    It may be a joint in a reference of Gazebo, or a material that is defined in a visual, to
    which ROS 2 adds its color.
    """
    parent = element.getparent()
    assert parent is not None
    named = _NAMED.get((str(parent.tag), str(element.tag), attribute))
    if not named:
        return None
    if attribute == "reference" and element.get(attribute) in joints:
        return _Named("joint", "use")
    if element.tag == "material" and len(element):
        return _Named("material", "definition")
    return named
