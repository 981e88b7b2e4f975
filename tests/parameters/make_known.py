"""Write the parameters of controllers: `python -m tests.parameters.make_known CHECKOUT...`.

The arguments are clones of the repositories in SOURCES with the branches of their releases, which are
read with git and not checked out. The tables stand at the end of `grader/ros/known/packages/PACKAGE.toml`:
what the files of generate_parameter_library say, with what `by_hand.toml` beside this script adds.
Nothing of their descriptions is copied. What stands before them is kept.
"""

import re
import subprocess
import sys
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from math import isinf, isnan
from pathlib import Path
from typing import Any

import yaml

from grader.ros.known.parameter_rows import COVERED
from grader.ros.known.releases import Release
from tests.known.tables import write_tables

BY_HAND = Path(__file__).with_name("by_hand.toml")
_COMMENT = "# By python -m tests.parameters.make_known, of the branches of Humble to Lyrical.\n"
# Branches of other names than their releases: https://control.ros.org/rolling/doc/getting_started/getting_started.html and
# the distribution.yaml of each release in ros/rosdistro.
BRANCHES: Mapping[Release, str] = {"lyrical": "master"}
_STEERING = "steering_controllers_library/src/steering_controllers_library.yaml"
_GRIPPER = "gripper_controllers/src/gripper_action_controller_parameters.yaml"
_FORWARD = "forward_command_controller/src/forward_command_controller_parameters.yaml"
_MULTI = "forward_command_controller/src/multi_interface_forward_command_controller_parameters.yaml"
# By repository: the files of each node or type of controller.
SOURCES: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    "ros-controls/ros2_control": {
        "controller_manager/ros2_control_node": (
            "controller_manager/src/controller_manager_parameters.yaml",
        ),
    },
    "ros-controls/ros2_controllers": {
        "ackermann_steering_controller/AckermannSteeringController": (
            "ackermann_steering_controller/src/ackermann_steering_controller.yaml",
            _STEERING,
        ),
        "admittance_controller/AdmittanceController": (
            "admittance_controller/src/admittance_controller_parameters.yaml",
        ),
        "bicycle_steering_controller/BicycleSteeringController": (
            "bicycle_steering_controller/src/bicycle_steering_controller.yaml",
            _STEERING,
        ),
        "diff_drive_controller/DiffDriveController": (
            "diff_drive_controller/src/diff_drive_controller_parameter.yaml",
        ),
        "effort_controllers/GripperActionController": (_GRIPPER,),
        "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster": (
            "force_torque_sensor_broadcaster/src/force_torque_sensor_broadcaster_parameters.yaml",
        ),
        "forward_command_controller/ForwardCommandController": (_FORWARD,),
        "forward_command_controller/MultiInterfaceForwardCommandController": (_MULTI,),
        "gpio_controllers/GpioCommandController": (
            "gpio_controllers/src/gpio_command_controller_parameters.yaml",
        ),
        "gps_sensor_broadcaster/GPSSensorBroadcaster": (
            "gps_sensor_broadcaster/src/gps_sensor_broadcaster_parameters.yaml",
        ),
        "imu_sensor_broadcaster/IMUSensorBroadcaster": (
            "imu_sensor_broadcaster/src/imu_sensor_broadcaster_parameters.yaml",
        ),
        "joint_state_broadcaster/JointStateBroadcaster": (
            "joint_state_broadcaster/src/joint_state_broadcaster_parameters.yaml",
        ),
        "joint_trajectory_controller/JointTrajectoryController": (
            "joint_trajectory_controller/src/joint_trajectory_controller_parameters.yaml",
        ),
        "magnetometer_broadcaster/MagnetometerBroadcaster": (
            "magnetometer_broadcaster/src/magnetometer_broadcaster_parameters.yaml",
        ),
        "mecanum_drive_controller/MecanumDriveController": (
            "mecanum_drive_controller/src/mecanum_drive_controller.yaml",
        ),
        "omni_wheel_drive_controller/OmniWheelDriveController": (
            "omni_wheel_drive_controller/src/omni_wheel_drive_controller_parameters.yaml",
        ),
        "parallel_gripper_action_controller/GripperActionController": (
            "parallel_gripper_controller/src/gripper_action_controller_parameters.yaml",
        ),
        "pid_controller/PidController": ("pid_controller/src/pid_controller.yaml",),
        "pose_broadcaster/PoseBroadcaster": (
            "pose_broadcaster/src/pose_broadcaster_parameters.yaml",
        ),
        "position_controllers/GripperActionController": (_GRIPPER,),
        "range_sensor_broadcaster/RangeSensorBroadcaster": (
            "range_sensor_broadcaster/src/range_sensor_broadcaster_parameters.yaml",
        ),
        "tricycle_controller/TricycleController": (
            "tricycle_controller/src/tricycle_controller_parameter.yaml",
        ),
        "tricycle_steering_controller/TricycleSteeringController": (
            "tricycle_steering_controller/src/tricycle_steering_controller.yaml",
            _STEERING,
        ),
    },
}
_EVERY_CONTROLLER = "controller_interface/ControllerInterface"
_FIXED = re.compile(r"_fixed_\d+")
_MAP = "__map_"
# The validations whose argument is a bound, and the key of a row for it.
_BOUNDS = {
    "gt": "above",
    "lt": "below",
    "gt_eq": "min",
    "lt_eq": "max",
    "gt_eq_or_nan": "min",
    "lt_eq_or_nan": "max",
    "fixed_size": "size",
}
_BARE = re.compile(r"[A-Za-z0-9_-]+")
Row = dict[str, Any]
Rows = dict[str, Row]  # by the name of the parameter


