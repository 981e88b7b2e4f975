"""Edits that may undo a problem of a URDF that ROS 2 reports: by the format alone, and as in the reference."""

from collections.abc import Iterator
from itertools import islice

from grader.names import closest
from grader.problems import Problem
from grader.robot import catalogue
from grader.robot.edits.difference import Difference, renamed
from grader.robot.edits.draft import Draft, Edits, Set, child_of, end_of
from grader.robot.edits.pieces import Piece
from grader.robot.edits.readable import is_readable, readable
from grader.xml.parsing import Element
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN, JOINT_TYPES, REQUIRED, TAGS, missing_element

_MAX_PIECES = 40  # for one problem
_MAX_NAMES = 4
_MAX_ELEMENTS, _MAX_MOVED = 3000, 6
_MAX_PROBLEMS = 60
_REMOVABLE = (
    "material",
    "inertial",
    "collision",
    "visual",
    "limit",
    "dynamics",
    "mimic",
    "safety_controller",
    "calibration",
    "joint",
    "link",
)
_ENDS = ("parent", "child")


def repairable(problems: tuple[Problem, ...]) -> list[Problem]:
    """Return the problems that edits may undo: first what ROS 2 ignores silently, last consequences of others."""
    found = [
        problem
        for problem in problems
        if problem.kind.effect in ("rejects", "drops") or problem.kind in (catalogue.MISSPELT, catalogue.COLOUR_COUNT)
    ]
    return sorted(found, key=lambda it: (it.kind is not catalogue.MISSPELT, it.kind.is_consequence))[:_MAX_PROBLEMS]


def misplaced(difference: Difference) -> Iterator[Piece]:
    """Yield the moves of elements which ROS 2 ignores where they are: a joint in a link, an origin beside the visual."""
    return islice(_misplaced(difference), _MAX_MOVED)


def _misplaced(difference: Difference) -> Iterator[Piece]:
    draft = difference.draft
    for element in islice(draft.root.iter(), 1, _MAX_ELEMENTS):
        tag, parent = str(element.tag), element.getparent()
        if parent is None or tag in CHILDREN.get(str(parent.tag), (tag,)):
            continue
        previous = element.getprevious()
        around = (*element.iterancestors(), *parent.iter(), *(previous.iter() if previous is not None else ()))
        for near in around:
            is_free = near is draft.root or near.find(tag) is None
            if near not in (parent, element) and tag in CHILDREN.get(str(near.tag), ()) and is_free:
                yield difference.moved(element, near)


def pieces_for(difference: Difference, problem: Problem) -> list[Piece]:
    """Return the edits that may undo a problem, the most plausible first."""
    found = difference.draft.places().get(problem.location)
    if found is None:
        return []
    element, attribute = found
    unique: dict[object, Piece] = {}
    for piece in _pieces(difference, element, attribute):
        if piece.sets or piece.edits:
            unique.setdefault(piece.sets or piece.edits, piece)
        if len(unique) == _MAX_PIECES:
            break
    return list(unique.values())


def _pieces(difference: Difference, element: Element, attribute: str | None) -> Iterator[Piece]:
    draft, tag = difference.draft, str(element.tag)
    if attribute is not None:
        yield from _of_value(difference, element, attribute)
        yield from _respelt(difference, element, attribute)
    else:
        yield from _retagged(difference, element)
    for inner in (element, *element):
        yield from _shapes(difference, inner)
    owner = draft.owner(element)
    yield from _as_in_reference(difference, owner)
    yield from _missing(difference, element)
    yield from _names(difference, element, attribute)
    if tag in ("joint", *_ENDS) or (tag == "link" and attribute is None):
        yield from _connections(difference, owner)
    removable: Element | None = element
    while removable is not None and removable is not draft.root:
        if removable.tag in _REMOVABLE:
            yield difference.piece(
                removable,
                f"an error in <{removable.tag}>",
                f"remove the <{removable.tag}>",
                edits=draft.remove(removable),
            )
        removable = removable.getparent()


