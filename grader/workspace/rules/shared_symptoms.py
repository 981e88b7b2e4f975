"""What the terminal prints where one of several rules is broken."""

from grader.workspace.rules.rule_table import Symptom

TREES_NOT_CONNECTED = Symptom(
    "trees-not-connected",
    pattern=(
        r"Could not find a connection between '(?P<one>[\w./-]{1,200}+)' and "
        r"'(?P<other>[\w./-]{1,200}+)' because they are not part of the same tree"
    ),
    source="ros2/geometry2 1b005c65, tf2/src/buffer_core.cpp:988",
    sentence="Nothing publishes the transforms between two frames.",
    example=(
        "Could not find a connection between 'map' and 'base_link' because they are not part of "
        "the same tree.Tf has two or more unconnected trees."
    ),
    within=("other",),
)
CLASS_DOES_NOT_EXIST = Symptom(
    "class-does-not-exist",
    pattern=(
        r"plugin descriptions the class (?P<plugin>[\w:/.-]{1,200}+) with base class type "
        r"[\w:/.-]{1,200}+ does not exist\."
    ),
    source="ros/pluginlib 5fb0f10, pluginlib/include/pluginlib/class_loader_imp.hpp:487",
    sentence="No installed package has the plugin.",
    example=(
        "According to the loaded plugin descriptions the class nav2_navfn_planner/Navfn with "
        "base class type nav2_core::GlobalPlanner does not exist. Declared types are a/B"
    ),
    within=("plugin",),
)
PARAMETERS_NOT_PARSED = Symptom(
    "parameters-not-parsed",
    pattern=(
        r"Couldn't parse params file: '--params-file (?:\S{0,400}/)?(?P<file>[^\s/']{1,200}+)'\. "
        r"Error: (?P<reason>.{1,200})"
    ),
    source="ros2/rcl c19dab5, rcl/src/rcl/arguments.c:416",
    sentence="rcl refuses the file of parameters.",
    example=(
        "Couldn't parse params file: '--params-file /home/ann/ws/install/cell/share/cell/config/"
        "drive.yaml'. Error: Cannot have a value before ros__parameters at line 2, at "
        "./src/parse.c:807"
    ),
    within=("file",),
)
INCOMPATIBLE_QUALITY = Symptom(
    "incompatible-quality",
    pattern=(
        r"New (?:subscription|publisher) discovered on topic '/?(?P<topic>[\w./~-]{1,200}+)', "
        r"(?:requesting|offering) incompatible QoS\."
    ),
    source=(
        "ros2/rclcpp a0a2a067d, rclcpp/src/rclcpp/publisher_base.cpp:361; ros2/rclpy ba72a01, "
        "rclpy/rclpy/event_handler.py:346"
    ),
    sentence="A publisher offers less than a subscription asks for, and nothing arrives.",
    example=(
        "New subscription discovered on topic '/scan', requesting incompatible QoS. No messages "
        "will be sent to it. Last incompatible policy: RELIABILITY"
    ),
    within=("topic",),
)
SERVICE_NOT_CONTACTED = Symptom(
    "service-not-contacted",
    pattern=(
        r"(?:(?:Could not contact|waiting for) service |Waiting for ')(?P<manager>/[\w/]{1,200}+)"
    ),
    source=(
        "ros-controls/ros2_control 53b9999d1, controller_manager/controller_manager/"
        "controller_manager_services.py:147"
    ),
    sentence=(
        "No controller manager answers the spawner: look at its namespace, and whether it is "
        "started."
    ),
    example="Could not contact service /controller_manager/list_controllers",
    follows=True,
    place="manager",
)
INTERFACE_MISSING = Symptom(
    "interface-missing",
    pattern=(
        r"(?:Command|State) interface with (?:key )?'(?P<joint>[\w.-]{1,200}+)/(?P<interface>[\w/"
        r".-]{1,200}+)' does not exist"
    ),
    source="ros-controls/ros2_control 53b9999d1, hardware_interface/src/resource_manager.cpp:1948",
    sentence="A controller claims an interface that <ros2_control> does not have.",
    example="Command interface with 'left_wheel_joint/velocity' does not exist",
    within=("joint",),
)
CONTROLLER_NOT_LOADED = Symptom(
    "controller-not-loaded",
    pattern=r"Failed loading controller (?P<controller>[\w./-]{1,200}+)",
    source=(
        "ros-controls/ros2_control 53b9999d1, controller_manager/controller_manager/spawner.py:497"
    ),
    sentence="A controller could not be loaded; the controller manager has said why.",
    example="Failed loading controller arm_controler",
    within=("controller",),
    follows=True,
)
TYPE_EXPECTED = Symptom(
    "type-expected",
    pattern=(
        r"(?:\A|what\(\): |message: )expected \[(?P<expected>\w{1,30}+)\] got "
        r"\[(?P<given>\w{1,30}+)\]"
    ),
    source="ros2/rclcpp a0a2a067d, rclcpp/include/rclcpp/parameter_value.hpp:67",
    sentence="A parameter has another type than its node declares; the message does not name it.",
    example=(
        "Exception thrown during controller's init with message: expected [double] got [integer]"
    ),
    within=(
        "expected",
        "given",
    ),
)
WORLD_AWAITED = Symptom(
    "world-awaited",
    pattern=r"Waiting for service \[/world/\w{1,100}+/create\] to become available",
    source="gazebosim/ros_gz a4d00a9, ros_gz_sim/src/create.cpp:273",
    sentence="Gazebo does not run, or runs another world than the one in which a robot is created.",
    example="Waiting for service [/world/hall/create] to become available ...",
)
INTERFACES_NOT_ACCEPTED = Symptom(
    "interfaces-not-accepted",
    pattern=(
        r"Not acceptable (?:command|state) interfaces combination.{0,1500}?Not "
        r"(?:existing|available): \[ (?P<joint>[^\s\]]{1,200}?)/[\w./-]{1,100}"
    ),
    source="ros-controls/ros2_control 53b9999d1, hardware_interface/src/resource_manager.cpp:2045",
    sentence="A controller claims interfaces that <ros2_control> does not have.",
    example=(
        "Not acceptable command interfaces combination: Start interfaces: [ elbow/velocity ] "
        "Stop interfaces: [ ] Not existing: [ elbow/velocity ]"
    ),
    within=("joint",),
)
INTERFACE_NOT_AVAILABLE = Symptom(
    "interface-not-available",
    pattern=(
        r"since the (?:command|state) interface '(?P<joint>[^'/]{1,200}+)/[^']{1,200}+' is not "
        r"available"
    ),
    source=(
        "ros-controls/ros2_control 53b9999d1, controller_manager/src/controller_manager.cpp:4381"
    ),
    sentence="A controller claims an interface that no active hardware has.",
    example=(
        "Unable to activate controller 'arm' since the command interface 'elbow/velocity' is not "
        "available."
    ),
    within=("joint",),
)
EXTRAPOLATION = Symptom(
    "extrapolation",
    pattern=(
        r"(?i)\bextrapolation (?:at time .{1,60}? )?into the (?:past|future)|timestamp on the "
        r"message is earlier than all the data|Transform data too old when converting"
    ),
    source="ros2/geometry2 1b005c65, tf2/src/cache.cpp:94",
    sentence=(
        "Two clocks are used: look at use_sim_time of all nodes of the launch, at /clock, and at "
        "the clocks of several machines; or a transform comes late."
    ),
    example=(
        "Lookup would require extrapolation into the future. Requested time 1700000000.5 but the "
        "latest data is at time 12.3, when looking up transform from frame [lidar] to frame "
        "[odom]"
    ),
)
TWO_PUBLISHERS = Symptom(
    "two-publishers",
    pattern=r"TF_(?:REPEATED|OLD)_DATA ignoring data .{0,100}?frame (?P<frame>[\w/.-]{1,200}+)",
    source="ros2/geometry2 1b005c65, tf2/src/buffer_core.cpp:297",
    sentence="Two programs publish one transform, or the clock went back.",
    example=(
        "TF_OLD_DATA ignoring data from the past for frame odom at time 12.3 according to "
        "authority Authority undetectable"
    ),
    within=("frame",),
)
NO_TRANSFORM = Symptom(
    "no-transform",
    pattern=r"No transform from \[(?P<frame>[\w/.-]{1,200}+)\] to \[",
    source=(
        "ros2/rviz f7112b1, rviz_default_plugins/src/rviz_default_plugins/robot/"
        "tf_link_updater.cpp:74"
    ),
    sentence=(
        "Nothing publishes the transform of a link: of a moving joint, look at what publishes "
        "joint_states."
    ),
    example="No transform from [left_wheel] to [base_link]",
)
JOINTS_UNKNOWN = Symptom(
    "joints-unknown",
    pattern=r"The complete state of the robot is not yet known\. Missing (?P<joint>\S{1,200})",
    source=(
        "moveit/moveit2 8fcb5d232, moveit_ros/planning/planning_scene_monitor/src/"
        "planning_scene_monitor.cpp:1495"
    ),
    sentence="Nothing publishes the positions of some joints on joint_states.",
    example="The complete state of the robot is not yet known. Missing elbow",
)
ACTION_NOT_CONNECTED = Symptom(
    "action-not-connected",
    pattern=r"Action client not connected to action server: (?P<controller>[\w-]{1,200}+)/",
    source=(
        "moveit/moveit2 8fcb5d232, moveit_plugins/moveit_simple_controller_manager/src/"
        "follow_joint_trajectory_controller_handle.cpp:53"
    ),
    sentence="No controller serves the action that MoveIt calls.",
    example="Action client not connected to action server: arm_controller/follow_joint_trajectory",
    within=("controller",),
)
JOINTS_WITHOUT_CONTROLLER = Symptom(
    "joints-without-controller",
    pattern=(
        r"Unable to identify any set of controllers that can actuate the specified joints: \[ "
        r"?(?P<joint>[\w-]{1,200}+)"
    ),
    source=(
        "moveit/moveit2 8fcb5d232, moveit_ros/planning/trajectory_execution_manager/src/"
        "trajectory_execution_manager.cpp:1161"
    ),
    sentence="MoveIt knows no controller of these joints: look at moveit_controllers.yaml.",
    example=(
        "Unable to identify any set of controllers that can actuate the specified joints: [ elbow ]"
    ),
)
COMPONENT_CLASS = Symptom(
    "component-class",
    pattern=r"Failed to find class with the requested plugin name '(?P<component>[\w:]{1,200}+)'",
    source="ros2/rclcpp a0a2a067d, rclcpp_components/src/component_manager.cpp:314",
    sentence="The library of a package has no such component.",
    example=(
        "Failed to find class with the requested plugin name 'cell::Mover' in the loaded library"
    ),
    within=("component",),
)
COMPONENT_RESOURCE = Symptom(
    "component-resource",
    pattern=r"Could not find requested resource in ament index",
    source="ros2/rclcpp a0a2a067d, rclcpp_components/src/component_manager.cpp:88",
    sentence="A package registers no components.",
    example="Could not find requested resource in ament index",
)
