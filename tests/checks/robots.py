"""Small robots as text: builders for the parts of a URDF, and the robot that ROS 2 reads from them."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, radians

from grader.lab.submission.opening import read_submission
from grader.lab.submission.submission import Submission
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import Reading, read_urdf

PATH = "urdf/robot.urdf"

Numbers = str | Sequence[float]

_JOINT = re.compile(r"<joint .*?</joint>\n", re.DOTALL)
_SHAPE = re.compile(r"<(box|cylinder|sphere|mesh) [^>]*>")
_LINK = re.compile(r'<link name="([^"]*)"')


@dataclass(frozen=True, slots=True)
class Scene:
    """The text of a URDF, each element on a line of its own, and the robot that ROS 2 reads from it."""

    text: str

    @property
    def reading(self) -> Reading:
        """Return the file as ROS 2 reads it."""
        return read_urdf(self.text.encode(), PATH)

    @property
    def robot(self) -> Configuration:
        """Return the robot in the file with all joints at 0."""
        found = self.reading.robot
        assert found is not None, self.text
        return Configuration(found, is_guarded=True)

    @property
    def submission(self) -> Submission:
        """Return the submission of the file alone."""
        return read_submission(self.text.encode(), identity="test", path=PATH)

    @property
    def links(self) -> tuple[str, ...]:
        """Return the names of the links in file order."""
        return tuple(_LINK.findall(self.text))

    def without_joints(self) -> "Scene":
        """Return the same links without any joints."""
        return Scene(_JOINT.sub("", self.text))

    def with_shape(self, shape: str) -> "Scene":
        """Return the same robot with every shape replaced by this one."""
        return Scene(_SHAPE.sub(shape, self.text))


def scene(*parts: str) -> Scene:
    """Return a scene of links, joints and materials."""
    return Scene("\n".join(('<robot name="test">', *parts, "</robot>", "")))


def link(name: str, *children: str) -> str:
    """Return a link with its inertial, visuals and collisions."""
    if not children:
        return f'<link name="{name}"/>'
    return "\n".join((f'<link name="{name}">', *children, "</link>"))


def visual(shape: str, *, xyz: Numbers = "", rpy: Numbers = "", material: str = "") -> str:
    """Return a visual; origin and material are omitted by default."""
    inside = (_origin(xyz, rpy), f"<geometry>\n{shape}\n</geometry>", material)
    return "\n".join(("<visual>", *filter(None, inside), "</visual>"))


def collision(shape: str, *, xyz: Numbers = "", rpy: Numbers = "") -> str:
    """Return a collision; the origin is omitted by default."""
    inside = (_origin(xyz, rpy), f"<geometry>\n{shape}\n</geometry>")
    return "\n".join(("<collision>", *filter(None, inside), "</collision>"))


def inertial(mass: float, inertia: Sequence[float], *, xyz: Numbers = "", rpy: Numbers = "") -> str:
    """Return an inertial with ixx, ixy, ixz, iyy, iyz, izz."""
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    given = " ".join(f'{name}="{value!r}"' for name, value in zip(names, inertia, strict=True))
    inside = (_origin(xyz, rpy), f'<mass value="{mass!r}"/>', f"<inertia {given}/>")
    return "\n".join(("<inertial>", *filter(None, inside), "</inertial>"))


def box(x: float, y: float, z: float) -> str:
    """Return a box with these edges in metres."""
    return f'<box size="{numbers((x, y, z))}"/>'


def cylinder(radius: float = 0.1, length: float = 0.05) -> str:
    """Return a cylinder in metres; default: the lab's wheel."""
    return f'<cylinder radius="{radius!r}" length="{length!r}"/>'


def sphere(radius: float) -> str:
    """Return a sphere in metres."""
    return f'<sphere radius="{radius!r}"/>'


def paint(rgba: Numbers, name: str = "paint") -> str:
    """Return a material with a colour, for use below <robot> or in a visual."""
    return f'<material name="{name}">\n<color rgba="{numbers(rgba)}"/>\n</material>'


def joint(
    name: str,
    kind: str,
    parent: str,
    child: str,
    *,
    xyz: Numbers = "",
    rpy: Numbers = "",
    axis: Numbers = "",
) -> str:
    """Return a joint; revolute and prismatic joints have a limit, so that ROS 2 accepts them."""
    inside = (
        f'<parent link="{parent}"/>',
        f'<child link="{child}"/>',
        _origin(xyz, rpy),
        f'<axis xyz="{numbers(axis)}"/>' if axis else "",
        '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
        if kind in ("revolute", "prismatic")
        else "",
    )
    return "\n".join((f'<joint name="{name}" type="{kind}">', *filter(None, inside), "</joint>"))


def turned(*, roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> str:
    """Return the rpy of an origin for angles in degrees."""
    return numbers((radians(roll), radians(pitch), radians(yaw)))


def numbers(values: Numbers) -> str:
    """Return numbers as a URDF writes them, with all their digits; text is returned unchanged."""
    return values if isinstance(values, str) else " ".join(map(repr, values))


def _origin(xyz: Numbers, rpy: Numbers) -> str:
    given = _attribute("xyz", xyz) + _attribute("rpy", rpy)
    return f"<origin{given}/>" if given else ""


def _attribute(name: str, value: Numbers) -> str:
    return f' {name}="{numbers(value)}"' if value else ""


BASE = link(
    "base", visual(box(0.6, 0.4, 0.2), xyz=(0.0, 0.0, 0.1), material=paint("0 0.6 0 1", "green"))
)
LIDAR = link("lidar", visual(cylinder()))
WHEEL = link("wheel", visual(cylinder()))
CASTER = link("caster", visual(sphere(0.05)))


def rolling(*, rpy: Numbers = (-pi / 2, 0.0, 0.0), wheel: str = WHEEL) -> Scene:
    """Return a base with one wheel on its left side, which drives it forward by default."""
    held = joint(
        "wheel_joint", "continuous", "base", "wheel", xyz=(-0.15, 0.225, 0.0), rpy=rpy, axis="0 0 1"
    )
    return scene(BASE, wheel, held)


def swinging(*, xyz: Numbers, rpy: Numbers, axis: Numbers) -> Scene:
    """Return a base with an arm on a joint, and a tip that is fixed to the arm by a frame turned about x."""
    return scene(
        link("base"),
        link("arm"),
        link("tip"),
        joint("shoulder", "revolute", "base", "arm", xyz=xyz, rpy=rpy, axis=axis),
        joint("tip_joint", "fixed", "arm", "tip", xyz="0.3 0 0", rpy=turned(roll=90)),
    )


# The robot of the reference solution, for checks that compare with it: an arm that swings, and a wheel at its end.
ARM = scene(
    link("base"),
    link("arm"),
    link("wheel", visual(cylinder())),
    joint("shoulder", "revolute", "base", "arm", xyz=(0.0, 0.0, 0.2), axis="0 1 0"),
    joint("spin", "continuous", "arm", "wheel", xyz=(0.5, 0.0, 0.0), axis="0 0 1"),
)
