"""What a node is given by its launch file: its name, parameters, remappings and arguments."""

from typing import Any

import pytest
import yaml
from hypothesis import example
from hypothesis import given as hypothesis_given
from hypothesis import strategies as st

from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.launch.node_parameters import NodeParameters, collect_parameters, list_controllers
from grader.ros.python.values import Unknown
from tests.launch.launch_samples import Installed, read

SHARE = "share/my_robot/config"
FILES = {
    f"{SHARE}/named.yaml": b"""\
driver:
  ros__parameters:
    speed: 2.0
    wheels: [left, right]
    pid: {p: 1, i: 0x10}
/**:
  ros__parameters:
    speed: 1.0
    is_on: yes
    quoted: 'yes'
    empty:
""",
    f"{SHARE}/wild.yaml": b"""\
/*/driver: {ros__parameters: {speed: 3}}
ns: {driver: {ros__parameters: {deep: 4}}}
/other: {ros__parameters: {speed: 5}}
""",
    f"{SHARE}/texts.yaml": b"/**: {ros__parameters: {a: $(var name), b: .inf, c: 1e3, d: 010, e: [1, a], f: 1:30, g: !x z}}",
    f"{SHARE}/tags.yaml": b"/**: {ros__parameters: {a: !!str 1, b: !!float 1, c: !!str , d: [!!str 1, x]}}",
    f"{SHARE}/broken.yaml": b"/**: {",
}
HEAD = """\
from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import IfCondition
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
import os
CONFIG = get_package_share_path('my_robot') / 'config'

def generate_launch_description():
    return LaunchDescription([{}])
"""


def launch(actions: str, ending: str = "py") -> Launch:
    """Return a launch file with these actions, in Python or in XML."""
    text = HEAD.format(actions) if ending == "py" else f"<launch>{actions}</launch>"
    return read(text.encode(), f"a.launch.{ending}", FILES)


def node(actions: str, ending: str = "py") -> StartedNode:
    """Return the last node that is started."""
    return launch(actions, ending).nodes[-1]


def given(actions: str, ending: str = "py", **options: Any) -> NodeParameters:
    """Return the parameters of the last node that is started."""
    return collect_parameters(node(actions, ending), Installed(FILES).open_installed, **options)


def values(found: NodeParameters) -> dict[str, Any]:
    """Return the values of parameters; `?` for one that is unknown."""
    return {
        name: "?" if isinstance(it.value, Unknown) else it.value
        for name, it in found.values.items()
    }


NAMED = "Node(package='a', executable='b', name='driver', parameters=[{}])"
IN_ROOT = "Node(package='a', executable='b', name='driver', namespace='/', parameters=[{}])"
XML = '<node pkg="a" exec="b" name="driver" namespace="ns">{}</node>'
FILE = "CONFIG / 'named.yaml'"


