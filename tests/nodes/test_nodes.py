"""The nodes of Python modules: what is a text, number or constant is known, and nothing else."""

import pytest

from grader.base.reuse import Answers
from grader.files.tree import make_tree, overlaid
from grader.ros.nodes.node_facts import (
    Endpoint,
    NodeFacts,
    NodeParameter,
    PackageNodes,
    Timer,
)
from grader.ros.nodes.python.python_nodes import read_nodes
from grader.ros.package.finding import read_packages
from grader.ros.python.values import Unknown

_SETUP = """
from setuptools import setup
setup(name='hub', packages=['hub'], entry_points={'console_scripts': ['talk = hub.talker:main', 'b = hub.b:main']})
"""
_HEAD = """
import rclpy
import std_msgs.msg
from rclpy.node import Node
from rclpy.qos import *
from rclpy.qos import QoSPresetProfiles, QoSProfile, ReliabilityPolicy, DurabilityPolicy, qos_profile_sensor_data
from std_msgs.msg import Float32
from std_srvs.srv import Trigger
TOPIC = 'heat'
"""
_CLASS = """
class Talker(Node):
    rate = 0.5
    def __init__(self):
        super().__init__('talker')
"""


def nodes_of(text: str, **files: str) -> PackageNodes:
    """Return the nodes of a package whose module talker has this text; other modules are given by their names."""
    texts = {
        "package.xml": "<package format='3'><name>hub</name></package>",
        "setup.py": _SETUP,
        "hub/__init__.py": "",
    }
    texts |= {f"hub/{name}.py": it for name, it in {"talker": text, **files}.items()}
    tree = overlaid(
        make_tree("work", (), ()), {f"src/hub/{path}": it.encode() for path, it in texts.items()}
    )
    [package] = read_packages(tree, "urdf/hub.urdf")
    return read_nodes(package, Answers(package))


def node_of(*statements: str) -> NodeFacts:
    """Return a node whose __init__ has these statements."""
    [node] = nodes_of(_HEAD + _CLASS + "".join(f"        {it}\n" for it in statements)).nodes
    return node


ENDPOINTS = [
    (
        "self.create_publisher(Float32, 'heat', 10)",
        ("publisher", "std_msgs.msg.Float32", "heat", (10, "reliable", "volatile")),
    ),
    (
        "self.create_publisher(qos_profile=5, topic=TOPIC, msg_type=std_msgs.msg.Bool)",
        ("publisher", "std_msgs.msg.Bool", "heat", (5, "reliable", "volatile")),
    ),
    (
        "self.create_subscription(Float32, f'{TOPIC}/raw', self.on, qos_profile_sensor_data)",
        ("subscription", "std_msgs.msg.Float32", "heat/raw", (5, "best_effort", "volatile")),
    ),
    (
        "self.create_subscription(Float32, 'a' + TOPIC, self.on, QoSPresetProfiles.SENSOR_DATA.value)",
        ("subscription", "std_msgs.msg.Float32", "aheat", (5, "best_effort", "volatile")),
    ),
    (
        "self.create_publisher(Float32, 'a', QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))",
        ("publisher", "std_msgs.msg.Float32", "a", (1, "reliable", "transient_local")),
    ),
    (
        "self.create_publisher(Float32, 'a', QoSProfile(depth=n(), reliability=ReliabilityPolicy.BEST_EFFORT))",
        ("publisher", "std_msgs.msg.Float32", "a", (None, "best_effort", "volatile")),
    ),
    (
        "self.create_publisher(Float32, 'a', QoSProfile(depth=1, reliability=n()))",
        ("publisher", "std_msgs.msg.Float32", "a", (1, None, "volatile")),
    ),
    (
        "self.create_publisher(Float32, 'a', True)",
        ("publisher", "std_msgs.msg.Float32", "a", (None, None, None)),
    ),
    (
        "self.create_service(Trigger, 'reset', self.on)",
        ("service", "std_srvs.srv.Trigger", "reset", (None, None, None)),
    ),
    (
        "self.create_client(Trigger, 'reset')",
        ("client", "std_srvs.srv.Trigger", "reset", (None, None, None)),
    ),
    (
        "self.create_publisher(kind(), topic(), 10)",
        ("publisher", None, None, (10, "reliable", "volatile")),
    ),
    ("self.create_publisher(*given)", ("publisher", None, None, (None, None, None))),
    ("self.create_publisher(**given)", ("publisher", None, None, (None, None, None))),
]


