"""The rules of a workspace: one row each, by which reports, settings and `grader explain` name it.

A row says what is right, and its name is the subject of the rule. The function that finds what is
not right names the row.
"""

from collections.abc import Mapping
from functools import partial
from typing import Literal, NamedTuple, get_args

from grader.base.problems import Kind, Problem, kinds_in
from grader.base.source import Location

Family = Literal[
    "files",
    "frames",
    "controllers",
    "parameters",
    "arguments",
    "programs",
    "topics",
    "dependencies",
    "services",
    "interfaces",
    "code",
    "values",
    "transforms",
]
FAMILIES: tuple[Family, ...] = get_args(Family)
# The families that are added here have only warnings, and no rubric can ask for them.
AnyFamily = (
    Family
    | Literal["wiring", "machine", "moveit", "words", "messages", "effects", "keys", "builds"]
)
DefinedKind = Literal[
    "frame",
    "link",
    "joint",
    "group",
    "controller",
    "plugin section",
    "parameter",
    "launch argument",
    "xacro argument",
    "node",
    "topic",
]

_error = partial(Kind, severity="error", effect="other")
_warning = partial(Kind, severity="warning", effect="other")

_NO_FILE = _error("REF001", "File that a build does not install")
_NO_FRAME = _error("REF002", "Frame, link or joint that does not exist")
_NO_CONTROLLER = _error("REF003", "Controller or interface that does not exist")
_NO_PARAMETER = _error("REF004", "Parameters that no node gets, or that a node does not accept")
_NO_ARGUMENT = _error("REF005", "Argument that nothing declares")
_NO_PROGRAM = _error("REF006", "Program, entry point or node that does not exist")
_NO_TOPIC = _error("REF007", "Topic with another name, type or quality of service")
_NO_DEPENDENCY = _warning("REF008", "Package that package.xml does not declare")
_SIMILAR = _warning("REF009", "Name, type or file that may be wrong")
_UNUSED = _warning("REF010", "File that no other file names")
_OTHER_RELEASE = _warning("REF011", "Name of another release of ROS 2")
_UNCOMPARED = Kind("REF012", "Names that are not compared", severity="note", effect="other")
_NO_SERVICE = _error("REF013", "Service or action with another name or type")
_NO_INTERFACE = _error("REF014", "Message, service, action or field that does not exist")
_NO_RUN = _error("REF015", "Node that certainly stops, or does nothing")
_MAY_WAIT = _warning("REF016", "Node that may stop or wait")
_WRONG_VALUE = _error("REF017", "Number that contradicts the robot")
_OTHER_VALUE = _warning("REF018", "Number that is not that of the robot")
_WRONG_TRANSFORM = _error("REF019", "Frames that are no tree")
_OTHER_TRANSFORM = _warning("REF020", "Transform that two programs publish")
_NO_COMPANION = _warning("REF021", "Node that does not fit the others")
_ONE_MACHINE = _warning("REF022", "What only one machine has")
_OTHER_MOVEIT = _warning("REF023", "Description for MoveIt that does not fit the robot")
_NO_WORD = _warning("REF024", "Word that a program ignores")
_NO_MESSAGE = _warning("REF025", "Messages that their reader cannot use")
_MOVES_NOTHING = _warning("REF026", "Controller that moves nothing")
_NO_SUCH_PARAMETER = _warning("REF027", "Parameter that a well-known node does not have")
_NO_EFFECT = _warning("REF028", "Parameter that has no effect")
_UNCONNECTED = _warning("REF029", "Transform between frames that nothing connects")
_BUILT_LATER = _error("REF030", "Package that a build does not find")
_NO_PACKAGE = _error("REF031", "Package that does not exist")
_NOWHERE = _warning("REF032", "Package that neither the workspace nor a release has")
_NO_KEY = _warning("REF033", "Name that rosdep does not know")
_UNKNOWN_KEY = Kind("REF034", "Name that may be no key of rosdep", severity="note", effect="other")
_NOT_COMPILED = _error("REF035", "C++ file that does not compile")
_BROUGHT = Kind("REF036", "Library that other packages install", severity="note", effect="other")
_NOT_BUILT = Kind("REF037", "Package that colcon does not find", severity="note", effect="other")
_OTHER_TIME = Kind(
    "REF038", "Node beside a simulation without its time", severity="note", effect="other"
)
_FORM = Kind("REF039", "Form of a package of which tools warn or that they ignore", "note", "other")
_NO_BUILD = _warning("REF040", "Package that colcon does not build")
_UNREAD = Kind(
    "REF041", "Parameter or argument that nothing reads", severity="note", effect="other"
)
_LENT = _warning("REF042", "Package that package.xml declares only indirectly")
NAME_CATALOGUE = kinds_in(globals().values())


