"""Names where they are written: the places that an editor goes to, and that a rename changes."""

from collections import Counter, defaultdict
from pathlib import Path

import pytest

from grader.base.extents import ended
from grader.base.source import Location, Source
from grader.files.tree import Tree, make_tree, overlaid
from grader.ros.package.robot_file import Read
from grader.workspace.index.all_names import WorkspaceNames, read_names
from grader.workspace.index.written_names import Role, WrittenName, span_of_name
from grader.workspace.opening.all_robots import read_workspace
from grader.workspace.opening.opened import OpenedWorkspace
from grader.workspace.opening.opening import open_workspace

pytestmark = pytest.mark.slow

_ROOT = Path(__file__).parent.parent.parent
_CART = _ROOT / "tests" / "corpus" / "given" / "cartkit"
_SAMPLES = sorted(path.parent for path in (_ROOT / "submissions").glob("*/*/expected.toml"))
_LABS = sorted(path.parent for path in (_ROOT / "rubrics").glob("*/rubric.toml"))
_SIZE = 1_000_000


def _text_at(tree: Tree, at: Location) -> str:
    source = Source(at.path, (tree.read(at.path, _SIZE) or b"").decode("utf-8", "replace"))
    start = source.offset(at.line, at.column)
    return source.text[start : source.offset(at.end_line, at.end_column)]


def _opened(files: dict[str, str]) -> OpenedWorkspace:
    tree = overlaid(make_tree("ws", (), ()), {path: text.encode() for path, text in files.items()})
    return read_workspace(tree, "ws", _SIZE, {})


@pytest.mark.parametrize("folder", [*_LABS, _CART, *_SAMPLES], ids=lambda it: it.name)
def test_the_text_at_a_place_is_the_name(folder: Path) -> None:
    """In every lab and sample, what is between the start and the end of a place is the name, or an
    expression that makes it. A file is at its start.
    """
    opened = open_workspace(str(folder), _SIZE, {})
    for name in read_names(opened.workspace).names:
        text = _text_at(opened.whole_tree, name.location)
        if name.kind in ("file", "program") and (name.role, text) == ("definition", ""):
            at = name.location  # the file itself
            assert (name.is_made, at.line, at.column) == (True, 1, 1)
            assert at.path in opened.whole_tree.files
            continue
        assert text.strip() == text != ""
        assert (text != name.name) == name.is_made, (name, text)


@pytest.mark.parametrize("folder", [*_LABS, _CART, *_SAMPLES], ids=lambda it: it.name)
def test_what_a_finding_is_about_is_in_the_file(folder: Path) -> None:
    """The end of each finding of a lab or sample is in its file, and not before its start."""
    opened = open_workspace(str(folder), _SIZE, {})
    problems = [*opened.package_problems()]
    for robot in opened.robots:
        if isinstance(robot, Read):
            problems += opened.find_problems(robot)
    for problem in problems:
        at = ended(problem.location, opened.source)
        source = opened.source(at.path)
        assert source is not None
        start, end = source.offset(at.line, at.column), source.offset(at.end_line, at.end_column)
        assert start <= end <= len(source.text)
        meant = source.text[start:end]
        begins_here = source.text[start : start + 1].strip() != ""
        assert meant == meant.strip()
        assert bool(meant) == begins_here


_URDF = """<robot name="bot">
  <material name="grey"><color rgba="1 1 1 1"/></material>
  <link name="base"><visual><geometry><sphere radius="1"/></geometry>
    <material name="grey"/></visual></link>
  <link name="arm"/>
  <link name="hand"/>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="arm"/></joint>
  <joint name="wrist" type="continuous">
    <parent link="arm"/><child link="hand"/><mimic joint="shoulder"/></joint>
  <gazebo reference="hand"><mu1>1</mu1></gazebo>
  <gazebo reference="wrist"><x/></gazebo>
  <transmission name="t"><type>x</type><joint name="wrist"/></transmission>
  <ros2_control name="s" type="system"><hardware><plugin>a/B</plugin></hardware>
    <joint name="shoulder"><command_interface name="position"/></joint></ros2_control>
</robot>
"""
_MANIFEST = (
    '<package format="3"><name>bot</name><version>1.0.0</version><description>d</description>'
    '<maintainer email="a@b.c">a</maintainer><license>MIT</license></package>\n'
)


