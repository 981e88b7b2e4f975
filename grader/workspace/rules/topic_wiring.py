"""Topics that connect, and yet no message arrives as it should.

Two sources send commands, images have another transport, displays of RViz ask for more, or
programs send another type.
"""

from collections.abc import Collection, Mapping, Sequence
from itertools import chain

from grader.base.names import first_part
from grader.base.text import quoted
from grader.ros.config.rviz import Display
from grader.ros.known.package_tables import transport_types
from grader.workspace.graph.code_ends import End
from grader.workspace.graph.graph import Graph, make_graph
from grader.workspace.graph.launch_graph import GraphEnd, GraphNode, LaunchGraph
from grader.workspace.graph.node_ends import deciding_parameter
from grader.workspace.graph.rviz_ends import list_rviz_files
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Facts, Mismatches, warning
from grader.workspace.rules.rule_table import (
    NO_COMPANION,
    Rule,
)
from grader.workspace.rules.shared_symptoms import INCOMPATIBLE_QUALITY

_COMMANDS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_IMAGE = "sensor_msgs.msg.Image"


def topic_wiring_facts(workspace: Workspace) -> Facts:
    """Yield topics on which messages do not arrive as they should."""
    graph = make_graph(workspace)
    publishers = graph.certain("publisher", "code")
    subscriptions = graph.certain("subscription", "code")
    for launched in graph.launched:
        yield from _two_commanders(workspace, launched)
    yield from _other_transport(publishers, subscriptions)
    yield from _displays(workspace, publishers)
    yield from _programs(graph)


_ONE_COMMANDER = Rule(
    "one-commander",
    "wiring",
    NO_COMPANION,
    "One node commands the robot.",
    why=(
        "The robot obeys each message in turn: it jerks between two speeds, and the next "
        "command of the other node cancels a stop."
    ),
    wrong="self.commands = self.create_publisher(Twist, 'cmd_vel', 10)",
    right="""
self.commands = self.create_publisher(Twist, 'pilot/commands', 10)  # an input of twist_mux
""",
    frame="start/pilot.py",
    beside={
        "joystick.py": "",
        "motors.py": "",
    },
    at="rover/joystick.py",
)


def _two_commanders(workspace: Workspace, graph: LaunchGraph) -> Mismatches:
    """Yield the topics of commands that two nodes of own code publish, and something obeys."""
    own_packages = workspace.own_packages
    obeyed = set()
    commands = []
    for node in graph.nodes:
        workspace.charge(1 + len(node.ends))
        is_own = first_part(node.program) in own_packages
        for end in node.ends:
            if node.doubt or end.doubt or end.type not in _COMMANDS:
                continue
            if end.kind == "subscription":
                obeyed.add(end.name)
            elif is_own:
                commands.append((node, end))
    first: dict[str, tuple[GraphNode, GraphEnd]] = {}
    said = set()
    for node, end in commands:
        other, before = first.setdefault(end.name, (node, end))
        if other is not node and end.name in obeyed and end.name not in said:
            said.add(end.name)
            message = (
                f"{node.label} and {other.label} both publish {end.name}: the robot obeys each "
                "in turn; twist_mux chooses one"
            )
            yield warning(_ONE_COMMANDER, message, end.location, before.location)


_IMAGE_TRANSPORT = Rule(
    "image-transport",
    "wiring",
    NO_COMPANION,
    "Images are read from the topic that carries them.",
    why=(
        "The topic carries compressed images, which are messages of another type. The "
        "subscription is not matched, so no image arrives."
    ),
    wrong="self.create_subscription(Image, 'image/compressed', self.receive, 10)",
    right="self.create_subscription(CompressedImage, 'image/compressed', self.receive, 10)",
    frame="start/pilot.py",
)


