import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    share = get_package_share_directory('courier')
    params_file = LaunchConfiguration('params_file')

    return LaunchDescription([
        DeclareLaunchArgument('rviz', default_value='true', description='Start RViz'),
        DeclareLaunchArgument(
            'params_file', default_value=os.path.join(share, 'config', 'stops.yaml')),
        Node(
            package='courier', executable='chassis', name='chassis', output='screen'),
        Node(
            package='courier', executable='driver', name='driver',
            parameters=[params_file], output='screen'),
        Node(
            package='courier', executable='planner', name='planner',
            parameters=[params_file], output='screen'),
        Node(
            package='tf2_ros', executable='static_transform_publisher', name='map_to_odom',
            arguments=['--x', '1.0', '--frame-id', 'map', '--child-frame-id', 'odom']),
        Node(
            package='rviz2', executable='rviz2', name='rviz2',
            arguments=['-d', os.path.join(share, 'rviz', 'stops.rviz')],
            condition=IfCondition(LaunchConfiguration('rviz'))),
    ])