def main(checkouts: Iterable[str]) -> None:
    """Write the tables of the nodes of these checkouts."""
    by_hand = tomllib.loads(BY_HAND.read_text("utf-8"))
    tables: dict[str, dict[str, dict[str, Any]]] = {}
    by_repository = {name_of(checkout): checkout for checkout in checkouts}
    if by_repository.keys() != SOURCES.keys():
        raise SystemExit(f"give a checkout of each of {', '.join(SOURCES)}")
    for repository, checkout in by_repository.items():
        for node, paths in SOURCES[repository].items():
            source = f"{repository}, {', '.join(paths)}"
            table = table_of({release: rows_in(checkout, paths, release) for release in COVERED})
            also = {} if node.endswith("_node") else {"also": [_EVERY_CONTROLLER]}
            read = {"read": COVERED[-1]}
            row = {"source": source, **also, **read, **table}
            tables.setdefault(package_of(node), {})[node] = row
    for node, added in by_hand.items():
        nodes = tables.setdefault(package_of(node), {})
        nodes[node] = with_additions(nodes.get(node, {}), added)
    for package, nodes in tables.items():
        texts = [text_of_node(node, table) for node, table in sorted(nodes.items())]
        write_tables(package, "".join([_COMMENT, *texts]))


def package_of(node: str) -> str:
    """Return the first part of the name of a node, after which its file is named."""
    return node.partition("/")[0]


def name_of(checkout: str) -> str:
    """Return the repository of a checkout."""
    parts = Path(checkout).resolve().parts
    for repository in SOURCES:
        owner, _, name = repository.partition("/")
        if f"{owner}+{name}" in parts or name in parts:
            return repository
    raise SystemExit(f"{checkout} is no checkout of {', '.join(SOURCES)}")


def rows_in(checkout: str, paths: Iterable[str], release: Release) -> Rows | None:
    """Return the parameters in the files of a release; None if it has none of them."""
    rows: Rows = {}
    found = False
    for path in paths:
        shown = subprocess.run(
            ["git", "-C", checkout, "show", f"{BRANCHES.get(release, release)}:{path}"],
            capture_output=True,
            check=False,
        )
        if shown.returncode == 0:
            found = True
            (tree,) = yaml.safe_load(shown.stdout).values()
            rows |= dict(rows_below(tree, ""))
    return rows if found else None


def rows_below(tree: Mapping[str, Any], above: str) -> Iterator[tuple[str, Row]]:
    """Yield the parameters in a table of generate_parameter_library, with their dotted names."""
    for key, value in tree.items():
        part = f"<{key.removeprefix(_MAP)}>" if key.startswith(_MAP) else key
        name = f"{above}.{part}" if above else part
        if not isinstance(value, dict):
            continue
        if isinstance(value.get("type"), str):
            if value["type"] != "none":
                yield name, row_of(value)
        else:
            yield from rows_below(value, name)


