from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("porter_nav")
    use_sim_time = LaunchConfiguration("use_sim_time")
    robot = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(PathJoinSubstitution([share, "launch", "robot.launch.py"])),
        launch_arguments={"use_sim_time": use_sim_time}.items(),
    )
    mapping = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            PathJoinSubstitution([FindPackageShare("slam_toolbox"), "launch", "online_async_launch.py"])),
        launch_arguments={
            "slam_params_file": PathJoinSubstitution([share, "config", "mapping.yaml"]),
            "use_sim_time": use_sim_time,
        }.items(),
    )
    return LaunchDescription([
        DeclareLaunchArgument("use_sim_time", default_value="false"),
        robot,
        mapping,
    ])
