"""Edits that may undo a problem of a URDF that ROS 2 reports: by the format alone, and as in the reference."""

from collections.abc import Iterator, Sequence
from itertools import islice

from grader.names import closest
from grader.problems import Problem
from grader.robot import catalogue
from grader.robot.edits.difference import RobotDifference, rename_link
from grader.robot.edits.draft import Draft
from grader.robot.edits.elements import Set, child_of, end_of
from grader.robot.edits.pieces import ENDS, Piece, unique
from grader.robot.edits.readable import is_readable, readable_values
from grader.xml.parsing import Element
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN, JOINT_TYPES, REQUIRED, TAGS, missing_element

_MAX_PIECES = 40  # for one problem
_MAX_NAMES, _MAX_PROBLEMS, _MAX_ELEMENTS = 4, 60, 3000
_KEPT = ("robot", "origin", "axis", "parent", "child", "geometry", *CHILDREN["geometry"])  # what no edit removes


def repairable(problems: tuple[Problem, ...]) -> list[Problem]:
    """Return the problems that edits may undo: first what ROS 2 ignores silently, last consequences of others."""
    found = [
        problem
        for problem in problems
        if problem.kind.effect in ("rejects", "drops") or problem.kind in (catalogue.MISSPELT, catalogue.COLOUR_COUNT)
    ]
    return sorted(found, key=lambda it: (it.kind is not catalogue.MISSPELT, it.kind.is_consequence))[:_MAX_PROBLEMS]


def misplaced(difference: RobotDifference) -> Iterator[Piece]:
    """Yield the moves of elements that ROS 2 ignores where they are: a joint in a link, an origin beside the visual."""
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


def pieces_for(difference: RobotDifference, problem: Problem) -> list[Piece]:
    """Return the edits that may undo a problem, the most plausible first."""
    found = difference.draft.places().get(problem.location)
    return unique(_pieces(difference, *found))[:_MAX_PIECES] if found is not None else []


def _pieces(difference: RobotDifference, element: Element, attribute: str | None) -> Iterator[Piece]:
    if attribute is not None:
        yield from _of_value(difference, element, attribute)
    yield from _respelt(difference, element, attribute)
    owner = difference.draft.owner(element)
    changes = ((piece, piece.element) for piece in difference.pieces if piece.element is not None)
    yield from (piece for piece, changed in changes if difference.draft.owner(changed) is owner)
    yield from _missing(difference, element)
    yield from _names(difference, element, attribute)
    if element.tag in ("joint", *ENDS) or (element.tag == "link" and attribute is None):
        yield from _connections(difference, owner)
    for around in (element, *element.iterancestors()):
        if around.tag in TAGS and around.tag not in _KEPT and around.get("name") not in difference.names:
            edits = difference.draft.remove(around)
            yield difference.piece(around, f"an error in <{around.tag}>", f"remove the <{around.tag}>", edits)


def _of_value(difference: RobotDifference, element: Element, attribute: str) -> Iterator[Piece]:
    """Write numbers as ROS 2 reads them, here and wherever the mistake is the same; a type as it is called."""
    text = element.get(attribute) or ""
    if not is_readable(attribute, text):
        for new, cause, action in readable_values(attribute, text):
            own = Set(element, "", attribute, new)
            everywhere = tuple(_same_mistake(difference.draft, cause))
            for sets in (everywhere, (own,)) if own in everywhere else ((own,),):
                yield difference.piece(element, cause, action, sets=sets)
    if attribute == "type":
        for wanted in (text.strip().lower(), closest(text, JOINT_TYPES), "fixed"):
            if wanted in JOINT_TYPES:
                yield difference.of_sets([Set(element, "", "type", wanted)])


def _same_mistake(draft: Draft, cause: str) -> Iterator[Set]:
    for element in draft.root.iter():
        for attribute in ATTRIBUTES.get(str(element.tag), ()):
            text = element.get(attribute)
            found = next(readable_values(attribute, text), None) if text and not is_readable(attribute, text) else None
            if found is not None and found[1] == cause:
                yield Set(element, "", attribute, found[0])


