"""The centre of mass and the inertia of a link: whether they can be those of its shapes."""

from math import dist, hypot, sqrt

from grader.base.patterns import on_use
from grader.base.quantities import in_millimetres, point
from grader.base.source import place
from grader.base.text import quoted
from grader.base.transforms import Vector
from grader.ros.urdf.mass_properties import Tensor, solid_inertia, turned, with_volume
from grader.ros.urdf.model import Collision, Cylinder, Inertial, Link, Mesh, Visual
from grader.ros.urdf.shapes import PlacedShape
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    OTHER_VALUE,
    Rule,
)

_AXES: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_NAMES = "xyz"
_MARGIN, _MARGIN_SHARE = 0.005, 0.1  # metres, and of the size of the shapes
_EQUAL, _OTHER = 0.05, 0.2  # of the largest moment of the cylinder
_TOO_LARGE = 2.0  # of the distance of the farthest part of the shapes
_OF_LINK = 20  # parts
_TURNED_BY = on_use(r"<origin\b[^<>]*?\brpy\s*=\s*[\"']\$\{\s*(\w+)\s*\}[\"']")


def mass_facts(workspace: Workspace) -> Facts:
    """Yield centres of mass outside of the shapes, and inertias of a cylinder along another axis.

    A link with a mesh is not compared: only its file says what it is.
    """
    said = set()  # of a macro, the first link
    for robot in workspace.robots.known:
        has_large = False  # of a robot, the first link is said
        for link in robot.robot.links:
            workspace.charge(_OF_LINK)
            inertial = link.inertial
            if not inertial or inertial.mass <= 0.0 or inertial.location is None:
                continue
            too_large = [] if has_large else list(_too_large(link, inertial))
            has_large = has_large or bool(too_large)
            for wrong in (
                *_centre_outside(link, inertial),
                *_other_axis(link, inertial),
                *_other_centre(link, inertial),
                *too_large,
            ):
                key = (wrong.rule, wrong.location.path, wrong.location.line)
                if key not in said:
                    said.add(key)
                    yield wrong


def _elements(link: Link) -> list[Visual | Collision]:
    return [*link.visuals, *link.collisions]


def _placed_shapes(link: Link) -> list[PlacedShape]:
    """Return the shapes of a link in its frame; nothing if one is a mesh, of unknown size."""
    if any(isinstance(element.geometry, Mesh) for element in _elements(link)):
        return []
    shapes = with_volume(_elements(link))
    return [PlacedShape(shape, origin.placed_in()) for shape, origin in shapes]


_CENTRE_OF_MASS = Rule(
    "centre-of-mass",
    "values",
    OTHER_VALUE,
    "The centre of mass of a link is within its shapes.",
    why=(
        "Gazebo simulates the mass where the link is not. The robot may tip over, swing or "
        "rotate without a visible reason."
    ),
    wrong="""
<inertial>
  <origin xyz="0 0 -0.5"/><mass value="2"/>
  <inertia ixx="0.02" iyy="0.02" izz="0.01" ixy="0" ixz="0" iyz="0"/>
</inertial>
""",
    right="""
<inertial>
  <origin xyz="0 0 0"/><mass value="2"/>
  <inertia ixx="0.02" iyy="0.02" izz="0.01" ixy="0" ixz="0" iyz="0"/>
</inertial>
""",
    frame="weight/rover.urdf",
)


def _centre_outside(link: Link, inertial: Inertial) -> Mismatches:
    """Yield that the centre of mass is outside of the box around all shapes of a link."""
    placed = _placed_shapes(link)
    if not placed:
        return
    centre = inertial.origin.placed_in().translation
    extents = _extents(placed)
    outside = []
    for coordinate, (least, most) in zip(centre, extents, strict=True):
        outside.append(max(least - coordinate, coordinate - most, 0.0))
    size = hypot(*(most - least for least, most in extents))
    if hypot(*outside) <= _MARGIN + _MARGIN_SHARE * size:
        return
    message = (
        f"the centre of mass of {quoted(link.name)} is at {point(centre)} m, "
        f"{in_millimetres(hypot(*outside))} outside of its shapes"
    )
    at = place(inertial.origin.location, "xyz") or place(inertial.location)
    if at:
        yield warning(_CENTRE_OF_MASS, message, at.resolve())


