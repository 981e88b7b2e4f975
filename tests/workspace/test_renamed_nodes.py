"""Nodes that a launch file gives another name than their program: which section of a parameter file they get."""

import pytest

from tests.workspace.rovers import FILES, LAUNCH, MORE, PILOT, Edit, problems_of

pytestmark = pytest.mark.slow

_FILE, _SECOND = "config/pilot.yaml", "launch/second.launch.py"
_GIVEN = "PathJoinSubstitution([share, 'config', 'pilot.yaml'])"
_NODE = f"Node(package='rover', executable='pilot', name='front', parameters=[{_GIVEN}]),"
_PLAIN = _NODE.replace(" name='front',", "")
_PILOT = "pilot:\n  ros__parameters:\n    speed: 2.0\n"
_FRONT = _PILOT.replace("pilot", "front")
_ALL = _PILOT.replace("pilot", "/**")
_INIT = "        super().__init__('pilot')\n"
_SUBSTITUTIONS = "from launch.substitutions import Command"


def _given(file: str, started: str = _NODE, default: str = "1.0") -> list[Edit]:
    """Return the edits that start the pilot with a parameter file."""
    declared = (
        f"{_INIT}        self.declare_parameter('speed', {default}); self.get_parameter('speed')\n"
    )
    return [(_FILE, file, file), (PILOT, _INIT, declared), (LAUNCH, MORE, started)]


def _second(started: str) -> Edit:
    """Return another launch file, which starts a node."""
    text = FILES[f"rover/{LAUNCH}"].replace(MORE, started)
    return (_SECOND, text, text)


def _said(
    name: str, code: str = "REF004", old: str = "pilot", advice: str = "rename the section to"
) -> str:
    return (
        f"{code} {_FILE}:1 the launch file names this node {name!r}, so it ignores the section "
        f"{old!r}, its name in its program: {advice} {name!r}"
    )


_AMCL = _PLAIN.replace(
    "'rover', executable='pilot'", "'nav2_amcl', executable='amcl', name='front'"
)
WRONG: list[tuple[str, list[str], list[Edit]]] = [
    ("the name of the program", [_said("front")], _given(_PILOT)),
    ("a similar name", [_said("pilot2")], _given(_PILOT, _NODE.replace("front", "pilot2"))),
    ("with a section for all", [_said("front")], _given(_PILOT + _ALL)),
    (
        "a namespace",
        [_said("front")],
        _given(_PILOT.replace("pilot", "/a/pilot"), _NODE.replace("name=", "namespace='a', name=")),
    ),
    (
        "two names",
        [_said("front"), _said("back")],
        _given(_PILOT, _NODE + _NODE.replace("front", "back")),
    ),
    (
        "one of two names has a section",
        [_said("back")],
        _given(_PILOT + _FRONT, _NODE + _NODE.replace("front", "back")),
    ),
    (
        "another launch file has the name of the program",
        [_said("front", advice="add a section")],
        [*_given(_PILOT), _second(_PLAIN)],
    ),
    (
        "another launch file with a name that is not known",
        [_said("front")],
        [*_given(_PILOT), _second(_NODE.replace("'front'", "made()"))],
    ),
    ("the section of a well-known program", [_said("front", old="amcl")], _given(_PILOT.replace("pilot", "amcl").replace("speed: 2.0", "max_beams: 60"), _AMCL)),
    (
        "a parameter that is not declared",
        [f"REF004 {_FILE}:3 the node 'front': there is no parameter 'sped'; did you mean 'speed' (rover/rover/pilot.py:9)?"],
        _given(_FRONT.replace("speed", "sped")),
    ),
    (
        "a value of another type",
        [f"REF004 {_FILE}:3 the parameter 'speed' is given a string; its node declares a double (rover/rover/pilot.py:9), and stops"],
        _given(_FRONT.replace("2.0", "fast")),
    ),
    (
        "a parameter of the launch file that is not declared",
        ["REF004 launch/rover.launch.py:24 the node 'front': there is no parameter 'sped'; did you mean 'speed' (rover/rover/pilot.py:9)?"],
        _given(_FRONT, _NODE.replace(_GIVEN, f"{_GIVEN}, {{'sped': 2.0}}")),
    ),
]  # fmt: skip


@pytest.mark.parametrize(("problems", "edits"), [it[1:] for it in WRONG], ids=[it[0] for it in WRONG])  # fmt: skip
def test_a_section_that_a_renamed_node_does_not_get(problems: list[str], edits: list[Edit]) -> None:
    """The name that the launch file gives counts, and nothing else is reported."""
    assert problems_of(*edits) == problems