class Rule(NamedTuple):
    """What agrees in a correct workspace.

    A finding is of `kind` if something certainly fails at run time, and otherwise of `doubtful`,
    which fails no criterion.

    >>> TOPIC_TYPE.name, TOPIC_TYPE.kind.code, TOPIC_TYPE.doubtful.code
    ('topic-type', 'REF007', 'REF009')
    """

    name: str  # which never changes; no check and no criterion has it
    family: AnyFamily  # of names_agree
    kind: Kind
    doubtful: Kind
    sentence: str  # what is right
    is_of_type: bool = False  # whether a value or a topic has another type

    def has(self, kind: Kind) -> bool:
        """Return whether a kind of problem is one of the rule.

        That a name is similar to another one, any rule may say.
        """
        return kind == self.kind or (kind == self.doubtful and kind != _SIMILAR)

    def problem(
        self, message: str, at: Location, subject: str = "", *, is_certain: bool = True
    ) -> Problem:
        """Return what does not agree as a problem of a file."""
        kind = self.kind if is_certain else self.doubtful
        return Problem(kind, message, at, subject or self.family, self.name)


def _rules_of(family: AnyFamily, kind: Kind, doubtful: Kind | None = None) -> "partial[Rule]":
    return partial(Rule, family=family, kind=kind, doubtful=doubtful or kind)


_file = _rules_of("files", _NO_FILE, _SIMILAR)
_similar_file = _rules_of("files", _SIMILAR)
FILE_INSTALLED = _file(
    "file-installed", sentence="A build installs each file at the path that another file names."
)
FILE_PACKAGE = _file("file-package", sentence="The package of a path exists.")
MAP_IMAGE = _file("map-image", sentence="The image of a map exists.")
WORLD_MODEL = _file("world-model", sentence="The models that a world includes exist.")
LAUNCH_FILE_NAME = _similar_file(
    "launch-file-name", sentence="An included launch file of a well-known package exists."
)
FILE_USED = Rule(
    "file-used", "files", _UNUSED, _UNUSED, "Another file names each file of the robot."
)

_frame = _rules_of("frames", _NO_FRAME, _SIMILAR)
_similar_frame = _rules_of("frames", _SIMILAR)
_FRAME_DEFINED = _frame("frame-defined", sentence="The frames that files name exist.")
_LINK_DEFINED = _frame("link-defined", sentence="The links that files name are in the robot.")
JOINT_DEFINED = _frame("joint-defined", sentence="The joints that files name are in the robot.")
_GROUP_DEFINED = _frame("group-defined", sentence="The groups that files name are in the SRDF.")
ROOT_FRAME = _frame(
    "root-frame",
    sentence="A frame that code publishes is not a misspelling of the root of the robot.",
)
FRAME_PARENT = _frame("frame-parent", sentence="A link of the robot gets no second parent.")
STATE_LIMITS = _frame(
    "state-limits", sentence="The states of an SRDF are within the limits of the joints."
)
DISABLED_PAIRS = _similar_frame(
    "disabled-pairs",
    sentence="An SRDF disables the collisions between links that a joint connects.",
)

