"""Code: what stops own nodes, or keeps them from doing anything."""

from grader.ros.known.releases import is_before
from grader.ros.launch.valid_names import is_node_name, why_no_topic
from grader.ros.nodes.node_facts import NodeFacts
from grader.ros.package.found_problems import syntax_fixes
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
    Undecided,
    warning,
)
from grader.workspace.rules.rule_table import (
    MAY_WAIT,
    NO_RUN,
    Rule,
)
from grader.workspace.rules.shared_symptoms import COMPONENT_CLASS, COMPONENT_RESOURCE

_CODE_SYNTAX = Rule(
    "code-syntax",
    "code",
    NO_RUN,
    "The Python modules of nodes have no syntax errors.",
    why=(
        "Python ends with a SyntaxError before the node is created, so ros2 launch reports that"
        " the process has died."
    ),
    wrong="""
def __init__(self)
    super().__init__('pilot')
""",
    right="""
def __init__(self):
    super().__init__('pilot')
""",
    frame="pilot.py",
)

_NAME_BINDING = Rule(
    "name-binding",
    "code",
    NO_RUN,
    "Names and attributes are defined, and format strings get their arguments.",
    why=(
        "Python finds the mistake only when the line runs. The node then stops with a "
        "NameError, AttributeError or TypeError, often in a callback."
    ),
    wrong="self.speeds.publish(Float32(data=1.0))",
    right="self.speeds.publish(Float64(data=1.0))",
    frame="tick/pilot.py",
)

_VALUE_OBJECT = Rule(
    "value-object",
    "code",
    NO_RUN,
    "Messages and computations get the values of parameters and times, not these objects.",
    why=(
        "get_parameter() and declare_parameter() return a Parameter, now() a Time of rclpy. Python "
        "raises an error where a number or a field of a message is meant."
    ),
    wrong="""
def __init__(self):
    super().__init__('pilot')
    self.declare_parameter('speed', 0.5)
    self.fast = 2 * self.get_parameter('speed')
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    self.declare_parameter('speed', 0.5)
    self.fast = 2 * self.get_parameter('speed').value
""",
    frame="pilot.py",
)

_CALLBACK_CALL = Rule(
    "callback-call",
    "code",
    NO_RUN,
    "A callback is given as a function, and not called.",
    why=(
        "The function runs once, while the node is created. ROS 2 gets its result, mostly None,"
        " and no event calls the function later."
    ),
    wrong="""
def __init__(self):
    super().__init__('pilot')
    self.create_timer(0.5, self.tick())

def tick(self):
    self.get_logger().info('tick')
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    self.create_timer(0.5, self.tick)

def tick(self):
    self.get_logger().info('tick')
""",
    frame="pilot.py",
)

_FUNCTION_CALL = Rule(
    "function-call",
    "code",
    NO_RUN,
    "A function that is a statement of its own is called.",
    why=(
        "Without the parentheses Python looks the function up and does nothing. No error is "
        "printed, or one of what the call should have prepared."
    ),
    wrong="""
rclpy.init
rclpy.spin(Pilot())
""",
    right="""
rclpy.init()
rclpy.spin(Pilot())
""",
    frame="main/pilot.py",
)

_DECLARED_ONCE = Rule(
    "declared-once",
    "code",
    NO_RUN,
    "A node declares a parameter once, and makes the same timer or subscription once.",
    why=(
        "rclpy raises ParameterAlreadyDeclaredException, and the node ends at its start. Two "
        "timers or subscriptions of one callback call it twice as often."
    ),
    wrong="""
def __init__(self):
    super().__init__('pilot')
    self.speed = self.declare_parameter('speed', 0.5).value
    self.declare_parameter('speed', 0.5)
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    self.speed = self.declare_parameter('speed', 0.5).value
    self.declare_parameter('width', 0.5)
""",
    frame="pilot.py",
)

_FILTER_CALLBACK = Rule(
    "filter-callback",
    "code",
    NO_RUN,
    "A synchroniser of message_filters has a callback.",
    why="Messages arrive and are compared, and no function gets them. No error is printed.",
    wrong="self.pairs = message_filters.TimeSynchronizer([self.left, self.right], 10)",
    right="""
self.pairs = message_filters.TimeSynchronizer([self.left, self.right], 10)
self.pairs.registerCallback(self.hear)
""",
    frame="pairs/pilot.py",
)

