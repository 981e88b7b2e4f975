"""Words for which ROS 2 rejects a file and that surely stand for others.

It tells what the robot is if they are undone.
"""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

from grader.base.element_edits import (
    escaped,
    merged,
    renamed_attribute,
    renamed_tag,
    with_attribute,
)
from grader.base.names import near
from grader.base.problems import NO_FIXES, Fix, Fixes, Problem
from grader.base.source import Edits
from grader.base.text import quoted
from grader.ros.urdf.diagnostics import Problems
from grader.ros.urdf.model import Robot
from grader.ros.urdf.numbers import readable_numbers
from grader.ros.urdf.words import meant_attribute, meant_tag, meant_value
from grader.ros.xml.parsing import Element
from grader.ros.xml.urdf_format import ATTRIBUTES, JOINT_TYPES, PARTS, REQUIRED

# one undone word can reveal the next: that of a tag, then its attribute, then its value
_MAX_ROUNDS = 5
_MAX_WORDS = 20  # in one file
_MAX_ATTRIBUTES = 50  # of one element, because lxml searches each name from the first
_ROOT = re.compile(
    r"(?i)base|world|map|odom|root"
)  # how the first link of a robot is usually called
_OF_JOINT = (
    "parent",
    "child",
    "limit",
    "mimic",
    "safety_controller",
)  # a defect of these rejects the file


class Word(NamedTuple):
    """A word of an element that is read as another one, in a sentence.

    `tag` and `attributes` are those as read.
    """

    element: Element
    attribute: str | None  # where the word is; None: the tag
    tag: str
    attributes: dict[str, str]
    sentence: str
    fixes: Fixes = NO_FIXES

    @property
    def place(self) -> tuple[Element, str | None]:
        """The element, with the attribute."""
        return self.element, self.attribute


class AsMeant(NamedTuple):
    """What ROS 2 would read if some words were others; the problems say which."""

    robot: Robot
    problems: list[Problem]
    words: list[Word]


def read_as_meant(
    root: Element, robot: Robot, read: Callable[[], tuple[Robot, Problems]]
) -> AsMeant | None:
    """Return what a rejected file means.

    Returns None if a word can stand for several, or ROS 2 would still reject the file.

    `robot` was read from `root`, and `read` reads it again. The elements are as before at the end.
    """
    undone: list[Word] = []
    before: list[tuple[Element, str, dict[str, str]]] = []
    try:
        for _ in range(_MAX_ROUNDS):
            ways = (
                _misspelt_format(root),
                _misspelt_references(root, robot),
                _repeated_names(root),
                _readable_numbers(root),
                _exchanged_ends(root, robot),
                _pasted_children(root, robot),
            )
            words = next(filter(None, ([*islice(way, _MAX_WORDS)] for way in ways)), [])
            if not words:
                return None
            for word in words:
                before.append((word.element, str(word.element.tag), dict(word.element.attrib)))  # type: ignore[arg-type]
                _rewrite_element(word.element, word.tag, word.attributes)
            undone += words
            robot, problems = read()
            if "rejects" not in problems.effects:
                words = [word._replace(fixes=_make_fixes(word, problems)) for word in undone]
                for word in words:
                    problems.undone = {**problems.undone, word.place: word.fixes}
                    problems.listed.append(problems.assumed(*word.place, word.sentence, word.fixes))
                return AsMeant(robot, problems.listed, words)
        return None
    finally:
        for element, tag, attributes in reversed(before):
            _rewrite_element(element, tag, attributes)


def _make_fixes(word: Word, problems: Problems) -> Fixes:
    return Fixes(lambda: [Fix(edits, word.sentence) for edits in _make_edits(word, problems)])


def _make_edits(word: Word, problems: Problems) -> Iterator[Edits]:
    """Yield the edits of a word, if they change the text.

    The word is a tag, the name of an attribute, or its value.
    """
    place, attribute = problems.location(word.element), word.attribute
    source, start = place.source.element(place.tag)
    if attribute is None:
        edits = renamed_tag(source, start, word.tag)
    elif attribute in word.attributes:
        edits = _edits_of_value(word, attribute, problems)
    else:
        new = next(name for name in word.attributes if name not in word.element.attrib)
        edits = renamed_attribute(source, start, attribute, new)
    yield from filter(None, [edits])


def _edits_of_value(word: Word, attribute: str, problems: Problems) -> Edits:
    element, value = word.element, word.attributes[attribute]
    written, place = element.get(attribute), problems.location(element)
    if problems.rewrites is not None and written is not None:
        ways = problems.rewrites(place.tag, attribute, (written, escaped(value)))
        edits = next(iter(ways), ())
        return tuple(edit for edit in dict.fromkeys(edits) if edit.old != edit.new)
    if PARTS.get(attribute):  # numbers
        value = merged(written or "", value)
    source, start = place.source.element(place.tag)
    if problems.is_broken:
        from grader.ros.xml.repair import rewritten_tag  # late: few texts are broken

        given = {str(name): str(text) for name, text in element.attrib.items()}
        rewritten = rewritten_tag(source, start, str(element.tag), {**given, attribute: value})
        if rewritten is not None:
            return rewritten
    edit = with_attribute(source, start, attribute, escaped(value))
    return (edit,) if edit.old != edit.new else ()


