"""Bridges between Gazebo and ROS: rows of ros_gz_bridge compared with topics of Gazebo."""

import posixpath
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from grader.base.names import closest, last_part
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.config.yaml_nodes import YamlFault
from grader.ros.known.gazebo_rows import NO_SENSOR, gazebo
from grader.ros.known.package_tables import bridge_table
from grader.ros.launch.launch_model import StartedNode
from grader.ros.xml.elements import first_text
from grader.ros.xml.parsing import Element, XmlFile
from grader.workspace.graph.bridge_rows import (
    BRIDGE,
    PARAMETER_BRIDGE,
    TO_GAZEBO,
    TO_ROS,
    BridgeRow,
    bridge_rows,
)
from grader.workspace.graph.gazebo_topics import (
    GazeboTopic,
    elements_in,
    gazebo_topics,
    sensor_topics,
)
from grader.workspace.graph.graph import make_graph
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
    charge_guess,
    cost_of_guess,
    warning,
)
from grader.workspace.rules.rule_table import NO_COMPANION, NO_TOPIC, Rule, Symptom

_TOPIC_KEYS = ("topic_name", "ros_topic_name", "gz_topic_name", "ign_topic_name")
_EXCHANGED = on_use(
    r"(?P<topic>[^@\s]++)@(?P<gz>(?:gz|ignition)\.msgs\.\w++)(?P<direction>[@\[\]])"
    r"(?P<ros>\w++/msg/\w++)"
)
_OF_ROS = on_use(r"\w++/(?:msg/)?\w++")
_COMPUTED = on_use("^(world|model)/|[${<%]")  # names that Gazebo or a program makes
_EXPANDED = "expand_gz_topic_names"  # the parameter that puts the namespace before the names
# Below the topic, or beside it: also of cameras that segment (gz-sensors).
_DERIVED = ("points", "image", "depth_image", "camera_info", "labels_map", "colored_map")
# Models in worlds that have no sensors.
_WITHOUT_SENSORS = ("sun", "ground_plane", "ground plane")


def bridge_facts(workspace: Workspace) -> Facts:
    """Yield rows with types or directions that no bridge has, missing topics and clocks.

    The topics are those that Gazebo does not have.
    """
    yield from _unreadable_files(workspace)
    yield from _incomplete_rows(workspace)
    yield from _other_arguments(workspace)
    yield from _exchanged_types(workspace)
    rows = list(bridge_rows(workspace))
    if not rows:
        return
    yield from _compared_rows(workspace, rows)
    yield from _no_clock(workspace, rows)


_BRIDGE_FILE = Rule(
    "bridge-file",
    "topics",
    NO_TOPIC,
    "A file of bridge rows is a list in YAML.",
    why=(
        "The bridge cannot read its rows from the file. It ends or bridges nothing, so no topic"
        " of Gazebo arrives in ROS 2."
    ),
    symptoms=(
        Symptom(
            "bridge-no-sequence",
            pattern=r"Could not parse config: top level must be a YAML sequence",
            source="gazebosim/ros_gz a4d00a9, ros_gz_bridge/src/bridge_config.cpp:159",
            sentence="The file of a bridge is no list.",
            example="Could not parse config: top level must be a YAML sequence",
        ),
    ),
    wrong="""
- ros_topic_name: scan
 gz_topic_name: scan
""",
    right="""
- ros_topic_name: scan
  gz_topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
""",
    frame="bridge.yaml",
    beside={
        "bridge/rover.launch.py": "",
    },
)


def _unreadable_files(workspace: Workspace) -> Mismatches:
    """Yield the files that bridges get and that cannot be parsed, or are no lists."""
    for path in bridge_files(workspace):
        tree = workspace.installed.yaml.get(path)
        if isinstance(tree, YamlFault):
            yield Mismatch(_BRIDGE_FILE, f"this is not YAML: {tree}", tree.location)
        elif tree and isinstance(tree.value, dict):
            message = "the file of a bridge is a list (a YAML sequence): begin each row with `- `"
            yield Mismatch(_BRIDGE_FILE, message, tree.location)


class _GazeboTopics(Named):
    """What is known of the topics of Gazebo."""

    by_name: Mapping[str, list[GazeboTopic]]  # those whose types are known
    named: set[str]  # all that files name, and those that Gazebo derives from them
    unused: Sequence[GazeboTopic]  # that no bridge takes
    nameless: Mapping[str, "_NamelessSensor"]
    is_known: bool  # whether no other sensor or bridge may have one
    are_expanded: bool  # whether the namespace may be put before the names of rows


