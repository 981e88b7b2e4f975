"""Repairs of materials: a name that is not defined, a definition without a colour."""

from collections.abc import Iterator

from grader.edits import Proposal
from grader.names import closest
from grader.robot.edits.families import written
from grader.robot.model import Material
from grader.robot.repairs.elements import attribute_repairs, child_repairs
from grader.robot.repairs.site import Site

_GRAY = (0.5, 0.5, 0.5, 1.0)


def material_repairs(site: Site) -> Iterator[Proposal]:
    """Name a material that is defined, or define it under the robot."""
    name = site.element.get("name") or ""
    defined = [found.get("name") or "" for found in site.draft.root.iter("material") if len(found)]
    wanted = _wanted(site)
    alike = [known.name for known in site.draft.robot.materials if wanted is not None and known.rgba == wanted.rgba]
    near = closest(name, defined)
    for other in dict.fromkeys([*([near] if near else []), *alike]):
        yield from site.set(site.element, "name", other, "the name of the material", "correct the name of the material")
    moved = site.draft.material(name)
    colour = moved.find("color") if moved is not None else None
    rgba = (colour.get("rgba") if colour is not None else None) or written(wanted.rgba if wanted else _GRAY)
    xml = f'<material name="{name}">\n  <color rgba="{rgba}"/>\n</material>'
    cause = "a material that is not defined under <robot>"
    yield Proposal(site.draft.insert(site.draft.root, xml), cause, "define the material under <robot>", "", site.link)


def colour_repairs(site: Site) -> Iterator[Proposal]:
    """Give a material under the robot a colour."""
    yield from child_repairs(site, "color")
    colour = site.element.find("color")
    if colour is not None:
        yield from attribute_repairs(Site(site.robots, colour, None))
    else:
        wanted = _wanted(site)
        xml = f'<color rgba="{written(wanted.rgba if wanted else _GRAY)}"/>'
        yield site.propose(site.draft.insert(site.element, xml), "the colour is missing", "add the colour")


def _wanted(site: Site) -> Material | None:
    """Return the material that the reference shows where this one is used."""
    robot = site.robots.reference.robot
    name = site.element.get("name")
    if site.owner.tag == "link" and robot.has_link(site.link):
        return next((visual.material for visual in robot.link(site.link).visuals if visual.material), None)
    return next((material for material in robot.materials if material.name == name), None)
