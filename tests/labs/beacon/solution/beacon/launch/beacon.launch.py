import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    share = get_package_share_directory("beacon")
    parameters = os.path.join(share, "config", "beacon.yaml")
    with open(os.path.join(share, "urdf", "lamp.urdf")) as file:
        description = file.read()
    return LaunchDescription([
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{"robot_description": description}]),
        Node(package="beacon", executable="orbiter", parameters=[parameters]),
        Node(package="beacon", executable="watcher", parameters=[parameters]),
    ])
