"""Launch files of every style that tutorials and students use, and hostile ones."""

import re
from pathlib import Path

import pytest

from grader.ros.launch.launch_model import Launch
from tests.examples import light
from tests.launch.launch_samples import FOLDER, SAMPLES, read, summarize, summarize_sample
from tests.work import limited_work

# What is found in each sample: its nodes, and with their lines the files that it names, its faults and what is unknown.
EXPECTED = {
    name: [line.strip() for line in rows.splitlines()]
    for name, rows in re.findall(
        r"^(\S.*)\n((?:  .*\n)*)",
        (Path(__file__).parent / "launch_samples.expected").read_text(encoding="utf-8"),
        re.MULTILINE,
    )
}


@pytest.mark.parametrize("sample", SAMPLES)
def test_samples(sample: str) -> None:
    """Nodes, files, faults and values known only at run time are found, each with its line."""
    assert summarize_sample(sample) == EXPECTED[sample]


def test_every_expectation_has_its_sample() -> None:
    """The table names existing samples."""
    assert EXPECTED.keys() == SAMPLES.keys()


PYTHON = """\
import os
from functools import partial
from launch import LaunchDescription
from launch.actions import *
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription, OpaqueFunction
from launch.actions import SetLaunchConfiguration
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
{before}

def generate_launch_description():
    {inside}
    return LaunchDescription([{actions}])
"""
NODE = "Node(package='a', executable='b')"
RVIZ = "Node(package='rviz2', executable='rviz2', arguments=['-d', {}])"


def python(actions: str, before: str = "", inside: str = "pass") -> bytes:
    """Return a launch file in Python."""
    return PYTHON.format(before=before, inside=inside, actions=actions).encode()


def doubling(last: str, name: str = "x", levels: int = 60) -> str:
    """Return nested lists, each containing the next twice: few lines that make more than any machine holds."""
    lines = [
        f"{name}0 = {last}",
        *(f"{name}{n} = [{name}{n - 1}, {name}{n - 1}]" for n in range(1, levels)),
    ]
    return "\n".join(lines)


def chained(levels: int = 60) -> str:
    """Return launch arguments, each with the one before it twice."""
    declaration = "DeclareLaunchArgument('a{}', default_value=[LaunchConfiguration('a{}'), LaunchConfiguration('a{}')])"
    return "DeclareLaunchArgument('a0', default_value='ab'), " + ", ".join(
        declaration.format(n, n - 1, n - 1) for n in range(1, levels)
    )


