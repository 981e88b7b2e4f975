"""Join the names that files define with those that they use.

A name that is used has to be defined somewhere.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Sized
from fnmatch import fnmatchcase
from itertools import chain
from typing import NamedTuple

from grader.base.grouping import Strings
from grader.base.names import are_of_one_side, closest, near
from grader.base.problems import NO_FIXES, Fixes
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import counted, quoted
from grader.workspace.graph.compared_robots import ComparedRobots
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.rule_table import (
    FAMILIES,
    NO_ARGUMENT,
    NO_CONTROLLER,
    NO_FRAME,
    NO_PARAMETER,
    NO_PROGRAM,
    NO_TOPIC,
    AnyFamily,
    DefinedKind,
    Rule,
    Symptom,
)
from grader.workspace.rules.shared_symptoms import (
    ACTION_NOT_CONNECTED,
    CONTROLLER_NOT_LOADED,
    INTERFACE_MISSING,
    INTERFACE_NOT_AVAILABLE,
    INTERFACES_NOT_ACCEPTED,
    TREES_NOT_CONNECTED,
)

_MAX_NEAR, _MAX_SIMILAR = 1000, 300  # known names that are compared in either way


_FRAME_DEFINED = Rule(
    "frame-defined",
    "frames",
    NO_FRAME,
    "The frames that files name exist.",
    why=(
        "tf2 has no transform for a frame that nothing publishes: lookups fail with "
        "LookupException, and RViz prints that the frame does not exist."
    ),
    symptoms=(TREES_NOT_CONNECTED,),
    wrong="""
Node(
    package='tf2_ros',
    executable='static_transform_publisher',
    arguments=['--frame-id', 'base_lnk', '--child-frame-id', 'camera'],
),
""",
    right="""
Node(
    package='tf2_ros',
    executable='static_transform_publisher',
    arguments=['--frame-id', 'base_link', '--child-frame-id', 'camera'],
),
""",
)

_LINK_DEFINED = Rule(
    "link-defined",
    "frames",
    NO_FRAME,
    "The links that files name are in the robot.",
    why=(
        "Gazebo ignores a <gazebo> element for an unknown link, so its friction or sensor is "
        "missing. MoveIt ignores unknown links of an SRDF."
    ),
    symptoms=(
        Symptom(
            "group-link",
            pattern=(
                r"Link '(?P<link>[^']{1,200}+)' declared as part of (?:a chain in )?group "
                r"'(?P<group>[^']{1,200}+)' is not known to the URDF"
            ),
            source="moveit/srdfdom e23af6e, src/model.cpp:147",
            sentence="A group of the SRDF names a link that the robot does not have.",
            example=(
                "Link 'tool9' declared as part of a chain in group 'arm' is not known to the URDF"
            ),
            within=("link",),
        ),
    ),
    wrong='<gazebo reference="base_lnk"><mu1>0.9</mu1></gazebo>',
    right='<gazebo reference="base_link"><mu1>0.9</mu1></gazebo>',
    frame="rover.urdf",
)

JOINT_DEFINED = Rule(
    "joint-defined",
    "frames",
    NO_FRAME,
    "The joints that files name are in the robot.",
    why=(
        "A controller cannot claim the interfaces of an unknown joint, so it does not become "
        "active. MoveIt ignores the limits of such a joint."
    ),
    symptoms=(
        Symptom(
            "group-joint",
            pattern=(
                r"Joint '(?P<joint>[^']{1,200}+)' declared as part of group "
                r"'(?P<group>[^']{1,200}+)' is not known to the URDF"
            ),
            source="moveit/srdfdom e23af6e, src/model.cpp:166",
            sentence="A group of the SRDF names a joint that the robot does not have.",
            example="Joint 'elbw' declared as part of group 'arm' is not known to the URDF",
            within=("joint",),
        ),
        INTERFACE_MISSING,
        INTERFACES_NOT_ACCEPTED,
        INTERFACE_NOT_AVAILABLE,
    ),
    wrong="""
joint_limits:
  arm_jiont: {has_velocity_limits: true, max_velocity: 0.9}
""",
    right="""
joint_limits:
  arm_joint: {has_velocity_limits: true, max_velocity: 0.9}
