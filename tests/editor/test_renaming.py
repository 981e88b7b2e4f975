"""A rename changes each place of a name, and nothing becomes wrong."""

import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest
from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.app.editor.renaming import CannotRenameError, renamed
from grader.app.editor.session import EditorSession
from grader.app.editor.text_ranges import TextRanges
from grader.workspace.index.written_names import WrittenName
from tests.command_line import ROOT

# With how many names are renamed, and how many are refused.
_WORKSPACES = {
    "rubrics/diffdrive": (27, 5),
    "rubrics/lab6": (15, 1),
    "tests/editor/cart": (22, 8),
    "tests/labs/beacon": (13, 6),
    "tests/labs/gripper": (7, 1),
    "tests/labs/laundry": (16, 7),
    "tests/labs/twolink": (37, 10),
}
_REFUSALS = (
    "from parts: change it there",
    "would cause a problem at",
    "not all places that use",
    "is not renamed here",
    "may have this",
    "would keep",
)
_CART = ROOT / "tests/editor/cart"
_LAUNCH = "cart_bringup/launch/cart.launch.py"
_BRIDGE = "cart_bringup/config/bridge.yaml"
_NODES = "cart_bringup/config/nodes.yaml"
_ROBOT = "cart_description/urdf/cart.urdf.xacro"
_CONTROLLERS = "cart_description/config/controllers.yaml"
_FILTER = "cart_nodes/cart_nodes/filter.py"
_DRIVER = "cart_nodes/cart_nodes/driver.py"
_WATCH = "cart_watch/src/watch.cpp"
_XML, _YAML, _RVIZ, _MUX = (
    f"cart_bringup/{path}"
    for path in (
        "launch/more.launch.xml",
        "launch/more.launch.yaml",
        "config/cart.rviz",
        "config/mux.yaml",
    )
)
# Parts of the workspace that are replaced by others.
_LINK, _SCAN, _TOPIC = '"lidar_link", tf2', '("scan_in", "scan_raw")', '"obstacle", self'
_DRIVER_NODE = 'Node(package="cart_nodes", executable="driver")'
_TELEOP = (
    'Node(package="teleop_twist_keyboard", executable="teleop_twist_keyboard", '
    f'remappings=[("cmd_vel", "/cmd_vel")]),\n            {_DRIVER_NODE}'
)
_MUX_NODE = (
    'Node(package="twist_mux", executable="twist_mux", '
    'parameters=[os.path.join(share, "config", "mux.yaml")], '
    f'remappings=[("cmd_vel_out", "/wheel_controller/cmd_vel")]),\n            {_DRIVER_NODE}'
)
_STATIC = (
    'Node(package="tf2_ros", executable="static_transform_publisher", arguments=["--frame-id", '
    f'"lidar_link", "--child-frame-id", "extra"]),\n            {_DRIVER_NODE}'
)
_FILTERED = (
    'Node(package="robot_localization", executable="ekf_node", name="ekf_filter_node", '
    f'parameters=[os.path.join(share, "config", "ekf.yaml")]),\n            {_DRIVER_NODE}'
)
_LINK_NAME = 'link name="lidar_link"'
_REMAPPED = 'remappings=[("/wheel_controller/cmd_vel", "/cmd_vel")],'
_WHEELS = '"wheel_controller", "joint_state_broadcaster"]'
_DECLARED = 'super().__init__("driver")\n        self.declare_parameter("topic", "{}")'
_ASKED = 'self.get_parameter("topic").value, self'
_FROM_XML = """<launch>
  <node pkg="cart_nodes" exec="filter" name="filter2">
    <param name="max_range" value="3.0"/>
    <remap from="scan_in" to="scan_raw"/>
    <remap from="obstacle" to="/cmd/obstacle"/>
  </node>
</launch>
"""
_FROM_YAML = """launch:
- node:
    pkg: cart_nodes
    exec: filter
    name: filter2
    remap:
    - from: scan_in
      to: scan_raw
"""
_SHOWN = """Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/LaserScan
      Enabled: true
      Name: Scan
      Topic:
        Value: /scan_raw
"""
_MIXED = """twist_mux:
  ros__parameters:
    use_stamped: true
    topics:
      navigation:
        topic: /cmd_vel
        timeout: 0.5
        priority: 10
"""