XML_NODE = '<node pkg="rviz2" exec="rviz2" args="{}"/>'
HOSTILE_PYTHON = {
    "nodes in doubled lists": python("x59", doubling("Node(package='a', executable='a')")),
    "texts in doubled lists": python(RVIZ.format("x59"), doubling("'ab'")),
    "package in doubled lists": python("Node(package=x59, executable='a')", doubling("'ab'")),
    "forgotten node in doubled lists": python(
        "", doubling("'ab'"), "n = Node(package=x59, executable=x59)"
    ),
    "command in doubled lists": python(RVIZ.format("Command(x59)"), doubling("'xacro '")),
    "path in doubled lists": python(RVIZ.format("PathJoinSubstitution(x59)"), doubling("'a'")),
    "expression in doubled lists": python(RVIZ.format("PythonExpression(x59)"), doubling("'1 + '")),
    "dicts in doubled lists": python(
        "Node(package='rviz2', executable='rviz2', parameters=x59)", doubling("{'a': 1}")
    ),
    "substitutions doubled": python(
        RVIZ.format("x"),
        "x = LaunchConfiguration('a', default='b')\n" + "x = PathJoinSubstitution([x, x])\n" * 60,
    ),
    "groups doubled": python(
        "x", "x = Node(package='a', executable='a')\n" + "x = GroupAction([x, x])\n" * 60
    ),
    "arguments doubled": python(chained() + ", " + RVIZ.format("LaunchConfiguration('a59')")),
    "list in itself": python("x", "x = []\nx.append(x)\nx.append(x)"),
    "list in itself as a text": python(RVIZ.format("x"), "x = []\nx.append(x)\nx.append(x)"),
    "list in a list, deep": python(
        "x", "x = [Node(package='a', executable='a')]\nfor i in range(5000):\n    x = [x]"
    ),
    "text in a list, deep": python(
        RVIZ.format("x"), "x = ['a']\nfor i in range(5000):\n    x = [x]"
    ),
    "method of a method, deep": python(
        RVIZ.format("x"), "x = open('a')\nfor i in range(5000):\n    x = x.read()"
    ),
    "argument of itself": python(
        "DeclareLaunchArgument('a', default_value=LaunchConfiguration('a')),"
        + RVIZ.format("LaunchConfiguration('a')")
    ),
    "thousands of nodes": python("*[Node(package='a', executable=f'b{i}') for i in range(9000)]"),
    "function of itself": python(
        "OpaqueFunction(function=f)",
        "def f(context):\n    return [OpaqueFunction(function=f), OpaqueFunction(function=f)]",
    ),
    "description of itself": python(
        "", "ld = LaunchDescription()\nld.add_action(ld)\nld.add_action(ld)", "return ld"
    ),
    "handler of itself": python("f", "def f():\n    return [f, f]"),
    "huge text": python(RVIZ.format("x"), "x = 'a' * 1000\nfor i in range(40):\n    x = x + x"),
    "huge number": python(RVIZ.format("x"), "x = 9\nfor i in range(9000):\n    x = x + x"),
    "open branches that double": python(
        NODE,
        inside="a, b, u = [1], [2], os.environ.get('U')\n"
        + """\
    if u: c = a
    else: c = b
    if u: d = b
    else: d = a
    a, b = c, d
"""
        * 200,
    ),
    "open branches of many names": python(
        NODE,
        inside="u = os.environ.get('U')\n"
        + "".join(f"    x{number} = {number}\n" for number in range(3000))
        + "    if u: y = 1\n" * 6000,
    ),
    "open lists, deep": python(
        "*a",
        inside="a, u = [], os.environ.get('U')\n"
        "    for i in range(3000):\n        b = []\n        if u: b.append(a)\n        a = b",
    ),
    "open lists, wide": python(
        "*a",
        inside=f"a, u = [{NODE}] * 60, os.environ.get('U')\n"
        "    for i in range(12):\n        b = []\n        if u: b += [a, a, a, a]\n        a = b",
    ),
    "calls of nothing known": python(
        NODE, "".join(f"x{number} = []\n" for number in range(2000)) + "g = gone(os)\n" * 1500
    ),
    "partial of nothing": python("OpaqueFunction(function=partial())"),
    "keywords that are open": python(
        "OpaqueFunction(function=partial(dict, a=1), kwargs=os.environ.get('X'))"
    ),
    "keywords that are numbers": python("OpaqueFunction(function=partial(dict), kwargs={1: 2})"),
    "documents of nothing": python(
        NODE, "import xml.etree.ElementTree as ET\nET.tostring(ET.parse('a')).decode()\nET.parse()"
    ),
    "long line": python("'" + "a" * 1_000_000 + "'"),
    "brackets": b"x = " + b"[" * 100_000,
    "closed brackets": b"x = " + b"[" * 90 + b"]" * 90,
    "minus signs": b"x = " + b"-" * 100_000 + b"1",
    "additions": b"x = 1" + b" + 1" * 20_000,
    "thousands of expressions": python(
        ",".join([RVIZ.format("PythonExpression('[i for i in range(2000)]')")] * 4_000)
    ),
    "zero bytes": b"\0" * 1000,
    "zero byte in a text": python(RVIZ.format("'a\0b'")),
    "no UTF-8": b"# \xe4\n" + python(""),
    "declared latin-1": "# -*- coding: latin-1 -*-\n# ä\n".encode("latin-1") + python(""),
    "lone surrogate": python(RVIZ.format(r"'\ud800'")),
    "surrogates everywhere": python(
        r"Node(package='\udcff', executable='\udcff', condition=IfCondition('\udcff'))"
    ),
    "expression with quotes": python(RVIZ.format("PythonExpression(\"'\\\\x\\\\'\")")),
    "expression that calls": python(
        RVIZ.format("PythonExpression(\"__import__('os').system('echo')\")")
    ),
    "expression that is deep": python(RVIZ.format("PythonExpression('(' * 900)")),
    "unclosed quotes of a command": python(RVIZ.format("Command('cat \"a')")),
    "empty command": python(
        RVIZ.format("Command('')") + ", Node(package='rviz2', executable='rviz2', arguments=[''])"
    ),
    "break outside a loop": b"def generate_launch_description():\n    break\n",
    "continue outside a loop": python(
        "OpaqueFunction(function=f)", "def f(context):\n    continue"
    ),
    "return at the top": b"return 1\n",
    "end of Python": python("", "", "import sys; sys.exit(1)"),
    "strange types": python(
        "1, None, True, 2.5, b'', (), {}, {'a': 1}, ..., Node, LaunchDescription, len, lambda: 1"
    ),
    "strange arguments": python(
        "Node(package=1, executable=None, parameters=1, arguments=2, condition=3), Node(**1), Node(*2)"
    ),
    "strange calls": python(
        "LaunchDescription(1), GroupAction(1), IncludeLaunchDescription(1), OpaqueFunction(1), DeclareLaunchArgument(1, 2), SetLaunchConfiguration(None)"
    ),
}
HOSTILE_XML = {
    "deep": b"<launch>" + b"<group>" * 100_000,
    "deep and closed": b"<launch>" + b"<group>" * 200 + b"</group>" * 200 + b"</launch>",
    "deep substitution": f"<launch>{XML_NODE.format('$(var ' * 100_000)}</launch>".encode(),
    "deep quotes": f"<launch>{XML_NODE.format('$(var (&quot;' * 50_000)}</launch>".encode(),
    "wide": b"<launch>" + b'<node pkg="a" exec="b"/>' * 40_000 + b"</launch>",
    "wide attributes": b"<launch><node "
    + b" ".join(b'a%d="b"' % n for n in range(20_000))
    + b"/></launch>",
    "long line": b'<launch><node pkg="' + b"a" * 1_000_000 + b'" exec="b"/></launch>',
    "many substitutions": f"<launch>{XML_NODE.format('$(var a) ' * 50_000)}</launch>".encode(),
    "backslashes": f"<launch>{XML_NODE.format(chr(92) * 100_000)}</launch>".encode(),
    "doctype": b'<!DOCTYPE launch SYSTEM "file:///etc/passwd"><launch/>',
    "entity": b'<!DOCTYPE l [<!ENTITY e SYSTEM "file:///etc/passwd">]><launch><node pkg="&e;" exec="b"/>&e;</launch>',
    "entities": b"<!DOCTYPE l [<!ENTITY a0 'ha'>"
    + b"".join(b"<!ENTITY a%d '&a%d;&a%d;'>" % (n, n - 1, n - 1) for n in range(1, 60))
    + b"]><launch><node pkg='&a59;' exec='b'/>&a59;</launch>",
    "zero bytes": b"<launch>\0</launch>",
    "no UTF-8": b'<launch><node pkg="\xe4" exec="b"/></launch>',
    "namespaces": b'<launch xmlns="urn:a" xmlns:b="urn:b"><b:node b:pkg="a"/></launch>',
    "comments": b"<launch><!-- <node> --><?pi <node> ?><![CDATA[<node>]]><node pkg='a' exec='b'/></launch>",
    "doubled arguments": (
        "<launch><let name='a0' value='ab'/>"
        + "".join(
            f"<let name='a{n}' value='$(var a{n - 1})$(var a{n - 1})'/>" for n in range(1, 60)
        )
        + XML_NODE.format("-d $(var a59)")
        + "</launch>"
    ).encode(),
    "empty": b"",
}
HOSTILE_YAML = {
    "aliases doubled": b"launch:\n- group: &a0 [node: {pkg: a, exec: b}]\n"
    + b"".join(
        b"- group: &a%d [group: *a%d, group: *a%d]\n" % (n, n - 1, n - 1) for n in range(1, 60)
    ),
    "children doubled": b"launch:\n- x: &a0 {y: z}\n"
    + b"".join(b"- x: &a%d {p: [*a%d, *a%d]}\n" % (n, n - 1, n - 1) for n in range(1, 60)),
    "alias of itself": b"launch: &a\n- group: *a\n- group: *a\n",
    "merge of itself": b"launch:\n- node: &a\n    <<: *a\n    pkg: a\n    exec: b\n",
    "merges of merges": b"launch:\n- node: &a0 {pkg: a, exec: b}\n"
    + b"".join(b"- node: &a%d {<<: [*a%d, *a%d]}\n" % (n, n - 1, n - 1) for n in range(1, 60)),
    "brackets": b"launch: " + b"[" * 100_000,
    "braces": b"launch: " + b"{a: " * 100_000,
    "dashes": b"launch: \n" + b"- " * 100_000,
    "long line": b"launch:\n- node: {pkg: " + b"a" * 400_000 + b", exec: b}",
    "zero bytes": b"launch: \0",
    "no UTF-8": b"launch:\n- node: {pkg: \xe4, exec: b}\n",
    "strange types": b"launch:\n- 1\n- \n- [node]\n- {}\n- {1: 2}\n- {[a]: b}\n- node: \n- node: 3\n- node: [a]\n- group: a\n",
    "a text": b"launch: yes",
    "many documents": b"---\n" * 10_000,
    "python tag": b"launch: !!python/object/apply:os.system ['true']\n",
    "empty": b"",
}


