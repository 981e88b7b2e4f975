"""Spawners: whether the controllers and the controller manager that they name exist.

It is compared as well whether each controller is started.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from grader.base.names import last_part, near
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.config.yaml_nodes import YamlFault, YamlNode
from grader.ros.config.yaml_values import sections_in
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.launch.node_parameters import list_controllers
from grader.ros.package.package import Package
from grader.workspace.graph.compared_robots import robots_for_launch
from grader.workspace.graph.started_controllers import Controller, defined_controllers
from grader.workspace.model.launches import CONTROL_NODE, MANAGER, SPAWNERS
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Definition,
    Facts,
    Mismatch,
    Mismatches,
    Open,
    Use,
)
from grader.workspace.rules.rule_table import (
    NO_CONTROLLER,
    Rule,
)
from grader.workspace.rules.shared_symptoms import (
    ACTION_NOT_CONNECTED,
    CONTROLLER_NOT_LOADED,
    SERVICE_NOT_CONTACTED,
)

_OTHER_TYPES = on_use(r"load_controller|(?<![<-])\bparam\b(?!-)")  # of commands that set a type
_OTHER_STARTS = on_use(r"(load|switch|set)_controller|(Load|Switch)Controller")
_OF_GAZEBO = ("gz_ros2_control/", "ign_ros2_control/", "gazebo_ros2_control/")  # hardware
_MAX_CONTROLLERS = 3  # in a message


def spawner_facts(workspace: Workspace) -> Facts:
    """Yield the controllers that spawners load, and what keeps controllers from being loaded."""
    misspelt = list(_misspelt_managers(workspace))
    if misspelt:
        yield from misspelt
        return
    controllers = list(defined_controllers(workspace))
    if not controllers:
        yield from _no_controllers(workspace)
        yield from _without_plugin(workspace)
        return
    if any(isinstance(tree, YamlFault) for tree in workspace.installed.yaml.values()):
        yield Open("controller", reason="a parameter file cannot be read")
    # Without a controller manager, the robot's driver starts one, with controllers of its own.
    if not workspace.robots.has_controller_manager:
        yield Open("controller")
    yield from _names_in_spawners(workspace)
    yield from _without_plugin(workspace)
    for package, launch in workspace.launches.roots:
        yield from _without_type(workspace, package, launch, controllers)
    yield from _not_started(workspace, controllers)


_SPAWNER_MANAGER = Rule(
    "spawner-manager",
    "controllers",
    NO_CONTROLLER,
    "The controller manager that a spawner asks is started.",
    why=(
        "The spawner waits for services of the controller manager that nothing offers. It waits"
        " on or ends with a timeout, and no controller starts."
    ),
    symptoms=(SERVICE_NOT_CONTACTED,),
    wrong="""
Node(package='controller_manager', executable='ros2_control_node', parameters=[controllers]),
Node(
    package='controller_manager',
    executable='spawner',
    arguments=['arm_controller', '-c', '/controler_manager'],
),
""",
    right="""
