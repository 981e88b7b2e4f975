"""The difference between a robot and the reference's, cut into pieces.

Each is an edit that may undo a mistake.
"""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property

from grader.base.element_edits import escaped
from grader.base.grouping import StringsByName, known_values
from grader.base.names import closest, near
from grader.base.records import Named
from grader.base.source import Edits
from grader.base.text import enumerated, quoted
from grader.lab.hints.edits import MAX_IN_HINT
from grader.lab.hints.robot_draft import Draft, Set, find_child, read_end
from grader.lab.hints.robot_numbers import mistake_in, read_values
from grader.lab.hints.tree_difference import Node, Step, paired, steps
from grader.ros.xml.parsing import Element
from grader.ros.xml.urdf_format import CHILDREN, TAGS

_ENDS = ("parent", "child")
_MOVING = ("revolute", "continuous", "prismatic", "planar")  # the types of joints whose axis counts
# The attributes that name a joint or a material, which a student may call otherwise.
_NAMES = {("mimic", "joint"): "joint", ("joint", "name"): "joint", ("material", "name"): "material"}
_MAX_LINKS = 400  # of a robot: more are not compared

# The ranks of pieces: values of a sibling of the student's own design; the reference's; the
# student's own, corrected; several at once, or another structure.
SIBLING, REFERENCE, OWN, STRUCTURE = range(4)
_Sets = Sequence[Set]
_Translation = Mapping[str, StringsByName]  # of names, by the kind of what has them


class Piece(Named):
    """An edit that may undo a mistake.

    It has values to set, edits of the text, or both; what is wrong, and the link.

    The `rank` orders pieces that gain as much. `around` is the element that changes.
    """

    cause: str
    link: str
    sets: _Sets = ()
    edits: Edits = ()
    rank: int = REFERENCE
    around: Element | None = None

    @property
    def is_pose(self) -> bool:
        """Whether it changes where something is, and not what it is held by."""
        tags = {tag for one in self.sets for tag in (one.tag, str(one.owner.tag))}
        return not tags.isdisjoint(("origin", "axis")) and tags.isdisjoint(_ENDS)


Pieces = Iterator[Piece]


class MissingPart(Named):
    """A link or joint of the reference that a robot does not have: nothing writes it."""

    tag: str
    link: str  # that it is, or that the joint moves
    joint_type: str = ""
    parent: str = ""


