"""Mutants of a package: a file deleted or renamed, mistakes in package.xml, setup.py, launch files and RViz files."""

import re
from collections.abc import Callable, Iterable, Iterator
from itertools import chain

from grader.mutation.mutants import Mutant, MutantEdit, as_mutants, misspelt, mutants
from grader.mutation.python_mutants import python_changes
from grader.package.package import MANIFEST, SETUP, Package
from grader.package.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.source import Source

# Files for people: without them the package does the same.
_FOR_PEOPLE = (".md", ".rst", ".txt", ".pdf", ".docx", ".png", ".jpg", ".jpeg", ".gif", ".svg", ".mp4")
_FOR_PEOPLE_TOO = re.compile(
    r"(^|/)(test|tests|doc|docs|\.[^/]*)/"  # test/test_pep257.py, .github/workflows/build.yml
    r"|(^|/)(LICENSE|README|CHANGELOG|\.)[^/]*$"  # LICENSE, README.html, .gitignore
)
_XML_FAMILIES = ("attribute misspelt", "element deleted", "text misspelt", "name misspelt")
_DISPLAY_TEXTS = (("Class",), ("Description Topic", "Value"), ("Topic", "Value"))

Text = Callable[[str], str]  # returns the text of a file by its path in the submission


def package_mutants(package: Package, links: Iterable[str], text: Text) -> Iterator[Mutant]:
    """Yield the mutants of a package; `links` are those of its robot, `text` returns that of a file."""
    names = list(links)
    for own in package.tree.files:
        path = package.path(own)
        is_built = own.rpartition("/")[2] == "CMakeLists.txt"
        if is_built or not (own.lower().endswith(_FOR_PEOPLE) or _FOR_PEOPLE_TOO.search(own)):
            yield Mutant(f"file deleted: {own}", "file deleted", path, 1, is_deleted=True, tags=("file",))
            folder, slash, name = path.rpartition("/")
            renamed = f"{folder}{slash}{misspelt(name)}"
            yield Mutant(f"file renamed: {own}", "file renamed", path, 1, renamed=renamed, tags=("file",))
        kind = _kind(package, own)
        if kind is not None:
            content = text(path)
            changes = _rviz(path, own, content, names) if kind == "rviz" else _changes(path, own, content)
            yield from as_mutants(content, path, changes, (kind,))


def _kind(package: Package, own: str) -> str | None:
    """Return what a file is called where its mutants are grouped; None for one in which no mistakes are made here."""
    if own in (MANIFEST, SETUP):
        return own
    return "rviz" if own in package.rviz_files else "launch" if own in package.launch_files else None


def _changes(path: str, label: str, text: str) -> Iterator[MutantEdit]:
    """Yield the changes of a file that builds or starts something, by its format."""
    match path.rpartition(".")[2]:
        case "py":
            yield from python_changes(path, label, text)
        case "xml" | "launch":
            yield from _xml(path, label, text)
        case "yaml" | "yml":
            yield from _launch_yaml(path, label, text)


def _xml(path: str, label: str, text: str) -> Iterator[MutantEdit]:
    """Yield the changes of a launch file, or of the name and the build type in package.xml: no other tag is read."""
    for mutant in mutants(text, path):
        is_read = label != MANIFEST or not {"name", "build_type"}.isdisjoint(mutant.tags)
        if is_read and mutant.family in _XML_FAMILIES:
            place = f"{label} {mutant.id.partition(': ')[2]}"
            yield MutantEdit(mutant.family, place, mutant.start, mutant.end, mutant.new)


def _launch_yaml(path: str, label: str, text: str) -> Iterator[MutantEdit]:
    root, source = _yaml(path, text), Source(path, text)
    actions = root.get("launch") if root else None
    for number, item in enumerate(actions.items if actions else (), 1):
        yield MutantEdit("action removed", f"{label} {number}", *_line_span(source, item), "")
        for scalar in _scalars(item):
            yield from _misspelt(source, label, scalar)


def _rviz(path: str, label: str, text: str, links: list[str]) -> Iterator[MutantEdit]:
    """Yield changes of the fixed frame, and of each display: deleted, disabled, its class or topic misspelt."""
    root, source = _yaml(path, text), Source(path, text)
    frame = root.get("Visualization Manager", "Global Options", "Fixed Frame") if root else None
    if frame is not None and frame.text:
        for other in (misspelt(frame.text), *links):
            yield MutantEdit("fixed frame", f"{label} -> {other}", *frame.span, other)
    displays = root.get("Visualization Manager", "Displays") if root else None
    for display in displays.items if displays else ():
        title = display.get("Name") or display.get("Class")
        place = f"{label} {title.text if title else ''}".rstrip()
        yield MutantEdit("display deleted", place, *_line_span(source, display), "")
        enabled = display.get("Enabled")
        if enabled is not None and enabled.text == "true":
            yield MutantEdit("display disabled", place, *enabled.span, "false")
        for keys in _DISPLAY_TEXTS:
            node = display.get(*keys)
            if node is not None and node.text:
                yield from _misspelt(source, f"{place} {'/'.join(keys)}", node)


def _misspelt(source: Source, label: str, node: YamlNode) -> Iterator[MutantEdit]:
    start, end = node.span
    text = source.text[start:end].strip("'\"")
    if text:
        start = source.text.index(text, start)
        yield MutantEdit("text misspelt", f"{label} {text}", start, start + len(text), misspelt(text))


def _yaml(path: str, text: str) -> YamlNode | None:
    try:
        return read_yaml(text.encode("utf-8", "surrogateescape"), path)
    except YamlFault:
        return None


def _scalars(node: YamlNode) -> Iterator[YamlNode]:
    match node.value:
        case str():
            yield node
        case list(items):
            yield from chain.from_iterable(map(_scalars, items))
        case dict(values):
            yield from chain.from_iterable(map(_scalars, values.values()))


def _line_span(source: Source, node: YamlNode) -> tuple[int, int]:
    """Return the offsets of the lines of a mapping: up to the next line that is not as deep as its keys."""
    number, last = node.location.line + 1, source.text.count("\n") + 1
    indent = " " * (node.location.column - 1)
    while number <= last and (not source.line(number).strip() or source.line(number).startswith(indent)):
        number += 1
    return source.offset(node.location.line, 1), source.offset(number, 1) if number <= last else len(source.text)