def _compared_rows(workspace: Workspace, rows: list[BridgeRow]) -> Facts:
    """Yield what is wrong with rows, by the topics that Gazebo has."""
    gz = _topics_of_gazebo(workspace, {row.gz for row in rows})
    for row in rows:
        yield Compared("topics")
        if row.direction not in bridge_table().directions:
            yield _no_direction(row)
            continue
        same = gz.by_name.get(row.gz, [])
        yield from _no_type(workspace, row)
        yield from _conversions(row, {f"gz.msgs.{topic.type}" for topic in same})
        yield from _clock_to_gazebo(row)
        if row.gz in gz.named:
            yield from _opposite_direction(row, same)
            yield from _type_of_topic(row, same)
        elif not gz.are_expanded and not _COMPUTED.search(row.gz):
            workspace.charge(len(gz.unused) + cost_of_guess(len(gz.unused)))
            yield from _not_there(row, gz.unused, is_known=gz.is_known)
            yield from _without_topic(row, gz.nameless)


def _topics_of_gazebo(workspace: Workspace, bridged: set[str]) -> _GazeboTopics:
    """Return the topics of Gazebo, some of which bridges take."""
    topics = list(gazebo_topics(workspace))
    by_name: dict[str, list[GazeboTopic]] = {}
    for topic in topics:
        by_name.setdefault(topic.name, []).append(topic)
    taken = {*bridged}
    for node in workspace.launches.nodes:
        if node.package == "ros_gz_image":
            taken |= {(word or "").strip("/") for word in node.arguments or ()}
    unused = [topic for topic in topics if topic.name not in taken]
    is_known = not has_unread_topics(workspace)
    are_expanded = any(_EXPANDED in text for text in workspace.texts.searched_launch_texts())
    return _GazeboTopics(
        by_name=by_name,
        named=_named_topics(workspace),
        unused=unused,
        nameless=_nameless_sensors(workspace, topics) if is_known else {},
        is_known=is_known,
        are_expanded=are_expanded,
    )


class _NamelessSensor(Named):
    """A sensor for whose topic Gazebo makes a name."""

    name: str
    gz_type: str
    location: Location


def _nameless_sensors(
    workspace: Workspace, topics: list[GazeboTopic]
) -> dict[str, _NamelessSensor]:
    """Return sensors without a <topic> by the types of their messages, which no topic has."""
    named = {f"gz.msgs.{topic.type}" for topic in topics}
    nameless: dict[str, _NamelessSensor] = {}
    for sensor, place in elements_in(workspace, "sensor"):
        types = gazebo().sensor.get(sensor.get("type", ""), NO_SENSOR)
        gz_type = f"gz.msgs.{types.topic}"
        if gz_type not in named and next(sensor.iterchildren("topic"), None) is None:
            nameless_sensor = _NamelessSensor(sensor.get("name", ""), gz_type, place(sensor))
            nameless.setdefault(gz_type, nameless_sensor)
    return nameless


_SENSOR_TOPIC = Rule(
    "sensor-topic",
    "wiring",
    NO_COMPANION,
    "The sensor whose messages a bridge takes has a <topic>.",
    why=(
        "Gazebo makes a topic from the names of world, model, link and sensor. The bridge waits"
        " on another name, and no message arrives in ROS 2."
    ),
    wrong='<gazebo reference="base_link"><sensor name="lidar" type="gpu_lidar"/></gazebo>',
    right="""
<gazebo reference="base_link">
  <sensor name="lidar" type="gpu_lidar"><topic>scan</topic></sensor>
</gazebo>
""",
    frame="rover.urdf",
    beside={
        "rover.launch.py": """
Node(package='ros_gz_bridge', executable='parameter_bridge',
     arguments=['/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan']),
""",
    },
    at="launch/rover.launch.py",
)


