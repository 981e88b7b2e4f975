"""The current folder as the default path of an inspection, its baseline, and its JUnit report."""

import json
from pathlib import Path

import pytest
from lxml import etree

from tests.command_line import ROOT, Done, run, run_with_input

SAMPLE = ROOT / "submissions/diffdrive/spawner-misspelt"
ROBOT = '<robot name="a"><link name="base"/>\n<joint name="j" type="hinge"/></robot>'


def inspect(folder: Path, *options: str) -> Done:
    """Run the command in a folder, without a path."""
    return run_with_input(("inspect", *options), b"", folder=folder)


def test_the_current_folder_is_inspected() -> None:
    """It is the default, and the paths of the format concise begin there."""
    done = inspect(SAMPLE, "--format", "concise")
    assert (done.returncode, done.stderr) == (1, b"")
    assert done.stdout.startswith(b"diffdrive_robot/launch/diffdrive.launch.py:38:25:")
    assert inspect(SAMPLE).stdout == run(("inspect", SAMPLE)).stdout


def test_a_baseline_hides_what_it_has(tmp_path: Path) -> None:
    """Also in other lines, and for the exit code; other findings are shown, and none is hidden from a grading."""
    robot, baseline = tmp_path / "a.urdf", tmp_path / "known.json"
    robot.write_text(ROBOT, encoding="utf-8")
    first = inspect(tmp_path, "--write-baseline", "known.json", "--format", "json")
    problems = json.loads(first.stdout)["robots"][0]["problems"]
    assert first.returncode == 0  # all is known from now on
    rows = json.loads(baseline.read_text(encoding="utf-8"))["findings"]
    assert sorted(row["code"] for row in rows) == sorted(each["code"] for each in problems)
    fingerprints = {row["fingerprint"] for row in rows}
    sarif = json.loads(inspect(tmp_path, "--format", "sarif").stdout)["runs"][0]["results"]
    assert {each["partialFingerprints"]["grader/v1"] for each in sarif} == fingerprints

    robot.write_text(f"<!-- a line -->\n{ROBOT}", encoding="utf-8")
    later = inspect(tmp_path, "--baseline", "known.json")
    assert later.returncode == 0
    assert f"{len(rows)} known from the baseline" in later.stdout.decode()
    assert "no other problems" in later.stdout.decode()
    more = ROBOT.replace('<link name="base"/>', '<link name="base"/><link name="base"/>')
    robot.write_text(more, encoding="utf-8")
    other = inspect(tmp_path, "--baseline", "known.json", "--format", "concise")
    assert other.returncode == 1
    assert [line.split(": ")[1].split()[0] for line in other.stdout.decode().splitlines()] == [
        "URDF031"
    ]
    both = inspect(tmp_path, "--baseline", "known.json", "--write-baseline", "known.json")
    assert both.returncode == 0
    assert len(json.loads(baseline.read_text(encoding="utf-8"))["findings"]) == len(rows) + 1
    assert run(("grade", tmp_path, "--baseline", baseline)).returncode == 2


def test_an_inspection_without_problems_has_an_empty_baseline(tmp_path: Path) -> None:
    """It hides nothing."""
    (tmp_path / "a.urdf").write_text('<robot name="a"><link name="b"/></robot>', encoding="utf-8")
    assert inspect(tmp_path, "--write-baseline", "none.json").returncode == 0
    assert json.loads((tmp_path / "none.json").read_text(encoding="utf-8"))["findings"] == []
    (tmp_path / "a.urdf").write_text(ROBOT, encoding="utf-8")
    assert inspect(tmp_path, "--baseline", "none.json").returncode == 1


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"schema": "grader/report/v1", "findings": []}', "[" * 9999]
)
def test_another_file_is_no_baseline(text: str, tmp_path: Path) -> None:
    """It is refused in one line, before anything is inspected."""
    (tmp_path / "a.urdf").write_text(ROBOT, encoding="utf-8")
    (tmp_path / "other.json").write_text(text, encoding="utf-8")
    done = inspect(tmp_path, "--baseline", "other.json")
    assert (done.returncode, done.stdout) == (2, b"")
    expected = b"grader: --baseline: other.json is no baseline: --write-baseline writes one\n"
    assert done.stderr == expected


def test_a_baseline_replaces_no_input(tmp_path: Path) -> None:
    """Neither the robot nor a file in a folder that does not exist is written."""
    robot = tmp_path / "a.urdf"
    robot.write_text(ROBOT, encoding="utf-8")
    for path, file in ((robot, robot), (tmp_path, tmp_path / "none" / "b.json")):
        done = run(("inspect", path, "--write-baseline", file))
        assert (done.returncode, done.stdout) == (2, b"")
    assert robot.read_text(encoding="utf-8") == ROBOT


def test_junit_has_a_case_for_each_finding(tmp_path: Path) -> None:
    """Errors are failures with their lines, others are skipped, and one case passes."""
    source = ROBOT.replace('<link name="base"/>', '<link name="base"><visul/></link>')
    (tmp_path / "a.urdf").write_text(source, encoding="utf-8")
    problems = json.loads(inspect(tmp_path, "--format", "json").stdout)["robots"][0]["problems"]
    severities = [problem["severity"] for problem in problems]
    assert {"error", "note"} <= {*severities}
    top = etree.fromstring(inspect(tmp_path, "--format", "junit").stdout)
    errors = severities.count("error")
    assert top.get("tests") == str(len(problems) + 1)
    assert top.get("failures") == str(errors) == str(len(top.findall(".//failure")))
    assert top.get("skipped") == str(len(problems) - errors) == str(len(top.findall(".//skipped")))
    [first, *cases] = top.iter("testcase")
    assert len(first) == 1
    assert {case.get("file") for case in cases} == {"a.urdf"}
    places = {(case.get("name", "").split()[0], int(case.get("line", "0"))) for case in cases}
    assert places == {(each["code"], each["location"]["line"]) for each in problems}
    assert "hinge" in (top.findall(".//failure")[0].text or "")
    single = etree.fromstring(run(("inspect", tmp_path / "a.urdf", "--format", "junit")).stdout)
    assert single.get("failures") == str(errors)