_INERTIA_PLACE = Rule(
    "inertia-place",
    "values",
    OTHER_VALUE,
    "The inertia of a shape about its middle has its <origin> there.",
    why=(
        "Gazebo simulates the mass at the origin of the link. An arm then loads its joint too "
        "little or too much, or a tall robot tips differently."
    ),
    wrong="""
<inertial>
  <mass value="3"/>
  <inertia ixx="0.0425" iyy="0.0425" izz="0.005" ixy="0" ixz="0" iyz="0"/>
</inertial>
""",
    right="""
<inertial>
  <origin xyz="0 0 0.2"/>
  <mass value="3"/>
  <inertia ixx="0.0425" iyy="0.0425" izz="0.005" ixy="0" ixz="0" iyz="0"/>
</inertial>
""",
    frame="long/rover.urdf",
)


def _other_centre(link: Link, inertial: Inertial) -> Mismatches:
    """Yield that an inertia is that of the shape of a link about its middle, which is elsewhere.

    A centre of mass with an offset may be meant, one at the origin of the link is forgotten.
    """
    placed = _only_shape(link)
    if not placed or any(inertial.origin.xyz):
        return
    if not _is_of_solid(inertial, placed):
        return
    middle = placed.pose.translation
    size = hypot(*(most - least for least, most in _extents([placed])))
    away = hypot(*middle)
    if away <= _MARGIN + _MARGIN_SHARE * size:
        return
    message = (
        f"the inertia of {quoted(link.name)} is that of its shape about the middle, but its centre "
        f'of mass is {in_millimetres(away)} away: write <origin xyz="{point(middle)}"/>'
    )
    assert inertial.location  # which mass_facts() asks for
    yield warning(_INERTIA_PLACE, message, inertial.location.resolve())


def _only_shape(link: Link) -> PlacedShape | None:
    """Return the only shape of a link, in whose middle its visuals are, too."""
    shapes = with_volume(link.collisions) or with_volume(link.visuals)
    if len(shapes) != 1 or any(each.origin.xyz != shapes[0][1].xyz for each in _elements(link)):
        return None
    shape, origin = shapes[0]
    return PlacedShape(shape, origin.placed_in())


def _is_of_solid(inertial: Inertial, placed: PlacedShape) -> bool:
    """Return whether an inertia is that of a uniform solid about its middle."""
    rotation = (inertial.origin.placed_in().inverse() @ placed.pose).rotation
    if isinstance(placed.geometry, Mesh):
        return False
    expected = turned(solid_inertia(placed.geometry, inertial.mass), rotation)
    return dist(inertial.inertia, expected) <= _EQUAL * max(map(abs, expected))


_INERTIA_SIZE = Rule(
    "inertia-size",
    "values",
    OTHER_VALUE,
    "The inertia of a link is that of a body of its size.",
    why=(
        "Gazebo simulates a body that hardly starts or stops to rotate. Joints respond slowly, "
        "and controllers overshoot or do not reach their goals."
    ),
    wrong="""
<inertial>
  <mass value="2"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
</inertial>
""",
    right="""
<inertial>
  <mass value="2"/>
  <inertia ixx="0.0101667" iyy="0.02" izz="0.0101667" ixy="0" ixz="0" iyz="0"/>
</inertial>
""",
    frame="weight/rover.urdf",
)


def _too_large(link: Link, inertial: Inertial) -> Mismatches:
    """Yield an inertia that no body of the size of the shapes has, whatever is in it.

    A moment of inertia is at most the mass by the square of the distance of its farthest part.
    """
    placed = _placed_shapes(link)
    if not placed:
        return
    centre = inertial.origin.placed_in().translation
    farthest = []
    for coordinate, (least, most) in zip(centre, _extents(placed), strict=True):
        farthest.append(max(most - coordinate, coordinate - least))
    reach = hypot(*farthest)
    ixx, _, _, iyy, _, izz = inertial.inertia
    radius = sqrt(max(ixx, iyy, izz, 0.0) / inertial.mass)
    if radius <= _TOO_LARGE * reach:
        return
    message = (
        f"the inertia of {quoted(link.name)} is that of {inertial.mass:g} kg at a distance of "
        f"{radius:.3g} m; its shapes reach {reach:.3g} m"
    )
    at = place(inertial.location, None, "inertia") or place(inertial.location)
    if at:
        yield warning(_INERTIA_SIZE, message, at.resolve())


