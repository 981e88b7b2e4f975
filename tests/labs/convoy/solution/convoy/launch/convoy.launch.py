from launch import LaunchDescription
from launch_ros.actions import ComposableNodeContainer
from launch_ros.descriptions import ComposableNode


def generate_launch_description():
    return LaunchDescription([
        ComposableNodeContainer(
            name="vehicle",
            namespace="",
            package="rclcpp_components",
            executable="component_container",
            composable_node_descriptions=[
                ComposableNode(package="convoy", plugin="convoy::Seer"),
                ComposableNode(package="convoy", plugin="convoy::Follower"),
            ],
        ),
    ])
