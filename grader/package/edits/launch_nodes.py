"""Nodes that a launch file does not start: misspelt, forgotten, prevented by a condition, or missing."""

import ast
from collections.abc import Container, Iterator, Mapping, Sequence

from grader.edits import Proposal
from grader.names import closest
from grader.package.edits.paths import pieces
from grader.package.edits.python_file import PythonFile, keyword
from grader.package.edits.task import proposal
from grader.package.launch.model import Launch, StartedNode
from grader.source import Edit, Location, Source
from grader.static_python.imports import USUAL_NAMES

_WHAT = "the launch file"
_MAX_DEPTH = 4  # of names that are replaced by their values


def started(launch: Launch, source: Source, nodes: Sequence[str], like: PythonFile | None) -> Iterator[Proposal]:
    """Yield edits with which a launch file starts nodes, each written `package/executable` or "a or b"."""
    wanted = {name for node in nodes for name in node.split(" or ")}
    running = {_name(node) for node in launch.nodes if node.when}
    missing = [choice for choice in (node.split(" or ") for node in nodes) if running.isdisjoint(choice)]
    file = PythonFile(source)
    whole: list[Edit] = []
    for choice in missing:
        found = [
            *_forgotten(launch, file, choice),
            *_misspelt(launch, source, choice, wanted),
            *_prevented(launch, file, choice),
        ]
        if not found and like is not None:
            found = [edits for wanted in choice[:1] if (edits := _restored(file, like, wanted))]
        for edits in found[:3]:
            names = " or ".join(choice)
            yield proposal(edits, f"{_WHAT} does not start {names}", f"let {_WHAT} start {names}")
        whole += found[0] if found else []
    if len(missing) > 1:
        yield proposal(_joined(whole), f"{_WHAT} does not start all nodes", f"let {_WHAT} start the missing nodes")


def _joined(edits: Sequence[Edit]) -> list[Edit]:
    """Return the edits with one for each place: what several insert there, each once."""
    by_place: dict[tuple[int, int, str], dict[str, None]] = {}
    for edit in edits:
        by_place.setdefault((edit.line, edit.column, edit.old), {})[edit.new] = None
    path = edits[0].path if edits else ""
    return [Edit(path, line, column, old, "".join(new)) for (line, column, old), new in by_place.items()]


def _name(node: StartedNode) -> str:
    return node.executable if node.package == node.executable else f"{node.package}/{node.executable}"


def _parts(wanted: str) -> tuple[str, str]:
    """Return the package and the executable of a node."""
    package, _, executable = wanted.partition("/")
    return package, executable or package


def _forgotten(launch: Launch, file: PythonFile, choice: Sequence[str]) -> Iterator[list[Edit]]:
    """Yield the edits that add a node to the description which the file creates, but does not use."""
    for node in launch.forgotten:
        assigned = (it for it in file.nodes if isinstance(it, ast.Assign) and it.lineno <= node.location.line)
        owner = max(
            (it for it in assigned if (it.end_lineno or 0) >= node.location.line),
            key=lambda it: it.lineno,
            default=None,
        )
        name = getattr(owner.targets[0], "id", "") if owner is not None else ""
        if _name(node) in choice and name and (edits := added(file, name)):
            yield edits


def _misspelt(launch: Launch, source: Source, choice: Sequence[str], wanted: set[str]) -> Iterator[list[Edit]]:
    """Yield the edits of the package and the executable of a node that is named almost like one of these."""
    for node in launch.nodes:
        for package, executable in map(_parts, choice if _name(node) not in wanted else ()):
            if package in (node.package, closest(node.package, [package])) and executable in (
                node.executable,
                closest(node.executable, [executable]),
            ):
                pairs = {node.package: package, node.executable: executable}
                edits = [
                    edit for old, new in pairs.items() if old != new for edit in _texts(source, old, new, node.location)
                ]
                if edits:
                    yield edits


def _texts(source: Source, old: str, new: str, at: Location) -> list[Edit]:
    """Return the edit of the first text after a place that is the old one."""
    start = source.offset(at.line, at.column)
    found = (span for span in pieces(source) if span[0] >= start and source.text[span[0] : span[1]] == old)
    return [source.edit(*span, new) for span in found][: 2 if old == new else 1]


