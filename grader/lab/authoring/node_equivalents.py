"""Equivalents of packages with nodes: other ways to give these parameters and names.

Each must keep full marks. A node is started in another way only where all that it is given is
known, and where the rubric does not name its program.
"""

import ast
import json
import posixpath
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from grader.base.errors import InputError, NotDecided
from grader.base.grouping import StringsByName, as_list
from grader.base.patterns import on_use
from grader.base.source import Source
from grader.lab.authoring.package_equivalents import (
    Files,
    Rewritings,
    Span,
    as_rewriting,
    python_launches,
    span_with_comma,
    with_spans,
)
from grader.lab.submission.edited import text_of, with_files
from grader.lab.submission.submission import Submission
from grader.ros.config.yaml_nodes import yaml_value
from grader.ros.launch.launch_model import StartedNode
from grader.ros.nodes.node_facts import Endpoint, NodeFacts
from grader.ros.package.package import SETUP, Package
from grader.ros.python.python_file import PythonFile, argument

_IN_LAUNCH = "parameters in the launch file"
_IN_FILE = "parameters in a parameter file"
_REMAPPED = "names remapped"
_IN_ONE_PROGRAM = "two nodes in one program"
_RELATIVE = on_use(r"[A-Za-z]\w*(?:/\w+)*")
_MAX_CALL = 400  # characters from the place of an end to its name
_SCALARS = (bool, int, float, str)
_FOLDERS = ("config", "params", "launch")
_IMPORTS = (
    "from launch.substitutions import PathJoinSubstitution as _Path\n"
    "from launch_ros.substitutions import FindPackageShare as _Share\n"
)
_PROGRAM = "both_2x"
_PROGRAM_TEXT = """import rclpy
from rclpy.executors import MultiThreadedExecutor

{imports}


def main():
    rclpy.init()
    executor = MultiThreadedExecutor()
    for node in ({made}):
        executor.add_node(node)
    executor.spin()
"""
_Spans = list[Span]  # of a file


class _NodeCall(NamedTuple):
    """A call of Node in a launch file in Python, and the own node that it certainly starts."""

    package: Package  # with the launch file
    file: PythonFile
    call: ast.Call
    node: StartedNode
    facts: NodeFacts

    def read_argument(self, name: str) -> str:
        """Return the text of an argument; empty if it is not given."""
        given = argument(self.call, name)
        return self.file.segment(given.value) if given else ""


_NodeCalls = Sequence[_NodeCall]


def node_equivalents(submission: Submission, named: Collection[str]) -> Rewritings:
    """Yield each rewriting with the files that it changes; `named` are the texts of the rubric."""
    calls: list[_NodeCall] = []
    for package in submission.lab_packages.values():
        calls += _node_calls(submission, package)
    yield from as_rewriting(_IN_LAUNCH, (_with_tables(submission, calls),))
    yield from as_rewriting(_IN_FILE, (_with_file(submission, calls),))
    yield from as_rewriting(_REMAPPED, (_with_remappings(submission, calls),))
    yield from as_rewriting(_IN_ONE_PROGRAM, (_in_one_program(submission, calls, named),))


def _node_calls(submission: Submission, package: Package) -> Iterator[_NodeCall]:
    """Yield the calls of Node that each start one own node, of which all is known."""
    code = submission.workspace.code
    roots = {launch.source.path for launch in submission.workspace.launches.outermost}
    for path, file in python_launches(submission, package):
        if path not in roots:
            continue  # the launch files that include it give it arguments
        nodes: dict[tuple[int, int], list[StartedNode]] = {}
        for node in package.launch(path.removeprefix(package.path(""))).nodes:
            if node.location.path == path and not node.included_by:
                place = node.location.line, node.location.column
                nodes.setdefault(place, []).append(node)
        for call in file.calls("Node"):
            at = file.source.at(file.span(call)[0])
            started = nodes.get((at.line, at.column), [])
            facts = code.own_node(started[0]) if len(started) == 1 and started[0].when else None
            is_argument = "LaunchConfiguration" in file.written(call)
            if facts and not facts.doubts and not is_argument:
                yield _NodeCall(package, file, call, started[0], facts)


