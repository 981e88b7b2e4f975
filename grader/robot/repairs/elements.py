"""Repairs of an element: a number that cannot be read, an attribute or child that is missing, a misspelt name."""

from collections.abc import Iterator

from grader.edits import Proposal
from grader.names import closest
from grader.robot.edits.draft import Edits, child_of
from grader.robot.repairs.numbers import COUNTS, is_readable, readable, with_count
from grader.robot.repairs.site import Robots, Site
from grader.xml.parsing import Element
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN, TAGS

REQUIRED = {
    "robot": ("name",),
    "link": ("name",),
    "joint": ("name", "type"),
    "material": ("name",),
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
    "mesh": ("filename",),
    "mass": ("value",),
    "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
    "limit": ("effort", "velocity"),
    "parent": ("link",),
    "child": ("link",),
    "mimic": ("joint",),
    "safety_controller": ("k_velocity",),
    "color": ("rgba",),
    "texture": ("filename",),
}
_DEFAULTS = {
    "effort": "10",
    "velocity": "1",
    "k_velocity": "1",
    "lower": "-1.57",
    "upper": "1.57",
    "value": "1",
    **dict.fromkeys(("ixx", "iyy", "izz"), "0.001"),
    **dict.fromkeys(("ixy", "ixz", "iyz"), "0"),
}
_DEFAULT_CHILDREN = {
    "mass": '<mass value="1"/>',
    "inertia": '<inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/>',
    "limit": '<limit lower="-1.57" upper="1.57" effort="10" velocity="1"/>',
}
_SHAPES = CHILDREN["geometry"]


def value_repairs(site: Site) -> Iterator[Proposal]:
    """Write numbers as ROS 2 reads them, here and wherever the mistake is the same; else as the reference has them."""
    attribute = site.attribute
    if attribute is None or is_readable(attribute, site.element.get(attribute) or ""):
        return
    for found in readable(attribute, site.element.get(attribute) or ""):
        edits = _everywhere(site.robots, found.cause)
        own = site.draft.write(site.element, attribute, found.text)[0]
        if len(edits) > 1 and set(own) <= set(edits):
            yield Proposal(edits, found.cause, found.action)
        yield site.propose(own, found.cause, f"{found.action} in {attribute}")
    wanted = _given(site, attribute)
    if wanted is not None:
        yield from site.set(
            site.element, attribute, wanted, f"the numbers of {attribute}", f"set {attribute} to {wanted}"
        )
    for text in with_count(attribute, site.element.get(attribute) or ""):
        count = COUNTS.get(attribute, 1)
        yield from site.set(
            site.element,
            attribute,
            text,
            f"the count of numbers in {attribute}",
            f"write {count} numbers in {attribute}",
        )


def _everywhere(robots: Robots, cause: str) -> Edits:
    """Return the edits of all attributes that have the same mistake."""
    edits: dict[object, None] = {}
    for element in robots.draft.root.iter():
        for attribute in ATTRIBUTES.get(str(element.tag), ()):
            text = element.get(attribute)
            if text is None or is_readable(attribute, text):
                continue
            found = next(iter(readable(attribute, text)), None)
            if found is not None and found.cause == cause:
                edits |= dict.fromkeys(robots.draft.write(element, attribute, found.text)[0])
    return tuple(edits)  # type: ignore[arg-type]


def attribute_repairs(site: Site) -> Iterator[Proposal]:
    """Rename or add the attributes that an element needs: height for length, a limit without effort."""
    element, tag = site.element, str(site.element.tag)
    missing = [name for name in REQUIRED.get(tag, ()) if element.get(name) is None]
    if not missing:
        return
    unknown = [name for name in map(str, element.keys()) if name not in ATTRIBUTES.get(tag, ())]
    for name in unknown:
        meant = TAGS[tag].aliases.get(name) or closest(name, missing)
        for wanted in [meant] if meant in missing else missing:
            yield site.propose(site.draft.rename_attribute(element, name, wanted), *_misspelt(f"attribute {wanted}"))
    given = {name: _given(site, name) for name in missing}
    values = {name: value for name, value in given.items() if value is not None}
    if values:
        names = " and ".join(values)
        yield site.propose(
            site.draft.add_attributes(element, values),
            f"<{tag}> has no {names}",
            f"add {names} to <{tag}>",
        )


