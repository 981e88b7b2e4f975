"""Facts about the elements for simulators and controllers, which ROS 2 itself does not read."""

import re
from collections.abc import Iterator
from typing import Any

from grader.authoring.fact import Fact, shown
from grader.xml.parsing import Element

_FOREIGN = ("gazebo", "ros2_control", "transmission")
_IN_JOINTS = ("safety_controller", "calibration")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_TRUTH = {"true": True, "false": False}
_NAMED_BY = ("reference", "name", "filename", "type")

Values = dict[str, Any]


def element_facts(root: Element) -> Iterator[Fact]:
    """Yield the values in the elements for simulators and controllers: a fact for each element in one of them."""
    for element in _children(root):
        tag = str(element.tag)
        if tag in _FOREIGN:
            yield from _facts_in(element)
        elif tag == "joint":
            for child in _children(element):
                if child.tag in _IN_JOINTS:
                    yield _fact(element, child.tag, values_of(child), _label(element))


def _facts_in(element: Element) -> Iterator[Fact]:
    """Yield a fact for the plain values in an element, and one for each child with elements or attributes of its own."""
    plain: Values = {}
    deep: list[Element] = []
    for child in _children(element):
        if len(child) or child.attrib:
            deep.append(child)
        else:
            _add(plain, str(child.tag), _value(child.text))
    if plain or not deep:
        yield _fact(element, "", plain, _label(element))
    for child in deep:
        yield _fact(element, str(child.tag), values_of(child), _label(element, child))


def _fact(element: Element, path: str, values: Values, label: str) -> Fact:
    arguments: dict[str, Any] = {"tag": str(element.tag)}
    attributes = {str(key): str(value) for key, value in element.attrib.items()}
    arguments |= {"attributes": attributes} if attributes else {}
    arguments |= {"path": path} if path else {}
    arguments |= {"values": values} if values else {}
    where = f"<{element.tag}>{f' of {_name(element)}' if _name(element) else ''}"
    title = f"{where} has {f'<{path}>' if path else 'the element'}" if path or not values else where
    listed = ", ".join(f"{key.lstrip('@')} {_shown(value)}" for key, value in values.items())
    title += f"{' with' if path else ' has'} {listed}" if listed else ""
    return Fact(label, "", title, "element_present", arguments, about=_about(element))


def values_of(element: Element, path: str = "") -> Values:
    """Return all attributes and texts in an element by their paths; of repeated ones a list."""
    found: Values = {}
    for key, text in element.attrib.items():
        _add(found, f"{path}@{key!s}", _value(str(text)))
    for child in _children(element):
        inner = f"{path}{child.tag}"
        if not len(child) and ((child.text or "").strip() or not child.attrib):
            _add(found, inner, _value(child.text))
        for key, value in values_of(child, f"{inner}/").items():
            _add(found, key, value)
    return found


def _add(found: Values, key: str, value: Any) -> None:
    """Add a value; of several different ones with one path, a list."""
    if key not in found:
        found[key] = value
    else:
        before = found[key] if isinstance(found[key], list) else [found[key]]
        found[key] = before + (value if isinstance(value, list) else [value])


def _value(text: str | None) -> str | bool | int | float:
    """Return the text of an element or attribute as a rubric writes it: a number, true or false, else a string."""
    word = (text or "").strip()
    if word in _TRUTH:
        return _TRUTH[word]
    if _NUMBER.fullmatch(word):
        number = float(word)
        return int(word) if re.fullmatch(r"-?(?:0|[1-9]\d{0,14})", word) else number
    return " ".join(word.split())


def _children(element: Element) -> list[Element]:
    return [child for child in element if isinstance(child.tag, str)]


def _name(element: Element) -> str:
    return next((str(element.get(key)) for key in _NAMED_BY if element.get(key)), "")


def _label(*elements: Element) -> str:
    """Return the words of an id: the tags and names of elements."""
    return " ".join(f"{element.tag} {_name(element)}" for element in elements)


def _about(element: Element) -> str:
    return "The joints" if element.tag == "joint" else f"<{element.tag}>"


def _shown(value: Any) -> str:
    match value:
        case bool():
            return str(value).lower()
        case int() | float():
            return shown([value])
        case list():
            return " and ".join(map(_shown, value))
    return str(value)


def texts_in(root: Element) -> set[str]:
    """Return the words in the elements for simulators and controllers, such as names of joints."""
    found: set[str] = set()
    for element in _children(root):
        for inner in element.iter() if element.tag in _FOREIGN else ():
            found.update((inner.text or "").split(), *(str(value).split() for value in inner.attrib.values()))
    return found