COSTLY = {
    "wide.launch.xml",
    "many substitutions.launch.xml",
    "thousands of expressions.launch.py",
    "deep substitution.launch.xml",
    "long line.launch.xml",
    "wide attributes.launch.xml",
    "thousands of nodes.launch.py",
    "deep quotes.launch.xml",
    "function of itself.launch.py",
    "aliases doubled.launch.yaml",
    "text in a list, deep.launch.py",
    "long line.launch.yaml",
    "method of a method, deep.launch.py",
    "huge number.launch.py",
}


def hostile() -> list[tuple[str, bytes]]:
    """Return every hostile file with its name as a launch file."""
    kinds = {".launch.py": HOSTILE_PYTHON, ".launch.xml": HOSTILE_XML, ".launch.yaml": HOSTILE_YAML}
    return [
        (name + ending, data) for ending, samples in kinds.items() for name, data in samples.items()
    ]


def is_well_formed(launch: Launch) -> bool:
    """Return whether the results are bounded and have locations in the file."""
    nodes = [*launch.nodes, *launch.forgotten]
    faults = [*launch.faults, *launch.unknown, *filter(None, [launch.syntax])]
    locations = [item.location for part in (nodes, launch.references, faults) for item in part]
    return len(locations) < 20_000 and all(
        at_location.line > 0 and at_location.column > 0 for at_location in locations
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "data"),
    light(hostile(), lambda row: row[0] in COSTLY),
    ids=[name for name, _ in hostile()],
)
def test_hostile_files(name: str, data: bytes) -> None:
    """Whatever a launch file contains, nothing raises or takes long."""
    with limited_work(200_000_000):
        launch = read(data, name)
        assert is_well_formed(launch)
        summarize(launch)