def _edited(edits: Mapping[str, _Spans], texts: StringsByName) -> Files:
    """Return files after edits of spans, by their paths."""
    return {path: with_spans(texts[path], spans) for path, spans in edits.items()}


# --- Parameters


def _values_given(submission: Submission, each: _NodeCall) -> dict[str, Any] | None:
    """Return the parameters that a node gets; None where one is not plain."""
    workspace = submission.workspace
    try:
        name = workspace.code.find_name(each.node) or ""
        given = workspace.parameters.read_given(each.package, each.node, name)
    except NotDecided:
        return None
    values = {name: parameter.value for name, parameter in given.values.items()}
    if given.unknown or not all(map(_is_plain, values.values())):
        return None
    return values


def _is_plain(value: Any) -> bool:
    """Return whether launch and YAML write a value alike."""
    items = as_list(value)
    if not items:
        return False
    for item in items:
        if not isinstance(item, _SCALARS) or "e-" in repr(item):
            return False
        if isinstance(item, str) and (not item or yaml_value(item) != item):
            return False  # launch reads the text as YAML
    return True


def _with_tables(submission: Submission, calls: _NodeCalls) -> Files:
    """Return launch files that give nodes the values of parameter files in tables."""
    edits: dict[str, _Spans] = {}
    texts = {each.file.source.path: each.file.text for each in calls}
    for each in calls:
        written = argument(each.call, "parameters")
        values = _values_given(submission, each)
        has_file = any(given.path for given in each.node.parameters or ())
        if written and values and has_file:
            span = (*each.file.span(written.value), f"[{values!r}]")
            edits.setdefault(each.file.source.path, []).append(span)
    return _edited(edits, texts)


def _with_file(submission: Submission, calls: _NodeCalls) -> Files:
    """Return a launch file that gives a node the values of its tables in a parameter file."""
    for each in calls:
        written = argument(each.call, "parameters")
        values = _values_given(submission, each)
        given = each.node.parameters or ()
        is_table = all(one.is_plain and not one.path for one in given)
        if not written or not values or not is_table or any("." in name for name in values):
            continue
        lines = [f"    {name}: {json.dumps(value)}\n" for name, value in values.items()]
        text = f"/**:\n  ros__parameters:\n{''.join(lines)}"
        for folder in _FOLDERS:
            files = _moved_to_file(each, written.value, f"{folder}/{_PROGRAM}.yaml", text)
            if _is_installed(submission, each.package, f"{folder}/{_PROGRAM}.yaml", files):
                return files
    return {}


def _moved_to_file(each: _NodeCall, written: ast.expr, path: str, text: str) -> Files:
    """Return a launch file that names a new parameter file, and that file."""
    folder, name = posixpath.split(path)
    found_by = f"_Path([_Share({each.package.name!r}), {folder!r}, {name!r}])"
    at, _ = each.file.span(each.file.imports[0])
    spans = [(*each.file.span(written), f"[{found_by}]"), (at, at, _IMPORTS)]
    changed = with_spans(each.file.text, spans)
    return {each.file.source.path: changed, each.package.path(path): text}


def _is_installed(
    submission: Submission, package: Package, path: str, files: Mapping[str, str | None]
) -> bool:
    """Return whether a build installs a new file of a package at its path."""
    data = {name: (text or "").encode("utf-8", "surrogateescape") for name, text in files.items()}
    try:
        changed = with_files(submission, data)
    except InputError:
        return False
    packages = [one for one in changed.lab_packages.values() if one.folder == package.folder]
    return any(f"share/{one.name}/{path}" in one.installed for one in packages)


# --- Names


