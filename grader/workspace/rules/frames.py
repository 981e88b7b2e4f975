"""Frames and joints of the robot and of static transforms, and where files name them."""

from collections.abc import Collection, Iterator, Sequence
from collections.abc import Set as AbstractSet
from itertools import pairwise, product

from grader.base.names import last_part, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import LazyLocation, Location
from grader.ros.config.yaml_values import YamlValue, is_parameters, values_in
from grader.ros.known.gazebo_rows import gazebo
from grader.ros.known.package_rows import frame_parameters, package_row
from grader.ros.known.shared_names import shared_names
from grader.ros.launch.launch_model import StartedNode
from grader.ros.nodes.node_facts import NodeFacts, NodeFrame, NodeProgram, PackageNodes
from grader.ros.package.package import Package
from grader.ros.package.static_transforms import STATIC_PUBLISHER, frames_named
from grader.ros.urdf.model import Robot
from grader.ros.xml.elements import first_text
from grader.ros.xml.parsing import Element
from grader.workspace.graph.code_ends import list_frames
from grader.workspace.graph.compared_robots import (
    ComparedRobots,
    robots_for_file,
    robots_for_launch,
)
from grader.workspace.graph.gazebo_topics import elements_in, list_systems, name_system
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.under_arguments import names_under_arguments
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Definition,
    Facts,
    Mismatch,
    Mismatches,
    Open,
    Pattern,
    Use,
    among,
    cost_of_guess,
)
from grader.workspace.rules.rule_table import (
    NO_FRAME,
    Rule,
)
from grader.workspace.rules.shared_symptoms import TREES_NOT_CONNECTED, TWO_PUBLISHERS

_MIN_OF_ROBOT = 2  # joints that a file names, from which on it is for another robot
_JOINTS = on_use(r"(^|_)joints?$|(wheels?|joints?)_names?$")
_FRAMES = on_use(r"(^|_)(frame|frame_id)$")
_BROADCASTING = ("TransformBroadcaster", "TFMessage")
_TRANSFORMS = "tf2_msgs.msg.TFMessage"
_POSES = "PosePublisher"  # a system of Gazebo that publishes the frames of a model
_SENSOR_FRAMES = ("gz_frame_id", "ignition_frame_id")
_FRAME_FIELDS = ("frame_id", "child_frame_id")  # of messages
# What a program calls the frames that it makes itself.
_OWN_FRAMES = on_use(r"^(odom|map|world|global|fixed|parent|target)_frame(_id)?$|^frame_prefix$")


def frame_facts(workspace: Workspace) -> Facts:
    """Yield the frames and joints that are defined, and those that files name.

    The files are YAML, SRDF, those of Gazebo and those of transforms.
    """
    robots = [
        known_robot.robot for known_robot in workspace.robots.known if known_robot.robot.links
    ]
    if not robots:
        return
    for known_robot in workspace.robots.known:
        yield from _defined_in(known_robot)
    start = _place(robots[0].links[0].location)
    yield from (Definition("frame", name, start) for name in shared_names().frames)
    yield from openings(workspace)
    yield from _static_transforms(workspace, robots)
    yield from _second_parents(workspace, robots)
    yield from _frames_in_code(workspace, robots)
    controllers = workspace.installed.typed_sections
    for tree in workspace.installed.trees:
        if is_parameters(tree):
            path = tree.source.path
            compared = robots_for_file(workspace, path)
            values = list(values_in(tree))
            joints = compared
            if _is_of_absent_robot(workspace, path, values):
                joints = ComparedRobots()
            for value in values:
                is_of_controller = not controllers.isdisjoint(value.keys)
                for fact in _in_yaml(value, is_of_controller=is_of_controller):
                    is_joint = isinstance(fact, Use) and fact.kind == "joint"
                    yield among(fact, joints if is_joint else compared)
    for known_robot in workspace.robots.known:
        yield from _in_robot(known_robot)
    yield from _odometry_frames(workspace, robots)
    yield from _sensor_frames(workspace, robots)


