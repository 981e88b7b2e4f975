"""Write the table of launch's classes from its sources: `python -m tests.launch.launch_api LAUNCH LAUNCH_ROS`.

The arguments are checkouts of github.com/ros2/launch and github.com/ros2/launch_ros (branch jazzy), which are parsed and
not imported. The table is `grader/ros/launch/launch_classes.json`.
"""

import ast
import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

TABLE = Path("grader/ros/launch/launch_classes.json")
PACKAGES = ("launch", "launch_ros", "launch_xml", "launch_yaml")
SOURCE = (
    "github.com/ros2/launch and github.com/ros2/launch_ros, branch jazzy (3.4.3 and 0.26.6), with what later versions add by "
    "their changelogs, read in November 2026, by python -m tests.launch.launch_api"
)
# What later releases export, so that a newer patch of Jazzy may: whether the name is there is not known.
LATER = {
    "launch.actions": {"ForEach", "ForLoop"},
    "launch.substitutions": {"PathSubstitution", "StringJoinSubstitution"},
    "launch.substitutions.path_join_substitution": {"PathSubstitution"},
}
_PATHS = "launch.substitutions.path_join_substitution"
_LOG = "launch.actions.log"
_DECLARATION = "launch.actions.declare_launch_argument.DeclareLaunchArgument"
_COMPONENT = "launch_ros.descriptions.composable_node.ComposableNode"
_LIFECYCLE = "launch_ros.actions.lifecycle_node.LifecycleNode"
Row = Mapping[str, Any]
_TEXT, _CONDITION = {"check": "text"}, {"check": "condition", "can_be_none": True}
_NEEDED_TEXT, _BOOL = {"required": True, "check": "text"}, {"check": "bool"}


