"""Names for which ROS 2 rejects a file and that surely stand for others: of links and joints."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from grader.base.grouping import group_values
from grader.base.names import near
from grader.base.patterns import on_use
from grader.base.text import quoted
from grader.ros.urdf.model import Robot
from grader.ros.xml.parsing import Element
from grader.ros.xml.urdf_format import JOINT_TYPES

_MAX_NAMES = 20  # that no link has
_MAX_PLACES = 100  # in which such names are
_MAX_DOUBLED = 5  # joints that move one link
_ROOT = on_use(r"(?i)base|world|map|odom|root")  # how the first link of a robot is usually called


class MeantName(NamedTuple):
    """A name in an attribute of an element that is read as another one."""

    element: Element
    attribute: str
    meant: str
    what: str  # "the link"

    @property
    def written(self) -> str:
        """The name as it is written."""
        return str(self.element.get(self.attribute))

    @property
    def sentence(self) -> str:
        """What is assumed."""
        return f"{self.what} {quoted(self.written)} is read as {quoted(self.meant)}"


_MeantNames = Iterator[MeantName]


def find_meant_names(root: Element, robot: Robot) -> list[list[MeantName]]:
    """Return the names that surely are others, each list with those that one slip changes.

    `robot` was read from `root`.
    """
    names = [*_misspelt_references(root, robot), *_repeated_names(root)]
    names += _pasted_children(root, robot)
    by_words = group_values(((name.sentence, name.attribute), name) for name in names)
    exchanged = list(_exchanged_ends(root, robot))
    return [*by_words.values(), *([exchanged] if exchanged else [])]


def _misspelt_references(root: Element, robot: Robot) -> _MeantNames:
    """Yield links that joints name and that do not exist, and joint types.

    Each is near one that can be meant.
    """
    links = [link.name for link in robot.links]
    uses = Counter(name for joint in robot.joints for name in (joint.parent, joint.child))
    unknown = [name for name in uses if name and not robot.has_link(name)]
    if len(unknown) > _MAX_NAMES:
        return
    defined = _misspelt_definitions(robot, links, uses, unknown)
    for element in root.iterchildren("link"):
        meant = defined.get(element.get("name") or "")
        if meant is not None:
            yield MeantName(element, "name", meant, "the link")
    misspelt = set(unknown).difference(defined.values())
    if sum(uses[name] for name in misspelt) > _MAX_PLACES:
        misspelt = set()
    children = {joint.child for joint in robot.joints}
    for joint in root.iterchildren("joint"):
        yield from _misspelt_type(joint)
        yield from _misspelt_ends(joint, misspelt, links, children)


def _misspelt_type(joint: Element) -> _MeantNames:
    """Yield the type of a joint if it is near one that there is."""
    written = joint.get("type")
    if written not in JOINT_TYPES:
        kind = near(written or "", JOINT_TYPES)
        if kind is not None:
            yield MeantName(joint, "type", kind, "the joint type")


def _misspelt_definitions(
    robot: Robot, links: Collection[str], uses: Mapping[str, int], unknown: Collection[str]
) -> dict[str, str]:
    """Return the links whose definitions have the wrong word.

    Each has the unknown name that is meant.

    No joint names the link, and several joints name the other one, or a joint is named after it.
    """
    names = "".join(f"_{joint.name}_" for joint in robot.joints)
    nearest = {
        near(name, links, "link"): name
        for name in unknown
        if uses[name] > 1 or f"_{name}_" in names
    }
    return {
        link: name
        for link, name in nearest.items()
        if link and link not in uses and (uses[name] > 1 or f"_{link}_" not in names)
        if name.endswith("link") or not link.endswith("link")  # the shorter name lacks its end
    }


def _misspelt_ends(
    joint: Element, misspelt: Collection[str], links: Sequence[str], children: set[str]
) -> _MeantNames:
    """Yield the misspelt parent and child of a joint.

    `children` grows by what is meant, which no other joint can.
    """
    ends = {role: end for role in ("parent", "child") if (end := joint.find(role)) is not None}
    for role, end in ends.items():
        name = end.get("link") or ""
        if name not in misspelt:
            continue
        others = {other.get("link") for other in ends.values()}
        if role == "child":
            others |= children
        meant = near(name, [link for link in links if link not in others], "link")
        if meant is not None:
            if role == "child":
                children.add(meant)
            yield MeantName(end, "link", meant, "the link")


def _exchanged_ends(root: Element, robot: Robot) -> _MeantNames:
    """Yield the parent and child of the one joint that are exchanged.

    Because of it one link has two parents.
    """
    root_with = _roots_with_exchanged_ends(robot)
    usual = [index for index, name in root_with.items() if _ROOT.match(name)]
    only = usual if len(root_with) > 1 else list(root_with)
    elements = list(root.iterchildren("joint"))
    if len(only) != 1 or len(elements) != len(robot.joints):
        return
    joint = robot.joints[only[0]]
    element = elements[only[0]]
    for role, link in (("parent", joint.child), ("child", joint.parent)):
        end = element.find(role)
        if end is not None and end.get("link"):
            yield MeantName(end, "link", link, f"the {role}")


def _roots_with_exchanged_ends(robot: Robot) -> dict[int, str]:
    """Return the only root of the robot if the ends of a joint are exchanged, by joint number.

    The joints are those above the one link that has several parents.
    """
    counts = Counter(joint.child for joint in robot.joints)
    doubled = [child for child, count in counts.items() if count > 1]
    if len(doubled) != 1 or counts[doubled[0]] > _MAX_DOUBLED:
        return {}
    root_with = {}
    for index, joint in enumerate(robot.joints):
        if joint.child == doubled[0] and joint.parent not in counts:
            others = {*counts, joint.parent}
            roots = [link.name for link in robot.links if link.name not in others]
            if len(roots) == 1:
                root_with[index] = roots[0]
    return root_with


def _pasted_children(root: Element, robot: Robot) -> _MeantNames:
    """Yield the child that a second joint has by mistake.

    The one link that no joint names should be there.
    """
    counts = Counter(joint.child for joint in robot.joints)
    named = {*counts, *(joint.parent for joint in robot.joints)}
    lonely = [link.name for link in robot.links if link.name not in named]
    doubled = [child for child, count in counts.items() if count == 2]
    if len(lonely) != 1 or len(doubled) != 1:
        return
    ends = []  # that of the joint that is named after the lonely link comes last
    for index, joint in enumerate(root.iterchildren("joint")):
        end = joint.find("child")
        if end is not None and end.get("link") == doubled[0]:
            ends.append((lonely[0] in (joint.get("name") or ""), index, end))
    for _, _, end in sorted(ends, key=lambda placed: placed[:2])[-1:]:
        yield MeantName(end, "link", lonely[0], "the child")


def _repeated_names(root: Element) -> _MeantNames:
    """Yield a name that is given twice, where one other name is used and not given.

    The later one should have it.
    """
    ends = [end for end in root.iterfind("joint/*") if end.tag in ("parent", "child")]
    used_links = dict.fromkeys(end.get("link") for end in ends)
    used_joints = dict.fromkeys(mimic.get("joint") for mimic in root.iterfind("joint/mimic"))
    yield from _find_repeated(root, "link", used_links)
    yield from _find_repeated(root, "joint", used_joints)


def _find_repeated(root: Element, tag: str, used: Iterable[str | None]) -> _MeantNames:
    by_name = group_values((element.get("name"), element) for element in root.iterchildren(tag))
    repeated = [named for name, named in by_name.items() if name is not None and len(named) > 1]
    missing = [name for name in used if name and name not in by_name]
    if len(repeated) == len(missing) == 1 and len(repeated[0]) == 2:
        yield MeantName(repeated[0][-1], "name", missing[0], f"the second {tag}")
    elif tag == "joint" and not missing:
        for joints in repeated:
            yield from _copied_joint(joints, by_name)


def _copied_joint(joints: Sequence[Element], known: Collection[str | None]) -> _MeantNames:
    """Yield the joint that was copied with its name, which has the child of the first one in it."""
    children = []
    for joint in joints:
        end = joint.find("child")
        children.append(end.get("link") or "" if end is not None else "")
    name = joints[0].get("name") or ""
    if len(joints) == 2 and children[0] and children[1] and name.count(children[0]) == 1:
        meant = name.replace(children[0], children[1])
        if meant not in known and children[1] not in name:
            yield MeantName(joints[1], "name", meant, "the second joint")
