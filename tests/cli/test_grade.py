"""What holds for every report of `grader grade`, in every format."""

import json
import re
import shlex
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest

from grader.report.formats import Format
from tests.command_line import ROOT, run
from tests.edits_rubric import copy_with_edits
from tests.report.readers import FINDINGS
from tests.report.reports import CLASSROOM50

PACKAGE = ROOT / "rubrics/lab6/my_robot"
MACROS = ROOT / "submissions/lab6/equivalent-xacro-macros/my_robot/urdf"
BOX = '<robot name="box"><link name="box"/></robot>'


def graded(path: Path, rubric: object = "lab6") -> dict[str, Any]:
    """Return the JSON report on a submission, without hints."""
    words = ("grade", path, "--format", "json", "--hints", "none", "--rubric", rubric)
    return dict(json.loads(run(words).stdout))


def test_ids_and_paths_do_not_depend_on_the_machine(tmp_path: Path) -> None:
    """The same file in another folder gives the same report except for the submission's name."""
    one, other = (
        graded(Path(shutil.copytree(PACKAGE / "urdf", tmp_path / name)))
        for name in ("alice", "bob")
    )
    assert (one["submission"].pop("id"), other["submission"].pop("id")) == ("alice", "bob")
    assert one == other
    assert str(tmp_path) not in json.dumps(one)


def test_what_is_read_besides_counts_in_the_sha256(tmp_path: Path) -> None:
    """Another content of an included file gives another hash, another file beside it does not."""
    path = Path(shutil.copytree(MACROS, tmp_path / "urdf")) / "my_robot.urdf"
    path = path.rename(path.with_suffix(".urdf.xacro"))
    digests = [graded(path)["submission"]["sha256"]]
    for name in ("other.xacro", "wheel.xacro"):
        (tmp_path / "urdf" / name).write_text(
            (MACROS / "wheel.xacro").read_text(encoding="utf-8") + "\n"
        )
        digests.append(graded(path)["submission"]["sha256"])
    assert digests[0] == digests[1] != digests[2]


@pytest.mark.parametrize("kind", [kind for kind in Format if kind not in FINDINGS])
def test_a_note_is_in_every_format(kind: Format, tmp_path: Path) -> None:
    """Another lab and another robot are named, in a terminal before all failures."""
    (tmp_path / "Lab7").mkdir()
    (tmp_path / "Lab7/box.urdf").write_text(BOX)
    text = run(
        ("grade", tmp_path, "--format", kind, "--hints", "none"), **CLASSROOM50
    ).stdout.decode()
    words = " ".join(re.sub(r"<[^>]+>", " ", text).split())
    assert "his looks like another robot: it has none of the links of the rubric lab6" in words
    if (
        kind is not Format.SVG and kind.needs != "identity"
    ):  # a picture of the robot, and points for a platform
        assert (
            "no folder of this lab was found: Lab7, the folder of another lab, was graded" in words
        )
    if kind is Format.TERMINAL:
        assert words.index("another robot") < words.index("base-box")


@pytest.mark.parametrize(
    ("code", "is_evaluated"),
    [
        ("type Path = str\n", False),
        ("def first[T](items: list[T]) -> T:\n    return items[0]\n", False),
        ("class Names[T]:\n    pass\n", True),
        ("names = {'a': 1}\nname = f'{names['a']}/{'b'}'\n", True),
        ("name = f'{\n  1 + 1\n}'\n", True),
    ],
)
@pytest.mark.parametrize("path", ["launch/my_robot_rviz.launch.py", "setup.py"])
def test_what_python_3_12_added_is_no_failure(
    path: str, code: str, is_evaluated: bool, tmp_path: Path
) -> None:
    """ROS 2 Jazzy runs it: a person decides on what is not evaluated, and on all of it where an older Python grades."""
    file = Path(shutil.copytree(PACKAGE, tmp_path / "my_robot")) / path
    file.write_text(file.read_text().replace("import os\n", f"import os\n{code}", 1))
    lab = Path(shutil.copytree(ROOT / "rubrics/lab6", tmp_path / "lab")) / "rubric.toml"
    lab.write_text(lab.read_text().replace('distro = "foxy"', 'distro = "jazzy"'))
    found = {
        row["status"]
        for row in graded(tmp_path / "my_robot", lab)["results"]
        if row["id"].startswith(("setup", "launch"))
    }
    is_decided = is_evaluated and sys.version_info >= (3, 12)
    assert found == ({"passed"} if is_decided else {"passed", "pending"})


def test_the_next_command_runs_with_a_rubric_elsewhere(tmp_path: Path) -> None:
    """It has the path of the rubric as it was given, quoted for a shell."""
    rubric = copy_with_edits(tmp_path / "my labs")
    (tmp_path / "box.urdf").write_text(BOX, encoding="utf-8")
    report = run(
        ("grade", tmp_path / "box.urdf", "--rubric", rubric, "--hints", "none"), COLUMNS="500"
    ).stdout.decode()
    [command] = re.findall(r"^Next: grader (.*)", report, re.MULTILINE)
    assert run(shlex.split(command)).returncode == 0