@pytest.mark.parametrize(
    ("actions", "options", "expected"),
    [
        (
            NAMED.format("{'a': 1, 'b': {'c': True, 'd': [1, 2.5]}}"),
            {},
            {"a": 1, "b.c": True, "b.d": [1.0, 2.5]},
        ),
        (
            NAMED.format("{'a': '5', 'b': LaunchConfiguration('x', default='5')}"),
            {},
            {"a": "5", "b": 5},
        ),
        (
            NAMED.format(
                "{'a': ParameterValue(LaunchConfiguration('x', default='5'), value_type=str)}"
            ),
            {},
            {"a": "5"},
        ),
        (
            NAMED.format("{'a': 'y', 'b': '0483', 'c': ['n', 'off'], 'd': 'yes', 'e': '017'}"),
            {},
            {"a": True, "b": 483.0, "c": [False, "off"], "d": "yes", "e": "017"},
        ),
        (NAMED.format("{'a': Command(['cat ', str(CONFIG / 'named.yaml')])}"), {}, {"a": "?"}),
        (
            NAMED.format(
                "{'a': LaunchConfiguration('x', default=EnvironmentVariable('A'))}, {'b': 1}"
            ),
            {},
            {"a": "?", "b": 1},
        ),
        (NAMED.format("{'a': 1}, {'a': 2}"), {}, {"a": 2}),
        ("SetParameter('a', 1), " + NAMED.format("{'b': 1}"), {}, {"a": 1, "b": 1}),
        ("SetParameter('a', 1), " + NAMED.format("{'a': 2}"), {}, {"a": 2}),
        (
            "SetParameter('a', '5'), SetParameter('b', [1]), " + NAMED.format(""),
            {},
            {"a": 5, "b": "?"},
        ),
        (
            f"SetParametersFromFile(str({FILE})), " + IN_ROOT.format("{'speed': 9.0}"),
            {},
            {"speed": 1.0},
        ),
        ("GroupAction([SetParameter('a', 1)]), " + NAMED.format("{'b': 1}"), {}, {"b": 1}),
        (
            "SetParameter('c', 1), GroupAction([SetParameter('a', 1)]), "
            + NAMED.format("{'b': 1}"),
            {},
            {"c": 1, "a": 1, "b": 1},
        ),
        ("SetUseSimTime(True), " + NAMED.format("{'b': 1}"), {}, {"b": 1}),
        (
            "Node(package='a', executable='b', arguments=['--ros-args', '-p', 'x:=1.5', '-p', 'driver:y:=on', '-p', 'other:z:=1'], name='driver')",
            {},
            {"x": 1.5, "y": True},
        ),
        (
            "Node(package='a', executable='b', ros_arguments=['-p', 'x:=[1, 2]', '-p', 'y:={'], name='driver')",
            {},
            {"x": [1, 2], "y": "?"},
        ),
    ],
)
def test_values(actions: str, options: dict[str, Any], expected: dict[str, Any]) -> None:
    """A parameter has the value that launch evaluates, and the last one that is given counts."""
    found = given(actions, **options)
    assert {
        name: it for name, it in values(found).items() if name in expected or len(found.values) < 5
    } == expected
    assert found.unknown == ""


def test_files() -> None:
    """A file is read as rcl reads it: by the names of nodes, with YAML's numbers, booleans, quotes and nested names."""
    found = given(IN_ROOT.format(FILE))
    assert values(found) == {
        "speed": 1.0,
        "is_on": True,
        "quoted": "yes",
        "empty": "?",
        "wheels": ["left", "right"],
        "pid.p": 1,
        "pid.i": 16,
    }
    assert found.values["pid.i"].location.line == 5
    assert found.values["pid.i"].location.path == "config/named.yaml"


def test_texts() -> None:
    """A value that is a substitution, no scalar or a list of several types is unknown; the rest is as in rcl."""
    found = given(NAMED.format("ParameterFile(CONFIG / 'texts.yaml', allow_substs=True)"), name="x")
    assert values(found) == {
        "a": "?",
        "b": float("inf"),
        "c": 1000.0,
        "d": 8,
        "e": "?",
        "f": "1:30",
        "g": "z",
    }
    assert (
        values(given(NAMED.format("ParameterFile([os.fspath(CONFIG / 'texts.yaml')])")))["a"]
        == "$(var name)"
    )


def test_precedence() -> None:
    """Where a file names the node before /**, the value of /** counts."""
    assert values(given(NAMED.format(FILE)))["speed"] == 1.0


