from pathlib import Path

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, LogInfo
from launch.substitutions import PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.actions import ComposableNodeContainer, LifecycleNode
from launch_ros.descriptions import ComposableLifecycleNode
from launch_ros.substitutions import FindPackagePrefix, FindPackageShare


def generate_launch_description():
    share = FindPackageShare('cart')
    return LaunchDescription([
        IncludeLaunchDescription(share / 'launch' / 'inner.launch.xml'),
        LogInfo(msg=FindPackagePrefix('cart') / 'lib' / 'cart'),
        LogInfo(msg=ThisLaunchFileDir() / 'inner.launch.xml'),
        LogInfo(msg=['in ', Path('maps') / 'hall.yaml']),
        LogInfo(msg=PathJoinSubstitution([share, Path('maps')])),
        LifecycleNode(package='lifecycle', executable='lifecycle_talker', name='lc', namespace='',
                      autostart=True),
        ComposableNodeContainer(
            package='rclcpp_components', executable='component_container', name='c', namespace='',
            composable_node_descriptions=[
                ComposableLifecycleNode(package='composition', plugin='composition::Talker',
                                        name='talker', autostart=True),
            ]),
    ])
