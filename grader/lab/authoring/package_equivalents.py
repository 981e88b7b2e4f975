"""Equivalents of packages: other files that build and start the same. Each must keep full marks.

A file is rewritten only where this certainly changes nothing: a launch file whose nodes are all
known, a setup.py that installs data only, a file that nothing names in another way.
"""

import ast
import json
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from posixpath import basename, split, splitext
from typing import Any
from xml.sax.saxutils import quoteattr

from grader.base.grouping import StringsByName
from grader.base.patterns import on_use
from grader.base.source import Source
from grader.lab.submission.edited import text_of
from grader.lab.submission.submission import Submission
from grader.ros.installation.places import PREFIX
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.package.package import CMAKE, MANIFEST, SETUP, Package
from grader.ros.python.python_file import PythonFile, argument

_ENDING_BY_LANGUAGE = {
    "launch file in XML": ".xml",
    "launch file in YAML": ".yaml",
    "launch file in Python": ".py",
}
BUILT_BY_CMAKE = "package built by CMake"
_LAUNCHING = ("launch", "launch_ros")  # the packages that a launch file in Python imports
_UNNAMED = "nodes without the name of their program"
_LATER = "spawners after an event"
_RENAMED = "files renamed"
_SYSTEM_RENAMED = "<ros2_control> renamed"
Files = Mapping[str, str | None]  # the new texts of files by their paths; None for one that goes
_TEXTS = (".py", ".xml", ".yaml", ".yml", ".xacro", ".urdf", ".txt", ".cfg", ".sdf", ".launch")
_FREE_FILES = on_use(r"(^|/)(config|params|worlds?|parameters)/[^/]+\.(ya?ml|sdf|world)$")
_SHARE = on_use(rf"^{re.escape(PREFIX)}/share/([^/]+)/(.+)$")
_FOUND = on_use(r"\$\(find-pkg-share ([^)]+)\)/(.+)")
_SYSTEM = on_use(r"<ros2_control\s[^<>]*?\bname=(['\"])([\w-]+)\1")
_COMMA = on_use(r"\s*,?")
_PROGRAMS = on_use("console_scripts|scripts *=|gui_scripts")
_IMPORTS = (
    "from launch.actions import RegisterEventHandler as _Handler, TimerAction as _Timer\n"
    "from launch.event_handlers import OnProcessStart as _OnStart\n"
)
_CMAKE_TEXT = """cmake_minimum_required(VERSION 3.8)
project({name})
find_package(ament_cmake REQUIRED)
{installs}
ament_package()
"""
_NodeTables = Sequence[Mapping[str, Any]]  # of a launch file
Span = tuple[int, int, str]  # from where to where there is which text
_Table = dict[str, Any]
Rewritings = Iterator[tuple[str, Files]]  # each with the files that it changes


def package_equivalents(
    submission: Submission, named: Collection[str], robot_files: Sequence[str]
) -> Rewritings:
    """Yield each rewriting with the files that it changes; `named` are the texts of the rubric."""
    packages = list(submission.lab_packages.values())
    for language, ending in _ENDING_BY_LANGUAGE.items():
        yield from as_rewriting(
            language, (_in_other_language(submission, package, ending) for package in packages)
        )
    yield from as_rewriting(
        BUILT_BY_CMAKE, (_built_by_cmake(submission, package) for package in packages)
    )
    yield from as_rewriting(_UNNAMED, (_without_names(submission, package) for package in packages))
    yield from as_rewriting(
        _LATER, (_with_later_spawners(submission, package) for package in packages)
    )
    yield from as_rewriting(
        _RENAMED, (_with_renamed_files(submission, package, named) for package in packages)
    )
    yield from as_rewriting(
        _SYSTEM_RENAMED, (_with_renamed_system(submission, named, robot_files),)
    )


def as_rewriting(rewriting: str, changes: Iterator[Files] | tuple[Files]) -> Rewritings:
    """Yield a rewriting with all its changes, if there are some."""
    files: dict[str, str | None] = {}
    for change in changes:
        files.update(change)
    if files:
        yield rewriting, files


def with_spans(text: str, spans: Iterable[Span]) -> str:
    """Return a text with other texts in spans of it."""
    for start, end, new in sorted(spans, reverse=True):
        text = text[:start] + new + text[end:]
    return text


