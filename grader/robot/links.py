"""Links as urdfdom reads them: what is lost with a bad element (`link.cpp`), and the colour that each visual gets.

The colour is that of `parseMaterial` in `link.cpp` and of `assignMaterial` in `model.cpp`.
"""

from grader.robot import catalogue
from grader.robot.diagnostics import ElementReader, Problems, first_children
from grader.robot.materials import Materials
from grader.robot.model import INERTIA, Box, Collision, Cylinder, Geometry, Inertial, Link, Mesh, Sphere, Visual
from grader.source import LazyLocation
from grader.xml.parsing import Element

_SHAPES = ("box", "cylinder", "sphere", "mesh")
# What is lost with an element that has a defect.
_INERTIAL_LOST = "ROS 2 drops all visuals and collisions of link {}"
_VISUAL_LOST = "ROS 2 drops this visual of link {}, the visuals after it and all collisions"
_COLLISION_LOST = "ROS 2 drops this collision of link {} and the collisions after it"


def read_link(element: Element, problems: Problems, materials: Materials) -> Link:
    """Read one link with what ROS 2 keeps of it: a bad inertial loses all shapes, a bad shape those after it."""
    name = element.get("name")
    location = problems.location(element)
    if name is None:
        problems.add(catalogue.LINK_WITHOUT_NAME, "this link has no name; ROS 2 keeps it as an empty link ''", element)
        return Link("", location=location)
    parts: dict[str, list[Element]] = {"inertial": [], "visual": [], "collision": []}
    for child in element:
        parts.get(child.tag, []).append(child)
    inertial = _read_inertial(parts["inertial"][0], problems, name) if parts["inertial"] else None
    dropping = inertial is None and parts["inertial"] != [] and not problems.is_unresolved(parts["inertial"][0])
    shapes: list[Visual | Collision] = []
    for child in parts["visual"] + parts["collision"]:
        shape = _read_shape(child, problems, name, None if dropping else materials)
        dropping = dropping or (shape is None and not problems.is_unresolved(child))
        if shape is not None and not dropping:
            shapes.append(shape)
    visuals = tuple(shape for shape in shapes if isinstance(shape, Visual))
    collisions = tuple(shape for shape in shapes if isinstance(shape, Collision))
    return Link(name, visuals, collisions, inertial, location, problems.parts(element))


def _read_inertial(element: Element, problems: Problems, link: str) -> Inertial | None:
    reader = ElementReader(problems, catalogue.BAD_INERTIAL, _INERTIAL_LOST, link)
    inside = first_children(element)
    origin = reader.origin(inside.get("origin"))
    values: list[float] = []
    for tag, attributes in (("mass", ("value",)), ("inertia", INERTIA)):
        if tag in inside:
            values += [reader.number(inside[tag], attribute) for attribute in attributes]
        else:
            reader.fail(f"<inertial> has no <{tag}>", element)
    if reader.failed:
        return None
    mass, ixx, ixy, ixz, iyy, iyz, izz = values
    return Inertial(mass, (ixx, ixy, ixz, iyy, iyz, izz), origin, problems.location(element))


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
    if shape.tag not in _SHAPES:
        guess = problems.did_you_mean(str(shape.tag), _SHAPES)
        reader.fail(f"<{shape.tag}> is not a shape that ROS 2 knows{guess}", shape)
        return None
    needed = {"box": "size", "mesh": "filename"}.get(shape.tag)
    if needed and shape.get(needed) is None:
        reader.fail(f"<{shape.tag}> has no {needed}", shape)
    geometry = _shape(shape, reader, problems.location(shape))
    for attribute, value in _sizes(geometry):
        if value < 0:
            message = f"{attribute} of <{shape.tag}> is negative ({value:g}), which ROS 2 does not check"
            problems.add(catalogue.NEGATIVE_SIZE, message, shape, attribute)
            break
    return geometry


def _shape(shape: Element, reader: ElementReader, location: LazyLocation) -> Geometry:
    match shape.tag:
        case "box":
            return Box(reader.vector(shape, "size"), location)
        case "cylinder":
            return Cylinder(reader.number(shape, "radius"), reader.number(shape, "length"), location)
        case "sphere":
            return Sphere(reader.number(shape, "radius"), location)
    return Mesh(shape.get("filename") or "", reader.vector(shape, "scale", (1.0, 1.0, 1.0)), location)


def _sizes(geometry: Geometry) -> list[tuple[str, float]]:
    """Return the attributes with the sizes of a shape that has some."""
    match geometry:
        case Box(size=edges):
            return [("size", edge) for edge in edges]
        case Cylinder(radius=radius, length=length):
            return [("radius", radius), ("length", length)]
        case Sphere(radius=radius):
            return [("radius", radius)]
    return []
