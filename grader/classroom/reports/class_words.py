"""A class in words: what the terminal and the class's page say of it."""

import unicodedata
from collections.abc import Iterator
from decimal import Decimal

from grader.base.text import counted, format_points
from grader.classroom.gradebook.statistics import ClassStatistics, Summary
from grader.classroom.gradebook.student_grade import StudentGrade

_LETTERS = str.maketrans(
    {"ł": "l", "ø": "o", "đ": "d", "æ": "ae", "œ": "oe", "ı": "i"}
)  # have no accents
EQUAL_NOTE = (
    "The same robot may differ in names, order, comments and the spelling of numbers. This "
    "is no verdict: students who"
    " follow the handout and make the same mistake have the same robot."
)
SHARE_NOTE = "Mean earned: the mean of what students earned, of the points of the criterion."


def family_name_order(name: str, key: str) -> tuple[str, str, str]:
    """Return the family name, then the name and the key.

    The family name is before a comma or the last word.
    """
    family = name.partition(",")[0] if "," in name else (name.split() or [""])[-1]
    return _letters(family), _letters(name), key


def _letters(name: str) -> str:
    """Return a name without accents, so that Öz is not after Zed."""
    apart = unicodedata.normalize("NFKD", name.casefold().translate(_LETTERS))
    return "".join(letter for letter in apart if not unicodedata.combining(letter))


def late_text(grade: StudentGrade) -> str:
    """Return the days late and the penalty; empty where they do not count."""
    penalty = f", {format_points(grade.late.points)}" if grade.late.points else ""
    if grade.late.days and not grade.has_final:
        return f"{counted(grade.late.days, 'day')}{penalty}"
    return ""


def head_lines(statistics: ClassStatistics) -> Iterator[str]:
    """Yield the lines above the figures of a class.

    They say how many students were graded and how many not, the grades in one line, what is open,
    and the sections.
    """
    words = {
        "graded": "graded",
        "unreadable": "could not be graded",
        "errored": "errored",
        "excused": "excused",
    }
    words["missing"] = "without a submission"
    counts = [
        f"{statistics.statuses[status]} {text}"
        for status, text in words.items()
        if status in statistics.statuses
    ]
    if statistics.late:
        counts.append(f"{statistics.late} late")
    yield ", ".join(counts) or "no students"
    if statistics.all:
        yield grades_text(statistics.maximum, statistics.all, is_open=bool(statistics.open))
    if statistics.open:
        verb = "needs" if statistics.open == 1 else "need"
        yield f"{counted(statistics.open, 'grade')} still {verb} manual grading"
    for name, one in statistics.sections.items():
        yield (
            f"Section {name or '(none)'}: {_means(one.mean, one.median)} "
            f"({counted(one.students, 'student')})"
        )


def grades_text(maximum: Decimal, figures: Summary, *, is_open: bool) -> str:
    """Return the mean and the median of the grades.

    Those that are open count with the points so far.
    """
    so_far = " so far" if is_open else ""
    return f"Grades of {format_points(maximum)}{so_far}: {_means(figures.mean, figures.median)}"


def _means(mean: Decimal | float, median: Decimal | float) -> str:
    """Return a mean and a median to one decimal."""
    return f"mean {mean:.1f}, median {median:.1f}"


def span(statistics: ClassStatistics, tenth: int) -> str:
    """Return the grades of a tenth of the maximum: "10 to 20"."""
    step = statistics.maximum / len(statistics.tenths)
    return f"{format_points(step * tenth)} to {format_points(step * (tenth + 1))}"


def percent(share: float) -> str:
    """Return a share in percent, not rounded up to 100 % or down to 0 %."""
    if share in (0, 1):
        return f"{share:.0%}"
    return f"{min(99, max(1, round(100 * share)))}%"
