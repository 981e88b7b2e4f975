"""The nodes that C++ code gives others: what a helper, a member or a function opens is the node's."""

import pytest

from tests.nodes.test_cpp_nodes import _HEAD, nodes_of

_BOOL = "std_msgs::msg::Bool"
_OPEN = f'create_publisher<{_BOOL}>("heat", 1);'
_SPIN = "int main(int argc, char ** argv) { rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Talker>()); }"


def _talker(statement: str, members: str = "") -> str:
    return f'class Talker : public rclcpp::Node {{ public: Talker() : Node("talker") {{ {statement} }} {members} }};'


def _helper(parameter: str, initializer: str, member: str, receiver: str = "node_->") -> str:
    return f"class Helper {{ public: explicit Helper({parameter}) {initializer} {{ {receiver}{_OPEN} }} {member} }};"


# A helper class or function before the node, and what the node does with it.
HELPERS = [
    (_helper("rclcpp::Node * node", ": node_(node)", "rclcpp::Node * node_;"), "helper_ = std::make_unique<Helper>(this);"),
    (_helper("rclcpp::Node & node", ": node_(node)", "rclcpp::Node & node_;", "node_."), "Helper helper(*this);"),
    (_helper("rclcpp::Node & node", ": node_{node}", "rclcpp::Node & node_;", "this->node_."), "Helper helper{*this};"),
    (_helper("rclcpp::Node::SharedPtr node", "", "rclcpp::Node::SharedPtr node_;", "node_ = node; node_->"), "new Helper(shared_from_this());"),
    (_helper("std::shared_ptr<rclcpp::Node> node", ": node_(std::move(node))", "std::weak_ptr<rclcpp::Node> node_;", "node_.lock()->"), "auto self = shared_from_this(); auto helper = std::make_shared<Helper>(std::move(self));"),
    (_helper("Talker * node", ": node_(node)", "Talker * node_;").replace("class Helper", "class Talker; class Helper"), "helpers_.emplace_back(std::make_shared<Helper>(this));"),
    ("class Base { protected: rclcpp::Node * node_; }; class Helper : public Base { public: Helper(rclcpp::Node * node) { node_ = node; node_->" + _OPEN + " } };", "Helper helper(this);"),
    ("class Base { public: Base(rclcpp::Node * node) : node_(node) {} rclcpp::Node * node_; }; class Helper : public Base { public: Helper(rclcpp::Node * node) : Base(node) { node_->" + _OPEN + " } };", "Helper helper(this);"),
    ("void help(rclcpp::Node & node) { node." + _OPEN + " }", "help(*this);"),
    ("void help(const rclcpp::Node::SharedPtr & node) { auto & same = node; same->" + _OPEN + " }", "help(this->shared_from_this());"),
    ("template<typename NodeT> void help(NodeT & node) { node." + _OPEN + " }", "help(*this);"),
    ("class Helper { public: void init(rclcpp::Node * node) { node->" + _OPEN + " } };", "helper_.init(this);"),
    ("rclcpp::Node * shared_node; void help() { shared_node->" + _OPEN + " }", "shared_node = this; help();"),
    ("template<typename NodeT> class Helper { public: Helper(NodeT * node) : node_(node) { node_->template " + _OPEN + " } NodeT * node_; };", "helper_ = std::make_unique<Helper<rclcpp::Node>>(this);"),
]  # fmt: skip


@pytest.mark.parametrize(("helper", "statement"), HELPERS)
def test_what_helpers_open(helper: str, statement: str) -> None:
    """What a helper opens with the node that it is given is the node's, and nothing is open."""
    [program] = nodes_of(f"{_HEAD}{helper}\n{_talker(statement)}\n{_SPIN}").programs
    [node] = program.nodes
    reasons = [doubt.reason for doubt in node.doubts if "template" not in doubt.reason]
    assert ([endpoint.name for endpoint in node.endpoints], reasons) == (["heat"], [])


