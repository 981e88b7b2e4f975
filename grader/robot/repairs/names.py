"""Repairs of names and types: duplicates, a joint without a name, a misspelt type, a revolute joint without limits."""

from collections.abc import Iterator

from grader.edits import Proposal
from grader.names import closest
from grader.robot.repairs.elements import child_repairs
from grader.robot.repairs.site import Site
from grader.xml.parsing import Element
from grader.xml.urdf_format import JOINT_TYPES

_MAX_NAMES = 4
_NEEDS_LIMIT = ("revolute", "prismatic")
_USUAL = ("origin", "parent", "child", "axis")  # children of a joint that are no misspelt limit


def duplicate_repairs(site: Site) -> Iterator[Proposal]:
    """Remove or rename one of two elements with one name: pasted twice, or pasted and not renamed."""
    element, tag = site.element, str(site.element.tag)
    name = element.get("name")
    same = [other for other in site.draft.root.iterchildren(tag) if other.get("name") == name]
    first = next((other for other in same if other is not element), element)
    is_copy = _content(first) == _content(element)
    removals = [_removed(site, other) for other in (element, first)]
    renames = [
        site.propose(edits, f"a duplicate {tag} name", _copy("rename", tag))
        for other in (element, first)
        for new in _other_names(site, other)
        for edits in site.draft.set(other, "name", new)
    ]
    yield from (*removals, *renames) if is_copy else (*renames, *removals)


def _removed(site: Site, element: Element) -> Proposal:
    cause = f"a duplicate {element.tag}"
    return site.propose(site.draft.remove(element), cause, _copy("remove", str(element.tag)))


def _copy(verb: str, tag: str) -> str:
    return f"{verb} one copy" if tag != "material" else f"{verb} one copy of the material"


def _other_names(site: Site, element: Element, tag: str = "") -> list[str]:
    tag = tag or str(element.tag)
    if tag == "link":
        return site.robots.unused_links()[:_MAX_NAMES]
    if tag == "joint":
        return site.robots.unused_joints(element)
    known = {material.get("name") for material in site.draft.root.iterchildren("material")}
    used = dict.fromkeys(found.get("name") or "" for found in site.draft.root.iter("material"))
    return [name for name in used if name and name not in known][:_MAX_NAMES]


def _content(element: Element) -> list[tuple[str, dict[str, str]]]:
    return [(str(inner.tag), {str(key): str(value) for key, value in inner.attrib.items()}) for inner in element.iter()]


def name_repairs(site: Site) -> Iterator[Proposal]:
    """Give a robot, link, joint or material the name that it needs."""
    element, tag = site.element, str(site.element.tag)
    match tag:
        case "robot":
            names = [site.robots.reference.root.get("name") or "robot"]
        case "link":
            names = site.robots.unused_links()[:_MAX_NAMES]
        case "joint":
            names = site.robots.unused_joints(element)
        case _:
            names = _other_names(site, element, "material") or ["material"]
    for name in names:
        edits = site.draft.add_attributes(element, {"name": name})
        yield site.propose(edits, f"the name of the {tag} is missing", f"name the {tag}")


def type_repairs(site: Site) -> Iterator[Proposal]:
    """Correct the type of a joint, or give it one."""
    element = site.element
    own = (element.get("type") or "").strip()
    like = site.like.get("type") if site.like is not None else None
    near = own.lower() if own.lower() in JOINT_TYPES else closest(own, JOINT_TYPES)
    for wanted in dict.fromkeys(found for found in (near, like, "fixed") if found):
        yield from site.set(element, "type", wanted, "the type of the joint", f"set the type to {wanted}")


def limit_repairs(site: Site) -> Iterator[Proposal]:
    """Make a joint without limits one that needs none, or give it limits."""
    like = site.like.get("type") if site.like is not None else None
    if any(child.tag not in _USUAL for child in site.element):
        yield from child_repairs(site, "limit")
    for wanted in dict.fromkeys(found for found in (like, "continuous") if found and found not in _NEEDS_LIMIT):
        yield from site.set(site.element, "type", wanted, "the type of the joint", f"set the type to {wanted}")
    yield from child_repairs(site, "limit")
