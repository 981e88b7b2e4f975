from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LifecycleNode, Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    config = PathJoinSubstitution([FindPackageShare("laundry"), "config", "laundry.yaml"])
    two = LaunchConfiguration("two")
    return LaunchDescription(
        [
            DeclareLaunchArgument("two", default_value="false"),
            LifecycleNode(
                package="laundry",
                executable="drum",
                name="drum",
                namespace="",
                parameters=[config],
                condition=UnlessCondition(two),
            ),
            LifecycleNode(
                package="laundry",
                executable="drum",
                name="left",
                namespace="",
                parameters=[{"period": 0.5}],
                condition=IfCondition(two),
            ),
            LifecycleNode(
                package="laundry",
                executable="drum",
                name="right",
                namespace="",
                parameters=[{"period": 0.5}],
                condition=IfCondition(two),
            ),
            Node(package="laundry", executable="door", name="door"),
            Node(package="laundry", executable="panel", name="panel", parameters=[config], output="screen"),
        ]
    )
