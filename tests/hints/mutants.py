"""Robots with one mistake each: every single edit of a text that families of mistakes allow.

The text is read here, not by the grader: a fault of its own reader must not hide itself.
"""

import re
from collections.abc import Iterable, Iterator
from itertools import pairwise
from math import degrees
from typing import NamedTuple

_TOKEN = re.compile(r"""<!--.*?-->|<[?!][^>]*>|</[^>]*>|<([^\s/>]+)(?:"[^"]*"|'[^']*'|[^>"'])*>""", re.DOTALL)
_ATTRIBUTE = re.compile(r"""\s([^\s="'<>/]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
_NAMES = ("name", "link", "joint")
_TEXTS = (*_NAMES, "type", "filename", "version", "encoding", "params")
_TYPES = ("fixed", "continuous", "revolute", "prismatic", "floating", "planar", "Fixed", "rotating")


class Mutant(NamedTuple):
    """A text with one mistake: its family, the line of the mistake, and the change in words."""

    family: str
    line: int
    change: str
    text: str


class Attribute(NamedTuple):
    """An attribute of a start tag: its name, and the offsets of the attribute and its value."""

    name: str
    start: int
    value: tuple[int, int]
    end: int


class Element(NamedTuple):
    """An element: the offsets of its start tag and of its end, its parent's index, and its attributes."""

    tag: str
    start: int
    end: int
    parent: int
    attributes: tuple[Attribute, ...]


def elements(text: str) -> list[Element]:
    """Return the elements of well-formed markup in document order."""
    found: list[Element] = []
    open_ones: list[int] = []
    for token in _TOKEN.finditer(text):
        if token[1]:
            found.append(
                Element(
                    token[1],
                    token.start(),
                    token.end(),
                    open_ones[-1] if open_ones else -1,
                    tuple(_attributes(text, token)),
                )
            )
            if not token[0].endswith("/>"):
                open_ones.append(len(found) - 1)
        elif token[0].startswith("</"):
            index = open_ones.pop()
            found[index] = found[index]._replace(end=token.end())
    return found


def mutants(text: str) -> Iterator[Mutant]:
    """Yield every mutant of a URDF or xacro once."""
    seen = {text}
    for family, start, end, new in _changes(text):
        mutant = text[:start] + new + text[end:]
        if mutant not in seen:
            seen.add(mutant)
            line = text.count("\n", 0, start) + 1
            yield Mutant(family, line, f"line {line}: {_short(text[start:end])} -> {_short(new)}", mutant)


Change = tuple[str, int, int, str]  # the family, two offsets, and the text that comes between them


def _changes(text: str) -> Iterator[Change]:
    found = elements(text)
    names = {tag: _once(_names(text, found, tag)) for tag in ("link", "joint", "material")}
    for element in found:
        for attribute in element.attributes:
            yield from _of_attribute(text, attribute)
            start, end = attribute.value
            if attribute.name in _NAMES:
                yield from _of_name(text, attribute, names, element.tag)
            elif attribute.name == "type":
                yield from (("type", start, end, other) for other in _TYPES)
            elif attribute.name not in _TEXTS and not attribute.name.startswith("xmlns"):
                yield from _of_numbers(text, start, end)
        if element.parent >= 0:
            yield from _of_element(text, element, found[element.parent])


def _of_attribute(text: str, attribute: Attribute) -> Iterator[Change]:
    yield "attribute deleted", attribute.start - 1, attribute.end, ""
    name_end = attribute.start + len(attribute.name)
    yield "attribute misspelt", attribute.start, name_end, _misspelt(attribute.name)


def _of_name(text: str, attribute: Attribute, names: dict[str, list[str]], tag: str) -> Iterator[Change]:
    start, end = attribute.value
    name = text[start:end]
    yield "name misspelt", start, end, _misspelt(name)
    yield "name capitalised", start, end, name.title() if name.islower() else name.lower()
    kind = tag if tag in names else "link"
    family = "material exchanged" if kind == "material" else "name exchanged"
    yield from ((family, start, end, other) for other in names[kind] if other != name)


def _of_numbers(text: str, start: int, end: int) -> Iterator[Change]:
    pieces = [(start + found.start(), start + found.end()) for found in _NUMBER.finditer(text[start:end])]
    for low, high in pieces:
        value = float(text[low:high])
        for family, other in _altered(value):
            yield family, low, high, f"{other:.6g}"
    for (low, middle), (next_low, high) in pairwise(pieces):
        yield "number exchanged", low, high, text[next_low:high] + text[middle:next_low] + text[low:middle]


def _altered(value: float) -> Iterable[tuple[str, float]]:
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


def _of_element(text: str, element: Element, parent: Element) -> Iterator[Change]:
    own = text[element.start : element.end]
    yield "element deleted", element.start, element.end, ""
    yield "element duplicated", element.end, element.end, f"\n{own}"
    if parent.parent >= 0:
        between = text[parent.start : element.start]
        yield "element moved up", parent.start, element.end, f"{own}\n{between}"


def _attributes(text: str, token: re.Match[str]) -> Iterator[Attribute]:
    for found in _ATTRIBUTE.finditer(text, token.start(), token.end()):
        yield Attribute(found[1], found.start(1), found.span(2 if found[2] is not None else 3), found.end())


def _names(text: str, found: Iterable[Element], tag: str) -> Iterator[str]:
    for element in found:
        for attribute in element.attributes:
            if element.tag == tag and attribute.name == "name":
                yield text[slice(*attribute.value)]


def _once(names: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(names))


def _misspelt(name: str) -> str:
    middle = len(name) // 2
    return name[:middle] + name[middle + 1 :] if len(name) > 3 else f"{name}x"


def _short(text: str) -> str:
    flat = " ".join(text.split())
    return flat if len(flat) <= 60 else f"{flat[:57]}..."
