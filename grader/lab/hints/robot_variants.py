"""Pieces besides the single steps of the difference to the reference.

The student's own numbers with another sign, order or unit, doubled or halved; those of the link at
the other side; and all steps that one link, or one element, needs together.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, combinations, starmap
from math import inf
from typing import TYPE_CHECKING

from grader.base.element_edits import format_number, format_numbers
from grader.base.errors import MissingElement, NotDecided
from grader.base.patterns import on_use
from grader.base.source import Edits
from grader.base.transforms import Z_AXIS
from grader.lab.hints.robot_difference import (
    OWN,
    SIBLING,
    STRUCTURE,
    Piece,
    Pieces,
    RobotDifference,
    normal,
)
from grader.lab.hints.robot_draft import Draft, Set, find_child, read_end
from grader.lab.hints.robot_numbers import LARGE, Values, plausible, read_values
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.shapes import UnknownShape
from grader.ros.urdf.standing_robot import StandingRobot
from grader.ros.xml.parsing import Element
from grader.ros.xml.urdf_format import TAGS

if TYPE_CHECKING:  # most robots are no xacro
    from grader.ros.xacro.rewriting import NumberDefinition

_SIDES = {
    "left": "right",
    "right": "left",
    "front": "rear",
    "rear": "front",
    "l": "r",
    "r": "l",
    "upper": "lower",
}
_WORD = on_use(r"[^\W\d_]+")
_EXCHANGED = "parent and child of {} are exchanged"
_OTHER_END = {"parent": "child", "child": "parent"}
_MAX_ONE_BY_ONE = 3  # values whose mistakes are named
_WITH_NUMBERS = (
    "origin",
    "axis",
    "limit",
    "mimic",
    "dynamics",
    "color",
    "box",
    "cylinder",
    "capsule",
    "sphere",
    "mass",
)


def _parts(draft: Draft, link: str) -> Iterator[tuple[str, Element]]:
    """Yield the elements with numbers of a link and its joint, each with its path."""
    for owner in (draft.find_joint(link), draft.link(link)):
        if owner is None:
            continue
        for element in owner.iter(*_WITH_NUMBERS):
            around = element.getparent()
            if around is not None and around.tag == "geometry":
                around = around.getparent()
            yield f"{owner.tag}/{around.tag if around is not None else ''}/{element.tag}", element


def _first_parts(draft: Draft, link: str) -> dict[str, Element]:
    """Return the first element at each path."""
    parts: dict[str, Element] = {}
    for path, element in _parts(draft, link):
        parts.setdefault(path, element)
    return parts


def of_siblings(difference: RobotDifference, links: Iterable[str]) -> Pieces:
    """Yield the numbers of the link at the other side, mirrored.

    There are some only where the student builds both unlike the reference.
    """
    for link in links:
        other_link = _other_side(link)
        theirs = _first_parts(difference.draft, other_link) if other_link != link else {}
        if not theirs:
            continue
        like_theirs = _first_parts(difference.reference, other_link)
        like_own = _first_parts(difference.reference, link)
        for path, element in _parts(difference.draft, link):
            if path not in theirs:
                continue
            known = [element]
            if path in like_own:
                known.append(like_own[path])
            yield from _mirror_numbers(difference, theirs[path], like_theirs.get(path), known)


def _mirror_numbers(
    difference: RobotDifference, other: Element, like: Element | None, known: Sequence[Element]
) -> Pieces:
    """Yield the mirrored numbers of another element that are not `known`.

    Those of its own element, the first of `known`, get them.
    """
    tag = str(other.tag)
    for name, attribute in TAGS[tag].attributes.items():
        text = other.get(name)
        text_of_reference = like.get(name) if like is not None else None
        values = read_values(text)
        if len(values) != len(attribute.parts):
            continue
        if normal(tag, name, text) == normal(tag, name, text_of_reference):
            continue
        tried = {normal(tag, name, element.get(name)) for element in known}
        for mirrored in map(format_numbers, _mirrored(values)):
            if normal(tag, name, mirrored) not in tried:
                yield difference.piece_of_sets([Set(known[0], "", name, mirrored)], SIBLING)


def _mirrored(values: Values) -> Iterator[Values]:
    yield values
    for index, value in enumerate(values):
        if value:
            yield (*values[:index], -value, *values[index + 1 :])


def of_own(difference: RobotDifference, links: Iterable[str]) -> Pieces:
    """Yield the numbers of links as they may be meant, where they are not the reference's.

    Where xacro computes them, yield the numbers that they come from.
    """
    seen = set()
    is_alone = difference.draft is difference.reference
    for link in links:
        like = _first_parts(difference.reference, link)
        for path, element in _parts(difference.draft, link):
            tag = str(element.tag)
            yield from _exchange_of_two(difference, element)
            for name in TAGS[tag].attributes:
                of_reference = like[path].get(name) if path in like else None
                is_same = normal(tag, name, element.get(name)) == normal(tag, name, of_reference)
                if is_same and not is_alone:
                    continue
                for piece in _meant_numbers(difference, element, name):
                    if piece.edits not in seen:
                        yield piece
                    if piece.edits:
                        seen.add(piece.edits)


def _exchange_of_two(difference: RobotDifference, element: Element) -> Pieces:
    """Yield what exchanges the two single numbers of an element, such as radius and length."""
    single = []
    for name, attribute in TAGS[str(element.tag)].attributes.items():
        if len(attribute.parts) == 1 and element.get(name):
            single.append(name)
    if len(single) == 2:
        first, second = single
        sets = [
            Set(element, "", first, element.get(second) or ""),
            Set(element, "", second, element.get(first) or ""),
        ]
        yield difference.piece_of_sets(sets, OWN)


def _meant_numbers(difference: RobotDifference, element: Element, name: str) -> Pieces:
    """Yield the numbers that an attribute may be meant to have, where it is written.

    If xacro computes it, yield those that it comes from.
    """
    unit = TAGS[str(element.tag)].attributes[name].unit
    least = 0.0 if unit == "m" and element.tag != "origin" else -inf  # of a size
    written = read_values(element.get(name))
    # A number like 1e400 has no values.
    definitions = [
        number for number in difference.draft.numbers(element, name) if read_values(number.text)
    ]
    if not definitions:
        for values in plausible(unit, written):
            if min(values) > least:
                yield difference.piece_of_sets(
                    [Set(element, "", name, format_numbers(values))], OWN
                )
    coordinates = written if element.tag == "origin" else ()
    cause = f"a number from which the {name} of {{}} is computed"
    for definition in definitions:
        for edits in _meant_definitions(definition, unit, least, coordinates):
            yield difference.piece(element, cause, edits, rank=OWN)
    yield from _exchanged_lengths(difference, element, name, definitions)


def _meant_definitions(
    definition: "NumberDefinition", unit: str, least: float, coordinates: tuple[float, ...]
) -> Iterator[Edits]:
    """Yield the edits that give a number of xacro another value, above `least`."""
    (old,) = read_values(definition.text)
    for (new,) in plausible(unit, (old,)):
        if new > least and _may_be_meant(old, new, coordinates):
            edits = definition.edits_with(format_number(new))
            if edits:
                yield edits


def _exchanged_lengths(
    difference: RobotDifference,
    element: Element,
    name: str,
    definitions: "Sequence[NumberDefinition]",
) -> Pieces:
    """Yield the edits that exchange two of the lengths that an attribute is computed from."""
    lengths = [number for number in definitions if abs(read_values(number.text)[0]) != 1.0]
    cause = f"the numbers from which the {name} of {{}} is computed"
    for one, other in combinations(lengths, 2):
        edits: Edits = ()
        if one.text != other.text:
            edits = one.edits_with(other.text) + other.edits_with(one.text)
        yield difference.piece(element, cause, edits, rank=OWN)


def _may_be_meant(old: float, new: float, coordinates: Values) -> bool:
    """Return whether a number of xacro may be another one.

    1 and -1 are the sides, and a length stays positive.
    """
    if abs(old) == 1.0:
        return new == -old
    return old in coordinates or not old > 0.0 > new


def reversed_joints(difference: RobotDifference) -> list[Element]:
    """Return the joints whose parent should be below their child.

    In the reference, the child is above the parent.
    """
    parents = {}
    for joint in difference.reference.joints():
        parents[read_end(joint, "child")] = read_end(joint, "parent")

    def links_above(link: str) -> set[str]:
        above = set()
        while (link := parents.get(link, "")) and link not in above:
            above.add(link)
        return above

    return [
        joint
        for joint in difference.draft.joints()
        if read_end(joint, "child") in links_above(read_end(joint, "parent"))
    ]


def exchanges(difference: RobotDifference) -> list[Piece]:
    """Return what exchanges the ends of joints.

    These are parent and child of reversed joints, and the children of two joints of both sides.
    """
    pieces = []
    for joint in reversed_joints(difference):
        edits = _exchange_ends(difference.draft, (joint, "parent"), (joint, "child"))
        pieces.append(difference.piece(joint, _EXCHANGED, edits))
    if len(pieces) > 1:
        every_edit = dict.fromkeys(edit for piece in pieces for edit in piece.edits)
        cause = "parents and children of joints are exchanged"
        pieces.append(pieces[0]._replace(cause=cause, edits=tuple(every_edit)))
    for joint in difference.draft.joints():
        other = difference.draft.find_joint(_other_side(read_end(joint, "child")))
        if other is not None and other is not joint:
            edits = _exchange_ends(difference.draft, (joint, "child"), (other, "child"))
            cause = "the children of two joints are exchanged"
            pieces.append(difference.piece(joint, cause, edits))
    return pieces


def _exchange_ends(draft: Draft, *ends: tuple[Element, str]) -> Edits:
    elements = list(starmap(find_child, ends))
    return draft.exchange(
        *[element for element in elements if element is not None], attribute="link"
    )


def _other_side(link: str) -> str:
    """Return the name of the link at the other side; the same name if it has no side."""
    return _WORD.sub(lambda word: _SIDES.get(word[0], word[0]), link)


def leveled_supports(difference: RobotDifference, links: Sequence[str], base: str) -> Pieces:
    """Yield the height at which a support is level with the others.

    It is above or below them.
    """
    robot = Configuration(difference.draft.robot)
    try:
        standing = StandingRobot(robot, links, base)
        link, height = standing.find_odd_height()
        joint = robot.parent_joints[link]
        up = robot.pose(standing.base, relative_to=joint.parent).rotate(Z_AXIS)
    except (KeyError, MissingElement, NotDecided, UnknownShape):
        return
    element = difference.draft.find_joint(link)
    origin = find_child(element, "origin") if element is not None else None
    if origin is None or not joint.origin or not height:
        return
    moved = [old - height * part for old, part in zip(joint.origin.xyz, up, strict=True)]
    xyz = format_numbers(round(number, 6) for number in moved)
    yield difference.piece_of_sets([Set(origin, "", "xyz", xyz)], OWN)


def in_another_unit(difference: RobotDifference) -> Pieces:
    """Yield all lengths in metres.

    This is for a robot of which they are all in centimetres or millimetres.
    """
    lengths = list(_list_lengths(difference.draft))
    if not any(element.tag != "origin" and max(values) >= LARGE for element, _, values in lengths):
        return
    for factor, unit in ((100.0, "centimetres"), (1000.0, "millimetres")):
        sets = []
        for element, name, values in lengths:
            metres = format_numbers(value / factor for value in values)
            sets.append(Set(element, "", name, metres))
        yield Piece(f"the unit of all lengths: {unit}, not metres", "", tuple(sets), (), OWN)


def _list_lengths(draft: Draft) -> Iterator[tuple[Element, str, Values]]:
    """Yield the attributes of a robot that are lengths, with their numbers, if one is not 0."""
    for element in draft.root.iter():
        if element.tag not in TAGS:
            continue
        for name, attribute in TAGS[str(element.tag)].attributes.items():
            values = read_values(element.get(name)) if attribute.unit == "m" else ()
            if any(values):
                yield element, name, values


def whole_links(difference: RobotDifference) -> Pieces:
    """Yield where each link and what it shows are, and all its values.

    Where they are is also yielded with what it carries.
    """
    links: dict[str, list[Set]] = {}
    for piece in difference.pieces:
        sets = links.setdefault(piece.link, [])
        for change in piece.sets:
            if change not in sets and change.attribute != "name":
                sets.append(change)
    every_set = list(chain.from_iterable(links.values()))
    for link, sets in links.items():
        if link not in difference.known:
            continue
        poses = [change for change in sets if _is_pose(change)]
        carried = {
            joint for joint in difference.draft.joints() if read_end(joint, "parent") == link
        }
        after = [
            change
            for change in every_set
            if change.owner in carried or change.owner.getparent() in carried
        ]
        frame = f"the frame of {link!r} and what it shows"
        yield from _group(difference, link, poses, frame)
        yield from _group(difference, link, poses + after, f"{frame} and carries")
        yield from _group(difference, link, sets, f"the values of {link!r}")


def _is_pose(change: Set) -> bool:
    """Return whether a value says where a link is, or how it moves."""
    tags = (change.tag, change.owner.tag)
    return "origin" in tags or "axis" in tags


def _group(difference: RobotDifference, link: str, sets: list[Set], what: str) -> Pieces:
    changed = {(change.owner, change.tag): change for change in sets}
    if len(changed) < 2:
        return
    if len(changed) == len(sets) <= _MAX_ONE_BY_ONE:
        what = _causes(difference, list(changed.values()))
    yield Piece(what, link, tuple(dict.fromkeys(sets)), (), STRUCTURE)


def _causes(difference: RobotDifference, changes: Sequence[Set]) -> str:
    """Return what is wrong with values; the ends of a joint that are exchanged are one mistake."""
    ends = {(change.owner.getparent(), str(change.owner.tag)): change for change in changes}
    exchanged = []
    others = []
    for change in changes:
        joint = change.owner.getparent()
        role = str(change.owner.tag)
        other = ends.get((joint, _OTHER_END.get(role, "")))
        if not other or change.value != other.owner.get("link"):
            others.append(difference.piece_of_sets([change]).cause)
        elif role == "parent" and joint is not None:
            exchanged.append(difference.piece(joint, _EXCHANGED).cause)
    return ", and ".join([*exchanged, *([" and ".join(others)] if others else [])])


def whole_elements(difference: RobotDifference) -> Pieces:
    """Yield the changes in one element together, and in one child of the robot.

    Of links and joints, no values are among them.
    """
    draft = difference.draft
    for is_owner in (False, True):
        groups: dict[Element, list[Piece]] = {}
        for piece in difference.pieces:
            if piece.around is None:
                continue
            owner = draft.owner(piece.around)
            has_values = owner.tag in ("link", "joint", "material", "robot")
            is_removed = not piece.sets and not any(edit.new for edit in piece.edits)
            if not is_removed and (piece.edits or not has_values):
                groups.setdefault(owner if is_owner else piece.around, []).append(piece)
        for element, pieces in groups.items():
            if element is draft.root or len(pieces) < 2:
                continue
            cause = " and ".join(dict.fromkeys(piece.cause for piece in pieces))
            edits = chain.from_iterable(piece.edits for piece in pieces)
            sets = chain.from_iterable(piece.sets for piece in pieces)
            yield Piece(cause, pieces[0].link, tuple(sets), tuple(edits), STRUCTURE)
