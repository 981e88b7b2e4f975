"""The rows of what well-known programs open: each is read, has its source, and names types that exist."""

import tomllib
from typing import Any

import pytest

from grader.ros.known.end_rows import (
    FOLDER,
    OpenedEnds,
    VaryingEnd,
    manual_programs,
    nodes_of_launch_file,
    opened_ends,
    packages_with_ends,
)
from grader.ros.known.package_tables import INTERFACE_KINDS, interface_table

_KINDS = {
    "publisher": "msg",
    "subscription": "msg",
    "service": "srv",
    "client": "srv",
    "action server": "action",
    "action client": "action",
}


def programs() -> list[tuple[str, str, OpenedEnds]]:
    """Return all programs with their packages and rows."""
    rows = []
    for package in packages_with_ends():
        table: dict[str, Any] = tomllib.loads((FOLDER / f"{package}.toml").read_text("utf-8"))
        assert table["source"], package
        for name in table.get("program", {}):
            row = opened_ends(package, name)
            assert row is not None
            rows.append((package, name, row))
        for file in table.get("launch", {}):
            for node in nodes_of_launch_file(package, file, "jazzy"):
                owner, _, program = node.node.partition("/")
                assert owner and program, node
    return rows


def test_at_least_eighty_programs_have_rows() -> None:
    """Besides components and controllers."""
    names = [name for _, name, _ in programs() if "::" not in name and name[0].islower()]
    assert len(names) >= 80


def test_each_type_is_of_its_kind_and_exists_where_its_package_is_known() -> None:
    """A topic has a message, a service a service, an action an action."""
    checked = 0
    for package, program, row in programs():
        ends = [
            *row.fixed,
            *((end.kind, end.name, end.type) for end in row.varying if not end.type_parameter),
        ]
        for kind, name, message in ends:
            owner, section, last = message.split(".")
            assert section == _KINDS[kind], (package, program, name)
            table = interface_table(owner)
            if table is not None:
                checked += 1
                assert last in table.get(section, {}), (package, program, name, message)
    assert checked > 200
    assert set(_KINDS.values()) == {*INTERFACE_KINDS}


def test_a_varying_end_has_a_name_and_a_type() -> None:
    """Or parameters that give them."""
    ends: list[VaryingEnd] = [end for _, _, row in programs() for end in row.varying]
    assert len(ends) > 60
    for end in ends:
        assert end.name or end.parameter, end
        assert end.type or end.type_parameter, end
        assert end.is_in("jazzy") or not end.is_in("jazzy")


def test_what_is_not_known_has_no_row() -> None:
    """Neither a program of an unknown package, nor another one of a known package."""
    assert opened_ends("nowhere", "talker") is None
    assert opened_ends("turtlesim", "nothing") is None
    assert nodes_of_launch_file("nowhere", "any.launch.py", "jazzy") == []
    assert nodes_of_launch_file("nav2_bringup", "nothing_launch.py", "jazzy") == []


@pytest.mark.parametrize(("release", "is_there"), [("humble", False), ("jazzy", True)])
def test_a_launch_file_starts_what_its_release_has(release: Any, is_there: bool) -> None:
    """The collision monitor is part of Nav2's navigation since Jazzy."""
    nodes = nodes_of_launch_file("nav2_bringup", "navigation_launch.py", release)
    assert ("nav2_collision_monitor/collision_monitor" in [node.node for node in nodes]) is is_there


def test_one_row_may_be_like_another() -> None:
    """A component opens what its program opens, and localization with slam_toolbox reads one topic more."""
    row = opened_ends("joy", "joy::Joy")
    assert row is not None
    assert row.publishers == {"joy": "sensor_msgs.msg.Joy"}
    mapping = opened_ends("slam_toolbox", "async_slam_toolbox_node")
    localization = opened_ends("slam_toolbox", "localization_slam_toolbox_node")
    assert mapping is not None
    assert localization is not None
    assert {*localization.subscriptions} - {*mapping.subscriptions} == {"initialpose"}
    assert localization.name == "slam_toolbox"


def test_manual_programs_are_those_that_a_person_starts() -> None:
    """Teleoperation and RViz are among them, and no driver."""
    names = [name for name, _ in manual_programs()]
    assert {"teleop_twist_keyboard/teleop_twist_keyboard", "rviz2/rviz2"} <= {*names}
    assert not [name for name in names if "lidar" in name]
