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
    label: str
    tags: tuple[str, ...]  # of those above it, from the root, and its own

    @property
    def is_foreign(self) -> bool:
        """Return whether it belongs to a tag below <robot> that ROS 2's own reader ignores, such as <gazebo>."""
        return len(self.tags) > 1 and self.tags[1] in FOREIGN


FOREIGN = ("gazebo", "ros2_control", "transmission", "sensor")


def elements(text: str) -> list[Element]:
    """Return the elements of markup in document order."""
    found: list[Element] = []
    open_ones: list[int] = []
    counts: Counter[tuple[int, str]] = Counter()  # of equal siblings, counted from the second on: `visual 2`
    position = 0
    while token := TOKEN.search(text, position):
        position = token.end()
        if token[0] == "<":
            position, is_empty = head_end(text, token.start())
            parent, tag = open_ones[-1] if open_ones else -1, text[token.end() : name_end(text, token.start())]
            above = found[parent] if parent >= 0 else None
            own = tuple(attributes(text, token.start()))
            label = " ".join([tag, *_name(text, tag, own, parent)])
            counts[parent, label] += 1
            label += f" {counts[parent, label]}" if counts[parent, label] > 1 else ""
            label = f"{above.label}/{label}" if above is not None and parent > 0 else label
            tags = (*(above.tags if above is not None else ()), tag)
            found.append(Element(tag, token.start(), position, position, parent, own, label, tags))
            if not is_empty:
                open_ones.append(len(found) - 1)
        elif token[0].startswith("</") and open_ones:
            index = open_ones.pop()
            found[index] = found[index]._replace(end=token.end())
    return found


def _name(text: str, tag: str, own: Iterable[Attribute], parent: int) -> list[str]:
    """Return the name of an element, if it has one; that of a material inside of a visual is a value."""
    if parent < 0 or (parent and tag == "material"):
        return []
    values = (text[slice(*attribute.value)] for attribute in own if attribute.name in _NAMED_BY)
    return [name for name in values if name][:1]


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
