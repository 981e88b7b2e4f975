"""The student's page says what the terminal says with `--verbose`, failures first, and nothing of the submission is markup."""

import sys
from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal
from typing import Any

import pytest
from lxml import html

from grader.lab.grading.grade import grade
from grader.lab.grading.report import ManualMark, Report
from grader.lab.submission.opening import read_submission
from grader.lab.submission.submission import Submission
from grader.report.formats import Format, render
from grader.report.pages.student import render_html
from grader.ros.package.robot_file import Absent
from tests.report.reports import AXLE, hinted, marked
from tests.samples import LAB6, ROOT, SAMPLES

sys.path.insert(0, str(ROOT / "benchmarks"))  # a folder of scripts
from pages import chain

MAX_SIZE = 300_000  # bytes


def read(text: str | bytes) -> Any:
    """Return the root of a page."""
    return html.document_fromstring(text)


@pytest.mark.slow
def test_page_of_sixty_links_is_small() -> None:
    """Score, failures and three views of all shapes take less than 300 KB."""
    page = render(
        grade(LAB6, read_submission(chain(60).encode(), identity="x", path="x.urdf")), Format.HTML
    )
    assert len(page.encode()) < MAX_SIZE
    assert page.count("<polygon") == 3 * 60


def test_number_of_a_failure_is_that_of_the_picture() -> None:
    """A failure has the number under which the views call its link out."""
    page = read(render_html(hinted()))
    pins = {pin.text_content().split()[-1] for pin in page.find_class("pin")}
    assert pins == {
        text.text for text in page.xpath("//*[local-name()='text' and @class='number']")
    }
    assert pins == {
        "1",
        "2",
        "3",
        "4",
    }  # the fifth is about several links: it has no place in the picture
    assert (
        "see below" not in page.text_content()
    )  # as in a picture of its own, which lists the criteria


def test_mark_in_place_of_a_hint_hides_no_other_card() -> None:
    """The card of a manual mark shows no edit: what the same edit fixes has its own card."""
    mark = ManualMark(Decimal(0), "Ada", "")
    report = hinted()
    results = (
        one._replace(manual_mark=mark if one.criterion.id == AXLE[0] else None)
        for one in report.results
    )
    page = read(render_html(report._replace(results=tuple(results))))
    assert not page.get_element_by_id(f"criterion-{AXLE[0]}").xpath(".//article")
    assert "180 degrees off" in page.get_element_by_id(f"criterion-{AXLE[1]}").text_content()


def mark_of_the_cause() -> Report:
    """Return a report in which a manual mark overrides a failure that others are skipped because of."""
    report = SAMPLES["empty-urdf"].grade()
    cause = next(result.because for result in report.results if result.because)
    given = [
        result._replace(manual_mark=ManualMark(result.criterion.points, "Ada", ""))
        if result.criterion.id == cause
        else result
        for result in report.results
    ]
    return report._replace(results=tuple(given))


@pytest.mark.parametrize(
    "report",
    [
        marked,
        hinted,
        mark_of_the_cause,
        *(SAMPLES[name].grade for name in ("axis-negated", "base-misnamed")),
    ],
)
def test_every_link_of_a_page_has_a_target(report: Callable[[], Report]) -> None:
    """A criterion that is skipped leads to the card of its cause."""
    page = read(render_html(report()))
    targets = {link.removeprefix("#") for link in page.xpath("//a/@href")}
    assert targets <= set(page.xpath("//@id"))
    assert any(target.startswith("criterion-") for target in targets)


@pytest.mark.parametrize(
    ("level", "is_shown"), [("none", False), ("place", False), ("cause", True), ("edit", True)]
)
def test_reference_is_as_secret_as_the_hints(level: Any, is_shown: bool) -> None:
    """Below the level `cause` no dashed outline shows the reference."""
    report = SAMPLES["lidar-buried"].grade()
    page = read(render_html(report._replace(rubric=replace(report.rubric, hints=level))))
    assert bool(page.find_class("reference")) == is_shown


def test_page_says_why_it_has_no_picture() -> None:
    """Nothing was submitted that a picture could show, or it is no longer there."""
    assert "No picture: no robot can be read" in render_html(SAMPLES["pictures-only"].grade())
    report = SAMPLES["lidar-buried"].grade()
    gone = report._replace(submission=Submission("ash", Absent(), is_single=False))
    assert "No picture: no robot can be read" in render_html(gone)