def _defined_in(known_robot: KnownRobot) -> Iterator[Definition]:
    """Yield the frames, links and joints of a robot."""
    robot = known_robot.robot
    path = known_robot.path
    for link in robot.links:
        yield Definition("frame", link.name, _place(link.location), robot=path)
        yield Definition("link", link.name, _place(link.location), robot=path)
    for joint in robot.joints:
        yield Definition("joint", joint.name, _place(joint.location), robot=path)


def _place(location: LazyLocation | None) -> Location:
    if location:
        return location.resolve()
    return Location("", 1, 1)


def openings(workspace: Workspace) -> Iterator[Open | Pattern]:
    """Yield that there may be other names.

    They may be of other robots, under other arguments, or of programs that may publish frames.
    """
    if workspace.robots.may_be_others:
        yield from (Open("frame"), Open("link"), Open("joint"), Open("group"))
    for name in names_under_arguments(workspace, "joint"):
        yield Pattern("joint", name)
    for name in names_under_arguments(workspace, "link"):
        yield from (Pattern("link", name), Pattern("frame", name))
    for launch in workspace.launches.every:
        if launch.more:
            yield Open("frame", reason=launch.more)
        if any("bag play" in command for command in launch.command_texts):
            yield Open("frame")  # a recording has frames of its own
    if _may_be_published(workspace):
        yield Open("frame")


def _named_in_code(named: Sequence["_NamedFrame"], above: Collection[str]) -> Facts:
    """Yield frames of code, but for those that are looked up above a static transform."""
    for each in named:
        if each.frame.use != "looks up" or each.name not in above:
            yield among(_definition_or_use(each), each.compared)


def _may_be_published(workspace: Workspace) -> bool:
    """Return whether a program, code or a system of Gazebo may publish unknown frames."""
    packages = workspace.own_packages
    for node in workspace.launches.nodes:
        if "frames" not in package_row(node.package).without and node.package not in packages:
            return True
    if any(_may_publish(workspace, package) for package in workspace.packages):
        return True
    for text in workspace.texts.python_texts:
        if any(word in text for word in _BROADCASTING):
            return True
    return _POSES in list_systems(workspace)


def _may_publish(workspace: Workspace, package: Package) -> bool:
    """Return whether the programs that CMake makes may publish unknown frames.

    The frames of programs that are started are known.
    """
    setup = package.installation
    if not package.is_cmake or not setup or not setup.programs:
        return False
    nodes = workspace.code.by_package[package.name]
    programs = {last_part(path) for path in setup.programs}
    if not _are_read(nodes, programs) or any(map(_may_open_transforms, nodes.nodes)):
        return True
    started = workspace.launches.programs
    others = [each for each in nodes.programs if (package.name, each.name) not in started]
    return any(map(_publishes_frame, others))


def _are_read(nodes: PackageNodes, programs: AbstractSet[str]) -> bool:
    """Return whether the nodes of programs, and all frames that these name, are known."""
    if nodes.doubts or nodes.loose_frames:
        return False
    return programs <= {program.name for program in nodes.programs if program.nodes}


def _publishes_frame(program: NodeProgram) -> bool:
    """Return whether a node of a program publishes a frame."""
    uses = set()
    for facts in program.nodes:
        uses |= {frame.use for frame in facts.frames}
    return "publishes" in uses


def _may_open_transforms(facts: NodeFacts) -> bool:
    """Return whether a node may open a topic of transforms itself."""
    return bool(facts.doubts) or any(end.type == _TRANSFORMS for end in facts.endpoints)


def _frames_in_code(workspace: Workspace, robots: Sequence[Robot]) -> Facts:
    """Yield the frames that own nodes publish, look up and name in messages."""
    named = []
    above = set()  # the frames that static transforms have as their parent: the root of a map
    for number, node in workspace.launches.launched:
        if _is_static(node):
            above.add(frames_named(node)[0])
        for name, frame in list_frames(workspace, node) if node.when is not False else ():
            if name is not None and name.strip("/"):
                compared = robots_for_launch(workspace, number)
                named.append(_NamedFrame(name.removeprefix("/"), frame, node, compared))
            elif name is None and frame.use == "publishes":
                yield Open("frame", reason=f"the frames of {node.executable} are computed")
    if named:
        yield from _prefixed_frames(workspace)
        yield from _frames_of_others(workspace)
    yield from _named_in_code(named, above)
    yield from _misspelt_roots(named, robots)
    yield from _frames_in_fields(workspace)


