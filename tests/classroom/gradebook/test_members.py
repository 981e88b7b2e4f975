"""The students behind each figure of a class are as many as the figure says."""

from collections import Counter
from decimal import Decimal
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import criterion_of
from grader.classroom.gradebook.statistics import members, statistics
from tests.classroom.gradebooks import graded_as, lab, mark, record_run

SIGNS = {"anna": "ppppp", "ben": "fpfpf", "cleo": "pfp?p", "dora": "??pp?", "finn": "fpf?p"}


def test_members_add_up_to_the_statistics(tmp_path: Path) -> None:
    """Also with manual marks that give or take points, and with grades that do not count."""
    rubric = lab()
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, rubric, [graded_as(rubric, key, signs) for key, signs in SIGNS.items()])
        grades = Grades(book)
        for key, name, points in (("ben", "loads", "3"), ("cleo", "essay", "1"), ("finn", "tall", "0.5")):
            mark(book, grades.find(key), criterion_of(rubric, name), Decimal(points), "me", "")
        figures = statistics(book, rubric)
        found = members(book, rubric, figures)
    tenths = Counter(member.tenth for member in found.values())
    assert tuple(tenths[number] for number in range(10)) == figures.bins
    assert tenths[None] == figures.undecided == 1
    mistakes = Counter(number for member in found.values() for number in member.mistakes)
    assert [mistakes[number] for number in range(len(figures.failures))] == [row.count for row in figures.failures]
    assert {key: [rubric.criteria[number].id for number in member.lost] for key, member in found.items()} == {
        "anna": [],
        "ben": ["tall", "picture"],
        "cleo": ["box", "essay"],
        "dora": [],
        "finn": ["loads"],
    }
