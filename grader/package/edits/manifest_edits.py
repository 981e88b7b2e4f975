"""Edits of package.xml: the name of the package and its build type."""

import re
from collections.abc import Iterator, Mapping
from typing import Any

from grader.edits import Proposal
from grader.package.edits.difference import restored, rewritten
from grader.package.edits.setup_edits import new_setup
from grader.package.edits.spelling import respelt
from grader.package.edits.task import Task, proposal
from grader.package.edits.xml_syntax import repaired
from grader.package.package import MANIFEST, SETUP
from grader.source import Edit, Location, Source

_TEXT = re.compile(r"<[^<>]*>\s*([^<]*?)\s*(?=<)")
_END = re.compile(r"</package\s*>")
_EXPORT_END = re.compile(r"[ \t]*</export\s*>")


def named(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits that give the package its name, in all its files, or create its package.xml."""
    yield from one_name(task, arguments["name"])
    yield from readable(task)


def one_name(task: Task, new: str) -> Iterator[Proposal]:
    """Yield edits that give the package one name in all its files, for a package that has another or several."""
    manifest, source, setup = task.package.manifest, task.source(MANIFEST), task.package.setup
    if manifest is None or source is None or manifest.name is None:
        return
    names = dict.fromkeys([manifest.name, *([setup.name] if setup and setup.name else []), *task.package.registered])
    names.pop(new, None)
    if not names:
        return
    edits = [_text(source, manifest.name_location, new)] if manifest.name != new else []
    for old in names:
        edits += _elsewhere(task, old, new)
    yield proposal(edits, "the name of the package", f"rename the package to {new}")
    modules = [
        task.renamed(path, path.replace(old, new, 1))
        for path in task.files
        for old in names
        if path.startswith(f"{old}/")
    ]
    if modules:
        action = f"rename the package to {new}, with its folder of Python files"
        yield proposal([*edits, *modules], "the name of the package", action)


def _elsewhere(task: Task, old: str, new: str) -> Iterator[Edit]:
    """Yield the edits of the other files that name the package."""
    word = re.compile(rf"(?<![\w.]){re.escape(old)}(?![\w.])")
    for path in (SETUP, *task.package.launch_files[:3]):
        file = task.python(path) if path.endswith(".py") else None
        for literal in file.literals if file is not None else ():
            text = word.sub(new, literal.text)
            if file is not None and text != literal.text and (path == SETUP or literal.text == old):
                yield file.source.edit(literal.start, literal.end, text)
    config = task.source("setup.cfg")
    if config is not None:
        yield from (config.edit(found.start(), found.end(), new) for found in word.finditer(config.text))
    if f"resource/{old}" in task.files and f"resource/{new}" not in task.files:
        yield task.renamed(f"resource/{old}", f"resource/{new}")


def _text(source: Source, at: Location, new: str) -> Edit:
    """Return the edit of the text of the element at a place."""
    start = source.offset(at.line, at.column)
    found = _TEXT.match(source.text, start)
    return source.edit(found.start(1), found.end(1), new) if found is not None else source.edit(start, start, new)


def typed(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits that set the build type; a package without a setup.py needs one, too."""
    manifest, source = task.package.manifest, task.source(MANIFEST)
    wanted = arguments["build_type"]
    if manifest is not None and source is not None and manifest.name is not None:
        needed = new_setup(task) if wanted == "ament_python" else []
        for edit in _type(source, manifest.type_location, wanted):
            also = ", and create its setup.py" if needed else ""
            yield proposal([edit, *needed], "the build type in package.xml", f"set the build type to {wanted}{also}")
        if needed:
            return  # with the build type alone, the package could not be built
    yield from readable(task)


def _type(source: Source, at: Location, wanted: str) -> Iterator[Edit]:
    start = source.offset(at.line, at.column)
    if source.text.startswith("<build_type", start):
        yield _text(source, at, wanted)
        return
    newline = "\r\n" if "\r\n" in source.text else "\n"
    element = f"<build_type>{wanted}</build_type>"
    export, end = _EXPORT_END.search(source.text), _END.search(source.text)
    if export is not None:
        indent = export[0][: len(export[0]) - len(export[0].lstrip())]
        yield source.edit(export.start(), export.start(), f"{indent}  {element}{newline}")
    elif end is not None:
        text = f"  <export>{newline}    {element}{newline}  </export>{newline}"
        yield source.edit(end.start(), end.start(), text)


def readable(task: Task) -> Iterator[Proposal]:
    """Yield edits after which ROS 2 reads package.xml: it is created, or written as in the reference."""
    wanted, source = task.wanted(MANIFEST), task.source(MANIFEST)
    if wanted is None:
        return
    if source is None:
        edits = task.created(MANIFEST, MANIFEST)
        yield proposal(edits, "a missing package.xml", "create package.xml as ros2 pkg create does")
        return
    manifest = task.package.manifest
    yield from repaired(source, MANIFEST)
    lines = [problem.location.line for problem in manifest.problems] if manifest is not None else []
    yield from respelt(source, [wanted], lines, MANIFEST)
    yield from restored(source, wanted, MANIFEST)
    if manifest is not None and manifest.name is None:
        whole = rewritten(source, wanted)
        yield proposal(
            [whole], "a package.xml that ROS 2 cannot read", "write package.xml as in the lab", is_rewrite=True
        )