def _with_remappings(submission: Submission, calls: _NodeCalls) -> Files:
    """Return code with other names of topics and services, which launch files remap."""
    started: dict[str, list[_NodeCall]] = {}
    for each in calls:
        started.setdefault(each.facts.location.path, []).append(each)
    edits: dict[str, _Spans] = {}
    texts = {}
    for path, of_file in started.items():
        is_free = all(each.node.remaps == () for each in of_file)
        if not is_free or _is_started_otherwise(submission, path, of_file):
            continue
        texts[path] = text_of(submission, path)
        names: dict[str, None] = {}
        for endpoint in of_file[0].facts.endpoints:
            span = _name_span(texts[path], path, endpoint)
            if span is not None:
                names[endpoint.name or ""] = None
                edits.setdefault(path, []).append((*span, f"{endpoint.name}_2x"))
        rules = [(f"{name}_2x", name) for name in names]
        for each in of_file if rules else ():
            launch = each.file.source.path
            texts[launch] = each.file.text
            start, _ = each.file.span(each.call.keywords[0])
            added = (start, start, f"remappings={rules!r}, ")
            edits.setdefault(launch, []).append(added)
    return _edited(edits, texts)


def _is_started_otherwise(submission: Submission, path: str, calls: _NodeCalls) -> bool:
    """Return whether the code of a file is started by other launch files or calls."""
    code = submission.workspace.code
    of_file = 0
    for node in submission.workspace.launches.nodes:
        of_file += any(facts.location.path == path for facts in code.find_nodes(node))
    in_file = [facts for facts in code.nodes if facts.location.path == path]
    return of_file != len(calls) or len(in_file) != 1


def _name_span(text: str, path: str, endpoint: Endpoint) -> tuple[int, int] | None:
    """Return the span of the name of an end in the code; None if it is not written there."""
    name = endpoint.name
    if (
        name is None
        or endpoint.kind not in ("publisher", "subscription", "service", "client")
        or not _RELATIVE.fullmatch(name)
    ):
        return None
    start = Source(path, text).start_offset(endpoint.location)
    quoted_name = re.compile(rf"([\"']){re.escape(name)}\1")
    match = quoted_name.search(text, start, start + _MAX_CALL)
    if not match or ";" in text[start : match.start()]:
        return None
    return match.start() + 1, match.end() - 1


# --- Programs


def _in_one_program(submission: Submission, calls: _NodeCalls, named: Collection[str]) -> Files:
    """Return a program of Python that has two nodes, and a launch file that starts it."""
    can_join = [each for each in calls if _can_join(submission, each, named)]
    for first in can_join:
        for second in can_join:
            is_same = first.file is second.file and first.facts.location != second.facts.location
            if is_same and _are_separate(first.node, second.node):
                files = _join(submission, first, second)
                if files:
                    return files
    return {}


def _can_join(submission: Submission, each: _NodeCall, named: Collection[str]) -> bool:
    """Return whether a node may be in the process of another one."""
    node = each.node
    facts = each.facts
    has_name = facts.name is not None and node.node_name in ("", facts.name)
    is_plain = has_name and not node.namespace and node.remaps == () and not node.arguments
    is_class = facts.location.path.endswith(".py") and bool(facts.class_name)
    is_known = node.parameters is not None and node.name not in named
    if not (is_plain and is_class and is_known and _find_module(submission, each)):
        return False
    others = ("condition", "ros_arguments", "on_exit", "respawn", "prefix")
    return not any(map(each.read_argument, others)) and _has_no_arguments(submission, facts)


def _find_module(submission: Submission, each: _NodeCall) -> str:
    """Return the module of a program, as setup.py has it once; empty if it does not."""
    owner = submission.workspace.find_package(each.node)
    if not owner or owner.is_cmake:
        return ""
    setup = text_of(submission, owner.path(SETUP))
    modules = re.findall(rf"[\"']{re.escape(each.node.executable)} *= *([\w.]+):\w+[\"']", setup)
    return modules[0] if len(modules) == 1 else ""


