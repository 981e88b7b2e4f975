"""For every check a robot that passes and one that fails; golden/outcomes-of-cases.txt has what it finds in them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import radians
from typing import Any

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
    """The sample of a check: arguments, a scene that passes, and one that fails.

    `edges` has, for each tolerance of the check, a function
    that returns a scene which is off by a given amount in the tolerance's unit, positive or negative unless the name is in
    `one_sided`. `mesh_status` is the status if every shape is a mesh. `needs_size` is False for a check that ignores the
    sizes of visuals.
    """

    check: AnyCheck
    arguments: Mapping[str, Any]
    passing: Scene
    failing: Scene
    edges: Mapping[str, Callable[[float], Scene]] = field(default_factory=dict)
    one_sided: tuple[str, ...] = ()
    mesh_status: Status = "passed"
    needs_size: bool = True

    @property
    def name(self) -> str:
        """Return the name of the check."""
        return self.check.__name__


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
        failing=scene(BASE, LIDAR),
        needs_size=False,
    ),
    Case(
        appearance.shows_box,
        {"link": "base", "size": (0.6, 0.4, 0.2), "tolerance": 0.002},
        passing=scene(BASE),
        failing=scene(link("base", visual(box(0.6, 0.2, 0.4)))),
        edges={"tolerance": lambda off: scene(link("base", visual(box(0.6, 0.4 + off, 0.2))))},
        mesh_status="failed",
    ),
    Case(
        appearance.shows_cylinder,
        {"link": "lidar", "radius": 0.1, "length": 0.05, "tolerance": 0.002},
        passing=scene(LIDAR),
        failing=scene(link("lidar", visual(cylinder(0.2, 0.05)))),
        edges={"tolerance": lambda off: scene(link("lidar", visual(cylinder(0.1 + off, 0.05))))},
        mesh_status="failed",
    ),
    Case(
        appearance.shows_sphere,
        {"link": "caster", "radius": 0.05, "tolerance": 0.002},
        passing=scene(CASTER),
        failing=scene(link("caster", visual(sphere(0.1)))),
        edges={"tolerance": lambda off: scene(link("caster", visual(sphere(0.05 + off))))},
        mesh_status="failed",
    ),
    Case(
        colours.shows_colour,
        {"link": "base", "colour": (0.0, 0.6, 0.0, 1.0), "tolerance": 0.01},
        passing=scene(BASE),
        failing=scene(link("base", visual(box(0.6, 0.4, 0.2), material=paint("0 1 0 1")))),
        edges={"tolerance": lambda off: painted("base", f"0 {0.6 + off} 0 1")},
    ),
    Case(
        colours.shows_grey,
        {"link": "lidar", "at_least": 0.75, "tolerance": 0.01},
        passing=scene(link("lidar", visual(cylinder(), material=paint("0.8 0.8 0.8 1")))),
        failing=scene(link("lidar", visual(cylinder(), material=paint("0.7 0.7 0.7 1")))),
        edges={"tolerance": lambda off: painted("lidar", f"0.8 {0.8 + off} 0.8 1")},
    ),
    Case(
        appearance.shows_nothing,
        {"link": "foot"},
        passing=scene(FOOT),
        failing=scene(link("foot", visual(box(0.1, 0.1, 0.1)))),
        needs_size=False,
    ),
    Case(
        tree.held_by,
        {"link": "wheel", "parent": "base", "joint_type": "continuous", "free": True},
        passing=rolling(),
        failing=scene(BASE, WHEEL, joint("j", "continuous", "base", "wheel", more='<mimic joint="j"/>')),
        needs_size=False,
    ),
    Case(
        tree.joints_named,
        {"parent": "base", "joints": {"base_lidar_joint": "lidar", "wheel_joint": "wheel"}},
        passing=scene(BASE, LIDAR, WHEEL, MOUNT, joint("wheel_joint", "continuous", "base", "wheel")),
        failing=scene(BASE, LIDAR, WHEEL, MOUNT, joint("weel_joint", "continuous", "base", "wheel")),
        needs_size=False,
    ),
    Case(
        tree.root_of_tree,
        {"link": "foot", "holds": "base"},
        passing=scene(FOOT, BASE, joint("base_joint", "fixed", "foot", "base")),
        failing=scene(FOOT, BASE, joint("base_joint", "fixed", "base", "foot")),
        needs_size=False,
    ),
    Case(
        counts.counts,
        {"links": 3, "joints": 2, "moving": 1, "revolute": 1, "continuous": 0, "prismatic": 0, "fixed": 1},
        passing=swinging(),
        failing=swinging(kind="continuous"),
        needs_size=False,
    ),
    Case(
        placement.frame_at,
        {"link": "lidar", "relative_to": "base", "xyz": (0.15, 0.0, 0.225), "tolerance": 0.002, "angle": 1.0},
        passing=mounted(),
        failing=mounted((0.15, 0.01, 0.2)),
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
        failing=rolling(xyz=(-0.15, 0.2, 0.0)),
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
        failing=scene(link("base", visual(box(0.6, 0.4, 0.2)))),
        edges={"tolerance": lambda off: scene(link("base", visual(box(0.6, 0.4, 0.2), xyz=(0.0, 0.0, 0.1 + off))))},
        mesh_status="pending",
    ),
    Case(
        heights.bottoms_at_height,
        {"links": ["wheel", "caster"], "relative_to": "foot", "height": 0.0, "tolerance": 0.002},
        passing=standing(),
        failing=standing(wheel=0.05),
        edges={"tolerance": lambda off: standing(wheel=off)},
        mesh_status="pending",
    ),
    Case(
        contact.stands_on,
        {"link": "lidar", "on": "base", "tolerance": 0.002},
        passing=mounted(),
        failing=mounted((0.15, 0.0, 0.2)),
        edges={"tolerance": lambda off: mounted((0.15, 0.0, 0.225 + off))},
        mesh_status="pending",
    ),
    Case(
        contact.clear_of,
        {"link": "wheel", "of": "base", "tolerance": 0.002},
        passing=rolling(),
        failing=rolling(xyz=(-0.15, 0.2, 0.0)),
        edges={"tolerance": lambda off: rolling(xyz=(-0.15, 0.225 - off, 0.0))},
        one_sided=("tolerance",),
        mesh_status="pending",
    ),
    Case(
        heights.under_the_base,
        {"link": "foot", "base": "base", "wheels": ["wheel"], "tolerance": 0.002, "angle": 1.0},
        passing=standing(),
        failing=standing(height=0.05),
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
        failing=rolling(rpy=turned(roll=90)),
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
        failing=rolling(rpy=turned(roll=90)),
        edges={"tolerance": lambda off: rolling(rpy=turned(roll=-90 + off))},
        needs_size=False,
    ),
    Case(
        motion.turns_about_itself,
        {"link": "wheel", "base": "base", "tolerance": 0.002, "angle": 1.0},
        passing=rolling(),
        failing=rolling(axis="0 1 0"),
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
        failing=swinging(limit='lower="-1.5708" upper="1.5708" effort="20" velocity="2"'),
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
        failing=swinging(axis="0 0 1"),
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
        failing=gripping('joint="left_joint"', 'offset="0.1"'),
        edges={"tolerance": lambda off: gripping(f'joint="left_joint" multiplier="{-1 + off!r}" offset="0.1"')},
        needs_size=False,
    ),
    Case(
        joints.joint_dynamics,
        {"link": "tip", "friction": 0.5, "damping": 0.0, "tolerance": 0.01},
        passing=swinging(more='<dynamics friction="0.5"/>'),
        failing=swinging(more='<dynamics damping="0.5" friction="0.5"/>'),
        edges={"tolerance": lambda off: swinging(more=f'<dynamics friction="{0.5 + off!r}"/>')},
        needs_size=False,
    ),
    Case(
        inertia.mass_is,
        {"link": "block", "mass": 12.0, "tolerance": 0.1},
        passing=weighing(),
        failing=weighing(1.2),
        edges={"tolerance": lambda off: weighing(12.0 + off)},
        needs_size=False,
    ),
    Case(
        inertia.inertia_plausible,
        {"link": "block", "tolerance": 10.0},
        passing=weighing(),
        failing=weighing(share=1.6),
        edges={"tolerance": lambda off: weighing(share=1.0 + off / 100.0)},
        mesh_status="pending",
    ),
    Case(
        collisions.collision_matches_visual,
        {"link": "block", "tolerance": 0.002},
        passing=colliding(),
        failing=colliding(z=0.0),
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
        failing=colliding(z=0.0),
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
        failing=meshed(z=0.2),
        edges={"tolerance": lambda off: meshed(z=0.1 + off)},
    ),
    Case(
        problems.without_problems,
        {"problems": ["URDF074", "XACRO003"]},
        passing=arm(),
        failing=arm(axis="0 2 0"),
        needs_size=False,
    ),
    Case(
        reference.kinematics_match_reference,
        {"links": ["wheel"], "samples": 20, "tolerance": 0.002, "angle": 1.0},
        passing=arm(),
        failing=arm(xyz=(0.55, 0.0, 0.0)),
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
        failing=with_camera(rate="10"),
        edges={"tolerance": lambda off: with_camera(rate=repr(30.0 + off))},
        needs_size=False,
    ),
)

CASE = {case.name: case for case in CASES}