Node(package='controller_manager', executable='ros2_control_node', parameters=[controllers]),
Node(
    package='controller_manager',
    executable='spawner',
    arguments=['arm_controller', '-c', '/controller_manager'],
),
""",
    frame="control/rover.launch.py",
    beside={
        "arm/rover.urdf": "",
        "arm/controllers.yaml": "",
    },
)


def _without_plugin(workspace: Workspace) -> Mismatches:
    """Yield that a spawner waits for the controller manager of a simulation that starts none.

    <ros2_control> names the hardware of Gazebo, which its plugin in <gazebo> loads.
    """
    if workspace.robots.has_controller_manager or workspace.robots.may_be_others:
        return
    for number, launch in enumerate(workspace.launches.outermost):
        spawners = [node for node in launch.nodes if _is_spawner(node)]
        systems = [
            robot.place(system)
            for robot in robots_for_launch(workspace, number).robots
            for system in robot.systems
            if system.findtext("hardware/plugin", "").strip().startswith(_OF_GAZEBO)
        ]
        if spawners and systems:
            message = (
                "no plugin in <gazebo> loads this hardware and starts the controller manager, for "
                f"which the spawner waits ({spawners[0].location.file_and_line}): add that of "
                "gz_ros2_control"
            )
            is_certain = not launch.more
            yield Mismatch(
                _SPAWNER_MANAGER, message, systems[0], spawners[0].location, is_certain=is_certain
            )


def _names_in_spawners(workspace: Workspace) -> Facts:
    """Yield the controllers that spawners name, and managers that they surely misspell.

    Where the launch file of a spawner starts no controller manager, that of a robot's driver may
    have controllers of its own.
    """
    managers = {}
    for node in workspace.launches.nodes:
        if _is_manager(node):
            managers[workspace.code.find_name(node)] = node.location
    for number, launch in enumerate(workspace.launches.outermost):
        spawners = [node for node in launch.nodes if _is_spawner(node)]
        spawners = [
            node for node in spawners if _is_defined_by_files(workspace, node.arguments or ())
        ]
        owner = ""
        if spawners and not _has_manager(workspace, number, launch):
            owner = f"launch {number}"
            yield Open("controller", owner)
            for controller in defined_controllers(workspace):
                yield Definition("controller", controller.name, controller.location, owner)
        for node in spawners:
            for name in _named(node.arguments or ()):
                yield Use("controller", name, node.location, "spawner", owner)
            yield from _managers_named(node, managers)


def _has_manager(workspace: Workspace, number: int, launch: Launch) -> bool:
    """Return whether a launch file starts a controller manager, or its robot has one in Gazebo."""
    if any(_is_manager(node) for node in launch.nodes):
        return True
    robots = robots_for_launch(workspace, number).robots
    return any(robot.has_controller_manager for robot in robots)


def _is_spawner(node: StartedNode) -> bool:
    return node.package == MANAGER and node.executable in SPAWNERS


def _named(words: Sequence[str | None]) -> Iterator[str]:
    """Yield the controllers before the options of a spawner."""
    for word in words:
        if word is None or word.startswith("-"):
            return
        yield from word.split()


def _is_defined_by_files(workspace: Workspace, words: Sequence[str | None]) -> bool:
    """Return whether files of the workspace define the controllers of a spawner.

    Otherwise, its arguments define them.
    """
    files = [path for option, path in pairwise(words) if option in ("-p", "--param-file")]
    return not _is_typed(words) and all(
        path is not None and workspace.installed.find_source(path) is not None for path in files
    )


def _is_typed(words: Sequence[str | None]) -> bool:
    return any(word and word.startswith(("-t", "--controller-t")) for word in words)


def _managers_named(spawner: StartedNode, managers: Mapping[str | None, Location]) -> Facts:
    """Yield the controller manager that a spawner waits for, if it means another one.

    It surely stands for another one.
    """
    for option, word in pairwise(spawner.arguments or ()):
        if option not in ("-c", "--controller-manager"):
            continue
        name = last_part(word or "")
        meant = near(name, filter(None, managers)) if name not in managers else None
        if meant is not None:
            at = managers[meant]
            message = (
                f"spawner: there is no controller manager {name!r}; did you mean {meant!r} "
                f"({at.file_and_line})?"
            )
            wrong = Mismatch(_SPAWNER_MANAGER, message, spawner.location, at)
            yield wrong.correcting(name, meant)


def _is_manager(node: StartedNode) -> bool:
    return node.executable == CONTROL_NODE


_MANAGER_PARAMETERS = Rule(
    "manager-parameters",
    "controllers",
    NO_CONTROLLER,
    "The controller manager gets the types of the controllers that spawners start.",
    why=(
        "For each spawner the controller manager prints that the 'type' param was not defined, "
        "and it loads no such controller."
    ),
    symptoms=(CONTROLLER_NOT_LOADED,),
    wrong="""
Node(package='controller_manager', executable='ros2_control_node'),
Node(package='controller_manager', executable='spawner', arguments=['arm_controller']),
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