def _logging_class(name: str, **more: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of a class that logs a message."""
    base = "launch.action.Action" if name == "Log" else f"{_LOG}.Log"
    keywords = {"msg": _NEEDED_TEXT, **more, "condition": _CONDITION}
    row = {"base": base, "positional": {}, "keyword_only": keywords, "methods": []}
    return row | {"since": "lyrical"}


# The classes of later versions that are evaluated, with the module that exports them. `since` is the first release that
# has one; without it, an update of Jazzy has it, or may have it. Sources, read in November 2026:
# - PathSubstitution: launch 3.4.5, https://github.com/ros2/launch/pull/868
# - Log and those derived from it, DeclareBooleanLaunchArgument: launch 3.9, actions/log.py and
#   actions/declare_boolean_launch_argument.py of ros2/launch; pull requests 858 and 944
# - StringJoinSubstitution: launch 3.8.1 (Kilted), https://github.com/ros2/launch/pull/843
# - ComposableLifecycleNode: launch_ros 0.28 (Kilted), descriptions/composable_lifecycle_node.py of ros2/launch_ros; whether
#   0.26.7 (Jazzy), which has LifecycleNode(autostart=True), has it too was not found, so no release lacks it
LATER_CLASSES: dict[str, dict[str, Any]] = {
    f"{_PATHS}.PathSubstitution": {
        "base": f"{_PATHS}.PathJoinSubstitution",
        "positional": {"path": _NEEDED_TEXT},
        "keyword_only": {},
        "methods": [],
    },
    f"{_LOG}.Log": _logging_class("Log", level=_NEEDED_TEXT),
    f"{_LOG}.LogDebug": _logging_class("LogDebug"),
    f"{_LOG}.LogWarning": _logging_class("LogWarning"),
    f"{_LOG}.LogError": _logging_class("LogError"),
    "launch.actions.declare_boolean_launch_argument.DeclareBooleanLaunchArgument": {
        "base": _DECLARATION,
        "positional": {"name": {"required": True}},
        "keyword_only": {
            "default_value": {"check": "boolean text", "can_be_none": True},
            "description": {},
            "condition": _CONDITION,
        },
        "methods": [],
        "since": "lyrical",
    },
    "launch.substitutions.string_join_substitution.StringJoinSubstitution": {
        "base": "launch.substitution.Substitution",
        "positional": {"substitutions": {"required": True, "check": "texts"}, "delimiter": _TEXT},
        "keyword_only": {},
        "methods": [],
        "since": "kilted",
    },
    "launch_ros.descriptions.composable_lifecycle_node.ComposableLifecycleNode": {
        "base": _COMPONENT,
        "positional": {},
        "keyword_only": {"autostart": _BOOL},  # and those of ComposableNode
        "methods": [],
    },
}
# What takes `/` since launch 3.4.9 (https://github.com/ros/rosdistro/pull/48509) and launch_ros 0.26.10 (pull request
# 48517 there): these became paths.
LATER_BASES = dict.fromkeys(
    (
        "launch.substitutions.this_launch_file_dir.ThisLaunchFileDir",
        "launch.substitutions.launch_log_dir.LaunchLogDir",
        "launch_ros.substitutions.find_package.FindPackage",
    ),
    f"{_PATHS}.PathSubstitution",
)
# Since launch_ros 0.26.7: https://github.com/ros/rosdistro/pull/44960
LATER_PARAMETERS = {_LIFECYCLE: {"autostart": _BOOL}}
# Of later patches: since https://github.com/ros2/launch/pull/838 a part of a path may be a list.
LATER_CHECKS = {(f"{_PATHS}.PathJoinSubstitution", "substitutions"): "path"}
# What XML and YAML have: `lifecycle_node` since launch_ros 0.26.12 (https://github.com/ros/rosdistro/pull/51757), the rest
# since Lyrical: pull requests 858, 857, 943 and 944 of ros2/launch, 480 of ros2/launch_ros.
LATER_TAGS = {
    "action": {
        "lifecycle_node": _LIFECYCLE,
        "bool_arg": "launch.actions.declare_boolean_launch_argument.DeclareBooleanLaunchArgument",
        "log_info": "launch.actions.log_info.LogInfo",
        "log_debug": f"{_LOG}.LogDebug",
        "log_warning": f"{_LOG}.LogWarning",
        "log_error": f"{_LOG}.LogError",
    },
    "substitution": {
        "string-join": "launch.substitutions.string_join_substitution.StringJoinSubstitution",
        "path-join": f"{_PATHS}.PathJoinSubstitution",
    },
}
SINCE: Mapping[str, Row] = {
    "action": dict.fromkeys(
        ("bool_arg", "log_info", "log_debug", "log_warning", "log_error"), "lyrical"
    ),
    "element": {"composable_lifecycle_node": "lyrical"},
    "attribute": {"log level": "lyrical"},
    "substitution": {"string-join": "lyrical", "path-join": "lyrical"},
}
# What the constructors require of arguments with these annotations: each stands for the check of this name.
CHECKS = {
    "SomeSubstitutionsType": "text",
    "Iterable[SomeSubstitutionsType]": "texts",
    "Dict[SomeSubstitutionsType, SomeSubstitutionsType]": "mapping",
    "Union[bool, SomeSubstitutionsType]": "bool",
    "Union[float, SomeSubstitutionsType]": "float",
    "Iterable[Union[Text, Substitution]]": "text",
    "SomeParameters": "parameters",
    "SomeRemapRules": "remappings",
    "SomeParameterValue": "parameter",
    "Condition": "condition",
    "Iterable[Action]": "actions",
    "Iterable[LaunchDescriptionEntity]": "actions",
}


def modules_of(root: Path) -> "Iterator[Module]":
    """Yield the modules of the packages below a folder."""
    for package in PACKAGES:
        for path in sorted((root / package / package).rglob("*.py")):
            parts = path.relative_to(root / package).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            if parts[-1] == "__init__" or not any(
                part.startswith("_") or part == "conftest" for part in parts
            ):
                yield Module(
                    name, ast.parse(path.read_text("utf-8")), is_package=parts[-1] == "__init__"
                )


class Module:
    """A module: its name, its statements, and the full name that each of its imports stands for."""

    def __init__(self, name: str, tree: ast.Module, *, is_package: bool) -> None:
        self.name, self.tree = name, tree
        self.imports: dict[str, str] = {}
        parts = name.split(".")
        for node in tree.body:
            if isinstance(node, ast.ImportFrom):
                package = parts[: len(parts) - node.level + is_package] if node.level else []
                inner = [*package, *([node.module] if node.module else [])]
                self.imports |= {
                    it.asname or it.name: ".".join([*inner, it.name]) for it in node.names
                }
            elif isinstance(node, ast.Assign) and isinstance(node.value, ast.Name):
                known = self.imports.get(node.value.id)  # PushRosNamespace = PushROSNamespace
                self.imports |= {
                    it.id: known for it in node.targets if known and isinstance(it, ast.Name)
                }

    @property
    def names(self) -> set[str]:
        """The names that it defines."""
        found = {*self.imports}
        for node in self.tree.body:
            if isinstance(node, ast.ClassDef | ast.FunctionDef):
                found.add(node.name)
            elif isinstance(node, ast.Import):
                found |= {it.asname or it.name.partition(".")[0] for it in node.names}
            elif isinstance(node, ast.Assign):
                found |= {it.id for it in node.targets if isinstance(it, ast.Name)}
        return {name for name in found if not name.startswith("_")}


class Constructor(NamedTuple):
    """The parameters of a class's own constructor by their names."""

    positional: dict[str, dict[str, Any]]
    keyword_only: dict[str, dict[str, Any]]
    passed: list[str]  # the names of those that it gives to its base's constructor
    takes_more: bool  # whether the rest is given to its base's constructor


def parameter(argument: ast.arg, default: ast.expr | None) -> dict[str, Any]:
    """Return what a constructor requires of a parameter: fields that are false or empty are left out."""
    written = ast.unparse(argument.annotation) if argument.annotation else ""
    is_optional = written.startswith("Optional[")
    if is_optional:
        written = written.removeprefix("Optional[").removesuffix("]")
    row: dict[str, Any] = {}
    if default is None:
        row["required"] = True
    if written in CHECKS:
        row["check"] = CHECKS[written]
        if is_optional or (isinstance(default, ast.Constant) and default.value is None):
            row["can_be_none"] = True
    return row


def constructor(cls: ast.ClassDef) -> Constructor | None:
    """Return the constructor that a class defines; None without one."""
    methods = (node for node in cls.body if isinstance(node, ast.FunctionDef))
    init = next((method for method in methods if method.name == "__init__"), None)
    if init is None:
        return None
    args = init.args
    positional = args.args[1:]
    defaults = [None] * (len(positional) - len(args.defaults)) + list(args.defaults)
    calls = (node for node in ast.walk(init) if isinstance(node, ast.Call))
    passed = [call.keywords for call in calls if ast.unparse(call.func) == "super().__init__"]
    return Constructor(
        {it.arg: parameter(it, default) for it, default in zip(positional, defaults, strict=True)},
        {
            it.arg: parameter(it, default)
            for it, default in zip(args.kwonlyargs, args.kw_defaults, strict=True)
        },
        [keyword.arg for keywords in passed for keyword in keywords if keyword.arg is not None],
        args.kwarg is not None,
    )


def tags(cls: ast.ClassDef, kind: str) -> list[str]:
    """Return the names that the XML and YAML front ends have for a class."""
    calls = [node for node in cls.decorator_list if isinstance(node, ast.Call)]
    return [
        ast.literal_eval(call.args[0])
        for call in calls
        if ast.unparse(call.func) == f"expose_{kind}"
    ]


def table(*roots: Path, with_later: bool = True) -> dict[str, Any]:
    """Return the classes by full name, the names that each module exports, and those of the front ends; `with_later` with
    what later versions add.
    """
    modules = {module.name: module for root in roots for module in modules_of(root)}
    classes: dict[str, Any] = {}
    found: dict[str, dict[str, str]] = {"action": {}, "substitution": {}}
    for name, module in modules.items():
        for cls in (node for node in module.tree.body if isinstance(node, ast.ClassDef)):
            methods = {
                n.name
                for n in cls.body
                if isinstance(n, ast.FunctionDef) and not n.name.startswith("_")
            }
            bases = [ast.unparse(base).rpartition(".")[2] for base in cls.bases]
            classes[f"{name}.{cls.name}"] = (bases[0] if bases else "", constructor(cls), methods)
            for kind, names in found.items():
                names |= dict.fromkeys(tags(cls, kind), f"{name}.{cls.name}")
    exports: dict[str, Any] = {}
    known = classes.keys() | LATER_CLASSES.keys()
    later = {name.rpartition(".")[2]: name for name in LATER_CLASSES}
    exported = {**LATER}
    for cls_name in LATER_CLASSES:  # launch.actions exports launch.actions.log.Log
        package = ".".join(cls_name.split(".")[:2])
        exported[package] = exported.get(package, set()) | {cls_name.rpartition(".")[2]}
    for name, module in modules.items():
        inner = {other.rpartition(".")[2] for other in modules if other.rpartition(".")[0] == name}
        full = {
            alias: target(module.imports.get(alias, ""), modules, classes) for alias in module.names
        }
        full |= later
        aliases = sorted(module.names | inner | exported.get(name, set()))
        targets = {
            alias: (full.get(alias) if inner else "") or f"{name}.{alias}" for alias in aliases
        }
        exports[name] = {
            "classes": {alias: targets[alias] for alias in aliases if targets[alias] in known},
            "others": [alias for alias in aliases if targets[alias] not in known],
        }
    rows: dict[str, Any] = LATER_CLASSES | {
        name: {
            "base": base_of(name, classes),
            **effective(name, classes),
            "methods": sorted(methods),
        }
        for name, (_, _, methods) in classes.items()
    }
    if not with_later:
        return {"classes": {name: rows[name] for name in classes}, **found}
    for (name, parameter), check in LATER_CHECKS.items():
        rows[name]["positional"][parameter]["check"] = check
    for name, parameters in LATER_PARAMETERS.items():
        rows[name]["keyword_only"] |= parameters
    for name, base in LATER_BASES.items():
        rows[name]["base"] = base
    for row in LATER_CLASSES.values():
        if row["base"] == _COMPONENT:
            row["keyword_only"] = rows[_COMPONENT]["keyword_only"] | row["keyword_only"]
    for kind, names in LATER_TAGS.items():
        found[kind] |= names
    return {"source": SOURCE, "exports": exports, "classes": rows, "since": SINCE, **found}


def effective(name: str, classes: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Return the parameters of a class's constructor, with those that it passes on."""
    base, own = base_of(name, classes), classes[name][1]
    inherited: dict[str, dict[str, Any]] = {"positional": {}, "keyword_only": {}}
    if base:
        inherited = effective(base, classes)
    if own is None:
        return inherited
    keyword_only = dict(own.keyword_only)
    if own.takes_more:
        known = {*own.positional, *own.keyword_only, *own.passed}
        more = inherited["positional"] | inherited["keyword_only"]
        keyword_only |= {key: row for key, row in more.items() if key not in known}
    return {"positional": own.positional, "keyword_only": keyword_only}


def target(full: str, modules: dict[str, Module], classes: dict[str, Any]) -> str:
    """Return the full name of the class that a name stands for; empty for anything else."""
    for __ in range(5):
        if not full or full in classes:
            return full
        module, _, name = full.rpartition(".")
        full = modules[module].imports.get(name, "") if module in modules else ""
    return ""


def base_of(name: str, classes: dict[str, Any]) -> str:
    """Return the full name of a class's base: the class of this name in the nearest package."""
    base = classes[name][0]
    same = [other for other in classes if other.rpartition(".")[2] == base and other != name]
    own = [
        other
        for package in (name.partition(".")[0], "launch")
        for other in same
        if other.startswith(f"{package}.")
    ]
    return next(iter(own), "")


if __name__ == "__main__":
    made = table(*map(Path, sys.argv[1:]))
    lines = [f'"source": {json.dumps(made["source"])}']
    for part in ("exports", "action", "substitution", "since", "classes"):
        rows = ",\n".join(
            f"{json.dumps(key)}: {json.dumps(value)}" for key, value in sorted(made[part].items())
        )
        lines.append(f'"{part}": {{\n{rows}\n}}')
    TABLE.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
