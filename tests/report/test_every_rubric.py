"""Reports of every rubric in every format, also on a robot that lacks most of what the rubric names."""

import pytest

from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import load_rubric, shipped_rubrics
from grader.report.formats import Format, render
from tests.samples import opened, reference

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("kind", Format)
@pytest.mark.parametrize("name", shipped_rubrics())
def test_each_format(name: str, kind: Format) -> None:
    """Something is printed for the reference, and for the reference of another lab."""
    rubric = load_rubric(name)
    for submission in (reference(rubric), opened("submissions/lab6/reference", rubric)):
        text = render(grade(rubric, submission), kind)
        assert text or kind is Format.CONCISE  # which has nothing but mistakes