def _without_type(
    workspace: Workspace, package: Package, launch: Launch, controllers: Sequence[Controller]
) -> Facts:
    """Yield the controllers whose types are in files or sections that nothing reads.

    The controller manager reads its own section of its files, and a spawner that of its controller.
    """
    manager, lacks_type = _controllers_without_type(workspace, package, launch)
    if not manager or _OTHER_TYPES.search(launch.source.text):
        return
    files = [
        workspace.installed.find_source(each.path) for each in manager.parameters or () if each.path
    ]
    lacking = [controller for controller in controllers if controller.name in lacks_type]
    elsewhere = [controller for controller in lacking if controller.location.path not in files]
    if elsewhere:
        at = elsewhere[0].location
        text = (
            "the controller manager is not given the parameters with the type of "
            f"{_join_names(elsewhere)} ({at.file_and_line})"
        )
        yield Mismatch(_MANAGER_PARAMETERS, text, manager.location, at)
        return
    for controller in lacking:
        if controller.is_own:
            text = (
                f"only a spawner with --param-file reads the type of {quoted(controller.name)} "
                f"here: give its spawner this file, or write the type below {MANAGER}"
            )
            yield Mismatch(_MANAGER_PARAMETERS, text, controller.location, manager.location)


def _controllers_without_type(
    workspace: Workspace, package: Package, launch: Launch
) -> tuple[StartedNode | None, set[str | None]]:
    """Return the controller manager of a launch file, and its controllers without a type.

    They are the controllers that spawners start and whose type neither of them is given. The
    result is None where this is not known.
    """
    managers = [node for node in launch.nodes if _is_manager(node) and node.when]
    if len(managers) != 1:
        return None, set()
    [manager] = managers
    given = workspace.parameters.given_to(package, manager)
    if given.unknown:
        return None, set()
    lacks_type: dict[str | None, bool] = {}  # by the names of the controllers that are started
    for controller in _spawned_without_parameters(launch):
        own_parameters = workspace.parameters.read(package, controller, "")
        has_type = "type" in own_parameters.values or f"{controller.node_name}.type" in given.values
        is_first = lacks_type.get(controller.node_name, True)  # one of its spawners may set it
        lacks_type[controller.node_name] = is_first and not own_parameters.unknown and not has_type
    return manager, {name for name, lacks in lacks_type.items() if lacks}


def _spawned_without_parameters(launch: Launch) -> Iterator[StartedNode]:
    """Yield the controllers of a launch file's spawners that get no parameters and no type.

    In later releases, spawners hand on their own parameters.
    """
    for spawner in launch.nodes:
        is_plain = spawner.parameters == () and not _is_typed(spawner.arguments or ())
        if _is_spawner(spawner) and spawner.when and is_plain:
            yield from list_controllers(spawner) or ()


_MANAGER_SECTION = Rule(
    "manager-section",
    "controllers",
    NO_CONTROLLER,
    "The types of controllers are below controller_manager.",
    why=(
        "The controller manager ignores a section with another name without a message. Later "
        "each spawner ends because the type of its controller is not defined."
    ),
    wrong="""
controller_manger:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters:
    {joints: [arm_joint], command_interfaces: [position], state_interfaces: [position]}
""",
    right="""
controller_manager:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters:
    {joints: [arm_joint], command_interfaces: [position], state_interfaces: [position]}
""",
    frame="controllers.yaml",
    beside={
        "arm/rover.urdf": "",
        "spawn/rover.launch.py": "",
    },
)


def _misspelt_managers(workspace: Workspace) -> Mismatches:
    """Yield the sections of types of controllers that are called nearly as the manager.

    They are yielded where none is called as the controller manager.
    """
    if not any(_is_spawner(node) for node in workspace.launches.nodes):
        return
    sections = []
    for tree in workspace.installed.trees:
        for keys, section in sections_in(tree):
            name = last_part(keys[-1]) if keys else ""
            if name == MANAGER:
                return
            if near(name, (MANAGER,)) is not None and _has_types(section):
                sections.append((name, tree.key_location(*keys)))
    for name, at in sections:
        message = f"the controller manager does not read the types below {name!r}"
        yield Mismatch(_MANAGER_SECTION, message, at).meaning(name, MANAGER)


