from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("cart_bringup")
    detector = PathJoinSubstitution([share, "config", "detector.yaml"])
    navigation = PathJoinSubstitution([share, "config", "navigation.yaml"])
    return LaunchDescription([
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(PathJoinSubstitution([share, "launch", "robot.launch.py"])),
            launch_arguments={"sim_time": "true"}.items(),
        ),
        Node(
            package="cart_nodes",
            executable="detector",
            name="detector",
            parameters=[detector],
            remappings=[("image", "camera/image")],
        ),
        Node(package="cart_nodes", executable="alarm", parameters=[{"volume": 3}]),
        Node(
            package="nav2_map_server",
            executable="map_server",
            name="map_server",
            parameters=[{"yaml_filename": PathJoinSubstitution([share, "worlds", "hall.yaml"])}],
        ),
        Node(
            package="nav2_controller",
            executable="controller_server",
            name="controller_server",
            parameters=[navigation],
        ),
        Node(
            package="nav2_lifecycle_manager",
            executable="lifecycle_manager",
            name="lifecycle_manager",
            parameters=[{"node_names": ["map_server", "controller_server"]}],
        ),
    ])
