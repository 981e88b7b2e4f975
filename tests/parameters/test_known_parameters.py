"""What files give well-known nodes is compared with their rows, by release."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import pytest

from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.ros.known.package_files import FOLDER
from grader.ros.known.package_rows import usual_names
from grader.ros.known.parameter_rows import (
    COVERED,
    ParameterRow,
    find_rows,
    known_nodes,
    node_called,
    node_rows,
    row_for,
)
from grader.ros.known.releases import RELEASES, Release
from grader.workspace.opening.all_robots import read_workspace
from grader.workspace.rules.names import Mismatch
from grader.workspace.rules.reading import read_agreement
from tests.workspace.rovers import FILES

MAX_SIZE = 400 * 1024  # bytes of the rows in the wheel
_PACKAGE = ("package.xml", "setup.py", "setup.cfg", "resource/rover", "rover/__init__.py")
_PROGRAMS = ("rover/pilot.py", "rover/horn.py")  # of the entry points of setup.py
# The nodes whose rows are those of others, and which no program runs.
_BASES = ("rclcpp/node", "nav2_util/LifecycleNode", "controller_interface/ControllerInterface")
_TYPES: Mapping[str, tuple[Any, Any]] = {  # with a value, and one of another type
    "bool": (True, "text"),
    "int": (7, "text"),
    "double": (0.5, 7),
    "string": ("text", 7),
    "bool_array": ([True], ["text"]),
    "int_array": ([7], ["text"]),
    "double_array": ([0.5], [7]),
    "string_array": (["text"], [7]),
}
_WORD = re.compile(r"[a-z]{5,}")
Values = dict[str, Any]
NODES = [node for node in known_nodes() if node not in _BASES and find_rows(node)]


def _last_releases(node: str) -> Iterator[tuple[str, Release]]:
    """Yield a node with the last release of each of its rows."""
    known = node_rows(node)
    assert known is not None
    last = {min(row.until, known.until, known.read, key=RELEASES.index) for row in known.rows}
    yield from ((node, release) for release in sorted(last, key=RELEASES.index))


_CASES = [case for node in NODES for case in _last_releases(node)]


@pytest.mark.parametrize("node", known_nodes())
def test_rows_are_of_known_forms(node: str) -> None:
    """Rows name their source, their releases in order, and rows of the same node."""
    known = node_rows(node)
    assert known is not None
    assert known.source
    names = {row.name for row in known.rows}
    for row in known.rows:
        assert row.type in ("", *_TYPES), row
        assert RELEASES.index(row.since) <= RELEASES.index(row.until), row
        assert {*row.unless, row.only_with or row.name} <= names, row
    for release in COVERED:
        in_release = [row.name for row in known.in_release(release)]
        assert len(in_release) == len(set(in_release)), release


def test_the_rows_stay_small_and_all_of_a_package_are_in_its_file() -> None:
    """The wheel has at most 400 KB of rows; usual names are those of nodes with rows."""
    assert sum(path.stat().st_size for path in FOLDER.glob("*.toml")) < MAX_SIZE
    for node in [*known_nodes(), *usual_names().values()]:
        assert (FOLDER / f"{re.split('/|::', node)[0]}.toml").is_file()
        assert node_rows(node) is not None


@pytest.mark.parametrize(
    ("name", "node"),
    [
        ("amcl", "nav2_amcl/amcl"),
        ("ekf_node", "robot_localization/ekf_node"),
        ("DiffDriveController", "diff_drive_controller/DiffDriveController"),
        ("joint_trajectory_controller", "joint_trajectory_controller/JointTrajectoryController"),
        ("nav2_costmap_2d::VoxelLayer", "nav2_costmap_2d::VoxelLayer"),
        ("GripperActionController", None),  # of three packages
        ("driver", None),
    ],
)
def test_a_node_is_found_by_its_names(name: str, node: str | None) -> None:
    """A usual name, a class and a package of one class mean a node; several of one end do not."""
    assert node_called(name) == node


def test_a_row_is_that_of_the_release() -> None:
    """The newest row that has a name counts where no release is given."""
    node = "diff_drive_controller/DiffDriveController"
    assert row_for(node, "use_stamped_vel", "humble") is not None
    assert row_for(node, "use_stamped_vel", "jazzy") is None
    row = row_for(node, "linear.x.max_velocity")
    assert row is not None
    assert row.lower == 0.0
    assert row_for("robot_localization/ekf_node", "imu12_config") is not None
    assert row_for("nobody/nothing", "frequency") is None


@pytest.mark.parametrize(("node", "release"), _CASES, ids=[" ".join(case) for case in _CASES])
def test_each_row_is_asked_for(node: str, release: Release) -> None:
    """A right value is no problem; a misspelt name, another type and a missing value are one each:
    for each row in its last release.
    """
    variants = [*_variants(node, release)]
    found = _mismatches(node, [values for _, values in variants], release)
    expected = {f"n{number}": int(what != "right") for number, (what, _) in enumerate(variants)}
    counts = {f"n{number}": len(found.get(number, ())) for number in range(len(variants))}
    wrong = {
        name: (variants[int(name[1:])], found.get(int(name[1:])))
        for name in expected
        if counts[name] != expected[name]
    }
    assert not wrong, next(iter(wrong.values()))


def _variants(node: str, release: Release) -> Iterator[tuple[str, Values]]:
    """Yield the parameters of a node in a release, with each of the rows right and wrong for which
    it is the last one.
    """
    known = node_rows(node)
    assert known is not None
    rows = known.in_release(release)
    required: Values = {}
    for row in rows:
        if row.is_required or "<**>" in row.name:
            required |= _given(row, rows)
    yield "right", required
    for row in rows:
        if "<**>" in row.name or release not in (row.until, known.until):
            continue
        given = required | _given(row, rows)
        name = _name(row)
        yield "right", given
        rest = {key: value for key, value in given.items() if key != name}
        wrong = _misspelt(row, is_open=release in known.open_in)
        if wrong:
            yield "misspelt", {**rest, wrong: given[name]}
        # The entries of a list are parts of other names.
        has_entries = any("it" in key.split(".") for key in rest) and row.name in _lists(rows)
        is_asked_for = name != "use_sim_time"  # of every node, by other rules
        if row.type and not (known.takes_any_type or row.is_class or has_entries) and is_asked_for:
            other = _TYPES[row.type][1]
            if isinstance(other, list):
                other = other * len(given[name])
            yield "type", {**given, name: other}
        if row.is_required:
            yield "missing", rest


def _lists(rows: Sequence[ParameterRow]) -> set[str]:
    """Return the lists whose entries are parts of the names of rows."""
    return {place for row in rows for place in row.places}


def _misspelt(row: ParameterRow, *, is_open: bool) -> str:
    """Return the name of a row with a letter twice, in a word that is long enough to be surely
    meant; in another word where the node has no other parameters. Empty for a class.
    """
    if row.name.endswith((".type", ".plugin", "primary_controller")):
        return ""
    written = re.sub(r"<[^<>]+>", lambda it: "0" * len(it[0]), row.name)
    words = [*_WORD.finditer(written)] or ([] if is_open else [*re.finditer("[a-z]+", written)])
    return _name(row, misspelt=words[-1].span()) if words else ""


def _name(row: ParameterRow, misspelt: tuple[int, int] | None = None) -> str:
    """Return a name of a row, with a letter twice in the word at a span."""
    name = row.name
    if misspelt is not None:
        middle = (misspelt[0] + misspelt[1]) // 2
        name = name[:middle] + name[middle - 1] + name[middle:]
    return re.sub(r"<#>", "0", re.sub(r"<[^<>#]+>", "it", name))


def _given(row: ParameterRow, rows: Sequence[ParameterRow]) -> Values:
    """Return a value for a row, with those that it needs."""
    values: Values = {} if "<**>" in row.name else {_name(row): _valid(row)}
    lists = {other.name: other for other in rows}
    if row.type == "string" and row.name in _lists(rows):  # its value is a part of other names
        values[row.name] = "it"
    for place in row.places:
        if place in lists:
            values[place] = "it" if lists[place].type == "string" else ["it"]
    if row.only_with:
        values[_name(row._replace(name=row.only_with))] = "text"
    for switch, value in row.unless.items():
        if switch in lists:
            values[_name(row._replace(name=switch))] = value
    return values


def _valid(row: ParameterRow) -> Any:
    if row.one_of or row.entries:
        items = [*row.one_of, *row.entries]
        return items[0] if row.one_of else items[:1]
    if row.is_class:
        return "nav2_navfn_planner::NavfnPlanner"
    if row.name == "robot_description":
        return "<robot/>"
    value = _TYPES[row.type][0] if row.type else "text"
    if row.upper is not None and isinstance(value, float) and row.upper < value:
        return float(row.upper)
    if row.size is not None or row.name.endswith("#>_config"):  # which another rule counts
        return value * (row.size or 15)
    return value


def _mismatches(
    node: str, variants: Sequence[Values], release: Release
) -> dict[int, list[Mismatch]]:
    """Return what is wrong with the parameters of some nodes of one kind, by their numbers."""
    names = [f"n{number}" for number in range(len(variants))]
    package, _, program = node.partition("/")
    sections, manager = [], ""
    lines: list[int] = [0]
    if "::" in node:
        variants = [
            {"planner_plugins": ["own"], "own.plugin": node}
            | {f"own.{name}": value for name, value in values.items()}
            for values in variants
        ]
        package, program = "nav2_planner", "planner_server"
    is_controller = "::" not in node and program[0].isupper()
    if is_controller:
        types = "".join(f"    {name}:\n      type: {node}\n" for name in names)
        manager = f"controller_manager:\n  ros__parameters:\n{types}"
    for name, values in zip(names, variants, strict=True):
        written = "".join(f"    {key}: {_yaml(value)}\n" for key, value in values.items())
        sections.append(f"{name}:\n  ros__parameters:\n    use_sim_time: false\n{written}")
        lines.append(lines[-1] + sections[-1].count("\n"))
    if is_controller:
        words = ", ".join(map(repr, [*names, "--param-file"]))
        started = (
            f"Node(package='controller_manager', executable='spawner', arguments=[{words}, given])"
        )
    else:
        started = (
            f"*[Node(package='{package}', executable='{program}', name=f'n{{number}}', "
            f"parameters=[given]) for number in range({len(names)})]"
        )
    found: dict[int, list[Mismatch]] = {}
    first = manager.count("\n")
    for mismatch in _wrong(manager + "".join(sections), started, release):
        if mismatch.location.path.endswith("nodes.yaml"):
            line = mismatch.location.line - 1
            number = sum(start <= line - first for start in lines) - 1
            if line < first:  # of the type of a controller
                number = (line - 2) // 2
        else:  # of what is missing
            said = re.match(r"'n(\d+)' stops", mismatch.message)
            assert said is not None, mismatch
            number = int(said[1])
        found.setdefault(number, []).append(mismatch)
    return found


def _wrong(nodes: str, started: str, release: Release) -> list[Mismatch]:
    """Return what is wrong with a parameter file of a workspace whose launch file starts nodes."""
    files = {f"rover/{name}": FILES[f"rover/{name}"] for name in (*_PACKAGE, *_PROGRAMS)}
    files["rover/config/nodes.yaml"] = nodes
    files["rover/launch/nodes.launch.py"] = _LAUNCH.replace("STARTED", started)
    tree = overlaid(make_tree("ws", (), ()), {path: it.encode() for path, it in files.items()})
    workspace = replace(read_workspace(tree, "ws", URDF_LIMIT, {}).workspace, releases=(release,))
    return [it for it in read_agreement(workspace).mismatches if it.family == "parameters"]


@pytest.mark.parametrize(
    ("nodes", "started"),
    [
        (  # values for any node, of which a controller is one
            (
                "/**:\n  ros__parameters:\n    robots: 2\n"
                "controller_manager:\n  ros__parameters:\n"
                "    wheels:\n      type: joint_state_broadcaster/JointStateBroadcaster\n"
                "wheels:\n  ros__parameters:\n    use_local_topics: true\n"
            ),
            (
                "Node(package='controller_manager', executable='spawner', "
                "arguments=['wheels', '--param-file', given])"
            ),
        ),
        (  # a node whose name only its program has: each section may be its own
            "somebody:\n  ros__parameters:\n    robots: 2\n",
            ("Node(package='urg_node2', executable='urg_node2_node', parameters=[given])"),
        ),
        (  # a name of several nodes
            "/**:\n  ros__parameters:\n    robots: 2\n",
            (
                "*[Node(package='nav2_smoother', executable='smoother_server', name=f'n{i}', "
                "parameters=[given]) for i in range(2)]"
            ),
        ),
        (  # so many unknown names are those of another program
            "n0:\n  ros__parameters:\n" + "".join(f"    own_{i}: 1\n" for i in range(5)),
            (
                "Node(package='nav2_smoother', executable='smoother_server', name='n0', "
                "parameters=[given])"
            ),
        ),
        (  # more plugins than are read
            "n0:\n  ros__parameters:\n    planner_plugins: ["
            + ", ".join(f"p{i}" for i in range(150))
            + "]\n"
            + "".join(
                f"    p{i}:\n      plugin: nav2_navfn_planner::NavfnPlanner\n      own: 1\n"
                for i in range(150)
            ),
            (
                "Node(package='nav2_planner', executable='planner_server', name='n0', "
                "parameters=[given])"
            ),
        ),
    ],
    ids=["any node", "no name", "several nodes", "another program", "many plugins"],
)
def test_what_may_be_another_nodes_is_not_reported(nodes: str, started: str) -> None:
    """A name that another node may have, or a node of another source, is no mistake."""
    assert [it.message for it in _wrong(nodes, started, "jazzy")] == []


def _yaml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return "[" + ", ".join(map(_yaml, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_yaml(it)}" for key, it in value.items()) + "}"
    return f"'{value}'" if isinstance(value, str) else str(value)


_LAUNCH = """\
from launch import LaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    given = PathJoinSubstitution([FindPackageShare('rover'), 'config', 'nodes.yaml'])
    return LaunchDescription([STARTED])
