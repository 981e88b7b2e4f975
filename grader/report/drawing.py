"""The drawing of a robot as an SVG element: three views at one scale, a key of the signs, and what is called out.

The element needs no style sheet, script or other file. A page that has it inside adds `DARK_RULES` for dark mode.
"""

from itertools import groupby
from statistics import median
from typing import Any

from lxml import etree

from grader.drawing.labels import Labels
from grader.drawing.picture import Picture
from grader.drawing.projection import Projection, Stroke, projection
from grader.drawing.sheet import WIDTH, Cell, framed_links, sheet_of, single_cell
from grader.drawing.views import SIDE, View
from grader.report.callouts import description
from grader.report.drawing_key import put_key, put_legend
from grader.report.drawing_signs import Signs, add_callouts, add_frames, add_ground, add_outlines, add_wheels
from grader.report.svg_elements import SVG, circle, colour, edge_look, path_data, put

_FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', Arial, sans-serif"
_RING = 8.0  # pixels
_THUMBNAIL = (240.0, 150.0)  # pixels
_MARGIN = 16.0
_THICKNESS = 0.05  # of an edge, as a share of the size of a shape
_THIN, _THICK = 0.3, 1.3  # pixels
_HIDDEN = 0.7  # of the thickness of a visible edge
_MAX_NAME, _MAX_TITLE = 60, 200  # characters
_CROWDED = "So many shapes overlap that edges behind others are drawn as if they were in front."
_NO_SHAPES = "There is no visual that can be drawn: only frames of links are shown."
_NAMESPACES: Any = {None: SVG}  # a default namespace, which the types do not know


def drawing_element(picture: Picture, title: str = "", top: float = 0.0, *, legend: bool = True) -> Any:
    """Return the drawing of a robot, with `top` pixels left free above it; `legend` lists the criteria below it.

    A screen reader says the title, and in words what is called out.
    """
    root = _root(title or "Three views of the robot", description(picture))
    sheet = sheet_of(picture, top)
    put(root, "rect", "paper", {"width": WIDTH, "height": 0})
    titles = put(root, "g", "faint")
    notes = picture.scene.missing if picture.scene.bodies else (*picture.scene.missing, _NO_SHAPES)
    for cell in sheet.cells:
        put(titles, "text", "", {"x": cell.left + 14.0, "y": cell.top + 14.0}, cell.view.title)
        if not _put_view(put(root, "g"), cell, picture):
            notes = (*picture.scene.missing, _CROWDED)  # said once
    put_key(put(root, "g"), sheet, picture, legend=legend)
    return _sized(root, WIDTH, put_legend(root, sheet.height, picture.callouts, notes) if legend else sheet.height)


def thumbnail_element(picture: Picture, view: View = SIDE) -> Any:
    """Return a small picture of a robot: one view, where shapes and frames of the reference differ, and the way the wheels drive.

    Rings mark links that are called out for another reason.
    """
    root = _root(f"The robot in the {view.title} view", description(picture))
    cell = single_cell(picture, view, *_THUMBNAIL, _MARGIN)
    labels, above, group = Labels(cell), Signs(), put(root, "g")
    _put_bodies(group, cell, projection(picture.scene, view))
    add_ground(above, cell, picture, labels)
    add_outlines(above, cell, picture, labels)
    add_frames(above, cell, picture, labels, [link for link in picture.frames if link in picture.scene.poses])
    add_wheels(above, cell, picture, labels)
    shown = {
        *picture.frames,
        *(body.link for body in picture.outlines),
        *(wheel.link for wheel in picture.scene.wheels),
    }
    for callout in picture.callouts:
        if callout.point is not None and callout.link not in shown:
            above.line("leader", circle(cell.place(callout.point), _RING))
    above.put(group)
    return _sized(root, *_THUMBNAIL)


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
    for paper in root.iterfind(f"{{{SVG}}}rect"):
        paper.set("height", f"{height:.0f}")
    return root


def _root(title: str, words: str) -> Any:
    root = etree.Element(
        f"{{{SVG}}}svg", {"class": "drawing", "role": "img", "font-family": _FONT, "font-size": "12"}, nsmap=_NAMESPACES
    )
    put(root, "title", text=title[:_MAX_TITLE])
    if words:
        put(root, "desc", text=words)
    return root


def _put_view(group: Any, cell: Cell, picture: Picture) -> bool:
    """Add a view, and return whether its hidden edges are known."""
    labels, below, above = Labels(cell), Signs(), Signs()
    add_ground(below, cell, picture, labels)
    below.put(group)
    shown = projection(picture.scene, cell.view)
    _put_bodies(group, cell, shown)
    add_outlines(above, cell, picture, labels)
    add_frames(above, cell, picture, labels, framed_links(picture))
    add_wheels(above, cell, picture, labels)
    add_callouts(above, cell, picture, labels)
    above.put(group)
    return shown.is_complete


def _put_bodies(group: Any, cell: Cell, shown: Projection) -> None:
    """Add the shapes from back to front, then hidden edges, then visible ones; thinner where the shapes are small."""
    for seen in shown.bodies:
        body = put(group, "path", "", {"d": path_data(cell, seen.outline, closed=True), **colour(seen.body.rgba)})
        put(body, "title", text=seen.body.link[:_MAX_NAME])
    sizes = [cell.scale * max(high - low for low, high in seen.extents) for seen in shown.bodies]
    width = min(max(median(sizes or [0.0]) * _THICKNESS, _THIN), _THICK)
    hidden = {"stroke-width": width * _HIDDEN, "stroke-opacity": "0.5"}
    for strokes, attributes in ((shown.hidden, hidden), (shown.visible, {"stroke-width": width})):
        for look, some in groupby(sorted(strokes, key=_look), _look):
            path = path_data(cell, (stroke.curve for stroke in some))
            put(group, "path", look, {"d": path, **attributes})


def _look(stroke: Stroke) -> str:
    return edge_look(stroke.rgba)
