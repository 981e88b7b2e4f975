"""Mutants of a URDF or xacro text: every single edit that a family of mistakes allows."""

import re
from collections.abc import Collection, Iterable, Iterator
from itertools import pairwise
from math import degrees
from typing import NamedTuple

from grader.markup import Attribute
from grader.mutation.elements import Element, elements, names_of_tag, text_span
from grader.xml.urdf_format import JOINT_TYPES, PARTS

_NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
_NAMES = ("name", "link", "joint", "reference")
_UNTOUCHED = ("version", "encoding")
_TYPES = (*JOINT_TYPES, "Fixed", "rotating")
_MAX_EXCHANGED = 12  # other names that a name becomes
_BOX = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'


class Mutant(NamedTuple):
    """One file of a solution with one mistake.

    `id` is stable: the family and the place by names, `number x10: joint base_lidar_joint/origin xyz.z`. From `start`
    to `end` the text becomes `new`; a file that is `renamed` gets this path, and one that `is_deleted` is gone. `tags`
    are those of the element that is changed, from the root, and the attribute with an @.
    """

    id: str
    family: str
    path: str
    line: int
    start: int = 0
    end: int = 0
    new: str = ""
    renamed: str = ""
    is_deleted: bool = False
    tags: tuple[str, ...] = ()

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
    tags: tuple[str, ...] = ()


def mutants(text: str, path: str = "", hidden: Collection[str] = ()) -> Iterator[Mutant]:
    """Yield every mutant of a URDF or xacro once; `hidden` are links that must show nothing, which show a box."""
    return as_mutants(text, path, _changes(text, {f"link {name}" for name in hidden}))


def as_mutants(text: str, path: str, changes: Iterable[MutantEdit], tags: tuple[str, ...] = ()) -> Iterator[Mutant]:
    """Yield the mutants that changes of a file make, each once and with an id of its own."""
    seen: set[tuple[int, int, str]] = set()
    ids: dict[str, int] = {}
    for change in changes:
        key = (change.start, change.end, change.new)
        if key in seen or text[change.start : change.end] == change.new:
            continue
        seen.add(key)
        name = f"{change.family}: {change.label}"
        ids[name] = ids.get(name, 0) + 1
        name += f" ({ids[name]})" if ids[name] > 1 else ""
        line = text.count("\n", 0, change.start) + 1
        yield Mutant(name, change.family, path, line, *key, tags=change.tags or tags)


def _changes(text: str, hidden: Collection[str]) -> Iterator[MutantEdit]:
    found = elements(text)
    known = {tag: names_of_tag(text, found, tag) for tag in ("link", "joint", "material")}
    for element in found:
        for attribute in element.attributes:
            yield from _of_attribute(text, element, attribute, known)
        span = text_span(text, element)
        if span is not None and element.parent >= 0:
            yield from of_value(text, element.label, span, "", (*element.tags, "@"))
        if element.parent >= 0:
            yield from _of_element(text, element, found[element.parent])
        if element.label in hidden:
            is_empty = text[element.head_end - 2] == "/"
            span = element.head_end - (2 if is_empty else 0), element.head_end
            new = f">{_BOX}</link>" if is_empty else _BOX
            yield MutantEdit("visual added", element.label, *span, new, (*element.tags, "visual"))


def _of_attribute(
    text: str, element: Element, attribute: Attribute, known: dict[str, list[str]]
) -> Iterator[MutantEdit]:
    name, span = attribute.name, attribute.value
    label, tags = f"{element.label} {name}", (*element.tags, f"@{name}")
    yield MutantEdit("attribute deleted", label, attribute.start - 1, attribute.end, "", tags)
    name_end = attribute.start + len(name)
    yield MutantEdit("attribute misspelt", label, attribute.start, name_end, misspelt(name), tags)
    if name in _NAMES:
        kind = element.tag if element.tag in known else name if name in known else "link"
        yield from of_name(text, label, span, known[kind], tags)
    elif name == "type" and element.tag == "joint":
        yield from (MutantEdit("type", f"{label} -> {other}", *span, other, tags) for other in _TYPES)
    elif name not in _UNTOUCHED and not name.startswith("xmlns"):
        changes = of_value(text, element.label, span, name, tags)
        yield from (change for change in changes if name != "params" or change.family != "text misspelt")
    if name == "lower":
        upper = next((other for other in element.attributes if other.name == "upper"), None)
        if upper is not None:
            first, last = sorted((span, upper.value))
            swapped = text[slice(*last)] + text[first[1] : last[0]] + text[slice(*first)]
            yield MutantEdit("limits exchanged", element.label, first[0], last[1], swapped, tags)