"""


@pytest.mark.parametrize(
    ("node", "release", "values", "messages"),
    [
        (
            "robot_localization/ekf_node",
            "humble",
            {"twist0_config": [True] * 15, "twist0_relative": True},
            [
                "'n0' does not use twist0_config without twist0",
                "'n0' has no parameter 'twist0_relative'",
            ],
        ),
        (
            "diff_drive_controller/DiffDriveController",
            "humble",
            {"left_wheel_names": ["text"], "right_wheel_names": ["text"]}
            | {"wheel_separation": 0.3, "wheel_radius": 0.0, "linear.x.max_velocity": 1.0}
            | {"angular.z.max_velocity": 0.0},  # off, as its switch
            [
                "the parameter 'wheel_radius' is 0; 'n0' needs more than 0, and stops",
                (
                    "'n0' does not use linear.x.max_velocity: linear.x.has_velocity_limits is "
                    "false, by default"
                ),
            ],
        ),
        (
            "nav2_bt_navigator/bt_navigator",
            "jazzy",
            {"plugin_lib_names": ["nav2_spin_action_bt_node", "own_bt_node"]},
            [
                (
                    "'n0' loads nav2_spin_action_bt_node itself, and stops where plugin_lib_names "
                    "has the same: list only other libraries"
                )
            ],
        ),
        (
            "nav2_bt_navigator/bt_navigator",
            "humble",
            {"plugin_lib_names": ["nav2_spin_action_bt_node", "nav2_is_stopped_condition_bt_node"]},
            ["'n0' stops: Humble has no library 'nav2_is_stopped_condition_bt_node'"],
        ),
        ("nav2_bt_navigator/bt_navigator", "foxy", {"plugin_lib_names": 1, "frequncy": 1}, []),
        (
            "nav2_velocity_smoother/velocity_smoother",
            "jazzy",
            {"feedback": "NONE AT ALL", "own": {"table": 1, "other": 2}},
            [
                "the parameter 'feedback' is 'NONE AT ALL'; 'n0' needs 'OPEN_LOOP' or 'CLOSED_LOOP', and stops",
                "'n0' has no parameter 'own'",
            ],
        ),
        (
            "joint_trajectory_controller/JointTrajectoryController",
            "jazzy",
            {"joints": ["a"], "command_interfaces": ["positon"], "state_interfaces": ["position"]}
            | {"gains.b.p": 1.0, "gains.b.d": 1.0},
            [
                "the parameter 'command_interfaces' is ['positon']; 'n0' knows no 'positon' there, and stops",
                "'n0' has no parameter 'gains.b'",
            ],
        ),
        (  # a limit that is off is not read, whatever its type
            "moveit_ros_move_group/move_group",
            "jazzy",
            {
                f"robot_description_planning.joint_limits.{joint}.{name}": value
                for joint, is_limited in (("a", False), ("b", True))
                for name, value in (
                    ("has_acceleration_limits", is_limited),
                    ("max_acceleration", 0),
                )
            },
            [
                (
                    "the parameter 'robot_description_planning.joint_limits.b.max_acceleration' is "
                    "given an integer; 'n0' declares a double, and stops"
                )
            ],
        ),
        (  # solvers have their own parameters
            "moveit_ros_move_group/move_group",
            "humble",
            {
                f"robot_description_kinematics.{group}.{name}": value
                for group, solver in (
                    ("a", "trac_ik_kinematics_plugin/TRAC_IKKinematicsPlugin"),
                    ("b", "kdl_kinematics_plugin/KDLKinematicsPlugin"),
                )
                for name, value in (("kinematics_solver", solver), ("epsilon", "1e-5"))
            },
            [
                (
                    "the parameter 'robot_description_kinematics.b.epsilon' is given a string; 'n0' "
                    "declares a double, and stops"
                )
            ],
        ),
        ("slam_toolbox/sync_slam_toolbox_node", "jazzy", {"robots": 2}, []),  # may have more
        (
            "slam_toolbox/sync_slam_toolbox_node",
            "kilted",
            {"robots": 2},
            ["'n0' has no parameter 'robots'"],
        ),
        (
            "amcl_of_somebody/amcl",
            "jazzy",
            {"frequncy": 1},
            [],
        ),
    ],
)
def test_what_a_node_does_with_a_value(
    node: str, release: Release, values: Values, messages: list[str]
) -> None:
    """A value without effect, beyond its bounds, or of a table that there is not, is one problem."""
    found = _mismatches(node, [values], release).get(0, [])
    assert sorted(it.message for it in found) == sorted(messages)
