"""The sample submissions in submissions/, each with its expected.toml, as `grader rubric test` reads them."""

from dataclasses import dataclass
from pathlib import Path

from grader.grading.grade import grade
from grader.grading.report import Report
from grader.grading.rubric import Rubric, load_rubric
from grader.mutation.samples import Sample as ExpectedSample
from grader.mutation.samples import read_samples
from grader.submission.opening import open_submission
from grader.submission.submission import Submission

ROOT = Path(__file__).parent.parent
LAB6 = load_rubric("lab6")


@dataclass(frozen=True, slots=True)
class Sample:
    """A folder of submissions/: the submission is this folder, or the path in it that expected.toml names."""

    expected: ExpectedSample

    @property
    def name(self) -> str:
        """Return the name of the folder."""
        return self.expected.name

    @property
    def path(self) -> Path:
        """Return the path of the submission, relative to the project's root."""
        return Path("submissions", self.name, self.expected.path)

    @property
    def rubric(self) -> Rubric:
        """Return the rubric for its grading."""
        return LAB6 if self.expected.rubric == LAB6.id else load_rubric(self.expected.rubric)

    def open(self) -> Submission:
        """Return the submission."""
        return self.expected.open(self.rubric)

    def grade(self) -> Report:
        """Return its report."""
        return grade(self.rubric, self.open())


def opened(path: Path | str, rubric: Rubric = LAB6) -> Submission:
    """Return the submission at a path relative to the project's root, opened as the command line does."""
    return open_submission(str(ROOT / path), wanted=rubric.urdf, package=rubric.package, folders=rubric.folders)


def reference(rubric: Rubric = LAB6) -> Submission:
    """Return the reference solution of a rubric."""
    assert rubric.solution is not None
    return rubric.solution.submission


SAMPLES = {sample.name: Sample(sample) for sample in read_samples(ROOT / "submissions")}
