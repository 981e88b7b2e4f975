"""The names in the elements of robots: links, joints and materials, defined and used."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.base import markup
from grader.ros.package.robot_file import Read
from grader.ros.workspace.index.written_names import Role, WrittenName, written_name
from grader.ros.xml.parsing import Element


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


def names_in_robots(urdfs: Sequence[Read]) -> Iterator[WrittenName]:
    """Yield the names in robots, each robot with its path as the owner; of xacro where they are
    written, and as they are after expansion.
    """
    for urdf in urdfs:
        reading = urdf.reading
        root = reading.root if reading.root is not None else reading.recovered
        if root is not None:
            yield from _names_in_robot(urdf, root)


def _names_in_robot(urdf: Read, root: Element) -> Iterator[WrittenName]:
    joints = {joint.get("name") for joint in root.iterchildren("joint")}
    for tag, element in enumerate(root.iter("*")):
        parent = element.getparent()
        if element.tag not in _TAGS or parent is None:
            continue
        for attribute in _ATTRIBUTES:
            named = _NAMED.get((str(parent.tag), str(element.tag), attribute))
            name = element.get(attribute)
            if named is None or not name:
                continue
            if attribute == "reference" and name in joints:
                named = _Named("joint", "use")
            elif element.tag == "material" and len(element):
                named = _Named("material", "definition")  # also in a visual: ROS 2 adds its color
            source, start = urdf.reading.source.element(tag)
            written = markup.attribute(source.text, start, attribute)
            if written is not None:
                yield written_name(source, written.value, named.kind, name, named.role, urdf.path)