def _without_topic(row: BridgeRow, nameless: Mapping[str, _NamelessSensor]) -> Mismatches:
    """Yield that the only sensor with the messages of a row has no <topic>.

    A model that is not in the workspace may publish it.
    """
    sensor = nameless.get(row.gz_type)
    if not sensor or not row.is_published:
        return
    at = sensor.location
    message = (
        f"nothing publishes {quoted(row.gz)} in Gazebo: the sensor {quoted(sensor.name)} has no "
        f"<topic> ({at.file_and_line})"
    )
    yield warning(_SENSOR_TOPIC, message, row.location, at)


_BRIDGE_ROW = Rule(
    "bridge-row",
    "topics",
    NO_TOPIC,
    "A row of a bridge has the keys that the bridge needs.",
    why=(
        "The bridge prints an error for the row and ignores it. Other rows work, so only this "
        "topic is missing in ROS 2 or Gazebo."
    ),
    wrong="""
- topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type: gz.msgs.LaserScan
""",
    right="""
- topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
""",
    frame="bridge.yaml",
    beside={
        "bridge/rover.launch.py": "",
    },
)


def _incomplete_rows(workspace: Workspace) -> Mismatches:
    """Yield the rows in files of bridges that name a topic and lack a key.

    A bridge leaves out such a row.
    """
    for path in sorted(bridge_files(workspace)):
        tree = workspace.installed.find_tree(path)
        for row in tree.items if tree else ():
            if all(not row.get(key) for key in _TOPIC_KEYS):
                continue
            for key in bridge_table().keys:
                if row.get(key) is None and row.get(key.replace("gz", "ign")) is None:
                    message = f"the bridge leaves out the row: it has no {key}"
                    yield Mismatch(_BRIDGE_ROW, message, row.location)


_BRIDGE_ARGUMENT = Rule(
    "bridge-argument",
    "topics",
    NO_TOPIC,
    "An argument of a bridge names a topic with its types.",
    why=(
        "parameter_bridge prints its usage and ends at the first argument that it cannot parse."
        " The topics of all other arguments are missing too."
    ),
    wrong="Node(package='ros_gz_bridge', executable='parameter_bridge', arguments=['/clock']),",
    right="""
Node(
    package='ros_gz_bridge',
    executable='parameter_bridge',
    arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock'],
),
""",
)


def _other_arguments(workspace: Workspace) -> Mismatches:
    """Yield the first argument of a bridge that is no topic with types, with which it ends."""
    for node in workspace.launches.nodes:
        word = _first_other_argument(node) if node.program == PARAMETER_BRIDGE else None
        if word is not None:
            message = (
                f"the bridge ends with an error at the argument {quoted(word)}: write "
                "TOPIC@ROS_TYPE[GZ_TYPE"
            )
            is_certain = node.when is True
            yield Mismatch(_BRIDGE_ARGUMENT, message, node.location, is_certain=is_certain)


_BRIDGE_TYPE = Rule(
    "bridge-type",
    "topics",
    NO_TOPIC,
    "A bridge converts the types of its rows, and a row has the type of Gazebo's topic.",
    why=(
        "The bridge prints 'Failed to create a bridge for topic', or receives nothing because "
        "Gazebo publishes another type. No message arrives in ROS 2."
    ),
    symptoms=(
        Symptom(
            "bridge-type",
            pattern=(
                r"Failed to create a bridge for topic \[/?(?P<topic>[^\]]{1,200}+)\] with ROS2 "
                r"type \[(?P<type>[^\]]{0,200}+)\]"
            ),
            source="gazebosim/ros_gz a4d00a9, ros_gz_bridge/src/ros_gz_bridge.cpp:121",
            sentence="The bridge converts no such pair of types.",
            example=(
                "Failed to create a bridge for topic [/scan] with ROS2 type "
                "[sensor_msgs/msg/LaserScan] to topic [/scan] with Gazebo Transport type "
                "[gz.msgs.Laserscan]"
            ),
            within=("topic",),
        ),
    ),
    wrong="""
Node(
    package='ros_gz_bridge',
    executable='parameter_bridge',
    arguments=['/scan@sensor_msgs/msg/LaserScan[gz.msgs.Image'],
),
""",
    right="""
Node(
    package='ros_gz_bridge',
    executable='parameter_bridge',
    arguments=['/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan'],
),
""",
    beside={
        "lidar/rover.urdf": "",
    },
)


