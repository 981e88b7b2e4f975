"""The student's page says what the terminal says with `--verbose`, failures first, and nothing of the submission is markup."""

from typing import Any

import pytest
from lxml import html

from grader.report.pages.student import render_html
from tests.command_line import run
from tests.report.reports import hinted, marked


def read(text: str | bytes) -> Any:
    """Return the root of a page."""
    return html.document_fromstring(text)


def test_page_has_score_and_failures_first() -> None:
    """The score is large, and the costliest failure is the first one."""
    page = read(run(("grade", "submissions/axis-negated/my_robot.urdf", "--format", "html")).stdout)
    assert page.find_class("score")[0].text_content().strip() == "64 / 70 points"
    first = page.xpath("//article")[0]
    assert first.get("id") == "criterion-left-wheel-forward"


def test_page_shows_hints_with_their_lines() -> None:
    """A hint has its message and the lines of its diff, the old ones and the new ones."""
    page = read(render_html(hinted()))
    card = page.get_element_by_id("criterion-right-wheel-forward")
    assert 'Change rpy="1.57 0 0" to' in card.find_class("hint")[0].text_content()
    assert [line.text.strip() for line in card.iter("del")] == ['-      <origin xyz="-0.15 -0.2 0" rpy="1.57 0 0" />']


def test_page_marks_the_place_in_the_source() -> None:
    """The lines around a place have their numbers, and what is meant is marked."""
    page = read(render_html(hinted()))
    source = page.get_element_by_id("criterion-right-wheel-forward").find_class("source")[0]
    assert [int(number.text) for number in source.find_class("line-number")] == [71, 72, 73, 74, 75]
    assert [mark.text for mark in source.iter("mark")] == ['rpy="1.57 0 0"']


def test_page_shows_manual_marks() -> None:
    """A manual mark overrides the check, with the grader's name and comment."""
    text = read(render_html(marked())).text_content()
    assert "Marked by Ada: so it is." in text


@pytest.mark.parametrize(("answers", "count"), [((), 0), (("--answers",), 1)])
def test_model_answers_need_the_option(answers: tuple[str, ...], count: int) -> None:
    """Model answers are on the page with --answers only."""
    page = read(run(("grade", "submissions/reference", "--format", "html", *answers)).stdout)
    assert ("Model answer:" in page.text_content()) == bool(count)