def _rewrite_element(element: Element, tag: str, attributes: dict[str, str]) -> None:
    element.tag = tag
    element.attrib.clear()
    for name, value in attributes.items():
        element.set(name, value)


def _word_with_value(element: Element, attribute: str, value: str, what: str) -> Word:
    given: dict[str, str] = dict(element.attrib)  # type: ignore[arg-type]
    sentence = f"{what} {quoted(given[attribute])} is read as {quoted(value)}"
    return Word(element, attribute, str(element.tag), {**given, attribute: value}, sentence)


def _misspelt_references(root: Element, robot: Robot) -> Iterator[Word]:
    """Yield links that joints name and that do not exist, and joint types.

    Each is near one that can be meant.
    """
    links = [link.name for link in robot.links]
    uses = Counter(name for joint in robot.joints for name in (joint.parent, joint.child))
    unknown = [name for name in uses if name and not robot.has_link(name)]
    if len(unknown) > _MAX_WORDS:
        return
    defined = _misspelt_definitions(robot, links, uses, unknown)
    yield from _misspelt_links(root, defined)
    misspelt = set(unknown).difference(defined.values())
    if sum(uses[name] for name in misspelt) > _MAX_ROUNDS * _MAX_WORDS:
        misspelt = set()
    children = {joint.child for joint in robot.joints}
    for joint in root.iterchildren("joint"):
        yield from _misspelt_type(joint)
        yield from _misspelt_ends(joint, misspelt, links, children)


def _misspelt_links(root: Element, defined: Mapping[str, str]) -> Iterator[Word]:
    """Yield the links whose definitions have the wrong word."""
    for element in root.iterchildren("link"):
        meant = defined.get(element.get("name") or "")
        if meant is not None:
            yield _word_with_value(element, "name", meant, "the link")


def _misspelt_type(joint: Element) -> Iterator[Word]:
    """Yield the type of a joint if it is near one that there is."""
    written = joint.get("type")
    if written not in JOINT_TYPES:
        kind = near(written or "", JOINT_TYPES)
        if kind is not None:
            yield _word_with_value(joint, "type", kind, "the joint type")


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
) -> Iterator[Word]:
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
            yield _word_with_value(end, "link", meant, "the link")


def _readable_numbers(root: Element) -> Iterator[Word]:
    """Yield numbers of joints that ROS 2 cannot read although they are clear.

    Without them it rejects the file.
    """
    for joint in root.iterchildren("joint"):
        for element in joint:
            tag = str(element.tag)
            given = {str(name): str(value) for name, value in element.attrib.items()}
            for name in given if tag in ATTRIBUTES else ():
                changed = _with_numbers(tag, name, given)
                if changed is not None:
                    sentence = f"{name} is read as {quoted(changed[name])}"
                    yield Word(element, name, tag, changed, sentence)


def _with_numbers(tag: str, name: str, given: dict[str, str]) -> dict[str, str] | None:
    """Return the attributes of an element, one of them with the numbers that are meant.

    Returns None where it can be read, or may be several.
    """
    count = len(PARTS.get(name, ()))
    if not count or name not in ATTRIBUTES[tag]:
        return None
    pose = readable_numbers(given[name], count) if count > 1 else None
    if pose is not None and len(pose) > count and name == "xyz" and "rpy" not in given:
        return {**given, name: " ".join(pose[:count]), "rpy": " ".join(pose[count:])}
    meant = meant_value(given[name], name)
    if meant is None:
        return None
    return {**given, name: meant}


def _exchanged_ends(root: Element, robot: Robot) -> Iterator[Word]:
    """Yield the parent and child of the one joint that are exchanged.

    Because of it one link has two parents.
    """
    root_with = _roots_with_exchanged_ends(robot)
    usual = [index for index, name in root_with.items() if _ROOT.match(name)]
    only = usual if len(root_with) > 1 else [*root_with]
    elements = [*root.iterchildren("joint")]
    if len(only) != 1 or len(elements) != len(robot.joints):
        return
    joint, element = robot.joints[only[0]], elements[only[0]]
    for role, link in (("parent", joint.child), ("child", joint.parent)):
        end = element.find(role)
        if end is not None and end.get("link"):
            yield _word_with_value(end, "link", link, f"the {role}")


def _roots_with_exchanged_ends(robot: Robot) -> dict[int, str]:
    """Return the only root of the robot if the ends of a joint are exchanged, by joint number.

    The joints are those above the one link that has several parents.
    """
    counts = Counter(joint.child for joint in robot.joints)
    doubled = [child for child, count in counts.items() if count > 1]
    if len(doubled) != 1 or counts[doubled[0]] > _MAX_ROUNDS:
        return {}
    root_with: dict[int, str] = {}
    for index, joint in enumerate(robot.joints):
        if joint.child == doubled[0] and joint.parent not in counts:
            others = {*counts, joint.parent}
            roots = [link.name for link in robot.links if link.name not in others]
            if len(roots) == 1:
                root_with[index] = roots[0]
    return root_with


