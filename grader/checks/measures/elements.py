"""Facts about the elements for simulators and controllers, which ROS 2 itself does not read."""

import re
from collections.abc import Iterator
from math import isfinite
from typing import Any

from grader.checks.measures.fact import Fact, Facts, Omission, Solution, in_title
from grader.package.launch.places import is_of_one_machine
from grader.text import enumerated
from grader.xml.parsing import Element
from grader.xml.wanted_element import name_of, readable, text_in

_FOREIGN = ("gazebo", "ros2_control", "transmission", "sensor")
_OF_CONTINUOUS = ("@effort", "@velocity")
_IN_JOINTS = ("safety_controller", "calibration")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_TRUTH = {"true": True, "false": False}
_NAMED_BY = ("reference", "name", "filename", "type")

_MAX_VALUES = 500  # in one element of <robot>: a check compares each with each
_MAX_LISTED = 4  # values in a title

ElementValues = dict[str, Any]


def elements(solution: Solution) -> Facts:
    """Yield the values in the elements for simulators and controllers: a fact for each element in one of them."""
    root = solution.reading.root
    assert root is not None  # ROS 2 loads the solution
    used = foreign_words(root)
    for element in _children(root):
        if name_of(element) in _FOREIGN:
            size = sum(1 + len(inner.attrib) for inner in element.iter())
            if size > _MAX_VALUES:
                yield Omission(_title(element, "", {}), f"it has more than {_MAX_VALUES} elements and attributes")
            else:
                yield from _facts_in(element)
        elif name_of(element) == "joint":
            for child in _children(element):
                yield from _fact_of_joint(element, child, is_used=_name(element) in used)


def _fact_of_joint(joint: Element, child: Element, *, is_used: bool) -> Facts:
    """Yield what no other check tests of a joint; it is found by the name of the joint, which must not be free."""
    tag = name_of(child)
    is_limit = tag == "limit" and joint.get("type") == "continuous"
    if tag in _IN_JOINTS or is_limit:
        values = {key: value for key, value in values_by_path(child).items() if not is_limit or key in _OF_CONTINUOUS}
        if is_used:
            yield _fact(joint, tag, values, _label(joint, child))
        elif values:
            yield Omission(
                f"<{tag}> of {_name(joint)}", "a check finds it by the name of the joint only, which is free"
            )


def _facts_in(element: Element) -> Iterator[Fact]:
    """Yield a fact for the plain values in an element, and one for each child that has elements or attributes."""
    plain: ElementValues = {}
    deep: list[Element] = []
    for child in _children(element):
        if _children(child) or child.attrib:
            deep.append(child)
        else:
            _add(plain, name_of(child), _value(text_in(child)))
    if plain or not deep:
        yield _fact(element, "", plain, _label(element))
    for child in deep:
        yield _fact(element, name_of(child), values_by_path(child), _label(element, child))


def _fact(element: Element, path: str, values: ElementValues, label: str) -> Fact:
    arguments: dict[str, Any] = {"tag": name_of(element)}
    is_joint = element.tag == "joint"
    attributes = {str(key): str(value) for key, value in element.attrib.items() if not is_joint or key == "name"}
    arguments |= {"attributes": attributes} if attributes else {}
    arguments |= {"path": path} if path else {}
    arguments |= {"values": values} if values else {}
    about = "The joints" if is_joint else f"<{name_of(element)}>"
    return Fact(label, "", _title(element, path, values), "element_present", arguments, about=about)


def _title(element: Element, path: str, values: ElementValues) -> str:
    """Return a title: "<gazebo> of camera_link has <sensor> with type camera, update_rate 30 and 8 more"."""
    owner = f"<{name_of(element)}>{f' of {_name(element)}' if _name(element) else ''}"
    listed = enumerated([f"{key.lstrip('@')} {_value_text(value)}" for key, value in values.items()], _MAX_LISTED)
    if not path:
        return f"{owner} has {listed}" if listed else f"There is a {owner}"
    return f"{owner} has <{path}>{f' with {listed}' if listed else ''}"


def values_by_path(element: Element, path: str = "") -> ElementValues:
    """Return all attributes and texts in an element by their paths; of repeated ones a list."""
    found: ElementValues = {}
    for key, text in element.attrib.items():
        _add(found, f"{path}@{key!s}", _value(str(text)))
    for child in _children(element):
        inner = f"{path}{name_of(child)}"
        if not _children(child) and (text_in(child) or not child.attrib):
            _add(found, inner, _value(text_in(child)))
        for key, value in values_by_path(child, f"{inner}/").items():
            _add(found, key, value)
    return found


def _add(found: ElementValues, key: str, value: Any) -> None:
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


def _name(element: Element) -> str:
    return next((str(element.get(key)) for key in _NAMED_BY if element.get(key)), "")


def _label(*elements: Element) -> str:
    """Return the words of an id: the tags and names of elements."""
    return " ".join(f"{name_of(element)} {_name(element)}" for element in elements)


def _value_text(value: Any) -> str:
    match value:
        case bool():
            return str(value).lower()
        case int() | float():
            return in_title([value])
        case list():
            return " and ".join(map(_value_text, value))
    return str(value)


def foreign_words(root: Element) -> set[str]:
    """Return the words in the elements for simulators and controllers, such as names of joints and paths."""
    found: set[str] = set()
    for element in _children(root):
        for inner in element.iter() if element.tag in _FOREIGN else ():
            found.update((inner.text or "").split(), *(str(value).split() for value in inner.attrib.values()))
    return found
