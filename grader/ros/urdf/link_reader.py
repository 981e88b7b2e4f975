"""Links as urdfdom reads them (`link.cpp`), with what is lost with a bad element.

The material that each visual gets is here too.

Its colour is that of `parseMaterial` in `link.cpp` and of `assignMaterial` in `model.cpp`.
"""

from collections.abc import Sequence
from math import nan

from grader.base.source import LazyLocation
from grader.base.text import quoted
from grader.ros.urdf import urdf_problems
from grader.ros.urdf.diagnostics import ElementReader, Problems, first_children, quote_value
from grader.ros.urdf.model import (
    INERTIA,
    Box,
    Capsule,
    Collision,
    Colour,
    Cylinder,
    Geometry,
    Inertial,
    Link,
    Material,
    Mesh,
    Sphere,
    UnresolvedPart,
    Visual,
)
from grader.ros.urdf.numbers import NumberError, rgba
from grader.ros.urdf.versions import WITH_CAPSULES, WITH_CHECKED_VALUES
from grader.ros.xml.parsing import Element, Elements

_BLACK = (0.0, 0.0, 0.0, 1.0)
_SHAPES = ("box", "cylinder", "sphere", "mesh")
_CAPSULE = "capsule"
# What is lost with an element that has a defect.
_INERTIAL_LOST = "ROS 2 drops all visuals and collisions of link {}"
_VISUAL_LOST = "ROS 2 drops this visual of link {}, the visuals after it and all collisions"
_COLLISION_LOST = "ROS 2 drops this collision of link {} and the collisions after it"


class Materials:
    """The materials that are defined so far.

    Those under <robot> come first, then those in links, in file order.
    """

    def __init__(self, problems: Problems) -> None:
        self._problems = problems
        # all definitions of the file, once one is missing
        self._defined: Elements | None = None
        self.known: dict[str, Material] = {}

    def define(self, element: Element) -> None:
        """Read a material directly under <robot>; without a valid colour it is black."""
        problems = self._problems
        name = element.get("name") or ""
        material, is_reported = self._read_material(element, name, "ROS 2 shows black")
        if element.get("name") is None:
            problems.add(
                urdf_problems.UNNAMED_MATERIAL,
                "this material has no name; no link can use it",
                element,
            )
        elif not material:
            if not is_reported:
                message = f"material {quoted(name)} has no valid colour; ROS 2 makes it black"
                problems.add(urdf_problems.COLOURLESS_MATERIAL, message, element)
            problems.check_printed(name, element, "name")
        if name in self.known:
            message = (
                f"material {quoted(name)} is defined twice under <robot>; ROS 2 rejects the file"
            )
            problems.add(urdf_problems.DUPLICATE_MATERIAL, message, element, "name")
        else:
            self.known[name] = material or Material(name, location=problems.location(element))

    def assign(self, element: Element, link: str) -> tuple[Material | None, str, bool]:
        """Return the material of a visual, its name, and whether its colour cannot be read.

        A defined one wins, otherwise the one in place is defined.
        """
        name = element.get("name") or ""
        if not len(element) and name in self.known and name:
            return self.known[name], name, False
        if name in self.known:
            fallback = "the definition above applies"
        else:
            fallback = f"material {quoted(name)} stays undefined"
        material, reported = self._read_material(element, name, f"ROS 2 logs an error: {fallback}")
        known = self.known.get(name) if name else material
        if not material:
            if not known and name and not reported:
                self._note_undefined(name, element, link)
                known = self._find_elsewhere(name)
        elif not known:
            known = self.known[name] = material
        elif (material.rgba, material.texture) != (known.rgba, known.texture):
            message = (
                f"material {quoted(name)} is already defined differently; ROS 2 ignores this "
                "definition"
            )
            self._problems.add(urdf_problems.REDEFINED_MATERIAL, message, element, "name")
        return known, name, not known and reported

    def _read_material(
        self, element: Element, name: str, consequence: str
    ) -> tuple[Material | None, bool]:
        """Return the material that an element defines, if it does.

        Also return whether its colour is reported as a problem.
        """
        inside = first_children(element)
        colour = inside.get("color")
        filename = inside["texture"].get("filename") if "texture" in inside else None
        channels = None
        reported = False
        if colour is not None and colour.get("rgba") is not None:
            channels = self._read_colour(colour, name, consequence)
            reported = channels is None
        unresolved = self._problems.parts(element)
        if channels is None and filename is None and not unresolved:
            return None, reported
        location = self._problems.location(element if colour is None else colour)
        return Material(name, channels or _BLACK, filename or "", location, unresolved), reported

    def _read_colour(self, colour: Element, name: str, consequence: str) -> Colour | None:
        """Return the channels of a colour; None, with a problem, for one that cannot be read."""
        text = colour.get("rgba") or ""
        try:
            channels = rgba(text)
        except NumberError as error:
            message = f"cannot read rgba={quote_value(text)}: {error}; {consequence}"
            self._problems.add(urdf_problems.BAD_COLOUR, message, colour, "rgba")
            self._problems.check_printed(f"{name} {text}", colour, "rgba")
            return None
        if channels is None:
            message = (
                f"rgba={quote_value(text)} needs exactly four numbers; ROS 2 silently shows black"
            )
            self._problems.add(urdf_problems.COLOUR_COUNT, message, colour, "rgba")
            return _BLACK
        return channels

    def _find_elsewhere(self, name: str) -> Material | None:
        """Return a material that may be defined in a part of the robot that xacro leaves open."""
        root = self._problems.root
        unresolved = self._problems.unresolved.get(root)
        if not unresolved or not unresolved.content:
            return None
        return Material(
            name, unresolved={"": UnresolvedPart(unresolved.content, self._problems.location(root))}
        )

    def _note_undefined(self, name: str, element: Element, link: str) -> None:
        problems = self._problems
        if self._defined is None:
            every = [other for other in problems.root.iter("material") if len(other)]
            self._defined = {other.get("name") or "": other for other in reversed(every)}
            self._defined.pop("", None)
        if name in self._defined:
            line = problems.line(self._defined[name])
            hint = f" before its definition in line {line}; define it directly under <robot>"
        else:
            hint = f", which is not defined{problems.did_you_mean(name, self._defined)}"
        message = (
            f"link {quoted(link)} uses material {quoted(name)}{hint}; ROS 2 shows it without "
            "the colour"
        )
        problems.add(urdf_problems.UNDEFINED_MATERIAL, message, element, "name")