_TRANSFORM_REGISTERED = Rule(
    "transform-registered",
    "code",
    NO_RUN,
    "A program that transforms messages imports their conversions.",
    why=(
        "tf2_ros raises a TypeException, because nothing has registered how to transform the type "
        "of the message. The node stops at the first one."
    ),
    wrong="from geometry_msgs.msg import PointStamped",
    right="""
import tf2_geometry_msgs
from geometry_msgs.msg import PointStamped
""",
    frame="transform/pilot.py",
    at="rover/pilot.py",
)

_CALLBACK_PARAMETERS = Rule(
    "callback-parameters",
    "code",
    NO_RUN,
    "A callback takes the arguments that it is called with.",
    why=(
        "rclpy raises a TypeError at the first message, request or timer event, and the node "
        "stops. Until then it seems to work."
    ),
    wrong="""
def __init__(self):
    super().__init__('pilot')
    self.create_service(Trigger, 'stop', self.stop)

def stop(self, request):
    return Trigger.Response(success=True)
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    self.create_service(Trigger, 'stop', self.stop)

def stop(self, request, response):
    response.success = True
    return response
""",
    frame="pilot.py",
)

_CALL_ARGUMENTS = Rule(
    "call-arguments",
    "code",
    NO_RUN,
    "A call of rclpy or tf2_ros has the arguments that it takes.",
    why=(
        "Python raises a TypeError at the call, such as 'missing 1 required positional "
        "argument'. The node stops, mostly at its start."
    ),
    wrong="""
def __init__(self):
    super().__init__('pilot')
    self.publisher = self.create_publisher(Float64, 'speed')
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    self.publisher = self.create_publisher(Float64, 'speed', 10)
""",
    frame="pilot.py",
)

_SERVICE_RESPONSE = Rule(
    "service-response",
    "code",
    NO_RUN,
    "The callback of a service or action returns its response or result on every path.",
    why=(
        "rclpy has nothing to send at the end of the call. A service raises a TypeError that "
        "stops the node, and its client gets no answer."
    ),
    wrong="""
def __init__(self):
    super().__init__('pilot')
    self.create_service(Trigger, 'stop', self.stop)

def stop(self, request, response):
    response.success = True
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    self.create_service(Trigger, 'stop', self.stop)

def stop(self, request, response):
    response.success = True
    return response
""",
    frame="pilot.py",
)

_CONSTRUCTOR_ORDER = Rule(
    "constructor-order",
    "code",
    NO_RUN,
    "A node is used after super().__init__().",
    why=(
        "Before that call the object has no publishers, parameters or logger yet. Python raises"
        " an AttributeError, and the node ends at its start."
    ),
    wrong="""
def __init__(self):
    self.declare_parameter('speed', 0.5)
    super().__init__('pilot')
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    self.declare_parameter('speed', 0.5)
""",
    frame="pilot.py",
)

_GOAL_STATE = Rule(
    "goal-state",
    "code",
    MAY_WAIT,
    "An action server accepts goals, and the function that executes one sets its state.",
    why=(
        "rclpy prints 'Goal state not set, assuming aborted', and rclcpp_action cancels the "
        "goal: the client sees a failure. A rejected goal never runs."
    ),
    wrong="""
def drive(self, goal_handle):
    result = Fibonacci.Result()
    result.sequence = [0, 1]
    return result
""",
    right="""
def drive(self, goal_handle):
    result = Fibonacci.Result()
    result.sequence = [0, 1]
    goal_handle.succeed()
    return result
""",
    frame="goal/pilot.py",
)

_ACTION_RESULT = Rule(
    "action-result",
    "code",
    NO_RUN,
    "The result of an action is the field result of its answer.",
    why=(
        "get_result_async() returns the status and the result in one object. Python raises an "
        "AttributeError when it arrives, so the result is lost."
    ),
    wrong="""
def finish(self, future):
    self.get_logger().info(f'{future.result().sequence}')
""",
    right="""
def finish(self, future):
    self.get_logger().info(f'{future.result().result.sequence}')
""",
    frame="ask/pilot.py",
)

_NODE_SPINS = Rule(
    "node-spins",
    "code",
    NO_RUN,
    "A node with callbacks is spun.",
    why=(
        "Without spinning, the executor calls no callback: timers never fire and no message "
        "arrives. No error is printed."
    ),
    wrong="""
rclpy.init()
Pilot()
""",
    right="""
rclpy.init()
rclpy.spin(Pilot())
""",
    frame="main/pilot.py",
)

_RCLPY_INIT = Rule(
    "rclpy-init",
    "code",
    NO_RUN,
    "A node is made after rclpy.init().",
    why=(
        "rclpy raises an error because rclpy.init() has not been called, and the program ends "
        "before it creates a node."
    ),
    wrong="rclpy.spin(Pilot())",
    right="""
rclpy.init()
rclpy.spin(Pilot())
""",
    frame="main/pilot.py",
)

