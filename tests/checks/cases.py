"""For every check a robot that passes and one that fails, and what the check says of each."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import pytest

from grader.checks.appearance import shows_box, shows_colour, shows_cylinder, shows_grey, shows_nothing, shows_sphere
from grader.checks.contact import clear_of, stands_on
from grader.checks.motion import axis_along, rolls_forward, turns_about_itself
from grader.checks.placement import bottom_at_height, bottoms_at_height, centre_at, frame_at, under_the_base
from grader.checks.tree import held_by, joints_named, root_of_tree, urdf_loads
from tests.checks.asking import AnyCheck
from tests.checks.robots import Numbers, Scene, box, cylinder, joint, link, paint, scene, sphere, turned, visual

BASE = link("base", visual(box(0.6, 0.4, 0.2), xyz=(0.0, 0.0, 0.1), material=paint("0 0.6 0 1", "green")))
LIDAR = link("lidar", visual(cylinder()))
WHEEL = link("wheel", visual(cylinder()))
CASTER = link("caster", visual(sphere(0.05)))
FOOT = link("foot")
MOUNT = joint("base_lidar_joint", "fixed", "base", "lidar", xyz=(0.15, 0.0, 0.225))
FORWARD = turned(roll=-90)


@dataclass(frozen=True, slots=True)
class Case:
    """A check with arguments, a scene that passes and one that fails, and where in it the failure stands, if anywhere."""

    check: AnyCheck
    arguments: Mapping[str, Any]
    passing: Scene
    says: str
    failing: Scene
    complains: str
    at: str | None

    @property
    def name(self) -> str:
        """The name of the check."""
        return self.check.__name__

    @property
    def family(self) -> str:
        """The module that the check is in."""
        return self.check.__module__.rpartition(".")[2]


def rolling(
    *, kind: str = "continuous", xyz: Numbers = (-0.15, 0.225, 0.0), rpy: Numbers = FORWARD, axis: Numbers = "0 0 1"
) -> Scene:
    """A base with one wheel at its left side; unless told, the wheel drives it forward."""
    return scene(BASE, WHEEL, joint("wheel_joint", kind, "base", "wheel", xyz=xyz, rpy=rpy, axis=axis))


def mounted(xyz: Numbers = (0.15, 0.0, 0.225), rpy: Numbers = "", *, lidar: str = LIDAR) -> Scene:
    """A base with a lidar on a fixed joint; unless told, it stands on the base."""
    return scene(BASE, lidar, joint("base_lidar_joint", "fixed", "base", "lidar", xyz=xyz, rpy=rpy))


def standing(*, height: float = 0.1, rpy: Numbers = "", xy: str = "0 0", wheel: float = 0.0) -> Scene:
    """A footprint with a base `height` above it, one wheel at `wheel` above the base's frame, and a caster."""
    return scene(
        FOOT,
        BASE,
        WHEEL,
        CASTER,
        joint("base_joint", "fixed", "foot", "base", xyz=f"{xy} {height!r}", rpy=rpy),
        joint("wheel_joint", "continuous", "base", "wheel", xyz=(-0.15, 0.225, wheel), rpy=FORWARD, axis="0 0 1"),
        joint("caster_joint", "fixed", "base", "caster", xyz=(0.2, 0.0, -0.05)),
    )


