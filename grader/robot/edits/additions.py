"""The pieces that add what a robot lacks and the reference has, with the robot's names."""

import re
from collections.abc import Iterator, Mapping, Sequence

from grader.difference import Node, Step, is_alike
from grader.robot.edits.draft import escaped
from grader.robot.edits.elements import Set, child_of, end_of
from grader.robot.edits.pieces import ENDS, Piece, PieceMaker, normal, twins_of
from grader.source import Edits
from grader.xml.parsing import Element
from grader.xml.urdf_format import CHILDREN


class Additions:
    """Adds elements of the reference; `names` are those of its joints and materials in the robot."""

    def __init__(self, maker: PieceMaker, names: Mapping[str, Mapping[str, str]]) -> None:
        self._maker, self._names = maker, names

    def text(self, element: Element) -> str:
        """Return an element of the reference as it is written, with the robot's names."""
        text = self._maker.reference.text(element)
        for tag, attribute in (("joint", "joint"), ("material", "name")):
            for old, new in self._names[tag].items():
                pattern = rf'(<(?:{tag}|mimic)\b[^>]*\b{attribute}=")({re.escape(old)})(")'
                name = escaped(new).replace("\\", r"\\")
                text = re.sub(pattern, rf"\g<1>{name}\g<3>", text) if old != new else text
        return text

    def pieces(self, step: Step, added: Sequence[Node], removed: Sequence[Node]) -> Iterator[Piece]:
        """Add an element: a link with its joint and its materials where these are missing, too."""
        like, parent = step.like, step.own.of
        assert like is not None
        element, tag = like.of, like.tag
        if parent is not self._maker.draft.root:
            yield from self._inner(parent, element)
            return
        defined = self._maker.draft.material(element.get("name") or "") if tag == "material" else None
        colours = zip(*(found.iter("color") for found in (defined, element) if found is not None), strict=False)
        if defined is not None and len(defined):  # in a link
            yield from (self._maker.of_sets([Set(own, "", "rgba", its.get("rgba") or "")]) for own, its in colours)
            return
        if tag in ("joint", "link"):
            yield self._add_link(like, [it.of for it in added if it.tag == "joint"])
            return
        spare = (it.of for it in removed if any(is_alike(it, inner) for inner in like.walk()))  # what the new one has
        away = tuple(edit for it in spare for edit in self._maker.draft.remove(it))
        text = self.text(element)
        there = self._maker.draft.insert(parent, text) if tag == "material" else self._maker.draft.append(text)
        yield self._maker.piece(parent, f"<{tag}> is missing", f"add <{tag}>", (*away, *there))

    def _add_link(self, like: Node, added: Sequence[Element]) -> Piece:
        """Add a joint, or a link with the joint and the materials that it needs."""
        element, tag = like.of, like.tag
        name = end_of(element, "child") if tag == "joint" else element.get("name") or ""
        joints = added if tag == "link" else ()
        own = [joint for joint in joints if name in self._ends_of(joint) and self._is_connected(joint, name)]
        text = "\n\n".join([self.text(element), *map(self.text, own)])
        what = f"the link {name!r}" if tag == "link" else f"the joint of {name!r}"
        edits = (*self._maker.draft.append(text), *self.materials(element))
        return Piece(f"{what} is missing", f"add {what}", name, (), edits)

    def _ends_of(self, joint: Element) -> list[str]:
        return [end_of(joint, role) for role in ENDS]

    def _is_connected(self, joint: Element, link: str) -> bool:
        """Return whether the links at the ends of a joint of the reference are there, once a link is added."""
        return all(name == link or self._maker.draft.link(name) is not None for name in self._ends_of(joint))

    def materials(self, element: Element) -> Edits:
        """Return the edits that define the materials of an element of the reference that the robot does not define."""
        names = dict.fromkeys(found.get("name") or "" for found in element.iter("material"))
        texts = [
            self.text(found)
            for name in names
            if self._names["material"].get(name) is None and self._maker.draft.material(name) is None
            for found in [self._maker.reference.material(name)]
            if found is not None
        ]
        return self._maker.draft.insert(self._maker.draft.root, "\n".join(texts)) if texts else ()

    def _inner(self, parent: Element, element: Element) -> Iterator[Piece]:
        """Add an element to another one: values of an origin or axis, another shape, or the element as it is."""
        tag, own = str(element.tag), child_of(parent, str(element.tag))
        if tag in ("origin", "axis"):  # one with default values only does not count
            values = {str(key): str(value) for key, value in element.attrib.items()}
            mine = {name: own.get(name) if own is not None else None for name in values}
            off = [name for name, value in values.items() if normal(tag, name, mine[name]) != normal(tag, name, value)]
            yield from self._maker.each([Set(parent, tag, name, values[name]) for name in off])
            return
        cause, action = f"the <{tag}> of {{}} is missing", f"add the <{tag}> of {{}}"
        shape = next((it for it in parent if parent.tag == "geometry" and it.tag in CHILDREN["geometry"]), None)
        if shape is None:
            edits = (*self._maker.draft.insert(parent, self.text(element)), *self._materials_in(element))
        else:
            alike = [it for geometry in twins_of(parent) for it in geometry if _is_equal(it, shape)]
            edits = tuple(edit for it in (shape, *alike) for edit in self._maker.draft.replace(it, self.text(element)))
            cause, action = "the shape of {}", f"make the shape of {{}} a {tag}"
        yield self._maker.piece(parent, cause, action, edits)

    def _materials_in(self, element: Element) -> Edits:
        parent = element.getparent()
        is_use = element.tag == "material" and parent is not None and not len(element)
        return self.materials(parent if is_use and parent is not None else element)


def _is_equal(one: Element, other: Element) -> bool:
    return (one.tag, sorted(one.attrib.items())) == (other.tag, sorted(other.attrib.items()))
