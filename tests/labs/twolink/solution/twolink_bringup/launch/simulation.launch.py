from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, RegisterEventHandler
from launch.conditions import IfCondition, UnlessCondition
from launch.event_handlers import OnProcessExit
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("twolink_bringup")
    gui = LaunchConfiguration("gui")
    world = PathJoinSubstitution([share, "worlds", "bench.sdf"])
    controllers = PathJoinSubstitution([share, "config", "controllers.yaml"])
    description = Command([
        "xacro ",
        PathJoinSubstitution([FindPackageShare("twolink_description"), "urdf", "twolink.urdf.xacro"]),
        " controllers_file:=", controllers,
    ])
    gz_sim = PythonLaunchDescriptionSource(
        PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"]))
    sim_time = {"use_sim_time": True}

    state_publisher = Node(
        package="robot_state_publisher",
        executable="robot_state_publisher",
        parameters=[{"robot_description": ParameterValue(description, value_type=str)}, sim_time],
    )
    create = Node(
        package="ros_gz_sim",
        executable="create",
        arguments=["-world", "bench", "-topic", "robot_description", "-name", "twolink"],
    )
    bridge = Node(
        package="ros_gz_bridge",
        executable="parameter_bridge",
        parameters=[{"config_file": PathJoinSubstitution([share, "config", "bridge.yaml"])}],
    )
    broadcaster = Node(
        package="controller_manager",
        executable="spawner",
        arguments=["joint_state_broadcaster"],
    )
    arm = Node(
        package="controller_manager",
        executable="spawner",
        arguments=["arm_controller", "--param-file", controllers],
    )
    sender = Node(
        package="twolink_bringup",
        executable="pose_sender",
        name="pose_sender",
        parameters=[PathJoinSubstitution([share, "config", "poses.yaml"]), sim_time],
    )
    light_meter = Node(
        package="twolink_bringup",
        executable="light_meter.py",
        name="light_meter",
        parameters=[sim_time],
    )
    return LaunchDescription([
        DeclareLaunchArgument("gui", default_value="true"),
        IncludeLaunchDescription(
            gz_sim, launch_arguments={"gz_args": ["-r ", world]}.items(), condition=IfCondition(gui)),
        IncludeLaunchDescription(
            gz_sim, launch_arguments={"gz_args": ["-r -s ", world]}.items(), condition=UnlessCondition(gui)),
        state_publisher,
        create,
        bridge,
        RegisterEventHandler(OnProcessExit(target_action=create, on_exit=[broadcaster])),
        RegisterEventHandler(OnProcessExit(target_action=broadcaster, on_exit=[arm])),
        RegisterEventHandler(OnProcessExit(target_action=arm, on_exit=[sender])),
        light_meter,
    ])
