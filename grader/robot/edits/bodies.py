"""Edits of the mass, the inertia and the collision shapes of a link: those of a uniform solid of its visible shapes.

The checks of bodies suggest them, because no number that they measure leads there: a rubric without a reference
solution needs them.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from grader.robot.edits.difference import RobotDifference
from grader.robot.edits.draft import empty_element
from grader.robot.edits.elements import Set, child_of
from grader.robot.edits.numbers import format_number
from grader.robot.edits.pieces import KNOWN, Piece
from grader.robot.frames import placed_by
from grader.robot.inertia import MassProperties, turned, uniform_solid, with_volume
from grader.robot.model import INERTIA, Link, Mesh
from grader.robot.shapes import is_empty
from grader.robot.transforms import IDENTITY
from grader.source import Edits
from grader.xml.parsing import Element


def body_pieces(difference: RobotDifference, arguments: Mapping[str, Any]) -> Iterator[Piece]:
    """Yield edits of what a link weighs and what it collides with; the arguments may give the expected mass in kg."""
    name = arguments["link"]
    own = difference.draft.link(name)
    if own is not None and difference.draft.robot.has_link(name):
        link = difference.draft.robot.link(name)
        yield from _inertial(difference, own, link, arguments.get("mass"))
        yield from _collisions(difference, own, link)


def _inertial(difference: RobotDifference, own: Element, link: Link, mass: float | None) -> Iterator[Piece]:
    """Correct the inertia, the centre of mass or both: an inertia for another shape, an <inertial> without origin."""
    element, inertial = child_of(own, "inertial"), link.inertial
    weighs = mass if mass is not None else inertial.mass if inertial is not None else None
    solid = _solid(link, weighs) if weighs is not None and weighs > 0.0 else None
    if solid is None:
        return
    centre = " ".join(map(format_number, solid.centre))
    if element is None or inertial is None:  # ROS 2 drops what a link shows with an <inertial> that it cannot read
        values = empty_element("inertia", dict(zip(INERTIA, map(format_number, solid.inertia), strict=True)))
        text = f'<inertial>\n  <origin xyz="{centre}"/>\n  <mass value="{solid.mass:.6g}"/>\n  {values}\n</inertial>'
        edits = difference.draft.insert(own, text)
        yield difference.piece(own, "the <inertial> of {} is missing", "add the <inertial> of {}", edits)
    else:
        T_link_inertial = placed_by(IDENTITY, inertial.origin)
        moments = turned(solid.inertia, T_link_inertial.inverse().rotation)
        known = zip(INERTIA, moments, inertial.inertia, strict=True)
        of_inertia = tuple(
            Set(element, "inertia", name, format_number(value)) for name, value, old in known if value != old
        )
        of_centre = (Set(element, "origin", "xyz", centre),)
        of_mass = (Set(element, "mass", "value", f"{mass:.6g}"),) if mass not in (None, inertial.mass) else ()
        for sets, what in (
            (of_mass, "the mass"),
            (of_inertia, "the inertia"),
            (of_centre, "the centre of mass"),
            ((*of_mass, *of_inertia), "mass and inertia"),
            ((*of_inertia, *of_centre), "inertia and centre of mass"),
        ):
            action = f"set {what} of {{}} to that of its shapes"
            if sets:
                yield difference.piece(own, f"{what} of {{}}", action, sets=sets)


def _solid(link: Link, mass: float) -> MassProperties | None:
    """Return the uniform solid of the shapes of a link; None for a mesh and for a link without a volume."""
    placed = with_volume(link.collisions) or with_volume(link.visuals)
    shapes = [(shape, placed_by(IDENTITY, origin)) for shape, origin in placed if not isinstance(shape, Mesh)]
    try:
        return uniform_solid(shapes, mass) if len(shapes) == len(placed) else None
    except ValueError:
        return None


def _collisions(difference: RobotDifference, own: Element, link: Link) -> Iterator[Piece]:
    """Make the collision shapes those that are shown: forgotten, in another place, of another size, or too many."""
    draft = difference.draft
    visuals, collisions = list(own.iterchildren("visual")), list(own.iterchildren("collision"))
    shown = [visual for visual, read in zip(visuals, link.visuals, strict=False) if not is_empty(read.geometry)]
    texts = [_as_collision(difference, visual) for visual in shown]
    if shown and not collisions:
        edits = draft.insert(own, "\n".join(texts))
        yield difference.piece(
            own, "the <collision> of {} is missing", "add a <collision> of {} like the visual", edits
        )
        return
    for collision, visual, text in zip(collisions, shown, texts, strict=False):
        for tag in ("origin", "geometry"):
            cause = f"the collision {tag} of {{}}"
            yield difference.piece(
                own, cause, f"make {cause} that of the visual", _like(difference, collision, visual, tag)
            )
        replaced = draft.replace(collision, text)
        yield difference.piece(own, "the collision of {}", "make the collision of {} like the visual", replaced)
    for extra in collisions[len(shown) :]:
        cause = "a collision of {} that is not shown"
        yield difference.piece(own, cause, "remove a collision of {}", draft.remove(extra), rank=KNOWN)


def _like(difference: RobotDifference, collision: Element, visual: Element, tag: str) -> Edits:
    """Return the edit that gives a collision a child as the visual has it."""
    draft, mine, other = difference.draft, child_of(collision, tag), child_of(visual, tag)
    if other is None:
        return draft.remove(mine) if mine is not None else ()
    text = draft.text(other)
    return draft.replace(mine, text) if mine is not None else draft.insert(collision, text)


def _as_collision(difference: RobotDifference, visual: Element) -> str:
    parts = (child_of(visual, tag) for tag in ("origin", "geometry"))
    inside = "\n".join(f"  {difference.draft.text(part)}" for part in parts if part is not None)
    return f"<collision>\n{inside}\n</collision>"
