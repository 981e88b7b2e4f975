"""The difference between a robot and the reference's, cut into pieces: each is an edit that may undo a mistake."""

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from itertools import groupby

from grader.difference import Node, Step, paired, steps
from grader.robot.edits.additions import Additions
from grader.robot.edits.draft import Draft
from grader.robot.edits.elements import Set, child_of, end_of
from grader.robot.edits.numbers import format_number, values_of
from grader.robot.edits.pieces import ENDS, SOLVED, STRUCTURE, Piece, PieceMaker, normal, unique
from grader.xml.parsing import Element
from grader.xml.urdf_format import PARTS, TAGS

_AXIS = ("1 0 0", "revolute", "continuous", "prismatic", "planar")


# The attributes that name a joint or a material, which a student may call otherwise.
_NAMES = {("mimic", "joint"): "joint", ("joint", "name"): "joint", ("material", "name"): "material"}
_MAX_LINKS = 400  # of a robot: more are not compared


def wanted_value(step: Step) -> str | None:
    """Return the value that a step sets: that of the reference, else the default; None if there is none."""
    if step.verb == "set" and step.like is not None:
        return step.like.values[step.name]
    known = TAGS[step.own.tag].attributes.get(step.name) if step.own.tag in TAGS else None
    return known.default or None if known is not None else None


def node_of(element: Element, names: Mapping[str, Mapping[str, str]] | None = None) -> Node:
    """Return the node of an element, without values and elements that are the default."""
    tag = str(element.tag)
    values = {}
    for name, value in element.attrib.items():
        text = normal(tag, str(name), str(value))
        if tag in TAGS and str(name) in TAGS[tag].attributes and text == normal(tag, str(name), None):
            continue
        values[str(name)] = (names or {}).get(_NAMES.get((tag, str(name)), ""), {}).get(text, text)
    if tag not in TAGS and not len(element) and (element.text or "").strip():
        values[""] = (element.text or "").strip()
    children = [node_of(child, names) for child in element if isinstance(child.tag, str)]
    is_moving = tag != "joint" or element.get("type") in _AXIS[1:]
    children = [child for child in children if not _is_default(child, is_moving=is_moving)]
    return Node(tag, _keys(element, values), values, children, element)


def _keys(element: Element, values: Mapping[str, str]) -> tuple[str, ...]:
    name = values.get("name", "") or values.get("reference", "")
    if element.tag == "joint" and element.getparent() is not None and child_of(element, "child") is not None:
        return end_of(element, "child"), name
    return (name,) if name and element.tag not in ("visual", "collision") else ()


def _is_default(node: Node, *, is_moving: bool) -> bool:
    if node.tag == "axis":
        return not is_moving or node.values.get("xyz", "1 0 0") == "1 0 0"
    return node.tag == "origin" and not node.values


class RobotDifference(PieceMaker):
    """A robot and the reference's, paired; `known` are names that may be told, because the reference has them."""

    def __init__(self, draft: Draft, reference: Draft) -> None:
        super().__init__(draft, reference)
        self._names = _translation(draft, reference)
        self.additions = Additions(self, self._names)

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
        return list(dict.fromkeys(format_number(abs(value)) for found in values for value in found if value))

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
                    yield from self.additions.pieces(step, added, removed)
                case "remove":
                    yield from self._remove(step.own)

    def _of_values(self, found: Sequence[Step]) -> Iterator[Piece]:
        """Yield the values of one element: each alone, and all together."""
        element: Element = found[0].own.of
        wanted = {step.name: wanted_value(step) for step in found}
        values = {name: value for name, value in wanted.items() if value is not None}
        if element.tag in ("link", "joint", "material", "visual", "collision") and "name" in values:
            yield from self._rename(element, values.pop("name"))
        if "" in values:
            text = values.pop("")
            edits = self.draft.write_text(element, text)
            yield self.piece(element, "the text of {}", f"set the text of {{}} to {text}", edits)
        yield from self.each([Set(element, "", name, value) for name, value in values.items()])

    def _rename(self, element: Element, name: str) -> Iterator[Piece]:
        """Rename a link with all that names it, or alone; a joint; a material where it is used or defined."""
        tag, old = str(element.tag), element.get("name") or ""
        own = (Set(element, "", "name", name),)
        everywhere = rename_link(self.draft, old, name) if tag == "link" else own
        for sets in filter(None, dict.fromkeys((everywhere, own))):
            cause, link = f"the name of a {tag}", name if tag == "link" else ""
            yield self.piece(element, cause, f"correct {cause}", sets=sets, link=link)

    def _remove(self, node: Node) -> Iterator[Piece]:
        """Remove what the reference does not have; an origin or axis gets its default."""
        element, tag = node.of, node.tag
        if tag in ("origin", "axis"):
            defaults = dict.fromkeys(node.values, "1 0 0" if tag == "axis" else "0 0 0")
            yield from (self.of_sets([Set(element, "", name, value)], SOLVED) for name, value in defaults.items())
            return
        if element.getparent() is not None and element.getparent().tag != "geometry":  # there the shape is replaced
            cause = f"an extra <{tag}>: {{}}" if tag not in ("link", "joint") else f"an extra {tag}"
            yield self.piece(element, cause, f"remove the extra <{tag}>", self.draft.remove(element), rank=STRUCTURE)


def rename_link(draft: Draft, old: str, new: str) -> tuple[Set, ...]:
    """Return what gives a link another name, also where joints name it; nothing where several have the old one."""
    own = [link for link in draft.links() if link.get("name") == old]
    ends = [(joint, role) for joint in draft.joints() for role in ENDS if end_of(joint, role) == old]
    sets = (*(Set(link, "", "name", new) for link in own), *(Set(joint, role, "link", new) for joint, role in ends))
    return sets if len(own) == 1 else sets[:0]


def _translation(draft: Draft, reference: Draft) -> dict[str, dict[str, str]]:
    """Return what the joints and materials of the reference are called in the robot."""
    names: dict[str, dict[str, str]] = {"joint": {}, "material": {}}
    known = {joint.name for joint in reference.robot.joints}
    for joint in reference.joints():
        own = draft.joint_of(end_of(joint, "child"))
        is_there = any(it.get("name") == joint.get("name") for it in draft.joints())
        if own is not None and own.get("name") and own.get("name") not in known and not is_there:
            names["joint"][joint.get("name") or ""] = own.get("name") or ""
    mine = [node_of(found) for found in draft.root.iterchildren("material")]
    pairs = paired(mine, [node_of(found) for found in reference.root.iterchildren("material")])
    called = {like.values.get("name", ""): own_node.values.get("name") for own_node, like in pairs.both}
    names["material"] = {name: own_name for name, own_name in called.items() if own_name}
    return names
