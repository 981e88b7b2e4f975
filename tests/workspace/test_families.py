"""What each family compares: a mistake in the workspace of the cart, and other ways to write it that agree."""

import pytest

from grader.workspace.rules.rule_table import Family
from tests.workspace.carts import Edit, agreement_of, edited, sure

_LAUNCH, _ROBOT_LAUNCH = "launch/cart.launch.py", "launch/robot.launch.py"
_CONTROLLERS, _URDF = "config/controllers.yaml", "cart.urdf.xacro"
_AT_LAUNCH = "cart_bringup/launch/cart.launch.py"
_OWN_PROGRAM = 'Node(package="cart_bringup", executable="monitor"),'
_DETECTOR, _ALARM = "cart_nodes/detector.py", "cart_nodes/alarm.py"
_WITH_MANAGER: list[Edit] = [
    (
        _ROBOT_LAUNCH,
        'executable="robot_state_publisher",',
        'executable="robot_state_publisher", arguments=[],',
    ),
    (
        _ROBOT_LAUNCH,
        "    return LaunchDescription([",
        '    return LaunchDescription([Node(package="controller_manager", executable="ros2_control_node", parameters=[controllers]),',
    ),
]
_IN_MACRO: list[Edit] = [
    (
        _URDF,
        '<ros2_control name="CartSystem"',
        '<xacro:macro name="control"><ros2_control name="CartSystem"',
    ),
    (_URDF, "</ros2_control>", "</ros2_control></xacro:macro>"),
]