def _exchanged_types(workspace: Workspace) -> Mismatches:
    """Yield the arguments of bridges that have the type of Gazebo in place of that of ROS."""
    for node in workspace.launches.nodes:
        for word in node.arguments or () if node.package == BRIDGE else ():
            match = _EXCHANGED.fullmatch(word or "")
            if match:
                right = f"{match['topic']}@{match['ros']}{match['direction']}{match['gz']}"
                message = f"the types are exchanged, so nothing is bridged: write {right}"
                is_certain = node.when is True
                yield Mismatch(_BRIDGE_TYPE, message, node.location, is_certain=is_certain)


def _first_other_argument(node: StartedNode) -> str | None:
    """Return the first argument of a bridge that is no topic; None before one that is not known."""
    for word in node.arguments or ():
        if word is None or word == "--ros-args":
            return None
        if "@" not in word[1:]:
            return word
    return None


_BRIDGE_DIRECTION = Rule(
    "bridge-direction",
    "topics",
    NO_TOPIC,
    "A row of a bridge goes in the direction of its messages.",
    why=(
        "The bridge then waits on the side where nothing publishes. ros2 topic list shows the "
        "topic, but no message arrives."
    ),
    wrong="""
Node(
    package='ros_gz_bridge',
    executable='parameter_bridge',
    arguments=['/clock@rosgraph_msgs/msg/Clock]gz.msgs.Clock'],
),
""",
    right="""
Node(
    package='ros_gz_bridge',
    executable='parameter_bridge',
    arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock'],
),
""",
)


def _no_direction(row: BridgeRow) -> Mismatch:
    """Return that a row has a direction that no bridge has."""
    meant = closest(row.direction, bridge_table().directions)
    guess = f"; did you mean {meant}?" if meant is not None else ""
    message = f"the bridge leaves out the row: it has no direction {quoted(row.direction)}{guess}"
    wrong = Mismatch(_BRIDGE_DIRECTION, message, row.direction_location, None, row.is_used)
    return wrong.correcting(row.direction, meant)


def _no_type(workspace: Workspace, row: BridgeRow) -> Mismatches:
    """Yield that no bridge has a type like the one of a row in ROS, and which one it may mean."""
    types = [kind.replace(".", "/") for kind in bridge_table().types]
    written = row.ros_type.replace(".", "/")
    if written in types:
        return
    charge_guess(workspace, types)
    meant = closest(written, types, is_clear=True)
    package, _, name = written.partition("/")
    if f"{package}/msg/{name}" in types:
        meant = f"{package}/msg/{name}"
    if meant is None or "/srv/" in written:
        return
    at = row.ros_type_location
    message = f"the bridge has no type {quoted(written)}; did you mean {meant}?"
    wrong = Mismatch(_BRIDGE_TYPE, message, at, None, row.is_used)
    yield wrong.correcting(written, meant)


def bridge_files(workspace: Workspace) -> set[str]:
    """Return the files with rows that launch files give to bridges.

    The keys are the paths of the files in the workspace.
    """
    files = set()
    for path in _files_named(workspace):
        source = workspace.installed.find_source(path) if isinstance(path, str) else None
        if source is not None:
            files.add(source)
    return files


def _files_named(workspace: Workspace) -> Iterator[Any]:
    """Yield what launch files name as the files of bridges."""
    for node in workspace.launches.nodes:
        for given in node.parameters or () if node.package == BRIDGE else ():
            value = given.values.get("config_file")
            if value:
                yield value.value
    for launch in workspace.launches.outermost:
        for passed in launch.passed:
            values = dict(passed.values) if f"/{BRIDGE}/" in passed.path else {}
            yield values.get("config_file")


def _conversions(row: BridgeRow, gazebo_types: set[str]) -> Mismatches:
    """Yield that no bridge converts a type into the other one.

    Where the topics of Gazebo have the type of the row, the other one is wrong.
    """
    fitting = _fitting_types(row)
    if not fitting and _OF_ROS.fullmatch(row.gz_type):
        message = f"the Gazebo type {row.gz_type} is a ROS type, so nothing is bridged"
        yield Mismatch(_BRIDGE_TYPE, message, row.gz_type_location, None, row.is_used)
    if not fitting or row.gz_type in fitting:
        return
    ros_type = row.ros_type.replace(".", "/")
    plain = row.gz_type.removeprefix("gz.msgs.")
    meant = []
    if gazebo_types == {row.gz_type}:
        for kind, converted in bridge_table().types.items():
            if plain in converted:
                meant.append(kind.replace(".", "/"))
    if meant:
        written = ros_type
        at = row.ros_type_location
    else:
        written = row.gz_type
        meant = fitting[:1]
        at = row.gz_type_location
    message = (
        f"the bridge does not convert {ros_type} and {row.gz_type or 'an empty type'}; "
        f"write {enumerated(meant, word='or')}"
    )
    wrong = Mismatch(_BRIDGE_TYPE, message, at, None, row.is_used)
    yield wrong.correcting(written, meant[0] if written and len(meant) == 1 else None)


