"""The worlds of Gazebo that launch files start, and the systems that it loads in them."""

from collections.abc import Sequence

from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.ros.xml.parsing import XmlFile
from grader.workspace.graph.gazebo_topics import name_system, roots
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.model.workspace import Workspace

# What Gazebo loads in a world without plugins: server.config of gz-sim8.
_DEFAULT_SYSTEMS = ("Physics", "UserCommands", "SceneBroadcaster")
# The packages whose programs show a robot.
_SHOWING = frozenset(
    {
        *("robot_state_publisher", "joint_state_publisher", "joint_state_publisher_gui"),
        *("rviz2", "tf2_ros"),
    }
)
_SIMULATION = "ros_gz_sim"
_OTHER_PROGRAMS = ("create", "remove", "set_entity_pose")  # of that package
# The launch files and commands that start Gazebo, which other packages also have.
_STARTS = on_use(r"ros_gz_sim/|gz_sim|gz_server|gzserver|gazebo|\bgz sim\b|\bign\b")
_OF_GAZEBO = on_use(r"(lib)?(gz-sim|ignition-gazebo)\d*-")
# Libraries whose systems have other names: CMakeLists.txt in src/systems of gz-sim8.
_OTHER_NAMES = {
    "multicopter-control": ("MulticopterVelocityControl",),
    "log": ("LogRecord", "LogPlayback"),
    "dvl": ("DopplerVelocityLogSystem", "DopplerVelocityLog"),
}
_LIBRARY = on_use(r"(?:lib)?(?:gz-sim|ignition-gazebo)\d*-([\w-]+)-system(?:\.so)?")


class _StartedWorlds(Named):
    """The worlds that launch files start, and the systems that Gazebo loads in them.

    Systems have the names of their classes. Those of models and robots are among them, and in a
    world without plugins, those that Gazebo loads by default.
    """

    files: list[XmlFile]  # that launch files name; without one, the only world there is
    has_others: bool  # whether the packages have worlds, and none of them is known to be started
    may_start: bool  # whether a launch file starts Gazebo, or something that is not known
    systems: frozenset[str]  # of Gazebo
    own_systems: frozenset[str]  # of other libraries
    misnamed: dict[str, tuple[str, Location]]  # with a library that Gazebo does not have


def started_worlds(workspace: Workspace) -> _StartedWorlds:
    """Return the worlds that launch files start."""
    worlds = _worlds(workspace)
    named = _named_worlds(workspace, worlds)
    files = named or (worlds if len(worlds) == 1 else [])
    systems = set()
    own_systems = set()
    misnamed = {}
    others = [world.root for world in worlds if files and world not in files]
    for root, place in roots(workspace):
        if any(root is other for other in others):
            continue
        for plugin in root.iter("plugin"):
            system = name_system(plugin)
            library = plugin.get("filename", "")
            if not _has_system(library, system):
                misnamed[system] = library, place(plugin)
            elif _LIBRARY.fullmatch(library):
                systems.add(system)
            else:
                own_systems.add(system)
    if any(_has_default_systems(file) for file in files):
        systems.update(_DEFAULT_SYSTEMS)
    return _StartedWorlds(
        files=files,
        has_others=bool(worlds) and not files,
        may_start=not named or _may_start_gazebo(workspace),
        systems=frozenset(systems),
        own_systems=frozenset(own_systems),
        misnamed=misnamed,
    )


def _has_default_systems(file: XmlFile) -> bool:
    """Return whether a world has no plugins."""
    worlds = file.root.iterchildren("world")
    return any(next(world.iterchildren("plugin"), None) is None for world in worlds)


def _worlds(workspace: Workspace) -> list[XmlFile]:
    worlds = []
    for file in workspace.texts.sdf_files:
        if next(file.root.iterchildren("world"), None) is not None:
            worlds.append(file)
    return worlds


def _named_worlds(workspace: Workspace, worlds: Sequence[XmlFile]) -> list[XmlFile]:
    """Return the worlds that launch files name."""
    texts = list(workspace.texts.searched_launch_texts())
    named = []
    for file in worlds:
        name = last_part(file.source.path)
        if any(name in text for text in texts):
            named.append(file)
    return named


def _may_start_gazebo(workspace: Workspace) -> bool:
    """Return whether a launch file starts Gazebo, or something that is not known."""
    if workspace.launches.unknown_nodes:
        return True
    for node in workspace.launches.nodes:
        if node.package == _SIMULATION and node.executable not in _OTHER_PROGRAMS:
            return True
    for launch in workspace.launches.outermost:
        included = [passed.path for passed in launch.passed]
        if any(_STARTS.search(text) for text in (*included, *launch.command_texts)):
            return True
    return False


def _has_system(library: str, system: str) -> bool:
    """Return whether a library has a system; one that is not of Gazebo may have any."""
    name = last_part(library)
    if not _OF_GAZEBO.match(name):
        return True
    match = _LIBRARY.fullmatch(name)
    if not match:
        return False
    return system in _OTHER_NAMES.get(match[1], ()) or match[1].replace("-", "") == system.lower()


def has_programs(workspace: Workspace) -> bool:
    """Return whether a workspace has nodes, controllers or a world, not only a robot to show."""
    if workspace.code.nodes:
        return True
    if any(node.package not in _SHOWING for node in workspace.launches.nodes):
        return True
    return bool(defined_controllers(workspace) or started_worlds(workspace).files)
