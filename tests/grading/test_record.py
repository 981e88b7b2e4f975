"""A record keeps everything in a report."""

import json

import pytest

from grader.grading.record import from_record, to_record
from grader.report.as_json import render_json
from tests.examples import spread
from tests.samples import SAMPLES


@pytest.mark.parametrize("name", spread(SAMPLES, 25))
def test_a_record_gives_the_same_report(name: str) -> None:
    """A report made from a record equals the original byte for byte, and gives the same record again."""
    report = SAMPLES[name].grade()
    record = to_record(report)
    again = from_record(record, report.rubric)
    assert render_json(again) == render_json(report)
    assert to_record(again) == record
    json.loads(record)
