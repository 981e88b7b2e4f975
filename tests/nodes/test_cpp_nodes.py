"""The nodes in C++: what they declare and open is known, or why it is not."""

import pytest

from grader.files.tree import make_tree, overlaid
from grader.ros.nodes.cpp.cpp_nodes import read_cpp_nodes
from grader.ros.nodes.node_facts import (
    Endpoint,
    NamePart,
    NodeFacts,
    NodeParameter,
    PackageNodes,
)
from grader.ros.package.finding import read_packages
from grader.ros.python.values import Unknown

_CMAKE = """
cmake_minimum_required(VERSION 3.8)
project(hub)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
find_package(rclcpp_components REQUIRED)
add_executable(talk src/talk.cpp)
ament_target_dependencies(talk rclcpp)
install(TARGETS talk DESTINATION lib/hub)
ament_package()
"""
_HEAD = """
#include <rclcpp/rclcpp.hpp>
using namespace std::chrono_literals;
using std_msgs::msg::Float32;
using Reading = sensor_msgs::msg::LaserScan;
namespace services = std_srvs::srv;
"""
_MAIN = "int main(int argc, char ** argv) { rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Talker>()); }"


def nodes_of(text: str, cmake: str = _CMAKE, **files: str) -> PackageNodes:
    """Return the nodes of a package whose program talk has this text; other files in src by their names."""
    texts = {
        "package.xml": "<package format='3'><name>hub</name><export><build_type>ament_cmake</build_type></export></package>",
        "CMakeLists.txt": cmake,
        "src/talk.cpp": text,
        **{f"src/{name}.hpp": it for name, it in files.items()},
    }
    found = {f"ws/hub/{path}": it.encode() for path, it in texts.items()}
    [package] = read_packages(overlaid(make_tree("work", (), ()), found), "urdf/hub.urdf")
    return read_cpp_nodes(package)


def node_of(*statements: str, members: str = "", base: str = "rclcpp::Node") -> NodeFacts:
    """Return a node whose constructor has these statements."""
    body = "\n".join(statements)
    text = f'{_HEAD}class Talker : public {base} {{ public: Talker() : Node("talker") {{ {body} }} {members} }};\n{_MAIN}'
    found = nodes_of(text)
    [program] = found.programs
    [node] = program.nodes
    return node


ENDPOINTS = [
    (
        'create_publisher<Float32>("heat", 10);',
        ("publisher", "std_msgs.msg.Float32", "heat", (10, "reliable", "volatile")),
    ),
    (
        'pub_ = this->create_publisher<std_msgs::msg::Bool>("heat", rclcpp::QoS(5).best_effort().transient_local());',
        ("publisher", "std_msgs.msg.Bool", "heat", (5, "best_effort", "transient_local")),
    ),
    (
        'create_subscription<Reading>("scan", rclcpp::SensorDataQoS(), [](const Reading &) {});',
        ("subscription", "sensor_msgs.msg.LaserScan", "scan", (5, "best_effort", "volatile")),
    ),
    (
        'create_subscription<Reading>("scan", rclcpp::QoS(rclcpp::KeepLast(1)).reliability(rclcpp::ReliabilityPolicy::BestEffort), cb);',
        ("subscription", "sensor_msgs.msg.LaserScan", "scan", (1, "best_effort", "volatile")),
    ),
    (
        'create_subscription<Reading>("scan", rclcpp::QoS(1).durability(RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL), cb);',
        ("subscription", "sensor_msgs.msg.LaserScan", "scan", (1, "reliable", "transient_local")),
    ),
    (
        'rclcpp::QoS qos(3); qos.best_effort(); create_publisher<Float32>("heat", qos);',
        ("publisher", "std_msgs.msg.Float32", "heat", (3, "best_effort", "volatile")),
    ),
    (
        'create_publisher<Float32>("heat", quality());',
        ("publisher", "std_msgs.msg.Float32", "heat", (None, None, None)),
    ),
    (
        'create_publisher<Mine>("heat", 1);',
        ("publisher", None, "heat", (1, "reliable", "volatile")),
    ),
    (
        'create_service<services::Trigger>("reset", cb);',
        ("service", "std_srvs.srv.Trigger", "reset", (None, None, None)),
    ),
    (
        'create_client<std_srvs::srv::Trigger>("reset");',
        ("client", "std_srvs.srv.Trigger", "reset", (None, None, None)),
    ),
    (
        'rclcpp_action::create_client<hub::action::Count>(this, "count");',
        ("action client", "hub.action.Count", "count", (None, None, None)),
    ),
    (
        'rclcpp_action::create_server<hub::action::Count>(this, "count", a, b, c);',
        ("action server", "hub.action.Count", "count", (None, None, None)),
    ),
]


