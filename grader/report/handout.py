"""A rubric as Markdown for the lab's handout: what is examined and what it is worth, without arguments, feedback and answers."""

from collections.abc import Iterator, Sequence

from grader.checks.manual import MANUAL_CHECKS
from grader.grading.criterion import Criterion
from grader.grading.rubric import Part, Rubric
from grader.grading.worth import worth
from grader.report.markdown_text import code, escaped
from grader.text import printable

_EXAMINED = {
    "urdf": "The URDF is examined.",
    "package": "The ROS 2 package is examined.",
    "files": "All submitted files are examined.",
}


def render_handout(rubric: Rubric) -> str:
    """Return the parts of a rubric, each with a table of its criteria and their points."""
    blocks = [f"# {_text(rubric.title)}", f"{worth(rubric.criteria).text} in total."]
    for part in rubric.parts:
        criteria = [criterion for criterion in rubric.criteria if criterion.part == part.id]
        if criteria:
            blocks += _part(part, criteria)
    return "\n\n".join(blocks) + "\n"


def _part(part: Part, criteria: Sequence[Criterion]) -> Iterator[str]:
    yield f"## {_text(part.title)} ({worth(criteria).text})"
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
    adjusted = f" *({_text(criterion.adjustment.message)})*" if criterion.adjustment is not None else ""
    return [name, about, _text(criterion.title) + manual + adjusted, worth((criterion,)).short]


def _text(text: str) -> str:
    return escaped(printable(" ".join(text.split())))
