"""SARIF: valid under the published schema, and under the additional rules of GitHub's code scanning."""

import re
from collections.abc import Iterator
from decimal import Decimal
from typing import Any
from urllib.parse import unquote, urlsplit

import pytest

from grader.grading.grade import grade
from grader.grading.report import Report
from grader.problems import Problem
from grader.report.findings import findings
from grader.report.sarif import render_sarif
from grader.robot.catalogue import UNDEFINED_MATERIAL
from grader.source import Base, Location
from grader.submission.opening import read_submission
from tests.report.readers import read_sarif
from tests.report.rewording import recast
from tests.samples import LAB6, REPORTED, ROOT, SAMPLES

MISTAKEN = ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"
MAX_RESULTS = 5000  # results that GitHub shows
MAX_DESCRIPTION = 1024  # characters of a rule's descriptions
FOLDER = "a lab #1/50%/ü?:x/"


def run_of(report: Report, base: Base = Base(FOLDER)) -> Any:  # noqa: B008  immutable
    """Return the run of a report, which satisfies GitHub's rules."""
    run = read_sarif(render_sarif(report, base))
    assert all(text.strip() for text in _texts(run))
    rules = run["tool"]["driver"]["rules"]
    assert len({rule["id"] for rule in rules}) == len(rules)
    for rule in rules:
        for key in ("shortDescription", "fullDescription", "help"):
            assert 0 < len(rule[key]["text"]) <= MAX_DESCRIPTION
    for result in run["results"]:
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"]
        assert result["message"]["text"]
        (location,) = result["locations"]
        _is_relative(location["physicalLocation"])
    prints = [result["partialFingerprints"]["primaryLocationLineHash"] for result in run["results"]]
    assert all(re.fullmatch("[0-9a-f]{16}:[1-9][0-9]*", fingerprint) for fingerprint in prints)
    assert len(set(prints)) == len(prints) <= MAX_RESULTS
    return run


def _is_relative(at_location: dict[str, Any]) -> None:
    uri = at_location["artifactLocation"]["uri"]
    parts = urlsplit(uri)
    assert (parts.scheme, parts.netloc, parts.query, parts.fragment) == ("", "", "", "")
    assert not uri.startswith(("/", "./"))
    assert re.fullmatch(r"(?:[A-Za-z0-9._~/-]|%[0-9A-F]{2})+", uri)
    region = at_location["region"]
    assert region["startLine"] >= 1
    assert region.get("endColumn", 1) >= region.get("startColumn", 1) >= 1


