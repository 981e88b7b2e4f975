"""The joints of wheels that a controller or a plugin of Gazebo drives: a differential drive."""

from collections.abc import Iterator
from contextlib import suppress
from typing import TYPE_CHECKING

from grader.base.errors import NotDecided
from grader.ros.config.yaml_nodes import Visits, YamlNode
from grader.ros.package.robot_file import Read

if TYPE_CHECKING:
    from grader.workspace.model.workspace import Workspace

_PLUGIN_TAGS = (("left_joint", "right_joint"), ("leftJoint", "rightJoint"))


def joints_of_plugins(robot: Read) -> list[str]:
    """Return the joints that the first plugin with joints on both sides names."""
    root = robot.loaded.root
    if root is None:
        return []
    for plugin in root.iter("plugin"):
        for left_tag, right_tag in _PLUGIN_TAGS:
            left, right = [*plugin.iterchildren(left_tag)], [*plugin.iterchildren(right_tag)]
            if left and right:
                return [(child.text or "").strip() for child in (*left, *right)]
    return []


def joints_of_controllers(workspace: "Workspace") -> list[str]:
    """Return the joints that the first controller with wheels on both sides names.

    There are none where reading the workspace takes too much work.
    """
    with suppress(NotDecided):
        for _, tree in workspace.installed.trees:
            for section in _tables_in(tree):
                left, right = section.get("left_wheel_names"), section.get("right_wheel_names")
                if left is not None and right is not None:
                    items = (*(left.items or [left]), *(right.items or [right]))
                    return [item.text for item in items if item.text]
    return []


def _tables_in(node: YamlNode) -> Iterator[YamlNode]:
    """Yield a table and all tables in it."""
    pending, visits = [node], Visits()
    while pending:
        table = pending.pop()
        if isinstance(table.value, dict) and visits.enters(table):
            yield table
            pending += table.value.values()