WRONG: list[tuple[Family, str, list[Edit]]] = [
    (
        "files",
        (
            "a build installs no share/cart_bringup/config/detectors.yaml: the package has no file 'detectors.yaml';"
            " did you mean 'detector.yaml'?"
        ),
        [(_LAUNCH, '"detector.yaml"', '"detectors.yaml"')],
    ),
    (
        "files",
        (
            "a build installs no share/cart_bringup/config/hall.yaml: it installs the file as"
            " share/cart_bringup/worlds/hall.yaml"
        ),
        [(_LAUNCH, '"worlds"', '"config"')],
    ),
    (
        "files",
        (
            "a build installs no share/cart_bringup/worlds/hall.yaml: no install() in CMakeLists.txt names"
            " worlds/hall.yaml"
        ),
        [("cart_bringup/CMakeLists.txt", " worlds", "")],
    ),
    (
        "files",
        "the image of the map, 'hall.png', does not exist; did you mean 'hall.pgm'?",
        [("worlds/hall.yaml", "hall.pgm", "hall.png")],
    ),
    (
        "files",
        "there is no package 'cart_bringups'; did you mean 'cart_bringup'?",
        [
            (
                "navigation.yaml",
                "controller_plugins",
                "tree: $(find-pkg-share cart_bringups)/tree.xml\n    controller_plugins",
            )
        ],
    ),
    (
        "files",
        (
            "a build installs no share/cart_bringup/worlds/halls.yaml: the package has no file 'halls.yaml';"
            " did you mean 'hall.yaml'?"
        ),
        [
            (
                "navigation.yaml",
                "controller_plugins",
                "maps: [{map: $(find-pkg-share cart_bringup)/worlds/halls.yaml}]\n    controller_plugins",
            )
        ],
    ),
    (
        "frames",
        (
            "wheel_controller.left_wheel_names: there is no joint 'wheel_left_joint'; did you mean 'left_wheel_joint'"
            " (cart_description/urdf/wheel.xacro:5)?"
        ),
        [(_CONTROLLERS, "[left_wheel_joint]", "[wheel_left_joint]")],
    ),
    (
        "frames",
        (
            "static_transform_publisher: there is no frame 'base'; did you mean 'base_link'"
            " (cart_description/urdf/cart.urdf.xacro:5)?"
        ),
        [(_ROBOT_LAUNCH, '"base_link"', '"base"')],
    ),
    (
        "frames",
        "the frame 'left_wheel' has two parents: 'base_link' in the robot, 'camera_link' here",
        [
            (
                _ROBOT_LAUNCH,
                '"base_link", "--child-frame-id", "laser"',
                '"camera_link", "--child-frame-id", "left_wheel"',
            )
        ],
    ),
    (
        "frames",
        (
            "<gazebo reference>: there is no link 'camera'; did you mean 'camera_link'"
            " (cart_description/urdf/cart.urdf.xacro:8)?"
        ),
        [(_URDF, 'reference="camera_link"', 'reference="camera"')],
    ),
    (
        "frames",
        (
            "<gz_frame_id>: there is no frame 'camera'; did you mean 'camera_link'"
            " (cart_description/urdf/cart.urdf.xacro:8)?"
        ),
        [(_URDF, "id>camera_link", "id>camera")],
    ),
    (
        "frames",
        (
            "<ros2_control>: there is no joint 'left_joint'; did you mean 'left_wheel_joint'"
            " (cart_description/urdf/wheel.xacro:5)?"
        ),
        [(_URDF, '"left_wheel_joint"', '"left_joint"')],
    ),
    (
        "frames",
        (
            "the parameter mimic: there is no joint 'left_joint'; did you mean 'left_wheel_joint'"
            " (cart_description/urdf/wheel.xacro:5)?"
        ),
        [
            (
                _URDF,
                '"right_wheel_joint">\n',
                '"right_wheel_joint"><param name="mimic">left_joint</param>\n',
            )
        ],
    ),
    (
        "controllers",
        (
            "spawner: there is no controller 'cart_controller'; did you mean 'wheel_controller'"
            " (cart_bringup/config/controllers.yaml:6)?"
        ),
        [(_ROBOT_LAUNCH, '"wheel_controller"', '"cart_controller"')],
    ),
    (
        "controllers",
        (
            "wheel_controller.type: there is no controller of the type 'diff_drive_controller/DiffDrive'; did"
            " you mean 'diff_drive_controller/DiffDriveController'?"
        ),
        [(_CONTROLLERS, "/DiffDriveController", "/DiffDrive")],
    ),
    (
        "controllers",
        (
            "the controller 'wheel_controller' has no parameters: there is no key wheel_controller with"
            " ros__parameters"
        ),
        [(_CONTROLLERS, "\nwheel_controller:", "\nwheels:")],
    ),
    (
        "controllers",
        (
            "wheel_controller needs the command interface left_wheel_joint/velocity; <ros2_control> has position"
            " (cart_description/urdf/cart.urdf.xacro:18)"
        ),
        [
            (
                _URDF,
                '"left_wheel_joint">\n      <command_interface name="velocity"',
                '"left_wheel_joint">\n      <command_interface name="position"',
            )
        ],
    ),
    (
        "controllers",
        (
            "wheel_controller needs the command interface right_wheel_joint/velocity; <ros2_control> has no joint"
            " 'right_wheel_joint'"
        ),
        [
            (
                _URDF,
                """
    <joint name="right_wheel_joint">
      <command_interface name="velocity"/> <state_interface name="position"/>
      <state_interface name="velocity"/>
    </joint>""",
                "",
            )
        ],
    ),
    (
        "controllers",
        "the controller manager is started, but the robot has no <ros2_control>",
        [
            (_URDF, '<ros2_control name="CartSystem" type="system">', "<control>"),
            (_URDF, "</ros2_control>", "</control>"),
            *_WITH_MANAGER,
        ],
    ),
    (
        "controllers",
        "the controller manager is started, but the robot has no <ros2_control>",
        [*_IN_MACRO, *_WITH_MANAGER],
    ),
    (
        "controllers",
        (
            "joint_state_broadcaster.type: there is no controller of the type"
            " 'joint_state_broadcaste/JointStateBroadcaster'; did you mean 'joint_state_broadcaster/JointStateBroadcaster'?"
        ),
        [(_CONTROLLERS, "joint_state_broadcaster/Joint", "joint_state_broadcaste/Joint")],
    ),
    (
        "controllers",
        "ActionClient: there is no controller 'limb'",
        [
            (
                _ALARM,
                "import rclpy\n",
                "import rclpy\nfrom control_msgs.action import FollowJointTrajectory\nfrom rclpy.action import ActionClient\n",
            ),
            (
                "cart_nodes/package.xml",
                "<exec_depend>rclpy",
                "<exec_depend>control_msgs</exec_depend><exec_depend>rclpy",
            ),
            (
                _ALARM,
                'self.declare_parameter("volume", 5)',
                (
                    'self.declare_parameter("volume", 5)\n'
                    '        ActionClient(self, FollowJointTrajectory, "/limb/follow_joint_trajectory")'
                ),
            ),
        ],
    ),
    (
        "parameters",
        "imu0_config has 3 values; it needs 15: x y z, angles, their rates and accelerations",
        [
            (
                "config/detector.yaml",
                "  ros__parameters:\n",
                "  ros__parameters:\n    imu0_config: [true, true, false]\n",
            ),
            (
                _DETECTOR,
                'self.declare_parameter("threshold", 0.5)',
                'self.declare_parameter("threshold", 0.5); self.declare_parameter("imu0_config", [])',
            ),
        ],
    ),
    (
        "parameters",
        (
            "'robot_state_publisher' stops without the parameter robot_description, which it does not get; did you"
            " mean it by 'robot_descripton'?"
        ),
        [(_ROBOT_LAUNCH, '"robot_description"', '"robot_descripton"')],
    ),
    (
        "parameters",
        "there are parameters for detect, but none for the node 'detector', which gets this file",
        [("config/detector.yaml", "detector:", "detect:")],
    ),
    (
        "parameters",
        "threshold is not below a key ros__parameters, so rcl cannot read the file",
        [
            (
                "config/detector.yaml",
                "  ros__parameters:\n    threshold: 0.5\n    camera_frame: camera_link",
                "  threshold: 0.5",
            )
        ],
    ),
    (
        "parameters",
        "ROS 2 reads no aliases in parameter files: write the value in place of *wheels",
        [
            (_CONTROLLERS, "[left_wheel_joint]", "&wheels [left_wheel_joint]"),
            (_CONTROLLERS, "[right_wheel_joint]", "*wheels"),
        ],
    ),
    (
        "parameters",
        (
            "robot_description is no XML, so robot_state_publisher stops: give it the content of the file, not the"
            " path"
        ),
        [(_ROBOT_LAUNCH, "ParameterValue(description, value_type=str)", "robot")],
    ),
    (
        "parameters",
        (
            "the parameter 'threshold' is given an integer; its node declares a double"
            " (cart_nodes/cart_nodes/detector.py:10), and stops"
        ),
        [("config/detector.yaml", "threshold: 0.5", "threshold: 1")],
    ),
    (
        "parameters",
        (
            "the parameter 'threshold' is given an integer; its node declares a double"
            " (cart_nodes/cart_nodes/detector.py:10), and stops"
        ),
        [(_LAUNCH, "parameters=[detector]", 'parameters=[{"threshold": 1}]')],
    ),
    (
        "parameters",
        (
            "the parameter 'threshold' is given an integer; its node declares a double"
            " (cart_nodes/cart_nodes/detector.py:10), and stops"
        ),
        [
            (_LAUNCH, "import PathJoin", "import LaunchConfiguration, PathJoin"),
            (
                _LAUNCH,
                "parameters=[detector]",
                'parameters=[{"threshold": LaunchConfiguration("level", default="1")}]',
            ),
        ],
    ),
    (
        "parameters",
        (
            "the parameter 'threshold' is given an integer; its node declares a double"
            " (cart_nodes/cart_nodes/detector.py:10), and stops"
        ),
        [
            (
                _LAUNCH,
                "parameters=[detector]",
                'parameters=[], ros_arguments=["-p", "threshold:=1"]',
            )
        ],
    ),
    (
        "parameters",
        (
            "the parameter 'wheel_separation' is given an integer; 'wheel_controller' declares a"
            " double, and stops"
        ),
        [(_CONTROLLERS, "wheel_separation: 0.4", "wheel_separation: 1")],
    ),
    (
        "parameters",
        (
            "the parameter 'enable_odom_tf' is given a string; 'wheel_controller' declares a"
            " boolean, and stops"
        ),
        [(_CONTROLLERS, "    base_frame_id", "    enable_odom_tf: 'yes'\n    base_frame_id")],
    ),
    (
        "parameters",
        (
            "the parameter 'pose_covariance_diagonal' is given a list of integers;"
            " 'wheel_controller' declares a list of doubles, and stops"
        ),
        [
            (
                _CONTROLLERS,
                "    base_frame_id",
                "    pose_covariance_diagonal: [0, 0, 0, 0, 0, 1]\n    base_frame_id",
            )
        ],
    ),
    (
        "parameters",
        (
            "the parameter 'update_rate' is given a double; 'controller_manager' declares an"
            " integer, and stops"
        ),
        [(_CONTROLLERS, "update_rate: 100", "update_rate: 100.0"), *_WITH_MANAGER],
    ),
    (
        "parameters",
        "the parameter 'use_sim_time' is given a string; its node declares a boolean, and stops",
        [("config/detector.yaml", "threshold: 0.5", "threshold: 0.5\n    use_sim_time: 'true'")],
    ),
    (
        "controllers",
        (
            "wheel_controller claims the command interface left_wheel_joint/velocity twice"
            " (cart_bringup/config/controllers.yaml:11)"
        ),
        [(_CONTROLLERS, "[right_wheel_joint]", "[left_wheel_joint]")],
    ),
    (
        "controllers",
        "wheel_controller.left_wheel_names is given a string; the controller stops without a list: [left_wheel_joint]",
        [(_CONTROLLERS, "[left_wheel_joint]", "left_wheel_joint")],
    ),
    (
        "files",
        "there is no package 'cart_descriptions'; did you mean 'cart_description'?",
        [
            (
                _URDF,
                '<link name="base_link"/>',
                (
                    '<link name="base_link"><visual><geometry><mesh'
                    ' filename="package://cart_descriptions/base.stl"/></geometry></visual></link>'
                ),
            )
        ],
    ),
    (
        "parameters",
        "wheel_controller: ros__parameters is inside of other ros__parameters",
        [
            (
                _CONTROLLERS,
                "\nwheel_controller:\n  ros__parameters:\n    left",
                "    wheel_controller:\n      ros__parameters:\n        left",
            ),
            (_CONTROLLERS, "    right_wheel_names", "        right_wheel_names"),
        ],
    ),
    (
        "parameters",
        (
            "the node 'detector': there is no parameter 'treshold'; did you mean 'threshold'"
            " (cart_nodes/cart_nodes/detector.py:10)?"
        ),
        [("config/detector.yaml", "threshold", "treshold")],
    ),
    (
        "parameters",
        "get_parameter: there is no parameter 'level'",
        [(_DETECTOR, 'get_parameter("threshold")', 'get_parameter("level")')],
    ),
    (
        "parameters",
        (
            "plugins: there is no plugin section 'obstacle'; did you mean 'obstacle_layer'"
            " (cart_bringup/config/navigation.yaml:13)?"
        ),
        [("navigation.yaml", "[obstacle_layer]", "[obstacle]")],
    ),
    (
        "parameters",
        (
            "obstacle_layer.plugin: there is no plugin 'nav2_costmap_2d/ObstacleLayer'; did you mean"
            " 'nav2_costmap_2d::ObstacleLayer'?"
        ),
        [("navigation.yaml", "2d::Obs", "2d/Obs")],
    ),
    (
        "parameters",
        "'nav2_behaviors::Spin' is a plugin from Jazzy on, and 'nav2_navfn_planner/NavfnPlanner' (cart_bringup/config/navigation.yaml:4) until Iron: no release has both",
        [
            (
                "navigation.yaml",
                "    controller_plugins",
                """    planner:
      plugin: nav2_navfn_planner/NavfnPlanner
    spin:
      plugin: nav2_behaviors::Spin
    controller_plugins""",
            )
        ],
    ),
    (
        "arguments",
        (
            "the include of robot.launch.py: there is no launch argument 'use_sim_time'; did you mean 'sim_time'"
            " (cart_bringup/launch/robot.launch.py:1)?"
        ),
        [(_LAUNCH, '"sim_time"', '"use_sim_time"')],
    ),
    (
        "arguments",
        "Command of xacro: there is no xacro argument 'sim'",
        [
            (
                _ROBOT_LAUNCH,
                '" controllers_file:=", controllers]',
                '" sim:=1 controllers_file:=", controllers]',
            )
        ],
    ),
    (
        "arguments",
        (
            "Command of xacro: there is no xacro argument 'controller_file'; did you mean 'controllers_file'"
            " (cart_description/urdf/cart.urdf.xacro:3)?"
        ),
        [(_ROBOT_LAUNCH, "controllers_file:=", "controller_file:=")],
    ),
    (
        "programs",
        "the package 'cart_nodes' has no program 'detect'; did you mean 'detector'?",
        [(_LAUNCH, 'executable="detector"', 'executable="detect"')],
    ),
    (
        "programs",
        "the package 'controller_manager' has no program 'spawn'; did you mean 'spawner'?",
        [
            (
                _ROBOT_LAUNCH,
                'executable="spawner", arguments=["joint',
                'executable="spawn", arguments=["joint',
            )
        ],
    ),
    (
        "programs",
        "the entry point of 'alarm' names no function: there is no module cart_nodes.siren; did you mean 'alarm'?",
        [("cart_nodes/setup.py", "cart_nodes.alarm", "cart_nodes.siren")],
    ),
    (
        "programs",
        "a build installs 'alarm' in bin, not in lib/cart_nodes: see install_scripts of setup.cfg",
        [("setup.cfg", "[install]\ninstall_scripts=$base/lib/cart_nodes\n", "")],
    ),
    (
        "programs",
        (
            "node_names: there is no node 'controller'; did you mean 'controller_server'"
            " (cart_bringup/launch/cart.launch.py:32)?"
        ),
        [(_LAUNCH, '"controller_server"]}', '"controller"]}')],
    ),
    (
        "topics",
        (
            "the topic /obstacle is subscribed to with std_msgs.msg.Int8, but published with std_msgs.msg.Bool"
            " (cart_nodes/cart_nodes/detector.py:13)"
        ),
        [(_ALARM, "import Bool", "import Int8"), (_ALARM, "(Bool", "(Int8")],
    ),
    (
        "topics",
        (
            "the subscription of /obstacle asks for reliable, but its publisher is best_effort"
            " (cart_nodes/cart_nodes/detector.py:14)"
        ),
        [
            (_DETECTOR, '"obstacle", 10', '"obstacle", qos_profile_sensor_data'),
            (
                _DETECTOR,
                "import Node",
                "import Node\nfrom rclpy.qos import qos_profile_sensor_data",
            ),
        ],
    ),
    (
        "topics",
        (
            "the remapping of detector: there is no topic 'images'; did you mean 'image'"
            " (cart_nodes/cart_nodes/detector.py:14)?"
        ),
        [(_LAUNCH, '("image"', '("images"')],
    ),
    (
        "topics",
        (
            "no sensor publishes 'camera' in Gazebo; did you mean 'front_camera'"
            " (cart_description/urdf/cart.urdf.xacro:29)?"
        ),
        [("bridge.yaml", "front_camera", "camera")],
    ),
    (
        "topics",
        "the bridge sends the time of ROS to Gazebo: the clock is Gazebo's, so write GZ_TO_ROS",
        [
            (
                "bridge.yaml",
                "msgs.Clock\n  direction: GZ_TO_ROS",
                "msgs.Clock\n  direction: ROS_TO_GZ",
            )
        ],
    ),
    (
        "topics",
        "nothing publishes /camera/image_raw; did you mean /camera/image (cart_bringup/config/bridge.yaml:7)?",
        [(_LAUNCH, '"camera/image"', '"camera/image_raw"')],
    ),
    (
        "topics",
        "nothing publishes /obstacles; did you mean /obstacle (cart_nodes/cart_nodes/detector.py:13)?",
        [(_ALARM, 'Bool, "obstacle"', 'Bool, "obstacles"')],
    ),
    (
        "dependencies",
        "package.xml of 'cart_bringup' does not declare 'nav2_controller', which is used here",
        [("cart_bringup/package.xml", "  <exec_depend>nav2_controller</exec_depend>\n", "")],
    ),
    (
        "dependencies",
        "package.xml of 'cart_bringup' does not declare 'diff_drive_controller', which is used here",
        [("cart_bringup/package.xml", "  <exec_depend>diff_drive_controller</exec_depend>\n", "")],
    ),
    (
        "dependencies",
        "package.xml of 'cart_nodes' does not declare 'std_msgs', which is used here",
        [("cart_nodes/package.xml", "  <exec_depend>std_msgs</exec_depend>\n", "")],
    ),
]


