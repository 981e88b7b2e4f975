from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, FindExecutable, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    bringup = FindPackageShare('lifter_gazebo')
    model = PathJoinSubstitution([FindPackageShare('lifter_description'), 'urdf', 'lifter.urdf.xacro'])
    description = ParameterValue(
        Command([FindExecutable(name='xacro'), ' ', model]), value_type=str)
    world = PathJoinSubstitution([bringup, 'worlds', 'bench.sdf'])

    gazebo = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            PathJoinSubstitution([FindPackageShare('ros_gz_sim'), 'launch', 'gz_sim.launch.py'])),
        launch_arguments={'gz_args': ['-r ', world]}.items())

    state_publisher = Node(
        package='robot_state_publisher', executable='robot_state_publisher',
        parameters=[{'robot_description': description, 'use_sim_time': True}])

    create = Node(
        package='ros_gz_sim', executable='create',
        arguments=['-topic', 'robot_description', '-name', 'lifter'], output='screen')

    bridge = Node(
        package='ros_gz_bridge', executable='parameter_bridge',
        parameters=[{'config_file': PathJoinSubstitution([bringup, 'config', 'bridge.yaml'])}])

    spawner = Node(
        package='controller_manager', executable='spawner',
        arguments=['joint_state_broadcaster', 'arm_controller', 'clamp_controller'])

    return LaunchDescription([gazebo, state_publisher, create, bridge, spawner])