_controller = _rules_of("controllers", _NO_CONTROLLER, _SIMILAR)
_CONTROLLER_DEFINED = _controller(
    "controller-defined", sentence="The controllers that files name are defined."
)
CONTROLLER_TYPE = _controller(
    "controller-type", sentence="The type of a controller is one that a package has."
)
CONTROLLER_PARAMETERS = _controller(
    "controller-parameters", sentence="A controller that needs parameters has some."
)
CONTROLLER_LIST = _controller(
    "controller-list", sentence="A parameter of a controller that needs a list has one."
)
CLAIMED_ONCE = _controller(
    "claimed-once", sentence="A controller claims each command interface once."
)
CONTROLLER_INTERFACE = _controller(
    "controller-interface",
    sentence="<ros2_control> has the command interfaces that a controller needs.",
)
CONTROLLER_HARDWARE = _controller(
    "controller-hardware", sentence="A robot with a controller manager has <ros2_control>."
)
INTERFACE_ONCE = _controller(
    "interface-once", sentence="A robot has each command interface in one <ros2_control> only."
)
MIMIC_COMMAND = _controller(
    "mimic-command", sentence="A joint that mimics another one has no command interface."
)
GAZEBO_HARDWARE = _controller(
    "gazebo-hardware", sentence="The plugin of ros2_control loads hardware of its own package."
)
PLUGIN_CLASS = _controller(
    "plugin-class",
    sentence="A package of the workspace describes the controller or hardware that a file names.",
)
PLUGIN_EXPORTED = _controller(
    "plugin-exported", sentence="CMakeLists.txt exports the files that describe plugins."
)
PLUGIN_LIBRARY = _controller(
    "plugin-library", sentence="A target makes the library of a file that describes plugins."
)
SPAWNER_MANAGER = _controller(
    "spawner-manager", sentence="The controller manager that a spawner asks is started."
)
MANAGER_PARAMETERS = _controller(
    "manager-parameters",
    sentence="The controller manager gets the types of the controllers that spawners start.",
)
MANAGER_SECTION = _controller(
    "manager-section", sentence="The types of controllers are below controller_manager."
)
CONTROLLER_STARTED = _controller(
    "controller-started",
    sentence="A spawner starts one of the controllers that move joints, and one that publishes.",
)
MOVEIT_CONTROLLER = _controller(
    "moveit-controller", sentence="A spawner starts the controllers that MoveIt commands."
)
MOVEIT_ACTION = _controller("moveit-action", sentence="MoveIt names the action of its controller.")
MOVEIT_JOINTS = _controller(
    "moveit-joints", sentence="MoveIt gives a controller the joints that it has."
)

_parameter = _rules_of("parameters", _NO_PARAMETER, _SIMILAR)
_PARAMETER_DEFINED = _parameter(
    "parameter-defined",
    sentence="A node declares the parameters that it is given and those that its code reads.",
)
_PLUGIN_SECTION = _parameter(
    "plugin-section", sentence="The plugins of a list have a section beside it."
)
PLUGIN_NAME = _parameter("plugin-name", sentence="The class of a plugin is one that exists.")
PARAMETER_FILE = _parameter(
    "parameter-file",
    sentence="An installed YAML file can be parsed, and a parameter file has no aliases.",
)
PARAMETER_KEY = _parameter(
    "parameter-key", sentence="The parameters of a node are below one key ros__parameters."
)
PARAMETER_NODE = _parameter(
    "parameter-node", sentence="A parameter file has a section for the node that gets it."
)
PARAMETER_NAMESPACE = _parameter(
    "parameter-namespace", sentence="The section of a node has the node's namespace."
)
NODE_SECTION = _parameter(
    "node-section", sentence="The section of a node has the name that its launch file gives it."
)
PARAMETER_REQUIRED = _parameter(
    "parameter-required", sentence="A node gets the parameters without which it stops."
)
PARAMETER_TYPE = _parameter(
    "parameter-type", sentence="A parameter has the type that its node declares.", is_of_type=True
)
PARAMETER_VALUE = _parameter(
    "parameter-value", sentence="A parameter has a value that its node accepts."
)
PLANNING_LIST = _parameter(
    "planning-list",
    sentence="The adapters of a planning pipeline of MoveIt are a list from Jazzy on.",
    is_of_type=True,
)
FILTER_SIZE = _parameter(
    "filter-size", sentence="An input of a robot_localization filter has 15 values."
)
ROBOT_TEXT = _parameter("robot-text", sentence="robot_description is the text of a robot.")
ROBOT_EXPANDED = _parameter(
    "robot-expanded", sentence="The text of a robot is what xacro makes of its file."
)
ROBOT_LINKS = _parameter(
    "robot-links", sentence="The file of a robot that a launch file starts has links."
)
CREATED_FROM = _parameter(
    "created-from", sentence="The program that creates a robot in Gazebo gets its source."
)
PARAMETER_TABLE = _parameter(
    "parameter-table", sentence="The parameters of a node in a launch file are a dictionary."
)
PARAMETER_NAME = Rule(
    "parameter-name",
    "parameters",
    _NO_SUCH_PARAMETER,
    _NO_SUCH_PARAMETER,
    "The parameters of a well-known node are those that it has.",
)
PARAMETER_EFFECT = Rule(
    "parameter-effect",
    "parameters",
    _NO_EFFECT,
    _NO_EFFECT,
    "The parameters of a well-known node have an effect under the values of others.",
)
PLUGIN_LISTED = Rule(
    "plugin-listed",
    "parameters",
    _NO_EFFECT,
    _NO_EFFECT,
    "A list of plugins names each layer that is configured.",
)
PARAMETER_READ = Rule(
    "parameter-read", "words", _UNREAD, _UNREAD, "Code reads the parameters that it declares."
)
LAUNCH_ARGUMENT_USED = Rule(
    "launch-argument-used",
    "words",
    _UNREAD,
    _UNREAD,
    "A launch file uses the arguments that it declares.",
)
XACRO_ARGUMENT_USED = Rule(
    "xacro-argument-used",
    "words",
    _UNREAD,
    _UNREAD,
    "The files of xacro use the arguments that they declare.",
)
PARAMETER_RELEASE = Rule(
    "parameter-release",
    "parameters",
    _OTHER_RELEASE,
    _OTHER_RELEASE,
    "The parameters of a well-known node are those of the stated release.",
)
NAME_RELEASE = Rule(
    "name-release",
    "words",
    _OTHER_RELEASE,
    _OTHER_RELEASE,
    "Packages, programs, controllers, plugins and topics are of the stated release.",
)
PARAMETER_LIST = _parameter(
    "parameter-list",
    sentence="A list in a parameter file has values of one type, and a key has a value.",
)

