"""The sample submissions in submissions/, each with its expected.toml, as `grader rubric test` reads them."""

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from grader.lab.authoring.samples import Sample as ExpectedSample
from grader.lab.authoring.samples import read_samples
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.rubric.rubric import Rubric, load_rubric, shipped_rubrics
from grader.lab.submission.opening import open_submission
from grader.lab.submission.submission import Submission

ROOT = Path(__file__).parent.parent
RUBRICS = {name: load_rubric(name) for name in shipped_rubrics()}
LAB6 = RUBRICS["lab6"]


@dataclass(frozen=True, slots=True)
class Sample:
    """A folder of submissions/RUBRIC/: the submission is this folder, or the path in it that expected.toml names."""

    expected: ExpectedSample

    @property
    def name(self) -> str:
        """Return the name of the folder, after the name of its rubric if that is not lab6."""
        folder = self.expected.folder
        return (
            folder.name if folder.parent.name == "lab6" else f"{folder.parent.name}/{folder.name}"
        )

    @property
    def path(self) -> Path:
        """Return the path of the submission, relative to the project's root."""
        return (self.expected.folder / self.expected.path).relative_to(ROOT)

    @property
    def alone(self) -> "Sample":
        """Return the sample that consists of the URDF of this one, without its package."""
        (urdf,) = self.expected.folder.glob("*/urdf/*_robot.urdf*")
        return Sample(
            replace(self.expected, path=urdf.relative_to(self.expected.folder).as_posix())
        )

    @property
    def rubric(self) -> Rubric:
        """Return the rubric for its grading."""
        return RUBRICS[self.expected.rubric]

    def open(self) -> Submission:
        """Return the submission."""
        return opened(self.path, self.rubric)

    def grade(self) -> Report:
        """Return its report, the same object each time: every format is tested on all samples."""
        return _report(self)


@cache
def _report(sample: Sample) -> Report:
    return grade(sample.rubric, sample.open())


def opened(path: Path | str, rubric: Rubric = LAB6) -> Submission:
    """Return the submission at a path relative to the project's root, opened as the command line does."""
    return open_submission(str(ROOT / path), rubric.lab)


def reference(rubric: Rubric = LAB6) -> Submission:
    """Return the reference solution of a rubric."""
    assert rubric.solution is not None
    return rubric.solution.submission


_FOLDERS = [ROOT / "submissions" / name for name in RUBRICS]
_READ = [
    Sample(sample) for folder in _FOLDERS if folder.exists() for sample in read_samples(folder)
]
SAMPLES = {sample.name: sample for sample in _READ}
LAB6_SAMPLES = {name: sample for name, sample in SAMPLES.items() if sample.rubric is LAB6}
# What every format of reports is tested on: together these reports reach every branch of the formats, and have each status with
# and without a place, a hint, points that are kept and an answer, each kind of problem, and each kind of submission.
REPORTED = (
    "reference",
    "several-mistakes",
    "axis-for-the-z-up-wheel",
    "truncated-file",
    "empty-urdf",
    "sensors/launch-home-path",
    "wheel-axes-along-x",
    "cmake-package",
    "arm/masses-in-grams",
    "commas-in-vectors",
    "equivalent-zero-size-footprint",
    "minus-sign-from-a-pdf",
    "xacro-from-another-package",
    "cylinder-height",
    "equivalent-box-on-its-side",
    "empty-urdf",
    "rviz-not-installed",
    "zero-axis",
    "caster-misnamed",
    "folder-misspelt-in-setup",
    "joint-without-child",
    "package-misnamed",
    "rviz-of-ros1",
    "sensors/gazebo-reference-misspelt",
    "raw-xacro",
    "equivalent-other-urdfs-nearby",
)
