"""GitLab's Code Quality report: valid, with one issue for each finding and unique fingerprints."""

from typing import Any

import pytest

from grader.grading.report import Report
from grader.report.annotations import render_codeclimate
from grader.report.findings import findings
from grader.source import Base
from tests.report.readers import read_by_schema
from tests.samples import REPORTED, SAMPLES

READ = read_by_schema("codeclimate")
SEVERITIES = {"error": "major", "warning": "minor", "note": "info"}


def issues(report: Report, base: Base = Base("lab/")) -> Any:  # noqa: B008  immutable
    """Return the issues of a report, whose fingerprints all differ."""
    found = READ(render_codeclimate(report, base))
    assert len({issue["fingerprint"] for issue in found}) == len(found)
    return found


@pytest.mark.parametrize("name", REPORTED)
def test_every_finding_is_an_issue(name: str) -> None:
    """Its rule, severity, text and line in the repository are those of the finding."""
    report = SAMPLES[name].grade()
    found = findings(report, Base("lab/"))
    for issue, finding in zip(issues(report), found, strict=True):
        assert (issue["check_name"], issue["severity"]) == (finding.rule, SEVERITIES[finding.level])
        assert finding.text.replace("\n", " ") in issue["description"]
        assert issue["location"]["path"].startswith("lab")
        if finding.location is not None:
            assert issue["location"] == {"path": finding.location.path, "lines": {"begin": finding.location.line}}
        if finding.lost:
            assert f"({finding.lost} point{'' if finding.lost == 1 else 's'} lost)" in issue["description"]


def test_a_report_without_findings_is_an_empty_list() -> None:
    """GitLab needs a list even then."""
    assert render_codeclimate(SAMPLES["reference"].grade(), Base()) == "[]\n"


@pytest.mark.parametrize("base", [Base(), Base("a/"), Base(archive="a.zip")])
@pytest.mark.parametrize(
    "name", ["several-mistakes", "pictures-only", "no-package-xml", "empty-urdf", "setup-as-created"]
)
def test_findings_without_a_location_have_a_path(name: str, base: Base) -> None:
    """The path is the URDF, the package or the folder: never empty, and never outside the repository."""
    for issue in issues(SAMPLES[name].grade(), base):
        assert issue["location"]["path"].startswith(base.archive or base.folder.rstrip("/"))