def _as_in_reference(difference: Difference, owner: Element) -> Iterator[Piece]:
    for piece in difference.pieces:
        if piece.element is not None and difference.draft.owner(piece.element) is owner:
            yield piece


def _of_value(difference: Difference, element: Element, attribute: str) -> Iterator[Piece]:
    """Write numbers as ROS 2 reads them, here and wherever the mistake is the same; a type as it is called."""
    draft, text = difference.draft, element.get(attribute) or ""
    if not is_readable(attribute, text):
        for new, cause, action in readable(attribute, text):
            everywhere = tuple(_same_mistake(draft, cause))
            own = Set(element, "", attribute, new)
            if len(everywhere) > 1 and own in everywhere:
                yield difference.piece(
                    element,
                    cause,
                    action,
                    edits=tuple(
                        edit for one in everywhere for edit in draft.write(one.owner, one.attribute, one.value)[0]
                    ),
                )
            yield from (
                difference.piece(element, cause, action, edits=edits) for edits in draft.write(element, attribute, new)
            )
    if attribute == "type":
        near = text.strip().lower() if text.strip().lower() in JOINT_TYPES else closest(text, JOINT_TYPES)
        for wanted in (near, "fixed"):
            for edits in draft.write(element, "type", wanted) if wanted else ():
                yield difference.piece(element, "the type of {}", f"set the type of {{}} to {wanted}", edits=edits)


def _same_mistake(draft: Draft, cause: str) -> Iterator[Set]:
    for element in draft.root.iter():
        for attribute in ATTRIBUTES.get(str(element.tag), ()):
            text = element.get(attribute)
            if text is not None and not is_readable(attribute, text):
                found = next(readable(attribute, text), None)
                if found is not None and found[1] == cause:
                    yield Set(element, "", attribute, found[0])


def _respelt(difference: Difference, element: Element, attribute: str) -> Iterator[Piece]:
    """Rename an attribute that ROS 2 does not know."""
    tag = str(element.tag)
    missing = [name for name in ATTRIBUTES.get(tag, ()) if element.get(name) is None]
    if attribute in ATTRIBUTES.get(tag, ()) or not missing:
        return
    alias = TAGS[tag].aliases.get(attribute) or closest(attribute, missing)
    for name in dict.fromkeys(filter(None, (alias, *REQUIRED.get(tag, ())))):
        if name in missing:
            edits = difference.draft.rename_attribute(element, attribute, name)
            yield difference.piece(
                element, f"the name of the attribute {name}", f"rename {attribute} to {name}", edits=edits
            )


def _retagged(difference: Difference, element: Element) -> Iterator[Piece]:
    """Rename a tag that ROS 2 does not know where it is, and attributes of the element."""
    parent = element.getparent()
    allowed = CHILDREN.get(str(parent.tag), ()) if parent is not None else ()
    if element.tag not in allowed:
        by_attributes = [
            name for name in allowed if REQUIRED.get(name) and set(map(str, element.keys())) & set(REQUIRED[name])
        ]
        for name in dict.fromkeys(filter(None, (closest(str(element.tag), allowed), *by_attributes))):
            yield difference.piece(
                element,
                f"the name of the tag <{name}>",
                f"rename the tag to <{name}>",
                edits=difference.draft.rename_tag(element, name),
            )
    for name in map(str, element.keys()):
        yield from _respelt(difference, element, name)
    for child in element:
        if isinstance(child.tag, str) and child.tag not in CHILDREN.get(str(element.tag), ()):
            near = closest(child.tag, CHILDREN.get(str(element.tag), ()))
            if near:
                yield difference.piece(
                    child,
                    f"the name of the tag <{near}>",
                    f"rename the tag to <{near}>",
                    edits=difference.draft.rename_tag(child, near),
                )


