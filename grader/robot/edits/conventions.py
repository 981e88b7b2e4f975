"""Conventions of a whole robot: its base frame elsewhere or rotated, or another unit of length, all consistently."""

from collections.abc import Iterator
from math import pi

from grader.robot.edits.difference import RobotDifference
from grader.robot.edits.draft import Draft
from grader.robot.edits.elements import Set, child_of, end_of
from grader.robot.edits.numbers import Values, format_numbers, round_numbers, values_of
from grader.robot.edits.pieces import CONVENTION, Piece
from grader.robot.model import Box
from grader.robot.transforms import IDENTITY, Transform, rotation_from_rpy
from grader.xml.parsing import Element
from grader.xml.urdf_format import TAGS

_LARGE = 3.0  # metres: no shape of a robot for a desk is as large


def conventions(difference: RobotDifference) -> Iterator[Piece]:
    """Yield the pieces that change a convention everywhere."""
    yield from _other_units(difference)
    draft = difference.draft
    for link in draft.robot.links:
        is_base = sum(joint.parent == link.name for joint in draft.robot.joints) > 1
        if is_base and difference.reference.robot.has_link(link.name):
            lifts = [shape.geometry.size[2] / 2 for shape in link.visuals[:1] if isinstance(shape.geometry, Box)]
            turns = (Transform(rotation_from_rpy((0.0, 0.0, yaw))) for yaw in (-pi / 2, pi / 2, pi))
            yield from (_whole(draft, link.name, "the directions of x and y", turn) for turn in turns)
            for height in (sign * lift for lift in lifts for sign in (1, -1)):
                yield _whole(draft, link.name, "the origin", Transform(translation=(0.0, 0.0, height)))


def _whole(draft: Draft, link: str, what: str, T_new_old: Transform) -> Piece:
    """Return the piece that moves a link's frame, but nothing that is seen; a rotated frame turns the robot with it."""
    own = draft.joint_of(link) if T_new_old.rotation == IDENTITY.rotation else None
    before = _place(own, IDENTITY, T_new_old.inverse()) if own is not None else ()
    cause = f"{what} of the frame {link!r}"
    return Piece(cause, f"correct {cause}", "", (*before, *_move(draft, link, T_new_old)), (), CONVENTION)


def other_frames(difference: RobotDifference) -> Iterator[Piece]:
    """Yield the pieces that put the frame of a link where the reference has it; all that is in it stays where it is."""
    draft = difference.draft
    for link in draft.robot.links:
        joint, other = draft.joint_of(link.name), difference.reference.joint_of(link.name)
        if joint is None or other is None:
            continue
        old, new = _pose(joint), _pose(other)
        for wanted in (new, Transform(new.rotation, old.translation), Transform(old.rotation, new.translation)):
            T_new_old = wanted.inverse() @ old
            sets = [*_set(joint, old, wanted)]
            axis = child_of(joint, "axis")
            direction = _values(axis, "xyz") if axis is not None else (1.0, 0.0, 0.0)
            turned = T_new_old.rotate(direction)
            if joint.get("type") != "fixed" and _differ(turned, direction):
                sets.append(Set(joint, "axis", "xyz", format_numbers(round_numbers(turned, 4))))
            moved = [*_move(draft, link.name, T_new_old)]
            if sets and moved:
                cause, action = "the frame {!r}", "correct the frame {!r}; what it shows stays where it is"
                texts = cause.format(link.name), action.format(link.name)
                yield difference.piece(joint, *texts, sets=(*sets, *moved), rank=CONVENTION)


def _differ(one: Values, other: Values) -> bool:
    return any(abs(a - b) > 1e-3 for a, b in zip(one, other, strict=True))


def _move(draft: Draft, link: str, T_new_old: Transform) -> Iterator[Set]:
    """Yield the values with which the frame of a link is moved, and all that is in it stays together."""
    own = draft.link(link)
    parts = own.iterchildren("visual", "collision", "inertial") if own is not None else ()
    for part in (*parts, *(joint for joint in draft.joints() if end_of(joint, "parent") == link)):
        yield from _place(part, T_new_old)


def _place(owner: Element, T_new_old: Transform, T_old_new: Transform = IDENTITY) -> Iterator[Set]:
    old = _pose(owner)
    return _set(owner, old, T_new_old @ old @ T_old_new)


def _set(owner: Element, old: Transform, new: Transform) -> Iterator[Set]:
    for name, before, after in (("xyz", old.translation, new.translation), ("rpy", old.rpy, new.rpy)):
        if _differ(before, after):
            yield Set(owner, "origin", name, format_numbers(round_numbers(after, 4)))


def _pose(owner: Element) -> Transform:
    found = child_of(owner, "origin")
    return Transform(rotation_from_rpy(_values(found, "rpy")), _values(found, "xyz"))


def _values(element: Element | None, name: str) -> tuple[float, float, float]:
    values = values_of(element.get(name)) if element is not None else ()
    return (values[0], values[1], values[2]) if len(values) == 3 else (0.0, 0.0, 0.0)


def _other_units(difference: RobotDifference) -> Iterator[Piece]:
    """Convert all lengths to metres: a robot in centimetres or millimetres."""
    found: list[tuple[Element, str, Values]] = []
    for element in difference.draft.root.iter():
        for name, known in TAGS[str(element.tag)].attributes.items() if element.tag in TAGS else ():
            values = values_of(element.get(name)) if known.unit == "m" else ()
            if any(values):
                found.append((element, name, values))
    if not any(value >= _LARGE for element, _, values in found for value in values if element.tag != "origin"):
        return
    for factor, unit in ((100.0, "centimetres"), (1000.0, "millimetres")):
        metres = [
            (element, name, format_numbers(tuple(value / factor for value in values)))
            for element, name, values in found
        ]
        sets = tuple(Set(element, "", name, value) for element, name, value in metres)
        cause = f"the unit of all lengths: {unit}, not metres"
        yield Piece(cause, "convert all lengths to metres", "", sets, (), CONVENTION)