_argument = _rules_of("arguments", _NO_ARGUMENT, _SIMILAR)
_LAUNCH_ARGUMENT = _argument(
    "launch-argument", sentence="The arguments that an include passes are declared."
)
_XACRO_ARGUMENT = _argument(
    "xacro-argument", sentence="The arguments that xacro gets are declared."
)

_program = _rules_of("programs", _NO_PROGRAM, _SIMILAR)
PROGRAM_EXISTS = _program(
    "program-exists", sentence="The package of a started node has its program."
)
ENTRY_POINT = _program("entry-point", sentence="An entry point names a function that exists.")
ENTRY_MODULE = _program(
    "entry-module",
    sentence="An entry point runs the module of its own name, if that has such a function.",
)
PROGRAM_RUNS = _program("program-runs", sentence="The first line of a script names an interpreter.")
_NODE_STARTED = _program(
    "node-started", sentence="A launch file starts the nodes that a lifecycle manager manages."
)
COMPONENT_REGISTERED = _program(
    "component-registered",
    sentence="CMakeLists.txt of the package registers the component that a launch file loads.",
)

_topic = _rules_of("topics", _NO_TOPIC, _SIMILAR)
_TOPIC_DEFINED = _topic(
    "topic-defined",
    sentence="A node has the topic that a remapping replaces, and what code reads is published.",
)
TOPIC_TYPE = _topic(
    "topic-type",
    sentence="Publishers and subscriptions of a topic have one type.",
    is_of_type=True,
)
TOPIC_QUALITY = _topic(
    "topic-quality", sentence="A publisher offers the quality of service that a subscription needs."
)
TOPIC_PUBLISHED = _topic(
    "topic-published", sentence="The topic that a node subscribes to is published."
)
TOPIC_SUBSCRIBED = _topic(
    "topic-subscribed",
    sentence="The topic that a node publishes is the one that a controller waits for.",
)
BRIDGE_FILE = _topic("bridge-file", sentence="A file of bridge rows is a list in YAML.")
BRIDGE_ROW = _topic("bridge-row", sentence="A row of a bridge has the keys that the bridge needs.")
BRIDGE_ARGUMENT = _topic(
    "bridge-argument", sentence="An argument of a bridge names a topic with its types."
)
BRIDGE_DIRECTION = _topic(
    "bridge-direction", sentence="A row of a bridge goes in the direction of its messages."
)
BRIDGE_TYPE = _topic(
    "bridge-type",
    sentence="A bridge converts the types of its rows, and a row has the type of Gazebo's topic.",
)
BRIDGE_TOPIC = _topic("bridge-topic", sentence="Gazebo has the topic of a row of a bridge.")
BRIDGE_CLOCK = _topic("bridge-clock", sentence="A bridge takes the clock from Gazebo.")
BRIDGE_TOPICS = _topic("bridge-topics", sentence="A bridge has topics.")
BRIDGE_SYSTEM = _topic(
    "bridge-system",
    sentence="The robot has a system for the commands, joints and odometry of a bridge.",
)
ODOMETRY_BRIDGED = _topic(
    "odometry-bridged", sentence="A bridge takes the transform of odometry that RViz shows to /tf."
)
SENSOR_SYSTEM = _topic("sensor-system", sentence="A world has the systems that its sensors need.")
CREATED_WORLD = _topic(
    "created-world", sentence="A robot is created in the world that Gazebo runs."
)
CREATED_TOPIC = _topic(
    "created-topic", sentence="A robot is created from the topic that robot_state_publisher has."
)