def row_of(written: Mapping[str, Any]) -> Row:
    """Return the row of a parameter, as a file of generate_parameter_library writes it."""
    row: Row = {"type": _FIXED.sub("", written["type"])}
    if "default_value" in written:
        row["default"] = default_of(written["default_value"], row["type"])
    row |= bounds_of(written.get("validation") or {})
    default = row.get("default")
    is_empty = row.pop("not_empty", False) and default in ([], "")
    is_low = "above" in row and isinstance(default, int | float) and default <= row["above"]
    if default is None or is_empty or is_low:
        row["required"] = True
    return row


def default_of(value: Any, kind: str) -> Any:
    """Return a default as a value of its type."""
    if kind == "double" and not isinstance(value, bool):
        return float(value)
    if kind == "double_array":
        return [*map(float, value)]
    return value


def bounds_of(validation: Mapping[str, Any]) -> Row:
    """Return the bounds among the validations of a parameter."""
    bounds: Row = {}
    for written, argument in validation.items():
        name = written.rpartition("::")[2].removesuffix("<>")
        values = argument if isinstance(argument, list) else [argument]
        if name in _BOUNDS:
            bounds[_BOUNDS[name]] = values[0]
        elif name == "bounds":
            bounds["min"], bounds["max"] = values
        elif name in ("one_of", "subset_of"):
            bounds[name] = values[0] if isinstance(values[0], list) else values
        elif name == "not_empty" or (name == "size_gt" and values[0] == 0):
            bounds["not_empty"] = True
    return bounds


def table_of(by_release: Mapping[Release, Rows | None]) -> dict[str, Any]:
    """Return the table of a node: each parameter in one row, or, where it changed, in one for each
    form.
    """
    having = [release for release, rows in by_release.items() if rows is not None]
    # A release between two that have a node has it too, in another form, which is not read.
    names: dict[str, None] = {}
    for release in reversed(having):
        names |= dict.fromkeys(by_release[release] or ())
    table: dict[str, Any] = {}
    if having[0] != COVERED[0]:
        table["since"] = having[0]
    if having[-1] != COVERED[-1]:
        table["until"] = having[-1]
    table["parameters"] = {}
    for name in names:
        forms: list[Row] = []
        last: Row | None = None
        for release in having:
            row = (by_release[release] or {}).get(name)
            if row is not None and row == last:
                forms[-1]["until"] = release
            elif row is not None:
                forms.append({**row, "since": release, "until": release})
            last = row
        for form in forms:
            if form["since"] == COVERED[0]:
                del form["since"]
            if form["until"] == COVERED[-1]:
                del form["until"]
        table["parameters"][name] = forms[0] if len(forms) == 1 else forms
    return table


def with_additions(table: Mapping[str, Any], added: Mapping[str, Any]) -> dict[str, Any]:
    """Return the table of a node with what is added by hand to its rows."""
    joined = {**table, **added}
    parameters = dict(table.get("parameters", {}))
    for name, keys in added.get("parameters", {}).items():
        before = parameters.get(name, {})
        if isinstance(before, list) and isinstance(keys, dict):
            parameters[name] = [form | keys for form in before]
        elif isinstance(before, list) or isinstance(keys, list):
            parameters[name] = keys
        else:
            parameters[name] = before | keys
    joined["parameters"] = parameters
    return joined


def text_of_node(node: str, table: Mapping[str, Any]) -> str:
    """Return the table of a node in TOML."""
    lines = ["", f'["{node}"]']
    for key, value in table.items():
        if key != "parameters":
            lines.append(f"{key} = {text_of(value)}")
    lines += ["", f'["{node}".parameters]']
    for name, row in table["parameters"].items():
        lines.append(f"{_key(name)} = {text_of(row)}")
    return "\n".join(lines) + "\n"


def text_of(value: Any) -> str:
    """Return a value in TOML."""
    match value:
        case bool():
            return str(value).lower()
        case float() if isnan(value):
            return "nan"
        case float() if isinf(value):
            return "inf" if value > 0 else "-inf"
        case int() | float():
            return str(value)
        case dict():
            return (
                "{ " + ", ".join(f"{_key(key)} = {text_of(it)}" for key, it in value.items()) + " }"
            )
        case list():
            return "[" + ", ".join(map(text_of, value)) + "]"
    escaped = str(value).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else f'"{name}"'


if __name__ == "__main__":
    main(sys.argv[1:])
