"""A record keeps everything in a report."""

import json

import pytest

from grader.grading.record import Template, from_record, to_record
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


REFERENCE = SAMPLES["reference"].grade()


@pytest.mark.parametrize("name", spread([name for name in SAMPLES if SAMPLES[name].rubric is REFERENCE.rubric], 10))
def test_a_template_removes_repetition(name: str) -> None:
    """A record with a template gives the same report, and is no longer than one without."""
    template = Template.of(REFERENCE)
    report = SAMPLES[name].grade()
    record = to_record(report, template)
    again = from_record(record, report.rubric, template=Template(template.text, report.rubric))
    assert render_json(again) == render_json(report)
    assert len(record) <= len(to_record(report))
