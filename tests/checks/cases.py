"""For every check a robot that passes, one that fails, and the message for each."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import radians
from typing import Any

import pytest

from grader.checks import (
    appearance,
    collisions,
    colours,
    contact,
    counts,
    elements,
    heights,
    inertia,
    joints,
    meshes,
    mimics,
    motion,
    placement,
    problems,
    reference,
    tree,
)
from grader.checks.outcome import Status
from tests.checks.outcomes import AnyCheck
from tests.checks.robots import (
    Numbers,
    Scene,
    arm,
    box,
    collision,
    cylinder,
    inertial,
    joint,
    link,
    mesh,
    paint,
    scene,
    sphere,
    turned,
    visual,
)

BASE = link("base", visual(box(0.6, 0.4, 0.2), xyz=(0.0, 0.0, 0.1), material=paint("0 0.6 0 1", "green")))
LIDAR = link("lidar", visual(cylinder()))
WHEEL = link("wheel", visual(cylinder()))
CASTER = link("caster", visual(sphere(0.05)))
FOOT = link("foot")
MOUNT = joint("base_lidar_joint", "fixed", "base", "lidar", xyz=(0.15, 0.0, 0.225))
FORWARD = turned(roll=-90)


@dataclass(frozen=True, slots=True)
class Case:
    """The sample of a check: arguments, a scene that passes, one that fails, and the messages.

    `at` is the text at the location of the failure, if it has one. `edges` has, for each tolerance of the check, a function
    that returns a scene which is off by a given amount in the tolerance's unit, positive or negative unless the name is in
    `one_sided`. `mesh_status` is the status if every shape is a mesh. `needs_size` is False for a check that ignores the
    sizes of visuals.
    """

    check: AnyCheck
    arguments: Mapping[str, Any]
    passing: Scene
    pass_message: str
    failing: Scene
    fail_message: str
    at: str | None
    edges: Mapping[str, Callable[[float], Scene]] = field(default_factory=dict)
    one_sided: tuple[str, ...] = ()
    mesh_status: Status = "passed"
    needs_size: bool = True

    @property
    def name(self) -> str:
        """Return the name of the check."""
        return self.check.__name__

    @property
    def family(self) -> str:
        """Return the module of the check."""
        return self.check.__module__.rpartition(".")[2]


def painted(name: str, rgba: str) -> Scene:
    """Return a link with a visual in a colour."""
    return scene(link(name, visual(box(0.6, 0.4, 0.2), material=paint(rgba))))


def rolling(
    *,
    kind: str = "continuous",
    xyz: Numbers = (-0.15, 0.225, 0.0),
    rpy: Numbers = FORWARD,
    axis: Numbers = "0 0 1",
    wheel: str = WHEEL,
) -> Scene:
    """Return a base with one wheel on its left side, which drives it forward by default."""
    return scene(BASE, wheel, joint("wheel_joint", kind, "base", "wheel", xyz=xyz, rpy=rpy, axis=axis))


def mounted(xyz: Numbers = (0.15, 0.0, 0.225), rpy: Numbers = "", *, lidar: str = LIDAR) -> Scene:
    """Return a base with a lidar on a fixed joint; default: the lidar stands on the base."""
    return scene(BASE, lidar, joint("base_lidar_joint", "fixed", "base", "lidar", xyz=xyz, rpy=rpy))


def standing(*, height: float = 0.1, rpy: Numbers = "", xy: str = "0 0", wheel: float = 0.0) -> Scene:
    """Return a footprint with a base `height` above it, one wheel at `wheel` above the base's frame, and a caster."""
    return scene(
        FOOT,
        BASE,
        WHEEL,
        CASTER,
        joint("base_joint", "fixed", "foot", "base", xyz=f"{xy} {height!r}", rpy=rpy),
        joint("wheel_joint", "continuous", "base", "wheel", xyz=(-0.15, 0.225, wheel), rpy=FORWARD, axis="0 0 1"),
        joint("caster_joint", "fixed", "base", "caster", xyz=(0.2, 0.0, -0.05)),
    )


