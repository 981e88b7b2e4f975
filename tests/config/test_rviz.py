"""Reading RViz files: the fixed frame, the enabled displays, and problems."""

import pytest

from grader.ros.config.rviz import RvizFile, read_rviz
from tests.examples import spread
from tests.work import limited_work

# As RViz of ROS 2 Jazzy saves it, without irrelevant parts.
SAVED = """\
Panels:
  - Class: rviz_common/Displays
    Help Height: 78
    Name: Displays
Visualization Manager:
  Class: ""
  Displays:
    - Alpha: 0.5
      Cell Size: 1
      Class: rviz_default_plugins/Grid
      Enabled: true
      Name: Grid
      Value: true
    - Alpha: 1
      Class: rviz_default_plugins/RobotModel
      Description File: ""
      Description Source: Topic
      Description Topic:
        Depth: 5
        Value: /robot_description
      Enabled: true
      Links:
        All Links Enabled: true
        base_link:
          Alpha: 1
          Show Axes: false
      Name: "My robot: the model"
      Value: true
    - Class: rviz_default_plugins/TF
      Enabled: false
      Name: TF
      Value: false
    - Class: rviz_common/Group
      Displays:
        - Class: rviz_default_plugins/Axes
          Enabled: true
          Name: Axes
        - Class: rviz_common/Group
          Displays:
            - Class: rviz_default_plugins/LaserScan
              Enabled: true
              Name: Scan
          Enabled: false
          Name: Off
      Enabled: true
      Name: Group
  Enabled: true
  Global Options:
    Background Color: 48; 48; 48
    Fixed Frame: base_footprint
    Frame Rate: 30
  Name: root
Window Geometry:
  Height: 846
"""


def read(text: str) -> RvizFile:
    """Return an RViz file with this text."""
    return read_rviz(text.encode(), "rviz/a.rviz")


def displays(*entries: str) -> RvizFile:
    """Return an RViz file with these displays, each a flow mapping."""
    listed = "".join(f"    - {{{entry}}}\n" for entry in entries)
    return read(
        f"Visualization Manager:\n  Displays:\n{listed}  Global Options: {{Fixed Frame: base_link}}\n"
    )


def test_a_saved_file() -> None:
    """All relevant settings are found, with groups flattened."""
    found = read(SAVED)
    assert found.fault is None
    assert found.fixed_frame == "base_footprint"
    assert SAVED.splitlines()[found.frame_location.line - 1] == "    Fixed Frame: base_footprint"
    assert found.frame_location.column == 18
    assert [
        (display.package, display.kind, display.name, display.enabled) for display in found.displays
    ] == [
        ("rviz_default_plugins", "Grid", "Grid", True),
        ("rviz_default_plugins", "RobotModel", "My robot: the model", True),
        ("rviz_default_plugins", "TF", "TF", False),
        ("rviz_common", "Group", "Group", True),
        ("rviz_default_plugins", "Axes", "Axes", True),
        ("rviz_common", "Group", "Off", False),
        ("rviz_default_plugins", "LaserScan", "Scan", False),
    ]
    lines = SAVED.splitlines()
    assert all(
        lines[display.location.line - 1].endswith(f"Class: {display.package}/{display.kind}")
        for display in found.displays
    )
    assert len({display.location for display in found.displays}) == 7
    topic = found.displays[1].node.get("Description Topic", "Value")
    assert topic is not None
    assert topic.text == "/robot_description"


