from launch import LaunchDescription
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    parameters = FindPackageShare('cart_nav') / 'config' / 'nav2.yaml'
    return LaunchDescription([
        Node(package='nav2_controller', executable='controller_server', parameters=[parameters]),
        Node(package='nav2_lifecycle_manager', executable='lifecycle_manager',
             parameters=[{'autostart': True, 'node_names': ['controller_server']}]),
    ])