def _definition_or_use(named: "_NamedFrame") -> Definition | Use:
    """Return what a node does with a frame that it names."""
    at = named.frame.location
    if named.frame.use in ("publishes", "is above"):
        return Definition("frame", named.name, at)
    if named.frame.use == "names":
        return Use("frame", named.name, at, "frame_id")
    is_python = at.path.endswith(".py")
    said = "lookup_transform" if is_python else "lookupTransform"
    return Use("frame", named.name, at, said, optional=is_python)


def _prefixed_frames(workspace: Workspace) -> Iterator[Definition | Open]:
    """Yield the links of robots under the prefix that robot_state_publisher gives them."""
    for node in workspace.launches.nodes:
        if node.frame_prefix is None:
            yield Open("frame")
        for robot in workspace.robots.known if node.frame_prefix else ():
            for link in robot.robot.links:
                name = f"{node.frame_prefix}{link.name}".removeprefix("/")
                yield Definition("frame", name, node.location)


def _frames_of_others(workspace: Workspace) -> Iterator[Definition | Open]:
    """Yield the frames that nodes of other packages publish under names from launch files."""
    for package, node in workspace.launches.placed_nodes:
        if not package_row(node.package).publishes_transforms:
            continue
        given = workspace.parameters.given_to(package, node)
        if given.unknown:
            yield Open("frame")
        for name, value in given.values.items():
            if name in frame_parameters() and isinstance(value.value, str):
                yield Definition("frame", value.value.removeprefix("/"), value.location)


def _frames_in_fields(workspace: Workspace) -> Iterator[Use]:
    """Yield the frames that Python code of started packages writes into messages."""
    started = {node.package for node in workspace.launches.nodes if node.when is not False}
    for package in workspace.packages:
        if package.name not in started:
            continue
        for field in workspace.code.by_package[package.name].field_uses:
            if field.path[-1] not in _FRAME_FIELDS or len(field.literal) != 1:
                continue
            text = field.literal[0]
            if isinstance(text, str) and text.strip("/"):
                yield Use("frame", text.removeprefix("/"), field.location, field.path[-1])


class _NamedFrame(Named):
    """A frame that a node names as it is started."""

    name: str
    frame: NodeFrame
    node: StartedNode
    compared: ComparedRobots


_ROOT_FRAME = Rule(
    "root-frame",
    "frames",
    NO_FRAME,
    "A frame that code publishes is not a misspelling of the root of the robot.",
    why=(
        "The odometry and the robot are then two trees. tf2 finds no transform from odom to a "
        "sensor, and RViz cannot show the robot in odom."
    ),
    wrong="""
geometry_msgs::msg::TransformStamped t;
t.header.frame_id = "odom";
t.child_frame_id = "base_lnk";
t.transform.rotation.w = 1.0;
sender_->sendTransform(t);
""",
    right="""
geometry_msgs::msg::TransformStamped t;
t.header.frame_id = "odom";
t.child_frame_id = "base_link";
t.transform.rotation.w = 1.0;
sender_->sendTransform(t);
""",
    frame="send/talk.cpp",
    beside={
        "package.xml": "",
        "talk/CMakeLists.txt": "",
    },
)


def _misspelt_roots(named: Sequence[_NamedFrame], robots: Sequence[Robot]) -> Mismatches:
    """Yield frames that are published, and are like the root of a robot that nothing places.

    It is certain for a node that is started, with one robot.
    """
    publishing = [each for each in named if each.frame.use == "publishes"]
    placed = {each.name for each in publishing}
    roots: dict[str, Location] = {}
    for robot in robots:
        placed |= {joint.child for joint in robot.joints}
        roots |= {link.name: _place(link.location) for link in robot.links}
    for name in placed.intersection(roots):
        roots.pop(name)
    for each in publishing:
        meant = near(each.name, roots)
        if meant is None:
            continue
        at = each.frame.location
        message = f"the frame {each.name!r} is published, which nothing else has"
        is_certain = each.node.when is True and len(robots) == 1
        wrong = Mismatch(_ROOT_FRAME, message, at, roots[meant], is_certain)
        yield wrong.meaning(each.name, meant, roots[meant])


