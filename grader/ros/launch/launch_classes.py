"""The classes of launch, launch_ros, launch_xml and launch_yaml, as `launch_classes.json` has them.

They are those of Jazzy with its updates; what later releases add says since which it is there.
"""

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from grader.base.grouping import StringsByName
from grader.base.records import Named
from grader.base.text import last_part

ENTITY = "launch.launch_description_entity.LaunchDescriptionEntity"
PROCESS = "launch.actions.execute_local.ExecuteLocal"
CONDITION = "launch.condition.Condition"
SUBSTITUTION = "launch.substitution.Substitution"
SOURCE = "launch.launch_description_source.LaunchDescriptionSource"
PATH = "launch.substitutions.path_join_substitution.PathSubstitution"
JOINED_PATH = "launch.substitutions.path_join_substitution.PathJoinSubstitution"
COMPONENT = "launch_ros.descriptions.composable_node.ComposableNode"
LIFECYCLE_COMPONENT = "launch_ros.descriptions.composable_lifecycle_node.ComposableLifecycleNode"
DESCRIPTION = "launch.launch_description.LaunchDescription"


class _ConstructorParameter(NamedTuple):
    """A parameter of a constructor."""

    is_positional: bool
    is_required: bool = False
    check: str = ""  # names what its value has to be; empty where it takes anything
    can_be_none: bool = False  # although it has a check


class LaunchClass(Named):
    """A class of launch: its constructor's parameters, and the names of its methods.

    The parameters include those that it passes on.
    """

    name: str
    base: str
    parameters: Mapping[str, _ConstructorParameter]
    methods: frozenset[str]
    since: str = ""  # the first release that has it; empty for one that Jazzy has

    @property
    def short(self) -> str:
        """The name without its module."""
        return last_part(self.name)


@cache
def _table() -> Any:
    return json.loads(Path(__file__).with_suffix(".json").read_text("utf-8"))


@cache
def class_named(name: str) -> LaunchClass | None:
    """Return a class by its full name; None where the table has none of this name."""
    row = _table()["classes"].get(name)
    if row is None:
        return None
    parameters = {}
    for group in ("positional", "keyword_only"):
        for parameter, fields in row[group].items():
            parameters[parameter] = _ConstructorParameter(
                group == "positional",
                fields.get("required", False),
                fields.get("check", ""),
                fields.get("can_be_none", False),
            )
    inherited = class_named(row["base"])
    methods = frozenset(row["methods"])
    if inherited:
        methods |= inherited.methods
    return LaunchClass(name, row["base"], parameters, methods, row.get("since", ""))


def is_a(name: str, base: str) -> bool:
    """Return whether a class is another, or derived from it."""
    while name != base:
        cls = class_named(name)
        if not cls:
            return False
        name = cls.base
    return True


@cache
def exports() -> Mapping[str, StringsByName]:
    """Return for each module the names that it exports.

    Each has the full name of the class, if it is one.
    """
    return {
        module: {**names["classes"], **dict.fromkeys(names["others"], "")}
        for module, names in _table()["exports"].items()
    }


def front_end(kind: str) -> StringsByName:
    """Return the classes by the names that XML and YAML have for them.

    `kind` is action or substitution.
    """
    names: StringsByName = _table()[kind]
    return names


def first_release(kind: str, name: str) -> str:
    """Return the first release that has a word of XML and YAML; empty for one that Jazzy has.

    Args:
        kind: Whether it is an action, an element, an attribute or a substitution.
        name: The word; of an attribute, after that of its element.
    """
    names: StringsByName = _table()["since"][kind]
    return names.get(name, "")
