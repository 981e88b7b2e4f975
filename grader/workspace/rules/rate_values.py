"""Rates and ranges that one file asks for and another one cannot give.

They are those of controllers, and of the lidars that Nav2 reads.
"""

from collections.abc import Iterable, Iterator

from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.urdf.numbers import finite_number
from grader.ros.xml.parsing import Element
from grader.workspace.graph.gazebo_topics import elements_in
from grader.workspace.graph.started_controllers import (
    defined_controllers,
    parameters_of_controllers,
)
from grader.workspace.model.launches import MANAGER
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    OTHER_VALUE,
    Rule,
)

_LIDARS = ("lidar", "gpu_lidar", "ray", "gpu_ray")
_SOURCES = "observation_sources"
_SCAN = "LaserScan"
_ROUNDING = 1e-6


class _StatedNumber(Named):
    """A positive number that a file says of something, and its place."""

    of: str
    value: float
    location: Location


def rate_facts(workspace: Workspace) -> Facts:
    """Yield the rates and ranges that cannot be reached."""
    yield from _rates_of_controllers(workspace)
    if workspace.robots.may_be_others:
        return
    farthest = _largest(_ranges_of_lidars(workspace))
    rates = _numbers_of_lidars(workspace, "update_rate")
    fastest = _largest(rate for rate, _ in rates)
    for name, source in _scan_sources(workspace):
        yield Compared("values")
        if farthest:
            yield from _too_far(_number_in(source, name, "obstacle_max_range"), farthest)
        if fastest:
            yield from _too_often(_number_in(source, name, "expected_update_rate"), fastest)


def _largest(numbers: Iterable[_StatedNumber]) -> _StatedNumber | None:
    return max(numbers, key=lambda stated: stated.value, default=None)


_OBSTACLE_RANGE = Rule(
    "obstacle-range",
    "values",
    OTHER_VALUE,
    "A costmap asks for no obstacles beyond the range of its lidar.",
    why=(
        "The lidar does not measure that far. The costmap marks obstacles later than the value "
        "says, so Nav2 avoids them later."
    ),
    wrong="""
obstacle_layer:
  observation_sources: scan
  scan: {data_type: LaserScan, obstacle_max_range: 12.0}
""",
    right="""
obstacle_layer:
  observation_sources: scan
  scan: {data_type: LaserScan, obstacle_max_range: 6.0}
""",
    frame="costmap.yaml",
    beside={
        "lidar/rover.urdf": "",
    },
)


def _too_far(asked: _StatedNumber | None, lidar: _StatedNumber) -> Mismatches:
    """Yield that a costmap marks obstacles farther away than any lidar measures."""
    if asked and asked.value > lidar.value + _ROUNDING:
        message = (
            f"{asked.of}.obstacle_max_range is {asked.value:g} m; the lidar {quoted(lidar.of)} "
            f"measures up to {lidar.value:g} m"
        )
        yield warning(_OBSTACLE_RANGE, message, asked.location, lidar.location)


_SCAN_RATE = Rule(
    "scan-rate",
    "values",
    OTHER_VALUE,
    "A costmap expects scans no more often than its lidar measures.",
    why=(
        "The costmap warns that its observation buffer has not been updated and takes its data "
        "for outdated. Nav2 then waits or stops the robot."
    ),
    wrong="""
obstacle_layer:
  observation_sources: scan
  scan: {data_type: LaserScan, expected_update_rate: 0.1}
""",
    right="""
obstacle_layer:
  observation_sources: scan
  scan: {data_type: LaserScan, expected_update_rate: 0.5}
""",
    frame="costmap.yaml",
    beside={
        "lidar/rover.urdf": "",
    },
)


def _too_often(asked: _StatedNumber | None, lidar: _StatedNumber) -> Mismatches:
    """Yield that a costmap expects scans more often than any lidar measures."""
    period = 1.0 / lidar.value
    if asked and asked.value < period - _ROUNDING:
        message = (
            f"{asked.of}.expected_update_rate is {asked.value:g} s; the lidar {quoted(lidar.of)} "
            f"measures every {period:.4g} s"
        )
        yield warning(_SCAN_RATE, message, asked.location, lidar.location)


_PUBLISH_RATE = Rule(
    "publish-rate",
    "values",
    OTHER_VALUE,
    "A controller publishes no more often than it is updated.",
    why=(
        "A controller publishes in its update(), so odometry and transforms arrive only at the "
        "rate of the manager. Localization may wait for them."
    ),
    wrong="""
controller_manager:
  ros__parameters:
    update_rate: 10
    drive_controller: {type: diff_drive_controller/DiffDriveController}
drive_controller:
  ros__parameters: {publish_rate: 50.0}
""",
    right="""
controller_manager:
  ros__parameters:
    update_rate: 100
    drive_controller: {type: diff_drive_controller/DiffDriveController}
drive_controller:
  ros__parameters: {publish_rate: 50.0}
""",
    frame="controllers.yaml",
)


def _rates_of_controllers(workspace: Workspace) -> Facts:
    """Yield the controllers that should publish more often than their manager updates them."""
    sections = parameters_of_controllers(workspace)
    update = _number_in(sections.get(MANAGER), MANAGER, "update_rate")
    if not update:
        return
    for controller in defined_controllers(workspace):
        asked = _number_in(sections.get(controller.name), controller.name, "publish_rate")
        if not asked:
            continue
        yield Compared("values")
        if asked.value > update.value + _ROUNDING:
            message = (
                f"{asked.of}.publish_rate is {asked.value:g} Hz; the controller manager updates "
                f"its controllers {update.value:g} times a second"
            )
            yield warning(_PUBLISH_RATE, message, asked.location, update.location)


def _number_in(section: YamlNode | None, name: str, key: str) -> _StatedNumber | None:
    """Return the positive number of a parameter, where it is given."""
    node = section.get(key) if section else None
    value = finite_number(node.text) if node is not None else None
    if not node or value is None or value <= 0.0:
        return None
    return _StatedNumber(name, value, node.location)


def _ranges_of_lidars(workspace: Workspace) -> Iterator[_StatedNumber]:
    """Yield how far simulated lidars measure, in metres."""
    for number, element in _numbers_of_lidars(workspace, "max"):
        parent = element.getparent()
        if parent is not None and parent.tag == "range":
            yield number


def _numbers_of_lidars(workspace: Workspace, tag: str) -> Iterator[tuple[_StatedNumber, Element]]:
    """Yield the positive numbers in elements of the simulated lidars, with the elements."""
    for sensor, place in elements_in(workspace, "sensor"):
        for element in sensor.iter(tag) if sensor.get("type") in _LIDARS else ():
            value = finite_number(element.text)
            if value is not None and value > 0.0:
                yield _StatedNumber(sensor.get("name", ""), value, place(element)), element


def _scan_sources(workspace: Workspace) -> Iterator[tuple[str, YamlNode]]:
    """Yield the sections of costmaps' observation sources that are scans."""
    for _, section in workspace.installed.sections:
        for _, layer in section.pairs:
            listed = layer.get(_SOURCES)
            for name in (listed.text or "").split() if listed else ():
                source = layer.get(name)
                kind = layer.get(name, "data_type")
                if source is not None and kind is not None and kind.text == _SCAN:
                    yield name, source
