"""pre-commit runs the checks before a commit in a student's repository, as the page documents it."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from grader.app.cli.changed_packages import main
from tests.ci.conftest import git, repository
from tests.command_line import HANG_TIMEOUT, ROOT

pytestmark = pytest.mark.slow

PAGE = (ROOT / "docs/ci.md").read_text(encoding="utf-8")
SAMPLES = ROOT / "submissions/lab6"


@pytest.mark.exhaustive
def test_the_documented_hooks(tmp_path: Path, published: Path) -> None:
    """An unfinished lab can be committed, a URDF that ROS 2 rejects cannot, and other files run nothing."""
    work = tmp_path / "work"
    work.mkdir()
    [config] = re.findall(r"```yaml\n(repos:.*?)```", PAGE, re.DOTALL)
    config = config.replace("https://github.com/", f"{published.as_uri()}/").replace("v1.0", "v1")
    (work / ".pre-commit-config.yaml").write_text(config, encoding="utf-8")
    repository(work)

    def commit(code: int) -> str:
        git(work, "add", "--all")
        done = _commit(work, tmp_path / "home")
        assert done.returncode == code, done.stdout + done.stderr
        git(work, "commit", "--quiet", "--no-verify", "--allow-empty", "--message", "More")
        return done.stdout

    (work / "README.md").write_text("Our robot\n", encoding="utf-8")
    assert commit(0).count("(no files to check)Skipped") == 2
    shutil.copytree(SAMPLES / "several-mistakes/my_robot", work / "src/my_robot")
    shutil.copytree(SAMPLES / "reference/roscourse_sim_ws/src/my_robot", work / "src/other")
    assert commit(0).count("Passed") == 2
    robot = work / "src/my_robot/urdf/my_robot.urdf"
    robot.write_text(robot.read_text(encoding="utf-8").replace("</robot>", ""), encoding="utf-8")
    rejected = commit(1)
    assert rejected.count("Failed") == 2
    assert "src/my_robot" in rejected
    assert "src/other" not in rejected.partition("inspect ROS 2 packages")[2]


def _commit(work: Path, home: Path) -> subprocess.CompletedProcess[str]:
    """Run pre-commit as at a commit; installed hooks are cached for the next run."""
    return subprocess.run(
        [sys.executable, "-m", "pre_commit", "run"],
        cwd=work,
        env={**os.environ, "PRE_COMMIT_HOME": str(home)},
        capture_output=True,
        text=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )


def test_each_changed_package_is_inspected_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A robot outside of packages is inspected on its own, other files not at all; options come first."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(SAMPLES / "reference/roscourse_sim_ws/src/my_robot", tmp_path / "src/my_robot")
    Path("lone.urdf").write_text('<robot name="lone"><link name="base"></robot>', encoding="utf-8")
    Path("notes.py").write_text("", encoding="utf-8")
    package = ["src/my_robot/package.xml", "src/my_robot/urdf/my_robot.urdf"]
    assert main(["notes.py"]) == 0
    assert capsys.readouterr().out == ""
    assert main(package) == 0
    assert capsys.readouterr().out == ""
    assert main(["--format", "terminal", *package]) == 0
    assert capsys.readouterr().out.count("ROS 2 loads it") == 1
    robot = Path("src/my_robot/urdf/my_robot.urdf")
    text = robot.read_text(encoding="utf-8")
    robot.write_text(text.replace('type="fixed"', 'type="fixd"', 1), encoding="utf-8")
    assert main([*package, "notes.py", "lone.urdf"]) == 1
    shown = capsys.readouterr().out.splitlines()
    line = text.partition('type="fixed"')[0].count("\n") + 1
    assert [row.partition(": ")[0].rpartition(":")[0] for row in shown] == [
        "lone.urdf:1",
        f"{robot}:{line}",
    ]