@pytest.mark.parametrize(("statement", "expected"), ENDPOINTS)
def test_endpoints(statement: str, expected: tuple[object, ...]) -> None:
    """Publishers, subscriptions, services and actions have a type, a name and a quality of service."""
    node = node_of(statement)
    [found] = node.endpoints
    assert (found.kind, found.type, found.name, tuple(found.qos)) == expected
    assert node.doubts == ()


PARTS = [
    (
        'create_publisher<Float32>(get_parameter("topic").as_string(), 1);',
        (NamePart("parameter", "topic"),),
    ),
    (
        'topic_ = declare_parameter<std::string>("topic", "a"); create_publisher<Float32>(topic_ + "/raw", 1);',
        (NamePart("parameter", "topic"), NamePart("text", "/raw")),
    ),
    (
        'get_parameter("topic", topic_); create_publisher<Float32>("/" + topic_, 1);',
        (NamePart("text", "/"), NamePart("parameter", "topic")),
    ),
    (
        'create_publisher<Float32>(std::string(get_name()) + "/raw", 1);',
        (NamePart("node name"), NamePart("text", "/raw")),
    ),
    (
        'create_publisher<Float32>("a" + other(), 1);',
        (NamePart("text", "a"), NamePart("unknown")),
    ),
]


@pytest.mark.parametrize(("statements", "expected"), PARTS)
def test_names_made_of_parts(statements: str, expected: tuple[NamePart, ...]) -> None:
    """A name that depends on the node as it is started is made of parts."""
    [found] = node_of(statements, members="std::string topic_;").endpoints
    assert (found.name, found.parts) == (None, expected)


PARAMETERS = [
    ('declare_parameter("rate", 10.0);', [("rate", 10.0, True, True)]),
    ('declare_parameter<double>("rate", 10);', [("rate", 10.0, True, True)]),
    ('declare_parameter<int>("n");', [("n", None, True, True)]),
    ('declare_parameter("n", rclcpp::PARAMETER_INTEGER);', [("n", None, True, True)]),
    ('declare_parameter("n", 3);', [("n", 3, True, True)]),
    ('declare_parameter("on", true);', [("on", True, True, True)]),
    ('declare_parameter("frame", std::string("map"));', [("frame", "map", True, True)]),
    ('declare_parameter("n", rclcpp::ParameterValue(3));', [("n", 3, True, True)]),
    ('declare_parameter("n", 3, descriptor);', [("n", 3, True, False)]),
    ('declare_parameter("v", std::vector<double>{1, 2});', [("v", [1.0, 2.0], True, True)]),
    (
        'declare_parameter<std::vector<std::string>>("v", {"a", "b"});',
        [("v", ["a", "b"], True, True)],
    ),
    (
        'declare_parameters<double>("pid", {{"p", 1}, {"i", 0.5}});',
        [("pid.p", 1.0, True, True), ("pid.i", 0.5, True, True)],
    ),
    ('get_parameter("rate");', [("rate", None, False, True)]),
]