def _clock_to_gazebo(row: BridgeRow) -> Mismatches:
    """Yield that a bridge sends the time of ROS to Gazebo."""
    if row.gz_type == "gz.msgs.Clock" and row.direction == TO_GAZEBO:
        message = (
            f"the bridge sends the time of ROS to Gazebo: the clock is Gazebo's, so write {TO_ROS}"
        )
        yield _wrong_direction(row, message, TO_ROS)


def _fitting_types(row: BridgeRow) -> list[str]:
    """Return the types of Gazebo that a bridge converts into the type of a row in ROS."""
    return [f"gz.msgs.{kind}" for kind in bridge_table().types.get(row.ros_type, ())]


def _wrong_direction(
    row: BridgeRow, message: str, right: str, related: Location | None = None
) -> Mismatch:
    """Return that a row has the wrong direction, with the right one.

    In an argument, the direction is a character.
    """
    at = row.direction_location
    wrong = Mismatch(_BRIDGE_DIRECTION, message, at, related, row.is_used)
    return wrong.correcting(row.direction, right if at != row.location else None)


def _opposite_direction(row: BridgeRow, topics: list[GazeboTopic]) -> Mismatches:
    """Yield that a topic of Gazebo is bridged in the other direction than its messages go."""
    if len({topic.is_input for topic in topics}) != 1:
        return
    at = topics[0].location
    wrong = TO_GAZEBO
    right = TO_ROS
    done = "publishes it"
    if topics[0].is_input:
        wrong = TO_ROS
        right = TO_GAZEBO
        done = "reads it"
    if row.direction == wrong:
        message = (
            f"the topic {row.gz} is bridged {wrong}, but Gazebo {done} ({at.file_and_line}): "
            f"write {right}"
        )
        yield _wrong_direction(row, message, right, at)


def _type_of_topic(row: BridgeRow, topics: list[GazeboTopic]) -> Mismatches:
    """Yield that a topic of Gazebo has messages of another type.

    That no bridge converts the type is another mistake.
    """
    types = [f"gz.msgs.{topic.type}" for topic in topics]
    if types and row.gz_type in _fitting_types(row) and row.gz_type not in types:
        at = topics[0].location
        message = (
            f"the topic {row.gz} of Gazebo has {types[0]} ({at.file_and_line}), not {row.gz_type}"
        )
        yield Mismatch(_BRIDGE_TYPE, message, row.gz_type_location, at, row.is_used)


_BRIDGE_TOPIC = Rule(
    "bridge-topic",
    "topics",
    NO_TOPIC,
    "Gazebo has the topic of a row of a bridge.",
    why=(
        "The bridge waits for a Gazebo topic without a publisher or reader. ros2 topic list "
        "shows its ROS topic, but no message arrives."
    ),
    wrong="""
Node(
    package='ros_gz_bridge',
    executable='parameter_bridge',
    arguments=['/scans@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan'],
),
""",
    right="""
Node(
    package='ros_gz_bridge',
    executable='parameter_bridge',
    arguments=['/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan'],
),
""",
    beside={
        "lidar/rover.urdf": "",
    },
)


def _not_there(row: BridgeRow, unused: Sequence[GazeboTopic], *, is_known: bool) -> Mismatches:
    """Yield that Gazebo does not have the topic of a row.

    Nothing is said where a row has one of the same type that Gazebo has. A sensor that is not
    read may publish the topic, unless there is a similar one.
    """
    fitting = {}
    for topic in unused:
        if f"gz.msgs.{topic.type}" == row.gz_type and topic.is_input != row.is_published:
            fitting[topic.name] = topic.location
    meant = closest(row.gz, fitting)
    if meant is None and is_known:
        meant = min(fitting, default=None)
    if meant is None:
        return
    at = fitting[meant]
    what = "no sensor publishes" if row.is_published else "nothing reads"
    message = f"{what} {quoted(row.gz)} in Gazebo"
    is_certain = row.is_used and is_known and len(fitting) == 1
    wrong = Mismatch(_BRIDGE_TOPIC, message, row.location, at, is_certain)
    yield wrong.meaning(row.gz, meant, at)


