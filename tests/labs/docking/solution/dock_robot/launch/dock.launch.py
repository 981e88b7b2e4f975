from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import LifecycleNode, Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("dock_robot")
    parameters = PathJoinSubstitution([share, "config", "dock.yaml"])
    return LaunchDescription([
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(PathJoinSubstitution([share, "launch", "base.launch.py"])),
            launch_arguments={"start_x": "-1.0", "start_y": "0.5"}.items(),
        ),
        Node(
            package="tf2_ros",
            executable="static_transform_publisher",
            name="dock_pose",
            arguments=["--x", "2.0", "--yaw", "3.14159",
                       "--frame-id", "odom", "--child-frame-id", "dock"],
        ),
        LifecycleNode(
            package="dock_robot", executable="battery", name="battery", namespace="",
            parameters=[parameters],
        ),
        Node(
            package="nav2_lifecycle_manager",
            executable="lifecycle_manager",
            name="lifecycle_manager",
            parameters=[{"autostart": True, "bond_timeout": 0.0, "node_names": ["battery"]}],
        ),
        Node(package="dock_robot", executable="dock_server", parameters=[parameters]),
    ])