def _place(look: Look, root: Path, name: WrittenName) -> TextPlace:
    at = name.location
    return TextPlace(root, at.path, TextRanges(look, root).lines(at.path), at.line, at.column)


def _texts(root: Path, look: Look, edit: lsp.WorkspaceEdit) -> dict[str, str]:
    """Return the files that an edit changes, after it."""
    texts = {}
    for uri, changes in (edit.changes or {}).items():
        path = uri.removeprefix(root.as_uri() + "/")
        source = look.opened.source(path)
        assert source is not None
        lines = source.text.split("\n")
        for change in sorted(changes, key=lambda it: it.range.start, reverse=True):
            row, start, end = (
                change.range.start.line,
                change.range.start.character,
                change.range.end.character,
            )
            lines[row] = lines[row][:start] + change.new_text + lines[row][end:]
        texts[path] = "\n".join(lines)
    return texts


def _rename_all(root: Path) -> tuple[int, list[str]]:
    """Rename names of a workspace, each in files as they are; return how many, and the refusals."""
    look = EditorSession(root).look()
    problems = [(it.rule.id, it.location.path, it.location.line) for it in look.findings]
    done, refused = 0, []
    for name in look.names.holding("", 1_000):
        try:
            edit = renamed(look, _place(look, root, name), f"{name.name}_new")
        except CannotRenameError as error:
            refused.append(f"{name.kind} {name.name}: {error}")
            continue
        assert edit is not None
        session = EditorSession(root)
        for path, text in _texts(root, look, edit).items():
            session.files.type(path, text)
        after = session.look()
        found = [(it.rule.id, it.location.path, it.location.line) for it in after.findings]
        assert sorted(found) == sorted(problems), name
        done += 1
    return done, refused


def test_renames_a_link_everywhere() -> None:
    root = ROOT / "rubrics/lab6"
    look = EditorSession(root).look()
    [link] = [it for it in look.names.holding("base_link", 10) if it.name == "base_link"]
    edit = renamed(look, _place(look, root, link), "chassis")
    assert edit is not None
    [(path, text)] = _texts(root, look, edit).items()
    assert path == "my_robot/urdf/my_robot.urdf"
    assert text.count('"chassis"') == 6
    assert '"base_link"' not in text


@pytest.mark.slow
@pytest.mark.parametrize(("folder", "expected"), _WORKSPACES.items())
def test_renames_are_proven(folder: str, expected: tuple[int, int]) -> None:
    done, refused = _rename_all(ROOT / folder)
    assert [it for it in refused if not any(why in it for why in _REFUSALS)] == []
    assert (done, len(refused)) == expected


def test_refuses_a_name_that_is_there() -> None:
    root = ROOT / "rubrics/lab6"
    look = EditorSession(root).look()
    [link] = [it for it in look.names.holding("base_link", 10) if it.name == "base_link"]
    with pytest.raises(CannotRenameError, match="there is a link 'lidar' already"):
        renamed(look, _place(look, root, link), "lidar")
    for wrong in ("", "two words", "a<b", "$(x)"):
        with pytest.raises(CannotRenameError, match="is no name"):
            renamed(look, _place(look, root, link), wrong)


def test_refuses_what_is_made_of_parts() -> None:
    root = ROOT / "rubrics/diffdrive"
    look = EditorSession(root).look()
    name = look.names.at("diffdrive_robot/config/controllers.yaml", 13, 30)
    assert name is not None
    with pytest.raises(CannotRenameError, match="builds the name 'left_wheel_joint' from parts"):
        renamed(look, _place(look, root, name), "other_joint")


