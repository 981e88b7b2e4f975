"""Each key of the files of `grader/ros/known` is one that their readers know."""

import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from grader.ros.known.cmake_words import CMakeWords, cmake_words
from grader.ros.known.gazebo_rows import Gazebo, gazebo
from grader.ros.known.package_files import FOLDER, packages_with_files, split_facts
from grader.ros.known.package_rows import PackageRow, package_row
from grader.ros.known.package_tables import INTERFACE_KINDS, TABLES
from grader.ros.known.parameter_rows import NodeTable, is_name_of_node, read_rows
from grader.ros.known.releases import RELEASES
from grader.ros.known.ros_machine import RosMachine, ros_machine
from grader.ros.known.rosdep_words import RosdepWords, rosdep_words
from grader.ros.known.shared_names import SharedNames, shared_names
from grader.ros.known.typed_places import TypedPlaces, typed_places
from grader.ros.known.typed_rows import read_row, read_typed

# The files of what belongs to no package; releases.py reads the one of releases, and docs/make.py
# writes the index.
_OTHERS: Mapping[str, tuple[Callable[..., Any], Callable[[], Any]]] = {
    "cmake": (CMakeWords, cmake_words),
    "gazebo": (Gazebo, gazebo),
    "machine": (RosMachine, ros_machine),
    "rosdep": (RosdepWords, rosdep_words),
    "shared_names": (SharedNames, shared_names),
    "typed_places": (TypedPlaces, typed_places),
}


def _text_of(package: str) -> str:
    return (FOLDER / f"{package}.toml").read_text("utf-8")


def _read_package(package: str, text: str) -> None:
    """Read the whole file of a package. Raises ValueError for a key that no reader knows."""
    facts, tables = map(tomllib.loads, split_facts(text))
    read_row(PackageRow, facts)
    for name, table in tables.items():
        if is_name_of_node(name):
            assert name.startswith((f"{package}/", f"{package}::"))
            [*rows] = read_rows(read_row(NodeTable, table).parameters)
            assert len(rows) >= len(table.get("parameters", ()))
        elif name in INTERFACE_KINDS:
            for form in table.values():
                assert isinstance(form, str) or form.keys() <= {*RELEASES}
        elif name in TABLES.get(package, ()):
            read_typed(TABLES[package][name], table)
        else:
            raise ValueError(f"the file of {package} has a table {name!r}")


def test_each_key_of_a_package_is_known() -> None:
    """Each key of the file of a package is one that a reader knows; its facts have a source, and
    stand before its tables.
    """
    for package in packages_with_files():
        text = _text_of(package)
        _read_package(package, text)
        facts, tables = map(tomllib.loads, split_facts(text))
        assert repr(facts | tables) == repr(tomllib.loads(text)), package  # nan is not nan
        assert not facts or facts["source"], package
        assert not tables.keys() & {*PackageRow._fields}, package


def test_programs_are_like_others_of_their_package() -> None:
    """A program that is like another one names it, and has no facts of its own but names."""
    for package in packages_with_files():
        programs = package_row(package).program
        for row in programs.values():
            if row.like:
                assert row.like in programs
                assert row == type(row)(like=row.like, name=row.name, usual_names=row.usual_names)


def test_each_file_of_no_package_is_read() -> None:
    """Each key of the other files is a field of the row that they are read into."""
    names = {path.stem for path in FOLDER.parent.glob("*.toml")}
    assert names == {*_OTHERS, "releases", "index", "tables", "outputs", "python_names"}
    for kind, read in _OTHERS.values():
        assert isinstance(read(), kind)  # type: ignore[arg-type]  # a function that makes rows


@pytest.mark.parametrize(
    ("package", "written", "misspelt"),
    [
        ("robot_localization", "is_compared =", "is_compard ="),
        ("robot_localization", '"lifecycle"]', '"lifecycles"]'),
        ("robot_localization", "usual_names =", "usual_name ="),
        ("robot_localization", "if_equal =", "if_equals ="),
        ("robot_localization", "[launch.", "[lanch."),
        ("robot_localization", "also =", "aslo ="),
        ("robot_localization", '{ type = "bool"', '{ tpye = "bool"'),
        ("robot_localization", '["robot_localization/', '["robot_localisation/'),
        ("diff_drive_controller", "joints =", "joint ="),
        ("diff_drive_controller", 'number = "track"', 'number = "tracks"'),
        ("joint_trajectory_controller", "interfaces =", "interface ="),
        ("geometry_msgs", "[msg]", "[mgs]"),
        ("geometry_msgs", "jazzy =", "jazy ="),
        ("ros_gz_bridge", "directions =", "direction ="),
        ("moveit_configs_utils", "only_if =", "if ="),
    ],
)
def test_a_misspelt_key_of_a_package_is_refused(package: str, written: str, misspelt: str) -> None:
    """A misspelt key, table or word in the file of a package is an error."""
    text = _text_of(package)
    assert written in text
    with pytest.raises((ValueError, AssertionError)):
        _read_package(package, text.replace(written, misspelt, 1))


@pytest.mark.parametrize(
    ("name", "written", "misspelt"),
    [
        ("cmake", "opaque =", "opaqe ="),
        ("gazebo", "has_odometry =", "has_odometri ="),
        ("gazebo", "below =", "bellow ="),
        ("machine", "environment =", "enviroment ="),
        ("shared_names", "frames =", "frame ="),
    ],
)
def test_a_misspelt_key_of_another_file_is_refused(name: str, written: str, misspelt: str) -> None:
    """A misspelt key in the file of what belongs to no package is an error."""
    text = Path(FOLDER.parent / f"{name}.toml").read_text("utf-8")
    assert written in text
    with pytest.raises(ValueError, match="has no"):
        read_row(_OTHERS[name][0], tomllib.loads(text.replace(written, misspelt, 1)))


def test_a_value_of_another_type_is_refused() -> None:
    """A text in place of a truth value, and a number in place of a text, are errors."""
    with pytest.raises(ValueError, match="'yes' is no"):
        read_row(PackageRow, {"is_installed": "yes"})
    with pytest.raises(ValueError, match="7 is no"):
        read_row(PackageRow, {"programs": [7]})
