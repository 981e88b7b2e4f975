"""Pieces besides the single steps of the difference to the reference.

The student's own numbers with another sign, order or unit, doubled or halved; those of the link at
the other side; and all steps that one link, or one element, needs together.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations
from math import inf

from grader.base.source import Edits
from grader.lab.hints.robot_difference import (
    OWN,
    SIBLING,
    STRUCTURE,
    Piece,
    RobotDifference,
    normal,
)
from grader.lab.hints.robot_draft import Draft, Set, child_of, end_of
from grader.lab.hints.robot_numbers import (
    LARGE,
    Values,
    format_number,
    format_numbers,
    plausible,
    values_of,
)
from grader.ros.xml.parsing import Element
from grader.ros.xml.urdf_format import TAGS

_SIDES = {
    "left": "right",
    "right": "left",
    "front": "rear",
    "rear": "front",
    "l": "r",
    "r": "l",
    "upper": "lower",
}
_WORD = re.compile(r"[^\W\d_]+")
_MAX_NAMED = 3  # values whose mistakes are named one by one
_FRAME = "the frame of {!r} and what it shows"
_WITH_NUMBERS = (
    "origin",
    "axis",
    "limit",
    "mimic",
    "dynamics",
    "color",
    "box",
    "cylinder",
    "sphere",
    "mass",
)


def _parts(draft: Draft, link: str) -> Iterator[tuple[str, Element]]:
    """Yield the elements with numbers of a link and its joint, each with its path."""
    for owner in (draft.joint_of(link), draft.link(link)):
        if owner is None:
            continue
        for element in owner.iter(*_WITH_NUMBERS):
            around = element.getparent()
            if around is not None and around.tag == "geometry":
                around = around.getparent()
            yield f"{owner.tag}/{around.tag if around is not None else ''}/{element.tag}", element


def _first_parts(draft: Draft, link: str) -> dict[str, Element]:
    """Return the first element at each path."""
    found: dict[str, Element] = {}
    for path, element in _parts(draft, link):
        found.setdefault(path, element)
    return found


def of_siblings(difference: RobotDifference, links: Iterable[str]) -> Iterator[Piece]:
    """Yield the numbers of the link at the other side, mirrored, where the student builds both
    unlike the reference.
    """
    for link in links:
        other = _other_side(link)
        theirs = _first_parts(difference.draft, other) if other != link else {}
        if theirs:
            like, mine = (
                _first_parts(difference.reference, other),
                _first_parts(difference.reference, link),
            )
            for path, element in _parts(difference.draft, link):
                if path in theirs:
                    known = [it for it in (element, mine.get(path)) if it is not None]
                    yield from _of_sibling(difference, theirs[path], like.get(path), known)


def _of_sibling(
    difference: RobotDifference, other: Element, like: Element | None, known: Sequence[Element]
) -> Iterator[Piece]:
    """Yield the mirrored numbers of another element that are not `known`: those of its own
    element, which is first.
    """
    tag = str(other.tag)
    for name, attribute in TAGS[tag].attributes.items():
        text, given = other.get(name), like.get(name) if like is not None else None
        values = values_of(text)
        if len(values) == len(attribute.parts) and normal(tag, name, text) != normal(
            tag, name, given
        ):
            tried = {normal(tag, name, it.get(name)) for it in known}
            for mirrored in map(format_numbers, _mirrored(values)):
                if normal(tag, name, mirrored) not in tried:
                    yield difference.of_sets([Set(known[0], "", name, mirrored)], SIBLING)


def _mirrored(values: Values) -> Iterator[Values]:
    yield values
    for index in (index for index, value in enumerate(values) if value):
        yield (*values[:index], -values[index], *values[index + 1 :])


def of_own(difference: RobotDifference, links: Iterable[str]) -> Iterator[Piece]:
    """Yield the numbers of links as they may be meant, where they are not the reference's.

    Where xacro computes them, the numbers that they come from.
    """
    seen: set[object] = set()
    is_alone = difference.draft is difference.reference
    for link in links:
        like = _first_parts(difference.reference, link)
        for path, element in _parts(difference.draft, link):
            tag = str(element.tag)
            numbers = TAGS[tag].attributes
            single = [
                name
                for name, known in numbers.items()
                if len(known.parts) == 1 and element.get(name)
            ]
            if len(single) == 2:
                pair = zip(single, single[::-1], strict=True)
                yield difference.of_sets(
                    [Set(element, "", one, element.get(other) or "") for one, other in pair], OWN
                )
            for name in numbers:
                given = like[path].get(name) if path in like else None
                if is_alone or normal(tag, name, element.get(name)) != normal(tag, name, given):
                    for piece in _of_number(difference, element, name):
                        if piece.edits not in seen:
                            yield piece
                        if piece.edits:
                            seen.add(piece.edits)


def _of_number(difference: RobotDifference, element: Element, name: str) -> Iterator[Piece]:
    unit = TAGS[str(element.tag)].attributes[name].unit
    least = 0.0 if unit == "m" and element.tag != "origin" else -inf  # of a size
    defined = [
        found for found in difference.draft.numbers(element, name) if values_of(found[0])
    ]  # not 1e400
    if not defined:
        for values in plausible(unit, values_of(element.get(name))):
            if min(values) > least:
                yield difference.of_sets([Set(element, "", name, format_numbers(values))], OWN)
    coordinates = values_of(element.get(name)) if element.tag == "origin" else ()
    for text, edits_with in defined:
        (old,) = values_of(text)
        for (value,) in plausible(unit, (old,)):
            is_side = abs(old) == 1.0 and value != -old  # 1 and -1 are the sides
            is_length = old > 0.0 > value and abs(old) != 1.0 and old not in coordinates
            edits = edits_with(format_number(value))
            if edits and value > least and not is_length and not is_side:
                cause = f"a number from which the {name} of {{}} is computed"
                yield difference.piece(element, cause, edits, rank=OWN)
    lengths = [it for it in defined if abs(values_of(it[0])[0]) != 1.0]
    for (one, with_one), (other, with_other) in combinations(lengths, 2):
        edits = (*with_one(other), *with_other(one)) if one != other else ()
        yield difference.piece(
            element, f"the numbers from which the {name} of {{}} is computed", edits, rank=OWN
        )


def reversed_joints(difference: RobotDifference) -> list[Element]:
    """Return the joints whose parent should be below their child: in the reference, the child is
    above the parent.
    """
    parents = {
        end_of(joint, "child"): end_of(joint, "parent") for joint in difference.reference.joints()
    }

    def links_above(link: str) -> set[str]:
        found: set[str] = set()
        while (link := parents.get(link, "")) and link not in found:
            found.add(link)
        return found

    return [
        it
        for it in difference.draft.joints()
        if end_of(it, "child") in links_above(end_of(it, "parent"))
    ]


def exchanges(difference: RobotDifference) -> list[Piece]:
    """Return what exchanges parent and child of reversed joints, and the children of two joints
    of both sides.
    """
    found: list[Piece] = []
    for joint in reversed_joints(difference):
        edits = _exchange_ends(difference.draft, (joint, "parent"), (joint, "child"))
        found.append(difference.piece(joint, "parent and child of a joint are exchanged", edits))
    if len(found) > 1:
        edits = tuple(dict.fromkeys(edit for piece in found for edit in piece.edits))
        found.append(
            found[0]._replace(cause="parents and children of joints are exchanged", edits=edits)
        )
    for joint in difference.draft.joints():
        other = difference.draft.joint_of(_other_side(end_of(joint, "child")))
        if other is not None and other is not joint:
            edits = _exchange_ends(difference.draft, (joint, "child"), (other, "child"))
            found.append(difference.piece(joint, "the children of two joints are exchanged", edits))
    return found


def _exchange_ends(draft: Draft, *ends: tuple[Element, str]) -> Edits:
    elements = [child_of(joint, role) for joint, role in ends]
    return draft.exchange(*[it for it in elements if it is not None], attribute="link")


def _other_side(link: str) -> str:
    """Return the name of the link at the other side; the same name if it has no side."""
    return _WORD.sub(lambda word: _SIDES.get(word[0], word[0]), link)


def in_another_unit(difference: RobotDifference) -> Iterator[Piece]:
    """Yield all lengths in metres, for a robot of which they are all in centimetres or
    millimetres.
    """
    found: list[tuple[Element, str, Values]] = []
    for element in difference.draft.root.iter():
        if element.tag not in TAGS:
            continue
        for name, known in TAGS[str(element.tag)].attributes.items():
            values = values_of(element.get(name)) if known.unit == "m" else ()
            if any(values):
                found.append((element, name, values))
    if not any(max(values) >= LARGE for element, _, values in found if element.tag != "origin"):
        return
    for factor, unit in ((100.0, "centimetres"), (1000.0, "millimetres")):
        metres = [
            (it, name, tuple(value / factor for value in values)) for it, name, values in found
        ]
        sets = tuple(Set(it, "", name, format_numbers(values)) for it, name, values in metres)
        cause = f"the unit of all lengths: {unit}, not metres"
        yield Piece(cause, "", sets, (), OWN)


def whole_links(difference: RobotDifference) -> Iterator[Piece]:
    """Yield where each link and what it shows are, also with what it carries; and all its
    values.
    """
    links: dict[str, list[Set]] = {}
    for piece in difference.pieces:
        own = links.setdefault(piece.link, [])
        own += [one for one in piece.sets if one not in own and one.attribute != "name"]
    for link, sets in links.items():
        if link not in difference.known:
            continue
        poses = [
            one
            for one in sets
            if "origin" in (one.tag, one.owner.tag) or "axis" in (one.tag, one.owner.tag)
        ]
        carried = {joint for joint in difference.draft.joints() if end_of(joint, "parent") == link}
        after = [
            one
            for own in links.values()
            for one in own
            if not carried.isdisjoint((one.owner, one.owner.getparent()))
        ]
        yield from _group(difference, link, poses, _FRAME.format(link))
        yield from _group(difference, link, poses + after, f"{_FRAME} and carries".format(link))
        yield from _group(difference, link, sets, f"the values of {link!r}")


def _group(difference: RobotDifference, link: str, sets: list[Set], what: str) -> Iterator[Piece]:
    changed = {(one.owner, one.tag): one for one in sets}
    if len(changed) < 2:
        return
    if len(changed) == len(sets) <= _MAX_NAMED:
        what = " and ".join(difference.of_sets([one]).cause for one in changed.values())
    yield Piece(what, link, tuple(dict.fromkeys(sets)), (), STRUCTURE)


def whole_elements(difference: RobotDifference) -> Iterator[Piece]:
    """Yield the changes in one element together, and in one child of the robot; of links and joints
    no values.
    """
    for is_owner in (False, True):
        groups: dict[Element, list[Piece]] = {}
        for piece in difference.pieces:
            if piece.around is not None:
                owner = difference.draft.owner(piece.around)
            else:
                owner = difference.draft.root
            has_values = owner.tag in ("link", "joint", "material", "robot")
            is_removed = not piece.sets and not any(edit.new for edit in piece.edits)
            if piece.around is not None and not is_removed and (piece.edits or not has_values):
                groups.setdefault(owner if is_owner else piece.around, []).append(piece)
        for pieces in (
            those for element, those in groups.items() if element is not difference.draft.root
        ):
            cause = " and ".join(dict.fromkeys(piece.cause for piece in pieces))
            edits = tuple(edit for piece in pieces for edit in piece.edits)
            sets = tuple(one for piece in pieces for one in piece.sets)
            if len(pieces) > 1:
                yield Piece(cause, pieces[0].link, sets, edits, STRUCTURE)