def _pasted_children(root: Element, robot: Robot) -> Iterator[Word]:
    """Yield the child that a second joint has by mistake.

    The one link that no joint names should be there.
    """
    counts = Counter(joint.child for joint in robot.joints)
    named = {*counts, *(joint.parent for joint in robot.joints)}
    lonely = [link.name for link in robot.links if link.name not in named]
    doubled = [child for child, count in counts.items() if count == 2]
    if len(lonely) == len(doubled) == 1:
        for end in _end_for_link(root, doubled[0], lonely[0]):
            yield _word_with_value(end, "link", lonely[0], "the child")


def _end_for_link(root: Element, doubled: str, lonely: str) -> Sequence[Element]:
    """Return the one end of a joint that names a child twice, and should name the lonely link.

    It is that of the joint that is named after the lonely link, else the later one.
    """
    ends = []
    named_after = []
    for joint in root.iterchildren("joint"):
        end = joint.find("child")
        if end is not None and end.get("link") == doubled:
            ends.append(end)
            if lonely in (joint.get("name") or ""):
                named_after.append(end)
    return named_after if len(named_after) == 1 else ends[-1:]


def _repeated_names(root: Element) -> Iterator[Word]:
    """Yield a name that is given twice, where one other name is used and not given.

    The later one should have it.
    """
    ends = [end for end in root.iterfind("joint/*") if end.tag in ("parent", "child")]
    used_links = dict.fromkeys(end.get("link") for end in ends)
    used_joints = dict.fromkeys(mimic.get("joint") for mimic in root.iterfind("joint/mimic"))
    yield from _find_repeated(root, "link", used_links)
    yield from _find_repeated(root, "joint", used_joints)


def _find_repeated(root: Element, tag: str, used: Iterable[str | None]) -> Iterator[Word]:
    by_name: dict[str | None, list[Element]] = {}
    for element in root.iterchildren(tag):
        by_name.setdefault(element.get("name"), []).append(element)
    repeated = [named for name, named in by_name.items() if name is not None and len(named) > 1]
    missing = [name for name in used if name and name not in by_name]
    if len(repeated) == len(missing) == 1 and len(repeated[0]) == 2:
        yield _word_with_value(repeated[0][-1], "name", missing[0], f"the second {tag}")
    elif tag == "joint" and not missing:
        for joints in repeated:
            yield from _copied_joint(joints, by_name)


def _copied_joint(joints: Sequence[Element], known: Collection[str | None]) -> Iterator[Word]:
    """Yield the joint that was copied with its name, which has the child of the first one in it."""
    children = []
    for joint in joints:
        end = joint.find("child")
        children.append(end.get("link") or "" if end is not None else "")
    name = joints[0].get("name") or ""
    if len(joints) == 2 and children[0] and children[1] and name.count(children[0]) == 1:
        meant = name.replace(children[0], children[1])
        if meant not in known and children[1] not in name:
            yield _word_with_value(joints[1], "name", meant, "the second joint")


def _misspelt_format(root: Element) -> Iterator[Word]:
    """Yield tags and attributes that the format does not have there.

    Each is near one that the format needs and that is absent.
    """
    yield from _misspelt_tags(root, ("link", "joint"))
    yield from _misspelt_attributes(root)
    for element in (declared for tag in ("link", "joint") for declared in root.iterchildren(tag)):
        yield from _misspelt_attributes(element)
        if element.tag == "joint":
            needed = ["parent", "child"]
            if element.get("type") in ("revolute", "prismatic"):
                needed.append("limit")
            yield from _misspelt_tags(element, [tag for tag in needed if element.find(tag) is None])
            for child in element:
                if child.tag in _OF_JOINT:
                    yield from _misspelt_attributes(child)


def _misspelt_tags(parent: Element, needed: Collection[str]) -> Iterator[Word]:
    present = {str(child.tag) for child in parent}
    for child in parent:
        tag = str(child.tag)
        meant = meant_tag(tag, str(parent.tag), present)
        if meant in needed and len(child.attrib) <= _MAX_ATTRIBUTES:
            yield Word(child, None, meant, dict(child.attrib), f"<{tag}> is read as <{meant}>")  # type: ignore[arg-type]


def _misspelt_attributes(element: Element) -> Iterator[Word]:
    tag = str(element.tag)
    absent = [name for name in REQUIRED[tag] if element.get(name) is None]
    if not absent or len(element.attrib) > _MAX_ATTRIBUTES:
        return
    given = {str(name): str(value) for name, value in element.attrib.items()}
    for name in given:
        meant = meant_attribute(name, tag, given)
        if meant in absent:
            renamed = {meant if key == name else key: value for key, value in given.items()}
            yield Word(
                element, name, tag, renamed, f"the attribute {name} of <{tag}> is read as {meant}"
            )
