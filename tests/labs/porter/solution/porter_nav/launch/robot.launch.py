from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    use_sim_time = LaunchConfiguration("use_sim_time")
    xacro_file = PathJoinSubstitution([FindPackageShare("porter_nav"), "urdf", "porter.urdf.xacro"])
    return LaunchDescription([
        DeclareLaunchArgument("use_sim_time", default_value="false"),
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[{
                "robot_description": ParameterValue(Command(["xacro ", xacro_file]), value_type=str),
                "use_sim_time": use_sim_time,
            }],
        ),
        Node(
            package="tf2_ros",
            executable="static_transform_publisher",
            name="laser_mount",
            arguments=[
                "--x", "0.11", "--z", "0.12", "--yaw", "3.14159265",
                "--frame-id", "base_link", "--child-frame-id", "laser",
            ],
            parameters=[{"use_sim_time": use_sim_time}],
        ),
    ])