def _has_no_arguments(submission: Submission, facts: NodeFacts) -> bool:
    """Return whether a class of nodes is made without arguments."""
    source = Source(facts.location.path, text_of(submission, facts.location.path))
    name = facts.class_name.rpartition(".")[2]
    for node in PythonFile(source).nodes:
        if isinstance(node, ast.ClassDef) and node.name == name:
            made = [part for part in node.body if isinstance(part, ast.FunctionDef)]
            inits = [part.args for part in made if part.name == "__init__"]
            return len(inits) == 1 and len(inits[0].args) == 1 + len(inits[0].defaults)
    return False


def _are_separate(first: StartedNode, second: StartedNode) -> bool:
    """Return whether no parameter that a launch file gives one node is one of the other."""
    names = []
    for node in (first, second):
        of_node: set[str] = set()
        for given in node.parameters or ():
            if given.unknown or not given.is_plain:
                return False
            of_node |= given.values.keys()
        names.append(of_node)
    return names[0].isdisjoint(names[1])


def _join(submission: Submission, first: _NodeCall, second: _NodeCall) -> Files:
    """Return a program with two nodes, in place of the first one, and what starts it."""
    owner = submission.workspace.find_package(first.node)
    entry = _find_entry(second)
    parameters = _joined_lists(first, second)
    if not owner or not entry or parameters is None:
        return {}
    imports = []
    made = []
    for each in (first, second):
        name = each.facts.class_name.rpartition(".")[2]
        imports.append(f"from {_find_module(submission, each)} import {name}")
        made.append(f"{name}()")
    program = _PROGRAM_TEXT.format(imports="\n".join(imports), made=", ".join(made))
    module = _find_module(submission, first)
    before = f"{first.node.executable} *= *{re.escape(module)}:\\w+"
    after = f"{_PROGRAM} = {module.rpartition('.')[0]}.{_PROGRAM}:main"
    setup = owner.path(SETUP)
    folder = posixpath.dirname(first.facts.location.path)
    return {
        f"{folder}/{_PROGRAM}.py": program,
        setup: re.sub(before, after, text_of(submission, setup)),
        first.file.source.path: _launch_joined(first, entry, parameters),
    }


def _joined_lists(first: _NodeCall, second: _NodeCall) -> str | None:
    """Return the items of both lists of parameters; None where one is no plain list."""
    items = []
    for each in (first, second):
        text = each.read_argument("parameters")
        if text and (text[0] != "[" or text[-1] != "]"):
            return None
        inner = text[1:-1].strip().rstrip(",")
        if inner:
            items.append(inner)
    return ", ".join(items)


def _find_entry(each: _NodeCall) -> ast.expr | None:
    """Return the entry of a launch description that starts a node, if nothing else names it."""
    for call in each.file.calls("LaunchDescription"):
        entries = call.args[0].elts if call.args and isinstance(call.args[0], ast.List) else []
        for entry in entries:
            if entry is each.call:
                return entry
            if isinstance(entry, ast.Name) and each.file.meant(entry) is each.call:
                uses = [node for node in each.file.nodes if isinstance(node, ast.Name)]
                if sum(node.id == entry.id for node in uses) == 2:  # it is made and started
                    return entry
    return None


def _launch_joined(first: _NodeCall, entry: ast.expr, parameters: str) -> str:
    """Return a launch file that starts the program of two nodes in place of both."""
    file = first.file
    spans = [(*span_with_comma(file, entry), "")]
    given = {name: argument(first.call, name) for name in ("executable", "name", "parameters")}
    written, named, listed = given.values()
    assert written  # it is a node of a program
    program = f"executable={_PROGRAM!r}"
    if listed:
        spans.append((*file.span(listed.value), f"[{parameters}]"))
    elif parameters:
        program += f", parameters=[{parameters}]"
    spans.append((*file.span(written), program))
    if named:
        spans.append((*span_with_comma(file, named), ""))
    return with_spans(file.text, spans)
