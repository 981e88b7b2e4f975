"""Unknown names that look like misspelt ones, which ROS 2 silently ignores, and repeated elements."""

from grader.robot import catalogue
from grader.robot.diagnostics import Problems
from grader.text import quoted
from grader.xml.parsing import Element
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN, TAGS

# Correct names that urdfdom does not read: they are not misspellings.
_EXTENSIONS = frozenset(
    {"gazebo", "transmission", "hardwareInterface", "ros2_control", "sensor", "plugin"}
    | {"drake", "mujoco", "capsule", "verbose"}
)


def check_spelling(root: Element, problems: Problems) -> None:
    """Report misspelt names and repeated elements in what urdfdom reads; extensions of other tools are skipped."""
    if not ATTRIBUTES["robot"].issuperset(root.keys()):
        _check_attributes(root, problems)
    waiting = [root]
    while waiting:
        element = waiting.pop()
        allowed = CHILDREN[element.tag]
        tags = []
        for child in element:
            tag = child.tag
            tags.append(tag)
            if tag in allowed:
                if not ATTRIBUTES[tag].issuperset(child.keys()):
                    _check_attributes(child, problems)
                if tag in CHILDREN and len(child):
                    waiting.append(child)
            elif tag not in _EXTENSIONS:
                _check_tag(child, element.tag, allowed, problems)
        if element is not root and len(tags) > 1 and (len(set(tags)) < len(tags) or element.tag == "geometry"):
            _check_repeated(element, tags, problems)


def _check_attributes(element: Element, problems: Problems) -> None:
    known, given = ATTRIBUTES[element.tag], list(map(str, element.keys()))
    missing = known - set(given)
    for name in given:
        if name in known or name.startswith("{"):
            continue
        meant = TAGS[element.tag].aliases.get(name) or problems.closest(name, missing)
        if meant:
            message = f"ROS 2 ignores the unknown attribute {quoted(name)} of <{element.tag}>"
            problems.add(catalogue.MISSPELT, f"{message}; did you mean {quoted(meant)}?", element, name)


def _check_tag(child: Element, parent: str, allowed: tuple[str, ...], problems: Problems) -> None:
    if child.tag.startswith("{"):  # a prefix is not a misspelling
        return
    meant = problems.closest(child.tag, allowed)
    if meant:
        message = f"ROS 2 ignores <{child.tag}> in <{parent}>; did you mean <{meant}>?"
    elif child.tag in ATTRIBUTES:
        message = f"ROS 2 ignores <{child.tag}> in <{parent}>: it does not belong there"
    else:
        return
    problems.add(catalogue.MISSPELT, message, child)


def _check_repeated(element: Element, tags: list[str], problems: Problems) -> None:
    seen: set[str] = set()
    for child, tag in zip(element, tags, strict=True):
        if element.tag == "geometry" and seen:
            problems.add(catalogue.REPEATED_ELEMENT, "a <geometry> has one shape: ROS 2 reads only the first", child)
        elif tag in seen and tag in TAGS[element.tag].children and tag not in TAGS[element.tag].repeated:
            message = f"<{tag}> is repeated in this <{element.tag}>: ROS 2 reads only the first"
            problems.add(catalogue.REPEATED_ELEMENT, message, child)
        seen.add(tag)
