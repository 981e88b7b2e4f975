"""A rubric as Markdown for the lab's handout: what is examined and what it is worth, without arguments, feedback and answers."""

from collections.abc import Iterator, Sequence
from decimal import Decimal

from grader.checks.manual import MANUAL_CHECKS
from grader.grading.criterion import Criterion
from grader.grading.rubric import Part, Rubric
from grader.report.markdown_text import code, escaped
from grader.text import counted_points, format_points, printable

_EXAMINED = {
    "urdf": "The URDF is examined.",
    "package": "The ROS 2 package is examined.",
    "files": "All submitted files are examined.",
}


def render_handout(rubric: Rubric) -> str:
    """Return the parts of a rubric, each with a table of its criteria and their points."""
    blocks = [f"# {_text(rubric.title)}", f"{counted_points(rubric.points)} in total."]
    for part in rubric.parts:
        criteria = [criterion for criterion in rubric.criteria if criterion.part == part.id]
        if criteria:
            blocks += _part(part, criteria)
    return "\n\n".join(blocks) + "\n"


def _part(part: Part, criteria: Sequence[Criterion]) -> Iterator[str]:
    points = sum((criterion.points for criterion in criteria), Decimal(0))
    yield f"## {_text(part.title)} ({counted_points(points)})"
    yield _EXAMINED[part.needs]
    rows = [["criterion", "about", "what should be true", "points"], ["---", "---", "---", "---:"]]
    rows += map(_row, criteria, [None, *criteria])
    columns = [0, 1, 2, 3] if any(criterion.about for criterion in criteria) else [0, 2, 3]
    yield "\n".join(f"| {' | '.join(row[column] for column in columns)} |" for row in rows)


def _row(criterion: Criterion, before: Criterion | None) -> list[str]:
    """Return the cells of a criterion; its heading only where the one before has another."""
    name = code(printable(criterion.id)).replace("|", "\\|")
    about = "" if before is not None and before.about == criterion.about else _text(criterion.about)
    manual = " *(graded manually)*" if criterion.check.function in MANUAL_CHECKS else ""
    return [name, about, _text(criterion.title) + manual, format_points(criterion.points)]


def _text(text: str) -> str:
    return escaped(printable(" ".join(text.split())))
