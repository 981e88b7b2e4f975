"""Tables of parameters in launch files in Python that are no dictionaries."""

from grader.base.text import cut, quoted
from grader.ros.launch.parameter_sets import may_have_sets, parameter_sets
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
)
from grader.workspace.rules.rule_table import (
    NO_PARAMETER,
    Rule,
)

_MAX_SHOWN = 60  # characters of a set


_PARAMETER_TABLE = Rule(
    "parameter-table",
    "parameters",
    NO_PARAMETER,
    "The parameters of a node in a launch file are a dictionary.",
    why=(
        "launch_ros takes a set, as in {'speed', 2.0}, for the path of a parameter file. The "
        "node does not get the value and keeps its default."
    ),
    wrong="Node(package='rover', executable='joystick', parameters=[{'speed', 2.0}]),",
    right="Node(package='rover', executable='joystick', parameters=[{'speed': 2.0}]),",
    beside={
        "joystick.py": "",
    },
)


def launch_table_facts(workspace: Workspace) -> Facts:
    """Yield the sets among the parameters of a node in a launch file: they set no parameter."""
    for package in workspace.packages:
        for source in filter(may_have_sets, workspace.texts.launch_sources(package)):
            yield Compared("parameters")
            for table, at in parameter_sets(source):
                message = (
                    f"{quoted(cut(table, _MAX_SHOWN))} is a set, which launch_ros takes for "
                    "the path of a file, so it sets no parameter: write a dictionary, with colons"
                )
                yield Mismatch(_PARAMETER_TABLE, message, at)