def _shapes(difference: Difference, element: Element) -> Iterator[Piece]:
    """Put a shape that is outside of <geometry> into one."""
    draft = difference.draft
    if element.tag in ("visual", "collision"):
        empty = [found for found in element.iterchildren("geometry") if not len(found)]
        for shape in element:
            if shape.tag in CHILDREN["geometry"]:
                edits: Edits = sum((draft.remove(found) for found in empty), ())
                yield difference.piece(
                    element,
                    "a shape outside <geometry>",
                    "put the shape into <geometry>",
                    edits=(*edits, *draft.wrap(shape, "geometry")),
                )


def _missing(difference: Difference, element: Element) -> Iterator[Piece]:
    """Add the attributes and children that an element needs, with usual values; define a material."""
    draft, tag = difference.draft, str(element.tag)
    missing = {name: TAGS[tag].attributes[name].usual for name in REQUIRED.get(tag, ()) if element.get(name) is None}
    if missing and all(missing.values()):
        names = " and ".join(missing)
        yield difference.piece(
            element,
            f"the {names} of {{}} is missing",
            f"add the {names} of {{}}",
            edits=draft.add_attributes(element, missing),
        )
    needed = (
        [*TAGS[tag].needed, *(["limit"] if element.get("type") in ("revolute", "prismatic") else [])]
        if tag in TAGS
        else []
    )
    if "limit" in needed and child_of(element, "limit") is None:
        yield from (
            difference.piece(element, "the type of {}", "set the type of {} to continuous", edits=edits)
            for edits in draft.write(element, "type", "continuous")
        )
    for child in needed:
        text = missing_element(child) if child_of(element, child) is None else None
        if text is not None:
            yield difference.piece(
                element,
                f"the <{child}> of {{}} is missing",
                f"add the <{child}> of {{}}",
                edits=draft.insert(element, text),
            )
    if tag == "material" and element.getparent() is not draft.root:
        like = difference.reference.link(draft.link_of(element))
        for found in like.iter("material") if like is not None else ():
            defined = difference.reference.material(found.get("name") or "")
            colour = child_of(defined, "color") if defined is not None else None
            if colour is not None:
                text = (
                    f'<material name="{element.get("name") or ""}">\n  {difference.reference.text(colour)}\n</material>'
                )
                yield difference.piece(
                    element,
                    "a material that is not defined",
                    "define the material under <robot>",
                    edits=draft.insert(draft.root, text),
                )


def _names(difference: Difference, element: Element, attribute: str | None) -> Iterator[Piece]:
    """Give an element a name, or another name where it has that of another one; remove a copy."""
    draft, tag = difference.draft, str(element.tag)
    if tag not in ("robot", "link", "joint", "material") or attribute not in (None, "name"):
        return
    name = element.get("name")
    same = (
        [other for other in draft.root.iterchildren(tag) if other.get("name") == name]
        if element.getparent() is draft.root
        else [element]
    )
    for other in same if name is None or len(same) > 1 else ():
        for new in _free_names(difference, other):
            ways = draft.write(other, "name", new) if name is not None else [draft.add_attributes(other, {"name": new})]
            cause = f"a duplicate {tag} name" if name is not None else f"the name of the {tag} is missing"
            yield from (
                difference.piece(other, cause, f"name the {tag}", edits=edits, link=new if tag == "link" else "")
                for edits in ways
            )
    for other in reversed(same) if len(same) > 1 else ():
        yield difference.piece(other, f"a duplicate {tag}", f"remove one copy of the {tag}", edits=draft.remove(other))
    if tag == "material" and len(same) == 1 and name is not None:
        known = [str(found.get("name")) for found in draft.root.iterchildren("material")]
        used = dict.fromkeys(
            str(found.get("name")) for found in draft.root.iter("material") if found.get("name") not in known
        )
        near = closest(name, known) if element.getparent() is not draft.root else None
        for new in dict.fromkeys(filter(None, (near, *known))) if element.getparent() is not draft.root else used:
            yield from (
                difference.piece(element, "the name of a material", "correct the name of the material", edits=edits)
                for edits in draft.write(element, "name", new)
            )
        for found in draft.root.iterchildren("material") if element.getparent() is not draft.root else ():
            if found.get("name") == near or not any(
                it is not found and it.get("name") == found.get("name") for it in draft.root.iter("material")
            ):
                yield from (
                    difference.piece(
                        found,
                        "the name of a material",
                        "correct the name of the definition of the material",
                        edits=edits,
                    )
                    for edits in draft.write(found, "name", name)
                )