def _prevented(launch: Launch, file: PythonFile, choice: Sequence[str]) -> Iterator[list[Edit]]:
    """Yield the edits that remove the condition of a node."""
    for node in launch.nodes:
        if node.when is False and _name(node) in choice:
            call = node_at(file, node.location)
            condition = keyword(call, "condition") if call is not None else None
            if condition is not None:
                start, end = file.span(condition)
                end += file.text[end : end + 1] == ","
                start = (
                    max(file.text.rfind("\n", 0, start), 0)
                    if not file.text[:start].rsplit("\n", 1)[-1].strip()
                    else start
                )
                yield [file.source.edit(start, end, "")]


def node_at(file: PythonFile, at: Location) -> ast.Call | None:
    """Return the outermost call that starts at a place."""
    start = file.source.offset(at.line, at.column)
    calls = (node for node in file.nodes if isinstance(node, ast.Call) and file.span(node)[0] == start)
    return max(calls, key=lambda call: file.span(call)[1], default=None)


def added(file: PythonFile, action: str) -> list[Edit]:
    """Return the edit that adds an action to the launch description of a file."""
    for call in file.calls("LaunchDescription"):
        listed = call.args[0] if call.args else None
        if isinstance(listed, ast.Name):
            assigned = (node for node in file.nodes if isinstance(node, ast.Assign))
            listed = next((it.value for it in assigned if getattr(it.targets[0], "id", "") == listed.id), None)
        if isinstance(listed, ast.List) and listed.elts:
            start, end = file.span(listed.elts[-1])
            line_start = file.text.rfind("\n", 0, start) + 1
            indent = file.text[line_start:start]
            if indent.strip():
                return [file.source.edit(end, end, f", {_at_indent(action, '', file.newline)}")]
            return [file.source.edit(end, end, f",{file.newline}{indent}{_at_indent(action, indent, file.newline)}")]
        if isinstance(listed, ast.List):
            return [file.replaced(listed, f"[{action}]")]
    for call in file.calls("add_action")[-1:]:
        start, end = file.span(call)
        indent = file.text[file.text.rfind("\n", 0, start) + 1 : start]
        function = file.segment(call.func)
        return [
            file.source.edit(end, end, f"{file.newline}{indent}{function}({_at_indent(action, indent, file.newline)})")
        ]
    return []


def _at_indent(code: str, indent: str, newline: str) -> str:
    """Return the lines of an expression, whose first one stands at this indentation."""
    first, *others = code.split("\n")
    least = min((len(line) - len(line.lstrip()) for line in others if line.strip()), default=0)
    return newline.join([first, *(indent + line[least:] if line.strip() else line for line in others)])


def _restored(file: PythonFile, like: PythonFile, wanted: str) -> list[Edit]:
    """Return the edits that add a node as the reference starts it."""
    for call in like.calls("Node"):
        given = [keyword(call, name) for name in ("package", "executable")]
        texts = tuple(it.value.value for it in given if it is not None and isinstance(it.value, ast.Constant))
        if texts == _parts(wanted):
            code, names = fitting(like, call, file.bound)
            edits = added(file, code)
            return [*file.with_imports(names), *edits] if edits else []
    return []


def fitting(like: PythonFile, node: ast.expr, bound: Container[str]) -> tuple[str, list[str]]:
    """Return an expression of the reference with only names that a file binds, or can import; and those that it needs to import."""
    values = _values(like)
    needed: dict[str, None] = {}

    def write(expression: ast.expr, depth: int) -> str:
        start, _ = like.span(expression)
        text = like.segment(expression)
        names = [it for it in ast.walk(expression) if isinstance(it, ast.Name)]
        for name in sorted(names, key=lambda it: like.span(it)[0], reverse=True):
            if name.id in bound:
                continue
            if name.id in values and depth:
                at, end = (offset - start for offset in like.span(name))
                text = text[:at] + write(values[name.id], depth - 1) + text[end:]
            elif name.id in USUAL_NAMES:
                needed[name.id] = None
        return text

    return write(node, _MAX_DEPTH), list(needed)


def _values(like: PythonFile) -> Mapping[str, ast.expr]:
    """Return the expressions that are bound to names in a file."""
    found: dict[str, ast.expr] = {}
    for node in like.nodes:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                found[name] = value
            case ast.withitem(context_expr=value, optional_vars=ast.Name(id=name)):
                found[name] = value
    return found
