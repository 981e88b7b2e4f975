"""`grader rubric show --format markdown`: the table of a lab's handout, for students."""

import re
from html import unescape

import cmarkgfm
import pytest

from grader.grading.rubric import load_rubric, shipped_rubrics
from tests.command_line import run


@pytest.mark.parametrize("name", sorted(shipped_rubrics()))
def test_the_table_of_a_shipped_rubric(name: str) -> None:
    """As HTML, the tables have a row for each criterion with its id, title and points."""
    text = run(("rubric", "show", name, "--format", "markdown")).stdout.decode()
    html = cmarkgfm.github_flavored_markdown_to_html(text)
    cells = [
        tuple(unescape(re.sub(r"<[^>]*>|\u2060", "", cell)) for cell in re.findall(r"<td[^>]*>(.*?)</td>", row))
        for row in re.findall(r"<tr>(.*?)</tr>", html, re.DOTALL)
    ]
    rubric = load_rubric(name)
    shown = {row[0]: row[1:] for row in cells if row}
    assert list(shown) == [
        criterion.id for part in rubric.parts for criterion in rubric.criteria if criterion.part == part.id
    ]
    for criterion in rubric.criteria:
        *_, title, points = shown[criterion.id]
        assert title.removesuffix(" (graded manually)") == criterion.title
        assert float(points) == float(criterion.points)
        assert criterion.feedback == "" or criterion.feedback not in text