def swinging(
    *,
    kind: str = "revolute",
    xyz: Numbers = (0.1, 0.0, 0.2),
    rpy: Numbers = "",
    axis: Numbers = "0 1 0",
    limit: str = 'lower="-1.5708" upper="0.7854" effort="10" velocity="2"',
    more: str = "",
) -> Scene:
    """Return a base with an arm on a joint, and a tip that is fixed to the arm by a frame turned about x."""
    return scene(
        link("base"),
        link("arm"),
        link("tip"),
        joint("shoulder", kind, "base", "arm", xyz=xyz, rpy=rpy, axis=axis, limit=limit, more=more),
        joint("tip_joint", "fixed", "arm", "tip", xyz="0.3 0 0", rpy=turned(roll=90)),
    )


def ranged(lower: float = radians(-90), upper: float = radians(45)) -> Scene:
    """Return a base with an arm that has these limits in radians."""
    return swinging(limit=f'lower="{lower!r}" upper="{upper!r}" effort="10" velocity="2"')


def gripping(*mimic: str, kind: str = "prismatic") -> Scene:
    """Return a palm with a left finger, and a right finger whose joint has these attributes of a <mimic>."""
    follows = f"<mimic {' '.join(mimic)}/>" if mimic else ""
    return scene(
        link("palm"),
        link("left"),
        link("right"),
        joint("left_joint", "prismatic", "palm", "left", axis="0 1 0"),
        joint("right_joint", kind, "palm", "right", axis="0 -1 0", more=follows),
    )


def weighing(mass: float = 12.0, *, share: float = 1.0, xyz: Numbers = "0 0 1") -> Scene:
    """Return a box 1 x 2 x 3 that stands on its link's frame, with its inertia but for a factor."""
    inertia = (13.0 * share, 0.0, 0.0, 10.0 * share, 0.0, 5.0 * share)
    shown = visual(box(1.0, 2.0, 3.0), xyz="0 0 1")
    return scene(link("block", inertial(mass, inertia, xyz=xyz), shown))


def colliding(z: float = 0.1) -> Scene:
    """Return a box that is shown at a height of 0.1, and collides at another height."""
    shape = box(0.6, 0.4, 0.2)
    return scene(link("block", visual(shape, xyz="0 0 0.1"), collision(shape, xyz=(0.0, 0.0, z))))


def meshed(z: float = 0.1) -> Scene:
    """Return a mesh that is shown at a height."""
    return scene(link("block", visual(mesh(), xyz=(0.0, 0.0, z))))


def with_camera(*, rate: str = "30", kind: str = "camera", width: str = "640", link_name: str = "camera") -> Scene:
    """Return a base with a camera that Gazebo simulates."""
    image = f"<camera>\n<image>\n<width>{width}</width>\n</image>\n</camera>"
    inside = f"<update_rate>{rate}</update_rate>\n<always_on>1</always_on>\n{image}"
    sensor = f'<sensor name="front" type="{kind}">\n{inside}\n</sensor>'
    camera = joint("camera_joint", "fixed", "base", "camera")
    return scene(BASE, link("camera"), camera, f'<gazebo reference="{link_name}">\n{sensor}\n</gazebo>')


