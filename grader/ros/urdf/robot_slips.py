"""The slips of a URDF that ROS 2 loads all the same: it ignores a word, or drops the element."""

import re
from collections.abc import Collection, Mapping
from itertools import islice

from grader.base import markup
from grader.base.element_edits import escaped, tag_edits, with_attribute
from grader.base.names import near
from grader.base.slips import Slip, Slips
from grader.base.source import Edits, Source
from grader.base.text import cut, quoted
from grader.ros.urdf.words import meant_attribute, meant_tag, meant_value
from grader.ros.xml.parsing import Element
from grader.ros.xml.tinyxml2 import decode
from grader.ros.xml.urdf_format import ATTRIBUTES, CHILDREN

_MAX_SLIPS = 20
_MAX_ATTRIBUTES = 50  # of one element, because lxml searches each name from the first
_MAX_SHOWN = 60  # characters of a value

_Place = tuple[Element, str | None]  # an element, or one of its attributes


class RobotSlips:
    """The search for the slips of one URDF."""

    def __init__(
        self,
        root: Element,
        source: Source,
        unresolved: Collection[Element],
    ) -> None:
        self._root = root
        self._source = source
        self._unresolved = unresolved
        self._indices = {element: index for index, element in enumerate(root.iter())}
        self._at_places: dict[_Place, Slip] = {}

    def listed(self) -> list[Slip]:
        """Return the slips in the order of the elements, each place once."""
        return list({slip.edits: slip for slip in islice(self._find(), _MAX_SLIPS)}.values())

    def at_places(self) -> Mapping[_Place, Slip]:
        """Return the slips by the elements and attributes that they are in."""
        for _ in self._find():
            pass
        return self._at_places

    def _find(self) -> Slips:
        """Yield the slips in document order: those of an element, then those inside of it."""
        waiting = [(self._root, "robot")]
        materials = self._material_slips()
        while waiting:
            element, tag = waiting.pop()
            if element not in self._unresolved:
                yield from self._attribute_slips(element, tag)
            if element in materials:
                yield materials[element]
            inside: list[tuple[Element, str]] = []
            yield from self._child_slips(element, tag, inside)
            waiting += reversed(inside)

    def _child_slips(self, element: Element, tag: str, inside: list[tuple[Element, str]]) -> Slips:
        """Yield the slips of children's tags; `inside` gets the children that ROS 2 should read."""
        present = {str(child.tag) for child in element}
        for child in element:
            written = str(child.tag)
            meant = None
            if child not in self._unresolved:
                meant = meant_tag(written, tag, present)
            if meant is not None:
                present.add(meant)
                yield from self._tag_slip(child, written, meant, tag)
            if meant is not None or written in CHILDREN.get(tag, ()):
                inside.append((child, meant or written))

    def _place(self, element: Element) -> tuple[Source, int]:
        """Return the text that an element was written in, and the offset of its start tag."""
        return self._source.element(self._indices[element])

    def _slip(
        self,
        element: Element,
        edits: Edits,
        reaction: str,
        assumption: str,
        attribute: str | None = None,
    ) -> Slip:
        location = self._source.tag(self._indices[element], attribute)
        slip = Slip(edits, reaction, assumption, location._replace(calls=()))
        self._at_places[element, attribute] = slip
        return slip

    def _tag_slip(self, element: Element, written: str, meant: str, parent: str) -> Slips:
        edits = tag_edits(*self._place(element), written, meant)
        reaction = f"ROS 2 ignores <{written}> in <{parent}>"
        yield self._slip(element, edits, reaction, f"<{written}> is read as <{meant}>")

    def _attribute_slips(self, element: Element, tag: str) -> Slips:
        if tag not in ATTRIBUTES or len(element.attrib) > _MAX_ATTRIBUTES:
            return
        values = {str(name): str(value) for name, value in element.attrib.items()}
        for name, value in values.items():
            meant = meant_attribute(name, tag, values) or name
            meant_numbers = meant_value(value, meant) if meant in ATTRIBUTES[tag] else None
            if meant != name or meant_numbers is not None:
                yield from self._attribute_slip(element, tag, name, meant, meant_numbers)

    def _attribute_slip(
        self, element: Element, tag: str, name: str, meant: str, numbers: str | None
    ) -> Slips:
        """Yield the slip in the name of an attribute, in its value, or in both."""
        source, start = self._place(element)
        attribute = markup.attribute(source.text, start, name)
        if not attribute:
            return
        written = source.text[slice(*attribute.value)]
        value = written if numbers is None else numbers
        # Xacro makes the value of several texts.
        if numbers is not None and decode(written) != element.get(name):
            value = _without_separators(written)
        before = source.text[attribute.start + len(name) : attribute.value_start]
        after = source.text[attribute.value_end : attribute.end]
        edit = source.edit(attribute.start, attribute.end, f"{meant}{before}{value}{after}")
        if edit.old == edit.new or "\n" in edit.old:
            return
        reaction = f"ROS 2 cannot read {name}={quoted(cut(written, _MAX_SHOWN))} of <{tag}>"
        assumption = f"{meant} is read as {quoted(cut(value, _MAX_SHOWN))}"
        if meant != name:
            reaction = f"ROS 2 ignores the attribute {name} of <{tag}>"
            is_read = value == written
            read = meant if is_read else f"{meant}={quoted(cut(value, _MAX_SHOWN))}"
            assumption = f"the attribute {name} of <{tag}> is read as {read}"
        yield self._slip(element, (edit,), reaction, assumption, name)

    def _material_slips(self) -> dict[Element, Slip]:
        """Return the slip of each material whose name is misspelt.

        It is where the name is used, or where nothing uses it as it is defined.
        """
        definitions = {}
        uses: dict[str, list[Element]] = {}
        for element in self._root.iter("material"):
            name = element.get("name") or ""
            if len(element):
                definitions[name] = element
            elif element.getparent() is not self._root:
                uses.setdefault(name, []).append(element)
        slips = {}
        for name, elements in uses.items():
            near_name = near(name, definitions) if name and name not in definitions else None
            if near_name is None:
                continue
            written = name
            meant = near_name
            places = elements
            if meant not in uses and len(elements) > 1:
                written = near_name
                meant = name
                places = [definitions[near_name]]
            for element in places:
                source, start = self._place(element)
                there = markup.attribute(source.text, start, "name")
                if there and decode(source.text[slice(*there.value)]) == written:
                    edit = with_attribute(source, start, "name", escaped(meant))
                    reaction = f"there is no material {quoted(name)}"
                    assumption = f"the material {quoted(written)} is read as {quoted(meant)}"
                    slips[element] = self._slip(element, (edit,), reaction, assumption, "name")
        return slips


def _without_separators(text: str) -> str:
    """Return a value of xacro without the separators that are outside of its expressions."""
    pieces = []
    for piece in re.split(r"(\$\{[^}$]*+\})", text):
        is_expression = piece.startswith("${")
        pieces.append(piece if is_expression else re.sub("[,;]", " ", piece))
    return "".join(pieces)