_CALLBACK_WAIT = Rule(
    "callback-wait",
    "code",
    NO_RUN,
    "A callback waits for no other callback.",
    why=(
        "The answer is read only after the callback ends, and the callback waits for it: the "
        "node hangs. rclcpp throws if a callback spins its own node."
    ),
    wrong="""
future = self.client.call_async(Trigger.Request())
rclpy.spin_until_future_complete(self, future)
""",
    right="""
future = self.client.call_async(Trigger.Request())
future.add_done_callback(lambda done: self.get_logger().info(done.result().message))
""",
    frame="tick/pilot.py",
)

_CALLBACK_SLEEP = Rule(
    "callback-sleep",
    "code",
    MAY_WAIT,
    "A callback does not sleep.",
    why=(
        "The default executor runs one callback at a time. During the sleep messages wait or "
        "are lost, timers are late, and services do not answer."
    ),
    wrong="""
def __init__(self):
    super().__init__('pilot')
    self.create_timer(0.5, self.tick)
    self.create_timer(0.1, self.drive)

def tick(self):
    time.sleep(2.0)

def drive(self):
    self.get_logger().info('drive')
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    self.create_timer(2.0, self.tick)
    self.create_timer(0.1, self.drive)

def tick(self):
    self.get_logger().info('tick')

def drive(self):
    self.get_logger().info('drive')
""",
    frame="pilot.py",
)

_ENTITY_KEPT = Rule(
    "entity-kept",
    "code",
    NO_RUN,
    "A node keeps what it makes.",
    why=(
        "A timer, subscription or listener that no variable holds is destroyed at the end of "
        "the block. Its callback is never called, without an error."
    ),
    wrong="auto timer = create_wall_timer(std::chrono::seconds(1), [this]() {send();});",
    right="timer_ = create_wall_timer(std::chrono::seconds(1), [this]() {send();});",
    frame="talk.cpp",
    beside={
        "package.xml": "",
        "talk/CMakeLists.txt": "",
    },
)

_PUBLISHER_ACTIVATED = Rule(
    "publisher-activated",
    "code",
    NO_RUN,
    "A node with a lifecycle activates its publishers.",
    why=(
        "The publisher drops each message and warns once that it is not activated. ros2 topic "
        "echo shows nothing, although the node is active."
    ),
    wrong="""
CallbackReturn on_activate(const rclcpp_lifecycle::State &) override
{
  return CallbackReturn::SUCCESS;
}
""",
    right="""
CallbackReturn on_activate(const rclcpp_lifecycle::State & state) override
{
  LifecycleNode::on_activate(state);
  return CallbackReturn::SUCCESS;
}
""",
    frame="active/talk.cpp",
    beside={
        "package.xml": "",
        "talk/CMakeLists.txt": "",
    },
    at="src/talk.cpp",
)

_CALLBACK_NAME = Rule(
    "callback-name",
    "code",
    NO_RUN,
    "Callbacks of a lifecycle node have the names that the lifecycle calls.",
    why=(
        "ros2 lifecycle reports success, because the node's base class has the callback, and what "
        "the method should do is never done."
    ),
    wrong="""
CallbackReturn on_activated(const rclcpp_lifecycle::State & state)
{
  return LifecycleNode::on_activate(state);
}
""",
    right="""
CallbackReturn on_activate(const rclcpp_lifecycle::State & state) override
{
  return LifecycleNode::on_activate(state);
}
""",
    frame="active/talk.cpp",
    beside={
        "package.xml": "",
        "talk/CMakeLists.txt": "",
    },
    at="src/talk.cpp",
)

_BUFFER_LISTENER = Rule(
    "buffer-listener",
    "code",
    NO_RUN,
    "A buffer of transforms has a listener.",
    why=(
        "No transform reaches the buffer, so each lookup reports that the frame does not exist,"
        " although other programs show the transform."
    ),
    wrong="buffer_ = std::make_unique<tf2_ros::Buffer>(get_clock());",
    right="""
buffer_ = std::make_unique<tf2_ros::Buffer>(get_clock());
listener_ = std::make_shared<tf2_ros::TransformListener>(*buffer_);
""",
    frame="look/talk.cpp",
    beside={
        "package.xml": "",
        "talk/CMakeLists.txt": "",
    },
    at="src/talk.cpp",
)

