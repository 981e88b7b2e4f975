from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("cart_bringup")
    robot = PathJoinSubstitution([FindPackageShare("cart_description"), "urdf", "cart.urdf.xacro"])
    controllers = PathJoinSubstitution([share, "config", "controllers.yaml"])
    description = Command(["xacro ", robot, " controllers_file:=", controllers])
    sim_time = {"use_sim_time": LaunchConfiguration("sim_time")}
    return LaunchDescription([
        DeclareLaunchArgument("sim_time", default_value="true"),
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[{"robot_description": ParameterValue(description, value_type=str)}, sim_time],
        ),
        Node(package="controller_manager", executable="spawner", arguments=["joint_state_broadcaster"]),
        Node(
            package="controller_manager",
            executable="spawner",
            arguments=["wheel_controller", "--param-file", controllers],
        ),
        Node(
            package="tf2_ros",
            executable="static_transform_publisher",
            arguments=["--z", "0.1", "--frame-id", "base_link", "--child-frame-id", "laser"],
        ),
        Node(
            package="ros_gz_bridge",
            executable="parameter_bridge",
            parameters=[{"config_file": PathJoinSubstitution([share, "config", "bridge.yaml"])}],
        ),
    ])