def span_with_comma(file: PythonFile, node: ast.expr | ast.keyword) -> tuple[int, int]:
    """Return the span of an item of a list, or of an argument, with the comma after it."""
    start, end = file.span(node)
    comma = _COMMA.match(file.text, end)
    return start, comma.end() if comma else end


# --- Launch files in another language


def _in_other_language(submission: Submission, package: Package, ending: str) -> Files:
    """Return the one launch file of a package in another language.

    The build file that installs it is there, too. There is none where not all of it is known, or
    where another file names it.
    """
    paths = [path for path in package.launch_files if not path.startswith("test/")]
    before = _language_ending(paths[0]) if len(paths) == 1 else ""
    if before in ("", ending):
        return {}
    launch = package.launch(paths[0])
    manifest = text_of(submission, package.path(MANIFEST))
    is_declared = ending != ".py" or all(f">{name}<" in manifest for name in _LAUNCHING)
    if not _is_plain(launch) or not is_declared:
        return {}
    nodes = [_node_table(node) for node in launch.nodes]
    known = [node for node in nodes if node is not None]
    if len(known) < len(nodes) or not known:
        return {}
    path = package.path(paths[0])
    build = package.path(CMAKE if package.is_cmake else SETUP)
    if _is_named_elsewhere(submission, path, build):
        return {}
    text = _launch_text(known, ending)
    built = text_of(submission, build).replace(f".launch{before}", f".launch{ending}")
    return {path: None, f"{path.removesuffix(before)}{ending}": text, build: built}


def _language_ending(path: str) -> str:
    """Return the ending of a launch file in a language that is written here, else nothing."""
    ending = splitext(path)[1]
    is_known = ending in _ENDING_BY_LANGUAGE.values()
    return ending if is_known and path.endswith(f".launch{ending}") else ""


def _launch_text(nodes: _NodeTables, ending: str) -> str:
    """Return a launch file that starts nodes, in the language of an ending."""
    if ending == ".xml":
        return _launch_xml(nodes)
    if ending == ".py":
        return _launch_python(nodes)
    # JSON is YAML.
    return json.dumps({"launch": [{"node": node} for node in nodes]}, indent=2)


def _is_named_elsewhere(submission: Submission, path: str, build: str) -> bool:
    """Return whether a text other than the build file names a launch file."""
    name = basename(path)
    for other in submission.whole_tree.files:
        is_text = other.endswith(_TEXTS) and other not in (path, build)
        if is_text and name in text_of(submission, other):
            return True
    return False


def _is_plain(launch: Launch) -> bool:
    """Return whether a launch file is known to start nodes only, always the same."""
    is_known = not launch.syntax and not launch.unread
    open_parts = launch.faults or launch.unknown or launch.doubts or launch.passed
    return is_known and not (open_parts or launch.values or launch.declared)


def _node_table(node: StartedNode) -> _Table | None:
    """Return a node as a table of a launch file; None where not all of it is known."""
    if not node.when or node.included_by or None in (node.node_name, node.namespace, node.remaps):
        return None
    if node.arguments is None or None in node.arguments or node.parameters is None:
        return None
    table: _Table = {"pkg": node.package, "exec": node.executable}
    if node.node_name:
        table["name"] = node.node_name
    if node.namespace:
        table["namespace"] = node.namespace
    words = [_installed_text(str(word)) for word in node.arguments]
    if any(" " in word.partition("$(")[0] for word in words):
        return None
    if words:
        table["args"] = " ".join(words)
    rows = _parameter_rows(node)
    if rows is None:
        return None
    if rows:
        table["param"] = rows
    if node.remaps:
        table["remap"] = [{"from": old, "to": new} for old, new in node.remaps]
    return table


def _parameter_rows(node: StartedNode) -> list[_Table] | None:
    """Return the parameters of a node as rows of a launch file.

    It is None where not all of them are plain.
    """
    rows = []
    for given in node.parameters or ():
        text = _installed_text(given.path)
        is_found = not given.path or text != given.path
        if given.unknown or not given.is_plain or given.node or not is_found:
            return None
        if given.path:
            rows.append({"from": text})
        for name, parameter in given.values.items():
            if type(parameter.value) not in (bool, int, float):
                return None  # launch reads the text of another value as YAML
            rows.append({"name": name, "value": parameter.value})
    return rows


def _installed_text(path: str) -> str:
    """Return a path below the prefix as a launch file finds it."""
    return _SHARE.sub(r"$(find-pkg-share \1)/\2", path)


