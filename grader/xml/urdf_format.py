"""The format of a URDF: the elements that urdfdom reads, their attributes, and the elements that may be in each."""

from collections.abc import Mapping
from typing import Literal, NamedTuple, get_args

JointType = Literal["fixed", "continuous", "revolute", "prismatic", "floating", "planar"]
JOINT_TYPES: tuple[str, ...] = get_args(JointType)


class Attribute(NamedTuple):
    """An attribute: the unit and the parts of its numbers (no parts: text), and what ROS 2 uses where it is not given.

    An attribute without a default is required; `usual` is what a person would write, where nothing else is known.
    """

    unit: str = ""
    parts: tuple[str, ...] = ()
    default: str | None = None
    usual: str = ""


class Tag(NamedTuple):
    """An element: its attributes in their usual order, its children (which are needed, which may repeat), wrong names of attributes."""

    attributes: Mapping[str, Attribute] = {}
    children: tuple[str, ...] = ()
    needed: tuple[str, ...] = ()  # of geometry one is needed, and of a joint that is revolute or prismatic also limit
    repeated: tuple[str, ...] = ()
    aliases: Mapping[str, str] = {}


_REQUIRED, _OPTIONAL = Attribute(), Attribute(default="")
_XYZ, _ONE = ("x", "y", "z"), ("",)
_LINK = Tag({"link": _REQUIRED}, aliases={"name": "link", "joint": "link"})
_POSITIVE, _MIXED = Attribute("kg m2", _ONE, usual="0.001"), Attribute("kg m2", _ONE, usual="0")
_END = Attribute("rad or m", _ONE, "0")
_SHAPES = ("box", "cylinder", "sphere", "mesh")

TAGS: dict[str, Tag] = {
    "robot": Tag({"name": _REQUIRED, "version": Attribute(default="1.0")}, ("link", "joint", "material"), ("link",), ("link", "joint", "material")),
    "link": Tag({"name": _REQUIRED}, ("inertial", "visual", "collision"), repeated=("visual", "collision")),
    "joint": Tag(
        {"name": _REQUIRED, "type": _REQUIRED},
        ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "safety_controller", "calibration"),
        ("parent", "child"),
    ),
    "material": Tag({"name": _REQUIRED}, ("color", "texture")),
    "visual": Tag({"name": _OPTIONAL}, ("origin", "geometry", "material"), ("geometry",)),
    "collision": Tag({"name": _OPTIONAL}, ("origin", "geometry"), ("geometry",)),
    "inertial": Tag({}, ("origin", "mass", "inertia"), ("mass", "inertia")),
    "geometry": Tag({}, _SHAPES),
    "parent": _LINK,
    "child": _LINK,
    "origin": Tag(
        {"xyz": Attribute("m", _XYZ, "0 0 0"), "rpy": Attribute("rad", ("roll", "pitch", "yaw"), "0 0 0")},
        aliases={"pos": "xyz"},
    ),
    "box": Tag({"size": Attribute("m", _XYZ)}),
    "cylinder": Tag({"radius": Attribute("m", _ONE), "length": Attribute("m", _ONE)}, aliases={"height": "length"}),
    "sphere": Tag({"radius": Attribute("m", _ONE)}),
    "mesh": Tag({"filename": _REQUIRED, "scale": Attribute("1", _XYZ, "1 1 1")}),
    "color": Tag({"rgba": Attribute("1", ("red", "green", "blue", "alpha"))}, aliases={"rgb": "rgba"}),
    "texture": Tag({"filename": _REQUIRED}),
    "mass": Tag({"value": Attribute("kg", _ONE, usual="1")}),
    "inertia": Tag(
        {"ixx": _POSITIVE, "ixy": _MIXED, "ixz": _MIXED, "iyy": _POSITIVE, "iyz": _MIXED, "izz": _POSITIVE}
    ),
    "axis": Tag({"xyz": Attribute("1", _XYZ, "0 0 0", "0 0 1")}),  # a joint without <axis> has 1 0 0
    "limit": Tag(
        {
            "lower": _END._replace(usual="-1.57"),
            "upper": _END._replace(usual="1.57"),
            "effort": Attribute("N m or N", _ONE, usual="10"),
            "velocity": Attribute("rad/s or m/s", _ONE, usual="1"),
        }
    ),
    "dynamics": Tag({"damping": Attribute("N m s/rad or N s/m", _ONE, "0"), "friction": Attribute("N m or N", _ONE, "0")}),
    "mimic": Tag({"joint": _REQUIRED, "multiplier": Attribute("1", _ONE, "1"), "offset": _END}),
    "safety_controller": Tag(
        {
            "soft_lower_limit": _END,
            "soft_upper_limit": _END,
            "k_position": Attribute("1", _ONE, "0"),
            "k_velocity": Attribute("1", _ONE, usual="1"),
        }
    ),
    "calibration": Tag({"rising": Attribute("rad or m", _ONE, ""), "falling": Attribute("rad or m", _ONE, "")}),
}  # fmt: skip

# Views of the table.
ATTRIBUTES = {name: frozenset(tag.attributes) for name, tag in TAGS.items()}
CHILDREN = {name: tag.children for name, tag in TAGS.items() if tag.children}
REQUIRED = {
    name: tuple(key for key, one in tag.attributes.items() if one.default is None) for name, tag in TAGS.items()
}
# The parts of the numbers in an attribute of this name; texts have none.
PARTS = {key: one.parts for tag in TAGS.values() for key, one in tag.attributes.items()}


def missing_element(name: str) -> str | None:
    """Return an element with usual values for its attributes; None where only the author knows a value."""
    values = {key: one.usual or one.default for key, one in TAGS[name].attributes.items()}
    given = "".join(f' {key}="{value}"' for key, value in values.items())
    return f"<{name}{given}/>" if values and all(values.values()) else None