def _respelt(difference: RobotDifference, element: Element, attribute: str | None) -> Iterator[Piece]:
    """Rename a tag or an attribute that ROS 2 does not know where it is."""
    tag, parent = str(element.tag), element.getparent()
    allowed = CHILDREN.get(str(parent.tag), ()) if parent is not None else (tag,)
    if attribute is None and tag not in allowed:
        names = [name for name in allowed if {*map(str, element.keys())} & {*REQUIRED.get(name, ())}]
        for name in dict.fromkeys(filter(None, (closest(tag, allowed), *names))):
            edits = difference.draft.rename_tag(element, name)
            yield difference.piece(element, f"the name of the tag <{name}>", f"rename the tag to <{name}>", edits)
    missing = [name for name in ATTRIBUTES.get(tag, ()) if element.get(name) is None]
    for old in map(str, element.keys()) if attribute is None else (attribute,):
        likely = (TAGS[tag].aliases.get(old), closest(old, missing), *REQUIRED[tag]) if tag in TAGS else ()
        for new in dict.fromkeys(likely) if old not in ATTRIBUTES.get(tag, ()) else ():
            if new in missing:
                edits = difference.draft.rename_attribute(element, old, new)
                yield difference.piece(element, f"the name of the attribute {new}", f"rename {old} to {new}", edits)


def _missing(difference: RobotDifference, element: Element) -> Iterator[Piece]:
    """Add the attributes and children that an element needs, with usual values; put shapes into <geometry>."""
    draft, tag = difference.draft, str(element.tag)
    missing = {name: TAGS[tag].attributes[name].usual for name in REQUIRED.get(tag, ()) if element.get(name) is None}
    if missing and all(missing.values()):
        yield difference.of_sets([Set(element, "", name, value) for name, value in missing.items()])
    is_limited = element.get("type") in ("revolute", "prismatic")
    for child in (*(TAGS[tag].needed if tag in TAGS else ()), *(["limit"] if is_limited else [])):
        if child_of(element, child) is not None:
            continue
        if child == "limit":
            yield difference.of_sets([Set(element, "", "type", "continuous")])
        inside = [it for it in element if it.tag in CHILDREN.get(child, ())]
        if inside:
            edits = draft.wrap(inside[0], child)
            yield difference.piece(element, f"a shape outside <{child}>", f"put the shape into <{child}>", edits)
        elif (text := missing_element(child)) is not None:
            edits = draft.insert(element, text)
            yield difference.piece(element, f"the <{child}> of {{}} is missing", f"add the <{child}> of {{}}", edits)
    if tag == "material":
        yield from _missing_material(difference, element)


def _missing_material(difference: RobotDifference, element: Element) -> Iterator[Piece]:
    """Define the materials of the reference's link, or give an element its colour."""
    like = difference.reference.link(difference.draft.link_of(element))
    if like is not None and (edits := difference.additions.materials(like)):
        cause, action = "a material that is not defined", "define the material under <robot>"
        yield difference.piece(element, cause, action, edits)
    elif like is not None:
        definitions = (difference.reference.material(it.get("name") or "") for it in like.iter("material"))
        for colour in (it for found in definitions if found is not None for it in found.iter("color")):
            yield difference.of_sets([Set(element, "color", "rgba", colour.get("rgba") or "")])


