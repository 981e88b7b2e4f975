import os
import xacro
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    path = os.path.join(get_package_share_directory('sensor_robot'), 'urdf', 'sensor_robot.urdf.xacro')
    robot = xacro.process_file(path).toxml()
    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher', parameters=[{'robot_description': robot}]),
        Node(package='joint_state_publisher', executable='joint_state_publisher'),
    ])