TWO = """\
<launch>
  <node pkg="a" exec="a"/>
  <include file="$(dirname)/{}.launch.xml"/>
  <include file="$(dirname)/{}.launch.xml"/>
</launch>
"""


def test_two_files_that_include_each_other() -> None:
    """A cycle of included files ends, and is a fault."""
    others = {
        f"{FOLDER}/{one}.launch.xml": TWO.format(two, two).encode() for one, two in ("ab", "ba")
    }
    launch = read(others[f"{FOLDER}/a.launch.xml"], "a.launch.xml", others)
    assert {fault.message for fault in launch.faults} == {"it includes itself"}
    assert len(launch.nodes) == 3


def test_many_includes() -> None:
    """Files that include the next one twice are evaluated up to a bound, which is reported."""
    others = {
        f"{FOLDER}/f{n}.launch.xml": TWO.format(f"f{n + 1}", f"f{n + 1}").encode()
        for n in range(40)
    }
    with limited_work(200_000):
        launch = read(others[f"{FOLDER}/f0.launch.xml"], "f0.launch.xml", others)
    assert "it includes more than 40 launch files" in {
        unknown.message for unknown in launch.unknown
    }
    assert len(launch.nodes) < 50


def test_arguments_of_an_include_stay_set() -> None:
    """The arguments of an include stay set after it, as in ROS 2; those of a group end with the group."""
    text = """\
<launch>
  <arg name="config" default="/opt/own.rviz"/>
  <group>
    <include file="$(dirname)/inner.launch.py"><arg name="config" value="/opt/given.rviz"/></include>
    <node pkg="rviz2" exec="rviz2" args="-d $(var config)"/>
  </group>
  <node pkg="rviz2" exec="rviz2" args="-d $(var config)"/>
</launch>
"""
    launch = read(text.encode(), "x.launch.xml")
    assert [node.path for node in launch.named("rviz")] == ["/opt/given.rviz", "/opt/own.rviz"]


def test_an_included_file_is_read_again() -> None:
    """Of two equal launch files, each starts what the file that it includes starts in its own package."""
    starts = '<launch><node pkg="{0}" exec="{0}"/></launch>'
    outer = b'<launch><include file="$(dirname)/inner.launch.xml"/></launch>'
    launches = [
        read(
            outer, "outer.launch.xml", {f"{FOLDER}/inner.launch.xml": starts.format(name).encode()}
        )
        for name in ("rviz2", "xacro", "rviz2")
    ]
    assert [[node.name for node in launch.nodes] for launch in launches] == [
        ["rviz2"],
        ["xacro"],
        ["rviz2"],
    ]
