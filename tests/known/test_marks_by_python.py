"""The marks, and all that is said of a submission, do not depend on the Python that runs the grader."""

import json
import sys

import pytest

from tests.known.marks_by_python import CASES, MARKS, Case, marks

_MARKS = json.loads(MARKS.read_text("utf-8"))


def test_each_case_has_its_marks() -> None:
    """There are forty cases or more, of different names, and the file has the marks of each."""
    assert len(CASES) >= 40
    assert [case.name for case in CASES] == [*_MARKS]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_marks(case: Case) -> None:
    """A case earns what the newest Python gives it, or needs manual grading, and says which Python it needs."""
    outcome = marks(case)
    if case.is_read:
        assert outcome == _MARKS[case.name]
        return
    running = sys.version_info.minor
    sentence = f"needs Python 3.{case.needs}, and Python 3.{running} runs the grader"
    assert any(sentence in text for text in outcome["said"])
    assert all(" pending: " in text for text in outcome["said"])
    assert any(" warning: " in text and sentence in text for text in outcome["problems"])
