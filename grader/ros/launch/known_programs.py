"""The packages of ROS 2 that every machine of a lab has, and the programs of those whose
programs are all known.
"""

from collections.abc import Sequence

# By the CMakeLists.txt and setup.py of the packages in ROS 2 Jazzy: what they install to
# lib/<package>.
_PROGRAMS = {
    "rviz2": "rviz2",
    "rviz_common": "",
    "rviz_default_plugins": "",
    "rviz_rendering": "",
    "robot_state_publisher": "robot_state_publisher",
    "joint_state_publisher": "joint_state_publisher",
    "joint_state_publisher_gui": "joint_state_publisher_gui",
    "xacro": "xacro",
    "urdf": "",
    "urdf_launch": "",
    "tf2_ros": "buffer_server static_transform_publisher tf2_echo tf2_monitor",
    "tf2": "",
    "tf2_tools": "view_frames",
    "turtlesim": "draw_square mimic turtle_teleop_key turtlesim_node",
    "rqt_graph": "rqt_graph",
    "rqt_gui": "rqt_gui",
    "teleop_twist_keyboard": "teleop_twist_keyboard",
    "launch": "",
    "launch_ros": "",
    "ros2launch": "",
    "rclpy": "",
    "rclcpp": "",
}
_OTHERS = ("demo_nodes_cpp", "demo_nodes_py", "rosbag2", "ros2bag")


def is_part_of_ros(package: str) -> bool:
    """Return whether a package is on every machine of a lab, whether package.xml names it or
    not.
    """
    return package in _OTHERS or package in _PROGRAMS


def programs_of(package: str) -> Sequence[str]:
    """Return the programs of a well-known package, if all are known."""
    return _PROGRAMS.get(package, "").split()


def lacks_program(package: str, name: str) -> bool:
    """Return whether a well-known package certainly has no such program."""
    return package in _PROGRAMS and name not in programs_of(package)