_ROTATION_SET = Rule(
    "rotation-set",
    "code",
    NO_RUN,
    "A transform that is sent has a rotation.",
    why=(
        "tf2 ignores a transform with a quaternion of zeros and prints "
        "TF_DENORMALIZED_QUATERNION. The frame does not exist for its listeners."
    ),
    wrong="""
geometry_msgs::msg::TransformStamped t;
t.header.frame_id = "odom";
t.child_frame_id = "base_link";
t.transform.rotation.x = 0.0;
t.transform.rotation.y = 0.0;
t.transform.rotation.z = 0.0;
t.transform.rotation.w = 0.0;
sender_->sendTransform(t);
""",
    right="""
geometry_msgs::msg::TransformStamped t;
t.header.frame_id = "odom";
t.child_frame_id = "base_link";
t.transform.rotation.x = 0.0;
t.transform.rotation.y = 0.0;
t.transform.rotation.z = 0.0;
t.transform.rotation.w = 1.0;
sender_->sendTransform(t);
""",
    frame="send/talk.cpp",
    beside={
        "package.xml": "",
        "talk/CMakeLists.txt": "",
    },
)

_COMPONENT_MACRO = Rule(
    "component-macro",
    "code",
    NO_RUN,
    "A source file registers the component that CMakeLists.txt names.",
    why=(
        "The library then has no factory for the class. A container fails to load the "
        "component, and the generated program runs without a node."
    ),
    symptoms=(
        COMPONENT_CLASS,
        COMPONENT_RESOURCE,
    ),
    wrong="RCLCPP_COMPONENTS_REGISTER_NODE(rover::Driver)",
    right="RCLCPP_COMPONENTS_REGISTER_NODE(rover::Drive)",
    frame="drive.cpp",
    beside={
        "rover.launch.py": "Node(package='rover', executable='drive_node'),",
        "package.xml": "",
        "parts/CMakeLists.txt": "",
    },
    at="CMakeLists.txt",
)

_PROGRAM_MAIN = Rule(
    "program-main",
    "code",
    NO_RUN,
    "A program has a main(), and a script calls it.",
    why=(
        "The linker stops the build with 'undefined reference to main', and no program is "
        "installed. A Python script that calls nothing ends at once, without an error."
    ),
    wrong="void talk() {}",
    right="int main() { return 0; }",
    frame="whole/talk.cpp",
    beside={
        "package.xml": "",
        "talk/CMakeLists.txt": "",
    },
    at="CMakeLists.txt",
)

_RCLCPP_INIT = Rule(
    "rclcpp-init",
    "code",
    NO_RUN,
    "A C++ program makes its nodes after rclcpp::init().",
    why=(
        "rclcpp throws an exception when the node is created without a valid context, and the "
        "program ends at its start."
    ),
    wrong="""
#include <rclcpp/rclcpp.hpp>
int main()
{
  rclcpp::spin(std::make_shared<rclcpp::Node>("talk"));
}
""",
    right="""
#include <rclcpp/rclcpp.hpp>
int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<rclcpp::Node>("talk"));
}
""",
    frame="whole/talk.cpp",
    beside={
        "package.xml": "<depend>rclcpp</depend>",
        "talk/CMakeLists.txt": "",
    },
)

_COMPONENT_CONSTRUCTOR = Rule(
    "component-constructor",
    "code",
    NO_RUN,
    "A component has a constructor that takes NodeOptions.",
    why=(
        "The registration macro creates the node from NodeOptions. The compiler finds no "
        "matching constructor, and the build stops."
    ),
    wrong="""
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>
namespace rover
{
class Drive : public rclcpp::Node
{
public:
  Drive() : Node("drive") {}
};
}
RCLCPP_COMPONENTS_REGISTER_NODE(rover::Drive)
""",
    right="""
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>
namespace rover
{
class Drive : public rclcpp::Node
{
public:
  explicit Drive(const rclcpp::NodeOptions & options) : Node("drive", options) {}
};
}
RCLCPP_COMPONENTS_REGISTER_NODE(rover::Drive)
""",
    frame="whole/drive.cpp",
    beside={
        "rover.launch.py": "Node(package='rover', executable='drive_node'),",
        "package.xml": "",
        "parts/CMakeLists.txt": "",
    },
)

# How rclcpp reads the types of values.
_CONVERSIONS = {bool: "as_bool", int: "as_int", float: "as_double", str: "as_string"}
# The rules of the faults that readers of code find.
_RULES_BY_NAME = {rule.name: rule for rule in list(globals().values()) if isinstance(rule, Rule)}


