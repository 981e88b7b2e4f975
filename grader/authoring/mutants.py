"""Mutants of a URDF or xacro text: every single edit that a family of mistakes allows."""

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from math import degrees
from typing import NamedTuple

from grader.markup import Attribute, attributes, element_end, head_end, name_end
from grader.source import Source
from grader.xml.parsing import Element, XmlFault, XmlFile, read_document
from grader.xml.urdf_format import JOINT_TYPES, PARTS

_NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
_NAMES = ("name", "link", "joint", "reference")
_UNTOUCHED = ("version", "encoding", "params")
_BOX = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'


class Mutant(NamedTuple):
    """One file of a solution with one mistake.

    `id` is stable: the family and the place by names, `number x10: joint base_lidar_joint/origin xyz.z`. From `start`
    to `end` the text becomes `new`; a file that `is_deleted` is gone, or is at the path `renamed`.
    """

    id: str
    family: str
    path: str
    line: int
    start: int = 0
    end: int = 0
    new: str = ""
    is_deleted: bool = False
    renamed: str = ""

    def applied(self, text: str) -> str:
        """Return the text of its file with the mistake."""
        return text[: self.start] + self.new + text[self.end :]


class MutantEdit(NamedTuple):
    """A change of a text between two offsets: its family, and its place by names, with what tells it from others."""

    family: str
    label: str
    start: int
    end: int
    new: str


def mutants(text: str, path: str = "", hidden: Collection[str] = ()) -> Iterator[Mutant]:
    """Yield every mutant of a URDF or xacro once; `hidden` are links that must show nothing, which show a box."""
    return as_mutants(text, path, _changes(text, {f"link {name}" for name in hidden}))


def as_mutants(text: str, path: str, changes: Iterable[MutantEdit]) -> Iterator[Mutant]:
    """Yield the mutants that changes of a file make, each once and with an id of its own."""
    seen: set[tuple[int, int, str]] = set()
    ids: Counter[str] = Counter()
    for family, label, start, end, new in changes:
        if (start, end, new) in seen or text[start:end] == new:
            continue
        seen.add((start, end, new))
        name = f"{family}: {label}"
        ids[name] += 1
        name += f" ({ids[name]})" if ids[name] > 1 else ""
        yield Mutant(name, family, path, text.count("\n", 0, start) + 1, start, end, new)


def _changes(text: str, hidden: Collection[str]) -> Iterator[MutantEdit]:
    places = list(_places(text))
    names = {tag: [it.get("name", "") for it, *_ in places if it.tag == tag] for tag in ("link", "joint", "material")}
    for element, label, start in places:
        for attribute in attributes(text, start):
            yield from _of_attribute(text, element, label, attribute, names)
        if element.getparent() is None:
            continue
        (head, is_empty), end = head_end(text, start), element_end(text, start)
        if not len(element) and (element.text or "").strip():
            yield from _of_value(text, label, (head, text.rindex("</", head, end)), "")
        yield MutantEdit("element deleted", label, start, end, "")
        if label in hidden:
            new = f">{_BOX}</link>" if is_empty else _BOX
            yield MutantEdit("visual added", label, head - 2 * is_empty, head, new)


def _places(text: str) -> Iterator[tuple[Element, str, int]]:
    """Yield each element with its offset, and its place by names, which does not change if lines are added."""
    data, source = text.encode("utf-8", "surrogateescape"), Source("", text)
    try:
        root: Element | None = XmlFile(data, source).root
    except XmlFault:
        document = read_document(data, "")
        root, source = document.root, document.source
    labels: dict[Element | None, str] = {}
    counts: Counter[str] = Counter()
    for index, element in enumerate(root.iter("*") if root is not None else ()):
        parent, (_, start) = element.getparent(), source.element(index)
        is_named = parent is not None and (element.tag != "material" or parent.getparent() is None)
        name = (element.get("name") or element.get("reference") or "") if is_named else ""
        label = f"{text[start + 1 : name_end(text, start)]} {name}".strip()
        label = f"{labels[parent]}/{label}" if labels.get(parent) else label
        counts[label] += 1
        label += f" {counts[label]}" if counts[label] > 1 else ""  # of equal siblings: visual 2
        labels[element] = label if parent is not None else ""
        yield element, label, start


def _of_attribute(
    text: str, element: Element, label: str, attribute: Attribute, names: Mapping[str, Sequence[str]]
) -> Iterator[MutantEdit]:
    name, span = attribute.name, attribute.value
    place = f"{label} {name}"
    yield MutantEdit("attribute deleted", place, attribute.start - 1, attribute.end, "")
    if name in _NAMES:
        value = text[slice(*span)]
        known = names.get(str(element.tag), names.get(name, names["link"]))
        yield MutantEdit("name misspelt", place, *span, misspelt(value))
        at = known.index(value) + 1 if value in known else 0
        other = next((it for it in (*known[at:], *known[:at]) if it != value), "")
        yield from [MutantEdit("name exchanged", f"{place} -> {other}", *span, other)] if other else []
    elif name == "type" and element.tag == "joint":
        yield from (MutantEdit("type", f"{place} -> {other}", *span, other) for other in JOINT_TYPES)
    elif name not in _UNTOUCHED and not name.startswith("xmlns"):
        yield from _of_value(text, label, span, name)


def _of_value(text: str, label: str, span: tuple[int, int], name: str) -> Iterator[MutantEdit]:
    """Yield changes of a value: of each number in it, else of the text."""
    start, end = span
    label = f"{label} {name}".rstrip()
    pieces = list(_NUMBER.finditer(text, start, end))
    for part, found in zip(_parts(name, len(pieces)), pieces, strict=True):
        for family, number in _alternatives(float(found[0])):
            if number != float(found[0]):
                yield MutantEdit(family, f"{label}{part}", *found.span(), f"{number:.6g}")
    value = text[start:end].strip()
    if not pieces and value:
        start = text.index(value, start)
        yield MutantEdit("text misspelt", label, start, start + len(value), misspelt(value))


def _parts(name: str, count: int) -> list[str]:
    """Return what tells the numbers of a value apart: .x, .y and .z of an xyz."""
    known = PARTS.get(name, ())
    return [""] if count == 1 else [f".{part}" for part in (known if len(known) == count else range(1, count + 1))]


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
    return name[:middle] + name[middle + 1 :] if len(name) > 3 else f"{name}x"
