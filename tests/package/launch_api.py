"""Write the table of launch's classes from its sources: `python -m tests.package.launch_api LAUNCH LAUNCH_ROS`.

The arguments are checkouts of github.com/ros2/launch and github.com/ros2/launch_ros (branch jazzy), which are parsed and
not imported. The table is `grader/ros/launch/launch_classes.json`.
"""

import ast
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

TABLE = Path("grader/ros/launch/launch_classes.json")
PACKAGES = ("launch", "launch_ros", "launch_xml", "launch_yaml")
SOURCE = "github.com/ros2/launch and github.com/ros2/launch_ros, branch jazzy, by python -m tests.package.launch_api"
# What later releases export, so that a newer patch of Jazzy may: whether the name is there is not known.
LATER = {
    "launch.actions": {"ForEach", "ForLoop"},
    "launch.substitutions": {"PathSubstitution", "StringJoinSubstitution"},
    "launch.substitutions.path_join_substitution": {"PathSubstitution"},
}
_PATHS = "launch.substitutions.path_join_substitution"
# Those of them that are evaluated; the demos of ros2_control use this one on Jazzy.
LATER_CLASSES = {
    f"{_PATHS}.PathSubstitution": {
        "base": f"{_PATHS}.PathJoinSubstitution",
        "positional": {"path": {"required": True, "check": "text"}},
        "keyword_only": {},
        "methods": [],
    }
}
# Of later patches: since https://github.com/ros2/launch/pull/838 a part of a path may be a list.
LATER_CHECKS = {(f"{_PATHS}.PathJoinSubstitution", "substitutions"): "path"}
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


def table(*roots: Path) -> dict[str, Any]:
    """Return the classes by full name, the names that each module exports, and those of the front ends."""
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
    for name, module in modules.items():
        inner = {other.rpartition(".")[2] for other in modules if other.rpartition(".")[0] == name}
        full = {
            alias: target(module.imports.get(alias, ""), modules, classes) for alias in module.names
        }
        full |= {it.rpartition(".")[2]: it for it in LATER_CLASSES}
        aliases = sorted(module.names | inner | LATER.get(name, set()))
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
    for (name, parameter), check in LATER_CHECKS.items():
        rows[name]["positional"][parameter]["check"] = check
    return {"source": SOURCE, "exports": exports, "classes": rows, **found}


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
    for part in ("exports", "action", "substitution", "classes"):
        rows = ",\n".join(
            f"{json.dumps(key)}: {json.dumps(value)}" for key, value in sorted(made[part].items())
        )
        lines.append(f'"{part}": {{\n{rows}\n}}')
    TABLE.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
