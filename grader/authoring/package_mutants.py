"""Mutants of a package: a file deleted or renamed, mistakes in package.xml, setup.py, launch files and RViz files."""

import ast
import re
from collections.abc import Callable, Iterable, Iterator

from grader.authoring.mutants import Mutant, MutantEdit, as_mutants, misspelt, mutants
from grader.hints.package.python_file import PythonFile, keyword
from grader.package.package import MANIFEST, SETUP, Package
from grader.package.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.source import Source

# Files for people: without them the package does the same.
_UNUSED = re.compile(
    r"(?i:\.(md|rst|(?<!CMakeLists\.)txt|pdf|docx|png|jpe?g|gif|svg|mp4))$"
    r"|(^|/)(test|tests|doc|docs|\.[^/]*)/"  # test/test_pep257.py, .github/workflows/build.yml
    r"|(^|/)(LICENSE|README|CHANGELOG|\.)[^/]*$"  # LICENSE, README.html, .gitignore
)
# Arguments of setup() that only people read.
_FOR_PEOPLE = re.compile(
    "(long_)?description|(author|maintainer)(_email)?|(install|tests)_requires?|classifiers|exclude|keywords|license|url"
    "|version|zip_safe"
)
_XML_FAMILIES = ("element deleted", "text misspelt", "name misspelt")
_READ_OF_MANIFEST = re.compile(r"(name|export/build_type)\b")
_DISPLAY_TEXTS = (("Class",), ("Description Topic", "Value"), ("Topic", "Value"))
_MAX_LABEL = 70

Text = Callable[[str], str]  # returns the text of a file by its path in the submission


def package_mutants(package: Package, links: Iterable[str], text: Text) -> Iterator[Mutant]:
    """Yield the mutants of a package; `links` are those of its robot, `text` returns that of a file."""
    for own in package.tree.files:
        path = package.path(own)
        if not _UNUSED.search(own):
            name = path.rpartition("/")[2]
            renamed = f"{path.removesuffix(name)}{misspelt(name)}"
            yield Mutant(f"file deleted: {own}", "file deleted", path, 1, is_deleted=True)
            yield Mutant(f"file renamed: {own}", "file renamed", path, 1, is_deleted=True, renamed=renamed)
        if own in package.rviz_files:
            yield from as_mutants(text(path), path, _rviz(Source(path, text(path)), own, links))
        elif own in (MANIFEST, SETUP) or own in package.launch_files:
            yield from as_mutants(text(path), path, _changes(Source(path, text(path)), own))


def _changes(source: Source, label: str) -> Iterator[MutantEdit]:
    """Yield the changes of a file that builds or starts something, by its format."""
    if source.path.endswith(".py"):
        yield from python_changes(PythonFile(source), label)
        return
    for mutant in mutants(source.text):
        place = mutant.id.partition(": ")[2]
        if mutant.family in _XML_FAMILIES and (label != MANIFEST or _READ_OF_MANIFEST.match(place)):
            yield MutantEdit(mutant.family, f"{label} {place}", mutant.start, mutant.end, mutant.new)


def _rviz(source: Source, label: str, links: Iterable[str]) -> Iterator[MutantEdit]:
    """Yield changes of the fixed frame, and of each display: disabled, its class or topic misspelt."""
    try:
        root = read_yaml(source.text.encode("utf-8", "surrogateescape"), source.path)
    except YamlFault:
        return
    frame = root.get("Visualization Manager", "Global Options", "Fixed Frame") if root else None
    if frame is not None and frame.text:
        for other in (misspelt(frame.text), *links):
            yield MutantEdit("fixed frame", f"{label} -> {other}", *frame.span, other)
    displays = root.get("Visualization Manager", "Displays") if root else None
    for display in displays.items if displays else ():
        yield from _of_display(display, label)


def _of_display(display: YamlNode, label: str) -> Iterator[MutantEdit]:
    title, enabled = display.get("Name") or display.get("Class"), display.get("Enabled")
    place = f"{label} {title.text if title else ''}".rstrip()
    if enabled is not None and enabled.text == "true":
        yield MutantEdit("display disabled", place, *enabled.span, "false")
    for keys in _DISPLAY_TEXTS:
        node = display.get(*keys)
        if node is not None and node.text:
            yield MutantEdit("text misspelt", f"{place} {'/'.join(keys)}", *node.span, misspelt(node.text))


def python_changes(file: PythonFile, label: str) -> Iterator[MutantEdit]:
    """Yield the changes of a file: an entry of data_files, an action or an import deleted, a string misspelt."""
    is_setup = label == SETUP
    family = "data_files entry deleted" if is_setup else "action removed"
    for item in _entries(file):
        start, end = file.span(item)
        comma = re.compile(r"\s*,").match(file.text, end)
        yield MutantEdit(family, f"{label} {_short(file, item)}", start, comma.end() if comma else end, "")
    for call in file.calls("add_action"):
        action = call.args[0] if call.args else call
        yield MutantEdit(family, f"{label} {_short(file, action)}", *file.span(call), "None")
    for node in file.imports if is_setup else ():
        yield MutantEdit("import deleted", f"{label} {file.segment(node)}", *file.span(node), "pass")
    ignored = [*_for_people(file)]
    for text, start, end in file.literals:
        if text.strip() and not any(first <= start < last for first, last in ignored):
            yield MutantEdit("string misspelt", f"{label} {text[:_MAX_LABEL]}", start, end, misspelt(text))


def _entries(file: PythonFile) -> Iterator[ast.expr]:
    """Yield the entries of data_files, and the actions of a launch file."""
    given = [keyword(call, "data_files") for call in file.calls("setup")]
    lists = [found.value for found in given if found is not None]
    lists += [call.args[0] for call in file.calls("LaunchDescription") if call.args]
    for found in lists:
        yield from found.elts if isinstance(found, ast.List | ast.Tuple) else ()


def _short(file: PythonFile, node: ast.expr) -> str:
    """Return what tells an item of a list from others: the executable of a node, else its text."""
    executable = keyword(node, "executable") if isinstance(node, ast.Call) else None
    text = " ".join(file.segment(executable.value if executable is not None else node).split())
    return text.strip("'\"") if len(text) <= _MAX_LABEL else text[:_MAX_LABEL]


def _for_people(file: PythonFile) -> Iterator[tuple[int, int]]:
    """Yield the offsets of docstrings and of arguments that only people read."""
    for node in file.nodes:
        match node:
            case ast.Expr(value=ast.Constant()):
                yield file.span(node)
            case ast.keyword(arg=str(name)) if _FOR_PEOPLE.fullmatch(name):
                yield file.span(node)
