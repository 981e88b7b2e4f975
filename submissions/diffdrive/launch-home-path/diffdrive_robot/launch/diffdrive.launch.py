from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("diffdrive_robot")
    controllers = PathJoinSubstitution([share, "config", "controllers.yaml"])
    robot = Command([
        "xacro ",
        PathJoinSubstitution([share, "urdf", "diffdrive.urdf.xacro"]),
        " use_mock_hardware:=",
        LaunchConfiguration("use_mock_hardware"),
    ])
    return LaunchDescription([
        DeclareLaunchArgument("gui", default_value="true", description="Start RViz"),
        DeclareLaunchArgument("drive", default_value="true", description="Drive in a circle"),
        DeclareLaunchArgument("use_mock_hardware", default_value="true"),
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[{"robot_description": ParameterValue(robot, value_type=str)}],
        ),
        Node(
            package="controller_manager",
            executable="ros2_control_node",
            parameters=[controllers],
            remappings=[("/diff_drive_controller/cmd_vel", "/cmd_vel")],
        ),
        Node(package="controller_manager", executable="spawner", arguments=["joint_state_broadcaster"]),
        Node(
            package="controller_manager",
            executable="spawner",
            arguments=["diff_drive_controller", "--param-file", controllers],
        ),
        Node(
            package="diffdrive_robot",
            executable="drive_circle.py",
            parameters=[controllers],
            condition=IfCondition(LaunchConfiguration("drive")),
        ),
        Node(
            package="rviz2",
            executable="rviz2",
            arguments=["-d", "/home/robo/roscourse_sim_ws/src/diffdrive_robot/rviz/diffdrive.rviz"],
            condition=IfCondition(LaunchConfiguration("gui")),
        ),
    ])