def _launch_xml(nodes: _NodeTables) -> str:
    lines = ["<launch>"]
    for node in nodes:
        plain = {key: value for key, value in node.items() if not isinstance(value, list)}
        attributes = "".join(f" {key}={quoteattr(str(value))}" for key, value in plain.items())
        lines.append(f"  <node{attributes}>")
        for tag in ("param", "remap"):
            for row in node.get(tag, ()):
                inner = ""
                for key, value in row.items():
                    text = str(value).lower() if isinstance(value, bool) else str(value)
                    inner += f" {key}={quoteattr(text)}"
                lines.append(f"    <{tag}{inner}/>")
        lines.append("  </node>")
    return "\n".join([*lines, "</launch>", ""])


def _launch_python(nodes: _NodeTables) -> str:
    """Return a launch file in Python that starts nodes."""
    lines = [
        "from launch import LaunchDescription",
        "from launch.substitutions import PathJoinSubstitution",
        "from launch_ros.actions import Node",
        "from launch_ros.substitutions import FindPackageShare",
        "",
        "",
        "def generate_launch_description():",
        "    return LaunchDescription([",
    ]
    lines += [f"        {_node_in_python(node)}," for node in nodes]
    return "\n".join([*lines, "    ])", ""])


def _node_in_python(node: Mapping[str, Any]) -> str:
    """Return the call that makes a node."""
    given = [f"package={node['pkg']!r}", f"executable={node['exec']!r}"]
    given += [f"{name}={node[name]!r}" for name in ("name", "namespace") if name in node]
    if "args" in node:
        given.append(f"arguments={[_in_python(word) for word in node['args'].split()]}")
    parameters = []
    for row in node.get("param", ()):
        value = _in_python(row["from"]) if "from" in row else {row["name"]: row["value"]}
        parameters.append(value)
    if parameters:
        given.append(f"parameters={parameters}")
    if "remap" in node:
        given.append(f"remappings={[(row['from'], row['to']) for row in node['remap']]}")
    return f"Node({', '.join(given)})"


class _PythonCode(str):
    """Code of Python whose text in a list is itself."""

    __slots__ = ()

    def __repr__(self) -> str:
        """Return the code."""
        return str(self)


def _in_python(word: str) -> str:
    """Return a word of a launch file, or the code that finds a file of a package."""
    match = _FOUND.fullmatch(word)
    if not match:
        return word
    parts = ", ".join(map(repr, match[2].split("/")))
    return _PythonCode(f"PathJoinSubstitution([FindPackageShare({match[1]!r}), {parts}])")


# --- Other builds


def _built_by_cmake(submission: Submission, package: Package) -> Files:
    """Return the files of a package that CMake builds in place of setup.py.

    There are none where it has programs or modules, or is no package of Python.
    """
    setup = package.path(SETUP)
    manifest = package.manifest
    is_python = manifest is not None and manifest.build_type == "ament_python"
    if not is_python or package.is_cmake or not package.installation:
        return {}
    if _PROGRAMS.search(text_of(submission, setup)) or package.installation.unknown:
        return {}
    text = _CMAKE_TEXT.format(name=package.name, installs="\n".join(_install_commands(package)))
    described = text_of(submission, package.path(MANIFEST)).replace("ament_python", "ament_cmake")
    depends = "<buildtool_depend>ament_cmake</buildtool_depend>"
    described = re.sub(r"(</license>)", rf"\1\n  {depends}", described, count=1)
    return {setup: None, package.path(CMAKE): text, package.path(MANIFEST): described}


def _install_commands(package: Package) -> Iterator[str]:
    """Yield the commands of CMake that install the files of a package into its share folder."""
    share = f"{package.share.rstrip('/')}/"
    for target, path in package.installed.items():
        if not target.startswith(share) or path == MANIFEST:
            continue
        folder, name = split(target.removeprefix(share))
        renamed = f" RENAME {name}" if name != basename(path) else ""
        where = f"share/${{PROJECT_NAME}}/{folder}".rstrip("/")
        yield f"install(FILES {path} DESTINATION {where}{renamed})"


# --- The same launch files, written differently


def python_launches(submission: Submission, package: Package) -> Iterator[tuple[str, PythonFile]]:
    """Yield the launch files of a package in Python, each with its path."""
    for path in package.launch_files:
        if path.endswith(".py") and not path.startswith("test/"):
            full = package.path(path)
            file = PythonFile(Source(full, text_of(submission, full)))
            if not file.fault:
                yield full, file


