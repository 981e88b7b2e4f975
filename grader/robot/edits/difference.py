"""The difference between a robot and the reference's, cut into pieces: each is an edit that may undo a mistake."""

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from itertools import groupby

from grader.difference import Node, Step, is_alike, paired, steps
from grader.robot.edits.draft import Draft, Edits, Set, child_of, end_of, escaped
from grader.robot.edits.nodes import node_of, wanted_value
from grader.robot.edits.numbers import number, values_of
from grader.robot.edits.pieces import ENDS, SOLVED, STRUCTURE, Piece, PieceMaker, normal, twins_of, unique
from grader.xml.parsing import Element
from grader.xml.urdf_format import CHILDREN, PARTS

_MAX_LINKS = 400  # of a robot: more are not compared


class RobotDifference(PieceMaker):
    """A robot and the reference's, paired; `known` are names that may be told, because the reference has them."""

    def __init__(self, draft: Draft, reference: Draft) -> None:
        super().__init__(draft, reference)
        self._names = self._translation()

    @cached_property
    def names(self) -> list[str]:
        """The links of the reference."""
        return [link.name for link in self.reference.robot.links]

    @cached_property
    def numbers(self) -> list[str]:
        """The numbers of the reference, each once."""
        values = (
            values_of(str(text))
            for element in self.reference.root.iter()
            for name, text in element.attrib.items()
            if PARTS.get(str(name))
        )
        return list(dict.fromkeys(number(abs(value)) for found in values for value in found if value))

    def _translation(self) -> dict[str, dict[str, str]]:
        """Return what the joints and materials of the reference are called in the robot."""
        names: dict[str, dict[str, str]] = {"joint": {}, "material": {}}
        known = {joint.name for joint in self.reference.robot.joints}
        for joint in self.reference.joints():
            own = self.draft.joint_of(end_of(joint, "child"))
            is_there = any(it.get("name") == joint.get("name") for it in self.draft.joints())
            if own is not None and own.get("name") and own.get("name") not in known and not is_there:
                names["joint"][joint.get("name") or ""] = own.get("name") or ""
        mine = [node_of(found) for found in self.draft.root.iterchildren("material")]
        pairs = paired(mine, [node_of(found) for found in self.reference.root.iterchildren("material")])
        called = {like.values.get("name", ""): own_node.values.get("name") for own_node, like in pairs.both}
        names["material"] = {name: own_name for name, own_name in called.items() if own_name}
        return names

    @cached_property
    def pieces(self) -> list[Piece]:
        """The pieces, each once: values first, then what moves, is added and is removed."""
        own, like = self._tree(self.draft, {}), self._tree(self.reference, self._names)
        found_steps = steps(own, like)
        return unique([*self._pieces(found_steps), *self._joint_names(), *self._ends()])

    def _joint_names(self) -> Iterator[Piece]:
        """Rename joints as in the reference, also where they are mimicked."""
        every: list[Set] = []
        for new, old in self._names["joint"].items():
            joint = next(it for it in self.draft.joints() if it.get("name") == old)
            mimics = (it for it in self.draft.root.iter("mimic") if it.get("joint") == old)
            sets = (Set(joint, "", "name", new), *(Set(it, "", "joint", new) for it in mimics))
            every += sets
            yield self.piece(joint, "the name of a joint", "correct the name of a joint", sets=sets, rank=STRUCTURE)
        if len(every) > 1:
            yield Piece("the names of joints", "correct the names of joints", "", tuple(every), (), STRUCTURE)

    def _ends(self) -> Iterator[Piece]:
        """Exchange the parent and the child of a joint."""
        for joint in self.draft.joints():
            names = [end_of(joint, role) for role in ENDS]
            likes = [self.reference.joint_of(name) for name in names]
            if any(like is not None and [end_of(like, role) for role in ENDS] == names[::-1] for like in likes):
                ends = [(child_of(joint, role), other) for role, other in zip(ENDS, ENDS[::-1], strict=True)]
                edits = tuple(it for end, other in ends if end is not None for it in self.draft.rename_tag(end, other))
                cause, action = "parent and child of {} are swapped", "swap parent and child of {}"
                yield self.piece(joint, cause, action, edits, rank=STRUCTURE)

    def _tree(self, draft: Draft, names: Mapping[str, Mapping[str, str]]) -> Node:
        children = [child for child in draft.root if isinstance(child.tag, str)]
        nodes = [node_of(child, names) for child in children[: 3 * _MAX_LINKS]]
        version = draft.root.get("version")
        return Node("robot", (), {"version": version} if version not in (None, "1.0") else {}, nodes, draft.root)

    def _pieces(self, found: Sequence[Step]) -> Iterator[Piece]:
        added = [
            step.like for step in found if step.like is not None and step.verb == "add" and step.own.tag == "robot"
        ]
        removed = [step.own for step in found if step.verb == "remove"]
        is_set = lambda step: id(step.own) if step.verb in ("set", "unset") else None  # noqa: E731
        for _, group in groupby(found, key=is_set):
            those = [*group]
            if those[0].verb in ("set", "unset"):
                yield from self._of_values(those)
        for step in found:
            match step.verb:
                case "rename":
                    edits = self.draft.rename_attribute(step.own.of, step.name, step.other)
                    cause = f"the name of the attribute {step.other} of {{}}"
                    yield self.piece(step.own.of, cause, f"rename {step.name} of {{}} to {step.other}", edits)
                case "retag" if step.like is not None:
                    edits, tag = self.draft.rename_tag(step.own.of, step.like.tag), f"<{step.like.tag}>"
                    yield self.piece(step.own.of, f"the name of the tag {tag}", f"rename the tag to {tag}", edits)
                case "move" if step.parent is not None and step.like is not None:
                    yield self.moved(step.own.of, step.parent.of)
                case "add" if step.like is not None:
                    yield from self._added(step, added, removed)
                case "remove":
                    yield from self._removed(step.own)

    def _of_values(self, found: Sequence[Step]) -> Iterator[Piece]:
        """Yield the values of one element: each alone, and all together."""
        element: Element = found[0].own.of
        wanted = {step.name: wanted_value(step) for step in found}
        values = {name: value for name, value in wanted.items() if value is not None}
        if element.tag in ("link", "joint", "material", "visual", "collision") and "name" in values:
            yield from self._renamed(element, values.pop("name"))
        if "" in values:
            text = values.pop("")
            edits = self.draft.write_text(element, text)
            yield self.piece(element, "the text of {}", f"set the text of {{}} to {text}", edits)
        yield from self._each([Set(element, "", name, value) for name, value in values.items()])

    def _each(self, sets: Sequence[Set]) -> Iterator[Piece]:
        """Yield the pieces that set each value alone, and all together."""
        yield from (self.of_sets([one]) for one in sets)
        if len(sets) > 1:
            yield self.of_sets(sets)

    def _renamed(self, element: Element, name: str) -> Iterator[Piece]:
        """Rename a link with all that names it, or alone; a joint; a material where it is used or defined."""
        tag, old = str(element.tag), element.get("name") or ""
        own = (Set(element, "", "name", name),)
        everywhere = renamed(self.draft, old, name) if tag == "link" else own
        for sets in filter(None, dict.fromkeys((everywhere, own))):
            cause, link = f"the name of a {tag}", name if tag == "link" else ""
            yield self.piece(element, cause, f"correct {cause}", sets=sets, link=link)

    def text(self, element: Element) -> str:
        """Return an element of the reference as it is written, with the robot's names."""
        text = self.reference.text(element)
        for tag, attribute in (("joint", "joint"), ("material", "name")):
            for old, new in self._names[tag].items():
                pattern = rf'(<(?:{tag}|mimic)\b[^>]*\b{attribute}=")({re.escape(old)})(")'
                name = escaped(new).replace("\\", r"\\")
                text = re.sub(pattern, rf"\g<1>{name}\g<3>", text) if old != new else text
        return text

    def _added(self, step: Step, added: Sequence[Node], removed: Sequence[Node]) -> Iterator[Piece]:
        """Add an element: a link with its joint and its materials where these are missing, too."""
        like, parent = step.like, step.own.of
        assert like is not None
        element, tag = like.of, like.tag
        if parent is not self.draft.root:
            yield from self._inner(parent, element)
            return
        defined = self.draft.material(element.get("name") or "") if tag == "material" else None
        colours = zip(*(found.iter("color") for found in (defined, element) if found is not None), strict=False)
        if defined is not None and len(defined):  # in a link
            yield from (self.of_sets([Set(own, "", "rgba", its.get("rgba") or "")]) for own, its in colours)
            return
        if tag in ("joint", "link"):
            yield self._added_link(like, [it.of for it in added if it.tag == "joint"])
            return
        spare = (it.of for it in removed if any(is_alike(it, inner) for inner in like.walk()))  # what the new one has
        away = tuple(edit for it in spare for edit in self.draft.remove(it))
        text = self.text(element)
        there = self.draft.insert(parent, text) if tag == "material" else self.draft.append(text)
        yield self.piece(parent, f"<{tag}> is missing", f"add <{tag}>", (*away, *there))

    def _added_link(self, like: Node, added: Sequence[Element]) -> Piece:
        """Add a joint, or a link with the joint and the materials that it needs."""
        element, tag = like.of, like.tag
        name = end_of(element, "child") if tag == "joint" else element.get("name") or ""
        joints = added if tag == "link" else ()
        own = [joint for joint in joints if name in self._ends_of(joint) and self._is_connected(joint, name)]
        text = "\n\n".join([self.text(element), *map(self.text, own)])
        what = f"the link {name!r}" if tag == "link" else f"the joint of {name!r}"
        edits = (*self.draft.append(text), *self.materials(element))
        return Piece(f"{what} is missing", f"add {what}", name, (), edits)

    def _ends_of(self, joint: Element) -> list[str]:
        return [end_of(joint, role) for role in ENDS]

    def _is_connected(self, joint: Element, link: str) -> bool:
        """Return whether the links at the ends of a joint of the reference are there, once a link is added."""
        return all(name == link or self.draft.link(name) is not None for name in self._ends_of(joint))

    def materials(self, element: Element) -> Edits:
        """Return the edits that define the materials of an element of the reference that the robot does not define."""
        names = dict.fromkeys(found.get("name") or "" for found in element.iter("material"))
        texts = [
            self.text(found)
            for name in names
            if self._names["material"].get(name) is None and self.draft.material(name) is None
            for found in [self.reference.material(name)]
            if found is not None
        ]
        return self.draft.insert(self.draft.root, "\n".join(texts)) if texts else ()

    def _inner(self, parent: Element, element: Element) -> Iterator[Piece]:
        """Add an element to another one: values of an origin or axis, another shape, or the element as it is."""
        tag, own = str(element.tag), child_of(parent, str(element.tag))
        if tag in ("origin", "axis"):  # one with default values only does not count
            values = {str(key): str(value) for key, value in element.attrib.items()}
            mine = {name: own.get(name) if own is not None else None for name in values}
            off = [name for name, value in values.items() if normal(tag, name, mine[name]) != normal(tag, name, value)]
            yield from self._each([Set(parent, tag, name, values[name]) for name in off])
            return
        cause, action = f"the <{tag}> of {{}} is missing", f"add the <{tag}> of {{}}"
        shape = next((it for it in parent if parent.tag == "geometry" and it.tag in CHILDREN["geometry"]), None)
        if shape is None:
            edits = (*self.draft.insert(parent, self.text(element)), *self._materials_in(element))
        else:
            alike = [it for geometry in twins_of(parent) for it in geometry if _is_equal(it, shape)]
            edits = tuple(edit for it in (shape, *alike) for edit in self.draft.replace(it, self.text(element)))
            cause, action = "the shape of {}", f"make the shape of {{}} a {tag}"
        yield self.piece(parent, cause, action, edits)

    def _materials_in(self, element: Element) -> Edits:
        parent = element.getparent()
        is_use = element.tag == "material" and parent is not None and not len(element)
        return self.materials(parent if is_use and parent is not None else element)

    def _removed(self, node: Node) -> Iterator[Piece]:
        """Remove what the reference does not have; an origin or axis gets its default."""
        element, tag = node.of, node.tag
        if tag in ("origin", "axis"):
            defaults = dict.fromkeys(node.values, "1 0 0" if tag == "axis" else "0 0 0")
            yield from (self.of_sets([Set(element, "", name, value)], SOLVED) for name, value in defaults.items())
            return
        if element.getparent() is not None and element.getparent().tag != "geometry":  # there the shape is replaced
            cause = f"an extra <{tag}>: {{}}" if tag not in ("link", "joint") else f"an extra {tag}"
            yield self.piece(element, cause, f"remove the extra <{tag}>", self.draft.remove(element), rank=STRUCTURE)


def renamed(draft: Draft, old: str, new: str) -> tuple[Set, ...]:
    """Return what gives a link another name, also where joints name it; nothing where several have the old one."""
    own = [link for link in draft.links() if link.get("name") == old]
    ends = [(joint, role) for joint in draft.joints() for role in ENDS if end_of(joint, role) == old]
    sets = (*(Set(link, "", "name", new) for link in own), *(Set(joint, role, "link", new) for joint, role in ends))
    return sets if len(own) == 1 else sets[:0]


def _is_equal(one: Element, other: Element) -> bool:
    return (one.tag, sorted(one.attrib.items())) == (other.tag, sorted(other.attrib.items()))
