from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("porter_nav")
    use_sim_time = LaunchConfiguration("use_sim_time")
    params_file = LaunchConfiguration("params_file")

    robot = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(PathJoinSubstitution([share, "launch", "robot.launch.py"])),
        launch_arguments={"use_sim_time": use_sim_time}.items(),
    )
    localization = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(PathJoinSubstitution([share, "launch", "localization.launch.py"])),
        launch_arguments={
            "map": LaunchConfiguration("map"),
            "params_file": params_file,
            "use_sim_time": use_sim_time,
        }.items(),
    )
    nav2 = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            PathJoinSubstitution([FindPackageShare("nav2_bringup"), "launch", "navigation_launch.py"])),
        launch_arguments={
            "params_file": params_file,
            "use_sim_time": use_sim_time,
            "use_composition": "False",
            "autostart": "true",
        }.items(),
    )
    rviz = Node(
        package="rviz2",
        executable="rviz2",
        arguments=["-d", PathJoinSubstitution([share, "rviz", "porter.rviz"])],
        parameters=[{"use_sim_time": use_sim_time}],
        condition=IfCondition(LaunchConfiguration("rviz")),
    )
    patrol = Node(
        package="porter_nav",
        executable="patrol.py",
        name="patrol",
        parameters=[
            PathJoinSubstitution([share, "config", "patrol.yaml"]),
            {"use_sim_time": use_sim_time},
        ],
        output="screen",
        condition=IfCondition(LaunchConfiguration("patrol")),
    )
    return LaunchDescription([
        DeclareLaunchArgument("map", default_value=PathJoinSubstitution([share, "maps", "hall.yaml"])),
        DeclareLaunchArgument(
            "params_file", default_value=PathJoinSubstitution([share, "config", "navigation.yaml"])),
        DeclareLaunchArgument("use_sim_time", default_value="false"),
        DeclareLaunchArgument("rviz", default_value="true"),
        DeclareLaunchArgument("patrol", default_value="false"),
        robot,
        localization,
        nav2,
        rviz,
        patrol,
    ])
