"""No hint on a slip takes away what the student wrote."""

import re

import pytest

from grader.base.source import Edits
from grader.lab.grading.grade import grade
from grader.lab.hints.hinting import hinted
from grader.lab.submission.edited import with_files
from grader.ros.xml.urdf_format import TAGS
from tests.examples import spread
from tests.grading.slip_forms import FormSlip, form_slips
from tests.grading.slips import WrittenSlip, written_slips
from tests.samples import reference

pytestmark = pytest.mark.slow

_WORD = re.compile(r"[-+]?\d+\.?\d*|\.\d+|[^\W\d]\w*")
_DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d)")
_OF_FORMAT = {*TAGS, *(name for tag in TAGS.values() for name in tag.attributes)}
_SIGNS = {"kg", "x", "O"}  # what stands for a sign, a digit, or says a unit that a URDF has
_SLIPS: list[FormSlip | WrittenSlip] = [*form_slips(), *written_slips()]


def _lost_words(edits: Edits) -> set[str]:
    """Return the numbers and names that edits remove without another one in their place."""
    old = {word for edit in edits for word in _WORD.findall(_DECIMAL_COMMA.sub(".", edit.old))}
    new = {word for edit in edits for word in _WORD.findall(edit.new)}
    lost = old - new - _OF_FORMAT - _SIGNS
    return lost if len(lost) > len(new - old) else set()


@pytest.mark.parametrize("slip", spread(_SLIPS, 120), ids=lambda slip: slip.name[:80])
def test_an_edit_keeps_what_is_written(slip: FormSlip | WrittenSlip) -> None:
    """Each number and name that a proposed edit removes is in the text that it writes, or another one for it."""
    submission = with_files(reference(slip.rubric), {slip.path: slip.text.encode()})
    report = grade(slip.rubric, submission)
    results = hinted(report, submission, "edit").report.results
    for result in results:
        if result.hint is not None and result.hint.edits:
            assert not _lost_words(result.hint.edits), result.hint.edits