def _rename_at(root: Path, path: str, text: str, inside: int, new: str) -> dict[str, list[int]]:
    """Rename the name at a text in a copy of the cart; return the lines that change, by files."""
    look = EditorSession(root).look()
    source = look.opened.source(f"src/{path}")
    assert source is not None
    at = source.at(source.text.index(text) + inside)
    place = TextPlace(root, at.path, TextRanges(look, root).lines(at.path), at.line, at.column)
    edit = renamed(look, place, new)
    assert edit is not None and edit.changes is not None
    return {
        uri.rpartition("/")[2]: [each.range.start.line + 1 for each in changes]
        for uri, changes in edit.changes.items()
    }


def _changed_cart(folder: Path, edits: Sequence[tuple[str, str, str]]) -> Path:
    """Return a copy of the cart, with texts in place of others, or new files."""
    root = Path(shutil.copytree(_CART, folder / "ws")).resolve()
    for path, old, new in edits:
        file = root / "src" / path
        text = file.read_text() if old else ""
        assert old in text, (path, old)
        file.write_text(text.replace(old, new) if old else new)
    return root


@pytest.mark.slow
@pytest.mark.parametrize(
    ("edits", "place", "expected"),
    [
        # topics
        ((), (_BRIDGE, '"scan_raw"', 2, "laser"), {"bridge.yaml": [1], "cart.launch.py": [47]}),
        ((), (_LAUNCH, '"scan_in"', 2, "laser"), {"filter.py": [13], "cart.launch.py": [47]}),
        ((), (_WATCH, '"obstacle", 10', 2, "/bump"), {"driver.py": [11], "filter.py": [12], "watch.cpp": [16]}),
        ([(_DRIVER, _TOPIC, 'PREFIX + "obstacle", self'), (_DRIVER, "class D", 'PREFIX = ""\n\n\nclass D')],
         (_FILTER, '"obstacle"', 2, "bump"), {"driver.py": [14], "filter.py": [12], "watch.cpp": [16]}),
        ([(_DRIVER, _TOPIC, "TOPIC, self"), (_DRIVER, "class D", 'TOPIC = "obstacle"\n\n\nclass D')],
         (_FILTER, '"obstacle"', 2, "bump"), {"driver.py": [7], "filter.py": [12], "watch.cpp": [16]}),
        ([(_LAUNCH, f"[{_SCAN}]", "rules"), (_LAUNCH, "    return L", f"    rules = [{_SCAN}]\n    return L")],
         (_BRIDGE, '"scan_raw"', 2, "laser"), {"bridge.yaml": [1], "cart.launch.py": [16]}),
        ([(_DRIVER, _TOPIC, _ASKED), (_DRIVER, 'super().__init__("driver")', _DECLARED.format("obstacle"))],
         (_FILTER, '"obstacle"', 2, "bump"), {"driver.py": [10], "filter.py": [12], "watch.cpp": [16]}),
        ([(_DRIVER, _TOPIC, _ASKED), (_DRIVER, 'super().__init__("driver")', _DECLARED.format("x")),
          (_LAUNCH, 'executable="driver"', 'executable="driver", parameters=[{"topic": "/obstacle"}]')],
         (_FILTER, '"obstacle"', 2, "bump"), {"cart.launch.py": [49], "filter.py": [12], "watch.cpp": [16]}),
        ([(_LAUNCH, 'executable="driver"', 'executable="driver", namespace="a"'), (_LAUNCH, 'name="filter",', 'name="filter", namespace="a",'),
          (_LAUNCH, 'executable="watch",', 'executable="watch", remappings=[("obstacle", "/a/obstacle")],'), (_NODES, "filter:", "/a/filter:")],
         (_FILTER, '"obstacle"', 2, "bump"), {"cart.launch.py": [52], "driver.py": [11], "filter.py": [12]}),
        ([(_XML, "", _FROM_XML)], (_FILTER, '"scan_in"', 2, "laser"), {"cart.launch.py": [47], "more.launch.xml": [4], "filter.py": [13]}),
        ([(_YAML, "", _FROM_YAML)], (_FILTER, '"scan_in"', 2, "laser"), {"cart.launch.py": [47], "more.launch.yaml": [7], "filter.py": [13]}),
        ([(_RVIZ, "", _SHOWN)], (_BRIDGE, '"scan_raw"', 2, "laser"), {"bridge.yaml": [1], "cart.launch.py": [47], "cart.rviz": [7]}),
        ([(_LAUNCH, _DRIVER_NODE, f'SetRemap(src="obstacle", dst="bump"),\n            {_DRIVER_NODE}'),
          (_LAUNCH, "actions import Node", "actions import Node, SetRemap"), (_WATCH, '"obstacle", 10', '"bump", 10')],
         (_WATCH, '"bump"', 2, "thing"), {"cart.launch.py": [49], "watch.cpp": [16]}),
        ([(_LAUNCH, _DRIVER_NODE, _TELEOP)],
         (_DRIVER, '"/cmd_vel"', 3, "drive"), {"cart.launch.py": [40, 49], "driver.py": [10]}),
        ([(_MUX, "", _MIXED), (_LAUNCH, _REMAPPED, ""), (_LAUNCH, _DRIVER_NODE, _MUX_NODE)],
         (_DRIVER, '"/cmd_vel"', 3, "drive"), {"mux.yaml": [6], "driver.py": [10]}),
        ([(_BRIDGE, '"scan_raw"', '"scan"'), (_LAUNCH, 'parameters=[{"config_file": os.path.join(share, "config", "bridge.yaml")}],',
           'arguments=["/scan_raw@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan"],')],
         (_LAUNCH, "/scan_raw@", 3, "laser"), {"cart.launch.py": [34, 47], "cart.urdf.xacro": [47]}),
        # links, also in code
        ((), (_ROBOT, _LINK_NAME, 12, "laser"), {"cart.urdf.xacro": [26, 29, 45, 48], "filter.py": [21], "watch.cpp": [26]}),
        ([(_WATCH, _LINK, "FRAME, tf2"), (_WATCH, "class W", '#define FRAME "lidar_link"\nclass W')],
         (_ROBOT, _LINK_NAME, 12, "laser"), {"cart.urdf.xacro": [26, 29, 45, 48], "filter.py": [21], "watch.cpp": [9]}),
        ([(_WATCH, _LINK, "kFrame.c_str(), tf2"), (_WATCH, "class W", 'static const std::string kFrame = "lidar_link";\nclass W')],
         (_ROBOT, _LINK_NAME, 12, "laser"), {"cart.urdf.xacro": [26, 29, 45, 48], "filter.py": [21], "watch.cpp": [9]}),
        ([(_LAUNCH, _DRIVER_NODE, _STATIC)],
         (_ROBOT, _LINK_NAME, 12, "laser"), {"cart.launch.py": [49], "cart.urdf.xacro": [26, 29, 45, 48], "filter.py": [21], "watch.cpp": [26]}),
        ([(_FILTER, 'frame_id = "lidar_link"', 'frame_id = "lidar_link"  # the "lidar_link"'), ("README.md", "", "the frame `lidar_link`")],
         (_ROBOT, _LINK_NAME, 12, "laser"), {"cart.urdf.xacro": [26, 29, 45, 48], "filter.py": [21], "watch.cpp": [26]}),
        ([("cart_bringup/config/ekf.yaml", "", "ekf_filter_node:\n  ros__parameters:\n    base_link_frame: base_link\n    odom0: /wheel_controller/odom\n"),
          (_LAUNCH, _DRIVER_NODE, _FILTERED)],
         (_ROBOT, 'link name="base_link"', 12, "chassis"),
         {"ekf.yaml": [3], "controllers.yaml": [15], "cart.urdf.xacro": [3, 11, 18, 25], "driver.py": [15], "watch.cpp": [26]}),
        # controllers and nodes, also in names of topics
        ((), (_LAUNCH, '"wheel_controller"', 2, "wheels"), {"cart.launch.py": [39, 40], "controllers.yaml": [6, 9]}),
        ([(_DRIVER, '"/cmd_vel"', '"/wheel_controller/cmd_vel"'), (_LAUNCH, _REMAPPED, "")],
         (_LAUNCH, '"wheel_controller"', 2, "wheels"), {"cart.launch.py": [39], "controllers.yaml": [6, 9], "driver.py": [10]}),
        ([(_LAUNCH, _REMAPPED, ""), (_LAUNCH, _WHEELS, f'{_WHEELS[:-1]}, "--controller-ros-args", "-r /wheel_controller/cmd_vel:=/cmd_vel"]')],
         (_LAUNCH, '"wheel_controller"', 2, "wheels"), {"cart.launch.py": [39, 39], "controllers.yaml": [6, 9]}),
        ([(_LAUNCH, _REMAPPED, ""), (_LAUNCH, _WHEELS, f'{_WHEELS[:-1]}, "--controller-ros-args", "-r /wheel_controller/cmd_vel:=/cmd_vel"]')],
         (_DRIVER, '"/cmd_vel"', 3, "drive"), {"cart.launch.py": [39], "driver.py": [10]}),
        ((), (_NODES, "filter:", 2, "sieve"), {"cart.launch.py": [45], "filter.py": [9], "nodes.yaml": [1]}),
        # parameters
        ((), (_WATCH, '"limit"', 2, "bound"), {"cart.launch.py": [53], "watch.cpp": [14, 22]}),
        ((), (_NODES, "min_range", 2, "low"), {"filter.py": [10, 16], "nodes.yaml": [3]}),
        ([(_NODES, "filter:", "/**:")], (_FILTER, '"min_range"', 2, "low"), {"filter.py": [10, 16], "nodes.yaml": [3]}),
        ([(_XML, "", _FROM_XML)], (_FILTER, '"max_range"', 2, "high"), {"cart.launch.py": [46], "filter.py": [11, 17], "more.launch.xml": [3]}),
        ([(_LAUNCH, 'parameters=[{"limit": 0.5}]', 'arguments=["--ros-args", "-p", "limit:=0.5"]')],
         (_WATCH, '"limit"', 2, "bound"), {"cart.launch.py": [53], "watch.cpp": [14, 22]}),
    ],
)  # fmt: skip
def test_renames_in_all_files(
    tmp_path: Path,
    edits: Sequence[tuple[str, str, str]],
    place: tuple[str, str, int, str],
    expected: dict[str, list[int]],
) -> None:
    assert _rename_at(_changed_cart(tmp_path, edits), *place) == expected