def _other_transport(publishers: Sequence[End], subscriptions: Sequence[End]) -> Mismatches:
    """Yield subscriptions of images on a topic that carries compressed ones."""
    published = {publisher.name for publisher in publishers}
    for each in subscriptions:
        topic, _, transport = each.name.rpartition("/")
        kind = transport_types().get(transport)
        if kind is None or each.type != _IMAGE or each.name in published:
            continue
        message = (
            f"the topic {each.name} carries {kind}, and is subscribed to with {_IMAGE}: "
            f"subscribe to {topic}, or with the other type"
        )
        yield warning(_IMAGE_TRANSPORT, message, each.location)


def _displays(workspace: Workspace, publishers: Sequence[End]) -> Mismatches:
    """Yield displays of RViz that ask for reliable messages of best-effort publishers.

    Every publisher of the topic sends as best effort.
    """
    offered: dict[str, set[str | None]] = {}
    for each in publishers:
        offered.setdefault(each.name, set()).add(each.endpoint.qos.reliability)
    for display in chain.from_iterable(file.displays for file in list_rviz_files(workspace)):
        if display.enabled:
            yield from _other_reliability(display, offered)


_DISPLAY_QUALITY = Rule(
    "display-quality",
    "wiring",
    NO_COMPANION,
    "A display of RViz asks for no more than is offered.",
    why=(
        "A best effort publisher is not matched with a reliable subscription. RViz prints a "
        "warning of incompatible QoS, and the display stays empty."
    ),
    symptoms=(INCOMPATIBLE_QUALITY,),
    wrong="""
- Class: rviz_default_plugins/Image
  Name: Image
  Enabled: true
  Topic: {Value: /image, Reliability Policy: Reliable}
""",
    right="""
- Class: rviz_default_plugins/Image
  Name: Image
  Enabled: true
  Topic: {Value: /image, Reliability Policy: Best Effort}
""",
    frame="show/rover.rviz",
    beside={
        "start/pilot.py": """
best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
self.images = self.create_publisher(Image, 'image', best_effort)
""",
    },
)


def _other_reliability(
    display: Display, offered: Mapping[str, Collection[str | None]]
) -> Mismatches:
    """Yield that a display asks for reliable messages, which are published as best effort."""
    policy = display.node.get("Topic", "Reliability Policy")
    topic = display.node.get("Topic", "Value")
    if policy is None or topic is None:
        return
    if policy.text == "Reliable" and offered.get(topic.text or "") == {"best_effort"}:
        message = (
            f"the display {quoted(display.name)} asks for reliable messages of "
            f"{topic.text}, which are published as best effort: it stays empty"
        )
        yield warning(_DISPLAY_QUALITY, message, policy.location)


_COMMAND_TYPE = Rule(
    "command-type",
    "wiring",
    NO_COMPANION,
    "A well-known program sends a controller the type that it reads.",
    why=(
        "The controller is not matched with the program. Keys or buttons publish commands, but "
        "the robot does not move, and no error is printed."
    ),
    wrong="""
Node(package='teleop_twist_keyboard', executable='teleop_twist_keyboard', prefix='xterm -e',
     remappings=[('cmd_vel', '/drive_controller/cmd_vel')]),
""",
    right="""
Node(package='teleop_twist_keyboard', executable='teleop_twist_keyboard', prefix='xterm -e',
     remappings=[('cmd_vel', '/drive_controller/cmd_vel')], parameters=[{'stamped': True}]),
""",
    frame="drive/rover.launch.py",
    beside={
        "drive/rover.urdf": "",
        "drive/controllers.yaml": "",
    },
)


def _programs(graph: Graph) -> Mismatches:
    """Yield the well-known programs that send a controller another type than it reads.

    A parameter decides the type.
    """
    subscriptions = graph.of_kind("subscription", sources=("controller",))
    publishers = graph.certain("publisher", "program")
    for reader, publisher in graph.pairs(subscriptions, publishers):
        parameter = deciding_parameter(publisher)
        is_same = reader.launch == publisher.launch
        if is_same and parameter is not None and publisher.type != reader.type:
            message = (
                f"{publisher.owner} publishes {publisher.name} with {publisher.type}, but the "
                f"controller subscribes to it with {reader.type}: set its parameter {parameter}"
            )
            yield warning(_COMMAND_TYPE, message, publisher.location, reader.location)
