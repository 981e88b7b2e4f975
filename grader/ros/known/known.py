"""What ROS 2 has, by the TOML files of this folder, each of which is read when it is needed."""

import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, Literal, TypedDict, cast

_FOLDER = Path(__file__).parent
_OF_WORKSPACES = (
    "packages",
    "programs",
    "nav2",
    "controllers",
    "gazebo",
    "transforms",
    "wheels",
    "wiring",
    "program_ends",
)


class _Known(TypedDict):
    """What packages define that are not in a workspace; the files say what each table means."""

    frames: list[str]
    transform_publishers: list[str]
    without_frames: list[str]
    without_lifecycle: list[str]
    without_commands: list[str]
    relaying: list[str]
    topics_of_others: list[str]
    written: list[str]
    read_by: list[str]
    metapackages: dict[str, list[str]]
    node_names: dict[str, str]
    compared: list[str]
    programs: dict[str, list[str]]
    children: dict[str, list[str]]
    launch_arguments: dict[str, list[str]]
    plugins: list[str]
    controllers: Mapping[Any, dict[str, str]]  # by the type that a file may give
    controller_packages: Mapping[Any, str]
    controller_topics: Mapping[Any, dict[Literal["subscription", "publisher"], dict[str, str]]]
    controller_actions: dict[str, list[str]]
    gains: Mapping[Any, dict[str, Any]]  # by the type of a controller
    moveit_actions: dict[str, str]
    frame_elements: list[str]
    joint_elements: list[str]
    odometry_systems: list[str]
    odometry_elements: list[str]
    odometry_frames: list[str]
    bridge_types: dict[str, list[str]]
    gazebo_systems: dict[str, dict[str, dict[str, str]]]
    gazebo_sensors: dict[str, dict[str, Any]]
    gazebo_transforms: dict[str, dict[str, str]]
    create_options: list[str]
    create_sources: list[str]
    older_create_options: dict[str, str]
    bridge_directions: list[str]
    bridge_keys: list[str]
    sensor_systems: dict[str, str]
    broadcasts: list[dict[str, Any]]
    joint_state_programs: list[str]
    joint_state_controller: str
    transport_types: dict[str, str]
    colour_encodings: dict[str, int]
    program_ends: list[dict[str, Any]]
    display_types: dict[str, str]
    program_topics: dict[str, list[dict[str, Any]]]
    containers: list[str]
    environment: list[str]
    time_packages: list[str]
    clock_words: list[str]
    launches_without_clock: list[str]
    wheel_values: Mapping[Any, dict[str, Any]]  # by the type of a controller or a plugin


class _Machine(TypedDict):
    """The file machine.toml."""

    other_packages: list[str]
    imported_by_launch: list[str]
    spawner_options: list[str]
    ending_commands: dict[str, list[str]]
    packages: dict[str, list[str]]


@cache
def _read(name: str) -> dict[str, Any]:
    return tomllib.loads((_FOLDER / f"{name}.toml").read_text("utf-8"))


@cache
def known() -> _Known:
    """Return what the packages define that a workspace is compared with."""
    tables: dict[str, Any] = {}
    for name in _OF_WORKSPACES:
        tables |= _read(name)
    return cast("_Known", tables)


def _machine() -> _Machine:
    return cast("_Machine", _read("machine"))


def is_on_every_machine(package: str) -> bool:
    """Return whether a package is on every machine with ROS 2, whether package.xml names it
    or not.
    """
    return package in _machine()["packages"] or package in _machine()["other_packages"]


@cache
def known_packages() -> frozenset[str]:
    """Return the packages that a table names."""
    packages = {*known()["without_frames"], *known()["programs"], *known()["metapackages"]}
    for members in known()["metapackages"].values():
        packages.update(members)
    for names in (known()["node_names"], known()["controllers"]):
        packages.update(each.partition("/")[0] for each in names)
    packages.update(path.split("/")[1] for path in known()["launch_arguments"])
    packages.update(_machine()["packages"], _machine()["other_packages"])
    return frozenset(packages.union(started_by_launch_files()))


def is_known_package(name: str) -> bool:
    """Return whether a table names a package."""
    return name in known_packages()


def programs_of(package: str) -> Sequence[str]:
    """Return the programs of a package that is on every machine, if all are known."""
    return _machine()["packages"].get(package, ())


def lacks_program(package: str, name: str) -> bool:
    """Return whether a package on every machine certainly has no such program."""
    return package in _machine()["packages"] and name not in programs_of(package)


def compared_programs(package: str) -> Sequence[str] | None:
    """Return the programs of a package with which a workspace is compared; None if it is not."""
    if package in known()["compared"]:
        return programs_of(package)
    return known()["programs"].get(package)


def messages() -> Mapping[str, Mapping[str, str]]:
    """Return the fields of well-known messages, with the types of those that have fields."""
    return cast("Mapping[str, Mapping[str, str]]", _read("rclpy")["messages"])


@cache
def node_attributes() -> frozenset[str]:
    """Return the public attributes of rclpy's nodes."""
    return frozenset(_read("rclpy")["node_attributes"].split())


def interface_table(package: str) -> Mapping[str, Mapping[str, Any]] | None:
    """Return the messages, services and actions of a package, by kind and name; None for a package
    without a table.
    """
    if package in _packages_with_interfaces():
        return _read(f"interfaces/{package}")
    return None


@cache
def _packages_with_interfaces() -> frozenset[str]:
    return frozenset(path.stem for path in (_FOLDER / "interfaces").glob("*.toml"))


def is_imported_by_launch(module: str) -> bool:
    """Return whether `ros2 launch` imports a Python package of this name."""
    return module in _machine()["imported_by_launch"]


def spawner_options() -> Sequence[str]:
    """Return the options of the spawner of ros2_control that a value follows."""
    return _machine()["spawner_options"]


def ending_commands() -> Mapping[str, Sequence[str]]:
    """Return the commands that end by themselves, each with the options with which it does not."""
    return _machine()["ending_commands"]


def started_by_launch_files() -> Mapping[str, Mapping[str, Sequence[str]]]:
    """Return the programs that the launch files of well-known packages start, by package and name
    of the file.
    """
    return _read("launch_files")


def moveit_launches() -> Mapping[str, Any]:
    """Return what each of the launch functions of MoveIt starts, by its name."""
    return _read("moveit")


@cache
@cache
def cmake_words(key: str) -> frozenset[str]:
    """Return the words that are known of CMake, by their key in cmake.toml."""
    return frozenset(str(_read("cmake")[key]).split())


def cmake_table(key: str) -> Mapping[str, str | int]:
    """Return a table that is known of CMake, by its key in cmake.toml."""
    table: Mapping[str, str | int] = _read("cmake")[key]
    return table


@cache
def rclcpp_words(key: str) -> frozenset[str]:
    """Return the names that are known of rclcpp and tf2_ros in C++, by their key in rclcpp.toml."""
    return frozenset(str(_read("rclcpp")[key]).split())


def rclcpp_profiles() -> Mapping[str, str]:
    """Return the presets of quality of service in C++: depth, reliability, durability."""
    profiles: Mapping[str, str] = _read("rclcpp")["profiles"]
    return profiles
