"""What keeps nodes in C++ from doing anything is found, and nothing else."""

import pytest

from grader.ros.nodes.node_facts import CodeFault
from tests.nodes.test_cpp_nodes import nodes_of

pytestmark = pytest.mark.slow

_MAIN = "int main(int argc, char ** argv) {{ rclcpp::init(argc, argv); {} }}"
_SPIN = _MAIN.format("rclcpp::spin(std::make_shared<Talker>());")


def faults_of(constructor: str, members: str = "", main: str = _SPIN) -> list[CodeFault]:
    """Return the faults of a node whose constructor has these statements."""
    text = f"""
#include <rclcpp/rclcpp.hpp>
class Talker : public rclcpp::Node {{
public:
  Talker() : Node("talker") {{ {constructor} }}
  {members}
}};
{main}"""
    return list(nodes_of(text).faults)


_ON = "void on() {}"
_SUBSCRIPTION = (
    'create_subscription<std_msgs::msg::Bool>("a", 1, [](const std_msgs::msg::Bool &) {});'
)
DESTROYED = [
    ("auto timer = create_wall_timer(1s, [this]() { on(); });", "nothing keeps this timer: it is destroyed when Talker() ends"),
    ("rclcpp::TimerBase::SharedPtr timer = this->create_wall_timer(1s, cb);", "nothing keeps this timer: it is destroyed when Talker() ends"),
    ("create_wall_timer(1s, cb);", "nothing keeps this timer: it is destroyed when Talker() ends"),
    (f"auto subscription = {_SUBSCRIPTION}", "nothing keeps this subscription: it is destroyed when Talker() ends"),
    (_SUBSCRIPTION, "nothing keeps this subscription: it is destroyed when Talker() ends"),
    ('auto it = create_service<std_srvs::srv::Trigger>("a", cb);', "nothing keeps this service: it is destroyed when Talker() ends"),
    ('rclcpp_action::create_server<a::action::B>(this, "a", b, c, d);', "nothing keeps this action server: it is destroyed when Talker() ends"),
    ("tf2_ros::TransformListener listener(buffer_);", "nothing keeps this TransformListener: the buffer stays empty"),
    ("tf2_ros::TransformListener listener{buffer_};", "nothing keeps this TransformListener: the buffer stays empty"),
    ("auto listener = std::make_shared<tf2_ros::TransformListener>(*buffer_);", "nothing keeps this TransformListener: the buffer stays empty"),
]  # fmt: skip
KEPT = [
    "timer_ = create_wall_timer(1s, cb);",
    "auto timer = create_wall_timer(1s, cb); timer_ = timer;",
    "auto timer = create_wall_timer(1s, cb); timers_.push_back(timer);",
    "timers_.push_back(create_wall_timer(1s, cb));",
    "static auto timer = create_wall_timer(1s, cb);",
    "auto timer = create_wall_timer(1s, cb); while (rclcpp::ok()) { rclcpp::spin_some(node); }",
    "auto timer = create_wall_timer(1s, cb); rclcpp::spin(node);",
    "auto timer = create_wall_timer(1s, [timer]() {});",
    "\n#if A\nauto timer = create_wall_timer(1s, cb);\n#endif\n",
    'create_publisher<std_msgs::msg::Bool>("a", 1);',
    "tf2_ros::TransformListener & listener = other_;",
]


@pytest.mark.parametrize(("statement", "message"), DESTROYED)
def test_what_nothing_keeps(statement: str, message: str) -> None:
    """What a constructor makes and nothing keeps is destroyed with it."""
    faults = [fault for fault in faults_of(statement, _ON) if fault.rule != "goal-state"]
    [fault] = faults
    assert (fault.rule, fault.message, fault.is_certain) == ("entity-kept", message, True)


@pytest.mark.parametrize("statement", KEPT)
def test_what_is_kept(statement: str) -> None:
    """A member, a list or a copy keeps it, and a function that waits."""
    assert faults_of(statement, _ON) == []


_LOOK = 'void on() { buffer_->lookupTransform("a", "b", tf2::TimePointZero); }'
_BUFFER = "std::unique_ptr<tf2_ros::Buffer> buffer_;"
_POINTER = "std::shared_ptr<tf2_ros::TransformListener> listener_;"
_MAKE = "timer_ = create_wall_timer(1s, [this]() { on(); }); buffer_ = std::make_unique<tf2_ros::Buffer>(get_clock());"


