"""The drawing of a robot as SVG: three views at one scale, a key of the signs, and the failed criteria.

It needs no script or other file. A page that contains it adds `STYLE` of `signs.py` to its own rules.
"""

import re
from collections.abc import Iterable, Sequence
from textwrap import wrap

from grader.drawing.picture import Callout, Picture, picture_of, plain_picture
from grader.drawing.views import WIDTH, panels_of
from grader.grading.report import Report, Result
from grader.report.content import bonus_line, grade_line, score_text, summary
from grader.report.criteria import points_of
from grader.report.details import remarks_on
from grader.report.inspection import Inspection, effect
from grader.report.signs import STYLE, badge, escaped, key, path, segment, text, view
from grader.submission.urdf import Absent
from grader.text import counted_points, enumerated, printable

_LEFT, _LINE, _INDENT = 14.0, 15.0, 26.0  # pixels
_LETTER_WIDTH = 6.8  # pixels, on average, of a font that is wider than most
_WIDTH = WIDTH - 2.0 * _LEFT
_MAX_TITLE, _MAX_TEXT, _MAX_LINES = 200, 1000, 6
_NO_SHAPES = "No visual can be drawn: only frames of links are shown."


def drawing_element(picture: Picture, title: str = "", *, legend: bool = True, above: Sequence[str] = ()) -> str:
    """Return the drawing of a robot as an SVG element; `above` are lines above it, `legend` lists the criteria below.

    Screen readers read the title, and a description of the callouts.
    """
    panels = panels_of(picture, _height(above) if title else 0.0)
    parts = _headline(title, above) if title else []
    parts += [f"<g>{''.join(view(panel, picture))}</g>" for panel in panels]
    parts += key(picture, panels[0].top)
    height = panels[-1].top + panels[-1].height
    height, below = _legend(picture, height) if legend else (height, [])
    return _svg(title or "Three views of the robot", _description(picture), height, [*parts, *below])


def _svg(title: str, words: str, height: float, parts: Iterable[str]) -> str:
    size = f'width="{WIDTH:g}" height="{height:.0f}"'
    said = f"<title>{escaped(title[:_MAX_TITLE])}</title><desc>{escaped(words)}</desc>"
    start = f'<svg xmlns="http://www.w3.org/2000/svg" class="drawing" role="img" viewBox="0 0 {WIDTH:g} {height:.0f}"'
    return f'{start} {size}>{said}<rect class="paper" {size}/>{"".join(parts)}</svg>'


def _legend(picture: Picture, top: float) -> tuple[float, list[str]]:
    """Return the failed criteria of each callout, and notes, below `top`, and where they end."""
    notes = picture.scene.missing if picture.scene.bodies else (*picture.scene.missing, _NO_SHAPES)
    if not picture.callouts and not notes:
        return top, []
    parts, y = [path("rule", segment((_LEFT, top + 8.0), (WIDTH - _LEFT, top + 8.0)))], top + 28.0
    blocks = [(one.number, [_heading(one), *map(_loss, one.results)]) for one in picture.callouts]
    for count, rows in (*blocks, (0, notes)):
        parts += [badge((_LEFT + 9.0, y - 4.0), count)] if count else []
        for index, line in ((at, line) for at, row in enumerate(rows) for line in _lines(row, _WIDTH - _INDENT)):
            parts.append(text("text" if index or not count else "strong", (_LEFT + _INDENT, y), line))
            y += _LINE
        y += 6.0
    return y, parts


def _heading(callout: Callout) -> str:
    """Return the link of a callout, the lost points, and a remark if it is not in the picture."""
    words = f"{callout.link or 'The robot'}: {points_of(callout.results)} lost"
    return words if callout.point is not None else f"{words} (not in the picture)"


def _loss(result: Result) -> str:
    return f"{result.criterion.id} ({counted_points(result.criterion.points)}): {result.outcome.message}"


def _description(picture: Picture) -> str:
    """Return a description of the callouts of a picture, and of what it does not show."""
    called = [
        f"{callout.number}: {_heading(callout)}, {enumerated([result.criterion.id for result in callout.results])}."
        for callout in picture.callouts
    ]
    return printable(" ".join((*called, *picture.scene.missing)))


def _lines(words: str, width: float) -> list[str]:
    """Return a text in lines of a width in pixels, with a number and its unit on one line; of a long text the first."""
    whole = re.sub(r"(?<=\d) (?=(?:m|mm|degrees)\b)", "\xa0", printable(words[:_MAX_TEXT]))
    lines = wrap(whole, int(width / _LETTER_WIDTH), max_lines=_MAX_LINES, placeholder=" ...", break_on_hyphens=False)
    return [line.replace("\xa0", " ") for line in lines]


def why_no_picture(report: Report) -> str:
    """Return why a report has no picture of the robot."""
    submission = report.submission
    urdf = submission.originals.urdf if submission.originals is not None else Absent()
    if submission.has_urdf and isinstance(urdf, Absent):
        return "No picture: the submission has changed or moved since it was graded."
    if submission.robot is None or not submission.robot.links:
        return "No picture: no robot could be read from the submission."
    return "No picture: no link of the robot has a pose."


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
    shown = [text("title", (_LEFT, 26.0), line) for line in _lines(title, _WIDTH / 1.5)[:1]]
    return shown + [text("faint", (_LEFT, 2.0 * _LEFT + _LINE * number), line) for number, line in enumerate(above, 1)]


def _height(above: Sequence[str]) -> float:
    return 2.0 * _LEFT + _LINE * len(above) + 8.0
