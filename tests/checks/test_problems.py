"""The check that a URDF is without given problems."""

from pathlib import Path

import pytest

from grader.checks.problems import without_problems
from tests.checks.outcomes import ask, graded, missing
from tests.checks.robots import Scene, arm, scene
from tests.checks.submissions import REFERENCE, URDF
from tests.command_line import run

RUBRIC = """\
id = "r"
title = "R"
[[part]]
id = "a"
title = "A"
[[criterion]]
id = "c"
part = "a"
title = "No problems"
points = 1
check = "without_problems"
with = { problems = %s }
"""
OPEN = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">\n<link name="${%s}"/>\n</robot>\n'


def test_other_problems_do_not_matter() -> None:
    """Only the named codes count; the first problem is named, and how many more there are."""
    twice = Scene(arm(axis="0 2 0").text.replace('xyz="0 0 1"', 'xyz="0 0 2"'))
    assert ask(without_problems, twice, problems=["URDF031"]).status == "passed"
    several = ask(without_problems, twice, problems=[f"URDF03{number}" for number in range(7)])
    assert several.message == "the URDF has none of the problems URDF030, URDF031, URDF032, URDF033, URDF034 and 2 more"
    outcome = graded(without_problems, twice, problems=["URDF031", "URDF074"])
    assert (
        outcome.message
        == "URDF074: only the direction of an axis counts: ROS 2 normalizes it (and 1 more such problem)"
    )
    assert outcome.location == twice.location_of('xyz="0 2 0"')
    assert outcome.mistake == "URDF074: A joint axis whose length is not 1"


def test_a_file_without_a_robot_is_not_without_problems() -> None:
    """What cannot be read at all misses the robot, unless the reason is one of the codes."""
    empty = Scene("nothing")
    assert missing(without_problems, empty, problems=["URDF074"]).kind == "robot"
    codes = [problem.code for problem in empty.reading.problems]
    assert ask(without_problems, empty, problems=codes).status == "failed"


def test_xacro() -> None:
    """Problems of xacro have codes, too; what cannot be determined is pending, even if its own code is named."""
    submitted = REFERENCE.with_files({URDF: OPEN % "lnk"}).renaming(URDF, f"{URDF}.xacro")
    assert ask(without_problems, submitted, problems=["XACRO002"]).status == "failed"
    assert ask(without_problems, submitted, problems=["XACRO003"]).status == "passed"
    unknown = submitted.with_files({f"{URDF}.xacro": (OPEN % "").replace("${}", "$(env NAME)")})
    for code in ("URDF074", "XACRO006"):
        outcome = ask(without_problems, unknown, problems=[code])
        assert outcome.status == "pending"
        assert "NAME is known only at run time" in outcome.message


@pytest.mark.parametrize(("codes", "code"), [('["URDF074"]', 0), ('["URDF074", "URDF999"]', 2), ('["PKG001"]', 2)])
def test_unknown_codes_are_mistakes_of_the_rubric(tmp_path: Path, codes: str, code: int) -> None:
    """The rubric is refused in one line if a code is not one of a URDF or of xacro."""
    (tmp_path / "rubric.toml").write_text(RUBRIC % codes)
    (tmp_path / "robot.urdf").write_text(scene('<link name="base"/>').text)
    done = run(("grade", tmp_path / "robot.urdf", "--rubric", tmp_path / "rubric.toml"))
    assert done.returncode == code, done
    if code:
        assert b"problems of without_problems must be codes of problems" in done.stderr
        assert done.stderr.count(b"\n") == 1
