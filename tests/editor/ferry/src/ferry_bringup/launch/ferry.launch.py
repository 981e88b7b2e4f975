from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare('ferry_bringup')
    model = PathJoinSubstitution(
        [FindPackageShare('ferry_description'), 'urdf', 'ferry.urdf.xacro']
    )
    description = ParameterValue(Command(['xacro ', model]), value_type=str)
    controllers = PathJoinSubstitution([share, 'config', 'controllers.yaml'])
    hoist = PathJoinSubstitution([FindPackageShare('ferry_hoist'), 'launch', 'hoist.launch.xml'])
    return LaunchDescription(
        [
            DeclareLaunchArgument('rviz', default_value='true'),
            DeclareLaunchArgument('height', default_value='0.8'),
            Node(
                package='robot_state_publisher',
                executable='robot_state_publisher',
                parameters=[{'robot_description': description}],
            ),
            Node(
                package='controller_manager',
                executable='ros2_control_node',
                parameters=[controllers],
                remappings=[
                    ('~/robot_description', '/robot_description'),
                    ('/paddles/cmd_vel', '/cmd_vel'),
                    ('/paddles/odom', '/odom'),
                ],
            ),
            Node(
                package='controller_manager',
                executable='spawner',
                arguments=['paddles', 'joint_state_broadcaster'],
            ),
            Node(
                package='ferry_deck',
                executable='pilot',
                parameters=[{'cruise_speed': 0.6}],
            ),
            IncludeLaunchDescription(
                hoist, launch_arguments={'height': LaunchConfiguration('height')}.items()
            ),
            Node(
                package='rviz2',
                executable='rviz2',
                arguments=['-d', PathJoinSubstitution([share, 'rviz', 'ferry.rviz'])],
            ),
        ]
    )
