"""Golden cases: a command line, and beside it what it must print, byte for byte."""

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parent.parent


@dataclass(frozen=True, slots=True)
class Golden:
    """One command with its exit code; standard output is kept in the file of its name."""

    name: str
    arguments: tuple[str, ...]
    exit_code: int

    @property
    def file(self) -> Path:
        """Where the expected output stands."""
        return HERE / f"{self.name}.{'json' if 'json' in self.arguments or 'schema' in self.arguments else 'txt'}"


GOLDEN = (
    Golden("reference", ("grade", "submissions/reference"), 0),
    Golden("reference-json", ("grade", "submissions/reference", "--format", "json"), 0),
    Golden("several-mistakes", ("grade", "submissions/several-mistakes/my_robot.urdf"), 1),
    Golden("several-mistakes-json", ("grade", "submissions/several-mistakes/my_robot.urdf", "--format", "json"), 1),
    Golden("lidar-without-joint", ("grade", "submissions/lidar-without-joint/my_robot.urdf"), 1),
    Golden("broken-tag-parent", ("grade", "submissions/broken-tag-parent/my_robot.urdf"), 1),
    Golden("broken-tag-parent-json", ("grade", "submissions/broken-tag-parent/my_robot.urdf", "--format", "json"), 1),
    Golden("no-launch-folder", ("grade", "submissions/no-launch-folder", "--part", "task2"), 1),
    Golden("launch-home-path", ("grade", "submissions/launch-home-path", "--part", "task2"), 1),
    Golden("setup-syntax-error", ("grade", "submissions/setup-syntax-error", "--part", "task2"), 1),
    Golden("pictures-only", ("grade", "submissions/pictures-only"), 1),
    Golden("team-of-two-json", ("grade", "submissions/equivalent-team-of-two", "--format", "json"), 0),
    Golden("zipped", ("grade", "submissions/equivalent-zipped-with-wrapper/lab6.zip", "--part", "questions"), 0),
    Golden("inspect-raw-xacro", ("inspect", "submissions/raw-xacro/my_robot.urdf"), 1),
    Golden("inspect-reference", ("inspect", "submissions/reference", "--relative-to", "base_link"), 0),
    Golden(
        "inspect-turned-json",
        ("inspect", "submissions/reference", "--joint", "base_left_wheel_joint=1.57", "--format", "json"),
        0,
    ),
    Golden("explain-criterion", ("explain", "lidar-frame"), 0),
    Golden("explain-code", ("explain", "URDF012"), 0),
    Golden("explain-package-code", ("explain", "PKG014"), 0),
    Golden("explain-check", ("explain", "bottom_at_height"), 0),
    Golden("rubric-show", ("rubric", "show", "lab6"), 0),
)


def run(arguments: tuple[str, ...], **variables: str) -> subprocess.CompletedProcess[bytes]:
    """Run the command line as a user does, 80 columns wide, from the project's root."""
    environment = {**os.environ, "COLUMNS": "80", "PYTHONIOENCODING": "utf-8", **variables}
    return subprocess.run(
        [sys.executable, "-m", "grader", *arguments],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        check=False,
        timeout=60,
    )