@pytest.mark.parametrize(
    ("family", "message", "edits"), WRONG, ids=[f"{it[0]}: {it[1][:50]}" for it in WRONG]
)
def test_a_wrong_name_is_a_sure_problem_of_one_family(
    family: Family, message: str, edits: list[Edit]
) -> None:
    """What certainly fails at run time is named with both places, and counts in one family."""
    found = sure(agreement_of(edited(*edits)))
    assert message in [it.message for it in found], found
    assert {it.family for it in found} == {family}


CORRECT: list[tuple[str, list[Edit]]] = [
    (
        "a macro that is called under another condition",
        [
            *_IN_MACRO,
            (
                _URDF,
                "</ros2_control></xacro:macro>",
                '</ros2_control></xacro:macro><xacro:if value="${1 > 2}"><xacro:control/></xacro:if>',
            ),
            *_WITH_MANAGER,
        ],
    ),
    ("parameters of every node", [("config/detector.yaml", "detector:", "/**:")]),
    (
        "parameters by the full name of a node",
        [("config/detector.yaml", "detector:", "/detector:")],
    ),
    (
        "parameters of every node are not declared by each",
        [
            ("config/detector.yaml", "detector:", "/**:"),
            ("config/detector.yaml", "threshold", "level"),
        ],
    ),
    (
        "a node that declares what it is given",
        [
            (
                _DETECTOR,
                'super().__init__("detector")',
                'super().__init__("detector", automatically_declare_parameters_from_overrides=True)',
            ),
            ("config/detector.yaml", "threshold", "level"),
        ],
    ),
    (
        "a parameter of any type",
        [
            (
                _DETECTOR,
                'self.declare_parameter("threshold", 0.5)',
                'self.declare_parameter("threshold", 0.5, self._any)',
            ),
            ("config/detector.yaml", "threshold: 0.5", "threshold: 1"),
        ],
    ),
    (
        "parameters of the declared types",
        [
            (_LAUNCH, "import PathJoin", "import LaunchConfiguration, PathJoin"),
            (
                _LAUNCH,
                "import Node\n",
                "import Node\nfrom launch_ros.parameter_descriptions import ParameterValue\n",
            ),
            (
                _LAUNCH,
                "parameters=[detector]",
                """parameters=[
                {"threshold": ParameterValue(LaunchConfiguration("a", default="1"), value_type=float)},
                {"threshold": LaunchConfiguration("b", default="1.0")},
                {"threshold": 1.0, "use_sim_time": LaunchConfiguration("c", default="True")},
            ]""",
            ),
            (
                _CONTROLLERS,
                "    base_frame_id",
                """    wheel_separation: 1.0
    cmd_vel_timeout: 5e-1
    enable_odom_tf: yes
    update_rate: 50
    pose_covariance_diagonal: []
    base_frame_id""",
            ),
        ],
    ),
    (
        "a xacro argument that is used, and only passed",
        [
            (
                _ROBOT_LAUNCH,
                '" controllers_file:=", controllers]',
                '" rate:=1 controllers_file:=", controllers]',
            ),
            (
                "urdf/cart.urdf.xacro",
                "</robot>",
                '<xacro:property name="rate" value="$(arg rate)"/></robot>',
            ),
        ],
    ),
    (
        "a xacro argument that another file may declare",
        [
            (
                _ROBOT_LAUNCH,
                '" controllers_file:=", controllers]',
                '" rate:=1 controllers_file:=", controllers]',
            ),
            (
                "urdf/cart.urdf.xacro",
                "</robot>",
                '<xacro:include filename="$(find other_description)/other.xacro"/></robot>',
            ),
            (
                "cart_description/package.xml",
                "</package>",
                "<exec_depend>other_description</exec_depend></package>",
            ),
        ],
    ),
    (
        "a file that an own node may write",
        [
            (
                _LAUNCH,
                'executable="detector",',
                (
                    'executable="detector", arguments=[PathJoinSubstitution([FindPackageShare('
                    '"cart_bringup"), "config", "marks.yaml"])],'
                ),
            )
        ],
    ),
    (
        "parameters of a node that MoveItPy makes in the process",
        [
            (_DETECTOR, "import rclpy", "import rclpy\nfrom moveit.planning import MoveItPy"),
            (
                _DETECTOR,
                'self.declare_parameter("threshold", 0.5)',
                'self.declare_parameter("threshold", 0.5); MoveItPy(node_name="arm")',
            ),
            (
                "config/detector.yaml",
                "    threshold: 0.5",
                "    threshold: 0.5\n    planning_pipelines.pipeline_names: [ompl]",
            ),
        ],
    ),
    (
        "parameters of which some names are computed",
        [
            (
                _DETECTOR,
                'self.declare_parameter("threshold", 0.5)',
                "self.declare_parameter(self._name(), 0.5)",
            )
        ],
    ),
    (
        "block style",
        [
            (
                _CONTROLLERS,
                "left_wheel_names: [left_wheel_joint]",
                "left_wheel_names:\n      - left_wheel_joint",
            )
        ],
    ),
    (
        "spawners of one node",
        [
            (
                _ROBOT_LAUNCH,
                '["wheel_controller", "--param-file"',
                '["wheel_controller", "joint_state_broadcaster", "--param-file"',
            )
        ],
    ),
    (
        "frames of localization",
        [
            (
                _ROBOT_LAUNCH,
                '"--frame-id", "base_link", "--child-frame-id", "laser"',
                '"--frame-id", "map", "--child-frame-id", "odom"',
            )
        ],
    ),
    (
        "a frame of a static transform",
        [("config/detector.yaml", "camera_frame: camera_link", "camera_frame: laser")],
    ),
    (
        "a frame that a node of another package may publish",
        [
            (_LAUNCH, 'package="nav2_map_server"', 'package="apriltag_ros"'),
            ("cart_bringup/package.xml", "nav2_map_server", "apriltag_ros"),
            ("config/detector.yaml", "camera_frame: camera_link", "camera_frame: tag_7"),
        ],
    ),
    (
        "a frame that a node of the workspace publishes",
        [
            (_DETECTOR, "import rclpy", "import rclpy\nfrom tf2_ros import TransformBroadcaster"),
            (
                "cart_nodes/package.xml",
                "<exec_depend>rclpy",
                "<exec_depend>tf2_ros</exec_depend><exec_depend>rclpy",
            ),
            ("config/detector.yaml", "camera_frame: camera_link", "camera_frame: target"),
        ],
    ),
    (
        "a reference to a joint",
        [(_URDF, '<gazebo reference="camera_link">', '<gazebo reference="camera_mount">')],
    ),
    (
        "a controller that is not known",
        [
            (
                _CONTROLLERS,
                "diff_drive_controller/DiffDriveController",
                "cart_control/CartController",
            ),
            (_CONTROLLERS, "left_wheel_names", "wheels"),
            (_CONTROLLERS, "right_wheel_names", "others"),
        ],
    ),
    (
        "a robot whose joints depend on an argument of xacro",
        [
            (
                _URDF,
                "<ros2_control name",
                '<xacro:if value="0"><ros2_control name="Other"/></xacro:if><ros2_control name',
            ),
            (_URDF, '<joint name="right_wheel_joint">', '<joint name="camera_mount">'),
        ],
    ),
    (
        "a robot that its publisher reads from a file",
        [
            (_ROBOT_LAUNCH, '"robot_description"', '"other"'),
            (
                _ROBOT_LAUNCH,
                'executable="robot_state_publisher"',
                'executable="robot_state_publisher", arguments=["a.urdf"]',
            ),
        ],
    ),
    (
        "an argument that nothing declares and nothing is like",
        [(_LAUNCH, '"sim_time": "true"', '"sim_time": "true", "colour": "red"')],
    ),
    (
        "a file that a program writes",
        [(_LAUNCH, '"worlds", "hall.yaml"', '"recorded", "mine.bag"')],
    ),
    (
        "programs of packages that are not submitted",
        [(_LAUNCH, 'executable="map_server"', 'executable="map_saver"')],
    ),
    ("a topic that nobody publishes", [(_ALARM, 'Bool, "obstacle"', 'Bool, "emergency"')]),
    (
        "reliable to best effort",
        [
            (_ALARM, "on_obstacle, 10", "on_obstacle, qos_profile_sensor_data"),
            (_ALARM, "import Node", "import Node\nfrom rclpy.qos import qos_profile_sensor_data"),
        ],
    ),
    (
        "a remapping of a node whose topics are computed",
        [
            (_DETECTOR, 'Image, "image"', "Image, self._topic()"),
            (_LAUNCH, '("image"', '("images"'),
        ],
    ),
    (
        "a dependency for the build too",
        [
            (
                "cart_nodes/package.xml",
                "<exec_depend>std_msgs</exec_depend>",
                "<depend>std_msgs</depend>",
            )
        ],
    ),
    (
        "a comment in xacro",
        [
            (
                _URDF,
                '<link name="base_link"/>',
                '<link name="base_link"/><!-- $(find cart_description)/urdf/old.xacro -->',
            )
        ],
    ),
    (
        "a comment in YAML",
        [
            (
                "navigation.yaml",
                "controller_plugins",
                "# $(find-pkg-share cart_bringup)/worlds/old.yaml\n    controller_plugins",
            )
        ],
    ),
    (
        "paths in the flow style of YAML, and in a substitution",
        [
            (
                "navigation.yaml",
                "controller_plugins",
                """maps: [{map: $(find-pkg-share cart_bringup)/worlds/hall.yaml}, package://cart_bringup/worlds/hall.yaml]
    text: $(file-content $(find-pkg-share cart_bringup)/worlds/hall.yaml)
    controller_plugins""",
            )
        ],
    ),
    (
        "a default that the include replaces",
        [
            (_LAUNCH, '{"sim_time": "true"}', '{"sim_time": "true", "gui": "false"}'),
            (
                _ROBOT_LAUNCH,
                'DeclareLaunchArgument("sim_time"',
                """DeclareLaunchArgument("gui", default_value="true"),
        Node(package="ros_gz_bridge", executable="parameter_bridge", condition=IfCondition(LaunchConfiguration("gui")),
             arguments=["-d", PathJoinSubstitution([share, "config", "gui.yaml"])]),
        DeclareLaunchArgument("sim_time\"""",
            ),
            (
                _ROBOT_LAUNCH,
                "launch_ros.actions",
                "launch.conditions import IfCondition\nfrom launch_ros.actions",
            ),
        ],
    ),
    (
        "a metapackage",
        [
            (
                "cart_bringup/package.xml",
                "  <exec_depend>nav2_map_server</exec_depend>\n",
                "  <exec_depend>navigation2</exec_depend>\n",
            )
        ],
    ),
    (
        "what a declared package needs",
        [
            (
                "cart_bringup/package.xml",
                "  <exec_depend>robot_state_publisher</exec_depend>\n",
                "",
            ),
            (
                "cart_description/package.xml",
                "<exec_depend>xacro",
                "<exec_depend>robot_state_publisher</exec_depend><exec_depend>xacro",
            ),
        ],
    ),
    (
        "what a camera publishes beside its pictures",
        [
            (
                "bridge.yaml",
                "- ros_topic_name: camera/image",
                """- topic_name: /camera_info
  ros_type_name: sensor_msgs/msg/CameraInfo
  gz_type_name: gz.msgs.CameraInfo
- ros_topic_name: camera/image""",
            )
        ],
    ),
    (
        "a topic of Gazebo's own name",
        [
            (
                "bridge.yaml",
                "front_camera",
                "/world/hall/model/cart/link/camera_link/sensor/front/image",
            )
        ],
    ),
    (
        "rows in arguments",
        [
            (
                "bridge.yaml",
                """- ros_topic_name: camera/image
  gz_topic_name: front_camera
  ros_type_name: sensor_msgs/msg/Image
  gz_type_name: gz.msgs.Image
  direction: GZ_TO_ROS
""",
                "",
            ),
            (
                _ROBOT_LAUNCH,
                'executable="parameter_bridge"',
                'executable="parameter_bridge", arguments=["/front_camera@sensor_msgs/msg/Image[gz.msgs.Image"]',
            ),
            (_LAUNCH, '"camera/image"', '"front_camera"'),
        ],
    ),
    (
        "pictures of a model that is not submitted",
        [("bridge.yaml", "front_camera", "camera"), (_URDF, "<topic>front_camera</topic>", "")],
    ),
    (
        "a topic that a node of another package may publish",
        [
            (_LAUNCH, '"camera/image"', '"camera/image_raw"'),
            (_LAUNCH, '"nav2_map_server"', '"usb_cam"'),
            ("cart_bringup/package.xml", "nav2_map_server", "usb_cam"),
        ],
    ),
    (
        "a topic that a parameter file names",
        [
            (_LAUNCH, '"camera/image"', '"camera/image_raw"'),
            (
                "navigation.yaml",
                "robot_base_frame",
                "image_topic: camera/image_raw\n      robot_base_frame",
            ),
        ],
    ),
    (
        "a topic of a driver that is started by hand",
        [
            (_ALARM, 'Bool, "obstacle"', 'Bool, "joy"'),
            (_DETECTOR, 'Bool, "obstacle"', 'Bool, "joys"'),
        ],
    ),
    (
        "topics below the names of nodes",
        [
            (_DETECTOR, 'Bool, "obstacle"', 'Bool, "~/state"'),
            (_ALARM, 'Bool, "obstacle"', 'Image, "~/state"'),
            (_ALARM, "import rclpy\n", "import rclpy\nfrom sensor_msgs.msg import Image\n"),
        ],
    ),
    (
        "parameters of an older release of Nav2",
        [
            (
                "navigation.yaml",
                "    controller_plugins",
                """    planner:
      plugin: nav2_navfn_planner/NavfnPlanner
    controller_plugins""",
            )
        ],
    ),
    (
        "a remapping of what rclpy opens",
        [(_LAUNCH, '("image", "camera/image")', '("image", "camera/image"), ("/tf", "tf")')],
    ),
    (
        "an argument of an included file that is not submitted",
        [
            (_LAUNCH, '{"sim_time": "true"}', '{"sim_time": "true", "slam_params_file": "x"}'),
            (
                "cart_bringup/package.xml",
                "<exec_depend>xacro",
                "<exec_depend>slam_toolbox</exec_depend><exec_depend>xacro",
            ),
            (
                _ROBOT_LAUNCH,
                'DeclareLaunchArgument("sim_time"',
                """DeclareLaunchArgument("params_file", default_value=""),
        IncludeLaunchDescription(PathJoinSubstitution(
            [FindPackageShare("slam_toolbox"), "launch", "online_async_launch.py"])),
        DeclareLaunchArgument("sim_time\"""",
            ),
            (
                _ROBOT_LAUNCH,
                "import DeclareLaunchArgument",
                "import DeclareLaunchArgument, IncludeLaunchDescription",
            ),
        ],
    ),
    (
        "an argument that is used without being declared",
        [
            (_LAUNCH, '{"sim_time": "true"}', '{"sim_time": "true", "sim_time_2": "x"}'),
            (
                _ROBOT_LAUNCH,
                'executable="parameter_bridge",',
                'executable="parameter_bridge", name=LaunchConfiguration("sim_time_2"),',
            ),
        ],
    ),
    (
        "a controller whose type is an argument",
        [
            (
                _ROBOT_LAUNCH,
                'arguments=["joint_state_broadcaster"]',
                'arguments=["states", "-t", "joint_state_broadcaster/JointStateBroadcaster"]',
            )
        ],
    ),
    (
        "a controller with a file of its own",
        [
            (
                _CONTROLLERS,
                "DiffDriveController\n",
                "DiffDriveController\n      params_file: /opt/wheels.yaml\n",
            ),
            (_CONTROLLERS, "\nwheel_controller:", "\nwheels:"),
        ],
    ),
    (
        "a key that is written twice",
        [
            (_CONTROLLERS, "controller_manager:\n", "/**:\n  controller_manager:\n"),
            (
                _CONTROLLERS,
                "  ros__parameters:\n    update_rate: 100\n    joint_state_broadcaster:\n      type:",
                "    ros__parameters:\n      update_rate: 100\n      joint_state_broadcaster:\n        type:",
            ),
            (
                _CONTROLLERS,
                "    wheel_controller:\n      type: ",
                "      wheel_controller:\n        type: ",
            ),
            (
                _CONTROLLERS,
                "\nwheel_controller:\n  ros__parameters:\n    left",
                "\n/**:\n  wheel_controller:\n   ros__parameters:\n    left",
            ),
            *_WITH_MANAGER,
        ],
    ),
    (
        "the type of a controller in a key with dots",
        [(_CONTROLLERS, "    wheel_controller:\n      type:", "    wheel_controller.type:")],
    ),
    (
        "a controller with parameters of every node",
        [(_CONTROLLERS, "\nwheel_controller:", "\n/**:")],
    ),
    (
        "a controller without interfaces",
        [
            (
                _CONTROLLERS,
                "diff_drive_controller/DiffDriveController",
                "joint_trajectory_controller/JointTrajectoryController",
            ),
            (_CONTROLLERS, "left_wheel_names", "joints"),
            (_CONTROLLERS, "    right_wheel_names: [right_wheel_joint]\n", ""),
            ("cart_bringup/package.xml", "diff_drive_controller", "joint_trajectory_controller"),
        ],
    ),
    (
        "a container that gives parameters to its components",
        [
            (
                _LAUNCH,
                'package="cart_nodes",\n            executable="detector",\n            name="detector"',
                'package="rclcpp_components",\n            executable="component_container",\n            name="container"',
            ),
            (
                "cart_bringup/package.xml",
                "cart_nodes",
                "rclcpp_components</exec_depend><exec_depend>cart_nodes",
            ),
        ],
    ),
    (
        "parameters that a node of another package may share",
        [
            (
                _LAUNCH,
                'package="cart_nodes",\n            executable="detector",\n            name="detector"',
                'package="other_nodes",\n            executable="driver",\n            name="driver"',
            ),
            (
                "cart_bringup/package.xml",
                "cart_nodes",
                "other_nodes</exec_depend><exec_depend>cart_nodes",
            ),
        ],
    ),
    (
        "a frame that a plugin publishes",
        [
            (
                _URDF,
                "<parameters>$(arg controllers_file)</parameters>",
                "<frame_id>cart/odom</frame_id>",
            )
        ],
    ),
    (
        "names that an own node calls joints",
        [
            ("config/detector.yaml", "threshold: 0.5", "threshold: 0.5\n    joints: [none, all]"),
            (
                _DETECTOR,
                'self.declare_parameter("threshold", 0.5)',
                'self.declare_parameter("threshold", 0.5)\n        self.declare_parameter("joints", [""])',
            ),
        ],
    ),
    (
        "a file that is also passed on",
        [
            ("config/detector.yaml", "detector:", "driver:"),
            (_LAUNCH, '{"sim_time": "true"}', '{"sim_time": "true", "driver_params": detector}'),
        ],
    ),
    (
        "a plugin that is not known",
        [("navigation.yaml", "nav2_costmap_2d::ObstacleLayer", "cart_layers/Layer")],
    ),
    (
        "overrides of the quality of service",
        [
            (
                "config/detector.yaml",
                "threshold: 0.5",
                "qos_overrides: {/obstacle: {publisher: {depth: 3}}}",
            )
        ],
    ),
]


