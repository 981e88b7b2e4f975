"""The JSON Schemas of what the grader reads and writes."""

from typing import Any


def json_schema(name: str) -> dict[str, Any]:
    """Return the schema of a report, rubric, inspection, graph, class, diff or rubric test."""
    if name == "rubric":
        from grader.lab.rubric.keys import rubric_schema

        return rubric_schema()
    if name in ("class", "diff"):
        from grader.classroom.reports.class_json import CLASS, DIFF
        from grader.report.json_data import make_schema

        return make_schema(name, CLASS if name == "class" else DIFF)
    from grader.report import formats

    return formats.json_schema(name)
