"""What one reader needs of a package: the tables after the facts in the files of some packages."""

from collections.abc import Mapping
from functools import cache
from typing import Any, cast

from grader.base.grouping import Strings, StringsByName
from grader.base.records import Named
from grader.ros.known.package_files import tables_in_file
from grader.ros.known.releases import Release
from grader.ros.known.typed_rows import read_typed

_Texts = Strings

_Names = frozenset[str]


class _BridgeTable(Named):
    """What the bridges of ros_gz_bridge accept."""

    directions: _Texts
    keys: _Texts  # that a row needs
    types: Mapping[str, _Texts]  # of Gazebo, by those of ROS


class _CreateTable(Named):
    """The options of the program create of ros_gz_sim."""

    options: _Texts
    sources: _Texts  # of a model
    older: StringsByName  # options of spawn_entity.py, with what they are called


class _CppTable(Named):
    """What programs in C++ use of rclcpp and tf2_ros; the file says what each is."""

    nodes: _Names  # classes
    other_bases: _Names
    without_nodes: _Names  # how the names of classes begin
    reading: _Names
    harmless: _Names
    macros: _Names  # how their names begin
    options: _Names
    profiles: StringsByName  # of quality of service: depth, reliability, durability


class _PythonTable(Named):
    """What nodes in Python use."""

    node_attributes: _Names  # public ones of rclpy's nodes
    of_foxy: _Names  # those that only nodes of Foxy have
    modules: _Names  # of packages of ROS 2, in any release
    of_ros1: _Names  # modules that no release has
    members: Mapping[str, _Names]  # the attributes of what a node gives
    gone: Mapping[str, Release]  # names of other modules, by the first release without them


class StartRow(Named):
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
    parts: _Texts = ()  # of the configuration
    parameters: Mapping[str, Any] = {}
    files: _Texts = ()
    remappings: tuple[_Texts, ...] = ()


class _LaunchFunction(Named):
    """A function of moveit_configs_utils.launches."""

    start: tuple[StartRow, ...]
    flags: Mapping[str, str] = {}  # launch arguments that are true or false, with their defaults
    arguments: Mapping[str, str] = {}  # other launch arguments


INTERFACE_KINDS = ("msg", "srv", "action")
_Words = StringsByName
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
    "rviz_default_plugins": {"displays": _Words, "classes": Mapping[str, Strings]},
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


def rviz_classes() -> Mapping[str, _Texts]:
    """Return the classes of rviz_default_plugins, by where a file of RViz has them."""
    return cast("Mapping[str, Strings]", _table("rviz_default_plugins", "classes"))


def call_signatures() -> _Signatures:
    """Return the parameters of what nodes in Python call, by the release in which they changed."""
    tables = [_table(package, "calls") for package in ("rclpy", "tf2_ros")]
    return {name: row for table in tables for name, row in table.items()}
