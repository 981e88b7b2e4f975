"""A robot in MuJoCo: it is set down, comes to rest, and drives with all wheels turning at one rate.

MuJoCo gets the shapes, the masses and the tree of joints, and shares no code with what it is compared with. What has no wheel
slides, as casters do: its contacts have no friction.
"""

from collections.abc import Iterable, Sequence
from math import acos, atan2, cos, degrees, pi, sin
from typing import Any, NamedTuple

import pytest

from grader.base.transforms import Transform
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Box, Cylinder, Joint, Link, Mesh, Sphere
from grader.ros.urdf.rolling import Course, mean
from tests.oracles.example_robots import MISSING

mujoco: Any = pytest.importorskip("mujoco", reason=MISSING)

_STEP = 0.001  # seconds
_SETTLE, _RAMP, _DRIVE = 1.5, 1.0, 2.5  # seconds
_RATE = 2.0  # rad/s
_TURN = 0.3  # rad; the direction of a longer drive says little
_GRIP, _SLIDE = "2 0.005 0.0001", "0.0001 0 0"
_INERTIA = "1e-9 1e-9 1e-9"


class Drive(NamedTuple):
    """Where the base of a robot went until it had turned by a little: metres along its own x and y axis before the drive, the
    angle of its turn, and the angles of its wheels in their order; angles are radians.
    """

    x: float
    y: float
    turn: float
    angles: list[float]


def measure_tilt(robot: Configuration, base: str, wheels: Sequence[str]) -> float:
    """Return by how many degrees the base leans when the robot stands, with its joints as they are."""
    model = mujoco.MjModel.from_xml_string(_document(robot, base, wheels, drives=False))
    data = mujoco.MjData(model)
    for _ in range(round(_SETTLE / _STEP)):
        mujoco.mj_step(model, data)
    return _lean(data.xmat[model.body(base).id].reshape(3, 3))


def measure_drive(robot: Configuration, base: str, wheels: Sequence[str], stiffness: int) -> Drive:
    """Return where a robot drives, on thin wheels: wide ones scrub in turns. The stiffness is that of friction."""
    document = _document(robot, base, wheels, drives=True, stiffness=stiffness)
    model = mujoco.MjModel.from_xml_string(document)
    data = mujoco.MjData(model)
    body = model.body(base).id
    for _ in range(round(_SETTLE / _STEP)):
        mujoco.mj_step(model, data)
    joints = [robot.moving_joint(wheel).name for wheel in wheels]
    start, turned = data.xpos[body].copy(), data.xmat[body].reshape(3, 3).copy()
    before = [float(data.joint(name).qpos[0]) for name in joints]
    for step in range(round(_DRIVE / _STEP)):
        data.ctrl[:] = _RATE * min(1.0, step * _STEP / _RAMP)
        mujoco.mj_step(model, data)
        relative = turned.T @ data.xmat[body].reshape(3, 3)
        if abs(atan2(relative[1, 0], relative[0, 0])) > _TURN:
            break
    moved = turned.T @ (data.xpos[body] - start)
    turn = atan2(relative[1, 0], relative[0, 0])
    angles = [float(data.joint(name).qpos[0]) for name in joints]
    return Drive(
        float(moved[0]),
        float(moved[1]),
        turn,
        [now - then for now, then in zip(angles, before, strict=True)],
    )


def travelled(course: Course) -> tuple[float, float, float]:
    """Return where the base of a robot is after a second of this motion: x, y, and the turn."""
    forward, left, angle = course.forward, course.left, course.turn
    along, across = 1.0, angle / 2.0
    if abs(angle) > 1e-9:
        along, across = sin(angle) / angle, (1.0 - cos(angle)) / angle
    x, y, _ = mean(
        [wheel.contact for wheel in course.wheels]
    )  # this point moves so, and the base turns about it
    moved_x = x - x * cos(angle) + y * sin(angle) + forward * along - left * across
    moved_y = y - x * sin(angle) - y * cos(angle) + forward * across + left * along
    return moved_x, moved_y, angle


def _lean(rotation: Any) -> float:
    return degrees(acos(max(-1.0, min(1.0, float(rotation[2, 2])))))


def _document(
    robot: Configuration, base: str, wheels: Sequence[str], *, drives: bool, stiffness: int = 1
) -> str:
    """Return the robot as MJCF, on a plane, with a motor at each wheel."""
    root = robot.find_root(base)
    turning = [robot.moving_joint(wheel) for wheel in wheels]
    is_weighed = any(link.inertial and link.inertial.mass > 0 for link in robot.robot.links)
    driven = {joint.name for joint in turning}
    bodies = _Bodies(robot, driven, is_weighed=is_weighed, drives=drives)
    lowest = bodies.lowest(root, base)
    T_base_root = robot.pose(root, relative_to=base)
    pose = Transform(
        T_base_root.rotation,
        (
            T_base_root.translation[0],
            T_base_root.translation[1],
            T_base_root.translation[2] - lowest + 1e-4,
        ),
    )
    tree = bodies.body(root, pose, None)
    weight, radius = bodies.weight(), bodies.radius(turning)
    gain = 8.0 * weight * radius * radius
    motors = (
        ""
        if not drives
        else "".join(f'<velocity joint="{name}" kv="{gain}"/>' for name in sorted(driven))
    )
    return f"""<mujoco><compiler balanceinertia="true" boundmass="1e-6" boundinertia="1e-9" angle="radian"/>
<option timestep="{_STEP}" integrator="implicitfast" cone="elliptic" impratio="{stiffness}"/><size memory="16M"/>
<worldbody><geom type="plane" size="50 50 1" contype="2" conaffinity="1"/>{tree}</worldbody>
<actuator>{motors}</actuator></mujoco>"""