def _free_names(difference: Difference, element: Element) -> list[str]:
    """Return names that an element may get: those that are used and not defined, and those of the reference."""
    draft, tag = difference.draft, str(element.tag)
    taken = {other.get("name") for other in draft.root.iterchildren(tag)}
    ends = [end_of(joint, role) for joint in draft.joints() for role in _ENDS]
    likes = {
        "robot": [difference.reference.root.get("name") or "robot"],
        "link": [*ends, *(link.name for link in difference.reference.robot.links)],
        "joint": [
            *(joint.name for joint in difference.reference.robot.joints if joint.child == end_of(element, "child")),
            f"{end_of(element, 'child') or 'new'}_joint",
            "new_joint",
        ],
        "material": [
            *(found.get("name") or "" for found in draft.root.iter("material")),
            *(one.name for one in difference.reference.robot.materials),
            "material",
        ],
    }[tag]
    return [name for name in dict.fromkeys(likes) if name and name not in taken][:_MAX_NAMES]


def _connections(difference: Difference, owner: Element) -> Iterator[Piece]:
    """Connect links: name the end of a joint, rename or add the link that it names, add the joint of a loose link."""
    draft = difference.draft
    links = [link.get("name") or "" for link in draft.links()]
    children = {end_of(joint, "child") for joint in draft.joints()}
    loose = [name for name in links if name and name not in children]
    for joint in [owner] if owner.tag == "joint" else draft.joints():
        for role in _ENDS:
            end, given = child_of(joint, role), end_of(joint, role)
            other = end_of(joint, "parent" if role == "child" else "child")
            if given in links and owner.tag != "joint":
                continue
            near = closest(given, links) if given else None
            for name in dict.fromkeys(filter(None, (near, *loose[:_MAX_NAMES]))):
                if name in (other, given):
                    continue
                ways = (
                    [draft.insert(joint, f'<{role} link="{name}"/>')]
                    if end is None
                    else draft.ways([Set(end, "", "link", name)])
                )
                yield from (
                    difference.piece(joint, f"the {role} of {{}}", f"correct the {role} of {{}}", edits=edits)
                    for edits in ways
                )
            if given and given not in links:
                unknown = [name for name in links if not difference.reference.robot.has_link(name)]
                for name in dict.fromkeys(
                    filter(None, (closest(given, unknown), *(name for name in loose if name in unknown)))
                ):
                    yield difference.piece(
                        joint,
                        "the name of a link",
                        "correct the name of the link",
                        edits=renamed(draft, name, given),
                        link=given,
                    )
                like = difference.reference.link(given)
                text = difference.text(like) if like is not None else f'<link name="{given}"/>'
                yield difference.piece(
                    joint,
                    "the link of a joint is missing",
                    "add the link that the joint names",
                    edits=draft.append(text),
                    link=given,
                )
    for name in loose:
        like = difference.reference.joint_of(name)
        if like is not None:
            yield Piece(
                f"the joint of {name!r} is missing",
                f"add the joint of {name!r}",
                name,
                (),
                draft.append(difference.text(like)),
            )
    if owner.tag == "link" and owner.get("name") in loose:
        for other in [name for name in links if name != owner.get("name")][:_MAX_NAMES]:
            child = owner.get("name")
            text = f'<joint name="{child}_joint" type="fixed">\n  <parent link="{other}"/>\n  <child link="{child}"/>\n</joint>'
            yield difference.piece(
                owner, "a link that is not connected", "connect the link by a joint", edits=draft.append(text)
            )
