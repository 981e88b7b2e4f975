"""Edits of the mass, the inertia and the collision shapes of a link: those of a uniform solid of its shapes, as it is shown."""

from collections.abc import Iterator, Mapping

from grader.edits import KNOWN, Proposal
from grader.robot.edits.draft import Draft, Edits, child_of
from grader.robot.frames import placed_by
from grader.robot.inertia import MassProperties, turned, uniform_solid, with_volume
from grader.robot.model import Link, Mesh
from grader.robot.shapes import is_empty
from grader.robot.transforms import IDENTITY
from grader.xml.parsing import Element

_INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def body_proposals(draft: Draft, link: str, mass: float | None) -> Iterator[Proposal]:
    """Yield edits of what a link weighs and what it collides with; `mass` is the expected one in kg, if a criterion gives it."""
    own = draft.link(link)
    if own is not None and draft.robot.has_link(link):
        yield from _inertial(draft, own, draft.robot.link(link), mass)
        yield from _collisions(draft, own, draft.robot.link(link))


def _inertial(draft: Draft, own: Element, link: Link, mass: float | None) -> Iterator[Proposal]:
    """Correct the mass, the inertia, the centre of mass or all: an inertia for another shape, an <inertial> without origin."""
    of, inertial, element = f"the link {link.name!r}", link.inertial, child_of(own, "inertial")
    weighs = mass if mass is not None else inertial.mass if inertial is not None else None
    solid = _solid(link, weighs) if weighs is not None and weighs > 0.0 else None
    if element is None:
        if solid is not None:
            text = _written(solid)
            yield Proposal(draft.insert(own, text), "the <inertial>{} is missing", "add an <inertial>{}", of, link.name)
        return
    if inertial is None:
        return
    of_mass: Edits = ()
    if mass is not None and mass != inertial.mass:
        of_mass = _set(draft, element, "mass", {"value": f"{mass:.6g}"})
        yield Proposal(of_mass, "the mass", f"set the mass{{}} to {mass:.6g} kg", of, link.name, KNOWN)
    if solid is None:
        return
    T_link_inertial = placed_by(IDENTITY, inertial.origin)
    values = turned(solid.inertia, T_link_inertial.inverse().rotation)
    of_inertia = _set(draft, element, "inertia", dict(zip(_INERTIA, map(_number, values), strict=True)))
    centre = {"xyz": " ".join(map(_number, solid.centre))}
    of_centre = _set(draft, element, "origin", centre)
    yield Proposal(of_inertia, "the inertia", "set the inertia{} to that of its shapes", of, link.name, KNOWN)
    yield Proposal(
        of_centre, "the centre of mass", "set the centre of mass{} to that of its shapes", of, link.name, KNOWN
    )
    for edits, what in (
        (of_mass + of_inertia, "mass and inertia"),
        (of_inertia + of_centre, "inertia and centre of mass"),
    ):
        yield Proposal(edits, what, f"set {what}{{}} to those of its shapes", of, link.name, KNOWN)


def _solid(link: Link, mass: float) -> MassProperties | None:
    """Return the uniform solid of the shapes of a link; None for a mesh and for a link without a volume."""
    placed = with_volume(link.collisions) or with_volume(link.visuals)
    shapes = [(shape, placed_by(IDENTITY, origin)) for shape, origin in placed if not isinstance(shape, Mesh)]
    try:
        return uniform_solid(shapes, mass) if len(shapes) == len(placed) else None
    except ValueError:
        return None


def _collisions(draft: Draft, own: Element, link: Link) -> Iterator[Proposal]:
    """Make the collision shapes those that are shown: forgotten, in another place, of another size, or too many."""
    of = f"the link {link.name!r}"
    visuals, collisions = list(own.iterchildren("visual")), list(own.iterchildren("collision"))
    shown = [visual for visual, read in zip(visuals, link.visuals, strict=False) if not is_empty(read.geometry)]
    texts = [_as_collision(draft, visual) for visual in shown]
    if shown and not collisions:
        added = draft.insert(own, "\n".join(texts))
        yield Proposal(added, "the <collision>{} is missing", "add a <collision>{} like the visual", of, link.name)
        return
    for collision, visual, text in zip(collisions, shown, texts, strict=False):
        for tag, what in (("origin", "the origin of the collision"), ("geometry", "the geometry of the collision")):
            edits = _like(draft, collision, visual, tag)
            yield Proposal(edits, what, f"make {what} that of the visual{{}}", of, link.name, KNOWN)
        replaced = draft.replace(collision, text)
        yield Proposal(replaced, "the collision", "make the collision{} like the visual", of, link.name, KNOWN)
    for extra in collisions[len(shown) :]:
        yield Proposal(
            draft.remove(extra), "a collision{} that is not shown", "remove a collision{}", of, link.name, KNOWN
        )


def _like(draft: Draft, collision: Element, visual: Element, tag: str) -> Edits:
    """Return the edit that gives a collision a child as the visual has it."""
    mine, other = child_of(collision, tag), child_of(visual, tag)
    if other is None:
        return draft.remove(mine) if mine is not None else ()
    text = draft.text(other)
    return draft.replace(mine, text) if mine is not None else draft.insert(collision, text)


def _as_collision(draft: Draft, visual: Element) -> str:
    parts = (child_of(visual, tag) for tag in ("origin", "geometry"))
    inside = "\n".join(f"  {draft.text(part)}" for part in parts if part is not None)
    return f"<collision>\n{inside}\n</collision>"


def _set(draft: Draft, owner: Element, tag: str, values: Mapping[str, str]) -> Edits:
    """Return the edits that set attributes of a child, which is inserted where it is missing."""
    child = child_of(owner, tag)
    if child is None:
        return draft.insert(owner, f"<{tag} {_attributes(values)}/>")
    edits: Edits = ()
    for name, text in values.items():
        ways = draft.write(child, name, text) if not _is_same(child.get(name), text) else []
        edits += ways[0] if ways else ()
    return edits


def _is_same(old: str | None, new: str) -> bool:
    """Return whether an attribute has these numbers already, however they are written."""
    try:
        return old is not None and [float(word) for word in old.split()] == [float(word) for word in new.split()]
    except ValueError:
        return False


def _written(solid: MassProperties) -> str:
    """Return the <inertial> of a solid."""
    values = _attributes(dict(zip(_INERTIA, map(_number, solid.inertia), strict=True)))
    centre = " ".join(map(_number, solid.centre))
    return f'<inertial>\n  <origin xyz="{centre}"/>\n  <mass value="{solid.mass:.6g}"/>\n  <inertia {values}/>\n</inertial>'


def _attributes(values: Mapping[str, str]) -> str:
    return " ".join(f'{name}="{text}"' for name, text in values.items())


def _number(value: float) -> str:
    """Return a number as a URDF contains it; what is 0 but for rounding is 0."""
    return f"{value:.6g}" if abs(value) > 1e-15 else "0"
