"""Links as urdfdom reads them (`link.cpp`): what is lost with a bad element, and which material a visual gets."""

from math import nan

from grader.robot import catalogue
from grader.robot.diagnostics import ElementReader, Problems, first_children
from grader.robot.materials import Materials
from grader.robot.model import Box, Collision, Cylinder, Geometry, Inertial, Link, Mesh, Sphere, Visual
from grader.xml.parsing import Element

_SHAPES = ("box", "cylinder", "sphere", "mesh")
_INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
# What is lost with an element that has a defect.
_INERTIAL_LOST = "ROS 2 drops all visuals and collisions of link {}"
_VISUAL_LOST = "ROS 2 drops this visual of link {}, those after it and all its collisions"
_COLLISION_LOST = "ROS 2 drops this collision of link {} and those after it"


def read_link(element: Element, problems: Problems, materials: Materials) -> Link:
    """Read one link with what ROS 2 keeps of it: a bad inertial loses all shapes, a bad shape those after it."""
    name = element.get("name")
    location = problems.location(element)
    if name is None:
        problems.add(catalogue.LINK_WITHOUT_NAME, "this link has no name; ROS 2 keeps it as an empty link ''", element)
        return Link("", location=location)
    inertial, dropping = None, False
    for child in element.iterchildren("inertial"):
        inertial = _read_inertial(child, problems, name)
        dropping = inertial is None
        break
    shapes: list[Visual | Collision] = []
    for child in (*element.iterchildren("visual"), *element.iterchildren("collision")):
        shape = _read_shape(child, problems, name, None if dropping else materials)
        dropping = dropping or shape is None
        if shape is not None and not dropping:
            shapes.append(shape)
    visuals = tuple(shape for shape in shapes if isinstance(shape, Visual))
    return Link(name, visuals, tuple(shape for shape in shapes if isinstance(shape, Collision)), inertial, location)


def _read_inertial(element: Element, problems: Problems, link: str) -> Inertial | None:
    reader = ElementReader(problems, catalogue.BAD_INERTIAL, _INERTIAL_LOST, link)
    inside = first_children(element)
    origin = reader.origin(inside.get("origin"))
    values = dict.fromkeys(("value", *_INERTIA), nan)
    for tag, attributes in (("mass", ("value",)), ("inertia", _INERTIA)):
        if tag in inside:
            values |= {attribute: reader.required(inside[tag], attribute) for attribute in attributes}
        else:
            reader.fail(f"<inertial> has no <{tag}>", element)
    if reader.failed:
        return None
    mass, ixx, ixy, ixz, iyy, iyz, izz = values.values()
    return Inertial(mass, (ixx, ixy, ixz, iyy, iyz, izz), origin)


def _read_shape(
    element: Element, problems: Problems, link: str, materials: Materials | None
) -> Visual | Collision | None:
    """Read a visual or collision; `materials` is None where it is dropped anyway, and defines none."""
    is_visual = element.tag == "visual"
    kind, lost = (catalogue.BAD_VISUAL, _VISUAL_LOST) if is_visual else (catalogue.BAD_COLLISION, _COLLISION_LOST)
    reader = ElementReader(problems, kind, lost, link)
    inside = first_children(element)
    origin = reader.origin(inside.get("origin"))
    geometry = _read_geometry(element, inside.get("geometry"), reader, problems)
    material = inside.get("material") if is_visual else None
    if material is not None and material.get("name") is None:
        reader.fail("<material> in a visual has no name", material)
    if reader.failed or geometry is None:
        return None
    if not is_visual:
        return Collision(geometry, origin, problems.location(element))
    if material is None or materials is None:
        return Visual(geometry, origin, location=problems.location(element))
    return Visual(geometry, origin, *materials.assign(material, link), problems.location(element))


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
    geometry: Geometry | None = None
    sizes: list[tuple[str, float]] = []
    match shape.tag:
        case "box":
            if shape.get("size") is None:
                reader.fail("<box> has no size", shape)
            geometry = Box(reader.vector(shape, "size"), location)
            sizes = [("size", edge) for edge in geometry.size]
        case "cylinder":
            geometry = Cylinder(reader.required(shape, "radius"), reader.required(shape, "length"), location)
            sizes = [("radius", geometry.radius), ("length", geometry.length)]
        case "sphere":
            geometry = Sphere(reader.required(shape, "radius"), location)
            sizes = [("radius", geometry.radius)]
        case "mesh":
            if shape.get("filename") is None:
                reader.fail("<mesh> has no filename", shape)
            geometry = Mesh(shape.get("filename") or "", reader.vector(shape, "scale", (1.0, 1.0, 1.0)), location)
        case unknown:
            guess = problems.did_you_mean(str(unknown), _SHAPES)
            reader.fail(f"<{unknown}> is not a shape that ROS 2 knows{guess}", shape)
    negative = next(((attribute, value) for attribute, value in sizes if value < 0), None)
    if negative is not None:
        attribute, value = negative
        message = f"{attribute} of <{shape.tag}> is negative ({value:g}), which ROS 2 does not check"
        problems.add(catalogue.NEGATIVE_SIZE, message, shape, attribute)
    return geometry
