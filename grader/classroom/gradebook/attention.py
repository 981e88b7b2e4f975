"""The students who need attention, and why."""

from typing import NamedTuple

from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.student_grade import Reason

_MAY_NEED_ATTENTION = (
    "((verdict <> 'graded' OR faults OR rubric <> ? OR removed_marks <> '') AND final IS NULL AND NOT is_excused)"
    " OR older_marks || revalued_marks || over_marks <> '' OR is_gone OR is_on_roster = 0 OR final_is_older"
)


class AttentionItem(NamedTuple):
    """A student who needs attention, with what distinguishes this case from others with the same reason."""

    key: str
    name: str
    detail: str


class AttentionGroup(NamedTuple):
    """The students who need attention for one reason, in the order of their keys."""

    reason: str
    items: tuple[AttentionItem, ...]


class Attention(NamedTuple):
    """The groups, the most urgent first, and the number of students in them: one may be in several groups."""

    groups: tuple[AttentionGroup, ...]
    total: int


def attention(grades: Grades) -> Attention:
    """Return who needs attention: no readable submission, a fault of the grader, a possibly outdated grade or mark."""
    newest = grades.newest_rubric().sha256
    found: dict[Reason, list[AttentionItem]] = {reason: [] for reason in Reason}
    total = 0
    for grade in grades.where(_MAY_NEED_ATTENTION, newest):
        total += 1
        for reason, detail in grade.concerns:
            found[reason].append(AttentionItem(grade.student.key, grade.student.name, detail))
    groups = (AttentionGroup(reason.value, tuple(items)) for reason, items in found.items() if items)
    return Attention(tuple(groups), total)
