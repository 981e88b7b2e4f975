"""The facts of the elements for simulators and controllers, which ROS 2 itself does not read."""

import re
from collections.abc import Iterator
from math import isfinite
from typing import Any

from grader.authoring.fact import Fact, Facts, Omission, Solution
from grader.package.launch.places import is_of_one_machine
from grader.xml.parsing import Element
from grader.xml.wanted_element import foreign_elements, name_of, readable, text_in

_MAX_VALUES = 500  # in one element of <robot>: a check compares each with each
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_TRUTH = {"true": True, "false": False}
_NAMED_BY = ("reference", "name", "filename", "type")

Values = dict[str, Any]


def element_facts(solution: Solution) -> Facts:
    """Yield the values in each element for simulators and controllers."""
    for element in foreign_elements(solution.root):
        about = f"<{name_of(element)}>"
        if sum(1 + len(inner.attrib) for inner in element.iter()) > _MAX_VALUES:
            yield Omission(_label(element), f"it has more than {_MAX_VALUES} elements and attributes")
            continue
        attributes = {str(key): str(value) for key, value in element.attrib.items()}
        for label, path, values in _element_values(element):
            arguments = {"tag": name_of(element), "attributes": attributes, "path": path, "values": values}
            given = {key: value for key, value in arguments.items() if value}
            yield Fact(about, "element_present", given, label)


def _element_values(element: Element) -> Iterator[tuple[str, str, Values]]:
    """Yield the plain values in an element, then those in each child that has elements or attributes.

    Each has a label, the path of the child, and values by their paths in it.
    """
    plain: Values = {}
    deep: list[Element] = []
    for child in _children(element):
        if _children(child) or child.attrib:
            deep.append(child)
        else:
            _add(plain, name_of(child), _value(text_in(child)))
    if plain or not deep:
        yield _label(element), "", plain
    for child in deep:
        yield f"{_label(element)} {_label(child)}", name_of(child), _values_by_path(child)


def _values_by_path(element: Element, path: str = "") -> Values:
    """Return all attributes and texts in an element by their paths; of repeated ones a list."""
    found: Values = {}
    for key, text in element.attrib.items():
        _add(found, f"{path}@{key!s}", _value(str(text)))
    for child in _children(element):
        inner = f"{path}{name_of(child)}"
        if not _children(child) and (text_in(child) or not child.attrib):
            _add(found, inner, _value(text_in(child)))
        for key, value in _values_by_path(child, f"{inner}/").items():
            _add(found, key, value)
    return found


def _add(found: Values, key: str, value: Any) -> None:
    """Add a value, unless it is a path that exists on one machine only; of several values with one path, a list."""
    if isinstance(value, str) and is_of_one_machine(value):
        return
    if key not in found:
        found[key] = value
    else:
        before = found[key] if isinstance(found[key], list) else [found[key]]
        found[key] = before + (value if isinstance(value, list) else [value])


def _value(text: str) -> str | bool | int | float:
    """Return the text of an element or attribute as a rubric writes it: a number, true or false, else a string."""
    word = readable(text.strip())
    if word in _TRUTH:
        return _TRUTH[word]
    if _NUMBER.fullmatch(word) and isfinite(number := float(word)):
        return int(word) if re.fullmatch(r"-?(?:0|[1-9]\d{0,14})", word) else number
    return " ".join(word.split())


def _children(element: Element) -> list[Element]:
    return [child for child in element if isinstance(child.tag, str)]


def _label(element: Element) -> str:
    """Return the tag and the name of an element."""
    return f"{name_of(element)} {next((str(element.get(key)) for key in _NAMED_BY if element.get(key)), '')}"