@pytest.mark.parametrize(("statement", "expected"), ENDPOINTS)
def test_publishers_subscriptions_services_and_clients_are_known_as_far_as_they_are_constants(
    statement: str, expected: tuple[object, ...]
) -> None:
    """Type, name and quality of service are known by themselves; what is computed is None."""
    [endpoint] = node_of(statement).endpoints
    assert isinstance(endpoint, Endpoint)
    assert (*endpoint[:3], tuple(endpoint.qos)) == expected
    assert (endpoint.location.path, endpoint.location.column) == ("src/hub/hub/talker.py", 9)
    assert endpoint.location.line == (_HEAD + _CLASS).count("\n") + 1


@pytest.mark.parametrize(
    ("statement", "durability"),
    [("latch(qos)", None), ("other = qos", None), ("self.latch(qos)", "volatile")],
)
def test_a_quality_that_is_given_away_may_be_changed(
    statement: str, durability: str | None
) -> None:
    """A function, or what has another name, may set its policies; methods of nodes set none."""
    lines = ("qos = QoSProfile(depth=1)", statement, "self.create_publisher(Float32, 'a', qos)")
    [endpoint] = node_of(*lines).endpoints
    assert isinstance(endpoint, Endpoint)
    assert endpoint.qos.durability == durability


CONSTANTS = [
    (["topic = 'a'"], "topic", "a"),
    (["self.topic = 'a'"], "self.topic", "a"),
    (["topic = 'a'", "topic = 'b'"], "topic", None),
    (["topic = 'a'", "topic += 'b'"], "topic", None),
    (["self.topic = 'a'", "self.topic = 'b'"], "self.topic", None),
    (["for topic in ('a', 'b'): pass"], "topic", None),
    (["topic: str = 'a'"], "topic", "a"),
    (["topic = undefined"], "topic", None),
    (["topics = ['a']", "topics[0] = 'b'"], "topics[0]", None),
    (["topic = self.get_parameter('topic').value"], "topic", None),
    (["topic = str(5)"], "topic", "5"),
    (["def inner(topic): pass", "topic = 'a'"], "topic", None),
]


@pytest.mark.parametrize(("statements", "topic", "expected"), CONSTANTS)
def test_a_name_that_is_bound_once_is_a_constant(
    statements: list[str], topic: str, expected: str | None
) -> None:
    """A name that is bound twice, changed, a parameter or in a list is not known."""
    node = node_of(*statements, f"self.create_publisher(Float32, {topic}, 10)")
    assert [it.name for it in node.endpoints] == [expected]


OPEN = [
    ("global TOPIC; TOPIC = 'b'", None),
    ("exec('TOPIC = 1')", None),
    ("pass", "heat"),
]


@pytest.mark.parametrize(("statement", "expected"), OPEN)
def test_what_may_be_bound_elsewhere_is_no_constant(statement: str, expected: str | None) -> None:
    """A global statement, and what binds names unseen, make a constant of the module unknown."""
    text = f"{_HEAD}def change():\n    {statement}\n{_CLASS}        self.create_publisher(Float32, TOPIC, 10)\n"
    [node] = nodes_of(text).nodes
    assert [it.name for it in node.endpoints] == [expected]


def test_a_star_import_below_a_constant_may_replace_it() -> None:
    """Names of messages do not replace it; those of an unknown module do."""
    for module, expected in (("std_msgs.msg", "heat"), ("math", "heat"), ("hub.settings", None)):
        [node] = nodes_of(
            f"{_HEAD}from {module} import *\n{_CLASS}        self.create_publisher(Float32, TOPIC, 1)\n"
        ).nodes
        assert [it.name for it in node.endpoints] == [expected]


