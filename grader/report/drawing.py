"""The drawing of a robot as SVG: three views at one scale, a key of the signs, and the failed criteria.

It needs no script or other file. A page that contains it adds `STYLE` to its own rules.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from textwrap import wrap

from grader.drawing.picture import Picture, picture_of, plain_picture
from grader.drawing.scene import Body
from grader.drawing.views import WIDTH, Panel, Sheet, from_back_to_front, sheet_of
from grader.grading.report import Report, Result
from grader.report.content import bonus_line, grade_line, score_text, summary
from grader.report.details import remarks_on
from grader.report.drawing_signs import Signs, ground_line, wheel_sign
from grader.report.drawing_words import description, heading, why_no_picture
from grader.report.inspection import Inspection, effect
from grader.report.svg_elements import STYLE, badge, circle, escaped, path, polygon, segment, text
from grader.text import counted_points, printable

_LEFT, _LINE, _ROW, _INDENT = 14.0, 15.0, 18.0, 26.0  # pixels
_LETTER_WIDTH = 6.8  # pixels, on average, of a font that is wider than most
_WIDTH = WIDTH - 2.0 * _LEFT
_MAX_NAME, _MAX_TITLE, _MAX_TEXT, _MAX_LINES = 60, 200, 1000, 6
_NO_SHAPES = "No visual can be drawn: only frames of links are shown."


def drawing_element(picture: Picture, title: str = "", *, legend: bool = True, above: Sequence[str] = ()) -> str:
    """Return the drawing of a robot as an SVG element; `above` are lines above it, `legend` lists the criteria below.

    Screen readers read the title, and a description of the callouts.
    """
    sheet = sheet_of(picture, _height(above) if title else 0.0)
    parts = _headline(title, above) if title else []
    parts += [f"<g>{''.join(_view(panel, picture))}</g>" for panel in sheet.panels]
    parts += _key(sheet, picture, legend=legend)
    height, below = _legend(picture, sheet.height) if legend else (sheet.height, [])
    return _svg(title or "Three views of the robot", description(picture), height, [*parts, *below])


def _svg(title: str, words: str, height: float, parts: Iterable[str]) -> str:
    size = f'width="{WIDTH:g}" height="{height:.0f}"'
    said = f"<title>{escaped(title[:_MAX_TITLE])}</title><desc>{escaped(words)}</desc>"
    start = f'<svg xmlns="http://www.w3.org/2000/svg" class="drawing" role="img" viewBox="0 0 {WIDTH:g} {height:.0f}"'
    return f'{start} {size}>{said}<rect class="paper" {size}/>{"".join(parts)}</svg>'


def _view(panel: Panel, picture: Picture) -> Iterator[str]:
    """Yield a view: the ground, the shapes from back to front, then the signs."""
    yield text("faint", (panel.left + _LEFT, panel.top + _LEFT), panel.title)
    if ground := ground_line(panel, picture):
        yield path("ground", segment(*ground))
    outlines = [
        (body, polygon(panel.outline(picture.scene, body))) for body in from_back_to_front(picture.scene, panel)
    ]
    for body, outline in outlines:
        points = outline[1:-1].replace("L", " ")
        yield f'<polygon {_looks(body)} points="{points}"><title>{escaped(body.link[:_MAX_NAME])}</title></polygon>'
    if len(outlines) > 1:  # what a shape hides shows through
        yield path("hidden", "".join(outline for _, outline in outlines))
    yield from Signs(panel, picture).all()


def _looks(body: Body) -> str:
    """Return the colour of a body, with dark edges on light colours and light edges on dark ones."""
    red, green, blue, alpha = body.rgba
    # The luminance as WCAG 2.2 defines it, with a plain gamma.
    is_dark = alpha >= 0.5 and 0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2 <= 0.18
    fill = "".join(f"{round(255.0 * value):02x}" for value in (red, green, blue))
    return f'fill="#{fill}" fill-opacity="{alpha:.2g}" stroke="{"#e8eaed" if is_dark else "#1c1f23"}"'


def _key(sheet: Sheet, picture: Picture, *, legend: bool) -> Iterator[str]:
    """Yield the scale bar, and the meaning of each sign; with a `legend` the criteria are listed below it."""
    left, top = sheet.key[0] + 8.0, sheet.key[1] + 20.0
    length, words = sheet.bar
    ends = (segment((x, top - 4.0), (x, top + 4.0)) for x in (left, left + length))
    yield path("ground", segment((left, top), (left + length, top)) + "".join(ends))
    yield text("text", (left + length + 8.0, top + 4.0), words)
    for row, (sign, meaning) in enumerate(_meanings(picture, legend=legend), 1):
        y = top + 6.0 + row * _ROW
        yield sign(left, y)
        yield text("faint", (left + 34.0, y + 4.0), meaning)


def _meanings(picture: Picture, *, legend: bool) -> Iterator[tuple[Callable[[float, float], str], str]]:
    """Yield what draws each sign of a drawing, with its meaning."""
    travels = [wheel.travel is not None for wheel in picture.scene.wheels]
    if any(callout.point is not None for callout in picture.callouts):
        yield lambda x, y: badge((x + 12.0, y), 1), f"points lost{': see below' if legend else ''}"
    if picture.outlines or picture.frames:
        yield partial(_line, "reference"), "reference solution"
    if any(travels):
        yield lambda x, y: path("arrow", wheel_sign((x - 3.0, y), (1.0, 0.0, 0.0))), "driven so by a positive rotation"
    if not all(travels):
        yield lambda x, y: path("arrow", wheel_sign((x + 12.0, y), None)), "wheel does not roll"
    yield _axes, "frame of a link: x, y, z"
    if len(picture.scene.bodies) > 1:
        yield partial(_line, "hidden"), "hidden edge"


def _line(look: str, x: float, y: float) -> str:
    return path(look, segment((x, y), (x + 26.0, y)))


def _axes(x: float, y: float) -> str:
    start = x + 6.0, y + 5.0
    lines = {"x": segment(start, (x + 20.0, y + 5.0)), "y": circle(start, 2.5), "z": segment(start, (x + 6.0, y - 9.0))}
    return "".join(path(f"axis-{name}", data) for name, data in lines.items())


def _legend(picture: Picture, top: float) -> tuple[float, list[str]]:
    """Return the failed criteria of each callout, and notes, below `top`, and where they end."""
    notes = picture.scene.missing if picture.scene.bodies else (*picture.scene.missing, _NO_SHAPES)
    if not picture.callouts and not notes:
        return top, []
    parts, y = [path("rule", segment((_LEFT, top + 8.0), (WIDTH - _LEFT, top + 8.0)))], top + 28.0
    rows = [("text", note) for note in notes]
    blocks = [
        (one.number, [("strong", heading(one)), *(("text", _loss(it)) for it in one.results)])
        for one in picture.callouts
    ]
    for number, words in (*blocks, (0, rows)):
        parts += [badge((_LEFT + 9.0, y - 4.0), number)] if number else []
        for look, line in ((look, line) for look, row in words for line in _lines(row, _WIDTH - _INDENT)):
            parts.append(text(look, (_LEFT + _INDENT, y), line))
            y += _LINE
        y += 6.0 if number else 2.0
    return y, parts


def _loss(result: Result) -> str:
    return f"{result.criterion.id} ({counted_points(result.criterion.points)}): {result.outcome.message}"


def _lines(words: str, width: float, most: int = _MAX_LINES) -> list[str]:
    """Return a text in at most some lines of a width in pixels, with a number and its unit on one line."""
    whole = re.sub(r"(?<=\d) (?=(?:m|mm|degrees)\b)", "\xa0", printable(words[:_MAX_TEXT]))
    room = max(1, int(width / _LETTER_WIDTH))
    lines = wrap(whole, room, max_lines=most, placeholder=" ...", break_on_hyphens=False)
    return [line.replace("\xa0", " ") for line in lines]


def render_svg(report: Report) -> str:
    """Return the drawing of the graded robot as a file; without a robot, a sentence with the reason."""
    words = [grade_line(report), summary(report), bonus_line(report)]
    for result in report.results:
        words += [f"{printable(result.criterion.id)}: {remark}" for remark in remarks_on(result)]
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
    above = [line for part in filter(None, words) for line in _lines(part, _WIDTH)]
    if picture is not None:
        drawn = drawing_element(picture, title, above=above)
    else:
        above += ["", *_lines(reason, _WIDTH)]
        drawn = _svg(title, reason, _height(above), _headline(title, above))
    return drawn.replace("<title>", f"<style>svg{{max-width:100%;height:auto}}{STYLE}</style><title>", 1) + "\n"


def _headline(title: str, above: Sequence[str]) -> list[str]:
    shown = [text("title", (_LEFT, 26.0), line) for line in _lines(title, _WIDTH / 1.5, 1)]
    return shown + [text("faint", (_LEFT, 2.0 * _LEFT + _LINE * number), line) for number, line in enumerate(above, 1)]


def _height(above: Sequence[str]) -> float:
    return 2.0 * _LEFT + _LINE * len(above) + 8.0
