"""The classes of launch, launch_ros, launch_xml and launch_yaml (ROS 2 Jazzy), as `api.json` lists
them.
"""

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

ENTITY = "launch.launch_description_entity.LaunchDescriptionEntity"
PROCESS = "launch.actions.execute_local.ExecuteLocal"
CONDITION = "launch.condition.Condition"
SUBSTITUTION = "launch.substitution.Substitution"
SOURCE = "launch.launch_description_source.LaunchDescriptionSource"
PATH = "launch.substitutions.path_join_substitution.PathSubstitution"
JOINED_PATH = "launch.substitutions.path_join_substitution.PathJoinSubstitution"
DESCRIPTION = "launch.launch_description.LaunchDescription"


class _ConstructorParameter(NamedTuple):
    """A parameter of a constructor."""

    name: str
    check: str  # names what its value has to be; empty where it takes anything
    is_required: bool
    is_positional: bool


class LaunchClass(NamedTuple):
    """A class: the parameters of its constructor, with those that it passes on, and the names of
    its methods.
    """

    name: str
    base: str
    parameters: Mapping[str, _ConstructorParameter]
    methods: frozenset[str]

    @property
    def short(self) -> str:
        """The name without its module."""
        return self.name.rpartition(".")[2]


@cache
def _table() -> Any:
    return json.loads(Path(__file__).with_suffix(".json").read_text("utf-8"))


@cache
def class_named(name: str) -> LaunchClass | None:
    """Return a class by its full name; None where the table has none of this name."""
    row = _table()["classes"].get(name)
    if row is None:
        return None
    base, signature, methods = row
    parameters, is_positional = {}, True
    for word in signature.split():
        own, _, check = word.partition(":")
        if word.startswith("*"):
            is_positional = False
        else:
            named = own.removesuffix("!")
            parameters[named] = _ConstructorParameter(
                named, check, own.endswith("!"), is_positional
            )
    inherited = class_named(base)
    return LaunchClass(
        name,
        base,
        parameters,
        frozenset(methods.split()) | (inherited.methods if inherited else set()),
    )


def is_a(name: str, base: str) -> bool:
    """Return whether a class is another, or derived from it."""
    while name != base:
        cls = class_named(name)
        if cls is None:
            return False
        name = cls.base
    return True


@cache
def exports() -> Mapping[str, Mapping[str, str]]:
    """Return for each module the names that it exports, with the full name of the class, if it is
    one.
    """
    found: dict[str, dict[str, str]] = {}
    for module, words in _table()["exports"].items():
        pairs = (word.partition("=") for word in words.split())
        own = {name: full or f"{module}.{name}" for name, _, full in pairs}
        found[module] = {
            name: full if full in _table()["classes"] else "" for name, full in own.items()
        }
    return found


def front_end(kind: str) -> Mapping[str, str]:
    """Return the classes by the names that XML and YAML have for them; `kind` is action or
    substitution.
    """
    names: Mapping[str, str] = _table()[kind]
    return names