def code_facts(workspace: Workspace) -> Facts:
    """Yield what is wrong in the code of nodes."""
    for package, nodes in workspace.code.by_package.items():
        if nodes.has_more_faults:
            yield Undecided("code", f"the code of {package!r} is too long to search")
        if nodes.nodes or nodes.programs:  # a script may use rclpy without a node of its own
            yield Compared("code")
        for program in nodes.programs:
            if program.syntax:
                at = program.syntax.location
                if program.syntax.is_certain:
                    message = f"Python cannot read the file: {program.syntax.message}"
                    fixes = syntax_fixes(program.syntax.source)
                    yield Mismatch(_CODE_SYNTAX, message, at, fixes=fixes)
                else:
                    message = f"the file is not read: {program.syntax.message}"
                    yield warning(_CODE_SYNTAX, message, at)
                    yield Undecided("code", f"{at.path} is not read")
        for node in nodes.nodes:
            workspace.charge(1 + len(node.endpoints))
            yield from _invalid_names(node)
            yield from _wrong_types(workspace, node)
        for fault in nodes.faults:
            rule = _RULES_BY_NAME[fault.rule]
            at = fault.location
            related = fault.related
            yield Mismatch(rule, fault.message, at, related, fault.is_certain, fixes=fault.fixes)


_NAME_VALID = Rule(
    "name-valid",
    "code",
    NO_RUN,
    "ROS 2 accepts the names of nodes, topics, services and actions in code.",
    why=(
        "rcl refuses the name: rclpy and rclcpp raise an exception that shows the invalid "
        "character, and the node ends at its start."
    ),
    wrong="""
def __init__(self):
    super().__init__('pilot')
    self.speeds = self.create_publisher(Float64, 'wheel speed', 10)
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    self.speeds = self.create_publisher(Float64, 'wheel_speed', 10)
""",
    frame="pilot.py",
)


_DECLARED_TYPE = Rule(
    "declared-type",
    "code",
    NO_RUN,
    "C++ declares a parameter with a value or a type, and reads it as that.",
    why=(
        "declare_parameter() with a name alone does not compile since Humble. as_int() of a double "
        "throws ParameterTypeException, and the node ends."
    ),
    wrong="""
#include <rclcpp/rclcpp.hpp>
int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<rclcpp::Node>("talk");
  node->declare_parameter("speed", 0.5);
  auto speed = node->get_parameter("speed").as_int();
  rclcpp::spin(node);
}
""",
    right="""
#include <rclcpp/rclcpp.hpp>
int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<rclcpp::Node>("talk");
  node->declare_parameter("speed", 0.5);
  auto speed = node->get_parameter("speed").as_double();
  rclcpp::spin(node);
}
""",
    frame="whole/talk.cpp",
    beside={
        "package.xml": "<depend>rclcpp</depend>",
        "talk/CMakeLists.txt": "",
    },
)


def _wrong_types(workspace: Workspace, node: NodeFacts) -> Mismatches:
    """Yield the parameters that C++ declares without a type, or reads as another one."""
    is_new = not any(is_before(release, "humble") for release in workspace.releases)
    types = {}
    for parameter in node.parameters:
        if parameter.is_declared and parameter.is_plain:
            types[parameter.name] = _CONVERSIONS.get(type(parameter.default), "")
        if parameter.is_untyped and is_new:
            message = (
                f"declare_parameter() of {parameter.name!r} has neither a type nor a value, which "
                "does not compile since Humble"
            )
            is_certain = bool(workspace.releases)
            yield Mismatch(_DECLARED_TYPE, message, parameter.location, is_certain=is_certain)
    for parameter in node.parameters:
        right = types.get(parameter.name, "")
        if right and parameter.read_as in {*_CONVERSIONS.values()} - {right}:
            message = (
                f"{parameter.read_as}() throws for the parameter {parameter.name!r}: use {right}()"
            )
            wrong = Mismatch(_DECLARED_TYPE, message, parameter.location)
            yield wrong.offering(parameter.read_as, right)


def _invalid_names(node: NodeFacts) -> Mismatches:
    """Yield the names of a node, and of what it opens, that ROS 2 refuses.

    They are checked as they are written in the code, before a launch file gives others.
    """
    if node.name and not is_node_name(node.name):
        message = (
            f"the name of the node, {node.name!r}, is not valid, so it stops: use letters, digits "
            "and _"
        )
        yield Mismatch(_NAME_VALID, message, node.named_at or node.location)
    for endpoint in node.endpoints:
        reason = why_no_topic(endpoint.name) if endpoint.name else ""
        if reason and not endpoint.is_caught:
            name = f"the name {endpoint.name!r} of the {endpoint.kind}"
            message = f"{name} is not valid, so the node stops: {reason}"
            yield Mismatch(_NAME_VALID, message, endpoint.location)
