import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    return LaunchDescription([
        IncludeLaunchDescription(
            PathJoinSubstitution([FindPackageShare('urdf_launch'), 'launch', 'display.launch.py']),
            launch_arguments={
                'urdf_package': 'my_robot',
                'urdf_package_path': 'my_robot.urdf',
                'rviz_config': os.path.join(get_package_share_directory('my_robot'), 'my_robot.rviz'),
            }.items(),
        ),
    ])