def _is_static(node: StartedNode) -> bool:
    return node.program == STATIC_PUBLISHER


def _static_transforms(workspace: Workspace, robots: Sequence[Robot]) -> Facts:
    """Yield the frames of static transforms, those that they publish and those that they need."""
    children = {joint.child for robot in robots for joint in robot.joints}
    links = {link.name for robot in robots for link in robot.links}
    for number, node in workspace.launches.launched:
        if not _is_static(node):
            continue
        frames = _frames_of_static(node)
        if frames is None:
            reason = "the frames of a static_transform_publisher are not evaluated"
            yield Open("frame", reason=reason)
            continue
        parent, child = frames
        yield Definition("frame", child, node.location)
        # Above a robot, or a frame that others publish, it may be the root.
        is_root = child not in children and (child in links or child in shared_names().frames)
        said = STATIC_PUBLISHER[1]
        use = Use("frame", parent, node.location, said, optional=is_root)
        yield among(use, robots_for_launch(workspace, number))


def _frames_of_static(node: StartedNode) -> tuple[str, str] | None:
    """Return parent and child of a static transform; None where they are not evaluated."""
    parent, child = frames_named(node)
    if not parent or not child or None in (node.arguments or (None,)):
        return None
    return parent, child


_FRAME_PARENT = Rule(
    "frame-parent",
    "frames",
    NO_FRAME,
    "A link of the robot gets no second parent.",
    why=(
        "tf2 keeps one parent of each frame, that of the last message. The link jumps between "
        "two places, or is no longer connected to the robot."
    ),
    symptoms=(
        TREES_NOT_CONNECTED,
        TWO_PUBLISHERS,
    ),
    wrong="""
Node(
    package='tf2_ros',
    executable='static_transform_publisher',
    arguments=['--frame-id', 'map', '--child-frame-id', 'arm'],
),
""",
    right="""
Node(
    package='tf2_ros',
    executable='static_transform_publisher',
    arguments=['--frame-id', 'map', '--child-frame-id', 'base_link'],
),
""",
    beside={
        "arm/rover.urdf": "",
    },
)


def _second_parents(workspace: Workspace, robots: Sequence[Robot]) -> Mismatches:
    """Yield static transforms that give a link of the robot a second parent.

    It is certain for a node that is started, with one robot.
    """
    joints = {joint.child: joint for robot in robots for joint in robot.joints}
    for node in workspace.launches.nodes:
        frames = _frames_of_static(node) if _is_static(node) else None
        if frames is None or frames[1] not in joints:
            continue
        parent, child = frames
        joint = joints[child]
        if joint.parent != parent:
            message = (
                f"the frame {child!r} has two parents: {joint.parent!r} in the robot, "
                f"{parent!r} here"
            )
            is_certain = node.when is True and len(robots) == 1
            at = _place(joint.location)
            yield Mismatch(_FRAME_PARENT, message, node.location, at, is_certain=is_certain)


def _is_of_absent_robot(workspace: Workspace, path: str, values: Sequence[YamlValue]) -> bool:
    """Return whether a file that nothing gives to a node is for a robot that is not there.

    It names joints, and no robot of the workspace has one of them, or one that is nearly called so.
    """
    given = workspace.parameters.files.keys() | workspace.parameters.controller_files
    joints = set()
    for known_robot in workspace.robots.known:
        joints |= {joint.name for joint in known_robot.robot.joints}
    named = set()
    for value in values:
        if value.keys and _JOINTS.search(value.keys[-1]):
            named |= {text for text, _ in value.texts() if text and "/" not in text}
    if path in given or len(named) < _MIN_OF_ROBOT or not named.isdisjoint(joints):
        return False
    workspace.charge(len(named) * cost_of_guess(len(joints)))
    return all(near(name, joints) is None for name in named)


def _in_yaml(value: YamlValue, *, is_of_controller: bool) -> Facts:
    """Yield the joints and frames that a parameter names.

    What a node of another kind calls joints may be other things.
    """
    key = value.keys[-1] if value.keys else ""
    names = {node.location: text for text, node in value.texts() if "$" not in text}
    if _JOINTS.search(key):
        for at, name in names.items():
            if name and "/" not in name:
                yield Use("joint", name, at, value.said, optional=not is_of_controller)
    elif _FRAMES.search(key):
        for at, text in names.items():
            yield from _frame_in_yaml(text.removeprefix("/"), at, value)