def _has_types(section: YamlNode) -> bool:
    """Return whether parameters have the types of controllers."""
    types = [kind for node in section.table.values() if (kind := node.get("type"))]
    return any("/" in (kind.text or "") for kind in types)


def _no_controllers(workspace: Workspace) -> Mismatches:
    """Yield the controllers that spawners start while no file has any, as an empty one."""
    if any(isinstance(tree, YamlFault) for tree in workspace.installed.yaml.values()):
        return
    for package, launch in workspace.launches.roots:
        manager, lacking = _controllers_without_type(workspace, package, launch)
        if manager and lacking:
            quoted_names = [quoted(name) for name in sorted(filter(None, lacking))]
            names = enumerated(quoted_names, _MAX_CONTROLLERS)
            message = f"no parameter file of the controller manager has the type of {names}"
            yield Mismatch(_MANAGER_PARAMETERS, message, manager.location)


def _join_names(controllers: Sequence[Controller], word: str = "and") -> str:
    names = dict.fromkeys(quoted(controller.name) for controller in controllers)
    return enumerated(names, _MAX_CONTROLLERS, word)


_CONTROLLER_STARTED = Rule(
    "controller-started",
    "controllers",
    NO_CONTROLLER,
    "A spawner starts one of the controllers that move joints, and one that publishes.",
    why=(
        "A controller without a spawner is not loaded. Its joints do not move, or without joint"
        " states the links of the robot have no transforms in RViz."
    ),
    symptoms=(ACTION_NOT_CONNECTED,),
    wrong="""
Node(package='controller_manager', executable='ros2_control_node', parameters=[controllers]),
Node(package='controller_manager', executable='spawner', arguments=['arm_controller']),
""",
    right="""
Node(package='controller_manager', executable='ros2_control_node', parameters=[controllers]),
Node(package='controller_manager', executable='spawner', arguments=['arm_controller']),
Node(package='controller_manager', executable='spawner', arguments=['joint_state_broadcaster']),
""",
    frame="control/rover.launch.py",
    beside={
        "arm/rover.urdf": "",
        "controllers.yaml": """
controller_manager:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
arm_controller:
  ros__parameters:
    {joints: [arm_joint], command_interfaces: [position], state_interfaces: [position]}
""",
    },
    at="config/controllers.yaml",
)


def _not_started(workspace: Workspace, controllers: Sequence[Controller]) -> Facts:
    """Yield the controllers that publish, or that move joints, where none is spawned."""
    spawned = started_controllers(workspace)
    if spawned is None:
        return
    given_files = {*workspace.parameters.files, *workspace.parameters.controller_files}
    publishing = []
    moving = []
    for controller in controllers:
        if controller.location.path not in given_files:
            continue
        if controller.is_broadcaster:
            publishing.append(controller)
        else:
            moving.append(controller)
    for kind in (publishing, moving):
        if kind and spawned.isdisjoint(controller.name for controller in kind):
            text = f"no spawner starts {_join_names(kind, 'or')}"
            yield Mismatch(_CONTROLLER_STARTED, text, kind[0].location)


def started_controllers(workspace: Workspace) -> set[str | None] | None:
    """Return the controllers that spawners start.

    The result is None where something else may start some, or the name of one may be misspelt.
    """
    spawned = _spawned(workspace)
    if spawned is None or not workspace.robots.has_controller_manager:
        return None
    if spawned - {controller.name for controller in defined_controllers(workspace)}:
        return None
    return spawned


def _spawned(workspace: Workspace) -> set[str | None] | None:
    """Return the controllers that spawners start.

    The result is None without a spawner, or where something else may start some.
    """
    texts = workspace.texts.launch_texts + workspace.texts.python_texts
    if workspace.launches.unknown_nodes or any(map(_OTHER_STARTS.search, texts)):
        return None
    spawned = set()
    has_spawner = False
    for node in workspace.launches.nodes:
        if _is_spawner(node):
            has_spawner = True
            spawned |= {controller.node_name for controller in list_controllers(node) or ()}
        elif node.package == MANAGER and not _is_manager(node):
            return None
    return spawned if has_spawner else None