CASES = (
    Case(
        tree.urdf_loads,
        {},
        passing=mounted(),
        pass_message="ROS 2 loads the file, and all links form one tree",
        failing=scene(BASE, LIDAR),
        fail_message="'lidar' is not connected to the robot: no joint has it as its child (the roots are 'base', 'lidar');"
        " ROS 2 rejects the file",
        at='name="lidar"',
        needs_size=False,
    ),
    Case(
        appearance.shows_box,
        {"link": "base", "size": (0.6, 0.4, 0.2), "tolerance": 0.002},
        passing=scene(BASE),
        pass_message="'base' shows a box 0.6 0.4 0.2 m",
        failing=scene(link("base", visual(box(0.6, 0.2, 0.4)))),
        fail_message="'base' shows a box 0.6 0.2 0.4 m; it should be 0.6 0.4 0.2 m (x, y, z)",
        at="size=",
        edges={"tolerance": lambda off: scene(link("base", visual(box(0.6, 0.4 + off, 0.2))))},
        mesh_status="failed",
    ),
    Case(
        appearance.shows_cylinder,
        {"link": "lidar", "radius": 0.1, "length": 0.05, "tolerance": 0.002},
        passing=scene(LIDAR),
        pass_message="'lidar' shows a cylinder of radius 0.1 m and length 0.05 m",
        failing=scene(link("lidar", visual(cylinder(0.2, 0.05)))),
        fail_message="'lidar' shows a cylinder of radius 0.2 m and length 0.05 m; it should have radius 0.1 m and length 0.05 m",
        at="radius=",
        edges={"tolerance": lambda off: scene(link("lidar", visual(cylinder(0.1 + off, 0.05))))},
        mesh_status="failed",
    ),
    Case(
        appearance.shows_sphere,
        {"link": "caster", "radius": 0.05, "tolerance": 0.002},
        passing=scene(CASTER),
        pass_message="the radius of the sphere that 'caster' shows is 0.05 m",
        failing=scene(link("caster", visual(sphere(0.1)))),
        fail_message="the radius of the sphere that 'caster' shows is 0.1 m; it should be 0.05 m (50 mm too large)",
        at="radius=",
        edges={"tolerance": lambda off: scene(link("caster", visual(sphere(0.05 + off))))},
        mesh_status="failed",
    ),
    Case(
        colours.shows_colour,
        {"link": "base", "colour": (0.0, 0.6, 0.0, 1.0), "tolerance": 0.01},
        passing=scene(BASE),
        pass_message="'base' is shown in rgba 0 0.6 0 1",
        failing=scene(link("base", visual(box(0.6, 0.4, 0.2), material=paint("0 1 0 1")))),
        fail_message="'base' is shown in rgba 0 1 0 1; it should be 0 0.6 0 1",
        at="rgba=",
        edges={"tolerance": lambda off: painted("base", f"0 {0.6 + off} 0 1")},
    ),
    Case(
        colours.shows_grey,
        {"link": "lidar", "at_least": 0.75, "tolerance": 0.01},
        passing=scene(link("lidar", visual(cylinder(), material=paint("0.8 0.8 0.8 1")))),
        pass_message="'lidar' is shown in rgb 0.8 0.8 0.8",
        failing=scene(link("lidar", visual(cylinder(), material=paint("0.7 0.7 0.7 1")))),
        fail_message="'lidar' is shown in rgb 0.7 0.7 0.7; each should be at least 0.75",
        at="rgba=",
        edges={"tolerance": lambda off: painted("lidar", f"0.8 {0.8 + off} 0.8 1")},
    ),
    Case(
        appearance.shows_nothing,
        {"link": "foot"},
        passing=scene(FOOT),
        pass_message="'foot' shows nothing",
        failing=scene(link("foot", visual(box(0.1, 0.1, 0.1)))),
        fail_message="'foot' shows a box; it should have no visual",
        at="<visual>",
        needs_size=False,
    ),
    Case(
        tree.held_by,
        {"link": "lidar", "parent": "base", "joint_type": "fixed"},
        passing=mounted(),
        pass_message="the fixed joint 'base_lidar_joint' connects 'lidar' to 'base'",
        failing=scene(BASE, LIDAR, joint("base_lidar_joint", "continuous", "base", "lidar")),
        fail_message="the joint that moves 'lidar' is continuous; it should be fixed (joint 'base_lidar_joint')",
        at='type="continuous"',
        needs_size=False,
    ),
    Case(
        tree.joints_named,
        {"parent": "base", "joints": {"base_lidar_joint": "lidar", "wheel_joint": "wheel"}},
        passing=scene(BASE, LIDAR, WHEEL, MOUNT, joint("wheel_joint", "continuous", "base", "wheel")),
        pass_message="the joints are named 'base_lidar_joint' and 'wheel_joint'",
        failing=scene(BASE, LIDAR, WHEEL, MOUNT, joint("weel_joint", "continuous", "base", "wheel")),
        fail_message="the joint of 'wheel' should be named 'wheel_joint', not 'weel_joint'",
        at='name="weel_joint"',
        needs_size=False,
    ),
    Case(
        tree.root_of_tree,
        {"link": "foot", "holds": "base"},
        passing=scene(FOOT, BASE, joint("base_joint", "fixed", "foot", "base")),
        pass_message="'foot' is the root, and 'base' is fixed to it",
        failing=scene(FOOT, BASE, joint("base_joint", "fixed", "base", "foot")),
        fail_message="'foot' is not the root: it is a child of 'base' (joint 'base_joint')",
        at="<joint",
        needs_size=False,
    ),
    Case(
        counts.counts,
        {"links": 3, "joints": 2, "moving": 1, "revolute": 1, "continuous": 0, "prismatic": 0, "fixed": 1},
        passing=swinging(),
        pass_message="the tree has 3 links, 2 joints, 1 moving joint, 1 revolute joint, 0 continuous joints, 0 prismatic joints"
        " and 1 fixed joint",
        failing=swinging(kind="continuous"),
        fail_message="there are 0 revolute joints; there should be 1; there is 1 continuous joint; there should be 0",
        at=None,
        needs_size=False,
    ),
    Case(
        placement.frame_at,
        {"link": "lidar", "relative_to": "base", "xyz": (0.15, 0.0, 0.225), "tolerance": 0.002, "angle": 1.0},
        passing=mounted(),
        pass_message="the frame 'lidar' is at 0.15 0 0.225 m in 'base'",
        failing=mounted((0.15, 0.01, 0.2)),
        fail_message="the frame 'lidar' is at 0.15 0.01 0.2 m in 'base'; it should be at 0.15 0 0.225 m"
        " (y 10 mm too large, z 25 mm too small)",
        at='xyz="0.15 0.01 0.2"',
        edges={
            "tolerance": lambda off: mounted((0.15, off, 0.225)),
            "angle": lambda off: mounted(rpy=turned(yaw=off)),
        },
        needs_size=False,
    ),
    Case(
        placement.centre_at,
        {
            "link": "wheel",
            "relative_to": "base",
            "xyz": (-0.15, 0.225, 0.0),
            "tolerance": 0.002,
            "axis": (0.0, -1.0, 0.0),
            "angle": 1.0,
        },
        passing=rolling(),
        pass_message="the centre of the visual of 'wheel' is at -0.15 0.225 0 m in 'base'",
        failing=rolling(xyz=(-0.15, 0.2, 0.0)),
        fail_message="the centre of the visual of 'wheel' is at -0.15 0.2 0 m in 'base'; it should be at -0.15 0.225 0 m"
        " (y 25 mm too small)",
        at='xyz="-0.15 0.2 0.0"',
        edges={
            "tolerance": lambda off: rolling(xyz=(-0.15, 0.225 + off, 0.0)),
            "angle": lambda off: rolling(rpy=turned(roll=-90 + off)),
        },
        mesh_status="pending",
    ),
    Case(
        heights.bottom_at_height,
        {"link": "base", "relative_to": "base", "height": 0.0, "tolerance": 0.002},
        passing=scene(BASE),
        pass_message="the bottom of 'base' in the frame 'base' is at z = 0 m",
        failing=scene(link("base", visual(box(0.6, 0.4, 0.2)))),
        fail_message="the bottom of 'base' in the frame 'base' is at z = -0.1 m; it should be 0 m (100 mm too low)",
        at="<visual>",
        edges={"tolerance": lambda off: scene(link("base", visual(box(0.6, 0.4, 0.2), xyz=(0.0, 0.0, 0.1 + off))))},
        mesh_status="pending",
    ),
    Case(
        heights.bottoms_at_height,
        {"links": ["wheel", "caster"], "relative_to": "foot", "height": 0.0, "tolerance": 0.002},
        passing=standing(),
        pass_message="the bottoms of 'wheel' and 'caster' are at z = 0 0 m in 'foot'",
        failing=standing(wheel=0.05),
        fail_message="the bottoms of 'wheel' and 'caster' are at z = 0.05 0 m in 'foot'; they should be at 0 m ('wheel' 50 mm too high)",
        at='xyz="-0.15 0.225 0.05"',  # of the wheel's joint
        edges={"tolerance": lambda off: standing(wheel=off)},
        mesh_status="pending",
    ),
    Case(
        contact.stands_on,
        {"link": "lidar", "on": "base", "tolerance": 0.002},
        passing=mounted(),
        pass_message="'lidar' stands on the top of 'base', at z = 0.2 m in 'base'",
        failing=mounted((0.15, 0.0, 0.2)),
        fail_message="the bottom of 'lidar' is at z = 0.175 m in 'base'; it should be at the top of 'base',"
        " 0.2 m (25 mm too low)",
        at=None,  # lidar or base: either may be in the wrong place
        edges={"tolerance": lambda off: mounted((0.15, 0.0, 0.225 + off))},
        mesh_status="pending",
    ),
    Case(
        contact.clear_of,
        {"link": "wheel", "of": "base", "tolerance": 0.002},
        passing=rolling(),
        pass_message="'wheel' does not cut into 'base'",
        failing=rolling(xyz=(-0.15, 0.2, 0.0)),
        fail_message="'wheel' cuts 25 mm deep into 'base'",
        at="<visual>\n<geometry>\n<cylinder",
        edges={"tolerance": lambda off: rolling(xyz=(-0.15, 0.225 - off, 0.0))},
        one_sided=("tolerance",),
        mesh_status="pending",
    ),
    Case(
        heights.under_the_base,
        {"link": "foot", "base": "base", "wheels": ["wheel"], "tolerance": 0.002, "angle": 1.0},
        passing=standing(),
        pass_message="the frame 'foot' is under 'base', level with the bottoms of the wheels",
        failing=standing(height=0.05),
        fail_message="the frame 'foot' should be under 'base', level with the bottoms of the wheels:"
        " the lowest point of 'wheel' is 50 mm below it",
        at='xyz="0 0 0.05"',
        edges={
            "tolerance": lambda off: standing(height=0.1 + off),
            "angle": lambda off: standing(rpy=turned(yaw=off)),
        },
        mesh_status="pending",
    ),
    Case(
        motion.rolls_forward,
        {"link": "wheel", "base": "base", "tolerance": 1.0},
        passing=rolling(),
        pass_message="a small positive turn of 'wheel' drives 'base' forward (joint 'wheel_joint')",
        failing=rolling(rpy=turned(roll=90)),
        fail_message="a small positive turn of 'wheel' drives 'base' backward; it should drive it forward (joint 'wheel_joint')",
        at="rpy=",
        edges={"tolerance": lambda off: rolling(rpy=turned(roll=-90, yaw=off))},
        mesh_status="pending",
    ),
    Case(
        motion.axis_along,
        {
            "link": "wheel",
            "axis": (0.0, 0.0, 1.0),
            "relative_to": "base",
            "direction": (0.0, 1.0, 0.0),
            "tolerance": 1.0,
        },
        passing=rolling(),
        pass_message="the z axis of the frame 'wheel' points along 0 1 0 in 'base'",
        failing=rolling(rpy=turned(roll=90)),
        fail_message="the z axis of the frame 'wheel' points along 0 -1 0 in 'base'; it should point along 0 1 0 (180 degrees off)",
        at="rpy=",
        edges={"tolerance": lambda off: rolling(rpy=turned(roll=-90 + off))},
        needs_size=False,
    ),
    Case(
        motion.turns_about_itself,
        {"link": "wheel", "base": "base", "tolerance": 0.002, "angle": 1.0},
        passing=rolling(),
        pass_message="'wheel' turns about its own axis",
        failing=rolling(axis="0 1 0"),
        fail_message="'wheel' wobbles: its joint axis is 90 degrees off the cylinder's axis; it should be along it (joint 'wheel_joint')",
        at='xyz="0 1 0"',
        edges={
            "tolerance": lambda off: rolling(wheel=link("wheel", visual(cylinder(), xyz=(off, 0.0, 0.0)))),
            "angle": lambda off: rolling(wheel=link("wheel", visual(cylinder(), rpy=turned(roll=off)))),
        },
        mesh_status="failed",
    ),
    Case(
        joints.joint_limits,
        {"link": "tip", "lower": -90.0, "upper": 45.0, "tolerance": 0.5, "effort": 10.0, "velocity": 2.0},
        passing=swinging(),
        pass_message="the range of the joint that moves 'tip' is -90 to 45 degrees",
        failing=swinging(limit='lower="-1.5708" upper="1.5708" effort="20" velocity="2"'),
        fail_message="the range of the joint that moves 'tip' is -90 to 90 degrees; it should be -90 to 45 degrees;"
        " its effort is 20; it should be 10 (joint 'shoulder')",
        at="upper=",
        edges={"tolerance": lambda off: ranged(upper=radians(45 + off))},
        needs_size=False,
    ),
    Case(
        joints.joint_axis,
        {
            "link": "tip",
            "relative_to": "base",
            "direction": (0.0, 2.0, 0.0),
            "tolerance": 1.0,
            "through": (0.1, 5.0, 0.2),
            "distance": 0.002,
        },
        passing=swinging(),
        pass_message="the axis of the joint that moves 'tip' points along 0 1 0 in 'base' and passes 0 mm from 0.1 5 0.2 m",
        failing=swinging(axis="0 0 1"),
        fail_message="the axis of the joint that moves 'tip' points along 0 0 1 in 'base'; it should point along 0 1 0"
        " (90 degrees off) (joint 'shoulder')",
        at='xyz="0 0 1"',
        edges={
            "tolerance": lambda off: swinging(xyz=(0.1, 5.0, 0.2), rpy=turned(roll=off)),
            "distance": lambda off: swinging(xyz=(0.1 + off, 0.0, 0.2)),
        },
        needs_size=False,
    ),
    Case(
        mimics.mimics,
        {"link": "right", "leader": "left", "multiplier": -1.0, "offset": 0.1, "tolerance": 0.01},
        passing=gripping('joint="left_joint" multiplier="-1" offset="0.1"'),
        pass_message="the joint that moves 'right' mimics the joint that moves 'left'",
        failing=gripping('joint="left_joint"', 'offset="0.1"'),
        fail_message="the joint that moves 'right' mimics the joint that moves 'left'; its multiplier is 1; it should be -1"
        " (joint 'right_joint')",
        at="<mimic",
        edges={"tolerance": lambda off: gripping(f'joint="left_joint" multiplier="{-1 + off!r}" offset="0.1"')},
        needs_size=False,
    ),
    Case(
        joints.joint_dynamics,
        {"link": "tip", "friction": 0.5, "damping": 0.0, "tolerance": 0.01},
        passing=swinging(more='<dynamics friction="0.5"/>'),
        pass_message="the joint that moves 'tip' has <dynamics>",
        failing=swinging(more='<dynamics damping="0.5" friction="0.5"/>'),
        fail_message="the joint that moves 'tip' has <dynamics>; its damping is 0.5; it should be 0 (joint 'shoulder')",
        at="damping=",
        edges={"tolerance": lambda off: swinging(more=f'<dynamics friction="{0.5 + off!r}"/>')},
        needs_size=False,
    ),
    Case(
        inertia.mass_is,
        {"link": "block", "mass": 12.0, "tolerance": 0.1},
        passing=weighing(),
        pass_message="the mass of 'block' is 12 kg",
        failing=weighing(1.2),
        fail_message="the mass of 'block' is 1.2 kg; it should be 12 kg (10.8 kg too small)",
        at='value="1.2"',
        edges={"tolerance": lambda off: weighing(12.0 + off)},
        needs_size=False,
    ),
    Case(
        inertia.inertia_plausible,
        {"link": "block", "tolerance": 10.0},
        passing=weighing(),
        pass_message="the inertia of 'block' is that of a uniform solid of its visual (0 % off)",
        failing=weighing(share=1.6),
        fail_message="the inertia of 'block' is 60 % off that of a uniform solid of its visual:"
        " it is 60 % too large, as for a mass of 19.2 kg",
        at="<inertia ",
        edges={"tolerance": lambda off: weighing(share=1.0 + off / 100.0)},
        mesh_status="pending",
    ),
    Case(
        collisions.collision_matches_visual,
        {"link": "block", "tolerance": 0.002},
        passing=colliding(),
        pass_message="'block' has 1 collision shape, as shown",
        failing=colliding(z=0.0),
        fail_message="no collision shape of 'block' is a box 0.6 0.4 0.2 m at 0 0 0.1 m, as shown;"
        " the nearest is a box 0.6 0.4 0.2 m at 0 0 0 m (100 mm away)",
        at='xyz="0.0 0.0 0.0"',
        edges={"tolerance": lambda off: colliding(z=0.1 + off)},
    ),
    Case(
        collisions.collides_as,
        {
            "link": "block",
            "box": (0.6, 0.4, 0.2),
            "xyz": (0.0, 0.0, 0.1),
            "rpy": (0.0, 0.0, 0.0),
            "tolerance": 0.002,
            "only": True,
        },
        passing=colliding(),
        pass_message="'block' collides as a box 0.6 0.4 0.2 m at 0 0 0.1 m",
        failing=colliding(z=0.0),
        fail_message="no collision shape of 'block' is a box 0.6 0.4 0.2 m at 0 0 0.1 m;"
        " the nearest is a box 0.6 0.4 0.2 m at 0 0 0 m (100 mm away)",
        at='xyz="0.0 0.0 0.0"',
        edges={"tolerance": lambda off: colliding(z=0.1 + off)},
        mesh_status="failed",
    ),
    Case(
        meshes.shows_mesh,
        {
            "link": "block",
            "file": "meshes/part.stl",
            "scale": (1.0, 1.0, 1.0),
            "xyz": (0.0, 0.0, 0.1),
            "rpy": (0.0, 0.0, 0.0),
            "tolerance": 0.002,
        },
        passing=meshed(),
        pass_message="'block' shows the mesh 'package://my_robot/meshes/part.stl'",
        failing=meshed(z=0.2),
        fail_message="the mesh of 'block' is at 0 0 0.2 m in 'block'; it should be at 0 0 0.1 m (z 100 mm too large)"
        " (mesh 'package://my_robot/meshes/part.stl')",
        at='xyz="0.0 0.0 0.2"',
        edges={"tolerance": lambda off: meshed(z=0.1 + off)},
    ),
    Case(
        problems.without_problems,
        {"problems": ["URDF074", "XACRO003"]},
        passing=arm(),
        pass_message="the URDF has none of the problems URDF074 and XACRO003",
        failing=arm(axis="0 2 0"),
        fail_message="URDF074: only the direction of an axis counts: ROS 2 normalizes it",
        at='xyz="0 2 0"',
        needs_size=False,
    ),
    Case(
        reference.kinematics_match_reference,
        {"links": ["wheel"], "samples": 20, "tolerance": 0.002, "angle": 1.0},
        passing=arm(),
        pass_message="'wheel' moves as in the reference at 27 positions of 2 joints: at most 0 mm and 0 degrees off",
        failing=arm(xyz=(0.55, 0.0, 0.0)),
        fail_message="'wheel' does not move as in the reference: it is 50 mm and 0 degrees off with all joints at 0",
        at='<link name="wheel"',
        edges={"tolerance": lambda off: arm(xyz=(0.5 + off, 0.0, 0.0)), "angle": lambda off: arm(rpy=turned(roll=off))},
        needs_size=False,
    ),
    Case(
        elements.element_present,
        {
            "tag": "gazebo",
            "attributes": {"reference": "camera"},
            "path": "sensor",
            "values": {"@type": "camera", "update_rate": 30.0, "always_on": True, "camera/image/width": 640.0},
            "tolerance": 0.01,
        },
        passing=with_camera(),
        pass_message='there is <sensor> in <gazebo reference="camera"> with the expected values',
        failing=with_camera(rate="10"),
        fail_message="<sensor> in <gazebo reference=\"camera\">: 'update_rate' is 10; it should be 30",
        at="<update_rate>",
        edges={"tolerance": lambda off: with_camera(rate=repr(30.0 + off))},
        needs_size=False,
    ),
)

CASE = {case.name: case for case in CASES}


def cases_of(family: str) -> pytest.MarkDecorator:
    """Parametrise a test over the checks of a family."""
    chosen = [case for case in CASES if case.family == family]
    return pytest.mark.parametrize("case", chosen, ids=[case.name for case in chosen])