def _frame_in_yaml(name: str, at: Location, value: YamlValue) -> Iterator[Definition | Use]:
    """Yield a frame that a parameter names, or that its program makes."""
    key = value.keys[-1]
    if name and not _OWN_FRAMES.search(key):
        yield Use("frame", name, at, value.said)
    elif name and key in frame_parameters():
        yield Definition("frame", name, at)


def _in_robot(robot: KnownRobot) -> Facts:
    """Yield what the elements for Gazebo and ros2_control name."""
    joints = {joint.name for joint in robot.robot.joints}
    named = gazebo().frame_elements + gazebo().joint_elements
    for element in robot.root.iterchildren("gazebo"):
        at = robot.place(element)
        for joint in element.iter("joint"):  # of Gazebo alone, for what URDF does not have
            yield Definition("joint", joint.get("name", ""), at)
        reference = element.get("reference")
        if reference and reference not in joints:
            yield Use("link", reference, at, "<gazebo reference>")
        for inner in element.iter(*named):
            yield from _in_element(robot, inner)
    for system in robot.systems:
        yield from _in_system(robot, system)


def _in_element(robot: KnownRobot, element: Element) -> Facts:
    """Yield the joint or frame that an element for Gazebo names, or makes."""
    text = first_text(element)
    at = robot.place(element)
    said = f"<{element.tag}>"
    parent = element.getparent()
    is_made = element.tag == "frame_id" and parent is not None and parent.tag == "plugin"
    if text and element.tag in gazebo().joint_elements:
        yield Use("joint", text, at, said)
    elif text and is_made:
        yield Definition("frame", text, at)  # that the plugin publishes
    elif text:
        yield Use("frame", text, at, said)


def _odometry_frames(workspace: Workspace, robots: Sequence[Robot]) -> Facts:
    """Yield the frames that systems of Gazebo publish.

    They are those that the systems name, and by default those below the model's.
    """
    created = _created_models(workspace)
    defaults = list(gazebo().odometry_frames)
    for robot in robots:
        defaults += [link.name for link in robot.links]
    for plugin, place in elements_in(workspace, "plugin"):
        if name_system(plugin) not in gazebo().odometry_systems:
            continue
        at = place(plugin)
        for element in plugin.iterchildren(*gazebo().odometry_elements):
            yield Definition("frame", first_text(element), at)
        around = {model.get("name", "") for model in plugin.iterancestors("robot", "model")}
        for model, frame in product(sorted(around | created), defaults):
            yield Definition("frame", f"{model}/{frame}", at)


def _created_models(workspace: Workspace) -> set[str]:
    """Return the names of the models that launch files create in the simulation."""
    created = set()
    for node in workspace.launches.nodes:
        if node.executable == "create":
            for option, name in pairwise(node.arguments or ()):
                if option == "-name" and name:
                    created.add(name)
    return created


def _sensor_frames(workspace: Workspace, robots: Sequence[Robot]) -> Iterator[Use]:
    """Yield the frames of the sensors of models that are a robot as well: these have a link of it.

    Their own links and frames are ignored, since Gazebo may publish them.
    """
    links = {link.name for robot in robots for link in robot.links}
    for file in workspace.texts.sdf_files:
        for model in file.root.iter("model"):
            made = {element.get("name") for element in model.iter("link", "frame")}
            for element in model.iter(*_SENSOR_FRAMES) if made & links else ():
                name = first_text(element).removeprefix("/")
                if name and name not in made:
                    at = file.location(element)
                    yield Use("frame", name, at, f"<{element.tag}>", optional=True)


def _in_system(robot: KnownRobot, system: Element) -> Facts:
    """Yield the joints that a system of ros2_control names."""
    for element in system.iterchildren("joint"):
        yield Use("joint", element.get("name", ""), robot.place(element), "<ros2_control>")
        for param in element.iterchildren("param"):
            text = first_text(param)
            if param.get("name") == "mimic" and text:
                yield Use("joint", text, robot.place(param), "the parameter mimic")