CASES = (
    Case(
        urdf_loads,
        {},
        passing=mounted(),
        says="ROS 2 loads the file and every link is in its one tree",
        failing=scene(BASE, LIDAR),
        complains="'lidar' is not connected to the robot: no joint has it as its child (roots are 'base', 'lidar');"
        " ROS 2 rejects the file",
        at='name="lidar"',
    ),
    Case(
        shows_box,
        {"link": "base", "size": (0.6, 0.4, 0.2), "tolerance": 0.002},
        passing=scene(BASE),
        says="'base' shows a box 0.6 0.4 0.2 m",
        failing=scene(link("base", visual(box(0.6, 0.2, 0.4)))),
        complains="'base' shows a box 0.6 0.2 0.4 m; it should be 0.6 0.4 0.2 m (x, y, z)",
        at="size=",
    ),
    Case(
        shows_cylinder,
        {"link": "lidar", "radius": 0.1, "length": 0.05, "tolerance": 0.002},
        passing=scene(LIDAR),
        says="'lidar' shows a cylinder of radius 0.1 m and length 0.05 m",
        failing=scene(link("lidar", visual(cylinder(0.2, 0.05)))),
        complains="'lidar' shows a cylinder of radius 0.2 m and length 0.05 m; it should have radius 0.1 m and length 0.05 m",
        at="radius=",
    ),
    Case(
        shows_sphere,
        {"link": "caster", "radius": 0.05, "tolerance": 0.002},
        passing=scene(CASTER),
        says="the radius of the sphere that 'caster' shows is 0.05 m",
        failing=scene(link("caster", visual(sphere(0.1)))),
        complains="the radius of the sphere that 'caster' shows is 0.1 m; it should be 0.05 m (50 mm too large)",
        at="radius=",
    ),
    Case(
        shows_colour,
        {"link": "base", "colour": (0.0, 0.6, 0.0, 1.0), "tolerance": 0.01},
        passing=scene(BASE),
        says="'base' is shown in rgba 0 0.6 0 1",
        failing=scene(link("base", visual(box(0.6, 0.4, 0.2), material=paint("0 1 0 1")))),
        complains="'base' is shown in rgba 0 1 0 1; it should be 0 0.6 0 1",
        at="rgba=",
    ),
    Case(
        shows_grey,
        {"link": "lidar", "at_least": 0.75, "tolerance": 0.01},
        passing=scene(link("lidar", visual(cylinder(), material=paint("0.8 0.8 0.8 1")))),
        says="'lidar' is shown in rgb 0.8 0.8 0.8",
        failing=scene(link("lidar", visual(cylinder(), material=paint("0.7 0.7 0.7 1")))),
        complains="'lidar' is shown in rgb 0.7 0.7 0.7; it should be at least 0.75",
        at="rgba=",
    ),
    Case(
        shows_nothing,
        {"link": "foot"},
        passing=scene(FOOT),
        says="'foot' shows nothing",
        failing=scene(link("foot", visual(box(0.1, 0.1, 0.1)))),
        complains="'foot' shows a box; it should have no visual",
        at="<visual>",
    ),
    Case(
        held_by,
        {"link": "lidar", "parent": "base", "joint_type": "fixed"},
        passing=mounted(),
        says="the fixed joint 'base_lidar_joint' connects 'lidar' to 'base'",
        failing=scene(BASE, LIDAR, joint("base_lidar_joint", "continuous", "base", "lidar")),
        complains="the joint that moves 'lidar' is continuous; it should be fixed (joint 'base_lidar_joint')",
        at='type="continuous"',
    ),
    Case(
        joints_named,
        {"parent": "base", "joints": {"base_lidar_joint": "lidar", "wheel_joint": "wheel"}},
        passing=scene(BASE, LIDAR, WHEEL, MOUNT, joint("wheel_joint", "continuous", "base", "wheel")),
        says="the joints are named 'base_lidar_joint' and 'wheel_joint'",
        failing=scene(BASE, LIDAR, WHEEL, MOUNT, joint("weel_joint", "continuous", "base", "wheel")),
        complains="the joint of 'wheel' should be named 'wheel_joint', not 'weel_joint'",
        at='name="weel_joint"',
    ),
    Case(
        root_of_tree,
        {"link": "foot", "holds": "base"},
        passing=scene(FOOT, BASE, joint("base_joint", "fixed", "foot", "base")),
        says="'foot' is the root, and 'base' is fixed to it",
        failing=scene(FOOT, BASE, joint("base_joint", "fixed", "base", "foot")),
        complains="'foot' is not the root: it is a child of 'base' (joint 'base_joint')",
        at="<joint",
    ),
    Case(
        frame_at,
        {"link": "lidar", "relative_to": "base", "xyz": (0.15, 0.0, 0.225), "tolerance": 0.002},
        passing=mounted(),
        says="the frame 'lidar' is at 0.15 0 0.225 m in 'base'",
        failing=mounted((0.15, 0.01, 0.2)),
        complains="the frame 'lidar' is at 0.15 0.01 0.2 m in 'base'; it should be at 0.15 0 0.225 m"
        " (y 10 mm too large, z 25 mm too small)",
        at='xyz="0.15 0.01 0.2"',
    ),
    Case(
        centre_at,
        {"link": "wheel", "relative_to": "base", "xyz": (-0.15, 0.225, 0.0), "tolerance": 0.002},
        passing=rolling(),
        says="the centre of what 'wheel' shows is at -0.15 0.225 0 m in 'base'",
        failing=rolling(xyz=(-0.15, 0.2, 0.0)),
        complains="the centre of what 'wheel' shows is at -0.15 0.2 0 m in 'base'; it should be at -0.15 0.225 0 m"
        " (y 25 mm too small)",
        at='xyz="-0.15 0.2 0.0"',
    ),
    Case(
        bottom_at_height,
        {"link": "base", "relative_to": "base", "height": 0.0, "tolerance": 0.002},
        passing=scene(BASE),
        says="the bottom of 'base' in the frame 'base' is at z = 0 m",
        failing=scene(link("base", visual(box(0.6, 0.4, 0.2)))),
        complains="the bottom of 'base' in the frame 'base' is at z = -0.1 m; it should be 0 m (100 mm too low)",
        at="<visual>",
    ),
    Case(
        bottoms_at_height,
        {"links": ["wheel", "caster"], "relative_to": "foot", "height": 0.0, "tolerance": 0.002},
        passing=standing(),
        says="the bottoms of 'wheel' and 'caster' are at z = 0 0 m in 'foot'",
        failing=standing(wheel=0.05),
        complains="the bottoms of 'wheel' and 'caster' are at z = 0.05 0 m in 'foot'; they should be at 0 m ('wheel' 50 mm too high)",
        at='xyz="-0.15 0.225 0.05"',  # of the wheel's joint
    ),
    Case(
        stands_on,
        {"link": "lidar", "on": "base", "tolerance": 0.002},
        passing=mounted(),
        says="'lidar' stands on the top of 'base', at z = 0.2 m in 'base'",
        failing=mounted((0.15, 0.0, 0.2)),
        complains="the bottom of 'lidar' is at z = 0.175 m in 'base'; it should be at the top of 'base',"
        " 0.2 m (25 mm too low)",
        at=None,  # lidar or base: either may be in the wrong place
    ),
    Case(
        clear_of,
        {"link": "wheel", "of": "base", "tolerance": 0.002},
        passing=rolling(),
        says="'wheel' does not cut into 'base'",
        failing=rolling(xyz=(-0.15, 0.2, 0.0)),
        complains="'wheel' cuts 25 mm deep into 'base'",
        at="<visual>\n<geometry>\n<cylinder",
    ),
    Case(
        under_the_base,
        {"link": "foot", "base": "base", "wheels": ["wheel"], "tolerance": 0.002, "angle": 1.0},
        passing=standing(),
        says="the frame 'foot' is under 'base', level with the bottoms of the wheels",
        failing=standing(height=0.05),
        complains="the frame 'foot' should be under 'base', level with the bottoms of the wheels:"
        " the lowest point of 'wheel' is 50 mm below it",
        at='xyz="0 0 0.05"',
    ),
    Case(
        rolls_forward,
        {"link": "wheel", "base": "base", "tolerance": 1.0},
        passing=rolling(),
        says="a small positive turn of 'wheel' drives 'base' forward (joint 'wheel_joint')",
        failing=rolling(rpy=turned(roll=90)),
        complains="a small positive turn of 'wheel' drives 'base' backward; it should drive it forward (joint 'wheel_joint')",
        at="rpy=",
    ),
    Case(
        axis_along,
        {
            "link": "wheel",
            "axis": (0.0, 0.0, 1.0),
            "relative_to": "base",
            "direction": (0.0, 1.0, 0.0),
            "tolerance": 1.0,
        },
        passing=rolling(),
        says="the z axis of the frame 'wheel' points along 0 1 0 in 'base'",
        failing=rolling(rpy=turned(roll=90)),
        complains="the z axis of the frame 'wheel' points along 0 -1 0 in 'base'; it should point along 0 1 0 (180 degrees off)",
        at="rpy=",
    ),
    Case(
        turns_about_itself,
        {"link": "wheel", "base": "base", "tolerance": 0.002, "angle": 1.0},
        passing=rolling(),
        says="'wheel' turns about its own axis",
        failing=rolling(axis="0 1 0"),
        complains="'wheel' wobbles: its joint axis is 90 degrees off the cylinder's axis; it should be along it (joint 'wheel_joint')",
        at='xyz="0 1 0"',
    ),
)

CASE = {case.name: case for case in CASES}


def cases_of(family: str) -> pytest.MarkDecorator:
    """Run a test once for each check of a family."""
    chosen = [case for case in CASES if case.family == family]
    return pytest.mark.parametrize("case", chosen, ids=[case.name for case in chosen])