DEPENDENCY_DECLARED = Rule(
    "dependency-declared",
    "dependencies",
    _NO_DEPENDENCY,
    _LENT,
    "package.xml declares the packages that the files of the package use.",
)
BUILD_ORDER = _rules_of("dependencies", _BUILT_LATER)(
    "build-order",
    sentence="package.xml declares the packages of the workspace that CMake needs.",
)
PACKAGE_EXISTS = Rule(
    "package-exists",
    "dependencies",
    _NO_PACKAGE,
    _NOWHERE,
    "The packages that files name exist: in the workspace, or in a release of ROS 2.",
)
ROSDEP_KEY = Rule(
    "rosdep-key",
    "keys",
    _NO_KEY,
    _UNKNOWN_KEY,
    "rosdep knows the dependencies in package.xml that the workspace does not have.",
)

LIBRARY_DECLARED = Rule(
    "library-declared",
    "keys",
    _NO_DEPENDENCY,
    _BROUGHT,
    "package.xml declares the libraries of Python and C++ that the files of the package use.",
)

_service = _rules_of("services", _NO_SERVICE, _SIMILAR)
SERVICE_TYPE = _service(
    "service-type",
    sentence="A service or action is called with the type with which it is served.",
    is_of_type=True,
)
SERVICE_SERVED = _service(
    "service-served", sentence="The service or action that a node calls is served."
)

_interface = _rules_of("interfaces", _NO_INTERFACE, _SIMILAR)
INTERFACE_FILE = _interface(
    "interface-file", sentence="rosidl reads the files of messages, services and actions."
)
INTERFACE_GROUP = _interface(
    "interface-group",
    sentence="package.xml of a package with interfaces has <member_of_group>.",
)
INTERFACE_DEPENDENCY = _interface(
    "interface-dependency",
    sentence="rosidl_generate_interfaces() names the packages whose types fields have.",
)
INTERFACE_TYPE = _interface(
    "interface-type",
    sentence="The messages, services and actions that code and interface files use exist.",
)
INTERFACE_FIELD = _interface(
    "interface-field", sentence="The fields and constants that code uses exist."
)
FIELD_VALUE = _interface(
    "field-value", sentence="A field is set to a value of its type.", is_of_type=True
)