def _written(opened: OpenedWorkspace, path: str = "") -> list[str]:
    """Return the names as the kind, the role, the name, its line, and the text if it is made."""
    rows = []
    for it in read_names(opened.workspace).names:
        if it.location.path.endswith(path):
            text = f" = {_text_at(opened.whole_tree, it.location)}" if it.is_made else ""
            rows.append(f"{it.kind} {it.role} {it.name} {it.location.line}{text}")
    return rows


def test_links_joints_and_materials_are_used_in_a_urdf() -> None:
    """Parents, children, mimic, Gazebo, transmissions, ros2_control and materials are uses."""
    assert _written(_opened({"bot.urdf": _URDF})) == [
        "material definition grey 2",
        "link definition base 3",
        "material use grey 4",
        "link definition arm 5",
        "link definition hand 6",
        "joint definition shoulder 7",
        "link use base 7",
        "link use arm 7",
        "joint definition wrist 8",
        "link use arm 9",
        "link use hand 9",
        "joint use shoulder 9",
        "link use hand 10",
        "joint use wrist 11",
        "joint use wrist 12",
        "plugin use a/B 13",
        "joint use shoulder 14",
    ]


_XACRO = """<robot name="bot" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="size" default="2"/>
  <xacro:property name="radius" value="$(arg size)"/>
  <xacro:macro name="wheel" params="side:=left radius *origin">
    <xacro:property name="half" value="${radius / 2}"/>
    <link name="${side}_wheel"/>
    <joint name="${side}_joint" type="fixed">
      <xacro:insert_block name="origin"/>
      <parent link="base"/><child link="${side}_wheel"/></joint>
  </xacro:macro>
  <link name="base"/> <!-- ${radius} -->
  <xacro:wheel side="left" radius="${2 * radius}"><origin xyz="0 $${radius} 0"/></xacro:wheel>
</robot>
"""


def test_names_of_xacro_are_where_they_are_written() -> None:
    """Arguments, properties, macros and parameters; a parameter hides the property of its name, and
    comments and escapes are no uses.
    """
    opened = _opened({"bot.urdf.xacro": _XACRO.replace("0 $${radius} 0", "0 0 ${radius}")})
    assert _written(opened) == [
        "xacro argument definition size 2",
        "xacro property definition radius 3",
        "xacro argument use size 3",
        "xacro macro definition wheel 4",
        "xacro parameter definition side 4",
        "xacro parameter definition radius 4",
        "xacro parameter definition origin 4",
        "xacro parameter definition half 5",
        "xacro parameter use radius 5",
        "link definition left_wheel 6 = ${side}_wheel",
        "xacro parameter use side 6",
        "joint definition left_joint 7 = ${side}_joint",
        "xacro parameter use side 7",
        "xacro parameter use origin 8",
        "link use base 9",
        "link use left_wheel 9 = ${side}_wheel",
        "xacro parameter use side 9",
        "link definition base 11",
        "xacro macro use wheel 12",
        "xacro parameter use side 12",
        "xacro parameter use radius 12",
        "xacro property use radius 12",
        "xacro property use radius 12",
        "xacro macro use wheel 12",
    ]


_LAUNCH = {
    "launch/a.launch.py": (
        "from launch import LaunchDescription\n"
        "from launch.actions import DeclareLaunchArgument\n"
        "from launch.substitutions import LaunchConfiguration\n"
        "def generate_launch_description():\n"
        "    gui = LaunchConfiguration('gui')\n"
        "    é = LaunchConfiguration(variable_name=r'gui')\n"
        "    return LaunchDescription([DeclareLaunchArgument('gui', default_value='x')])\n"
    ),
    "launch/b.launch.xml": (
        '<launch><arg name="gui" default="1"/>\n'
        '<!-- $(var gui) -->\n<log message="$(var gui)"/></launch>\n'
    ),
    "launch/c.launch.yaml": (
        "launch:\n- arg:\n    name: gui\n    default: x\n- log: {message: $(var gui)} # $(var gui)\n"
    ),
}