@pytest.mark.parametrize("edits", [it[1] for it in CORRECT], ids=[it[0] for it in CORRECT])
def test_what_ros_accepts_is_no_sure_problem(edits: list[Edit]) -> None:
    """Other ways to write the same, and names that something which is not submitted may define, are not wrong."""
    assert sure(agreement_of(edited(*edits))) == []


def test_a_plugin_may_be_named_unlike_its_package() -> None:
    """A controller that a package describes for pluginlib exists, however near the name of another one is."""
    texts = edited((_CONTROLLERS, "joint_state_broadcaster/Joint", "joint_state_broadcaste/Joint"))
    name = "joint_state_broadcaste/JointStateBroadcaster"
    described = (
        f'<library path="own"><class name="{name}" type="own::Own" base_class_type="C"/></library>'
    )
    assert [it.family for it in sure(agreement_of(texts))] == ["controllers"]
    assert sure(agreement_of({**texts, "cart_nodes/own.xml": described})) == []


def test_a_module_beside_is_no_package() -> None:
    """A module of the package itself may be named like messages, and is imported from its package."""
    texts = edited((_ALARM, "import rclpy\n", "import rclpy\nimport own_msgs\n"))
    assert [it.family for it in sure(agreement_of(texts))] == ["dependencies"]
    beside = {**texts, "cart_nodes/cart_nodes/own_msgs.py": ""}
    assert [it.family for it in sure(agreement_of(beside))] == ["code"]
    owned = edited((_ALARM, "import rclpy\n", "import rclpy\nfrom cart_nodes import own_msgs\n"))
    assert sure(agreement_of({**owned, "cart_nodes/cart_nodes/own_msgs.py": ""})) == []


