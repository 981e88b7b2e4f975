"""Facts about what a link shows: its shapes, where they are in its frame, their colours; and its meshes."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from grader.checks.measures.fact import (
    Fact,
    Measure,
    Omission,
    direction,
    in_title,
    is_same_number,
    length,
    lengths,
    of_links,
)
from grader.checks.mesh_files import mesh_file
from grader.checks.visuals import MAX_SHAPES
from grader.robot.model import Box, Cylinder, Geometry, Link, Mesh, Sphere, Visual
from grader.robot.shapes import is_empty, volume
from grader.robot.transforms import Z_AXIS, rotation_from_rpy

_CLEARLY_SMALLER = 0.95  # of the largest volume: more could be the largest in an equivalent robot


class _ShapeGroup(NamedTuple):
    """The visuals of a link that have shapes of one kind; `selected` are the arguments that choose the kind."""

    link: str
    kind: type[Geometry]
    visuals: Sequence[Visual]
    selected: Mapping[str, Any]

    @property
    def name(self) -> str:
        """The name of the kind: box."""
        return self.kind.__name__.lower()

    @property
    def largest(self) -> Visual | None:
        """The largest shape, which alone the checks of places and colours examine; None where that is not clear."""
        largest, *others = sorted(self.visuals, key=lambda visual: volume(visual.geometry), reverse=True)
        is_clear = not others or volume(others[0].geometry) <= _CLEARLY_SMALLER * volume(largest.geometry)
        return largest if is_clear else None


def _groups(link: Link) -> Iterator[_ShapeGroup]:
    """Yield what a link shows, by the kind of shape; nothing where it shows too much."""
    if len(link.visuals) > MAX_SHAPES:
        return
    visuals = [visual for visual in link.visuals if not is_empty(visual.geometry)]
    by_kind: dict[type[Geometry], list[Visual]] = {}
    for visual in visuals:
        by_kind.setdefault(type(visual.geometry), []).append(visual)
    for kind, same in by_kind.items():
        selected = {"shape": kind.__name__.lower()} if len(visuals) > 1 and kind is not Mesh else {}
        yield _ShapeGroup(link.name, kind, same, selected)


def _places(link: Link) -> Iterator[Fact | Omission]:
    """Yield the place of the largest shape of each kind."""
    if len(link.visuals) > MAX_SHAPES:
        yield Omission(f"what {link.name} shows", f"it has more than {MAX_SHAPES} visuals")
    for group in _groups(link):
        largest = group.largest if group.kind is not Mesh else None
        if largest is not None:
            yield _place(link.name, largest, group.name, group.selected)
            if len(group.visuals) > 1:
                what = f"{link.name}: place and colour of all its {_PLURALS[group.kind]} but the largest"
                yield Omission(what, "a check examines the largest shape of a kind")
        elif group.kind is not Mesh:
            yield Omission(f"{link.name}: place and colour of its {_PLURALS[group.kind]}", "they are equally large")


def _colours(link: Link) -> Iterator[Fact | Omission]:
    """Yield the colour of the largest shape of each kind, and that of the meshes."""
    for group in _groups(link):
        if group.kind is not Mesh:
            examined = group.largest
        elif len({visual.material and visual.material.rgba for visual in group.visuals}) == 1:
            examined = group.visuals[0]
        else:
            yield Omission(f"{link.name}: the colours of its meshes", "a check examines one mesh, and they differ")
            continue
        if examined is not None:
            yield from _colour(link.name, examined, group.name, group.selected)


def _meshes(link: Link) -> Iterator[Fact]:
    for group in _groups(link):
        if group.kind is Mesh:
            yield from (_mesh(link.name, visual, number) for number, visual in enumerate(group.visuals))


def _sizes(kind: type[Geometry]) -> Measure:
    """Return a fact for each different size of shapes of one kind."""

    def of_link(link: Link) -> Iterator[Fact]:
        seen: list[Mapping[str, Any]] = []
        for visual in (it for group in _groups(link) if group.kind is kind for it in group.visuals):
            check, arguments, title = _SIZES[kind](visual)
            if arguments not in seen:
                seen.append(arguments)
                aspect = check.removeprefix("shows_")
                yield Fact(link.name, aspect, f"{link.name} shows a {title}", check, {"link": link.name, **arguments})

    return of_links(of_link)


boxes, cylinders, spheres = map(_sizes, (Box, Cylinder, Sphere))
meshes = of_links(_meshes)
places = of_links(_places)
colours = of_links(_colours)


def _box(visual: Visual) -> tuple[str, Mapping[str, Any], str]:
    assert isinstance(visual.geometry, Box)
    edges = _along_axes(visual, visual.geometry)
    return "shows_box", {"size": edges}, f"box {' x '.join(in_title([edge]) for edge in edges)} m"


def _cylinder(visual: Visual) -> tuple[str, Mapping[str, Any], str]:
    assert isinstance(visual.geometry, Cylinder)
    radius, long = length(abs(visual.geometry.radius)), length(abs(visual.geometry.length))
    title = f"cylinder of radius {in_title([radius])} m and length {in_title([long])} m"
    return "shows_cylinder", {"radius": radius, "length": long}, title


def _sphere(visual: Visual) -> tuple[str, Mapping[str, Any], str]:
    assert isinstance(visual.geometry, Sphere)
    radius = length(abs(visual.geometry.radius))
    return "shows_sphere", {"radius": radius}, f"sphere of radius {in_title([radius])} m"


_SIZES: Mapping[type[Geometry], Callable[[Visual], tuple[str, Mapping[str, Any], str]]] = {
    Box: _box,
    Cylinder: _cylinder,
    Sphere: _sphere,
}
_PLURALS: Mapping[type[Geometry], str] = {Box: "boxes", Cylinder: "cylinders", Sphere: "spheres"}


def _along_axes(visual: Visual, box: Box) -> list[float]:
    """Return the edges of a box along the axes of its link; of a box that is turned otherwise, along its own."""
    rotation = rotation_from_rpy(visual.origin.rpy)
    rows = [[abs(value) for value in rotation[3 * row : 3 * row + 3]] for row in range(3)]
    order = [row.index(max(row)) for row in rows]
    return [length(abs(box.size[column])) for column in (order if sorted(order) == [0, 1, 2] else range(3))]


def _place(link: str, visual: Visual, kind: str, selected: Mapping[str, Any]) -> Fact:
    """Return where a shape is in its link, and how the axis of a cylinder, or of a box that is turned, lies."""
    xyz = lengths(visual.origin.xyz)
    arguments: dict[str, Any] = {}
    title = f"The centre of the {kind} of {link} is at {in_title(xyz)} m in its frame"
    if isinstance(visual.geometry, Cylinder):
        x, y, z = (rotation_from_rpy(visual.origin.rpy)[index] for index in (2, 5, 8))
        axis = direction((x, y, z))
        arguments = {"axis": axis} if not is_same_number(abs(z), 1.0) else {}
        arguments["angle"] = 1.0
        title += f", its axis along {in_title(axis if arguments.get('axis') else Z_AXIS)}"
    place = {"link": link, **selected, "relative_to": link, "xyz": xyz, **arguments}
    return Fact(link, f"{kind}-place" if selected else "place", title, "centre_at", place)


def _colour(link: str, visual: Visual, kind: str, selected: Mapping[str, Any]) -> Iterator[Fact]:
    if visual.material is None:
        return
    channels = [round(channel, 4) for channel in visual.material.rgba]
    what = f"{kind} of {link}" if selected else link
    title = f"{'The ' if selected else ''}{what} is shown in rgba {in_title(channels)}"
    aspect = f"{kind}-colour" if selected else "colour"
    yield Fact(link, aspect, title, "shows_colour", {"link": link, **selected, "colour": channels})


def _mesh(link: str, visual: Visual, number: int) -> Fact:
    mesh = visual.geometry
    assert isinstance(mesh, Mesh)
    file = "/".join(mesh_file(mesh.filename, is_expanded=True).steps)
    scale, xyz, rpy = lengths(mesh.scale), lengths(visual.origin.xyz), lengths(visual.origin.rpy)
    title = f"{link} shows the mesh {file}"
    title += f", scaled by {in_title(scale)}" if scale != [1.0, 1.0, 1.0] else ""
    title += f", at {in_title(xyz)} m in its frame" if any(xyz) else ""
    arguments = {"link": link, "file": file, "scale": scale, "xyz": xyz, "rpy": rpy}
    return Fact(link, f"mesh-{number + 1}" if number else "mesh", title, "shows_mesh", arguments)
