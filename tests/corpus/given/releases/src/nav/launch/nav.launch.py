import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    share = get_package_share_directory('nav')
    nav2 = os.path.join(share, 'config', 'nav2.yaml')
    drive = os.path.join(share, 'config', 'drive.yaml')
    gazebo = get_package_share_directory('ros_ign_gazebo')
    return LaunchDescription([
        IncludeLaunchDescription(os.path.join(gazebo, 'launch', 'ign_gazebo.launch.py')),
        Node(package='nav2_controller', executable='controller_server', parameters=[nav2]),
        Node(package='nav2_recoveries', executable='recoveries_server', parameters=[nav2]),
        Node(package='controller_manager', executable='ros2_control_node', parameters=[drive]),
        Node(
            package='controller_manager',
            executable='spawner.py',
            arguments=['drive'],
            remappings=[('/drive/cmd_vel_unstamped', '/cmd_vel')],
        ),
    ])
