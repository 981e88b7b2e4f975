"""`grader grade` of xacro: what xacro refuses, what cannot be determined, and the files that it reads."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run
from tests.samples import ROOT

PACKAGE = ROOT / "rubrics/lab6/my_robot"
GREEN = "0 0.6 0 1"
NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ROBOT = (PACKAGE / "urdf/my_robot.urdf").read_text().replace("<robot ", f"<robot {NAMESPACE} ")


def graded(path: Path, *more: str) -> tuple[int, dict[str, Any]]:
    """Return the exit code and the report of a submission."""
    done = run(("grade", path, "--format", "json", *more))
    return done.returncode, json.loads(done.stdout)


def statuses(report: dict[str, Any]) -> dict[str, str]:
    """Return the status of each criterion."""
    return {result["id"]: result["status"] for result in report["results"]}


@pytest.mark.parametrize(
    "added",
    [
        '<xacro:property name="d" value="$(arg nope)" lazy_eval="false"/>',
        '<xacro:property name="d" value="${xacro.arg(\'nope\')}" lazy_eval="false"/>',
        '<xacro:macro name="m" params="p"/><xacro:m p="$(arg nope)"/>',
        '<xacro:macro name="m" params="p:=$(arg nope)"/><xacro:m/>',
    ],
)
def test_a_value_that_xacro_may_refuse_is_undecided_even_if_nothing_uses_it(added: str, tmp_path: Path) -> None:
    """xacro evaluates it, so that the robot may not load: `urdf-loads` needs manual grading."""
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(ROBOT.replace("</robot>", f"{added}</robot>"))
    code, report = graded(path)
    assert (code, report["score"], statuses(report)["urdf-loads"]) == (1, 67, "pending")
    assert graded(path, "--arg", "nope=1")[0] == 0


@pytest.mark.parametrize("expression", ["range(2**70)[1]", "len(math.keys())", "len(math)"])
def test_what_xacro_accepts_is_not_refused(expression: str, tmp_path: Path) -> None:
    """An expression that is valid for xacro and not supported is undecided."""
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(ROBOT.replace("</robot>", f'<a b="${{{expression}}}"/></robot>'))
    code, report = graded(path)
    assert (code, report["score"], statuses(report)["urdf-loads"]) == (1, 67, "pending")


def test_a_macro_may_have_a_parameter_twice(tmp_path: Path) -> None:
    """The last default counts, as in xacro."""
    macro = f'<xacro:macro name="m" params="c:=1 c:=\'{GREEN}\'"><material name="green"><color rgba="${{c}}"/></material></xacro:macro>'
    before, _, after = ROBOT.partition('<material name="green">')
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(f"{before}{macro}<xacro:m/>{after.partition('</material>')[2]}")
    assert graded(path)[1]["score"] == 70
