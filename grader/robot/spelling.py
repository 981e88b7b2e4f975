"""Unknown names that look like misspelt ones, which ROS 2 silently ignores, and repeated elements."""

from collections.abc import Callable, Iterable, Iterator

from grader.names import closest
from grader.robot import catalogue
from grader.robot.diagnostics import Problems
from grader.text import quoted
from grader.xml.parsing import Element

# What urdfdom reads: the attributes of each element, and the elements that may be in it.
_ATTRIBUTES: dict[str, set[str] | frozenset[str]] = {
    "robot": {"name", "version"},
    **dict.fromkeys(("link", "material", "visual", "collision"), frozenset({"name"})),
    "joint": {"name", "type"},
    **dict.fromkeys(("inertial", "geometry"), frozenset[str]()),
    **dict.fromkeys(("parent", "child"), frozenset({"link"})),
    "origin": {"xyz", "rpy"},
    "box": {"size"},
    "cylinder": {"radius", "length"},
    "sphere": {"radius"},
    "mesh": {"filename", "scale"},
    "color": {"rgba"},
    "texture": {"filename"},
    "mass": {"value"},
    "inertia": {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"},
    "axis": {"xyz"},
    "limit": {"lower", "upper", "effort", "velocity"},
    "dynamics": {"damping", "friction"},
    "mimic": {"joint", "multiplier", "offset"},
    "safety_controller": {"soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity"},
    "calibration": {"rising", "falling"},
}
_CHILDREN: dict[str, tuple[str, ...]] = {
    "robot": ("link", "joint", "material"),
    "link": ("inertial", "visual", "collision"),
    "visual": ("origin", "geometry", "material"),
    "collision": ("origin", "geometry"),
    "inertial": ("origin", "mass", "inertia"),
    "geometry": ("box", "cylinder", "sphere", "mesh"),
    "material": ("color", "texture"),
    "joint": ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "safety_controller", "calibration"),
}
# Correct names that urdfdom does not read: they are not misspellings.
_EXTENSIONS = frozenset(
    {"gazebo", "transmission", "hardwareInterface", "ros2_control", "sensor", "plugin"}
    | {"drake", "mujoco", "capsule", "verbose"}
)
_SINGLE = frozenset(
    {"origin", "geometry", "parent", "child", "axis", "limit", "inertial", "mass", "inertia", "mimic", "dynamics"}
)
_SWAPPED = {("cylinder", "height"): "length", ("color", "rgb"): "rgba", ("origin", "pos"): "xyz"}


Closest = Callable[[str, Iterable[str]], str | None]


def check_spelling(root: Element, problems: Problems) -> None:
    """Report misspelt names and repeated elements in what urdfdom reads; extensions of other tools are skipped."""
    if not _ATTRIBUTES["robot"].issuperset(root.keys()):
        _check_attributes(root, problems)
    waiting = [root]
    while waiting:
        element = waiting.pop()
        allowed = _CHILDREN[element.tag]
        tags = []
        for child in element:
            tag = child.tag
            tags.append(tag)
            if tag in allowed:
                if not _ATTRIBUTES[tag].issuperset(child.keys()):
                    _check_attributes(child, problems)
                if tag in _CHILDREN and len(child):
                    waiting.append(child)
            elif tag not in _EXTENSIONS:
                _check_tag(child, element.tag, allowed, problems)
        if element is not root and len(tags) > 1 and (len(set(tags)) < len(tags) or element.tag == "geometry"):
            _check_repeated(element, tags, problems)


def _check_attributes(element: Element, problems: Problems) -> None:
    for name, meant in misspelt_attributes(element, problems.closest):
        message = f"ROS 2 ignores the unknown attribute {quoted(name)} of <{element.tag}>"
        problems.add(catalogue.MISSPELT, f"{message}; did you mean {quoted(meant)}?", element, name)


def misspelt_attributes(element: Element, closest: Closest = closest) -> Iterator[tuple[str, str]]:
    """Yield the attributes of an element that urdfdom does not read, each with the one that is probably meant."""
    known, given = _ATTRIBUTES.get(str(element.tag)), list(map(str, element.keys()))
    missing = known - set(given) if known else frozenset[str]()
    for name in given if missing else ():
        if known is not None and name not in known and not name.startswith("{"):
            meant = _SWAPPED.get((str(element.tag), name)) or closest(name, missing)
            if meant:
                yield name, meant


def meant_tag(element: Element, closest: Closest = closest) -> str | None:
    """Return the tag that an unknown one is probably meant to be."""
    parent = element.getparent()
    allowed = _CHILDREN.get(str(parent.tag), ()) if parent is not None else ()
    tag = str(element.tag)
    return closest(tag, allowed) if allowed and tag not in allowed and tag not in _EXTENSIONS else None


def _check_tag(child: Element, parent: str, allowed: tuple[str, ...], problems: Problems) -> None:
    meant = problems.closest(child.tag, allowed)
    if meant:
        message = f"ROS 2 ignores <{child.tag}> in <{parent}>; did you mean <{meant}>?"
    elif child.tag in _ATTRIBUTES:
        message = f"ROS 2 ignores <{child.tag}> in <{parent}>: it does not belong there"
    else:
        return
    problems.add(catalogue.MISSPELT, message, child)


def _check_repeated(element: Element, tags: list[str], problems: Problems) -> None:
    seen: set[str] = set()
    for child, tag in zip(element, tags, strict=True):
        if element.tag == "geometry" and seen:
            problems.add(catalogue.REPEATED_ELEMENT, "a <geometry> has one shape: ROS 2 reads only the first", child)
        elif tag in seen and (tag in _SINGLE or (element.tag == "visual" and tag == "material")):
            message = f"<{tag}> is repeated in this <{element.tag}>: ROS 2 reads only the first"
            problems.add(catalogue.REPEATED_ELEMENT, message, child)
        seen.add(tag)
