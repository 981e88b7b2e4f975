from launch import LaunchDescription
from launch.actions import DeclareBooleanLaunchArgument, GroupAction, LogError, LogWarning
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, StringJoinSubstitution


def generate_launch_description():
    sliders = LaunchConfiguration('sliders')
    return LaunchDescription([
        DeclareBooleanLaunchArgument('sliders', default_value=True, description='Show sliders'),
        GroupAction([LogWarning(msg=['sliders: ', sliders])], condition=IfCondition(sliders)),
        LogError(msg=StringJoinSubstitution(['no', 'sliders'], delimiter=' ')),
    ])