def read_link(element: Element, problems: Problems, materials: Materials) -> Link:
    """Read one link with what ROS 2 keeps of it.

    A bad inertial loses all shapes, a bad shape those after it.
    """
    name = element.get("name")
    location = problems.location(element)
    if name is None:
        problems.add(
            urdf_problems.LINK_WITHOUT_NAME,
            "this link has no name; ROS 2 keeps it as an empty link ''",
            element,
        )
        return Link("", location=location)
    parts: dict[str, list[Element]] = {"inertial": [], "visual": [], "collision": []}
    for child in element:
        parts.get(child.tag, []).append(child)
    inertial = None
    is_bad = False
    if parts["inertial"]:
        first = parts["inertial"][0]
        inertial = _read_inertial(first, problems, name)
        is_bad = not inertial and not problems.is_unresolved(first)
    elements = parts["visual"] + parts["collision"]
    shapes = _read_shapes(elements, problems, name, materials, is_dropping=is_bad)
    visuals = tuple(shape for shape in shapes if isinstance(shape, Visual))
    collisions = tuple(shape for shape in shapes if isinstance(shape, Collision))
    return Link(name, visuals, collisions, inertial, location, problems.parts(element))


def _read_shapes(
    elements: Sequence[Element],
    problems: Problems,
    link: str,
    materials: Materials,
    *,
    is_dropping: bool,
) -> list[Visual | Collision]:
    """Read the shapes of a link; after a bad one, or with `is_dropping`, none is kept."""
    shapes = []
    for element in elements:
        shape = _read_shape(element, problems, link, None if is_dropping else materials)
        if not shape:
            is_dropping = is_dropping or not problems.is_unresolved(element)
        elif not is_dropping:
            shapes.append(shape)
    return shapes


def _read_inertial(element: Element, problems: Problems, link: str) -> Inertial | None:
    reader = ElementReader(problems, urdf_problems.BAD_INERTIAL, _INERTIAL_LOST, link)
    inside = first_children(element)
    origin = reader.origin(inside.get("origin"))
    values = []
    for tag, attributes in (("mass", ("value",)), ("inertia", INERTIA)):
        if tag in inside:
            values += [reader.number(inside[tag], attribute) for attribute in attributes]
        else:
            reader.fail(f"<inertial> has no <{tag}>", element, lacks=tag)
            values += [nan] * len(attributes)
    if reader.failed and not problems.keeps_dropped:
        return None
    mass, ixx, ixy, ixz, iyy, iyz, izz = values
    inertia = (ixx, ixy, ixz, iyy, iyz, izz)
    inertial = Inertial(mass, inertia, origin, problems.location(element))
    if not reader.failed:
        return inertial
    from grader.ros.urdf.not_known import with_unknown  # late: few elements are dropped

    fields = {"value": "mass", "mass": "mass", "xyz": "origin", "rpy": "origin"}
    errors = reader.unknown.items()
    unknown = {fields.get(name, "inertia"): error for (_, name), error in errors}
    return with_unknown(inertial, unknown)