def test_members_of_the_node() -> None:
    """A member that its own class initializes with the node is a helper, too."""
    helper = _helper("rclcpp::Node & node", ": node_(node)", "rclcpp::Node & node_;", "node_.")
    text = f'{_HEAD}{helper} class Talker : public rclcpp::Node {{ public: Talker() : Node("a"), helper_(*this) {{}} Helper helper_; }}; {_SPIN}'
    [program] = nodes_of(text).programs
    assert [endpoint.name for endpoint in program.nodes[0].endpoints] == ["heat"]
    assert program.nodes[0].doubts == ()


# What a helper or a node does, and why the node is open.
OPEN = [
    ("class Helper { public: Helper(int node, rclcpp::Node * other) {} };", "Helper helper(this);", "Helper is given the node"),
    ("class Helper { public: Helper(rclcpp::Node * node) {} Helper(Talker * node) {} };", "Helper helper(this);", "Helper is given the node"),
    ("class Helper { public: Helper(rclcpp::Node * node) { other(node); } };", "Helper helper(this);", "other is given the node"),
    ("class Helper { public: Helper(int node) {} };", "Helper helper(this);", "Helper is given the node"),
    ("void help(rclcpp::Node::SharedPtr node) { DDS writer(node); }", "help(shared_from_this());", "DDS is given the node"),
    ('void help(rclcpp::Node * node) { image_transport::create_publisher(node, "a"); }', "help(this);", "what image_transport::create_publisher() opens is not evaluated"),
]  # fmt: skip


@pytest.mark.parametrize(("helper", "statement", "reason"), OPEN)
def test_what_helpers_leave_open(helper: str, statement: str, reason: str) -> None:
    """What is given the node in turn leaves it open."""
    text = f"{_HEAD}class Talker;\n{helper}\n{_talker(statement)}\n{_SPIN}"
    [program] = nodes_of(text).programs
    assert [doubt.reason for doubt in program.nodes[0].doubts] == [reason]


HELD = [
    'class Talker { public: Talker() { node_ = rclcpp::Node::make_shared("talker"); node_->%s } rclcpp::Node::SharedPtr node_; };',
    'class Talker { public: Talker() : node_(std::make_shared<rclcpp::Node>("talker")) { node_->%s } rclcpp::Node::SharedPtr node_; };',
    'class Talker { public: Talker() : node_(std::make_shared<rclcpp::Node>("talker")) { get_node()->%s } rclcpp::Node::SharedPtr get_node() { return node_; } rclcpp::Node::SharedPtr node_; };',
    'rclcpp::Node::SharedPtr node; void open() { node->%s } class Talker { public: Talker() { node = std::make_shared<rclcpp::Node>("talker"); open(); } };',
]  # fmt: skip


@pytest.mark.parametrize("text", HELD)
def test_nodes_that_are_held(text: str) -> None:
    """A node that is a member, or a variable of a namespace, has what is opened with it."""
    main = "int main() { Talker talker; rclcpp::spin(talker.node_); }"
    [program] = nodes_of(f"{_HEAD}{text % _OPEN}\n{main}").programs
    [node] = program.nodes
    assert (node.name, [endpoint.name for endpoint in node.endpoints]) == ("talker", ["heat"])
    assert node.doubts == ()


STRANGERS = [
    "class Part : public controller_interface::ControllerInterface { void on() { get_node()->%s } };",
    "class Part : public controller_interface::ControllerInterface { void on() { this->get_node()->%s } };",
    "class Part : public nav2_core::Behavior { void on() { auto node = node_.lock(); node->%s } };",
    "class Part : public BT::Action { void on() { node_->%s } rclcpp::Node::SharedPtr node_; };",
    "class Part : public BT::Action { void on() { node_->%s } nav2::LifecycleNode::SharedPtr node_; };",
    "class Part : public other::Base { void on() { %s } };",
]  # fmt: skip


@pytest.mark.parametrize("text", STRANGERS)
def test_nodes_of_other_programs(text: str) -> None:
    """The node that a plugin gets is known by its class, and leaves other nodes as they are."""
    nodes = nodes_of(f"{_HEAD}{text % _OPEN}\n{_talker('')}\n{_SPIN}")
    [talker, part] = nodes.nodes
    assert (part.class_name, [endpoint.name for endpoint in part.endpoints]) == ("Part", ["heat"])
    assert [doubt.reason for doubt in part.doubts] == ["its node is one of another program"]
    assert talker.doubts == ()


