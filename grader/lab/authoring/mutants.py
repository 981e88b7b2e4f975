"""Mutants of a reference: one file with one mistake.

There is one for every single edit that a mutation allows.

Those of a URDF or xacro text come first; then those of a package: a file deleted or renamed, and
mistakes in package.xml, setup.py, launch files and RViz files.
"""

import ast
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import chain
from math import degrees
from posixpath import basename
from typing import NamedTuple

from grader.base.grouping import Span
from grader.base.markup import Attribute, attributes, element_end, head_end, name_end
from grader.base.patterns import on_use
from grader.base.source import Source
from grader.ros.config.yaml_nodes import YamlNode, yaml_root
from grader.ros.package.package import MANIFEST, SETUP, Package
from grader.ros.python.python_file import PythonFile, argument
from grader.ros.xml.parsing import Element, parse_root
from grader.ros.xml.urdf_format import JOINT_TYPES, PARTS

_COMMA = on_use(r"\s*,")
_NUMBER = on_use(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
_NAMES = ("name", "link", "joint", "reference")
_BOX = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'


class Mutant(NamedTuple):
    """One file of a solution with one mistake."""

    # stable: the mutation and the place by names, `number x10: joint base_lidar_joint/origin xyz.z`
    id: str
    mutation: str
    path: str
    line: int
    start: int = 0  # from here to `end`, the text becomes `new`
    end: int = 0
    new: str = ""
    is_deleted: bool = False  # whether the file is gone, or is at the path `renamed`
    renamed: str = ""

    def applied(self, text: str) -> str:
        """Return the text of its file with the mistake."""
        return text[: self.start] + self.new + text[self.end :]


class MutantEdit(NamedTuple):
    """A change of a text between two offsets.

    It has its mutation, and its place by names, with what tells it from others.
    """

    mutation: str
    place: str
    start: int
    end: int
    new: str


MutantEdits = Iterator[MutantEdit]


def mutants(text: str, path: str = "", hidden: Collection[str] = ()) -> Iterator[Mutant]:
    """Yield every mutant of a URDF or xacro once.

    `hidden` are links that must show nothing, which show a box.
    """
    return _as_mutants(text, path, _changes(text, {f"link {name}" for name in hidden}))


def _as_mutants(
    text: str, path: str, changes: Iterable[MutantEdit], label: str = ""
) -> Iterator[Mutant]:
    """Yield the mutants that changes of a file make, each once and with an id of its own.

    `label` is what ids have before the places in the file.
    """
    seen = set()
    ids: Counter[str] = Counter()
    for mutation, place, start, end, new in changes:
        if (start, end, new) in seen or text[start:end] == new:
            continue
        seen.add((start, end, new))
        name = f"{mutation}: {' '.join(filter(None, (label, place)))}"
        ids[name] += 1
        name += f" ({ids[name]})" if ids[name] > 1 else ""
        yield Mutant(name, mutation, path, text.count("\n", 0, start) + 1, start, end, new)


def _names_by_tag(elements: Iterable[Element]) -> dict[str, list[str]]:
    """Return the names of links, joints and materials, each where it is written."""
    names: dict[str, list[str]] = {"link": [], "joint": [], "material": []}
    for element in elements:
        if element.tag in names:
            names[str(element.tag)].append(element.get("name", ""))
    return names


def _changes(text: str, hidden: Collection[str]) -> MutantEdits:
    places = list(_places(text))
    names = _names_by_tag(element for element, *_ in places)
    for element, label, start in places:
        for attribute in attributes(text, start):
            yield from _attribute_changes(text, element, label, attribute, names)
        if element.getparent() is None:
            continue
        (head, is_empty), end = head_end(text, start), element_end(text, start)
        if not len(element) and (element.text or "").strip():
            yield from _value_changes(text, label, (head, text.rindex("</", head, end)), "")
        yield MutantEdit("element deleted", label, start, end, "")
        if label in hidden:
            if is_empty:  # <link name="x"/>
                yield MutantEdit("visual added", label, head - len("/>"), head, f">{_BOX}</link>")
            else:
                yield MutantEdit("visual added", label, head, head, _BOX)


def _places(text: str) -> Iterator[tuple[Element, str, int]]:
    """Yield each element with its offset, and its place by names.

    The place does not change if lines are added.
    """
    root, source = parse_root(text)
    if root is None:
        return
    labels: dict[Element, str] = {}
    counts: Counter[str] = Counter()
    for index, element in enumerate(root.iter("*")):
        parent, (_, start) = element.getparent(), source.element(index)
        label = text[start + 1 : name_end(text, start)]
        if parent is None:
            counts[label] += 1
            yield element, label, start
            continue
        # Inside a link, the name of a material is a value and no place.
        if element.tag != "material" or parent is root:
            label = f"{label} {element.get('name') or element.get('reference') or ''}".strip()
        if parent is not root:
            label = f"{labels[parent]}/{label}"
        counts[label] += 1
        if counts[label] > 1:  # of equal siblings: visual 2
            label += f" {counts[label]}"
        labels[element] = label
        yield element, label, start


def _next_name(known: Sequence[str], value: str) -> str:
    """Return the name after this one, or the first; empty if there is no other one."""
    at = known.index(value) + 1 if value in known else 0
    for name in (*known[at:], *known[:at]):
        if name != value:
            return name
    return ""


def _attribute_changes(
    text: str,
    element: Element,
    label: str,
    attribute: Attribute,
    names: Mapping[str, Sequence[str]],
) -> MutantEdits:
    name = attribute.name
    span = attribute.value
    place = f"{label} {name}"
    yield MutantEdit("attribute deleted", place, attribute.start - 1, attribute.end, "")
    if name in _NAMES:
        value = text[slice(*span)]
        known = names.get(str(element.tag), names.get(name, names["link"]))
        yield MutantEdit("name misspelt", place, *span, misspelt(value))
        other = _next_name(known, value)
        if other:
            yield MutantEdit("name exchanged", f"{place} -> {other}", *span, other)
    elif name == "type" and element.tag == "joint":
        yield from (
            MutantEdit("type", f"{place} -> {other}", *span, other) for other in JOINT_TYPES
        )
    elif name not in ("version", "encoding", "params") and not name.startswith("xmlns"):
        yield from _value_changes(text, label, span, name)


def _value_changes(text: str, label: str, span: Span, name: str) -> MutantEdits:
    """Yield changes of a value: of each number in it, else of the text."""
    start, end = span
    label = f"{label} {name}".rstrip()
    pieces = list(_NUMBER.finditer(text, start, end))
    for part, match in zip(_parts(name, len(pieces)), pieces, strict=True):
        for mutation, number in _alternatives(float(match[0])):
            if number != float(match[0]):
                yield MutantEdit(mutation, f"{label}{part}", *match.span(), f"{number:.6g}")
    value = text[start:end].strip()
    if not pieces and value:
        start = text.index(value, start)
        yield MutantEdit("text misspelt", label, start, start + len(value), misspelt(value))


def _parts(name: str, count: int) -> list[str]:
    """Return what tells the numbers of a value apart: .x, .y and .z of an xyz."""
    if count == 1:
        return [""]
    known = PARTS.get(name, ())
    return [f".{part}" for part in (known if len(known) == count else range(1, count + 1))]


def _alternatives(value: float) -> Iterable[tuple[str, float]]:
    return (
        ("number negated", -value),
        ("number x10", value * 10),
        ("number +0.05", value + 0.05),
        ("number -0.05", value - 0.05),
        ("number zero", 0.0),
        ("number in degrees", degrees(value)),
    )


def misspelt(name: str) -> str:
    """Return a text without the letter in its middle."""
    middle = len(name) // 2
    if len(name) > 3:
        return name[:middle] + name[middle + 1 :]
    return f"{name}x"


# Files for people: without them the package does the same.
_UNUSED = on_use(
    r"(?i:\.(md|rst|(?<!CMakeLists\.)txt|pdf|docx|png|jpe?g|gif|svg|mp4))$"
    r"|(^|/)(test|tests|doc|docs|\.[^/]*)/"  # test/test_pep257.py, .github/workflows/build.yml
    r"|(^|/)(LICENSE|README|CHANGELOG|\.)[^/]*$"  # LICENSE, README.html, .gitignore
)
# Arguments of setup() that only people read.
_FOR_PEOPLE = on_use(
    "(long_)?description|(author|maintainer)(_email)?|(install|tests)_requires?|classifiers|exclude|keywords|license|url"
    "|version|zip_safe"
)
_READ_OF_MANIFEST = on_use(r"(name|export/build_type)\b")
_DISPLAY_TEXTS = (("Class",), ("Description Topic", "Value"), ("Topic", "Value"))
MAX_LABEL = 70

_Text = Callable[[str], str]  # returns the text of a file by its path in the submission
_Changes = Callable[[Source], Iterable[MutantEdit]]  # of a file


def package_mutants(
    package: Package,
    links: Iterable[str],
    text: _Text,
    further: _Changes = lambda _: (),
    *,
    prefix: str = "",
) -> Iterator[Mutant]:
    """Yield the mutants of a package.

    `links` are those of its robot, `text` returns that of a file.

    `further` returns more changes of a file; `prefix` is what ids have before the paths in the
    package.
    """
    for file in package.tree.files:
        path = package.path(file)
        label = prefix + file
        if not _UNUSED.search(file):
            name = basename(path)
            renamed = f"{path.removesuffix(name)}{misspelt(name)}"
            yield Mutant(f"file deleted: {label}", "file deleted", path, 1, is_deleted=True)
            yield Mutant(
                f"file renamed: {label}", "file renamed", path, 1, is_deleted=True, renamed=renamed
            )
        source = Source(path, text(path))
        changes: Iterable[MutantEdit] = ()
        if file in package.rviz_files:
            changes = _rviz(source, links)
        elif file in (MANIFEST, SETUP) or file in package.launch_files:
            changes = _file_changes(source, file)
        yield from _as_mutants(source.text, path, chain(changes, further(source)), label)


def _file_changes(source: Source, file: str) -> MutantEdits:
    """Yield the changes of a file that builds or starts something, by its format."""
    if source.path.endswith(".py"):
        yield from _python_changes(PythonFile(source), is_setup=file == SETUP)
        return
    for mutant in mutants(source.text):
        place = mutant.id.partition(": ")[2]
        if mutant.mutation in ("element deleted", "text misspelt", "name misspelt") and (
            file != MANIFEST or _READ_OF_MANIFEST.match(place)
        ):
            yield MutantEdit(mutant.mutation, place, mutant.start, mutant.end, mutant.new)


def _rviz(source: Source, links: Iterable[str]) -> MutantEdits:
    """Yield changes of the fixed frame, and of each display.

    A display is disabled, or its class or topic is misspelt.
    """
    root = yaml_root(source)
    frame = root.get("Visualization Manager", "Global Options", "Fixed Frame") if root else None
    if frame and frame.text:
        for other in (misspelt(frame.text), *links):
            yield MutantEdit("fixed frame", f"-> {other}", *frame.span, other)
    displays = root.get("Visualization Manager", "Displays") if root else None
    for display in displays.items if displays else ():
        yield from _display_changes(display)


def _display_changes(display: YamlNode) -> MutantEdits:
    title = display.get("Name") or display.get("Class")
    enabled = display.get("Enabled")
    place = title.text or "" if title else ""
    if enabled and enabled.text == "true":
        yield MutantEdit("display disabled", place, *enabled.span, "false")
    for keys in _DISPLAY_TEXTS:
        node = display.get(*keys)
        if node and node.text:
            path = f"{place} {'/'.join(keys)}".lstrip()
            yield MutantEdit("text misspelt", path, *node.span, misspelt(node.text))


def _python_changes(file: PythonFile, *, is_setup: bool) -> MutantEdits:
    """Yield the changes of a Python file.

    An entry of data_files, an action or an import is deleted, a string is misspelt.
    """
    mutation = "data_files entry deleted" if is_setup else "action removed"
    for item in _entries(file):
        start, end = file.span(item)
        comma = _COMMA.match(file.text, end)
        end = comma.end() if comma else end
        yield MutantEdit(mutation, _short(file, item), start, end, "")
    for call in file.calls("add_action"):
        action = call.args[0] if call.args else call
        yield MutantEdit(mutation, _short(file, action), *file.span(call), "None")
    if is_setup:
        for node in file.imports:
            yield MutantEdit("import deleted", file.segment(node), *file.span(node), "pass")
    yield from _string_changes(file)


def _string_changes(file: PythonFile) -> MutantEdits:
    """Yield that a string is misspelt, but none for people."""
    ignored = list(_for_people(file))
    for text, start, end in file.literals:
        is_ignored = any(first <= start < last for first, last in ignored)
        if text.strip() and not is_ignored:
            yield MutantEdit("string misspelt", text[:MAX_LABEL], start, end, misspelt(text))


def _entries(file: PythonFile) -> Iterator[ast.expr]:
    """Yield the entries of data_files, and the actions of a launch file."""
    given = [argument(call, "data_files") for call in file.calls("setup")]
    lists = [keyword.value for keyword in given if keyword]
    lists += [call.args[0] for call in file.calls("LaunchDescription") if call.args]
    for value in lists:
        if isinstance(value, ast.List | ast.Tuple):
            yield from value.elts


def _short(file: PythonFile, node: ast.expr) -> str:
    """Return what tells an item of a list from others: the executable of a node, else its text."""
    executable = argument(node, "executable") if isinstance(node, ast.Call) else None
    text = " ".join(file.segment(executable.value if executable else node).split())
    if len(text) <= MAX_LABEL:
        return text.strip("'\"")
    return text[:MAX_LABEL]


def _for_people(file: PythonFile) -> Iterator[Span]:
    """Yield the offsets of docstrings and of arguments that only people read."""
    for node in file.nodes:
        match node:
            case ast.Expr(value=ast.Constant()):
                yield file.span(node)
            case ast.keyword(arg=str(name)) if _FOR_PEOPLE.fullmatch(name):
                yield file.span(node)