def _extents(placed: list[PlacedShape]) -> list[tuple[float, float]]:
    """Return from where to where shapes reach along each axis."""
    extents = []
    for axis in _AXES:
        each = [shape.extent(axis) for shape in placed]
        extents.append((min(least for least, _ in each), max(most for _, most in each)))
    return extents


_INERTIA_AXIS = Rule(
    "inertia-axis",
    "values",
    OTHER_VALUE,
    "The inertia of a cylinder is that about its own axis.",
    why=(
        "Gazebo resists rotation about the wrong axis. Wheels and arms accelerate too easily or"
        " too slowly, and the robot may shake."
    ),
    wrong="""
<inertial>
  <mass value="2"/>
  <inertia ixx="0.0101667" iyy="0.0101667" izz="0.02" ixy="0" ixz="0" iyz="0"/>
</inertial>
""",
    right="""
<inertial>
  <mass value="2"/>
  <inertia ixx="0.0101667" iyy="0.02" izz="0.0101667" ixy="0" ixz="0" iyz="0"/>
</inertial>
""",
    frame="weight/rover.urdf",
)


def _other_axis(link: Link, inertial: Inertial) -> Mismatches:
    """Yield that an inertia is that of the cylinder of a link along another axis than it has."""
    shapes = with_volume(link.collisions) or with_volume(link.visuals)
    if len(shapes) != 1:
        return
    cylinder, origin = shapes[0]
    if not isinstance(cylinder, Cylinder):
        return
    T_link_inertial = inertial.origin.placed_in()
    rotation = (T_link_inertial.inverse() @ origin.placed_in()).rotation
    across, _, _, _, _, along = solid_inertia(cylinder, inertial.mass)
    candidates = [_about(number, along, across) for number in range(3)]
    allowed = _EQUAL * max(along, across)
    given = [
        number
        for number, candidate in enumerate(candidates)
        if dist(inertial.inertia, candidate) <= allowed
    ]
    expected = turned(candidates[2], rotation)
    if len(given) != 1 or dist(inertial.inertia, expected) <= _OTHER * max(along, across):
        return
    right = [n for n, each in enumerate(candidates) if dist(each, expected) <= allowed]
    written = _NAMES[given[0]]
    advice = "turn the <origin> of the <inertial>"
    if len(right) == 1:
        names = sorted((written, _NAMES[right[0]]))
        advice = f"exchange i{names[0] * 2} and i{names[1] * 2}, or {advice}"
    said = f"the inertia of {quoted(link.name)} is that of its cylinder along {written}, but the "
    inertia = place(inertial.location, None, "inertia")
    if inertia is None or link.location is None:
        return
    at = inertia.resolve()
    around = link.location.resolve().calls
    inside = at.calls[len(around) :]
    if inside:  # the macro is for other links as well
        macro, call = inside[0]
        at = call._replace(calls=around)
        advice = _advice_for_call(inertial, macro, is_direct=len(inside) == 1)
    yield warning(_INERTIA_AXIS, f"{said}cylinder lies otherwise: {advice}", at)


def _advice_for_call(inertial: Inertial, macro: str, *, is_direct: bool) -> str:
    """Return how to turn the inertia of one link, which a macro writes."""
    origin = inertial.origin.location
    parameter = None
    if origin and is_direct:
        source, start = origin.source.element(origin.tag)
        parameter = _TURNED_BY.match(source.text, start)
    if not parameter:
        return f"give the link an <inertial> of its own, in place of {macro}"
    return f"pass {parameter[1]} to {macro} here, which turns the <origin> of the <inertial>"


def _about(number: int, along: float, across: float) -> Tensor:
    """Return the inertia of a cylinder along the axis of a number."""
    moments = [across, across, across]
    moments[number] = along
    return (moments[0], 0.0, 0.0, moments[1], 0.0, moments[2])