@pytest.mark.parametrize("members", ["", _POINTER])
def test_a_buffer_without_listener(members: str) -> None:
    """A buffer that no listener fills is empty."""
    [fault] = faults_of(_MAKE, f"{_LOOK} {_BUFFER} {members}")
    assert (fault.rule, fault.message) == (
        "buffer-listener",
        "the buffer stays empty: nothing makes a TransformListener",
    )


FILLED = [
    ("listener_ = std::make_shared<tf2_ros::TransformListener>(*buffer_);", _POINTER),
    ("listener_.reset(new tf2_ros::TransformListener(*buffer_));", _POINTER),
    ("", "tf2_ros::TransformListener listener_{*buffer_};"),
    ("", "using Listener = tf2_ros::TransformListener; std::shared_ptr<Listener> listener_;"),
    ("fill(*buffer_);", _POINTER),
    ("buffer_->setTransform(t, name);", _POINTER),
]


@pytest.mark.parametrize(("statement", "members"), FILLED)
def test_a_buffer_that_is_filled(statement: str, members: str) -> None:
    """A listener of any kind, or another function, may fill the buffer."""
    assert faults_of(_MAKE + statement, f"{_LOOK} {_BUFFER} {members}") == []


_ZEROS = "t.transform.rotation.x = 0; t.transform.rotation.y = 0.0; t.transform.rotation.z = 0.0f; "
_SENT = "geometry_msgs::msg::TransformStamped t; {} t.transform.rotation.w = {}; t.header.stamp = now(); {} sender_->sendTransform(t);"


def test_a_rotation_of_zeros() -> None:
    """Four zeros are no rotation."""
    [fault] = faults_of(_SENT.format(_ZEROS, "0.0", ""))
    assert (fault.rule, fault.message) == (
        "rotation-set",
        "the rotation 0 0 0 0 turns nothing: tf2 ignores the transform",
    )


ROTATIONS = [
    _SENT.format(_ZEROS, "1.0", ""),
    _SENT.format(_ZEROS, "0.0", "fill(t);"),
    _SENT.format(_ZEROS, "0.0", "t.transform.rotation = tf2::toMsg(q);"),
    _SENT.format(_ZEROS, "0.0", "t.transform.rotation.w = 1.0;"),
    _SENT.format(_ZEROS, "0.0", "fill(t.transform.rotation);"),
    _SENT.format("", "0.0", ""),
    _SENT.format(_ZEROS, "0.0", "").replace("sendTransform", "publish"),
]


@pytest.mark.parametrize("statements", ROTATIONS)
def test_rotations_that_may_be_right(statements: str) -> None:
    """Another number, another function, or what is published and not sent to tf2."""
    assert faults_of(statements) == []


def test_nothing_spins() -> None:
    """A node with callbacks that nothing spins does nothing."""
    main = _MAIN.format("auto node = std::make_shared<Talker>(); rclcpp::shutdown();")
    [fault] = faults_of("timer_ = create_wall_timer(1s, cb);", main=main)
    assert (fault.rule, fault.message) == (
        "node-spins",
        "nothing spins the node: its callbacks are never called",
    )
    assert faults_of('create_publisher<std_msgs::msg::Bool>("a", 1);', main=main) == []


SPINNING = [
    "rclcpp::spin(std::make_shared<Talker>());",
    "auto node = std::make_shared<Talker>(); rclcpp::executors::SingleThreadedExecutor it; it.add_node(node); it.spin();",
    "auto node = std::make_shared<Talker>(); rclcpp::WaitSet set;",
    "auto node = std::make_shared<Talker>(); Library library(node);",
    "run();",
]


@pytest.mark.parametrize("statements", SPINNING)
def test_what_may_spin(statements: str) -> None:
    """An executor, a set of waiting, and what is given the node may spin it."""
    assert faults_of("timer_ = create_wall_timer(1s, cb);", main=_MAIN.format(statements)) == []


_WAIT = "void on() {{ auto future = client_->async_send_request(request); {} }}"
_TIMER = "timer_ = create_wall_timer(1s, std::bind(&Talker::on, this));"
WAITING = [
    "future.wait();",
    "auto response = future.get();",
    "rclcpp::spin_until_future_complete(shared_from_this(), future);",
    "rclcpp::spin_until_future_complete(this->get_node_base_interface(), future);",
]


@pytest.mark.parametrize("statement", WAITING)
def test_waiting_in_a_callback(statement: str) -> None:
    """A callback cannot receive the response that it waits for."""
    [fault] = faults_of(_TIMER, _WAIT.format(statement))
    assert fault.rule == "callback-wait"


