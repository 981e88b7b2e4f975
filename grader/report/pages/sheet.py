"""The sheet of a lab: what students get of its rubric, without the reference."""

from collections.abc import Iterator
from itertools import groupby
from typing import Literal, NamedTuple

from markupsafe import Markup

from grader import __version__
from grader.base.errors import InputError
from grader.base.text import format_points, shell_quoted
from grader.lab.checks.manual import MANUAL_CHECKS
from grader.lab.rubric.criterion import Criterion, Part, worth
from grader.lab.rubric.rubric import Rubric
from grader.report.drawing.picture import plain_picture
from grader.report.drawing.three_views import STYLE, drawing_element
from grader.report.inspection import main_root
from grader.report.pages.shell import Assets, render_page
from grader.report.writers.escaped_markdown import escape_words

_SheetFormat = Literal["markdown", "html"]
_MARKDOWN = {"part": "## ", "about": "### ", "text": "", "item": "- "}


class _Block(NamedTuple):
    """A line of a sheet, in which code is between backticks."""

    kind: Literal["part", "about", "text", "item"]
    text: str


def write_sheet(rubric: Rubric, output_format: _SheetFormat, *, has_picture: bool) -> str:
    """Return the sheet of a rubric: tasks, points, what to submit, and how to check it.

    Raises InputError for a picture in Markdown, or of a rubric without a robot as reference.
    """
    blocks = list(_list_blocks(rubric))
    if output_format == "html":
        picture = _draw_reference(rubric) if has_picture else ""
        values = {
            "version": __version__,
            "title": rubric.title,
            "blocks": blocks,
            "picture": picture,
        }
        return render_page("sheet.html", values, {}, Assets("text.css", rules=STYLE))
    if has_picture:
        raise InputError("--picture is for --format html")
    lines = [f"# {escape_words(rubric.title)}"]
    for kind, items in groupby(blocks, key=lambda block: block.kind):
        lines.append("")
        lines += [f"{_MARKDOWN[kind]}{escape_words(text)}" for _, text in items]
    return "\n".join(lines) + "\n"


def _draw_reference(rubric: Rubric) -> Markup:
    """Return the drawing of the reference. Raises InputError without a robot."""
    if not rubric.solution:
        raise InputError(f"the rubric {rubric.id} has no reference: there is no picture")
    robot = rubric.solution.robot
    picture = plain_picture(robot, main_root(robot))
    assert picture  # there is a robot, with a root
    return Markup(drawing_element(picture))  # noqa: S704  our own, which escapes its texts


def _list_blocks(rubric: Rubric) -> Iterator[_Block]:
    """Yield the blocks below the title."""
    release = rubric.distro.capitalize()
    yield _Block("text", f"{worth(rubric.criteria).text}. The release of ROS 2 is {release}.")
    for part in rubric.parts:
        yield from _list_tasks(rubric, part)
    yield _Block("part", "What to submit")
    for name in filter(None, rubric.lab.package_names):
        yield _Block("item", f"The package `{name}`")
    if any(each.check.is_of_robot for each in rubric.criteria):
        yield _Block("item", f"The robot, `{rubric.urdf}`")
    for evidence in rubric.evidence:
        yield _Block("item", f"{evidence.title} (a file with `{evidence.names[0]}` in its name)")
    yield _Block("part", "Before the deadline")
    name = rubric.id if rubric.is_shipped else shell_quoted(rubric.path.name)
    yield _Block("item", "`grader inspect` in your folder says what does not fit together.")
    yield _Block(
        "item", f"`grader grade --rubric {name}` says what is missing, with file and line."
    )


def _list_tasks(rubric: Rubric, part: Part) -> Iterator[_Block]:
    """Yield what a part asks for, by its headings."""
    criteria = [each for each in rubric.criteria if each.part == part.id and each.points]
    if criteria:
        yield _Block("part", f"{part.title} ({worth(criteria).text})")
    for about, group in groupby(criteria, key=lambda criterion: criterion.about):
        if about:
            yield _Block("about", about)
        for criterion in group:
            yield _Block("item", f"{criterion.title} ({_worth_of(criterion)})")


def _worth_of(criterion: Criterion) -> str:
    by_hand = ", manual grading" if criterion.check.function in MANUAL_CHECKS else ""
    extra = " extra" if criterion.bonus else ""
    return f"{format_points(criterion.points)}{extra}{by_hand}"