_COMPONENTS = (
    "ComposableNodeContainer(name='hall', namespace='', package='rclcpp_components', "
    "executable='component_container', composable_node_descriptions=[ComposableNode("
    f"package='halls', plugin='halls::Hall', name='pilot', parameters=[{_GIVEN}])]),"
)
_IMPORTS: list[Edit] = [
    (LAUNCH, "import Node\n", "import ComposableNodeContainer, Node\n"),
    (LAUNCH, "from launch_ros.substitutions", "from launch_ros.descriptions import ComposableNode\nfrom launch_ros.substitutions"),
]  # fmt: skip
_XML = "launch/second.launch.xml"
_XML_PARAMETERS = '<param from="$(find-pkg-share rover)/config/pilot.yaml"/>'
_XML_NODE = f'<node pkg="rover" exec="pilot" name="front">{_XML_PARAMETERS}</node>'
_XML_COMPONENTS = (
    '<node_container pkg="rclcpp_components" exec="component_container" name="hall" namespace="">'
    f'<composable_node pkg="halls" plugin="halls::Hall" name="pilot">{_XML_PARAMETERS}'
    "</composable_node></node_container>"
)


def _xml(text: str) -> list[Edit]:
    """Return a launch file in XML as the only one that starts the pilot."""
    text = f"<launch>{text}</launch>"
    return [*_given(_PILOT, MORE), (_XML, text, text)]


_CONTAINER = (
    f"Node(package='rclcpp_components', executable='component_container', parameters=[{_GIVEN}]),"
)
CORRECT: list[tuple[str, list[Edit]]] = [
    ("the name of the launch file", _given(_FRONT)),
    ("both names", _given(_PILOT + _FRONT)),
    ("both names, one in any namespace", _given(_PILOT + _FRONT.replace("front", "/**/front"))),
    ("no other name", _given(_PILOT, _PLAIN)),
    ("the same name", _given(_PILOT, _NODE.replace("front", "pilot"))),
    ("another node has the name", _given(_PILOT, _NODE + _PLAIN)),
    (
        "a name that is an argument",
        [
            *_given(_PILOT, _NODE.replace("'front'", "LaunchConfiguration('name')")),
            (LAUNCH, _SUBSTITUTIONS, f"{_SUBSTITUTIONS}, LaunchConfiguration"),
        ],
    ),
    (
        "a second node with a name that is not known",
        _given(_PILOT, _NODE + _NODE.replace("'front'", "made()")),
    ),
    (
        "a section for all, and another launch file with the name of the program",
        [*_given(_PILOT + _ALL), _second(_PLAIN)],
    ),
    (
        "a section for all, and another launch file with a component",
        [*_given(_PILOT + _ALL, _COMPONENTS), *_IMPORTS, _second(_NODE)],
    ),
    ("a container", _given(_PILOT, _NODE + _CONTAINER)),
    ("a component in XML", _xml(_XML_NODE + _XML_COMPONENTS)),
    (
        "a name that is an argument in XML",
        _xml(f'<arg name="name"/>{_XML_NODE.replace("front", "$(var name)")}'),
    ),
    ("a component", [*_given(_PILOT, _NODE + _COMPONENTS), *_IMPORTS]),
    (
        "another program of the same name that declares the parameter",
        _given(_FRONT, _NODE + _NODE.replace("executable='pilot'", "executable='horn'")),
    ),
    (
        "another program of the same name that is not known",
        _given(
            _FRONT.replace("speed", "sped"),
            _NODE + _NODE.replace("'rover', executable='pilot'", "'halls', executable='hall'"),
        ),
    ),
    ("a parameter of the other section", _given(_PILOT.replace("speed", "sped") + _FRONT)),
]  # fmt: skip


@pytest.mark.parametrize("edits", [it[1] for it in CORRECT], ids=[it[0] for it in CORRECT])
def test_sections_that_a_renamed_node_may_get(edits: list[Edit]) -> None:
    """The node gets its section, or what it gets is not known."""
    assert [it for it in problems_of(*edits) if "REF004" in it] == []


def test_a_node_that_a_launch_file_in_xml_renames() -> None:
    """Its sections are those of the name in <node>."""
    assert problems_of(*_xml(_XML_NODE)) == [_said("front")]


def test_a_parameter_that_no_program_of_a_name_declares() -> None:
    """Each of the two is given it, and the place is the same."""
    both = _NODE + _NODE.replace("executable='pilot'", "executable='horn'")
    edits = _given(_FRONT.replace("speed", "sped"), both)
    found = [it for it in problems_of(*edits) if "REF004" in it]
    said = f"REF004 {_FILE}:3 the node 'front': there is no parameter 'sped'"
    assert [it.partition(";")[0] for it in found] == [said, said]


def test_a_value_that_a_renamed_node_gets() -> None:
    """What it declares without a value, its section gives it, and no other."""
    declared = "rclpy.Parameter.Type.DOUBLE)\n        self.get_parameter('speed'"
    assert problems_of(*_given(_FRONT, default=declared)) == []
    lacks, stops = problems_of(*_given(_FRONT.replace("speed", "sped"), default=declared))
    assert lacks.startswith(f"REF004 {_FILE}:3 the node 'front': there is no parameter 'sped'")
    assert "the node 'front' stops without a value of the parameter 'speed'" in stops
