"""Conventions of a whole robot: its base frame elsewhere or turned, and another unit of length, with all else consistent."""

from collections.abc import Iterator
from math import pi

from grader.robot.edits.difference import Difference
from grader.robot.edits.draft import Draft, Set, child_of, end_of
from grader.robot.edits.numbers import Values, values_of, written
from grader.robot.edits.pieces import CONVENTION, Piece
from grader.robot.frames import placed_by
from grader.robot.model import Box, Origin
from grader.robot.transforms import IDENTITY, Transform, rotation_from_rpy
from grader.xml.parsing import Element
from grader.xml.urdf_format import TAGS

_LARGE = 3.0  # metres: no shape of a robot for a desk is as large


def conventions(difference: Difference) -> Iterator[Piece]:
    """Yield the pieces that change a convention everywhere."""
    yield from _other_units(difference)
    draft = difference.draft
    for link in draft.robot.links:
        joints = [joint for joint in draft.robot.joints if joint.parent == link.name]
        if len(joints) < 2 or not difference.reference.robot.has_link(link.name):
            continue
        turns = ((0.0, 0.0, -pi / 2), (0.0, 0.0, pi / 2), (0.0, 0.0, pi))
        lifts = [shape.geometry.size[2] / 2 for shape in link.visuals[:1] if isinstance(shape.geometry, Box)]
        for moved in (
            *(Transform(rotation_from_rpy(turn)) for turn in turns),
            *(_lifted(sign * lift) for lift in lifts for sign in (1, -1)),
        ):
            is_turn = moved.translation == (0.0, 0.0, 0.0)
            what = "the directions of x and y" if is_turn else "the origin"
            own = draft.joint_of(link.name)
            before = _placed(own, IDENTITY, moved.inverse()) if own is not None and not is_turn else ()
            sets = (*before, *_moved(draft, link.name, moved))
            yield Piece(
                f"{what} of the frame {link.name!r}",
                f"correct {what} of the frame {link.name!r}",
                "",
                sets,
                (),
                CONVENTION,
            )


def other_frames(difference: Difference) -> Iterator[Piece]:
    """Yield the pieces with which the frame of a link is where the reference has it, and all that is in it stays where it is."""
    draft = difference.draft
    for link in draft.robot.links:
        joint, other = draft.joint_of(link.name), difference.reference.joint_of(link.name)
        if joint is None or other is None:
            continue
        old, new = (
            Transform(rotation_from_rpy(_values(child_of(it, "origin"), "rpy")), _values(child_of(it, "origin"), "xyz"))
            for it in (joint, other)
        )
        for wanted in (new, Transform(new.rotation, old.translation), Transform(old.rotation, new.translation)):
            T_new_old = wanted.inverse() @ old
            sets = [
                Set(joint, "origin", name, written(value))
                for name, value, before in (("xyz", wanted.translation, old.translation), ("rpy", wanted.rpy, old.rpy))
                if _differ(value, before)
            ]
            axis = child_of(joint, "axis")
            direction = (values_of(axis.get("xyz")) if axis is not None else ()) or (1.0, 0.0, 0.0)
            turned = T_new_old.rotate((direction[0], direction[1], direction[2])) if len(direction) == 3 else direction
            if joint.get("type") != "fixed" and _differ(turned, direction):
                sets.append(Set(joint, "axis", "xyz", written(tuple(round(value, 4) + 0.0 for value in turned))))
            moved = [*_moved(draft, link.name, T_new_old)]
            if sets and moved:
                yield difference.piece(
                    joint,
                    f"the frame {link.name!r}",
                    f"correct the frame {link.name!r}; what it shows stays where it is",
                    sets=(*sets, *moved),
                    rank=CONVENTION,
                )


def _differ(one: Values, other: Values) -> bool:
    return any(abs(a - b) > 1e-3 for a, b in zip(one, other, strict=True))


def _lifted(height: float) -> Transform:
    return Transform(translation=(0.0, 0.0, height))


def _moved(draft: Draft, link: str, T_new_old: Transform) -> Iterator[Set]:
    """Yield the values with which the frame of a link is moved, and all that is in it stays together."""
    own = draft.link(link)
    for part in own if own is not None else ():
        if part.tag in ("visual", "collision", "inertial"):
            yield from _placed(part, T_new_old)
    for joint in draft.joints():
        if end_of(joint, "parent") == link:
            yield from _placed(joint, T_new_old)


def _placed(owner: Element, T_new_old: Transform, T_old_new: Transform = IDENTITY) -> Iterator[Set]:
    found = child_of(owner, "origin")
    old = Origin(_values(found, "xyz"), _values(found, "rpy"))
    pose = placed_by(T_new_old, old) @ T_old_new
    for name, before, after in (("xyz", old.xyz, pose.translation), ("rpy", old.rpy, pose.rpy)):
        if _differ(before, after):
            yield Set(owner, "origin", name, written(tuple(round(value, 4) + 0.0 for value in after)))


def _values(element: Element | None, name: str) -> tuple[float, float, float]:
    values = values_of(element.get(name)) if element is not None else ()
    return (values[0], values[1], values[2]) if len(values) == 3 else (0.0, 0.0, 0.0)


def _other_units(difference: Difference) -> Iterator[Piece]:
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
        sets = tuple(
            Set(element, "", name, written(tuple(value / factor for value in values)))
            for element, name, values in found
        )
        yield Piece(
            f"the unit of all lengths: {unit}, not metres", "convert all lengths to metres", "", sets, (), CONVENTION
        )
