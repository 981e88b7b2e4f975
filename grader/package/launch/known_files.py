"""Launch files of well-known ROS 2 packages, which submissions include but do not contain: the nodes they start."""

from collections.abc import Mapping

from grader.package.launch.model import STATE_PUBLISHER, Contents, Context, Findings, Purpose, StartedNode
from grader.package.launch.places import PREFIX, ROS, SHARE
from grader.package.launch.substitutions import resolve
from grader.static_python.values import Call, Unknown

_RVIZ = "rviz2"
_GIVEN: Mapping[str, Purpose] = {STATE_PUBLISHER: "urdf", _RVIZ: "rviz"}  # the nodes that are given a file
_URDF_LAUNCH, _TURTLEBOT = "urdf_launch/launch/", "turtlebot3_gazebo/launch/"
# Which of robot_state_publisher, joint_state_publisher, joint_state_publisher_gui and rviz2 a file below share starts,
# with the defaults of its arguments, as read in the repository on GitHub that is named behind it.
_STARTS: dict[str, tuple[str, ...]] = {
    f"{_URDF_LAUNCH}description.launch.py": (STATE_PUBLISHER,),  # ros/urdf_launch
    f"{_URDF_LAUNCH}display.launch.py": (STATE_PUBLISHER, "joint_state_publisher_gui", _RVIZ),  # ros/urdf_launch
    "nav2_bringup/launch/rviz_launch.py": (_RVIZ,),  # ros-navigation/navigation2
    f"{_TURTLEBOT}robot_state_publisher.launch.py": (STATE_PUBLISHER,),  # ROBOTIS-GIT/turtlebot3_simulations
    f"{_TURTLEBOT}turtlebot3_world.launch.py": (STATE_PUBLISHER,),  # ROBOTIS-GIT/turtlebot3_simulations
}
# The files in the folder launch of a package that start none of these nodes.
_NONE = {
    "ros_gz_sim": "gz_sim.launch.py gz_server.launch.py gz_spawn_model.launch.py ros_gz_sim.launch.py "
    "ros_gz_spawn_model.launch.py",  # gazebosim/ros_gz; gz_sim.launch.py is made of gz_sim.launch.py.in
    "ros_gz_bridge": "ros_gz_bridge.launch.py",  # gazebosim/ros_gz
    "ros_ign_gazebo": "ign_gazebo.launch.py",  # gazebosim/ros_gz
    "gazebo_ros": "gazebo.launch.py gzclient.launch.py gzserver.launch.py",  # ros-simulation/gazebo_ros_pkgs, ros2
    "slam_toolbox": "lifelong_launch.py localization_launch.py offline_launch.py online_async_launch.py "
    "online_sync_launch.py",  # SteveMacenski/slam_toolbox
    "nav2_bringup": "bringup_launch.py localization_launch.py navigation_launch.py slam_launch.py",  # as rviz_launch.py
    "robot_localization": "ekf.launch.py",  # cra-ros-pkg/robot_localization
    "turtlebot3_gazebo": "spawn_turtlebot3.launch.py",  # ROBOTIS-GIT/turtlebot3_simulations
    "teleop_twist_joy": "teleop-launch.py",  # ros2/teleop_twist_joy
    "realsense2_camera": "rs_launch.py",  # realsenseai/realsense-ros
    "ydlidar_ros2_driver": "ydlidar_launch.py",  # YDLIDAR/ydlidar_ros2_driver
}
_STARTS |= {f"{package}/launch/{name}": () for package, names in _NONE.items() for name in names.split()}


def start_known_file(findings: Findings, path: str, call: Call, context: Context) -> bool:
    """Add what an included launch file of a well-known package starts; return whether the path is that of one."""
    prefix, _, name = path.rpartition("/share/")
    nodes = _STARTS.get(name) if prefix.startswith((PREFIX, ROS)) else None
    if nodes is None:
        return False
    findings.nodes += [StartedNode(node, node, context.when, findings.locate(call.at)) for node in nodes]
    for node in nodes:
        if node in _GIVEN and not name.startswith(_URDF_LAUNCH):
            findings.refer(_GIVEN[node], Unknown(f"{name} decides which file {node} gets", call.at), call)
    if name.startswith(_URDF_LAUNCH):
        _refer_files(findings, call, context, is_shown=_RVIZ in nodes)
    return True


def _refer_files(findings: Findings, call: Call, context: Context, *, is_shown: bool) -> None:
    """Add the files that the arguments of urdf_launch name."""
    given = [context.arguments.get(key) for key in ("urdf_package", "urdf_package_path")]
    match [resolve(value, context) for value in given]:
        case [str() as package, str() as urdf]:
            findings.refer("urdf", Contents(f"{SHARE}/{package}/{urdf}", "xacro"), call)
        case values:
            unknown = next(value for value in values if not isinstance(value, str))
            is_missing = None in given or isinstance(unknown, Contents)
            message = "urdf_launch needs the arguments urdf_package and urdf_package_path"
            findings.refer("urdf", None if is_missing else unknown, call, wrong=message)
    opened = resolve(context.arguments.get("rviz_config", Contents("", "")), context)
    if is_shown and isinstance(opened, Contents):
        message = "urdf_launch is included without rviz_config, so it opens its own configuration, not the lab's"
        findings.refer("rviz", None, call, wrong=message)
    elif is_shown:
        findings.refer("rviz", opened, call)