LOOSE = [
    "class Part { void on(rclcpp::Node * node) { node->%s } };",
    "class Part { void on() { unknown->%s } };",
    "class Part { void on() { std::make_shared<Unknown>()->%s } };",
    "void on() { auto a = 1; { auto a = 2; a->%s } }",
    "class Part : public std::exception { void on() { get_node()->%s } };",
]  # fmt: skip


@pytest.mark.parametrize("text", LOOSE)
def test_loose_calls(text: str) -> None:
    """A call of a node that is not known may be one of each node of the program."""
    nodes = nodes_of(f"{_HEAD}{text % _OPEN}\n{_talker('')}\n{_SPIN}")
    [talker] = nodes.nodes
    reason = "the node of this create_publisher() is not known"
    assert [doubt.reason for doubt in talker.doubts] == [reason]


def test_variables_that_change() -> None:
    """A variable that gets another node holds both; an action takes the interfaces of a node."""
    actions = (
        'rclcpp_action::create_client<turtlesim::action::RotateAbsolute>(this, "a"); '
        "rclcpp_action::create_server<turtlesim::action::RotateAbsolute>(get_node_base_interface(), "
        'get_node_clock_interface(), get_node_logging_interface(), get_node_waitables_interface(), "b");'
    )
    text = f'int main() {{ auto node = rclcpp::Node::make_shared("a"); node = rclcpp::Node::make_shared("b"); node->{_OPEN} }}'
    nodes = nodes_of(f"{_HEAD}{_talker(actions)}\n{text}").nodes
    names = {node.name: [endpoint.name for endpoint in node.endpoints] for node in nodes}
    assert names == {"talker": ["a", "b"], "a": ["heat"], "b": ["heat"]}


def test_base_nodes() -> None:
    """A node has what the constructor of its own base class opens."""
    base = f"class Base : public rclcpp::Node {{ public: Base(std::string n) : Node(n) {{ {_OPEN} }} }};"
    text = f'{_HEAD}{base} class Talker : public Base {{ public: Talker() : Base("talker") {{}} }}; {_SPIN}'
    [program] = nodes_of(text).programs
    assert [endpoint.name for endpoint in program.nodes[0].endpoints] == ["heat"]
    assert program.nodes[0].doubts == ()


NAMES = [
    ('Talker(std::string t) : Node("a") { open(t); }', 'Talker>("heat")', ["heat"]),
    ('Talker(std::string t = "heat") : Node("a") { open(t + "/a"); }', "Talker>()", ["heat/a"]),
    ('Talker(std::string t) : Node("a"), t_(t) { open(t_); } std::string t_;', 'Talker>("heat")', ["heat"]),
    ('Talker(std::string t) : Node("a") { open(t); }', 'Talker>("a")); rclcpp::spin(std::make_shared<Talker>("b")', [None]),
    ('Talker() : Node("a") { both("a"); both("b"); } void both(std::string t) { open(t); }', "Talker>()", ["a", "b"]),
    ('Talker() : Node("a") { both("a"); } void both(std::string t, int) { open(t); }', "Talker>()", [None]),
    ('Talker() : Node("a") { both("a"); } void both(std::string t) { open(t); } void both(int t) {}', "Talker>()", [None]),
    ('Talker() : Node("a") { both("a", 1); } void both(std::string t, int) { open(t); }', "Talker>()", [None]),
    ('Talker() : Node("a") { one("a"); } void one(std::string t) { two(t); } void two(std::string t) { open(t); }', "Talker>()", ["a"]),
    ('Talker() : Node("a") { } void both(std::string t) { open(t); }', "Talker>()", [None]),
]  # fmt: skip