def test_arguments_of_launch_files_are_where_they_are_written() -> None:
    """Declarations and uses in Python, XML and YAML; those of one file are no others'."""
    opened = _opened({"package.xml": _MANIFEST, **_LAUNCH})
    assert _written(opened, ".py") == [
        "launch argument use gui 5",
        "launch argument use gui 6",
        "launch argument definition gui 7",
    ]
    assert _written(opened, ".launch.xml") == [
        "launch argument definition gui 1",
        "launch argument use gui 3",
    ]
    assert _written(opened, ".yaml") == [
        "launch argument definition gui 3",
        "launch argument use gui 5",
    ]
    names = read_names(opened.workspace)
    arguments = [it for it in names.names if it.kind == "launch argument"]
    assert len({it.owner for it in arguments}) == 3
    assert {it.location.path for it in names.same_as(arguments[0])} == {"launch/a.launch.py"}


def test_names_belong_to_their_robot() -> None:
    """Two robots with equal names have each their own, unless they share a file; all robots of a
    workspace are there.
    """
    part = (
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/><link name="lid"/>'
        '<joint name="j" type="fixed"><parent link="base"/><child link="lid"/></joint></robot>\n'
    )
    whole = (
        '<robot name="{}" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:include filename="part.xacro"/></robot>\n'
    )
    opened = _opened(
        {
            "a/a.urdf": _URDF,
            "b/b.urdf": _URDF,
            "c/part.xacro": part,
            "c/c.urdf.xacro": whole.format("c"),
            "c/d.urdf.xacro": whole.format("d"),
        }
    )
    names = read_names(opened.workspace)
    assert {it.owner for it in names.names if it.kind in ("link", "joint")} == {
        "a/a.urdf",
        "b/b.urdf",
        "c/c.urdf.xacro",
        "c/d.urdf.xacro",
    }
    [base] = names.at("a/a.urdf", 3, 15)
    assert {it.location.path for it in names.same_as(base)} == {"a/a.urdf"}
    [shared, also] = names.at("c/part.xacro", 1, part.index("base") + 1)
    assert shared.owner != also.owner
    assert set(names.same_as(shared)) == set(names.same_as(also))
    assert {it.location.path for it in names.same_as(shared)} == {"c/part.xacro"}


_NOT_ALONE = {
    # A topic and a controller, whose topics are named after it, are renamed on one side only: the
    # other side is in another node.
    "topic",
    "controller",
    "parameter",
    "plugin section",
    "node",
    "group",
    # These are also names of files, of builds or of other packages, and are never renamed.
    "file",
    "package",
    "plugin",
    "program",
}


@pytest.mark.parametrize("folder", [*_LABS, _CART], ids=lambda it: it.name)
def test_a_name_that_is_renamed_at_all_its_places_still_agrees(folder: Path) -> None:
    """Nothing is wrong that was not, whichever link, joint, material, argument or name of xacro is
    renamed: no use is missed that anything compares.
    """
    opened = open_workspace(str(folder), _SIZE, {})
    names, before = read_names(opened.workspace), _problems(opened)
    renamed: set[frozenset[Location]] = set()
    for name in names.names:
        group = names.same_as(name)
        places = frozenset(it.location for it in group)
        is_alone = name.role == "definition" and name.kind not in _NOT_ALONE
        if not is_alone or places in renamed or any(it.is_made for it in group):
            continue
        renamed.add(places)
        after = _problems(_renamed(opened, group, f"{name.name}_qjz"))
        assert not after - before, name
    assert renamed


def _renamed(opened: OpenedWorkspace, group: tuple[WrittenName, ...], new: str) -> OpenedWorkspace:
    places: dict[str, set[Location]] = defaultdict(set)
    for it in group:
        places[it.location.path].add(it.location)
    texts: dict[str, bytes] = {}
    for path, of_file in places.items():
        text = (opened.whole_tree.read(path, _SIZE) or b"").decode()
        source = Source(path, text)
        for at in sorted(of_file, reverse=True):
            end = source.offset(at.end_line, at.end_column)
            text = text[: source.offset(at.line, at.column)] + new + text[end:]
        texts[path] = text.encode()
    tree = overlaid(opened.whole_tree, texts)
    return read_workspace(tree, opened.id, _SIZE, {})