class _Bodies:
    """The bodies of MJCF that the links of a robot are."""

    def __init__(
        self, robot: Configuration, driven: set[str], *, is_weighed: bool, drives: bool
    ) -> None:
        self._robot, self._driven, self._is_weighed = robot, driven, is_weighed
        self._drives = drives
        self._children: dict[str, list[Joint]] = {}
        for joint in robot.parent_joints.values():
            self._children.setdefault(joint.parent, []).append(joint)

    def body(self, name: str, pose: Transform, joint: Joint | None, grips: bool = False) -> str:
        """Return a link and all below it; what a driven joint turns has friction."""
        link = self._robot.link(name)
        grips = grips or (joint is not None and joint.name in self._driven)
        inside = "<freejoint/>" if joint is None else ""
        if self._drives and joint is not None and joint.name in self._driven:
            axis = " ".join(map(repr, self._robot.axis(joint)))
            inside += f'<joint name="{joint.name}" type="hinge" axis="{axis}"/>'
        inside += self._inertial(link)
        for element in shapes_of(link):
            inside += self._geometry(element, grips)
        for below in self._children.get(name, []):
            assert below.origin is not None
            inside += self.body(below.child, below.origin.placed_in(), below, grips)
        return f'<body name="{name}" {_place(pose)}>{inside}</body>'

    def _inertial(self, link: Link) -> str:
        given = link.inertial
        if not self._is_weighed:
            if shapes_of(link):
                return ""  # computed from the shapes
            return f'<inertial pos="0 0 0" mass="1e-6" diaginertia="{_INERTIA}"/>'
        if given is None or not given.mass > 0:
            return f'<inertial pos="0 0 0" mass="1e-6" diaginertia="{_INERTIA}"/>'
        # How a robot rests and rolls depends on the masses only; an impossible tensor would be refused.
        size = given.mass * 0.01**2
        place = _place(given.origin.placed_in())
        return f'<inertial {place} mass="{given.mass}" diaginertia="{size} {size} {size}"/>'

    def _geometry(self, element: Any, grips: bool) -> str:
        friction, dimensions = (_GRIP, 3) if grips else (_SLIDE, 1)
        match element.geometry:
            case Box(size=size):
                kind, numbers = "box", [abs(length) / 2 for length in size]
            case Cylinder(radius=radius, length=length):
                kind, numbers = "cylinder", [abs(radius), abs(length) / 2]
            case _:
                kind, numbers = "sphere", [abs(element.geometry.radius)]
        if grips and kind == "cylinder" and self._drives:
            numbers[1] *= 0.02
        shown = " ".join(repr(max(number, 1e-5)) for number in numbers)
        place = _place(element.origin.placed_in())
        return (
            f'<geom type="{kind}" size="{shown}" {place} density="500" friction="{friction}" priority="1" solref="0.004 1" '
            f'condim="{dimensions}" contype="1" conaffinity="2"/>'
        )

    def lowest(self, root: str, base: str) -> float:
        """Return the height of the lowest point of the robot in the frame of its base."""
        heights = []
        for link in self._robot.robot.links:
            if not self._is_in(link.name, root):
                continue
            T_base_link = self._robot.pose(link.name, relative_to=base)
            for element in shapes_of(link):
                heights.append(_bottom(element.geometry, element.origin.placed_in(T_base_link)))
        return min(heights)

    def _is_in(self, name: str, root: str) -> bool:
        chain = self._robot.chain(name)
        return name == root or (bool(chain) and chain[0].parent == root)

    def weight(self) -> float:
        """Return the mass of the robot, kg."""
        total = 0.0
        for link in self._robot.robot.links:
            if self._is_weighed:
                total += link.inertial.mass if link.inertial else 0.0
            else:
                total += sum(500.0 * element.geometry.volume for element in shapes_of(link))
        return total

    def radius(self, turning: Iterable[Joint]) -> float:
        """Return the largest radius of what the joints turn, else 5 cm."""
        radii = [0.05]
        for joint in turning:
            for element in shapes_of(self._robot.link(joint.child)):
                radii.append(abs(getattr(element.geometry, "radius", 0.05)))
        return max(radii)


def shapes_of(link: Link) -> list[Any]:
    """Return the collision shapes of a link, else its visuals, that have a size and are no meshes."""
    for elements in (link.collisions, link.visuals):
        solid = [
            it for it in elements if not isinstance(it.geometry, Mesh) and not it.geometry.is_empty
        ]
        if solid:
            return solid
    return []


def _bottom(geometry: Any, pose: Transform) -> float:
    """Return the lowest z of a shape: the least of many of its points."""
    match geometry:
        case Box(size=(x, y, z)):
            points = [
                (i * x / 2, j * y / 2, k * z / 2) for i in (1, -1) for j in (1, -1) for k in (1, -1)
            ]
        case Cylinder(radius=radius, length=length):
            around = [number * pi / 180.0 for number in range(360)]
            points = [
                (radius * cos(it), radius * sin(it), end * length / 2)
                for it in around
                for end in (1, -1)
            ]
        case Sphere(radius=radius):
            return pose.translation[2] - abs(radius)
    return min(pose.apply(point)[2] for point in points)


def _place(pose: Transform) -> str:
    x, y, z, w = pose.quaternion
    return f'pos="{" ".join(map(repr, pose.translation))}" quat="{w!r} {x!r} {y!r} {z!r}"'
