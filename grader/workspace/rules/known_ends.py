"""Topics of well-known programs and displays, compared with what is published there.

It is compared whether they have the type of these, whether inputs are published at all, and
whether remappings replace names that they have.
"""

from collections.abc import Mapping, Sequence

from grader.base.names import near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.known.end_rows import opened_ends
from grader.ros.known.package_rows import ProgramRow
from grader.ros.known.package_tables import display_types
from grader.ros.known.releases import RELEASES
from grader.ros.launch.launch_model import StartedNode
from grader.workspace.graph.code_ends import End
from grader.workspace.graph.graph import grouped, make_graph
from grader.workspace.graph.node_ends import KnownProgram, programs_in
from grader.workspace.graph.opened_by_programs import ends_of_row
from grader.workspace.graph.rviz_ends import list_rviz_files
from grader.workspace.graph.unread_ends import Sought, may_be_opened
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_COMPANION,
    NO_WORD,
    Rule,
)

_INPUT = on_use(r"([a-z]+)\d+")
_DEFAULT_DISPLAYS = "rviz_default_plugins"
_CLASSIC = "libgazebo_ros_"  # how the names of plugins of Gazebo Classic begin, which publish


class _Input(Named):
    """A topic that a program reads, and its type."""

    reader: str  # the parameter that names it, or the program
    topic: str
    type: str
    location: Location


_ByTopic = Mapping[str, Sequence[End]]  # the ends that publish a topic


def known_end_facts(workspace: Workspace) -> Facts:
    """Yield topics that well-known programs and displays cannot read, and wrong names.

    A wrong name is one that the program or display does not have.
    """
    graph = make_graph(workspace)
    published = graph.certain("publisher", "code", "controller", "bridge", "program")
    published = [end for end in published if end.type is not None]
    by_launch = grouped(published, lambda end: end.launch)
    for program in programs_in(workspace):
        by_topic = grouped(by_launch.get(program.launch, ()), lambda end: end.name)
        inputs = _inputs(workspace, program)
        yield from (Compared("wiring") for _ in inputs)
        yield from _other_types(workspace, program, inputs, by_topic)
        yield from _not_published(workspace, program.node, inputs, by_topic)
        yield from _other_remappings(program.node, program.row)
    yield from _displays(workspace, grouped(published, lambda end: end.name))


def _other_type(published: Sequence[End], wanted: str) -> End | None:
    """Return what is published with another type, if nothing is with the one that is wanted."""
    if any(each.type == wanted for each in published):
        return None
    return next(iter(published), None)


_INPUT_TYPE = Rule(
    "input-type",
    "wiring",
    NO_COMPANION,
    "A well-known program reads a topic with the type that it has.",
    why=(
        "The program subscribes with its own type and is not matched with the publisher. It "
        "receives no message and publishes no result."
    ),
    wrong="""
Node(package='rover', executable='camera'),
Node(package='pointcloud_to_laserscan', executable='pointcloud_to_laserscan_node',
     remappings=[('cloud_in', '/depth')]),
""",
    right="""
Node(package='rover', executable='camera'),
Node(package='depthimage_to_laserscan', executable='depthimage_to_laserscan_node',
     remappings=[('depth', '/depth')]),
""",
    beside={
        "camera.py": "",
    },
)


def _other_types(
    workspace: Workspace,
    program: KnownProgram,
    inputs: Sequence[_Input],
    published: _ByTopic,
) -> Facts:
    """Yield the topics that a program reads and that are published with another type only.

    The program reads them by itself, or as its parameters say.
    """
    node = program.node
    read = []
    for name, wanted in program.row.subscriptions.items():
        topic = node.topic(name) or ""
        if topic in published:
            yield Compared("wiring")
        read.append(_Input(node.executable, topic, wanted, node.location))
    topics = {each.topic for each in (*read, *inputs)}
    others = [each for each in _opened(workspace, program) if each.topic not in topics]
    for each in (*read, *inputs, *others):
        other = _other_type(published.get(each.topic, ()), each.type)
        if other:
            message = (
                f"{each.reader} reads {each.topic} with {each.type}, but it is published with "
                f"{other.type} ({other.location.file_and_line})"
            )
            yield warning(_INPUT_TYPE, message, each.location, other.location)


def _opened(workspace: Workspace, program: KnownProgram) -> Sequence[_Input]:
    """Return what a program certainly subscribes to, in each release that may be meant."""
    node = program.node
    row = opened_ends(*node.program)
    if not row:
        return ()
    given = workspace.parameters.given_to(program.package, node)
    opened = []
    for release in workspace.releases or RELEASES:
        ends = ends_of_row(row, node, given, release)
        subscriptions = [end for end in ends if end.kind == "subscription" and not end.doubt]
        workspace.charge(1 + len(subscriptions))
        opened.append(
            {
                _Input(node.executable, end.name, end.type.replace("/", "."), end.location)
                for end in subscriptions
                if end.type
            }
        )
    return sorted(set.intersection(*opened))


def _inputs(workspace: Workspace, program: KnownProgram) -> list[_Input]:
    """Return the topics that parameters of a program name, such as `odom0` of an ekf_node."""
    row = program.row
    if not row.inputs:
        return []
    inputs = []
    parameters = workspace.parameters.given_to(program.package, program.node)
    for name, given in parameters.values.items():
        numbered = _INPUT.fullmatch(name)
        if not numbered or numbered[1] not in row.inputs or not isinstance(given.value, str):
            continue
        topic = program.node.topic(given.value)
        if topic is not None:
            inputs.append(_Input(name, topic, row.inputs[numbered[1]], given.location))
    return inputs


