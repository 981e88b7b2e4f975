"""The drawing of a robot as SVG: three views at one scale, a key of the signs, and the failed criteria.

It needs no script or other file. A page that contains it adds `STYLE` to its own rules.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from textwrap import wrap

from grader.drawing.picture import Callout, Picture, picture_of, plain_picture
from grader.drawing.views import WIDTH, Panel, Sheet, from_back_to_front, lifted_ground, sheet_of
from grader.grading.report import Report
from grader.report.content import bonus_line, grade_line, score_text, summary
from grader.report.details import remarks_on
from grader.report.drawing_signs import Signs, wheel_sign
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
    shown = title or "Three views of the robot"
    sheet = sheet_of(picture, _height(above) if title else 0.0)
    parts = [f"<g>{''.join(_view(panel, picture))}</g>" for panel in sheet.panels]
    parts += _key(sheet, picture, legend=legend)
    height = sheet.height
    if legend:
        notes = picture.scene.missing if picture.scene.bodies else (*picture.scene.missing, _NO_SHAPES)
        height, below = _legend(sheet.height, picture.callouts, notes)
        parts += below
    return _svg(shown, description(picture), height, [*(_headline(title, above) if title else ()), *parts])


def _svg(title: str, words: str, height: float, parts: Iterable[str]) -> str:
    size = f'viewBox="0 0 {WIDTH:g} {height:.0f}" width="{WIDTH:g}" height="{height:.0f}"'
    said = f"<title>{escaped(title[:_MAX_TITLE])}</title><desc>{escaped(words)}</desc>"
    paper = f'<rect class="paper" width="{WIDTH:g}" height="{height:.0f}"/>'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="drawing" role="img" {size}>{said}{paper}{"".join(parts)}</svg>'
    )


def _view(panel: Panel, picture: Picture) -> Iterator[str]:
    """Yield a view: the ground, the shapes from back to front, then the signs."""
    yield text("faint", (panel.left + _LEFT, panel.top + _LEFT), panel.title)
    signs = Signs(panel, picture)
    yield from signs.grounds()
    outlines = [(body, panel.outline(picture.scene, body)) for body in from_back_to_front(picture.scene, panel)]
    for body, corners in outlines:
        red, green, blue, alpha = body.rgba
        # As WCAG 2.2 defines it, with a plain gamma: dark edges on light colours, light edges on dark ones.
        is_dark = alpha >= 0.5 and 0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2 <= 0.18
        fill = "".join(f"{round(255.0 * value):02x}" for value in (red, green, blue))
        looks = f'fill="#{fill}" fill-opacity="{alpha:.2g}" stroke="{"#e8eaed" if is_dark else "#1c1f23"}"'
        name = escaped(body.link[:_MAX_NAME])
        yield f'<polygon {looks} points="{polygon(corners)[1:-1].replace("L", " ")}"><title>{name}</title></polygon>'
    if len(outlines) > 1:  # what a shape hides shows through
        yield path("hidden", "".join(polygon(corners) for _, corners in outlines))
    yield from signs.all()


def _key(sheet: Sheet, picture: Picture, *, legend: bool) -> Iterator[str]:
    """Yield the scale bar, and the meaning of each sign; with a `legend` the criteria are listed below it."""
    left, top = sheet.key[0] + 8.0, sheet.key[1] + 20.0
    length, words = sheet.bar
    ends = (segment((x, top - 4.0), (x, top + 4.0)) for x in (left, left + length))
    yield path("ground", segment((left, top), (left + length, top)) + "".join(ends))
    yield text("text", (left + length + 8.0, top + 4.0), words)
    for row, (look, meaning) in enumerate(_meanings(picture, legend=legend), 1):
        x, y = left, top + 6.0 + row * _ROW
        yield _sign(look, x, y)
        yield text("faint", (x + 34.0, y + 4.0), meaning)


def _meanings(picture: Picture, *, legend: bool) -> Iterator[tuple[str, str]]:
    """Yield the signs of a drawing with their meanings."""
    travels = [wheel.travel is not None for wheel in picture.scene.wheels]
    if any(callout.point is not None for callout in picture.callouts):
        yield "badge", f"points lost{': see below' if legend else ''}"
    if picture.outlines or picture.frames or lifted_ground(picture) is not None:
        yield "reference", "reference solution"
    if any(travels):
        yield "arrow", "driving direction, positive turn"
    if not all(travels):
        yield "slash", "wheel does not roll"
    yield "axes", "frame of a link: x, y, z"
    if len(picture.scene.bodies) > 1:
        yield "hidden", "hidden edge"


def _sign(look: str, x: float, y: float) -> str:
    match look:
        case "badge":
            return badge((x + 12.0, y), 1)
        case "arrow":
            return path("arrow", wheel_sign((x - 3.0, y), (1.0, 0.0, 0.0)))
        case "slash":
            return path("arrow", wheel_sign((x + 12.0, y), None))
        case "axes":
            ends = (("x", segment((x + 6.0, y + 5.0), (x + 20.0, y + 5.0))), ("y", circle((x + 6.0, y + 5.0), 2.5)))
            lines = (*ends, ("z", segment((x + 6.0, y + 5.0), (x + 6.0, y - 9.0))))
            return "".join(path(f"axis-{name}", data) for name, data in lines)
    return path(look, segment((x, y), (x + 26.0, y)))


def _legend(top: float, callouts: Sequence[Callout], notes: Sequence[str]) -> tuple[float, list[str]]:
    """Return the failed criteria of each callout, and notes, below `top`, and where they end."""
    if not callouts and not notes:
        return top, []
    parts = [path("rule", segment((_LEFT, top + 8.0), (WIDTH - _LEFT, top + 8.0)))]
    left, y = _LEFT + _INDENT, top + 28.0
    for callout in callouts:
        parts.append(badge((_LEFT + 9.0, y - 4.0), callout.number))
        lost = [
            f"{result.criterion.id} ({counted_points(result.criterion.points)}): {result.outcome.message}"
            for result in callout.results
        ]
        for look, words in (("strong", heading(callout)), *(("text", words) for words in lost)):
            some = _lines(words, WIDTH - _LEFT - left)
            parts += (text(look, (left, y + n * _LINE), line) for n, line in enumerate(some))
            y += _LINE * len(some)
        y += 6.0
    for line in (line for note in notes for line in _lines(note, WIDTH - _LEFT - left)):
        parts.append(text("text", (left, y), line))
        y += _LINE
    return y + 2.0, parts


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
    start, rest = drawn.split("<title>", 1)
    return f"{start}<style>svg{{max-width:100%;height:auto}}{STYLE}</style><title>{rest}\n"


def _headline(title: str, above: Sequence[str]) -> list[str]:
    shown = _lines(title, _WIDTH / 1.5, 1)
    lines = [text("faint", (_LEFT, 2.0 * _LEFT + _LINE * number), line) for number, line in enumerate(above, 1)]
    return [*(text("title", (_LEFT, 26.0), line) for line in shown), *lines]


def _height(above: Sequence[str]) -> float:
    return 2.0 * _LEFT + _LINE * len(above) + 8.0
