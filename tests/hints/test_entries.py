"""A hint that needs an earlier one names it as the report shows it."""

import pytest

from grader.grading.hints.hinting import hinted
from grader.report.order import failures
from tests.samples import SAMPLES


@pytest.mark.parametrize("name", ["links-without-joints", "wheel-axes-along-x", "truncated-file", "caster-misnamed"])
def test_an_earlier_edit_is_named_by_the_entry_that_shows_it(name: str) -> None:
    """Not by a criterion that is listed below another one with the same edit."""
    found = failures(hinted(SAMPLES[name].grade(), SAMPLES[name].open(), "edit").report)
    hints = (failure.result.hint for failure in found if not failure.first)
    texts = [hint.message.partition("`")[0] for hint in hints if hint is not None]
    references = [text for text in texts if text.startswith(("After", "Make"))]
    named = {
        failure.result.criterion.id
        for failure in found
        for text in references
        if _names(text, failure.result.criterion.id)
    }
    assert references
    assert named
    assert named <= {failure.result.criterion.id for failure in found if not failure.first}


def _names(text: str, criterion: str) -> bool:
    return criterion in text.replace(",", " ").replace(".", " ").split()