@pytest.mark.slow
@pytest.mark.parametrize(
    ("edits", "place", "reason"),
    [
        ([(_DRIVER, _TOPIC, "sys.argv[1], self"), (_DRIVER, "import rclpy\n", "import sys\n\nimport rclpy\n")],
         (_FILTER, '"obstacle"', 2, "bump"), r"driver.py:13 may have this topic: a subscription of driver has a name that is computed"),
        ([(_LAUNCH, _SCAN, '("scan_in", LaunchConfiguration("scan"))'),
          (_LAUNCH, "DeclareLaunchArgument(", 'DeclareLaunchArgument("scan", default_value="scan_raw"),\n            DeclareLaunchArgument(')],
         (_BRIDGE, '"scan_raw"', 2, "laser"), r"cart.launch.py:43 may have this topic: a remapping of cart_nodes/filter is computed"),
        ([(_LAUNCH, _DRIVER_NODE, f'Node(package="teleop_twist_keyboard", executable="teleop_twist_keyboard"),\n            {_DRIVER_NODE}')],
         (_DRIVER, '"/cmd_vel"', 3, "drive"), r"cart.launch.py:49 may have this topic: /teleop_twist_keyboard has a publisher of this name"),
        ([(_FILTER, 'message.header.frame_id = "lidar_link"', 'self.fill(message, "lidar_link")')],
         (_ROBOT, _LINK_NAME, 12, "laser"), r"filter.py:21 would keep 'lidar_link': it is not known what is named there"),
        ([(_FILTER, 'frame_id = "lidar_link"', 'frame_id = f"{self.side}_link"')],
         (_ROBOT, _LINK_NAME, 12, "laser"), r"filter.py:21 may have this link: code makes a frame of parts"),
        ([(_BRIDGE, "scan_raw", "other"), (_LAUNCH, _DRIVER_NODE, f'Node(package="lidar_driver", executable="lidar"),\n            {_DRIVER_NODE}')],
         (_LAUNCH, '"scan_raw"', 2, "laser"), r"cart.launch.py:49 may have this topic: what lidar_driver/lidar opens is not known"),
        ([(_FILTER, 'self.get_parameter("min_range").value', "read(self)"), (_FILTER, "import rclpy\n", "import rclpy\n\nfrom cart_nodes.helper import read\n"),
          ("cart_nodes/cart_nodes/helper.py", "", 'def read(node):\n    return node.get_parameter("min_range").value\n')],
         (_FILTER, '"min_range"', 2, "low"), r"helper.py:2 would keep 'min_range'"),
        ([("cart_bringup/config/nav.yaml", "", "a:\n  ros__parameters:\n    progress_checker_plugins: [fast]\n    one: fast\n    fast:\n      plugin: nav2_controller::SimpleProgressChecker\n")],
         ("cart_bringup/config/nav.yaml", "[fast]", 2, "slow"), r"nav.yaml:4 would keep 'fast'"),
        ([(_LAUNCH, '"limit": 0.5', '"limit": 0.5, "use_sim_time": True')], (_LAUNCH, '"use_sim_time": True', 3, "simulated"),
         r"no code declares the parameter 'use_sim_time'"),
        ((), (_LAUNCH, '"/cmd_vel"', 3, "obstacle"), r"there is a topic 'obstacle' already, at .*driver.py:11"),
        ((), (_LAUNCH, '"cart_nodes"', 3, "other"), r"a package is not renamed here"),
        ((), (_LAUNCH, 'executable="driver"', 13, "other"), r"a program is not renamed here"),
        ((), (_LAUNCH, '"nodes.yaml"', 3, "other"), r"a file is not renamed here"),
        ((), (_FILTER, "import Obstacle", 8, "Other"), r"a message type is not renamed here"),
    ],
)  # fmt: skip
def test_refuses_with_the_reason(
    tmp_path: Path,
    edits: Sequence[tuple[str, str, str]],
    place: tuple[str, str, int, str],
    reason: str,
) -> None:
    with pytest.raises(CannotRenameError, match=reason):
        _rename_at(_changed_cart(tmp_path, edits), *place)


def test_refuses_what_changes_something_else(tmp_path: Path) -> None:
    """The frame of a display is that of a controller by default, which no file writes."""
    root = Path(shutil.copytree(ROOT / "rubrics/diffdrive", tmp_path / "ws")).resolve()
    file = root / "diffdrive_robot/config/controllers.yaml"
    for is_written in (True, False):
        look = EditorSession(root).look()
        frame = look.names.at("diffdrive_robot/rviz/diffdrive.rviz", 21, 19)
        assert frame is not None
        place = _place(look, root, frame)
        if is_written:
            edit = renamed(look, place, "world")
            assert edit is not None and len(edit.changes or {}) == 2
            file.write_text(file.read_text().replace("    odom_frame_id: odom\n", ""))
        else:
            with pytest.raises(CannotRenameError, match=r"yaml:8 would have 'base_footprint'"):
                renamed(look, place, "world")
