"""Edits of RViz files: the fixed frame, the displays and their classes, and the file's name."""

import posixpath
import re
from collections.abc import Iterator, Mapping
from typing import Any

from grader.edits import Proposal
from grader.package.edits.difference import restored, rewritten
from grader.package.edits.spelling import respelt
from grader.package.edits.task import Task, proposal
from grader.package.launch.model import Launch
from grader.package.rviz import Display, RvizFile, read_rviz, switched_on
from grader.package.yaml_nodes import Node
from grader.source import Edit, Location, Source

_WHAT = "the RViz file"
_SCALAR = re.compile(r""""[^"\n]*"|'[^'\n]*'|[^\s#][^\n\r]*?(?=\s*(?:\r?\n|$|\s#))""")
_OLD_CLASS = re.compile(r"(?<=Class: )rviz/(\w+)")
_PANELS = ("Displays", "Help", "Selection", "Time", "Tool Properties", "Transformation", "Views")


def named(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits that give the RViz file its name, or create it."""
    name = arguments["name"]
    files = task.package.rviz_files
    inside = [path for path in task.files if posixpath.dirname(path) == "rviz"]
    for path in (files or inside)[:2]:
        new = posixpath.join(posixpath.dirname(path), name)
        if new not in task.files:
            yield proposal(
                [task.renamed(path, new)], "a misspelt name of the RViz file", f"rename the RViz file to {name}"
            )
    yield from _created(task, name)


def _created(task: Task, name: str) -> Iterator[Proposal]:
    like = task.reference.rviz_file(name, None) if task.reference is not None else None
    edits = task.created(f"rviz/{name}", like) if not task.package.rviz_files else []
    if edits:
        yield proposal(edits, "a missing RViz file", "create the lab's RViz file")


def fixed_frame(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits that set the Fixed Frame."""
    read = _read(task, arguments)
    if read is not None and read[1].fault is None:
        source, rviz = read
        if rviz.fixed_frame is not None:
            launch = _launch(task, arguments)
            frames = launch.frames_of(arguments["frame"]) if launch is not None else (arguments["frame"],)
            for frame in filter(None, frames):
                edits = [_scalar(source, rviz.frame_location, frame)]
                added = "" if frame == arguments["frame"] else ", after the frame_prefix"
                yield proposal(edits, "the Fixed Frame of RViz", f"set the Fixed Frame to {arguments['frame']}{added}")
    yield from _readable(task, arguments)


def shows_robot(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits with which a RobotModel display is on and reads its topic."""
    yield from _display(task, arguments, "RobotModel", arguments.get("topic", "/robot_description"))


def display_on(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits with which a display of a class is on."""
    yield from _display(task, arguments, arguments["kind"].rpartition("/")[2], "")


def _display(task: Task, arguments: Mapping[str, Any], kind: str, topic: str) -> Iterator[Proposal]:
    read = _read(task, arguments)
    if read is not None and read[1].fault is None:
        source, rviz = read
        if edits := _classes(source):
            yield proposal(edits, "display classes of ROS 1", "use the display classes of ROS 2")
        for display in rviz.displays:
            if display.kind == kind and (edits := _settings(source, rviz, display, topic)):
                yield proposal(edits, f"a {kind} display that shows nothing", f"switch the {kind} display on")
        if not any(display.kind == kind for display in rviz.displays):
            yield from _added(task, source, arguments, kind)
    yield from _readable(task, arguments)


def _classes(source: Source) -> list[Edit]:
    """Return the edits of all classes of ROS 1."""
    return [
        source.edit(
            match.start(), match.end(), f"rviz_{'common' if match[1] in _PANELS else 'default_plugins'}/{match[1]}"
        )
        for match in _OLD_CLASS.finditer(source.text)
    ]


def _settings(source: Source, rviz: RvizFile, display: Display, topic: str) -> list[Edit]:
    """Return the edits of the settings with which a display shows nothing."""
    edits: list[Edit] = []
    around = [other for other in rviz.displays if _holds(other.node, display.node)]
    for node in (display.node, *(other.node for other in around)):
        switch = node.get("Enabled") or node.get("Value")
        if switch is not None and not switched_on(switch, default=True):
            edits.append(_scalar(source, switch.location, "true"))
    visual = display.node.get("Visual Enabled")
    if topic and visual is not None and not switched_on(visual, default=True):
        edits.append(_scalar(source, visual.location, "true"))
    read = display.node.get("Description Topic", "Value") or display.node.get("Description Topic")
    if topic and read is not None and read.text is not None and read.text.strip("/") != topic.strip("/"):
        edits.append(_scalar(source, read.location, topic))
    if display.package in ("", "rviz") and (named := display.node.get("Class")) is not None:
        edits.append(_scalar(source, named.location, f"rviz_default_plugins/{display.kind}"))
    return edits


def _holds(group: Node, inner: Node) -> bool:
    listed = group.get("Displays")
    return listed is not None and any(item is inner or _holds(item, inner) for item in listed.items)


def _scalar(source: Source, at: Location, new: str) -> Edit:
    """Return the edit of the value at a place."""
    start = source.offset(at.line, at.column)
    found = _SCALAR.match(source.text, start)
    if found is None:  # nothing stands there
        gap = " " if source.text[start - 1 : start].strip() else ""
        return source.edit(start, start, gap + new)
    return source.edit(start, found.end(), new)


def _added(task: Task, source: Source, arguments: Mapping[str, Any], kind: str) -> Iterator[Proposal]:
    """Yield the edit that adds a display as it is in the reference."""
    like = task.reference.rviz_file(arguments["name"], None) if task.reference is not None else None
    wanted = task.wanted(like)
    block = _block(wanted, kind) if wanted else ""
    displays = re.search(r"^( *)Displays:[ \t]*(\[\])?[ \t]*\r?\n", source.text, re.MULTILINE)
    if block and displays is not None:
        first = re.compile(r" *(?=- )").match(source.text, displays.end())
        indent = first[0] if first is not None and not displays[2] else displays[1] + "  "
        newline = "\r\n" if "\r\n" in source.text else "\n"
        text = "".join(f"{indent}{line}{newline}" for line in block.split("\n"))
        edits = [source.edit(displays.end(), displays.end(), text)]
        if displays[2]:
            edits.append(source.edit(displays.start(2), displays.end(2), ""))
        yield proposal(edits, f"a missing {kind} display", f"add a {kind} display")


def _block(wanted: str, kind: str) -> str:
    """Return the lines of a display in the reference's file, without their indentation."""
    read = read_rviz(wanted.encode(), "")
    display = next((display for display in read.displays if display.kind == kind), None)
    if display is None:
        return ""
    lines = wanted.split("\n")[display.node.location.line - 1 :]
    depth = display.node.location.column - 1
    count = next(
        (i for i, line in enumerate(lines[1:], 1) if line.strip() and not line.startswith(" " * depth)), len(lines)
    )
    own = [line[depth:] if line[:depth].strip() == "" else "  " + line[depth:] for line in lines[:count]]
    return "\n".join(["- " + lines[0][depth:], *("  " + line for line in own[1:])]).rstrip()


def _readable(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits that make the file as the reference's, or create it."""
    read = _read(task, arguments)
    if read is None:
        yield from named(task, arguments)
        return
    source, rviz = read
    like = task.reference.rviz_file(arguments["name"], None) if task.reference is not None else None
    wanted = task.wanted(like)
    if wanted is not None:
        lines = [rviz.fault.location.line] if rviz.fault is not None else []
        yield from respelt(source, [wanted], lines, _WHAT)
        yield from restored(source, wanted, _WHAT)
        if rviz.fault is not None:
            whole = rewritten(source, wanted)
            yield proposal([whole], "an RViz file that RViz cannot read", "use the lab's RViz file", is_rewrite=True)


def _launch(task: Task, arguments: Mapping[str, Any]) -> Launch | None:
    opened = task.package.launch_file(arguments.get("launch", "")) if arguments.get("launch") else None
    return task.package.launch(opened) if opened is not None else None


def _read(task: Task, arguments: Mapping[str, Any]) -> tuple[Source, RvizFile] | None:
    """Return the text of the graded RViz file, and what it says."""
    path = task.package.rviz_file(arguments["name"], _launch(task, arguments))
    source = task.source(path) if path is not None else None
    return (source, task.package.rviz(path)) if source is not None and path is not None else None