PARAMETERS = [
    ("self.declare_parameter('rate', 10.0)", [("rate", 10.0, True)]),
    ("self.declare_parameter('rate', Parameter.Type.DOUBLE)", [("rate", "?", True)]),
    ("self.declare_parameter('rate', rclpy.Parameter.Type.DOUBLE)", [("rate", None, True)]),
    ("self.declare_parameter('rate', n())", [("rate", "?", True)]),
    ("self.declare_parameter(n(), 1)", [(None, 1, True)]),
    (
        "self.declare_parameters('', [('a', 1), ('b', [2.0], Descriptor()), ('c',)])",
        [("a", 1, True), ("b", [2.0], True), ("c", None, True)],
    ),
    ("self.declare_parameters('arm', [('a', 1)])", [("arm.a", 1, True)]),
    ("self.declare_parameters(n(), [('a', 1)])", [(None, 1, True)]),
    ("self.declare_parameters('', n())", [(None, "?", True)]),
    ("x = self.get_parameter('rate').value", [("rate", None, False)]),
    ("x = self.get_parameter_or('rate', 5)", [("rate", None, False)]),
]


@pytest.mark.parametrize(("statement", "expected"), PARAMETERS)
def test_parameters_are_known_with_their_defaults(
    statement: str, expected: list[tuple[object, ...]]
) -> None:
    """Each parameter has a name and a default, as far as they are constants, and is declared or read."""
    found: tuple[NodeParameter, ...] = node_of(statement).parameters
    shown = [
        (it.name, "?" if isinstance(it.default, Unknown) else it.default, it.is_declared)
        for it in found
    ]
    assert shown == expected


def test_timers_have_periods() -> None:
    """A period is a number or a constant of the class; one that is computed is not known."""
    statements = ("self.create_timer(self.rate, self.on)", "self.create_timer(1 / n(), self.on)")
    timers: tuple[Timer, ...] = node_of(*statements).timers
    assert [it.period for it in timers] == [0.5, None]


BASES = [
    ("from rclpy.node import Node\n", "Node"),
    ("import rclpy\n", "rclpy.node.Node"),
    ("from rclpy import node as n\n", "n.Node"),
    ("from rclpy.lifecycle import LifecycleNode as L\n", "L"),
]


@pytest.mark.parametrize(("head", "base"), BASES)
def test_a_class_of_nodes_is_one_whatever_its_base_is_called(head: str, base: str) -> None:
    """The base is known by its full name; super() or the base itself names the node."""
    for call in (
        "super().__init__('a')",
        "super(T, self).__init__(node_name='a')",
        f"{base}.__init__(self, 'a')",
    ):
        [node] = nodes_of(
            f"{head}class T({base}):\n    def __init__(self):\n        {call}\n"
        ).nodes
        assert (node.class_name, node.name, node.location.line, node.doubts) == (
            "hub.talker.T",
            "a",
            2,
            (),
        )


NAMES = [
    "pass",
    "super().__init__(name)",
    "super().__init__(name); super().__init__('b')",
    "Mixin.__init__(self, 'a')",
]


def test_a_name_is_known_beside_other_arguments() -> None:
    """It is the first one, or has a name."""
    for call in ("'a', **given", "node_name='a', **given"):
        [node] = nodes_of(
            f"{_HEAD}class T(Node):\n    def __init__(self):\n        super().__init__({call})\n"
        ).nodes
        assert node.name == "a"


@pytest.mark.parametrize("call", NAMES)
def test_a_name_that_is_computed_is_not_known(call: str) -> None:
    """So is one of a node that is named twice, or whose base class is given the name."""
    [node] = nodes_of(
        f"{_HEAD}class T(Node):\n    def __init__(self, name):\n        {call}\n"
    ).nodes
    assert node.name is None