def _read_shape(
    element: Element, problems: Problems, link: str, materials: Materials | None
) -> Visual | Collision | None:
    """Read a visual or collision.

    `materials` is None where it is dropped anyway, and defines none.
    """
    is_visual = element.tag == "visual"
    if is_visual:
        reader = ElementReader(problems, urdf_problems.BAD_VISUAL, _VISUAL_LOST, link)
    else:
        reader = ElementReader(problems, urdf_problems.BAD_COLLISION, _COLLISION_LOST, link)
    inside = first_children(element)
    origin = reader.origin(inside.get("origin"))
    geometry = _read_geometry(element, inside.get("geometry"), reader, problems)
    material = inside.get("material") if is_visual else None
    if material is not None and material.get("name") is None:
        reader.fail("<material> in a visual has no name", material)
    errors = reader.unknown.items()
    of_shape = {name: error for (tag, name), error in errors if tag != "origin"}
    is_kept = problems.keeps_dropped and geometry and of_shape.keys() <= {*geometry._fields}
    if not geometry or (reader.failed and not is_kept):
        return None
    if reader.failed:
        from grader.ros.urdf.not_known import with_unknown  # late: few elements are dropped

        geometry = with_unknown(geometry, of_shape)
        of_origin = {name: error for (tag, name), error in errors if tag == "origin"}
        origin = with_unknown(origin, of_origin)
    if not is_visual:
        return Collision(geometry, origin, problems.location(element))
    if material is None or not materials:
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
    has_capsules = problems.format.version >= WITH_CAPSULES
    if shape.tag not in _SHAPES and not (has_capsules and shape.tag == _CAPSULE):
        _refuse_shape(shape, reader, problems)
        return None
    needed = {"box": "size", "mesh": "filename"}.get(shape.tag)
    if needed and shape.get(needed) is None:
        reader.fail(f"<{shape.tag}> has no {needed}", shape, lacks=needed)
    geometry = _geometry_from(shape, reader, problems.location(shape))
    for attribute, value in _sizes_by_attribute(geometry):
        if value <= 0.0 and problems.format.version >= WITH_CHECKED_VALUES:
            reason = f"{attribute} of <{shape.tag}> is {value:g}, and version 1.2 needs more than 0"
            reader.fail(reason, shape, attribute)
            break
        if value < 0:
            message = (
                f"{attribute} of <{shape.tag}> is negative ({value:g}), which ROS 2 does not check"
            )
            problems.add(urdf_problems.NEGATIVE_SIZE, message, shape, attribute)
            break
    return geometry


def _refuse_shape(shape: Element, reader: ElementReader, problems: Problems) -> None:
    """Report a shape that ROS 2 does not know, or not in a file of this version."""
    if shape.tag == _CAPSULE and problems.format.warns:
        reason = '<capsule> needs version 1.1 of URDF: write <robot version="1.1">'
    elif shape.tag == _CAPSULE:
        reason = "<capsule> is a shape that ROS 2 knows from Lyrical on"
    else:
        guess = problems.did_you_mean(str(shape.tag), _SHAPES)
        reason = f"<{shape.tag}> is not a shape that ROS 2 knows{guess}"
    reader.fail(reason, shape)


def _geometry_from(shape: Element, reader: ElementReader, location: LazyLocation) -> Geometry:
    match shape.tag:
        case "box":
            return Box(reader.vector(shape, "size"), location)
        case "cylinder":
            return Cylinder(
                reader.number(shape, "radius"), reader.number(shape, "length"), location
            )
        case "capsule":
            return Capsule(reader.number(shape, "radius"), reader.number(shape, "length"), location)
        case "sphere":
            return Sphere(reader.number(shape, "radius"), location)
    return Mesh(
        shape.get("filename") or "", reader.vector(shape, "scale", (1.0, 1.0, 1.0)), location
    )


def _sizes_by_attribute(geometry: Geometry) -> list[tuple[str, float]]:
    """Return the attributes with the sizes of a shape that has some."""
    match geometry:
        case Box(size=edges):
            return [("size", edge) for edge in edges]
        case Cylinder(radius=radius, length=length) | Capsule(radius=radius, length=length):
            return [("radius", radius), ("length", length)]
        case Sphere(radius=radius):
            return [("radius", radius)]
    return []