def test_a_robot_that_is_not_used_is_no_sure_problem() -> None:
    """What an old file beside the robot names is looked for by nobody: it is a warning."""
    old = '<robot name="x"><link name="{}"><visual><geometry><mesh filename="package://cart_description/urdf/wheel.stl"/>'
    texts = {
        **edited(),
        "cart_description/urdf/old.xacro": f"{old}</geometry></visual></link></robot>",
    }
    found = agreement_of(texts)
    assert [(it.family, it.is_certain) for it in found.mismatches] == [("files", False)]


def test_a_launch_file_that_is_not_installed_finds_what_is_beside_it() -> None:
    """Started by its path, it has the folder of the sources."""
    include = """from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import ThisLaunchFileDir, PathJoinSubstitution


def generate_launch_description():
    return LaunchDescription([IncludeLaunchDescription(PathJoinSubstitution([ThisLaunchFileDir(), "b.launch.py"]))])
"""
    texts = {
        **edited(),
        "cart_bringup/examples/a.launch.py": include,
        "cart_bringup/examples/b.launch.py": include,
    }
    assert sure(agreement_of(texts)) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "found"),
    [
        ("online_async_launch.py", []),
        (
            "onlin_async_launch.py",
            [
                (
                    "slam_toolbox is not known to have a launch file 'onlin_async_launch.py'; did you mean"
                    " 'online_async_launch.py'?"
                )
            ],
        ),
        ("another_launch.py", []),
    ],
)
def test_a_misspelt_launch_file_of_a_well_known_package(file: str, found: list[str]) -> None:
    include = f"""from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("slam_toolbox")
    return LaunchDescription([IncludeLaunchDescription(PathJoinSubstitution([share, "launch", "{file}"]))])
"""
    mismatches = agreement_of({**edited(), "cart_bringup/launch/map.launch.py": include}).mismatches
    assert [it.message for it in mismatches if it.family == "files"] == found


