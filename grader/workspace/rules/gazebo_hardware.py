"""The hardware of robots in Gazebo, and the plugin of ros2_control that loads it."""

from grader.base.names import first_part
from grader.base.patterns import on_use
from grader.ros.xml.elements import first_text
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_CONTROLLER,
    Rule,
)

_PACKAGES = ("gz_ros2_control", "ign_ros2_control", "gazebo_ros2_control")
_LIBRARY = on_use(r"(?:lib)?(\w+?_ros2_control)(?:-system)?(?:\.so)?")


def gazebo_hardware_facts(workspace: Workspace) -> Facts:
    """Yield hardware of another package than the plugin of Gazebo that loads it."""
    for robot in workspace.robots.known:
        loading = set()  # the packages whose plugins of Gazebo load the hardware
        for plugin in robot.root.iter("plugin"):
            library = _LIBRARY.fullmatch(plugin.get("filename", ""))
            if library and library[1] in _PACKAGES:
                loading.add(library[1])
        for system in robot.systems if loading else ():
            yield from _other_hardware(robot, system.findtext("hardware/plugin") or "", loading)


_GAZEBO_HARDWARE = Rule(
    "gazebo-hardware",
    "controllers",
    NO_CONTROLLER,
    "The plugin of ros2_control loads hardware of its own package.",
    why=(
        "Each plugin looks only for hardware classes of its own package. The hardware is not "
        "loaded, so no controller moves a joint in Gazebo."
    ),
    wrong="""
<ros2_control name="arm" type="system">
  <hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
</ros2_control>
<gazebo>
  <plugin filename="libign_ros2_control-system.so"
          name="ign_ros2_control::IgnitionROS2ControlPlugin"/>
</gazebo>
""",
    right="""
<ros2_control name="arm" type="system">
  <hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
</ros2_control>
<gazebo>
  <plugin filename="libgz_ros2_control-system.so"
          name="gz_ros2_control::GazeboSimROS2ControlPlugin"/>
</gazebo>
""",
    frame="rover.urdf",
)


def _other_hardware(robot: KnownRobot, hardware: str, loading: set[str]) -> Mismatches:
    """Yield that hardware is of a package for Gazebo whose plugin is not loaded."""
    name = first_part(hardware.strip())
    if name not in _PACKAGES or name in loading:
        return
    for element in robot.root.iterfind("ros2_control/hardware/plugin"):
        if first_text(element) == hardware.strip():
            message = (
                f"the plugin of {min(loading)} loads no hardware of {name}: both have to be of "
                "one package"
            )
            yield warning(_GAZEBO_HARDWARE, message, robot.place(element))
            return
