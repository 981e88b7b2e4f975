"""The sample submissions, each with the contents of its expected.toml."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from grader.grading.grade import grade
from grader.grading.report import Report
from grader.grading.rubric import Rubric, load_rubric
from grader.submission.opening import open_submission
from grader.submission.submission import Submission

ROOT = Path(__file__).parent.parent
LAB6 = load_rubric("lab6")


@dataclass(frozen=True, slots=True)
class Sample:
    """A folder of submissions/: the submission is this folder, or the path in it that expected.toml names."""

    name: str
    expected: dict[str, Any]

    @property
    def path(self) -> Path:
        """Return the path of the submission, relative to the project's root."""
        return Path("submissions", self.name, str(self.expected.get("path", "")))

    @property
    def rubric(self) -> Rubric:
        """Return the rubric for its grading."""
        named = self.expected.get("rubric", LAB6.id)
        return LAB6 if named == LAB6.id else load_rubric(named)

    def open(self) -> Submission:
        """Return the submission."""
        return opened(self.path, self.rubric)

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


def _read(folder: Path) -> Sample:
    return Sample(folder.name, tomllib.loads((folder / "expected.toml").read_text(encoding="utf-8")))


SAMPLES = {path.parent.name: _read(path.parent) for path in sorted((ROOT / "submissions").glob("*/expected.toml"))}
