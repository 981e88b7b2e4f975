"""The format of a URDF: the elements that urdfdom reads.

Each has its attributes, and the elements that may be in it.
"""

from collections.abc import Mapping
from math import isfinite
from typing import Literal, get_args

from grader.base.grouping import Strings
from grader.base.records import Named

JointType = Literal["fixed", "continuous", "revolute", "prismatic", "floating", "planar"]
JOINT_TYPES: Strings = get_args(JointType)


class _AttributeFormat(Named):
    """The format of an attribute.

    It is the unit and the parts of its numbers (no parts: text), and what ROS 2 uses where it is
    not given.

    An attribute without a default is required.
    """

    unit: str = ""
    parts: Strings = ()
    default: str | None = None


class _TagFormat(Named):
    """The format of an element.

    It is its attributes in usual order, children (also needed, repeated ones), wrong names of
    attributes.
    """

    attributes: Mapping[str, _AttributeFormat] = {}
    children: Strings = ()
    # Of geometry one is needed, and of a joint that is revolute or prismatic also limit.
    needed: Strings = ()
    repeated: Strings = ()
    aliases: Mapping[str, str] = {}


_REQUIRED = _AttributeFormat()
_OPTIONAL = _AttributeFormat(default="")
_XYZ = ("x", "y", "z")
_ONE = ("",)
_LINK = _TagFormat({"link": _REQUIRED}, aliases={"name": "link", "joint": "link"})
_POSITIVE = _AttributeFormat("kg m2", _ONE)
_MIXED = _AttributeFormat("kg m2", _ONE)
_END = _AttributeFormat("rad or m", _ONE, "0")
_SHAPES = ("box", "cylinder", "sphere", "mesh")

