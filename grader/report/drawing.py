"""The drawing of a robot as an SVG element, and as the file of a report: three views at one scale, a key of the signs.

The element needs no style sheet, script or other file. A page that contains it adds `DARK_RULES` for dark mode.
"""

from collections.abc import Iterable, Sequence
from statistics import median
from typing import Any

from lxml import etree

from grader.drawing.curves import Curve, Edge, inner_edges
from grader.drawing.picture import Picture, picture_of, plain_picture
from grader.drawing.sheet import WIDTH, Panel, Seen, framed_links, projection, sheet_of, with_fronts
from grader.grading.report import Report
from grader.report.content import bonus_line, grade_line, score_text, summary
from grader.report.details import remarks_on
from grader.report.drawing_key import description, put_key, put_legend, why_no_picture
from grader.report.drawing_signs import ViewSigns
from grader.report.inspection import Inspection, effect
from grader.report.svg_elements import DARK_RULES, LINE, SVG, colour, edge_look, path_data, put, put_lines, wrap
from grader.text import printable

_FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', Arial, sans-serif"
_THICKNESS = 0.05  # of an edge, as a share of the size of a shape
_THIN, _THICK = 0.3, 1.3  # pixels
_HIDDEN = 0.7  # of the thickness of a visible edge
_MAX_NAME, _MAX_TITLE = 60, 200  # characters
_NO_SHAPES = "No visual can be drawn: only frames of links are shown."
_NAMESPACES: Any = {None: SVG}  # a default namespace, which the types do not know


def drawing_element(picture: Picture, title: str = "", top: float = 0.0, *, legend: bool = True) -> Any:
    """Return the drawing of a robot, with `top` pixels left free above it; `legend` lists the criteria below it.

    Screen readers read the title, and a description of the callouts.
    """
    root = _root(title or "Three views of the robot", description(picture))
    sheet = sheet_of(picture, top)
    titles = put(root, "g", "faint")
    notes = picture.scene.missing if picture.scene.bodies else (*picture.scene.missing, _NO_SHAPES)
    for panel in sheet.panels:
        put(titles, "text", "", {"x": panel.left + 14.0, "y": panel.top + 14.0}, panel.view.title)
        _put_view(put(root, "g"), panel, picture)
    put_key(put(root, "g"), sheet, picture, legend=legend)
    return _set_size(root, WIDTH, put_legend(root, sheet.height, picture.callouts, notes) if legend else sheet.height)


def _set_size(root: Any, width: float, height: float) -> Any:
    """Set the size of a drawing, and of its background, in pixels."""
    root.set("viewBox", f"0 0 {width:g} {height:.0f}")
    root.set("width", f"{width:g}")
    root.set("height", f"{height:.0f}")
    for paper in root.iterfind(f"{{{SVG}}}rect"):
        paper.set("height", f"{height:.0f}")
    return root


def _root(title: str, words: str) -> Any:
    """Return the root of a drawing, without its size."""
    looks = {"class": "drawing", "role": "img", "font-family": _FONT, "font-size": "12"}
    root = etree.Element(f"{{{SVG}}}svg", looks, nsmap=_NAMESPACES)
    put(root, "title", text=title[:_MAX_TITLE])
    if words:
        put(root, "desc", text=words)
    put(root, "rect", "paper", {"width": WIDTH, "height": 0})
    return root


def _put_view(group: Any, panel: Panel, picture: Picture) -> None:
    signs = ViewSigns(panel, picture)
    signs.add_ground()
    signs.put(group)
    _put_bodies(group, panel, projection(picture.scene, panel.view))
    _add_robot_signs(signs, framed_links(picture))
    signs.add_callouts()
    signs.put(group)


def _add_robot_signs(signs: ViewSigns, framed: Iterable[str]) -> None:
    signs.add_outlines()
    signs.add_frames(framed)
    signs.add_wheels()
    signs.add_letters()


