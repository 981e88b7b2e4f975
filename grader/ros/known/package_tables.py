"""What one reader needs of a package: the tables after the facts in the files of some packages."""

from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple, cast

from grader.ros.known.package_files import tables_in_file
from grader.ros.known.releases import Release
from grader.ros.known.typed_rows import read_typed


class _BridgeTable(NamedTuple):
    """What the bridges of ros_gz_bridge accept."""

    directions: tuple[str, ...]
    keys: tuple[str, ...]  # that a row needs
    types: Mapping[str, tuple[str, ...]]  # of Gazebo, by those of ROS


class _CreateTable(NamedTuple):
    """The options of the program create of ros_gz_sim."""

    options: tuple[str, ...]
    sources: tuple[str, ...]  # of a model
    older: Mapping[str, str]  # options of spawn_entity.py, with what they are called


class _CppTable(NamedTuple):
    """What programs in C++ use of rclcpp and tf2_ros; the file says what each is."""

    nodes: frozenset[str]  # classes
    other_bases: frozenset[str]
    without_nodes: frozenset[str]  # how the names of classes begin
    reading: frozenset[str]
    harmless: frozenset[str]
    macros: frozenset[str]  # how their names begin
    options: frozenset[str]
    profiles: Mapping[str, str]  # of quality of service: depth, reliability, durability


class _PythonTable(NamedTuple):
    """What nodes in Python use."""

    node_attributes: frozenset[str]  # public ones of rclpy's nodes
    modules: frozenset[str]  # of packages of ROS 2, in any release
    of_ros1: frozenset[str]  # modules that no release has


class StartRow(NamedTuple):
    """A node or an include that a launch function of MoveIt starts.

    "$name" is the value of a launch argument, {package} the folder of the configuration, {folder}
    the one that a launch file gives in its place.
    """

    node: str = ""  # package/program
    include: str = ""
    optional: bool = False  # whether the included file may lack
    only_if: str = ""  # a launch argument is true
    debug: bool = False  # whether it is started with or without a debugger
    arguments: tuple[Any, ...] = ()
    parts: tuple[str, ...] = ()  # of the configuration
    parameters: Mapping[str, Any] = {}
    files: tuple[str, ...] = ()
    remappings: tuple[tuple[str, ...], ...] = ()


class _LaunchFunction(NamedTuple):
    """A function of moveit_configs_utils.launches."""

    start: tuple[StartRow, ...]
    flags: Mapping[str, str] = {}  # launch arguments that are true or false, with their defaults
    arguments: Mapping[str, str] = {}  # other launch arguments


INTERFACE_KINDS = ("msg", "srv", "action")
_Words = Mapping[str, str]
_Signatures = Mapping[str, Mapping[Release, str]]
TABLES: Mapping[str, Mapping[str, Any]] = {  # the types of the tables of each package
    "cv_bridge": {"encodings": Mapping[str, int]},
    "image_transport": {"transports": _Words},
    "moveit_configs_utils": {"launches": Mapping[str, _LaunchFunction]},
    "moveit_simple_controller_manager": {"actions": _Words},
    "rclcpp": {"cpp": _CppTable},
    "rclpy": {"python": _PythonTable, "calls": _Signatures},
    "ros_gz_bridge": {"bridge": _BridgeTable},
    "ros_gz_sim": {"create": _CreateTable},
    "rviz_default_plugins": {"displays": _Words},
    "tf2_ros": {"calls": _Signatures},
}


def interface_table(package: str) -> Mapping[str, Mapping[str, Any]] | None:
    """Return the messages, services and actions of a package, by kind and name.

    The result is None for a package without any.
    """
    tables = tables_in_file(package)
    kinds = {kind: tables[kind] for kind in INTERFACE_KINDS if kind in tables}
    return kinds or None


@cache
def _table(package: str, name: str) -> Any:
    return read_typed(TABLES[package][name], tables_in_file(package)[name])


def colour_encodings() -> Mapping[str, int]:
    """Return the encodings of images with colours, with how many channels they have."""
    return cast("Mapping[str, int]", _table("cv_bridge", "encodings"))


def transport_types() -> _Words:
    """Return the types of the topics of image_transport, by their last word."""
    return cast("_Words", _table("image_transport", "transports"))


def launch_functions() -> Mapping[str, _LaunchFunction]:
    """Return what each of the launch functions of MoveIt starts, by its name."""
    return cast("Mapping[str, _LaunchFunction]", _table("moveit_configs_utils", "launches"))


def moveit_actions() -> _Words:
    """Return the actions of MoveIt, by the types of controllers in moveit_controllers.yaml."""
    return cast("_Words", _table("moveit_simple_controller_manager", "actions"))


def cpp_table() -> _CppTable:
    """Return what programs in C++ use of rclcpp and tf2_ros."""
    return cast("_CppTable", _table("rclcpp", "cpp"))


def python_table() -> _PythonTable:
    """Return what nodes in Python use of rclpy."""
    return cast("_PythonTable", _table("rclpy", "python"))


def bridge_table() -> _BridgeTable:
    """Return what the bridges of ros_gz_bridge accept."""
    return cast("_BridgeTable", _table("ros_gz_bridge", "bridge"))


def create_table() -> _CreateTable:
    """Return the options of the program create of ros_gz_sim."""
    return cast("_CreateTable", _table("ros_gz_sim", "create"))


def display_types() -> _Words:
    """Return the types of messages that displays of rviz_default_plugins read."""
    return cast("_Words", _table("rviz_default_plugins", "displays"))


def call_signatures() -> _Signatures:
    """Return the parameters of what nodes in Python call, by the release in which they changed."""
    tables = [_table(package, "calls") for package in ("rclpy", "tf2_ros")]
    return {name: row for table in tables for name, row in table.items()}