""",
    frame="joint_limits.yaml",
    beside={
        "arm/rover.urdf": "",
    },
)

_GROUP_DEFINED = Rule(
    "group-defined",
    "frames",
    NO_FRAME,
    "The groups that files name are in the SRDF.",
    why=(
        "MoveIt looks up solvers and planners by the name of the group. Settings under another "
        "name have no effect, and a group may have no kinematics solver."
    ),
    symptoms=(
        Symptom(
            "group-unknown",
            pattern=r"Group '(?P<group>[^']{1,200}+)' not found in model",
            source="moveit/moveit2 8fcb5d232, moveit_core/robot_model/src/robot_model.cpp:517",
            sentence="Code or a file names a group that the SRDF does not have.",
            example="Group 'manipulater' not found in model 'cell'",
            within=("group",),
        ),
    ),
    wrong="""
arms:
  kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin
""",
    right="""
arm:
  kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin
""",
    frame="kinematics.yaml",
    beside={
        "arm/rover.urdf": "",
        "rover.srdf": "",
    },
)

_CONTROLLER_DEFINED = Rule(
    "controller-defined",
    "controllers",
    NO_CONTROLLER,
    "The controllers that files name are defined.",
    why=(
        "The controller manager prints that the 'type' param was not defined, the spawner ends "
        "with an error, and the controller is not loaded."
    ),
    symptoms=(
        CONTROLLER_NOT_LOADED,
        ACTION_NOT_CONNECTED,
    ),
    wrong="""
Node(package='controller_manager', executable='ros2_control_node', parameters=[controllers]),
Node(package='controller_manager', executable='spawner', arguments=['arm_contoller']),
""",
    right="""
Node(package='controller_manager', executable='ros2_control_node', parameters=[controllers]),
Node(package='controller_manager', executable='spawner', arguments=['arm_controller']),
""",
    frame="control/rover.launch.py",
    beside={
        "arm/rover.urdf": "",
        "arm/controllers.yaml": "",
    },
)

_PARAMETER_DEFINED = Rule(
    "parameter-defined",
    "parameters",
    NO_PARAMETER,
    "A node declares the parameters that it is given and those that its code reads.",
    why=(
        "ROS 2 ignores a value for an undeclared parameter without a message, so the default "
        "counts. Code that reads one stops with ParameterNotDeclaredException."
    ),
    symptoms=(
        Symptom(
            "parameter-undeclared",
            pattern=(
                r"Invalid access to undeclared parameter\(s\): \[?'?(?P<parameter>[\w.-]{1,200}+)"
            ),
            source="ros2/rclpy ba72a01, rclpy/rclpy/exceptions.py:90",
            sentence="Code reads a parameter that the node does not declare.",
            example=(
                "rclpy.exceptions.ParameterNotDeclaredException: Invalid access to undeclared "
                "parameter(s): speed"
            ),
            within=("parameter",),
        ),
    ),
    wrong="Node(package='rover', executable='joystick', parameters=[{'sped': 2.0}]),",
    right="Node(package='rover', executable='joystick', parameters=[{'speed': 2.0}]),",
    beside={
        "joystick.py": "",
    },
)

_PLUGIN_SECTION = Rule(
    "plugin-section",
    "parameters",
    NO_PARAMETER,
    "The plugins of a list have a section beside it.",
    why=(
        "Nav2 reads the class of a plugin from its section. Without it the node prints that it "
        "cannot get the 'plugin' param and stops; a sensor source keeps defaults."
    ),
    symptoms=(
        Symptom(
            "plugin-without-type",
            pattern=r"Can not get 'plugin' param value for (?P<plugin>[\w.-]{1,200}+)",
            source=(
                "ros-navigation/navigation2 a3a97043e, nav2_ros_common/include/nav2_ros_common/"
                "node_utils.hpp:338"
            ),
            sentence="A plugin of a list has no section with its class.",
            example="Can not get 'plugin' param value for FollowPath",
            within=("plugin",),
        ),
    ),
    wrong="""
plugins: [obstacles]
obstacle_layer:
  plugin: nav2_costmap_2d::ObstacleLayer
""",
    right="""
plugins: [obstacle_layer]
obstacle_layer:
  plugin: nav2_costmap_2d::ObstacleLayer
""",
    frame="costmap.yaml",
)

_LAUNCH_ARGUMENT = Rule(
    "launch-argument",
    "arguments",
    NO_ARGUMENT,
    "The arguments that an include passes are declared.",
    why=(
        "An include accepts unknown arguments without a message. The included file uses its "
        "default, such as another world or no simulated time."
    ),
    symptoms=(
        Symptom(
            "launch-argument-missing",
            pattern=(
                r"Included launch description missing required argument "
                r"'(?P<argument>[^']{1,200}+)\'"
            ),
            source="ros2/launch 02595baf, launch/launch/actions/include_launch_description.py:174",
            sentence="An include does not pass an argument that has no default.",
            example=(
                "Included launch description missing required argument 'world' (description: 'no "
                "description given'), given: []"
            ),
            within=("argument",),
        ),
    ),
    wrong="""