DOUBTS = [
    ("super().__init__('a', namespace='b')", "namespace of its Node"),
    ("super().__init__('a', **given)", "more arguments of its Node"),
    ("super().__init__(**given)", "more arguments of its Node"),
    ("Helper(self)", "Helper is given the node"),
    ("helpers[0](node=self)", "this call is given the node"),
    ("rclpy.spin(self)", None),
    ("other.create_publisher(Float32, 'x', 10)", None),
]


@pytest.mark.parametrize(("statement", "doubt"), DOUBTS)
def test_what_may_open_more_is_a_doubt(statement: str, doubt: str | None) -> None:
    """A function that is given the node, and options of Node, may declare or open more."""
    [node] = nodes_of(
        f"{_HEAD}class T(Node):\n    def __init__(self):\n        {statement}\n"
    ).nodes
    assert [it.reason for it in node.doubts] == [doubt] * (doubt is not None)


def test_a_node_may_be_made_by_a_function() -> None:
    """rclpy.create_node and Node itself make a node, whose calls are found by the name that it is bound to."""
    text = f"{_HEAD}def main():\n    rclpy.init()\n    n = rclpy.create_node('a')\n    n.create_publisher(Float32, 'x', 10)\n    rclpy.spin(n)\n"
    found = nodes_of(text)
    [node] = found.nodes
    assert (node.class_name, node.name, [it.name for it in node.endpoints], node.doubts) == (
        "",
        "a",
        ["x"],
        (),
    )
    assert [(it.name, it.nodes) for it in found.programs] == [("talk", (node,)), ("b", ())]
    [other] = nodes_of(_HEAD + "node = Node('b')\nnode.create_client(Trigger, 'x')").nodes
    assert (other.name, len(other.endpoints)) == ("b", 1)


def test_calls_of_an_unknown_node_are_a_doubt_of_the_package() -> None:
    """The node that a function is given is not known, nor is a file that is not read."""
    text = f"{_HEAD}def helper(node):\n    node.create_publisher(Float32, 'x', 10)\n"
    found = nodes_of(text, broken="def (")
    assert found.nodes == ()
    reasons = {"the node of this create_publisher() is not known", "the file is not read"}
    assert {it.reason for it in found.doubts} == reasons


def test_a_method_of_a_variable_starts_no_node_without_a_class() -> None:
    """Only the function that makes such a node has it; others that call methods of a variable have not."""
    other = (
        f"{_HEAD}def main():\n    rclpy.init()\n    n = rclpy.create_node('b')\n    rclpy.spin(n)\n"
    )
    text = f"{_HEAD}{_CLASS}def main():\n    node = Talker()\n    node.destroy_node()\n"
    programs = nodes_of(text, b=other).programs
    names = {program.name: [node.name for node in program.nodes] for program in programs}
    assert names == {"talk": ["talker"], "b": ["b"]}


_GIVEN = """
def go(node, client, x=1):
    node.get_logger().info('a')
    last(node)
def last(robot):
    robot.create_publisher(Float32, 'x', 10)
def main():
    n = rclpy.create_node('a')
    go(n, 1, x=2)
    go(client=1, node=n)
"""


@pytest.mark.parametrize(
    ("more", "opened"),
    [
        ("", ["x"]),
        ("    go(Node('b'), 1)\n", []),  # more than one node
        ("    go(*[n])\n", ["x"]),
        ("    helper.go(n)\n", ["x"]),
    ],
)
def test_a_function_of_the_module_opens_what_it_opens_of_the_node_that_it_is_given(
    more: str, opened: list[str]
) -> None:
    """All its calls give it one node; a function of another module may open anything."""
    node, *_ = nodes_of(_HEAD + _GIVEN + more).nodes
    assert [end.name for end in node.endpoints] == opened
    assert bool(node.doubts) == (more[:9] in ("    go(No", "    helpe"))