class RobotDifference:
    """A robot beside the reference's.

    It has the pieces that lead from one to the other, and what is missing.

    Only `known` names are shown, because the reference has them.
    """

    def __init__(self, draft: Draft, reference: Draft) -> None:
        self.draft = draft
        self.reference = reference
        links = [link.name for link in reference.robot.links]
        self.known = {*links, *(material.name for material in reference.robot.materials)}
        self._names = _translation(draft, reference)

    @property
    def names(self) -> list[str]:
        """The links of the reference."""
        return [link.name for link in self.reference.robot.links]

    @cached_property
    def pieces(self) -> list[Piece]:
        """The pieces, each once: values first, then what moves, is added and is removed."""
        pieces = [*self._misspelt_attributes(), *self._pieces(self._steps)]
        return _unique([*pieces, *self._materials(), *self._joint_names()])

    @cached_property
    def missing(self) -> list[MissingPart]:
        """The links and joints of the reference that the robot does not have."""
        parts = []
        for step in self._steps:
            if step.verb == "add" and step.own_node.tag == "robot" and step.like:
                like = step.like.of
                if like.tag == "link":
                    parts.append(MissingPart("link", like.get("name") or ""))
                elif like.tag == "joint":
                    ends = (
                        read_end(like, "child"),
                        like.get("type") or "",
                        read_end(like, "parent"),
                    )
                    parts.append(MissingPart("joint", *ends))
        return parts

    @cached_property
    def _steps(self) -> list[Step]:
        return steps(self._tree(self.draft, {}), self._tree(self.reference, self._names))

    def piece(
        self,
        element: Element,
        cause: str,
        edits: Edits = (),
        *,
        sets: _Sets = (),
        rank: int = REFERENCE,
        link: str = "",
        tag: str = "",
    ) -> Piece:
        """Return a piece that changes an element, or its child with a tag.

        {} in the cause stands for its name.
        """
        cause = cause.replace("{}", self.draft.describe(element, tag, self.known))
        around = element if element.getparent() is self.draft.root else element.getparent()
        return Piece(cause, link or self.draft.find_link(element), sets, edits, rank, around)

    def piece_of_sets(self, sets: _Sets, rank: int = REFERENCE) -> Piece:
        """Return the piece that sets values of one element, named by what is wrong with them."""
        first = sets[0]
        return self.piece(first.owner, _cause(sets), sets=tuple(sets), rank=rank, tag=first.tag)

    def each(self, sets: _Sets) -> Pieces:
        """Yield the pieces that set each value alone, and all together."""
        yield from (self.piece_of_sets([one]) for one in sets)
        if len(sets) > 1:
            yield self.piece_of_sets(sets)

    def moved(self, element: Element, parent: Element) -> Piece:
        """Return the piece that moves an element into another one."""
        text = self.draft.text(element)
        was = element.getparent()
        cause = (
            f"<{element.tag}> is inside <{was.tag if was is not None else ''}>; it belongs in "
            f"<{parent.tag}>"
        )
        edits = self.draft.remove(element) + self.draft.insert(parent, text)
        return self.piece(element, cause, edits)._replace(around=parent)

    def _misspelt_attributes(self) -> Pieces:
        """Give attributes that ROS 2 ignores the missing names that they are like."""
        for element in self.draft.root.iter(*TAGS):
            known = TAGS[str(element.tag)].attributes.keys()
            given = list(map(str, element.keys()))
            for name in given:
                meant = closest(name, sorted(known - {*given})) if name not in known else None
                if meant is not None:
                    edits = self.draft.rename_attribute(element, name, meant)
                    cause = f"the name of the attribute {meant} of {{}}"
                    yield self.piece(element, cause, edits, rank=SIBLING)

    def _materials(self) -> Pieces:
        """Give what links show the reference's colours, if no material has them."""
        own_materials = {
            material.get("name", ""): material
            for material in self.draft.root.iterchildren("material")
        }
        for used in self.draft.root.iter("material"):
            yield from self._material(used, own_materials)

    def _material(self, used: Element, own_names: Collection[str]) -> Pieces:
        link = self.reference.link(self.draft.find_link(used))
        shown = next(link.iter("material"), None) if link is not None else None
        if shown is None:
            return
        name = shown.get("name", "")
        like = self.reference.material(name)
        colour = find_child(like, "color") if like is not None else None
        if like is None or colour is None:
            return
        if used.get("name", "") not in own_names:
            yield self.piece_of_sets([Set(used, "color", "rgba", colour.get("rgba", ""))])
            return
        own_name = self._names["material"].get(name, "")
        if self.draft.material(name) is None and self.draft.material(own_name) is None:
            replaced = self.draft.replace(used, self.reference.text(like))
            yield self.piece(used, "the material of {}", replaced)

    def _joint_names(self) -> Pieces:
        """Rename joints as in the reference, also where they are mimicked."""
        every: list[Set] = []
        for new, old in self._names["joint"].items():
            joint = next(
                candidate for candidate in self.draft.joints() if candidate.get("name") == old
            )
            mimics = (mimic for mimic in self.draft.root.iter("mimic") if mimic.get("joint") == old)
            sets = (
                Set(joint, "", "name", new),
                *(Set(mimic, "", "joint", new) for mimic in mimics),
            )
            every += sets
            yield self.piece(joint, f"the name {quoted(old)} of a joint", sets=sets, rank=STRUCTURE)
        if len(every) > 1:
            names = enumerated(map(quoted, self._names["joint"].values()), MAX_IN_HINT)
            yield Piece(f"the names {names} of joints", "", tuple(every), (), STRUCTURE)

    def _tree(self, draft: Draft, names: _Translation) -> Node:
        children = [child for child in draft.root if isinstance(child.tag, str)]
        nodes = [_make_node(child, names) for child in children[: 3 * _MAX_LINKS]]
        values = {}
        if draft is self.reference and self.draft.root.get("name") is None:
            values["name"] = draft.root.get("name") or ""
        version = draft.root.get("version")
        if version is not None and version != "1.0":
            values["version"] = version
        return Node("robot", (), values, nodes, draft.root)

    def _pieces(self, steps_of_one: Sequence[Step]) -> Pieces:
        for values in _values_of_one(steps_of_one):
            yield from self._value_pieces(values)
        for step in steps_of_one:
            own_node = step.own_node
            like = step.like
            aliases = TAGS[own_node.tag].aliases if own_node.tag in TAGS else {}
            match step.verb:
                case "rename" | "unset" if new := step.other or aliases.get(step.name):
                    edits: Edits = ()
                    if new not in own_node.values:
                        edits = self.draft.rename_attribute(own_node.of, step.name, new)
                    cause = f"the name of the attribute {new} of {{}}"
                    yield self.piece(own_node.of, cause, edits, rank=SIBLING)
                case "retag" if like:
                    edits = self.draft.rename_tag(own_node.of, like.tag)
                    yield self.piece(own_node.of, f"the name of the tag <{like.tag}>", edits)
                case "move" if step.parent is not None and like is not None:
                    yield self.moved(own_node.of, step.parent.of)
                case "add" if like and own_node.tag != "robot":
                    yield from self._inner(own_node.of, like.of)
                case "remove":
                    yield from self._remove(own_node)

    def _value_pieces(self, steps_of_one: Sequence[Step]) -> Pieces:
        """Yield the values of one element: each alone, and all together."""
        element = steps_of_one[0].own_node.of
        wanted = {step.name: _wanted_value(step) for step in steps_of_one}
        values = known_values(wanted)
        if element.tag in ("link", "joint", "material", "visual", "collision") and "name" in values:
            yield from self._rename(element, values.pop("name"))
        if "" in values:
            text = values.pop("")
            yield self.piece(element, "the text of {}", self.draft.write_text(element, text))
        if not self._is_loose(element):
            yield from self.each([Set(element, "", name, value) for name, value in values.items()])

    def _is_loose(self, element: Element) -> bool:
        """Return whether an element names a parent that no joint holds yet.

        The parent is the student's own, and is what lacks.
        """
        name = element.get("link") or ""
        if element.tag != "parent" or name in self.known or self.draft.link(name) is None:
            return False
        return self.draft.find_joint(name) is None

    def _rename(self, element: Element, name: str) -> Pieces:
        """Rename an element.

        This is a link with all that names it, or alone; a joint; or a material where it is used or
        defined.
        """
        tag = str(element.tag)
        old = element.get("name", "")
        is_begun = 2 * sum(map(self.draft.robot.has_link, self.names)) >= len(self.names)
        if tag == "link" and not is_begun and old and near(old, [name], "link") is None:
            return  # nothing shows that it is this one
        alone = (Set(element, "", "name", name),)
        everywhere = _rename_link(self.draft, old, name) if tag == "link" else alone
        link = name if tag == "link" else ""
        for sets in dict.fromkeys((everywhere, alone)):
            if sets:
                cause = f"the name {quoted(old)} of a {tag}" if old else f"the name of a {tag}"
                yield self.piece(element, cause, sets=sets, link=link)

    def _remove(self, node: Node) -> Pieces:
        """Remove what the reference does not have; an origin or axis gets its default."""
        element = node.of
        tag = node.tag
        around = element.getparent()
        # another one has the same name, or another joint the same child
        is_twice = any(self._uses[key] > 1 for key in _identities(element))
        if tag in ("origin", "axis"):
            default = "1 0 0" if tag == "axis" else "0 0 0"
            yield from self.each([Set(element, "", name, default) for name in node.values])
        elif around is self.draft.root and not is_twice:
            return
        elif around is not None and around.tag != "geometry":  # there the shape is replaced
            cause = f"an extra <{tag}>: {{}}"
            if tag in ("link", "joint"):
                cause = f"an extra {tag} {quoted(element.get('name', ''))}"
            yield self.piece(element, cause, self.draft.remove(element), rank=STRUCTURE)

    @cached_property
    def _uses(self) -> Counter[tuple[str, str, str]]:
        """How many children of the robot have a name, or move a link, by their tag."""
        return Counter(
            key for child in self.draft.root.iterchildren("*") for key in _identities(child)
        )

    def _inner(self, parent: Element, element: Element) -> Pieces:
        """Add an element to another one.

        These are values of an origin or axis, another shape, or the element as it is.
        """
        tag = str(element.tag)
        if tag in ("origin", "axis"):  # one with default values only does not count
            inner = find_child(parent, tag)
            sets = []
            for key, text in element.attrib.items():
                name = str(key)
                wanted = normal(tag, str(key), str(text))
                written = inner.get(name) if inner is not None else None
                if normal(tag, name, written) != wanted:
                    sets.append(Set(parent, tag, name, wanted))
            yield from self.each(sets)
            return
        shapes = parent.iterchildren(*CHILDREN["geometry"]) if parent.tag == "geometry" else ()
        shape = next(iter(shapes), None)
        text = self._text(element)
        if shape is None:
            cause = f"the <{tag}> of {{}} is missing"
            yield self.piece(parent, cause, self.draft.insert(parent, text))
        else:
            yield self.piece(parent, "the shape of {}", self.draft.replace(shape, text))

    def _text(self, element: Element) -> str:
        """Return an element of the reference with the robot's names.

        An undefined material has its colour.
        """
        renamed = self._names["material" if element.tag == "material" else "joint"]
        text = self.reference.text(element)
        if element.tag in ("material", "mimic"):
            for old, new in renamed.items():
                text = text.replace(f'"{old}"', f'"{escaped(new)}"')
        if element.tag == "material":
            name = element.get("name") or ""
            defined = self.reference.material(name)
            if defined is not None and self.draft.material(renamed.get(name, name)) is None:
                return self.reference.text(defined)
        return text


