"""Where the robots of a workspace say why a message of a log was said."""

from collections.abc import Iterator

from grader.base.source import Location
from grader.ros.package.robot_file import Read
from grader.ros.urdf.urdf_problems import HARDWARE_PLUGIN
from grader.workspace.log.known_messages import KnownMessage
from grader.workspace.opening.opened import OpenedWorkspace
from grader.workspace.rules.refused_robots import list_impossible_bodies


def find_hardware_without_plugin(opened: OpenedWorkspace, _: KnownMessage) -> Iterator[Location]:
    """Yield <hardware> that xacro gives no <plugin>, also where other arguments would give one."""
    for robot in opened.robots:
        for problem in robot.loaded.problems if isinstance(robot, Read) else ():
            if problem.kind == HARDWARE_PLUGIN:
                yield problem.location


def find_systems_without_states(opened: OpenedWorkspace, _: KnownMessage) -> Iterator[Location]:
    """Yield the <ros2_control> of robots that have no <state_interface> at all."""
    for robot in opened.workspace.robots.known:
        if not list(robot.root.iter("state_interface")):
            for system in robot.systems:
                yield robot.place(system)


def find_invalid_inertias(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[Location]:
    """Yield the inertias that no body has, of a link and of those that fixed joints join to it."""
    for robot in opened.workspace.robots.known:
        for body in list_impossible_bodies(robot):
            if body.link == known.groups["link"]:
                yield body.location