def _put_bodies(group: Any, panel: Panel, bodies: Sequence[Seen]) -> None:
    """Add the shapes from back to front, then lighter the edges that others hide. Small shapes have thinner edges."""
    sizes = [panel.scale * max(high - low for low, high in seen.extents) for seen in bodies]
    width = min(max(median(sizes or [0.0]) * _THICKNESS, _THIN), _THICK)
    hidden: dict[str, list[Curve]] = {}
    for seen, fronts in with_fronts(bodies):
        inner = inner_edges(seen.body.shape, seen.pose)
        _put_body(group, panel, seen, inner, width)
        # What may be hidden is drawn again, whole, in the look for the colour of the shape that is around it.
        covered = [*(seen.outline if fronts else ()), *(it.curve for it in inner if fronts or not it.faces_viewer)]
        for curve, extents in ((curve, curve.extents()) for curve in covered):
            around = next((other for other in fronts if other.encloses(extents)), seen)
            hidden.setdefault(edge_look(around.body.rgba), []).append(curve)
    for look, curves in sorted(hidden.items()):
        d = path_data(panel, curves)
        put(group, "path", look, {"d": d, "stroke-width": width * _HIDDEN, "stroke-opacity": "0.5"})


def _put_body(group: Any, panel: Panel, seen: Seen, inner: Sequence[Edge], width: float) -> None:
    """Add a shape with its visible edges."""
    look, looks = edge_look(seen.body.rgba), {"stroke-width": width}
    d = path_data(panel, seen.outline, closed=True)
    body = put(group, "path", look, {"d": d, **colour(seen.body.rgba), **looks})
    put(body, "title", text=seen.body.link[:_MAX_NAME])
    # The inner edges have a path of their own: in that of the outline they would make holes in what it fills.
    if visible := path_data(panel, (edge.curve for edge in inner if edge.faces_viewer)):
        put(group, "path", look, {"d": visible, **looks})


_STYLE = f"svg{{max-width:100%;height:auto}}@media screen and (prefers-color-scheme:dark){{{DARK_RULES}}}"
_LEFT, _TITLE = 14.0, 28.0  # pixels
_WIDTH = WIDTH - 2.0 * _LEFT


def render_svg(report: Report) -> str:
    """Return the drawing of the graded robot as a file; without a robot, a sentence with the reason."""
    words = [grade_line(report), summary(report), bonus_line(report)]
    for result in report.results:
        words += [f"{printable(result.criterion.id)}: {remark}" for remark in remarks_on(result, report)]
    return _file(picture_of(report), f"{report.rubric.title}: {score_text(report)}", words, why_no_picture(report))


def inspection_svg(inspection: Inspection) -> str:
    """Return the drawing of an inspected robot as a file, with its joints at the given positions."""
    robot = inspection.robot
    picture = plain_picture(robot, inspection.relative_to)
    name = robot.robot.name if robot is not None else inspection.path
    positions = ", ".join(f"{joint} = {position}" for joint, position in robot.positions.items()) if robot else ""
    words = f"{inspection.path}: {effect(inspection)}{f'; {positions}' if positions else ''}"
    return _file(picture, name or inspection.path, (words,), "No picture: no robot could be read from the file.")


def _file(picture: Picture | None, title: str, words: Iterable[str], reason: str) -> str:
    lines = [line for text in filter(None, words) for line in wrap(text, _WIDTH)]
    lines += [] if picture is not None else ["", *wrap(reason, _WIDTH)]
    top = _TITLE + LINE * len(lines) + 8.0
    empty = _set_size(_root(title, reason), WIDTH, top)
    root = drawing_element(picture, title, top) if picture is not None else empty
    put_lines(put(root, "g", "title"), _LEFT, _TITLE - 2.0, _WIDTH / 1.5, title, 1)
    faint = put(root, "g", "faint")
    for number, line in enumerate(lines, 1):
        put(faint, "text", "", {"x": _LEFT, "y": _TITLE + LINE * number}, line)
    style = etree.Element(f"{{{SVG}}}style")
    style.text = _STYLE
    root.find(f"{{{SVG}}}rect").addprevious(style)
    return etree.tostring(root, encoding="unicode") + "\n"