_code = _rules_of("code", _NO_RUN, _MAY_WAIT)
_slow_code = _rules_of("code", _MAY_WAIT)
MODULE_INSTALLED = _code(
    "module-installed", sentence="A build installs the modules of the package that a node imports."
)
CODE_SYNTAX = _code("code-syntax", sentence="The Python modules of nodes have no syntax errors.")
NAME_BINDING = _code(
    "name-binding",
    sentence="Names and attributes are defined, and format strings get their arguments.",
)
CALLBACK_CALL = _code(
    "callback-call", sentence="A callback is given as a function, and not called."
)
CALLBACK_PARAMETERS = _code(
    "callback-parameters", sentence="A callback takes the arguments that it is called with."
)
CALL_ARGUMENTS = _code(
    "call-arguments", sentence="A call of rclpy or tf2_ros has the arguments that it takes."
)
SERVICE_RESPONSE = _code(
    "service-response",
    sentence="The callback of a service or action returns its response or result on every path.",
)
CONSTRUCTOR_ORDER = _code("constructor-order", sentence="A node is used after super().__init__().")
GOAL_STATE = _slow_code(
    "goal-state",
    sentence="An action server accepts goals, and the function that executes one sets its state.",
)
ACTION_RESULT = _code(
    "action-result", sentence="The result of an action is the field result of its answer."
)
NODE_SPINS = _code("node-spins", sentence="A node with callbacks is spun.")
RCLPY_INIT = _code("rclpy-init", sentence="A node is made after rclpy.init().")
CALLBACK_WAIT = _code("callback-wait", sentence="A callback waits for no other callback.")
CALLBACK_SLEEP = _slow_code("callback-sleep", sentence="A callback does not sleep.")
ENTITY_KEPT = _code("entity-kept", sentence="A node keeps what it makes.")
NAME_VALID = _code(
    "name-valid", sentence="ROS 2 accepts the names of nodes, topics, services and actions in code."
)
PUBLISHER_ACTIVATED = _code(
    "publisher-activated", sentence="A node with a lifecycle activates its publishers."
)
BUFFER_LISTENER = _code("buffer-listener", sentence="A buffer of transforms has a listener.")
ROTATION_SET = _code("rotation-set", sentence="A transform that is sent has a rotation.")
COMPONENT_MACRO = _code(
    "component-macro", sentence="A source file registers the component that CMakeLists.txt names."
)
PROGRAM_MAIN = _code("program-main", sentence="The sources of a C++ program have a main().")
RCLCPP_INIT = _code("rclcpp-init", sentence="A C++ program makes its nodes after rclcpp::init().")
COMPONENT_CONSTRUCTOR = _code(
    "component-constructor", sentence="A component has a constructor that takes NodeOptions."
)

_value = _rules_of("values", _WRONG_VALUE, _OTHER_VALUE)
_other_value = _rules_of("values", _OTHER_VALUE)
WHEEL_SIDE = _value(
    "wheel-side",
    sentence="The left and right wheels of a controller or a Gazebo plugin are on their sides.",
)
WHEEL_AXIS = _other_value("wheel-axis", sentence="A positive speed of a wheel drives forward.")
WHEEL_DISTANCE = _value(
    "wheel-distance",
    sentence="The track and wheelbase of a controller or a Gazebo plugin are those of the robot.",
)
WHEEL_SIZE = _value(
    "wheel-size",
    sentence="The wheel radius of a controller or a Gazebo plugin is that of the robot.",
)
WHEEL_LIMIT = _other_value(
    "wheel-limit", sentence="A wheel that is driven in Gazebo turns without limits."
)
JOINT_LIMIT = _other_value(
    "joint-limit", sentence="The limits in a file are within those of the robot's joints."
)
FOOTPRINT_SIZE = _other_value(
    "footprint-size", sentence="The footprint of a costmap holds the robot."
)
OBSTACLE_RANGE = _other_value(
    "obstacle-range", sentence="A costmap asks for no obstacles beyond the range of its lidar."
)
SCAN_RATE = _other_value(
    "scan-rate", sentence="A costmap expects scans no more often than its lidar measures."
)
PUBLISH_RATE = _other_value(
    "publish-rate", sentence="A controller publishes no more often than it is updated."
)
STATIC_POSE = _other_value(
    "static-pose", sentence="A static transform of a link equals its fixed joint."
)
ROBOT_STANDS = _other_value(
    "robot-stands",
    sentence="A robot stands level on its wheels, and they drive it straight ahead.",
)
CENTRE_OF_MASS = _other_value(
    "centre-of-mass", sentence="The centre of mass of a link is within its shapes."
)
INERTIA_AXIS = _other_value(
    "inertia-axis", sentence="The inertia of a cylinder is that about its own axis."
)
INERTIA_PLACE = _other_value(
    "inertia-place", sentence="The inertia of a shape about its middle has its <origin> there."
)
INERTIA_SIZE = _other_value(
    "inertia-size", sentence="The inertia of a link is that of a body of its size."
)
LINK_SIDE = _other_value(
    "link-side", sentence="Links that are called left are on the left of those called right."
)
COLLISION_PLACE = _other_value(
    "collision-place", sentence="A collision with the shape of a visual is where that is."
)
GAZEBO_INERTIA = _other_value(
    "gazebo-inertia", sentence="A link that a joint moves in Gazebo has a mass."
)
MESH_UNIT = _other_value("mesh-unit", sentence="Meshes are in metres.")