def _given(site: Site, name: str) -> str | None:
    like = site.like.get(name) if site.like is not None else None
    return like if like is not None else _DEFAULTS.get(name)


def child_repairs(site: Site, tag: str) -> Iterator[Proposal]:
    """Rename or add a child that an element needs: a visual without geometry, a revolute joint without limit."""
    element = site.element
    if child_of(element, tag) is not None:
        return
    for child in element:
        if child.tag not in ATTRIBUTES and (closest(str(child.tag), [tag]) or str(child.tag).lower() == tag):
            yield site.propose(site.draft.rename_tag(child, tag), *_misspelt(f"tag <{tag}>"))
    if tag == "geometry":
        for child in element:
            if child.tag in _SHAPES:
                yield site.propose(site.draft.wrap(child, tag), "a shape outside <geometry>", "put it into <geometry>")
    like = child_of(site.like, tag) if site.like is not None else None
    xml = site.robots.reference.text(like) if like is not None else _DEFAULT_CHILDREN.get(tag)
    if xml is not None:
        yield site.propose(site.draft.insert(element, xml), f"the <{tag}> is missing", f"add the <{tag}>")


def shape_repairs(site: Site) -> Iterator[Proposal]:
    """Name a shape as ROS 2 does, or add it: <cilinder>, <Box>, an empty <geometry>."""
    element = site.element
    geometry = child_of(element, "geometry") if element.tag in ("visual", "collision") else element
    if geometry is None or geometry.tag != "geometry":
        parent = element.getparent()
        geometry = parent if parent is not None and parent.tag == "geometry" else None
    if geometry is None:
        return
    for shape in geometry:
        if shape.tag in _SHAPES:
            continue
        for name in _meant(shape):
            yield site.propose(site.draft.rename_tag(shape, name), *_misspelt(f"tag <{name}>"))
    inner = Site(site.robots, geometry, None)
    if not len(geometry) and inner.like is not None and len(inner.like):
        like = site.robots.reference.text(inner.like[0])
        yield site.propose(site.draft.insert(geometry, like), "the shape is missing", "add the shape")
        parent = geometry.getparent()
        misplaced = [child for child in parent if child.tag in _SHAPES] if parent is not None else []
        for shape in misplaced:
            edits = (*site.draft.remove(geometry), *site.draft.wrap(shape, "geometry"))
            yield site.propose(edits, "a shape outside <geometry>", "put it into <geometry>")


def _meant(shape: Element) -> list[str]:
    near = closest(str(shape.tag), _SHAPES)
    by_attributes = [name for name in _SHAPES if set(map(str, shape.keys())) & set(REQUIRED[name])]
    return list(dict.fromkeys([*([near] if near else []), *by_attributes]))


def removal(site: Site, tags: tuple[str, ...]) -> Iterator[Proposal]:
    """Remove the element that cannot be read, where the robot needs none."""
    found: Element | None = site.element
    while found is not None and found.tag not in tags:
        found = found.getparent()
    if found is not None:
        tag = found.tag
        yield site.propose(site.draft.remove(found), f"the <{tag}>", f"remove the <{tag}>")


def spelling_repairs(site: Site) -> Iterator[Proposal]:
    """Correct a tag or attribute that ROS 2 ignores: <vizual>, <Origin>, hight=."""
    element, tag, attribute = site.element, str(site.element.tag), site.attribute
    if attribute is not None:
        known = ATTRIBUTES.get(tag, ())
        missing = [name for name in known if element.get(name) is None]
        meant = (TAGS[tag].aliases.get(attribute) if tag in TAGS else None) or closest(attribute, missing)
        if attribute not in known and meant:
            yield site.propose(site.draft.rename_attribute(element, attribute, meant), *_misspelt(f"attribute {meant}"))
        return
    parent = element.getparent()
    near = closest(tag, CHILDREN.get(str(parent.tag), ())) if parent is not None else None
    if near and tag not in CHILDREN.get(str(parent.tag) if parent is not None else "", ()):
        yield site.propose(site.draft.rename_tag(element, near), *_misspelt(f"tag <{near}>"))


def _misspelt(name: str) -> tuple[str, str]:
    return f"the name of the {name}", f"correct the name of the {name}"