def _texts(value: Any) -> Iterator[str]:
    """Yield every string but those in properties, which no viewer shows."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, list):
        for item in value:
            yield from _texts(item)
    elif isinstance(value, dict):
        for key, item in value.items():
            if key not in ("properties", "insertedContent"):  # which may be empty
                yield from _texts(item)


@pytest.mark.parametrize("name", REPORTED)
def test_every_finding_is_a_result(name: str) -> None:
    """Rule, level, location and message are those of the finding, and the lost points add up."""
    report = SAMPLES[name].grade()
    run = run_of(report)
    found = findings(report, Base(FOLDER))
    assert [result["ruleId"] for result in run["results"]] == [finding.rule for finding in found]
    for reported, finding in zip(run["results"], found, strict=True):
        at_location = reported["locations"][0]["physicalLocation"]
        assert reported["level"] == finding.level
        assert unquote(at_location["artifactLocation"]["uri"]).startswith(FOLDER.rstrip("/"))
        if finding.location is not None:
            assert unquote(at_location["artifactLocation"]["uri"]) == finding.location.path
            assert at_location["region"]["startLine"] == finding.location.line
    lost = sum(Decimal(str(result.get("properties", {}).get("points", 0))) for result in run["results"])
    assert (
        report.score + lost + report.pending == report.max_score
    )  # the points of skipped criteria count for the cause


def test_snippets_match_their_regions() -> None:
    """The region of a file from its first column to the one before its last is the snippet, counted in characters."""
    text = MISTAKEN.read_text(encoding="utf-8").replace("<origin", "<!-- \U0001f600 \u00fc --><origin")
    report = grade(LAB6, read_submission(text.encode(), identity="a", path="my_robot.urdf"))
    regions = [result["locations"][0]["physicalLocation"]["region"] for result in run_of(report)["results"]]
    quoted = [region for region in regions if "snippet" in region]
    assert len(quoted) == 6
    for region in quoted:
        line = text.splitlines()[region["startLine"] - 1]
        assert line[region["startColumn"] - 1 : region["endColumn"] - 1] == region["snippet"]["text"]


def test_a_moved_finding_keeps_its_fingerprint() -> None:
    """Lines inserted above change no fingerprint; a change of the line does."""
    text = MISTAKEN.read_bytes()

    def prints(data: bytes) -> dict[str, str]:
        report = grade(LAB6, read_submission(data, identity="a", path="my_robot.urdf"))
        return {
            result["ruleId"]: result["partialFingerprints"]["primaryLocationLineHash"]
            for result in run_of(report)["results"]
        }

    before = prints(text)
    assert prints(text.replace(b"<!-- ===", b"\n\n<!-- ===")) == before
    assert prints(text.replace(b"   <origin", b"\t<origin")) == before
    after = prints(text.replace(b'xyz="0.15 0 0.2"', b'xyz="0.15 0 0.21"'))
    assert {name for name in before if before[name] != after.get(name)} == {"lidar-frame"}


def test_the_number_of_results_is_limited() -> None:
    """The first ones are kept, which cost points, and the run says how many are missing."""
    report = SAMPLES["several-mistakes"].alone.grade()
    problems = tuple(
        Problem(UNDEFINED_MATERIAL, "no such colour", Location("a.urdf", 1, 1)) for _ in range(MAX_RESULTS + 100)
    )
    run = run_of(report._replace(problems=problems))
    assert len(run["results"]) == MAX_RESULTS
    assert run["properties"]["leftOut"] == 107
    assert [result["ruleId"] for result in run["results"][:2]] == ["base-green", "lidar-frame"]


def test_a_file_of_one_long_line_has_a_small_report() -> None:
    """No report is a thousand times as large as its submission."""
    joints = "".join(f"<joint name='j{number}' type='q'/>" for number in range(3000))
    text = f"<robot name='r'><link name='a'/>{joints}</robot>"
    report = grade(LAB6, read_submission(text.encode(), identity="a", path="a.urdf"))
    assert len(report.problems) > 1000
    assert len(render_sarif(report, Base())) < 10 * len(text)


def test_findings_in_an_archive_are_at_the_archive() -> None:
    """Code scanning only knows files of the repository, and needs a line for each."""
    run = run_of(SAMPLES["several-mistakes"].alone.grade(), Base(archive="lab 6.zip"))
    for result in run["results"]:
        at_location = result["locations"][0]["physicalLocation"]
        assert at_location["artifactLocation"]["uri"] == "lab%206.zip"
        assert at_location["region"] == {"startLine": 1}


def test_the_rest_of_the_report_is_in_the_properties() -> None:
    """Points, every criterion, versions and paths."""
    report = SAMPLES["reference"].grade()
    run = run_of(report)
    output = run["properties"]
    assert (output["score"], output["maxScore"], output["pending"]) == (90, 100, 10)
    assert output["rubric"] == {"id": "lab6", "sha256": report.rubric.sha256}
    assert [criterion["status"] for criterion in output["criteria"]] == [
        result.outcome.status for result in report.results
    ]
    assert run["automationDetails"]["id"] == "grader/lab6/"
    assert run["columnKind"] == "unicodeCodePoints"


def test_a_message_contains_no_link() -> None:
    """Viewers interpret links as in Markdown, and nothing else."""
    report = recast(SAMPLES["several-mistakes"].alone.grade(), lambda: "[x](http://e.org) ![y](z)")
    messages = [result["message"]["text"] for result in run_of(report)["results"]]
    assert all("[x]" in message for message in messages)
    assert not any("](" in message for message in messages)
