from launch import LaunchDescription
from launch.substitutions import Command, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    robot = PathJoinSubstitution([FindPackageShare("armkit_description"), "urdf", "armkit.urdf.xacro"])
    parameters = PathJoinSubstitution([FindPackageShare("armkit_bringup"), "config", "publisher.yaml"])
    description = ParameterValue(Command(["xacro ", robot]), value_type=str)
    return LaunchDescription([
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[parameters, {"robot_description": description}],
        ),
    ])