def test_a_parameter_that_is_bound_again_is_no_node() -> None:
    """An inner function, or an assignment, may give the name to something else."""
    for body in ("def in_it(robot):\n        pass", "robot = 1"):
        text = _GIVEN.replace("def last(robot):", f"def last(robot):\n    {body}")
        [node] = nodes_of(_HEAD + text).nodes
        assert node.endpoints == ()


def test_a_program_has_the_nodes_that_its_function_creates() -> None:
    """Also those of functions that it calls, and of a function or class of another module; a derived class is one."""
    text = f"{_HEAD}from .base import Base, run\nclass T(Base):\n    pass\ndef start():\n    T()\ndef main():\n    start(); run()\n"
    base = f"{_HEAD}class Base(Node):\n    def __init__(self):\n        super().__init__('base')\ndef run():\n    Base()\n"
    found = nodes_of(text, base=base)
    assert {it.class_name for it in found.nodes} == {"hub.base.Base", "hub.talker.T"}
    assert [{it.class_name for it in program.nodes} for program in found.programs] == [
        {"hub.base.Base", "hub.talker.T"},
        set(),
    ]
    [derived] = [it for it in found.nodes if it.class_name == "hub.talker.T"]
    assert (derived.name, derived.doubts) == ("base", ())


@pytest.mark.parametrize(
    ("file", "expected"), [("talk.py", ["talker"]), ("talk", ["talker"]), ("other", None)]
)
def test_a_script_that_cmake_installs_is_a_program(file: str, expected: list[str] | None) -> None:
    """Its body creates the node; it is Python by its ending or its first line."""
    first = "#!/bin/sh" if file == "other" else "#!/usr/bin/env python3"
    texts = {
        "package.xml": "<package format='3'><name>hub</name><export><build_type>ament_cmake</build_type></export></package>",
        "CMakeLists.txt": "project(hub)\nfind_package(ament_cmake)\n"
        f"install(PROGRAMS scripts/{file} DESTINATION lib/${{PROJECT_NAME}})\nament_package()",
        f"scripts/{file}": f"{first}\n{_HEAD}{_CLASS}\nif __name__ == '__main__':\n    Talker()\n",
    }
    tree = overlaid(
        make_tree("work", (), ()), {f"src/hub/{path}": it.encode() for path, it in texts.items()}
    )
    [package] = read_packages(tree, "urdf/hub.urdf")
    found = [
        (it.name, [node.name for node in it.nodes])
        for it in read_nodes(package, Answers(package)).programs
    ]
    assert found == ([(file, expected)] if expected else [])