@pytest.mark.parametrize(
    ("key", "is_read"),
    [
        ("/**/driver", True),
        ("/*", False),
        ("/**", True),
        ("/*/driver", True),
        ("/**/other", False),
        ("/*/*", True),
        ("/ns/*", True),
        ("ns/driver", True),
        ("driver", False),
    ],
)
def test_wildcards(key: str, is_read: bool) -> None:
    """In a key, * stands for one name and ** for any number of them, or none."""
    files = {f"{SHARE}/named.yaml": f"{key}: {{ros__parameters: {{a: 1}}}}".encode()}
    started = node(IN_ROOT.replace("'/'", "'ns'").format(FILE))
    found = collect_parameters(started, Installed(files).open_installed)
    assert values(found) == ({"a": 1} if is_read else {})


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ("value='map_server, amcl' value-sep=', '", ["map_server", "amcl"]),
        ("value='1;2' value-sep=';'", [1, 2]),
        ("value='a' value-sep=';'", ["a"]),
        ("value='1;b' value-sep=';'", None),
        ("value='$(var a);b' value-sep=';'", None),
        ("value='1;2' value-sep=';' type='list_of_int'", None),
    ],
)
def test_separated_values(attributes: str, expected: object) -> None:
    """In XML, value-sep makes a list of a value; lists of several types or with substitutions are unknown."""
    action = XML.format(f"<param name='names' {attributes}/>")
    if expected is None:
        assert launch(action, "xml").unknown
        assert not launch(action, "xml").faults
    else:
        assert values(given(action, "xml")) == {"names": expected}


def test_an_empty_separator_stops_the_launch() -> None:
    """Python splits by no empty text."""
    found = launch(XML.format("<param name='a' value='b' value-sep=''/>"), "xml")
    assert [it.message for it in found.faults] == ["value-sep is empty"]


def test_names() -> None:
    """The key of a section has wildcards and namespaces; the name is unknown where the launch file gives none."""
    wild = XML.format("<param from='$(find-pkg-share my_robot)/config/wild.yaml'/>")
    assert values(given(wild, "xml")) == {"speed": 3, "deep": 4}
    assert values(given(wild, "xml", name="/other")) == {"speed": 5}
    nameless = f"Node(package='a', executable='b', parameters=[{FILE}, {{'x': 1}}])"
    assert values(given(nameless)) == {
        "speed": "?",
        "is_on": True,
        "quoted": "yes",
        "empty": "?",
        "wheels": "?",
        "pid.p": "?",
        "pid.i": "?",
        "x": 1,
    }
    assert values(given(nameless, name="driver"))["wheels"] == ["left", "right"]
    renamed = "Node(package='a', executable='b', name='x', arguments=['--ros-args', '-r', '__node:=y', '-r', '__ns:=/z'])"
    assert (node(renamed).node_name, node(renamed).namespace) == ("y", "/z")


@pytest.mark.parametrize(
    "parameters",
    [
        "CONFIG / 'missing.yaml'",
        "'/tmp/a.yaml'",
        "CONFIG / 'broken.yaml'",
        "ParameterValue(1)",
        "{'b': {'c': EnvironmentVariable('A')}}",
        "ParameterFile(EnvironmentVariable('A'))",
        "EnvironmentVariable('A')",
    ],
)
def test_unknown(parameters: str) -> None:
    """What is not evaluated may contain any parameter, and replaces those before it."""
    found = given(NAMED.format(f"{{'a': 1}}, {parameters}, {{'z': 1}}"))
    assert values(found) == {"a": "?", "z": 1}
    assert found.unknown


def test_for_all_nodes() -> None:
    """What is set under a condition that is unknown may be given."""
    condition = "condition=IfCondition(EnvironmentVariable('A', default_value='true'))"
    assert given(f"SetParameter('a', 1, {condition}), " + NAMED.format("")).unknown
    remapped = node(f"SetRemap('a', 'b', {condition}), Node(package='a', executable='b')")
    assert remapped.remaps is None
    kept = node(
        "GroupAction([SetRemap('a', 'b')]), Node(package='a', executable='b', remappings=[('a', 'c')])"
    )
    assert kept.remaps == (("a", "c"),)
    first = "Node(package='a', executable='b', remappings=[('a', 'c')], arguments=['--ros-args', '-r', 'a:=d'])"
    assert node(f"SetRemap('a', 'b'), {first}").topic("a") == "/d"