_transform = _rules_of("transforms", _WRONG_TRANSFORM, _OTHER_TRANSFORM)
TRANSFORM_ROTATION = _transform(
    "transform-rotation", sentence="The quaternion of a static transform is a rotation."
)
TRANSFORM_OWNER = _transform(
    "transform-owner", sentence="One program publishes the transform of a frame."
)
TRANSFORM_CYCLE = _transform("transform-cycle", sentence="The transforms of a robot have no cycle.")
TRANSFORM_CONNECTED = Rule(
    "transform-connected",
    "transforms",
    _UNCONNECTED,
    _UNCONNECTED,
    "The frames between which a node looks up a transform are connected.",
)

_companion = _rules_of("wiring", _NO_COMPANION)
NODE_NAME = _companion("node-name", sentence="The nodes of a launch file have different names.")
ONE_JOINT_STATE = _companion(
    "one-joint-state", sentence="One program publishes the positions of the joints."
)
JOINT_STATES = _companion(
    "joint-states", sentence="Something publishes the positions of the joints."
)
ROBOT_PUBLISHED = _companion(
    "robot-published", sentence="robot_state_publisher gives the controller manager the robot."
)
CLOCK_PUBLISHED = _companion(
    "clock-published", sentence="Something publishes the clock of nodes with use_sim_time."
)
SIMULATION_TIME = _companion("simulation-time", sentence="The nodes of a simulation use its time.")
SIMULATED_NODE = Rule(
    "simulated-node",
    "wiring",
    _OTHER_TIME,
    _OTHER_TIME,
    "The nodes that a launch file starts beside Gazebo use its time.",
)
PROGRAM_TERMINAL = Rule(
    "program-terminal",
    "wiring",
    _MAY_WAIT,
    _MAY_WAIT,
    "A program that reads keys or lines is started in a terminal.",
)
SIMULATED_JOINTS = _companion(
    "simulated-joints",
    sentence="Something publishes the positions of the joints of a robot in Gazebo.",
)
SIMULATION_STARTED = _companion(
    "simulation-started", sentence="Something starts the Gazebo in which a robot is created."
)
CONTAINER_STARTED = _companion(
    "container-started", sentence="The container of a component is started."
)
UNSTARTED_TYPE = _companion(
    "unstarted-type",
    sentence="Two programs of a package that share a topic have one type for it.",
)
TOPIC_PARTNER = _companion(
    "topic-partner",
    sentence="A topic that a node waits for is one that another node of its launch publishes.",
)
SENSOR_TOPIC = _companion(
    "sensor-topic", sentence="The sensor whose messages a bridge takes has a <topic>."
)
INPUT_TYPE = _companion(
    "input-type", sentence="A well-known program reads a topic with the type that it has."
)
INPUT_PUBLISHED = _companion(
    "input-published", sentence="The topic that a parameter names is published."
)
DISPLAY_TYPE = _companion(
    "display-type", sentence="A display of RViz reads a topic with the type that it has."
)
DISPLAY_QUALITY = _companion(
    "display-quality", sentence="A display of RViz asks for no more than is offered."
)
ONE_COMMANDER = _companion("one-commander", sentence="One node commands the robot.")
IMAGE_TRANSPORT = _companion(
    "image-transport", sentence="Images are read from the topic that carries them."
)
COMMAND_TYPE = _companion(
    "command-type", sentence="A well-known program sends a controller the type that it reads."
)

