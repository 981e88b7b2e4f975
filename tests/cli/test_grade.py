"""grader grade: thresholds, parts, saved reports, and the URDF of a folder."""

import json
from pathlib import Path

import pytest

from tests.golden.cases import ROOT, run

REFERENCE = ROOT / "submissions/reference/roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"
MISTAKEN = "submissions/lidar-offset-in-visual/my_robot.urdf"  # 64 of 70


@pytest.mark.parametrize(
    ("threshold", "code"), [("64", 0), ("64.0", 0), ("64.1", 1), ("91%", 0), ("91.5%", 1), ("0", 0), ("100%", 1)]
)
def test_fail_under(threshold: str, code: int) -> None:
    """The threshold is in points, or in percent of the maximum; reaching it is enough."""
    assert run(("grade", MISTAKEN, "--fail-under", threshold)).returncode == code


def test_without_a_threshold_every_criterion_must_pass() -> None:
    """One failed criterion is exit code 1."""
    assert run(("grade", MISTAKEN)).returncode == 1
    assert run(("grade", "submissions/reference", "--part", "task1")).returncode == 0


def test_saved_reports_equal_printed_ones(tmp_path: Path) -> None:
    """One run writes several reports; files contain no colours, whatever the terminal supports."""
    saves = ("--save", f"json={tmp_path / 'a.json'}", "--save", f"terminal={tmp_path / 'a.txt'}")
    done = run(("grade", MISTAKEN, "--format", "json", *saves))
    assert (tmp_path / "a.json").read_bytes() == done.stdout
    assert (tmp_path / "a.txt").read_bytes() == run(("grade", MISTAKEN)).stdout
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.json", "a.txt"]


def test_the_urdf_that_the_rubric_expects_is_graded(tmp_path: Path) -> None:
    """The path takes precedence, then the name, then the shortest path; the report lists the others with the reason."""
    for name in ("box.urdf", "a/my_robot.urdf", "ws/src/my_robot/urdf/my_robot.urdf", "install/urdf/my_robot.urdf"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(REFERENCE.read_bytes())
    done = run(("grade", str(tmp_path), "--format", "json"))
    submission = json.loads(done.stdout)["submission"]
    assert submission["path"] == "ws/src/my_robot/urdf/my_robot.urdf"
    assert submission["passed_over"] == [
        {"path": "a/my_robot.urdf", "because": "it has the expected name, but is not at urdf/my_robot.urdf"},
        {"path": "box.urdf", "because": "its name differs from that of urdf/my_robot.urdf"},
        {"path": "install/urdf/my_robot.urdf", "because": "a build generated it: only source files are graded"},
    ]
    assert done.stderr == b""


def test_ids_and_paths_do_not_depend_on_the_machine(tmp_path: Path) -> None:
    """The same file in another folder gives the same report except for the submission's name."""
    for name in ("alice", "bob"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "my_robot.urdf").write_bytes(REFERENCE.read_bytes())
    one, other = (
        json.loads(run(("grade", str(tmp_path / name), "--format", "json")).stdout) for name in ("alice", "bob")
    )
    assert (one["submission"].pop("id"), other["submission"].pop("id")) == ("alice", "bob")
    assert one == other
    assert str(tmp_path) not in json.dumps(one)


def test_max_size(tmp_path: Path) -> None:
    """The limit can be raised and lowered."""
    (tmp_path / "a.urdf").write_bytes(REFERENCE.read_bytes() + b" " * 1024 * 1024)
    assert run(("grade", str(tmp_path / "a.urdf"))).returncode == 2
    assert run(("grade", str(tmp_path / "a.urdf"), "--max-size", "2000000")).returncode == 0


@pytest.mark.parametrize(
    "variables", [{"NO_COLOR": "1"}, {"TERM": "dumb"}, {"PYTHONIOENCODING": "ascii"}, {"COLUMNS": "40"}]
)
def test_a_pipe_gets_no_escape_codes(variables: dict[str, str]) -> None:
    """A report in a pipe is plain text, at any width and in any encoding."""
    done = run(("grade", "submissions/several-mistakes/my_robot.urdf"), **variables)
    assert done.returncode == 1
    assert b"\x1b" not in done.stdout
    width = int(variables.get("COLUMNS", "80"))
    assert max(map(len, done.stdout.decode().splitlines())) <= width
