from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare('my_robot')
    model = DeclareLaunchArgument('model', default_value=PathJoinSubstitution([share, 'my_robot.urdf']))
    gui = DeclareLaunchArgument('gui', default_value='false')
    description = ParameterValue(Command(['xacro ', LaunchConfiguration('model')]), value_type=str)

    ld = LaunchDescription([model, gui])
    ld.add_action(Node(
        package='robot_state_publisher',
        executable='robot_state_publisher',
        parameters=[{'robot_description': description}],
    ))
    for name, condition in (('joint_state_publisher', UnlessCondition), ('joint_state_publisher_gui', IfCondition)):
        ld.add_action(Node(package=name, executable=name, condition=condition(LaunchConfiguration('gui'))))
    ld.add_action(Node(
        package='rviz2',
        executable='rviz2',
        arguments=['-d', PathJoinSubstitution([share, 'my_robot.rviz'])],
    ))
    return ld