@pytest.mark.parametrize(("members", "made", "names"), NAMES)
def test_names_that_are_given(members: str, made: str, names: list[str | None]) -> None:
    """A name that a constructor or a method is given is known where all calls of it are."""
    opened = members
    for argument in ("t_", 't + "/a"', "t"):
        opened = opened.replace(f"open({argument});", f"create_publisher<{_BOOL}>({argument}, 1);")
    text = f"{_HEAD}class Talker : public rclcpp::Node {{ public: {opened} }}; int main() {{ rclcpp::spin(std::make_shared<{made}); }}"
    node = nodes_of(text).nodes[0]
    assert [endpoint.name for endpoint in node.endpoints] == names


def test_names_of_helpers() -> None:
    """A helper that is made twice opens both of its topics; one that an object declares counts."""
    helper = f"class Helper {{ public: Helper(rclcpp::Node * node, std::string t) {{ node->create_publisher<{_BOOL}>(t, 1); }} }};"
    body = 'Helper one(this, "a"); Helper two{this, "b"}; '
    talker = f'class Talker : public rclcpp::Node {{ public: Talker() : Node("a"), three_(this, "c") {{ {body} }} Helper three_; }};'
    [program] = nodes_of(f"{_HEAD}{helper}{talker}{_SPIN}").programs
    assert [endpoint.name for endpoint in program.nodes[0].endpoints] == ["a", "b", "c"]
    assert program.nodes[0].doubts == ()


def test_headers_in_other_folders() -> None:
    """A header in a folder `include` anywhere in the package is read, if only one has its name."""
    header = _talker(_OPEN)
    files = {"part/include/hub/talker": header}
    [program] = nodes_of(f"{_HEAD}#include <hub/talker.hpp>\n{_SPIN}", **files).programs
    assert [endpoint.name for endpoint in program.nodes[0].endpoints] == ["heat"]


def test_the_code_of_a_base_class_makes_no_node() -> None:
    """The sources of rclcpp_lifecycle themselves define a class of nodes."""
    text = (
        "namespace rclcpp_lifecycle { class LifecycleNode : public Base { void start(); };"
        f' void LifecycleNode::start() {{ rclcpp::create_publisher<{_BOOL}>(*this, "a", 1); }} }}'
    )
    [talker] = nodes_of(f"{_HEAD}{text}\n{_talker('')}\n{_SPIN}").nodes
    assert talker.class_name == "Talker"


@pytest.mark.parametrize(
    ("constructor", "member"),
    [
        ("", "diagnostic_updater::Updater updater_{this};"),
        ("updater_ = std::make_unique<diagnostic_updater::Updater>(this);", "std::unique_ptr<diagnostic_updater::Updater> updater_;"),
        ("diagnostic_updater::Updater updater_(this);", ""),
    ],
)  # fmt: skip
def test_an_updater_of_diagnostics(constructor: str, member: str) -> None:
    """It publishes for the node that it is given, has two parameters, and opens nothing else."""
    arrow = "->" if "unique" in member else "."
    add = f'updater_{arrow}add("a", this, &Talker::check);' if member else ""
    initializer = ", updater_(this)" if "{" in member else ""
    declared = member.replace("{this}", "")
    text = (
        f'{_HEAD}#include "diagnostic_updater/diagnostic_updater.hpp"\n'
        f'class Talker : public rclcpp::Node {{ public: Talker() : Node("talker"){initializer} '
        f"{{ {constructor} {add} }} {declared} }}; {_SPIN}"
    )
    [program] = nodes_of(text).programs
    [node] = program.nodes
    [end] = node.endpoints
    assert (end.kind, end.name, node.doubts) == ("publisher", "/diagnostics", ())
    assert [parameter.name for parameter in node.parameters] == [
        "diagnostic_updater.period",
        "diagnostic_updater.use_fqn",
    ]


def test_another_updater_leaves_the_node_open() -> None:
    """A class of the same name may open anything."""
    text = f"{_HEAD}{_talker('updater_.add(this);', 'own::Updater updater_;')} {_SPIN}"
    [program] = nodes_of(text).programs
    assert [doubt.reason for doubt in program.nodes[0].doubts] == ["add is given the node"]