def _identities(element: Element) -> list[tuple[str, str, str]]:
    """Return what no other child of the robot with this tag may have.

    This is its name, and the link that it moves.
    """
    texts = (("name", element.get("name") or ""), ("child", read_end(element, "child")))
    return [(str(element.tag), what, text) for what, text in texts if text]


def _cause(sets: _Sets) -> str:
    """Return what is wrong with the values of one element."""
    tag = sets[0].tag or str(sets[0].owner.tag)
    names = " and ".join(one.attribute for one in sets)
    what = "{}" if tag in _ENDS else f"the {names} of {{}}"
    if sets[0].element is None:
        return "{} is missing"
    if all(one.attribute not in one.element.attrib for one in sets if one.element is not None):
        return f"{what} is missing"
    parts = []
    old: list[float] = []
    new: list[float] = []
    for one in sets:
        known = TAGS[tag].attributes.get(one.attribute) if tag in TAGS else None
        text = one.element.get(one.attribute) if one.element is not None else None
        if not known or not known.parts:
            return what
        parts += [part or one.attribute for part in known.parts]
        old += read_values(known.default if text is None else text)
        new += read_values(one.value)
    unit = TAGS[tag].attributes[sets[-1].attribute].unit
    return mistake_in(parts, unit, tuple(old), tuple(new))