NOT_WAITING = [
    ("", _TIMER),
    ("future.wait_for(1s);", _TIMER),
    ("rclcpp::spin_until_future_complete(other_node_, future);", _TIMER),
    ("future.wait();", "on();"),
    ("future.wait();", f"group_ = create_callback_group(a); {_TIMER}"),
    ("future.wait();", "thread_ = std::thread(std::bind(&Talker::on, this));"),
]


@pytest.mark.parametrize(("statement", "constructor"), NOT_WAITING)
def test_waiting_elsewhere(statement: str, constructor: str) -> None:
    """Outside of callbacks, for a while, or with other threads a node may wait."""
    assert faults_of(constructor, _WAIT.format(statement)) == []


_COMPONENT = 'rclcpp_components_register_node(talk PLUGIN "hub::Talker" EXECUTABLE talker)'
_OTHER = 'rclcpp_components_register_nodes(talk "hub::Talker")'
_REGISTERED = "RCLCPP_COMPONENTS_REGISTER_NODE({})"


def _registered(text: str, command: str = _COMPONENT) -> list[tuple[str, bool]]:
    cmake = (
        "project(hub)\nfind_package(ament_cmake REQUIRED)\nfind_package(rclcpp_components REQUIRED)\n"
        f"add_library(talk SHARED src/talk.cpp)\n{command}\nament_package()\n"
    )
    return [(fault.message, fault.is_certain) for fault in nodes_of(text, cmake).faults]


def test_components_that_no_source_registers() -> None:
    """The program of a component stops, and a container cannot load it."""
    message = "no source registers the component 'hub::Talker'"
    assert _registered("int a;") == [(message, True)]
    assert _registered("int a;", _OTHER) == [(message, True)]
    meant = f"{message}; did you mean 'hub::Talkr'?"
    assert _registered(_REGISTERED.format("hub::Talkr")) == [(meant, True)]
    assert _registered(f"// {_REGISTERED.format('hub::Talker')}") == [(message, True)]


REGISTERED = [
    _REGISTERED.format("hub::Talker"),
    f"#include <a.hpp>\n{_REGISTERED.format(' hub::Talker ')}\n",
    f"#if A\n{_REGISTERED.format('hub::Talker')}\n#endif\n",
    "CLASS_LOADER_REGISTER_CLASS(rclcpp_components::NodeFactoryTemplate<hub::Talker>, rclcpp_components::NodeFactory)",
]


@pytest.mark.parametrize("text", REGISTERED)
def test_components_that_a_source_may_register(text: str) -> None:
    """Also under a condition, or by the macro of class_loader."""
    assert _registered(text) == []


@pytest.mark.parametrize(
    ("statement", "is_lost"),
    [
        ("add_on_set_parameters_callback(cb);", True),
        ("auto handle = add_on_set_parameters_callback(cb);", True),
        ("handle_ = this->add_on_set_parameters_callback(cb);", False),
        ("handles_.push_back(add_post_set_parameters_callback(cb));", False),
    ],
)
def test_handles_of_callbacks(statement: str, is_lost: bool) -> None:
    """A callback of parameters runs as long as its handle is kept."""
    messages = [fault.message for fault in faults_of(statement)]
    lost = "nothing keeps this handle of a callback: it is destroyed when Talker() ends"
    assert (lost in messages) == is_lost


_SERVE = 'server_ = {}create_server<a::action::B>(this, "a", b, c, d);'


@pytest.mark.parametrize(
    ("library", "members", "is_ended"),
    [
        ("rclcpp_action::", "void run(Handle goal) { goal->canceled(result); }", False),
        ("rclcpp_action::", "void run(Handle goal) { goal->succeed(result); }", True),
        ("rclcpp_action::", "void run(Handle goal) { goal->abort(result); }", False),
        ("other::", "void run(Handle goal) {}", True),
    ],
)
def test_goals_without_a_state(library: str, members: str, *, is_ended: bool) -> None:
    """A goal that nothing ends, or that never succeeds, is cancelled with its handle."""
    faults = [
        (fault.rule, fault.is_certain) for fault in faults_of(_SERVE.format(library), members)
    ]
    assert faults == ([] if is_ended else [("goal-state", False)])


@pytest.mark.parametrize(
    ("asks", "is_read"),
    [("goal->is_canceling()", True), ("goal->is_active()", False)],
)
def test_accepted_cancel_requests(asks: str, *, is_read: bool) -> None:
    """A server that accepts cancel requests asks for them while it executes a goal."""
    members = f"""
    Answer cancel() {{ return rclcpp_action::CancelResponse::ACCEPT; }}
    void run(Handle goal) {{ if ({asks}) {{ goal->canceled(); }} goal->succeed(); }}
    """
    messages = [fault.message for fault in faults_of(_SERVE.format("rclcpp_action::"), members)]
    unread = "cancel requests are accepted but ignored: check is_canceling()"
    assert messages == ([] if is_read else [unread])


