"""Findings for editors and CI systems: concise, SARIF and GitLab's code quality."""

import json
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import pytest

from grader.base.source import Base
from grader.report.formats import Format, render
from tests.command_line import ROOT, run
from tests.report.readers import read_by_schema, reader
from tests.samples import REPORTED, SAMPLES

LEVELS = {"error": "major", "warning": "minor", "note": "info"}
MISTAKEN = ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"


def rendered(name: str, kind: Format, base: Base | None = None) -> Any:
    """Return a sample's report in a format, as its reader reads it."""
    return reader(kind).parse(render(SAMPLES[name].grade(), kind, base))


@pytest.mark.parametrize("base", [Base(), Base("a b/"), Base(archive="a.zip")])
@pytest.mark.parametrize("name", REPORTED)
def test_the_formats_list_the_same_findings(name: str, base: Base) -> None:
    """Each has the same rules and places in the same order; a fingerprint is there once."""
    lines = render(SAMPLES[name].grade(), Format.CONCISE, base).splitlines()
    [log] = rendered(name, Format.SARIF, base)["runs"]
    issues = rendered(name, Format.CODEQUALITY, base)
    rules = log["tool"]["driver"]["rules"]
    assert [rule["id"] for rule in rules] == sorted({issue["check_name"] for issue in issues})
    for line, result, issue in zip(lines, log["results"], issues, strict=True):
        [place] = result["locations"]
        place = place["physicalLocation"]
        path, number = issue["location"]["path"], issue["location"]["lines"]["begin"]
        assert place["artifactLocation"]["uriBaseId"] == "%SRCROOT%"
        assert unquote(place["artifactLocation"]["uri"]) == path
        assert " " not in place["artifactLocation"]["uri"]
        assert place.get("region", {"startLine": 1})["startLine"] == number
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"] == issue["check_name"]
        assert LEVELS[result["level"]] == issue["severity"]
        assert result["message"]["text"] == issue["description"]
        assert f": {issue['check_name']} " in line
        if not base.archive:
            assert base.folder + line.partition(":")[0] in (path, f"{base.folder}.")
            assert line.split(":")[1] == str(number)
    assert len({issue["fingerprint"] for issue in issues}) == len(issues)


def test_a_fingerprint_does_not_change_with_the_line(tmp_path: Path) -> None:
    """Lines above a finding change its line, and the one that its hint names, and nothing else."""
    text = MISTAKEN.read_text(encoding="utf-8")
    reports = []
    for number, more in enumerate(("", "<!-- a robot -->\n\n")):
        (tmp_path / str(number)).mkdir()
        file = tmp_path / str(number) / "my_robot.urdf"
        file.write_text(text.replace("<robot", f"{more}<robot", 1), encoding="utf-8")
        reports.append(json.loads(run(("grade", file, "--format", "codequality")).stdout))
    before, after = ([issue["fingerprint"] for issue in report] for report in reports)
    assert before == after
    assert [issue["location"]["lines"] for issue in reports[0]] != [
        issue["location"]["lines"] for issue in reports[1]
    ]


def test_an_inspection_is_valid_sarif() -> None:
    """The rules of problems have a page with their anchor."""
    for name in ("raw-xacro", "several-mistakes", "reference"):
        done = run(("inspect", ROOT / "submissions/lab6" / name, "--format", "sarif"))
        [log] = read_by_schema("sarif-2.1.0")(done.stdout.decode())["runs"]
        for rule in log["tool"]["driver"]["rules"]:
            assert rule["helpUri"].endswith(f"/problems.html#{rule['id'].lower()}")
            assert f"\n## {rule['id']}\n" in (ROOT / "docs/problems.md").read_text("utf-8")


def test_a_rule_of_a_criterion_has_the_page_of_its_check() -> None:
    """The page of checks has a section for each."""
    [log] = rendered("several-mistakes", Format.SARIF)["runs"]
    page = (ROOT / "docs/checks.md").read_text(encoding="utf-8")
    for rule in log["tool"]["driver"]["rules"]:
        assert f"\n## `{rule['helpUri'].partition('#')[2]}`\n" in page