def _names(difference: RobotDifference, element: Element, attribute: str | None) -> Iterator[Piece]:
    """Give an element a name, or another name where it has that of another one; remove a copy."""
    draft, tag = difference.draft, str(element.tag)
    if "name" not in REQUIRED.get(tag, ()) or attribute not in (None, "name"):
        return
    name, is_definition = element.get("name"), element.getparent() is draft.root
    same = [it for it in draft.root.iterchildren(tag) if it.get("name") == name] if is_definition else [element]
    is_pasted = tag == "joint" and len({end_of(it, "child") for it in same}) < len(same)  # no name makes it another
    for other in same if name is None or (len(same) > 1 and not is_pasted) else ():
        cause = f"the name of the {tag} is missing" if name is None else f"a duplicate {tag} name"
        for new in _free_names(difference, other):
            sets, link = (Set(other, "", "name", new),), new if tag == "link" else ""
            yield difference.piece(other, cause, f"name the {tag}", sets=sets, link=link)
    for other in reversed(same) if len(same) > 1 else ():
        yield difference.piece(other, f"a duplicate {tag}", f"remove one copy of the {tag}", draft.remove(other))
    if tag == "material" and name is not None and not is_definition:
        defined = [*draft.root.iterchildren("material")]
        names = [str(it.get("name")) for it in defined]
        for new in dict.fromkeys(filter(None, (closest(name, names), *names))):
            yield difference.of_sets([Set(element, "", "name", new)])
        yield from (difference.of_sets([Set(it, "", "name", name)]) for it in defined)


def _free_names(difference: RobotDifference, element: Element) -> list[str]:
    """Return names that an element may get: those that are used and not defined, and those of the reference."""
    draft, tag = difference.draft, str(element.tag)
    taken = {other.get("name") for other in draft.root.iterchildren(tag)}
    known, child = difference.reference.robot, end_of(element, "child")
    likes = {
        "link": [*(end_of(joint, role) for joint in draft.joints() for role in ENDS), *(it.name for it in known.links)],
        "joint": [
            *(joint.name for joint in known.joints if joint.child == child),
            f"{child or 'new'}_joint",
            "new_joint",
        ],
        "material": [
            *(it.get("name") or "" for it in draft.root.iter("material")),
            *(it.name for it in known.materials),
        ],
    }.get(tag, [difference.reference.root.get("name") or tag])
    return [name for name in dict.fromkeys(likes) if name and name not in taken][:_MAX_NAMES]


def _connections(difference: RobotDifference, owner: Element) -> Iterator[Piece]:
    """Connect links: name the end of a joint, rename or add the link that it names."""
    draft = difference.draft
    links = [link.get("name") or "" for link in draft.links()]
    children = {end_of(joint, "child") for joint in draft.joints()}
    loose = [name for name in links if name and name not in children]
    joints = [owner] if owner.tag == "joint" else draft.joints()
    for joint, (role, opposite) in ((joint, roles) for joint in joints for roles in (ENDS, ENDS[::-1])):
        given = end_of(joint, role)
        if given in links and owner.tag != "joint":
            continue
        for name in dict.fromkeys(filter(None, (closest(given, links), *loose[:_MAX_NAMES]))):
            if name not in (end_of(joint, opposite), given):
                yield difference.of_sets([Set(joint, role, "link", name)])
        if given and given not in links:
            yield from _missing_link(difference, joint, given, links, loose)


def _missing_link(
    difference: RobotDifference, joint: Element, given: str, links: Sequence[str], loose: Sequence[str]
) -> Iterator[Piece]:
    """Give a link that the reference does not have the name that a joint names, or add a link of that name."""
    draft = difference.draft
    unknown = [name for name in links if not difference.reference.robot.has_link(name)]
    free = (name for name in loose if name in unknown)
    for name in dict.fromkeys(filter(None, (closest(given, unknown), *free))):
        cause, action = "the name of a link", "correct the name of the link"
        yield difference.piece(joint, cause, action, sets=rename_link(draft, name, given), link=given)
    like = difference.reference.link(given)
    text = difference.additions.text(like) if like is not None else f'<link name="{given}"/>'
    cause, action = "the link of a joint is missing", "add the link that the joint names"
    yield difference.piece(joint, cause, action, draft.append(text), link=given)