@pytest.mark.parametrize(("statement", "expected"), PARAMETERS)
def test_parameters(statement: str, expected: list[tuple[object, ...]]) -> None:
    """A parameter has a default of the type that it is declared with."""
    found = [
        (it.name, it.default, it.is_declared, it.is_plain) for it in node_of(statement).parameters
    ]
    assert found == expected
    assert [type(it[1]) for it in found] == [type(it[1]) for it in expected]


def test_needed_parameters() -> None:
    """get_parameter() with a variable returns false for what is not declared, and does not throw."""
    statements = 'get_parameter("a"); get_parameter("b", b); has_parameter("c"); double b;'
    assert [it.is_needed for it in node_of(statements).parameters] == [True, False, False]


def test_computed_defaults() -> None:
    """A default that is computed is not known."""
    [parameter] = node_of('declare_parameter("rate", 2 * M_PI);').parameters
    assert isinstance(parameter.default, Unknown)


def test_timers() -> None:
    """A timer has its period in seconds."""
    statements = (
        "create_wall_timer(500ms, cb);",
        "create_wall_timer(std::chrono::milliseconds(20), cb);",
        "create_wall_timer(std::chrono::duration<double>(0.5), cb);",
        "create_wall_timer(period, cb);",
    )
    assert [it.period for it in node_of(*statements).timers] == [0.5, 0.02, 0.5, None]


