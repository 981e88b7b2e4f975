from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("start_x", default_value="0.0"),
        DeclareLaunchArgument("start_y", default_value="0.0"),
        Node(
            package="dock_robot",
            executable="base",
            parameters=[{
                "x": ParameterValue(LaunchConfiguration("start_x"), value_type=float),
                "y": ParameterValue(LaunchConfiguration("start_y"), value_type=float),
            }],
        ),
    ])
