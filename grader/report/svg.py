"""The drawing of a robot as SVG: three views at one scale, a key of the signs, and the failed criteria.

It needs no script or other file. A page that contains it adds `STYLE` of `signs.py` to its own rules.
"""

from collections.abc import Iterable, Sequence
from textwrap import wrap

from grader.grading.report import Report
from grader.report.content import bonus_line, grade_line, notes, score_text, summary
from grader.report.criteria import points_of
from grader.report.details import remarks_on
from grader.report.drawing.picture import Picture, picture_of, plain_picture
from grader.report.drawing.views import WIDTH, panels_of
from grader.report.inspection import Inspection, effect
from grader.report.signs import STYLE, escaped, key, text, view
from grader.text import enumerated, printable

_LEFT, _LINE = 14.0, 15.0  # pixels
_LETTER_WIDTH = 6.8  # pixels, on average, of a font that is wider than most
_WIDTH = WIDTH - 2.0 * _LEFT
_MAX_TITLE, _MAX_TEXT, _MAX_LINES = 200, 1000, 6
NO_PICTURE = "No picture: no robot can be read."
_NO_SHAPES = "No visual can be drawn: only frames of links are shown."


def drawing_element(picture: Picture, title: str = "", *, legend: bool = True, above: Sequence[str] = ()) -> str:
    """Return the drawing of a robot as an SVG element; `above` are lines above it, `legend` lists the callouts below.

    Screen readers read the title and the same list.
    """
    panels = panels_of(picture, _height(above) if title else 0.0)
    parts = _headline(title, above) if title else []
    parts += [f"<g>{''.join(view(panel, picture))}</g>" for panel in panels]
    parts += key(picture, panels[0].top)
    height, words = panels[-1].top + panels[-1].height, _words(picture)
    lines = [line for part in words if legend for line in _lines(part, _WIDTH)]
    parts += [text("text", (_LEFT, height + _LINE * number), line) for number, line in enumerate(lines, 1)]
    below = _LINE * len(lines) + 6.0 if lines else 0.0
    return _svg(title or "Three views of the robot", " ".join(words), height + below, parts)


def _svg(title: str, words: str, height: float, parts: Iterable[str]) -> str:
    size = f'width="{WIDTH:g}" height="{height:.0f}"'
    said = f"<title>{escaped(title[:_MAX_TITLE])}</title><desc>{escaped(words)}</desc>"
    start = f'<svg xmlns="http://www.w3.org/2000/svg" class="drawing" role="img" viewBox="0 0 {WIDTH:g} {height:.0f}"'
    return f'{start} {size}>{said}<rect class="paper" {size}/>{"".join(parts)}</svg>'


def _words(picture: Picture) -> list[str]:
    """Return what each callout of a picture is about, and what is not shown."""
    called = [
        f"{one.number}: {one.link or 'the robot'}: {points_of(one.results)} lost"
        f"{' (not in the picture)' * (one.point is None)}, {enumerated([it.criterion.id for it in one.results])}."
        for one in picture.callouts
    ]
    return [*map(printable, (*called, *picture.scene.missing, *([] if picture.scene.bodies else [_NO_SHAPES])))]


def _lines(words: str, width: float) -> list[str]:
    """Return a text in lines of a width in pixels; of a long text the first."""
    text, most = printable(words[:_MAX_TEXT]), int(width / _LETTER_WIDTH)
    return wrap(text, most, max_lines=_MAX_LINES, placeholder=" ...", break_on_hyphens=False)


def render_svg(report: Report) -> str:
    """Return the drawing of the graded robot as a file; without a robot, a sentence with the reason."""
    words = [grade_line(report), summary(report), bonus_line(report)]
    words += notes(report)[: bool(report.submission.another_robot)]
    for result in report.results:
        words += [f"{printable(result.criterion.id)}: {remark}" for remark in remarks_on(result)]
    return _file(picture_of(report), f"{report.rubric.title}: {score_text(report)}", words, NO_PICTURE)


def inspection_svg(inspection: Inspection) -> str:
    """Return the drawing of an inspected robot as a file, with its joints at the given positions."""
    robot = inspection.robot
    picture = plain_picture(robot, inspection.relative_to)
    name = robot.robot.name if robot is not None else inspection.path
    positions = ", ".join(f"{joint} = {position}" for joint, position in robot.positions.items()) if robot else ""
    words = f"{inspection.path}: {effect(inspection)}{f'; {positions}' if positions else ''}"
    return _file(picture, name or inspection.path, (words,), NO_PICTURE)


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