def _unique(pieces: Iterable[Piece]) -> list[Piece]:
    """Return the pieces that change something, each once."""
    unique: dict[object, Piece] = {}
    for piece in pieces:
        unique.setdefault((piece.sets, piece.edits), piece)
    return [piece for piece in unique.values() if piece.sets or piece.edits]


def normal(tag: str, attribute: str, text: str | None) -> str:
    """Return a value as it is compared.

    Numbers have no needless digits, and the default stands where there is none.
    """
    known = TAGS[tag].attributes.get(attribute) if tag in TAGS else None
    if text is None:
        text = known.default or "" if known else ""
    is_read = known is not None and known.parts and (len(known.parts) > 1 or text == text.rstrip())
    values = read_values(text) if is_read else ()
    if values:
        return " ".join(f"{value + 0.0:.6g}" for value in values)
    return text


def _wanted_value(step: Step) -> str | None:
    """Return the value that a step sets: that of the reference, else the default.

    It is None if there is none.
    """
    if step.verb == "set" and step.like:
        return step.like.values[step.name]
    known = TAGS[step.own_node.tag].attributes.get(step.name) if step.own_node.tag in TAGS else None
    return known.default or None if known else None


def _make_node(element: Element, names: _Translation) -> Node:
    """Return the node of an element, without values and elements that are the default."""
    tag = str(element.tag)
    attributes = TAGS[tag].attributes if tag in TAGS else {}
    values = {}
    for key, value in element.attrib.items():
        name = str(key)
        text = normal(tag, name, str(value))
        if name in attributes and text == normal(tag, name, None):
            continue
        translation = names.get(_NAMES.get((tag, name), ""), {})
        values[name] = translation.get(text, text)
    content = (element.text or "").strip()
    if tag not in TAGS and not len(element) and content:
        values[""] = content
    is_moving = tag != "joint" or element.get("type") in _MOVING
    children = []
    for child in element:
        if isinstance(child.tag, str):
            node = _make_node(child, names)
            if not _is_default(node, is_moving=is_moving):
                children.append(node)
    return Node(tag, _keys(element, values), values, children, element)