DOUBTS = [
    ("helper(this);", "helper is given the node"),
    ("Helper helper(*this);", "Helper is given the node"),
    ("auto it = std::make_unique<Helper>(this);", "Helper is given the node"),
    ("helper_.take(std::move(shared_from_this()));", "take is given the node"),
    ("DECLARE_ALL();", "the macro DECLARE_ALL is not evaluated"),
    (
        '\n#if A\ndeclare_parameter("a", 1);\n#endif\n',
        "it depends on the preprocessor or on a template",
    ),
    (
        "options.allow_undeclared_parameters(true);",
        "allow_undeclared_parameters of its NodeOptions",
    ),
    (
        'other->create_publisher<Float32>("a", 1);',
        "the node of this create_publisher() is not known",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("statement", "reason"), DOUBTS)
def test_doubts(statement: str, reason: str) -> None:
    """What may declare or open more leaves a node open."""
    assert [doubt.reason for doubt in node_of(statement).doubts] == [reason]


HARMLESS = [
    "timer_ = create_wall_timer(1s, std::bind(&Talker::on, this));",
    "listener_ = std::make_shared<tf2_ros::TransformListener>(*buffer_, this);",
    "broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>(*this);",
    'RCLCPP_INFO(this->get_logger(), "a");',
    "auto on = [this](int) { count_++; };",
]


@pytest.mark.parametrize("statement", HARMLESS)
def test_without_doubts(statement: str) -> None:
    """What nodes usually do with themselves leaves nothing open."""
    assert node_of(statement).doubts == ()


def test_other_bases() -> None:
    """A second base class leaves open what the node does."""
    node = node_of(base="rclcpp::Node, public Mine")
    assert [doubt.reason for doubt in node.doubts] == ["what another base class does is not added"]
    assert node_of(base="rclcpp::Node, public std::enable_shared_from_this<Talker>").doubts == ()


NAMES = [
    ('class Talker : public rclcpp::Node { public: Talker() : Node("a") {} };', "Talker>()", "a"),
    ('class Talker : public rclcpp::Node { public: Talker() : rclcpp::Node{"a"} {} };', "Talker>()", "a"),
    ("class Talker : public rclcpp::Node { public: Talker(std::string n) : Node(n) {} };", 'Talker>("a")', "a"),
    ('class Talker : public rclcpp::Node { public: Talker(const std::string & n = "a") : Node(n) {} };', "Talker>()", "a"),
    ('class Talker : public rclcpp::Node { public: Talker(); }; Talker::Talker() : Node("a") {}', "Talker>()", "a"),
    ('using Base = rclcpp::Node; class Talker : public Base { public: Talker() : Base("a") {} };', "Talker>()", "a"),
    ('class Talker : public rclcpp::Node { public: Talker() : Node("a") {} Talker(int) : Node("b") {} };', "Talker>()", None),
    ('class Talker : public rclcpp_lifecycle::LifecycleNode { public: Talker() : LifecycleNode("a") {} };', "Talker>()", "a"),
    ("", 'rclcpp::Node>("a")', "a"),
    ("", "rclcpp::Node>(name())", None),
]  # fmt: skip


@pytest.mark.parametrize(("text", "made", "name"), NAMES)
def test_names_of_nodes(text: str, made: str, name: str | None) -> None:
    """A node has the name that its constructor gives, also where that is an argument."""
    [program] = nodes_of(f"{text} int main() {{ rclcpp::spin(std::make_shared<{made}); }}").programs
    assert [node.name for node in program.nodes] == [name]


def test_objects_of_nodes() -> None:
    """The methods of a node that is a local variable are its own; what is given it leaves it open."""
    text = 'int main() { auto node = rclcpp::Node::make_shared("a"); node->create_publisher<std_msgs::msg::Bool>("b", 1); '
    [program] = nodes_of(f"{text} rclcpp::spin(node); }}").programs
    [node] = program.nodes
    assert ([it.name for it in node.endpoints], node.doubts) == (["b"], ())
    [program] = nodes_of(f"{text} Helper helper(node); }}").programs
    assert [it.reason for it in program.nodes[0].doubts] == ["Helper is given the node"]


def test_errors_that_are_caught() -> None:
    """What is opened in a try block may be refused without stopping the node."""
    opened = 'create_publisher<Float32>("{}", 1);'
    node = node_of(f"try {{ {opened.format('a')} }} catch (...) {{ }}", opened.format("b"))
    assert [(it.name, it.is_caught) for it in node.endpoints] == [("a", True), ("b", False)]


def test_headers_of_the_package() -> None:
    """A class in a header of the package is read with the file that includes it."""
    header = 'class Talker : public rclcpp::Node { public: Talker() : Node("a") {} };'
    [program] = nodes_of(f'#include "talker.hpp"\n{_MAIN}', talker=header).programs
    assert [node.name for node in program.nodes] == ["a"]


def test_components() -> None:
    """A program of a component has the node of its class; a library alone is no program."""
    cmake = _CMAKE.replace(
        "add_executable(talk",
        'add_library(part SHARED src/part.cpp)\nrclcpp_components_register_node(part PLUGIN "hub::Part" EXECUTABLE part_node)\nadd_executable(talk',
    )
    text = 'namespace hub { class Part : public rclcpp::Node { public: explicit Part(const rclcpp::NodeOptions & options) : Node("part", options) {} }; }'
    cmake = cmake.replace("src/part.cpp", "src/part.hpp src/talk.cpp")
    found = nodes_of(f'#include "part.hpp"\n{_HEAD}', cmake, part=text)
    programs = {it.name: [node.name for node in it.nodes] for it in found.programs}
    assert programs == {"part_node": ["part"], "talk": []}


def test_unread_files() -> None:
    """A file that is broken leaves its nodes open; a package without C++ has none."""
    found = nodes_of(
        f'{_HEAD}class Talker : public rclcpp::Node {{ Talker() : Node("a") {{ }} ) }}; {_MAIN}'
    )
    assert "C++ is not read as a whole: this is no C++ that is known" in {
        it.reason for it in found.doubts
    }
    assert nodes_of("", _CMAKE.replace("src/talk.cpp", "src/none.cpp")) == PackageNodes((), (), ())


def test_places() -> None:
    """What is found has the place where it is written."""
    node = node_of('declare_parameter("a", 1);', 'create_publisher<Float32>("b", 1);')
    [parameter], [endpoint] = node.parameters, node.endpoints
    assert isinstance(parameter, NodeParameter)
    assert isinstance(endpoint, Endpoint)
    assert parameter.location.file_and_line == "ws/hub/src/talk.cpp:7"
    assert endpoint.location.file_and_line == "ws/hub/src/talk.cpp:8"
