"""An element that is looked for in an XML file: its tag, its attributes, a path in it, and the values there."""

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from grader.xml.element_values import FoundElement, Scalar, are_there, attribute, is_same, steps_of, text_of, texts_at
from grader.xml.parsing import Element, Unresolved

AttributeValue = Scalar | list[Scalar]

_IDENTIFYING = ("@name", "@reference", "@filename", "@type")  # the first that a rubric gives
_INSTALLED = re.compile(r"/install/([^/\s]+)/share/\1(?=[/\s]|\Z)")  # what the expansion makes of $(find package)


class WantedElement(NamedTuple):
    """What a rubric looks for."""

    tag: str
    attributes: Mapping[str, Scalar]
    path: str
    values: Mapping[str, AttributeValue]
    tolerance: float

    @property
    def element(self) -> str:
        """The element below <robot>: <gazebo reference="camera_link">."""
        given = (f' {key}="{text_of(value)}"' for key, value in self.attributes.items())
        return f"<{self.tag}{''.join(given)}>"

    @property
    def inner(self) -> str:
        """The element at the path in it: <sensor> in <gazebo>."""
        steps = steps_of(self.path)
        return f"{''.join(f'<{step}>' for step in steps)} in {self.element}" if steps else self.element

    def fits(self, element: Element) -> bool:
        """Return whether an element has the attributes."""
        given = ((attribute(element, key), value) for key, value in self.attributes.items())
        return all(text is not None and is_same(text, value, self.tolerance) for text, value in given)

    def may_fit(self, element: Element, unresolved: Unresolved | None) -> bool:
        """Return whether an element, of which not all may be known, can have the attributes."""
        left = {key: value for key, value in self.attributes.items() if unresolved and key not in unresolved.attributes}
        if unresolved is not None and unresolved.content is not None:
            left = {key: value for key, value in left.items() if attribute(element, key) is not None}
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
        return any(is_same(readable(found.text), one, self.tolerance) for one in wanted)

    def _has(self, element: Element, key: str, value: AttributeValue) -> bool:
        texts = [readable(found.text) for found in texts_at(element, key)]
        return are_there(texts, value if isinstance(value, list) else [value], self.tolerance)


def readable(text: str) -> str:
    """Return a text in which paths of installed packages are as xacro writes them: $(find package)."""
    return _INSTALLED.sub(r"$(find \1)", text)