def test_problems() -> None:
    """A TF display that is disabled counts as missing; a ROS 1 class is reported at its location."""
    assert [problem.kind.code for problem in read(SAVED).problems] == ["RVZ003"]
    old = displays(
        "Class: rviz/RobotModel, Enabled: true", "Class: rviz/TF, Enabled: true, Name: TF"
    )
    assert [(problem.kind.code, problem.location.line) for problem in old.problems] == [
        ("RVZ002", 3),
        ("RVZ002", 4),
    ]
    assert "in ROS 2 it is rviz_default_plugins/RobotModel" in old.problems[0].message
    assert displays("Class: rviz_default_plugins/TF, Enabled: true").problems == ()


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("Visualization Manager: [", 1, "not readable as YAML"),
        ("\tVisualization Manager:", 1, "not readable as YAML"),
        ("", 1, "there is no 'Visualization Manager'"),
        ("- a", 1, "there is no 'Visualization Manager'"),
        ("<robot/>", 1, "there is no 'Visualization Manager'"),
        ("Visualization manager: {}", 1, "there is no 'Visualization Manager'"),
    ],
)
def test_faults(text: str, line: int, words: str) -> None:
    """A file that is no RViz file is reported once, and gives nothing else."""
    found = read(text)
    assert [problem.kind.code for problem in found.problems] == ["RVZ001"]
    assert found.fault is not None
    assert words in found.fault.message
    assert found.fault.location.line == line
    assert found.fixed_frame is None
    assert found.displays == ()


@pytest.mark.parametrize(
    "text",
    [
        "Visualization Manager:",
        "Visualization Manager: 3",
        "Visualization Manager: []",
        "Visualization Manager: {Displays: 3, Global Options: []}",
        "Visualization Manager: {Displays: {a: b}, Global Options: {Fixed Frame: [a]}}",
        "Visualization Manager: {Displays: [1, [], {}, ~, {Class: [a]}, {Class: {a: b}}, {Displays: 3}], Global Options: 4}",
    ],
)
def test_odd_shapes(text: str) -> None:
    """Lists in place of mappings, and the other way round, contain nothing."""
    found = read(text)
    assert found.fault is None
    assert found.fixed_frame is None
    assert all(
        display.kind == display.package == "" and not display.enabled for display in found.displays
    )


@pytest.mark.parametrize(
    ("settings", "is_on"),
    [
        ("Enabled: true", True),
        ("Enabled: True", True),
        ("Enabled: 1", True),
        ("Enabled: 'true'", True),
        ("Enabled: yes", True),
        ("Enabled: false", False),
        ("Enabled: FALSE", False),
        ("Enabled: 0", False),
        ("Enabled: ''", False),
        ("Enabled: ", False),
        ("Name: a", False),
        ("Enabled: false, Value: true", False),
        ("Enabled: true, Value: false", True),
    ],
)
def test_enabled(settings: str, is_on: bool) -> None:
    """A display is enabled exactly if RViz enables it."""
    assert [display.enabled for display in displays(f"Class: a/B, {settings}").displays] == [is_on]


def test_settings_of_displays() -> None:
    """A missing setting, or one that is a list, is on; RViz reads every text but false and 0 as on."""
    settings = {"[a]": True, "no": True, "off": True, "0": False, "0.0": True, "false": False}
    for text, is_on in settings.items():
        [display] = displays(f"Class: a/B, Shown: {text}").displays
        assert (display.is_on("Shown"), display.is_on("Other")) == (is_on, True)


def test_class_without_a_package() -> None:
    """A class is split at its last slash."""
    found = displays("Class: RobotModel", "Class: a/b/C", "Class: ''").displays
    assert [(display.package, display.kind) for display in found] == [
        ("", "RobotModel"),
        ("a/b", "C"),
        ("", ""),
    ]


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    spread(
        [
            "Visualization Manager:\n  Displays: &a\n    - Displays: *a\n    - Displays: *a\n",
            "Visualization Manager:\n  Displays: &a\n" + "    - Displays: *a\n" * 900,
            "Visualization Manager:\n  Displays: &a ["
            + "{Displays: *a}, " * 900
            + "b, " * 80_000
            + "]\n",
            "Visualization Manager:\n  Displays:\n" + "    - Class: a/B\n" * 20_000,
            "Visualization Manager: &a {Displays: [*a, *a], Global Options: *a}",
        ],
        2,
    ),
)
def test_endless_groups(text: str) -> None:
    """Groups in themselves, and thousands of displays, are read up to a bound."""
    with limited_work(9_000_000):
        found = read(text)
        assert len(found.displays) <= 500
        assert isinstance(found.problems, tuple)
