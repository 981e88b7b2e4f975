"""The drawing of a robot as an SVG element: three views at one scale, a key of the signs, and what is called out.

The element needs no style sheet, script or other file. A page that has it inside adds `DARK_RULES` for dark mode.
"""

from itertools import groupby
from typing import Any

from lxml import etree

from grader.drawing.labels import Labels
from grader.drawing.picture import Picture
from grader.drawing.projection import Stroke, projection
from grader.drawing.sheet import WIDTH, Cell, sheet_of
from grader.drawing.views import SIDE
from grader.report.drawing_key import description, put_key, put_legend
from grader.report.drawing_signs import Signs, add_callouts, add_frames, add_ground, add_outlines, add_wheels, outlines
from grader.report.svg_elements import SVG, colour, edge_look, path_data, put

_FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', Arial, sans-serif"
_HIDDEN = {"stroke-opacity": "0.5", "stroke-width": "0.9"}
_THUMBNAIL = (160.0, 100.0)
_NAMESPACES: Any = {None: SVG}  # a default namespace, which the types do not know


def drawing_element(picture: Picture, title: str = "", top: float = 0.0, *, legend: bool = True) -> Any:
    """Return the drawing of a robot, with `top` pixels left free above it; `legend` lists the criteria below it.

    A screen reader says the title, and in words what is called out.
    """
    root = _root(title or "Three views of the robot", description(picture))
    sheet = sheet_of(picture, top)
    put(root, "rect", "paper", {"width": WIDTH, "height": 0})
    titles = put(root, "g", "faint")
    for cell in sheet.cells:
        put(titles, "text", "", {"x": cell.left + 14.0, "y": cell.top + 14.0}, cell.view.title)
        _put_view(put(root, "g"), cell, picture)
    put_key(put(root, "g"), sheet, picture)
    return _sized(root, WIDTH, put_legend(root, sheet.height, picture) if legend else sheet.height)


def thumbnail_element(picture: Picture) -> Any:
    """Return a small picture of a robot: the side view without labels."""
    root = _root("The robot from its side", description(picture))
    width, height = _THUMBNAIL
    cell = next(cell for cell in sheet_of(picture).cells if cell.view is SIDE)
    group = put(root, "g")
    _put_bodies(group, cell, picture)
    for seen in outlines(picture, cell):
        put(group, "path", "reference", {"d": path_data(cell, seen.outline, closed=True)})
    root.set("viewBox", f"{cell.left:g} {cell.top:g} {cell.width:g} {cell.height:g}")
    root.set("width", f"{width:g}")
    root.set("height", f"{height:g}")
    return root


def empty_element(title: str, words: str, height: float) -> Any:
    """Return a drawing without a robot: paper of a height in pixels."""
    root = _root(title, words)
    put(root, "rect", "paper", {"width": WIDTH, "height": 0})
    return _sized(root, WIDTH, height)


def _sized(root: Any, width: float, height: float) -> Any:
    """Set the size of a drawing, and of its background, in pixels."""
    root.set("viewBox", f"0 0 {width:g} {height:.0f}")
    root.set("width", f"{width:g}")
    root.set("height", f"{height:.0f}")
    root.find(f"{{{SVG}}}rect").set("height", f"{height:.0f}")
    return root


def _root(title: str, words: str) -> Any:
    root = etree.Element(
        f"{{{SVG}}}svg", {"class": "drawing", "role": "img", "font-family": _FONT, "font-size": "12"}, nsmap=_NAMESPACES
    )
    put(root, "title", text=title)
    if words:
        put(root, "desc", text=words)
    return root


def _put_view(group: Any, cell: Cell, picture: Picture) -> None:
    labels, below, above = Labels(cell), Signs(), Signs()
    add_ground(below, cell, picture, labels)
    below.put(group)
    _put_bodies(group, cell, picture)
    add_outlines(above, cell, picture)
    add_frames(above, cell, picture, labels)
    add_wheels(above, cell, picture, labels)
    add_callouts(above, cell, picture, labels)
    above.put(group)


def _put_bodies(group: Any, cell: Cell, picture: Picture) -> None:
    """Add the shapes from back to front, then hidden edges, then visible ones."""
    shown = projection(picture.scene, cell.view)
    for seen in shown.bodies:
        body = put(group, "path", "", {"d": path_data(cell, seen.outline, closed=True), **colour(seen.body.rgba)})
        put(body, "title", text=seen.body.link)
    for strokes, attributes in ((shown.hidden, _HIDDEN), (shown.visible, {})):
        for look, some in groupby(sorted(strokes, key=_look), _look):
            path = path_data(cell, (stroke.curve for stroke in some))
            put(group, "path", look, {"d": path, **attributes})


def _look(stroke: Stroke) -> str:
    return edge_look(stroke.rgba)
