import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    robot = PathJoinSubstitution([FindPackageShare("cart_description"), "urdf", "cart.urdf.xacro"])
    share = get_package_share_directory("cart_bringup")
    nodes = os.path.join(share, "config", "nodes.yaml")
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="true"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[
                    {
                        "robot_description": ParameterValue(
                            Command(["xacro ", robot]), value_type=str
                        ),
                        "use_sim_time": LaunchConfiguration("use_sim_time"),
                    }
                ],
            ),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                parameters=[{"config_file": os.path.join(share, "config", "bridge.yaml")}],
            ),
            Node(
                package="controller_manager",
                executable="spawner",
                arguments=["wheel_controller", "joint_state_broadcaster"],
                remappings=[("/wheel_controller/cmd_vel", "/cmd_vel")],
            ),
            Node(
                package="cart_nodes",
                executable="filter",
                name="filter",
                parameters=[nodes, {"max_range": 8.0}],
                remappings=[("scan_in", "scan_raw")],
            ),
            Node(package="cart_nodes", executable="driver"),
            Node(
                package="cart_watch",
                executable="watch",
                parameters=[{"limit": 0.5}],
            ),
        ]
    )
