from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package="hallway", executable="eye"),
        Node(package="hallway", executable="driver"),
        Node(package="hallway", executable="odometry"),
        Node(package="tf2_ros", executable="static_transform_publisher",
             arguments=["--frame-id", "map", "--child-frame-id", "odom"]),
        Node(package="tf2_ros", executable="static_transform_publisher",
             arguments=["--x", "0.1", "--frame-id", "base_link", "--child-frame-id", "laser"]),
    ])
