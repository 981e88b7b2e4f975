"""Names of Ignition in robots, models and worlds of a workspace that uses Gazebo."""

from grader.base.text import counted
from grader.workspace.graph.gazebo_topics import elements_in
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    warning,
)
from grader.workspace.rules.rule_table import (
    FORM,
    Rule,
)

_PACKAGES = ("ros_gz", "ros_gz_sim", "ros_gz_bridge", "ros_gz_image", "gz_ros2_control")
_FOR_IGNITION = frozenset(("foxy", "galactic", "humble", "iron"))  # releases
_OLDER = ("ignition::gazebo::", "ignition-gazebo-", "libignition-gazebo-")
_NEWER = ("gz::sim::", "gz-sim-", "libgz-sim-")


_OLDER_GAZEBO = Rule(
    "older-gazebo",
    "words",
    FORM,
    "Plugins have the names of Gazebo, where the workspace uses that in place of Ignition.",
    why=(
        "Gazebo still loads such plugins with a warning. A later release does not know their "
        "names, and the sensor or motion is then missing."
    ),
    wrong="""
<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
<plugin filename="ignition-gazebo-imu-system" name="ignition::gazebo::systems::Imu"/>
""",
    right="""
<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
<plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>
""",
    frame="world.sdf",
)


def older_gazebo_facts(workspace: Workspace) -> Facts:
    """Yield the first plugin that has a name of Ignition beside names of Gazebo.

    Gazebo loads it with a warning until a later release. Names of Gazebo are those of other plugins
    and, where only releases are stated whose packages are for it, those of its packages in
    package.xml or of programs that launch files start: with Humble, they are for Fortress.
    """
    plugins = []
    is_newer = _uses_packages(workspace)
    for plugin, place in elements_in(workspace, "plugin"):
        workspace.charge(1)
        names = plugin.get("name", ""), plugin.get("filename", "")
        if any(name.startswith(_NEWER) for name in names):
            is_newer = True
        if any(name.startswith(_OLDER) for name in names):
            plugins.append((names, place(plugin)))
    if not is_newer or not plugins:
        return
    yield Compared("words")
    names, at = plugins[0]
    older = next(name for name in names if name.startswith(_OLDER))
    newer = older.replace("ignition::gazebo", "gz::sim").replace("ignition-gazebo", "gz-sim")
    message = f"{older} is a name of Ignition, and this is Gazebo: write {newer}"
    others = len({place.path for _, place in plugins}) - 1
    if others:
        message += f"; {counted(others, 'other file has', 'other files have')} such names, too"
    yield warning(_OLDER_GAZEBO, message, at).offering(older, newer)


def _uses_packages(workspace: Workspace) -> bool:
    """Return whether packages of Gazebo are used, with releases where they are not for Ignition."""
    if not workspace.releases or not _FOR_IGNITION.isdisjoint(workspace.releases):
        return False
    if any(node.package in _PACKAGES for node in workspace.launches.nodes):
        return True
    return any(package.depends_on(name) for package in workspace.packages for name in _PACKAGES)