def test_what_is_installed_for_tests_leaves_files_undecided() -> None:
    """BUILD_TESTING is on by default, but not where packages are built for others."""
    texts = edited(
        (
            "cart_bringup/CMakeLists.txt",
            "install(DIRECTORY launch config worlds",
            "if(BUILD_TESTING)\n  install(DIRECTORY worlds DESTINATION share/x)\nendif()\ninstall(DIRECTORY launch config",
        )
    )
    assert "files" in agreement_of(texts).undecided
    assert sure(agreement_of(texts)) == []


def test_a_family_is_undecided_where_what_defines_its_names_is_not_evaluated() -> None:
    """A CMakeLists.txt that calls an own function may install the file."""
    texts = edited(("cart_bringup/CMakeLists.txt", "install(", "install_all("))
    found = agreement_of(texts)
    assert "files" in found.undecided
    assert [it for it in sure(found) if it.family == "files"] == []


def test_a_urdf_alone_has_problems_but_no_families() -> None:
    """Without a package, no criterion about names can be drafted; what is wrong in the robot is still known."""
    robot = "<robot name='cart'><link name='base'/><gazebo reference='bas'/></robot>"
    found = agreement_of({"cart.urdf": robot})
    assert (found.families, [it.family for it in found.mismatches]) == (frozenset(), ["frames"])