def _keys(element: Element, values: StringsByName) -> Sequence[str]:
    name = values.get("name", "") or values.get("reference", "")
    is_joint = element.tag == "joint" and element.getparent() is not None
    if is_joint and find_child(element, "child") is not None:
        return read_end(element, "child"), name
    if name and element.tag not in ("visual", "collision"):
        return (name,)
    return ()


def _is_default(node: Node, *, is_moving: bool) -> bool:
    if node.tag == "axis":
        return not is_moving or node.values.get("xyz", "1 0 0") == "1 0 0"
    return node.tag == "origin" and not node.values


def _translation(draft: Draft, reference: Draft) -> dict[str, dict[str, str]]:
    """Return what the joints and materials of the reference are called in the robot."""
    joints = {}
    known = {joint.name for joint in reference.robot.joints}
    written = {joint.get("name") for joint in draft.joints()}
    for joint in reference.joints():
        own_joint = draft.find_joint(read_end(joint, "child"))
        own_name = own_joint.get("name") if own_joint is not None else None
        if own_name and own_name not in known and joint.get("name") not in written:
            joints[joint.get("name") or ""] = own_name
    own_materials = [_make_node(material, {}) for material in draft.root.iterchildren("material")]
    materials = [_make_node(material, {}) for material in reference.root.iterchildren("material")]
    called = {}
    for node, like in paired(own_materials, materials).both:
        called[like.values.get("name", "")] = node.values.get("name", "")
    named = {name: own_name for name, own_name in called.items() if own_name}
    return {"joint": joints, "material": named}


def _values_of_one(steps_in_order: Iterable[Step]) -> Iterator[list[Step]]:
    """Yield the steps that set values, those of one node that follow each other together."""
    together: list[Step] = []
    for step in steps_in_order:
        is_value = step.verb in ("set", "unset")
        if together and not (is_value and together[0].own_node is step.own_node):
            yield together
            together = []
        if is_value:
            together.append(step)
    if together:
        yield together


def _rename_link(draft: Draft, old: str, new: str) -> _Sets:
    """Return what gives a link another name, also where joints name it.

    There is nothing where several have the old one.
    """
    links = [link for link in draft.links() if link.get("name") == old]
    if len(links) != 1:
        return ()
    ends = [
        (joint, role) for joint in draft.joints() for role in _ENDS if read_end(joint, role) == old
    ]
    return (
        Set(links[0], "", "name", new),
        *(Set(joint, role, "link", new) for joint, role in ends),
    )
