"""Golden cases: a command line, and the exact output that it must print."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from grader.report.formats import Format
from tests.command_line import ROOT, run

__all__ = ["CLASSROOM50", "GOLDEN", "ROOT", "Golden", "run"]
FOLDER = Path(__file__).parent


@dataclass(frozen=True, slots=True)
class Golden:
    """A command with its exit code; standard output is in the file of its name. `variables` are set around it."""

    name: str
    arguments: tuple[str, ...]
    exit_code: int
    variables: Mapping[str, str] = field(default_factory=dict)

    @property
    def file(self) -> Path:
        """Return the file of the expected output, with the ending of its format."""
        requested = self.arguments[self.arguments.index("--format") + 1] if "--format" in self.arguments else "terminal"
        return FOLDER / f"{self.name}.{Format(requested).ending.rpartition('.')[2]}"


# The variables that the runner of Classroom 50 sets for an autograder.
CLASSROOM50 = {
    "CLASSROOM": "robotics",
    "ASSIGNMENT": "lab6",
    "ASSIGNMENT_TYPE": "individual",
    "USERNAME": "alice",
    "SUBMISSION_TAG": "submit/2026-11-20T18-30-05Z-ab12cd3",
    "COMMIT_URL": "https://github.com/robotics/lab6-alice/commit/ab12cd3",
    "RELEASE_URL": "https://github.com/robotics/lab6-alice/releases/tag/submit%2F2026-11-20T18-30-05Z-ab12cd3",
    "REVIEW_URL": "https://github.com/robotics/lab6-alice/compare/0a1b2c3...ab12cd3",
}


def _in_every_format(name: str, path: str, exit_code: int) -> tuple[Golden, ...]:
    """Return a case for each format of a platform."""
    formats = ("markdown", "junit", "sarif", "github", "gradescope", "classroom50", "codeclimate")
    around = {
        "CI_PROJECT_DIR": str(ROOT),
        **CLASSROOM50,
    }  # paths relative to this project, whatever repository contains it
    return tuple(
        Golden(f"{name}-{file_format}", ("grade", path, "--format", file_format), exit_code, around)
        for file_format in formats
    )


# Samples whose drawings are kept.
_DRAWN = (
    "lab6/reference",
    "lab6/axis-negated",
    "lab6/base-half-sunk",
    "lab6/caster-misnamed",
    "lab6/lidar-buried",
    "lab6/several-mistakes",
    "lab6/wheel-inside-base",
    "lab6/wheels-lying-flat",
    "arm/hand-half-sunk",
    "sensors/camera-up",
)


def _drawings() -> tuple[Golden, ...]:
    """Return a case for each drawing."""
    return tuple(
        Golden(
            f"drawing-{sample.removeprefix('lab6/').replace('/', '-')}",
            ("grade", f"submissions/{sample}", "--rubric", sample.partition("/")[0], "--format", "svg"),
            int(sample != "lab6/reference"),
        )
        for sample in _DRAWN
    )


GOLDEN = (
    Golden("reference", ("grade", "submissions/lab6/reference"), 0),
    Golden("reference-verbose", ("grade", "submissions/lab6/reference", "--verbose"), 0),
    Golden("reference-json", ("grade", "submissions/lab6/reference", "--format", "json"), 0),
    Golden("several-mistakes", ("grade", "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"), 1),
    Golden(
        "several-mistakes-json",
        ("grade", "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf", "--format", "json"),
        1,
    ),
    Golden("lidar-without-joint", ("grade", "submissions/lab6/lidar-without-joint/my_robot/urdf/my_robot.urdf"), 1),
    Golden("broken-tag-parent", ("grade", "submissions/lab6/broken-tag-parent/my_robot/urdf/my_robot.urdf"), 1),
    Golden(
        "broken-tag-parent-json",
        ("grade", "submissions/lab6/broken-tag-parent/my_robot/urdf/my_robot.urdf", "--format", "json"),
        1,
    ),
    Golden("no-launch-folder", ("grade", "submissions/lab6/no-launch-folder", "--part", "task2"), 1),
    Golden("launch-home-path", ("grade", "submissions/lab6/launch-home-path", "--part", "task2"), 1),
    Golden("setup-syntax-error", ("grade", "submissions/lab6/setup-syntax-error", "--part", "task2"), 1),
    Golden("empty-urdf", ("grade", "submissions/lab6/empty-urdf"), 1),
    Golden("team-of-two-json", ("grade", "submissions/lab6/equivalent-team-of-two/Lab6/Ash", "--format", "json"), 0),
    Golden("zipped", ("grade", "submissions/lab6/equivalent-zipped-with-wrapper/lab6.zip", "--part", "questions"), 0),
    Golden("inspect-raw-xacro", ("inspect", "submissions/lab6/raw-xacro/my_robot.urdf"), 1),
    Golden("inspect-reference", ("inspect", "submissions/lab6/reference", "--relative-to", "base_link"), 0),
    Golden(
        "inspect-turned-json",
        ("inspect", "submissions/lab6/reference", "--joint", "base_left_wheel_joint=1.57", "--format", "json"),
        0,
    ),
    Golden("explain-criterion", ("explain", "lidar-frame"), 0),
    Golden("explain-code", ("explain", "URDF012"), 0),
    Golden("explain-package-code", ("explain", "PKG014"), 0),
    Golden("explain-check", ("explain", "bottom_at_height"), 0),
    Golden("rubric-show", ("rubric", "show", "lab6"), 0),
    *_drawings(),
    Golden(
        "drawing-turned-arm",
        (
            "inspect",
            "submissions/arm/equivalent-plain",
            "--joint",
            "joint_2=0.6",
            "--joint",
            "joint_3=0.8",
            "--format",
            "svg",
        ),
        0,
    ),
    *_in_every_format("several-mistakes", "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf", 1),
)