_INPUT_PUBLISHED = Rule(
    "input-published",
    "wiring",
    NO_COMPANION,
    "The topic that a parameter names is published.",
    why=(
        "The node starts without an error and never gets the input. A filter estimates without "
        "that sensor, or publishes nothing."
    ),
    wrong="""
Node(package='rover', executable='odometry'),
Node(package='robot_localization', executable='ekf_node', parameters=[{'odom0': 'wheel_odom'}]),
""",
    right="""
Node(package='rover', executable='odometry'),
Node(package='robot_localization', executable='ekf_node', parameters=[{'odom0': 'wheels/odom'}]),
""",
    beside={
        "odometry.py": "",
    },
)


def _not_published(
    workspace: Workspace, node: StartedNode, inputs: Sequence[_Input], published: _ByTopic
) -> Mismatches:
    """Yield the inputs that nothing publishes, while others publish one that is not read.

    Others publish one other topic of their type that the node does not read.
    """
    topics = {each.topic for each in inputs}
    for each in inputs:
        if each.topic in published or _may_be_published(workspace, each.topic):
            continue
        meant = _only_unread(workspace, node, each.type, published, topics)
        if meant:
            message = (
                f"{each.reader} reads {each.topic}, which nothing publishes; did you mean "
                f"{meant.name} ({meant.location.file_and_line})?"
            )
            wrong = warning(_INPUT_PUBLISHED, message, each.location, meant.location)
            yield wrong.offering(each.topic, meant.name)


def _only_unread(
    workspace: Workspace, node: StartedNode, wanted: str, published: _ByTopic, read: set[str]
) -> End | None:
    """Return what others than a node publish with a type, and it does not read.

    The result is None if that is not one topic.
    """
    workspace.charge(len(published))
    of_type = []
    for ends in published.values():
        of_type += [end for end in ends if end.type == wanted]
    topics = {end.name for end in of_type if end.location != node.location} - read
    if len(topics) != 1:
        return None
    return next(end for end in of_type if end.name in topics)


def _may_be_published(workspace: Workspace, topic: str) -> bool:
    """Return whether something that is not read may publish a topic."""
    for robot in workspace.robots.known:
        if any(_CLASSIC in tag.get("filename", "") for tag in robot.root.iter("plugin")):
            return True
    # Programs of other packages know the type, also where the workspace has its package.
    return may_be_opened(workspace, Sought("publisher", topic, None))


_REMAPPED_TOPIC = Rule(
    "remapped-topic",
    "words",
    NO_WORD,
    "A remapping of a well-known program names a topic that it has.",
    why=(
        "A remapping without a match does nothing and prints nothing. The program waits on its "
        "own topic and gets no message."
    ),
    wrong="""
Node(package='depthimage_to_laserscan', executable='depthimage_to_laserscan_node',
     remappings=[('depht', '/camera/depth')]),
""",
    right="""
Node(package='depthimage_to_laserscan', executable='depthimage_to_laserscan_node',
     remappings=[('depth', '/camera/depth')]),
""",
)


def _other_remappings(node: StartedNode, row: ProgramRow) -> Mismatches:
    """Yield the remappings of names that surely stand for one that a program has.

    What has a colon, or begins with __, is no topic.
    """
    names = [*row.subscriptions, *row.publishers, *row.names]
    replaced = [rule[0].removeprefix("~/").strip("/") for rule in node.remaps or ()]
    left = [name for name in names if name not in replaced]
    plain = {name.replace("_", ""): name for name in left}
    for written in replaced:
        if written in names or ":" in written or written.startswith("__"):
            continue
        meant = plain.get(written.replace("_", "")) or near(written, left)
        if meant is not None:
            message = (
                f"{node.executable} has no topic {quoted(written)}, so its remapping does nothing; "
                f"did you mean {meant}?"
            )
            yield warning(_REMAPPED_TOPIC, message, node.location).offering(written, meant)


_DISPLAY_TYPE = Rule(
    "display-type",
    "wiring",
    NO_COMPANION,
    "A display of RViz reads a topic with the type that it has.",
    why=(
        "The display is never matched with the publisher, so it stays empty although ros2 topic"
        " hz shows messages."
    ),
    wrong="""
- {Class: rviz_default_plugins/LaserScan, Name: Depth, Enabled: true, Topic: {Value: /depth}}
""",
    right="""
- {Class: rviz_default_plugins/Image, Name: Depth, Enabled: true, Topic: {Value: /depth}}
""",
    frame="show/rover.rviz",
    beside={
        "camera.py": "",
    },
)


def _displays(workspace: Workspace, published: _ByTopic) -> Mismatches:
    """Yield displays of RViz that read other messages than are published."""
    for file in list_rviz_files(workspace):
        for display in file.displays:
            is_default = display.package == _DEFAULT_DISPLAYS
            wanted = display_types().get(display.kind) if is_default else None
            topic = display.node.get("Topic", "Value")
            if wanted is None or not topic or not display.enabled:
                continue
            other = _other_type(published.get(topic.text or "", ()), wanted)
            if other:
                message = (
                    f"the display {quoted(display.name)} reads {wanted}, but {topic.text} is "
                    f"published with {other.type} ({other.location.file_and_line})"
                )
                yield warning(_DISPLAY_TYPE, message, topic.location, other.location)