_BRIDGE_CLOCK = Rule(
    "bridge-clock",
    "topics",
    NO_TOPIC,
    "A bridge takes the clock from Gazebo.",
    why=(
        "Without /clock the time of a node with use_sim_time stays 0: timers on its clock never"
        " fire, and time stamps and tf2 lookups are wrong."
    ),
    wrong="""
Node(package='ros_gz_bridge', executable='parameter_bridge', arguments=[
    '/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan']),
Node(package='rover', executable='joystick', parameters=[{'use_sim_time': True}]),
""",
    right="""
Node(package='ros_gz_bridge', executable='parameter_bridge', arguments=[
    '/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock',
    '/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan']),
Node(package='rover', executable='joystick', parameters=[{'use_sim_time': True}]),
""",
    beside={
        "lidar/rover.urdf": "",
        "joystick.py": "",
    },
)


def _no_clock(workspace: Workspace, rows: list[BridgeRow]) -> Mismatches:
    """Yield that a node waits for the time of the simulation, and no bridge takes it from Gazebo.

    Nothing is said where a bridge, or an included launch file, may have more rows.
    """
    used = [row for row in rows if row.is_used]
    has_bridge = any(node.package == BRIDGE for node in workspace.launches.nodes)
    has_clock = any(row.ros == "clock" for row in rows)
    if not has_bridge or not used or has_clock:
        return
    if has_unread_topics(workspace) or _may_include_bridge(workspace):
        return
    for node, sim_time in make_graph(workspace).given("use_sim_time"):
        # A launch file may give a text of which ROS makes a boolean.
        if node.when and str(sim_time.value).lower() == "true":
            message = (
                f"{node.executable} waits for the time of the simulation, but no bridge takes "
                "clock from Gazebo"
            )
            yield Mismatch(_BRIDGE_CLOCK, message, sim_time.location, used[0].location)
            return


def _may_include_bridge(workspace: Workspace) -> bool:
    """Return whether a launch file includes one of another package that may have a bridge."""
    for launch in workspace.launches.outermost:
        for passed in launch.passed:
            if (
                not workspace.installed.find_source(passed.path)
                and "/ros_gz_sim/" not in passed.path
            ):
                return True
    return False


def _named_topics(workspace: Workspace) -> set[str]:
    """Return every topic that the robot, models and worlds name, and those derived by Gazebo.

    Gazebo derives topics from those that are named.
    """
    topics: set[str] = set()
    for element, _ in elements_in(workspace, "*"):
        if str(element.tag).endswith("topic"):
            topics.update(_topics_from(element))
    return topics


def _topics_from(element: Element) -> Iterator[str]:
    """Yield the topics that Gazebo makes of the one that an element names."""
    text = first_text(element).strip("/")
    if not text:
        return
    sensor = element.getparent()
    published = {}
    if sensor is not None and sensor.tag == "sensor" and element.tag == "topic":
        published = dict(sensor_topics(sensor, element))
    if published:
        yield from published
        return
    yield from (text, f"{text}_image")  # the latter of cameras that draw boxes
    for name in _DERIVED:
        yield posixpath.join(posixpath.dirname(text), name)
        yield f"{text}/{name}"


def has_unread_topics(workspace: Workspace) -> bool:
    """Return whether there may be other sensors and bridges than those that were read."""
    robots = workspace.robots
    if not robots.known or robots.may_be_others or workspace.launches.has_more_nodes:
        return True
    for node in workspace.launches.nodes:
        is_known = node.arguments is not None and None not in node.arguments
        if node.package in (BRIDGE, "ros_gz_image") and not is_known:
            return True
    return any(map(_includes_model, workspace.texts.sdf_files))


def _includes_model(file: XmlFile) -> bool:
    """Return whether a world includes a model that may have sensors."""
    for include in file.root.iter("include"):
        model = last_part((include.findtext("uri") or "").strip())
        if model.lower() not in _WITHOUT_SENSORS:
            return True
    return False