@pytest.mark.slow
def test_a_module_may_be_too_long_to_evaluate(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is not read is a doubt."""
    text = _HEAD + _CLASS + "        self.create_client(Trigger, 'a' + 'b')\n" * 2000
    monkeypatch.setattr("grader.ros.python.constants._MAX_STEPS", 5_000)
    assert "the module is too long to evaluate" in {it.reason for it in nodes_of(text).doubts}


def test_a_package_without_a_build_file_has_no_nodes() -> None:
    """Nothing of it is installed."""
    tree = overlaid(
        make_tree("work", (), ()),
        {"hub/package.xml": b"<package format='3'><name>hub</name></package>"},
    )
    [package] = read_packages(tree, "urdf/hub.urdf")
    assert read_nodes(package, Answers(package)) == PackageNodes((), (), ())


@pytest.mark.parametrize(
    ("method", "name"),
    [
        ("self.add_on_set_parameters_callback(self.change)", "parameter"),
        ("self.add_post_set_parameters_callback(self.change)", "parameter"),
        ("self.create_timer(1.0, self.change)", ""),
    ],
)
def test_an_attribute_that_a_callback_of_parameters_sets(method: str, name: str) -> None:
    """When the node is started, it has the first value."""
    text = f"""
import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32


class Counter(Node):
    def __init__(self):
        super().__init__('counter')
        self.topic = self.declare_parameter('topic', 'count').value
        self.open()
        {method}

    def open(self):
        self.create_publisher(Int32, self.topic, 10)

    def change(self, parameters=()):
        self.topic = 'other'


def main():
    rclpy.init()
    rclpy.spin(Counter())
"""
    [node] = nodes_of(text).nodes
    kinds = [part.kind for end in node.endpoints for part in end.parts]
    assert kinds == ([name] if name else [])


INCREASED = [
    ("self.angle = 0.0\nself.angle_ += 1.0", ["Look has no attribute angle_; did you mean angle?"]),
    ("self.angle = 0.0\nself.angle += 1.0", []),
    ("self.angle: float = 0.0\nself.angle += 1.0", []),
    ("setattr(self, 'angle', 0.0)\nself.angle += 1.0", []),
]


@pytest.mark.parametrize(("body", "messages"), INCREASED)
def test_attributes_that_only_increase(body: str, messages: list[str]) -> None:
    """+= makes no attribute."""
    statements = "".join(f"        {line}\n" for line in body.splitlines())
    text = f"from rclpy.node import Node\nclass Look(Node):\n    def __init__(self):\n        super().__init__('look')\n{statements}Look()\n"
    assert [fault.message for fault in nodes_of(text).faults] == messages


@pytest.mark.parametrize(
    ("loop", "opened"),
    [
        ("[self.create_publisher(k, t, 1) for k, t in [(Float32, 'a'), (Float32, 'b')]]", "a b"),
        ("for t, d in (('a', 1), ('b', 2)): self.create_publisher(Float32, t, d)", "a b"),
        ("pairs = [(Float32, 'a')]; [self.create_publisher(k, t, 1) for k, t in pairs]", "a"),
        ("[self.create_publisher(k, t, 1) for k, t in [(Float32, 'a'), (Float32, x)]]", "a ?"),
        ("[self.create_publisher(k, t, 1) for k, t in found()]", "?"),
        ("[self.create_publisher(k, t, 1) for k, t in [(Float32, 'a'), (Float32,)]]", "?"),
    ],
)
def test_calls_in_a_loop_over_tuples_are_one_for_each(loop: str, opened: str) -> None:
    """What each gives is known as far as the list is written in the file."""
    node = node_of(loop)
    assert " ".join(end.name or "?" for end in node.endpoints) == opened


@pytest.mark.parametrize(
    ("signature", "call", "name"),
    [
        ("self, name='talker'", "Talker()", "talker"),
        ("self, name='talker'", "Talker('other')", "other"),
        ("self, name", "Talker(name='other')", "other"),
        ("self, name='talker'", "Talker(), Talker('other')", None),
        ("self, name='talker'", "Talker(*given)", None),
        ("self, name='talker'", "print()", None),
    ],
)
def test_a_name_may_be_a_parameter_of_the_constructor(
    signature: str, call: str, name: str | None
) -> None:
    """It is known where all calls of the module give the same text, or leave the default."""
    head = f"class Talker(Node):\n    def __init__({signature}):\n        super().__init__(name)\n"
    [node] = nodes_of(f"{_HEAD}\n{head}\ndef main():\n    {call}\n").nodes
    assert node.name == name


@pytest.mark.parametrize(
    ("helper", "created"),
    [
        ("def run(kind):\n    rclpy.spin(kind())", ["talker"]),
        ("def run(kind):\n    print(kind)", []),
    ],
)
def test_a_helper_may_make_the_node_whose_class_it_is_given(
    helper: str, created: list[str]
) -> None:
    """A program has the node if the function calls that parameter."""
    [program, *_] = nodes_of(
        f"{_HEAD}{_CLASS}\n{helper}\n\ndef main():\n    rclpy.init()\n    run(Talker)\n"
    ).programs
    assert [node.name for node in program.nodes] == created


def test_an_updater_of_diagnostics() -> None:
    """It publishes for the node that it is given, and opens nothing else."""
    text = _HEAD + "from diagnostic_updater import Updater\n" + _CLASS
    [node] = nodes_of(f"{text}        updater = Updater(self)\n").nodes
    assert [end.name for end in node.endpoints] == ["/diagnostics"]
    assert node.doubts == ()
