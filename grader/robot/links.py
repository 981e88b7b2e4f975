"""Links as urdfdom reads them (`link.cpp`): what a bad part costs, and which material a visual ends up with."""

from grader.robot import catalogue
from grader.robot.diagnostics import Notes, Part, children
from grader.robot.materials import Materials
from grader.robot.model import Box, Collision, Cylinder, Geometry, Inertial, Link, Mesh, Sphere, Visual
from grader.xml.parsing import Element

_SHAPES = ("box", "cylinder", "sphere", "mesh")
_VISUAL_LOST = "ROS 2 drops this visual of link {}, those behind it and all its collisions"
_INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def read_link(element: Element, notes: Notes, materials: Materials) -> Link:
    """One link with what ROS 2 keeps of it: a bad inertial loses all shapes, a bad shape those behind it."""
    name = element.get("name")
    location = notes.location(element)
    if name is None:
        notes.add(catalogue.LINK_WITHOUT_NAME, "this link has no name; ROS 2 keeps it as an empty link ''", element)
        return Link("", location=location)
    inertial, dropping = None, False
    visuals: list[Visual] = []
    collisions: list[Collision] = []
    if len(element):
        parts: dict[str, list[Element]] = {"inertial": [], "visual": [], "collision": []}
        for child in element:
            if child.tag in parts:
                parts[child.tag].append(child)
        for each in parts["inertial"][:1]:
            inertial = _read_inertial(each, notes, name)
            dropping = inertial is None
        for each in parts["visual"]:
            visual = _read_visual(each, notes, name, materials if not dropping else None)
            dropping = dropping or visual is None
            if visual is not None and not dropping:
                visuals.append(visual)
        for each in parts["collision"]:
            collision = _read_collision(each, notes, name)
            dropping = dropping or collision is None
            if collision is not None and not dropping:
                collisions.append(collision)
    return Link(name, tuple(visuals), tuple(collisions), inertial, location)


def _read_inertial(element: Element, notes: Notes, link: str) -> Inertial | None:
    part = Part(notes, catalogue.BAD_INERTIAL, "ROS 2 drops all visuals and collisions of link {}", link)
    inside = children(element)
    origin = part.origin(inside.get("origin"))
    mass, values = float("nan"), [float("nan")] * len(_INERTIA)
    if "mass" in inside:
        mass = part.needed(inside["mass"], "value")
    else:
        part.fail("<inertial> has no <mass>", element)
    if "inertia" in inside:
        values = [part.needed(inside["inertia"], each) for each in _INERTIA]
    else:
        part.fail("<inertial> has no <inertia>", element)
    if part.bad or origin is None:
        return None
    return Inertial(mass, (values[0], values[1], values[2], values[3], values[4], values[5]), origin)


def _read_visual(element: Element, notes: Notes, link: str, materials: Materials | None) -> Visual | None:
    """A visual with its material resolved; a visual that is dropped anyway defines no material."""
    part = Part(notes, catalogue.BAD_VISUAL, _VISUAL_LOST, link)
    inside = children(element)
    origin = part.origin(inside.get("origin"))
    geometry = _read_geometry(element, inside.get("geometry"), part, notes)
    material = inside.get("material")
    if material is not None and material.get("name") is None:
        part.fail("<material> in a visual has no name", material)
    if part.bad or geometry is None or origin is None:
        return None
    if material is None or materials is None:
        return Visual(geometry, origin, location=part.location(element))
    return Visual(geometry, origin, *materials.assign(material, link), part.location(element))


def _read_collision(element: Element, notes: Notes, link: str) -> Collision | None:
    part = Part(notes, catalogue.BAD_COLLISION, "ROS 2 drops this collision of link {} and those behind it", link)
    inside = children(element)
    origin = part.origin(inside.get("origin"))
    geometry = _read_geometry(element, inside.get("geometry"), part, notes)
    if part.bad or geometry is None or origin is None:
        return None
    return Collision(geometry, origin, part.location(element))


def _read_geometry(owner: Element, element: Element | None, part: Part, notes: Notes) -> Geometry | None:
    if element is None:
        part.fail(f"<{owner.tag}> has no <geometry>", owner)
        return None
    if not len(element):
        part.fail("<geometry> is empty", element)
        return None
    shape = element[0]
    location = part.location(shape)
    match shape.tag:
        case "box":
            if shape.get("size") is None:
                part.fail("<box> has no size", shape)
            size = part.vector(shape, "size")
            geometry: Geometry | None = Box(size, location) if size is not None else None
        case "cylinder":
            geometry = Cylinder(part.needed(shape, "radius"), part.needed(shape, "length"), location)
        case "sphere":
            geometry = Sphere(part.needed(shape, "radius"), location)
        case "mesh":
            geometry = _read_mesh(shape, part)
        case unknown:
            message = f"<{unknown}> is not a shape that ROS 2 knows{notes.did_you_mean(str(unknown), _SHAPES)}"
            part.fail(message, shape)
            return None
    _note_negative(geometry, shape, notes)
    return geometry


def _read_mesh(shape: Element, part: Part) -> Mesh | None:
    filename = shape.get("filename")
    if filename is None:
        part.fail("<mesh> has no filename", shape)
    scale = part.vector(shape, "scale") if shape.get("scale") is not None else (1.0, 1.0, 1.0)
    if filename is None or scale is None:
        return None
    return Mesh(filename, scale, part.location(shape))


def _note_negative(geometry: Geometry | None, shape: Element, notes: Notes) -> None:
    match geometry:
        case Box(size=size):
            sizes: tuple[tuple[str, float], ...] = tuple(("size", each) for each in size)
        case Cylinder(radius=radius, length=length):
            sizes = (("radius", radius), ("length", length))
        case Sphere(radius=radius):
            sizes = (("radius", radius),)
        case _:
            return
    for attribute, value in sizes:
        if value < 0:
            message = f"{attribute} of <{shape.tag}> is {value:g}: a size below zero, which ROS 2 does not check"
            notes.add(catalogue.NEGATIVE_SIZE, message, shape, attribute)
            return