def test_programs_are_undecided_where_the_file_that_installs_them_is_too_large() -> None:
    """It may install each of them."""
    texts = {**edited(), "cart_bringup/CMakeLists.txt": "# more\n" * 20_000}
    texts[_AT_LAUNCH] = texts[_AT_LAUNCH].replace(
        "return LaunchDescription([", f"return LaunchDescription([{_OWN_PROGRAM}"
    )
    found = agreement_of(texts)
    assert "programs" in found.undecided
    assert [it for it in sure(found) if it.family == "programs"] == []


_NO_WORLDS = "a build installs no share/cart_bringup/worlds: it installs"


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        (" worlds", "", [("no file of the folder worlds", True)]),
        (
            "share/${PROJECT_NAME})",
            "share/worlds)",
            [("worlds/hall.pgm as share/worlds/worlds/hall.pgm", False)],
        ),
        ("share/${PROJECT_NAME})", "share/${PROJECT_NAME} PATTERN hall.* EXCLUDE)", []),
    ],
)
def test_a_folder_that_is_not_installed_is_called_a_folder(
    old: str, new: str, found: list[tuple[str, bool]]
) -> None:
    """It says where its files are installed; CMake also makes folders that stay empty."""
    tree = "tree: $(find-pkg-share cart_bringup)/worlds\n    controller_plugins"
    texts = edited(
        ("cart_bringup/CMakeLists.txt", old, new), ("navigation.yaml", "controller_plugins", tree)
    )
    known = [it for it in agreement_of(texts).mismatches if it.message.startswith(_NO_WORLDS)]
    assert [(it.message.removeprefix(f"{_NO_WORLDS} "), it.is_certain) for it in known] == found