IncludeLaunchDescription(
    os.path.join(gazebo, 'launch', 'gz_sim.launch.py'),
    launch_arguments={'gz_arg': '-r empty.sdf'}.items(),
),
""",
    right="""
IncludeLaunchDescription(
    os.path.join(gazebo, 'launch', 'gz_sim.launch.py'),
    launch_arguments={'gz_args': '-r empty.sdf'}.items(),
),
""",
)

_XACRO_ARGUMENT = Rule(
    "xacro-argument",
    "arguments",
    NO_ARGUMENT,
    "The arguments that xacro gets are declared.",
    why=(
        "xacro accepts unknown arguments without a message. The robot is built with its "
        "defaults, and the value has no effect."
    ),
    wrong="""
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node

def generate_launch_description():
    file = os.path.join(get_package_share_directory('rover'), 'urdf', 'base.xacro')
    robot = Command(['xacro ', file, ' prefx:=a_'])
    return LaunchDescription([Node(
        package='robot_state_publisher', executable='robot_state_publisher',
        parameters=[{'robot_description': robot}],
    )])
""",
    right="""
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node

def generate_launch_description():
    file = os.path.join(get_package_share_directory('rover'), 'urdf', 'base.xacro')
    robot = Command(['xacro ', file, ' prefix:=a_'])
    return LaunchDescription([Node(
        package='robot_state_publisher', executable='robot_state_publisher',
        parameters=[{'robot_description': robot}],
    )])
""",
    frame="xacro.launch.py",
    beside={
        "base.xacro": """
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="prefix" default=""/>
  <link name="$(arg prefix)base_link"/>
</robot>
""",
    },
)

_NODE_STARTED = Rule(
    "node-started",
    "programs",
    NO_PROGRAM,
    "A launch file starts the nodes that a lifecycle manager manages.",
    why=(
        "The lifecycle manager waits for the services of a node that nothing starts. It "
        "activates no node, so Nav2 does not start."
    ),
    symptoms=(
        Symptom(
            "bringup-failed",
            pattern=r"Failed to change state for node: (?P<node>[\w/]{1,200}+)",
            source=(
                "ros-navigation/navigation2 a3a97043e, nav2_lifecycle_manager/src/"
                "lifecycle_manager.cpp:306"
            ),
            sentence="A server of Nav2 could not be started, and has said why before.",
            example="Failed to change state for node: planner_server",
            within=("node",),
            follows=True,
        ),
        Symptom(
            "state-awaited",
            pattern=(
                r"(?:Waiting for service )?(?P<node>[\w-]{1,200}+)/get_state(?: service client: "
                r"waiting for service|\.\.\.)"
            ),
            source=(
                "ros-navigation/navigation2 a3a97043e, nav2_ros_common/include/nav2_ros_common/"
                "service_client.hpp:98"
            ),
            sentence="A lifecycle manager waits for a node that is not started.",
            example="planner_server/get_state service client: waiting for service to appear...",
            within=("node",),
        ),
    ),
    wrong="""
Node(package='nav2_map_server', executable='map_server', name='map_server'),
Node(
    package='nav2_lifecycle_manager',
    executable='lifecycle_manager',
    parameters=[{'node_names': ['mapserver']}],
),
""",
    right="""
Node(package='nav2_map_server', executable='map_server', name='map_server'),
Node(
    package='nav2_lifecycle_manager',
    executable='lifecycle_manager',
    parameters=[{'node_names': ['map_server']}],
),
""",
)

_TOPIC_DEFINED = Rule(
    "topic-defined",
    "topics",
    NO_TOPIC,
    "A node has the topic that a remapping replaces, and what code reads is published.",
    why=(
        "A remapping without a match changes nothing and prints nothing. The node keeps its own"
        " topic, and no message arrives on the other name."
    ),
    wrong="""
Node(package='rover', executable='joystick', remappings=[('cmd_vell', 'drive/cmd_vel')]),
""",
    right="""