def _constant(call: ast.Call, name: str) -> str:
    """Return an argument that is written as a text; empty for any other one."""
    given = argument(call, name)
    if not given or not isinstance(given.value, ast.Constant):
        return ""
    return str(given.value.value)


def _without_names(submission: Submission, package: Package) -> Files:
    """Return launch files without the names of nodes that their programs have anyway."""
    files = {}
    for path, file in python_launches(submission, package):
        nodes = package.launch(path.removeprefix(package.path(""))).nodes
        spans = []
        for call in file.calls("Node"):
            given = argument(call, "name")
            name = _constant(call, "name")
            executable = _constant(call, "executable")
            same_nodes = [
                node for node in nodes if node.executable == executable and node.node_name == name
            ]
            if not given or not name or not same_nodes:
                continue
            if submission.workspace.code.find_name(same_nodes[0]._replace(node_name="")) == name:
                spans.append((*span_with_comma(file, given), ""))
        if spans:
            files[path] = with_spans(file.text, spans)
    return files


def _with_later_spawners(submission: Submission, package: Package) -> Files:
    """Return launch files whose spawners start after another node, or after some seconds."""
    files = {}
    for path, file in python_launches(submission, package):
        entries = []
        for call in file.calls("LaunchDescription"):
            if call.args and isinstance(call.args[0], ast.List):
                entries += call.args[0].elts
        spawners = [started for started in entries if _is_spawner(file, started)]
        others = [
            started
            for started in entries
            if isinstance(started, ast.Name) and _is_node(file, started)
        ]
        first = next((started.id for started in others if started not in spawners), "")
        spans = []
        for entry in spawners:
            action = file.segment(entry)
            later = f"_Timer(period=3.0, actions=[{action}])"
            if first:
                later = f"_Handler(_OnStart(target_action={first}, on_start=[{action}]))"
            spans.append((*file.span(entry), later))
        if spans and file.imports:
            start, _ = file.span(file.imports[0])
            files[path] = with_spans(file.text, [*spans, (start, start, _IMPORTS)])
    return files


def _is_node(file: PythonFile, entry: ast.expr) -> bool:
    meant = file.meant(entry)
    return isinstance(meant, ast.Call) and file.segment(meant.func) == "Node"


def _is_spawner(file: PythonFile, entry: ast.expr) -> bool:
    meant = file.meant(entry)
    if not isinstance(meant, ast.Call) or file.segment(meant.func) != "Node":
        return False
    return _constant(meant, "executable").removesuffix(".py") == "spawner"


# --- Names that are free


def _replace_name(
    submission: Submission, texts: StringsByName, name: str, new: str
) -> dict[str, str]:
    """Return the files that name another file, with its new name; `texts` are changed already."""
    word = re.compile(rf"(?<![\w.-]){re.escape(name)}(?![\w.-])")
    uses = {}
    for other in submission.whole_tree.files:
        if other.endswith(_TEXTS):
            text = texts.get(other, text_of(submission, other))
            if word.search(text):
                uses[other] = word.sub(new, text)
    return uses


def _with_renamed_files(submission: Submission, package: Package, named: Collection[str]) -> Files:
    """Return the files of parameters and worlds under other names.

    All files that name them are among these.
    """
    files: dict[str, str | None] = {}
    texts: dict[str, str] = {}
    for path in package.tree.files:
        name = basename(path)
        stem, ending = splitext(name)
        is_asked = any(name in text or f"/{stem}" in text for text in named)
        if not _FREE_FILES.search(path) or is_asked or "*" in name:
            continue
        uses = _replace_name(submission, texts, name, f"{stem}_2x{ending}")
        old = package.path(path)
        if uses and old not in uses:
            texts.update(uses)
            files[old] = None
            files[old.removesuffix(ending) + f"_2x{ending}"] = text_of(submission, old)
    return {**texts, **files}


def _with_renamed_system(
    submission: Submission, named: Collection[str], robot_files: Sequence[str]
) -> Files:
    """Return the files of a robot in which <ros2_control> has another name, if nothing names it."""
    files = {}
    for path in robot_files:
        text = text_of(submission, path)
        spans = []
        for match in _SYSTEM.finditer(text):
            if not any(match[2] in text_in_use for text_in_use in named):
                spans.append((*match.span(2), f"{match[2]}_2x"))
        if spans:
            files[path] = with_spans(text, spans)
    return files
