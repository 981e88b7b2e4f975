"""The elements of a URDF or xacro text with the offsets of all their parts."""

from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

from grader.markup import TOKEN, Attribute, attributes, head_end, name_end

_NAMED_BY = ("name", "reference")


class Element(NamedTuple):
    """An element: where its start tag begins and ends, where it ends itself, its parent's index, its attributes.

    `label` is its place by names, which does not change if lines are added: `joint base_lidar_joint/origin`.
    """

    tag: str
    start: int
    head_end: int
    end: int
    parent: int
    attributes: tuple[Attribute, ...]
    label: str = ""
    tags: tuple[str, ...] = ()  # of those above it, from the root, and its own

    @property
    def is_foreign(self) -> bool:
        """Return whether it belongs to a tag below <robot> that ROS 2's own reader ignores, such as <gazebo>."""
        return len(self.tags) > 1 and self.tags[1] in FOREIGN


FOREIGN = ("gazebo", "ros2_control", "transmission", "sensor")


def elements(text: str) -> list[Element]:
    """Return the elements of markup in document order."""
    found: list[Element] = []
    open_ones: list[int] = []
    position = 0
    while token := TOKEN.search(text, position):
        position = token.end()
        if token[0] == "<":
            position, is_empty = head_end(text, token.start())
            parent, tag = open_ones[-1] if open_ones else -1, text[token.end() : name_end(text, token.start())]
            tags = (*(found[parent].tags if parent >= 0 else ()), tag)
            own = tuple(attributes(text, token.start()))
            found.append(Element(tag, token.start(), position, position, parent, own, "", tags))
            if not is_empty:
                open_ones.append(len(found) - 1)
        elif token[0].startswith("</") and open_ones:
            index = open_ones.pop()
            found[index] = found[index]._replace(end=token.end())
    return _label(text, found)


def text_span(text: str, element: Element) -> tuple[int, int] | None:
    """Return the offsets of the text in an element, without white space around it; None if it has none, or children."""
    end = text.rfind("</", element.head_end, element.end)
    inner = text[element.head_end : end] if end >= 0 else ""
    if not inner.strip() or "<" in inner:
        return None
    start = element.head_end + len(inner) - len(inner.lstrip())
    return start, start + len(inner.strip())


def names_of_tag(text: str, found: Iterable[Element], tag: str) -> list[str]:
    """Return the names of the elements with a tag, each once."""
    own = (attribute for element in found if element.tag == tag for attribute in element.attributes)
    return list(dict.fromkeys(text[slice(*attribute.value)] for attribute in own if attribute.name == "name"))


def _label(text: str, found: list[Element]) -> list[Element]:
    """Return the elements with their labels; equal siblings are counted from the second on: `visual 2`."""
    counts: Counter[tuple[int, str]] = Counter()
    labelled: list[Element] = []
    for element in found:
        own = " ".join([element.tag, *_name(text, element)])
        counts[element.parent, own] += 1
        count = counts[element.parent, own]
        own += f" {count}" if count > 1 else ""
        above = labelled[element.parent].label if element.parent > 0 else ""
        labelled.append(element._replace(label=f"{above}/{own}" if above else own))
    return labelled


def _name(text: str, element: Element) -> list[str]:
    if element.parent < 0 or (element.parent and element.tag == "material"):  # there the name is a value of the visual
        return []
    values = (text[slice(*attribute.value)] for attribute in element.attributes if attribute.name in _NAMED_BY)
    return [name for name in values if name][:1]
