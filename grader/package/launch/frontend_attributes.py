"""The attributes of the elements in launch files, of their types; wrong ones are errors."""

from collections.abc import Mapping
from typing import Any

from grader.names import did_you_mean
from grader.package.launch.frontend import Entity
from grader.package.launch.frontend_values import is_typed, typed_text
from grader.package.launch.model import LaunchFails

TYPES: Mapping[str, type | None] = {"int": int, "float": float, "bool": bool, "any": None}


_ROS1_ATTRIBUTES: dict[str, dict[str, str]] = {
    "node": {"type": "exec", "package": "pkg", "executable": "exec", "ns": "namespace", "required": ""},
    "arg": {"value": "default", "default_value": "default", "doc": "description"},
    "param": {"command": "value", "textfile": "value"}, "group": {"ns": ""}, "include": {"ns": "", "pass_all_args": ""},
}  # fmt: skip


def attributes_of(entity: Entity, known: str) -> dict[str, Any]:
    """Return the attributes of an entity, of their types. Raises LaunchFails for unknown and missing ones."""
    if entity.error:
        raise LaunchFails(entity.error, entity.at)
    if entity.is_yaml and entity.has_actions != ("children" in known):
        what = "needs the key children" if "children" in known else "has no list of actions"
        raise LaunchFails(f"{entity.kind} {what}", entity.at)
    names = {word.partition(":")[0].rstrip("![]"): word for word in known.split()}
    lists = {name for name, word in names.items() if word.endswith("[]")}
    for name in () if "children" in names else [*entity.nested, *(it.kind for it in entity.actions)]:
        if name not in lists:
            raise LaunchFails(f"<{entity.kind}> contains no <{name}>{did_you_mean(name, lists)}", entity.at)
    found: dict[str, Any] = {}
    for name, value in entity.attributes.items():
        plain = name.removesuffix("-sep") if not entity.is_yaml else name
        if plain not in names or plain in lists or plain == "children":
            right = _ROS1_ATTRIBUTES.get(entity.kind, {}).get(name)
            hint = (
                (f" in ROS 2; write {right!r}" if right else " in ROS 2")
                if right is not None
                else did_you_mean(name, names)
            )
            raise LaunchFails(f"<{entity.kind}> has no attribute {name!r}{hint}", entity.at)
        if plain == name:
            found[name] = _typed(entity, name, value, names[name])
    missing = [name for name, word in names.items() if "!" in word and name not in {*found, *entity.nested}]
    if missing:
        raise LaunchFails(f"<{entity.kind}> needs the attribute {missing[0]!r}", entity.at)
    return found


def _typed(entity: Entity, name: str, value: Any, word: str) -> Any:
    _, _, kind = word.partition(":")
    wanted = TYPES[kind] if kind else str
    if entity.is_yaml:
        if not is_typed(value, wanted):
            what = f"{name} of {entity.kind} is {value!r}, which YAML reads as {type(value).__name__}"
            raise LaunchFails(f"{what}: {'put quotes around it' if wanted is str else f'write a {kind}'}", entity.at)
        return value
    separator = entity.attributes.get(f"{name}-sep")
    if separator:
        return [typed_text(part, wanted, entity.at) for part in value.split(separator)]
    return value if wanted is str else typed_text(value, wanted, entity.at)