Node(package='rover', executable='joystick', remappings=[('cmd_vel', 'drive/cmd_vel')]),
""",
    beside={
        "joystick.py": "",
    },
)

# What is wrong where a name of a kind is not defined.
DEFINED: Mapping[DefinedKind, Rule] = {
    "frame": _FRAME_DEFINED,
    "link": _LINK_DEFINED,
    "joint": JOINT_DEFINED,
    "group": _GROUP_DEFINED,
    "controller": _CONTROLLER_DEFINED,
    "plugin section": _PLUGIN_SECTION,
    "parameter": _PARAMETER_DEFINED,
    "launch argument": _LAUNCH_ARGUMENT,
    "xacro argument": _XACRO_ARGUMENT,
    "node": _NODE_STARTED,
    "topic": _TOPIC_DEFINED,
}


class Definition(NamedTuple):
    """A name that a file defines.

    Those of one kind agree within one owner only, such as the arguments of a file. What is of one
    of several robots has the path of that robot.
    """

    kind: DefinedKind
    name: str
    location: Location
    owner: str = ""
    robot: str = ""


class Use(Named):
    """A name that a file uses, and what the file calls it.

    Where it is `optional`, only a similar name is wrong. It does not stand for one that is `taken`,
    such as another entry of the list that it is in, nor for that of another robot than `robots`.
    """

    kind: DefinedKind
    name: str
    location: Location
    said: str
    owner: str = ""
    optional: bool = False
    taken: frozenset[str] = frozenset()
    robots: ComparedRobots | None = None  # None for all


class Open(Named):
    """That names of a kind may be defined elsewhere.

    They may be defined by what is not in the workspace, or, for a reason, by what is not
    evaluated.
    """

    kind: DefinedKind
    owner: str = ""
    reason: str = ""


class Pattern(Named):
    """That names of a kind may be defined that are not known; * stands for a part of them."""

    kind: DefinedKind
    pattern: str


class Correction(Named):
    """Another name in a file.

    The old one is at a place, behind it in the same element, or the key before it.
    """

    location: Location
    old: str
    new: str


class Mismatch(Named):
    """Something that does not agree.

    It is a warning, and fails no criterion, unless it certainly fails at run time.
    """

    rule: Rule
    message: str
    location: Location
    related: Location | None = None  # of what was meant
    is_certain: bool = True
    corrections: tuple[
        Correction, ...
    ] = ()  # with each of which it agrees: first of the use, then of the definition
    fixes: Fixes = NO_FIXES  # of what is no name
    word: str = ""  # that is wrong, in the call or element at the location
    cause: str = ""  # what it has in common with others that one mistake makes
    lacked: str = ""  # the package that package.xml lacks, and is to be added
    tag: str = "exec_depend"  # with which package.xml is to declare that package
    names: Strings = ()  # by which a message of a log may mean it
    offered: tuple[Correction, ...] = ()  # in an editor; hints and grades have only corrections

    def offering(self, old: str, new: str | None, at: Location | None = None) -> "Mismatch":
        """Return it with an edit that its message names; without an old text it is an element.

        An element is added to the package.xml at the place. Nothing is offered without a new text.
        """
        correction = Correction(at or self.location, old, new or "")
        return self._replace(offered=(correction,)) if new else self

    def correcting(
        self, name: str, meant: str | None, defined: Location | None = None
    ) -> "Mismatch":
        """Return it with what makes it agree: `corrections` of a name at its place."""
        return self._replace(corrections=corrections(name, self.location, meant, defined))

    def meaning(self, name: str, meant: str | None, defined: Location | None = None) -> "Mismatch":
        """Return it with the name that is meant, if that is known, which its message asks for."""
        if meant is None:
            return self
        place = f" ({defined.file_and_line})" if defined else ""
        asking = self._replace(message=f"{self.message}; did you mean {quoted(meant)}{place}?")
        return asking.correcting(name, meant, defined)

    @property
    def family(self) -> AnyFamily:
        """The family of names_agree to which the rule belongs."""
        return self.rule.family


def warning(rule: Rule, message: str, at: Location, related: Location | None = None) -> Mismatch:
    """Return something that does not agree, and may be meant so."""
    return Mismatch(rule, message, at, related, is_certain=False)


class Compared(Named):
    """That something of a family is there to be compared; of a file its path below the prefix."""

    family: AnyFamily
    name: str = ""


class Undecided(Named):
    """That the names of a family are not compared, and why."""

    family: AnyFamily
    reason: str


class Counted(Named):
    """How many names of a family are compared with a counterpart, and why not all are known."""

    family: AnyFamily
    compared: int
    total: int
    reason: str = ""  # empty where all names are known

    @property
    def words(self) -> str:
        """Return the count, where some names are not known; else an empty text."""
        if not self.reason:
            return ""
        if not self.total:
            return f"no name compared: {self.reason}"
        return f"{self.compared} of {counted(self.total, 'name')} compared: {self.reason}"


Fact = Definition | Use | Open | Pattern | Mismatch | Compared | Undecided | Counted
# What the readers of rules yield.
Facts = Iterator[Fact]
Mismatches = Iterator[Mismatch]


class Agreement(Named):
    """What does not agree in a workspace, and for each family why something is not known."""

    mismatches: tuple[Mismatch, ...]
    undecided: Mapping[AnyFamily, str]
    families: frozenset[AnyFamily]  # of which something is compared
    files: frozenset[str]  # the paths below the prefix at which files are looked for
    counts: Mapping[AnyFamily, Counted]
    unused: tuple[Location, ...] = ()  # the files that no other one names

    def holds(self, family: AnyFamily) -> bool:
        """Return whether something of a family is compared, and all of it certainly agrees."""
        is_wrong = any(
            mismatch.family == family and mismatch.is_certain for mismatch in self.mismatches
        )
        return family in self.families and family not in self.undecided and not is_wrong


def uncompared(facts: Iterable[Fact], reason: str) -> Agreement:
    """Return the mismatches among facts that are not all known, and why no more is compared.

    The reason is given for each family.
    """
    mismatches = [fact for fact in facts if isinstance(fact, Mismatch)]
    families = frozenset(fact.family for fact in mismatches)
    return Agreement(
        _in_order(mismatches), dict.fromkeys(FAMILIES, reason), families, frozenset(), {}
    )


def agreement(facts: Iterable[Fact], charge: Callable[[int], None] = lambda _: None) -> Agreement:
    """Return which of the names that are used are not defined, in the order of their places.

    The work of comparing names is charged.
    """
    every = list(facts)
    names = _DefinedNames(every)
    mismatches = [fact for fact in every if isinstance(fact, Mismatch)]
    counts = {fact.family: fact for fact in every if isinstance(fact, Counted)}
    undecided = _undecided(every, counts.values())
    compared, files = _compared(every)
    for use in [fact for fact in every if isinstance(fact, Use)]:
        family = DEFINED[use.kind].family
        if names.compares(use):
            compared.add(family)
        charge(1 + len(names.patterns))
        # A name in a file with which no robot has to do may be that of any robot.
        is_open = use.robots is not None and not use.robots.robots
        if is_open or names.holds(use) or names.may_hold(use):
            continue
        mismatches += _undefined(names, use, charge)
        if names.why_open(use):
            undecided.setdefault(family, names.why_open(use))
    return Agreement(_in_order(mismatches), undecided, frozenset(compared), files, counts)


def _undefined(names: "_DefinedNames", use: Use, charge: Callable[[int], None]) -> Mismatches:
    """Yield that a name is not defined, unless what is not known may define it."""
    known = names.like(use)
    if use.taken:
        known = {name: at for name, at in known.items() if name not in use.taken}
    charge(cost_of_guess(len(known)))
    mismatch = _mismatch(use, known, is_open=names.are_open(use))
    if mismatch:
        yield mismatch


def _compared(facts: Iterable[Fact]) -> tuple[set[AnyFamily], frozenset[str]]:
    """Return of which families something is compared, and the files that are looked for."""
    families = set()
    files = set()
    for fact in facts:
        if isinstance(fact, Compared | Mismatch):
            families.add(fact.family)
        if isinstance(fact, Compared) and fact.name:
            files.add(fact.name)
    return families, frozenset(files)


class _DefinedNames:
    """The names that files define, and which others may be defined."""

    def __init__(self, facts: Iterable[Fact]) -> None:
        self.patterns = []
        # By kind and owner; each name with the robots that have it, and the place in each.
        self._known: dict[tuple[DefinedKind, str], dict[str, dict[str, Location]]] = {}
        self._reasons: dict[tuple[DefinedKind, str], str] = {}  # why names are open
        for fact in facts:
            match fact:
                case Definition():
                    names = self._known.setdefault((fact.kind, fact.owner), {})
                    names.setdefault(fact.name, {}).setdefault(fact.robot, fact.location)
                case Open():
                    before = self._reasons.get((fact.kind, fact.owner))
                    self._reasons[fact.kind, fact.owner] = before or fact.reason
                case Pattern():
                    self.patterns.append(fact)

    def like(self, use: Use) -> Mapping[str, Location]:
        """Return the names that are defined of the kind, the owner and the robots of a use."""
        similar: dict[str, Location] = {}
        for name, places in self._known.get((use.kind, use.owner), {}).items():
            for robot, place in places.items():
                if not use.robots or not robot or robot in use.robots.paths:
                    similar.setdefault(name, place)
        return similar

    def compares(self, use: Use) -> bool:
        """Return whether it is certain that a name is defined, or that it has to be."""
        return self.holds(use) or not (use.optional or self.are_open(use))

    def holds(self, use: Use) -> bool:
        """Return whether a name is defined, by a robot that counts or by none."""
        places = self._known.get((use.kind, use.owner), {}).get(use.name, {})
        if not use.robots or not use.robots.are_started:
            return bool(places)
        return "" in places or not use.robots.paths.isdisjoint(places)

    def may_hold(self, use: Use) -> bool:
        """Return whether a name is computed, or one that may be defined."""
        possible = (each.pattern for each in self.patterns if each.kind == use.kind)
        return "$" in use.name or any(fnmatchcase(use.name, pattern) for pattern in possible)

    def are_open(self, use: Use) -> bool:
        """Return whether other names of its kind may be defined."""
        return (use.kind, use.owner) in self._reasons

    def why_open(self, use: Use) -> str:
        """Return why names of its kind are not evaluated; empty where they are, or need not be."""
        return self._reasons.get((use.kind, use.owner), "")


def _in_order(mismatches: Iterable[Mismatch]) -> tuple[Mismatch, ...]:
    """Return mismatches, each once, in the order of their places."""
    by_place: dict[tuple[str, int, int], list[Mismatch]] = {}
    for mismatch in dict.fromkeys(mismatches):
        at = mismatch.location
        by_place.setdefault((at.path, at.line, at.column), []).append(mismatch)
    return tuple(chain.from_iterable(by_place[place] for place in sorted(by_place)))


def charge_guess(workspace: Workspace, known: Sized) -> None:
    """Charge the work of comparing a name with known ones. Raises NotDecided."""
    workspace.charge(cost_of_guess(len(known)))


def cost_of_guess(known: int) -> int:
    """Return the parts of comparing a name with as many known ones.

    The most similar text is searched among the first of them.
    """
    return 3 * min(known, _MAX_NEAR) + 20 * min(known, _MAX_SIMILAR)


def _undecided(facts: Sequence[Fact], counts: Iterable[Counted]) -> dict[AnyFamily, str]:
    """Return the families whose names are not compared, and why: the first reason of each."""
    undecided = {
        fact.family: fact.reason for fact in reversed(facts) if isinstance(fact, Undecided)
    }
    for count in counts:
        if count.reason and not count.compared:
            undecided.setdefault(count.family, count.words)
    return undecided


def _mismatch(use: Use, known: Mapping[str, Location], *, is_open: bool) -> Mismatch | None:
    """Return what is wrong with a name that is not defined, as far as it is known what is."""
    meant = near(use.name, known, "link" if use.kind == "frame" else use.kind)
    if meant is None and not is_open:
        meant = closest(use.name, known, is_clear=True)
    if meant is None and (is_open or use.optional):
        return None
    where = use.robots.words if use.robots else ""
    message = f"{use.said}: there is no {use.kind} {quoted(use.name)}{where}"
    related = known[meant] if meant is not None else None
    rule = DEFINED[use.kind]
    wrong = Mismatch(rule, message, use.location, related, not is_open, word=use.name)
    return wrong.meaning(use.name, meant, related)


def among(fact: Fact, compared: ComparedRobots) -> Fact:
    """Return a fact in which a name is compared with those of some robots.

    A joint is one of the robots that are started. A frame may be published by what is not read, so
    that it is right if any robot has it.
    """
    if not isinstance(fact, Use):
        return fact
    if fact.kind != "joint":
        compared = compared._replace(are_started=False)
    return fact._replace(robots=compared)


def corrections(
    name: str, at: Location, meant: str | None, defined: Location | None = None
) -> tuple[Correction, ...]:
    """Return that a name becomes the one that is meant, or the reverse.

    There are none for names of two sides or numbers.
    """
    if meant is None or not (are_of_one_side(name, meant) or near(name, [meant])):
        return ()
    return (
        Correction(at, name, meant),
        *([Correction(defined, meant, name)] if defined else []),
    )