_machine = _rules_of("machine", _ONE_MACHINE)
HOME_PATH = _machine("home-path", sentence="No file names a folder of one user's machine.")
RELEASE_PATH = _machine(
    "release-path", sentence="Files of ROS 2 are found by packages, and not in a release's folder."
)
ENVIRONMENT_VARIABLE = _machine(
    "environment-variable",
    sentence="A launch file gives an environment variable a default.",
)

_moveit = _rules_of("moveit", _OTHER_MOVEIT)
SRDF_ROBOT = _moveit("srdf-robot", sentence="An SRDF names its robot.")
SRDF_GROUP = _moveit("srdf-group", sentence="A group of an SRDF is not empty.")

_word = _rules_of("words", _NO_WORD)
CLASSIC_PLUGIN = _word(
    "classic-plugin",
    sentence="The plugins of Gazebo Classic and their elements are those of ROS 2.",
)
CREATE_OPTION = _word(
    "create-option", sentence="The program that creates a robot in Gazebo has the given options."
)
REMAPPED_TOPIC = _word(
    "remapped-topic", sentence="A remapping of a well-known program names a topic that it has."
)
OLDER_GAZEBO = Rule(
    "older-gazebo",
    "words",
    _FORM,
    _FORM,
    "Plugins have the names of Gazebo, where the workspace uses that in place of Ignition.",
)
_message = _rules_of("messages", _NO_MESSAGE)
MESSAGE_HEADER = _message(
    "message-header", sentence="The messages of a filter or synchroniser have a header."
)
MESSAGE_STAMP = _message(
    "message-stamp", sentence="Messages and transforms have a stamp where what reads them needs it."
)
MESSAGE_DEPTH = _message("message-depth", sentence="A publisher or subscription keeps messages.")
IMAGE_ENCODING = _message(
    "image-encoding", sentence="cv_bridge converts the images of a topic to the asked encoding."
)

GAIN_SET = Rule(
    "gain-set",
    "effects",
    _MOVES_NOTHING,
    _MOVES_NOTHING,
    "A controller that computes efforts or velocities with gains has gains.",
)
NAMES_COMPARED = Rule(
    "names-compared", "files", _UNCOMPARED, _UNCOMPARED, "All names of a workspace are compared."
)

_build = _rules_of("builds", _NOT_COMPILED)
OWN_HEADER = _build(
    "own-header", sentence="The headers of a package that a compiled file includes exist."
)
PACKAGE_NESTED = Rule(
    "package-nested",
    "builds",
    _NOT_BUILT,
    _NOT_BUILT,
    "No package is below the folder of another one, where colcon does not look.",
)
HEADER_INSTALLED = _build(
    "header-installed", sentence="A build installs the headers that other packages include."
)
_form = _rules_of("builds", _FORM)
DEPENDENCY_ONCE = _form("dependency-once", sentence="package.xml declares a dependency once.")
DEPENDENCY_KIND = _form(
    "dependency-kind",
    sentence="package.xml declares what a build needs for it, and what a run needs for that.",
)
MANIFEST_TEXT = _form("manifest-text", sentence="package.xml has no text beside its elements.")
PACKAGE_NAME = _form(
    "package-name", sentence="The name of a package has small letters, digits and underscores."
)
PACKAGE_VERSION = _form(
    "package-version", sentence="setup.py has the version that package.xml has."
)
SETUP_KEY = _form("setup-key", sentence="The keys of setup.cfg have underscores, and no dashes.")
PYTHON_BUILD_TYPE = _rules_of("builds", _NO_BUILD)(
    "python-build-type", sentence="package.xml of a package with setup.py has a build type."
)
# What is wrong where a name of a kind is not defined.
DEFINED: Mapping[DefinedKind, Rule] = {
    "frame": _FRAME_DEFINED,
    "link": _LINK_DEFINED,
    "joint": JOINT_DEFINED,
    "group": _GROUP_DEFINED,
    "controller": _CONTROLLER_DEFINED,
    "plugin section": _PLUGIN_SECTION,
    "parameter": _PARAMETER_DEFINED,
    "launch argument": _LAUNCH_ARGUMENT,
    "xacro argument": _XACRO_ARGUMENT,
    "node": _NODE_STARTED,
    "topic": _TOPIC_DEFINED,
}
RULES: Mapping[str, Rule] = {
    rule.name: rule for rule in [*globals().values()] if isinstance(rule, Rule)
}