TAGS: dict[str, _TagFormat] = {
    "robot": _TagFormat(
        {"name": _REQUIRED, "version": _AttributeFormat(default="1.0")},
        ("link", "joint", "material"),
        needed=("link",),
        repeated=("link", "joint", "material"),
    ),
    "link": _TagFormat(
        {"name": _REQUIRED}, ("inertial", "visual", "collision"), repeated=("visual", "collision")
    ),
    "joint": _TagFormat(
        {"name": _REQUIRED, "type": _REQUIRED},
        (
            "origin",
            "parent",
            "child",
            "axis",
            "limit",
            "dynamics",
            "mimic",
            "safety_controller",
            "calibration",
        ),
        ("parent", "child"),
    ),
    "material": _TagFormat({"name": _REQUIRED}, ("color", "texture")),
    "visual": _TagFormat({"name": _OPTIONAL}, ("origin", "geometry", "material"), ("geometry",)),
    "collision": _TagFormat({"name": _OPTIONAL}, ("origin", "geometry"), ("geometry",)),
    "inertial": _TagFormat({}, ("origin", "mass", "inertia"), ("mass", "inertia")),
    "geometry": _TagFormat({}, _SHAPES),
    "parent": _LINK,
    "child": _LINK,
    "origin": _TagFormat(
        {
            "xyz": _AttributeFormat("m", _XYZ, "0 0 0"),
            "rpy": _AttributeFormat("rad", ("roll", "pitch", "yaw"), "0 0 0"),
            "quat_xyzw": _AttributeFormat("1", ("x", "y", "z", "w"), ""),  # from version 1.1 on
        },
        aliases={"pos": "xyz"},
    ),
    "box": _TagFormat({"size": _AttributeFormat("m", _XYZ)}),
    "cylinder": _TagFormat(
        {"radius": _AttributeFormat("m", _ONE), "length": _AttributeFormat("m", _ONE)},
        aliases={"height": "length"},
    ),
    "capsule": _TagFormat(  # from version 1.1 on
        {"radius": _AttributeFormat("m", _ONE), "length": _AttributeFormat("m", _ONE)},
        aliases={"height": "length"},
    ),
    "sphere": _TagFormat({"radius": _AttributeFormat("m", _ONE)}),
    "mesh": _TagFormat({"filename": _REQUIRED, "scale": _AttributeFormat("1", _XYZ, "1 1 1")}),
    "color": _TagFormat(
        {"rgba": _AttributeFormat("1", ("red", "green", "blue", "alpha"))}, aliases={"rgb": "rgba"}
    ),
    "texture": _TagFormat({"filename": _REQUIRED}),
    "mass": _TagFormat({"value": _AttributeFormat("kg", _ONE)}),
    "inertia": _TagFormat(
        {
            "ixx": _POSITIVE,
            "ixy": _MIXED,
            "ixz": _MIXED,
            "iyy": _POSITIVE,
            "iyz": _MIXED,
            "izz": _POSITIVE,
        }
    ),
    # a joint without <axis> has 1 0 0
    "axis": _TagFormat({"xyz": _AttributeFormat("1", _XYZ, "0 0 0")}),
    "limit": _TagFormat(
        {
            "lower": _END,
            "upper": _END,
            "effort": _AttributeFormat("N m or N", _ONE),
            "velocity": _AttributeFormat("rad/s or m/s", _ONE),
            # from version 1.2 on
            "acceleration": _AttributeFormat("rad/s^2 or m/s^2", _ONE, ""),
            "deceleration": _AttributeFormat("rad/s^2 or m/s^2", _ONE, ""),
            "jerk": _AttributeFormat("rad/s^3 or m/s^3", _ONE, ""),
        }
    ),
    "dynamics": _TagFormat(
        {
            "damping": _AttributeFormat("N m s/rad or N s/m", _ONE, "0"),
            "friction": _AttributeFormat("N m or N", _ONE, "0"),
        }
    ),
    "mimic": _TagFormat(
        {"joint": _REQUIRED, "multiplier": _AttributeFormat("1", _ONE, "1"), "offset": _END}
    ),
    "safety_controller": _TagFormat(
        {
            "soft_lower_limit": _END,
            "soft_upper_limit": _END,
            "k_position": _AttributeFormat("1", _ONE, "0"),
            "k_velocity": _AttributeFormat("1", _ONE),
        }
    ),
    "calibration": _TagFormat(
        {
            "rising": _AttributeFormat("rad or m", _ONE, ""),
            "falling": _AttributeFormat("rad or m", _ONE, ""),
        }
    ),
}

# Elements of SDF and of other tools, which no element below <robot> has: what to do instead.
ELSEWHERE = {
    "xyz": "write its numbers as an attribute of <origin>",
    "rpy": "write its numbers as an attribute of <origin>",
    "pose": "that is SDF; a URDF has <origin>",
    "gazebo": "put it directly under <robot>",
    "ros2_control": "put it directly under <robot>",
    "transmission": "put it directly under <robot>",
}

# Views of the table.
ATTRIBUTES = {name: frozenset(tag.attributes) for name, tag in TAGS.items()}
CHILDREN = {name: tag.children for name, tag in TAGS.items() if tag.children}
REQUIRED: dict[str, Strings] = {}
OWNERS: dict[str, list[str]] = {}
for _name, _tag in TAGS.items():
    _required = [key for key, attribute in _tag.attributes.items() if attribute.default is None]
    REQUIRED[_name] = tuple(_required)
    for _key in _tag.attributes:
        OWNERS.setdefault(_key, []).append(_name)
# The parts of the numbers in an attribute of this name; texts have none.
PARTS = {key: one.parts for tag in TAGS.values() for key, one in tag.attributes.items()}


def numbers_in(text: str) -> list[float]:
    """Return the numbers that a text consists of; nothing for any other text."""
    try:
        values = [float(piece) for piece in text.split()]
    except ValueError:
        return []
    return (
        values if "_" not in text and all(map(isfinite, values)) else []
    )  # Python reads 1_000 as a number
