"""Edits of launch files: their names, their syntax, the nodes that they start and the files that they name."""

import posixpath
from collections.abc import Iterator, Mapping
from typing import Any

from grader.edits import Proposal
from grader.package.edits.difference import restored, rewritten
from grader.package.edits.launch_files import found
from grader.package.edits.launch_nodes import started
from grader.package.edits.python_file import PythonFile
from grader.package.edits.python_names import defined
from grader.package.edits.spelling import respelt
from grader.package.edits.syntax import repaired
from grader.package.edits.task import Task, proposal
from grader.package.edits.xml_syntax import repaired as repaired_xml
from grader.package.launch.model import Launch
from grader.source import Edit, Source

_WHAT = "the launch file"
# The words of launch files in XML and YAML.
_FRONTEND = """launch node pkg exec name args output if unless arg default description value param from include file let group
find-pkg-share find-pkg-prefix var env eval command dirname true false screen xacro robot_description ros_args remap"""


def named(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits that give the launch file its name, or create it."""
    name = arguments["name"]
    path = task.package.launch_file(name)
    if path is None:
        yield from created_launch(task, name)
        return
    new = posixpath.join(posixpath.dirname(path), name)
    if new not in task.files:
        edits = [task.renamed(path, new), *_mentions(task, posixpath.basename(path), name)]
        yield proposal(edits, "a misspelt name of the launch file", f"rename the launch file to {name}")


def created_launch(task: Task, name: str) -> Iterator[Proposal]:
    """Yield the edit that creates the launch file of the reference: the course hands it out."""
    like = task.reference.launch_file(name) if task.reference is not None else None
    if edits := task.created(f"launch/{name}", like):
        yield proposal(edits, "a missing launch file", "create the lab's launch file")


def _mentions(task: Task, old: str, new: str) -> list[Edit]:
    """Return the edits of setup.py that name a file which gets another name."""
    file = task.setup
    literals = file.literals if file is not None else []
    return [
        file.source.edit(literal.start, literal.end, literal.text.removesuffix(old) + new)
        for literal in literals
        if file is not None and posixpath.basename(literal.text) == old
    ]


def starts(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits with which the launch file starts nodes."""
    yield from _edits(task, arguments["name"], arguments["nodes"])


def finds_files(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits with which the launch file finds the files that it names."""
    yield from _edits(task, arguments["name"], ())


def _edits(task: Task, name: str, nodes: list[str] | tuple[()]) -> Iterator[Proposal]:
    path = task.package.launch_file(name)
    source = task.source(path) if path is not None else None
    if path is None or source is None:
        yield from created_launch(task, name)
        return
    wanted = _reference_text(task, path, name)
    like = PythonFile(Source("", wanted)) if wanted else None
    launch = task.package.launch(path)
    if launch.syntax is None:
        yield from started(launch, source, nodes, like) if nodes else found(task, launch, source, like)
    yield from task.once(path, lambda: _readable(task, launch, source, wanted))


def _readable(task: Task, launch: Launch, source: Source, wanted: str | None) -> Iterator[Proposal]:
    """Yield edits after which the launch file is read, and starts; the last is the file of the reference."""
    faults = [fault.location for fault in (*filter(None, [launch.syntax]), *launch.faults)]
    faults = [place for place in faults if place.path == source.path]
    is_python = not source.path.endswith((".xml", ".yaml", ".yml"))
    if launch.syntax is not None:
        yield from repaired(PythonFile(source), _WHAT) if is_python else repaired_xml(source, _WHAT)
    elif is_python:
        yield from defined(PythonFile(source), faults, _WHAT)
    for literal in PythonFile(source).literals if is_python else ():
        if literal.text in ("xacro", "cat"):
            edits = [source.edit(literal.start, literal.end, f"{literal.text} ")]
            yield proposal(
                edits, "a missing space in a command", "add the space that separates the program from the path"
            )
    words = [wanted or ("" if is_python else _FRONTEND), *task.package.installed]
    yield from respelt(source, words, (place.line for place in faults), _WHAT)
    if wanted:
        yield from restored(source, wanted, _WHAT)
        if faults:
            whole = rewritten(source, wanted)
            yield proposal([whole], "a launch file that does not start", "use the lab's launch file", is_rewrite=True)


def _reference_text(task: Task, path: str, name: str) -> str | None:
    """Return the text of the reference's launch file, if it is in the same language."""
    like = task.reference.launch_file(name) if task.reference is not None else None
    if like is None or posixpath.splitext(like)[1] != (posixpath.splitext(path)[1] or ".py"):
        return None
    return task.wanted(like)