def _problems(opened: OpenedWorkspace) -> Counter[tuple[str, str, int]]:
    found = [*opened.package_problems()]
    for robot in opened.robots:
        if isinstance(robot, Read):
            found += opened.find_problems(robot)
    return Counter((it.code, it.location.path, it.location.line) for it in found)


def test_a_place_without_a_name_has_none() -> None:
    """Only the name itself is one, with the place after its last character."""
    at = Location("a.urdf", 1, 5, end_line=1, end_column=9)
    names = WorkspaceNames([WrittenName("link", "base", "definition", at)])
    found = [column for column in range(1, 12) if names.at("a.urdf", 1, column)]
    assert found == [5, 6, 7, 8, 9]
    assert not names.at("b.urdf", 1, 5)


def _span_text(path: str, text: str, kind: str, name: str, role: Role = "use") -> str | None:
    """Return the text of a name in what begins at the mark in a text."""
    start = text.index("«")
    source = Source(path, text.replace("«", ""))
    span = span_of_name(source, source.at(start), kind, name, role)
    return None if span is None else source.text[slice(*span)]


@pytest.mark.parametrize(
    ("path", "text", "kind", "name", "written"),
    [
        ("a.xml", '«<node exec="s" args="arm --p $(var f)"/>', "controller", "arm", "arm"),
        ("a.xml", '«<node args="0 $(var arm)/x"/>', "controller", "arm", "0 $(var arm)/x"),
        ("a.xml", "<a><b>«<f>\n camera </f></b></a>", "frame", "camera", "camera"),
        ("a.xml", '«<node pkg="a" exec="a"/>', "joint", "b", None),
        (
            "a.xml",
            '«<include file="a"><arg name="gui" value="gui"/></include>',
            "launch argument",
            "gui",
            "gui",
        ),
        ("a.xml", "<a b=«'/left arm/'/>", "frame", "left", "left"),
        ("a.yaml", "arm:\n  type: «a/B\n", "controller", "arm", "arm"),
        ("a.yaml", "arm: {x: 1}\nleg:\n  type: «a/B\n", "controller", "arm", None),
        ("a.yaml", "m:\n  'arm':\n  # no\n\n    - type: «a/B\n", "controller", "arm", "arm"),
        ("a.yaml", "m:\n- arm: 1\n- type: «a/B\n", "controller", "arm", None),
        ("a.yaml", "arm:\n- x: 1\n- type: «a/B\n", "controller", "arm", "arm"),
        ("a.yaml", "- arm:\n    x: 1\n    type: «a/B\n", "controller", "arm", "arm"),
        ("a.yaml", 'x: «"/base"\n', "frame", "base", "base"),
        ("a.py", "«Node(name='a', arguments=['a'])", "controller", "a", "a"),
        ("a.py", "«Node(arguments=[f'{x}'])", "controller", "a", "Node"),
        ("a.py", "«Command(['xacro', ' f:=', f])", "xacro argument", "f", "f"),
        ("a.py", "«process(f, mappings={'f': '1'})", "xacro argument", "f", "f"),
        ("a.py", "{'rate': «LaunchConfiguration('rate')}", "parameter", "rate", "rate"),
        ("a.cpp", "x = «node->create(\"a\", /* ( */ 'b');", "topic", "/a", "a"),
        ("a.py", "«class A(Node):\n  'use_sim_time'", "parameter", "use_sim_time", None),
    ],
)
def test_a_name_is_found_in_what_a_fact_is_about(
    path: str, text: str, kind: str, name: str, written: str | None
) -> None:
    """The name is the attribute, text, key or argument of that name, else what makes it."""
    assert _span_text(path, text, kind, name) == written


def test_a_node_that_is_started_has_its_name_in_one_argument() -> None:
    """A program of the same name is another one; without a name the call makes it."""
    call = "«Node(package='amcl', executable='amcl'{})"
    assert _span_text("a.py", call.format(""), "node", "amcl", "definition") == "Node"
    named = call.format(", name='amcl'")
    start = named.replace("«", "").rindex("amcl")
    source = Source("a.py", named.replace("«", ""))
    span = span_of_name(source, source.at(0), "node", "amcl", "definition")
    assert span == (start, start + 4)
    xml = '«<node exec="amcl"/>'
    assert _span_text("a.xml", xml, "node", "amcl", "definition") is None