def test_arguments() -> None:
    """The words after the program are kept; one that is not evaluated is None."""
    assert node(
        "Node(package='a', executable='b', arguments=['x', EnvironmentVariable('A')])"
    ).arguments == ("x", None)
    assert node('<node pkg="a" exec="b" ros_args="-p x:=1"/>', "xml").arguments == ()
    assert values(given('<node pkg="a" exec="b" ros_args="-p x:=1"/>', "xml")) == {"x": 1}


def test_included_by() -> None:
    """A node knows the launch files by which its own is included."""
    inner = {"share/my_robot/launch/b.launch.xml": b'<launch><node pkg="a" exec="b"/></launch>'}
    outer = b'<launch><include file="$(dirname)/b.launch.xml"/></launch>'
    assert read(outer, "a.launch.xml", inner).nodes[0].included_by == (
        "share/my_robot/launch/a.launch.xml",
    )


def test_files_are_named() -> None:
    """A launch file names the parameter files that it gives to nodes, and stops without one for all nodes."""
    found = launch(f"SetParametersFromFile(str({FILE})), " + NAMED.format("CONFIG / 'wild.yaml'"))
    named = [[it.path for it in found.named(purpose)] for purpose in ("read", "parameters")]
    spawned = launch(
        "Node(package='controller_manager', executable='spawner', arguments=['a', '-p', 'x.yaml'])"
    )
    assert [it.path for it in spawned.named("parameters")] == ["x.yaml"]
    assert named == [
        [f"/<prefix>/{SHARE}/named.yaml"],
        [f"/<prefix>/{SHARE}/{name}.yaml" for name in ("named", "wild")],
    ]


def controllers(words: str) -> list[tuple[str | None, str | None, dict[str, Any]]] | None:
    """Return the names, namespaces and parameters of the controllers that a spawner with these arguments starts."""
    found = list_controllers(
        node(f"Node(package='controller_manager', executable='spawner', arguments=[{words}])")
    )
    if found is None:
        return None
    return [
        (
            it.node_name,
            it.namespace,
            values(collect_parameters(it, Installed(FILES).open_installed)),
        )
        for it in found
    ]


def test_controllers() -> None:
    """A spawner starts controllers in the namespace of their manager, with the parameters of its files."""
    path = "str(CONFIG / 'wild.yaml')"
    assert controllers(
        f"'other', 'driver', '--param-file', {path}, '-c', '/ns/controller_manager'"
    ) == [
        ("other", "/ns", {}),
        ("driver", "/ns", {"speed": 3, "deep": 4}),
    ]
    assert controllers(f"'--inactive', 'other', '-p', {path}") == [("other", "/", {"speed": 5})]
    assert controllers("'other', '--controller-manager=cm', '--ros-args', '-p', 'a:=1'") == [
        ("other", "/", {})
    ]
    assert controllers("'other', EnvironmentVariable('A')") is None


def test_a_tag_makes_a_string() -> None:
    """!!str counts in every release; what other tags make of a text depends on the release."""
    action = "Node(package='p', executable='e', parameters=[str(CONFIG / 'tags.yaml')])"
    assert values(given(action)) == {"a": "1", "b": "?", "c": "", "d": ["1", "x"]}


@example("y")
@example("1.5e3")
@hypothesis_given(st.text("yYnNof01789.eExX+- ", min_size=1, max_size=6))
def test_a_text_is_what_rcl_reads_in_the_file_of_launch_ros(text: str) -> None:
    """launch_ros writes a dict with PyYAML, which adds quotes only where PyYAML reads no text."""
    written = yaml.dump({"/**": {"ros__parameters": {"a": text}}}).encode()
    files = {f"{SHARE}/written.yaml": written}
    of_file = read(
        HEAD.format(NAMED.format("str(CONFIG / 'written.yaml')")).encode(), "a.launch.py", files
    )
    of_dict = given(NAMED.format(f"{{'a': {text!r}}}"))
    expected = collect_parameters(of_file.nodes[-1], Installed(files).open_installed)
    assert values(of_dict) == values(expected)
