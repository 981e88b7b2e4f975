"""A slip in the form of a robot's markup or expressions costs one criterion, at most 5 points."""

from collections import Counter
from functools import cache

import pytest

from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.edited import with_files
from grader.lab.submission.submission import Submission
from tests.grading.slip_forms import FORMS, FormSlip, form_slips
from tests.samples import reference

pytestmark = pytest.mark.slow

_MAX_PRICE = 5
_MAX_OF_ONE = 6  # of a criterion that is worth as much


@cache
def _open_in_solution(rubric: str) -> frozenset[str]:
    slip = next(slip for slip in form_slips() if slip.rubric.id == rubric)
    report = grade(slip.rubric, reference(slip.rubric))
    return frozenset(result.criterion.id for result in report.results if result.is_open)


def _graded(slip: FormSlip) -> Report:
    submission: Submission = with_files(reference(slip.rubric), {slip.path: slip.text.encode()})
    report = grade(slip.rubric, submission)
    assert not report.fault
    return report


def _wrong_price(rubric: Rubric, report: Report) -> str:
    """Return what is wrong with the price of a slip; empty for one payer and a price that is right."""
    lost = {
        result.criterion.id: result.criterion.points for result in report.results if result.is_lost
    }
    still_open = {result.criterion.id for result in report.results if result.is_open}
    if still_open - _open_in_solution(rubric.id):
        return f"open: {still_open}"
    if len(lost) > 1 or sum(lost.values()) > _MAX_OF_ONE:
        return f"lost: {lost}"
    return ""


@pytest.mark.parametrize("kind", dict.fromkeys(form.kind for form in FORMS))
def test_a_slip_of_form_costs_one_criterion(kind: str) -> None:
    """One criterion pays for a slip of each kind, and nothing becomes open; some cost something."""
    prices = Counter[int]()
    wrong = []
    for slip in form_slips():
        if slip.kind == kind:
            report = _graded(slip)
            prices[
                int(sum(result.criterion.points for result in report.results if result.is_lost))
            ] += 1
            reason = _wrong_price(slip.rubric, report)
            if reason:
                wrong.append((slip.name, reason))
    assert wrong == []
    assert any(prices)
