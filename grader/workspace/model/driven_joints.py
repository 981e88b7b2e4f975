"""The joints of wheels that a controller or a plugin of Gazebo drives: a differential drive."""

from contextlib import suppress
from typing import TYPE_CHECKING

from grader.base.errors import NotDecided
from grader.ros.config.yaml_values import tables_in
from grader.ros.package.robot_file import Read
from grader.ros.xml.elements import first_text

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
            left = list(plugin.iterchildren(left_tag))
            right = list(plugin.iterchildren(right_tag))
            if left and right:
                return [first_text(child) for child in left + right]
    return []


def joints_of_controllers(workspace: "Workspace") -> list[str]:
    """Return the joints that the first controller with wheels on both sides names.

    There are none where reading the workspace takes too much work.
    """
    with suppress(NotDecided):
        for tree in workspace.installed.trees:
            for section in tables_in(tree):
                left = section.get("left_wheel_names")
                right = section.get("right_wheel_names")
                if left is not None and right is not None:
                    items = (*(left.items or [left]), *(right.items or [right]))
                    return [item.text for item in items if item.text]
    return []