def of_name(
    text: str, label: str, span: tuple[int, int], others: Iterable[str], tags: tuple[str, ...] = ()
) -> Iterator[MutantEdit]:
    """Yield changes of a name: misspelt, in other case, or another name that exists."""
    name = text[slice(*span)]
    yield MutantEdit("name misspelt", label, *span, misspelt(name), tags)
    yield MutantEdit("name capitalised", label, *span, name.title() if name.islower() else name.lower(), tags)
    family = "material exchanged" if "material" in tags[-2:] else "name exchanged"
    yield from (MutantEdit(family, f"{label} -> {other}", *span, other, tags) for other in _next(name, list(others)))


def _next(name: str, names: list[str]) -> list[str]:
    """Return the other names, the next ones of many: a robot of 200 links would have 100,000 exchanges."""
    start = names.index(name) + 1 if name in names else 0
    others = [other for other in names[start:] + names[:start] if other != name][:_MAX_EXCHANGED]
    return sorted(others, key=names.index)


def of_value(
    text: str, label: str, span: tuple[int, int], name: str, tags: tuple[str, ...] = ()
) -> Iterator[MutantEdit]:
    """Yield changes of a value: of each number in it, else of the text."""
    start, end = span
    pieces = [(start + found.start(), start + found.end()) for found in _NUMBER.finditer(text[start:end])]
    label = f"{label} {name}".rstrip()
    parts = [f"{label}{part}" for part in _parts(name, len(pieces))]
    for part, (low, high) in zip(parts, pieces, strict=True):
        for family, number in _alternatives(float(text[low:high])):
            yield MutantEdit(family, part, low, high, f"{number:.6g}", tags)
    for part, ((low, middle), (next_low, high)) in zip(parts, pairwise(pieces), strict=False):
        swapped = text[next_low:high] + text[middle:next_low] + text[low:middle]
        yield MutantEdit("number exchanged", part, low, high, swapped, tags)
    if not pieces and text[start:end].strip():
        yield MutantEdit("text misspelt", label, start, end, misspelt(text[start:end]), tags)
        if name == "filename":
            yield MutantEdit("text in other case", label, start, end, text[start:end].swapcase(), tags)


def _parts(name: str, count: int) -> list[str]:
    """Return what tells the numbers of a value apart: .x, .y and .z of an xyz."""
    known = PARTS.get(name, ())
    return [""] if count == 1 else [f".{part}" for part in (known if len(known) == count else range(1, count + 1))]


def _alternatives(value: float) -> Iterable[tuple[str, float]]:
    return (
        ("number negated", -value),
        ("number x10", value * 10),
        ("number /10", value / 10),
        ("number +0.05", value + 0.05),
        ("number -0.05", value - 0.05),
        ("number zero", 0.0),
        ("number halved", value / 2),
        ("number doubled", value * 2),
        ("number in degrees", degrees(value)),
    )


def _of_element(text: str, element: Element, parent: Element) -> Iterator[MutantEdit]:
    own, label, tags = text[element.start : element.end], element.label, element.tags
    yield MutantEdit("element deleted", label, element.start, element.end, "", tags)
    if not element.is_foreign:  # whether a simulator reads the second one depends on the simulator
        yield MutantEdit("element duplicated", label, element.end, element.end, f"\n{own}", tags)
    if parent.parent >= 0:
        between = text[parent.start : element.start]
        yield MutantEdit("element moved up", label, parent.start, element.end, f"{own}\n{between}", tags)


def misspelt(name: str) -> str:
    """Return a text without the letter in its middle."""
    middle = len(name) // 2
    return name[:middle] + name[middle + 1 :] if len(name) > 3 else f"{name}x"
