"""An element that is looked for in an XML file: its tag, its attributes, a path in it, and the values there."""

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from grader.pairing import most_pairs
from grader.xml.parsing import Element, Unresolved
from grader.xml.urdf_format import numbers_in

_Scalar = str | float | bool

_MADE_UP = re.compile(r"ns\d+")  # a prefix that lxml gives an element that is made, not read
_SLACK = 1e-12  # a tolerance includes its end
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
FOREIGN = ("gazebo", "ros2_control", "transmission", "sensor")  # below <robot>; ROS 2 itself ignores them
_AttributeValue = _Scalar | list[_Scalar]

_IDENTIFYING = ("@name", "@reference", "@filename", "@type")  # the first that a rubric gives
_INSTALLED = re.compile(r"/install/([^/\s]+)/share/\1(?=[/\s]|\Z)")  # what the expansion makes of $(find package)


class FoundElement(NamedTuple):
    """A text in an element: that of an attribute, or the element's own."""

    text: str
    element: Element
    attribute: str | None = None


def name_of(element: Element) -> str:
    """Return the name of an element as it is written, with its prefix."""
    return _name_with_prefix(str(element.tag), element)


def _name_with_prefix(name: str, element: Element) -> str:
    space, _, local = name.removeprefix("{").rpartition("}")
    if not space:
        return local
    prefix = next((prefix for prefix, uri in element.nsmap.items() if prefix and uri == space), "")
    return f"{space if not prefix or _MADE_UP.fullmatch(prefix) else prefix}:{local}"


def steps_of(path: str) -> list[str]:
    """Return the names in a slash-separated path; an empty path is the element itself."""
    return [step for step in path.split("/") if step not in ("", ".")]


def elements_at(element: Element, steps: Sequence[str]) -> list[Element]:
    """Return the elements at a path in an element, in document order."""
    found = [element]
    for step in steps:
        found = [child for parent in found for child in parent if name_of(child) == step]
    return found


def texts_at(element: Element, path: str) -> list[FoundElement]:
    """Return the texts at a path in an element: of attributes where it ends with @name, else of elements."""
    *steps, last = steps_of(path) or ["."]
    if not last.startswith("@"):
        return [FoundElement(text_in(found), found) for found in elements_at(element, steps_of(path))]
    values = ((found, attribute_of(found, last[1:])) for found in elements_at(element, steps))
    return [FoundElement(value, found, last[1:]) for found, value in values if value is not None]


def attribute_of(element: Element, name: str) -> str | None:
    """Return the value of an attribute by its name as it is written; None where the element has none."""
    plain = element.get(name)
    if plain is not None or ":" not in name:
        return plain
    return next((str(value) for key, value in element.items() if _name_with_prefix(str(key), element) == name), None)


def text_in(element: Element) -> str:
    """Return the text in an element, without that in its children."""
    return "".join([element.text or "", *(child.tail or "" for child in element)]).strip()


def _matches_value(text: str, expected: _Scalar, tolerance: float) -> bool:
    """Return whether a text is an expected value: numbers and lists are compared as numbers, true and 1 are equal."""
    wanted = xml_text(expected)
    one, other = text.strip().lower(), wanted.strip().lower()
    if "true" in (one, other) or "false" in (one, other):
        return one == other if one not in _BOOLEANS else _BOOLEANS[one] == _BOOLEANS.get(other)
    actual, numbers = numbers_in(text), numbers_in(wanted)
    if actual and numbers:
        pairs = zip(actual, numbers, strict=False)
        return len(actual) == len(numbers) and all(abs(a - b) <= tolerance + _SLACK for a, b in pairs)
    return text.split() == wanted.split()


def xml_text(value: _Scalar) -> str:
    """Return a value as XML writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    return value if isinstance(value, str) else f"{value:.12g}"


def _are_there(texts: Sequence[str], expected: Sequence[_Scalar], tolerance: float) -> bool:
    """Return whether each expected value is a different one of the texts, in any order."""
    fitting = [[i for i, text in enumerate(texts) if _matches_value(text, value, tolerance)] for value in expected]
    return len(most_pairs(fitting)) == len(expected)


class WantedElement(NamedTuple):
    """What a rubric looks for."""

    tag: str
    attributes: Mapping[str, _Scalar]
    path: str
    values: Mapping[str, _AttributeValue]
    tolerance: float

    @property
    def element(self) -> str:
        """The element below <robot>: <gazebo reference="camera_link">."""
        given = (f' {key}="{xml_text(value)}"' for key, value in self.attributes.items())
        return f"<{self.tag}{''.join(given)}>"

    @property
    def inner(self) -> str:
        """The element at the path in it: <sensor> in <gazebo>."""
        steps = steps_of(self.path)
        return f"{''.join(f'<{step}>' for step in steps)} in {self.element}" if steps else self.element

    def fits(self, element: Element) -> bool:
        """Return whether an element has the attributes."""
        given = ((attribute_of(element, key), value) for key, value in self.attributes.items())
        return all(text is not None and _matches_value(text, value, self.tolerance) for text, value in given)

    def may_fit(self, element: Element, unresolved: Unresolved | None) -> bool:
        """Return whether an element, of which not all may be known, can have the attributes."""
        left = {key: value for key, value in self.attributes.items() if unresolved and key not in unresolved.attributes}
        if unresolved is not None and unresolved.content is not None:
            left = {key: value for key, value in left.items() if attribute_of(element, key) is not None}
        return self._replace(attributes=left).fits(element) if unresolved else self.fits(element)

    def wrong(self, element: Element) -> list[str]:
        """Return the keys of the values that an element does not have."""
        return [key for key, value in self.values.items() if not self._has(element, key, value)]

    @property
    def identity(self) -> str:
        """The key of the attribute that identifies one of several elements; empty if the values have none."""
        return next((key for key in _IDENTIFYING if isinstance(self.values.get(key), str)), "")

    def nearest(self, elements: Sequence[Element]) -> Element:
        """Return the element with the identifying attribute and the most of the other values."""
        wrong = {element: self.wrong(element) for element in elements}
        return min(elements, key=lambda element: (self.identity in wrong[element], len(wrong[element])))

    def has(self, key: str, found: FoundElement) -> bool:
        """Return whether a text is the value at a path, or one of several."""
        value = self.values[key]
        wanted = value if isinstance(value, list) else [value]
        return any(_matches_value(readable(found.text), one, self.tolerance) for one in wanted)

    def _has(self, element: Element, key: str, value: _AttributeValue) -> bool:
        texts = [readable(found.text) for found in texts_at(element, key)]
        return _are_there(texts, value if isinstance(value, list) else [value], self.tolerance)


def readable(text: str) -> str:
    """Return a text in which paths of installed packages are as xacro writes them: $(find package)."""
    return _INSTALLED.sub(r"$(find \1)", text)


def foreign_elements(root: Element) -> list[Element]:
    """Return the elements of <robot> for simulators and controllers."""
    return [child for child in root if child.tag in FOREIGN]


def words_of_foreign(root: Element) -> set[str]:
    """Return the words in the elements for simulators and controllers, such as names of joints and paths."""
    found = [inner for element in foreign_elements(root) for inner in element.iter("*")]
    texts = [text for inner in found for text in (inner.text or "", *map(str, inner.attrib.values()))]
    return {word for text in texts for word in text.split()}