@pytest.mark.parametrize(
    ("library", "answers", "is_wrong"),
    [
        ("rclcpp_action::", "return rclcpp_action::GoalResponse::REJECT;", True),
        ("rclcpp_action::", "return ok ? Answer::ACCEPT_AND_DEFER : Answer::REJECT;", False),
        ("rclcpp_action::", "return decided(order);", False),
        ("rclcpp_action::", "return rclcpp_action::CancelResponse::REJECT;", False),
        ("other::", "return GoalResponse::REJECT;", False),
    ],
)
def test_servers_that_reject_each_goal(library: str, answers: str, *, is_wrong: bool) -> None:
    """A server executes no goal where nothing is accepted."""
    members = f"int answer(int order) {{ {answers} }} void run(Handle goal) {{ goal->succeed(); }}"
    faults = [(each.rule, each.is_certain) for each in faults_of(_SERVE.format(library), members)]
    assert faults == ([("goal-state", False)] if is_wrong else [])


_ACTIVE = """
#include <rclcpp_lifecycle/lifecycle_node.hpp>
class Talker : public {} {{
public:
  Talker() : LifecycleNode("talker") {{ {} }}
  CallbackReturn on_activate(const rclcpp_lifecycle::State & state) override {{ {} }}
  {}
}};
"""
_PUBLISHER = 'publisher_ = create_publisher<std_msgs::msg::Bool>("a", 1);'


@pytest.mark.parametrize(
    ("base", "made", "active", "members", "is_active"),
    [
        ("rclcpp_lifecycle::LifecycleNode", _PUBLISHER, "go();", "", False),
        ("rclcpp_lifecycle::LifecycleNode", "", "go();", "", True),
        ("rclcpp_lifecycle::LifecycleNode", "", "go();", f"void on() {{ {_PUBLISHER} }}", False),
        ("rclcpp_lifecycle::LifecycleNode", _PUBLISHER, "publisher_->on_activate();", "", True),
        ("rclcpp_lifecycle::LifecycleNode", _PUBLISHER, "LifecycleNode::on_activate(state);", "", True),
        ("nav2_util::LifecycleNode", _PUBLISHER, "go();", "", True),
        ("rclcpp_lifecycle::LifecycleNode", _PUBLISHER, "", "void at() { publisher_->on_activate(); }", True),
    ],
)  # fmt: skip
def test_publishers_that_stay_inactive(
    base: str, made: str, active: str, members: str, *, is_active: bool
) -> None:
    """Each publisher of a node with a lifecycle is activated, with the node or on its own."""
    faults = list(nodes_of(_ACTIVE.format(base, made, active, members)).faults)
    rules = [
        (fault.rule, fault.is_certain) for fault in faults if fault.rule == "publisher-activated"
    ]
    assert rules == ([] if is_active else [("publisher-activated", True)])


_ACTION = """
#include <rclcpp/rclcpp.hpp>
class Talker : public rclcpp::Node {{
public:
  Talker() : Node("talker") {{
    server_ = rclcpp_action::create_server<a::action::B>(this, "a", goal, cancel,
      [this](const std::shared_ptr<Handle> handle) {{ {} }});
  }}
  void accept(const std::shared_ptr<Handle> handle) {{ execute(handle); }}
  void execute(const std::shared_ptr<Handle> handle) {{
    rclcpp::Rate rate(2.0);
    for (int i = 0; i < 9; ++i) {{ handle->publish_feedback(i); rate.sleep(); }}
    handle->succeed(result);
  }}
  void other() {{ other(); }}
}};
""" + _SPIN  # fmt: skip


@pytest.mark.parametrize(
    ("accepted", "is_said"),
    [
        ("accept(handle);", True),
        ("this->execute(handle);", True),
        ("std::thread([this, handle]() { execute(handle); }).detach();", False),
        ("goals_.push_back(handle);", False),
    ],
)
def test_a_goal_that_is_executed_where_it_is_accepted(accepted: str, is_said: bool) -> None:
    """The executor calls nothing else until the goal has ended, unless a thread executes it."""
    text = _ACTION.replace("{}", accepted).replace("{{", "{").replace("}}", "}")
    rules = [fault.rule for fault in nodes_of(text).faults if fault.rule == "callback-sleep"]
    assert rules == (["callback-sleep"] if is_said else [])
