"""Links as urdfdom reads them (`link.cpp`): the content that is dropped with an invalid element, and the material of each visual."""

from grader.robot import catalogue
from grader.robot.diagnostics import Problems, first_children
from grader.robot.element_reader import ElementReader
from grader.robot.materials import Materials
from grader.robot.model import Box, Collision, Cylinder, Geometry, Inertial, Link, Mesh, Sphere, Visual
from grader.xml.parsing import Element

_SHAPES = ("box", "cylinder", "sphere", "mesh")
_INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
_INERTIAL_LOST = "ROS 2 drops all visuals and collisions of link {}"
_VISUAL_LOST = "ROS 2 drops this visual of link {}, the visuals after it and all collisions"
_COLLISION_LOST = "ROS 2 drops this collision of link {} and the collisions after it"
_UNIT_SCALE = (1.0, 1.0, 1.0)


def read_link(element: Element, problems: Problems, materials: Materials) -> Link:
    """Read one link with what ROS 2 keeps of it: a bad inertial loses all shapes, a bad shape those after it."""
    name = element.get("name")
    location = problems.location(element)
    if name is None:
        problems.add(catalogue.LINK_WITHOUT_NAME, "this link has no name; ROS 2 keeps it as an empty link ''", element)
        return Link("", location=location)
    parts: dict[str, list[Element]] = {"inertial": [], "visual": [], "collision": []}
    for child in element:
        if child.tag in parts:
            parts[child.tag].append(child)
    inertial, dropping = None, False
    if parts["inertial"]:
        inertial = _read_inertial(parts["inertial"][0], problems, name)
        dropping = inertial is None
    visuals: list[Visual] = []
    for child in parts["visual"]:
        visual = _read_visual(child, problems, name, None if dropping else materials)
        dropping = dropping or visual is None
        if visual is not None and not dropping:
            visuals.append(visual)
    collisions: list[Collision] = []
    for child in parts["collision"]:
        collision = _read_collision(child, problems, name)
        dropping = dropping or collision is None
        if collision is not None and not dropping:
            collisions.append(collision)
    return Link(name, tuple(visuals), tuple(collisions), inertial, location)


def _read_inertial(element: Element, problems: Problems, link: str) -> Inertial | None:
    reader = ElementReader(problems, catalogue.BAD_INERTIAL, _INERTIAL_LOST, link)
    inside = first_children(element)
    origin = reader.origin(inside.get("origin"))
    mass, values = float("nan"), [float("nan")] * len(_INERTIA)
    if "mass" in inside:
        mass = reader.required(inside["mass"], "value")
    else:
        reader.fail("<inertial> has no <mass>", element)
    if "inertia" in inside:
        values = [reader.required(inside["inertia"], name) for name in _INERTIA]
    else:
        reader.fail("<inertial> has no <inertia>", element)
    if reader.failed or origin is None:
        return None
    return Inertial(mass, (values[0], values[1], values[2], values[3], values[4], values[5]), origin)


def _read_visual(element: Element, problems: Problems, link: str, materials: Materials | None) -> Visual | None:
    """Read a visual and resolve its material; `materials` is None where it is dropped anyway, and defines none."""
    reader = ElementReader(problems, catalogue.BAD_VISUAL, _VISUAL_LOST, link)
    inside = first_children(element)
    origin = reader.origin(inside.get("origin"))
    geometry = _read_geometry(element, inside.get("geometry"), reader, problems)
    material = inside.get("material")
    if material is not None and material.get("name") is None:
        reader.fail("<material> in a visual has no name", material)
    if reader.failed or geometry is None or origin is None:
        return None
    if material is None or materials is None:
        return Visual(geometry, origin, location=problems.location(element))
    return Visual(geometry, origin, *materials.assign(material, link), problems.location(element))


def _read_collision(element: Element, problems: Problems, link: str) -> Collision | None:
    reader = ElementReader(problems, catalogue.BAD_COLLISION, _COLLISION_LOST, link)
    inside = first_children(element)
    origin = reader.origin(inside.get("origin"))
    geometry = _read_geometry(element, inside.get("geometry"), reader, problems)
    if reader.failed or geometry is None or origin is None:
        return None
    return Collision(geometry, origin, problems.location(element))


def _read_geometry(
    owner: Element, element: Element | None, reader: ElementReader, problems: Problems
) -> Geometry | None:
    if element is None:
        reader.fail(f"<{owner.tag}> has no <geometry>", owner)
        return None
    if not len(element):
        reader.fail("<geometry> is empty", element)
        return None
    shape = element[0]
    location = problems.location(shape)
    match shape.tag:
        case "box":
            if shape.get("size") is None:
                reader.fail("<box> has no size", shape)
            size = reader.vector(shape, "size")
            geometry: Geometry | None = Box(size, location) if size is not None else None
        case "cylinder":
            geometry = Cylinder(reader.required(shape, "radius"), reader.required(shape, "length"), location)
        case "sphere":
            geometry = Sphere(reader.required(shape, "radius"), location)
        case "mesh":
            filename, scale = shape.get("filename"), reader.vector(shape, "scale", _UNIT_SCALE)
            if filename is None:
                reader.fail("<mesh> has no filename", shape)
            return Mesh(filename, scale, location) if filename is not None and scale is not None else None
        case unknown:
            guess = problems.did_you_mean(str(unknown), _SHAPES)
            reader.fail(f"<{unknown}> is not a shape that ROS 2 knows{guess}", shape)
            return None
    _check_sizes(geometry, shape, problems)
    return geometry


def _check_sizes(geometry: Geometry | None, shape: Element, problems: Problems) -> None:
    match geometry:
        case Box(size=size):
            sizes = [("size", edge) for edge in size]
        case Cylinder(radius=radius, length=length):
            sizes = [("radius", radius), ("length", length)]
        case Sphere(radius=radius):
            sizes = [("radius", radius)]
        case _:
            return
    for attribute, value in sizes:
        if value < 0:
            message = f"{attribute} of <{shape.tag}> is negative ({value:g}), which ROS 2 does not check"
            problems.add(catalogue.NEGATIVE_SIZE, message, shape, attribute)
            return
