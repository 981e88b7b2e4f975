"""Reports and inspections as JSON: valid under their schemas, exact, and harmless whatever a student writes."""

import json
from typing import Any

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.app.commands.schemas import json_schema
from grader.lab.grading.grade import grade
from grader.lab.rubric.keys import rubric_schema
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import read_submission
from grader.report.inspection import InspectedRobot, Inspection, main_root
from grader.report.json_data import rounded, to_json
from grader.report.writers.as_json import render_json
from grader.report.writers.inspection_json import inspection_json
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import read_urdf
from tests.urdf.edge_cases import EDGE_CASES

RUBRIC = load_rubric("lab6")


def inspected(data: bytes) -> str:
    """Return the inspection of a file's bytes as JSON."""
    reading = read_urdf(data, "a.urdf")
    robot = Configuration(reading.robot) if reading.robot is not None else None
    shown = InspectedRobot("a.urdf", reading, robot, main_root(robot) if robot else None)
    return inspection_json(Inspection("a.urdf", (shown,)))


@pytest.mark.parametrize(
    "schema",
    [json_schema("report"), json_schema("inspect"), rubric_schema()],
    ids=["report", "inspect", "rubric"],
)
def test_schemas_are_json_schemas(schema: dict[str, Any]) -> None:
    """Every printed schema is a JSON Schema."""
    jsonschema.Draft202012Validator.check_schema(schema)


@pytest.mark.slow
def test_reports_and_inspections_of_edge_cases_are_valid() -> None:
    """Whatever the file: no exception, no NaN, no invalid Unicode."""
    report_schema, inspect_schema = (
        jsonschema.Draft202012Validator(schema)
        for schema in (json_schema("report"), json_schema("inspect"))
    )
    for case in EDGE_CASES[::8]:
        if len(case.text) > 20_000:
            continue
        report = grade(RUBRIC, read_submission(case.text, identity=case.name, path="a.urdf"))
        assert not report.fault, case.name
        report_schema.validate(json.loads(render_json(report)))
        inspect_schema.validate(json.loads(inspected(case.text)))


def test_measured_values_have_no_minus_zero_and_no_nan() -> None:
    """Digits that differ between machines are rounded away; values that are not finite are null."""
    assert str(rounded(-0.0)) == "0.0"
    assert rounded((1e-9, float("nan"), float("inf"), 0.1 + 0.2)) == [0.0, None, None, 0.3]
    assert rounded(None) is None
    assert rounded({"a": "b"}) == {"a": "b"}


@given(st.lists(st.tuples(st.text(), st.text() | st.none() | st.lists(st.text())), min_size=1))
def test_lines_are_only_layout(values: list[tuple[str, Any]]) -> None:
    """A list of objects has a line for each, whatever its strings contain, and reads back unchanged."""
    rows = [{"id": name, "x": value} for name, value in values]
    text = to_json({"rows": rows})
    assert json.loads(text) == {"rows": rows}
    assert text.count("\n") == len(rows) + 4
